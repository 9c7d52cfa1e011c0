/* SPDX-License-Identifier: Apache-2.0 */
/*
 * dielectric: glass, water and the like: Fresnel's reflection and refraction at a smooth interface (two mirror-like lobes) or at a rough one of GGX
 * microfacets (Walter et al., "Microfacet models for refraction through rough surfaces", 2007). Radiance that enters an index n is n^2 times what it was.
 * The interior behind the front side absorbs as Beer and Lambert have it; where it overlaps others, priority decides.
 *
 * Light that meets more than one microfacet is lost, as with a conductor. `compensation` gives it back in two diffuse lobes, one above and one below: glass.h.
 *
 * A thin wall has both interfaces in one and light passes straight on. Of the unpolarised reflectance R of one of them and the share t that crosses the
 * wall's inside, all internal reflections together reflect R + (1 - R)^2 t^2 R / (1 - R^2 t^2) and pass (1 - R)^2 t / (1 - R^2 t^2).
 * A rough one scatters what passes as it scatters what it reflects, to the other side.
 *
 * With roughness 0 the surface is smooth. A texture of roughness that is not 0 everywhere makes lobes, of 1e-7 rad where it is 0.
 */
#include <mcrender/glass.h>
#include <mcrender/math.h>

/* Parameters, in the order of the table. */
enum { INDEX, ROUGHNESS, THIN, TRANSMITTANCE, DEPTH, ATTENUATION, PRIORITY, COMPENSATION, PARAMETERS };
#define CHANNEL(parameter) (3 * (parameter))

static const struct mcr_parameter parameters[PARAMETERS] = {
    [INDEX] = {.size = sizeof(struct mcr_parameter),
               .type = MCR_TYPE_NUMBER,
               .name = "index",
               .unit = "",
               .summary = "Index of refraction of what is behind the front side.",
               .fallback = {1.5},
               .min = 1e-3,
               .max = 1e6},
    [ROUGHNESS] = {.size = sizeof(struct mcr_parameter),
                   .type = MCR_TYPE_NUMBER,
                   .flags = MCR_PARAMETER_VARYING,
                   .name = "roughness",
                   .unit = "",
                   .summary = "The alpha of GGX, the width of the slopes' distribution; 0 is smooth.",
                   .fallback = {0},
                   .min = 0,
                   .max = 1},
    [THIN] = {.size = sizeof(struct mcr_parameter),
              .type = MCR_TYPE_CHOICE,
              .name = "thin",
              .unit = "",
              .choices = "no|yes",
              .summary = "Whether the surface is a thin wall, through which light passes straight on, and not the boundary of an interior.",
              .fallback = {0}},
    [TRANSMITTANCE] = {.size = sizeof(struct mcr_parameter),
                       .type = MCR_TYPE_COLOUR,
                       .flags = MCR_PARAMETER_ABOVE_MIN,
                       .name = "transmittance",
                       .unit = "",
                       .summary = "Share of light that is left after the distance `depth` inside, or after crossing a thin wall at any angle.",
                       .fallback = {1, 1, 1},
                       .min = 0,
                       .max = 1},
    [DEPTH] = {.size = sizeof(struct mcr_parameter),
               .type = MCR_TYPE_NUMBER,
               .flags = MCR_PARAMETER_ABOVE_MIN,
               .name = "depth",
               .unit = "scene length",
               .summary = "The distance of `transmittance`.",
               .fallback = {1},
               .min = 0,
               .max = HUGE_VAL},
    [ATTENUATION] = {.size = sizeof(struct mcr_parameter),
                     .type = MCR_TYPE_COLOUR,
                     .name = "attenuation",
                     .unit = "1/scene length",
                     .summary = "Absorption inside: light falls as exp(-attenuation * distance). The other way of saying `transmittance` and `depth`.",
                     .fallback = {0},
                     .min = 0,
                     .max = HUGE_VAL},
    [PRIORITY] = {.size = sizeof(struct mcr_parameter),
                  .type = MCR_TYPE_NUMBER,
                  .name = "priority",
                  .unit = "",
                  .summary = "Where interiors overlap, that of the highest priority counts.",
                  .fallback = {0},
                  .min = -1e9,
                  .max = 1e9},
    [COMPENSATION] = {.size = sizeof(struct mcr_parameter),
                      .type = MCR_TYPE_CHOICE,
                      .name = "compensation",
                      .unit = "",
                      .choices = "none|kulla-conty",
                      .summary = "Whether the light that meets several facets is lost or comes back in diffuse lobes on both sides.",
                      .fallback = {0}},
};

