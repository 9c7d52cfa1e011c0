/* SPDX-License-Identifier: Apache-2.0 */
/* emitter: radiates equally into all directions, from its front or from both sides. With an albedo it also scatters, as lambert does. */
#include <mcrender/surface.h>

/* The parameters' places in the table, and their first channels among the inputs. */
enum { RADIANCE, SIDES, ALBEDO, PARAMETERS };
#define CHANNEL(parameter) (3 * (parameter))
#define SIDES_TWO 1 /* place of the word in `choices` */

static const struct mcr_parameter parameters[PARAMETERS] = {
    [RADIANCE] = {.size = sizeof(struct mcr_parameter),
                  .type = MCR_TYPE_COLOUR,
                  .flags = MCR_PARAMETER_REQUIRED | MCR_PARAMETER_VARYING,
                  .name = "radiance",
                  .unit = "W/(sr m^2)",
                  .summary = "Emitted radiance, the same in all directions.",
                  .min = 0,
                  .max = 1e100}, /* squares of it are numbers */
    [SIDES] = {.size = sizeof(struct mcr_parameter),
               .type = MCR_TYPE_CHOICE,
               .name = "sides",
               .unit = "",
               .choices = "one|two",
               .summary = "Whether only the front radiates or both sides do.",
               .fallback = {0}},
    [ALBEDO] = {.size = sizeof(struct mcr_parameter),
                .type = MCR_TYPE_COLOUR,
                .flags = MCR_PARAMETER_VARYING,
                .name = "albedo",
                .unit = "",
                .summary = "Share of the arriving light that is scattered, on both sides.",
                .fallback = {0},
                .min = 0,
                .max = 1},
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    (void)host, (void)context, (void)with;
    *instance = NULL;
    return MCR_OK;
}

static int any(const double *colour)
{
    return colour[0] > 0 || colour[1] > 0 || colour[2] > 0;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    const double *radiance = values->number + CHANNEL(RADIANCE);

    (void)host, (void)context, (void)instance;
    traits->does = any(values->number + CHANNEL(ALBEDO)) ? MCR_MATERIAL_REFLECTS : 0;
    if (any(radiance))
        traits->does |= MCR_MATERIAL_EMITS_FRONT | (values->number[CHANNEL(SIDES)] == SIDES_TWO ? MCR_MATERIAL_EMITS_BACK : 0);
    for (int c = 0; c < 3; c++)
        traits->radiance[c] = radiance[c];
    return MCR_OK;
}

/* Radiance times a mask of 0 and 1. Called with the material's numbers where they are the same in all lanes. */
static void emit_same(uint32_t n, const double *restrict side, int two, double red, double green, double blue, double *restrict r,
                      double *restrict g, double *restrict b)
{
    for (uint32_t i = 0; i < n; i++) {
        int emits = two | (side[i] > 0);
        r[i] = emits ? red : 0;
        g[i] = emits ? green : 0;
        b[i] = emits ? blue : 0;
    }
}

/* One channel, with any strides. */
static void emit_channel(uint32_t n, const double *restrict side, const double *restrict sides, uint32_t sides_stride,
                         const double *restrict radiance, uint32_t radiance_stride, double *restrict out)
{
    for (uint32_t i = 0; i < n; i++) {
        int emits = (sides[i * sides_stride] == SIDES_TWO) | (side[i] > 0);
        out[i] = emits ? radiance[i * radiance_stride] : 0;
    }
}

static int32_t emission(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_colours *out)
{
    const double *const *radiance = inputs->channel + CHANNEL(RADIANCE), *sides = inputs->channel[CHANNEL(SIDES)];
    const uint32_t *stride = inputs->stride + CHANNEL(RADIANCE), sides_stride = inputs->stride[CHANNEL(SIDES)];
    double *const channel[3] = {out->r, out->g, out->b};

    (void)host, (void)context, (void)instance;
    if (!(stride[0] | stride[1] | stride[2] | sides_stride))
        emit_same(at->n, at->side, sides[0] == SIDES_TWO, radiance[0][0], radiance[1][0], radiance[2][0], out->r, out->g, out->b);
    else
        for (int c = 0; c < 3; c++)
            emit_channel(at->n, at->side, sides, sides_stride, radiance[c], stride[c], channel[c]);
    return MCR_OK;
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    (void)host, (void)context, (void)instance;
    mcr_cosine_evaluate(inputs, CHANNEL(ALBEDO), at, toward, out);
    return MCR_OK;
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)host, (void)context, (void)instance, (void)inputs;
    mcr_cosine_draw(at->n, at->nx, at->ny, at->nz, number[0], number[1], out->x, out->y, out->z);
    if (density)
        mcr_cosine_density(at->n, at->nx, at->ny, at->nz, out->x, out->y, out->z, density);
    return MCR_OK;
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)host, (void)context, (void)instance, (void)inputs;
    mcr_cosine_density(at->n, at->nx, at->ny, at->nz, toward->x, toward->y, toward->z, density);
    return MCR_OK;
}

static int32_t albedo(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    (void)host, (void)context, (void)instance;
    mcr_colour_lanes(at->n, inputs, CHANNEL(ALBEDO), out);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin),
             .kind = MCR_KIND_MATERIAL,
             .isa = MCR_ISA,
             .parameter_count = PARAMETERS,
             .name = "emitter",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "light source of constant radiance, diffuse if given an albedo",
             .parameters = parameters},
    .flags = MCR_MATERIAL_STATELESS | MCR_MATERIAL_EVEN,
    .create = create,
    .traits = traits,
    .evaluate = evaluate,
    .draw = draw,
    .density = density,
    .emission = emission,
    .albedo = albedo,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
