/* SPDX-License-Identifier: Apache-2.0 */
/* What `mcrender study` prints: a compact table and the verdicts in words; report.html has the rest. */
#ifndef MCR_CLI_STUDY_REPORT_H
#define MCR_CLI_STUDY_REPORT_H

#include <stdio.h>

#include "study/analysis.h"
#include "study/run.h"

void mcr_study_print(FILE *to, const struct mcr_study *study, const struct mcr_analysis *analysis);
void mcr_study_print_estimate(FILE *to, const struct mcr_study *study, const struct mcr_study_estimate *cell,
                              const struct mcr_study_estimate *reference);

#endif
