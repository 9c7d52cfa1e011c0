/* SPDX-License-Identifier: Apache-2.0 */
/* The product of the plan's lists: settings, labels, groups, and the keys by which what was rendered is found again. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/cpu.h"
#include "study/text.h"
#include "study/words.h"
#include "study/work.h"

/* What the trials of a study find, by sampler and compat. */
struct trials {
    struct mcr_trial *of;   /* sampler * compat_count + compat: of the least spp */
    struct mcr_trial reference;
};

/* ---- trials ---- */

void mcr_study_shot(const struct mcr_study_work *work, const struct mcr_study_settings *settings, uint64_t seed, struct mcr_shot_settings *shot)
{
    *shot = (struct mcr_shot_settings){.sampler = work->plan->sampler[settings->sampler], .spp = settings->spp, .depth = settings->depth,
                                       .accel = settings->accel, .compat = settings->compat, .roulette = settings->roulette,
                                       .has_roulette = work->roulette_listed, .seed = seed};
}

void mcr_study_reference_shot(const struct mcr_study_work *work, uint32_t reference, uint32_t part, struct mcr_shot_settings *shot)
{
    const struct mcr_study_plan *plan = work->plan;
    uint32_t parts = mcr_study_parts(plan), spp = plan->reference_spp / parts + (part < plan->reference_spp % parts);
    *shot = (struct mcr_shot_settings){.sampler = plan->reference_sampler, .spp = spp, .depth = work->study.reference[reference].depth,
                                       .accel = work->setup.scene->render.accel, .seed = plan->reference_seed + part};
}

/* Tries a scene in silence, and once more for the user where it is wrong: one message a mistake. Returns 0, or -1. */
static int try_once(struct mcr_study_work *work, const struct mcr_shot_settings *shot, struct mcr_trial *trial)
{
    struct mcr_diagnostics *silent = mcr_diagnostics_create();
    int status = silent ? mcr_shot_try(&work->setup, silent, shot, trial) : -1;
    if (silent)
        mcr_diagnostics_destroy(silent);
    if (status)
        mcr_shot_try(&work->setup, work->setup.diagnostics, shot, trial);
    return status;
}

/* Every scene that differs in what can be wrong: the sampler is laid out for spp, and quirks may be refused. */
static int try_cells(struct mcr_study_work *work, struct trials *trials)
{
    const struct mcr_study_plan *plan = work->plan;
    int wrong = 0;
    for (uint32_t s = 0; s < plan->sampler_count; s++)
        for (uint32_t c = 0; c < plan->compat_count; c++)
            for (uint32_t p = plan->spp_count, bad = 0; p-- > 0 && !bad;) {
                struct mcr_study_settings settings = {.sampler = s, .spp = plan->spp[p], .depth = plan->depth[0], .accel = plan->accel[0],
                                                      .roulette = (int)plan->roulette[0], .compat = plan->compat[c]};
                struct mcr_shot_settings shot;
                mcr_study_shot(work, &settings, plan->first_seed, &shot);
                bad = try_once(work, &shot, &trials->of[s * plan->compat_count + c]) != 0;
                wrong |= (int)bad;
            }
    return wrong ? -1 : 0;
}

/* An unbiased sampler that covers what the scene scatters, where none is named. */
static int choose_reference(struct mcr_study_work *work, struct mcr_trial *trial)
{
    static const char *const candidates[] = {"mixture(cosine 1, light 1)", "cosine"};
    struct mcr_shot_settings shot;
    for (size_t i = work->setup.scene->has_lights ? 0 : 1; i < sizeof candidates / sizeof *candidates; i++) {
        struct mcr_diagnostics *silent = mcr_diagnostics_create();
        int status = -1;
        work->plan->reference_sampler = candidates[i];
        mcr_study_reference_shot(work, 0, 0, &shot);
        if (silent) {
            status = mcr_shot_try(&work->setup, silent, &shot, trial);
            mcr_diagnostics_destroy(silent);
        }
        if (!status && trial->coverage.complete)
            return 0;
    }
    return try_once(work, &shot, trial);
}

static int try_reference(struct mcr_study_work *work, struct mcr_trial *trial)
{
    struct mcr_shot_settings shot;
    int status;
    if (work->plan->reference_image)
        return 0;
    if (work->plan->reference_sampler) {
        mcr_study_reference_shot(work, 0, 0, &shot);
        status = try_once(work, &shot, trial);
    } else {
        status = choose_reference(work, trial);
    }
    if (status || trial->coverage.complete)
        return status;
    mcr_report(work->setup.diagnostics, MCR_ERROR, work->setup.scene->study->reference_place,
               "the reference's sampler %s does not estimate the whole image: it misses %s; expected one that covers the scene",
               work->plan->reference_sampler, trial->coverage.missing);
    return -1;
}

/* ---- labels and keys ---- */

