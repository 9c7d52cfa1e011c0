# SPDX-License-Identifier: Apache-2.0
# The sampler `control`: exact where nothing is hidden, right where something is, and with little noise where little is hidden.
part=quick
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"
near='(0.3, 0.2, 0.5)' scene=$TMPDIR/scene.scn

# exact WHAT ANSWER: one scattering event, every path alike: the mean is the answer, whose digits are 13 or more
exact()
{
    render "$scene" --sampler control --size 8x8 --spp 4 || return
    holds 'abs(mean - answer) <= 1e-11 * answer && error <= 1e-11 * answer' mean="$mean" error="$error" answer="$2"
    point $? "$1: $mean +- $error" "expected $2"
}

receiver scene "$near" 'quad { corner (-1, -1, 1)   u (0, 2, 0)   v (2, 0, 0)   material lamp }'
exact 'S2, centred' .55412642397957
receiver scene "$near" 'quad { corner (-2.5, -1.5, 1)   u (0, 2, 0)   v (2, 0, 0)   material both }'
exact 'S2, receiver at (1.5, .5), two sides' .14748482740113
receiver scene "$near" 'sphere { center (-2 * sin(60), 0, 2 * cos(60))   radius 0.5   material lamp }'
exact 'S5, 60 degrees' .03125
receiver scene "$near" 'sphere { center (2 * sin(80), 0, 2 * cos(80))   radius 1   material lamp }'
sed -i 's/^plane.*/disk { center (0, 0, 0)   normal (0, 0, 1)   radius 0.01   material receiver }/' "$scene"
exact 'S6, 80 degrees: through the horizon' .054695816445537
receiver scene "$near" 'quad { corner (1, 0, -1)   u (0, 1, 0)   v (0, 0, 2)   material both }'
sed -i 's/^plane.*/disk { center (0, 0, 0)   normal (0, 0, 1)   radius 0.01   material receiver }/' "$scene"
exact 'S3, a wall: through the horizon' .055734197002554
receiver scene "$near" 'triangle { a (0, 0, 2)   b (1, 0, 2)   c (0, 1, 3)   material both }'
exact S20 .023717994556414

# What the closed form is not for: a disk, and a lamp that something hides
receiver scene "$near" 'disk { center (0, 0, 1)   normal (0, 0, -1)   radius 1   material lamp }'
known 'S4, a disk: as nee' "$scene" .5 control
receiver scene '(0.6, 0.2, 0.5)' 'quad { corner (-1, -1, 2)   u (0, 2, 0)   v (2, 0, 0)   material lamp }
    quad { corner (-50, -50, 1)   u (50.25, 0, 0)   v (0, 100, 0)   material black }'
known S14 "$scene" .05354562144698 'control;control(by=area)'
# Several bounces, and materials that are not Lambertian
closed scene 'box { min (-2, -1, -1.5)   max (1.5, 2, 3)   transform { rotate (1, 2, 3, 40) }   material wall }'
known 'S1, turned box, rho .8, D = 8' "$scene" 4.32891136 control --set rho=0.8 --depth 8
{ preamble "camera perspective { from (1.2, 0.9, 0.1)   to (3, 2, 0)   fov 30 }"
  cat <<'TEXT'
material inner emitter { radiance 1   albedo 0.3 }
material outer lambert { albedo 0.6 }
sphere { center (0, 0, 0)   radius 1   material inner }
sphere { center (0, 0, 0)   radius 2   material outer }
TEXT
} | sed '/^let rho/d' >"$scene"
known 'S10, outer' "$scene" .2970297029703 control --depth 60

# The Cornell box after one event, the wall on the right, which the lamp sheds its light on unhindered: what is left is the pixels' own extent.
render "$srcdir/scenes/cornell-box.scn" --sampler nee --depth 1 --size 32x32 --crop 26,8,31,24 --spp 256 --seed 1
nee=$(calculate 'e * e' e="$error") nee_mean=$mean
render "$srcdir/scenes/cornell-box.scn" --sampler control --depth 1 --size 32x32 --crop 26,8,31,24 --spp 256 --seed 2
holds 'e * e < 0.5 * nee' e="$error" nee="$nee"
point $? "Cornell box, the wall: squared error $(calculate 'e * e / nee' e="$error" nee="$nee") of that of nee"
holds 'abs(a - b) <= 4 * sqrt(e * e + nee)' a="$mean" b="$nee_mean" e="$error" nee="$nee"
point $? "Cornell box, the wall: $mean and $nee_mean"
first=
for how in '--isa baseline --threads 1' '--threads 2 --batch 40' '--accel bvh'; do
    # shellcheck disable=SC2086
    "$MCRENDER" "$srcdir/scenes/cornell-box.scn" $how --sampler control --size 16x16 --spp 16 --quiet -o "$TMPDIR/bits.pfm"
    sum=$(cksum <"$TMPDIR/bits.pfm")
    first=${first:-$sum}
    [ -s "$TMPDIR/bits.pfm" ] && [ "$sum" = "$first" ]
    point $? "the same bits with $how"
done
finish
