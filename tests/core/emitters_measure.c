/* SPDX-License-Identifier: Apache-2.0 */
/*
 * How exactly solid angles are measured, against the same formulas in long double (64 bits or more): lights of 1e-4 to 1e-12 sr, grazing,
 * with needle corners, points close to edges and corners; spheres of angular radius 1 to 1e-9; disks, and how they are swept. Bounds from
 * "Extremes" of the analytic scenes.
 */
#include "emitters_scene.h"

#include <float.h>

#include "core/emitter_disk.h"
#include "core/emitter_round.h"

static long double dot_l(const long double a[3], const long double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Half the solid angle of the triangle a, b, c seen from 0; `triple` is known better than a.(b x c). */
static long double half_angle(const long double a[3], const long double b[3], const long double c[3], long double triple)
{
    long double la = sqrtl(dot_l(a, a)), lb = sqrtl(dot_l(b, b)), lc = sqrtl(dot_l(c, c));
    return atan2l(fabsl(triple), la * lb * lc + dot_l(a, b) * lc + dot_l(b, c) * la + dot_l(c, a) * lb);
}

/* A light, the point 0, and the facts about it that bound the error. */
struct sight {
    double c[3], e0[3], e1[3];
    long double half;
    double cosine; /* least cosine at the light's vertices */
    double sine;   /* of its corners */
};

static void sight_measure(uint32_t kind, struct sight *s)
{
    long double v[4][3], n[3], triple = 0, farthest = 0, length = 0;
    int count = kind == MCR_EMITTER_TRIANGLE ? 3 : 4;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = (long double)s->e0[j] * s->e1[k] - (long double)s->e0[k] * s->e1[j];
        triple += n[i] * s->c[i];
        length += n[i] * n[i];
        v[0][i] = s->c[i];
        v[1][i] = v[0][i] + s->e0[i];
        v[2][i] = kind == MCR_EMITTER_TRIANGLE ? v[0][i] + s->e1[i] : v[1][i] + s->e1[i];
        v[3][i] = v[0][i] + s->e1[i];
    }
    for (int i = 0; i < count; i++)
        farthest = fmaxl(farthest, dot_l(v[i], v[i]));
    s->half = half_angle(v[0], v[1], v[2], triple);
    if (count == 4)
        s->half += half_angle(v[0], v[2], v[3], triple);
    s->cosine = (double)(fabsl(triple) / sqrtl(length * farthest));
    long double l0 = 0, l1 = 0;
    for (int i = 0; i < 3; i++) {
        l0 += (long double)s->e0[i] * s->e0[i];
        l1 += (long double)s->e1[i] * s->e1[i];
    }
    s->sine = (double)sqrtl(length / (l0 * l1));
}

static double number(uint64_t key, uint64_t dimension)
{
    return mcr_number(mcr_mix64(key), dimension);
}

static void unit(uint64_t key, uint64_t dimension, double out[3])
{
    double z = 2 * number(key, dimension) - 1, angle = 2 * MCR_PI * number(key, dimension + 1), rho = sqrt(1 - z * z);
    out[0] = rho * cos(angle);
    out[1] = rho * sin(angle);
    out[2] = z;
}

/* The program's measure of it, through its table of emitters. */
static struct fan measured(struct stage *s, uint32_t kind, const struct sight *sight)
{
    stage_begin(s);
    if (kind == MCR_EMITTER_TRIANGLE) {
        double b[3], c[3];
        for (int i = 0; i < 3; i++) {
            b[i] = sight->c[i] + sight->e0[i];
            c[i] = sight->c[i] + sight->e1[i];
        }
        stage_triangle(s, FRONT | BACK, 1, sight->c, b, c);
    } else {
        stage_flat(s, MCR_SHAPE_PARALLELOGRAM, FRONT | BACK, 1, sight->c, sight->e0, sight->e1);
    }
    stage_ready(s);
    struct flat flat = flat_load(s->emitters->k[0], 1);
    struct fan fan = kind == MCR_EMITTER_TRIANGLE ? fan_measure(MCR_EMITTER_TRIANGLE, &flat, 0, 0, 0)
                                                  : fan_measure(MCR_EMITTER_PARALLELOGRAM, &flat, 0, 0, 0);
    stage_end(s);
    return fan;
}

