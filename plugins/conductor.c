/* SPDX-License-Identifier: Apache-2.0 */
/*
 * conductor: a metal of GGX microfacets, on both sides. f cos = F D G2 / (4 cos_o): D of Trowbridge and Reitz, "Average irregularity representation of
 * a rough surface for ray reflection" (1975), as in Walter et al., "Microfacet models for refraction through rough surfaces" (2007); G2 is Smith's
 * shadowing and masking correlated by height, Heitz, "Understanding the masking-shadowing function in microfacet-based BRDFs" (2014), section 6.
 * Light that meets more than one microfacet is lost: a rough white metal is a few ten per cent too dark.
 *
 * Directions are drawn by the normals that the outgoing direction sees, as a spherical cap: Dupuy and Benyoub, "Sampling visible GGX normals with
 * spherical caps" (2023). Of those, a share is reflected below the horizon and not drawn: there the density integrates to less than 1.
 *
 * All is written in the normal's slope, so that nothing cancels or overflows down to LEAST, which is a lobe of 1e-7 rad: unit vectors in doubles tell
 * such a slope to about 1e-9 of it. Below, the surface is a mirror and no density serves it.
 */
#include <math.h>
#include <mcrender/material.h>
#include <mcrender/sampler.h>

#define LEAST 1e-7     /* the smallest alpha: the host keeps to the range */
#define HORIZON 1e-100 /* cosines below count as 0, so that no product of two underflows */
#define PI 3.1415926535897932

/* Parameters, in the order of the table. */
enum { METAL, REFLECTANCE, ETA, K, ROUGHNESS, PARAMETERS };
#define CHANNEL(parameter) (3 * (parameter))

/* The words of `metal`. */
enum { BY_REFLECTANCE, BY_INDEX, GOLD, SILVER, COPPER, ALUMINIUM, METALS };

/*
 * eta and k at 611, 549 and 464 nm, the dominant wavelengths of the Rec. 709 primaries, interpolated linearly between the measurements. Gold, silver,
 * copper: Johnson and Christy, "Optical constants of the noble metals", Phys. Rev. B 6, 4370 (1972). Aluminium: Rakic, "Algorithm for the determination
 * of intrinsic optical constants of metal films", Appl. Opt. 34, 4755 (1995). Both as tabulated by refractiveindex.info (CC0).
 */
static const double preset[METALS][2][3] = {
    [GOLD] = {{0.2234, 0.4283, 1.3353}, {3.2036, 2.4599, 1.8725}},
    [SILVER] = {{0.0583, 0.0599, 0.0464}, {4.1029, 3.5892, 2.7925}},
    [COPPER] = {{0.3669, 1.0162, 1.2464}, {3.1213, 2.5785, 2.4520}},
    [ALUMINIUM] = {{1.3195, 1.0109, 0.6825}, {7.3068, 6.6157, 5.6230}},
};

