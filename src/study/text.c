/* SPDX-License-Identifier: Apache-2.0 */
#include "study/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json.h"

void mcr_text_fini(struct mcr_text *text)
{
    free(text->bytes);
    memset(text, 0, sizeof *text);
}

/* Room for `count` more bytes and the NUL; NULL after a failure. */
static char *reserve(struct mcr_text *text, size_t count)
{
    if (text->failed)
        return NULL;
    if (count >= MCR_TEXT_MAX - text->used) {
        text->failed = 1;
        return NULL;
    }
    if (text->used + count >= text->room) {
        size_t room = text->room ? text->room : 4096;
        while (room <= text->used + count)
            room *= 2;
        char *larger = realloc(text->bytes, room);
        if (!larger) {
            text->failed = 1;
            return NULL;
        }
        text->bytes = larger;
        text->room = room;
    }
    return text->bytes + text->used;
}

void mcr_text_bytes(struct mcr_text *text, const char *bytes, size_t count)
{
    char *to = reserve(text, count);
    if (!to)
        return;
    memcpy(to, bytes, count);
    to[count] = '\0';
    text->used += count;
}

void mcr_text_put(struct mcr_text *text, const char *string)
{
    mcr_text_bytes(text, string, strlen(string));
}

void mcr_text_printf(struct mcr_text *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int count = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    char *to = count < 0 ? NULL : reserve(text, (size_t)count);
    if (!to) {
        text->failed = 1;
        return;
    }
    va_start(arguments, format);
    vsnprintf(to, (size_t)count + 1, format, arguments);
    va_end(arguments);
    text->used += (size_t)count;
}

static const char *escape(unsigned char c)
{
    switch (c) {
    case '&': return "&amp;";
    case '<': return "&lt;";
    case '>': return "&gt;";
    case '"': return "&quot;";
    case '\'': return "&#39;";
    default: return c < 0x20 && c != '\t' && c != '\n' ? "\xef\xbf\xbd" : NULL;
    }
}

static void put_html(struct mcr_text *text, const char *string, int breaks)
{
    size_t length = string ? strlen(string) : 0;
    for (size_t i = 0; i < length;) {
        size_t sequence = mcr_utf8_sequence(string + i, length - i);
        const char *instead = sequence ? escape((unsigned char)string[i]) : "\xef\xbf\xbd";
        if (sequence == 3 && (!memcmp(string + i, "\xef\xbf\xbe", 3) || !memcmp(string + i, "\xef\xbf\xbf", 3)))
            instead = "\xef\xbf\xbd"; /* U+FFFE and U+FFFF are no characters of XML */
        if (instead)
            mcr_text_put(text, instead);
        else
            mcr_text_bytes(text, string + i, sequence);
        if (breaks && string[i] == '(')
            mcr_text_put(text, "<wbr/>");
        i += sequence ? sequence : 1;
    }
}

void mcr_text_html(struct mcr_text *text, const char *string)
{
    put_html(text, string, 0);
}

void mcr_text_html_breaks(struct mcr_text *text, const char *string)
{
    put_html(text, string, 1);
}

/* RFC 4648. */
void mcr_text_base64(struct mcr_text *text, const unsigned char *bytes, size_t count)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (count > MCR_TEXT_MAX) {
        text->failed = 1;
        return;
    }
    size_t length = (count + 2) / 3 * 4;
    char *to = reserve(text, length);
    if (!to)
        return;
    for (size_t i = 0; i < count; i += 3) {
        size_t left = count - i;
        uint32_t three = (uint32_t)bytes[i] << 16 | (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
        *to++ = digit[three >> 18];
        *to++ = digit[three >> 12 & 63];
        *to++ = left > 1 ? digit[three >> 6 & 63] : '=';
        *to++ = left > 2 ? digit[three & 63] : '=';
    }
    *to = '\0';
    text->used += length;
}

/* The significant digits of |x|, finite, as text, and the decimal exponent of the first. printf's decimal point, the locale's, is skipped. */
static int decimal(double x, int digits, char significant[32])
{
    char printed[64];
    int count = 0;
    snprintf(printed, sizeof printed, "%.*e", digits - 1, fabs(x));
    const char *exponent = strchr(printed, 'e');
    for (const char *at = printed; at < exponent && count < 31; at++)
        if (*at >= '0' && *at <= '9')
            significant[count++] = *at;
    significant[count] = '\0';
    return (int)strtol(exponent + 1, NULL, 10);
}

/* The digits from `from` on, or zeros where there are none. */
static void put_digits(struct mcr_text *text, const char *significant, int from, int count)
{
    int length = (int)strlen(significant);
    for (int i = from; i < from + count; i++)
        mcr_text_bytes(text, i >= 0 && i < length ? significant + i : "0", 1);
}

/* Returns 1 if an exponent remains to be written, *exponent. trim: without zeros at the end. */
static int put_number(struct mcr_text *text, double x, int digits, int trim, const char *minus, int *exponent)
{
    char significant[32];
    int first = decimal(x, digits, significant);
    int scientific = x != 0 && (first < -3 || first >= 6), length = (int)strlen(significant);
    while (trim && length > 1 && significant[length - 1] == '0')
        significant[--length] = '\0';
    *exponent = first;
    if (x < 0)
        mcr_text_put(text, minus);
    int before = scientific ? 1 : first < 0 ? 0 : first + 1; /* digits before the point */
    if (before)
        put_digits(text, significant, 0, before);
    else
        mcr_text_put(text, "0");
    int skip = !scientific && first < 0 ? first + 1 : before; /* the first digit after the point; below 0: zeros */
    if (length > skip && x != 0) {
        mcr_text_put(text, ".");
        put_digits(text, significant, skip, length - skip);
    }
    return scientific;
}

static void put_plain(struct mcr_text *text, double x, int digits, int trim)
{
    int exponent;
    if (isnan(x))
        mcr_text_put(text, "unknown");
    else if (isinf(x))
        mcr_text_put(text, x < 0 ? "-infinite" : "infinite");
    else if (put_number(text, x, digits, trim, "-", &exponent))
        mcr_text_printf(text, "e%d", exponent);
}

void mcr_text_digits(struct mcr_text *text, double x, int digits)
{
    put_plain(text, x, digits, 0);
}

void mcr_text_short(struct mcr_text *text, double x, int digits)
{
    put_plain(text, x, digits, 1);
}

void mcr_text_digits_html(struct mcr_text *text, double x, int digits)
{
    int exponent;
    if (isnan(x))
        mcr_text_put(text, "\u2014");
    else if (isinf(x))
        mcr_text_put(text, x < 0 ? "\u2212\u221e" : "\u221e");
    else if (put_number(text, x, digits, 0, "\u2212", &exponent))
        mcr_text_printf(text, "\u00b710<sup>%s%d</sup>", exponent < 0 ? "\u2212" : "", abs(exponent));
}

void mcr_text_fixed(struct mcr_text *text, double x)
{
    if (!(fabs(x) < 1e12))
        x = 0;
    uint64_t hundredths = (uint64_t)floor(fabs(x) * 100 + 0.5);
    mcr_text_printf(text, "%s%llu", x < 0 && hundredths ? "-" : "", (unsigned long long)(hundredths / 100));
    if (hundredths % 100)
        mcr_text_printf(text, hundredths % 10 ? ".%02llu" : ".%.1llu", (unsigned long long)(hundredths % 10 ? hundredths % 100 :
                                                                                            hundredths % 100 / 10));
}