/* Edges as they are stored: triangles are given by vertices, whose differences are rounded. */
static void settle(uint32_t kind, struct sight *s)
{
    for (int i = 0; i < 3 && kind == MCR_EMITTER_TRIANGLE; i++) {
        volatile double b = s->c[i] + s->e0[i], c = s->c[i] + s->e1[i];
        s->e0[i] = b - s->c[i];
        s->e1[i] = c - s->c[i];
    }
}

/* A light of about `target` sr in a random direction at distance 1, turned and skewed at random. */
static void random_sight(uint32_t kind, uint64_t key, double target, struct sight *s)
{
    double way[3], other[3], size = sqrt(target);
    unit(key, 0, way);
    unit(key, 2, s->e0);
    unit(key, 4, other);
    for (int i = 0; i < 3; i++) {
        s->c[i] = way[i];
        s->e0[i] *= size;
        s->e1[i] = size * other[i];
    }
    settle(kind, s);
    sight_measure(kind, s);
}

static void test_small(uint32_t kind, const char *name)
{
    static struct stage stage;
    for (int power = 2; power <= 12; power += 2) {
        double worst = 0, worst_scaled = 0, sum = 0;
        uint32_t count = 0, wrong = 0;
        for (uint64_t key = 0; key < 20000; key++) {
            struct sight s;
            random_sight(kind, key * 100 + (uint64_t)power, pow(10, -power), &s);
            if (!(s.cosine > 1e-4) || !(s.sine > 1e-4))
                continue;
            struct fan f = measured(&stage, kind, &s);
            double error = fabs((double)(f.half / s.half - 1));
            worst_scaled = fmax(worst_scaled, error * s.cosine * s.sine);
            if (s.cosine < 0.1 || s.sine < 0.1)
                continue;
            worst = fmax(worst, error);
            sum += error;
            count++;
            wrong += f.steady != (s.half > STEADY_HALF_ANGLE);
        }
        ok(worst <= 1e-14, "%s of 1e-%d sr, cosine and sine above .1: error %.1e, mean %.1e", name, power, worst, sum / count);
        ok(worst_scaled <= 1e-14, "%s of 1e-%d sr, any: error times cosine and sine %.1e", name, power, worst_scaled);
        ok(wrong == 0, "%s of 1e-%d sr: by area below 1e-8 sr, by solid angle above", name, power);
    }
}

/*
 * Points at all heights over the plane of a light of size 1, over it, beside it, close to its edges and corners: what is called steady is.
 */
static void test_close(uint32_t kind, const char *name)
{
    static struct stage stage;
    double worst = 0;
    uint32_t steady = 0, total = 60000;
    for (uint64_t key = 0; key < total; key++) {
        struct sight s = {.half = 0};
        double way[3], height = pow(10, -7 * number(key, 10)), a, b, slant = 0.9 * (2 * number(key, 13) - 1);
        unit(key, 0, way);
        double n[3] = {-way[1], way[2], way[0]}, u[3], v[3];
        cross_product(way, n, u);
        double length = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
        for (int i = 0; i < 3; i++)
            u[i] /= length;
        cross_product(way, u, v);
        /* the foot of the point in the light's coordinates: anywhere, or a hair from an edge or a corner */
        a = 3 * number(key, 11) - 1;
        b = 3 * number(key, 12) - 1;
        if (key % 3 > 0)
            a = (a > 0.5 ? 1 : 0) + (number(key, 14) - 0.5) * pow(10, -9 * number(key, 15));
        if (key % 3 > 1)
            b = (b > 0.5 ? 1 : 0) + (number(key, 16) - 0.5) * pow(10, -9 * number(key, 17));
        for (int i = 0; i < 3; i++) {
            s.e0[i] = u[i];
            s.e1[i] = v[i] + slant * u[i];
            s.c[i] = height * way[i] - a * s.e0[i] - b * s.e1[i];
        }
        settle(kind, &s);
        sight_measure(kind, &s);
        struct fan f = measured(&stage, kind, &s);
        if (!f.steady)
            continue;
        steady++;
        worst = fmax(worst, fabs((double)(f.half / s.half - 1)));
    }
    ok(worst <= 1e-10, "%s close by: error of what is called steady %.1e (%u of %u)", name, worst, steady, total);
    ok(steady > total / 3, "%s close by: most is steady", name);
}

