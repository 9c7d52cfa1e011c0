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
 * reflections together reflect 2 F / (1 + F). Light that meets several facets of glass is lost, as with `dielectric`: of clear glass of index 1.5 seen at 60
 * degrees 0.7 % at roughness 0.3, 26 % at 1.
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
#include <mcrender/math.h>
#include <mcrender/microfacet.h>
#include <stdlib.h>

/* Parameters, in the order of the table. */
enum {
    BASE, METALLIC, ROUGHNESS, IOR, SPECULAR, SPECULAR_COLOR, CLEARCOAT, CLEARCOAT_ROUGHNESS, SHEEN_COLOR, SHEEN_ROUGHNESS, TRANSMISSION, THIN,
    ATTENUATION_COLOR, ATTENUATION_DISTANCE, PRIORITY, COMPENSATION, PARAMETERS
};
#define CHANNEL(parameter) (3 * (parameter))

#define SHARE(word, text, standard)                                                                                                            \
    {                                                                                                                                          \
        .size = sizeof(struct mcr_parameter), .type = MCR_TYPE_NUMBER, .flags = MCR_PARAMETER_VARYING, .name = word, .unit = "", .summary = text, \
        .fallback = {standard}, .min = 0, .max = 1                                                                                             \
    }
#define COLOUR(word, text, standard, most, how)                                                                                                \
    {                                                                                                                                          \
        .size = sizeof(struct mcr_parameter), .type = MCR_TYPE_COLOUR, .flags = how, .name = word, .unit = "", .summary = text,                \
        .fallback = {standard, standard, standard}, .min = 0, .max = most                                                                      \
    }

static const struct mcr_parameter parameters[PARAMETERS] = {
    [BASE] = COLOUR("base_color", "A metal's reflectance seen from straight above, else the share that is scattered diffusely or tints what is transmitted.",
                    1, 1, MCR_PARAMETER_VARYING),
    [METALLIC] = SHARE("metallic", "How much of the surface is metal: 0 or 1, between them a blend (glTF's own default is 1).", 0),
    [ROUGHNESS] = SHARE("roughness", "Perceptual, as in glTF: its square is GGX's alpha, which other materials here call roughness; 0 is smooth.", 0.5),
    [IOR] = {.size = sizeof(struct mcr_parameter),
             .type = MCR_TYPE_NUMBER,
             .name = "ior",
             .unit = "",
             .summary = "Index of refraction of what is not metal.",
             .fallback = {1.5},
             .min = 1,
             .max = 1e3},
    [SPECULAR] = SHARE("specular", "Scales the reflection of what is not metal, at all angles.", 1),
    [SPECULAR_COLOR] = COLOUR("specular_color", "Scales the reflection of what is not metal seen from straight above, up to 1.", 1, 1e6, MCR_PARAMETER_VARYING),
    [CLEARCOAT] = SHARE("clearcoat", "How much of the surface has a clear coat of index 1.5 on top.", 0),
    [CLEARCOAT_ROUGHNESS] = SHARE("clearcoat_roughness", "The coat's roughness, perceptual like `roughness`; 0 is smooth.", 0),
    [SHEEN_COLOR] = COLOUR("sheen_color", "Colour and strength of the sheen of fibres, as of velvet, under the coat and over all else.", 0, 1, MCR_PARAMETER_VARYING),
    [SHEEN_ROUGHNESS] = SHARE("sheen_roughness", "Perceptual: its square is the alpha of the fibres' distribution; below 0.1 as 0.1.", 0.3),
    [TRANSMISSION] = SHARE("transmission", "How much of what is not metal lets light through instead of scattering it diffusely.", 0),
    [THIN] = {.size = sizeof(struct mcr_parameter),
              .type = MCR_TYPE_CHOICE,
              .name = "thin",
              .unit = "",
              .choices = "no|yes",
              .summary = "Whether a surface that transmits is a thin wall (glTF without its volume extension) and not the boundary of an interior.",
              .fallback = {0}},
    [ATTENUATION_COLOR] = COLOUR("attenuation_color", "Share of light that is left after `attenuation_distance` inside.", 1, 1, MCR_PARAMETER_ABOVE_MIN),
    [ATTENUATION_DISTANCE] = {.size = sizeof(struct mcr_parameter),
                              .type = MCR_TYPE_NUMBER,
                              .flags = MCR_PARAMETER_ABOVE_MIN,
                              .name = "attenuation_distance",
                              .unit = "scene length",
                              .summary = "The distance of `attenuation_color`.",
                              .fallback = {1},
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
                      .summary = "Whether the light that meets several facets of metal is lost or comes back in a diffuse lobe.",
                      .fallback = {1}},
};

