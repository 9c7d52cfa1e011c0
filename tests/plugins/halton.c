/* SPDX-License-Identifier: Apache-2.0 */
/*
 * halton: every interval of every base holds its share of any number of samples, pairs and fours theirs of boxes, and the variances are those of
 * theory for any number of samples. (Uniformity, independence and the rest: numbers.h.)
 */
#include "numbers.h"

static const uint32_t base[4] = {2, 3, 5, 7};

/* The interval of width 1/n that a number is in, judged as doubles compare. */
static uint32_t interval(double x, uint32_t n)
{
    uint32_t k = (uint32_t)(x * n);

    return k > 0 && (double)k / n > x ? k - 1 : (double)(k + 1) / n <= x ? k + 1 : k;
}

/* Whether boxes side[0] x ... x side[3] have floor(N / boxes) or one more of the N numbers each, as N successive points of Halton's sequence do. */
static int shared(uint32_t n, const uint32_t *side)
{
    static uint32_t hits[MOST];
    uint32_t boxes = side[0] * side[1] * side[2] * side[3], wrong = 0;

    memset(hits, 0, boxes * sizeof *hits);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t box = 0;

        for (uint32_t k = 0; k < 4; k++)
            box = box * side[k] + (side[k] > 1 ? interval(u[k][i], side[k]) : 0);
        hits[box]++;
    }
    for (uint32_t c = 0; c < boxes; c++)
        wrong += hits[c] != n / boxes && hits[c] != n / boxes + (n % boxes > 0);
    return wrong == 0;
}

static void test_boxes(void)
{
    static const uint32_t counts[] = {1, 2, 3, 5, 6, 7, 9, 16, 27, 36, 49, 100, 125, 210, 343, 1000, 1024, 2310, 8820};
    static const uint32_t firsts[] = {0, 2, 8, 12, 16, 20, 24, 28};
    uint32_t sets = 0, wrong[3] = {0};

    for (uint32_t g = 0; g < sizeof firsts / sizeof *firsts; g++)
        for (uint32_t c = 0; c < 2 * sizeof counts / sizeof *counts; c++) {
            uint32_t n = counts[c / 2], size = firsts[g] < 8 ? 2 : 4, of = c % 2 ? 8820 : n;

            while (of > n && n & (n - 1)) /* of more samples, the first power of two */
                n &= n - 1;
            for (uint32_t i = 0; i < n; i++)
                set(i, 11 + c, i, of, g);
            fill(n, firsts[g], size);
            sets++;
            for (uint32_t k = 0; k < size; k++)
                for (uint32_t side = base[k]; side <= base[k] * n && side <= MOST; side *= base[k]) {
                    uint32_t sides[4] = {1, 1, 1, 1};

                    sides[k] = side;
                    wrong[0] += !shared(n, sides);
                }
            for (uint32_t a = 2; a <= 16; a *= 2)
                for (uint32_t b = 3; b <= 81; b *= 3)
                    wrong[1] += !shared(n, (uint32_t[]){a, b, 1, 1});
            if (size == 4)
                wrong[2] += !shared(n, (uint32_t[]){1, 3, 5, 1}) + !shared(n, (uint32_t[]){1, 1, 5, 7}) + !shared(n, (uint32_t[]){2, 3, 5, 7}) +
                            !shared(n, (uint32_t[]){4, 9, 5, 7});
        }
    ok(wrong[0] + wrong[1] + wrong[2] == 0, "isa %u: in %u sets of samples, intervals, boxes of two and of four dimensions hold their shares (%u, %u, %u not)",
       isa, sets, wrong[0], wrong[1], wrong[2]);
}

/*
 * The variance of the mean of (x - 1/2)(y - 1/2), x in base p and y in base q, over the first N points with nested uniform scrambles: 1/N^2 times
 * the sum over all pairs (i, j) of K_p(i - j) K_q(i - j). K_p(d) is the covariance of two x's whose first v digits are alike, p^v being
 * the largest power that divides d: given those digits the next two differ; 1/12 (1 - p^-2v - p^-2(v + 1) (p + 1)), and 1/12 for d = 0. (Check: for
 * N = p points, 1 / (12 N^3) as for a sample in each of N intervals.) q = 0: of x - 1/2 alone.
 */
static double covariance(uint32_t p, uint32_t d)
{
    double square = 1;

    if (p == 0)
        return 1;
    if (d == 0)
        return 1.0 / 12;
    for (; d % p == 0; d /= p)
        square /= p * p;
    return (1 - square - square / (p * p) * (p + 1)) / 12;
}