static void test_sphere(void)
{
    for (int power = 0; power <= 9; power++) {
        double worst = 0, radius = pow(10, -power) * 0.9;
        for (uint64_t key = 0; key < 2000; key++) {
            double way[3], distance = 1 + number(key, 20);
            unit(key, 0, way);
            double c[3] = {way[0] * distance, way[1] * distance, way[2] * distance}, r = radius * (1 + 0.1 * number(key, 21));
            long double square = (long double)c[0] * c[0] + (long double)c[1] * c[1] + (long double)c[2] * c[2];
            long double sine = (long double)r * r / square;
            long double open = sine / (1 + sqrtl(1 - sine)), known = 1 / (2 * 3.14159265358979323846264338327950288L * open);
            double k[MCR_K_SIZE] = {c[0], c[1], c[2]};
            k[MCR_K_RADIUS] = r, k[MCR_K_SQUARE] = r * r, k[MCR_K_INVERSE] = 1 / (2 * MCR_PI * r * r);
            k[MCR_K_ABOVE] = 0, k[MCR_K_BELOW] = -INFINITY;
            struct ball s = ball_load(k, 1);
            struct drawn d = ball_draw_solid(&s, 0, 0, 0, 0.5, 0.5);
            if (square > (long double)r * r * 1.01L)
                worst = fmax(worst, fabs((double)(d.density / known - 1)));
        }
        ok(worst <= 1e-14, "sphere of angular radius 1e-%d: error %.1e", power, worst);
    }
}

/* The solid angle of a disk at c seen from 0 by the sweep around its centre, with 2^13 nodes; no principal frame is involved. */
static long double disk_angle(const double c[3], const double e0[3], const double e1[3])
{
    const uint32_t nodes = 1u << 13;
    long double square = 0, triple = 0, sum = 0, distance;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        square += (long double)c[i] * c[i];
        triple += c[i] * ((long double)e0[j] * e1[k] - (long double)e0[k] * e1[j]);
    }
    distance = sqrtl(square);
    for (uint32_t n = 0; n < nodes; n++) {
        long double angle = 2 * 3.14159265358979323846264338327950288L * n / nodes, x = cosl(angle), y = sinl(angle), along = 0, length = 0;
        for (int i = 0; i < 3; i++) {
            long double v = c[i] + x * e0[i] + y * e1[i];
            length += v * v;
            along += v * c[i];
        }
        length = sqrtl(length);
        sum += 1 / (length * (length + along / distance));
    }
    return fabsl(triple) / distance * sum * 2 * 3.14159265358979323846264338327950288L / nodes;
}

/* The sweep from 0 to `turn` of a cone with semi-axes a, b: Simpson's rule on 1000 parts. */
static long double swept(long double aa, long double bb, long double turn)
{
    const int parts = 1000;
    long double sum = 0;
    for (int n = 0; n <= 2 * parts; n++) {
        long double x = cosl(turn * n / (2 * parts)), y = sinl(turn * n / (2 * parts)), square = 1 + aa * x * x + bb * y * y;
        sum += (n == 0 || n == 2 * parts ? 1 : n % 2 ? 4 : 2) * sqrtl(aa * bb) / (square + sqrtl(square));
    }
    return sum * turn / (6 * parts);
}

/*
 * Disks far and near, round and thin: the solid angle against a quadrature; and for drawn directions, the part of the solid angle that the
 * sweep has passed at theirs against the number they were drawn with, and 1 - cos within the sector.
 */
