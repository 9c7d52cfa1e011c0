/* SPDX-License-Identifier: Apache-2.0 */
/* mcrender compare IMAGE REFERENCE: how far apart two images are, where, and whether they estimate the same thing. */
#include <signal.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/compare_report.h"
#include "image/format.h"

/* What one comparison works on. */
struct work {
    struct mcr_compare_options *options;
    struct mcr_image *image, *reference, *mask;
    struct mcr_target *target[MCR_OUTPUTS_MAX]; /* of the maps */
    struct mcr_bias bias;
    struct mcr_compare_data data;
};

static int fail(int status, const char *reason)
{
    fprintf(stderr, "mcrender: error: %s\n", reason);
    return status;
}

/* Raw values in formats of floating-point numbers, false colours in the others. */
static int is_coloured(const struct mcr_format *format)
{
    return mcr_format_encoding(format, 0) != MCR_ENCODE_FLOAT;
}

/* All maps, before anything is read. */
static int open_maps(struct work *work)
{
    const struct mcr_compare_options *options = work->options;
    char reason[512];
    for (uint32_t i = 0; i < options->map_count; i++) {
        const char *path = options->map[i];
        const struct mcr_format *format = mcr_format_of_path(path, reason, sizeof reason);
        work->data.map[i] = (struct mcr_compare_map){.path = path, .coloured = format && is_coloured(format), .failed = 1};
        if (mcr_target_is_input(path, options->image) || mcr_target_is_input(path, options->reference) || mcr_target_is_input(path, options->mask)) {
            fprintf(stderr, "mcrender: error: the map '%s' is one of the images\n", path);
            return MCR_EXIT_USAGE;
        }
        work->target[i] = mcr_target_open(path, reason, sizeof reason);
        if (!work->target[i])
            return fail(MCR_EXIT_FAILED, reason);
        for (uint32_t k = 0; k < i; k++)
            if (mcr_target_same(work->target[k], work->target[i])) {
                fprintf(stderr, "mcrender: error: '%s' and '%s' are the same file\n", options->map[k], path);
                return MCR_EXIT_USAGE;
            }
    }
    return MCR_EXIT_DONE;
}

static struct mcr_image *read_input(const char *path)
{
    char reason[512];
    struct mcr_image *image = mcr_image_read(strcmp(path, "-") ? path : "/dev/stdin", reason, sizeof reason);
    if (!image)
        fail(MCR_EXIT_FAILED, reason);
    return image;
}

static int read_inputs(struct work *work)
{
    work->image = read_input(work->options->image);
    work->reference = work->image ? read_input(work->options->reference) : NULL;
    if (!work->reference)
        return MCR_EXIT_FAILED;
    if (work->options->mask) {
        work->mask = read_input(work->options->mask);
        work->options->how.mask = work->mask;
    }
    return work->options->mask && !work->mask ? MCR_EXIT_FAILED : MCR_EXIT_DONE;
}

static int measure(struct work *work)
{
    const struct mcr_compare_options *options = work->options;
    struct mcr_compare_data *data = &work->data;
    char reason[512];
    data->options = options;
    data->width = work->image->width;
    data->height = work->image->height;
    if (mcr_metrics_compare(work->image, work->reference, &options->how, MCR_METRICS_ALL, &data->comparison)) {
        uint64_t bad = data->comparison.not_finite[0] + data->comparison.not_finite[1];
        fprintf(stderr, "mcrender: error: '%s' and '%s' cannot be compared: %s%s\n", options->image, options->reference, data->comparison.error,
                bad && !options->how.exclude_not_finite ? " (--exclude-nonfinite leaves such pixels out)" : "");
        return MCR_EXIT_FAILED;
    }
    data->variance_known[0] = mcr_bias_known(work->image);
    data->variance_known[1] = mcr_bias_known(work->reference);
    if (!data->variance_known[0] || !data->variance_known[1])
        return MCR_EXIT_DONE;
    if (mcr_bias_test(work->image, work->reference, &options->how, options->confidence, &work->bias, reason, sizeof reason))
        return fail(MCR_EXIT_FAILED, reason);
    data->bias = &work->bias;
    return MCR_EXIT_DONE;
}

