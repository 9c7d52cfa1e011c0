/* SPDX-License-Identifier: Apache-2.0 */
/*
 * sobol: nets, uniformity, independence of all that is to be independent, and the variances that theory gives for scrambled nets. Fixed keys:
 * every result is a constant, the limits are those of a fresh sample, |z| <= 4.
 */
#include "numbers.h"

/*
 * The first 2^m samples, planned or of more; and 2^m samples that are the second part of 9 * 2^m + 1. The first two dimensions of a group
 * make a (0,m,2)-net; the others, with loss: that of two polynomials' degrees is at most (degree - 1) + (degree' - 1) = 1 bit for
 * dimensions 2 and 3, 3 bits for 3 and 4.
 */
static void test_nets(void)
{
    static const uint32_t firsts[] = {0, 2, 8, 12, 16, 20, 24, 28};
    uint32_t wrong = 0, wrong_later = 0, wrong_one = 0, nets = 0;

    for (uint32_t g = 0; g < sizeof firsts / sizeof *firsts; g++)
        for (uint32_t m = 0; m <= 10; m++)
            for (uint32_t of = 0; of < 3; of++) {
                uint32_t n = 1u << m, begin = of == 2 ? 8 * n : 0;

                for (uint32_t i = 0; i < n; i++)
                    set(i, 11 + m, begin + i, of == 0 ? n : of == 1 ? n + 489 : 9 * n + (m > 0), g);
                fill(n, firsts[g], firsts[g] < 8 ? 2 : 4);
                wrong += uneven(u[0], u[1], m, m);
                nets++;
                if (firsts[g] < 8)
                    continue;
                wrong_later += m >= 1 ? uneven(u[1], u[2], m, m - 1) : 0;
                wrong_later += m >= 3 ? uneven(u[2], u[3], m, m - 3) : 0;
                for (uint32_t k = 0; k < 4; k++) /* with itself: the boxes of one dimension alone, and empty ones */
                    wrong_one += uneven(u[k], u[k], m, 0) || (m >= 1 && uneven(u[k], u[0], m, 1));
                for (uint32_t k = 2; k < 4; k++) {
                    static uint32_t hits[1024];

                    memset(hits, 0, sizeof hits);
                    for (uint32_t i = 0; i < n; i++)
                        wrong_one += hits[(uint32_t)ldexp(u[k][i], (int)m)]++;
                }
            }
    ok(wrong == 0, "isa %u: %u sets of samples have one in each elementary box (%u not)", isa, nets, wrong);
    ok(wrong_later == 0 && wrong_one == 0, "isa %u: dimensions 3 and 4 have one in each interval, and lose 1 and 3 bits at most (%u, %u not)", isa,
       wrong_one, wrong_later);
}

/*
 * The variance of the mean of N = 2^m samples, from so many pixels: against theory, and its standard error from the fourth moments.
 * Linear (f = x - 1/2): a sample in each interval, independent within, 1 / (12 N^3). Product (x - 1/2)(y - 1/2): Owen 1997, section 3: 1/N times the
 * sum over levels k1, k2 >= 1 of 4^-(k1 + k2) / 16, the function's variance there, times the net's gain: 0 for k1 + k2 <= m, 2 for m + 1, then 1.
 */
static double product_variance(uint32_t m)
{
    double sum = 2 * (double)m * pow(4, -(m + 1.0));

    for (uint32_t s = m + 2; s < m + 60; s++)
        sum += (s - 1) * pow(4, -(double)s);
    return sum / 16 / (1u << m);
}

struct measured {
    double mean, mean_error, variance, error;
};

static struct measured measure(uint32_t m, uint32_t first, uint32_t k, int product, uint32_t pixels)
{
    uint32_t n = 1u << m, chunk = MOST / n;
    double sum = 0, second = 0, fourth = 0;

    pixels = pixels > chunk ? pixels : chunk;
    for (uint32_t done = 0; done < pixels; done += chunk) {
        for (uint32_t i = 0; i < MOST; i++)
            set(i, 100000 * m + done + i / n, i % n, n, 3);
        fill(MOST, first, k + 2);
        for (uint32_t p = 0; p < chunk; p++) {
            double mean = 0;

            for (uint32_t i = p * n; i < (p + 1) * n; i++)
                mean += (u[k][i] - 0.5) * (product ? u[k + 1][i] - 0.5 : 1);
            mean /= n;
            sum += mean;
            second += mean * mean;
            fourth += mean * mean * mean * mean;
        }
    }
    sum /= pixels, second /= pixels, fourth /= pixels;
    return (struct measured){sum, sqrt(second / pixels), second, sqrt((fourth - second * second) / pixels)};
}

