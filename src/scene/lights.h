/* SPDX-License-Identifier: Apache-2.0 */
/* Lights that are no shapes, as part of the immutable scene. Positions in render space, directions unit, colours linear Rec. 709. */
#ifndef MCR_SCENE_LIGHTS_H
#define MCR_SCENE_LIGHTS_H

#include "base/diag.h"

enum mcr_light_kind { MCR_LIGHT_POINT, MCR_LIGHT_SPOT, MCR_LIGHT_SUN, MCR_LIGHT_ENVIRONMENT };

/*
 * point   intensity
 * spot    intensity on the axis, times t^2 (3 - 2t) with t = (outer - v) / (outer - inner) clamped to [0, 1], v = 1 - cos of the angle to the axis
 * sun     `direction` is toward it; outer 0: parallel light of this irradiance on a surface that faces it; else the radiance of a cone v <= outer
 */
struct mcr_scene_light {
    const char *name;
    struct mcr_place place;
    uint32_t kind;       /* not MCR_LIGHT_ENVIRONMENT: that is by itself */
    double position[3];
    double direction[3]; /* spot: along its axis, away from it; sun: toward it */
    double colour[3];    /* intensity in W/sr times the square of the scene's scale, so that it is divided by the square of a render length;
                            irradiance in W/m^2; or radiance in W/(sr m^2) */
    double outer, inner; /* 1 - cos of the edge and of where the full light begins, without cancellation; inner <= outer */
};

/*
 * What comes from infinitely far, as a function of direction. In its own frame +y is up. A gradient is linear in the cosine to up on each side of
 * the horizon. An image covers longitude by columns and colatitude by rows, the top row at +y, the middle between columns seen along +z, +x in
 * the left half: as OpenEXR's latitude-longitude maps, right way round from inside.
 */
struct mcr_environment {
    struct mcr_place place;
    double frame[3][3];  /* rows: own x, y, z in render space; orthonormal, may be a reflection */
    double zenith[3], horizon[3], nadir[3]; /* without an image */
    uint32_t width, height;
    const double *texel; /* 3 * width * height, >= 0 and finite, times `scale` */
    double scale;
    int bilinear;        /* between the texels' centres; else constant in each */
};

#define MCR_ENVIRONMENT_TEXELS ((uint64_t)1 << 25) /* 8192 x 4096; 32 bytes each, with what draws from them */
#define MCR_SUN_LEAST 1e-7                         /* degrees: the least angular radius of a sun but 0: below, the roundings of directions show */

#endif