static char *kept(struct mcr_study_work *work, struct mcr_text *text)
{
    char *copy = text->failed ? NULL : mcr_arena_text(work->arena, text->bytes ? text->bytes : "", text->used);
    mcr_text_fini(text);
    return copy;
}

/* What tells this contestant from the others. */
static char *label_of(struct mcr_study_work *work, const struct mcr_study_settings *settings)
{
    const struct mcr_study_plan *plan = work->plan;
    struct mcr_text text = {0};
    char compat[MCR_COMPAT_TEXT];
    mcr_text_put(&text, plan->sampler[settings->sampler]);
    if (plan->precision_count > 1)
        mcr_text_printf(&text, ", %s", mcr_precision_word(settings->precision));
    if (plan->accel_count > 1)
        mcr_text_printf(&text, ", %s", mcr_accel_word(settings->accel));
    if (plan->roulette_count > 1)
        mcr_text_printf(&text, ", roulette %s", settings->roulette ? "on" : "off");
    mcr_compat_text(settings->compat, compat);
    if (plan->compat_count > 1)
        mcr_text_printf(&text, settings->compat ? ", compat %s" : ", no compat", compat);
    if (work->study.reference_count == 1 && plan->depth_count > 1)
        mcr_text_printf(&text, ", depth %u", settings->depth);
    return kept(work, &text);
}

/* What all keys of a study share. */
static void common(const struct mcr_study_work *work, const struct mcr_trial *trial, struct mcr_text *text)
{
    const struct mcr_study *study = &work->study;
    const struct mcr_film_settings *film = &trial->film;
    mcr_text_printf(text, "mcrender %s|scene %016llx|plugins %016llx|%ux%u|%u,%u,%u,%u|", PACKAGE_VERSION, (unsigned long long)work->content,
                    (unsigned long long)trial->plugins, film->width, film->height, film->x0, film->y0, film->x1, film->y1);
    mcr_text_printf(text, "threads %u|isa %s|", study->threads, study->instruction_set);
}

static int key_of(struct mcr_text *text, uint64_t *key)
{
    int failed = text->failed;
    *key = failed ? 0 : mcr_study_hash(text->bytes, text->used);
    mcr_text_fini(text);
    return failed ? -1 : 0;
}

/* Everything that decides what a cell's runs are, but the spp. */
static int base_key(struct mcr_study_work *work, const struct trials *trials, const struct mcr_study_cell *cell, uint32_t compat_index)
{
    const struct mcr_study_plan *plan = work->plan;
    const struct mcr_study_settings *settings = &cell->settings;
    const struct mcr_trial *trial = &trials->of[settings->sampler * plan->compat_count + compat_index];
    struct mcr_text text = {0};
    uint64_t peak;
    memcpy(&peak, &plan->how.peak, sizeof peak);
    common(work, trial, &text);
    mcr_text_printf(&text, "%s|depth %u|precision %u|accel %u|roulette %d from %u|compat %u|seed %llu|", plan->sampler[settings->sampler],
                    settings->depth, settings->precision, settings->accel, settings->roulette, trial->roulette_from, settings->compat,
                    (unsigned long long)plan->first_seed);
    mcr_text_printf(&text, "reference %016llx|metrics %u|encoding %u|peak %016llx", (unsigned long long)work->reference_key[cell->reference],
                    plan->metrics, plan->how.encoding, (unsigned long long)peak);
    return key_of(&text, &work->base_key[cell->series]);
}

uint64_t mcr_study_spp_key(uint64_t base, uint32_t spp)
{
    char text[64];
    int length = snprintf(text, sizeof text, "%016llx|spp %u", (unsigned long long)base, spp);
    return mcr_study_hash(text, (size_t)length);
}

static int reference_keys(struct mcr_study_work *work, const struct mcr_trial *trial, char *error, size_t length)
{
    const struct mcr_study_plan *plan = work->plan;
    int failed = 0;
    if (plan->reference_image) /* set as it is read (reference.c): the file's content decides */
        return mcr_study_reference_read(work, error, length);
    for (uint32_t k = 0; k < work->study.reference_count; k++) {
        struct mcr_text text = {0};
        common(work, trial, &text);
        mcr_text_printf(&text, "reference %s|spp %u|depth %u|seed %llu|roulette %d from %u", plan->reference_sampler, plan->reference_spp,
                        work->study.reference[k].depth, (unsigned long long)plan->reference_seed, trial->roulette, trial->roulette_from);
        failed |= key_of(&text, &work->reference_key[k]);
    }
    return failed ? -1 : 0;
}

/* ---- the product ---- */

