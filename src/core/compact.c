/* SPDX-License-Identifier: Apache-2.0 */
/* Rays for the points that live, each starting off its surface (MCR_OFFSET). Stage file, compiled once per instruction set. */
#include "core/stages.h"

void MCR_ISA_NAME(mcr_stage_compact)(struct mcr_batch *batch)
{
    const struct mcr_surface_points *at = &batch->at;
    const double *alive = batch->alive;
    uint32_t *living = batch->source;
    uint32_t rays = 0;
    for (uint32_t r = 0; r < batch->range_count && !batch->range[r].ends; r++)
        for (uint32_t k = batch->range[r].begin, end = batch->range[r].end; k < end; k++) {
            living[rays] = k; /* without a branch: who dies is not to be foreseen */
            rays += alive[k] > 0;
        }
    batch->rays = rays;
    const uint32_t *source = batch->source;
    MCR_LANES
    for (uint32_t j = 0; j < rays; j++) {
        uint32_t k = source[j];
        double dx = batch->wx[k], dy = batch->wy[k], dz = batch->wz[k];
        double gx = at->gx[k], gy = at->gy[k], gz = at->gz[k];
        double off = MCR_OFFSET * at->reach[k];
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
