/* SPDX-License-Identifier: Apache-2.0 */
/* The memory of a batch: one block, cut into 64-byte aligned arrays. */
#include "core/batch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/host.h"

/* Cuts arrays from memory; with memory NULL it only counts. STAGGER keeps lane i of different arrays out of the same set of the first-level cache. */
#define STAGGER (5 * 64)

struct cutter {
    char *memory;
    size_t used;
};

static void *cut(struct cutter *c, size_t count, size_t size)
{
    void *at = c->memory ? c->memory + c->used : NULL;
    c->used += (count * size + 63) / 64 * 64 + STAGGER;
    return at;
}

static void cut_paths(struct cutter *c, struct mcr_paths *paths, uint32_t lanes, const struct mcr_core *core)
{
    paths->r = cut(c, lanes, sizeof(double));
    paths->g = cut(c, lanes, sizeof(double));
    paths->b = cut(c, lanes, sizeof(double));
    paths->pixel_key = cut(c, lanes, sizeof(uint64_t));
    paths->path_key = cut(c, lanes, sizeof(uint64_t));
    paths->index = cut(c, lanes, sizeof(uint32_t));
    paths->planned = cut(c, lanes, sizeof(uint32_t));
    paths->bounce = cut(c, lanes, sizeof(uint32_t));
    paths->slot = cut(c, lanes, sizeof(uint32_t));
    for (uint32_t i = 0; i < core->interiors; i++)
        paths->inside[i] = cut(c, lanes, sizeof(uint32_t));
    if (core->needs_pixel) {
        paths->x = cut(c, lanes, sizeof(uint32_t));
        paths->y = cut(c, lanes, sizeof(uint32_t));
    }
}

/* Footprints, surface coordinates and tangents. */
static void cut_coordinates(struct cutter *c, struct mcr_batch *b)
{
    struct mcr_surface_points *at = &b->at;
    double **array[] = {&b->state.width, &b->state.spread, &b->sorted.width, &b->sorted.spread, &at->u, &at->v, &at->width, &at->gu[0],
                        &at->gu[1], &at->gu[2], &at->gv[0], &at->gv[1], &at->gv[2]};
    double **tangent[] = {&at->tx, &at->ty, &at->tz};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        *array[i] = cut(c, b->lanes, sizeof(double));
    for (size_t i = 0; i < 3 && b->core->charts.needs & MCR_NEEDS_TANGENTS; i++)
        *tangent[i] = cut(c, b->lanes, sizeof(double));
}

/* Arrays for combining techniques. */
static void cut_light(struct cutter *c, struct mcr_light_lanes *l, uint32_t lanes)
{
    double **array[] = {&l->own, &l->others, &l->weight, &l->qx, &l->qy, &l->qz, &l->wx,  &l->wy,   &l->wz, &l->distance, &l->density, &l->sum,
                        &l->other, &l->fr,  &l->fg,     &l->fb, &l->ox, &l->oy, &l->oz,  &l->dx,   &l->dy, &l->dz,       &l->far,     &l->seen,
                        &l->px,  &l->py,    &l->pz,     &l->nx, &l->ny, &l->nz, &l->tx,  &l->ty,   &l->tz, &l->side,     &l->lr,      &l->lg,
                        &l->lb,  &l->sx,    &l->sy,     &l->sz, &l->mx, &l->my, &l->mz};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        *array[i] = cut(c, lanes, sizeof(double));
    l->emitter = cut(c, lanes, sizeof *l->emitter);
    l->hit = cut(c, lanes, sizeof *l->hit);
    l->lane = cut(c, lanes, sizeof *l->lane);
    l->material = cut(c, lanes, sizeof *l->material);
    l->of = cut(c, lanes, sizeof *l->of);
}

static void cut_elsewhere(struct cutter *c, struct mcr_batch *b)
{
    struct mcr_elsewhere *e = &b->elsewhere;
    double **array[] = {&e->u, &e->v, &e->width, &e->gu[0], &e->gu[1], &e->gu[2], &e->gv[0], &e->gv[1], &e->gv[2]};
    e->input = cut(c, (size_t)b->core->channels * b->lanes, sizeof(double));
    for (size_t i = 0; i < sizeof array / sizeof *array && b->core->charts.needs; i++)
        *array[i] = cut(c, b->lanes, sizeof(double));
    if (b->core->charts.needs)
        e->primitive = cut(c, b->lanes, sizeof *e->primitive);
}

static int has_textures(const struct mcr_core *core)
{
    return core->textured || core->charts.needs & MCR_NEEDS_NORMALS;
}

