/* SPDX-License-Identifier: Apache-2.0 */
/* lambert: scatters equally into all directions: f = albedo / pi over the hemisphere of the outgoing direction, on both sides. */
#include <math.h>
#include <mcrender/surface.h>

static const struct mcr_parameter parameters[] = {
    {.size = sizeof(struct mcr_parameter),
     .type = MCR_TYPE_COLOUR,
     .flags = MCR_PARAMETER_VARYING,
     .name = "albedo",
     .unit = "",
     .summary = "Share of the arriving light that is scattered.",
     .fallback = {0.5, 0.5, 0.5},
     .min = 0,
     .max = 1},
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    (void)host, (void)context, (void)with;
    *instance = NULL;
    return MCR_OK;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    (void)host, (void)context, (void)instance, (void)values;
    traits->does = MCR_MATERIAL_REFLECTS;
    return MCR_OK;
}

static int32_t evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    (void)host, (void)context, (void)instance;
    mcr_cosine_evaluate(inputs, 0, at, toward, out);
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
    mcr_colour_lanes(at->n, inputs, 0, out);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin),
             .kind = MCR_KIND_MATERIAL,
             .isa = MCR_ISA,
             .parameter_count = 1,
             .name = "lambert",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "ideally diffuse surface, two-sided",
             .parameters = parameters},
    .flags = MCR_MATERIAL_STATELESS | MCR_MATERIAL_LAMBERTIAN,
    .create = create,
    .traits = traits,
    .evaluate = evaluate,
    .draw = draw,
    .density = density,
    .albedo = albedo,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
