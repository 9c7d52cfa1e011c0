/* SPDX-License-Identifier: Apache-2.0 */
/* Tone curves: known values, ends, order, and what is left alone. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "../tap.h"
#include "image/encode.h"

static double of(uint32_t curve, double white, double v)
{
    struct mcr_tone tone = {curve, white};
    double rgb[3] = {v, v, v};
    mcr_tone_apply(&tone, rgb);
    return rgb[1];
}

static int near(double a, double b)
{
    return fabs(a - b) <= 1e-12 * fmax(1, fabs(b));
}

/* Computed by hand: fractions. */
static void known(void)
{
    ok(of(MCR_TONE_LINEAR, 0, 3.5) == 3.5, "linear");
    ok(near(of(MCR_TONE_REINHARD, 4, 1), 17 / 32.0) && near(of(MCR_TONE_REINHARD, 4, 4), 1) && near(of(MCR_TONE_REINHARD, 2, 0.5), 0.375), "reinhard");
    ok(near(of(MCR_TONE_REINHARD, 1e10, 1), 0.5), "reinhard with white far away: L / (1 + L)");
    /* 2.54 / 3.16; 0.18: 0.18 * 0.4818 / (0.18 * 1.0274 + 0.14) */
    ok(near(of(MCR_TONE_ACES, 0, 1), 2.54 / 3.16) && near(of(MCR_TONE_ACES, 0, 0.18), 0.086724 / 0.324932), "aces");
    /* x = 1, exposed to 2: (2 (.3 + .05) + .004) / (2 (.3 + .5) + .06) - 1/15; white 5.6, exposed to 11.2: 11.2 (1.68 + .05) + .004 = 19.38 over 11.2 (1.68 + .5) + .06 */
    double one = 0.704 / 1.66 - 1 / 15.0, white = 19.38 / 24.476 - 1 / 15.0;
    ok(near(of(MCR_TONE_HABLE, 5.6, 1), one / white) && near(of(MCR_TONE_HABLE, 5.6, 5.6), 1) && near(of(MCR_TONE_HABLE, 1, 1), 1), "hable");
}

static void ordered(void)
{
    for (uint32_t curve = 0; curve < MCR_TONE_COUNT; curve++) {
        double before = 0, first = of(curve, 4, 1e-9);
        int rises = 1;
        for (double v = 1e-9; v < MCR_TONE_MOST; v *= 1.05) {
            double now = of(curve, 4, v);
            rises &= now >= before * (1 - 1e-12) && isfinite(now);
            before = now;
        }
        ok(rises && first > 0 && first < 1e-7 && of(curve, 4, 0) == 0, "%s begins at 0, rises and stays finite", mcr_tone_name[curve]);
        ok(of(curve, 4, -0.5) == -0.5 && isnan(of(curve, 4, NAN)) && isinf(of(curve, 4, INFINITY)), "%s leaves alone what is no radiance", mcr_tone_name[curve]);
    }
}

static void colours(void)
{
    struct mcr_tone tone = {MCR_TONE_REINHARD, MCR_TONE_LEAST_WHITE};
    double far[3] = {MCR_TONE_MOST, 0, -MCR_TONE_MOST};
    mcr_tone_apply(&tone, far);
    ok(isfinite(far[0]) && far[1] == 0 && far[0] >= 1, "the ends of all ranges give numbers");
    tone.white = 4;
    double rgb[3] = {3, 1, 0.5}, l = 0.2126 * 3 + 0.7152 + 0.0722 * 0.5, factor = (1 + l / 16) / (1 + l);
    mcr_tone_apply(&tone, rgb);
    ok(near(rgb[0], 3 * factor) && near(rgb[1], factor) && near(rgb[2], 0.5 * factor), "reinhard keeps the channels' ratios");
    tone.curve = MCR_TONE_ACES;
    rgb[0] = 1, rgb[1] = 0, rgb[2] = -1;
    mcr_tone_apply(&tone, rgb);
    ok(near(rgb[0], 2.54 / 3.16) && rgb[1] == 0 && rgb[2] == -1, "aces takes each by itself");
}

static void texts(void)
{
    char text[MCR_TONE_TEXT];
    mcr_tone_text(&(struct mcr_tone){MCR_TONE_REINHARD, 2.5}, text);
    ok(!strcmp(text, "reinhard(white=2.5)"), "%s", text);
    mcr_tone_text(&(struct mcr_tone){MCR_TONE_HABLE, -DBL_MAX}, text);
    ok(strlen(text) < MCR_TONE_TEXT - 1, "%s", text);
    mcr_tone_text(&(struct mcr_tone){0}, text);
    ok(!strcmp(text, "linear"), "%s", text);
}

/* Through the encoder: exposed first, then the curve, then the code; grey images and what is clipped. */
static void encoded(void)
{
    static const struct mcr_format integers = {.extension = "x", .encoding = MCR_ENCODE_U8, .bits8 = MCR_ENCODE_U8, .bits16 = MCR_ENCODE_U16};
    struct mcr_image *grey = mcr_image_create(2, 1, 1, NULL), *colour = mcr_image_create(1, 1, 3, NULL);
    struct mcr_encoder encoder;
    uint8_t row[4];
    uint16_t wide[3];
    grey->data[0] = 0.5, grey->data[1] = 100;
    mcr_encoder_init(&encoder, grey, &integers, 8, 1);
    encoder.tone = (struct mcr_tone){MCR_TONE_REINHARD, 4};
    mcr_encode_row(&encoder, 0, row);
    /* 17/32 is 192.9 of 255 in sRGB */
    ok(row[0] == (uint8_t)floor(255 * (1.055 * pow(17 / 32.0, 1 / 2.4) - 0.055) + 0.5) && row[1] == 255 && encoder.overflowed == 1, "grey: %u, %u", row[0], row[1]);
    colour->data[0] = 1, colour->data[1] = 0.18, colour->data[2] = -1;
    mcr_encoder_init(&encoder, colour, &integers, 16, 0);
    encoder.tone = (struct mcr_tone){MCR_TONE_ACES, 0};
    mcr_encode_row(&encoder, 0, wide);
    ok(wide[0] == (uint16_t)floor(65535 * (1.055 * pow(2.54 / 3.16, 1 / 2.4) - 0.055) + 0.5) &&
       wide[1] == (uint16_t)floor(65535 * (1.055 * pow(0.086724 / 0.324932, 1 / 2.4) - 0.055) + 0.5) && wide[2] == 0 && encoder.overflowed == 1,
       "colour, 16 bits: %u, %u, %u", wide[0], wide[1], wide[2]);
    mcr_image_destroy(grey);
    mcr_image_destroy(colour);
}

int main(void)
{
    known();
    ordered();
    colours();
    texts();
    encoded();
    return tap_done();
}
