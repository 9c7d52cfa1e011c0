/* SPDX-License-Identifier: Apache-2.0 */
#include "base/diag.h"
#include "base/arena.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#define RECORD_LIMIT 100u  /* errors, and warnings, that are kept; the rest is only counted */
#define MESSAGE_LIMIT 2000 /* bytes of a message */
#define EXCERPT_LIMIT 120u /* bytes of a source line that are shown */
#define EXCERPT_LEAD 60u   /* of them at most before the column, in a longer line */
#define WORD_LIMIT 64u     /* longer words get no suggestion */

struct message {
    struct message *next;
    enum mcr_severity severity;
    struct mcr_place place;
    const char *text;
};

struct mcr_diagnostics {
    struct mcr_arena *arena;
    struct message *first, *last, *printed; /* printed: the last one that was */
    const struct mcr_source *last_source;
    const struct mcr_source *shown;         /* whose chain of includes was printed last */
    uint32_t errors, warnings, left_out, left_out_printed;
    int werror, skipping;                   /* skipping: the message before was only counted, and so are its notes */
};

struct mcr_diagnostics *mcr_diagnostics_create(void)
{
    struct mcr_diagnostics *diagnostics = calloc(1, sizeof *diagnostics);
    if (!diagnostics)
        return NULL;
    diagnostics->arena = mcr_arena_create(0);
    if (!diagnostics->arena) {
        free(diagnostics);
        return NULL;
    }
    return diagnostics;
}

void mcr_diagnostics_destroy(struct mcr_diagnostics *diagnostics)
{
    if (!diagnostics)
        return;
    mcr_arena_destroy(diagnostics->arena);
    free(diagnostics);
}

void mcr_diagnostics_werror(struct mcr_diagnostics *diagnostics, int on)
{
    diagnostics->werror = on;
}

const struct mcr_source *mcr_diagnostics_source(struct mcr_diagnostics *diagnostics, const char *name, const char *text, size_t length,
                                                const struct mcr_place *included_from)
{
    struct mcr_source *source = mcr_arena_alloc(diagnostics->arena, 1, sizeof *source);
    if (!source)
        return NULL;
    source->name = mcr_arena_text(diagnostics->arena, name, strlen(name));
    source->text = mcr_arena_text(diagnostics->arena, text, length);
    source->length = length;
    if (included_from) {
        source->parent = included_from->source;
        source->parent_line = included_from->line;
        source->parent_column = included_from->column;
    }
    if (!source->name || !source->text)
        return NULL;
    source->earlier = diagnostics->last_source;
    return diagnostics->last_source = source;
}

const struct mcr_source *mcr_diagnostics_last_source(const struct mcr_diagnostics *diagnostics)
{
    return diagnostics->last_source;
}

/* Whether the message is kept; counts it. */
static int counted(struct mcr_diagnostics *diagnostics, enum mcr_severity severity)
{
    uint32_t *count = severity == MCR_ERROR ? &diagnostics->errors : &diagnostics->warnings;
    if (severity == MCR_NOTE)
        return !diagnostics->skipping;
    *count += *count < UINT32_MAX;
    diagnostics->skipping = *count > RECORD_LIMIT;
    diagnostics->left_out += diagnostics->skipping && diagnostics->left_out < UINT32_MAX;
    return !diagnostics->skipping;
}

void mcr_report(struct mcr_diagnostics *diagnostics, enum mcr_severity severity, struct mcr_place place, const char *format, ...)
{
    char text[MESSAGE_LIMIT];
    struct message *message;
    va_list arguments;
    int made_error = severity == MCR_WARNING && diagnostics->werror, length;

    if (made_error)
        severity = MCR_ERROR;
    if (!counted(diagnostics, severity))
        return;
    va_start(arguments, format);
    length = vsnprintf(text, sizeof text - 16, format, arguments);
    va_end(arguments);
    if (length < 0)
        text[0] = '\0';
    else if ((size_t)length >= sizeof text - 16)
        strcat(text, "...");
    if (made_error)
        strcat(text, " [--werror]");
    message = mcr_arena_alloc(diagnostics->arena, 1, sizeof *message);
    if (!message)
        return;
    message->severity = severity;
    message->place = place;
    message->text = mcr_arena_text(diagnostics->arena, text, strlen(text));
    if (!message->text)
        message->text = "(no memory for the message)";
    if (diagnostics->last)
        diagnostics->last->next = message;
    else
        diagnostics->first = message;
    diagnostics->last = message;
}

