/* SPDX-License-Identifier: Apache-2.0 */
/* What the files of a running study share. Private to src/study and its tests. */
#ifndef MCR_STUDY_WORK_H
#define MCR_STUDY_WORK_H

#include "study/journal.h"
#include "study/run.h"
#include "study/shot.h"

struct mcr_study_work {
    struct mcr_study_setup setup;
    struct mcr_arena *arena;
    struct mcr_study study;
    struct mcr_study_plan *plan;
    const char *folder;
    uint64_t content;                 /* of the scene, without what cells set themselves */
    uint64_t *base_key;               /* a contestant and depth's key without spp: series_count */
    uint64_t *reference_key;          /* study.reference_count */
    int roulette_listed;              /* else each cell has what the scene and compat make of it */
    struct mcr_journal *journal;
    struct mcr_image **reference_variance; /* of each value of the reference, or NULL where it is unknown */
    struct mcr_image **reference_image;    /* owned */
    double started;                   /* mcr_wall_seconds */
    struct mcr_study_progress progress;
};

/* FNV-1a 64, mixed. */
uint64_t mcr_study_hash(const void *bytes, size_t count);
/* The scene's tree without the block `study` and without the settings that every cell sets. */
uint64_t mcr_study_content(const struct mcr_item *root);

/* cells.c: the product of the lists, coverage, labels and keys. Returns 0, or -1: after recorded mistakes, or with `error`. */
int mcr_study_cells(struct mcr_study_work *work, char *error, size_t length);
/* What a cell renders with. */
void mcr_study_shot(const struct mcr_study_work *work, const struct mcr_study_settings *settings, uint64_t seed, struct mcr_shot_settings *shot);
void mcr_study_reference_shot(const struct mcr_study_work *work, uint32_t reference, uint32_t part, struct mcr_shot_settings *shot);

/* The key of a cell: of its series with its spp. */
uint64_t mcr_study_spp_key(uint64_t base, uint32_t spp);

/* reference.c: reads the file that is the reference, and sets its key by its content. 0, or -1 with the reason. */
int mcr_study_reference_read(struct mcr_study_work *work, char *error, size_t length);
/* Reads from the folder or renders reference k. 0, 1 stopped, -1 with the reason. */
int mcr_study_reference_make(struct mcr_study_work *work, uint32_t k, char *error, size_t length);
/* How many of its parts are in the folder. */
uint32_t mcr_study_reference_parts(const struct mcr_study_work *work, uint32_t k);

/* sums.c: adds run number `run` of a cell to its sums. 0, or -1 with the reason: the file could not be written. */
int mcr_study_sums_add(struct mcr_study_work *work, const struct mcr_study_cell *cell, uint32_t run, const struct mcr_image *image, char *error,
                       size_t length);
/* bias_square and its error from the sums on disk; NaN where they do not fit the journal. */
int mcr_study_sums_bias(struct mcr_study_work *work, struct mcr_study_cell *cell);


/* images/NAME, relative to the folder, in the arena. NULL when memory is short. */
const char *mcr_study_image_name(struct mcr_study_work *work, const char *label, uint32_t spp, uint32_t depth, uint64_t key);
int mcr_study_image_write(struct mcr_study_work *work, const char *name, const struct mcr_image *image, const struct mcr_shot_settings *settings,
                          char *error, size_t length);

/* measure.c: renders and measures. 0, 1 stopped, -1 with the reason. */
int mcr_study_measure(struct mcr_study_work *work, const struct mcr_shot_settings *settings, uint32_t reference, struct mcr_shot *shot,
                      double metric[MCR_METRIC_COUNT], char *error, size_t length);
/* One render that does not count. */
void mcr_study_warm_up(struct mcr_study_work *work);

/* estimate.c: the median wall time of a cell's runs, NaN without one; and seconds of all runs that are missing. */
double mcr_study_median_seconds(const struct mcr_study_cell *cell);
double mcr_study_seconds_left(const struct mcr_study_work *work);

/* equal_time.c, after the matrix. 0, 1 stopped, -1 with the reason. */
int mcr_study_equal_times(struct mcr_study_work *work, char *error, size_t length);

/* The runs that the journal has, and names of the images that are there. 0, or -1 when memory is short. */
int mcr_study_take_journal(struct mcr_study_work *work);

/* Tells the setup's caller where things are; what, label, spp, depth, done, total and left are set by who calls. */
void mcr_study_show(struct mcr_study_work *work);
void mcr_study_tell(struct mcr_study_work *work, const char *format, ...) __attribute__((format(printf, 2, 3)));
int mcr_study_stopped(const struct mcr_study_work *work);

#endif
