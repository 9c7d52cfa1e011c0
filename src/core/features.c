/* SPDX-License-Identifier: Apache-2.0 */
#include "core/features.h"

#include <math.h>
#include <string.h>

#include "base/random.h"
#include "core/host.h"

/* Draws of a material's own sampling that stand for its albedo at one point, where it cannot tell. Unbiased over the samples of a pixel. */
#define DRAWS 4u
#define DIMENSION_ALBEDO 34u /* of bounce 0: 8 + 26 to 8 + 28 */

void mcr_features_cut(struct mcr_batch *batch, void *(*cut)(void *cutter, size_t count, size_t size), void *cutter)
{
    struct mcr_feature_slots *f = &batch->features;
    const uint32_t asked = batch->core->features;
    const size_t slots = (size_t)MCR_JOBS * MCR_JOB_SLOTS, lanes = batch->lanes;
    double **estimate[] = {&f->number[0], &f->number[1], &f->number[2], &f->delta, &f->x, &f->y, &f->z, &f->density, &f->probability,
                           &f->r, &f->g, &f->b, &f->sum[0], &f->sum[1], &f->sum[2]};
    for (int c = 0; c < 3; c++) {
        f->albedo[c] = asked & MCR_FEATURE_ALBEDO ? cut(cutter, slots, sizeof(double)) : NULL;
        f->normal[c] = asked & MCR_FEATURE_NORMAL ? cut(cutter, slots, sizeof(double)) : NULL;
        f->direct[c] = asked & MCR_FEATURE_DIRECT ? cut(cutter, slots, sizeof(double)) : NULL;
        f->indirect[c] = asked & MCR_FEATURE_DIRECT ? cut(cutter, slots, sizeof(double)) : NULL;
    }
    f->depth = asked & MCR_FEATURE_DEPTH ? cut(cutter, slots, sizeof(double)) : NULL;
    f->distance = asked & MCR_FEATURE_ID ? cut(cutter, slots, sizeof(double)) : NULL;
    f->taken = asked & MCR_FEATURE_DIRECT ? cut(cutter, slots, 1) : NULL;
    f->id = cut(cutter, slots, sizeof *f->id);
    for (size_t i = 0; i < sizeof estimate / sizeof *estimate && (asked & MCR_FEATURE_ALBEDO); i++)
        *estimate[i] = cut(cutter, lanes, sizeof(double));
}

void mcr_features_begin(struct mcr_batch *batch, size_t first, uint32_t n)
{
    struct mcr_feature_slots *f = &batch->features;
    double *zero[] = {f->albedo[0], f->albedo[1], f->albedo[2], f->normal[0], f->normal[1], f->normal[2], f->depth};
    for (size_t i = 0; i < sizeof zero / sizeof *zero; i++)
        if (zero[i])
            memset(zero[i] + first, 0, n * sizeof(double));
    memset(f->id + first, 0, n * sizeof *f->id);
    if (f->taken)
        memset(f->taken + first, 0, n);
}

/* ---- Albedo ---------------------------------------------------------------------------------------------------- */

/* What the radiance that lane i's direction brings counts for: light that comes out of matter has lost the square of its index, which is no loss of light. */
static double square_index(const struct mcr_batch *batch, const struct mcr_range *range, uint32_t i)
{
    const struct mcr_surface_points *at = &batch->at;
    const struct mcr_feature_slots *f = &batch->features;
    const uint32_t k = range->begin + i;
    double n = at->here && at->gx[k] * f->x[i] + at->gy[k] * f->y[i] + at->gz[k] * f->z[i] < 0 ? at->beyond[k] / at->here[k] : 1;
    return n * n;
}

