/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/report.h"

#include <math.h>

#include "base/cpu.h"
#include "base/json.h"

const char *mcr_accel_name(uint32_t kind)
{
    return kind == MCR_ACCEL_LIST ? "list" : kind == MCR_ACCEL_BVH ? "bvh" : "auto";
}

static uint64_t all_rays(const struct mcr_render_stats *stats)
{
    return stats->camera_rays + stats->bounce_rays + stats->shadow_rays;
}

static double per_second(uint64_t count, double seconds)
{
    return seconds > 0 ? (double)count / seconds : 0;
}

/* 1/(MSE t): of luminance, with the render's wall time. Infinite (in JSON null) where every sample was the same. */
static double efficiency(const struct mcr_report_data *data)
{
    double cost = data->figures.mean_variance * data->stats->wall_seconds;
    return cost > 0 ? 1 / cost : INFINITY;
}

static void text_loaded(FILE *to, const struct mcr_report_data *data)
{
    const struct mcr_scene *scene = data->loaded->scene;
    const struct mcr_loaded *list;
    uint32_t count = mcr_registry_loaded(data->loaded->registry, &list);
    fputs("loaded    ", to);
    for (uint32_t i = 0; i < count; i++)
        fprintf(to, "%s%s", i ? ", " : "", list[i].descriptor->name);
    fprintf(to, "; %s, %u shapes, %u triangles; instruction set %s\n", mcr_accel_name(data->accel->kind), scene->shape_count, scene->triangles.count,
            mcr_cpu_isa_name(data->options->isa));
}

static const char *stopped_by(const struct mcr_report_data *data)
{
    static const char *const name[] = {[MCR_STOPPED_SPP] = "spp",           [MCR_STOPPED_TIME] = "time", [MCR_STOPPED_TARGET] = "target_error",
                                       [MCR_STOPPED_MAP] = "map", [MCR_STOPPED_MOST] = "most"};
    return data->sampling->stopped ? name[data->sampling->stopped] : "interruption";
}

/* Rounds: how many samples pixels have, and why they are no more. */
static void text_sampling(FILE *to, const struct mcr_report_data *data)
{
    const struct mcr_render_settings *render = &data->loaded->scene->render;
    const struct mcr_sampling_result *sampling = data->sampling;
    if (!sampling)
        return;
    fprintf(to, "sampling  %s%llu to %llu samples per pixel, %.6g in the mean, by rounds of %u", render->adaptive ? "adaptive: " : "",
            (unsigned long long)sampling->least, (unsigned long long)sampling->most, sampling->mean, render->round);
    if (sampling->scouts > 0)
        fprintf(to, "; %.4g more as scouts", sampling->scouts);
    fprintf(to, "\nstopped   by %s", stopped_by(data));
    if (render->time > 0)
        fprintf(to, "; time %.6g s", render->time);
    if (render->limit)
        fprintf(to, "; spp %u", render->limit);
    if (render->target_error > 0 && data->figures.known)
        fprintf(to, "; target error %.6g: with 95 %% confidence the error is below %.4g", render->target_error, data->figures.relative_bound);
    else if (render->target_error > 0)
        fprintf(to, "; target error %.6g: the error is unknown", render->target_error);
    fputs("\n", to);
}

static void text_error(FILE *to, const struct mcr_report_data *data)
{
    const struct mcr_film_figures *figures = &data->figures;
    if (figures->known)
        fprintf(to, "error     relative %.3g (root mean variance of a pixel over the mean luminance %.6g +- %.2g), MSE %.4g; efficiency 1/(MSE s) %.4g\n",
                figures->relative_error, figures->luminance, figures->standard_error, figures->mean_variance, efficiency(data));
    else
        fprintf(to, "error     unknown: %s; mean luminance %.6g\n",
                data->film->correlated && data->sampling ? "the numbers are correlated, and there are fewer than two rounds"
                : data->film->correlated ? "the numbers are correlated, and there are fewer than two replicates (render { replicates 2 })"
                                       : "one sample per pixel tells nothing of its variance",
                figures->luminance);
}

