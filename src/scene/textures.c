/* SPDX-License-Identifier: Apache-2.0 */
/* Blocks `texture NAME image|checker|gradient { … }`, found by name. */
#include "scene/build.h"
#include "scene/texture_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- settings that several kinds have ---- */

/* A number for both axes, or one for each. */
static void read_scale(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, double out[2])
{
    const struct mcr_parameter *row = &settings->word->setting[index];
    const struct mcr_value *value = settings->value[index], *found = value ? mcr_value_resolve(value) : NULL;
    double scale[2];
    out[0] = out[1] = 1;
    if (!value || found->kind == MCR_VALUE_ERROR)
        return;
    if (found->kind == MCR_VALUE_NUMBER)
        scale[0] = scale[1] = found->number;
    else if (mcr_read_numbers(build, value, row->name, settings->of, mcr_word_form(row->type), 2, row->max, scale) != 0)
        return;
    for (int i = 0; i < 2; i++) {
        if (fabs(scale[i]) >= MCR_TEXTURE_SCALE_LEAST && fabs(scale[i]) <= row->max) {
            out[i] = scale[i];
            continue;
        }
        mcr_error(build, value->place, "'%s' of '%s' has %.10g, expected a magnitude from %g to %g", row->name, settings->of, scale[i],
                  MCR_TEXTURE_SCALE_LEAST, row->max);
        return;
    }
}

static void read_placement(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_texture *texture)
{
    const struct mcr_parameter *row = &settings->word->setting[TEXTURE_OFFSET];
    const struct mcr_value *value = settings->value[TEXTURE_OFFSET];
    read_scale(build, settings, TEXTURE_SCALE, texture->scale);
    if (value)
        mcr_read_numbers(build, value, row->name, settings->of, mcr_word_form(row->type), 2, row->max, texture->offset);
}

/* The place of a word in its list. */
static uint32_t read_choice(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index)
{
    double number = settings->word->setting[index].fallback[0];
    mcr_read_number(build, settings, index, &number);
    return (uint32_t)number;
}

static int is_grey(const double colour[3])
{
    return colour[0] == colour[1] && colour[1] == colour[2];
}

/* ---- checker ---- */

static void build_checker(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_texture *texture)
{
    struct mcr_texture_checker *checker = &texture->checker;
    struct mcr_texture_bounds *bounds = &texture->bounds;
    mcr_read_colour(build, settings, CHECKER_EVEN, checker->even);
    mcr_read_colour(build, settings, CHECKER_ODD, checker->odd);
    checker->filtered = read_choice(build, settings, CHECKER_FILTER) == 0;
    texture->grey = is_grey(checker->even) && is_grey(checker->odd);
    for (int c = 0; c < 3; c++) {
        bounds->min[c] = fmin(checker->even[c], checker->odd[c]);
        bounds->max[c] = fmax(checker->even[c], checker->odd[c]);
        bounds->mean[c] = 0.5 * checker->even[c] + 0.5 * checker->odd[c];
    }
}

/* ---- gradient ---- */

/* The colours at 0 and 1; -1 after an error. */
static int read_ends(struct mcr_build *build, const struct mcr_settings *settings, double position[2], double (*colour)[3])
{
    uint32_t missing = settings->value[GRADIENT_FROM] ? GRADIENT_TO : GRADIENT_FROM;
    position[1] = 1;
    if (!settings->value[missing]) {
        if (!settings->damaged && !(settings->misspelt & 1u << missing))
            mcr_error(build, settings->place, "a gradient needs '%s', expected from and to, or stops", settings->word->setting[missing].name);
        return -1;
    }
    return mcr_read_colour(build, settings, GRADIENT_FROM, colour[0]) | mcr_read_colour(build, settings, GRADIENT_TO, colour[1]) ? -1 : 0;
}

/* One stop (position, colour), not before `least`; -1 after an error. */
static int read_stop(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_value *item, double least, double *position,
                     double colour[3])
{
    static const struct mcr_parameter row = { .size = sizeof row, .type = MCR_TYPE_COLOUR, .name = "stops", .unit = "", .summary = "",
                                              .min = -MCR_EXTENT_LIMIT, .max = MCR_EXTENT_LIMIT };
    const struct mcr_value *stop = mcr_value_resolve(item), *at;
    at = stop->kind == MCR_VALUE_TUPLE && stop->count == 2 ? mcr_value_resolve(&stop->item[0]) : NULL;
    if (!at || (at->kind != MCR_VALUE_NUMBER && at->kind != MCR_VALUE_ERROR))
        return mcr_wrong_kind(build, item, row.name, settings->of, "stops (position, colour)");
    if (at->kind == MCR_VALUE_ERROR || mcr_value_resolve(&stop->item[1])->kind == MCR_VALUE_ERROR)
        return -1;
    if (!(at->number >= least && at->number <= 1)) {
        mcr_error(build, stop->item[0].place, "a stop stands at %.10g, expected ascending positions from 0 to 1", at->number);
        return -1;
    }
    *position = at->number;
    return mcr_value_check(build->diagnostics, &row, &stop->item[1], settings->of, colour);
}