static void cut_textures(struct cutter *c, struct mcr_batch *b)
{
    struct mcr_texture_lanes *t = &b->textures;
    double **array[] = {&t->u, &t->v, &t->width, &t->r, &t->g, &t->b};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        *array[i] = cut(c, b->lanes, sizeof(double));
    t->head = cut(c, b->core->scene->material_count, sizeof *t->head);
    t->next = cut(c, b->lanes, sizeof *t->next);
    t->lane = cut(c, b->lanes, sizeof *t->lane);
    t->present = cut(c, b->lanes, sizeof *t->present);
    double **normals[] = {&t->su, &t->sv, &t->step, &t->slope[0], &t->slope[1]};
    for (size_t i = 0; i < sizeof normals / sizeof *normals && b->core->charts.needs & MCR_NEEDS_NORMALS; i++)
        *normals[i] = cut(c, b->lanes, sizeof(double));
    if (b->core->charts.needs & MCR_NEEDS_NORMALS)
        t->front = cut(c, b->lanes, sizeof *t->front);
}

/* Arrays for mirror-like lobes. */
static void cut_lobes(struct cutter *c, struct mcr_lobes *l, uint32_t lanes)
{
    double **array[] = {&l->number, &l->none, &l->x, &l->y, &l->z, &l->probability, &l->r, &l->g, &l->b};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        *array[i] = cut(c, lanes, sizeof(double));
}

/* Arrays for rays that cross surfaces. */
static void cut_crossing(struct cutter *c, struct mcr_batch *b)
{
    struct mcr_crossing_lanes *l = &b->crossing_lanes;
    double **array[] = {&l->px, &l->py, &l->pz, &l->nx, &l->ny, &l->nz, &l->ox, &l->oy, &l->oz, &l->side, &l->r, &l->g, &l->b, &l->t};
    uint32_t **whole[] = {&l->material, &l->of, &l->active, &l->asked, &l->going};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        *array[i] = cut(c, b->lanes, sizeof(double));
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        *whole[i] = cut(c, b->lanes, sizeof(uint32_t));
    l->primitive = cut(c, b->lanes, sizeof *l->primitive);
    l->hit = cut(c, b->lanes, sizeof *l->hit);
    b->crossing = cut(c, b->lanes, sizeof *b->crossing);
}

static void *cut_feature(void *cutter, size_t count, size_t size)
{
    return cut(cutter, count, size);
}

/* Arrays for point lights. */
static void cut_point(struct cutter *c, struct mcr_point_lanes *p, uint32_t lanes)
{
    double **array[] = {&p->number, &p->wx, &p->wy, &p->wz, &p->er, &p->eg, &p->eb, &p->far, &p->fr,    &p->fg,
                        &p->fb,     &p->ox, &p->oy, &p->oz, &p->dx, &p->dy, &p->dz, &p->length, &p->seen};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        *array[i] = cut(c, lanes, sizeof(double));
    p->lane = cut(c, lanes, sizeof *p->lane);
}

