/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What a block `study { … }`, or the options that say the same, ask for: read and judged by itself. What is not given stands as 0 or NULL and is
 * decided by src/study, which knows the rest. Lives in the scene's arena.
 */
#ifndef MCR_SCENE_STUDY_H
#define MCR_SCENE_STUDY_H

#include "base/diag.h"
#include "scene/words.h"

/* Values of a list in the order of the text, except that spp and depth are ascending. No value stands in it twice. */
struct mcr_study_list {
    uint32_t count; /* 0: not given */
    uint32_t *value;
};

struct mcr_scene_study {
    struct mcr_place place;                 /* of the block's word; none where options alone ask */
    const char *title, *output;
    uint32_t sampler_count;
    const char **sampler;                   /* in normal form */
    struct mcr_place *sampler_place;
    struct mcr_study_list spp, depth, precision, accel, roulette, compat; /* compat: masks */
    uint32_t seeds, runs;
    int has_seed, has_target, has_size, has_crop, has_reference_depth, has_reference_seed;
    uint64_t seed;
    const char *baseline;                   /* in normal form */
    struct mcr_place baseline_place;
    double confidence, target;              /* 0: not given */
    uint32_t metrics;                       /* bits in the order of MCR_METRIC_WORDS */
    uint32_t encoding;                      /* 0 linear, 1 srgb8 */
    double peak;
    uint32_t size[2], crop[4];
    const char *reference_sampler, *reference_image; /* image: the path to open */
    struct mcr_place reference_place, reference_seed_place;
    uint32_t reference_spp, reference_depth;
    uint64_t reference_seed;
};

/* What the command line says over the block: lists and values as text in the scene's syntax, texts (title, output, image) as they are. NULL: nothing. */
struct mcr_study_texts {
    int passed_over; /* the block is not looked at: what a study's own scenes are built with */
    const char *setting[STUDY_COUNT], *reference[REFERENCE_COUNT];
};

#endif
