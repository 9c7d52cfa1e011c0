#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# mcrender explain: what is active in scenes that need nothing, and in scenes that need one thing each; bytes that add up; JSON. No time is asserted.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/cli/run.sh"
box=$srcdir/scenes/cornell-box.scn

if ! python3 -c pass 2>/dev/null; then python=; else python=python3; fi

# explain ARGUMENT...: into e.json
explain() { run explain "$@" --report e.json --quiet; }
# active: the names of e.json's active features; and the value of a feature
active() { awk -F'"' '/"name": / { name = $4 } /"active": true/ { print name }' e.json | sort | paste -sd, ; }
of_feature() # name key
{
    awk -v name="$1" -v key="\"$2\":" '$1 == "\"name\":" { line = $0; sub(/^ *"name": "/, "", line); sub(/",?$/, "", line); found = line == name }
        found && $1 == key { sub(/,$/, "", $2); print $2; exit }' e.json
}

# ---- the diffuse box ---------------------------------------------------------------------------------------------------------------------
explain "$box" --size 32x32 --spp 16
equal "the diffuse box: status, and nothing is said" "$status $(cat "$TMPDIR/stdout" "$TMPDIR/stderr")" "0 "
equal "the diffuse box: what is active" "$(active)" "emission,emitters,roulette,varying inputs"
for name in lobes interiors 'light passes' textures 'point lights' sky background coordinates tangents 'normal maps' 'smooth normals' look-ups lens 'filter weights' \
    'feature layers' compat 'light tree' 'pixel numbers' sources 'inputs elsewhere' rounds 'variance layer'; do
    equal "the diffuse box: $name" "$(of_feature "$name" active) $(of_feature "$name" batch_bytes) $(of_feature "$name" table_bytes) $(of_feature "$name" ns)" "false 0 0 0"
done
equal "the diffuse box: lights" "$(value emitters e.json) $(value parallelogram e.json) $(value one_sided e.json) $(value two_sided e.json) $(value chosen e.json)" "1 1 1 0 one"
equal "the diffuse box: accelerator" "$(value kind e.json) $(value shapes e.json) $(value triangles e.json) $(value nodes e.json)" "list 8 0 0"
equal "the diffuse box: modules" "$(grep '"modules"' e.json | tr -d ' ')" '"modules":[],'
equal "the diffuse box: plugins" "$(sed -n '/"plugins"/,/"modules"/s/^ *"name": "\(.*\)",/\1/p' e.json | sort | paste -sd' ')" "cosine emitter independent lambert light mixture"
listing >before
run explain "$box" --size 32x32 --spp 16
check "the text" bash -c "cd '$TMPDIR' && for word in scene sampler plugins modules accel lights features not time memory; do grep -q \"^\$word \" stdout || exit 1; done"
check "the text: what is not needed" grep -q '^not needed: .*lobes, .*point lights, .*sky' "$TMPDIR/stdout"
check "no file is written" diff before <(listing)

# ---- one thing each ------------------------------------------------------------------------------------------------------------------------
# A floor under a lamp, both of them seen; nothing but what is added.
head='mcrender 1
camera perspective { from (0, 1, 6)   to (0, 1, 0)   fov 50 }
film { size (16, 16) FILM }
render { sampler cosine   spp 16   depth 6   roulette off RENDER }
material grey lambert { albedo 0.5 }
material lamp emitter { radiance 3 }
plane { point (0, 0, 0)   normal (0, 1, 0)   material grey }
disk { center (0, 4, 0)   normal (0, -1, 0)   radius 1   material lamp }'
# needs WHAT FEATURES TEXT [FILM [RENDER]]: with it exactly these are active, beside what the floor has
needs()
{
    local scene=${head/FILM/$4} wanted
    printf '%s\n%s\n' "${scene/RENDER/$5}" "$3" >one.scn
    explain one.scn
    wanted=$(printf '%s\n' emission emitters | sort)
    [ -z "$2" ] || wanted=$(printf '%s\nemission\nemitters' "${2//,/$'\n'}" | sort)
    equal "$1" "$status $(active)" "0 $(paste -sd, <<<"$wanted")"
    equal "$1: the bytes of a batch add up" "$(sums batch_bytes batch_base)" "$(value batch e.json)"
    equal "$1: the bytes of tables add up" "$(sums table_bytes tables_base)" "$(value tables e.json)"
}
sums() { awk -v key="\"$1\":" -v base="\"$2\":" '$1 == key || $1 == base { sub(/,$/, "", $2); sum += $2 } END { printf "%.0f\n", sum }' e.json; }
# adds FEATURE BYTES: for each path at least so many, what must be kept of it: a direction takes 24, a colour 24, a number 8
adds() { check "$1 adds bytes to a batch" test "$(of_feature "$1" batch_bytes)" -ge $(($2 * $(value batch_paths e.json))); }

