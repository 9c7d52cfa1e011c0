/* SPDX-License-Identifier: Apache-2.0 */
/* mcrender SCENE: parse, build, render, write, report. */
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/cpu.h"
#include "cli/commands.h"
#include "cli/report.h"

static volatile sig_atomic_t stop_asked;

/* The first signal lets the running pass end; a second one of the same kind kills. */
static void on_stop(int number)
{
    stop_asked = 1;
    signal(number, SIG_DFL);
}

static void signals(void)
{
    struct sigaction stop = {.sa_handler = on_stop}, ignore = {.sa_handler = SIG_IGN};
    sigaction(SIGINT, &stop, NULL);
    sigaction(SIGTERM, &stop, NULL);
    sigaction(SIGPIPE, &ignore, NULL); /* writing fails with EPIPE */
    sigaction(SIGXFSZ, &ignore, NULL); /* writing fails with EFBIG */
}

static void progress(void *data, double done, double seconds)
{
    (void)data;
    double left = done > 0 ? seconds / done - seconds : 0;
    fprintf(stderr, "\r%5.1f %%  %.0f s, about %.0f s to go \033[K", 100 * done, seconds, left);
}

/* The scene's file name with another ending, in the current folder. */
static char *default_output(const char *scene)
{
    char reason[256];
    const char *ending = mcr_image_module(reason, sizeof reason) ? ".exr" : ".ppm", *base = strrchr(scene, '/');
    base = base ? base + 1 : scene;
    if (!strcmp(scene, "-"))
        base = "scene";
    const char *dot = strrchr(base, '.');
    size_t length = dot && dot != base ? (size_t)(dot - base) : strlen(base);
    char *path = malloc(length + strlen(ending) + 1);
    if (path) {
        memcpy(path, base, length);
        strcpy(path + length, ending);
    }
    return path;
}

static int targets_open(const struct mcr_report_data *data, struct mcr_target **target)
{
    char reason[512];
    for (uint32_t i = 0; i < data->output_count; i++) {
        target[i] = mcr_target_open(data->output[i].path, reason, sizeof reason);
        if (target[i])
            continue;
        fprintf(stderr, "mcrender: error: %s\n", reason);
        return MCR_EXIT_FAILED;
    }
    return MCR_EXIT_DONE;
}

#define ATTRIBUTES 10

/* The film's mean as an image, and what it says of itself. */
static int write_all(struct mcr_report_data *data, struct mcr_target **target)
{
    static const char *const names[] = {"R", "G", "B"};
    const struct mcr_scene *scene = data->loaded->scene;
    char text[ATTRIBUTES][32];
    struct mcr_attribute attribute[ATTRIBUTES] = {
        {"mcrender:version", PACKAGE_VERSION},
        {"mcrender:scene", text[1]},
        {"mcrender:sampler", scene->sampler->expression},
        {"mcrender:spp", text[3]},
        {"mcrender:depth", text[4]},
        {"mcrender:seed", text[5]},
        {"mcrender:precision", "double"},
        {"mcrender:accelerator", mcr_accel_name(data->accel->kind)},
        {"mcrender:coverage", data->coverage.complete ? "complete" : data->coverage.missing},
        {"mcrender:samples", text[9]},
    };
    snprintf(text[1], sizeof text[1], "%016llx", (unsigned long long)scene->hash);
    snprintf(text[3], sizeof text[3], "%u", scene->render.spp);
    snprintf(text[4], sizeof text[4], "%u", scene->render.depth);
    snprintf(text[5], sizeof text[5], "%llu", (unsigned long long)scene->render.seed);
    snprintf(text[9], sizeof text[9], "%llu", (unsigned long long)data->film->samples);
    struct mcr_write_options options = {data->options->bits, data->options->exposure, ATTRIBUTES, attribute};
    struct mcr_image *image = mcr_image_create(data->film->width, data->film->height, 3, names);
    int status = MCR_EXIT_DONE;
    if (!image) {
        fputs("mcrender: error: out of memory\n", stderr);
        return MCR_EXIT_FAILED;
    }
    mcr_film_mean(data->film, image->data);
    for (uint32_t i = 0; i < data->output_count; i++) {
        struct mcr_report_output *output = &data->output[i];
        output->failed = mcr_target_write(target[i], image, &options, &output->result) != 0;
        target[i] = NULL;
        if (output->failed) {
            fprintf(stderr, "mcrender: error: %s\n", output->result.error);
            status = MCR_EXIT_FAILED;
        } else if (output->result.overflowed && data->options->quiet) {
            fprintf(stderr, "mcrender: warning: %s: %llu values beyond the format's range were clipped\n", output->path,
                    (unsigned long long)output->result.overflowed);
        }
    }
    mcr_image_destroy(image);
    return status;
}

