/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Choosing one of many emitters by descending the tree: at each node a child in proportion to its importance, a bound of what its light
 * brings to the point. Compiled once per instruction set. The eight children of a node lie side by side in a vector; their importances are
 * added one after the other, so that the bits are the same in any width. Drawing and asking for a probability go the same way.
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
#define BEHIND 0.0625

#define LARGEST_NUMBER (1 - 0x1p-53)

/* A point, and the normal of the surface there; `open` is 1 if there is none, else 0. */
struct spot {
    double px, py, pz, nx, ny, nz, open;
};

static inline struct spot spot_of(const struct mcr_emitter_lanes *points, uint32_t i)
{
    struct spot s = {points->px[i], points->py[i], points->pz[i], 0, 0, 0, 1};
    if (points->nx) {
        s.nx = points->nx[i], s.ny = points->ny[i], s.nz = points->nz[i];
        s.open = s.nx == 0 && s.ny == 0 && s.nz == 0 ? 1 : 0;
    }
    return s;
}

/* About the mean of max(0, x) for x that are spread evenly over middle +- half: never 0 where one of them is above 0. */
static inline double clipped(double middle, double half)
{
    double part = 0.25 * (middle + half);
    part = part > middle ? part : middle;
    return part > 0 ? part : 0;
}

/*
 * Importances of a node's children: power * cosine at the emitters * cosine at the surface / distance^2, each cosine about as it is on average
 * over the ball and the cone, but never 0 where one of them is not. With d from the ball's centre c to the point: some q of the emitters and some n of their
 * normals has n.(p - q) > 0 only if a.d / |d| + open + lift / |d| > 0; and a part of the ball is in front of the surface only if
 * -n.d / |d| + radius / |d| > 0. Cones wider than a hemisphere's are taken for the more even the wider they are. The distance counts as at
 * least the radius.
 */
static __attribute__((noinline)) void importances(const struct mcr_emitter_bounds *restrict b, const struct spot *restrict s,
                                                  double *restrict out)
{
    const double *restrict cx = b->c[0], *restrict cy = b->c[1], *restrict cz = b->c[2], *restrict radius = b->radius;
    const double *restrict ax = b->axis[0], *restrict ay = b->axis[1], *restrict az = b->axis[2], *restrict open = b->open;
    const double *restrict lift = b->lift, *restrict fold = b->fold, *restrict within = b->within, *restrict power = b->power;
    const double px = s->px, py = s->py, pz = s->pz, nx = s->nx, ny = s->ny, nz = s->nz, least = s->open;
    MCR_LANES
    for (uint32_t i = 0; i < MCR_TREE_WIDTH; i++) {
        double dx = px - cx[i], dy = py - cy[i], dz = pz - cz[i], square = dx * dx + dy * dy + dz * dz;
        double near = radius[i] * radius[i], reach = within[i];
        near = near < square ? square : near;
        near = near < 1e-280 ? 1e-280 : near > 1e200 ? 1e200 : near;
        double inverse = 1 / sqrt(near), sine = radius[i] * inverse;
        double along = (ax[i] * dx + ay[i] * dy + az[i] * dz) * inverse, over = -fold[i] * along;
        double facing = along > over ? along : over, spread = open[i] + lift[i] * inverse;
        double faces = -(nx * dx + ny * dy + nz * dz) * inverse;
        double shines = clipped(facing, spread), front = clipped(faces, sine), back = BEHIND * clipped(-faces, sine);
        shines = spread > 1 ? shines + (spread - 1) : shines;
        shines = shines > 1 ? 1 : shines;
        double lit = front > back ? front : back;
        lit = lit > least ? lit : least;
        shines = shines > 0 ? shines : 0;
        shines = square <= reach ? shines : 0;
        out[i] = power[i] * shines * lit * (inverse * inverse);
    }
}

/*
 * Sums of the importances before each child; the last is their total. In this order, which is shorter to wait for than one after the other,
 * they do not fall: roundings are monotonic.
 */
static inline void run(const double w[MCR_TREE_WIDTH], double sum[MCR_TREE_WIDTH + 1])
{
    double pair = w[0] + w[1], half = pair + (w[2] + w[3]), most = half + (w[4] + w[5]);
    sum[0] = 0, sum[1] = w[0], sum[2] = pair, sum[3] = pair + w[2];
    sum[4] = half, sum[5] = half + w[4], sum[6] = most, sum[7] = most + w[6];
    sum[8] = most + (w[6] + w[7]);
}

