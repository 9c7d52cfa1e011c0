/* SPDX-License-Identifier: Apache-2.0 */
/* mix: two materials in one surface, each with its share: everything that they scatter, emit and let through is blended linearly. */
#include <mcrender/material.h>
#include <mcrender/sampler.h>
#include <stdlib.h>
#include <string.h>

/* The parameters' places in the table, and their first channels among the inputs. */
enum { FIRST, SECOND, AMOUNT, PARAMETERS };
#define CHANNEL(parameter) (3 * (parameter))

#define SCATTERS (MCR_MATERIAL_REFLECTS | MCR_MATERIAL_TRANSMITS)
#define EMITS (MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK)
#define CLOSE_TO_1 0.99999999999999989 /* 1 - 2^-53: the largest number that a source gives */

static const struct mcr_parameter parameters[PARAMETERS] = {
    [FIRST] = {.size = sizeof(struct mcr_parameter),
               .type = MCR_TYPE_MATERIAL,
               .flags = MCR_PARAMETER_REQUIRED,
               .name = "first",
               .unit = "",
               .summary = "The material that is there with amount 0."},
    [SECOND] = {.size = sizeof(struct mcr_parameter),
                .type = MCR_TYPE_MATERIAL,
                .flags = MCR_PARAMETER_REQUIRED,
                .name = "second",
                .unit = "",
                .summary = "The material that is there with amount 1; for more than two, one of them is a mix."},
    [AMOUNT] = {.size = sizeof(struct mcr_parameter),
                .type = MCR_TYPE_NUMBER,
                .flags = MCR_PARAMETER_VARYING,
                .name = "amount",
                .unit = "",
                .summary = "Share of the second material.",
                .fallback = {0.5},
                .min = 0,
                .max = 1},
};

struct mix {
    const struct mcr_child *child[2];
    struct mcr_material_traits traits[2];
};

static int interiors_differ(const struct mcr_material_traits *a, const struct mcr_material_traits *b)
{
    return a->index != b->index || a->priority != b->priority || a->attenuation[0] != b->attenuation[0] ||
           a->attenuation[1] != b->attenuation[1] || a->attenuation[2] != b->attenuation[2];
}

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    struct mix *mix = calloc(1, sizeof *mix);
    int32_t status = mix ? MCR_OK : MCR_E_NOMEM;

    *instance = NULL;
    for (int k = 0; k < 2 && !status; k++) {
        mix->child[k] = with->child[(uint32_t)with->values->number[CHANNEL(FIRST + k)]];
        mix->traits[k].size = sizeof mix->traits[k];
        status = host->material_child_traits(host, context, mix->child[k], &mix->traits[k]);
    }
    if (!status && mix->traits[0].does & mix->traits[1].does & MCR_MATERIAL_INTERIOR && interiors_differ(&mix->traits[0], &mix->traits[1])) {
        host->report(host, context, MCR_REPORT_ERROR, "the materials in this mix fill what they bound with different matter, expected one index, "
                                                      "attenuation and priority");
        status = MCR_E_INVALID;
    }
    if (!status && (mix->traits[0].does | mix->traits[1].does) & MCR_MATERIAL_INTERIOR && (mix->traits[0].does | mix->traits[1].does) & MCR_MATERIAL_THIN) {
        host->report(host, context, MCR_REPORT_ERROR, "one of the materials in this mix bounds an interior, the other one is a thin wall: expected the "
                                                      "same 'thin' of both");
        status = MCR_E_INVALID;
    }
    if (status)
        free(mix);
    else
        *instance = mix;
    return status;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    const struct mix *mix = instance;
    const struct mcr_material_traits *one = &mix->traits[0], *two = &mix->traits[1], *inside = one->does & MCR_MATERIAL_INTERIOR ? one : two;
    double amount = values->number[CHANNEL(AMOUNT)];

    (void)host, (void)context;
    traits->does = one->does | two->does;
    for (int c = 0; c < 3; c++)
        traits->radiance[c] = (1 - amount) * one->radiance[c] + amount * two->radiance[c];
    if (traits->does & MCR_MATERIAL_INTERIOR) {
        traits->index = inside->index;
        traits->priority = inside->priority;
        memcpy(traits->attenuation, inside->attenuation, sizeof traits->attenuation);
    }
    return MCR_OK;
}

