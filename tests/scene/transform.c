/* SPDX-License-Identifier: Apache-2.0 */
/* Transforms: directions of rotation, order, normals, and what far origins cost. */
#include "help.h"

#include "scene/transform.h"
#include "scene/vector.h"

#define U 0x1p-53

static const double zero[3] = { 0, 0, 0 };

static struct mcr_transform start(void)
{
    struct mcr_transform transform;
    mcr_transform_init(&transform, zero);
    return transform;
}

static void identity(double l[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            l[i][j] = i == j;
}

static void translate(struct mcr_transform *transform, double x, double y, double z)
{
    double l[3][3], t[3] = { x, y, z };
    identity(l);
    mcr_transform_then(transform, l, t);
}

static void rotate(struct mcr_transform *transform, double x, double y, double z, double degrees)
{
    double l[3][3], axis[3] = { x, y, z };
    mcr_rotation(axis, degrees, l);
    mcr_transform_then(transform, l, zero);
}

static void scale(struct mcr_transform *transform, double x, double y, double z)
{
    double l[3][3] = { { x, 0, 0 }, { 0, y, 0 }, { 0, 0, z } };
    mcr_transform_then(transform, l, zero);
}

static void rotations(void)
{
    static const double p[3] = { 1, 2, 3 }, axis[3] = { 1, -2, 0.5 };
    const double c = cos(15 * M_PI / 180), s = sin(15 * M_PI / 180);
    struct mcr_transform t = start();
    double out[3], l[3][3], gram = 0;
    rotate(&t, 0, 1, 0, 15);
    mcr_transform_point(&t, p, out);
    ok(near3(out, c + 3 * s, 2, -s + 3 * c, 16 * U), "about y by 15 degrees: x' = x cos + z sin, z' = -x sin + z cos");
    t = start();
    rotate(&t, 0, 0, 1, 90);
    mcr_transform_point(&t, p, out);
    ok(same3(out, -2, 1, 3), "a quarter turn about z is exact: x becomes y");
    t = start();
    rotate(&t, 2, 0, 0, 90);
    mcr_transform_point(&t, p, out);
    ok(same3(out, 1, -3, 2), "a quarter turn about x is exact, whatever the axis' length: y becomes z");
    mcr_rotation(axis, 77, l);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            gram = fmax(gram, fabs(l[0][i] * l[0][j] + l[1][i] * l[1][j] + l[2][i] * l[2][j] - (i == j)));
    ok(gram <= 16 * U, "about any axis: orthonormal to %g", gram);
    t = start();
    rotate(&t, axis[0], axis[1], axis[2], 77);
    mcr_transform_point(&t, axis, out);
    ok(near3(out, axis[0], axis[1], axis[2], 32 * U), "the axis stays");
    ok(!mcr_rotation(zero, 30, l), "a zero axis is refused");
}

/* The order: transform_then composes from the outside to the inside. */
static void order(void)
{
    static const double p[3] = { 1, 0, 0 };
    struct mcr_transform t = start();
    double out[3];
    translate(&t, 10, 0, 0);
    rotate(&t, 0, 0, 1, 90);
    mcr_transform_point(&t, p, out);
    ok(same3(out, 10, 1, 0), "the step composed last acts first");
}

static void far_origins(void)
{
    static const double camera[3] = { 1e8, -1e8, 3e8 }, p[3] = { 0.1, 0.2, 0.3 };
    struct mcr_transform t, plain = start();
    double out[3], expected[3], worst = 0;
    mcr_transform_init(&t, camera);
    translate(&t, 1e8, -1e8, 3e8);
    rotate(&t, 1, 1, 0, 33);
    rotate(&plain, 1, 1, 0, 33);
    mcr_transform_point(&t, p, out);
    mcr_transform_point(&plain, p, expected);
    ok(memcmp(out, expected, sizeof out) == 0, "an offset of camera and scene alike changes no bit");

    /* Turned about a pivot 1e8 away: plain doubles would leave errors of 1e-8. */
    t = start();
    translate(&t, 1e8, 2e8, -1e8);
    rotate(&t, 1, 1, 0, 33);
    translate(&t, -1e8, -2e8, 1e8);
    for (int i = 0; i < 8; i++) {
        const double q[3] = { 1e8 + (i & 1 ? 0.5 : 0.25), 2e8 + (i & 2 ? 0.5 : 0.25), -1e8 + (i & 4 ? 0.5 : 0.25) };
        const double local[3] = { q[0] - 1e8, q[1] - 2e8, q[2] + 1e8 }, back[3] = { -1e8, -2e8, 1e8 };
        mcr_transform_point(&t, q, out);
        mcr_transform_point(&plain, local, expected);
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs(out[k] + back[k] - expected[k]));
    }
    ok(worst <= 2 * 0x1p-26, "turned about a far pivot, errors are the rounding of the result: %g", worst); /* ulp(2e8) = 2^-25,
        half of it each */
    mcr_transform_init(&t, (const double[3]){ 1e8, 2e8, -1e8 });
    translate(&t, 1e8, 2e8, -1e8);
    rotate(&t, 1, 1, 0, 33);
    translate(&t, -1e8, -2e8, 1e8);
    worst = 0;
    for (int i = 0; i < 8; i++) {
        const double q[3] = { 1e8 + (i & 1 ? 0.5 : 0.25), 2e8 + (i & 2 ? 0.5 : 0.25), -1e8 + (i & 4 ? 0.5 : 0.25) };
        const double local[3] = { q[0] - 1e8, q[1] - 2e8, q[2] + 1e8 };
        mcr_transform_point(&t, q, out);
        mcr_transform_point(&plain, local, expected);
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs(out[k] - expected[k]));
    }
    ok(worst <= 4 * U, "seen from there, they are of the size of u: %g", worst);
}

