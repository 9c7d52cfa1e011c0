/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Elementary functions: accuracy against the C library's long double functions, where those have at least 64 bits (their own
 * error, below 2 ulp of long double, is 0.001 ulp here); exact values; and the same bits from scalar code, from vector code of
 * every instruction set, and from every compiler (a checksum).
 */
#include "base/elementary.h"
#include "base/random.h"
#include "../tap.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#define POINTS 400000u /* for each range of each function */

typedef double function(double x);
typedef long double reference(double x);

/* ---- accuracy ---- */

/* Random numbers of the test: a function of a counter. */
static double unit(uint64_t stream, uint64_t n)
{
    return mcr_unit_double(mcr_mix64(mcr_mix64(stream) + n * MCR_GOLDEN));
}

/* Difference in spacings of doubles at the true value. */
static double ulps(double got, long double expected)
{
    int exponent;
    if (isnan(got) || isnan(expected))
        return isnan(got) && isnan(expected) ? 0.0 : INFINITY;
    if (fabsl(expected) > DBL_MAX || isinf(got)) /* half an ulp above DBL_MAX rounds to infinity */
        return (isinf(got) && fabsl(expected) >= 0x1.fffffffffffff8p1023L) ? 0.0 : INFINITY;
    frexpl(expected, &exponent);
    exponent = expected == 0.0L || exponent < -1021 ? -1021 : exponent;
    return (double)fabsl(ldexpl(got - expected, 53 - exponent));
}

/* A point of [low, high], or with `logarithmic` of magnitude 2^low to 2^high and either sign where `both`. */
struct range {
    double low, high;
    int logarithmic, both;
};

static double point(const struct range *range, uint64_t stream, uint64_t n)
{
    double u = unit(stream, 2 * n), x = range->low + (range->high - range->low) * u;
    if (range->logarithmic)
        x = ldexp(1.0 + unit(stream, 2 * n + 1), (int)floor(x));
    if (range->both && (n & 1))
        x = -x;
    return x;
}

struct accuracy {
    const char *name;
    function *ours;
    reference *theirs;
    double bound; /* ulp, as stated in the header */
    struct range ranges[3];
};

static double our_sin_turns(double u) { double s, c; mcr_sincos_turns(u, &s, &c); return s; }
static double our_cos_turns(double u) { double s, c; mcr_sincos_turns(u, &s, &c); return c; }
#define WRAP(name) static double our_##name(double x) { return mcr_##name(x); }
WRAP(sin) WRAP(cos) WRAP(tan) WRAP(sin_degrees) WRAP(cos_degrees) WRAP(tan_degrees)
WRAP(asin) WRAP(acos) WRAP(atan) WRAP(exp) WRAP(log)

#define PI_LONG 3.14159265358979323846264338327950288L
static long double ref_sin(double x) { return sinl(x); }
static long double ref_cos(double x) { return cosl(x); }
static long double ref_tan(double x) { return tanl(x); }
static long double ref_asin(double x) { return asinl(x); }
static long double ref_acos(double x) { return acosl(x); }
static long double ref_atan(double x) { return atanl(x); }
static long double ref_exp(double x) { return expl(x); }
static long double ref_log(double x) { return logl(x); }

/* sin, cos and tan of x quarter turns' worth: `quarter` is the unit's 90 degrees. remquo is exact. */
static void quarters(double x, double quarter, long double *s, long double *c)
{
    int q;
    long double r = (long double)remquo(x, quarter, &q) * (PI_LONG / 2) / quarter, sine = sinl(r), cosine = cosl(r);
    *s = (q & 1) ? cosine : sine;
    *c = (q & 1) ? sine : cosine;
    *s = (q & 2) ? -*s : *s;
    *c = ((q + 1) & 2) ? -*c : *c;
}
static long double ref_sin_turns(double x) { long double s, c; quarters(x, 0.25, &s, &c); return s; }
static long double ref_cos_turns(double x) { long double s, c; quarters(x, 0.25, &s, &c); return c; }
static long double ref_sin_degrees(double x) { long double s, c; quarters(x, 90, &s, &c); return s; }
static long double ref_cos_degrees(double x) { long double s, c; quarters(x, 90, &s, &c); return c; }
static long double ref_tan_degrees(double x) { long double s, c; quarters(x, 90, &s, &c); return c == 0 ? INFINITY : s / c; }

