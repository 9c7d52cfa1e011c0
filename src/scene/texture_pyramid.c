/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A picture's levels: the colours of a file in linear light, and each level the means of the one before, by the exact area that its
 * texels cover there (so that odd sizes need no rule of their own).
 */
#include "image/image.h"
#include "scene/texture_pyramid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows from the bottom, as doubles: of a file, or of a level. */
struct rows {
    uint32_t width, height, channels;
    const struct mcr_pixels *pixels;
    const struct mcr_texture_reading *reading;
    const double *table; /* of all codes, NULL for floats */
    const float *value;  /* of a level; pixels is NULL */
};

static double decoded(const struct rows *rows, size_t at)
{
    return mcr_pixels_linear(rows->pixels, rows->reading->transfer, rows->table, at);
}

static void get_row(const struct rows *rows, uint32_t y, double *restrict out)
{
    size_t count = (size_t)rows->width * rows->channels;
    const struct mcr_texture_reading *reading = rows->reading;
    if (!rows->pixels) {
        for (size_t i = 0; i < count; i++)
            out[i] = rows->value[y * count + i];
        return;
    }
    for (size_t x = 0; x < rows->width; x++) {
        size_t at = ((rows->height - 1 - (size_t)y) * rows->width + x) * rows->pixels->channels;
        if (reading->luminance)
            out[x] = 0.2126 * decoded(rows, at + reading->channel[0]) + 0.7152 * decoded(rows, at + reading->channel[1]) +
                     0.0722 * decoded(rows, at + reading->channel[2]);
        else
            for (uint32_t c = 0; c < rows->channels; c++)
                out[x * rows->channels + c] = decoded(rows, at + reading->channel[c]);
    }
}

/*
 * Where texel k of `less` lies over those of `more` (at least as many): texel j of these covers [j less, (j + 1) less) and k covers
 * [k more, (k + 1) more), in whole numbers. Returns the first and last; the share of the last, of those in
 * between, and what is missing from 1 is the first one's.
 */
struct cover {
    uint32_t first, last;
    double inner, last_share;
};

static struct cover cover_of(uint32_t k, uint32_t less, uint32_t more)
{
    uint64_t begin = (uint64_t)k * more, end = begin + more;
    struct cover cover = { (uint32_t)(begin / less), (uint32_t)((end - 1) / less), (double)less / more, 0 };
    if (cover.last > cover.first)
        cover.last_share = (double)(end - (uint64_t)cover.last * less) / more;
    return cover;
}

/* Of any but the first. */
static double share(const struct cover *cover, uint32_t j)
{
    return j == cover->last ? cover->last_share : cover->inner;
}

/* Means along a row: as the first value plus weighted differences, so that what is constant stays so to the last bit. */
static void narrow_row(const double *restrict in, uint32_t width, uint32_t less, uint32_t channels, double *restrict out)
{
    for (uint32_t k = 0; k < less; k++) {
        struct cover cover = cover_of(k, less, width);
        for (uint32_t c = 0; c < channels; c++) {
            double start = in[(size_t)cover.first * channels + c], sum = 0;
            for (uint32_t j = cover.first + 1; j <= cover.last; j++)
                sum += share(&cover, j) * (in[(size_t)j * channels + c] - start);
            out[(size_t)k * channels + c] = start + sum;
        }
    }
}

/* Half the size of `rows` in both directions, rounded down, at least 1. 0, or -1 without memory. */
static int reduce(const struct rows *rows, float *restrict to)
{
    uint32_t width = mcr_texture_half(rows->width), height = mcr_texture_half(rows->height), channels = rows->channels;
    size_t count = (size_t)width * channels, wide = (size_t)rows->width * channels;
    double *work = malloc((wide + 3 * count) * sizeof *work), *row = work, *narrow = work + wide;
    double *start = narrow + count, *sum = start + count;
    if (!work)
        return -1;
    for (uint32_t y = 0; y < height; y++) {
        struct cover cover = cover_of(y, height, rows->height);
        memset(sum, 0, count * sizeof *sum);
        for (uint32_t j = cover.first; j <= cover.last; j++) {
            double part = share(&cover, j);
            get_row(rows, j, row);
            narrow_row(row, rows->width, width, channels, j == cover.first ? start : narrow);
            for (size_t i = 0; j > cover.first && i < count; i++)
                sum[i] += part * (narrow[i] - start[i]);
        }
        for (size_t i = 0; i < count; i++)
            to[y * count + i] = (float)(start[i] + sum[i]);
    }
    free(work);
    return 0;
}

