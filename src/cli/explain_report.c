/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/explain_report.h"

#include <string.h>

#include "base/cpu.h"
#include "base/json.h"
#include "cli/report.h"

static uint64_t rays_of(const struct mcr_render_stats *stats)
{
    return stats->camera_rays + stats->bounce_rays + stats->shadow_rays;
}

/* ns of one thread for a sample: of everything, and of some stages. */
static double per_sample(const struct mcr_explain_data *data, double seconds)
{
    return data->pilot.samples ? seconds * 1e9 / (double)data->pilot.samples : 0;
}

static double stage_seconds(const struct mcr_explain_data *data, uint32_t stages)
{
    double sum = 0;
    for (uint32_t i = 0; i < MCR_STAGE_COUNT; i++)
        sum += stages & 1u << i ? data->pilot.stage_seconds[i] : 0;
    return sum;
}

/* The pilot's time: what the clocks between the stages do not see belongs to it, too. */
static double all_seconds(const struct mcr_explain_data *data)
{
    double stages = stage_seconds(data, ~0u);
    return data->pilot.pass_seconds > stages ? data->pilot.pass_seconds : stages;
}

static double render_samples(const struct mcr_explain_data *data)
{
    const struct mcr_scene *scene = data->loaded->scene;
    return (double)(scene->film.x1 - scene->film.x0) * (scene->film.y1 - scene->film.y0) * scene->render.spp;
}

static double render_seconds(const struct mcr_explain_data *data)
{
    return render_samples(data) * per_sample(data, all_seconds(data)) * 1e-9 / data->threads;
}

static void scale_bytes(double bytes, char text[32])
{
    static const char *const unit[] = {"bytes", "kB", "MB", "GB"};
    uint32_t u = 0;
    for (; u < 3 && bytes >= 999.5; u++)
        bytes /= 1000;
    snprintf(text, 32, u ? "%.3g %s" : "%.0f %s", bytes, unit[u]);
}

static void text_bytes(FILE *to, uint64_t bytes)
{
    char text[32];
    scale_bytes((double)bytes, text);
    fputs(text, to);
}

/* ---- What is loaded -------------------------------------------------------------------------------------------- */

static void text_plugins(FILE *to, const struct mcr_explain_data *data)
{
    const struct mcr_loaded *list;
    uint32_t count = mcr_registry_loaded(data->loaded->registry, &list);
    for (uint32_t i = 0; i < count; i++)
        fprintf(to, "%s %-14s %-7s %s\n", i ? "         " : "plugins  ", list[i].descriptor->name, list[i].descriptor->version, list[i].path);
}

/* Pictures among the textures, and the environment: what the module was loaded for. */
static int is_picture(const struct mcr_scene_texture *texture)
{
    return texture->texture && mcr_texture_bytes(texture->texture) > 0;
}

static void text_modules(FILE *to, const struct mcr_explain_data *data)
{
    const struct mcr_scene *scene = data->loaded->scene;
    const char *path = mcr_image_module_path(), *between = "";
    if (!path) {
        fputs("modules   none\n", to);
        return;
    }
    fprintf(to, "modules   oiio %s: decodes the pictures of ", path);
    for (uint32_t i = 0; i < scene->texture_count; i++)
        if (is_picture(&scene->texture[i])) {
            fprintf(to, "%s%s", between, scene->texture[i].name);
            between = ", ";
        }
    if (scene->environment && scene->environment->texel)
        fprintf(to, "%sthe environment", between);
    fputs("\n", to);
}

static const char *accel_why(const struct mcr_explain_data *data)
{
    if (data->loaded->scene->render.accel != MCR_ACCEL_AUTO)
        return "as asked for";
    return data->accel->kind == MCR_ACCEL_LIST ? "few shapes are fastest one by one" : "many shapes are found through a tree";
}

