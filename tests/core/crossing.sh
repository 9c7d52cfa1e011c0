# SPDX-License-Identifier: Apache-2.0
# Mirror-like lobes, light that passes straight on, and interiors, by a material for tests (sheet.c) whose chances have nothing to do with what it carries.
part=quick
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"
for plugin in sheet neelight; do
    ${MCR_CC:-cc} -std=gnu17 -O2 -shared -fPIC -I"$srcdir/src" "$srcdir/tests/core/$plugin.c" -o "$TMPDIR/$plugin.so" -lm ||
        { point 1 "$plugin.c compiles"; finish; }
done
plugins="--plugin $TMPDIR/sheet.so --plugin $TMPDIR/neelight.so"
all='uniform;cosine;bsdf;nee;nee(by=area);mixture(bsdf 1, light 1);neelight'
scene=$TMPDIR/scene.scn

# exact WHAT ANSWER ARGUMENT...: every path sees the same: the mean is the answer to rounding
exact()
{
    local what=$1 answer=$2
    shift 2
    # shellcheck disable=SC2086
    render "$scene" $plugins --size 8x8 --spp 4 "$@" || return
    holds 'abs(mean - answer) <= 1e-12 * answer' mean="$mean" answer="$answer"
    point $? "$what: $mean" "expected $answer"
}

# S WHAT ANSWER SAMPLERS ARGUMENT...
S()
{
    local what=$1 answer=$2 samplers=$3
    shift 3
    # shellcheck disable=SC2086
    known "$what" "$scene" "$answer" "$samplers" $plugins "$@"
}

# ---- lobes ----
# S1 with a wall that mirrors .3 and spreads .5 of the light, and a lobe of mirrors chosen with .2: every bounce keeps .8.
closed scene 'material glossy sheet { diffuse 0.5   mirror 0.3   mirror_chance 0.2   radiance 1 }
box { min (-2, -1, -1.5)   max (1.5, 2, 3)   transform { rotate (1, 2, 3, 40) }   material glossy }'
sed -i '/^material wall/d' "$scene"
S 'furnace of mirrors and lambert, D = 8' 4.32891136 "$all" --depth 8
sed -i 's/roulette off/roulette on(from=2)/' "$scene"
S 'the same to the end, with roulette' 5 "$all" --depth 1000
# The chance of a lobe does not change the picture, only its noise.
closed scene 'material wall sheet { mirror 0.8   mirror_chance 1   radiance 1 }
sphere { center (0, 0, 0)   radius 2   material wall }'
sed -i '/^material wall emitter/d' "$scene"
exact 'a ball of mirrors: nothing but lobes, D = 8' 4.32891136 --depth 8 --sampler nee
exact 'and with uniform' 4.32891136 --depth 8 --sampler uniform

# A lamp of radiance 1 beside a mirror: the receiver sees it twice (S2's second case, once at (1.5, .5), once at the other side of the mirror).
receiver scene '(-0.3, 0.2, 0.5)' 'material mirror sheet { mirror 0.6   mirror_chance 0.7 }
quad { corner (-2.5, -1.5, 1)   u (0, 2, 0)   v (2, 0, 0)   material both }
plane { point (1e-9, 0, 0)   normal (-1, 0, 0)   material mirror }'
S 'a lamp and its image' "$(calculate 'f + .6 * f' f=.14748482740113)" "$all" --depth 2

