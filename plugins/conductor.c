/* SPDX-License-Identifier: Apache-2.0 */
/*
 * conductor: a metal of GGX microfacets, on both sides: f cos = F D G2 / (4 cos_o), as <mcrender/microfacet.h> tells.
 *
 * Light that meets more than one microfacet is lost: a rough white metal is a few ten per cent too dark. `compensation` gives it back as a diffuse lobe,
 * (1 - E(o)) (1 - E(i)) / (pi (1 - <E>)) F_ms, Kulla and Conty, "Revisiting physically based shading at Imageworks" (2017), with
 * F_ms = <F>^2 <E> / (1 - <F> (1 - <E>)); E is the directional albedo of GGX without Fresnel's part and < > a mean weighted by the cosine. Where the
 * widths differ, E is at least that: mcr_ggx_width.
 *
 * Of the directions drawn by visible normals, a share is reflected below the horizon and not drawn: there the density integrates to less than 1.
 */
#include <mcrender/math.h>
#include <mcrender/microfacet.h>

/* Parameters, in the order of the table. */
enum { METAL, REFLECTANCE, ETA, K, ROUGHNESS, ANISOTROPY, ROTATION, COMPENSATION, PARAMETERS };
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
                   .min = MCR_GGX_LEAST,
                   .max = 1},
    [ANISOTROPY] = {.size = sizeof(struct mcr_parameter),
                    .type = MCR_TYPE_NUMBER,
                    .flags = MCR_PARAMETER_VARYING,
                    .name = "anisotropy",
                    .unit = "",
                    .summary = "a > 0: along growing u the roughness is 1 - a times as much; a < 0: across u it is 1 + a times as much.",
                    .fallback = {0},
                    .min = -1,
                    .max = 1},
    [ROTATION] = {.size = sizeof(struct mcr_parameter),
                  .type = MCR_TYPE_NUMBER,
                  .flags = MCR_PARAMETER_VARYING,
                  .name = "rotation",
                  .unit = "degrees",
                  .summary = "Turns the direction that `anisotropy` means by u around the normal, counterclockwise seen from outside.",
                  .fallback = {0},
                  .min = -360,
                  .max = 360},
    [COMPENSATION] = {.size = sizeof(struct mcr_parameter),
                      .type = MCR_TYPE_CHOICE,
                      .name = "compensation",
                      .unit = "",
                      .choices = "none|kulla-conty",
                      .summary = "Whether the light that meets several facets is lost or comes back in a diffuse lobe.",
                      .fallback = {0}},
};

/* What would be ignored is a mistake. */
static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    const uint32_t *given = with->values->given;
    uint32_t metal = (uint32_t)with->values->number[CHANNEL(METAL)];

    *instance = NULL;
    if (given[REFLECTANCE] && metal != BY_REFLECTANCE)
        return mcr_refuse(host, context, "'reflectance' has no effect with this 'metal': it belongs to 'metal reflectance', the default");
    if ((given[ETA] || given[K]) && metal != BY_INDEX)
        return mcr_refuse(host, context, "'eta' and 'k' have no effect without 'metal index'");
    return MCR_OK;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    (void)host, (void)context, (void)instance;
    traits->does = MCR_MATERIAL_REFLECTS | (values->given[ANISOTROPY] ? MCR_MATERIAL_LEANS : 0); /* what is isotropic does not ask for tangents */
    return MCR_OK;
}

/* Arrays of scratch, of mcr_padded(n) doubles each. TANGENT and TURNED are 3. */
enum { ALPHA, AX, AY, TANGENT, TURNED = TANGENT + 3, DEGREES = TURNED + 3, LEANING, SHAPE, COSINE, ETA_LANES, K_LANES, AGAIN, MEAN_LOST, PART, ARRAYS };

static uint64_t scratch_bytes(const void *instance, uint32_t n)
{
    (void)instance;
    return ARRAYS * mcr_padded(n) * sizeof(double);
}

/* ---- the surface ---- */

/* Widths and tangents of the lanes; the width by which E is known, and the mean of 1 - E: only with compensation. */
struct surface {
    const double *alpha, *lost, *ax, *ay, *t[3];
};

