/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Located diagnostics: everything below src/cli records what is wrong here and returns a status; only src/cli prints.
 *
 *   scene.scn:12:5: error: unknown setting 'raduis' in 'sphere', expected center, radius, material or transform
 *      12 |     raduis 3
 *         |     ^~~~~~
 *   scene.scn:12:5: note: did you mean 'radius'?
 *
 * Not thread-safe: used on the main thread.
 */
#ifndef MCR_BASE_DIAG_H
#define MCR_BASE_DIAG_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* One text that was read: a file, or an option of the command line (name "--sampler"). Owned by the diagnostics it was added to. */
struct mcr_source {
    const char *name;                    /* as it is shown */
    const char *text;                    /* length bytes, NUL-terminated */
    size_t length;
    const struct mcr_source *parent;     /* the including source, or NULL */
    uint32_t parent_line, parent_column; /* where it was included, 1-based */
    const struct mcr_source *earlier;    /* the one that was added before it, or NULL */
};

/* A stretch of one line. source NULL: no place (the command line as a whole). line and column are 1-based; column counts bytes. */
struct mcr_place {
    const struct mcr_source *source;
    uint32_t line, column, length;
};

enum mcr_severity { MCR_NOTE, MCR_WARNING, MCR_ERROR };

struct mcr_diagnostics;

struct mcr_diagnostics *mcr_diagnostics_create(void);
void mcr_diagnostics_destroy(struct mcr_diagnostics *diagnostics);
/* Warnings recorded from now on are errors. */
void mcr_diagnostics_werror(struct mcr_diagnostics *diagnostics, int on);
/* Takes a copy of name and text. NULL when memory is short. */
const struct mcr_source *mcr_diagnostics_source(struct mcr_diagnostics *diagnostics, const char *name, const char *text, size_t length,
                                                const struct mcr_place *included_from);
/* The one that was added last, or NULL. */
const struct mcr_source *mcr_diagnostics_last_source(const struct mcr_diagnostics *diagnostics);
/* Records a message (printf format). A note belongs to the message before it. Past 100 errors the rest is only counted. */
void mcr_report(struct mcr_diagnostics *diagnostics, enum mcr_severity severity, struct mcr_place place, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
uint32_t mcr_diagnostics_errors(const struct mcr_diagnostics *diagnostics);
uint32_t mcr_diagnostics_warnings(const struct mcr_diagnostics *diagnostics);
/* Prints what was recorded since the last call, in order of recording, with line, caret and chain of includes. colour: ANSI colours. */
void mcr_diagnostics_print(struct mcr_diagnostics *diagnostics, FILE *to, int colour);

/* The nearest of `count` words by Damerau-Levenshtein distance, or NULL if none is close (distance at most a third of the length, at least 1). */
const char *mcr_nearest_word(const char *word, const char *const *words, size_t count);

/* Length of the well-formed UTF-8 sequence at `at` < end, 1 to 4, or 0 (RFC 3629: no surrogates, no overlong forms). */
size_t mcr_utf8_length(const char *at, const char *end);

#endif
