#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# make install with DESTDIR puts everything in its place, installcheck passes there, uninstall leaves nothing behind.
. "$srcdir/tests/tap.sh"

root=$TMPDIR/root
run_make() { "$MCR_MAKE" -C "$builddir" --no-print-directory "$@" DESTDIR="$root"; }
prefix=$(sed -n 's/^prefix = //p' "$builddir/Makefile")
files() { (cd "$root" 2>/dev/null && find . -type f -o -type l) | sort; }

check "make install DESTDIR=…" run_make install
installed=$(files)
holds() { check "installed: $1" grep -qE "/$1\$" <<<"$installed"; }
holds bin/mcrender
for word in $MCR_PLUGINS; do holds "mcrender-1/plugins/$word\\.so"; done
for header in plugin sampler material math surface microfacet glass glass_table; do holds "include/mcrender/$header\\.h"; done
holds 'pkgconfig/mcrender-plugin\.pc'
holds 'bash-completion/completions/mcrender\.bash'
for page in $MCR_MAN; do holds "man/man${page##*.}/$(basename "$page")"; done
for scene in $MCR_SCENES; do holds "mcrender/scenes/$(basename "$scene")"; done
if [ -f "$MCRENDER_MODULE_PATH/oiio.so" ]; then holds 'mcrender-1/modules/oiio\.so'; fi
empty "no .la file and no library is installed" "$(grep -E '\.la$|\.a$|/lib[^/]*\.so' <<<"$installed")"
empty "everything is below the prefix" "$(grep -v "^\\.$prefix/" <<<"$installed")"

include=$(find "$root" -path '*/include/mcrender' -type d)
for header in plugin sampler material math surface microfacet glass glass_table; do
    echo "#include <mcrender/$header.h>" >"$TMPDIR/$header.c"
    check "$header.h compiles by itself from where it is installed" \
        $MCR_CC -std=c11 -Wall -Wextra -pedantic -Werror -I"${include%/mcrender}" -c "$TMPDIR/$header.c" -o "$TMPDIR/$header.o"
done

if [ "$MCR_SANITIZED" = 1 ]; then skip "make installcheck" "sanitized"; else check "make installcheck" run_make installcheck; fi
check "make uninstall" run_make uninstall
empty "uninstall leaves no file" "$(files)"
empty "uninstall leaves no folder of ours" "$(find "$root$prefix" -type d -name "mcrender*" 2>/dev/null)"
finish
