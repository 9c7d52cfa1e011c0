# SPDX-License-Identifier: Apache-2.0
# Renders in rounds: a sample map gives the same bits again, however it is run; with equal numbers they are those of a plain render; and a target
# is reached on a scene whose answer is known.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"
box=$srcdir/scenes/cornell-box.scn
isas=baseline
for isa in avx2 avx512; do "$MCRENDER" check "$box" --isa $isa >"$TMPDIR/log" 2>&1 && isas="$isas $isa"; done

draw() # FILE ARGUMENT...
{
    local file=$1
    shift
    "$MCRENDER" "$box" --size 40x30 --depth 6 --seed 5 --quiet -o "$file" "$@"
}

for sampler in 'mixture(cosine 1, light 1)' 'stratified(mixture(cosine 1, light 1))' 'sobol(nee)' 'bluenoise(nee)'; do
    wrong=
    draw "$TMPDIR/first.pfm" --sampler "$sampler" --spp 96 --adaptive --sample-map "$TMPDIR/map.pfm" --threads 2 || wrong="no picture"
    [ "$(tail -c 4800 "$TMPDIR/map.pfm" | od -An -v -f -w4 | sort -u | wc -l)" -gt 4 ] || wrong="$wrong; no differences in the map"
    for way in "--threads 1" "--threads 3 --batch 8" "--batch 100" "--accel bvh" $isas; do
        [ "${way#--}" != "$way" ] || way="--isa $way"
        draw "$TMPDIR/other.pfm" --sampler "$sampler" --use-map "$TMPDIR/map.pfm" --sample-map "$TMPDIR/again.pfm" $way || wrong="$wrong; $way fails"
        cmp -s "$TMPDIR/first.pfm" "$TMPDIR/other.pfm" && cmp -s "$TMPDIR/map.pfm" "$TMPDIR/again.pfm" || wrong="$wrong; $way"
        draw "$TMPDIR/other.pfm" --sampler "$sampler" --spp 96 --adaptive $way
        cmp -s "$TMPDIR/first.pfm" "$TMPDIR/other.pfm" || wrong="$wrong; decisions, $way"
    done
    empty "$sampler: decisions and the map's picture have the same bits for all ways to run it" "$wrong"
    draw "$TMPDIR/plain.pfm" --sampler "$sampler" --spp 48 --replicates 3
    draw "$TMPDIR/even.pfm" --sampler "$sampler" --spp 48 --target-error 1e-9
    if [ "$sampler" = 'mixture(cosine 1, light 1)' ]; then draw "$TMPDIR/plain.pfm" --sampler "$sampler" --spp 48; fi
    check "$sampler: rounds of all pixels are the replicates of a plain render" cmp "$TMPDIR/plain.pfm" "$TMPDIR/even.pfm"
done

# A disk above a diffuse floor: every pixel is the same answer, and the picture's error is what is said.
receiver scene '(0.3, 0.2, 0.5)' 'disk { center (0, 0, 1)   normal (0, 0, -1)   radius 1   material lamp }'
for how in '' --adaptive; do
    for sampler in cosine 'stratified(mixture(cosine 1, light 1))'; do
        render "$TMPDIR/scene.scn" --sampler "$sampler" --target-error 0.02 $how
        holds 'abs(mean - 0.5) <= 4 * error && error < 0.02 * 0.5 / 16 * 1.05 && error > 0.02 * 0.5 / 16 / 1.5' mean="$mean" error="$error"
        point $? "target 0.02 $how, $sampler: $mean +- $error (256 pixels), expected 0.5"
        check "$sampler: the report says that it is reached" grep -q '"target_reached": true' "$TMPDIR/out.json"
    done
done
finish