/* Doubles to one array of scratch: a multiple of 8 keeps every array aligned and padded. */
static uint64_t padded(uint32_t n)
{
    return ((uint64_t)n + 7) / 8 * 8;
}

#define ARRAYS 12

static uint64_t scratch_bytes(const void *instance, uint32_t n)
{
    (void)instance;
    return ARRAYS * padded(n) * sizeof(double);
}

static struct mcr_colours colours(double *at, uint32_t n)
{
    return (struct mcr_colours){sizeof(struct mcr_colours), n, at, at + padded(n), at + 2 * padded(n)};
}

static void clear(const struct mcr_colours *out)
{
    memset(out->r, 0, out->n * sizeof *out->r);
    memset(out->g, 0, out->n * sizeof *out->g);
    memset(out->b, 0, out->n * sizeof *out->b);
}

/* out = (1 - amount) out + amount with */
static void blend_lanes(uint32_t n, const double *restrict amount, uint32_t stride, const double *restrict with, double *restrict out)
{
    for (uint32_t i = 0; i < n; i++)
        out[i] = (1 - amount[i * stride]) * out[i] + amount[i * stride] * with[i];
}

static void blend(const struct mcr_inputs *inputs, const struct mcr_colours *with, const struct mcr_colours *out)
{
    const double *amount = inputs->channel[CHANNEL(AMOUNT)];
    uint32_t stride = inputs->stride[CHANNEL(AMOUNT)];

    blend_lanes(out->n, amount, stride, with->r, out->r);
    blend_lanes(out->n, amount, stride, with->g, out->g);
    blend_lanes(out->n, amount, stride, with->b, out->b);
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    const struct mix *mix = instance;
    struct mcr_colours with = colours(host->scratch(host, context), at->n);
    int32_t status = MCR_OK;

    for (int k = 0; k < 2 && !status; k++) {
        const struct mcr_colours *to = k ? &with : out;
        if (mix->traits[k].does & SCATTERS)
            status = host->material_child_evaluate(host, context, mix->child[k], at, toward, to);
        else
            clear(to);
    }
    if (!status)
        blend(inputs, &with, out);
    return status;
}

/* ---- Sampling: one of those that scatter, with its share ---- */

/* The chance of the second in each lane: its amount, where both scatter. */
static void chance_lanes(uint32_t n, const struct mix *mix, const double *restrict amount, uint32_t stride, double *restrict chance)
{
    int one = (mix->traits[0].does & SCATTERS) != 0, two = (mix->traits[1].does & SCATTERS) != 0;

    for (uint32_t i = 0; i < n; i++)
        chance[i] = one & two ? amount[i * stride] : two ? 1.0 : 0.0;
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    const struct mix *mix = instance;
    double *chance = host->scratch(host, context), *with = chance + padded(at->n);
    int32_t status = MCR_OK;

    chance_lanes(at->n, mix, inputs->channel[CHANNEL(AMOUNT)], inputs->stride[CHANNEL(AMOUNT)], chance);
    for (int k = 0; k < 2 && !status; k++) {
        double *to = k ? with : density;
        if (mix->traits[k].does & SCATTERS)
            status = host->material_child_density(host, context, mix->child[k], at, toward, to);
        else
            memset(to, 0, at->n * sizeof *to);
    }
    if (!status)
        blend_lanes(at->n, chance, 1, with, density);
    return status;
}

/* Lanes below the chance are the second's; what is left of the number is uniform again. */
static void choose_lanes(uint32_t n, const double *restrict chance, const double *restrict number, double *restrict second, double *restrict left)
{
    for (uint32_t i = 0; i < n; i++) {
        int is = number[i] < chance[i];
        double of = is ? chance[i] : 1 - chance[i], rest = (is ? number[i] : number[i] - chance[i]) / (of > 0 ? of : 1);
        second[i] = is ? 1.0 : 0.0;
        left[i] = rest < CLOSE_TO_1 ? rest : CLOSE_TO_1;
    }
}

/* `wanted` of the lanes that are the first's (which 0) or the second's (1). */
static void wanted_lanes(uint32_t n, const double *restrict second, double which, double *restrict wanted)
{
    for (uint32_t i = 0; i < n; i++)
        wanted[i] = second[i] == which ? 1.0 : 0.0;
}

