/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/compare_options.h"

#include <string.h>

#include "cli/arguments.h"

const char *const mcr_metrics_encoding_name[2] = {"linear", "srgb8"};

enum option_id { CROP, MASK, ENCODING, PEAK, EXCLUDE, CONFIDENCE, MAP, MAP_KIND, MAP_RANGE, LIMIT, JSON, QUIET, HELP, VERSION };

static const struct option {
    enum option_id id;
    const char *name, *argument, *text;
} table[] = {
    {CROP, "--crop", "X,Y,X,Y", "compare this part only"},
    {MASK, "--mask", "FILE", "compare where this image is not black"},
    {ENCODING, "--encoding", "KIND", "of the values: linear (default), srgb8"},
    {PEAK, "--peak", "VALUE", "white: 1 by default, 255 with srgb8"},
    {EXCLUDE, "--exclude-nonfinite", NULL, "leave out pixels with NaN or infinities"},
    {CONFIDENCE, "--confidence", "P", "of the tests for bias: 0.95 by default"},
    {MAP, "--map", "FILE", "picture of the error; may be repeated"},
    {MAP_KIND, "--map-kind", "KIND", "signed, absolute (default), relative"},
    {MAP_RANGE, "--map-range", "VALUE", "of false colours; by default the largest"},
    {LIMIT, "--fail-above", "METRIC=VALUE", "status 4 if worse; may be repeated"},
    {JSON, "--json", NULL, "the report as JSON"},
    {QUIET, "--quiet", NULL, "no report"},
    {HELP, "--help", NULL, "this text"},
    {VERSION, "--version", NULL, "the version"},
};
#define OPTIONS (sizeof table / sizeof *table)

void mcr_compare_options_help(FILE *to)
{
    fputs("Usage: mcrender compare IMAGE REFERENCE [OPTION]...   - is standard input\n\n", to);
    for (size_t i = 0; i < OPTIONS; i++) {
        char left[32];
        snprintf(left, sizeof left, "%s%s%s", table[i].name, table[i].argument ? " " : "", table[i].argument ? table[i].argument : "");
        fprintf(to, "  %-26s %s\n", left, table[i].text);
    }
    fputs("\nMetrics:", to);
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++)
        fprintf(to, " %s", mcr_metric_name[m]);
    fputs("\nStatus: 0 done, 1 failed, 2 usage, 4 worse than --fail-above.\n", to);
}

static int take_limit(struct mcr_compare_options *options, const char *text)
{
    const char *equals = strchr(text, '=');
    char name[32];
    if (!equals || equals == text || !equals[1])
        return mcr_usage_error("--fail-above expects METRIC=VALUE, not '%s'", text);
    if (options->limit_count == MCR_LIMITS_MAX)
        return mcr_usage_error("--fail-above may be given %u times at most", MCR_LIMITS_MAX);
    struct mcr_compare_limit *limit = &options->limit[options->limit_count++];
    snprintf(name, sizeof name, "%.*s", (int)(equals - text < 31 ? equals - text : 31), text);
    int status = mcr_argument_word("--fail-above", name, mcr_metric_name, MCR_METRIC_COUNT, MCR_METRIC_COUNT, &limit->metric);
    return status ? status : mcr_argument_number("--fail-above", equals + 1, -1e300, 1e300, &limit->value);
}

static int take_map(struct mcr_compare_options *options, const char *text)
{
    if (!strcmp(text, "-"))
        return mcr_usage_error("--map - is not possible: standard output holds the report");
    if (options->map_count == MCR_OUTPUTS_MAX)
        return mcr_usage_error("--map may be given %u times at most", MCR_OUTPUTS_MAX);
    options->map[options->map_count++] = text;
    return 0;
}

static int take(struct mcr_compare_options *options, const struct option *option, const char *text)
{
    switch (option->id) {
    case CROP:
        options->how.has_crop = 1;
        return mcr_argument_crop("--crop", text, options->how.crop);
    case MASK:
        options->mask = text;
        return 0;
    case ENCODING:
        return mcr_argument_word("--encoding", text, mcr_metrics_encoding_name, 2, 2, &options->how.encoding);
    case PEAK:
        return mcr_argument_number("--peak", text, 1e-30, 1e30, &options->how.peak);
    case EXCLUDE:
        options->how.exclude_not_finite = 1;
        return 0;
    case CONFIDENCE:
        return mcr_argument_number("--confidence", text, 0.5, 0.999999, &options->confidence);
    case MAP:
        return take_map(options, text);
    case MAP_KIND:
        return mcr_argument_word("--map-kind", text, mcr_map_kind_name, MCR_MAP_KINDS, MCR_MAP_KINDS, &options->map_kind);
    case MAP_RANGE:
        return mcr_argument_number("--map-range", text, 1e-30, 1e30, &options->map_range);
    case LIMIT:
        return take_limit(options, text);
    case JSON:
        options->json = 1;
        return 0;
    case QUIET:
        options->quiet = 1;
        return 0;
    case HELP:
        options->help = 1;
        return 0;
    default:
        options->version = 1;
        return 0;
    }
}

/* NULL after a message. */
static const struct option *find(const char *argument, size_t length)
{
    int found = mcr_option_find(&table[0].name, sizeof *table, OPTIONS, argument, length, 3);
    if (found == MCR_OPTION_NONE)
        mcr_option_unknown(&table[0].name, sizeof *table, OPTIONS, argument, length, "mcrender compare --help");
    return found < 0 ? NULL : &table[found];
}

static int take_operand(struct mcr_compare_options *options, const char *text)
{
    if (options->reference)
        return mcr_usage_error("two images are expected: '%s' follows '%s'", text, options->reference);
    if (options->image)
        options->reference = text;
    else
        options->image = text;
    return 0;
}

/* Both images, and nothing that contradicts the rest. */
static int check(const struct mcr_compare_options *options)
{
    if (!options->reference)
        return mcr_usage_error("an image and a reference are expected (see mcrender compare --help)");
    int standard_input = !strcmp(options->image, "-") + !strcmp(options->reference, "-") + (options->mask && !strcmp(options->mask, "-"));
    if (standard_input > 1)
        return mcr_usage_error("standard input holds one image only");
    if (!options->map_count && options->map_range > 0)
        return mcr_usage_error("--map-range needs --map");
    return 0;
}

int mcr_compare_options_parse(struct mcr_compare_options *options, int argc, char **argv)
{
    int operands_only = 0, status = 0;
    *options = (struct mcr_compare_options){.confidence = 0.95, .map_kind = MCR_MAP_ABSOLUTE};
    for (int i = 1; i < argc && !status; i++) {
        const char *equals = strchr(argv[i], '='), *value = equals ? equals + 1 : NULL;
        if (operands_only || argv[i][0] != '-' || !argv[i][1]) {
            status = take_operand(options, argv[i]);
            continue;
        }
        if (!strcmp(argv[i], "--")) {
            operands_only = 1;
            continue;
        }
        const struct option *option = strcmp(argv[i], "-h") ? find(argv[i], equals ? (size_t)(equals - argv[i]) : strlen(argv[i])) : find("--help", 6);
        if (!option)
            return MCR_EXIT_USAGE;
        if (!option->argument && value)
            return mcr_usage_error("%s takes no value", option->name);
        if (option->argument && !value && ++i == argc)
            return mcr_usage_error("%s expects %s", option->name, option->argument);
        status = take(options, option, value ? value : option->argument ? argv[i] : NULL);
    }
    return status || options->help || options->version ? status : check(options);
}
