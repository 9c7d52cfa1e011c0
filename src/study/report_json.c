/* SPDX-License-Identifier: Apache-2.0 */
/* study.json: all that a study holds. Its keys are described in mcrender-study(1). */
#include "study/report.h"

#include <stdio.h>

#include "base/json.h"
#include "study/words.h"

static void json_hex(struct mcr_json_writer *json, const char *key, uint64_t value)
{
    char text[20];
    snprintf(text, sizeof text, "%016llx", (unsigned long long)value);
    mcr_json_text(json, key, text);
}

static void json_interval(struct mcr_json_writer *json, const char *key, const struct mcr_interval *interval)
{
    mcr_json_begin_object(json, key);
    mcr_json_number(json, "value", interval->value);
    mcr_json_number(json, "low", interval->low);
    mcr_json_number(json, "high", interval->high);
    mcr_json_end(json);
}

static void json_whole(struct mcr_json_writer *json, const char *key, const uint32_t *list, uint32_t count)
{
    mcr_json_begin_array(json, key);
    for (uint32_t i = 0; i < count; i++)
        mcr_json_unsigned(json, NULL, list[i]);
    mcr_json_end(json);
}

static void json_compat(struct mcr_json_writer *json, const char *key, uint32_t mask)
{
    mcr_json_begin_array(json, key);
    for (uint32_t i = 0; i < MCR_COMPAT_COUNT; i++)
        if (mask >> i & 1)
            mcr_json_text(json, NULL, mcr_compat_name[i]);
    mcr_json_end(json);
}

static void json_marks(struct mcr_json_writer *json, uint32_t marks)
{
    mcr_json_begin_array(json, "marks");
    for (uint32_t i = 0; i < MCR_MARK_COUNT; i++)
        if (marks >> i & 1)
            mcr_json_text(json, NULL, mcr_mark_word[i]);
    mcr_json_end(json);
}

/* Those that were asked for; a value may be null. */
static void json_metrics(struct mcr_json_writer *json, uint32_t wanted, const double value[MCR_METRIC_COUNT])
{
    mcr_json_begin_object(json, "metrics");
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++)
        if (wanted >> m & 1)
            mcr_json_number(json, mcr_metric_name[m], value[m]);
    mcr_json_end(json);
}

static uint32_t wanted_metrics(const struct mcr_study *study)
{
    return study->plan->metrics | 1u << MCR_METRIC_MSE;
}

/* ---- what was asked for ---------------------------------------------------------------------------------------------------------- */

static void json_plan_lists(struct mcr_json_writer *json, const struct mcr_study_plan *plan)
{
    mcr_json_begin_array(json, "samplers");
    for (uint32_t i = 0; i < plan->sampler_count; i++)
        mcr_json_text(json, NULL, plan->sampler[i]);
    mcr_json_end(json);
    json_whole(json, "spp", plan->spp, plan->spp_count);
    json_whole(json, "depth", plan->depth, plan->depth_count);
    mcr_json_begin_array(json, "precision");
    for (uint32_t i = 0; i < plan->precision_count; i++)
        mcr_json_text(json, NULL, mcr_precision_word(plan->precision[i]));
    mcr_json_end(json);
    mcr_json_begin_array(json, "accelerator");
    for (uint32_t i = 0; i < plan->accel_count; i++)
        mcr_json_text(json, NULL, mcr_accel_word(plan->accel[i]));
    mcr_json_end(json);
    mcr_json_begin_array(json, "roulette");
    for (uint32_t i = 0; i < plan->roulette_count; i++)
        mcr_json_boolean(json, NULL, plan->roulette[i] != 0);
    mcr_json_end(json);
    mcr_json_begin_array(json, "compat");
    for (uint32_t i = 0; i < plan->compat_count; i++)
        json_compat(json, NULL, plan->compat[i]);
    mcr_json_end(json);
}

