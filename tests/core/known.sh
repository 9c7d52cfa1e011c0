# SPDX-License-Identifier: Apache-2.0
# Scenes with a known answer: the mean within 4 standard errors, at an error below 0.2 %, with every sampler that covers the integrand.
# The names S1 ... are those of the project's table of analytic scenes. What takes longest is left to known_long.sh, which sets part=long.
part=${part:-quick}
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"

near='(0.3, 0.2, 0.5)'
lights='light(by=area);light(by=solid-angle)'
mixed='mixture(cosine 1, light 1);mixture(cosine 1, light(by=area) 1);stratified(mixture(cosine 1, light 1));independent(mixture(uniform 1, cosine 1, light 1))'
all="uniform;cosine;$lights;$mixed"
S()
{
    local what=$1
    shift
    known "$what" "$TMPDIR/scene.scn" "$@"
}

# S2: rectangles parallel to the receiver
receiver scene "$near" 'quad { corner (-1, -1, 1)   u (0, 2, 0)   v (2, 0, 0)   material lamp }'
S 'S2, centred' .55412642397957 "$all"
receiver scene "$near" 'quad { corner (-2.5, -1.5, 1)   u (0, 2, 0)   v (2, 0, 0)   material both }'
S 'S2, receiver at (1.5, .5), two sides' .14748482740113 "$all"
receiver scene "$near" 'quad { corner (-0.005, -0.005, 1)   u (0, 0.01, 0)   v (0.01, 0, 0)   material lamp }'
S 'S2, .01 x .01' 3.182992762256e-5 "$lights;mixture(cosine 1, light 1)"
receiver scene '(0.003, 0.002, 0.005)' 'quad { corner (-1, -1, 0.01)   u (0, 2, 0)   v (2, 0, 0)   material lamp }'
S 'S2, h = .01' .99991817594388 "uniform;cosine;light(by=solid-angle);mixture(cosine 1, light 1);stratified(mixture(cosine 1, light 1))"

# S3: a rectangle that stands on the receiver's plane
receiver scene '(0.3, 0.2, 0.5)' 'quad { corner (1, 0, 0)   u (0, 0, 1)   v (0, 1, 0)   material lamp }'
S S3 .055734197002554 "$all"

# S4: disks
receiver scene "$near" 'disk { center (0, 0, 1)   normal (0, 0, -1)   radius 1   material lamp }'
S 'S4, coaxial' .5 "$all"
S 'S4, coaxial, albedo .25' .125 'cosine;light;mixture(cosine 1, light 1)' --set rho=0.25
receiver scene "$near" 'disk { center (0, 1.5, 1)   normal (0, 0, -1)   radius 1   material lamp }'
S 'S4, off the axis' .12629534065817 "$all"
receiver scene "$near" 'disk { center (0, 0, 2)   normal (0, 0, -1)   radius 0.5   material lamp }'
S 'S4, R = .5, h = 2' .058823529411765 "$all"

# S5: spheres above the horizon
receiver scene "$near" 'sphere { center (0, 0, 2)   radius 0.5   material lamp }'
S 'S5, overhead' .0625 "$all"
receiver scene "$near" 'sphere { center (-2 * sin(60), 0, 2 * cos(60))   radius 0.5   material lamp }'
S 'S5, 60 degrees' .03125 "$all"

# S6: spheres that cross it
for case in 80/.054695816445537 90/.028834442811219 110/.0021495675176078; do
    receiver scene '(1, 0.3, 1)' "let angle = ${case%/*} sphere { center (-2 * sin(angle), 0, 2 * cos(angle))   radius 1   material lamp }"
    S "S6, ${case%/*} degrees" "${case#*/}" "$all"
done

# S14: half of a light behind an occluder
light='quad { corner (-1, -1, 2)   u (0, 2, 0)   v (2, 0, 0)   material lamp }'
receiver scene "$near" "$light"
S 'S14 without its occluder' .23945647046077 'cosine;light;mixture(cosine 1, light 1)'
receiver scene '(0.6, 0.2, 0.5)' "$light quad { corner (-50, -50, 1)   u (50.25, 0, 0)   v (0, 100, 0)   material black }"
S S14 .05354562144698 "$all"

