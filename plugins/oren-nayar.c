/* SPDX-License-Identifier: Apache-2.0 */
/*
 * oren-nayar: a rough diffuse surface, on both sides, as in "EON: A practical energy-preserving rough diffuse BRDF", Portsmouth, Kutz and Hill (2024).
 * Single scattering is Fujii's improved form of Oren and Nayar, "Generalization of Lambert's reflectance model" (1994); the light that it loses comes
 * back as a lobe of the Kulla-Conty kind, with its exact directional albedo E: with albedo 1 nothing is lost, and the model is reciprocal.
 *
 *     f = albedo / pi  A (1 + sigma s / t)  +  m / pi  (1 - E(o)) (1 - E(i)) / (1 - <E>)         A = 1 / (1 + C1 sigma)
 *     s = i.o - cos_i cos_o      t = max(cos_i, cos_o) where s > 0, else 1      E = A (1 + sigma g)      <E> = A (1 + C2 sigma)
 *     m = albedo^2 <E> / (1 - albedo (1 - <E>))      1 - E = A sigma (C1 - g)      1 - <E> = A sigma (C1 - C2)
 *
 * g(cos) is G / pi of the paper; C1 = g(0) = 1/2 - 2/(3 pi), C2 = 2/3 - 28/(15 pi) its mean. In this form nothing cancels as sigma goes to 0.
 */
#include <math.h>
#include <mcrender/material.h>
#include <mcrender/sampler.h>

#define PER_PI 0.31830988618379067     /* 1 / pi */
#define PER_TWO_PI 0.15915494309189535 /* 1 / (2 pi) */
#define C1 0.28779340921080622
#define C2 0.07248821245692408
#define TINY 1e-100                    /* cosines below do not divide, lest the quotient overflow */
#define PER_REST 4.6445697320678774    /* 1 / (C1 - C2) */

enum { ALBEDO, SIGMA, PARAMETERS };
#define CHANNEL(parameter) (3 * (parameter))

static const struct mcr_parameter parameters[PARAMETERS] = {
    [ALBEDO] = {.size = sizeof(struct mcr_parameter),
                .type = MCR_TYPE_COLOUR,
                .flags = MCR_PARAMETER_VARYING,
                .name = "albedo",
                .unit = "",
                .summary = "Share of the light at one microfacet that is scattered; of all light somewhat less, but for 0 and 1.",
                .fallback = {0.5, 0.5, 0.5},
                .min = 0,
                .max = 1},
    [SIGMA] = {.size = sizeof(struct mcr_parameter),
               .type = MCR_TYPE_NUMBER,
               .flags = MCR_PARAMETER_VARYING,
               .name = "sigma",
               .unit = "",
               .summary = "Roughness, from 0, which is lambert, to 1, which is about as bright at its rim as in its middle; no angle.",
               .fallback = {0.5},
               .min = 0,
               .max = 1},
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    (void)host, (void)context, (void)with;
    *instance = NULL;
    return MCR_OK;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    (void)host, (void)context, (void)instance, (void)values;
    traits->does = MCR_MATERIAL_REFLECTS;
    return MCR_OK;
}

static uint64_t padded(uint32_t n)
{
    return ((uint64_t)n + 7) / 8 * 8;
}

static uint64_t scratch_bytes(const void *instance, uint32_t n)
{
    (void)instance;
    return 2 * padded(n) * sizeof(double);
}

/*
 * C1 - g(c) >= 0 for a cosine c in [0, 1], with s = sin and t the angle: pi g = s (t - s c) + 2/3 s (c (1 + s + s^2) / (1 + s) - 1), which is the paper's G
 * with (1 - s^3) / c written out. The polynomial is t / sqrt(1 - c), interpolated at 17 Chebyshev nodes: relative error 1e-15.
 */