/* Light falls by exp(-attenuation distance). */
static double attenuation_of(const struct mcr_values *values, int c)
{
    if (values->given[TRANSMITTANCE])
        return -mcr_log(values->number[CHANNEL(TRANSMITTANCE) + c]) / values->number[CHANNEL(DEPTH)] + 0.0;
    return values->number[CHANNEL(ATTENUATION) + c];
}

/* What would be ignored is a mistake. */
static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    const uint32_t *given = with->values->given;

    *instance = NULL;
    if (with->values->number[CHANNEL(THIN)] != 0 && (given[DEPTH] || given[ATTENUATION] || given[PRIORITY]))
        return mcr_refuse(host, context, "'depth', 'attenuation' and 'priority' have no effect with 'thin yes': a thin wall has no interior");
    if (given[TRANSMITTANCE] && given[ATTENUATION])
        return mcr_refuse(host, context, "'transmittance' and 'attenuation' say the same: give one of them");
    if (given[DEPTH] && !given[TRANSMITTANCE])
        return mcr_refuse(host, context, "'depth' has no effect without 'transmittance'");
    for (int c = 0; c < 3 && with->values->number[CHANNEL(THIN)] == 0; c++)
        if (!(attenuation_of(with->values, c) < HUGE_VAL))
            return mcr_refuse(host, context, "'depth' is too small for this 'transmittance': the attenuation is infinite");
    return MCR_OK;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    (void)host, (void)context, (void)instance;
    traits->does = values->number[CHANNEL(ROUGHNESS)] > 0 ? MCR_MATERIAL_REFLECTS | MCR_MATERIAL_TRANSMITS : MCR_MATERIAL_DELTA;
    if (values->number[CHANNEL(THIN)] == 0) {
        traits->does |= MCR_MATERIAL_INTERIOR;
        traits->index = values->number[CHANNEL(INDEX)];
        for (int c = 0; c < 3; c++)
            traits->attenuation[c] = attenuation_of(values, c);
        traits->priority = values->number[CHANNEL(PRIORITY)];
    } else {
        traits->does |= MCR_MATERIAL_THIN;
    }
    return MCR_OK;
}

/* Arrays of scratch, of mcr_padded(n) doubles each. TANGENT is 3. */
enum { RATIO, WALL, INDEX_LANES, ALPHA, THIN_LANES, TANGENT, VALUES = TANGENT + 3, COSINES, CROSSED, ARRAYS };
/* Further ones with `compensation`. */
enum { BEYOND = ARRAYS, COSINE_O, COSINE_W, SIDE, LOST_O, LOST_W, MEAN, MEAN_BEYOND, UP, DOWN, SHARE, CHOICE, ALL_ARRAYS };

static uint64_t scratch_bytes(const void *instance, uint32_t n)
{
    (void)instance;
    return ALL_ARRAYS * mcr_padded(n) * sizeof(double);
}

/* ---- the interface ---- */

/* Per lane: the relative index of an interface and of a wall, whether it is thin, and alpha, at least what a lobe can be. */
struct interface {
    const double *ratio, *thin, *alpha;
};

static void choose_lanes(uint32_t n, const double *thin, const double *wall, double *restrict ratio)
{
    for (uint32_t i = 0; i < n; i++)
        ratio[i] = thin[i] != 0 ? wall[i] : ratio[i];
}

static void at_least_lanes(uint32_t n, const double *alpha, double *restrict out)
{
    for (uint32_t i = 0; i < n; i++)
        out[i] = alpha[i] > MCR_GGX_LEAST ? alpha[i] : MCR_GGX_LEAST;
}

