/* SPDX-License-Identifier: Apache-2.0 */
/* JSON (RFC 8259): a writer for reports, a strict reader for study files. */
#ifndef MCR_BASE_JSON_H
#define MCR_BASE_JSON_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/diag.h"

/* Nesting of objects and arrays, for both sides. */
#define MCR_JSON_DEPTH 64u

/* ---- writing ---- */

/*
 * Values are written in order; commas, line breaks and indentation come by themselves. `key` is given within an object and NULL
 * elsewhere. Failures (memory, the stream, a value out of place) are remembered: only mcr_json_writer_finish tells them.
 * Not thread-safe.
 */
struct mcr_json_writer;

/* Writes to `to`, which stays the caller's, or to a buffer where it is NULL. NULL when memory is short. */
struct mcr_json_writer *mcr_json_writer_create(FILE *to);
void mcr_json_writer_destroy(struct mcr_json_writer *writer);

void mcr_json_begin_object(struct mcr_json_writer *writer, const char *key);
void mcr_json_begin_array(struct mcr_json_writer *writer, const char *key);
/* Ends the innermost object or array. */
void mcr_json_end(struct mcr_json_writer *writer);

/* NUL-terminated UTF-8; NULL is null. A byte that is not UTF-8 becomes U+FFFD. */
void mcr_json_text(struct mcr_json_writer *writer, const char *key, const char *text);
/* The shortest decimal that reads back as the same double. NaN and infinities, which JSON lacks, become null. */
void mcr_json_number(struct mcr_json_writer *writer, const char *key, double number);
/* An array of numbers on one line. */
void mcr_json_numbers(struct mcr_json_writer *writer, const char *key, const double *numbers, size_t count);
/* In full; readers that hold numbers as doubles lose digits above 2^53. */
void mcr_json_integer(struct mcr_json_writer *writer, const char *key, int64_t number);
void mcr_json_unsigned(struct mcr_json_writer *writer, const char *key, uint64_t number);
void mcr_json_boolean(struct mcr_json_writer *writer, const char *key, int value);
void mcr_json_null(struct mcr_json_writer *writer, const char *key);

/* Ends the text with a newline. 0, or -1 if anything failed: memory or the stream (flushed here), a missing or needless key, an
 * unbalanced end, no or several values at the top, depth over MCR_JSON_DEPTH. */
int mcr_json_writer_finish(struct mcr_json_writer *writer);
/* After a finish without failure: the text, NUL-terminated, the writer's. NULL for a writer to a stream. */
const char *mcr_json_writer_text(const struct mcr_json_writer *writer, size_t *length);

/* number as mcr_json_number writes it ("null" for NaN and infinities), independent of the locale. */
#define MCR_JSON_NUMBER_SIZE 32
void mcr_json_format(double number, char text[MCR_JSON_NUMBER_SIZE]);

/* ---- reading ---- */

#define MCR_JSON_NULL 0u
#define MCR_JSON_BOOLEAN 1u
#define MCR_JSON_NUMBER 2u
#define MCR_JSON_TEXT 3u
#define MCR_JSON_ARRAY 4u
#define MCR_JSON_OBJECT 5u

/* One value; everything it points to lives in the arena. */
struct mcr_json {
    uint32_t kind;               /* MCR_JSON_* */
    uint32_t boolean;            /* 0 or 1 */
    double number;               /* finite */
    const char *text;            /* of a text: UTF-8, unescaped; of a number: as it was written (whole seeds up to 2^64) */
    size_t length;               /* of text, which is NUL-terminated besides; \u0000 may stand within */
    const char *key;             /* in an object, else NULL */
    size_t key_length;
    struct mcr_json *next;       /* the next element or member */
    struct mcr_json *first;      /* of an array or object; NULL if empty */
    size_t count;                /* elements or members */
    struct mcr_place place;      /* of the value */
    struct mcr_place key_place;
};

/*
 * Reads the whole source as one value. Strict: RFC 8259 without extensions, UTF-8 only, no byte order mark, no duplicate keys, no
 * lone surrogates, no numbers beyond the range of doubles, nesting up to MCR_JSON_DEPTH. NULL after one located error.
 * Takes some 130 bytes of the arena a value besides its key and text, up to 75 times the source: give the arena a limit.
 */
struct mcr_json *mcr_json_parse(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const struct mcr_source *source);
/* The member of an object, or NULL (also where `value` is NULL or no object). */
struct mcr_json *mcr_json_get(const struct mcr_json *value, const char *key);

/* Length in bytes, 1 to 4, of the valid UTF-8 sequence that text begins with; 0 if it does not. */
size_t mcr_utf8_sequence(const char *text, size_t length);

#endif
