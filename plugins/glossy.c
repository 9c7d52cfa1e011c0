/* SPDX-License-Identifier: Apache-2.0 */
/*
 * glossy: a diffuse base under a clear dielectric coat, smooth (a mirror-like lobe) or of GGX microfacets, on both sides; plastic, varnish, polish.
 *
 *     f = coat + albedo / pi  (1 - E(o)) (1 - E(i)) / (n^2 (1 - albedo k))        k = 1 - (1 - <E>) / n^2
 *
 * E is the coat's directional albedo and < > a mean weighted by the cosine: what the coat does not reflect reaches the base and leaves it again, after any
 * number of reflections between base and coat, of which the coat keeps the share k (Egan and Hilgeman, "Optical properties of inhomogeneous materials",
 * 1979, equation 4.2): colours become deeper, white loses nothing, and f is reciprocal. A smooth coat has E of Fresnel's formulas; for a rough one
 * `create` integrates the mean of Fresnel's reflectance over visible normals at 14 x 16 Chebyshev nodes and keeps the polynomial through them, which
 * together with that of mcr_ggx_lost errs by less than 1e-3.
 */
#include <mcrender/math.h>
#include <mcrender/microfacet.h>
#include <stdlib.h>

enum { ALBEDO, INDEX, ROUGHNESS, PARAMETERS };
#define CHANNEL(parameter) (3 * (parameter))

static const struct mcr_parameter parameters[PARAMETERS] = {
    [ALBEDO] = {.size = sizeof(struct mcr_parameter),
                .type = MCR_TYPE_COLOUR,
                .flags = MCR_PARAMETER_VARYING,
                .name = "albedo",
                .unit = "",
                .summary = "Share of the light that the base scatters at once, without the coat.",
                .fallback = {0.5, 0.5, 0.5},
                .min = 0,
                .max = 1},
    [INDEX] = {.size = sizeof(struct mcr_parameter),
               .type = MCR_TYPE_NUMBER,
               .name = "index",
               .unit = "",
               .summary = "Index of refraction of the coat, relative to the medium outside.",
               .fallback = {1.5},
               .min = 1,
               .max = 1e3},
    [ROUGHNESS] = {.size = sizeof(struct mcr_parameter),
                   .type = MCR_TYPE_NUMBER,
                   .flags = MCR_PARAMETER_VARYING,
                   .name = "roughness",
                   .unit = "",
                   .summary = "The alpha of the coat's GGX, the width of the slopes' distribution; 0 is smooth.",
                   .fallback = {0.1},
                   .min = 0,
                   .max = 1},
};

#define ROWS 14
#define COLUMNS 16

/* `mean[j]` holds the coefficients of x^j, in y, of Fresnel's mean at (cosine, alpha); x and y in [-1, 1] as in mcr_ggx_grazing. `whole`: <E> in y. */
struct coat {
    double index, smooth;
    double mean[ROWS][COLUMNS], whole[COLUMNS];
};

/* ---- create ---- */

static double node(int k, int n)
{
    return mcr_cos(MCR_PI * (k + 0.5) / n);
}

/* Coefficients of powers of the polynomial through n <= 16 values at the nodes. */
static void interpolate(const double *value, int n, double *c)
{
    double before[16] = {1}, here[16] = {0, 1}, next[16];

    for (int k = 0; k < n; k++)
        c[k] = 0;
    for (int k = 0; k < n; k++) {
        double sum = 0;
        for (int j = 0; j < n; j++)
            sum += value[j] * mcr_cos(MCR_PI * k * (j + 0.5) / n);
        sum *= (k ? 2.0 : 1.0) / n;
        for (int i = 0; i < n; i++)
            c[i] += sum * (k ? here[i] : before[i]);
        for (int i = 0; i < n && k; i++)
            next[i] = (i ? 2 * here[i - 1] : 0) - before[i];
        for (int i = 0; i < n && k; i++)
            before[i] = here[i], here[i] = next[i];
    }
}

