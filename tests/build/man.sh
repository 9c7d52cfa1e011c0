#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The man pages are clean under mandoc's lint and all of them are installed.
. "$srcdir/tests/tap.sh"

check "there are man pages" test -n "$MCR_MAN"
for page in "$srcdir"/man/*.[157]; do
    [ -f "$page" ] || continue
    case " $MCR_MAN " in *" man/$(basename "$page") "*) point 0 "$(basename "$page") is installed" ;;
    *) point 1 "$(basename "$page") is installed" "not among man_pages in man/Makefile.inc" ;; esac
    if command -v mandoc >/dev/null; then
        # whether a referenced manual is found depends on what else is installed
        empty "$(basename "$page") is clean under mandoc -Tlint" "$(mandoc -Tlint -W style "$page" 2>&1 | grep -vE 'referenced manual not found|outdated mandoc.db')"
    else
        skip "$(basename "$page") is clean under mandoc -Tlint" "no mandoc"
    fi
done
finish
