/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Building the tree of many emitters: a binary tree first, split where the surface area orientation heuristic of Conty Estevez and Kulla
 * (2018, section 4.4) is least, then wide nodes made of it. O(n log n) time; some 300 bytes an emitter, half of them working memory.
 */
#include "core/emitter_tree.h"
#include "core/emitter_lanes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/cell.h"
#include "scene/vector.h"
#include <mcrender/material.h>

/*
 * Boxes are a few thousand roundings larger than what is in them: whether a ray crosses at a very edge may be decided either way, but not
 * by the box.
 */
#define SLACK (4096 * MCR_ROUNDING)

#define BINS 12
#define BOTH_SIDES (MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK)

/* Powers below this, of the power of all, are taken for it: products of them with squares of lengths stay above 1e-300. */
#define LEAST_POWER 1e-90

struct item {
    double lo[3], hi[3], n[3]; /* n: unit, toward the emitting side; 0 where all directions are alike */
    double power;
    uint32_t emitter;
};

/* A node of the binary tree over items first .. first + count - 1; its left child follows it. */
struct branch {
    double cost;
    uint32_t first, count, right;
};

struct builder {
    struct mcr_emitters *all;
    struct item *item;
    struct branch *branch;
    uint32_t branches;
    uint32_t nodes;
    struct mcr_emitter_node *node;
    struct mcr_emitter_bounds *bounds;
    uint64_t *place;
};

/* ---- items ----------------------------------------------------------------------------------------------------------- */

/* Adds c + s e0 + t e1 to a box. */
static void include(struct item *item, const double *k, double s, double t)
{
    for (int i = 0; i < 3; i++) {
        double x = k[MCR_K_C + i] + s * k[MCR_K_E0 + i] + t * k[MCR_K_E1 + i];
        item->lo[i] = fmin(item->lo[i], x);
        item->hi[i] = fmax(item->hi[i], x);
    }
}

static void bound(const struct mcr_emitters *all, uint32_t e, struct item *item)
{
    const double *k = all->k[e];
    uint32_t kind = all->emitter[e].kind;
    for (int i = 0; i < 3; i++) {
        double third = kind == MCR_EMITTER_ELLIPSOID ? k[MCR_K_N + i] : 0, a = k[MCR_K_E0 + i], b = k[MCR_K_E1 + i];
        double half = kind == MCR_EMITTER_SPHERE ? k[MCR_K_RADIUS] : sqrt(a * a + b * b + third * third);
        item->lo[i] = k[i] - (kind <= MCR_EMITTER_TRIANGLE ? 0 : half);
        item->hi[i] = k[i] + (kind <= MCR_EMITTER_TRIANGLE ? 0 : half);
    }
    if (kind <= MCR_EMITTER_TRIANGLE) {
        include(item, k, 1, 0);
        include(item, k, 0, 1);
    }
    if (kind == MCR_EMITTER_PARALLELOGRAM)
        include(item, k, 1, 1);
    for (int i = 0; i < 3; i++) {
        double slack = SLACK * (fabs(item->lo[i]) + fabs(item->hi[i]) + (item->hi[i] - item->lo[i]));
        item->lo[i] -= slack;
        item->hi[i] += slack;
    }
}

static int is_flat(uint32_t kind)
{
    return kind != MCR_EMITTER_SPHERE && kind != MCR_EMITTER_ELLIPSOID;
}

static void make_item(const struct mcr_emitters *all, uint32_t e, struct item *item)
{
    const struct mcr_emitter *emitter = &all->emitter[e];
    bound(all, e, item);
    item->emitter = e;
    item->power = fmax(emitter->probability, LEAST_POWER) * (is_flat(emitter->kind) && emitter->sides != BOTH_SIDES ? 1 : 0.5);
    if (!is_flat(emitter->kind)) /* a quarter of a ball's surface is what a point sees, head on */
        item->power *= emitter->sides == BOTH_SIDES ? 0.25 : 0.5;
    memset(item->n, 0, sizeof item->n);
    if (is_flat(emitter->kind) && mcr_unit(all->k[e] + MCR_K_N, item->n) && emitter->sides == MCR_MATERIAL_EMITS_BACK)
        for (int i = 0; i < 3; i++)
            item->n[i] = -item->n[i];
}

/* ---- the binary tree -------------------------------------------------------------------------------------------------- */

/* A set of items, as the heuristic looks at it. */
struct heap {
    double lo[3], hi[3], n[3], power;
    uint32_t count;
};

