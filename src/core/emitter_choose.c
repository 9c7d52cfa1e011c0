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
 * Times the cosine of what is on a surface's far side. Light from there matters if the material lets it through, which is not known here:
 * it is chosen seldom where there is light in front as well, but it is chosen.
 */
#define BEHIND (-0.0625f)

#define LARGEST_NUMBER (1 - 0x1p-53)

static inline double largest_of(double x, double y, double z)
{
    double ax = fabs(x), ay = fabs(y), az = fabs(z), most = ax > ay ? ax : ay;
    return most > az ? most : az;
}

/* The points of n lanes in the frames of their nodes. */
static __attribute__((noinline)) void to_frames(const struct mcr_emitter_bounds *bounds, const struct mcr_emitter_lanes *points, uint32_t n,
                                                const int32_t *restrict lane, const int32_t *restrict node, mcr_emitter_thin *restrict to)
{
    const double *restrict px = points->px, *restrict py = points->py, *restrict pz = points->pz;
    const double *restrict ox = bounds->origin, *restrict oy = ox + 1, *restrict oz = ox + 2, *restrict scale = &bounds->scale;
    MCR_LANES
    for (uint32_t j = 0; j < n; j++) {
        int64_t at = node[j] * (int64_t)(sizeof *bounds / sizeof(double)), i = lane[j];
        double x = px[i] - ox[at], y = py[i] - oy[at], z = pz[i] - oz[at];
        double far = largest_of(x, y, z), by = scale[at], nearer = MCR_TREE_FAR / far;
        by = far * by > MCR_TREE_FAR ? nearer : by;
        to[0][j] = (float)(x * by);
        to[1][j] = (float)(y * by);
        to[2][j] = (float)(z * by);
    }
}

/* What is opposite to the normals of the surfaces at points, and 1 if there is none, else 0. */
static __attribute__((noinline)) void away_from(const struct mcr_emitter_lanes *points, mcr_emitter_thin *restrict to)
{
    const double *restrict nx = points->nx, *restrict ny = points->ny, *restrict nz = points->nz;
    const uint32_t n = points->n;
    for (uint32_t i = 0; !nx && i < n; i++) {
        to[0][i] = to[1][i] = to[2][i] = 0;
        to[3][i] = 1;
    }
    if (!nx)
        return;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double x = -nx[i], y = -ny[i], z = -nz[i], most = largest_of(x, y, z);
        to[0][i] = (float)x;
        to[1][i] = (float)y;
        to[2][i] = (float)z;
        to[3][i] = most > 0 ? 0 : 1;
    }
}

/* About the mean of max(0, x) for x that are spread evenly over middle +- half: never 0 where one of them is above 0. */
static inline float clipped(float middle, float half)
{
    float most = middle + half, part = 0.25f * (most > 0 ? most : 0);
    return part > middle ? part : middle;
}

/*
 * Importances of a node's children: power * cosine at the emitters * cosine at the surface / distance^2, each cosine about as it is on
 * average over the ball and the cone, but never 0 where one of them is not. With d from the ball's centre c to the point: some q of the
 * emitters and some n of their normals has n.(p - q) > 0 only if a.d / |d| + open + lift / |d| > 0; and a part of the ball is in front of
 * the surface only if -n.d / |d| + radius / |d| > 0. Cones wider than a hemisphere's light all directions, the more the wider they are.
 * The distance counts as at least the radius.
 *
 * Roundings: the frame's numbers are off by 2^-22 of the frame at most, or if that is more, 2^-22 of the distance (the point, the centre,
 * their difference, MCR_TREE_FAR), and a cosine by 2^-21 (axis or normal, product, root, division).
 */
static __attribute__((noinline)) void importances(const struct mcr_emitter_bounds *restrict bounds, uint32_t n,
                                                  const struct mcr_emitter_descent *restrict d, double *restrict out)
{
    for (uint32_t j = 0; j < n; j++, out += MCR_TREE_WIDTH) {
        const struct mcr_emitter_bounds *restrict b = &bounds[d->node[j]];
        const int32_t lane = d->lane[j];
        const float px = d->point[0][j], py = d->point[1][j], pz = d->point[2][j];
        const float nx = d->away[0][lane], ny = d->away[1][lane], nz = d->away[2][lane], least = d->away[3][lane];
        MCR_LANES
        for (uint32_t i = 0; i < MCR_TREE_WIDTH; i++) {
            float dx = px - b->c[0][i], dy = py - b->c[1][i], dz = pz - b->c[2][i], square = dx * dx + dy * dy + dz * dz;
            float radius = b->radius[i], near = radius * radius;
            near = near < square ? square : near;
            float inverse = 1 / sqrtf(near), sine = radius * inverse + MCR_TREE_GRACE;
            float along = (b->axis[0][i] * dx + b->axis[1][i] * dy + b->axis[2][i] * dz) * inverse, over = b->fold[i] * along;
            float facing = along > over ? along : over, spread = b->open[i] + b->lift[i] * inverse, even = spread - 1;
            float faces = (nx * dx + ny * dy + nz * dz) * inverse, lit = clipped(faces, sine), back = BEHIND * faces;
            float shines = clipped(facing, spread), power = b->power[i];
            shines = shines > even ? shines : even;
            shines = shines > 1 ? 1 : shines;
            lit = lit > back ? lit : back;
            lit = lit > least ? lit : least;
            power = square <= b->within[i] ? power : 0;
            out[i] = power * shines * lit * (inverse * inverse);
        }
    }
}

