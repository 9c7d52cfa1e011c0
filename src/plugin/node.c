/* SPDX-License-Identifier: Apache-2.0 */
#include "plugin/node.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plugin/create.h"

#define ALL_COVERS (MCR_COVERS_REFLECTION | MCR_COVERS_TRANSMISSION | MCR_COVERS_EMITTERS)
#define ALL_DOES (MCR_MATERIAL_REFLECTS | MCR_MATERIAL_TRANSMITS | MCR_MATERIAL_DELTA | MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK | \
                  MCR_MATERIAL_INTERIOR | MCR_MATERIAL_PASSES | MCR_MATERIAL_LEANS | MCR_MATERIAL_THIN)

static const char *status_name(int32_t status)
{
    switch (status) {
    case MCR_E_INVALID: return "its parameters cannot work together";
    case MCR_E_NOMEM: return "out of memory";
    case MCR_E_UNSUPPORTED: return "it needs a service that this program lacks";
    case MCR_E_INTERNAL: return "internal error";
    default: return "it returned a status that does not exist";
    }
}

void mcr_node_failed(const struct mcr_node *node, struct mcr_diagnostics *diagnostics, const char *operation, int32_t status)
{
    mcr_report(diagnostics, MCR_ERROR, node->place, "'%s' failed in '%s': %s", node->descriptor->name, operation, status_name(status));
}

int mcr_node_instantiate(struct mcr_node *node, struct mcr_diagnostics *diagnostics, uint32_t planned, int has_lights)
{
    struct mcr_context context = {.node = node, .diagnostics = diagnostics, .has_lights = has_lights != 0};
    struct mcr_creation with = {.size = sizeof with,
                                .child_count = node->child_count,
                                .values = &node->values,
                                .child = (const struct mcr_child *const *)node->child,
                                .weight = node->weight,
                                .spp = planned};
    uint32_t errors = mcr_diagnostics_errors(diagnostics);
    const struct mcr_host *host = mcr_creation_host();
    int32_t status;

    switch (node->descriptor->kind) {
    case MCR_KIND_DIRECTIONS:
        status = ((const struct mcr_directions_plugin *)node->descriptor)->create(host, &context, &with, &node->instance);
        break;
    case MCR_KIND_NUMBERS:
        status = ((const struct mcr_numbers_plugin *)node->descriptor)->create(host, &context, &with, &node->instance);
        break;
    default:
        status = ((const struct mcr_material_plugin *)node->descriptor)->create(host, &context, &with, &node->instance);
    }
    if (status == MCR_OK && mcr_diagnostics_errors(diagnostics) == errors)
        return 0;
    if (status == MCR_OK) /* it told of an error and went on: it made an instance */
        mcr_node_destroy(node, 0);
    else if (mcr_diagnostics_errors(diagnostics) == errors)
        mcr_node_failed(node, diagnostics, "create", status);
    return -1;
}

void mcr_node_destroy(struct mcr_node *node, int children)
{
    void (*destroy)(void *);

    if (!node)
        return;
    switch (node->descriptor->kind) {
    case MCR_KIND_DIRECTIONS: destroy = ((const struct mcr_directions_plugin *)node->descriptor)->destroy; break;
    case MCR_KIND_NUMBERS: destroy = ((const struct mcr_numbers_plugin *)node->descriptor)->destroy; break;
    default: destroy = ((const struct mcr_material_plugin *)node->descriptor)->destroy;
    }
    if (destroy)
        destroy(node->instance);
    for (uint32_t k = 0; children && k < node->child_count; k++)
        mcr_node_destroy(node->child[k], 1);
}

