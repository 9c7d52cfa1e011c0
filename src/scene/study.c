/* SPDX-License-Identifier: Apache-2.0 */
/* Blocks `study { … }`, and what the command line says over them. Options become values in the place of the block's, so that one reader judges both. */
#include "scene/build.h"

#include <stdio.h>
#include <stdlib.h>

#define ELEMENTS_LIMIT 4096u /* of one list: a bound on what is compared with what */

/* The block with the options' values in it. */
struct sheet {
    struct mcr_settings settings;
    struct mcr_value value[MCR_SETTINGS_LIMIT]; /* those of options */
};

/* ---- options become values ---- */

static int is_list(uint32_t type)
{
    return type == MCR_WORD_SAMPLERS || type == MCR_WORD_WHOLES || type == MCR_WORD_CHOICES || type == MCR_WORD_COMPATS;
}

/* Puts the value of option --NAME in the place of setting `index`. */
static void override(struct mcr_build *build, struct sheet *sheet, uint32_t index, const char *option, const char *text)
{
    const struct mcr_parameter *row = &sheet->settings.word->setting[index];
    const struct mcr_value *value;
    char name[80];
    snprintf(name, sizeof name, "--%s", option);
    sheet->settings.value[index] = NULL;
    if (row->type == MCR_WORD_TEXT) {
        sheet->value[index] = (struct mcr_value){ .kind = MCR_VALUE_STRING, .text = text };
    } else {
        value = is_list(row->type) ? mcr_parse_list(build->arena, build->diagnostics, name, text)
                                   : mcr_parse_value(build->arena, build->diagnostics, name, text);
        if (!value) {
            sheet->settings.damaged = 1;
            return;
        }
        sheet->value[index] = *value;
    }
    sheet->settings.value[index] = &sheet->value[index];
}

/* ---- values ---- */

/* A text's characters, or NULL where it is not given or wrong. */
static const char *read_text(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index)
{
    const struct mcr_value *value = settings->value[index], *text = value ? mcr_value_resolve(value) : NULL;
    if (!text)
        return NULL;
    if (text->kind != MCR_VALUE_STRING) {
        mcr_wrong_kind(build, value, settings->word->setting[index].name, settings->of, mcr_word_form(MCR_WORD_TEXT));
        return NULL;
    }
    if (!*text->text) {
        mcr_error(build, value->place, "'%s' of '%s' is empty", settings->word->setting[index].name, settings->of);
        return NULL;
    }
    return text->text;
}

/* The elements of a list, or its only one without brackets. Returns how many; 0 where it is not given or wrong. */
static uint32_t elements(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, const struct mcr_value **item)
{
    const struct mcr_value *value = settings->value[index], *list = value ? mcr_value_resolve(value) : NULL;
    if (!list || list->kind == MCR_VALUE_ERROR)
        return 0;
    *item = list->kind == MCR_VALUE_TUPLE ? list->item : value;
    if (list->kind != MCR_VALUE_TUPLE)
        return 1;
    if (list->count <= ELEMENTS_LIMIT)
        return list->count;
    mcr_error(build, value->place, "'%s' of '%s' has %u values, expected at most %u", settings->word->setting[index].name, settings->of, list->count,
              ELEMENTS_LIMIT);
    return 0;
}

static void twice(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, const struct mcr_value *value)
{
    char text[80];
    mcr_error(build, value->place, "'%s' of '%s' has %s twice, expected once", settings->word->setting[index].name, settings->of,
              mcr_value_described(value, text));
}

/* One element as a number: a whole number, a word's place among the choices, or a mask. Returns 0, or -1 after an error. */
static int element(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, const struct mcr_value *value, uint32_t *out)
{
    struct mcr_parameter row = settings->word->setting[index];
    struct mcr_settings one = *settings;
    double number[3];
    if (row.type == MCR_WORD_COMPATS) {
        uint32_t before = mcr_diagnostics_errors(build->diagnostics);
        one.value[index] = value;
        *out = mcr_read_compat(build, &one, index);
        return mcr_diagnostics_errors(build->diagnostics) > before ? -1 : 0;
    }
    row.type = row.type == MCR_WORD_WHOLES ? MCR_TYPE_INTEGER : MCR_TYPE_CHOICE;
    if (mcr_value_check(build->diagnostics, &row, value, settings->of, number) != 0)
        return -1;
    *out = (uint32_t)number[0];
    return 0;
}

static int ascending(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

static void read_list(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, struct mcr_study_list *list)
{
    const struct mcr_value *item = NULL;
    uint32_t count = elements(build, settings, index, &item);
    list->value = count ? mcr_build_alloc(build, count, sizeof *list->value) : NULL;
    if (!list->value)
        return;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t value, j = 0;
        if (element(build, settings, index, &item[i], &value) != 0)
            continue;
        while (j < list->count && list->value[j] != value)
            j++;
        if (j < list->count)
            twice(build, settings, index, &item[i]);
        else
            list->value[list->count++] = value;
    }
    if (settings->word->setting[index].type == MCR_WORD_WHOLES)
        qsort(list->value, list->count, sizeof *list->value, ascending);
}

