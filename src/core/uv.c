/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Surface coordinates, footprints and tangents. Stage file, compiled once per instruction set.
 *
 * Footprint: each path carries the cone of its pixel (Akenine-Moller et al., "Texture level of detail strategies for real-time ray tracing", Ray Tracing
 * Gems, 2019): a diameter that grows with the length of the whole path. Scattering does not widen it and curvature does not bend it, so that it is the
 * same under every sampler and never larger than what the pixel sees in a plane mirror: a texture may be filtered too little, never too much.
 */
#include <math.h>

#include "base/elementary.h"
#include "core/stages.h"
#include <mcrender/sampler.h>

#define PER_TURN 0.15915494309189535 /* 1 / (2 pi) */

/* Cosines to the normal below this widen a footprint no further. */
#define GRAZING 0x1p-10

static void flat_lanes(const struct mcr_charts *charts, const struct mcr_chart_lanes *l)
{
    const int64_t last = charts->count;
    MCR_LANES
    for (uint32_t i = 0; i < l->n; i++) {
        int64_t p = l->primitive[i] < last ? l->primitive[i] : 0;
        double x = l->px[i] - charts->c[0][p], y = l->py[i] - charts->c[1][p], z = l->pz[i] - charts->c[2][p];
        double ux = charts->gu[0][p], uy = charts->gu[1][p], uz = charts->gu[2][p];
        double vx = charts->gv[0][p], vy = charts->gv[1][p], vz = charts->gv[2][p];
        l->u[i] = ux * x + uy * y + uz * z + charts->u0[p];
        l->v[i] = vx * x + vy * y + vz * z + charts->v0[p];
        l->gu[0][i] = ux;
        l->gu[1][i] = uy;
        l->gu[2][i] = uz;
        l->gv[0][i] = vx;
        l->gv[1][i] = vy;
        l->gv[2][i] = vz;
    }
}

/*
 * Longitude and latitude on the unit sphere: u = 1/2 + atan2(x, z) / 2 pi, v = 1/2 + atan2(y, sqrt(x^2 + z^2)) / pi. On the axis u is 1/2 and has no
 * gradient.
 */
static void round_lane(const struct mcr_charts *charts, const struct mcr_chart_lanes *l, uint32_t i)
{
    int64_t p = l->primitive[i];
    const double *m = charts->local[p];
    double q[3] = {l->px[i] - charts->c[0][p], l->py[i] - charts->c[1][p], l->pz[i] - charts->c[2][p]}, at[3], du[3] = {0, 0, 0}, dv[3] = {0, 0, 0};
    for (int j = 0; j < 3; j++)
        at[j] = m[3 * j] * q[0] + m[3 * j + 1] * q[1] + m[3 * j + 2] * q[2];
    double square = at[0] * at[0] + at[2] * at[2], rho = sqrt(square), all = square + at[1] * at[1];
    l->u[i] = 0.5 + PER_TURN * mcr_atan2(at[0], at[2]);
    l->v[i] = 0.5 + 2 * PER_TURN * mcr_atan2(at[1], rho);
    if (square > 0) {
        du[0] = PER_TURN * at[2] / square;
        du[2] = -PER_TURN * at[0] / square;
        dv[0] = -2 * PER_TURN * at[0] * at[1] / (all * rho);
        dv[1] = 2 * PER_TURN * rho / all;
        dv[2] = -2 * PER_TURN * at[2] * at[1] / (all * rho);
    }
    /* Back through the map, and into the tangent plane: an ellipsoid's normal is not along its radius. */
    const double n[3] = {l->gx[i], l->gy[i], l->gz[i]};
    double gu[3], gv[3];
    for (int j = 0; j < 3; j++) {
        gu[j] = m[j] * du[0] + m[3 + j] * du[1] + m[6 + j] * du[2];
        gv[j] = m[j] * dv[0] + m[3 + j] * dv[1] + m[6 + j] * dv[2];
    }
    double un = gu[0] * n[0] + gu[1] * n[1] + gu[2] * n[2], vn = gv[0] * n[0] + gv[1] * n[1] + gv[2] * n[2];
    for (int j = 0; j < 3; j++) {
        l->gu[j][i] = gu[j] - un * n[j];
        l->gv[j][i] = gv[j] - vn * n[j];
    }
}

