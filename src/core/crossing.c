/* SPDX-License-Identifier: Apache-2.0 */
#include "core/crossing.h"

#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "base/elementary.h"
#include "core/host.h"

/* Crossings of one ray at most: beyond it, the ray is lost. Far above what straight lines and closed shapes can need. */
#define MOST_CROSSINGS 65536u

#define DIMENSION_PASSES 33u /* of bounce 0: 8 + 25 */

/* ---- Tables ---------------------------------------------------------------------------------------------------- */

/*
 * As many as can be around one point: a shape bounds one, and a closed surface has four triangles or more. Two more are for rays that rounding let in,
 * but not out.
 */
static uint32_t count_interiors(const struct mcr_scene *scene)
{
    uint64_t shapes = 0, triangles = 0, all;
    for (uint32_t i = 0; i < scene->shape_count; i++)
        shapes += (scene->material[scene->shape[i].material].traits.does & MCR_MATERIAL_INTERIOR) != 0;
    for (uint32_t t = 0; t < scene->triangles.count; t++)
        triangles += (scene->material[scene->triangles.material[t]].traits.does & MCR_MATERIAL_INTERIOR) != 0;
    all = shapes + (triangles + 3) / 4;
    return all == 0 ? 0 : all + 2 < MCR_INTERIORS ? (uint32_t)all + 2 : MCR_INTERIORS;
}

int mcr_crossing_init(struct mcr_core *core, struct mcr_arena *arena)
{
    const struct mcr_scene *scene = core->scene;
    core->interiors = count_interiors(scene);
    core->crosses = core->interiors > 0;
    for (uint32_t p = 0; p < core->surfaces.count; p++) /* a material that no surface has costs nothing */
        core->crosses |= (scene->material[core->surfaces.material[p]].traits.does & MCR_MATERIAL_PASSES) != 0;
    if (!core->crosses)
        return 0;
    core->interior = mcr_arena_alloc(arena, scene->material_count, sizeof *core->interior);
    if (!core->interior)
        return -1;
    for (uint32_t m = 0; m < scene->material_count; m++) {
        const struct mcr_material_traits *traits = &scene->material[m].traits;
        struct mcr_interior *interior = &core->interior[m];
        interior->passes = (traits->does & MCR_MATERIAL_PASSES) != 0;
        interior->bounds = (traits->does & MCR_MATERIAL_INTERIOR) != 0;
        if (!interior->bounds)
            continue;
        interior->index = traits->index;
        interior->priority = traits->priority;
        for (int c = 0; c < 3; c++) {
            interior->attenuation[c] = traits->attenuation[c] / scene->scale; /* a scene length is `scale` of render space */
            interior->absorbs |= traits->attenuation[c] > 0;
        }
    }
    return 0;
}

void mcr_surface_project(const struct mcr_core *core, int64_t primitive, double q[3], double n[3])
{
    const struct mcr_surfaces *s = &core->surfaces;
    const struct mcr_surface *at = &s->surface[primitive];
    double length;
    if (s->quadric && s->quadric[primitive] != UINT32_MAX) {
        const double *m = core->accel->shape[s->quadric[primitive]].k;
        double local[3], square;
        for (int i = 0; i < 3; i++)
            local[i] = m[3 + 3 * i] * (q[0] - m[0]) + m[4 + 3 * i] * (q[1] - m[1]) + m[5 + 3 * i] * (q[2] - m[2]);
        for (int j = 0; j < 3; j++)
            n[j] = m[3 + j] * local[0] + m[6 + j] * local[1] + m[9 + j] * local[2];
        square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        length = sqrt(square);
        for (int j = 0; j < 3; j++) { /* Newton's step, as in the surface stage */
            q[j] -= (local[0] * local[0] + local[1] * local[1] + local[2] * local[2] - 1) / (2 * square) * n[j];
            n[j] /= length;
        }
    } else if (at->radius > 0) {
        const double c[3] = {at->x, at->y, at->z};
        for (int j = 0; j < 3; j++)
            n[j] = q[j] - c[j];
        length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int j = 0; j < 3; j++) {
            n[j] /= length;
            q[j] = c[j] + at->radius * n[j];
        }
    } else {
        n[0] = at->x;
        n[1] = at->y;
        n[2] = at->z;
        double off = n[0] * q[0] + n[1] * q[1] + n[2] * q[2] - at->offset;
        for (int j = 0; j < 3; j++)
            q[j] -= off * n[j];
    }
}

