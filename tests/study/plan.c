/* SPDX-License-Identifier: Apache-2.0 */
/* From blocks and options to plans: defaults, lists, limits; and what the keys of cells go by. */
#include "../scene/help.h"
#include "plugin/values.h"
#include "study/plan.h"
#include "study/work.h"

#define ROOM CAMERA MATERIALS "sphere { center (0, 0, 3) radius 1 material m }\nsphere { center (0, 3, 0) radius 1 material lamp }\nrender { spp 7 depth 3 roulette off }\n"

static struct mcr_study_plan *plan_of(struct world *world, const char *text, const struct mcr_study_texts *texts)
{
    char whole[4096];
    struct mcr_overrides overrides = { .study = texts };
    snprintf(whole, sizeof whole, "%s%s", ROOM, text);
    *world = open_world(whole, &overrides);
    return world->scene && world->scene->study ? mcr_study_plan_create(world->arena, world->diagnostics, world->scene, "some/where/room.scn") : NULL;
}

static void defaults(void)
{
    struct world world;
    struct mcr_study_plan *plan = plan_of(&world, "study { }", NULL);
    ok(plan != NULL, "an empty block is a study");
    if (plan) {
        ok(strcmp(plan->title, "room.scn") == 0 && strcmp(plan->output, "room-study") == 0, "title and folder by the scene's name: %s, %s", plan->title,
           plan->output);
        ok(plan->spp_count == 1 && plan->spp[0] == 7 && plan->depth[0] == 3 && plan->roulette[0] == 0, "spp, depth and roulette of `render`");
        ok(plan->sampler_count == 1 && strcmp(plan->sampler[0], "sobol(nee)") == 0, "the scene's sampler: %s", plan->sampler[0]);
        ok(plan->seeds == 10 && plan->runs == 10 && plan->first_seed == 1 && plan->confidence == 0.95, "ten seeds, ten runs");
        ok(plan->reference_spp == 1024 && plan->reference_seed + MCR_REFERENCE_PARTS == UINT64_C(1) << 53, "a reference of 1024 spp, far seeds");
        ok((plan->metrics >> MCR_METRIC_MSE & 1) && (plan->metrics >> MCR_METRIC_MS_SSIM & 1), "mse and ms_ssim are measured");
    }
    close_world(&world);
}

static void block(void)
{
    struct mcr_study_texts texts = { .setting = { [STUDY_SPP] = "8, 2", [STUDY_TITLE] = "a \"title\"" }, .reference = { [REFERENCE_SPP] = "99" } };
    struct world world;
    struct mcr_study_plan *plan = plan_of(&world, "let many = (100, 1)\nstudy { samplers (uniform, cosine) spp many depth 4 compat (none, clamp, (disk-polar, clamp)) "
                                                  "accel (bvh, list) roulette (on, off) metrics psnr baseline cosine seed 5 seeds 3 runs 4 }", NULL);
    ok(plan && plan->spp_count == 2 && plan->spp[0] == 1 && plan->spp[1] == 100, "a list by name, ascending");
    ok(plan && plan->compat_count == 3 && plan->compat[0] == 0 && plan->compat[2] == (MCR_COMPAT_CLAMP | MCR_COMPAT_DISK_POLAR), "tuples in a tuple");
    ok(plan && plan->accel[0] == MCR_ACCEL_BVH && plan->roulette[0] == 1 && plan->roulette[1] == 0, "words in their order");
    ok(plan && plan->baseline == 1 && plan->metrics == (1u << MCR_METRIC_MSE | 1u << MCR_METRIC_PSNR), "the baseline; mse is always in");
    ok(plan && mcr_study_rounds(plan) == 4 && mcr_study_cell_count(plan) == 2 * 2 * 3 * 2 * 2, "cells: the product");
    ok(plan && plan->reference_spp == 1600, "the reference has 16 times the most");
    close_world(&world);
    plan = plan_of(&world, "study { spp (100, 1) depth (1, 2) reference { spp 5 depth 3 } }", &texts);
    ok(plan && plan->spp_count == 2 && plan->spp[0] == 2 && plan->spp[1] == 8, "an option takes the place of a list");
    ok(plan && plan->depth_count == 2 && strcmp(plan->title, "a \"title\"") == 0, "other settings stay; a text is taken as it is");
    ok(plan && plan->reference_spp == 99 && plan->has_reference_depth && plan->reference_depth == 3, "the same for the reference");
    close_world(&world);
    texts = (struct mcr_study_texts){ .passed_over = 1 };
    ok(!plan_of(&world, "study { spp nothing }", &texts) && world.scene && !world.scene->study, "a block that is passed over is not judged");
    close_world(&world);
}

