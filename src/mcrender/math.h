/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mcrender plugin interface: elementary functions, for the host and for plugins.
 *
 * Their bits do not depend on processor, C library, compiler or vector width: no libm but sqrt and fabs,
 * no fused multiply-add (build with -ffp-contract=off), no branches, so that a loop over them is vectorised for any instruction
 * set. (mcr_pow is the exception: it branches, and is for scalar use.) Rounding mode: to nearest.
 *
 * `ulp` below is the largest error measured by tests/base/elementary.c, which asserts the bounds; one ulp is the spacing of
 * doubles at the true value. NaN goes in and comes out; which NaN is not promised. All functions may be called from any thread.
 *
 * Polynomials: minimax fits in relative error of the whole function (Remez exchange in 120-digit arithmetic; for exp Lawson's
 * iteration, its weight being zero inside the interval), rounded to double one coefficient after the other, the remaining ones
 * fitted anew each time. The error of each fit stands beside it. Sums of two doubles: T. J. Dekker, "A floating-point technique
 * for extending the available precision", Numer. Math. 18 (1971).
 */
#ifndef MCRENDER_MATH_H
#define MCRENDER_MATH_H

#include <math.h>
#include <mcrender/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MCR_PI 0x1.921fb54442d18p+1
#define MCR_INFINITY __builtin_inf()
#define MCR_NAN __builtin_nan("")

/* Adding and subtracting it rounds a double of magnitude below 2^51 to the nearest integer (ties to even); in between, the low
 * bits of the sum are that integer in two's complement. SSE2 has neither a rounding nor a conversion to 64-bit integers. */
#define MCR_SHIFTER 0x1.8p52

/* ---- bits and helpers ---- */

MCR_INLINE uint64_t mcr_bits(double x)
{
    uint64_t bits;
    __builtin_memcpy(&bits, &x, sizeof bits);
    return bits;
}

MCR_INLINE double mcr_from_bits(uint64_t bits)
{
    double x;
    __builtin_memcpy(&x, &bits, sizeof x);
    return x;
}

/* The second if either is NaN: as minsd and maxsd do it. */
MCR_INLINE double mcr_min(double a, double b) { return a < b ? a : b; }
MCR_INLINE double mcr_max(double a, double b) { return a > b ? a : b; }
/* x within [low, high]; NaN stays NaN. */
MCR_INLINE double mcr_clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

MCR_INLINE double mcr_copysign(double magnitude, double sign)
{
    const uint64_t bit = UINT64_C(1) << 63;
    return mcr_from_bits((mcr_bits(magnitude) & ~bit) | (mcr_bits(sign) & bit));
}

/* Exact. Adding 2^52 rounds to an integer; from 2^52 on there is nothing to round. */
MCR_INLINE double mcr_floor(double x)
{
    double rounded = mcr_copysign((fabs(x) + 0x1p52) - 0x1p52, x);
    double down = mcr_copysign(rounded - (rounded > x ? 1.0 : 0.0), x);
    return fabs(x) < 0x1p52 ? down : x;
}

/* The upper 26 significant bits: the product of two such numbers is exact. */
MCR_INLINE double mcr_upper_half(double x) { return mcr_from_bits(mcr_bits(x) & ~UINT64_C(0x7ffffff)); }

/* ---- sine and cosine ---- */

/* Quarter turn and residue: what the three reductions below have in common. angle = quarter * pi/2 + (hi + lo), |hi| <= pi/4. */
struct mcr_reduced {
    uint64_t quarter; /* modulo 4 in the two low bits; the others are noise */
    double hi, lo;
};

/* sin and cos of hi + lo, |hi| <= pi/4, each as an unevaluated sum. */
struct mcr_sine_cosine {
    double sine, sine_lo, cosine, cosine_lo;
};

