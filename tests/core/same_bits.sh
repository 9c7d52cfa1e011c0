# SPDX-License-Identifier: Apache-2.0
# Determinism: threads, batch size, instruction set, accelerator, crop and the C library's own choice of instructions never change a bit.
. "$srcdir/tests/tap.sh"

picture() # SCENE ARGUMENT...: a PFM, floats as they are, on standard output
{
    "$MCRENDER" "$@" --quiet -o "$TMPDIR/picture.pfm" 2>"$TMPDIR/messages" && cat "$TMPDIR/picture.pfm"
}

isas=baseline
for isa in avx2 avx512; do
    "$MCRENDER" check "$srcdir/scenes/cornell-box.scn" --isa $isa >"$TMPDIR/log" 2>&1 && isas="$isas $isa"
done
echo "# instruction sets: $isas"
ways=("--threads 1" "--threads 2" "--threads 7" "--batch 1" "--batch 8" "--batch 100" "--batch 1000" "--batch 4096" "--accel list" "--accel bvh")
for isa in $isas; do ways+=("--isa $isa"); done
ways+=("--threads 7 --batch 8 --isa baseline --accel bvh" "--threads 1 --batch 4096 --accel list")
# Sanitizers look for what is read or written out of place, not for bits: every kind of way once.
[ "$MCR_SANITIZED" != 1 ] || ways=("--threads 7 --batch 8 --isa baseline --accel bvh" "--threads 1 --batch 4096 --accel list" "--isa ${isas##* } --batch 100")

# A short last cell (21 = 16 + 5), replicates of different length (10 and 11), paths deep enough for roulette.
compare()
{
    local name=$1 scene=$2 wrong= way
    shift 2
    set -- "$scene" "$@" --size 64x48 --depth 8 --seed 7
    picture "$@" >"$TMPDIR/first.pfm" || wrong="no picture"
    [ "$(tail -c +20 "$TMPDIR/first.pfm" | od -An -v -f -w4 | sort -u | wc -l)" -gt 40 ] || wrong="$wrong; hardly a picture"
    for way in "${ways[@]}"; do
        picture "$@" $way >"$TMPDIR/other.pfm" && cmp -s "$TMPDIR/first.pfm" "$TMPDIR/other.pfm" || wrong="$wrong; $way"
    done
    GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F picture "$@" >"$TMPDIR/other.pfm"
    cmp -s "$TMPDIR/first.pfm" "$TMPDIR/other.pfm" || wrong="$wrong; GLIBC_TUNABLES"
    picture "$@" --crop 13,9,50,41 >"$TMPDIR/other.pfm"
    parts "$TMPDIR/first.pfm" "$TMPDIR/other.pfm" || wrong="$wrong; crop"
    empty "$name: the same bits for ${#ways[@]} ways to run it" "$wrong"
}

# parts FULL CROP: rows of a PFM come from the bottom; 64x48 and the part 13,9 to 50,41 of it, three floats a pixel
parts()
{
    local row
    [ "$(stat -c %s "$2")" = $((37 * 32 * 12 + $(sed 3q "$2" | wc -c))) ] || return 1
    for row in 0 1 15 31; do
        cmp -s <(tail -c $((64 * 48 * 12)) "$1" | tail -c +$((1 + ((48 - 41 + row) * 64 + 13) * 12)) | head -c $((37 * 12))) \
            <(tail -c $((37 * 32 * 12)) "$2" | tail -c +$((1 + row * 37 * 12)) | head -c $((37 * 12))) || return 1
    done
}

for scene in "$srcdir"/scenes/*.scn; do
    name=${scene##*/}
    compare "${name%.scn}" "$scene" --spp 3
    lights='mixture(cosine 1, light 1)'
    [ "$name" = orthographic.scn ] && lights='mixture(cosine 1, uniform 1)'
    compare "${name%.scn}, stratified" "$scene" --spp 21 --sampler "stratified($lights)"
