#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Every option of the command line: what it changes, what it refuses, how it may be spelt.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/cli/run.sh"

# ---- what an option changes: the report tells ---------------------------------------------------------------------------------------
# sets WHAT KEY VALUE ARGUMENT...
sets()
{
    local what=$1 key=$2 wanted=$3
    shift 3
    rm -f out.json
    run glow.scn --quiet -o out.ppm --report out.json "$@"
    equal "$what: $* gives $key $wanted" "$status $(value "$key" out.json)" "0 $wanted"
}
sets "the scene's" spp 4
sets "the scene's" depth 2
sets "the scene's" seed 11
sets "the scene's" threads 1
sets "the scene's" sampler cosine
sets "the scene's" width 8
sets "the scene's" height 8
sets "the scene's" accelerator bvh
sets "the scene's" batch 24
sets replaced spp 7 --spp 7
sets replaced depth 0 --depth 0
sets replaced seed 9007199254740992 --seed 9007199254740992
sets replaced threads 2 --threads 2 --spp 128
sets replaced threads 1 --threads 999
sets replaced sampler 'mixture(uniform 2, cosine 1)' --sampler 'mixture(uniform 2, cosine 1)'
sets replaced width 20 --size 20x10
sets replaced height 10 --size 20x10
sets replaced width 5 --crop 1,2,6,8
sets replaced height 6 --crop 1,2,6,8
sets replaced precision double --precision double
sets replaced accelerator list --accel list
sets replaced accelerator list --accel auto
sets replaced instruction_set baseline --isa baseline
best=$("$MCRENDER" explain glow.scn --report - 2>/dev/null | sed -n 's/.*"instruction_set": "\(.*\)".*/\1/p')
sets replaced instruction_set "$best" --isa baseline --isa "$best"
sets replaced batch 64 --batch 64
sets replaced replicates 3 --replicates 3
sets "the scene's" roulette false
sets replaced roulette true --roulette on
sets replaced roulette true --roulette 'on(from=0)'
sets replaced roulette false --roulette on --roulette off
sets "the scene's" compat none
sets "the scene's" biased false
sets replaced compat clamp --compat clamp
sets replaced compat 'clamp, background-at-limit' --compat background-at-limit,clamp
sets replaced biased true --compat clamp
sets replaced compat none --compat clamp --compat none
sets replaced luminance 0.25
sets replaced luminance 0.5 --set glow=0.5
sets replaced luminance 0.75 --set 'glow=0.5 + 0.25'
sets "the scene's" tone linear
sets "the scene's" exposure 0
sets replaced tone 'reinhard(white=4)' --tone reinhard
sets replaced tone 'hable(white=2.5)' --tone 'hable(white=5 / 2)'
sets replaced tone aces --tone hable --tone aces
sets replaced exposure -1.5 --exposure -1.5
sets 'the last one counts' spp 9 --spp 3 --spp 9
sets '--name=value' spp 7 --spp=7
sets '--name=value' luminance 0.5 --set=glow=0.5
sets abbreviated spp 7 --sp 7
sets '--name=value' sampler uniform --sampler=uniform
sets abbreviated precision double --pre double
run glow.scn --quiet --threads 0 -o out.ppm --report out.json
check "--threads 0: all processors" test "$(value threads out.json)" -ge 1