/* Draw `d` of all points of the range: mirror-like lobe or direction, whose weight over its probability is added to f->sum. */
static int32_t add_draw(struct mcr_batch *batch, const struct mcr_range *range, uint32_t d)
{
    struct mcr_feature_slots *f = &batch->features;
    const struct mcr_group *group = &batch->core->group[range->group];
    const uint32_t n = range->end - range->begin;
    const uint64_t *key = batch->sorted.path_key + range->begin;
    struct mcr_directions out = {sizeof out, n, f->x, f->y, f->z};
    struct mcr_colours colours = {sizeof colours, n, f->r, f->g, f->b};
    const double *value[3] = {f->r, f->g, f->b};
    int32_t status = MCR_OK;
    for (uint32_t i = 0; i < n; i++) {
        uint64_t own = mcr_mix64(key[i] + (d + 1) * UINT64_C(0x9e3779b97f4a7c15));
        /* strata in what chooses among lobes, which has the largest part in the variance */
        double choice = (d + mcr_number(own, DIMENSION_ALBEDO + 2)) / DRAWS;
        f->number[0][i] = mcr_number(own, DIMENSION_ALBEDO);
        f->number[1][i] = mcr_number(own, DIMENSION_ALBEDO + 1);
        f->number[2][i] = f->delta[i] = choice;
        f->probability[i] = 1;
    }
    if (group->lobes) {
        status = mcr_group_delta(batch, range, (const double *const *)&f->delta, &out, f->probability, &colours);
        for (uint32_t i = 0; i < n && !status; i++) {
            int chosen = f->x[i] != 0 || f->y[i] != 0 || f->z[i] != 0;
            for (int c = 0; c < 3 && chosen && f->probability[i] > 0; c++)
                f->sum[c][i] += value[c][i] * square_index(batch, range, i) / f->probability[i];
            f->probability[i] = chosen ? 0 : f->probability[i];
            f->number[2][i] = mcr_number(key[i], DIMENSION_ALBEDO + 64 + d); /* lobes are chosen: the number that chose is used up */
        }
    }
    if (!status && group->spreads)
        status = mcr_group_draw(batch, range, (const double *const *)f->number, &out, f->density);
    if (!status && group->spreads)
        status = mcr_group_evaluate(batch, range, &out, &colours);
    for (uint32_t i = 0; i < n && !status && group->spreads; i++)
        for (int c = 0; c < 3 && f->density[i] > 0 && f->probability[i] > 0; c++)
            f->sum[c][i] += value[c][i] * square_index(batch, range, i) / (f->density[i] * f->probability[i]);
    return status;
}

/* Whether a material tells its albedo, and with it all inside that scatter. */
static int tells_albedo(const struct mcr_core *core, const struct mcr_group *group)
{
    for (uint32_t l = 0; l < group->layer_count; l++) {
        const struct mcr_node *node = group->layer[l].node;
        const struct mcr_material_plugin *plugin = (const struct mcr_material_plugin *)(const void *)node->descriptor;
        uint32_t does = core->scene->material[node->number].traits.does;
        int told = plugin->head.size >= offsetof(struct mcr_material_plugin, albedo) + sizeof plugin->albedo && plugin->albedo;
        if (!told && (does & (MCR_MATERIAL_REFLECTS | MCR_MATERIAL_TRANSMITS | MCR_MATERIAL_DELTA)))
            return 0;
    }
    return 1;
}

/* Albedos of the points of a range into f->sum. */
static int32_t albedos(struct mcr_batch *batch, const struct mcr_range *range)
{
    struct mcr_feature_slots *f = &batch->features;
    const struct mcr_group *group = &batch->core->group[range->group];
    const uint32_t n = range->end - range->begin;
    struct mcr_colours told = {sizeof told, n, f->sum[0], f->sum[1], f->sum[2]};
    int32_t status = group->scatters && tells_albedo(batch->core, group) ? mcr_group_albedo(batch, range, &told) : MCR_E_UNSUPPORTED;
    if (status != MCR_E_UNSUPPORTED)
        return status;
    batch->failed = NULL; /* no failure: it leaves the estimate to us */
    status = MCR_OK;
    for (int c = 0; c < 3; c++)
        memset(f->sum[c], 0, n * sizeof(double));
    for (uint32_t d = 0; d < DRAWS && group->scatters && !status; d++)
        status = add_draw(batch, range, d);
    for (int c = 0; c < 3; c++)
        for (uint32_t i = 0; i < n; i++)
            f->sum[c][i] *= 1.0 / DRAWS;
    return status;
}

/* ---- Samples --------------------------------------------------------------------------------------------------- */

static int has_first(const struct mcr_batch *batch, const struct mcr_range *range)
{
    for (uint32_t k = range->begin; k < range->end; k++)
        if (batch->sorted.bounce[k] == 0)
            return 1;
    return 0;
}

