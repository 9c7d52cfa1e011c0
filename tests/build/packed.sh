#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The compiler vectorised the stages: each object holds packed arithmetic on doubles, in the registers of its instruction set.
# The flags must have survived whatever optimisation level the user gave.
. "$srcdir/tests/tap.sh"
command -v objdump >/dev/null || skip_all "packed.sh: no objdump"
[ "$MCR_SANITIZED" != 1 ] || skip_all "packed.sh: sanitizers keep loops scalar"
case " $MCR_CFLAGS " in *" -O0 "* | *" -Og "* | *" -O1 "* | *" -Os "* | *"coverage"*) skip_all "packed.sh: built with $MCR_CFLAGS" ;; esac
[ "$MCR_ISA_COUNT" = 3 ] || skip_all "packed.sh: knows the instructions of x86-64 only"

operation='(add|sub|mul|div|sqrt|min|max|fn?m(add|sub)[0-9]*)pd'
pattern=("[[:space:]]$operation[[:space:]].*%xmm" "[[:space:]]v$operation[[:space:]].*%ymm" "[[:space:]]v$operation[[:space:]].*%zmm")
set_name=(baseline avx2 avx512)

packed() # object, instruction set: how many packed operations
{
    objdump -d --no-show-raw-insn "$1" | grep -cE "${pattern[$2]}"
}

[ -n "$MCR_STAGES" ] || point 1 "there are stages"
for source in $MCR_STAGES; do
    case $source in *.h) continue ;; esac
    for isa in 0 1 2; do
        object=$builddir/$(dirname "$source")/.libs/libstages${isa}_la-$(basename "$source" .c).o
        if [ ! -f "$object" ]; then
            point 1 "$source, ${set_name[$isa]}: compiled" "$object is missing"
        elif case " $MCR_SCALAR_STAGES " in *" $(basename "$source" .c) "*) ;; *) false ;; esac then
            point 0 "$source, ${set_name[$isa]}: compiled (no packed arithmetic is expected: scalar_stages)"
        else
            count=$(packed "$object" $isa)
            [ "$count" -gt 0 ]
            point $? "$source, ${set_name[$isa]}: packed arithmetic on doubles ($count)" "no packed operation in $object"
        fi
    done
done
for isa in 0 1; do # nothing of a wider set may leak into a narrower one: the program would die of it
    leaked=
    for source in $MCR_STAGES; do
        object=$builddir/$(dirname "$source")/.libs/libstages${isa}_la-$(basename "$source" .c).o
        [ ! -f "$object" ] || ! objdump -d --no-show-raw-insn "$object" | grep -qE "$([ $isa = 0 ] && echo '%[yz]mm|[[:space:]]v[a-z]+[ps]d[[:space:]]' || echo '%zmm')" ||
            leaked="$leaked $object"
    done
    empty "no instruction of a wider set in the ${set_name[$isa]} stages" "$leaked"
done
case " $MCR_CFLAGS " in *-march=* | *-mavx*) ;; *)
    empty "no AVX instruction in the program's own objects" "$(for object in $(find "$builddir/src" -name '*.o' -path '*/.libs/*' ! -name 'libstages*' ! -path '*/modules/*'); do
        objdump -d --no-show-raw-insn "$object" | grep -qE '%[yz]mm' && echo "$object"; done)" ;;
esac
finish