static int walls(const struct mcr_inputs *inputs)
{
    return inputs->stride[CHANNEL(THIN)] || inputs->channel[CHANNEL(THIN)][0] != 0;
}

static struct interface interface_lanes(const struct mcr_points *at, const struct mcr_inputs *inputs, double *room)
{
    const uint64_t stride = mcr_padded(at->n);
    const double *index = mcr_input_lanes(inputs, CHANNEL(INDEX), at->n, room + INDEX_LANES * stride);
    struct interface s = {room + RATIO * stride, mcr_input_lanes(inputs, CHANNEL(THIN), at->n, room + THIN_LANES * stride), room + ALPHA * stride};

    mcr_ratio_lanes(at, index, 0, room + RATIO * stride);
    if (walls(inputs)) {
        mcr_ratio_lanes(at, index, 1, room + WALL * stride);
        choose_lanes(at->n, s.thin, room + WALL * stride, room + RATIO * stride);
    }
    at_least_lanes(at->n, mcr_input_lanes(inputs, CHANNEL(ROUGHNESS), at->n, room + WALL * stride), room + ALPHA * stride);
    return s;
}

/* The shares that are reflected and passed on at the cosine c, of light of which `inside` crosses a thin wall. */
struct shares {
    double reflected, passed, q;
};

MCR_INLINE struct shares shares_of(double c, double ratio, double thin, double inside)
{
    struct shares s;
    double r, t, again;

    r = mcr_fresnel_dielectric(c, ratio, &s.q);
    t = 1 - r;
    again = 1 - r * r * (inside * inside);
    again = 1 / (again > 0 ? again : 1);
    s.reflected = thin != 0 ? r + t * t * (inside * inside) * r * again : r;
    s.passed = thin != 0 ? t * t * inside * again : t;
    return s;
}

/* ---- smooth ---- */

/* The directions of both lobes; `passes`: 1 where the second one was chosen. The choice knows clear walls only, and is right for coloured ones. */
static void lobe_lanes(const struct mcr_points *at, const struct interface *s, const double *choice, double *restrict x, double *restrict y,
                       double *restrict z, double *restrict probability, double *restrict passes, double *restrict cosine)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *ratio = s->ratio, *thin = s->thin;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_vector n = mcr_vector(nx[i], ny[i], nz[i]), o = mcr_vector(ox[i], oy[i], oz[i]), w, t;
        double c = mcr_dot(n, o), below, fix;
        struct shares f = shares_of(c < 1 ? c : 1, ratio[i], thin[i], 1);
        int second = choice[i] >= f.reflected, right;

        w = mcr_mirrored(o, n, mcr_dot(n, n));
        t = mcr_refracted(o, n, c, ratio[i], f.q);
        t.x = thin[i] != 0 ? -o.x : t.x;
        t.y = thin[i] != 0 ? -o.y : t.y;
        t.z = thin[i] != 0 ? -o.z : t.z;
        w.x = second ? t.x : w.x;
        w.y = second ? t.y : w.y;
        w.z = second ? t.z : w.z;
        fix = 0.5 * (1 - mcr_dot(w, w));
        below = gx[i] * w.x + gy[i] * w.y + gz[i] * w.z;
        right = (c > 0) & (second ? below < 0 : below > 0);
        x[i] = right ? w.x + w.x * fix : 0;
        y[i] = right ? w.y + w.y * fix : 0;
        z[i] = right ? w.z + w.z * fix : 0;
        probability[i] = c > 0 ? (second ? f.passed : f.reflected) : 1;
        passes[i] = right ? (second ? 1 : 0) : -1; /* neither: what the shading normal sends to the wrong side is absorbed */
        cosine[i] = c;
    }
}

