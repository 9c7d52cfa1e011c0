/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Instances of plugins: materials and the nodes of a sampler expression, checked against their parameter tables.
 * Built on the main thread, immutable afterwards.
 */
#ifndef MCR_PLUGIN_NODE_H
#define MCR_PLUGIN_NODE_H

#include "base/arena.h"
#include "base/diag.h"
#include "language/tree.h"
#include "plugin/registry.h"
#include <mcrender/material.h>
#include <mcrender/sampler.h>

struct mcr_texture;

/* One instance. `struct mcr_child` of the public headers is a pointer to this. */
struct mcr_node {
    const struct mcr_descriptor *descriptor;
    const char *path;              /* of the file that it came from */
    void *instance;
    struct mcr_place place;
    struct mcr_values values;      /* checked, defaults filled; of textures the means */
    const struct mcr_texture **texture; /* materials: by parameter, NULL where there is none; NULL: there are none at all */
    uint32_t child_count;
    struct mcr_node *child[MCR_MAX_CHILDREN];
    uint32_t number;               /* materials: their place in the scene */
    const struct mcr_material_traits *traits; /* materials: as the scene has them, once they are told; NULL before */
    double weight[MCR_MAX_CHILDREN];
    uint32_t technique_count;      /* directions only */
    struct mcr_technique technique[MCR_MAX_TECHNIQUES];
};

/* What mcr_context is: the same structure at creation and in operations, so that services find their way. */
struct mcr_context {
    const struct mcr_node *node;           /* whose operation runs */
    struct mcr_diagnostics *diagnostics;   /* creation: where report goes; NULL in operations */
    void *scratch;                         /* of the running operation */
    void *core;                            /* operations: the core's state of this thread */
    uint32_t has_lights;
    char message[200];                     /* operations: the last report's text, "" if none; the core tells it when the operation fails */
};

/* A sampler: number sources from outside to inside, then the direction tree. */
struct mcr_sampler {
    uint32_t source_count;                       /* without the independent source that ends every chain */
    struct mcr_node *source[MCR_MAX_TREE_DEPTH];
    struct mcr_node *independent;                /* the plugin `independent`, always */
    struct mcr_node *directions;
    const char *expression;                      /* printed back in normal form, all weights written */
    int correlated;                              /* any source says so */
    uint32_t needs;                              /* MCR_NEEDS_* of all sources that supply anything */
    uint32_t quirks;                             /* bits: those of struct mcr_quirks that a node has, by whomever set */
};

/*
 * Quirks by name, for nodes that have a parameter `compat` (a choice): one that the expression leaves alone takes the last of its words that is
 * wanted, if any.
 */
struct mcr_quirks {
    const char *const *name;
    uint32_t count;  /* at most 32 */
    uint32_t wanted; /* bits */
};

/* The host table for creation: report, child_techniques, material_child_traits and has_lights work, the rest returns MCR_E_UNSUPPORTED. */
const struct mcr_host *mcr_creation_host(void);

/*
 * Makes an instance of `descriptor` from settings (item[0..count), words are parameter names) or arguments.
 * NULL after an error, which was recorded at its place.
 */
struct mcr_node *mcr_material_create(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, struct mcr_registry *registry,
                                     const struct mcr_item *block);
/* The same where names may stand for textures and other materials. */
struct mcr_value_names;
struct mcr_node *mcr_material_create_with(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, struct mcr_registry *registry,
                                          const struct mcr_item *block, const struct mcr_value_names *names);
/* As told by the plugin. Returns 0, or -1 after an error. */
int mcr_material_traits(const struct mcr_node *material, struct mcr_diagnostics *diagnostics, struct mcr_material_traits *traits);

/* planned: samples per pixel and replicate. has_lights: whether the scene has emitters that can be sampled. */
struct mcr_sampler *mcr_sampler_create(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, struct mcr_registry *registry,
                                       const struct mcr_value *expression, uint32_t planned, int has_lights);
/* The same with quirks that the scene asks for. */
struct mcr_sampler *mcr_sampler_create_with(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, struct mcr_registry *registry,
                                            const struct mcr_value *expression, uint32_t planned, int has_lights, const struct mcr_quirks *quirks);
/* Calls the plugins' destroy (memory is the arena's). NULL is allowed. */
void mcr_sampler_destroy(struct mcr_sampler *sampler);
void mcr_material_destroy(struct mcr_node *material);

/*
 * A colour, number, integer or choice from a value of the tree, with the range of the parameter checked and mistakes recorded.
 * Returns 0, or -1. Used for plugins' parameters and for the scene's own settings alike. `of` is the block's word, for messages.
 */
int mcr_value_check(struct mcr_diagnostics *diagnostics, const struct mcr_parameter *parameter, const struct mcr_value *value, const char *of,
                    double number[3]);

#endif
