/* SPDX-License-Identifier: Apache-2.0 */
/*
 * principled: the metallic-roughness model of glTF 2.0 (Khronos, appendix B) with its extensions ior, specular, clearcoat, sheen, transmission and volume.
 *
 *     base = metallic metal + (1 - metallic) (transmission glass + (1 - transmission) plastic)
 *     f    = coat + C (sheen + S base)
 *
 * metal is GGX with Schlick's formula from base_color on, and with `compensation` the lobe of Kulla and Conty, "Revisiting physically based shading at
 * Imageworks" (2017), for the light that meets several facets. plastic is GGX with Schlick's formula from r = specular min(1, specular_color
 * ((ior - 1) / (ior + 1))^2) on up to `specular`, over base_color / pi (1 - E(o)) (1 - E(w)) / (1 - <E>), E being the directional albedo of the former in
 * its brightest colour and < > a mean weighted by the cosine: white loses nothing. glass is an interface with Fresnel's formulas, whose reflection `specular`
 * and `specular_color` scale, but where all is reflected; base_color tints what it passes. A thin wall has two interfaces; with F of one, all internal
 * reflections together reflect 2 F / (1 + F). Light that meets several facets of glass comes back with `compensation` as glass.h has it, tinted once: white
 * glass loses nothing. That is for Fresnel's formulas as they are; where `specular` or `specular_color` is below 1, only that share of it comes back, and
 * where specular_color raises the reflectance from r to r', (1 - r') / (1 - r): less than what is lost. A wall has no such factor.
 *
 * coat is clearcoat times GGX of F = 0.04 + 0.96 (1 - cos)^5, without a colour. sheen is sheen_color times the distribution of Estevez and Kulla,
 * "Production friendly microfacet sheen BRDF" (2017), with the visibility of Ashikhmin and Premoze, "Distribution-based BRDFs" (2007), 1 / (4 (cos_o + cos_w
 * - cos_o cos_w)); of low roughness it would reflect more than what arrives at grazing angles, and is divided by the larger of E(o), E(w) and 1.
 * What is below a layer of directional albedo E is scaled by min(1 - E(o), 1 - E(w)), as the extension for sheen has it: f is reciprocal, and no light is
 * made, but a white base under a layer loses some: at most the mean of max(0, E(w) - E(o)), from above 5 % under a full coat, 11 % under white sheen.
 *
 * The layers are on both sides, as are metal and plastic. Smooth lobes (roughness 0 everywhere) are found by `delta`. A texture of roughness that is not 0
 * everywhere makes lobes, of 1e-7 rad where it is 0.
 */
#include "principled_base.h"
#include "principled_lanes.h"
#include <mcrender/glass.h>
#include <stdlib.h>

/* ---- create ---- */

static double attenuation_of(const double *number, int c)
{
    return -mcr_log(number[CHANNEL(ATTENUATION_COLOR) + c]) / number[CHANNEL(ATTENUATION_DISTANCE)] + 0.0;
}

/* A mean is 0 or 1 only where all is. */
static struct surface surface_of(const double *number)
{
    const double *colour = number + CHANNEL(SHEEN_COLOR), metallic = number[CHANNEL(METALLIC)], transmission = number[CHANNEL(TRANSMISSION)];
    struct surface s = {0};

    s.ior = number[CHANNEL(IOR)];
    s.smooth = !(number[CHANNEL(ROUGHNESS)] > 0);
    s.coat = number[CHANNEL(CLEARCOAT)] > 0;
    s.coat_smooth = s.coat && !(number[CHANNEL(CLEARCOAT_ROUGHNESS)] > 0);
    s.sheen = colour[0] > 0 || colour[1] > 0 || colour[2] > 0;
    s.transmits = transmission > 0 && metallic < 1;
    s.thin = number[CHANNEL(THIN)] != 0;
    s.compensates = metallic > 0 && number[CHANNEL(COMPENSATION)] != 0 && !s.smooth;
    s.several = s.transmits && number[CHANNEL(COMPENSATION)] != 0 && !s.smooth;
    s.diffuse = s.compensates || (metallic < 1 && transmission < 1);
    return s;
}

