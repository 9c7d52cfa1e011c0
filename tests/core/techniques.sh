#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Samplers of several techniques, which the core combines by multiple importance sampling, against samplers of one: the same mean luminance
# within 4 standard errors, where these are so small that 1 % of difference would be 6 of them. Scenes without a known answer: boxes with lights
# of several kinds, with indirect light and shadows.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
${MCR_CC:-cc} -std=gnu17 -O2 -shared -fPIC -I"$srcdir/src" "$srcdir/tests/core/neelight.c" -o "$TMPDIR/neelight.so" -lm ||
    { point 1 "neelight.c compiles"; finish; }

# room NAME TEXT...: a box, open toward the camera, with a block in it and TEXT
room()
{
    local name=$1
    shift
    cat >"$TMPDIR/$name.scn" <<TEXT
mcrender 1
camera perspective { from (0, 1, 3.4)   to (0, 1, 0)   fov 40 }
film { size (16, 16) }
material red lambert { albedo (0.65, 0.05, 0.05) }
material green lambert { albedo (0.12, 0.45, 0.15) }
material white lambert { albedo 0.73 }
quad { corner (-1, 0, -1)   u (0, 2, 0)   v (0, 0, 2)   material red }
quad { corner (1, 0, -1)   u (0, 2, 0)   v (0, 0, 2)   material green }
quad { corner (-1, 0, -1)   u (2, 0, 0)   v (0, 0, 2)   material white }
quad { corner (-1, 2, -1)   u (2, 0, 0)   v (0, 0, 2)   material white }
quad { corner (-1, 0, -1)   u (2, 0, 0)   v (0, 2, 0)   material white }
box { size (0.6, 1.2, 0.6)   transform { rotate (0, 1, 0, 15)   translate (-0.7, 0, -0.7) }   material white }
$*
TEXT
}
ceiling='material lamp emitter { radiance 4 }   quad { corner (-0.5, 1.99, -0.5)   u (1, 0, 0)   v (0, 0, 1)   material lamp }'
room lamp "$ceiling" 'render { roulette off   depth 3 }'
room power "$ceiling" 'render { roulette off   depth 3   mis power }'
room sky "$ceiling" 'render { roulette off   depth 3   background (0.3, 0.5, 0.8) }'
room skypower "$ceiling" 'render { roulette off   depth 3   background (0.3, 0.5, 0.8)   mis power }'
shapes='material glow emitter { radiance 3   albedo 0.4 }   material both emitter { radiance (2, 4, 1)   sides two }
    sphere { center (0.4, 0.4, 0.2)   radius 0.25   material glow }
    triangle { a (-0.9, 1.9, -0.5)   b (0.2, 1.5, -0.8)   c (-0.4, 1.8, 0.6)   material both }'
room shapes "$shapes" 'render { roulette off   depth 3   background 0.1 }'
room shapespower "$shapes" 'render { roulette off   depth 3   background 0.1   mis power }'
room roulette "$shapes" 'render { roulette on(from=1)   depth 50   background 0.1 }'
room plane 'material sun emitter { radiance 0.8 }   plane { point (0, 4, 0)   normal (0, -1, 0)   material sun }' 'render { roulette off   depth 3 }'

# measured SCENE SAMPLER RELATIVE-ERROR ARGUMENT...: as `render`, with as many samples as that takes by a pilot's variance; each with its own seed
seed=0
measured()
{
    local scene=$TMPDIR/$1.scn sampler=$2 wanted=$3
    shift 3
    seed=$((seed + 1))
    render "$scene" --plugin "$TMPDIR/neelight.so" --sampler "$sampler" --spp 64 --seed $((1000 + seed)) "$@" || return 1
    render "$scene" --plugin "$TMPDIR/neelight.so" --sampler "$sampler" --seed $seed "$@" \
        --spp "$(calculate 'int((n = variance / (wanted * mean) ^ 2 / 256 + 1) < 64 ? 64 : n)' variance="$variance" wanted="$wanted" mean="$mean")"
}

# reference SCENE SAMPLER ARGUMENT...: what the following are compared with
reference()
{
    local scene=$1 sampler=$2
    shift 2
    measured "$scene" "$sampler" 0.0008 "$@" || return
    reference_mean=$mean reference_error=$error
}

# z: of the last render against the reference
z() { calculate '(a - b) / sqrt(x ^ 2 + y ^ 2)' a="$mean" b="$reference_mean" x="$error" y="$reference_error"; }

# same SCENE SAMPLER ARGUMENT...: a point: the mean is the reference's. The error may exceed the pilot's promise by half at most.
same()
{
    local scene=$1 sampler=$2 z
    shift 2
    measured "$scene" "$sampler" 0.0013 "$@" || return
    z=$(z)
    holds 'error > 0 && error < 0.002 * mean && abs(z) <= 4' error="$error" mean="$mean" z="$z"
    point $? "$scene $sampler $*: $mean +- $error, z = ${z:0:6}" "expected $reference_mean +- $reference_error"
}

for scene in lamp sky shapes roulette; do
    reference $scene 'mixture(cosine 1, light 1)'
    for sampler in cosine 'mixture(cosine 1, light(by=area) 1)' nee neelight; do same $scene "$sampler"; done
    [ $scene = roulette ] || for sampler in nee neelight; do
        [ $scene = lamp ] && other=power || other=${scene}power
        same $other "$sampler"
    done
done

# The mistake of `skewed`, 5 % in one of two densities, takes 1 to 2 % of the light away: it must be seen where the others pass.
for scene in lamp sky; do
    reference $scene 'mixture(cosine 1, light 1)'
    measured $scene skewed 0.0013
    z=$(z)
    holds 'z < -4' z="$z"
    point $? "$scene: a density that is 5 % too high is seen: z = ${z:0:6}"
done

# An infinite plane emits too; only what does not sample lights can be used then.
reference plane cosine
for sampler in uniform 'mixture(cosine 1, uniform 1)'; do same plane "$sampler"; done
for sampler in nee neelight light 'mixture(cosine 1, light 1)'; do
    said=$("$MCRENDER" check "$TMPDIR/plane.scn" --plugin "$TMPDIR/neelight.so" --sampler "$sampler" 2>&1)
    [ $? = 3 ] && [[ $said = *"an infinite plane cannot be sampled as a light"* ]]
    point $? "plane $sampler: a located error" "$said"
done

# The cut by depth. Depth 0 shows emission alone: every sampler gives the same bits.
render "$TMPDIR/shapes.scn" --sampler cosine --spp 64 --depth 0
cp "$TMPDIR/out.pfm" "$TMPDIR/emission.pfm"
for sampler in uniform light 'mixture(cosine 1, light 1)' nee neelight; do
    render "$TMPDIR/shapes.scn" --plugin "$TMPDIR/neelight.so" --sampler "$sampler" --spp 64 --depth 0
    check "shapes $sampler --depth 0: the same bits" cmp "$TMPDIR/emission.pfm" "$TMPDIR/out.pfm"
done
for depth in 1 2; do
    reference shapes 'mixture(cosine 1, light 1)' --depth $depth
    for sampler in cosine nee neelight; do same shapes "$sampler" --depth $depth; done
done
# Direct light alone is what `light` is complete for.
reference lamp 'mixture(cosine 1, light 1)' --depth 1
for sampler in light nee neelight; do same lamp "$sampler" --depth 1; done
finish
