/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options.h"

#include <stdlib.h>
#include <string.h>

#include "base/cpu.h"
#include "cli/arguments.h"
#include "cli/layers.h"

enum option_id {
    OUTPUT, SPP, DEPTH, SEED, THREADS, SAMPLER, SIZE, CROP, PRECISION, ACCEL, ISA, BATCH, REPLICATES, ROULETTE, COMPAT, TIME, TARGET_ERROR,
    ADAPTIVE, ROUND, SAMPLE_MAP, USE_MAP, SET, PLUGIN, LAYERS, REPORT, PROFILE, BITS, EXPOSURE, TONE, QUIET, WERROR, HELP, VERSION
};

/* Where an option may stand. */
enum { RENDER = 1, CHECK = 2, PLUGINS = 4, STUDY = 8, EXPLAIN = 16, ALL = 31 };

static const struct option {
    enum option_id id;
    int where;
    const char *name, *argument, *text;
} table[] = { /* in the order of option_id */
    {OUTPUT, RENDER | STUDY, "-o", "FILE", "image; '-': stdout"},
    {SPP, RENDER | CHECK | EXPLAIN, "--spp", "N", "samples per pixel"},
    {DEPTH, RENDER | CHECK | EXPLAIN, "--depth", "N", "scatterings at most"},
    {SEED, RENDER | CHECK | EXPLAIN, "--seed", "N", "of all randomness"},
    {THREADS, RENDER | CHECK | EXPLAIN | STUDY, "--threads", "N", "0: all processors"},
    {SAMPLER, RENDER | CHECK | EXPLAIN, "--sampler", "EXPR", "draws directions"},
    {SIZE, RENDER | CHECK | EXPLAIN | STUDY, "--size", "WxH", "of the picture"},
    {CROP, RENDER | CHECK | EXPLAIN | STUDY, "--crop", "X,Y,X,Y", "part of the picture"},
    {PRECISION, RENDER | CHECK | EXPLAIN, "--precision", "KIND", "double"},
    {ACCEL, RENDER | CHECK | EXPLAIN, "--accel", "KIND", "auto, list, bvh"},
    {ISA, RENDER | CHECK | EXPLAIN | PLUGINS | STUDY, "--isa", "NAME", "instruction set"},
    {BATCH, RENDER | CHECK | EXPLAIN | STUDY, "--batch", "N", "paths at once"},
    {REPLICATES, RENDER | CHECK | EXPLAIN, "--replicates", "N", "for the error"},
    {ROULETTE, RENDER | CHECK | EXPLAIN, "--roulette", "WORD", "on, off, on(from=N)"},
    {COMPAT, RENDER | CHECK | EXPLAIN, "--compat", "LIST", "known mistakes"},
    {TIME, RENDER | CHECK | EXPLAIN, "--time", "SECONDS", "ends after so long"},
    {TARGET_ERROR, RENDER | CHECK | EXPLAIN, "--target-error", "E", "ends when below"},
    {ADAPTIVE, RENDER | CHECK | EXPLAIN, "--adaptive", NULL, "more where noisy"},
    {ROUND, RENDER | CHECK | EXPLAIN, "--round", "N", "samples at once"},
    {SAMPLE_MAP, RENDER, "--sample-map", "FILE", "samples of pixels"},
    {USE_MAP, RENDER, "--use-map", "FILE", "the same again"},
    {SET, RENDER | CHECK | EXPLAIN | STUDY, "--set", "NAME=VALUE", "replaces a `let`"},
    {PLUGIN, ALL, "--plugin", "FILE", "before all others"},
    {LAYERS, RENDER | EXPLAIN, "--layers", "LIST", "more, in EXR"},
    {REPORT, RENDER | EXPLAIN, "--report", "FILE", "figures as JSON"},
    {PROFILE, RENDER, "--profile", NULL, "time of each stage"},
    {BITS, RENDER, "--bits", "8|16", "of PPM, PNG, TIFF"},
    {EXPOSURE, RENDER, "--exposure", "STOPS", "of PPM, PNG, JPEG"},
    {TONE, RENDER, "--tone", "CURVE", "of PPM, PNG, JPEG"},
    {QUIET, RENDER | CHECK | EXPLAIN | STUDY, "--quiet", NULL, "errors and warnings"},
    {WERROR, RENDER | CHECK | EXPLAIN | STUDY, "--werror", NULL, "warnings are errors"},
    {HELP, ALL, "--help", NULL, "this text"},
    {VERSION, ALL, "--version", NULL, "the version"},
};
#define OPTIONS (sizeof table / sizeof *table)

