/* SPDX-License-Identifier: Apache-2.0 */
/* The sRGB transfer function (IEC 61966-2-1), exact pieces, with our own power so that no bit depends on the C library. */
#ifndef MCR_IMAGE_SRGB_H
#define MCR_IMAGE_SRGB_H

#include "base/elementary.h"
#include <math.h>
#include <stdint.h>

/* Linear light in [0, 1] to the encoded value in [0, 1]. */
static inline double mcr_srgb_encode(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * mcr_pow(linear, 1.0 / 2.4) - 0.055;
}

/* The inverse, also for values above 1. */
static inline double mcr_srgb_decode(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : mcr_pow((encoded + 0.055) / 1.055, 2.4);
}

/* Linear light in [0, 1] to an integer in 0 .. peak, rounded half up. (floor(x + .5) would round .5 - 2^-54 up.) */
static inline uint32_t mcr_srgb_quantise(double linear, uint32_t peak)
{
    double scaled = mcr_srgb_encode(linear) * peak, below = floor(scaled);
    return (uint32_t)below + (scaled - below >= 0.5);
}

#endif
