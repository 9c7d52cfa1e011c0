/* SPDX-License-Identifier: Apache-2.0 */
#include "metrics/bias.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/distributions.h"
#include "base/elementary.h"
#include "base/memory.h"
#include "metrics/blocks.h"
#include "metrics/sum.h"

/* In the order of the series. */
static const char *const variance_name[] = {"variance.R", "variance.G", "variance.B", "variance.Y"};

static int variance_channel(const struct mcr_image *image, uint32_t channels, uint32_t series)
{
    return mcr_pair_channel(image, channels == 1 || series == MCR_PAIR_LUMINANCE ? variance_name[3] : variance_name[series]);
}

int mcr_bias_known(const struct mcr_image *image)
{
    int grey = mcr_pair_channel(image, "R") < 0;
    for (uint32_t c = 0; c < (grey ? 1 : MCR_METRICS_CHANNELS); c++)
        if (variance_channel(image, grey ? 1 : MCR_METRICS_CHANNELS, c) < 0)
            return 0;
    return 1;
}

/* The noise of a sum of e: the greatest of what v, e^2, and each image's variance times the typical ratio tell. */
static double cautious_noise(const struct mcr_block *block, double ratio)
{
    double from_r = (1 + ratio) * block->vr + block->rounding, from_a = (1 + 1 / ratio) * block->va + block->rounding;
    double noise = mcr_max(block->e2, mcr_block_noise(block));
    return mcr_max(from_r, mcr_max(from_a, noise)); /* the second, where the ratio and with it the first is NaN */
}

/* Degrees of freedom of the variances of the image and of the reference; infinite where nothing tells. */
struct degrees {
    double a, r;
};

/* Those of va + vr, where va / vr is `ratio` (Satterthwaite); at least 1. */
static double combined(struct degrees of, double ratio)
{
    double k = ratio / (1 + ratio), both = 1 / (k * k / of.a + (1 - k) * (1 - k) / of.r);
    return both > 1e5 || ratio != ratio ? MCR_INFINITY : mcr_max(both, 1);
}

/*
 * Degrees of freedom by scatter. Where both variances, brought to one scale by their ratio in the block, have n of them, the share va / (va + vr) has
 * variance 1 / (4 (n + 1)). For unequal numbers 2 / n = 1 / na + 1 / nr; the noisier image is taken to have fewer, na / nr = variance of r / variance of a,
 * as with one sampler. Noise that is not normal counts too: rare bright samples leave few.
 */
static struct degrees scattered_degrees(const struct mcr_blocks *blocks, const struct mcr_series *series, double ratio)
{
    struct mcr_sum scatter = {0, 0};
    uint64_t count = 0;
    struct mcr_noisy s;
    for (uint32_t y = 0; y < series->pair->height; y++) {
        mcr_series_row(series, y);
        for (uint32_t x = 0; x < series->pair->width; x++) {
            const struct mcr_block *block = mcr_blocks_at(blocks, x, y);
            if (!(block->va > 0) || !(block->vr > 0) || !mcr_series_take(series, x, y, &s) || !(s.va + s.vr > 0))
                continue;
            double share = s.va / (s.va + s.vr * (block->va / block->vr)) - 0.5;
            mcr_sum_add(&scatter, share * share);
            count++;
        }
    }
    double n = count ? 1 / (4 * mcr_sum_value(scatter) / (double)count) - 1 : MCR_INFINITY;
    return (struct degrees){0.5 * n * (1 + 1 / ratio), 0.5 * n * (1 + ratio)};
}

/* What the files say, or else what the scatter tells. */
static struct degrees told_degrees(const struct mcr_pair *pair, struct degrees scattered)
{
    uint32_t of_a = pair->image[0]->units, of_r = pair->image[1]->units;
    return of_a < 2 || of_r < 2 ? scattered : (struct degrees){of_a - 1.0, of_r - 1.0};
}

/* How |e| is judged: beyond threshold * sqrt(v), and beyond the noise that one image foretells. */
struct pixel_test {
    double threshold;
    double from_a, from_r; /* threshold^2 times what either variance is multiplied with; 0: not asked */
};

/*
 * Where one image has less than half the variance of the other it has more samples, and knows better what a pixel's variance is: the other's may be far too
 * low, where it has not met the light yet. Then both tests are asked; with one sampler either holds its level.
 */
static struct pixel_test pixel_test(const struct mcr_bias_series *series, struct degrees of, double ratio, double confidence)
{
    struct pixel_test test = {mcr_student_quantile(0.5 * (1 + confidence), series->degrees), 0, 0};
    double better = ratio > 2 ? mcr_max(of.r, 1) : ratio < 0.5 ? mcr_max(of.a, 1) : 0;
    double threshold = better > 0 ? mcr_student_quantile(0.5 * (1 + confidence), better) : 0;
    if (ratio > 2)
        test.from_r = threshold * threshold * (1 + ratio);
    else if (ratio < 0.5)
        test.from_a = threshold * threshold * (1 + 1 / ratio);
    return test;
}

