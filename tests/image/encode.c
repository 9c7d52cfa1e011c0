/* SPDX-License-Identifier: Apache-2.0 */
/* The sRGB codes of 8 and 16 bits, exposure, what is counted, and the rounding of RGBE. */
#include "help.h"
#include "image/encode.h"
#include "image/srgb.h"

#include <float.h>

static const struct mcr_format integers = {"ppm", NULL, MCR_ENCODE_U8, MCR_ENCODE_U8, MCR_ENCODE_U16, 0, 0};
static const struct mcr_format floats = {"exr", NULL, MCR_ENCODE_FLOAT, MCR_ENCODE_FLOAT, MCR_ENCODE_FLOAT, 1, 0};
static const struct mcr_format shared = {"hdr", NULL, MCR_ENCODE_RGBE, MCR_ENCODE_RGBE, MCR_ENCODE_RGBE, 0, 0};

static struct mcr_encoder encoder;

/* Encodes one grey value. */
static uint32_t code(double value, uint32_t bits, double exposure)
{
    struct mcr_image *image = image_of(1, 1, 1, NULL, &value);
    uint8_t byte = 0;
    uint16_t word = 0;
    mcr_encoder_init(&encoder, image, &integers, bits, exposure);
    mcr_encode_row(&encoder, 0, bits == 16 ? (void *)&word : (void *)&byte);
    mcr_image_destroy(image);
    return bits == 16 ? word : byte;
}

/* Known values of the curve: codes of linear values, from the definition in 40-digit arithmetic. */
static void known_codes(void)
{
    static const struct { double linear; uint32_t code8, code16; } known[] = {
        {0, 0, 0}, {0.0031308, 10, 2651}, {0.01, 25, 6544}, {0.18, 118, 30235}, {0.5, 188, 48192}, {1, 255, 65535}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        uint32_t c8 = code(known[i].linear, 8, 0), c16 = code(known[i].linear, 16, 0);
        ok(c8 == known[i].code8 && c16 == known[i].code16, "%g is %u of 255 and %u of 65535 (%u, %u)", known[i].linear, known[i].code8,
           known[i].code16, c8, c16);
    }
}

/* Whether the fast way gives the function's own code for each of 512 values. */
static int as_the_function(const double *values)
{
    uint8_t codes[512];
    int same = 1;
    struct mcr_image *image = image_of(512, 1, 1, NULL, values);
    mcr_encoder_init(&encoder, image, &integers, 8, 0);
    mcr_encode_row(&encoder, 0, codes);
    for (int i = 0; i < 512; i++) same &= codes[i] == mcr_srgb_quantise(values[i], 255);
    mcr_image_destroy(image);
    return same;
}

/* Around the edge between two codes, in steps of one double and of 256. */
static void all_steps(void)
{
    int same = 1, rounds = 1, back = 1;
    double values[512];
    uint64_t state = 1;
    for (uint32_t k = 1; k < 256; k++) {
        double edge = mcr_srgb_decode((k - 0.5) / 255.0);
        for (int i = 0; i < 512; i++) values[i] = edge * (1 + (i - 256) * 0x1p-52);
        same &= as_the_function(values);
        for (int i = 0; i < 512; i++) values[i] = edge * (1 + (i - 256) * 0x1p-40);
        same &= as_the_function(values);
        rounds &= mcr_srgb_quantise(edge * (1 - 1e-12), 255) == k - 1 && mcr_srgb_quantise(edge * (1 + 1e-12), 255) == k;
    }
    ok(same, "the codes around 255 edges are those of the function, to the last bit");
    ok(rounds, "each edge lies at half a code");
    same = 1;
    for (int turn = 0; turn < 64; turn++) {
        for (int i = 0; i < 512; i++) values[i] = (double)(next_random(&state) >> 11) * 0x1p-53;
        same &= as_the_function(values);
    }
    ok(same, "32768 random values: the codes of the function");
    for (uint32_t k = 0; k < 256; k++) back &= code(mcr_srgb_decode(k / 255.0), 8, 0) == k;
    ok(back, "256 codes decode and encode to themselves");
    back = 1;
    for (uint32_t k = 0; k < 65536; k++) back &= mcr_srgb_quantise(mcr_srgb_decode(k / 65535.0), 65535) == k;
    ok(back, "65536 codes decode and encode to themselves");
}

