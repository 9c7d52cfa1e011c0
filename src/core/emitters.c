/* SPDX-License-Identifier: Apache-2.0 */
/* The table of emitters of a scene. */
#include "core/emitters.h"

#include <math.h>
#include <string.h>

#include "base/elementary.h"
#include "core/cell.h"
#include "core/emitter_lanes.h"
#include "scene/vector.h"
#include <mcrender/material.h>

#define BOTH_SIDES (MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK)

/* The height of points on a surface is a few roundings (u = 2^-53) of the coordinates it comes from; so far around it counts as unseen. */
#define MARGIN (64 * MCR_ROUNDING)

/* Where a product overflows; the sum of 2^32 such is finite. */
#define MOST_POWER 1e290

/* a * b - c * d, rounded once or twice: the products are formed exactly. */
static double difference_of_products(double a, double b, double c, double d)
{
    double ab_lo, cd_lo, ab = mcr_product_(a, b, &ab_lo), cd = mcr_product_(c, d, &cd_lo);
    return (ab - cd) + (ab_lo - cd_lo);
}

/* Normals and solid angles of needles rest on this. */
static void exact_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = difference_of_products(a[1], b[2], a[2], b[1]);
    out[1] = difference_of_products(a[2], b[0], a[0], b[2]);
    out[2] = difference_of_products(a[0], b[1], a[1], b[0]);
}

static uint32_t emitting_sides(const struct mcr_scene_material *material)
{
    const double *radiance = material->traits.radiance;
    return mcr_luminance(radiance[0], radiance[1], radiance[2]) > 0 ? material->traits.does & BOTH_SIDES : 0;
}

static void set_sides(double *k, uint32_t sides, double margin)
{
    k[MCR_K_ABOVE] = sides & MCR_MATERIAL_EMITS_FRONT ? margin : INFINITY;
    k[MCR_K_BELOW] = sides & MCR_MATERIAL_EMITS_BACK ? -margin : -INFINITY;
}

/* Takes room for one more emitter; its area must be a positive number in floating point. */
static double *add(struct mcr_emitters *all, uint32_t kind, uint32_t primitive, uint32_t material, uint32_t sides, double area)
{
    struct mcr_emitter *emitter = &all->emitter[all->count];
    if (!(area > 0) || !(area < INFINITY))
        return NULL;
    *emitter = (struct mcr_emitter){.kind = kind, .primitive = primitive, .material = material, .sides = sides, .area = area};
    all->kinds |= 1u << kind;
    return all->k[all->count++];
}

/*
 * Parallelogram, triangle or disk: corner or centre c, edges or half axes e0, e1; `front` is on the front side. |N| times `share` is the
 * area.
 */
static void add_flat(struct mcr_emitters *all, uint32_t kind, uint32_t primitive, uint32_t material, uint32_t sides, const double c[3],
                     const double e0[3], const double e1[3], const double front[3], double share)
{
    double normal[3], dual0[3], dual1[3], length, *k;
    exact_cross(e0, e1, normal);
    length = mcr_length(normal);
    k = add(all, kind, primitive, material, sides, share * length);
    if (!k)
        return;
    exact_cross(e1, normal, dual0);
    exact_cross(normal, e0, dual1);
    for (int i = 0; i < 3; i++) {
        k[MCR_K_C + i] = c[i];
        k[MCR_K_E0 + i] = e0[i];
        k[MCR_K_E1 + i] = e1[i];
        k[MCR_K_DUAL0 + i] = dual0[i] / length / length;
        k[MCR_K_DUAL1 + i] = dual1[i] / length / length;
    }
    double side = mcr_dot(normal, front) < 0 ? -1.0 : 1.0;
    for (int i = 0; i < 3; i++)
        k[MCR_K_N + i] = side * normal[i];
    k[MCR_K_NN] = length * length;
    k[MCR_K_FACTOR] = 1 / share;
    set_sides(k, sides, MARGIN * length * (mcr_length(c) + mcr_length(e0) + mcr_length(e1)));
}

static void add_sphere(struct mcr_emitters *all, const struct mcr_shape *shape, uint32_t sides)
{
    double r = shape->radius, *k = add(all, MCR_EMITTER_SPHERE, shape->primitive, shape->material, sides, 4 * MCR_PI * r * r);
    if (!k)
        return;
    mcr_copy(shape->c, k + MCR_K_C);
    k[MCR_K_RADIUS] = r;
    k[MCR_K_SQUARE] = r * r;
    k[MCR_K_INVERSE] = 1 / (2 * MCR_PI * r * r);
    k[MCR_K_SPREAD] = 1 / (4 * MCR_PI * r);
    set_sides(k, sides, MARGIN * r * (mcr_length(shape->c) + r));
}