/* What is wrong with a technique as told, or NULL. */
static const char *technique_mistake(const struct mcr_directions_plugin *plugin, const struct mcr_technique *technique)
{
    if (technique->kind != MCR_TECHNIQUE_DIRECTION && technique->kind != MCR_TECHNIQUE_EMITTER)
        return "is of an unknown kind";
    if (technique->kind == MCR_TECHNIQUE_DIRECTION && !plugin->draw)
        return "draws directions, but the plugin has no operation draw";
    if (technique->kind == MCR_TECHNIQUE_EMITTER && !plugin->draw_emitter)
        return "draws points on emitters, but the plugin has no operation draw_emitter";
    if (technique->continues > 1 || (technique->continues && technique->kind != MCR_TECHNIQUE_DIRECTION))
        return "continues the path without drawing directions";
    if (technique->flags & ~MCR_TECHNIQUE_CONTROL || (technique->flags && technique->kind != MCR_TECHNIQUE_EMITTER))
        return "has flags that are unknown, or not for its kind";
    if (technique->covers & ~ALL_COVERS)
        return "covers something unknown";
    return NULL;
}

int mcr_node_techniques(struct mcr_node *node, struct mcr_diagnostics *diagnostics, int has_lights)
{
    const struct mcr_directions_plugin *plugin = (const struct mcr_directions_plugin *)node->descriptor;
    struct mcr_context context = {.node = node, .diagnostics = diagnostics, .has_lights = has_lights != 0};
    uint32_t count = MCR_MAX_TECHNIQUES, errors = mcr_diagnostics_errors(diagnostics), continuing = 0;
    int32_t status;

    for (uint32_t t = 0; t < MCR_MAX_TECHNIQUES; t++)
        node->technique[t] = (struct mcr_technique){.size = sizeof node->technique[t]};
    status = plugin->techniques(mcr_creation_host(), &context, node->instance, node->technique, &count);
    if (status != MCR_OK || mcr_diagnostics_errors(diagnostics) != errors) {
        if (mcr_diagnostics_errors(diagnostics) == errors)
            mcr_node_failed(node, diagnostics, "techniques", status);
        return -1;
    }
    if (count == 0 || count > MCR_MAX_TECHNIQUES) {
        mcr_report(diagnostics, MCR_ERROR, node->place, "'%s' tells of %u techniques, expected 1 to %u: a mistake in the plugin",
                   plugin->head.name, count, MCR_MAX_TECHNIQUES);
        return -1;
    }
    for (uint32_t t = 0; t < count; t++) {
        const char *mistake = technique_mistake(plugin, &node->technique[t]);

        if (mistake) {
            mcr_report(diagnostics, MCR_ERROR, node->place, "technique %u of '%s' %s: a mistake in the plugin", t + 1, plugin->head.name,
                       mistake);
            return -1;
        }
        continuing += node->technique[t].continues;
    }
    if (continuing > 1) {
        mcr_report(diagnostics, MCR_ERROR, node->place,
                   "%u techniques of '%s' continue the path, expected at most one: a mistake in the plugin", continuing, plugin->head.name);
        return -1;
    }
    node->technique_count = count;
    return 0;
}

/* ---- materials ---- */

/* The block's content as settings; nested blocks are errors. NULL after an error of memory. */
static struct mcr_setting *read_block(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const struct mcr_item *block,
                                      uint32_t *count, int *wrong)
{
    struct mcr_setting *setting = mcr_arena_alloc(arena, block->count, sizeof *setting);

    *count = 0;
    if (!setting)
        mcr_report(diagnostics, MCR_ERROR, block->place, "out of memory");
    for (uint32_t k = 0; setting && k < block->count; k++) {
        const struct mcr_item *item = &block->item[k];

        if (item->is_block) {
            mcr_report(diagnostics, MCR_ERROR, item->place, "unexpected block '%s' in material '%s', expected settings of '%s'", item->word,
                       block->name ? block->name : "", block->kind);
            *wrong = 1;
        } else {
            setting[(*count)++] = (struct mcr_setting){item->word, item->place, &item->value};
        }
    }
    return setting;
}

struct mcr_node *mcr_material_create(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, struct mcr_registry *registry,
                                     const struct mcr_item *block)
{
    return mcr_material_create_with(arena, diagnostics, registry, block, NULL);
}

