/* SPDX-License-Identifier: Apache-2.0 */
/* Sampler expressions: a tree of calls becomes a chain of number sources and a tree of direction nodes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plugin/create.h"
#include "plugin/node.h"

#define MOST_NODES 256u      /* of one expression: 16 children at each of 8 levels would be too many by far */
#define MOST_DIMENSIONS 16u  /* numbers of one bounce for all techniques, DESIGN: 0-15 */

struct builder {
    struct mcr_arena *arena;
    struct mcr_diagnostics *diagnostics;
    struct mcr_registry *registry;
    uint32_t planned, nodes;
    int has_lights;
    const struct mcr_quirks *quirks;
    uint32_t taken; /* bits: quirks that a node has */
};

static struct mcr_node *build(struct builder *builder, const struct mcr_value *value, uint32_t depth, const struct mcr_descriptor *parent);

/* The weight behind a child. Returns 0, or -1 after an error. */
static int read_weight(struct builder *builder, const struct mcr_argument *argument, const struct mcr_descriptor *parent, double *weight)
{
    const struct mcr_value *value = mcr_value_resolve(&argument->weight);

    *weight = 1;
    if (!argument->has_weight)
        return 0;
    if (value->kind == MCR_VALUE_NUMBER && isfinite(value->number) && value->number >= 0 && parent->kind == MCR_KIND_DIRECTIONS) {
        *weight = value->number + 0.0;
        return 0;
    }
    if (value->kind == MCR_VALUE_NUMBER && parent->kind != MCR_KIND_DIRECTIONS)
        mcr_report(builder->diagnostics, MCR_ERROR, argument->weight.place, "the sampler inside '%s' has a weight, expected none",
                   parent->name);
    else if (value->kind == MCR_VALUE_NUMBER)
        mcr_report(builder->diagnostics, MCR_ERROR, argument->weight.place, "this weight is %.10g, expected at least 0", value->number);
    else if (value->kind != MCR_VALUE_ERROR)
        mcr_report(builder->diagnostics, MCR_ERROR, argument->weight.place, "this weight is %s, expected a number",
                   mcr_value_kind_name(value));
    return -1;
}

/* The arguments that are children, built; those that are settings go to `setting`. Returns 0, or -1 after errors; then no child is left. */
static int read_arguments(struct builder *builder, const struct mcr_value *value, uint32_t depth, struct mcr_node *node,
                          struct mcr_setting *setting, uint32_t *settings)
{
    uint32_t children = 0;
    int wrong = 0;

    for (uint32_t k = 0; value->kind == MCR_VALUE_CALL && k < value->count; k++) {
        const struct mcr_argument *argument = &value->argument[k];
        struct mcr_node *child;

        if (argument->name) {
            setting[(*settings)++] = (struct mcr_setting){argument->name, argument->name_place, &argument->value};
            continue;
        }
        if (++children > MCR_MAX_CHILDREN) {
            if (children == MCR_MAX_CHILDREN + 1)
                mcr_report(builder->diagnostics, MCR_ERROR, argument->value.place,
                           "'%s' has more than %u samplers inside it, expected at most %u", node->descriptor->name, MCR_MAX_CHILDREN,
                           MCR_MAX_CHILDREN);
            wrong = 1;
            continue;
        }
        child = build(builder, &argument->value, depth + 1, node->descriptor);
        wrong |= !child;
        wrong |= read_weight(builder, argument, node->descriptor, &node->weight[node->child_count]) != 0;
        if (child)
            node->child[node->child_count++] = child;
    }
    if (node->descriptor->kind == MCR_KIND_NUMBERS && children != 1) {
        mcr_report(builder->diagnostics, MCR_ERROR, node->place,
                   "'%s' supplies numbers and has %u samplers inside it, expected one, as in %s(cosine)", node->descriptor->name, children,
                   node->descriptor->name);
        wrong = 1;
    }
    return wrong ? -1 : 0;
}

/* ---- the parameter `compat` ---- */

/* The place of the choice `compat` in a plugin's table, or parameter_count. */
static uint32_t find_compat(const struct mcr_descriptor *descriptor)
{
    uint32_t k = 0;

    while (k < descriptor->parameter_count && (mcr_descriptor_parameter(descriptor, k)->type != MCR_TYPE_CHOICE ||
                                               strcmp(mcr_descriptor_parameter(descriptor, k)->name, "compat") != 0))
        k++;
    return k;
}

