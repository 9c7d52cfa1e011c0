/* SPDX-License-Identifier: Apache-2.0 */
/*
 * stratified: one sample in each cell, for every number of samples; the order of the cells; the places within them. Fixed keys:
 * every result is a constant, the limits are those of a fresh sample, |z| <= 4.
 */
#include "stand_in.h"

#define MOST 70000u

static struct mcr_context context;
static const struct mcr_numbers_plugin *plugin;
static uint32_t isa;
static double *x, *y;
static uint64_t pixel_key[MOST], path_key[MOST];
static uint32_t sample[MOST], planned[MOST], bounce[MOST];

static int floor_sqrt; /* what make() sets compat to */

static int32_t make(double n, double m, void **instance)
{
    double number[9] = {n, 0, 0, m, 0, 0, floor_sqrt};
    uint32_t given[3] = {1, 1, 1};
    struct mcr_values values = {sizeof values, 3, number, given};
    struct mcr_creation with = {.size = sizeof with, .values = &values, .spp = 16};

    context.message[0] = 0;
    return plugin->create(&stand_in, &context, &with, instance);
}

static void set(uint32_t lane, uint64_t pixel, uint32_t number, uint32_t of)
{
    pixel_key[lane] = mcr_pixel_key(mcr_replicate_key(7, 0), pixel);
    path_key[lane] = mcr_path_key(pixel_key[lane], number);
    sample[lane] = number;
    planned[lane] = of;
}

static void fill(void *instance, uint32_t lanes)
{
    struct mcr_samples samples = {.size = sizeof samples, .n = lanes, .pixel_key = pixel_key, .path_key = path_key,
                                  .index = sample, .planned = planned, .bounce = bounce};
    double *number[2] = {x, y};

    if (plugin->fill(&stand_in, &context, instance, &samples, 0, 2, number) != MCR_OK) {
        printf("Bail out! fill failed\n");
        exit(99);
    }
}

/* ---- which cell a number lies in; borders are c / count as doubles, as the plugin promises ---- */

static uint32_t between(double value, double cells, uint32_t step, uint32_t count)
{
    uint32_t c = (uint32_t)(value * (cells / step));

    c = c < count ? c : count - 1;
    while (value < (double)c * step / cells)
        c--;
    while (value >= (double)(c + 1) * step / cells)
        c++;
    return c;
}

/* Cells in a grid of n x m. */
static uint32_t grid_cell(double u, double v, uint32_t n, uint32_t m)
{
    return between(v, (double)n * m, n, m) * n + between(u, n, 1, n);
}

/* The shape that the plugin documents for N samples: a grid, or rows of one more and then rows of `columns`. */
static uint32_t automatic_cell(double u, double v, uint32_t cells)
{
    uint32_t rows = 0, columns, before = 0;

    for (uint32_t n = 1; n * n <= cells; n++)
        if (cells % n == 0 && cells / n <= 2 * n)
            rows = n;
    if (rows)
        return grid_cell(u, v, rows, cells / rows);
    while ((rows + 1) * (rows + 1) <= cells)
        rows++;
    for (uint32_t r = 0; r < rows; r++, before += columns) {
        columns = cells / rows + (r < cells % rows);
        if (v >= (double)before / cells && v < (double)(before + columns) / cells)
            return before + between(u, columns, 1, columns);
    }
    return UINT32_MAX;
}

static void test_automatic(void)
{
    static uint32_t hits[MOST];
    uint32_t wrong = 0, cases = 0;
    void *instance;

    make(0, 0, &instance);
    for (uint32_t cells = 1; cells <= 1100; cells = cells < 200 ? cells + 1 : cells + 100, cells = cells == 300 ? 997 : cells) {
        memset(hits, 0, cells * sizeof *hits);
        for (uint32_t i = 0; i < cells; i++)
            set(i, cells, i, cells);
        fill(instance, cells);
        for (uint32_t i = 0; i < cells; i++) {
            uint32_t c = automatic_cell(x[i], y[i], cells);
            wrong += !(x[i] >= 0 && x[i] < 1 && y[i] >= 0 && y[i] < 1) || c >= cells || hits[c]++;
        }
        cases++;
    }
    ok(wrong == 0 && cases > 200, "isa %u: one sample in each of N cells, %u values of N (%u wrong)", isa, cases, wrong);
    plugin->destroy(instance);
}

