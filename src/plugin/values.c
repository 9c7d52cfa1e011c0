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

/* The parameter's place in the table, or parameter_count after an error. */
static uint32_t find_parameter(struct mcr_diagnostics *diagnostics, const struct mcr_descriptor *descriptor,
                               const struct mcr_setting *setting)
{
    const char *word[MCR_MAX_PARAMETERS], *near;
    uint32_t k, count = descriptor->parameter_count;
    char list[1024] = "";

    for (k = 0; k < count; k++) {
        word[k] = mcr_descriptor_parameter(descriptor, k)->name;
        if (!strcmp(word[k], setting->name))
            return k;
        mcr_text_list(list, sizeof list, word[k], k, count);
    }
    mcr_report(diagnostics, MCR_ERROR, setting->place, "unknown setting '%s' of '%s', expected %s", setting->name, descriptor->name,
               count ? list : "none: it has no parameters");
    near = mcr_nearest_word(setting->name, word, count);
    if (near)
        mcr_report(diagnostics, MCR_NOTE, setting->place, "did you mean '%s'?", near);
    return count;
}

int mcr_values_read(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const struct mcr_descriptor *descriptor,
                    const struct mcr_setting *setting, uint32_t count, struct mcr_place place, int damaged,
                    struct mcr_values *values)
{
    uint32_t parameters = descriptor->parameter_count;
    double *number = mcr_arena_alloc(arena, parameters, 3 * sizeof *number);
    uint32_t *given = mcr_arena_alloc(arena, parameters, sizeof *given);
    struct mcr_place first[MCR_MAX_PARAMETERS];
    int wrong = 0;

    if (!number || !given) {
        mcr_report(diagnostics, MCR_ERROR, place, "out of memory");
        return -1;
    }
    for (uint32_t s = 0; s < count; s++) {
        uint32_t k = find_parameter(diagnostics, descriptor, &setting[s]);

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
            if (mcr_value_check(diagnostics, mcr_descriptor_parameter(descriptor, k), setting[s].value, descriptor->name, number + 3 * k))
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
            number[3 * k + c] = parameter->fallback[c] + 0.0;
    }
    *values = (struct mcr_values){sizeof *values, parameters, number, given};
    return wrong;
}
