/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The distributions behind confidence intervals, on base/elementary.h alone: the same digits on every machine. Relative errors, measured by
 * tests/base/distributions.c against 40-digit values, are below 1e-12. NaN in, or a parameter outside its range: NaN out.
 */
#ifndef MCR_BASE_DISTRIBUTIONS_H
#define MCR_BASE_DISTRIBUTIONS_H

/* log(1 + x), also for tiny x. x > -1. */
double mcr_log1p(double x);

/* log of the gamma function, x > 0. Near its zeros at 1 and 2 the error is absolute, 1e-14. */
double mcr_log_gamma(double x);

/* The regularised incomplete beta function I_x(a, b) and its complement, each with its own relative accuracy. a, b > 0; y = 1 - x is given apart,
 * for x close to 1. About sqrt(max(a, b)) steps. */
struct mcr_beta {
    double lower, upper; /* I_x(a, b) and 1 - I_x(a, b) */
    double density;      /* x^a y^b / B(a, b): the derivative of I, times x y */
};
struct mcr_beta mcr_beta_regularised(double a, double b, double x, double y);

/* P(Z > z), and the z with P(Z <= z) = p, 0 < p < 1. */
double mcr_normal_upper(double z);
double mcr_normal_quantile(double p);

/* P(T > t), and the t with P(T <= t) = p, of Student's distribution with df degrees of freedom; df > 0 may be a fraction or infinite. The
 * quantile holds for tails down to 1e-100. */
double mcr_student_upper(double t, double df);
double mcr_student_quantile(double p, double df);

/* P(at most k heads in n tosses of a fair coin). */
double mcr_coin_lower(double k, double n);

#endif