done
compare 'cornell-box, light by area' "$srcdir/scenes/cornell-box.scn" --spp 5 --sampler 'mixture(uniform 1, cosine 2, light(by=area) 3)'
compare 'every-shape, nee' "$srcdir/scenes/every-shape.scn" --spp 5 --sampler 'stratified(nee)'
compare 'cornell-box, bsdf and light' "$srcdir/scenes/cornell-box.scn" --spp 5 --sampler 'mixture(bsdf 2, light(by=area) 3)'

sed 's/filter box/filter mitchell/' "$srcdir/scenes/cornell-box.scn" >"$TMPDIR/mitchell.scn"
check 'a scene with mitchell' grep -q 'filter mitchell' "$TMPDIR/mitchell.scn"
compare 'cornell-box, mitchell' "$TMPDIR/mitchell.scn" --spp 21
for source in halton bluenoise antithetic; do compare "cornell-box, $source" "$srcdir/scenes/cornell-box.scn" --spp 7 --sampler "$source(nee)"; done

quirks=clamp,background-at-limit,disk-polar,sphere-spherical,floor-sqrt
compare 'spheres-thinlens, every quirk' "$srcdir/scenes/spheres-thinlens.scn" --spp 21 --sampler 'stratified(mixture(cosine 1, light 1))' --compat $quirks
compare 'cornell-box, quirks' "$srcdir/scenes/cornell-box.scn" --spp 5 --compat clamp,disk-polar

# The film is added up in passes where the pixels are few.
set -- "$srcdir/scenes/cornell-box.scn" --size 3x3 --spp 40000 --depth 2
picture "$@" --threads 1 --batch 100 >"$TMPDIR/first.pfm"
picture "$@" --threads 7 --batch 1000 >"$TMPDIR/other.pfm"
check '9 pixels, 40000 samples: the same bits for 1 and 7 threads' cmp "$TMPDIR/first.pfm" "$TMPDIR/other.pfm"

# The variance layer, with independent numbers and with replicates. (--accel is named in the file.)
skipped=
"$MCRENDER" "$srcdir/scenes/cornell-box.scn" --size 8x8 --spp 2 --quiet -o "$TMPDIR/first.exr" 2>"$TMPDIR/log" || skipped=$(cat "$TMPDIR/log")
for sampler in 'mixture(cosine 1, light 1)' 'stratified(mixture(cosine 1, light 1))'; do
    if [ -n "$skipped" ]; then skip "variance layer, $sampler" "$skipped"; continue; fi
    wrong=
    for way in "${ways[0]}" "${ways[@]}"; do
        SOURCE_DATE_EPOCH=1 "$MCRENDER" "$srcdir/scenes/cornell-box.scn" --size 24x20 --spp 37 --depth 8 --layers variance --sampler "$sampler" --quiet \
            -o "$TMPDIR/other.exr" ${way/--accel bvh/} || wrong="$wrong; no picture"
        [ "$way" = "${ways[0]}" ] && [ ! -e "$TMPDIR/layer.exr" ] && cp "$TMPDIR/other.exr" "$TMPDIR/layer.exr"
        cmp -s "$TMPDIR/layer.exr" "$TMPDIR/other.exr" || wrong="$wrong; $way"
    done
    rm -f "$TMPDIR/layer.exr"
    empty "variance layer, $sampler: the same bits for ${#ways[@]} ways to run it" "$wrong"
done

# And a seed does.
picture "$srcdir/scenes/cornell-box.scn" --size 64x48 --spp 3 --seed 1 >"$TMPDIR/first.pfm"
picture "$srcdir/scenes/cornell-box.scn" --size 64x48 --spp 3 --seed 2 >"$TMPDIR/other.pfm"
refute 'another seed gives another picture' cmp -s "$TMPDIR/first.pfm" "$TMPDIR/other.pfm"
finish
