# SPDX-License-Identifier: Apache-2.0
# Number sources in whole pictures: none is biased, by themselves and in chains, however long the path; the rates and variances that theory gives; and
# pictures whose errors cancel between neighbours. (sobol.sh has more of sobol.)
#
# What biases an image is a source whose dimensions come back along the path: paths that are alike at every bounce. repeats.c has two such sources, for
# which the same measurements must fail.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"
${MCR_CC:-cc} -std=gnu17 -O2 -shared -fPIC -I"$srcdir/src" "$srcdir/tests/core/repeats.c" -o "$TMPDIR/repeats.so" ||
    { point 1 "repeats.c compiles"; finish; }

# Chains take what the outer source does not supply from the inner one. @: the sampler inside.
sources='independent(@);stratified(@);sobol(@);halton(@);bluenoise(@);antithetic(@)'
chains='stratified(sobol(@));stratified(n=3, m=3, halton(@));antithetic(of=pixel, bluenoise(@));antithetic(of=bounces, stratified(@));antithetic(of=camera, sobol(@))'
IFS=';' read -ra all <<<"$sources;$chains"
mixture='mixture(cosine 1, light 1)'

# S11: a sphere of albedo .8 with a black emitting cap, 4 scattering events
{ preamble 'camera perspective { from (0.1, 0.2, 0.3)   to (0.3, -0.5, -0.7)   fov 50 }'
  cat <<'TEXT'
material wall lambert { albedo 0.8 }
material lamp emitter { radiance 1 }
sphere { center (0, 0, 0)   radius 1   material wall }
disk { center (0, 0, cos(30))   normal (0, 0, -1)   radius sin(30)   material lamp }
TEXT
} >"$TMPDIR/sphere.scn"
s11=.14573137011522
for inner in "$mixture" nee; do
    for source in "${all[@]}"; do
        render "$TMPDIR/sphere.scn" --sampler "${source/@/$inner}" --depth 4 --size 16x16 --spp 1024 --replicates 64 --seed 3
        agrees "S11, D = 4, ${source/@/$inner}" $s11
    done
    for source in repeats repeats-twice; do
        render "$TMPDIR/sphere.scn" --plugin "$TMPDIR/repeats.so" --sampler "$source($inner)" --depth 4 --size 16x16 --spp 1024 --seed 3
        holds 'error > 0 && abs(mean - answer) > 6 * error' mean="$mean" error="$error" answer=$s11
        point $? "S11, D = 4, $source($inner) is caught: $(calculate '100 * (mean / answer - 1)' mean="$mean" answer=$s11 | cut -c1-6) %"
    done
done

# S9: two infinite planes, paths of up to 60 events with roulette; odd numbers of samples, no power of anything
{ preamble 'camera perspective { from (0.2, 0.1, 0.4)   to (0.2, 0.1, 0)   up (1, 0, 0)   fov 80 }'
  cat <<'TEXT'
material top emitter { radiance 1   albedo 0.3 * rho }
material bottom lambert { albedo 0.6 }
plane { point (0, 0, 1)   normal (0, 0, -1)   material top }
plane { point (0, 0, 0)   normal (0, 0, 1)   material bottom }
TEXT
} | sed 's/roulette off/roulette on(from=0)/' >"$TMPDIR/planes.scn"
for source in 'halton(uniform)' 'bluenoise(uniform)' 'antithetic(uniform)' 'antithetic(of=pixel, halton(mixture(cosine 1, uniform 3)))'; do
    render "$TMPDIR/planes.scn" --sampler "$source" --size 16x16 --spp 3465 --replicates 35 --depth 60 --seed 3
    agrees "S9, roulette, $source" .73170731707317
done

