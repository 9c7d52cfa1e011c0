/* SPDX-License-Identifier: Apache-2.0 */
/* Times to come: by runs that are finished, and in a dry run by renders with few samples. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "study/work.h"

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* The median wall time of a cell's runs; NaN without one. */
double mcr_study_median_seconds(const struct mcr_study_cell *cell)
{
    double *seconds = malloc((cell->run_count + 1) * sizeof *seconds), median = (double)NAN;
    uint32_t n = cell->run_count;
    for (uint32_t i = 0; seconds && i < n; i++)
        seconds[i] = cell->run[i].wall_seconds;
    if (seconds && n) {
        qsort(seconds, n, sizeof *seconds, ascending);
        median = (seconds[(n - 1) / 2] + seconds[n / 2]) / 2;
    }
    free(seconds);
    return median;
}

/* Seconds of a run: of the cell itself, or by samples from the cell of its series with the most that has any; NaN where none has. */
static double expected_seconds(const struct mcr_study *study, const struct mcr_study_cell *cell, uint32_t spp_count)
{
    const struct mcr_study_cell *series = cell - (cell - study->cell) % spp_count;
    if (cell->run_count)
        return mcr_study_median_seconds(cell);
    for (uint32_t p = spp_count; p-- > 0;)
        if (series[p].run_count)
            return mcr_study_median_seconds(&series[p]) * cell->settings.spp / series[p].settings.spp;
    return (double)NAN;
}

/* Wall seconds of the runs that are missing: by the time that the work took so far, where nothing is known of a series. */
double mcr_study_seconds_left(const struct mcr_study_work *work)
{
    const struct mcr_study *study = &work->study;
    uint32_t rounds = mcr_study_rounds(work->plan);
    double left = 0, known_samples = 0, known_seconds = 0, unknown_samples = 0;
    for (uint32_t i = 0; i < study->cell_count; i++) {
        const struct mcr_study_cell *cell = &study->cell[i];
        double seconds = expected_seconds(study, cell, work->plan->spp_count), missing = rounds - cell->run_count, spp = cell->settings.spp;
        if (isnan(seconds)) {
            unknown_samples += missing * spp;
        } else {
            left += missing * seconds;
            known_samples += spp;
            known_seconds += seconds;
        }
    }
    if (unknown_samples > 0)
        left += unknown_samples * (known_seconds / known_samples);
    return left;
}

/* ---- a dry run ---- */

#define PILOT_SAMPLES 4u

/* Seconds of a render with these settings by one with few samples. 0, 1 stopped, -1. */
static int pilot(struct mcr_study_work *work, struct mcr_shot_settings *settings, double *seconds, char *error, size_t length)
{
    uint32_t spp = settings->spp;
    struct mcr_shot shot = {0};
    int status;
    settings->spp = spp < PILOT_SAMPLES ? spp : PILOT_SAMPLES;
    status = mcr_shot_render(&work->setup, settings, &shot, error, length);
    *seconds = shot.stats.wall_seconds * spp / settings->spp;
    mcr_shot_fini(&shot);
    return status;
}

static int estimate_references(struct mcr_study_work *work, struct mcr_study_estimate *out, char *error, size_t length)
{
    uint32_t parts = work->plan->reference_image ? 0 : mcr_study_parts(work->plan);
    int status = 0;
    *out = (struct mcr_study_estimate){.renders = parts * work->study.reference_count};
    for (uint32_t k = 0; k < work->study.reference_count && parts && !status; k++) {
        uint32_t finished = mcr_study_reference_parts(work, k);
        double seconds = 0;
        struct mcr_shot_settings settings;
        mcr_study_reference_shot(work, k, 0, &settings);
        out->finished += finished;
        if (finished < parts)
            status = pilot(work, &settings, &seconds, error, length);
        out->seconds += seconds * (parts - finished);
    }
    return status;
}

int mcr_study_estimate(struct mcr_study_work *work, struct mcr_study_estimate *cell, struct mcr_study_estimate *reference, char *error, size_t length)
{
    struct mcr_study *study = &work->study;
    struct mcr_journal_head head = {.scene = work->setup.scene_name, .content = work->content};
    uint32_t spp_count = work->plan->spp_count;
    double per_sample = 0;
    int status;
    work->journal = mcr_journal_look(work->folder, &head, error, length);
    if (!work->journal)
        return -1;
    if (mcr_study_take_journal(work)) {
        snprintf(error, length, "out of memory");
        return -1;
    }
    mcr_study_warm_up(work);
    status = estimate_references(work, reference, error, length);
    for (uint32_t i = 0; i < study->cell_count && !status; i++) {
        const struct mcr_study_cell *of = &study->cell[i];
        double seconds = expected_seconds(study, of, spp_count);
        cell[i] = (struct mcr_study_estimate){of->run_count, mcr_study_rounds(work->plan), seconds, !isnan(seconds)};
        if (!cell[i].measured && (i % spp_count == 0 || cell[i - 1].measured)) {
            struct mcr_shot_settings settings;
            mcr_study_shot(work, &study->cell[i - i % spp_count + spp_count - 1].settings, work->plan->first_seed, &settings);
            uint32_t spp = settings.spp;
            status = mcr_study_stopped(work) ? 1 : pilot(work, &settings, &seconds, error, length);
            per_sample = seconds / spp;
        }
        if (!cell[i].measured)
            cell[i].seconds = per_sample * of->settings.spp;
    }
    return status;
}
