/* SPDX-License-Identifier: Apache-2.0 */
#include "core/lobes.h"

#include "core/host.h"

int32_t mcr_lobes_choose(struct mcr_batch *batch, const struct mcr_range *range)
{
    struct mcr_lobes *l = &batch->lobe;
    const uint32_t b = range->begin, n = range->end - b;
    struct mcr_directions out = {sizeof out, n, l->x + b, l->y + b, l->z + b};
    struct mcr_colours weight = {sizeof weight, n, l->r + b, l->g + b, l->b + b};
    double *number = l->number + b;
    int32_t status = mcr_numbers(batch, &batch->sorted, b, range->end, MCR_DIMENSION_MATERIAL, MCR_DELTA_DIMENSIONS, &number);
    if (!status)
        status = mcr_group_delta(batch, range, (const double *const *)&number, &out, l->probability + b, &weight);
    for (uint32_t k = b; k < range->end && !status; k++)
        l->none[k] = ((l->x[k] == 0) & (l->y[k] == 0) & (l->z[k] == 0)) ? 1.0 : 0.0;
    return status;
}

void mcr_lobes_none(struct mcr_batch *batch, const struct mcr_range *range)
{
    for (uint32_t k = range->begin; k < range->end; k++)
        batch->lobe.none[k] = 1;
}

void mcr_lobes_share(const struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_colours *f)
{
    const double *none = batch->lobe.none + range->begin, *probability = batch->lobe.probability + range->begin;
    for (uint32_t i = 0; i < range->end - range->begin; i++) {
        double share = none[i] > 0 && probability[i] > 0 ? 1 / probability[i] : 0;
        f->r[i] *= share;
        f->g[i] *= share;
        f->b[i] *= share;
    }
}