/* What would be ignored is a mistake. */
static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    const uint32_t *given = with->values->given;
    const double *number = with->values->number;
    const int volume = given[ATTENUATION_COLOR] || given[ATTENUATION_DISTANCE] || given[PRIORITY];
    struct surface *s;

    *instance = NULL;
    if (volume && number[CHANNEL(THIN)] != 0)
        return mcr_refuse(host, context, "'attenuation_color', 'attenuation_distance' and 'priority' have no effect with 'thin yes': a thin wall has no interior");
    if ((volume || given[THIN]) && !(number[CHANNEL(TRANSMISSION)] > 0))
        return mcr_refuse(host, context, "'thin', 'attenuation_color', 'attenuation_distance' and 'priority' have no effect without 'transmission'");
    if (given[ATTENUATION_COLOR] != given[ATTENUATION_DISTANCE])
        return mcr_refuse(host, context, "'attenuation_color' and 'attenuation_distance' belong together: give both or neither");
    for (int c = 0; c < 3; c++)
        if (!(attenuation_of(number, c) < HUGE_VAL))
            return mcr_refuse(host, context, "'attenuation_distance' is too small for this 'attenuation_color': the attenuation is infinite");
    s = malloc(sizeof *s);
    if (!s)
        return MCR_E_NOMEM;
    *s = surface_of(number);
    *instance = s;
    return MCR_OK;
}

static void destroy(void *instance)
{
    free(instance);
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    const struct surface s = surface_of(values->number);

    (void)host, (void)context, (void)instance;
    traits->does = (s.smooth || s.coat_smooth ? MCR_MATERIAL_DELTA : 0) | (s.transmits && !s.smooth ? MCR_MATERIAL_TRANSMITS : 0);
    if (!s.smooth || s.diffuse || s.sheen || (s.coat && !s.coat_smooth))
        traits->does |= MCR_MATERIAL_REFLECTS;
    if (s.transmits && !s.thin) {
        traits->does |= MCR_MATERIAL_INTERIOR;
        traits->index = s.ior;
        for (int c = 0; c < 3; c++)
            traits->attenuation[c] = attenuation_of(values->number, c);
        traits->priority = values->number[CHANNEL(PRIORITY)];
    } else if (s.transmits) {
        traits->does |= MCR_MATERIAL_THIN;
    }
    return MCR_OK;
}

/* ---- evaluate ---- */

/* GGX of the base without its shares; the cosine at the facet, whether w is on the other side. */
MCR_LOOP void facet_lanes(const struct mcr_points *at, const double *const t[3], const double *restrict alpha, const double *restrict ratio, int thin,
                          const double *restrict x, const double *restrict y, const double *restrict z, double *restrict value, double *restrict cosine)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz, *tx = t[0], *ty = t[1], *tz = t[2];

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));
        struct mcr_ggx g = mcr_ggx_interface(alpha[i], ratio[i], thin, o, w);

        value[i] = g.value;
        cosine[i] = g.cosine;
    }
}

/* GGX above alone, without Fresnel's share. */
MCR_LOOP void reflect_lanes(const struct mcr_points *at, const double *const t[3], const double *restrict alpha, const double *restrict x,
                            const double *restrict y, const double *restrict z, double *restrict value, double *restrict cosine)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz, *tx = t[0], *ty = t[1], *tz = t[2];

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));
        struct mcr_ggx g = mcr_ggx_reflect(alpha[i], alpha[i], o, w);

        value[i] = g.value;
        cosine[i] = g.cosine;
    }
}

MCR_LOOP void glass_lanes(uint32_t n, const double *restrict cosine, const double *restrict ratio, double *restrict plain, double *restrict rest)
{
    for (uint32_t i = 0; i < n; i++) {
        struct glass g = glass_of(cosine[i], ratio[i]);
        plain[i] = g.plain;
        rest[i] = g.rest;
    }
}

/* f cos of white plastic's diffuse part, and of a metal's light of several facets without F_ms. */
MCR_LOOP void diffuse_lanes(const struct lanes *l, double least, int compensates, const double *restrict alpha, const double *restrict tint,
                            const double *restrict specular, const double *restrict cosine, const double *restrict lost_o, const double *restrict lost_w,
                            const double *restrict grazing_o, const double *restrict grazing_w, double *restrict white, double *restrict again)
{
    const int smooth = l->surface->smooth;

    for (uint32_t i = 0; i < l->n; i++) {
        double lost = smooth ? 0 : mcr_ggx_mean_lost(alpha[i]), grazing = smooth ? 1.0 / 21 : mcr_ggx_mean_grazing(alpha[i]);
        double r = plastic_of(least, tint[i], specular[i], 0), rise = specular[i] - r, f = cosine[i] * MCR_PER_PI;
        double out = 1 - (1 - lost_o[i]) * (r + rise * grazing_o[i]), in = 1 - (1 - lost_w[i]) * (r + rise * grazing_w[i]);
        double mean = 1 - (r * (1 - lost - grazing) + specular[i] * grazing);

        mean = mean > 1e-9 ? mean : 1e-9; /* all is reflected: out and in are 0, or what is lost */
        white[i] = f * (out * in / mean);
        again[i] = compensates ? f * (lost_o[i] * lost_w[i] / (lost > 0 ? lost : 1)) : 0;
    }
}

