/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A study: one scene rendered with every combination of some settings, several times each, and measured against a reference.
 *
 *   plan (what is asked for) -> cells (the product of its lists) -> runs (one render each, journalled) -> analysis (statistics) -> outputs
 *
 * A contestant is what competes: a cell's settings but spp and depth (and depth too, where one reference serves all depths). Cells with the same
 * spp and depth form a group, within which contestants are compared; cells of one contestant and depth form a series over spp.
 */
#ifndef MCR_STUDY_STUDY_H
#define MCR_STUDY_STUDY_H

#include "core/core.h"
#include "metrics/metrics.h"
#include "scene/scene.h"

/* What a cell renders with. */
struct mcr_study_settings {
    uint32_t sampler;    /* index in plan->sampler */
    uint32_t spp, depth;
    uint32_t precision;  /* enum mcr_precision */
    uint32_t accel;      /* enum mcr_accel_kind */
    int roulette;        /* 0, or 1 */
    uint32_t compat;     /* MCR_COMPAT_* */
};

struct mcr_study_plan {
    const char *title;                            /* of the report; the scene's file name by default */
    uint32_t sampler_count, spp_count, depth_count, precision_count, accel_count, roulette_count, compat_count; /* each at least 1 */
    const char *const *sampler;                   /* expressions, as text */
    const uint32_t *spp, *depth, *precision, *accel, *roulette, *compat; /* spp and depth ascending */
    uint32_t runs;                                /* timed, a cell; >= 1 */
    uint32_t seeds;                               /* independent, a cell; >= 1 */
    uint64_t first_seed;                          /* run i renders with first_seed + i */
    uint32_t baseline;                            /* index in sampler: what efficiency is relative to */
    double confidence;                            /* e.g. 0.95 */
    double target;                                /* MSE to reach; 0: chosen by the analysis, which tells it */
    uint32_t metrics;                             /* bits 1u << enum mcr_metric; MSE is always in */
    struct mcr_metrics_options how;               /* how they are measured */
    const char *output;                           /* folder */
    /* The reference. One for each depth of the contestants, or a single one where its depth (or an image) is given. */
    const char *reference_image;                  /* a file, or NULL */
    const char *reference_sampler;                /* an expression */
    uint32_t reference_spp, reference_depth;
    int has_reference_depth;
    uint64_t reference_seed;
};

struct mcr_study_reference {
    uint32_t depth;
    const struct mcr_image *image;
    double noise;         /* its own MSE (all colour channels, linear): mean over pixels and channels of the variance of the mean; NaN: unknown */
    double seconds;       /* wall; 0 for an image file */
};

/* One render. Run i of a cell is timed if i < plan->runs and measured if i < plan->seeds. */
struct mcr_study_run {
    uint64_t seed;
    double wall_seconds, cpu_seconds; /* of the render alone */
    double build_seconds, write_seconds;
    uint64_t samples, rays;
    uint64_t not_finite;
    double metric[MCR_METRIC_COUNT];  /* of all channels, against the reference; NaN: not asked for, or undefined */
    uint64_t order;                   /* place among all runs of the study, from 0: shows the interleaving */
};

struct mcr_study_cell {
    struct mcr_study_settings settings;
    uint32_t contestant;  /* index in study->contestant */
    uint32_t group;       /* cells with the same number are compared: numbered by depth (as above) and spp */
    uint32_t series;      /* cells of one contestant and depth */
    uint32_t reference;   /* index in study->reference */
    uint64_t key;         /* of everything that decides what its runs are: names it in the journal and in files */
    uint32_t run_count;   /* finished ones, the first of the cell's */
    struct mcr_study_run *run;
    struct mcr_coverage coverage;
    /* Over the run_count images x_i against the reference r, sums over pixels p and colour channels (values N): what the bias test needs. */
    double bias_square;       /* estimate of the mean of (E x - r)^2 by products of different seeds, the reference's noise taken off; NaN below 2 runs */
    double bias_square_error; /* its standard error, from the spread over pixels */
    const char *image;        /* file of the first run's image, relative to the output folder, or NULL */
};

/* What was rendered at (about) the time of the slowest contestant for the pictures at equal time; one a contestant. */
struct mcr_study_equal_time {
    uint32_t contestant;
    uint32_t spp;
    double wall_seconds;
    double metric[MCR_METRIC_COUNT];
    const char *image;
};

struct mcr_study {
    const struct mcr_study_plan *plan;
    const char *scene_path;
    uint64_t scene_hash;
    uint32_t width, height;
    uint32_t cell_count;
    struct mcr_study_cell *cell;
    uint32_t contestant_count, group_count, series_count;
    const char **contestant; /* labels: the sampler's expression and what else differs in this study, e.g. "cosine, bvh, roulette off" */
    uint32_t reference_count;
    struct mcr_study_reference *reference;
    uint32_t equal_time_count;
    struct mcr_study_equal_time *equal_time; /* all at one depth, the greatest */
    uint32_t equal_time_depth;
    double equal_time_seconds;               /* aimed at */
    /* To repeat it: */
    const char *version, *machine, *processor, *instruction_set, *started, *command; /* text; started in UTC, ISO 8601; command as words of a shell */
    uint32_t threads;
};

#endif