static const struct mcr_parameter parameters[PARAMETERS] = {
    [METAL] = {.size = sizeof(struct mcr_parameter),
               .type = MCR_TYPE_CHOICE,
               .name = "metal",
               .unit = "",
               .choices = "reflectance|index|gold|silver|copper|aluminium",
               .summary = "What gives the colour: `reflectance`, the `index` eta + i k, or the measured index of a metal.",
               .fallback = {BY_REFLECTANCE}},
    [REFLECTANCE] = {.size = sizeof(struct mcr_parameter),
                     .type = MCR_TYPE_COLOUR,
                     .flags = MCR_PARAMETER_VARYING,
                     .name = "reflectance",
                     .unit = "",
                     .summary = "With `metal reflectance`: reflectance at normal incidence, rising to 1 at grazing incidence as Schlick has it.",
                     .fallback = {0.9, 0.9, 0.9},
                     .min = 0,
                     .max = 1},
    [ETA] = {.size = sizeof(struct mcr_parameter),
             .type = MCR_TYPE_COLOUR,
             .flags = MCR_PARAMETER_VARYING,
             .name = "eta",
             .unit = "",
             .summary = "With `metal index`: the real part of the index of refraction, relative to the medium outside.",
             .fallback = {1, 1, 1},
             .min = 0,
             .max = 1e6},
    [K] = {.size = sizeof(struct mcr_parameter),
           .type = MCR_TYPE_COLOUR,
           .flags = MCR_PARAMETER_VARYING,
           .name = "k",
           .unit = "",
           .summary = "With `metal index`: the imaginary part of the index of refraction, by which the metal absorbs.",
           .fallback = {5, 5, 5},
           .min = 0,
           .max = 1e6},
    [ROUGHNESS] = {.size = sizeof(struct mcr_parameter),
                   .type = MCR_TYPE_NUMBER,
                   .flags = MCR_PARAMETER_VARYING,
                   .name = "roughness",
                   .unit = "",
                   .summary = "The alpha of GGX, the width of the slopes' distribution: not the square root of it that some programs ask for.",
                   .fallback = {0.2},
                   .min = LEAST,
                   .max = 1},
};

static int32_t refuse(const struct mcr_host *host, struct mcr_context *context, const char *text)
{
    host->report(host, context, MCR_REPORT_ERROR, text);
    return MCR_E_INVALID;
}

/* What would be ignored is a mistake. */
static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    const uint32_t *given = with->values->given;
    uint32_t metal = (uint32_t)with->values->number[CHANNEL(METAL)];

    *instance = NULL;
    if (given[REFLECTANCE] && metal != BY_REFLECTANCE)
        return refuse(host, context, "'reflectance' has no effect with this 'metal': it belongs to 'metal reflectance', the default");
    if ((given[ETA] || given[K]) && metal != BY_INDEX)
        return refuse(host, context, "'eta' and 'k' have no effect without 'metal index'");
    return MCR_OK;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    (void)host, (void)context, (void)instance, (void)values;
    traits->does = MCR_MATERIAL_REFLECTS;
    return MCR_OK;
}

/* Doubles to one array of scratch: a multiple of 8 keeps every array aligned and padded. */
static uint64_t padded(uint32_t n)
{
    return ((uint64_t)n + 7) / 8 * 8;
}

static uint64_t scratch_bytes(const void *instance, uint32_t n)
{
    (void)instance;
    return 4 * padded(n) * sizeof(double);
}

/* ---- Fresnel ---- */

/*
 * Reflectance of unpolarised light at the cosine c in (0, 1] for the index eta + i k. With eta^2 - k^2 - sin^2 + 2i eta k = (a + i b)^2: parallel and
 * perpendicular part as quotients of squares, which do not cancel; of a^2 and b^2 the smaller comes from the product a b = eta k.
 */
MCR_INLINE double fresnel_index(double c, double eta, double k)
{
    double s2 = (1 - c) * (1 + c), t = eta * eta - k * k - s2, ab = eta * k;
    double modulus = sqrt(t * t + 4 * ab * ab), larger = 0.5 * (modulus + fabs(t)), smaller = ab * ab / (larger > 0 ? larger : 1);
    double a2 = t > 0 ? larger : smaller, b2 = t > 0 ? smaller : larger, a = sqrt(a2);
    double across = ((a - c) * (a - c) + b2) / ((a + c) * (a + c) + b2);
    double minus = a * c - s2, plus = a * c + s2, below = plus * plus + b2 * c * c;
    double ratio = (minus * minus + b2 * c * c) / (below > 0 ? below : 1);

    ratio = below > 0 ? ratio : 1; /* 0/0 for eta = k = 0 at c = 1 alone: a perfect mirror */
    return 0.5 * (across + across * ratio);
}