/* In two columns, one below the other: 80 characters and 32 lines are all there is. */
void mcr_options_help(FILE *to)
{
    const size_t rows = (OPTIONS + 1) / 2;
    fputs("Usage: mcrender SCENE [-o FILE]... [OPTION]...   render; - is standard input\n"
          "       mcrender check SCENE [OPTION]...          parse and build only\n"
          "       mcrender explain SCENE [OPTION]...        what it takes and costs\n"
          "       mcrender study SCENE [OPTION]...          compare samplers; study --help\n"
          "       mcrender compare IMAGE REFERENCE          their distance; compare --help\n"
          "       mcrender plugins [NAME]                   list plugins, or explain one\n\n",
          to);
    for (size_t row = 0; row < rows; row++) {
        for (size_t i = row; i < OPTIONS; i += rows) {
            char left[24];
            snprintf(left, sizeof left, "%s%s%s", table[i].name, table[i].argument ? " " : "", table[i].argument ? table[i].argument : "");
            fprintf(to, i + rows < OPTIONS ? "  %-17s %-20s" : "  %-17s %s", left, table[i].text);
        }
        fputs("\n", to);
    }
    fputs("\nFILE's ending tells its format: ppm (or none), pfm, exr, png, jpg, tiff, hdr.\n"
          "Options replace what the scene says; --threads, --isa, --batch, --accel no bit.\n"
          "Status: 0 done, 1 failed, 2 usage, 3 scene error, 130 interrupted after saving.\n",
          to);
}

static int whole32(const char *option, const char *text, uint32_t lo, uint32_t hi, uint32_t *out, int *has)
{
    uint64_t value;
    int status = mcr_argument_whole(option, text, lo, hi, &value);
    if (!status) {
        *out = (uint32_t)value;
        *has = 1;
    }
    return status;
}

static int take_isa(struct mcr_options *options, const char *text)
{
    int32_t isa = mcr_cpu_isa_parse(text);
    if (isa < 0)
        return mcr_usage_error("--isa expects baseline, avx2 or avx512, not '%s'", text);
    if ((uint32_t)isa > mcr_cpu_isa())
        return mcr_usage_error("--isa %s: this processor or build has %s at most", text, mcr_cpu_isa_name(mcr_cpu_isa()));
    options->isa = (uint32_t)isa;
    return 0;
}

static int take_set(struct mcr_options *options, const char *text)
{
    const char *equals = strchr(text, '=');
    if (!equals || equals == text || !equals[1])
        return mcr_usage_error("--set expects NAME=VALUE, not '%s'", text);
    if (options->definition_count == MCR_DEFINITIONS_MAX)
        return mcr_usage_error("--set may be given %u times at most", MCR_DEFINITIONS_MAX);
    char *copy = strdup(text);
    if (!copy)
        return mcr_usage_error("out of memory");
    copy[equals - text] = '\0';
    for (uint32_t i = 0; i < options->definition_count; i++)
        if (!strcmp(options->definition[i].name, copy)) {
            free(copy);
            return mcr_usage_error("--set %.*s is given twice", (int)(equals - text), text);
        }
    options->definition_text[options->definition_count] = copy;
    options->definition[options->definition_count++] = (struct mcr_definition){.name = copy, .text = copy + (equals - text) + 1};
    return 0;
}

static int take_exposure(struct mcr_options *options, const char *text)
{
    char *end;
    options->overrides.has_exposure = 1;
    options->overrides.exposure = strtod(text, &end);
    if (end == text || *end || !(options->overrides.exposure >= -64 && options->overrides.exposure <= 64))
        return mcr_usage_error("--exposure expects a number of stops from -64 to 64, not '%s'", text);
    return 0;
}

/* on, off or on(from=N), as in scenes. */
static int take_roulette(struct mcr_overrides *o, const char *text)
{
    static const char before[] = "on(from=", form[] = "on, off or on(from=N)";
    char digits[16];
    size_t length = strlen(text), head = sizeof before - 1;
    o->has_roulette = 1;
    o->roulette = strcmp(text, "off") != 0;
    o->has_roulette_from = 0;
    if (!o->roulette || !strcmp(text, "on"))
        return 0;
    if (strncmp(text, before, head) || text[length - 1] != ')' || length - head > sizeof digits)
        return mcr_usage_error("--roulette expects %s, not '%s'", form, text);
    snprintf(digits, sizeof digits, "%.*s", (int)(length - head - 1), text + head);
    return whole32("--roulette on(from=N)", digits, 0, INT32_MAX - 1, &o->roulette_from, &o->has_roulette_from);
}

