/* SPDX-License-Identifier: Apache-2.0 */
/* mcrender check and mcrender plugins. */
#include "cli/commands.h"
#include "cli/load.h"
#include "plugin/describe.h"

int mcr_command_check(struct mcr_options *options)
{
    struct mcr_loaded_scene loaded;
    int status = mcr_load(&loaded, options);
    if (!status && !options->quiet) {
        const struct mcr_scene *scene = loaded.scene;
        printf("%s: good: %u shapes, %u triangles, %u materials, %ux%u, %u spp, sampler %s\n", options->scene, scene->shape_count,
               scene->triangles.count, scene->material_count, scene->film.width, scene->film.height, scene->render.spp, scene->sampler->expression);
    }
    mcr_unload(&loaded);
    return status;
}

int mcr_command_plugins(struct mcr_options *options)
{
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    struct mcr_registry *registry = diagnostics ? mcr_registry_create(diagnostics, options->isa, options->plugin) : NULL;
    int status = MCR_EXIT_FAILED;
    if (!registry) {
        fputs("mcrender: error: out of memory\n", stderr);
    } else if (!options->scene) {
        mcr_registry_open_all(registry);
        mcr_describe_all(stdout, registry);
        status = MCR_EXIT_DONE;
    } else {
        status = mcr_describe_word(stdout, registry, options->scene) ? MCR_EXIT_FAILED : MCR_EXIT_DONE;
    }
    if (diagnostics)
        mcr_print_diagnostics(diagnostics);
    if (registry)
        mcr_registry_destroy(registry);
    if (diagnostics)
        mcr_diagnostics_destroy(diagnostics);
    return status;
}
