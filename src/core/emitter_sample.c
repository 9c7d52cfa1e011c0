/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The light services over blocks of lanes: choosing emitters, drawing, summing densities. Compiled once per instruction set.
 *
 * Every lane's results are the same in whatever block and order it is computed: a lane's sums run over the emitters in their order.
 */
#include "core/emitter_flat.h"
#include "core/emitter_pack.h"

#include <string.h>

#define CROSS MCR_ISA_NAME(mcr_emitter_cross)
#define SEEN MCR_ISA_NAME(mcr_emitter_seen)
#define DENSITY MCR_ISA_NAME(mcr_emitter_density)
#define DISTANCE MCR_ISA_NAME(mcr_emitter_distance)
#define DRAW MCR_ISA_NAME(mcr_emitter_draw)
#define CHOOSE MCR_ISA_NAME(mcr_emitter_choose)
#define CHANCE MCR_ISA_NAME(mcr_emitter_chance)
#define WALK MCR_ISA_NAME(mcr_emitter_walk)
#define TREE_MASS MCR_ISA_NAME(mcr_emitter_tree_mass)

/* Up to so many emitters the lanes of one emitter are drawn together, with its constants in registers; beyond, the lanes of one kind. */
#define MOST_BY_EMITTER 8u

#define MINIMUM(a, b) ((a) < (b) ? (a) : (b))

/* ---- lists of lanes ------------------------------------------------------------------------------------------------ */

/* Most flags are 0: they are looked at eight at a time. */
static uint32_t list_flagged(uint32_t n, const double *restrict flag, int32_t *restrict list)
{
    uint32_t count = 0, i = 0;
    for (; i + 8 <= n; i += 8) {
        uint64_t bits[8];
        memcpy(bits, flag + i, sizeof bits);
        if (!(bits[0] | bits[1] | bits[2] | bits[3] | bits[4] | bits[5] | bits[6] | bits[7]))
            continue;
        for (uint32_t j = 0; j < 8; j++) {
            list[count] = (int32_t)(i + j);
            count += bits[j] != 0;
        }
    }
    for (; i < n; i++) {
        list[count] = (int32_t)i;
        count += flag[i] != 0;
    }
    return count;
}

static void scatter_drawn(uint32_t count, const int32_t *list, const struct mcr_emitter_pack *from, const struct mcr_emitter_lanes *to)
{
    scatter(count, list, from->wx, to->wx);
    scatter(count, list, from->wy, to->wy);
    scatter(count, list, from->wz, to->wz);
    scatter(count, list, from->density, to->density);
    scatter(count, list, from->distance, to->distance);
}

/* The points of a block: lanes base .. base+n-1 of the caller's arrays. */
static struct mcr_emitter_lanes block_points(const struct mcr_points *at, uint32_t base)
{
    struct mcr_emitter_lanes lanes = {.n = MINIMUM(at->n - base, MCR_EMITTER_BLOCK), .px = at->px + base, .py = at->py + base,
                                      .pz = at->pz + base};
    if (at->nx)
        lanes.nx = at->nx + base, lanes.ny = at->ny + base, lanes.nz = at->nz + base;
    return lanes;
}

/* ---- choosing an emitter ------------------------------------------------------------------------------------------- */

/* Whether probabilities are shared among the emitters that are seen. With one emitter there is nothing to share. */
static int shares(const struct mcr_emitters *all)
{
    return all->count > 1 && all->count <= MCR_EMITTERS_FEW;
}

/* total: the probabilities of the emitters that each lane sees. Uses `flag`. */
static void sum_seen(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, struct mcr_emitter_scratch *s)
{
    struct mcr_emitter_lanes lanes = *points;
    double *restrict total = s->total, *restrict seen = s->flag;
    lanes.distance = s->flag;
    for (uint32_t i = 0; i < lanes.n; i++)
        total[i] = 0;
    for (uint32_t e = 0; e < all->count; e++) {
        double probability = all->emitter[e].probability;
        SEEN(all, e, &lanes);
        MCR_LANES
        for (uint32_t i = 0; i < lanes.n; i++)
            total[i] += probability * seen[i];
    }
}

/* total becomes its inverse, 0 for 0. */
static void invert_total(uint32_t n, double *restrict total)
{
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double inverse = 1 / total[i];
        total[i] = total[i] > 0 ? inverse : 0;
    }
}

/*
 * Few emitters: the first whose running sum of probabilities passes number * total. The last sum is the total itself, which the product
 * cannot reach.
 */
