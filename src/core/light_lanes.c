/* SPDX-License-Identifier: Apache-2.0 */
/* Look-ups for light, over lanes: see light_lanes.h. Stage file, compiled once per instruction set. */
#include "core/light_lanes.h"

#include <math.h>
#include <string.h>

#include "core/crossing.h"

static inline double largest(double a, double b)
{
    return a > b ? a : b;
}

static void add(uint32_t n, int power, const double *restrict density, double *restrict sum)
{
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        sum[i] += power ? density[i] * density[i] : density[i];
}

static void clear(struct mcr_batch *batch, const struct mcr_range *range)
{
    struct mcr_light_lanes *l = &batch->light;
    const int32_t *emitter = l->emitter;
    MCR_LANES
    for (uint32_t k = range->begin; k < range->end; k++) {
        int none = emitter[k] < 0;
        l->wx[k] = none ? 0 : l->wx[k];
        l->wy[k] = none ? 0 : l->wy[k];
        l->wz[k] = none ? 0 : l->wz[k];
        l->density[k] = none ? 0 : l->density[k];
    }
}

/* ---- Which points look, and where their rays begin --------------------------------------------------------------- */

/* flag[i] of the range's points: whether a direction was drawn and light from there is scattered. */
static void flag_worth(const struct mcr_batch *batch, const struct mcr_range *range, double *restrict flag)
{
    const struct mcr_light_lanes *l = &batch->light;
    const uint32_t b = range->begin, n = range->end - b;
    const double *density = l->density + b, *r = l->fr + b, *g = l->fg + b, *blue = l->fb + b;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        flag[i] = ((density[i] > 0) & ((r[i] > 0) | (g[i] > 0) | (blue[i] > 0))) ? 1.0 : 0.0;
}

/* Whether scattering events may be the last ones, behind which compat background-at-limit sees nothing but the background. */
static int has_limit(const struct mcr_batch *batch)
{
    return (batch->core->scene->render.compat & MCR_COMPAT_BACKGROUND_AT_LIMIT) != 0;
}

/* Lists the flagged lanes, at the limit or not; returns how many. Without branches: which they are is not to be foreseen. */
static uint32_t list_lanes(const struct mcr_batch *batch, const struct mcr_range *range, const double *restrict flag, int at_limit, uint32_t *restrict list)
{
    const uint32_t b = range->begin, n = range->end - b, depth = batch->core->scene->render.depth, *bounce = batch->sorted.bounce + b;
    uint32_t count = 0;
    if (!has_limit(batch)) {
        for (uint32_t i = 0; i < n && !at_limit; i++) {
            list[count] = b + i;
            count += flag[i] != 0;
        }
        return count;
    }
    for (uint32_t i = 0; i < n; i++) {
        list[count] = b + i;
        count += (flag[i] != 0) & ((bounce[i] + 1 >= depth) == at_limit);
    }
    return count;
}

/* The rays' origins, each off its surface on the side of the look-up's direction (MCR_OFFSET). */
static void leave_points(const struct mcr_batch *batch, uint32_t n)
{
    const struct mcr_surface_points *at = &batch->at;
    const struct mcr_light_lanes *l = &batch->light;
    const uint32_t *lane = l->lane;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = lane[i];
        double gx = at->gx[k], gy = at->gy[k], gz = at->gz[k], off = MCR_OFFSET * at->reach[k];
        off = gx * l->wx[k] + gy * l->wy[k] + gz * l->wz[k] < 0 ? -off : off;
        l->ox[i] = at->px[k] + off * gx;
        l->oy[i] = at->py[k] + off * gy;
        l->oz[i] = at->pz[k] + off * gz;
    }
}

/* The rays go in the directions drawn. */
static void go_along(const struct mcr_batch *batch, uint32_t n)
{
    const struct mcr_light_lanes *l = &batch->light;
    const uint32_t *lane = l->lane;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = lane[i];
        l->dx[i] = l->wx[k];
        l->dy[i] = l->wy[k];
        l->dz[i] = l->wz[k];
    }
}

/* ---- Points on emitters ------------------------------------------------------------------------------------------ */

