/* SPDX-License-Identifier: Apache-2.0 */
/* Lists of quirks, and which are in force in a scene; roulette and replicates from the command line. */
#include "help.h"

#define BALL "sphere { center (0, 0, 5) radius 1 material m }\nsphere { center (0, 9, 5) radius 1 material lamp }\n"
#define ALL ((1u << MCR_COMPAT_COUNT) - 1)

static void test_lists(void)
{
    static const struct {
        const char *text;
        uint32_t mask;
    } good[] = { { "none", 0 }, { "clamp", MCR_COMPAT_CLAMP }, { "floor-sqrt,disk-polar", MCR_COMPAT_FLOOR_SQRT | MCR_COMPAT_DISK_POLAR },
                 { " clamp , sphere-spherical ", MCR_COMPAT_CLAMP | MCR_COMPAT_SPHERE_SPHERICAL } };
    static const char *const bad[] = { "", ",", "clamp,", "clamp,,floor-sqrt", "clamp,clamp", "none,clamp", "Clamp", "clamp disk-polar", "clam",
                                       "a-word-that-is-longer-than-all-the-quirks-together-can-be-in-a-list" };
    char text[MCR_COMPAT_TEXT], error[300];
    uint32_t mask, wrong = 0;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++)
        ok(mcr_compat_parse(good[i].text, &mask, error, sizeof error) == 0 && mask == good[i].mask, "'%s' is a list", good[i].text);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        mask = 77;
        *error = 0;
        ok(mcr_compat_parse(bad[i], &mask, error, sizeof error) == -1 && mask == 77 && *error, "'%s' is none: %s", bad[i], error);
    }
    for (uint32_t m = 0; m <= ALL; m++) {
        mcr_compat_text(m, text);
        wrong += mcr_compat_parse(text, &mask, error, sizeof error) != 0 || mask != m;
    }
    ok(wrong == 0, "every mask as a text and back");
    ok(strlen(text) < MCR_COMPAT_TEXT - 1, "there is room for all of them: %s", text);
}

/* What is in force when a sampler meets what was asked for. */
static void test_in_force(void)
{
    static const struct {
        const char *sampler;
        uint32_t asked, acts;
        const char *expression;
    } row[] = {
        { "cosine", ALL, MCR_COMPAT_CLAMP | MCR_COMPAT_BACKGROUND_AT_LIMIT | MCR_COMPAT_SPHERE_SPHERICAL, "cosine(compat=sphere-spherical)" },
        { "cosine", MCR_COMPAT_DISK_POLAR, MCR_COMPAT_DISK_POLAR, "cosine(compat=disk-polar)" },
        { "cosine(compat=none)", MCR_COMPAT_DISK_POLAR, 0, "cosine" },
        { "cosine(compat=disk-polar)", 0, MCR_COMPAT_DISK_POLAR, "cosine(compat=disk-polar)" },
        { "uniform", ALL, MCR_COMPAT_CLAMP | MCR_COMPAT_BACKGROUND_AT_LIMIT, "uniform" },
        { "stratified(mixture(uniform 1, light 1))", MCR_COMPAT_FLOOR_SQRT, MCR_COMPAT_FLOOR_SQRT,
          "stratified(compat=floor-sqrt, mixture(uniform 1, light 1))" },
        { "stratified(compat=none, uniform)", MCR_COMPAT_FLOOR_SQRT, 0, "stratified(uniform)" },
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct mcr_overrides over = { .has_compat = 1, .compat = row[i].asked, .sampler = row[i].sampler };
        struct world world = open_world(CAMERA MATERIALS BALL, &over);
        int built = world.scene != NULL;
        ok(built && world.scene->render.compat == row[i].acts, "%s, asked for %x: %x in force", row[i].sampler, row[i].asked, row[i].acts);
        ok(built && strcmp(world.scene->sampler->expression, row[i].expression) == 0,
           "as an expression: %s", built ? world.scene->sampler->expression : "");
        ok(built && !world.scene->camera.lens_polar, "no lens is touched where there is none");
        close_world(&world);
    }
}

static void test_overrides(void)
{
    struct mcr_overrides over = { .has_roulette = 1, .roulette = 1, .has_roulette_from = 1, .roulette_from = 3, .has_replicates = 1, .replicates = 5 };
    struct world world = open_world(CAMERA MATERIALS BALL "render { roulette off replicates 2 compat clamp spp 10 }\n", &over);
    ok(world.scene && world.scene->render.roulette && world.scene->render.roulette_from == 3, "roulette from the command line");
    ok(world.scene && world.scene->render.replicates == 5, "replicates from the command line");
    ok(world.scene && world.scene->render.compat == MCR_COMPAT_CLAMP, "the scene's compat");
    close_world(&world);
    over = (struct mcr_overrides){ .has_compat = 1 };
    world = open_world(CAMERA MATERIALS BALL "render { compat clamp }\n", &over);
    ok(world.scene && world.scene->render.compat == 0 && world.scene->render.roulette, "none from the command line");
    close_world(&world);
    world = open_world(CAMERA MATERIALS BALL "render { compat clamp }\n", NULL);
    ok(world.scene && world.scene->render.compat && !world.scene->render.roulette, "roulette is off with clamp, where nobody asked for it");
    close_world(&world);
    quiet = 1;
    over = (struct mcr_overrides){ .has_replicates = 1, .replicates = 50 };
    world = open_world(CAMERA MATERIALS BALL, &over);
    ok(!world.scene, "more replicates than samples are an error");
    close_world(&world);
}

int main(void)
{
    test_lists();
    test_in_force();
    test_overrides();
    return tap_done();
}
