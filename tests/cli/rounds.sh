# SPDX-License-Identifier: Apache-2.0
# time, target_error, adaptive and sample maps on the command line and in scenes: what limits what, what is told, what is refused.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/cli/run.sh"
box=$srcdir/scenes/cornell-box.scn

# scene SETTINGS: box.scn, the box with other render settings
scene() { { sed '/^render {/,/^}/d' "$box"; echo "render { sampler mixture(cosine 1, light 1)   depth 3   $1 }"; } >box.scn; }
scene 'spp 32'
check "the scene of these tests" grep -q 'depth 3   spp 32' box.scn

# tells WHAT KEY VALUE ARGUMENT...: of box.scn's report
tells()
{
    local what=$1 key=$2 wanted=$3
    shift 3
    rm -f out.json
    run box.scn --size 12x10 --quiet -o out.pfm --report out.json "$@"
    equal "$what: $* gives $key $wanted" "$status $(value "$key" out.json)" "0 $wanted"
}
tells "no rules" stopped_by ''
tells "--adaptive distributes spp" stopped_by spp --adaptive
tells "its limit" spp_limit 32 --adaptive
tells "--adaptive=off" stopped_by '' --adaptive=off
tells "the floor" samples_min 32 --spp 256 '--adaptive=on(floor=20)'
tells "a rule of the command line is not held up by the scene's spp" stopped_by target_error --target-error 0.3
tells "but by that of the command line" samples_max 32 --target-error 1e-9 --spp 32
check "which is a warning" grep -q 'warning: the target error 1e-09 is not reached: stopped by spp' "$TMPDIR/stderr"
tells "time that is too short: one round" samples_max 16 --time 1e-9
tells "and it is the time" stopped_by time --time 1e-9
tells "a smaller round" samples_max 3 --time 1e-9 --round 3
tells "whichever comes first" stopped_by spp --time 1000 --spp 64
scene 'time 1000 target_error 0.3 adaptive on(floor=32) round 8 spp 100000'
tells "all in the scene" stopped_by target_error
tells "all in the scene" round 8
tells "over the scene" stopped_by time --time 1e-9
scene 'target_error 1e-9 spp 32'
tells "spp beside the rules of a scene limits them" stopped_by spp
scene 'adaptive off time 1e-9'
tells "without any other word a round is not above spp" samples_max 4 --spp 4
tells "adaptive off" adaptive false
scene 'spp 16'
tells "nothing to distribute" samples_max 16 --adaptive
check "which is a warning" grep -q 'warning: adaptive had nothing to distribute' "$TMPDIR/stderr"
run box.scn --size 12x10 --adaptive --spp 64 -o out.pfm
ends "the report as text" 0 "sampling  adaptive: 16 to " "more as scouts" "stopped   by spp; spp 64"
run check box.scn --adaptive --target-error 0.1 --round 32
ends "check knows them" 0

