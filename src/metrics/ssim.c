/* SPDX-License-Identifier: Apache-2.0 */
#include "metrics/ssim.h"

#include <stdlib.h>

#include "base/elementary.h"
#include "base/memory.h"
#include "metrics/sum.h"

#define TAPS MCR_SSIM_TAPS
#define MOMENTS 4u /* weighted means of a, r, a^2 + r^2, a r */

/* Where the rows of one scale come from: the pair, or a halved plane of each image. */
struct source {
    const struct mcr_pair *pair; /* at scale 1, else NULL */
    uint32_t series;
    const double *plane[2];
    uint32_t width, height;
};

/* What the windows of one scale give. */
struct means {
    struct mcr_sum ssim, contrast;
    uint64_t windows;
};

/* Rows of the windows' moments: the last TAPS rows, filtered along x. */
struct filter {
    double weight[TAPS], c1, c2;
    uint32_t columns;      /* windows side by side */
    double *row[2];        /* the values of one row of each image */
    double *product;       /* values that are filtered: of one moment */
    double *ring;          /* [TAPS][MOMENTS][columns] */
    double *moment;        /* [MOMENTS][columns], filtered along y too */
};

static void source_row(const struct source *source, int which, uint32_t y, double *row)
{
    if (source->pair)
        mcr_pair_row(source->pair, which, source->series, y, row);
    else
        memcpy(row, source->plane[which] + (size_t)y * source->width, source->width * sizeof *row);
}

static void filter_fini(struct filter *filter)
{
    free(filter->row[0]);
    free(filter->row[1]);
    free(filter->product);
    free(filter->ring);
    free(filter->moment);
}

static int filter_init(struct filter *filter, uint32_t width, double peak)
{
    double sum = 0;
    *filter = (struct filter){.columns = width - TAPS + 1, .c1 = 0.01 * peak * (0.01 * peak), .c2 = 0.03 * peak * (0.03 * peak)};
    for (uint32_t k = 0; k < TAPS; k++) {
        double d = (double)k - TAPS / 2;
        sum += filter->weight[k] = mcr_exp(-d * d / (2 * 1.5 * 1.5));
    }
    for (uint32_t k = 0; k < TAPS; k++)
        filter->weight[k] /= sum;
    filter->row[0] = mcr_array_alloc(width, sizeof(double));
    filter->row[1] = mcr_array_alloc(width, sizeof(double));
    filter->product = mcr_array_alloc(width, sizeof(double));
    filter->ring = mcr_array_alloc((size_t)TAPS * MOMENTS * filter->columns, sizeof(double));
    filter->moment = mcr_array_alloc((size_t)MOMENTS * filter->columns, sizeof(double));
    return filter->row[0] && filter->row[1] && filter->product && filter->ring && filter->moment ? 0 : -1;
}

/* Row y of the source, filtered along x, enters the ring. */
static void filter_take(struct filter *filter, const struct source *source, uint32_t y)
{
    double *restrict value = filter->product;
    const double *a = filter->row[0], *r = filter->row[1];
    source_row(source, 0, y, filter->row[0]);
    source_row(source, 1, y, filter->row[1]);
    for (uint32_t m = 0; m < MOMENTS; m++) {
        double *restrict out = filter->ring + ((size_t)(y % TAPS) * MOMENTS + m) * filter->columns;
        for (uint32_t x = 0; x < source->width; x++)
            value[x] = m == 0 ? a[x] : m == 1 ? r[x] : m == 2 ? a[x] * a[x] + r[x] * r[x] : a[x] * r[x];
        for (uint32_t x = 0; x < filter->columns; x++)
            out[x] = filter->weight[0] * value[x];
        for (uint32_t k = 1; k < TAPS; k++)
            for (uint32_t x = 0; x < filter->columns; x++)
                out[x] += filter->weight[k] * value[x + k];
    }
}

/* The windows whose last row is y, filtered along y. */
static void filter_columns(struct filter *filter, uint32_t y)
{
    size_t count = (size_t)MOMENTS * filter->columns;
    double *restrict out = filter->moment;
    for (uint32_t k = 0; k < TAPS; k++) {
        const double *restrict in = filter->ring + (y + 1 + k) % TAPS * count; /* the oldest row first */
        for (size_t i = 0; i < count; i++)
            out[i] = (k ? out[i] : 0) + filter->weight[k] * in[i];
    }
}

