/* SPDX-License-Identifier: Apache-2.0 */
/* Building accelerators: the kernels' constants of each shape, and the tree of boxes over them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel.h"

/* A tree's leaf holds at most this many items, unless they cannot be told apart. */
#define LEAF_ITEMS 4u
#define BINS 16
/* Below this depth splits are by surface area, from it on at the median, so that no tree is deeper than this plus 32 levels (2^31 items). */
#define SAH_DEPTH 48u

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The vector d with d.a = 1, d.b = 0, d.c = 0. */
static void dual(const double a[3], const double b[3], const double c[3], double out[3])
{
    double n[3];
    cross(b, c, n);
    double volume = dot(a, n);
    for (int j = 0; j < 3; j++)
        out[j] = n[j] / volume;
}

/* The axis that the vector runs along, or -1. */
static int axis_of(const double v[3])
{
    for (int j = 0; j < 3; j++)
        if (v[j] != 0 && v[(j + 1) % 3] == 0 && v[(j + 2) % 3] == 0)
            return j;
    return -1;
}

/* A parallelogram along the axes is tested with a tenth of the arithmetic. Returns whether it is one. */
static int rectangle_constants(const struct mcr_shape *shape, struct mcr_accel_shape *to)
{
    int first = axis_of(shape->e[0]), second = axis_of(shape->e[1]);
    if (first < 0 || second < 0)
        return 0;
    int axis = 3 - first - second;
    to->kind = MCR_ACCEL_RECTANGLE + (uint32_t)axis;
    to->k[0] = shape->c[axis];
    for (int i = 0; i < 2; i++) {
        int j = (axis + 1 + i) % 3;
        double from = shape->c[j], length = shape->e[0][j] + shape->e[1][j]; /* one of them is 0 */
        to->k[1 + 2 * i] = length > 0 ? from : from + length;
        to->k[2 + 2 * i] = length > 0 ? from + length : from;
    }
    return 1;
}

static void box_constants(const struct mcr_shape *shape, double *k)
{
    for (int i = 0; i < 3; i++) {
        double *n = k + 3 + 3 * i;
        cross(shape->e[(i + 1) % 3], shape->e[(i + 2) % 3], n);
        double length = sqrt(dot(n, n));
        length = dot(n, shape->e[i]) < 0 ? -length : length;
        for (int j = 0; j < 3; j++)
            n[j] /= length;
        k[12 + i] = dot(n, shape->e[i]);
    }
}

/* 1 if an edge runs along the axis of its own number. */
static int upright_constants(const struct mcr_shape *shape, struct mcr_accel_shape *to)
{
    double general[15], *k = to->k;
    int axis = 0;
    while (axis < 3 && !(axis_of(shape->e[axis]) == axis && shape->e[(axis + 1) % 3][axis] == 0 && shape->e[(axis + 2) % 3][axis] == 0))
        axis++;
    if (axis == 3)
        return 0;
    box_constants(shape, general);
    to->kind = MCR_ACCEL_UPRIGHT + (uint32_t)axis;
    k[3] = shape->e[axis][axis] > 0 ? 1 : -1;
    k[4] = shape->e[axis][axis];
    for (int i = 0; i < 3; i++)
        k[i] = shape->c[(axis + i) % 3];
    for (int i = 1; i < 3; i++) {
        int row = (axis + i) % 3;
        for (int j = 1; j < 3; j++)
            k[2 + 2 * i + j] = general[3 + 3 * row + (axis + j) % 3];
        k[8 + i] = general[12 + row];
    }
    return 1;
}

static void shape_constants(const struct mcr_shape *shape, struct mcr_accel_shape *to)
{
    double *k = to->k;
    to->kind = shape->kind;
    to->primitive = shape->primitive;
    memcpy(k, shape->c, 3 * sizeof *k);
    switch (shape->kind) {
    case MCR_SHAPE_PLANE:
        memcpy(k + 3, shape->n, 3 * sizeof *k);
        break;
    case MCR_SHAPE_SPHERE:
        k[3] = shape->radius;
        k[4] = shape->radius * shape->radius;
        break;
    case MCR_SHAPE_PARALLELOGRAM:
        if (rectangle_constants(shape, to))
            break;
        /* fall through */
    case MCR_SHAPE_DISK:
        memcpy(k + 3, shape->n, 3 * sizeof *k);
        dual(shape->e[0], shape->e[1], shape->n, k + 6);
        dual(shape->e[1], shape->e[0], shape->n, k + 9);
        break;
    case MCR_SHAPE_BOX:
        if (!upright_constants(shape, to))
            box_constants(shape, k);
        break;
    default: /* ellipsoid: the inverse of the matrix whose columns are e[0..2] */
        dual(shape->e[0], shape->e[1], shape->e[2], k + 3);
        dual(shape->e[1], shape->e[2], shape->e[0], k + 6);
        dual(shape->e[2], shape->e[0], shape->e[1], k + 9);
    }
}