run glow.scn --quiet -oattached.ppm
equal "-oFILE" "$status $(head -c 2 attached.ppm)" "0 P6"
run glow.scn --quiet --bits 16 -o out.ppm
equal "--bits 16" "$status $(head -n 3 out.ppm | tail -n 1 | tr -d '\0' | head -c 5)" "0 65535"
run glow.scn --quiet --exposure 1.5 --set glow=0.5 -o bright.ppm
equal "--exposure with a fraction" "$status" 0
run glow.scn --quiet --exposure 1 -o bright.ppm
run glow.scn --quiet --set glow=0.5 -o set.ppm
check "--exposure 1 doubles" cmp bright.ppm set.ppm
run glow.scn --quiet --exposure -1 --set glow=0.5 -o dark.ppm
run glow.scn --quiet -o set.ppm
check "--exposure -1 halves" cmp dark.ppm set.ppm
# 0.25 2^2 = 1 is the white of reinhard(white=1), whose curve goes through (1, 1); 0.25 becomes 0.25 (1 + 0.25) / 1.25 = 0.25
run glow.scn --quiet --exposure 2 --tone 'reinhard(white=1)' -o toned.ppm
run glow.scn --quiet --set glow=1 -o set.ppm
check "--tone: white becomes 1" cmp toned.ppm set.ppm
run glow.scn --quiet --tone 'reinhard(white=0.5)' -o toned.ppm
run glow.scn --quiet --set glow=0.4 -o set.ppm
check "--tone reinhard(white=0.5): 0.25 becomes 0.4" cmp toned.ppm set.ppm
run glow.scn --quiet --tone aces --exposure 3 -o toned.pfm
run glow.scn --quiet -o set.pfm
check "--tone and --exposure change no PFM" cmp toned.pfm set.pfm
sed 's/^film { /film { exposure 1 tone reinhard(white=1)   /' glow.scn >shown.scn
run shown.scn --quiet -o toned.ppm
run glow.scn --quiet --exposure 1 --tone 'reinhard(white=1)' -o set.ppm
check "the same in the film block" cmp toned.ppm set.ppm
run shown.scn -o toned.ppm
ends "the report tells" 0 "display   tone reinhard(white=1), exposure 1 stops"
run glow.scn --tone sepia -o bad.ppm
ends "--tone of an unknown curve" 3 "--tone:1:1: error: unknown tone 'sepia' of 'film', expected linear, reinhard, hable or aces"
run glow.scn --tone 'reinhard(white=0)' -o bad.ppm
ends "--tone with a white of 0" 3 "--tone:1:16: error: 'white' of 'reinhard' is 0"
run glow.scn --tone 'aces(white=2)' -o bad.ppm
ends "--tone with an argument that there is not" 3 "--tone:1:6: error: 'aces' takes no arguments"
run glow.scn --tone 3 -o bad.ppm
ends "--tone with a number" 3 "--tone:1:1: error: 'tone' of 'film' is 3, expected linear, reinhard, hable or aces"
refute "no picture of them" test -e bad.ppm
cp glow.scn ./-dash.scn
run --quiet -o dash.ppm -- -dash.scn
ends "-- ends the options" 0
{ cat glow.scn; echo 'material unused lambert { }'; } >unused.scn
run unused.scn --quiet -o out.ppm
ends "an unused name is a warning" 0 "warning: "
run unused.scn --quiet --werror -o out.ppm
ends "--werror makes it an error" 3 "error: "
run check --werror unused.scn
ends "check --werror" 3 "error: "

# ---- what an option refuses ---------------------------------------------------------------------------------------------------------
# refused TEXT ARGUMENT...: status 2, that text, and no file is made
refused()
{
    local text=$1 before
    shift
    before=$(listing)
    run glow.scn "$@"
    ends "refused: $*" 2 "mcrender: error: " "$text"
    [ "$(listing)" = "$before" ] || point 1 "refused: $*: no file is made" "$(listing)"
}
for bad in 0 -1 1.5 '' x 4x 0x4 ' 4' +4 2147483648 99999999999999999999999; do refused "--spp expects" --spp "$bad"; done
for bad in -1 1e3 2147483647; do refused "--depth expects a whole number from 0" --depth "$bad"; done
for bad in -1 x 9007199254740993; do refused "--seed expects a whole number from 0" --seed "$bad"; done
for bad in -1 x 1025; do refused "--threads expects a whole number from 0" --threads "$bad"; done
for bad in -1 x 65537; do refused "--batch expects a whole number from 0" --batch "$bad"; done
for bad in 0 -1 x 4097; do refused "--replicates expects a whole number from 1 to 4096" --replicates "$bad"; done
for bad in yes On 'on(' 'on(from=)' 'on(from=2' 'on(from=-1)' 'on(from=2147483647)' 'on(from=99999999999999999)' 'on(5)' 'off(from=2)'; do
    refused "--roulette " --roulette "$bad"