static void widths_lanes(uint32_t n, const double *alpha, const double *anisotropy, double *restrict ax, double *restrict ay)
{
    for (uint32_t i = 0; i < n; i++) {
        double a = anisotropy[i], along = alpha[i] * (1 - (a > 0 ? a : 0)), across = alpha[i] * (1 + (a < 0 ? a : 0));
        ax[i] = along > MCR_GGX_LEAST ? along : MCR_GGX_LEAST;
        ay[i] = across > MCR_GGX_LEAST ? across : MCR_GGX_LEAST;
    }
}

static void one_width_lanes(uint32_t n, const double *ax, const double *ay, double *restrict alpha, double *restrict lost)
{
    for (uint32_t i = 0; i < n; i++) {
        double same = mcr_ggx_mean_lost(ax[i]), leaning = mcr_ggx_width_mean_lost(ax[i], ay[i]), width = mcr_ggx_width(ax[i], ay[i]);
        alpha[i] = ax[i] == ay[i] ? ax[i] : width;
        lost[i] = ax[i] == ay[i] ? same : leaning;
    }
}

static void mean_lost_lanes(uint32_t n, const double *alpha, double *restrict lost)
{
    for (uint32_t i = 0; i < n; i++)
        lost[i] = mcr_ggx_mean_lost(alpha[i]);
}

/* t cos + (n x t) sin; t to the bit where there is no anisotropy, so that a lane's bits do not depend on its neighbours. */
static void turn_lanes(const struct mcr_points *at, const double *const t[3], const double *degrees, const double *anisotropy, double *restrict x,
                       double *restrict y, double *restrict z)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *tx = t[0], *ty = t[1], *tz = t[2];

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        double angle = anisotropy[i] != 0 ? degrees[i] : 0, c = mcr_cos_degrees(angle), s = mcr_sin_degrees(angle);
        x[i] = f.t.x * c + f.b.x * s;
        y[i] = f.t.y * c + f.b.y * s;
        z[i] = f.t.z * c + f.b.z * s;
    }
}

static int differs(const struct mcr_inputs *inputs, uint32_t channel)
{
    return inputs->stride[channel] || inputs->channel[channel][0] != 0;
}

/* 1 where the material gives back what is lost. */
static int compensates(const struct mcr_inputs *inputs)
{
    return differs(inputs, CHANNEL(COMPENSATION));
}

/* What is isotropic needs no particular tangent. */
static void surface_lanes(const struct mcr_points *at, const struct mcr_inputs *inputs, double *room, struct surface *s)
{
    uint64_t stride = mcr_padded(at->n);
    int leans = differs(inputs, CHANNEL(ANISOTROPY));
    const double *anisotropy;

    s->alpha = s->ax = s->ay = mcr_input_lanes(inputs, CHANNEL(ROUGHNESS), at->n, room + ALPHA * stride);
    s->lost = room + MEAN_LOST * stride;
    mcr_tangent_lanes(at, room + TANGENT * stride, s->t);
    if (!leans && compensates(inputs))
        mean_lost_lanes(at->n, s->alpha, room + MEAN_LOST * stride);
    if (!leans)
        return;
    anisotropy = mcr_input_lanes(inputs, CHANNEL(ANISOTROPY), at->n, room + LEANING * stride);
    widths_lanes(at->n, s->alpha, anisotropy, room + AX * stride, room + AY * stride);
    s->ax = room + AX * stride, s->ay = room + AY * stride;
    if (differs(inputs, CHANNEL(ROTATION))) {
        double *turned = room + TURNED * stride;
        const double *degrees = mcr_input_lanes(inputs, CHANNEL(ROTATION), at->n, room + DEGREES * stride);
        turn_lanes(at, s->t, degrees, anisotropy, turned, turned + stride, turned + 2 * stride);
        s->t[0] = turned, s->t[1] = turned + stride, s->t[2] = turned + 2 * stride;
    }
    if (compensates(inputs)) {
        one_width_lanes(at->n, s->ax, s->ay, room + DEGREES * stride, room + MEAN_LOST * stride);
        s->alpha = room + DEGREES * stride;
    }
}

