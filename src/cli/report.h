/* SPDX-License-Identifier: Apache-2.0 */
/* What a render tells: text for people on stderr, JSON for programs. */
#ifndef MCR_CLI_REPORT_H
#define MCR_CLI_REPORT_H

#include "cli/load.h"
#include "core/core.h"
#include "film/features.h"
#include "film/sampling.h"

struct mcr_report_output {
    const char *path;
    struct mcr_write_result result;
    int failed;
    int layers;             /* it holds layers */
};

struct mcr_report_data {
    const struct mcr_options *options;
    struct mcr_loaded_scene *loaded;
    const struct mcr_accel *accel;
    struct mcr_features *features; /* NULL: no layer needs them */
    const struct mcr_render_stats *stats;
    const struct mcr_film *film;
    const struct mcr_sampling_result *sampling; /* of a render in rounds, or NULL */
    struct mcr_film_figures figures;
    struct mcr_coverage coverage;
    double accel_seconds, write_seconds;
    uint32_t output_count;
    struct mcr_report_output output[MCR_OUTPUTS_MAX];
};

void mcr_report_text(FILE *to, const struct mcr_report_data *data);
/* What is wrong with the picture, for --quiet too. */
void mcr_report_warnings(FILE *to, const struct mcr_report_data *data);
/* Ends the target. Returns 0, or -1 with the reason in `error`. */
int mcr_report_json(struct mcr_target *target, const struct mcr_report_data *data, char *error, size_t length);

const char *mcr_accel_name(uint32_t kind);

#endif
