/* SPDX-License-Identifier: Apache-2.0 */
/*
 * For testing what the core does with mirror-like lobes, light that passes straight on, and interiors: the material `sheet`. Of the light that
 * does not pass, it scatters `diffuse` as lambert does, mirrors `mirror`, and lets `through` refract (without Fresnel's reflection; none at total reflection). Its lobes are chosen with
 * the chances `mirror_chance` and `through_chance`, whatever they carry, so that a mistake with them shows.
 */
#include <math.h>
#include <mcrender/material.h>
#include <mcrender/sampler.h>
#include <stdlib.h>

#define PER_PI 0.31830988618379067

enum { DIFFUSE, MIRROR, THROUGH, PASS, RADIANCE, MIRROR_CHANCE, THROUGH_CHANCE, INTERIOR, INDEX, ATTENUATION, PRIORITY, PARAMETERS };

#define COLOUR(NAME) {sizeof(struct mcr_parameter), MCR_TYPE_COLOUR, MCR_PARAMETER_VARYING, 0, NAME, "", NULL, "A share.", {0, 0, 0}, 0, 1}
#define NUMBER(NAME, DEFAULT, MOST) {sizeof(struct mcr_parameter), MCR_TYPE_NUMBER, 0, 0, NAME, "", NULL, "A number.", {DEFAULT}, 0, MOST}
static const struct mcr_parameter parameters[PARAMETERS] = {
    [DIFFUSE] = COLOUR("diffuse"),
    [MIRROR] = COLOUR("mirror"),
    [THROUGH] = COLOUR("through"),
    [PASS] = COLOUR("pass"),
    [RADIANCE] = NUMBER("radiance", 0, 1e6),
    [MIRROR_CHANCE] = NUMBER("mirror_chance", 0, 1),
    [THROUGH_CHANCE] = NUMBER("through_chance", 0, 1),
    [INTERIOR] = NUMBER("interior", 0, 1),
    [INDEX] = NUMBER("index", 1, 100),
    [ATTENUATION] = {sizeof(struct mcr_parameter), MCR_TYPE_COLOUR, 0, 0, "attenuation", "", NULL, "A colour.", {0, 0, 0}, 0, 1e9},
    [PRIORITY] = NUMBER("priority", 0, 100),
};

static double input(const struct mcr_inputs *inputs, uint32_t parameter, uint32_t component, uint32_t lane)
{
    uint32_t c = 3 * parameter + component;
    return inputs->channel[c][lane * inputs->stride[c]];
}

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    double *chances = malloc(2 * sizeof *chances);
    (void)host, (void)context;
    if (!chances)
        return MCR_E_NOMEM;
    chances[0] = with->values->number[3 * MIRROR_CHANCE];
    chances[1] = with->values->number[3 * THROUGH_CHANCE];
    *instance = chances;
    return MCR_OK;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    const double *number = values->number;
    (void)host, (void)context, (void)instance;
    for (int c = 0; c < 3; c++) {
        traits->does |= number[3 * DIFFUSE + c] > 0 ? MCR_MATERIAL_REFLECTS : 0;
        traits->does |= number[3 * PASS + c] > 0 ? MCR_MATERIAL_PASSES : 0;
        traits->does |= number[3 * MIRROR + c] > 0 || number[3 * THROUGH + c] > 0 ? MCR_MATERIAL_DELTA : 0;
        traits->radiance[c] = number[3 * RADIANCE];
        traits->attenuation[c] = number[3 * ATTENUATION + c];
    }
    traits->does |= number[3 * RADIANCE] > 0 ? MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK : 0;
    traits->does |= number[3 * INTERIOR] > 0 ? MCR_MATERIAL_INTERIOR : 0;
    traits->index = number[3 * INDEX];
    traits->priority = number[3 * PRIORITY];
    return MCR_OK;
}

static void colour(const struct mcr_inputs *inputs, uint32_t parameter, uint32_t lane, double factor, const struct mcr_colours *out)
{
    out->r[lane] = factor * (1 - input(inputs, PASS, 0, lane)) * input(inputs, parameter, 0, lane);
    out->g[lane] = factor * (1 - input(inputs, PASS, 1, lane)) * input(inputs, parameter, 1, lane);
    out->b[lane] = factor * (1 - input(inputs, PASS, 2, lane)) * input(inputs, parameter, 2, lane);
}