static int film_add(void *film, const struct mcr_cell *cell, uint32_t count)
{
    return mcr_film_add(film, cell, count);
}

static void film_end_replicate(void *film)
{
    mcr_film_end_replicate(film);
}

static int report_all(struct mcr_report_data *data)
{
    if (mcr_film_figures(data->film, &data->figures)) {
        fputs("mcrender: error: out of memory\n", stderr);
        return MCR_EXIT_FAILED;
    }
    if (!data->options->quiet)
        mcr_report_text(stderr, data);
    if (data->options->report && mcr_report_json(data->options->report, data)) {
        fprintf(stderr, "mcrender: error: %s: %s\n", data->options->report, strerror(errno));
        return MCR_EXIT_FAILED;
    }
    return MCR_EXIT_DONE;
}

/* Everything between a good scene and the exit status. */
static int render(struct mcr_report_data *data, struct mcr_film *film, struct mcr_target **target)
{
    struct mcr_render_stats stats;
    struct mcr_render_options how = {.isa = data->options->isa, .profile = data->options->profile, .stop = &stop_asked};
    struct mcr_cell_sink sink = {film, film_add, film_end_replicate};
    char reason[512];
    data->stats = &stats;
    mcr_coverage(data->loaded->scene, &data->coverage);
    if (isatty(STDERR_FILENO) && !data->options->quiet)
        how.progress = progress;
    signals();
    int status = mcr_render(data->loaded->scene, data->accel, &how, &sink, &stats, reason, sizeof reason);
    if (how.progress)
        fputs("\r\033[K", stderr);
    if (status) {
        fprintf(stderr, "mcrender: error: %s: %s\n", data->options->scene, reason);
        return MCR_EXIT_FAILED;
    }
    if (!data->coverage.complete && data->options->quiet)
        fprintf(stderr, "mcrender: warning: the sampler's coverage is incomplete: it misses %s\n", data->coverage.missing);
    double start = mcr_wall_seconds();
    int wrote = write_all(data, target);
    data->write_seconds = mcr_wall_seconds() - start;
    int reported = report_all(data);
    if (wrote || reported)
        return MCR_EXIT_FAILED;
    return stats.interrupted ? MCR_EXIT_INTERRUPTED : MCR_EXIT_DONE;
}

int mcr_command_render(struct mcr_options *options)
{
    struct mcr_loaded_scene loaded;
    struct mcr_target *target[MCR_OUTPUTS_MAX] = {NULL};
    struct mcr_report_data data = {.options = options, .loaded = &loaded};
    struct mcr_film *film = NULL;
    char *path = NULL;
    int status = mcr_load(&loaded, options);
    if (!status && !options->output_count) {
        path = default_output(options->scene);
        options->output[0] = path;
        options->output_count = path ? 1 : 0;
    }
    if (!status) {
        const struct mcr_film_settings *settings = &loaded.scene->film;
        for (uint32_t i = 0; i < options->output_count; i++)
            data.output[data.output_count++].path = options->output[i];
        status = targets_open(&data, target);
        double start = mcr_wall_seconds();
        if (!status) {
            data.accel = mcr_accel_create(loaded.arena, loaded.scene, loaded.scene->render.accel);
            data.film = film = mcr_film_create(settings->x1 - settings->x0, settings->y1 - settings->y0, loaded.scene->sampler->correlated);
        }
        data.accel_seconds = mcr_wall_seconds() - start;
        if (!status && (!data.accel || !film)) {
            fputs("mcrender: error: out of memory\n", stderr);
            status = MCR_EXIT_FAILED;
        }
    }
    if (!status)
        status = render(&data, film, target);
    for (uint32_t i = 0; i < MCR_OUTPUTS_MAX; i++)
        mcr_target_cancel(target[i]);
    mcr_film_destroy(film);
    mcr_unload(&loaded);
    free(path);
    return status;
}
