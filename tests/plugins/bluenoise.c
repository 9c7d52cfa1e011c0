/* SPDX-License-Identifier: Apache-2.0 */
/*
 * bluenoise: the points of a pixel and of blocks of pixels are nets, and errors of neighbouring pixels cancel: the spectrum of the error and what
 * remains of it when the picture is blurred, against sobol and independent numbers. (Uniformity, independence and the rest: numbers.h.)
 */
#include "numbers.h"

/* Lanes of the pixels of a block that begins at (x, y). */
static uint32_t block(uint32_t x, uint32_t y, uint32_t side, uint32_t n)
{
    for (uint32_t i = 0; i < side * side * n; i++) {
        uint32_t px = x + i / n % side, py = y + i / n / side;

        set(i, (uint64_t)py * 65536 + px, i % n, n, 1);
        pixel_x[i] = px;
        pixel_y[i] = py;
    }
    return side * side * n;
}

/*
 * 2^m samples in 2^k x 2^k pixels: a (0, m + 2k, 2)-net in the first two dimensions of every group. And any number of them in 16 x 16 pixels or in all of
 * a tile: each interval of 1/256 or 1/65536 has one sample for each that a pixel has.
 */
static void test_nets(void)
{
    static const uint32_t firsts[] = {0, 2, 8, 12, 24, 32};
    uint32_t wrong = 0, wrong_one = 0, nets = 0;

    for (uint32_t g = 0; g < sizeof firsts / sizeof *firsts; g++)
        for (uint32_t m = 0; m <= 5; m++)
            for (uint32_t k = 0; k <= 4; k++) {
                block(37u << k, 21u << k, 1u << k, 1u << m);
                fill(1u << (m + 2 * k), firsts[g], 2);
                wrong += uneven(u[0], u[1], m + 2 * k, m + 2 * k);
                nets++;
            }
    ok(wrong == 0, "isa %u: the samples of %u pixels and blocks of pixels have one in each elementary box (%u not)", isa, nets, wrong);
    for (uint32_t n = 1; n <= 40; n += 3)
        for (uint32_t first = 0; first <= 8; first += 8) {
            static uint32_t hits[4][256];
            uint32_t lanes = block(48, 528, 16, n), count = first < 8 ? 2 : 4;

            memset(hits, 0, sizeof hits);
            fill(lanes, first, count);
            for (uint32_t k = 0; k < count; k++) {
                for (uint32_t i = 0; i < lanes; i++)
                    hits[k][(uint32_t)(u[k][i] * 256)]++;
                for (uint32_t c = 0; c < 256; c++)
                    wrong_one += hits[k][c] != n;
            }
        }
    for (uint32_t k = 0; k < 2; k++) {
        static uint32_t hits[MOST];

        block(256, 512, 256, 1);
        fill(MOST, 8, 2);
        memset(hits, 0, sizeof hits);
        for (uint32_t i = 0; i < MOST; i++)
            wrong_one += hits[(uint32_t)(u[k][i] * MOST)]++;
    }
    ok(wrong_one == 0, "isa %u: any number of samples in 16 x 16 pixels, and one in a tile, are as many in each interval (%u not)", isa, wrong_one);
}

/* ---- The spectrum ---- */

#define SIDE 64u
#define PIXELS (SIDE * SIDE)
#define SEEDS 24u
#define LOW 6 /* frequencies up to 6 / 64 of a period per pixel */

/* Smooth in two dimensions; an edge; all of a path's first dimensions: pixel, sampler and light. With their means. */
static double smooth(uint32_t i)
{
    return (0.5 + u[0][i]) * exp(u[1][i]) - (M_E - 1);
}

static double edge(uint32_t i)
{
    return (u[0][i] + 0.5 * u[1][i] < 0.6) - 0.35;
}

