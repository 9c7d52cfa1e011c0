# SPDX-License-Identifier: Apache-2.0
# Renders and their figures for the proofs of src/core; sourced, after tests/tap.sh.
#
# The program's own report is the measuring device: the mean over all pixels, its standard error, the variance of one sample. (That these
# figures are true is tested in tests/film/.) Where radiance is grey, luminance is radiance.

# figures REPORT: "mean error variance" of the luminance; error and variance are -1 where they are not known
figures()
{
    awk '
        function number() { sub(/.*: /, ""); sub(/,$/, ""); return $0 + 0 }
        BEGIN { error = variance = -1 }
        /^    "luminance":/ { mean = number() }
        /^    "standard_error":/ { error = number() }
        /^    "sample_variance":/ { variance = number() }
        END { printf "%.17g %.17g %.17g\n", mean, error, variance }' "$1"
}

# render SCENE ARGUMENT...: sets mean, error, variance; the picture is $TMPDIR/out.pfm. A failure fails a point.
render()
{
    local scene=$1 told
    shift
    mean=0 error=-1 variance=-1
    if ! told=$("$MCRENDER" "$scene" -o "$TMPDIR/out.pfm" --quiet --report "$TMPDIR/out.json" "$@" 2>&1); then
        point 1 "render $scene $*" "$told"
        return 1
    fi
    read -r mean error variance <<<"$(figures "$TMPDIR/out.json")"
}

# holds CONDITION NAME=VALUE...: an awk condition over numbers
holds()
{
    local condition=$1 values=()
    shift
    for value; do values+=(-v "$value"); done
    awk "${values[@]}" 'function abs(x) { return x < 0 ? -x : x } BEGIN { exit !('"$condition"') }'
}

# calculate EXPRESSION NAME=VALUE...: its value
calculate()
{
    local expression=$1 values=()
    shift
    for value; do values+=(-v "$value"); done
    awk "${values[@]}" 'BEGIN { printf "%.17g\n", ('"$expression"') }'
}

# Rounding alone: a path of a few hundred events multiplies and adds a few thousand numbers, each to 2^-53, and the known values have 13 digits.
ROUNDING=1e-12

# agrees WHAT ANSWER: a point: the last render's mean within 4 standard errors of the answer (and rounding), and the error below 0.2 % of it.
agrees()
{
    local z
    z=$(calculate 'error > 0 ? (mean - answer) / error : 0' mean="$mean" error="$error" answer="$2")
    holds 'error >= 0 && error < 0.002 * answer && abs(mean - answer) <= 4 * error + rounding * answer' \
        mean="$mean" error="$error" answer="$2" rounding=$ROUNDING
    point $? "$1: $mean +- $error, z = ${z:0:6}" "expected $2"
}

# known WHAT SCENE ANSWER SAMPLERS ARGUMENT...: `agrees` for each of the samplers (separated by ;). A pilot with another seed tells how
# many samples the 0.2 % take (0.18, as the pilot errs itself); at least 32768 are drawn, over 16 x 16 pixels. $part says which renders are
# made: `quick` those of up to 3 million samples (a quarter of a million with sanitizers), `long` the others.
known()
{
    local what=$1 scene=$2 answer=$3 samplers sampler spp most=12000
    [ "$MCR_SANITIZED" != 1 ] || most=1000
    IFS=';' read -ra samplers <<<"$4"
    shift 4
    for sampler in "${samplers[@]}"; do
        render "$scene" --sampler "$sampler" --size 64x64 --spp 16 --seed 1001 "$@" || continue
        spp=$(calculate 'int((n = variance / (0.0018 * answer) ^ 2 / 256 + 1) < 128 ? 128 : n)' variance="$variance" answer="$answer")
        [ "$spp" -gt $most ] && [ "$part" = quick ] && continue
        [ "$spp" -le $most ] && [ "$part" = long ] && continue
        render "$scene" --sampler "$sampler" --size 16x16 --spp "$spp" --seed 1 "$@" || continue
        agrees "$what, $sampler" "$answer"
    done
}

# rate WHAT SCENE SAMPLER LIMIT ARGUMENT...: the slope of log variance over log N, N = 4 ... 256 samples a replicate, is below LIMIT by 4 standard errors.
# Variances of the mean over the picture; with 64 replicates each log2 errs by sqrt(2/63) / ln 2 = .257, the slope by .257 / sqrt(28) = .049.
rate()
{
    local what=$1 scene=$2 sampler=$3 limit=$4 m points=
    shift 4
    for m in 2 3 4 5 6 7 8; do
        render "$scene" --sampler "$sampler" --size 4x4 --spp $((64 << m)) --replicates 64 --seed 8 "$@"
        points="$points$m $error
"
    done
    slope=$(awk 'NF { s += ($1 - 5) / 28 * 2 * log($2) / log(2); n++ } END { printf "%.3f", n == 7 ? s : 0 }' <<<"$points")
    holds 'slope + 4 * 0.049 < limit' slope="$slope" limit="$limit"
    point $? "$what, $sampler: the variance falls as N^$slope, expected below N^$limit"
}
