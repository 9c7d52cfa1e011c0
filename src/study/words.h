/* SPDX-License-Identifier: Apache-2.0 */
/* The words for what a study's structures hold as numbers: keys and values of study.json and study.csv, and sentences of the report. */
#ifndef MCR_STUDY_WORDS_H
#define MCR_STUDY_WORDS_H

#include "study/analysis.h"

#define MCR_MARK_COUNT 6u
/* In the order of the bits MCR_MARK_*. */
extern const char *const mcr_mark_word[MCR_MARK_COUNT];
extern const char *const mcr_mark_sentence[MCR_MARK_COUNT];
/* With one of these a cell is left out of rankings. */
#define MCR_MARK_UNRANKED (MCR_MARK_INCOMPLETE | MCR_MARK_FLATTENS | MCR_MARK_BIASED | MCR_MARK_NOT_FINITE)

const char *mcr_verdict_word(uint32_t verdict);   /* better, worse, unknown, excluded */
const char *mcr_target_word(uint32_t target);     /* measured, extrapolated, unreachable */
const char *mcr_precision_word(uint32_t precision);
const char *mcr_accel_word(uint32_t accel);
const char *mcr_encoding_word(uint32_t encoding); /* linear, srgb8 */
/* A heading: "PSNR (dB)". */
const char *mcr_metric_title(uint32_t metric);
/* The peak that the metrics take: 1 or 255 where none is given. */
double mcr_metrics_peak(const struct mcr_metrics_options *options);

#endif