void mcr_report_text(FILE *to, const struct mcr_report_data *data)
{
    const struct mcr_scene *scene = data->loaded->scene;
    const struct mcr_render_settings *render = &scene->render;
    const struct mcr_render_stats *stats = data->stats;
    double seconds = stats->wall_seconds;
    fprintf(to, "scene     %s: %ux%u, ", data->options->scene, scene->film.x1 - scene->film.x0, scene->film.y1 - scene->film.y0);
    if (!data->sampling)
        fprintf(to, "%u spp, ", render->spp);
    fprintf(to, "depth %u, seed %llu\n", render->depth, (unsigned long long)render->seed);
    fprintf(to, "sampler   %s%s; numbers %s%s; roulette %s\n", scene->sampler->expression,
            scene->sampler_chosen ? " (chosen for this scene, which names none)" : "", data->film->correlated ? "correlated" : "independent",
            data->film->correlated && render->replicates < 2 && !data->sampling ? ", one replicate" : "", render->roulette ? "on" : "off");
    if (data->film->correlated && render->replicates > 1)
        fprintf(to, "          %u replicates of %u samples\n", render->replicates, render->spp / render->replicates);
    text_sampling(to, data);
    if (scene->film.exposure != 0 || scene->film.tone.curve != MCR_TONE_LINEAR) {
        char tone[MCR_TONE_TEXT];
        mcr_tone_text(&scene->film.tone, tone);
        fprintf(to, "display   tone %s, exposure %g stops, in files of 8 and 16 bits only\n", tone, scene->film.exposure);
    }
    text_loaded(to, data);
    if (render->compat) {
        char compat[MCR_COMPAT_TEXT];
        mcr_compat_text(render->compat, compat);
        fprintf(to, "compat    BIASED on purpose: %s\n", compat);
    }
    fprintf(to, "coverage  %s%s\n", data->coverage.complete ? "complete" : "INCOMPLETE: misses ", data->coverage.missing);
    fprintf(to, "time      parse %.4f s, build %.4f s, render %.3f s (processor %.3f s, %u threads), write %.3f s\n", data->loaded->parse_seconds,
            data->loaded->build_seconds + data->accel_seconds, seconds, stats->cpu_seconds, stats->threads, data->write_seconds);
    fprintf(to, "work      %llu samples, %llu scatterings, %llu rays (%llu camera, %llu bounce, %llu shadow), %.4g rays/s\n",
            (unsigned long long)stats->samples, (unsigned long long)stats->scatterings, (unsigned long long)all_rays(stats),
            (unsigned long long)stats->camera_rays, (unsigned long long)stats->bounce_rays, (unsigned long long)stats->shadow_rays,
            per_second(all_rays(stats), seconds));
    if (data->options->profile) {
        fputs("stages   ", to);
        for (int i = 0; i < MCR_STAGE_COUNT; i++)
            if (stats->stage_seconds[i] > 0)
                fprintf(to, " %s %.3f s", mcr_stage_name[i], stats->stage_seconds[i]);
        fputs("\n", to);
    }
    fprintf(to, "memory    %.1f MB at most\n", (double)mcr_peak_memory() / 1e6);
    text_error(to, data);
    for (uint32_t i = 0; i < data->output_count; i++) {
        const struct mcr_report_output *output = &data->output[i];
        if (output->failed)
            continue;
        fprintf(to, "wrote     %s%s", output->path, output->layers ? " with layers" : "");
        if (output->result.overflowed)
            fprintf(to, " (%llu values beyond the format's range were clipped)", (unsigned long long)output->result.overflowed);
        if (output->result.not_finite)
            fprintf(to, " (%llu values not finite)", (unsigned long long)output->result.not_finite);
        fputs("\n", to);
    }
}

void mcr_report_warnings(FILE *to, const struct mcr_report_data *data)
{
    const struct mcr_render_stats *stats = data->stats;
    char compat[MCR_COMPAT_TEXT];
    mcr_compat_text(data->loaded->scene->render.compat, compat);
    if (data->loaded->scene->render.compat)
        fprintf(to, "mcrender: warning: this picture is biased on purpose: compat %s\n", compat);
    if (data->options->variance_layer && data->film->units < 2)
        fprintf(to, "mcrender: warning: the variance layer is left out: of %s, %u is finished\n", data->film->correlated ? "the replicates" : "the samples",
                data->film->units);
    if (!data->coverage.complete)
        fprintf(to, "mcrender: warning: this sampler alone does not estimate the whole image: it misses %s\n", data->coverage.missing);
    if (stats->not_finite)
        fprintf(to, "mcrender: warning: %llu samples were not finite and count as black; the first: pixel %u,%u sample %llu\n",
                (unsigned long long)stats->not_finite, stats->not_finite_x, stats->not_finite_y, (unsigned long long)stats->not_finite_sample);
    if (stats->overfull)
        fprintf(to, "mcrender: warning: %llu rays entered more interiors, one inside the other, than are accounted for: the picture is wrong where these "
                "are seen; are surfaces with interiors closed, and at most %u deep?\n", (unsigned long long)stats->overfull, MCR_INTERIORS);
    const struct mcr_render_settings *render = &data->loaded->scene->render;
    if (data->sampling && render->target_error > 0 && data->sampling->stopped != MCR_STOPPED_TARGET)
        fprintf(to, "mcrender: warning: the target error %.6g is not reached: stopped by %s\n", render->target_error, stopped_by(data));
    if (data->sampling && render->adaptive && !data->sampling->distributed && !stats->interrupted)
        fprintf(to, "mcrender: warning: adaptive had nothing to distribute: every pixel has its floor alone\n");
    if (stats->interrupted && data->sampling)
        fprintf(to, "mcrender: warning: interrupted after %llu samples per pixel or more\n", (unsigned long long)data->film->samples);
    else if (stats->interrupted)
        fprintf(to, "mcrender: warning: interrupted after %llu of %u spp\n", (unsigned long long)data->film->samples, data->loaded->scene->render.spp);
}

