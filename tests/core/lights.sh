# SPDX-License-Identifier: Apache-2.0
# Lights that are no shapes, through the whole program: irradiance in closed form under every sampler, direct and indirect, in the open and hidden, at
# extreme scales and radiances, turned; and the same bits however it is run. (S12, S18, S19 are names of the project's table of analytic scenes.)
part=quick
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"

pi=3.141592653589793
near='(0.3, 0.2, 0.5)'
covering='uniform;cosine;bsdf;nee;mixture(cosine 1, light 1)'
aiming="cosine;light;nee(by=area);mixture(bsdf 1, light 3);sobol(nee)"
S()
{
    local what=$1
    shift
    known "$what" "$TMPDIR/scene.scn" "$@"
}
# ground NORMAL FROM BLOCK...: a plane through the origin, seen there
ground()
{
    local normal=$1 from=$2
    shift 2
    { preamble "camera perspective { from $from   to (0, 0, 0)   up (0.1, 0.9, 0.3)   fov 1e-9 }"
      echo "material receiver lambert { albedo rho } plane { point (0, 0, 0)   normal $normal   material receiver }"
      echo "$*"
    } >"$TMPDIR/scene.scn"
}
black='material black lambert { albedo 0 }'

# Points: I cos / d^2, over pi
ground '(0, 0, 1)' "$near" 'light a point { position (3, 0, 4)   intensity 7 }'
S 'a point' "$(calculate 7/25*0.8/pi pi=$pi)" 'uniform;cosine;bsdf;nee'
ground '(0, 0, 1)' "$near" 'light a point { position (0, 0, 2)   power 7   transform { scale 2   rotate (0, 1, 0, 60) } }'
S 'a point of known power, moved' "$(calculate '7/(4*pi)/16*0.5/pi' pi=$pi)" 'cosine;bsdf'
ground '(0, 0, 1)' "$near" "$black light a point { position (0, 0, 4)   intensity 7 } light b point { position (0, 3, 4)   intensity 2 } light c point { position (0, 3, -4)   intensity 2 }
    disk { center (0, 0, 2)   normal (0, 0, 1)   radius 0.5   material black }"
S 'two points and one below, one of them hidden' "$(calculate 2/25*0.8/pi pi=$pi)" 'cosine;nee'
ground '(0, 0, 1)' "$near" 'light a point { position (0, 0, 4)   intensity 7 } light b point { position (0, 3, 4)   intensity 2 } light c sun { direction (0, 1, -1)   irradiance 0.3 }'
S 'points and a sun' "$(calculate '(7/16 + 2/25*0.8 + 0.3*sqrt(0.5))/pi' pi=$pi)" 'cosine;nee'
lights=
answer=0
for i in $(seq 0 19); do
    for j in $(seq 0 19); do
        lights="$lights light p$i-q$j point { position ($i / 4 - 2, $j / 3 - 3, 1.5)   intensity 0.01 + $i * $j }"
        [ $(((i + j) % 3)) != 0 ] || lights="$lights light s$i-q$j spot { position ($i / 4 - 2, $j / 3 - 3, 1.2)   direction (0, 0, -1)   intensity 3   angle 90   softness 0 }"
    done
done
lights=$(sed -E 's/ ([ps][0-9]+)-q/ \1_/g' <<<"$lights")
answer=$(awk -v pi=$pi 'BEGIN { for (i = 0; i < 20; i++) for (j = 0; j < 20; j++) { x = i / 4 - 2; y = j / 3 - 3; d = sqrt(x * x + y * y + 2.25); e += (0.01 + i * j) * 1.5 / d ^ 3
    if ((i + j) % 3 == 0) { d = sqrt(x * x + y * y + 1.44); e += 3 * 1.2 / d ^ 3 } } printf "%.15g\n", e / pi }')
ground '(0, 0, 1)' "$near" "$lights"
S 'some hundred points and spots, by a tree' "$answer" 'cosine;sobol(bsdf)'

