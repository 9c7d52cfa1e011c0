/* SPDX-License-Identifier: Apache-2.0 */
/*
 * For testing how the core combines techniques, and that materials are asked: the sampler `neelight` is `nee` with a direction technique
 * that looks for light as well; `skewed` is `nee` with a mistake: the density over emitters is 5 % too high. The material `flat` scatters as lambert of albedo 1/2
 * does, but draws uniformly, and draws nothing at all in lanes that nobody looks at.
 */
#include <math.h>
#include <mcrender/material.h>
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

/* ---- flat ------------------------------------------------------------------------------------------------------ */

#define PER_PI 0.31830988618379067

static int32_t flat_traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                           struct mcr_material_traits *traits)
{
    (void)host, (void)context, (void)instance, (void)values;
    traits->does = MCR_MATERIAL_REFLECTS;
    return MCR_OK;
}

static double cosine(const struct mcr_points *at, const struct mcr_directions *toward, uint32_t i)
{
    return at->nx[i] * toward->x[i] + at->ny[i] * toward->y[i] + at->nz[i] * toward->z[i];
}

static int32_t flat_evaluate(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                             const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    (void)host, (void)context, (void)instance, (void)inputs;
    for (uint32_t i = 0; i < at->n; i++) {
        double c = cosine(at, toward, i);
        out->r[i] = out->g[i] = out->b[i] = c > 0 ? 0.5 * c * PER_PI : 0;
    }
    return MCR_OK;
}

static int32_t flat_density(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                            const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)host, (void)context, (void)instance, (void)inputs;
    for (uint32_t i = 0; i < at->n; i++)
        density[i] = cosine(at, toward, i) > 0 ? 0.5 * PER_PI : 0;
    return MCR_OK;
}

static int32_t flat_draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                         const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    for (uint32_t i = 0; i < at->n; i++) {
        double x, y, square = 1 - mcr_disk_from_square(number[0][i], number[1][i], &x, &y), s = sqrt(2 - square);
        int wanted = !at->wanted || at->wanted[i] != 0;
        mcr_to_world(at->nx[i], at->ny[i], at->nz[i], x * s, y * s, 1 - square, &out->x[i], &out->y[i], &out->z[i]);
        if (!wanted || !(cosine(at, out, i) > 0))
            out->x[i] = out->y[i] = out->z[i] = 0;
    }
    return density ? flat_density(host, context, instance, inputs, at, out, density) : MCR_OK;
}

#define HEAD(NAME, TYPE, KIND) {sizeof(struct TYPE), KIND, MCR_ISA_BASELINE, 0, NAME, "1", "Apache-2.0", "for tests", NULL}

static const struct mcr_directions_plugin neelight = {.head = HEAD("neelight", mcr_directions_plugin, MCR_KIND_DIRECTIONS),
                                                      .create = create,
                                                      .techniques = and_a_direction_technique,
                                                      .draw = draw,
                                                      .density = density,
                                                      .draw_emitter = draw_emitter,
                                                      .density_emitter = density_emitter};
static const struct mcr_directions_plugin skewed = {.head = HEAD("skewed", mcr_directions_plugin, MCR_KIND_DIRECTIONS),
                                                    .create = create,
                                                    .techniques = one_emitter_technique,
                                                    .draw = draw,
                                                    .density = density,
                                                    .draw_emitter = draw_emitter_skewed,
                                                    .density_emitter = density_emitter_skewed};
static const struct mcr_material_plugin flat = {.head = HEAD("flat", mcr_material_plugin, MCR_KIND_MATERIAL),
                                                .create = create,
                                                .traits = flat_traits,
                                                .evaluate = flat_evaluate,
                                                .draw = flat_draw,
                                                .density = flat_density};
static const struct mcr_descriptor *const list[] = {&neelight.head, &skewed.head, &flat.head};
MCR_EXPORT const struct mcr_plugin mcr_plugin = {sizeof mcr_plugin, MCR_PLUGIN_MAJOR, MCR_PLUGIN_MINOR, 3, list};