# S20: a triangle, alone and in a mesh
receiver scene "$near" 'triangle { a (0, 0, 2)   b (0, 1, 3)   c (1, 0, 2)   material lamp }'
S S20 .023717994556414 "$all"
receiver scene "$near" 'mesh { vertices ((0, 0, 2), (0, 1, 3), (1, 0, 2), (0.5, 0, 2))   faces ((0, 1, 3), (3, 1, 2))   material lamp }'
S 'S20, in two halves' .023717994556414 "cosine;$lights;mixture(cosine 1, light 1)"

# S1: closed furnaces, Le = 1. Cut at depth D: (1 - rho^(D+1)) / (1 - rho); with cosine each sample is exact.
furnace()
{
    S "S1, $1, rho .8, D = 1" 1.8 "cosine;uniform;$2" --set rho=0.8 --depth 1
    S "S1, $1, rho .8, D = 8" 4.32891136 "cosine;uniform;$2" --set rho=0.8 --depth 8
    S "S1, $1, rho .5, D = 8" 1.99609375 "cosine;$2" --set rho=0.5 --depth 8
    S "S1, $1, rho .8" 5 'cosine' --set rho=0.8 --depth 200
    S "S1, $1, rho .99, D = 64" 47.965947734969 'cosine' --set rho=0.99 --depth 64
    S "S1, $1, rho 1, D = 10" 11 'cosine' --depth 10
}
closed scene 'sphere { center (0, 0, 0)   radius 2   material wall }'
S 'S1, sphere, D = 0' 1 'cosine;mixture(cosine 1, light 1)' --depth 0
furnace sphere 'mixture(cosine 1, light 1);mixture(cosine 1, light(by=area) 1);stratified(mixture(cosine 1, light 1))'
closed scene 'box { min (-2, -1, -1.5)   max (1.5, 2, 3)   transform { rotate (1, 2, 3, 40) }   material wall }'
furnace 'turned box' 'mixture(cosine 1, light 1)'
closed scene 'let a = -1 let b = 1
    quad { corner (a, a, a)   u (0, 2, 0)   v (0, 0, 2)   material wall }   quad { corner (b, a, a)   u (0, 0, 2)   v (0, 2, 0)   material wall }
    quad { corner (a, a, a)   u (0, 0, 2)   v (2, 0, 0)   material wall }   quad { corner (a, b, a)   u (2, 0, 0)   v (0, 0, 2)   material wall }
    quad { corner (a, a, a)   u (2, 0, 0)   v (0, 2, 0)   material wall }   quad { corner (a, a, b)   u (0, 2, 0)   v (2, 0, 0)   material wall }'
S 'S1, six quads, rho .8, D = 8' 4.32891136 'cosine;mixture(cosine 1, light 1)' --set rho=0.8 --depth 8
closed scene 'sphere { center (0, 0, 0)   radius 2   transform { scale (1, 0.7, 1.5)   rotate (3, 1, 2, 25) }   material wall }'
S 'S1, ellipsoid, rho .8, D = 8' 4.32891136 'cosine;uniform;mixture(cosine 1, light 1)' --set rho=0.8 --depth 8
closed scene 'mesh {
    vertices ((-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1))
    faces ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
    transform { scale 1.5   rotate (1, 1, 3, 20) }   material wall }'
S 'S1, mesh, rho .8, D = 8' 4.32891136 'cosine;mixture(cosine 1, light 1)' --set rho=0.8 --depth 8
S 'S1, mesh, rho .8, D = 8, bvh' 4.32891136 'cosine' --set rho=0.8 --depth 8 --accel bvh

