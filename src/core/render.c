/* SPDX-License-Identifier: Apache-2.0 */
/* Rendering: threads, and the order of passes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/cpu.h"
#include "base/random.h"
#include "base/threads.h"
#include "core/assemble.h"
#include "core/pass.h"

const char *const mcr_stage_name[MCR_STAGE_COUNT] = {
    "camera",   "hit",     "crossing", "sort",  "surface", "coordinates", "normals",  "inputs",  "textures", "interiors", "sky", "emission",
    "numbers",  "sampler", "lobes",    "light", "points",  "material",    "roulette", "scatter", "compact",  "layers",    "film"};

struct render {
    struct mcr_core core;
    struct mcr_arena *arena;
    struct mcr_pass pass;
    struct mcr_batch *batch; /* threads */
    uint32_t threads;
    uint64_t samples_before;  /* of earlier passes */
    uint64_t samples_total;
    double start, last_tick;
    double begin, end;        /* directed: the running task's part of all */
    struct mcr_stages directed;
};

static void tick(void *data, const struct mcr_pass *pass)
{
    struct render *render = data;
    const struct mcr_render_options *options = render->core.options;
    double seconds = mcr_wall_seconds() - render->start;
    if (seconds - render->last_tick < 0.1)
        return;
    render->last_tick = seconds;
    uint64_t cells = atomic_load_explicit(&pass->done, memory_order_relaxed);
    double done = (double)(render->samples_before + cells * pass->cell_samples) / (double)render->samples_total;
    if (options->director)
        done = render->begin + (render->end - render->begin) * ((double)cells / (double)pass->cells);
    options->progress(options->progress_data, done, seconds);
}

static void work(void *argument, uint32_t thread)
{
    struct render *render = argument;
    mcr_batch_run(&render->batch[thread], &render->pass, thread);
}

/* Sums what the threads counted in a pass. */
static void collect(struct render *render, struct mcr_render_stats *stats)
{
    const struct mcr_film_settings *film = &render->core.scene->film;
    const struct mcr_pass *pass = &render->pass;
    uint64_t cell = UINT64_MAX, before = stats->not_finite;
    for (uint32_t i = 0; i < render->threads; i++) {
        struct mcr_batch *batch = &render->batch[i];
        stats->camera_rays += batch->camera_rays;
        stats->bounce_rays += batch->bounce_rays;
        stats->shadow_rays += batch->shadow_rays;
        stats->bounce_rays += batch->crossings;
        stats->scatterings += batch->scatterings;
        stats->not_finite += batch->not_finite;
        stats->overfull += batch->overfull;
        for (int s = 0; s < MCR_STAGE_COUNT; s++)
            stats->stage_seconds[s] += batch->stage_seconds[s];
        if (batch->not_finite && batch->not_finite_cell < cell && !before) {
            cell = batch->not_finite_cell;
            const struct mcr_task *task = render->core.task;
            uint64_t pixel = cell % pass->pixels, first = pass->first;
            if (task) {
                first = task->entry[pixel].first;
                pixel = task->entry[pixel].pixel;
            }
            stats->not_finite_x = film->x0 + (uint32_t)(pixel % (film->x1 - film->x0));
            stats->not_finite_y = film->y0 + (uint32_t)(pixel / (film->x1 - film->x0));
            stats->not_finite_sample = first + cell / pass->pixels * pass->cell_samples + batch->not_finite_sample;
        }
        batch->camera_rays = batch->bounce_rays = batch->shadow_rays = batch->crossings = batch->scatterings = batch->not_finite = batch->overfull = 0;
        memset(batch->stage_seconds, 0, sizeof batch->stage_seconds);
    }
}

/* One cell of every pixel goes to the sink. */
static int hand_on(const struct mcr_pass *pass, const struct mcr_cell_sink *sink, uint64_t first, uint32_t count)
{
    int status = pass->channels ? sink->add_channels(sink->data, pass->cell + first, pass->channels + first, count)
                                : sink->add(sink->data, pass->cell + first, count);
    return !status && pass->features ? sink->add_features(sink->features, pass->features + first, count) : status;
}

/* Renders the cells of a pass. Returns 0, or -1 with pass.error set. */
static int run_cells(struct render *render, uint64_t first, uint32_t cell_samples, uint64_t blocks)
{
    struct mcr_pass *pass = &render->pass;
    pass->first = first;
    pass->cell_samples = cell_samples;
    pass->cells = pass->pixels * blocks;
    atomic_store(&pass->next, 0);
    atomic_store(&pass->done, 0);
    mcr_threads_run(render->threads, work, render);
    return atomic_load(&pass->failed) ? -1 : 0;
}

