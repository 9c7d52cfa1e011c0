/* SPDX-License-Identifier: Apache-2.0 */
/* The metrics that look at one value after another: sums of one series, and what they make together. */
#ifndef MCR_METRICS_POINTWISE_H
#define MCR_METRICS_POINTWISE_H

#include "metrics/pair.h"
#include "metrics/sum.h"

struct mcr_pointwise {
    uint64_t count;
    struct mcr_sum image, reference;                              /* sums of a and r */
    struct mcr_sum square_error, absolute_error, relative, smape; /* of e^2, |e|, e^2 / (r^2 + 0.01 L^2), |e| / (|a| + |r|) */
    struct mcr_sum square_reference;                              /* of r^2 */
    double moment_error, moment_reference;                        /* sums of (e - mean e)^2 and (r - mean r)^2 */
};

/* row: room for 2 * pair->width values. */
void mcr_pointwise_measure(const struct mcr_pair *pair, uint32_t series, double *row, struct mcr_pointwise *sums);
/* Adds what another series found. */
void mcr_pointwise_join(struct mcr_pointwise *sums, const struct mcr_pointwise *other);
/* The values of all metrics but ssim and ms_ssim, with notes. */
void mcr_pointwise_finish(const struct mcr_pointwise *sums, double peak, struct mcr_metrics *metrics);

#endif