/*
 * Mean of |E^-T s| over unit vectors s, times 4 pi |det E|: by a product rule of 64 x 64 points, whose error only bends the choice of
 * emitter.
 */
static double ellipsoid_area(const double inverse[9], double determinant)
{
    double sum = 0;
    for (int i = 0; i < 64; i++) {
        double z = (2 * i + 1) / 64.0 - 1, rho = sqrt(1 - z * z);
        for (int j = 0; j < 64; j++) {
            double c, s, n[3];
            mcr_sincos_turns((j + 0.5) / 64, &s, &c);
            for (int a = 0; a < 3; a++)
                n[a] = inverse[a] * rho * c + inverse[3 + a] * rho * s + inverse[6 + a] * z;
            sum += sqrt(mcr_dot(n, n));
        }
    }
    return 4 * MCR_PI * determinant * (sum / 4096);
}

static void add_ellipsoid(struct mcr_emitters *all, const struct mcr_shape *shape, uint32_t sides)
{
    double row[3][3], inverse[9], determinant, stretch = 0, reach = mcr_length(shape->c);
    for (int i = 0; i < 3; i++)
        exact_cross(shape->e[(i + 1) % 3], shape->e[(i + 2) % 3], row[i]);
    determinant = mcr_dot(row[0], shape->e[0]);
    for (int i = 0; i < 9; i++)
        inverse[i] = row[i / 3][i % 3] / determinant;
    for (int i = 0; i < 3; i++) {
        reach += mcr_length(shape->e[i]);
        stretch += mcr_length(inverse + 3 * i);
    }
    double *k = add(all, MCR_EMITTER_ELLIPSOID, shape->primitive, shape->material, sides, ellipsoid_area(inverse, fabs(determinant)));
    if (!k)
        return;
    mcr_copy(shape->c, k + MCR_K_C);
    mcr_copy(shape->e[0], k + MCR_K_E0);
    mcr_copy(shape->e[1], k + MCR_K_E1);
    mcr_copy(shape->e[2], k + MCR_K_N);
    memcpy(k + MCR_K_DUAL0, inverse, sizeof inverse);
    k[MCR_K_SPREAD] = 1 / (4 * MCR_PI * fabs(determinant));
    set_sides(k, sides, MARGIN * stretch * reach);
}

/* Six parallelograms, in the order of the box's primitives: axis by axis, the face at 0 before that at 1. */
static void add_box(struct mcr_emitters *all, const struct mcr_shape *shape, uint32_t sides)
{
    for (uint32_t face = 0; face < 6; face++) {
        uint32_t axis = face / 2, j = (axis + 1) % 3, k = (axis + 2) % 3;
        double corner[3], out[3];
        for (int i = 0; i < 3; i++) {
            corner[i] = shape->c[i] + (face % 2 ? shape->e[axis][i] : 0);
            out[i] = face % 2 ? shape->e[axis][i] : -shape->e[axis][i];
        }
        add_flat(all, MCR_EMITTER_PARALLELOGRAM, shape->primitive + face, shape->material, sides, corner, shape->e[j], shape->e[k], out, 1);
    }
}

static void add_shape(struct mcr_emitters *all, const struct mcr_shape *shape, uint32_t sides)
{
    switch (shape->kind) {
    case MCR_SHAPE_PARALLELOGRAM:
        add_flat(all, MCR_EMITTER_PARALLELOGRAM, shape->primitive, shape->material, sides, shape->c, shape->e[0], shape->e[1], shape->n, 1);
        break;
    case MCR_SHAPE_DISK:
        add_flat(all, MCR_EMITTER_DISK, shape->primitive, shape->material, sides, shape->c, shape->e[0], shape->e[1], shape->n, MCR_PI);
        break;
    case MCR_SHAPE_SPHERE:
        add_sphere(all, shape, sides);
        break;
    case MCR_SHAPE_ELLIPSOID:
        add_ellipsoid(all, shape, sides);
        break;
    case MCR_SHAPE_BOX:
        add_box(all, shape, sides);
        break;
    default: /* planes */
        break;
    }
}

