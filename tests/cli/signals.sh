#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# SIGINT and SIGTERM end a render after the running pass; what there is is written.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/cli/run.sh"
[ -r /proc/self/status ] || skip_all "signals.sh: no /proc"
set -m # else the shell has SIGINT ignored in background jobs

# start ARGUMENT...: in the background; returns when threads are at work, which is after the handlers were installed. Sets pid.
start()
{
    local i
    "$MCRENDER" "$srcdir/scenes/cornell-box.scn" --threads 2 "$@" >"$TMPDIR/stdout" 2>"$TMPDIR/stderr" </dev/null &
    pid=$!
    for i in $(seq 600); do
        [ "$(sed -n 's/^Threads:[^0-9]*//p' "/proc/$pid/status" 2>/dev/null)" != 2 ] || return 0
        sleep 0.05
    done
    point 1 "the render starts" "$(cat "$TMPDIR/stderr")"
}

# caught SIGNAL-NUMBER: whether the program still handles it
caught()
{
    local mask
    mask=$(sed -n 's/^SigCgt:[^0-9a-f]*//p' "/proc/$pid/status" 2>/dev/null)
    [ $(((0x0$mask >> ($1 - 1)) & 1)) = 1 ]
}

finite() # file: a PPM of 16 x 16 that is not black
{
    [ "$(head -c 2 "$1")" = P6 ] && [ "$(wc -c <"$1")" = $((13 + 16 * 16 * 3)) ] && [ -n "$(tail -c 768 "$1" | tr -d '\0')" ]
}

for signal in INT TERM; do
    start --size 16x16 --spp 2000000000 --depth 2 -o $signal.ppm --report $signal.json
    kill -s $signal $pid
    wait $pid
    status=$?
    ends "SIG$signal: status 130, and the report says so" 130 "warning: interrupted after " " of 2000000000 spp" "wrote     $signal.ppm"
    check "SIG$signal: the picture is written" finite $signal.ppm
    equal "SIG$signal: JSON" "$(value interrupted $signal.json)" true
    check "SIG$signal: whole passes" awk -v n="$(value samples $signal.json)" 'BEGIN { exit !(n > 0 && n % (16 * 16 * 16) == 0) }'
    check "SIG$signal: the report is that of the samples that there are" test "$(value camera_rays $signal.json)" = "$(value samples $signal.json)"
done

# What was written is what a render of so many samples gives. (Number sources that count on the planned spp are another matter.)
samples=$(($(value samples INT.json) / 256))
if [ $samples -le 200000 ]; then
    run "$srcdir/scenes/cornell-box.scn" --quiet --size 16x16 --spp $samples --depth 2 -o again.ppm
    check "an interrupted picture has the bits of a shorter one ($samples spp)" cmp INT.ppm again.ppm
else
    skip "an interrupted picture has the bits of a shorter one" "$samples samples a pixel would take too long"
fi

# A pass of 16 million paths lasts longer than it takes to see that the first signal has been handled.
rm -f ./*.ppm ./*.json
start --size 1024x1024 --spp 16 -o killed.ppm --report killed.json
kill -s INT $pid
for i in $(seq 600); do caught 15 || break; sleep 0.01; done
kill -s TERM $pid
wait $pid
equal "a second signal kills" $? 143
equal "a second signal: nothing is written, nothing is left over" "$(listing)" "glow.scn"

# As nohup and background jobs of scripts have it.
(trap '' INT; exec "$MCRENDER" "$srcdir/scenes/cornell-box.scn" --quiet --threads 2 --size 16x16 --spp 100000 --depth 2 -o ignored.ppm) &
pid=$!
for i in $(seq 600); do caught 15 && break; sleep 0.01; done
refute "an ignored SIGINT stays ignored" caught 2
kill -s INT $pid
kill -s TERM $pid
wait $pid
equal "SIGTERM is handled then" $? 130
finish
