/* SPDX-License-Identifier: Apache-2.0 */
/* Which words open blocks, where, and with which parts: `word [name] [kind] { … }`. The one thing that the parser knows about words. */
#ifndef MCR_LANGUAGE_WORDS_H
#define MCR_LANGUAGE_WORDS_H

#include <stddef.h>

/* Where a word stands: what is allowed in a block follows from the word that opened it. Bits, so that a form may be for several places. */
enum mcr_inside {
    MCR_INSIDE_SCENE = 1,    /* the top level */
    MCR_INSIDE_GROUP = 2,
    MCR_INSIDE_SHAPE = 4,
    MCR_INSIDE_SETTINGS = 8, /* blocks of settings alone */
    MCR_INSIDE_UNKNOWN = 16, /* a block that was refused: its content is read, but not judged */
    MCR_INSIDE_STUDY = 32
};

/* Words as values that are judged by the block, not where they are read: names and calls in tuples; `srgb` alone, which is a function elsewhere. */
enum { MCR_WORDS_TUPLES = 1, MCR_WORDS_SRGB = 2, MCR_WORDS_ALL = 3 };

struct mcr_block_form {
    const char *word;
    unsigned within;  /* where it may stand */
    unsigned inside;  /* what its content is */
    unsigned has_name, has_kind;
    unsigned is_single; /* a scene has one: where a bracket is missing, this word is outside of any group */
    unsigned words;     /* MCR_WORDS_* */
};

/* The form that `word` opens within `inside`, or NULL: it is a setting there, or nothing. */
const struct mcr_block_form *mcr_block_form(unsigned inside, const char *word);
/* The words that open blocks within `inside`, and `let` and `include`. Returns how many, at most `room`. */
size_t mcr_block_words(unsigned inside, const char **list, size_t room);

#endif
