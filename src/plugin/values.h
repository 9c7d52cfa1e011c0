/* SPDX-License-Identifier: Apache-2.0 */
/* Parameter tables at work: settings of the text become a plugin's values. Main thread. mcr_value_check is in plugin/node.h. */
#ifndef MCR_PLUGIN_VALUES_H
#define MCR_PLUGIN_VALUES_H

#include "base/arena.h"
#include "base/diag.h"
#include "language/tree.h"
#include <mcrender/plugin.h>

#define MCR_MAX_PARAMETERS 64u
#define MCR_MAX_CHOICES 64u
#define MCR_MAX_OTHERS 16u     /* settings that a block takes beside its plugin's */
#define MCR_MAX_WORD 64u /* bytes of a word, without its NUL */

/* One `name value` of a block or `name=value` of a call. */
struct mcr_setting {
    const char *name;
    struct mcr_place place; /* of the name */
    const struct mcr_value *value;
};

struct mcr_texture; /* src/scene makes and reads them; here they are handed on */
struct mcr_node;

/* A texture in the place of a value: what it lies between, and its mean; of a number, in the first component. */
struct mcr_varying {
    const struct mcr_texture *texture;
    double min[3], max[3], mean[3];
};

/* What names in a material may stand for beside what the language knows, and what a material takes beside its plugin's parameters. */
struct mcr_value_names {
    void *data;
    const char *const *word;  /* other settings, for suggestions */
    uint32_t word_count;
    /* Returns 1 and fills `out` where a texture has the value's name, which is used from then on; else 0, and tells nothing. */
    int (*texture)(void *data, const struct mcr_value *value, uint32_t type, struct mcr_varying *out);
    /* A name that is near, or NULL. */
    const char *(*near_texture)(void *data, const char *name);
    /* The instance of the material that the value names, made at need; NULL after an error that was recorded. */
    struct mcr_node *(*material)(void *data, const struct mcr_value *value);
};

/* What is left of values that are no numbers, by parameter; NULL where there is none. */
struct mcr_named_values {
    const struct mcr_texture **texture; /* NULL: no value is a texture */
    uint32_t child_count;
    struct mcr_node *child[MCR_MAX_CHILDREN]; /* materials, in the order of the text; the parameters hold their places */
};

/*
 * Fills `values` (arena) from settings: checked, defaults where nothing is given. place: the word itself, for what is missing; damaged:
 * settings were lost to mistakes that were told, so that nothing is said of what is missing.
 * Returns 0, or -1 after all mistakes were recorded.
 */
int mcr_values_read(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const struct mcr_descriptor *descriptor,
                    const struct mcr_setting *setting, uint32_t count, struct mcr_place place, int damaged,
                    struct mcr_values *values);
/* The same where names may stand for textures (whose means are in `values`) and materials. */
int mcr_values_read_named(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const struct mcr_descriptor *descriptor,
                          const struct mcr_setting *setting, uint32_t count, struct mcr_place place, int damaged,
                          const struct mcr_value_names *names, struct mcr_values *values, struct mcr_named_values *named);

/* What a value stands for: names that a `let` gives a value are followed to it. */
const struct mcr_value *mcr_value_resolve(const struct mcr_value *value);
/* "a number", "a tuple", … for messages. */
const char *mcr_value_kind_name(const struct mcr_value *value);

/* Parameter k < parameter_count; the table's elements may be larger than this host's structure. */
const struct mcr_parameter *mcr_descriptor_parameter(const struct mcr_descriptor *descriptor, uint32_t k);
/* The number of words in "one|two", and word k copied to `word` (of MCR_MAX_WORD + 1 bytes; longer ones are cut). */
uint32_t mcr_choice_count(const char *choices);
void mcr_choice_word(const char *choices, uint32_t k, char word[MCR_MAX_WORD + 1]);

/* "0 to 1", "at least 0", "above 0 and at most 180 degrees"; "a finite number" without bounds. */
void mcr_range_text(const struct mcr_parameter *parameter, char *text, size_t length);
/* A value in the scene's syntax, exact: 0.1, 3, (0.1, 0.2, 0.3), area. */
void mcr_value_text(const struct mcr_parameter *parameter, const double number[3], char *text, size_t length);
/* Appends the shortest decimal that reads back as the same double. */
void mcr_text_number(char *text, size_t length, double number);
/* Appends to text[length], cutting what does not fit. */
void mcr_text_append(char *text, size_t length, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* Appends word k of `count` to a list in prose: "a, b or c" over three calls. */
void mcr_text_list(char *text, size_t length, const char *word, uint32_t k, uint32_t count);

#endif