uint32_t mcr_diagnostics_errors(const struct mcr_diagnostics *diagnostics)
{
    return diagnostics->errors;
}

uint32_t mcr_diagnostics_warnings(const struct mcr_diagnostics *diagnostics)
{
    return diagnostics->warnings;
}

/* ---- printing ---- */

size_t mcr_utf8_length(const char *at, const char *end)
{
    const unsigned char *b = (const unsigned char *)at;
    size_t length = b[0] < 0x80 ? 1 : b[0] >= 0xc2 && b[0] < 0xe0 ? 2 : (b[0] & 0xf0) == 0xe0 ? 3 : b[0] >= 0xf0 && b[0] < 0xf5 ? 4 : 0;
    if (!length || length > (size_t)(end - at))
        return 0;
    for (size_t i = 1; i < length; i++)
        if ((b[i] & 0xc0) != 0x80)
            return 0;
    if ((b[0] == 0xe0 && b[1] < 0xa0) || (b[0] == 0xed && b[1] > 0x9f) || (b[0] == 0xf0 && b[1] < 0x90) || (b[0] == 0xf4 && b[1] > 0x8f))
        return 0;
    return length;
}

/* Text from outside never reaches a terminal as it is: control characters and broken UTF-8 are shown as '?', one for each byte. */
static void print_clean(FILE *to, const char *text, size_t length)
{
    for (size_t i = 0; i < length;) {
        size_t wide = mcr_utf8_length(text + i, text + length);
        unsigned char byte = (unsigned char)text[i];
        if (wide > 1 && !(wide == 2 && byte == 0xc2 && (unsigned char)text[i + 1] < 0xa0)) { /* U+0080 to U+009F: control characters */
            fwrite(text + i, 1, wide, to);
            i += wide;
        } else {
            fputc(byte == '\t' || (byte >= 0x20 && byte < 0x7f) ? byte : '?', to);
            i++;
        }
    }
}

/* Columns that print_clean makes of the text, printed (if `to` is not NULL) as blanks that keep tabs; wide glyphs count as one. */
static uint32_t print_blank(FILE *to, const char *text, size_t length)
{
    uint32_t columns = 0;
    for (size_t i = 0; i < length; columns++) {
        size_t wide = mcr_utf8_length(text + i, text + length);
        if (to)
            fputc(text[i] == '\t' ? '\t' : ' ', to);
        i += wide ? wide : 1;
    }
    return columns;
}

/* The line without its end, or NULL if the source has no such line. A byte order mark is no part of line 1. */
static const char *find_line(const struct mcr_source *source, uint32_t line, size_t *length)
{
    const char *at = source->text, *end = source->text + source->length, *stop;
    if (source->length >= 3 && memcmp(at, "\xef\xbb\xbf", 3) == 0)
        at += 3;
    for (; line > 1; line--) {
        at = memchr(at, '\n', (size_t)(end - at));
        if (!at)
            return NULL;
        at++;
    }
    stop = memchr(at, '\n', (size_t)(end - at));
    if (!stop)
        stop = end;
    if (stop > at && stop[-1] == '\r')
        stop--;
    *length = (size_t)(stop - at);
    return at;
}

static size_t utf8_start(const char *text, size_t at)
{
    for (int back = 0; back < 3 && at > 0 && ((unsigned char)text[at] & 0xc0) == 0x80; back++)
        at--;
    return at;
}

/* The line, cut around the column if it is long, and a caret below. */
static void print_excerpt(FILE *to, const struct mcr_place *place, const char *colour, const char *plain)
{
    size_t length, from = 0, column = place->column ? place->column - 1 : 0, until, marked;
    const char *line = find_line(place->source, place->line, &length);
    if (!line)
        return;
    if (column > length)
        column = length;
    if (length > EXCERPT_LIMIT && column > EXCERPT_LEAD)
        from = utf8_start(line, column - EXCERPT_LEAD);
    until = length - from > EXCERPT_LIMIT ? utf8_start(line, from + EXCERPT_LIMIT) : length;
    marked = place->length < until - column ? place->length : until - column;

    fprintf(to, "%5u | %s", place->line, from ? "..." : "");
    print_clean(to, line + from, until - from);
    fprintf(to, "%s\n", until < length ? "..." : "");
    fprintf(to, "%*s | %s", place->line > 99999 ? snprintf(NULL, 0, "%u", place->line) : 5, "", from ? "   " : "");
    print_blank(to, line + from, column - from);
    fprintf(to, "%s^", colour);
    for (uint32_t columns = print_blank(NULL, line + column, marked); columns > 1; columns--)
        fputc('~', to);
    fprintf(to, "%s\n", plain);
}

