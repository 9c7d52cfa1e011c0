# SPDX-License-Identifier: Apache-2.0
# Scenes with a known answer as texts in $TMPDIR; sourced. Answers: computed in high precision, cross-checked by quadrature.

# preamble CAMERA: what all have: emitters of radiance 1, `rho` the receiver's albedo, one scattering event
preamble()
{
    cat <<TEXT
mcrender 1
let rho = 1
$1
film { size (16, 16) }
render { roulette off   depth 1 }
TEXT
}

# receiver NAME FROM LIGHT...: a plane through the origin that faces +z, seen at the origin from FROM, with the LIGHT blocks above
receiver()
{
    local name=$1 from=$2
    shift 2
    { preamble "camera perspective { from $from   to (0, 0, 0)   up (0.1, 0.9, 0.3)   fov 1e-9 }"
      cat <<TEXT
material receiver lambert { albedo rho }
material lamp emitter { radiance 1 }
material both emitter { radiance 1   sides two }
material black lambert { albedo 0 }
plane { point (0, 0, 0)   normal (0, 0, 1)   material receiver }
$*
TEXT
    } >"$TMPDIR/$name.scn"
}

# closed NAME SHAPE...: a furnace seen from inside, from a point that is no centre of anything
closed()
{
    local name=$1
    shift
    { preamble "camera perspective { from (0.1, -0.2, 0.15)   to (1, 0.5, -0.7)   fov 70 }"
      cat <<TEXT
material wall emitter { radiance 1   albedo rho   sides two }
$*
TEXT
    } >"$TMPDIR/$name.scn"
}