/* The points q of the finds, brought onto their primitives as mcr_surface_project does it, and the unit normals there; garbage for the sky's. */
static inline __attribute__((always_inline)) void project(const struct mcr_batch *batch, uint32_t n, int round)
{
    const struct mcr_surface *s = batch->core->surfaces.surface;
    const struct mcr_light_lanes *l = &batch->light;
    const uint32_t *lane = l->lane;
    const int64_t *hit = l->hit;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = lane[i];
        int64_t m = hit[i] < 0 ? 0 : hit[i];
        double qx = l->qx[k], qy = l->qy[k], qz = l->qz[k];
        double nx = s[m].x, ny = s[m].y, nz = s[m].z;
        double off = nx * qx + ny * qy + nz * qz - s[m].offset;
        double x = qx - off * nx, y = qy - off * ny, z = qz - off * nz;
        if (round) {
            double cx = s[m].x, cy = s[m].y, cz = s[m].z, radius = s[m].radius;
            double ux = qx - cx, uy = qy - cy, uz = qz - cz, length = sqrt(ux * ux + uy * uy + uz * uz);
            int sphere = radius > 0;
            ux /= length;
            uy /= length;
            uz /= length;
            nx = sphere ? ux : nx;
            ny = sphere ? uy : ny;
            nz = sphere ? uz : nz;
            x = sphere ? cx + radius * ux : x;
            y = sphere ? cy + radius * uy : y;
            z = sphere ? cz + radius * uz : z;
        }
        l->sx[i] = x;
        l->sy[i] = y;
        l->sz[i] = z;
        l->mx[i] = nx;
        l->my[i] = ny;
        l->mz[i] = nz;
    }
}

static void project_quadrics(const struct mcr_batch *batch, uint32_t n)
{
    const uint32_t *quadric = batch->core->surfaces.quadric;
    const struct mcr_light_lanes *l = &batch->light;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = l->lane[i];
        double q[3] = {l->qx[k], l->qy[k], l->qz[k]}, m[3];
        if (l->hit[i] < 0 || quadric[l->hit[i]] == UINT32_MAX)
            continue;
        mcr_surface_project(batch->core, l->hit[i], q, m);
        l->sx[i] = q[0];
        l->sy[i] = q[1];
        l->sz[i] = q[2];
        l->mx[i] = m[0];
        l->my[i] = m[1];
        l->mz[i] = m[2];
    }
}

static void project_all(const struct mcr_batch *batch, uint32_t n)
{
    if (batch->core->surfaces.round)
        project(batch, n, 1);
    else
        project(batch, n, 0);
    if (batch->core->surfaces.quadric)
        project_quadrics(batch, n);
}

/* Each ray ends as far before the emitter's surface as it starts off its own; toward the sky it has no end. */
static inline __attribute__((always_inline)) void end_before(const struct mcr_batch *batch, uint32_t n, int sky)
{
    const struct mcr_surface *s = batch->core->surfaces.surface;
    const double *reach_at = batch->at.reach;
    const struct mcr_light_lanes *l = &batch->light;
    const uint32_t *lane = l->lane;
    const int64_t *hit = l->hit;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = lane[i];
        int far = hit[i] < 0;
        double wx = l->wx[k], wy = l->wy[k], wz = l->wz[k], mx = l->mx[i], my = l->my[i], mz = l->mz[i];
        double reach = largest(largest(fabs(l->sx[i]), fabs(l->sy[i])), largest(fabs(l->sz[i]), s[far ? 0 : hit[i]].reach));
        reach = MCR_OFFSET * largest(reach, reach_at[k]);
        double off = mx * wx + my * wy + mz * wz < 0 ? reach : -reach;
        double dx = l->sx[i] + off * mx - l->ox[i], dy = l->sy[i] + off * my - l->oy[i], dz = l->sz[i] + off * mz - l->oz[i];
        double length = sqrt(dx * dx + dy * dy + dz * dz);
        l->dx[i] = sky && far ? wx : dx / length;
        l->dy[i] = sky && far ? wy : dy / length;
        l->dz[i] = sky && far ? wz : dz / length;
        l->far[i] = sky && far ? INFINITY : length;
    }
}

/* What the rays aim at, before they are traced. */
static void tell_targets(const struct mcr_batch *batch, uint32_t n)
{
    const struct mcr_emitter *emitters = batch->core->emitters->emitter;
    const struct mcr_light_lanes *l = &batch->light;
    const int32_t sky = batch->core->sky_emitter;
    for (uint32_t i = 0; i < n; i++) {
        int32_t e = l->emitter[l->lane[i]];
        l->hit[i] = e == sky ? MCR_FOUND_SKY : (int64_t)emitters[e].primitive;
    }
}

static uint32_t aim(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_light_lanes *l = &batch->light;
    flag_worth(batch, range, l->seen);
    uint32_t n = list_lanes(batch, range, l->seen, 0, l->lane);
    tell_targets(batch, n);
    leave_points(batch, n);
    if (!batch->core->emitters->count) { /* nothing but the sky */
        go_along(batch, n);
        for (uint32_t i = 0; i < n; i++)
            l->far[i] = INFINITY;
        return n;
    }
    project_all(batch, n);
    if (batch->core->sky_emitter >= 0)
        end_before(batch, n, 1);
    else
        end_before(batch, n, 0);
    return n;
}

