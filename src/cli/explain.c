/* SPDX-License-Identifier: Apache-2.0 */
/* mcrender explain SCENE: what is assembled for a scene, why, and what it costs, measured by a small render of the scene itself. */
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "base/cpu.h"
#include "cli/commands.h"
#include "cli/explain_report.h"
#include "cli/layers.h"

#define PILOT_SECONDS 0.25 /* of processor time, after a first sample of each of its pixels */
/* Samples lie anywhere in their pixel, so that few pixels see the whole picture, too; where a pixel has few samples, more pixels are needed. */
#define PILOT_PIXELS 256u
#define PILOT_PIXELS_MOST 16384u
#define PILOT_SAMPLES 131072u

static int take_nothing(void *data, const struct mcr_cell *cell, uint32_t count)
{
    (void)data, (void)cell, (void)count;
    return 0;
}

static int take_no_channels(void *data, const struct mcr_cell *cell, const struct mcr_cell_channels *channels, uint32_t count)
{
    (void)data, (void)cell, (void)channels, (void)count;
    return 0;
}

static int take_no_features(void *data, const struct mcr_cell_features *features, uint32_t count)
{
    (void)data, (void)features, (void)count;
    return 0;
}

static uint32_t at_least_one(double number)
{
    return number >= 1 ? (uint32_t)number : 1;
}

/* The same view, with few pixels; the crop's edges go to the nearest ones. */
static void shrink(struct mcr_film_settings *film, uint32_t planned)
{
    double wanted = fmin(fmax(PILOT_PIXELS, PILOT_SAMPLES / planned), PILOT_PIXELS_MOST);
    double by = sqrt(wanted / ((double)(film->x1 - film->x0) * (film->y1 - film->y0)));
    if (by >= 1)
        return;
    film->width = at_least_one(film->width * by + 0.5);
    film->height = at_least_one(film->height * by + 0.5);
    film->x0 = (uint32_t)(film->x0 * by);
    film->y0 = (uint32_t)(film->y0 * by);
    film->x1 = at_least_one(film->x1 * by + 0.5);
    film->y1 = at_least_one(film->y1 * by + 0.5);
    film->x1 = film->x1 > film->width ? film->width : film->x1;
    film->y1 = film->y1 > film->height ? film->height : film->y1;
    film->x0 = film->x0 < film->x1 ? film->x0 : film->x1 - 1;
    film->y0 = film->y0 < film->y1 ? film->y0 : film->y1 - 1;
}

/* Renders for a while, on one thread, and throws the samples away. Returns an exit status. */
static int run_pilot(struct mcr_explain_data *data, uint32_t features, int channels)
{
    struct mcr_scene scene = *data->loaded->scene;
    struct mcr_render_options how = {.isa = data->options->isa, .profile = 1, .features = features, .pilot = PILOT_SECONDS};
    struct mcr_cell_sink sink = {.add = take_nothing, .add_channels = channels ? take_no_channels : NULL, .add_features = take_no_features};
    char reason[512];
    shrink(&scene.film, scene.render.spp / scene.render.replicates);
    data->pilot_width = scene.film.x1 - scene.film.x0;
    data->pilot_height = scene.film.y1 - scene.film.y0;
    scene.render.threads = 1;
    if (!mcr_render(&scene, data->accel, &how, &sink, &data->pilot, reason, sizeof reason))
        return MCR_EXIT_DONE;
    fprintf(stderr, "mcrender: error: %s: %s\n", data->options->scene, reason);
    return MCR_EXIT_FAILED;
}