/*
 * Interpolated between the corners. With edges a, b from the first corner and N = a x b, the second corner's weight has the gradient b x N / N^2 and the
 * third's N x a / N^2; in units of the longest component of the edges, so that no product underflows.
 */
static void triangle_lane(const struct mcr_triangles *m, uint32_t f, const struct mcr_chart_lanes *l, uint32_t i)
{
    const uint32_t *c = m->vertex[f], *t = m->uv[f];
    double a[3] = {m->x[c[1]] - m->x[c[0]], m->y[c[1]] - m->y[c[0]], m->z[c[1]] - m->z[c[0]]};
    double b[3] = {m->x[c[2]] - m->x[c[0]], m->y[c[2]] - m->y[c[0]], m->z[c[2]] - m->z[c[0]]}, unit = 0;
    double q[3] = {l->px[i] - m->x[c[0]], l->py[i] - m->y[c[0]], l->pz[i] - m->z[c[0]]}, u = 0, v = 0;
    double ua = m->u[t[1]] - m->u[t[0]], ub = m->u[t[2]] - m->u[t[0]], va = m->v[t[1]] - m->v[t[0]], vb = m->v[t[2]] - m->v[t[0]];
    for (int j = 0; j < 3; j++)
        unit = mcr_max(unit, mcr_max(fabs(a[j]), fabs(b[j])));
    for (int j = 0; j < 3; j++) {
        a[j] /= unit;
        b[j] /= unit;
    }
    double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double scale = 1 / ((n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) * unit);
    for (int j = 0; j < 3; j++) {
        int k = (j + 1) % 3, o = (j + 2) % 3;
        double second = (b[k] * n[o] - b[o] * n[k]) * scale, third = (n[k] * a[o] - n[o] * a[k]) * scale;
        double gu = ua * second + ub * third, gv = va * second + vb * third;
        u += gu * q[j];
        v += gv * q[j];
        l->gu[j][i] = gu;
        l->gv[j][i] = gv;
    }
    l->u[i] = m->u[t[0]] + u;
    l->v[i] = m->v[t[0]] + v;
}

/*
 * The footprint is an ellipse of the cone's diameter w across and w / cosine along the surface; its area in units of u and v is that times |gu x gv|,
 * and the width is the diameter of the circle of the same area.
 */
static void width_lanes(const struct mcr_chart_lanes *l)
{
    MCR_LANES
    for (uint32_t i = 0; i < l->n; i++) {
        double cosine = l->gx[i] * l->ox[i] + l->gy[i] * l->oy[i] + l->gz[i] * l->oz[i];
        double x = l->gu[1][i] * l->gv[2][i] - l->gu[2][i] * l->gv[1][i], y = l->gu[2][i] * l->gv[0][i] - l->gu[0][i] * l->gv[2][i];
        double z = l->gu[0][i] * l->gv[1][i] - l->gu[1][i] * l->gv[0][i];
        double area = sqrt(x * x + y * y + z * z) / (cosine > GRAZING ? cosine : GRAZING);
        l->width[i] *= sqrt(area);
    }
}

void MCR_ISA_NAME(mcr_stage_chart)(const struct mcr_core *core, const struct mcr_chart_lanes *lanes)
{
    const struct mcr_charts *charts = &core->charts;
    const struct mcr_triangles *triangles = &core->scene->triangles;
    const struct mcr_surfaces *s = &core->surfaces;
    flat_lanes(charts, lanes);
    for (uint32_t i = 0; i < lanes->n && charts->local; i++) {
        int64_t p = lanes->primitive[i];
        if (s->surface[p].radius > 0 || (s->quadric && s->quadric[p] != UINT32_MAX))
            round_lane(charts, lanes, i);
    }
    for (uint32_t i = 0; i < lanes->n && triangles->count; i++)
        if (lanes->primitive[i] >= triangles->first_primitive)
            triangle_lane(triangles, (uint32_t)(lanes->primitive[i] - triangles->first_primitive), lanes, i);
    width_lanes(lanes);
}

