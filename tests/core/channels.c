/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The variances of a picture's channels: where they are known, and against the spread over seeds. |z| <= 4 throughout, from the spread of the estimates
 * over pixels or seeds.
 */
#include <stdlib.h>

#include "../scene/help.h"
#include "base/cpu.h"
#include "core/core.h"
#include "film/film.h"

/* S16: below a disk of radius 1 at height 1, albedo .5, one sample by `cosine` has the variance .0625 for radiance 1. */
#define RECEIVER                                                                                              \
    "camera perspective { from (0.3, 0.2, 0.5) to (0, 0, 0) up (0.1, 0.9, 0.3) fov 1e-9 }\n"                  \
    "material grey lambert { albedo 0.5 }\nmaterial lamp emitter { radiance (1, 2, 0.5) }\n"                  \
    "plane { point (0, 0, 0) normal (0, 0, 1) material grey }\n"                                              \
    "disk { center (0, 0, 1) normal (0, 0, -1) radius 1 material lamp }\n"

/* Edges within pixels: what varies is where a pixel is hit, so that strata help; and a lit floor, where it is the light. */
#define EDGES                                                                                                 \
    "camera perspective { from (0, 0, 5) to (0, 0, 0) fov 40 }\n"                                             \
    "material grey lambert { albedo (0.9, 0.5, 0.2) }\nmaterial lamp emitter { radiance (1, 0.5, 2) sides two }\n" \
    "quad { corner (-1, -0.2, 0) u (2.3, 0.9, 0) v (-0.4, 1.1, 0) material lamp }\n"                          \
    "quad { corner (-3, -1, -3) u (6, 0, 0) v (0, 0, 6) material grey }\n"

#define SIDE 16
#define PIXELS (SIDE * SIDE)

/* Renders with a seed: the mean, and the variance of the mean by channel. -1 after a failure. */
static int picture(const char *text, const char *settings, uint64_t seed, double *mean, double *variance)
{
    char whole[2000];
    struct mcr_overrides over = {.has_seed = 1, .seed = seed, .has_threads = 1, .threads = 1};
    snprintf(whole, sizeof whole, "%sfilm { size (%d, %d) }\nrender { roulette off depth 1 %s }\n", text, SIDE, SIDE, settings);
    struct world world = open_world(whole, &over);
    if (!world.scene)
        return -1;
    struct mcr_film *film = mcr_film_create(SIDE, SIDE, world.scene->sampler->correlated);
    struct mcr_render_options how = {.isa = MCR_ISA_BASELINE};
    struct mcr_render_stats stats;
    char error[256] = "";
    mcr_film_keep_channels(film);
    struct mcr_cell_sink sink = mcr_film_sink(film);
    struct mcr_accel *accel = mcr_accel_create(world.arena, world.scene, world.scene->render.accel);
    int status = mcr_render(world.scene, accel, &how, &sink, &stats, error, sizeof error);
    if (status)
        fprintf(stderr, "%s\n", error);
    mcr_film_mean(film, mean);
    status |= mcr_film_channel_variance(film, variance);
    mcr_film_destroy(film);
    close_world(&world);
    return status;
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

static double spread_error(const struct spread *s)
{
    return sqrt(s->moment / (s->n - 1) / s->n);
}

/* Radiance (1, 2, .5): the variances are .0625 times its squares, and the estimates of pixels are independent. */
static void test_known(const char *what, const char *settings, uint32_t spp)
{
    static const double square[3] = {1, 4, 0.25};
    double mean[3 * PIXELS], variance[3 * PIXELS], worst = 0;
    if (!ok(picture(RECEIVER, settings, 3, mean, variance) == 0, "%s renders", what))
        return;
    for (int c = 0; c < 3; c++) {
        struct spread s = {0, 0, 0};
        for (int p = 0; p < PIXELS; p++)
            spread_add(&s, variance[3 * p + c] * spp);
        double z = (s.mean - 0.0625 * square[c]) / spread_error(&s);
        ok(fabs(z) <= 4 && spread_error(&s) < 0.05 * s.mean, "%s, channel %d: variance of a sample %.5g +- %.2g, z = %.2f", what, c, s.mean,
           spread_error(&s), z);
    }
    for (int p = 0; p < PIXELS; p++)
        worst = fmax(worst, fmax(fabs(variance[3 * p + 1] / variance[3 * p] - 4), fabs(variance[3 * p + 2] / variance[3 * p] - 0.25)));
    ok(worst < 1e-9, "%s: the channels' ratios in every pixel (difference %.2g)", what, worst);
}

#define SEEDS 64

/*
 * Over seeds, the spread of a pixel's mean must be the variance that is told: the difference of both, averaged over the pixels that see anything, by seed
 * (deviations from the mean of all seeds, times S / (S - 1)), is a number of expectation 0.
 */
static void test_spread(const char *what, const char *settings, double *told)
{
    static double mean[SEEDS][3 * PIXELS], variance[SEEDS][3 * PIXELS];
    int failed = 0;
    for (int s = 0; s < SEEDS; s++)
        failed |= picture(EDGES, settings, 100 + (uint64_t)s, mean[s], variance[s]);
    if (!ok(!failed, "%s renders", what))
        return;
    for (int c = 0; c < 3; c++) {
        struct spread difference = {0, 0, 0}, all = {0, 0, 0};
        double middle[PIXELS] = {0};
        for (int p = 0; p < PIXELS; p++)
            for (int s = 0; s < SEEDS; s++)
                middle[p] += mean[s][3 * p + c] / SEEDS;
        for (int s = 0; s < SEEDS; s++) {
            double sum = 0, sum_told = 0;
            for (int p = 0; p < PIXELS; p++) {
                double d = mean[s][3 * p + c] - middle[p];
                sum += d * d * SEEDS / (SEEDS - 1) / PIXELS;
                sum_told += variance[s][3 * p + c] / PIXELS;
            }
            spread_add(&difference, sum_told - sum);
            spread_add(&all, sum_told);
        }
        double z = difference.mean / spread_error(&difference);
        told[c] = all.mean;
        ok(fabs(z) <= 4 && spread_error(&difference) < 0.1 * all.mean, "%s, channel %d: mean variance %.4g, over the seeds %.4g, z = %.2f", what, c,
           all.mean, all.mean - difference.mean, z);
    }
}

int main(void)
{
    double independent[3], stratified[3];
    test_known("S16, independent", "spp 512 sampler cosine", 512);
    test_known("S16, stratified, 16 replicates", "spp 512 replicates 16 sampler stratified(cosine)", 512);
    test_spread("edges, independent", "spp 16 sampler mixture(cosine 1, light 1)", independent);
    test_spread("edges, stratified, 4 replicates", "spp 64 replicates 4 sampler stratified(mixture(cosine 1, light 1))", stratified);
    for (int c = 0; c < 3; c++)
        ok(stratified[c] * 4 < 0.9 * independent[c], "channel %d: strata help, at equal numbers of samples (%.3g, %.3g)", c, stratified[c] * 4, independent[c]);
    return tap_done();
}