/* ---- Interiors ------------------------------------------------------------------------------------------------- */

/* Entries of `inside` are material + 1, 0 beyond the last. */

/* Returns 0 where there is no room for it. */
static int enter(const struct mcr_core *core, uint32_t inside[MCR_INTERIORS], uint32_t material)
{
    for (uint32_t i = 0; i < core->interiors; i++)
        if (!inside[i]) {
            inside[i] = material + 1;
            return 1;
        }
    return 0;
}

/* Around all that is there. */
static void surround(uint32_t inside[MCR_INTERIORS], uint32_t material)
{
    for (uint32_t i = MCR_INTERIORS - 1; i > 0; i--)
        inside[i] = inside[i - 1];
    inside[0] = material + 1;
}

/* The last entry of the material goes, if there is one. */
static void leave(uint32_t inside[MCR_INTERIORS], uint32_t material)
{
    uint32_t i = MCR_INTERIORS;
    while (i > 0 && inside[i - 1] != material + 1)
        i--;
    for (; i > 0 && i < MCR_INTERIORS; i++)
        inside[i - 1] = inside[i];
    if (i)
        inside[MCR_INTERIORS - 1] = 0;
}

static void cross(struct mcr_batch *batch, uint32_t inside[MCR_INTERIORS], uint32_t material, int entering)
{
    if (!batch->core->interior[material].bounds)
        return;
    if (!entering)
        leave(inside, material);
    else if (!enter(batch->core, inside, material))
        batch->overfull++;
}

/* The material whose interior counts, or -1 in the open. */
static int64_t counts(const struct mcr_core *core, const uint32_t inside[MCR_INTERIORS])
{
    int64_t best = -1;
    for (uint32_t i = 0; i < MCR_INTERIORS && inside[i]; i++)
        if (best < 0 || core->interior[inside[i] - 1].priority >= core->interior[best].priority)
            best = inside[i] - 1;
    return best;
}

/* The same without the material itself. */
static int64_t counts_without(const struct mcr_core *core, const uint32_t inside[MCR_INTERIORS], uint32_t material)
{
    uint32_t rest[MCR_INTERIORS];
    memcpy(rest, inside, sizeof rest);
    leave(rest, material);
    return counts(core, rest);
}

static double index_of(const struct mcr_core *core, int64_t material)
{
    return material < 0 ? 1.0 : core->interior[material].index;
}

/* Whether a boundary is not there, because an interior of higher priority is on both sides of it. */
static int hidden(const struct mcr_core *core, const uint32_t inside[MCR_INTERIORS], uint32_t material, int entering)
{
    if (!core->interior[material].bounds)
        return 0;
    int64_t around = entering ? counts(core, inside) : counts_without(core, inside, material);
    return around >= 0 && core->interior[around].priority > core->interior[material].priority;
}

static void absorb(const struct mcr_core *core, const uint32_t inside[MCR_INTERIORS], double distance, double factor[3])
{
    int64_t m = counts(core, inside);
    if (m < 0 || !core->interior[m].absorbs)
        return;
    for (int c = 0; c < 3; c++)
        if (core->interior[m].attenuation[c] > 0)
            factor[c] *= mcr_exp(-core->interior[m].attenuation[c] * distance);
}

static void take_inside(const struct mcr_core *core, const struct mcr_paths *paths, uint32_t lane, uint32_t inside[MCR_INTERIORS])
{
    for (uint32_t i = 0; i < MCR_INTERIORS; i++)
        inside[i] = i < core->interiors ? paths->inside[i][lane] : 0;
}

/* ---- One ray after the other, their hits together -------------------------------------------------------------- */

