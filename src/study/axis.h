/* SPDX-License-Identifier: Apache-2.0 */
/* A logarithmic axis: its range, where its ticks stand and how they are labelled. */
#ifndef MCR_STUDY_AXIS_H
#define MCR_STUDY_AXIS_H

#include <stdint.h>

#include "study/text.h"

#define MCR_AXIS_TICKS 24u

struct mcr_axis {
    double low, high;             /* 0 < low < high */
    double least, greatest;       /* of the values that were added, or NaN */
    uint32_t ticks;
    double tick[MCR_AXIS_TICKS];  /* within [low, high], rising */
    int powers;                   /* the labels are powers of ten */
};

void mcr_axis_init(struct mcr_axis *axis);
/* Values that are not positive and finite are passed over. */
void mcr_axis_add(struct mcr_axis *axis, double value);
/* Like mcr_axis_add for the end of an interval around `value`, which may lie far out: it counts up to a factor of 4. */
void mcr_axis_add_end(struct mcr_axis *axis, double value, double end);
/* Sets range and ticks. Whole decades where there are enough, else 1 2 5, else steps in equal distances; about `wanted` (2 ... 10) at most.
 * An axis without values goes from 0.1 to 10. */
void mcr_axis_finish(struct mcr_axis *axis, uint32_t wanted);
/* Ticks at these rising values instead, as far as they are at least `share` of the axis apart. */
void mcr_axis_set_ticks(struct mcr_axis *axis, const double *value, uint32_t count, double share);
/* 0 at low, 1 at high; may lie outside. NaN for values that are not positive and finite. */
double mcr_axis_place(const struct mcr_axis *axis, double value);
/* A tick's label, as content of an SVG <text>. */
void mcr_axis_label(const struct mcr_axis *axis, double tick, struct mcr_text *out);

#endif
