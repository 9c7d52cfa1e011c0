#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Rough surfaces in renders: known answers, and a room with metal and a rough wall in it, of which every sampler must make the same picture: mean
# luminances within 4 standard errors, where these are so small that 1 % of difference would be 5 of them.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
part=quick
samplers='uniform;cosine;mixture(uniform 1, cosine 1);bsdf;stratified(bsdf)'

# seen MATERIAL COSINE: the material under a background of 1, seen at one point at that cosine, one scattering event: its directional albedo
seen()
{
    cat >"$TMPDIR/scene.scn" <<TEXT
mcrender 1
camera perspective { from ($(calculate 'sqrt(1 - c * c)' c="$2"), 0, $2)   to (0, 0, 0)   up (0.1, 0.9, 0.3)   fov 1e-9 }
film { size (16, 16) }
render { roulette off   depth 1   background 1 }
material receiver $1
plane { point (0, 0, 0)   normal (0, 0, 1)   material receiver }
TEXT
}
while read -r alpha cosine answer; do
    seen "conductor { reflectance 1   roughness $alpha }" "$cosine"
    known "S21, alpha $alpha, cosine $cosine" "$TMPDIR/scene.scn" "$answer" "$samplers"
done <<TEXT
0.25 0.5 .857263435582
0.5 1 .687848515110
0.5 0.1 .860105072668
1 0.5 .450693855666
TEXT
# Anisotropic: midpoint sums over 4000 x 4000 normals of D G2 / G1, which for equal widths are S21 to 1e-7. The quad's u is the world's x, as is the view.
while read -r roughness lean turn cosine answer; do
    seen "conductor { reflectance 1   roughness $roughness   anisotropy $lean   rotation $turn }" "$cosine"
    sed -i 's/^plane.*/quad { corner (-9, -9, 0)   u (18, 0, 0)   v (0, 18, 0)   material receiver }/' "$TMPDIR/scene.scn"
    known "anisotropy $lean, rotation $turn, cosine $cosine" "$TMPDIR/scene.scn" "$answer" 'cosine;bsdf;nee'
done <<TEXT
0.7 0.8 0 0.5 .672444797
0.7 0.8 90 0.5 .743669427
0.7 -0.5 -30 0.2 .801650447
TEXT
for cosine in 1 0.3; do
    seen 'oren-nayar { albedo 1   sigma 1 }' $cosine
    known "oren-nayar in the white furnace, cosine $cosine" "$TMPDIR/scene.scn" 1 "$samplers"
done
for cosine in 0.9 0.3; do # the polynomials of directional albedos err by less than the samples' 4 standard errors
    seen 'conductor { reflectance 1   roughness 0.5   compensation kulla-conty }' $cosine
    known "conductor with compensation in the white furnace, cosine $cosine" "$TMPDIR/scene.scn" 1 'cosine;bsdf'
    seen 'glossy { albedo 1   roughness 0.4 }' $cosine
    known "glossy in the white furnace, cosine $cosine" "$TMPDIR/scene.scn" 1 'cosine;bsdf'
    seen "principled { base_color 1   metallic 1   roughness 0.7 }" $cosine
    known "principled metal in the white furnace, cosine $cosine" "$TMPDIR/scene.scn" 1 'cosine;bsdf'
    seen "principled { base_color 1   roughness 0.6 }" $cosine
    known "principled plastic in the white furnace, cosine $cosine" "$TMPDIR/scene.scn" 1 'cosine;bsdf'
done

# The limits of principled: S21 without compensation, the diffuse base alone, smooth glass (all light passes or is reflected) and what is left of the light
# that crosses a wall of index 1 along its normal, twice its attenuation_distance thick.
seen 'principled { base_color 1   metallic 1   roughness 0.5   compensation none }' 0.5
known 'principled metal without compensation is S21' "$TMPDIR/scene.scn" .857263435582 'cosine;bsdf'
seen 'principled { base_color 0.6   specular 0 }' 0.3
known 'principled without specular scatters base_color' "$TMPDIR/scene.scn" 0.6 'cosine;bsdf'
seen 'principled { roughness 0   transmission 1   thin yes }' 0.5
known 'principled glass in the white furnace' "$TMPDIR/scene.scn" 1 bsdf
cat >"$TMPDIR/slab.scn" <<TEXT
mcrender 1
camera perspective { from (0, 0, 5)   to (0, 0, 0)   up (0, 1, 0)   fov 1e-9 }
film { size (16, 16) }
render { roulette off   depth 4   background 1 }
material glass principled { roughness 0   ior 1   specular 0   transmission 1   attenuation_color 0.5   attenuation_distance 0.5 }
box { min (-9, -9, 0)   max (9, 9, 1)   material glass }
TEXT
known 'principled: Beer and Lambert, 0.5^2' "$TMPDIR/slab.scn" 0.25 bsdf

