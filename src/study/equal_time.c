/* SPDX-License-Identifier: Apache-2.0 */
/* The pictures at equal time: what each contestant makes of the time that the slowest takes for the most samples. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/folder.h"
#include "study/work.h"

#define EQUAL_TIMES 16u     /* at most so many times the study's most samples */
#define EQUAL_TOLERANCE .05 /* a render of almost the samples that are wanted is not made again */

/* The cell of contestant k at the greatest depth that it has, and the most samples. */
static struct mcr_study_cell *largest_cell(struct mcr_study *study, uint32_t k)
{
    struct mcr_study_cell *found = NULL;
    for (uint32_t i = 0; i < study->cell_count; i++)
        if (study->cell[i].contestant == k)
            found = &study->cell[i]; /* depth and spp ascend */
    return found;
}

static uint32_t samples_for(const struct mcr_study_cell *cell, double seconds)
{
    double spp = cell->settings.spp, most = spp * EQUAL_TIMES, wanted = floor(spp * (seconds / mcr_study_median_seconds(cell)) + .5);
    most = most > INT32_MAX ? INT32_MAX : most;
    return wanted >= most ? (uint32_t)most : wanted >= 1 ? (uint32_t)wanted : 1;
}

static int render_equal(struct mcr_study_work *work, const struct mcr_study_cell *cell, uint32_t spp, struct mcr_journal_equal *equal, char *error,
                        size_t length)
{
    struct mcr_study_settings settings = cell->settings;
    struct mcr_shot_settings shot_settings;
    struct mcr_shot shot = {0};
    const char *name;
    int status;
    settings.spp = spp;
    *equal = (struct mcr_journal_equal){.spp = spp, .key = mcr_study_spp_key(work->base_key[cell->series], spp)};
    mcr_study_shot(work, &settings, work->plan->first_seed, &shot_settings);
    status = mcr_study_measure(work, &shot_settings, cell->reference, &shot, equal->metric, error, length);
    name = mcr_study_image_name(work, work->study.contestant[cell->contestant], spp, settings.depth, equal->key);
    if (!status && name)
        status = mcr_study_image_write(work, name, shot.image, &shot_settings, error, length);
    if (!status) {
        equal->wall_seconds = shot.stats.wall_seconds;
        snprintf(equal->image, sizeof equal->image, "%s", name ? name : "");
        status = mcr_journal_add_equal(work->journal, work->base_key[cell->series], equal, error, length);
    }
    mcr_shot_fini(&shot);
    return status;
}

/* One contestant's. */
static int make_equal(struct mcr_study_work *work, uint32_t k, double seconds, char *error, size_t length)
{
    const struct mcr_study_cell *cell = largest_cell(&work->study, k);
    uint32_t spp = samples_for(cell, seconds);
    const struct mcr_journal_equal *known = mcr_journal_equal(work->journal, work->base_key[cell->series]);
    struct mcr_journal_equal equal;
    struct mcr_study_equal_time *out = &work->study.equal_time[k];
    int status = 0;
    if (spp == cell->settings.spp && cell->image) { /* the slowest: its first run */
        equal = (struct mcr_journal_equal){.spp = spp, .wall_seconds = cell->run[0].wall_seconds};
        memcpy(equal.metric, cell->run[0].metric, sizeof equal.metric);
        snprintf(equal.image, sizeof equal.image, "%s", cell->image);
    } else if (known && fabs((double)known->spp - spp) <= EQUAL_TOLERANCE * spp && mcr_folder_has(work->folder, known->image)) {
        equal = *known;
    } else {
        work->progress = (struct mcr_study_progress){.what = "equal time", .label = work->study.contestant[k], .spp = spp, .depth = cell->settings.depth,
                                                     .done = k, .total = work->study.contestant_count, .left = (double)NAN};
        mcr_study_show(work);
        status = render_equal(work, cell, spp, &equal, error, length);
    }
    if (status)
        return status;
    *out = (struct mcr_study_equal_time){.contestant = k, .spp = equal.spp, .wall_seconds = equal.wall_seconds};
    memcpy(out->metric, equal.metric, sizeof out->metric);
    out->image = mcr_arena_text(work->arena, equal.image, strlen(equal.image));
    work->study.equal_time_count = k + 1;
    return 0;
}

int mcr_study_equal_times(struct mcr_study_work *work, char *error, size_t length)
{
    struct mcr_study *study = &work->study;
    double seconds = 0;
    int status = 0;
    study->equal_time = mcr_arena_alloc(work->arena, study->contestant_count, sizeof *study->equal_time);
    if (!study->equal_time) {
        snprintf(error, length, "out of memory");
        return -1;
    }
    for (uint32_t k = 0; k < study->contestant_count; k++)
        seconds = fmax(seconds, mcr_study_median_seconds(largest_cell(study, k)));
    study->equal_time_seconds = seconds;
    study->equal_time_depth = work->plan->depth[work->plan->depth_count - 1];
    for (uint32_t k = 0; k < study->contestant_count && !status; k++)
        status = mcr_study_stopped(work) ? 1 : make_equal(work, k, seconds, error, length);
    return status;
}