static void cut_all(struct cutter *c, struct mcr_batch *b)
{
    const struct mcr_core *core = b->core;
    const uint32_t groups = core->group_count, rays = core->capacity;
    struct mcr_surface_points *at = &b->at;
    double **of_rays[] = {&b->rox, &b->roy, &b->roz, &b->rdx, &b->rdy, &b->rdz, &b->t};
    double **of_points[] = {&at->px, &at->py, &at->pz,   &at->gx,    &at->gy, &at->gz, &at->ox,      &at->oy, &at->oz, &at->side,
                            &at->reach, &b->wx, &b->wy,  &b->wz,     &b->density, &b->fr, &b->fg,      &b->fb,  &b->alive};
    for (size_t i = 0; i < sizeof of_rays / sizeof *of_rays; i++)
        *of_rays[i] = cut(c, rays, sizeof(double));
    b->hit = cut(c, rays, sizeof *b->hit);
    b->source = cut(c, rays, sizeof *b->source);
    cut_paths(c, &b->state, b->lanes, core);
    cut_paths(c, &b->sorted, b->lanes, core);
    for (size_t i = 0; i < sizeof of_points / sizeof *of_points; i++)
        *of_points[i] = cut(c, b->lanes, sizeof(double));
    if (core->surfaces.smooth || core->charts.needs & MCR_NEEDS_NORMALS) {
        at->nx = cut(c, b->lanes, sizeof(double));
        at->ny = cut(c, b->lanes, sizeof(double));
        at->nz = cut(c, b->lanes, sizeof(double));
    } else {
        at->nx = at->gx;
        at->ny = at->gy;
        at->nz = at->gz;
    }
    if (core->charts.needs)
        cut_coordinates(c, b);
    at->material = cut(c, b->lanes, sizeof *at->material);
    at->primitive = cut(c, b->lanes, sizeof *at->primitive);
    b->order = cut(c, b->lanes, sizeof *b->order);
    b->range = cut(c, 2 * (size_t)groups, sizeof *b->range);
    b->zone_count = cut(c, 3 * (size_t)groups + 1, sizeof *b->zone_count);
    b->zone_list = cut(c, (3 * (size_t)groups + 1) * rays, sizeof *b->zone_list);
    for (uint32_t k = 0; k < MCR_NUMBERS_MAX; k++)
        b->number[k] = cut(c, b->lanes, sizeof(double));
    if (core->scene->render.roulette || core->lobes)
        b->material_density = cut(c, b->lanes, sizeof(double));
    b->kept = cut(c, rays, sizeof(double));
    if (core->scene->render.roulette)
        b->roulette = cut(c, b->lanes, sizeof(double));
    b->lane_input = cut(c, (size_t)core->channels * b->lanes, sizeof(double));
    b->channel = cut(c, core->channels, sizeof *b->channel);
    b->stride = cut(c, core->channels, sizeof *b->stride);
    b->slot_r = cut(c, (size_t)MCR_JOBS * MCR_JOB_SLOTS, sizeof(double));
    b->slot_g = cut(c, (size_t)MCR_JOBS * MCR_JOB_SLOTS, sizeof(double));
    b->slot_b = cut(c, (size_t)MCR_JOBS * MCR_JOB_SLOTS, sizeof(double));
    if (core->features)
        mcr_features_cut(b, cut_feature, c);
    if (core->scene->film.filter_edge)
        b->slot_weight = cut(c, (size_t)MCR_JOBS * MCR_JOB_SLOTS, sizeof(double));
    if (core->scene->render.compat & MCR_COMPAT_CLAMP) {
        b->cap_r = cut(c, (size_t)MCR_JOBS * MCR_JOB_SLOTS, sizeof(double));
        b->cap_g = cut(c, (size_t)MCR_JOBS * MCR_JOB_SLOTS, sizeof(double));
        b->cap_b = cut(c, (size_t)MCR_JOBS * MCR_JOB_SLOTS, sizeof(double));
    }
    b->job = cut(c, MCR_JOBS, sizeof *b->job);
    b->camera_x = cut(c, rays, sizeof(double));
    b->camera_y = cut(c, rays, sizeof(double));
    if (core->control >= 0)
        b->controlled = cut(c, b->lanes, sizeof(double));
    if (core->combines)
        cut_light(c, &b->light, b->lanes);
    if ((core->combines || core->crosses) && core->varying_elsewhere)
        cut_elsewhere(c, b);
    if (has_textures(core))
        cut_textures(c, b);
    if (core->crosses)
        cut_crossing(c, b);
    if (core->interiors) {
        at->here = cut(c, b->lanes, sizeof(double));
        at->beyond = cut(c, b->lanes, sizeof(double));
    }
    if (core->lobes)
        cut_lobes(c, &b->lobe, b->lanes);
    if (core->point_lights)
        cut_point(c, &b->point, b->lanes);
    b->scratch = cut(c, core->scratch_bytes, 1);
}

/* Cuts nothing yet: only counts. */
static size_t lay_out(struct mcr_batch *batch, struct mcr_core *core)
{
    struct cutter c = {NULL, 0};
    memset(batch, 0, sizeof *batch);
    batch->core = core;
    /* Points take at most the rays and a pad for each zone; camera paths fill up what the rays leave, with a pad for each job. */
    batch->lanes = 2 * core->capacity + MCR_LANE_PAD * (2 * core->group_count + MCR_JOBS + 1);
    cut_all(&c, batch);
    return c.used;
}

size_t mcr_batch_bytes(struct mcr_core *core)
{
    struct mcr_batch batch;
    return lay_out(&batch, core);
}

int mcr_batch_init(struct mcr_batch *batch, struct mcr_core *core)
{
    const size_t bytes = lay_out(batch, core);
    struct cutter c;
    batch->memory = aligned_alloc(64, bytes);
    if (!batch->memory)
        return -1;
    memset(batch->memory, 0, bytes);
    c = (struct cutter){batch->memory, 0};
    cut_all(&c, batch);
    for (uint32_t m = 0; has_textures(core) && m < core->scene->material_count; m++)
        batch->textures.head[m] = UINT32_MAX;
    batch->context.core = batch;
    batch->context.has_lights = core->scene->has_lights != 0;
    return 0;
}

void mcr_batch_fini(struct mcr_batch *batch)
{
    free(batch->memory);
    batch->memory = NULL;
}

void mcr_batch_judge(struct mcr_batch *batch, uint32_t begin, uint32_t n, const struct mcr_directions *drawn, double *density)
{
    const struct mcr_stages *stages = batch->core->stages;
    if (!stages->unsound(n, density, drawn))
        return;
    for (uint32_t i = 0; i < n; i++) {
        const struct mcr_directions one = {sizeof one, 1, drawn->x + i, drawn->y + i, drawn->z + i};
        if (!stages->unsound(1, density + i, &one))
            continue;
        uint32_t slot = batch->sorted.slot[begin + i];
        batch->slot_r[slot] = batch->slot_g[slot] = batch->slot_b[slot] = NAN;
        density[i] = 0;
    }
}
