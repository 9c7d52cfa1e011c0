/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The film's variances. Over many repetitions the mean estimate must be the true variance of the pixel's mean: a z-test with the estimates' own spread.
 * Single estimates are compared with the definition, computed here in two passes.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../tap.h"
#include "base/random.h"
#include "film/film.h"

#define REPETITIONS 4000u
#define MOST 256u

static uint64_t state = 1;

static double number(void)
{
    return mcr_unit_double(mcr_mix64(state++));
}

/* Distributions with their mean and variance. */
enum { UNIFORM, RARE, EXPONENTIAL, KINDS };
static const char *const kind_name[KINDS] = {"uniform", "rare", "exponential"};
static const double kind_mean[KINDS] = {0.5, 0.05, 1}, kind_variance[KINDS] = {1.0 / 12, 0.05 * 0.95, 1};

static double draw(int kind)
{
    double u = number();
    return kind == UNIFORM ? u : kind == RARE ? u < 0.05 : -log(1 - u);
}

/* Adds samples by cells, as the core hands them over. */
static void add(struct mcr_film *film, const double *r, const double *g, const double *b, uint32_t count)
{
    for (uint32_t done = 0; done < count;) {
        uint32_t n = count - done < MCR_CELL_SAMPLES ? count - done : MCR_CELL_SAMPLES;
        struct mcr_cell cell;
        mcr_cell_sum(r + done, g + done, b + done, n, &cell);
        mcr_film_add(film, &cell, n);
        done += n;
    }
}

struct spread {
    double n, mean, moment;
};

static void spread_add(struct spread *s, double x)
{
    double difference = x - s->mean;
    s->mean += difference / ++s->n;
    s->moment += difference * (x - s->mean);
}

static double spread_z(const struct spread *s, double expected)
{
    return (s->mean - expected) / sqrt(s->moment / (s->n - 1) / s->n);
}

static void test_independent(int kind, uint32_t samples)
{
    struct spread estimate = {0, 0, 0}, square = {0, 0, 0};
    for (uint32_t r = 0; r < REPETITIONS; r++) {
        struct mcr_film *film = mcr_film_create(1, 1, 0);
        double v[MOST], rgb[3], variance = -1;
        for (uint32_t i = 0; i < samples; i++)
            v[i] = draw(kind);
        add(film, v, v, v, samples);
        mcr_film_mean(film, rgb);
        mcr_film_variance(film, &variance);
        spread_add(&estimate, variance);
        spread_add(&square, (rgb[0] - kind_mean[kind]) * (rgb[0] - kind_mean[kind]));
        mcr_film_destroy(film);
    }
    double z = spread_z(&estimate, kind_variance[kind] / samples), real = spread_z(&square, kind_variance[kind] / samples);
    ok(fabs(z) <= 4 && fabs(real) <= 4, "%u independent samples, %s: variance z = %.2f (the real squared error: z = %.2f)", samples, kind_name[kind], z,
       real);
}

/*
 * Replicates of almost equal size whose samples are spread over strata: the mean of one has the variance 1/(12 n^3), and not 1/(12 n). All have n samples but
 * for the first `longer`, which have one more, as the core divides them.
 */
static void test_replicates(uint32_t replicates, uint32_t n, uint32_t longer, int strata)
{
    struct spread estimate = {0, 0, 0}, square = {0, 0, 0};
    double expected = 0, total = (double)replicates * n + longer;
    for (uint32_t r = 0; r < replicates; r++) {
        double count = n + (r < longer);
        expected += count * count * (strata ? 1 / (12 * count * count * count) : 1 / (12 * count)) / (total * total);
    }
    for (uint32_t k = 0; k < REPETITIONS; k++) {
        struct mcr_film *film = mcr_film_create(1, 1, 1);
        double v[MOST], rgb[3], variance = -1;
        for (uint32_t r = 0; r < replicates; r++) {
            uint32_t count = n + (r < longer);
            for (uint32_t i = 0; i < count; i++)
                v[i] = strata ? (i + number()) / count : number();
            add(film, v, v, v, count);
            mcr_film_end_replicate(film);
        }
        mcr_film_mean(film, rgb);
        mcr_film_variance(film, &variance);
        spread_add(&estimate, variance);
        spread_add(&square, (rgb[0] - 0.5) * (rgb[0] - 0.5));
        mcr_film_destroy(film);
    }
    double z = spread_z(&estimate, expected), real = spread_z(&square, expected);
    ok(fabs(z) <= 4 && fabs(real) <= 4, "%u replicates of %u samples, %u of them longer by one, %s: variance z = %.2f (the real squared error: z = %.2f)",
       replicates, n, longer, strata ? "stratified" : "independent", z, real);
}

