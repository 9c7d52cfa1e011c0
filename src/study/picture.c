/* SPDX-License-Identifier: Apache-2.0 */
#include "study/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/srgb.h"
#include "study/png.h"

void mcr_picture_channels(const struct mcr_image *image, uint32_t index[3])
{
    static const char *const name[3] = {"R", "G", "B"};
    uint32_t found = 0;
    for (uint32_t k = 0; k < 3; k++) {
        index[k] = image->channels >= 3 ? k : 0;
        for (uint32_t c = 0; image->name && c < image->channels; c++)
            found += image->name[c] && !strcmp(image->name[c], name[k]);
    }
    if (found != 3)
        return;
    for (uint32_t k = 0; k < 3; k++)
        for (uint32_t c = 0; c < image->channels; c++)
            if (!strcmp(image->name[c], name[k]))
                index[k] = c;
}

double mcr_picture_luminance(const struct mcr_image *image)
{
    size_t pixels = (size_t)image->width * image->height, count = 0;
    uint32_t channel[3];
    double sum = 0;
    mcr_picture_channels(image, channel);
    for (size_t i = 0; i < pixels; i++) {
        const double *at = image->data + i * image->channels;
        double luminance = 0.2126 * at[channel[0]] + 0.7152 * at[channel[1]] + 0.0722 * at[channel[2]];
        if (!isfinite(luminance) || luminance < 0)
            continue;
        sum += luminance;
        count++;
    }
    return count ? sum / (double)count : 0;
}

/* [0, 1]; NaN is black. */
static double displayed(double value)
{
    return value > 0 ? value < 1 ? value : 1 : 0;
}

/* The mean of one channel over the pixels that become (x, y). */
static double shrunk(const struct mcr_image *image, const struct mcr_view *view, uint32_t x, uint32_t y, uint32_t channel)
{
    uint32_t left = view->x0 + x * view->shrink, top = view->y0 + y * view->shrink, count = 0;
    double sum = 0;
    for (uint32_t j = top; j < top + view->shrink && j < view->y1; j++) {
        for (uint32_t i = left; i < left + view->shrink && i < view->x1; i++, count++)
            sum += displayed(image->data[((size_t)j * image->width + i) * image->channels + channel] * view->scale);
    }
    return sum / count;
}

void mcr_picture_write(struct mcr_text *out, const struct mcr_image *image, const struct mcr_view *view)
{
    uint32_t width = (view->x1 - view->x0 + view->shrink - 1) / view->shrink,
        height = (view->y1 - view->y0 + view->shrink - 1) / view->shrink;
    uint32_t channel[3];
    size_t length = 0, pixels = (size_t)width * height;
    uint8_t *rgb = malloc(3 * pixels);
    if (rgb) {
        mcr_picture_channels(image, channel);
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++)
                for (uint32_t k = 0; k < 3; k++)
                    rgb[3 * ((size_t)y * width + x) + k] = (uint8_t)mcr_srgb_quantise(shrunk(image, view, x, y, channel[k]), 255);
    }
    unsigned char *png = rgb ? mcr_png_encode(rgb, width, height, &length) : NULL;
    if (png) {
        mcr_text_put(out, "data:image/png;base64,");
        mcr_text_base64(out, png, length);
    } else {
        out->failed = 1;
    }
    free(png);
    free(rgb);
}

/* ---- where the images differ ----------------------------------------------------------------------------------------------------- */

int mcr_error_field_init(struct mcr_error_field *field, const struct mcr_image *reference)
{
    size_t pixels;
    field->width = reference->width;
    field->height = reference->height;
    field->sum = mcr_size_mul(field->width, field->height, &pixels) ? calloc(pixels, sizeof *field->sum) : NULL;
    return field->sum ? 0 : -1;
}

void mcr_error_field_fini(struct mcr_error_field *field)
{
    free(field->sum);
    field->sum = NULL;
}

void mcr_error_field_add(struct mcr_error_field *field, const struct mcr_image *image, const struct mcr_image *reference)
{
    uint32_t from[3], to[3];
    if (image->width != field->width || image->height != field->height)
        return;
    mcr_picture_channels(image, from);
    mcr_picture_channels(reference, to);
    for (size_t i = 0; i < (size_t)field->width * field->height; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            double r = reference->data[i * reference->channels + to[k]], e = image->data[i * image->channels + from[k]] - r;
            double relative = e * e / (r * r + 0.01);
            field->sum[i] += relative <= 1 ? relative : 1; /* NaN too */
        }
    }
}

/* The sum over a window of `side` pixels. */
static double window_sum(const struct mcr_error_field *field, uint32_t x, uint32_t y, uint32_t side)
{
    double sum = 0;
    for (uint32_t j = y; j < y + side; j++)
        for (uint32_t i = x; i < x + side; i++)
            sum += field->sum[(size_t)j * field->width + i];
    return sum;
}

void mcr_error_field_window(const struct mcr_error_field *field, const uint32_t region[4], uint32_t side, uint32_t window[4])
{
    uint32_t step = side > 4 ? side / 4 : 1; /* each pixel lies in some 16 windows: 16 times the pixels' work at any size */
    uint32_t x = region[0] + (region[2] - region[0] - side) / 2, y = region[1] + (region[3] - region[1] - side) / 2;
    double most = window_sum(field, x, y, side) * 1.000001; /* the centre, unless something is farther */
    for (uint32_t j = region[1]; j + side <= region[3]; j += step) {
        for (uint32_t i = region[0]; i + side <= region[2]; i += step) {
            double sum = window_sum(field, i, j, side);
            if (sum <= most)
                continue;
            most = sum;
            x = i;
            y = j;
        }
    }
    window[0] = x, window[1] = y, window[2] = x + side, window[3] = y + side;
}
