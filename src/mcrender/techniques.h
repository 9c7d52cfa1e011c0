/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mcrender plugin interface: the techniques that the host's services make, for samplers to use as their operations or to call from them: directions as
 * the material draws them, directions toward emitters, and points on emitters. Everything is compiled into the plugin.
 */
#ifndef MCRENDER_TECHNIQUES_H
#define MCRENDER_TECHNIQUES_H

#include <mcrender/sampler.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- how emitters are sampled: the parameter `by`, and an instance that is nothing but its value ---- */

/* The row of the table. The words are in the order of MCR_LIGHT_BY_*. */
#define MCR_PARAMETER_BY                                                                                                             \
    {                                                                                                                                \
        .size = sizeof(struct mcr_parameter), .type = MCR_TYPE_CHOICE, .name = "by", .unit = "", .choices = "area|solid-angle",      \
        .summary = "Measure in which points of an emitter are equally likely; solid angle falls back to area where it is not stable.", \
        .fallback = {MCR_LIGHT_BY_SOLID_ANGLE},                                                                                      \
    }

/* The instance for a value of `by`: one of two constants, so that `create` has nothing to allocate and `destroy` nothing to free. */
MCR_INLINE void *mcr_by_instance(double value)
{
    static const uint32_t by[] = {MCR_LIGHT_BY_AREA, MCR_LIGHT_BY_SOLID_ANGLE};
    return (void *)&by[value == MCR_LIGHT_BY_AREA ? 0 : 1];
}

MCR_INLINE uint32_t mcr_instance_by(const void *instance) { return *(const uint32_t *)instance; }

/* ---- the material's own directions, by which the path goes on; they read no instance ---- */

MCR_INLINE void mcr_material_technique(struct mcr_technique *technique)
{
    technique->kind = MCR_TECHNIQUE_DIRECTION;
    technique->covers = MCR_COVERS_REFLECTION | MCR_COVERS_TRANSMISSION;
    technique->continues = 1;
    technique->dimensions = MCR_MATERIAL_DIMENSIONS;
}

MCR_INLINE int32_t mcr_material_draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                                     const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)instance, (void)technique;
    return host->material_draw(host, context, at, number, out, density);
}

MCR_INLINE int32_t mcr_material_density(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                                        const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)instance, (void)technique;
    return host->material_density(host, context, at, toward, density);
}

/* ---- directions toward emitters, by which the path goes on; the instance is that of mcr_by_instance ---- */

MCR_INLINE void mcr_light_technique(struct mcr_technique *technique)
{
    technique->kind = MCR_TECHNIQUE_DIRECTION;
    technique->covers = MCR_COVERS_EMITTERS;
    technique->continues = 1;
    technique->dimensions = MCR_LIGHT_DIMENSIONS;
}

MCR_INLINE int32_t mcr_light_draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                                  const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)technique;
    return host->light_draw(host, context, mcr_instance_by(instance), at, number, out, density);
}

MCR_INLINE int32_t mcr_light_density(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                                     const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)technique;
    return host->light_density(host, context, mcr_instance_by(instance), at, toward, density);
}

MCR_INLINE int32_t mcr_light_mass(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                                  const struct mcr_points *at, double *mass)
{
    (void)technique;
    return host->light_mass(host, context, mcr_instance_by(instance), at, mass);
}

/* ---- points on emitters, which only look for light; the instance is that of mcr_by_instance ---- */

MCR_INLINE void mcr_emitter_technique(struct mcr_technique *technique)
{
    technique->kind = MCR_TECHNIQUE_EMITTER;
    technique->covers = MCR_COVERS_EMITTERS;
    technique->continues = 0;
    technique->dimensions = MCR_LIGHT_DIMENSIONS;
}

MCR_INLINE int32_t mcr_emitter_draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                                    const struct mcr_points *at, const double *const *number, const struct mcr_emitter_points *out, double *density)
{
    (void)technique;
    return host->light_draw_point(host, context, mcr_instance_by(instance), at, number, out, density);
}

MCR_INLINE int32_t mcr_emitter_density(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                                       const struct mcr_points *at, const struct mcr_emitter_points *points, double *density)
{
    (void)technique;
    return host->light_density_point(host, context, mcr_instance_by(instance), at, points, density);
}

/*
 * ---- next event estimation: the material's technique, and points on emitters where the scene has any ----
 *
 * The material's technique comes first, so that its numbers are the same with and without lights. Operations of such a sampler are mcr_material_draw,
 * mcr_material_density, mcr_emitter_draw and mcr_emitter_density: there is one technique of each kind. `flags` are those of the points' technique.
 */
MCR_INLINE int32_t mcr_nee_techniques(const struct mcr_host *host, struct mcr_context *context, uint32_t flags, struct mcr_technique *technique,
                                      uint32_t *count)
{
    mcr_material_technique(&technique[0]);
    *count = 1;
    if (!host->has_lights(host, context))
        return MCR_OK;
    mcr_emitter_technique(&technique[1]);
    technique[1].flags = flags;
    *count = 2;
    return MCR_OK;
}

#ifdef __cplusplus
}
#endif

#endif
