/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Emitters: the bounded shapes of a scene whose materials emit, and drawing directions or points toward them. These are the host's light
 * services (mcrender/sampler.h) over a batch of points. An emitter is one primitive; a box is six of them. Infinite planes are left out.
 *
 * With at most MCR_EMITTERS_FEW emitters, one is chosen with a probability in proportion to its power: luminance of its mean radiance times
 * area times emitting sides. Only those count that can be seen from the point at all: a point behind a one-sided plane, or inside a sphere
 * that emits outside, does not see it. With more, a tree of them is descended, at each node with probabilities in proportion to bounds of
 * what its children bring to the point, from their power, distance, orientation, and that of the surface (its shading normal; points
 * without normals are taken for points in space). At a leaf it may turn out that the emitter cannot be seen: then nothing is drawn. No
 * emitter that sees the point has probability 0.
 */
#ifndef MCR_CORE_EMITTERS_H
#define MCR_CORE_EMITTERS_H

#include "base/arena.h"
#include "scene/scene.h"
#include <mcrender/plugin.h>
#include <mcrender/sampler.h>

#define MCR_EMITTERS_FEW 4u

enum mcr_emitter_kind {
    MCR_EMITTER_PARALLELOGRAM,
    MCR_EMITTER_TRIANGLE,
    MCR_EMITTER_DISK,
    MCR_EMITTER_SPHERE,
    MCR_EMITTER_ELLIPSOID,
    MCR_EMITTER_KINDS
};

/*
 * An emitter as the loops want it. Each kind has a height function of a point: flat ones N.(p - c), with N = e0 x e1 toward the front;
 * spheres |p - c|^2 - R^2; ellipsoids |E^-1 (p - c)|^2 - 1. The emitter is seen where height > K_ABOVE or height < K_BELOW (infinite if
 * that side is dark).
 * The thresholds are a few roundings of the coordinates off zero, so that a surface does not see itself.
 */
enum mcr_emitter_constant {
    MCR_K_C = 0,       /* corner, vertex or centre */
    MCR_K_E0 = 3,      /* edges, half axes */
    MCR_K_E1 = 6,
    MCR_K_N = 9,       /* flat: N; ellipsoid: e2 */
    MCR_K_DUAL0 = 12,  /* flat: dual vectors of e0 and e1; ellipsoid: the rows of E^-1, up to MCR_K_SIZE */
    MCR_K_DUAL1 = 15,
    MCR_K_NN = 18,     /* flat: N.N */
    MCR_K_FACTOR = 19, /* flat: |N| / area */
    MCR_K_RADIUS = 12, /* sphere */
    MCR_K_SQUARE = 13, /* sphere: R^2 */
    MCR_K_INVERSE = 14, /* sphere: 1 / (2 pi R^2) */
    MCR_K_ABOVE = 21,
    MCR_K_BELOW = 22,
    MCR_K_SPREAD = 23, /* sphere: 1 / (4 pi R); ellipsoid: 1 / (4 pi |det E|) */
    MCR_K_SIZE = 24
};

struct mcr_emitter {
    uint32_t kind;
    uint32_t primitive;
    uint32_t material;
    uint32_t sides;      /* MCR_MATERIAL_EMITS_* */
    double area;         /* render space */
    double probability;  /* power over the power of all; by it few emitters are chosen */
};

struct mcr_emitter_node;
struct mcr_emitter_bounds;

struct mcr_emitters {
    uint32_t count;
    uint32_t primitive_count;
    struct mcr_emitter *emitter;
    double (*k)[MCR_K_SIZE];      /* count rows, indices above */
    int32_t *of_primitive;        /* the emitter's number or -1 */
    uint32_t kinds;               /* bit set of those there are */
    double power;                 /* see mcr_emitters_power */
    /* The tree (emitter_tree.h) of more than MCR_EMITTERS_FEW emitters, which are in the order of its leaves; else NULL. */
    struct mcr_emitter_node *node;
    struct mcr_emitter_bounds *bounds;
    uint64_t *place;              /* where in the tree each emitter is */
    uint64_t tree_bytes;
    double cosine[128];           /* cos(2 pi i / 128) */
};

/* NULL when memory is short. Lives in `arena`; immutable. */
struct mcr_emitters *mcr_emitters_create(struct mcr_arena *arena, const struct mcr_scene *scene);

/*
 * What all emitters radiate together: luminance of their mean radiance times area times emitting sides times pi; W in render space, that is
 * W in the world times the square of the scene's scale. 0 without emitters. An estimate, as the mean radiances are.
 */
double mcr_emitters_power(const struct mcr_emitters *emitters);

/* Bytes of scratch, 64-byte aligned, that one call over n points needs. */
size_t mcr_emitters_scratch(const struct mcr_emitters *emitters, uint32_t n);

/*
 * The services, one set for each instruction set, all with the same bits. Contracts as in struct mcr_host: `by` is MCR_LIGHT_BY_*,
 * `kept` (at->n, may be NULL) takes along from a draw what the density at the same points with the same `by` can use again: pass it on or pass NULL.
 * number[0] chooses the emitter, number[1] and [2] the point. `density` may be NULL in the draws. A lane's results depend on nothing but
 * that lane.
 */
struct mcr_emitter_functions {
    void (*draw)(const struct mcr_emitters *emitters, void *scratch, uint32_t by, const struct mcr_points *at, const double *const *number,
                 const struct mcr_directions *out, double *density, double *kept);
    void (*density)(const struct mcr_emitters *emitters, void *scratch, uint32_t by, const struct mcr_points *at,
                    const struct mcr_directions *toward, const double *kept, double *density);
    void (*mass)(const struct mcr_emitters *emitters, void *scratch, uint32_t by, const struct mcr_points *at, double *mass);
    void (*draw_point)(const struct mcr_emitters *emitters, void *scratch, uint32_t by, const struct mcr_points *at,
                       const double *const *number, const struct mcr_emitter_points *out, double *density);
    void (*density_point)(const struct mcr_emitters *emitters, void *scratch, uint32_t by, const struct mcr_points *at,
                          const struct mcr_emitter_points *points, double *density);
};

/* Instruction sets 1 and 2 on x86-64 only. */
extern const struct mcr_emitter_functions mcr_emitter_functions_isa0, mcr_emitter_functions_isa1, mcr_emitter_functions_isa2;

#endif
