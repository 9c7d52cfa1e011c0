/* SPDX-License-Identifier: Apache-2.0 */
#include "study/shot.h"

#include <stdio.h>
#include <string.h>

#include "base/cpu.h"
#include "film/film.h"

#define ARENA_LIMIT ((size_t)8 << 30) /* bytes: as for any scene */

/* The command line's settings with the cell's over them. */
static struct mcr_overrides overrides_of(const struct mcr_study_setup *setup, const struct mcr_shot_settings *settings,
                                         struct mcr_study_texts *passed_over)
{
    const struct mcr_scene_study *asked = setup->scene->study;
    struct mcr_overrides over = *setup->overrides;
    memset(passed_over, 0, sizeof *passed_over);
    passed_over->passed_over = 1;
    over.study = passed_over;
    over.sampler = settings->sampler;
    over.has_spp = over.has_depth = over.has_seed = over.has_accel = over.has_replicates = over.has_compat = 1;
    over.spp = settings->spp;
    over.depth = settings->depth;
    over.seed = settings->seed;
    over.accel = settings->accel;
    over.compat = settings->compat;
    over.replicates = 1; /* errors come from the seeds */
    over.plain = 1;
    over.has_roulette = settings->has_roulette;
    over.roulette = settings->roulette;
    if (asked->has_size && !over.has_size) {
        over.has_size = 1;
        over.width = asked->size[0];
        over.height = asked->size[1];
    }
    if (asked->has_crop && !over.has_crop) {
        over.has_crop = 1;
        memcpy(over.crop, asked->crop, sizeof over.crop);
    }
    return over;
}

/* Rendering itself, timed by the core. */
static int render(const struct mcr_study_setup *setup, const struct mcr_scene *scene, const struct mcr_accel *accel, struct mcr_shot *shot, char *error,
                  size_t length)
{
    static const char *const names[] = {"R", "G", "B"};
    struct mcr_render_options how = {.isa = setup->isa, .stop = setup->stop, .progress = setup->beat, .progress_data = setup->beat_data};
    struct mcr_film *film = mcr_film_create(scene->film.x1 - scene->film.x0, scene->film.y1 - scene->film.y0, 0);
    struct mcr_cell_sink sink;
    int status = -1;
    snprintf(error, length, "out of memory");
    if (!film)
        return -1;
    sink = mcr_film_sink(film);
    if (!mcr_render(scene, accel, &how, &sink, &shot->stats, error, length)) {
        status = shot->stats.interrupted ? 1 : 0;
        shot->image = status ? NULL : mcr_image_create(film->width, film->height, 3, names);
        if (shot->image) {
            mcr_film_mean(film, shot->image->data);
        } else if (!status) {
            snprintf(error, length, "out of memory");
            status = -1;
        }
    }
    mcr_film_destroy(film);
    return status;
}

int mcr_shot_render(const struct mcr_study_setup *setup, const struct mcr_shot_settings *settings, struct mcr_shot *shot, char *error, size_t length)
{
    struct mcr_study_texts passed_over;
    struct mcr_overrides over = overrides_of(setup, settings, &passed_over);
    struct mcr_arena *arena = mcr_arena_create(ARENA_LIMIT);
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    struct mcr_scene *scene = NULL;
    struct mcr_accel *accel = NULL;
    int status = -1;
    double start = mcr_wall_seconds();
    if (arena && diagnostics)
        scene = mcr_scene_build(arena, diagnostics, setup->registry, setup->root, &over);
    if (scene)
        accel = mcr_accel_create(arena, scene, scene->render.accel);
    shot->build_seconds = mcr_wall_seconds() - start;
    if (accel)
        status = render(setup, scene, accel, shot, error, length);
    else /* mistakes were found by the trial */
        snprintf(error, length, "not enough memory for the scene");
    mcr_scene_destroy(scene);
    if (diagnostics)
        mcr_diagnostics_destroy(diagnostics);
    mcr_arena_destroy(arena);
    return status;
}

void mcr_shot_fini(struct mcr_shot *shot)
{
    mcr_image_destroy(shot->image);
    shot->image = NULL;
}

/* ---- trials ---- */

static uint64_t add_text(uint64_t hash, const char *text)
{
    for (size_t i = 0; i <= strlen(text); i++)
        hash = (hash ^ (unsigned char)text[i]) * UINT64_C(1099511628211);
    return hash;
}

static uint64_t add_plugin(uint64_t hash, const struct mcr_node *node)
{
    hash = add_text(add_text(hash, node->descriptor->name), node->descriptor->version);
    for (uint32_t i = 0; i < node->child_count; i++)
        hash = add_plugin(hash, node->child[i]);
    return hash;
}

static uint64_t plugins_of(const struct mcr_scene *scene)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    for (uint32_t i = 0; i < scene->material_count; i++)
        hash = add_plugin(hash, scene->material[i].node);
    hash = add_plugin(hash, scene->sampler->source_count ? scene->sampler->source[0] : scene->sampler->directions);
    return add_plugin(hash, scene->sampler->independent);
}

int mcr_shot_try(const struct mcr_study_setup *setup, struct mcr_diagnostics *diagnostics, const struct mcr_shot_settings *settings,
                 struct mcr_trial *trial)
{
    struct mcr_study_texts passed_over;
    struct mcr_overrides over = overrides_of(setup, settings, &passed_over);
    struct mcr_arena *arena = mcr_arena_create(ARENA_LIMIT);
    struct mcr_scene *scene = arena ? mcr_scene_build(arena, diagnostics, setup->registry, setup->root, &over) : NULL;
    if (scene) {
        mcr_coverage(scene, &trial->coverage);
        trial->plugins = plugins_of(scene);
        trial->compat = scene->render.compat;
        trial->film = scene->film;
        trial->roulette = scene->render.roulette != 0;
        trial->roulette_from = scene->render.roulette_from;
    }
    mcr_scene_destroy(scene);
    mcr_arena_destroy(arena);
    return scene ? 0 : -1;
}
