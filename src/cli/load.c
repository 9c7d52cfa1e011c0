/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/load.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/cpu.h"
#include "image/image.h"

/* What one scene may take of memory, bytes: a stop for hostile files, far above what a scene of 64 MiB of text needs. */
#define ARENA_LIMIT ((size_t)8 << 30)

void mcr_print_diagnostics(struct mcr_diagnostics *diagnostics)
{
    const char *no_colour = getenv("NO_COLOR"), *terminal = getenv("TERM");
    int colour = isatty(STDERR_FILENO) && !(no_colour && no_colour[0]) && !(terminal && !strcmp(terminal, "dumb"));
    mcr_diagnostics_print(diagnostics, stderr, colour);
}

static int out_of_memory(void)
{
    fputs("mcrender: error: out of memory\n", stderr);
    return MCR_EXIT_FAILED;
}

static int is_gltf(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (!strcasecmp(dot, ".gltf") || !strcasecmp(dot, ".glb"));
}

int mcr_load(struct mcr_loaded_scene *loaded, struct mcr_options *options)
{
    memset(loaded, 0, sizeof *loaded);
    if (is_gltf(options->scene)) {
        fprintf(stderr, "mcrender: error: %s: glTF is not available in this build\n", options->scene);
        return MCR_EXIT_USAGE;
    }
    loaded->arena = mcr_arena_create(ARENA_LIMIT);
    loaded->diagnostics = mcr_diagnostics_create();
    if (!loaded->arena || !loaded->diagnostics)
        return out_of_memory();
    mcr_diagnostics_werror(loaded->diagnostics, options->werror);
    loaded->registry = mcr_registry_create(loaded->diagnostics, options->isa, options->plugin);
    if (!loaded->registry)
        return out_of_memory();
    double start = mcr_wall_seconds();
    const struct mcr_item *root = mcr_parse_file(loaded->arena, loaded->diagnostics, options->scene, options->definition, options->definition_count);
    double parsed = mcr_wall_seconds();
    loaded->root = root;
    loaded->parse_seconds = parsed - start;
    if (root)
        loaded->scene = mcr_scene_build(loaded->arena, loaded->diagnostics, loaded->registry, root, &options->overrides);
    loaded->build_seconds = mcr_wall_seconds() - parsed;
    int failed = !loaded->scene || mcr_diagnostics_errors(loaded->diagnostics);
    mcr_print_diagnostics(loaded->diagnostics);
    return failed ? MCR_EXIT_SCENE : MCR_EXIT_DONE;
}

const char *mcr_input_of(const struct mcr_loaded_scene *loaded, const struct mcr_options *options, const char *path)
{
    if (mcr_target_is_input(path, options->scene))
        return "is the scene";
    for (const struct mcr_source *source = mcr_diagnostics_last_source(loaded->diagnostics); source; source = source->earlier)
        if (source->parent && mcr_target_is_input(path, source->name))
            return "is included by the scene";
    for (const struct mcr_scene_file *file = loaded->scene->files; file; file = file->earlier)
        if (mcr_target_is_input(path, file->path))
            return "is a picture in the scene";
    if (mcr_target_is_input(path, options->use_map))
        return "is the map to follow";
    return NULL;
}

void mcr_unload(struct mcr_loaded_scene *loaded)
{
    mcr_scene_destroy(loaded->scene);
    if (loaded->registry)
        mcr_registry_destroy(loaded->registry);
    if (loaded->diagnostics)
        mcr_diagnostics_destroy(loaded->diagnostics);
    mcr_arena_destroy(loaded->arena);
}