/* Least, largest and mean value of each channel; counts those that are not finite as floats. -1 without memory. */
static int survey(const struct rows *rows, struct mcr_texture_survey *survey)
{
    uint32_t channels = rows->channels;
    size_t count = (size_t)rows->width * channels;
    double *row = malloc(count * sizeof *row);
    *survey = (struct mcr_texture_survey){ .bounds = { .min = { INFINITY, INFINITY, INFINITY }, .max = { -INFINITY, -INFINITY, -INFINITY } } };
    if (!row)
        return -1;
    for (uint32_t y = 0; y < rows->height; y++) {
        double sum[3] = { 0 };
        get_row(rows, y, row);
        for (size_t i = 0; i < count; i++) {
            double value = (float)row[i];
            uint32_t c = (uint32_t)(i % channels);
            if (!isfinite(value)) {
                if (survey->not_finite++ == 0)
                    survey->x = (uint32_t)(i / channels), survey->y = rows->height - 1 - y;
                continue;
            }
            sum[c] += value;
            survey->bounds.min[c] = value < survey->bounds.min[c] ? value : survey->bounds.min[c];
            survey->bounds.max[c] = value > survey->bounds.max[c] ? value : survey->bounds.max[c];
        }
        for (uint32_t c = 0; c < channels; c++)
            survey->bounds.mean[c] += sum[c] / rows->width / rows->height;
    }
    free(row);
    for (uint32_t c = channels; c < 3; c++) {
        survey->bounds.min[c] = survey->bounds.min[0];
        survey->bounds.max[c] = survey->bounds.max[0];
        survey->bounds.mean[c] = survey->bounds.mean[0];
    }
    return 0;
}

uint64_t mcr_texture_room(uint32_t width, uint32_t height, uint32_t channels, int codes, int pyramid)
{
    uint64_t bytes = (uint64_t)width * height * channels * (codes ? 1 : sizeof(float));
    bytes = (bytes + 63) / 64 * 64;
    while (pyramid && (width > 1 || height > 1)) {
        width = mcr_texture_half(width);
        height = mcr_texture_half(height);
        bytes += (uint64_t)width * height * channels * sizeof(float);
    }
    return bytes;
}

/* All linear values of codes; NULL with *failed set without memory, or where there are no codes. */
static double *decoding(const struct mcr_pixels *pixels, const struct mcr_texture_reading *reading, int *failed)
{
    double *table = mcr_pixels_table(pixels, reading->transfer);
    *failed = pixels->peak && !table;
    for (uint32_t k = 0; table && k <= pixels->peak; k++)
        table[k] = (float)table[k]; /* what levels hold */
    return table;
}

/* The first level from a file whose size is kept. -1 without memory. */
static int store_first(const struct rows *rows, struct mcr_texture_image *image, void *memory, int codes)
{
    size_t count = (size_t)rows->width * rows->channels;
    double *row = codes ? NULL : malloc(count * sizeof *row);
    float *value = memory;
    uint8_t *code = memory;
    if (codes) {
        for (uint32_t k = 0; k < 256; k++)
            image->decode[k] = (float)rows->table[k < rows->pixels->peak ? k : rows->pixels->peak];
        for (size_t y = 0; y < rows->height; y++)
            for (size_t x = 0; x < rows->width; x++)
                for (uint32_t c = 0; c < rows->channels; c++)
                    code[y * count + x * rows->channels + c] =
                        rows->pixels->code[((rows->height - 1 - y) * rows->width + x) * rows->pixels->channels + rows->reading->channel[c]];
        image->level[0] = (struct mcr_texture_level){ rows->width, rows->height, code, NULL };
        return 0;
    }
    if (!row)
        return -1;
    for (uint32_t y = 0; y < rows->height; y++) {
        get_row(rows, y, row);
        for (size_t i = 0; i < count; i++)
            value[y * count + i] = (float)row[i];
    }
    free(row);
    image->level[0] = (struct mcr_texture_level){ rows->width, rows->height, NULL, value };
    return 0;
}