/* ---- Fresnel ---- */

/* out = shape * F(cosine). The index of lane i is at i * stride; a negative k says that eta holds a reflectance. */
static void fresnel_lanes(uint32_t n, const double *restrict shape, const double *restrict cosine, const double *restrict eta,
                          const double *restrict k, uint32_t stride, double *restrict out)
{
    if (stride)
        for (uint32_t i = 0; i < n; i++) {
            double by_index = mcr_fresnel_conductor(cosine[i], eta[i], k[i]), by_colour = mcr_fresnel_schlick(cosine[i], eta[i]);
            out[i] = shape[i] * (k[i] < 0 ? by_colour : by_index);
        }
    else if (k[0] < 0)
        for (uint32_t i = 0; i < n; i++)
            out[i] = shape[i] * mcr_fresnel_schlick(cosine[i], eta[0]);
    else
        for (uint32_t i = 0; i < n; i++)
            out[i] = shape[i] * mcr_fresnel_conductor(cosine[i], eta[0], k[0]);
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

/* The mean of F over the hemisphere, weighted by the cosine: of Schlick's formula (20 r + 1) / 21, else by Gauss and Legendre's rule of 8 points. */
static void mean_fresnel_lanes(uint32_t n, const double *eta, const double *k, double *restrict mean)
{
    for (uint32_t i = 0; i < n; i++) {
        double sum = 0, e = eta[i], absorbs = k[i];
        for (uint32_t j = 0; j < 8; j++)
            sum += mcr_mean_weight_[j] * mcr_fresnel_conductor(mcr_mean_node_[j], e, absorbs);
        mean[i] = absorbs < 0 ? (20 * e + 1) / 21 : sum;
    }
}

/* out += again * F_ms */
static void again_lanes(uint32_t n, const double *lost, const double *again, const double *mean, uint32_t stride, double *restrict out)
{
    for (uint32_t i = 0; i < n; i++) {
        double f = mean[i * stride], kept = 1 - lost[i];
        out[i] += again[i] * (f * f * kept / (1 - f * (1 - kept)));
    }
}

/* ---- evaluate ---- */

/* f cos without Fresnel's part, and the cosine for that; 0 below either horizon. */
static void shape_lanes(const struct mcr_points *at, const struct surface *s, const double *restrict x, const double *restrict y,
                        const double *restrict z, double *restrict shape, double *restrict cosine)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *tx = s->t[0], *ty = s->t[1], *tz = s->t[2], *ax = s->ax, *ay = s->ay;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));
        struct mcr_ggx g = mcr_ggx_reflect(ax[i], ay[i], o, w);
        double above = gx[i] * x[i] + gy[i] * y[i] + gz[i] * z[i];

        shape[i] = above > 0 ? g.value : 0;
        cosine[i] = g.cosine;
    }
}

/* 1 - E of a direction in the frame. */
MCR_INLINE double lost_lane(double alpha, double ax, double ay, struct mcr_vector v)
{
    double above = v.z > MCR_GGX_HORIZON ? v.z : MCR_GGX_HORIZON;
    return mcr_ggx_lost_stretched(alpha, above / mcr_ggx_spread(ax, ay, mcr_vector(v.x, v.y, above)));
}

