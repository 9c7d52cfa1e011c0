/* SPDX-License-Identifier: Apache-2.0 */
#include "core/control.h"

#include <string.h>

#include "core/host.h"
#include "core/light_lanes.h"

/* Whether what a material emits is its mean radiance, from every point in every direction. */
static int is_even(const struct mcr_scene_material *material)
{
    const struct mcr_material_plugin *plugin = (const struct mcr_material_plugin *)(const void *)material->node->descriptor;
    if (material->needs & MCR_NEEDS_COORDINATES)
        return 0;
    return material->surface.emits ? !plugin->emission : (plugin->flags & MCR_MATERIAL_EVEN) != 0;
}

int mcr_control_init(struct mcr_core *core, struct mcr_arena *arena)
{
    const struct mcr_node *directions = core->scene->sampler->directions;
    const struct mcr_emitters *emitters = core->emitters;
    core->control = -1;
    for (uint32_t t = 0; t < directions->technique_count; t++)
        if (directions->technique[t].flags & MCR_TECHNIQUE_CONTROL)
            core->control = (int32_t)t;
    if (core->control < 0 || core->crosses || (core->scene->render.compat & MCR_COMPAT_BACKGROUND_AT_LIMIT) || !emitters->count || emitters->count > MCR_CONTROL_EMITTERS) {
        core->control = -1;
        return 0;
    }
    core->controllable = mcr_arena_alloc(arena, (size_t)emitters->count + 1, sizeof *core->controllable);
    if (!core->controllable)
        return -1;
    for (uint32_t e = 0; e < emitters->count; e++) {
        uint32_t kind = emitters->emitter[e].kind;
        int known = kind == MCR_EMITTER_PARALLELOGRAM || kind == MCR_EMITTER_TRIANGLE || kind == MCR_EMITTER_SPHERE;
        memcpy(core->controllable[e], &emitters->k[e][MCR_K_C], 3 * sizeof(double));
        core->controllable[e][3] = known && is_even(&core->scene->material[emitters->emitter[e].material]) ? emitters->emitter[e].area : -1;
    }
    core->controllable[emitters->count][3] = -1;
    return 0;
}

int32_t mcr_control_add(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_group *group = &core->group[range->group];
    const struct mcr_surface_points *at = &batch->at;
    struct mcr_light_lanes *l = &batch->light;
    const uint32_t b = range->begin;
    if (!(group->plugin->flags & MCR_MATERIAL_LAMBERTIAN) || group->lobes) {
        memset(batch->controlled + b, 0, (range->end - b) * sizeof *batch->controlled);
        return MCR_OK;
    }
    /* f cos toward the normal is rho / pi. */
    struct mcr_directions normal = {sizeof normal, range->end - b, at->nx + b, at->ny + b, at->nz + b};
    struct mcr_colours f = {sizeof f, range->end - b, l->fr + b, l->fg + b, l->fb + b};
    int32_t status = mcr_group_evaluate(batch, range, &normal, &f);
    if (!status)
        core->looks->control(batch, range);
    return status;
}
