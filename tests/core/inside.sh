# SPDX-License-Identifier: Apache-2.0
# Materials inside materials, mix and mask, in renders: lobes, light that crosses and interiors of what is inside, against known answers. What a single call
# answers is tested in tests/plugins/inside.c; here is what the core makes of it.
part=quick
. "$srcdir/tests/tap.sh"
. "$srcdir/tests/core/measure.sh"
. "$srcdir/tests/core/scenes.sh"
${MCR_CC:-cc} -std=gnu17 -O2 -shared -fPIC -I"$srcdir/src" "$srcdir/tests/core/sheet.c" -o "$TMPDIR/sheet.so" -lm || { point 1 'sheet.c compiles'; finish; }
scene=$TMPDIR/scene.scn

# ---- A closed room whose walls keep .8 of the light: S1 with a mirror that emits nothing, and so 0.4 of the radiance ----
for wall in 'mix { first shiny   second paint   amount 0.4 }' 'mix { first part   second paint   amount 0.25 }
material part mix { first shiny   second paint   amount 0.2 }'; do
    closed scene "material wall $wall
material shiny mirror { reflectance 0.8 }
material paint emitter { radiance 1   albedo 0.8   sides two }
box { min (-2, -1, -1.5)   max (1.5, 2, 3)   transform { rotate (1, 2, 3, 40) }   material wall }"
    sed -i '/^material wall emitter/d' "$scene"
    known "walls that are ${wall%%$'\n'*}" "$scene" 1.731564544 'uniform;cosine;bsdf;nee;mixture(bsdf 1, light 1)' --depth 8
done

# ---- The white furnace: a ball of what loses no light is not seen ----

# ball MATERIAL...
ball()
{
    cat >"$scene" <<TEXT
mcrender 1
camera perspective { from (0, 0, 3)   to (0, 0, 0)   fov 39 }
film { size (16, 16) }
render { roulette off   depth 150   background 1 }
texture board checker { even 0.9   odd (0.2, 0.5, 0.1)   scale 7 }
material glass dielectric { index 1.5 }
material water dielectric { index 1.33   priority 1 }
material white lambert { albedo 1 }
material shiny mirror { reflectance 1 }
material lace mask { material glass   opacity 0.6 }
sphere { center (0, 0, 0)   radius 1   material ball }
TEXT
    printf '%s\n' "$@" >>"$scene"
    known "furnace: $1" "$scene" 1 "${samplers:-bsdf;cosine}"
}
ball 'material ball mix { first white   second shiny   amount 0.4 }'
ball 'material ball mix { first glass   second white   amount 0.3 }'
ball 'material ball mix { first part   second glass   amount board }' 'material part mix { first white   second shiny   amount 0.7 }'
ball 'material ball mask { material shiny   opacity board }'
ball 'material ball mask { material part   opacity (0.9, 0.3, 0.6) }' 'material part mix { first white   second shiny   amount board }'
# Light that crosses where an interior begins: radiance over the squared index is kept, else light would be made where it goes in by a hole and out by the glass
ball 'material ball mask { material glass   opacity 0.6 }'
ball 'material ball mask { material glass   opacity board }'
ball 'material ball mask { material part   opacity 0.5 }' 'material part mix { first glass   second white   amount 0.2 }'
ball 'material ball mix { first lace   second white   amount 0.3 }'
ball 'material ball mask { material water   opacity 0.5 }' 'sphere { center (0.3, 0, 0)   radius 0.9   material lace }'

# A coat over a base is two in one as well, by one plugin
ball 'material ball glossy { albedo 1   roughness 0 }'
samplers=bsdf ball 'material ball glossy { albedo 1   roughness 0.05 }'
ball 'material ball glossy { albedo 1   roughness 0.6   index 1.8 }'
samplers=bsdf ball 'material ball mix { first part   second white   amount board }' 'texture rough gradient { from 0.01   to 0.9   along u }' \
    'material part glossy { albedo 1   roughness rough }'

# ---- Interiors: a slab, seen straight on, under a light of 1 from everywhere ----

# slab MATERIAL...: 1 thick
slab()
{
    cat >"$scene" <<TEXT
mcrender 1
camera perspective { from (0, 0, 5)   to (0, 0, 0)   up (0, 1, 0)   fov 1e-9 }
film { size (16, 16) }
render { roulette off   depth 100   background 1 }
box { min (-9, -9, 0)   max (9, 9, 1)   material slab }
TEXT
    printf '%s\n' "$@" >>"$scene"
}
# What crosses an interface is t = (1 - o) + o (1 - R), what comes back r = o R; inside, a = exp(-attenuation) is left: t^2 a and r behind each other.
for index in 1 1.5; do
    for opacity in 1 0.5 0; do
        slab "material slab mask { material ink   opacity $opacity }" "material ink dielectric { index $index   attenuation 0.7 }"
        known "slab of index $index and opacity $opacity" "$scene" \
            "$(calculate 'r + t * t * a * (1 + r * a) / (1 - r * r * a * a)' r="$(calculate 'o * ((n - 1) / (n + 1)) ^ 2' o=$opacity n=$index)" \
                t="$(calculate '1 - o * ((n - 1) / (n + 1)) ^ 2' o=$opacity n=$index)" a="$(calculate 'exp(-.7)')")" bsdf
    done
done
# A mix is filled with what its glass is filled with.
slab 'material slab mix { first ink   second black   amount 0.25 }' 'material ink dielectric { index 1   attenuation 0.7 }' 'material black lambert { albedo 0 }'
known 'a mix of ink and black' "$scene" "$(calculate '.75 * .75 * exp(-.7)')" 'bsdf;cosine'

# ---- Where something inside cannot tell its albedo, the layer is estimated ----
cat >"$scene" <<TEXT
mcrender 1
camera perspective { from (0, 0, 5)   to (0, 0, 0)   fov 1e-6 }
film { size (8, 8) }
render { spp 64   sampler cosine   depth 0 }
material part sheet { diffuse 0.5 }
material white lambert { albedo 1 }
material both mix { first part   second white   amount 0.25 }
plane { point (0, 0, 0)   normal (0, 0, 1)   material both }
TEXT
if [ -e "$MCRENDER_MODULE_PATH/oiio.so" ]; then
    check 'the albedo of a mix, of which one cannot tell its own' "$MCRENDER" "$scene" --plugin "$TMPDIR/sheet.so" --layers albedo --quiet -o "$TMPDIR/layers.exr"
else
    skip 'the albedo of a mix, of which one cannot tell its own' "OpenImageIO's module is not built"
fi
finish
