/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The tree of boxes: one ray after the other through it, all children of a node at once and the nearest of them first; at its leaves packets of
 * shapes of one kind, all at once as well. Stage file, compiled once per instruction set.
 */
#include "accel/block.h"

#define WIDTH MCR_BVH_WIDTH

/* Levels of the tree at most, of which each leaves up to WIDTH - 1 children waiting; the builder keeps below (accel/build.c). */
#define LEVELS 96
#define STACK (LEVELS * WIDTH)

/*
 * Distances to boxes are off by 7 u at most (difference, inverse: 5, product; 1 more for `leave`). The farther side is moved out by more than twice
 * that, which makes the test conservative (Ize, "Robust BVH ray traversal", JCGT 2(2), 2013). What is compared with the nearer side and has no
 * error of its own, a ray's end, is moved out by little more than once that: a ray that ends at a rectangle (core/light.c) ends before its box.
 */
#define WIDEN (1 + 32 * 0x1p-53)
#define WIDEN_END (1 + 10 * 0x1p-53)

struct ray {
    double o[3], d[3], inverse[3];
    double leave[3]; /* the inverses, widened */
    uint32_t up[3];  /* the directions' signs: 1 where they do not go down */
    struct mcr_shear shear;
};

struct best {
    double t;
    int64_t primitive;
};

static inline double least(double a, double b)
{
    return a < b ? a : b;
}

static inline double most(double a, double b)
{
    return a > b ? a : b;
}

/* Where the ray enters each child's box, or +infinity. The inverses are finite and not 0, so nothing is NaN. */
static inline __attribute__((always_inline)) void enter_boxes(const struct mcr_bvh_node *node, const struct ray *ray, double limit, double *enter)
{
    const double *nx = node->side[1 - ray->up[0]][0], *fx = node->side[ray->up[0]][0];
    const double *ny = node->side[1 - ray->up[1]][1], *fy = node->side[ray->up[1]][1];
    const double *nz = node->side[1 - ray->up[2]][2], *fz = node->side[ray->up[2]][2];
    const double ox = ray->o[0], oy = ray->o[1], oz = ray->o[2];
    const double ix = ray->inverse[0], iy = ray->inverse[1], iz = ray->inverse[2];
    const double lx = ray->leave[0], ly = ray->leave[1], lz = ray->leave[2];
    MCR_LANES
    for (uint32_t i = 0; i < WIDTH; i++) {
        double ax = (nx[i] - ox) * ix, ay = (ny[i] - oy) * iy, az = (nz[i] - oz) * iz;
        double bx = (fx[i] - ox) * lx, by = (fy[i] - oy) * ly, bz = (fz[i] - oz) * lz;
        double a = ax > ay ? ax : ay, b = bx < by ? bx : by;
        az = az > 0 ? az : 0;
        bz = bz < limit ? bz : limit;
        a = a > az ? a : az;
        b = b < bz ? b : bz;
        enter[i] = a <= b ? a : INFINITY;
    }
}

/* Each lane's crossing, or +infinity. CALL works on row(j): constant j of the lane's shape. */
#define LANES(CALL)                                                                                                                     \
    do {                                                                                                                                \
        MCR_LANES                                                                                                                       \
        for (uint32_t i = 0; i < WIDTH; i++) {                                                                                          \
            double at;                                                                                                                  \
            int hit = CALL;                                                                                                             \
            t[i] = hit ? at : INFINITY;                                                                                                 \
        }                                                                                                                               \
    } while (0)
#define FACES(CALL)                                                                                                                     \
    do {                                                                                                                                \
        MCR_LANES                                                                                                                       \
        for (uint32_t i = 0; i < WIDTH; i++) {                                                                                          \
            double at, side;                                                                                                            \
            int hit = CALL;                                                                                                             \
            t[i] = hit ? at : INFINITY;                                                                                                 \
            face[i] = side;                                                                                                             \
        }                                                                                                                               \
    } while (0)
#define K5 ((double[]){k[0][i], k[1][i], k[2][i], k[3][i], k[4][i]})
#define K11 ((double[]){k[0][i], k[1][i], k[2][i], k[3][i], k[4][i], k[5][i], k[6][i], k[7][i], k[8][i], k[9][i], k[10][i]})
#define K12 ((double[]){k[0][i], k[1][i], k[2][i], k[3][i], k[4][i], k[5][i], k[6][i], k[7][i], k[8][i], k[9][i], k[10][i], k[11][i]})
#define K15 ((double[]){k[0][i], k[1][i], k[2][i], k[3][i], k[4][i], k[5][i], k[6][i], k[7][i], k[8][i], k[9][i], k[10][i], k[11][i], k[12][i], k[13][i], k[14][i]})

