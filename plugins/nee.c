/* SPDX-License-Identifier: Apache-2.0 */
/*
 * nee, next event estimation: at each point a direction that the material draws, by which the path goes on, and a point on an emitter to which
 * visibility is tested. The core combines what both find by multiple importance sampling (Veach and Guibas, "Optimally combining sampling
 * techniques for Monte Carlo rendering", 1995), with the heuristic that the scene names. Without lights only the first is left: bsdf.
 */
#include <mcrender/techniques.h>

static const struct mcr_parameter parameters[] = {MCR_PARAMETER_BY};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    *instance = mcr_by_instance(with->values->number[0]);
    return mcr_without_children(host, context, with);
}

static int32_t techniques(const struct mcr_host *host, struct mcr_context *context, const void *instance, struct mcr_technique *technique,
                          uint32_t *count)
{
    (void)instance;
    return mcr_nee_techniques(host, context, 0, technique, count);
}

MCR_HIDDEN const struct mcr_directions_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_directions_plugin),
             .kind = MCR_KIND_DIRECTIONS,
             .isa = MCR_ISA,
             .parameter_count = 1,
             .name = "nee",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "points on emitters and directions as each material draws them, combined",
             .parameters = parameters},
    .create = create,
    .techniques = techniques,
    .draw = mcr_material_draw,
    .density = mcr_material_density,
    .draw_emitter = mcr_emitter_draw,
    .density_emitter = mcr_emitter_density,
};

MCR_PLUGIN(struct mcr_directions_plugin, descriptor);
