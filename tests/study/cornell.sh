#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The founding study (scenes/studies/cornell-variance.scn) small: its six samplers, fewer samples and pixels. What holds at any size must show.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/study/help.sh"

study "$srcdir/scenes/studies/cornell-variance.scn" --size 32x32 --spp 4,16 --depth 1,5 --seeds 6 --runs 4 --reference-spp 2048 -o small
ends "the founding study, small" 0
check "six samplers, two sample counts, two depths, six seeds" test "$(grep -c '"run":[0-9]*,"cell"' small/journal.jsonl)" -ge 144
check "light alone is marked in all its cells" test "$(grep -c '"incomplete"' small/study.json)" -ge 8

# verdicts A B: of all pairs of the two, as the command prints them for the greatest depth and spp
verdict() { awk -v a="  $1 against $2" '$0 == a { getline; sub(/^ */, ""); print; getline; sub(/^ */, ""); print; exit }' stdout; }
cosine_mixture=$(verdict cosine 'mixture(cosine 1, light 1)')
mixture_strata=$(verdict 'mixture(cosine 1, light 1)' 'stratified(mixture(cosine 1, light 1))')
check "light is in no verdict" test "$(grep -cE 'against light$|^  light against' stdout)" = 0
check "but the pairs that it is in are told" grep -q '^9 pairs of the most samples are not compared: one of the two is marked' stdout
check "mixture beats cosine: $(tail -n 1 <<<"$cosine_mixture")" grep -q 'with equal samples: worse by a factor' <<<"$cosine_mixture"
check "stratified pixels beat independent ones: $(tail -n 1 <<<"$mixture_strata")" grep -q 'with equal samples: worse by a factor' <<<"$mixture_strata"
for figure in '<h2>Time' '<h2>Image quality' '<svg'; do check "the report has $figure" grep -q "$figure" small/report.html; done

study "$srcdir/scenes/studies/knobs.scn" --size 16x16 --spp 4 --depth 1,3 --seeds 3 --runs 3 --reference-spp 256 --reference-depth 10 -o knobs
ends "the other knobs, small" 0
check "two samplers, accelerators and depths, roulette on and off" test "$(grep -c '"run":[0-9]*,"cell"' knobs/journal.jsonl)" -ge 48
study "$srcdir/scenes/studies/quirks.scn" --size 16x9 --spp 5,20 --seeds 3 --runs 3 --reference-spp 256 -o quirks
ends "the quirks, small" 0
check "all quirks but none are announced" test "$(grep -c '"compat"' quirks/study.json)" -ge 5
finish