struct bounds {
    double lo[3], hi[3];
};

static void bounds_empty(struct bounds *b)
{
    for (int j = 0; j < 3; j++) {
        b->lo[j] = INFINITY;
        b->hi[j] = -INFINITY;
    }
}

static void bounds_point(struct bounds *b, const double p[3])
{
    for (int j = 0; j < 3; j++) {
        b->lo[j] = p[j] < b->lo[j] ? p[j] : b->lo[j];
        b->hi[j] = p[j] > b->hi[j] ? p[j] : b->hi[j];
    }
}

static void bounds_join(struct bounds *b, const struct bounds *with)
{
    bounds_point(b, with->lo);
    bounds_point(b, with->hi);
}

static double bounds_area(const struct bounds *b)
{
    double x = b->hi[0] - b->lo[0], y = b->hi[1] - b->lo[1], z = b->hi[2] - b->lo[2];
    return x >= 0 ? x * y + y * z + z * x : 0;
}

/*
 * Moves the sides out by 64 u of the largest magnitude in the box: the kernels' crossings lie off the exact surface by a few u of the coordinates
 * and radii they work with, and a box holds its shape's centre and edges.
 */
static void bounds_pad(struct bounds *b)
{
    double reach = 0;
    for (int j = 0; j < 3; j++) {
        reach = fabs(b->lo[j]) > reach ? fabs(b->lo[j]) : reach;
        reach = fabs(b->hi[j]) > reach ? fabs(b->hi[j]) : reach;
    }
    for (int j = 0; j < 3; j++) {
        b->lo[j] -= 64 * 0x1p-53 * reach;
        b->hi[j] += 64 * 0x1p-53 * reach;
    }
}

static void shape_bounds(const struct mcr_shape *shape, struct bounds *b)
{
    bounds_empty(b);
    if (shape->kind == MCR_SHAPE_PARALLELOGRAM || shape->kind == MCR_SHAPE_BOX) {
        int corners = shape->kind == MCR_SHAPE_BOX ? 8 : 4;
        for (int i = 0; i < corners; i++) {
            double p[3];
            for (int j = 0; j < 3; j++)
                p[j] = shape->c[j] + (i & 1 ? shape->e[0][j] : 0) + (i & 2 ? shape->e[1][j] : 0) + (i & 4 ? shape->e[2][j] : 0);
            bounds_point(b, p);
        }
    } else {
        for (int j = 0; j < 3; j++) {
            double square = shape->e[0][j] * shape->e[0][j] + shape->e[1][j] * shape->e[1][j];
            if (shape->kind == MCR_SHAPE_ELLIPSOID)
                square += shape->e[2][j] * shape->e[2][j];
            double reach = shape->kind == MCR_SHAPE_SPHERE ? shape->radius : sqrt(square);
            b->lo[j] = shape->c[j] - reach;
            b->hi[j] = shape->c[j] + reach;
        }
    }
    bounds_pad(b);
}

static void triangle_bounds(const struct mcr_triangles *triangles, uint32_t f, struct bounds *b)
{
    bounds_empty(b);
    for (int i = 0; i < 3; i++) {
        uint32_t v = triangles->vertex[f][i];
        double p[3] = {triangles->x[v], triangles->y[v], triangles->z[v]};
        bounds_point(b, p);
    }
    bounds_pad(b);
}

struct builder {
    struct mcr_accel *accel;
    struct bounds *bounds; /* of each item, by its index before sorting */
};

static double centre(const struct builder *to, uint32_t item, int axis)
{
    return to->bounds[item].lo[axis] / 2 + to->bounds[item].hi[axis] / 2;
}

/* Splits items by bins of equal width along one axis; returns the cost of the best split (areas times counts) and its bin. */
static double best_split(const struct builder *to, const uint32_t *item, uint32_t count, int axis, double lo, double hi, int *split)
{
    struct bounds bin[BINS];
    uint32_t in[BINS] = {0};
    double right_area[BINS], cost, best = INFINITY;
    for (int i = 0; i < BINS; i++)
        bounds_empty(&bin[i]);
    for (uint32_t i = 0; i < count; i++) {
        int k = (int)((centre(to, item[i], axis) - lo) / (hi - lo) * BINS);
        k = k < 0 ? 0 : k >= BINS ? BINS - 1 : k;
        in[k]++;
        bounds_join(&bin[k], &to->bounds[item[i]]);
    }
    struct bounds right;
    bounds_empty(&right);
    for (int i = BINS - 1; i > 0; i--) {
        bounds_join(&right, &bin[i]);
        right_area[i] = bounds_area(&right);
    }
    struct bounds left;
    uint32_t left_count = 0;
    bounds_empty(&left);
    for (int i = 0; i + 1 < BINS; i++) {
        bounds_join(&left, &bin[i]);
        left_count += in[i];
        if (!left_count || left_count == count)
            continue;
        cost = bounds_area(&left) * left_count + right_area[i + 1] * (count - left_count);
        if (cost < best) {
            best = cost;
            *split = i;
        }
    }
    return best;
}

