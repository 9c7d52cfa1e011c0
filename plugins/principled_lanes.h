/* SPDX-License-Identifier: Apache-2.0 */
/* principled: the settings, one number for each lane, and the directional albedos of what they make. */
#ifndef PLUGINS_PRINCIPLED_LANES_H
#define PLUGINS_PRINCIPLED_LANES_H

#include "principled_layers.h"
#include "principled_settings.h"

/* What the whole surface is. Lobes that are smooth, are not there, or are everywhere, cost nothing. */
struct surface {
    int smooth, coat, coat_smooth, sheen, transmits, thin, compensates;
    int diffuse; /* something is scattered that is no lobe of GGX */
    int several; /* light that meets several facets of glass comes back */
    double ior;
};

/*
 * Arrays of scratch, of mcr_padded(n) doubles each. ..._O and ..._W are for the outgoing direction and for the other one: LOST and GRAZING are E of the base's
 * GGX (microfacet.h), COAT and SHEEN those layers' own E, CLEAR the 1 - E of glass. BEYOND to CHOICE are used with `several` alone.
 */
enum {
    COLOURS, INPUT = COLOURS + 9, ALPHA = INPUT + 7, COAT_ALPHA, RATIO, TANGENT, COSINE_O = TANGENT + 3, COSINE_W, LOST_O, LOST_W, GRAZING_O, GRAZING_W,
    COAT_O, COAT_W, SHEEN_O, SHEEN_W, TINT, SHEEN_TINT, GREY, VALUE, FACET, CROSSED, PLAIN, REST, COATED, FIBRES, OVER, UNDER, WHITE, METAL_AGAIN, CHANCE,
    BEYOND = CHANCE + 4, CLEAR_O, CLEAR_W, MEAN, MEAN_BEYOND, UP, DOWN, SHARE, BACK, CHOICE, ARRAYS
};

static uint64_t scratch_bytes(const void *instance, uint32_t n)
{
    (void)instance;
    return ARRAYS * mcr_padded(n) * sizeof(double);
}

/* The inputs, one number for each lane. */
struct lanes {
    uint32_t n;
    const struct surface *surface;
    double *room;
    uint64_t stride;
    const double *base[3], *tint[3], *sheen[3]; /* tint: specular_color */
    const double *metallic, *specular, *coat, *transmission, *sheen_roughness, *t[3];
};

static double *room_of(const struct lanes *l, uint32_t array)
{
    return l->room + array * l->stride;
}

/* GGX's alpha, at least what a lobe can be. */
MCR_LOOP void square_lanes(uint32_t n, const double *restrict roughness, double *restrict alpha)
{
    for (uint32_t i = 0; i < n; i++) {
        double a = roughness[i] * roughness[i];
        alpha[i] = a > MCR_GGX_LEAST ? a : MCR_GGX_LEAST;
    }
}

MCR_LOOP void most_lanes(uint32_t n, const double *restrict r, const double *restrict g, const double *restrict b, double *restrict most)
{
    for (uint32_t i = 0; i < n; i++) {
        double m = r[i] > g[i] ? r[i] : g[i];
        most[i] = m > b[i] ? m : b[i];
    }
}

MCR_LOOP void grey_lanes(uint32_t n, const double *restrict r, const double *restrict g, const double *restrict b, double *restrict grey)
{
    for (uint32_t i = 0; i < n; i++)
        grey[i] = (r[i] + g[i] + b[i]) * (1.0 / 3);
}

/* The cosine to the normal, without its sign. */
MCR_LOOP void cosine_lanes(uint32_t n, const double *restrict nx, const double *restrict ny, const double *restrict nz, const double *restrict x,
                           const double *restrict y, const double *restrict z, double *restrict cosine)
{
    for (uint32_t i = 0; i < n; i++)
        cosine[i] = mcr_within_unit_(fabs(nx[i] * x[i] + ny[i] * y[i] + nz[i] * z[i]));
}

/* ---- directional albedos ---- */

/* Of GGX: what is lost, and the mean of (1 - o.h)^5. */
MCR_LOOP void ggx_lanes(uint32_t n, int smooth, const double *restrict alpha, const double *restrict cosine, double *restrict lost, double *restrict grazing)
{
    if (smooth)
        for (uint32_t i = 0; i < n; i++)
            lost[i] = 0, grazing[i] = mcr_schlick_weight(cosine[i]);
    else {
        for (uint32_t i = 0; i < n; i++)
            lost[i] = mcr_ggx_lost(alpha[i], cosine[i]);
        for (uint32_t i = 0; i < n; i++)
            grazing[i] = mcr_ggx_grazing(alpha[i], cosine[i]);
    }
}