/* Stops from the text, with one more at each end; -1 after an error. */
static int read_stops(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_value *list, double *position,
                      double (*colour)[3])
{
    for (uint32_t k = 1; k <= list->count; k++)
        if (read_stop(build, settings, &list->item[k - 1], position[k - 1], &position[k], colour[k]) != 0)
            return -1;
    memcpy(colour[0], colour[1], sizeof colour[0]);
    position[list->count + 1] = 1;
    memcpy(colour[list->count + 1], colour[list->count], sizeof colour[0]);
    return 0;
}

/* The bounds of the stops, and the mean of a grid over the unit square. */
static void bound_gradient(struct mcr_texture *texture)
{
    enum { SIDE = 64 };
    const struct mcr_texture_gradient *gradient = &texture->gradient;
    struct mcr_texture_bounds *bounds = &texture->bounds;
    double u[SIDE], v[SIDE], out[3][SIDE];
    texture->grey = 1;
    for (uint32_t k = 0; k < gradient->count; k++) {
        texture->grey &= is_grey(gradient->colour[k]);
        for (int c = 0; c < 3; c++) {
            bounds->min[c] = k == 0 ? gradient->colour[k][c] : fmin(bounds->min[c], gradient->colour[k][c]);
            bounds->max[c] = k == 0 ? gradient->colour[k][c] : fmax(bounds->max[c], gradient->colour[k][c]);
        }
    }
    for (uint32_t row = 0; row < SIDE; row++) {
        for (uint32_t i = 0; i < SIDE; i++) {
            u[i] = (i + 0.5) / SIDE;
            v[i] = (row + 0.5) / SIDE;
        }
        mcr_texture_lookup(texture, SIDE, u, v, NULL, out[0], out[1], out[2]);
        for (uint32_t i = 0; i < SIDE; i++)
            for (int c = 0; c < 3; c++)
                bounds->mean[c] += out[c][i] / (SIDE * SIDE);
    }
}

static void build_gradient(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_texture *texture)
{
    struct mcr_texture_gradient *gradient = &texture->gradient;
    const struct mcr_value *value = settings->value[GRADIENT_STOPS], *list = value ? mcr_value_resolve(value) : NULL;
    int ends = settings->value[GRADIENT_FROM] || settings->value[GRADIENT_TO], failed;
    double *position, (*colour)[3];
    gradient->along = read_choice(build, settings, GRADIENT_ALONG);
    gradient->wrap = (uint32_t[]){ MCR_WRAP_CLAMP, MCR_WRAP_REPEAT, MCR_WRAP_MIRROR }[read_choice(build, settings, GRADIENT_WRAP)];
    if (list && ends) {
        mcr_error(build, settings->key[GRADIENT_STOPS], "a gradient has 'stops' or 'from' and 'to', expected one of these");
        return;
    }
    if (list && (list->kind != MCR_VALUE_TUPLE || list->count < 2 || list->count > MCR_TEXTURE_STOPS)) {
        mcr_wrong_kind(build, value, "stops", settings->of, "a tuple of 2 to 256 stops (position, colour)");
        return;
    }
    gradient->count = list ? list->count + 2 : 2;
    gradient->position = position = mcr_build_alloc(build, gradient->count, sizeof *position);
    colour = mcr_build_alloc(build, gradient->count, sizeof *colour);
    gradient->colour = (const double(*)[3])colour;
    if (!position || !colour)
        return;
    failed = list ? read_stops(build, settings, list, position, colour) : read_ends(build, settings, position, colour);
    if (failed)
        return;
    texture->kind = MCR_TEXTURE_GRADIENT;
    bound_gradient(texture);
}

/* ---- blocks ---- */

/* Records that the kind is absent or unknown. */
static void unknown_kind(struct mcr_build *build, const struct mcr_item *block)
{
    static const char *const kinds[] = { "image", "checker", "gradient" };
    const char *nearest;
    if (!block->name || !block->kind) {
        mcr_error(build, block->place, "'texture' needs its %s, expected texture NAME image|checker|gradient { ... }",
                  block->name ? "kind" : "name and kind");
        return;
    }
    nearest = mcr_nearest_word(block->kind, kinds, 3);
    mcr_error(build, block->kind_place, "unknown kind '%s' of 'texture', expected image, checker or gradient", block->kind);
    if (nearest)
        mcr_report(build->diagnostics, MCR_NOTE, block->kind_place, "did you mean '%s'?", nearest);
}