# Spots: I S(v) cos / d^2; S is half at the middle of the soft part in 1 - cos, and the power is that of full light up to there
ground '(0, 0, 1)' "$near" 'light a spot { position (0, 0, 2)   to (1, 0, 2)   intensity 5 }'
render "$TMPDIR/scene.scn" --sampler cosine --size 4x4 --spp 4
holds 'mean == 0' mean="$mean"
point $? "a spot that looks away: $mean"
spot() # ANGLE SOFTNESS OFF: expected radiance of a spot of power 5 at height 2 that looks OFF degrees past the receiver
{
    awk -v a="$1" -v s="$2" -v o="$3" -v pi=$pi 'function v(d) { d = sin(d / 2 * pi / 180); return 2 * d * d }
        BEGIN { out = v(a); inner = v(a * (1 - s)); t = (out - v(o)) / (out - inner); t = t > 1 ? 1 : t < 0 ? 0 : t
                printf "%.15g\n", 5 / (pi * (out + inner)) * t * t * (3 - 2 * t) / 4 / pi }'
}
for case in 30/0.2/10 30/0.5/20 30/1/15 120/0.5/90 2/0.3/1.9 180/1/170; do
    IFS=/ read -r angle softness off <<<"$case"
    ground '(0, 0, 1)' "$near" "light a spot { position (0, 0, 2)   direction (sin($off), 0, -cos($off))   power 5   angle $angle   softness $softness }"
    S "a spot of $angle degrees, softness $softness, $off off its axis" "$(spot "$angle" "$softness" "$off")" 'cosine'
done

# Suns: E cos / pi; with an extent, wholly above the horizon, the same
ground '(0, 0, 1)' "$near" 'light a sun { direction (0, 2, -2)   irradiance 3 }'
S 'a sun' "$(calculate '3*sqrt(0.5)/pi' pi=$pi)" 'uniform;cosine;bsdf;nee'
ground '(0, 0, 1)' "$near" "$black light a sun { direction (0, 2, -2)   irradiance 3 } disk { center (0, -5, 5)   normal (0, 0, 1)   radius 0.1   material black }"
render "$TMPDIR/scene.scn" --sampler cosine --size 4x4 --spp 4
holds 'mean == 0' mean="$mean"
point $? "a hidden sun: $mean"
for radius in 5.7e-5 0.2665 20; do
    ground '(0, 0, 1)' "$near" "light a sun { direction (0, 1, -2)   irradiance 3   angular_radius $radius }"
    samplers='light;nee;mixture(bsdf 1, light 3)'
    [ $radius = 20 ] && samplers=$aiming
    S "a sun of $radius degrees" "$(calculate '3*2/sqrt(5)/pi' pi=$pi)" "$samplers"
done
ground '(0, 0, 1)' "$near" 'light a sun { direction (0, 0, -1)   radiance 3   angular_radius 90 }'
S 'a sun of half the sky' 3 "$aiming"
ground '(0, 0, 1)' "$near" 'light a sun { direction (0, 0, -1)   radiance 3   angular_radius 30 } light b sun { direction (0, 0, -1)   radiance 8   angular_radius 45 }'
S 'two suns that overlap' "$(calculate '3*0.25 + 8*0.5')" "$aiming"

