/* SPDX-License-Identifier: Apache-2.0 */
/* Lists of lanes, and gathering lanes into packs and back. Private to the emitters' stage files. */
#ifndef MCR_CORE_EMITTER_PACK_H
#define MCR_CORE_EMITTER_PACK_H

#include "core/emitter_lanes.h"

/*
 * Repeats the first entry up to a whole vector, since a few odd lanes cost as much one by one. Returns the new length; there is room for
 * it.
 */
static inline uint32_t pad_list(uint32_t count, int32_t *list)
{
    while (count % MCR_LANE_PAD)
        list[count++] = list[0];
    return count;
}

static inline __attribute__((unused)) void gather(uint32_t count, const int32_t *restrict list, const double *restrict from,
                                                  double *restrict to)
{
    MCR_LANES
    for (uint32_t j = 0; j < count; j++)
        to[j] = from[list[j]];
}

static inline void scatter(uint32_t count, const int32_t *restrict list, const double *restrict from, double *restrict to)
{
    for (uint32_t j = 0; j < count; j++)
        to[list[j]] = from[j];
}

static inline struct mcr_emitter_lanes pack_lanes(struct mcr_emitter_pack *pack, uint32_t n)
{
    struct mcr_emitter_lanes lanes = {.n = n, .px = pack->px, .py = pack->py, .pz = pack->pz, .u = pack->u, .v = pack->v, .wx = pack->wx,
                                      .wy = pack->wy, .wz = pack->wz, .density = pack->density, .distance = pack->distance};
    return lanes;
}

static inline void gather_points(const struct mcr_emitter_lanes *from, uint32_t count, const int32_t *list, struct mcr_emitter_pack *to)
{
    gather(count, list, from->px, to->px);
    gather(count, list, from->py, to->py);
    gather(count, list, from->pz, to->pz);
}

static inline void gather_numbers(const struct mcr_emitter_lanes *from, uint32_t count, const int32_t *list, struct mcr_emitter_pack *to)
{
    gather(count, list, from->u, to->u);
    gather(count, list, from->v, to->v);
}

static inline void gather_directions(const struct mcr_emitter_lanes *from, uint32_t count, const int32_t *list, struct mcr_emitter_pack *to)
{
    gather(count, list, from->wx, to->wx);
    gather(count, list, from->wy, to->wy);
    gather(count, list, from->wz, to->wz);
}

/* Each lane gets the constants of its emitter. */
static inline void gather_constants(const struct mcr_emitters *all, const int64_t *restrict chosen, uint32_t count,
                                    const int32_t *restrict list, struct mcr_emitter_pack *restrict to)
{
    for (uint32_t j = 0; j < count; j++) {
        const double *k = all->k[chosen[list[j]]];
        for (uint32_t c = 0; c < MCR_K_SIZE; c++)
            to->k[c][j] = k[c];
    }
}

#endif