static void store(struct mcr_batch *batch, const struct mcr_range *range)
{
    struct mcr_feature_slots *f = &batch->features;
    const struct mcr_surface_points *at = &batch->at;
    const double *normal[3] = {at->nx, at->ny, at->nz}, *through[3] = {batch->sorted.r, batch->sorted.g, batch->sorted.b}, per_scale = 1 / batch->core->scene->scale;
    for (uint32_t k = range->begin; k < range->end; k++) {
        const uint32_t slot = batch->sorted.slot[k];
        if (batch->sorted.bounce[k] > 0)
            continue;
        f->id[slot] = at->material[k] + 1;
        if (f->depth)
            f->depth[slot] = batch->t[batch->order[k]] * per_scale;
        for (int c = 0; c < 3 && f->normal[0]; c++)
            f->normal[c][slot] = normal[c][k];
        for (int c = 0; c < 3 && f->albedo[0]; c++)
            f->albedo[c][slot] = f->sum[c][k - range->begin] * through[c][k]; /* with masks before it, their and its shares add up */
    }
}

int32_t mcr_features_hit(struct mcr_batch *batch)
{
    for (uint32_t r = 0; r < batch->range_count; r++) {
        const struct mcr_range *range = &batch->range[r];
        if (!has_first(batch, range))
            continue;
        int32_t status = batch->features.albedo[0] ? albedos(batch, range) : MCR_OK;
        if (status)
            return status;
        store(batch, range);
    }
    return MCR_OK;
}

void mcr_features_direct(struct mcr_batch *batch)
{
    struct mcr_feature_slots *f = &batch->features;
    if (!f->taken)
        return;
    for (uint32_t r = 0; r < batch->range_count; r++)
        for (uint32_t k = batch->range[r].begin; k < batch->range[r].end; k++) {
            const uint32_t slot = batch->sorted.slot[k];
            if (batch->sorted.bounce[k] != 1)
                continue;
            f->taken[slot] = 1;
            f->direct[0][slot] = batch->slot_r[slot];
            f->direct[1][slot] = batch->slot_g[slot];
            f->direct[2][slot] = batch->slot_b[slot];
        }
}

void mcr_features_settle(struct mcr_batch *batch, size_t first, uint32_t n)
{
    struct mcr_feature_slots *f = &batch->features;
    const double *all[3] = {batch->slot_r, batch->slot_g, batch->slot_b};
    if (!f->taken)
        return;
    for (size_t i = first; i < first + n; i++) {
        double weight = batch->slot_weight ? batch->slot_weight[i] : 1;
        int finite = isfinite(all[0][i]) && isfinite(all[1][i]) && isfinite(all[2][i]); /* or the sample counts as black */
        for (int c = 0; c < 3; c++) {
            double direct = f->taken[i] ? f->direct[c][i] : all[c][i];
            direct = batch->cap_r && direct > all[c][i] ? all[c][i] : direct; /* compat clamp: the part of what is left */
            f->direct[c][i] = finite ? direct * weight : 0;
            f->indirect[c][i] = finite ? (all[c][i] - direct) * weight : 0;
        }
    }
}

static double sum_of(const double *v, size_t slot, uint32_t count)
{
    double sum = 0;
    for (uint32_t s = 0; v && s < count; s++)
        sum += v[slot + s];
    return sum;
}

void mcr_features_cell(const struct mcr_batch *batch, size_t slot, uint32_t count, struct mcr_cell_features *cell)
{
    const struct mcr_feature_slots *f = &batch->features;
    *cell = (struct mcr_cell_features){.distance = INFINITY};
    for (int c = 0; c < 3; c++) {
        cell->albedo[c] = sum_of(f->albedo[c], slot, count);
        cell->normal[c] = sum_of(f->normal[c], slot, count);
        cell->direct[c] = sum_of(f->direct[c], slot, count);
        cell->indirect[c] = sum_of(f->indirect[c], slot, count);
    }
    cell->depth = sum_of(f->depth, slot, count);
    for (uint32_t s = 0; s < count; s++) {
        cell->hits += f->id[slot + s] > 0;
        if (!f->distance || !(f->distance[slot + s] < cell->distance))
            continue;
        cell->distance = f->distance[slot + s];
        cell->id = f->id[slot + s];
    }
}