/* Has a node's `compat` set to the last of its words that is wanted, unless the expression set it. `value` must live as long as the settings. */
static void want_quirk(const struct builder *builder, const struct mcr_node *node, struct mcr_setting *setting, uint32_t *settings,
                       struct mcr_value *value)
{
    uint32_t k = find_compat(node->descriptor);
    char word[MCR_MAX_WORD + 1];
    const char *choices;

    if (k == node->descriptor->parameter_count)
        return;
    for (uint32_t s = 0; s < *settings; s++)
        if (!strcmp(setting[s].name, "compat"))
            return;
    choices = mcr_descriptor_parameter(node->descriptor, k)->choices;
    *value = (struct mcr_value){.kind = MCR_VALUE_NAME, .place = node->place};
    for (uint32_t c = 0; c < mcr_choice_count(choices); c++) {
        mcr_choice_word(choices, c, word);
        for (uint32_t q = 0; q < builder->quirks->count; q++)
            if (builder->quirks->wanted & 1u << q && !strcmp(builder->quirks->name[q], word))
                value->text = builder->quirks->name[q];
    }
    if (value->text)
        setting[(*settings)++] = (struct mcr_setting){"compat", node->place, value};
}

/* Notes the quirk that a node has. */
static void take_quirk(struct builder *builder, const struct mcr_node *node)
{
    uint32_t k = find_compat(node->descriptor);
    char word[MCR_MAX_WORD + 1];

    if (k == node->descriptor->parameter_count)
        return;
    mcr_choice_word(mcr_descriptor_parameter(node->descriptor, k)->choices, (uint32_t)node->values.number[3 * k], word);
    for (uint32_t q = 0; q < builder->quirks->count; q++)
        if (!strcmp(builder->quirks->name[q], word))
            builder->taken |= 1u << q;
}

/* The descriptor of a node's word, where its kind may stand. NULL after an error. */
static const struct mcr_descriptor *find_word(struct builder *builder, const struct mcr_value *value, uint32_t depth,
                                              const struct mcr_descriptor *parent, const char **path)
{
    const uint32_t mask = MCR_KIND_MASK(MCR_KIND_DIRECTIONS) | MCR_KIND_MASK(MCR_KIND_NUMBERS);
    const struct mcr_descriptor *descriptor;

    if (value->kind == MCR_VALUE_ERROR)
        return NULL;
    if (value->kind != MCR_VALUE_NAME && value->kind != MCR_VALUE_CALL) {
        mcr_report(builder->diagnostics, MCR_ERROR, value->place, "this is %s, expected a sampler, as in mixture(cosine 1, light 1)",
                   mcr_value_kind_name(value));
        return NULL;
    }
    if (depth > MCR_MAX_TREE_DEPTH || builder->nodes >= MOST_NODES) {
        if (depth > MCR_MAX_TREE_DEPTH)
            mcr_report(builder->diagnostics, MCR_ERROR, value->place, "samplers are nested too deeply, expected at most %u levels",
                       MCR_MAX_TREE_DEPTH);
        else if (builder->nodes++ == MOST_NODES)
            mcr_report(builder->diagnostics, MCR_ERROR, value->place, "too many samplers in one expression, expected at most %u", MOST_NODES);
        return NULL;
    }
    builder->nodes++;
    descriptor = mcr_registry_find(builder->registry, mask, value->text, value->place, path);
    if (descriptor && parent && parent->kind == MCR_KIND_DIRECTIONS && descriptor->kind == MCR_KIND_NUMBERS) {
        mcr_report(builder->diagnostics, MCR_ERROR, value->place,
                   "'%s' supplies numbers and stands outside of all directions, as in %s(%s(...))", value->text, value->text, parent->name);
        return NULL;
    }
    return descriptor;
}

static struct mcr_node *build(struct builder *builder, const struct mcr_value *value, uint32_t depth, const struct mcr_descriptor *parent)
{
    const char *path = NULL;
    const struct mcr_descriptor *descriptor = find_word(builder, value, depth, parent, &path);
    struct mcr_setting *setting;
    struct mcr_node *node;
    struct mcr_value quirk;
    uint32_t settings = 0;
    int wrong;