/* The first level from a file that is halved `dropped` times. -1 without memory. */
static int store_reduced(struct rows rows, uint32_t dropped, struct mcr_texture_image *image, float *memory)
{
    float *before = NULL;
    for (uint32_t i = 0; i < dropped; i++) {
        uint32_t width = mcr_texture_half(rows.width), height = mcr_texture_half(rows.height);
        float *to = i + 1 == dropped ? memory : malloc((size_t)width * height * rows.channels * sizeof *to);
        int failed = !to || reduce(&rows, to) != 0;
        free(before);
        before = i + 1 == dropped ? NULL : to;
        if (failed)
            return free(before), -1;
        rows.pixels = NULL;
        rows.value = to;
        rows.width = width;
        rows.height = height;
    }
    image->level[0] = (struct mcr_texture_level){ rows.width, rows.height, NULL, memory };
    return 0;
}

/* The levels behind the first, in the memory behind it. `file` is read once more where the first level is of codes. -1 without memory. */
static int store_levels(const struct rows *file, struct mcr_texture_image *image, float *memory)
{
    while (image->level_count < MCR_TEXTURE_LEVELS) {
        const struct mcr_texture_level *last = &image->level[image->level_count - 1];
        struct rows rows = { last->width, last->height, image->channels, NULL, NULL, NULL, last->value };
        uint32_t width = mcr_texture_half(last->width), height = mcr_texture_half(last->height);
        if (last->width == 1 && last->height == 1)
            return 0;
        if (reduce(last->code ? file : &rows, memory) != 0)
            return -1;
        image->level[image->level_count++] = (struct mcr_texture_level){ width, height, NULL, memory };
        memory += (size_t)width * height * image->channels;
    }
    return 0;
}

static int build(const struct rows *file, uint32_t dropped, struct mcr_texture_image *image, struct mcr_texture_survey *found)
{
    uint32_t width = file->width, height = file->height;
    int codes = dropped == 0 && mcr_texture_codes(file->pixels, file->reading), pyramid = image->filter == MCR_TEXTURE_MIPMAP, failed;
    size_t first;
    for (uint32_t i = 0; i < dropped; i++) {
        width = mcr_texture_half(width);
        height = mcr_texture_half(height);
    }
    if (survey(file, found) != 0)
        return -1;
    if (found->not_finite)
        return 0;
    first = (size_t)mcr_texture_room(width, height, file->channels, codes, 0);
    image->channels = file->channels;
    image->level_count = 1;
    image->memory = malloc((size_t)mcr_texture_room(width, height, file->channels, codes, pyramid));
    if (!image->memory)
        return -1;
    failed = dropped ? store_reduced(*file, dropped, image, image->memory) : store_first(file, image, image->memory, codes);
    return failed || (pyramid && store_levels(file, image, (float *)(void *)((char *)image->memory + first)) != 0) ? -1 : 0;
}

int mcr_texture_pyramid(const struct mcr_pixels *pixels, const struct mcr_texture_reading *reading, uint32_t dropped,
                        struct mcr_texture_image *image, struct mcr_texture_survey *found)
{
    struct rows file = { pixels->width, pixels->height, reading->channels, pixels, reading, NULL, NULL };
    int failed;
    double *table = decoding(pixels, reading, &failed);
    file.table = table;
    if (!failed)
        failed = build(&file, dropped, image, found);
    free(table);
    if (failed) {
        free(image->memory);
        image->memory = NULL;
    }
    return failed ? -1 : 0;
}