MCR_INLINE struct mcr_sine_cosine mcr_sincos_kernel_(double hi, double lo)
{
    struct mcr_sine_cosine r;
    double z = hi * hi, half = 0.5 * z, one_minus = 1.0 - half, small;
    double s = 0x1.5d8b60e162fadp-33, c = -0x1.8fa67db631123p-37;

    /* (sin r - r) / r^3, relative error 2^-57.8 of the sine */
    s = s * z - 0x1.ae5e4ba0491e7p-26;
    s = s * z + 0x1.71de3555361a3p-19;
    s = s * z - 0x1.a01a019be90b4p-13;
    s = s * z + 0x1.111111110f72fp-7;
    s = s * z - 0x1.5555555555548p-3;
    small = hi * (z * s) + lo * one_minus;
    r.sine = hi + small;
    r.sine_lo = (hi - r.sine) + small;

    /* (cos r - 1 + r^2/2) / r^4, relative error 2^-63.9 of the cosine */
    c = c * z + 0x1.1ee9dbc541f9cp-29;
    c = c * z - 0x1.27e4f7f188713p-22;
    c = c * z + 0x1.a01a019c8f204p-16;
    c = c * z - 0x1.6c16c16c15015p-10;
    c = c * z + 0x1.555555555554bp-5;
    small = ((1.0 - one_minus) - half) + (z * z * c - hi * lo);
    r.cosine = one_minus + small;
    r.cosine_lo = (one_minus - r.cosine) + small;
    return r;
}

/* a where mask is 0, b where it is all ones: a 64-bit integer comparison would be slow on SSE2. */
MCR_INLINE double mcr_blend_(double a, double b, uint64_t mask)
{
    return mcr_from_bits((mcr_bits(a) & ~mask) | (mcr_bits(b) & mask));
}

MCR_INLINE void mcr_sincos_reduced_(struct mcr_reduced a, double *sine, double *cosine)
{
    struct mcr_sine_cosine r = mcr_sincos_kernel_(a.hi, a.lo);
    uint64_t odd = 0 - (a.quarter & 1);
    *sine = mcr_from_bits(mcr_bits(mcr_blend_(r.sine, r.cosine, odd)) ^ ((a.quarter & 2) << 62));
    *cosine = mcr_from_bits(mcr_bits(mcr_blend_(r.cosine, r.sine, odd)) ^ (((a.quarter + 1) & 2) << 62));
}

/* The quotient of two unevaluated sums: one Newton step after a plain division. */
MCR_INLINE double mcr_tan_reduced_(struct mcr_reduced a)
{
    struct mcr_sine_cosine r = mcr_sincos_kernel_(a.hi, a.lo);
    uint64_t odd = 0 - (a.quarter & 1);
    double n = mcr_blend_(r.sine, r.cosine, odd), n_lo = mcr_blend_(r.sine_lo, r.cosine_lo, odd);
    double d = mcr_blend_(r.cosine, r.sine, odd), d_lo = mcr_blend_(r.cosine_lo, r.sine_lo, odd);
    double q = n / d, q_upper = mcr_upper_half(q), d_upper = mcr_upper_half(d);
    double rest = ((n - q_upper * d_upper) - q_upper * (d - d_upper)) - (q - q_upper) * d;
    double step = (rest + (n_lo - q * d_lo)) / d;
    double tangent = q + (fabs(step) < fabs(q) ? step : 0.0); /* at a pole the step is NaN */
    return mcr_from_bits(mcr_bits(tangent) ^ ((a.quarter & 1) << 63));
}

/* x in radians. pi/2 in three parts of 36, 36 and 53 bits, so that the first two products are exact up to 2^17 quarter turns.
 * Above 2^32, where a double no longer tells the angle, x counts as 0; below, the result is at least finite and in range. */
MCR_INLINE struct mcr_reduced mcr_reduce_radians_(double x)
{
    struct mcr_reduced r;
    double inside = fabs(x) > 0x1p32 ? x * 0.0 : x; /* infinity gives NaN here, as it should */
    double shifted = inside * 0x1.45f306dc9c883p-1 + MCR_SHIFTER, n = shifted - MCR_SHIFTER;
    double first = inside - n * 0x1.921fb5444p+0, product = n * 0x1.68c234c4cp-39;
    double second = first - product, tail = ((first - second) - product) - n * 0x1.98a2e03707345p-77;
    r.quarter = mcr_bits(shifted);
    r.hi = second + tail;
    r.lo = (second - r.hi) + tail;
    return r;
}