# ---- maps -----------------------------------------------------------------------------------------------------------------------------
run box.scn --size 12x10 --adaptive --spp 128 --sample-map map.pfm -o a.pfm --quiet
equal "a map of one channel" "$status $(head -c 8 map.pfm | tr '\n' ' ')" "0 Pf 12 10"
run box.scn --size 12x10 --use-map map.pfm -o b.pfm --report out.json
ends "the map again" 0 "stopped   by map"
check "the same bits" cmp a.pfm b.pfm
run box.scn --size 12x10 --use-map map.pfm --seed 1 -o b.pfm --quiet
equal "with another seed" "$status" 0
refute "it is another picture" cmp -s a.pfm b.pfm
rm -f ./*.pfm.* a.pfm b.pfm out.pfm out.json

# map NAME BYTES: 2 x 1 floats, little-endian, as octal escapes
map() { { printf 'Pf\n2 1\n-1.0\n'; printf "$2"; } >"$1.pfm"; }
sixteen='\0\0\200A'
map good "$sixteen$sixteen"
map zero "$sixteen\0\0\0\0"
map nan "$sixteen\0\0\300\177"
map infinite "$sixteen\0\0\200\177"
map negative "$sixteen\0\0\200\301"
map fraction "$sixteen\0\0\204A"
map part "$sixteen\0\0\210A"
map huge "$sixteen\0\0\200\173"
map short "$sixteen"
printf 'PF\n2 1\n-1.0\n%024d' 0 >colour.pfm
printf 'no image' >text.pfm
# no_map STATUS TEXT ARGUMENT...: refused, and nothing is made
no_map()
{
    local wanted=$1 text=$2 before
    shift 2
    before=$(listing)
    run box.scn --size 2x1 -o out.pfm --report out.json "$@"
    ends "refused: $*" "$wanted" "error: " "$text"
    equal "refused: $*: no file is made" "$(listing)" "$before"
}
run box.scn --size 2x1 --use-map good.pfm -o out.pfm --quiet
equal "a map by hand" "$status" 0
rm -f out.pfm
for bad in zero nan infinite negative fraction huge; do no_map 1 "pixel 1,0: " --use-map $bad.pfm; done
no_map 1 "17 samples are not whole rounds of 16 (--round)" --use-map part.pfm
no_map 1 "cannot read 'short.pfm'" --use-map short.pfm
no_map 1 "cannot read 'text.pfm'" --use-map text.pfm
no_map 1 "cannot read 'absent.pfm'" --use-map absent.pfm
no_map 1 "2x1 pixels of 3 channels, expected 2x1 of one" --use-map colour.pfm
no_map 1 "expected 3x1 of one" --use-map good.pfm --size 3x1
for other in '--spp 4' '--time 1' '--target-error 1' --adaptive; do no_map 2 "${other% *} does not go with it" --use-map good.pfm $other; done
no_map 2 "every pixel has spp samples" --sample-map map2.pfm
for name in map2.ppm map2.png map2; do no_map 2 "--sample-map: " --adaptive --sample-map $name; done
no_map 1 "" --adaptive --sample-map absent/map2.pfm
no_map 2 "are the same file" --adaptive --sample-map out.pfm

# ---- values ---------------------------------------------------------------------------------------------------------------------------
for bad in 0 -1 x nan inf 1e10 1s; do no_map 2 "--time expects" --time "$bad"; done
for bad in 0 -1 x nan inf 1%; do no_map 2 "--target-error expects" --target-error "$bad"; done
for bad in yes 'on(' 'on(floor=' 'on(floor=)' 'on(floor=0)' 'on(floor=x)' 'on(5)' 'off(floor=2)' 'on(floor=99999999999)'; do
    no_map 2 "--adaptive" "--adaptive=$bad"
done
for bad in 0 -1 x 65537; do no_map 2 "--round expects a whole number from 1 to 65536" --round "$bad"; done
no_map 3 "a round of 24 samples cannot be cut" --adaptive --round 24
no_map 3 "spp 4 is less than one round of 16 samples" --adaptive --spp 4 --round 16
no_map 3 "8 replicates are rounds of 16 samples and need at least 128 samples per pixel, spp is 64" --adaptive --spp 64 --replicates 8
for bad in 'time 0' 'time "x"' 'target_error -1' 'adaptive yes' 'adaptive on(floor=-1)' 'adaptive on(flor=3)' 'round 0' 'round 20 time 1'; do
    scene "$bad"
    no_map 3 "box.scn:"
done

# ---- interrupted ----------------------------------------------------------------------------------------------------------------------
scene 'time 100000'
set -m
"$MCRENDER" box.scn --threads 2 --size 16x16 -o int.pfm --sample-map int-map.pfm --report int.json >"$TMPDIR/stdout" 2>"$TMPDIR/stderr" &
pid=$!
for i in $(seq 600); do
    [ "$(sed -n 's/^Threads:[^0-9]*//p' /proc/$pid/status 2>/dev/null)" != 2 ] || break
    sleep 0.05
done
kill -s INT $pid
wait $pid
status=$?
ends "SIGINT: what there is is written" 130 "interrupted after" "stopped   by interruption"
run box.scn --size 16x16 --use-map int-map.pfm -o again.pfm --quiet
check "and its map gives the same bits" cmp int.pfm again.pfm
finish