MCR_INLINE double lost(double c)
{
    double x = 2 * c - 1, p = 1.851111751086014e-10, one_minus = 1 - c, s = sqrt(one_minus * (1 + c)), g, rest;

    p = p * x - 6.081211523283149e-10;
    p = p * x + 1.2229492339493375e-09;
    p = p * x - 4.102044564899384e-09;
    p = p * x + 1.5257551778951588e-08;
    p = p * x - 5.197953798050399e-08;
    p = p * x + 1.7790703300266097e-07;
    p = p * x - 6.223317961744095e-07;
    p = p * x + 2.216039610288938e-06;
    p = p * x - 8.063600679357754e-06;
    p = p * x + 3.0187166843649764e-05;
    p = p * x - 0.0001174124943522419;
    p = p * x + 0.00048205410080041987;
    p = p * x - 0.00214913585971806;
    p = p * x + 0.011029313317973908;
    p = p * x - 0.0760160912346503;
    p = p * x + 1.480960979386122;
    g = s * (sqrt(one_minus) * p - s * c) + (2.0 / 3) * s * (c * (1 + s + s * s) / (1 + s) - 1);
    rest = C1 - g * PER_PI;
    return rest > 0 ? rest : 0;
}

MCR_INLINE double unit(double c)
{
    double positive = c > 0 ? c : 0;
    return positive < 1 ? positive : 1;
}

/* Both parts of f cos without the albedo, `once` and `more`; 0 below either horizon. An outgoing direction below the horizon counts as on it. */
MCR_INLINE void parts_lane(double sigma, double nx, double ny, double nz, double gx, double gy, double gz, double ox, double oy, double oz, double x,
                           double y, double z, double *once, double *more)
{
    double in = nx * x + ny * y + nz * z, out = unit(nx * ox + ny * oy + nz * oz), above = gx * x + gy * y + gz * z;
    double s = (x * ox + y * oy + z * oz) - in * out, larger = in > out ? in : out, a = 1 / (1 + C1 * sigma);
    double f = in > 0 ? in * PER_PI : 0;

    f = above > 0 ? f : 0;
    int divides = (s > 0) & (larger > TINY);
    s = s / (divides ? larger : 1.0);
    *once = f > 0 ? f * (a * (1 + sigma * s)) : 0;
    *more = f * (a * sigma * PER_REST * lost(unit(in)) * lost(out));
}

static void parts_lanes(const struct mcr_points *at, const double *restrict x, const double *restrict y, const double *restrict z,
                        const double *restrict sigma, uint32_t stride, double *restrict once, double *restrict more)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double same = sigma[0];

    if (stride)
        for (uint32_t i = 0; i < at->n; i++)
            parts_lane(sigma[i], nx[i], ny[i], nz[i], gx[i], gy[i], gz[i], ox[i], oy[i], oz[i], x[i], y[i], z[i], &once[i], &more[i]);
    else
        for (uint32_t i = 0; i < at->n; i++)
            parts_lane(same, nx[i], ny[i], nz[i], gx[i], gy[i], gz[i], ox[i], oy[i], oz[i], x[i], y[i], z[i], &once[i], &more[i]);
}

/* albedo * (once + more * albedo <E> / (1 - albedo (1 - <E>))) */
MCR_INLINE double colour_lane(double albedo, double sigma, double once, double more)
{
    double mean = (1 + C2 * sigma) / (1 + C1 * sigma);
    return albedo * (once + more * (albedo * mean / (1 - albedo * (1 - mean))));
}

static void colour_lanes(uint32_t n, const double *restrict once, const double *restrict more, const double *restrict albedo, uint32_t albedo_stride,
                         const double *restrict sigma, uint32_t sigma_stride, double *restrict out)
{
    if (albedo_stride | sigma_stride)
        for (uint32_t i = 0; i < n; i++)
            out[i] = colour_lane(albedo[i * albedo_stride], sigma[i * sigma_stride], once[i], more[i]);
    else
        for (uint32_t i = 0; i < n; i++)
            out[i] = colour_lane(albedo[0], sigma[0], once[i], more[i]);
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    double *once = host->scratch(host, context), *more = once + padded(at->n), *result[3] = {out->r, out->g, out->b};
    const double *sigma = inputs->channel[CHANNEL(SIGMA)];
    uint32_t stride = inputs->stride[CHANNEL(SIGMA)];

    (void)instance;
    parts_lanes(at, toward->x, toward->y, toward->z, sigma, stride, once, more);
    for (uint32_t c = 0; c < 3; c++)
        colour_lanes(at->n, once, more, inputs->channel[c], inputs->stride[c], sigma, stride, result[c]);
    return MCR_OK;
}