/* Fills the compact lanes with the surface that ray c has reached; returns its side: +1 where it comes from the front. */
static void reach_surface(const struct mcr_batch *batch, struct mcr_crossing *c)
{
    for (int j = 0; j < 3; j++)
        c->q[j] = c->o[j] + c->t * c->d[j];
    mcr_surface_project(batch->core, c->hit, c->q, c->n);
    c->side = c->n[0] * c->d[0] + c->n[1] * c->d[1] + c->n[2] * c->d[2] < 0 ? 1.0 : -1.0;
    c->material = batch->core->surfaces.material[c->hit];
}

/* What crosses at the surfaces of the rays listed, whose groups are several: `passes` of their materials goes to share[]. */
static int32_t ask_passes(struct mcr_batch *batch, const uint32_t *list, uint32_t count)
{
    const struct mcr_core *core = batch->core;
    struct mcr_crossing_lanes *l = &batch->crossing_lanes;
    for (uint32_t g = 0; g < core->group_count; g++) {
        uint32_t n = 0;
        if (!(core->scene->material[core->group[g].first].traits.does & MCR_MATERIAL_PASSES))
            continue;
        for (uint32_t i = 0; i < count; i++) {
            const struct mcr_crossing *c = &batch->crossing[list[i]];
            if (core->group_of_material[c->material] != g)
                continue;
            l->px[n] = c->q[0];
            l->py[n] = c->q[1];
            l->pz[n] = c->q[2];
            l->nx[n] = c->side * c->n[0];
            l->ny[n] = c->side * c->n[1];
            l->nz[n] = c->side * c->n[2];
            l->ox[n] = -c->d[0];
            l->oy[n] = -c->d[1];
            l->oz[n] = -c->d[2];
            l->side[n] = c->side;
            l->material[n] = c->material;
            l->primitive[n] = c->hit;
            if (batch->elsewhere.primitive) {
                batch->elsewhere.primitive[n] = c->hit;
                batch->elsewhere.width[n] = c->width + c->spread * (c->travelled + c->t);
            }
            l->of[n++] = list[i];
        }
        if (!n)
            continue;
        struct mcr_points at = {.size = sizeof at, .n = n, .px = l->px, .py = l->py, .pz = l->pz, .nx = l->nx, .ny = l->ny, .nz = l->nz,
                                .gx = l->nx, .gy = l->ny, .gz = l->nz, .ox = l->ox, .oy = l->oy, .oz = l->oz, .side = l->side};
        struct mcr_colours out = {sizeof out, n, l->r, l->g, l->b};
        int32_t status = mcr_points_passes(batch, &core->group[g], &at, l->material, &out);
        if (status)
            return status;
        for (uint32_t i = 0; i < n; i++) {
            struct mcr_crossing *c = &batch->crossing[l->of[i]];
            c->share[0] = l->r[i];
            c->share[1] = l->g[i];
            c->share[2] = l->b[i];
        }
    }
    return MCR_OK;
}

/* Whether the ray crosses the surface that lets `share` pass; weights it. */
static int decide(struct mcr_crossing *c)
{
    double chance = (c->share[0] + c->share[1] + c->share[2]) / 3, divisor;
    int crosses;
    if (!c->by_chance) {
        for (int k = 0; k < 3; k++)
            c->factor[k] *= c->share[k];
        return c->factor[0] > 0 || c->factor[1] > 0 || c->factor[2] > 0;
    }
    uint64_t key = mcr_mix64(c->key + (uint64_t)(c->crossings + 1) * UINT64_C(0x9e3779b97f4a7c15));
    crosses = mcr_number(key, DIMENSION_PASSES + UINT64_C(32) * c->bounce) < chance;
    divisor = crosses ? chance : 1 - chance;
    for (int k = 0; k < 3; k++) /* what stays is told by the material's other operations, the crossing light taken off */
        c->factor[k] *= (crosses ? c->share[k] : 1.0) / divisor;
    return crosses;
}

