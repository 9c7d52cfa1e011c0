/* SPDX-License-Identifier: Apache-2.0 */
/*
 * uniform: directions with density 1 / (2 pi) over the hemisphere of the shading normal. A point of the unit disk, uniform in
 * area and at radius r, becomes the direction at height 1 - r^2: by Archimedes' theorem height and azimuth are uniform.
 */
#include <math.h>
#include <mcrender/sampler.h>

#define PER_TWO_PI 0.15915494309189535 /* 1 / (2 pi) */

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    *instance = NULL;
    return mcr_without_children(host, context, with);
}

static int32_t techniques(const struct mcr_host *host, struct mcr_context *context, const void *instance, struct mcr_technique *technique,
                          uint32_t *count)
{
    (void)host, (void)context, (void)instance;
    technique[0].kind = MCR_TECHNIQUE_DIRECTION;
    technique[0].covers = MCR_COVERS_REFLECTION;
    technique[0].continues = 1;
    technique[0].dimensions = 2;
    *count = 1;
    return MCR_OK;
}

/* The loops are functions of their own because gcc believes `restrict` of parameters only. */
static void density_lanes(uint32_t n, const double *restrict nx, const double *restrict ny, const double *restrict nz,
                          const double *restrict x, const double *restrict y, const double *restrict z, double *restrict density)
{
    for (uint32_t i = 0; i < n; i++) {
        double cosine = nx[i] * x[i] + ny[i] * y[i] + nz[i] * z[i];
        density[i] = cosine > 0 ? PER_TWO_PI : 0;
    }
}

/* A direction that rounding puts on the horizon or below is not drawn. */
static void draw_lanes(uint32_t n, const double *restrict nx, const double *restrict ny, const double *restrict nz, const double *restrict u,
                       const double *restrict v, double *restrict x, double *restrict y, double *restrict z)
{
    for (uint32_t i = 0; i < n; i++) {
        double lx, ly, wx, wy, wz, height = mcr_disk_from_square(u[i], v[i], &lx, &ly);
        double spread = sqrt(1 + height); /* (1 - height^2) / r^2 = 1 + height */

        mcr_to_world(nx[i], ny[i], nz[i], lx * spread, ly * spread, height, &wx, &wy, &wz);
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
    (void)host, (void)context, (void)instance, (void)technique;
    draw_lanes(at->n, at->nx, at->ny, at->nz, number[0], number[1], out->x, out->y, out->z);
    if (density)
        density_lanes(at->n, at->nx, at->ny, at->nz, out->x, out->y, out->z, density);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_directions_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_directions_plugin),
             .kind = MCR_KIND_DIRECTIONS,
             .isa = MCR_ISA,
             .name = "uniform",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "directions uniform over the hemisphere of the shading normal"},
    .create = create,
    .techniques = techniques,
    .draw = draw,
    .density = density,
};

MCR_PLUGIN(struct mcr_directions_plugin, descriptor);
