/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The parser's parts, for the files of this folder.
 *
 * lexer.c       bytes -> tokens
 * source.c      files -> text, and the chain of includes
 * names.c       words kept once, `let` names, definitions from outside, suggestions
 * value.c       values: tuples, strings, names, calls, colours
 * expression.c  arithmetic
 * recover.c     looking ahead and skipping after a mistake
 * parser.c      items, blocks, let, include; the entry points
 *
 * Mistakes. What is wrong is recorded where it is found. If the text can be read on from there, parsing goes on with an
 * MCR_VALUE_ERROR; if not, `panic` is set, everything returns up to the item, and mcr_recover skips to where the next one begins.
 * `fatal` (no memory, or too many mistakes) makes the lexer return TOKEN_END for ever.
 *
 * Depth of the C stack is bounded: every recursion passes mcr_enter, which stops at MCR_NESTING_LIMIT, and includes at MCR_INCLUDE_LIMIT.
 */
#ifndef MCR_LANGUAGE_INTERNAL_H
#define MCR_LANGUAGE_INTERNAL_H

#include "language/tree.h"
#include "language/words.h"

#include <string.h>
#include <sys/types.h>

#define MCR_WORD_LIMIT 255u                /* bytes of a word */
#define MCR_DIGIT_LIMIT 1000u              /* bytes of a number: enough for any double written exactly */
#define MCR_MISTAKE_LIMIT 1000u            /* where reading ends; far fewer are shown */
#define MCR_ARGUMENT_LIMIT (1u << 20)      /* arguments of all calls together: a bound on memory */

enum { TOKEN_END = 0, TOKEN_WORD = 256, TOKEN_NUMBER, TOKEN_STRING }; /* others: the character ( ) { } , = + - * / ^ */

struct mcr_token {
    int kind;
    uint32_t line, column, length; /* length in bytes, to the line's end at most */
    const char *text;              /* in the source; of a string without the quotes */
    uint32_t text_length;
    uint8_t first;                 /* the first on its line */
    uint8_t bad;                   /* wrong, which was reported */
    uint8_t after_stray;           /* bytes before it were refused */
    double number;
};

/* Copied to look ahead: everything that the next token depends on. */
struct mcr_lexer {
    const struct mcr_source *source;
    const char *at, *end, *line_start;
    uint32_t line;
    uint32_t square;     /* '[' read as '(' and not closed yet */
    int fresh;           /* nothing but blanks so far on this line */
    int lone_return;     /* a CR without LF was reported in this source */
};

/* A text being read. */
struct mcr_file {
    const struct mcr_file *parent;
    const struct mcr_source *source;
    const char *directory;     /* relative includes start here; "" for the current one */
    dev_t device;
    ino_t inode;
    int has_identity;          /* device and inode are known */
    int excess_known;
    int64_t excess;            /* '{' that have no '}' in this text (less than 0: the other way round) */
};

struct mcr_let {
    const char *name;
    struct mcr_place place;
    struct mcr_value value;
    uint32_t depth;            /* of nested tuples */
    int used;
    struct mcr_let *next;
};

/* A word, kept once. */
struct mcr_name {
    const char *text;
    uint32_t length, hash;
    struct mcr_let *let;
};

/* A growing array, of which each nesting level has its own. */
struct mcr_vector {
    void *data;
    size_t count, capacity;
};