/* Schlick, "An inexpensive BRDF model for physically-based rendering" (1994). */
MCR_INLINE double fresnel_schlick(double c, double reflectance)
{
    double m = 1 - c, m2 = m * m;
    return reflectance + (1 - reflectance) * (m2 * m2 * m);
}

/* out = shape * F(cosine). The index of lane i is at i * stride; a negative k says that eta holds a reflectance. */
static void fresnel_lanes(uint32_t n, const double *restrict shape, const double *restrict cosine, const double *restrict eta,
                          const double *restrict k, uint32_t stride, double *restrict out)
{
    if (stride)
        for (uint32_t i = 0; i < n; i++) {
            double by_index = fresnel_index(cosine[i], eta[i], k[i]), by_colour = fresnel_schlick(cosine[i], eta[i]);
            out[i] = shape[i] * (k[i] < 0 ? by_colour : by_index);
        }
    else if (k[0] < 0)
        for (uint32_t i = 0; i < n; i++)
            out[i] = shape[i] * fresnel_schlick(cosine[i], eta[0]);
    else
        for (uint32_t i = 0; i < n; i++)
            out[i] = shape[i] * fresnel_index(cosine[i], eta[0], k[0]);
}

/* The index of channel c in n lanes, as fresnel_lanes wants it. */
static void index_lanes(uint32_t n, const struct mcr_inputs *inputs, uint32_t c, double *restrict eta, double *restrict k)
{
    const uint32_t *s = inputs->stride;
    const double *const *in = inputs->channel;
    const uint32_t at_metal = CHANNEL(METAL), at_colour = CHANNEL(REFLECTANCE) + c, at_eta = CHANNEL(ETA) + c, at_k = CHANNEL(K) + c;

    for (uint32_t i = 0; i < n; i++) {
        uint32_t metal = (uint32_t)in[at_metal][i * s[at_metal]];
        if (metal == BY_REFLECTANCE)
            eta[i] = in[at_colour][i * s[at_colour]], k[i] = -1;
        else if (metal == BY_INDEX)
            eta[i] = in[at_eta][i * s[at_eta]], k[i] = in[at_k][i * s[at_k]];
        else
            eta[i] = preset[metal][0][c], k[i] = preset[metal][1][c];
    }
}

/* ---- Microfacets ---- */

struct facet {
    double out, in; /* cosines of both directions to the shading normal */
    double d;       /* D of the half vector, 1/sr */
    double cosine;  /* between the half vector and either direction */
    int above;      /* whether both directions are above the horizon */
};

/*
 * With h = o + w, the part of it along the normal and the square of the part across: the slope of the microfacet that reflects o to w is across / along.
 * Symmetric in o and w to the last bit.
 */
MCR_INLINE struct facet facet_of(double alpha, double nx, double ny, double nz, double ox, double oy, double oz, double x, double y, double z)
{
    struct facet f;
    double out = nx * ox + ny * oy + nz * oz, in = nx * x + ny * y + nz * z, along = out + in;
    double ax = (ox + x) - along * nx, ay = (oy + y) - along * ny, az = (oz + z) - along * nz;
    double across2 = ax * ax + ay * ay + az * az, along2 = along * along, length2 = along2 + across2;
    int above = (out > HORIZON) & (in > HORIZON);
    double inverse = 1 / (above ? length2 : 1.0), q = (alpha * alpha * along2 + across2) * inverse, half = 0.5 * sqrt(length2);

    f.out = out;
    f.in = in;
    f.d = alpha * alpha / (PI * q * q);
    half = half < 1 ? half : 1;
    f.cosine = half > HORIZON ? half : HORIZON; /* both selects do nothing but at opposite and equal directions */
    f.above = above;
    return f;
}

/* sqrt(cos^2 + alpha^2 sin^2): in Smith's terms, cos (1 + 2 Lambda). */
MCR_INLINE double spread(double alpha, double cosine)
{
    double a2 = alpha * alpha;
    return sqrt(a2 + (1 - a2) * cosine * cosine);
}

