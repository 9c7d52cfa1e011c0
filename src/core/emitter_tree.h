/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The tree of many emitters: wide nodes, eight children side by side, so that one lane looks at all of them at once and what it does depends
 * on nothing but itself. The same tree serves two ends, each with an array of its own: which emitters a ray crosses (boxes), and with which
 * probability an emitter is chosen at a point (bounds of light). Emitters are in the order of the leaves. Private to the emitters' files.
 */
#ifndef MCR_CORE_EMITTER_TREE_H
#define MCR_CORE_EMITTER_TREE_H

#include "core/emitters.h"

#define MCR_TREE_WIDTH 8u

/*
 * Levels of wide nodes there can be: a wide level goes down one level of the binary tree that it is made from or more, and that is split by
 * cost for the first MCR_TREE_BY_COST levels, then in halves, of which a 32-bit count allows 32.
 */
#define MCR_TREE_BY_COST 28u
#define MCR_TREE_DEPTH (MCR_TREE_BY_COST + 33u)

/* Where a node or an emitter hangs: its parent's number and its place there; MCR_TREE_ROOT for the root. */
#define MCR_TREE_PLACE(node, slot) ((uint64_t)(node) << 3 | (slot))
#define MCR_TREE_ROOT UINT64_MAX

/* Boxes of the children, a little too large. child: a node's number, or ~ an emitter's. */
struct mcr_emitter_node {
    double lo[3][MCR_TREE_WIDTH], hi[3][MCR_TREE_WIDTH];
    int32_t child[MCR_TREE_WIDTH];
    uint32_t count; /* of the children that there are */
};

/*
 * Bounds of the children's light, for a point p (A. Conty Estevez, C. Kulla, "Importance sampling of many lights with adaptive tree
 * splitting", Proc. ACM Comput. Graph. Interact. Tech. 1(2), 2018): a ball around the emitters, and a cone around their normals. Unused
 * children have power 0.
 *
 * Single precision is enough to choose by, and half as much to load; so that it has the range, too, each node has a frame of its own: a
 * point p of the world is (p - origin) * scale there, the children lie in [-1, 1]^3, and powers are relative to the node's largest. Balls
 * and cones are larger than what is in them by more than all roundings of the numbers here and in emitter_choose.c: MCR_TREE_SLACK and
 * MCR_TREE_GRACE.
 */
struct mcr_emitter_bounds { /* whole cache lines */
    _Alignas(64) float c[3][MCR_TREE_WIDTH]; /* centre of the ball */
    float radius[MCR_TREE_WIDTH];            /* at least MCR_TREE_SLACK */
    float axis[3][MCR_TREE_WIDTH];           /* of the cone, unit */
    float open[MCR_TREE_WIDTH];              /* of its half angle t: sin t below a quarter turn, 1 - cos t above; and MCR_TREE_GRACE */
    float lift[MCR_TREE_WIDTH];              /* no q of the ball's emitters with a normal n there has n.(c - q) above this */
    float fold[MCR_TREE_WIDTH];              /* 1: both sides of the cone emit, -1: the axis' side does */
    float within[MCR_TREE_WIDTH];            /* square of the distance from c beyond which nothing is seen */
    float power[MCR_TREE_WIDTH];             /* of the sides that a point can see at once: MCR_TREE_LEAST_POWER .. MCR_TREE_POWER, or 0 */
    int32_t child[MCR_TREE_WIDTH];           /* as in struct mcr_emitter_node */
    double origin[3], scale;                 /* scale: a power of two */
    uint64_t place;
    uint32_t count;
};

/* What lengths in a node's frame are enlarged by, and cosines near a horizon are lifted by, far above roundings of single precision. */
#define MCR_TREE_SLACK 0x1p-20f
#define MCR_TREE_GRACE 0x1p-19f

/*
 * A point farther than this from a node's origin, in its frame, is taken for one at that distance in the same direction: from there, the
 * children are all in one direction to 2^-23.
 */
#define MCR_TREE_FAR 0x1p24

/*
 * Powers in a node. With these limits an importance that is not 0 is in 2^-82 .. 2^120: the inverse square of a distance is in 2^-50 ..
 * 2^40; a cosine at the emitters that is not 0 is above 2^-46, since sums of numbers of which one is above 2^-20 are multiples of 2^-44;
 * that at the surface is above 2^-26.
 */
#define MCR_TREE_POWER 0x1p80f
#define MCR_TREE_LEAST_POWER 0x1p40f

#endif
