/* SPDX-License-Identifier: Apache-2.0 */
#include "study/run.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>

#include "base/cpu.h"
#include "base/random.h"
#include "study/folder.h"
#include "study/work.h"

#define ARENA_LIMIT ((size_t)1 << 30) /* bytes: a hundred thousand runs take 20 MB */

void mcr_study_show(struct mcr_study_work *work)
{
    work->progress.seconds = mcr_wall_seconds() - work->started;
    if (work->setup.progress)
        work->setup.progress(work->setup.data, &work->progress);
}

/* Within a render. */
static void beat(void *data, double done, double seconds)
{
    (void)done, (void)seconds;
    mcr_study_show(data);
}

void mcr_study_tell(struct mcr_study_work *work, const char *format, ...)
{
    char text[600];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (work->setup.tell)
        work->setup.tell(work->setup.data, text);
}

int mcr_study_stopped(const struct mcr_study_work *work)
{
    return work->setup.stop && *work->setup.stop;
}

const struct mcr_study *mcr_study_of(const struct mcr_study_work *work)
{
    return &work->study;
}

/* ---- preparing ---- */

/* What is needed to repeat it. No name of the machine: a report may be passed on. */
static int describe(struct mcr_study_work *work)
{
    struct mcr_study *study = &work->study;
    struct utsname system;
    char machine[200] = "unknown", processor[128];
    if (!uname(&system))
        snprintf(machine, sizeof machine, "%.60s %.60s, %u processors", system.sysname, system.machine, mcr_cpu_count());
    mcr_cpu_model(processor, sizeof processor);
    study->version = PACKAGE_VERSION;
    study->instruction_set = mcr_cpu_isa_name(work->setup.isa);
    study->command = work->setup.command;
    study->scene_path = work->setup.scene_name;
    study->scene_hash = work->setup.scene->hash;
    study->threads = work->setup.scene->render.threads ? work->setup.scene->render.threads : mcr_cpu_count();
    study->machine = mcr_arena_text(work->arena, machine, strlen(machine));
    study->processor = mcr_arena_text(work->arena, processor, strlen(processor));
    study->started = "";
    return study->machine && study->processor ? 0 : -1;
}

static int prepare(struct mcr_study_work *work, char *error, size_t length)
{
    const struct mcr_scene *scene = work->setup.scene;
    work->plan = mcr_study_plan_create(work->arena, work->setup.diagnostics, scene, work->setup.scene_name);
    if (!work->plan)
        return -1;
    if (work->setup.output)
        work->plan->output = work->setup.output;
    work->folder = work->plan->output;
    work->study.plan = work->plan;
    work->content = mcr_study_content(work->setup.root);
    work->roulette_listed = scene->study->roulette.count > 0;
    if (describe(work)) {
        snprintf(error, length, "out of memory");
        return -1;
    }
    return mcr_study_cells(work, error, length);
}

struct mcr_study_work *mcr_study_prepare(const struct mcr_study_setup *setup, char *error, size_t length)
{
    struct mcr_study_work *work = calloc(1, sizeof *work);
    error[0] = '\0';
    if (work)
        work->arena = mcr_arena_create(ARENA_LIMIT);
    if (!work || !work->arena) {
        snprintf(error, length, "out of memory");
        mcr_study_end(work);
        return NULL;
    }
    work->setup = *setup;
    work->setup.beat = setup->progress ? beat : NULL;
    work->setup.beat_data = work;
    work->started = mcr_wall_seconds();
    if (!prepare(work, error, length))
        return work;
    mcr_study_end(work);
    return NULL;
}

void mcr_study_end(struct mcr_study_work *work)
{
    if (!work)
        return;
    for (uint32_t k = 0; work->reference_image && work->reference_variance && k < work->study.reference_count; k++) {
        mcr_image_destroy(work->reference_image[k]);
        mcr_image_destroy(work->reference_variance[k]);
    }
    mcr_journal_close(work->journal);
    mcr_arena_destroy(work->arena);
    free(work);
}