/* What the render takes beside what the pilot's process has held. */
static void estimate_memory(struct mcr_explain_data *data, uint32_t features)
{
    const struct mcr_scene *scene = data->loaded->scene;
    const struct mcr_render_settings *render = &scene->render;
    const uint64_t pixels = (uint64_t)(scene->film.x1 - scene->film.x0) * (scene->film.y1 - scene->film.y0);
    const uint32_t planned = (render->spp + render->replicates - 1) / render->replicates;
    const int correlated = scene->sampler->correlated;
    uint64_t layers = pixels * mcr_features_bytes(features, mcr_render_in_rounds(render));
    uint64_t plain = mcr_film_bytes(pixels, correlated, 0, planned, render->replicates);
    plain += mcr_render_in_rounds(render) ? mcr_film_pixel_bytes(pixels, correlated) : 0;
    data->variance_bytes = data->options->variance_layer ? mcr_film_bytes(pixels, correlated, 1, planned, render->replicates) - plain : 0;
    /* the cells of a pass are among the features' bytes a pixel */
    data->film_bytes = plain + data->variance_bytes + (features ? layers - pixels * sizeof(struct mcr_cell_features) : 0);
    data->picture_bytes = 2 * 3 * sizeof(double) * pixels; /* the means, and the image that is written */
    data->measured = mcr_peak_memory();
    /* When the picture is made, batches and cells are gone. */
    uint64_t passes = data->threads * data->core.batch_bytes + data->core.pass_bytes;
    uint64_t pilot = data->measured > data->core.batch_bytes ? data->measured - data->core.batch_bytes : 0;
    data->total = pilot + data->film_bytes + (passes > data->picture_bytes ? passes : data->picture_bytes);
}

static int explain(struct mcr_explain_data *data)
{
    const struct mcr_scene *scene = data->loaded->scene;
    const uint32_t features = mcr_layers_features(data->options->layers);
    const int channels = data->options->variance_layer && !scene->sampler->correlated;
    const struct mcr_render_options how = {.isa = data->options->isa, .features = features};
    double start = mcr_wall_seconds();
    data->scene_bytes = mcr_arena_used(data->loaded->arena);
    data->accel = mcr_accel_create(data->loaded->arena, scene, scene->render.accel);
    data->accel_bytes = mcr_arena_used(data->loaded->arena) - data->scene_bytes;
    data->prepare_seconds = data->loaded->parse_seconds + data->loaded->build_seconds + mcr_wall_seconds() - start;
    if (!data->accel || mcr_explain(scene, data->accel, &how, channels, &data->core)) {
        fputs("mcrender: error: out of memory\n", stderr);
        return MCR_EXIT_FAILED;
    }
    mcr_coverage(scene, &data->coverage);
    data->threads = scene->render.threads ? scene->render.threads : mcr_cpu_count();
    int status = run_pilot(data, features, channels);
    if (!status)
        estimate_memory(data, features);
    return status;
}

static int open_report(const struct mcr_loaded_scene *loaded, const struct mcr_options *options, struct mcr_target **target)
{
    const char *input = mcr_input_of(loaded, options, options->report);
    char reason[512];
    if (input) {
        fprintf(stderr, "mcrender: error: '%s' %s\n", options->report, input);
        return MCR_EXIT_USAGE;
    }
    *target = mcr_target_open_text(options->report, reason, sizeof reason);
    if (*target)
        return MCR_EXIT_DONE;
    fprintf(stderr, "mcrender: error: %s\n", reason);
    return MCR_EXIT_FAILED;
}

int mcr_command_explain(struct mcr_options *options)
{
    struct mcr_loaded_scene loaded;
    struct mcr_explain_data data = {.options = options, .loaded = &loaded};
    struct mcr_target *target = NULL;
    char reason[512];
    int status = mcr_load(&loaded, options);
    if (!status && options->report)
        status = open_report(&loaded, options, &target);
    if (!status)
        status = explain(&data);
    if (!status && !options->quiet && !(options->report && !strcmp(options->report, "-")))
        mcr_explain_text(stdout, &data);
    if (!status && target) {
        if (mcr_explain_json(target, &data, reason, sizeof reason)) {
            fprintf(stderr, "mcrender: error: %s\n", reason);
            status = MCR_EXIT_FAILED;
        }
        target = NULL;
    }
    mcr_target_cancel(target);
    mcr_unload(&loaded);
    return status;
}
