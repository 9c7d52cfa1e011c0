/* SPDX-License-Identifier: Apache-2.0 */
/* Blocks `camera KIND { … }`. */
#include "scene/build.h"
#include "scene/vector.h"

/* right, up and forward of the picture; -1 after an error. */
static int frame(struct mcr_build *build, const struct mcr_settings *settings, double to_distance[1])
{
    struct mcr_camera *camera = &build->scene->camera;
    double from[3], to[3], up[3], view[3];
    int bad = mcr_read_vector(build, settings, CAMERA_FROM, from) != 0;
    bad |= mcr_read_vector(build, settings, CAMERA_TO, to) != 0;
    bad |= mcr_read_vector(build, settings, CAMERA_UP, up) < 0;
    if (bad)
        return -1;
    mcr_copy(from, camera->world);
    mcr_subtract(to, from, view);
    *to_distance = mcr_length(view);
    if (!mcr_unit(view, camera->forward)) {
        mcr_error(build, settings->value[CAMERA_TO]->place, "'from' and 'to' of the camera are the same point");
        return -1;
    }
    if (mcr_sine(camera->forward, up, camera->right) <= MCR_PARALLEL) {
        int given = settings->value[CAMERA_UP] != NULL;
        mcr_error(build, given ? settings->value[CAMERA_UP]->place : settings->place, "%s of the camera is %s%s",
                  given ? "'up'" : "the default 'up', (0, 1, 0),", mcr_largest(up) == 0 ? "zero" : "parallel to the view",
                  given ? "" : ": 'up' must be given");
        return -1;
    }
    mcr_cross(camera->right, camera->forward, camera->up);
    mcr_unit(camera->up, camera->up);
    return 0;
}

/* tan(fov/2) from an angle, or from a focal length and the height of the film. */
static void field_of_view(struct mcr_build *build, const struct mcr_settings *settings)
{
    double fov = 0, focal = 0, height = 0;
    int has_fov = mcr_read_number(build, settings, CAMERA_FOV, &fov), has_focal = mcr_read_number(build, settings, CAMERA_FOCAL, &focal);
    int has_height = mcr_read_number(build, settings, CAMERA_FILM_HEIGHT, &height);
    if (has_fov < 0 || has_focal < 0 || has_height < 0)
        return;
    if (has_fov == 0 && (has_focal == 0 || has_height == 0)) {
        uint32_t other = has_focal == 0 ? CAMERA_FOCAL : CAMERA_FILM_HEIGHT;
        mcr_error(build, settings->key[other], "'fov' and '%s' are both given, expected 'fov', or 'focal' with 'film_height'",
                  settings->word->setting[other].name);
        mcr_report(build->diagnostics, MCR_NOTE, settings->key[CAMERA_FOV], "'fov' was given here");
    } else if (has_fov == 0) {
        build->scene->camera.half_height = mcr_tan_degrees(fov / 2);
    } else if (has_focal == 0 && has_height == 0) {
        build->scene->camera.half_height = height / 2 / focal;
        if (!(build->scene->camera.half_height >= 1e-100 && build->scene->camera.half_height <= 1e100))
            mcr_error(build, settings->value[CAMERA_FILM_HEIGHT]->place, "'film_height' over 'focal' is out of range");
    } else if (has_focal == 0 || has_height == 0) {
        uint32_t given = has_focal == 0 ? CAMERA_FOCAL : CAMERA_FILM_HEIGHT, other = has_focal == 0 ? CAMERA_FILM_HEIGHT : CAMERA_FOCAL;
        mcr_error(build, settings->key[given], "'%s' needs '%s' beside it", settings->word->setting[given].name,
                  settings->word->setting[other].name);
    } else if (!settings->damaged) {
        mcr_error(build, settings->place, "'camera' needs 'fov', or 'focal' with 'film_height'");
    }
}

static void unknown_kind(struct mcr_build *build, const struct mcr_item *block)
{
    static const char *const kinds[] = { "perspective", "orthographic", "thinlens" };
    const char *nearest;
    if (!block->kind) {
        mcr_error(build, block->place, "'camera' needs its kind, expected perspective, orthographic or thinlens");
        return;
    }
    nearest = mcr_nearest_word(block->kind, kinds, 3);
    mcr_error(build, block->kind_place, "unknown kind '%s' of 'camera', expected perspective, orthographic or thinlens", block->kind);
    if (nearest)
        mcr_report(build->diagnostics, MCR_NOTE, block->kind_place, "did you mean '%s'?", nearest);
}

void mcr_build_camera(struct mcr_build *build, const struct mcr_item *block)
{
    static const struct mcr_camera start = { .right = { -1, 0, 0 }, .up = { 0, 1, 0 }, .forward = { 0, 0, 1 }, .half_height = 1 };
    struct mcr_camera *camera = &build->scene->camera;
    const struct mcr_block_word *word;
    struct mcr_settings settings;
    double distance = 1;
    *camera = start;
    if (!block)
        return;
    word = mcr_scene_block("camera", block->kind);
    if (!word) {
        unknown_kind(build, block);
        return;
    }
    mcr_settings_match(build, block, word, 0, &settings);
    if (settings.value[CAMERA_FROM] && settings.value[CAMERA_TO])
        frame(build, &settings, &distance);
    if (strcmp(word->kind, "orthographic") == 0) {
        double height = 2;
        camera->kind = MCR_CAMERA_ORTHOGRAPHIC;
        mcr_read_number(build, &settings, ORTHOGRAPHIC_HEIGHT, &height);
        camera->half_height = height / 2;
        return;
    }
    field_of_view(build, &settings);
    if (strcmp(word->kind, "thinlens") == 0) {
        camera->kind = MCR_CAMERA_THIN_LENS;
        mcr_read_number(build, &settings, CAMERA_LENS_RADIUS, &camera->lens_radius);
        if (mcr_read_number(build, &settings, CAMERA_FOCUS_DISTANCE, &camera->focus_distance) == 1)
            camera->focus_distance = distance;
    }
}
