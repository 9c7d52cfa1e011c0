/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What every source of correlated numbers that supplies all dimensions must be: uniform, independent where it is to be, the same bits for each lane by
 * itself and for each instruction set. A pixel has groups of 2 dimensions below 8 and of 4 from there on. Fixed keys: every result is a constant, the
 * limits are those of a fresh sample, |z| <= 4.
 */
#ifndef TESTS_PLUGINS_NUMBERS_H
#define TESTS_PLUGINS_NUMBERS_H

#include "stand_in.h"


#define MOST 65536u
#define DIMENSIONS 16u

static struct mcr_context context;
static const struct mcr_numbers_plugin *plugin;
static uint32_t isa;
static void *instance;
static double *u[DIMENSIONS];
static uint64_t pixel_key[MOST], path_key[MOST];
static uint32_t sample[MOST], planned[MOST], bounce[MOST], pixel_x[MOST], pixel_y[MOST];
static uint64_t replicate_key;

/* Pixels are far apart: no source may make them depend on each other. */
static void set(uint32_t lane, uint64_t pixel, uint32_t number, uint32_t of, uint32_t at)
{
    pixel_key[lane] = mcr_pixel_key(replicate_key, pixel);
    pixel_x[lane] = (uint32_t)pixel << 8;
    pixel_y[lane] = (uint32_t)(pixel >> 24);
    path_key[lane] = mcr_path_key(pixel_key[lane], number);
    sample[lane] = number;
    planned[lane] = of;
    bounce[lane] = at;
}

/* Dimensions first + k into u[k]. */
static void fill(uint32_t lanes, uint32_t first, uint32_t count)
{
    struct mcr_samples samples = {.size = sizeof samples, .n = lanes, .pixel_key = pixel_key, .path_key = path_key,
                                  .index = sample, .planned = planned, .bounce = bounce,
                                  .x = pixel_x, .y = pixel_y, .replicate_key = replicate_key};

    if (plugin->fill(&stand_in, &context, instance, &samples, first, count, u) != MCR_OK) {
        printf("Bail out! fill failed\n");
        exit(99);
    }
}

/* z of a chi-square of `df` degrees of freedom (Wilson and Hilferty 1931). */
static double deviate(double chi, double df)
{
    return (cbrt(chi / df) - (1 - 2 / (9 * df))) / sqrt(2 / (9 * df));
}

/* Boxes of 2^-k x 2^-(boxes-k), for any k, that do not hold as many of the 2^m points as every other: none in a (m - boxes, m, 2)-net. */
static __attribute__((unused)) uint32_t uneven(const double *a, const double *b, uint32_t m, uint32_t boxes)
{
    static uint32_t hits[MOST];
    uint32_t wrong = 0;

    for (uint32_t k = 0; k <= boxes; k++) {
        memset(hits, 0, sizeof *hits << boxes);
        for (uint32_t i = 0; i < 1u << m; i++)
            hits[((uint32_t)ldexp(a[i], (int)k) << (boxes - k)) + (uint32_t)ldexp(b[i], (int)(boxes - k))]++;
        for (uint32_t c = 0; c < 1u << boxes; c++)
            wrong += hits[c] != 1u << (m - boxes);
    }
    return wrong;
}

/* One sample of many pixels: uniform, alone and with its neighbour in the group; bits 33 to 53 too. Two samples: any two in the first 2^m. */
static void test_uniform(uint32_t number, uint32_t of, uint32_t first)
{
    static uint32_t one[4][256], two[3][16][16], behind[256];
    double chi = 0, z, worst = 0, expected = MOST / 256.0;

    memset(one, 0, sizeof one), memset(two, 0, sizeof two), memset(behind, 0, sizeof behind);
    for (uint32_t i = 0; i < MOST; i++)
        set(i, i, number, of, 2);
    fill(MOST, first, first < 8 ? 2 : 4);
    for (uint32_t i = 0; i < MOST; i++) {
        uint32_t count = first < 8 ? 2 : 4;

        for (uint32_t k = 0; k < count; k++)
            one[k][(uint32_t)(u[k][i] * 256)]++;
        for (uint32_t k = 0; k + 1 < count; k++)
            two[k][(uint32_t)(u[k][i] * 16)][(uint32_t)(u[k + 1][i] * 16)]++;
        behind[(uint32_t)(ldexp(u[0][i], 40) - floor(ldexp(u[0][i], 32)) * 256)]++;
    }
    for (uint32_t k = 0; k < (first < 8 ? 4u : 8u); k++) {
        const uint32_t *hits = k == 0 ? behind : k <= 3 && first < 8 ? (k < 3 ? one[k - 1] : two[0][0]) : k <= 4 ? one[k - 1] : two[k - 5][0];

        chi = 0;
        for (uint32_t c = 0; c < 256; c++)
            chi += (hits[c] - expected) * (hits[c] - expected) / expected;
        z = deviate(chi, 255);
        worst = fmax(worst, fabs(z));
    }
    ok(worst <= 4, "isa %u: sample %u of %u is uniform over pixels, from dimension %u (worst z %.2f)", isa, number, of, first, worst);
}

