/* SPDX-License-Identifier: Apache-2.0 */
/* Building accelerators: the kernels' constants of each shape, and the tree of boxes over them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel.h"

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

/* Each side by itself: joined with empty bounds, nothing changes. */
static void bounds_join(struct bounds *b, const struct bounds *with)
{
    for (int j = 0; j < 3; j++) {
        b->lo[j] = with->lo[j] < b->lo[j] ? with->lo[j] : b->lo[j];
        b->hi[j] = with->hi[j] > b->hi[j] ? with->hi[j] : b->hi[j];
    }
}

static double bounds_area(const struct bounds *b)
{
    double x = b->hi[0] - b->lo[0], y = b->hi[1] - b->lo[1], z = b->hi[2] - b->lo[2];
    return x >= 0 ? x * y + y * z + z * x : 0;
}

/*
 * Moves the sides out by 64 u of the largest magnitude in the box: the kernels' crossings lie off the exact surface by a few u of the coordinates
 * and radii they work with, and a box holds its shape's centre and edges. But not across `flat`, the axis of a rectangle (or -1): there the box is
 * entered where the kernel's crossing is, by the same arithmetic. Rays that leave the rectangle or end at it do not come into its box.
 */
static void bounds_pad(struct bounds *b, int flat)
{
    double reach = 0;
    for (int j = 0; j < 3; j++) {
        reach = fabs(b->lo[j]) > reach ? fabs(b->lo[j]) : reach;
        reach = fabs(b->hi[j]) > reach ? fabs(b->hi[j]) : reach;
    }
    for (int j = 0; j < 3; j++) {
        if (j == flat)
            continue;
        b->lo[j] -= 64 * 0x1p-53 * reach;
        b->hi[j] += 64 * 0x1p-53 * reach;
    }
}

static void shape_bounds(const struct mcr_shape *shape, uint32_t kind, struct bounds *b)
{
    int flat = kind >= MCR_ACCEL_RECTANGLE && kind < MCR_ACCEL_RECTANGLE + 3 ? (int)(kind - MCR_ACCEL_RECTANGLE) : -1;
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
    bounds_pad(b, flat);
}

static void triangle_bounds(const struct mcr_triangles *triangles, uint32_t f, struct bounds *b)
{
    bounds_empty(b);
    for (int i = 0; i < 3; i++) {
        uint32_t v = triangles->vertex[f][i];
        double p[3] = {triangles->x[v], triangles->y[v], triangles->z[v]};
        bounds_point(b, p);
    }
    bounds_pad(b, -1);
}

/* A node of the tree of two children, from which the wide one is made. */
struct branch {
    struct bounds bounds;
    uint32_t first;        /* inner: the left child, the right one follows it; leaf: the first of its items */
    uint32_t count;        /* leaf: items, else 0 */
};

struct builder {
    struct mcr_accel *accel;
    const struct mcr_triangles *triangles;
    struct bounds *bounds; /* of each item, by its number */
    uint32_t *item;        /* a shape's index, or shape_count + a triangle's; sorted by the tree */
    struct branch *branch;
    uint32_t branch_count;
    uint32_t node_count;   /* of the wide tree, so far */
    uint64_t line_count;   /* of its packets */
};

static double centre(const struct builder *to, uint32_t item, int axis)
{
    return to->bounds[item].lo[axis] / 2 + to->bounds[item].hi[axis] / 2;
}

/* Packets that so many items of one kind fill. */
static double packets(uint32_t count)
{
    return (count + MCR_BVH_WIDTH - 1) / MCR_BVH_WIDTH;
}

/* Splits items by bins of equal width along one axis; returns the cost of the best split (areas times packets) and its bin. */
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
        cost = bounds_area(&left) * packets(left_count) + right_area[i + 1] * packets(count - left_count);
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

static uint32_t kind_of(const struct builder *to, uint32_t item)
{
    return item < to->accel->shape_count ? to->accel->shape[item].kind : MCR_ACCEL_TRIANGLE;
}

/* Whether the items make one packet. */
static int is_packet(const struct builder *to, const uint32_t *item, uint32_t count)
{
    if (count > MCR_BVH_WIDTH)
        return 0;
    for (uint32_t i = 1; i < count; i++)
        if (kind_of(to, item[i]) != kind_of(to, item[0]))
            return 0;
    return 1;
}

static void build_branch(struct builder *to, uint32_t number, uint32_t first, uint32_t count, uint32_t depth)
{
    struct branch *branch = &to->branch[number];
    bounds_empty(&branch->bounds);
    for (uint32_t i = 0; i < count; i++)
        bounds_join(&branch->bounds, &to->bounds[to->item[first + i]]);
    if (is_packet(to, to->item + first, count)) {
        branch->first = first;
        branch->count = count;
        return;
    }
    uint32_t low = partition(to, to->item + first, count, depth);
    branch->first = to->branch_count;
    branch->count = 0;
    to->branch_count += 2;
    build_branch(to, branch->first, first, low, depth + 1);
    build_branch(to, branch->first + 1, first + low, count - low, depth + 1);
}