static void refused(const char *text, const char *what)
{
    struct world world;
    struct mcr_study_plan *plan;
    quiet = 1;
    plan = plan_of(&world, text, NULL);
    ok(!plan && mcr_diagnostics_errors(world.diagnostics) == 1, "%s: one error (%u)", what, mcr_diagnostics_errors(world.diagnostics));
    close_world(&world);
    quiet = 0;
}

static void limits(void)
{
    struct world world;
    struct mcr_study_plan *plan = plan_of(&world, "study { seeds 50000 runs 1 spp (1, 2) }", NULL);
    ok(plan != NULL, "a hundred thousand renders");
    close_world(&world);
    refused("study { seeds 50001 runs 1 spp (1, 2) }", "two more");
    refused("study { seeds 1 runs 100000 spp (1, 2) }", "by runs");
    refused("study { seed 8 seeds 3 reference { seed 10 } }", "a reference's seed among the runs'");
    refused("study { seed 18 seeds 3 reference { seed 3 } }", "the last of its seeds");
    plan = plan_of(&world, "study { seed 19 seeds 3 runs 1 reference { seed 3 } }", NULL);
    ok(plan != NULL, "just before the runs'");
    close_world(&world);
    refused("study { reference { seed 9007199254740992 } }", "too few seeds left");
    refused("study { baseline cosine samplers (uniform, light) }", "a baseline that does not compete");
}

static uint64_t content(const char *text)
{
    char whole[4096];
    struct mcr_arena *arena = mcr_arena_create(0);
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    snprintf(whole, sizeof whole, "mcrender 1\n%s", text);
    const struct mcr_item *root = mcr_parse_text(arena, diagnostics, "test.scn", ".", whole, strlen(whole), NULL, 0);
    uint64_t hash = root ? mcr_study_content(root) : 0;
    mcr_diagnostics_destroy(diagnostics);
    mcr_arena_destroy(arena);
    return hash;
}

static void contents(void)
{
    uint64_t plain = content(ROOM);
    ok(content(ROOM "study { spp 3 }\n") == plain, "a study is no part of the scene");
    ok(content("# a comment\n" CAMERA MATERIALS "let r = 1\nsphere { center (0, 0, 3) radius r material m }\n"
               "sphere { center (0, 3, 0) radius 1 material lamp }\nrender { spp 8 seed 4 roulette on depth 50 }\nfilm { size (3, 3) }\n") !=
       plain, "an empty `film` is");
    ok(content("# a comment\n" CAMERA MATERIALS "let r = 1\nsphere { center (0, 0, 3) radius r material m }\n"
               "sphere { center (0, 3, 0) radius 1 material lamp }\nrender { spp 8 seed 4 roulette on depth 50 }\n") ==
       plain, "comments, names and what cells set themselves are not");
    ok(content(ROOM "sphere { center (0, 0, 3) radius 1 material m }") != plain, "one sphere more is");
    ok(content(CAMERA MATERIALS "sphere { center (0, 0, 3) radius 1.0000000000000002 material m }\nsphere { center (0, 3, 0) radius 1 material lamp }\nrender { }") !=
       plain, "the last bit of a radius is");
    ok(content(ROOM "film { filter tent exposure 1 tone aces }") == content(ROOM "film { filter tent tone linear }"), "how files of 8 bits look is not");
    ok(content(ROOM "film { filter tent(radius=1) }") != content(ROOM "film { filter tent(radius=2) }"), "arguments of calls are");
}

static void words(void)
{
    char word[MCR_MAX_WORD + 1];
    int same = mcr_choice_count(MCR_METRIC_WORDS) == MCR_METRIC_COUNT;
    for (uint32_t m = 0; m < MCR_METRIC_COUNT && same; m++) {
        mcr_choice_word(MCR_METRIC_WORDS, m, word);
        same = strcmp(word, mcr_metric_name[m]) == 0;
    }
    ok(same, "the scene language knows the metrics in their order");
}

int main(void)
{
    defaults();
    block();
    limits();
    contents();
    words();
    return tap_done();
}