static void json_measure(struct mcr_json_writer *json, const struct mcr_metrics_options *how)
{
    mcr_json_begin_object(json, "measure");
    mcr_json_text(json, "encoding", mcr_encoding_word(how->encoding));
    mcr_json_number(json, "peak", mcr_metrics_peak(how));
    if (how->has_crop)
        json_whole(json, "crop", how->crop, 4);
    else
        mcr_json_null(json, "crop");
    mcr_json_boolean(json, "mask", how->mask != NULL);
    mcr_json_boolean(json, "exclude_not_finite", how->exclude_not_finite);
    mcr_json_end(json);
}

static void json_plan(struct mcr_json_writer *json, const struct mcr_study_plan *plan)
{
    mcr_json_begin_object(json, "plan");
    json_plan_lists(json, plan);
    mcr_json_unsigned(json, "runs", plan->runs);
    mcr_json_unsigned(json, "seeds", plan->seeds);
    mcr_json_unsigned(json, "first_seed", plan->first_seed);
    mcr_json_text(json, "baseline", plan->baseline < plan->sampler_count ? plan->sampler[plan->baseline] : NULL);
    mcr_json_number(json, "confidence", plan->confidence);
    mcr_json_begin_array(json, "metrics");
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++)
        if ((plan->metrics | 1u << MCR_METRIC_MSE) >> m & 1)
            mcr_json_text(json, NULL, mcr_metric_name[m]);
    mcr_json_end(json);
    json_measure(json, &plan->how);
    mcr_json_text(json, "output", plan->output);
    mcr_json_begin_object(json, "reference");
    mcr_json_text(json, "image", plan->reference_image);
    if (!plan->reference_image) {
        mcr_json_text(json, "sampler", plan->reference_sampler);
        mcr_json_unsigned(json, "spp", plan->reference_spp);
        if (plan->has_reference_depth)
            mcr_json_unsigned(json, "depth", plan->reference_depth);
        else
            mcr_json_null(json, "depth");
        mcr_json_unsigned(json, "seed", plan->reference_seed);
    }
    mcr_json_end(json);
    mcr_json_end(json);
}

static void json_head(struct mcr_json_writer *json, const struct mcr_study *study)
{
    mcr_json_unsigned(json, "schema", MCR_STUDY_SCHEMA);
    mcr_json_text(json, "mcrender", study->version);
    mcr_json_text(json, "title", study->plan->title);
    mcr_json_text(json, "started", study->started);
    mcr_json_text(json, "command", study->command);
    mcr_json_begin_object(json, "machine");
    mcr_json_text(json, "system", study->machine);
    mcr_json_text(json, "processor", study->processor);
    mcr_json_text(json, "instruction_set", study->instruction_set);
    mcr_json_unsigned(json, "threads", study->threads);
    mcr_json_end(json);
    mcr_json_begin_object(json, "scene");
    mcr_json_text(json, "file", study->scene_path);
    json_hex(json, "hash", study->scene_hash);
    mcr_json_unsigned(json, "width", study->width);
    mcr_json_unsigned(json, "height", study->height);
    mcr_json_end(json);
}

/* ---- what came out --------------------------------------------------------------------------------------------------------------- */

static void json_references(struct mcr_json_writer *json, const struct mcr_study *study)
{
    mcr_json_begin_array(json, "references");
    for (uint32_t i = 0; i < study->reference_count; i++) {
        const struct mcr_study_reference *reference = &study->reference[i];
        mcr_json_begin_object(json, NULL);
        mcr_json_unsigned(json, "depth", reference->depth);
        mcr_json_number(json, "noise", reference->noise);
        mcr_json_number(json, "seconds", reference->seconds);
        mcr_json_end(json);
    }
    mcr_json_end(json);
}

static void json_settings(struct mcr_json_writer *json, const struct mcr_study *study, const struct mcr_study_settings *settings)
{
    const struct mcr_study_plan *plan = study->plan;
    mcr_json_text(json, "sampler", settings->sampler < plan->sampler_count ? plan->sampler[settings->sampler] : NULL);
    mcr_json_unsigned(json, "spp", settings->spp);
    mcr_json_unsigned(json, "depth", settings->depth);
    mcr_json_text(json, "precision", mcr_precision_word(settings->precision));
    mcr_json_text(json, "accelerator", mcr_accel_word(settings->accel));
    mcr_json_boolean(json, "roulette", settings->roulette != 0);
    json_compat(json, "compat", settings->compat);
}

