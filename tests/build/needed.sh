#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The dynamic section of the program and of the plugins: libc, libm, libdl and libpthread, nothing else.
. "$srcdir/tests/tap.sh"
command -v readelf >/dev/null || skip_all "needed.sh: no readelf"
[ "$MCR_SANITIZED" != 1 ] || skip_all "needed.sh: sanitizers add their libraries"

needed() { readelf -d "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\].*/\1/p'; }
foreign() { needed "$1" | grep -vE '^(libc|libm|libdl|libpthread)\.so\.[0-9]+$|^ld-linux.*\.so\.[0-9]+$|^(libc\.musl|ld-musl).*'; }

check "the program in the build tree is ELF, not a script" readelf -h "$MCRENDER"
check "the program needs libc" grep -q libc <<<"$(needed "$MCRENDER")"
empty "the program needs nothing beside libc, libm, libdl and libpthread" "$(foreign "$MCRENDER")"
empty "the program has no run path" "$(readelf -d "$MCRENDER" | grep -E 'RPATH|RUNPATH')"
for word in $MCR_PLUGINS; do
    empty "$word.so needs nothing beside them" "$(foreign "$MCRENDER_PLUGIN_PATH/$word.so" 2>&1)"
done
finish
