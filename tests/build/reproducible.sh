#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# No build path and no host in what is installed.
. "$srcdir/tests/tap.sh"
command -v strings >/dev/null || skip_all "reproducible.sh: no strings"

[ "$MCR_SANITIZED" != 1 ] || skip_all "reproducible.sh: sanitizers keep the names of source files"

host=$(uname -n)
traces() # file: what it tells about where it was built; the installation's own folders may be in it
{
    strings -a -n 4 "$1" | grep -vF "/mcrender-1/" | grep -F -e "$builddir/" -e "$srcdir/" $([ ${#host} -ge 8 ] && [ "$host" != localhost ] && printf -- '-e %s' "$host")
}

empty "mcrender does not tell where it was built" "$(traces "$MCRENDER")"
for file in "$MCRENDER_PLUGIN_PATH"/*.so "$MCRENDER_MODULE_PATH"/*.so; do
    [ -f "$file" ] && empty "$(basename "$file") does not tell where it was built" "$(traces "$file")"
done
printf '%s/src/x.c\n' "$builddir" >"$TMPDIR/trace"
check "a trace is seen" test -n "$(traces "$TMPDIR/trace")"
finish