static void normals(void)
{
    static const double n[3] = { 0.6, 0, 0.8 }, a[3] = { 0, 1, 0 }, b[3] = { -0.8, 0, 0.6 };
    struct mcr_transform t = start();
    double out[3], p[3], q[3], up[3], c[3];
    scale(&t, 2, 0.5, -3); /* mirrors */
    rotate(&t, 1, 2, 3, 40);
    ok(mcr_transform_finish(&t) == 0 && t.mirrored, "one negative factor mirrors");
    mcr_transform_normal(&t, n, out);
    mcr_transform_vector(&t, a, p);
    mcr_transform_vector(&t, b, q);
    mcr_transform_vector(&t, n, up);
    ok(fabs(mcr_dot(out, p)) <= 16 * U && fabs(mcr_dot(out, q)) <= 16 * U, "a normal stays perpendicular to its surface");
    ok(mcr_dot(out, up) > 0, "and on the side that its front was on");
    mcr_cross(p, q, c);
    ok(mcr_dot(c, out) < 0, "where the order of edges turns over");
    ok(fabs(mcr_dot(out, out) - 1) <= 4 * U, "and has unit length");
    ok(!mcr_transform_normal(&t, zero, out), "a zero normal is refused");
}

static void similarity(void)
{
    struct mcr_transform t = start();
    ok(mcr_transform_similarity(&t) == 1, "nothing scales by 1");
    scale(&t, 3, 3, 3);
    ok(mcr_transform_similarity(&t) == 3, "a factor comes back exactly");
    scale(&t, -1, 1, 1);
    ok(mcr_transform_similarity(&t) == 3, "mirrored, too");
    for (int i = 0; i < 64; i++)
        rotate(&t, 1 + i % 3, 0.3 * i, -1, 5.7 * i);
    ok(fabs(mcr_transform_similarity(&t) - 3) <= 64 * 16 * U * 3, "after 64 rotations it is one still: %.17g",
       mcr_transform_similarity(&t));
    scale(&t, 1, 1, 1.000001);
    ok(mcr_transform_similarity(&t) == 0, "stretched by a millionth it is not");
    t = start();
    scale(&t, 1e-90, 1e-90, 1e-90);
    ok(mcr_transform_similarity(&t) == 1e-90, "of 1e-90: no underflow");
}

static void limits(void)
{
    double flat[3][3] = { { 1, 2, 3 }, { 4, 5, 6 }, { 7, 8, 9 } }, thin[3][3] = { { 1, 1, 0 }, { 0, 1e-12, 0 }, { 0, 0, 1 } };
    struct mcr_transform t = start();
    mcr_transform_then(&t, flat, zero);
    ok(mcr_transform_finish(&t) == -1, "a matrix of rank 2 is singular");
    t = start();
    mcr_transform_then(&t, thin, zero);
    ok(mcr_transform_finish(&t) == 0, "one that is nearly so is not");
    t = start();
    scale(&t, 1e-30, 1, 1e30);
    ok(mcr_transform_finish(&t) == 0, "scaling by very different factors is not singular");
    t = start();
    scale(&t, 1, 0, 1);
    ok(mcr_transform_finish(&t) == -1, "scaling by 0 is");
    t = start();
    scale(&t, 1e60, 1e60, 1e60);
    scale(&t, 1e60, 1e60, 1e60);
    ok(mcr_transform_finish(&t) == -2, "a product beyond 1e100 is out of range");
    t = start();
    for (int i = 0; i < 8; i++)
        scale(&t, 1e90, 1e90, 1e90);
    ok(mcr_transform_finish(&t) == -2, "and so is one that overflows");
}

static void lookat(void)
{
    static const double from[3] = { 1, 2, 3 }, to[3] = { 1, 2, 8 }, up[3] = { 0, 3, 1 };
    double l[3][3];
    ok(mcr_lookat(from, to, up, l) && l[0][2] == 0 && l[1][2] == 0 && l[2][2] == 1, "lookat turns +z toward the target");
    ok(l[0][1] == 0 && l[1][1] == 1 && l[2][1] == 0, "+y toward up");
    ok(l[0][0] == 1, "+x to the left of one who looks along it: not mirrored");
    ok(!mcr_lookat(from, from, up, l), "the same point twice is refused");
    ok(!mcr_lookat(from, to, (const double[3]){ 0, 0, -2 }, l), "up along the view is refused");
}

int main(void)
{
    rotations();
    order();
    far_origins();
    normals();
    similarity();
    limits();
    lookat();
    return tap_done();
}