/* Words that the language has but this build has not. */
static void check_available(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, const struct mcr_study_list *list, uint32_t last,
                            const char *absent)
{
    for (uint32_t i = 0; i < list->count; i++)
        if (list->value[i] > last)
            mcr_error(build, settings->value[index]->place, "'%s %s' is not available in this build", settings->word->setting[index].name, absent);
}

/* ---- samplers ---- */

/* Makes the sampler as a trial. Its expression in normal form; NULL after an error. */
static const char *try_sampler(struct mcr_build *build, const struct mcr_value *value, uint32_t spp)
{
    const struct mcr_value *what = mcr_value_resolve(value);
    if (what->kind == MCR_VALUE_ERROR)
        return NULL;
    return mcr_build_try_sampler(build, value, spp);
}

/* What the samplers are made for as a trial: the most of the study, as some sources lay out so many. */
static uint32_t trial_spp(const struct mcr_build *build, const struct mcr_scene_study *study)
{
    return study->spp.count ? study->spp.value[study->spp.count - 1] : build->scene->render.spp;
}

static void read_samplers(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_scene_study *study)
{
    const struct mcr_value *item = NULL;
    uint32_t count = elements(build, settings, STUDY_SAMPLERS, &item);
    if (!count)
        return;
    study->sampler = mcr_build_alloc(build, count, sizeof *study->sampler);
    study->sampler_place = mcr_build_alloc(build, count, sizeof *study->sampler_place);
    if (!study->sampler || !study->sampler_place)
        return;
    for (uint32_t i = 0; i < count; i++) {
        const char *expression = try_sampler(build, &item[i], trial_spp(build, study));
        uint32_t j = 0;
        while (expression && j < study->sampler_count && strcmp(study->sampler[j], expression) != 0)
            j++;
        if (!expression)
            continue;
        if (j < study->sampler_count) {
            mcr_error(build, item[i].place, "'samplers' of 'study' has %s twice, expected once", expression);
            continue;
        }
        study->sampler_place[study->sampler_count] = item[i].place;
        study->sampler[study->sampler_count++] = expression;
    }
}

static void read_baseline(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_scene_study *study, uint32_t before)
{
    const struct mcr_value *value = settings->value[STUDY_BASELINE];
    uint32_t i = 0;
    if (!value || mcr_diagnostics_errors(build->diagnostics) > before || !(study->baseline = try_sampler(build, value, trial_spp(build, study))))
        return;
    study->baseline_place = value->place;
    if (!study->sampler_count)
        return; /* the scene's own sampler competes: src/study knows it */
    while (i < study->sampler_count && strcmp(study->sampler[i], study->baseline) != 0)
        i++;
    if (i == study->sampler_count)
        mcr_error(build, value->place, "the baseline %s is not among the samplers", study->baseline);
}

/* ---- the reference ---- */

static void read_reference(struct mcr_build *build, const struct mcr_item *block, struct mcr_scene_study *study)
{
    static const struct mcr_item none = { .is_block = 1, .word = "reference" };
    const struct mcr_study_texts *texts = build->overrides ? build->overrides->study : NULL;
    const struct mcr_block_word *word = mcr_scene_block("reference", NULL);
    struct sheet sheet;
    struct mcr_settings *settings = &sheet.settings;
    double number = 0;
    mcr_settings_match(build, block ? block : &none, word, 0, settings);
    for (uint32_t i = 0; texts && i < REFERENCE_COUNT; i++) {
        char name[40] = "reference";
        if (i != REFERENCE_IMAGE)
            snprintf(name, sizeof name, "reference-%s", word->setting[i].name);
        if (texts->reference[i])
            override(build, &sheet, i, name, texts->reference[i]);
        if (texts->reference[i] && i == REFERENCE_IMAGE)
            memset(settings->value, 0, REFERENCE_IMAGE * sizeof settings->value[0]); /* it takes the place of what the block says */
    }
    study->reference_place = settings->place;
    if (mcr_read_number(build, settings, REFERENCE_SPP, &number) == 0)
        study->reference_spp = (uint32_t)number;
    study->has_reference_depth = mcr_read_number(build, settings, REFERENCE_DEPTH, &number) == 0;
    study->reference_depth = study->has_reference_depth ? (uint32_t)number : 0;
    study->has_reference_seed = mcr_read_number(build, settings, REFERENCE_SEED, &number) == 0;
    study->reference_seed = study->has_reference_seed ? (uint64_t)number : 0;
    if (settings->value[REFERENCE_SEED])
        study->reference_seed_place = settings->value[REFERENCE_SEED]->place;
    if (settings->value[REFERENCE_SAMPLER])
        study->reference_sampler =
            try_sampler(build, settings->value[REFERENCE_SAMPLER], study->reference_spp ? study->reference_spp : build->scene->render.spp);
    study->reference_image = read_text(build, settings, REFERENCE_IMAGE);
    if (!study->reference_image)
        return;
    study->reference_image = mcr_build_path(build, study->reference_image, settings->value[REFERENCE_IMAGE]->place);
    for (uint32_t i = 0; i < REFERENCE_IMAGE; i++)
        if (settings->value[i])
            mcr_error(build, settings->value[i]->place, "'%s' of 'reference' says how it is rendered, but it is a file: expected one of the two",
                      word->setting[i].name);
}

