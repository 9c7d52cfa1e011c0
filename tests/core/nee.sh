# SPDX-License-Identifier: Apache-2.0
# The samplers that ask the material, `bsdf` and `nee`, through the whole program: scenes with a known answer, the variance of one sample,
# several groups of materials, and every pixel of the Cornell box. (S1 ... are the names of the project's table of analytic scenes.)
part=all
[ "$MCR_SANITIZED" != 1 ] || part=quick
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"
${MCR_CC:-cc} -std=gnu17 -O2 -shared -fPIC -I"$srcdir/src" "$srcdir/tests/core/neelight.c" -o "$TMPDIR/neelight.so" -lm ||
    { point 1 "neelight.c compiles"; finish; }

near='(0.3, 0.2, 0.5)'
nees='nee;nee(by=area)'
all="bsdf;$nees;mixture(bsdf 1, light 1)"

# S WHAT ANSWER ARGUMENT...: all samplers, then `nee` with the power heuristic
S()
{
    local what=$1 answer=$2
    shift 2
    known "$what" "$TMPDIR/scene.scn" "$answer" "$all" "$@"
    sed 's/roulette off/mis power   roulette off/' "$TMPDIR/scene.scn" >"$TMPDIR/power.scn"
    known "$what, power" "$TMPDIR/power.scn" "$answer" "$nees" "$@"
}

# S2, S4, S5, S14: one light above a diffuse receiver
receiver scene "$near" 'quad { corner (-1, -1, 1)   u (0, 2, 0)   v (2, 0, 0)   material lamp }'
S 'S2, centred' .55412642397957
receiver scene "$near" 'quad { corner (-2.5, -1.5, 1)   u (0, 2, 0)   v (2, 0, 0)   material both }'
S 'S2, receiver at (1.5, .5), two sides' .14748482740113
receiver scene "$near" 'disk { center (0, 0, 1)   normal (0, 0, -1)   radius 1   material lamp }'
S 'S4, coaxial' .5
receiver scene "$near" 'sphere { center (-2 * sin(60), 0, 2 * cos(60))   radius 0.5   material lamp }'
S 'S5, 60 degrees' .03125
receiver scene '(0.6, 0.2, 0.5)' 'quad { corner (-1, -1, 2)   u (0, 2, 0)   v (2, 0, 0)   material lamp }
    quad { corner (-50, -50, 1)   u (50.25, 0, 0)   v (0, 100, 0)   material black }'
S S14 .05354562144698

# S1, S10: the light goes on; two plugins of materials
closed scene 'sphere { center (0, 0, 0)   radius 2   material wall }'
S 'S1, sphere, rho .8, D = 8' 4.32891136 --set rho=0.8 --depth 8
closed scene 'box { min (-2, -1, -1.5)   max (1.5, 2, 3)   transform { rotate (1, 2, 3, 40) }   material wall }'
S 'S1, turned box, rho .8, D = 8' 4.32891136 --set rho=0.8 --depth 8
{ preamble "camera perspective { from (1.2, 0.9, 0.1)   to (3, 2, 0)   fov 30 }"
  cat <<'TEXT'
material inner emitter { radiance 1   albedo 0.3 }
material outer lambert { albedo 0.6 }
sphere { center (0, 0, 0)   radius 1   material inner }
sphere { center (0, 0, 0)   radius 2   material outer }
TEXT
} >"$TMPDIR/scene.scn"
S 'S10, outer' .2970297029703 --depth 60
S 'S10, outer, D = 1' .15
sed -i 's/roulette off/roulette on(from=2)/' "$TMPDIR/scene.scn"
known 'S10, outer, roulette' "$TMPDIR/scene.scn" .2970297029703 "$all" --depth 60

# S9: a plane emits, which `bsdf` alone may meet
{ preamble 'camera perspective { from (0.2, 0.1, 0.4)   to (0.2, 0.1, 0)   up (1, 0, 0)   fov 80 }'
  cat <<'TEXT'
material top emitter { radiance 1   albedo 0.3 * rho }
material bottom lambert { albedo 0.6 }
plane { point (0, 0, 1)   normal (0, 0, -1)   material top }
plane { point (0, 0, 0)   normal (0, 0, 1)   material bottom }
TEXT
} >"$TMPDIR/scene.scn"
known 'S9, bottom' "$TMPDIR/scene.scn" .73170731707317 bsdf --depth 60

