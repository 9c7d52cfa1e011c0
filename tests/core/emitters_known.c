/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Known answers by light sampling alone: form factors S2 to S6 and S20 of the analytic scenes, by area and by solid angle, as directions
 * and as points; and the variance of one sample in S16 and S17. L = 1, the receiver looks along +z.
 */
#include "emitters_scene.h"

#define LANES 4096u
#define PI MCR_PI

/* A receiver under a scene: cosine times visible radiance over pi and density, that is the form factor, sample by sample. */
static void estimate(const struct stage *s, uint32_t by, int points, const double p[3], const double normal[3], uint32_t rounds,
                     struct mean *mean)
{
    const struct mcr_emitter_functions *f = best_functions();
    struct batch b;
    double *q[4];
    int32_t *emitter = aligned_alloc(64, LANES * sizeof *emitter);
    batch_begin(&b, LANES);
    batch_at(&b, p);
    for (int k = 0; k < 4; k++)
        q[k] = doubles(LANES);
    for (uint32_t round = 0; round < rounds; round++) {
        struct mcr_emitter_points out = {sizeof out, LANES, emitter, q[0], q[1], q[2], b.x, b.y, b.z, q[3]};
        batch_numbers(&b, 40000 + round + (uint64_t)mean->count);
        if (points)
            f->draw_point(s->emitters, s->scratch, by, &b.at, (const double *const *)b.u, &out, b.density);
        else
            batch_draw(&b, s, f, by);
        for (uint32_t i = 0; i < LANES; i++) {
            double cosine = b.x[i] * normal[0] + b.y[i] * normal[1] + b.z[i] * normal[2], value = 0;
            if (cosine > 0 && b.density[i] > 0)
                value = cosine / (PI * b.density[i]);
            if (points && value > 0 && s->shape[0].kind == MCR_SHAPE_SPHERE && s->scene.shape_count) {
                /* a point on the far half of a sphere is hidden by the sphere */
                const double *c = s->shape[0].c;
                if ((q[0][i] - c[0]) * b.x[i] + (q[1][i] - c[1]) * b.y[i] + (q[2][i] - c[2]) * b.z[i] > 0)
                    value = 0;
            }
            mean_add(mean, value);
        }
    }
    for (int k = 0; k < 4; k++)
        free(q[k]);
    free(emitter);
    batch_end(&b);
}

static void check(const struct stage *s, const char *name, const double p[3], double degrees, double known)
{
    double normal[3] = {sin(degrees * PI / 180), 0, cos(degrees * PI / 180)};
    for (uint32_t by = 0; by <= 1; by++)
        for (int points = 0; points <= 1; points++) {
            struct mean mean = {0};
            do /* until the standard error is below 0.2 % */
                estimate(s, by, points, p, normal, 100, &mean);
            while (mean.count < 2e7 && !(mean_error(&mean) < 0.002 * known));
            double error = mean_error(&mean), z = (mean_value(&mean) - known) / fmax(error, 1e-14 * known);
            ok(fabs(z) <= 4 && error < 0.002 * known, "%s by %s%s: %.10g, known %.10g, z = %.2f", name, by ? "solid angle" : "area",
               points ? ", points" : "", mean_value(&mean), known, z);
        }
}

static const double origin[3];

/* A rectangle parallel to the receiver that faces down, its middle over (x, y). */
static void rectangle(struct stage *s, double x, double y, double side, double h)
{
    const double c[3] = {x - side / 2, y - side / 2, h}, e0[3] = {0, side, 0}, e1[3] = {side, 0, 0};
    stage_begin(s);
    stage_flat(s, MCR_SHAPE_PARALLELOGRAM, FRONT, 1, c, e0, e1);
    stage_ready(s);
}

static void disk(struct stage *s, double x, double radius, double h)
{
    const double c[3] = {x, 0, h}, e0[3] = {0, radius, 0}, e1[3] = {radius, 0, 0};
    stage_begin(s);
    stage_flat(s, MCR_SHAPE_DISK, FRONT, 1, c, e0, e1);
    stage_ready(s);
}

static void test_flat(void)
{
    struct stage s;
    rectangle(&s, 0, 0, 2, 1);
    check(&s, "S2 centred", origin, 0, 0.55412642397957);
    stage_end(&s);
    rectangle(&s, -1.5, -0.5, 2, 1);
    check(&s, "S2 at (1.5, .5)", origin, 0, 0.14748482740113);
    stage_end(&s);
    rectangle(&s, 0, 0, 0.01, 1);
    check(&s, "S2 of size .01", origin, 0, 3.182992762256e-5);
    stage_end(&s);
    stage_begin(&s);
    stage_flat(&s, MCR_SHAPE_PARALLELOGRAM, FRONT, 1, (const double[3]){1, 0, 0}, (const double[3]){0, 0, 1}, (const double[3]){0, 1, 0});
    stage_ready(&s);
    check(&s, "S3", origin, 0, 0.055734197002554);
    stage_end(&s);
    disk(&s, 0, 1, 1);
    check(&s, "S4 coaxial", origin, 0, 0.5);
    stage_end(&s);
    disk(&s, 1.5, 1, 1);
    check(&s, "S4 off axis", origin, 0, 0.12629534065817);
    stage_end(&s);
    disk(&s, 0, 0.5, 2);
    check(&s, "S4 smaller", origin, 0, 0.058823529411765);
    stage_end(&s);
    stage_begin(&s);
    stage_triangle(&s, BACK, 1, (const double[3]){0, 0, 2}, (const double[3]){1, 0, 2}, (const double[3]){0, 1, 3});
    stage_ready(&s);
    check(&s, "S20", origin, 0, 0.023717994556414);
    stage_end(&s);
}

