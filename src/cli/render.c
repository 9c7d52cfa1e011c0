/* SPDX-License-Identifier: Apache-2.0 */
/* mcrender SCENE: parse, build, render, write, report. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/cpu.h"
#include "cli/commands.h"
#include "cli/layers.h"
#include "cli/map.h"
#include "cli/report.h"
#include "cli/stop.h"
#include "image/format.h"

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

/* Where everything goes: the images in the order of data->output, and behind them the report and the sample map. */
struct targets {
    struct mcr_target *target[MCR_OUTPUTS_MAX + 2];
    const char *path[MCR_OUTPUTS_MAX + 2];
    uint32_t count;
    uint32_t map; /* the place of the sample map */
};

static int targets_add(struct targets *targets, const struct mcr_report_data *data, const char *path, int text)
{
    char reason[512];
    const char *input = mcr_input_of(data->loaded, data->options, path);
    if (input) {
        fprintf(stderr, "mcrender: error: '%s' %s\n", path, input);
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
    const struct mcr_film_settings *film = &data->loaded->scene->film;
    int status = MCR_EXIT_DONE;
    for (uint32_t i = 0; i < data->output_count && !status; i++) {
        char reason[512];
        status = targets_add(targets, data, data->output[i].path, 0);
        if (!status && mcr_target_check_size(targets->target[i], film->x1 - film->x0, film->y1 - film->y0, reason, sizeof reason)) {
            fprintf(stderr, "mcrender: error: %s\n", reason);
            status = MCR_EXIT_USAGE;
        }
    }
    if (data->options->report && !status)
        status = targets_add(targets, data, data->options->report, 1);
    targets->map = targets->count;
    if (data->options->sample_map && !status)
        status = targets_add(targets, data, data->options->sample_map, 0);
    return status;
}

#define ATTRIBUTES 16

/* What a file says of its picture. */
struct metadata {
    uint32_t count; /* of those that all files have */
    uint32_t more;  /* behind them, of files with layers */
    char *materials; /* owned; NULL */
    struct mcr_attribute attribute[ATTRIBUTES];
    char hash[20], spp[12], depth[12], seed[24], samples[24], units[12], compat[MCR_COMPAT_TEXT], round[12];
};

/* In the order of their numbers in the layer `id`, with blanks between them. NULL when memory is short. */
static char *material_names(const struct mcr_scene *scene)
{
    size_t length = 1;
    for (uint32_t m = 0; m < scene->material_count; m++)
        length += strlen(scene->material[m].name) + 1;
    char *text = calloc(length, 1), *at = text;
    for (uint32_t m = 0; text && m < scene->material_count; m++)
        at += sprintf(at, "%s%s", m ? " " : "", scene->material[m].name);
    return text;
}

static void describe(struct metadata *meta, const struct mcr_report_data *data)
{
    const struct mcr_scene *scene = data->loaded->scene;
    const struct mcr_render_settings *render = &scene->render;
    const struct mcr_attribute always[] = {
        {"mcrender:version", PACKAGE_VERSION},
        {"mcrender:scene", meta->hash},
        {"mcrender:sampler", scene->sampler->expression},
        {"mcrender:spp", meta->spp},
        {"mcrender:depth", meta->depth},
        {"mcrender:seed", meta->seed},
        {"mcrender:precision", "double"},
        {"mcrender:accelerator", mcr_accel_name(data->accel->kind)},
        {"mcrender:coverage", data->coverage.complete ? "complete" : data->coverage.missing},
        {"mcrender:samples", meta->samples},
    };
    snprintf(meta->hash, sizeof meta->hash, "%016llx", (unsigned long long)scene->hash);
    snprintf(meta->spp, sizeof meta->spp, "%u", render->spp);
    snprintf(meta->depth, sizeof meta->depth, "%u", render->depth);
    snprintf(meta->seed, sizeof meta->seed, "%llu", (unsigned long long)render->seed);
    if (data->sampling) /* the mean over pixels */
        snprintf(meta->samples, sizeof meta->samples, "%.9g", data->sampling->mean);
    else
        snprintf(meta->samples, sizeof meta->samples, "%llu", (unsigned long long)data->film->samples);
    snprintf(meta->round, sizeof meta->round, "%u", render->round);
    snprintf(meta->units, sizeof meta->units, "%u", data->film->units);
    mcr_compat_text(render->compat, meta->compat);
    memcpy(meta->attribute, always, sizeof always);
    meta->count = sizeof always / sizeof *always;
    if (render->compat) {
        meta->attribute[meta->count++] = (struct mcr_attribute){"mcrender:biased", "true"};
        meta->attribute[meta->count++] = (struct mcr_attribute){"mcrender:compat", meta->compat};
    }
    if (data->sampling)
        meta->attribute[meta->count++] = (struct mcr_attribute){"mcrender:round", meta->round};
    meta->more = 0;
    if (data->options->variance_layer && data->film->units > 1)
        meta->attribute[meta->count + meta->more++] = (struct mcr_attribute){"mcrender:units", meta->units};
    meta->materials = data->options->layers & MCR_LAYER_ID ? material_names(scene) : NULL;
    if (meta->materials)
        meta->attribute[meta->count + meta->more++] = (struct mcr_attribute){"mcrender:materials", meta->materials};
}

/* 1 or 0; -1 where the file's format cannot be written at all. */
static int holds_layers(const char *path)
{
    char reason[512];
    const struct mcr_format *format = mcr_format_of_path(path, reason, sizeof reason);
    return format ? (int)format->all_channels : -1;
}

static int write_all(struct mcr_report_data *data, struct targets *targets)
{
    struct metadata meta;
    struct mcr_image *image = mcr_layers_image(data->film, data->features, data->options->layers);
    int status = MCR_EXIT_DONE;
    if (!image) {
        fputs("mcrender: error: out of memory\n", stderr);
        return MCR_EXIT_FAILED;
    }
    describe(&meta, data);
    struct mcr_write_options options = {data->options->bits, data->loaded->scene->film.exposure, meta.count, meta.attribute,
                                        data->loaded->scene->film.tone};
    for (uint32_t i = 0; i < data->output_count; i++) {
        struct mcr_report_output *output = &data->output[i];
        output->layers = image->channels > 3 && holds_layers(output->path) > 0;
        options.attribute_count = meta.count + (output->layers ? meta.more : 0);
        output->failed = mcr_target_write(targets->target[i], image, &options, &output->result) != 0;
        targets->target[i] = NULL;
        if (output->failed) {
            fprintf(stderr, "mcrender: error: %s\n", output->result.error);
            status = MCR_EXIT_FAILED;
        }
    }
    mcr_image_destroy(image);
    free(meta.materials);
    return status;
}

/* The map that was asked for. */
static int write_map(struct mcr_report_data *data, struct targets *targets)
{
    struct metadata meta;
    struct mcr_write_result result;
    struct mcr_target *target = data->options->sample_map ? targets->target[targets->map] : NULL;
    struct mcr_image *image = target ? mcr_map_of_film(data->film) : NULL;
    int status = MCR_EXIT_DONE;
    if (!target)
        return status;
    if (image) {
        describe(&meta, data);
        struct mcr_write_options options = {.attribute_count = meta.count, .attribute = meta.attribute};
        targets->target[targets->map] = NULL;
        status = mcr_target_write(target, image, &options, &result) ? MCR_EXIT_FAILED : MCR_EXIT_DONE;
        free(meta.materials);
    }
    if (!image || status)
        fprintf(stderr, "mcrender: error: %s\n", image ? result.error : "out of memory");
    mcr_image_destroy(image);
    return image ? status : MCR_EXIT_FAILED;
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

/* What is written of a film that has samples. Returns an exit status. */
static int save(struct mcr_report_data *data, struct targets *targets)
{
    double start = mcr_wall_seconds();
    int wrote = write_all(data, targets), mapped = write_map(data, targets);
    data->write_seconds = mcr_wall_seconds() - start;
    int reported = report_all(data, targets);
    if (wrote || mapped || reported)
        return MCR_EXIT_FAILED;
    return data->stats->interrupted ? MCR_EXIT_INTERRUPTED : MCR_EXIT_DONE;
}

/* Everything between open targets and the exit status. sampling: NULL where all pixels get spp samples. */
static int render(struct mcr_report_data *data, struct mcr_film *film, struct mcr_sampling *sampling, struct targets *targets)
{
    struct mcr_render_stats stats;
    struct mcr_sampling_result result;
    struct mcr_director director;
    struct mcr_render_options how = {.isa = data->options->isa, .profile = data->options->profile, .stop = &mcr_stop_asked};
    struct mcr_cell_sink sink = mcr_film_sink(film);
    char reason[512];
    if (data->features) {
        how.features = data->features->asked;
        sink.add_features = mcr_features_add;
        sink.features = data->features;
    }
    data->stats = &stats;
    mcr_coverage(data->loaded->scene, &data->coverage);
    if (isatty(STDERR_FILENO) && !data->options->quiet)
        how.progress = progress;
    if (sampling) {
        director = mcr_sampling_director(sampling);
        how.director = &director;
    }
    mcr_stop_catch();
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
    if (sampling) {
        mcr_sampling_result(sampling, &result);
        data->sampling = &result;
    }
    status = save(data, targets);
    data->sampling = NULL;
    return status;
}

/*
 * Whether the layers that were asked for can be had: some file must hold them, and the samples must tell the variance. What is known before the first ray is
 * told then. Returns an exit status.
 */
static int check_layers(const struct mcr_report_data *data)
{
    const struct mcr_scene *scene = data->loaded->scene;
    const struct mcr_render_settings *render = &scene->render;
    int held = 0;
    if (!data->options->layers)
        return MCR_EXIT_DONE;
    const int rounds = mcr_render_in_rounds(render);
    for (uint32_t i = 0; i < data->output_count; i++)
        held |= holds_layers(data->output[i].path); /* a format that cannot be written is told when the targets are opened */
    if (!held)
        fprintf(stderr, "mcrender: error: --layers: '%s' cannot hold layers, .exr can\n", data->output[0].path);
    else if (!data->options->variance_layer)
        return MCR_EXIT_DONE;
    else if (!rounds && scene->sampler->correlated && render->replicates < 2)
        fputs("mcrender: error: --layers variance: the numbers are correlated, and their variance is known from 2 replicates on (--replicates 2)\n", stderr);
    else if (!rounds && !scene->sampler->correlated && render->spp < 2)
        fputs("mcrender: error: --layers variance: one sample per pixel tells nothing of its variance\n", stderr);
    else
        return MCR_EXIT_DONE;
    return MCR_EXIT_USAGE;
}

/* Whether there will be a sample map, and a file that can hold it. Returns an exit status. */
static int check_map(const struct mcr_report_data *data)
{
    char reason[512] = "every pixel has spp samples: there is a map with --time, --target-error, --adaptive or --use-map";
    if (!data->options->sample_map ||
        (mcr_render_in_rounds(&data->loaded->scene->render) && !mcr_map_check_path(data->options->sample_map, reason, sizeof reason)))
        return MCR_EXIT_DONE;
    fprintf(stderr, "mcrender: error: --sample-map: %s\n", reason);
    return MCR_EXIT_USAGE;
}

/* The map to follow into *map, NULL where there is none. Returns an exit status. */
static int read_map(const struct mcr_report_data *data, uint32_t **map)
{
    const struct mcr_scene *scene = data->loaded->scene;
    const char *path = data->options->use_map;
    char reason[512];
    *map = path ? mcr_map_read(path, scene->film.x1 - scene->film.x0, scene->film.y1 - scene->film.y0, scene->render.round, reason, sizeof reason) : NULL;
    if (!path || *map)
        return MCR_EXIT_DONE;
    fprintf(stderr, "mcrender: error: --use-map: %s\n", reason);
    return MCR_EXIT_FAILED;
}

/* The rules of a render in rounds. NULL when memory is short. */
static struct mcr_sampling *sampling_of(const struct mcr_scene *scene, struct mcr_film *film, struct mcr_features *features, const uint32_t *map)
{
    const struct mcr_render_settings *render = &scene->render;
    struct mcr_sampling_rules rules = {.time = render->time,
                                       .target = render->target_error,
                                       .limit = render->limit,
                                       .round = render->round,
                                       .least = render->least_rounds,
                                       .floor = render->floor,
                                       .adaptive = render->adaptive,
                                       .by_replicate = (scene->sampler->needs & MCR_NEEDS_PIXEL) != 0,
                                       .map = map};
    return mcr_sampling_create(film, features, &rules);
}

/* From open targets to the exit status; map: NULL or the rounds of every pixel. */
static int make_and_render(struct mcr_report_data *data, struct targets *targets, const uint32_t *map)
{
    struct mcr_loaded_scene *loaded = data->loaded;
    const struct mcr_film_settings *film_settings = &loaded->scene->film;
    const struct mcr_render_settings *how = &loaded->scene->render;
    int status;
    double start = mcr_wall_seconds();
    struct mcr_film *film = mcr_film_create(film_settings->x1 - film_settings->x0, film_settings->y1 - film_settings->y0,
                                            loaded->scene->sampler->correlated);
    uint32_t features = mcr_layers_features(data->options->layers);
    data->film = film;
    data->features = film && features ? mcr_features_create(film->pixels, features, mcr_render_in_rounds(how)) : NULL;
    data->accel = mcr_accel_create(loaded->arena, loaded->scene, loaded->scene->render.accel);
    data->accel_seconds = mcr_wall_seconds() - start;
    int ready = data->accel && film && (data->features || !features) && (!data->options->variance_layer || !mcr_film_keep_channels(film));
    struct mcr_sampling *sampling = ready && mcr_render_in_rounds(how) ? sampling_of(loaded->scene, film, data->features, map) : NULL;
    if (ready && (sampling || !mcr_render_in_rounds(how))) {
        status = render(data, film, sampling, targets);
    } else {
        fputs("mcrender: error: out of memory\n", stderr);
        status = MCR_EXIT_FAILED;
    }
    mcr_features_destroy(data->features);
    mcr_sampling_destroy(sampling);
    mcr_film_destroy(film);
    return status;
}

/* From a good scene to the exit status. */
static int prepare_and_render(struct mcr_report_data *data, struct targets *targets)
{
    uint32_t *map = NULL;
    int status = check_layers(data);
    if (!status)
        status = check_map(data);
    if (!status)
        status = read_map(data, &map);
    if (!status)
        status = targets_open(targets, data);
    if (!status)
        status = make_and_render(data, targets, map);
    free(map);
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
