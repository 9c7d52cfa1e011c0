/* SPDX-License-Identifier: Apache-2.0 */
#include "core/compat.h"

#include <math.h>
#include <string.h>

/* The rays that stay move up. */
static void keep(struct mcr_batch *batch, uint32_t to, uint32_t from)
{
    batch->rox[to] = batch->rox[from];
    batch->roy[to] = batch->roy[from];
    batch->roz[to] = batch->roz[from];
    batch->rdx[to] = batch->rdx[from];
    batch->rdy[to] = batch->rdy[from];
    batch->rdz[to] = batch->rdz[from];
    batch->source[to] = batch->source[from];
}

/* The background for the path in lane l, with the weight of a miss: of the directions' techniques alone (light.c). */
static void see_background(struct mcr_batch *batch, uint32_t j, uint32_t l)
{
    const struct mcr_core *core = batch->core;
    double radiance[3];
    const double *own = batch->light.own, *others = batch->light.others;
    const struct mcr_paths *paths = &batch->state;
    const uint32_t slot = paths->slot[l];
    if (core->sky)
        core->sky_functions->radiance(core->sky, 1, &batch->rdx[j], &batch->rdy[j], &batch->rdz[j], &radiance[0], &radiance[1], &radiance[2]);
    else
        memcpy(radiance, core->scene->render.background, sizeof radiance);
    double share = batch->core->combines && l < batch->points ? own[l] / (own[l] + others[l]) : 1;
    batch->slot_r[slot] += paths->r[l] * radiance[0] * share;
    batch->slot_g[slot] += paths->g[l] * radiance[1] * share;
    batch->slot_b[slot] += paths->b[l] * radiance[2] * share;
}

/* Whether floor-sqrt leaves out this sample. */
static int beyond_square(uint32_t index, uint32_t planned)
{
    uint64_t side = (uint64_t)sqrt(planned);
    return index >= side * side;
}

void mcr_compat_end_rays(struct mcr_batch *batch)
{
    const struct mcr_render_settings *render = &batch->core->scene->render;
    const struct mcr_paths *paths = &batch->state;
    const int limit = (render->compat & MCR_COMPAT_BACKGROUND_AT_LIMIT) != 0, square = (render->compat & MCR_COMPAT_FLOOR_SQRT) != 0;
    uint32_t kept = 0;
    for (uint32_t j = 0; j < batch->rays; j++) {
        uint32_t l = batch->source[j];
        int black = square && paths->bounce[l] == 0 && beyond_square(paths->index[l], paths->planned[l]);
        if (!black && !(limit && paths->bounce[l] >= render->depth)) {
            keep(batch, kept++, j);
            continue;
        }
        if (!black)
            see_background(batch, j, l);
        if (paths->bounce[l])
            batch->bounce_rays--;
        else
            batch->camera_rays--;
    }
    batch->rays = kept;
}

static double least(double cap, double reach)
{
    return reach < cap ? reach : cap;
}

void mcr_compat_lower_caps(struct mcr_batch *batch)
{
    const struct mcr_paths *paths = &batch->sorted;
    for (uint32_t r = 0; r < batch->range_count; r++)
        for (uint32_t k = batch->range[r].begin; k < batch->range[r].end; k++) {
            uint32_t slot = paths->slot[k];
            batch->cap_r[slot] = least(batch->cap_r[slot], batch->slot_r[slot] + paths->r[k]);
            batch->cap_g[slot] = least(batch->cap_g[slot], batch->slot_g[slot] + paths->g[k]);
            batch->cap_b[slot] = least(batch->cap_b[slot], batch->slot_b[slot] + paths->b[k]);
        }
}

void mcr_compat_raise_caps(struct mcr_batch *batch, size_t first, uint32_t n)
{
    for (size_t i = first; i < first + n; i++)
        batch->cap_r[i] = batch->cap_g[i] = batch->cap_b[i] = INFINITY;
}

void mcr_compat_clamp(struct mcr_batch *batch, size_t first, uint32_t n)
{
    double *slot[3] = {batch->slot_r, batch->slot_g, batch->slot_b}, *cap[3] = {batch->cap_r, batch->cap_g, batch->cap_b};
    for (int c = 0; c < 3; c++)
        for (size_t i = first; i < first + n; i++)
            slot[c][i] = slot[c][i] > cap[c][i] ? cap[c][i] : slot[c][i]; /* NaN stays, and is told */
}