static void see(struct mcr_batch *batch, uint32_t n)
{
    const double *seen = batch->light.seen;
    int64_t *hit = batch->light.hit;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        hit[i] = seen[i] != 0 ? hit[i] : MCR_FOUND_NOTHING;
}

/* ---- Directions -------------------------------------------------------------------------------------------------- */

static uint32_t leave(struct mcr_batch *batch, const struct mcr_range *range, uint32_t *traced)
{
    const struct mcr_light_lanes *l = &batch->light;
    flag_worth(batch, range, l->seen);
    *traced = list_lanes(batch, range, l->seen, 0, l->lane);
    uint32_t limited = list_lanes(batch, range, l->seen, 1, l->of);
    memcpy(l->lane + *traced, l->of, limited * sizeof *l->lane);
    leave_points(batch, *traced);
    go_along(batch, *traced);
    for (uint32_t k = range->begin; k < range->end; k++)
        l->emitter[k] = -1;
    return *traced + limited;
}

static uint32_t find(struct mcr_batch *batch, uint32_t traced, uint32_t all)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_light_lanes *l = &batch->light;
    for (uint32_t i = 0; i < traced; i++) {
        uint32_t k = l->lane[i];
        l->emitter[k] = l->hit[i] >= 0 ? core->emitters->of_primitive[l->hit[i]] : core->sky_emitter;
        l->distance[k] = l->far[i];
        l->qx[k] = l->ox[i] + l->far[i] * l->dx[i];
        l->qy[k] = l->oy[i] + l->far[i] * l->dy[i];
        l->qz[k] = l->oz[i] + l->far[i] * l->dz[i];
    }
    uint32_t count = 0;
    for (uint32_t i = 0; i < all; i++) {
        int64_t m = i < traced ? l->hit[i] : -1;
        int found = m < 0 ? core->background : core->group[core->group_of_material[core->surfaces.material[m]]].emits;
        l->lane[count] = l->lane[i];
        l->hit[count] = m < 0 ? MCR_FOUND_SKY : m;
        l->seen[count] = 1;
        count += found != 0;
    }
    project_all(batch, count);
    return count;
}

/* ---- What is found ----------------------------------------------------------------------------------------------- */

/* Finds whose primitives are the group's. All finds that are primitives emit: with one group that does, it is theirs. */
static uint32_t list_group(const struct mcr_batch *batch, uint32_t n, uint32_t group)
{
    const struct mcr_core *core = batch->core;
    const int64_t *restrict hit = batch->light.hit;
    uint32_t *restrict of = batch->light.of, emitting = 0, count = 0;
    for (uint32_t g = 0; g < core->group_count; g++)
        emitting += core->group[g].emits != 0;
    for (uint32_t i = 0; i < n; i++) {
        of[count] = i;
        count += hit[i] >= 0;
    }
    if (emitting == 1)
        return count;
    n = count;
    count = 0;
    for (uint32_t c = 0; c < n; c++) {
        of[count] = of[c];
        count += core->group_of_material[core->surfaces.material[hit[of[c]]]] == group;
    }
    return count;
}

static uint32_t surfaces(struct mcr_batch *batch, uint32_t n, uint32_t group)
{
    const struct mcr_light_lanes *l = &batch->light;
    const uint32_t count = list_group(batch, n, group), *of = l->of, *lane = l->lane, *material_of = batch->core->surfaces.material;
    const int64_t *hit = l->hit;
    uint32_t *material = l->material;
    MCR_LANES
    for (uint32_t c = 0; c < count; c++) {
        uint32_t i = of[c], k = lane[i];
        double wx = l->wx[k], wy = l->wy[k], wz = l->wz[k], mx = l->mx[i], my = l->my[i], mz = l->mz[i];
        double side = mx * wx + my * wy + mz * wz < 0 ? 1.0 : -1.0;
        l->px[c] = l->sx[i];
        l->py[c] = l->sy[i];
        l->pz[c] = l->sz[i];
        l->nx[c] = side * mx;
        l->ny[c] = side * my;
        l->nz[c] = side * mz;
        l->tx[c] = -wx;
        l->ty[c] = -wy;
        l->tz[c] = -wz;
        l->side[c] = side;
    }
    MCR_LANES
    for (uint32_t c = 0; c < count; c++)
        material[c] = material_of[hit[of[c]]];
    for (uint32_t c = 0; c < count && batch->elsewhere.primitive; c++) {
        uint32_t k = lane[of[c]];
        batch->elsewhere.primitive[c] = hit[of[c]];
        batch->elsewhere.width[c] = batch->sorted.width[k] + batch->sorted.spread[k] * l->distance[k];
    }
    return count;
}

