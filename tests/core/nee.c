/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A sampler with several techniques, for testing how the core combines them: `nee` draws points on emitters and continues by the material,
 * `neelight` looks for light with a direction technique as well. `skewed` is `nee` with a mistake: the density over emitters is 5 % too high.
 */
#include <mcrender/sampler.h>

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    (void)host;
    (void)context;
    (void)with;
    *instance = NULL;
    return MCR_OK;
}

static int32_t one_emitter_technique(const struct mcr_host *host, struct mcr_context *context, const void *instance, struct mcr_technique *technique,
                                     uint32_t *count)
{
    (void)host;
    (void)context;
    (void)instance;
    technique[0].kind = MCR_TECHNIQUE_EMITTER;
    technique[0].covers = MCR_COVERS_EMITTERS;
    technique[0].continues = 0;
    technique[0].dimensions = MCR_LIGHT_DIMENSIONS;
    technique[1].kind = MCR_TECHNIQUE_DIRECTION;
    technique[1].covers = MCR_COVERS_REFLECTION;
    technique[1].continues = 1;
    technique[1].dimensions = MCR_MATERIAL_DIMENSIONS;
    *count = 2;
    return MCR_OK;
}

static int32_t and_a_direction_technique(const struct mcr_host *host, struct mcr_context *context, const void *instance,
                                         struct mcr_technique *technique, uint32_t *count)
{
    one_emitter_technique(host, context, instance, technique, count);
    technique[2].kind = MCR_TECHNIQUE_DIRECTION;
    technique[2].covers = MCR_COVERS_EMITTERS;
    technique[2].continues = 0;
    technique[2].dimensions = MCR_LIGHT_DIMENSIONS;
    *count = 3;
    return MCR_OK;
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique, const struct mcr_points *at,
                    const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)instance;
    return technique == 1 ? host->material_draw(host, context, at, number, out, density)
                          : host->light_draw(host, context, MCR_LIGHT_BY_AREA, at, number, out, density);
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique, const struct mcr_points *at,
                       const struct mcr_directions *toward, double *out)
{
    (void)instance;
    return technique == 1 ? host->material_density(host, context, at, toward, out)
                          : host->light_density(host, context, MCR_LIGHT_BY_AREA, at, toward, out);
}

static int32_t draw_emitter(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                            const struct mcr_points *at, const double *const *number, const struct mcr_emitter_points *out, double *density)
{
    (void)instance;
    (void)technique;
    return host->light_draw_point(host, context, MCR_LIGHT_BY_SOLID_ANGLE, at, number, out, density);
}

static int32_t density_emitter(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                               const struct mcr_points *at, const struct mcr_emitter_points *points, double *density)
{
    (void)instance;
    (void)technique;
    return host->light_density_point(host, context, MCR_LIGHT_BY_SOLID_ANGLE, at, points, density);
}

static int32_t draw_emitter_skewed(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                                   const struct mcr_points *at, const double *const *number, const struct mcr_emitter_points *out, double *density)
{
    int32_t status = draw_emitter(host, context, instance, technique, at, number, out, density);
    for (uint32_t i = 0; i < at->n && density; i++)
        density[i] *= 1.05;
    return status;
}

static int32_t density_emitter_skewed(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                                      const struct mcr_points *at, const struct mcr_emitter_points *points, double *density)
{
    int32_t status = density_emitter(host, context, instance, technique, at, points, density);
    for (uint32_t i = 0; i < at->n; i++)
        density[i] *= 1.05;
    return status;
}

#define HEAD(NAME) {sizeof(struct mcr_directions_plugin), MCR_KIND_DIRECTIONS, MCR_ISA_BASELINE, 0, NAME, "1", "Apache-2.0", "for tests", NULL}

static const struct mcr_directions_plugin nee = {.head = HEAD("nee"),
                                                 .create = create,
                                                 .techniques = one_emitter_technique,
                                                 .draw = draw,
                                                 .density = density,
                                                 .draw_emitter = draw_emitter,
                                                 .density_emitter = density_emitter};
static const struct mcr_directions_plugin neelight = {.head = HEAD("neelight"),
                                                      .create = create,
                                                      .techniques = and_a_direction_technique,
                                                      .draw = draw,
                                                      .density = density,
                                                      .draw_emitter = draw_emitter,
                                                      .density_emitter = density_emitter};
static const struct mcr_directions_plugin skewed = {.head = HEAD("skewed"),
                                                    .create = create,
                                                    .techniques = one_emitter_technique,
                                                    .draw = draw,
                                                    .density = density,
                                                    .draw_emitter = draw_emitter_skewed,
                                                    .density_emitter = density_emitter_skewed};
static const struct mcr_descriptor *const list[] = {&nee.head, &neelight.head, &skewed.head};
MCR_EXPORT const struct mcr_plugin mcr_plugin = {sizeof mcr_plugin, MCR_PLUGIN_MAJOR, MCR_PLUGIN_MINOR, 3, list};
