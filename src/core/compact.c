/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Rays for the points that live. A ray starts off its surface, on the side it leaves to, by OFFSET u max(|p|, |o|, |c|, R).
 *
 * OFFSET: the point is off its surface along the normal by at most about 4 u of that maximum after the projection in the surface stage (3 for the
 * dot product and its difference, 1 for the subtraction); the kernels' numerators n.(c - o) err by 4 u of it, and the sphere's |f|^2 - R^2 by
 * 4 u R^2, which is 2 u R of distance. 16 u is twice their sum.
 *
 * Stage file, compiled once per instruction set.
 */
#include "core/stages.h"

#define OFFSET (16 * 0x1p-53)

void MCR_ISA_NAME(mcr_stage_compact)(struct mcr_batch *batch)
{
    const struct mcr_surface_points *at = &batch->at;
    uint32_t rays = 0;
    for (uint32_t r = 0; r < batch->range_count && !batch->range[r].ends; r++)
        for (uint32_t k = batch->range[r].begin; k < batch->range[r].end; k++) {
            if (batch->alive[k] > 0)
                batch->source[rays++] = k;
            else
                batch->job[batch->sorted.slot[k] / MCR_JOB_SLOTS].pending--;
        }
    batch->rays = rays;
    const uint32_t *source = batch->source;
    MCR_LANES
    for (uint32_t j = 0; j < rays; j++) {
        uint32_t k = source[j];
        double dx = batch->wx[k], dy = batch->wy[k], dz = batch->wz[k];
        double gx = at->gx[k], gy = at->gy[k], gz = at->gz[k];
        double off = OFFSET * at->reach[k];
        off = gx * dx + gy * dy + gz * dz < 0 ? -off : off;
        batch->rox[j] = at->px[k] + off * gx;
        batch->roy[j] = at->py[k] + off * gy;
        batch->roz[j] = at->pz[k] + off * gz;
        batch->rdx[j] = dx;
        batch->rdy[j] = dy;
        batch->rdz[j] = dz;
    }
    struct mcr_paths swap = batch->state;
    batch->state = batch->sorted;
    batch->sorted = swap;
    batch->states = batch->points;
}