/* What the whole surface is. Lobes that are smooth, are not there, or are everywhere, cost nothing. */
struct surface {
    int smooth, coat, coat_smooth, sheen, transmits, thin, compensates;
    int diffuse; /* something is scattered that is no lobe of GGX */
    double ior;
};

/* ---- create ---- */

static int32_t refuse(const struct mcr_host *host, struct mcr_context *context, const char *text)
{
    host->report(host, context, MCR_REPORT_ERROR, text);
    return MCR_E_INVALID;
}

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
        return refuse(host, context, "'attenuation_color', 'attenuation_distance' and 'priority' have no effect with 'thin yes': a thin wall has no interior");
    if ((volume || given[THIN]) && !(number[CHANNEL(TRANSMISSION)] > 0))
        return refuse(host, context, "'thin', 'attenuation_color', 'attenuation_distance' and 'priority' have no effect without 'transmission'");
    if (given[ATTENUATION_COLOR] != given[ATTENUATION_DISTANCE])
        return refuse(host, context, "'attenuation_color' and 'attenuation_distance' belong together: give both or neither");
    for (int c = 0; c < 3; c++)
        if (!(attenuation_of(number, c) < HUGE_VAL))
            return refuse(host, context, "'attenuation_distance' is too small for this 'attenuation_color': the attenuation is infinite");
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

/* ---- lanes ---- */

/*
 * Arrays of scratch, of mcr_padded(n) doubles each. ..._O and ..._W are for the outgoing direction and for the other one: LOST and GRAZING are E of the base's
 * GGX (microfacet.h), COAT and SHEEN those layers' own E.
 */