static const struct accuracy accuracies[] = {
    {"sin", our_sin, ref_sin, 0.80, {{-4, 4, 0, 0}, {-1e5, 1e5, 0, 0}, {-1000, 16, 1, 1}}},
    {"cos", our_cos, ref_cos, 0.80, {{-4, 4, 0, 0}, {-1e5, 1e5, 0, 0}, {-1000, 16, 1, 1}}},
    {"tan", our_tan, ref_tan, 1.00, {{-4, 4, 0, 0}, {-1e5, 1e5, 0, 0}, {-1000, 16, 1, 1}}},
    {"sin of turns", our_sin_turns, ref_sin_turns, 1.00, {{-1, 1, 0, 0}, {-1e9, 1e9, 0, 0}, {-1000, 40, 1, 1}}},
    {"cos of turns", our_cos_turns, ref_cos_turns, 0.80, {{-1, 1, 0, 0}, {-1e9, 1e9, 0, 0}, {-1000, 40, 1, 1}}},
    {"sin of degrees", our_sin_degrees, ref_sin_degrees, 1.00, {{-360, 360, 0, 0}, {-1e9, 1e9, 0, 0}, {-1000, 40, 1, 1}}},
    {"cos of degrees", our_cos_degrees, ref_cos_degrees, 0.80, {{-360, 360, 0, 0}, {-1e9, 1e9, 0, 0}, {-1000, 40, 1, 1}}},
    {"tan of degrees", our_tan_degrees, ref_tan_degrees, 1.00, {{-360, 360, 0, 0}, {-1e9, 1e9, 0, 0}, {-1000, 40, 1, 1}}},
    {"asin", our_asin, ref_asin, 1.60, {{-1, 1, 0, 0}, {0.99, 1, 0, 1}, {-1022, 0, 1, 1}}},
    {"acos", our_acos, ref_acos, 1.60, {{-1, 1, 0, 0}, {0.99, 1, 0, 1}, {-1022, 0, 1, 1}}},
    {"atan", our_atan, ref_atan, 0.65, {{-3, 3, 0, 0}, {-50, 50, 1, 1}, {-1070, 1023, 1, 1}}},
    {"exp", our_exp, ref_exp, 0.80, {{-1, 1, 0, 0}, {-750, 711, 0, 0}, {-60, 9, 1, 1}}},
    {"log", our_log, ref_log, 0.70, {{0.5, 2, 0, 0}, {0.999, 1.001, 0, 0}, {-1074, 1023, 1, 0}}},
};

static void test_accuracy(void)
{
    for (size_t i = 0; i < sizeof accuracies / sizeof *accuracies; i++) {
        const struct accuracy *a = &accuracies[i];
        double worst = 0.0, where = 0.0;
        for (uint32_t r = 0; r < 3; r++)
            for (uint32_t n = 0; n < POINTS; n++) {
                double x = point(&a->ranges[r], 10 * i + r, n), error = ulps(a->ours(x), a->theirs(x));
                if (!(error <= worst)) {
                    worst = error;
                    where = x;
                }
            }
        ok(worst <= a->bound, "%s: largest error %.4f ulp (at %a), bound %.2f", a->name, worst, where, a->bound);
    }
}

