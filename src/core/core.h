/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The path-tracing core: renders an immutable scene into cells of samples.
 *
 * The core never follows one path. Each thread owns a batch of paths in structure-of-arrays form and runs its stages over it, one file a stage,
 * until no path is left; finished paths make room for new ones. What a path contributes depends on its pixel and sample alone.
 */
#ifndef MCR_CORE_CORE_H
#define MCR_CORE_CORE_H

#include <signal.h>

#include "accel/accel.h"
#include "core/cell.h"
#include "core/features.h"
#include "scene/scene.h"

/* The stages, in the order in which a batch goes through them; indices of mcr_render_stats.stage_seconds. */
enum mcr_stage {
    MCR_STAGE_CAMERA,
    MCR_STAGE_HIT,
    MCR_STAGE_SORT,
    MCR_STAGE_SURFACE,
    MCR_STAGE_EMISSION,
    MCR_STAGE_NUMBERS,
    MCR_STAGE_SAMPLER,
    MCR_STAGE_LIGHT,
    MCR_STAGE_MATERIAL,
    MCR_STAGE_SCATTER,
    MCR_STAGE_COMPACT,
    MCR_STAGE_FILM,
    MCR_STAGE_COUNT
};
extern const char *const mcr_stage_name[MCR_STAGE_COUNT];

struct mcr_render_options {
    uint32_t isa;                            /* MCR_ISA_*, not above what the processor has */
    int profile;                             /* time the stages */
    uint32_t features;                       /* MCR_FEATURE_* that the sink's add_features takes; 0 */
    const volatile sig_atomic_t *stop;       /* not 0: end after the running pass. May be NULL */
    void (*progress)(void *data, double done, double seconds); /* done in [0,1]; called now and then on the main thread. May be NULL */
    void *progress_data;
};

struct mcr_render_stats {
    double wall_seconds, cpu_seconds;
    uint32_t threads, batch, passes;
    uint64_t samples;                        /* paths begun and finished */
    uint64_t camera_rays, bounce_rays, shadow_rays;
    uint64_t scatterings;                    /* scattering events, over all paths */
    uint64_t not_finite;                     /* samples rejected and counted as black */
    uint32_t not_finite_x, not_finite_y;     /* where the first of them (in order of pixels of the first pass that has one) was */
    uint64_t not_finite_sample;
    int interrupted;
    double stage_seconds[MCR_STAGE_COUNT];   /* summed over threads; 0 without profile */
};

/* What the sampler covers of what the scene's materials scatter, in words; "" if all of it. */
struct mcr_coverage {
    int complete;
    char missing[256];
};
void mcr_coverage(const struct mcr_scene *scene, struct mcr_coverage *coverage);

/*
 * Renders and hands the cells to `sink`. Returns 0, or -1 with the reason in `error` (memory, or a plugin's operation that failed).
 * Interrupted by *stop it returns 0 with stats->interrupted set, after whole passes.
 */
int mcr_render(const struct mcr_scene *scene, const struct mcr_accel *accel, const struct mcr_render_options *options, const struct mcr_cell_sink *sink,
               struct mcr_render_stats *stats, char *error, size_t length);

#endif