/* Rows of constants in a packet. */
static uint32_t rows_of(uint32_t kind)
{
    switch (kind) {
    case MCR_SHAPE_SPHERE:
        return 5;
    case MCR_SHAPE_BOX:
        return 15;
    case MCR_ACCEL_RECTANGLE:
    case MCR_ACCEL_RECTANGLE + 1:
    case MCR_ACCEL_RECTANGLE + 2:
        return 5;
    case MCR_ACCEL_UPRIGHT:
    case MCR_ACCEL_UPRIGHT + 1:
    case MCR_ACCEL_UPRIGHT + 2:
        return 11;
    case MCR_ACCEL_TRIANGLE:
        return 9;
    default: /* parallelogram, disk, ellipsoid */
        return 12;
    }
}

static void fill_packet(const struct builder *to, const struct branch *leaf, struct mcr_bvh_packet *packet)
{
    const struct mcr_triangles *m = to->triangles;
    const uint32_t *item = to->item + leaf->first;
    packet->kind = kind_of(to, item[0]);
    packet->count = leaf->count;
    for (uint32_t i = 0; i < MCR_BVH_WIDTH; i++) {
        uint32_t from = item[i < leaf->count ? i : 0];
        if (packet->kind != MCR_ACCEL_TRIANGLE) {
            packet->primitive[i] = to->accel->shape[from].primitive;
            for (uint32_t row = 0; row < rows_of(packet->kind); row++)
                packet->k[row][i] = to->accel->shape[from].k[row];
            continue;
        }
        uint32_t f = from - to->accel->shape_count;
        packet->primitive[i] = m->first_primitive + f;
        for (uint32_t j = 0; j < 3; j++) {
            uint32_t v = m->vertex[f][j];
            packet->k[3 * j][i] = m->x[v];
            packet->k[3 * j + 1][i] = m->y[v];
            packet->k[3 * j + 2][i] = m->z[v];
        }
    }
}

/* The child of a wide node that a branch becomes; in the first pass, without `node`, it is counted only. */
static uint32_t make_packet(struct builder *to, const struct branch *leaf)
{
    uint32_t line = (uint32_t)to->line_count;
    to->line_count += 1 + rows_of(kind_of(to, to->item[leaf->first])) * MCR_BVH_WIDTH * (uint32_t)sizeof(double) / MCR_BVH_LINE;
    if (to->accel->packet)
        fill_packet(to, leaf, (struct mcr_bvh_packet *)(void *)(to->accel->packet + (size_t)line * MCR_BVH_LINE));
    return line | MCR_BVH_PACKET;
}

/* The branches that become a node's children: those of the largest area are replaced by their two halves for as long as there is room. */
static uint32_t open_branches(const struct builder *to, uint32_t number, uint32_t child[MCR_BVH_WIDTH])
{
    uint32_t count = 1;
    for (child[0] = number; count < MCR_BVH_WIDTH; count++) {
        int widest = -1;
        double area = -1;
        for (uint32_t i = 0; i < count; i++) {
            const struct branch *branch = &to->branch[child[i]];
            if (!branch->count && bounds_area(&branch->bounds) > area) {
                area = bounds_area(&branch->bounds);
                widest = (int)i;
            }
        }
        if (widest < 0)
            break;
        uint32_t first = to->branch[child[widest]].first;
        child[widest] = first;
        child[count] = first + 1;
    }
    return count;
}

/* Two passes: the first, without accel->node, counts nodes and lines; the second fills them. Returns the node's number. */
static uint32_t make_node(struct builder *to, uint32_t number)
{
    uint32_t child[MCR_BVH_WIDTH], made = to->node_count++, count = open_branches(to, number, child);
    for (uint32_t i = 0; i < count; i++) {
        const struct branch *branch = &to->branch[child[i]];
        uint32_t is = branch->count ? make_packet(to, branch) : make_node(to, child[i]);
        if (!to->accel->node)
            continue;
        struct mcr_bvh_node *node = &to->accel->node[made];
        node->child[i] = is;
        for (int j = 0; j < 3; j++) {
            node->side[0][j][i] = branch->bounds.lo[j];
            node->side[1][j][i] = branch->bounds.hi[j];
        }
    }
    for (uint32_t i = count; to->accel->node && i < MCR_BVH_WIDTH; i++)
        for (int j = 0; j < 3; j++) {
            to->accel->node[made].side[0][j][i] = INFINITY;
            to->accel->node[made].side[1][j][i] = -INFINITY;
        }
    return made;
}

