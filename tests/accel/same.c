/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The list and the tree, in every instruction set, give the same bits: for hundreds of random shapes of all kinds, many of them coincident (copies, faces
 * that lie in one plane, shapes that touch), for rays that run in surfaces and along axes. Of equal crossings that of the lowest number is taken.
 */
#include "scene.h"

/* Coordinates on a coarse grid make shapes touch and coincide; others are free. */
static double coordinate(int grid)
{
    return grid ? floor(between(-4, 5)) : between(-4, 4);
}

static void random_point(int grid, double p[3])
{
    for (int j = 0; j < 3; j++)
        p[j] = coordinate(grid);
}

static void add_shape(struct stage *s, int grid)
{
    double c[3], e[3][3], frame[3][3];
    uint32_t kind = (uint32_t)(number() * (MCR_SHAPE_BOX + 1));
    random_point(grid, c);
    random_frame(frame);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            e[i][j] = grid ? (i == j ? 1 : 0) : between(0.2, 1) * frame[i][j];
    switch (kind) {
    case MCR_SHAPE_PLANE: /* few: they hide the rest */
        if (s->scene.shape_count % 16 == 0) {
            for (int j = 0; j < 3; j++)
                c[j] = 6 * e[0][j];
            stage_plane(s, c, grid ? e[0] : frame[0]);
        }
        break;
    case MCR_SHAPE_SPHERE:
        stage_sphere(s, c, grid ? 1 : between(0.1, 1));
        break;
    case MCR_SHAPE_PARALLELOGRAM:
    case MCR_SHAPE_DISK:
        stage_flat(s, kind, c, e[(s->scene.shape_count) % 3], e[(s->scene.shape_count + 1) % 3]);
        break;
    default:
        stage_axes(s, kind, c, e);
    }
}

static void add_triangles(struct stage *s, int grid, int count)
{
    for (int t = 0; t < count; t++) {
        double p[3];
        uint32_t v[3];
        random_point(grid, p);
        double q[3][3], e[2][3], n[3];
        do {
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    q[i][j] = p[j] + (grid ? floor(between(-1, 2)) : between(-1, 1));
            for (int j = 0; j < 3; j++) {
                e[0][j] = q[1][j] - q[0][j];
                e[1][j] = q[2][j] - q[0][j];
            }
            cross_product(e[0], e[1], n);
        } while (!(fabs(n[0]) + fabs(n[1]) + fabs(n[2]) > 0)); /* the scene drops triangles without area */
        for (int i = 0; i < 3; i++)
            v[i] = stage_vertex(s, q[i]);
        stage_triangle(s, v[0], v[1], v[2]);
        if (t % 5 == 0)
            stage_triangle(s, v[1], v[2], v[0]); /* the same again */
    }
}

/* Every fourth shape is there twice. */
static void add_shapes(struct stage *s, int grid, uint32_t count)
{
    while (s->scene.shape_count < count) {
        uint32_t before = s->scene.shape_count;
        add_shape(s, grid);
        if (s->scene.shape_count > before && before % 4 == 0) {
            struct mcr_shape *copy = &s->shape[s->scene.shape_count];
            *copy = s->shape[before];
            copy->primitive = s->scene.primitive_count;
            s->scene.primitive_count += copy->kind == MCR_SHAPE_BOX ? 6 : 1;
            s->scene.shape_count++;
        }
    }
}

