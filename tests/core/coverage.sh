# SPDX-License-Identifier: Apache-2.0
# A sampler that cannot see all of the light is announced, in the text and in JSON; one that can is not.
. "$srcdir/tests/tap.sh"

run() # SAMPLER ARGUMENT...
{
    local sampler=$1
    shift
    "$MCRENDER" "$srcdir/scenes/cornell-box.scn" --size 8x8 --spp 2 --sampler "$sampler" -o "$TMPDIR/out.pfm" --report "$TMPDIR/out.json" "$@" 2>"$TMPDIR/text"
}
json() # KEY: its value in "coverage"
{
    sed -n '/^  "coverage": {/,/^  }/s/^    "'"$1"'": \(.*[^,]\),\{0,1\}$/\1/p' "$TMPDIR/out.json"
}
says() { [ "$(json "$1")" = "$2" ]; }

for sampler in light 'light(by=area)' 'stratified(light)'; do
    run "$sampler"
    check "$sampler: INCOMPLETE in the text" grep -q '^coverage  INCOMPLETE: .*misses reflected light' "$TMPDIR/text"
    check "$sampler: not complete in JSON" says complete false
    check "$sampler: JSON says what is missing" grep -q reflected <(json missing)
    run "$sampler" --quiet
    check "$sampler: a warning where the report is not printed" grep -q 'warning: .*misses reflected light' "$TMPDIR/text"
done
for sampler in cosine uniform bsdf nee 'mixture(cosine 1, light 1)' 'stratified(mixture(light 3, uniform 1))'; do
    run "$sampler"
    check "$sampler: complete in the text" grep -q '^coverage  complete$' "$TMPDIR/text"
    check "$sampler: complete in JSON" says complete true
    check "$sampler: nothing is missing in JSON" says missing '""'
    run "$sampler" --quiet
    empty "$sampler: no warning" "$(cat "$TMPDIR/text")"
done

# Where nothing scatters there is nothing to miss.
cat >"$TMPDIR/lamp.scn" <<'TEXT'
mcrender 1
camera perspective { from (0, 0, 3)   to (0, 0, 0)   fov 40 }
film { size (8, 8) }
render { sampler light }
material lamp emitter { radiance 1 }
sphere { center (0, 0, 0)   radius 1   material lamp }
TEXT
"$MCRENDER" "$TMPDIR/lamp.scn" -o "$TMPDIR/out.pfm" 2>"$TMPDIR/text"
check 'light is complete where no surface scatters' grep -q '^coverage  complete$' "$TMPDIR/text"
finish