/* n x m given: sets of n * m samples, each one in each cell; what is left over, no two in one cell. */
static void test_given(uint32_t n, uint32_t m, uint32_t spp, uint32_t real_n, uint32_t real_m)
{
    static uint32_t hits[MOST];
    uint32_t cells = real_n * real_m, wrong = 0;
    void *instance;

    make(n, m, &instance);
    for (uint32_t i = 0; i < spp; i++)
        set(i, 3, i, spp);
    fill(instance, spp);
    for (uint32_t i = 0; i < spp; i++) {
        uint32_t c = grid_cell(x[i], y[i], real_n, real_m);

        if (i % cells == 0)
            memset(hits, 0, cells * sizeof *hits);
        wrong += !(x[i] >= 0 && x[i] < 1 && y[i] >= 0 && y[i] < 1) || c >= cells || hits[c]++;
    }
    ok(wrong == 0, "isa %u: n=%u m=%u: %u samples in sets of %u x %u", isa, n, m, spp, real_n, real_m);
    plugin->destroy(instance);
}

/* compat=floor-sqrt: the first samples, as many as the largest square number among them, are one in each of so many cells. */
static void test_floor_sqrt(uint32_t spp, uint32_t side)
{
    void *instance;

    floor_sqrt = 1;
    ok(make(4, 0, &instance) == MCR_E_INVALID && make(0, 4, &instance) == MCR_E_INVALID, "isa %u: floor-sqrt chooses n and m: %s", isa, context.message);
    test_given(0, 0, spp, side, side);
    floor_sqrt = 0;
}

/* z of a chi-square of `df` degrees of freedom (Wilson and Hilferty 1931). */
static double deviate(double chi, double df)
{
    return (cbrt(chi / df) - (1 - 2 / (9 * df))) / sqrt(2 / (9 * df));
}

/*
 * The order over many pixels: where sample 0 lies, and where a pair of samples lie, is uniform over the cells (pairs of different cells).
 * A set of pixels that follow each other, as in an image.
 */
static void test_order(uint32_t cells, uint32_t first, uint32_t second)
{
    static uint32_t single[64], pairs[64 * 64];
    const uint32_t pixels = 1 << 18, chunk = MOST / 2;
    double chi = 0, chi_pairs = 0, expected = (double)pixels / cells, expected_pair = (double)pixels / cells / (cells - 1), z, z_pairs;
    void *instance;

    make(0, 0, &instance);
    memset(single, 0, sizeof single);
    memset(pairs, 0, sizeof pairs);
    for (uint32_t done = 0; done < pixels; done += chunk) {
        uint32_t n = pixels - done < chunk ? pixels - done : chunk;

        for (uint32_t i = 0; i < n; i++) {
            set(2 * i, done + i, first, cells);
            set(2 * i + 1, done + i, second, cells);
        }
        fill(instance, 2 * n);
        for (uint32_t i = 0; i < n; i++) {
            uint32_t a = automatic_cell(x[2 * i], y[2 * i], cells), b = automatic_cell(x[2 * i + 1], y[2 * i + 1], cells);
            single[a]++;
            pairs[a * cells + b]++;
        }
    }
    for (uint32_t a = 0; a < cells; a++) {
        chi += (single[a] - expected) * (single[a] - expected) / expected;
        for (uint32_t b = 0; b < cells; b++)
            if (a != b)
                chi_pairs += (pairs[a * cells + b] - expected_pair) * (pairs[a * cells + b] - expected_pair) / expected_pair;
    }
    z = deviate(chi, cells - 1);
    z_pairs = deviate(chi_pairs, (double)cells * (cells - 1) - 1);
    ok(fabs(z) <= 4, "isa %u: %u cells: sample %u is uniform over the cells (z %.2f)", isa, cells, first, z);
    ok(fabs(z_pairs) <= 4, "isa %u: %u cells: samples %u and %u are uniform over pairs of cells (z %.2f)", isa, cells, first, second, z_pairs);
    plugin->destroy(instance);
}