static const struct heap nothing = {.lo = {INFINITY, INFINITY, INFINITY}, .hi = {-INFINITY, -INFINITY, -INFINITY}};

static void heap_add(struct heap *heap, const double *lo, const double *hi, const double *n, double power, uint32_t count)
{
    for (int i = 0; i < 3; i++) {
        heap->lo[i] = lo[i] < heap->lo[i] ? lo[i] : heap->lo[i];
        heap->hi[i] = hi[i] > heap->hi[i] ? hi[i] : heap->hi[i];
        heap->n[i] += n[i];
    }
    heap->power += power;
    heap->count += count;
}

/*
 * Power times surface area times the measure of directions that are lit, over pi: 1 for equal normals, 4 for the whole sphere. Between, it
 * follows the length of the mean normal, which is (1 + cos t) / 2 for normals that fill a cone of half angle t: no cone has to be merged
 * for a heuristic.
 */
static double heap_cost(const struct heap *heap)
{
    double d[3] = {heap->hi[0] - heap->lo[0], heap->hi[1] - heap->lo[1], heap->hi[2] - heap->lo[2]};
    double mean = sqrt(mcr_dot(heap->n, heap->n)) / heap->count, spread = 1 + 3 * fmin(1, 2 * fmax(0, 1 - mean));
    return heap->power * spread * (d[0] * d[1] + d[1] * d[2] + d[2] * d[0]);
}

static double middle(const struct item *item, int axis)
{
    return 0.5 * item->lo[axis] + 0.5 * item->hi[axis];
}

static int bin_of(const struct item *item, int axis, double low, double per)
{
    double at = (middle(item, axis) - low) * per;
    return at >= BINS - 1 ? BINS - 1 : at > 0 ? (int)at : 0;
}

static void swap_items(struct item *a, struct item *b)
{
    struct item swap = *a;
    *a = *b;
    *b = swap;
}

/* Puts the `half` smallest along an axis first (Hoare's selection). */
static void divide(struct item *item, uint32_t count, uint32_t half, int axis)
{
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        double pivot = middle(&item[low + (high - low) / 2], axis);
        uint32_t i = low, j = high;
        for (;;) {
            while (middle(&item[i], axis) < pivot)
                i++;
            while (middle(&item[j], axis) > pivot)
                j--;
            if (i >= j)
                break;
            swap_items(&item[i++], &item[j--]);
        }
        if (half <= j)
            high = j;
        else
            low = j + 1;
    }
}

struct split {
    double cost, low, per;
    int axis, bin; /* bins before it go left */
};

static void try_axis(const struct heap bin[BINS], int axis, double low, double per, double penalty, struct split *best)
{
    struct heap right[BINS], left = nothing;
    right[BINS - 1] = bin[BINS - 1];
    for (int b = BINS - 2; b > 0; b--) {
        right[b] = right[b + 1];
        heap_add(&right[b], bin[b].lo, bin[b].hi, bin[b].n, bin[b].power, bin[b].count);
    }
    for (int b = 1; b < BINS; b++) {
        heap_add(&left, bin[b - 1].lo, bin[b - 1].hi, bin[b - 1].n, bin[b - 1].power, bin[b - 1].count);
        if (left.count == 0 || right[b].count == 0)
            continue;
        double cost = penalty * (heap_cost(&left) + heap_cost(&right[b]));
        if (cost < best->cost)
            *best = (struct split){cost, low, per, axis, b};
    }
}

/* The best split of all axes; axis -1: none is better than halves. low, high: of the items' middles. */
static struct split find_split(const struct item *item, uint32_t count, const double low[3], const double high[3])
{
    struct split best = {.cost = INFINITY, .axis = -1};
    double longest = fmax(high[0] - low[0], fmax(high[1] - low[1], high[2] - low[2]));
    for (int axis = 0; axis < 3; axis++) {
        double length = high[axis] - low[axis], per = BINS / length;
        struct heap bin[BINS];
        if (!(length > 0) || !(per < INFINITY))
            continue;
        for (int b = 0; b < BINS; b++)
            bin[b] = nothing;
        for (uint32_t n = 0; n < count; n++)
            heap_add(&bin[bin_of(&item[n], axis, low[axis], per)], item[n].lo, item[n].hi, item[n].n, item[n].power, 1);
        try_axis(bin, axis, low[axis], per, longest / length, &best);
    }
    return best;
}