/*
 * A ray goes through a surface and keeps its direction. Radiance over the squared index stays what it is, as where light is refracted, for else light would
 * be made where it goes into matter by a hole and out of it by refraction.
 */
static void pass_through(struct mcr_batch *batch, struct mcr_crossing *c)
{
    const struct mcr_core *core = batch->core;
    double here = index_of(core, counts(core, c->inside)), beyond;
    cross(batch, c->inside, c->material, c->side > 0);
    beyond = index_of(core, counts(core, c->inside));
    for (int k = 0; k < 3 && here != beyond; k++)
        c->factor[k] *= here / beyond * (here / beyond);
}

/*
 * From where it is now, off the surface that it went through, to its end. A ray that kept its direction would pass its end by as much as large surfaces
 * move it aside, which is more than the little by which it ends before an emitter.
 */
static void aim(struct mcr_crossing *c)
{
    double to[3], square = 0, along = 0;
    for (int j = 0; j < 3; j++) {
        to[j] = c->end[j] - c->o[j];
        square += to[j] * to[j];
        along += to[j] * c->d[j];
    }
    c->far = along > 0 ? sqrt(square) : 0; /* 0: the surface is as good as there */
    for (int j = 0; j < 3 && along > 0; j++)
        c->d[j] = to[j] / c->far;
}

/* The next stretches of the rays listed, beyond the surfaces that they have reached. */
static void step_on(struct mcr_batch *batch, const uint32_t *list, uint32_t count)
{
    const struct mcr_core *core = batch->core;
    struct mcr_crossing_lanes *l = &batch->crossing_lanes;
    for (uint32_t i = 0; i < count; i++) {
        struct mcr_crossing *c = &batch->crossing[list[i]];
        double reach = core->surfaces.surface[c->hit].reach, advance = 0;
        for (int j = 0; j < 3; j++)
            reach = mcr_max(reach, mcr_max(fabs(c->q[j]), fabs(c->o[j])));
        pass_through(batch, c);
        for (int j = 0; j < 3; j++) {
            double to = c->q[j] - c->side * MCR_OFFSET * reach * c->n[j];
            advance += (to - c->o[j]) * c->d[j];
            c->o[j] = to;
        }
        c->travelled += advance;
        if (c->far < INFINITY)
            aim(c);
        c->crossings++;
        l->px[i] = c->o[0];
        l->py[i] = c->o[1];
        l->pz[i] = c->o[2];
        l->ox[i] = c->d[0];
        l->oy[i] = c->d[1];
        l->oz[i] = c->d[2];
    }
    struct mcr_rays rays = {count, l->px, l->py, l->pz, l->ox, l->oy, l->oz};
    core->trace->closest(core->accel, &rays, l->side, l->primitive);
    for (uint32_t i = 0; i < count; i++) {
        batch->crossing[list[i]].t = l->side[i];
        batch->crossing[list[i]].hit = l->primitive[i];
    }
}

/* Lists the rays that are to be asked whether they pass, and of those that go on at once. */
static void look_ahead(struct mcr_batch *batch, uint32_t active, uint32_t *asked, uint32_t *ask_count, uint32_t *going, uint32_t *go_count)
{
    const struct mcr_core *core = batch->core;
    *ask_count = *go_count = 0;
    for (uint32_t i = 0; i < active; i++) {
        struct mcr_crossing *c = &batch->crossing[batch->crossing_lanes.active[i]];
        absorb(core, c->inside, mcr_min(c->t, c->far), c->factor);
        if (c->hit < 0 || c->t >= c->far)
            continue;
        if (c->crossings >= MOST_CROSSINGS) {
            c->factor[0] = c->factor[1] = c->factor[2] = 0;
            continue;
        }
        reach_surface(batch, c);
        if (hidden(core, c->inside, c->material, c->side > 0))
            going[(*go_count)++] = batch->crossing_lanes.active[i];
        else if (core->interior[c->material].passes)
            asked[(*ask_count)++] = batch->crossing_lanes.active[i];
    }
}

