#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Convergence as `mcrender study` measures it: error falls with slope -1 for independent numbers, within 0.02; stratified pixels gain on an edge, where
# the variance of jittered samples falls as N^-3/2 in two dimensions (Mitchell, "Consequences of stratified sampling in graphics", SIGGRAPH 1996).
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/study/help.sh"

slopes() { awk '/"slope": \{/ { for (i = 0; i < 3; i++) { getline; gsub(/[^-0-9.e+]/, "", $2); printf "%s ", $2 } print "" }' "$1/study.json"; } # value low high, a line a series
within() { awk -v x="$1" -v lo="$2" -v hi="$3" 'BEGIN { exit !(x >= lo && x <= hi) }'; }

tiny 'samplers (cosine, mixture(cosine 1, light 1))   spp (1, 4, 16, 64, 256)   seeds 40   runs 1   metrics mse   size (24, 24)
      reference { sampler mixture(cosine 1, light 1)   spp 65536 }'
study tiny.scn -o room
ends "a room with indirect light" 0
while read -r value low high; do
    check "independent numbers: slope $value in -1.00 +- 0.02" within "$value" -1.02 -0.98
    check "its interval [$low, $high] is narrower than 0.08 and reaches -1" awk -v lo="$low" -v hi="$high" 'BEGIN { exit !(hi - lo < 0.08 && lo < -0.97 && hi > -1.03) }'
done < <(slopes room)
check "two series" test "$(slopes room | wc -l)" = 2

cat >edge.scn <<'TEXT'
mcrender 1
camera orthographic { from (0, 0, 5)   to (0, 0, 0)   height 2 }
film { size (16, 16) }
render { depth 0   threads 1 }
material lamp emitter { radiance 1 }
quad { corner (-4, -4, 0)   u (4.03, 0.7, 0)   v (-0.9, 8, 0)   material lamp }
study { samplers (cosine, stratified(cosine))   spp (4, 16, 64, 256)   seeds 40   runs 1   metrics mse   reference { sampler cosine   spp 4000000 } }
TEXT
study edge.scn -o edge
ends "an edge" 0
{ read -r plain _ _; read -r strata low high; } < <(slopes edge)
check "independent numbers on an edge: slope $plain in -1.00 +- 0.05" within "$plain" -1.05 -0.95
check "stratified pixels: slope $strata is -3/2 within 0.1" within "$strata" -1.6 -1.4
check "and steeper than -1 beyond doubt: [$low, $high]" within "$high" -2 -1.2
finish