# S18, S19: environments
ground '(0, 0, 1)' "$near" 'light a environment { radiance 1 }'
S 'S18' 0.6 "$aiming" --set rho=0.6
render "$TMPDIR/scene.scn" --sampler uniform --size 16x16 --spp 4096
holds 'abs(variance * 3 - 1) < 0.01' variance="$variance"
point $? "S18: uniform's variance of one sample: $variance, expected rho^2 / 3"
ground '(0, 0, 1)' "$near" 'light a environment { zenith 2   horizon 1   nadir 0   transform { rotate (1, 0, 0, 90) } }'
S 'S18, 1 + cos' .83333333333333 "$covering;light" --set rho=0.5
ground '(0, 1, 0)' '(0.2, 0.5, 0.3)' 'light a environment { zenith 2   horizon 1   nadir 0 }'
sed 's/roulette off/roulette off mis power/' "$TMPDIR/scene.scn" >"$TMPDIR/power.scn"
known 'S18, 1 + cos, power heuristic' "$TMPDIR/power.scn" .83333333333333 'nee' --set rho=0.5
ground '(0, 0, 1)' "$near" "$black sphere { center (0, 0, 2)   radius 1   material black } light a environment { radiance 1 }"
S S19 .75 "$aiming"
ground '(0, 0, 1)' "$near" "material lamp emitter { radiance 1 } sphere { center (0, 0, 2)   radius 1   material lamp } light a environment { radiance 1 }"
S 'S19, the sphere shines as bright' 1 "$aiming"
ground '(0, 0, 1)' "$near" "material lamp emitter { radiance 1000 } sphere { center (0, 0, 20)   radius 1   material lamp } light a environment { radiance 1 }"
S 'a lamp in front of an environment' "$(calculate '(399 + 1000) / 400')" "nee;light;mixture(cosine 1, light 1)"

# Images: one bright texel in the dark, and a step; irradiance by the integrals of n.w over the texel
texels() # NAME WIDTH HEIGHT CONDITION: a picture, 1 where the condition in column c and row r holds, else 0
{
    awk -v w="$2" -v h="$3" 'BEGIN { print "P2", w, h, 255; for (r = 0; r < h; r++) for (c = 0; c < w; c++) print ('"$4"') ? 255 : 0 }' >"$TMPDIR/$1"
}
# facing WIDTH HEIGHT COLUMN ROW: the integrals of x, y and z over a texel
facing()
{
    awk -v w="$1" -v h="$2" -v c="$3" -v r="$4" -v pi=$pi 'BEGIN {
        t0 = pi * r / h; t1 = pi * (r + 1) / h; p1 = (0.5 - c / w) * 2 * pi; p0 = (0.5 - (c + 1) / w) * 2 * pi
        a = (t1 / 2 - sin(2 * t1) / 4) - (t0 / 2 - sin(2 * t0) / 4)
        printf "%.15g %.15g %.15g\n", a * (cos(p0) - cos(p1)), (p1 - p0) * (sin(t1) ^ 2 - sin(t0) ^ 2) / 2, a * (sin(p1) - sin(p0)) }'
}
texels one.pgm 16 8 'c == 5 && r == 2'
read -r x y z <<<"$(facing 16 8 5 2)"
close='light;nee;mixture(bsdf 1, light 3);sobol(nee)'
ground '(0, 1, 0)' '(0.2, 0.5, 0.3)' 'light a environment { image "one.pgm"   scale 40 }'
S 'one texel, facing +y' "$(calculate '40*y/pi' y="$y" pi=$pi)" "$close"
ground '(1, 0, 0)' '(0.5, 0.2, 0.3)' 'light a environment { image "one.pgm"   scale 40 }'
S 'one texel, facing +x' "$(calculate '40*x/pi' x="$x" pi=$pi)" "$close"
ground '(0, 0, 1)' '(0.2, 0.3, 0.5)' 'light a environment { image "one.pgm"   scale 40 }'
S 'one texel, facing +z' "$(calculate '40*z/pi' z="$z" pi=$pi)" "$close"
ground '(0, 0, 1)' '(0.2, 0.3, 0.5)' 'light a environment { image "one.pgm"   scale 40   transform { rotate (1, 0, 0, 90)   rotate (0, 0, 1, 33)   scale 7   translate (1, 2, 3) } }'
S 'one texel, turned' "$(calculate '40*y/pi' y="$y" pi=$pi)" "$close"
ground '(1, 0, 0)' '(0.5, 0.2, 0.3)' 'group { transform { scale (-1, 1, 1)   rotate (0, 1, 0, 180) } light a environment { image "one.pgm"   scale 40 } }'
S 'one texel, mirrored along z' "$(calculate '40*x/pi' x="$x" pi=$pi)" "$close"
texels fine.pgm 512 256 'c == 200 && r == 60'
read -r x y z <<<"$(facing 512 256 200 60)"
ground '(0, 1, 0)' '(0.2, 0.5, 0.3)' 'light a environment { image "fine.pgm"   scale 1e5 }'
S 'one small texel' "$(calculate '1e5*y/pi' y="$y" pi=$pi)" 'light;nee'
texels step.pgm 8 6 'r < 3'
ground '(0, 1, 0)' '(0.2, 0.5, 0.3)' 'light a environment { image "step.pgm"   scale 3   transform { rotate (0, 0, 1, 90) } }'
S 'half of the sky' 1.5 "$aiming"
texels whole.pgm 7 5 1
ground '(0.2, 1, 0.3)' '(0.2, 0.5, 0.3)' 'light a environment { image "whole.pgm"   filter bilinear }'
S 'a white image, bilinear' 1 "$aiming"

