/* SPDX-License-Identifier: Apache-2.0 */
/* The helpers of the public header against long double: the error bounds that it states, with e = 2^-53. */
#include "../tap.h"

#include <math.h>
#include <mcrender/sampler.h>

#define E 0x1p-53
#define POINTS 2000000u

#if __LDBL_MANT_DIG__ < 64
#define NO_REFERENCE 1
#else
#define NO_REFERENCE 0
#endif

static long double larger(long double a, long double b)
{
    return b <= a ? a : b; /* a NaN wins */
}

/* Number i of a stream; every 4th one close to the middle or the borders, where the map's branches meet. */
static double number(uint64_t stream, uint64_t i)
{
    double u = mcr_number(mcr_mix64(stream), i);

    if (i % 4 == 1)
        u = 0.5 + (u - 0.5) * 0x1p-30;
    if (i % 16 == 2)
        u *= 0x1p-40;
    if (i % 16 == 3)
        u = 1 - E * (1 + floor(u * 8));
    return u;
}

static void test_disk(void)
{
    const long double eighth = atanl(1);
    long double error = 0, square = 0, height = 0, length = 0, outside = 0;

    for (uint64_t i = 0; i < POINTS; i++) {
        double u = floor(number(1, i) * 0x1p53) * E, v = floor(number(2, i / 3) * 0x1p53) * E, x, y, h = mcr_disk_from_square(u, v, &x, &y);
        long double a = 2 * (long double)u - 1, b = 2 * (long double)v - 1, r = fabsl(a) > fabsl(b) ? a : b, t = (fabsl(a) > fabsl(b) ? b : a) / r;
        long double along = r * cosl(eighth * t), across = r * sinl(eighth * t), exact = (1 - r) * (1 + r), z = sqrtl(h);

        if (r == 0) {
            outside = larger(outside, fabs(x) + fabs(y) + fabs(h - 1));
            continue;
        }
        error = larger(error, fabsl(x - (fabsl(a) > fabsl(b) ? along : across)) / fabsl(r));
        error = larger(error, fabsl(y - (fabsl(a) > fabsl(b) ? across : along)) / fabsl(r));
        square = larger(square, fabsl((long double)x * x + (long double)y * y - r * r) / (r * r));
        height = larger(height, exact == 0 ? fabs(h) : fabsl(h - exact) / exact);
        length = larger(length, fabsl(sqrtl((long double)x * x + (long double)y * y + z * z) - 1));
    }
    ok(error <= 3 * E, "disk: x and y to 3e of the radius (%.2Lf)", error / E);
    ok(square <= 5 * E, "disk: x^2 + y^2 to 5e (%.2Lf)", square / E);
    ok(height <= 3 * E, "disk: 1 - radius^2 to 3e (%.2Lf)", height / E);
    ok(length <= 3 * E, "disk: the direction over it is unit (%.2Lf)", length / E);
    ok(outside == 0, "disk: the centre is the centre");
}

/* Uniform in area: 16 rings of equal area by 16 sectors; chi-square of 255 degrees of freedom as a normal deviate. */
static void test_area(void)
{
    static uint32_t count[16][16];
    const double df = 255, expected = POINTS / 256.0;
    double chi = 0, z;

    for (uint64_t i = 0; i < POINTS; i++) {
        double x, y, h = mcr_disk_from_square(mcr_number(5, 2 * i), mcr_number(5, 2 * i + 1), &x, &y);
        int ring = (int)((1 - h) * 16), sector = (int)((atan2(y, x) / (2 * M_PI) + 0.5) * 16);

        count[ring < 16 ? ring : 15][sector < 16 ? sector : 15]++;
    }
    for (int k = 0; k < 256; k++)
        chi += (count[k / 16][k % 16] - expected) * (count[k / 16][k % 16] - expected) / expected;
    z = (cbrt(chi / df) - (1 - 2 / (9 * df))) / sqrt(2 / (9 * df));
    ok(fabs(z) <= 4, "disk: uniform in area (z %.2f)", z);
}

