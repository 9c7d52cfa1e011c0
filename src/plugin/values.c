/* SPDX-License-Identifier: Apache-2.0 */
#include "plugin/values.h"

#include <math.h>
#include <string.h>

#include "plugin/node.h"

#define LARGEST_INTEGER 9007199254740992.0 /* 2^53: all whole numbers up to here are doubles */
#define MOST_NAMES 64                      /* a `let` of a `let` of a …: bounded in case of a cycle */

const struct mcr_value *mcr_value_resolve(const struct mcr_value *value)
{
    for (int k = 0; k < MOST_NAMES && value->kind == MCR_VALUE_NAME && value->bound; k++)
        value = value->bound;
    return value;
}

const char *mcr_value_kind_name(const struct mcr_value *value)
{
    switch (value->kind) {
    case MCR_VALUE_NUMBER: return "a number";
    case MCR_VALUE_TUPLE: return "a tuple";
    case MCR_VALUE_STRING: return "a string";
    case MCR_VALUE_NAME: return "a word";
    case MCR_VALUE_CALL: return "a call";
    case MCR_VALUE_ERROR: break;
    }
    return "unreadable";
}

/* What a parameter takes, without its range. */
static const char *type_name(uint32_t type)
{
    switch (type) {
    case MCR_TYPE_NUMBER: return "a number";
    case MCR_TYPE_INTEGER: return "a whole number";
    case MCR_TYPE_COLOUR: return "a colour: one number, or three as (red, green, blue)";
    case MCR_TYPE_MATERIAL: return "the name of a material";
    default: return "a word";
    }
}

static void report_kind(struct mcr_diagnostics *diagnostics, const struct mcr_parameter *parameter, const struct mcr_value *value,
                        const char *of)
{
    const struct mcr_value *what = mcr_value_resolve(value);

    if (what->kind == MCR_VALUE_NAME)
        mcr_report(diagnostics, MCR_ERROR, value->place, "unknown name '%s' for '%s' of '%s', expected %s", what->text, parameter->name, of,
                   type_name(parameter->type));
    else if (what->kind == MCR_VALUE_TUPLE && parameter->type == MCR_TYPE_COLOUR)
        mcr_report(diagnostics, MCR_ERROR, value->place, "'%s' of '%s' has %u components, expected %s", parameter->name, of, what->count,
                   type_name(parameter->type));
    else
        mcr_report(diagnostics, MCR_ERROR, value->place, "'%s' of '%s' is %s, expected %s", parameter->name, of, mcr_value_kind_name(what),
                   type_name(parameter->type));
}

/* One component: finite, whole where it must be, and in range. */
static int check_component(struct mcr_diagnostics *diagnostics, const struct mcr_parameter *parameter, struct mcr_place place, const char *of,
                           double number)
{
    char range[160];
    int low = parameter->flags & MCR_PARAMETER_ABOVE_MIN ? number > parameter->min : number >= parameter->min;
    int high = parameter->flags & MCR_PARAMETER_BELOW_MAX ? number < parameter->max : number <= parameter->max;

    if (parameter->type == MCR_TYPE_INTEGER && (number != floor(number) || fabs(number) > LARGEST_INTEGER)) {
        mcr_report(diagnostics, MCR_ERROR, place, "'%s' of '%s' is %.17g, expected a whole number", parameter->name, of, number);
        return -1;
    }
    if (isfinite(number) && low && high)
        return 0;
    mcr_range_text(parameter, range, sizeof range);
    mcr_report(diagnostics, MCR_ERROR, place, "'%s' of '%s' is %.10g, expected %s", parameter->name, of, number, range);
    return -1;
}

