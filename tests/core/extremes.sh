# SPDX-License-Identifier: Apache-2.0
# Scenes at the extremes, through the whole program: closed rooms at scales of 1e-9 to 1e9, far from the origin, turned, walled with enormous spheres or needles.
# The first wall that a path meets is white and emits nothing, all others emit 1 and scatter nothing: with `cosine` every sample is exactly 1. A self-hit
# makes it 0, a leak finds the background, 1e30. 2e5 paths of two segments each.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"

# room NAME PLACE SIZE SHAPE...: PLACE turns, scales and moves the room; its front wall is `dark`, the others `bright`. The camera looks at the front.
room() # WHAT SCALE OFFSET ROTATION FRONT REST ARGUMENT...
{
    local what=$1 scale=$2 offset=$3 turn=$4 front=$5 rest=$6
    shift 6
    cat >"$TMPDIR/scene.scn" <<TEXT
mcrender 1
let s = $scale
let o = $offset
# The room is turned about its view, the x axis, and with it about z.
let t = $turn
camera perspective { from (o, -0.7 * o, 0.3 * o)   to (o + s * cos(t), -0.7 * o + s * sin(t), 0.3 * o)   up (0, 0, 1)   fov 60 }
film { size (256, 256) }
render { sampler cosine   roulette off   depth 1   background 1e30   spp 4 }
material dark lambert { albedo 1 }
material bright emitter { radiance 1   sides two }
group {
    transform { rotate (1, 0, 0, t - 8)   rotate (0, 0, 1, t)   scale s   translate (o, -0.7 * o, 0.3 * o) }
    $front
    $rest
}
TEXT
    render "$TMPDIR/scene.scn" "$@" || return
    holds 'abs(mean - 1) < 1e-12 && error < 1e-12' mean="$mean" error="$error"
    point $? "$what, scale $scale, offset $offset, turned by $turn $*: mean $mean, error $error"
}

front='quad { corner (0.5, -0.5, -0.5)   u (0, 1, 0)   v (0, 0, 1)   material dark }'
rest='quad { corner (-0.5, -0.5, -0.5)   u (0, 1, 0)   v (0, 0, 1)   material bright }
    quad { corner (-0.5, -0.5, -0.5)   u (1, 0, 0)   v (0, 0, 1)   material bright }   quad { corner (-0.5, 0.5, -0.5)   u (1, 0, 0)   v (0, 0, 1)   material bright }
    quad { corner (-0.5, -0.5, -0.5)   u (1, 0, 0)   v (0, 1, 0)   material bright }   quad { corner (-0.5, -0.5, 0.5)   u (1, 0, 0)   v (0, 1, 0)   material bright }'
for scale in 1e-9 1e-6 1e-3 1 1e3 1e6 1e9; do
    room 'room of quads' $scale 0 33 "$front" "$rest"
done
for offset in 1 1e3 1e6 1e8; do
    room 'room of quads' 1 $offset 33 "$front" "$rest"
done
room 'room of quads' 1 0 0 "$front" "$rest" --accel bvh
room 'room of quads' 1e-6 1 33 "$front" "$rest" --accel bvh
room 'room of quads' 1 1e8 71 "$front" "$rest" --accel bvh

# A mesh; its walls share vertices
corners='(-0.5, -0.5, -0.5), (0.5, -0.5, -0.5), (0.5, 0.5, -0.5), (-0.5, 0.5, -0.5), (-0.5, -0.5, 0.5), (0.5, -0.5, 0.5), (0.5, 0.5, 0.5), (-0.5, 0.5, 0.5)'
front_mesh="mesh { vertices ($corners)   faces ((1, 5, 6, 2))   material dark }"
rest_mesh="mesh { vertices ($corners)   faces ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (2, 6, 7, 3), (3, 7, 4, 0))   material bright }"
for case in 1e-9/0 1/0 1e9/0 1/1e8; do
    for accel in list bvh; do room 'room of triangles' ${case%/*} ${case#*/} 33 "$front_mesh" "$rest_mesh" --accel $accel; done
done

# The same with a front of needles: strips 1e6 times as long as wide beside broad ones
needles='mesh { vertices ((0.5, -0.5, -0.5), (0.5, 0, -0.5), (0.5, 1e-6, -0.5), (0.5, 0.5, -0.5), (0.5, -0.5, 0.5), (0.5, 0, 0.5), (0.5, 1e-6, 0.5), (0.5, 0.5, 0.5))
    faces ((0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3))   material dark }'
room 'room with needles' 1 0 33 "$needles" "$rest_mesh"

# A sphere as the front, seen from outside, that bulges into the room: no ray that leaves it can meet it again.
for radius in 1e4 1e5 1e6 1e7 1e8; do
    wall="sphere { center (0.45 + $radius, 0, 0)   radius $radius   material dark }"
    room "room with a sphere of radius $radius" 1 0 33 "$wall" "$rest $(echo "$front" | sed 's/dark/bright/')"
    room "room with a sphere of radius $radius" 1e-3 0 0 "$wall" "$rest $(echo "$front" | sed 's/dark/bright/')" --accel bvh