/* The diffuse lobe of the light that meets several facets, without its colour; 0 where it is not asked for. */
static void lost_lanes(const struct mcr_points *at, const struct surface *s, const double *restrict x, const double *restrict y,
                       const double *restrict z, const double *asked, uint32_t stride, double *restrict again)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *tx = s->t[0], *ty = s->t[1], *tz = s->t[2], *ax = s->ax, *ay = s->ay, *alpha = s->alpha, *lost = s->lost;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));
        double above = gx[i] * x[i] + gy[i] * y[i] + gz[i] * z[i];
        double value = w.z * MCR_PER_PI * lost_lane(alpha[i], ax[i], ay[i], o) * lost_lane(alpha[i], ax[i], ay[i], w) / lost[i];
        int seen = (o.z > MCR_GGX_HORIZON) & (w.z > MCR_GGX_HORIZON) & (above > 0) & (asked[i * stride] != 0);

        again[i] = seen ? value : 0;
    }
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    double *room = host->scratch(host, context), *channel[3] = {out->r, out->g, out->b};
    const uint64_t stride = mcr_padded(at->n);
    double *shape = room + SHAPE * stride, *cosine = room + COSINE * stride, *eta = room + ETA_LANES * stride, *k = room + K_LANES * stride;
    double *again = room + AGAIN * stride;
    const uint32_t *s = inputs->stride;
    struct surface surface;

    (void)instance;
    surface_lanes(at, inputs, room, &surface);
    shape_lanes(at, &surface, toward->x, toward->y, toward->z, shape, cosine);
    if (compensates(inputs))
        lost_lanes(at, &surface, toward->x, toward->y, toward->z, inputs->channel[CHANNEL(COMPENSATION)], s[CHANNEL(COMPENSATION)], again);
    for (uint32_t c = 0; c < 3; c++) {
        uint32_t varies = s[CHANNEL(METAL)] | s[CHANNEL(REFLECTANCE) + c] | s[CHANNEL(ETA) + c] | s[CHANNEL(K) + c];

        index_lanes(varies ? at->n : 1, inputs, c, eta, k);
        fresnel_lanes(at->n, shape, cosine, eta, k, varies, channel[c]);
        if (compensates(inputs)) {
            double *mean = room + LEANING * stride; /* no longer needed */
            mean_fresnel_lanes(varies ? at->n : 1, eta, k, mean);
            again_lanes(at->n, surface.lost, again, mean, varies, channel[c]);
        }
    }
    return MCR_OK;
}

/* What is lost, where it is given back: the chance that a direction is drawn in proportion to the cosine. */
static void share_lanes(const struct mcr_points *at, const struct surface *s, const double *asked, uint32_t stride, double *restrict share)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *tx = s->t[0], *ty = s->t[1], *tz = s->t[2], *ax = s->ax, *ay = s->ay, *alpha = s->alpha;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        double lost = lost_lane(alpha[i], ax[i], ay[i], mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])));
        share[i] = asked[i * stride] != 0 ? lost : 0;
    }
}

static const double *shares(const struct mcr_points *at, const struct mcr_inputs *inputs, const struct surface *s, double *room)
{
    if (compensates(inputs))
        share_lanes(at, s, inputs->channel[CHANNEL(COMPENSATION)], inputs->stride[CHANNEL(COMPENSATION)], room);
    else
        mcr_fill_lanes(at->n, 0, room);
    return room;
}

/* ---- albedo ---- */

/* The share of the light, without Fresnel's part, that is reflected at point k of the lattice over visible normals, and the cosine there. */
static void normal_lanes(const struct mcr_points *at, const struct surface *s, int k, double *restrict shape, double *restrict cosine)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *tx = s->t[0], *ty = s->t[1], *tz = s->t[2], *ax = s->ax, *ay = s->ay;
    double rest, turn, sine, cosine_turn, weight = mcr_ggx_lattice(k, &rest, &turn);

    mcr_sincos_turns(turn, &sine, &cosine_turn);
    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), m, w;
        int visible = o.z > MCR_GGX_HORIZON;
        double length2, so, sw, c, g;

        o.z = visible ? o.z : 1;
        m = mcr_ggx_visible_at(ax[i], ay[i], o, rest, sine, cosine_turn);
        length2 = mcr_dot(m, m);
        w = mcr_mirrored(o, m, length2);
        so = mcr_ggx_spread(ax[i], ay[i], o), sw = mcr_ggx_spread(ax[i], ay[i], w);
        visible &= (w.z > MCR_GGX_HORIZON) & (length2 > 0);
        g = w.z * (o.z + so) / (visible ? w.z * so + o.z * sw : 1); /* G2 / G1(o) */
        c = mcr_dot(o, m) / sqrt(length2 > 0 ? length2 : 1);
        shape[i] = visible ? weight * g : 0;
        cosine[i] = c < 1 ? (c > 0 ? c : 0) : 1;
    }
}