/* Runs one pass of `blocks` cells a pixel and hands them on. Returns 0, or -1 with pass.error set. */
static int run_pass(struct render *render, const struct mcr_cell_sink *sink, uint64_t first, uint32_t cell_samples, uint64_t blocks,
                    struct mcr_render_stats *stats)
{
    struct mcr_pass *pass = &render->pass;
    if (run_cells(render, first, cell_samples, blocks))
        return -1;
    for (uint64_t b = 0; b < blocks; b++)
        if (hand_on(pass, sink, b * pass->pixels, cell_samples)) {
            snprintf(pass->error, sizeof pass->error, "out of memory");
            return -1;
        }
    collect(render, stats);
    stats->passes++;
    stats->samples += pass->cells * cell_samples;
    render->samples_before = stats->samples;
    return 0;
}

/* All passes of one replicate. */
static int run_replicate(struct render *render, const struct mcr_cell_sink *sink, uint32_t replicate, uint32_t planned, struct mcr_render_stats *stats)
{
    const struct mcr_render_options *options = render->core.options;
    struct mcr_pass *pass = &render->pass;
    uint64_t at_once = MCR_TASK_CELLS / pass->pixels ? MCR_TASK_CELLS / pass->pixels : 1;
    pass->replicate_key = mcr_replicate_key(render->core.scene->render.seed, replicate);
    pass->planned = planned;
    for (uint32_t done = 0; done < planned;) {
        if (options->stop && *options->stop) {
            stats->interrupted = 1;
            return 0;
        }
        uint32_t left = planned - done, cell_samples = left < MCR_CELL_SAMPLES ? left : MCR_CELL_SAMPLES;
        uint64_t blocks = left / cell_samples < at_once ? left / cell_samples : at_once;
        if (run_pass(render, sink, done, cell_samples, blocks, stats))
            return -1;
        done += (uint32_t)(blocks * cell_samples);
    }
    if (sink->end_replicate)
        sink->end_replicate(sink->data);
    return 0;
}

static int run_all(struct render *render, const struct mcr_scene *scene, const struct mcr_cell_sink *sink, struct mcr_render_stats *stats)
{
    const struct mcr_render_settings *settings = &scene->render;
    for (uint32_t r = 0; r < settings->replicates && !stats->interrupted; r++) {
        uint32_t planned = settings->spp / settings->replicates + (r < settings->spp % settings->replicates);
        if (run_replicate(render, sink, r, planned, stats))
            return -1;
    }
    return 0;
}

/*
 * As much of the first replicate as its time allows: one sample of each pixel, by which the rest is judged and which does not count then, and more
 * and more of them. The passes are those of a render, so that their times are.
 */
static int run_pilot(struct render *render, const struct mcr_cell_sink *sink, struct mcr_render_stats *stats)
{
    const struct mcr_render_settings *settings = &render->core.scene->render;
    struct mcr_pass *pass = &render->pass;
    const uint64_t at_once = MCR_TASK_CELLS / pass->pixels ? MCR_TASK_CELLS / pass->pixels : 1;
    uint32_t planned = settings->spp / settings->replicates + (settings->spp % settings->replicates != 0), cell_samples = 1;
    uint64_t blocks = 1;
    double start = mcr_cpu_seconds();
    pass->replicate_key = mcr_replicate_key(settings->seed, 0);
    pass->planned = planned;
    for (uint32_t done = 0; done < planned && blocks;) {
        double before = mcr_cpu_seconds();
        if (done == 1) {
            memset(stats, 0, sizeof *stats);
            render->samples_before = 0;
        }
        if (run_pass(render, sink, done, cell_samples, blocks, stats))
            return -1;
        done += (uint32_t)(blocks * cell_samples);
        double now = mcr_cpu_seconds(), of_one = (now - start) / done;
        stats->pass_seconds += now - before;
        double room = fmin((render->core.options->pilot - (now - start)) / of_one, planned - done); /* a coarse clock: planned - done */
        uint32_t more = room >= 1 ? (uint32_t)room : 0;
        cell_samples = more < MCR_CELL_SAMPLES ? more : MCR_CELL_SAMPLES;
        blocks = cell_samples ? more / cell_samples : 0;
        blocks = blocks < at_once ? blocks : at_once;
        blocks = blocks <= done / MCR_CELL_SAMPLES ? blocks : done / MCR_CELL_SAMPLES ? done / MCR_CELL_SAMPLES : blocks > 0;
    }
    return 0;
}

