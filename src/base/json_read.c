/* SPDX-License-Identifier: Apache-2.0 */
/* The JSON reader: recursive descent, bounded by MCR_JSON_DEPTH; the first error ends it. */
#include "base/json.h"

#include <limits.h>
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

struct reader {
    struct mcr_arena *arena;
    struct mcr_diagnostics *diagnostics;
    const struct mcr_source *source;
    const char *at, *end, *line_start;
    uint32_t line, depth;
};

size_t mcr_utf8_sequence(const char *text, size_t length)
{
    const unsigned char *s = (const unsigned char *)text;
    unsigned low = 0x80, high = 0xbf; /* limits of the second byte: no overlong forms, no surrogates, nothing above U+10FFFF */
    size_t size;

    if (!length || (s[0] >= 0x80 && s[0] < 0xc2) || s[0] > 0xf4)
        return 0;
    if (s[0] < 0x80)
        return 1;
    size = s[0] < 0xe0 ? 2 : s[0] < 0xf0 ? 3 : 4;
    low = s[0] == 0xe0 ? 0xa0 : s[0] == 0xf0 ? 0x90 : low;
    high = s[0] == 0xed ? 0x9f : s[0] == 0xf4 ? 0x8f : high;
    if (length < size || s[1] < low || s[1] > high)
        return 0;
    for (size_t i = 2; i < size; i++)
        if ((s[i] & 0xc0) != 0x80)
            return 0;
    return size;
}

static struct mcr_place place_of(const struct reader *reader, const char *at, const char *end)
{
    ptrdiff_t column = at - reader->line_start + 1, length = end - at;
    return (struct mcr_place){reader->source, reader->line, (uint32_t)(column < UINT32_MAX ? column : UINT32_MAX),
                              (uint32_t)(length < 1 ? 1 : length < UINT32_MAX ? length : UINT32_MAX)};
}

static void *fail(struct reader *reader, const char *at, const char *end, const char *message)
{
    mcr_report(reader->diagnostics, MCR_ERROR, place_of(reader, at, end), "%s", message);
    return NULL;
}

static void *no_memory(struct reader *reader)
{
    return fail(reader, reader->at, reader->at, "not enough memory for this JSON text");
}

static void skip_blanks(struct reader *reader)
{
    for (; reader->at < reader->end; reader->at++) {
        if (*reader->at == '\n') {
            reader->line++;
            reader->line_start = reader->at + 1;
        } else if (*reader->at != ' ' && *reader->at != '\t' && *reader->at != '\r') {
            return;
        }
    }
}

/* The next byte, or -1 at the end. */
static int peek(const struct reader *reader)
{
    return reader->at < reader->end ? (unsigned char)*reader->at : -1;
}

/* ---- texts ---- */

/* Four hexadecimal digits, or -1. */
static int32_t hexadecimal(const char *at, const char *end)
{
    int32_t value = 0;
    if (end - at < 4)
        return -1;
    for (int i = 0; i < 4; i++) {
        unsigned c = (unsigned char)at[i], digit = c - '0';
        if (digit > 9) {
            digit = (c | 32) - 'a' + 10;
            if (digit < 10 || digit > 15)
                return -1;
        }
        value = value * 16 + (int32_t)digit;
    }
    return value;
}

static size_t encode_utf8(uint32_t code, char *out)
{
    if (code < 0x80) {
        out[0] = (char)code;
        return 1;
    }
    if (code < 0x800) {
        out[0] = (char)(0xc0 | code >> 6);
        out[1] = (char)(0x80 | (code & 63));
        return 2;
    }
    if (code < 0x10000) {
        out[0] = (char)(0xe0 | code >> 12);
        out[1] = (char)(0x80 | (code >> 6 & 63));
        out[2] = (char)(0x80 | (code & 63));
        return 3;
    }
    out[0] = (char)(0xf0 | code >> 18);
    out[1] = (char)(0x80 | (code >> 12 & 63));
    out[2] = (char)(0x80 | (code >> 6 & 63));
    out[3] = (char)(0x80 | (code & 63));
    return 4;
}

