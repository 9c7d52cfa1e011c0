/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Lights without extent (point_lights.h), over lanes: the choice among few, the shadow rays, and what arrives. Stage file, compiled once per instruction
 * set.
 */
#include <math.h>
#include <string.h>

#include "core/stages.h"

static inline double least(double a, double b)
{
    return a < b ? a : b;
}

static inline double largest(double a, double b)
{
    return a > b ? a : b;
}

/* Nothing is chosen yet. ox, oy, oz: total and last weight of the candidates, and the last one's share of its colour; far and er .. eb: its own. */
static void begin_choice(const struct mcr_point_lanes *l, uint32_t b, uint32_t n)
{
    double *const array[] = {l->wx, l->wy, l->wz, l->er, l->eg, l->eb, l->far, l->ox, l->oy, l->oz};
    for (size_t a = 0; a < sizeof array / sizeof *array; a++)
        memset(array[a] + b, 0, n * sizeof(double));
}

/*
 * One candidate takes the place of those before it with its part of the sum; the number is scaled anew each time. `kind` is constant where this is
 * inlined. Operation by operation as in point_lights.c, which does it for one point.
 */
static inline __attribute__((always_inline)) void consider(const struct mcr_batch *batch, const struct mcr_range *range, uint32_t index,
                                                                   uint32_t kind, int both)
{
    const struct mcr_scene_light *light = &batch->core->point_lights->light[index];
    const struct mcr_surface_points *at = &batch->at;
    const struct mcr_point_lanes *l = &batch->point;
    const double luminance = batch->core->point_lights->luminance[index], r = light->colour[0], g = light->colour[1], b = light->colour[2];
    const double lx = light->position[0], ly = light->position[1], lz = light->position[2], outer = light->outer, inner = light->inner;
    const double behind = both ? 1 : 0, ax = light->direction[0], ay = light->direction[1], az = light->direction[2];
    MCR_LANES
    for (uint32_t k = range->begin; k < range->end; k++) {
        double wx = ax, wy = ay, wz = az, distance = INFINITY, share = 1;
        if (kind != MCR_LIGHT_SUN) {
            double x = lx - at->px[k], y = ly - at->py[k], z = lz - at->pz[k], square = x * x + y * y + z * z;
            distance = sqrt(square);
            wx = x / distance;
            wy = y / distance;
            wz = z / distance;
            if (kind == MCR_LIGHT_SPOT) { /* 1 - cos to the axis is |-w - axis|^2 / 2, without cancellation */
                double sx = wx + ax, sy = wy + ay, sz = wz + az, v = (sx * sx + sy * sy + sz * sz) * 0.5;
                double within = (outer - v) / (outer - inner), t = v <= inner ? 1 : within;
                share = t * t * (3 - 2 * t) / square;
                share = v >= outer ? 0 : share;
            } else {
                share = 1 / square;
            }
            share = square > 0 ? share : 0;
        }
        int faces = (share > 0) & (at->gx[k] * wx + at->gy[k] * wy + at->gz[k] * wz > 0);
        double weight = least(luminance * share, MCR_MOST_ESTIMATE);
        weight = faces ? weight : weight * behind;
        double number = l->number[k], before = l->ox[k], last = l->oy[k], its = l->oz[k], far = l->far[k]; /* loaded whether they stay or not */
        double vx = l->wx[k], vy = l->wy[k], vz = l->wz[k], er = l->er[k], eg = l->eg[k], eb = l->eb[k];
        double total = before + weight, part = weight / total;
        int counts = weight > 0, taken = counts & (number < part);
        double next = number < part ? number / part : (number - part) / (1 - part);
        next = next < 1 ? next : 0x1.fffffffffffffp-1; /* rounded up */
        l->number[k] = counts ? next : number;
        l->ox[k] = counts ? total : before;
        l->oy[k] = taken ? weight : last;
        l->oz[k] = taken ? share : its;
        l->wx[k] = taken ? wx : vx;
        l->wy[k] = taken ? wy : vy;
        l->wz[k] = taken ? wz : vz;
        l->far[k] = taken ? distance : far;
        l->er[k] = taken ? r : er;
        l->eg[k] = taken ? g : eg;
        l->eb[k] = taken ? b : eb;
    }
}