# A white rough ball in a white furnace cannot be seen.
cat >"$TMPDIR/furnace.scn" <<TEXT
mcrender 1
camera perspective { from (0, 0, 3)   to (0, 0, 0)   fov 40 }
film { size (16, 16) }
render { roulette off   depth 16   background 1 }
material ball oren-nayar { albedo 1   sigma 0.8 }
sphere { center (0, 0, 0)   radius 1   material ball }
TEXT
known 'a white oren-nayar ball in the white furnace' "$TMPDIR/furnace.scn" 1 "$samplers"

cat >"$TMPDIR/room.scn" <<TEXT
mcrender 1
camera perspective { from (0, 1, 3.4)   to (0, 1, 0)   fov 40 }
film { size (16, 16) }
render { roulette off   depth 3   background (0.3, 0.5, 0.8) }
material lamp emitter { radiance 4 }
material clay oren-nayar { albedo (0.8, 0.5, 0.3)   sigma 0.9 }
material gold conductor { metal gold   roughness 0.4 }
material steel conductor { metal index   eta (2.9, 2.95, 2.6)   k (3.1, 2.9, 2.8)   roughness 0.25 }
quad { corner (-0.5, 1.99, -0.5)   u (1, 0, 0)   v (0, 0, 1)   material lamp }
quad { corner (-1, 0, -1)   u (2, 0, 0)   v (0, 0, 2)   material clay }
quad { corner (-1, 0, -1)   u (2, 0, 0)   v (0, 2, 0)   material clay }
quad { corner (1, 0, -1)   u (0, 2, 0)   v (0, 0, 2)   material steel }
sphere { center (-0.3, 0.5, -0.2)   radius 0.5   material gold }
TEXT

# measured SAMPLER RELATIVE-ERROR: as `render`, with as many samples as that takes by a pilot's variance; each with its own seed
seed=0
measured()
{
    seed=$((seed + 1))
    render "$TMPDIR/room.scn" --sampler "$1" --spp 256 --seed $((1000 + seed)) || return 1
    render "$TMPDIR/room.scn" --sampler "$1" --seed $seed \
        --spp "$(calculate 'int((n = variance / (wanted * mean) ^ 2 / 256 + 1) < 64 ? 64 : n)' variance="$variance" wanted="$2" mean="$mean")"
}
measured 'mixture(cosine 1, light 1)' 0.001 && reference_mean=$mean reference_error=$error
for sampler in uniform cosine 'mixture(uniform 1, light 1)' bsdf 'mixture(bsdf 1, light 1)'; do
    measured "$sampler" 0.0015 || continue
    z=$(calculate '(a - b) / sqrt(x ^ 2 + y ^ 2)' a="$mean" b="$reference_mean" x="$error" y="$reference_error")
    holds 'error > 0 && error < 0.0022 * mean && abs(z) <= 4' error="$error" mean="$mean" z="$z"
    point $? "room, $sampler: $mean +- $error, z = ${z:0:6}" "expected $reference_mean +- $reference_error"
done

# Materials of one plugin share a batch: each must get its own settings, whatever the batch and the instruction set.
picture() { "$MCRENDER" "$TMPDIR/room.scn" --sampler bsdf --spp 16 --quiet -o "$TMPDIR/$1.pfm" "${@:2}"; }
picture first
for arguments in '--isa baseline' '--batch 7' '--isa baseline --batch 64 --threads 2'; do
    picture other $arguments
    check "room, $arguments: the same bits" cmp "$TMPDIR/first.pfm" "$TMPDIR/other.pfm"
done
finish