static void choose_few(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, const double *restrict number,
                       struct mcr_emitter_scratch *s)
{
    struct mcr_emitter_lanes lanes = *points;
    double *restrict seen = s->flag, *restrict share = s->share, *restrict running = s->wx, *restrict total = s->total;
    int64_t *restrict chosen = s->chosen;
    lanes.distance = s->flag;
    for (uint32_t i = 0; i < lanes.n; i++) {
        running[i] = 0;
        share[i] = 0;
        chosen[i] = -1;
    }
    for (uint32_t e = 0; e < all->count; e++) {
        double probability = all->emitter[e].probability;
        SEEN(all, e, &lanes);
        MCR_LANES
        for (uint32_t i = 0; i < lanes.n; i++) {
            double target = number[i] * total[i], before = running[i], after = before + probability * seen[i];
            int here = (before <= target) & (target < after);
            share[i] = here ? probability : share[i];
            chosen[i] = here ? (int64_t)e : chosen[i];
            running[i] = after;
        }
    }
}

/* ---- drawing ------------------------------------------------------------------------------------------------------- */

/* Draws in lanes of one kind; where solid angle is not steady, by area. */
static void draw_lanes(const struct mcr_emitters *all, uint32_t kind, uint32_t by, int alone, const struct mcr_emitter_lanes *lanes,
                       const double *k, int varying, double *kept, struct mcr_emitter_scratch *s)
{
    struct mcr_emitter_pack *second = &s->second;
    const double *restrict density = lanes->density;
    uint32_t falling = 0, count = 0;
    DRAW(all, kind, by, alone, lanes, k, varying, &s->solid);
    if (kept)
        memcpy(kept, density, lanes->n * sizeof *kept);
    if (by == MCR_LIGHT_BY_AREA)
        return;
    for (uint32_t i = 0; i < lanes->n; i++)
        falling += density[i] < 0;
    if (falling > 0) {
        for (uint32_t i = 0; i < lanes->n; i++) {
            second->lane[count] = (int32_t)i;
            count += density[i] < 0;
        }
        uint32_t padded = pad_list(count, second->lane);
        struct mcr_emitter_lanes part = pack_lanes(second, padded);
        gather_points(lanes, padded, second->lane, second);
        gather_numbers(lanes, padded, second->lane, second);
        for (uint32_t c = 0; varying && c < MCR_K_SIZE; c++)
            gather(padded, second->lane, k + c * MCR_EMITTER_BLOCK, second->k[c]);
        DRAW(all, kind, MCR_LIGHT_BY_AREA, alone, &part, varying ? second->k[0] : k, varying, &s->solid);
        scatter_drawn(count, second->lane, second, lanes);
    }
}

/*
 * Lanes are grouped by their emitters where there are few, else by the kinds of their emitters. Of a group: its emitters' kind
 * (MCR_EMITTER_KINDS where there is none), and its lanes, with their constants gathered if they differ.
 */
static int by_kind(const struct mcr_emitters *all)
{
    return all->count > MOST_BY_EMITTER;
}

static uint32_t group_count(const struct mcr_emitters *all)
{
    return by_kind(all) ? MCR_EMITTER_KINDS : all->count;
}

static uint32_t group_kind(const struct mcr_emitters *all, uint32_t group)
{
    if (!by_kind(all))
        return all->emitter[group].kind;
    return all->kinds >> group & 1 ? group : MCR_EMITTER_KINDS;
}

/* Where there is one kind only, it is not looked up: a lookup of one of many emitters waits for memory. */
static uint32_t list_group(const struct mcr_emitters *all, const struct mcr_emitter_scratch *s, uint32_t n, uint32_t group,
                           int32_t *restrict list)
{
    const int64_t *restrict chosen = s->chosen;
    const int kinds = by_kind(all);
    uint32_t count = 0;
    if (kinds && all->kinds == 1u << group) {
        for (uint32_t i = 0; i < n; i++) {
            list[count] = (int32_t)i;
            count += chosen[i] >= 0;
        }
        return count;
    }
    for (uint32_t i = 0; i < n; i++) {
        int64_t e = chosen[i];
        list[count] = (int32_t)i;
        count += kinds ? e >= 0 && all->emitter[e].kind == group : e == (int64_t)group;
    }
    return count;
}

static const double *group_constants(const struct mcr_emitters *all, uint32_t group, uint32_t count, const int32_t *list,
                                     struct mcr_emitter_scratch *s)
{
    if (!by_kind(all))
        return all->k[group];
    gather_constants(all, s->chosen, count, list, &s->pack);
    return s->pack.k[0];
}

