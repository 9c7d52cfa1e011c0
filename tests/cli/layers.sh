#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# --layers variance: which files hold it, and what is refused before the first ray.
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
    check "no layer without asking" bash -c "$described plain.exr | grep -q 'channel list: R, G, B\$'"
fi
finish