static int check_choice(struct mcr_diagnostics *diagnostics, const struct mcr_parameter *parameter, const struct mcr_value *value,
                        const char *of, double number[3])
{
    char words[MCR_MAX_CHOICES][MCR_MAX_WORD + 1], list[512] = "";
    const char *word[MCR_MAX_CHOICES], *near;
    uint32_t count = mcr_choice_count(parameter->choices);

    if (value->kind != MCR_VALUE_NAME) {
        report_kind(diagnostics, parameter, value, of);
        return -1;
    }
    for (uint32_t k = 0; k < count && k < MCR_MAX_CHOICES; k++) {
        mcr_choice_word(parameter->choices, k, words[k]);
        if (!strcmp(words[k], value->text)) {
            number[0] = k;
            return 0;
        }
        word[k] = words[k];
        mcr_text_list(list, sizeof list, words[k], k, count);
    }
    mcr_report(diagnostics, MCR_ERROR, value->place, "unknown word '%s' for '%s' of '%s', expected %s", value->text, parameter->name, of,
               list);
    near = mcr_nearest_word(value->text, word, count < MCR_MAX_CHOICES ? count : MCR_MAX_CHOICES);
    if (near)
        mcr_report(diagnostics, MCR_NOTE, value->place, "did you mean '%s'?", near);
    return -1;
}

int mcr_value_check(struct mcr_diagnostics *diagnostics, const struct mcr_parameter *parameter, const struct mcr_value *value, const char *of,
                    double number[3])
{
    const struct mcr_value *what = mcr_value_resolve(value);
    int wrong = 0;

    number[0] = number[1] = number[2] = 0;
    if (what->kind == MCR_VALUE_ERROR) /* told already */
        return -1;
    if (parameter->type == MCR_TYPE_CHOICE)
        return check_choice(diagnostics, parameter, value, of, number);
    if (what->kind == MCR_VALUE_NUMBER) {
        if (check_component(diagnostics, parameter, value->place, of, what->number))
            return -1;
        number[0] = what->number + 0.0; /* no negative zero */
        if (parameter->type == MCR_TYPE_COLOUR)
            number[1] = number[2] = number[0];
        return 0;
    }
    if (what->kind != MCR_VALUE_TUPLE || parameter->type != MCR_TYPE_COLOUR || what->count != 3) {
        report_kind(diagnostics, parameter, value, of);
        return -1;
    }
    for (uint32_t c = 0; c < 3; c++) {
        const struct mcr_value *component = mcr_value_resolve(&what->item[c]);

        if (component->kind == MCR_VALUE_ERROR) {
            wrong = -1;
        } else if (component->kind != MCR_VALUE_NUMBER) {
            mcr_report(diagnostics, MCR_ERROR, what->item[c].place, "component %u of '%s' of '%s' is %s, expected a number", c + 1,
                       parameter->name, of, mcr_value_kind_name(component));
            wrong = -1;
        } else if (check_component(diagnostics, parameter, what->item[c].place, of, component->number)) {
            wrong = -1;
        } else {
            number[c] = component->number + 0.0;
        }
    }
    return wrong;
}

/* ---- a block's settings ---- */

/* The parameter's place in the table, or parameter_count after an error. */
static uint32_t find_parameter(struct mcr_diagnostics *diagnostics, const struct mcr_descriptor *descriptor,
                               const struct mcr_setting *setting, const struct mcr_value_names *names)
{
    const char *word[MCR_MAX_PARAMETERS + MCR_MAX_OTHERS], *near;
    uint32_t k, count = descriptor->parameter_count, others = names ? names->word_count : 0;
    char list[1024] = "";

    for (k = 0; k < count; k++) {
        word[k] = mcr_descriptor_parameter(descriptor, k)->name;
        if (!strcmp(word[k], setting->name))
            return k;
        mcr_text_list(list, sizeof list, word[k], k, count);
    }
    mcr_report(diagnostics, MCR_ERROR, setting->place, "unknown setting '%s' of '%s', expected %s", setting->name, descriptor->name,
               count ? list : "none: it has no parameters");
    for (k = 0; k < others && k < MCR_MAX_OTHERS; k++)
        word[count + k] = names->word[k];
    near = mcr_nearest_word(setting->name, word, count + k);
    if (near)
        mcr_report(diagnostics, MCR_NOTE, setting->place, "did you mean '%s'?", near);
    return count;
}

