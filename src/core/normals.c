/* SPDX-License-Identifier: Apache-2.0 */
/* Normal maps and bumps: shading normals that textures tilt, before any plugin sees them. */
#include <math.h>
#include <string.h>

#include "core/batch.h"
#include <mcrender/sampler.h>

/* The shading normal rises above the geometric horizon by at least this, the mirror direction of the outgoing one by MIRROR. */
#define HORIZON 0x1p-10
#define MIRROR 0.01

/* Heights are compared at least so far apart, in parts of the larger of 1, |u| and |v|: the rounding of heights and coordinates is lost in that. */
#define LEAST_STEP 0x1p-20

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Returns 0 and leaves the vector where it has no direction. */
static int normalize(double v[3])
{
    double square = dot(v, v), length = sqrt(square);
    if (!(square > 0x1p-1000 && square < 0x1p1000))
        return 0;
    for (int j = 0; j < 3; j++)
        v[j] /= length;
    return 1;
}

/*
 * Keeps a normal usable: above the geometric horizon, and so that the mirror direction of the outgoing one is above it too, as Keller et al. do ("The
 * Iray light transport simulation and rendering system", 2017): where that would be below, it is raised and the normal becomes the half vector. The
 * outgoing direction is above the normal's horizon then, and nothing turns black that only leans too far. g, o and n are on one side.
 */
static void raise_normal(const double g[3], const double o[3], double n[3])
{
    double above = dot(n, g), mirror[3], out, low, least = 0.9 * dot(o, g);
    if (above < HORIZON) {
        for (int j = 0; j < 3; j++)
            n[j] += (HORIZON - above) * g[j];
        normalize(n);
    }
    out = 2 * dot(n, o);
    for (int j = 0; j < 3; j++)
        mirror[j] = out * n[j] - o[j];
    least = least < MIRROR ? least : MIRROR;
    low = dot(mirror, g);
    if (low >= least)
        return;
    for (int j = 0; j < 3; j++)
        mirror[j] += (least - low) * g[j];
    if (!normalize(mirror))
        return;
    for (int j = 0; j < 3; j++)
        n[j] = mirror[j] + o[j];
    normalize(n);
}

/* The shading normal of point k becomes `front`, which is on the front; its tangent follows. */
static void store(const struct mcr_surface_points *at, uint32_t k, const double front[3])
{
    const double g[3] = {at->gx[k], at->gy[k], at->gz[k]}, o[3] = {at->ox[k], at->oy[k], at->oz[k]};
    double n[3] = {at->side[k] * front[0], at->side[k] * front[1], at->side[k] * front[2]};
    raise_normal(g, o, n);
    at->nx[k] = n[0];
    at->ny[k] = n[1];
    at->nz[k] = n[2];
    if (!at->tx)
        return;
    double t[3] = {at->tx[k], at->ty[k], at->tz[k]}, along = dot(t, n), bx, by, bz;
    for (int j = 0; j < 3; j++)
        t[j] -= along * n[j];
    if (!normalize(t))
        mcr_basis(n[0], n[1], n[2], &t[0], &t[1], &t[2], &bx, &by, &bz);
    at->tx[k] = t[0];
    at->ty[k] = t[1];
    at->tz[k] = t[2];
}

/* Normals of the lanes on the front, as tilted so far. Those of a map: x along growing u, y along growing v, z the surface's own. */
static void map_normals(const struct mcr_surface_points *at, const struct mcr_texture_lanes *t, uint32_t n, const struct mcr_surface_settings *surface,
                        double (*front)[3])
{
    mcr_texture_lookup(surface->normal_map, n, t->u, t->v, t->width, t->r, t->g, t->b);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = t->lane[i];
        double x = (2 * t->r[i] - 1) * surface->normal_strength, y = (2 * t->g[i] - 1) * surface->normal_strength, z = 2 * t->b[i] - 1;
        double a[3] = {at->tx[k], at->ty[k], at->tz[k]}, *m = front[i], b[3], v[3], sum[3];
        double rises = 0;
        for (int j = 0; j < 3; j++) {
            b[j] = m[(j + 1) % 3] * a[(j + 2) % 3] - m[(j + 2) % 3] * a[(j + 1) % 3];
            v[j] = at->gv[j][k];
            rises += b[j] * v[j];
        }
        for (int j = 0; j < 3; j++)
            sum[j] = x * a[j] + (rises < 0 ? -y : y) * b[j] + z * m[j];
        if (normalize(sum))
            memcpy(m, sum, sizeof sum);
    }
}

