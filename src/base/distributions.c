/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The incomplete beta function by its continued fraction, its leading factor by deviances and Stirling's error term (C. Loader, "Fast and accurate
 * computation of binomial probabilities", 2000), since differences of log-gammas lose digits as the degrees of freedom grow. Quantiles by Newton's
 * method on log tail against log t: the log tail is concave in log t, so that steps from the right are monotone.
 */
#include "base/distributions.h"

#include "base/elementary.h"

#define LOG_ROOT_2PI 0.91893853320467274178
#define ROOT_2PI 2.5066282746310005024
#define TINY 1e-300          /* stands for 0 in a denominator of Lentz' method */
#define MOST_STEPS 100000    /* of a continued fraction: 10 sqrt(df) at the largest df that gets there */
#define NEARLY_NORMAL 1e7    /* degrees of freedom from which on three terms of an expansion in 1/df have all digits */
#define NEWTON_STEPS 200

double mcr_log1p(double x)
{
    double u = 1.0 + x;
    /* (u - 1) is what of x is in u; log(u) / (u - 1) varies slowly. W. Kahan's way. */
    return u == 1.0 ? x : u == MCR_INFINITY ? u : mcr_log(u) * (x / (u - 1.0));
}

/* log(1 + x) - x without cancellation; one_plus is 1 + x, given apart for x close to -1. With s = x / (2 + x), log(1 + x) = 2 atanh s and
 * 2 s - x = -x s. */
static double log1p_rest(double x, double one_plus)
{
    double s, z, sum = 0.0;
    if (!(fabs(x) < 0.5))
        return mcr_log(one_plus) - x;
    s = x / (2.0 + x);
    z = s * s; /* at most 1/9: 18 terms */
    for (int k = 18; k >= 1; k--)
        sum = sum * z + 1.0 / (2 * k + 1);
    return 2.0 * s * z * sum - x * s;
}

static double stirling_main(double z) { return (z - 0.5) * mcr_log(z) - z; }

/* Stirling's error: log gamma(z) - ((z - 1/2) log z - z + log(2 pi) / 2), absolute error 1e-14; below 16 by
 * gamma(z) = gamma(z + k) / (z ... (z + k - 1)). */
static double stirling_error(double z)
{
    double product = 1.0, x = z, r, series;
    for (; x < 16.0; x += 1.0)
        product *= x;
    r = 1.0 / (x * x); /* Bernoulli numbers over 2k (2k - 1); the first one left out is 2e-18 at 16 */
    series = (1.0 / 12 - r * (1.0 / 360 - r * (1.0 / 1260 - r * (1.0 / 1680 - r * (1.0 / 1188 - r * (691.0 / 360360 - r / 156)))))) / x;
    return x > z ? series + stirling_main(x) - mcr_log(product) - stirling_main(z) : series;
}

double mcr_log_gamma(double x)
{
    if (!(x > 0.0))
        return MCR_NAN;
    return stirling_main(x) + LOG_ROOT_2PI + stirling_error(x);
}

static double leading_factor(double a, double b, double x, double y)
{
    double n = a + b, h = x * b - y * a; /* x n / a = 1 + h / a, y n / b = 1 - h / b */
    double exponent = stirling_error(n) - stirling_error(a) - stirling_error(b);
    exponent += a * log1p_rest(h / a, x * n / a) + b * log1p_rest(-h / b, y * n / b);
    return sqrt(a / n * b) / ROOT_2PI * mcr_exp(exponent);
}

static double not_zero(double x) { return fabs(x) < TINY ? TINY : x; }

/* I_x(a, b) / (x^a y^b / B(a, b)) for x below (a + 1) / (a + b + 2): the continued fraction of A. R. DiDonato and A. H. Morris (ACM Trans. Math.
 * Softw. 18, 1992, eq. 9), which takes the distance from the mean apart so that nothing cancels near it, by W. J. Lentz' method. */
static double beta_fraction(double a, double b, double x, double y)
{
    double distance = a * y - b * x, f = not_zero(a / (a + 1.0) * (distance + 1.0)), c = f, d = 0.0;
    for (int n = 1; n <= MOST_STEPS; n++) {
        double odd = a + 2 * n - 1.0, turn = n * (b - n) * x / odd, step;
        double numerator = (a + n - 1.0) * (a + b + n - 1.0) / odd * turn * x;
        double denominator = n + turn + (a + n) / (odd + 2.0) * (distance + 1.0 + n * (1.0 + y));
        d = 1.0 / not_zero(denominator + numerator * d);
        c = not_zero(denominator + numerator / c);
        step = c * d;
        f *= step;
        if (fabs(step - 1.0) < 0x1p-52)
            break;
    }
    return 1.0 / f;
}

struct mcr_beta mcr_beta_regularised(double a, double b, double x, double y)
{
    struct mcr_beta r = {MCR_NAN, MCR_NAN, MCR_NAN};
    if (!(a > 0.0 && b > 0.0 && x >= 0.0 && y >= 0.0))
        return r;
    if (x == 0.0 || y == 0.0) {
        r.lower = x == 0.0 ? 0.0 : 1.0;
        r.upper = 1.0 - r.lower;
        r.density = 0.0;
        return r;
    }
    r.density = leading_factor(a, b, x, y);
    if (x < (a + 1.0) / (a + b + 2.0)) {
        r.lower = r.density * beta_fraction(a, b, x, y);
        r.upper = 1.0 - r.lower;
    } else {
        r.upper = r.density * beta_fraction(b, a, y, x);
        r.lower = 1.0 - r.upper;
    }
    return r;
}