/* Fresnel's mean over the reflected light seen at this cosine, by midpoints in the cap's azimuth and in the cube root of 1 - radius^2. */
static double mean_reflectance(double index, double alpha, double cosine)
{
    enum { RINGS = 48, SPOKES = 24 };
    struct mcr_vector o = mcr_vector(sqrt((1 - cosine) * (1 + cosine)), 0, cosine);
    double spread = mcr_ggx_spread(alpha, alpha, o), sx = alpha * o.x / spread, sz = cosine / spread, p = 1 + sz, all = 0, reflected = 0, q;

    for (int i = 0; i < RINGS; i++) {
        double t = (i + 0.5) / RINGS, rest = t * t * t, radius = sqrt(1 - rest) * sqrt(p * (2 - (1 - rest) * p));
        for (int j = 0; j < SPOKES; j++) {
            double sine, turn, length, c, in, weight;
            struct mcr_vector m;

            mcr_sincos_turns(0.5 * (j + 0.5) / SPOKES, &sine, &turn);
            m = mcr_vector(alpha * (radius * turn + sx), alpha * radius * sine, p * rest);
            length = sqrt(mcr_dot(m, m)), c = mcr_dot(o, m) / length, in = 2 * c * m.z / length - cosine;
            if (!(in > 0))
                continue;
            weight = t * t * in * (cosine + spread) / (in * spread + cosine * sqrt(in * in + alpha * alpha * (1 - in * in)));
            all += weight;
            reflected += weight * mcr_fresnel_dielectric(c < 1 ? c : 1, index, &q);
        }
    }
    return all > 0 ? reflected / all : 1;
}

/* E as the loops have it. */
MCR_INLINE double rough_albedo(const struct coat *coat, double alpha, double c)
{
    double cosine = mcr_within_unit_(c), spread = sqrt(cosine * cosine + alpha * alpha * ((1 - cosine) * (1 + cosine)));
    double x = 2 * (cosine * sqrt((1 + alpha) / (spread + alpha))) - 1, y = 2 * sqrt(alpha) - 1, p = mcr_row16_(coat->mean[13], y);

    p = p * x + mcr_row16_(coat->mean[12], y);
    p = p * x + mcr_row16_(coat->mean[11], y);
    p = p * x + mcr_row16_(coat->mean[10], y);
    p = p * x + mcr_row16_(coat->mean[9], y);
    p = p * x + mcr_row16_(coat->mean[8], y);
    p = p * x + mcr_row16_(coat->mean[7], y);
    p = p * x + mcr_row16_(coat->mean[6], y);
    p = p * x + mcr_row16_(coat->mean[5], y);
    p = p * x + mcr_row16_(coat->mean[4], y);
    p = p * x + mcr_row16_(coat->mean[3], y);
    p = p * x + mcr_row16_(coat->mean[2], y);
    p = p * x + mcr_row16_(coat->mean[1], y);
    p = p * x + mcr_row16_(coat->mean[0], y);
    return mcr_within_unit_(p) * (1 - mcr_ggx_lost(alpha, cosine));
}

MCR_INLINE double smooth_albedo(double index, double c)
{
    double q;
    return mcr_fresnel_dielectric(mcr_within_unit_(c), index, &q);
}

/* 2 integral E c dc by midpoints in the cube root of c. */
static double whole_albedo(const struct coat *coat, double alpha)
{
    enum { STEPS = 512 };
    double sum = 0;

    for (int k = 0; k < STEPS; k++) {
        double z = (k + 0.5) / STEPS, c = z * z * z;
        sum += (coat->smooth != 0 ? smooth_albedo(coat->index, c) : rough_albedo(coat, alpha, c)) * 6 * c * z * z;
    }
    return sum / STEPS;
}

static void fill(struct coat *coat)
{
    double value[16], rows[COLUMNS][ROWS], column[COLUMNS];

    for (int i = 0; i < COLUMNS && coat->smooth == 0; i++) {
        double y = 0.5 + 0.5 * node(i, COLUMNS), alpha = y * y;
        for (int j = 0; j < ROWS; j++) {
            double x = 0.5 + 0.5 * node(j, ROWS), spread = alpha + (1 - alpha) * x * x;
            double c = sqrt((spread - alpha) * (spread + alpha) / ((1 - alpha) * (1 + alpha)));
            value[j] = mean_reflectance(coat->index, alpha, c < 1 ? c : 1);
        }
        interpolate(value, ROWS, rows[i]);
    }
    for (int j = 0; j < ROWS && coat->smooth == 0; j++) {
        for (int i = 0; i < COLUMNS; i++)
            column[i] = rows[i][j];
        interpolate(column, COLUMNS, coat->mean[j]);
    }
    for (int i = 0; i < COLUMNS; i++) {
        double y = 0.5 + 0.5 * node(i, COLUMNS);
        column[i] = whole_albedo(coat, y * y);
    }
    interpolate(column, COLUMNS, coat->whole);
}

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    struct coat *coat = calloc(1, sizeof *coat);

    (void)host, (void)context;
    *instance = coat;
    if (!coat)
        return MCR_E_NOMEM;
    coat->index = with->values->number[CHANNEL(INDEX)];
    coat->smooth = with->values->number[CHANNEL(ROUGHNESS)] > 0 ? 0 : 1;
    fill(coat);
    return MCR_OK;
}

