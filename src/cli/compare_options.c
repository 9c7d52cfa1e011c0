/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/compare_options.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/diag.h"

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

static int usage_error(const char *format, ...) __attribute__((format(printf, 1, 2)));
static int usage_error(const char *format, ...)
{
    va_list arguments;
    fputs("mcrender: error: ", stderr);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputs("\n", stderr);
    return MCR_EXIT_USAGE;
}

/* A finite number in low .. high. */
static int number(const char *option, const char *text, double low, double high, double *out)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || (*text != '-' && *text != '.' && (*text < '0' || *text > '9')) || !(value >= low && value <= high))
        return usage_error("%s expects a number from %g to %g, not '%s'", option, low, high, text);
    *out = value;
    return 0;
}

/* Its place among the words. */
static int word(const char *option, const char *text, const char *const *words, uint32_t count, uint32_t *out)
{
    for (uint32_t i = 0; i < count; i++)
        if (!strcmp(text, words[i])) {
            *out = i;
            return 0;
        }
    const char *near = mcr_nearest_word(text, words, count);
    if (near)
        return usage_error("%s does not know '%s', did you mean '%s'?", option, text, near);
    fprintf(stderr, "mcrender: error: %s does not know '%s', expected", option, text);
    for (uint32_t i = 0; i < count; i++)
        fprintf(stderr, "%s %s", i == 0 ? "" : i + 1 < count ? "," : " or", words[i]);
    fputs("\n", stderr);
    return MCR_EXIT_USAGE;
}

static int take_crop(struct mcr_compare_options *options, const char *text)
{
    const char *at = text;
    for (uint32_t i = 0; i < 4; i++) {
        char *end;
        errno = 0;
        unsigned long value = *at >= '0' && *at <= '9' ? strtoul(at, &end, 10) : (end = NULL, 0);
        if (!end || errno || value > 65536 || *end != (i < 3 ? ',' : '\0'))
            return usage_error("--crop expects X0,Y0,X1,Y1 in pixels, each from 0 to 65536, not '%s'", text);
        options->how.crop[i] = (uint32_t)value;
        at = end + 1;
    }
    if (options->how.crop[0] >= options->how.crop[2] || options->how.crop[1] >= options->how.crop[3])
        return usage_error("--crop %s is empty: X0 < X1 and Y0 < Y1 are expected", text);
    options->how.has_crop = 1;
    return 0;
}

static int take_limit(struct mcr_compare_options *options, const char *text)
{
    const char *equals = strchr(text, '=');
    char name[32];
    if (!equals || equals == text || !equals[1])
        return usage_error("--fail-above expects METRIC=VALUE, not '%s'", text);
    if (options->limit_count == MCR_LIMITS_MAX)
        return usage_error("--fail-above may be given %u times at most", MCR_LIMITS_MAX);
    struct mcr_compare_limit *limit = &options->limit[options->limit_count++];
    snprintf(name, sizeof name, "%.*s", (int)(equals - text < 31 ? equals - text : 31), text);
    int status = word("--fail-above", name, mcr_metric_name, MCR_METRIC_COUNT, &limit->metric);
    return status ? status : number("--fail-above", equals + 1, -1e300, 1e300, &limit->value);
}

static int take_map(struct mcr_compare_options *options, const char *text)
{
    if (!strcmp(text, "-"))
        return usage_error("--map - is not possible: standard output holds the report");
    if (options->map_count == MCR_OUTPUTS_MAX)
        return usage_error("--map may be given %u times at most", MCR_OUTPUTS_MAX);
    options->map[options->map_count++] = text;
    return 0;
}

static int take(struct mcr_compare_options *options, const struct option *option, const char *text)
{
    switch (option->id) {
    case CROP:
        return take_crop(options, text);
    case MASK:
        options->mask = text;
        return 0;
    case ENCODING:
        return word("--encoding", text, mcr_metrics_encoding_name, 2, &options->how.encoding);
    case PEAK:
        return number("--peak", text, 1e-30, 1e30, &options->how.peak);
    case EXCLUDE:
        options->how.exclude_not_finite = 1;
        return 0;
    case CONFIDENCE:
        return number("--confidence", text, 0.5, 0.999999, &options->confidence);
    case MAP:
        return take_map(options, text);
    case MAP_KIND:
        return word("--map-kind", text, mcr_map_kind_name, MCR_MAP_KINDS, &options->map_kind);
    case MAP_RANGE:
        return number("--map-range", text, 1e-30, 1e30, &options->map_range);
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

/* The option of that name, or the one that it abbreviates. NULL after a message. */
static const struct option *find(const char *name, size_t length)
{
    const struct option *found = NULL;
    const char *names[OPTIONS];
    char shown[64];
    uint32_t fits = 0;
    for (size_t i = 0; i < OPTIONS; i++) {
        names[i] = table[i].name;
        if (strncmp(table[i].name, name, length))
            continue;
        if (!table[i].name[length])
            return &table[i];
        found = &table[i];
        fits++;
    }
    if (fits == 1 && length > 2)
        return found;
    snprintf(shown, sizeof shown, "%.*s", (int)(length < sizeof shown ? length : sizeof shown), name);
    const char *near = mcr_nearest_word(shown, names, OPTIONS);
    if (fits > 1 && length > 2)
        usage_error("'%s' may be several options (see mcrender compare --help)", shown);
    else
        usage_error("unknown option '%s'%s%s%s", shown, near ? ", did you mean '" : "", near ? near : "", near ? "'?" : " (see mcrender compare --help)");
    return NULL;
}

static int take_operand(struct mcr_compare_options *options, const char *text)
{
    if (options->reference)
        return usage_error("two images are expected: '%s' follows '%s'", text, options->reference);
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
        return usage_error("an image and a reference are expected (see mcrender compare --help)");
    int standard_input = !strcmp(options->image, "-") + !strcmp(options->reference, "-") + (options->mask && !strcmp(options->mask, "-"));
    if (standard_input > 1)
        return usage_error("standard input holds one image only");
    if (!options->map_count && options->map_range > 0)
        return usage_error("--map-range needs --map");
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
            return usage_error("%s takes no value", option->name);
        if (option->argument && !value && ++i == argc)
            return usage_error("%s expects %s", option->name, option->argument);
        status = take(options, option, value ? value : option->argument ? argv[i] : NULL);
    }
    return status || options->help || options->version ? status : check(options);
}