static void add_triangle(struct mcr_emitters *all, const struct mcr_triangles *triangles, uint32_t t, uint32_t sides)
{
    const uint32_t *v = triangles->vertex[t];
    double p[3][3], e0[3], e1[3], front[3];
    for (int i = 0; i < 3; i++) {
        p[i][0] = triangles->x[v[i]];
        p[i][1] = triangles->y[v[i]];
        p[i][2] = triangles->z[v[i]];
    }
    mcr_subtract(p[1], p[0], e0);
    mcr_subtract(p[2], p[0], e1);
    exact_cross(e0, e1, front);
    add_flat(all, MCR_EMITTER_TRIANGLE, triangles->first_primitive + t, triangles->material[t], sides, p[0], e0, e1, front, 0.5);
}

/* The most emitters that there can be. */
static size_t count_candidates(const struct mcr_scene *scene)
{
    size_t count = 0;
    for (uint32_t i = 0; i < scene->shape_count; i++)
        if (emitting_sides(&scene->material[scene->shape[i].material]))
            count += scene->shape[i].kind == MCR_SHAPE_BOX ? 6 : 1;
    for (uint32_t t = 0; t < scene->triangles.count; t++)
        count += emitting_sides(&scene->material[scene->triangles.material[t]]) != 0;
    return count;
}

/* Probabilities in proportion to power; powers relative to the largest, so that neither 1e30 nor 1e-30 is lost. */
static void set_probabilities(struct mcr_emitters *all, const struct mcr_scene *scene)
{
    double largest = 0, sum = 0;
    for (uint32_t e = 0; e < all->count; e++) {
        struct mcr_emitter *emitter = &all->emitter[e];
        const double *radiance = scene->material[emitter->material].traits.radiance;
        double luminance = mcr_luminance(radiance[0], radiance[1], radiance[2]);
        emitter->probability = fmin(luminance * emitter->area * (emitter->sides == BOTH_SIDES ? 2 : 1), MOST_POWER);
        largest = fmax(largest, emitter->probability);
    }
    for (uint32_t e = 0; e < all->count; e++) {
        all->emitter[e].probability /= largest;
        sum += all->emitter[e].probability;
    }
    all->power = MCR_PI * largest * sum;
    for (uint32_t e = 0; e < all->count; e++)
        all->emitter[e].probability /= sum;
}

double mcr_emitters_power(const struct mcr_emitters *emitters)
{
    return emitters->power;
}

size_t mcr_emitters_scratch(const struct mcr_emitters *emitters, uint32_t n)
{
    (void)emitters, (void)n; /* one block's */
    return sizeof(struct mcr_emitter_scratch);
}

struct mcr_emitters *mcr_emitters_create(struct mcr_arena *arena, const struct mcr_scene *scene)
{
    struct mcr_emitters *all = mcr_arena_alloc(arena, 1, sizeof *all);
    size_t candidates = count_candidates(scene);
    if (!all)
        return NULL;
    all->primitive_count = scene->primitive_count;
    all->emitter = mcr_arena_alloc(arena, candidates, sizeof *all->emitter);
    all->k = mcr_arena_alloc(arena, candidates, sizeof *all->k);
    all->of_primitive = mcr_arena_alloc(arena, scene->primitive_count, sizeof *all->of_primitive);
    if (!all->emitter || !all->k || !all->of_primitive)
        return NULL;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        uint32_t sides = emitting_sides(&scene->material[scene->shape[i].material]);
        if (sides)
            add_shape(all, &scene->shape[i], sides);
    }
    for (uint32_t t = 0; t < scene->triangles.count; t++) {
        uint32_t sides = emitting_sides(&scene->material[scene->triangles.material[t]]);
        if (sides)
            add_triangle(all, &scene->triangles, t, sides);
    }
    set_probabilities(all, scene);
    if (all->count > MCR_EMITTERS_FEW && mcr_emitter_tree_build(all, arena))
        return NULL;
    for (uint32_t p = 0; p < scene->primitive_count; p++)
        all->of_primitive[p] = -1;
    for (uint32_t e = 0; e < all->count; e++)
        all->of_primitive[all->emitter[e].primitive] = (int32_t)e;
    for (uint32_t i = 0; i < 128; i++) {
        double sine;
        mcr_sincos_turns(i / 128.0, &sine, &all->cosine[i]);
    }
    return all;
}
