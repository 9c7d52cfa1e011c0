/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The outputs of a study. Each is built in memory, then written whole or not at all; each ends its target. 0, or -1 with the reason in `error`.
 * They take any study, also an interrupted one: what is missing is told as missing. `analysis` is mcr_analysis_create's of the same study. The files'
 * formats are in mcrender-study(1). Main thread: pictures may need the OpenImageIO module.
 */
#ifndef MCR_STUDY_REPORT_H
#define MCR_STUDY_REPORT_H

#include "image/image.h"
#include "study/analysis.h"
#include "study/study.h"

/* Raised when a key of study.json changes its meaning or goes away; new keys do not raise it. */
#define MCR_STUDY_SCHEMA 1u

/* Everything. */
int mcr_study_write_json(struct mcr_target *target, const struct mcr_study *study, const struct mcr_analysis *analysis, char *error, size_t length);
/* One row a run. */
int mcr_study_write_csv(struct mcr_target *target, const struct mcr_study *study, const struct mcr_analysis *analysis, char *error, size_t length);
/* One page that needs nothing else. The pictures are read from plan->output; one that cannot be read is told as such on the page. */
int mcr_study_write_html(struct mcr_target *target, const struct mcr_study *study, const struct mcr_analysis *analysis, char *error, size_t length);

#endif