/* Neighbours of the places where two pieces of a function meet, or where a result changes its exponent or kind. */
static void test_edges(void)
{
    static const double edges[] = {0x1.921fb54442d18p-1, 0x1.921fb54442d18p+0, 0x1.921fb54442d18p+1, 0x1.6a09e667f3bcdp-1,
                                   0x1.6a09e667f3bcdp+0, 0x1.a827999fcef32p-2, 0x1.3504f333f9de6p+1, 0x1.62e42fefa39efp-2,
                                   0x1.62e42fefa39efp-1, 0.0, 0.25, 0.5, 1.0, 2.0, 0.125, 45, 90, 30, 180, 360, 0x1p-1022, DBL_MIN * 0.5,
                                   0x1.62e42fefa39efp+9, 0x1.74910d52d3051p+9, 0x1.6232bdd7abcd2p+9, 1e5, 63661 * 0x1.921fb54442d18p+0,
                                   1e-300, 1e-160, 1e-8, 3e-8};
    for (size_t i = 0; i < sizeof accuracies / sizeof *accuracies; i++) {
        const struct accuracy *a = &accuracies[i];
        double worst = 0.0, where = 0.0;
        for (size_t e = 0; e < sizeof edges / sizeof *edges; e++)
            for (int step = -200; step <= 200; step++)
                for (int sign = 0; sign < 2; sign++) {
                    uint64_t bits = mcr_bits(edges[e]);
                    double x = mcr_from_bits(bits + (uint64_t)(int64_t)(bits == 0 && step < 0 ? -step : step)), error;
                    x = sign ? -x : x;
                    if (fabs(x) > 1e5)
                        continue;
                    error = ulps(a->ours(x), a->theirs(x));
                    if (!(error <= worst)) {
                        worst = error;
                        where = x;
                    }
                }
        ok(worst <= a->bound, "%s at its seams: largest error %.4f ulp (at %a)", a->name, worst, where);
    }
}

static void test_two_arguments(void)
{
    static const struct range wide = {-1074, 1023, 1, 1}, near = {-2, 2, 0, 0}, base = {-30, 30, 1, 0}, power = {-40, 40, 0, 0},
                              tiny = {-1074, 1023, 1, 0}, slow = {-12, 12, 1, 1}, one = {0.9, 1.1, 0, 0}, fast = {-7000, 7000, 0, 0};
    const struct range *pairs[][2] = {{&wide, &wide}, {&near, &near}, {&base, &base}};
    const struct range *powers[][2] = {{&base, &power}, {&tiny, &slow}, {&one, &fast}};
    double worst = 0.0, wx = 0.0, wy = 0.0;

    for (uint32_t r = 0; r < 3; r++)
        for (uint32_t n = 0; n < POINTS; n++) {
            double x = point(pairs[r][0], 500 + r, n), y = point(pairs[r][1], 600 + r, n / 2), e = ulps(mcr_atan2(y, x), atan2l(y, x));
            if (!(e <= worst)) {
                worst = e;
                wx = x;
                wy = y;
            }
        }
    ok(worst <= 0.65, "atan2: largest error %.4f ulp (y = %a, x = %a), bound 0.65", worst, wy, wx);
    worst = 0.0;
    for (uint32_t r = 0; r < 3; r++)
        for (uint32_t n = 0; n < POINTS; n++) {
            double x = point(powers[r][0], 700 + r, n), y = point(powers[r][1], 800 + r, n), e = ulps(mcr_pow(x, y), powl(x, y));
            if (!(e <= worst)) {
                worst = e;
                wx = x;
                wy = y;
            }
        }
    ok(worst <= 0.75, "pow: largest error %.4f ulp (x = %a, y = %a), bound 0.75", worst, wx, wy);
}

/* ---- exact values ---- */

static int same(double a, double b)
{
    return mcr_bits(a) == mcr_bits(b) || (a != a && b != b);
}

