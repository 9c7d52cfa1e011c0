/* SPDX-License-Identifier: Apache-2.0 */
#include "image/encode.h"

#include "image/srgb.h"

#include <float.h>
#include <string.h>

/* The largest value of Ward's RGBE: mantissa 255/256, exponent 2^127. */
#define RGBE_MAX (255.0 / 256.0 * 0x1p127)

double mcr_exposure_scale(double stops)
{
    double whole = floor(stops), fraction = stops - whole, scale = fraction > 0 ? mcr_pow(2.0, fraction) : 1.0;
    for (; whole >= 1; whole--) scale *= 2.0;
    for (; whole <= -1; whole++) scale *= 0.5;
    return scale;
}

static int channel_named(const struct mcr_image *image, const char *name)
{
    for (uint32_t c = 0; image->name && c < image->channels; c++)
        if (image->name[c] && !strcmp(image->name[c], name)) return (int)c;
    return -1;
}

static void choose_channels(struct mcr_encoder *encoder, const struct mcr_image *image)
{
    int r = channel_named(image, "R"), g = channel_named(image, "G"), b = channel_named(image, "B");
    if (r >= 0 && g >= 0 && b >= 0) {
        encoder->channels = 3;
        encoder->from[0] = (uint32_t)r, encoder->from[1] = (uint32_t)g, encoder->from[2] = (uint32_t)b;
    } else if (image->channels >= 3) {
        encoder->channels = 3;
        encoder->from[0] = 0, encoder->from[1] = 1, encoder->from[2] = 2;
    } else {
        encoder->channels = 1;
        encoder->from[0] = 0;
    }
}

void mcr_encoder_init(struct mcr_encoder *encoder, const struct mcr_image *image, const struct mcr_format *format, uint32_t bits,
                      double exposure)
{
    memset(encoder, 0, sizeof *encoder);
    encoder->image = image;
    encoder->encoding = mcr_format_encoding(format, bits);
    encoder->all = format->all_channels;
    encoder->channels = image->channels;
    if (!encoder->all) choose_channels(encoder, image);
    encoder->scale = mcr_exposure_scale(exposure);
    if (encoder->encoding != MCR_ENCODE_U8) return;
    for (int k = 1; k < 256; k++) encoder->edge[k] = mcr_srgb_decode((k - 0.5) / 255.0);
    encoder->edge[256] = 2.0;
}

size_t mcr_encoder_row_bytes(const struct mcr_encoder *encoder)
{
    static const size_t bytes[] = {[MCR_ENCODE_U8] = 1, [MCR_ENCODE_U16] = 2, [MCR_ENCODE_FLOAT] = 4, [MCR_ENCODE_RGBE] = 4};
    return (size_t)encoder->image->width * encoder->channels * bytes[encoder->encoding];
}

/*
 * The 8-bit code, equal to mcr_srgb_quantise(v, 255) but without a power for nearly all values: the code is found among the
 * edges, and only next to an edge is the function itself asked. 1e-9 is a million times the error of our power.
 */
static uint32_t code8(const double *edge, double v)
{
    uint32_t k = 0;
    for (uint32_t step = 128; step; step >>= 1) k += v >= edge[k + step] ? step : 0;
    return v < edge[k] * (1 + 1e-9) || v > edge[k + 1] * (1 - 1e-9) ? mcr_srgb_quantise(v, 255) : k;
}

/* One value for an integer format, exposed and through the tone curve. */
static uint32_t encode_integer(struct mcr_encoder *encoder, double v)
{
    uint32_t peak = encoder->encoding == MCR_ENCODE_U8 ? 255 : 65535;
    if (!isfinite(v)) {
        encoder->not_finite++;
        return 0;
    }
    if (v < 0 || v > 1) {
        encoder->overflowed++;
        return v < 0 ? 0 : peak;
    }
    return peak == 255 ? code8(encoder->edge, v) : mcr_srgb_quantise(v, 65535);
}

/* One value as float, within +-FLT_MAX; what is not finite stays so. */
static float encode_float(struct mcr_encoder *encoder, double v)
{
    if (!isfinite(v)) {
        encoder->not_finite++;
        return (float)v;
    }
    if (fabs(v) > FLT_MAX) {
        encoder->overflowed++;
        return v < 0 ? -FLT_MAX : FLT_MAX;
    }
    return (float)v;
}

static float encode_rgbe(struct mcr_encoder *encoder, double v)
{
    if (!isfinite(v)) {
        encoder->not_finite++;
        return 0;
    }
    if (v < 0 || v > RGBE_MAX) {
        encoder->overflowed++;
        return v < 0 ? 0 : (float)RGBE_MAX;
    }
    return (float)v;
}

/*
 * Encoders of RGBE cut the mantissas off, which darkens an image by half a step. Values that are multiples of their pixel's step
 * already survive the cut, so they are rounded to it here.
 */
static void round_rgbe(float *pixel, uint32_t channels)
{
    double largest = 0, step = 0x1p-8, rounded = 0;
    for (uint32_t c = 0; c < channels; c++) largest = pixel[c] > largest ? pixel[c] : largest;
    if (largest < 1e-32) return; /* written as black */
    while (largest >= 256 * step) step *= 2;
    while (largest < 128 * step) step *= 0.5;
    if (largest >= 255.5 * step && 512 * step <= 0x1p127) step *= 2; /* rounds up to the next exponent */
    for (uint32_t c = 0; c < channels; c++) {
        rounded = floor(pixel[c] / step + 0.5);
        pixel[c] = (float)((rounded > 255 ? 255 : rounded) * step);
    }
}

/* A pixel for an integer format. A grey one goes through the curve as one of three equal channels. */
static void encode_pixel(struct mcr_encoder *encoder, const double *pixel, void *row, size_t first)
{
    double v[3];
    for (uint32_t c = 0; c < 3; c++) {
        double linear = pixel[encoder->from[c < encoder->channels ? c : 0]];
        v[c] = isfinite(linear) ? mcr_clamp(linear * encoder->scale, -MCR_TONE_MOST, MCR_TONE_MOST) : linear;
    }
    mcr_tone_apply(&encoder->tone, v);
    for (uint32_t c = 0; c < encoder->channels; c++) {
        uint32_t code = encode_integer(encoder, v[c]);
        if (encoder->encoding == MCR_ENCODE_U8) ((uint8_t *)row)[first + c] = (uint8_t)code;
        else ((uint16_t *)row)[first + c] = (uint16_t)code;
    }
}

void mcr_encode_row(struct mcr_encoder *encoder, uint32_t y, void *row)
{
    const struct mcr_image *image = encoder->image;
    const double *pixel = image->data + (size_t)y * image->width * image->channels;
    uint32_t channels = encoder->channels;
    for (size_t x = 0; x < image->width; x++, pixel += image->channels) {
        if (encoder->encoding == MCR_ENCODE_U8 || encoder->encoding == MCR_ENCODE_U16) {
            encode_pixel(encoder, pixel, row, x * channels);
            continue;
        }
        for (uint32_t c = 0; c < channels; c++) {
            double v = pixel[encoder->all ? c : encoder->from[c]];
            size_t i = x * channels + c;
            ((float *)row)[i] = encoder->encoding == MCR_ENCODE_RGBE ? encode_rgbe(encoder, v) : encode_float(encoder, v);
        }
        if (encoder->encoding == MCR_ENCODE_RGBE) round_rgbe((float *)row + x * channels, channels);
    }
}
