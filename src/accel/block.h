/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A block of rays against one shape after the other, as many rays at once as a vector holds: how the list works, and how the tree asks for the
 * shapes that most rays come near. Private to the accelerators' stage files.
 */
#ifndef MCR_ACCEL_BLOCK_H
#define MCR_ACCEL_BLOCK_H

#include <string.h>

#include "accel/isa.h"
#include "accel/kernels.h"

/*
 * One block's rays and what they have met so far. It lives on the stack and is seen whole after inlining: only then may the compiler turn the
 * conditional stores into selects.
 */
struct mcr_block {
    uint32_t count; /* rays; results beyond are garbage */
    const double *ox, *oy, *oz, *dx, *dy, *dz;
    _Alignas(64) double inverse[3][MCR_ACCEL_BLOCK]; /* of the directions, where something wants them */
    _Alignas(64) double form[9][MCR_ACCEL_BLOCK];    /* struct mcr_shear, where there are triangles */
    _Alignas(64) double t[MCR_ACCEL_BLOCK];
    _Alignas(64) double primitive[MCR_ACCEL_BLOCK]; /* a whole number: as such it takes part in the same selects as t on plain SSE2; -1: nothing */
    _Alignas(64) double copy[6][MCR_ACCEL_BLOCK];   /* of a short block, so that the loops have a constant count */
};

/* The shapes come in order of their numbers, so that "strictly nearer" leaves ties to the lower one. */
#define LOOP_OVER_RAYS(KERNEL)                                                                                                          \
    do {                                                                                                                                \
        MCR_LANES                                                                                                                       \
        for (uint32_t i = 0; i < MCR_ACCEL_BLOCK; i++) {                                                                                \
            double t, was = b->primitive[i], best = b->t[i];                                                                            \
            int nearer = KERNEL(k, b->ox[i], b->oy[i], b->oz[i], b->dx[i], b->dy[i], b->dz[i], &t) & (t < best);                        \
            b->primitive[i] = nearer ? number : was;                                                                                    \
            b->t[i] = nearer ? t : best;                                                                                                \
        }                                                                                                                               \
    } while (0)

/* O, P, Q: the coordinates of the origin, D, E those of the direction, beginning with the rectangle's axis. */
#define RECTANGLE(AXIS, O, P, D, Q, E)                                                                                                  \
    do {                                                                                                                                \
        MCR_LANES                                                                                                                       \
        for (uint32_t i = 0; i < MCR_ACCEL_BLOCK; i++) {                                                                                \
            double t, was = b->primitive[i], best = b->t[i];                                                                            \
            int nearer = kernel_rectangle(k, b->O[i], b->inverse[AXIS][i], b->P[i], b->D[i], b->Q[i], b->E[i], &t) & (t < best);        \
            b->primitive[i] = nearer ? number : was;                                                                                    \
            b->t[i] = nearer ? t : best;                                                                                                \
        }                                                                                                                               \
    } while (0)

#define UPRIGHT(AXIS, O, P, D, Q, E)                                                                                                    \
    do {                                                                                                                                \
        MCR_LANES                                                                                                                       \
        for (uint32_t i = 0; i < MCR_ACCEL_BLOCK; i++) {                                                                                \
            double t, face, was = b->primitive[i], best = b->t[i];                                                                      \
            int nearer = kernel_upright(k, AXIS, b->O[i], b->inverse[AXIS][i], b->P[i], b->D[i], b->Q[i], b->E[i], &face, &t) & (t < best); \
            b->primitive[i] = nearer ? number + face : was;                                                                             \
            b->t[i] = nearer ? t : best;                                                                                                \
        }                                                                                                                               \
    } while (0)

static inline __attribute__((always_inline)) void block_shape(const struct mcr_accel_shape *shape, struct mcr_block *b)
{
    double k[15];
    double number = shape->primitive;
    for (int j = 0; j < 15; j++)
        k[j] = shape->k[j];
    switch (shape->kind) {
    case MCR_SHAPE_PLANE:
        LOOP_OVER_RAYS(kernel_plane);
        break;
    case MCR_SHAPE_SPHERE:
        LOOP_OVER_RAYS(kernel_sphere);
        break;
    case MCR_SHAPE_ELLIPSOID:
        LOOP_OVER_RAYS(kernel_ellipsoid);
        break;
    case MCR_SHAPE_PARALLELOGRAM:
        LOOP_OVER_RAYS(kernel_parallelogram);
        break;
    case MCR_SHAPE_DISK:
        LOOP_OVER_RAYS(kernel_disk);
        break;
    case MCR_ACCEL_RECTANGLE:
        RECTANGLE(0, ox, oy, dy, oz, dz);
        break;
    case MCR_ACCEL_RECTANGLE + 1:
        RECTANGLE(1, oy, oz, dz, ox, dx);
        break;
    case MCR_ACCEL_RECTANGLE + 2:
        RECTANGLE(2, oz, ox, dx, oy, dy);
        break;
    case MCR_ACCEL_UPRIGHT:
        UPRIGHT(0, ox, oy, dy, oz, dz);
        break;
    case MCR_ACCEL_UPRIGHT + 1:
        UPRIGHT(1, oy, oz, dz, ox, dx);
        break;
    case MCR_ACCEL_UPRIGHT + 2:
        UPRIGHT(2, oz, ox, dx, oy, dy);
        break;
    default:
        MCR_LANES
        for (uint32_t i = 0; i < MCR_ACCEL_BLOCK; i++) {
            double face;
            double t, was = b->primitive[i], best = b->t[i];
            int nearer = kernel_box(k, b->ox[i], b->oy[i], b->oz[i], b->dx[i], b->dy[i], b->dz[i], &face, &t) & (t < best);
            b->primitive[i] = nearer ? number + face : was;
            b->t[i] = nearer ? t : best;
        }
    }
}