/* In point techniques the distance is wanted of lanes that were drawn by solid angle, too. */
static void draw_group(const struct mcr_emitters *all, uint32_t by, int alone, uint32_t group, const struct mcr_emitter_lanes *block,
                       struct mcr_emitter_scratch *s)
{
    struct mcr_emitter_pack *pack = &s->pack;
    uint32_t kind = group_kind(all, group);
    uint32_t count = kind < MCR_EMITTER_KINDS ? list_group(all, s, block->n, group, pack->lane) : 0;
    if (count == 0)
        return;
    uint32_t padded = pad_list(count, pack->lane);
    struct mcr_emitter_lanes lanes = pack_lanes(pack, padded);
    gather_points(block, padded, pack->lane, pack);
    gather_numbers(block, padded, pack->lane, pack);
    const double *k = group_constants(all, group, padded, pack->lane, s);
    draw_lanes(all, kind, by, alone, &lanes, k, by_kind(all), NULL, s);
    scatter_drawn(count, pack->lane, pack, block);
}

/*
 * Chooses emitters and draws toward them. `block` has its arrays; its densities are those of the chosen emitter alone, given that it was
 * chosen.
 */
static void draw_block(const struct mcr_emitters *all, uint32_t by, int alone, const struct mcr_emitter_lanes *block, const double *number,
                       double *kept, struct mcr_emitter_scratch *s)
{
    uint32_t n = block->n;
    if (all->count == 0) {
        for (uint32_t i = 0; i < n; i++)
            block->wx[i] = block->wy[i] = block->wz[i] = block->density[i] = block->distance[i] = 0;
        return;
    }
    if (all->count == 1) {
        draw_lanes(all, all->emitter[0].kind, by, alone, block, all->k[0], 0, kept, s);
        return;
    }
    if (shares(all)) {
        sum_seen(all, block, s);
        choose_few(all, block, number, s);
        invert_total(n, s->total);
    } else {
        CHOOSE(all, block, number, s);
    }
    for (uint32_t i = 0; i < n; i++)
        block->wx[i] = block->wy[i] = block->wz[i] = block->density[i] = block->distance[i] = 0;
    for (uint32_t group = 0; group < group_count(all); group++)
        draw_group(all, by, alone, group, block, s);
}

/* ---- densities of directions --------------------------------------------------------------------------------------- */

/* Adds to `sum` the densities of emitter e, times its probability, in the lanes that are flagged: their rays cross it. */
static void add_flagged(const struct mcr_emitters *all, uint32_t e, uint32_t by, const struct mcr_emitter_lanes *block, double *restrict sum,
                        struct mcr_emitter_scratch *s)
{
    uint32_t count = list_flagged(block->n, s->flag, s->list);
    if (count == 0)
        return;
    struct mcr_emitter_pack *pack = &s->second;
    uint32_t padded = pad_list(count, s->list);
    struct mcr_emitter_lanes lanes = pack_lanes(pack, padded);
    gather_points(block, padded, s->list, pack);
    gather_directions(block, padded, s->list, pack);
    DENSITY(all, all->emitter[e].kind, by, 0, &lanes, all->k[e], 0, &s->solid);
    for (uint32_t j = 0; j < count; j++) {
        int32_t i = s->list[j];
        double probability = all->bounds ? CHANCE(all, block, (uint32_t)i, e, &s->descent) : all->emitter[e].probability;
        sum[i] += probability * pack->density[j];
    }
}

/* The same in the lanes whose rays cross it, but for those that chose it (chosen may be NULL). */
static void add_emitter(const struct mcr_emitters *all, uint32_t e, uint32_t by, const struct mcr_emitter_lanes *block,
                        const int64_t *chosen, double *sum, struct mcr_emitter_scratch *s)
{
    double *restrict flag = s->flag;
    CROSS(all, e, block, flag);
    if (chosen) {
        MCR_LANES
        for (uint32_t i = 0; i < block->n; i++)
            flag[i] = chosen[i] == (int64_t)e ? 0 : flag[i];
    }
    add_flagged(all, e, by, block, sum, s);
}

/* Adds all emitters but the chosen ones. */
static void add_all(const struct mcr_emitters *all, uint32_t by, const struct mcr_emitter_lanes *block, const int64_t *chosen, double *sum,
                    struct mcr_emitter_scratch *s)
{
    if (all->node) {
        WALK(all, by, block, chosen, sum, s);
        return;
    }
    for (uint32_t e = 0; e < all->count; e++)
        add_emitter(all, e, by, block, chosen, sum, s);
}