/* f cos without Fresnel, which is D G2 / (4 cos_o), and the cosine for Fresnel; 0 below either horizon. */
MCR_INLINE void shape_lane(double alpha, double nx, double ny, double nz, double gx, double gy, double gz, double ox, double oy, double oz, double x,
                           double y, double z, double *shape, double *cosine)
{
    struct facet f = facet_of(alpha, nx, ny, nz, ox, oy, oz, x, y, z);
    double below = f.in * spread(alpha, f.out) + f.out * spread(alpha, f.in), geometric = gx * x + gy * y + gz * z;
    double value = f.d * f.in / (2 * below);

    value = f.above ? value : 0;
    *shape = geometric > 0 ? value : 0;
    *cosine = f.cosine;
}

static void shape_lanes(const struct mcr_points *at, const double *restrict x, const double *restrict y, const double *restrict z,
                        const double *restrict alpha, uint32_t stride, double *restrict shape, double *restrict cosine)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double same = alpha[0];

    if (stride)
        for (uint32_t i = 0; i < at->n; i++)
            shape_lane(alpha[i], nx[i], ny[i], nz[i], gx[i], gy[i], gz[i], ox[i], oy[i], oz[i], x[i], y[i], z[i], &shape[i], &cosine[i]);
    else
        for (uint32_t i = 0; i < at->n; i++)
            shape_lane(same, nx[i], ny[i], nz[i], gx[i], gy[i], gz[i], ox[i], oy[i], oz[i], x[i], y[i], z[i], &shape[i], &cosine[i]);
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    double *shape = host->scratch(host, context), *cosine = shape + padded(at->n), *eta = cosine + padded(at->n), *k = eta + padded(at->n);
    double *channel[3] = {out->r, out->g, out->b};
    const uint32_t *s = inputs->stride;

    (void)instance;
    shape_lanes(at, toward->x, toward->y, toward->z, inputs->channel[CHANNEL(ROUGHNESS)], s[CHANNEL(ROUGHNESS)], shape, cosine);
    for (uint32_t c = 0; c < 3; c++) {
        uint32_t varies = s[CHANNEL(METAL)] | s[CHANNEL(REFLECTANCE) + c] | s[CHANNEL(ETA) + c] | s[CHANNEL(K) + c];

        index_lanes(varies ? at->n : 1, inputs, c, eta, k);
        fresnel_lanes(at->n, shape, cosine, eta, k, varies, channel[c]);
    }
    return MCR_OK;
}

/* ---- Sampling ---- */

/* G1(o) D / (4 cos_o), the density of visible normals over that of reflected directions. */
MCR_INLINE double density_lane(double alpha, double nx, double ny, double nz, double ox, double oy, double oz, double x, double y, double z)
{
    struct facet f = facet_of(alpha, nx, ny, nz, ox, oy, oz, x, y, z);
    double value = f.d / (2 * (f.out + spread(alpha, f.out)));

    return f.above ? value : 0;
}

static void density_lanes(const struct mcr_points *at, const double *restrict x, const double *restrict y, const double *restrict z,
                          const double *restrict alpha, uint32_t stride, double *restrict density)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double same = alpha[0];

    if (stride)
        for (uint32_t i = 0; i < at->n; i++)
            density[i] = density_lane(alpha[i], nx[i], ny[i], nz[i], ox[i], oy[i], oz[i], x[i], y[i], z[i]);
    else
        for (uint32_t i = 0; i < at->n; i++)
            density[i] = density_lane(same, nx[i], ny[i], nz[i], ox[i], oy[i], oz[i], x[i], y[i], z[i]);
}

/*
 * In a frame with the normal as z: squeezed by alpha, the surface's normals are those of a hemisphere and o becomes the unit vector w. A point of the
 * spherical cap z > -w.z, uniform in area, plus w is a visible normal of the hemisphere; stretched back, one of the surface. The cap's point at a disk's
 * radius r is at height 1 - r^2 (1 + w.z), so that the sum has the height (1 + w.z)(1 - r^2), which is exact at both ends.
 */
