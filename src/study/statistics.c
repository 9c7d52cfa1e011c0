/* SPDX-License-Identifier: Apache-2.0 */
#include "study/statistics.h"

#include <stdlib.h>

#include "base/elementary.h"
#include "base/memory.h"
#include "base/distributions.h"

/* ---- intervals and tests ---- */

static double half_width(struct mcr_estimate e, double confidence)
{
    if (!(e.variance > 0.0 && e.value == e.value)) /* a quantile is worth sparing */
        return e.variance == 0.0 ? 0.0 : MCR_NAN;
    return mcr_student_quantile(0.5 + 0.5 * confidence, e.df) * sqrt(e.variance);
}

struct mcr_interval mcr_estimate_interval(struct mcr_estimate e, double confidence)
{
    double half = half_width(e, confidence);
    struct mcr_interval r = {e.value, e.value - half, e.value + half};
    return r;
}

struct mcr_interval mcr_estimate_exp_interval(struct mcr_estimate e, double confidence)
{
    struct mcr_interval r = mcr_estimate_interval(e, confidence);
    r.value = mcr_exp(r.value);
    r.low = mcr_exp(r.low);
    r.high = mcr_exp(r.high);
    return r;
}

double mcr_estimate_p(struct mcr_estimate e)
{
    if (e.variance == 0.0 && e.value == e.value)
        return e.value == 0.0 ? 1.0 : 0.0;
    return 2.0 * mcr_student_upper(fabs(e.value) / sqrt(e.variance), e.df);
}

double mcr_estimate_p_above(struct mcr_estimate e, double bound)
{
    if (e.variance == 0.0 && e.value == e.value)
        return e.value <= bound ? 1.0 : 0.0;
    return mcr_student_upper((e.value - bound) / sqrt(e.variance), e.df);
}

struct mcr_estimate mcr_estimate_add(struct mcr_estimate a, double scale_a, struct mcr_estimate b, double scale_b)
{
    struct mcr_estimate r;
    double va = scale_a * scale_a * a.variance, vb = scale_b * scale_b * b.variance;
    r.value = scale_a * a.value + scale_b * b.value;
    r.variance = va + vb;
    r.df = va == 0.0 ? b.df : vb == 0.0 ? a.df : r.variance * r.variance / (va * va / a.df + vb * vb / b.df);
    return r;
}

/* ---- estimates ---- */

/* Sum of (x - mean)^2; the mean in two passes, so that equal numbers have exactly their own value as mean and no spread. */
static double spread(const double *x, uint32_t n, double *mean)
{
    double rest = 0.0, sum = 0.0, m = x[0];
    for (uint32_t i = 0; i < n; i++)
        rest += x[i] - x[0];
    m += rest / n;
    for (uint32_t i = 0; i < n; i++)
        sum += (x[i] - m) * (x[i] - m);
    *mean = m;
    return sum;
}

struct mcr_estimate mcr_mean(const double *x, uint32_t n)
{
    struct mcr_estimate r = {MCR_NAN, MCR_NAN, 0.0};
    double squares;
    if (n == 0)
        return r;
    squares = spread(x, n, &r.value);
    r.df = n - 1.0;
    r.variance = n > 1 ? squares / r.df / n : MCR_NAN;
    return r;
}

