#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Every source names its licence in its first lines.
. "$srcdir/tests/tap.sh"

sources() # top of a source tree
{
    cd "$1" || exit 99
    find src plugins tests scenes man share packaging -type f \( -name '*.[ch]' -o -name '*.cc' -o -name '*.hh' -o -name '*.sh' -o -name '*.py' \
        -o -name '*.inc' -o -name '*.[157]' \) ! -path '*/.libs/*' 2>/dev/null
    find scenes -name '*.scn' 2>/dev/null
    ls configure.ac Makefile.am mcrender-plugin.pc.in quickstart .ci/run tests/run m4/mcr-*.m4 2>/dev/null
}

unlicensed() { sources "$1" | while read -r file; do head -n 4 "$1/$file" | grep -q 'SPDX-License-Identifier: Apache-2.0' || echo "$file"; done; }

empty "an SPDX line in every source" "$(unlicensed "$srcdir")"
check "sources were found" test "$(sources "$srcdir" | wc -l)" -ge 20
check "LICENSE is the Apache License 2.0" grep -q 'Version 2.0, January 2004' "$srcdir/LICENSE"
mkdir -p "$TMPDIR/bad/src/base"
echo 'int x;' >"$TMPDIR/bad/src/base/x.c"
check "a source without one is seen" test "$(unlicensed "$TMPDIR/bad")" = src/base/x.c
finish
