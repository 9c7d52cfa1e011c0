/* SPDX-License-Identifier: Apache-2.0 */
/*
 * bsdf: what the material at each point would draw itself. Every material that scatters can; the host refuses those that cannot when it
 * loads them.
 */
#include <mcrender/techniques.h>

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    *instance = NULL;
    return mcr_without_children(host, context, with);
}

static int32_t techniques(const struct mcr_host *host, struct mcr_context *context, const void *instance, struct mcr_technique *technique,
                          uint32_t *count)
{
    (void)host, (void)context, (void)instance;
    mcr_material_technique(&technique[0]);
    *count = 1;
    return MCR_OK;
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
    .draw = mcr_material_draw,
    .density = mcr_material_density,
};

MCR_PLUGIN(struct mcr_directions_plugin, descriptor);
