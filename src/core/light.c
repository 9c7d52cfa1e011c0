/* SPDX-License-Identifier: Apache-2.0 */
#include "core/light.h"

#include <math.h>

#include "core/control.h"
#include "core/crossing.h"
#include "core/host.h"
#include "core/lobes.h"

static double heuristic(const struct mcr_core *core, double density)
{
    return core->scene->render.mis_power ? density * density : density;
}

/* Adds h of a technique's density in the directions of the look-ups to `sum`, for the points of a range. */
static int32_t add_direction_density(struct mcr_batch *batch, uint32_t technique, const struct mcr_points *at, uint32_t begin,
                                     const struct mcr_directions *toward, double *sum)
{
    double *density = batch->light.other + begin;
    int32_t status = mcr_node_density(batch, batch->core->scene->sampler->directions, technique, at, toward, density);
    for (uint32_t i = 0; i < at->n && !status; i++)
        sum[begin + i] += heuristic(batch->core, density[i]);
    return status;
}

static int32_t add_emitter_density(struct mcr_batch *batch, uint32_t technique, const struct mcr_points *at, uint32_t begin,
                                   const struct mcr_emitter_points *points, double *sum)
{
    double *density = batch->light.other + begin;
    int32_t status = mcr_node_density_emitter(batch, batch->core->scene->sampler->directions, technique, at, points, density);
    for (uint32_t i = 0; i < at->n && !status; i++)
        sum[begin + i] += heuristic(batch->core, density[i]);
    return status;
}