/* The base of one colour, f cos: GGX's part. */
MCR_LOOP void specular_lanes(const struct lanes *l, double least, const double *restrict value, const double *restrict cosine, const double *restrict base,
                             const double *restrict tint, double *restrict out)
{
    const double *metallic = l->metallic, *specular = l->specular;

    for (uint32_t i = 0; i < l->n; i++) {
        double weight = mcr_schlick_weight(cosine[i]), metal = base[i] + (1 - base[i]) * weight;
        out[i] = value[i] * (metallic[i] * metal + (1 - metallic[i]) * plastic_of(least, tint[i], specular[i], weight));
    }
}

/* The same with glass. What passes is what the brightest colour does not reflect. */
MCR_LOOP void clear_lanes(const struct lanes *l, double least, const double *restrict value, const double *restrict cosine, const double *restrict base,
                          const double *restrict tint, double *restrict out)
{
    const double *metallic = l->metallic, *specular = l->specular, *transmission = l->transmission, *ratio = room_of(l, RATIO), *most = room_of(l, TINT);
    const double *plain = room_of(l, PLAIN), *rest = room_of(l, REST), *crossed = room_of(l, CROSSED);
    const int thin = l->surface->thin;

    for (uint32_t i = 0; i < l->n; i++) {
        double weight = mcr_schlick_weight(cosine[i]), metal = base[i] + (1 - base[i]) * weight, t = transmission[i];
        double f = interface_of(plain[i], rest[i], ratio[i], tint[i], specular[i]), brightest = interface_of(plain[i], rest[i], ratio[i], most[i], specular[i]);
        double all = thin ? wall_of(f) : f, passed = (1 - (thin ? wall_of(brightest) : brightest)) * base[i];
        double above = metallic[i] * metal + (1 - metallic[i]) * (t * all + (1 - t) * plastic_of(least, tint[i], specular[i], weight));

        out[i] = value[i] * (crossed[i] != 0 ? (1 - metallic[i]) * t * passed : above);
    }
}

MCR_LOOP void spread_lanes(const struct lanes *l, const double *restrict alpha, const double *restrict base, const double *restrict white,
                           const double *restrict again, double *restrict out)
{
    const double *metallic = l->metallic, *transmission = l->transmission, *crossed = room_of(l, CROSSED);

    for (uint32_t i = 0; i < l->n; i++) {
        double kept = 1 - mcr_ggx_mean_lost(alpha[i]), f = (20 * base[i] + 1) * (1.0 / 21), several = f * f * kept / (1 - f * (1 - kept));
        double sum = (1 - metallic[i]) * (1 - transmission[i]) * base[i] * white[i] + metallic[i] * several * again[i];
        out[i] += crossed[i] != 0 ? 0 : sum;
    }
}

static void shapes(const struct lanes *l, const struct mcr_points *at, const double *x, const double *y, const double *z)
{
    const struct surface *s = l->surface;
    double *value = room_of(l, VALUE), *cosine = room_of(l, FACET), *coated = room_of(l, COATED);

    mcr_fill_lanes(l->n, 0, coated);
    mcr_fill_lanes(l->n, 0, room_of(l, FIBRES));
    if (s->coat && !s->coat_smooth) {
        reflect_lanes(at, l->t, room_of(l, COAT_ALPHA), x, y, z, coated, cosine);
        coated_lanes(l->n, l->coat, cosine, coated);
    }
    if (s->sheen)
        fibre_lanes(at, l->sheen_roughness, x, y, z, room_of(l, SHEEN_O), room_of(l, SHEEN_W), room_of(l, FIBRES));
    cover_lanes(at, x, y, z, room_of(l, COAT_O), room_of(l, COAT_W), room_of(l, SHEEN_O), room_of(l, SHEEN_W), room_of(l, SHEEN_TINT), room_of(l, OVER),
                room_of(l, UNDER), room_of(l, CROSSED));
    if (s->smooth)
        return;
    if (s->transmits) {
        facet_lanes(at, l->t, room_of(l, ALPHA), room_of(l, RATIO), s->thin, x, y, z, value, cosine);
        glass_lanes(l->n, cosine, room_of(l, RATIO), room_of(l, PLAIN), room_of(l, REST));
    } else
        reflect_lanes(at, l->t, room_of(l, ALPHA), x, y, z, value, cosine);
}

/* ---- light that meets several facets of glass ---- */

/* The index on this side over that on the other. */
MCR_LOOP void beyond_lanes(uint32_t n, const double *restrict ratio, double *restrict beyond)
{
    for (uint32_t i = 0; i < n; i++)
        beyond[i] = 1 / ratio[i];
}

/* Of the side that w is on. */
MCR_LOOP void same_side_lanes(uint32_t n, const double *restrict ratio, const double *restrict crossed, double *restrict beyond)
{
    for (uint32_t i = 0; i < n; i++)
        beyond[i] = crossed[i] != 0 ? beyond[i] : ratio[i];
}