struct mcr_parser {
    struct mcr_arena *arena;
    struct mcr_diagnostics *diagnostics;
    struct mcr_lexer lexer;
    struct mcr_token token;                /* the next one, not taken yet */
    uint32_t taken_line, taken_column;     /* behind the last one taken */
    const char *judged;                    /* lexical mistakes before this were reported: looking ahead twice tells them once */
    struct mcr_file *file;
    int quiet;                             /* looking ahead: report nothing */
    int panic, fatal;
    const char *expected_at;               /* the token before which a ',' was missing */
    uint32_t panic_brackets;               /* '(' that were open when panic was set */
    int item_first;                        /* the item being read began a line */
    unsigned words;                        /* MCR_WORDS_*: of the block whose setting is read */
    int incomplete;                        /* a text is missing: names may be defined there */
    uint32_t depth, deepest, brackets, include_depth;
    uint64_t total;                        /* bytes read */
    uint64_t hash;
    uint32_t arguments;
    struct mcr_vector items[MCR_NESTING_LIMIT + 2], values[MCR_NESTING_LIMIT + 2], call[MCR_NESTING_LIMIT + 2];
    struct mcr_name *names;                /* open addressing; name_room is a power of 2 */
    size_t name_count, name_room;
    struct mcr_let *first_let, *last_let;
    struct mcr_definition *definitions;
    struct mcr_value *defined;             /* their values */
    uint32_t *defined_depth;
    const struct mcr_source **defined_in;
    uint32_t definition_count;
};

/* A block while its content is read. */
struct mcr_block {
    const struct mcr_block *parent;
    const char *word;
    unsigned inside;
    struct mcr_place open;                 /* of '{' */
    uint32_t indent;                       /* column of its word, if that began a line; else 0 */
    const struct mcr_file *file;           /* where it was opened */
    uint32_t level;                        /* of its items among the vectors */
    unsigned words;                        /* of its form */
    int damaged, closed;                   /* closed: by the parser, as its '}' is missing */
    enum { MCR_AFTER_OTHER, MCR_AFTER_SETTING, MCR_AFTER_ERROR } after; /* what was read last; ERROR: a value that was wrong */
};

/* Where the lexer stands, to come back to. */
struct mcr_mark {
    struct mcr_lexer lexer;
    struct mcr_token token;
    uint32_t taken_line, taken_column;
};

/* lexer.c */
void mcr_lexer_start(struct mcr_lexer *lexer, const struct mcr_source *source, size_t offset);
void mcr_lex(struct mcr_parser *parser, struct mcr_lexer *lexer, struct mcr_token *token);
/* Takes the token. */
void mcr_next(struct mcr_parser *parser);
struct mcr_place mcr_token_place(const struct mcr_parser *parser, const struct mcr_token *token);
/* From `start` to the last token taken, if that is on the same line; else start alone. */
struct mcr_place mcr_span(const struct mcr_parser *parser, const struct mcr_place *start);
/* The token in words, for messages. */
const char *mcr_token_described(const struct mcr_token *token, char text[80]);
int mcr_token_is(const struct mcr_token *token, const char *word);
/* The text of a string with its escapes resolved; NULL when memory is short. */
const char *mcr_token_string(struct mcr_parser *parser, const struct mcr_token *token);
struct mcr_mark mcr_mark(const struct mcr_parser *parser);
void mcr_return_to(struct mcr_parser *parser, const struct mcr_mark *mark);

/* source.c: the text of a file, which becomes the diagnostics'. NULL after an error, reported at `place`. */
const struct mcr_source *mcr_source_read(struct mcr_parser *parser, const char *path, struct mcr_file *file, struct mcr_place place);
const struct mcr_source *mcr_source_add(struct mcr_parser *parser, const char *name, const char *text, size_t length, const struct mcr_place *place);
void mcr_hash(struct mcr_parser *parser, const char *bytes, size_t length);
/* Where `path` is, seen from the folder `directory`; in the arena. NULL when memory is short. */
const char *mcr_source_path(struct mcr_parser *parser, const char *directory, const char *path);
const char *mcr_source_directory(struct mcr_parser *parser, const char *path);