static void test_exact(void)
{
    static const double specials[] = {0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 2.0, -2.0, 3.0, -3.0, 2.5, -2.5, INFINITY, -INFINITY, NAN,
                                      0x1p52, 0x1p53, -0x1p53, 0x1.fffffffffffffp52, 4.0, -4.0, DBL_MAX, -DBL_MAX, 1e300, -1e300, DBL_MIN,
                                      0x1p-1074, -0x1p-1074, 0x1.0000000000001p0, 0x1.fffffffffffffp-1, 1e17, 1023, 1024, -1074, -1075};
    const size_t count = sizeof specials / sizeof *specials;
    int good = 1, wrong_pow = 0, wrong_atan2 = 0, wrong_floor = 0;
    double s, c;

    for (int n = -8000; n <= 8000; n++) {
        static const double quarter_sine[4] = {0, 1, 0, -1};
        mcr_sincos_turns(n * 0.25, &s, &c);
        good &= same(s, quarter_sine[n & 3]) && same(c, quarter_sine[(n + 1) & 3]);
        good &= same(mcr_sin_degrees(90.0 * n), quarter_sine[n & 3]) && same(mcr_cos_degrees(90.0 * n), quarter_sine[(n + 1) & 3]);
        good &= same(mcr_tan_degrees(90.0 * n), (n & 1) ? INFINITY : 0.0);
        good &= same(mcr_sin_degrees(360.0 * n + 30), 0.5) && same(mcr_sin_degrees(360.0 * n + 150), 0.5);
        good &= same(mcr_sin_degrees(360.0 * n - 30), -0.5) && same(mcr_sin_degrees(360.0 * n + 210), -0.5);
        good &= same(mcr_cos_degrees(360.0 * n + 60), 0.5) && same(mcr_cos_degrees(360.0 * n - 60), 0.5);
        good &= same(mcr_cos_degrees(360.0 * n + 120), -0.5) && same(mcr_cos_degrees(360.0 * n + 240), -0.5);
        good &= same(mcr_tan_degrees(180.0 * n + 45), 1.0) && same(mcr_tan_degrees(180.0 * n - 45), -1.0);
    }
    ok(good, "sines, cosines and tangents of turns and degrees are exact where they can be");

    for (size_t i = 0; i < count; i++) {
        double x = specials[i];
        wrong_floor += !same(mcr_floor(x), floor(x));
        for (size_t j = 0; j < count; j++) {
            double y = specials[j], got = mcr_pow(x, y), want = pow(x, y), angle = mcr_atan2(y, x), libm = atan2(y, x);
            /* ordinary results may differ from libm's in the last place: kind and sign must not */
            if (isnan(want) || isinf(want) || want == 0.0 || fabs(x) == 1.0 ? !same(got, want) : ulps(got, want) > 1.5)
                printf("# pow(%g, %g) = %g, expected %g\n", x, y, got, want), wrong_pow++;
            if (isnan(libm) || libm == 0.0 ? !same(angle, libm) : ulps(angle, libm) > 1.0)
                printf("# atan2(%g, %g) = %.17g, expected %.17g\n", y, x, angle, libm), wrong_atan2++;
        }
    }
    ok(!wrong_pow, "pow has C's special cases");
    ok(!wrong_atan2, "atan2 has C's special cases");
    for (uint64_t n = 0; n < 200000; n++) {
        double x = mcr_from_bits(mcr_mix64(n)), z = (unit(3, n) - 0.5) * 100.0;
        wrong_floor += !same(mcr_floor(x), floor(x)) + !same(mcr_floor(z), floor(z)) + !same(mcr_floor(floor(z)), floor(z));
    }
    ok(!wrong_floor, "floor is exact");
}