/* ---- the folder ---- */

static void now(char text[32])
{
    time_t seconds = time(NULL);
    struct tm utc;
    if (!gmtime_r(&seconds, &utc) || !strftime(text, 32, "%Y-%m-%dT%H:%M:%SZ", &utc))
        text[0] = '\0';
}

/* Runs that are there, and names of the images that are. */
int mcr_study_take_journal(struct mcr_study_work *work)
{
    struct mcr_study *study = &work->study;
    for (uint32_t i = 0; i < study->cell_count; i++) {
        struct mcr_study_cell *cell = &study->cell[i];
        const char *name = mcr_study_image_name(work, study->contestant[cell->contestant], cell->settings.spp, cell->settings.depth, cell->key);
        if (!name)
            return -1;
        cell->run_count = mcr_journal_runs(work->journal, cell->key, cell->run, mcr_study_rounds(work->plan));
        cell->image = cell->run_count && mcr_folder_has(work->folder, name) ? name : NULL;
    }
    return 0;
}

static int open_folder(struct mcr_study_work *work, char *error, size_t length)
{
    struct mcr_journal_head head = {.scene = work->setup.scene_name, .content = work->content};
    now(head.started);
    if (mcr_folder_make(work->folder, error, length))
        return -1;
    work->journal = mcr_journal_open(work->folder, &head, error, length);
    if (!work->journal || mcr_folder_fill(work->folder, error, length))
        return -1;
    mcr_folder_tidy(work->folder);
    if (mcr_journal_dropped(work->journal))
        mcr_study_tell(work, "%u lines of the journal are torn or damaged and count as not rendered", mcr_journal_dropped(work->journal));
    work->study.started = mcr_arena_text(work->arena, head.started, strlen(head.started));
    if (work->study.started && !mcr_study_take_journal(work))
        return 0;
    snprintf(error, length, "out of memory");
    return -1;
}

/* ---- one run ---- */

/* The image of a cell's first run. */
static int keep_image(struct mcr_study_work *work, struct mcr_study_cell *cell, const struct mcr_shot_settings *settings, const struct mcr_image *image,
                      double *seconds, char *error, size_t length)
{
    const char *name = mcr_study_image_name(work, work->study.contestant[cell->contestant], settings->spp, settings->depth, cell->key);
    double start = mcr_wall_seconds();
    if (!name) {
        snprintf(error, length, "out of memory");
        return -1;
    }
    if (mcr_study_image_write(work, name, image, settings, error, length))
        return -1;
    cell->image = name;
    *seconds = mcr_wall_seconds() - start;
    return 0;
}

/* The next run of a cell. 0, 1 stopped, -1 with the reason. */
static int run_next(struct mcr_study_work *work, struct mcr_study_cell *cell, char *error, size_t length)
{
    uint32_t index = cell->run_count;
    struct mcr_study_run run = {.seed = work->plan->first_seed + index, .order = mcr_journal_count(work->journal)};
    struct mcr_shot_settings settings;
    struct mcr_shot shot = {0};
    int status;
    mcr_study_shot(work, &cell->settings, run.seed, &settings);
    status = mcr_study_measure(work, &settings, cell->reference, &shot, run.metric, error, length);
    if (!status && index == 0)
        status = keep_image(work, cell, &settings, shot.image, &run.write_seconds, error, length);
    if (!status)
        status = mcr_study_sums_add(work, cell, index, shot.image, error, length);
    if (!status) {
        run.wall_seconds = shot.stats.wall_seconds;
        run.cpu_seconds = shot.stats.cpu_seconds;
        run.build_seconds = shot.build_seconds;
        run.samples = shot.stats.samples;
        run.rays = shot.stats.camera_rays + shot.stats.bounce_rays + shot.stats.shadow_rays;
        run.not_finite = shot.stats.not_finite;
        status = mcr_journal_add_run(work->journal, cell->key, index, &run, error, length);
    }
    if (!status)
        cell->run[cell->run_count++] = run;
    mcr_shot_fini(&shot);
    return status;
}

