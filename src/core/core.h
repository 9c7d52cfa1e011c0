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
    MCR_STAGE_CROSSING,    /* of paths and look-ups alike */
    MCR_STAGE_SORT,
    MCR_STAGE_SURFACE,
    MCR_STAGE_COORDINATES, /* footprints, tangents */
    MCR_STAGE_NORMALS,     /* tilted by maps and bumps */
    MCR_STAGE_INPUTS,      /* values that differ between the materials of a call; those of look-ups too */
    MCR_STAGE_TEXTURES,    /* the same */
    MCR_STAGE_INTERIORS,
    MCR_STAGE_SKY,         /* seen by paths; the background, too */
    MCR_STAGE_EMISSION,
    MCR_STAGE_NUMBERS,
    MCR_STAGE_SAMPLER,
    MCR_STAGE_LOBES,
    MCR_STAGE_LIGHT,       /* look-ups, with their rays and all that they call but crossing and textures */
    MCR_STAGE_POINTS,      /* lights without extent, the same */
    MCR_STAGE_MATERIAL,
    MCR_STAGE_ROULETTE,
    MCR_STAGE_SCATTER,
    MCR_STAGE_COMPACT,
    MCR_STAGE_LAYERS,      /* of features */
    MCR_STAGE_FILM,
    MCR_STAGE_COUNT
};
extern const char *const mcr_stage_name[MCR_STAGE_COUNT];

#define MCR_INTERIORS 16u /* interiors that a path remembers being in, at most: see crossing.h */

#define MCR_TASK_CELLS 65536u /* cells of a task at most */

/* One replicate of one pixel, or with independent numbers the next of its samples. */
struct mcr_task_entry {
    uint32_t pixel;                          /* of the crop, row by row from the top */
    uint32_t first;                          /* the number of its first sample within the replicate */
    uint64_t replicate;
};

/* What a director asks for: `cells` cells of `cell_samples` samples for each entry. A pixel may be among the entries several times. */
struct mcr_task {
    const struct mcr_task_entry *entry;      /* the director's, until it is asked for the next task */
    uint32_t count, cells, cell_samples;     /* count * cells <= MCR_TASK_CELLS; cell_samples <= MCR_CELL_SAMPLES */
    uint32_t planned;                        /* samples of a replicate */
    int incomplete;                          /* after it pixels are still without any sample: an interruption waits */
    double begin, end;                       /* for the progress: how much of all is done before and after it, in [0,1] */
};

/*
 * Who says what is rendered next, where that is not `spp` samples of every pixel. It is asked between passes on the main thread, and knows what
 * finished passes have shown: threads, batches and instruction sets cannot matter.
 */
struct mcr_director {
    void *data;
    /* 1: *task is to be rendered; 0: all is done; -1: memory is short. seconds: since the rendering began. */
    int (*next)(void *data, double seconds, struct mcr_task *task);
    /* Its results: cell b of entry e in cell[b * count + e]; channels and features NULL unless asked for. Returns 0, or -1 when memory is short. */
    int (*take)(void *data, const struct mcr_task *task, const struct mcr_cell *cell, const struct mcr_cell_channels *channels,
                const struct mcr_cell_features *features);
    int channels;                            /* the channels' moments are asked for */
};

struct mcr_render_options {
    uint32_t isa;                            /* MCR_ISA_*, not above what the processor has */
    int profile;                             /* time the stages */
    uint32_t features;                       /* MCR_FEATURE_* that the sink's add_features takes, or the director; 0 */
    double pilot;                            /* not 0: only so many seconds of processor time, for the stats; see render.c */
    const volatile sig_atomic_t *stop;       /* not 0: end after the running pass. May be NULL */
    void (*progress)(void *data, double done, double seconds); /* done in [0,1]; called now and then on the main thread. May be NULL */
    void *progress_data;
    const struct mcr_director *director;     /* NULL: spp samples of every pixel. Else the sink is not used, and may be NULL */
};

struct mcr_render_stats {
    double wall_seconds, cpu_seconds;
    double pass_seconds;                     /* of processor time: of the passes alone; of a pilot only */
    uint32_t threads, batch, passes;
    uint64_t samples;                        /* paths begun and finished */
    uint64_t camera_rays, bounce_rays, shadow_rays;
    uint64_t scatterings;                    /* scattering events, over all paths */
    uint64_t not_finite;                     /* samples rejected and counted as black */
    uint32_t not_finite_x, not_finite_y;     /* where the first of them (in order of pixels of the first pass that has one) was */
    uint64_t not_finite_sample;
    uint64_t overfull;                       /* rays that entered more interiors than a path remembers */
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
