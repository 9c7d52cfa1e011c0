/* SPDX-License-Identifier: Apache-2.0 */
/* The founding study's quirks: names, lists of them, and the setting `compat`. */
#include "scene/build.h"

#include <stdio.h>

const char *const mcr_compat_name[MCR_COMPAT_COUNT] = { "clamp", "background-at-limit", "disk-polar", "sphere-spherical", "floor-sqrt" };

/* The bit of a name, or 0. */
static uint32_t find(const char *name, size_t length)
{
    for (uint32_t i = 0; i < MCR_COMPAT_COUNT; i++)
        if (strlen(mcr_compat_name[i]) == length && memcmp(mcr_compat_name[i], name, length) == 0)
            return 1u << i;
    return 0;
}

static int unknown(const char *word, size_t length, char *error, size_t room)
{
    char name[40], all[MCR_COMPAT_TEXT];
    const char *near;
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), word);
    near = mcr_nearest_word(name, mcr_compat_name, MCR_COMPAT_COUNT);
    mcr_compat_text((1u << MCR_COMPAT_COUNT) - 1, all);
    snprintf(error, room, "does not know '%s', expected none, or some of %s%s%s%s", name, all, near ? "; did you mean '" : "", near ? near : "",
             near ? "'?" : "");
    return -1;
}

int mcr_compat_parse(const char *text, uint32_t *mask, char *error, size_t length)
{
    uint32_t all = 0, bit;
    if (strcmp(text, "none") != 0) {
        for (const char *at = text, *end; at; at = *end ? end + 1 : NULL) {
            size_t count;
            at += strspn(at, " ");
            end = at + strcspn(at, ",");
            for (count = (size_t)(end - at); count > 0 && at[count - 1] == ' '; count--)
                ;
            bit = find(at, count);
            if (!bit)
                return unknown(at, count, error, length);
            if (all & bit) {
                snprintf(error, length, "names '%.*s' twice", (int)count, at);
                return -1;
            }
            all |= bit;
        }
    }
    *mask = all;
    return 0;
}

void mcr_compat_text(uint32_t mask, char text[MCR_COMPAT_TEXT])
{
    size_t used = 0;
    for (uint32_t i = 0; i < MCR_COMPAT_COUNT; i++)
        if (mask & 1u << i)
            used += (size_t)snprintf(text + used, MCR_COMPAT_TEXT - used, "%s%s", used ? ", " : "", mcr_compat_name[i]);
    if (!used)
        snprintf(text, MCR_COMPAT_TEXT, "none");
}

/* One name of the setting's value. Returns 0, or -1 after an error. */
static int read_name(struct mcr_build *build, const struct mcr_value *value, uint32_t *mask)
{
    const struct mcr_value *what = mcr_value_resolve(value);
    uint32_t bit;
    if (what->kind == MCR_VALUE_ERROR) /* told already */
        return -1;
    if (what->kind != MCR_VALUE_NAME)
        return mcr_wrong_kind(build, value, "compat", "render", mcr_word_form(MCR_WORD_COMPAT));
    bit = find(what->text, strlen(what->text));
    if (!bit) {
        mcr_unknown_word(build, value->place, "quirk", what->text, "compat", mcr_compat_name, MCR_COMPAT_COUNT);
        return -1;
    }
    if (*mask & bit) {
        mcr_error(build, value->place, "'compat' names '%s' twice, expected once", what->text);
        return -1;
    }
    *mask |= bit;
    return 0;
}

uint32_t mcr_read_compat(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index)
{
    const struct mcr_value *value = settings->value[index], *what = value ? mcr_value_resolve(value) : NULL;
    uint32_t mask = 0;
    if (!what || (what->kind == MCR_VALUE_NAME && strcmp(what->text, "none") == 0))
        return 0;
    if (what->kind != MCR_VALUE_TUPLE) {
        read_name(build, value, &mask);
        return mask;
    }
    for (uint32_t i = 0; i < what->count; i++)
        read_name(build, &what->item[i], &mask);
    return mask;
}
