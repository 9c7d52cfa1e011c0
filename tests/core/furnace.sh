# SPDX-License-Identifier: Apache-2.0
# The white furnace of scenes/furnace.scn is invisible under every sampler: the mean is 1 within 4 standard errors. When the paint
# loses a little, it is not.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
for sampler in bsdf nee 'mixture(bsdf 1, light 1)' 'sobol(nee)' 'stratified(mixture(bsdf 1, light 1))'; do
    render "$srcdir/scenes/furnace.scn" --sampler "$sampler" --size 48x32 --spp 1024 --replicates 16 --seed 5
    z=$(calculate 'error > 0 ? (mean - 1) / error : 0' mean="$mean" error="$error")
    holds 'error >= 0 && error < 5e-4 && abs(mean - 1) <= 4 * error + 1e-12' mean="$mean" error="$error"
    point $? "the furnace, $sampler: $mean +- $error, z = ${z:0:6}"
done
sed 's/albedo 1 /albedo 0.97 /' "$srcdir/scenes/furnace.scn" >"$TMPDIR/lossy.scn"
render "$TMPDIR/lossy.scn" --sampler nee --size 48x32 --spp 1024 --seed 5
holds 'error > 0 && 1 - mean > 6 * error' mean="$mean" error="$error"
point $? "paint that loses 3 % is seen: $mean +- $error"
finish