static inline __attribute__((always_inline)) void cross_packet(const struct mcr_bvh_packet *packet, const struct ray *r, double *t, double *face)
{
    const double (*k)[WIDTH] = packet->k;
    const double ox = r->o[0], oy = r->o[1], oz = r->o[2], dx = r->d[0], dy = r->d[1], dz = r->d[2];
    const double ix = r->inverse[0], iy = r->inverse[1], iz = r->inverse[2];
    const struct mcr_shear shear = r->shear;
    switch (packet->kind) {
    case MCR_ACCEL_TRIANGLE:
        LANES(kernel_triangle(&shear, k[0][i], k[1][i], k[2][i], k[3][i], k[4][i], k[5][i], k[6][i], k[7][i], k[8][i], ox, oy, oz, &at));
        break;
    case MCR_SHAPE_SPHERE:
        LANES(kernel_sphere(K5, ox, oy, oz, dx, dy, dz, &at));
        break;
    case MCR_SHAPE_ELLIPSOID:
        LANES(kernel_ellipsoid(K12, ox, oy, oz, dx, dy, dz, &at));
        break;
    case MCR_SHAPE_PARALLELOGRAM:
        LANES(kernel_parallelogram(K12, ox, oy, oz, dx, dy, dz, &at));
        break;
    case MCR_SHAPE_DISK:
        LANES(kernel_disk(K12, ox, oy, oz, dx, dy, dz, &at));
        break;
    case MCR_ACCEL_RECTANGLE:
        LANES(kernel_rectangle(K5, ox, ix, oy, dy, oz, dz, &at));
        break;
    case MCR_ACCEL_RECTANGLE + 1:
        LANES(kernel_rectangle(K5, oy, iy, oz, dz, ox, dx, &at));
        break;
    case MCR_ACCEL_RECTANGLE + 2:
        LANES(kernel_rectangle(K5, oz, iz, ox, dx, oy, dy, &at));
        break;
    case MCR_ACCEL_UPRIGHT:
        FACES(kernel_upright(K11, 0, ox, ix, oy, dy, oz, dz, &side, &at));
        break;
    case MCR_ACCEL_UPRIGHT + 1:
        FACES(kernel_upright(K11, 1, oy, iy, oz, dz, ox, dx, &side, &at));
        break;
    case MCR_ACCEL_UPRIGHT + 2:
        FACES(kernel_upright(K11, 2, oz, iz, ox, dx, oy, dy, &side, &at));
        break;
    default:
        FACES(kernel_box(K15, ox, oy, oz, dx, dy, dz, &side, &at));
    }
}

/* Takes what is nearer than the best so far; of equal ones the lower primitive. Lanes beyond the count repeat the first. */
static inline __attribute__((always_inline)) void consider(const struct mcr_bvh_packet *packet, const struct ray *ray, struct best *best)
{
    _Alignas(64) double t[WIDTH], face[WIDTH];
    int faces = packet->kind == MCR_SHAPE_BOX || (packet->kind >= MCR_ACCEL_UPRIGHT && packet->kind < MCR_ACCEL_TRIANGLE);
    cross_packet(packet, ray, t, face);
    if (least(least(least(t[0], t[4]), least(t[1], t[5])), least(least(t[2], t[6]), least(t[3], t[7]))) > best->t)
        return; /* most packets end here, with one branch */
    for (uint32_t i = 0; i < packet->count; i++) {
        if (!(t[i] <= best->t))
            continue;
        int64_t number = (int64_t)packet->primitive[i] + (faces ? (int64_t)face[i] : 0);
        if (t[i] < best->t || (best->primitive >= 0 && number < best->primitive)) {
            best->t = t[i];
            best->primitive = number;
        }
    }
}

/* A child that waits, and where the ray enters its box. */
struct waiting {
    double enter;
    uint32_t child;
};

/* Sorts so that the nearest is the last, which is taken first. */
static inline __attribute__((always_inline)) void sort_waiting(struct waiting *list, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        struct waiting one = list[i];
        uint32_t at = i;
        for (; at > 0 && list[at - 1].enter < one.enter; at--)
            list[at] = list[at - 1];
        list[at] = one;
    }
}

/* The nearest crossing before best->t; with `any`, the first that is found. */
static inline __attribute__((always_inline)) void traverse(const struct mcr_accel *accel, const struct ray *ray, struct best *best, int any)
{
    struct waiting stack[STACK];
    _Alignas(64) double enter[WIDTH];
    uint32_t top = 1;
    stack[0] = (struct waiting){0, 0};
    while (top) {
        struct waiting next = stack[--top];
        if (!any && next.enter > best->t * WIDEN_END)
            continue;
        if (next.child & MCR_BVH_PACKET) {
            consider((const struct mcr_bvh_packet *)(const void *)(accel->packet + (size_t)(next.child ^ MCR_BVH_PACKET) * MCR_BVH_LINE), ray, best);
            if (any && best->primitive >= 0)
                return;
            continue;
        }
        const struct mcr_bvh_node *node = &accel->node[next.child];
        enter_boxes(node, ray, best->t * WIDEN_END, enter);
        uint32_t bottom = top;
        for (uint32_t i = 0; i < WIDTH; i++) { /* without branches: which boxes are entered is hard to foresee */
            stack[top].enter = enter[i];
            stack[top].child = node->child[i];
            top += enter[i] < INFINITY;
        }
        if (!any)
            sort_waiting(stack + bottom, top - bottom);
    }
}

