#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# What would make images depend on the machine or the day: flags, intrinsics, and the time of the build.
. "$srcdir/tests/tap.sh"

look() # pattern files…
{
    local pattern=$1
    shift
    (cd "$srcdir" && find "$@" -type f ! -path '*/.libs/*' ! -name '*.o' ! -name '*.lo' ! -name 'flags.sh' -exec grep -nE -e "$pattern" {} + 2>/dev/null)
}

recipes='Makefile.am configure.ac m4/mcr-flags.m4 mcrender-plugin.pc.in quickstart .ci/run src plugins tests'
fast='-(march=native|mtune=native|mcpu=native|ffast-math|Ofast|funsafe-math-optimizations|ffp-contract=(fast|on)|fassociative-math|ffinite-math-only)'
# A comment may name what is not done.
empty "no flag that gives up reproducible arithmetic" "$(look "$fast" $recipes | grep -vE ':[[:space:]]*(/?\*|#|//)|[Nn]o(t|r)? +-|[Nn]ever ')"
empty "no intrinsics and no dispatch by the linker" \
    "$(look '#[[:space:]]*include[[:space:]]*<([a-z]*mmintrin|immintrin|x86intrin|arm_neon)\.h>|target_clones|__attribute__.*ifunc' src plugins)"
empty "no time of the build in the sources" "$(look '__(DATE|TIME|TIMESTAMP)__' src plugins)"

for flag in -ffp-contract=off -fno-math-errno -fno-trapping-math; do
    check "mcrender-plugin.pc gives $flag" grep -qE "^Cflags:.* $flag( |\$)" "$builddir/mcrender-plugin.pc"
done
check "contraction is off in this build" grep -qE '^number_flags = .*-ffp-contract=off' "$builddir/Makefile"
empty "the user's CFLAGS come after the project's and hold none of them" "$(grep -E '^CFLAGS = .*-(ffp-contract|ftree-vectorize|fno-math-errno)' "$builddir/Makefile")"

# The numbers in the .pc file are those of the header.
header=$srcdir/src/mcrender/plugin.h
number=$(sed -n 's/^#define MCR_PLUGIN_MAJOR \([0-9]*\)u$/\1/p' "$header").$(sed -n 's/^#define MCR_PLUGIN_MINOR \([0-9]*\)u$/\1/p' "$header")
check "mcrender-plugin.pc gives the interface $number" grep -qx "interface=$number" "$builddir/mcrender-plugin.pc"
finish
