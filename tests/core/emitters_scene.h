/* SPDX-License-Identifier: Apache-2.0 */
/* Small scenes of emitters, points and directions for the tests of src/core/emitters.h. */
#ifndef TESTS_CORE_EMITTERS_SCENE_H
#define TESTS_CORE_EMITTERS_SCENE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../tap.h"
#include "base/cpu.h"
#include "base/elementary.h"
#include "core/emitters.h"
#include <mcrender/material.h>

#define FRONT MCR_MATERIAL_EMITS_FRONT
#define BACK MCR_MATERIAL_EMITS_BACK
#ifndef MOST_SHAPES
#define MOST_SHAPES 64
#define MOST_TRIANGLES 64
#endif

/* One material a shape. */
struct stage {
    struct mcr_scene scene;
    struct mcr_shape shape[MOST_SHAPES];
    struct mcr_scene_material material[MOST_SHAPES + MOST_TRIANGLES];
    double x[3 * MOST_TRIANGLES], y[3 * MOST_TRIANGLES], z[3 * MOST_TRIANGLES];
    uint32_t vertex[MOST_TRIANGLES][3], triangle_material[MOST_TRIANGLES];
    struct mcr_arena *arena;
    struct mcr_emitters *emitters;
    void *scratch;
};

static inline uint32_t stage_material(struct stage *s, uint32_t sides, double radiance)
{
    struct mcr_material_traits *traits = &s->material[s->scene.material_count].traits;
    traits->does = sides;
    traits->radiance[0] = traits->radiance[1] = traits->radiance[2] = radiance;
    return s->scene.material_count++;
}

