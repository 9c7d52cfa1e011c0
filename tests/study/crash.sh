#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# A study is killed at each of its writes, and goes on: its figures are those of one that nobody stopped. The same for a full disk.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/study/help.sh"
[ -z "$MCR_SANITIZED" ] || skip_all "crash.sh: a preloaded library and sanitizers do not go together"
${MCR_CC:-cc} -std=gnu17 -O1 -shared -fPIC "$srcdir/tests/study/crash.c" -o "$TMPDIR/crash.so" -ldl || { point 1 "crash.c compiles"; finish; }

# By PFM, so that every process makes the same calls with and without OpenImageIO.
export MCRENDER_MODULE_PATH=$TMPDIR/none
tiny 'samplers (cosine, light)   spp 2   seeds 3   runs 1   reference { spp 4   sampler cosine }'
study tiny.scn -o whole
ends "nobody stops it" 0
figures whole >expected
check "it has figures" test "$(wc -l <expected)" = 12

MCR_CRASH_COUNT=$TMPDIR/count LD_PRELOAD=$TMPDIR/crash.so "$MCRENDER" study tiny.scn -o counted >stdout 2>stderr </dev/null
count=$(cat count)
check "it writes often ($count calls)" test "$count" -ge 40

# killed_at N FOLDER: in a shell of its own, which says nothing of the signal
killed_at()
{
    (MCR_CRASH_AT=$1 LD_PRELOAD=$TMPDIR/crash.so "$MCRENDER" study tiny.scn -o "$2" >stdout 2>stderr </dev/null; exit $?) 2>/dev/null
}
wrong= killed=0
for at in $(seq 1 "$count"); do
    rm -rf crash
    killed_at "$at" crash
    [ $? != 137 ] || killed=$((killed + 1))
    study tiny.scn -o crash
    figures crash >after 2>&1
    [ $status = 0 ] && cmp -s after expected && [ -z "$(find crash -name '.*.tmp')" ] || wrong="$wrong $at (status $status: $(head -n 2 stderr))"
done
check "it is killed nearly each time (equal times differ by a write)" test $killed -ge $((count - 8))
empty "killed at any write, it goes on to the same figures, and no temporary file stays" "$wrong"

wrong=
for at in $(seq 1 3 $((count - 8))); do
    rm -rf full
    MCR_FULL_AT=$at LD_PRELOAD=$TMPDIR/crash.so "$MCRENDER" study tiny.scn -o full >stdout 2>stderr </dev/null
    full=$?
    grep -q 'No space left' stderr || full="$full without a reason"
    study tiny.scn -o full
    figures full >after 2>&1
    [ "$full" = 1 ] && [ $status = 0 ] && cmp -s after expected || wrong="$wrong $at (status $full, then $status: $(head -n 2 stderr))"
done
empty "on a full disk it ends with status 1 and the reason, and goes on later" "$wrong"

# killed within a run after another
rm -rf twice
for at in 25 20 15 10 5; do killed_at $at twice; done
study tiny.scn -o twice
figures twice >after
check "killed again and again" cmp after expected
finish