static void destroy(void *instance)
{
    free(instance);
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    (void)host, (void)context, (void)instance;
    traits->does = MCR_MATERIAL_REFLECTS | (values->number[CHANNEL(ROUGHNESS)] > 0 ? 0 : MCR_MATERIAL_DELTA);
    return MCR_OK;
}

/* Arrays of scratch, of mcr_padded(n) doubles each. TANGENT is 3. */
enum { ALPHA, SPECULAR, BASE, SHARE, RED, GREEN, BLUE, TANGENT, ARRAYS = TANGENT + 3 };

static uint64_t scratch_bytes(const void *instance, uint32_t n)
{
    (void)instance;
    return ARRAYS * mcr_padded(n) * sizeof(double);
}

/* ---- lanes ---- */

static const double *alpha_lanes(const struct mcr_points *at, const struct mcr_inputs *inputs, double *restrict room)
{
    const double *alpha = inputs->channel[CHANNEL(ROUGHNESS)];
    uint32_t stride = inputs->stride[CHANNEL(ROUGHNESS)];

    for (uint32_t i = 0; i < at->n; i++) {
        double a = alpha[i * stride];
        room[i] = a > MCR_GGX_LEAST ? a : MCR_GGX_LEAST;
    }
    return room;
}

/* The coat's part of f cos, and the base's without its colour. */
static void part_lanes(const struct coat *coat, const struct mcr_points *at, const double *const tangent[3], const double *alpha, const double *restrict x,
                       const double *restrict y, const double *restrict z, double *restrict specular, double *restrict base)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *tx = tangent[0], *ty = tangent[1], *tz = tangent[2], index = coat->index;
    const int smooth = coat->smooth != 0;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));
        struct mcr_ggx g = mcr_ggx_reflect(alpha[i], alpha[i], o, w);
        int seen = (o.z > MCR_GGX_HORIZON) & (w.z > MCR_GGX_HORIZON) & (gx[i] * x[i] + gy[i] * y[i] + gz[i] * z[i] > 0);
        double q, fresnel = mcr_fresnel_dielectric(g.cosine, index, &q), out, in;

        if (smooth)
            fresnel = 0, out = smooth_albedo(index, o.z), in = smooth_albedo(index, w.z);
        else
            out = rough_albedo(coat, alpha[i], o.z), in = rough_albedo(coat, alpha[i], w.z);
        specular[i] = seen ? g.value * fresnel : 0;
        base[i] = seen ? w.z * MCR_PER_PI * (1 - out) * (1 - in) / (index * index) : 0;
    }
}

static void colour_lanes(uint32_t n, const struct coat *coat, const double *alpha, const double *specular, const double *base, const double *albedo,
                         uint32_t stride, double *restrict out)
{
    const double inverse = 1 / (coat->index * coat->index);

    for (uint32_t i = 0; i < n; i++) {
        double a = albedo[i * stride], whole = mcr_within_unit_(mcr_row16_(coat->whole, 2 * sqrt(alpha[i]) - 1)), k = 1 - (1 - whole) * inverse;
        out[i] = specular[i] + base[i] * (a / (1 - a * k));
    }
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    double *room = host->scratch(host, context), *channel[3] = {out->r, out->g, out->b};
    const uint64_t stride = mcr_padded(at->n);
    const double *tangent[3], *alpha = alpha_lanes(at, inputs, room + ALPHA * stride);

    mcr_tangent_lanes(at, room + TANGENT * stride, tangent);
    part_lanes(instance, at, tangent, alpha, toward->x, toward->y, toward->z, room + SPECULAR * stride, room + BASE * stride);
    for (uint32_t c = 0; c < 3; c++)
        colour_lanes(at->n, instance, alpha, room + SPECULAR * stride, room + BASE * stride, inputs->channel[c], inputs->stride[c], channel[c]);
    return MCR_OK;
}

