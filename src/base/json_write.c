/* SPDX-License-Identifier: Apache-2.0 */
#include "base/json.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct level {
    char close;  /* '}' or ']' */
    int has_any; /* a value stands in it already */
};

struct mcr_json_writer {
    FILE *to;
    char *text;
    size_t length, capacity;
    struct level levels[MCR_JSON_DEPTH];
    uint32_t depth;
    int failed, complete; /* complete: the value at the top has been begun */
};

struct mcr_json_writer *mcr_json_writer_create(FILE *to)
{
    struct mcr_json_writer *writer = calloc(1, sizeof *writer);
    if (writer)
        writer->to = to;
    return writer;
}

void mcr_json_writer_destroy(struct mcr_json_writer *writer)
{
    if (writer)
        free(writer->text);
    free(writer);
}

static void put(struct mcr_json_writer *writer, const char *text, size_t length)
{
    if (writer->failed)
        return;
    if (writer->to) {
        writer->failed = fwrite(text, 1, length, writer->to) != length;
        return;
    }
    if (length >= writer->capacity - writer->length) { /* one more for the NUL */
        size_t needed, capacity = writer->capacity ? writer->capacity : 1024;
        char *larger = NULL;
        if (!__builtin_add_overflow(writer->length, length + 1, &needed) && needed < PTRDIFF_MAX / 2) {
            while (capacity < needed)
                capacity *= 2;
            larger = realloc(writer->text, capacity);
        }
        if (!larger) {
            writer->failed = 1;
            return;
        }
        writer->text = larger;
        writer->capacity = capacity;
    }
    memcpy(writer->text + writer->length, text, length);
    writer->length += length;
    writer->text[writer->length] = '\0';
}

static void put_string(struct mcr_json_writer *writer, const char *string)
{
    put(writer, string, strlen(string));
}

static void new_line(struct mcr_json_writer *writer)
{
    put(writer, "\n", 1);
    for (uint32_t i = 0; i < writer->depth; i++)
        put(writer, "  ", 2);
}

/* The string between quotes. Runs that need no escape are written at once. */
static void put_quoted(struct mcr_json_writer *writer, const char *text)
{
    size_t length = strlen(text), start = 0, i = 0;

    put(writer, "\"", 1);
    while (i < length) {
        unsigned char c = (unsigned char)text[i];
        size_t sequence = mcr_utf8_sequence(text + i, length - i);
        char escape[8];
        if (sequence && c >= 0x20 && c != '"' && c != '\\' && c != 0x7f) {
            i += sequence;
            continue;
        }
        put(writer, text + start, i - start);
        if (!sequence)
            put_string(writer, "\xef\xbf\xbd"); /* U+FFFD */
        else if (c == '"' || c == '\\')
            put(writer, (char[]){'\\', (char)c}, 2);
        else if (c == '\n' || c == '\t' || c == '\r')
            put_string(writer, c == '\n' ? "\\n" : c == '\t' ? "\\t" : "\\r");
        else {
            snprintf(escape, sizeof escape, "\\u%04x", c);
            put_string(writer, escape);
        }
        start = ++i;
    }
    put(writer, text + start, length - start);
    put(writer, "\"", 1);
}

/* What stands before a value: comma, line break, key. Tells whether the value may stand here. */
static int begin_value(struct mcr_json_writer *writer, const char *key)
{
    struct level *level = writer->depth ? &writer->levels[writer->depth - 1] : NULL;
    int in_object = level && level->close == '}';

    if (in_object != (key != NULL) || (!level && writer->complete))
        writer->failed = 1;
    if (writer->failed)
        return 0;
    writer->complete = 1;
    if (level) {
        if (level->has_any)
            put(writer, ",", 1);
        level->has_any = 1;
        new_line(writer);
    }
    if (key) {
        put_quoted(writer, key);
        put(writer, ": ", 2);
    }
    return 1;
}

static void begin_level(struct mcr_json_writer *writer, const char *key, char open, char close)
{
    if (!begin_value(writer, key))
        return;
    if (writer->depth == MCR_JSON_DEPTH) {
        writer->failed = 1;
        return;
    }
    put(writer, &open, 1);
    writer->levels[writer->depth++] = (struct level){.close = close};
}

void mcr_json_begin_object(struct mcr_json_writer *writer, const char *key)
{
    begin_level(writer, key, '{', '}');
}

void mcr_json_begin_array(struct mcr_json_writer *writer, const char *key)
{
    begin_level(writer, key, '[', ']');
}

void mcr_json_end(struct mcr_json_writer *writer)
{
    struct level *level;
    if (!writer->depth)
        writer->failed = 1;
    if (writer->failed)
        return;
    level = &writer->levels[--writer->depth];
    if (level->has_any)
        new_line(writer);
    put(writer, &level->close, 1);
}

static void put_value(struct mcr_json_writer *writer, const char *key, const char *value)
{
    if (begin_value(writer, key))
        put_string(writer, value);
}

void mcr_json_text(struct mcr_json_writer *writer, const char *key, const char *text)
{
    if (!text)
        mcr_json_null(writer, key);
    else if (begin_value(writer, key))
        put_quoted(writer, text);
}

void mcr_json_format(double number, char text[MCR_JSON_NUMBER_SIZE])
{
    char *comma;
    if (!isfinite(number)) {
        strcpy(text, "null");
        return;
    }
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, MCR_JSON_NUMBER_SIZE, "%.*g", digits, number);
        if (strtod(text, NULL) == number)
            break;
    }
    comma = strchr(text, ','); /* the decimal point of some locales */
    if (comma)
        *comma = '.';
}

void mcr_json_number(struct mcr_json_writer *writer, const char *key, double number)
{
    char text[MCR_JSON_NUMBER_SIZE];
    mcr_json_format(number, text);
    put_value(writer, key, text);
}

void mcr_json_numbers(struct mcr_json_writer *writer, const char *key, const double *numbers, size_t count)
{
    char text[MCR_JSON_NUMBER_SIZE];
    if (!begin_value(writer, key))
        return;
    put(writer, "[", 1);
    for (size_t i = 0; i < count; i++) {
        mcr_json_format(numbers[i], text);
        put_string(writer, i ? ", " : "");
        put_string(writer, text);
    }
    put(writer, "]", 1);
}

void mcr_json_integer(struct mcr_json_writer *writer, const char *key, int64_t number)
{
    char text[32];
    snprintf(text, sizeof text, "%" PRId64, number);
    put_value(writer, key, text);
}

void mcr_json_unsigned(struct mcr_json_writer *writer, const char *key, uint64_t number)
{
    char text[32];
    snprintf(text, sizeof text, "%" PRIu64, number);
    put_value(writer, key, text);
}

void mcr_json_boolean(struct mcr_json_writer *writer, const char *key, int value)
{
    put_value(writer, key, value ? "true" : "false");
}

void mcr_json_null(struct mcr_json_writer *writer, const char *key)
{
    put_value(writer, key, "null");
}

int mcr_json_writer_finish(struct mcr_json_writer *writer)
{
    if (writer->depth || !writer->complete)
        writer->failed = 1;
    put(writer, "\n", 1);
    if (writer->to && fflush(writer->to))
        writer->failed = 1;
    return writer->failed ? -1 : 0;
}

const char *mcr_json_writer_text(const struct mcr_json_writer *writer, size_t *length)
{
    if (length)
        *length = writer->length;
    return writer->text;
}