/* Alone, or on, off or on(floor=N) behind a =, as in scenes. */
static int take_adaptive(struct mcr_overrides *o, const char *text)
{
    static const char before[] = "on(floor=";
    char digits[16];
    size_t length = text ? strlen(text) : 0, head = sizeof before - 1;
    o->has_adaptive = 1;
    o->adaptive = !text || strcmp(text, "off") != 0;
    o->has_floor = 0;
    if (!o->adaptive || !text || !strcmp(text, "on"))
        return 0;
    if (strncmp(text, before, head) || text[length - 1] != ')' || length - head > sizeof digits)
        return mcr_usage_error("--adaptive stands alone, or with =on, =off or =on(floor=N), not '%s'", text);
    snprintf(digits, sizeof digits, "%.*s", (int)(length - head - 1), text + head);
    return whole32("--adaptive=on(floor=N)", digits, 1, 1048576, &o->floor, &o->has_floor);
}

/* What a map fixes is not to be said again. */
static int check_map(const struct mcr_options *options)
{
    const struct mcr_overrides *o = &options->overrides;
    const char *other = o->has_spp ? "--spp" : o->has_time ? "--time" : o->has_target_error ? "--target-error" : o->has_adaptive ? "--adaptive" : NULL;
    if (options->use_map && other)
        return mcr_usage_error("--use-map says how many samples each pixel has: %s does not go with it", other);
    return 0;
}

static int take_compat(struct mcr_overrides *o, const char *text)
{
    char reason[256];
    if (mcr_compat_parse(text, &o->compat, reason, sizeof reason))
        return mcr_usage_error("--compat %s", reason);
    o->has_compat = 1;
    return 0;
}