/*
 * No dimension repeats along the path, no pixel repeats another, no replicate either. 16 samples in each of 4096 pixels; any two dimensions
 * of different groups or bounces: in each pixel, the sums over samples of (u - 1/2)(v - 1/2) and of the 49 products of Walsh functions of
 * their first 3 bits. All are to be 0 on average; errors from the pixels' own, as samples of a pixel depend on each other.
 */
static double worst_chi, worst_linear;

static void compare(const double *a, const double *b)
{
    double chi = 0, linear = 0, squares = 0, walsh[64] = {0}, walsh_squares[64] = {0};
    uint32_t functions = 0;

    for (uint32_t pixel = 0; pixel < MOST / 16; pixel++) {
        double sum = 0;
        int cells[64] = {0};

        for (uint32_t i = pixel * 16; i < pixel * 16 + 16; i++) {
            cells[(uint32_t)(a[i] * 8) * 8 + (uint32_t)(b[i] * 8)]++;
            sum += (a[i] - 0.5) * (b[i] - 0.5);
        }
        linear += sum, squares += sum * sum;
        for (uint32_t step = 1; step < 64; step *= 2) /* the Walsh-Hadamard transform */
            for (uint32_t c = 0; c < 64; c++)
                if (!(c & step)) {
                    int x = cells[c], y = cells[c + step];
                    cells[c] = x + y, cells[c + step] = x - y;
                }
        for (uint32_t c = 0; c < 64; c++)
            walsh[c] += cells[c], walsh_squares[c] += cells[c] * cells[c];
    }
    for (uint32_t c = 0; c < 64; c++)
        if (c / 8 && c % 8 && walsh_squares[c] > 0) /* pairs u, 1 - u have no odd products */
            chi += walsh[c] * walsh[c] / walsh_squares[c], functions++;
    worst_chi = fmax(worst_chi, fabs(deviate(chi, functions)));
    worst_linear = fmax(worst_linear, fabs(linear) / sqrt(squares));
}

