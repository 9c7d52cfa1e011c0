/* SPDX-License-Identifier: Apache-2.0 */
#include "metrics/pair.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "core/cell.h"
#include "image/srgb.h"

#define CODES 256

static int fail(char *error, size_t length, const char *format, ...) __attribute__((format(printf, 3, 4)));
static int fail(char *error, size_t length, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error, length, format, arguments);
    va_end(arguments);
    return -1;
}

int mcr_pair_channel(const struct mcr_image *image, const char *name)
{
    for (uint32_t c = 0; image->name && c < image->channels; c++)
        if (image->name[c] && !strcmp(image->name[c], name))
            return (int)c;
    return -1;
}

/* R, G and B by name, or Y, or where there are no names the first three or the only one. Returns how many, 0: none of these. */
static uint32_t colour_channels(const struct mcr_image *image, uint32_t from[MCR_METRICS_CHANNELS])
{
    int r = mcr_pair_channel(image, "R"), g = mcr_pair_channel(image, "G"), b = mcr_pair_channel(image, "B"), grey = mcr_pair_channel(image, "Y");
    if (!image->name && image->channels >= 3)
        r = 0, g = 1, b = 2;
    if (r >= 0 && g >= 0 && b >= 0) {
        from[0] = (uint32_t)r, from[1] = (uint32_t)g, from[2] = (uint32_t)b;
        return 3;
    }
    from[0] = grey >= 0 ? (uint32_t)grey : 0;
    return grey >= 0 || image->channels == 1;
}

static int match(struct mcr_pair *pair, char *error, size_t length)
{
    static const char *const colours[] = {"R", "G", "B"}, *const words[] = {"neither R, G, B nor Y", "one grey channel", "", "R, G, B"};
    const struct mcr_image *a = pair->image[0], *r = pair->image[1];
    uint32_t of_image = colour_channels(a, pair->from[0]), of_reference = colour_channels(r, pair->from[1]);
    if (a->width != r->width || a->height != r->height)
        return fail(error, length, "different sizes: the image has %ux%u pixels, the reference %ux%u", a->width, a->height, r->width, r->height);
    if (of_image != of_reference || !of_image)
        return fail(error, length, "different channels: the image has %s, the reference %s; both must have R, G, B or be grey", words[of_image],
                    words[of_reference]);
    pair->channels = of_image;
    for (uint32_t c = 0; c < of_image; c++)
        pair->name[c] = of_image == 1 ? "Y" : colours[c];
    return 0;
}

static int choose_region(struct mcr_pair *pair, const struct mcr_metrics_options *options, char *error, size_t length)
{
    const struct mcr_image *image = pair->image[0];
    const uint32_t *crop = options->crop;
    pair->width = image->width, pair->height = image->height;
    if (options->mask && (options->mask->width != image->width || options->mask->height != image->height))
        return fail(error, length, "the mask has %ux%u pixels, the images %ux%u", options->mask->width, options->mask->height, image->width, image->height);
    if (!options->has_crop)
        return 0;
    if (crop[0] >= crop[2] || crop[1] >= crop[3] || crop[2] > image->width || crop[3] > image->height)
        return fail(error, length, "the crop %u,%u,%u,%u is empty or reaches beyond the images, which have %ux%u pixels", crop[0], crop[1], crop[2], crop[3],
                    image->width, image->height);
    pair->x0 = crop[0], pair->y0 = crop[1], pair->width = crop[2] - crop[0], pair->height = crop[3] - crop[1];
    return 0;
}

static int masked_in(const struct mcr_image *mask, uint32_t x, uint32_t y)
{
    const double *pixel = mask->data + ((size_t)y * mask->width + x) * mask->channels;
    for (uint32_t c = 0; c < mask->channels; c++)
        if (pixel[c] != 0 && !(mask->name && mask->name[c] && !strcmp(mask->name[c], "A")))
            return 1;
    return 0;
}

static const double *pixel_of(const struct mcr_pair *pair, int which, uint32_t x, uint32_t y)
{
    const struct mcr_image *image = pair->image[which];
    return image->data + ((size_t)(pair->y0 + y) * image->width + pair->x0 + x) * image->channels;
}

/* Counts the values of a pixel that are not finite. */
static int finite_pixel(struct mcr_pair *pair, uint32_t x, uint32_t y)
{
    int good = 1;
    for (int which = 0; which < 2; which++) {
        const double *pixel = pixel_of(pair, which, x, y);
        for (uint32_t c = 0; c < pair->channels; c++)
            if (!isfinite(pixel[pair->from[which][c]])) {
                pair->not_finite[which]++;
                good = 0;
            }
    }
    return good;
}

/* Which pixels take part, and where the first is that is not finite. */
static void take_part(struct mcr_pair *pair, const struct mcr_metrics_options *options, uint32_t first[2])
{
    for (uint32_t y = 0; y < pair->height; y++)
        for (uint32_t x = 0; x < pair->width; x++) {
            int in = !options->mask || masked_in(options->mask, pair->x0 + x, pair->y0 + y);
            if (in && !finite_pixel(pair, x, y)) {
                if (!pair->left_out++)
                    first[0] = pair->x0 + x, first[1] = pair->y0 + y;
                in = 0;
            }
            if (pair->part)
                pair->part[(size_t)y * pair->width + x] = (unsigned char)in;
            pair->pixels += (uint64_t)in;
        }
}