/* Heights at (u + du[i], v + dv[i]) into t->r. */
static void heights(const struct mcr_texture_lanes *t, uint32_t n, const struct mcr_texture *bump, const double *step, double du, double dv)
{
    for (uint32_t i = 0; i < n; i++) {
        t->su[i] = t->u[i] + du * step[i];
        t->sv[i] = t->v[i] + dv * step[i];
    }
    mcr_texture_lookup(bump, n, t->su, t->sv, t->width, t->r, t->g, t->b);
    for (uint32_t i = 0; i < n; i++)
        t->r[i] = mcr_texture_number(t->r[i], t->g[i], t->b[i]);
}

/*
 * A surface raised by the height h along its normal n has a normal along n - grad h (Mikkelsen, "Bump mapping unparametrized surfaces on the GPU", 2010).
 * The gradient is that of u times dh/du, plus v's; each is a central difference over half a footprint to both sides.
 */
static void bump_normals(const struct mcr_surface_points *at, const struct mcr_texture_lanes *t, uint32_t n, const struct mcr_texture *bump, double height,
                         double (*front)[3])
{
    for (uint32_t i = 0; i < n; i++) {
        double least = fabs(t->u[i]) > fabs(t->v[i]) ? fabs(t->u[i]) : fabs(t->v[i]);
        least = LEAST_STEP * (least > 1 ? least : 1);
        t->step[i] = 0.5 * t->width[i] > least ? 0.5 * t->width[i] : least;
    }
    heights(t, n, bump, t->step, 1, 0);
    memcpy(t->slope[0], t->r, n * sizeof *t->r);
    heights(t, n, bump, t->step, -1, 0);
    for (uint32_t i = 0; i < n; i++)
        t->slope[0][i] = height * (t->slope[0][i] - t->r[i]) / (2 * t->step[i]);
    heights(t, n, bump, t->step, 0, 1);
    memcpy(t->slope[1], t->r, n * sizeof *t->r);
    heights(t, n, bump, t->step, 0, -1);
    for (uint32_t i = 0; i < n; i++)
        t->slope[1][i] = height * (t->slope[1][i] - t->r[i]) / (2 * t->step[i]);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = t->lane[i];
        double sum[3];
        for (int j = 0; j < 3; j++)
            sum[j] = front[i][j] - (t->slope[0][i] * at->gu[j][k] + t->slope[1][i] * at->gv[j][k]);
        if (normalize(sum))
            memcpy(front[i], sum, sizeof sum);
    }
}

/* The points of one material, a stretch that begins with `first` in the list. */
static void tilt(struct mcr_batch *batch, uint32_t material, uint32_t first)
{
    const struct mcr_surface_settings *surface = &batch->core->scene->material[material].surface;
    const struct mcr_surface_points *at = &batch->at;
    const struct mcr_texture_lanes *t = &batch->textures;
    uint32_t n = 0;
    for (uint32_t k = first; k != UINT32_MAX; k = t->next[k]) {
        t->lane[n] = k;
        t->u[n] = at->u[k];
        t->v[n] = at->v[k];
        t->width[n] = at->width[k];
        t->front[n][0] = at->side[k] * at->nx[k];
        t->front[n][1] = at->side[k] * at->ny[k];
        t->front[n][2] = at->side[k] * at->nz[k];
        n++;
    }
    if (surface->normal_map)
        map_normals(at, t, n, surface, t->front);
    if (surface->bump)
        bump_normals(at, t, n, surface->bump, surface->bump_height * batch->core->scene->scale, t->front);
    for (uint32_t i = 0; i < n; i++)
        store(at, t->lane[i], t->front[i]);
}

void mcr_normals_tilt(struct mcr_batch *batch)
{
    const struct mcr_scene_material *material = batch->core->scene->material;
    const struct mcr_surface_points *at = &batch->at;
    const struct mcr_texture_lanes *t = &batch->textures;
    uint32_t present = 0;
    if (!batch->core->surfaces.smooth) {
        memcpy(at->nx, at->gx, batch->points * sizeof *at->nx);
        memcpy(at->ny, at->gy, batch->points * sizeof *at->ny);
        memcpy(at->nz, at->gz, batch->points * sizeof *at->nz);
    }
    for (uint32_t k = 0; k < batch->points; k++) {
        uint32_t m = at->material[k];
        if (!(material[m].surface.normal_map || material[m].surface.bump))
            continue;
        if (t->head[m] == UINT32_MAX)
            t->present[present++] = m;
        t->next[k] = t->head[m];
        t->head[m] = k;
    }
    for (uint32_t i = 0; i < present; i++) {
        uint32_t first = t->head[t->present[i]];
        t->head[t->present[i]] = UINT32_MAX;
        tilt(batch, t->present[i], first);
    }
}