static void test_path(void)
{
    static const struct {
        uint32_t bounce, first, k;
    } taken[] = {{0, 0, 0}, {0, 0, 1}, {0, 2, 0},  {0, 2, 1},  {0, 8, 0}, {0, 8, 1},  {0, 8, 2},  {0, 8, 4},  {0, 8, 9},
                 {0, 8, 15}, {0, 24, 0}, {0, 28, 1}, {0, 32, 0}, {1, 8, 0}, {1, 8, 1},  {1, 8, 3},  {1, 8, 5},  {1, 24, 1},
                 {1, 32, 0}, {2, 8, 0}, {2, 8, 1}, {7, 8, 0},  {7, 8, 2},  {31, 8, 0}, {31, 8, 3}, {100, 8, 1}};
    const uint32_t count = sizeof taken / sizeof *taken;
    double *kept[sizeof taken / sizeof *taken];
    uint32_t pairs = 0;

    worst_chi = worst_linear = 0;
    for (uint32_t t = 0; t < count; t++) {
        kept[t] = array(MOST);
        for (uint32_t i = 0; i < MOST; i++)
            set(i, i / 16, i % 16, 16, taken[t].bounce);
        fill(MOST, taken[t].first, taken[t].first < 8 ? 2 : taken[t].first == 8 ? 16 : 4);
        memcpy(kept[t], u[taken[t].k], MOST * sizeof(double));
        for (uint32_t s = 0; s < t; s++) {
            uint32_t a = taken[s].first + taken[s].k, b = taken[t].first + taken[t].k;

            if (taken[s].bounce == taken[t].bounce && a / (a < 8 ? 2 : 4) == b / (b < 8 ? 2 : 4))
                continue;
            compare(kept[s], kept[t]);
            pairs++;
        }
    }
    ok(pairs > 300 && worst_chi <= 4 && worst_linear <= 4, "isa %u: %u pairs of dimensions along a path are independent (worst z %.2f, %.2f)", isa,
       pairs, worst_chi, worst_linear);

    worst_chi = worst_linear = 0;
    for (uint32_t far = 1; far <= 1000; far *= 10) { /* neighbours, and those below in pictures of these widths; sample by sample */
        for (uint32_t i = 0; i < MOST; i++)
            set(i, i / 16 + far, i % 16, 16, 0);
        fill(MOST, 0, 2);
        compare(kept[0], u[0]);
        compare(kept[1], u[1]);
        compare(kept[0], u[1]);
    }
    replicate_key = mcr_replicate_key(7, 1);
    for (uint32_t i = 0; i < MOST; i++)
        set(i, i / 16, i % 16, 16, 0);
    fill(MOST, 0, 2);
    compare(kept[0], u[0]);
    compare(kept[1], u[1]);
    replicate_key = mcr_replicate_key(7, 0);
    ok(worst_chi <= 4 && worst_linear <= 4, "isa %u: pixels and replicates are independent (worst z %.2f, %.2f)", isa, worst_chi, worst_linear);
    for (uint32_t t = 0; t < count; t++)
        free(kept[t]);
}

/* A lane's number does not depend on the others, nor on what else is asked for. */
static void test_lanes(void)
{
    const uint32_t lanes = 700;
    double *all[DIMENSIONS];
    uint32_t wrong = 0;

    for (uint32_t i = 0; i < lanes; i++) {
        uint32_t of = (uint32_t)(1 + 300 * fixed(50, i / 7));
        set(i, i % 13, i % of, of, i % 5);
    }
    fill(lanes, 8, DIMENSIONS);
    for (uint32_t k = 0; k < DIMENSIONS; k++) {
        all[k] = array(lanes);
        memcpy(all[k], u[k], lanes * sizeof(double));
    }
    for (uint32_t first = 0; first < DIMENSIONS; first++) {
        fill(lanes, 8 + first, first < 12 ? 3 : 1);
        for (uint32_t i = 0; i < lanes; i++)
            wrong += u[0][i] != all[first][i] || (first < 12 && u[2][i] != all[first + 2][i]);
    }
    for (uint32_t i = 0; i < lanes; i++) {
        uint32_t of = (uint32_t)(1 + 300 * fixed(50, i / 7));
        set(0, i % 13, i % of, of, i % 5);
        fill(1, 8, DIMENSIONS);
        for (uint32_t k = 0; k < DIMENSIONS; k++)
            wrong += u[k][0] != all[k][i];
    }
    ok(wrong == 0, "isa %u: a lane's number depends on its pixel, sample and dimension alone", isa);
    for (uint32_t k = 0; k < DIMENSIONS; k++)
        free(all[k]);
}

/* Counts near the limits of 32 bits: in [0, 1), no two samples alike. */
static void test_large(void)
{
    static const uint32_t counts[] = {1u << 20, 1u << 31, (1u << 31) + 1, UINT32_MAX};
    uint32_t wrong = 0;

    for (uint32_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        for (uint32_t i = 0; i < 1000; i++)
            set(i, 9, i < 500 ? i : counts[c] - 1 - (i - 500), counts[c], UINT32_MAX);
        fill(1000, 8, 4);
        for (uint32_t k = 0; k < 4; k++)
            for (uint32_t i = 0; i < 1000; i++) {
                wrong += !(u[k][i] >= 0 && u[k][i] < 1);
                for (uint32_t j = 0; j < i; j++)
                    wrong += u[k][i] == u[k][j];
            }
    }
    ok(wrong == 0, "isa %u: up to 2^32 - 1 samples", isa);
}

