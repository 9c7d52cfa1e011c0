/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Where a mirror-like lobe was chosen, it takes the place of what the sampler drew; elsewhere the sampler's density is multiplied by the probability that
 * none was. Before the scatter stage. Stage file, compiled once per instruction set.
 */
#include <string.h>

#include "core/stages.h"

/* Takes the lobe's value where one was chosen. */
static void take(uint32_t n, const double *none, const double *lobe, double *value)
{
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        value[i] = none[i] > 0 ? value[i] : lobe[i];
}

/* The density of what was drawn, times the probability of none; or the lobe's probability. */
static void weigh(uint32_t n, const double *none, const double *probability, double *density)
{
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        density[i] = (none[i] > 0 ? density[i] : 1.0) * probability[i];
}

void MCR_ISA_NAME(mcr_stage_mirror)(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_lobes *l = &batch->lobe;
    const uint32_t b = range->begin, n = range->end - b;
    const double *none = l->none + b;
    double *density = batch->density + b, *own = batch->material_density + b;
    if (!batch->core->group[range->group].spreads) { /* nothing was drawn */
        memset(density, 0, n * sizeof *density);
        memset(own, 0, n * sizeof *own);
    }
    take(n, none, l->x + b, batch->wx + b);
    take(n, none, l->y + b, batch->wy + b);
    take(n, none, l->z + b, batch->wz + b);
    take(n, none, l->r + b, batch->fr + b);
    take(n, none, l->g + b, batch->fg + b);
    take(n, none, l->b + b, batch->fb + b);
    weigh(n, none, l->probability + b, density);
    weigh(n, none, l->probability + b, own);
}