/* The sphere stands at distance d along x after a turn of the receiver's normal; see S5 and S6. */
static void test_spheres(void)
{
    static const double known[][4] = {/* r, d, angle, answer */
                                      {0.5, 2, 0, 0.0625},
                                      {0.5, 2, 60, 0.03125},
                                      {1, 2, 80, 0.054695816445537},
                                      {1, 2, 90, 0.028834442811219},
                                      {1, 2, 110, 0.0021495675176078}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        struct stage s;
        char name[40];
        stage_begin(&s);
        stage_sphere(&s, FRONT, 1, (const double[3]){0, 0, known[i][1]}, known[i][0]);
        stage_ready(&s);
        snprintf(name, sizeof name, "S%d, %g degrees", i < 2 ? 5 : 6, known[i][2]);
        check(&s, name, origin, known[i][2], known[i][3]);
        stage_end(&s);
    }
}

/* A light of 2x2 at h = .01: by area the variance is boundless in practice, by solid angle it is small. */
static void test_nose(void)
{
    struct stage s;
    struct mean mean = {0};
    rectangle(&s, 0, 0, 2, 0.01);
    estimate(&s, MCR_LIGHT_BY_SOLID_ANGLE, 0, origin, (const double[3]){0, 0, 1}, 100, &mean);
    double z = (mean_value(&mean) - 0.99991817594388) / mean_error(&mean);
    ok(fabs(z) <= 4 && mean_error(&mean) < 0.002, "S2 at h = .01 by solid angle: z = %.2f", z);
    stage_end(&s);
}

/* Variance of one sample of rho F with rho = .5, whose mean is .5 R^2 / (R^2 + 1); and of the mixture with the cosine sampler. */
static void variance(const struct stage *s, uint32_t by, double radius, double alone, double mixed)
{
    const struct mcr_emitter_functions *f = best_functions();
    struct batch b;
    struct mean one = {0}, two = {0};
    batch_begin(&b, LANES);
    batch_at(&b, origin);
    for (uint32_t round = 0; round < 250; round++) {
        batch_numbers(&b, 90000 + round);
        batch_draw(&b, s, f, by);
        for (uint32_t i = 0; i < LANES; i++)
            mean_add(&one, 0.5 / PI * b.z[i] / b.density[i]);
        for (uint32_t i = 0; i < LANES; i++) /* every other lane by cosine */
            if (i % 2) {
                double height = sqrt(mcr_disk_from_square(b.u[1][i], b.u[2][i], &b.x[i], &b.y[i]));
                b.z[i] = height;
            }
        batch_density(&b, s, f, by, b.density);
        for (uint32_t i = 0; i < LANES; i++) {
            double radiance = b.x[i] * b.x[i] + b.y[i] * b.y[i] <= radius * radius * b.z[i] * b.z[i] ? 1 : 0;
            mean_add(&two, radiance * 0.5 / PI * b.z[i] / (0.5 * b.density[i] + 0.5 * b.z[i] / PI));
        }
    }
    ok(fabs(mean_variance(&one) / alone - 1) < 0.05, "R = %g by %s: variance %.6g, known %.6g", radius, by ? "solid angle" : "area",
       mean_variance(&one), alone);
    ok(fabs(mean_variance(&two) / mixed - 1) < 0.05, "R = %g by %s with cosine: variance %.6g, known %.6g", radius,
       by ? "solid angle" : "area",
       mean_variance(&two), mixed);
    batch_end(&b);
}

static void test_variance(void)
{
    struct stage s;
    disk(&s, 0, 1, 1);
    variance(&s, MCR_LIGHT_BY_AREA, 1, 0.010416666666667, 0.026624722801679);
    variance(&s, MCR_LIGHT_BY_SOLID_ANGLE, 1, 0.0006132760733929, 0.021197471073498);
    stage_end(&s);
    disk(&s, 0, 0.1, 1);
    variance(&s, MCR_LIGHT_BY_AREA, 0.1, 8.0882512e-10, 2.402843449237e-5);
    variance(&s, MCR_LIGHT_BY_SOLID_ANGLE, 0.1, 5.0550944576e-11, 2.4026962113e-5);
    stage_end(&s);
}

int main(void)
{
    test_flat();
    test_spheres();
    test_nose();
    test_variance();
    return tap_done();
}
