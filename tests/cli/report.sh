#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# What a render tells: text on stderr, JSON, progress, metadata, memory.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/cli/run.sh"
box=$srcdir/scenes/cornell-box.scn

# ---- text ------------------------------------------------------------------------------------------------------------------------------
run glow.scn --quiet -o a.ppm
equal "--quiet prints nothing" "$status $(cat "$TMPDIR/stdout" "$TMPDIR/stderr")" "0 "
run "$box" --size 16x16 --spp 8 --threads 1 -o a.ppm
ends "the report" 0 "scene " "sampler " "loaded " "coverage  complete" "time " "parse " "build " "render " "write " "work " "rays/s" "memory " "error " \
    "efficiency" "wrote     a.ppm"
check "nothing on standard output" test ! -s "$TMPDIR/stdout"
check "no progress and no colour without a terminal" bash -c '! LC_ALL=C grep -q "$(printf "[\r\033]")" "$1"' - "$TMPDIR/stderr"
refute "no stages without --profile" grep -q '^stages' "$TMPDIR/stderr"
run "$box" --size 16x16 --spp 8 --profile -o a.ppm
ends "--profile: the stages" 0 "stages " "camera " "hit " "surface " "sampler " "material " "film "
run "$box" --size 16x16 --spp 1 -o a.ppm
ends "one sample: the error is unknown, not invented" 0 "error     unknown: one sample"
sed 's/sampler cosine/sampler stratified(cosine)   replicates 1/' glow.scn >replicate.scn
run replicate.scn -o a.ppm --report one.json
ends "correlated numbers, one replicate: the error is unknown" 0 "error     unknown: the numbers are correlated"
run "$box" --size 16x16 --spp 16 --sampler 'stratified(cosine)' -o a.ppm --report two.json
ends "correlated numbers, two replicates: their error" 0 "2 replicates of 8 samples" "error     relative "
equal "correlated numbers, two replicates, in JSON" "$(value replicates two.json) $(value error_known two.json)" "2 true"
run "$box" --size 16x16 --spp 4 --sampler light --quiet -o a.ppm --report light.json
ends "light alone is incomplete, in spite of --quiet" 0 "warning: this sampler alone does not estimate the whole image"
equal "light alone is incomplete, in JSON" "$(value complete light.json)" false
check "what it misses, in JSON" test -n "$(value missing light.json)"

run glow.scn --compat clamp --quiet -o a.ppm --report biased.json
ends "a quirk is told, in spite of --quiet" 0 "warning: this picture is biased on purpose: compat clamp"
equal "a quirk, in JSON" "$(value compat biased.json) $(value biased biased.json)" "clamp true"
run glow.scn --compat clamp -o a.ppm
ends "a quirk, in the report" 0 "compat    BIASED on purpose: clamp"
run glow.scn --compat floor-sqrt -o a.ppm --report none.json
ends "a quirk that finds nothing is told" 0 "warning: compat 'floor-sqrt' has no effect here"
equal "it is not in force" "$(value compat none.json) $(value biased none.json)" "none false"

# Radiance 4 is beyond white: every value of the picture. 2^100 is beyond half and 32-bit floats hold it, 2^1000 they do not.
run glow.scn --set glow=4 -o over.ppm -o over.pfm --report over.json
ends "clipped values are told" 0 "wrote     over.ppm (192 values beyond the format's range were clipped)"
equal "clipped values, in JSON" "$(sed -n 's/.*"overflowed": //p' over.json | tr '\n' ' ')" "192, 0, "
run glow.scn --set glow='2^100 * 2^100' -o over.pfm
ends "values beyond 32-bit floats" 0 "wrote     over.pfm (192 values beyond the format's range were clipped)"
run glow.scn --set glow=4 --exposure -2 -o over.ppm --report over.json
equal "--exposure brings them back" "$(value overflowed over.json)" 0

# ---- JSON ------------------------------------------------------------------------------------------------------------------------------
run "$box" --size 16x12 --spp 8 --seed 5 --threads 2 --profile --quiet -o a.ppm -o b.pfm --report r.json
valid=
if python3 -c pass 2>/dev/null; then valid="python3 -m json.tool"; elif jq -n 1 >/dev/null 2>&1; then valid="jq ."; fi
for file in r.json one.json light.json; do
    if [ -n "$valid" ]; then check "$file is JSON" bash -c "$valid <$file"; else skip "$file is JSON" "neither python3 nor jq"; fi