# ---- what passes ----
receiver scene '(0.3, 0.2, 0.5)' 'material glass sheet { pass (0.2, 0.5, 0.8) }
quad { corner (-2.5, -1.5, 1)   u (0, 2, 0)   v (2, 0, 0)   material both }
plane { point (0, 0, 0.9)   normal (0, 0.02, 1)   material glass }'
S 'a lamp behind stained glass: no scattering event' "$(calculate 'f * (.2126 * .2 + .7152 * .5 + .0722 * .8)' f=.14748482740113)" "$all"
receiver scene '(0.3, 0.2, 0.5)' 'material glass sheet { pass (0.2, 0.5, 0.8) }
material gauze sheet { pass 0.5 }
quad { corner (-2.5, -1.5, 1)   u (0, 2, 0)   v (2, 0, 0)   material both }
plane { point (0, 0, 0.9)   normal (0, 0.02, 1)   material glass }
sphere { center (0, 0, 0)   radius 0.2   material gauze }
sphere { center (0, 0, 0)   radius 0.1   material gauze }'
S 'and behind two spheres of gauze' "$(calculate 'f * (.2126 * .2 + .7152 * .5 + .0722 * .8) / 4 / 4' f=.14748482740113)" "$all"
# The far wall of a ball, seen through the near one: by solid angle only the near one is drawn.
receiver scene '(0.3, 0.2, 0.5)' 'material veil mask { material both   opacity 0.4 }
sphere { center (0.3, -0.4, 1.2)   radius 0.6   material veil }'
S 'both walls of a veiled lamp' "$(calculate '(.4 + .6 * .4) * .36 / 1.69 * 1.2 / 1.3')" "$all;light;control;sobol(nee)"
receiver scene '(0.3, 0.2, 0.5)' 'material veil mask { material both   opacity 0.4 }
sphere { center (0.3, -0.4, 1.2)   radius 0.6   material veil }
sphere { center (0.6, -0.8, 2.4)   radius 1.2   material veil }'
S 'and of two, of which the farther is twice as large' "$(calculate '(.4 + .6 * .4) * (1 + .36) * .36 / 1.69 * 1.2 / 1.3')" "$all;light;control"
# Large panes of nothing before a tilted lamp: rays that end at it are not moved past it.
for half in 3 30 1e4; do
    mean=
    for pane in '' "let h = $half
material nothing sheet { pass 1 }
quad { corner (-h, -h, 0.4)   u (2 * h, 0, 0)   v (0, 2 * h, 0)   material nothing }
quad { corner (-h, -h, 0.6)   u (2 * h, 0, 0.1 * h)   v (0, 2 * h, 0.3 * h)   material nothing }"; do
        receiver scene '(0.3, 0.2, 0.5)' "disk { center (0, 0, 1)   normal (0.3, 0.1, -1)   radius 0.5   material both }
$pane"
        plain=$mean
        # shellcheck disable=SC2086
        render "$scene" $plugins --size 8x8 --spp 64 --seed 5 --sampler nee
    done
    holds 'plain > .01 && abs(mean - plain) <= 1e-9 * plain' mean="$mean" plain="$plain"
    point $? "two panes of nothing, $half wide, hide nothing: $mean" "expected $plain"
done
# A lamp that is half there: half of its light, and half of the lamp behind it.
receiver scene '(0.3, 0.2, 0.5)' 'material veil sheet { pass 0.5   radiance 3 }
quad { corner (-2.5, -1.5, 1)   u (0, 2, 0)   v (2, 0, 0)   material both }
quad { corner (-2.5, -1.5, 1)   u (0, 2, 0)   v (2, 0, 0)   material veil   transform { translate (0, 0, -1e-9) } }'
S 'a lamp that lets another one through' "$(calculate 'f * (1.5 + .5)' f=.14748482740113)" "$all"
# What does not pass is scattered: a floor of albedo .6 through which .25 passes, above a lamp, inside a furnace that emits 1: .25 + .75 * .6, and D = 1.
closed scene 'material floor sheet { pass 0.25   diffuse 0.6 }
sphere { center (0, 0, 0)   radius 2   material wall }
plane { point (0, 0, -0.5)   normal (0, 0, 1)   material floor }'
sed -i 's/albedo rho/albedo 0/; s/to (1, 0.5, -0.7)   fov 70/to (0.1, 0.5, -2)   fov 5/' "$scene"
# behind the floor, its back scatters the lower half of the furnace likewise
S 'the floor of a furnace' .7 'uniform;cosine;bsdf;nee;mixture(bsdf 1, light 1)'

# ---- interiors ----
# straight CAMERA SHAPES...: a view straight through things at a lamp of radiance 1
straight()
{
    local scale=$1
    shift
    { preamble "let s = $scale
camera orthographic { from (0, 0, 5 * s)   to (0, 0, 0)   up (0, 1, 0)   height 0.2 * s }"
      cat <<TEXT
material lamp emitter { radiance 1   sides two }
quad { corner (-s, -s, -5 * s)   u (2 * s, 0, 0)   v (0, 2 * s, 0)   material lamp }
$*
TEXT
    } | sed '/^let rho/d' >"$scene"
}
luminance='.2126 * exp(-a) + .7152 * exp(-2 * a) + .0722 * exp(-3 * a)'
for scale in 1 1e-6 1e6; do
    straight $scale "material ink sheet { through 1   through_chance 1   interior 1   attenuation (1 / s, 2 / s, 3 / s) }
