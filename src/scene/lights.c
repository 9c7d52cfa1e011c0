/* SPDX-License-Identifier: Apache-2.0 */
/* Blocks `light NAME KIND { … }`: points, spots, suns and the environment, from text into the camera's frame, in world units. */
#include "image/pixels.h"
#include "scene/build.h"
#include "scene/vector.h"

#include <stdlib.h>

/* ---- Reading --------------------------------------------------------------------------------------------------- */

static const char *name_of(const struct mcr_settings *settings, uint32_t index)
{
    return settings->word->setting[index].name;
}

/*
 * Which of `count` alternatives, each told by one setting of `list`, is given: its place in the list. Two of them, or none, are an error
 * (-1); `expected` names all.
 */
static int alternative(struct mcr_build *build, const struct mcr_settings *settings, const uint32_t *list, int count, const char *expected)
{
    int found = -1;
    for (int i = 0; i < count; i++) {
        if (!settings->value[list[i]])
            continue;
        if (found >= 0) {
            mcr_error(build, settings->key[list[i]], "'%s' and '%s' are both given in 'light', expected %s", name_of(settings, list[found]),
                      name_of(settings, list[i]), expected);
            return -1;
        }
        found = i;
    }
    if (found < 0 && !settings->damaged && !settings->misspelt)
        mcr_error(build, settings->place, "'light' needs %s", expected);
    return found;
}

/* A direction of any length, moved and made unit; -1 after an error. */
static int read_direction(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, const struct mcr_transform *transform,
                          double out[3])
{
    double v[3];
    if (mcr_read_vector(build, settings, index, v) != 0)
        return -1;
    if (mcr_largest(v) == 0) {
        mcr_error(build, settings->value[index]->place, "'%s' of '%s' is zero", name_of(settings, index), settings->of);
        return -1;
    }
    mcr_level(v, v);
    mcr_transform_vector(transform, v, v);
    mcr_unit(v, out);
    return 0;
}

/* 1 - cos, without cancellation. */
static double versine(double degrees)
{
    double s = mcr_sin_degrees(degrees / 2);
    return 2 * s * s;
}

/* ---- Points, spots and suns ------------------------------------------------------------------------------------ */

/* Intensity, from what radiates over so many steradians at full intensity if the power is told. Returns 0, or -1 after an error. */
static int read_intensity(struct mcr_build *build, const struct mcr_settings *settings, double steradians, struct mcr_scene_light *light)
{
    static const uint32_t either[] = { POINT_INTENSITY, POINT_POWER };
    int which = alternative(build, settings, either, 2, "'intensity' or 'power'");
    if (which < 0 || mcr_read_colour(build, settings, either[which], light->colour) != 0)
        return -1;
    for (int i = 0; i < 3 && which == 1; i++)
        light->colour[i] /= steradians;
    return 0;
}

static int read_position(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform, double out[3])
{
    double p[3];
    if (mcr_read_vector(build, settings, POINT_POSITION, p) != 0)
        return -1;
    mcr_transform_point(transform, p, out);
    if (mcr_largest(out) <= MCR_EXTENT_LIMIT)
        return 0;
    mcr_error(build, settings->place, "'light' is at %.3g, expected coordinates of at most %g", mcr_largest(out), MCR_EXTENT_LIMIT);
    return -1;
}

static int build_point(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                       struct mcr_scene_light *light)
{
    int bad = read_position(build, settings, transform, light->position) != 0;
    light->kind = MCR_LIGHT_POINT;
    bad |= read_intensity(build, settings, 4 * MCR_PI, light) != 0;
    return bad ? -1 : 0;
}

static int read_axis(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                     struct mcr_scene_light *light)
{
    static const uint32_t either[] = { SPOT_TO, SPOT_DIRECTION };
    int which = alternative(build, settings, either, 2, "'to' or 'direction'");
    double to[3];
    if (which < 0)
        return -1;
    if (which == 1)
        return read_direction(build, settings, SPOT_DIRECTION, transform, light->direction);
    if (mcr_read_vector(build, settings, SPOT_TO, to) != 0)
        return -1;
    mcr_transform_point(transform, to, to);
    mcr_subtract(to, light->position, to);
    if (mcr_unit(to, light->direction))
        return 0;
    mcr_error(build, settings->value[SPOT_TO]->place, "'position' and 'to' of 'light' are the same point");
    return -1;
}