static double cosine(const struct mcr_points *at, const struct mcr_directions *toward, uint32_t i)
{
    return at->nx[i] * toward->x[i] + at->ny[i] * toward->y[i] + at->nz[i] * toward->z[i];
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    (void)host, (void)context, (void)instance;
    for (uint32_t i = 0; i < at->n; i++)
        colour(inputs, DIFFUSE, i, fmax(cosine(at, toward, i), 0) * PER_PI, out);
    return MCR_OK;
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *out)
{
    (void)host, (void)context, (void)instance, (void)inputs;
    for (uint32_t i = 0; i < at->n; i++)
        out[i] = fmax(cosine(at, toward, i), 0) * PER_PI;
    return MCR_OK;
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *told)
{
    for (uint32_t i = 0; i < at->n; i++) {
        double x, y, height = sqrt(mcr_disk_from_square(number[0][i], number[1][i], &x, &y));
        mcr_to_world(at->nx[i], at->ny[i], at->nz[i], x, y, height, &out->x[i], &out->y[i], &out->z[i]);
    }
    return told ? density(host, context, instance, inputs, at, out, told) : MCR_OK;
}

static int32_t emission(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_colours *out)
{
    (void)host, (void)context, (void)instance;
    for (uint32_t i = 0; i < at->n; i++) {
        double radiance = input(inputs, RADIANCE, 0, i);
        out->r[i] = radiance * (1 - input(inputs, PASS, 0, i));
        out->g[i] = radiance * (1 - input(inputs, PASS, 1, i));
        out->b[i] = radiance * (1 - input(inputs, PASS, 2, i));
    }
    return MCR_OK;
}

/* Snell's law for the vectors themselves; w is left (0, 0, 0) at total reflection. */
static int refract(const double n[3], const double o[3], double ratio, double w[3])
{
    double c = n[0] * o[0] + n[1] * o[1] + n[2] * o[2], square = 1 - ratio * ratio * (1 - c * c);
    for (int j = 0; j < 3 && square >= 0; j++)
        w[j] = ratio * (c * n[j] - o[j]) - sqrt(square) * n[j];
    return square >= 0;
}

static int32_t delta(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                     const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *probability,
                     const struct mcr_colours *weight)
{
    const double *chance = instance;
    (void)host, (void)context;
    for (uint32_t i = 0; i < at->n; i++) {
        double n[3] = {at->nx[i], at->ny[i], at->nz[i]}, o[3] = {at->ox[i], at->oy[i], at->oz[i]}, w[3] = {0, 0, 0};
        double ratio = at->here ? at->here[i] / at->beyond[i] : 1, c = n[0] * o[0] + n[1] * o[1] + n[2] * o[2];
        probability[i] = 1 - chance[0] - chance[1];
        weight->r[i] = weight->g[i] = weight->b[i] = 0;
        if (number[0][i] < chance[0]) {
            for (int j = 0; j < 3; j++)
                w[j] = 2 * c * n[j] - o[j];
            probability[i] = chance[0];
            colour(inputs, MIRROR, i, 1, weight);
        } else if (number[0][i] < chance[0] + chance[1]) {
            probability[i] = chance[1];
            if (refract(n, o, ratio, w))
                colour(inputs, THROUGH, i, ratio * ratio, weight);
            else
                for (int j = 0; j < 3; j++)
                    w[j] = -o[j]; /* somewhere, with weight 0 */
        }
        out->x[i] = w[0];
        out->y[i] = w[1];
        out->z[i] = w[2];
    }
    return MCR_OK;
}

static int32_t passes(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    (void)host, (void)context, (void)instance;
    for (uint32_t i = 0; i < at->n; i++) {
        out->r[i] = input(inputs, PASS, 0, i);
        out->g[i] = input(inputs, PASS, 1, i);
        out->b[i] = input(inputs, PASS, 2, i);
    }
    return MCR_OK;
}

static const struct mcr_material_plugin sheet = {.head = {sizeof(struct mcr_material_plugin), MCR_KIND_MATERIAL, MCR_ISA_BASELINE, PARAMETERS,
                                                          "sheet", "1", "Apache-2.0", "for tests", parameters},
                                                 .create = create,
                                                 .destroy = free,
                                                 .traits = traits,
                                                 .evaluate = evaluate,
                                                 .draw = draw,
                                                 .density = density,
                                                 .emission = emission,
                                                 .delta = delta,
                                                 .passes = passes};
static const struct mcr_descriptor *const list[] = {&sheet.head};
MCR_EXPORT const struct mcr_plugin mcr_plugin = {sizeof mcr_plugin, MCR_PLUGIN_MAJOR, MCR_PLUGIN_MINOR, 1, list};