box { min (-s, -s, 0)   max (s, s, 0.5 * s)   material ink }"
    exact "absorbing box, scale $scale" "$(calculate "$luminance" a=.5)" --depth 4 --sampler nee
done
for lower in 1 0; do
    straight 1 "material a sheet { through 1   through_chance 1   interior 1   attenuation 1   index 1.5   priority $((1 - lower)) }
material b sheet { through 1   through_chance 1   interior 1   attenuation 3   index 1.3   priority $lower }
box { min (-1, -1, 0)   max (1, 1, 1)   material a }
box { min (-1, -1, 0.5)   max (1, 1, 2)   material b }"
    exact "overlapping interiors, $([ $lower = 1 ] && echo the upper counts || echo the lower counts)" \
        "$(calculate "$([ $lower = 1 ] && echo 'exp(-.5 - 3 * 1.5)' || echo 'exp(-1 - 3)')" x=0)" --depth 8 --sampler cosine
done
# nest DEEP: boxes inside of each other, box i from -(1 - .04 i) to 1 - .04 i
nest()
{
    local i
    for ((i = 0; i < $1; i++)); do
        echo "material m$i sheet { through 1   through_chance 1   interior 1   attenuation $(calculate '.1 * (i + 1)' i=$i)   index $(calculate '1 + .1 * (i % 3)' i=$i) }
let h$i = 1 - 0.04 * $i
box { min (-h$i, -h$i, -h$i)   max (h$i, h$i, h$i)   material m$i }"
    done
}
for deep in 9 16; do # box i is .08 thick, the innermost 2 - .08 (deep - 1)
    straight 1 "$(nest $deep)"
    exact "$deep interiors inside of each other" "$(calculate 'exp(-.1 * (.08 * n * (n - 1) / 2 + n * (2 - .08 * (n - 1))))' n=$deep)" --depth 40 --sampler cosine
done
straight 1 "$(nest 17)"
# shellcheck disable=SC2086
"$MCRENDER" "$scene" $plugins --size 4x4 --spp 1 --depth 40 --sampler cosine --quiet -o "$TMPDIR/deep.pfm" 2>"$TMPDIR/text"
check 'seventeen are more than is accounted for, and it is said' grep -q 'warning: [0-9]* rays entered more interiors' "$TMPDIR/text"
# A mask all around, and the camera inside of an interior that fills the furnace: albedo .5 at its centre, seen from .3 away.
closed scene 'material wall sheet { radiance 1   interior 1   attenuation 0.7 }
material dot lambert { albedo 0.5 }
sphere { center (0, 0, 0)   radius 2   material wall }
disk { center (0, 0, 0)   normal (0, 0, 1)   radius 1e-6   material dot }'
sed -i '/^material wall emitter/d; s/from .*/from (0, 0, 0.3)   to (0, 0, 0)   up (0, 1, 0)   fov 1e-5 }/' "$scene"
S 'the camera inside of an interior' "$(calculate '.5 * exp(-.7 * 2.3)' x=0)" "$all" --seed 3

# Same bits for all batches and instruction sets
straight 1 "material pane sheet { pass (0.2, 0.3, 0.1)   diffuse 0.3   mirror 0.2   mirror_chance 0.3   through 0.4   through_chance 0.2   interior 1   index 1.5   attenuation 0.3 }
box { min (-1, -1, 0)   max (1, 1, 1)   material pane   transform { rotate (1, 2, 3, 20) } }
sphere { center (0, 0, 2)   radius 0.08   material pane }"
first=
for how in '--isa baseline --threads 1' '--isa baseline --threads 2 --batch 40' '--isa avx2' '--isa avx512 --batch 1000' '--accel bvh'; do
    # shellcheck disable=SC2086
    "$MCRENDER" "$scene" $plugins $how --sampler nee --size 24x24 --spp 16 --depth 6 --quiet -o "$TMPDIR/bits.pfm" 2>"$TMPDIR/text" || { grep -q 'instruction set' "$TMPDIR/text" && continue; }
    sum=$(cat "$TMPDIR/bits.pfm" "$TMPDIR/text" | cksum)
    first=${first:-$sum}
    [ -s "$TMPDIR/bits.pfm" ] && [ "$sum" = "$first" ]
    point $? "the same bits with $how"
done
finish
