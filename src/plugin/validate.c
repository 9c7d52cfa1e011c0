/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A plugin's tables by themselves, before anything in them is used. It is code of the user's choice and runs in this process: this
 * finds honest mistakes, not malice. Sizes are read before what they cover.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "plugin/registry.h"
#include "plugin/values.h"
#include <mcrender/material.h>
#include <mcrender/sampler.h>

#define MOST_DESCRIPTORS 256u
#define MOST_TEXT 1000u /* bytes of a summary, a version, … */

struct check {
    char *why;
    size_t length;
    const struct mcr_descriptor *descriptor; /* in hand, for messages; NULL before there is one */
};

static int __attribute__((format(printf, 2, 3))) fail(struct check *check, const char *format, ...)
{
    va_list arguments;
    int used = 0;

    if (check->length == 0)
        return -1;
    if (check->descriptor)
        used = snprintf(check->why, check->length, "'%s': ", check->descriptor->name);
    if (used < 0 || (size_t)used >= check->length)
        return -1;
    va_start(arguments, format);
    vsnprintf(check->why + used, check->length - (size_t)used, format, arguments);
    va_end(arguments);
    return -1;
}

int mcr_word_valid(const char *word, size_t length)
{
    if (length == 0 || length > MCR_MAX_WORD || word[0] < 'a' || word[0] > 'z')
        return 0;
    for (size_t i = 1; i < length; i++)
        if (!((word[i] >= 'a' && word[i] <= 'z') || (word[i] >= '0' && word[i] <= '9') || word[i] == '_' || word[i] == '-'))
            return 0;
    return 1;
}

/* A line of text that may be shown on a terminal: no control characters, not endless. */
static int printable(const char *text)
{
    size_t length = text ? strnlen(text, MOST_TEXT + 1) : 0;

    if (!text || length > MOST_TEXT)
        return 0;
    for (size_t i = 0; i < length; i++)
        if ((unsigned char)text[i] < 0x20 || text[i] == 0x7f)
            return 0;
    return 1;
}

static int check_choices(struct check *check, const struct mcr_parameter *parameter)
{
    char word[MCR_MAX_WORD + 1], other[MCR_MAX_WORD + 1];
    const char *at = parameter->choices;
    uint32_t count;

    if (!at || strnlen(at, MCR_MAX_CHOICES * (MCR_MAX_WORD + 1)) == MCR_MAX_CHOICES * (MCR_MAX_WORD + 1))
        return fail(check, "parameter '%s' has no choices or too many", parameter->name);
    count = mcr_choice_count(at);
    if (count > MCR_MAX_CHOICES)
        return fail(check, "parameter '%s' has %u choices, at most %u are allowed", parameter->name, count, MCR_MAX_CHOICES);
    for (uint32_t k = 0; k < count; k++, at += strcspn(at, "|") + 1) {
        if (!mcr_word_valid(at, strcspn(at, "|")))
            return fail(check, "choice %u of parameter '%s' is no word", k + 1, parameter->name);
        mcr_choice_word(parameter->choices, k, word);
        for (uint32_t j = 0; j < k; j++) {
            mcr_choice_word(parameter->choices, j, other);
            if (!strcmp(word, other))
                return fail(check, "parameter '%s' has the choice '%s' twice", parameter->name, word);
        }
    }
    if (!(parameter->flags & MCR_PARAMETER_REQUIRED) &&
        !(parameter->fallback[0] >= 0 && parameter->fallback[0] < count && parameter->fallback[0] == floor(parameter->fallback[0])))
        return fail(check, "the default of parameter '%s' is none of its choices", parameter->name);
    return 0;
}

