/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The random numbers: exact conversion, known values, and statistics over the composed keys (pixel, sample, dimension, replicate,
 * seed). All inputs are fixed, so that a result is a constant; the limits are those of a fresh sample: |z| <= 4.
 */
#include "base/random.h"
#include "../tap.h"

#include <math.h>

static double number_of(uint64_t path_key, uint64_t dimension)
{
    return mcr_unit_double(mcr_dimension_bits(path_key, dimension));
}

static double number(uint64_t seed, uint64_t pixel, uint64_t replicate, uint64_t sample, uint64_t dimension)
{
    return number_of(mcr_path_key(mcr_pixel_key(mcr_replicate_key(seed, replicate), pixel), sample), dimension);
}

static void test_conversion(void)
{
    static const uint64_t edges[] = {0, 1, 0x7ff, 0x800, 0xfff, UINT64_MAX, UINT64_MAX - 0x7ff, UINT64_MAX - 0x800, UINT64_C(1) << 63,
                                     UINT64_C(1) << 43, (UINT64_C(1) << 43) - 1, (UINT64_C(1) << 42), UINT64_C(0xffffffff)};
    uint64_t wrong = 0;

    for (size_t i = 0; i < sizeof edges / sizeof *edges; i++)
        wrong += mcr_unit_double(edges[i]) != (double)(edges[i] >> 11) * 0x1p-53;
    for (uint64_t n = 0; n < 1000000; n++) {
        uint64_t x = mcr_mix64(n) >> (n & 63);
        wrong += mcr_unit_double(x) != (double)(x >> 11) * 0x1p-53;
    }
    ok(wrong == 0, "unit doubles are exactly the top 53 bits");
    ok(mcr_unit_double(UINT64_MAX) < 1.0 && mcr_unit_double(0) == 0.0, "unit doubles lie in [0, 1)");
}

/* The first outputs of splitmix64 from state 0 are published with it; they pin mix64 and golden. */
static void test_known(void)
{
    ok(mcr_dimension_bits(0, 0) == UINT64_C(0xe220a8397b1dcdaf) && mcr_dimension_bits(0, 1) == UINT64_C(0x6e789e6aa1b965f4) &&
           mcr_dimension_bits(0, 2) == UINT64_C(0x06c45d188009454f),
       "dimension bits are splitmix64 started at the path key");
    ok(mcr_number(0, 1) == (double)(UINT64_C(0x6e789e6aa1b965f4) >> 11) * 0x1p-53 && mcr_number(UINT64_MAX, 700) == number_of(UINT64_MAX, 700),
       "the plugins' mcr_number is the host's");
}

/* Chi-square of counts against equal expectation, as a normal deviate (Wilson and Hilferty 1931). */
static double deviate(const uint32_t *counts, uint32_t cells, double total)
{
    double expected = total / cells, chi = 0.0, degrees = cells - 1, scale = 2.0 / (9.0 * degrees);
    for (uint32_t i = 0; i < cells; i++)
        chi += (counts[i] - expected) * (counts[i] - expected) / expected;
    return (cbrt(chi / degrees) - (1.0 - scale)) / sqrt(scale);
}

/* Which of the five coordinates of a number runs, and from where. */
struct walk {
    const char *name;
    uint64_t step[5]; /* of seed, pixel, replicate, sample, dimension */
};

static const struct walk walks[] = {
    {"seeds", {1, 0, 0, 0, 0}},      {"pixels", {0, 1, 0, 0, 0}},    {"rows of 512", {0, 512, 0, 0, 0}},
    {"replicates", {0, 0, 1, 0, 0}}, {"samples", {0, 0, 0, 1, 0}},   {"dimensions", {0, 0, 0, 0, 1}},
    {"bounces", {0, 0, 0, 0, 32}},   {"diagonal", {1, 1, 1, 1, 1}},  {"high bits", {UINT64_C(1) << 40, 0, 0, UINT64_C(1) << 33, 0}},
};

static double step_number(const struct walk *walk, uint64_t n, uint64_t dimension)
{
    return number(7 + n * walk->step[0], 11 + n * walk->step[1], n * walk->step[2], n * walk->step[3], dimension + n * walk->step[4]);
}

#define COUNT 262144u