enum {
    COLOURS, INPUT = COLOURS + 9, ALPHA = INPUT + 7, COAT_ALPHA, RATIO, TANGENT, COSINE_O = TANGENT + 3, COSINE_W, LOST_O, LOST_W, GRAZING_O, GRAZING_W,
    COAT_O, COAT_W, SHEEN_O, SHEEN_W, TINT, SHEEN_TINT, GREY, VALUE, FACET, CROSSED, PLAIN, REST, COATED, FIBRES, OVER, UNDER, WHITE, METAL_AGAIN, CHANCE,
    ARRAYS = CHANCE + 4
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

#define COAT_LEAST 0.04 /* ((1.5 - 1) / (1.5 + 1))^2 */

/* Of the coat; on entry `e` holds what is lost. */
MCR_LOOP void coat_lanes(uint32_t n, const double *restrict coat, const double *restrict grazing, double *restrict e)
{
    for (uint32_t i = 0; i < n; i++)
        e[i] = coat[i] * ((1 - e[i]) * (COAT_LEAST + (1 - COAT_LEAST) * grazing[i]));
}

/*
 * Of white sheen, a polynomial in x = 2 sqrt(cos) - 1 (rows) and y = (2 roughness - 1.1) / 0.9, fitted to midpoint sums over 400 x 200 directions. It errs by
 * less than SHEEN_ERROR, which is added.
 */
#define SHEEN_ERROR 2.5e-3
#define SHEEN_LEAST 0.1
static const double sheen_albedo[14][12] = {
    {0.42738957, -0.037023806, -0.011840679, 0.040998604, -0.14358183, 0.19412687, 0.20446427, -0.33134095, -0.42158941, 0.51079737,
     0.20018866, -0.23882175},
    {-0.48390504, 0.4265285, -0.3649447, 0.27695521, -0.13527434, -0.1771005, 0.20089456, 0.35637461, -0.36070916, -0.41226155, 0.58514284,
     -0.17712668},
    {0.07880211, -0.21289409, 0.18065895, -0.0093059429, 2.2718776, -3.6557088, -6.1329187, 9.1240573, 10.048778, -12.52318, -5.2058498,
     6.0599342},
    {0.030857029, -0.074940446, 0.21272586, -0.57544717, -0.83263598, 3.3650205, 1.9879525, -7.9882471, -2.0472641, 8.9776052, -0.89274297,
     -2.1659619},
    {-0.043988189, 0.10710051, 0.57432305, -1.6521622, -6.9623334, 13.098504, 23.98154, -37.029219, -35.988036, 48.029858, 18.504501,
     -22.64918},
    {0.052881796, -0.096165083, -0.17056471, 1.14519, 1.8401675, -7.4849485, -4.8935115, 18.608511, 4.3077605, -19.324458, 0.42406112,
     5.6224018},
    {0.070114794, -0.17647121, -0.89685191, 2.9451839, 9.8311745, -21.144678, -33.862191, 59.209873, 48.040449, -73.106849, -23.105865,
     32.238816},
    {-0.12258457, 0.14114356, -0.30531589, -0.031581188, 1.7545149, 0.54787595, -8.5816918, 2.2699044, 14.871621, -7.3793525, -9.5747398,
     6.3400306},
    {-0.17036916, 0.27592927, 0.57573096, -2.6164251, -7.7450319, 19.344798, 24.865715, -51.701532, -33.369462, 60.685811, 14.551043,
     -24.795147},
    {0.25295138, -0.21649741, 0.91212685, -1.7509738, -5.8221405, 10.059464, 22.9684, -31.736383, -33.506257, 41.275456, 18.198046,
     -20.491915},
    {0.16734519, -0.22072956, -0.094965607, 1.1046786, 2.9646164, -8.8656499, -8.2770446, 22.205617, 10.274101, -24.724491, -3.5135945,
     9.0752358},
    {-0.23544861, 0.19325624, -0.8078485, 1.7645787, 4.8541165, -9.8815104, -18.801133, 29.684406, 26.594448, -36.790206, -14.171383,
     17.464532},
    {-0.069430635, 0.079254535, -0.058485493, -0.11408981, -0.29085149, 1.3599729, 0.2669822, -2.886294, -0.002469778, 2.8243877,
     -0.51402811, -0.63402355},
    {0.08893795, -0.074689338, 0.27504253, -0.60192588, -1.5204968, 3.2356647, 5.9572596, -9.6718914, -8.3642211, 11.841045, 4.4966991,
     -5.6114426},
};

MCR_INLINE double sheen_of(double cosine, double roughness)
{
    double r = roughness > SHEEN_LEAST ? roughness : SHEEN_LEAST, x = 2 * sqrt(cosine) - 1, y = (r - 0.55) * (1 / 0.45);
    double p = mcr_row12_(sheen_albedo[13], y);

    p = p * x + mcr_row12_(sheen_albedo[12], y);
    p = p * x + mcr_row12_(sheen_albedo[11], y);
    p = p * x + mcr_row12_(sheen_albedo[10], y);
    p = p * x + mcr_row12_(sheen_albedo[9], y);
    p = p * x + mcr_row12_(sheen_albedo[8], y);
    p = p * x + mcr_row12_(sheen_albedo[7], y);
    p = p * x + mcr_row12_(sheen_albedo[6], y);
    p = p * x + mcr_row12_(sheen_albedo[5], y);
    p = p * x + mcr_row12_(sheen_albedo[4], y);
    p = p * x + mcr_row12_(sheen_albedo[3], y);
    p = p * x + mcr_row12_(sheen_albedo[2], y);
    p = p * x + mcr_row12_(sheen_albedo[1], y);
    p = p * x + mcr_row12_(sheen_albedo[0], y);
    p = (p > 0 ? p : 0) + SHEEN_ERROR;
    return p;
}

MCR_LOOP void sheen_lanes(uint32_t n, const double *restrict roughness, const double *restrict cosine, double *restrict e)
{
    for (uint32_t i = 0; i < n; i++)
        e[i] = sheen_of(cosine[i], roughness[i]);
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
    if (s->diffuse || !toward)
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

/* ---- reflectances ---- */

/* At normal incidence, of the index n. */
MCR_INLINE double least_of(double n)
{
    double root = (n - 1) / (n + 1);
    return root * root;
}

/* Plastic's, with (1 - cos)^5, or a mean of it, as weight. */
MCR_INLINE double plastic_of(double least, double tint, double specular, double weight)
{
    double r = least * tint;

    r = r < 1 ? r : 1;
    return specular * (r + (1 - r) * weight);
}

/* Glass's share of Fresnel: `plain`, and by how much it is to be moved where the tint is not 1: `rest`, -1 where all is reflected. */
struct glass {
    double plain, rest, q;
};

MCR_INLINE struct glass glass_of(double c, double ratio)
{
    double least = least_of(ratio), rise;
    struct glass g;

    g.plain = mcr_fresnel_dielectric(c, ratio, &g.q);
    rise = (g.plain - least) / (1 - least);
    g.rest = g.plain < 1 ? 1 - (rise > 0 ? rise : 0) : -1;
    return g;
}

/* One interface's reflectance. */
MCR_INLINE double interface_of(double plain, double rest, double ratio, double tint, double specular)
{
    double least = least_of(ratio), r = least * tint, f;

    r = r < 1 ? r : 1;
    f = plain + (r - least) * rest;
    f = specular * (f > 0 ? f : 0);
    f = f < 1 ? f : 1;
    return rest < 0 ? 1 : f;
}

/* What a wall of two of them reflects. */
MCR_INLINE double wall_of(double f) { return 2 * f / (1 + f); }

/* Of the base at a facet, in grey: what is reflected, and what passes. For choosing between both. */
struct shares {
    double reflected, passed;
};

MCR_INLINE struct shares shares_of(double cosine, struct glass g, double ratio, double least, double tint, double specular, double metallic,
                                   double transmission, double grey, int thin)
{
    double weight = mcr_schlick_weight(cosine), f = interface_of(g.plain, g.rest, ratio, tint, specular), all = thin ? wall_of(f) : f;
    struct shares s;

    s.reflected = metallic * (grey + (1 - grey) * weight) +
                  (1 - metallic) * (transmission * all + (1 - transmission) * plastic_of(least, tint, specular, weight));
    s.passed = (1 - metallic) * transmission * (1 - all) * grey;
    return s;
}

/* The chance that a facet reflects. */
MCR_INLINE double reflects_of(struct shares s)
{
    double sum = s.reflected + s.passed;
    return sum > 0 ? s.reflected / sum : 1;
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
        struct mcr_ggx reflected = mcr_ggx_reflect(alpha[i], alpha[i], o, mcr_vector(w.x, w.y, fabs(w.z)));
        struct mcr_ggx refracted = mcr_ggx_transmit(alpha[i], alpha[i], o, w, ratio[i]);
        int bends = !thin & (w.z < 0);

        value[i] = bends ? refracted.value : reflected.value;
        cosine[i] = bends ? refracted.cosine : reflected.cosine;
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

MCR_LOOP void coated_lanes(uint32_t n, const double *restrict coat, const double *restrict cosine, double *restrict value)
{
    for (uint32_t i = 0; i < n; i++)
        value[i] *= coat[i] * mcr_fresnel_schlick(cosine[i], COAT_LEAST);
}

MCR_LOOP void glass_lanes(uint32_t n, const double *restrict cosine, const double *restrict ratio, double *restrict plain, double *restrict rest)
{
    for (uint32_t i = 0; i < n; i++) {
        struct glass g = glass_of(cosine[i], ratio[i]);
        plain[i] = g.plain;
        rest[i] = g.rest;
    }
}

/*
 * White sheen, f cos. D = (2 + 1/alpha) sin^(1/alpha) / (2 pi) of the half vector's angle to the normal; its sine is that of the part across the normal.
 */
MCR_LOOP void fibre_lanes(const struct mcr_points *at, const double *restrict roughness, const double *restrict x, const double *restrict y,
                          const double *restrict z, const double *restrict above, const double *restrict below, double *restrict value)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_vector n = mcr_vector(nx[i], ny[i], nz[i]), h = mcr_vector(ox[i] + x[i], oy[i] + y[i], oz[i] + z[i]);
        double o = mcr_dot(n, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_dot(n, mcr_vector(x[i], y[i], z[i])), up = o + w;
        double length2 = mcr_dot(h, h), sine2 = 1 - up * up / (length2 > 0 ? length2 : 1), r = roughness[i] > SHEEN_LEAST ? roughness[i] : SHEEN_LEAST;
        double inverse = 1 / (r * r), most = above[i] > below[i] ? above[i] : below[i], d, shadow = o + w - o * w;
        int seen = (o > MCR_GGX_HORIZON) & (w > MCR_GGX_HORIZON);

        sine2 = sine2 > 1e-300 ? sine2 : 1e-300;
        d = (2 + inverse) * mcr_exp(0.5 * inverse * mcr_log(sine2)) * (0.5 * MCR_PER_PI);
        d = d * w / (4 * (seen ? shadow : 1) * (most > 1 ? most : 1));
        value[i] = seen ? d : 0;
    }
}

/*
 * What the layers let through, and where: `over` is what is under the coat, `under` what is under sheen, too; 0 where the shading normal and the geometric
 * one do not agree on w's side. `crossed`: 1 on the other side.
 */
MCR_LOOP void cover_lanes(const struct mcr_points *at, const double *restrict x, const double *restrict y, const double *restrict z,
                          const double *restrict coat_o, const double *restrict coat_w, const double *restrict sheen_o, const double *restrict sheen_w,
                          const double *restrict tint, double *restrict over, double *restrict under, double *restrict crossed)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        double o = nx[i] * ox[i] + ny[i] * oy[i] + nz[i] * oz[i], w = nx[i] * x[i] + ny[i] * y[i] + nz[i] * z[i];
        double side = gx[i] * x[i] + gy[i] * y[i] + gz[i] * z[i], sheen = sheen_o[i] > sheen_w[i] ? sheen_o[i] : sheen_w[i];
        double coat = coat_o[i] > coat_w[i] ? coat_o[i] : coat_w[i];
        int right = (o > MCR_GGX_HORIZON) & (fabs(w) > MCR_GGX_HORIZON) & (w < 0 ? side < 0 : side > 0);

        over[i] = right ? 1 - coat : 0;
        under[i] = over[i] * (1 - tint[i] * (sheen < 1 ? sheen : 1));
        crossed[i] = w < 0 ? 1 : 0;
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

MCR_LOOP void layers_lanes(uint32_t n, const double *restrict over, const double *restrict under, const double *restrict crossed, const double *restrict coated,
                           const double *restrict fibres, const double *restrict sheen, double *restrict out)
{
    for (uint32_t i = 0; i < n; i++) {
        double f = out[i] * under[i] + fibres[i] * sheen[i] * over[i], all = f + (over[i] > 0 && crossed[i] == 0 ? coated[i] : 0);
        out[i] = all;
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
    for (uint32_t c = 0; c < 3; c++) {
        if (s->smooth)
            mcr_fill_lanes(l.n, 0, channel[c]);
        else if (s->transmits)
            clear_lanes(&l, least, room_of(&l, VALUE), room_of(&l, FACET), l.base[c], l.tint[c], channel[c]);
        else
            specular_lanes(&l, least, room_of(&l, VALUE), room_of(&l, FACET), l.base[c], l.tint[c], channel[c]);
        if (s->diffuse)
            spread_lanes(&l, room_of(&l, ALPHA), l.base[c], white, again, channel[c]);
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

static void chances(const struct lanes *l)
{
    double *c[4];

    for (uint32_t k = 0; k < 4; k++)
        c[k] = room_of(l, CHANCE + k);
    weights_lanes(l, c[0], c[1], c[2], c[3]);
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
        struct mcr_vector up = mcr_vector(w.x, w.y, fabs(w.z));
        struct mcr_ggx coat = mcr_ggx_reflect(coat_alpha[i], coat_alpha[i], o, w), reflected = mcr_ggx_reflect(alpha[i], alpha[i], o, up);
        struct mcr_ggx refracted = mcr_ggx_transmit(alpha[i], alpha[i], o, w, ratio[i]);
        int bends = !thin & (w.z < 0), seen = (o.z > MCR_GGX_HORIZON) & (fabs(w.z) > MCR_GGX_HORIZON);
        double base = bends ? refracted.density : reflected.density, cosine = bends ? refracted.cosine : reflected.cosine;
        double chance = reflects_at(cosine, ratio[i], least, tint[i], specular[i], metallic[i], transmission[i], grey[i], thin), above;

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
        double bent = mcr_ggx_index(ratio[i]), root2, span = second[i] - first[i], wide = sqrt(1 + rest), above;

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
        root2 = (bent - 1) * (bent + 1) + c * c;
        p = mcr_refracted(o, m, c, bent, sqrt(root2 > 0 ? root2 : 0));
        p.x = thin ? d.x : p.x;
        p.y = thin ? d.y : p.y;
        p.z = thin ? -d.z : p.z;
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

/* Where rounding leaves no density, nothing was drawn. */
MCR_LOOP void drop_lanes(uint32_t n, const double *restrict density, double *restrict x, double *restrict y, double *restrict z)
{
    for (uint32_t i = 0; i < n; i++) {
        int drawn = density[i] > 0;
        x[i] = drawn ? x[i] : 0;
        y[i] = drawn ? y[i] : 0;
        z[i] = drawn ? z[i] : 0;
    }
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    struct lanes l = lanes_of(instance, at, inputs, host->scratch(host, context));

    chances(&l);
    draw_lanes(&l, at, number, out->x, out->y, out->z);
    density = density ? density : room_of(&l, VALUE);
    density_lanes(&l, at, out->x, out->y, out->z, density);
    drop_lanes(l.n, density, out->x, out->y, out->z);
    return MCR_OK;
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    struct lanes l = lanes_of(instance, at, inputs, host->scratch(host, context));

    chances(&l);
    density_lanes(&l, at, toward->x, toward->y, toward->z, density);
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

MCR_LOOP void albedo_lanes(const struct lanes *l, const double *restrict base, const double *restrict tint, const double *restrict sheen_colour,
                           double *restrict out)
{
    const double *lost = room_of(l, LOST_O), *grazing = room_of(l, GRAZING_O), *coat = room_of(l, COAT_O), *sheen = room_of(l, SHEEN_O);
    const double *most = room_of(l, SHEEN_TINT), *brightest = room_of(l, TINT), *specular = l->specular, *metallic = l->metallic;
    const double least = least_of(l->surface->ior);

    for (uint32_t i = 0; i < l->n; i++) {
        double e = sheen[i] < 1 ? sheen[i] : 1, kept = 1 - lost[i], metal = base[i] + (1 - base[i]) * grazing[i];
        double reflected = kept * plastic_of(least, tint[i], specular[i], grazing[i]);
        double under = (1 - kept * plastic_of(least, brightest[i], specular[i], grazing[i])) * base[i];
        double all = sheen_colour[i] * e + (1 - most[i] * e) * (metallic[i] * metal + (1 - metallic[i]) * (reflected + under));

        out[i] = mcr_within_unit_(coat[i] + (1 - coat[i]) * all);
    }
}

static int32_t albedo(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    struct lanes l = lanes_of(instance, at, inputs, host->scratch(host, context));
    double *channel[3] = {out->r, out->g, out->b};

    for (uint32_t c = 0; c < 3; c++)
        albedo_lanes(&l, l.base[c], l.tint[c], l.sheen[c], channel[c]);
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