needs "nothing" "" ""
base_batch=$(value batch e.json)
equal "nothing: a batch has no more than the least" "$(value batch_base e.json)" "$base_batch"
needs "a mirror" lobes 'material m mirror { }
sphere { center (0, 1, 0)   radius 1   material m }'
adds lobes 72
check "a mirror: why" grep -q '"why": "1 material has mirror-like lobes: m"' e.json
check "a mirror: its stage" test "$(sed -n '/"name": "lobes"/,/"ns"/p' e.json | grep -c '"lobes"')" = 2
needs "glass" interiors,lobes 'material g dielectric { }
sphere { center (0, 1, 0)   radius 1   material g }'
adds interiors 100
check "glass: the table of interiors" test "$(of_feature interiors table_bytes)" -gt 0
needs "glass that nothing is made of" "" 'material g dielectric { }'
equal "glass that nothing is made of costs nothing" "$(value batch e.json)" "$base_batch"
needs "a mask" 'light passes' 'material m mask { material grey   opacity 0.5 }
disk { center (0, 1, 0)   normal (0, 0, 1)   radius 1   material m }'
adds 'light passes' 100
needs "a texture" 'coordinates,textures,varying inputs' 'texture t checker { even 0.2   odd 0.7 }
material c lambert { albedo t }
sphere { center (0, 1, 0)   radius 1   material c }'
adds textures 48
adds coordinates 72
equal "a checker has no pictures" "$(of_feature textures table_bytes)" 0
needs "a point" 'point lights' 'light lonely point { position (0, 3, 3)   intensity 1 }'
adds 'point lights' 100
check "a point: why" grep -q '"why": "1 light without extent: lonely"' e.json
needs "a sky" sky 'light all environment { radiance 1 }'
equal "a sky: chosen with a probability" "$(awk '$1 == "\"sky_share\":" { print ($2 + 0 > 0 && $2 + 0 < 1) }' e.json)" 1
needs "a background" background '' '' 'background 1'
equal "a background takes no bytes" "$(value batch e.json)" "$base_batch"
kept=$head
head=${kept/sampler cosine/sampler nee}; needs "look-ups" look-ups ''
adds look-ups 200
check "look-ups: why" grep -q '"why": "nee has 2 techniques, combined by the balance heuristic"' e.json
head=${kept/sampler cosine/sampler sobol(cosine)}; needs "a source" sources ''
head=${kept/sampler cosine/sampler bluenoise(cosine)}; needs "a source that looks at pixels" 'pixel numbers,sources' ''
adds 'pixel numbers' 16
head=${kept/roulette off/roulette on}; needs "roulette" roulette ''
adds roulette 16
head=${kept/roulette off/compat clamp}; needs "a quirk" compat ''
adds compat 24
head=${kept/camera perspective/camera thinlens}; head=${head/fov 50/fov 50   lens_radius 0.1}; needs "a lens" lens ''
head=$kept
needs "weights of a filter" 'filter weights' '' 'filter mitchell'
adds 'filter weights' 8
needs "two greys" 'varying inputs' 'material other lambert { albedo 0.2 }
sphere { center (0, 1, 0)   radius 1   material other }'
needs "smooth triangles" 'smooth normals' 'mesh { vertices ((0, 1, 0), (1, 1, 0), (0, 2, 0))   normals ((0, 0, 1), (0, 0, 1), (0, 0.1, 1))   faces ((0, 1, 2))   material grey }'
adds 'smooth normals' 24
needs "many lamps" 'light tree' "$(for i in $(seq 20); do echo "disk { center ($i, 4, 0)   normal (0, -1, 0)   radius 0.1   material lamp }"; done)"
check "many lamps: the tree has bytes" test "$(of_feature 'light tree' table_bytes)" -gt 0
equal "many lamps: the sampler does not aim at them" "$(value emitters e.json) $(value disk e.json) $(value chosen e.json)" "21 21 by chance"
explain one.scn --sampler nee
equal "many lamps: chosen by the tree" "$(value chosen e.json)" tree
explain one.scn --sampler nee --layers albedo,variance --threads 3
equal "layers are told" "$(of_feature 'feature layers' active) $(of_feature 'variance layer' active) $(value threads e.json)" "true true 3"
adds 'feature layers' 48
check "the variance layer adds bytes to the film" test "$(of_feature 'variance layer' film_bytes)" -gt 0
explain one.scn --time 100
equal "rounds are told" "$(of_feature rounds active)" true
explain one.scn --accel bvh
equal "the tree of shapes that was asked for" "$(value kind e.json) $(value why e.json)" "bvh as asked for"
check "it has nodes, or wide shapes" test "$(($(value nodes e.json) + $(value wide e.json)))" -gt 0

