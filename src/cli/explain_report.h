/* SPDX-License-Identifier: Apache-2.0 */
/* What `mcrender explain` tells: text for people, JSON for programs. */
#ifndef MCR_CLI_EXPLAIN_REPORT_H
#define MCR_CLI_EXPLAIN_REPORT_H

#include "cli/load.h"
#include "core/explain.h"

struct mcr_explain_data {
    const struct mcr_options *options;
    struct mcr_loaded_scene *loaded;
    const struct mcr_accel *accel;
    struct mcr_coverage coverage;
    struct mcr_explanation core;
    struct mcr_render_stats pilot;
    uint32_t pilot_width, pilot_height;
    uint32_t threads;          /* of the render */
    double prepare_seconds;    /* parsing, building, the accelerator */
    /* the render's memory, estimated, in bytes */
    uint64_t scene_bytes, accel_bytes, film_bytes, picture_bytes;
    uint64_t variance_bytes;   /* of the film, for the layer `variance`; 0 without it */
    uint64_t measured;         /* the peak of this process, which has held a pilot's film and one batch */
    uint64_t total;            /* of the render: what was measured, and what it takes more than the pilot */
};

void mcr_explain_text(FILE *to, const struct mcr_explain_data *data);
/* Ends the target. Returns 0, or -1 with the reason in `error`. */
int mcr_explain_json(struct mcr_target *target, const struct mcr_explain_data *data, char *error, size_t length);

#endif
