/* SPDX-License-Identifier: Apache-2.0 */
/* Blocks `material NAME KIND { … }`: instances of plugins, found by name. */
#include "scene/build.h"

#include <stdlib.h>
#include <string.h>

static int by_name(const void *a, const void *b)
{
    const struct mcr_named_material *p = a, *q = b;
    int order = strcmp(p->name, q->name);
    return order ? order : (p->number > q->number) - (p->number < q->number);
}

static void sort_names(struct mcr_build *build)
{
    const struct mcr_scene *scene = build->scene;
    uint32_t n = scene->material_count;
    for (uint32_t i = 0; i < n; i++)
        build->sorted[i] = (struct mcr_named_material){ scene->material[i].name, i };
    qsort(build->sorted, n, sizeof *build->sorted, by_name);
    for (uint32_t i = 0, first = 0; i < n; i++) {
        const struct mcr_scene_material *one = &scene->material[build->sorted[i].number],
            *other = &scene->material[build->sorted[first].number];
        build->names[i] = one->name;
        if (i == first || strcmp(one->name, other->name) != 0) {
            first = i;
            continue;
        }
        mcr_error(build, one->place, "a material '%s' exists already", one->name);
        mcr_report(build->diagnostics, MCR_NOTE, other->place, "the first one is here");
    }
}

enum { NOT_MADE, BEING_MADE, MADE };

/* ---- Names in materials ---- */

static int find_texture(void *data, const struct mcr_value *value, uint32_t type, struct mcr_varying *out)
{
    struct mcr_build *build = data;
    const struct mcr_texture_bounds *bounds;
    if (!mcr_build_is_texture(build, value->text))
        return 0;
    out->texture = mcr_build_find_texture(build, value);
    bounds = mcr_texture_bounds(out->texture);
    for (int c = 0; c < 3; c++) {
        out->min[c] = bounds->min[c];
        out->max[c] = bounds->max[c];
        out->mean[c] = bounds->mean[c];
    }
    if (type == MCR_TYPE_COLOUR)
        return 1;
    out->min[0] = mcr_texture_number(bounds->min[0], bounds->min[1], bounds->min[2]);
    out->max[0] = mcr_texture_number(bounds->max[0], bounds->max[1], bounds->max[2]);
    out->mean[0] = mcr_texture_number(bounds->mean[0], bounds->mean[1], bounds->mean[2]);
    return 1;
}

static const char *near_texture(void *data, const char *name)
{
    const struct mcr_build *build = data;
    return mcr_nearest_word(name, build->texture_names, build->scene->texture_count);
}