/* The smooth step is symmetric: a spot radiates as much as one of full intensity up to the middle, in 1 - cos, of where it falls off. */
static int build_spot(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                      struct mcr_scene_light *light)
{
    double angle = settings->word->setting[SPOT_ANGLE].fallback[0], softness = settings->word->setting[SPOT_SOFTNESS].fallback[0];
    int bad = read_position(build, settings, transform, light->position) != 0;
    light->kind = MCR_LIGHT_SPOT;
    bad = bad || read_axis(build, settings, transform, light) != 0;
    bad |= mcr_read_number(build, settings, SPOT_ANGLE, &angle) < 0;
    bad |= mcr_read_number(build, settings, SPOT_SOFTNESS, &softness) < 0;
    if (!bad && angle < MCR_SUN_LEAST) {
        mcr_error(build, settings->value[SPOT_ANGLE]->place, "'angle' of 'light' is %.3g, expected at least %g degrees", angle, MCR_SUN_LEAST);
        bad = 1;
    }
    light->outer = versine(angle);
    light->inner = versine(angle * (1 - softness));
    bad |= read_intensity(build, settings, MCR_PI * (light->outer + light->inner), light) != 0;
    return bad ? -1 : 0;
}

static int build_sun(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                     struct mcr_scene_light *light)
{
    static const uint32_t either[] = { SUN_IRRADIANCE, SUN_RADIANCE };
    int which = alternative(build, settings, either, 2, "'irradiance' or 'radiance'");
    double radius = 0, sine;
    int bad = read_direction(build, settings, SUN_DIRECTION, transform, light->direction) != 0;
    light->kind = MCR_LIGHT_SUN;
    bad |= mcr_read_number(build, settings, SUN_ANGULAR_RADIUS, &radius) < 0;
    bad |= which < 0 || mcr_read_colour(build, settings, either[which], light->colour) != 0;
    if (!bad && radius > 0 && radius < MCR_SUN_LEAST) {
        mcr_error(build, settings->value[SUN_ANGULAR_RADIUS]->place, "'angular_radius' of 'light' is %.3g, expected 0 or at least %g degrees",
                  radius, MCR_SUN_LEAST);
        bad = 1;
    }
    if (!bad && which == 1 && radius == 0) {
        mcr_error(build, settings->key[SUN_RADIANCE], "'radiance' needs an 'angular_radius' above 0 beside it, expected 'irradiance' for parallel light");
        bad = 1;
    }
    if (bad)
        return -1;
    light->outer = versine(radius);
    sine = mcr_sin_degrees(radius);
    for (int i = 0; i < 3; i++) {
        light->direction[i] = 0 - light->direction[i]; /* toward it, without -0 */
        if (which == 0 && radius > 0)
            light->colour[i] /= MCR_PI * sine * sine; /* integral of the cosine over the cone */
    }
    return 0;
}

/* ---- The environment ------------------------------------------------------------------------------------------- */

/* Decodes the pixels. What is no radiance, negative, infinite or NaN, becomes 0, and a warning says so. */
static int take_texels(struct mcr_build *build, const struct mcr_pixels *pixels, uint32_t colour, struct mcr_place place, struct mcr_environment *sky)
{
    const int32_t channel[3] = { pixels->red, pixels->green, pixels->blue };
    const uint32_t transfer = mcr_build_transfer(colour, pixels);
    uint64_t count = (uint64_t)pixels->width * pixels->height, wrong = 0, first = 0;
    double *texel, *table;
    if (count > MCR_ENVIRONMENT_TEXELS) {
        mcr_error(build, place, "the image has %u x %u texels, expected at most %llu in all, as 8192 x 4096", pixels->width, pixels->height,
                  (unsigned long long)MCR_ENVIRONMENT_TEXELS);
        return -1;
    }
    texel = mcr_build_alloc(build, 3 * count, sizeof *texel);
    table = mcr_pixels_table(pixels, transfer);
    if (!texel || (pixels->peak && !table)) {
        free(table);
        mcr_error(build, place, "not enough memory for an image of %u x %u", pixels->width, pixels->height);
        return -1;
    }
    for (uint64_t i = 0; i < count; i++) {
        int bad = 0;
        for (int c = 0; c < 3; c++) {
            double v = mcr_pixels_linear(pixels, transfer, table, i * pixels->channels + (uint32_t)channel[c]);
            int good = v >= 0 && v <= MCR_EXTENT_LIMIT;
            texel[3 * i + (uint32_t)c] = good ? v : 0;
            bad |= !good;
        }
        first = bad && !wrong ? i : first;
        wrong += (uint64_t)bad;
    }
    free(table);
    if (wrong)
        mcr_report(build->diagnostics, MCR_WARNING, place,
                   "%llu texels of the image are negative or not finite and count as 0 there, the first in column %llu, row %llu",
                   (unsigned long long)wrong, (unsigned long long)(first % pixels->width), (unsigned long long)(first / pixels->width));
    sky->texel = texel;
    sky->width = pixels->width;
    sky->height = pixels->height;
    return 0;
}

