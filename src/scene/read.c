/* SPDX-License-Identifier: Apache-2.0 */
/* Values of settings: numbers by mcr_value_check, as for plugins, and the tuples that only scenes have. */
#include "scene/build.h"
#include "scene/vector.h"

const char *mcr_value_described(const struct mcr_value *value, char text[80])
{
    value = mcr_value_resolve(value);
    switch (value->kind) {
    case MCR_VALUE_NUMBER:
        snprintf(text, 80, "%.10g", value->number);
        break;
    case MCR_VALUE_TUPLE:
        snprintf(text, 80, "a tuple of %u", value->count);
        break;
    case MCR_VALUE_NAME:
        snprintf(text, 80, "the name '%.60s'", value->text);
        break;
    case MCR_VALUE_CALL:
        snprintf(text, 80, "a call of '%.60s'", value->text);
        break;
    default:
        snprintf(text, 80, "a string");
    }
    return text;
}

int mcr_wrong_kind(struct mcr_build *build, const struct mcr_value *value, const char *name, const char *of, const char *form)
{
    char text[80];
    /* What could not be read was reported by the parser. */
    if (mcr_value_resolve(value)->kind != MCR_VALUE_ERROR)
        mcr_error(build, value->place, "'%s' of '%s' is %s, expected %s", name, of, mcr_value_described(value, text), form);
    return -1;
}

/* The default of a row where it is not given. */
static int fallback(const struct mcr_parameter *row, uint32_t count, double *out)
{
    for (uint32_t i = 0; i < count; i++)
        out[i] = i < 3 ? row->fallback[i] : 0;
    return 1;
}

int mcr_read_colour(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, double out[3])
{
    const struct mcr_parameter *row = &settings->word->setting[index];
    if (!settings->value[index])
        return fallback(row, 3, out);
    if (mcr_value_resolve(settings->value[index])->kind == MCR_VALUE_ERROR)
        return -1;
    return mcr_value_check(build->diagnostics, row, settings->value[index], settings->of, out);
}

int mcr_read_number(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, double *out)
{
    double number[3];
    int result = mcr_read_colour(build, settings, index, number);
    if (result >= 0)
        *out = number[0];
    return result;
}

/* "in range", or an error that says the range. */
static int in_range(struct mcr_build *build, const struct mcr_parameter *row, const struct mcr_value *value, double x, const char *of)
{
    int above = row->flags & MCR_PARAMETER_ABOVE_MIN ? x > row->min : x >= row->min;
    int below = row->flags & MCR_PARAMETER_BELOW_MAX ? x < row->max : x <= row->max;
    char range[160];
    if (above && below)
        return 1;
    mcr_range_text(row, range, sizeof range);
    mcr_error(build, value->place, "'%s' of '%s' has %.10g, expected %s", row->name, of, x, range);
    return 0;
}

/* `value` must be a tuple of `width` numbers. Its items, or NULL after an error. */
static const struct mcr_value *tuple_of(struct mcr_build *build, const struct mcr_value *value, const char *name, const char *of,
                                        const char *form, uint32_t width)
{
    const struct mcr_value *tuple = mcr_value_resolve(value);
    char text[80];
    if (tuple->kind != MCR_VALUE_TUPLE || tuple->count != width) {
        mcr_wrong_kind(build, value, name, of, form);
        return NULL;
    }
    for (uint32_t i = 0; i < width; i++) {
        const struct mcr_value *item = mcr_value_resolve(&tuple->item[i]);
        if (item->kind == MCR_VALUE_NUMBER)
            continue;
        if (item->kind != MCR_VALUE_ERROR)
            mcr_error(build, tuple->item[i].place, "component %u of '%s' of '%s' is %s, expected a number", i + 1, name, of,
                      mcr_value_described(item, text));
        return NULL;
    }
    return tuple->item;
}

int mcr_read_numbers(struct mcr_build *build, const struct mcr_value *value, const char *name, const char *of, const char *form,
                     uint32_t width, double limit, double *out)
{
    const struct mcr_value *item = tuple_of(build, value, name, of, form, width);
    if (!item)
        return -1;
    for (uint32_t i = 0; i < width; i++) {
        out[i] = mcr_value_resolve(&item[i])->number;
        if (!(fabs(out[i]) <= limit)) {
            mcr_error(build, item[i].place, "'%s' of '%s' has %.10g, expected %g to %g", name, of, out[i], -limit, limit);
            return -1;
        }
    }
    return 0;
}

int mcr_read_vector(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, double out[3])
{
    const struct mcr_parameter *row = &settings->word->setting[index];
    const struct mcr_value *value = settings->value[index], *item;
    if (!value)
        return fallback(row, 3, out);
    item = tuple_of(build, value, row->name, settings->of, mcr_word_form(row->type), 3);
    if (!item)
        return -1;
    for (int i = 0; i < 3; i++) {
        out[i] = mcr_value_resolve(&item[i])->number;
        if (!in_range(build, row, &item[i], out[i], settings->of))
            return -1;
    }
    return 0;
}

int mcr_read_whole(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, uint32_t count, uint32_t *out)
{
    const struct mcr_parameter *row = &settings->word->setting[index];
    const struct mcr_value *value = settings->value[index], *item;
    if (!value) {
        for (uint32_t i = 0; i < count; i++)
            out[i] = i < 3 ? (uint32_t)row->fallback[i] : 0;
        return 1;
    }
    item = tuple_of(build, value, row->name, settings->of, mcr_word_form(row->type), count);
    if (!item)
        return -1;
    for (uint32_t i = 0; i < count; i++) {
        double number = mcr_value_resolve(&item[i])->number;
        if (!in_range(build, row, &item[i], number, settings->of))
            return -1;
        if (floor(number) != number) {
            mcr_error(build, item[i].place, "'%s' of '%s' has %.17g, expected %s", row->name, settings->of, number,
                      mcr_word_form(row->type));
            return -1;
        }
        out[i] = (uint32_t)number;
    }
    return 0;
}

int mcr_read_list(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, const struct mcr_value **item,
                  uint32_t *count)
{
    const struct mcr_parameter *row = &settings->word->setting[index];
    const struct mcr_value *value = settings->value[index], *list = mcr_value_resolve(value);
    if (list->kind != MCR_VALUE_TUPLE)
        return mcr_wrong_kind(build, value, row->name, settings->of, mcr_word_form(row->type));
    /* ((1, 2, 3)) is (1, 2, 3) in brackets: a list of one. */
    if (list->count > 0 && mcr_value_resolve(&list->item[0])->kind == MCR_VALUE_NUMBER) {
        *item = list;
        *count = 1;
    } else {
        *item = list->item;
        *count = list->count;
    }
    return 0;
}

int mcr_read_tuples(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, uint32_t count, uint32_t width,
                    double *out)
{
    const struct mcr_parameter *row = &settings->word->setting[index];
    const struct mcr_value *item;
    uint32_t given;
    const char *form = width == 3 ? mcr_word_form(MCR_WORD_POINT) : "2 numbers (u, v)";
    int result = 0;
    if (!settings->value[index])
        return 1;
    if (mcr_read_list(build, settings, index, &item, &given) != 0)
        return -1;
    if (given != count) {
        mcr_error(build, settings->value[index]->place, "'%s' of '%s' has %u, expected %s", row->name, settings->of, given,
                  mcr_word_form(row->type));
        return -1;
    }
    for (uint32_t i = 0; i < count; i++)
        if (mcr_read_numbers(build, &item[i], row->name, settings->of, form, width, MCR_EXTENT_LIMIT, out + (size_t)i * width) != 0)
            result = -1;
    return result;
}