# How its numbers are encoded: 188 of 255 is sRGB's word for half of the light, or linear.
half=$(calculate '((188 / 255 + 0.055) / 1.055) ^ 2.4')
awk 'BEGIN { print "P2 7 5 255"; for (i = 0; i < 35; i++) print 188 }' >"$TMPDIR/half.pgm"
for word in '' auto srgb linear; do
    ground '(0.2, 1, 0.3)' '(0.2, 0.5, 0.3)' "light a environment { image \"half.pgm\"   ${word:+colour $word} }"
    [ "$word" = linear ] && half=$(calculate '188 / 255')
    S "numbers of an image, colour ${word:-not said}" "$half" 'cosine;nee'
done
hash_of() { sed -n 's/.*"hash": "\(.*\)".*/\1/p' "$TMPDIR/out.json"; }
render "$TMPDIR/scene.scn" --spp 1
before=$(hash_of)
render "$TMPDIR/scene.scn" --spp 1
check "the same image is the same scene" test -n "$before" -a "$before" = "$(hash_of)"
sed -i 's/188/187/' "$TMPDIR/half.pgm"
render "$TMPDIR/scene.scn" --spp 1
check "another image is another scene" test "$before" != "$(hash_of)"

# Bilinear, turned, with a lamp, suns and points: every sampler finds the same.
cat >"$TMPDIR/scene.scn" <<'TEXT'
mcrender 1
camera perspective { from (0, 1, 3.4)   to (0, 1, 0)   fov 40 }
film { size (16, 16) }
render { roulette off   depth 3 }
material red lambert { albedo (0.65, 0.05, 0.05) }
material white lambert { albedo 0.73 }
material lamp emitter { radiance 4   albedo 0.5 }
quad { corner (-1, 0, -1)   u (0, 2, 0)   v (0, 0, 2)   material red }
quad { corner (-1, 0, -1)   u (0, 0, 2)   v (2, 0, 0)   material white }
quad { corner (-0.25, 1.99, -0.25)   u (0.5, 0, 0)   v (0, 0, 0.5)   material lamp }
box { size (0.6, 1.2, 0.6)   transform { rotate (0, 1, 0, 15)   translate (-0.7, 0, -0.7) }   material white }
light a sun { direction (-1, -2, -1)   irradiance (1, 0.9, 0.8)   angular_radius 10 }
light b sun { direction (1, -2, -1)   irradiance (0.3, 0.9, 0.8) }
light c point { position (0.5, 0.5, 0.5)   intensity 0.2 }
light d spot { position (0.9, 1.5, 1)   to (0, 0, 0)   intensity (1, 2, 1) }
light e environment { image "step.pgm"   filter bilinear   transform { rotate (1, 1, 1, 50) } }
TEXT
[ "$MCR_SANITIZED" = 1 ] && many=256 || many=2048
render "$TMPDIR/scene.scn" --sampler 'mixture(cosine 1, light 1)' --seed 2 --spp $((4 * many))
reference_mean=$mean reference_error=$error
for sampler in nee 'nee(by=area)' bsdf 'mixture(bsdf 1, light 1)' 'mixture(light 1, bsdf 2, uniform 1)' 'stratified(nee)' 'sobol(nee)'; do
    render "$TMPDIR/scene.scn" --sampler "$sampler" --seed 1 --spp $many
    z=$(calculate '(a - b) / sqrt(x ^ 2 + y ^ 2)' a="$mean" b="$reference_mean" x="$error" y="$reference_error")
    holds 'error > 0 && error < 0.04 * mean && abs(z) <= 4' error="$error" mean="$mean" z="$z"
    point $? "all lights, $sampler: $mean +- $error, z = ${z:0:6}" "expected $reference_mean +- $reference_error"
