/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Textures: colours over (u, v), made by blocks `texture NAME KIND { … }`. Immutable, the scene's; may be used from any thread.
 * u grows to the right and v upward: a picture stands upright on the unit square, its lower left corner at (0, 0).
 */
#ifndef MCR_SCENE_TEXTURE_H
#define MCR_SCENE_TEXTURE_H

#include <stdint.h>

struct mcr_texture;

/*
 * The colours of n lanes: linear Rec. 709, or the numbers of the file where the texture holds data (`colour linear`). u, v: any numbers;
 * those that are not finite count as 0. width: diameter of the footprint in units of (u, v), NULL (or 0, negative, NaN): as sharp as can be.
 * A lane depends on itself alone: its bits are the same in every call, on every instruction set. r, g, b overlap nothing, nor each other.
 */
void mcr_texture_lookup(const struct mcr_texture *texture, uint32_t n, const double *u, const double *v, const double *width, double *r,
                        double *g, double *b);

/* What every lookup lies between, and what is expected of one: for the ranges of parameters, their means and the power of emitters. */
struct mcr_texture_bounds {
    double min[3], max[3]; /* attained or wider; no lookup is outside, not by a rounding */
    double mean[3];        /* over the unit square for gradients, else over a whole period or the whole picture */
};
const struct mcr_texture_bounds *mcr_texture_bounds(const struct mcr_texture *texture);

/* A colour as a number: its luminance (Rec. 709), which of equal components is that number exactly. */
static inline double mcr_texture_number(double r, double g, double b)
{
    return r + (0.7152 * (g - r) + 0.0722 * (b - r));
}

/* 0: lookups do the same for every width, so that none need be computed. */
int mcr_texture_uses_width(const struct mcr_texture *texture);
/* 1: red, green and blue are one number everywhere (a grey picture, a single channel, grey colours). */
int mcr_texture_is_grey(const struct mcr_texture *texture);
/* Bytes of its pictures; 0 for those that are computed. */
uint64_t mcr_texture_bytes(const struct mcr_texture *texture);

#endif