/* r * c as a sum; c = c_upper + c_tail with 26 bits in c_upper. */
MCR_INLINE struct mcr_reduced mcr_scale_angle_(uint64_t quarter, double r, double c, double c_upper, double c_tail)
{
    struct mcr_reduced a;
    double upper = mcr_upper_half(r), product = upper * c_upper, rest = upper * c_tail + (r - upper) * c;
    a.quarter = quarter;
    a.hi = product + rest;
    a.lo = (product - a.hi) + rest;
    return a;
}

/* u in turns; exact up to 2^48, beyond that u counts as 0. */
MCR_INLINE struct mcr_reduced mcr_reduce_turns_(double u)
{
    double inside = fabs(u) > 0x1p48 ? u * 0.0 : u;
    double shifted = inside * 4.0 + MCR_SHIFTER, n = shifted - MCR_SHIFTER;
    return mcr_scale_angle_(mcr_bits(shifted), inside - n * 0.25, 0x1.921fb54442d18p+2, 0x1.921fb5p+2, 0x1.110b4611a6263p-24);
}

/* x in degrees; exact up to 2^46, beyond that x counts as 0. */
MCR_INLINE struct mcr_reduced mcr_reduce_degrees_(double x)
{
    double inside = fabs(x) > 0x1p46 ? x * 0.0 : x;
    double shifted = inside * 0x1.6c16c16c16c17p-7 + MCR_SHIFTER, n = shifted - MCR_SHIFTER;
    return mcr_scale_angle_(mcr_bits(shifted), inside - n * 90.0, 0x1.1df46a2529d39p-6, 0x1.1df46ap-6, 0x1.294e9c8ae0ec6p-33);
}

/* 0.77 ulp for |x| <= 1e5. */
MCR_INLINE double mcr_sin(double x)
{
    double sine, cosine;
    mcr_sincos_reduced_(mcr_reduce_radians_(x), &sine, &cosine);
    return x == 0.0 ? x : sine; /* keeps the sign of zero */
}

/* 0.77 ulp for |x| <= 1e5. */
MCR_INLINE double mcr_cos(double x)
{
    double sine, cosine;
    mcr_sincos_reduced_(mcr_reduce_radians_(x), &sine, &cosine);
    return cosine;
}

/* 0.91 ulp for |x| <= 1e5; finite for every finite x. */
MCR_INLINE double mcr_tan(double x)
{
    double tangent = mcr_tan_reduced_(mcr_reduce_radians_(x));
    return x == 0.0 ? x : tangent;
}

/* sin and cos of 2 pi u. Multiples of a quarter give exactly 0 and +-1; every zero is +0. 0.77 ulp (0.98 for subnormal u). */
MCR_INLINE void mcr_sincos_turns(double u, double *sine, double *cosine)
{
    double s, c;
    mcr_sincos_reduced_(mcr_reduce_turns_(u), &s, &c);
    *sine = s + 0.0;
    *cosine = c + 0.0;
}

/* Exact where the result is 0, +-1/2 or +-1; every zero is +0. 0.77 ulp (sine: 0.95 for subnormal x). */
MCR_INLINE double mcr_sin_degrees(double x)
{
    double sine, cosine;
    mcr_sincos_reduced_(mcr_reduce_degrees_(x), &sine, &cosine);
    return sine + 0.0;
}

MCR_INLINE double mcr_cos_degrees(double x)
{
    double sine, cosine;
    mcr_sincos_reduced_(mcr_reduce_degrees_(x), &sine, &cosine);
    return cosine + 0.0;
}

/* Exact where the result is 0 (+0) or +-1; +infinity at 90 + 180 n. 0.95 ulp. */
MCR_INLINE double mcr_tan_degrees(double x)
{
    double tangent = mcr_tan_reduced_(mcr_reduce_degrees_(x)) + 0.0;
    return fabs(tangent) == MCR_INFINITY ? MCR_INFINITY : tangent;
}

/* ---- arc functions ---- */

/* The angle of (x, y) in [-pi, pi], as C's atan2: signed zeros and infinities included, atan2(0, 0) = 0. 0.62 ulp.
 * atan of the smaller over the larger coordinate, from above tan(pi/8) on as pi/4 + atan((a - b) / (a + b)), its quotient as a sum. */