static int make_cells(struct mcr_study_work *work, const struct trials *trials)
{
    const struct mcr_study_plan *plan = work->plan;
    struct mcr_study *study = &work->study;
    int single = work->study.reference_count == 1; /* depths are compared with each other */
    uint32_t settings_count = plan->precision_count * plan->accel_count * plan->roulette_count * plan->compat_count, n = 0;
    for (uint32_t outer = 0; outer < plan->sampler_count * settings_count; outer++)
        for (uint32_t d = 0; d < plan->depth_count; d++)
            for (uint32_t p = 0; p < plan->spp_count; p++) {
                struct mcr_study_cell *cell = &study->cell[n++];
                uint32_t rest = outer % settings_count, c = rest % plan->compat_count, s = outer / settings_count;
                const struct mcr_trial *trial = &trials->of[s * plan->compat_count + c];
                struct mcr_study_settings *set = &cell->settings;
                *set = (struct mcr_study_settings){.sampler = s, .spp = plan->spp[p], .depth = plan->depth[d], .compat = plan->compat[c]};
                rest /= plan->compat_count;
                set->roulette = work->roulette_listed ? plan->roulette[rest % plan->roulette_count] != 0 : trial->roulette;
                rest /= plan->roulette_count;
                set->accel = plan->accel[rest % plan->accel_count];
                set->precision = plan->precision[rest / plan->accel_count];
                cell->coverage = trial->coverage;
                cell->series = outer * plan->depth_count + d;
                cell->contestant = single ? cell->series : outer;
                cell->group = single ? p : d * plan->spp_count + p;
                cell->reference = single ? 0 : d;
                cell->bias_square = cell->bias_square_error = (double)NAN;
                if (!study->contestant[cell->contestant] && !(study->contestant[cell->contestant] = label_of(work, set)))
                    return -1;
                if (p == 0 && base_key(work, trials, cell, c))
                    return -1;
                cell->key = mcr_study_spp_key(work->base_key[cell->series], set->spp);
                cell->run = mcr_arena_alloc(work->arena, mcr_study_rounds(plan), sizeof *cell->run);
                if (!cell->run)
                    return -1;
            }
    return 0;
}

/* The first sampler that covers the scene. */
static void choose_baseline(struct mcr_study_work *work, const struct trials *trials)
{
    struct mcr_study_plan *plan = work->plan;
    if (work->setup.scene->study->baseline)
        return;
    for (uint32_t s = plan->sampler_count; s-- > 0;)
        if (trials->of[s * plan->compat_count].coverage.complete)
            plan->baseline = s;
}

static int make_room(struct mcr_study_work *work, struct trials *trials)
{
    const struct mcr_study_plan *plan = work->plan;
    struct mcr_study *study = &work->study;
    int single = plan->reference_image || plan->has_reference_depth || plan->depth_count == 1;
    study->cell_count = mcr_study_cell_count(plan);
    study->series_count = study->cell_count / plan->spp_count;
    study->reference_count = single ? 1 : plan->depth_count;
    study->contestant_count = single ? study->series_count : study->series_count / plan->depth_count;
    study->group_count = single ? plan->spp_count : plan->spp_count * plan->depth_count;
    study->cell = mcr_arena_alloc(work->arena, study->cell_count, sizeof *study->cell);
    study->contestant = mcr_arena_alloc(work->arena, study->contestant_count, sizeof *study->contestant);
    study->reference = mcr_arena_alloc(work->arena, study->reference_count, sizeof *study->reference);
    work->base_key = mcr_arena_alloc(work->arena, study->series_count, sizeof *work->base_key);
    work->reference_key = mcr_arena_alloc(work->arena, study->reference_count, sizeof *work->reference_key);
    work->reference_image = mcr_arena_alloc(work->arena, study->reference_count, sizeof(struct mcr_image *));
    work->reference_variance = mcr_arena_alloc(work->arena, study->reference_count, sizeof(struct mcr_image *));
    trials->of = mcr_arena_alloc(work->arena, (size_t)plan->sampler_count * plan->compat_count, sizeof *trials->of);
    if (!study->cell || !study->contestant || !study->reference || !work->base_key || !work->reference_key || !work->reference_image ||
        !work->reference_variance || !trials->of)
        return -1;
    for (uint32_t k = 0; k < study->reference_count; k++) {
        study->reference[k].depth = plan->has_reference_depth ? plan->reference_depth : plan->depth[k];
        study->reference[k].noise = (double)NAN;
    }
    return 0;
}

int mcr_study_cells(struct mcr_study_work *work, char *error, size_t length)
{
    struct trials trials = {0};
    int wrong;
    snprintf(error, length, "out of memory");
    if (make_room(work, &trials))
        return -1;
    error[0] = '\0';
    wrong = try_cells(work, &trials);
    wrong |= try_reference(work, &trials.reference);
    if (wrong)
        return -1;
    work->study.width = trials.of[0].film.x1 - trials.of[0].film.x0;
    work->study.height = trials.of[0].film.y1 - trials.of[0].film.y0;
    choose_baseline(work, &trials);
    snprintf(error, length, "out of memory");
    if (reference_keys(work, &trials.reference, error, length) || make_cells(work, &trials))
        return -1;
    error[0] = '\0';
    return 0;
}
