/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Affine maps of nested groups. The translation is kept to about 106 bits and composed from the outside to the inside, the camera's
 * position subtracted first: a far origin, or turning about a far pivot, costs no accuracy.
 */
#ifndef MCR_SCENE_TRANSFORM_H
#define MCR_SCENE_TRANSFORM_H

#include <stdint.h>

struct mcr_transform {
    double l[3][3];          /* linear part: rows */
    double t[3], low[3];     /* translation, and what t does not hold of it */
    uint32_t steps;          /* that went into l: its rounding error is about 8 u a step */
    int mirrored;            /* det l < 0 */
};

/* The map from the world to the frame whose origin is the camera. */
void mcr_transform_init(struct mcr_transform *transform, const double camera[3]);
/* transform becomes: first the step (linear l, translation t), then what it was before. */
void mcr_transform_then(struct mcr_transform *transform, double l[3][3], const double t[3]);
/* After a block of steps: 0 and `mirrored` set, -1 singular, -2 out of range. */
int mcr_transform_finish(struct mcr_transform *transform);

void mcr_transform_point(const struct mcr_transform *transform, const double p[3], double out[3]);
void mcr_transform_vector(const struct mcr_transform *transform, const double v[3], double out[3]);
/* Directions of surfaces: the inverse transpose, so that fronts stay fronts. Unit. Returns 0 if n is zero. */
int mcr_transform_normal(const struct mcr_transform *transform, const double n[3], double out[3]);
/* The factor if it is a similarity to rounding, else 0. */
double mcr_transform_similarity(const struct mcr_transform *transform);

/* Matrices of the steps. The axis need not be a unit vector; 0 if it is zero. */
int mcr_rotation(const double axis[3], double degrees, double l[3][3]);
/* +z toward to - from, +y toward up. 0 if the points coincide or up is parallel. */
int mcr_lookat(const double from[3], const double to[3], const double up[3], double l[3][3]);

#define MCR_SINGULAR (16 * 0x1p-53) /* |det| / product of the columns' lengths: 3 products of 3 factors and 5 sums, each rounded */

struct mcr_build;
struct mcr_item;
/* Applies the blocks of steps (the last step first) to `transform`. Returns 0, or -1 after an error. */
int mcr_build_transform(struct mcr_build *build, const struct mcr_item *block, struct mcr_transform *transform);

#endif