/* A texture must lie in the parameter's range as a whole. One without extent may be what mistakes left of it. */
static int check_texture(struct mcr_diagnostics *diagnostics, const struct mcr_parameter *parameter, const struct mcr_value *value, const char *of,
                         const struct mcr_varying *varying)
{
    const double *low = varying->min, *high = varying->max;
    char range[160];

    for (int c = 0; c < (parameter->type == MCR_TYPE_COLOUR ? 3 : 1); c++) {
        int above = parameter->flags & MCR_PARAMETER_ABOVE_MIN ? low[c] > parameter->min : low[c] >= parameter->min;
        int below = parameter->flags & MCR_PARAMETER_BELOW_MAX ? high[c] < parameter->max : high[c] <= parameter->max;

        if ((above && below) || (low[c] == high[c] && mcr_diagnostics_errors(diagnostics) > 0))
            continue;
        mcr_range_text(parameter, range, sizeof range);
        mcr_report(diagnostics, MCR_ERROR, value->place, "texture '%s' for '%s' of '%s' goes from %.10g to %.10g, expected %s", value->text,
                   parameter->name, of, low[c], high[c], range);
        return -1;
    }
    return 0;
}

/*
 * A name that no `let` explains, as the name of a texture. Returns 1 if it is one and right, 0 if it is to be judged as a plain value, -1 after an
 * error.
 */
static int read_texture(struct mcr_diagnostics *diagnostics, const struct mcr_parameter *parameter, const struct mcr_value *value, const char *of,
                        const struct mcr_value_names *names, struct mcr_varying *varying)
{
    const struct mcr_value *what = mcr_value_resolve(value);
    const char *near;
    int takes = parameter->flags & MCR_PARAMETER_VARYING;

    if (!names || what->kind != MCR_VALUE_NAME || (parameter->type != MCR_TYPE_COLOUR && parameter->type != MCR_TYPE_NUMBER))
        return 0;
    if (names->texture(names->data, what, parameter->type, varying)) {
        if (takes)
            return check_texture(diagnostics, parameter, what, of, varying) ? -1 : 1;
        mcr_report(diagnostics, MCR_ERROR, value->place, "'%s' of '%s' is the texture '%s', expected %s: it cannot vary over the surface",
                   parameter->name, of, what->text, type_name(parameter->type));
        return -1;
    }
    if (!takes)
        return 0;
    mcr_report(diagnostics, MCR_ERROR, value->place, "unknown name '%s' for '%s' of '%s', expected %s, or the name of a texture", what->text,
               parameter->name, of, type_name(parameter->type));
    near = names->near_texture(names->data, what->text);
    if (near)
        mcr_report(diagnostics, MCR_NOTE, value->place, "did you mean '%s'?", near);
    return -1;
}

/* Another material's name. Its place among the children becomes the number. */
static int read_material(struct mcr_diagnostics *diagnostics, const struct mcr_parameter *parameter, const struct mcr_value *value, const char *of,
                         const struct mcr_value_names *names, struct mcr_named_values *named, double number[3])
{
    struct mcr_node *child;

    if (mcr_value_resolve(value)->kind == MCR_VALUE_ERROR)
        return -1;
    if (value->kind != MCR_VALUE_NAME || value->bound || !names) {
        report_kind(diagnostics, parameter, value, of);
        return -1;
    }
    if (named->child_count == MCR_MAX_CHILDREN) {
        mcr_report(diagnostics, MCR_ERROR, value->place, "'%s' has more than %u materials inside it", of, MCR_MAX_CHILDREN);
        return -1;
    }
    child = names->material(names->data, value);
    if (!child)
        return -1;
    number[0] = named->child_count;
    named->child[named->child_count++] = child;
    return 0;
}

/* What mcr_values_read_named works on. */
struct reader {
    struct mcr_arena *arena;
    struct mcr_diagnostics *diagnostics;
    const struct mcr_descriptor *descriptor;
    const struct mcr_value_names *names;
    struct mcr_named_values *named;
    double *number;
};