/* The coat's E and, for the base, what colour_lanes expects integrated over all directions: (1 - E(o)) (1 - <E>) / n^2. */
static void integral_lanes(const struct coat *coat, const struct mcr_points *at, const double *alpha, double *restrict specular, double *restrict base)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz, inverse = 1 / (coat->index * coat->index);
    const int smooth = coat->smooth != 0;

    for (uint32_t i = 0; i < at->n; i++) {
        double c = nx[i] * ox[i] + ny[i] * oy[i] + nz[i] * oz[i], whole = mcr_within_unit_(mcr_row16_(coat->whole, 2 * sqrt(alpha[i]) - 1));
        double e = smooth ? smooth_albedo(coat->index, c) : rough_albedo(coat, alpha[i], c);

        specular[i] = e;
        base[i] = (1 - e) * (1 - whole) * inverse;
    }
}

/* To the errors of E's polynomials. */
static int32_t albedo(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    double *room = host->scratch(host, context), *channel[3] = {out->r, out->g, out->b};
    const uint64_t stride = mcr_padded(at->n);
    const double *alpha = alpha_lanes(at, inputs, room + ALPHA * stride);

    integral_lanes(instance, at, alpha, room + SPECULAR * stride, room + BASE * stride);
    for (uint32_t c = 0; c < 3; c++)
        colour_lanes(at->n, instance, alpha, room + SPECULAR * stride, room + BASE * stride, inputs->channel[c], inputs->stride[c], channel[c]);
    return MCR_OK;
}

/* The chance of the coat's lobe: its share of what is scattered, about, seen in grey. */
static void share_lanes(const struct coat *coat, const struct mcr_points *at, const double *alpha, const double *red, const double *green,
                        const double *blue, double *restrict share)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const int smooth = coat->smooth != 0;

    for (uint32_t i = 0; i < at->n; i++) {
        double c = nx[i] * ox[i] + ny[i] * oy[i] + nz[i] * oz[i], grey = (red[i] + green[i] + blue[i]) * (1.0 / 3), sum;
        double e = smooth ? smooth_albedo(coat->index, c) : rough_albedo(coat, alpha[i], c);

        sum = e + (1 - e) * grey;
        share[i] = sum > 0 ? e / sum : 0;
    }
}

static const double *shares(const struct coat *coat, const struct mcr_points *at, const struct mcr_inputs *inputs, const double *alpha, double *room)
{
    const uint64_t stride = mcr_padded(at->n);

    share_lanes(coat, at, alpha, mcr_input_lanes(inputs, 0, at->n, room + RED * stride), mcr_input_lanes(inputs, 1, at->n, room + GREEN * stride),
                mcr_input_lanes(inputs, 2, at->n, room + BLUE * stride), room + SHARE * stride);
    return room + SHARE * stride;
}

static void density_lanes(const struct mcr_points *at, const double *const tangent[3], const double *alpha, const double *share, const double *restrict x,
                          const double *restrict y, const double *restrict z, double *restrict density)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *tx = tangent[0], *ty = tangent[1], *tz = tangent[2];

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));
        struct mcr_ggx g = mcr_ggx_reflect(alpha[i], alpha[i], o, w);
        int above = (o.z > MCR_GGX_HORIZON) & (w.z > MCR_GGX_HORIZON);
        double value = share[i] * g.density + (1 - share[i]) * (w.z * MCR_PER_PI);

        density[i] = above ? value : 0;
    }
}