# The Cornell box in 9 blocks, against independent numbers: the greatest |z|, and the greatest difference in percent
box=$srcdir/scenes/cornell-box.scn
block() # SAMPLER SEED X Y ARGUMENT...
{
    render "$box" --sampler "$1" --size 36x36 --crop "$3,$4,$(($3 + 12)),$(($4 + 12))" --spp 245 --replicates 35 --depth 6 --seed "$2" "${@:5}"
}
for y in 0 12 24; do for x in 0 12 24; do block "$mixture" 21 $x $y && echo "$mean $error"; done; done >"$TMPDIR/reference"
blocks() # SAMPLER ARGUMENT...: sets z and percent
{
    local x y
    for y in 0 12 24; do for x in 0 12 24; do block "$1" 22 $x $y "${@:2}" && echo "$mean $error"; done; done >"$TMPDIR/blocks"
    read -r z percent <<<"$(paste -d' ' "$TMPDIR/reference" "$TMPDIR/blocks" | awk '
        function abs(x) { return x < 0 ? -x : x }
        NF == 4 && $2 > 0 && $4 > 0 { n++; d = abs($3 - $1); t = d / sqrt($2 ^ 2 + $4 ^ 2); if (t > z) z = t; if (100 * d / $1 > p) p = 100 * d / $1 }
        END { printf "%.2f %.2f\n", n == 9 ? z : 999, p }')"
}
for source in "${all[@]:1:7}"; do
    blocks "${source/@/$mixture}"
    holds 'z <= 4' z="$z"
    point $? "Cornell box in blocks, ${source/@/$mixture}: |z| up to $z, differences up to $percent %"
done
blocks "repeats($mixture)" --plugin "$TMPDIR/repeats.so"
holds 'z > 10 && percent > 5' z="$z" percent="$percent"
point $? "Cornell box in blocks, repeats is caught: |z| up to $z, differences up to $percent %"

# Rates (see `rate`): a point on a light has bases 3 and 5, the pixel 2 and 3. N^-2 in theory; an edge N^-1.5
receiver scene '(0.3, 0.2, 0.5)' 'quad { corner (-1, -1, 1)   u (0, 2, 0)   v (2, 0, 0)   material lamp }'
{ preamble 'camera orthographic { from (0, 0, 5)   to (0, 0, 0)   height 4 }'
  echo 'material lamp emitter { radiance 1 }   disk { center (0.1, 0.2, 0)   normal (0, 0, 1)   radius 1.3   material lamp }'
} >"$TMPDIR/edge.scn"
rate 'smooth light' "$TMPDIR/scene.scn" 'halton(light(by=area))' -1.6
rate edge "$TMPDIR/edge.scn" 'halton(cosine)' -1.1
rate 'smooth light' "$TMPDIR/scene.scn" 'bluenoise(light(by=area))' -2
rate edge "$TMPDIR/edge.scn" 'bluenoise(cosine)' -1.1

# Antithetic pairs. A pixel whose left part, a share c, is lit: V = c (1 - c); a pair's mean is 1/2 with probability 2c, else 0, for c < 1/2. With .3, V = .21
# and the pair's variance .06; three samples have (4 * .06 + .21) / 9 = .05. What is told is the variance of a replicate's mean times its samples; 4096
# replicates err by sqrt((kurtosis - 1) / 4096) < 2 %.
lit()
{
    { preamble 'camera orthographic { from (0, 0, 5)   to (0, 0, 0)   height 1 }'
      echo 'material lamp emitter { radiance 1 }'
      echo "quad { corner (-5, -5, 0)   u ($1 + 4.5, 0, 0)   v (0, 10, 0)   material lamp }"
    } >"$TMPDIR/lit.scn"
}
varies() # WHAT EXPECTED: the last render's variance
{
    holds 'abs(variance / expected - 1) < 0.08' variance="$variance" expected="$2"
    point $? "$1: $variance, expected $2"
}
lit 0.3
for case in 'independent 1 .21' 'antithetic 2 .12' 'antithetic 3 .15' 'antithetic(of=camera) 2 .12' 'antithetic(of=lens) 2 .21' 'antithetic(of=bounces) 2 .21'; do
    read -r word each expected <<<"$case"
    sampler="$word(cosine)"
    [ "$word" = "${word%)}" ] || sampler="${word%)}, cosine)"
    render "$TMPDIR/lit.scn" --sampler "$sampler" --size 1x1 --spp $((4096 * each)) --replicates 4096 --seed 1
    varies "a pixel lit in part, $sampler, $each samples" "$expected"
