/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Working memory of the emitters' stage files, and what they share: the services work on blocks of lanes that stay in the first cache;
 * lanes for which something expensive is to be done are listed, gathered, computed side by side and scattered.
 */
#ifndef MCR_CORE_EMITTER_LANES_H
#define MCR_CORE_EMITTER_LANES_H

#include "base/lanes.h"
#include "core/emitters.h"

/* Lanes of a block. */
#define MCR_EMITTER_BLOCK 128u

/* Lanes side by side: point; numbers u, v or direction; results. Arrays of the caller, or of a pack. Normals: NULL or for the tree. */
struct mcr_emitter_lanes {
    uint32_t n;
    const double *px, *py, *pz, *u, *v;
    double *wx, *wy, *wz, *density, *distance;
    const double *nx, *ny, *nz;
};

typedef double mcr_emitter_row[MCR_EMITTER_BLOCK];
typedef float mcr_emitter_thin[MCR_EMITTER_BLOCK];

/* Gathered lanes with the constants of an emitter each. */
struct mcr_emitter_pack {
    mcr_emitter_row px, py, pz, u, v, wx, wy, wz, density, distance;
    mcr_emitter_row k[MCR_K_SIZE];
    int32_t lane[MCR_EMITTER_BLOCK];
};

/* Disks by solid angle: the cones of all lanes, and a chunk of lanes whose sweeps have as many nodes. */
#define MCR_DISK_CHUNK 32u
#define MCR_DISK_NODES 32u
#define MCR_DISK_ROWS 11u

typedef double mcr_disk_row[MCR_DISK_CHUNK];

struct mcr_disk_chunk {
    mcr_disk_row cone[MCR_DISK_ROWS];
    mcr_disk_row u, v, p, q, mean, phi, b1, b2, sine, twice, wx, wy, wz, density;
    mcr_disk_row g[MCR_DISK_NODES], series[MCR_DISK_NODES];
};

struct mcr_disk_scratch {
    mcr_emitter_row cone[MCR_DISK_ROWS]; /* axis, a and b along their axes, a^2, b^2 */
    mcr_emitter_row nodes;               /* 8, 16, 32; 0: by area; -1: not seen */
    int32_t list[MCR_EMITTER_BLOCK];
    struct mcr_disk_chunk chunk;
};

/* Triangles and parallelograms by solid angle: struct sweep of each lane. */
#define MCR_SWEEP_ROWS 12u

struct mcr_solid_scratch {
    struct mcr_disk_scratch disk;
    mcr_emitter_row sweep[MCR_SWEEP_ROWS];
};

/*
 * emitter_tree.c: puts more than MCR_EMITTERS_FEW emitters, whose probabilities are set, into a tree and into its order. Returns 0, or -1
 * when memory is short.
 */
int mcr_emitter_tree_build(struct mcr_emitters *all, struct mcr_arena *arena);

/* Pairs of a lane and an emitter whose box the lane's ray crosses, and what they add to the lane's density. */
struct mcr_emitter_pairs {
    uint32_t count;
    int32_t lane[MCR_EMITTER_BLOCK], list[MCR_EMITTER_BLOCK];
    int64_t emitter[MCR_EMITTER_BLOCK];
    mcr_emitter_row value, share, flag;
};

/*
 * Lanes on their way down the tree, side by side: their nodes, the points in the nodes' frames, the importances of the eight children (those
 * of a lane one after the other), the chosen ones, the probability of having come there, and what is left of the number that chooses.
 */
struct mcr_emitter_descent {
    double importance[8 * MCR_EMITTER_BLOCK];
    mcr_emitter_row number, share, slot;
    mcr_emitter_thin point[3], away[4]; /* away: by lanes of the block */
    int32_t node[MCR_EMITTER_BLOCK], lane[MCR_EMITTER_BLOCK];
};