/* The wide shapes, in order of their numbers; what a ray meets among them is where its way through the tree ends. */
static inline __attribute__((always_inline)) void block_wide(const struct mcr_accel *accel, struct mcr_block *b)
{
    for (uint32_t w = 0; w < accel->wide_count; w++) {
        uint32_t item = accel->wide[w];
        if (item < accel->shape_count)
            block_shape(&accel->shape[item], b);
        else
            block_triangle(accel->triangles, item - accel->shape_count, b);
    }
}

/* Lists the rays that come into the box around the tree before what they have met; with `any`, those that have met nothing. Returns their number. */
static inline __attribute__((always_inline)) uint32_t block_enter(const struct mcr_accel *accel, const struct mcr_block *b, int any, uint32_t *list)
{
    _Alignas(64) double enters[MCR_ACCEL_BLOCK];
    const double lx = accel->lo[0], ly = accel->lo[1], lz = accel->lo[2], hx = accel->hi[0], hy = accel->hi[1], hz = accel->hi[2];
    uint32_t count = 0;
    if (!accel->node_count)
        return 0;
    MCR_LANES
    for (uint32_t i = 0; i < MCR_ACCEL_BLOCK; i++) {
        double ax = (lx - b->ox[i]) * b->inverse[0][i], bx = (hx - b->ox[i]) * b->inverse[0][i];
        double ay = (ly - b->oy[i]) * b->inverse[1][i], by = (hy - b->oy[i]) * b->inverse[1][i];
        double az = (lz - b->oz[i]) * b->inverse[2][i], bz = (hz - b->oz[i]) * b->inverse[2][i];
        double enter = least(ax, bx), leave = most(ax, bx);
        enter = most(enter, least(ay, by));
        leave = least(leave, most(ay, by));
        enter = most(enter, least(az, bz));
        leave = least(leave, most(az, bz));
        enter = enter > 0 ? enter : 0;
        leave = least(leave * WIDEN, b->t[i] * WIDEN_END);
        int met = any & (b->primitive[i] >= 0);
        enters[i] = ((enter <= leave) & !met) ? 1.0 : 0.0;
    }
    for (uint32_t i = 0; i < b->count; i++) {
        list[count] = i;
        count += enters[i] > 0;
    }
    return count;
}

static inline __attribute__((always_inline)) struct best block_ray(const struct mcr_accel *accel, const struct mcr_block *b, uint32_t i, int any)
{
    struct best best = {b->t[i], (int64_t)b->primitive[i]};
    struct ray ray = {.o = {b->ox[i], b->oy[i], b->oz[i]}, .d = {b->dx[i], b->dy[i], b->dz[i]}};
    for (int j = 0; j < 3; j++) {
        ray.inverse[j] = b->inverse[j][i];
        ray.leave[j] = b->inverse[j][i] * WIDEN;
        ray.up[j] = b->inverse[j][i] >= 0;
    }
    for (int j = 0; j < 3 && accel->triangles->count; j++) {
        ray.shear.p[j] = b->form[j][i];
        ray.shear.q[j] = b->form[3 + j][i];
        ray.shear.r[j] = b->form[6 + j][i];
    }
    traverse(accel, &ray, &best, any);
    return best;
}

void MCR_ISA_NAME(mcr_bvh_closest)(const struct mcr_accel *accel, const struct mcr_rays *rays, double *t, int64_t *primitive)
{
    for (uint32_t first = 0; first < rays->n; first += MCR_ACCEL_BLOCK) {
        struct mcr_block b;
        uint32_t list[MCR_ACCEL_BLOCK];
        block_begin(accel, rays, first, NULL, 1, &b);
        block_wide(accel, &b);
        uint32_t count = block_enter(accel, &b, 0, list);
        block_end(&b, t + first, primitive + first);
        for (uint32_t l = 0; l < count; l++) {
            struct best best = block_ray(accel, &b, list[l], 0);
            t[first + list[l]] = best.t;
            primitive[first + list[l]] = best.primitive;
        }
    }
}

void MCR_ISA_NAME(mcr_bvh_visible)(const struct mcr_accel *accel, const struct mcr_rays *rays, const double *far, double *visible)
{
    for (uint32_t first = 0; first < rays->n; first += MCR_ACCEL_BLOCK) {
        struct mcr_block b;
        uint32_t list[MCR_ACCEL_BLOCK];
        block_begin(accel, rays, first, far, 1, &b);
        block_wide(accel, &b);
        uint32_t count = block_enter(accel, &b, 1, list);
        MCR_LANES
        for (uint32_t i = 0; i < b.count; i++)
            visible[first + i] = b.primitive[i] < 0 ? 1.0 : 0.0;
        for (uint32_t l = 0; l < count; l++)
            visible[first + list[l]] = block_ray(accel, &b, list[l], 1).primitive < 0 ? 1.0 : 0.0;
    }
}

const struct mcr_accel_functions MCR_ISA_NAME(mcr_accel_functions)[2] = {
    {MCR_ISA_NAME(mcr_list_closest), MCR_ISA_NAME(mcr_list_visible)},
    {MCR_ISA_NAME(mcr_bvh_closest), MCR_ISA_NAME(mcr_bvh_visible)},
};