static void json_scene(struct mcr_json_writer *json, const struct mcr_report_data *data)
{
    const struct mcr_scene *scene = data->loaded->scene;
    const struct mcr_render_settings *render = &scene->render;
    char hash[20], compat[MCR_COMPAT_TEXT], tone[MCR_TONE_TEXT];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)scene->hash);
    mcr_json_begin_object(json, "scene");
    mcr_json_text(json, "file", data->options->scene);
    mcr_json_text(json, "hash", hash);
    mcr_json_unsigned(json, "width", scene->film.x1 - scene->film.x0);
    mcr_json_unsigned(json, "height", scene->film.y1 - scene->film.y0);
    mcr_json_unsigned(json, "shapes", scene->shape_count);
    mcr_json_unsigned(json, "triangles", scene->triangles.count);
    mcr_json_unsigned(json, "materials", scene->material_count);
    mcr_json_unsigned(json, "dropped", scene->dropped);
    mcr_json_end(json);
    mcr_json_begin_object(json, "settings");
    mcr_json_text(json, "sampler", scene->sampler->expression);
    mcr_json_boolean(json, "sampler_chosen", scene->sampler_chosen);
    mcr_json_unsigned(json, "spp", render->spp);
    mcr_json_unsigned(json, "depth", render->depth);
    mcr_json_unsigned(json, "seed", render->seed);
    mcr_json_unsigned(json, "replicates", render->replicates);
    mcr_json_boolean(json, "roulette", render->roulette);
    mcr_compat_text(render->compat, compat);
    mcr_json_text(json, "compat", compat);
    mcr_json_boolean(json, "biased", render->compat != 0);
    mcr_tone_text(&scene->film.tone, tone);
    mcr_json_text(json, "tone", tone);
    mcr_json_number(json, "exposure", scene->film.exposure);
    mcr_json_text(json, "precision", "double");
    mcr_json_text(json, "accelerator", mcr_accel_name(data->accel->kind));
    mcr_json_text(json, "instruction_set", mcr_cpu_isa_name(data->options->isa));
    mcr_json_unsigned(json, "threads", data->stats->threads);
    mcr_json_unsigned(json, "batch", data->stats->batch);
    mcr_json_end(json);
}

static void json_sampling(struct mcr_json_writer *json, const struct mcr_report_data *data)
{
    const struct mcr_render_settings *render = &data->loaded->scene->render;
    const struct mcr_sampling_result *sampling = data->sampling;
    if (!sampling)
        return;
    mcr_json_begin_object(json, "sampling");
    mcr_json_text(json, "stopped_by", stopped_by(data));
    mcr_json_boolean(json, "adaptive", render->adaptive);
    mcr_json_unsigned(json, "round", render->round);
    mcr_json_unsigned(json, "samples_min", sampling->least);
    mcr_json_number(json, "samples_mean", sampling->mean);
    mcr_json_unsigned(json, "samples_max", sampling->most);
    mcr_json_number(json, "scout_samples", sampling->scouts);
    mcr_json_unsigned(json, "steps", sampling->steps);
    if (render->limit)
        mcr_json_unsigned(json, "spp_limit", render->limit);
    if (render->time > 0)
        mcr_json_number(json, "time_limit", render->time);
    if (render->target_error > 0) {
        mcr_json_number(json, "target_error", render->target_error);
        mcr_json_boolean(json, "target_reached", sampling->stopped == MCR_STOPPED_TARGET);
    }
    if (data->figures.known) {
        mcr_json_number(json, "confidence", 0.95);
        mcr_json_number(json, "error_bound", data->figures.relative_bound);
    }
    mcr_json_end(json);
}

static void json_loaded(struct mcr_json_writer *json, const struct mcr_report_data *data)
{
    const struct mcr_loaded *list;
    uint32_t count = mcr_registry_loaded(data->loaded->registry, &list);
    mcr_json_begin_array(json, "loaded");
    for (uint32_t i = 0; i < count; i++) {
        mcr_json_begin_object(json, NULL);
        mcr_json_text(json, "name", list[i].descriptor->name);
        mcr_json_text(json, "version", list[i].descriptor->version);
        mcr_json_text(json, "path", list[i].path);
        mcr_json_end(json);
    }
    mcr_json_end(json);
    mcr_json_begin_object(json, "coverage");
    mcr_json_boolean(json, "complete", data->coverage.complete);
    mcr_json_text(json, "missing", data->coverage.missing);
    mcr_json_end(json);
}