static void test_variance(void)
{
    double worst = 0, worst_mean = 0, logs[7], errors[7], slope = 0, slope_error = 0;

    for (uint32_t m = 1; m <= 7; m++)
        for (int product = 0; product < 2; product++)
            for (uint32_t first = 0; first <= 8; first += 8) {
                struct measured at = measure(m, first, 0, product, 16384);
                double expected = product ? product_variance(m) : pow(8, -(double)m) / 12;

                worst = fmax(worst, fabs(at.variance - expected) / at.error);
                worst_mean = fmax(worst_mean, fabs(at.mean) / at.mean_error);
                if (at.error > 0.03 * expected)
                    worst = INFINITY;
            }
    ok(worst <= 4, "isa %u: variances are those of scrambled nets (worst z %.2f)", isa, worst);
    ok(worst_mean <= 4, "isa %u: means are unbiased (worst z %.2f)", isa, worst_mean);

    /* N^-3 log N: the slope over log N, by least squares, between N = 4 and 256. Dimensions 2 and 3, those of a light's points, lose a constant. */
    for (uint32_t k = 0; k < 2; k++) {
        slope = slope_error = 0;
        for (uint32_t m = 2; m <= 8; m++) {
            struct measured at = measure(m, 8, k, 1, 4096);

            logs[m - 2] = log2(at.variance), errors[m - 2] = at.error / at.variance / log(2);
            slope += (m - 5.0) / 28 * logs[m - 2];
            slope_error += (m - 5.0) / 28 * (m - 5.0) / 28 * errors[m - 2] * errors[m - 2];
        }
        slope_error = sqrt(slope_error);
        ok(slope + 4 * slope_error < -2.5 && slope > -3.2, "isa %u: dimensions %u and %u: the variance of a product falls as N^%.3f +- %.3f", isa,
           k + 1, k + 2, slope, slope_error);
    }
}

/*
 * The scramble as such. In the first 2^m samples, m <= 5, the interval of 2^-m that is number c from below
 * holds one sample, in its upper half or its lower. Halves of any two intervals are to be independent, and those of any four neighbours: over the
 * pixels, the products of their signs have mean 0. Chi-square over all pairs of intervals, pairwise uncorrelated.
 */
static void test_scramble(void)
{
    double worst = 0, pixels = 0;

    for (uint32_t m = 1; m <= 5; m++) {
        static double pair[32][32], four[32];
        const uint32_t n = 1u << m;
        double chi = 0, chi_four = 0;

        memset(pair, 0, sizeof pair), memset(four, 0, sizeof four);
        pixels = 0;
        for (uint32_t chunk = 0; chunk < 8 * n; chunk++) {
            for (uint32_t i = 0; i < MOST; i++)
                set(i, chunk * (MOST / n) + i / n, i % n, n, 0);
            fill(MOST, 0, 1);
            for (uint32_t p = 0; p < MOST / n; p++, pixels++) {
                double sign[32];

                for (uint32_t i = p * n; i < (p + 1) * n; i++) {
                    uint32_t half = (uint32_t)(u[0][i] * 2 * n);

                    sign[half / 2] = half % 2 ? 1 : -1;
                }
                for (uint32_t c = 0; c < n; c++) {
                    for (uint32_t d = 0; d < c; d++)
                        pair[c][d] += sign[c] * sign[d];
                    if (c >= 3)
                        four[c] += sign[c] * sign[c - 1] * sign[c - 2] * sign[c - 3];
                }
            }
        }
        for (uint32_t c = 0; c < n; c++) {
            for (uint32_t d = 0; d < c; d++)
                chi += pair[c][d] * pair[c][d] / pixels;
            chi_four += four[c] * four[c] / pixels;
        }
        worst = fmax(worst, fabs(deviate(chi, n * (n - 1) / 2)));
        if (n > 3)
            worst = fmax(worst, fabs(deviate(chi_four, n - 3)));
    }
    ok(worst <= 4, "isa %u: bits of values are turned independently (worst z %.2f)", isa, worst);
}

/* Groups together: the blocks of 1, 1, 2, 4 ... N / 2 samples cost a little, about 1.14 at N = 64. (A nested order has 1.6 and more at any N.) */
static void test(void)
{
    test_nets();
    if (isa == MCR_ISA_BASELINE) { /* the same bits elsewhere */
        test_variance();
        test_scramble();
        test_gains(0.95, 1.2);
    }
}

int main(void)
{
    return run("sobol", test);
}