/* Of a perspective ray, the picture lies at distance 1 along the camera's axis, 1 / cosine along the ray. */
void MCR_ISA_NAME(mcr_stage_cones)(struct mcr_batch *batch, uint32_t to, uint32_t ray, uint32_t n)
{
    const struct mcr_camera *camera = &batch->core->scene->camera;
    const double step = 2 * camera->half_height / batch->core->scene->film.height, *f = camera->forward;
    const double fx = f[0], fy = f[1], fz = f[2], *x = batch->rdx + ray, *y = batch->rdy + ray, *z = batch->rdz + ray;
    const int parallel = camera->kind == MCR_CAMERA_ORTHOGRAPHIC;
    double *width = batch->state.width + to, *spread = batch->state.spread + to;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        width[i] = parallel ? step : 0;
        spread[i] = parallel ? 0 : step * (fx * x[i] + fy * y[i] + fz * z[i]);
    }
}

/*
 * Along growing u at constant v: across the gradient of v, in the plane of the shading normal. Where v does not change, along the gradient of u; where
 * there is neither (at a pole, or all corners of a triangle at one point of the texture), any direction.
 */
static void tangent_lane(const struct mcr_surface_points *at, const double *nx, const double *ny, const double *nz, uint32_t k)
{
    double n[3] = {nx[k], ny[k], nz[k]}, gu[3], gv[3], t[3], bx, by, bz, along = 0, square = 0, dot = 0;
    for (int j = 0; j < 3; j++) {
        gu[j] = at->gu[j][k];
        gv[j] = at->gv[j][k];
    }
    double g[3] = {at->gx[k], at->gy[k], at->gz[k]};
    for (int j = 0; j < 3; j++) {
        t[j] = gv[(j + 1) % 3] * g[(j + 2) % 3] - gv[(j + 2) % 3] * g[(j + 1) % 3];
        along += t[j] * gu[j];
    }
    for (int j = 0; j < 3; j++) {
        t[j] = along > 0 ? t[j] : along < 0 ? -t[j] : gu[j];
        dot += t[j] * n[j];
    }
    for (int j = 0; j < 3; j++) {
        t[j] -= dot * n[j];
        square += t[j] * t[j];
    }
    double length = sqrt(square);
    if (square > 0x1p-1000 && square < 0x1p1000) {
        at->tx[k] = t[0] / length;
        at->ty[k] = t[1] / length;
        at->tz[k] = t[2] / length;
    } else {
        mcr_basis(n[0], n[1], n[2], &at->tx[k], &at->ty[k], &at->tz[k], &bx, &by, &bz);
    }
}

void MCR_ISA_NAME(mcr_stage_coordinates)(struct mcr_batch *batch)
{
    const struct mcr_surface_points *at = &batch->at;
    const struct mcr_paths *from = &batch->state, *to = &batch->sorted;
    const uint32_t *order = batch->order, *source = batch->source;
    MCR_LANES
    for (uint32_t k = 0; k < batch->points; k++) {
        uint32_t j = order[k], l = source[j];
        double spread = from->spread[l], width = from->width[l] + spread * batch->t[j];
        to->spread[k] = spread;
        to->width[k] = width;
        at->width[k] = width;
    }
    MCR_ISA_NAME(mcr_stage_chart)(batch->core, &(struct mcr_chart_lanes){.n = batch->points,
                                                                         .primitive = at->primitive,
                                                                         .px = at->px,
                                                                         .py = at->py,
                                                                         .pz = at->pz,
                                                                         .gx = at->gx,
                                                                         .gy = at->gy,
                                                                         .gz = at->gz,
                                                                         .ox = at->ox,
                                                                         .oy = at->oy,
                                                                         .oz = at->oz,
                                                                         .u = at->u,
                                                                         .v = at->v,
                                                                         .width = at->width,
                                                                         .gu = {at->gu[0], at->gu[1], at->gu[2]},
                                                                         .gv = {at->gv[0], at->gv[1], at->gv[2]}});
    /* Shading normals that are still to be tilted are the geometric ones, unless triangles have their own. */
    int smooth = batch->core->surfaces.smooth;
    const double *nx = smooth ? at->nx : at->gx, *ny = smooth ? at->ny : at->gy, *nz = smooth ? at->nz : at->gz;
    for (uint32_t k = 0; k < batch->points && at->tx; k++)
        tangent_lane(at, nx, ny, nz, k);
}