static int is_beyond(const struct pixel_test *test, const struct mcr_noisy *s)
{
    return fabs(s->e) > test->threshold * sqrt(mcr_noisy_variance(s)) && s->e * s->e > test->from_a * s->va + test->from_r * s->vr;
}

static void test_pixels(const struct mcr_series *series, const struct pixel_test *test, struct mcr_bias_series *out)
{
    struct mcr_noisy s;
    for (uint32_t y = 0; y < series->pair->height; y++) {
        mcr_series_row(series, y);
        for (uint32_t x = 0; x < series->pair->width; x++) {
            if (!mcr_series_take(series, x, y, &s))
                continue;
            int silent = s.va + s.vr == 0, beyond = is_beyond(test, &s);
            out->tested += !silent || beyond;
            out->differing += beyond;
            out->silent_same += silent && !beyond;
            out->silent_differing += silent && beyond;
        }
    }
}

/* Degrees of freedom of a sum of v, given the sum of their squares, whose expectation is (1 + 2 / n) times that of the true ones. */
static double degrees_of_sum(double v, double squares, double each)
{
    return squares > 0 ? mcr_max((each + 2) * v * v / squares, 1) : MCR_INFINITY;
}

/* The p of a sum of e; without noise a difference is certain. */
static double sum_p(double e, double noise, double degrees)
{
    if (e == 0)
        return 1;
    return noise > 0 ? 2 * mcr_student_upper(fabs(e) / sqrt(noise), degrees) : 0;
}

static void test_mean(const struct mcr_blocks *blocks, double ratio, double degrees, struct mcr_bias_series *out, double confidence)
{
    struct mcr_block total = mcr_blocks_total(blocks);
    double count = (double)total.count, noise = cautious_noise(&total, ratio), v = mcr_block_noise(&total);
    double half = mcr_student_quantile(0.5 * (1 + confidence), degrees_of_sum(v, total.v2, degrees)) * sqrt(noise) / count;
    out->difference = total.e / count;
    out->low = out->difference - half;
    out->high = out->difference + half;
    out->mean_p = sum_p(total.e, noise, degrees_of_sum(v, total.v2, degrees));
}

static void test_tiles(const struct mcr_blocks *blocks, double ratio, double degrees, const struct mcr_pair *pair, struct mcr_bias_series *out)
{
    double least = 2, tiles = 0;
    for (uint32_t row = 0; row < blocks->rows; row++)
        for (uint32_t column = 0; column < blocks->columns; column++) {
            const struct mcr_block *block = &blocks->block[(size_t)row * blocks->columns + column];
            struct mcr_block around = mcr_blocks_around(blocks, column, row);
            double noise = cautious_noise(block, ratio), p;
            if (!block->count)
                continue;
            noise = mcr_max(noise, mcr_block_noise(&around) / (double)around.count * (double)block->count);
            tiles++;
            p = sum_p(block->e, noise, degrees_of_sum(mcr_block_noise(block), block->v2, degrees));
            if (p >= least)
                continue;
            least = p;
            out->local = noise > 0 ? block->e / sqrt(noise) : 0;
            out->tile[0] = pair->x0 + column * blocks->side, out->tile[1] = pair->y0 + row * blocks->side;
            out->tile[2] = pair->x0 + ((column + 1) * blocks->side < pair->width ? (column + 1) * blocks->side : pair->width);
            out->tile[3] = pair->y0 + ((row + 1) * blocks->side < pair->height ? (row + 1) * blocks->side : pair->height);
        }
    out->local_p = tiles > 0 ? mcr_min(least * tiles, 1) : MCR_NAN;
}

#define EXCESS_BLOCKS 30u /* for a standard error that is worth the name */

/* e^2 - v by blocks: one-sided t. */
static void test_excess(const struct mcr_blocks *blocks, struct mcr_bias_series *out)
{
    struct mcr_block total = mcr_blocks_total(blocks);
    struct mcr_sum squares = {0, 0};
    double count = 0, v = mcr_block_noise(&total), mean, deviation, t, p;
    for (size_t i = 0; i < blocks->count; i++)
        count += blocks->block[i].count > 0;
    mean = (total.e2 - v) / count;
    for (size_t i = 0; i < blocks->count; i++) {
        const struct mcr_block *block = &blocks->block[i];
        double d = block->e2 - mcr_block_noise(block) - mean;
        mcr_sum_add(&squares, block->count ? d * d : 0);
    }
    out->excess = out->excess_p = MCR_NAN;
    if (count < EXCESS_BLOCKS || !(total.va + total.vr > 0))
        return;
    deviation = sqrt(mcr_sum_value(squares) / (count - 1) / count);
    t = mean / deviation;
    p = deviation > 0 ? 2 * mcr_student_upper(fabs(t), count - 1) : 1;
    out->excess = total.e2 / v;
    out->excess_p = t > 0 ? p / 2 : 1 - p / 2;
}