static void add_windows(const struct filter *filter, const struct source *source, uint32_t y, struct means *means)
{
    const double *a = filter->moment, *r = a + filter->columns, *squares = r + filter->columns, *products = squares + filter->columns;
    for (uint32_t x = 0; x < filter->columns; x++) {
        double both = a[x] * r[x], power = a[x] * a[x] + r[x] * r[x];
        double contrast = (2 * (products[x] - both) + filter->c2) / (squares[x] - power + filter->c2);
        double ssim = (2 * both + filter->c1) / (power + filter->c1) * contrast;
        if (source->pair && (!mcr_pair_has(source->pair, x + TAPS / 2, y - TAPS / 2) || (source->pair->left_out && ssim != ssim)))
            continue;
        mcr_sum_add(&means->ssim, ssim);
        mcr_sum_add(&means->contrast, contrast);
        means->windows++;
    }
}

static int measure_scale(const struct source *source, double peak, struct means *means)
{
    struct filter filter;
    int status = filter_init(&filter, source->width, peak);
    *means = (struct means){0};
    for (uint32_t y = 0; !status && y < source->height; y++) {
        filter_take(&filter, source, y);
        if (y + 1 < TAPS)
            continue;
        filter_columns(&filter, y);
        add_windows(&filter, source, y, means);
    }
    filter_fini(&filter);
    return status;
}

/* Halves both sides of rows that `source` gives, into `plane`, which may be the source's own. row: room for two of its rows. */
static void halve(const struct source *source, int which, double *row, double *plane)
{
    uint32_t width = (source->width + 1) / 2, height = (source->height + 1) / 2, last_x = source->width - 1, last_y = source->height - 1;
    double *above = row, *below = row + source->width;
    for (uint32_t y = 0; y < height; y++) {
        source_row(source, which, 2 * y, above);
        source_row(source, which, 2 * y < last_y ? 2 * y + 1 : last_y, below);
        for (uint32_t x = 0; x < width; x++) {
            uint32_t left = 2 * x, right = left < last_x ? left + 1 : last_x;
            plane[(size_t)y * width + x] = 0.25 * ((above[left] + above[right]) + (below[left] + below[right]));
        }
    }
}

/* The product over the scales, whose first is measured already. Returns 0, or -1 when memory is short. */
static int measure_scales(const struct source *first, double peak, struct means means, double *result)
{
    static const double exponent[MCR_SSIM_SCALES] = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
    struct source source = *first;
    size_t pixels = (size_t)(source.width / 2 + 1) * (source.height / 2 + 1);
    double *plane[2] = {mcr_array_alloc(pixels, sizeof(double)), mcr_array_alloc(pixels, sizeof(double))};
    double *row = mcr_array_alloc(2 * (size_t)source.width, sizeof(double));
    int status = plane[0] && plane[1] && row ? 0 : -1;
    *result = 1;
    for (uint32_t scale = 0; !status && scale < MCR_SSIM_SCALES; scale++) {
        if (scale > 0) {
            halve(&source, 0, row, plane[0]);
            halve(&source, 1, row, plane[1]);
            source = (struct source){.plane = {plane[0], plane[1]}, .width = (source.width + 1) / 2, .height = (source.height + 1) / 2};
            status = measure_scale(&source, peak, &means);
        }
        double mean = mcr_sum_value(scale + 1 < MCR_SSIM_SCALES ? means.contrast : means.ssim) / (double)means.windows;
        *result *= mean < 0 ? 0 : mcr_pow(mean, exponent[scale]);
    }
    free(plane[0]);
    free(plane[1]);
    free(row);
    return status;
}

int mcr_ssim_measure(const struct mcr_pair *pair, uint32_t series, double *ssim, double *ms_ssim, const char **ssim_note, const char **ms_ssim_note)
{
    static const char range[] = "undefined: the values are too large";
    struct source source = {.pair = pair, .series = series, .width = pair->width, .height = pair->height};
    struct means means = {.windows = 0};
    int small = pair->width < TAPS || pair->height < TAPS;
    if (!small && measure_scale(&source, pair->peak, &means))
        return -1;
    if (ssim) {
        *ssim = means.windows ? mcr_sum_value(means.ssim) / (double)means.windows : MCR_NAN;
        *ssim_note = small             ? "undefined: a side of the region is below 11 pixels"
                     : !means.windows  ? "undefined: no window of 11 by 11 pixels lies within the region around a pixel that takes part"
                     : isfinite(*ssim) ? NULL
                                       : range;
    }
    if (!ms_ssim)
        return 0;
    *ms_ssim = MCR_NAN;
    if (pair->width < MCR_MS_SSIM_SIDE || pair->height < MCR_MS_SSIM_SIDE) {
        *ms_ssim_note = "undefined: a side of the region is below 176 pixels";
        return 0;
    }
    if (pair->pixels < (uint64_t)pair->width * pair->height) {
        *ms_ssim_note = "undefined: the region is no rectangle";
        return 0;
    }
    int status = measure_scales(&source, pair->peak, means, ms_ssim);
    *ms_ssim_note = isfinite(*ms_ssim) ? NULL : range;
    return status;
}
