/* SPDX-License-Identifier: Apache-2.0 */
#include "core/light.h"

#include <string.h>

#include "core/control.h"
#include "core/crossing.h"
#include "core/host.h"
#include "core/light_lanes.h"
#include "core/lobes.h"

/* Adds h of densities, the balance or the power heuristic's. */
static void add(const struct mcr_core *core, uint32_t n, const double *density, double *sum)
{
    core->looks->add(n, core->scene->render.mis_power, density, sum);
}

/* Adds h of a technique's density in the directions of the look-ups to `sum`, for the points of a range. */
static int32_t add_direction_density(struct mcr_batch *batch, uint32_t technique, const struct mcr_points *at, uint32_t begin,
                                     const struct mcr_directions *toward, double *sum)
{
    double *density = batch->light.other + begin;
    int32_t status = mcr_node_density(batch, batch->core->scene->sampler->directions, technique, at, toward, density);
    if (!status)
        add(batch->core, at->n, density, sum + begin);
    return status;
}

static int32_t add_emitter_density(struct mcr_batch *batch, uint32_t technique, const struct mcr_points *at, uint32_t begin,
                                   const struct mcr_emitter_points *points, double *sum)
{
    double *density = batch->light.other + begin;
    int32_t status = mcr_node_density_emitter(batch, batch->core->scene->sampler->directions, technique, at, points, density);
    if (!status)
        add(batch->core, at->n, density, sum + begin);
    return status;
}

/* `sum` becomes the sum of h over all techniques of the root but `self`; the emitter techniques only where `points` tells an emitter. */
static int32_t others(struct mcr_batch *batch, uint32_t self, const struct mcr_points *at, uint32_t begin, const struct mcr_directions *toward,
                      const struct mcr_emitter_points *points, double *sum)
{
    const struct mcr_node *node = batch->core->scene->sampler->directions;
    memset(sum + begin, 0, at->n * sizeof *sum);
    for (uint32_t t = 0; t < node->technique_count; t++) {
        int32_t status = MCR_OK;
        if (t != self && node->technique[t].kind == MCR_TECHNIQUE_DIRECTION)
            status = add_direction_density(batch, t, at, begin, toward, sum);
        else if (t != self && points)
            status = add_emitter_density(batch, t, at, begin, points, sum);
        if (status)
            return status;
    }
    return MCR_OK;
}

static struct mcr_emitter_points emitter_points(const struct mcr_light_lanes *l, uint32_t begin, uint32_t n)
{
    return (struct mcr_emitter_points){sizeof(struct mcr_emitter_points), n, l->emitter + begin, l->qx + begin, l->qy + begin, l->qz + begin,
                                       l->wx + begin, l->wy + begin, l->wz + begin, l->distance + begin};
}

/* ---- The two kinds of look-up ---------------------------------------------------------------------------------- */

/* The emitter technique's points that nothing hides; *n finds. */
static int32_t look_at_points(struct mcr_batch *batch, const struct mcr_range *range, uint32_t technique, uint32_t *n)
{
    struct mcr_light_lanes *l = &batch->light;
    const struct mcr_core *core = batch->core;
    *n = core->looks->aim(batch, range);
    struct mcr_rays rays = {*n, l->ox, l->oy, l->oz, l->dx, l->dy, l->dz};
    struct mcr_look look = {.rays = rays, .lane = l->lane, .far = l->far, .seen = l->seen, .r = l->fr, .g = l->fg, .b = l->fb};
    int32_t status = mcr_look_visible(batch, &look);
    if (status)
        return status;
    batch->shadow_rays += *n;
    if (core->control >= 0)
        core->looks->turn(batch, *n, core->control == (int32_t)technique);
    core->looks->see(batch, *n);
    return MCR_OK;
}

/* The direction technique's first hits; a miss sees the background or the sky. */
static int32_t look_along(struct mcr_batch *batch, const struct mcr_range *range, uint32_t technique, uint32_t *n)
{
    struct mcr_light_lanes *l = &batch->light;
    const struct mcr_core *core = batch->core;
    uint32_t traced, all = core->looks->leave(batch, range, &traced);
    struct mcr_rays rays = {traced, l->ox, l->oy, l->oz, l->dx, l->dy, l->dz};
    struct mcr_look look = {.rays = rays, .lane = l->lane, .salt = technique + 1, .far = l->far, .hit = l->hit, .r = l->fr, .g = l->fg, .b = l->fb};
    int32_t status = mcr_look_closest(batch, &look);
    if (status)
        return status;
    batch->shadow_rays += traced;
    *n = core->looks->find(batch, traced, all);
    if (core->control >= 0)
        core->looks->turn(batch, *n, core->control == (int32_t)technique);
    core->looks->see(batch, *n);
    return MCR_OK;
}