struct mcr_emitter_scratch {
    mcr_emitter_row total;                /* sum of the probabilities of the emitters that are seen, then its inverse */
    mcr_emitter_row share;                /* of the chosen emitter, before division by the total */
    mcr_emitter_row wx, wy, wz, density, distance, flag;
    int64_t chosen[MCR_EMITTER_BLOCK];    /* emitter, -1: none */
    int32_t list[MCR_EMITTER_BLOCK];
    struct mcr_emitter_pack pack, second; /* second: those of the pack that fall back to area */
    struct mcr_emitter_pack wanted;       /* lanes that the caller wants, where it does not want all */
    mcr_emitter_row number;               /* theirs that choose the emitter */
    mcr_emitter_row normal[3];            /* theirs */
    struct mcr_solid_scratch solid;
    struct mcr_emitter_pairs pairs;
    struct mcr_emitter_descent descent;
};

/* emitter_kernels.c. Flags (1 or 0) the lanes whose rays (p; w) cross emitter e and that see it. */
void MCR_ISA_NAME(mcr_emitter_cross)(const struct mcr_emitters *all, uint32_t e, const struct mcr_emitter_lanes *lanes, double *flag);
/* The same for lanes of one kind with the constants of an emitter each: constant j of lane i is k[j * MCR_EMITTER_BLOCK + i]. */
void MCR_ISA_NAME(mcr_emitter_cross_each)(uint32_t kind, const struct mcr_emitter_lanes *lanes, const double *k, double *flag);
/* Sets distance to 1 in the lanes that see emitter e, else to 0. */
void MCR_ISA_NAME(mcr_emitter_seen)(const struct mcr_emitters *all, uint32_t e, const struct mcr_emitter_lanes *lanes);
/*
 * For lanes of one kind; `varying` tells whether constant j of lane i is k[j * MCR_EMITTER_BLOCK + i] or k[j].
 * density: of directions that cross. `alone`: the density of the one point at `distance`.
 */
void MCR_ISA_NAME(mcr_emitter_density)(const struct mcr_emitters *all, uint32_t kind, uint32_t by, int alone,
                                       const struct mcr_emitter_lanes *lanes,
                                       const double *k, int varying, struct mcr_solid_scratch *scratch);
/* distance: to what is seen in direction w. */
void MCR_ISA_NAME(mcr_emitter_distance)(uint32_t kind, const struct mcr_emitter_lanes *lanes, const double *k, int varying);
/* Draws w, density and distance (0 where it was drawn by solid angle); density NOT_STEADY: is to be drawn by area. */
void MCR_ISA_NAME(mcr_emitter_draw)(const struct mcr_emitters *all, uint32_t kind, uint32_t by, int alone,
                                    const struct mcr_emitter_lanes *lanes, const double *k, int varying, struct mcr_solid_scratch *scratch);

/*
 * emitter_choose.c, with the tree. Chooses an emitter for each lane: `chosen` (-1: none) and its probability `share`.
 */
void MCR_ISA_NAME(mcr_emitter_choose)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, const double *number,
                                      struct mcr_emitter_scratch *scratch);
/* The probability with which emitter e is chosen in lane i, to the bit. */
double MCR_ISA_NAME(mcr_emitter_chance)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, uint32_t i, uint32_t e,
                                        struct mcr_emitter_descent *scratch);
/* Sums over the emitters that lanes see the probabilities that they are chosen. */
void MCR_ISA_NAME(mcr_emitter_tree_mass)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *points, double *mass,
                                         struct mcr_emitter_descent *scratch);

/*
 * emitter_walk.c, with the tree. Adds to `sum` the densities of all emitters that the lanes' rays cross, times the probabilities that they
 * are chosen, but of those in `chosen` (may be NULL).
 */
void MCR_ISA_NAME(mcr_emitter_walk)(const struct mcr_emitters *all, uint32_t by, const struct mcr_emitter_lanes *block, const int64_t *chosen,
                                    double *sum, struct mcr_emitter_scratch *scratch);

/* emitter_disk.c: these two for disks by solid angle. */
void MCR_ISA_NAME(mcr_emitter_disk_density)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *lanes, const double *k,
                                            int varying, struct mcr_disk_scratch *scratch);
void MCR_ISA_NAME(mcr_emitter_disk_draw)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *lanes, const double *k,
                                         int varying, struct mcr_disk_scratch *scratch);

#endif
