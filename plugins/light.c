/* SPDX-License-Identifier: Apache-2.0 */
/* light: directions toward emitters, as the host samples them. Draws nothing where no emitter can be seen at all. */
#include <mcrender/techniques.h>

static const struct mcr_parameter parameters[] = {MCR_PARAMETER_BY};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    *instance = mcr_by_instance(with->values->number[0]);
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
    mcr_light_technique(&technique[0]);
    *count = 1;
    return MCR_OK;
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
    .draw = mcr_light_draw,
    .density = mcr_light_density,
    .mass = mcr_light_mass,
};

MCR_PLUGIN(struct mcr_directions_plugin, descriptor);