static void scale(uint32_t n, const double *restrict factor, double *restrict value)
{
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        value[i] *= factor[i];
}

/*
 * A single flat emitter has one density by solid angle at a point, whatever the direction, which the draw had to find: it need not be found again.
 * Where it was not steady (negative), it is by area and must be.
 */
static int keeps(const struct mcr_emitters *all, uint32_t by)
{
    return all->count == 1 && by == MCR_LIGHT_BY_SOLID_ANGLE &&
           (all->emitter[0].kind == MCR_EMITTER_PARALLELOGRAM || all->emitter[0].kind == MCR_EMITTER_TRIANGLE);
}

/* kept: NOT_STEADY where the density must be found, because it is by area or nothing was drawn in that lane. */
static void kept_density(const struct mcr_emitters *all, uint32_t by, const struct mcr_emitter_lanes *block, const double *restrict kept,
                         double *restrict out, struct mcr_emitter_scratch *s)
{
    const uint32_t n = block->n;
    double *restrict flag = s->flag;
    CROSS(all, 0, block, flag);
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double known = kept[i], crossed = flag[i];
        int lost = known < 0;
        out[i] = lost ? 0 : crossed * known;
        flag[i] = lost ? crossed : 0;
    }
    add_flagged(all, 0, by, block, out, s);
}

static void density(const struct mcr_emitters *all, void *scratch, uint32_t by, const struct mcr_points *at,
                    const struct mcr_directions *toward, const double *kept, double *out)
{
    struct mcr_emitter_scratch *s = scratch;
    for (uint32_t base = 0; base < at->n; base += MCR_EMITTER_BLOCK) {
        struct mcr_emitter_lanes block = block_points(at, base);
        block.wx = toward->x + base, block.wy = toward->y + base, block.wz = toward->z + base;
        if (kept && keeps(all, by)) {
            kept_density(all, by, &block, kept + base, out + base, s);
            continue;
        }
        for (uint32_t i = 0; i < block.n; i++)
            out[base + i] = 0;
        add_all(all, by, &block, NULL, out + base, s);
        if (shares(all)) {
            sum_seen(all, &block, s);
            invert_total(block.n, s->total);
            scale(block.n, s->total, out + base);
        }
    }
}

/* Completes the densities of drawn directions: the chosen emitter's is there, the others that the ray crosses are added. */
static void complete(const struct mcr_emitters *all, uint32_t by, const struct mcr_emitter_lanes *block, double *restrict out,
                     struct mcr_emitter_scratch *s)
{
    uint32_t n = block->n;
    const double *restrict own = block->density, *restrict share = s->share;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        out[i] = own[i] * share[i];
    add_all(all, by, block, s->chosen, out, s);
    if (shares(all))
        scale(n, s->total, out);
}

/* The wanted lanes from `from` on, as many as fit into a block; returns where the next block begins. */
static uint32_t gather_wanted(const struct mcr_points *at, const double *const *number, uint32_t from, struct mcr_emitter_scratch *s,
                              struct mcr_emitter_lanes *block)
{
    struct mcr_emitter_pack *pack = &s->wanted;
    const struct mcr_emitter_lanes all = {.n = at->n, .px = at->px, .py = at->py, .pz = at->pz, .u = number[1], .v = number[2]};
    const double *restrict wanted = at->wanted; /* 0 or anything */
    int32_t *restrict list = pack->lane;
    uint32_t count = 0, i = from;
    for (; i < at->n && count < MCR_EMITTER_BLOCK; i++) {
        list[count] = (int32_t)i;
        count += wanted[i] != 0;
    }
    *block = pack_lanes(pack, count);
    if (count == 0)
        return i;
    uint32_t padded = pad_list(count, list);
    gather_points(&all, padded, list, pack);
    gather_numbers(&all, padded, list, pack);
    gather(padded, list, number[0], s->number);
    if (at->nx) {
        gather(padded, list, at->nx, s->normal[0]);
        gather(padded, list, at->ny, s->normal[1]);
        gather(padded, list, at->nz, s->normal[2]);
        block->nx = s->normal[0], block->ny = s->normal[1], block->nz = s->normal[2];
    }
    return i;
}

