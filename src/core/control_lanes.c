/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Unoccluded light in closed form (control.h), over lanes. The general forms, for emitters that the horizon cuts, are closed_form.h's; here is what they
 * come to where all of an emitter is above the horizon, operation by operation. Stage file, compiled once per instruction set.
 */
#include <math.h>
#include <string.h>

#include "base/elementary.h"
#include "core/closed_form.h"
#include "core/control.h"
#include "core/light_lanes.h"

/* Whether the light of an emitter of that area (negative: of no such emitter) at c is in its closed form at the point p. */
static inline int holds(double controlled, double area, double cx, double cy, double cz, double px, double py, double pz)
{
    double x = cx - px, y = cy - py, z = cz - pz;
    return (controlled > 0) & (area >= MCR_CONTROL_LEAST * (x * x + y * y + z * z));
}

/* The points of a range, from 0, and what is found out about them. Arrays are those of a look-up, which comes later. */
struct lanes {
    uint32_t n;
    const double *px, *py, *pz, *nx, *ny, *nz, *controlled;
    double *whole, *cut;    /* flags: all of an emitter is above the horizon, or some of it */
    double *share;          /* of an emitter: the integral of the cosine */
    double *r, *g, *b;      /* sums of radiance times share */
    uint32_t *list;
    double *lpx, *lpy, *lpz, *lnx, *lny, *lnz, *sum; /* of those listed */
};

/* ---- Flat emitters ------------------------------------------------------------------------------------------------ */

/* Flags the lanes to which an emitter shows a bright side; sides are judged as where points are drawn. */
static inline __attribute__((always_inline)) void flag_flat(const struct lanes *l, const double *k, double area, const double v[4][3], int corners)
{
    const double above = k[MCR_K_ABOVE], below = k[MCR_K_BELOW], cx = k[MCR_K_C], cy = k[MCR_K_C + 1], cz = k[MCR_K_C + 2];
    const double ex = k[MCR_K_N], ey = k[MCR_K_N + 1], ez = k[MCR_K_N + 2];
    const double v1x = v[1][0], v1y = v[1][1], v1z = v[1][2], v2x = v[2][0], v2y = v[2][1], v2z = v[2][2], v3x = v[3][0], v3y = v[3][1], v3z = v[3][2];
    const uint32_t count = l->n;
    MCR_LANES
    for (uint32_t i = 0; i < count; i++) {
        double px = l->px[i], py = l->py[i], pz = l->pz[i], nx = l->nx[i], ny = l->ny[i], nz = l->nz[i];
        double height = ex * (px - cx) + ey * (py - cy) + ez * (pz - cz);
        int bright = holds(l->controlled[i], area, cx, cy, cz, px, py, pz) & ((height > above) | (height < below));
        int h0 = (cx - px) * nx + (cy - py) * ny + (cz - pz) * nz > 0, h1 = (v1x - px) * nx + (v1y - py) * ny + (v1z - pz) * nz > 0;
        int h2 = (v2x - px) * nx + (v2y - py) * ny + (v2z - pz) * nz > 0;
        int h3 = corners == 4 ? (v3x - px) * nx + (v3y - py) * ny + (v3z - pz) * nz > 0 : h2;
        l->whole[i] = (bright & h0 & h1 & h2 & h3) ? 1.0 : 0.0;
        l->cut[i] = (bright & (h0 | h1 | h2 | h3)) ? 1.0 : 0.0;
        l->share[i] = 0;
    }
}

/* Takes those points together of which all of the emitter is seen. */
static uint32_t pack_whole(const struct lanes *l)
{
    const double *restrict whole = l->whole;
    uint32_t *restrict list = l->list, count = 0;
    for (uint32_t i = 0; i < l->n; i++) {
        list[count] = i;
        count += whole[i] != 0;
    }
    MCR_LANES
    for (uint32_t c = 0; c < count; c++) {
        uint32_t i = list[c];
        l->lpx[c] = l->px[i];
        l->lpy[c] = l->py[i];
        l->lpz[c] = l->pz[i];
        l->lnx[c] = l->nx[i];
        l->lny[c] = l->ny[i];
        l->lnz[c] = l->nz[i];
        l->sum[c] = 0;
    }
    return count;
}

