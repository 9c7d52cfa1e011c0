/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Choosing one of many emitters by descending the tree: at each node a child in proportion to its importance, a bound of what its light
 * brings to the point. Compiled once per instruction set. All lanes go down a level together, in two passes: the importances of the eight
 * children of a lane's node lie side by side in a vector; then lanes lie side by side, and each chooses. Sums are formed in one order, so
 * that the bits are the same in any width. Drawing and asking for a probability go the same way.
 *
 * One number chooses all the way down, stretched at each node to what is left of it. Its 53 bits tell apart emitters whose probability is
 * above about 2^-53, however many levels there are; what is below is drawn too seldom or too often by as little.
 */
#include "core/emitter_pack.h"
#include "core/emitter_tree.h"

#include "base/elementary.h"

#define SEEN MCR_ISA_NAME(mcr_emitter_seen)

/*
 * What of a surface's far side counts. Light from there matters if the material lets it through, which is not known here: it is chosen
 * seldom where there is light in front as well, but it is chosen.
 */
#define BEHIND 0.0625f

#define LARGEST_NUMBER (1 - 0x1p-53)

/* A point in a node's frame, and the normal of the surface there; `open` is 1 if there is none, else 0. */
struct spot {
    float px, py, pz, nx, ny, nz, open;
};

static inline double largest_of(double x, double y, double z)
{
    double ax = fabs(x), ay = fabs(y), az = fabs(z), most = ax > ay ? ax : ay;
    return most > az ? most : az;
}

static inline struct spot spot_of(const struct mcr_emitter_lanes *points, uint32_t i, const struct mcr_emitter_bounds *node)
{
    double x = points->px[i] - node->origin[0], y = points->py[i] - node->origin[1], z = points->pz[i] - node->origin[2];
    double far = largest_of(x, y, z), scale = node->scale;
    if (far * scale > MCR_TREE_FAR)
        scale = MCR_TREE_FAR / far;
    struct spot s = {(float)(x * scale), (float)(y * scale), (float)(z * scale), 0, 0, 0, 1};
    if (points->nx) {
        double nx = points->nx[i], ny = points->ny[i], nz = points->nz[i];
        s.nx = (float)nx, s.ny = (float)ny, s.nz = (float)nz;
        s.open = nx == 0 && ny == 0 && nz == 0 ? 1 : 0;
    }
    return s;
}

/* About the mean of max(0, x) for x that are spread evenly over middle +- half: never 0 where one of them is above 0. */
static inline float clipped(float middle, float half)
{
    float part = 0.25f * (middle + half);
    part = part > middle ? part : middle;
    return part > 0 ? part : 0;
}

/*
 * Importances of a node's children: power * cosine at the emitters * cosine at the surface / distance^2, each cosine about as it is on average
 * over the ball and the cone, but never 0 where one of them is not. With d from the ball's centre c to the point: some q of the emitters and some n of their
 * normals has n.(p - q) > 0 only if a.d / |d| + open + lift / |d| > 0; and a part of the ball is in front of the surface only if
 * -n.d / |d| + radius / |d| > 0. Cones wider than a hemisphere's are taken for the more even the wider they are. The distance counts as at
 * least the radius.
 *
 * Roundings: the frame's numbers are off by 2^-22 of the frame at most, or if that is more, 2^-22 of the distance (the point, the centre,
 * their difference, MCR_TREE_FAR), and a cosine by 2^-21 (axis or normal, product, root, division).
 */