# S18: a plane under a constant environment, without any light to sample: `nee` is `bsdf` then, to the bit, and complete.
{ preamble 'camera orthographic { from (0, 0, 5)   to (0, 0, 0)   height 3 }'
  echo 'material ground lambert { albedo 0.7 * rho }   plane { point (0, 0, 0)   normal (0, 0, 1)   material ground }
    quad { corner (-0.5, -0.5, 1)   u (0, 1, 0)   v (0.7, 0, 0.8)   material ground }'
} | sed 's/roulette off/background 1 roulette off/' >"$TMPDIR/scene.scn"
render "$TMPDIR/scene.scn" --sampler bsdf --depth 5 --spp 64
cp "$TMPDIR/out.pfm" "$TMPDIR/bsdf.pfm"
render "$TMPDIR/scene.scn" --sampler nee --depth 5 --spp 64
check 'without lights, nee is bsdf, to the bit' cmp "$TMPDIR/bsdf.pfm" "$TMPDIR/out.pfm"
empty 'without lights, nee is no mistake and complete' "$("$MCRENDER" check "$TMPDIR/scene.scn" --sampler nee --quiet 2>&1)"

# S16: one sample of `bsdf` varies as one that is drawn by what the material draws by: lambert the cosine, `flat` of neelight.c (the same surface)
# uniformly. At half a million samples the error of these is below 0.5 %.
variance_of() # WHAT SAMPLER EXPECTED [SCENE]
{
    local what=$1 sampler=$2 expected=$3
    render "$TMPDIR/${4:-scene}.scn" --sampler "$sampler" --size 16x16 --spp 2048 --seed 1 --set rho=0.5 --plugin "$TMPDIR/neelight.so" || return
    holds 'abs(variance / expected - 1) < 0.05' variance="$variance" expected="$expected"
    point $? "$what: $variance, expected $expected"
}
disk='disk { center (0, 0, 1)   normal (0, 0, -1)   radius 1   material lamp }'
receiver scene "$near" "$disk"
variance_of 'S16, bsdf on lambert' bsdf .0625
variance_of 'S16, half bsdf, half light by area' 'mixture(bsdf 1, light(by=area) 1)' .026624722801679
# `nee` by quadrature: with p the light's density and q the cosine's, f = cos / 2 pi and w = h(p) / (h(p) + h(q)), the light's part has the second moment
# integral of (f w)^2 / p and the mean integral of f w; the material's with p and q exchanged; both are independent. h is the identity or the square.
variance_of 'S16, nee' nee .0071869377453
variance_of 'S16, nee by area' 'nee(by=area)' .0107382903727
sed 's/roulette off/mis power   roulette off/' "$TMPDIR/scene.scn" >"$TMPDIR/power.scn"
variance_of 'S16, nee, power' nee .0028527404525 power
variance_of 'S16, nee by area, power' 'nee(by=area)' .0080489581260 power
# The same beside a surface of the other kind, which no path meets: each point's own material is asked. Mixed, it tells the density, too.
receiver scene "$near" "$disk   quad { corner (-1, -1, -3)   u (0, 1, 0)   v (1, 0, 0)   material other }"
sed 's/^film/material other flat { } film/' "$TMPDIR/scene.scn" >"$TMPDIR/beside.scn"
variance_of 'S16, bsdf on lambert beside flat' bsdf .0625 beside
variance_of 'S16, half bsdf on lambert beside flat' 'mixture(bsdf 1, light(by=area) 1)' .026624722801679 beside
sed -e 's/^film/material other lambert { } film/' -e 's/receiver lambert { albedo rho }/receiver flat { }/' "$TMPDIR/scene.scn" >"$TMPDIR/beside.scn"
variance_of 'S16, bsdf on flat beside lambert' bsdf .15298220313558 beside
variance_of 'S16, half bsdf on flat beside lambert' 'mixture(bsdf 1, light(by=area) 1)' 0.044883044335 beside