/* All of a direction's albedos: arrays COSINE, LOST, GRAZING, COAT and SHEEN, those of o being first. */
static void albedos(const struct lanes *l, const struct mcr_points *at, const double *x, const double *y, const double *z, int toward)
{
    const struct surface *s = l->surface;
    double *cosine = room_of(l, COSINE_O + (uint32_t)toward), *coat = room_of(l, COAT_O + (uint32_t)toward);
    double *lost = room_of(l, LOST_O + (uint32_t)toward), *grazing = room_of(l, GRAZING_O + (uint32_t)toward);

    cosine_lanes(l->n, at->nx, at->ny, at->nz, x, y, z, cosine);
    if (s->coat) {
        ggx_lanes(l->n, s->coat_smooth, room_of(l, COAT_ALPHA), cosine, coat, grazing);
        coat_lanes(l->n, l->coat, grazing, coat);
    } else
        mcr_fill_lanes(l->n, 0, coat);
    if (s->sheen)
        sheen_lanes(l->n, l->sheen_roughness, cosine, room_of(l, SHEEN_O + (uint32_t)toward));
    else
        mcr_fill_lanes(l->n, 0, room_of(l, SHEEN_O + (uint32_t)toward));
    if (s->diffuse || s->several || !toward)
        ggx_lanes(l->n, s->smooth, room_of(l, ALPHA), cosine, lost, grazing);
}

/* The inputs, and the albedos of o. */
static struct lanes lanes_of(const struct surface *s, const struct mcr_points *at, const struct mcr_inputs *inputs, double *room)
{
    struct lanes l = {.n = at->n, .surface = s, .room = room, .stride = mcr_padded(at->n)};

    for (uint32_t c = 0; c < 3; c++) {
        l.base[c] = mcr_input_lanes(inputs, CHANNEL(BASE) + c, l.n, room_of(&l, COLOURS + c));
        l.tint[c] = mcr_input_lanes(inputs, CHANNEL(SPECULAR_COLOR) + c, l.n, room_of(&l, COLOURS + 3 + c));
        l.sheen[c] = mcr_input_lanes(inputs, CHANNEL(SHEEN_COLOR) + c, l.n, room_of(&l, COLOURS + 6 + c));
    }
    l.metallic = mcr_input_lanes(inputs, CHANNEL(METALLIC), l.n, room_of(&l, INPUT));
    l.specular = mcr_input_lanes(inputs, CHANNEL(SPECULAR), l.n, room_of(&l, INPUT + 1));
    l.coat = mcr_input_lanes(inputs, CHANNEL(CLEARCOAT), l.n, room_of(&l, INPUT + 2));
    l.transmission = mcr_input_lanes(inputs, CHANNEL(TRANSMISSION), l.n, room_of(&l, INPUT + 3));
    l.sheen_roughness = mcr_input_lanes(inputs, CHANNEL(SHEEN_ROUGHNESS), l.n, room_of(&l, INPUT + 4));
    square_lanes(l.n, mcr_input_lanes(inputs, CHANNEL(ROUGHNESS), l.n, room_of(&l, INPUT + 5)), room_of(&l, ALPHA));
    square_lanes(l.n, mcr_input_lanes(inputs, CHANNEL(CLEARCOAT_ROUGHNESS), l.n, room_of(&l, INPUT + 6)), room_of(&l, COAT_ALPHA));
    most_lanes(l.n, l.tint[0], l.tint[1], l.tint[2], room_of(&l, TINT));
    most_lanes(l.n, l.sheen[0], l.sheen[1], l.sheen[2], room_of(&l, SHEEN_TINT));
    grey_lanes(l.n, l.base[0], l.base[1], l.base[2], room_of(&l, GREY));
    if (s->transmits)
        mcr_ratio_lanes(at, mcr_input_lanes(inputs, CHANNEL(IOR), l.n, room_of(&l, FACET)), s->thin, room_of(&l, RATIO));
    mcr_tangent_lanes(at, room_of(&l, TANGENT), l.t);
    albedos(&l, at, at->ox, at->oy, at->oz, 0);
    return l;
}

#endif