/* One escape from the backslash on; writes up to 4 bytes (never more than it reads). Bytes read, or 0 after an error. */
static size_t read_escape(struct reader *reader, const char *at, char *out, size_t *written)
{
    static const char letters[] = "\"\\/bfnrt", meanings[] = "\"\\/\b\f\n\r\t";
    const char *letter = at + 1 < reader->end && at[1] ? strchr(letters, at[1]) : NULL;
    int32_t code, low;

    if (letter) {
        *out = meanings[letter - letters];
        *written = 1;
        return 2;
    }
    if (at + 1 >= reader->end || at[1] != 'u') {
        fail(reader, at, at + 2, "unknown escape, expected \\\" \\\\ \\/ \\b \\f \\n \\r \\t or \\uXXXX");
        return 0;
    }
    code = hexadecimal(at + 2, reader->end);
    if (code < 0) {
        fail(reader, at, at + 2, "expected four hexadecimal digits after \\u");
        return 0;
    }
    if (code < 0xd800 || code > 0xdfff) {
        *written = encode_utf8((uint32_t)code, out);
        return 6;
    }
    low = code < 0xdc00 && reader->end - at >= 12 && at[6] == '\\' && at[7] == 'u' ? hexadecimal(at + 8, reader->end) : -1;
    if (low < 0xdc00 || low > 0xdfff) {
        fail(reader, at, at + 6, "half of a surrogate pair, expected two \\u escapes for a character above U+FFFF");
        return 0;
    }
    *written = encode_utf8(0x10000u + ((uint32_t)(code - 0xd800) << 10) + (uint32_t)(low - 0xdc00), out);
    return 12;
}

/* Where the closing quote must be: past it nothing is read. NULL after an error. */
static const char *find_quote(struct reader *reader)
{
    const char *at = reader->at + 1;
    while (at < reader->end && *at != '"') {
        if ((unsigned char)*at < 0x20)
            return fail(reader, at, at, *at == '\n' ? "this line ends within a text: expected '\"' before, or \\n for a line break"
                                                    : "control character in a text, expected \\u00XX");
        at += *at == '\\' && at + 1 < reader->end && (unsigned char)at[1] >= 0x20 ? 2 : 1;
    }
    if (at >= reader->end)
        return fail(reader, reader->at, reader->at, "this text has no end, expected '\"'");
    return at;
}

/* A text in quotes, unescaped: never longer than it was. */
static const char *read_text(struct reader *reader, size_t *length)
{
    const char *quote = find_quote(reader), *at = reader->at + 1;
    char *text = quote ? mcr_arena_alloc(reader->arena, (size_t)(quote - at) + 1, 1) : NULL;
    size_t used = 0, step, written;

    if (!text)
        return quote ? no_memory(reader) : NULL;
    while (at < quote) {
        if (*at == '\\') {
            step = read_escape(reader, at, text + used, &written);
            if (!step)
                return NULL;
            at += step;
            used += written;
            continue;
        }
        step = mcr_utf8_sequence(at, (size_t)(quote - at));
        if (!step)
            return fail(reader, at, at, "this byte is not UTF-8");
        memcpy(text + used, at, step);
        at += step;
        used += step;
    }
    reader->at = quote + 1;
    *length = used;
    return text;
}

/* ---- numbers and words ---- */

static const char *skip_digits(const char *at, const char *end)
{
    while (at < end && *at >= '0' && *at <= '9')
        at++;
    return at;
}

/* The end of the number at `at`, or NULL if the grammar has none there: -? (0 | [1-9][0-9]*) (.[0-9]+)? ([eE][+-]?[0-9]+)? */
static const char *number_end(const char *at, const char *end)
{
    const char *digits = at < end && *at == '-' ? at + 1 : at, *after = skip_digits(digits, end);
    if (after == digits || (*digits == '0' && after > digits + 1))
        return NULL;
    if (after < end && *after == '.') {
        digits = after + 1;
        after = skip_digits(digits, end);
        if (after == digits)
            return NULL;
    }
    if (after < end && (*after | 32) == 'e') {
        digits = after + 1 + (after + 1 < end && (after[1] == '+' || after[1] == '-'));
        after = skip_digits(digits, end);
        if (after == digits)
            return NULL;
    }
    return after;
}

