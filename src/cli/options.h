/* SPDX-License-Identifier: Apache-2.0 */
/* The command line: one table of options serves parsing, checking and --help. */
#ifndef MCR_CLI_OPTIONS_H
#define MCR_CLI_OPTIONS_H

#include <stdio.h>

#include "cli/study_options.h"
#include "image/image.h"
#include "language/tree.h"
#include "scene/scene.h"

/* Exit statuses. */
enum { MCR_EXIT_DONE = 0, MCR_EXIT_FAILED = 1, MCR_EXIT_USAGE = 2, MCR_EXIT_SCENE = 3, MCR_EXIT_THRESHOLD = 4, MCR_EXIT_INTERRUPTED = 130 };

#define MCR_OUTPUTS_MAX 16u
#define MCR_DEFINITIONS_MAX 64u
#define MCR_PLUGINS_MAX 64u

struct mcr_options {
    const char *scene;                            /* or the operand of a subcommand; NULL if absent */
    const char *output[MCR_OUTPUTS_MAX];
    uint32_t output_count;
    struct mcr_definition definition[MCR_DEFINITIONS_MAX];
    char *definition_text[MCR_DEFINITIONS_MAX];   /* owned copies */
    uint32_t definition_count;
    const char *plugin[MCR_PLUGINS_MAX + 1];      /* NULL-terminated */
    uint32_t plugin_count;
    struct mcr_overrides overrides;
    const char *report;
    uint32_t layers;                              /* MCR_LAYER_* */
    int variance_layer;                           /* variance is among them */
    const char *sample_map;                       /* --sample-map: to write; NULL: none */
    const char *use_map;                          /* --use-map: to follow; NULL: none */
    uint32_t isa;
    uint32_t bits;
    int quiet, werror, profile;
    int help, version;
    struct mcr_study_options study;
    int argument_count;                           /* the command's words: argument[1] .. [argument_count - 1] follow it */
    char **argument;
};

/*
 * Parses argv[1..] for one command: `mcrender` itself ("") or a subcommand. Returns 0, or MCR_EXIT_USAGE after a message on stderr.
 * End with mcr_options_fini.
 */
int mcr_options_parse(struct mcr_options *options, const char *command, int argc, char **argv);
void mcr_options_fini(struct mcr_options *options);

/* Prints the usage of all commands: fits one screen. */
void mcr_options_help(FILE *to);

#endif