/* Orders the items so that the left child's come first; returns their number. */
static uint32_t split_items(struct item *item, uint32_t count, uint32_t depth)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t n = 0; n < count; n++)
        for (int i = 0; i < 3; i++) {
            low[i] = fmin(low[i], middle(&item[n], i));
            high[i] = fmax(high[i], middle(&item[n], i));
        }
    struct split split = {.axis = -1};
    if (depth < MCR_TREE_BY_COST && count > 2)
        split = find_split(item, count, low, high);
    if (split.axis >= 0) {
        uint32_t left = 0;
        for (uint32_t n = 0; n < count; n++)
            if (bin_of(&item[n], split.axis, split.low, split.per) < split.bin)
                swap_items(&item[left++], &item[n]);
        return left;
    }
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (high[i] - low[i] > high[axis] - low[axis])
            axis = i;
    divide(item, count, count / 2, axis);
    return count / 2;
}

static void grow(struct builder *b, uint32_t first, uint32_t count, uint32_t depth)
{
    struct branch *here = &b->branch[b->branches++];
    struct heap heap = nothing;
    for (uint32_t n = first; n < first + count; n++)
        heap_add(&heap, b->item[n].lo, b->item[n].hi, b->item[n].n, b->item[n].power, 1);
    *here = (struct branch){heap_cost(&heap), first, count, 0};
    if (count == 1)
        return;
    uint32_t left = split_items(b->item + first, count, depth);
    grow(b, first, left, depth + 1);
    here->right = b->branches;
    grow(b, first + left, count - left, depth + 1);
}

/* ---- bounds of light ---------------------------------------------------------------------------------------------------- */

/* What a subtree's light is bounded by. The cone is of half angle `angle` around `axis`. */
struct light {
    double lo[3], hi[3], axis[3], angle, power;
    int folds; /* both sides of the cone emit */
    int inner; /* nothing in it is seen from outside its ball */
};

/* A cone around both (Conty Estevez and Kulla, algorithm 1). A two-sided cone may be turned over. */
static void cone_merge(struct light *a, const struct light *b)
{
    const struct light *wide = a->angle >= b->angle ? a : b, *slim = wide == a ? b : a;
    double other[3], cross[3], aside[3], sine, cosine, between, angle, s, c;
    mcr_copy(slim->axis, other);
    a->folds |= b->folds;
    if (a->folds && mcr_dot(wide->axis, other) < 0)
        for (int i = 0; i < 3; i++)
            other[i] = -other[i];
    mcr_cross(wide->axis, other, cross);
    sine = mcr_length(cross), cosine = mcr_dot(wide->axis, other);
    between = mcr_atan2(sine, cosine);
    angle = 0.5 * (wide->angle + between + slim->angle);
    if (fmin(between + slim->angle, MCR_PI) <= wide->angle) {
        angle = wide->angle;
        mcr_copy(wide->axis, a->axis);
    } else if (angle >= MCR_PI || !(sine > 1e-9)) {
        /* opposite, or as good as equal */
        mcr_copy(wide->axis, a->axis);
        angle = cosine > 0 ? fmin(MCR_PI, wide->angle + slim->angle + 2e-9) : MCR_PI;
    } else {
        mcr_cross(cross, wide->axis, aside); /* of length `sine`, orthogonal to the axis, toward the other one */
        mcr_sincos_turns((angle - wide->angle) / (2 * MCR_PI), &s, &c);
        double turned[3] = {c * wide->axis[0] + s / sine * aside[0], c * wide->axis[1] + s / sine * aside[1],
                            c * wide->axis[2] + s / sine * aside[2]};
        mcr_unit(turned, a->axis);
    }
    a->angle = angle;
}

static void light_merge(struct light *a, const struct light *b)
{
    for (int i = 0; i < 3; i++) {
        a->lo[i] = fmin(a->lo[i], b->lo[i]);
        a->hi[i] = fmax(a->hi[i], b->hi[i]);
    }
    a->power += b->power;
    a->inner &= b->inner;
    cone_merge(a, b);
}

static struct light light_of(const struct builder *b, uint32_t n)
{
    const struct item *item = &b->item[n];
    const struct mcr_emitter *emitter = &b->all->emitter[item->emitter];
    struct light light = {.axis = {0, 0, 1}, .angle = MCR_PI, .power = item->power};
    mcr_copy(item->lo, light.lo);
    mcr_copy(item->hi, light.hi);
    if (is_flat(emitter->kind)) {
        mcr_copy(item->n, light.axis);
        light.angle = 0;
        light.folds = emitter->sides == BOTH_SIDES;
    } else {
        light.inner = emitter->sides == MCR_MATERIAL_EMITS_BACK;
    }
    return light;
}