/* Range and default of a number, an integer or a colour. */
static int check_range(struct check *check, const struct mcr_parameter *parameter)
{
    double min = parameter->min, max = parameter->max;
    int above = (parameter->flags & MCR_PARAMETER_ABOVE_MIN) != 0, below = (parameter->flags & MCR_PARAMETER_BELOW_MAX) != 0;
    char range[160];

    if (!(min <= max) || (min == max && (above || below || isinf(min))))
        return fail(check, "parameter '%s' has an empty range", parameter->name);
    if (parameter->choices)
        return fail(check, "parameter '%s' has choices but is no choice", parameter->name);
    if (parameter->flags & MCR_PARAMETER_REQUIRED)
        return 0;
    for (int c = 0; c < (parameter->type == MCR_TYPE_COLOUR ? 3 : 1); c++) {
        double value = parameter->fallback[c];

        if (!isfinite(value) || !(above ? value > min : value >= min) || !(below ? value < max : value <= max)) {
            mcr_range_text(parameter, range, sizeof range);
            return fail(check, "the default of parameter '%s' is %g, expected %s", parameter->name, value, range);
        }
        if (parameter->type == MCR_TYPE_INTEGER && (value != floor(value) || fabs(value) > 9007199254740992.0))
            return fail(check, "the default of parameter '%s' is %g, expected a whole number", parameter->name, value);
    }
    return 0;
}

static int check_parameter(struct check *check, uint32_t k)
{
    const struct mcr_parameter *parameter = mcr_descriptor_parameter(check->descriptor, k);
    const uint32_t flags = MCR_PARAMETER_REQUIRED | MCR_PARAMETER_VARYING | MCR_PARAMETER_ABOVE_MIN | MCR_PARAMETER_BELOW_MAX;

    if (parameter->size != check->descriptor->parameters->size)
        return fail(check, "parameter %u has size %u, the first one %u", k + 1, parameter->size, check->descriptor->parameters->size);
    if (!parameter->name || !mcr_word_valid(parameter->name, strnlen(parameter->name, MCR_MAX_WORD + 1)))
        return fail(check, "the name of parameter %u is no word ([a-z][a-z0-9_-]*, at most %u bytes)", k + 1, MCR_MAX_WORD);
    for (uint32_t j = 0; j < k; j++)
        if (!strcmp(parameter->name, mcr_descriptor_parameter(check->descriptor, j)->name))
            return fail(check, "parameter '%s' is there twice", parameter->name);
    if (!printable(parameter->unit) || strlen(parameter->unit) > MCR_MAX_WORD || !printable(parameter->summary))
        return fail(check, "unit or summary of parameter '%s' is missing, too long or has control characters", parameter->name);
    if (parameter->flags & ~flags || parameter->reserved)
        return fail(check, "parameter '%s' has unknown flags", parameter->name);
    if (parameter->flags & MCR_PARAMETER_VARYING && check->descriptor->kind != MCR_KIND_MATERIAL)
        return fail(check, "parameter '%s' is marked as varying, which only a material's can be", parameter->name);
    switch (parameter->type) {
    case MCR_TYPE_NUMBER:
    case MCR_TYPE_INTEGER:
    case MCR_TYPE_COLOUR: return check_range(check, parameter);
    case MCR_TYPE_CHOICE: return check_choices(check, parameter);
    case MCR_TYPE_MATERIAL:
        if (check->descriptor->kind != MCR_KIND_MATERIAL || parameter->flags & MCR_PARAMETER_VARYING || parameter->choices)
            return fail(check, "parameter '%s' is a material, which only one of a material that does not vary can be", parameter->name);
        return 0;
    default: return fail(check, "parameter '%s' has the unknown type %u", parameter->name, parameter->type);
    }
}

static int check_directions(struct check *check)
{
    const struct mcr_directions_plugin *plugin = (const struct mcr_directions_plugin *)check->descriptor;

    if (!plugin->create || !plugin->techniques)
        return fail(check, "operation %s is missing", plugin->create ? "techniques" : "create");
    if (!plugin->draw != !plugin->density)
        return fail(check, "operation %s is missing beside %s", plugin->draw ? "density" : "draw", plugin->draw ? "draw" : "density");
    if (!plugin->draw_emitter != !plugin->density_emitter)
        return fail(check, "operation %s is missing", plugin->draw_emitter ? "density_emitter" : "draw_emitter");
    if (!plugin->draw && !plugin->draw_emitter)
        return fail(check, "operations draw and density are missing");
    return 0;
}