/* What surrounds the others and lies in faces of them: tested for every ray (struct mcr_accel, wide). */
static void add_walls(struct stage *s, int grid)
{
    double turned[3][3] = {{7, 0, 3}, {0, 5, 0}, {-3, 0, 7}}, away = grid ? 4 : 4.5, c[3], e[2][3];
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t axis = i % 3;
        for (uint32_t j = 0; j < 3; j++) {
            c[j] = j == axis && i < 3 ? away : -away;
            e[0][j] = j == (axis + 1) % 3 ? 2 * away : 0;
            e[1][j] = j == (axis + 2) % 3 ? 2 * away : 0;
        }
        stage_flat(s, i == 2 ? MCR_SHAPE_DISK : MCR_SHAPE_PARALLELOGRAM, c, e[0], e[1]);
    }
    for (int j = 0; j < 3; j++)
        c[j] = -2;
    stage_axes(s, MCR_SHAPE_BOX, c, turned);
    stage_sphere(s, c, 5);
    for (int t = 0; t < 2; t++) {
        uint32_t v[3];
        for (int i = 0; i < 3; i++) {
            double p[3] = {i == 1 ? away : -away, t ? -away : -3, i == 2 ? away : -away};
            v[i] = stage_vertex(s, p);
        }
        stage_triangle(s, v[0], v[1], v[2]);
    }
}

static void aim(struct bundle *b, int grid)
{
    for (uint32_t i = 0; i < b->n; i++) {
        double o[3], to[3], d[3];
        random_point(grid, o);
        random_point(grid, to);
        random_direction(d);
        uint32_t axis = i % 3;
        for (int j = 0; j < 3; j++) {
            if (i % 8 == 0) /* along an axis */
                to[j] = o[j] + ((uint32_t)j == axis ? (i % 16 ? 1 : -1) : 0);
            else if (i % 8 == 1) /* in a plane of the grid */
                to[j] = (uint32_t)j == axis ? o[j] : to[j];
            else if (i % 8 == 2 || !(fabs(to[0] - o[0]) + fabs(to[1] - o[1]) + fabs(to[2] - o[2]) > 0))
                to[j] = o[j] + d[j];
        }
        if (!(fabs(to[0] - o[0]) + fabs(to[1] - o[1]) + fabs(to[2] - o[2]) > 0))
            to[axis] += 1;
        bundle_aim(b, i, o, to);
        b->far[i] = i % 4 == 0 ? INFINITY : between(0, 6);
    }
}

