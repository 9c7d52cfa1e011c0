/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What the core is assembled from for a scene: its features, which of them are active and why, and the bytes that each adds. All of it is told by the
 * assembled core itself: the bytes of a batch are counted by what cuts it, once with each feature and once without.
 */
#ifndef MCR_CORE_EXPLAIN_H
#define MCR_CORE_EXPLAIN_H

#include "core/core.h"

#define MCR_EXPLAINED_FEATURES 32u

struct mcr_explained_feature {
    const char *name;
    int active;
    char why[200];         /* one clause, of an inactive feature what is not there */
    uint64_t batch_bytes;  /* of a thread's batch, on top of the features behind it in the list; 0 where inactive */
    uint64_t table_bytes;  /* that all threads share; 0 where inactive */
    uint32_t stages;       /* bits: 1 << enum mcr_stage whose time is its; 0 where it has none of its own. No two active features share any */
};

#define MCR_EXPLAINED_EMITTER_KINDS 5u

struct mcr_explained_lights {
    uint32_t emitters, one_sided, two_sided;
    uint32_t kind[MCR_EXPLAINED_EMITTER_KINDS]; /* emitters by mcr_explained_emitter_kind */
    int aimed;             /* the sampler aims at emitters */
    int tree;              /* they are chosen by a tree */
    int sky;               /* the sky is one more of them */
    double sky_share;      /* the probability with which it is chosen; 0 without one */
    uint32_t points, spots, suns; /* without extent: looked for by rays of their own */
    int points_tree;
};
/* "parallelogram", … */
extern const char *const mcr_explained_emitter_kind[MCR_EXPLAINED_EMITTER_KINDS];

struct mcr_explanation {
    uint32_t count;
    struct mcr_explained_feature feature[MCR_EXPLAINED_FEATURES];
    uint32_t batch;                           /* paths in a batch */
    uint64_t batch_bytes, batch_base_bytes;   /* of one thread: all, and without any of the features. Their difference is the features' sum */
    uint64_t table_bytes, table_base_bytes;   /* the same for tables, textures included */
    uint64_t texture_bytes;
    uint64_t pass_bytes;                      /* cells on their way to the film, as many as are used */
    struct mcr_explained_lights lights;
};

/* options: isa, features; channels: their moments are asked for (struct mcr_cell_sink). Returns 0, or -1 when memory is short. */
int mcr_explain(const struct mcr_scene *scene, const struct mcr_accel *accel, const struct mcr_render_options *options, int channels,
                struct mcr_explanation *out);

#endif