static double expected(uint32_t p, uint32_t q, uint32_t n)
{
    double sum = n * covariance(p, 0) * covariance(q, 0);

    for (uint32_t d = 1; d < n; d++)
        sum += 2.0 * (n - d) * covariance(p, d) * covariance(q, d);
    return sum / n / n;
}

struct measured {
    double mean, mean_error, variance, error;
};

/* Of dimensions first + a and first + b (a alone where they are the same), from so many pixels; the errors from the fourth moments. */
static struct measured measure(uint32_t n, uint32_t first, uint32_t a, uint32_t b, uint32_t pixels)
{
    uint32_t chunk = MOST / n, done;
    double sum = 0, second = 0, fourth = 0;

    for (done = 0; done < pixels; done += chunk) {
        for (uint32_t i = 0; i < chunk * n; i++)
            set(i, 100000 * n + done + i / n, i % n, n, 3);
        fill(chunk * n, first, (a > b ? a : b) + 1);
        for (uint32_t p = 0; p < chunk; p++) {
            double mean = 0;

            for (uint32_t i = p * n; i < (p + 1) * n; i++)
                mean += (u[a][i] - 0.5) * (a != b ? u[b][i] - 0.5 : 1);
            mean /= n;
            sum += mean, second += mean * mean, fourth += mean * mean * mean * mean;
        }
    }
    sum /= done, second /= done, fourth /= done;
    return (struct measured){sum, sqrt(second / done), second, sqrt((fourth - second * second) / done)};
}

static void test_variance(void)
{
    static const uint32_t counts[] = {2, 3, 4, 5, 6, 7, 9, 12, 25, 30, 36, 64, 100};
    static const uint32_t pairs[][3] = {{0, 0, 1}, {2, 1, 0}, {8, 0, 0}, {8, 0, 1}, {8, 1, 1}, {8, 2, 2}, {8, 3, 3}, {8, 1, 2}, {8, 2, 3}, {24, 0, 3}};
    double worst = 0, worst_mean = 0;
    uint32_t coarse = 0;

    for (uint32_t c = 0; c < sizeof counts / sizeof *counts; c++)
        for (uint32_t q = 0; q < sizeof pairs / sizeof *pairs; q++) {
            uint32_t a = pairs[q][1], b = pairs[q][2];
            struct measured at = measure(counts[c], pairs[q][0], a, b, counts[c] < 20 ? 8192 : 6000);

            worst = fmax(worst, fabs(at.variance - expected(base[a], a == b ? 0 : base[b], counts[c])) / at.error);
            worst_mean = fmax(worst_mean, fabs(at.mean) / at.mean_error);
            coarse += at.error > 0.03 * at.variance;
        }
    ok(worst <= 4 && coarse == 0, "isa %u: variances are those of nested scrambles, for any number of samples (worst z %.2f)", isa, worst);
    ok(worst_mean <= 4, "isa %u: means are unbiased (worst z %.2f)", isa, worst_mean);
}

/*
 * The rate, by least squares over log N: about N^-2 for any N (here 4 ... 256), as the sequence in two bases is nowhere quite a net, and faster for the
 * powers of 6 in bases 2 and 3.
 */
static void test_rate(uint32_t k, const uint32_t *n, uint32_t count, double limit)
{
    double slope = 0, error = 0, mean = 0, square = 0;

    for (uint32_t c = 0; c < count; c++)
        mean += log(n[c]) / count, square += log(n[c]) * log(n[c]);
    square -= count * mean * mean;
    for (uint32_t c = 0; c < count; c++) {
        struct measured at = measure(n[c], 8, k, k + 1, 4096);

        slope += (log(n[c]) - mean) / square * log(at.variance);
        error += pow((log(n[c]) - mean) / square * at.error / at.variance, 2);
    }
    ok(slope + 4 * sqrt(error) < limit, "isa %u: bases %u and %u, %u to %u samples: the variance of a product falls as N^%.3f +- %.3f", isa, base[k],
       base[k + 1], n[0], n[count - 1], slope, sqrt(error));
}

static void test(void)
{
    if (isa == MCR_ISA_BASELINE) { /* the same bits elsewhere */
        test_boxes();
        test_variance();
        test_rate(0, (uint32_t[]){4, 8, 16, 32, 64, 128, 256}, 7, -1.85);
        test_rate(1, (uint32_t[]){4, 8, 16, 32, 64, 128, 256}, 7, -1.85);
        test_rate(0, (uint32_t[]){6, 36, 216}, 3, -2.2);
        test_gains(0.95, 1.2);
    }
}

int main(void)
{
    return run("halton", test);
}