/* `sum` becomes the sum of h over all techniques of the root but `self`; the emitter techniques only where `points` tells an emitter. */
static int32_t others(struct mcr_batch *batch, uint32_t self, const struct mcr_points *at, uint32_t begin, const struct mcr_directions *toward,
                      const struct mcr_emitter_points *points, double *sum)
{
    const struct mcr_node *node = batch->core->scene->sampler->directions;
    for (uint32_t i = 0; i < at->n; i++)
        sum[begin + i] = 0;
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

/* ---- What a look-up sees --------------------------------------------------------------------------------------- */

/* Lane k's point on an emitter becomes compact point c. */
static void emitter_surface(struct mcr_batch *batch, uint32_t k, uint32_t c)
{
    struct mcr_light_lanes *l = &batch->light;
    double q[3] = {l->qx[k], l->qy[k], l->qz[k]}, n[3];
    mcr_surface_project(batch->core, l->primitive[k], q, n);
    double side = n[0] * l->wx[k] + n[1] * l->wy[k] + n[2] * l->wz[k] < 0 ? 1.0 : -1.0;
    l->px[c] = q[0];
    l->py[c] = q[1];
    l->pz[c] = q[2];
    l->nx[c] = side * n[0];
    l->ny[c] = side * n[1];
    l->nz[c] = side * n[2];
    l->tx[c] = -l->wx[k];
    l->ty[c] = -l->wy[k];
    l->tz[c] = -l->wz[k];
    l->side[c] = side;
    l->material[c] = batch->core->surfaces.material[l->primitive[k]];
    l->of[c] = k;
    if (batch->elsewhere.primitive) {
        batch->elsewhere.primitive[c] = l->primitive[k];
        batch->elsewhere.width[c] = batch->sorted.width[k] + batch->sorted.spread[k] * l->distance[k];
    }
}

/* Adds the weighted light that the lanes of one group see: throughput * f * Le * h(p) / (h(p) + others) / p. */
static int32_t add_group(struct mcr_batch *batch, uint32_t g, uint32_t count)
{
    struct mcr_light_lanes *l = &batch->light;
    const struct mcr_paths *paths = &batch->sorted;
    struct mcr_points at = {.size = sizeof at, .n = count, .px = l->px, .py = l->py, .pz = l->pz, .nx = l->nx, .ny = l->ny, .nz = l->nz, .gx = l->nx,
                            .gy = l->ny, .gz = l->nz, .ox = l->tx, .oy = l->ty, .oz = l->tz, .side = l->side};
    struct mcr_colours out = {sizeof out, count, l->lr, l->lg, l->lb};
    int32_t status = mcr_points_emission(batch, &batch->core->group[g], &at, l->material, &out);
    for (uint32_t c = 0; c < count && !status; c++) {
        uint32_t k = l->of[c], slot = paths->slot[k];
        double h = heuristic(batch->core, l->density[k]);
        double weight = h / ((h + l->sum[k]) * l->density[k]);
        weight = mcr_control_holds(batch, k, l->emitter[k]) ? -1 / l->density[k] : weight; /* hidden, see turn_hidden */
        batch->slot_r[slot] += paths->r[k] * l->fr[k] * l->lr[c] * weight;
        batch->slot_g[slot] += paths->g[k] * l->fg[k] * l->lg[c] * weight;
        batch->slot_b[slot] += paths->b[k] * l->fb[k] * l->lb[c] * weight;
    }
    return status;
}

/* Everything that the look-ups of a range have found: primitive[k] >= 0 where there is something. */
static int32_t add_found(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_core *core = batch->core;
    struct mcr_light_lanes *l = &batch->light;
    for (uint32_t g = 0; g < core->group_count; g++) {
        uint32_t count = 0;
        if (!core->group[g].emits)
            continue;
        for (uint32_t k = range->begin; k < range->end; k++)
            if (l->primitive[k] >= 0 && core->group_of_material[core->surfaces.material[l->primitive[k]]] == g)
                emitter_surface(batch, k, count++);
        int32_t status = count ? add_group(batch, g, count) : MCR_OK;
        if (status)
            return status;
    }
    return MCR_OK;
}

/* ---- The two kinds of look-up ---------------------------------------------------------------------------------- */

static int worth_tracing(const struct mcr_light_lanes *l, uint32_t k)
{
    return l->density[k] > 0 && (l->fr[k] > 0 || l->fg[k] > 0 || l->fb[k] > 0);
}

/* Whether the scattering event of lane k is the last one, behind which compat background-at-limit sees the background. */
static int at_limit(const struct mcr_batch *batch, uint32_t k)
{
    const struct mcr_render_settings *render = &batch->core->scene->render;
    return (render->compat & MCR_COMPAT_BACKGROUND_AT_LIMIT) && batch->sorted.bounce[k] + 1 >= render->depth;
}

/* Where a ray leaves the surface point of lane k in the look-up's direction. */
static void leave_point(const struct mcr_batch *batch, uint32_t k, double o[3])
{
    const struct mcr_surface_points *at = &batch->at;
    const struct mcr_light_lanes *l = &batch->light;
    double g[3] = {at->gx[k], at->gy[k], at->gz[k]}, off = MCR_OFFSET * at->reach[k];
    off = g[0] * l->wx[k] + g[1] * l->wy[k] + g[2] * l->wz[k] < 0 ? -off : off;
    o[0] = at->px[k] + off * g[0];
    o[1] = at->py[k] + off * g[1];
    o[2] = at->pz[k] + off * g[2];
}

/* The emitter technique's points that nothing hides. A ray ends as far before the emitter's surface as it starts off its own. */
static int32_t keep_visible(struct mcr_batch *batch, const struct mcr_range *range)
{
    struct mcr_light_lanes *l = &batch->light;
    const struct mcr_core *core = batch->core;
    uint32_t rays = 0;
    for (uint32_t k = range->begin; k < range->end; k++) {
        l->primitive[k] = -1;
        if (l->emitter[k] < 0 || !worth_tracing(l, k) || at_limit(batch, k))
            continue;
        if (l->emitter[k] == core->sky_emitter) {
            double o[3];
            leave_point(batch, k, o);
            l->ox[rays] = o[0];
            l->oy[rays] = o[1];
            l->oz[rays] = o[2];
            l->dx[rays] = l->wx[k];
            l->dy[rays] = l->wy[k];
            l->dz[rays] = l->wz[k];
            l->far[rays] = INFINITY;
            l->lane[rays++] = k;
            continue;
        }
        uint32_t primitive = core->emitters->emitter[l->emitter[k]].primitive;
        double o[3], n[3], q[3] = {l->qx[k], l->qy[k], l->qz[k]}, d[3], square = 0, reach = core->surfaces.reach[primitive];
        leave_point(batch, k, o);
        mcr_surface_project(core, primitive, q, n);
        for (int j = 0; j < 3; j++)
            reach = fabs(q[j]) > reach ? fabs(q[j]) : reach;
        reach = batch->at.reach[k] > reach ? batch->at.reach[k] : reach;
        double off = n[0] * l->wx[k] + n[1] * l->wy[k] + n[2] * l->wz[k] < 0 ? MCR_OFFSET * reach : -MCR_OFFSET * reach;
        for (int j = 0; j < 3; j++) {
            d[j] = q[j] + off * n[j] - o[j];
            square += d[j] * d[j];
        }
        double length = sqrt(square);
        l->ox[rays] = o[0];
        l->oy[rays] = o[1];
        l->oz[rays] = o[2];
        l->dx[rays] = d[0] / length;
        l->dy[rays] = d[1] / length;
        l->dz[rays] = d[2] / length;
        l->far[rays] = length;
        l->lane[rays++] = k;
    }
    struct mcr_rays all = {rays, l->ox, l->oy, l->oz, l->dx, l->dy, l->dz};
    struct mcr_look look = {.rays = all, .lane = l->lane, .far = l->far, .seen = l->seen, .r = l->fr, .g = l->fg, .b = l->fb};
    int32_t status = mcr_look_visible(batch, &look);
    for (uint32_t i = 0; i < rays && !status; i++) {
        int32_t emitter = l->emitter[l->lane[i]];
        if (l->seen[i] > 0)
            l->primitive[l->lane[i]] = emitter == core->sky_emitter ? -2 : (int64_t)core->emitters->emitter[emitter].primitive;
    }
    batch->shadow_rays += rays;
    return status;
}

/* The direction technique's first hits; a miss sees the background or the sky. */
static int32_t trace_directions(struct mcr_batch *batch, const struct mcr_range *range, uint32_t technique)
{
    struct mcr_light_lanes *l = &batch->light;
    const struct mcr_core *core = batch->core;
    uint32_t rays = 0;
    for (uint32_t k = range->begin; k < range->end; k++) {
        double o[3];
        l->primitive[k] = -1;
        l->emitter[k] = -1;
        if (!worth_tracing(l, k))
            continue;
        if (at_limit(batch, k)) {
            l->primitive[k] = -2; /* the background */
            continue;
        }
        leave_point(batch, k, o);
        l->ox[rays] = o[0];
        l->oy[rays] = o[1];
        l->oz[rays] = o[2];
        l->dx[rays] = l->wx[k];
        l->dy[rays] = l->wy[k];
        l->dz[rays] = l->wz[k];
        l->lane[rays++] = k;
    }
    struct mcr_rays all = {rays, l->ox, l->oy, l->oz, l->dx, l->dy, l->dz};
    struct mcr_look look = {.rays = all, .lane = l->lane, .salt = technique + 1, .far = l->far, .hit = l->hit, .r = l->fr, .g = l->fg, .b = l->fb};
    int32_t status = mcr_look_closest(batch, &look);
    for (uint32_t i = 0; i < rays && !status; i++) {
        uint32_t k = l->lane[i];
        l->primitive[k] = l->hit[i] >= 0 ? l->hit[i] : -2; /* -2: the background */
        l->emitter[k] = l->hit[i] >= 0 ? core->emitters->of_primitive[l->hit[i]] : core->sky_emitter;
        l->distance[k] = l->far[i];
        l->qx[k] = l->ox[i] + l->far[i] * l->dx[i];
        l->qy[k] = l->oy[i] + l->far[i] * l->dy[i];
        l->qz[k] = l->oz[i] + l->far[i] * l->dz[i];
    }
    batch->shadow_rays += rays;
    return status;
}

static void add_background(struct mcr_batch *batch, const struct mcr_range *range)
{
    struct mcr_light_lanes *l = &batch->light;
    const struct mcr_paths *paths = &batch->sorted;
    const struct mcr_core *core = batch->core;
    const uint32_t b = range->begin;
    if (!core->background)
        return;
    if (core->sky) /* lr .. lb are free: points on emitters come later */
        core->sky_functions->radiance(core->sky, range->end - b, l->wx + b, l->wy + b, l->wz + b, l->lr, l->lg, l->lb);
    for (uint32_t k = b; k < range->end; k++) {
        if (l->primitive[k] != -2)
            continue;
        const double *constant = core->scene->render.background;
        double red = core->sky ? l->lr[k - b] : constant[0], green = core->sky ? l->lg[k - b] : constant[1];
        double blue = core->sky ? l->lb[k - b] : constant[2];
        double h = heuristic(core, l->density[k]), weight = h / ((h + l->sum[k]) * l->density[k]);
        batch->slot_r[paths->slot[k]] += paths->r[k] * l->fr[k] * red * weight;
        batch->slot_g[paths->slot[k]] += paths->g[k] * l->fg[k] * green * weight;
        batch->slot_b[paths->slot[k]] += paths->b[k] * l->fb[k] * blue * weight;
    }
}

/* Of controlled light, the points that are hidden count, and no others: what keep_visible has told is turned round. */
static void turn_hidden(struct mcr_batch *batch, const struct mcr_range *range)
{
    struct mcr_light_lanes *l = &batch->light;
    for (uint32_t k = range->begin; k < range->end; k++)
        if (l->emitter[k] >= 0 && worth_tracing(l, k) && !at_limit(batch, k) && mcr_control_holds(batch, k, l->emitter[k]))
            l->primitive[k] = l->primitive[k] < 0 ? (int64_t)batch->core->emitters->emitter[l->emitter[k]].primitive : -1;
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
    for (uint32_t k = b; by_point && k < range->end; k++) /* nothing drawn: a direction that everybody knows how to leave out */
        if (l->emitter[k] < 0)
            l->wx[k] = l->wy[k] = l->wz[k] = l->density[k] = 0;
    if (!status)
        status = mcr_group_evaluate(batch, range, &toward, &f);
    if (status)
        return status;
    if (core->group[range->group].lobes)
        mcr_lobes_share(batch, range, &f);
    status = by_point ? keep_visible(batch, range) : trace_directions(batch, range, technique);
    if (!status && core->control == (int32_t)technique)
        turn_hidden(batch, range);
    if (!status)
        status = others(batch, technique, at, b, &toward, &points, l->sum);
    if (status)
        return status;
    add_background(batch, range);
    return add_found(batch, range);
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
    for (uint32_t k = b; k < range->end; k++)
        l->own[k] = heuristic(core, batch->density[k]);
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
    for (uint32_t k = 0; k < batch->points; k++) {
        l->emitter[k] = -1;
        l->sum[k] = l->others[k];
    }
    for (uint32_t j = 0; j < batch->rays; j++) {
        uint32_t k = batch->source[j];
        if (k >= batch->points || (batch->hit[j] < 0 && core->sky_emitter < 0))
            continue;
        l->emitter[k] = batch->hit[j] < 0 ? core->sky_emitter : core->emitters->of_primitive[batch->hit[j]];
        l->distance[k] = batch->t[j];
        l->qx[k] = batch->rox[j] + batch->t[j] * batch->rdx[j];
        l->qy[k] = batch->roy[j] + batch->t[j] * batch->rdy[j];
        l->qz[k] = batch->roz[j] + batch->t[j] * batch->rdz[j];
        l->wx[k] = batch->rdx[j];
        l->wy[k] = batch->rdy[j];
        l->wz[k] = batch->rdz[j];
    }
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
    /* Camera rays come from beyond the points; what is found along a mirror-like lobe no technique could have drawn. */
    for (uint32_t j = 0; j < batch->rays; j++) {
        uint32_t k = batch->source[j];
        int drawn = k < batch->points && !(core->lobes && batch->lobe.none[k] == 0);
        l->weight[j] = !drawn ? 1 : mcr_control_holds(batch, k, l->emitter[k]) ? 0 : l->own[k] / (l->own[k] + l->sum[k]);
    }
    return MCR_OK;
}