static int same_double(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static void compare(const char *what, struct stage *s, int grid, uint32_t rays)
{
    struct bundle b = bundle_create(rays);
    double *t = malloc(rays * sizeof *t);
    int64_t *primitive = malloc(rays * sizeof *primitive);
    uint32_t hits = 0, ways = 0;
    uint32_t wrong = 0, wrong_visible = 0, wrong_end = 0;
    aim(&b, grid);
    for (uint32_t kind = 0; kind < 2; kind++)
        for (uint32_t isa = 0; isa < 3 && functions_of(isa, kind); isa++, ways++) {
            bundle_trace(&b, s, isa, kind);
            if (!ways) {
                memcpy(t, b.t, rays * sizeof *t);
                memcpy(primitive, b.primitive, rays * sizeof *primitive);
            }
            functions_of(isa, kind)->visible(s->accel[kind], &b.rays, b.far, b.visible);
            for (uint32_t i = 0; i < rays; i++) {
                hits += !ways && primitive[i] >= 0;
                wrong += primitive[i] != b.primitive[i] || !same_double(t[i], b.t[i]);
                wrong_visible += b.visible[i] != (t[i] < b.far[i] ? 0.0 : 1.0);
            }
        }
    for (uint32_t i = 0; i < rays; i++) /* to the hit, or to the next number behind it */
        b.far[i] = i % 2 ? t[i] : nextafter(t[i], INFINITY);
    for (uint32_t kind = 0; kind < 2; kind++)
        for (uint32_t isa = 0; isa < 3 && functions_of(isa, kind); isa++) {
            functions_of(isa, kind)->visible(s->accel[kind], &b.rays, b.far, b.visible);
            for (uint32_t i = 0; i < rays; i++)
                wrong_end += b.visible[i] != (t[i] < b.far[i] ? 0.0 : 1.0);
        }
    ok(wrong == 0 && hits > rays / 100, "%s: %u shapes and %u triangles, %u rays, %u of them hit, %u ways: %u differ", what, s->scene.shape_count,
       s->scene.triangles.count, rays, hits, ways, wrong);
    ok(wrong_visible == 0, "%s: visible means that nothing is hit before: %u differ", what, wrong_visible);
    ok(wrong_end == 0, "%s: to the last bit: %u differ", what, wrong_end);
    free(t);
    free(primitive);
    bundle_destroy(&b);
}

/* Two of the same: the first is hit. */
static void test_ties(void)
{
    uint32_t wrong = 0, hits = 0;
    for (uint32_t trial = 0; trial < 40; trial++) {
        struct stage *s = stage_create();
        struct bundle b = bundle_create(256);
        do
            add_shape(s, trial % 2);
        while (s->scene.shape_count == 0 || s->shape[0].kind == MCR_SHAPE_PLANE ? (s->scene.shape_count = s->scene.primitive_count = 0, 1) : 0);
        s->shape[1] = s->shape[0];
        s->shape[1].primitive = s->scene.primitive_count;
        s->scene.primitive_count *= 2;
        s->scene.shape_count = 2;
        if (trial % 3 == 0) { /* a triangle and its copy */
            add_triangles(s, 0, 1);
            memcpy(s->vertex[1], s->vertex[0], sizeof s->vertex[1]);
            s->scene.shape_count = 0;
            s->scene.primitive_count = 0;
        }
        stage_ready(s);
        uint32_t half = s->scene.primitive_count / 2;
        const double *at = trial % 3 ? s->shape[0].c : NULL;
        for (uint32_t i = 0; i < b.n; i++) {
            double o[3], to[3];
            for (int j = 0; j < 3; j++) {
                o[j] = between(-9, 9);
                to[j] = at ? at[j] + between(0, 0.5) : (s->x[j] * (j == 0) + s->y[j] * (j == 1) + s->z[j] * (j == 2));
            }
            if (!at)
                for (int j = 0; j < 3; j++) {
                    const double *v = j == 0 ? s->x : j == 1 ? s->y : s->z;
                    to[j] = (v[0] + v[1] + v[2]) / 3;
                }
            bundle_aim(&b, i, o, to);
        }
        for (uint32_t kind = 0; kind < 2; kind++) {
            bundle_trace(&b, s, best_isa(), kind);
            for (uint32_t i = 0; i < b.n; i++) {
                hits += b.primitive[i] >= 0;
                wrong += b.primitive[i] >= (int64_t)half;
            }
        }
        bundle_destroy(&b);
        stage_destroy(s);
    }
    ok(wrong == 0 && hits > 5000, "of two equal shapes the first is hit: %u of %u hits wrong", wrong, hits);
}

int main(void)
{
    for (int grid = 0; grid < 2; grid++) {
        struct stage *s = stage_create();
        add_shapes(s, grid, 200);
        add_triangles(s, grid, 100);
        stage_ready(s);
        compare(grid ? "on a grid" : "free", s, grid, 20000);
        stage_destroy(s);
        s = stage_create();
        add_shapes(s, grid, 3);
        stage_ready(s);
        compare(grid ? "few on a grid" : "few", s, grid, 20000);
        stage_destroy(s);
        s = stage_create();
        add_triangles(s, grid, 500);
        stage_ready(s);
        compare(grid ? "triangles on a grid" : "triangles", s, grid, 20000);
        stage_destroy(s);
    }
    test_ties();
    for (int grid = 0; grid < 2; grid++) {
        struct stage *s = stage_create();
        add_shapes(s, grid, 60);
        add_walls(s, grid);
        add_shapes(s, grid, 120);
        add_triangles(s, grid, 50);
        stage_ready(s);
        ok(s->accel[1]->wide_count >= 4 && s->accel[1]->node_count > 0, "a room: %u wide shapes beside %u nodes", s->accel[1]->wide_count, s->accel[1]->node_count);
        compare(grid ? "a room on a grid" : "a room", s, grid, 20000);
        stage_destroy(s);
    }
    return tap_done();
}
