/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Which of many emitters rays cross: each lane walks the tree of boxes by itself, eight children at a time; the pairs of lanes and emitters
 * that it finds are then looked at side by side. Compiled once per instruction set. A lane's densities are added in the order of the
 * emitters.
 */
#include "core/emitter_pack.h"
#include "core/emitter_tree.h"

#include <string.h>

#define CROSS_EACH MCR_ISA_NAME(mcr_emitter_cross_each)
#define DENSITY MCR_ISA_NAME(mcr_emitter_density)
#define CHANCE MCR_ISA_NAME(mcr_emitter_chance)

/* A ray: origin, and the inverses of its direction. */
struct ray {
    double px, py, pz, ix, iy, iz;
};

/* 1 for the children whose boxes the ray crosses. What is not a number (a zero direction in the plane of a side) counts as crossed. */
static __attribute__((noinline)) void cross_boxes(const struct mcr_emitter_node *restrict node, const struct ray *restrict ray,
                                                  double *restrict flag)
{
    const double *restrict lx = node->lo[0], *restrict ly = node->lo[1], *restrict lz = node->lo[2];
    const double *restrict hx = node->hi[0], *restrict hy = node->hi[1], *restrict hz = node->hi[2];
    const double px = ray->px, py = ray->py, pz = ray->pz, ix = ray->ix, iy = ray->iy, iz = ray->iz;
    MCR_LANES
    for (uint32_t i = 0; i < MCR_TREE_WIDTH; i++) {
        double x0 = (lx[i] - px) * ix, x1 = (hx[i] - px) * ix, y0 = (ly[i] - py) * iy;
        double y1 = (hy[i] - py) * iy, z0 = (lz[i] - pz) * iz, z1 = (hz[i] - pz) * iz;
        double nx = x0 < x1 ? x0 : x1, fx = x0 < x1 ? x1 : x0, ny = y0 < y1 ? y0 : y1, fy = y0 < y1 ? y1 : y0;
        double nz = z0 < z1 ? z0 : z1, fz = z0 < z1 ? z1 : z0;
        int apart = (nx > fy) | (nx > fz) | (ny > fx) | (ny > fz) | (nz > fx) | (nz > fy) | (fx < 0) | (fy < 0) | (fz < 0);
        flag[i] = apart ? 0.0 : 1.0;
    }
}

/* Densities of the pairs whose emitters are of one kind. */
static void measure_kind(const struct mcr_emitters *all, uint32_t kind, uint32_t by, const struct mcr_emitter_lanes *block,
                         struct mcr_emitter_scratch *s)
{
    struct mcr_emitter_pairs *pairs = &s->pairs;
    struct mcr_emitter_pack *pack = &s->second;
    int32_t *which = pack->lane, lane[MCR_EMITTER_BLOCK];
    uint32_t count = 0;
    for (uint32_t j = 0; j < pairs->count; j++) {
        which[count] = (int32_t)j;
        count += all->emitter[pairs->emitter[j]].kind == kind;
    }
    if (count == 0)
        return;
    uint32_t padded = pad_list(count, which);
    struct mcr_emitter_lanes lanes = pack_lanes(pack, padded);
    for (uint32_t j = 0; j < padded; j++)
        lane[j] = pairs->lane[which[j]];
    gather_points(block, padded, lane, pack);
    gather_directions(block, padded, lane, pack);
    gather_constants(all, pairs->emitter, padded, which, pack);
    CROSS_EACH(kind, &lanes, pack->k[0], pairs->flag);
    DENSITY(all, kind, by, 0, &lanes, pack->k[0], 1, &s->solid);
    for (uint32_t j = 0; j < count; j++)
        pairs->value[which[j]] = pairs->flag[j] != 0 ? pack->density[j] : 0;
}

static void add_pairs(const struct mcr_emitters *all, uint32_t by, const struct mcr_emitter_lanes *block, double *sum,
                      struct mcr_emitter_scratch *s)
{
    struct mcr_emitter_pairs *pairs = &s->pairs;
    for (uint32_t kind = 0; kind < MCR_EMITTER_KINDS; kind++)
        if (all->kinds >> kind & 1)
            measure_kind(all, kind, by, block, s);
    for (uint32_t j = 0; j < pairs->count; j++)
        if (pairs->value[j] > 0)
            sum[pairs->lane[j]] +=
                CHANCE(all, block, (uint32_t)pairs->lane[j], (uint32_t)pairs->emitter[j], &s->descent) * pairs->value[j];
    pairs->count = 0;
}

void MCR_ISA_NAME(mcr_emitter_walk)(const struct mcr_emitters *all, uint32_t by, const struct mcr_emitter_lanes *block, const int64_t *chosen,
                                    double *sum, struct mcr_emitter_scratch *s)
{
    struct mcr_emitter_pairs *pairs = &s->pairs;
    int32_t stack[MCR_TREE_DEPTH * MCR_TREE_WIDTH];
    double flag[MCR_TREE_WIDTH] __attribute__((aligned(64)));
    pairs->count = 0;
    for (uint32_t i = 0; i < block->n; i++) {
        struct ray ray = {block->px[i], block->py[i], block->pz[i], 1 / block->wx[i], 1 / block->wy[i], 1 / block->wz[i]};
        if (block->wx[i] == 0 && block->wy[i] == 0 && block->wz[i] == 0)
            continue;
        uint32_t depth = 1;
        for (stack[0] = 0; depth > 0;) {
            int32_t at = stack[--depth];
            if (at < 0 && chosen && chosen[i] == ~at)
                continue;
            if (at < 0) {
                pairs->lane[pairs->count] = (int32_t)i;
                pairs->emitter[pairs->count++] = ~at;
                if (pairs->count == MCR_EMITTER_BLOCK)
                    add_pairs(all, by, block, sum, s);
                continue;
            }
            const struct mcr_emitter_node *node = &all->node[at];
            cross_boxes(node, &ray, flag);
            for (uint32_t j = node->count; j-- > 0;) {
                stack[depth] = node->child[j];
                depth += flag[j] != 0;
            }
        }
    }
    add_pairs(all, by, block, sum, s);
}