static int check_numbers(struct check *check)
{
    const struct mcr_numbers_plugin *plugin = (const struct mcr_numbers_plugin *)check->descriptor;
    const char *missing = !plugin->create       ? "create"
                          : !plugin->supplies   ? "supplies"
                          : !plugin->correlated ? "correlated"
                          : !plugin->fill       ? "fill"
                                                : NULL;

    return missing ? fail(check, "operation %s is missing", missing) : 0;
}

static int check_material(struct check *check)
{
    const struct mcr_material_plugin *plugin = (const struct mcr_material_plugin *)check->descriptor;
    int scatters = (plugin->evaluate != NULL) + (plugin->draw != NULL) + (plugin->density != NULL);

    if (!plugin->create || !plugin->traits)
        return fail(check, "operation %s is missing", plugin->create ? "traits" : "create");
    if (scatters != 0 && scatters != 3)
        return fail(check, "operations evaluate, draw and density belong together; %s is missing",
                    !plugin->evaluate ? "evaluate" : !plugin->draw ? "draw" : "density");
    if (!scatters && !plugin->emission && !plugin->delta)
        return fail(check, "operations evaluate, emission and delta are all missing");
    return 0;
}

/* A descriptor of a kind and for an instruction set that this host knows. */
static int check_descriptor(struct check *check)
{
    const struct mcr_descriptor *descriptor = check->descriptor;
    static const size_t size[] = {[MCR_KIND_DIRECTIONS] = sizeof(struct mcr_directions_plugin),
                                  [MCR_KIND_NUMBERS] = sizeof(struct mcr_numbers_plugin),
                                  [MCR_KIND_MATERIAL] = sizeof(struct mcr_material_plugin)};

    if (descriptor->size < size[descriptor->kind])
        return fail(check, "the descriptor has %u bytes, expected at least %zu for its kind", descriptor->size, size[descriptor->kind]);
    if (!printable(descriptor->version) || !printable(descriptor->licence) || !printable(descriptor->summary))
        return fail(check, "version, licence or summary is missing, too long or has control characters");
    if (descriptor->parameter_count > MCR_MAX_PARAMETERS)
        return fail(check, "it has %u parameters, at most %u are allowed", descriptor->parameter_count, MCR_MAX_PARAMETERS);
    if (descriptor->parameter_count && !descriptor->parameters)
        return fail(check, "the table of its %u parameters is missing", descriptor->parameter_count);
    if (descriptor->parameter_count && (descriptor->parameters->size < sizeof(struct mcr_parameter) || descriptor->parameters->size > 4096 ||
                                        descriptor->parameters->size % sizeof(double)))
        return fail(check, "its parameters have %u bytes each, expected at least %zu", descriptor->parameters->size,
                    sizeof(struct mcr_parameter));
    for (uint32_t k = 0; k < descriptor->parameter_count; k++)
        if (check_parameter(check, k))
            return -1;
    switch (descriptor->kind) {
    case MCR_KIND_DIRECTIONS: return check_directions(check);
    case MCR_KIND_NUMBERS: return check_numbers(check);
    default: return check_material(check);
    }
}

int mcr_descriptor_known(const struct mcr_descriptor *descriptor)
{
    return descriptor->kind >= MCR_KIND_DIRECTIONS && descriptor->kind <= MCR_KIND_MATERIAL && descriptor->isa <= MCR_ISA_AVX512;
}