/* A refracted lobe's weight is for radiance: the share that passes, over ratio^2. `inside` counts for walls. */
static void weight_lanes(uint32_t n, const struct interface *s, const double *passes, const double *cosine, const double *inside, uint32_t stride,
                         double *restrict out)
{
    const double *ratio = s->ratio, *thin = s->thin;

    for (uint32_t i = 0; i < n; i++) {
        struct shares f = shares_of(cosine[i] < 1 ? cosine[i] : 1, ratio[i], thin[i], inside[i * stride]);
        double scaled = f.passed / (ratio[i] * ratio[i]), passed = thin[i] != 0 ? f.passed : scaled;
        out[i] = passes[i] > 0 ? passed : passes[i] < 0 ? 0 : f.reflected;
    }
}

static int32_t delta(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                     const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *probability,
                     const struct mcr_colours *weight)
{
    double *room = host->scratch(host, context), *channel[3] = {weight->r, weight->g, weight->b};
    double *passes = room + CROSSED * mcr_padded(at->n), *cosine = room + COSINES * mcr_padded(at->n);
    struct interface s = interface_lanes(at, inputs, room);

    (void)instance;
    lobe_lanes(at, &s, number[0], out->x, out->y, out->z, probability, passes, cosine);
    for (uint32_t c = 0; c < 3; c++)
        weight_lanes(at->n, &s, passes, cosine, inputs->channel[CHANNEL(TRANSMITTANCE) + c], inputs->stride[CHANNEL(TRANSMITTANCE) + c], channel[c]);
    return MCR_OK;
}

/* ---- light that meets several facets ---- */

static int compensates(const struct mcr_inputs *inputs)
{
    return inputs->stride[CHANNEL(COMPENSATION)] || inputs->channel[CHANNEL(COMPENSATION)][0] != 0;
}

/* The index on this side over that on the other, and the cosine to the normal. */
MCR_LOOP void beyond_lanes(const struct mcr_points *at, const double *restrict ratio, double *restrict beyond, double *restrict cosine)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        beyond[i] = 1 / ratio[i];
        cosine[i] = mcr_within_unit_(mcr_dot(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(ox[i], oy[i], oz[i])));
    }
}

/* The same for w, by the index of the side that it is on; the side: 0 where the normals do not agree on it. */
MCR_LOOP void toward_lanes(const struct mcr_points *at, const double *restrict x, const double *restrict y, const double *restrict z, const double *restrict ratio,
                           double *restrict beyond, double *restrict cosine, double *restrict side)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_vector n = mcr_vector(nx[i], ny[i], nz[i]);
        double o = mcr_dot(n, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_dot(n, mcr_vector(x[i], y[i], z[i])), g = gx[i] * x[i] + gy[i] * y[i] + gz[i] * z[i];
        int right = (o > MCR_GGX_HORIZON) & (fabs(w) > MCR_GGX_HORIZON) & (w < 0 ? g < 0 : g > 0);

        beyond[i] = w < 0 ? beyond[i] : ratio[i];
        cosine[i] = mcr_within_unit_(fabs(w));
        side[i] = right ? (w < 0 ? -1 : 1) : 0;
    }
}

/* Walls lose what a mirror loses. */
MCR_LOOP void wall_lost_lanes(uint32_t n, const double *restrict alpha, const double *restrict thin, const double *restrict cosine, double *restrict lost)
{
    for (uint32_t i = 0; i < n; i++) {
        double wall = mcr_ggx_lost(alpha[i], cosine[i]);
        lost[i] = thin[i] != 0 ? wall : lost[i];
    }
}

/* Their lobes for light of which `inside` crosses them. */
MCR_LOOP void wall_lobe_lanes(uint32_t n, const struct interface *s, const double *restrict inside, uint32_t stride, double *restrict up, double *restrict down)
{
    const double *ratio = s->ratio, *thin = s->thin, *alpha = s->alpha;

    for (uint32_t i = 0; i < n; i++) {
        double reflected = 0, passed = 0, above, below;

        for (int k = 0; k < 8; k++) {
            struct shares f = shares_of(mcr_mean_node_[k], ratio[i], 1, inside[i * stride]);
            reflected += mcr_mean_weight_[k] * f.reflected;
            passed += mcr_mean_weight_[k] * f.passed;
        }
        mcr_glass_wall(alpha[i], reflected, passed, &above, &below);
        up[i] = thin[i] != 0 ? above : up[i];
        down[i] = thin[i] != 0 ? below : down[i];
    }
}

