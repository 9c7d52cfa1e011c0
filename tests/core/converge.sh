# SPDX-License-Identifier: Apache-2.0
# The Cornell box converges to one image, whatever the sampler and with and without Russian roulette: the mean luminance, and every pixel.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"

box=$srcdir/scenes/cornell-box.scn
mixture='mixture(cosine 1, light 1)'
for roulette in off 'on(from=0)'; do
    sed "s/^    depth   50/    depth 50   roulette $roulette/" "$box" >"$TMPDIR/roulette ${roulette%(*}.scn"
done
refute 'the scene was changed' cmp -s "$TMPDIR/roulette on.scn" "$box"

# Names of the variants, their scenes and samplers
names=("cosine" "mixture" "stratified" "roulette off" "roulette on" "light by area")
scenes=("$box" "$box" "$box" "$TMPDIR/roulette off.scn" "$TMPDIR/roulette on.scn" "$box")
samplers=(cosine "$mixture" "stratified($mixture)" "$mixture" "$mixture" 'mixture(uniform 1, cosine 2, light(by=area) 2)')

# The mean luminance, each with an own seed
for i in "${!names[@]}"; do
    case ${names[$i]} in cosine | 'roulette on') spp=2048 ;; *) spp=512 ;; esac
    render "${scenes[$i]}" --sampler "${samplers[$i]}" --size 32x32 --spp $spp --seed $((20 + i))
    means[$i]=$mean errors[$i]=$error
    holds 'error > 0 && error < 0.01 * mean' mean="$mean" error="$error"
    point $? "${names[$i]}: $mean +- $error"
done
for i in "${!names[@]}"; do
    [ "$i" = 1 ] && continue
    holds 'abs(a - b) <= 4 * sqrt(x ^ 2 + y ^ 2)' a="${means[$i]}" b="${means[1]}" x="${errors[$i]}" y="${errors[1]}"
    point $? "mean luminance: ${names[$i]} and mixture agree"
done

# Every pixel, from $seeds pictures each. With 48 of them the pixel means' differences over their errors follow Student's distribution with about 94
# degrees, which is beyond 3 with probability .0034; normal numbers are with .0027. Of 1024 pixels that is 3, and 4 standard errors more are 10.
# (Roulette from the first event on is too skewed for that: it ends nine in ten of the paths that aim at the lamp. known.sh has it.)
seeds=48
for i in 0 1 2; do
    [ "${samplers[$i]}" = cosine ] && spp=64 || spp=16
    for seed in $(seq $seeds); do
        render "${scenes[$i]}" --sampler "${samplers[$i]}" --size 32x32 --spp $spp --seed $((1000 * (i + 1) + seed)) --threads 1 || break
        tail -c $((32 * 32 * 12)) "$TMPDIR/out.pfm" | od -An -v -t f4 -w12
    done | awk -v pixels=1024 '
        { p = (NR - 1) % pixels; v = 0.2126 * $1 + 0.7152 * $2 + 0.0722 * $3; n[p]++; d = v - m[p]; m[p] += d / n[p]; s[p] += d * (v - m[p]) }
        END { for (p = 0; p < pixels; p++) printf "%.9g %.9g\n", m[p], s[p] / (n[p] * (n[p] - 1)) }' >"$TMPDIR/pixels.$i"
done
for i in 0 2; do
    outside=$(paste -d' ' "$TMPDIR/pixels.$i" "$TMPDIR/pixels.1" |
        awk '{ e = $2 + $4; d = $1 - $3; lit += $1 > 0; if (e > 0 ? d * d > 9 * e : d != 0) n++ } END { print (NR == 1024 && lit > 500) ? n + 0 : "no picture" }')
    holds 'n + 0 == n && n <= 10' n="$outside"
    point $? "pixels: ${names[$i]} and mixture differ by more than 3 standard errors in $outside of 1024"
done
finish