static void test_special(void)
{
    static const double huge[] = {1e6, 1e9, 0x1p32, 0x1p33, 1e17, 1e100, DBL_MAX};
    int good = 1;
    for (size_t i = 0; i < sizeof huge / sizeof *huge; i++)
        for (double x = -huge[i], k = 0; k < 2; k++, x = -x) {
            good &= fabs(mcr_sin(x)) <= 1.0 && fabs(mcr_cos(x)) <= 1.0 && isfinite(mcr_tan(x));
            good &= fabs(our_sin_turns(x)) <= 1.0 && fabs(our_cos_turns(x)) <= 1.0;
            good &= fabs(mcr_sin_degrees(x)) <= 1.0 && fabs(mcr_cos_degrees(x)) <= 1.0;
        }
    ok(good, "sine and cosine stay within [-1, 1] at huge arguments");
    good = 1;
    for (size_t i = 0; i < sizeof accuracies / sizeof *accuracies; i++)
        good &= isnan(accuracies[i].ours(NAN));
    ok(good, "NaN stays NaN");
    ok(isnan(mcr_sin(INFINITY)) && isnan(mcr_cos(-INFINITY)) && isnan(mcr_tan(INFINITY)) && isnan(mcr_asin(1.5)) &&
           isnan(mcr_acos(-1.0000001)) && isnan(mcr_log(-1.0)) && isnan(our_sin_turns(INFINITY)) && isnan(mcr_cos_degrees(INFINITY)),
       "outside the domain is NaN");
    ok(same(mcr_exp(0.0), 1.0) && same(mcr_exp(-INFINITY), 0.0) && same(mcr_exp(INFINITY), INFINITY) && same(mcr_exp(1e300), INFINITY) &&
           same(mcr_exp(-1e300), 0.0) && same(mcr_log(1.0), 0.0) &&
           same(mcr_log(0.0), -INFINITY) && same(mcr_log(-0.0), -INFINITY) &&
           same(mcr_log(INFINITY), INFINITY),
       "ends of exp and log");
    ok(same(mcr_sin(-0.0), -0.0) && same(mcr_tan(-0.0), -0.0) && same(mcr_atan(-0.0), -0.0) && same(mcr_asin(-0.0), -0.0) &&
           same(mcr_cos(-0.0), 1.0) && same(mcr_asin(1.0), MCR_PI / 2) && same(mcr_acos(1.0), 0.0) && same(mcr_acos(-1.0), MCR_PI) && same(mcr_atan(INFINITY), MCR_PI / 2),
       "signs of zero and ends of the arc functions");
}

/* ---- the same bits everywhere ---- */

#define LANES 4096
static double input[LANES], second[LANES], expected[LANES], got[LANES], other[LANES];

/* Loops of one instruction set; `attributes` names it. */
#define LOOP(isa, attributes, name, expression)                                     \
    static attributes __attribute__((noinline)) void loop_##name##_##isa(void)      \
    {                                                                               \
        for (int i = 0; i < LANES; i++) {                                           \
            double x = input[i], y = second[i];                                     \
            (void)y;                                                                \
            got[i] = expression;                                                    \
        }                                                                           \
    }