MCR_INLINE double mcr_atan2(double y, double x)
{
    double ax = fabs(x), ay = fabs(y);
    int swapped = ay > ax;
    double b = swapped ? ay : ax, a = swapped ? ax : ay, scale, n, d, n_lo, d_lo, z, z_lo, z_upper, d_upper, rest, w, p;
    double eighths, sign, base, sum, angle;
    int large;

    a = b == MCR_INFINITY ? (a == MCR_INFINITY ? 1.0 : 0.0) : a;
    b = b == MCR_INFINITY || b == 0.0 ? 1.0 : b;
    scale = b > 0x1p1000 ? 0x1p-100 : b < 0x1p-400 ? 0x1p600 : 1.0; /* a + b shall not overflow, no residue underflow */
    a *= scale;
    b *= scale;
    large = a > 0x1.a827999fcef32p-2 * b;
    n = large ? a - b : a;
    d = large ? a + b : b;
    n_lo = large ? a - (b + n) : 0.0;
    d_lo = large ? a - (d - b) : 0.0;

    z = n / d;
    z_upper = mcr_upper_half(z);
    d_upper = mcr_upper_half(d);
    rest = ((n - z_upper * d_upper) - z_upper * (d - d_upper)) - (z - z_upper) * d;
    z_lo = (rest + (n_lo - z * d_lo)) / d;
    z_lo = fabs(z) < 0x1p-500 ? 0.0 : z_lo; /* the residue of such a quotient may underflow and is not needed */

    /* (atan z - z) / z^3, |z| <= tan(pi/8), relative error 2^-59.4 of the angle */
    w = z * z;
    p = -0x1.256616ad96409p-6;
    p = p * w + 0x1.37d3f99aab701p-5;
    p = p * w - 0x1.9cd23155f70dcp-5;
    p = p * w + 0x1.df0f3283725b7p-5;
    p = p * w - 0x1.10ebb6fe2e503p-4;
    p = p * w + 0x1.3b111907c1d73p-4;
    p = p * w - 0x1.745cf8dba42ccp-4;
    p = p * w + 0x1.c71c70e60a928p-4;
    p = p * w - 0x1.24924922ad54fp-3;
    p = p * w + 0x1.9999999995869p-3;
    p = p * w - 0x1.555555555553dp-2;
    p = z * (w * p) + z_lo * (1.0 - w);

    /* Back to the full circle: eighths of a turn (of 50 bits, times up to 4 still exact) plus or minus the small angle. */
    eighths = large ? 1.0 : 0.0;
    eighths = swapped ? 2.0 - eighths : eighths;
    sign = swapped ? -1.0 : 1.0;
    eighths = mcr_copysign(1.0, x) < 0.0 ? 4.0 - eighths : eighths;
    sign *= mcr_copysign(1.0, x);
    base = eighths * 0x1.921fb54442d18p-1;
    sum = base + sign * z;
    angle = sum + (((base - sum) + sign * z) + (sign * p + eighths * 0x1.1a62633145c07p-55));
    angle = mcr_copysign(angle, y);
    angle = x == x ? angle : x;
    return y == y ? angle : y;
}

/* 0.60 ulp. */
MCR_INLINE double mcr_atan(double x) { return mcr_atan2(x, 1.0); }
/* NaN outside [-1, 1]. asin 1.55 ulp, acos 1.44 ulp. */
MCR_INLINE double mcr_asin(double x) { return mcr_atan2(x, sqrt((1.0 - x) * (1.0 + x))); }
MCR_INLINE double mcr_acos(double x) { return mcr_atan2(sqrt((1.0 - x) * (1.0 + x)), x); }

/* ---- exponential and logarithm ---- */

/* e^(x + lo), |lo| far below |x|. x = k ln 2 + r, |r| <= ln 2 / 2. The scale is applied in two factors, so that overflow and
 * gradual underflow come by themselves. */