static void text_accel(FILE *to, const struct mcr_explain_data *data)
{
    const struct mcr_scene *scene = data->loaded->scene;
    fprintf(to, "accel     %s, %s (auto: list up to %u): %u shapes, %u triangles", mcr_accel_name(data->accel->kind), accel_why(data),
            MCR_ACCEL_LIST_LIMIT, scene->shape_count, scene->triangles.count);
    if (data->accel->kind == MCR_ACCEL_BVH)
        fprintf(to, ", %u nodes, %u wide shapes beside them", data->accel->node_count, data->accel->wide_count);
    fputs("; ", to);
    text_bytes(to, data->accel_bytes);
    fprintf(to, "; instruction set %s\n", mcr_cpu_isa_name(data->options->isa));
}

/* ---- Lights ---------------------------------------------------------------------------------------------------- */

static const char *choice_of(const struct mcr_explained_lights *lights)
{
    if (!lights->emitters && !lights->sky)
        return "none";
    if (!lights->aimed)
        return "by chance";
    return !lights->emitters ? "sky" : lights->tree ? "tree" : lights->emitters == 1 ? "one" : "power";
}

static const char *choice_told(const struct mcr_explained_lights *lights)
{
    if (!lights->aimed)
        return "found by chance: the sampler does not aim at them";
    if (lights->tree)
        return "chosen by a tree, by power, distance and orientation";
    return lights->emitters == 1 ? "always chosen" : "chosen by power among those that face the point";
}

static void text_lights(FILE *to, const struct mcr_explain_data *data)
{
    const struct mcr_explained_lights *l = &data->core.lights;
    const char *lead = "lights   ";
    if (l->emitters) {
        fprintf(to, "%s %u emitter%s (", lead, l->emitters, l->emitters > 1 ? "s" : "");
        for (uint32_t k = 0, told = 0; k < MCR_EXPLAINED_EMITTER_KINDS; k++)
            if (l->kind[k])
                fprintf(to, "%s%u %s%s", told++ ? ", " : "", l->kind[k], mcr_explained_emitter_kind[k], l->kind[k] > 1 ? "s" : "");
        fprintf(to, "; %u one-sided, %u two-sided), %s\n", l->one_sided, l->two_sided, choice_told(l));
        lead = "         ";
    }
    if (l->sky) {
        fprintf(to, l->aimed ? "%s the sky, chosen with probability %.3g\n" : "%s the sky, found by chance\n", lead, l->sky_share);
        lead = "         ";
    }
    if (l->points + l->spots + l->suns) {
        fprintf(to, "%s %u points, %u spots, %u suns without extent, one of them looked for at each scattering event%s\n", lead, l->points,
                l->spots, l->suns, l->points_tree ? ", through a tree" : "");
        lead = "         ";
    }
    if (lead[0] != ' ')
        fputs("lights    none that can be aimed at\n", to);
}

/* ---- Features -------------------------------------------------------------------------------------------------- */

static void text_features(FILE *to, const struct mcr_explain_data *data)
{
    const char *lead = "features ", *between = "";
    for (uint32_t i = 0; i < data->core.count; i++) {
        const struct mcr_explained_feature *f = &data->core.feature[i];
        char bytes[2][32], time[32] = "";
        if (!f->active)
            continue;
        scale_bytes((double)f->batch_bytes, bytes[0]);
        scale_bytes((double)f->table_bytes, bytes[1]);
        if (f->stages)
            snprintf(time, sizeof time, "%.1f ns", per_sample(data, stage_seconds(data, f->stages)));
        fprintf(to, "%s %-17s %10s a thread, %10s in all, %10s  %s\n", lead, f->name, bytes[0], bytes[1], time, f->why);
        lead = "         ";
    }
    fputs("not needed: ", to);
    for (uint32_t i = 0; i < data->core.count; i++)
        if (!data->core.feature[i].active) {
            fprintf(to, "%s%s", between, data->core.feature[i].name);
            between = ", ";
        }
    if (data->options->variance_layer)
        fputs("\n", to);
    else
        fprintf(to, "%svariance layer\n", between);
    if (data->options->variance_layer) {
        fputs("          variance layer: ", to);
        text_bytes(to, data->variance_bytes);
        fputs(" of the film\n", to);
    }
}

