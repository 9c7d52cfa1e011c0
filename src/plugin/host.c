/* SPDX-License-Identifier: Apache-2.0 */
/* The host as plugins see it while they are created: the scene is not there yet, so that only messages and questions work. */
#include <string.h>

#include "plugin/node.h"

static void report(const struct mcr_host *host, struct mcr_context *context, uint32_t severity, const char *text)
{
    enum mcr_severity as = severity == MCR_REPORT_NOTE ? MCR_NOTE : severity == MCR_REPORT_WARNING ? MCR_WARNING : MCR_ERROR;

    (void)host;
    mcr_report(context->diagnostics, as, context->node->place, "%.500s", text ? text : "(no text)");
}

static void *no_scratch(const struct mcr_host *host, struct mcr_context *context)
{
    (void)host, (void)context;
    return NULL;
}

static int32_t child_techniques(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                struct mcr_technique *technique, uint32_t *count)
{
    const struct mcr_node *node = (const struct mcr_node *)child;

    (void)host, (void)context;
    if (!child || node->descriptor->kind != MCR_KIND_DIRECTIONS)
        return MCR_E_INVALID;
    for (uint32_t t = 0; t < node->technique_count; t++) {
        size_t size = technique[t].size < sizeof *technique ? technique[t].size : sizeof *technique;

        if (size > sizeof technique->size) /* as much as the caller knows of, but for its own `size` */
            memcpy((char *)&technique[t] + sizeof technique->size, (const char *)&node->technique[t] + sizeof technique->size,
                   size - sizeof technique->size);
    }
    *count = node->technique_count;
    return MCR_OK;
}

static int32_t no_draw(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                       const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)host, (void)context, (void)child, (void)technique, (void)at, (void)number, (void)out, (void)density;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_density(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                          const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)host, (void)context, (void)child, (void)technique, (void)at, (void)toward, (void)density;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_mass(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                       const struct mcr_points *at, double *mass)
{
    (void)host, (void)context, (void)child, (void)technique, (void)at, (void)mass;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_light_draw(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                             const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)host, (void)context, (void)by, (void)at, (void)number, (void)out, (void)density;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_light_density(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                                const struct mcr_directions *toward, double *density)
{
    (void)host, (void)context, (void)by, (void)at, (void)toward, (void)density;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_light_mass(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at, double *mass)
{
    (void)host, (void)context, (void)by, (void)at, (void)mass;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_light_draw_point(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                                   const double *const *number, const struct mcr_emitter_points *out, double *density)
{
    (void)host, (void)context, (void)by, (void)at, (void)number, (void)out, (void)density;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_light_density_point(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                                      const struct mcr_emitter_points *points, double *density)
{
    (void)host, (void)context, (void)by, (void)at, (void)points, (void)density;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_material_draw(const struct mcr_host *host, struct mcr_context *context, const struct mcr_points *at,
                                const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)host, (void)context, (void)at, (void)number, (void)out, (void)density;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_material_density(const struct mcr_host *host, struct mcr_context *context, const struct mcr_points *at,
                                   const struct mcr_directions *toward, double *density)
{
    (void)host, (void)context, (void)at, (void)toward, (void)density;
    return MCR_E_UNSUPPORTED;
}

static int32_t material_child_traits(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                     struct mcr_material_traits *traits)
{
    const struct mcr_node *node = (const struct mcr_node *)child;
    size_t size = traits->size < sizeof *traits ? traits->size : sizeof *traits;

    (void)host, (void)context;
    if (!child || node->descriptor->kind != MCR_KIND_MATERIAL || !node->traits)
        return MCR_E_INVALID;
    if (size > sizeof traits->size) /* as much as the caller knows of, but for its own `size` */
        memcpy((char *)traits + sizeof traits->size, (const char *)node->traits + sizeof traits->size, size - sizeof traits->size);
    return MCR_OK;
}

static int32_t no_child_evaluate(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                 const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    (void)host, (void)context, (void)child, (void)at, (void)toward, (void)out;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_child_draw(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                             const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)host, (void)context, (void)child, (void)at, (void)number, (void)out, (void)density;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_child_density(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)host, (void)context, (void)child, (void)at, (void)toward, (void)density;
    return MCR_E_UNSUPPORTED;
}

/* emission, passes, albedo */
static int32_t no_child_colour(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                               const struct mcr_points *at, const struct mcr_colours *out)
{
    (void)host, (void)context, (void)child, (void)at, (void)out;
    return MCR_E_UNSUPPORTED;
}

static int32_t no_child_delta(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                              const struct mcr_points *at, const double *const *number, const struct mcr_directions *out,
                              double *probability, const struct mcr_colours *weight)
{
    (void)host, (void)context, (void)child, (void)at, (void)number, (void)out, (void)probability, (void)weight;
    return MCR_E_UNSUPPORTED;
}

static uint32_t has_lights(const struct mcr_host *host, struct mcr_context *context)
{
    (void)host;
    return context->has_lights;
}

const struct mcr_host *mcr_creation_host(void)
{
    static const struct mcr_host host = {
        .size = sizeof host,
        .major = MCR_PLUGIN_MAJOR,
        .minor = MCR_PLUGIN_MINOR,
        .report = report,
        .scratch = no_scratch,
        .child_techniques = child_techniques,
        .child_draw = no_draw,
        .child_density = no_density,
        .child_mass = no_mass,
        .light_draw = no_light_draw,
        .light_density = no_light_density,
        .light_mass = no_light_mass,
        .light_draw_point = no_light_draw_point,
        .light_density_point = no_light_density_point,
        .material_draw = no_material_draw,
        .material_density = no_material_density,
        .has_lights = has_lights,
        .material_child_traits = material_child_traits,
        .material_child_evaluate = no_child_evaluate,
        .material_child_draw = no_child_draw,
        .material_child_density = no_child_density,
        .material_child_emission = no_child_colour,
        .material_child_delta = no_child_delta,
        .material_child_passes = no_child_colour,
        .material_child_albedo = no_child_colour,
    };

    return &host;
}
