/* SPDX-License-Identifier: Apache-2.0 */
/* The film's variance of each channel against the definition in two passes; and that asking for it changes nothing else. */
#include <math.h>
#include <string.h>

#include "../tap.h"
#include "base/random.h"
#include "film/film.h"

#define PIXELS 3
#define MOST 5000 /* samples: 313 cells, three levels of the film's tree */

static double sample[3][PIXELS][MOST];

static void draw(void)
{
    uint64_t state = 1;
    for (int p = 0; p < PIXELS; p++)
        for (int i = 0; i < MOST; i++)
            for (int c = 0; c < 3; c++) {
                double u = mcr_unit_double(mcr_mix64(state++));
                sample[c][p][i] = p == 0 ? (1 + c) * u : p == 1 ? 100 * c + u : u < 0.05;
            }
}

/* Samples first .. end-1, by cells, as the core hands them over: through the film's own sink. */
static void add(struct mcr_film *film, uint32_t first, uint32_t end)
{
    struct mcr_cell_sink sink = mcr_film_sink(film);
    for (uint32_t at = first; at < end; at += MCR_CELL_SAMPLES) {
        uint32_t n = end - at < MCR_CELL_SAMPLES ? end - at : MCR_CELL_SAMPLES;
        struct mcr_cell cell[PIXELS];
        struct mcr_cell_channels channels[PIXELS];
        for (int p = 0; p < PIXELS; p++) {
            const double *r = &sample[0][p][at], *g = &sample[1][p][at], *b = &sample[2][p][at];
            mcr_cell_sum(r, g, b, n, &cell[p]);
            mcr_cell_channel_moments(r, g, b, n, &cell[p], &channels[p]);
        }
        if (sink.add_channels)
            sink.add_channels(sink.data, cell, channels, n);
        else
            sink.add(sink.data, cell, n);
    }
}

static double mean_of(int c, int p, uint32_t first, uint32_t end)
{
    double sum = 0;
    for (uint32_t i = first; i < end; i++)
        sum += sample[c][p][i];
    return sum / (end - first);
}

/* The largest relative difference of rgb from `expected`, pixels by channels. */
static double worst_of(const double *rgb, double expected[PIXELS][3])
{
    double worst = 0;
    for (int p = 0; p < PIXELS; p++)
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs(rgb[3 * p + c] / expected[p][c] - 1));
    return worst;
}

/* Beside a film that keeps no channels. Pixel 1 has means up to 200 and deviations of .3: its differences err by 1e-13, the replicates' by 4e-13 (measured). */
static void test_independent(uint32_t samples)
{
    struct mcr_film *film = mcr_film_create(PIXELS, 1, 0), *plain = mcr_film_create(PIXELS, 1, 0);
    double rgb[3 * PIXELS], expected[PIXELS][3], mean[2][3 * PIXELS], variance[2][PIXELS];
    mcr_film_keep_channels(film);
    add(film, 0, samples);
    add(plain, 0, samples);
    for (int p = 0; p < PIXELS; p++)
        for (int c = 0; c < 3; c++) {
            double m = mean_of(c, p, 0, samples), moment = 0;
            for (uint32_t i = 0; i < samples; i++)
                moment += (sample[c][p][i] - m) * (sample[c][p][i] - m);
            expected[p][c] = moment / samples / (samples - 1);
        }
    memset(rgb, 0, sizeof rgb);
    int status = mcr_film_channel_variance(film, rgb);
    ok(status == 0 && worst_of(rgb, expected) < 1e-11, "%u samples: each channel's variance as defined (relative difference %.2g)", samples,
       worst_of(rgb, expected));
    mcr_film_mean(film, mean[0]);
    mcr_film_mean(plain, mean[1]);
    mcr_film_variance(film, variance[0]);
    mcr_film_variance(plain, variance[1]);
    ok(!memcmp(mean[0], mean[1], sizeof mean[0]) && !memcmp(variance[0], variance[1], sizeof variance[0]),
       "%u samples: mean and luminance variance have the bits of a film without channels", samples);
    ok(mcr_film_channel_variance(plain, rgb) == -1, "%u samples: a film that was not asked has no channels' variance", samples);
    mcr_film_destroy(film);
    mcr_film_destroy(plain);
}

/* sum n_i (m_i - m)^2 / (N (R - 1)), with replicates of 20, 20 and 19 samples. */
static void test_replicates(void)
{
    static const uint32_t begin[4] = {0, 20, 40, 59};
    struct mcr_film *film = mcr_film_create(PIXELS, 1, 1);
    double rgb[3 * PIXELS] = {-7}, expected[PIXELS][3];
    mcr_film_keep_channels(film);
    for (int p = 0; p < PIXELS; p++)
        for (int c = 0; c < 3; c++) {
            double all = mean_of(c, p, 0, 59), moment = 0;
            for (int r = 0; r < 3; r++) {
                double difference = mean_of(c, p, begin[r], begin[r + 1]) - all;
                moment += (begin[r + 1] - begin[r]) * difference * difference;
            }
            expected[p][c] = moment / (59 * 2);
        }
    ok(!mcr_film_sink(film).add_channels, "replicates need no moments of cells");
    for (int r = 0; r < 3; r++) {
        add(film, begin[r], begin[r + 1]);
        if (r == 1)
            ok(mcr_film_channel_variance(film, rgb) == -1 && rgb[0] == -7, "one finished replicate: unknown, and nothing is stored");
        mcr_film_end_replicate(film);
    }
    int status = mcr_film_channel_variance(film, rgb);
    ok(status == 0 && worst_of(rgb, expected) < 1e-11, "replicates: each channel's variance as defined (relative difference %.2g)", worst_of(rgb, expected));
    mcr_film_destroy(film);
}

static void test_unknown(void)
{
    struct mcr_film *film = mcr_film_create(PIXELS, 1, 0);
    struct mcr_cell cell[PIXELS] = {{{0}, 0}};
    double rgb[3 * PIXELS] = {-7};
    mcr_film_keep_channels(film);
    ok(mcr_film_add(film, cell, 1) == -1 && film->samples == 0, "cells without the moments that were asked for are refused");
    add(film, 0, 1);
    ok(mcr_film_channel_variance(film, rgb) == -1 && rgb[0] == -7, "one sample: unknown, and nothing is stored");
    mcr_film_destroy(film);
}

int main(void)
{
    draw();
    test_independent(2);
    test_independent(77);
    test_independent(MOST);
    test_replicates();
    test_unknown();
    return tap_done();
}
