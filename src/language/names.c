/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Words, kept once; `let` names; definitions from outside. A `let` is in force from its end on, through includes and blocks, and cannot
 * be given another value. It counts as used wherever its name stands as a value, also where that turns out to be a material's name: the
 * parser cannot know better, and a warning must not be wrong.
 */
#include "language/internal.h"

#include <stdlib.h>

#define SUGGESTION_ROOM 4096u /* names that are searched for a near one */

static uint32_t hash_of(const char *text, uint32_t length)
{
    uint32_t hash = 2166136261u;
    for (uint32_t i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)text[i]) * 16777619u;
    return hash;
}

static struct mcr_name *find(const struct mcr_parser *parser, const char *text, uint32_t length, uint32_t hash)
{
    size_t mask = parser->name_room - 1, i = hash & mask;
    for (; parser->names[i].text; i = (i + 1) & mask)
        if (parser->names[i].hash == hash && parser->names[i].length == length && memcmp(parser->names[i].text, text, length) == 0)
            break;
    return &parser->names[i];
}

static int grow(struct mcr_parser *parser)
{
    size_t room = parser->name_room ? parser->name_room * 2 : 256;
    struct mcr_name *old = parser->names, *names = calloc(room, sizeof *names);
    if (!names)
        return 0;
    for (size_t i = 0; i < parser->name_room; i++) {
        size_t j = old[i].hash & (room - 1);
        if (!old[i].text)
            continue;
        while (names[j].text)
            j = (j + 1) & (room - 1);
        names[j] = old[i];
    }
    free(old);
    parser->names = names;
    parser->name_room = room;
    return 1;
}

struct mcr_name *mcr_name(struct mcr_parser *parser, const char *text, uint32_t length)
{
    uint32_t hash = hash_of(text, length);
    struct mcr_name *name;
    if (parser->name_count >= parser->name_room - parser->name_room / 4 && !grow(parser)) {
        mcr_fatal(parser);
        return NULL;
    }
    name = find(parser, text, length, hash);
    if (!name->text) {
        char *copy = mcr_arena_text(parser->arena, text, length);
        if (!copy) {
            mcr_fatal(parser);
            return NULL;
        }
        *name = (struct mcr_name){ .text = copy, .length = length, .hash = hash };
        parser->name_count++;
    }
    return name;
}

const char *mcr_token_text(struct mcr_parser *parser, const struct mcr_token *token)
{
    const struct mcr_name *name = mcr_name(parser, token->text, token->text_length);
    return name ? name->text : "";
}

static struct mcr_let *let_of(const struct mcr_parser *parser, const struct mcr_token *token)
{
    if (!parser->name_room || token->kind != TOKEN_WORD)
        return NULL;
    return find(parser, token->text, token->text_length, hash_of(token->text, token->text_length))->let;
}

struct mcr_let *mcr_let_use(struct mcr_parser *parser, const struct mcr_token *token)
{
    struct mcr_let *let = let_of(parser, token);
    if (let)
        let->used = 1;
    return let;
}

int mcr_let_exists(struct mcr_parser *parser, const struct mcr_token *token)
{
    return let_of(parser, token) != NULL;
}

static const char *const reserved[] = { "abs", "blackbody", "cos", "hex", "include", "inf", "infinity", "let", "max", "mcrender",
                                        "min", "nan", "pi",  "sin",     "sqrt", "srgb",     "tan" };
static const char *const usable[] = { "abs", "blackbody", "cos", "hex", "max", "min", "pi", "sin", "sqrt", "srgb", "tan" };

int mcr_is_reserved(const char *word)
{
    for (size_t i = 0; i < sizeof reserved / sizeof reserved[0]; i++)
        if (strcmp(reserved[i], word) == 0)
            return 1;
    return 0;
}

int mcr_is_near_function(const char *word)
{
    return mcr_nearest_word(word, usable, sizeof usable / sizeof usable[0]) != NULL;
}

void mcr_suggest(struct mcr_parser *parser, struct mcr_place place, const char *word, const char *const *words, size_t count)
{
    const char *nearest = mcr_nearest_word(word, words, count);
    if (nearest)
        mcr_report(parser->diagnostics, MCR_NOTE, place, "did you mean '%s'?", nearest);
}

/* `a-b` is one word; where each side is a name, blanks were forgotten. */
static int is_difference(struct mcr_parser *parser, const char *word)
{
    const char *minus = strchr(word, '-');
    for (; minus; minus = strchr(minus + 1, '-')) {
        struct mcr_token left = { .kind = TOKEN_WORD, .text = word, .text_length = (uint32_t)(minus - word) };
        struct mcr_token right = { .kind = TOKEN_WORD, .text = minus + 1, .text_length = (uint32_t)strlen(minus + 1) };
        if ((mcr_let_exists(parser, &left) || mcr_token_is(&left, "pi")) && (mcr_let_exists(parser, &right) || mcr_token_is(&right, "pi"))) {
            mcr_let_use(parser, &left);
            mcr_let_use(parser, &right);
            return (int)(minus - word);
        }
    }
    return 0;
}

