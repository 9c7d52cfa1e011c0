#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# mcrender compare: its report, its statuses, its maps, what it refuses.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/cli/run.sh"

# said WHAT TEXT...: a point: the last run's standard output holds the texts, blanks squeezed
said()
{
    local what=$1 text
    shift
    for text; do
        tr -s ' ' <"$TMPDIR/stdout" | grep -qF -- "$text" && continue
        point 1 "$what" "stdout lacks '$text': $(cat "$TMPDIR/stdout" "$TMPDIR/stderr")"
        return
    done
    point 0 "$what"
}

# grey_pfm NAME WIDTH HEIGHT VALUE...: a grey PFM, little-endian, of the hexadecimal 32-bit floats given, repeated as often as needed
grey_pfm()
{
    local name=$1 width=$2 height=$3 i text=
    shift 3
    local -a words=("$@")
    for ((i = 0; i < width * height; i++)); do
        local w=${words[i % ${#words[@]}]}
        text+="\\x${w:6:2}\\x${w:4:2}\\x${w:2:2}\\x${w:0:2}"
    done
    { printf 'Pf\n%d %d\n-1\n' "$width" "$height"; printf "$text"; } >"$name"
}

half=3f000000 quarter=3e800000 nan=7fc00000
grey_pfm half.pfm 16 16 $half
grey_pfm quarter.pfm 16 16 $quarter
grey_pfm small.pfm 8 16 $half
grey_pfm nan.pfm 16 16 $nan $half $half $half $half $half $half $half
run glow.scn --quiet -o glow.ppm -o glow.pfm # 8 x 8, 0.25 everywhere
grey_pfm glow-grey.pfm 8 8 $quarter

# ---- the report ------------------------------------------------------------------------------------------------------------------------
run compare half.pfm quarter.pfm
ends "a comparison" 0
check "nothing on standard error" test ! -s "$TMPDIR/stderr"
said "the report" "image half.pfm" "reference quarter.pfm" "region 0,0,16,16 of 16x16 pixels; 256 pixels take part" \
    "values linear, peak 1; range 0.5 to 0.5, of the reference 0.25 to 0.25" "ms_ssim undefined: a side of the region is below 176"
said "its figures" "mse 0.0625" "rmse 0.25" "psnr 12.0412" "mean_ratio 2"
run compare half.pfm half.pfm
said "identical images" "psnr infinite" "psnr infinite: the values are the same"
run compare half.pfm quarter.pfm --quiet
equal "--quiet" "$status $(cat "$TMPDIR/stdout" "$TMPDIR/stderr")" "0 "
run compare --encoding srgb8 half.pfm quarter.pfm
said "--encoding srgb8" "values srgb8, peak 255; range 188 to 188, of the reference 137 to 137" "mae 51"
run compare half.pfm quarter.pfm --peak 0.5
said "--peak" "peak 0.5;" "psnr 6.0206"
run compare half.pfm quarter.pfm --crop 2,3,10,7
said "--crop" "region 2,3,10,7 of 16x16 pixels; 32 pixels take part" "ssim undefined: a side of the region is below 11"
run compare glow.pfm glow.ppm
ends "PFM and PPM" 0
said "colours" "whole R G B luminance" # code 137 is 0.2502, 0.25 to half a code
"$MCRENDER" compare - quarter.pfm <half.pfm >"$TMPDIR/stdout" 2>"$TMPDIR/stderr"
status=$?
ends "standard input" 0
said "standard input: its figures" "mse 0.0625"
cp half.pfm ./-odd.pfm
run compare -- -odd.pfm half.pfm
ends "names that begin with -" 0

# ---- JSON ------------------------------------------------------------------------------------------------------------------------------
run compare glow.pfm glow.ppm --json
cp "$TMPDIR/stdout" c.json
for key in mse rmse mae relmse smape psnr snr snr_variance ssim ms_ssim mean_ratio; do
    check "JSON: $key, five times" test "$(grep -c "^ *\"$key\": [-0-9n]" c.json)" = 5
done
for key in R G B luminance channels range notes not_finite; do check "JSON: $key" grep -q "\"$key\": {" c.json; done
equal "JSON: the whole stands first" "$(grep -n -m 1 '"mse"' c.json | cut -d: -f1) before" "$(awk '/"mse"/ { m = NR } /"channels"/ && m { print m " before"; exit }' c.json)"
equal "JSON: what was compared" "$(for key in image reference width height pixels peak encoding; do value $key c.json; done | tr '\n' ' ')" \
    "glow.pfm glow.ppm 8 8 64 1 linear "
equal "JSON: the region" "$(grep -c '"region": \[0, 0, 8, 8\]' c.json)" 1
run compare half.pfm half.pfm --json
equal "JSON: infinite is null with a note" "$(value psnr "$TMPDIR/stdout") $(grep -c '"psnr": "infinite: ' "$TMPDIR/stdout")" "null 3"
valid=
if python3 -c pass 2>/dev/null; then valid="python3 -m json.tool"; elif jq -n 1 >/dev/null 2>&1; then valid="jq ."; fi
if [ -n "$valid" ]; then check "it is JSON" bash -c "$valid <c.json"; else skip "it is JSON" "neither python3 nor jq"; fi

# ---- limits ----------------------------------------------------------------------------------------------------------------------------
limit() # what status option...
{
    local what=$1 wanted=$2
    shift 2
    run compare half.pfm quarter.pfm --quiet "$@"
    ends "--fail-above: $what" "$wanted"
}
limit "kept" 0 --fail-above mse=0.0625
limit "exceeded" 4 --fail-above mse=0.0624
limit "one of several" 4 --fail-above mse=1 --fail-above=mae=0.1 --fail-above psnr=3
limit "all kept" 0 --fail-above mse=1 --fail-above mae=0.3 --fail-above psnr=12 --fail-above ssim=0.5
limit "psnr: less is worse" 4 --fail-above psnr=13
limit "ssim: less is worse" 4 --fail-above ssim=0.9
limit "mean_ratio: by its distance from 1" 4 --fail-above mean_ratio=0.99
limit "mean_ratio: kept" 0 --fail-above mean_ratio=1
limit "an undefined metric" 4 --fail-above ms_ssim=0
ends "and it is told" 4 "ms_ssim has a limit and is undefined: a side of the region is below 176"
run compare half.pfm half.pfm --fail-above psnr=1e300 --fail-above snr=99
ends "infinite decibels exceed no limit" 0
said "the report tells limits" "limit psnr at least 1e+300: kept"
run compare half.pfm quarter.pfm --json --fail-above mse=0.01
equal "limits in JSON" "$status $(value metric "$TMPDIR/stdout") $(value exceeded "$TMPDIR/stdout")" "4 mse true"

# ---- not finite ------------------------------------------------------------------------------------------------------------------------
run compare nan.pfm half.pfm
ends "NaN" 1 "'nan.pfm' and 'half.pfm' cannot be compared: 32 values of the image and 0 of the reference are NaN or infinite" "--exclude-nonfinite"
check "NaN: nothing on standard output" test ! -s "$TMPDIR/stdout"
run compare nan.pfm half.pfm --exclude-nonfinite
ends "NaN: left out" 0
said "NaN: counted" "224 pixels take part" "32 values of the image and 0 of the reference"

# ---- masks -----------------------------------------------------------------------------------------------------------------------------
printf 'P2\n16 16\n255\n' >mask.pgm
for ((i = 0; i < 16; i++)); do echo "0 0 0 0 0 0 0 0 255 255 255 255 1 1 1 1"; done >>mask.pgm
run compare half.pfm quarter.pfm --mask mask.pgm
ends "a mask" 0
said "a mask: its pixels" "mask mask.pgm; 128 pixels take part" "ms_ssim undefined"

# ---- maps ------------------------------------------------------------------------------------------------------------------------------
run compare half.pfm quarter.pfm --map map.ppm --map map.pfm
ends "maps" 0
said "maps are told" "map map.ppm: absolute error in false colours from 0 to 0.25" "map map.pfm: absolute error"
run compare map.pfm quarter.pfm
said "a raw map holds the errors" "mse 0"
run compare quarter.pfm half.pfm --map signed.pfm --map signed.ppm --map-kind signed --map-range 2
said "signed, and its range" "signed error in false colours from -2 to 2"
run compare signed.pfm quarter.pfm
said "a signed map" "mean_ratio -1"
run compare half.pfm half.pfm --map zero.ppm
said "no error at all: the range is the peak" "from 0 to 1"
run compare half.pfm quarter.pfm --mask mask.pgm --map masked.pfm
run compare masked.pfm quarter.pfm --exclude-nonfinite
said "outside the mask a raw map is NaN" "128 pixels take part" "mse 0"
before=$(cat half.pfm | cksum)
ln -s half.pfm link.pfm
ln half.pfm hard.pfm
for name in half.pfm ./half.pfm link.pfm hard.pfm quarter.pfm; do
    run compare half.pfm quarter.pfm --map $name
    ends "a map over an input: $name" 2 "is one of the images"
done
run compare half.pfm quarter.pfm --mask mask.pgm --map mask.pgm
ends "a map over the mask" 2 "is one of the images"
equal "the input is whole" "$(cat half.pfm | cksum)" "$before"
run compare half.pfm quarter.pfm --map twice.ppm --map ./twice.ppm
ends "one file for two maps" 2 "the same file"
run compare half.pfm quarter.pfm --map missing/map.ppm
ends "a map that cannot be written" 1 "cannot write 'missing/map.ppm'"
check "which is known before the work" test ! -s "$TMPDIR/stdout"
listed=$(listing)
run compare half.pfm small.pfm --map never.ppm --map -
ends "a map on standard output" 2 "--map - is not possible"
run compare half.pfm small.pfm --map never.ppm
equal "a comparison that fails writes no map" "$status $(listing)" "1 $listed"
if [ -c /dev/full ]; then
    run compare half.pfm quarter.pfm --map /dev/full
    ends "a full disk" 1 "No space left"
    "$MCRENDER" compare half.pfm quarter.pfm >/dev/full 2>"$TMPDIR/stderr"
    status=$?
    ends "a full standard output" 1 "standard output could not be written"
    "$MCRENDER" compare half.pfm quarter.pfm --json >/dev/full 2>"$TMPDIR/stderr"
    status=$?
    ends "a full standard output, JSON" 1 "standard output could not be written"
fi

# ---- what is refused -------------------------------------------------------------------------------------------------------------------
run compare half.pfm small.pfm
ends "different sizes" 1 "different sizes: the image has 16x16 pixels, the reference 8x16"
run compare glow.pfm glow-grey.pfm
ends "different channels" 1 "different channels: the image has R, G, B, the reference one grey channel"
run compare half.pfm missing.pfm
ends "a missing file" 1 "cannot read 'missing.pfm': No such file"
run compare half.pfm glow.scn
ends "a file that is no image" 1 "cannot read 'glow.scn'"
run compare half.pfm .
ends "a folder" 1 "it is a folder"
head -c 500 half.pfm >cut.pfm
run compare half.pfm cut.pfm
ends "a file that is cut off" 1 "cannot read 'cut.pfm'"
printf 'Pf\n65536 65536\n-1\n' >huge.pfm
run compare huge.pfm half.pfm
ends "a file that claims to be huge" 1 "cannot read 'huge.pfm'"
: >empty.pfm
run compare half.pfm empty.pfm
ends "an empty file" 1 "it is empty"
run compare half.pfm quarter.pfm --crop 0,0,17,16
ends "a crop beyond the images" 1 "reaches beyond the images"
run compare half.pfm quarter.pfm --mask small.pfm
ends "a mask of another size" 1 "the mask has 8x16 pixels"

usage() # what text argument...
{
    local what=$1 text=$2
    shift 2
    run compare "$@"
    ends "$what" 2 "$text"
    check "$what: nothing on standard output" test ! -s "$TMPDIR/stdout"
}
usage "no image" "an image and a reference are expected"
usage "one image" "an image and a reference are expected" half.pfm
usage "three images" "two images are expected: 'half.pfm' follows 'quarter.pfm'" half.pfm quarter.pfm half.pfm
usage "standard input twice" "standard input holds one image only" - -
usage "an unknown option" "unknown option '--josn', did you mean '--json'?" half.pfm half.pfm --josn
usage "an ambiguous option" "'--ma' may be '--m" half.pfm half.pfm --ma map.ppm
usage "an unknown metric" "--fail-above does not know 'psrn', did you mean 'psnr'?" half.pfm half.pfm --fail-above psrn=3
usage "a metric far from any" "expected mse, rmse, mae," half.pfm half.pfm --fail-above beauty=3
usage "a limit without a value" "--fail-above expects METRIC=VALUE" half.pfm half.pfm --fail-above mse
usage "a limit that is no number" "not '1x'" half.pfm half.pfm --fail-above mse=1x
usage "a limit that is NaN" "not 'nan'" half.pfm half.pfm --fail-above mse=nan
usage "an unknown encoding" "--encoding does not know 'srgb', did you mean 'srgb8'?" half.pfm half.pfm --encoding srgb
usage "an unknown kind" "--map-kind does not know 'sined'" half.pfm half.pfm --map x.ppm --map-kind sined
usage "a peak of 0" "--peak expects a number from 1e-30 to 1e+30, not '0'" half.pfm half.pfm --peak 0
usage "a confidence of 1" "--confidence expects" half.pfm half.pfm --confidence 1
usage "an empty crop" "is empty" half.pfm half.pfm --crop 4,4,4,8
usage "a bad crop" "--crop expects X0,Y0,X1,Y1" half.pfm half.pfm --crop 4,4,8
usage "a range without a map" "--map-range needs --map" half.pfm half.pfm --map-range 1
usage "a value missing" "--peak expects VALUE" half.pfm half.pfm --peak
usage "a value too many" "--json takes no value" half.pfm half.pfm --json=1
run compare --help
ends "--help" 0
check "--help: 24 lines of 80 columns" awk 'length > 80 { bad = 1 } END { exit bad || NR > 24 || NR < 10 }' "$TMPDIR/stdout"
check "the options of the manual" diff <(grep -oE '^  --[-a-z]+' "$TMPDIR/stdout" | tr -d ' ' | sort) \
    <(sed -n 's/^\.It Fl Fl \([a-z-]*\).*/--\1/p' "$srcdir/man/mcrender-compare.1" | sort)

# ---- other formats, variance -----------------------------------------------------------------------------------------------------------
if [ ! -f "$MCRENDER_MODULE_PATH/oiio.so" ]; then
    skip "EXR and PNG" "OpenImageIO's module is not built"
    run compare half.pfm quarter.pfm --map map.png
    ends "a PNG map without the module" 1 "needs OpenImageIO"
    finish
fi
box=$srcdir/scenes/cornell-box.scn
for seed in 1 2; do run "$box" --size 48x48 --spp 32 --seed $seed --quiet --layers variance -o s$seed.exr -o s$seed.png -o s$seed.pfm; done
run compare s1.exr s1.pfm
said "EXR and PFM hold the same" "mse 0" "bias not tested: the reference has no variance layers"
run compare s1.png s1.pfm --encoding srgb8
said "so do PNG and PFM, as codes" "mse 0"
run compare s1.exr s2.exr --json
cp "$TMPDIR/stdout" bias.json
equal "two seeds estimate the same" "$(value verdict bias.json) $(value dependent bias.json) $(value expected_share bias.json)" "same false 0.05"
check "in each channel, at most the share by chance and its error" awk -F '[:,]' '
    /"share"/ { n++; share = $2 } /"tested"/ { if (share > 0.05 + 4 * sqrt(0.05 * 0.95 / $2)) bad = 1 } END { exit bad || n != 4 }' bias.json
run compare s1.exr s2.exr
for key in $(sed -n 's/^ *"\([a-z_]*\)": .*/\1/p' bias.json c.json | sort -u); do
    # within the section of the manual, as a word of its own
    check "the key $key is in the manual" bash -c "sed -n '/^\.Sh METRICS/,\$p' '$srcdir/man/mcrender-compare.1' | grep -E '^\.(It )?Cm|^\.Cm' | grep -qw '$key'"
done
said "in words" "bias same: " "% of " "5 % at most expected by chance"
run compare s1.exr s1.exr
said "one seed twice" "do they have a seed in common?"
run "$box" --size 48x48 --spp 32 --seed 3 --sampler light --quiet --layers variance -o light.exr
run compare light.exr s2.exr --json --confidence 0.99
equal "a biased sampler is caught" "$status $(value verdict "$TMPDIR/stdout") $(value confidence "$TMPDIR/stdout")" "0 different 0.99"
run compare light.exr s2.exr --map e.exr --map e.png --map-kind signed
said "in words" "bias different: the images do not estimate the same thing"
run compare e.exr s1.exr
ends "an EXR map is read again" 0
head -c 3000 s1.exr >cut.exr
run compare cut.exr s1.exr
ends "an EXR that is cut off" 1 "cannot read 'cut.exr'"
finish