struct mcr_estimate mcr_welch(const double *x, uint32_t nx, const double *y, uint32_t ny)
{
    return mcr_estimate_add(mcr_mean(x, nx), 1.0, mcr_mean(y, ny), -1.0);
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void mcr_sort(double *x, uint32_t n)
{
    qsort(x, n, sizeof *x, ascending);
}

struct mcr_estimate mcr_trimmed_mean(const double *sorted, uint32_t n, uint32_t cut)
{
    struct mcr_estimate r = {MCR_NAN, MCR_NAN, 0.0};
    double squares, low, high, mean, d_low, d_high, d_mean;
    uint32_t kept = n - 2 * cut;
    if (n < 1 || (n - 1) / 2 < cut) /* at least one must stay */
        return r;
    squares = spread(sorted + cut, kept, &r.value);
    r.df = kept - 1.0;
    if (kept < 2)
        return r;
    /* The numbers cut are moved to the next ones kept; their mean moves too. */
    low = sorted[cut];
    high = sorted[n - 1 - cut];
    d_low = low - r.value;
    d_high = high - r.value;
    mean = cut * (d_low + d_high) / n; /* from the trimmed mean */
    d_mean = squares + cut * (d_low * d_low + d_high * d_high) - n * mean * mean;
    r.variance = (d_mean > 0.0 ? d_mean : 0.0) / kept / (kept - 1.0);
    return r;
}

/* The greatest k with 2 P(heads <= k - 1) <= 1 - confidence; 0: none. */
static uint32_t median_rank(uint32_t n, double confidence)
{
    uint32_t low = 0, high = n / 2;
    while (low < high) {
        uint32_t k = high - (high - low) / 2;
        if (2.0 * mcr_coin_lower(k - 1.0, n) <= 1.0 - confidence)
            low = k;
        else
            high = k - 1;
    }
    return low;
}

struct mcr_interval mcr_median(const double *sorted, uint32_t n, double confidence)
{
    struct mcr_interval r = {MCR_NAN, MCR_NAN, MCR_NAN};
    uint32_t k = n ? median_rank(n, confidence) : 0;
    if (n)
        r.value = n % 2 ? sorted[n / 2] : sorted[n / 2 - 1] + 0.5 * (sorted[n / 2] - sorted[n / 2 - 1]);
    if (k) {
        r.low = sorted[k - 1];
        r.high = sorted[n - k];
    }
    return r;
}

void mcr_slope_weights(const double *x, uint32_t n, double *weight)
{
    double mean, squares = n ? spread(x, n, &mean) : 0.0;
    for (uint32_t i = 0; i < n; i++)
        weight[i] = squares > 0.0 ? (x[i] - mean) / squares : MCR_NAN;
}

struct mcr_estimate mcr_slope(const double *x, const double *y, uint32_t n)
{
    struct mcr_estimate r = {MCR_NAN, MCR_NAN, 0.0};
    double mean_x, mean_y, squares, product = 0.0, rest = 0.0;
    if (n < 2 || !((squares = spread(x, n, &mean_x)) > 0.0))
        return r;
    spread(y, n, &mean_y);
    for (uint32_t i = 0; i < n; i++)
        product += (x[i] - mean_x) * (y[i] - mean_y);
    r.value = product / squares;
    r.df = n - 2.0;
    for (uint32_t i = 0; i < n; i++) {
        double e = y[i] - mean_y - r.value * (x[i] - mean_x);
        rest += e * e;
    }
    r.variance = n > 2 ? rest / r.df / squares : MCR_NAN;
    return r;
}

/* ---- many tests ---- */

struct ranked {
    double p;
    uint32_t index;
};

static int by_p(const void *a, const void *b)
{
    const struct ranked *x = a, *y = b;
    return x->p != y->p ? (x->p > y->p) - (x->p < y->p) : (x->index > y->index) - (x->index < y->index);
}

int mcr_holm(const double *p, double *adjusted, uint32_t n)
{
    struct ranked *list = mcr_array_alloc(n, sizeof *list);
    uint32_t count = 0;
    double largest = 0.0;
    if (!list)
        return -1;
    for (uint32_t i = 0; i < n; i++) {
        if (p[i] == p[i])
            list[count++] = (struct ranked){p[i], i};
        adjusted[i] = p[i];
    }
    qsort(list, count, sizeof *list, by_p);
    for (uint32_t i = 0; i < count; i++) {
        double q = list[i].p * (count - i);
        largest = q > largest ? q : largest;
        adjusted[list[i].index] = largest < 1.0 ? largest : 1.0;
    }
    free(list);
    return 0;
}

static int found_by(double n, double difference, double spread_one, double fixed, double level, double power)
{
    double t = mcr_student_quantile(1.0 - 0.5 * level, n - 1.0) + mcr_student_quantile(power, n - 1.0);
    return fabs(difference) >= t * sqrt(spread_one / n + fixed);
}

/* As found_by with infinite degrees of freedom, solved for n: a lower bound. */
static double least_by_normal(double difference, double spread_one, double fixed, double level, double power)
{
    double z = mcr_normal_quantile(1.0 - 0.5 * level) + mcr_normal_quantile(power), room = difference / z * (difference / z) - fixed;
    return room > 0.0 ? spread_one / room : MCR_INFINITY;
}

uint32_t mcr_sample_size(double difference, double spread_one, double fixed, double level, double power, uint32_t above, uint32_t most)
{
    double bound = least_by_normal(difference, spread_one, fixed, level, power);
    uint32_t low = above < 1 ? 1 : above, high, step = 1;
    if (!(fabs(difference) > 0.0 && bound < most) || low >= most)
        return 0;
    if (bound - 1.0 > low)
        low = (uint32_t)(bound - 1.0);
    for (high = low + 1; !found_by(high, difference, spread_one, fixed, level, power); step *= 2) { /* low is too few, or not asked for */
        low = high;
        if (high >= most)
            return 0;
        high = most - high > step ? high + step : most;
    }
    while (high - low > 1) {
        uint32_t n = low + (high - low) / 2;
        if (found_by(n, difference, spread_one, fixed, level, power))
            high = n;
        else
            low = n;
    }
    return high;
}