/* The number of the material that a value names; -1 after an error. */
static int64_t find(struct mcr_build *build, const struct mcr_value *value)
{
    const struct mcr_scene *scene = build->scene;
    uint32_t low = 0, high = scene->material_count;
    const char *nearest;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (strcmp(build->names[middle], value->text) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    if (low < scene->material_count && strcmp(build->names[low], value->text) == 0) {
        build->used[build->sorted[low].number] = 1;
        return build->sorted[low].number;
    }
    mcr_error(build, value->place, "there is no material '%s'", value->text);
    nearest = mcr_nearest_word(value->text, build->names, scene->material_count);
    if (nearest)
        mcr_report(build->diagnostics, MCR_NOTE, value->place, "did you mean '%s'?", nearest);
    return -1;
}

static void make(struct mcr_build *build, uint32_t number);

static uint32_t tree_depth(const struct mcr_node *node)
{
    uint32_t most = 0;
    for (uint32_t k = 0; k < node->child_count; k++) {
        uint32_t depth = tree_depth(node->child[k]);
        most = depth > most ? depth : most;
    }
    return most + 1;
}

/* A material inside another, made first. */
static struct mcr_node *find_child(void *data, const struct mcr_value *value)
{
    struct mcr_build *build = data;
    int64_t number = find(build, value);
    struct mcr_scene_material *child;
    if (number < 0)
        return NULL;
    child = &build->scene->material[number];
    if (build->material_state[number] == BEING_MADE) {
        mcr_error(build, value->place, "material '%s' is inside itself", child->name);
        mcr_report(build->diagnostics, MCR_NOTE, child->place, "it begins here");
        return NULL;
    }
    /* What is made already may be deep, what is made now may get deep. */
    if (build->material_state[number] == NOT_MADE && build->material_depth < MCR_MAX_TREE_DEPTH)
        make(build, (uint32_t)number);
    if (build->material_state[number] == NOT_MADE || (child->node && build->material_depth + tree_depth(child->node) > MCR_MAX_TREE_DEPTH)) {
        mcr_error(build, value->place, "materials are inside each other more than %u deep", MCR_MAX_TREE_DEPTH);
        return NULL;
    }
    if (child->node && (child->surface.normal_map || child->surface.bump)) {
        mcr_error(build, value->place, "material '%s' has a %s, which has no effect inside another: give it to the outermost one", child->name,
                  child->surface.normal_map ? "normal map" : "bump");
        return NULL;
    }
    return child->node;
}

/* ---- What every material takes ---- */

static int is_own(const struct mcr_descriptor *descriptor, const char *word)
{
    for (uint32_t k = 0; k < descriptor->parameter_count; k++)
        if (strcmp(mcr_descriptor_parameter(descriptor, k)->name, word) == 0)
            return 1;
    return 0;
}

/*
 * Takes out of the block the settings that the host handles; a plugin's own parameter of the same name goes before. `rest` is the block without them.
 * Returns 0, or -1 when memory is short; mistakes are recorded.
 */
static int split(struct mcr_build *build, const struct mcr_item *block, const struct mcr_descriptor *descriptor, struct mcr_item *rest,
                 struct mcr_settings *settings)
{
    struct mcr_item *item = mcr_build_alloc(build, block->count, sizeof *item);
    memset(settings, 0, sizeof *settings);
    settings->word = mcr_scene_block("material", NULL);
    settings->of = descriptor->name;
    settings->place = block->place;
    if (!item)
        return -1;
    *rest = *block;
    rest->item = item;
    rest->count = 0;
    for (uint32_t i = 0; i < block->count; i++) {
        const struct mcr_item *one = &block->item[i];
        uint32_t k = 0;
        while (k < SURFACE_COUNT && strcmp(settings->word->setting[k].name, one->word) != 0)
            k++;
        if (k == SURFACE_COUNT || one->is_block || is_own(descriptor, one->word)) {
            item[rest->count++] = *one;
        } else if (settings->value[k]) {
            mcr_error(build, one->place, "'%s' of '%s' is given twice, expected once", one->word, descriptor->name);
            mcr_report(build->diagnostics, MCR_NOTE, settings->key[k], "the first one is here");
        } else {
            settings->value[k] = &one->value;
            settings->key[k] = one->place;
        }
    }
    return 0;
}

/* The texture that a setting names; NULL if it is not given, or after an error. */
static const struct mcr_texture *read_texture(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index)
{
    const struct mcr_value *value = settings->value[index];
    if (!value || mcr_value_resolve(value)->kind == MCR_VALUE_ERROR)
        return NULL;
    if (mcr_value_resolve(value)->kind == MCR_VALUE_NAME)
        return mcr_build_find_texture(build, mcr_value_resolve(value));
    mcr_wrong_kind(build, value, settings->word->setting[index].name, settings->of, mcr_word_form(MCR_WORD_TEXTURE));
    return NULL;
}

static void read_emission(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_surface_settings *surface)
{
    const struct mcr_value *value = settings->value[SURFACE_EMISSION], *what = value ? mcr_value_resolve(value) : NULL;
    double sides = 0;
    if (what && what->kind == MCR_VALUE_NAME) {
        const struct mcr_texture_bounds *bounds;
        surface->emission_texture = mcr_build_find_texture(build, what);
        bounds = surface->emission_texture ? mcr_texture_bounds(surface->emission_texture) : NULL;
        for (int c = 0; c < 3 && bounds; c++)
            surface->emission[c] = bounds->mean[c];
        for (int c = 0; c < 3 && bounds; c++)
            if (!(bounds->min[c] >= 0)) {
                mcr_error(build, value->place, "texture '%s' for 'emission' of '%s' goes down to %.10g, expected at least 0", what->text, settings->of,
                          bounds->min[c]);
                break;
            }
    } else {
        mcr_read_colour(build, settings, SURFACE_EMISSION, surface->emission);
    }
    mcr_read_number(build, settings, SURFACE_EMISSION_SIDES, &sides);
    if (surface->emission[0] > 0 || surface->emission[1] > 0 || surface->emission[2] > 0)
        surface->emits = MCR_MATERIAL_EMITS_FRONT | (sides > 0 ? MCR_MATERIAL_EMITS_BACK : 0);
}

/* Records a setting that is there without the one that it belongs to. */
static void check_beside(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, uint32_t beside)
{
    if (settings->value[index] && !settings->value[beside])
        mcr_error(build, settings->key[index], "'%s' of '%s' has no effect without '%s'", settings->word->setting[index].name, settings->of,
                  settings->word->setting[beside].name);
}

/* Normals that lean far on the whole are mostly data that was taken for colours: the code for "flat" then decodes to a lean of 39 degrees. */
static void check_lean(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_texture *map)
{
    const struct mcr_value *value = settings->value[SURFACE_NORMAL_MAP];
    const double *mean;
    double x, y, z;
    if (!map)
        return;
    mean = mcr_texture_bounds(map)->mean;
    x = 2 * mean[0] - 1;
    y = 2 * mean[1] - 1;
    z = 2 * mean[2] - 1;
    if (z <= 0 || x * x + y * y > z * z / 3)
        mcr_report(build->diagnostics, MCR_WARNING, value->place,
                   "the normals of texture '%s' lean by more than 30 degrees in the mean: a picture of normals is data, with 'colour linear'",
                   mcr_value_resolve(value)->text);
}

static void read_surface(struct mcr_build *build, const struct mcr_settings *settings, int damaged, struct mcr_scene_material *material)
{
    struct mcr_surface_settings *surface = &material->surface;
    read_emission(build, settings, surface);
    surface->normal_map = read_texture(build, settings, SURFACE_NORMAL_MAP);
    check_lean(build, settings, surface->normal_map);
    surface->bump = read_texture(build, settings, SURFACE_BUMP);
    mcr_read_number(build, settings, SURFACE_NORMAL_STRENGTH, &surface->normal_strength);
    mcr_read_number(build, settings, SURFACE_BUMP_HEIGHT, &surface->bump_height);
    check_beside(build, settings, SURFACE_EMISSION_SIDES, SURFACE_EMISSION);
    check_beside(build, settings, SURFACE_NORMAL_STRENGTH, SURFACE_NORMAL_MAP);
    check_beside(build, settings, SURFACE_BUMP_HEIGHT, SURFACE_BUMP);
    if (settings->value[SURFACE_BUMP] && !settings->value[SURFACE_BUMP_HEIGHT] && !damaged)
        mcr_error(build, settings->key[SURFACE_BUMP], "'bump' of '%s' needs 'bump_height' beside it", settings->of);
    if (surface->emission_texture)
        material->needs |= MCR_NEEDS_COORDINATES;
    if (surface->bump)
        material->needs |= MCR_NEEDS_COORDINATES | MCR_NEEDS_NORMALS;
    if (surface->normal_map)
        material->needs |= MCR_NEEDS_COORDINATES | MCR_NEEDS_NORMALS | MCR_NEEDS_TANGENTS;
}

/* ---- Blocks ---- */

/* What the instance asks of points, and what the host adds to what it does. */
static void finish(struct mcr_build *build, struct mcr_scene_material *material)
{
    struct mcr_node *node = material->node;
    struct mcr_material_traits *traits = &material->traits;
    const struct mcr_material_plugin *plugin = (const struct mcr_material_plugin *)(const void *)node->descriptor;
    node->number = (uint32_t)(material - build->scene->material);
    mcr_material_traits(node, build->diagnostics, traits);
    traits->does |= material->surface.emits;
    for (int c = 0; c < 3 && material->surface.emits; c++)
        traits->radiance[c] += material->surface.emission[c];
    node->traits = traits;
    if (node->texture)
        material->needs |= MCR_NEEDS_COORDINATES;
    if (plugin->flags & MCR_MATERIAL_TANGENTS || traits->does & MCR_MATERIAL_LEANS)
        material->needs |= MCR_NEEDS_TANGENTS;
    for (uint32_t k = 0; k < node->child_count; k++)
        material->needs |= build->scene->material[node->child[k]->number].needs;
    build->needs |= material->needs;
}

static void make(struct mcr_build *build, uint32_t number)
{
    const char *word[SURFACE_COUNT];
    const struct mcr_item *block = build->material_block[number];
    struct mcr_scene_material *material = &build->scene->material[number];
    const struct mcr_descriptor *descriptor;
    struct mcr_settings settings;
    struct mcr_item rest;
    for (uint32_t k = 0; k < SURFACE_COUNT; k++)
        word[k] = mcr_scene_block("material", NULL)->setting[k].name;
    build->material_state[number] = BEING_MADE;
    build->material_depth++;
    material->traits.size = sizeof material->traits;
    if (!block->name || !block->kind) {
        mcr_error(build, block->place, "'material' needs its %s, expected material NAME KIND { ... }",
                  block->name ? "kind" : "name and kind");
    } else if ((descriptor = mcr_registry_find(build->registry, MCR_KIND_MASK(MCR_KIND_MATERIAL), block->kind, block->kind_place, NULL)) &&
               split(build, block, descriptor, &rest, &settings) == 0) {
        struct mcr_value_names names = { build, word, SURFACE_COUNT, find_texture, near_texture, find_child };
        read_surface(build, &settings, block->damaged, material);
        material->node = mcr_material_create_with(build->arena, build->diagnostics, build->registry, &rest, &names);
        if (material->node)
            finish(build, material);
    }
    build->material_depth--;
    build->material_state[number] = MADE;
}

void mcr_build_materials(struct mcr_build *build, const struct mcr_item *root)
{
    struct mcr_scene *scene = build->scene;
    uint32_t n = 0;
    for (uint32_t i = 0; i < root->count; i++)
        n += root->item[i].is_block && strcmp(root->item[i].word, "material") == 0;
    scene->material = mcr_build_alloc(build, n, sizeof *scene->material);
    build->sorted = mcr_build_alloc(build, n, sizeof *build->sorted);
    build->names = mcr_build_alloc(build, n, sizeof *build->names);
    build->used = mcr_build_alloc(build, n, sizeof *build->used);
    build->material_block = mcr_build_alloc(build, n, sizeof *build->material_block);
    build->material_state = mcr_build_alloc(build, n, sizeof *build->material_state);
    if (build->short_of_memory)
        return;
    for (uint32_t i = 0; i < root->count; i++) {
        const struct mcr_item *block = &root->item[i];
        if (!block->is_block || strcmp(block->word, "material") != 0)
            continue;
        scene->material[scene->material_count].name = block->name ? block->name : "";
        scene->material[scene->material_count].place = block->name ? block->name_place : block->place;
        build->material_block[scene->material_count++] = block;
    }
    sort_names(build);
    for (uint32_t i = 0; i < n && !build->short_of_memory; i++)
        if (build->material_state[i] == NOT_MADE)
            make(build, i);
}

int64_t mcr_build_find_material(struct mcr_build *build, const struct mcr_settings *settings)
{
    const struct mcr_value *value = settings->value[SHAPE_MATERIAL];
    if (!value)
        return -1; /* told as missing */
    if (value->kind != MCR_VALUE_NAME)
        return mcr_wrong_kind(build, value, "material", settings->of, mcr_word_form(MCR_WORD_MATERIAL));
    return find(build, value);
}

void mcr_build_unused_materials(struct mcr_build *build)
{
    /* What was wrong may have used it. */
    if (mcr_diagnostics_errors(build->diagnostics) > 0)
        return;
    for (uint32_t i = 0; i < build->scene->material_count; i++)
        if (!build->used[i])
            mcr_report(build->diagnostics, MCR_WARNING, build->scene->material[i].place, "material '%s' is not used",
                       build->scene->material[i].name);
}