/* Blocks for the excess: the largest of 8, 4, 2 and 1 pixels of which there are enough. */
static uint32_t excess_side(const struct mcr_pair *pair)
{
    uint32_t side = MCR_BIAS_TILE;
    while (side > 1 && (uint64_t)(pair->width / side) * (pair->height / side) < 2 * EXCESS_BLOCKS)
        side /= 2;
    return side;
}

/*
 * Independent images differ by about their noise: in most tiles the squares are near 1 of it. Of those that share all samples they are 0, of those where one
 * has half of the other's samples, 1/3.
 */
#define DEPENDENT_SQUARES 0.5
#define DEPENDENT_TILES 16u

/* All tests of one series. Returns 0, or -1 when memory is short. */
static int test_series(const struct mcr_series *series, struct mcr_bias_series *out, struct mcr_bias *bias)
{
    struct mcr_blocks tiles = {0}, blocks = {0};
    struct mcr_blocks_medians typical;
    int status = mcr_blocks_create(&tiles, series, MCR_BIAS_TILE) || mcr_blocks_create(&blocks, series, excess_side(series->pair)) ||
                 mcr_blocks_typical(&tiles, &typical);
    if (!status) {
        double ratio = typical.ratio;
        struct degrees scattered = scattered_degrees(&tiles, series, ratio), told = told_degrees(series->pair, scattered);
        double degrees = combined(scattered, ratio);
        out->degrees = combined(told, ratio);
        struct pixel_test test = pixel_test(out, told, ratio, bias->confidence);
        test_pixels(series, &test, out);
        test_mean(&tiles, ratio, degrees, out, bias->confidence);
        test_tiles(&tiles, ratio, degrees, series->pair, out);
        test_excess(&blocks, out);
        bias->dependent |= typical.count >= DEPENDENT_TILES && typical.squares < DEPENDENT_SQUARES;
    }
    free(tiles.block);
    free(blocks.block);
    return status ? -1 : 0;
}

/*
 * Whether pixels without noise differ in greater number than samples could have it by chance: an edge through a pixel that all samples of one image
 * happen to miss and all of the other hit. Of two samples an image, the fewest with a variance, and pixels half covered, the worst, that is 1 pixel in 8,
 * against 3 in 4 that show noise: a sixth of these; and four standard deviations.
 */
static int silent_differ(const struct mcr_bias_series *series)
{
    double chance = (double)(series->tested - series->silent_differing) / 6;
    return (double)series->silent_differing > chance + 4 * sqrt(chance);
}

static void judge(struct mcr_bias *bias)
{
    double least = 1;
    int silent = 0;
    for (uint32_t i = 0; i < bias->series_count; i++) {
        const struct mcr_bias_series *series = &bias->series[i];
        const double p[] = {series->mean_p, series->excess_p, series->local_p};
        for (int k = 0; k < 3; k++) {
            bias->tests += p[k] == p[k];
            least = p[k] < least ? p[k] : least;
        }
        silent |= silent_differ(series);
    }
    bias->p = silent ? 0 : least * bias->tests < 1 ? least * bias->tests : 1;
    bias->different = bias->p < 1 - bias->confidence;
}

static int test_all(const struct mcr_pair *pair, struct mcr_bias *bias)
{
    double *row = mcr_array_alloc(4 * (size_t)pair->width, sizeof *row);
    int status = row ? 0 : -1;
    for (uint32_t i = 0; i <= pair->channels && !status; i++) {
        uint32_t index = i < pair->channels ? i : MCR_PAIR_LUMINANCE;
        struct mcr_series series = {pair, index, {0, 0}, {row, row + pair->width}, {row + 2 * (size_t)pair->width, row + 3 * (size_t)pair->width}};
        for (int which = 0; which < 2; which++)
            series.variance[which] = variance_channel(pair->image[which], pair->channels, index);
        if ((index == MCR_PAIR_LUMINANCE && pair->channels == 1) || series.variance[0] < 0 || series.variance[1] < 0)
            continue; /* luminance is the one channel of a grey image; and it may lack in files that are not ours */
        struct mcr_bias_series *out = &bias->series[bias->series_count++];
        out->name = index == MCR_PAIR_LUMINANCE ? "luminance" : pair->name[index];
        status = test_series(&series, out, bias);
    }
    free(row);
    return status;
}

int mcr_bias_test(const struct mcr_image *image, const struct mcr_image *reference, const struct mcr_metrics_options *options, double confidence,
                  struct mcr_bias *bias, char *error, size_t length)
{
    struct mcr_metrics_options linear = *options;
    struct mcr_pair pair;
    linear.encoding = MCR_ENCODING_LINEAR;
    *bias = (struct mcr_bias){.confidence = confidence, .expected_share = (1e6 - 1e6 * confidence) / 1e6}; /* without digits that no decimal has */
    int status = mcr_pair_init(&pair, image, reference, &linear, error, length);
    if (!status && test_all(&pair, bias)) {
        snprintf(error, length, "out of memory");
        status = -1;
    }
    mcr_pair_fini(&pair);
    if (!status)
        judge(bias);
    return status;
}
