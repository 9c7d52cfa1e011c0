/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The tree of boxes: one ray after the other through it, all children of a node at once and the nearest of them first; at its leaves packets of
 * shapes of one kind, all at once as well. Stage file, compiled once per instruction set.
 */
#include "accel/isa.h"
#include "accel/kernels.h"

#define WIDTH MCR_BVH_WIDTH

/* Levels of the tree at most, of which each leaves up to WIDTH - 1 children waiting; the builder keeps below (accel/build.c). */
#define LEVELS 96
#define STACK (LEVELS * WIDTH)

/*
 * Distances to boxes are off by 7 u at most (difference, inverse: 5, product; 1 more for `leave`). What is compared with the nearer side is moved
 * out by more than twice that, which makes the test conservative (Ize, "Robust BVH ray traversal", JCGT 2(2), 2013).
 */
#define WIDEN (1 + 32 * 0x1p-53)

struct ray {
    double o[3], d[3], inverse[3];
    double leave[3]; /* the inverses, widened */
    uint32_t up[3];  /* the directions' signs: 1 where they do not go down */
    struct mcr_shear shear;
};

/* What a block of rays has in common with the list's: everything that can be done for all of them at once. */
struct block {
    _Alignas(64) double inverse[3][MCR_ACCEL_BLOCK];
    _Alignas(64) double form[9][MCR_ACCEL_BLOCK];  /* struct mcr_shear, where there are triangles */
    _Alignas(64) double t[MCR_ACCEL_BLOCK];
    _Alignas(64) double primitive[MCR_ACCEL_BLOCK]; /* whole numbers; -1: nothing met */
};

struct best {
    double t;
    int64_t primitive;
};

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

static inline double least(double a, double b)
{
    return a < b ? a : b;
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
        if (!any && next.enter > best->t * WIDEN)
            continue;
        if (next.child & MCR_BVH_PACKET) {
            consider((const struct mcr_bvh_packet *)(const void *)(accel->packet + (size_t)(next.child ^ MCR_BVH_PACKET) * MCR_BVH_LINE), ray, best);
            if (any && best->primitive >= 0)
                return;
            continue;
        }
        const struct mcr_bvh_node *node = &accel->node[next.child];
        enter_boxes(node, ray, best->t * WIDEN, enter);
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

/* The planes, and what the tree needs of each ray, for the rays from `first` on. */
static void block_begin(const struct mcr_accel *accel, const struct mcr_rays *rays, uint32_t first, uint32_t count, const double *far, struct block *b)
{
    const double *ox = rays->ox + first, *oy = rays->oy + first, *oz = rays->oz + first;
    const double *dx = rays->dx + first, *dy = rays->dy + first, *dz = rays->dz + first;
    uint32_t padded = (count + MCR_LANE_PAD - 1) / MCR_LANE_PAD * MCR_LANE_PAD;
    for (uint32_t i = 0; i < padded; i++) {
        b->t[i] = far && i < count ? far[first + i] : INFINITY;
        b->primitive[i] = -1;
    }
    MCR_LANES
    for (uint32_t i = 0; i < padded; i++) {
        double inverse[3];
        kernel_inverse(dx[i], dy[i], dz[i], inverse);
        b->inverse[0][i] = inverse[0];
        b->inverse[1][i] = inverse[1];
        b->inverse[2][i] = inverse[2];
    }
    if (accel->triangles->count) {
        MCR_LANES
        for (uint32_t i = 0; i < padded; i++) {
            struct mcr_shear s = kernel_shear(dx[i], dy[i], dz[i]);
            for (int j = 0; j < 3; j++) {
                b->form[j][i] = s.p[j];
                b->form[3 + j][i] = s.q[j];
                b->form[6 + j][i] = s.r[j];
            }
        }
    }
    for (uint32_t p = 0; p < accel->plane_count; p++) {
        const struct mcr_accel_shape *plane = &accel->shape[accel->plane[p]];
        const double k[6] = {plane->k[0], plane->k[1], plane->k[2], plane->k[3], plane->k[4], plane->k[5]}, number = plane->primitive;
        MCR_LANES
        for (uint32_t i = 0; i < padded; i++) {
            double t, was = b->primitive[i], best = b->t[i];
            int nearer = kernel_plane(k, ox[i], oy[i], oz[i], dx[i], dy[i], dz[i], &t) & (t < best);
            b->primitive[i] = nearer ? number : was;
            b->t[i] = nearer ? t : best;
        }
    }
}

static inline __attribute__((always_inline)) struct best block_ray(const struct mcr_accel *accel, const struct mcr_rays *rays, uint32_t first, uint32_t i, const struct block *b, int any)
{
    struct best best = {b->t[i], (int64_t)b->primitive[i]};
    if (!accel->node_count || (any && best.primitive >= 0))
        return best;
    uint32_t n = first + i;
    struct ray ray = {.o = {rays->ox[n], rays->oy[n], rays->oz[n]}, .d = {rays->dx[n], rays->dy[n], rays->dz[n]}};
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
    struct block block;
    for (uint32_t first = 0; first < rays->n; first += MCR_ACCEL_BLOCK) {
        uint32_t count = rays->n - first < MCR_ACCEL_BLOCK ? rays->n - first : MCR_ACCEL_BLOCK;
        block_begin(accel, rays, first, count, NULL, &block);
        for (uint32_t i = 0; i < count; i++) {
            struct best best = block_ray(accel, rays, first, i, &block, 0);
            t[first + i] = best.t;
            primitive[first + i] = best.primitive;
        }
    }
}

void MCR_ISA_NAME(mcr_bvh_visible)(const struct mcr_accel *accel, const struct mcr_rays *rays, const double *far, double *visible)
{
    struct block block;
    for (uint32_t first = 0; first < rays->n; first += MCR_ACCEL_BLOCK) {
        uint32_t count = rays->n - first < MCR_ACCEL_BLOCK ? rays->n - first : MCR_ACCEL_BLOCK;
        block_begin(accel, rays, first, count, far, &block);
        for (uint32_t i = 0; i < count; i++)
            visible[first + i] = block_ray(accel, rays, first, i, &block, 1).primitive < 0 ? 1.0 : 0.0;
    }
}

const struct mcr_accel_functions MCR_ISA_NAME(mcr_accel_functions)[2] = {
    {MCR_ISA_NAME(mcr_list_closest), MCR_ISA_NAME(mcr_list_visible)},
    {MCR_ISA_NAME(mcr_bvh_closest), MCR_ISA_NAME(mcr_bvh_visible)},
};