/* ---- the matrix ---- */

/* The cells in an order of its own for each round, the same in every process. */
static void shuffle(uint32_t *order, uint32_t count, uint32_t round)
{
    uint64_t state = mcr_mix64(round + MCR_GOLDEN);
    for (uint32_t i = 0; i < count; i++)
        order[i] = i;
    for (uint32_t i = count; i > 1; i--) {
        uint32_t j = (uint32_t)((state = mcr_mix64(state + MCR_GOLDEN)) % i), kept = order[i - 1];
        order[i - 1] = order[j];
        order[j] = kept;
    }
}

static uint32_t finished_runs(const struct mcr_study_work *work)
{
    uint32_t done = 0;
    for (uint32_t i = 0; i < work->study.cell_count; i++)
        done += work->study.cell[i].run_count;
    return done;
}

static void show_run(struct mcr_study_work *work, const struct mcr_study_cell *cell, uint32_t done)
{
    work->progress = (struct mcr_study_progress){.what = "run", .label = work->study.contestant[cell->contestant], .spp = cell->settings.spp,
                                                 .depth = cell->settings.depth, .done = done, .left = mcr_study_seconds_left(work),
                                                 .total = work->study.cell_count * mcr_study_rounds(work->plan)};
    mcr_study_show(work);
}

/* Round after round over all cells. 0, 1 stopped, -1 with the reason. */
static int run_matrix(struct mcr_study_work *work, char *error, size_t length)
{
    struct mcr_study *study = &work->study;
    uint32_t rounds = mcr_study_rounds(work->plan), done = finished_runs(work), *order = malloc(study->cell_count * sizeof *order);
    int status = order ? 0 : -1;
    if (!order)
        snprintf(error, length, "out of memory");
    if (done < study->cell_count * rounds)
        mcr_study_warm_up(work);
    for (uint32_t round = 0; round < rounds && !status; round++) {
        shuffle(order, study->cell_count, round);
        for (uint32_t i = 0; i < study->cell_count && !status; i++) {
            struct mcr_study_cell *cell = &study->cell[order[i]];
            if (cell->run_count > round)
                continue;
            show_run(work, cell, done++);
            status = mcr_study_stopped(work) ? 1 : run_next(work, cell, error, length);
        }
    }
    free(order);
    return status;
}

/* ---- all ---- */

static int make_references(struct mcr_study_work *work, char *error, size_t length)
{
    int status = 0;
    for (uint32_t k = 0; k < work->study.reference_count && !status; k++) {
        status = mcr_study_reference_make(work, k, error, length);
        if (!status && isnan(work->study.reference[k].noise))
            mcr_study_tell(work, "the noise of the reference is unknown (%s): it is not taken off the errors, and biases cannot be told from it",
                           work->plan->reference_image ? "the file has no variance layers" : "it has one sample a pixel");
    }
    return status;
}

/* The bias figures of what is finished, also of a study that was stopped. */
static void find_biases(struct mcr_study_work *work)
{
    uint32_t lost = 0;
    for (uint32_t i = 0; i < work->study.cell_count; i++) {
        struct mcr_study_cell *cell = &work->study.cell[i];
        if (work->reference_image[cell->reference] && mcr_study_sums_bias(work, cell))
            lost++;
    }
    if (lost)
        mcr_study_tell(work, "the sums for the bias test of %u cells are missing or damaged: their bias is unknown", lost);
}

int mcr_study_run(struct mcr_study_work *work, char *error, size_t length)
{
    int status;
    error[0] = '\0';
    work->started = mcr_wall_seconds();
    if (open_folder(work, error, length))
        return -1;
    status = make_references(work, error, length);
    if (!status)
        status = run_matrix(work, error, length);
    if (!status)
        status = mcr_study_equal_times(work, error, length);
    find_biases(work);
    return status;
}
