#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# What varies over surfaces: coordinates of every shape, textures in materials and on lights, normal maps, bumps, materials inside materials. Known
# answers; the same picture from every sampler within 4 standard errors; the same bits however it is run.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"
part=quick

# ---- What a file says of its colours (OpenImageIO makes "Rec709" of every PPM) ----
if [ -f "$MCRENDER_MODULE_PATH/oiio.so" ]; then
    start=iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAA end=ocDig8D8BAAoFAwBV9gDKAAAAAElFTkSuQmCC
    text=FnRFWHRvaWlvOkNvbG9yU3BhY2UA rest=AAAA9JREFUeNpjaHA4oPA/AQAKBQMAVfYAygAAAABJRU5ErkJggg==
    echo "${start}D0lEQVR42mN$end" | base64 -d >"$TMPDIR/plain.png"
    echo "$start${text}UmVjNzA5hT49lQ$rest" | base64 -d >"$TMPDIR/Rec709.png"
    echo "$start${text}QUNFU2NnmT92fg$rest" | base64 -d >"$TMPDIR/ACEScg.png"
    shown() # FILE SETTINGS: the picture of a wall that emits the texture
    {
        cat >"$TMPDIR/shown.scn" <<TEXT
mcrender 1
camera orthographic { from (0, 0, 1)   to (0, 0, 0)   height 1 }
film { size (2, 2) }
render { sampler cosine   depth 0   spp 4 }
texture picture image { file "$1.png"   $2 }
material m lambert { albedo 0   emission picture   emission_sides both }
quad { corner (-1, -1, 0)   u (2, 0, 0)   v (0, 2, 0)   material m }
TEXT
        "$MCRENDER" "$TMPDIR/shown.scn" --quiet -o "$TMPDIR/$1.pfm" 2>"$TMPDIR/text"
    }
    for word in auto srgb linear; do
        shown plain "colour $word"
        check "a picture that says Rec709, colour $word" shown Rec709 "colour $word"
        check "has the bits of one that says nothing, colour $word" cmp "$TMPDIR/plain.pfm" "$TMPDIR/Rec709.pfm"
        [ $word != auto ] || continue
        check "a picture of other colours, colour $word" shown ACEScg "colour $word"
        check "has the same bits, colour $word" cmp "$TMPDIR/plain.pfm" "$TMPDIR/ACEScg.pfm"
    done
    refute 'a picture of other colours, taken as it says' shown ACEScg ''
    check 'which is told where it is named' grep -q "shown.scn:5:.*cannot read '.*ACEScg.png': its colour space 'ACEScg' is not known" "$TMPDIR/text"
fi

# ---- Coordinates: a surface that emits u or v, seen at one point ----