/* names.c */
/* The word's entry, which stays until the next call. NULL when memory is short (fatal is set). */
struct mcr_name *mcr_name(struct mcr_parser *parser, const char *text, uint32_t length);
const char *mcr_token_text(struct mcr_parser *parser, const struct mcr_token *token);
/* The `let` of this name or NULL; marks it used. */
struct mcr_let *mcr_let_use(struct mcr_parser *parser, const struct mcr_token *token);
int mcr_let_exists(struct mcr_parser *parser, const struct mcr_token *token);
void mcr_let_add(struct mcr_parser *parser, const char *name, struct mcr_place place, const struct mcr_value *value, uint32_t depth);
/* A word that has a meaning in expressions: function, constant or colour. */
int mcr_is_reserved(const char *word);
int mcr_is_near_function(const char *word);
/* Records that nothing is known as `word`, which should have been a number or a function, with what is near. */
void mcr_unknown_name(struct mcr_parser *parser, const char *what, const char *word, struct mcr_place place);
void mcr_suggest(struct mcr_parser *parser, struct mcr_place place, const char *word, const char *const *words, size_t count);
void mcr_definitions_read(struct mcr_parser *parser);
/* What is left at the end: names that nothing used, definitions that nothing took. */
void mcr_names_check(struct mcr_parser *parser);

/* value.c */
/* Any value: what a setting or a named argument takes. */
struct mcr_value mcr_value_read(struct mcr_parser *parser);
/* What a `let` takes: a number, a tuple or a string. */
struct mcr_value mcr_plain_value_read(struct mcr_parser *parser);
/* A value and nothing behind it, in a text of its own. plain: what a `let` takes. MCR_VALUE_ERROR after an error. */
struct mcr_value mcr_whole_value_read(struct mcr_parser *parser, int plain);
/* Values with commas between them and nothing behind: a tuple, which may hold names and calls. MCR_VALUE_ERROR after an error. */
struct mcr_value mcr_whole_list_read(struct mcr_parser *parser);
struct mcr_value mcr_primary(struct mcr_parser *parser);
struct mcr_value mcr_error_value(struct mcr_place place);
int mcr_begins_value(const struct mcr_token *token);
/* Makes a name that a `let` is bound to the value; a name without a `let`, or a call, is an error. */
void mcr_plain(struct mcr_parser *parser, struct mcr_value *value);
/* After an element of a list opened at `open`: MORE, or DONE with the bracket taken or, after an error, missing; SHORT: an element is missing. */
enum { MCR_LIST_MORE, MCR_LIST_DONE, MCR_LIST_SHORT };
int mcr_separator(struct mcr_parser *parser, struct mcr_place open);
/* Behind the '(' at `open` or a ',': whether an element stands here; if the text or the block ends instead, that is reported. */
int mcr_element_follows(struct mcr_parser *parser, struct mcr_place open);

/* expression.c */
struct mcr_value mcr_expression(struct mcr_parser *parser);
int mcr_is_function(const struct mcr_token *token);
/* `word (` was taken up to the word. */
struct mcr_value mcr_function(struct mcr_parser *parser, const struct mcr_token *word);
/* Whether the value is a number, or becomes one as its name is looked up; reports if not. */
int mcr_number(struct mcr_parser *parser, struct mcr_value *value);
/* The value, if it is finite; else an error. */
struct mcr_value mcr_finite(struct mcr_parser *parser, struct mcr_place place, double number, const char *otherwise);
int mcr_is_finite(double number);

/* recover.c */
int mcr_enter(struct mcr_parser *parser, struct mcr_place place); /* one level deeper; 0 and panic if that is too deep */
void mcr_leave(struct mcr_parser *parser);
void mcr_panic(struct mcr_parser *parser);
void mcr_fatal(struct mcr_parser *parser); /* no memory */
void mcr_recover(struct mcr_parser *parser, unsigned inside);
/* Whether `depth` open '(' are closed from the next token on, before a bracket of blocks, a `let` or the end. */
int mcr_brackets_close(struct mcr_parser *parser, uint32_t depth);
/* A word was taken: whether `[name] [kind] {` follows. */
int mcr_block_follows(struct mcr_parser *parser);
void mcr_skip_block(struct mcr_parser *parser); /* from '{' past its '}' */
/* '{' without '}' in the text being read. */
int64_t mcr_excess(struct mcr_parser *parser);
int mcr_vector_add(struct mcr_parser *parser, struct mcr_vector *vector, const void *element, size_t size);
/* The elements, which become the arena's. */
void *mcr_vector_take(struct mcr_parser *parser, struct mcr_vector *vector, size_t size);

#endif