    if (!descriptor)
        return NULL;
    node = mcr_arena_alloc(builder->arena, 1, sizeof *node);
    setting = mcr_arena_alloc(builder->arena, (value->kind == MCR_VALUE_CALL ? (uint64_t)value->count : 0) + 1, sizeof *setting);
    if (!node || !setting) {
        mcr_report(builder->diagnostics, MCR_ERROR, value->place, "out of memory");
        return NULL;
    }
    node->descriptor = descriptor;
    node->path = path;
    node->place = value->place;
    wrong = read_arguments(builder, value, depth, node, setting, &settings);
    want_quirk(builder, node, setting, &settings, &quirk);
    wrong |= mcr_values_read(builder->arena, builder->diagnostics, descriptor, setting, settings, value->place, 0, &node->values);
    if (!wrong && mcr_node_instantiate(node, builder->diagnostics, builder->planned, builder->has_lights) == 0) {
        if (descriptor->kind != MCR_KIND_DIRECTIONS || mcr_node_techniques(node, builder->diagnostics, builder->has_lights) == 0) {
            take_quirk(builder, node);
            return node;
        }
        mcr_node_destroy(node, 1);
        return NULL;
    }
    for (uint32_t k = 0; k < node->child_count; k++)
        mcr_node_destroy(node->child[k], 1);
    return NULL;
}

/* ---- the whole ---- */

static int check_root(struct mcr_diagnostics *diagnostics, const struct mcr_node *root)
{
    uint32_t continuing = 0;
    uint64_t dimensions = 0;

    for (uint32_t t = 0; t < root->technique_count; t++) {
        continuing += root->technique[t].continues;
        dimensions += root->technique[t].dimensions;
    }
    if (continuing != 1)
        mcr_report(diagnostics, MCR_ERROR, root->place, "no technique of '%s' continues the path, expected one that draws directions",
                   root->descriptor->name);
    if (dimensions > MOST_DIMENSIONS)
        mcr_report(diagnostics, MCR_ERROR, root->place, "this sampler takes %llu numbers at each bounce, expected at most %u",
                   (unsigned long long)dimensions, MOST_DIMENSIONS);
    return continuing == 1 && dimensions <= MOST_DIMENSIONS ? 0 : -1;
}

/* The groups in which numbers are asked for: pixel, lens; in a bounce sampler nodes, light, material, roulette (sampler.h). */
static const struct {
    uint32_t first, count;
} group[] = {{0, 2}, {2, 2}, {8, 16}, {24, 4}, {28, 4}, {32, 1}};

/*
 * Cuts the tree into sources and directions. The sampler is correlated if a source is that supplies anything: what an outer
 * source supplies is not asked of an inner one. Returns 0, or -1 after an error.
 */
static int split(struct mcr_diagnostics *diagnostics, struct mcr_sampler *sampler, struct mcr_node *root)
{
    uint32_t done[sizeof group / sizeof *group] = {0};

    for (; root->descriptor->kind == MCR_KIND_NUMBERS; root = root->child[0]) {
        const struct mcr_numbers_plugin *plugin = (const struct mcr_numbers_plugin *)root->descriptor;
        uint32_t supplied = 0;

        sampler->source[sampler->source_count++] = root;
        for (uint32_t g = 0; g < sizeof group / sizeof *group; g++) {
            uint32_t left = group[g].count - done[g], count = left ? plugin->supplies(root->instance, group[g].first + done[g], left) : 0;

            if (count > left) {
                mcr_report(diagnostics, MCR_ERROR, root->place, "'%s' would supply %u numbers of %u: a mistake in the plugin",
                           plugin->head.name, count, left);
                return -1;
            }
            done[g] += count;
            supplied |= count;
        }
        if (supplied && plugin->correlated(root->instance))
            sampler->correlated = 1;
        if (supplied && plugin->needs)
            sampler->needs |= plugin->needs(root->instance);
    }
    sampler->directions = root;
    return 0;
}

/* The source that ends every chain. NULL after an error. */
static struct mcr_node *build_independent(struct builder *builder, struct mcr_place place)
{
    const struct mcr_descriptor *descriptor;
    const char *path = NULL;
    struct mcr_node *node = mcr_arena_alloc(builder->arena, 1, sizeof *node);