MCR_LOOP void wall_share_lanes(uint32_t n, const double *restrict thin, const double *restrict up, const double *restrict down, double *restrict share)
{
    for (uint32_t i = 0; i < n; i++) {
        double part = down[i] / (up[i] + down[i] > 0 ? up[i] + down[i] : 1);
        share[i] = thin[i] != 0 ? part : share[i];
    }
}

/* What o loses, 0 where nobody asks for it, and the lobes' factors and shares; of walls those of clear ones. */
static void lost(const struct mcr_points *at, const struct interface *s, const struct mcr_inputs *inputs, double *room)
{
    static const double clear[1] = {1};
    const uint64_t stride = mcr_padded(at->n);
    double *beyond = room + BEYOND * stride, *cosine = room + COSINE_O * stride, *lost = room + LOST_O * stride, *mean = room + MEAN * stride;
    double *up = room + UP * stride, *down = room + DOWN * stride, *share = room + SHARE * stride;

    beyond_lanes(at, s->ratio, beyond, cosine);
    mcr_glass_lost_lanes(at->n, s->alpha, s->ratio, cosine, lost, mean);
    mcr_glass_lost_lanes(at->n, s->alpha, beyond, NULL, NULL, room + MEAN_BEYOND * stride);
    mcr_glass_lobe_lanes(at->n, s->ratio, mean, room + MEAN_BEYOND * stride, up, down, share);
    if (walls(inputs)) {
        wall_lost_lanes(at->n, s->alpha, s->thin, cosine, lost);
        wall_lobe_lanes(at->n, s, clear, 0, up, down);
        wall_share_lanes(at->n, s->thin, up, down, share);
    }
    mcr_multiply_lanes(at->n, inputs->channel[CHANNEL(COMPENSATION)], inputs->stride[CHANNEL(COMPENSATION)], lost);
}

/* Adds the lobes toward w. */
static void lobes(const struct mcr_points *at, const struct interface *s, const struct mcr_inputs *inputs, const struct mcr_directions *toward, double *room,
                  double *const channel[3])
{
    const uint64_t stride = mcr_padded(at->n);
    double *beyond = room + BEYOND * stride, *cosine = room + COSINE_W * stride, *side = room + SIDE * stride, *other = room + LOST_W * stride;
    double *up = room + UP * stride, *down = room + DOWN * stride;

    lost(at, s, inputs, room);
    toward_lanes(at, toward->x, toward->y, toward->z, s->ratio, beyond, cosine, side);
    mcr_glass_lost_lanes(at->n, s->alpha, beyond, cosine, other, room + MEAN * stride);
    if (walls(inputs))
        wall_lost_lanes(at->n, s->alpha, s->thin, cosine, other);
    for (uint32_t c = 0; c < 3; c++) {
        if (walls(inputs))
            wall_lobe_lanes(at->n, s, inputs->channel[CHANNEL(TRANSMITTANCE) + c], inputs->stride[CHANNEL(TRANSMITTANCE) + c], up, down);
        mcr_glass_add_lanes(at->n, room + LOST_O * stride, other, cosine, side, up, down, channel[c]);
    }
}

/* ---- rough ---- */

/* What one lane scatters from o to w: the value without the shares, the density with them, the cosine at the facet, whether w is on the other side. */
MCR_INLINE struct mcr_ggx facet_lane(double alpha, double ratio, double thin, struct mcr_vector o, struct mcr_vector w)
{
    struct mcr_ggx g = mcr_ggx_interface(alpha, ratio, thin != 0, o, w);
    struct shares f = shares_of(g.cosine, ratio, thin, 1);

    g.density *= w.z < 0 ? f.passed : f.reflected;
    return g;
}

