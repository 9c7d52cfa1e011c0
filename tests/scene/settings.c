/* SPDX-License-Identifier: Apache-2.0 */
/* Cameras, film, render settings: defaults, what the scene says, what the command line says over it. */
#include "help.h"

#include "scene/vector.h"

#define U 0x1p-53

static void cameras(void)
{
    struct world world = open_world("camera perspective { from (278, 278, -800) to (278, 278, 0) fov 90 }\n", NULL);
    struct mcr_camera c;
    if (!ok(world.scene != NULL, "a perspective camera"))
        return;
    c = world.scene->camera;
    ok(same3(c.forward, 0, 0, 1) && same3(c.up, 0, 1, 0) && same3(c.right, -1, 0, 0), "looking along +z, +x is to the left");
    ok(c.kind == MCR_CAMERA_PERSPECTIVE && c.half_height == 1 && c.lens_radius == 0, "90 degrees: half height 1");
    close_world(&world);

    world = open_world("camera perspective { from (3, 1, 2) to (-1, 2, 7) up (0.3, 1, 0.2) focal 50 film_height 24 }\n", NULL);
    c = world.scene->camera;
    ok(fabs(mcr_dot(c.right, c.up)) <= 4 * U && fabs(mcr_dot(c.right, c.forward)) <= 4 * U && fabs(mcr_dot(c.up, c.forward)) <= 4 * U &&
           fabs(mcr_dot(c.up, c.up) - 1) <= 4 * U,
       "the frame is orthonormal");
    ok(mcr_dot(c.up, (const double[3]){ 0.3, 1, 0.2 }) > 0, "and upright");
    ok(c.half_height == 0.24, "50 mm before a film of 24 mm: half height 0.24");
    close_world(&world);

    world = open_world("camera orthographic { from (0, 0, 3) to (0, 0, 0) height 8 }\nmaterial m lambert { albedo 0.5 }\n"
                       "sphere { center (0, 0, 0) radius 1 material m }\n",
                       NULL);
    c = world.scene->camera;
    ok(c.kind == MCR_CAMERA_ORTHOGRAPHIC && c.half_height == 4 * world.scene->scale && world.scene->scale == 0x1p-4,
       "an orthographic camera; its view counts into the extent");
    close_world(&world);

    world = open_world("camera thinlens { from (0, 0, 4) to (0, 0, 1) fov 40 lens_radius 0.5 }\n", NULL);
    c = world.scene->camera;
    ok(c.kind == MCR_CAMERA_THIN_LENS && c.focus_distance == 3 * world.scene->scale && c.lens_radius == 0.5 * world.scene->scale,
       "a thin lens is sharp at `to` by default");
    close_world(&world);
}

static void defaults(void)
{
    struct world world = open_world(CAMERA, NULL);
    const struct mcr_film_settings *f;
    const struct mcr_render_settings *r;
    if (!ok(world.scene != NULL, "film and render may be left out"))
        return;
    f = &world.scene->film;
    r = &world.scene->render;
    ok(f->width == 512 && f->height == 512 && f->x0 == 0 && f->y0 == 0 && f->x1 == 512 && f->y1 == 512, "512 x 512, all of it");
    ok(f->filter == MCR_FILTER_BOX && f->filter_radius == 0.5 && !f->filter_edge, "a box filter");
    ok(f->exposure == 0 && f->tone.curve == MCR_TONE_LINEAR, "shown as it is");
    ok(r->spp == 16 && r->depth == 50 && r->seed == 0 && r->threads == 0 && r->batch == 0 && r->replicates == 2,
       "16 spp in 2 replicates, depth 50, seed 0");
    ok(r->roulette && r->roulette_from == 8 && !r->mis_power && r->accel == MCR_ACCEL_AUTO && mcr_largest(r->background) == 0,
       "roulette from 8, balance, auto, black");
    ok(!world.scene->has_lights && strcmp(world.scene->sampler->expression, "sobol(bsdf)") == 0 && world.scene->sampler_chosen, "without light the sampler is sobol(bsdf)");
    close_world(&world);
    world = open_world(CAMERA MATERIALS "sphere { center (0, 0, 5) radius 1 material lamp }\nplane { point (0, 0, 9) normal (0, 0, -1) material m }\n", NULL);
    ok(world.scene && strcmp(world.scene->sampler->expression, "sobol(nee)") == 0, "with light it is sobol(nee)");
    close_world(&world);
    world = open_world(CAMERA MATERIALS "sphere { center (0, 0, 5) radius 1 material lamp }\nplane { point (0, 0, 9) normal (0, 0, -1) material lamp }\n",
                       NULL);
    ok(world.scene && strcmp(world.scene->sampler->expression, "sobol(bsdf)") == 0, "with an infinite plane that emits it is sobol(bsdf) again");
    close_world(&world);
}

