/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Groups the rays by what they hit. Zones: the groups that scatter, their paths that roulette may end, the groups whose paths end here (at the depth
 * limit, or because the material only emits), and misses; paths that end without emitting are gone, unless features of their hits are asked for. Each ray goes to its zone's list in one pass, and
 * the lists are laid out one behind the other, the first two zones of a group as one range. Stage file of integers.
 */
#include <string.h>

#include "core/stages.h"

static void fill_lists(struct mcr_batch *batch)
{
    const struct mcr_core *core = batch->core;
    const uint32_t *zone_of = core->surfaces.zone, *source = batch->source, *bounce = batch->state.bounce;
    const struct mcr_render_settings *render = &core->scene->render;
    const uint32_t groups = core->group_count, depth = render->depth, rays = batch->rays, room = core->capacity;
    const uint32_t from = render->roulette ? render->roulette_from : UINT32_MAX;
    const int64_t *hit = batch->hit;
    uint32_t *list = batch->zone_list, *count = batch->zone_count;
    for (uint32_t z = 0; z <= 3 * groups; z++)
        count[z] = 0;
    for (uint32_t j = 0; j < rays; j++) {
        /* Entry 0 is for misses; a material that does not scatter has its zone among those that end already. */
        uint32_t z = zone_of[hit[j] + 1], events = bounce[source[j]];
        uint32_t later = events >= depth ? 2 * groups : events >= from ? groups : 0;
        z += z < groups ? later : 0;
        list[(size_t)z * room + count[z]++] = j;
    }
}

/* The lists of two zones (second 0: of one) become a range of points. */
static uint32_t lay_out(struct mcr_batch *batch, uint32_t zone, uint32_t second, uint32_t at)
{
    const uint32_t groups = batch->core->group_count, room = batch->core->capacity;
    const uint32_t count = batch->zone_count[zone], more = second ? batch->zone_count[second] : 0;
    const uint32_t *list = batch->zone_list + (size_t)zone * room;
    uint32_t *order = batch->order + at, n = count + more;
    if (!n)
        return at;
    memcpy(order, list, count * sizeof *order);
    memcpy(order + count, batch->zone_list + (size_t)second * room, more * sizeof *order);
    for (; n % MCR_LANE_PAD; n++) /* lanes between the groups are computed with too: copies of one */
        order[n] = order[0];
    batch->range[batch->range_count++] = (struct mcr_range){
        .group = zone % groups, .begin = at, .end = at + count + more, .ends = !second,
        .roulette = more ? at + count / MCR_LANE_PAD * MCR_LANE_PAD : at + count};
    return at + n;
}

void MCR_ISA_NAME(mcr_stage_sort)(struct mcr_batch *batch)
{
    const uint32_t groups = batch->core->group_count;
    uint32_t at = 0;
    fill_lists(batch);
    batch->range_count = 0;
    for (uint32_t g = 0; g < groups; g++)
        at = lay_out(batch, g, groups + g, at);
    for (uint32_t g = 0; g < groups; g++)
        if (batch->core->group[g].emits || batch->core->features)
            at = lay_out(batch, 2 * groups + g, 0, at);
    batch->points = at;
    batch->miss = batch->zone_list + (size_t)3 * groups * batch->core->capacity;
    batch->miss_count = batch->zone_count[3 * groups];
}