static int read_image(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_environment *sky)
{
    const struct mcr_value *value = settings->value[SKY_IMAGE], *text = mcr_value_resolve(value);
    struct mcr_pixels *pixels;
    const char *path;
    double colour = MCR_COLOUR_AUTO;
    char reason[400];
    int result;
    mcr_read_number(build, settings, SKY_COLOUR, &colour);
    if (text->kind != MCR_VALUE_STRING)
        return mcr_wrong_kind(build, value, "image", settings->of, mcr_word_form(MCR_WORD_TEXT));
    path = mcr_build_path(build, text->text, text->place);
    if (!path)
        return -1;
    pixels = mcr_pixels_read(path, colour != MCR_COLOUR_AUTO, reason, sizeof reason);
    if (!pixels) {
        mcr_error(build, value->place, "cannot read '%s': %s", path, reason);
        return -1;
    }
    mcr_build_file(build, path, pixels->hash);
    result = take_texels(build, pixels, (uint32_t)colour, value->place, sky);
    mcr_pixels_destroy(pixels);
    return result;
}

/* Its colours; -1 after an error. */
static int read_gradient(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_environment *sky)
{
    int bad = 0;
    for (uint32_t i = SKY_ZENITH; i <= SKY_HORIZON; i++) {
        if (!settings->value[i] && !settings->damaged && !settings->misspelt)
            mcr_error(build, settings->place, "a gradient needs '%s', with 'zenith', 'horizon' and perhaps 'nadir'", name_of(settings, i));
        bad |= mcr_read_colour(build, settings, i, i == SKY_ZENITH ? sky->zenith : sky->horizon) != 0;
    }
    mcr_copy(sky->horizon, sky->nadir);
    if (settings->value[SKY_NADIR])
        bad |= mcr_read_colour(build, settings, SKY_NADIR, sky->nadir) != 0;
    return bad ? -1 : 0;
}

/* Radiance of one of the three kinds; -1 after an error. */
static int read_sky(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_environment *sky)
{
    uint32_t gradient = settings->value[SKY_ZENITH] ? SKY_ZENITH : settings->value[SKY_HORIZON] ? SKY_HORIZON : SKY_NADIR;
    const uint32_t either[] = { SKY_RADIANCE, gradient, SKY_IMAGE };
    int which = alternative(build, settings, either, 3, "'radiance', 'zenith' and 'horizon', or 'image'");
    int bad = which < 0;
    double number = 0;
    if (which == 0) {
        bad |= mcr_read_colour(build, settings, SKY_RADIANCE, sky->horizon) != 0;
        mcr_copy(sky->horizon, sky->zenith);
        mcr_copy(sky->horizon, sky->nadir);
    } else if (which == 1) {
        bad |= read_gradient(build, settings, sky) != 0;
    } else if (which == 2) {
        bad |= read_image(build, settings, sky) != 0;
    }
    for (uint32_t i = SKY_FILTER; i <= SKY_COLOUR; i++)
        if (which >= 0 && which != 2 && settings->value[i]) {
            mcr_error(build, settings->key[i], "'%s' is for an 'image', which is not given", name_of(settings, i));
            bad = 1;
        }
    bad |= mcr_read_number(build, settings, SKY_FILTER, &number) < 0;
    sky->bilinear = number == 1;
    sky->scale = 1;
    bad |= mcr_read_number(build, settings, SKY_SCALE, &sky->scale) < 0;
    for (int i = 0; i < 3; i++) {
        sky->zenith[i] *= sky->scale;
        sky->horizon[i] *= sky->scale;
        sky->nadir[i] *= sky->scale;
    }
    return bad ? -1 : 0;
}

/* Only turned or mirrored: how it would be stretched is not to be told from how bright it would become. */
static int read_frame(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                      struct mcr_environment *sky)
{
    double factor = mcr_transform_similarity(transform);
    if (!(factor > 0)) {
        mcr_error(build, settings->place, "an environment can be turned only, but where it stands it is stretched");
        return -1;
    }
    for (int j = 0; j < 3; j++) {
        double column[3] = { transform->l[0][j] / factor, transform->l[1][j] / factor, transform->l[2][j] / factor };
        mcr_copy(column, sky->frame[j]);
    }
    return 0;
}

static void build_environment(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                              struct mcr_place place)
{
    struct mcr_environment *sky = mcr_build_alloc(build, 1, sizeof *sky);
    if (!sky)
        return;
    sky->place = place;
    if (build->scene->environment) {
        mcr_error(build, place, "a second environment, a scene has at most one");
        mcr_report(build->diagnostics, MCR_NOTE, build->scene->environment->place, "the first is here");
    }
    if (mcr_largest(build->scene->render.background) > 0)
        mcr_error(build, place, "an environment beside a 'background' of 'render', expected one of them");
    if (read_sky(build, settings, sky) == 0)
        read_frame(build, settings, transform, sky);
    build->scene->environment = sky;
}