/* Draws in some lanes alone. The others' kept densities stay to be found. */
static void draw_wanted(const struct mcr_emitters *all, struct mcr_emitter_scratch *s, uint32_t by, const struct mcr_points *at,
                        const double *const *number, const struct mcr_directions *out, double *out_density, double *kept)
{
    struct mcr_emitter_pack *pack = &s->wanted;
    struct mcr_emitter_lanes block;
    for (uint32_t i = 0; kept && i < at->n; i++)
        kept[i] = NOT_STEADY;
    for (uint32_t next = 0; next < at->n;) {
        next = gather_wanted(at, number, next, s, &block);
        uint32_t count = block.n;
        if (count == 0)
            continue;
        block.n = (count + MCR_LANE_PAD - 1) / MCR_LANE_PAD * MCR_LANE_PAD;
        draw_block(all, by, 0, &block, s->number, kept ? s->number : NULL, s);
        if (kept)
            scatter(count, pack->lane, s->number, kept);
        if (out_density && all->count > 1) {
            complete(all, by, &block, s->number, s);
            scatter(count, pack->lane, s->number, out_density);
        } else if (out_density) {
            scatter(count, pack->lane, pack->density, out_density);
        }
        scatter(count, pack->lane, pack->wx, out->x);
        scatter(count, pack->lane, pack->wy, out->y);
        scatter(count, pack->lane, pack->wz, out->z);
    }
}

static void draw(const struct mcr_emitters *all, void *scratch, uint32_t by, const struct mcr_points *at, const double *const *number,
                 const struct mcr_directions *out, double *out_density, double *kept)
{
    struct mcr_emitter_scratch *s = scratch;
    double *keep = kept && keeps(all, by) ? kept : NULL;
    if (at->size >= sizeof *at && at->wanted) {
        draw_wanted(all, s, by, at, number, out, out_density, keep);
        return;
    }
    for (uint32_t base = 0; base < at->n; base += MCR_EMITTER_BLOCK) {
        struct mcr_emitter_lanes block = block_points(at, base);
        block.u = number[1] + base, block.v = number[2] + base;
        block.wx = out->x + base, block.wy = out->y + base, block.wz = out->z + base;
        block.density = out_density && all->count <= 1 ? out_density + base : s->density;
        block.distance = s->distance;
        draw_block(all, by, 0, &block, number[0] + base, keep ? keep + base : NULL, s);
        if (out_density && all->count > 1)
            complete(all, by, &block, out_density + base, s);
    }
}

static void mass(const struct mcr_emitters *all, void *scratch, uint32_t by, const struct mcr_points *at, double *out)
{
    struct mcr_emitter_scratch *s = scratch;
    (void)by;
    for (uint32_t base = 0; base < at->n; base += MCR_EMITTER_BLOCK) {
        struct mcr_emitter_lanes block = block_points(at, base);
        if (all->bounds) {
            TREE_MASS(all, &block, out + base, &s->descent);
            continue;
        }
        sum_seen(all, &block, s);
        for (uint32_t i = 0; i < block.n; i++)
            out[base + i] = s->total[i] > 0 ? 1 : 0;
    }
}

/* ---- points on emitters --------------------------------------------------------------------------------------------- */

/* Distances of lanes that were drawn by solid angle: those that have a direction and none. */
static void find_distances(const struct mcr_emitters *all, const struct mcr_emitter_lanes *block, struct mcr_emitter_scratch *s)
{
    struct mcr_emitter_pack *pack = &s->pack;
    for (uint32_t group = 0; group < group_count(all); group++) {
        uint32_t kind = group_kind(all, group), listed = kind < MCR_EMITTER_KINDS ? list_group(all, s, block->n, group, pack->lane) : 0,
            count = 0;
        for (uint32_t j = 0; j < listed; j++) {
            int32_t i = pack->lane[j];
            pack->lane[count] = i;
            count += block->density[i] > 0 && block->distance[i] == 0;
        }
        if (count == 0)
            continue;
        uint32_t padded = pad_list(count, pack->lane);
        struct mcr_emitter_lanes lanes = pack_lanes(pack, padded);
        gather_points(block, padded, pack->lane, pack);
        gather_directions(block, padded, pack->lane, pack);
        DISTANCE(kind, &lanes, group_constants(all, group, padded, pack->lane, s), by_kind(all));
        scatter(count, pack->lane, pack->distance, block->distance);
    }
}

