/* SPDX-License-Identifier: Apache-2.0 */
/* Radiance into the slots of the samples. Every lane has a slot of its own. Stage file, compiled once per instruction set. */
#include "core/stages.h"

void MCR_ISA_NAME(mcr_stage_emit)(struct mcr_batch *batch, uint32_t begin, uint32_t end)
{
    const struct mcr_paths *paths = &batch->sorted;
    MCR_LANES
    for (uint32_t k = begin; k < end; k++) {
        uint32_t slot = paths->slot[k];
        batch->slot_r[slot] += paths->r[k] * batch->fr[k];
        batch->slot_g[slot] += paths->g[k] * batch->fg[k];
        batch->slot_b[slot] += paths->b[k] * batch->fb[k];
    }
}

#define BLOCK 64u

/* The same where radiance depends on direction. */
static void sky(struct mcr_batch *batch)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_paths *paths = &batch->state;
    const double *weight = core->combines ? batch->light.weight : NULL;
    double x[BLOCK], y[BLOCK], z[BLOCK], red[BLOCK], green[BLOCK], blue[BLOCK];
    for (uint32_t at = 0; at < batch->miss_count; at += BLOCK) {
        const uint32_t *miss = batch->miss + at, n = batch->miss_count - at < BLOCK ? batch->miss_count - at : BLOCK;
        for (uint32_t i = 0; i < n; i++) {
            x[i] = batch->rdx[miss[i]];
            y[i] = batch->rdy[miss[i]];
            z[i] = batch->rdz[miss[i]];
        }
        core->sky_functions->radiance(core->sky, n, x, y, z, red, green, blue);
        for (uint32_t i = 0; i < n; i++) {
            uint32_t l = batch->source[miss[i]], slot = paths->slot[l];
            double share = weight ? weight[miss[i]] : 1;
            batch->slot_r[slot] += paths->r[l] * red[i] * share;
            batch->slot_g[slot] += paths->g[l] * green[i] * share;
            batch->slot_b[slot] += paths->b[l] * blue[i] * share;
        }
    }
}

void MCR_ISA_NAME(mcr_stage_background)(struct mcr_batch *batch)
{
    if (batch->core->sky) {
        sky(batch);
        return;
    }
    const struct mcr_paths *paths = &batch->state;
    const double *radiance = batch->core->scene->render.background, *weight = batch->core->combines ? batch->light.weight : NULL;
    MCR_LANES
    for (uint32_t i = 0; i < batch->miss_count; i++) {
        uint32_t j = batch->miss[i], l = batch->source[j], slot = paths->slot[l];
        double share = weight ? weight[j] : 1;
        batch->slot_r[slot] += paths->r[l] * radiance[0] * share;
        batch->slot_g[slot] += paths->g[l] * radiance[1] * share;
        batch->slot_b[slot] += paths->b[l] * radiance[2] * share;
    }
}
