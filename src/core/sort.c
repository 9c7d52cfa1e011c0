/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Groups the rays by what they hit. Zones: the groups that scatter, then those whose paths end here (at the depth limit, or because the material only
 * emits), then misses; paths that end without emitting are gone. Each ray goes to its zone's list in one pass, and the lists are laid out one behind
 * the other. Stage file of integers.
 */
#include <string.h>

#include "core/stages.h"

static void fill_lists(struct mcr_batch *batch)
{
    const struct mcr_core *core = batch->core;
    const uint32_t *zone_of = core->surfaces.zone, *source = batch->source, *bounce = batch->state.bounce;
    const uint32_t groups = core->group_count, depth = core->scene->render.depth, rays = batch->rays, room = core->capacity;
    const int64_t *hit = batch->hit;
    uint32_t *list = batch->zone_list, *count = batch->zone_count;
    for (uint32_t z = 0; z <= 2 * groups; z++)
        count[z] = 0;
    for (uint32_t j = 0; j < rays; j++) {
        /* Entry 0 is for misses; a material that does not scatter has its zone among those that end already. */
        uint32_t z = zone_of[hit[j] + 1];
        z += ((z < groups) & (bounce[source[j]] >= depth)) ? groups : 0;
        list[(size_t)z * room + count[z]++] = j;
    }
}

/* A zone's list becomes a stretch of points. */
static uint32_t lay_out(struct mcr_batch *batch, uint32_t zone, uint32_t at)
{
    const uint32_t groups = batch->core->group_count, count = batch->zone_count[zone];
    const uint32_t *list = batch->zone_list + (size_t)zone * batch->core->capacity;
    uint32_t *order = batch->order + at, n = count;
    memcpy(order, list, count * sizeof *order);
    for (; n % MCR_LANE_PAD; n++) /* lanes between the groups are computed with too: copies of one */
        order[n] = list[0];
    batch->range[batch->range_count++] = (struct mcr_range){zone % groups, at, at + count, zone >= groups};
    return at + n;
}

void MCR_ISA_NAME(mcr_stage_sort)(struct mcr_batch *batch)
{
    const uint32_t groups = batch->core->group_count;
    uint32_t at = 0;
    fill_lists(batch);
    batch->range_count = 0;
    for (uint32_t z = 0; z < 2 * groups; z++)
        if (batch->zone_count[z] && (z < groups || batch->core->group[z - groups].emits))
            at = lay_out(batch, z, at);
    batch->points = at;
    batch->miss = batch->zone_list + (size_t)2 * groups * batch->core->capacity;
    batch->miss_count = batch->zone_count[2 * groups];
}