static void not_wanted_lanes(uint32_t n, const double *restrict before, double *restrict wanted)
{
    for (uint32_t i = 0; i < n; i++)
        wanted[i] = before[i] == 0 ? 0.0 : wanted[i];
}

/* out = with where second */
static void take_lanes(uint32_t n, const double *restrict second, const double *restrict with, double *restrict out)
{
    for (uint32_t i = 0; i < n; i++)
        out[i] = second[i] > 0 ? with[i] : out[i];
}

/* The points with those of them wanted that are the first's or the second's. */
static struct mcr_points share(const struct mcr_points *at, const double *second, double which, double *wanted)
{
    struct mcr_points points = *at;

    wanted_lanes(at->n, second, which, wanted);
    if (at->wanted)
        not_wanted_lanes(at->n, at->wanted, wanted);
    points.wanted = wanted;
    return points;
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *found)
{
    const struct mix *mix = instance;
    const uint64_t room = padded(at->n);
    double *chance = host->scratch(host, context), *second = chance + room, *left = second + room, *wanted = left + room, *x = wanted + room;
    struct mcr_directions with = {sizeof with, at->n, x, x + room, x + 2 * room};
    const double *const numbers[3] = {number[0], number[1], left};
    int32_t status = MCR_OK;

    chance_lanes(at->n, mix, inputs->channel[CHANNEL(AMOUNT)], inputs->stride[CHANNEL(AMOUNT)], chance);
    choose_lanes(at->n, chance, number[2], second, left);
    for (int k = 0; k < 2 && !status; k++) {
        const struct mcr_directions *to = k ? &with : out;
        struct mcr_points points = share(at, second, k, wanted);
        if (mix->traits[k].does & SCATTERS) {
            status = host->material_child_draw(host, context, mix->child[k], &points, numbers, to, NULL);
            continue;
        }
        memset(to->x, 0, at->n * sizeof *to->x);
        memset(to->y, 0, at->n * sizeof *to->y);
        memset(to->z, 0, at->n * sizeof *to->z);
    }
    if (status)
        return status;
    take_lanes(at->n, second, with.x, out->x);
    take_lanes(at->n, second, with.y, out->y);
    take_lanes(at->n, second, with.z, out->z);
    return found ? density(host, context, instance, inputs, at, &(struct mcr_directions){sizeof *out, at->n, out->x, out->y, out->z}, found) : MCR_OK;
}

/* ---- Emission, light that crosses, mirror-like lobes ---- */

typedef int32_t colour_service(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, const struct mcr_points *at,
                               const struct mcr_colours *out);

/* What those tell that do this, blended. */
static int32_t blend_of(const struct mcr_host *host, struct mcr_context *context, const struct mix *mix, uint32_t does, colour_service *ask,
                        const struct mcr_inputs *inputs, const struct mcr_points *at, const struct mcr_colours *out)
{
    struct mcr_colours with = colours(host->scratch(host, context), at->n);
    int32_t status = MCR_OK;

    for (int k = 0; k < 2 && !status; k++) {
        const struct mcr_colours *to = k ? &with : out;
        if (mix->traits[k].does & does)
            status = ask(host, context, mix->child[k], at, to);
        else
            clear(to);
    }
    if (!status)
        blend(inputs, &with, out);
    return status;
}

static int32_t emission(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_colours *out)
{
    return blend_of(host, context, instance, EMITS, host->material_child_emission, inputs, at, out);
}

static int32_t passes(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    return blend_of(host, context, instance, MCR_MATERIAL_PASSES, host->material_child_passes, inputs, at, out);
}

static int32_t albedo(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    return blend_of(host, context, instance, SCATTERS | MCR_MATERIAL_DELTA, host->material_child_albedo, inputs, at, out);
}

/* A child's answer to `delta`. */
struct lobes {
    struct mcr_directions toward;
    double *probability;
    struct mcr_colours weight;
};

static int32_t ask_delta(const struct mcr_host *host, struct mcr_context *context, const struct mix *mix, int k, const struct mcr_points *at,
                         const double *number, const struct lobes *lobes)
{
    const double *const numbers[1] = {number};

    if (mix->traits[k].does & MCR_MATERIAL_DELTA)
        return host->material_child_delta(host, context, mix->child[k], at, numbers, &lobes->toward, lobes->probability, &lobes->weight);
    for (uint32_t i = 0; i < at->n; i++) {
        lobes->toward.x[i] = lobes->toward.y[i] = lobes->toward.z[i] = 0;
        lobes->probability[i] = 1;
    }
    clear(&lobes->weight);
    return MCR_OK;
}

