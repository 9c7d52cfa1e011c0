/* SPDX-License-Identifier: Apache-2.0 */
/* Blocks `transform { … }`: their steps, from text to matrices. */
#include "scene/build.h"
#include "scene/vector.h"

static const double origin[3] = { 0, 0, 0 };

static void identity(double l[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            l[i][j] = i == j;
}

/* Says what is wrong with a step; 0 if its linear part can be inverted. */
static int check_step(struct mcr_build *build, const struct mcr_item *step, double l[3][3])
{
    struct mcr_transform alone;
    int result;
    mcr_transform_init(&alone, origin);
    mcr_transform_then(&alone, l, origin);
    result = mcr_transform_finish(&alone);
    if (result == -1)
        mcr_error(build, step->value.place, "'%s' is singular: it would flatten what it moves", step->word);
    else if (result == -2)
        mcr_error(build, step->value.place, "'%s' scales by more than %g or less than %g", step->word, MCR_EXTENT_LIMIT,
                  1 / MCR_EXTENT_LIMIT);
    return result;
}

static int read_scale(struct mcr_build *build, const struct mcr_item *step, double l[3][3])
{
    const struct mcr_value *value = mcr_value_resolve(&step->value);
    const char *form = mcr_word_form(MCR_WORD_SCALE);
    double s[3];
    if (value->kind == MCR_VALUE_NUMBER) {
        s[0] = s[1] = s[2] = value->number;
    } else if (mcr_read_numbers(build, &step->value, "scale", "transform", form, 3, MCR_EXTENT_LIMIT, s) != 0) {
        return -1;
    }
    for (int i = 0; i < 3; i++)
        l[i][i] = s[i];
    return check_step(build, step, l);
}

static int read_rotate(struct mcr_build *build, const struct mcr_item *step, double l[3][3])
{
    double r[4];
    if (mcr_read_numbers(build, &step->value, "rotate", "transform", mcr_word_form(MCR_WORD_ROTATION), 4, MCR_EXTENT_LIMIT, r) != 0)
        return -1;
    if (!mcr_rotation(r, r[3], l)) {
        mcr_error(build, step->value.place, "'rotate' has the axis (0, 0, 0)");
        return -1;
    }
    return 0;
}

static int read_matrix(struct mcr_build *build, const struct mcr_item *step, double l[3][3], double t[3])
{
    static const double last[4] = { 0, 0, 0, 1 };
    const struct mcr_value *value = mcr_value_resolve(&step->value);
    uint32_t width = value->kind == MCR_VALUE_TUPLE && value->count == 16 ? 16 : 12;
    double m[16];
    if (mcr_read_numbers(build, &step->value, "matrix", "transform", mcr_word_form(MCR_WORD_MATRIX), width, MCR_EXTENT_LIMIT, m) != 0)
        return -1;
    for (uint32_t i = 12; i < width; i++) {
        if (m[i] != last[i - 12]) {
            mcr_error(build, value->item[i].place, "the last row of 'matrix' must be 0, 0, 0, 1");
            return -1;
        }
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            l[i][j] = m[4 * i + j];
        t[i] = m[4 * i + 3];
    }
    return check_step(build, step, l);
}

static int read_lookat(struct mcr_build *build, const struct mcr_item *step, double l[3][3], double t[3])
{
    static const char *const part[3] = { "from", "to", "up" };
    const struct mcr_value *value = mcr_value_resolve(&step->value);
    double p[3][3];
    if (value->kind != MCR_VALUE_TUPLE || value->count != 3)
        return mcr_wrong_kind(build, &step->value, "lookat", "transform", mcr_word_form(MCR_WORD_LOOKAT));
    for (int i = 0; i < 3; i++)
        if (mcr_read_numbers(build, &value->item[i], part[i], "lookat", mcr_word_form(MCR_WORD_POINT), 3, MCR_EXTENT_LIMIT, p[i]) != 0)
            return -1;
    if (!mcr_lookat(p[0], p[1], p[2], l)) {
        int together = memcmp(p[0], p[1], sizeof p[0]) == 0;
        mcr_error(build, value->item[together ? 1 : 2].place, together ? "'from' and 'to' of 'lookat' are the same point"
                                                                      : "'up' of 'lookat' is zero or parallel to the view");
        return -1;
    }
    mcr_copy(p[0], t);
    return 0;
}

/* Returns the step's number in the table, or -1 after an error. */
static int find_step(struct mcr_build *build, const struct mcr_item *step)
{
    const struct mcr_block_word *word = mcr_scene_block("transform", NULL);
    const char *words[MCR_SETTINGS_LIMIT];
    for (uint32_t i = 0; i < word->count; i++) {
        words[i] = word->setting[i].name;
        if (strcmp(words[i], step->word) == 0) {
            if (!step->is_block)
                return (int)i;
            mcr_error(build, step->place, "'%s' of 'transform' is a block, expected a value", step->word);
            return -1;
        }
    }
    mcr_unknown_word(build, step->place, "step", step->word, "transform", words, word->count);
    return -1;
}

static int read_step(struct mcr_build *build, const struct mcr_item *step, double l[3][3], double t[3])
{
    identity(l);
    mcr_copy(origin, t);
    switch (find_step(build, step)) {
    case STEP_TRANSLATE:
        return mcr_read_numbers(build, &step->value, "translate", "transform", mcr_word_form(MCR_WORD_VECTOR), 3, MCR_EXTENT_LIMIT, t);
    case STEP_ROTATE:
        return read_rotate(build, step, l);
    case STEP_SCALE:
        return read_scale(build, step, l);
    case STEP_MATRIX:
        return read_matrix(build, step, l, t);
    case STEP_LOOKAT:
        return read_lookat(build, step, l, t);
    default:
        return -1;
    }
}

int mcr_build_transform(struct mcr_build *build, const struct mcr_item *block, struct mcr_transform *transform)
{
    int good = 1, result;
    /* What acts last on points is outermost: it is composed first. */
    for (uint32_t i = block->count; i-- > 0;) {
        double l[3][3], t[3];
        if (read_step(build, &block->item[i], l, t) != 0)
            good = 0;
        else if (good)
            mcr_transform_then(transform, l, t);
    }
    if (!good)
        return -1;
    result = mcr_transform_finish(transform);
    if (result == -1)
        mcr_error(build, block->place, "this transform, together with those around it, is singular");
    else if (result == -2)
        mcr_error(build, block->place, "this transform, together with those around it, leaves the range of %g to %g", 1 / MCR_EXTENT_LIMIT,
                  MCR_EXTENT_LIMIT);
    return result;
}
