/* SPDX-License-Identifier: Apache-2.0 */
#include "core/assemble.h"

#include <string.h>

#include "core/control.h"
#include "core/crossing.h"
#include "core/groups.h"
#include "core/host.h"
#include "core/light_lanes.h"
#include "core/lights.h"

/* Rays in a batch by default: their arrays stay in the second-level cache (measured: `make bench`). */
#define DEFAULT_BATCH 1024u

static const struct mcr_stages *stages_of(uint32_t isa)
{
#if MCR_ISA_COUNT > 1
    return isa == MCR_ISA_AVX512 ? &mcr_stages_isa2 : isa == MCR_ISA_AVX2 ? &mcr_stages_isa1 : &mcr_stages_isa0;
#else
    (void)isa;
    return &mcr_stages_isa0;
#endif
}

static const struct mcr_accel_functions *trace_of(uint32_t isa, uint32_t kind)
{
    uint32_t k = kind == MCR_ACCEL_BVH;
#if MCR_ISA_COUNT > 1
    return isa == MCR_ISA_AVX512 ? &mcr_accel_functions_isa2[k] : isa == MCR_ISA_AVX2 ? &mcr_accel_functions_isa1[k] : &mcr_accel_functions_isa0[k];
#else
    (void)isa;
    return &mcr_accel_functions_isa0[k];
#endif
}

static const struct mcr_emitter_functions *lights_of(uint32_t isa)
{
#if MCR_ISA_COUNT > 1
    return isa == MCR_ISA_AVX512 ? &mcr_emitter_functions_isa2 : isa == MCR_ISA_AVX2 ? &mcr_emitter_functions_isa1 : &mcr_emitter_functions_isa0;
#else
    (void)isa;
    return &mcr_emitter_functions_isa0;
#endif
}

static const struct mcr_light_functions *looks_of(uint32_t isa)
{
#if MCR_ISA_COUNT > 1
    return isa == MCR_ISA_AVX512 ? &mcr_light_functions_isa2 : isa == MCR_ISA_AVX2 ? &mcr_light_functions_isa1 : &mcr_light_functions_isa0;
#else
    (void)isa;
    return &mcr_light_functions_isa0;
#endif
}

/* Bytes that the arena has handed out since the last call. */
static uint64_t since(const struct mcr_arena *arena, size_t *used)
{
    size_t before = *used;
    *used = mcr_arena_used(arena);
    return *used - before;
}

int mcr_core_init(struct mcr_core *core, struct mcr_arena *arena, const struct mcr_scene *scene, const struct mcr_accel *accel,
                  const struct mcr_render_options *options)
{
    const struct mcr_node *directions = scene->sampler->directions;
    const double *background = scene->render.background;
    core->scene = scene;
    core->accel = accel;
    core->options = options;
    core->features = options->features;
    core->trace = trace_of(options->isa, accel->kind);
    core->stages = stages_of(options->isa);
    core->lights = lights_of(options->isa);
    core->looks = looks_of(options->isa);
    core->capacity = scene->render.batch ? (scene->render.batch + MCR_LANE_PAD - 1) / MCR_LANE_PAD * MCR_LANE_PAD : DEFAULT_BATCH;
    core->needs_samples = scene->sampler->source_count > 0;
    core->needs_pixel = (scene->sampler->needs & MCR_NEEDS_PIXEL) != 0;
    core->background = background[0] > 0 || background[1] > 0 || background[2] > 0;
    for (uint32_t t = 0; t < directions->technique_count; t++) {
        core->dimensions += directions->technique[t].dimensions;
        if (directions->technique[t].continues)
            core->continuing = t;
    }
    core->combines = directions->technique_count > 1;
    memset(&core->tables, 0, sizeof core->tables);
    size_t used = mcr_arena_used(arena);
    core->emitters = mcr_emitters_create(arena, scene);
    core->tables.emitters = since(arena, &used);
    if (!core->emitters || mcr_groups_init(core, arena) || mcr_surfaces_init(core, arena))
        return -1;
    core->tables.surfaces = since(arena, &used);
    if (mcr_charts_init(core, arena))
        return -1;
    core->tables.charts = since(arena, &used);
    if (mcr_crossing_init(core, arena))
        return -1;
    mcr_crossing_camera(core);
    core->tables.crossing = since(arena, &used);
    if (mcr_lights_init(core, arena))
        return -1;
    core->tables.sky = since(arena, &used);
    if (mcr_point_lights_create(arena, scene, &core->point_lights))
        return -1;
    core->tables.points = since(arena, &used);
    core->background |= core->sky != NULL;
    if (mcr_control_init(core, arena))
        return -1;
    mcr_host_init(core);
    core->scratch_bytes = mcr_host_scratch(core);
    return 0;
}