static double path(uint32_t i)
{
    return (0.5 + u[0][i]) * (0.5 + u[1][i]) * (1.5 - u[2][i]) * (0.5 + u[3][i]) * (0.25 + 1.5 * u[4][i] * u[4][i] * (1 + u[5][i] - 0.5)) - 0.75;
}

struct found {
    double mean, square, low, blurred; /* of the error; its power at low frequencies, all but 0, and after a blur: per pixel */
};

/* The share of a picture's squares that lies in the low frequencies, times how many there are in all over how many are low: 1 for white noise. */
static double low_power(const double *error)
{
    double sum = 0, cosine[SIDE], sine[SIDE];
    uint32_t count = 0;

    for (uint32_t k = 0; k < SIDE; k++)
        cosine[k] = cos(2 * M_PI * k / SIDE), sine[k] = sin(2 * M_PI * k / SIDE);
    for (int fx = 0; fx <= LOW; fx++)
        for (int fy = fx ? -LOW : 1; fy <= LOW; fy++) {
            double re = 0, im = 0;

            if (fx * fx + fy * fy > LOW * LOW)
                continue;
            for (uint32_t p = 0; p < PIXELS; p++) {
                uint32_t phase = (uint32_t)(fx * (int)(p % SIDE) + fy * (int)(p / SIDE)) % SIDE;

                re += error[p] * cosine[phase];
                im += error[p] * sine[phase];
            }
            sum += (re * re + im * im) / PIXELS;
            count++;
        }
    return sum / count;
}

/* The mean square of the error behind a Gaussian of 1.5 pixels, around the edges. */
static double blurred_square(const double *error)
{
    static double half[PIXELS];
    double weight[9], total = 0, sum = 0;

    for (int d = -4; d <= 4; d++)
        total += weight[d + 4] = exp(-d * d / (2 * 1.5 * 1.5));
    for (uint32_t p = 0; p < PIXELS; p++) {
        half[p] = 0;
        for (uint32_t d = 0; d < 9; d++)
            half[p] += weight[d] / total * error[p / SIDE * SIDE + (p + SIDE + d - 4) % SIDE];
    }
    for (uint32_t p = 0; p < PIXELS; p++) {
        double value = 0;

        for (uint32_t d = 0; d < 9; d++)
            value += weight[d] / total * half[(p + (SIDE + d - 4) * SIDE) % PIXELS];
        sum += value * value / PIXELS;
    }
    return sum;
}

/* One picture of N samples a pixel, at a place of its own. */
static struct found picture(uint32_t n, uint32_t seed, double (*f)(uint32_t))
{
    static double error[PIXELS];
    struct found found = {0};
    uint32_t lanes;

    replicate_key = mcr_replicate_key(1000 + seed, 0);
    lanes = block(64 * (seed % 7), 64 * (seed / 7), SIDE, n);
    if (f == path) {
        double *after[DIMENSIONS];

        memcpy(after, u, sizeof u); /* pixel into 0 and 1, sampler 2 and 3, light 4 and 5 */
        fill(lanes, 0, 2);
        memcpy(u, after + 2, (DIMENSIONS - 2) * sizeof *u);
        fill(lanes, 8, 2);
        memcpy(u, after + 4, (DIMENSIONS - 4) * sizeof *u);
        fill(lanes, 24, 2);
        memcpy(u, after, sizeof u);
    } else {
        fill(lanes, 8, 2);
    }
    for (uint32_t p = 0; p < PIXELS; p++) {
        error[p] = 0;
        for (uint32_t i = p * n; i < (p + 1) * n; i++)
            error[p] += f(i) / n;
        found.mean += error[p] / PIXELS;
        found.square += error[p] * error[p] / PIXELS;
    }
    found.low = low_power(error);
    found.blurred = blurred_square(error);
    replicate_key = mcr_replicate_key(7, 0);
    return found;
}

struct series {
    double low, low_error, blurred, blurred_error, square, mean, mean_error;
};