/* Moves n rays on to where they stay, or to their ends: crossing[0 .. n-1], whose t and hit are known. */
static int32_t go_on(struct mcr_batch *batch, uint32_t n)
{
    struct mcr_crossing_lanes *l = &batch->crossing_lanes;
    uint32_t active = n;
    for (uint32_t i = 0; i < n; i++)
        l->active[i] = i;
    while (active) {
        uint32_t asked, going;
        look_ahead(batch, active, l->asked, &asked, l->going, &going);
        int32_t status = asked ? ask_passes(batch, l->asked, asked) : MCR_OK;
        if (status)
            return status;
        for (uint32_t i = 0; i < asked; i++)
            if (decide(&batch->crossing[l->asked[i]]))
                l->going[going++] = l->asked[i];
        if (going)
            step_on(batch, l->going, going);
        memcpy(l->active, l->going, going * sizeof *l->active);
        active = going;
    }
    return MCR_OK;
}

/* ---- Paths ----------------------------------------------------------------------------------------------------- */

/* Whether anything can happen to a ray between its origin and its hit, or at the hit. */
static int concerns(const struct mcr_core *core, int64_t hit, uint32_t innermost)
{
    return innermost || (hit >= 0 && core->interior[core->surfaces.material[hit]].passes);
}

int32_t mcr_crossing_paths(struct mcr_batch *batch)
{
    const struct mcr_core *core = batch->core;
    struct mcr_paths *paths = &batch->state;
    uint32_t n = 0;
    for (uint32_t j = 0; j < batch->rays; j++) {
        uint32_t lane = batch->source[j];
        if (!concerns(core, batch->hit[j], core->interiors ? paths->inside[0][lane] : 0))
            continue;
        struct mcr_crossing *c = &batch->crossing[n++];
        *c = (struct mcr_crossing){.ray = j, .o = {batch->rox[j], batch->roy[j], batch->roz[j]}, .d = {batch->rdx[j], batch->rdy[j], batch->rdz[j]},
                                   .t = batch->t[j], .hit = batch->hit[j], .far = INFINITY, .factor = {1, 1, 1}, .by_chance = 1,
                                   .key = paths->path_key[lane], .bounce = paths->bounce[lane],
                                   .width = paths->width ? paths->width[lane] : 0, .spread = paths->width ? paths->spread[lane] : 0};
        take_inside(core, paths, lane, c->inside);
    }
    int32_t status = n ? go_on(batch, n) : MCR_OK;
    for (uint32_t i = 0; i < n && !status; i++) {
        const struct mcr_crossing *c = &batch->crossing[i];
        uint32_t lane = batch->source[c->ray];
        batch->t[c->ray] = c->travelled + c->t;
        batch->hit[c->ray] = c->hit;
        paths->r[lane] *= c->factor[0];
        paths->g[lane] *= c->factor[1];
        paths->b[lane] *= c->factor[2];
        for (uint32_t e = 0; e < core->interiors; e++)
            paths->inside[e][lane] = c->inside[e];
        batch->crossings += c->crossings;
    }
    return status;
}

void mcr_crossing_begin(struct mcr_batch *batch, uint32_t from, uint32_t n)
{
    for (uint32_t i = 0; i < batch->core->interiors; i++)
        for (uint32_t k = from; k < from + n; k++)
            batch->state.inside[i][k] = batch->core->camera_inside[i];
}

void mcr_crossing_points(struct mcr_batch *batch)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_surface_points *at = &batch->at;
    for (uint32_t k = 0; k < batch->points; k++) {
        uint32_t inside[MCR_INTERIORS], m = at->material[k];
        take_inside(core, &batch->state, batch->source[batch->order[k]], inside);
        for (uint32_t i = 0; i < core->interiors; i++)
            batch->sorted.inside[i][k] = inside[i];
        int64_t around = counts(core, inside);
        at->here[k] = at->beyond[k] = index_of(core, around);
        if (!core->interior[m].bounds)
            continue;
        if (at->side[k] > 0) {
            at->beyond[k] = core->interior[m].index;
        } else {
            at->here[k] = core->interior[m].index;
            at->beyond[k] = index_of(core, counts_without(core, inside, m));
        }
    }
}

