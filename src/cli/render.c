/* SPDX-License-Identifier: Apache-2.0 */
/* mcrender SCENE: parse, build, render, write, report. */
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/cpu.h"
#include "cli/commands.h"
#include "cli/report.h"

static volatile sig_atomic_t stop_asked;

/* The first signal lets the running pass end; a second one kills. */
static void on_stop(int number)
{
    (void)number;
    stop_asked = 1;
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
}

static void signals(void)
{
    static const int stops[] = {SIGINT, SIGTERM};
    struct sigaction stop = {.sa_handler = on_stop, .sa_flags = SA_RESTART}, ignore = {.sa_handler = SIG_IGN}, before;
    for (int i = 0; i < 2; i++)
        if (!sigaction(stops[i], NULL, &before) && before.sa_handler != SIG_IGN) /* as nohup and shells have it for background jobs */
            sigaction(stops[i], &stop, NULL);
    sigaction(SIGPIPE, &ignore, NULL); /* writing fails with EPIPE */
    sigaction(SIGXFSZ, &ignore, NULL); /* writing fails with EFBIG */
}

#define PROGRESS_WIDTH 60 /* columns, enough for what is shown */

static void progress(void *data, double done, double seconds)
{
    char text[PROGRESS_WIDTH + 1];
    (void)data;
    if (done > 0)
        snprintf(text, sizeof text, "%5.1f %%, %.0f s, ETA %.0f s", 100 * done, seconds, seconds / done - seconds);
    else
        snprintf(text, sizeof text, "%5.1f %%, %.0f s", 0.0, seconds);
    fprintf(stderr, "\r%-*s", PROGRESS_WIDTH, text);
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

/* Where everything goes: the images in the order of data->output, and behind them the report. */
struct targets {
    struct mcr_target *target[MCR_OUTPUTS_MAX + 1];
    const char *path[MCR_OUTPUTS_MAX + 1];
    uint32_t count;
};

static int is_file(const char *path, const struct stat *status)
{
    struct stat other;
    return !stat(path, &other) && S_ISREG(other.st_mode) && other.st_dev == status->st_dev && other.st_ino == status->st_ino;
}

static int targets_add(struct targets *targets, const char *path, int text, const struct stat *scene)
{
    char reason[512];
    if (is_file(path, scene)) {
        fprintf(stderr, "mcrender: error: '%s' is the scene\n", path);
        return MCR_EXIT_USAGE;
    }
    struct mcr_target *target = text ? mcr_target_open_text(path, reason, sizeof reason) : mcr_target_open(path, reason, sizeof reason);
    if (!target) {
        fprintf(stderr, "mcrender: error: %s\n", reason);
        return MCR_EXIT_FAILED;
    }
    targets->target[targets->count] = target;
    targets->path[targets->count++] = path;
    for (uint32_t i = 0; i + 1 < targets->count; i++)
        if (mcr_target_same(targets->target[i], target)) {
            fprintf(stderr, "mcrender: error: '%s' and '%s' are the same file\n", targets->path[i], path);
            return MCR_EXIT_USAGE;
        }
    return MCR_EXIT_DONE;
}

/* Before the first ray: whoever waits an hour for a picture wants to be able to keep it. */
static int targets_open(struct targets *targets, const struct mcr_report_data *data)
{
    struct stat scene = {0}; /* of standard input, where the scene is that */
    int status = MCR_EXIT_DONE;
    if (strcmp(data->options->scene, "-") ? stat(data->options->scene, &scene) : fstat(STDIN_FILENO, &scene))
        memset(&scene, 0, sizeof scene); /* gone since it was read */
    for (uint32_t i = 0; i < data->output_count && !status; i++)
        status = targets_add(targets, data->output[i].path, 0, &scene);
    if (data->options->report && !status)
        status = targets_add(targets, data->options->report, 1, &scene);
    return status;
}

#define ATTRIBUTES 10

/* The film's mean as an image, and what it says of itself. */
static int write_all(struct mcr_report_data *data, struct targets *targets)
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
        output->failed = mcr_target_write(targets->target[i], image, &options, &output->result) != 0;
        targets->target[i] = NULL;
        if (output->failed) {
            fprintf(stderr, "mcrender: error: %s\n", output->result.error);
            status = MCR_EXIT_FAILED;
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

static int report_all(struct mcr_report_data *data, struct targets *targets)
{
    char reason[512];
    if (mcr_film_figures(data->film, &data->figures)) {
        fputs("mcrender: error: out of memory\n", stderr);
        return MCR_EXIT_FAILED;
    }
    if (!data->options->quiet)
        mcr_report_text(stderr, data);
    mcr_report_warnings(stderr, data);
    if (!data->options->report)
        return MCR_EXIT_DONE;
    struct mcr_target *target = targets->target[data->output_count];
    targets->target[data->output_count] = NULL;
    if (!mcr_report_json(target, data, reason, sizeof reason))
        return MCR_EXIT_DONE;
    fprintf(stderr, "mcrender: error: %s\n", reason);
    return MCR_EXIT_FAILED;
}

/* Everything between open targets and the exit status. */
static int render(struct mcr_report_data *data, struct mcr_film *film, struct targets *targets)
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
        fprintf(stderr, "\r%*s\r", PROGRESS_WIDTH, "");
    if (status) {
        fprintf(stderr, "mcrender: error: %s: %s\n", data->options->scene, reason);
        return MCR_EXIT_FAILED;
    }
    if (!film->samples) {
        fputs("mcrender: warning: interrupted before the first sample: nothing is written\n", stderr);
        return MCR_EXIT_INTERRUPTED;
    }
    double start = mcr_wall_seconds();
    int wrote = write_all(data, targets);
    data->write_seconds = mcr_wall_seconds() - start;
    int reported = report_all(data, targets);
    if (wrote || reported)
        return MCR_EXIT_FAILED;
    return stats.interrupted ? MCR_EXIT_INTERRUPTED : MCR_EXIT_DONE;
}

/* From a good scene to the exit status. */
static int prepare_and_render(struct mcr_report_data *data, struct targets *targets)
{
    struct mcr_loaded_scene *loaded = data->loaded;
    const struct mcr_film_settings *film_settings = &loaded->scene->film;
    int status = targets_open(targets, data);
    if (status)
        return status;
    double start = mcr_wall_seconds();
    struct mcr_film *film = mcr_film_create(film_settings->x1 - film_settings->x0, film_settings->y1 - film_settings->y0,
                                            loaded->scene->sampler->correlated);
    data->film = film;
    data->accel = mcr_accel_create(loaded->arena, loaded->scene, loaded->scene->render.accel);
    data->accel_seconds = mcr_wall_seconds() - start;
    if (data->accel && film) {
        status = render(data, film, targets);
    } else {
        fputs("mcrender: error: out of memory\n", stderr);
        status = MCR_EXIT_FAILED;
    }
    mcr_film_destroy(film);
    return status;
}

int mcr_command_render(struct mcr_options *options)
{
    struct mcr_loaded_scene loaded;
    struct targets targets = {.count = 0};
    struct mcr_report_data data = {.options = options, .loaded = &loaded};
    char *path = NULL;
    int status = mcr_load(&loaded, options);
    if (!status && !options->output_count) {
        path = default_output(options->scene);
        options->output[0] = path ? path : "";
        options->output_count = 1;
    }
    for (uint32_t i = 0; i < options->output_count; i++) /* failed until written */
        data.output[data.output_count++] = (struct mcr_report_output){.path = options->output[i], .failed = 1};
    if (!status)
        status = prepare_and_render(&data, &targets);
    for (uint32_t i = 0; i < targets.count; i++)
        mcr_target_cancel(targets.target[i]);
    mcr_unload(&loaded);
    free(path);
    return status;
}
