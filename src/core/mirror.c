/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Where a mirror-like lobe was chosen, it takes the place of what the sampler drew; elsewhere the sampler's density is multiplied by the probability that
 * none was. Before the scatter stage. Stage file, compiled once per instruction set.
 */
#include "core/stages.h"

void MCR_ISA_NAME(mcr_stage_mirror)(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_lobes *l = &batch->lobe;
    const int spreads = batch->core->group[range->group].spreads;
    const double *none = l->none, *probability = l->probability, *lx = l->x, *ly = l->y, *lz = l->z, *lr = l->r, *lg = l->g, *lb = l->b;
    double *wx = batch->wx, *wy = batch->wy, *wz = batch->wz, *fr = batch->fr, *fg = batch->fg, *fb = batch->fb;
    double *density = batch->density, *own = batch->material_density;
    MCR_LANES
    for (uint32_t k = range->begin; k < range->end; k++) {
        int drawn = none[k] > 0;
        double chance = probability[k], sampled = spreads ? density[k] : 0.0, had = spreads ? own[k] : 0.0;
        wx[k] = drawn ? wx[k] : lx[k];
        wy[k] = drawn ? wy[k] : ly[k];
        wz[k] = drawn ? wz[k] : lz[k];
        fr[k] = drawn ? fr[k] : lr[k];
        fg[k] = drawn ? fg[k] : lg[k];
        fb[k] = drawn ? fb[k] : lb[k];
        density[k] = (drawn ? sampled : 1.0) * chance;
        own[k] = (drawn ? had : 1.0) * chance;
    }
}