/* ---- normal ---- */

/* P(0 < Z < z): a series of positive terms, z^(2k+1) / (1 3 5 ... (2k+1)). */
static double normal_centre(double z)
{
    double term = z, sum = 0.0;
    for (int k = 1; sum + term != sum && k < 1000; k++) {
        sum += term;
        term *= z * z / (2 * k + 1);
    }
    return sum * mcr_exp(-0.5 * z * z) / ROOT_2PI;
}

double mcr_normal_upper(double z)
{
    double fraction = 0.0;
    int terms;
    if (z != z)
        return z;
    if (z < 0.0)
        return 1.0 - mcr_normal_upper(-z);
    if (z < 2.0)
        return 0.5 - normal_centre(z);
    terms = z < 8.0 ? 10 + (int)(700.0 / (z * z)) : 20; /* of 1 / (z + 1 / (z + 2 / (z + 3 / ...))) for all digits; measured */
    for (int k = terms; k >= 1; k--)
        fraction = k / (z + fraction);
    return mcr_exp(-0.5 * z * z) / (ROOT_2PI * (z + fraction));
}

/* z with P(Z > z) = q <= 1/2, to 4.5e-4: Abramowitz and Stegun 26.2.23. */
static double normal_guess(double q)
{
    double t = sqrt(-2.0 * mcr_log(q));
    return t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
}

double mcr_normal_quantile(double p)
{
    double q = p < 0.5 ? p : 1.0 - p, z = 0.0;
    if (!(p > 0.0 && p < 1.0))
        return MCR_NAN;
    if (q > 0.4) { /* near the middle: Newton on the centre, concave in z, from 0 on monotone */
        double centre = fabs(p - 0.5);
        for (int k = 0; k < 8; k++)
            z += (centre - normal_centre(z)) * ROOT_2PI * mcr_exp(0.5 * z * z);
    } else {
        z = normal_guess(q);
        for (int k = 0; k < 3; k++) {
            double upper = mcr_normal_upper(z);
            z += mcr_log(upper / q) * upper * ROOT_2PI * mcr_exp(0.5 * z * z);
        }
    }
    return p < 0.5 ? -z : z;
}

/* ---- Student ---- */

/* x = df / (df + t^2) and y = 1 - x. */
static struct mcr_beta student_beta(double t, double df)
{
    double s = t * t / df, x = 1.0 / (1.0 + s), y = s < 1.0 ? s / (1.0 + s) : 1.0 / (1.0 + 1.0 / s);
    return mcr_beta_regularised(0.5 * df, 0.5, x, y);
}

double mcr_student_upper(double t, double df)
{
    if (!(df > 0.0) || t != t)
        return MCR_NAN;
    if (df >= NEARLY_NORMAL) { /* the expansion of R. A. Fisher and E. A. Cornish (1960), inverse of the one below */
        double r = 1.0 / df, s = t * t;
        return mcr_normal_upper(t * (1.0 - r * ((s + 1.0) / 4.0 - r * ((13.0 * s + 8.0) * s + 3.0) / 96.0)));
    }
    if (t < 0.0)
        return 1.0 - 0.5 * student_beta(t, df).lower;
    return 0.5 * student_beta(t, df).lower;
}

/* t with P(T > t) = q < 1/4; t f(t) = x^a y^b / B(a, b), the density of the beta. */
static double student_tail_quantile(double q, double df)
{
    /* D. L. Wallace's transformation (1959) to the normal, inverted. It may overflow for few degrees of freedom: then Cauchy's tail. */
    double z = normal_guess(q) * (8.0 * df + 3.0) / (8.0 * df + 1.0), exponent = z * z / df;
    double t = exponent < 300.0 ? sqrt(df * (mcr_exp(exponent) - 1.0)) : 1e60;
    for (int k = 0; k < NEWTON_STEPS; k++) {
        struct mcr_beta beta = student_beta(t, df);
        double upper = 0.5 * beta.lower, step = mcr_log(upper / q) * upper / beta.density;
        t *= mcr_exp(step);
        if (!(fabs(step) > 0x1p-50))
            break;
    }
    return t;
}

/* t with P(0 < T < t) = c <= 1/4. */
static double student_centre_quantile(double c, double df)
{
    double t = c * ROOT_2PI;
    for (int k = 0; c > 0.0 && k < NEWTON_STEPS; k++) {
        struct mcr_beta beta = student_beta(t, df);
        double centre = 0.5 * beta.upper, step = mcr_log(c / centre) * centre / beta.density;
        t *= mcr_exp(step);
        if (!(fabs(step) > 0x1p-50))
            break;
    }
    return t;
}

double mcr_student_quantile(double p, double df)
{
    double q = p < 0.5 ? p : 1.0 - p, t;
    if (!(df > 0.0 && p > 0.0 && p < 1.0))
        return MCR_NAN;
    if (df >= NEARLY_NORMAL) {
        double z = -mcr_normal_quantile(q), s = z * z, r = 1.0 / df;
        t = z * (1.0 + r * ((s + 1.0) / 4.0 + r * ((5.0 * s + 16.0) * s + 3.0) / 96.0));
    } else {
        t = q < 0.25 ? student_tail_quantile(q, df) : student_centre_quantile(fabs(p - 0.5), df);
    }
    return p < 0.5 ? -t : t;
}

double mcr_coin_lower(double k, double n)
{
    if (k < 0.0)
        return 0.0;
    return k >= n ? 1.0 : mcr_beta_regularised(n - k, k + 1.0, 0.5, 0.5).lower;
}
