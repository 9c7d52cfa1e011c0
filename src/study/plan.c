/* SPDX-License-Identifier: Apache-2.0 */
#include "study/plan.h"

#include <stdio.h>
#include <string.h>

#define SEED_LIMIT (UINT64_C(1) << 53)  /* of a scene's seeds */
#define REFERENCE_TIMES 16u             /* its spp over the study's most: its noise is then small against every cell's error */
#define REFERENCE_LEAST 1024u
#define DEFAULT_METRICS                                                                                                            \
    (1u << MCR_METRIC_MSE | 1u << MCR_METRIC_PSNR | 1u << MCR_METRIC_SNR | 1u << MCR_METRIC_SSIM | 1u << MCR_METRIC_MS_SSIM | 1u << MCR_METRIC_RELMSE)

/* The last part of a path without its ending. */
static const char *base_name(const char *path, size_t *length)
{
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path, *dot;
    if (!strcmp(path, "-") || !*base)
        base = "scene";
    dot = strrchr(base, '.');
    *length = dot && dot != base ? (size_t)(dot - base) : strlen(base);
    return base;
}

static char *default_output(struct mcr_arena *arena, const char *scene_name)
{
    size_t length;
    const char *base = base_name(scene_name, &length);
    char *text = mcr_arena_alloc(arena, length + sizeof "-study", 1);
    if (text) {
        memcpy(text, base, length);
        strcpy(text + length, "-study");
    }
    return text;
}

/* A list, or the one value that stands for it. */
static const uint32_t *take_list(struct mcr_arena *arena, const struct mcr_study_list *list, uint32_t otherwise, uint32_t *count)
{
    uint32_t *one;
    *count = list->count ? list->count : 1;
    if (list->count)
        return list->value;
    one = mcr_arena_alloc(arena, 1, sizeof *one);
    if (one)
        *one = otherwise;
    return one;
}

static void take_lists(struct mcr_arena *arena, struct mcr_study_plan *plan, const struct mcr_scene *scene)
{
    const struct mcr_scene_study *asked = scene->study;
    const struct mcr_render_settings *render = &scene->render;
    plan->spp = take_list(arena, &asked->spp, render->spp, &plan->spp_count);
    plan->depth = take_list(arena, &asked->depth, render->depth, &plan->depth_count);
    plan->precision = take_list(arena, &asked->precision, render->precision, &plan->precision_count);
    plan->accel = take_list(arena, &asked->accel, render->accel, &plan->accel_count);
    plan->roulette = take_list(arena, &asked->roulette, render->roulette != 0, &plan->roulette_count);
    plan->compat = take_list(arena, &asked->compat, render->compat, &plan->compat_count);
    plan->sampler_count = asked->sampler_count ? asked->sampler_count : 1;
    plan->sampler = asked->sampler;
    if (!asked->sampler_count) {
        const char **one = mcr_arena_alloc(arena, 1, sizeof *one);
        if (one)
            *one = scene->sampler->expression;
        plan->sampler = one;
    }
}

/* The baseline among the samplers. Returns 0, or -1 after an error. */
static int take_baseline(struct mcr_diagnostics *diagnostics, struct mcr_study_plan *plan, const struct mcr_scene_study *asked)
{
    if (!asked->baseline)
        return 0;
    while (plan->baseline < plan->sampler_count && strcmp(plan->sampler[plan->baseline], asked->baseline))
        plan->baseline++;
    if (plan->baseline < plan->sampler_count)
        return 0;
    mcr_report(diagnostics, MCR_ERROR, asked->baseline_place, "the baseline %s is not among the samplers", asked->baseline);
    return -1;
}

