/* SPDX-License-Identifier: Apache-2.0 */
#include "film/allocate.h"

#include <float.h>
#include <math.h>

/* Sums over neighbours in a row, then over these sums in a column: plain sums, since running ones would carry rounding from pixel to pixel. */
static double row_mean(const double *row, uint32_t width, uint32_t x)
{
    uint32_t from = x > MCR_NOISE_REACH ? x - MCR_NOISE_REACH : 0, to = width - x > MCR_NOISE_REACH ? x + MCR_NOISE_REACH + 1 : width;
    double sum = 0;
    for (uint32_t i = from; i < to; i++)
        sum += row[i];
    return sum / (to - from);
}

static double column_mean(const double *means, uint32_t width, uint32_t height, uint32_t x, uint32_t y)
{
    uint32_t from = y > MCR_NOISE_REACH ? y - MCR_NOISE_REACH : 0, to = height - y > MCR_NOISE_REACH ? y + MCR_NOISE_REACH + 1 : height;
    double sum = 0;
    for (uint32_t i = from; i < to; i++)
        sum += means[(uint64_t)i * width + x];
    return sum / (to - from);
}

void mcr_noise(uint32_t width, uint32_t height, double *variance, const double *cells, double *noise, double *scratch)
{
    const uint64_t pixels = (uint64_t)width * height;
    double most = 0, scale;
    for (uint64_t p = 0; p < pixels; p++)
        most = variance[p] <= DBL_MAX && variance[p] > most ? variance[p] : most;
    /* Scaled to 1, so that no sum overflows. */
    scale = most > 0 ? most : 1;
    for (uint64_t p = 0; p < pixels; p++)
        variance[p] = variance[p] <= DBL_MAX ? variance[p] / scale : 1;
    for (uint64_t p = 0; p < pixels; p++)
        scratch[p] = row_mean(variance + p / width * width, width, (uint32_t)(p % width));
    for (uint64_t p = 0; p < pixels; p++) {
        double around = column_mean(scratch, width, height, (uint32_t)(p % width), (uint32_t)(p / width));
        noise[p] = sqrt((cells[p] * variance[p] + MCR_NOISE_PRIOR * around) / (cells[p] + MCR_NOISE_PRIOR));
    }
}

/*
 * The factor c with the sum of max(low, c noise) = total: from c = total / sum(noise) down, with those at their lower bounds left out, until no more are.
 * Each round but the last takes at least one pixel out, and a few do in practice. 0 where the lower bounds leave nothing.
 */
static double factor(uint64_t pixels, const double *noise, const uint32_t *have, uint32_t least, double total)
{
    double c = DBL_MAX;
    uint64_t bound = UINT64_MAX;
    for (int tries = 0; tries < 100; tries++) {
        double low = 0, sum = 0;
        uint64_t now = 0;
        for (uint64_t p = 0; p < pixels; p++) {
            double lower = have[p] > least ? have[p] : least;
            if (c * noise[p] <= lower) {
                low += lower;
                now++;
            } else {
                sum += noise[p];
            }
        }
        if (now == bound || now == pixels)
            break;
        bound = now;
        c = (total - low) / sum;
        if (!(c > 0))
            return 0;
    }
    return c;
}

uint64_t mcr_allocate(uint64_t pixels, const double *noise, const uint32_t *have, uint32_t least, uint32_t most, double total, uint32_t *want)
{
    double c, each, sum = 0, bounds = 0, carry = 0.5; /* rounds the total, which is whole */
    uint64_t added = 0, noisy = 0;
    for (uint64_t p = 0; p < pixels; p++) {
        noisy += noise[p] > 0;
        sum += have[p];
        bounds += have[p] > least ? have[p] : least;
    }
    if (bounds > total) /* next time */
        least = 0;
    c = noisy ? factor(pixels, noise, have, least, total) : 0;
    each = (total - sum) / (double)pixels;
    for (uint64_t p = 0; p < pixels; p++) {
        double lower = have[p] > least ? have[p] : least, wish = noisy ? c * noise[p] : have[p] + each;
        carry += wish > lower ? wish - lower : 0;
        double whole = floor(carry), room = most > lower ? most - lower : 0;
        whole = whole < room ? whole : room;
        carry = carry - whole < 1 ? carry - whole : 1; /* what a full pixel cannot take is not for its neighbour */
        want[p] = (uint32_t)(lower + whole);
        added += want[p] - have[p];
    }
    return added;
}
