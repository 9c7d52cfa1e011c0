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
    if (!word) {
        unknown_kind(build, block);
        return;
    }
    mcr_settings_match(build, block, word, 0, &settings);
    read_placement(build, &settings, texture);
    texture->kind = MCR_TEXTURE_CHECKER;
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
