/* SPDX-License-Identifier: Apache-2.0 */
#include "image/pixels.h"

#include "image/fail.h"
#include "image/format.h"
#include "image/image.h"
#include "image/module.h"
#include "image/read.h"
#include "image/srgb.h"

#include <stdlib.h>
#include <string.h>

double mcr_transfer_decode(uint32_t transfer, double gamma, double encoded)
{
    if (transfer == MCR_TRANSFER_SRGB) return mcr_srgb_decode(encoded);
    if (transfer == MCR_TRANSFER_LINEAR) return encoded;
    return encoded < 0 ? -mcr_pow(-encoded, gamma) : mcr_pow(encoded, gamma);
}

double *mcr_pixels_table(const struct mcr_pixels *pixels, uint32_t transfer)
{
    double *table = pixels->peak ? malloc(((size_t)pixels->peak + 1) * sizeof *table) : NULL;
    for (uint32_t k = 0; table && k <= pixels->peak; k++) table[k] = mcr_transfer_decode(transfer, pixels->gamma, (double)k / pixels->peak);
    return table;
}

double mcr_pixels_linear(const struct mcr_pixels *pixels, uint32_t transfer, const double *table, size_t at)
{
    if (pixels->peak) return table[pixels->peak < 256 ? pixels->code[at] : pixels->wide[at]];
    return transfer == MCR_TRANSFER_LINEAR ? (double)pixels->value[at] : mcr_transfer_decode(transfer, pixels->gamma, pixels->value[at]);
}

struct mcr_pixels *mcr_pixels_create(uint32_t width, uint32_t height, uint32_t channels, uint32_t peak)
{
    size_t size = peak == 0 ? sizeof(float) : peak < 256 ? 1 : 2;
    if (!width || !height || !channels || width > MCR_IMAGE_MAX_SIDE || height > MCR_IMAGE_MAX_SIDE || channels > MCR_IMAGE_MAX_CHANNELS ||
        (uint64_t)width * height * channels > MCR_IMAGE_MAX_BYTES / size)
        return NULL;
    struct mcr_pixels *pixels = calloc(1, sizeof *pixels);
    void *memory = pixels ? calloc((size_t)width * height * channels, size) : NULL;
    if (!memory) {
        free(pixels);
        return NULL;
    }
    *pixels = (struct mcr_pixels){.width = width, .height = height, .channels = channels, .peak = peak, .alpha = -1, .memory = memory};
    if (peak == 0) pixels->value = memory;
    else if (peak < 256) pixels->code = memory;
    else pixels->wide = memory;
    return pixels;
}

void mcr_pixels_destroy(struct mcr_pixels *pixels)
{
    if (!pixels) return;
    free(pixels->memory);
    free(pixels);
}

static int32_t channel_named(const char *const *names, uint32_t count, const char *name)
{
    for (uint32_t c = 0; c < count; c++)
        if (!strcmp(names[c], name)) return (int32_t)c;
    return -1;
}

void mcr_pixels_name(struct mcr_pixels *pixels, const char *const *names, int32_t alpha)
{
    uint32_t n = pixels->channels;
    int32_t r = channel_named(names, n, "R"), g = channel_named(names, n, "G"), b = channel_named(names, n, "B");
    int32_t y = channel_named(names, n, "Y");
    pixels->alpha = alpha >= 0 && alpha < (int32_t)n ? alpha : channel_named(names, n, "A");
    if (r < 0 || g < 0 || b < 0) r = g = b = y; /* grey */
    if (r < 0 && n >= 3) r = 0, g = 1, b = 2;   /* no names that are known: in their order */
    if (r < 0) r = g = b = pixels->alpha == 0 && n > 1 ? 1 : 0;
    pixels->red = r, pixels->green = g, pixels->blue = b;
}

/* What is read as doubles and was floats in the file. */
static struct mcr_pixels *floats_of(struct mcr_image *image)
{
    struct mcr_pixels *pixels = image ? mcr_pixels_create(image->width, image->height, image->channels, 0) : NULL;
    size_t count = pixels ? (size_t)image->width * image->height * image->channels : 0;
    float *values = pixels ? pixels->memory : NULL;
    for (size_t i = 0; i < count; i++) values[i] = (float)image->data[i];
    if (pixels) mcr_pixels_name(pixels, image->name, -1);
    mcr_image_destroy(image);
    return pixels;
}

static uint64_t hash_of(const unsigned char *bytes, size_t count)
{
    uint64_t hash = 14695981039346656037u;
    for (size_t i = 0; i < count; i++) hash = (hash ^ bytes[i]) * 1099511628211u;
    return hash;
}

/* As mcr_image_decode. */
static struct mcr_pixels *decode(const unsigned char *bytes, size_t count, int data, char *error, size_t length)
{
    const char *module = NULL;
    switch (mcr_format_of_bytes(bytes, count, &module)) {
    case MCR_MAGIC_PNM: return mcr_pnm_pixels(bytes, count, error, length);
    case MCR_MAGIC_PFM: return floats_of(mcr_pfm_read(bytes, count, error, length));
    case MCR_MAGIC_MODULE:
        return mcr_image_needs_module(module, error, length) ? NULL : mcr_module_pixels(module, bytes, count, data, error, length);
    case MCR_MAGIC_UNKNOWN: break;
    }
    mcr_image_unknown(count, error, length);
    return NULL;
}

struct mcr_pixels *mcr_pixels_read(const char *path, int data, char *error, size_t length)
{
    size_t count = 0;
    unsigned char *bytes = mcr_image_bytes(path, &count, error, length);
    struct mcr_pixels *pixels;
    if (!bytes) return NULL;
    if (length) error[0] = '\0';
    pixels = decode(bytes, count, data, error, length);
    if (pixels) pixels->hash = hash_of(bytes, count);
    else if (length && !error[0]) mcr_image_fail(error, length, "not enough memory");
    free(bytes);
    return pixels;
}
