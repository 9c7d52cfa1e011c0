/* SPDX-License-Identifier: Apache-2.0 */
/* Options that only `mcrender study` has: they say what a block `study` says, in the scene's syntax, and go there as texts. */
#ifndef MCR_CLI_STUDY_OPTIONS_H
#define MCR_CLI_STUDY_OPTIONS_H

#include <stdio.h>

#include "scene/study.h"

struct mcr_study_options {
    struct mcr_study_texts texts;
    char *owned[STUDY_COUNT]; /* lists that were given in several options, put together */
    int dry_run;
};

/*
 * Takes argv[*i], and its value, if it is one of these; *i is then the last argument that was taken. Returns 1 if it was, 0 if it is none of them, -1
 * after a message on stderr.
 */
int mcr_study_option(struct mcr_study_options *options, int argc, char **argv, int *i);
void mcr_study_options_fini(struct mcr_study_options *options);
void mcr_study_options_help(FILE *to);

#endif