static __attribute__((noinline)) void importances(const struct mcr_emitter_bounds *restrict b, const struct spot *restrict s,
                                                  double *restrict out)
{
    const float *restrict cx = b->c[0], *restrict cy = b->c[1], *restrict cz = b->c[2], *restrict radius = b->radius;
    const float *restrict ax = b->axis[0], *restrict ay = b->axis[1], *restrict az = b->axis[2], *restrict open = b->open;
    const float *restrict lift = b->lift, *restrict fold = b->fold, *restrict within = b->within, *restrict power = b->power;
    const float px = s->px, py = s->py, pz = s->pz, nx = s->nx, ny = s->ny, nz = s->nz, least = s->open;
    MCR_LANES
    for (uint32_t i = 0; i < MCR_TREE_WIDTH; i++) {
        float dx = px - cx[i], dy = py - cy[i], dz = pz - cz[i], square = dx * dx + dy * dy + dz * dz;
        float near = radius[i] * radius[i], reach = within[i];
        near = near < square ? square : near;
        float inverse = 1 / sqrtf(near), sine = radius[i] * inverse + MCR_TREE_GRACE;
        float along = (ax[i] * dx + ay[i] * dy + az[i] * dz) * inverse, over = -fold[i] * along;
        float facing = along > over ? along : over, spread = open[i] + lift[i] * inverse;
        float faces = -(nx * dx + ny * dy + nz * dz) * inverse;
        float shines = clipped(facing, spread), front = clipped(faces, sine), back = BEHIND * clipped(-faces, sine);
        shines = spread > 1 ? shines + (spread - 1) : shines;
        shines = shines > 1 ? 1 : shines;
        float lit = front > back ? front : back;
        lit = lit > least ? lit : least;
        shines = shines > 0 ? shines : 0;
        shines = square <= reach ? shines : 0;
        out[i] = power[i] * shines * lit * (inverse * inverse);
    }
}

/* The sum of eight importances, in the order of choose_children. */
static inline double total_of(const double w[MCR_TREE_WIDTH])
{
    return w[0] + w[1] + (w[2] + w[3]) + (w[4] + w[5]) + (w[6] + w[7]);
}

/*
 * Chooses a child for each lane: slot, -1 where there is none to choose. `number` and `share` are replaced. The sums before each child, in
 * this order, which is shorter to wait for than one after the other, do not fall: roundings are monotonic.
 */
static __attribute__((noinline)) void choose_children(uint32_t n, const double *restrict importance, double *restrict number,
                                                      double *restrict share, int64_t *restrict slot)
{
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        const double *w = importance + MCR_TREE_WIDTH * (size_t)i;
        double w0 = w[0], w1 = w[1], w2 = w[2], w3 = w[3], w4 = w[4], w5 = w[5], w6 = w[6], w7 = w[7];
        double pair = w0 + w1, half = pair + (w2 + w3), most = half + (w4 + w5), total = most + (w6 + w7);
        double target = number[i] * total, below = total * LARGEST_NUMBER;
        target = target < total ? target : below; /* rounded up to it */
        int right = half <= target;
        double start = right ? half : 0, middle = right ? most : pair;
        int second = middle <= target;
        double a0 = right ? w4 : w0, a1 = right ? w5 : w1, b0 = right ? w6 : w2, b1 = right ? w7 : w3;
        start = second ? middle : start;
        a0 = second ? b0 : a0, a1 = second ? b1 : a1;
        double next = start + a0;
        int last = next <= target;
        double own = last ? a1 : a0, before = last ? next : start;
        double rest = (target - before) / own, part = own / total;
        number[i] = rest < LARGEST_NUMBER ? rest : LARGEST_NUMBER;
        share[i] *= part;
        int64_t child = (right ? 4 : 0) + (second ? 2 : 0) + (last ? 1 : 0);
        slot[i] = own > 0 ? child : -1; /* all are 0, or as good as */
    }
}

/* The chosen children become the lanes' nodes; lanes that have come to a leaf, or have nothing to choose, leave. Returns how many go on. */
static uint32_t descend(const struct mcr_emitters *all, uint32_t count, struct mcr_emitter_descent *d, struct mcr_emitter_scratch *scratch)
{
    uint32_t left = 0;
    for (uint32_t j = 0; j < count; j++) {
        int32_t i = d->lane[j];
        int64_t slot = d->slot[j];
        int32_t child = all->bounds[d->node[j]].child[slot < 0 ? 0 : slot];
        int none = slot < 0;
        scratch->chosen[i] = none | (child >= 0) ? -1 : ~child;
        scratch->share[i] = none ? 0 : d->share[j];
        d->lane[left] = i;
        d->node[left] = child;
        d->number[left] = d->number[j];
        d->share[left] = d->share[j];
        left += !none & (child >= 0);
    }
    return left;
}