/* Adds what finds 0 .. n-1 see. */
static int32_t add_found(struct mcr_batch *batch, uint32_t n)
{
    const struct mcr_core *core = batch->core;
    struct mcr_light_lanes *l = &batch->light;
    if (core->background)
        core->looks->shed(batch, core->looks->sky(batch, n));
    for (uint32_t g = 0; g < core->group_count; g++) {
        uint32_t count = core->group[g].emits ? core->looks->surfaces(batch, n, g) : 0;
        if (!count)
            continue;
        struct mcr_points at = {.size = sizeof at, .n = count, .px = l->px, .py = l->py, .pz = l->pz, .nx = l->nx, .ny = l->ny, .nz = l->nz,
                                .gx = l->nx, .gy = l->ny, .gz = l->nz, .ox = l->tx, .oy = l->ty, .oz = l->tz, .side = l->side};
        struct mcr_colours out = {sizeof out, count, l->lr, l->lg, l->lb};
        int32_t status = mcr_points_emission(batch, &core->group[g], &at, l->material, &out);
        if (status)
            return status;
        core->looks->shed(batch, count);
    }
    return MCR_OK;
}

static int32_t lookup(struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_points *at, uint32_t technique, double *const *number)
{
    struct mcr_light_lanes *l = &batch->light;
    const struct mcr_core *core = batch->core;
    const struct mcr_node *node = core->scene->sampler->directions;
    const uint32_t b = range->begin, n = at->n;
    int by_point = node->technique[technique].kind == MCR_TECHNIQUE_EMITTER;
    struct mcr_emitter_points points = emitter_points(l, b, n);
    struct mcr_directions toward = {sizeof toward, n, l->wx + b, l->wy + b, l->wz + b};
    struct mcr_colours f = {sizeof f, n, l->fr + b, l->fg + b, l->fb + b};
    int32_t status = by_point ? mcr_node_draw_emitter(batch, node, technique, at, (const double *const *)number, &points, l->density + b)
                              : mcr_node_draw(batch, node, technique, at, (const double *const *)number, &toward, l->density + b);
    if (by_point)
        core->looks->clear(batch, range);
    if (!status)
        mcr_batch_judge(batch, b, n, &toward, l->density + b);
    if (!status)
        status = mcr_group_evaluate(batch, range, &toward, &f);
    if (status)
        return status;
    if (core->group[range->group].lobes)
        mcr_lobes_share(batch, range, &f);
    uint32_t found = 0;
    status = by_point ? look_at_points(batch, range, technique, &found) : look_along(batch, range, technique, &found);
    if (!status)
        status = others(batch, technique, at, b, &toward, &points, l->sum);
    return status ? status : add_found(batch, found);
}

int32_t mcr_light_lookups(struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_points *at, double *const *number)
{
    struct mcr_light_lanes *l = &batch->light;
    const struct mcr_core *core = batch->core;
    const struct mcr_node *node = core->scene->sampler->directions;
    const uint32_t b = range->begin;
    struct mcr_directions continuing = {sizeof continuing, at->n, batch->wx + b, batch->wy + b, batch->wz + b};
    int32_t status = others(batch, core->continuing, at, b, &continuing, NULL, l->others);
    if (!status && core->control >= 0)
        status = mcr_control_add(batch, range);
    memset(l->own + b, 0, at->n * sizeof *l->own);
    add(core, at->n, batch->density + b, l->own + b);
    uint32_t first = 0;
    for (uint32_t t = 0; t < node->technique_count && !status; t++) {
        if (t != core->continuing)
            status = lookup(batch, range, at, t, number + first);
        first += node->technique[t].dimensions;
    }
    return status;
}

int32_t mcr_light_weights(struct mcr_batch *batch)
{
    struct mcr_light_lanes *l = &batch->light;
    const struct mcr_core *core = batch->core;
    const struct mcr_node *node = core->scene->sampler->directions;
    core->looks->hits(batch);
    for (uint32_t r = 0; r < batch->range_count && !batch->range[r].ends; r++) {
        const struct mcr_range *range = &batch->range[r];
        struct mcr_points at = mcr_batch_points(batch, range->begin, range->end);
        struct mcr_emitter_points points = emitter_points(l, range->begin, at.n);
        batch->running = range;
        for (uint32_t t = 0; t < node->technique_count; t++) {
            int32_t status = node->technique[t].kind == MCR_TECHNIQUE_EMITTER ? add_emitter_density(batch, t, &at, range->begin, &points, l->sum) : MCR_OK;
            if (status)
                return status;
        }
        batch->running = NULL;
    }
    core->looks->weights(batch);
    if (core->control >= 0)
        core->looks->spare(batch);
    return MCR_OK;
}
