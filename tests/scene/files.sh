#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# `mcrender check` on scenes that are right (status 0; what it prints is nothing, or NAME.expected where there are warnings) and on
# scenes with mistakes (status 3; NAME.expected holds exactly what it prints). Run in the folder, so that messages name bare files.
#     MCR_UPDATE=1 writes NAME.expected anew: read every difference before it is kept.
. "$srcdir/tests/tap.sh"

mkdir -p "$TMPDIR"

one() # status file
{
    local name=${2%.scn} status
    "$MCRENDER" check "$2" >"$TMPDIR/out" 2>"$TMPDIR/messages" </dev/null
    status=$?
    if [ -n "$MCR_UPDATE" ]; then
        if [ -s "$TMPDIR/messages" ]; then cp "$TMPDIR/messages" "$name.expected"; else rm -f "$name.expected"; fi
    fi
    if [ $status != "$1" ]; then
        point 1 "${PWD##*/}/$2" "status $status instead of $1
$(cat "$TMPDIR/messages")"
    elif [ -e "$name.expected" ]; then
        empty "${PWD##*/}/$2" "$(diff -a -u "$name.expected" "$TMPDIR/messages")"
    elif [ "$1" = 0 ]; then
        empty "${PWD##*/}/$2" "$(cat "$TMPDIR/messages")"
    else
        point 1 "${PWD##*/}/$2" "there is no $name.expected"
    fi
}

cd "$srcdir/tests/scene/good" || exit 99
for file in *.scn; do one 0 "$file"; done
cd "$srcdir/tests/scene/bad" || exit 99
for file in *.scn; do one 3 "$file"; done
check "at least 60 scenes with mistakes" test "$(ls ./*.scn | wc -l)" -ge 60
finish
