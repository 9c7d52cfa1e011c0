/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Accelerators: closest hit and occlusion for a batch of rays.
 *
 * All work in double on the shapes of a scene, in render space, with the same kernels (accel/kernels.h): `list` and `bvh` give the same
 * bits. A hit is the crossing of smallest t > 0; of equal ones that of the lowest primitive number. Immutable after creation, so that any number
 * of threads may ask at once.
 */
#ifndef MCR_ACCEL_ACCEL_H
#define MCR_ACCEL_ACCEL_H

#include "base/arena.h"
#include "scene/scene.h"

/* n rays; directions are unit. Arrays are 64-byte aligned and padded to 8: the padding is read and computed with, its results are garbage. */
struct mcr_rays {
    uint32_t n;
    const double *ox, *oy, *oz;
    const double *dx, *dy, *dz;
};

/* Lanes that the list handles at once, so that rays and results stay in the first-level cache. */
#define MCR_ACCEL_BLOCK 64u

/*
 * A shape as the kernels want it: k is, by kind,
 *   plane          point, normal
 *   parallelogram, disk   corner or centre, normal, dual vectors of the two edges or half axes
 *   sphere         centre, radius, radius^2
 *   ellipsoid      centre, rows of the inverse of the half axes
 *   box            corner, unit inward normals of the three faces through it, their distances to the opposite ones
 *   rectangle across axis 0, 1 or 2: a parallelogram whose edges are along the other two: its coordinate, and its extent along them in cyclic order
 *   upright box    one whose edge 0, 1 or 2 runs along that axis, the others being turned about it: see kernel_upright
 */
struct mcr_accel_shape {
    uint32_t kind;        /* enum mcr_shape_kind, or one of these */
    uint32_t primitive;
    double k[15];
};
#define MCR_ACCEL_RECTANGLE 16u /* + axis */
#define MCR_ACCEL_UPRIGHT 20u   /* + axis */

/* Children of a node and items of a packet: what is tested at once. */
#define MCR_BVH_WIDTH 8u

/* Boxes of the children, rounded outward: side[0] the low ones, side[1] the high ones, by axis. Where there is no child, nothing is between them. */
struct mcr_bvh_node {
    double side[2][3][MCR_BVH_WIDTH];
    uint32_t child[MCR_BVH_WIDTH]; /* a node; or the line of a packet and MCR_BVH_PACKET */
    uint32_t padding[8];
};
#define MCR_BVH_PACKET 0x80000000u

/*
 * A leaf of the tree: items of one kind, and behind this line of 64 bytes their constants, a row of MCR_BVH_WIDTH for each: what
 * struct mcr_accel_shape holds, or the vertices of triangles. The lanes beyond `count` repeat the first.
 */
struct mcr_bvh_packet {
    uint32_t kind;        /* as in struct mcr_accel_shape, or MCR_ACCEL_TRIANGLE */
    uint32_t count;
    uint32_t primitive[MCR_BVH_WIDTH];
    uint32_t padding[6];
    double k[][MCR_BVH_WIDTH];
};
#define MCR_ACCEL_TRIANGLE 24u
#define MCR_BVH_LINE 64u

struct mcr_accel {
    uint32_t kind;        /* MCR_ACCEL_LIST or MCR_ACCEL_BVH */
    uint32_t shape_count;
    int inverses;         /* some shapes, rectangles or upright boxes, want the inverses of the directions */
    struct mcr_accel_shape *shape;            /* in order of their primitive numbers */
    const struct mcr_triangles *triangles;
    /* bvh only */
    uint32_t wide_count;
    uint32_t *wide;                           /* asked for every ray: shapes, and beyond shape_count triangles; by their numbers */
    double lo[3], hi[3];                      /* bounds of the tree */
    uint32_t node_count;
    struct mcr_bvh_node *node;                /* the root first */
    unsigned char *packet;                    /* struct mcr_bvh_packet, found by their lines */
};

/*
 * Up to this many shapes and triangles `auto` takes the list. Both cost the same, in the rooms of `make bench` (list against bvh), at about 20 with
 * the baseline's instructions, at 30 with AVX2 and at 35-60 with AVX-512.
 */
#define MCR_ACCEL_LIST_LIMIT 32u

/* kind: MCR_ACCEL_*; auto takes the list for few shapes. NULL when memory is short. */
struct mcr_accel *mcr_accel_create(struct mcr_arena *arena, const struct mcr_scene *scene, uint32_t kind);

/* One set of these for each instruction set. */
struct mcr_accel_functions {
    /* Stores t (infinity for a miss) and the primitive's number (-1). */
    void (*closest)(const struct mcr_accel *accel, const struct mcr_rays *rays, double *t, int64_t *primitive);
    /* `far` holds each ray's length; stores 1 where nothing is crossed at 0 < t < far, else 0. */
    void (*visible)(const struct mcr_accel *accel, const struct mcr_rays *rays, const double *far, double *visible);
};

/* The list first, then the bvh; instruction sets 1 and 2 on x86-64 only. */
extern const struct mcr_accel_functions mcr_accel_functions_isa0[2], mcr_accel_functions_isa1[2], mcr_accel_functions_isa2[2];

#endif