struct mcr_node *mcr_material_create_with(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, struct mcr_registry *registry,
                                          const struct mcr_item *block, const struct mcr_value_names *names)
{
    struct mcr_named_values named;
    const struct mcr_descriptor *descriptor;
    struct mcr_setting *setting;
    struct mcr_node *node;
    const char *path = NULL;
    uint32_t count;
    int wrong = 0;

    if (!block->kind) {
        mcr_report(diagnostics, MCR_ERROR, block->name ? block->name_place : block->place,
                   "this material has no kind, expected a name and a kind, as in: material %s lambert { albedo 0.5 }",
                   block->name ? block->name : "white");
        return NULL;
    }
    descriptor = mcr_registry_find(registry, MCR_KIND_MASK(MCR_KIND_MATERIAL), block->kind, block->kind_place, &path);
    if (!descriptor)
        return NULL;
    node = mcr_arena_alloc(arena, 1, sizeof *node);
    setting = read_block(arena, diagnostics, block, &count, &wrong);
    if (!node || !setting)
        return NULL;
    node->descriptor = descriptor;
    node->path = path;
    node->place = block->kind_place;
    wrong |= mcr_values_read_named(arena, diagnostics, descriptor, setting, count, block->kind_place, block->damaged, names, &node->values, &named);
    node->texture = named.texture;
    node->child_count = named.child_count;
    for (uint32_t k = 0; k < named.child_count; k++) {
        node->child[k] = named.child[k];
        node->weight[k] = 1;
    }
    if (wrong || mcr_node_instantiate(node, diagnostics, 0, 0))
        return NULL;
    return node;
}

void mcr_material_destroy(struct mcr_node *material)
{
    mcr_node_destroy(material, 0);
}

/* What is wrong with traits as told, or NULL. */
static const char *traits_mistake(const struct mcr_material_plugin *plugin, const struct mcr_material_traits *traits)
{
    if (traits->does & ~ALL_DOES)
        return "tells of something unknown that it does";
    if (traits->does & (MCR_MATERIAL_REFLECTS | MCR_MATERIAL_TRANSMITS) && !plugin->evaluate)
        return "scatters, but has no operation evaluate";
    if (traits->does & MCR_MATERIAL_DELTA && !plugin->delta)
        return "has delta lobes, but no operation delta";
    if (traits->does & (MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK) && !plugin->emission)
        return "emits, but has no operation emission";
    if (traits->does & MCR_MATERIAL_PASSES && !plugin->passes)
        return "lets light pass, but has no operation passes";
    if (traits->does & MCR_MATERIAL_INTERIOR && (!(traits->index > 0) || !isfinite(traits->index) || !isfinite(traits->priority)))
        return "has an interior whose index of refraction is not above 0, or whose priority is not finite";
    if (traits->does & MCR_MATERIAL_INTERIOR && traits->does & MCR_MATERIAL_THIN)
        return "has an interior and is a thin wall";
    for (int c = 0; c < 3; c++)
        if (traits->does & MCR_MATERIAL_INTERIOR && (!(traits->attenuation[c] >= 0) || !isfinite(traits->attenuation[c])))
            return "tells of an attenuation that is negative or not finite";
    for (int c = 0; c < 3; c++)
        if (!(traits->radiance[c] >= 0) || !isfinite(traits->radiance[c]))
            return "tells of a radiance that is negative or not finite";
    return NULL;
}

int mcr_material_traits(const struct mcr_node *material, struct mcr_diagnostics *diagnostics, struct mcr_material_traits *traits)
{
    const struct mcr_material_plugin *plugin = (const struct mcr_material_plugin *)material->descriptor;
    struct mcr_context context = {.node = material, .diagnostics = diagnostics};
    uint32_t errors = mcr_diagnostics_errors(diagnostics);
    const char *mistake;
    int32_t status;

    *traits = (struct mcr_material_traits){.size = sizeof *traits};
    status = plugin->traits(mcr_creation_host(), &context, material->instance, &material->values, traits);
    if (mcr_diagnostics_errors(diagnostics) != errors)
        return -1;
    if (status != MCR_OK) {
        mcr_node_failed(material, diagnostics, "traits", status);
        return -1;
    }
    mistake = traits_mistake(plugin, traits);
    if (mistake)
        mcr_report(diagnostics, MCR_ERROR, material->place, "'%s' %s: a mistake in the plugin", plugin->head.name, mistake);
    return mistake ? -1 : 0;
}
