/* SPDX-License-Identifier: Apache-2.0 */
/* Hits become surface points: position, normals, side; path states follow in the same order. Stage file, compiled once per instruction set. */
#include <math.h>
#include <string.h>

#include "core/stages.h"

static inline double largest(double a, double b)
{
    return a > b ? a : b;
}

/*
 * The point o + t d is off its surface by a few u of the numbers it was computed with. One step along the normal brings flat shapes back to
 * u * max(|p|, |c|), and spheres are projected from their centre. `round` is constant where this is inlined: without spheres, what is
 * computed for them is not there.
 */
static inline __attribute__((always_inline)) void points(struct mcr_batch *batch, int round)
{
    const struct mcr_surface *s = batch->core->surfaces.surface;
    const struct mcr_surface_points *at = &batch->at;
    const uint32_t *order = batch->order;
    MCR_LANES
    for (uint32_t k = 0; k < batch->points; k++) {
        uint32_t j = order[k];
        int64_t m = batch->hit[j];
        double t = batch->t[j], rx = batch->rox[j], ry = batch->roy[j], rz = batch->roz[j];
        double dx = batch->rdx[j], dy = batch->rdy[j], dz = batch->rdz[j];
        double nx = s[m].x, ny = s[m].y, nz = s[m].z;
        double px = rx + t * dx, py = ry + t * dy, pz = rz + t * dz;
        double off = nx * px + ny * py + nz * pz - s[m].offset;
        double x = px - off * nx, y = py - off * ny, z = pz - off * nz;
        if (round) {
            double cx = s[m].x, cy = s[m].y, cz = s[m].z, radius = s[m].radius;
            double qx = px - cx, qy = py - cy, qz = pz - cz;
            double inverse = 1 / sqrt(qx * qx + qy * qy + qz * qz);
            int sphere = radius > 0;
            double ux = qx * inverse, uy = qy * inverse, uz = qz * inverse;
            nx = sphere ? ux : nx;
            ny = sphere ? uy : ny;
            nz = sphere ? uz : nz;
            x = sphere ? cx + radius * ux : x;
            y = sphere ? cy + radius * uy : y;
            z = sphere ? cz + radius * uz : z;
        }
        double side = nx * dx + ny * dy + nz * dz < 0 ? 1.0 : -1.0;
        at->px[k] = x;
        at->py[k] = y;
        at->pz[k] = z;
        at->gx[k] = side * nx;
        at->gy[k] = side * ny;
        at->gz[k] = side * nz;
        at->ox[k] = -dx;
        at->oy[k] = -dy;
        at->oz[k] = -dz;
        at->side[k] = side;
        double reach = largest(largest(fabs(x), fabs(y)), fabs(z));
        reach = largest(reach, largest(largest(fabs(rx), fabs(ry)), fabs(rz)));
        at->reach[k] = largest(reach, s[m].reach);
    }
}

static void identities(struct mcr_batch *batch)
{
    const uint32_t *order = batch->order, *material_of = batch->core->surfaces.material, n = batch->points;
    const int64_t *hit = batch->hit;
    uint32_t *material = batch->at.material;
    int64_t *primitive = batch->at.primitive;
    MCR_LANES
    for (uint32_t k = 0; k < n; k++) {
        primitive[k] = hit[order[k]];
        material[k] = material_of[primitive[k]];
    }
}

static void states(struct mcr_batch *batch)
{
    const struct mcr_paths *from = &batch->state, *to = &batch->sorted;
    const uint32_t *order = batch->order, *source = batch->source;
    MCR_LANES
    for (uint32_t k = 0; k < batch->points; k++) {
        uint32_t l = source[order[k]];
        to->r[k] = from->r[l];
        to->g[k] = from->g[l];
        to->b[k] = from->b[l];
        to->path_key[k] = from->path_key[l];
    }
    const uint32_t *bounce = from->bounce, *slot = from->slot, n = batch->points;
    uint32_t *to_bounce = to->bounce, *to_slot = to->slot;
    MCR_LANES
    for (uint32_t k = 0; k < n; k++) {
        uint32_t l = source[order[k]];
        to_bounce[k] = bounce[l];
        to_slot[k] = slot[l];
    }
    if (batch->core->needs_samples)
        for (uint32_t k = 0; k < batch->points; k++) {
            uint32_t l = source[order[k]];
            to->pixel_key[k] = from->pixel_key[l];
            to->index[k] = from->index[l];
            to->planned[k] = from->planned[l];
        }
    if (batch->core->needs_pixel)
        for (uint32_t k = 0; k < batch->points; k++) {
            uint32_t l = source[order[k]];
            to->x[k] = from->x[l];
            to->y[k] = from->y[l];
        }
}