#define LOOPS(isa, attributes)                                                                          \
    LOOP(isa, attributes, sin, mcr_sin(x))                                                              \
    LOOP(isa, attributes, cos, mcr_cos(x))                                                              \
    LOOP(isa, attributes, tan, mcr_tan(x))                                                              \
    LOOP(isa, attributes, sin_degrees, mcr_sin_degrees(x))                                              \
    LOOP(isa, attributes, cos_degrees, mcr_cos_degrees(x))                                              \
    LOOP(isa, attributes, tan_degrees, mcr_tan_degrees(x))                                              \
    LOOP(isa, attributes, asin, mcr_asin(x))                                                            \
    LOOP(isa, attributes, acos, mcr_acos(x))                                                            \
    LOOP(isa, attributes, atan, mcr_atan(x))                                                            \
    LOOP(isa, attributes, atan2, mcr_atan2(y, x))                                                       \
    LOOP(isa, attributes, exp, mcr_exp(x))                                                              \
    LOOP(isa, attributes, log, mcr_log(x))                                                              \
    LOOP(isa, attributes, floor, mcr_floor(x))                                                          \
    LOOP(isa, attributes, unit, mcr_unit_double(mcr_mix64(mcr_bits(x))))                                \
    static attributes __attribute__((noinline)) void loop_turns_##isa(void)                             \
    {                                                                                                   \
        for (int i = 0; i < LANES; i++)                                                                 \
            mcr_sincos_turns(input[i], &got[i], &other[i]);                                             \
        for (int i = 0; i < LANES; i++)                                                                 \
            got[i] += 4.0 * other[i];                                                                   \
    }                                                                                                   \
    static void (*const loops_##isa[])(void) = {loop_sin_##isa, loop_cos_##isa, loop_tan_##isa, loop_sin_degrees_##isa, loop_cos_degrees_##isa, \
                                                loop_tan_degrees_##isa, loop_asin_##isa, loop_acos_##isa, loop_atan_##isa, loop_atan2_##isa,    \
                                                loop_exp_##isa, loop_log_##isa, loop_floor_##isa, loop_unit_##isa, loop_turns_##isa};

LOOPS(baseline, )
#define LOOP_COUNT (sizeof loops_baseline / sizeof *loops_baseline)

static double scalar_value(size_t which, double x, double y)
{
    double s, c;
    switch (which) {
    case 9: return mcr_atan2(y, x);
    case 12: return mcr_floor(x);
    case 13: return (double)(mcr_mix64(mcr_bits(x)) >> 11) * 0x1p-53;
    case 14: mcr_sincos_turns(x, &s, &c); return s + 4.0 * c;
    default: break;
    }
    static function *const plain[] = {our_sin, our_cos, our_tan, our_sin_degrees, our_cos_degrees, our_tan_degrees, our_asin,
                                      our_acos, our_atan, NULL, our_exp, our_log};
    return plain[which](x);
}

static void fill(uint64_t round)
{
    static const struct range wide = {-1074, 1023, 1, 1}, middle = {-30, 30, 1, 1}, small = {-1.2, 1.2, 0, 0};
    const struct range *range = round == 0 ? &wide : round == 1 ? &middle : &small;
    for (uint32_t i = 0; i < LANES; i++) {
        input[i] = point(range, 1000 + round, i);
        second[i] = point(range, 2000 + round, i / 2);
    }
    input[0] = 0.0, input[1] = -0.0, input[2] = INFINITY, input[3] = -INFINITY, input[4] = NAN;
}

static void compare_loops(const char *isa, void (*const *loops)(void))
{
    size_t different = 0;
    for (uint64_t round = 0; round < 3; round++) {
        fill(round);
        for (size_t f = 0; f < LOOP_COUNT; f++) {
            for (uint32_t i = 0; i < LANES; i++)
                expected[i] = scalar_value(f, input[i], second[i]);
            memset(got, 0, sizeof got);
            loops[f]();
            for (uint32_t i = 0; i < LANES; i++)
                different += !same(got[i], expected[i]);
        }
    }
    ok(different == 0, "%s loops give the bits of scalar code: %zu of %zu differ", isa, different, (size_t)3 * LOOP_COUNT * LANES);
}

#if defined(__x86_64__)
LOOPS(avx2, __attribute__((target("avx2"))))
LOOPS(avx512, __attribute__((target("avx512f,avx512dq,avx512vl,avx512bw"))))
#endif

static void test_bits(void)
{
    uint64_t checksum = 0;
    compare_loops("baseline", loops_baseline);
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2"))
        compare_loops("AVX2", loops_avx2);
    else
        tap_skip("AVX2 loops", "no AVX2");
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512bw"))
        compare_loops("AVX-512", loops_avx512);
    else
        tap_skip("AVX-512 loops", "no AVX-512");
#endif
    for (uint64_t round = 0; round < 3; round++) {
        fill(round);
        for (uint32_t i = 0; i < LANES; i++) {
            for (size_t f = 0; f < LOOP_COUNT; f++) {
                double value = scalar_value(f, input[i], second[i]);
                checksum = mcr_mix64(checksum + (value != value ? 1 : mcr_bits(value)));
            }
            double value = mcr_pow(fabs(input[i]), second[i]);
            checksum = mcr_mix64(checksum + (value != value ? 1 : mcr_bits(value)));
        }
    }
    /* From gcc 12 on x86-64; it changes only with the functions themselves. */
    ok(checksum == UINT64_C(0x1b793126ee95b39d), "checksum of all functions is %#018llx", (unsigned long long)checksum);
}

int main(void)
{
    if (LDBL_MANT_DIG >= 64) {
        test_accuracy();
        test_edges();
        test_two_arguments();
    } else {
        tap_skip("accuracy", "long double is no wider than double");
    }
    test_exact();
    test_special();
    test_bits();
    return tap_done();
}