/* An edge's angle, and how far its plane leans from the horizon: a term of Lambert's formula. */
static void add_edge(const struct lanes *l, uint32_t count, const double a[3], const double b[3])
{
    const double a0 = a[0], a1 = a[1], a2 = a[2], b0 = b[0], b1 = b[1], b2 = b[2];
    MCR_LANES
    for (uint32_t c = 0; c < count; c++) {
        double ax = a0 - l->lpx[c], ay = a1 - l->lpy[c], az = a2 - l->lpz[c];
        double bx = b0 - l->lpx[c], by = b1 - l->lpy[c], bz = b2 - l->lpz[c];
        double x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
        double length = sqrt(x * x + y * y + z * z), sum = l->sum[c];
        double term = mcr_atan2(length, ax * bx + ay * by + az * bz) * (x * l->lnx[c] + y * l->lny[c] + z * l->lnz[c]) / length;
        l->sum[c] = length > 0 ? sum + term : sum;
    }
}

static void share_flat(const struct lanes *l, const double *k, double area, uint32_t corners)
{
    double v[4][3];
    for (int j = 0; j < 3; j++) {
        double c = k[MCR_K_C + j], a = k[MCR_K_E0 + j], b = k[MCR_K_E1 + j];
        v[0][j] = c;
        v[1][j] = c + a;
        v[2][j] = corners == 3 ? c + b : c + a + b;
        v[3][j] = c + b;
    }
    if (corners == 3)
        flag_flat(l, k, area, v, 3);
    else
        flag_flat(l, k, area, v, 4);
    uint32_t count = pack_whole(l);
    for (uint32_t j = 0; j < corners; j++)
        add_edge(l, count, v[j], v[(j + 1) % corners]);
    for (uint32_t c = 0; c < count; c++)
        l->share[l->list[c]] = 0.5 * fabs(l->sum[c]);
    for (uint32_t i = 0; i < l->n; i++)
        if (l->cut[i] > l->whole[i])
            l->share[i] = mcr_polygon_cosine(v, corners, (double[3]){l->px[i], l->py[i], l->pz[i]}, (double[3]){l->nx[i], l->ny[i], l->nz[i]});
}

/* ---- Spheres ------------------------------------------------------------------------------------------------------ */

static void share_sphere(const struct lanes *l, const double *k, double area)
{
    const double cx = k[MCR_K_C], cy = k[MCR_K_C + 1], cz = k[MCR_K_C + 2], radius = k[MCR_K_RADIUS], square = k[MCR_K_SQUARE];
    const double above = k[MCR_K_ABOVE], below = k[MCR_K_BELOW];
    const uint32_t count = l->n;
    MCR_LANES
    for (uint32_t i = 0; i < count; i++) {
        double px = l->px[i], py = l->py[i], pz = l->pz[i], x = cx - px, y = cy - py, z = cz - pz, all = x * x + y * y + z * z;
        double distance = sqrt(all), height = x * l->nx[i] + y * l->ny[i] + z * l->nz[i], ratio = radius / distance, off = all - square;
        int known = holds(l->controlled[i], area, cx, cy, cz, px, py, pz), outside = known & (off >= 0) & (off > above) & (distance > radius);
        double seen = MCR_PI * ratio * ratio * (height / distance), around = (known & (off < 0) & (off < below)) ? MCR_PI : 0;
        l->share[i] = (outside & (height >= radius)) ? seen : around;
        l->cut[i] = (outside & (height < radius) & (height > -radius)) ? 1.0 : 0.0;
    }
    for (uint32_t i = 0; i < count; i++)
        if (l->cut[i] > 0)
            l->share[i] = mcr_sphere_cosine(k + MCR_K_C, radius, (double[3]){l->px[i], l->py[i], l->pz[i]}, (double[3]){l->nx[i], l->ny[i], l->nz[i]});
}

/* ---- All of them -------------------------------------------------------------------------------------------------- */

/* Points whose shading normal is the geometric one, bit by bit. */
static void flag_controlled(const struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_surface_points *at = &batch->at;
    double *controlled = batch->controlled;
    MCR_LANES
    for (uint32_t k = range->begin; k < range->end; k++)
        controlled[k] = ((at->nx[k] == at->gx[k]) & (at->ny[k] == at->gy[k]) & (at->nz[k] == at->gz[k])) ? 1.0 : 0.0;
}