/* The lobes of a wall, in its brightest colour. */
MCR_LOOP void wall_lobe_lanes(const struct lanes *l, double *restrict up, double *restrict down, double *restrict share)
{
    const double *alpha = room_of(l, ALPHA), *ratio = room_of(l, RATIO), *tint = room_of(l, TINT), *specular = l->specular;

    for (uint32_t i = 0; i < l->n; i++) {
        double reflected = 0;

        for (int k = 0; k < 8; k++) {
            struct glass g = glass_of(mcr_mean_node_[k], ratio[i]);
            reflected += mcr_mean_weight_[k] * wall_of(interface_of(g.plain, g.rest, ratio[i], tint[i], specular[i]));
        }
        mcr_glass_wall(alpha[i], reflected, 1 - reflected, &up[i], &down[i]);
        share[i] = 1 - reflected;
    }
}

/* What comes back, of all that glass of Fresnel's formulas loses: 1 for walls, which lose the same whatever they reflect. */
MCR_LOOP void back_lanes(const struct lanes *l, double least, double *restrict back)
{
    const double *tint = room_of(l, TINT), *specular = l->specular, *metallic = l->metallic, *transmission = l->transmission;
    const int thin = l->surface->thin;

    for (uint32_t i = 0; i < l->n; i++) {
        double r = least * tint[i], left = (1 - (r < 1 ? r : 1)) / (1 - least), kept = specular[i] * (tint[i] < 1 ? tint[i] : left);
        back[i] = (1 - metallic[i]) * transmission[i] * (thin ? 1 : kept);
    }
}

/* Of the outgoing direction. */
static void lose(const struct lanes *l)
{
    const struct surface *s = l->surface;
    double *beyond = room_of(l, BEYOND), *up = room_of(l, UP), *down = room_of(l, DOWN), *share = room_of(l, SHARE);

    back_lanes(l, least_of(s->ior), room_of(l, BACK));
    if (s->thin) {
        wall_lobe_lanes(l, up, down, share);
        return;
    }
    beyond_lanes(l->n, room_of(l, RATIO), beyond);
    mcr_glass_lost_lanes(l->n, room_of(l, ALPHA), room_of(l, RATIO), room_of(l, COSINE_O), room_of(l, CLEAR_O), room_of(l, MEAN));
    mcr_glass_lost_lanes(l->n, room_of(l, ALPHA), beyond, NULL, NULL, room_of(l, MEAN_BEYOND));
    mcr_glass_lobe_lanes(l->n, room_of(l, RATIO), room_of(l, MEAN), room_of(l, MEAN_BEYOND), up, down, share);
}

static const double *lost_of(const struct lanes *l, int toward)
{
    return room_of(l, (l->surface->thin ? LOST_O : CLEAR_O) + (uint32_t)toward);
}

/* Of both directions. */
static void lose_both(const struct lanes *l)
{
    lose(l);
    if (l->surface->thin)
        return;
    same_side_lanes(l->n, room_of(l, RATIO), room_of(l, CROSSED), room_of(l, BEYOND));
    mcr_glass_lost_lanes(l->n, room_of(l, ALPHA), room_of(l, BEYOND), room_of(l, COSINE_W), room_of(l, CLEAR_W), room_of(l, MEAN));
}

MCR_LOOP void again_lanes(const struct lanes *l, const double *restrict lost_o, const double *restrict lost_w, const double *restrict base, double *restrict out)
{
    const double *cosine = room_of(l, COSINE_W), *crossed = room_of(l, CROSSED), *up = room_of(l, UP), *down = room_of(l, DOWN), *back = room_of(l, BACK);

    for (uint32_t i = 0; i < l->n; i++) {
        double f = lost_o[i] * lost_w[i] * cosine[i] * (crossed[i] != 0 ? down[i] : up[i]);
        out[i] += back[i] * base[i] * f;
    }
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    const struct surface *s = instance;
    struct lanes l = lanes_of(s, at, inputs, host->scratch(host, context));
    double *channel[3] = {out->r, out->g, out->b}, least = least_of(s->ior), *white = room_of(&l, WHITE), *again = room_of(&l, METAL_AGAIN);

    albedos(&l, at, toward->x, toward->y, toward->z, 1);
    shapes(&l, at, toward->x, toward->y, toward->z);
    if (s->diffuse)
        diffuse_lanes(&l, least, s->compensates, room_of(&l, ALPHA), room_of(&l, TINT), l.specular, room_of(&l, COSINE_W), room_of(&l, LOST_O),
                      room_of(&l, LOST_W), room_of(&l, GRAZING_O), room_of(&l, GRAZING_W), white, again);
    if (s->several)
        lose_both(&l);
    for (uint32_t c = 0; c < 3; c++) {
        if (s->smooth)
            mcr_fill_lanes(l.n, 0, channel[c]);
        else if (s->transmits)
            clear_lanes(&l, least, room_of(&l, VALUE), room_of(&l, FACET), l.base[c], l.tint[c], channel[c]);
        else
            specular_lanes(&l, least, room_of(&l, VALUE), room_of(&l, FACET), l.base[c], l.tint[c], channel[c]);
        if (s->diffuse)
            spread_lanes(&l, room_of(&l, ALPHA), l.base[c], white, again, channel[c]);
        if (s->several)
            again_lanes(&l, lost_of(&l, 0), lost_of(&l, 1), l.base[c], channel[c]);
        layers_lanes(l.n, room_of(&l, OVER), room_of(&l, UNDER), room_of(&l, CROSSED), room_of(&l, COATED), room_of(&l, FIBRES), l.sheen[c], channel[c]);
    }
    return MCR_OK;
}