static void create(struct mcr_build *build, const struct mcr_item *block, struct mcr_scene_texture *named)
{
    const struct mcr_block_word *word = block->name ? mcr_scene_block("texture", block->kind) : NULL;
    struct mcr_settings settings;
    struct mcr_texture *texture;
    named->name = block->name ? block->name : "";
    named->place = block->name ? block->name_place : block->place;
    texture = mcr_build_alloc(build, 1, sizeof *texture);
    if (!texture)
        return;
    named->texture = texture;
    texture->kind = MCR_TEXTURE_CHECKER; /* what is wrong is black */
    if (!word) {
        unknown_kind(build, block);
        return;
    }
    mcr_settings_match(build, block, word, 0, &settings);
    read_placement(build, &settings, texture);
    if (strcmp(word->kind, "image") == 0)
        mcr_build_image(build, &settings, texture);
    else if (strcmp(word->kind, "gradient") == 0)
        build_gradient(build, &settings, texture);
    else
        build_checker(build, &settings, texture);
}

static int by_name(const void *a, const void *b)
{
    const struct mcr_named_texture *p = a, *q = b;
    int order = strcmp(p->name, q->name);
    return order ? order : (p->number > q->number) - (p->number < q->number);
}

static void sort_names(struct mcr_build *build)
{
    const struct mcr_scene *scene = build->scene;
    uint32_t n = scene->texture_count;
    for (uint32_t i = 0; i < n; i++)
        build->textures[i] = (struct mcr_named_texture){ scene->texture[i].name, i };
    qsort(build->textures, n, sizeof *build->textures, by_name);
    for (uint32_t i = 0, first = 0; i < n; i++) {
        const struct mcr_scene_texture *one = &scene->texture[build->textures[i].number],
            *other = &scene->texture[build->textures[first].number];
        build->texture_names[i] = one->name;
        if (i == first || strcmp(one->name, other->name) != 0) {
            first = i;
            continue;
        }
        mcr_error(build, one->place, "a texture '%s' exists already", one->name);
        mcr_report(build->diagnostics, MCR_NOTE, other->place, "the first one is here");
    }
}

void mcr_build_textures(struct mcr_build *build, const struct mcr_item *root)
{
    struct mcr_scene *scene = build->scene;
    uint32_t n = 0;
    for (uint32_t i = 0; i < root->count; i++)
        n += root->item[i].is_block && strcmp(root->item[i].word, "texture") == 0;
    if (n == 0)
        return;
    scene->texture = mcr_build_alloc(build, n, sizeof *scene->texture);
    build->textures = mcr_build_alloc(build, n, sizeof *build->textures);
    build->texture_names = mcr_build_alloc(build, n, sizeof *build->texture_names);
    build->texture_used = mcr_build_alloc(build, n, sizeof *build->texture_used);
    for (uint32_t i = 0; i < root->count && !build->short_of_memory; i++)
        if (root->item[i].is_block && strcmp(root->item[i].word, "texture") == 0)
            create(build, &root->item[i], &scene->texture[scene->texture_count++]);
    if (build->short_of_memory)
        return;
    sort_names(build);
}

/* Its place in the sorted names, or texture_count. */
static uint32_t find(const struct mcr_build *build, const char *name)
{
    uint32_t n = build->scene->texture_count, low = 0, high = n;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (strcmp(build->texture_names[middle], name) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < n && strcmp(build->texture_names[low], name) == 0 ? low : n;
}

int mcr_build_is_texture(const struct mcr_build *build, const char *name)
{
    return find(build, name) < build->scene->texture_count;
}

const struct mcr_texture *mcr_build_find_texture(struct mcr_build *build, const struct mcr_value *value)
{
    const struct mcr_scene *scene = build->scene;
    uint32_t at = find(build, value->text), number;
    const char *nearest;
    if (at < scene->texture_count) {
        number = build->textures[at].number;
        build->texture_used[number] = 1;
        return scene->texture[number].texture;
    }
    mcr_error(build, value->place, "there is no texture '%s'", value->text);
    nearest = mcr_nearest_word(value->text, build->texture_names, scene->texture_count);
    if (nearest)
        mcr_report(build->diagnostics, MCR_NOTE, value->place, "did you mean '%s'?", nearest);
    return NULL;
}

void mcr_build_unused_textures(struct mcr_build *build)
{
    /* What was wrong may have used it. */
    if (mcr_diagnostics_errors(build->diagnostics) > 0)
        return;
    for (uint32_t i = 0; i < build->scene->texture_count; i++)
        if (!build->texture_used[i])
            mcr_report(build->diagnostics, MCR_WARNING, build->scene->texture[i].place, "texture '%s' is not used",
                       build->scene->texture[i].name);
}
