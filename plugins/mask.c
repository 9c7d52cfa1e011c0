/* SPDX-License-Identifier: Apache-2.0 */
/* mask: a material with holes: what it is not opaque to crosses the surface straight on, as if there were nothing. */
#include <mcrender/material.h>
#include <mcrender/sampler.h>
#include <stdlib.h>
#include <string.h>

/* The parameters' places in the table, and their first channels among the inputs. */
enum { MATERIAL, OPACITY, PARAMETERS };
#define CHANNEL(parameter) (3 * (parameter))

#define SCATTERS (MCR_MATERIAL_REFLECTS | MCR_MATERIAL_TRANSMITS)
#define EMITS (MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK)

static const struct mcr_parameter parameters[PARAMETERS] = {
    [MATERIAL] = {.size = sizeof(struct mcr_parameter),
                  .type = MCR_TYPE_MATERIAL,
                  .flags = MCR_PARAMETER_REQUIRED,
                  .name = "material",
                  .unit = "",
                  .summary = "What is there where it is opaque."},
    [OPACITY] = {.size = sizeof(struct mcr_parameter),
                 .type = MCR_TYPE_COLOUR,
                 .flags = MCR_PARAMETER_REQUIRED | MCR_PARAMETER_VARYING,
                 .name = "opacity",
                 .unit = "",
                 .summary = "Share of the light that meets the material; the rest crosses straight on. As a colour: a stained sheet.",
                 .min = 0,
                 .max = 1},
};

struct mask {
    const struct mcr_child *child;
    struct mcr_material_traits traits;
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    struct mask *mask = calloc(1, sizeof *mask);
    int32_t status;

    *instance = NULL;
    if (!mask)
        return MCR_E_NOMEM;
    mask->child = with->child[(uint32_t)with->values->number[CHANNEL(MATERIAL)]];
    mask->traits.size = sizeof mask->traits;
    status = host->material_child_traits(host, context, mask->child, &mask->traits);
    if (status)
        free(mask);
    else
        *instance = mask;
    return status;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    const struct mask *mask = instance;
    uint32_t size = traits->size;

    (void)host, (void)context;
    memcpy(traits, &mask->traits, size < sizeof *traits ? size : sizeof *traits);
    traits->size = size;
    traits->does |= MCR_MATERIAL_PASSES;
    for (int c = 0; c < 3; c++)
        traits->radiance[c] *= values->number[CHANNEL(OPACITY) + c];
    return MCR_OK;
}

static void clear(const struct mcr_colours *out)
{
    memset(out->r, 0, out->n * sizeof *out->r);
    memset(out->g, 0, out->n * sizeof *out->g);
    memset(out->b, 0, out->n * sizeof *out->b);
}

static void multiply_lanes(uint32_t n, const double *restrict opacity, uint32_t stride, double *restrict out)
{
    for (uint32_t i = 0; i < n; i++)
        out[i] *= opacity[i * stride];
}

static void multiply(const struct mcr_inputs *inputs, const struct mcr_colours *out)
{
    const double *const *opacity = inputs->channel + CHANNEL(OPACITY);
    const uint32_t *stride = inputs->stride + CHANNEL(OPACITY);

    multiply_lanes(out->n, opacity[0], stride[0], out->r);
    multiply_lanes(out->n, opacity[1], stride[1], out->g);
    multiply_lanes(out->n, opacity[2], stride[2], out->b);
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    const struct mask *mask = instance;
    int32_t status = MCR_OK;

    if (mask->traits.does & SCATTERS)
        status = host->material_child_evaluate(host, context, mask->child, at, toward, out);
    else
        clear(out);
    multiply(inputs, out);
    return status;
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    const struct mask *mask = instance;

    (void)inputs;
    if (mask->traits.does & SCATTERS)
        return host->material_child_draw(host, context, mask->child, at, number, out, density);
    memset(out->x, 0, at->n * sizeof *out->x);
    memset(out->y, 0, at->n * sizeof *out->y);
    memset(out->z, 0, at->n * sizeof *out->z);
    if (density)
        memset(density, 0, at->n * sizeof *density);
    return MCR_OK;
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    const struct mask *mask = instance;

    (void)inputs;
    if (mask->traits.does & SCATTERS)
        return host->material_child_density(host, context, mask->child, at, toward, density);
    memset(density, 0, at->n * sizeof *density);
    return MCR_OK;
}

static int32_t emission(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_colours *out)
{
    const struct mask *mask = instance;
    int32_t status = MCR_OK;

    if (mask->traits.does & EMITS)
        status = host->material_child_emission(host, context, mask->child, at, out);
    else
        clear(out);
    multiply(inputs, out);
    return status;
}

static int32_t delta(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                     const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *probability,
                     const struct mcr_colours *weight)
{
    const struct mask *mask = instance;
    int32_t status = MCR_OK;

    if (mask->traits.does & MCR_MATERIAL_DELTA) {
        status = host->material_child_delta(host, context, mask->child, at, number, out, probability, weight);
    } else {
        memset(out->x, 0, at->n * sizeof *out->x);
        memset(out->y, 0, at->n * sizeof *out->y);
        memset(out->z, 0, at->n * sizeof *out->z);
        for (uint32_t i = 0; i < at->n; i++)
            probability[i] = 1;
        clear(weight);
    }
    multiply(inputs, weight);
    return status;
}

/* What is not opaque, and of the rest p, which crosses the material itself: exactly 1 and p where opacity is 0 and 1. */
static void pass_lanes(uint32_t n, const double *restrict opacity, uint32_t stride, double *restrict out)
{
    for (uint32_t i = 0; i < n; i++)
        out[i] = 1 - opacity[i * stride] + opacity[i * stride] * out[i];
}

static int32_t passes(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    const struct mask *mask = instance;
    const double *const *opacity = inputs->channel + CHANNEL(OPACITY);
    const uint32_t *stride = inputs->stride + CHANNEL(OPACITY);
    int32_t status = MCR_OK;

    if (mask->traits.does & MCR_MATERIAL_PASSES)
        status = host->material_child_passes(host, context, mask->child, at, out);
    else
        clear(out);
    pass_lanes(at->n, opacity[0], stride[0], out->r);
    pass_lanes(at->n, opacity[1], stride[1], out->g);
    pass_lanes(at->n, opacity[2], stride[2], out->b);
    return status;
}

static int32_t albedo(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    const struct mask *mask = instance;
    int32_t status = MCR_OK;

    if (mask->traits.does & (SCATTERS | MCR_MATERIAL_DELTA))
        status = host->material_child_albedo(host, context, mask->child, at, out);
    else
        clear(out);
    multiply(inputs, out);
    return status;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin),
             .kind = MCR_KIND_MATERIAL,
             .isa = MCR_ISA,
             .parameter_count = PARAMETERS,
             .name = "mask",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "a material with holes or of partial opacity; the rest of the light crosses straight on",
             .parameters = parameters},
    .create = create,
    .destroy = free,
    .traits = traits,
    .evaluate = evaluate,
    .draw = draw,
    .density = density,
    .emission = emission,
    .delta = delta,
    .passes = passes,
    .albedo = albedo,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
