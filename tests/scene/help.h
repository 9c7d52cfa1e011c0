/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes from text for the tests of src/scene. */
#ifndef TESTS_SCENE_HELP_H
#define TESTS_SCENE_HELP_H

#include "../tap.h"

#include "scene/scene.h"

#include <math.h>
#include <string.h>

struct world {
    struct mcr_arena *arena;
    struct mcr_diagnostics *diagnostics;
    struct mcr_registry *registry;
    struct mcr_scene *scene; /* NULL after an error */
};

/* What every scene below begins with: a camera at the origin and two materials. */
#define CAMERA "camera perspective { from (0, 0, 0) to (0, 0, 1) fov 90 }\n"
#define MATERIALS "material m lambert { albedo 0.5 }\nmaterial lamp emitter { radiance 2 }\n"

static int quiet; /* errors are expected */

static struct world __attribute__((unused)) open_world(const char *text, const struct mcr_overrides *overrides)
{
    static char whole[65536];
    const struct mcr_item *root;
    struct world world = { mcr_arena_create((size_t)1 << 28), mcr_diagnostics_create(), NULL, NULL };
    world.registry = mcr_registry_create(world.diagnostics, MCR_ISA_BASELINE, NULL);
    snprintf(whole, sizeof whole, "mcrender 1\n%s", text);
    root = mcr_parse_text(world.arena, world.diagnostics, "test.scn", ".", whole, strlen(whole), NULL, 0);
    world.scene = root ? mcr_scene_build(world.arena, world.diagnostics, world.registry, root, overrides) : NULL;
    if (!world.scene && !quiet)
        mcr_diagnostics_print(world.diagnostics, stderr, 0);
    return world;
}

static void __attribute__((unused)) close_world(struct world *world)
{
    mcr_scene_destroy(world->scene);
    mcr_registry_destroy(world->registry);
    mcr_diagnostics_destroy(world->diagnostics);
    mcr_arena_destroy(world->arena);
}

/* Whether every component is within `tolerance`. */
static int __attribute__((unused)) near3(const double a[3], double x, double y, double z, double tolerance)
{
    return fabs(a[0] - x) <= tolerance && fabs(a[1] - y) <= tolerance && fabs(a[2] - z) <= tolerance;
}

static int __attribute__((unused)) same3(const double a[3], double x, double y, double z)
{
    return a[0] == x && a[1] == y && a[2] == z;
}

#endif
