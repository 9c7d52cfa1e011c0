#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Torn, edited and hostile files in a study's folder: what is damaged is told and made again, and nothing brings the program down.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/study/help.sh"

tiny 'samplers (cosine, light)   spp 2   seeds 3   runs 1   reference { spp 4   sampler cosine }'
study tiny.scn -o whole
ends "nobody damages it" 0
figures whole >expected
# Torn and edited lines.
resume() # WHAT STATUS [TEXT]
{
    study tiny.scn -o damaged
    ends "$1" "$2" "$3"
    [ -f damaged/journal.jsonl ] && figures damaged 2>/dev/null | grep run >after
}
again() { rm -rf damaged && cp -r whole damaged; }
again
size=$(wc -c <damaged/journal.jsonl)
grep run expected >expected_runs
wrong=
for cut in $(seq 1 97 "$size"); do
    again
    head -c $((size - cut)) whole/journal.jsonl >damaged/journal.jsonl
    study tiny.scn -o damaged
    figures damaged | grep run >after
    [ $status = 0 ] && cmp -s after expected_runs || wrong="$wrong $cut"
done
empty "a journal that ends anywhere" "$wrong"
again
sed -i '4s/"mse":./"mse":7/' damaged/journal.jsonl
resume "an edited line is not taken" 0 "1 lines of the journal are torn or damaged"
check "and that run is rendered again" test "$(grep -v '"mse":7' after | sort -u | cksum)" = "$(cksum <expected_runs)"
again
{ head -n 3 whole/journal.jsonl; head -c 3000 /dev/urandom; echo; echo '{"run":0}'; tail -n +4 whole/journal.jsonl; } >damaged/journal.jsonl
resume "garbage between lines is passed over" 0 "torn or damaged"
check "and no line of it is taken" test "$(sort -u after | grep -vxF '{"run":0}' | cksum)" = "$(cksum <expected_runs)"

# State files.
again
for file in damaged/state/*; do head -c 100 "$file" >x && mv x "$file"; done
resume "cut state files: the reference is rendered again, biases are unknown" 0 "their bias is unknown"
check "and told as such" test "$(grep -c '"bias_square": null' damaged/study.json)" = 2
again
for file in damaged/state/*; do size=$(wc -c <"$file"); head -c "$size" /dev/urandom >"$file"; done
resume "garbage in state files" 0 "their bias is unknown"
again
for file in damaged/state/*; do printf '\001' | dd of="$file" bs=1 seek=200 conv=notrunc 2>/dev/null; done
resume "one byte of a state file" 0 "their bias is unknown"
again
rm -r damaged/state damaged/images
resume "no state and no images" 0 "their bias is unknown"
again
cp damaged/state/*.parts x
for file in damaged/state/*.sums; do cp x "$file"; done
resume "a state file in the place of another" 0 "their bias is unknown"
again
rm damaged/journal.jsonl && mkfifo damaged/journal.jsonl
resume "a pipe in the place of the journal" 1
again
rm damaged/state/*.parts && mkdir "damaged/state/$(cd whole/state && ls ./*.parts)"
resume "a folder in the place of the reference" 1
finish
