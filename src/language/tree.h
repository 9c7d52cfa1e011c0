/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The located tree that scene text is parsed into. Arithmetic, `let`, `include`, srgb(), hex() and blackbody() are gone from it: numbers
 * are evaluated. What words mean is not known here (src/scene checks that), except which words open blocks.
 * Immutable after parsing; lives in the arena given to the parser.
 */
#ifndef MCR_LANGUAGE_TREE_H
#define MCR_LANGUAGE_TREE_H

#include "base/arena.h"
#include "base/diag.h"

enum mcr_value_kind {
    MCR_VALUE_NUMBER, /* number; finite */
    MCR_VALUE_TUPLE,  /* ( a, b, … ): item[count], numbers, tuples and strings, in some blocks names and calls, too; a colour from srgb(), hex() or blackbody() is a tuple of 3 numbers */
    MCR_VALUE_STRING, /* text */
    MCR_VALUE_NAME,   /* a bare word: text. Where a `let` of that name is in force, `bound` is its value: NUMBER, TUPLE, STRING or ERROR */
    MCR_VALUE_CALL,   /* text ( argument, … ): argument[count] */
    MCR_VALUE_ERROR   /* could not be read, which was reported: stands for any value, take it without another message */
};

/* 64 bytes: the numbers of a mesh are so many of these. */
struct mcr_value {
    enum mcr_value_kind kind;
    uint32_t count;
    struct mcr_place place;
    double number;
    const char *text;
    union {
        const struct mcr_value *item;          /* MCR_VALUE_TUPLE */
        const struct mcr_argument *argument;   /* MCR_VALUE_CALL */
    };
    const struct mcr_value *bound;             /* MCR_VALUE_NAME, or NULL; NULL in every other kind */
};

/* `name=value`, or a child with an optional weight: name is NULL then. */
struct mcr_argument {
    const char *name;
    struct mcr_place name_place;
    struct mcr_value value;
    int has_weight;
    struct mcr_value weight; /* a number */
};

/* One thing in a block, in the order of the text: a setting `word value` or a block `word [name] [kind] { … }`. */
struct mcr_item {
    uint8_t is_block;
    uint8_t damaged;             /* block: something in it was left out after a mistake that was reported; what is missing is no second one */
    uint32_t count;              /* block: of item */
    const char *word;
    struct mcr_place place;      /* of the word */
    struct mcr_value value;      /* setting */
    const char *name;            /* block, or NULL */
    struct mcr_place name_place;
    const char *kind;            /* block, or NULL */
    struct mcr_place kind_place;
    const struct mcr_item *item; /* block: its content */
};

#define MCR_SOURCE_LIMIT (64u << 20) /* bytes, all includes together */
#define MCR_NESTING_LIMIT 64u        /* of blocks, brackets and expressions together */
#define MCR_INCLUDE_LIMIT 16u

/* `let` values set from outside: `--set NAME=VALUE`. The text is parsed as an expression; unknown names are errors. */
struct mcr_definition {
    const char *name;
    const char *text;
    int used; /* set by the parser */
};

/*
 * Parses a scene file ("-": standard input) and all it includes into the root block (word "", no name or kind).
 * Mistakes are recorded and parsing goes on. Returns NULL only if there is nothing to go on with (unreadable file, another format
 * version, no memory, more than a thousand mistakes).
 * A tree that comes with errors may be checked further but not rendered.
 */
const struct mcr_item *mcr_parse_file(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const char *path,
                                      struct mcr_definition *definitions, uint32_t definition_count);
/* The same from memory; relative includes are resolved against `directory`. */
const struct mcr_item *mcr_parse_text(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const char *name, const char *directory,
                                      const char *text, size_t length, struct mcr_definition *definitions, uint32_t definition_count);
/* One value, as on the command line: name is the option's, e.g. "--sampler". NULL after an error. */
const struct mcr_value *mcr_parse_value(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const char *name, const char *text);

/* One or more values with commas between them: a tuple, in which names and calls may stand; `(a, b)` is a tuple in it. NULL after an error. */
const struct mcr_value *mcr_parse_list(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const char *name, const char *text);

/* FNV-1a 64 over the bytes of all sources in the order they were read, and the definitions: identifies the scene in metadata. */
uint64_t mcr_parse_hash(const struct mcr_item *root);

#endif