/* Within the cells: uniform (mean 1/2, variance 1/12 of the place), and the numbers that `independent` gives where there is one cell. */
static void test_places(void)
{
    const uint32_t cells = 64 * 64;
    double sum[2] = {0}, square[2] = {0}, product = 0, worst = 0;
    uint32_t wrong = 0;
    void *instance;

    make(0, 0, &instance);
    for (uint32_t i = 0; i < cells; i++)
        set(i, 5, i, cells);
    fill(instance, cells);
    for (uint32_t i = 0; i < cells; i++) {
        double u = x[i] * 64 - floor(x[i] * 64) - 0.5, v = y[i] * 64 - floor(y[i] * 64) - 0.5;
        sum[0] += u, sum[1] += v, square[0] += u * u, square[1] += v * v, product += u * v;
    }
    for (int k = 0; k < 2; k++) {
        worst = fmax(worst, fabs(sum[k]) / sqrt(cells / 12.0));
        worst = fmax(worst, fabs(square[k] - cells / 12.0) / sqrt(cells / 180.0));
    }
    worst = fmax(worst, fabs(product) / sqrt(cells / 144.0));
    ok(worst <= 4, "isa %u: places within cells are uniform and uncorrelated (worst z %.2f)", isa, worst);
    for (uint32_t i = 0; i < 1000; i++)
        set(i, i, 0, 1);
    fill(instance, 1000);
    for (uint32_t i = 0; i < 1000; i++)
        wrong += x[i] != mcr_number(path_key[i], 0) || y[i] != mcr_number(path_key[i], 1);
    ok(wrong == 0, "isa %u: one sample of one is independent's", isa);
    plugin->destroy(instance);
}

/* The inverse of mcr_mix64. */
static uint64_t unmix(uint64_t x)
{
    uint64_t a = 1, b = 1;

    for (int k = 0; k < 6; k++) { /* Newton's iteration for inverses modulo 2^64 */
        a *= 2 - UINT64_C(0x94d049bb133111eb) * a;
        b *= 2 - UINT64_C(0xbf58476d1ce4e5b9) * b;
    }
    x = x ^ (x >> 31) ^ (x >> 62);
    x = a * x;
    x = x ^ (x >> 27) ^ (x >> 54);
    x = b * x;
    return x ^ (x >> 30) ^ (x >> 60);
}

/* The largest number there is, 1 - 2^-53, as place: it rounds to the end of most cells, and must not leave them. */
static void test_ends(void)
{
    static uint32_t hits[MOST];
    uint32_t wrong = 0;
    void *instance;

    make(0, 0, &instance);
    for (uint32_t cells = 1; cells <= 400; cells++)
        for (uint64_t dimension = 0; dimension < 2; dimension++) {
            memset(hits, 0, cells * sizeof *hits);
            for (uint32_t i = 0; i < cells; i++) {
                set(i, 1, i, cells);
                path_key[i] = unmix(UINT64_MAX) - (dimension + 1) * MCR_GOLDEN;
            }
            fill(instance, cells);
            for (uint32_t i = 0; i < cells; i++) {
                uint32_t c = automatic_cell(x[i], y[i], cells);
                wrong += !(x[i] >= 0 && x[i] < 1 && y[i] >= 0 && y[i] < 1) || c >= cells || hits[c]++;
            }
        }
    ok(wrong == 0 && mcr_number(unmix(UINT64_MAX) - MCR_GOLDEN, 0) == 1 - 0x1p-53, "isa %u: the largest number stays in its cell (%u left)", isa,
       wrong);
    plugin->destroy(instance);
}

/*
 * What it is for: the error of the mean of a function over the pixel. For f = x + y with N = 97 samples, independent variance is 1/6/N;
 * in cells it is below 1/6/N^2 * 2 or so. It must nowhere be above independent's, also for rows of unequal counts: checked at every N to
 * 40 with 512 pixels each; 4 standard deviations of a variance over 512 pixels are a factor of 1 + 4 sqrt(2/511) = 1.25.
 */
static void test_variance(void)
{
    uint32_t worse = 0;
    void *instance;

    make(0, 0, &instance);
    for (uint32_t cells = 1; cells <= 40; cells++) {
        double square = 0;

        for (uint32_t p = 0; p < 512; p++)
            for (uint32_t i = 0; i < cells; i++)
                set(p * cells + i, p, i, cells);
        fill(instance, 512 * cells);
        for (uint32_t p = 0; p < 512; p++) {
            double sum = 0;
            for (uint32_t i = 0; i < cells; i++)
                sum += x[p * cells + i] + y[p * cells + i] - 1;
            square += sum / cells * sum / cells;
        }
        worse += square / 512 > 1.25 / 6 / cells;
    }
    ok(worse == 0, "isa %u: variance is nowhere above that of independent numbers", isa);
    plugin->destroy(instance);
}