static void json_run(struct mcr_json_writer *json, const struct mcr_study *study, const struct mcr_study_run *run)
{
    mcr_json_begin_object(json, NULL);
    mcr_json_unsigned(json, "seed", run->seed);
    mcr_json_unsigned(json, "order", run->order);
    mcr_json_number(json, "wall", run->wall_seconds);
    mcr_json_number(json, "cpu", run->cpu_seconds);
    mcr_json_number(json, "build", run->build_seconds);
    mcr_json_number(json, "write", run->write_seconds);
    mcr_json_unsigned(json, "samples", run->samples);
    mcr_json_unsigned(json, "rays", run->rays);
    mcr_json_unsigned(json, "not_finite", run->not_finite);
    json_metrics(json, wanted_metrics(study), run->metric);
    mcr_json_end(json);
}

static void json_time(struct mcr_json_writer *json, const char *key, const struct mcr_time_summary *time)
{
    mcr_json_begin_object(json, key);
    mcr_json_unsigned(json, "runs", time->runs);
    json_interval(json, "trimmed", &time->trimmed);
    json_interval(json, "median", &time->median);
    mcr_json_number(json, "lowest", time->lowest);
    mcr_json_number(json, "highest", time->highest);
    mcr_json_end(json);
}

static void json_analysis(struct mcr_json_writer *json, const struct mcr_study *study, const struct mcr_cell_analysis *cell)
{
    mcr_json_begin_object(json, "analysis");
    json_time(json, "wall", &cell->wall);
    json_time(json, "cpu", &cell->cpu);
    mcr_json_begin_object(json, "metrics");
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++)
        if (wanted_metrics(study) >> m & 1)
            json_interval(json, mcr_metric_name[m], &cell->metric[m]);
    mcr_json_end(json);
    json_interval(json, "error", &cell->error);
    json_interval(json, "efficiency", &cell->efficiency);
    json_interval(json, "speed", &cell->speed);
    mcr_json_number(json, "reference_share", cell->reference_share);
    json_marks(json, cell->marks);
    mcr_json_end(json);
}

static void json_cell(struct mcr_json_writer *json, const struct mcr_study *study, const struct mcr_study_cell *cell,
                      const struct mcr_cell_analysis *analysis)
{
    mcr_json_begin_object(json, NULL);
    json_hex(json, "key", cell->key);
    mcr_json_unsigned(json, "contestant", cell->contestant);
    mcr_json_unsigned(json, "group", cell->group);
    mcr_json_unsigned(json, "series", cell->series);
    mcr_json_unsigned(json, "reference", cell->reference);
    json_settings(json, study, &cell->settings);
    mcr_json_begin_object(json, "coverage");
    mcr_json_boolean(json, "complete", cell->coverage.complete);
    mcr_json_text(json, "missing", cell->coverage.missing);
    mcr_json_end(json);
    mcr_json_text(json, "image", cell->image);
    mcr_json_number(json, "bias_square", cell->bias_square);
    mcr_json_number(json, "bias_square_error", cell->bias_square_error);
    mcr_json_begin_array(json, "runs");
    for (uint32_t i = 0; i < cell->run_count; i++)
        json_run(json, study, &cell->run[i]);
    mcr_json_end(json);
    json_analysis(json, study, analysis);
    mcr_json_end(json);
}

static void json_series(struct mcr_json_writer *json, const struct mcr_study *study, const struct mcr_analysis *analysis)
{
    mcr_json_begin_array(json, "series");
    for (uint32_t i = 0; i < study->series_count; i++) {
        const struct mcr_series_analysis *series = &analysis->series[i];
        mcr_json_begin_object(json, NULL);
        mcr_json_unsigned(json, "contestant", series->contestant);
        mcr_json_unsigned(json, "depth", series->depth);
        mcr_json_unsigned(json, "cells", series->cells);
        json_interval(json, "slope", &series->slope);
        json_interval(json, "time_slope", &series->time_slope);
        json_interval(json, "time_to_target", &series->time_to_target);
        mcr_json_text(json, "target", mcr_target_word(series->target));
        json_marks(json, series->marks);
        mcr_json_end(json);
    }
    mcr_json_end(json);
}