static void json_work(struct mcr_json_writer *json, const struct mcr_report_data *data)
{
    const struct mcr_render_stats *stats = data->stats;
    mcr_json_begin_object(json, "time");
    mcr_json_number(json, "parse", data->loaded->parse_seconds);
    mcr_json_number(json, "build", data->loaded->build_seconds + data->accel_seconds);
    mcr_json_number(json, "render", stats->wall_seconds);
    mcr_json_number(json, "render_cpu", stats->cpu_seconds);
    mcr_json_number(json, "write", data->write_seconds);
    if (data->options->profile) {
        mcr_json_begin_object(json, "stages");
        for (int i = 0; i < MCR_STAGE_COUNT; i++)
            mcr_json_number(json, mcr_stage_name[i], stats->stage_seconds[i]);
        mcr_json_end(json);
    }
    mcr_json_end(json);
    mcr_json_begin_object(json, "work");
    mcr_json_unsigned(json, "samples", stats->samples);
    mcr_json_unsigned(json, "scatterings", stats->scatterings);
    mcr_json_unsigned(json, "rays", all_rays(stats));
    mcr_json_unsigned(json, "camera_rays", stats->camera_rays);
    mcr_json_unsigned(json, "bounce_rays", stats->bounce_rays);
    mcr_json_unsigned(json, "shadow_rays", stats->shadow_rays);
    mcr_json_number(json, "rays_per_second", per_second(all_rays(stats), stats->wall_seconds));
    mcr_json_unsigned(json, "passes", stats->passes);
    mcr_json_unsigned(json, "peak_memory", mcr_peak_memory());
    mcr_json_unsigned(json, "not_finite", stats->not_finite);
    if (stats->not_finite) {
        mcr_json_begin_object(json, "not_finite_first");
        mcr_json_unsigned(json, "x", stats->not_finite_x);
        mcr_json_unsigned(json, "y", stats->not_finite_y);
        mcr_json_unsigned(json, "sample", stats->not_finite_sample);
        mcr_json_end(json);
    }
    mcr_json_unsigned(json, "interiors_overfull", stats->overfull);
    mcr_json_boolean(json, "interrupted", stats->interrupted);
    mcr_json_end(json);
}

static void json_image(struct mcr_json_writer *json, const struct mcr_report_data *data)
{
    const struct mcr_film_figures *figures = &data->figures;
    mcr_json_begin_object(json, "image");
    mcr_json_numbers(json, "mean", figures->mean, 3);
    mcr_json_number(json, "luminance", figures->luminance);
    mcr_json_boolean(json, "error_known", figures->known);
    if (figures->known) {
        mcr_json_number(json, "standard_error", figures->standard_error);
        mcr_json_number(json, "relative_error", figures->relative_error);
        mcr_json_number(json, "mse", figures->mean_variance);
        mcr_json_number(json, "sample_variance", figures->sample_variance);
        mcr_json_number(json, "efficiency", efficiency(data));
    }
    mcr_json_end(json);
    mcr_json_begin_array(json, "outputs");
    for (uint32_t i = 0; i < data->output_count; i++) {
        mcr_json_begin_object(json, NULL);
        mcr_json_text(json, "path", data->output[i].path);
        mcr_json_boolean(json, "written", !data->output[i].failed);
        mcr_json_unsigned(json, "overflowed", data->output[i].result.overflowed);
        mcr_json_unsigned(json, "not_finite", data->output[i].result.not_finite);
        mcr_json_end(json);
    }
    mcr_json_end(json);
}

int mcr_report_json(struct mcr_target *target, const struct mcr_report_data *data, char *error, size_t length)
{
    struct mcr_json_writer *json = mcr_json_writer_create(NULL);
    int status = -1;
    if (json) {
        mcr_json_begin_object(json, NULL);
        mcr_json_text(json, "mcrender", PACKAGE_VERSION);
        json_scene(json, data);
        json_sampling(json, data);
        json_loaded(json, data);
        json_work(json, data);
        json_image(json, data);
        mcr_json_end(json);
        status = mcr_json_writer_finish(json);
    }
    if (status) {
        snprintf(error, length, "out of memory");
        mcr_target_cancel(target);
    } else {
        size_t bytes;
        const char *text = mcr_json_writer_text(json, &bytes);
        status = mcr_target_write_text(target, text, bytes, error, length);
    }
    if (json)
        mcr_json_writer_destroy(json);
    return status;
}
