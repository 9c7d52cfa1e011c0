# SPDX-License-Identifier: Apache-2.0
# sobol in whole pictures: known answers, the Cornell box as with independent numbers, rates of convergence, and the same bits however it is run.
# Errors come from replicates, which share the samples: 64 of them tell a variance to sqrt(2/63) = 18 %.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"

mixture='mixture(cosine 1, light 1)'

# S2, a square light; S9, two infinite planes: paths of many bounces, where a dimension that came back would show
receiver scene '(0.3, 0.2, 0.5)' 'quad { corner (-1, -1, 1)   u (0, 2, 0)   v (2, 0, 0)   material lamp }'
for sampler in uniform cosine light 'light(by=area)' "$mixture"; do
    render "$TMPDIR/scene.scn" --sampler "sobol($sampler)" --size 16x16 --spp 4096 --replicates 64 --seed 3
    agrees "S2, sobol($sampler)" .55412642397957
done
{ preamble 'camera perspective { from (0.2, 0.1, 0.4)   to (0.2, 0.1, 0)   up (1, 0, 0)   fov 80 }'
  cat <<'TEXT'
material top emitter { radiance 1   albedo 0.3 * rho }
material bottom lambert { albedo 0.6 }
plane { point (0, 0, 1)   normal (0, 0, -1)   material top }
plane { point (0, 0, 0)   normal (0, 0, 1)   material bottom }
TEXT
} | sed 's/roulette off/roulette on(from=0)/' >"$TMPDIR/planes.scn"
for sampler in 'sobol(uniform)' 'stratified(sobol(mixture(cosine 1, uniform 3)))'; do
    render "$TMPDIR/planes.scn" --sampler "$sampler" --size 16x16 --spp 16384 --replicates 64 --depth 60 --seed 3
    agrees "S9, roulette, $sampler" .73170731707317
done

# The Cornell box: the mean and its error, against independent numbers
box=$srcdir/scenes/cornell-box.scn
render "$box" --sampler "$mixture" --size 32x32 --spp 1024 --seed 5
reference=$mean reference_error=$error
render "$box" --sampler "sobol($mixture)" --size 32x32 --spp 1024 --replicates 64 --seed 6
holds 'x > 0 && y > 0 && y < x && y < 0.003 * b && abs(a - b) <= 4 * sqrt(x ^ 2 + y ^ 2)' a="$reference" b="$mean" x="$reference_error" y="$error"
point $? "Cornell box: $mean +- $error, independent $reference +- $reference_error"

# Smooth direct light, 2 dimensions: N^-3 log N; an edge through the pixels: N^-1.5; independent numbers: N^-1, which shows that this measures.
rate 'smooth light' "$TMPDIR/scene.scn" 'sobol(light(by=area))' -2.3
rate 'smooth light' "$TMPDIR/scene.scn" 'sobol(cosine)' -1.2
{ preamble 'camera orthographic { from (0, 0, 5)   to (0, 0, 0)   height 4 }'
  echo 'material lamp emitter { radiance 1 }   disk { center (0.1, 0.2, 0)   normal (0, 0, 1)   radius 1.3   material lamp }'
} >"$TMPDIR/edge.scn"
rate edge "$TMPDIR/edge.scn" 'sobol(cosine)' -1.2
rate edge "$TMPDIR/edge.scn" 'independent(cosine)' -0.8
holds 'slope > -1 - 4 * 0.049' slope="$slope"
point $? "edge, independent: N^$slope is no better than N^-1"

# The same bits, also with replicates of different length (10 and 11)
same()
{
    "$MCRENDER" "$box" --sampler "sobol($mixture)" --size 48x32 --spp 21 --depth 8 --seed 7 --quiet -o "$TMPDIR/$1.pfm" "${@:2}" 2>"$TMPDIR/messages"
}
same first
wrong=
ways=('--threads 1' '--threads 7' '--batch 1' '--batch 100' '--batch 4096' '--isa baseline')
for isa in avx2 avx512; do
    "$MCRENDER" check "$box" --isa $isa >"$TMPDIR/log" 2>&1 && ways+=("--isa $isa")
done
for way in "${ways[@]}"; do
    same other $way && cmp -s "$TMPDIR/first.pfm" "$TMPDIR/other.pfm" || wrong="$wrong; $way"
done
empty "the same bits for ${#ways[@]} ways to run it" "$wrong"

# It stands outside of directions, with one sampler inside
refute 'sobol without a sampler inside' "$MCRENDER" check "$box" --sampler 'sobol'
refute 'sobol within a mixture' "$MCRENDER" check "$box" --sampler 'mixture(sobol(cosine) 1, light 1)'
finish
