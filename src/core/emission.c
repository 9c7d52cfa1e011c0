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

void MCR_ISA_NAME(mcr_stage_background)(struct mcr_batch *batch)
{
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