static int read_value(struct reader *reader, uint32_t k, const struct mcr_value *value)
{
    const struct mcr_parameter *parameter = mcr_descriptor_parameter(reader->descriptor, k);
    const char *of = reader->descriptor->name;
    struct mcr_named_values *named = reader->named;
    double *number = reader->number + 3 * (size_t)k;
    struct mcr_varying varying;
    int texture;

    if (parameter->type == MCR_TYPE_MATERIAL)
        return read_material(reader->diagnostics, parameter, value, of, reader->names, named, number);
    texture = read_texture(reader->diagnostics, parameter, value, of, reader->names, &varying);
    if (texture <= 0)
        return texture < 0 ? -1 : mcr_value_check(reader->diagnostics, parameter, value, of, number);
    if (!named->texture && !(named->texture = mcr_arena_alloc(reader->arena, reader->descriptor->parameter_count, sizeof *named->texture))) {
        mcr_report(reader->diagnostics, MCR_ERROR, value->place, "out of memory");
        return -1;
    }
    named->texture[k] = varying.texture;
    for (int c = 0; c < (parameter->type == MCR_TYPE_COLOUR ? 3 : 1); c++)
        number[c] = varying.mean[c] + 0.0;
    return 0;
}

int mcr_values_read_named(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const struct mcr_descriptor *descriptor,
                          const struct mcr_setting *setting, uint32_t count, struct mcr_place place, int damaged,
                          const struct mcr_value_names *names, struct mcr_values *values, struct mcr_named_values *named)
{
    uint32_t parameters = descriptor->parameter_count;
    double *number = mcr_arena_alloc(arena, parameters, 3 * sizeof *number);
    uint32_t *given = mcr_arena_alloc(arena, parameters, sizeof *given);
    struct reader reader = {arena, diagnostics, descriptor, names, named, number};
    struct mcr_place first[MCR_MAX_PARAMETERS];
    int wrong = 0;

    memset(named, 0, sizeof *named);
    if (!number || !given) {
        mcr_report(diagnostics, MCR_ERROR, place, "out of memory");
        return -1;
    }
    for (uint32_t s = 0; s < count; s++) {
        uint32_t k = find_parameter(diagnostics, descriptor, &setting[s], names);

        if (k == parameters) {
            wrong = -1;
        } else if (given[k]) {
            mcr_report(diagnostics, MCR_ERROR, setting[s].place, "'%s' of '%s' is given twice, expected once", setting[s].name,
                       descriptor->name);
            mcr_report(diagnostics, MCR_NOTE, first[k], "the first one is here");
            wrong = -1;
        } else {
            given[k] = 1;
            first[k] = setting[s].place;
            if (read_value(&reader, k, setting[s].value))
                wrong = -1;
        }
    }
    for (uint32_t k = 0; k < parameters; k++) {
        const struct mcr_parameter *parameter = mcr_descriptor_parameter(descriptor, k);

        if (given[k])
            continue;
        if (parameter->flags & MCR_PARAMETER_REQUIRED && !damaged)
            mcr_report(diagnostics, MCR_ERROR, place, "'%s' needs '%s', expected %s", descriptor->name, parameter->name,
                       type_name(parameter->type));
        wrong |= parameter->flags & MCR_PARAMETER_REQUIRED ? -1 : 0;
        for (uint32_t c = 0; c < (parameter->type == MCR_TYPE_COLOUR ? 3 : 1); c++)
            number[3 * k + c] = parameter->type == MCR_TYPE_MATERIAL ? -1 : parameter->fallback[c] + 0.0;
    }
    *values = (struct mcr_values){sizeof *values, parameters, number, given};
    return wrong;
}

int mcr_values_read(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const struct mcr_descriptor *descriptor,
                    const struct mcr_setting *setting, uint32_t count, struct mcr_place place, int damaged,
                    struct mcr_values *values)
{
    struct mcr_named_values named;

    return mcr_values_read_named(arena, diagnostics, descriptor, setting, count, place, damaged, NULL, values, &named);
}