/* ---- sampling ---- */

/* About how much each lobe scatters, in grey: coat, GGX of the base, sheen, diffuse; 0 of those that are smooth. What is not 0 has a chance. */
MCR_LOOP void weights_lanes(const struct lanes *l, double *restrict coated, double *restrict facets, double *restrict fibres, double *restrict diffuse)
{
    const struct surface *s = l->surface;
    const double *lost = room_of(l, LOST_O), *grazing = room_of(l, GRAZING_O), *coat = room_of(l, COAT_O), *sheen = room_of(l, SHEEN_O);
    const double *grey = room_of(l, GREY), *tint = room_of(l, TINT), *fibre_tint = room_of(l, SHEEN_TINT), *metallic = l->metallic;
    const double *transmission = l->transmission, *specular = l->specular, least = least_of(s->ior);
    const double coat_rough = s->coat_smooth ? 0 : 1, rough = s->smooth ? 0 : 1, again = s->compensates ? 1 : 0;

    for (uint32_t i = 0; i < l->n; i++) {
        double t = transmission[i], m = metallic[i], g = grey[i], e = sheen[i] < 1 ? sheen[i] : 1, over = 1 - coat[i], under = over * (1 - fibre_tint[i] * e);
        double plastic = plastic_of(least, tint[i], specular[i], grazing[i]), metal = g + (1 - g) * grazing[i], any = t > specular[i] ? t : specular[i];
        double all = m * metal + (1 - m) * (t * (0.1 + 0.9 * g) + (1 - t) * plastic) + 1e-3 * (m + (1 - m) * any);

        coated[i] = coat_rough * coat[i];
        facets[i] = rough * (under * ((1 - lost[i]) * all));
        fibres[i] = over * (fibre_tint[i] * e);
        diffuse[i] = under * (g * ((1 - m) * (1 - t) * (1 - (1 - lost[i]) * plastic) + again * m * lost[i]));
    }
}

/* The four weights become the numbers up to which coat, base and sheen are drawn. */
MCR_LOOP void cuts_lanes(uint32_t n, double *restrict coated, double *restrict facets, double *restrict fibres, const double *restrict diffuse)
{
    for (uint32_t i = 0; i < n; i++) {
        double first = coated[i], second = first + facets[i], third = second + fibres[i], sum = third + diffuse[i];

        sum = sum > 0 ? sum : 1;
        coated[i] = first / sum;
        facets[i] = second / sum;
        fibres[i] = third / sum;
    }
}

/* Of all weights, that of the light that meets several facets of glass: as the chance of its lobes, `back`. */
MCR_LOOP void several_lanes(const struct lanes *l, const double *restrict lost, const double *restrict coated, const double *restrict facets,
                            const double *restrict fibres, const double *restrict diffuse, double *restrict back)
{
    const double *coat = room_of(l, COAT_O), *sheen = room_of(l, SHEEN_O), *tint = room_of(l, SHEEN_TINT), *grey = room_of(l, GREY);

    for (uint32_t i = 0; i < l->n; i++) {
        double e = sheen[i] < 1 ? sheen[i] : 1, weight = (1 - coat[i]) * (1 - tint[i] * e) * grey[i] * back[i] * lost[i];
        double sum = coated[i] + facets[i] + fibres[i] + diffuse[i] + weight;
        back[i] = weight / (sum > 0 ? sum : 1);
    }
}

static void chances(const struct lanes *l)
{
    double *c[4];

    for (uint32_t k = 0; k < 4; k++)
        c[k] = room_of(l, CHANCE + k);
    weights_lanes(l, c[0], c[1], c[2], c[3]);
    if (l->surface->several) {
        lose(l);
        several_lanes(l, lost_of(l, 0), c[0], c[1], c[2], c[3], room_of(l, BACK));
    }
    cuts_lanes(l->n, c[0], c[1], c[2], c[3]);
    if (!l->surface->transmits)
        mcr_fill_lanes(l->n, l->surface->ior, room_of(l, RATIO)); /* any number: nothing passes */
}