# at SHAPE FROM TO U V: what is there, to a millionth
at()
{
    local along answer wrong=
    for along in u v; do
        [ $along = u ] && answer=$4 || answer=$5
        cat >"$TMPDIR/at.scn" <<TEXT
mcrender 1
camera perspective { from $2   to $3   up (0.1, 0.9, 0.3)   fov 1e-9 }
film { size (1, 1) }
render { sampler cosine   depth 0   spp 1 }
texture ramp gradient { from 0   to 1   along $along }
material m lambert { albedo 0   emission ramp   emission_sides both }
$1
TEXT
        render "$TMPDIR/at.scn"
        holds 'abs(mean - answer) < 1e-6' mean="$mean" answer="$answer" || wrong="$wrong $along is $mean, expected $answer;"
    done
    empty "coordinates: $1" "$wrong"
}
turned='transform { rotate (0, 0, 1, 90)   scale (2, 2, 2)   translate (1, 0, 0) }'
at 'quad { corner (0, 0, 0)   u (4, 0, 0)   v (0, 2, 0)   material m }' '(1, 1.5, 5)' '(1, 1.5, 0)' .25 .75
at "quad { corner (0, 0, 0)   u (4, 0, 0)   v (0, 2, 0)   material m   $turned }" '(-2, 2, 5)' '(-2, 2, 0)' .25 .75
at 'quad { corners ((0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 2, 0))   material m }' '(3, 0.6, 5)' '(3, 0.6, 0)' .75 .15
at 'plane { point (1, 0, 2)   normal (0, 1, 0)   material m }' '(1.25, 5, 1.5)' '(1.25, 0, 1.5)' .25 .5
at "plane { point (0, 0, 0)   normal (0, 0, 1)   material m   $turned }" '(0.5, 0.8, 5)' '(0.5, 0.8, 0)' .4 .25
at 'plane { point (0, 0, 0)   normal (1, 0, 0)   material m }' '(5, 0.3, -0.6)' '(0, 0.3, -0.6)' .6 .3
at 'disk { center (0, 0, 0)   normal (0, 0, 1)   radius 2   material m }' '(1, -0.5, 5)' '(1, -0.5, 0)' .75 .375
at 'sphere { center (0, 0, 0)   radius 1   material m }' '(0, 0, 5)' '(0, 0, 0)' .5 .5
at 'sphere { center (0, 0, 0)   radius 1   material m }' '(5, 0, 0)' '(0, 0, 0)' .75 .5
at 'sphere { center (0, 0, 0)   radius 1   material m }' '(0, 4, 4)' '(0, 0, 0)' .5 .75
at 'sphere { center (0, 0, 0)   radius 1   material m   transform { rotate (0, 1, 0, 90) } }' '(5, 0, 0)' '(0, 0, 0)' .5 .5
at 'sphere { center (0, 0, 0)   radius 1   material m   transform { scale (1, 2, 3) } }' '(-5, 0, 0)' '(0, 0, 0)' .25 .5
at 'box { corner (0, 0, 0)   size (1, 2, 4)   material m }' '(0.25, 1.5, 9)' '(0.25, 1.5, 4)' .25 .75
at 'box { corner (0, 0, 0)   size (1, 2, 4)   material m }' '(0.25, 1.5, -9)' '(0.25, 1.5, 0)' .75 .75
at 'box { corner (0, 0, 0)   size (1, 2, 4)   material m }' '(9, 1.5, 1)' '(1, 1.5, 1)' .75 .75
at 'box { corner (0, 0, 0)   size (1, 2, 4)   material m }' '(-9, 1.5, 1)' '(0, 1.5, 1)' .25 .75
at 'box { corner (0, 0, 0)   size (1, 2, 4)   material m }' '(0.25, 9, 1)' '(0.25, 2, 1)' .25 .75
at 'box { corner (0, 0, 0)   size (1, 2, 4)   material m }' '(0.25, -9, 1)' '(0.25, 0, 1)' .25 .25
at 'triangle { a (0, 0, 0)   b (4, 0, 0)   c (0, 4, 0)   material m }' '(1, 2, 5)' '(1, 2, 0)' .25 .5
at 'triangle { a (0, 0, 0)   b (4, 0, 0)   c (0, 4, 0)   material m   transform { scale (-1, 1, 1) } }' '(-1, 2, 5)' '(-1, 2, 0)' .25 .5
at 'triangle { a (0, 0, 0)   b (4, 0, 0)   c (0, 4, 0)   uv ((1, 0), (0.2, 0.4), (0.6, 1))   material m }' '(1, 2, 5)' '(1, 2, 0)' .6 .6
at 'mesh { vertices ((0, 0, 0), (4, 0, 0), (0, 4, 0))   faces ((0, 1, 2))   uv ((1, 0), (0.2, 0.4), (0.6, 1))   material m }' '(1, 2, 5)' '(1, 2, 0)' .6 .6

# ---- Textures in materials and on lights ----

cat >"$TMPDIR/floor.scn" <<TEXT
mcrender 1
camera orthographic { from (0, 0, 5)   to (0, 0, 0)   height 2 }
film { size (16, 16) }
render { roulette off   depth 1   background 1 }
texture board checker { even 0.8   odd (0.2, 0.4, 0.1)   scale 8 }
material floor lambert { albedo board }
material other lambert { albedo 0.3 }
quad { corner (-1, -1, 0)   u (2, 0, 0)   v (0, 2, 0)   material floor }
quad { corner (-9, -9, -1)   u (20, 0, 0)   v (0, 20, 0)   material other }
TEXT
known 'a checked floor from above' "$TMPDIR/floor.scn" "$(calculate '.2126 * .5 + .7152 * .6 + .0722 * .45')" 'uniform;cosine;mixture(uniform 1, bsdf 1)'

