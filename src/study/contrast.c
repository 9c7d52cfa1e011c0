/* SPDX-License-Identifier: Apache-2.0 */
#include "base/elementary.h"
#include "base/distributions.h"
#include "study/inference.h"

#define LEAST_TRIMMED 7u /* runs: of fewer, cutting two leaves too little to know the spread from (of 5, intervals of 95 % hold in 94) */

/* The runs that every term has are marked by 0 in `mark`, the others by NaN; returns how many. */
static uint32_t common_runs(const struct mcr_term *term, uint32_t terms, uint32_t runs, double *mark)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < runs; i++) {
        int all = 1;
        for (uint32_t j = 0; j < terms; j++)
            all &= fabs(term[j].x[i]) < MCR_INFINITY;
        mark[i] = all ? 0.0 : MCR_NAN;
        count += (uint32_t)all;
    }
    return count;
}

/* Moves what is not NaN to the front. */
static void compact(double *x, uint32_t n)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < n; i++) {
        if (x[i] == x[i])
            x[kept++] = x[i];
    }
}

/* Mean of x - minus over the marked runs. */
static double marked_mean(const struct mcr_term *term, uint32_t runs, uint32_t count, const double *mark)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < runs; i++)
        sum += mark[i] == mark[i] ? term->x[i] - term->minus : 0.0;
    return sum / count;
}

/*
 * A run's pseudo-value is n log m - (n - 1) log m_i = log m - (n - 1) log(m_i / m), with the mean m and the mean without the run, m_i: but for a
 * constant, -(n - 1) log(1 + (m - x_i) / ((n - 1) m)). To first order that is x_i / m - 1, what the run moves the log of the mean by, times n.
 */
static int add_pseudo_values(const struct mcr_term *term, uint32_t runs, uint32_t count, double mean, double *sum)
{
    for (uint32_t i = 0; i < runs; i++) {
        double log_ratio;
        if (sum[i] != sum[i])
            continue;
        log_ratio = mcr_log1p((mean - (term->x[i] - term->minus)) / ((count - 1.0) * mean));
        if (!(fabs(log_ratio) < MCR_INFINITY)) /* nothing is left without this run */
            return 0;
        sum[i] -= term->weight * (count - 1.0) * log_ratio;
    }
    return 1;
}

struct mcr_estimate mcr_contrast_errors(const struct mcr_term *term, uint32_t terms, uint32_t runs, double floor, double *scratch)
{
    struct mcr_estimate r = {MCR_NAN, MCR_NAN, 0.0};
    uint32_t count = common_runs(term, terms, runs, scratch);
    double value = 0.0;
    int known = count > 1;
    if (count == 0)
        return r;
    for (uint32_t j = 0; j < terms; j++) {
        double mean = marked_mean(&term[j], runs, count, scratch);
        if (!(mean > floor))
            return r;
        value += term[j].weight * mcr_log(mean);
    }
    for (uint32_t j = 0; j < terms && known; j++)
        known = add_pseudo_values(&term[j], runs, count, marked_mean(&term[j], runs, count, scratch), scratch);
    if (known) {
        compact(scratch, runs);
        r = mcr_mean(scratch, count);
    }
    r.value = value;
    return r;
}

struct mcr_estimate mcr_contrast_times(const struct mcr_term *term, uint32_t terms, uint32_t runs, double *scratch)
{
    uint32_t count = common_runs(term, terms, runs, scratch);
    for (uint32_t j = 0; j < terms; j++) {
        for (uint32_t i = 0; i < runs; i++)
            scratch[i] += scratch[i] == scratch[i] ? term[j].weight * term[j].x[i] : 0.0;
    }
    compact(scratch, runs);
    mcr_sort(scratch, count);
    return mcr_trimmed_mean(scratch, count, count >= LEAST_TRIMMED ? 1 : 0);
}