static void facet_lanes(const struct mcr_points *at, const struct interface *s, const double *const tangent[3], const double *restrict x,
                        const double *restrict y, const double *restrict z, double *restrict value, double *restrict cosine, double *restrict crossed)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *tx = tangent[0], *ty = tangent[1], *tz = tangent[2], *ratio = s->ratio, *thin = s->thin, *alpha = s->alpha;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));
        struct mcr_ggx g = facet_lane(alpha[i], ratio[i], thin[i], o, w);
        double below = gx[i] * x[i] + gy[i] * y[i] + gz[i] * z[i];
        int right = w.z < 0 ? below < 0 : below > 0;

        value[i] = right ? g.value : 0;
        cosine[i] = g.cosine;
        crossed[i] = w.z < 0 ? 1 : 0;
    }
}

/* The value of a refraction is for radiance already. */
static void share_lanes(uint32_t n, const struct interface *s, const double *value, const double *cosine, const double *crossed, const double *inside,
                        uint32_t stride, double *restrict out)
{
    const double *ratio = s->ratio, *thin = s->thin;

    for (uint32_t i = 0; i < n; i++) {
        struct shares f = shares_of(cosine[i], ratio[i], thin[i], inside[i * stride]);
        out[i] = value[i] * (crossed[i] != 0 ? f.passed : f.reflected);
    }
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    double *room = host->scratch(host, context), *channel[3] = {out->r, out->g, out->b};
    const uint64_t stride = mcr_padded(at->n);
    double *value = room + VALUES * stride, *cosine = room + COSINES * stride, *crossed = room + CROSSED * stride;
    struct interface s = interface_lanes(at, inputs, room);
    const double *tangent[3];

    (void)instance;
    mcr_tangent_lanes(at, room + TANGENT * stride, tangent);
    facet_lanes(at, &s, tangent, toward->x, toward->y, toward->z, value, cosine, crossed);
    for (uint32_t c = 0; c < 3; c++)
        share_lanes(at->n, &s, value, cosine, crossed, inputs->channel[CHANNEL(TRANSMITTANCE) + c], inputs->stride[CHANNEL(TRANSMITTANCE) + c], channel[c]);
    if (compensates(inputs))
        lobes(at, &s, inputs, toward, room, channel);
    return MCR_OK;
}

static void density_lanes(const struct mcr_points *at, const struct interface *s, const double *const tangent[3], const double *restrict x,
                          const double *restrict y, const double *restrict z, double *restrict density)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *tx = tangent[0], *ty = tangent[1], *tz = tangent[2], *ratio = s->ratio, *thin = s->thin, *alpha = s->alpha;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));

        density[i] = facet_lane(alpha[i], ratio[i], thin[i], o, w).density;
    }
}