static void draw_lanes(const struct mcr_points *at, const double *const tangent[3], const double *alpha, const double *share, const double *const *number,
                       double *restrict x, double *restrict y, double *restrict z)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz, *u = number[0], *v = number[1], *choice = number[2];
    const double *tx = tangent[0], *ty = tangent[1], *tz = tangent[2];

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), m, l, w;
        int visible = o.z > MCR_GGX_HORIZON, diffuse = choice[i] >= share[i];
        double px, py, rest = mcr_disk_from_square(u[i], v[i], &px, &py);

        o.z = visible ? o.z : 1;
        m = mcr_ggx_visible(alpha[i], alpha[i], o, u[i], v[i]);
        l = mcr_mirrored(o, m, mcr_dot(m, m));
        l.x = diffuse ? px : l.x;
        l.y = diffuse ? py : l.y;
        l.z = diffuse ? sqrt(rest) : l.z;
        w = mcr_from_frame(f, l);
        int above = visible & (mcr_dot(f.n, w) > MCR_GGX_HORIZON);
        x[i] = above ? w.x : 0;
        y[i] = above ? w.y : 0;
        z[i] = above ? w.z : 0;
    }
}

/* Under a smooth coat the base alone is drawn. */
static const double *drawn_shares(const struct coat *coat, const struct mcr_points *at, const struct mcr_inputs *inputs, const double *alpha, double *room)
{
    if (coat->smooth == 0)
        return shares(coat, at, inputs, alpha, room);
    mcr_fill_lanes(at->n, 0, room + SHARE * mcr_padded(at->n));
    return room + SHARE * mcr_padded(at->n);
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    double *room = host->scratch(host, context);
    const double *tangent[3], *alpha = alpha_lanes(at, inputs, room + ALPHA * mcr_padded(at->n));
    const double *share = drawn_shares(instance, at, inputs, alpha, room);

    mcr_tangent_lanes(at, room + TANGENT * mcr_padded(at->n), tangent);
    density_lanes(at, tangent, alpha, share, toward->x, toward->y, toward->z, density);
    return MCR_OK;
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    double *room = host->scratch(host, context);
    const double *tangent[3], *alpha = alpha_lanes(at, inputs, room + ALPHA * mcr_padded(at->n));
    const double *share = drawn_shares(instance, at, inputs, alpha, room);

    mcr_tangent_lanes(at, room + TANGENT * mcr_padded(at->n), tangent);
    draw_lanes(at, tangent, alpha, share, number, out->x, out->y, out->z);
    if (density)
        density_lanes(at, tangent, alpha, share, out->x, out->y, out->z, density);
    return MCR_OK;
}

/* ---- a smooth coat's lobe ---- */

static void mirror_lanes(const struct mcr_points *at, double index, const double *share, const double *choice, double *restrict x, double *restrict y,
                         double *restrict z, double *restrict probability, double *restrict weight)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_vector n = mcr_vector(nx[i], ny[i], nz[i]), o = mcr_vector(ox[i], oy[i], oz[i]), w = mcr_mirrored(o, n, mcr_dot(n, n));
        double c = mcr_dot(n, o), fix = 0.5 * (1 - mcr_dot(w, w)), reflected = smooth_albedo(index, c);
        int above = (c > 0) & (gx[i] * w.x + gy[i] * w.y + gz[i] * w.z > 0), chosen = above & (choice[i] < share[i]);

        x[i] = chosen ? w.x + w.x * fix : 0;
        y[i] = chosen ? w.y + w.y * fix : 0;
        z[i] = chosen ? w.z + w.z * fix : 0;
        probability[i] = above ? (chosen ? share[i] : 1 - share[i]) : 1;
        weight[i] = chosen ? reflected : 0;
    }
}

static int32_t delta(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                     const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *probability,
                     const struct mcr_colours *weight)
{
    const struct coat *coat = instance;
    double *room = host->scratch(host, context), *channel[3] = {weight->r, weight->g, weight->b};
    const double *share;

    if (coat->smooth != 0)
        share = shares(coat, at, inputs, NULL, room);
    else
        mcr_fill_lanes(at->n, 0, room), share = room;
    for (uint32_t c = 0; c < 3; c++)
        mirror_lanes(at, coat->index, share, number[0], out->x, out->y, out->z, probability, channel[c]);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin),
             .kind = MCR_KIND_MATERIAL,
             .isa = MCR_ISA,
             .parameter_count = PARAMETERS,
             .name = "glossy",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "diffuse under a clear coat, smooth or rough, two-sided; loses no light",
             .parameters = parameters},
    .create = create,
    .destroy = destroy,
    .traits = traits,
    .scratch_bytes = scratch_bytes,
    .evaluate = evaluate,
    .draw = draw,
    .density = density,
    .delta = delta,
    .albedo = albedo,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