static void print_chain(FILE *to, const struct mcr_source *source)
{
    for (; source && source->parent; source = source->parent) {
        fputs("in file included from ", to);
        print_clean(to, source->parent->name, strlen(source->parent->name));
        fprintf(to, ":%u:%u:\n", source->parent_line, source->parent_column);
    }
}

static int same_place(const struct mcr_place *a, const struct mcr_place *b)
{
    return a->source == b->source && a->line == b->line && a->column == b->column;
}

void mcr_diagnostics_print(struct mcr_diagnostics *diagnostics, FILE *to, int colour)
{
    static const char *const name[] = { "note", "warning", "error" }, *const ink[] = { "\033[36m", "\033[35m", "\033[31m" };
    const struct message *before = diagnostics->printed;
    struct message *message = diagnostics->printed ? diagnostics->printed->next : diagnostics->first;
    const char *bold = colour ? "\033[1m" : "", *plain = colour ? "\033[0m" : "";

    for (; message; before = message, message = message->next) {
        const struct mcr_place *place = &message->place;
        if (message->severity != MCR_NOTE && place->source && place->source != diagnostics->shown) {
            print_chain(to, place->source);
            diagnostics->shown = place->source;
        }
        fputs(bold, to);
        if (place->source) {
            print_clean(to, place->source->name, strlen(place->source->name));
            fprintf(to, ":%u:%u: ", place->line, place->column);
        }
        fprintf(to, "%s%s:%s ", colour ? ink[message->severity] : "", name[message->severity], plain);
        print_clean(to, message->text, strlen(message->text));
        fputc('\n', to);
        if (place->source && !(message->severity == MCR_NOTE && before && same_place(&before->place, place)))
            print_excerpt(to, place, colour ? ink[message->severity] : "", plain);
        diagnostics->printed = message;
    }
    if (diagnostics->left_out > diagnostics->left_out_printed) {
        uint32_t more = diagnostics->left_out - diagnostics->left_out_printed;
        fprintf(to, "%u more %s not shown\n", more, more == 1 ? "message is" : "messages are");
        diagnostics->left_out_printed = diagnostics->left_out;
    }
}

/* ---- suggestions ---- */

/* Damerau-Levenshtein distance (adjacent letters may change places, each letter is edited once), or more than `limit` if it is above it. */
static size_t distance(const char *a, size_t a_length, const char *b, size_t b_length, size_t limit)
{
    size_t rows[3][WORD_LIMIT + 1], *before = rows[0], *above = rows[1], *row = rows[2];
    if (a_length > b_length + limit || b_length > a_length + limit)
        return limit + 1;
    for (size_t j = 0; j <= b_length; j++)
        above[j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        size_t *spare = before;
        row[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            size_t best = above[j - 1] + (a[i - 1] != b[j - 1]);
            if (above[j] + 1 < best)
                best = above[j] + 1;
            if (row[j - 1] + 1 < best)
                best = row[j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && before[j - 2] + 1 < best)
                best = before[j - 2] + 1;
            row[j] = best;
        }
        before = above;
        above = row;
        row = spare;
    }
    return above[b_length];
}

const char *mcr_nearest_word(const char *word, const char *const *words, size_t count)
{
    size_t length = strlen(word), best = length / 3 > 1 ? length / 3 : 1;
    const char *nearest = NULL;
    if (length == 0 || length > WORD_LIMIT)
        return NULL;
    for (size_t i = 0; i < count; i++) {
        size_t other = strlen(words[i]), edits;
        if (other > WORD_LIMIT)
            continue;
        edits = distance(word, length, words[i], other, best);
        /* A word of which nothing is left is not near. */
        if (edits <= best && edits < (length > other ? length : other)) {
            if (!nearest || edits < best)
                nearest = words[i];
            if (edits == 0)
                return words[i];
            best = edits;
        }
    }
    return nearest;
}