void mcr_unknown_name(struct mcr_parser *parser, const char *what, const char *word, struct mcr_place place)
{
    const char **words;
    size_t count = 0;
    int minus;

    if (parser->incomplete || parser->quiet)
        return;
    mcr_report(parser->diagnostics, MCR_ERROR, place, "unknown %s '%s'", what, word);
    minus = is_difference(parser, word);
    if (minus) {
        mcr_report(parser->diagnostics, MCR_NOTE, place, "'%s' is one word, a difference needs blanks: %.*s - %s", word, minus, word,
                   word + minus + 1);
        return;
    }
    words = mcr_diagnostics_errors(parser->diagnostics) > 100 ? NULL : malloc(SUGGESTION_ROOM * sizeof *words);
    if (!words)
        return;
    for (const struct mcr_let *let = parser->first_let; let && count < SUGGESTION_ROOM - 16; let = let->next)
        words[count++] = let->name;
    for (size_t i = 0; i < sizeof usable / sizeof usable[0]; i++)
        words[count++] = usable[i];
    mcr_suggest(parser, place, word, words, count);
    free(words);
}

/* The last definition of the name (as a later option overrides an earlier one), or -1. */
static int64_t definition_of(struct mcr_parser *parser, const char *name)
{
    int64_t found = -1;
    for (uint32_t i = 0; i < parser->definition_count; i++)
        if (strcmp(parser->definitions[i].name, name) == 0) {
            parser->definitions[i].used = 1;
            found = i;
        }
    return found;
}

void mcr_let_add(struct mcr_parser *parser, const char *name, struct mcr_place place, const struct mcr_value *value, uint32_t depth)
{
    struct mcr_name *entry = mcr_name(parser, name, (uint32_t)strlen(name));
    struct mcr_let *let;
    int64_t definition;

    if (!entry)
        return;
    if (entry->let) {
        mcr_report(parser->diagnostics, MCR_ERROR, place, "'%s' is defined already", name);
        mcr_report(parser->diagnostics, MCR_NOTE, entry->let->place, "the first definition is here");
        return;
    }
    let = mcr_arena_alloc(parser->arena, 1, sizeof *let);
    if (!let) {
        mcr_fatal(parser);
        return;
    }
    *let = (struct mcr_let){ .name = entry->text, .place = place, .value = *value, .depth = depth };
    definition = definition_of(parser, name);
    if (definition >= 0) {
        let->value = parser->defined[definition];
        let->depth = parser->defined_depth[definition];
    }
    entry->let = let;
    if (parser->last_let)
        parser->last_let->next = let;
    else
        parser->first_let = let;
    parser->last_let = let;
}

/* Definitions are read before the scene, as texts of their own in which no `let` is in force. */
void mcr_definitions_read(struct mcr_parser *parser)
{
    uint32_t count = parser->definition_count;
    parser->defined = mcr_arena_alloc(parser->arena, count, sizeof *parser->defined);
    parser->defined_in = mcr_arena_alloc(parser->arena, count, sizeof *parser->defined_in);
    parser->defined_depth = mcr_arena_alloc(parser->arena, count, sizeof *parser->defined_depth);
    if (!parser->defined || !parser->defined_in || !parser->defined_depth) {
        mcr_fatal(parser);
        return;
    }
    for (uint32_t i = 0; i < count && !parser->fatal; i++) {
        struct mcr_definition *definition = &parser->definitions[i];
        size_t name = strlen(definition->name), length = strlen(definition->text);
        char *text = mcr_arena_alloc(parser->arena, name + length + 2, 1);
        definition->used = 0;
        if (!text) {
            mcr_fatal(parser);
            return;
        }
        memcpy(text, definition->name, name);
        text[name] = '=';
        memcpy(text + name + 1, definition->text, length);
        parser->defined_in[i] = mcr_source_add(parser, "--set", text, name + 1 + length, NULL);
        if (!parser->defined_in[i])
            return;
        parser->judged = NULL;
        mcr_lexer_start(&parser->lexer, parser->defined_in[i], name + 1);
        mcr_next(parser);
        parser->deepest = 0;
        parser->defined[i] = mcr_whole_value_read(parser, 1);
        parser->defined_depth[i] = parser->deepest;
    }
}

void mcr_names_check(struct mcr_parser *parser)
{
    const char **words;
    size_t count = 0;

    if (parser->incomplete || parser->fatal)
        return;
    for (const struct mcr_let *let = parser->first_let; let; let = let->next)
        if (!let->used)
            mcr_report(parser->diagnostics, MCR_WARNING, let->place, "'%s' is defined but not used", let->name);
    words = malloc(SUGGESTION_ROOM * sizeof *words);
    for (const struct mcr_let *let = parser->first_let; let && words && count < SUGGESTION_ROOM; let = let->next)
        words[count++] = let->name;
    for (uint32_t i = 0; i < parser->definition_count; i++) {
        const struct mcr_definition *definition = &parser->definitions[i];
        struct mcr_place place = { parser->defined_in[i], 1, 1, (uint32_t)strlen(definition->name) };
        if (definition->used)
            continue;
        mcr_report(parser->diagnostics, MCR_ERROR, place, "no 'let %s' in the scene", definition->name);
        mcr_suggest(parser, place, definition->name, words, count);
    }
    free(words);
}
