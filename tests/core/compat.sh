# SPDX-License-Identifier: Apache-2.0
# What each quirk of the founding study does, against values computed by hand.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"

# exactly WHAT SCENE ANSWER ARGUMENT...: a point: every path gives the same, so that the mean is the answer up to rounding
exactly()
{
    local what=$1 answer=$3
    render "$TMPDIR/$2.scn" "${@:4}" || return
    holds 'abs(mean - answer) <= rounding * answer' mean="$mean" answer="$answer" rounding=$ROUNDING
    point $? "$what: $mean" "expected $answer"
}

# nearly WHAT SCENE ANSWER ARGUMENT...: within 4 standard errors, which are below 1 % of the answer
nearly()
{
    local what=$1 answer=$3
    render "$TMPDIR/$2.scn" "${@:4}" || return
    holds 'error > 0 && error < 0.01 * answer && abs(mean - answer) <= 4 * error' mean="$mean" error="$error" answer="$answer"
    point $? "$what: $mean +- $error" "expected $answer"
}

# same_picture WHAT SCENE ARGUMENT...: the first of the arguments makes no difference
same_picture()
{
    local what=$1 scene=$TMPDIR/$2.scn quirk=$3
    shift 3
    "$MCRENDER" "$scene" --quiet -o "$TMPDIR/plain.pfm" "$@" 2>"$TMPDIR/log" && "$MCRENDER" "$scene" --quiet -o "$TMPDIR/quirk.pfm" --compat "$quirk" "$@" 2>"$TMPDIR/log"
    check "$what" cmp "$TMPDIR/plain.pfm" "$TMPDIR/quirk.pfm"
}

# A furnace from inside: radiance `glow` from everywhere, of what comes in `rho` goes out again. `cosine` weighs all paths alike.
cat >"$TMPDIR/furnace.scn" <<'TEXT'
mcrender 1
let rho = 0.5
let glow = 0.3
let sky = 0.7
camera perspective { from (0.1, -0.2, 0.15)   to (1, 0.5, -0.7)   fov 70 }
film { size (16, 16) }
render { roulette off   depth 4   spp 16   sampler cosine   background sky }
material wall emitter { radiance glow   albedo rho   sides two }
box { min (-1, -1, -1)   max (1, 1, 1)   material wall }
TEXT
# A floor of albedo 1 below a lamp of radius 1 at height 1: directions with cos > sqrt(.5) meet it. S16 of analytic-scenes, half of all light.
cat >"$TMPDIR/floor.scn" <<'TEXT'
mcrender 1
let glow = 1
camera perspective { from (0.3, 0.2, 0.5)   to (0, 0, 0)   up (0.1, 0.9, 0.3)   fov 1e-9 }
film { size (16, 16) }
render { roulette off   depth 1   spp 1024 }
material white lambert { albedo 1 }
material lamp emitter { radiance glow }
plane { point (0, 0, 0)   normal (0, 0, 1)   material white }
disk { center (0, 0, 1)   normal (0, 0, -1)   radius 1   material lamp }
TEXT

# ---- clamp: L_b = min(1, e_b + w_b L_(b+1)) ----
exactly 'furnace as it is: .3 (1 + .5 + .25 + .125 + .0625)' furnace .58125
same_picture 'a clamp that is never reached changes no bit' furnace clamp
exactly 'clamp, glow .8: .8 + .5 min(1, ...) = 1.3 is clamped at every hit' furnace 1 --compat clamp --set glow=.8
# Hits 0 to 3 come before the limit, at which 100 comes in: .2 + .5 * 100 -> 1, .7, .55, .475
exactly 'clamp and background-at-limit: 1, .7, .55, .475' furnace .475 --compat clamp,background-at-limit --set glow=.2 --set sky=100
# The lamp's 10 is clamped to 1 before it is weighed. With `cosine`, w = 1 for half of the directions; with `uniform`, w = 2 cos > 1 for 1 - sqrt(.5) of them.
nearly 'clamp, radiance 10, cosine: .5 min(1, 1)' floor .5 --compat clamp --set glow=10 --sampler cosine
nearly 'clamp, radiance 10, uniform: (1 - sqrt .5) min(1, 2 cos)' floor .29289321881345254 --compat clamp --set glow=10 --sampler uniform
# radiance .6: 2 cos * .6 > 1 where cos > 5/6. Integral over cos from sqrt(.5) to 5/6 of 1.2 cos, and 1/6: .6 (25/36 - 1/2) + 1/6
nearly 'clamp, radiance .6, uniform' floor .28333333333333333 --compat clamp --set glow=.6 --sampler uniform
nearly 'the same without clamp' floor .3 --set glow=.6 --sampler uniform