MCR_INLINE double mcr_exp_sum_(double x, double lo)
{
    double inside = mcr_clamp(x, -746.0, 710.0);
    double n = (inside * 0x1.71547652b82fep+0 + MCR_SHIFTER) - MCR_SHIFTER;
    double first = inside - n * 0x1.62e42fefa3p-1, tail = lo - n * 0x1.3de6af278ece6p-42; /* ln 2 in 41 and 53 bits */
    double r = first + tail, r_lo = (first - r) + tail, p = 0x1.ad9bc7c760cacp-26, one_plus, y, half, n1, n2;

    /* (e^r - 1 - r) / r^2, relative error 2^-57.9 of e^r */
    p = p * r + 0x1.28adffa03f7e8p-22;
    p = p * r + 0x1.71df1336ba186p-19;
    p = p * r + 0x1.a019995b0f5a3p-16;
    p = p * r + 0x1.a01a01328c2c6p-13;
    p = p * r + 0x1.6c16c18478b2fp-10;
    p = p * r + 0x1.1111111126354p-7;
    p = p * r + 0x1.55555555506b5p-5;
    p = p * r + 0x1.5555555555500p-3;
    p = p * r + 0x1.000000000000ap-1;
    one_plus = 1.0 + r;
    y = one_plus + (((1.0 - one_plus) + r) + (r_lo * one_plus + r * r * p));

    half = n * 0.5 + MCR_SHIFTER;
    n1 = half - MCR_SHIFTER;
    n2 = (n - n1) + MCR_SHIFTER;
    y *= mcr_from_bits((mcr_bits(half) << 52) + (UINT64_C(1023) << 52));
    return y * mcr_from_bits((mcr_bits(n2) << 52) + (UINT64_C(1023) << 52));
}

/* 0.63 ulp, 0.76 where the result is subnormal. */
MCR_INLINE double mcr_exp(double x) { return mcr_exp_sum_(x, 0.0); }

/* x = m 2^exponent with m in [sqrt(1/2), sqrt(2)], for x > 0 and finite. */
MCR_INLINE double mcr_split_(double x, double *exponent)
{
    const uint64_t root_half = UINT64_C(0x3fe6a09e667f3bcd), mantissa = (UINT64_C(1) << 52) - 1;
    int tiny = x < 0x1p-1022;
    uint64_t bits = mcr_bits(tiny ? x * 0x1p54 : x) + ((UINT64_C(1023) << 52) - root_half);
    /* The exponent's bits become a double by being put below those of 2^52. */
    *exponent = (mcr_from_bits((bits >> 52) | (UINT64_C(0x433) << 52)) - 0x1p52) - (tiny ? 1077.0 : 1023.0);
    return mcr_from_bits((bits & mantissa) + root_half);
}

/* 0.67 ulp; -infinity at 0, NaN below. With f = m - 1, s = f / (2 + f): log m = 2 atanh s = f - (f^2/2 - s (f^2/2 + R(s^2))); the
 * difference of the two large terms is formed exactly from the upper half of f. */
MCR_INLINE double mcr_log(double x)
{
    double k, m = mcr_split_(x, &k), f = m - 1.0, s = f / (2.0 + f), z = s * s, p = 0x1.2f03f98987fefp-3;
    double upper = mcr_upper_half(f), square = 0.5 * upper * upper, rest = 0.5 * (f - upper) * (f + upper);
    double head = f - square, tail, base, sum, result;

    /* (2 atanh(s) / s - 2) / s^2, |s| <= 3 - sqrt 8, relative error 2^-59.5 of the logarithm */
    p = p * z + 0x1.39a1e321474p-3;
    p = p * z + 0x1.74663d1d05731p-3;
    p = p * z + 0x1.c71c5213a0c1fp-3;
    p = p * z + 0x1.24924941e1d5ap-2;
    p = p * z + 0x1.999999997ff17p-2;
    p = p * z + 0x1.5555555555592p-1;
    tail = ((f - head) - square) - (rest - s * ((square + rest) + z * p));
    base = k * 0x1.62e42fefa3p-1; /* exact: 41 bits times 11 */
    sum = base + head;
    result = sum + (((base - sum) + head) + (tail + k * 0x1.3de6af278ece6p-42));
    result = x == MCR_INFINITY ? x : result;
    return x > 0.0 ? result : x == 0.0 ? -MCR_INFINITY : MCR_NAN;
}