/* The chance that the base's facet reflects. */
MCR_INLINE double reflects_at(double cosine, double ratio, double least, double tint, double specular, double metallic, double transmission, double grey, int thin)
{
    return reflects_of(shares_of(cosine, glass_of(cosine, ratio), ratio, least, tint, specular, metallic, transmission, grey, thin));
}

/* GGX: drawn by the coat's facets and by the base's, which reflect or pass. */
MCR_LOOP void density_lanes(const struct lanes *l, const struct mcr_points *at, const double *restrict x, const double *restrict y, const double *restrict z,
                            double *restrict density)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz, *tx = l->t[0], *ty = l->t[1], *tz = l->t[2];
    const double *first = room_of(l, CHANCE), *second = room_of(l, CHANCE + 1), *third = room_of(l, CHANCE + 2), *alpha = room_of(l, ALPHA);
    const double *coat_alpha = room_of(l, COAT_ALPHA), *ratio = room_of(l, RATIO), *tint = room_of(l, TINT), *grey = room_of(l, GREY);
    const double *specular = l->specular, *metallic = l->metallic, *transmission = l->transmission, least = least_of(l->surface->ior);
    const int thin = l->surface->thin;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_to_frame(f, mcr_vector(x[i], y[i], z[i]));
        struct mcr_ggx coat = mcr_ggx_reflect(coat_alpha[i], coat_alpha[i], o, w), facet = mcr_ggx_interface(alpha[i], ratio[i], thin, o, w);
        int seen = (o.z > MCR_GGX_HORIZON) & (fabs(w.z) > MCR_GGX_HORIZON);
        double base = facet.density, chance = reflects_at(facet.cosine, ratio[i], least, tint[i], specular[i], metallic[i], transmission[i], grey[i], thin), above;

        base *= (second[i] - first[i]) * (w.z < 0 ? 1 - chance : chance);
        above = first[i] * coat.density + (third[i] - second[i]) * (0.5 * MCR_PER_PI) + (1 - third[i]) * (w.z * MCR_PER_PI);
        base += w.z > 0 ? above : 0;
        density[i] = seen ? base : 0;
    }
}

MCR_LOOP void draw_lanes(const struct lanes *l, const struct mcr_points *at, const double *const *number, double *restrict x, double *restrict y,
                         double *restrict z)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz, *tx = l->t[0], *ty = l->t[1], *tz = l->t[2];
    const double *first = room_of(l, CHANCE), *second = room_of(l, CHANCE + 1), *third = room_of(l, CHANCE + 2), *alpha = room_of(l, ALPHA);
    const double *coat_alpha = room_of(l, COAT_ALPHA), *ratio = room_of(l, RATIO), *tint = room_of(l, TINT), *grey = room_of(l, GREY);
    const double *specular = l->specular, *metallic = l->metallic, *transmission = l->transmission, least = least_of(l->surface->ior);
    const double *u = number[0], *v = number[1], *choice = number[2];
    const int thin = l->surface->thin;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        struct mcr_vector o = mcr_to_frame(f, mcr_vector(ox[i], oy[i], oz[i])), m, d, p, w;
        int visible = o.z > MCR_GGX_HORIZON, coated = choice[i] < first[i], facet = choice[i] < second[i], fibre = choice[i] < third[i], passes;
        double px, py, rest = mcr_disk_from_square(u[i], v[i], &px, &py), a = coated ? coat_alpha[i] : alpha[i], length2, inverse, c, chance, left;
        double span = second[i] - first[i], wide = sqrt(1 + rest), above;

        o.z = visible ? o.z : 1;
        m = mcr_ggx_visible(a, a, o, u[i], v[i]);
        length2 = mcr_dot(m, m);
        visible &= (length2 > 0) | !facet; /* seen from straight above, the cap's edge is no normal */
        d = mcr_mirrored(o, m, length2);
        inverse = 1 / sqrt(length2 > 0 ? length2 : 1);
        m = mcr_vector(m.x * inverse, m.y * inverse, m.z * inverse);
        c = mcr_dot(o, m);
        c = mcr_within_unit_(c);
        chance = reflects_at(c, ratio[i], least, tint[i], specular[i], metallic[i], transmission[i], grey[i], thin);
        left = choice[i] - first[i];
        passes = facet & !coated & (left >= chance * span);
        p = mcr_ggx_passed(o, m, c, d, ratio[i], thin);
        d.x = passes ? p.x : d.x;
        d.y = passes ? p.y : d.y;
        d.z = passes ? p.z : d.z;
        /* the disk's point under a cosine lobe's direction, and, drawn in, under one that is uniform over the hemisphere: height = 1 - radius^2 = rest */
        wide = fibre ? wide : 1;
        d.x = facet ? d.x : px * wide;
        d.y = facet ? d.y : py * wide;
        d.z = facet ? d.z : fibre ? rest : sqrt(rest);
        w = mcr_from_frame(f, d);
        above = mcr_dot(f.n, w);
        visible &= passes ? above < -MCR_GGX_HORIZON : above > MCR_GGX_HORIZON;
        x[i] = visible ? w.x : 0;
        y[i] = visible ? w.y : 0;
        z[i] = visible ? w.z : 0;
    }
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    struct lanes l = lanes_of(instance, at, inputs, host->scratch(host, context));
    const double *others[3] = {number[0], number[1], number[2]}, *chance = room_of(&l, BACK), *share = room_of(&l, SHARE), *alpha = room_of(&l, ALPHA);
    const int several = l.surface->several;

    chances(&l);
    if (several) {
        mcr_glass_choice_lanes(l.n, number[2], chance, room_of(&l, CHOICE));
        others[2] = room_of(&l, CHOICE);
    }
    draw_lanes(&l, at, others, out->x, out->y, out->z);
    if (several)
        mcr_glass_draw_lanes(at, l.t, number, alpha, chance, share, out->x, out->y, out->z);
    density = density ? density : room_of(&l, VALUE);
    density_lanes(&l, at, out->x, out->y, out->z, density);
    if (several)
        mcr_glass_density_lanes(at, alpha, chance, share, out->x, out->y, out->z, density);
    mcr_drop_lanes(l.n, density, out->x, out->y, out->z);
    return MCR_OK;
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    struct lanes l = lanes_of(instance, at, inputs, host->scratch(host, context));

    chances(&l);
    density_lanes(&l, at, toward->x, toward->y, toward->z, density);
    if (l.surface->several)
        mcr_glass_density_lanes(at, room_of(&l, ALPHA), room_of(&l, BACK), room_of(&l, SHARE), toward->x, toward->y, toward->z, density);
    return MCR_OK;
}