/* ---- Time and memory --------------------------------------------------------------------------------------------- */

static void text_duration(FILE *to, double seconds)
{
    if (seconds < 60)
        fprintf(to, "%.2g s", seconds);
    else if (seconds < 5400)
        fprintf(to, "%.0f min", seconds / 60);
    else
        fprintf(to, "%.1f h", seconds / 3600);
}

static void text_time(FILE *to, const struct mcr_explain_data *data)
{
    const double all = all_seconds(data), samples = (double)data->pilot.samples;
    fprintf(to, "time      %.0f ns a sample on one thread, %.2f rays (measured now: %llu samples of %ux%u pixels); about ",
            per_sample(data, all), (double)rays_of(&data->pilot) / samples, (unsigned long long)data->pilot.samples, data->pilot_width, data->pilot_height);
    text_duration(to, render_seconds(data));
    fprintf(to, " for %.4g samples on %u thread%s%s\n", render_samples(data), data->threads, data->threads > 1 ? "s" : "",
            mcr_render_in_rounds(&data->loaded->scene->render) ? ", but rounds end by their rules" : "");
    for (uint32_t i = 0; i < MCR_STAGE_COUNT; i++)
        if (data->pilot.stage_seconds[i] > 0)
            fprintf(to, "          %-12s %9.1f ns %5.1f %%\n", mcr_stage_name[i], per_sample(data, data->pilot.stage_seconds[i]),
                    100 * data->pilot.stage_seconds[i] / all);
    double between = all - stage_seconds(data, ~0u);
    fprintf(to, "          %-12s %9.1f ns %5.1f %%\n", "(between)", per_sample(data, between), 100 * between / all);
}

static void text_memory(FILE *to, const struct mcr_explain_data *data)
{
    const struct {
        const char *what;
        uint64_t bytes;
    } part[] = {
        {"scene", data->scene_bytes},      {"accelerator", data->accel_bytes},
        {"textures", data->core.texture_bytes}, {"tables", data->core.table_bytes - data->core.texture_bytes},
        {"batches", data->threads * data->core.batch_bytes}, {"film", data->film_bytes},
        {"cells of a pass", data->core.pass_bytes}, {"picture to be written", data->picture_bytes},
    };
    fputs("memory    about ", to);
    text_bytes(to, data->total);
    fputs(": ", to);
    for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
        fputs(i ? ", " : "", to);
        fprintf(to, "%s ", part[i].what);
        text_bytes(to, part[i].bytes);
    }
    fputs("; measured here, with one batch and no film: ", to);
    text_bytes(to, data->measured);
    fprintf(to, "\n          a batch of %u paths: ", data->core.batch);
    text_bytes(to, data->core.batch_bytes);
    fputs(" a thread, ", to);
    text_bytes(to, data->core.batch_base_bytes);
    fputs(" of them without any of these features\n", to);
}

void mcr_explain_text(FILE *to, const struct mcr_explain_data *data)
{
    const struct mcr_scene *scene = data->loaded->scene;
    fprintf(to, "scene     %s: %ux%u, %u spp, depth %u, seed %llu\n", data->options->scene, scene->film.x1 - scene->film.x0,
            scene->film.y1 - scene->film.y0, scene->render.spp, scene->render.depth, (unsigned long long)scene->render.seed);
    fprintf(to, "sampler   %s%s; coverage %s%s\n", scene->sampler->expression,
            scene->sampler_chosen ? " (chosen for this scene, which names none)" : "", data->coverage.complete ? "complete" : "INCOMPLETE: misses ",
            data->coverage.missing);
    text_plugins(to, data);
    text_modules(to, data);
    text_accel(to, data);
    text_lights(to, data);
    text_features(to, data);
    text_time(to, data);
    text_memory(to, data);
}

/* ---- JSON ------------------------------------------------------------------------------------------------------ */

