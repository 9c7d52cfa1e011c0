/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Spheres at the extremes, against the same rays in 113 bits: small ones far away, whose discriminant cancels in the textbook's formula (a third
 * of the decisions is wrong at 1e8 radii), and enormous ones as walls, where the hit must lie on the sphere to 4 u R.
 */
#include "scene.h"

#define RAYS 100000u

#ifdef __SIZEOF_FLOAT128__
typedef __float128 quad;
#else
typedef long double quad; /* 113 bits where there is no __float128 */
#endif

static quad dot(const quad a[3], const quad b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Whether ray i crosses the sphere of radius r around c ahead of its origin, from outside: r^2 |d|^2 >= |f x d|^2. */
static int crosses(const struct bundle *b, uint32_t i, const double c[3], double r)
{
    quad f[3], d[3], n[3];
    for (int j = 0; j < 3; j++) {
        f[j] = (quad)b->o[j][i] - c[j];
        d[j] = b->d[j][i];
    }
    for (int j = 0; j < 3; j++)
        n[j] = f[(j + 1) % 3] * d[(j + 2) % 3] - f[(j + 2) % 3] * d[(j + 1) % 3];
    return (quad)r * r * dot(d, d) >= dot(n, n) && dot(f, d) < 0;
}

/* The distance of o + t d from the sphere, without a square root in 113 bits: (|q|^2 - R^2) / (|q| + R). */
static double off_surface(const struct bundle *b, uint32_t i, const double c[3], double r)
{
    quad q[3];
    for (int j = 0; j < 3; j++)
        q[j] = (quad)b->o[j][i] + (quad)b->t[i] * b->d[j][i] - c[j];
    quad square = dot(q, q);
    return fabs((double)(square - (quad)r * r) / (sqrt((double)square) + r));
}

/* Rays from around the origin at a sphere of radius 1 at `distance`, half of them within a fifth of its rim. */
static void test_far(double distance)
{
    struct stage *s = stage_create();
    struct bundle b = bundle_create(RAYS);
    double c[3], frame[3][3];
    random_frame(frame);
    for (int j = 0; j < 3; j++)
        c[j] = distance * frame[0][j];
    stage_sphere(s, c, 1);
    stage_ready(s);
    for (uint32_t i = 0; i < RAYS; i++) {
        double o[3] = {between(-1, 1), between(-1, 1), between(-1, 1)}, to[3];
        double angle = between(0, 2 * MCR_PI), radius = i % 2 ? between(0.8, 1.2) : between(0, 1.5);
        for (int j = 0; j < 3; j++)
            to[j] = c[j] + radius * (cos(angle) * frame[1][j] + sin(angle) * frame[2][j]);
        bundle_aim(&b, i, o, to);
    }
    uint32_t hits = 0;
    for (uint32_t kind = 0; kind < 2; kind++)
        for (uint32_t isa = 0; functions_of(isa, kind) && isa < 3; isa++) {
            uint32_t wrong = 0;
            bundle_trace(&b, s, isa, kind);
            hits = 0;
            for (uint32_t i = 0; i < RAYS; i++) {
                int hit = b.primitive[i] == 0;
                hits += hit;
                wrong += hit != crosses(&b, i, c, 1) || (hit && fabs(b.t[i] - distance) > 3);
            }
            ok(wrong == 0 && hits > RAYS / 3 && hits < RAYS / 3 * 2, "radius 1 at %g, %s, instruction set %u: %u of %u rays wrong (%u hit)",
               distance, accel_name[kind], isa, wrong, RAYS, hits);
        }
    bundle_destroy(&b);
    stage_destroy(s);
}

/* A wall of radius R that passes within 1 of the origin, seen from a unit room from outside and from inside. */
static void test_wall(double radius, int inside)
{
    struct stage *s = stage_create();
    struct bundle b = bundle_create(RAYS);
    double c[3], frame[3][3];
    random_frame(frame);
    for (int j = 0; j < 3; j++)
        c[j] = (inside ? radius - 0.7 : radius + 0.7) * frame[0][j];
    stage_sphere(s, c, radius);
    stage_ready(s);
    for (uint32_t i = 0; i < RAYS; i++) {
        double o[3], to[3], u = between(-1, 1), v = between(-1, 1), w = between(-0.5, 0.5);
        for (int j = 0; j < 3; j++) {
            o[j] = between(-0.3, 0.3);
            to[j] = (inside ? -0.7 : 0.7) * frame[0][j] + u * frame[1][j] + v * frame[2][j] + 0.1 * w * frame[0][j];
        }
        bundle_aim(&b, i, o, to);
    }
    for (uint32_t kind = 0; kind < 2; kind++) {
        double worst = 0;
        uint32_t missed = 0;
        bundle_trace(&b, s, best_isa(), kind);
        for (uint32_t i = 0; i < RAYS; i++) {
            missed += b.primitive[i] != 0;
            worst = b.primitive[i] == 0 ? fmax(worst, off_surface(&b, i, c, radius)) : worst;
        }
        ok(!missed && worst <= 4 * UNIT_ROUNDING * radius, "wall R = %g from %s, %s: %.2g u R off the surface at most, %u missed", radius,
           inside ? "inside" : "outside", accel_name[kind], worst / (UNIT_ROUNDING * radius), missed);
    }
    bundle_destroy(&b);
    stage_destroy(s);
}

int main(void)
{
    for (double distance = 1e2; distance < 2e8; distance *= 100)
        test_far(distance);
    for (double radius = 1e5; radius < 2e8; radius *= 10) {
        test_wall(radius, 0);
        test_wall(radius, 1);
    }
    return tap_done();
}