done
lit 0.5
render "$TMPDIR/lit.scn" --sampler 'antithetic(cosine)' --size 4x4 --spp 64 --replicates 32 --seed 1
[ "$mean $error" = '0.5 0' ]
point $? 'a pixel lit in half: no variance' "$mean +- $error"
# S18 with the sampler `uniform`: rho^2 / 3 for one sample. Its directions turn with u and v by half a turn: a pair is one sample drawn twice.
{ preamble 'camera perspective { from (0.3, 0.2, 0.5)   to (0, 0, 0)   up (0.1, 0.9, 0.3)   fov 1e-9 }' | sed 's/roulette off/background 1   roulette off/'
  echo 'material receiver lambert { albedo rho }   plane { point (0, 0, 0)   normal (0, 0, 1)   material receiver }'
} >"$TMPDIR/sky.scn"
render "$TMPDIR/sky.scn" --sampler 'uniform' --size 16x16 --spp 256 --seed 1
varies 'S18, uniform' .33333333
render "$TMPDIR/sky.scn" --sampler 'antithetic(uniform)' --size 16x16 --spp 256 --replicates 128 --seed 1
varies 'S18, antithetic(uniform), symmetric' .66666667

# Pictures of few samples: the variance of the means of blocks of 8 x 8 pixels, over that of the pixels, times 64: 1 for pixels that know nothing of each other.
# The receiver looks the same in every pixel. 64 blocks and 4 seeds tell a variance to sqrt(2 / 256) = 9 %.
whiteness() # SAMPLER SPP
{
    local seed
    for seed in 1 2 3 4; do
        "$MCRENDER" "$TMPDIR/scene.scn" --sampler "$1" --size 64x64 --spp "$2" --replicates 1 --seed $seed --quiet -o "$TMPDIR/out.pfm" 2>"$TMPDIR/messages" || return
        tail -c 49152 "$TMPDIR/out.pfm" | od -An -v -t f4 -w12 | awk -v answer=.55412642397957 '
            { e = $1 - answer; pixel = NR - 1; block[int(pixel / 512) * 8 + int(pixel % 64 / 8)] += e / 64; square += e * e / 4096 }
            END { for (b in block) sum += block[b] ^ 2; print NR == 4096 ? sum : -999, square }'
    done | awk '{ sum += $1; square += $2 } END { printf "%.3f\n", NR == 4 ? sum / square : -1 }'
}
for spp in 1 2 3 4; do
    for inner in 'light(by=area)' "$mixture"; do
        blue=$(whiteness "bluenoise($inner)" $spp) sobol=$(whiteness "sobol($inner)" $spp) white=$(whiteness "$inner" $spp)
        holds 'blue >= 0 && blue < 0.4 && abs(sobol - 1) < 0.36 && abs(white - 1) < 0.36' blue="$blue" sobol="$sobol" white="$white"
        point $? "$spp samples, $inner: blocks of pixels vary $blue times as much as independent pixels; with sobol $sobol, independent $white"
    done
done

# They stand outside of directions, with one sampler inside
for word in halton bluenoise antithetic; do
    refute "$word without a sampler inside" "$MCRENDER" check "$box" --sampler $word
    refute "$word within a mixture" "$MCRENDER" check "$box" --sampler "mixture($word(cosine) 1, light 1)"
done
refute 'an unknown choice' "$MCRENDER" check "$box" --sampler 'antithetic(of=time, cosine)'
finish
