/* SPDX-License-Identifier: Apache-2.0 */
#include "image/tone.h"

#include <math.h>
#include <stdio.h>

const char *const mcr_tone_name[MCR_TONE_COUNT] = {"linear", "reinhard", "hable", "aces"};

/* Beyond, the curves of channels have reached their end, and squares would overflow. */
#define FAR_BEYOND 1e100

/* The same factor for all channels, so that hues stay: L_d / L = (1 + L / white^2) / (1 + L). */
static void reinhard(double white, double rgb[3])
{
    double luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    double factor = luminance > 0 ? (1 + luminance / white / white) / (1 + luminance) : 1;
    for (int c = 0; c < 3; c++)
        rgb[c] *= factor;
}

/* Shoulder strength, linear strength and angle, toe strength, numerator and denominator as in the talk. */
static double hable(double x)
{
    const double a = 0.15, b = 0.50, c = 0.10, d = 0.20, e = 0.02, f = 0.30;
    return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

static double aces(double x)
{
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

void mcr_tone_apply(const struct mcr_tone *tone, double rgb[3])
{
    if (tone->curve == MCR_TONE_LINEAR || !isfinite(rgb[0] + rgb[1] + rgb[2])) return;
    if (tone->curve == MCR_TONE_REINHARD) {
        reinhard(tone->white, rgb);
        return;
    }
    for (int c = 0; c < 3; c++) {
        double x = rgb[c] < FAR_BEYOND ? rgb[c] : FAR_BEYOND;
        if (!(x > 0)) continue;
        /* The talk exposes by 2 before the curve, and takes white as a value of what is exposed. */
        rgb[c] = tone->curve == MCR_TONE_ACES ? aces(x) : hable(2 * x) / hable(2 * tone->white);
    }
}

void mcr_tone_text(const struct mcr_tone *tone, char text[MCR_TONE_TEXT])
{
    int has_white = tone->curve == MCR_TONE_REINHARD || tone->curve == MCR_TONE_HABLE;
    snprintf(text, MCR_TONE_TEXT, has_white ? "%s(white=%.10g)" : "%s", mcr_tone_name[tone->curve], tone->white);
}
