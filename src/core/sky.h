/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The sky: what comes from infinitely far, as a function of direction. Its parts are the background of the render settings, which is constant and
 * never aimed at, and, in scenes that have them, an environment and suns with an extent, which overlap and add up. To the samplers all of it is one
 * emitter, drawn part by part in proportion to the parts' irradiance and with the sum of their densities, so that every technique sees the same
 * radiance along a direction.
 *
 * Densities are exact for what is drawn: the environment's as constant over each texel's solid angle, whose sides are the numbers in `edge`, or linear
 * in the cosine for a gradient; the suns' constant over their cones. The radiance of a bilinear image is not what its density is in proportion to, but
 * the density is positive wherever the radiance is.
 */
#ifndef MCR_CORE_SKY_H
#define MCR_CORE_SKY_H

#include "base/arena.h"
#include "scene/scene.h"
#include <mcrender/plugin.h>

struct mcr_sky_sun {
    double direction[3];    /* toward its centre */
    double radiance[3];
    double versine;         /* 1 - cos of its angular radius */
    double probability;     /* among the parts of the sky */
    double from;            /* numbers from here on choose it, up to the next one's */
};

struct mcr_sky {
    double background[3];
    const struct mcr_environment *environment; /* NULL: none */
    double probability;         /* of the environment among the parts; numbers below it choose it */
    uint32_t sun_count;
    const struct mcr_sky_sun *sun;
    /* gradient: luminances relative to the largest, the chance of the upper half, and what makes a density of a luminance */
    double zenith, horizon, nadir, above, factor;
    /* image */
    double *edge;               /* height + 1: cosines to +y between the rows, from 1 to -1 */
    double *row_from;           /* 2^row_levels: row r takes numbers row_from[r] .. row_from[r+1]; 2 beyond the last */
    double *row_density;        /* height: the row's probability over one texel's solid angle */
    double *column_from;        /* height * (width + 1): column c of row r takes numbers c .. c + 1 of the row's stretch, which ends with 1 */
    uint32_t row_levels, column_levels;
    double power;               /* luminance of the integral over all directions, W/m^2, without the background; 0: nothing to aim at */
};

/* The sky of a scene that has an environment or suns with an extent; *sky is set to NULL in others. Returns 0, or -1 when memory is short. */
int mcr_sky_create(struct mcr_arena *arena, const struct mcr_scene *scene, const struct mcr_sky **sky);

/* Over n lanes; directions are unit, or (0, 0, 0), which has density 0. The same bits with every instruction set; a lane depends on itself alone. */
struct mcr_sky_functions {
    void (*radiance)(const struct mcr_sky *sky, uint32_t n, const double *x, const double *y, const double *z, double *r, double *g, double *b);
    /* Over solid angle, summed over the parts. */
    void (*density)(const struct mcr_sky *sky, uint32_t n, const double *x, const double *y, const double *z, double *density);
    /* Directions by three numbers in [0, 1): one chooses the part, two the direction. */
    void (*draw)(const struct mcr_sky *sky, uint32_t n, const double *choice, const double *u, const double *v, double *x, double *y, double *z);
};

/* Instruction sets 1 and 2 on x86-64 only. */
extern const struct mcr_sky_functions mcr_sky_functions_isa0, mcr_sky_functions_isa1, mcr_sky_functions_isa2;

#endif