static void add_share(const struct lanes *l, const double radiance[3])
{
    const double r = radiance[0], g = radiance[1], b = radiance[2];
    const uint32_t count = l->n;
    MCR_LANES
    for (uint32_t i = 0; i < count; i++) {
        double share = l->share[i];
        l->r[i] += r * share;
        l->g[i] += g * share;
        l->b[i] += b * share;
    }
}

void MCR_ISA_NAME(mcr_light_control)(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_surface_points *at = &batch->at;
    const struct mcr_light_lanes *w = &batch->light;
    const struct mcr_paths *paths = &batch->sorted;
    const uint32_t b = range->begin, n = range->end - b;
    struct lanes l = {.n = n, .px = at->px + b, .py = at->py + b, .pz = at->pz + b, .nx = at->nx + b, .ny = at->ny + b, .nz = at->nz + b,
                      .controlled = batch->controlled + b, .whole = w->seen, .cut = w->far, .share = w->side, .r = w->lr, .g = w->lg, .b = w->lb,
                      .list = w->of, .lpx = w->px, .lpy = w->py, .lpz = w->pz, .lnx = w->nx, .lny = w->ny, .lnz = w->nz, .sum = w->tx};
    flag_controlled(batch, range);
    memset(l.r, 0, n * sizeof *l.r);
    memset(l.g, 0, n * sizeof *l.g);
    memset(l.b, 0, n * sizeof *l.b);
    for (uint32_t e = 0; e < core->emitters->count; e++) {
        const struct mcr_emitter *emitter = &core->emitters->emitter[e];
        const double *k = core->emitters->k[e], area = core->controllable[e][3];
        if (area < 0)
            continue;
        if (emitter->kind == MCR_EMITTER_SPHERE)
            share_sphere(&l, k, area);
        else
            share_flat(&l, k, area, emitter->kind == MCR_EMITTER_TRIANGLE ? 3 : 4);
        add_share(&l, core->scene->material[emitter->material].traits.radiance);
    }
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = b + i, slot = paths->slot[k];
        batch->slot_r[slot] += paths->r[k] * w->fr[k] * l.r[i];
        batch->slot_g[slot] += paths->g[k] * w->fg[k] * l.g[i];
        batch->slot_b[slot] += paths->b[k] * w->fb[k] * l.b[i];
    }
}

/* The emitter known at point k, or the one that is none: the sky as well. */
static inline uint32_t emitter_of(const struct mcr_batch *batch, uint32_t k)
{
    const uint32_t e = (uint32_t)batch->light.emitter[k], count = batch->core->emitters->count;
    return e < count ? e : count;
}

static inline int held(const struct mcr_batch *batch, uint32_t k, uint32_t e)
{
    const double(*c)[4] = (const double(*)[4])batch->core->controllable;
    return holds(batch->controlled[k], c[e][3], c[e][0], c[e][1], c[e][2], batch->at.px[k], batch->at.py[k], batch->at.pz[k]);
}

void MCR_ISA_NAME(mcr_light_turn)(struct mcr_batch *batch, uint32_t n, int own)
{
    const struct mcr_light_lanes *l = &batch->light;
    const uint32_t *restrict lane = l->lane;
    uint32_t *restrict emitter = l->of;
    const double hidden = own ? -1 : 0;
    for (uint32_t i = 0; i < n; i++)
        emitter[i] = emitter_of(batch, lane[i]);
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double seen = l->seen[i], turned = seen == 0 ? hidden : 0;
        l->seen[i] = held(batch, lane[i], emitter[i]) ? turned : seen;
    }
}

void MCR_ISA_NAME(mcr_light_spare)(struct mcr_batch *batch)
{
    const struct mcr_light_lanes *l = &batch->light;
    const uint32_t points = batch->points, rays = batch->rays, *source = batch->source;
    const double *none = batch->core->lobes ? batch->lobe.none : NULL;
    for (uint32_t j = 0; j < rays; j++) {
        uint32_t k = source[j];
        if (k < points && l->emitter[k] >= 0 && !(none && none[k] == 0) && held(batch, k, emitter_of(batch, k)))
            l->weight[j] = 0;
    }
}