static int is_word(int c)
{
    return (c >= '0' && c <= '9') || ((c | 32) >= 'a' && (c | 32) <= 'z') || c == '.' || c == '+' || c == '-' || c == '_';
}

/* The end of what looks like one word, for messages and to refuse "truely" and "1.5.2". */
static const char *word_end(const struct reader *reader)
{
    const char *at = reader->at;
    while (at < reader->end && is_word((unsigned char)*at))
        at++;
    return at;
}

static int read_number(struct reader *reader, struct mcr_json *value)
{
    const char *after = number_end(reader->at, reader->end), *end = word_end(reader), *point = localeconv()->decimal_point;
    char *text, *dot;

    if (!after || after != end) {
        fail(reader, reader->at, end, "malformed number, expected digits as in -12.5e-3");
        return 0;
    }
    text = mcr_arena_text(reader->arena, reader->at, (size_t)(after - reader->at));
    if (!text) {
        no_memory(reader);
        return 0;
    }
    dot = strchr(text, '.');
    if (dot)
        *dot = point[0]; /* strtod follows the locale */
    value->number = strtod(text, NULL);
    if (dot)
        *dot = '.';
    if (!isfinite(value->number)) {
        fail(reader, reader->at, end, "number out of range, expected a magnitude below 1.8e308");
        return 0;
    }
    value->kind = MCR_JSON_NUMBER;
    value->text = text;
    value->length = (size_t)(after - reader->at);
    reader->at = after;
    return 1;
}

static int read_word(struct reader *reader, struct mcr_json *value)
{
    static const struct {
        const char *word;
        uint32_t kind, boolean;
    } words[] = {{"null", MCR_JSON_NULL, 0}, {"false", MCR_JSON_BOOLEAN, 0}, {"true", MCR_JSON_BOOLEAN, 1}};
    const char *end = word_end(reader);
    size_t length = (size_t)(end - reader->at);

    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strlen(words[i].word) == length && !memcmp(words[i].word, reader->at, length)) {
            value->kind = words[i].kind;
            value->boolean = words[i].boolean;
            reader->at = end;
            return 1;
        }
    fail(reader, reader->at, end, "expected a value: an object, an array, a text in double quotes, a number, true, false or null");
    return 0;
}

/* ---- objects and arrays ---- */

static int compare_members(const void *left, const void *right)
{
    const struct mcr_json *a = *(struct mcr_json *const *)left, *b = *(struct mcr_json *const *)right;
    int order = memcmp(a->key, b->key, a->key_length < b->key_length ? a->key_length : b->key_length);
    if (order || a->key_length != b->key_length)
        return order ? order : a->key_length < b->key_length ? -1 : 1;
    if (a->key_place.line != b->key_place.line)
        return a->key_place.line < b->key_place.line ? -1 : 1;
    return a->key_place.column < b->key_place.column ? -1 : 1;
}

/* Refuses duplicate keys, by sorting: an object of a million keys shall not take hours. */
static int check_keys(struct reader *reader, const struct mcr_json *object)
{
    struct mcr_json **members = object->count > 1 ? calloc(object->count, sizeof *members) : NULL, *member = object->first;
    int distinct = 1;

    if (object->count < 2)
        return 1;
    if (!members) {
        no_memory(reader);
        return 0;
    }
    for (size_t i = 0; i < object->count; i++, member = member->next)
        members[i] = member;
    qsort(members, object->count, sizeof *members, compare_members);
    for (size_t i = 1; i < object->count && distinct; i++) {
        const struct mcr_json *a = members[i - 1], *b = members[i];
        if (a->key_length != b->key_length || memcmp(a->key, b->key, a->key_length))
            continue;
        mcr_report(reader->diagnostics, MCR_ERROR, b->key_place, "duplicate key, expected each key once in an object");
        mcr_report(reader->diagnostics, MCR_NOTE, a->key_place, "it stands here already");
        distinct = 0;
    }
    free(members);
    return distinct;
}

static struct mcr_json *read_value(struct reader *reader);