done
for key in parse build render render_cpu write rays camera_rays bounce_rays shadow_rays scatterings samples rays_per_second peak_memory luminance \
    standard_error relative_error mse sample_variance efficiency not_finite hash camera hit surface sampler material film seed version path; do
    check "JSON has $key" grep -q "^ *\"$key\": [^ ]" r.json
done
check "no stages without --profile" bash -c '! grep -q "\"stages\"" one.json'
equal "JSON: unknown errors are left out" "$(value error_known one.json) $(value mse one.json)" "false "
equal "JSON: samples" "$(value samples r.json)" $((16 * 12 * 8))
equal "JSON: camera rays" "$(value camera_rays r.json)" $((16 * 12 * 8))
equal "JSON: all rays" "$(value rays r.json)" $(($(value camera_rays r.json) + $(value bounce_rays r.json) + $(value shadow_rays r.json)))
equal "JSON: what was loaded" "$(sed -n 's/^ *"name": "\(.*\)",/\1/p' r.json | sort | tr '\n' ' ')" "cosine emitter independent lambert light mixture "
equal "JSON: the outputs" "$(sed -n 's/.*"written": \(.*\),/\1/p' r.json | tr '\n' ' ')" "true true "
check "JSON: efficiency is 1/(MSE t)" awk -v e="$(value efficiency r.json)" -v m="$(value mse r.json)" -v t="$(value render r.json | head -n 1)" \
    'BEGIN { q = e * m * t; exit !(q > 0.999999 && q < 1.000001) }'
check "JSON: relative error is the root of the MSE over the mean" awk -v r="$(value relative_error r.json)" -v m="$(value mse r.json)" \
    -v l="$(value luminance r.json)" 'BEGIN { q = r * l / sqrt(m); exit !(q > 0.999999 && q < 1.000001) }'
check "JSON: rays a second" awk -v r="$(value rays r.json)" -v s="$(value rays_per_second r.json)" -v t="$(value render r.json)" \
    'BEGIN { q = s * t / r; exit !(q > 0.999999 && q < 1.000001) }'
run glow.scn --quiet -o a.ppm --report same.json
equal "JSON: no noise, infinite efficiency" "$(value mse same.json) $(value efficiency same.json)" "0 null"
"$MCRENDER" "$box" --size 16x16 --spp 2 --quiet -o /dev/full --report failed.json 2>/dev/null
equal "JSON: a picture that failed" "$? $(value written failed.json)" "1 false"
cp glow.scn "$(printf 'a\tb"\\\303\244.scn')"
run "$(printf 'a\tb"\\\303\244.scn')" --quiet -o a.ppm --report odd.json
equal "JSON: odd file names" "$(grep '"file"' odd.json)" "$(printf '    "file": "a\\tb\\"\\\\\303\244.scn",')"

# The mean of the picture is what the report says: 8-byte PFM header lines, then floats; grey.
equal "JSON: the mean" "$(value luminance same.json)" 0.25

# ---- a terminal ------------------------------------------------------------------------------------------------------------------------
if script -qec true /dev/null >/dev/null 2>&1 </dev/null; then
    # 4 million paths: progress is shown ten times a second, and comes at least once after a pass
    script -qec "'$MCRENDER' '$box' --size 32x32 --spp 4000 --depth 3 -o t.ppm" /dev/null >tty </dev/null
    check "a terminal: progress with ETA" grep -q 'ETA [0-9]* s' tty
    check "a terminal: the report follows" grep -q 'wrote     t.ppm' tty
    script -qec "'$MCRENDER' '$box' --size 32x32 --spp 4000 --depth 3 -o t.ppm --quiet" /dev/null >tty </dev/null
    check "a terminal: --quiet shows no progress" test ! -s tty
    printf 'mcrender 1\nsphere { raduis 3 }\n' >bad.scn
    script -qec "TERM=xterm '$MCRENDER' bad.scn" /dev/null >tty </dev/null
    check "a terminal: errors have colours" grep -q "$(printf '\033')" tty
    script -qec "TERM=xterm NO_COLOR=1 '$MCRENDER' bad.scn" /dev/null >tty </dev/null
    check "a terminal: NO_COLOR" bash -c '! grep -q "$1" tty' - "$(printf '\033')"
    script -qec "TERM=dumb '$MCRENDER' bad.scn" /dev/null >tty </dev/null
    check "a terminal: TERM=dumb" bash -c '! grep -q "$1" tty' - "$(printf '\033')"
    script -qec "'$MCRENDER' glow.scn -o -" /dev/null >tty </dev/null
    check "a terminal: no picture on it" grep -q 'standard output is a terminal' tty
