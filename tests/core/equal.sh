# SPDX-License-Identifier: Apache-2.0
# Every scene of scenes/ converges to the same image under every sampler: `bsdf`, `nee`, `mixture(bsdf 1, light 1)` and `sobol` or `stratified` around
# them. Each is compared with `nee` of another seed, pixel by pixel and as a whole, with what their replicates tell of the noise: the share of pixels beyond 3 standard errors
# (of Student's t, so that few replicates count as what they are) is at most .27 % and 4 standard errors of it, and the mean is within 4.
. "$srcdir/tests/tap.sh"
if [ ! -f "$MCRENDER_MODULE_PATH/oiio.so" ]; then
    echo "1..0 # SKIP equal.sh: layers of variance are in EXR, and OpenImageIO's module is not built"
    exit 0
fi
size=${1:-24x24} replicates=32

# number KEY: of luminance, which comes last
number()
{
    sed -n 's/^ *"'"$1"'": \([-+.0-9e]*\),\{0,1\}$/\1/p' "$TMPDIR/compare.json" | tail -n 1
}

# picture NAME SCENE SPP SAMPLER SEED DEPTH
picture()
{
    "$MCRENDER" "$srcdir/scenes/$2.scn" -o "$TMPDIR/$1.exr" --layers variance --quiet --size "$size" --spp $((replicates * $3)) --replicates $replicates \
        --sampler "$4" --seed "$5" --depth "$6" "${settings[@]}" 2>"$TMPDIR/text" || point 1 "$2, $4" "$(cat "$TMPDIR/text")"
}

# equal_scene SCENE SPP DEPTH ARGUMENT...: SPP samples of one replicate
equal_scene()
{
    local scene=$1 spp=$2 depth=$3 sampler seed=2
    local samplers=(nee control 'mixture(bsdf 1, light 1)' 'sobol(nee)' 'stratified(mixture(bsdf 1, light 1))')
    shift 3
    case $with in
    bsdf) samplers=(bsdf) ;;
    all) samplers=(bsdf "${samplers[@]}") ;;
    esac
    settings=("$@")
    picture reference "$scene" "$spp" nee 1 "$depth"
    for sampler in "${samplers[@]}"; do
        picture picture "$scene" "$spp" "$sampler" $seed "$depth"
        "$MCRENDER" compare "$TMPDIR/picture.exr" "$TMPDIR/reference.exr" --confidence 0.9973 --json >"$TMPDIR/compare.json" 2>"$TMPDIR/text"
        awk -v share="$(number share)" -v tested="$(number tested)" -v p="$(number mean_p)" '
            BEGIN { most = .0027 + 4 * sqrt(.0027 * .9973 / (tested > 0 ? tested : 1)); exit !(tested > 100 && share != "" && share <= most && p > 6.3e-5) }'
        point $? "$scene $*, $sampler: beyond 3 standard errors: $(number share) of $(number tested) pixels; mean: p = $(number mean_p)" "$(cat "$TMPDIR/text" "$TMPDIR/compare.json")"
        seed=$((seed + 1))
    done
}

with=all
equal_scene cornell-box 32 50
equal_scene cornell-glass 128 20
equal_scene furnace 8 200
equal_scene many-lights 32 6
equal_scene still-life 64 8
equal_scene every-shape 64 8
equal_scene spheres-thinlens 32 8
# `bsdf` meets small lamps so seldom that the spread of its replicates tells nothing: with the lamps as they are, the others; with large ones, `bsdf`.
with=others
equal_scene mis 64 8
equal_scene caustic 64 12
equal_scene stained-mask 64 8
with=bsdf
equal_scene mis 256 8 --set smallest=0.3
equal_scene caustic 256 12 --set lamp=2.5
equal_scene stained-mask 64 8 --set sun=20
finish