/* How probable it is that a child chooses none, which the number close to 1 tells. */
static int32_t ask_none(const struct mcr_host *host, struct mcr_context *context, const struct mix *mix, int k, const struct mcr_points *at,
                        double *number, const struct lobes *lobes, double *none)
{
    int32_t status;

    for (uint32_t i = 0; i < at->n; i++)
        number[i] = CLOSE_TO_1;
    status = ask_delta(host, context, mix, k, at, number, lobes);
    for (uint32_t i = 0; i < at->n; i++) {
        int lobe = (lobes->toward.x[i] != 0) | (lobes->toward.y[i] != 0) | (lobes->toward.z[i] != 0);
        none[i] = lobe ? 0 : lobes->probability[i];
    }
    return status;
}

/*
 * The numbers from 0 on choose the first's lobes, those that follow the second's, the last ones none: with both children's chances of none, which is the
 * chance of none here whichever is asked.
 */
static int32_t delta(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                     const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *probability,
                     const struct mcr_colours *weight)
{
    const struct mix *mix = instance;
    const uint64_t room = padded(at->n);
    double *none[2] = {host->scratch(host, context), NULL}, *own, *chance;
    const double *amount = inputs->channel[CHANNEL(AMOUNT)];
    const uint32_t stride = inputs->stride[CHANNEL(AMOUNT)];
    int32_t status;

    none[1] = none[0] + room;
    own = none[1] + room;
    chance = own + room;
    struct lobes lobes = {{sizeof lobes.toward, at->n, chance + room, chance + 2 * room, chance + 3 * room}, chance, colours(chance + 4 * room, at->n)};
    status = ask_none(host, context, mix, 0, at, own, &lobes, none[0]);
    if (!status)
        status = ask_none(host, context, mix, 1, at, own, &lobes, none[1]);
    for (uint32_t i = 0; i < at->n; i++) {
        double t = amount[i * stride];
        out->x[i] = out->y[i] = out->z[i] = weight->r[i] = weight->g[i] = weight->b[i] = 0;
        probability[i] = (1 - t) * none[0][i] + t * none[1][i];
    }
    for (int k = 0; k < 2 && !status; k++) {
        if (!(mix->traits[k].does & MCR_MATERIAL_DELTA))
            continue;
        for (uint32_t i = 0; i < at->n; i++) {
            double t = amount[i * stride], of = k ? t : 1 - t, before = k ? (1 - t) * (1 - none[0][i]) : 0;
            double u = (number[0][i] - before) / (of > 0 ? of : 1);
            own[i] = u < 0 ? 0 : u < CLOSE_TO_1 ? u : CLOSE_TO_1;
        }
        status = ask_delta(host, context, mix, k, at, own, &lobes);
        for (uint32_t i = 0; i < at->n; i++) {
            double t = amount[i * stride], of = k ? t : 1 - t, before = k ? (1 - t) * (1 - none[0][i]) : 0, u = number[0][i];
            int lobe = (lobes.toward.x[i] != 0) | (lobes.toward.y[i] != 0) | (lobes.toward.z[i] != 0);
            if (!(lobe && of > 0 && u >= before && u < before + of * (1 - none[k][i])))
                continue;
            out->x[i] = lobes.toward.x[i];
            out->y[i] = lobes.toward.y[i];
            out->z[i] = lobes.toward.z[i];
            probability[i] = of * lobes.probability[i];
            weight->r[i] = of * lobes.weight.r[i];
            weight->g[i] = of * lobes.weight.g[i];
            weight->b[i] = of * lobes.weight.b[i];
        }
    }
    return status;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin),
             .kind = MCR_KIND_MATERIAL,
             .isa = MCR_ISA,
             .parameter_count = PARAMETERS,
             .name = "mix",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "two materials blended, by an amount that may vary over the surface",
             .parameters = parameters},
    .create = create,
    .destroy = free,
    .traits = traits,
    .scratch_bytes = scratch_bytes,
    .evaluate = evaluate,
    .draw = draw,
    .density = density,
    .emission = emission,
    .delta = delta,
    .passes = passes,
    .albedo = albedo,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
