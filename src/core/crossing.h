/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Surfaces that a ray crosses straight on: those whose material lets light pass, and those inside of an interior of higher priority. And what lies between
 * surfaces: interiors that absorb. Nothing of this runs in scenes without such materials. Private to src/core.
 *
 * A path holds the interiors that it is in, as many as closed surfaces can nest and at most MCR_INTERIORS, in the order in which it entered; the one that counts is that of the highest
 * priority, the last entered of equals (Schmidt and Budge, "Simple nested dielectrics in ray traced images", 2002). What is entered beyond
 * these is not remembered, but counted: batch->overfull. Radiance falls by exp(-attenuation * distance) in the interior that counts (Bouguer, Lambert, Beer).
 *
 * Paths cross or stay by chance: they cross with the mean of the colours' shares, and their throughput is weighted by share over chance. So do look-ups that take what they meet first;
 * those that see a point cross always and are weighted by the share. In no case is a bounce counted, and the techniques' densities are those of the point where the ray began.
 */
#ifndef MCR_CORE_CROSSING_H
#define MCR_CORE_CROSSING_H

#include "core/batch.h"

/* Tables of the scene's interiors. Returns 0, or -1 when memory is short. After mcr_groups_init. */
int mcr_crossing_init(struct mcr_core *core, struct mcr_arena *arena);
/* The interiors in which the camera stands: planes by the side it is on, closed shapes by the crossings of a ray. After mcr_surfaces_init. */
void mcr_crossing_camera(struct mcr_core *core);

/* After the rays' hits are known: moves them on to where they stay, and weights the paths. Returns 0 or a plugin's failure. */
int32_t mcr_crossing_paths(struct mcr_batch *batch);
/* After the surface stage: the points' interiors, and the indices of refraction around them. */
void mcr_crossing_points(struct mcr_batch *batch);
/* After scattering: who went through the surface is inside, or out of it. */
void mcr_crossing_scattered(struct mcr_batch *batch, const struct mcr_range *range);
/* New camera paths in states from .. from+n-1. */
void mcr_crossing_begin(struct mcr_batch *batch, uint32_t from, uint32_t n);

/* Rays of look-ups, compact; ray i leaves the point lane[i]. */
struct mcr_look {
    struct mcr_rays rays;
    const uint32_t *lane;
    uint64_t salt;          /* of mcr_look_closest: another one for each of a point's look-ups */
    double *far;            /* in: the rays' lengths; of mcr_look_closest out: to the hit */
    int64_t *hit;           /* of mcr_look_closest: the primitive, or -1 */
    double *seen;           /* of mcr_look_visible: 1 where something arrives */
    double *r, *g, *b;      /* by lane: weighted by what the way lets through. Left alone where nothing does and the ray is not seen */
};

/* Whether light comes through, up to `far`; and the first hit. The caller counts the rays. Return 0 or a plugin's failure. */
int32_t mcr_look_visible(struct mcr_batch *batch, const struct mcr_look *look);
int32_t mcr_look_closest(struct mcr_batch *batch, const struct mcr_look *look);

/* A point near primitive `primitive`, brought onto it, and the unit normal of its front there. */
void mcr_surface_project(const struct mcr_core *core, int64_t primitive, double q[3], double n[3]);

#endif