/* The frame of a wide node that holds the box. */
static void set_frame(struct mcr_emitter_bounds *to, const struct light *whole)
{
    double extent = 0;
    int exponent;
    for (int i = 0; i < 3; i++) {
        double half = 0.5 * whole->hi[i] - 0.5 * whole->lo[i];
        to->origin[i] = 0.5 * whole->lo[i] + 0.5 * whole->hi[i];
        extent = fmax(extent, half + SLACK * (fabs(to->origin[i]) + half));
    }
    frexp(extent, &exponent);
    exponent = exponent < -1000 ? -1000 : exponent;
    to->scale = ldexp(1, -exponent);
}

/* No ray crosses the boxes of children that there are not. */
static void set_boxes(struct mcr_emitter_node *to, const struct light light[MCR_TREE_WIDTH])
{
    for (uint32_t i = 0; i < MCR_TREE_WIDTH; i++)
        for (int a = 0; a < 3; a++) {
            to->lo[a][i] = i < to->count ? light[i].lo[a] : INFINITY;
            to->hi[a][i] = i < to->count ? light[i].hi[a] : -INFINITY;
        }
}

/* alone: the emitter that the child is, or NULL. most: the largest power of the node's children. */
static void set_child(struct builder *b, uint32_t node, uint32_t slot, const struct light *light, double most,
                      const struct mcr_emitter *alone, const double *k)
{
    struct mcr_emitter_bounds *to = &b->bounds[node];
    double half[3], c[3], reach = 0, along = 0, off = 0, sine, cosine, chord, slack;
    for (int i = 0; i < 3; i++) {
        c[i] = 0.5 * light->lo[i] + 0.5 * light->hi[i];
        half[i] = 0.5 * light->hi[i] - 0.5 * light->lo[i];
        reach = fmax(reach, fabs(c[i]) + half[i]);
        along += fabs(light->axis[i]) * half[i];
        to->c[i][slot] = (float)((c[i] - to->origin[i]) * to->scale);
        to->axis[i][slot] = (float)light->axis[i];
    }
    slack = SLACK * reach + MCR_TREE_SLACK / to->scale;
    double radius = (alone && alone->kind == MCR_EMITTER_SPHERE ? k[MCR_K_RADIUS] : mcr_length(half)) + slack;
    mcr_sincos_turns(light->angle / (2 * MCR_PI), &sine, &cosine);
    chord = sqrt(2 * fmax(0, 1 - cosine)); /* how far normals are from the axis */
    for (int i = 0; i < 3; i++) /* the middle of a triangle's box is not in its plane */
        off += light->axis[i] * (c[i] - k[MCR_K_C + i]);
    double lift = alone && is_flat(alone->kind) ? fabs(off) + slack : fmin(radius, along + chord * radius + slack);
    radius *= to->scale;
    to->radius[slot] = (float)radius;
    to->lift[slot] = (float)(lift * to->scale);
    to->open[slot] = (float)(light->angle < 0.5 * MCR_PI ? sine : 1 - cosine) + MCR_TREE_GRACE;
    to->fold[slot] = light->folds ? -1 : 1;
    to->within[slot] = light->inner ? (float)(radius * radius) * (1 + MCR_TREE_GRACE) : INFINITY;
    to->power[slot] = fmaxf((float)(light->power / most) * MCR_TREE_POWER, MCR_TREE_LEAST_POWER);
}

/* ---- wide nodes ------------------------------------------------------------------------------------------------------------ */

/*
 * Which entry of a wide node to open next: the costliest of those that hold more than a node's worth of emitters; else the smallest that
 * there is room for. -1: none.
 */
static int next_to_open(const struct branch *branch, const uint32_t *entry, uint32_t entries)
{
    int best = -1;
    for (uint32_t i = 0; i < entries; i++)
        if (branch[entry[i]].count > MCR_TREE_WIDTH && (best < 0 || branch[entry[i]].cost > branch[entry[best]].cost))
            best = (int)i;
    if (best >= 0)
        return best;
    for (uint32_t i = 0; i < entries; i++) {
        uint32_t count = branch[entry[i]].count;
        if (count > 1 && entries - 1 + count <= MCR_TREE_WIDTH && (best < 0 || count < branch[entry[best]].count))
            best = (int)i;
    }
    return best;
}