/* ---- smooth lobes ---- */

/* Mirrors or passes straight on (0, 0, 0: neither); those directions that are on the wrong side of the geometric surface are not there. */
MCR_LOOP void choose_lanes(const struct lanes *l, const struct mcr_points *at, const double *restrict choice, double *restrict x, double *restrict y,
                           double *restrict z, double *restrict probability)
{
    const struct surface *s = l->surface;
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;
    const double *ratio = room_of(l, RATIO), *tint = room_of(l, TINT), *grey = room_of(l, GREY), *specular = l->specular, *metallic = l->metallic;
    const double *transmission = l->transmission, *coat = room_of(l, COAT_O), *sheen = room_of(l, SHEEN_O), *sheen_tint = room_of(l, SHEEN_TINT);
    const double *w0 = room_of(l, CHANCE), *w1 = room_of(l, CHANCE + 1), *w2 = room_of(l, CHANCE + 2), *w3 = room_of(l, CHANCE + 3);
    const double least = least_of(s->ior), smooth = s->smooth ? 1 : 0, coat_smooth = s->coat_smooth ? 1 : 0;
    const int thin = s->thin;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_vector n = mcr_vector(nx[i], ny[i], nz[i]), o = mcr_vector(ox[i], oy[i], oz[i]), m = mcr_mirrored(o, n, mcr_dot(n, n)), p;
        double signed_c = mcr_dot(n, o), c = mcr_within_unit_(signed_c), e = sheen[i] < 1 ? sheen[i] : 1, none = w0[i] + w1[i] + w2[i] + w3[i];
        double under = smooth * ((1 - coat[i]) * (1 - sheen_tint[i] * e)), mirrors, passes, sum, first, second, fix;
        struct glass g = glass_of(c, ratio[i]);
        struct shares f = shares_of(c, g, ratio[i], least, tint[i], specular[i], metallic[i], transmission[i], grey[i], thin);
        int up, down, through, drawn;

        p = mcr_refracted(o, n, signed_c, ratio[i], g.q);
        p.x = thin ? -o.x : p.x;
        p.y = thin ? -o.y : p.y;
        p.z = thin ? -o.z : p.z;
        up = (signed_c > MCR_GGX_HORIZON) & (gx[i] * m.x + gy[i] * m.y + gz[i] * m.z > 0);
        down = (signed_c > MCR_GGX_HORIZON) & (gx[i] * p.x + gy[i] * p.y + gz[i] * p.z < 0);
        mirrors = up ? coat_smooth * coat[i] + under * f.reflected : 0;
        passes = down ? under * f.passed : 0;
        none = none > 0 ? none + 0.01 : 0; /* layers may let through more than their estimate */
        sum = mirrors + passes + none;
        first = sum > 0 ? mirrors / sum : 0;
        second = sum > 0 ? (mirrors + passes) / sum : 0;
        through = choice[i] >= first;
        drawn = choice[i] < second;
        p.x = through ? p.x : m.x;
        p.y = through ? p.y : m.y;
        p.z = through ? p.z : m.z;
        fix = 1 + 0.5 * (1 - mcr_dot(p, p));
        x[i] = drawn ? p.x * fix : 0;
        y[i] = drawn ? p.y * fix : 0;
        z[i] = drawn ? p.z * fix : 0;
        probability[i] = drawn ? (through ? second - first : first) : 1 - second;
    }
}