done
room 'room with an ellipsoid' 1 0 33 'sphere { center (0, 0, 0)   radius 1e5   transform { scale (1, 0.7, 2)   translate (100000.4, 0, 0) }   material dark }' \
    "$rest $(echo "$front" | sed 's/dark/bright/')"

# Mirrored: the scene in a mirroring transform, seen by a camera that stands in the mirror, against the scene as it is. x -> -x, which the camera's `right`
# follows, so that the pictures are each other's mirror images: figures over all of the picture agree.
sides()
{
    cat <<TEXT
mcrender 1
camera perspective { from ($1 0.3, 0.4, 5)   to (0, 0.2, 0)   fov 40 }
film { size (32, 32) }
render { sampler mixture(cosine 1, light 1)   depth 6   background 0.1 }
material floor lambert { albedo (0.6, 0.5, 0.3) }
material other lambert { albedo (0.2, 0.3, 0.7) }
material lamp emitter { radiance (9, 5, 4) }
group {
    transform { scale ($1 1, 1, 1) }
    quad { corner (-2, -1, -2)   u (0, 0, 4)   v (4, 0, 0)   material floor }
    quad { corner (-1, 2, -1)   u (1, 0, 0)   v (0, 0, 1)   material lamp }
    disk { center (1.5, 0.5, 0)   normal (-1, 1, 0)   radius 0.5   material lamp }
    triangle { a (-1.8, -0.5, 0)   b (-1.2, -0.5, 0.3)   c (-1.5, 0.5, 0)   material lamp }
    sphere { center (0, -0.4, 0.5)   radius 0.6   material other }
    box { min (0.5, -1, -1)   max (1, 0.2, 0)   transform { rotate (0, 1, 0, 20) }   material other }
    mesh { vertices ((-1, -1, 0), (-0.2, -1, 0), (-0.6, 0.3, -0.3))   faces ((0, 1, 2))   normals ((-1, 0, 1), (1, 0, 1), (0, 1, 1))   material floor }
}
TEXT
}
sides '' >"$TMPDIR/plain.scn"
sides '-' >"$TMPDIR/mirrored.scn"
render "$TMPDIR/plain.scn" --spp 1024 --seed 3
plain=$mean plain_error=$error
render "$TMPDIR/mirrored.scn" --spp 1024 --seed 4
holds 'abs(mean - plain) <= 4 * sqrt(error ^ 2 + plain_error ^ 2) && error < 0.005 * mean' mean="$mean" plain="$plain" error="$error" plain_error="$plain_error"
point $? "mirrored: $mean +- $error, plain: $plain +- $plain_error"

# One lamp alone, lit from its front only, mirrored or not: a flipped normal would make it dark.
for lamp in 'quad { corner (-1, 2, -1)   u (1, 0, 0)   v (0, 0, 1)   material lamp }' 'disk { center (1.5, 0.5, 0)   normal (-1, 1, 0)   radius 0.5   material lamp }' \
    'triangle { a (-1.8, -0.5, 0)   b (-1.2, -0.5, 0.3)   c (-1.5, 0.5, 0)   material lamp }' 'box { min (0.5, -1, -1)   max (1, 0.2, 0)   material lamp }' \
    'sphere { center (0, 0, 0)   radius 0.5   transform { scale (1, 2, 1) }   material lamp }'; do
    for mirror in '' -; do
        sides "$mirror" | sed '/^    [a-z]* {.*material/d' | sed "/transform { scale/a $lamp" >"$TMPDIR/lamp.scn"
        render "$TMPDIR/lamp.scn" --depth 0 --spp 64
        [ -z "$mirror" ] && plain=$mean plain_error=$error
    done
    holds 'plain > 0.1005 && abs(mean - plain) <= 4 * sqrt(error ^ 2 + plain_error ^ 2)' mean="$mean" plain="$plain" error="$error" plain_error="$plain_error"
    point $? "${lamp%% *} alone, mirrored: $mean, plain: $plain"
done

# Rays that run almost along planes: the cosine to a side is tiny, of either sign, or the very number by which the kernels keep it off zero.
for tilt in 0 1e-100 -1e-100 2e-100 -2e-100 1e-300 -1e-300 1e-84 -1e-84; do
    for shape in 'quad { corner (-4, -4, 0)   u (8, 0, 0)   v (0, 8, 0)   material lamp }' 'box { min (-4, -4, -1)   max (4, 4, 0)   material lamp }' \
        'box { min (-4, -4, -1)   max (4, 4, 0)   material lamp   transform { rotate (0, 0, 1, 30) } }' \
        'box { min (-4, -4, -1)   max (4, 4, 0)   material lamp   transform { rotate (1, 2, 3, 20) } }'; do
        for accel in list bvh; do
            cat >"$TMPDIR/scene.scn" <<TEXT
mcrender 1
camera orthographic { from (0, 0, 5)   to ($tilt, $tilt, 4)   height 2 }
film { size (8, 8) }
render { sampler cosine   depth 0   spp 4 }
material lamp emitter { radiance 1 }
$shape
TEXT
            render "$TMPDIR/scene.scn" --accel $accel
            holds 'mean == 1' mean="$mean"
            point $? "a view tilted by $tilt, ${shape%%\{*}$accel: mean $mean"
        done
    done
done
finish