# As many events a path as 1e6: it ends, and nothing has worn away. Every sample is the same up to rounding: 3 roundings an event at most.
closed scene 'sphere { center (0, 0, 0)   radius 2   material wall }'
sed 's/roulette off/roulette on(from=0)/' "$TMPDIR/scene.scn" >"$TMPDIR/roulette.scn"
[ $part = quick ] && depth=100000 || depth=1000000
for scene in scene roulette; do
    render "$TMPDIR/$scene.scn" --sampler cosine --depth $depth --size 4x4 --spp 1
    holds 'abs(mean / (depth + 1) - 1) < 3 * depth * 1.2e-16' mean="$mean" depth=$depth
    point $? "S1, $scene, rho 1, D = $depth: $mean"
done

# S9: two infinite planes; an infinite plane is no light to sample. The answers hold for all of the picture, so that the film's strata matter.
planes()
{
    { preamble "camera perspective { from (0.2, 0.1, 0.4)   to $1   up (1, 0, 0)   fov 80 }"
      cat <<'TEXT'
material top emitter { radiance 1   albedo 0.3 * rho }
material bottom lambert { albedo 0.6 }
plane { point (0, 0, 1)   normal (0, 0, -1)   material top }
plane { point (0, 0, 0)   normal (0, 0, 1)   material bottom }
TEXT
    } >"$TMPDIR/scene.scn"
}
# At depth 60 the rest, .18^30, is below rounding. With roulette, the noisy ones are shorter.
roulette()
{
    sed -i 's/roulette off/roulette on(from=2)/' "$TMPDIR/scene.scn"
}
planes '(0.2, 0.1, 1)'
S 'S9, top' 1.2195121951220 'uniform;cosine;stratified(cosine)' --depth 60
roulette
S 'S9, top, roulette' 1.2195121951220 'uniform;cosine;stratified(uniform);mixture(cosine 1, uniform 1)' --depth 60
planes '(0.2, 0.1, 0)'
S 'S9, bottom' .73170731707317 'cosine;stratified(cosine)' --depth 60
roulette
S 'S9, bottom, roulette' .73170731707317 'uniform;cosine;stratified(n=3, m=5, mixture(cosine 1, uniform 3))' --depth 60

# S10: concentric spheres
spheres()
{
    { preamble "camera perspective { from (1.2, 0.9, 0.1)   to $1   fov 30 }"
      cat <<'TEXT'
material inner emitter { radiance 1   albedo 0.3 * rho }
material outer lambert { albedo 0.6 }
sphere { center (0, 0, 0)   radius 1   material inner }
sphere { center (0, 0, 0)   radius 2   material outer }
TEXT
    } >"$TMPDIR/scene.scn"
}
spheres '(0, 0, 0)'
S 'S10, inner' 1.0891089108911 "uniform;cosine;$mixed" --depth 60
roulette
S 'S10, inner, roulette' 1.0891089108911 "uniform;cosine;$mixed" --depth 60
spheres '(3, 2, 0)'
S 'S10, outer' .2970297029703 "uniform;cosine;$mixed" --depth 60
S 'S10, outer, D = 1' .15 "$all"
roulette
S 'S10, outer, roulette' .2970297029703 "uniform;cosine;$mixed" --depth 60

# S18: a plane under a constant environment; uniform has the variance rho^2 / 3
{ preamble 'camera orthographic { from (0, 0, 5)   to (0, 0, 0)   height 3 }'
  echo 'material ground lambert { albedo 0.7 * rho }   plane { point (0, 0, 0)   normal (0, 0, 1)   material ground }'
} | sed 's/roulette off/background 1 roulette off/' >"$TMPDIR/scene.scn"
S S18 .7 'uniform;cosine;stratified(uniform);mixture(uniform 1, cosine 3)' --depth 5
if [ $part = quick ]; then
    render "$TMPDIR/scene.scn" --sampler uniform --size 16x16 --spp 4096
    holds 'abs(variance / (0.49 / 3) - 1) < 0.01' variance="$variance"
    point $? "S18: uniform's variance of one sample: $variance, expected rho^2 / 3"
fi

finish
