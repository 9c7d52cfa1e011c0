/* SPDX-License-Identifier: Apache-2.0 */
/* The command line of `mcrender compare`. */
#ifndef MCR_CLI_COMPARE_OPTIONS_H
#define MCR_CLI_COMPARE_OPTIONS_H

#include <stdio.h>

#include "cli/options.h"
#include "metrics/map.h"
#include "metrics/metrics.h"

#define MCR_LIMITS_MAX 32u

struct mcr_compare_limit {
    uint32_t metric; /* enum mcr_metric */
    double value;
};

struct mcr_compare_options {
    const char *image, *reference;         /* NULL if absent; "-": standard input */
    const char *mask;                      /* or NULL */
    struct mcr_metrics_options how;        /* but for the mask's image */
    const char *map[MCR_OUTPUTS_MAX];
    uint32_t map_count;
    uint32_t map_kind;                     /* enum mcr_map_kind */
    double map_range;                      /* 0: the largest value */
    struct mcr_compare_limit limit[MCR_LIMITS_MAX];
    uint32_t limit_count;
    double confidence;
    int json, quiet, help, version;
};

extern const char *const mcr_metrics_encoding_name[2];

/* Parses argv[1..]. Returns 0, or MCR_EXIT_USAGE after a message on stderr. What points into argv stays there. */
int mcr_compare_options_parse(struct mcr_compare_options *options, int argc, char **argv);
void mcr_compare_options_help(FILE *to);

#endif
