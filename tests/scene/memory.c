/* SPDX-License-Identifier: Apache-2.0 */
/* Too little memory: at whatever point it ends there is an error and no scene, and nothing is read or freed twice. */
#include "help.h"

static const char text[] = "mcrender 1\n" CAMERA MATERIALS
                           "sphere { center (0, 0, 5) radius 1 material lamp }\n"
                           "mesh { vertices ((0, 0, 5), (1, 0, 5), (0, 1, 5)) faces ((0, 1, 2)) normals ((0, 0, 1), (0, 0, 1), (0, 0, 1))\n"
                           "uv ((0, 0), (1, 0), (0, 1)) material m }\n"
                           "texture a checker { even 1 odd 0 }\ntexture b gradient { stops ((0, 1), (1, 0)) }\n"
                           "render { sampler stratified(mixture(cosine 1, light 1)) spp 16 }\n";

/* 1 built, 0 refused with an error, -1 refused without one. */
static int try_limit(size_t limit)
{
    struct mcr_arena *arena = mcr_arena_create(limit);
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    struct mcr_registry *registry = mcr_registry_create(diagnostics, MCR_ISA_BASELINE, NULL);
    const struct mcr_item *root = arena ? mcr_parse_text(arena, diagnostics, "test.scn", ".", text, strlen(text), NULL, 0) : NULL;
    struct mcr_scene *scene = root ? mcr_scene_build(arena, diagnostics, registry, root, NULL) : NULL;
    int result = scene ? 1 : mcr_diagnostics_errors(diagnostics) > 0 || !arena ? 0 : -1;
    mcr_scene_destroy(scene);
    mcr_registry_destroy(registry);
    mcr_diagnostics_destroy(diagnostics);
    mcr_arena_destroy(arena);
    return result;
}

int main(void)
{
    size_t limit = 64, silent = 0, refused = 0, enough = 0;
    for (; limit < (size_t)1 << 20 && !enough; limit += 64) {
        int result = try_limit(limit);
        silent += result < 0;
        refused += result == 0;
        enough = result > 0 ? limit : 0;
    }
    ok(enough > 0, "%zu bytes are enough for a small scene", enough);
    ok(refused > 10 && silent == 0, "with less it is refused with an error, for each of %zu limits", refused);
    return tap_done();
}
