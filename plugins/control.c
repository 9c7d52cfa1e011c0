/* SPDX-License-Identifier: Apache-2.0 */
/*
 * control: `nee` with a control variate. Where a polygon or a sphere sheds light on a Lambertian surface, the host adds what it would shed if nothing were
 * between, in closed form, and the points on emitters estimate what is hidden of it: no noise where nothing is. Everything else is as with `nee`:
 * points and the material's directions, combined by multiple importance sampling. (J. Hammersley and D. Handscomb, "Monte Carlo Methods", 1964, 5.5.)
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
    return mcr_nee_techniques(host, context, MCR_TECHNIQUE_CONTROL, technique, count);
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
    .draw = mcr_material_draw,
    .density = mcr_material_density,
    .draw_emitter = mcr_emitter_draw,
    .density_emitter = mcr_emitter_density,
};

MCR_PLUGIN(struct mcr_directions_plugin, descriptor);
