/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A study at work. Everything that was rendered is kept in the study's folder:
 *
 *   journal.jsonl   a line a finished run (study/journal.h): what makes a study that was interrupted go on
 *   state/          references, and sums over the runs of each cell
 *   images/         the first run of each cell, the references, the renders at equal time
 *
 * The caller writes study.json, study.csv and report.html beside them. Main thread.
 */
#ifndef MCR_STUDY_RUN_H
#define MCR_STUDY_RUN_H

#include <signal.h>

#include "study/plan.h"

/* What is going on. Seconds are of wall time. */
struct mcr_study_progress {
    const char *what;      /* "reference", "run", "equal time" */
    const char *label;     /* the contestant's */
    uint32_t spp, depth;
    uint32_t done, total;  /* finished renders, and all: of what `what` says */
    double seconds, left;  /* since the start of mcr_study_run; left: an estimate, NaN where there is none */
};

struct mcr_study_setup {
    const struct mcr_item *root;             /* the scene's tree */
    struct mcr_diagnostics *diagnostics;     /* mistakes of cells go there */
    struct mcr_registry *registry;
    const struct mcr_scene *scene;           /* of the tree, with scene->study */
    const struct mcr_overrides *overrides;   /* size, crop, threads and batch are in force for every cell */
    const char *scene_name, *command;        /* command: as words of a shell */
    const char *output;                      /* the folder, or NULL: the plan's */
    uint32_t isa;
    const volatile sig_atomic_t *stop;
    void (*progress)(void *data, const struct mcr_study_progress *progress); /* now and then; may be NULL */
    void (*tell)(void *data, const char *message);                          /* something the user should know; a sentence without its end */
    void *data;
    /* Set by mcr_study_prepare: called now and then while a scene is rendered. */
    void (*beat)(void *beat_data, double done, double seconds);
    void *beat_data;
};

struct mcr_study_work;

/*
 * Plans and builds every scene once, so that what is wrong is known before the first render. NULL after a failure: mistakes were recorded in the
 * diagnostics, and what else failed is in `error` ("" if nothing). What the setup points to stays the caller's and stays.
 */
struct mcr_study_work *mcr_study_prepare(const struct mcr_study_setup *setup, char *error, size_t length);
void mcr_study_end(struct mcr_study_work *work);

/*
 * Renders what is missing, measures, journals. Returns 0, 1 when it was stopped, or -1 with the reason in `error`; what is finished is in the study
 * in any case.
 */
int mcr_study_run(struct mcr_study_work *work, char *error, size_t length);
/* The study with what is finished so far. */
const struct mcr_study *mcr_study_of(const struct mcr_study_work *work);

/* What a study would take. Seconds of wall time. */
struct mcr_study_estimate {
    uint32_t finished, renders;    /* runs of the cell */
    double seconds;                /* of one run: measured where some are finished, else from a render with few samples */
    int measured;
};
/*
 * One estimate a cell, and of the references (all of them together, finished counts parts). Reads the folder if it is there, and writes nothing.
 * Returns 0, 1 when it was stopped, or -1 with the reason.
 */
int mcr_study_estimate(struct mcr_study_work *work, struct mcr_study_estimate *cell, struct mcr_study_estimate *reference, char *error, size_t length);

#endif
