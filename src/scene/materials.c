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

static void create(struct mcr_build *build, const struct mcr_item *block, struct mcr_scene_material *material)
{
    material->name = block->name ? block->name : "";
    material->place = block->name ? block->name_place : block->place;
    material->traits.size = sizeof material->traits;
    if (!block->name || !block->kind) {
        mcr_error(build, block->place, "'material' needs its %s, expected material NAME KIND { ... }",
                  block->name ? "kind" : "name and kind");
        return;
    }
    material->node = mcr_material_create(build->arena, build->diagnostics, build->registry, block);
    if (!material->node)
        return;
    mcr_material_traits(material->node, build->diagnostics, &material->traits);
    if (((const struct mcr_material_plugin *)(const void *)material->node->descriptor)->flags & MCR_MATERIAL_TANGENTS)
        material->needs |= MCR_NEEDS_TANGENTS;
    build->needs |= material->needs;
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
    if (build->short_of_memory)
        return;
    for (uint32_t i = 0; i < root->count; i++)
        if (root->item[i].is_block && strcmp(root->item[i].word, "material") == 0)
            create(build, &root->item[i], &scene->material[scene->material_count++]);
    sort_names(build);
}

int64_t mcr_build_find_material(struct mcr_build *build, const struct mcr_settings *settings)
{
    const struct mcr_scene *scene = build->scene;
    const struct mcr_value *value = settings->value[SHAPE_MATERIAL];
    uint32_t low = 0, high = scene->material_count;
    const char *nearest;
    if (!value)
        return -1; /* told as missing */
    if (value->kind != MCR_VALUE_NAME)
        return mcr_wrong_kind(build, value, "material", settings->of, mcr_word_form(MCR_WORD_MATERIAL));
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
