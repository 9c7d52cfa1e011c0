/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Closed meshes seen from inside: a ray that leaves is a crack. Rays are aimed at edges and vertices that triangles share (the textbook's test misses one in
 * eight of these), at meshes of all sizes and places and at needles of 1e6 : 1.
 */
#include "scene.h"

/* An octahedron whose edges are halved `times` times; vertices at a random distance from its centre, which stays inside. */
struct mesher {
    struct stage *s;
    uint32_t (*half)[3]; /* edges that were halved: ends and middle */
    uint32_t halves;
    double c[3], size;
};

static uint32_t middle(struct mesher *m, uint32_t a, uint32_t b)
{
    double p[3], *coordinate[3] = {m->s->x, m->s->y, m->s->z};
    uint32_t low = a < b ? a : b, high = a < b ? b : a;
    for (uint32_t i = 0; i < m->halves; i++)
        if (m->half[i][0] == low && m->half[i][1] == high)
            return m->half[i][2];
    for (int j = 0; j < 3; j++)
        p[j] = (coordinate[j][a] - m->c[j]) / m->size + (coordinate[j][b] - m->c[j]) / m->size;
    normalise(p);
    double distance = m->size * between(0.8, 1.2);
    for (int j = 0; j < 3; j++)
        p[j] = m->c[j] + distance * p[j];
    uint32_t *half = m->half[m->halves++];
    half[0] = low;
    half[1] = high;
    return half[2] = stage_vertex(m->s, p);
}

static void divide(struct mesher *m, uint32_t a, uint32_t b, uint32_t c, int times)
{
    if (!times) {
        stage_triangle(m->s, a, b, c);
        return;
    }
    uint32_t ab = middle(m, a, b), bc = middle(m, b, c), ca = middle(m, c, a);
    divide(m, a, ab, ca, times - 1);
    divide(m, ab, b, bc, times - 1);
    divide(m, ca, bc, c, times - 1);
    divide(m, ab, bc, ca, times - 1);
}

static struct stage *ball(const double c[3], double size, int times)
{
    static const uint32_t face[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    struct mesher m = {.s = stage_create(), .half = malloc(sizeof *m.half * MOST_TRIANGLES), .c = {c[0], c[1], c[2]}, .size = size};
    double frame[3][3];
    random_frame(frame);
    for (int i = 0; i < 6; i++) {
        double p[3];
        for (int j = 0; j < 3; j++)
            p[j] = c[j] + (i % 2 ? -size : size) * frame[i / 2][j];
        stage_vertex(m.s, p);
    }
    for (int f = 0; f < 8; f++)
        divide(&m, face[f][0], face[f][1], face[f][2], times);
    free(m.half);
    stage_ready(m.s);
    return m.s;
}

/* Rays from near `from` (within `wide`) at random points of random edges, every eighth at a vertex. */
static void aim_at_edges(struct bundle *b, const struct stage *s, const double from[3], double wide)
{
    const double *coordinate[3] = {s->x, s->y, s->z};
    for (uint32_t i = 0; i < b->n; i++) {
        const uint32_t *v = s->vertex[(uint32_t)(number() * s->scene.triangles.count)];
        uint32_t e = (uint32_t)(3 * number()), a = v[e], z = v[(e + 1) % 3];
        double o[3], to[3], part = i % 8 ? number() : 0;
        for (int j = 0; j < 3; j++) {
            o[j] = from[j] + between(-wide, wide);
            to[j] = coordinate[j][a] + part * (coordinate[j][z] - coordinate[j][a]);
        }
        bundle_aim(b, i, o, to);
    }
}

static void count_misses(const char *what, const struct stage *s, struct bundle *b, int list)
{
    for (uint32_t kind = list ? 0 : 1; kind < 2; kind++) {
        uint32_t missed = 0;
        bundle_trace(b, s, best_isa(), kind);
        for (uint32_t i = 0; i < b->n; i++)
            missed += b->primitive[i] < 0;
        ok(missed == 0, "%s, %u triangles, %s: %u of %u rays at its edges missed", what, s->scene.triangles.count, accel_name[kind], missed, b->n);
    }
}

static void test_ball(const char *what, double x, double size, int times, uint32_t rays)
{
    double c[3] = {x, -0.7 * x, 0.3 * x};
    struct stage *s = ball(c, size, times);
    struct bundle b = bundle_create(rays);
    aim_at_edges(&b, s, c, 0.2 * size);
    count_misses(what, s, &b, times < 3);
    bundle_destroy(&b);
    stage_destroy(s);
}

/* A tube of 64 strips of two needles each, 1e6 times as long as wide, with a fan at each end; seen from places all along its axis. */
static void test_needles(void)
{
    enum { SIDES = 64 };
    struct stage *s = stage_create();
    struct bundle b = bundle_create(200000);
    double frame[3][3], length = 1e6 * 2 * MCR_PI / SIDES;
    uint32_t end[2], rim[2][SIDES];
    random_frame(frame);
    for (int e = 0; e < 2; e++) {
        double p[3];
        for (int j = 0; j < 3; j++)
            p[j] = (e - 0.5) * length * frame[0][j];
        end[e] = stage_vertex(s, p);
        for (int i = 0; i < SIDES; i++) {
            double angle = 2 * MCR_PI * i / SIDES;
            for (int j = 0; j < 3; j++)
                p[j] = (e - 0.5) * length * frame[0][j] + cos(angle) * frame[1][j] + sin(angle) * frame[2][j];
            rim[e][i] = stage_vertex(s, p);
        }
    }
    for (int i = 0; i < SIDES; i++) {
        int k = (i + 1) % SIDES;
        stage_triangle(s, rim[0][i], rim[0][k], rim[1][i]);
        stage_triangle(s, rim[0][k], rim[1][k], rim[1][i]);
        stage_triangle(s, end[0], rim[0][k], rim[0][i]);
        stage_triangle(s, end[1], rim[1][i], rim[1][k]);
    }
    stage_ready(s);
    aim_at_edges(&b, s, (const double[3]){0, 0, 0}, 0.5);
    count_misses("tube of needles, from its middle", s, &b, 1);
    for (uint32_t i = 0; i < b.n; i++) {
        double o[3], d[3], to[3], along = between(-0.49, 0.49) * length;
        random_direction(d);
        for (int j = 0; j < 3; j++) {
            o[j] = along * frame[0][j] + 0.3 * frame[1][j];
            to[j] = o[j] + d[j];
        }
        bundle_aim(&b, i, o, to);
    }
    count_misses("tube of needles, all along it", s, &b, 1);
    bundle_destroy(&b);
    stage_destroy(s);
}

int main(void)
{
    test_ball("ball", 0, 1, 2, 1000000);
    test_ball("ball", 0, 1, 5, 1000000);
    test_ball("tiny ball", 0, 1e-9, 2, 100000);
    test_ball("ball 1e4 radii from the origin", 1e4, 1, 2, 100000);
    test_ball("ball 1e8 radii from the origin", 1e8, 1, 2, 100000);
    test_ball("flat octahedron", 0, 1, 0, 100000);
    test_needles();
    return tap_done();
}
