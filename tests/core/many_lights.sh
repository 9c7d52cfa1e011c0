# SPDX-License-Identifier: Apache-2.0
# Ten thousand small emitters beside the same total light as one emitter: the same picture, and at equal numbers of samples no more noise.
# A ceiling of 100 x 100 panels covers what one panel covers, so that both scenes have the same answer; a cloud of sparks and one ball
# of their total power have not, but their noise may be compared, each with its mean.
#
# The variance of one sample is averaged over 8 seeds, whose scatter tells its standard error.
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"

room()
{
    cat <<'TEXT'
mcrender 1
camera perspective { from (0, 0.6, 3.4)   to (0, 0.35, 0)   fov 14 }
film { size (16, 16) }
render { roulette off   depth 1 }
material white lambert { albedo 0.7 }
material lamp emitter { radiance 4 }
quad { corner (-1, 0, -1)   u (0, 2, 0)   v (0, 0, 2)   material white }
quad { corner (1, 0, -1)   u (0, 2, 0)   v (0, 0, 2)   material white }
quad { corner (-1, 0, -1)   u (2, 0, 0)   v (0, 0, 2)   material white }
quad { corner (-1, 0, -1)   u (2, 0, 0)   v (0, 2, 0)   material white }
TEXT
}

panels() # SIDE: side * side of them, which cover a square, over a block
{
    room
    echo 'box { size (0.6, 1.2, 0.6)   transform { rotate (0, 1, 0, 15)   translate (-0.7, 0, -0.7) }   material white }'
    awk -v n="$1" 'BEGIN { s = 1.6 / n
        for (i = 0; i < n; i++) for (j = 0; j < n; j++)
            printf "quad { corner (%.9g, 1.99, %.9g) u (%.9g, 0, 0) v (0, 0, %.9g) material lamp }\n", i * s - 0.8, j * s - 0.8, s, s }'
}

balls() # N: in a cloud, of the same power together; without a block, whose half shadows would be noise of their own, and so small that they
        # hardly hide each other, which is noise as well (a tenth of the light hidden: a relative variance of .11)
{
    room
    echo 'material spark emitter { radiance 400 }'
    awk -v n="$1" 'function random() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
        BEGIN { seed = 4711
            if (n == 1) { print "sphere { center (0, 1.6, 0) radius 0.25 material lamp }"; exit }
            for (i = 0; i < n; i++) { x = 1.8 * random() - 0.9; y = 1.3 + 0.6 * random(); z = 1.8 * random() - 0.9
                printf "sphere { center (%.6f, %.6f, %.6f) radius %.9g material spark }\n", x, y, z, 0.025 / sqrt(n) } }'
}

# several SCENE SAMPLER: sets average, average_error, noise and noise_error: of 8 seeds, the mean and one sample's variance
several()
{
    for seed in 1 2 3 4 5 6 7 8; do
        render "$TMPDIR/$1.scn" --sampler "$2" --spp 64 --seed $seed
        echo "$mean $variance"
    done >"$TMPDIR/seeds"
    read -r average average_error noise noise_error <<<"$(awk '{ m += $1; mm += $1 ^ 2; v += $2; vv += $2 ^ 2 }
        function error(sum, squares) { x = (squares / NR - (sum / NR) ^ 2) / (NR - 1); return sqrt(x > 0 ? x : 0) }
        END { printf "%.17g %.17g %.17g %.17g\n", m / NR, error(m, mm), v / NR, error(v, vv) }' "$TMPDIR/seeds")"
}

panels 1 >"$TMPDIR/one.scn"
panels 100 >"$TMPDIR/many.scn"
balls 1 >"$TMPDIR/ball.scn"
balls 10000 >"$TMPDIR/cloud.scn"
while read -r panel_share ball_share sampler; do
    several one "$sampler"
    one_average=$average one_error=$average_error one_noise=$noise one_noise_error=$noise_error
    several many "$sampler"
    z=$(calculate '(a - b) / sqrt(x ^ 2 + y ^ 2)' a="$average" b="$one_average" x="$average_error" y="$one_error")
    holds 'abs(z) <= 5.5' z="$z" # 14 degrees of freedom: as seldom as 4 of a normal deviate
    point $? "$sampler: 10000 panels light a room as one does, z = ${z:0:6}" "$average +- $average_error, expected $one_average +- $one_error"
    holds 'many + 3 * e < share * (one - 3 * f)' share="$panel_share" many="$noise" one="$one_noise" e="$noise_error" f="$one_noise_error"
    point $? "$sampler: a sample's variance $noise +- $noise_error, of one emitter $one_noise +- $one_noise_error"
    several ball "$sampler"
    one_noise=$(calculate 'v / m ^ 2' v="$noise" m="$average")
    several cloud "$sampler"
    noise=$(calculate 'v / m ^ 2' v="$noise" m="$average") noise_error=$(calculate 'e / m ^ 2' e="$noise_error" m="$average")
    holds 'cloud + 3 * e < share * one' share="$ball_share" cloud="$noise" e="$noise_error" one="$one_noise"
    point $? "$sampler: a cloud of 10000 balls has relative variance $noise +- $noise_error, one ball $one_noise"
done <<'TEXT'
0.6 0.25 nee
0.85 1.2 mixture(bsdf 1, light 1)
TEXT
finish