static int make_tree(struct mcr_arena *arena, struct builder *to, uint32_t bounded)
{
    struct mcr_accel *accel = to->accel;
    if (!bounded)
        return 0;
    to->branch = malloc(2 * (size_t)bounded * sizeof *to->branch);
    if (!to->branch)
        return -1;
    to->branch_count = 1;
    build_branch(to, 0, 0, bounded, 0);
    make_node(to, 0);
    if (to->line_count > MCR_BVH_PACKET) /* 128 GiB: more than a child can name */
        return -1;
    accel->node_count = to->node_count;
    accel->packet = mcr_arena_alloc(arena, to->line_count, MCR_BVH_LINE);
    accel->node = accel->packet ? mcr_arena_alloc(arena, to->node_count, sizeof *accel->node) : NULL;
    if (!accel->node)
        return -1;
    to->node_count = to->line_count = 0;
    make_node(to, 0);
    return 0;
}

/* ---- wide shapes -------------------------------------------------------------------------------------------------- */

/*
 * What nearly every ray comes near is not worth finding: a shape whose bounds have this part or more of the surface of the tree's bounds is tested
 * for a whole block of rays at once, which costs about an eighth of what it costs one ray after the other. So do planes, which have no bounds.
 * Without the walls of a room its tree is smaller, and many rays pass it by.
 */
#define WIDE_PART 0.125
#define WIDE_MOST 16u /* of those with bounds */

/* The items of largest bounds, the largest first; returns their number. */
static uint32_t largest_items(const struct builder *to, uint32_t count, uint32_t most[WIDE_MOST])
{
    double area[WIDE_MOST];
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t item = to->item[i], at = found < WIDE_MOST ? found : WIDE_MOST;
        double own = bounds_area(&to->bounds[item]);
        for (; at > 0 && area[at - 1] < own; at--)
            if (at < WIDE_MOST) {
                area[at] = area[at - 1];
                most[at] = most[at - 1];
            }
        if (at == WIDE_MOST)
            continue;
        area[at] = own;
        most[at] = item;
        found += found < WIDE_MOST;
    }
    return found;
}

static int by_number(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Takes the wide ones from the items; returns how many are left for the tree. */
static uint32_t take_wide(struct builder *to, uint32_t count)
{
    struct mcr_accel *accel = to->accel;
    uint32_t most[WIDE_MOST], candidates = largest_items(to, count, most), wide = 0, left = 0;
    struct bounds all[WIDE_MOST + 1]; /* all[k]: of everything but the k largest */
    bounds_empty(&all[candidates]);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t k = 0;
        while (k < candidates && most[k] != to->item[i])
            k++;
        if (k == candidates)
            bounds_join(&all[candidates], &to->bounds[to->item[i]]);
    }
    for (uint32_t k = candidates; k-- > 0;) {
        all[k] = all[k + 1];
        bounds_join(&all[k], &to->bounds[most[k]]);
    }
    while (wide < candidates && bounds_area(&to->bounds[most[wide]]) >= WIDE_PART * bounds_area(&all[wide]))
        accel->wide[accel->wide_count++] = most[wide++];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t k = 0;
        while (k < wide && most[k] != to->item[i])
            k++;
        if (k == wide)
            to->item[left++] = to->item[i];
    }
    qsort(accel->wide, accel->wide_count, sizeof *accel->wide, by_number);
    memcpy(accel->lo, all[wide].lo, sizeof accel->lo);
    memcpy(accel->hi, all[wide].hi, sizeof accel->hi);
    return left;
}

static int build_tree(struct mcr_arena *arena, struct mcr_accel *accel, const struct mcr_scene *scene)
{
    size_t items = (size_t)scene->shape_count + scene->triangles.count;
    uint32_t bounded = 0;
    struct builder to = {.accel = accel, .triangles = &scene->triangles};
    int status = -1;
    accel->wide = mcr_arena_alloc(arena, (size_t)scene->shape_count + WIDE_MOST, sizeof *accel->wide); /* all may be planes */
    to.bounds = malloc((items + 1) * sizeof *to.bounds);
    to.item = malloc((items + 1) * sizeof *to.item);
    if (!accel->wide || !to.bounds || !to.item)
        goto done;
    for (uint32_t i = 0; i < items; i++) {
        if (i >= scene->shape_count)
            triangle_bounds(&scene->triangles, i - scene->shape_count, &to.bounds[i]);
        else if (scene->shape[i].kind != MCR_SHAPE_PLANE)
            shape_bounds(&scene->shape[i], accel->shape[i].kind, &to.bounds[i]);
        else {
            accel->wide[accel->wide_count++] = i;
            continue;
        }
        to.item[bounded++] = i;
    }
    status = make_tree(arena, &to, take_wide(&to, bounded));
done:
    free(to.bounds);
    free(to.item);
    free(to.branch);
    return status;
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