static void json_loaded(struct mcr_json_writer *json, const struct mcr_explain_data *data)
{
    const struct mcr_scene *scene = data->loaded->scene;
    const struct mcr_loaded *list;
    uint32_t count = mcr_registry_loaded(data->loaded->registry, &list);
    mcr_json_begin_array(json, "plugins");
    for (uint32_t i = 0; i < count; i++) {
        mcr_json_begin_object(json, NULL);
        mcr_json_text(json, "name", list[i].descriptor->name);
        mcr_json_text(json, "version", list[i].descriptor->version);
        mcr_json_text(json, "path", list[i].path);
        mcr_json_end(json);
    }
    mcr_json_end(json);
    mcr_json_begin_array(json, "modules");
    if (mcr_image_module_path()) {
        mcr_json_begin_object(json, NULL);
        mcr_json_text(json, "name", "oiio");
        mcr_json_text(json, "path", mcr_image_module_path());
        mcr_json_begin_array(json, "textures");
        for (uint32_t i = 0; i < scene->texture_count; i++)
            if (is_picture(&scene->texture[i]))
                mcr_json_text(json, NULL, scene->texture[i].name);
        mcr_json_end(json);
        mcr_json_boolean(json, "environment", scene->environment && scene->environment->texel);
        mcr_json_end(json);
    }
    mcr_json_end(json);
    mcr_json_begin_object(json, "accelerator");
    mcr_json_text(json, "kind", mcr_accel_name(data->accel->kind));
    mcr_json_text(json, "why", accel_why(data));
    mcr_json_unsigned(json, "shapes", scene->shape_count);
    mcr_json_unsigned(json, "triangles", scene->triangles.count);
    mcr_json_unsigned(json, "nodes", data->accel->node_count);
    mcr_json_unsigned(json, "wide", data->accel->wide_count);
    mcr_json_unsigned(json, "bytes", data->accel_bytes);
    mcr_json_text(json, "instruction_set", mcr_cpu_isa_name(data->options->isa));
    mcr_json_end(json);
}

static void json_lights(struct mcr_json_writer *json, const struct mcr_explain_data *data)
{
    const struct mcr_explained_lights *l = &data->core.lights;
    mcr_json_begin_object(json, "lights");
    mcr_json_unsigned(json, "emitters", l->emitters);
    mcr_json_begin_object(json, "kinds");
    for (uint32_t k = 0; k < MCR_EXPLAINED_EMITTER_KINDS; k++)
        mcr_json_unsigned(json, mcr_explained_emitter_kind[k], l->kind[k]);
    mcr_json_end(json);
    mcr_json_unsigned(json, "one_sided", l->one_sided);
    mcr_json_unsigned(json, "two_sided", l->two_sided);
    mcr_json_text(json, "chosen", choice_of(l));
    mcr_json_boolean(json, "sky", l->sky);
    mcr_json_number(json, "sky_share", l->sky_share);
    mcr_json_unsigned(json, "points", l->points);
    mcr_json_unsigned(json, "spots", l->spots);
    mcr_json_unsigned(json, "suns", l->suns);
    mcr_json_boolean(json, "points_tree", l->points_tree);
    mcr_json_end(json);
}

