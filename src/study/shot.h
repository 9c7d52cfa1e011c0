/* SPDX-License-Identifier: Apache-2.0 */
/* One render of a study: the scene built anew in memory of its own, rendered, and its mean as an image. */
#ifndef MCR_STUDY_SHOT_H
#define MCR_STUDY_SHOT_H

#include "study/run.h"

struct mcr_shot_settings {
    const char *sampler;
    uint32_t spp, depth, accel, compat;
    int roulette, has_roulette; /* without has_roulette: as the scene has it */
    uint64_t seed;
};

struct mcr_shot {
    struct mcr_image *image; /* R, G, B of the crop; the caller's, NULL where stopped */
    struct mcr_render_stats stats;
    double build_seconds;
};

/* Zeroed `shot` in. 0, 1 when it was stopped (nothing is kept), -1 with the reason. End with mcr_shot_fini. */
int mcr_shot_render(const struct mcr_study_setup *setup, const struct mcr_shot_settings *settings, struct mcr_shot *shot, char *error, size_t length);
void mcr_shot_fini(struct mcr_shot *shot);

/* A scene with these settings: what a trial finds. */
struct mcr_trial {
    struct mcr_coverage coverage;
    uint64_t plugins;           /* hash of the names and versions of materials and sampler */
    uint32_t compat;            /* in force */
    struct mcr_film_settings film;
    int roulette;
    uint32_t roulette_from;
};
/* Builds and judges without rendering. Mistakes go to `diagnostics`. Returns 0, or -1 after mistakes. */
int mcr_shot_try(const struct mcr_study_setup *setup, struct mcr_diagnostics *diagnostics, const struct mcr_shot_settings *settings,
                 struct mcr_trial *trial);

#endif