/* Newton's step onto |A (p - c)| = 1, A the inverse of the half axes, and the normal of that level set. */
static void ellipsoid_point(const struct mcr_accel_shape *shape, const struct mcr_surface_points *at, uint32_t k)
{
    const double *m = shape->k;
    double q[3] = {at->px[k] - m[0], at->py[k] - m[1], at->pz[k] - m[2]}, local[3], n[3];
    for (int i = 0; i < 3; i++)
        local[i] = m[3 + 3 * i] * q[0] + m[4 + 3 * i] * q[1] + m[5 + 3 * i] * q[2];
    for (int j = 0; j < 3; j++)
        n[j] = m[3 + j] * local[0] + m[6 + j] * local[1] + m[9 + j] * local[2];
    double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    double step = (local[0] * local[0] + local[1] * local[1] + local[2] * local[2] - 1) / (2 * square);
    double inverse = 1 / sqrt(square), side = n[0] * at->ox[k] + n[1] * at->oy[k] + n[2] * at->oz[k] > 0 ? 1.0 : -1.0;
    at->px[k] -= step * n[0];
    at->py[k] -= step * n[1];
    at->pz[k] -= step * n[2];
    at->side[k] = side;
    at->gx[k] = side * n[0] * inverse;
    at->gy[k] = side * n[1] * inverse;
    at->gz[k] = side * n[2] * inverse;
}

/* The normal interpolated from the corners by the areas that the point spans with the opposite edges; kept on the geometric normal's side. */
static void smooth_normal(const struct mcr_triangles *m, uint32_t f, const struct mcr_surface_points *at, uint32_t k)
{
    const uint32_t *v = m->vertex[f], *w = m->normal[f];
    if (w[0] == UINT32_MAX)
        return;
    double corner[3][3], weight[3], n[3] = {0, 0, 0}, g[3] = {at->gx[k], at->gy[k], at->gz[k]};
    for (int i = 0; i < 3; i++) {
        corner[i][0] = m->x[v[i]] - at->px[k];
        corner[i][1] = m->y[v[i]] - at->py[k];
        corner[i][2] = m->z[v[i]] - at->pz[k];
    }
    for (int i = 0; i < 3; i++) {
        const double *a = corner[(i + 1) % 3], *b = corner[(i + 2) % 3];
        weight[i] = g[0] * (a[1] * b[2] - a[2] * b[1]) + g[1] * (a[2] * b[0] - a[0] * b[2]) + g[2] * (a[0] * b[1] - a[1] * b[0]);
        weight[i] *= at->side[k];
        weight[i] = weight[i] > 0 ? weight[i] : 0;
    }
    for (int i = 0; i < 3; i++) {
        n[0] += weight[i] * m->nx[w[i]];
        n[1] += weight[i] * m->ny[w[i]];
        n[2] += weight[i] * m->nz[w[i]];
    }
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    double sign = n[0] * g[0] + n[1] * g[1] + n[2] * g[2] < 0 ? -1.0 : 1.0;
    if (!(length > 0))
        return;
    at->nx[k] = sign * n[0] / length;
    at->ny[k] = sign * n[1] / length;
    at->nz[k] = sign * n[2] / length;
}

/* Without smooth triangles the shading normals are the geometric ones: the same arrays (batch.c). */
static void smooth_normals(struct mcr_batch *batch)
{
    const struct mcr_triangles *triangles = &batch->core->scene->triangles;
    const struct mcr_surface_points *at = &batch->at;
    memcpy(at->nx, at->gx, batch->points * sizeof *at->nx);
    memcpy(at->ny, at->gy, batch->points * sizeof *at->ny);
    memcpy(at->nz, at->gz, batch->points * sizeof *at->nz);
    for (uint32_t k = 0; k < batch->points; k++)
        if (at->primitive[k] >= triangles->first_primitive)
            smooth_normal(triangles, (uint32_t)(at->primitive[k] - triangles->first_primitive), at, k);
}

void MCR_ISA_NAME(mcr_stage_gather)(uint32_t n, const uint32_t *index, const double *table, double *out)
{
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        out[i] = table[index[i]];
}

void MCR_ISA_NAME(mcr_stage_surface)(struct mcr_batch *batch)
{
    const struct mcr_surfaces *s = &batch->core->surfaces;
    if (s->round)
        points(batch, 1);
    else
        points(batch, 0);
    identities(batch);
    states(batch);
    if (s->quadric)
        for (uint32_t k = 0; k < batch->points; k++)
            if (s->quadric[batch->at.primitive[k]] != UINT32_MAX)
                ellipsoid_point(&batch->core->accel->shape[s->quadric[batch->at.primitive[k]]], &batch->at, k);
    if (s->smooth)
        smooth_normals(batch);
}