static inline __attribute__((always_inline)) void block_triangle(const struct mcr_triangles *triangles, uint32_t f, struct mcr_block *b)
{
    const uint32_t *v = triangles->vertex[f];
    double ax = triangles->x[v[0]], ay = triangles->y[v[0]], az = triangles->z[v[0]];
    double bx = triangles->x[v[1]], by = triangles->y[v[1]], bz = triangles->z[v[1]];
    double cx = triangles->x[v[2]], cy = triangles->y[v[2]], cz = triangles->z[v[2]];
    double number = (double)triangles->first_primitive + f;
    MCR_LANES
    for (uint32_t i = 0; i < MCR_ACCEL_BLOCK; i++) {
        struct mcr_shear s = {{b->form[0][i], b->form[1][i], b->form[2][i]}, {b->form[3][i], b->form[4][i], b->form[5][i]}, {b->form[6][i], b->form[7][i], b->form[8][i]}};
        double t, was = b->primitive[i], best = b->t[i];
        int nearer = kernel_triangle(&s, ax, ay, az, bx, by, bz, cx, cy, cz, b->ox[i], b->oy[i], b->oz[i], &t) & (t < best);
        b->primitive[i] = nearer ? number : was;
        b->t[i] = nearer ? t : best;
    }
}

/* What was met, to the caller's arrays. */
static inline __attribute__((always_inline)) void block_end(const struct mcr_block *b, double *t, int64_t *primitive)
{
    memcpy(t, b->t, b->count * sizeof *t);
    MCR_LANES
    for (uint32_t i = 0; i < b->count; i++)
        primitive[i] = (int64_t)b->primitive[i];
}

static inline __attribute__((always_inline)) void block_inverses(struct mcr_block *b)
{
    MCR_LANES
    for (uint32_t i = 0; i < MCR_ACCEL_BLOCK; i++) {
        double inverse[3];
        kernel_inverse(b->dx[i], b->dy[i], b->dz[i], inverse);
        b->inverse[0][i] = inverse[0];
        b->inverse[1][i] = inverse[1];
        b->inverse[2][i] = inverse[2];
    }
}

static inline __attribute__((always_inline)) void block_forms(struct mcr_block *b)
{
    MCR_LANES
    for (uint32_t i = 0; i < MCR_ACCEL_BLOCK; i++) {
        struct mcr_shear s = kernel_shear(b->dx[i], b->dy[i], b->dz[i]);
        for (int j = 0; j < 3; j++) {
            b->form[j][i] = s.p[j];
            b->form[3 + j][i] = s.q[j];
            b->form[6 + j][i] = s.r[j];
        }
    }
}

/*
 * The rays first .. first + MCR_ACCEL_BLOCK - 1 as far as there are any; `far` bounds t (NULL: no bound). `inverses`: whether they are wanted.
 * No initializer where the block is made: it would clear the arrays.
 */
static inline __attribute__((always_inline)) void block_begin(const struct mcr_accel *accel, const struct mcr_rays *rays, uint32_t first, const double *far,
                                                              int inverses, struct mcr_block *b)
{
    const uint32_t count = rays->n - first < MCR_ACCEL_BLOCK ? rays->n - first : MCR_ACCEL_BLOCK;
    b->count = count;
    b->ox = rays->ox + first, b->oy = rays->oy + first, b->oz = rays->oz + first;
    b->dx = rays->dx + first, b->dy = rays->dy + first, b->dz = rays->dz + first;
    if (count < MCR_ACCEL_BLOCK) {
        const double *from[6] = {b->ox, b->oy, b->oz, b->dx, b->dy, b->dz};
        for (int j = 0; j < 6; j++)
            for (uint32_t i = 0; i < MCR_ACCEL_BLOCK; i++)
                b->copy[j][i] = i < count ? from[j][i] : 0;
        b->ox = b->copy[0], b->oy = b->copy[1], b->oz = b->copy[2], b->dx = b->copy[3], b->dy = b->copy[4], b->dz = b->copy[5];
    }
    for (uint32_t i = 0; i < MCR_ACCEL_BLOCK; i++) {
        b->t[i] = INFINITY;
        b->primitive[i] = -1;
    }
    for (uint32_t i = 0; far && i < count; i++)
        b->t[i] = far[first + i];
    if (inverses)
        block_inverses(b);
    if (accel->triangles->count)
        block_forms(b);
}

#endif
