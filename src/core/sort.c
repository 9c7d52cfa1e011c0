/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Groups the rays by what they hit. A counting sort over zones: the groups that scatter, then those whose paths end here (at the depth limit, or
 * because the material only emits); those that end without emitting are gone. Stage file of integers.
 */
#include "core/stages.h"

static void count_zones(struct mcr_batch *batch)
{
    const struct mcr_core *core = batch->core;
    const uint32_t *zone_of = core->surfaces.zone, *source = batch->source, *bounce = batch->state.bounce;
    const uint32_t groups = core->group_count, depth = core->scene->render.depth;
    for (uint32_t z = 0; z <= 2 * groups; z++)
        batch->zone_count[z] = 0;
    for (uint32_t j = 0; j < batch->rays; j++) {
        /* Entry 0 is for misses; a material that does not scatter has its zone among those that end already. */
        uint32_t z = zone_of[batch->hit[j] + 1];
        z += ((z < groups) & (bounce[source[j]] >= depth)) ? groups : 0;
        batch->zone[j] = z;
        batch->zone_count[z]++;
    }
}

/* Gives each zone its stretch of points, and zones that are done with one behind all, where nobody looks. Returns how many lanes the points take. */
static uint32_t lay_out(struct mcr_batch *batch)
{
    const uint32_t groups = batch->core->group_count;
    uint32_t at = 0, done;
    batch->range_count = 0;
    for (uint32_t z = 0; z < 2 * groups; z++) {
        uint32_t g = z % groups, count = batch->zone_count[z];
        int ends = z >= groups;
        if (!count || (ends && !batch->core->group[g].emits))
            continue;
        batch->zone_begin[z] = at;
        batch->range[batch->range_count++] = (struct mcr_range){g, at, at + count, ends};
        at = (at + count + MCR_LANE_PAD - 1) / MCR_LANE_PAD * MCR_LANE_PAD;
    }
    batch->zone_begin[2 * groups] = done = at;
    done += batch->zone_count[2 * groups];
    for (uint32_t z = groups; z < 2 * groups; z++)
        if (!batch->core->group[z % groups].emits) {
            batch->zone_begin[z] = done;
            done += batch->zone_count[z];
        }
    return at;
}

void MCR_ISA_NAME(mcr_stage_sort)(struct mcr_batch *batch)
{
    const uint32_t groups = batch->core->group_count;
    count_zones(batch);
    batch->points = lay_out(batch);
    uint32_t first_miss = batch->zone_begin[2 * groups];
    for (uint32_t j = 0; j < batch->rays; j++)
        batch->order[batch->zone_begin[batch->zone[j]]++] = j;
    batch->miss_count = batch->zone_count[2 * groups];
    for (uint32_t i = 0; i < batch->miss_count; i++)
        batch->miss[i] = batch->order[first_miss + i];
    /* Paths that do not scatter any more are taken off their jobs; what they emit is added before the jobs are looked at. */
    for (uint32_t z = groups; z <= 2 * groups; z++)
        for (uint32_t k = batch->zone_begin[z] - batch->zone_count[z]; batch->zone_count[z] && k < batch->zone_begin[z]; k++)
            batch->job[batch->state.slot[batch->source[batch->order[k]]] / MCR_JOB_SLOTS].pending--;
    /* Lanes between the groups are computed with too: let them be copies. */
    for (uint32_t r = 0; r < batch->range_count; r++)
        for (uint32_t k = batch->range[r].end; k % MCR_LANE_PAD; k++)
            batch->order[k] = batch->order[batch->range[r].begin];
}
