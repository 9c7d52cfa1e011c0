#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Nothing lies about unused: every fragment is included, every test and every source is listed in one.
. "$srcdir/tests/tap.sh"
cd "$srcdir" || exit 99

all=$(cat Makefile.am src/*/Makefile.inc tests/*/Makefile.inc plugins/Makefile.inc | tr -s ' \t\\' '\n')
unlisted() { while read -r file; do grep -qxF -e "$file" -e "${file%.c}" -e "${file%.*}.la" <<<"$all" || echo "$file"; done; }

empty "every fragment is included" "$(for fragment in */Makefile.inc */*/Makefile.inc; do grep -qx "include $fragment" Makefile.am || echo "$fragment"; done)"
empty "every source is listed" "$(find src -name '*.[ch]' -o -name '*.cc' | sort | unlisted)"
empty "every test is listed" "$(find tests -mindepth 2 -maxdepth 2 \( -name '*.c' -o -name '*.h' -o -name '*.sh' \) ! -name bench.sh | sort | unlisted)"
empty "every scene is listed" "$(for scene in scenes/*.scn scenes/studies/*; do [ ! -f "$scene" ] || grep -qw "$scene" scenes/Makefile.inc || echo "$scene"; done)"
check "an unlisted file is seen" test "$(echo src/base/no-such-file.c | unlisted)" = src/base/no-such-file.c
finish