static uint32_t sky(struct mcr_batch *batch, uint32_t n)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_light_lanes *l = &batch->light;
    const int64_t *restrict hit = l->hit;
    uint32_t *restrict of = l->of, count = 0;
    for (uint32_t i = 0; i < n; i++) {
        of[count] = i;
        count += hit[i] == MCR_FOUND_SKY;
    }
    if (core->sky) {
        MCR_LANES
        for (uint32_t c = 0; c < count; c++) {
            uint32_t k = l->lane[of[c]];
            l->tx[c] = l->wx[k];
            l->ty[c] = l->wy[k];
            l->tz[c] = l->wz[k];
        }
        core->sky_functions->radiance(core->sky, count, l->tx, l->ty, l->tz, l->lr, l->lg, l->lb);
        return count;
    }
    for (uint32_t c = 0; c < count; c++) {
        l->lr[c] = core->scene->render.background[0];
        l->lg[c] = core->scene->render.background[1];
        l->lb[c] = core->scene->render.background[2];
    }
    return count;
}

static void shed(struct mcr_batch *batch, uint32_t count)
{
    const struct mcr_light_lanes *l = &batch->light;
    const struct mcr_paths *paths = &batch->sorted;
    const uint32_t *of = l->of, *lane = l->lane, *slot = paths->slot;
    const int power = batch->core->scene->render.mis_power;
    MCR_LANES
    for (uint32_t c = 0; c < count; c++) {
        uint32_t k = lane[of[c]];
        double density = l->density[k], h = power ? density * density : density;
        double weight = h / ((h + l->sum[k]) * density);
        weight = l->seen[of[c]] < 0 ? -1 / density : weight;
        l->lr[c] = paths->r[k] * l->fr[k] * l->lr[c] * weight;
        l->lg[c] = paths->g[k] * l->fg[k] * l->lg[c] * weight;
        l->lb[c] = paths->b[k] * l->fb[k] * l->lb[c] * weight;
    }
    for (uint32_t c = 0; c < count; c++) {
        uint32_t s = slot[lane[of[c]]];
        batch->slot_r[s] += l->lr[c];
        batch->slot_g[s] += l->lg[c];
        batch->slot_b[s] += l->lb[c];
    }
}

/* ---- What the paths' own rays have hit --------------------------------------------------------------------------- */

static void hits(struct mcr_batch *batch)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_light_lanes *l = &batch->light;
    memset(l->emitter, 0xff, batch->points * sizeof *l->emitter); /* -1 */
    memcpy(l->sum, l->others, batch->points * sizeof *l->sum);
    const uint32_t *restrict source = batch->source, rays = batch->rays;
    uint32_t *restrict list = l->of, count = 0;
    for (uint32_t j = 0; j < rays; j++) { /* camera rays belong to lanes beyond the points, where there is room and nobody looks */
        int32_t e = batch->hit[j] < 0 ? core->sky_emitter : core->emitters->of_primitive[batch->hit[j]];
        l->emitter[source[j]] = e;
        list[count] = j;
        count += e >= 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = list[i], k = source[j];
        double t = batch->t[j], dx = batch->rdx[j], dy = batch->rdy[j], dz = batch->rdz[j];
        l->distance[k] = t;
        l->qx[k] = batch->rox[j] + t * dx;
        l->qy[k] = batch->roy[j] + t * dy;
        l->qz[k] = batch->roz[j] + t * dz;
        l->wx[k] = dx;
        l->wy[k] = dy;
        l->wz[k] = dz;
    }
}

static void weights(struct mcr_batch *batch)
{
    const struct mcr_light_lanes *l = &batch->light;
    const uint32_t points = batch->points, rays = batch->rays, *source = batch->source;
    MCR_LANES
    for (uint32_t j = 0; j < rays; j++) { /* camera rays come from beyond the points */
        uint32_t k = source[j];
        double weight = l->own[k] / (l->own[k] + l->sum[k]);
        l->weight[j] = k < points ? weight : 1.0;
    }
    if (!batch->core->lobes)
        return;
    const double *none = batch->lobe.none;
    MCR_LANES
    for (uint32_t j = 0; j < rays; j++) { /* what is found along a mirror-like lobe no technique could have drawn */
        uint32_t k = source[j];
        l->weight[j] = ((k < points) & (none[k] == 0)) ? 1.0 : l->weight[j];
    }
}

const struct mcr_light_functions MCR_ISA_NAME(mcr_light_functions) = {
    .add = add, .clear = clear, .aim = aim, .see = see, .leave = leave, .find = find, .surfaces = surfaces, .sky = sky, .shed = shed,
    .hits = hits, .weights = weights, .control = MCR_ISA_NAME(mcr_light_control), .turn = MCR_ISA_NAME(mcr_light_turn),
    .spare = MCR_ISA_NAME(mcr_light_spare)};