# Several groups at once: floor, block and walls by materials that draw in different ways. What one sampler finds, all find.
cat >"$TMPDIR/groups.scn" <<'TEXT'
mcrender 1
camera perspective { from (0, 1, 3.4)   to (0, 1, 0)   fov 40 }
film { size (16, 16) }
render { roulette off   depth 4   background 0.1 }
material plain flat { }
material red lambert { albedo (0.65, 0.05, 0.05) }
material white lambert { albedo 0.73 }
material lamp emitter { radiance 4   albedo 0.5 }
quad { corner (-1, 0, -1)   u (0, 2, 0)   v (0, 0, 2)   material red }
quad { corner (1, 0, -1)   u (0, 2, 0)   v (0, 0, 2)   material plain }
quad { corner (-1, 0, -1)   u (2, 0, 0)   v (0, 0, 2)   material plain }
quad { corner (-1, 0, -1)   u (2, 0, 0)   v (0, 2, 0)   material white }
quad { corner (-0.5, 1.99, -0.5)   u (1, 0, 0)   v (0, 0, 1)   material lamp }
box { size (0.6, 1.2, 0.6)   transform { rotate (0, 1, 0, 15)   translate (-0.7, 0, -0.7) }   material plain }
TEXT
grouped() # SAMPLER ARGUMENT...: mean and error at an error of 0.1 %
{
    local sampler=$1
    shift
    render "$TMPDIR/groups.scn" --plugin "$TMPDIR/neelight.so" --sampler "$sampler" --spp 64 --seed 1001 "$@" || return
    render "$TMPDIR/groups.scn" --plugin "$TMPDIR/neelight.so" --sampler "$sampler" --seed 1 "$@" \
        --spp "$(calculate 'int(variance / (0.001 * mean) ^ 2 / 256 + 64)' variance="$variance" mean="$mean")"
}
grouped 'mixture(cosine 1, light 1)' --seed 2
reference_mean=$mean reference_error=$error
for sampler in bsdf nee 'mixture(bsdf 1, light 1)' 'mixture(light 1, bsdf 2, uniform 1)'; do
    grouped "$sampler"
    z=$(calculate '(a - b) / sqrt(x ^ 2 + y ^ 2)' a="$mean" b="$reference_mean" x="$error" y="$reference_error")
    holds 'error > 0 && error < 0.002 * mean && abs(z) <= 4' error="$error" mean="$mean" z="$z"
    point $? "four groups, $sampler: $mean +- $error, z = ${z:0:6}" "expected $reference_mean +- $reference_error"
done
render "$TMPDIR/groups.scn" --plugin "$TMPDIR/neelight.so" --sampler 'mixture(bsdf 1, light 1)' --spp 16 --batch 8 --threads 1
cp "$TMPDIR/out.pfm" "$TMPDIR/first.pfm"
render "$TMPDIR/groups.scn" --plugin "$TMPDIR/neelight.so" --sampler 'mixture(bsdf 1, light 1)' --spp 16 --batch 1000 --threads 3
check 'four groups: the same bits whatever the batch' cmp "$TMPDIR/first.pfm" "$TMPDIR/out.pfm"

# The Cornell box, every pixel: 48 pictures each. The pixel means' differences over their errors follow Student's distribution with about 94 degrees,
# which is beyond 3 with probability .0034; of 1024 pixels that is 3, and 4 standard errors more are 10.
box=$srcdir/scenes/cornell-box.scn
pictures() # FILE FIRST-SEED SAMPLER ARGUMENT...: lines "mean variance-of-the-mean" of the luminance of each pixel
{
    local to=$1 first=$2 sampler=$3 seed
    shift 3
    for seed in $(seq $((first + 1)) $((first + 48))); do
        render "$box" --sampler "$sampler" --size 32x32 --spp 16 --seed "$seed" --threads 1 "$@" || break
        tail -c $((32 * 32 * 12)) "$TMPDIR/out.pfm" | od -An -v -t f4 -w12
    done | awk -v pixels=1024 '
        { p = (NR - 1) % pixels; v = 0.2126 * $1 + 0.7152 * $2 + 0.0722 * $3; n[p]++; d = v - m[p]; m[p] += d / n[p]; s[p] += d * (v - m[p]) }
        END { for (p = 0; p < pixels; p++) printf "%.9g %.9g\n", m[p], s[p] / (n[p] * (n[p] - 1)) }' >"$TMPDIR/$to"
}
pictures mixture 1000 'mixture(cosine 1, light 1)'
i=1
for sampler in nee 'mixture(bsdf 1, light 1)'; do
    i=$((i + 1))
    pictures other $((1000 * i)) "$sampler"
    read -r outside z < <(paste -d' ' "$TMPDIR/other" "$TMPDIR/mixture" | awk '
        { e = $2 + $4; d = $1 - $3; lit += $1 > 0; if (e > 0 ? d * d > 9 * e : d != 0) n++; D += d; E += e }
        END { if (NR == 1024 && lit > 500) print n + 0, D / sqrt(E); else print "none none" }')
    ratio=$(paste -d' ' "$TMPDIR/other" "$TMPDIR/mixture" | awk '$4 > 0 { print $2 / $4 }' | sort -g | awk '{ r[NR] = $1 } END { print r[int((NR + 1) / 2)] }')
    holds 'n + 0 == n && n <= 10' n="$outside"
    point $? "Cornell box: $sampler and mixture differ by more than 3 standard errors in $outside of 1024 pixels"
    holds 'z + 0 == z && abs(z) <= 4' z="$z"
    point $? "Cornell box: the means of $sampler and mixture differ by $z standard errors"
    echo "# $sampler: at equal samples, the squared error over that of mixture(cosine 1, light 1): $ratio in the median pixel"
done
finish