/* Tells the points that were drawn, and their densities. */
static void store_points(const struct mcr_emitters *all, const struct mcr_emitter_lanes *block, const struct mcr_emitter_points *out,
                         uint32_t base, double *restrict out_density, struct mcr_emitter_scratch *s)
{
    const int scaled = shares(all);
    for (uint32_t i = 0; i < block->n; i++) {
        double distance = block->distance[i], density = block->density[i] * s->share[i];
        int good = density > 0 && distance > 0 && distance < MCR_INFINITY;
        out->emitter[base + i] = good ? (int32_t)s->chosen[i] : -1;
        out->distance[base + i] = good ? distance : 0;
        out->qx[base + i] = good ? block->px[i] + distance * block->wx[i] : 0;
        out->qy[base + i] = good ? block->py[i] + distance * block->wy[i] : 0;
        out->qz[base + i] = good ? block->pz[i] + distance * block->wz[i] : 0;
        if (!good)
            block->wx[i] = block->wy[i] = block->wz[i] = 0;
        if (out_density)
            out_density[base + i] = good ? (scaled ? density * s->total[i] : density) : 0;
    }
}

static void draw_point(const struct mcr_emitters *all, void *scratch, uint32_t by, const struct mcr_points *at, const double *const *number,
                       const struct mcr_emitter_points *out, double *out_density)
{
    struct mcr_emitter_scratch *s = scratch;
    for (uint32_t base = 0; base < at->n; base += MCR_EMITTER_BLOCK) {
        struct mcr_emitter_lanes block = block_points(at, base);
        block.u = number[1] + base, block.v = number[2] + base;
        block.wx = out->wx + base, block.wy = out->wy + base, block.wz = out->wz + base;
        block.density = s->density;
        block.distance = s->distance;
        for (uint32_t i = 0; all->count == 1 && i < block.n; i++) {
            s->chosen[i] = 0;
            s->share[i] = 1;
        }
        draw_block(all, by, 1, &block, number[0] + base, NULL, s);
        if (by == MCR_LIGHT_BY_SOLID_ANGLE)
            find_distances(all, &block, s);
        store_points(all, &block, out, base, out_density, s);
    }
}

/* The density of each lane's emitter at its point, given that it was chosen; 0 where the emitter is not seen. */
static void density_of_points(const struct mcr_emitters *all, uint32_t by, const struct mcr_emitter_lanes *block,
                              struct mcr_emitter_scratch *s)
{
    struct mcr_emitter_pack *pack = &s->pack;
    for (uint32_t group = 0; group < group_count(all); group++) {
        uint32_t kind = group_kind(all, group);
        uint32_t count = kind < MCR_EMITTER_KINDS ? list_group(all, s, block->n, group, pack->lane) : 0;
        if (count == 0)
            continue;
        uint32_t padded = pad_list(count, pack->lane);
        struct mcr_emitter_lanes lanes = pack_lanes(pack, padded);
        gather_points(block, padded, pack->lane, pack);
        gather_directions(block, padded, pack->lane, pack);
        gather(padded, pack->lane, block->distance, pack->distance);
        DENSITY(all, kind, by, 1, &lanes, group_constants(all, group, padded, pack->lane, s), by_kind(all), &s->solid);
        scatter(count, pack->lane, pack->density, block->density);
    }
}

static void density_point(const struct mcr_emitters *all, void *scratch, uint32_t by, const struct mcr_points *at,
                          const struct mcr_emitter_points *points, double *out)
{
    struct mcr_emitter_scratch *s = scratch;
    for (uint32_t base = 0; base < at->n; base += MCR_EMITTER_BLOCK) {
        struct mcr_emitter_lanes block = block_points(at, base);
        block.wx = points->wx + base, block.wy = points->wy + base, block.wz = points->wz + base;
        block.density = s->density;
        block.distance = points->distance + base;
        for (uint32_t i = 0; i < block.n; i++) {
            int32_t e = points->emitter[base + i];
            s->chosen[i] = e;
            s->density[i] = 0;
            s->share[i] = e < 0 ? 0 : all->bounds ? CHANCE(all, &block, i, (uint32_t)e, &s->descent) : all->emitter[e].probability;
        }
        density_of_points(all, by, &block, s);
        if (shares(all)) {
            sum_seen(all, &block, s);
            invert_total(block.n, s->total);
            scale(block.n, s->total, s->share);
        }
        for (uint32_t i = 0; i < block.n; i++)
            out[base + i] = s->share[i] * s->density[i];
    }
}

const struct mcr_emitter_functions MCR_ISA_NAME(mcr_emitter_functions) = {
    .draw = draw, .density = density, .mass = mass, .draw_point = draw_point, .density_point = density_point};