/* What a map's file says of it. */
static int write_map(struct work *work, uint32_t i, const struct mcr_image *image)
{
    char range[32], peak[32];
    struct mcr_compare_map *map = &work->data.map[i];
    const struct mcr_attribute attribute[] = {
        {"mcrender:version", PACKAGE_VERSION},
        {"mcrender:map", mcr_map_kind_name[work->options->map_kind]},
        {"mcrender:encoding", mcr_metrics_encoding_name[work->options->how.encoding]},
        {"mcrender:peak", peak},
        {"mcrender:range", range},
    };
    snprintf(peak, sizeof peak, "%.17g", work->data.comparison.peak);
    snprintf(range, sizeof range, "%.17g", work->data.map_range);
    struct mcr_write_options options = {.attribute_count = map->coloured ? 5 : 4, .attribute = attribute};
    map->failed = mcr_target_write(work->target[i], image, &options, &map->result) != 0;
    work->target[i] = NULL;
    return map->failed ? fail(MCR_EXIT_FAILED, map->result.error) : MCR_EXIT_DONE;
}

static int write_maps(struct work *work)
{
    const struct mcr_compare_options *options = work->options;
    char reason[512] = "out of memory";
    int status = MCR_EXIT_DONE;
    if (!options->map_count)
        return status;
    struct mcr_image *map = mcr_map_create(work->image, work->reference, &options->how, options->map_kind, reason, sizeof reason), *coloured = NULL;
    if (map) {
        double largest = mcr_map_largest(map);
        work->data.map_range = options->map_range > 0 ? options->map_range : largest > 0 ? largest : work->data.comparison.peak;
        coloured = mcr_map_colour(map, options->map_kind, work->data.map_range);
    }
    for (uint32_t i = 0; i < options->map_count && map && coloured; i++) {
        int written = write_map(work, i, work->data.map[i].coloured ? coloured : map);
        status = status ? status : written;
    }
    if (!map || !coloured)
        status = fail(MCR_EXIT_FAILED, reason);
    mcr_image_destroy(map);
    mcr_image_destroy(coloured);
    return status;
}

/* Prints what was found. Returns the exit status as far as the limits go. */
static int tell(const struct work *work)
{
    const struct mcr_compare_options *options = work->options;
    int status = MCR_EXIT_DONE;
    if (options->json) {
        if (mcr_compare_json(stdout, &work->data) && !ferror(stdout)) /* main tells of the stream */
            return fail(MCR_EXIT_FAILED, "out of memory");
    } else if (!options->quiet) {
        mcr_compare_text(stdout, &work->data);
    }
    for (uint32_t i = 0; i < options->limit_count; i++) {
        const struct mcr_compare_limit *limit = &options->limit[i];
        const struct mcr_metrics *whole = &work->data.comparison.whole;
        if (!mcr_compare_exceeds(&work->data, limit))
            continue;
        status = MCR_EXIT_THRESHOLD;
        if (whole->value[limit->metric] == whole->value[limit->metric])
            fprintf(stderr, "mcrender: %s is %.7g, worse than the limit of %g\n", mcr_metric_name[limit->metric], whole->value[limit->metric], limit->value);
        else
            fprintf(stderr, "mcrender: %s has a limit and is %s\n", mcr_metric_name[limit->metric], whole->note[limit->metric]);
    }
    return status;
}

static int compare(struct mcr_compare_options *options)
{
    struct work work = {.options = options};
    signal(SIGXFSZ, SIG_IGN); /* writing fails with EFBIG, */
    if (options->map_count)
        signal(SIGPIPE, SIG_IGN); /* and with EPIPE */
    int status = open_maps(&work);
    if (!status)
        status = read_inputs(&work);
    if (!status)
        status = measure(&work);
    if (!status) {
        int mapped = write_maps(&work), told = tell(&work);
        status = mapped ? mapped : told;
    }
    for (uint32_t i = 0; i < options->map_count; i++)
        mcr_target_cancel(work.target[i]);
    mcr_image_destroy(work.image);
    mcr_image_destroy(work.reference);
    mcr_image_destroy(work.mask);
    return status;
}

int mcr_command_compare(int argc, char **argv)
{
    struct mcr_compare_options options;
    int status = mcr_compare_options_parse(&options, argc, argv);
    if (!status && options.help)
        mcr_compare_options_help(stdout);
    else if (!status && options.version)
        puts("mcrender " PACKAGE_VERSION);
    else if (!status)
        status = compare(&options);
    return status;
}