static void add_lanes(uint32_t n, const double *part, double *restrict sum)
{
    for (uint32_t i = 0; i < n; i++) {
        double all = sum[i] + part[i];
        sum[i] = all < 1 ? all : 1;
    }
}

/* The directional albedo, where no reflection is below the geometric surface, to about 2e-3, where it is anisotropic to 6e-3: for feature layers. */
static int32_t albedo(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    double *room = host->scratch(host, context), *channel[3] = {out->r, out->g, out->b};
    const uint64_t stride = mcr_padded(at->n);
    double *shape = room + SHAPE * stride, *cosine = room + COSINE * stride, *eta = room + ETA_LANES * stride, *k = room + K_LANES * stride;
    double *again = room + AGAIN * stride, *part = room + PART * stride;
    const uint32_t *in = inputs->stride;
    struct surface s;

    (void)instance;
    surface_lanes(at, inputs, room, &s);
    if (compensates(inputs))
        share_lanes(at, &s, inputs->channel[CHANNEL(COMPENSATION)], in[CHANNEL(COMPENSATION)], again);
    for (uint32_t c = 0; c < 3; c++) {
        uint32_t varies = in[CHANNEL(METAL)] | in[CHANNEL(REFLECTANCE) + c] | in[CHANNEL(ETA) + c] | in[CHANNEL(K) + c];

        index_lanes(varies ? at->n : 1, inputs, c, eta, k);
        mcr_fill_lanes(at->n, 0, channel[c]);
        for (int j = 0; j < MCR_GGX_NORMALS; j++) {
            normal_lanes(at, &s, j, shape, cosine);
            fresnel_lanes(at->n, shape, cosine, eta, k, varies, part);
            add_lanes(at->n, part, channel[c]);
        }
        if (compensates(inputs)) {
            mean_fresnel_lanes(varies ? at->n : 1, eta, k, shape);
            mcr_fill_lanes(at->n, 0, part);
            again_lanes(at->n, s.lost, again, shape, varies, part);
            add_lanes(at->n, part, channel[c]);
        }
    }
    return MCR_OK;
}

/* ---- Sampling ---- */

static void density_lanes(const struct mcr_points *at, const struct surface *s, const double *share, const double *restrict x,
                          const double *restrict y, const double *restrict z, double *restrict density)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *tx = s->t[0], *ty = s->t[1], *tz = s->t[2], *ax = s->ax, *ay = s->ay;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));
        struct mcr_ggx g = mcr_ggx_reflect(ax[i], ay[i], o, w);
        int above = (o.z > MCR_GGX_HORIZON) & (w.z > MCR_GGX_HORIZON);
        double value = (1 - share[i]) * g.density + share[i] * (w.z * MCR_PER_PI);

        density[i] = above ? value : 0;
    }
}

static void draw_lanes(const struct mcr_points *at, const struct surface *s, const double *share, const double *const *number, double *restrict x,
                       double *restrict y, double *restrict z)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz, *u = number[0], *v = number[1], *choice = number[2];
    const double *tx = s->t[0], *ty = s->t[1], *tz = s->t[2], *ax = s->ax, *ay = s->ay;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), m, l, w;
        int visible = o.z > MCR_GGX_HORIZON, diffuse = choice[i] < share[i];
        double px, py, rest = mcr_disk_from_square(u[i], v[i], &px, &py);

        o.z = visible ? o.z : 1;
        m = mcr_ggx_visible(ax[i], ay[i], o, u[i], v[i]);
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

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    double *room = host->scratch(host, context);
    const double *share;
    struct surface s;

    (void)instance;
    surface_lanes(at, inputs, room, &s);
    share = shares(at, inputs, &s, room + SHAPE * mcr_padded(at->n));
    draw_lanes(at, &s, share, number, out->x, out->y, out->z);
    if (density)
        density_lanes(at, &s, share, out->x, out->y, out->z, density);
    return MCR_OK;
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    double *room = host->scratch(host, context);
    struct surface s;

    (void)instance;
    surface_lanes(at, inputs, room, &s);
    density_lanes(at, &s, shares(at, inputs, &s, room + SHAPE * mcr_padded(at->n)), toward->x, toward->y, toward->z, density);
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
    .albedo = albedo,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