static inline void cross_product(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static inline struct mcr_shape *stage_shape(struct stage *s, uint32_t kind, uint32_t sides, double radiance, const double c[3])
{
    struct mcr_shape *shape = &s->shape[s->scene.shape_count++];
    shape->kind = kind;
    shape->primitive = s->scene.primitive_count;
    shape->material = stage_material(s, sides, radiance);
    memcpy(shape->c, c, sizeof shape->c);
    s->scene.primitive_count += kind == MCR_SHAPE_BOX ? 6 : 1;
    return shape;
}

/* Parallelogram or disk; the front is where e0 x e1 points. */
static inline void stage_flat(struct stage *s, uint32_t kind, uint32_t sides, double radiance, const double c[3], const double e0[3],
                              const double e1[3])
{
    struct mcr_shape *shape = stage_shape(s, kind, sides, radiance, c);
    memcpy(shape->e[0], e0, sizeof shape->e[0]);
    memcpy(shape->e[1], e1, sizeof shape->e[1]);
    cross_product(e0, e1, shape->n);
    double length = sqrt(shape->n[0] * shape->n[0] + shape->n[1] * shape->n[1] + shape->n[2] * shape->n[2]);
    for (int i = 0; i < 3; i++)
        shape->n[i] /= length;
}

static inline void stage_sphere(struct stage *s, uint32_t sides, double radiance, const double c[3], double radius)
{
    stage_shape(s, MCR_SHAPE_SPHERE, sides, radiance, c)->radius = radius;
}

static inline void stage_axes(struct stage *s, uint32_t kind, uint32_t sides, double radiance, const double c[3], const double e[3][3])
{
    memcpy(stage_shape(s, kind, sides, radiance, c)->e, e, 9 * sizeof(double));
}

/* Triangles come after all shapes. */
static inline void stage_triangle(struct stage *s, uint32_t sides, double radiance, const double a[3], const double b[3], const double c[3])
{
    uint32_t t = s->scene.triangles.count++;
    const double *v[3] = {a, b, c};
    for (uint32_t i = 0; i < 3; i++) {
        s->vertex[t][i] = 3 * t + i;
        s->x[3 * t + i] = v[i][0];
        s->y[3 * t + i] = v[i][1];
        s->z[3 * t + i] = v[i][2];
    }
    s->triangle_material[t] = stage_material(s, sides, radiance);
}

static inline void stage_begin(struct stage *s)
{
    memset(s, 0, sizeof *s);
}

static inline void stage_ready(struct stage *s)
{
    struct mcr_triangles *t = &s->scene.triangles;
    s->scene.shape = s->shape;
    s->scene.material = s->material;
    t->x = s->x, t->y = s->y, t->z = s->z, t->vertex = s->vertex, t->material = s->triangle_material;
    t->first_primitive = s->scene.primitive_count;
    t->vertex_count = 3 * t->count;
    s->scene.primitive_count += t->count;
    s->arena = mcr_arena_create(0);
    s->emitters = mcr_emitters_create(s->arena, &s->scene);
    s->scratch = aligned_alloc(64, (mcr_emitters_scratch(s->emitters, 4096) + 63) / 64 * 64);
}

static inline void stage_end(struct stage *s)
{
    free(s->scratch);
    mcr_arena_destroy(s->arena);
}

/* The functions of an instruction set, or NULL where this processor lacks it. */
static inline const struct mcr_emitter_functions *functions_of(uint32_t isa)
{
#if defined(__x86_64__)
    static const struct mcr_emitter_functions *const all[] = {&mcr_emitter_functions_isa0, &mcr_emitter_functions_isa1,
                                                              &mcr_emitter_functions_isa2};
    return isa <= 2 && isa <= mcr_cpu_isa() ? all[isa] : NULL;
#else
    return isa == 0 ? &mcr_emitter_functions_isa0 : NULL;
#endif
}

static inline const struct mcr_emitter_functions *best_functions(void)
{
    uint32_t isa = 2;
    while (!functions_of(isa))
        isa--;
    return functions_of(isa);
}

/* Arrays of n doubles, aligned and padded as the interface asks. */
static inline double *doubles(size_t n)
{
    double *array = aligned_alloc(64, (n + 8) * sizeof *array / 64 * 64 + 64);
    if (!array)
        abort();
    memset(array, 0, n * sizeof *array);
    return array;
}

/* Numbers: a stream of its own for each key. */
static inline void fill_numbers(uint64_t key, uint32_t n, double *out)
{
    for (uint32_t i = 0; i < n; i++)
        out[i] = mcr_number(mcr_mix64(key) + i, key);
}

/* A batch of lanes: points, numbers, directions, results. */
struct batch {
    uint32_t n;
    double *nx, *ny, *nz; /* normals: at->nx is NULL until batch_normals */
    double *px, *py, *pz, *u[3], *x, *y, *z, *density, *kept;
    struct mcr_points at;
    struct mcr_directions toward;
};

static inline void batch_begin(struct batch *b, uint32_t n)
{
    double **all[] = {&b->nx, &b->ny, &b->nz, &b->px, &b->py, &b->pz, &b->u[0], &b->u[1], &b->u[2], &b->x, &b->y, &b->z, &b->density, &b->kept};
    memset(b, 0, sizeof *b);
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        *all[i] = doubles(n);
    b->n = n;
    b->at = (struct mcr_points){.size = sizeof b->at, .n = n, .px = b->px, .py = b->py, .pz = b->pz};
    b->toward = (struct mcr_directions){sizeof b->toward, n, b->x, b->y, b->z};
}

static inline void batch_end(struct batch *b)
{
    double *all[] = {b->nx, b->ny, b->nz, b->px, b->py, b->pz, b->u[0], b->u[1], b->u[2], b->x, b->y, b->z, b->density, b->kept};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
}

static inline void batch_normals(struct batch *b)
{
    b->at.nx = b->nx, b->at.ny = b->ny, b->at.nz = b->nz;
}

/* All lanes at one point. */
static inline void batch_at(struct batch *b, const double p[3])
{
    for (uint32_t i = 0; i < b->n; i++) {
        b->px[i] = p[0];
        b->py[i] = p[1];
        b->pz[i] = p[2];
    }
}

static inline void batch_numbers(struct batch *b, uint64_t key)
{
    for (uint64_t k = 0; k < 3; k++)
        fill_numbers(3 * key + k, b->n, b->u[k]);
}

static inline void batch_draw(struct batch *b, const struct stage *s, const struct mcr_emitter_functions *f, uint32_t by)
{
    f->draw(s->emitters, s->scratch, by, &b->at, (const double *const *)b->u, &b->toward, b->density, b->kept);
}

static inline void batch_density(struct batch *b, const struct stage *s, const struct mcr_emitter_functions *f, uint32_t by, double *out)
{
    f->density(s->emitters, s->scratch, by, &b->at, &b->toward, NULL, out);
}

/* The same, with what the last draw kept. */
static inline void batch_density_kept(struct batch *b, const struct stage *s, const struct mcr_emitter_functions *f, uint32_t by, double *out)
{
    f->density(s->emitters, s->scratch, by, &b->at, &b->toward, b->kept, out);
}

/* Mean and its standard error. */
struct mean {
    double count, sum, squares;
};

static inline void mean_add(struct mean *m, double x)
{
    m->count++;
    m->sum += x;
    m->squares += x * x;
}

static inline double mean_value(const struct mean *m)
{
    return m->sum / m->count;
}

static inline double mean_variance(const struct mean *m)
{
    double mean = mean_value(m);
    return fmax(m->squares / m->count - mean * mean, 0) * m->count / (m->count - 1);
}

static inline double mean_error(const struct mean *m)
{
    return sqrt(mean_variance(m) / m->count);
}

#endif