static void test_disk(void)
{
    struct stage s;
    struct batch b;
    double worst = 0, worst_far = 0, worst_turn = 0, worst_out = 0;
    uint32_t kinds[4] = {0};
    batch_begin(&b, 8);
    for (uint64_t key = 0; key < 800; key++) {
        double way[3], size = pow(10, -4 * number(key, 20)), thin = pow(10, -1.5 * number(key, 21)), e0[3], e1[3], c[3];
        unit(key, 0, way);
        unit(key, 2, e0);
        unit(key, 4, e1);
        for (int i = 0; i < 3; i++) {
            c[i] = way[i];
            e0[i] *= 1.5 * size;
            e1[i] *= 1.5 * size * thin;
        }
        stage_begin(&s);
        stage_flat(&s, MCR_SHAPE_DISK, FRONT | BACK, 1, c, e0, e1);
        stage_ready(&s);
        struct flat flat = flat_load(s.emitters->k[0], 1);
        struct disk_cone cone = disk_cone(&flat, 0, 0, 0);
        kinds[cone.nodes == 8 ? 0 : cone.nodes == 16 ? 1 : cone.nodes == 32 ? 2 : 3]++;
        if (cone.nodes > 0) {
            const double origin[3] = {0};
            batch_at(&b, origin);
            batch_numbers(&b, key);
            batch_draw(&b, &s, best_functions(), MCR_LIGHT_BY_SOLID_ANGLE);
            long double known = disk_angle(c, e0, e1), whole = swept(cone.aa, cone.bb, MCR_PI);
            double error = fabs((double)(b.density[0] * known - 1));
            worst = fmax(worst, error);
            worst_far = fmax(worst_far, size < 0.3 ? error : 0);
            for (uint32_t i = 0; i < b.n && key % 4 == 0; i++) {
                double x = (b.x[i] * cone.ax + b.y[i] * cone.ay + b.z[i] * cone.az) / cone.aa;
                double y = (b.x[i] * cone.bx + b.y[i] * cone.by + b.z[i] * cone.bz) / cone.bb,
                       z = b.x[i] * cone.zx + b.y[i] * cone.zy + b.z[i] * cone.zz;
                double turn = atan2(y, x), radius = cone.aa * x * x + cone.bb * y * y, sink = radius / (1 + z);
                turn = turn < 0 ? turn + 2 * MCR_PI : turn;
                double edge = cone.aa * cos(turn) * cos(turn) + cone.bb * sin(turn) * sin(turn), open = edge / (1 + edge + sqrt(1 + edge));
                double place = (double)(swept(cone.aa, cone.bb, turn) / (2 * whole));
                worst_turn = fmax(worst_turn, fmin(fabs(place - b.u[1][i]), 1 - fabs(place - b.u[1][i])));
                worst_out = fmax(worst_out, fabs(sink / open - b.u[2][i]));
            }
        }
        stage_end(&s);
    }
    batch_end(&b);
    ok(worst <= 1e-10, "disks: error of the solid angle %.1e, of those that fill less than a sixth of the view %.1e", worst, worst_far);
    /* the series ends at 5e-11; a direction's rounding over the size of the light, 1e-16 / 1e-4, and over its thinness is less */
    ok(worst_turn <= 1e-10, "disks: swept by solid angle, to %.1e of it", worst_turn);
    ok(worst_out <= 1e-10, "disks: uniform along the sector, to %.1e", worst_out);
    ok(kinds[0] > 20 && kinds[1] > 10 && kinds[2] > 10 && kinds[3] > 10, "disks of 8, 16, 32 nodes and by area: %u, %u, %u, %u", kinds[0],
       kinds[1], kinds[2],
       kinds[3]);
}

int main(void)
{
    if (LDBL_MANT_DIG <= DBL_MANT_DIG) {
        printf("1..0 # SKIP long double has no more digits than double here\n");
        return 0;
    }
    test_small(MCR_EMITTER_PARALLELOGRAM, "parallelogram");
    test_small(MCR_EMITTER_TRIANGLE, "triangle");
    test_close(MCR_EMITTER_PARALLELOGRAM, "parallelogram");
    test_close(MCR_EMITTER_TRIANGLE, "triangle");
    test_sphere();
    test_disk();
    return tap_done();
}
