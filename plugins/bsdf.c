/* SPDX-License-Identifier: Apache-2.0 */
/*
 * bsdf: what the material at each point would draw itself. Every material that scatters can; the host refuses those that cannot when it
 * loads them.
 */
#include <mcrender/sampler.h>

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    *instance = NULL;
    return mcr_without_children(host, context, with);
}

static int32_t techniques(const struct mcr_host *host, struct mcr_context *context, const void *instance, struct mcr_technique *technique,
                          uint32_t *count)
{
    (void)host, (void)context, (void)instance;
    technique[0].kind = MCR_TECHNIQUE_DIRECTION;
    technique[0].covers = MCR_COVERS_REFLECTION | MCR_COVERS_TRANSMISSION;
    technique[0].continues = 1;
    technique[0].dimensions = MCR_MATERIAL_DIMENSIONS;
    *count = 1;
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

MCR_HIDDEN const struct mcr_directions_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_directions_plugin),
             .kind = MCR_KIND_DIRECTIONS,
             .isa = MCR_ISA,
             .name = "bsdf",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "directions as each material draws them itself"},
    .create = create,
    .techniques = techniques,
    .draw = draw,
    .density = density,
};

MCR_PLUGIN(struct mcr_directions_plugin, descriptor);