/* All instruction sets of a word share one table: settings are read by one and used by another. */
static int check_same_table(struct check *check, const struct mcr_descriptor *baseline)
{
    const struct mcr_descriptor *descriptor = check->descriptor;
    int same = descriptor->parameter_count == baseline->parameter_count;

    for (uint32_t k = 0; same && k < baseline->parameter_count; k++) {
        const struct mcr_parameter *a = mcr_descriptor_parameter(baseline, k), *b = mcr_descriptor_parameter(descriptor, k);

        same = a->type == b->type && a->flags == b->flags && !strcmp(a->name, b->name) && a->min == b->min && a->max == b->max &&
               !memcmp(a->fallback, b->fallback, sizeof a->fallback) && (a->type != MCR_TYPE_CHOICE || !strcmp(a->choices, b->choices));
    }
    return same ? 0 : fail(check, "its parameters differ between instruction sets");
}

/* Each word once per kind and instruction set, and always for the baseline. */
static int check_list(struct check *check, const struct mcr_plugin *plugin)
{
    for (uint32_t i = 0; i < plugin->count; i++) {
        const struct mcr_descriptor *a = plugin->list[i], *baseline = NULL;

        if (!mcr_descriptor_known(a))
            continue;
        check->descriptor = a;
        for (uint32_t j = 0; j < plugin->count; j++) {
            const struct mcr_descriptor *b = plugin->list[j];

            if (!mcr_descriptor_known(b) || a->kind != b->kind || strcmp(a->name, b->name))
                continue;
            if (j < i && a->isa == b->isa)
                return fail(check, "it is listed twice for instruction set %u", a->isa);
            baseline = b->isa == MCR_ISA_BASELINE ? b : baseline;
        }
        if (!baseline)
            return fail(check, "it is not there for the baseline instruction set, which is required");
        if (check_same_table(check, baseline))
            return -1;
    }
    return 0;
}

int mcr_plugin_validate(const struct mcr_plugin *plugin, const char *word, char *why, size_t length)
{
    struct check check = {why, length, NULL};
    int known = 0, found = 0;

    if (plugin->size < 4 * sizeof(uint32_t))
        return fail(&check, "mcr_plugin has %u bytes, expected at least %zu", plugin->size, sizeof *plugin);
    if (plugin->major != MCR_PLUGIN_MAJOR)
        return fail(&check, "it was built for plugin interface %u.%u, this program has %u.%u", plugin->major, plugin->minor, MCR_PLUGIN_MAJOR,
                    MCR_PLUGIN_MINOR);
    if (plugin->size < sizeof *plugin)
        return fail(&check, "mcr_plugin has %u bytes, expected at least %zu", plugin->size, sizeof *plugin);
    if (plugin->count == 0 || plugin->count > MOST_DESCRIPTORS)
        return fail(&check, "it lists %u descriptors, expected 1 to %u", plugin->count, MOST_DESCRIPTORS);
    if (!plugin->list)
        return fail(&check, "its list of descriptors is missing");
    for (uint32_t i = 0; i < plugin->count; i++) {
        const struct mcr_descriptor *descriptor = plugin->list[i];

        check.descriptor = NULL;
        if (!descriptor || descriptor->size < sizeof *descriptor)
            return fail(&check, "descriptor %u is %s", i + 1, descriptor ? "too short" : "missing");
        if (!descriptor->name || !mcr_word_valid(descriptor->name, strnlen(descriptor->name, MCR_MAX_WORD + 1)))
            return fail(&check, "the name of descriptor %u is no word ([a-z][a-z0-9_-]*, at most %u bytes)", i + 1, MCR_MAX_WORD);
        check.descriptor = descriptor;
        if (!mcr_descriptor_known(descriptor)) { /* of a later minor version: left alone */
            if (plugin->minor <= MCR_PLUGIN_MINOR)
                return fail(&check, "unknown kind %u or instruction set %u", descriptor->kind, descriptor->isa);
            continue;
        }
        if (check_descriptor(&check))
            return -1;
        known = 1;
        found |= word && !strcmp(descriptor->name, word);
    }
    check.descriptor = NULL;
    if (!known)
        return fail(&check, "nothing in it is known to plugin interface %u.%u", MCR_PLUGIN_MAJOR, MCR_PLUGIN_MINOR);
    if (word && !found)
        return fail(&check, "it does not define '%s', the word of its file name", word);
    return check_list(&check, plugin);
}