void mcr_crossing_scattered(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_surface_points *at = &batch->at;
    for (uint32_t k = range->begin; k < range->end; k++) {
        uint32_t inside[MCR_INTERIORS];
        if (at->gx[k] * batch->wx[k] + at->gy[k] * batch->wy[k] + at->gz[k] * batch->wz[k] >= 0)
            continue;
        take_inside(batch->core, &batch->sorted, k, inside);
        cross(batch, inside, at->material[k], at->side[k] > 0);
        for (uint32_t i = 0; i < batch->core->interiors; i++)
            batch->sorted.inside[i][k] = inside[i];
    }
}

/* ---- Look-ups -------------------------------------------------------------------------------------------------- */

/* The rays that anything can happen to go their ways; crossing[] holds them, *count of them. */
static int32_t follow(struct mcr_batch *batch, const struct mcr_look *look, int by_chance, const double *t, const int64_t *hit, uint32_t *count)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_surface_points *at = &batch->at;
    const struct mcr_rays *rays = &look->rays;
    uint32_t n = 0;
    for (uint32_t i = 0; i < rays->n; i++) {
        uint32_t k = look->lane[i], inside[MCR_INTERIORS];
        take_inside(core, &batch->sorted, k, inside);
        if (at->gx[k] * rays->dx[i] + at->gy[k] * rays->dy[i] + at->gz[k] * rays->dz[i] < 0)
            cross(batch, inside, at->material[k], at->side[k] > 0);
        if (!concerns(core, hit[i], inside[0]))
            continue;
        struct mcr_crossing *c = &batch->crossing[n++];
        *c = (struct mcr_crossing){.ray = i, .o = {rays->ox[i], rays->oy[i], rays->oz[i]}, .d = {rays->dx[i], rays->dy[i], rays->dz[i]}, .t = t[i],
                                   .hit = hit[i], .far = look->far[i], .factor = {1, 1, 1}, .by_chance = by_chance,
                                   .key = mcr_mix64(batch->sorted.path_key[k] ^ look->salt), .bounce = batch->sorted.bounce[k],
                                   .width = batch->sorted.width ? batch->sorted.width[k] : 0,
                                   .spread = batch->sorted.width ? batch->sorted.spread[k] : 0};
        memcpy(c->inside, inside, sizeof inside);
        for (int j = 0; j < 3; j++)
            c->end[j] = c->o[j] + c->far * c->d[j];
    }
    *count = n;
    int32_t status = n ? go_on(batch, n) : MCR_OK;
    for (uint32_t i = 0; i < n && !status; i++) {
        const struct mcr_crossing *c = &batch->crossing[i];
        look->r[look->lane[c->ray]] *= c->factor[0];
        look->g[look->lane[c->ray]] *= c->factor[1];
        look->b[look->lane[c->ray]] *= c->factor[2];
        batch->crossings += c->crossings;
    }
    return status;
}

int32_t mcr_look_visible(struct mcr_batch *batch, const struct mcr_look *look)
{
    const struct mcr_core *core = batch->core;
    struct mcr_crossing_lanes *l = &batch->crossing_lanes;
    uint32_t n;
    if (!core->crosses) {
        core->trace->visible(core->accel, &look->rays, look->far, look->seen);
        return MCR_OK;
    }
    core->trace->closest(core->accel, &look->rays, l->t, l->hit);
    for (uint32_t i = 0; i < look->rays.n; i++)
        look->seen[i] = l->t[i] >= look->far[i] ? 1.0 : 0.0;
    int32_t status;
    MCR_TIMED(MCR_STAGE_CROSSING, status = follow(batch, look, 0, l->t, l->hit, &n));
    for (uint32_t i = 0; i < n && !status; i++) {
        const struct mcr_crossing *c = &batch->crossing[i];
        look->seen[c->ray] = c->t >= c->far && (c->factor[0] > 0 || c->factor[1] > 0 || c->factor[2] > 0) ? 1.0 : 0.0;
    }
    return status;
}