done
render "$TMPDIR/scene.scn" --sampler 'sobol(nee)' --spp 16 --batch 8 --threads 1
cp "$TMPDIR/out.pfm" "$TMPDIR/first.pfm"
wrong=
for way in '--batch 1000 --threads 3' '--isa baseline' '--isa avx2' '--accel bvh --batch 100'; do
    case $way in *isa*) "$MCRENDER" check "$TMPDIR/scene.scn" $way >"$TMPDIR/log" 2>&1 || continue ;; esac
    render "$TMPDIR/scene.scn" --sampler 'sobol(nee)' --spp 16 $way
    cmp -s "$TMPDIR/first.pfm" "$TMPDIR/out.pfm" || wrong="$wrong; $way"
done
empty 'all lights: the same bits however it is run' "$wrong"

# S12: a point in the middle of a sphere, rho I / (pi R^2 (1 - rho)) by light that goes round; every sampler, none of which can aim at it
inside()
{
    { preamble "camera perspective { from ($1, $2, $3)   to ($1 * 0.3, $2, $3)   fov 40 }" | sed 's/depth 1/depth 130/'
      echo "material wall lambert { albedo 0.8 } sphere { center (0, 0, 0)   radius $4   material wall } $5"
    } >"$TMPDIR/scene.scn"
}
inside 0.5 0.1 0.2 1 'light a point { position (0, 0, 0)   intensity 1 }'
S S12 1.2732395447352 'cosine;nee;mixture(cosine 1, uniform 1);sobol(bsdf)'
S 'S12, direct alone' .25464790894703 'cosine' --depth 1
for scale in 1e-9 1e9; do
    inside 0.5*$scale 0.1*$scale 0.2*$scale $scale "light a point { position (0, 0, 0)   intensity 1e30 * $scale ^ 2 }"
    S "S12, of radius $scale, 1e30 times as bright" 1.2732395447352e30 'bsdf'
done

# What does not shine is not aimed at.
ground '(0, 0, 1)' "$near" 'light a environment { radiance 0 } light b point { position (0, 0, 1)   intensity 0 }'
refute 'a black environment is no light' "$MCRENDER" check "$TMPDIR/scene.scn" --sampler light
render "$TMPDIR/scene.scn" --sampler nee --size 4x4 --spp 4
holds 'mean == 0' mean="$mean"
point $? 'and all is black'

# The environment and suns with an extent are seen, points and parallel suns are not.
{ preamble 'camera perspective { from (0, 0, 0)   to (0, 0, 1)   fov 1 }'
  echo 'light a environment { radiance 0.5 } light b sun { direction (0, 0, -1)   radiance 2   angular_radius 5 } light c sun { direction (0, 0, -1)   irradiance 9 }
      light d point { position (0, 0, 1)   intensity 9 } material m lambert { } sphere { center (0, 9, 0)   radius 1   material m }'
} >"$TMPDIR/scene.scn"
render "$TMPDIR/scene.scn" --sampler nee --size 4x4 --spp 4
holds 'abs(mean - 2.5) < 1e-14' mean="$mean"
point $? "the sky is seen: $mean"
finish
