#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# `mcrender study` from the scene to its outputs: what it plans, renders, keeps, refuses.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/study/help.sh"

tiny 'samplers (cosine, mixture(cosine, light))   spp (1, 2)   seeds 3   runs 2   reference { spp 64 }'
study tiny.scn --dry-run
ends "a dry run" 0
empty "it writes nothing" "$(ls | grep -vE '^(tiny.scn|stdout|stderr)$')"
check "it lists the cells, the reference and the sum" test "$(grep -cE '^(cosine|mixture|reference)' stdout) $(grep -c '^4 cells, 28 renders to go' stdout)" = "5 1"

study tiny.scn
ends "a study" 0
empty "no message" "$(cat stderr)"
check "a line a run, and two of them at equal time at most" test "$(runs tiny-study)" = 12
for file in study.json study.csv report.html; do check "$file" test -s tiny-study/$file; done
check "an image a cell" test "$(ls tiny-study/images | grep -cE -- '-spp[12]-depth2-')" -ge 4
check "the verdict in words" grep -q 'with equal samples: ' stdout
check "the seeds are those that follow the first" test "$(grep -o '"run":[0-9],.*"seed":[0-9]' tiny-study/journal.jsonl | sed 's/"cell.*"seed"//' | sort -u | tr '\n' ' ')" = '"run":0,:1 "run":1,:2 "run":2,:3 '
check "cells take turns: a round is a permutation of them" awk '
    /"run"/ { match($0, /"cell":"[0-9a-f]*"/); cell = substr($0, RSTART, RLENGTH); round = int(n * 0.25); n++; if (seen[round cell]++) bad = 1 }
    END { exit bad || n != 12 }' tiny-study/journal.jsonl

cp -r tiny-study before
study tiny.scn
ends "the same again" 0
check "renders nothing: the journal is as it was" cmp before/journal.jsonl tiny-study/journal.jsonl
study tiny.scn --dry-run
check "a dry run knows" grep -q '^4 cells, 0 renders to go' stdout
study tiny.scn --seeds 4
ends "more seeds" 0
check "one more run a cell" test "$(runs tiny-study)" = 16
check "and the old ones are kept" test "$(head -n "$(wc -l <before/journal.jsonl)" tiny-study/journal.jsonl | cksum)" = "$(cksum <before/journal.jsonl)"
figures before | grep run >old
figures tiny-study | grep run >new
empty "the old figures are among the new" "$(grep -vxFf new old)"
study tiny.scn --spp 4
check "another spp by option: two cells more" test "$(runs tiny-study)" = 22
study tiny.scn -o other --sampler cosine --spp 1 --seeds 2 --runs 1 --depth 1,2 --roulette on,off --reference-depth 2 --reference-spp 16 --metrics mse,ssim
ends "everything by options, in another folder" 0
check "the product of the lists, depths compared with each other" test "$(runs other)" = 8
check "metrics that nobody asked for are not there" awk '/"run"/ && /psnr|relmse/ { bad = 1 } END { exit bad }' other/journal.jsonl
printf 'mcrender 1\ninclude "tiny.scn"\n' >outer.scn
study outer.scn --seeds 1 --runs 1 --spp 1 --reference-spp 16
ends "a file that includes the scene" 0
check "has a folder by its own name" test -s outer-study/study.json

# Images as references.
"$MCRENDER" tiny.scn --quiet --spp 64 -o reference.pfm
study tiny.scn -o byfile --reference reference.pfm --seeds 2 --runs 1 --spp 1
ends "a file is the reference, whose noise is unknown" 0 "the noise of the reference is unknown"
check "and so is the bias" grep -q '"bias_square": null' byfile/study.json
"$MCRENDER" tiny.scn --quiet --size 9x8 --spp 1 -o wide.pfm
study tiny.scn -o wide --reference wide.pfm
ends "a reference of another size" 1 "9 x 8 pixels, the study's pictures 8 x 8"
refute "leaves no folder" test -e wide

# Safety.
sed 's/0.73/0.74/' tiny.scn >changed.scn
study changed.scn -o tiny-study
ends "another scene does not go into the folder" 1 "its renders are of another scene ('tiny.scn' as it was then)"
sed 's/spp (1, 2)/spp (1)/; s/^render/# the same\nrender/' tiny.scn >grown.scn
study grown.scn -o tiny-study
ends "another study of the same scene does" 0
check "and finds what is there" test "$(runs tiny-study)" = 22
mkdir foreign && echo mine >foreign/report.html
study tiny.scn -o foreign
ends "a folder with somebody's files" 1 "no journal of a study"
check "is left alone" test "$(ls foreign) $(cat foreign/report.html)" = "report.html mine"
echo mine >foreign/journal.jsonl
study tiny.scn -o foreign
ends "a journal that is none" 1 "no journal of a study"
check "is left alone, too" test "$(cat foreign/journal.jsonl)" = mine
study tiny.scn -o no/where
ends "a folder in no folder" 1 "No such file or directory"
study tiny.scn -o tiny.scn
ends "a file is no folder" 1 "Not a directory"

if command -v flock >/dev/null; then
    flock tiny-study/journal.jsonl "$MCRENDER" study tiny.scn >stdout 2>stderr
    status=$?
    ends "two at once: the second is refused" 1 "another process works in this folder"
else
    skip "two at once" "no flock"
fi

# Mistakes: all in one run, before anything is rendered.
study tiny.scn -o wrong --spp 1,1 --sampler cosin --metrics pnsr --reference-seed 2
ends "options are judged like the block" 3 "--spp:1:3: error: 'spp' of 'study' has 1 twice"
for text in "unknown sampler 'cosin'" "did you mean 'psnr'?"; do check "$text" grep -qF "$text" stderr; done
study tiny.scn -o wrong --reference-seed 2
ends "a reference that shares seeds with the runs" 3 "it would share their noise"
study tiny.scn -o wrong --reference-sampler light
ends "a reference that does not cover the scene" 3 "does not estimate the whole image"
study tiny.scn -o wrong --seeds 100000
ends "too many renders" 3 "more than 100000 renders"
study "$srcdir/scenes/cornell-box.scn"
ends "a scene without a study" 3 "asks for no study"
study tiny.scn -o a -o b
ends "two folders" 2
refute "no folder after any of these" test -e wrong

"$MCRENDER" study --help | sed -n 's/^  \(--[a-z-]*\).*/\1/p' | sort >told
sed -n 's/^\.It Fl Fl \([a-z-]*\).*/--\1/p' "$srcdir/man/mcrender-study.1" | sort >listed
check "the options of --help are those of the manual page" diff told listed
check "there are options" test "$(wc -l <told)" -ge 20
empty "no line of --help is wider than 80 columns" "$("$MCRENDER" study --help | awk 'length > 80')"

# A crop that the scene's film says is part of what was rendered.
tiny 'samplers cosine   spp 1   seeds 1   runs 1   reference { spp 16 }'
study tiny.scn -o crop
sed -i 's/size (8, 8)/size (8, 8)   crop (0, 0, 4, 4)/' tiny.scn
study tiny.scn -o crop
ends "a crop in the scene's film" 0
check "is another cell" test "$(runs crop)" = 2
finish
