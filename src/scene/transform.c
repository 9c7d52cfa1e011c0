/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/transform.h"

#include "scene/vector.h"
#include "scene/words.h"

/* a + b exactly: the rounded sum and its error (Knuth). */
static double two_sum(double a, double b, double *error)
{
    double sum = a + b, part = sum - a;
    *error = (a - (sum - part)) + (b - part);
    return sum;
}

/* a * b exactly, by halves of 26 bits (Dekker); magnitudes below 1e250. The compiler must not contract. */
static double two_product(double a, double b, double *error)
{
    const double split = 134217729; /* 2^27 + 1 */
    double p = a * b, ca = split * a, cb = split * b;
    double ah = ca - (ca - a), al = a - ah, bh = cb - (cb - b), bl = b - bh;
    *error = ((ah * bh - p) + ah * bl + al * bh) + al * bl;
    return p;
}

/* (high, low) += a * b. */
static void accumulate(double *high, double *low, double a, double b)
{
    double error, rest, product = two_product(a, b, &error), sum = two_sum(*high, product, &rest);
    *high = two_sum(sum, *low + (error + rest), low);
}

void mcr_transform_init(struct mcr_transform *transform, const double camera[3])
{
    memset(transform, 0, sizeof *transform);
    for (int i = 0; i < 3; i++) {
        transform->l[i][i] = 1;
        transform->t[i] = 0 - camera[i];
    }
}

void mcr_transform_then(struct mcr_transform *transform, double l[3][3], const double t[3])
{
    double product[3][3];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            accumulate(&transform->t[i], &transform->low[i], transform->l[i][k], t[k]);
        for (int j = 0; j < 3; j++)
            product[i][j] = transform->l[i][0] * l[0][j] + transform->l[i][1] * l[1][j] + transform->l[i][2] * l[2][j];
    }
    memcpy(transform->l, product, sizeof product);
    transform->steps++;
}

static void column(const struct mcr_transform *transform, int j, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = transform->l[i][j];
}

int mcr_transform_finish(struct mcr_transform *transform)
{
    double c[3][3], cross[3], det, most = 0;
    for (int j = 0; j < 3; j++) {
        double length;
        column(transform, j, c[j]);
        if (!isfinite(mcr_dot(c[j], (const double[3]){ 1, 1, 1 })) || !isfinite(transform->t[j]))
            return -2;
        length = mcr_length(c[j]);
        if (length == 0)
            return -1;
        if (length > MCR_EXTENT_LIMIT || length < 1 / MCR_EXTENT_LIMIT)
            return -2;
        most = mcr_max(most, fabs(transform->t[j]));
        mcr_unit(c[j], c[j]);
    }
    if (most > MCR_EXTENT_LIMIT)
        return -2;
    mcr_cross(c[0], c[1], cross);
    det = mcr_dot(cross, c[2]);
    if (fabs(det) <= MCR_SINGULAR)
        return -1;
    transform->mirrored = det < 0;
    return 0;
}

void mcr_transform_point(const struct mcr_transform *transform, const double p[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        double high = transform->t[i], low = transform->low[i];
        for (int k = 0; k < 3; k++)
            accumulate(&high, &low, transform->l[i][k], p[k]);
        out[i] = high;
    }
}

void mcr_transform_vector(const struct mcr_transform *transform, const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = mcr_dot(transform->l[i], v);
}

int mcr_transform_normal(const struct mcr_transform *transform, const double n[3], double out[3])
{
    double level[3], cofactor[3], sum[3], sign = transform->mirrored ? -1 : 1;
    mcr_level(n, level);
    for (int i = 0; i < 3; i++) {
        /* The rows of the cofactor matrix are cross products of the other two rows. */
        mcr_cross(transform->l[(i + 1) % 3], transform->l[(i + 2) % 3], cofactor);
        sum[i] = sign * mcr_dot(cofactor, level);
    }
    return mcr_unit(sum, out);
}

double mcr_transform_similarity(const struct mcr_transform *transform)
{
    double c[3][3], flat[3] = { 0, 0, 0 }, power, mean, limit = (transform->steps + 1) * 16 * MCR_ROUNDING;
    for (int j = 0; j < 3; j++) {
        column(transform, j, c[j]);
        flat[j] = mcr_largest(c[j]);
    }
    power = mcr_power_of_two(mcr_largest(flat));
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            c[j][i] /= power;
    mean = (mcr_dot(c[0], c[0]) + mcr_dot(c[1], c[1]) + mcr_dot(c[2], c[2])) / 3;
    for (int j = 0; j < 3; j++)
        if (fabs(mcr_dot(c[j], c[j]) - mean) > limit * mean || fabs(mcr_dot(c[j], c[(j + 1) % 3])) > limit * mean)
            return 0;
    return power * sqrt(mean);
}

/* Rodrigues' formula; about a coordinate axis the other entries are exactly 0 and 1. */
int mcr_rotation(const double axis[3], double degrees, double l[3][3])
{
    double a[3], c = mcr_cos_degrees(degrees), s = mcr_sin_degrees(degrees);
    if (!mcr_unit(axis, a))
        return 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        l[i][i] = c + a[i] * a[i] * (1 - c);
        if (a[i] * a[i] == 1)
            l[i][i] = 1; /* c + (1 - c) may round */
        l[i][j] = a[i] * a[j] * (1 - c) - a[k] * s;
        l[j][i] = a[i] * a[j] * (1 - c) + a[k] * s;
    }
    return 1;
}

int mcr_lookat(const double from[3], const double to[3], const double up[3], double l[3][3])
{
    double x[3], y[3], z[3], view[3];
    mcr_subtract(to, from, view);
    if (!mcr_unit(view, z) || mcr_sine(up, z, x) <= MCR_PARALLEL)
        return 0;
    mcr_cross(z, x, y);
    mcr_unit(y, y);
    for (int i = 0; i < 3; i++) {
        l[i][0] = x[i];
        l[i][1] = y[i];
        l[i][2] = z[i];
    }
    return 1;
}