static struct series measure(const char *word, uint32_t n, double (*f)(uint32_t))
{
    const struct mcr_numbers_plugin *was = plugin;
    void *instance_was = instance;
    struct mcr_values values = {.size = sizeof values};
    struct mcr_creation with = {.size = sizeof with, .values = &values, .spp = n};
    struct series s = {0};
    double low2 = 0, blurred2 = 0, mean2 = 0;

    plugin = descriptor_of(load(word), isa);
    plugin->create(&stand_in, &context, &with, &instance);
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        struct found at = picture(n, seed, f);

        s.low += at.low / SEEDS, low2 += at.low * at.low / SEEDS;
        s.blurred += at.blurred / SEEDS, blurred2 += at.blurred * at.blurred / SEEDS;
        s.mean += at.mean / SEEDS, mean2 += at.mean * at.mean / SEEDS;
        s.square += at.square / SEEDS;
    }
    s.low_error = sqrt((low2 - s.low * s.low) / (SEEDS - 1));
    s.blurred_error = sqrt((blurred2 - s.blurred * s.blurred) / (SEEDS - 1));
    s.mean_error = sqrt((mean2 - s.mean * s.mean) / (SEEDS - 1));
    if (plugin->destroy)
        plugin->destroy(instance);
    plugin = was;
    instance = instance_was;
    return s;
}

/* Less than `limit` times the other's, by 4 standard errors. */
static int below(double a, double a_error, double b, double b_error, double limit)
{
    return a - limit * b < -4 * sqrt(a_error * a_error + limit * limit * b_error * b_error);
}

/*
 * Low frequencies, and the square behind a blur, which is little else: below a half of sobol's and of independent numbers' for what is smooth, .75 for
 * an edge and .85 for what takes three groups together; they are far below that but for 4 samples, of which sobol makes much already. The power of
 * independent numbers is what their square tells, which shows that this measures.
 */
static void test_spectrum(void)
{
    double (*const functions[])(uint32_t) = {smooth, edge, path};
    static const char *const name[] = {"a smooth function", "an edge", "a path"};
    static const double limit[] = {0.5, 0.75, 0.85};

    for (uint32_t f = 0; f < 3; f++)
        for (uint32_t n = 1; n <= 4; n++) {
            struct series independent = measure("independent", n, functions[f]), sobol = measure("sobol", n, functions[f]);
            struct series blue = measure("bluenoise", n, functions[f]);

            ok(below(blue.low, blue.low_error, independent.low, independent.low_error, limit[f]) &&
                   below(blue.low, blue.low_error, sobol.low, sobol.low_error, limit[f]) &&
                   fabs(independent.low - independent.square) <= 4 * independent.low_error,
               "isa %u: %s, %u samples: low frequencies have %.3g +- %.1g of their power, with sobol %.3g +- %.1g, independent %.3g +- %.1g", isa, name[f], n,
               blue.low / independent.square, blue.low_error / independent.square, sobol.low / independent.square,
               sobol.low_error / independent.square, independent.low / independent.square, independent.low_error / independent.square);
            ok(below(blue.blurred, blue.blurred_error, independent.blurred, independent.blurred_error, limit[f]) &&
                   below(blue.blurred, blue.blurred_error, sobol.blurred, sobol.blurred_error, limit[f]),
               "isa %u: ... blurred, the MSE is %.3g of that of independent numbers, with sobol %.3g", isa, blue.blurred / independent.blurred,
               sobol.blurred / independent.blurred);
            ok(fabs(blue.mean) <= 4 * blue.mean_error && fabs(sobol.mean) <= 4 * sobol.mean_error && fabs(independent.mean) <= 4 * independent.mean_error,
               "isa %u: ... the mean is unbiased (z %.2f)", isa, blue.mean / blue.mean_error);
        }
}

static void test(void)
{
    test_nets();
    if (isa == MCR_ISA_BASELINE) { /* the same bits elsewhere */
        test_gains(0.95, 1.05);
        test_spectrum();
    }
}

int main(void)
{
    return run("bluenoise", test);
}
