/* SPDX-License-Identifier: Apache-2.0 */
/* light: directions toward emitters, as the host samples them. Draws nothing where no emitter can be seen at all. */
#include <mcrender/sampler.h>

/* The words of `by` in the order of MCR_LIGHT_BY_*. */
static const struct mcr_parameter parameters[] = {
    {.size = sizeof(struct mcr_parameter),
     .type = MCR_TYPE_CHOICE,
     .name = "by",
     .unit = "",
     .choices = "area|solid-angle",
     .summary = "Measure in which points of an emitter are equally likely; solid angle falls back to area where it is not stable.",
     .fallback = {MCR_LIGHT_BY_SOLID_ANGLE}},
};

/* Two constants, so that create has nothing to allocate: the instance points at one of them. */
static const uint32_t by_area = MCR_LIGHT_BY_AREA, by_solid_angle = MCR_LIGHT_BY_SOLID_ANGLE;

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    *instance = (void *)(with->values->number[0] == MCR_LIGHT_BY_AREA ? &by_area : &by_solid_angle);
    if (!host->has_lights(host, context)) {
        host->report(host, context, MCR_REPORT_ERROR, "'light' has nothing to draw: no emitter of this scene can be sampled");
        return MCR_E_INVALID;
    }
    return mcr_without_children(host, context, with);
}

static int32_t techniques(const struct mcr_host *host, struct mcr_context *context, const void *instance, struct mcr_technique *technique,
                          uint32_t *count)
{
    (void)host, (void)context, (void)instance;
    technique[0].kind = MCR_TECHNIQUE_DIRECTION;
    technique[0].covers = MCR_COVERS_EMITTERS;
    technique[0].continues = 1;
    technique[0].dimensions = MCR_LIGHT_DIMENSIONS;
    *count = 1;
    return MCR_OK;
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)technique;
    return host->light_draw(host, context, *(const uint32_t *)instance, at, number, out, density);
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)technique;
    return host->light_density(host, context, *(const uint32_t *)instance, at, toward, density);
}

static int32_t mass(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                    const struct mcr_points *at, double *mass)
{
    (void)technique;
    return host->light_mass(host, context, *(const uint32_t *)instance, at, mass);
}

MCR_HIDDEN const struct mcr_directions_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_directions_plugin),
             .kind = MCR_KIND_DIRECTIONS,
             .isa = MCR_ISA,
             .parameter_count = 1,
             .name = "light",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "directions toward emitters",
             .parameters = parameters},
    .create = create,
    .techniques = techniques,
    .draw = draw,
    .density = density,
    .mass = mass,
};

MCR_PLUGIN(struct mcr_directions_plugin, descriptor);
