/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The tree itself: every shape is in one packet or among the wide ones, packets hold one kind and are well filled, and boxes are as small as they can be where shapes lie apart,
 * in a grid with large gaps as much as beside a shape far away (which leaves most of the bins empty that splits are looked for in). Boxes of rectangles are as flat as they are.
 */
#include "scene.h"

struct sums {
    uint32_t items, packets, mixed, strangers, thick;
    double area; /* of the packets' boxes across z */
};

static void add_packet(const struct stage *s, const struct mcr_bvh_node *node, uint32_t lane, struct sums *sums)
{
    const struct mcr_accel *accel = s->accel[1];
    const struct mcr_bvh_packet *packet = (const void *)(accel->packet + (size_t)(node->child[lane] & ~MCR_BVH_PACKET) * MCR_BVH_LINE);
    sums->packets++;
    sums->items += packet->count;
    sums->area += (node->side[1][0][lane] - node->side[0][0][lane]) * (node->side[1][1][lane] - node->side[0][1][lane]);
    sums->thick += packet->kind == MCR_ACCEL_RECTANGLE + 2 && node->side[0][2][lane] != node->side[1][2][lane];
    for (uint32_t i = 0; i < packet->count; i++) {
        const struct mcr_shape *shape = &s->shape[packet->primitive[i]]; /* no boxes here: shapes and primitives have the same numbers */
        sums->mixed += accel->shape[packet->primitive[i]].kind != packet->kind;
        for (int j = 0; j < 3; j++)
            sums->strangers += shape->c[j] < node->side[0][j][lane] || shape->c[j] > node->side[1][j][lane];
    }
}

static struct sums sum_up(const struct stage *s)
{
    struct sums sums = {0};
    for (uint32_t n = 0; n < s->accel[1]->node_count; n++)
        for (uint32_t i = 0; i < MCR_BVH_WIDTH; i++)
            if (s->accel[1]->node[n].side[0][0][i] < INFINITY && s->accel[1]->node[n].child[i] & MCR_BVH_PACKET)
                add_packet(s, &s->accel[1]->node[n], i, &sums);
    return sums;
}

/* 20 x 20 squares of half the grid's step, or disks; with a square as large as the grid below it, and another very far away. wide: how many are. */
static void test_grid(const char *what, int disks, double below, double away, uint32_t wide_ones)
{
    struct stage *s = stage_create();
    double e[2][3] = {{0.5, 0, 0}, {0, 0.5, 0}}, wide[2][3] = {{20, 0, 0}, {0, 20, 0}}, floor_at[3] = {0, 0, below}, far_at[3] = {away, 0, 0};
    for (uint32_t i = 0; i < 400; i++) {
        double c[3] = {i % 20, i / 20, 0};
        stage_flat(s, disks && i % 2 ? MCR_SHAPE_DISK : MCR_SHAPE_PARALLELOGRAM, c, e[0], e[1]);
    }
    if (below != 0)
        stage_flat(s, MCR_SHAPE_PARALLELOGRAM, floor_at, wide[0], wide[1]);
    if (away != 0)
        stage_flat(s, MCR_SHAPE_PARALLELOGRAM, far_at, e[0], e[1]);
    stage_ready(s);
    struct sums sums = sum_up(s);
    /* Packets that lie apart cover no more than the grid does, 20.5^2 with the disks' rims, and the wide square. */
    double most = 20.5 * 20.5 * (disks ? 2 : 1) + (below != 0 ? 400 : 0);
    ok(sums.items + wide_ones == s->scene.shape_count && !sums.mixed && !sums.strangers && sums.packets < 100 && sums.area < most,
       "%s: %u shapes, %u in %u packets (%u mixed, %u outside), which cover %.1f of at most %.1f", what, s->scene.shape_count, sums.items, sums.packets,
       sums.mixed, sums.strangers, sums.area, most);
    ok(s->accel[1]->wide_count == wide_ones && (!wide_ones || s->accel[1]->wide[0] == 400), "%s: %u wide of %u", what, s->accel[1]->wide_count, wide_ones);
    ok(disks || !sums.thick, "%s: %u boxes of rectangles are thicker than they", what, sums.thick);
    stage_destroy(s);
}

int main(void)
{
    test_grid("grid", 0, 0, 0, 0);
    test_grid("grid over a wide square", 0, -10, 0, 1);
    test_grid("grid and a square far away", 0, 0, 1e4, 0);
    test_grid("all of that", 0, -10, 1e6, 0);
    test_grid("all of that, every other one a disk", 1, -10, 1e6, 0);
    return tap_done();
}