static double sky_most(const struct mcr_environment *sky)
{
    double most = 0;
    if (!sky->texel)
        return mcr_max(mcr_largest(sky->horizon), mcr_max(mcr_largest(sky->zenith), mcr_largest(sky->nadir)));
    for (uint64_t i = 0; i < 3 * (uint64_t)sky->width * sky->height; i++)
        most = mcr_max(most, sky->texel[i]);
    return most * sky->scale;
}

int mcr_build_sky_emits(const struct mcr_scene *scene)
{
    for (uint32_t i = 0; i < scene->light_count; i++)
        if (scene->light[i].kind == MCR_LIGHT_SUN && scene->light[i].outer > 0 && mcr_largest(scene->light[i].colour) > 0)
            return 1;
    return scene->environment && sky_most(scene->environment) > 0;
}

/* ---- All of them ----------------------------------------------------------------------------------------------- */

static uint64_t count_lights(const struct mcr_item *item, uint32_t count)
{
    uint64_t lights = 0;
    for (uint32_t i = 0; i < count; i++) {
        lights += item[i].is_block && strcmp(item[i].word, "light") == 0;
        if (item[i].is_block && strcmp(item[i].word, "group") == 0)
            lights += count_lights(item[i].item, item[i].count);
    }
    return lights;
}

int mcr_build_light_room(struct mcr_build *build, const struct mcr_item *root)
{
    uint64_t lights = count_lights(root->item, root->count);
    build->scene->light = mcr_build_alloc(build, lights, sizeof *build->scene->light);
    build->named_lights = mcr_build_alloc(build, lights, sizeof *build->named_lights);
    return build->short_of_memory ? -1 : 0;
}

static void unknown_kind(struct mcr_build *build, const struct mcr_item *block)
{
    static const char *const kinds[] = { "point", "spot", "sun", "environment" };
    const char *nearest;
    if (!block->kind) {
        mcr_error(build, block->place, "'light' needs its name and kind, expected light NAME KIND { ... }");
        return;
    }
    nearest = mcr_nearest_word(block->kind, kinds, 4);
    mcr_error(build, block->kind_place, "unknown kind '%s' of 'light', expected point, spot, sun or environment", block->kind);
    if (nearest)
        mcr_report(build->diagnostics, MCR_NOTE, block->kind_place, "did you mean '%s'?", nearest);
}

void mcr_build_light(struct mcr_build *build, const struct mcr_item *block, const struct mcr_transform *transform)
{
    const struct mcr_block_word *word = mcr_scene_block("light", block->kind);
    struct mcr_scene_light light = { .name = block->name ? block->name : "", .place = block->name ? block->name_place : block->place };
    struct mcr_transform own = *transform;
    struct mcr_settings settings;
    int bad;
    if (block->name)
        build->named_lights[build->named_light_count++] = (struct mcr_named_light){ light.name, light.place, build->named_light_count };
    if (!word) {
        unknown_kind(build, block);
        return;
    }
    bad = mcr_settings_match(build, block, word, 0, &settings) != 0;
    if (settings.transform && mcr_build_transform(build, settings.transform, &own) != 0)
        own = *transform; /* go on for the sake of further mistakes */
    if (strcmp(word->kind, "environment") == 0) {
        build_environment(build, &settings, &own, light.place);
        return;
    }
    for (uint32_t i = 0; i < word->count; i++)
        if ((word->setting[i].flags & MCR_PARAMETER_REQUIRED) && !settings.value[i])
            return; /* told as missing */
    bad |= strcmp(word->kind, "point") == 0   ? build_point(build, &settings, &own, &light)
           : strcmp(word->kind, "spot") == 0 ? build_spot(build, &settings, &own, &light)
                                             : build_sun(build, &settings, &own, &light);
    if (!bad)
        build->scene->light[build->scene->light_count++] = light;
}

static int by_name(const void *a, const void *b)
{
    const struct mcr_named_light *p = a, *q = b;
    int order = strcmp(p->name, q->name);
    return order ? order : (p->number > q->number) - (p->number < q->number);
}

void mcr_build_light_names(struct mcr_build *build)
{
    struct mcr_named_light *named = build->named_lights;
    if (!build->named_light_count)
        return;
    qsort(named, build->named_light_count, sizeof *named, by_name);
    for (uint32_t i = 1, first = 0; i < build->named_light_count; i++) {
        if (strcmp(named[i].name, named[first].name) != 0) {
            first = i;
            continue;
        }
        mcr_error(build, named[i].place, "a light '%s' exists already", named[i].name);
        mcr_report(build->diagnostics, MCR_NOTE, named[first].place, "the first one is here");
    }
}