/* One member or element with what stands before its value. */
static struct mcr_json *read_item(struct reader *reader, int in_object)
{
    const char *key = NULL;
    size_t key_length = 0;
    struct mcr_place key_place = {NULL, 0, 0, 0};
    struct mcr_json *item;

    if (in_object) {
        const char *start = reader->at;
        if (peek(reader) != '"')
            return fail(reader, reader->at, word_end(reader), "expected a key in double quotes");
        key = read_text(reader, &key_length);
        if (!key)
            return NULL;
        key_place = place_of(reader, start, reader->at);
        skip_blanks(reader);
        if (peek(reader) != ':')
            return fail(reader, reader->at, reader->at, "expected ':' after the key");
        reader->at++;
        skip_blanks(reader);
    }
    item = read_value(reader);
    if (item) {
        item->key = key;
        item->key_length = key_length;
        item->key_place = key_place;
    }
    return item;
}

static int read_items(struct reader *reader, struct mcr_json *value, int in_object)
{
    const char close = in_object ? '}' : ']';
    struct mcr_json **link = &value->first;

    value->kind = in_object ? MCR_JSON_OBJECT : MCR_JSON_ARRAY;
    reader->at++;
    skip_blanks(reader);
    if (peek(reader) == close) {
        reader->at++;
        return 1;
    }
    for (;;) {
        *link = read_item(reader, in_object);
        if (!*link)
            return 0;
        link = &(*link)->next;
        value->count++;
        skip_blanks(reader);
        if (peek(reader) == close)
            break;
        if (peek(reader) == -1) {
            mcr_report(reader->diagnostics, MCR_ERROR, value->place, "this %s has no end, expected '%c'", in_object ? "object" : "array", close);
            return 0;
        }
        if (peek(reader) != ',') {
            fail(reader, reader->at, reader->at, in_object ? "expected ',' or '}'" : "expected ',' or ']'");
            return 0;
        }
        reader->at++;
        skip_blanks(reader);
    }
    reader->at++;
    return !in_object || check_keys(reader, value);
}

static struct mcr_json *read_value(struct reader *reader)
{
    struct mcr_json *value = mcr_arena_alloc(reader->arena, 1, sizeof *value);
    const char *start = reader->at;
    int c = peek(reader), good = 0;

    if (!value)
        return no_memory(reader);
    value->place = place_of(reader, start, start);
    if (c == '{' || c == '[') {
        if (reader->depth == MCR_JSON_DEPTH)
            return fail(reader, start, start, "nested too deeply, expected at most 64 objects and arrays within each other");
        reader->depth++;
        good = read_items(reader, value, c == '{');
        reader->depth--;
        return good ? value : NULL;
    }
    if (c == '"') {
        value->kind = MCR_JSON_TEXT;
        value->text = read_text(reader, &value->length);
        good = value->text != NULL;
    } else if (c == '-' || (c >= '0' && c <= '9')) {
        good = read_number(reader, value);
    } else {
        good = read_word(reader, value);
    }
    value->place = place_of(reader, start, reader->at);
    return good ? value : NULL;
}

struct mcr_json *mcr_json_parse(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const struct mcr_source *source)
{
    struct reader reader = {.arena = arena, .diagnostics = diagnostics, .source = source, .at = source->text, .end = source->text + source->length,
                            .line_start = source->text, .line = 1};
    struct mcr_json *root;

    if (source->length >= 3 && !memcmp(source->text, "\xef\xbb\xbf", 3))
        return fail(&reader, reader.at, reader.at, "byte order mark, expected plain UTF-8 without one");
    skip_blanks(&reader);
    root = read_value(&reader);
    if (!root)
        return NULL;
    skip_blanks(&reader);
    if (reader.at < reader.end)
        return fail(&reader, reader.at, word_end(&reader), "text after the end of the value");
    return root;
}

struct mcr_json *mcr_json_get(const struct mcr_json *value, const char *key)
{
    size_t length = strlen(key);
    struct mcr_json *member = value && value->kind == MCR_JSON_OBJECT ? value->first : NULL;
    while (member && (member->key_length != length || memcmp(member->key, key, length)))
        member = member->next;
    return member;
}
