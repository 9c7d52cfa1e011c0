#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Plugins that fail: samples that are not finite are counted, located and told; an operation that fails ends the render with its text.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/cli/run.sh"
compile_plugin nan || { point 1 "nan.c compiles"; finish; }

# picture SHARE FAILS SHAPE: 8 x 8 pixels of one unit each, seen from above; the upper left one has its corner at (-4, 4)
picture()
{
    cat <<TEXT
mcrender 1
camera orthographic { from (0, 0, 5)   to (0, 0, 0)   height 8 }
film { size (8, 8) }
render { sampler cosine   spp 64   depth 0 }
material flawed nan { share $1   fails $2 }
material lamp emitter { radiance 1 }
quad { corner (-9, -9, 0)   u (18, 0, 0)   v (0, 18, 0)   material lamp }
$3
TEXT
}

# Pixel (5, 2) alone, a hand before the rest.
picture 1 no 'quad { corner (1.01, 1.01, 1)   u (0.98, 0, 0)   v (0, 0.98, 0)   material flawed }' >pixel.scn
run pixel.scn --plugin "$TMPDIR/nan.so" --quiet -o pixel.pfm -o pixel.ppm --report pixel.json
ends "one pixel: told in spite of --quiet" 0 "warning: " " samples were not finite and count as black; the first: pixel 5,2 sample "
count=$(value not_finite pixel.json)
# The share .98^2 of 64 samples: within 4 standard errors, 1.56 each
check "one pixel: counted, $count" test "${count:-0}" -ge 55 -a "${count:-0}" -le 64
equal "one pixel: located in JSON" "$(value x pixel.json),$(value y pixel.json)" 5,2
check "one pixel: the sample that is named is in range" test "$(value sample pixel.json)" -lt 64
equal "one pixel: black counts, exactly" "$(value luminance pixel.json)" "$(awk -v n="$count" 'BEGIN { printf "%.17g", 1 - n / 4096 }')"
equal "one pixel: the picture is finite" "$(sed -n 's/.*"not_finite": \([0-9]*\)$/\1/p' pixel.json | tr '\n' ' ')" "0 0 "

# A tenth of all points: 409.6 of 4096 samples, standard deviation 19.2.
picture 0.1 no 'quad { corner (-9, -9, 1)   u (18, 0, 0)   v (0, 18, 0)   material flawed }' >tenth.scn
run tenth.scn --plugin "$TMPDIR/nan.so" -o tenth.pfm --report tenth.json
ends "a tenth: told" 0 "samples were not finite" "loaded" "nan"
count=$(value not_finite tenth.json)
check "a tenth: counted, $count" awk -v n="$count" 'BEGIN { z = (n - 409.6) / 19.2; exit !(z >= -4 && z <= 4) }'
equal "a tenth: black counts, exactly" "$(value luminance tenth.json)" "$(awk -v n="$count" 'BEGIN { printf "%.17g", 1 - n / 4096 }')"
where="$(value x tenth.json) $(value y tenth.json) $(value sample tenth.json)"
for how in "--threads 1" "--threads 7" "--batch 8" "--batch 4096 --threads 2" "--isa baseline" "--accel bvh"; do
    run tenth.scn --plugin "$TMPDIR/nan.so" --quiet $how -o other.pfm --report other.json
    equal "a tenth, $how: the same count and place" "$(value not_finite other.json) $(value x other.json) $(value y other.json) $(value sample other.json)" \
        "$count $where"
    check "a tenth, $how: the same bits" cmp tenth.pfm other.pfm
done
run tenth.scn --plugin "$TMPDIR/nan.so" --quiet --crop 3,4,7,8 -o other.pfm --report other.json
check "a crop: located in the whole picture" test "$(value x other.json)" -ge 3 -a "$(value y other.json)" -ge 4

# ---- a sampler that draws or tells what cannot be: a tenth of its directions ----
compile_plugin astray || { point 1 "astray.c compiles"; finish; }
cat >astray.scn <<'TEXT'
mcrender 1
camera orthographic { from (0, 0, 5)   to (0, 0, 0)   height 8 }
film { size (8, 8) }
render { spp 64   depth 1   background 1 }
material grey lambert { albedo 0.5 }
quad { corner (-9, -9, 0)   u (18, 0, 0)   v (0, 18, 0)   material grey }
TEXT
for fault in nan-density negative-density infinite-density nan-direction long-direction; do
    for way in "astray(fault=$fault)" "stratified(astray(fault=$fault))" "mixture(astray(fault=$fault) 1)"; do
        run astray.scn --plugin "$TMPDIR/astray.so" --sampler "$way" --quiet -o astray.pfm --report astray.json
        ends "$way: told" 0 "samples were not finite and count as black; the first: pixel "
        count=$(value not_finite astray.json)
        check "$way: counted, $count" awk -v n="$count" 'BEGIN { z = (n - 409.6) / 19.2; exit !(z >= -4 && z <= 4) }'
    done
done
run astray.scn --plugin "$TMPDIR/astray.so" --sampler "mixture(astray 1, uniform 1)" --quiet -o astray.pfm --report astray.json
ends "a child's density: told" 0 "samples were not finite"

# ---- an operation that fails --------------------------------------------------------------------------------------------------------------
picture 0 yes 'quad { corner (1.01, 1.01, 1)   u (0.98, 0, 0)   v (0, 0.98, 0)   material flawed }' >broken.scn
: >old.ppm
for threads in 1 3; do
    run broken.scn --plugin "$TMPDIR/nan.so" --threads $threads -o old.ppm -o new.ppm --report new.json
    ends "a failure, $threads threads" 1 "error: " "the filament is broken" "nan"
done
equal "a failure: old files are untouched, new ones not made" "$(wc -c <old.ppm) $(ls new.* 2>&1 | grep -c '^new')" "0 0"
run check broken.scn --plugin "$TMPDIR/nan.so"
ends "check does not render" 0

# ---- which plugins are found --------------------------------------------------------------------------------------------------------------
run tenth.scn --quiet -o a.ppm
ends "without --plugin" 3 "tenth.scn:5:17: error: unknown material 'nan'"
MCRENDER_PLUGIN_PATH=$MCRENDER_PLUGIN_PATH:$TMPDIR run plugins nan
check "plugins: through MCRENDER_PLUGIN_PATH" grep -q 'a faulty lamp' "$TMPDIR/stdout"
run plugins nan --plugin "$TMPDIR/nan.so"
check "plugins --plugin" grep -q 'a faulty lamp' "$TMPDIR/stdout"
mkdir -p home/.local/share/mcrender-1/plugins && cp "$TMPDIR/nan.so" home/.local/share/mcrender-1/plugins
HOME=$PWD/home run plugins nan
check "plugins: the user's folder" grep -q 'a faulty lamp' "$TMPDIR/stdout"
echo 'no plugin at all' >text.so
run glow.scn --quiet --plugin ./text.so -o a.ppm
ends "--plugin with a file that is none" 3 "text.so"
finish