# A picture: in the bytes of the textures.
{ printf 'P6\n4 4\n255\n'; head -c 48 /dev/zero | tr '\0' 'd'; } >p.ppm
printf '%s\n' "$head" 'texture p image { file "p.ppm" }' 'material c lambert { albedo p }' \
    'sphere { center (0, 1, 0)   radius 1   material c }' | sed 's/FILM//; s/RENDER//' >picture.scn
explain picture.scn
check "a picture has bytes" test "$(of_feature textures table_bytes)" -ge 48
equal "they are those of all textures" "$(of_feature textures table_bytes)" "$(sed -n '/"memory"/,$p' e.json >memory.json; value textures memory.json)"

# ---- JSON, and how it ends -----------------------------------------------------------------------------------------------------------------
run explain picture.scn --report -
equal "--report -: JSON instead of the text" "$status $(head -c 1 "$TMPDIR/stdout")" "0 {"
if [ -n "$python" ]; then
    check "it is JSON, and its numbers agree" "$python" -c '
import json, sys
e = json.load(open(sys.argv[1]))
f = e["features"]
assert sum(x["batch_bytes"] for x in f) + e["memory"]["batch_base"] == e["memory"]["batch"]
assert sum(x["table_bytes"] for x in f) + e["memory"]["tables_base"] == e["memory"]["tables"]
assert all(not x["stages"] and x["ns"] == 0 and x["batch_bytes"] == x["table_bytes"] == 0 for x in f if not x["active"])
stages = [s for x in f for s in x["stages"]]
assert len(stages) == len(set(stages)), "a stage belongs to one feature"
assert all(x["why"] for x in f)
assert sum(e["time"]["stages"].values()) <= e["time"]["ns"] * (1 + 1e-9)
assert e["time"]["rays"] >= 1 and e["time"]["samples"] == 16 * 16 * 16 and e["time"]["pilot_samples"] > 0' "$TMPDIR/stdout"
else
    skip "it is JSON" "no python3"
fi
# Stages and kinds of emitters are keys, too, which the list does not repeat.
told() { { sed -n 's/^ *"\([a-z_]*\)": .*/\1/p' e.json keys.json; printf '%s\n' environment; } | sort -u; }
listed() { sed -n '/explained: begin/,/explained: end/p' "$srcdir/man/mcrender.1" | sed 's/^\.It //; s/^\.//' | grep '^Cm' | tr ' ' '\n' | grep '^[a-z_]*$'; }
cp e.json keys.json
explain one.scn --layers variance
empty "the manual has all keys" "$(told | grep -vxF "$(listed; "$MCRENDER" explain "$box" --size 4x4 --spp 1 --report - | sed -n '/"stages": {/,/}/s/^ *"\([a-z]*\)":.*/\1/p'; printf '%s\n' parallelogram triangle disk sphere ellipsoid)")"
run explain absent.scn
equal "an absent scene" "$status" 3
printf 'mcrender 1\nsphere { raduis 3 }\n' >bad.scn
run explain bad.scn --report bad.json
ends "a scene with mistakes" 3 "bad.scn:2:10: error: unknown setting 'raduis'"
check "a scene with mistakes: nothing is printed or written" test ! -s "$TMPDIR/stdout" -a ! -e bad.json
run explain glow.scn -o a.ppm
ends "explain writes no picture" 2 "-o does not go with 'mcrender explain'"
run explain
ends "explain without a scene" 2 "a scene file is expected"
cp glow.scn same.scn
run explain same.scn --report same.scn
ends "a report over the scene" 2 "'same.scn' is the scene"
check "the scene is as it was" cmp glow.scn same.scn
run explain glow.scn --report absent/e.json
equal "a report that cannot be written" "$status" 1
run explain glow.scn --crop 7,7,8,8 --quiet --size 8000x8000
equal "a crop of one pixel" "$status" 0
run explain glow.scn --size 3x9000 --crop 2,8000,3,9000 --spp 1
equal "a narrow crop" "$status" 0

# ---- memory: the estimate against what a render takes ----------------------------------------------------------------------------------------
if [ "$MCR_SANITIZED" = 1 ]; then
    skip "memory" "sanitizers take their own"
else
    explain "$box" --spp 1 --threads 2
    run "$box" --spp 1 --threads 2 --quiet -o m.ppm --report m.json
    check "the estimate of memory, $(value total e.json), is near $(value peak_memory m.json)" awk -v a="$(value total e.json)" -v b="$(value peak_memory m.json)" \
        'BEGIN { exit !(a > 0.7 * b && a < 1.4 * b) }'
fi
finish
