/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/study_options.h"

#include <stdlib.h>
#include <string.h>

#include "cli/arguments.h"

enum { OF_STUDY, OF_REFERENCE, DRY_RUN };

static const struct option {
    const char *name, *argument, *text;
    uint32_t of, index;
    int is_list; /* may be given again: more elements */
} table[] = {
    {"--sampler", "EXPR", "one to compare; again for more", OF_STUDY, STUDY_SAMPLERS, 1},
    {"--spp", "LIST", "samples per pixel: 1,100", OF_STUDY, STUDY_SPP, 1},
    {"--depth", "LIST", "scatterings at most: 1,25,50", OF_STUDY, STUDY_DEPTH, 1},
    {"--precision", "LIST", "double", OF_STUDY, STUDY_PRECISION, 1},
    {"--accel", "LIST", "auto,list,bvh", OF_STUDY, STUDY_ACCEL, 1},
    {"--roulette", "LIST", "on,off", OF_STUDY, STUDY_ROULETTE, 1},
    {"--compat", "LIST", "known mistakes: none,clamp", OF_STUDY, STUDY_COMPAT, 1},
    {"--seeds", "N", "renders of a cell for its error", OF_STUDY, STUDY_SEEDS, 0},
    {"--runs", "N", "renders of a cell for its time", OF_STUDY, STUDY_RUNS, 0},
    {"--seed", "N", "of the first run", OF_STUDY, STUDY_SEED, 0},
    {"--baseline", "EXPR", "efficiency is relative to it", OF_STUDY, STUDY_BASELINE, 0},
    {"--confidence", "P", "of intervals: 0.95", OF_STUDY, STUDY_CONFIDENCE, 0},
    {"--target", "MSE", "error whose time is asked for", OF_STUDY, STUDY_TARGET, 0},
    {"--metrics", "LIST", "mse,psnr,ssim", OF_STUDY, STUDY_METRICS, 1},
    {"--encoding", "KIND", "linear, srgb8: of the metrics", OF_STUDY, STUDY_ENCODING, 0},
    {"--peak", "X", "white, for the metrics", OF_STUDY, STUDY_PEAK, 0},
    {"--title", "TEXT", "of the report", OF_STUDY, STUDY_TITLE, 0},
    {"--reference", "FILE", "an image to measure against", OF_REFERENCE, REFERENCE_IMAGE, 0},
    {"--reference-sampler", "EXPR", "or how to render it", OF_REFERENCE, REFERENCE_SAMPLER, 0},
    {"--reference-spp", "N", "", OF_REFERENCE, REFERENCE_SPP, 0},
    {"--reference-depth", "N", "one for all depths", OF_REFERENCE, REFERENCE_DEPTH, 0},
    {"--reference-seed", "N", "", OF_REFERENCE, REFERENCE_SEED, 0},
    {"--dry-run", NULL, "lists the renders and their time", DRY_RUN, 0, 0},
};
#define OPTIONS (sizeof table / sizeof *table)

void mcr_study_options_help(FILE *to)
{
    fputs("Usage: mcrender study SCENE [-o FOLDER] [OPTION]...\n\n"
          "Renders the scene with every combination of what is listed, several times each,\n"
          "measures time and error, and says which is better. What is finished is kept: an\n"
          "interrupted study goes on where it was. Options replace what a block `study` in\n"
          "the scene says.\n\n",
          to);
    for (size_t i = 0; i < OPTIONS; i++) {
        char left[32];
        snprintf(left, sizeof left, "%s%s%s", table[i].name, table[i].argument ? " " : "", table[i].argument ? table[i].argument : "");
        fprintf(to, "  %-24s%s%s\n", left, *table[i].text ? " " : "", table[i].text);
    }
    fputs("\nFurther --size, --crop, --threads, --isa, --batch, --set, --plugin, --quiet and\n"
          "--werror as for a render.\n"
          "Status: 0 done, 1 failed, 2 usage, 3 scene error, 130 interrupted after saving.\n",
          to);
}

#define SHORTEST 5u /* bytes of an abbreviation: fewer may be meant for an option that all commands have */

static int take_list(struct mcr_study_options *options, uint32_t index, const char *value)
{
    const char *before = options->texts.setting[index];
    size_t room = before ? strlen(before) + strlen(value) + 3 : 0;
    char *whole = before ? malloc(room) : NULL;
    if (before && !whole) {
        mcr_usage_error("out of memory");
        return -1;
    }
    if (whole)
        snprintf(whole, room, "%s, %s", before, value);
    free(options->owned[index]);
    options->owned[index] = whole;
    options->texts.setting[index] = whole ? whole : value;
    return 1;
}

static int take(struct mcr_study_options *options, const struct option *option, const char *value)
{
    if (option->of == DRY_RUN)
        options->dry_run = 1;
    else if (option->of == OF_REFERENCE)
        options->texts.reference[option->index] = value;
    else if (option->is_list)
        return take_list(options, option->index, value);
    else
        options->texts.setting[option->index] = value;
    return 1;
}

int mcr_study_option(struct mcr_study_options *options, int argc, char **argv, int *i)
{
    const char *argument = argv[*i], *equals = strchr(argument, '='), *value = equals ? equals + 1 : NULL;
    size_t length = equals ? (size_t)(equals - argument) : strlen(argument);
    int found = strncmp(argument, "--", 2) ? MCR_OPTION_NONE : mcr_option_find(&table[0].name, sizeof *table, OPTIONS, argument, length, SHORTEST);
    if (found < 0)
        return found == MCR_OPTION_NONE ? 0 : -1;
    const struct option *option = &table[found];
    if (!option->argument && value) {
        mcr_usage_error("%s takes no value", option->name);
        return -1;
    }
    if (option->argument && !value)
        value = ++*i < argc ? argv[*i] : "";
    if (option->argument && !*value) {
        mcr_usage_error("%s expects %s", option->name, option->argument);
        return -1;
    }
    return take(options, option, value);
}

void mcr_study_options_fini(struct mcr_study_options *options)
{
    for (uint32_t i = 0; i < STUDY_COUNT; i++)
        free(options->owned[i]);
    memset(options->owned, 0, sizeof options->owned);
}