/* Lanes in any order, of several pixels and several counts, one at a time or together: a number depends on its lane alone. */
static void test_lanes(void)
{
    const uint32_t lanes = 700;
    double *one_x = array(lanes), *one_y = array(lanes);
    uint32_t wrong = 0;
    void *instance;

    make(0, 0, &instance);
    for (uint32_t i = 0; i < lanes; i++) {
        uint32_t of = (uint32_t)(1 + 300 * fixed(50, i / 7));
        set(0, i % 13, i % of, of);
        fill(instance, 1);
        one_x[i] = x[0], one_y[i] = y[0];
    }
    for (uint32_t i = 0; i < lanes; i++) {
        uint32_t of = (uint32_t)(1 + 300 * fixed(50, i / 7));
        set(i, i % 13, i % of, of);
    }
    fill(instance, lanes);
    for (uint32_t i = 0; i < lanes; i++)
        wrong += x[i] != one_x[i] || y[i] != one_y[i];
    ok(wrong == 0, "isa %u: a lane's number does not depend on the other lanes", isa);
    free(one_x), free(one_y);
    plugin->destroy(instance);
}

/* More samples than memory could hold cells for, and counts near the limits of 32 bits. */
static void test_large(void)
{
    static const uint32_t counts[] = {1u << 20, (1u << 30) - 1, 1u << 30, (1u << 30) + 1, 4294967291u, UINT32_MAX};
    uint32_t wrong = 0;
    void *instance;

    make(0, 0, &instance);
    for (uint32_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        for (uint32_t i = 0; i < 1000; i++)
            set(i, 9, i < 500 ? i : counts[k] - 1 - (i - 500), counts[k]);
        fill(instance, 1000);
        for (uint32_t i = 0; i < 1000; i++)
            wrong += !(x[i] >= 0 && x[i] < 1 && y[i] >= 0 && y[i] < 1);
    }
    ok(wrong == 0, "isa %u: up to 2^32 - 1 samples", isa);
    plugin->destroy(instance);
    ok(make(65536, 65536, &instance) == MCR_E_INVALID && context.message[0], "isa %u: too many cells are refused: %s", isa, context.message);
    ok(make(32768, 32768, &instance) == MCR_OK, "isa %u: 2^30 cells are not", isa);
    plugin->destroy(instance);
}

static uint64_t bits_of(void)
{
    uint64_t sum = 0;
    void *instance;

    for (uint32_t n = 0; n < 3; n++) {
        make(n, 0, &instance);
        for (uint32_t i = 0; i < 5000; i++)
            set(i, i / 97, i % 97, 97);
        fill(instance, 5000);
        for (uint32_t i = 0; i < 5000; i++)
            sum = mcr_mix64(sum + mcr_bits(x[i]) + 3 * mcr_bits(y[i]));
        plugin->destroy(instance);
    }
    return sum;
}

int main(void)
{
    const struct mcr_plugin *file = load("stratified");
    uint64_t first_bits = 0;

    x = array(MOST), y = array(MOST);
    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        plugin = descriptor_of(file, isa);
        if (!plugin) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        ok(plugin->correlated(NULL) == 1 && plugin->supplies(NULL, 0, 2) == 2 && plugin->supplies(NULL, 2, 2) == 0 &&
               plugin->supplies(NULL, 8, 16) == 0,
           "isa %u: supplies the film, correlated", isa);
        test_automatic();
        test_given(4, 4, 48, 4, 4);
        test_given(4, 4, 50, 4, 4);
        test_given(3, 7, 100, 3, 7);
        test_given(1, 1, 20, 1, 1);
        test_given(1, 64, 64, 1, 64);
        test_given(64, 1, 150, 64, 1);
        test_given(10, 0, 97, 10, 10);
        test_given(0, 10, 101, 11, 10);
        test_given(100, 100, 60, 100, 100);
        test_given(256, 256, 65536, 256, 256);
        test_floor_sqrt(10, 3);
        test_floor_sqrt(1000, 31);
        test_floor_sqrt(49, 7);
        test_order(3, 0, 1);
        test_order(4, 0, 1);
        test_order(7, 2, 3);
        test_order(16, 0, 1);
        test_order(23, 5, 21);
        test_order(36, 0, 35);
        test_order(64, 1, 2);
        test_places();
        test_ends();
        test_variance();
        test_lanes();
        test_large();
        if (isa == MCR_ISA_BASELINE)
            first_bits = bits_of();
        ok(bits_of() == first_bits, "isa %u: the bits of the baseline", isa);
    }
    free(x), free(y);
    return tap_done();
}