/* ---- power: scalar, with branches ---- */

/* a * b as a sum, exact but for underflow. */
MCR_INLINE double mcr_product_(double a, double b, double *lo)
{
    double a1 = mcr_upper_half(a), a2 = a - a1, b1 = mcr_upper_half(b), b2 = b - b1, product = a * b;
    *lo = ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2;
    return product;
}

/* log x as a sum, relative error about 2^-65, for x > 0 and finite. */
static inline double mcr_log_sum_(double x, double *lo)
{
    double k, m = mcr_split_(x, &k), f = m - 1.0, d = 2.0 + f, d_lo = f - (d - 2.0), s = f / d, product, error, s_lo;
    double z, z_lo, p = 0x1.eac5a22f8090ap-4, q, q_lo, t, t_lo, base, sum, high, low;

    product = mcr_product_(s, d, &error);
    s_lo = (((f - product) - error) - s * d_lo) / d;
    z = mcr_product_(s, s, &z_lo);
    z_lo += 2.0 * s * s_lo;

    /* ((2 atanh(s) / s - 2) / s^2 - 2/3) / s^2, relative error 2^-73.3 of the logarithm */
    p = p * z + 0x1.de3d7465ffb72p-4;
    p = p * z + 0x1.11206f19da3f7p-3;
    p = p * z + 0x1.3b1364c9a4470p-3;
    p = p * z + 0x1.745d182955be7p-3;
    p = p * z + 0x1.c71c71c596905p-3;
    p = p * z + 0x1.2492492492f51p-2;
    p = p * z + 0x1.9999999999996p-2;

    /* q = 2/3 + z p, t = s z q, all as sums */
    error = z * p;
    q = 0x1.5555555555555p-1 + error;
    q_lo = ((0x1.5555555555555p-1 - q) + error) + 0x1.5555555555555p-55;
    t = mcr_product_(z, q, &t_lo);
    t_lo += z * q_lo + z_lo * q;
    product = mcr_product_(s, t, &error);
    error += s * t_lo + s_lo * t;

    high = 2.0 * s + product;
    low = ((2.0 * s - high) + product) + (error + 2.0 * s_lo);
    base = k * 0x1.62e42fefa3p-1;
    sum = base + high;
    low += ((base - sum) + high) + k * 0x1.3de6af278ece6p-42;
    high = sum + low;
    *lo = (sum - high) + low;
    return high;
}

/* 0.70 ulp. x^y as C's pow in all special cases: x^0 = 1^y = 1; a negative base with an integer exponent has the sign of its parity,
 * with another one gives NaN. */
static inline double mcr_pow(double x, double y)
{
    double magnitude = fabs(x), whole = mcr_floor(y), log_hi, log_lo, product, error, result;
    int integer = whole == y, odd = integer && fabs(y) < 0x1p53 && mcr_floor(0.5 * y) != 0.5 * y;

    if (y == 0.0 || x == 1.0)
        return 1.0;
    if (x != x || y != y)
        return x + y;
    if (magnitude == 1.0 && fabs(y) == MCR_INFINITY)
        return 1.0;
    if (magnitude == 0.0 || magnitude == MCR_INFINITY || fabs(y) == MCR_INFINITY) {
        int grows = (magnitude > 1.0) == (y > 0.0);
        result = grows ? MCR_INFINITY : 0.0;
        return odd ? mcr_copysign(result, x) : result;
    }
    if (x < 0.0 && !integer)
        return MCR_NAN;
    log_hi = mcr_log_sum_(magnitude, &log_lo);
    if (fabs(y) > 0x1p64) /* the result is 0, 1 (only for |x| = 1) or infinite; the products below shall not overflow */
        y = mcr_copysign(0x1p64, y);
    product = mcr_product_(y, log_hi, &error);
    error += y * log_lo;
    if (fabs(product) > 800.0) {
        error = 0.0;
    }
    result = mcr_exp_sum_(product, error);
    return odd ? mcr_copysign(result, x) : result;
}

#ifdef __cplusplus
}
#endif

#endif