/* A refracted lobe's weight is for radiance. */
MCR_LOOP void unit_lanes(uint32_t n, const double *restrict ratio, const double *restrict crossed, int thin, double *restrict value)
{
    for (uint32_t i = 0; i < n; i++) {
        double scaled = 1 / (ratio[i] * ratio[i]);
        value[i] = (thin | (crossed[i] == 0)) ? 1 : scaled;
    }
}

static int32_t delta(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                     const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *probability,
                     const struct mcr_colours *weight)
{
    const struct surface *s = instance;
    struct lanes l = lanes_of(s, at, inputs, host->scratch(host, context));
    double *channel[3] = {weight->r, weight->g, weight->b}, *cosine = room_of(&l, COSINE_O), *value = room_of(&l, VALUE), *coated = room_of(&l, COATED);
    const double least = least_of(s->ior);

    weights_lanes(&l, room_of(&l, CHANCE), room_of(&l, CHANCE + 1), room_of(&l, CHANCE + 2), room_of(&l, CHANCE + 3));
    if (!s->transmits)
        mcr_fill_lanes(l.n, s->ior, room_of(&l, RATIO));
    choose_lanes(&l, at, number[0], out->x, out->y, out->z, probability);
    albedos(&l, at, out->x, out->y, out->z, 1);
    cover_lanes(at, out->x, out->y, out->z, room_of(&l, COAT_O), room_of(&l, COAT_W), room_of(&l, SHEEN_O), room_of(&l, SHEEN_W), room_of(&l, SHEEN_TINT),
                room_of(&l, OVER), room_of(&l, UNDER), room_of(&l, CROSSED));
    unit_lanes(l.n, room_of(&l, RATIO), room_of(&l, CROSSED), s->thin, value);
    glass_lanes(l.n, cosine, room_of(&l, RATIO), room_of(&l, PLAIN), room_of(&l, REST));
    mcr_fill_lanes(l.n, s->coat_smooth ? 1 : 0, coated);
    coated_lanes(l.n, l.coat, cosine, coated);
    mcr_fill_lanes(l.n, 0, room_of(&l, FIBRES));
    for (uint32_t c = 0; c < 3; c++) {
        if (s->smooth)
            clear_lanes(&l, least, value, cosine, l.base[c], l.tint[c], channel[c]);
        else
            mcr_fill_lanes(l.n, 0, channel[c]);
        layers_lanes(l.n, room_of(&l, OVER), room_of(&l, UNDER), room_of(&l, CROSSED), coated, room_of(&l, FIBRES), l.sheen[c], channel[c]);
    }
    return MCR_OK;
}

/* ---- feature layers ---- */

/* Of plastic, and of metal without compensation. */
MCR_LOOP void albedo_lanes(const struct lanes *l, const double *restrict base, const double *restrict tint, double *restrict out)
{
    const double *lost = room_of(l, LOST_O), *grazing = room_of(l, GRAZING_O), *brightest = room_of(l, TINT), *specular = l->specular, *metallic = l->metallic;
    const double least = least_of(l->surface->ior);

    for (uint32_t i = 0; i < l->n; i++) {
        double kept = 1 - lost[i], metal = kept * (base[i] + (1 - base[i]) * grazing[i]);
        double reflected = kept * plastic_of(least, tint[i], specular[i], grazing[i]);
        double under = (1 - kept * plastic_of(least, brightest[i], specular[i], grazing[i])) * base[i];

        out[i] = mcr_within_unit_(metallic[i] * metal + (1 - metallic[i]) * (reflected + under));
    }
}

/* That of layers, of glass and of what comes back from metal is left to the host's estimate. */
static int32_t albedo(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    const struct surface *s = instance;
    double *channel[3] = {out->r, out->g, out->b};
    struct lanes l;

    if (s->coat || s->sheen || s->transmits || s->compensates)
        return MCR_E_UNSUPPORTED;
    l = lanes_of(instance, at, inputs, host->scratch(host, context));
    for (uint32_t c = 0; c < 3; c++)
        albedo_lanes(&l, l.base[c], l.tint[c], channel[c]);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin),
             .kind = MCR_KIND_MATERIAL,
             .isa = MCR_ISA,
             .parameter_count = PARAMETERS,
             .name = "principled",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "glTF's metallic-roughness model with clear coat, sheen, transmission and volume; `roughness` is perceptual",
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