static void json_test(struct mcr_json_writer *json, const char *key, const struct mcr_pair_test *test)
{
    mcr_json_begin_object(json, key);
    mcr_json_text(json, "verdict", mcr_verdict_word(test->verdict));
    json_interval(json, "ratio", &test->ratio);
    mcr_json_number(json, "p", test->p);
    mcr_json_number(json, "p_holm", test->p_holm);
    if (test->seeds_needed)
        mcr_json_unsigned(json, "seeds_needed", test->seeds_needed);
    else
        mcr_json_null(json, "seeds_needed");
    mcr_json_end(json);
}

static void json_pairs(struct mcr_json_writer *json, const struct mcr_analysis *analysis)
{
    mcr_json_begin_array(json, "pairs");
    for (uint32_t i = 0; i < analysis->pair_count; i++) {
        const struct mcr_pair_analysis *pair = &analysis->pair[i];
        mcr_json_begin_object(json, NULL);
        mcr_json_unsigned(json, "group", pair->group);
        mcr_json_unsigned(json, "cell_a", pair->cell_a);
        mcr_json_unsigned(json, "cell_b", pair->cell_b);
        json_test(json, "equal_time", &pair->equal_time);
        json_test(json, "equal_spp", &pair->equal_spp);
        mcr_json_end(json);
    }
    mcr_json_end(json);
}

static void json_equal_time(struct mcr_json_writer *json, const struct mcr_study *study)
{
    mcr_json_begin_object(json, "equal_time");
    mcr_json_unsigned(json, "depth", study->equal_time_depth);
    mcr_json_number(json, "seconds", study->equal_time_seconds);
    mcr_json_begin_array(json, "renders");
    for (uint32_t i = 0; i < study->equal_time_count; i++) {
        const struct mcr_study_equal_time *render = &study->equal_time[i];
        mcr_json_begin_object(json, NULL);
        mcr_json_unsigned(json, "contestant", render->contestant);
        mcr_json_unsigned(json, "spp", render->spp);
        mcr_json_number(json, "wall", render->wall_seconds);
        mcr_json_text(json, "image", render->image);
        json_metrics(json, wanted_metrics(study), render->metric);
        mcr_json_end(json);
    }
    mcr_json_end(json);
    mcr_json_end(json);
}

static int build(struct mcr_json_writer *json, const struct mcr_study *study, const struct mcr_analysis *analysis)
{
    mcr_json_begin_object(json, NULL);
    json_head(json, study);
    json_plan(json, study->plan);
    json_references(json, study);
    mcr_json_begin_array(json, "contestants");
    for (uint32_t i = 0; i < study->contestant_count; i++)
        mcr_json_text(json, NULL, study->contestant[i]);
    mcr_json_end(json);
    mcr_json_begin_array(json, "cells");
    for (uint32_t i = 0; i < study->cell_count; i++)
        json_cell(json, study, &study->cell[i], &analysis->cell[i]);
    mcr_json_end(json);
    json_series(json, study, analysis);
    json_pairs(json, analysis);
    mcr_json_begin_object(json, "target");
    mcr_json_number(json, "mse", analysis->target);
    mcr_json_boolean(json, "chosen", analysis->target_chosen);
    mcr_json_end(json);
    mcr_json_number(json, "reference_noise", analysis->reference_noise);
    json_equal_time(json, study);
    mcr_json_end(json);
    return mcr_json_writer_finish(json);
}

int mcr_study_write_json(struct mcr_target *target, const struct mcr_study *study, const struct mcr_analysis *analysis, char *error,
                         size_t length)
{
    struct mcr_json_writer *json = mcr_json_writer_create(NULL);
    size_t bytes;
    int status = -1;
    if (json && !build(json, study, analysis)) {
        const char *text = mcr_json_writer_text(json, &bytes);
        status = mcr_target_write_text(target, text, bytes, error, length);
    } else {
        snprintf(error, length, "not enough memory for the study's JSON");
        mcr_target_cancel(target);
    }
    mcr_json_writer_destroy(json);
    return status;
}
