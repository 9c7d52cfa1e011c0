/* SPDX-License-Identifier: Apache-2.0 */
/*
 * 1e8 samples in one pixel: the film's sum against the exact one. The samples are multiples of 2^-53, so that sums of them are exact in integers of
 * 128 bits. Naive sums in double err by 6e-14 (uniform samples) and 1.9e-9 (the constant .1), in float by tens of percents.
 */
#include <math.h>
#include <string.h>

#include "../tap.h"
#include "base/random.h"
#include "film/film.h"

#define CELLS 6250000u
#define PIXELS 4u

__extension__ typedef unsigned __int128 exact;

static const char *const name[PIXELS] = {"uniform", "the constant .1", "rare bright samples (1 in 100000 is 1e5 times as bright)", "large before small"};

/* A sample in units of 2^-53, below 2^80. */
static exact sample(uint32_t pixel, uint64_t i)
{
    uint64_t bits = mcr_mix64(i * PIXELS + pixel) >> 11;
    switch (pixel) {
    case 0:
        return bits;
    case 1:
        return (exact)(0.1 * 0x1p57) / 16;
    case 2:
        return mcr_mix64(bits) % 100000 ? bits : (exact)bits * 100000 >> 17 << 17; /* 53 bits at most: a double holds it */
    default:
        return i < 1000 ? (exact)1 << 73 : bits >> 20;
    }
}

static double as_double(exact units)
{
    return (double)units * 0x1p-53;
}

/* Relative error of the film's mean against total / n; the differences are formed exactly, as far as it takes. */
static double error_of(double mean, exact total, uint64_t n)
{
    __float128 expected = (__float128)total * 0x1p-53 / n;
    return (double)(((__float128)mean - expected) / expected);
}

static void test_long(int correlated, uint32_t cells)
{
    struct mcr_film *film = mcr_film_create(PIXELS, 1, correlated);
    exact total[PIXELS] = {0};
    double rgb[3 * PIXELS];
    for (uint32_t c = 0; c < cells; c++) {
        struct mcr_cell cell[PIXELS];
        for (uint32_t p = 0; p < PIXELS; p++) {
            double v[MCR_CELL_SAMPLES];
            for (uint32_t s = 0; s < MCR_CELL_SAMPLES; s++) {
                exact units = sample(p, (uint64_t)c * MCR_CELL_SAMPLES + s);
                total[p] += units;
                v[s] = as_double(units);
            }
            mcr_cell_sum(v, v, v, MCR_CELL_SAMPLES, &cell[p]);
        }
        mcr_film_add(film, cell, MCR_CELL_SAMPLES);
        if (correlated && c % 1000 == 999)
            mcr_film_end_replicate(film);
    }
    mcr_film_mean(film, rgb);
    for (uint32_t p = 0; p < PIXELS; p++) {
        double error = error_of(rgb[3 * p], total[p], (uint64_t)cells * MCR_CELL_SAMPLES);
        ok(fabs(error) <= 2e-14 && rgb[3 * p] == rgb[3 * p + 2], "%u samples%s, %s: relative error %.2g", cells * MCR_CELL_SAMPLES,
           correlated ? " in replicates" : "", name[p], error);
    }
    mcr_film_destroy(film);
}

/* Every number of cells up to a few full nodes of the tree, the last cell short: sums of whole numbers are exact whatever their order, and none is lost. */
static void test_counts(void)
{
    uint32_t wrong = 0;
    for (uint32_t cells = 1; cells <= 300; cells++) {
        struct mcr_film *film = mcr_film_create(2, 1, 0);
        uint64_t sum = 0, samples = 0;
        double rgb[6];
        for (uint32_t c = 0; c < cells; c++) {
            uint32_t count = c + 1 < cells ? MCR_CELL_SAMPLES : 1 + cells % MCR_CELL_SAMPLES;
            double v[MCR_CELL_SAMPLES], twice[MCR_CELL_SAMPLES];
            struct mcr_cell cell[2];
            for (uint32_t s = 0; s < count; s++) {
                sum += 1 + samples;
                v[s] = 1 + (double)samples++;
                twice[s] = 2 * v[s];
            }
            mcr_cell_sum(v, twice, v, count, &cell[0]);
            mcr_cell_sum(twice, v, v, count, &cell[1]);
            mcr_film_add(film, cell, count);
        }
        mcr_film_mean(film, rgb);
        double mean = (double)sum / (double)samples, two = 2 * (double)sum / (double)samples;
        mcr_film_destroy(film);
        wrong += rgb[0] != mean || rgb[1] != two || rgb[2] != mean || rgb[3] != two || rgb[4] != mean || rgb[5] != mean;
    }
    ok(wrong == 0, "1 to 300 cells: no sample is lost or counted twice (%u wrong)", wrong);
}

int main(void)
{
    test_long(0, CELLS);
    test_long(1, 100000);
    test_counts();
    return tap_done();
}