void MCR_ISA_NAME(mcr_emitter_choose)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, const double *restrict number,
                                      struct mcr_emitter_scratch *scratch)
{
    struct mcr_emitter_descent *d = &scratch->descent;
    uint32_t count = points->n;
    for (uint32_t i = 0; i < count; i++) {
        double middle = number[i] + 0x1p-54; /* of the interval that the number stands for: 0 is not the least likely of all */
        d->number[i] = middle < LARGEST_NUMBER ? middle : LARGEST_NUMBER;
        d->share[i] = 1;
        d->node[i] = 0;
        d->lane[i] = (int32_t)i;
    }
    while (count > 0) {
        for (uint32_t j = 0; j < count; j++) {
            const struct mcr_emitter_bounds *node = &all->bounds[d->node[j]];
            struct spot spot = spot_of(points, (uint32_t)d->lane[j], node);
            importances(node, &spot, d->importance + MCR_TREE_WIDTH * (size_t)j);
        }
        choose_children(count, d->importance, d->number, d->share, d->slot);
        count = descend(all, count, d, scratch);
    }
}

double MCR_ISA_NAME(mcr_emitter_chance)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, uint32_t i, uint32_t e)
{
    uint64_t path[MCR_TREE_DEPTH], place = all->place[e];
    uint32_t depth = 0;
    double share = 1;
    for (; place != MCR_TREE_ROOT; place = all->bounds[place >> 3].place)
        path[depth++] = place;
    while (depth-- > 0 && share > 0) {
        double importance[MCR_TREE_WIDTH] __attribute__((aligned(64)));
        const struct mcr_emitter_bounds *node = &all->bounds[path[depth] >> 3];
        struct spot spot = spot_of(points, i, node);
        importances(node, &spot, importance);
        double own = importance[path[depth] & 7];
        share = own > 0 ? share * (own / total_of(importance)) : 0;
    }
    return share;
}

/* Everything below the root whose importance is not 0, depth first. */
static double mass_at(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, uint32_t lane)
{
    struct {
        double share;
        int32_t node;
    } stack[MCR_TREE_DEPTH * MCR_TREE_WIDTH];
    uint32_t depth = 1;
    double mass = 0, seen;
    const struct mcr_emitter_lanes one = {.n = 1, .px = points->px + lane, .py = points->py + lane, .pz = points->pz + lane,
                                          .distance = &seen};
    stack[0].share = 1;
    stack[0].node = 0;
    while (depth > 0) {
        double importance[MCR_TREE_WIDTH] __attribute__((aligned(64))), share = stack[--depth].share, total;
        const struct mcr_emitter_bounds *node = &all->bounds[stack[depth].node];
        struct spot spot = spot_of(points, lane, node);
        importances(node, &spot, importance);
        total = total_of(importance);
        for (uint32_t i = 0; i < node->count; i++) {
            double part = importance[i] > 0 ? share * (importance[i] / total) : 0;
            if (!(part > 0))
                continue;
            if (node->child[i] >= 0) {
                stack[depth].share = part;
                stack[depth++].node = node->child[i];
                continue;
            }
            SEEN(all, (uint32_t)~node->child[i], &one);
            mass += seen > 0 ? part : 0;
        }
    }
    return mass < 1 ? mass : 1;
}

void MCR_ISA_NAME(mcr_emitter_tree_mass)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, double *mass)
{
    for (uint32_t i = 0; i < points->n; i++)
        mass[i] = mass_at(all, points, i);
}
