#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# SIGINT and SIGTERM end a study after the running pass; what is finished is kept and written.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/study/help.sh"
set -m # else the shell has SIGINT ignored in background jobs

tiny 'samplers (cosine, light)   spp (64, 20000)   seeds 200   runs 1   reference { spp 64 }'
for signal in INT TERM; do
    "$MCRENDER" study tiny.scn -o $signal >stdout 2>stderr </dev/null &
    pid=$!
    for i in $(seq 600); do
        [ "$(runs $signal)" -lt 6 ] || break
        sleep 0.05
    done
    kill -s $signal $pid
    wait $pid
    status=$?
    ends "SIG$signal: status 130, and how it goes on" 130 "of 800 runs; the same command goes on from here"
    n=$(runs $signal)
    check "SIG$signal: the runs are kept ($n)" test "$n" -ge 6
    check "SIG$signal: the outputs are of what there is" test "$(($(wc -l <$signal/study.csv) - 1))" = "$n"
    for file in study.json report.html; do check "SIG$signal: $file" test -s $signal/$file; done
done
study tiny.scn -o INT --spp 64 --seeds 2
ends "it goes on" 0
finish
