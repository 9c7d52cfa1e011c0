/* SPDX-License-Identifier: Apache-2.0 */
/* Estimates, intervals and tests on small data worked out by hand or, where said, by python3-mpmath 1.3.0 from the same formulas. */
#include <math.h>

#include "../tap.h"
#include "study/statistics.h"

#define T_975_1 12.706204736174694 /* t quantiles: tests/base/distributions.c */
#define T_975_4 2.7764451051977944

static int near(double value, double truth)
{
    return fabs(value - truth) <= 1e-12 * fmax(1, fabs(truth));
}

static int unknown(struct mcr_interval interval, double value)
{
    return near(interval.value, value) && isnan(interval.low) && isnan(interval.high);
}

static void test_mean(void)
{
    const double x[5] = {1, 2, 3, 4, 5}, same[3] = {0.1, 0.1, 0.1};
    struct mcr_estimate e = mcr_mean(x, 5), two = mcr_mean(x, 2), equal = mcr_mean(same, 3);
    struct mcr_interval i = mcr_estimate_interval(e, 0.95);
    ok(e.value == 3 && near(e.variance, 0.5) && e.df == 4, "mean of five");
    ok(near(i.low, 3 - T_975_4 * sqrt(0.5)) && near(i.high, 3 + T_975_4 * sqrt(0.5)), "its interval: t with 4 degrees of freedom");
    i = mcr_estimate_interval(two, 0.95);
    ok(near(i.low, 1.5 - T_975_1 * 0.5) && near(i.high, 1.5 + T_975_1 * 0.5), "two numbers: t with 1");
    ok(unknown(mcr_estimate_interval(mcr_mean(x, 1), 0.95), 1) && isnan(mcr_mean(x, 0).value), "one number has no interval, none no mean");
    i = mcr_estimate_interval(equal, 0.95);
    ok(equal.value == 0.1 && i.low == 0.1 && i.high == 0.1, "equal numbers: exactly their value, no width");
    e.value = log(2);
    i = mcr_estimate_exp_interval(e, 0.95);
    ok(near(i.value, 2) && near(i.low * i.high, 4) && near(log(i.high / i.value), T_975_4 * sqrt(0.5)), "exponential of an interval");
}

static void test_p(void)
{
    struct mcr_estimate e = {T_975_4, 1, 4}, exact = {1, 0, 4}, nothing = {0, 0, 4}, blind = {1, NAN, 0};
    ok(near(mcr_estimate_p(e), 0.05) && near(mcr_estimate_p_above(e, 0), 0.025) && near(mcr_estimate_p_above(e, 2 * T_975_4), 0.975),
       "p, two- and one-sided");
    ok(mcr_estimate_p(exact) == 0 && mcr_estimate_p(nothing) == 1 && mcr_estimate_p_above(exact, 1) == 1 && mcr_estimate_p_above(exact, 0.5) == 0,
       "p without variance");
    ok(isnan(mcr_estimate_p(blind)) && isnan(mcr_estimate_p_above(blind, 0)), "p of an unknown variance is unknown");
}

static void test_welch(void)
{
    const double x[4] = {1, 2, 3, 4}, y[3] = {4, 8, 9}; /* variances of the means 5/12 and 7/3 */
    struct mcr_estimate e = mcr_welch(x, 4, y, 3), one = mcr_estimate_add(mcr_mean(x, 4), 2, (struct mcr_estimate){1, 0, 7}, 3);
    double va = 5.0 / 12, vb = 7.0 / 3;
    ok(near(e.value, -4.5) && near(e.variance, va + vb) && near(e.df, (va + vb) * (va + vb) / (va * va / 3 + vb * vb / 2)), "Welch: df %.6f", e.df);
    ok(near(one.value, 8) && near(one.variance, 4 * va) && one.df == 3, "a sum with what is known exactly");
    ok(isnan(mcr_welch(x, 4, y, 1).variance), "one number against four: no variance");
}

static void test_trimmed(void)
{
    double x[7] = {10, 2, 3, 1, 2.5, 4, -50};
    struct mcr_estimate e, plain;
    mcr_sort(x, 7);
    e = mcr_trimmed_mean(x, 7, 1); /* 1 2 2.5 3 4 of -50 ... 10; winsorised 1 1 2 2.5 3 4 4: sum of squares about 2.5 is 9.5 */
    ok(x[0] == -50 && x[6] == 10 && near(e.value, 2.5) && e.df == 4 && near(e.variance, 9.5 / (5 * 4)),
       "trimmed mean and Yuen's variance: %g, %g", e.value,
       e.variance);
    e = mcr_trimmed_mean((const double[]){0, 1, 2, 9}, 4, 1); /* winsorised 1 1 2 2: sum of squares 1 about 1.5 */
    ok(near(e.value, 1.5) && e.df == 1 && near(e.variance, 1.0 / 2), "trimmed mean of four");
    e = mcr_trimmed_mean((const double[]){0, 1, 1, 4}, 4, 1);
    ok(e.value == 1 && e.variance == 0, "all that is kept is equal");
    e = mcr_trimmed_mean((const double[]){0, 0, 0, 1, 3}, 5, 1); /* winsorised 0 0 0 1 1: mean 0.4, sum of squares 1.2 */
    ok(near(e.value, 1.0 / 3) && near(e.variance, 1.2 / 6), "the winsorised mean is not the trimmed one");
    plain = mcr_mean(x, 7);
    e = mcr_trimmed_mean(x, 7, 0);
    ok(near(e.value, plain.value) && near(e.variance, plain.variance) && e.df == 6, "nothing cut: the mean");
    ok(isnan(mcr_trimmed_mean(x, 3, 1).variance) && mcr_trimmed_mean(x, 3, 1).value == x[1] && isnan(mcr_trimmed_mean(x, 2, 1).value) &&
       isnan(mcr_trimmed_mean(x, 0, 0).value), "too few to trim");
}