static void given(void)
{
    static const struct mcr_overrides over = { .has_spp = 1, .spp = 5, .has_depth = 1, .depth = 0, .has_seed = 1, .seed = 1ull << 63,
                                               .has_size = 1,
                                               .width = 200, .height = 100, .has_crop = 1, .crop = { 1, 2, 3, 4 }, .has_accel = 1,
                                               .accel = MCR_ACCEL_LIST, .sampler = "uniform" };
    static const char text[] = CAMERA "film { size (640, 360) crop (10, 20, 30, 40) filter gaussian(sigma=0.75) }\n"
                                      "render { spp 7 depth 3 seed 9007199254740992 threads 2 roulette on(from=5) background (1, 2, 3) accel bvh mis power\n"
                                      "batch 512 replicates 3 sampler cosine }\n";
    struct world world = open_world(text, NULL);
    const struct mcr_film_settings *f;
    const struct mcr_render_settings *r;
    if (!ok(world.scene != NULL, "everything given"))
        return;
    f = &world.scene->film;
    r = &world.scene->render;
    ok(f->width == 640 && f->height == 360 && f->x0 == 10 && f->y0 == 20 && f->x1 == 30 && f->y1 == 40, "size and crop");
    ok(f->filter == MCR_FILTER_GAUSSIAN && f->filter_sigma == 0.75 && f->filter_radius == 1.5,
       "a filter with one argument, the other by default");
    ok(r->spp == 7 && r->depth == 3 && r->seed == 9007199254740992u && r->threads == 2 && r->replicates == 3 && r->batch == 512, "numbers");
    ok(r->roulette && r->roulette_from == 5 && r->mis_power && r->accel == MCR_ACCEL_BVH && same3(r->background, 1, 2, 3), "words");
    close_world(&world);
    world = open_world(text, &over);
    f = &world.scene->film;
    r = &world.scene->render;
    ok(f->width == 200 && f->height == 100 && f->x0 == 1 && f->y0 == 2 && f->x1 == 3 && f->y1 == 4, "--size and --crop win");
    ok(r->spp == 5 && r->depth == 0 && r->seed == 1ull << 63 && r->accel == MCR_ACCEL_LIST && r->threads == 2,
       "--spp, --depth, --seed and --accel win");
    ok(strcmp(world.scene->sampler->directions->descriptor->name, "uniform") == 0, "--sampler wins");
    close_world(&world);
}

/* How files of 8 bits show it. */
static void shown(void)
{
    static const char text[] = CAMERA "film { exposure -1.5 tone reinhard(white=8) filter mitchell(b=0, c=0.5) }\n";
    static const struct mcr_overrides over = { .has_exposure = 1, .exposure = 2, .tone = "hable" }, linear = { .tone = "linear" };
    struct world world = open_world(text, NULL);
    const struct mcr_film_settings *f = &world.scene->film;
    ok(f->exposure == -1.5 && f->tone.curve == MCR_TONE_REINHARD && f->tone.white == 8, "exposure and tone");
    ok(f->filter == MCR_FILTER_MITCHELL && f->filter_radius == 2 && f->filter_b == 0 && f->filter_c == 0.5 && f->filter_edge, "a mitchell filter");
    close_world(&world);
    world = open_world(text, &over);
    f = &world.scene->film;
    ok(f->exposure == 2 && f->tone.curve == MCR_TONE_HABLE && f->tone.white == 5.6, "--exposure and --tone win");
    close_world(&world);
    world = open_world(text, &linear);
    f = &world.scene->film;
    ok(f->exposure == -1.5 && f->tone.curve == MCR_TONE_LINEAR, "--tone linear does, too");
    close_world(&world);
    world = open_world(CAMERA "film { tone aces }\n", NULL);
    ok(world.scene->film.tone.curve == MCR_TONE_ACES, "aces");
    close_world(&world);
}

/* Replicates: one for independent numbers, two for correlated ones where there is enough. */
static void replicates(void)
{
    static const struct {
        const char *settings;
        uint32_t expected;
    } table[] = {
        { "sampler cosine spp 100", 1 },
        { "sampler stratified(cosine) spp 100", 2 },
        { "sampler stratified(cosine) spp 16", 2 },
        { "sampler stratified(cosine) spp 15", 1 },
        { "sampler stratified(cosine) spp 101 replicates 4", 4 },
        { "sampler cosine spp 100 replicates 4", 4 },
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        char text[400];
        struct world world;
        snprintf(text, sizeof text, CAMERA "render { %s }\n", table[i].settings);
        world = open_world(text, NULL);
        ok(world.scene && world.scene->render.replicates == table[i].expected, "%s: %u replicates", table[i].settings, table[i].expected);
        close_world(&world);
    }
}

/* What does not fit together only since the command line said so. */
static void refused(void)
{
    static const struct mcr_overrides small = { .has_size = 1, .width = 20, .height = 20 };
    static const struct mcr_overrides crop = { .has_crop = 1, .crop = { 0, 0, 513, 1 } };
    static const struct mcr_overrides huge = { .has_size = 1, .width = 65536, .height = 65536 };
    static const struct mcr_overrides few = { .has_spp = 1, .spp = 2 };
    static const struct mcr_overrides sampler = { .sampler = "no-such-sampler" };
    static const struct {
        const char *what, *text;
        const struct mcr_overrides *overrides;
    } table[] = {
        { "--size smaller than the scene's crop", CAMERA "film { crop (0, 0, 100, 100) }\n", &small },
        { "--crop beyond the picture", CAMERA, &crop },
        { "--size of more film than is allowed", CAMERA, &huge },
        { "--spp below the scene's replicates", CAMERA "render { spp 64 replicates 4 }\n", &few },
        { "--sampler that does not exist", CAMERA, &sampler },
    };
    struct world world;
    quiet = 1;
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        world = open_world(table[i].text, table[i].overrides);
        ok(!world.scene && mcr_diagnostics_errors(world.diagnostics) == 1, "%s is refused", table[i].what);
        close_world(&world);
    }
    world = open_world("camera perspective { from (0, 0, 0) to (0, 0, 1) fov 40 fov 50 }\nrender { spp 0 }\n", NULL);
    ok(!world.scene && mcr_diagnostics_errors(world.diagnostics) == 2, "every mistake is counted");
    close_world(&world);
    quiet = 0;
}

int main(void)
{
    refused();
    cameras();
    defaults();
    given();
    shown();
    replicates();
    return tap_done();
}