static int take_reference(struct mcr_diagnostics *diagnostics, struct mcr_study_plan *plan, const struct mcr_scene_study *asked)
{
    uint64_t most = (uint64_t)plan->spp[plan->spp_count - 1] * REFERENCE_TIMES, last = plan->first_seed + mcr_study_rounds(plan) - 1;
    plan->reference_image = asked->reference_image;
    plan->reference_sampler = asked->reference_sampler;
    most = most < REFERENCE_LEAST ? REFERENCE_LEAST : most > INT32_MAX ? INT32_MAX : most;
    plan->reference_spp = asked->reference_spp ? asked->reference_spp : (uint32_t)most;
    plan->has_reference_depth = asked->has_reference_depth;
    plan->reference_depth = asked->reference_depth;
    /* Far from the runs' by default, whatever their number: a study that grows keeps its reference. */
    plan->reference_seed = asked->has_reference_seed ? asked->reference_seed : SEED_LIMIT - MCR_REFERENCE_PARTS;
    if (plan->reference_seed > SEED_LIMIT - MCR_REFERENCE_PARTS) {
        mcr_report(diagnostics, MCR_ERROR, asked->reference_seed_place, "the reference takes %u seeds from %llu on, the last seed is %llu",
                   MCR_REFERENCE_PARTS, (unsigned long long)plan->reference_seed, (unsigned long long)SEED_LIMIT);
        return -1;
    }
    if (plan->reference_image || plan->reference_seed > last || plan->reference_seed + MCR_REFERENCE_PARTS - 1 < plan->first_seed)
        return 0;
    mcr_report(diagnostics, MCR_ERROR, asked->reference_seed_place,
               "the reference's seeds, %llu to %llu, are among those of the runs, %llu to %llu: it would share their noise",
               (unsigned long long)plan->reference_seed, (unsigned long long)plan->reference_seed + MCR_REFERENCE_PARTS - 1,
               (unsigned long long)plan->first_seed, (unsigned long long)last);
    return -1;
}

uint32_t mcr_study_cell_count(const struct mcr_study_plan *plan)
{
    return plan->sampler_count * plan->spp_count * plan->depth_count * plan->precision_count * plan->accel_count * plan->roulette_count *
           plan->compat_count;
}

/* The product of the lists stays below the limit. */
static int check_size(struct mcr_diagnostics *diagnostics, const struct mcr_study_plan *plan, const struct mcr_scene_study *asked)
{
    const uint32_t factor[] = {plan->sampler_count, plan->spp_count,      plan->depth_count,  plan->precision_count,
                               plan->accel_count,   plan->roulette_count, plan->compat_count, mcr_study_rounds(plan)};
    uint64_t product = 1;
    for (size_t i = 0; i < sizeof factor / sizeof *factor; i++) {
        product *= factor[i]; /* both below 2^32 */
        if (product > MCR_STUDY_RUNS_LIMIT) {
            mcr_report(diagnostics, MCR_ERROR, asked->place, "the study has more than %u renders (cells times seeds or runs), which is the most",
                       MCR_STUDY_RUNS_LIMIT);
            return -1;
        }
    }
    return 0;
}

struct mcr_study_plan *mcr_study_plan_create(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const struct mcr_scene *scene,
                                             const char *scene_name)
{
    const struct mcr_scene_study *asked = scene->study;
    struct mcr_study_plan *plan = mcr_arena_alloc(arena, 1, sizeof *plan);
    const char *slash = strrchr(scene_name, '/');
    int wrong;
    if (!plan)
        return NULL;
    plan->title = asked->title ? asked->title : slash ? slash + 1 : scene_name;
    take_lists(arena, plan, scene);
    plan->output = asked->output ? asked->output : default_output(arena, scene_name);
    if (!plan->spp || !plan->depth || !plan->precision || !plan->accel || !plan->roulette || !plan->compat || !plan->sampler || !plan->output) {
        mcr_report(diagnostics, MCR_ERROR, asked->place, "out of memory");
        return NULL;
    }
    plan->seeds = asked->seeds ? asked->seeds : 10;
    plan->runs = asked->runs ? asked->runs : 10;
    plan->first_seed = asked->has_seed ? asked->seed : 1;
    plan->confidence = asked->confidence > 0 ? asked->confidence : 0.95;
    plan->target = asked->target;
    plan->metrics = (asked->metrics ? asked->metrics : DEFAULT_METRICS) | 1u << MCR_METRIC_MSE;
    plan->how.encoding = asked->encoding ? MCR_ENCODING_SRGB8 : MCR_ENCODING_LINEAR;
    plan->how.peak = asked->peak;
    wrong = take_baseline(diagnostics, plan, asked);
    wrong |= take_reference(diagnostics, plan, asked);
    wrong |= check_size(diagnostics, plan, asked);
    return wrong ? NULL : plan;
}