/* One number: 1024 cells of its top bits and 256 of its middle ones; two neighbours: 32 x 32 cells and their correlation. */
static void test_walk(const struct walk *walk)
{
    static uint32_t top[1024], middle[256], pair[1024];
    double previous = step_number(walk, COUNT, 5), product = 0.0, z[4];
    int good = 1;

    for (uint32_t i = 0; i < 1024; i++)
        top[i] = pair[i] = middle[i & 255] = 0;
    for (uint64_t n = 0; n < COUNT; n++) {
        double u = step_number(walk, n, 5), scaled = u * 0x1p30;
        top[(uint32_t)(u * 1024)]++;
        middle[(uint32_t)((scaled - floor(scaled)) * 256)]++;
        pair[(uint32_t)(u * 32) * 32 + (uint32_t)(previous * 32)]++;
        product += (u - 0.5) * (previous - 0.5);
        previous = u;
    }
    z[0] = deviate(top, 1024, COUNT);
    z[1] = deviate(middle, 256, COUNT);
    z[2] = deviate(pair, 1024, COUNT);
    z[3] = product * 12.0 / sqrt(COUNT); /* each factor has variance 1/12 */
    for (int i = 0; i < 4; i++)
        good &= fabs(z[i]) <= 4.0;
    ok(good, "along %s: z = %.2f (top bits), %.2f (middle bits), %.2f (pairs), %.2f (correlation)", walk->name, z[0], z[1], z[2], z[3]);
}

/* Four dimensions of a path that are used together, 6^4 cells over samples and pixels; and sums over paths: mean and variance. */
static void test_together(void)
{
    static uint32_t cells[1296];
    double sum = 0.0, squares = 0.0;

    for (uint64_t n = 0; n < COUNT; n++) {
        uint64_t key = mcr_path_key(mcr_pixel_key(mcr_replicate_key(1, 0), n >> 6), n & 63);
        uint32_t cell = 0;
        for (uint64_t d = 0; d < 4; d++) {
            double u = mcr_unit_double(mcr_dimension_bits(key, d));
            cell = cell * 6 + (uint32_t)(u * 6);
            sum += u - 0.5;
            squares += (u - 0.5) * (u - 0.5) - 1.0 / 12.0;
        }
        cells[cell]++;
    }
    /* variances: 1/12 and 1/80 - 1/144 = 1/180 */
    double z = deviate(cells, 1296, COUNT), mean = sum * sqrt(12.0 / (4.0 * COUNT)), spread = squares * sqrt(180.0 / (4.0 * COUNT));
    ok(fabs(z) <= 4.0 && fabs(mean) <= 4.0 && fabs(spread) <= 4.0, "four dimensions together: z = %.2f, mean %.2f, variance %.2f", z, mean, spread);
}

/* Avalanche: one bit of one coordinate flips each bit of the result in half of the cases. 64 bits x 2048 cases for each input bit. */
static void test_avalanche(void)
{
    double worst = 0.0;
    for (uint32_t coordinate = 0; coordinate < 5; coordinate++)
        for (uint32_t bit = 0; bit < 64; bit++) {
            uint32_t flipped = 0;
            for (uint64_t n = 0; n < 2048; n++) {
                uint64_t c[5] = {n, 3 * n, n & 15, n >> 3, n & 63}, a, b;
                a = mcr_dimension_bits(mcr_path_key(mcr_pixel_key(mcr_replicate_key(c[0], c[2]), c[1]), c[3]), c[4]);
                c[coordinate] ^= UINT64_C(1) << bit;
                b = mcr_dimension_bits(mcr_path_key(mcr_pixel_key(mcr_replicate_key(c[0], c[2]), c[1]), c[3]), c[4]);
                flipped += (uint32_t)__builtin_popcountll(a ^ b);
            }
            double z = (flipped - 65536.0) / sqrt(131072.0 / 4.0);
            worst = fabs(z) > fabs(worst) ? z : worst;
        }
    /* the largest of 320 */
    ok(fabs(worst) <= 4.0, "each input bit flips half of the output: worst z = %.2f of 320", worst);
}

int main(void)
{
    test_conversion();
    test_known();
    for (size_t i = 0; i < sizeof walks / sizeof *walks; i++)
        test_walk(&walks[i]);
    test_together();
    test_avalanche();
    return tap_done();
}
