/* SPDX-License-Identifier: Apache-2.0 */
/* Three-component vectors of the scene builder. Exact where they can be, never NaN for finite arguments below 1e150. */
#ifndef MCR_SCENE_VECTOR_H
#define MCR_SCENE_VECTOR_H

#include "base/elementary.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define MCR_ROUNDING 0x1p-53 /* u: half the distance from 1 to the next double */

/* The largest power of two <= x, for x > 0 and finite; exact, also for subnormal numbers. */
static inline double mcr_power_of_two(double x)
{
    uint64_t bits;
    double shift = 1;
    if (x < 0x1p-1000) {
        x *= 0x1p200;
        shift = 0x1p-200;
    }
    memcpy(&bits, &x, sizeof bits);
    bits &= UINT64_C(0x7ff0000000000000);
    memcpy(&x, &bits, sizeof x);
    return x * shift;
}

static inline double mcr_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void mcr_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void mcr_subtract(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

static inline double mcr_largest(const double a[3])
{
    return mcr_max(fabs(a[0]), mcr_max(fabs(a[1]), fabs(a[2])));
}

static inline void mcr_copy(const double a[3], double out[3])
{
    memcpy(out, a, 3 * sizeof *out);
}

/* Multiplies by the power of two that brings the largest component into [1, 2) and returns its inverse; 0 for the zero vector. */
static inline double mcr_level(const double a[3], double out[3])
{
    double most = mcr_largest(a), power;
    if (!(most > 0)) {
        out[0] = out[1] = out[2] = 0;
        return 0;
    }
    power = mcr_power_of_two(most);
    for (int i = 0; i < 3; i++)
        out[i] = power < 0x1p-1000 ? a[i] * 0x1p200 / (power * 0x1p200) : a[i] / power;
    return power;
}

/* sqrt of the sum of squares without overflow or underflow on the way. */
static inline double mcr_length(const double a[3])
{
    double level[3], power = mcr_level(a, level);
    return power * sqrt(mcr_dot(level, level));
}

/* The unit vector along a; 0 and a zero vector if a is zero. Vectors along an axis keep exact components. May work in place. */
static inline int mcr_unit(const double a[3], double out[3])
{
    double level[3], length;
    if (mcr_level(a, level) == 0) {
        out[0] = out[1] = out[2] = 0;
        return 0;
    }
    length = sqrt(mcr_dot(level, level));
    for (int i = 0; i < 3; i++)
        out[i] = level[i] / length;
    return 1;
}

/*
 * The sine of the angle between a and b, 0 if either is zero, and if `normal` is not NULL the unit vector along a x b.
 * The relative rounding of the components (differences of coordinates are rounded once) makes it uncertain by about 8 u:
 * parallel vectors are told by <= MCR_PARALLEL.
 */
#define MCR_PARALLEL (8 * MCR_ROUNDING)
static inline double mcr_sine(const double a[3], const double b[3], double normal[3])
{
    double p[3], q[3], cross[3];
    if (!mcr_unit(a, p) || !mcr_unit(b, q)) {
        if (normal)
            normal[0] = normal[1] = normal[2] = 0;
        return 0;
    }
    mcr_level(a, p);
    mcr_level(b, q);
    mcr_cross(p, q, cross);
    if (normal)
        mcr_unit(cross, normal);
    return mcr_length(cross) / (sqrt(mcr_dot(p, p)) * sqrt(mcr_dot(q, q)));
}

#endif
