/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/arguments.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/diag.h"
#include "cli/options.h"

int mcr_usage_error(const char *format, ...)
{
    va_list arguments;
    fputs("mcrender: error: ", stderr);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputs("\n", stderr);
    return MCR_EXIT_USAGE;
}

/* ---- names ---- */

static const char *name_of(const char *const *names, size_t stride, size_t i)
{
    return *(const char *const *)(const void *)((const char *)names + i * stride);
}

int mcr_option_find(const char *const *names, size_t stride, size_t count, const char *argument, size_t length, size_t shortest)
{
    int found = MCR_OPTION_NONE, other = MCR_OPTION_NONE;
    for (size_t i = 0; i < count; i++) {
        const char *name = name_of(names, stride, i);
        if (strncmp(name, argument, length))
            continue;
        if (!name[length])
            return (int)i;
        other = found;
        found = (int)i;
    }
    if (length < shortest || found < 0)
        return MCR_OPTION_NONE;
    if (other < 0)
        return found;
    mcr_usage_error("'%.*s' may be '%s' or '%s'", (int)length, argument, name_of(names, stride, (size_t)other), name_of(names, stride, (size_t)found));
    return MCR_OPTION_SEVERAL;
}

#define NAMES_MAX 64u

int mcr_option_unknown(const char *const *names, size_t stride, size_t count, const char *argument, size_t length, const char *help)
{
    const char *list[NAMES_MAX];
    char shown[64];
    size_t known = count < NAMES_MAX ? count : NAMES_MAX;
    snprintf(shown, sizeof shown, "%.*s", (int)(length < sizeof shown ? length : sizeof shown), argument);
    for (size_t i = 0; i < known; i++)
        list[i] = name_of(names, stride, i);
    const char *near = mcr_nearest_word(shown, list, known);
    return near ? mcr_usage_error("unknown option '%s', did you mean '%s'?", shown, near) : mcr_usage_error("unknown option '%s' (see %s)", shown, help);
}

/* ---- values ---- */

int mcr_argument_whole(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *out)
{
    char *end;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    if (text[0] < '0' || text[0] > '9' || *end || errno || value < low || value > high)
        return mcr_usage_error("%s expects a whole number from %llu to %llu, not '%s'", option, (unsigned long long)low, (unsigned long long)high, text);
    *out = value;
    return 0;
}

int mcr_argument_number(const char *option, const char *text, double low, double high, double *out)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || (*text != '-' && *text != '.' && (*text < '0' || *text > '9')) || !(value >= low && value <= high))
        return mcr_usage_error("%s expects a number from %g to %g, not '%s'", option, low, high, text);
    *out = value;
    return 0;
}

int mcr_argument_pixels(const char *option, const char *text, char separator, uint32_t count, uint32_t low, const char *form, uint32_t *out)
{
    const char *at = text;
    for (uint32_t i = 0; i < count; i++) {
        char *end;
        errno = 0;
        unsigned long long value = *at >= '0' && *at <= '9' ? strtoull(at, &end, 10) : UINT64_MAX;
        if (value == UINT64_MAX || errno || value < low || value > 65536 || *end != (i + 1 < count ? separator : '\0'))
            return mcr_usage_error("%s expects %s in pixels, each from %u to 65536, not '%s'", option, form, low, text);
        out[i] = (uint32_t)value;
        at = end + 1;
    }
    return 0;
}

int mcr_argument_crop(const char *option, const char *text, uint32_t crop[4])
{
    if (mcr_argument_pixels(option, text, ',', 4, 0, "X0,Y0,X1,Y1", crop))
        return MCR_EXIT_USAGE;
    if (crop[0] >= crop[2] || crop[1] >= crop[3])
        return mcr_usage_error("%s %s is empty: X0 < X1 and Y0 < Y1 are expected", option, text);
    return 0;
}

int mcr_argument_word(const char *option, const char *text, const char *const *words, uint32_t count, uint32_t absent, uint32_t *out)
{
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(text, words[i]))
            continue;
        if (i >= absent)
            return mcr_usage_error("%s %s is not available in this build", option, text);
        *out = i;
        return 0;
    }
    const char *near = mcr_nearest_word(text, words, count);
    if (near)
        return mcr_usage_error("%s does not know '%s', did you mean '%s'?", option, text, near);
    fprintf(stderr, "mcrender: error: %s does not know '%s', expected", option, text);
    for (uint32_t i = 0; i < absent; i++)
        fprintf(stderr, "%s %s", i == 0 ? "" : i + 1 < absent ? "," : " or", words[i]);
    fputs("\n", stderr);
    return MCR_EXIT_USAGE;
}