/* ---- the block ---- */

static void read_numbers(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_scene_study *study)
{
    struct mcr_study_list metrics = { 0 };
    double number;
    if (mcr_read_number(build, settings, STUDY_SEEDS, &number) == 0)
        study->seeds = (uint32_t)number;
    if (mcr_read_number(build, settings, STUDY_RUNS, &number) == 0)
        study->runs = (uint32_t)number;
    study->has_seed = mcr_read_number(build, settings, STUDY_SEED, &number) == 0;
    study->seed = study->has_seed ? (uint64_t)number : 0;
    if (mcr_read_number(build, settings, STUDY_CONFIDENCE, &number) == 0)
        study->confidence = number;
    if (mcr_read_number(build, settings, STUDY_TARGET, &number) == 0)
        study->target = number;
    if (mcr_read_number(build, settings, STUDY_ENCODING, &number) == 0)
        study->encoding = (uint32_t)number;
    if (mcr_read_number(build, settings, STUDY_PEAK, &number) == 0)
        study->peak = number;
    read_list(build, settings, STUDY_METRICS, &metrics);
    for (uint32_t i = 0; i < metrics.count; i++)
        study->metrics |= 1u << metrics.value[i];
    study->has_size = mcr_read_whole(build, settings, STUDY_SIZE, 2, study->size) == 0;
    study->has_crop = mcr_read_whole(build, settings, STUDY_CROP, 4, study->crop) == 0;
}

static void read_lists(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_scene_study *study)
{
    read_list(build, settings, STUDY_SPP, &study->spp);
    read_list(build, settings, STUDY_DEPTH, &study->depth);
    read_list(build, settings, STUDY_PRECISION, &study->precision);
    read_list(build, settings, STUDY_ACCEL, &study->accel);
    read_list(build, settings, STUDY_ROULETTE, &study->roulette);
    read_list(build, settings, STUDY_COMPAT, &study->compat);
    check_available(build, settings, STUDY_PRECISION, &study->precision, MCR_PRECISION_DOUBLE, "single");
    check_available(build, settings, STUDY_ACCEL, &study->accel, MCR_ACCEL_BVH, "embree");
}

void mcr_build_study(struct mcr_build *build, const struct mcr_item *block)
{
    static const struct mcr_item none = { .is_block = 1, .word = "study" };
    const struct mcr_study_texts *texts = build->overrides ? build->overrides->study : NULL;
    const struct mcr_item *reference = NULL;
    struct mcr_scene_study *study;
    struct sheet sheet;
    uint32_t before = mcr_diagnostics_errors(build->diagnostics), given = block != NULL;
    for (uint32_t i = 0; texts && i < STUDY_COUNT; i++)
        given |= texts->setting[i] != NULL;
    if (!given || (texts && texts->passed_over) || !(study = mcr_build_alloc(build, 1, sizeof *study)))
        return;
    mcr_settings_match(build, block ? block : &none, mcr_scene_block("study", NULL), 1u << MCR_BLOCK_REFERENCE, &sheet.settings);
    for (uint32_t i = 0; texts && i < STUDY_COUNT; i++)
        if (texts->setting[i])
            override(build, &sheet, i, i == STUDY_SAMPLERS ? "sampler" : sheet.settings.word->setting[i].name, texts->setting[i]);
    for (uint32_t i = 0; block && i < block->count; i++) {
        const struct mcr_item *item = &block->item[i];
        if (!item->is_block || strcmp(item->word, "reference") != 0)
            continue;
        if (reference)
            mcr_error(build, item->place, "a second 'reference', a study has one");
        else
            reference = item;
    }
    study->place = sheet.settings.place;
    study->title = read_text(build, &sheet.settings, STUDY_TITLE);
    study->output = read_text(build, &sheet.settings, STUDY_OUTPUT);
    read_lists(build, &sheet.settings, study);
    read_numbers(build, &sheet.settings, study);
    read_samplers(build, &sheet.settings, study);
    read_baseline(build, &sheet.settings, study, before);
    read_reference(build, reference, study);
    build->scene->study = study;
}