/* One film of three pixels against the definitions. */
static void test_definition(void)
{
    enum { PIXELS = 3, SAMPLES = 77 };
    static double v[3][PIXELS][SAMPLES];
    struct mcr_film *film = mcr_film_create(PIXELS, 1, 0);
    double variance[PIXELS], mean_variance = 0, mean[3] = {0, 0, 0}, worst = 0;
    for (int p = 0; p < PIXELS; p++) {
        double luminance[SAMPLES], sum = 0, moment = 0;
        for (int i = 0; i < SAMPLES; i++) {
            for (int c = 0; c < 3; c++) {
                v[c][p][i] = (1 + c) * draw(p % KINDS);
                mean[c] += v[c][p][i] / (SAMPLES * PIXELS);
            }
            luminance[i] = 0.2126 * v[0][p][i] + 0.7152 * v[1][p][i] + 0.0722 * v[2][p][i];
            sum += luminance[i];
        }
        for (int i = 0; i < SAMPLES; i++)
            moment += (luminance[i] - sum / SAMPLES) * (luminance[i] - sum / SAMPLES);
        variance[p] = moment / (SAMPLES - 1) / SAMPLES;
        mean_variance += variance[p] / PIXELS;
    }
    for (uint32_t done = 0; done < SAMPLES; done += MCR_CELL_SAMPLES) {
        struct mcr_cell cell[PIXELS];
        uint32_t n = SAMPLES - done < MCR_CELL_SAMPLES ? SAMPLES - done : MCR_CELL_SAMPLES;
        for (int p = 0; p < PIXELS; p++)
            mcr_cell_sum(v[0][p] + done, v[1][p] + done, v[2][p] + done, n, &cell[p]);
        mcr_film_add(film, cell, n);
    }
    double out[PIXELS];
    struct mcr_film_figures figures;
    mcr_film_variance(film, out);
    for (int p = 0; p < PIXELS; p++)
        worst = fmax(worst, fabs(out[p] / variance[p] - 1));
    ok(worst < 1e-13, "coloured samples: variance of luminance as defined (relative difference %.2g)", worst);
    ok(mcr_film_figures(film, &figures) == 0 && figures.known, "figures are known");
    for (int c = 0; c < 3; c++)
        worst = fmax(worst, fabs(figures.mean[c] / mean[c] - 1));
    double luminance = 0.2126 * mean[0] + 0.7152 * mean[1] + 0.0722 * mean[2];
    ok(worst < 1e-13 && fabs(figures.luminance / luminance - 1) < 1e-13, "mean over the pixels, its luminance");
    ok(fabs(figures.mean_variance / mean_variance - 1) < 1e-13, "mean variance: over the pixels");
    ok(fabs(figures.standard_error / sqrt(mean_variance / PIXELS) - 1) < 1e-13, "standard error of the mean over independent pixels");
    ok(fabs(figures.sample_variance / (mean_variance * SAMPLES) - 1) < 1e-13, "variance of one sample: times their number");
    ok(fabs(figures.relative_error / (sqrt(mean_variance) / luminance) - 1) < 1e-13, "relative error");
    mcr_film_destroy(film);
}

/* sum n_i (m_i - m)^2 / (N (R - 1)), with replicates of 20, 20 and 19 samples. */
static void test_replicate_definition(void)
{
    static const uint32_t count[3] = {20, 20, 19};
    struct mcr_film *film = mcr_film_create(1, 1, 1);
    double mean[3], overall = 0, expected = 0, out = -1;
    for (int r = 0; r < 3; r++) {
        double v[20], sum = 0;
        for (uint32_t i = 0; i < count[r]; i++)
            sum += v[i] = number();
        mean[r] = sum / count[r];
        overall += sum / 59;
        add(film, v, v, v, count[r]);
        mcr_film_end_replicate(film);
    }
    for (int r = 0; r < 3; r++)
        expected += count[r] * (mean[r] - overall) * (mean[r] - overall) / (59 * 2);
    struct mcr_film_figures figures;
    mcr_film_variance(film, &out);
    mcr_film_figures(film, &figures);
    ok(fabs(out / expected - 1) < 1e-12, "replicates' variance as defined: %.17g, %.17g", out, expected);
    ok(fabs(figures.sample_variance / (expected * 59) - 1) < 1e-12, "its variance of one sample: times all samples");
    mcr_film_destroy(film);
}

/* A mean far from 0 must not eat the variance: 1e8 + uniform. The numbers themselves are rounded to 2^-26, the luminance to a few of these. */
static void test_offset(void)
{
    struct mcr_film *film = mcr_film_create(1, 1, 0);
    double v[MOST], sum = 0, moment = 0, out = -1;
    for (uint32_t i = 0; i < MOST; i++) {
        v[i] = 1e8 + number();
        sum += v[i] - 1e8;
    }
    for (uint32_t i = 0; i < MOST; i++)
        moment += (v[i] - 1e8 - sum / MOST) * (v[i] - 1e8 - sum / MOST);
    add(film, v, v, v, MOST);
    mcr_film_variance(film, &out);
    double expected = moment / (MOST - 1) / MOST;
    ok(fabs(out / expected - 1) < 1e-6, "1e8 + noise: relative difference %.2g", out / expected - 1);
    mcr_film_destroy(film);
}

static void test_unknown(void)
{
    double v[4] = {1, 2, 3, 4}, out = -7;
    struct mcr_film_figures figures;
    struct mcr_film *film = mcr_film_create(1, 1, 0);
    add(film, v, v, v, 1);
    mcr_film_figures(film, &figures);
    ok(mcr_film_variance(film, &out) == -1 && out == -7 && !figures.known, "one sample: the variance is unknown");
    mcr_film_destroy(film);
    film = mcr_film_create(1, 1, 1);
    add(film, v, v, v, 4);
    mcr_film_end_replicate(film);
    mcr_film_figures(film, &figures);
    ok(mcr_film_variance(film, &out) == -1 && !figures.known, "one replicate: unknown");
    add(film, v, v, v, 3);
    ok(mcr_film_variance(film, &out) == -1, "a replicate that is not finished does not count");
    mcr_film_end_replicate(film);
    ok(mcr_film_variance(film, &out) == 0, "two replicates: known");
    mcr_film_destroy(film);
}

int main(void)
{
    for (int kind = 0; kind < KINDS; kind++) {
        test_independent(kind, 2);
        test_independent(kind, 21);
        test_independent(kind, MOST);
    }
    test_replicates(2, 10, 1, 0);
    test_replicates(4, 16, 0, 1);
    test_replicates(3, 19, 2, 0);
    test_replicates(16, 5, 0, 1);
    test_definition();
    test_replicate_definition();
    test_offset();
    test_unknown();
    return tap_done();
}