/* Unit vectors of every kind, half of them within 2^-20 … 2^-60 of -z or +z. */
static void test_basis(void)
{
    long double worst = 0, world = 0;

    for (uint64_t i = 0; i < POINTS; i++) {
        double phi = 2 * M_PI * mcr_number(6, 3 * i), z = 2 * mcr_number(6, 3 * i + 1) - 1, s = sqrt(1 - z * z), t[3], b[3], w[3], n[3];
        long double length;

        if (i % 2) {
            s = exp2(-60 * mcr_number(6, 3 * i + 2));
            z = z < 0 ? -1 : 1;
        }
        length = sqrtl((long double)s * s + (long double)z * z);
        n[0] = (double)(s * cos(phi) / length), n[1] = (double)(s * sin(phi) / length), n[2] = (double)(z / length);
        length = sqrtl((long double)n[0] * n[0] + (long double)n[1] * n[1] + (long double)n[2] * n[2]); /* 1 to about e: taken out of the errors */
        mcr_basis(n[0], n[1], n[2], &t[0], &t[1], &t[2], &b[0], &b[1], &b[2]);
        worst = larger(worst, fabsl((long double)t[0] * n[0] + (long double)t[1] * n[1] + (long double)t[2] * n[2]));
        worst = larger(worst, fabsl((long double)b[0] * n[0] + (long double)b[1] * n[1] + (long double)b[2] * n[2]));
        worst = larger(worst, fabsl((long double)b[0] * t[0] + (long double)b[1] * t[1] + (long double)b[2] * t[2]));
        worst = larger(worst, fabsl(sqrtl((long double)t[0] * t[0] + (long double)t[1] * t[1] + (long double)t[2] * t[2]) - 1));
        worst = larger(worst, fabsl(sqrtl((long double)b[0] * b[0] + (long double)b[1] * b[1] + (long double)b[2] * b[2]) - 1));
        for (int c = 0; c < 3; c++) /* right-handed: t x b = n */
            worst = larger(worst, fabsl((long double)t[(c + 1) % 3] * b[(c + 2) % 3] - (long double)t[(c + 2) % 3] * b[(c + 1) % 3] - n[c]));
        mcr_to_world(n[0], n[1], n[2], 0.6, 0.64, 0.48, &w[0], &w[1], &w[2]);
        world = larger(world, fabsl(sqrtl((long double)w[0] * w[0] + (long double)w[1] * w[1] + (long double)w[2] * w[2]) - 1));
        for (int c = 0; c < 3; c++) /* not normalised by 0.6, 0.64, 0.48's own rounding, which is below e */
            worst = larger(worst, fabsl(w[c] - (0.6L * t[c] + 0.64L * b[c] + 0.48L * n[c])));
    }
    ok(worst <= 8 * E, "basis: orthonormal and right-handed to 8e, near -z too (%.2Lf)", worst / E);
    ok(world <= 3 * E, "basis: a vector in it stays unit to 3e (%.2Lf)", world / E);
}

/* Known answers: splitmix64 of seed 0 begins e220a8397b1dcdaf, 6e789e6aa1b965f4 (Vigna's splitmix64.c). */
static void test_numbers(void)
{
    ok(mcr_mix64(UINT64_C(0x9e3779b97f4a7c15)) == UINT64_C(0xe220a8397b1dcdaf) &&
           mcr_mix64(2 * UINT64_C(0x9e3779b97f4a7c15)) == UINT64_C(0x6e789e6aa1b965f4),
       "mix64: splitmix64's first outputs");
    ok(mcr_unit_double(0) == 0 && mcr_unit_double(UINT64_MAX) == 1 - E && mcr_unit_double(UINT64_C(1) << 11) == E &&
           mcr_unit_double(UINT64_C(1) << 63) == 0.5,
       "unit_double: 53 bits");
    ok(mcr_number(0, 0) == (double)(UINT64_C(0xe220a8397b1dcdaf) >> 11) * E, "number: dimension 0 of key 0");
}

int main(void)
{
    test_numbers();
    test_area();
    if (NO_REFERENCE) {
        tap_skip("error bounds", "long double is no wider than double");
        return tap_done();
    }
    test_disk();
    test_basis();
    return tap_done();
}
