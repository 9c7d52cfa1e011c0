/* SPDX-License-Identifier: Apache-2.0 */
/*
 * control: `nee` with a control variate. Where a polygon or a sphere sheds light on a Lambertian surface, the host adds what it would shed if nothing were
 * between, in closed form, and the points on emitters estimate what is hidden of it: no noise where nothing is. Everything else is as with `nee`:
 * points and the material's directions, combined by multiple importance sampling. (J. Hammersley and D. Handscomb, "Monte Carlo Methods", 1964, 5.5.)
 */
#include <mcrender/sampler.h>

/* The techniques in their order. The one that is always there comes first, so that its numbers are the same with and without lights. */
enum { MATERIAL, EMITTER };

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
    return mcr_without_children(host, context, with);
}

static int32_t techniques(const struct mcr_host *host, struct mcr_context *context, const void *instance, struct mcr_technique *technique,
                          uint32_t *count)
{
    (void)instance;
    technique[MATERIAL].kind = MCR_TECHNIQUE_DIRECTION;
    technique[MATERIAL].covers = MCR_COVERS_REFLECTION | MCR_COVERS_TRANSMISSION;
    technique[MATERIAL].continues = 1;
    technique[MATERIAL].dimensions = MCR_MATERIAL_DIMENSIONS;
    *count = 1;
    if (!host->has_lights(host, context))
        return MCR_OK;
    technique[EMITTER].kind = MCR_TECHNIQUE_EMITTER;
    technique[EMITTER].covers = MCR_COVERS_EMITTERS;
    technique[EMITTER].continues = 0;
    technique[EMITTER].dimensions = MCR_LIGHT_DIMENSIONS;
    technique[EMITTER].flags = MCR_TECHNIQUE_CONTROL;
    *count = 2;
    return MCR_OK;
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)instance, (void)technique;
    return host->material_draw(host, context, at, number, out, density);
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)instance, (void)technique;
    return host->material_density(host, context, at, toward, density);
}

static int32_t draw_emitter(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                            const struct mcr_points *at, const double *const *number, const struct mcr_emitter_points *out, double *density)
{
    (void)technique;
    return host->light_draw_point(host, context, *(const uint32_t *)instance, at, number, out, density);
}

static int32_t density_emitter(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                               const struct mcr_points *at, const struct mcr_emitter_points *points, double *density)
{
    (void)technique;
    return host->light_density_point(host, context, *(const uint32_t *)instance, at, points, density);
}

MCR_HIDDEN const struct mcr_directions_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_directions_plugin),
             .kind = MCR_KIND_DIRECTIONS,
             .isa = MCR_ISA,
             .parameter_count = 1,
             .name = "control",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "nee with unoccluded light in closed form where it is known; only what is hidden is estimated",
             .parameters = parameters},
    .create = create,
    .techniques = techniques,
    .draw = draw,
    .density = density,
    .draw_emitter = draw_emitter,
    .density_emitter = density_emitter,
};

MCR_PLUGIN(struct mcr_directions_plugin, descriptor);