void MCR_ISA_NAME(mcr_stage_point_choose)(struct mcr_batch *batch, const struct mcr_range *range, int both)
{
    const struct mcr_point_lights *all = batch->core->point_lights;
    const struct mcr_point_lanes *l = &batch->point;
    begin_choice(l, range->begin, range->end - range->begin);
    for (uint32_t i = 0; i < all->count; i++)
        if (all->light[i].kind == MCR_LIGHT_SUN)
            consider(batch, range, i, MCR_LIGHT_SUN, both);
        else if (all->light[i].kind == MCR_LIGHT_SPOT)
            consider(batch, range, i, MCR_LIGHT_SPOT, both);
        else
            consider(batch, range, i, MCR_LIGHT_POINT, both);
    MCR_LANES
    for (uint32_t k = range->begin; k < range->end; k++) {
        double total = l->ox[k], probability = l->oy[k] / total, factor = l->oz[k] / probability;
        double wx = l->wx[k], wy = l->wy[k], wz = l->wz[k], er = l->er[k] * factor, eg = l->eg[k] * factor, eb = l->eb[k] * factor;
        int is = (total > 0) & (factor > 0);
        l->wx[k] = is ? wx : 0;
        l->wy[k] = is ? wy : 0;
        l->wz[k] = is ? wz : 0;
        l->er[k] = is ? er : 0;
        l->eg[k] = is ? eg : 0;
        l->eb[k] = is ? eb : 0;
    }
}

/* Lists the points where light of the chosen one would be scattered. */
static uint32_t list_worth(const struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_point_lanes *l = &batch->point;
    const uint32_t b = range->begin, n = range->end - b;
    const double *fr = l->fr + b, *fg = l->fg + b, *fb = l->fb + b, *er = l->er + b, *eg = l->eg + b, *eb = l->eb + b;
    double *restrict flag = l->seen;
    uint32_t *restrict lane = l->lane, count = 0;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        flag[i] = (((fr[i] > 0) | (fg[i] > 0) | (fb[i] > 0)) & ((er[i] != 0) | (eg[i] != 0) | (eb[i] != 0))) ? 1.0 : 0.0;
    for (uint32_t i = 0; i < n; i++) {
        lane[count] = b + i;
        count += flag[i] != 0;
    }
    return count;
}

uint32_t MCR_ISA_NAME(mcr_stage_point_aim)(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_surface_points *at = &batch->at;
    const struct mcr_point_lanes *l = &batch->point;
    const uint32_t rays = list_worth(batch, range), *lane = l->lane;
    MCR_LANES
    for (uint32_t i = 0; i < rays; i++) {
        uint32_t k = lane[i];
        double gx = at->gx[k], gy = at->gy[k], gz = at->gz[k], wx = l->wx[k], wy = l->wy[k], wz = l->wz[k], far = l->far[k];
        double off = MCR_OFFSET * at->reach[k], leave = gx * wx + gy * wy + gz * wz < 0 ? -off : off;
        l->ox[i] = at->px[k] + leave * gx;
        l->oy[i] = at->py[k] + leave * gy;
        l->oz[i] = at->pz[k] + leave * gz;
        l->dx[i] = wx;
        l->dy[i] = wy;
        l->dz[i] = wz;
        l->length[i] = far - largest(off, MCR_OFFSET * (far < INFINITY ? far : 0));
    }
    return rays;
}

void MCR_ISA_NAME(mcr_stage_point_add)(struct mcr_batch *batch, uint32_t rays)
{
    const struct mcr_paths *paths = &batch->sorted;
    const struct mcr_point_lanes *l = &batch->point;
    const double *restrict seen = l->seen;
    uint32_t *restrict lane = l->lane, count = 0;
    for (uint32_t i = 0; i < rays; i++) { /* those that are seen move up */
        lane[count] = lane[i];
        count += seen[i] > 0;
    }
    MCR_LANES
    for (uint32_t i = 0; i < count; i++) {
        uint32_t k = lane[i];
        l->dx[i] = paths->r[k] * l->fr[k] * l->er[k];
        l->dy[i] = paths->g[k] * l->fg[k] * l->eg[k];
        l->dz[i] = paths->b[k] * l->fb[k] * l->eb[k];
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t slot = paths->slot[lane[i]];
        batch->slot_r[slot] += l->dx[i];
        batch->slot_g[slot] += l->dy[i];
        batch->slot_b[slot] += l->dz[i];
    }
}