else
    skip "a terminal" "no script(1) of util-linux"
fi

# ---- metadata --------------------------------------------------------------------------------------------------------------------------
described=
if oiiotool --version >/dev/null 2>&1; then described="oiiotool --info -v"; elif iinfo --help >/dev/null 2>&1; then described="iinfo -v"; fi
if [ ! -f "$MCRENDER_MODULE_PATH/oiio.so" ]; then
    skip "EXR metadata" "OpenImageIO's module is not built"
elif [ -z "$described" ]; then
    skip "EXR metadata" "neither oiiotool nor iinfo"
else
    run "$box" --size 16x16 --spp 8 --depth 7 --seed 9007199254740992 --quiet -o m.exr -o m.png --report m.json
    $described m.exr >described 2>&1
    for text in 'mcrender:version: "' "mcrender:scene: \"$(value hash m.json)\"" 'mcrender:sampler: "mixture(cosine 1, light 1)"' 'mcrender:spp: "8"' \
        'mcrender:depth: "7"' 'mcrender:seed: "9007199254740992"' 'mcrender:precision: "double"' 'mcrender:accelerator: "list"' \
        'mcrender:coverage: "complete"' 'chromaticities: 0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329' oiio:ColorSpace 'channel list: R, G, B'; do
        check "EXR: $text" grep -qF "$text" described
    done
    refute "EXR: no quirk" grep -q 'mcrender:compat\|mcrender:biased' described
    run "$box" --size 16x16 --spp 4 --compat clamp,background-at-limit --quiet -o q.exr
    $described q.exr >described 2>&1
    for text in 'mcrender:biased: "true"' 'mcrender:compat: "clamp, background-at-limit"'; do check "EXR: $text" grep -qF "$text" described; done
fi

# ---- a scene that names no sampler --------------------------------------------------------------------------------------------------------
for what in 'sobol(nee)|quad { corner (-1, -1, 2)   u (0, 2, 0)   v (2, 0, 0)   material lamp }' 'sobol(bsdf)|plane { point (0, 0, 2)   normal (0, 0, -1)   material lamp }' \
    'sobol(bsdf)|sphere { center (0, 0, 0)   radius 0.5   material white }'; do
    printf '%s\n' 'mcrender 1' 'camera perspective { from (0, 0, 1)   to (0, 0, 0)   up (0, 1, 0)   fov 40 }' 'material white lambert { albedo 0.5 }' \
        'material lamp emitter { radiance 1 }' 'plane { point (0, 0, 0)   normal (0, 0, 1)   material white }' "${what#*|}" >chosen.scn
    run chosen.scn --size 4x4 --report c.json -o c.ppm
    check "${what%%|*} is chosen, and told" grep -qF "sampler   ${what%%|*} (chosen for this scene, which names none); " "$TMPDIR/stderr"
    check "and in JSON" grep -q '"sampler_chosen": true' c.json
    run chosen.scn --size 4x4 --report c.json -o c.ppm --sampler uniform
    check "a sampler that is named is not called chosen" test "$(grep -c '(chosen\|"sampler_chosen": true' "$TMPDIR/stderr" c.json | sed 's/.*://' | paste -sd' ')" = '0 0'
done

# ---- memory ----------------------------------------------------------------------------------------------------------------------------
if [ "$MCR_SANITIZED" = 1 ]; then
    skip "memory" "sanitizers take their own"
else
    for threads in 1 2; do
        run "$box" --quiet --size 512x512 --spp 1 --threads $threads -o m.ppm --report m.json
        memory=$(value peak_memory m.json)
        check "$threads threads, 512 x 512, PPM: $memory bytes are below 64 MB" test "$memory" -gt 1000000 -a "$memory" -lt 64000000
    done
fi
finish