done
for bad in clam clamp,clamp clamp, none,clamp 'clamp disk-polar'; do refused "--compat " --compat "$bad"; done
refused "did you mean 'disk-polar'?" --compat disc-polar
refused "--layers names 'depth' twice" --layers depth,id,depth
for bad in depth, ,depth 'depth id' depth,,id; do refused "--layers does not know" --layers "$bad"; done
refused "--layers does not know 'varience', did you mean 'variance'?" --layers varience
for bad in 8 8x 0x8 8x0 8x8x8 8,8 -8x8 8x65537 8X8 '8 x8'; do refused "--size expects WIDTHxHEIGHT" --size "$bad"; done
for bad in 1,2,3 1,2,3,4,5 a,b,c,d 1,2,3,-4 1x2x3x4; do refused "--crop expects X0,Y0,X1,Y1" --crop "$bad"; done
for bad in 4,0,4,8 0,4,8,4 5,0,4,8; do refused "--crop $bad is empty" --crop "$bad"; done
for bad in 12 0 x; do refused "--bits expects 8 or 16" --bits "$bad"; done
for bad in x nan inf 65 -65 1e9 1s; do refused "--exposure expects a number of stops" --exposure "$bad"; done
for bad in glow =1 glow= ''; do refused "--set expects NAME=VALUE" --set "$bad"; done
refused "--set glow is given twice" --set glow=1 --set glow=2
refused "--isa expects baseline, avx2 or avx512" --isa sse
refused "did you mean 'list'?" --accel lsit
refused "did you mean 'double'?" --precision doubel
refused "--precision single is not available in this build" --precision single
refused "--accel embree is not available in this build" --accel embree
refused "--sampler expects EXPR" --sampler ''
refused "--report expects FILE" --report=
for option in -o --spp --depth --seed --threads --sampler --size --crop --precision --accel --isa --batch --replicates --roulette --compat --time --target-error --round --sample-map --use-map --set --plugin \
    --layers --report --bits --exposure --tone; do
    refused "$option expects" "$option"
done
for option in --quiet --werror --profile --help --version; do refused "$option takes no value" "$option=yes"; done
refused "unknown option '--spq', did you mean '--spp'?" --spq 4
refused "unknown option '--sampelr', did you mean '--sampler'?" --sampelr=uniform
refused "unknown option '--frobnicate' (see mcrender --help)" --frobnicate
refused "unknown option '-q'" -q
refused "'--sam' may be '--sampler' or '--sample-map'" --sam=uniform
refused "'--se' may be '--seed' or '--set'" --se 4
refused "one operand expected: 'other.scn' follows 'glow.scn'" other.scn
many=()
for i in $(seq 17); do many+=(-o "$i.ppm"); done
refused "-o may be given 16 times at most" "${many[@]}"
for name in scene.gltf scene.glb SCENE.GLB; do
    run "$name"
    ends "$name" 2 "$name: glTF is not available in this build"
    run check "$name"
    ends "check $name" 2 "$name: glTF is not available in this build"
done
run
ends "no scene" 2 "a scene file is expected"
run check
ends "check without a scene" 2 "a scene file is expected"
run check glow.scn -o out.ppm
ends "check writes nothing" 2 "-o does not go with 'mcrender check'"
run plugins --spp 4
ends "plugins renders nothing" 2 "--spp does not go with 'mcrender plugins'"

