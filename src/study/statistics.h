/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Estimates, intervals and tests, free of everything about studies. An estimate is a value with its variance and the degrees of freedom of that
 * variance; what the data do not give is NaN, and NaN in gives NaN out. Values shall be finite: callers leave others out.
 */
#ifndef MCR_STUDY_STATISTICS_H
#define MCR_STUDY_STATISTICS_H

#include <stdint.h>

/* Two-sided confidence interval. value alone may be known: then low and high are NaN. */
struct mcr_interval {
    double value, low, high;
};

struct mcr_estimate {
    double value;
    double variance; /* of the value; NaN: unknown, e.g. of one number */
    double df;       /* of the variance; a fraction after mcr_estimate_add */
};

/* ---- intervals and tests of an estimate: t(df) about the value ---- */
struct mcr_interval mcr_estimate_interval(struct mcr_estimate estimate, double confidence);
/* The estimate is of a logarithm: the exponentials of the interval. */
struct mcr_interval mcr_estimate_exp_interval(struct mcr_estimate estimate, double confidence);
/* Two-sided p of "the value is 0"; one-sided p of "the value is at most `bound`". With variance 0: 0, or 1 where the data agree with it. */
double mcr_estimate_p(struct mcr_estimate estimate);
double mcr_estimate_p_above(struct mcr_estimate estimate, double bound);
/* scale_a a + scale_b b, independent; degrees of freedom by Welch and Satterthwaite. */
struct mcr_estimate mcr_estimate_add(struct mcr_estimate a, double scale_a, struct mcr_estimate b, double scale_b);

/* ---- estimates from numbers ---- */
struct mcr_estimate mcr_mean(const double *x, uint32_t n);
/* Difference of the means of two independent samples whose spreads may differ: Welch. */
struct mcr_estimate mcr_welch(const double *x, uint32_t nx, const double *y, uint32_t ny);
/* Ascending, in place. */
void mcr_sort(double *x, uint32_t n);
/* Of sorted numbers: the mean without the `cut` lowest and the `cut` highest, variance from the winsorised sum of squares (K. K. Yuen, Biometrika 61,
 * 1974), n - 2 cut - 1 degrees of freedom. cut 0 is mcr_mean. */
struct mcr_estimate mcr_trimmed_mean(const double *sorted, uint32_t n, uint32_t cut);
/* Of sorted numbers: order statistics, with at least the confidence asked for; NaN ends where n is too small for it (below 6 at 95 %). */
struct mcr_interval mcr_median(const double *sorted, uint32_t n, double confidence);
/* Least squares line through (x, y): its slope, n - 2 degrees of freedom. NaN where all x are equal. */
struct mcr_estimate mcr_slope(const double *x, const double *y, uint32_t n);
/* weight[i] such that sum weight[i] y[i] is that slope; all NaN where all x are equal. */
void mcr_slope_weights(const double *x, uint32_t n, double *weight);

/* ---- many tests ---- */
/* S. Holm (Scand. J. Statist. 6, 1979): adjusted[i] <= level holds for a true hypothesis in at most a share `level` of all families, whatever their
 * dependence. NaN p take no part and stay NaN. The two may be the same array. Returns 0, or -1 when memory is short. */
int mcr_holm(const double *p, double *adjusted, uint32_t n);

/* The least n > above for which a two-sided t test at `level` finds `difference` with probability `power`, where n numbers give the mean a variance
 * of spread / n + fixed and n - 1 degrees of freedom: difference >= (t_level/2 + t_power) * its root. 0: more than most, or not to be had. */
uint32_t mcr_sample_size(double difference, double spread, double fixed, double level, double power, uint32_t above, uint32_t most);

#endif