static int take(struct mcr_options *options, const struct option *option, const char *text)
{
    static const char *const precisions[] = {"double", "single"}, *const accels[] = {"auto", "list", "bvh", "embree"};
    struct mcr_overrides *o = &options->overrides;
    uint32_t chosen;
    switch (option->id) {
    case OUTPUT:
        if (options->output_count == MCR_OUTPUTS_MAX)
            return mcr_usage_error("-o may be given %u times at most", MCR_OUTPUTS_MAX);
        options->output[options->output_count++] = text;
        return 0;
    case SPP:
        return whole32("--spp", text, 1, INT32_MAX, &o->spp, &o->has_spp);
    case DEPTH:
        return whole32("--depth", text, 0, INT32_MAX - 1, &o->depth, &o->has_depth);
    case SEED:
        o->has_seed = 1;
        return mcr_argument_whole("--seed", text, 0, UINT64_C(1) << 53, &o->seed);
    case THREADS:
        return whole32("--threads", text, 0, 1024, &o->threads, &o->has_threads);
    case SAMPLER:
        o->sampler = text;
        return 0;
    case SIZE: {
        uint32_t size[2];
        int status = mcr_argument_pixels("--size", text, 'x', 2, 1, "WIDTHxHEIGHT", size);
        o->has_size = !status;
        o->width = status ? 0 : size[0];
        o->height = status ? 0 : size[1];
        return status;
    }
    case CROP:
        o->has_crop = 1;
        return mcr_argument_crop("--crop", text, o->crop);
    case PRECISION:
        return mcr_argument_word("--precision", text, precisions, 2, 1, &chosen);
    case ACCEL:
        o->has_accel = 1;
        return mcr_argument_word("--accel", text, accels, 4, 3, &o->accel);
    case ISA:
        return take_isa(options, text);
    case BATCH:
        return whole32("--batch", text, 0, 65536, &o->batch, &o->has_batch);
    case REPLICATES:
        return whole32("--replicates", text, 1, 4096, &o->replicates, &o->has_replicates);
    case ROULETTE:
        return take_roulette(o, text);
    case COMPAT:
        return take_compat(o, text);
    case LAYERS:
        if (mcr_layers_parse(text, &options->layers))
            return MCR_EXIT_USAGE;
        options->variance_layer = o->channel_variance = (options->layers & MCR_LAYER_VARIANCE) != 0;
        o->layer_bytes = mcr_features_bytes(mcr_layers_features(options->layers), 1);
        return 0;
    case TIME:
        o->has_time = 1;
        return mcr_argument_number("--time", text, 1e-9, 1e9, &o->time);
    case TARGET_ERROR:
        o->has_target_error = 1;
        return mcr_argument_number("--target-error", text, 1e-300, 1e100, &o->target_error);
    case ADAPTIVE:
        return take_adaptive(o, text);
    case ROUND:
        return whole32("--round", text, 1, 65536, &o->round, &o->has_round);
    case SAMPLE_MAP:
        options->sample_map = text;
        return 0;
    case USE_MAP:
        options->use_map = text;
        o->mapped = 1;
        return 0;
    case SET:
        return take_set(options, text);
    case PLUGIN:
        if (options->plugin_count == MCR_PLUGINS_MAX)
            return mcr_usage_error("--plugin may be given %u times at most", MCR_PLUGINS_MAX);
        options->plugin[options->plugin_count++] = text;
        return 0;
    case REPORT:
        options->report = text;
        return 0;
    case BITS:
        if (strcmp(text, "8") && strcmp(text, "16"))
            return mcr_usage_error("--bits expects 8 or 16, not '%s'", text);
        options->bits = text[0] == '8' ? 8 : 16;
        return 0;
    case EXPOSURE:
        return take_exposure(options, text);
    case TONE:
        o->tone = text;
        return 0;
    case PROFILE:
        options->profile = 1;
        return 0;
    case QUIET:
        options->quiet = 1;
        return 0;
    case WERROR:
        options->werror = 1;
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
static const struct option *find_long(const char *argument, size_t length)
{
    int found = mcr_option_find(&table[0].name, sizeof *table, OPTIONS, argument, length, 3);
    if (found == MCR_OPTION_NONE)
        mcr_option_unknown(&table[0].name, sizeof *table, OPTIONS, argument, length, "mcrender --help");
    return found < 0 ? NULL : &table[found];
}

/* The option that an argument names: -h, -o, -oVALUE, --name, --name=VALUE. *value is the value in the argument, or NULL. NULL after a message. */
static const struct option *find(const char *argument, const char **value)
{
    const char *equals = argument[1] == '-' ? strchr(argument, '=') : NULL;
    *value = equals ? equals + 1 : NULL;
    if (!strcmp(argument, "-h"))
        argument = "--help";
    if (argument[1] != 'o')
        return find_long(argument, equals ? (size_t)(equals - argument) : strlen(argument));
    *value = argument[2] ? argument + 2 : NULL;
    return &table[OUTPUT];
}

int mcr_options_parse(struct mcr_options *options, const char *command, int argc, char **argv)
{
    int where = !strcmp(command, "check") ? CHECK : !strcmp(command, "plugins") ? PLUGINS : !strcmp(command, "study") ? STUDY : !strcmp(command, "explain") ? EXPLAIN : RENDER;
    int operands_only = 0;
    memset(options, 0, sizeof *options);
    options->argument_count = argc;
    options->argument = argv;
    options->isa = mcr_cpu_isa();
    if (options->isa >= MCR_ISA_COUNT)
        options->isa = MCR_ISA_COUNT - 1;
    for (int i = 1; i < argc; i++) {
        const char *value;
        if (operands_only || argv[i][0] != '-' || !argv[i][1]) {
            if (options->scene)
                return mcr_usage_error("one operand expected: '%s' follows '%s'", argv[i], options->scene);
            options->scene = argv[i];
            continue;
        }
        if (!strcmp(argv[i], "--")) {
            operands_only = 1;
            continue;
        }
        int taken = where == STUDY ? mcr_study_option(&options->study, argc, argv, &i) : 0;
        if (taken > 0)
            continue;
        const struct option *option = taken ? NULL : find(argv[i], &value); /* taken < 0: a message was printed */
        if (!option)
            return MCR_EXIT_USAGE;
        if (!(option->where & where))
            return mcr_usage_error("%s does not go with 'mcrender %s'", option->name, command);
        if (option->argument && !value && ++i == argc)
            return mcr_usage_error("%s expects %s", option->name, option->argument);
        if (!option->argument && value && option->id != ADAPTIVE)
            return mcr_usage_error("%s takes no value", option->name);
        value = value || !option->argument ? value : argv[i];
        if (value && !*value)
            return mcr_usage_error("%s expects %s, not an empty text", option->name, option->argument ? option->argument : "on or off");
        if (take(options, option, value))
            return MCR_EXIT_USAGE;
    }
    return check_map(options);
}

void mcr_options_fini(struct mcr_options *options)
{
    for (uint32_t i = 0; i < options->definition_count; i++)
        free(options->definition_text[i]);
    options->definition_count = 0;
    mcr_study_options_fini(&options->study);
}