/* One pass for each task, as long as the director has any. */
static int run_directed(struct render *render, const struct mcr_director *director, struct mcr_render_stats *stats)
{
    const struct mcr_render_options *options = render->core.options;
    struct mcr_pass *pass = &render->pass;
    struct mcr_task task = {.incomplete = 0};
    mcr_directed_stages(&render->core, &render->directed);
    render->core.task = &task;
    for (;;) {
        if (options->stop && *options->stop && !task.incomplete) {
            stats->interrupted = 1;
            return 0;
        }
        int more = director->next(director->data, mcr_wall_seconds() - render->start, &task);
        if (!more)
            return 0;
        pass->pixels = task.count;
        pass->planned = task.planned;
        if (more > 0) /* for number sources that look at pixels: their tasks are of one replicate */
            pass->replicate_key = mcr_replicate_key(render->core.scene->render.seed, task.entry[0].replicate);
        render->begin = task.begin;
        render->end = task.end;
        if (more > 0 && run_cells(render, 0, task.cell_samples, task.cells))
            return -1;
        if (more < 0 || director->take(director->data, &task, pass->cell, pass->channels, pass->features)) {
            snprintf(pass->error, sizeof pass->error, "out of memory");
            return -1;
        }
        collect(render, stats);
        stats->passes++;
        stats->samples += pass->cells * task.cell_samples;
    }
}

/* As many as were asked for, but not more than there are jobs to hand out, where it is known how many samples there will be. */
static uint32_t useful_threads(const struct mcr_scene *scene, uint64_t pixels)
{
    const struct mcr_render_settings *render = &scene->render;
    uint32_t threads = render->threads ? render->threads : mcr_cpu_count();
    uint64_t jobs = pixels * render->spp / MCR_JOB_SLOTS + 1;
    return mcr_render_in_rounds(render) || jobs > threads ? threads : (uint32_t)jobs;
}

static int batches_create(struct render *render)
{
    render->batch = calloc(render->threads, sizeof *render->batch);
    if (!render->batch)
        return -1;
    for (uint32_t i = 0; i < render->threads; i++)
        if (mcr_batch_init(&render->batch[i], &render->core))
            return -1;
    return 0;
}

int mcr_render(const struct mcr_scene *scene, const struct mcr_accel *accel, const struct mcr_render_options *options,
               const struct mcr_cell_sink *sink, struct mcr_render_stats *stats, char *error, size_t length)
{
    const struct mcr_film_settings *film = &scene->film;
    struct render render = {.arena = mcr_arena_create(0)};
    struct mcr_pass *pass = &render.pass;
    double cpu = mcr_cpu_seconds();
    int status = -1;
    memset(stats, 0, sizeof *stats);
    render.threads = useful_threads(scene, (uint64_t)(film->x1 - film->x0) * (film->y1 - film->y0));
    render.start = mcr_wall_seconds();
    pass->core = &render.core;
    pass->pixels = (uint64_t)(film->x1 - film->x0) * (film->y1 - film->y0);
    const struct mcr_director *director = options->director;
    const int channels = director ? director->channels : sink->add_channels != NULL;
    uint64_t cells = pass->pixels > MCR_TASK_CELLS && !director ? pass->pixels : MCR_TASK_CELLS;
    pass->cell = calloc(cells, sizeof *pass->cell);
    pass->channels = channels ? calloc(cells, sizeof *pass->channels) : NULL;
    pass->features = options->features ? calloc(cells, sizeof *pass->features) : NULL;
    int short_of_memory = !render.arena || !pass->cell || (channels && !pass->channels) || (options->features && !pass->features);
    pass->tick = options->progress ? tick : NULL;
    pass->tick_data = &render;
    render.samples_total = pass->pixels * scene->render.spp;
    if (short_of_memory || mcr_core_init(&render.core, render.arena, scene, accel, options) || batches_create(&render)) {
        snprintf(error, length, "out of memory");
    } else {
        status = options->pilot > 0 ? run_pilot(&render, sink, stats)
                 : director         ? run_directed(&render, director, stats)
                                    : run_all(&render, scene, sink, stats);
        if (status)
            snprintf(error, length, "%s", pass->error);
    }
    stats->threads = render.threads;
    stats->batch = render.core.capacity;
    for (uint32_t i = 0; render.batch && i < render.threads; i++)
        mcr_batch_fini(&render.batch[i]);
    free(render.batch);
    free(pass->cell);
    free(pass->channels);
    free(pass->features);
    mcr_arena_destroy(render.arena);
    stats->wall_seconds = mcr_wall_seconds() - render.start;
    stats->cpu_seconds = mcr_cpu_seconds() - cpu;
    return status;
}