# Half of S2's rectangle emits: half of its irradiance, by symmetry.
half='texture half checker { even 1   odd 0   scale (2, 1) }'
for lamp in 'emitter { radiance half }' 'lambert { albedo 0   emission half }' 'conductor { emission half   reflectance 0 }'; do
    receiver scene '(0.3, 0.2, 0.5)' "$half   material glow $lamp   quad { corner (-1, -1, 1)   u (0, 2, 0)   v (2, 0, 0)   material glow }"
    known "a light that is half dark, $lamp" "$TMPDIR/scene.scn" .277063211989785 'cosine;light;mixture(cosine 1, light 1);nee' --depth 1
done

# ---- Tilted normals: a small lamp above a point of the surface, whose radiance is albedo L (R / d)^2 cosine ----

# tilted TEXTURE SETTINGS X Y: with a normal along (x, y, 1)
tilted()
{
    cat >"$TMPDIR/tilted.scn" <<TEXT
mcrender 1
camera perspective { from (0, 0, 1)   to (0, 0, 0)   fov 1e-9 }
film { size (16, 16) }
render { roulette off   depth 1 }
texture t $1
material floor lambert { albedo 1   $2 }
material lamp emitter { radiance 1 }
quad { corner (-1, -1, 0)   u (2, 0, 0)   v (0, 2, 0)   material floor }
sphere { center (0, 1, 3)   radius 0.5   material lamp }
TEXT
    known "tilted by $1, $2" "$TMPDIR/tilted.scn" "$(calculate '.025 * (y + 3) / sqrt(10 * (x * x + y * y + 1))' x="$3" y="$4")" \
        'light;mixture(cosine 1, light 1);nee'
}
flat='even (0.65, 0.4, 0.9)   odd (0.65, 0.4, 0.9)'
tilted "checker { $flat }" 'normal_map t' .375 -.25
tilted "checker { $flat }" 'normal_map t   normal_strength 0.5' .1875 -.125
tilted 'gradient { from 0   to 1   along u }' 'bump t   bump_height -0.75' .375 0
tilted 'gradient { from 0   to 1   along v }' 'bump t   bump_height 0.6' 0 -.3

# ---- Materials inside materials ----

cat >"$TMPDIR/mix.scn" <<TEXT
mcrender 1
camera perspective { from (0, 1, 4)   to (0, 0, 0)   fov 40 }
film { size (16, 16) }
render { roulette off   depth 3   background 1   spp 64   sampler cosine }
let plain = 0
material a lambert { albedo (0.9, 0.2, 0.4) }
material b lambert { albedo (0.1, 0.6, 0.3) }
material both mix { first a   second b   amount 0.3 }
material blended lambert { albedo 0.7 * (0.9, 0.2, 0.4) + 0.3 * (0.1, 0.6, 0.3) }
plane { point (0, -1, 0)   normal (0, 1, 0)   material both }
sphere { center (0, 0, 0)   radius 1   material both }
TEXT
sed 's/^let plain.*//; s/^material both.*//; s/^material [ab] .*//; s/material both/material blended/' "$TMPDIR/mix.scn" >"$TMPDIR/blended.scn"
sed -i 's/0.7 \* (0.9, 0.2, 0.4) + 0.3 \* (0.1, 0.6, 0.3)/(0.66, 0.32, 0.37)/' "$TMPDIR/blended.scn"
sed -i '/^material blended/d; /^let plain/d' "$TMPDIR/mix.scn"
render "$TMPDIR/blended.scn"
blended=$mean
render "$TMPDIR/mix.scn"
check "a mix of two lamberts is the lambert of the mixed albedo: $mean, $blended" \
    holds 'blended > 0.3 && abs(mean - blended) < 1e-13' mean="$mean" blended="$blended"

cat >"$TMPDIR/mask.scn" <<TEXT
mcrender 1
camera orthographic { from (0, 0, 5)   to (0, 0, 0)   height 2 }
film { size (16, 16) }
render { roulette off   depth 2   background 1 }
texture holes checker { even 0.25   odd 0.75   scale 4 }
material black lambert { albedo 0 }
material sheet mask { material black   opacity holes }
quad { corner (-1, -1, 0)   u (2, 0, 0)   v (0, 2, 0)   material sheet }
TEXT
known 'a black sheet with holes' "$TMPDIR/mask.scn" .5 'cosine;mixture(cosine 1, bsdf 1)'

