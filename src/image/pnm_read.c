/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Reading PGM, PPM (netpbm's ppm(5): integers are sRGB) and PFM (linear; its sign of the scale tells the byte order).
 */
#include "image/fail.h"
#include "image/read.h"
#include "image/srgb.h"

#include <stdlib.h>
#include <string.h>

static const char *const grey[] = {"Y"}, *const colour[] = {"R", "G", "B"};

struct cursor {
    const unsigned char *bytes;
    size_t count, at;
    char *error;
    size_t length;
};

static int is_space(int c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* Passes over white space and, where comments are allowed, from '#' to the end of the line. */
static void skip_space(struct cursor *cursor, int comments)
{
    for (; cursor->at < cursor->count; cursor->at++) {
        if (comments && cursor->bytes[cursor->at] == '#') {
            while (cursor->at < cursor->count && cursor->bytes[cursor->at] != '\n' && cursor->bytes[cursor->at] != '\r') cursor->at++;
            if (cursor->at == cursor->count) return;
        }
        if (!is_space(cursor->bytes[cursor->at])) return;
    }
}

/* An unsigned decimal number in least .. most. Returns 0, or -1 with the error told. */
static int read_number(struct cursor *cursor, const char *what, uint32_t least, uint32_t most, uint32_t *value)
{
    skip_space(cursor, 1);
    size_t start = cursor->at;
    uint64_t number = 0;
    while (cursor->at < cursor->count && cursor->bytes[cursor->at] >= '0' && cursor->bytes[cursor->at] <= '9') {
        if (number <= UINT32_MAX) number = number * 10 + (cursor->bytes[cursor->at] - '0');
        cursor->at++;
    }
    if (start == cursor->count) return mcr_image_fail(cursor->error, cursor->length, "it ends at byte %zu, where its %s should be", start, what);
    if (start == cursor->at) return mcr_image_fail(cursor->error, cursor->length, "at byte %zu: expected a number for its %s", start, what);
    if (number < least || number > most)
        return mcr_image_fail(cursor->error, cursor->length, "at byte %zu: its %s is not from %u to %u", start, what, least, most);
    *value = (uint32_t)number;
    return 0;
}

/* The one white-space byte that ends a header. */
static int end_header(struct cursor *cursor)
{
    if (cursor->at < cursor->count && is_space(cursor->bytes[cursor->at])) return cursor->at++, 0;
    return mcr_image_fail(cursor->error, cursor->length, "at byte %zu: expected white space", cursor->at);
}

/* White space or a comment behind the first two bytes. */
static int end_magic(struct cursor *cursor)
{
    return cursor->at < cursor->count && cursor->bytes[cursor->at] == '#' ? 0 : end_header(cursor);
}

/* Whether the data can be there at all, `least` bytes for each value, and fits, `most` bytes each, into memory. -1 with the error told. */
static int fits(const struct cursor *cursor, uint32_t width, uint32_t height, uint32_t channels, size_t least, size_t most)
{
    uint64_t values = (uint64_t)width * height * channels; /* below 2^34 */
    if (values > MCR_IMAGE_MAX_BYTES / most)
        return mcr_image_fail(cursor->error, cursor->length, "its size %u x %u is too large: over 1 GiB of pixels", width, height);
    if (cursor->count - cursor->at < values * least)
        return mcr_image_fail(cursor->error, cursor->length, "it is cut off: %llu bytes of pixels at least, %zu there",
                              (unsigned long long)(values * least), cursor->count - cursor->at);
    return 0;
}

static int read_samples(struct cursor *cursor, struct mcr_pixels *pixels, int plain)
{
    size_t values = (size_t)pixels->width * pixels->height * pixels->channels;
    uint32_t peak = pixels->peak;
    uint8_t *code = pixels->memory;
    uint16_t *wide = pixels->memory;
    for (size_t i = 0; i < values; i++) {
        uint32_t value = 0;
        if (plain) {
            if (read_number(cursor, "value", 0, peak, &value)) return -1;
        } else if (peak < 256) {
            value = cursor->bytes[cursor->at++];
        } else {
            value = (uint32_t)cursor->bytes[cursor->at] << 8 | cursor->bytes[cursor->at + 1];
            cursor->at += 2;
        }
        if (value > peak)
            return mcr_image_fail(cursor->error, cursor->length, "before byte %zu: value %u is over its maximum %u", cursor->at, value, peak);
        if (peak < 256) code[i] = (uint8_t)value;
        else wide[i] = (uint16_t)value;
    }
    return 0;
}

/* `most`: bytes that a value will take in the end; 0: as few as its codes need. */
static struct mcr_pixels *read_pnm(const unsigned char *bytes, size_t count, size_t most, char *error, size_t length)
{
    struct cursor cursor = {bytes, count, 2, error, length};
    uint32_t width, height, peak, channels = bytes[1] == '3' || bytes[1] == '6' ? 3 : 1;
    int plain = bytes[1] <= '3';
    if (bytes[1] == '1' || bytes[1] == '4') {
        mcr_image_fail(error, length, "bitmaps (P%c) are not read, only P2, P3, P5 and P6", bytes[1]);
        return NULL;
    }
    if (end_magic(&cursor) || read_number(&cursor, "width", 1, MCR_IMAGE_MAX_SIDE, &width) ||
        read_number(&cursor, "height", 1, MCR_IMAGE_MAX_SIDE, &height) || read_number(&cursor, "maximum", 1, 65535, &peak) || end_header(&cursor))
        return NULL;
    if (fits(&cursor, width, height, channels, plain || peak < 256 ? 1 : 2, most ? most : peak < 256 ? 1 : 2)) return NULL;
    struct mcr_pixels *pixels = mcr_pixels_create(width, height, channels, peak);
    if (!pixels) {
        mcr_image_fail(error, length, "not enough memory");
        return NULL;
    }
    pixels->transfer = MCR_TRANSFER_SRGB;
    mcr_pixels_name(pixels, channels == 1 ? grey : colour, -1);
    if (!read_samples(&cursor, pixels, plain)) return pixels;
    mcr_pixels_destroy(pixels);
    return NULL;
}

struct mcr_pixels *mcr_pnm_pixels(const unsigned char *bytes, size_t count, char *error, size_t length)
{
    return read_pnm(bytes, count, 0, error, length);
}

struct mcr_image *mcr_pnm_read(const unsigned char *bytes, size_t count, char *error, size_t length)
{
    struct mcr_pixels *pixels = read_pnm(bytes, count, sizeof(double), error, length);
    if (!pixels) return NULL;
    uint32_t peak = pixels->peak, channels = pixels->channels;
    size_t values = (size_t)pixels->width * pixels->height * channels;
    struct mcr_image *image = mcr_image_create_named(pixels->width, pixels->height, channels, channels == 1 ? grey : colour);
    double *linear = values > peak ? malloc((size_t)(peak + 1) * sizeof *linear) : NULL; /* not for few of many values */
    for (uint32_t k = 0; linear && k <= peak; k++) linear[k] = mcr_srgb_decode((double)k / peak);
    for (size_t i = 0; image && i < values; i++) {
        uint32_t value = peak < 256 ? pixels->code[i] : pixels->wide[i];
        image->data[i] = linear ? linear[value] : mcr_srgb_decode((double)value / peak);
    }
    free(linear);
    mcr_pixels_destroy(pixels);
    if (!image) mcr_image_fail(error, length, "not enough memory");
    return image;
}

/* The scale: a decimal number, finite and not 0. */
static int read_scale(struct cursor *cursor, double *scale)
{
    char text[40], *end;
    size_t used = 0;
    skip_space(cursor, 0);
    size_t start = cursor->at;
    while (used < sizeof text - 1 && cursor->at < cursor->count && !is_space(cursor->bytes[cursor->at]))
        text[used++] = (char)cursor->bytes[cursor->at++];
    text[used] = '\0';
    *scale = strtod(text, &end);
    if (used && !*end && isfinite(*scale) && *scale != 0) return 0;
    return mcr_image_fail(cursor->error, cursor->length, "at byte %zu: its scale is not a finite number other than 0", start);
}

struct mcr_image *mcr_pfm_read(const unsigned char *bytes, size_t count, char *error, size_t length)
{
    struct cursor cursor = {bytes, count, 2, error, length};
    uint32_t width, height, channels = bytes[1] == 'F' ? 3 : 1;
    double scale;
    if (end_magic(&cursor) || read_number(&cursor, "width", 1, MCR_IMAGE_MAX_SIDE, &width) ||
        read_number(&cursor, "height", 1, MCR_IMAGE_MAX_SIDE, &height) || read_scale(&cursor, &scale) || end_header(&cursor))
        return NULL;
    if (fits(&cursor, width, height, channels, 4, sizeof(double))) return NULL;
    struct mcr_image *image = mcr_image_create_named(width, height, channels, channels == 1 ? grey : colour);
    if (!image) {
        mcr_image_fail(error, length, "not enough memory");
        return NULL;
    }
    size_t row = (size_t)width * channels;
    double factor = fabs(scale);
    for (uint32_t y = height; y-- > 0;) {
        for (size_t i = 0; i < row; i++, cursor.at += 4) {
            const unsigned char *b = bytes + cursor.at;
            uint32_t bits = scale < 0 ? b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24
                                      : b[3] | (uint32_t)b[2] << 8 | (uint32_t)b[1] << 16 | (uint32_t)b[0] << 24;
            float value;
            memcpy(&value, &bits, sizeof value);
            image->data[y * row + i] = value * factor;
        }
    }
    return image;
}
