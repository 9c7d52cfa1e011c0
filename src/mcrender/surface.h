/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mcrender plugin interface: helpers for materials. Vectors and frames at a surface point, inputs and tangents as arrays over the lanes, and the
 * cosine lobe. Everything is compiled into the plugin.
 */
#ifndef MCRENDER_SURFACE_H
#define MCRENDER_SURFACE_H

#include <math.h>
#include <mcrender/material.h>
#include <mcrender/sampler.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Loops over lanes are functions of their own, so that the compiler believes `restrict`. */
#if defined(__GNUC__)
#define MCR_LOOP static __attribute__((noinline, unused))
#else
#define MCR_LOOP static
#endif

#define MCR_PER_PI 0.31830988618379067 /* 1 / pi */

/* What `create` returns for settings that cannot work together, with the reason. */
MCR_INLINE int32_t mcr_refuse(const struct mcr_host *host, struct mcr_context *context, const char *text)
{
    host->report(host, context, MCR_REPORT_ERROR, text);
    return MCR_E_INVALID;
}

/* Doubles to one array of scratch over n lanes: a multiple of 8 keeps every array aligned and padded. */
MCR_INLINE uint64_t mcr_padded(uint32_t n) { return ((uint64_t)n + 7) / 8 * 8; }

/* ---- vectors and frames ---- */

struct mcr_vector {
    double x, y, z;
};

/* Tangent, bitangent and normal: orthonormal and right-handed. */
struct mcr_frame {
    struct mcr_vector t, b, n;
};

MCR_INLINE struct mcr_vector mcr_vector(double x, double y, double z)
{
    struct mcr_vector v = {x, y, z};
    return v;
}