# ---- A scene with everything ----

cat >"$TMPDIR/all.scn" <<TEXT
mcrender 1
camera perspective { from (0.3, 1.2, 4)   to (0, 0.6, 0)   fov 40 }
film { size (24, 16) }
render { depth 4   background 0.3   roulette off }
texture board checker { even 0.9   odd (0.2, 0.4, 0.1)   scale 4 }
texture ramp gradient { from 0.1   to 0.9   along v }
texture waves gradient { stops ((0, 0), (0.5, 1), (1, 0))   along u   wrap repeat   scale 6 }
texture lean checker { even (0.6, 0.5, 0.9)   odd (0.4, 0.6, 0.9)   scale 16 }
material floor lambert { albedo board   bump waves   bump_height 0.02 }
material walls lambert { albedo ramp }
material worn mix { first metal   second floor-like   amount board }
material metal conductor { metal gold   roughness ramp }
material floor-like oren-nayar { albedo board }
material holes mask { material walls   opacity board }
material lamp emitter { radiance board   sides two }
material glow mask { material lamp   opacity board }
material dent oren-nayar { albedo 0.7   normal_map lean   emission ramp }
plane { point (0, 0, 0)   normal (0, 1, 0)   material floor }
sphere { center (-0.8, 0.5, 0)   radius 0.5   material worn }
sphere { center (0, 0, 0)   radius 0.3   material dent   transform { scale (1, 2, 1)   rotate (0, 0, 1, 30)   translate (0.2, 0.6, 0.8) } }
box { corner (0.5, 0.1, 0)   size (0.6, 0.6, 0.6)   material holes }
quad { corner (-1, 2, -1)   u (2, 0, 0)   v (0, 0, 2)   material glow }
mesh { vertices ((-1.5, 0, -1), (1.5, 0, -1), (1.5, 1.5, -1.2), (-1.5, 1.5, -1.2))   faces ((0, 1, 2, 3))   normals ((0.2, 0, 1), (0, 0, 1), (0, 0.1, 1), (0, 0, 1))
    material walls }
TEXT
spp=1500
[ "$MCR_SANITIZED" != 1 ] || spp=200
render "$TMPDIR/all.scn" --sampler cosine --spp $spp --seed 1
first=$mean first_error=$error
for sampler in nee 'mixture(cosine 1, light 1)' bsdf uniform; do
    render "$TMPDIR/all.scn" --sampler "$sampler" --spp $spp --seed 2
    check "all of it, $sampler: $mean +- $error, cosine $first +- $first_error" holds \
        'e > 0 && f > 0 && abs(mean - first) <= 4 * sqrt(e * e + f * f) && sqrt(e * e + f * f) < .0025 * first * sqrt(1500 / spp)' \
        mean="$mean" first="$first" e="$error" f="$first_error" spp=$spp
done

isas=baseline
for isa in avx2 avx512; do
    "$MCRENDER" check "$TMPDIR/all.scn" --isa $isa >"$TMPDIR/log" 2>&1 && isas="$isas $isa"
done
ways=("--threads 3" "--batch 8" "--batch 100" "--batch 4096 --threads 1" "--accel list" "--accel bvh")
for isa in $isas; do ways+=("--isa $isa"); done
for sampler in nee 'stratified(bsdf)'; do
    wrong=
    "$MCRENDER" "$TMPDIR/all.scn" --spp 5 --sampler "$sampler" --quiet -o "$TMPDIR/first.pfm" || wrong='no picture'
    for way in "${ways[@]}"; do
        "$MCRENDER" "$TMPDIR/all.scn" --spp 5 --sampler "$sampler" $way --quiet -o "$TMPDIR/other.pfm"
        cmp -s "$TMPDIR/first.pfm" "$TMPDIR/other.pfm" || wrong="$wrong; $way"
    done
    GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F "$MCRENDER" "$TMPDIR/all.scn" --spp 5 --sampler "$sampler" --quiet -o "$TMPDIR/other.pfm"
    cmp -s "$TMPDIR/first.pfm" "$TMPDIR/other.pfm" || wrong="$wrong; GLIBC_TUNABLES"
    empty "the same bits for every way to run it, $sampler" "$wrong"
done
finish