int32_t mcr_look_closest(struct mcr_batch *batch, const struct mcr_look *look)
{
    const struct mcr_core *core = batch->core;
    struct mcr_crossing_lanes *l = &batch->crossing_lanes;
    uint32_t n;
    core->trace->closest(core->accel, &look->rays, look->far, look->hit);
    if (!core->crosses)
        return MCR_OK;
    memcpy(l->t, look->far, look->rays.n * sizeof *l->t);
    for (uint32_t i = 0; i < look->rays.n; i++)
        look->far[i] = INFINITY;
    int32_t status;
    MCR_TIMED(MCR_STAGE_CROSSING, status = follow(batch, look, 1, l->t, look->hit, &n));
    memcpy(look->far, l->t, look->rays.n * sizeof *l->t);
    for (uint32_t i = 0; i < n && !status; i++) {
        const struct mcr_crossing *c = &batch->crossing[i];
        look->far[c->ray] = c->travelled + c->t;
        look->hit[c->ray] = c->hit;
    }
    return status;
}

/* ---- The camera ------------------------------------------------------------------------------------------------ */

static int is_plane(const struct mcr_scene *scene, int64_t primitive)
{
    uint32_t low = 0, high = scene->shape_count; /* shapes are in the order of their primitives */
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (scene->shape[middle].primitive <= primitive)
            low = middle;
        else
            high = middle;
    }
    return low < high && scene->shape[low].primitive == primitive && scene->shape[low].kind == MCR_SHAPE_PLANE;
}

/* The camera is at the origin. Planes are judged by their sides; a ray along the view counts the other boundaries that it leaves before it enters them. */
void mcr_crossing_camera(struct mcr_core *core)
{
    const struct mcr_scene *scene = core->scene;
    double o[3] = {0, 0, 0};
    const double *d = scene->camera.forward;
    if (!core->interiors)
        return;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const struct mcr_shape *shape = &scene->shape[i];
        if (shape->kind == MCR_SHAPE_PLANE && core->interior[shape->material].bounds &&
            shape->n[0] * shape->c[0] + shape->n[1] * shape->c[1] + shape->n[2] * shape->c[2] > 0)
            surround(core->camera_inside, shape->material);
    }
    uint32_t begun[MCR_INTERIORS] = {0};
    for (uint32_t crossings = 0; crossings < MOST_CROSSINGS; crossings++) {
        _Alignas(64) double lane[7][MCR_LANE_PAD] = {{o[0]}, {o[1]}, {o[2]}, {d[0]}, {d[1]}, {d[2]}};
        _Alignas(64) int64_t hit[MCR_LANE_PAD];
        struct mcr_rays ray = {1, lane[0], lane[1], lane[2], lane[3], lane[4], lane[5]};
        double q[3], n[3], reach;
        core->trace->closest(core->accel, &ray, lane[6], hit);
        if (hit[0] < 0)
            return;
        for (int j = 0; j < 3; j++)
            q[j] = o[j] + lane[6][0] * d[j];
        mcr_surface_project(core, hit[0], q, n);
        reach = core->surfaces.surface[hit[0]].reach;
        double side = n[0] * d[0] + n[1] * d[1] + n[2] * d[2] < 0 ? 1.0 : -1.0;
        for (int j = 0; j < 3; j++)
            reach = mcr_max(reach, mcr_max(fabs(q[j]), fabs(o[j])));
        for (int j = 0; j < 3; j++)
            o[j] = q[j] - side * MCR_OFFSET * reach * n[j];
        uint32_t m = core->surfaces.material[hit[0]], before[MCR_INTERIORS];
        if (!core->interior[m].bounds || is_plane(scene, hit[0]))
            continue;
        memcpy(before, begun, sizeof before);
        if (side > 0) {
            enter(core, begun, m);
        } else {
            leave(begun, m);
            if (!memcmp(before, begun, sizeof before)) /* it was not entered on the way: the camera is inside */
                surround(core->camera_inside, m);
        }
    }
}
