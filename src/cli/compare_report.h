/* SPDX-License-Identifier: Apache-2.0 */
/* What `mcrender compare` tells: a text for people, JSON for programs; both on standard output. */
#ifndef MCR_CLI_COMPARE_REPORT_H
#define MCR_CLI_COMPARE_REPORT_H

#include "cli/compare_options.h"
#include "metrics/bias.h"

struct mcr_compare_map {
    const char *path;
    int coloured, failed;
    struct mcr_write_result result;
};

struct mcr_compare_data {
    const struct mcr_compare_options *options;
    uint32_t width, height;
    struct mcr_comparison comparison;
    int variance_known[2];       /* of the image and of the reference */
    const struct mcr_bias *bias; /* NULL: not tested */
    double map_range;
    struct mcr_compare_map map[MCR_OUTPUTS_MAX];
};

void mcr_compare_text(FILE *to, const struct mcr_compare_data *data);
/* Returns 0, or -1 when memory is short or the stream fails. */
int mcr_compare_json(FILE *to, const struct mcr_compare_data *data);

/* Whether a limit is exceeded: 0, or 1; an undefined metric exceeds every limit. */
int mcr_compare_exceeds(const struct mcr_compare_data *data, const struct mcr_compare_limit *limit);

#endif