# ---- background-at-limit: behind scattering event `depth`, the background ----
exactly 'background-at-limit: .3 (1 + .5 + .25 + .125) + .0625 * .7' furnace .60625 --compat background-at-limit
exactly 'background-at-limit, depth 0: background alone' furnace .7 --compat background-at-limit --depth 0
exactly 'background-at-limit, depth 1: emission, and .5 * .7' furnace .65 --compat background-at-limit --depth 1

# ---- disk-polar: half of the points within half of the radius, instead of a quarter ----
# Through the point of focus, a point of the lens is seen mirrored at twice the distance.
cat >"$TMPDIR/lens.scn" <<'TEXT'
mcrender 1
camera thinlens { from (0, 0, 0)   to (0, 0, -1)   fov 1e-9   lens_radius 1   focus_distance 1 }
film { size (16, 16) }
render { depth 0   spp 1024   sampler uniform }
material lamp emitter { radiance 1 }
disk { center (0, 0, -2)   normal (0, 0, 1)   radius 0.5   material lamp }
TEXT
nearly 'a lens' lens .25
nearly 'disk-polar: a lens' lens .5 --compat disk-polar
nearly 'disk-polar asked of a sampler leaves the lens alone' lens .25 --sampler 'cosine(compat=disk-polar)'
# cosine: sin = u instead of sqrt(u), and below sqrt(.5) the lamp is met
nearly 'disk-polar: cosine' floor .70710678118654752 --compat disk-polar --sampler cosine
nearly 'disk-polar: an expression' floor .70710678118654752 --sampler 'mixture(cosine(compat=disk-polar) 1)'
nearly 'disk-polar: an expression that says none' floor .5 --compat disk-polar --sampler 'cosine(compat=none)'

# ---- sphere-spherical: normal + r (cos p sin t, sin p cos t, cos t) ----
# The lamp is met where r A <= 1 + r c, A^2 = (cos p sin t)^2 + (sin p cos t)^2, c = cos t: for a share min(1, 1 / (A - c)) of r.
share=$(awk 'BEGIN {
    n = 500; pi = atan2(0, -1)
    for (i = 0; i < n; i++) for (j = 0; j < n; j++) {
        t = (i + .5) / n * pi; p = (j + .5) / n * pi / 2
        a = sqrt((cos(p) * sin(t)) ^ 2 + (sin(p) * cos(t)) ^ 2) - cos(t)
        s += a > 1 ? 1 / a : 1
    }
    printf "%.9g", s / n / n }')
holds 's > 0.70711 && s < 1' s="$share"
point $? "sphere-spherical: the share by quadrature is $share"
nearly 'sphere-spherical' floor "$share" --compat sphere-spherical --sampler cosine --spp 4096
nearly 'sphere-spherical goes before disk-polar' floor "$share" --compat disk-polar,sphere-spherical --sampler cosine --spp 4096

# ---- floor-sqrt: the other samples are black ----
exactly 'floor-sqrt, 7 samples: 4/7' furnace "$(calculate '.58125 * 4 / 7')" --compat floor-sqrt --sampler 'stratified(cosine)' --spp 7
exactly 'floor-sqrt, 1000 samples: 961/1000' furnace "$(calculate '.58125 * 961 / 1000')" --compat floor-sqrt --sampler 'stratified(cosine)' --spp 1000 --replicates 1
exactly 'floor-sqrt, 2 replicates of 15 samples: 9/15 each' furnace "$(calculate '.58125 * 9 / 15')" --compat floor-sqrt --sampler 'stratified(cosine)' --spp 30
exactly 'floor-sqrt by the expression' furnace "$(calculate '.58125 * 9 / 10')" --sampler 'stratified(compat=floor-sqrt, cosine)' --spp 10
same_picture 'floor-sqrt: a square number of samples is what it was' furnace floor-sqrt --sampler 'stratified(cosine)' --spp 50 --replicates 2

# ---- with several techniques ----
if ! ${MCR_CC:-cc} -std=gnu17 -O2 -shared -fPIC -I"$srcdir/src" "$srcdir/tests/core/neelight.c" -o "$TMPDIR/neelight.so" -lm; then
    point 1 'neelight.c compiles'
    finish
fi
# At depth 1 `nee` looks for the lamps in vain and goes on as `cosine` does; `neelight` shares the background out between two ways to find it.
for sampler in nee neelight; do
    set -- --plugin "$TMPDIR/neelight.so" --sampler "$sampler" --spp 256
    nearly "$sampler: background-at-limit" furnace .60625 --compat background-at-limit "$@"
    [ $sampler = nee ] && exactly "$sampler: background-at-limit, depth 1" furnace .65 --compat background-at-limit --depth 1 "$@"
    [ $sampler = nee ] || nearly "$sampler: background-at-limit, depth 1" furnace .65 --compat background-at-limit --depth 1 "$@"
    same_picture "$sampler: a clamp that is never reached changes no bit" furnace clamp "$@" --set glow=1e-9
    exactly "$sampler: a clamp that is always reached" furnace 1 --compat clamp "$@" --set glow=9
done
finish