    if (!node) {
        mcr_report(builder->diagnostics, MCR_ERROR, place, "out of memory");
        return NULL;
    }
    descriptor = mcr_registry_find(builder->registry, MCR_KIND_MASK(MCR_KIND_NUMBERS), "independent", place, &path);
    if (!descriptor)
        return NULL;
    node->descriptor = descriptor;
    node->path = path;
    node->place = place;
    if (mcr_values_read(builder->arena, builder->diagnostics, descriptor, NULL, 0, place, 0, &node->values) ||
        mcr_node_instantiate(node, builder->diagnostics, builder->planned, builder->has_lights))
        return NULL;
    return node;
}

struct mcr_sampler *mcr_sampler_create(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, struct mcr_registry *registry,
                                       const struct mcr_value *expression, uint32_t planned, int has_lights)
{
    static const struct mcr_quirks none;

    return mcr_sampler_create_with(arena, diagnostics, registry, expression, planned, has_lights, &none);
}

struct mcr_sampler *mcr_sampler_create_with(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, struct mcr_registry *registry,
                                            const struct mcr_value *expression, uint32_t planned, int has_lights, const struct mcr_quirks *quirks)
{
    struct builder builder = {arena, diagnostics, registry, planned, 0, has_lights, quirks, 0};
    struct mcr_sampler *sampler = mcr_arena_alloc(arena, 1, sizeof *sampler);
    struct mcr_node *root = build(&builder, expression, 1, NULL);

    if (!root)
        return NULL;
    if (!sampler || !(sampler->expression = mcr_node_expression(arena, root))) {
        mcr_report(diagnostics, MCR_ERROR, expression->place, "out of memory");
        mcr_node_destroy(root, 1);
        return NULL;
    }
    if (split(diagnostics, sampler, root) || check_root(diagnostics, sampler->directions) ||
        !(sampler->independent = build_independent(&builder, expression->place))) {
        mcr_node_destroy(root, 1);
        return NULL;
    }
    sampler->quirks = builder.taken;
    return sampler;
}

void mcr_sampler_destroy(struct mcr_sampler *sampler)
{
    if (!sampler)
        return;
    mcr_node_destroy(sampler->source_count ? sampler->source[0] : sampler->directions, 1);
    mcr_node_destroy(sampler->independent, 0);
}

/* ---- normal form ---- */

static int is_default(const struct mcr_parameter *parameter, const double *number)
{
    if (parameter->flags & MCR_PARAMETER_REQUIRED)
        return 0;
    return number[0] == parameter->fallback[0] &&
           (parameter->type != MCR_TYPE_COLOUR || (number[1] == parameter->fallback[1] && number[2] == parameter->fallback[2]));
}

static void print_node(FILE *to, const struct mcr_node *node)
{
    const char *separator = "(";
    char text[128];

    fputs(node->descriptor->name, to);
    for (uint32_t k = 0; k < node->values.count; k++) {
        const struct mcr_parameter *parameter = mcr_descriptor_parameter(node->descriptor, k);

        if (is_default(parameter, node->values.number + 3 * k))
            continue;
        mcr_value_text(parameter, node->values.number + 3 * k, text, sizeof text);
        fprintf(to, "%s%s=%s", separator, parameter->name, text);
        separator = ", ";
    }
    for (uint32_t k = 0; k < node->child_count; k++) {
        fputs(separator, to);
        print_node(to, node->child[k]);
        if (node->descriptor->kind == MCR_KIND_DIRECTIONS) {
            *text = 0;
            mcr_text_number(text, sizeof text, node->weight[k]);
            fprintf(to, " %s", text);
        }
        separator = ", ";
    }
    if (*separator == ',')
        fputc(')', to);
}

const char *mcr_node_expression(struct mcr_arena *arena, const struct mcr_node *root)
{
    char *text = NULL, *copy = NULL;
    size_t length = 0;
    FILE *memory = open_memstream(&text, &length);

    if (!memory)
        return NULL;
    print_node(memory, root);
    if (fclose(memory) == 0)
        copy = mcr_arena_text(arena, text, length);
    free(text);
    return copy;
}