/* The directional albedo is albedo (E + (1 - E) albedo <E> / (1 - albedo (1 - <E>))): colour_lane of both parts' integrals. */
static void integral_lanes(const struct mcr_points *at, const double *restrict sigma, uint32_t stride, double *restrict once, double *restrict more)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        double s = sigma[i * stride], rest = s / (1 + C1 * s) * lost(unit(nx[i] * ox[i] + ny[i] * oy[i] + nz[i] * oz[i]));
        once[i] = 1 - rest;
        more[i] = rest;
    }
}

static int32_t albedo(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    double *once = host->scratch(host, context), *more = once + padded(at->n), *result[3] = {out->r, out->g, out->b};
    const double *sigma = inputs->channel[CHANNEL(SIGMA)];
    uint32_t stride = inputs->stride[CHANNEL(SIGMA)];

    (void)instance;
    integral_lanes(at, sigma, stride, once, more);
    for (uint32_t c = 0; c < 3; c++)
        colour_lanes(at->n, once, more, inputs->channel[c], inputs->stride[c], sigma, stride, result[c]);
    return MCR_OK;
}

/*
 * Drawn in proportion to the cosine, and with this chance uniformly: seen at grazing angles a rough surface has f cos far above the cosine near the
 * horizon, and the uniform share bounds f cos / density there.
 */
MCR_INLINE double uniform_share(double sigma, double out)
{
    return 0.5 * sigma * (1 - unit(out));
}

static void density_lanes(const struct mcr_points *at, const double *restrict x, const double *restrict y, const double *restrict z,
                          const double *restrict sigma, uint32_t stride, double *restrict density)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        double in = nx[i] * x[i] + ny[i] * y[i] + nz[i] * z[i];
        double share = uniform_share(sigma[i * stride], nx[i] * ox[i] + ny[i] * oy[i] + nz[i] * oz[i]);
        density[i] = in > 0 ? (1 - share) * (in * PER_PI) + share * PER_TWO_PI : 0;
    }
}

/* A point of the disk, uniform in area and at radius r, is raised to sqrt(1 - r^2), or moved out to the direction at height 1 - r^2. */
static void draw_lanes(const struct mcr_points *at, const double *restrict sigma, uint32_t stride, const double *restrict u, const double *restrict v,
                       const double *restrict choice, double *restrict x, double *restrict y, double *restrict z)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        double lx, ly, wx, wy, wz, rest = mcr_disk_from_square(u[i], v[i], &lx, &ly);
        double share = uniform_share(sigma[i * stride], nx[i] * ox[i] + ny[i] * oy[i] + nz[i] * oz[i]);
        double outward = sqrt(1 + rest), up = sqrt(rest);
        int uniform = choice[i] < share;

        lx = uniform ? lx * outward : lx;
        ly = uniform ? ly * outward : ly;
        mcr_to_world(nx[i], ny[i], nz[i], lx, ly, uniform ? rest : up, &wx, &wy, &wz);
        int above = nx[i] * wx + ny[i] * wy + nz[i] * wz > 0;
        x[i] = above ? wx : 0;
        y[i] = above ? wy : 0;
        z[i] = above ? wz : 0;
    }
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    const double *sigma = inputs->channel[CHANNEL(SIGMA)];
    uint32_t stride = inputs->stride[CHANNEL(SIGMA)];

    (void)host, (void)context, (void)instance;
    draw_lanes(at, sigma, stride, number[0], number[1], number[2], out->x, out->y, out->z);
    if (density)
        density_lanes(at, out->x, out->y, out->z, sigma, stride, density);
    return MCR_OK;
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)host, (void)context, (void)instance;
    density_lanes(at, toward->x, toward->y, toward->z, inputs->channel[CHANNEL(SIGMA)], inputs->stride[CHANNEL(SIGMA)], density);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin),
             .kind = MCR_KIND_MATERIAL,
             .isa = MCR_ISA,
             .parameter_count = PARAMETERS,
             .name = "oren-nayar",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "rough diffuse surface, energy-preserving (EON), two-sided",
             .parameters = parameters},
    .flags = MCR_MATERIAL_STATELESS,
    .create = create,
    .traits = traits,
    .scratch_bytes = scratch_bytes,
    .evaluate = evaluate,
    .draw = draw,
    .density = density,
    .albedo = albedo,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