MCR_INLINE double mcr_dot(struct mcr_vector a, struct mcr_vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/* The frame of a normal and a tangent, both unit and orthogonal. */
MCR_INLINE struct mcr_frame mcr_frame(struct mcr_vector n, struct mcr_vector t)
{
    struct mcr_frame f;

    f.t = t;
    f.b = mcr_vector(n.y * t.z - n.z * t.y, n.z * t.x - n.x * t.z, n.x * t.y - n.y * t.x);
    f.n = n;
    return f;
}

/* Coordinates of the vector v in the frame. */
MCR_INLINE struct mcr_vector mcr_to_frame(struct mcr_frame f, struct mcr_vector v)
{
    return mcr_vector(mcr_dot(f.t, v), mcr_dot(f.b, v), mcr_dot(f.n, v));
}

/* The unit vector with these coordinates; one Newton step keeps its length. */
MCR_INLINE struct mcr_vector mcr_from_frame(struct mcr_frame f, struct mcr_vector l)
{
    struct mcr_vector v = mcr_vector(l.x * f.t.x + l.y * f.b.x + l.z * f.n.x, l.x * f.t.y + l.y * f.b.y + l.z * f.n.y,
                                     l.x * f.t.z + l.y * f.b.z + l.z * f.n.z);
    double fix = 0.5 * (1 - mcr_dot(v, v));

    return mcr_vector(v.x + v.x * fix, v.y + v.y * fix, v.z + v.z * fix);
}

/* ---- arrays over the lanes ---- */

MCR_LOOP void mcr_fill_lanes(uint32_t n, double value, double *restrict out)
{
    for (uint32_t i = 0; i < n; i++)
        out[i] = value;
}

/* Where rounding leaves no density, as close to index 1, nothing was drawn. */
MCR_LOOP void mcr_drop_lanes(uint32_t n, const double *restrict density, double *restrict x, double *restrict y, double *restrict z)
{
    for (uint32_t i = 0; i < n; i++) {
        int drawn = density[i] > 0;
        x[i] = drawn ? x[i] : 0;
        y[i] = drawn ? y[i] : 0;
        z[i] = drawn ? z[i] : 0;
    }
}

/* Channel c over n lanes: the host's array where it varies, else `room`, filled with its value. */
MCR_INLINE const double *mcr_input_lanes(const struct mcr_inputs *inputs, uint32_t c, uint32_t n, double *room)
{
    if (inputs->stride[c])
        return inputs->channel[c];
    mcr_fill_lanes(n, inputs->channel[c][0], room);
    return room;
}

MCR_LOOP void mcr_basis_lanes(uint32_t n, const double *nx, const double *ny, const double *nz, double *restrict x, double *restrict y,
                              double *restrict z)
{
    for (uint32_t i = 0; i < n; i++) {
        double bx, by, bz;
        mcr_basis(nx[i], ny[i], nz[i], &x[i], &y[i], &z[i], &bx, &by, &bz);
    }
}

/* The points' tangents; of a host that tells none those of mcr_basis, in `room`: 3 arrays. */
MCR_INLINE void mcr_tangent_lanes(const struct mcr_points *at, double *room, const double *tangent[3])
{
    int told = at->size >= offsetof(struct mcr_points, tz) + sizeof at->tz && at->tx;
    double *x = room, *y = x + mcr_padded(at->n), *z = y + mcr_padded(at->n);

    if (!told)
        mcr_basis_lanes(at->n, at->nx, at->ny, at->nz, x, y, z);
    tangent[0] = told ? at->tx : x;
    tangent[1] = told ? at->ty : y;
    tangent[2] = told ? at->tz : z;
}

MCR_LOOP void mcr_index_lanes_(uint32_t n, const double *index, const double *side, const double *here, const double *beyond, int thin,
                               double *restrict ratio)
{
    if (here && thin)
        for (uint32_t i = 0; i < n; i++)
            ratio[i] = index[i] / here[i];
    else if (here)
        for (uint32_t i = 0; i < n; i++)
            ratio[i] = beyond[i] / here[i];
    else if (thin)
        for (uint32_t i = 0; i < n; i++)
            ratio[i] = index[i];
    else
        for (uint32_t i = 0; i < n; i++) {
            double inverse = 1 / index[i];
            ratio[i] = side[i] > 0 ? index[i] : inverse;
        }
}

/*
 * The index of refraction on the other side over that on the side of the outgoing direction: what the host tells, else that of a material of this index
 * behind the front side and of nothing before it. Of a thin wall: the wall's over that of its surroundings.
 */
MCR_INLINE void mcr_ratio_lanes(const struct mcr_points *at, const double *index, int thin, double *ratio)
{
    int told = at->size >= offsetof(struct mcr_points, beyond) + sizeof at->beyond && at->here && at->beyond;
    mcr_index_lanes_(at->n, index, at->side, told ? at->here : NULL, told ? at->beyond : NULL, thin, ratio);
}

/* ---- the cosine lobe: f = albedo / pi over the hemisphere of the outgoing direction ---- */

/* cos / pi where the direction is above the shading normal's and the geometric normal's horizon, else 0; times one albedo for all. */
MCR_LOOP void mcr_cosine_lanes_(const struct mcr_points *at, const double *restrict nx, const double *restrict ny, const double *restrict nz,
                                const double *restrict x, const double *restrict y, const double *restrict z, const double albedo[3],
                                double *restrict r, double *restrict g, double *restrict b)
{
    const double *gx = at->gx, *gy = at->gy, *gz = at->gz;
    double red = albedo[0], green = albedo[1], blue = albedo[2];

    for (uint32_t i = 0; i < at->n; i++) {
        double cosine = nx[i] * x[i] + ny[i] * y[i] + nz[i] * z[i];
        double above = gx[i] * x[i] + gy[i] * y[i] + gz[i] * z[i];
        double f = cosine > 0 ? cosine * MCR_PER_PI : 0;
        f = above > 0 ? f : 0;
        r[i] = red * f;
        g[i] = green * f;
        b[i] = blue * f;
    }
}

MCR_LOOP void mcr_multiply_lanes(uint32_t n, const double *restrict channel, uint32_t stride, double *restrict out)
{
    if (stride)
        for (uint32_t i = 0; i < n; i++)
            out[i] *= channel[i];
    else
        for (uint32_t i = 0; i < n; i++)
            out[i] *= channel[0];
}

/*
 * `evaluate` of a diffuse surface, its albedo being channels first .. first + 2. One pass where the albedo is the same in all lanes; else a pass with
 * albedo 1 and one for each channel: both give albedo * f.
 */
MCR_LOOP void mcr_cosine_evaluate(const struct mcr_inputs *inputs, uint32_t first, const struct mcr_points *at, const struct mcr_directions *toward,
                                  const struct mcr_colours *out)
{
    const double *const *channel = inputs->channel + first;
    const uint32_t *stride = inputs->stride + first;
    double albedo[3] = {1, 1, 1};
    int same = !(stride[0] | stride[1] | stride[2]);

    for (uint32_t c = 0; c < 3 && same; c++)
        albedo[c] = channel[c][0];
    mcr_cosine_lanes_(at, at->nx, at->ny, at->nz, toward->x, toward->y, toward->z, albedo, out->r, out->g, out->b);
    if (same)
        return;
    mcr_multiply_lanes(at->n, channel[0], stride[0], out->r);
    mcr_multiply_lanes(at->n, channel[1], stride[1], out->g);
    mcr_multiply_lanes(at->n, channel[2], stride[2], out->b);
}

/* The density of directions in proportion to the cosine: x, y and z are their arrays. */
MCR_LOOP void mcr_cosine_density(uint32_t n, const double *restrict nx, const double *restrict ny, const double *restrict nz,
                                 const double *restrict x, const double *restrict y, const double *restrict z, double *restrict density)
{
    for (uint32_t i = 0; i < n; i++) {
        double cosine = nx[i] * x[i] + ny[i] * y[i] + nz[i] * z[i];
        density[i] = cosine > 0 ? cosine * MCR_PER_PI : 0;
    }
}

/* Draws in proportion to the cosine. A direction that rounding puts on the horizon or below is not drawn. */
MCR_LOOP void mcr_cosine_draw(uint32_t n, const double *restrict nx, const double *restrict ny, const double *restrict nz, const double *restrict u,
                              const double *restrict v, double *restrict x, double *restrict y, double *restrict z)
{
    for (uint32_t i = 0; i < n; i++) {
        double lx, ly, wx, wy, wz, height = sqrt(mcr_disk_from_square(u[i], v[i], &lx, &ly));

        mcr_to_world(nx[i], ny[i], nz[i], lx, ly, height, &wx, &wy, &wz);
        int above = nx[i] * wx + ny[i] * wy + nz[i] * wz > 0;
        x[i] = above ? wx : 0;
        y[i] = above ? wy : 0;
        z[i] = above ? wz : 0;
    }
}

/* `albedo` of a surface of which that is one colour: channels first .. first + 2. */
MCR_LOOP void mcr_colour_lanes(uint32_t n, const struct mcr_inputs *inputs, uint32_t first, const struct mcr_colours *out)
{
    double *result[3] = {out->r, out->g, out->b};

    for (uint32_t c = 0; c < 3; c++) {
        mcr_fill_lanes(n, 1, result[c]);
        mcr_multiply_lanes(n, inputs->channel[first + c], inputs->stride[first + c], result[c]);
    }
}

#ifdef __cplusplus
}
#endif

#endif
