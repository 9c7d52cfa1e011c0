/* SPDX-License-Identifier: Apache-2.0 */
/* A scene and what it lives on: what `mcrender SCENE` and `mcrender check SCENE` have in common. */
#ifndef MCR_CLI_LOAD_H
#define MCR_CLI_LOAD_H

#include "cli/options.h"

struct mcr_loaded_scene {
    struct mcr_arena *arena;
    struct mcr_diagnostics *diagnostics;
    struct mcr_registry *registry;
    const struct mcr_item *root;       /* the tree; NULL after errors */
    struct mcr_scene *scene;           /* NULL after errors */
    double parse_seconds, build_seconds;
};

/* Parses and builds; prints diagnostics on stderr. Returns an exit status. End with mcr_unload in any case. */
int mcr_load(struct mcr_loaded_scene *loaded, struct mcr_options *options);
void mcr_unload(struct mcr_loaded_scene *loaded);

/* What was read that lies in the file `path`, in words: 'is the scene', for messages; NULL: nothing. It must not be written over. */
const char *mcr_input_of(const struct mcr_loaded_scene *loaded, const struct mcr_options *options, const char *path);

/* Prints what was recorded since the last time. */
void mcr_print_diagnostics(struct mcr_diagnostics *diagnostics);

#endif