# ---- scene errors: status 3, located -------------------------------------------------------------------------------------------------
run glow.scn --set other=1
ends "--set of an unknown name" 3 "no 'let other' in the scene"
run glow.scn --set 'glow=1 +'
ends "--set with half an expression" 3 "--set:1:9: error: "
run glow.scn --sampler 'mixture(cosine 1'
ends "--sampler unclosed" 3 "--sampler:1:"
run glow.scn --sampler cosien
ends "--sampler misspelt" 3 "--sampler:1:1: error: unknown sampler 'cosien'" "did you mean 'cosine'"
run glow.scn --crop 0,0,9,9
ends "--crop beyond the picture" 3 "--crop"
run glow.scn --size 65536x65536
ends "--size beyond the memory allowed" 3 "65536 x 65536"
run glow.scn --plugin ./absent.so
ends "--plugin absent" 3 "no plugin file './absent.so'"
run absent.scn
ends "no such scene" 3 "absent.scn"
run .
ends "a folder as a scene" 3 "cannot read '.'"
printf 'mcrender 1\nsphere { raduis 3 }\n' >bad.scn
run bad.scn
ends "a scene with mistakes" 3 "bad.scn:2:10: error: unknown setting 'raduis'"
run check bad.scn
ends "check of a scene with mistakes" 3 "bad.scn:2:10: error: unknown setting 'raduis'"

# ---- help and version ----------------------------------------------------------------------------------------------------------------
for how in "--help" "-h" "check --help" "plugins --help" "--hel"; do
    run $how
    ends "$how" 0
    check "$how: 32 lines of 80 columns" awk 'length > 80 { bad = 1 } END { exit bad || NR > 32 || NR < 10 }' "$TMPDIR/stdout"
    check "$how: nothing on stderr" test ! -s "$TMPDIR/stderr"
done
for option in -o --spp --depth --seed --threads --sampler --size --crop --precision --accel --isa --batch --replicates --roulette --compat --time --target-error --round --sample-map --use-map --set \
    --plugin --layers --report --profile --adaptive --bits --exposure --tone --quiet --werror --help --version; do
    check "--help tells $option" grep -q -- "^\(.* \)\?$option " "$TMPDIR/stdout"
done
run --version
equal "--version" "$status $(sed 's/[0-9.]*$/N/' "$TMPDIR/stdout")" "0 mcrender N"

# ---- check and plugins ---------------------------------------------------------------------------------------------------------------
run check glow.scn
equal "check: status and stderr" "$status $(cat "$TMPDIR/stderr")" "0 "
check "check: says good" grep -q 'glow.scn: good' "$TMPDIR/stdout"
run check --quiet glow.scn
equal "check --quiet prints nothing" "$status $(cat "$TMPDIR/stdout" "$TMPDIR/stderr")" "0 "
run check --spp 3 --sampler uniform --set glow=2 --size 4x4 glow.scn
ends "check with replaced settings" 0
run plugins
ends "plugins" 0
for word in uniform cosine light mixture bsdf nee stratified sobol halton bluenoise antithetic independent lambert oren-nayar mirror dielectric glossy principled conductor emitter mix mask control; do
    check "plugins lists $word" grep -qw "$word" "$TMPDIR/stdout"
done
run plugins light
ends "plugins light" 0
check "plugins light tells its parameter" grep -qw by "$TMPDIR/stdout"
run plugins lihgt
check "plugins of an unknown word" test "$status" = 1 -a ! -s "$TMPDIR/stdout"
ends "plugins suggests" 1 "light"

# ---- surroundings --------------------------------------------------------------------------------------------------------------------
surroundings()
{
    local what=$1
    shift
    check "$what: a render" env "$@" "$MCRENDER" glow.scn --quiet -o home.ppm
    check "$what: plugins" env "$@" "$MCRENDER" plugins
}
surroundings "no HOME" -u HOME
surroundings "HOME is empty" HOME=
surroundings "HOME does not exist" HOME=/nonexistent
surroundings "an empty environment" -i MCRENDER_PLUGIN_PATH="$MCRENDER_PLUGIN_PATH" MCRENDER_MODULE_PATH="$MCRENDER_MODULE_PATH"
finish