static void test_median(void)
{
    double x[100];
    struct mcr_interval i;
    for (int k = 0; k < 100; k++)
        x[k] = k + 1;
    ok(unknown(mcr_median(x, 5, 0.95), 3) && unknown(mcr_median(x, 1, 0.95), 1) && isnan(mcr_median(x, 0, 0.95).value), "median of fewer than six");
    i = mcr_median(x, 6, 0.95);
    ok(i.value == 3.5 && i.low == 1 && i.high == 6, "of six: all of them (covers 96.9 %%)");
    i = mcr_median(x, 10, 0.95);
    ok(i.value == 5.5 && i.low == 2 && i.high == 9, "of ten: second to ninth (97.9 %%; third to eighth would be 89.1)");
    i = mcr_median(x, 100, 0.95);
    ok(i.low == 40 && i.high == 61, "of a hundred: 40th to 61st (96.5 %%)");
    i = mcr_median(x, 10, 0.99);
    ok(i.low == 1 && i.high == 10, "of ten at 99 %%: first to tenth");
}

static void test_slope(void)
{
    const double x[4] = {0, 1, 2, 3}, y[4] = {1, 0, 2, 1}, line[4] = {5, 3, 1, -1}, flat[2] = {1, 1};
    struct mcr_estimate e = mcr_slope(x, y, 4);
    double weight[4], sum = 0;
    ok(near(e.value, 0.2) && e.df == 2 && near(e.variance, 1.8 / 2 / 5), "slope of four points"); /* residuals .3 -.9 .9 -.3 */
    e = mcr_slope(x, line, 4);
    ok(near(e.value, -2) && e.variance < 1e-30, "of a line");
    mcr_slope_weights(x, 4, weight);
    for (int k = 0; k < 4; k++)
        sum += weight[k] * y[k];
    ok(near(sum, 0.2), "weights give the slope");
    ok(isnan(mcr_slope(flat, y, 2).value) && isnan(mcr_slope(x, y, 1).value) && isnan(mcr_slope(x, y, 2).variance) &&
       near(mcr_slope(x, y, 2).value, -1),
       "no slope at one place, no variance of two points");
    mcr_slope_weights(flat, 2, weight);
    ok(isnan(weight[0]) && isnan(weight[1]), "nor weights");
}

static void test_holm(void)
{
    double p[5] = {0.01, 0.04, NAN, 0.03, 0.005}, one[1] = {0.3}, large[2] = {0.6, 0.7};
    ok(mcr_holm(p, p, 5) == 0 && near(p[4], 0.02) && near(p[0], 0.03) && near(p[3], 0.06) && near(p[1], 0.06) && isnan(p[2]),
       "Holm's example: %g %g %g %g", p[0], p[1], p[3], p[4]);
    ok(mcr_holm(one, one, 1) == 0 && one[0] == 0.3 && mcr_holm(large, large, 2) == 0 && large[0] == 1 && large[1] == 1 &&
       mcr_holm(NULL, NULL, 0) == 0,
       "one p stays, none is above 1, no p at all");
}

/* n by trying all. */
static uint32_t tried(double difference, double spread, double fixed, double level, double power, uint32_t above)
{
    for (uint32_t n = above + 1; n <= 2000; n++) {
        struct mcr_estimate at_level = {0, 1, n - 1.0}, at_power = {0, 1, n - 1.0};
        double t = mcr_estimate_interval(at_level, 1 - level).high + mcr_estimate_interval(at_power, 2 * power - 1).high;
        if (n > 1 && difference >= t * sqrt(spread / n + fixed))
            return n;
    }
    return 0;
}

static void test_sample_size(void)
{
    int same = 1;
    for (double difference = 0.05; difference < 3; difference *= 1.3)
        same &= mcr_sample_size(difference, 0.3, 1e-4, 0.05, 0.8, 2, 2000) == tried(difference, 0.3, 1e-4, 0.05, 0.8, 2);
    ok(same, "the sample size is the least one");
    /* z: (1.959963985 + 0.841621234)^2 = 7.848879735 for one unit of difference and spread; t adds about two. */
    ok(mcr_sample_size(1, 100, 0, 0.05, 0.8, 1, 1000000) == 787,
       "785 by the normal, 787 by t: %u", mcr_sample_size(1, 100, 0, 0.05, 0.8, 1, 1000000));
    ok(mcr_sample_size(-1, 100, 0, 0.05, 0.8, 1, 1000000) == 787 && mcr_sample_size(1, 100, 0, 0.05, 0.8, 900, 1000000) == 901,
       "either sign; more than there are");
    ok(mcr_sample_size(1, 100, 0, 0.05, 0.8, 1, 500) == 0 && mcr_sample_size(0, 1, 0, 0.05, 0.8, 1, 500) == 0 &&
       mcr_sample_size(0, 0, 0, 0.05, 0.8, 1, 500) == 0 &&
       mcr_sample_size(1, 1, 0.2, 0.05, 0.8, 1, 500) == 0 && mcr_sample_size(NAN, 1, 0, 0.05, 0.8, 1, 500) == 0 &&
       mcr_sample_size(1, NAN, 0, 0.05, 0.8, 1, 500) == 0 && mcr_sample_size(1, 1, 0, 0.05, 0.8, 500, 500) == 0, "not to be had");
}

int main(void)
{
    test_mean();
    test_p();
    test_welch();
    test_trimmed();
    test_median();
    test_slope();
    test_holm();
    test_sample_size();
    return tap_done();
}
