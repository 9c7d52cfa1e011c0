/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes of bare shapes in render space, rays, and both accelerators in every instruction set, for tests of src/accel. */
#ifndef TESTS_ACCEL_SCENE_H
#define TESTS_ACCEL_SCENE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../tap.h"
#include "accel/accel.h"
#include "base/cpu.h"
#include "base/random.h"

#define UNIT_ROUNDING 0x1p-53
#define MOST_SHAPES 512
#define MOST_TRIANGLES 65536

struct stage {
    struct mcr_scene scene;
    struct mcr_shape shape[MOST_SHAPES];
    double x[MOST_TRIANGLES], y[MOST_TRIANGLES], z[MOST_TRIANGLES];
    uint32_t vertex[MOST_TRIANGLES][3], material[MOST_TRIANGLES];
    struct mcr_arena *arena;
    struct mcr_accel *accel[2]; /* list, bvh */
};

static uint64_t number_state = 1;

static inline double number(void)
{
    return mcr_unit_double(mcr_mix64(number_state++));
}

static inline double between(double a, double b)
{
    return a + (b - a) * number();
}

static inline void cross_product(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static inline void normalise(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

static inline void random_direction(double d[3])
{
    double square;
    do {
        square = 0;
        for (int i = 0; i < 3; i++) {
            d[i] = between(-1, 1);
            square += d[i] * d[i];
        }
    } while (square > 1 || square < 0.01);
    normalise(d);
}

/* Three orthonormal vectors turned at random. */
static inline void random_frame(double frame[3][3])
{
    double other[3];
    random_direction(frame[0]);
    random_direction(other);
    cross_product(frame[0], other, frame[1]);
    normalise(frame[1]);
    cross_product(frame[0], frame[1], frame[2]);
    normalise(frame[2]);
}

static inline struct stage *stage_create(void)
{
    struct stage *s = calloc(1, sizeof *s);
    if (!s)
        abort();
    return s;
}

static inline struct mcr_shape *stage_shape(struct stage *s, uint32_t kind, const double c[3])
{
    struct mcr_shape *shape = &s->shape[s->scene.shape_count++];
    shape->kind = kind;
    shape->primitive = s->scene.primitive_count;
    memcpy(shape->c, c, sizeof shape->c);
    s->scene.primitive_count += kind == MCR_SHAPE_BOX ? 6 : 1;
    return shape;
}

static inline void stage_sphere(struct stage *s, const double c[3], double radius)
{
    stage_shape(s, MCR_SHAPE_SPHERE, c)->radius = radius;
}

static inline void stage_plane(struct stage *s, const double c[3], const double n[3])
{
    memcpy(stage_shape(s, MCR_SHAPE_PLANE, c)->n, n, 3 * sizeof *n);
}

/* Parallelogram or disk. */
static inline void stage_flat(struct stage *s, uint32_t kind, const double c[3], const double e0[3], const double e1[3])
{
    struct mcr_shape *shape = stage_shape(s, kind, c);
    memcpy(shape->e[0], e0, sizeof shape->e[0]);
    memcpy(shape->e[1], e1, sizeof shape->e[1]);
    cross_product(e0, e1, shape->n);
    normalise(shape->n);
}

/* Box or ellipsoid. */
static inline void stage_axes(struct stage *s, uint32_t kind, const double c[3], double e[3][3])
{
    memcpy(stage_shape(s, kind, c)->e, e, 9 * sizeof(double));
}

static inline uint32_t stage_vertex(struct stage *s, const double p[3])
{
    struct mcr_triangles *t = &s->scene.triangles;
    s->x[t->vertex_count] = p[0];
    s->y[t->vertex_count] = p[1];
    s->z[t->vertex_count] = p[2];
    return t->vertex_count++;
}

/* Triangles come after all shapes. */
static inline void stage_triangle(struct stage *s, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *v = s->vertex[s->scene.triangles.count++];
    v[0] = a;
    v[1] = b;
    v[2] = c;
}

static inline void stage_ready(struct stage *s)
{
    struct mcr_triangles *t = &s->scene.triangles;
    s->scene.shape = s->shape;
    t->x = s->x, t->y = s->y, t->z = s->z, t->vertex = s->vertex, t->material = s->material;
    t->first_primitive = s->scene.primitive_count;
    s->scene.primitive_count += t->count;
    s->arena = mcr_arena_create(0);
    s->accel[0] = mcr_accel_create(s->arena, &s->scene, MCR_ACCEL_LIST);
    s->accel[1] = mcr_accel_create(s->arena, &s->scene, MCR_ACCEL_BVH);
    if (!s->accel[0] || !s->accel[1])
        abort();
}

static inline void stage_destroy(struct stage *s)
{
    mcr_arena_destroy(s->arena);
    free(s);
}

/* The most that this processor and this build have. */
static inline uint32_t best_isa(void)
{
    uint32_t isa = mcr_cpu_isa();
    return isa < MCR_ISA_COUNT ? isa : MCR_ISA_COUNT - 1;
}

/* kind 0: list, 1: bvh. NULL where this processor or build lacks the instruction set. */
static inline const struct mcr_accel_functions *functions_of(uint32_t isa, uint32_t kind)
{
    if (isa > best_isa())
        return NULL;
#if MCR_ISA_COUNT > 1
    return isa == 2 ? &mcr_accel_functions_isa2[kind] : isa == 1 ? &mcr_accel_functions_isa1[kind] : &mcr_accel_functions_isa0[kind];
#else
    return &mcr_accel_functions_isa0[kind];
#endif
}

/* Rays with what they hit. */
struct bundle {
    uint32_t n;
    double *o[3], *d[3], *t, *far, *visible;
    int64_t *primitive;
    struct mcr_rays rays;
};

static inline void *aligned(size_t n, size_t size)
{
    void *at = aligned_alloc(64, (n + 8) * size / 64 * 64 + 64);
    if (!at)
        abort();
    memset(at, 0, n * size);
    return at;
}

static inline struct bundle bundle_create(uint32_t n)
{
    struct bundle b = {.n = n};
    for (int i = 0; i < 3; i++) {
        b.o[i] = aligned(n + 64, sizeof(double));
        b.d[i] = aligned(n + 64, sizeof(double));
    }
    b.t = aligned(n + 64, sizeof(double));
    b.far = aligned(n + 64, sizeof(double));
    b.visible = aligned(n + 64, sizeof(double));
    b.primitive = aligned(n + 64, sizeof(int64_t));
    b.rays = (struct mcr_rays){n, b.o[0], b.o[1], b.o[2], b.d[0], b.d[1], b.d[2]};
    return b;
}

static inline void bundle_destroy(struct bundle *b)
{
    for (int i = 0; i < 3; i++) {
        free(b->o[i]);
        free(b->d[i]);
    }
    free(b->t);
    free(b->far);
    free(b->visible);
    free(b->primitive);
}

/* From o toward `to`. */
static inline void bundle_aim(struct bundle *b, uint32_t i, const double o[3], const double to[3])
{
    double d[3] = {to[0] - o[0], to[1] - o[1], to[2] - o[2]};
    normalise(d);
    for (int j = 0; j < 3; j++) {
        b->o[j][i] = o[j];
        b->d[j][i] = d[j];
    }
}

static inline void bundle_trace(struct bundle *b, const struct stage *s, uint32_t isa, uint32_t kind)
{
    functions_of(isa, kind)->closest(s->accel[kind], &b->rays, b->t, b->primitive);
}

static const char *const accel_name[2] = {"list", "bvh"};

#endif
