/* SPDX-License-Identifier: Apache-2.0 */
/* Many emitters are put into a tree of boxes, so that a ray is tested against few of them. */
#include "core/emitter_lanes.h"

#include <math.h>
#include <string.h>

#include "scene/vector.h"

/*
 * Boxes are a few thousand roundings larger than what is in them: whether a ray crosses at a very edge may be decided either way, but not
 * by the box.
 */
#define SLACK (4096 * MCR_ROUNDING)

struct item {
    double lo[3], hi[3];
    uint32_t emitter;
};

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
    item->emitter = e;
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

static double middle(const struct item *item, int axis)
{
    return item->lo[axis] + item->hi[axis];
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
            struct item swap = item[i];
            item[i++] = item[j];
            item[j--] = swap;
        }
        if (half <= j)
            high = j;
        else
            low = j + 1;
    }
}

/* Depth first: the left child follows its parent. Returns the number of the first node after it. */
static uint32_t grow(struct mcr_emitter_node *node, uint32_t at, struct item *item, uint32_t first, uint32_t count)
{
    struct mcr_emitter_node *here = &node[at];
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    memcpy(here->lo, item[first].lo, sizeof here->lo);
    memcpy(here->hi, item[first].hi, sizeof here->hi);
    for (uint32_t n = first; n < first + count; n++)
        for (int i = 0; i < 3; i++) {
            here->lo[i] = fmin(here->lo[i], item[n].lo[i]);
            here->hi[i] = fmax(here->hi[i], item[n].hi[i]);
            low[i] = fmin(low[i], middle(&item[n], i));
            high[i] = fmax(high[i], middle(&item[n], i));
        }
    here->first = first;
    here->count = count;
    if (count <= MCR_EMITTER_LEAF)
        return at + 1;
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (high[i] - low[i] > high[axis] - low[axis])
            axis = i;
    uint32_t half = count / 2;
    divide(item + first, count, half, axis);
    here->count = 0;
    here->right = grow(node, at + 1, item, first, half);
    return grow(node, here->right, item, first + half, count - half);
}

int mcr_emitter_tree_build(struct mcr_emitters *all, struct mcr_arena *arena)
{
    struct item *item = mcr_arena_alloc(arena, all->count, sizeof *item);
    struct mcr_emitter *emitter = mcr_arena_alloc(arena, all->count, sizeof *emitter);
    double (*k)[MCR_K_SIZE] = mcr_arena_alloc(arena, all->count, sizeof *k);
    struct mcr_emitter_node *node = mcr_arena_alloc(arena, all->count, sizeof *node); /* leaves hold two emitters or more */
    if (!item || !emitter || !k || !node)
        return -1;
    for (uint32_t e = 0; e < all->count; e++)
        bound(all, e, &item[e]);
    grow(node, 0, item, 0, all->count);
    for (uint32_t e = 0; e < all->count; e++) {
        emitter[e] = all->emitter[item[e].emitter];
        memcpy(k[e], all->k[item[e].emitter], sizeof k[e]);
    }
    all->emitter = emitter;
    all->k = k;
    all->node = node;
    return 0;
}