MCR_INLINE void reflect_lane(double alpha, double ox, double oy, double oz, double u, double v, double *x, double *y, double *z)
{
    double qx = alpha * ox, qy = alpha * oy, length = 1 / sqrt(qx * qx + qy * qy + oz * oz);
    double wx = qx * length, wy = qy * length, wz = oz * length < 1 ? oz * length : 1;
    double px, py, rest = mcr_disk_from_square(u, v, &px, &py), p = 1 + wz, s = sqrt(p * (2 - (1 - rest) * p));
    double mx = alpha * (px * s + wx), my = alpha * (py * s + wy), mz = p * rest;
    double m2 = mx * mx + my * my + mz * mz, twice = 2 * (ox * mx + oy * my + oz * mz) / (m2 > 0 ? m2 : 1);

    *x = twice * mx - ox;
    *y = twice * my - oy;
    *z = twice * mz - oz;
}

MCR_INLINE void draw_lane(double alpha, double nx, double ny, double nz, double ox, double oy, double oz, double u, double v, double *x, double *y,
                          double *z)
{
    double tx, ty, tz, bx, by, bz, lx, ly, lz, wx, wy, wz, out = nx * ox + ny * oy + nz * oz;
    int visible = out > HORIZON;

    mcr_basis(nx, ny, nz, &tx, &ty, &tz, &bx, &by, &bz);
    reflect_lane(alpha, tx * ox + ty * oy + tz * oz, bx * ox + by * oy + bz * oz, visible ? out : 1, u, v, &lx, &ly, &lz);
    mcr_to_world(nx, ny, nz, lx, ly, lz, &wx, &wy, &wz);
    int above = visible & (nx * wx + ny * wy + nz * wz > HORIZON);
    *x = above ? wx : 0;
    *y = above ? wy : 0;
    *z = above ? wz : 0;
}

static void draw_lanes(const struct mcr_points *at, const double *restrict alpha, uint32_t stride, const double *restrict u,
                       const double *restrict v, double *restrict x, double *restrict y, double *restrict z)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double same = alpha[0];

    if (stride)
        for (uint32_t i = 0; i < at->n; i++)
            draw_lane(alpha[i], nx[i], ny[i], nz[i], ox[i], oy[i], oz[i], u[i], v[i], &x[i], &y[i], &z[i]);
    else
        for (uint32_t i = 0; i < at->n; i++)
            draw_lane(same, nx[i], ny[i], nz[i], ox[i], oy[i], oz[i], u[i], v[i], &x[i], &y[i], &z[i]);
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    const double *alpha = inputs->channel[CHANNEL(ROUGHNESS)];
    uint32_t stride = inputs->stride[CHANNEL(ROUGHNESS)];

    (void)host, (void)context, (void)instance;
    draw_lanes(at, alpha, stride, number[0], number[1], out->x, out->y, out->z);
    if (density)
        density_lanes(at, out->x, out->y, out->z, alpha, stride, density);
    return MCR_OK;
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)host, (void)context, (void)instance;
    density_lanes(at, toward->x, toward->y, toward->z, inputs->channel[CHANNEL(ROUGHNESS)], inputs->stride[CHANNEL(ROUGHNESS)], density);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin),
             .kind = MCR_KIND_MATERIAL,
             .isa = MCR_ISA,
             .parameter_count = PARAMETERS,
             .name = "conductor",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "rough metal: GGX microfacets with a complex index of refraction, two-sided",
             .parameters = parameters},
    .flags = MCR_MATERIAL_STATELESS,
    .create = create,
    .traits = traits,
    .scratch_bytes = scratch_bytes,
    .evaluate = evaluate,
    .draw = draw,
    .density = density,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