static void exposures(void)
{
    ok(mcr_exposure_scale(0) == 1 && mcr_exposure_scale(3) == 8 && mcr_exposure_scale(-4) == 0.0625, "whole stops are powers of two, exactly");
    ok(fabs(mcr_exposure_scale(0.5) - 1.4142135623730951) < 1e-15 && fabs(mcr_exposure_scale(-0.5) - 0.70710678118654757) < 1e-15, "half stops");
    ok(code(0.125, 8, 2) == code(0.5, 8, 0) && encoder.overflowed == 0, "two stops up");
    ok(code(2, 8, -1) == 255 && encoder.overflowed == 0, "a stop down brings 2 into the range");
    ok(code(0.75, 8, 1) == 255 && encoder.overflowed == 1, "exposure can push a value out of the range");
}

static void counts(void)
{
    ok(code(1.0000001, 8, 0) == 255 && encoder.overflowed == 1, "over 1: clipped and counted");
    ok(code(-1e-9, 8, 0) == 0 && encoder.overflowed == 1, "below 0: clipped and counted");
    ok(code(-0.0, 8, 0) == 0 && encoder.overflowed == 0, "minus zero is in the range");
    ok(code(NAN, 8, 0) == 0 && encoder.overflowed == 0 && encoder.not_finite == 1, "NaN: 0 and counted");
    ok(code(INFINITY, 16, -3) == 0 && encoder.overflowed == 0 && encoder.not_finite == 1, "infinity: 0 and counted");
    ok(code(DBL_MAX, 16, 128) == 65535 && encoder.overflowed == 1, "a product that overflows is one that is too large");
    const double values[] = {1e39, -1e39, FLT_MAX, INFINITY, NAN, -7};
    struct mcr_image *image = image_of(2, 1, 3, rgb, values);
    float row[6];
    mcr_encoder_init(&encoder, image, &floats, 0, 5);
    mcr_encode_row(&encoder, 0, row);
    ok(row[0] == FLT_MAX && row[1] == -FLT_MAX && row[2] == FLT_MAX && encoder.overflowed == 2, "floats: beyond FLT_MAX clipped and counted");
    ok(row[3] == INFINITY && isnan(row[4]) && encoder.not_finite == 2, "floats: infinity and NaN kept and counted");
    ok(row[5] == -7, "floats: no exposure, negative values kept");
    mcr_encoder_init(&encoder, image, &shared, 0, 0);
    mcr_encode_row(&encoder, 0, row);
    ok(row[0] == 0xffp119f && row[1] == 0 && row[5] == 0 && encoder.overflowed == 4 && encoder.not_finite == 2 && row[3] == 0,
       "RGBE: clipped to its largest value, negative ones to 0, counted");
    mcr_image_destroy(image);
}

/* The mantissas of RGBE hold 8 bits: values that are rounded to their steps, not cut. */
static void rgbe(void)
{
    const double values[] = {1, 0.5 / 128, 0.49 / 128, 0.9999, 0.3, 0, 1e-33, 0, 0, 0x1p-20, 0, 0x1.8p-28};
    struct mcr_image *image = image_of(4, 1, 3, rgb, values);
    float row[12];
    mcr_encoder_init(&encoder, image, &shared, 0, 0);
    mcr_encode_row(&encoder, 0, row);
    ok(row[0] == 1 && row[1] == 0x1p-7f && row[2] == 0, "beside 1 the step is 1/128, halves go up");
    ok(row[3] == 1 && row[4] == 38.0f / 128, "what rounds up to the next power of two takes the others along");
    ok(row[9] == 0x1p-20f && row[11] == 0x1p-27f, "steps of small pixels are small");
    mcr_image_destroy(image);
}

static void channels(void)
{
    static const char *const names[] = {"A", "B", "albedo.R", "R", "G"};
    const double values[] = {0, 0.25, 0, 1, 0.5};
    uint8_t row[3] = {0};
    struct mcr_image *image = image_of(1, 1, 5, names, values);
    mcr_encoder_init(&encoder, image, &integers, 8, 0);
    mcr_encode_row(&encoder, 0, row);
    ok(encoder.channels == 3 && row[0] == 255 && row[1] == code(0.5, 8, 0) && row[2] == code(0.25, 8, 0), "R, G and B are found by name");
    mcr_image_destroy(image);
}

int main(void)
{
    known_codes();
    all_steps();
    exposures();
    counts();
    rgbe();
    channels();
    return tap_done();
}