/* Reorders item[0..count) so that the first part's centres lie below the split; returns the part's size, in 1 .. count-1. */
static uint32_t partition(const struct builder *to, uint32_t *item, uint32_t count, uint32_t depth)
{
    struct bounds centres;
    int axis = 0, split = -1;
    double best = INFINITY;
    bounds_empty(&centres);
    for (uint32_t i = 0; i < count; i++) {
        double p[3] = {centre(to, item[i], 0), centre(to, item[i], 1), centre(to, item[i], 2)};
        bounds_point(&centres, p);
    }
    for (int j = 0; j < 3 && depth < SAH_DEPTH; j++) {
        int at = -1;
        double cost = centres.hi[j] > centres.lo[j] ? best_split(to, item, count, j, centres.lo[j], centres.hi[j], &at) : INFINITY;
        if (cost < best) {
            best = cost;
            axis = j;
            split = at;
        }
    }
    if (split < 0)
        return count / 2; /* no extent to split along, or too deep: any halves will do */
    uint32_t low = 0;
    double lo = centres.lo[axis], hi = centres.hi[axis];
    for (uint32_t i = 0; i < count; i++) {
        int k = (int)((centre(to, item[i], axis) - lo) / (hi - lo) * BINS);
        if (k <= split) {
            uint32_t swap = item[i];
            item[i] = item[low];
            item[low++] = swap;
        }
    }
    return low && low < count ? low : count / 2;
}

static void build_node(struct builder *to, uint32_t number, uint32_t first, uint32_t count, uint32_t depth)
{
    struct mcr_accel *accel = to->accel;
    struct mcr_bvh_node *node = &accel->node[number];
    struct bounds b;
    bounds_empty(&b);
    for (uint32_t i = 0; i < count; i++)
        bounds_join(&b, &to->bounds[accel->item[first + i]]);
    memcpy(node->lo, b.lo, sizeof b.lo);
    memcpy(node->hi, b.hi, sizeof b.hi);
    if (count <= LEAF_ITEMS) {
        node->first = first;
        node->count = count;
        return;
    }
    uint32_t low = partition(to, accel->item + first, count, depth);
    node->first = accel->node_count;
    node->count = 0;
    accel->node_count += 2;
    build_node(to, accel->node[number].first, first, low, depth + 1);
    build_node(to, accel->node[number].first + 1, first + low, count - low, depth + 1);
}

static int build_tree(struct mcr_arena *arena, struct mcr_accel *accel, const struct mcr_scene *scene)
{
    size_t items = (size_t)scene->shape_count + scene->triangles.count, bounded = 0;
    struct builder to = {accel, malloc((items ? items : 1) * sizeof *to.bounds)};
    accel->plane = mcr_arena_alloc(arena, scene->shape_count, sizeof *accel->plane);
    accel->item = mcr_arena_alloc(arena, items, sizeof *accel->item);
    accel->node = mcr_arena_alloc(arena, 2 * items + 1, sizeof *accel->node);
    if (!to.bounds || !accel->plane || !accel->item || !accel->node) {
        free(to.bounds);
        return -1;
    }
    for (uint32_t i = 0; i < items; i++) {
        if (i >= scene->shape_count)
            triangle_bounds(&scene->triangles, i - scene->shape_count, &to.bounds[i]);
        else if (scene->shape[i].kind != MCR_SHAPE_PLANE)
            shape_bounds(&scene->shape[i], &to.bounds[i]);
        else {
            accel->plane[accel->plane_count++] = i;
            continue;
        }
        accel->item[bounded++] = i;
    }
    if (bounded) {
        accel->node_count = 1;
        build_node(&to, 0, 0, (uint32_t)bounded, 0);
    }
    free(to.bounds);
    return 0;
}

struct mcr_accel *mcr_accel_create(struct mcr_arena *arena, const struct mcr_scene *scene, uint32_t kind)
{
    struct mcr_accel *accel = mcr_arena_alloc(arena, 1, sizeof *accel);
    if (!accel)
        return NULL;
    if (kind == MCR_ACCEL_AUTO)
        kind = (uint64_t)scene->shape_count + scene->triangles.count <= MCR_ACCEL_LIST_LIMIT ? MCR_ACCEL_LIST : MCR_ACCEL_BVH;
    accel->kind = kind;
    accel->shape_count = scene->shape_count;
    accel->triangles = &scene->triangles;
    accel->shape = mcr_arena_alloc(arena, scene->shape_count, sizeof *accel->shape);
    if (!accel->shape)
        return NULL;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        shape_constants(&scene->shape[i], &accel->shape[i]);
        accel->inverses |= accel->shape[i].kind >= MCR_ACCEL_RECTANGLE;
    }
    if (kind == MCR_ACCEL_BVH && build_tree(arena, accel, scene))
        return NULL;
    return accel;
}