static void json_features(struct mcr_json_writer *json, const struct mcr_explain_data *data)
{
    mcr_json_begin_array(json, "features");
    for (uint32_t i = 0; i < data->core.count; i++) {
        const struct mcr_explained_feature *f = &data->core.feature[i];
        mcr_json_begin_object(json, NULL);
        mcr_json_text(json, "name", f->name);
        mcr_json_boolean(json, "active", f->active);
        mcr_json_text(json, "why", f->why);
        mcr_json_unsigned(json, "batch_bytes", f->batch_bytes);
        mcr_json_unsigned(json, "table_bytes", f->table_bytes);
        mcr_json_begin_array(json, "stages");
        for (uint32_t s = 0; s < MCR_STAGE_COUNT; s++)
            if (f->stages & 1u << s)
                mcr_json_text(json, NULL, mcr_stage_name[s]);
        mcr_json_end(json);
        mcr_json_number(json, "ns", per_sample(data, stage_seconds(data, f->stages)));
        mcr_json_end(json);
    }
    mcr_json_begin_object(json, NULL);
    mcr_json_text(json, "name", "variance layer");
    mcr_json_boolean(json, "active", data->options->variance_layer);
    mcr_json_text(json, "why", data->options->variance_layer ? "asked for" : "it is not asked for");
    mcr_json_unsigned(json, "batch_bytes", 0);
    mcr_json_unsigned(json, "table_bytes", 0);
    mcr_json_unsigned(json, "film_bytes", data->variance_bytes);
    mcr_json_begin_array(json, "stages");
    mcr_json_end(json);
    mcr_json_number(json, "ns", 0);
    mcr_json_end(json);
    mcr_json_end(json);
}

static void json_time(struct mcr_json_writer *json, const struct mcr_explain_data *data)
{
    const double all = all_seconds(data);
    mcr_json_begin_object(json, "time");
    mcr_json_number(json, "ns", per_sample(data, all));
    mcr_json_number(json, "rays", (double)rays_of(&data->pilot) / (double)data->pilot.samples);
    mcr_json_begin_object(json, "stages");
    for (uint32_t i = 0; i < MCR_STAGE_COUNT; i++)
        mcr_json_number(json, mcr_stage_name[i], per_sample(data, data->pilot.stage_seconds[i]));
    mcr_json_end(json);
    mcr_json_unsigned(json, "pilot_samples", data->pilot.samples);
    mcr_json_number(json, "samples", render_samples(data));
    mcr_json_unsigned(json, "threads", data->threads);
    mcr_json_number(json, "prepare", data->prepare_seconds);
    mcr_json_number(json, "render", render_seconds(data));
    mcr_json_end(json);
}

static void json_memory(struct mcr_json_writer *json, const struct mcr_explain_data *data)
{
    mcr_json_begin_object(json, "memory");
    mcr_json_unsigned(json, "scene", data->scene_bytes);
    mcr_json_unsigned(json, "accelerator", data->accel_bytes);
    mcr_json_unsigned(json, "textures", data->core.texture_bytes);
    mcr_json_unsigned(json, "tables", data->core.table_bytes);
    mcr_json_unsigned(json, "tables_base", data->core.table_base_bytes);
    mcr_json_unsigned(json, "batch", data->core.batch_bytes);
    mcr_json_unsigned(json, "batch_base", data->core.batch_base_bytes);
    mcr_json_unsigned(json, "batch_paths", data->core.batch);
    mcr_json_unsigned(json, "film", data->film_bytes);
    mcr_json_unsigned(json, "pass", data->core.pass_bytes);
    mcr_json_unsigned(json, "picture", data->picture_bytes);
    mcr_json_unsigned(json, "measured", data->measured);
    mcr_json_unsigned(json, "total", data->total);
    mcr_json_end(json);
}

int mcr_explain_json(struct mcr_target *target, const struct mcr_explain_data *data, char *error, size_t length)
{
    const struct mcr_scene *scene = data->loaded->scene;
    struct mcr_json_writer *json = mcr_json_writer_create(NULL);
    int status = -1;
    if (json) {
        mcr_json_begin_object(json, NULL);
        mcr_json_text(json, "mcrender", PACKAGE_VERSION);
        mcr_json_text(json, "file", data->options->scene);
        mcr_json_text(json, "sampler", scene->sampler->expression);
        mcr_json_boolean(json, "sampler_chosen", scene->sampler_chosen);
        mcr_json_boolean(json, "complete", data->coverage.complete);
        mcr_json_text(json, "missing", data->coverage.missing);
        json_loaded(json, data);
        json_lights(json, data);
        json_features(json, data);
        json_time(json, data);
        json_memory(json, data);
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
