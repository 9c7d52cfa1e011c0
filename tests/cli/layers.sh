#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# --layers: which files hold them, and what is refused before the first ray.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/cli/run.sh"
box=$srcdir/scenes/cornell-box.scn

# refused WHAT TEXT ARGUMENT...: status 2, that text, and no file is made
refused()
{
    local what=$1 text=$2 before
    shift 2
    before=$(listing)
    run "$box" --size 8x8 "$@" --layers variance
    ends "$what" 2 "mcrender: error: --layers" "$text"
    equal "$what: no file is made" "$(listing)" "$before"
}
refused "PPM holds no layers" "'a.ppm' cannot hold layers" -o a.ppm --spp 4
refused "nor does standard output" "'-' cannot hold layers" -o - --spp 4
refused "nor PFM" "'a.pfm' cannot hold layers" -o a.pfm --spp 4
run "$box" --layers varience -o a.ppm
ends "a layer that is unknown" 2 "--layers does not know 'varience', did you mean 'variance'?"
run "$box" --layers variance --size 5000x2000 -o a.exr
ends "the layer counts for the film's memory" 3 "needs 1221 MiB, at most 1024 MiB"

if [ ! -f "$MCRENDER_MODULE_PATH/oiio.so" ]; then
    skip "EXR" "OpenImageIO's module is not built"
    finish
fi
export SOURCE_DATE_EPOCH=1
refused "one sample" "one sample per pixel tells nothing of its variance" -o a.exr --spp 1
refused "one replicate" "--replicates 2" -o a.exr --spp 4 --sampler 'stratified(cosine)'
run "$box" --size 8x8 --spp 4 --layers variance -o a.exr -o a.png
ends "EXR holds the layer, PNG beside it the picture" 0 "wrote     a.exr with layers" "wrote     a.png"
refute "PNG does not say that it holds layers" grep -q 'a.png with layers' "$TMPDIR/stderr"
run "$box" --size 8x8 --spp 4 -o plain.exr -o plain.png
check "PNG is the same as without layers" cmp a.png plain.png
run "$box" --size 8x8 --spp 4 --layers depth -o a.ppm
ends "PPM holds no depth" 2 "mcrender: error: --layers: 'a.ppm' cannot hold layers"
run "$box" --size 3000x2000 --layers albedo,normal,depth,id,direct -o big.exr
ends "layers of features count for the film's memory" 3 "MiB, at most 1024 MiB"
every=id,indirect,albedo,normal,depth,variance,direct
run "$box" --size 24x16 --spp 21 --seed 3 --layers $every -o every.exr
ends "every layer" 0 "wrote     every.exr with layers"
for way in "--threads 1" "--threads 7" "--batch 1" "--batch 1000" "--isa baseline"; do
    run "$box" --size 24x16 --spp 21 --seed 3 --layers $every $way -o way.exr
    check "the same bits with $way" cmp every.exr way.exr
done
run "$box" --size 24x16 --spp 21 --seed 3 -o every.pfm
run compare every.exr every.pfm --fail-above mse=0
equal "the picture is the same with every layer" "$status" 0
run "$box" --size 24x16 --spp 64 --adaptive --layers $every -o rounds.exr -o rounds.pfm
ends "every layer, where pixels differ in samples" 0 "wrote     rounds.exr with layers" "adaptive: "
run compare rounds.exr rounds.pfm --fail-above mse=0
equal "the picture of it" "$status" 0
run "$box" --size 8x8 --spp 1 --layers depth -o one.exr
ends "one sample is enough for depth" 0 "wrote     one.exr with layers"
run "$box" --size 8x8 --spp 7 --sampler 'stratified(cosine)' --replicates 3 --layers variance -o r.exr
ends "replicates" 0 "wrote     r.exr with layers"

described=
if oiiotool --version >/dev/null 2>&1; then described="oiiotool --info -v"; elif iinfo --help >/dev/null 2>&1; then described="iinfo -v"; fi
if [ -z "$described" ]; then
    skip "what the EXR says" "neither oiiotool nor iinfo"
else
    check "channels" bash -c "$described a.exr | grep -q 'channel list: R, G, B, variance.R, variance.G, variance.B, variance.Y'"
    check "units: samples" bash -c "$described a.exr | grep -q 'mcrender:units: \"4\"'"
    check "units: replicates" bash -c "$described r.exr | grep -q 'mcrender:units: \"3\"'"
    refute "no units without the layer" bash -c "$described plain.exr | grep -q mcrender:units"
    for channel in R G B variance.R variance.Y albedo.R albedo.G albedo.B N.X N.Y N.Z Z id direct.R direct.B indirect.G; do
        check "every layer: $channel" bash -c "$described every.exr | grep 'channel list' | grep -qw -- '$channel'"
    done
    check "the materials' names" bash -c "$described every.exr | grep -q 'mcrender:materials: \"red green white lamp\"'"
    refute "no names without ids" bash -c "$described one.exr | grep -q mcrender:materials"
    check "no layer without asking" bash -c "$described plain.exr | grep -q 'channel list: R, G, B\$'"
fi
finish