/* Point i alone, for importances_of. */
static void descend_alone(const struct mcr_emitter_lanes *points, uint32_t i, struct mcr_emitter_lanes *one, struct mcr_emitter_descent *d)
{
    *one = (struct mcr_emitter_lanes){.n = 1, .px = points->px + i, .py = points->py + i, .pz = points->pz + i};
    if (points->nx)
        one->nx = points->nx + i, one->ny = points->ny + i, one->nz = points->nz + i;
    away_from(one, d->away);
    d->lane[0] = 0;
}

/* The importances of one node's children. */
static void importances_of(const struct mcr_emitters *all, int32_t node, const struct mcr_emitter_lanes *one, struct mcr_emitter_descent *d)
{
    d->node[0] = node;
    to_frames(all->bounds, one, 1, d->lane, d->node, d->point);
    importances(all->bounds, 1, d, d->importance);
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
                                                      double *restrict share, double *restrict slot)
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
        double child = (right ? 4.0 : 0.0) + (second ? 2.0 : 0.0) + (last ? 1.0 : 0.0);
        slot[i] = own > 0 ? child : -1; /* all are 0, or as good as */
    }
}

/*
 * Fetches what will be looked at soon: nodes and constants of ten thousand emitters are 3 MB. Not a function: gcc removes calls of functions
 * that do nothing else.
 */
#define FETCH(what)                                            \
    do {                                                       \
        for (uint32_t at_ = 0; at_ < sizeof(what); at_ += 64)  \
            __builtin_prefetch((const char *)&(what) + at_);   \
    } while (0)

/* The chosen children become the lanes' nodes; lanes that have come to a leaf, or have nothing to choose, leave. Returns how many go on. */
static uint32_t go_down(const struct mcr_emitters *all, uint32_t count, struct mcr_emitter_descent *d, struct mcr_emitter_scratch *scratch)
{
    uint32_t left = 0;
    for (uint32_t j = 0; j < count; j++) {
        int32_t i = d->lane[j], slot = (int32_t)d->slot[j], none = slot < 0;
        int32_t child = all->bounds[d->node[j]].child[none ? 0 : slot];
        scratch->chosen[i] = (none | (child >= 0)) ? -1 : ~child;
        scratch->share[i] = none ? 0 : d->share[j];
        if (child < 0) {
            FETCH(all->k[~child]);
            FETCH(all->emitter[~child]);
        } else {
            FETCH(all->bounds[child]);
        }
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
    away_from(points, d->away);
    while (count > 0) {
        to_frames(all->bounds, points, count, d->lane, d->node, d->point);
        importances(all->bounds, count, d, d->importance);
        choose_children(count, d->importance, d->number, d->share, d->slot);
        count = go_down(all, count, d, scratch);
    }
}

double MCR_ISA_NAME(mcr_emitter_chance)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, uint32_t i, uint32_t e,
                                        struct mcr_emitter_descent *d)
{
    uint64_t path[MCR_TREE_DEPTH], place = all->place[e];
    struct mcr_emitter_lanes one;
    uint32_t depth = 0;
    double share = 1;
    descend_alone(points, i, &one, d);
    for (; place != MCR_TREE_ROOT; place = all->bounds[place >> 3].place)
        path[depth++] = place;
    while (depth-- > 0 && share > 0) {
        importances_of(all, (int32_t)(path[depth] >> 3), &one, d);
        double own = d->importance[path[depth] & 7];
        share = own > 0 ? share * (own / total_of(d->importance)) : 0;
    }
    return share;
}

/* Everything below the root whose importance is not 0, depth first. */
static double mass_at(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, uint32_t lane, struct mcr_emitter_descent *d)
{
    struct {
        double share;
        int32_t node;
    } stack[MCR_TREE_DEPTH * MCR_TREE_WIDTH];
    struct mcr_emitter_lanes one;
    uint32_t depth = 1;
    double mass = 0, seen;
    descend_alone(points, lane, &one, d);
    one.distance = &seen;
    stack[0].share = 1;
    stack[0].node = 0;
    while (depth > 0) {
        double share = stack[--depth].share, total;
        const struct mcr_emitter_bounds *node = &all->bounds[stack[depth].node];
        importances_of(all, stack[depth].node, &one, d);
        total = total_of(d->importance);
        for (uint32_t i = 0; i < node->count; i++) {
            double part = d->importance[i] > 0 ? share * (d->importance[i] / total) : 0;
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

void MCR_ISA_NAME(mcr_emitter_tree_mass)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, double *mass,
                                         struct mcr_emitter_descent *d)
{
    for (uint32_t i = 0; i < points->n; i++)
        mass[i] = mass_at(all, points, i, d);
}