static double encode(const struct mcr_pair *pair, double v);

static void find_range(struct mcr_pair *pair)
{
    for (int which = 0; which < 2; which++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t y = 0; y < pair->height; y++)
            for (uint32_t x = 0; x < pair->width; x++) {
                const double *pixel = pixel_of(pair, which, x, y);
                for (uint32_t c = 0; c < pair->channels && mcr_pair_has(pair, x, y); c++) {
                    double v = pixel[pair->from[which][c]];
                    low = v < low ? v : low;
                    high = v > high ? v : high;
                }
            }
        pair->range[which][0] = encode(pair, low); /* the encodings are monotonic */
        pair->range[which][1] = encode(pair, high);
    }
}

static int prepare_encoding(struct mcr_pair *pair, const struct mcr_metrics_options *options, char *error, size_t length)
{
    pair->encoding = options->encoding;
    pair->peak = options->peak > 0 ? options->peak : pair->encoding == MCR_ENCODING_SRGB8 ? 255 : 1;
    if (pair->encoding != MCR_ENCODING_SRGB8)
        return 0;
    pair->edge = calloc(CODES + 1, sizeof *pair->edge);
    if (!pair->edge)
        return fail(error, length, "out of memory");
    for (int k = 1; k < CODES; k++)
        pair->edge[k] = mcr_srgb_decode((k - 0.5) / 255.0);
    pair->edge[CODES] = 2.0;
    return 0;
}

int mcr_pair_init(struct mcr_pair *pair, const struct mcr_image *image, const struct mcr_image *reference, const struct mcr_metrics_options *options,
                  char *error, size_t length)
{
    uint32_t first[2] = {0, 0};
    memset(pair, 0, sizeof *pair);
    pair->image[0] = image;
    pair->image[1] = reference;
    if (match(pair, error, length) || choose_region(pair, options, error, length) || prepare_encoding(pair, options, error, length))
        return -1;
    if (options->mask || options->exclude_not_finite) {
        size_t pixels;
        pair->part = mcr_size_mul(pair->width, pair->height, &pixels) ? malloc(pixels) : NULL;
        if (!pair->part)
            return fail(error, length, "out of memory");
    }
    take_part(pair, options, first);
    if (pair->left_out && !options->exclude_not_finite)
        return fail(error, length, "%llu values of the image and %llu of the reference are NaN or infinite, in %llu pixels; the first is pixel %u,%u",
                    (unsigned long long)pair->not_finite[0], (unsigned long long)pair->not_finite[1], (unsigned long long)pair->left_out, first[0], first[1]);
    if (!pair->pixels)
        return fail(error, length, "no pixel takes part: %s", pair->left_out ? "none of the region is finite" : "the mask is black in the region");
    find_range(pair);
    return 0;
}

void mcr_pair_fini(struct mcr_pair *pair)
{
    free(pair->part);
    free(pair->edge);
    pair->part = NULL;
    pair->edge = NULL;
}

/* The code that an 8-bit file would hold, as mcr_srgb_quantise(v, 255) has it; its power is taken only next to an edge (see image/encode.c). */
static double code_of(const double *edge, double v)
{
    uint32_t k = 0;
    if (!(v > 0))
        return v <= 0 ? 0 : v;
    if (v >= 1)
        return 255;
    for (uint32_t step = CODES / 2; step; step >>= 1)
        k += v >= edge[k + step] ? step : 0;
    return v < edge[k] * (1 + 1e-9) || v > edge[k + 1] * (1 - 1e-9) ? mcr_srgb_quantise(v, 255) : k;
}

static double encode(const struct mcr_pair *pair, double v)
{
    return pair->encoding == MCR_ENCODING_SRGB8 ? code_of(pair->edge, v) : v;
}

void mcr_pair_channel_row(const struct mcr_pair *pair, int which, uint32_t channel, uint32_t y, double *row)
{
    uint32_t channels = pair->image[which]->channels;
    const double *value = pixel_of(pair, which, 0, y) + channel;
    for (uint32_t x = 0; x < pair->width; x++)
        row[x] = value[(size_t)x * channels];
}

void mcr_pair_row(const struct mcr_pair *pair, int which, uint32_t series, uint32_t y, double *row)
{
    const uint32_t *from = pair->from[which];
    uint32_t channels = pair->image[which]->channels;
    const double *pixel = pixel_of(pair, which, 0, y);
    if (series != MCR_PAIR_LUMINANCE || pair->channels == 1)
        mcr_pair_channel_row(pair, which, from[series == MCR_PAIR_LUMINANCE ? 0 : series], y, row);
    else
        for (uint32_t x = 0; x < pair->width; x++, pixel += channels)
            row[x] = mcr_luminance(pixel[from[0]], pixel[from[1]], pixel[from[2]]);
    for (uint32_t x = 0; pair->encoding != MCR_ENCODING_LINEAR && x < pair->width; x++)
        row[x] = encode(pair, row[x]);
}