static uint64_t bits_of(void)
{
    uint64_t sum = 0;

    for (uint32_t first = 0; first <= 8; first += 4) {
        for (uint32_t i = 0; i < 5000; i++)
            set(i, i / 97, i % 97, 97, i % 50);
        fill(5000, first, first < 8 ? 2 : DIMENSIONS);
        for (uint32_t k = 0; k < (first < 8 ? 2 : DIMENSIONS); k++)
            for (uint32_t i = 0; i < 5000; i++)
                sum = mcr_mix64(sum + mcr_bits(u[k][i]) + k);
    }
    return sum;
}

/*
 * What two groups do together has about the variance that independent numbers would give it, 1 / (144 N) for the product. The error of the ratio, from
 * 16384 pixels, is about .013.
 */
static __attribute__((unused)) void test_gains(double low, double high)
{
    static const uint32_t pairs[][4] = {{0, 0, 2, 0}, {0, 0, 8, 0}, {0, 1, 8, 1}, {8, 0, 12, 0}, {8, 2, 24, 3}, {8, 0, 16, 1}};
    const uint32_t n = 64, pixels = 16384, count = sizeof pairs / sizeof *pairs;
    double second[sizeof pairs / sizeof *pairs] = {0}, worst = 0, least = INFINITY, *kept = array(MOST);

    for (uint32_t done = 0; done < pixels; done += MOST / n) {
        for (uint32_t i = 0; i < MOST; i++)
            set(i, done + i / n, i % n, n, 0);
        for (uint32_t q = 0; q < count; q++) {
            fill(MOST, pairs[q][0], pairs[q][1] + 1);
            memcpy(kept, u[pairs[q][1]], MOST * sizeof *kept);
            fill(MOST, pairs[q][2], pairs[q][3] + 1);
            for (uint32_t p = 0; p < MOST / n; p++) {
                double sum = 0;

                for (uint32_t i = p * n; i < (p + 1) * n; i++)
                    sum += (kept[i] - 0.5) * (u[pairs[q][3]][i] - 0.5);
                second[q] += sum * sum / n;
            }
        }
    }
    for (uint32_t q = 0; q < count; q++)
        worst = fmax(worst, second[q] / pixels * 144), least = fmin(least, second[q] / pixels * 144);
    ok(worst < high && least > low, "isa %u: two groups together have %.3f to %.3f of the variance of independent numbers", isa, least, worst);
    free(kept);
}

/* The whole test of a source; `more` is called for each instruction set. */
static __attribute__((unused)) int run(const char *word, void (*more)(void))
{
    const struct mcr_plugin *file = load(word);
    double zero[3] = {0};
    struct mcr_values values = {.size = sizeof values, .count = 1, .number = zero};
    struct mcr_creation with = {.size = sizeof with, .values = &values, .spp = 16};
    uint64_t first_bits = 0;

    replicate_key = mcr_replicate_key(7, 0);
    for (uint32_t k = 0; k < DIMENSIONS; k++)
        u[k] = array(MOST);
    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        plugin = descriptor_of(file, isa);
        if (!plugin) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        ok(plugin->create(&stand_in, &context, &with, &instance) == MCR_OK && plugin->correlated(instance) == 1 &&
               plugin->supplies(instance, 0, 2) == 2 && plugin->supplies(instance, 2, 2) == 2 && plugin->supplies(instance, 8, 16) == 16 &&
               plugin->supplies(instance, 32, 1) == 1,
           "isa %u: supplies all, correlated", isa);
        ok(first_bits == 0 || bits_of() == first_bits, "isa %u: the bits of the baseline", isa);
        first_bits = bits_of();
        test_lanes();
        more();
        if (isa == MCR_ISA_BASELINE) { /* the same bits elsewhere */
            test_uniform(0, 1, 0);
            test_uniform(5, 16, 8);
            test_uniform(1000, 1024, 20);
            test_uniform(2, 3, 8);
            test_path();
            test_large();
        }
        if (plugin->destroy)
            plugin->destroy(instance);
    }
    for (uint32_t k = 0; k < DIMENSIONS; k++)
        free(u[k]);
    return tap_done();
}

#endif
