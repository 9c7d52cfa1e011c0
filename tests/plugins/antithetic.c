/* SPDX-License-Identifier: Apache-2.0 */
/* antithetic: u and 1 - u, whichever dimensions are asked for, odd numbers of samples, and the variances of closed form. (The rest: numbers.h.) */
#include "numbers.h"

static void test_pairs(void)
{
    static const uint32_t counts[] = {1, 2, 3, 7, 64, 101};
    uint32_t wrong = 0;

    for (uint32_t c = 0; c < sizeof counts / sizeof *counts; c++)
        for (uint32_t first = 0; first <= 32; first += first < 8 ? 2 : 4) {
            uint32_t n = counts[c], count = first < 8 ? 2 : 4;

            for (uint32_t i = 0; i < 10 * n; i++)
                set(i, i / n, i % n, n, first % 7);
            fill(10 * n, first, count);
            for (uint32_t i = 0; i < 10 * n; i++)
                for (uint32_t k = 0; k < count; k++) {
                    wrong += !(u[k][i] >= 0 && u[k][i] < 1);
                    wrong += i % n % 2 == 1 && u[k][i] + u[k][i - 1] != 1 - 0x1p-53;
                    wrong += i % n % 2 == 0 && i > 0 && u[k][i] + u[k][i - 1] == 1 - 0x1p-53 && i % n > 0;
                }
        }
    ok(wrong == 0, "isa %u: two samples each have numbers that add up to 1 - 2^-53", isa);
}

static double linear(double x)
{
    return x;
}

static double square(double x)
{
    return x * x;
}

static double symmetric(double x)
{
    return (x - 0.5) * (x - 0.5);
}

/*
 * The variance of the mean of N samples, over pixels: (p (V + C) / 2 * 4 + r V) / N^2, with V the variance of one sample, C the covariance of a pair,
 * p = N / 2 pairs and r = N mod 2. For f = x: V = 1/12, C = -1/12. x^2: V = 4/45, and (V + C) / 2 = 1/180. e^x: V = (e^2 - 1)/2 - (e - 1)^2,
 * C = e - (e - 1)^2. (x - 1/2)^2: V = C = 1/180.
 */
static void test_variance(void)
{
    const double e = M_E, mean_of_exp = e - 1;
    const struct {
        double (*f)(double);
        double mean, variance, covariance;
    } known[] = {{linear, 0.5, 1.0 / 12, -1.0 / 12},
                 {square, 1.0 / 3, 4.0 / 45, 1.0 / 90 - 4.0 / 45},
                 {exp, mean_of_exp, (e * e - 1) / 2 - mean_of_exp * mean_of_exp, e - mean_of_exp * mean_of_exp},
                 {symmetric, 1.0 / 12, 1.0 / 180, 1.0 / 180}};
    static const uint32_t counts[] = {1, 2, 3, 8, 9};
    double worst = 0, worst_mean = 0, worst_zero = 0;

    for (uint32_t k = 0; k < sizeof known / sizeof *known; k++)
        for (uint32_t c = 0; c < sizeof counts / sizeof *counts; c++) {
            uint32_t n = counts[c], pixels = MOST / n;
            double variance = (n / 2 * 2 * (known[k].variance + known[k].covariance) + n % 2 * known[k].variance) / (n * n);
            double sum = 0, second = 0, fourth = 0;

            for (uint32_t i = 0; i < pixels * n; i++)
                set(i, 1000000 * c + i / n, i % n, n, 2);
            fill(pixels * n, 8, 1);
            for (uint32_t p = 0; p < pixels; p++) {
                double mean = -known[k].mean;

                for (uint32_t i = p * n; i < (p + 1) * n; i++)
                    mean += known[k].f(u[0][i]) / n;
                sum += mean, second += mean * mean, fourth += mean * mean * mean * mean;
            }
            sum /= pixels, second /= pixels, fourth /= pixels;
            if (variance < 1e-20) {
                worst_zero = fmax(worst_zero, sqrt(second));
                continue;
            }
            worst = fmax(worst, fabs(second - variance) / sqrt((fourth - second * second) / pixels));
            worst_mean = fmax(worst_mean, fabs(sum) / sqrt(second / pixels));
        }
    ok(worst_zero < 1e-15, "isa %u: a linear function has no variance (%g)", isa, worst_zero);
    ok(worst <= 4, "isa %u: variances of pairs, and of a last sample alone, are those of closed form (worst z %.2f)", isa, worst);
    ok(worst_mean <= 4, "isa %u: means are unbiased (worst z %.2f)", isa, worst_mean);
}

/* of: all, pixel, lens, camera, bounces */
static void test_choices(void)
{
    static const uint32_t expected[5][3] = {{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}};
    uint32_t wrong = 0;

    for (uint32_t of = 0; of < 5; of++) {
        double number[3] = {of};
        struct mcr_values values = {.size = sizeof values, .count = 1, .number = number};
        struct mcr_creation with = {.size = sizeof with, .values = &values, .spp = 16};
        void *other;

        wrong += plugin->create(&stand_in, &context, &with, &other) != MCR_OK;
        wrong += plugin->supplies(other, 0, 2) != 2 * expected[of][0] || plugin->supplies(other, 2, 2) != 2 * expected[of][1];
        wrong += plugin->supplies(other, 8, 16) != 16 * expected[of][2] || plugin->supplies(other, 24, 4) != 4 * expected[of][2];
        wrong += plugin->supplies(other, 32, 1) != expected[of][2];
        if (plugin->destroy)
            plugin->destroy(other);
    }
    ok(wrong == 0, "isa %u: the choice of dimensions", isa);
}

static void test(void)
{
    test_pairs();
    test_choices();
    if (isa == MCR_ISA_BASELINE) /* the same bits elsewhere */
        test_variance();
}

int main(void)
{
    return run("antithetic", test);
}
