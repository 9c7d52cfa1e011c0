/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The loops over lanes of the look-ups for light (light.c), compiled once per instruction set, all with the same bits. Private to src/core.
 *
 * Those of a range's points whose find can count are listed in light.lane; from then on ray i, or find i, is that of point lane[i]. light.hit[i] is what
 * it finds: a primitive, MCR_FOUND_NOTHING, or MCR_FOUND_SKY for what comes from infinitely far, the background included.
 */
#ifndef MCR_CORE_LIGHT_LANES_H
#define MCR_CORE_LIGHT_LANES_H

#include "core/batch.h"

#define MCR_FOUND_NOTHING (-1)
#define MCR_FOUND_SKY (-2)

struct mcr_light_functions {
    /* sum[i] += h(density[i]): p, or with the power heuristic p^2. */
    void (*add)(uint32_t n, int power, const double *density, double *sum);
    /* Where nothing was drawn: a direction that everybody knows how to leave out. */
    void (*clear)(struct mcr_batch *batch, const struct mcr_range *range);
    /* Rays toward the points drawn on emitters; hit[] is what each sees unless something is in between. Returns how many. */
    uint32_t (*aim)(struct mcr_batch *batch, const struct mcr_range *range);
    /* After they were traced: rays that are not `seen` find nothing. */
    void (*see)(struct mcr_batch *batch, uint32_t n);
    /* Rays in the directions drawn, *traced of them; behind them are the points that see the background without one. Returns how many in all. */
    uint32_t (*leave)(struct mcr_batch *batch, const struct mcr_range *range, uint32_t *traced);
    /* After they were traced: the points' emitters, and of the rays those that have found light. Returns how many. */
    uint32_t (*find)(struct mcr_batch *batch, uint32_t traced, uint32_t all);
    /* Of finds 0 .. n-1 those in a group's primitives: the surface points that they have come to. Returns how many; at c is that of find of[c]. */
    uint32_t (*surfaces)(struct mcr_batch *batch, uint32_t n, uint32_t group);
    /* The same of the sky, whose radiance goes to lr .. lb at once. */
    uint32_t (*sky)(struct mcr_batch *batch, uint32_t n);
    /* Adds throughput * f * radiance * h(p) / (h(p) + sum) / p to the slots; where `seen` is negative, -throughput * f * radiance / p. */
    void (*shed)(struct mcr_batch *batch, uint32_t count);
    /* What the rays have hit, by the points that they left; and then the weights of it. */
    void (*hits)(struct mcr_batch *batch);
    void (*weights)(struct mcr_batch *batch);
    /* With control.h, where f is that toward the normal: which points are controlled, and their unoccluded light, added to the slots. */
    void (*control)(struct mcr_batch *batch, const struct mcr_range *range);
    /*
     * Of controlled light, the points of its own technique (own) that are hidden count, and no others: `seen` becomes negative there, and 0 where it is
     * seen. What rays have hit of it counts nothing: it is in its closed form already.
     */
    void (*turn)(struct mcr_batch *batch, uint32_t n, int own);
    void (*spare)(struct mcr_batch *batch);
};

void MCR_ISA_NAME(mcr_light_control)(struct mcr_batch *batch, const struct mcr_range *range);
void MCR_ISA_NAME(mcr_light_turn)(struct mcr_batch *batch, uint32_t n, int own);
void MCR_ISA_NAME(mcr_light_spare)(struct mcr_batch *batch);

/* Instruction sets 1 and 2 on x86-64 only. */
extern const struct mcr_light_functions mcr_light_functions_isa0, mcr_light_functions_isa1, mcr_light_functions_isa2;

#endif
