/* SPDX-License-Identifier: Apache-2.0 */
/*
 * cosine: directions with density cos / pi over the hemisphere of the shading normal. A point of the unit disk, uniform in area,
 * is raised to the hemisphere over it (Malley's method).
 *
 * compat: two mistakes of the founding study, which keep the density that the right way has, so that the picture is wrong. disk-polar: the point of
 * the disk has the radius u instead of sqrt(u) (its algorithm 4). sphere-spherical: the direction is that of the normal plus a point of its algorithm 5,
 * r (cos p sin t, sin p cos t, cos t) along the axes of the world, which is meant to lie in the unit sphere.
 */
#include <math.h>
#include <mcrender/sampler.h>

#define PER_PI 0.31830988618379067 /* 1 / pi */

/* The words of `compat`, which are the instances too. */
enum { NONE, DISK_POLAR, SPHERE_SPHERICAL, QUIRKS };
static const uint32_t quirks[QUIRKS] = {NONE, DISK_POLAR, SPHERE_SPHERICAL};

static const struct mcr_parameter parameters[] = {
    {.size = sizeof(struct mcr_parameter),
     .type = MCR_TYPE_CHOICE,
     .name = "compat",
     .unit = "",
     .choices = "none|disk-polar|sphere-spherical",
     .summary = "A mistake of the founding study to make, which biases the picture; where it is not set, what the render's `compat` names."},
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    *instance = (void *)(uintptr_t)&quirks[(uint32_t)with->values->number[0]];
    return mcr_without_children(host, context, with);
}

static int32_t techniques(const struct mcr_host *host, struct mcr_context *context, const void *instance, struct mcr_technique *technique,
                          uint32_t *count)
{
    (void)host, (void)context;
    technique[0].kind = MCR_TECHNIQUE_DIRECTION;
    technique[0].covers = MCR_COVERS_REFLECTION;
    technique[0].continues = 1;
    technique[0].dimensions = *(const uint32_t *)instance == SPHERE_SPHERICAL ? 3 : 2;
    *count = 1;
    return MCR_OK;
}

/* The loops are functions of their own because gcc believes `restrict` of parameters only. */
static void density_lanes(uint32_t n, const double *restrict nx, const double *restrict ny, const double *restrict nz,
                          const double *restrict x, const double *restrict y, const double *restrict z, double *restrict density)
{
    for (uint32_t i = 0; i < n; i++) {
        double cosine = nx[i] * x[i] + ny[i] * y[i] + nz[i] * z[i];
        density[i] = cosine > 0 ? cosine * PER_PI : 0;
    }
}

/* ---- compat: no loop here is fast ---- */

/* Cosine and sine of t turns, t in [0, 1): a quarter of the circle is a side of the square in mcr_disk_from_square. */
static void circle(double t, double *cosine, double *sine)
{
    uint32_t nearest = (uint32_t)(4 * t + 0.5), quarter = nearest & 3;
    double s = 2 * (4 * t - nearest);
    double a = quarter == 0 ? 1 : quarter == 1 ? -s : quarter == 2 ? -1 : s;
    double b = quarter == 0 ? s : quarter == 1 ? 1 : quarter == 2 ? -s : -1;

    mcr_disk_from_square((a + 1) / 2, (b + 1) / 2, cosine, sine);
}

static void polar_direction(const double n[3], double u, double v, double w[3])
{
    double cosine, sine;

    circle(v, &cosine, &sine);
    mcr_to_world(n[0], n[1], n[2], u * cosine, u * sine, sqrt((1 - u) * (1 + u)), &w[0], &w[1], &w[2]);
}

static void spherical_direction(const double n[3], double r, double u, double v, double w[3])
{
    double cos_t, sin_t, cos_p, sin_p, length;

    circle(u, &cos_t, &sin_t);
    circle(v, &cos_p, &sin_p);
    w[0] = n[0] + r * cos_p * sin_t;
    w[1] = n[1] + r * sin_p * cos_t;
    w[2] = n[2] + r * cos_t;
    length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (int k = 0; k < 3; k++)
        w[k] = length > 0 ? w[k] / length : 0;
}

static void draw_quirk(uint32_t quirk, const struct mcr_points *at, const double *const *number, const struct mcr_directions *out)
{
    for (uint32_t i = 0; i < at->n; i++) {
        double n[3] = {at->nx[i], at->ny[i], at->nz[i]}, w[3];

        if (quirk == DISK_POLAR)
            polar_direction(n, number[0][i], number[1][i], w);
        else
            spherical_direction(n, number[0][i], number[1][i], number[2][i], w);
        int above = n[0] * w[0] + n[1] * w[1] + n[2] * w[2] > 0;
        out->x[i] = above ? w[0] : 0;
        out->y[i] = above ? w[1] : 0;
        out->z[i] = above ? w[2] : 0;
    }
}

/* A direction that rounding puts on the horizon or below is not drawn. */
static void draw_lanes(uint32_t n, const double *restrict nx, const double *restrict ny, const double *restrict nz, const double *restrict u,
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

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)host, (void)context, (void)instance, (void)technique;
    density_lanes(at->n, at->nx, at->ny, at->nz, toward->x, toward->y, toward->z, density);
    return MCR_OK;
}

/* The density is that of the direction as it was stored: the same bits as from `density`. */
static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    uint32_t quirk = *(const uint32_t *)instance;

    (void)host, (void)context, (void)technique;
    if (quirk != NONE)
        draw_quirk(quirk, at, number, out);
    else
        draw_lanes(at->n, at->nx, at->ny, at->nz, number[0], number[1], out->x, out->y, out->z);
    if (density)
        density_lanes(at->n, at->nx, at->ny, at->nz, out->x, out->y, out->z, density);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_directions_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_directions_plugin),
             .kind = MCR_KIND_DIRECTIONS,
             .isa = MCR_ISA,
             .parameter_count = 1,
             .name = "cosine",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "directions in proportion to the cosine to the shading normal",
             .parameters = parameters},
    .create = create,
    .techniques = techniques,
    .draw = draw,
    .density = density,
};

MCR_PLUGIN(struct mcr_directions_plugin, descriptor);