static void draw_lanes(const struct mcr_points *at, const struct interface *s, const double *const tangent[3], const double *const *number,
                       const double *choice, double *restrict x, double *restrict y, double *restrict z)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz, *u = number[0], *v = number[1];
    const double *tx = tangent[0], *ty = tangent[1], *tz = tangent[2], *ratio = s->ratio, *thin = s->thin, *alpha = s->alpha;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), m, l, t, w;
        int visible = o.z > MCR_GGX_HORIZON, second, right;
        double length, c, above;
        struct shares share;

        o.z = visible ? o.z : 1;
        m = mcr_ggx_visible(alpha[i], alpha[i], o, u[i], v[i]);
        length = mcr_dot(m, m);
        visible &= length > 0; /* seen from straight above, the cap's edge is no normal */
        l = mcr_mirrored(o, m, length);
        length = 1 / sqrt(length > 0 ? length : 1);
        m = mcr_vector(m.x * length, m.y * length, m.z * length);
        c = mcr_dot(o, m);
        c = c < 1 ? c : 1;
        share = shares_of(c, ratio[i], thin[i], 1);
        second = choice[i] >= share.reflected;
        t = mcr_ggx_passed(o, m, c, l, ratio[i], thin[i] != 0);
        l.x = second ? t.x : l.x;
        l.y = second ? t.y : l.y;
        l.z = second ? t.z : l.z;
        w = mcr_from_frame(f, l);
        above = mcr_dot(f.n, w);
        right = visible & (second ? above < -MCR_GGX_HORIZON : above > MCR_GGX_HORIZON);
        x[i] = right ? w.x : 0;
        y[i] = right ? w.y : 0;
        z[i] = right ? w.z : 0;
    }
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    double *room = host->scratch(host, context);
    const uint64_t stride = mcr_padded(at->n);
    const double *tangent[3], *choice = number[2], *chance = room + LOST_O * stride, *share = room + SHARE * stride;
    struct interface s = interface_lanes(at, inputs, room);
    const int several = compensates(inputs);

    (void)instance;
    mcr_tangent_lanes(at, room + TANGENT * stride, tangent);
    if (several) {
        lost(at, &s, inputs, room);
        mcr_glass_choice_lanes(at->n, number[2], chance, room + CHOICE * stride);
        choice = room + CHOICE * stride;
    }
    draw_lanes(at, &s, tangent, number, choice, out->x, out->y, out->z);
    if (several)
        mcr_glass_draw_lanes(at, tangent, number, s.alpha, chance, share, out->x, out->y, out->z);
    density = density ? density : room + VALUES * stride;
    density_lanes(at, &s, tangent, out->x, out->y, out->z, density);
    if (several)
        mcr_glass_density_lanes(at, s.alpha, chance, share, out->x, out->y, out->z, density);
    mcr_drop_lanes(at->n, density, out->x, out->y, out->z);
    return MCR_OK;
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    double *room = host->scratch(host, context);
    const uint64_t stride = mcr_padded(at->n);
    struct interface s = interface_lanes(at, inputs, room);
    const double *tangent[3];

    (void)instance;
    mcr_tangent_lanes(at, room + TANGENT * stride, tangent);
    density_lanes(at, &s, tangent, toward->x, toward->y, toward->z, density);
    if (compensates(inputs)) {
        lost(at, &s, inputs, room);
        mcr_glass_density_lanes(at, s.alpha, room + LOST_O * stride, room + SHARE * stride, toward->x, toward->y, toward->z, density);
    }
    return MCR_OK;
}

/* Of a smooth interface; what a wall's inside absorbs is lost. */
static void albedo_lanes(const struct mcr_points *at, const struct interface *s, const double *inside, uint32_t stride, double *restrict out)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz, *ratio = s->ratio, *thin = s->thin;

    for (uint32_t i = 0; i < at->n; i++) {
        double c = mcr_dot(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(ox[i], oy[i], oz[i]));
        struct shares f = shares_of(mcr_within_unit_(c), ratio[i], thin[i], inside[i * stride]);
        out[i] = mcr_within_unit_(f.reflected + f.passed);
    }
}

/* That of rough ones is left to the host's estimate. */
static int32_t albedo(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    double *channel[3] = {out->r, out->g, out->b};
    struct interface s;

    (void)instance;
    if (inputs->stride[CHANNEL(ROUGHNESS)] || inputs->channel[CHANNEL(ROUGHNESS)][0] > 0)
        return MCR_E_UNSUPPORTED;
    s = interface_lanes(at, inputs, host->scratch(host, context));
    for (uint32_t c = 0; c < 3; c++)
        albedo_lanes(at, &s, inputs->channel[CHANNEL(TRANSMITTANCE) + c], inputs->stride[CHANNEL(TRANSMITTANCE) + c], channel[c]);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin),
             .kind = MCR_KIND_MATERIAL,
             .isa = MCR_ISA,
             .parameter_count = PARAMETERS,
             .name = "dielectric",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "glass and other clear matter, smooth or rough, an interior's boundary or a thin wall",
             .parameters = parameters},
    .flags = MCR_MATERIAL_STATELESS,
    .create = create,
    .traits = traits,
    .scratch_bytes = scratch_bytes,
    .evaluate = evaluate,
    .draw = draw,
    .density = density,
    .delta = delta,
    .albedo = albedo,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