/* The entries of the wide node that branch `at` becomes, in the order of their items. */
static uint32_t open_branch(const struct branch *branch, uint32_t at, uint32_t entry[MCR_TREE_WIDTH])
{
    uint32_t entries = 1;
    int open;
    entry[0] = at;
    while (entries < MCR_TREE_WIDTH && (open = next_to_open(branch, entry, entries)) >= 0) {
        memmove(entry + open + 2, entry + open + 1, (entries - 1 - (uint32_t)open) * sizeof *entry);
        entry[open + 1] = branch[entry[open]].right;
        entry[open]++;
        entries++;
    }
    return entries;
}

static uint32_t count_nodes(const struct branch *branch, uint32_t at)
{
    uint32_t entry[MCR_TREE_WIDTH], entries = open_branch(branch, at, entry), nodes = 1;
    for (uint32_t i = 0; i < entries; i++)
        if (branch[entry[i]].count > 1)
            nodes += count_nodes(branch, entry[i]);
    return nodes;
}

static struct light widen(struct builder *b, uint32_t at, uint64_t place)
{
    uint32_t entry[MCR_TREE_WIDTH], entries = open_branch(b->branch, at, entry), here = b->nodes++;
    struct light light[MCR_TREE_WIDTH], whole;
    double most = 0;
    b->node[here].count = b->bounds[here].count = entries;
    b->bounds[here].place = place;
    for (uint32_t i = 0; i < entries; i++) {
        uint32_t first = b->branch[entry[i]].first;
        int alone = b->branch[entry[i]].count == 1;
        b->node[here].child[i] = b->bounds[here].child[i] = alone ? ~(int32_t)first : (int32_t)b->nodes;
        light[i] = alone ? light_of(b, first) : widen(b, entry[i], MCR_TREE_PLACE(here, i));
        if (alone)
            b->place[first] = MCR_TREE_PLACE(here, i);
        if (i == 0)
            whole = light[i];
        else
            light_merge(&whole, &light[i]);
        most = fmax(most, light[i].power);
    }
    set_frame(&b->bounds[here], &whole);
    for (uint32_t i = 0; i < entries; i++) {
        uint32_t e = b->item[b->branch[entry[i]].first].emitter;
        set_child(b, here, i, &light[i], most, b->branch[entry[i]].count == 1 ? &b->all->emitter[e] : NULL, b->all->k[e]);
    }
    set_boxes(&b->node[here], light);
    return whole;
}

/* Puts the emitters into the order of the leaves, in place, cycle by cycle. */
static void reorder(struct mcr_emitters *all, struct item *item)
{
    for (uint32_t start = 0; start < all->count; start++) {
        struct mcr_emitter emitter = all->emitter[start];
        double k[MCR_K_SIZE];
        memcpy(k, all->k[start], sizeof k);
        for (uint32_t to = start, from = item[to].emitter; from != to; to = from, from = item[to].emitter) {
            int last = from == start;
            all->emitter[to] = last ? emitter : all->emitter[from];
            memcpy(all->k[to], last ? k : all->k[from], sizeof k);
            item[to].emitter = to;
            if (last)
                break;
        }
    }
}

static int build(struct builder *b, struct mcr_arena *arena)
{
    struct mcr_emitters *all = b->all;
    for (uint32_t e = 0; e < all->count; e++)
        make_item(all, e, &b->item[e]);
    grow(b, 0, all->count, 0);
    uint32_t nodes = count_nodes(b->branch, 0);
    b->node = mcr_arena_alloc(arena, nodes, sizeof *b->node);
    b->bounds = mcr_arena_alloc(arena, nodes, sizeof *b->bounds);
    b->place = mcr_arena_alloc(arena, all->count, sizeof *b->place);
    if (!b->node || !b->bounds || !b->place)
        return -1;
    widen(b, 0, MCR_TREE_ROOT);
    all->node = b->node;
    all->bounds = b->bounds;
    all->place = b->place;
    all->tree_bytes = nodes * (sizeof *b->node + sizeof *b->bounds) + all->count * sizeof *b->place;
    reorder(all, b->item);
    return 0;
}

int mcr_emitter_tree_build(struct mcr_emitters *all, struct mcr_arena *arena)
{
    struct builder b = {.all = all, .item = calloc(all->count, sizeof *b.item), .branch = calloc(2 * (size_t)all->count, sizeof *b.branch)};
    int status = b.item && b.branch ? build(&b, arena) : -1;
    free(b.item);
    free(b.branch);
    return status;
}