/* Goes down one level. `number` and `share` are replaced. Returns the child, or INT32_MIN where there is none to choose. */
static inline int32_t go_down(const struct mcr_emitters *all, int32_t node, const struct spot *spot, double *number, double *share)
{
    double importance[MCR_TREE_WIDTH] __attribute__((aligned(64))), sum[MCR_TREE_WIDTH + 1], total, target;
    uint32_t child;
    importances(&all->bounds[node], spot, importance);
    run(importance, sum);
    total = sum[MCR_TREE_WIDTH];
    target = *number * total;
    target = target < total ? target : total * LARGEST_NUMBER; /* rounded up to it */
    child = sum[4] <= target ? 4 : 0;
    child += sum[child + 2] <= target ? 2 : 0;
    child += sum[child + 1] <= target;
    if (!(importance[child] > 0)) /* all are 0, or as good as */
        return INT32_MIN;
    double rest = (target - sum[child]) / importance[child];
    *number = rest < LARGEST_NUMBER ? rest : LARGEST_NUMBER;
    *share *= importance[child] / total;
    return all->bounds[node].child[child];
}

void MCR_ISA_NAME(mcr_emitter_choose)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, const double *restrict number,
                                      struct mcr_emitter_scratch *scratch)
{
    struct mcr_emitter_descent *d = &scratch->descent;
    uint32_t count = points->n;
    for (uint32_t i = 0; i < count; i++) {
        double middle = number[i] + 0x1p-54; /* of the interval that the number stands for: 0 is not the least likely of all */
        d->number[i] = middle < LARGEST_NUMBER ? middle : LARGEST_NUMBER;
        d->node[i] = 0;
        d->list[i] = (int32_t)i;
        scratch->share[i] = 1;
        scratch->chosen[i] = -1;
    }
    while (count > 0) {
        uint32_t left = 0;
        for (uint32_t j = 0; j < count; j++) {
            int32_t i = d->list[j];
            struct spot spot = spot_of(points, (uint32_t)i);
            int32_t child = go_down(all, d->node[i], &spot, &d->number[i], &scratch->share[i]);
            d->node[i] = child;
            d->list[left] = i;
            left += child >= 0;
            scratch->chosen[i] = child < 0 && child != INT32_MIN ? ~child : -1;
        }
        count = left;
    }
    for (uint32_t i = 0; i < points->n; i++)
        scratch->share[i] = scratch->chosen[i] < 0 ? 0 : scratch->share[i];
}

double MCR_ISA_NAME(mcr_emitter_chance)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, uint32_t i, uint32_t e)
{
    uint64_t path[MCR_TREE_DEPTH], place = all->place[e];
    uint32_t depth = 0;
    struct spot spot = spot_of(points, i);
    double share = 1;
    for (; place != MCR_TREE_ROOT; place = all->bounds[place >> 3].place)
        path[depth++] = place;
    while (depth-- > 0 && share > 0) {
        double importance[MCR_TREE_WIDTH] __attribute__((aligned(64))), sum[MCR_TREE_WIDTH + 1];
        importances(&all->bounds[path[depth] >> 3], &spot, importance);
        run(importance, sum);
        double own = importance[path[depth] & 7];
        share = own > 0 ? share * (own / sum[MCR_TREE_WIDTH]) : 0;
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
    struct spot spot = spot_of(points, lane);
    uint32_t depth = 1;
    double mass = 0, seen;
    const struct mcr_emitter_lanes one = {.n = 1, .px = &spot.px, .py = &spot.py, .pz = &spot.pz, .distance = &seen};
    stack[0].share = 1;
    stack[0].node = 0;
    while (depth > 0) {
        double importance[MCR_TREE_WIDTH] __attribute__((aligned(64))), sum[MCR_TREE_WIDTH + 1], share = stack[--depth].share;
        const struct mcr_emitter_bounds *node = &all->bounds[stack[depth].node];
        importances(node, &spot, importance);
        run(importance, sum);
        for (uint32_t i = 0; i < node->count; i++) {
            double part = importance[i] > 0 ? share * (importance[i] / sum[MCR_TREE_WIDTH]) : 0;
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
