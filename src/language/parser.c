/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The grammar (mcrender-scene(5) has it in full):
 *
 *     file    = "mcrender" "1" items            an included file may do without the first two words
 *     items   = { let | include | setting | block }
 *     let     = "let" WORD "=" value
 *     include = "include" STRING
 *     setting = WORD value
 *     block   = WORD [ name ] [ kind ] "{" items "}"
 *
 * Whether a word opens a block is decided by the table in words.c, so that one token ahead is enough. Looking further ahead happens only
 * behind words that the table does not have, to tell a mistake's kind.
 */
#include "language/internal.h"

#include <stdarg.h>
#include <stdlib.h>

#define WORD_ROOM 64

struct root {
    struct mcr_item item; /* first: mcr_parse_hash finds the rest by it */
    uint64_t hash;
};

static void read_items(struct mcr_parser *parser, struct mcr_block *block);

static int __attribute__((format(printf, 3, 4))) complain(struct mcr_parser *parser, struct mcr_place place, const char *format, ...)
{
    char text[1000];
    va_list arguments;
    if (parser->fatal)
        return 0;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    mcr_report(parser->diagnostics, MCR_ERROR, place, "%s", text);
    return 0;
}

static void add_item(struct mcr_parser *parser, struct mcr_block *block, const struct mcr_item *item)
{
    if (block->inside != MCR_INSIDE_UNKNOWN)
        mcr_vector_add(parser, &parser->items[block->level], item, sizeof *item);
}

/* The setting read last in this block, or NULL if something else was. */
static struct mcr_item *last_setting(struct mcr_parser *parser, struct mcr_block *block)
{
    struct mcr_vector *items = &parser->items[block->level];
    if (block->after != MCR_AFTER_SETTING || block->inside == MCR_INSIDE_UNKNOWN || !items->count)
        return NULL;
    return (struct mcr_item *)items->data + items->count - 1;
}

static struct mcr_place here(const struct mcr_parser *parser)
{
    return mcr_token_place(parser, &parser->token);
}

/* Whether a value stands here, and not the beginning of what comes after a value that was forgotten. */
static int value_follows(struct mcr_parser *parser)
{
    struct mcr_mark mark;
    char word[MCR_WORD_LIMIT + 1];
    int follows;

    if (parser->token.kind != TOKEN_WORD)
        return mcr_begins_value(&parser->token);
    if (mcr_token_is(&parser->token, "let") || mcr_token_is(&parser->token, "include"))
        return 0;
    memcpy(word, parser->token.text, parser->token.text_length);
    word[parser->token.text_length] = '\0';
    if (!mcr_block_form(MCR_INSIDE_SCENE | MCR_INSIDE_GROUP | MCR_INSIDE_SHAPE | MCR_INSIDE_STUDY, word))
        return 1;
    mark = mcr_mark(parser);
    parser->quiet++;
    mcr_next(parser);
    follows = mcr_block_follows(parser);
    parser->quiet--;
    mcr_return_to(parser, &mark);
    return !follows;
}

static void read_setting(struct mcr_parser *parser, struct mcr_block *block, const char *word, struct mcr_place place)
{
    struct mcr_item item = { .word = word, .place = place }, *before = last_setting(parser, block);
    int after_stray = parser->token.after_stray;
    char text[80];

    if (parser->token.kind == '=') {
        complain(parser, here(parser), "unexpected '=', a setting is written: %s value", word);
        mcr_next(parser);
    }
    if (!value_follows(parser)) {
        if (block->inside != MCR_INSIDE_UNKNOWN)
            complain(parser, here(parser), "expected a value for '%s', found %s", word, mcr_token_described(&parser->token, text));
        if (before && before->value.kind == MCR_VALUE_NAME && !before->value.bound && !parser->fatal) {
            /* One value is missing, and it may be that of the setting before. */
            mcr_report(parser->diagnostics, MCR_NOTE, before->place, "'%s' was read as the value of '%s'", before->value.text, before->word);
            before->value = mcr_error_value(before->value.place);
        }
        item.value = mcr_error_value(place);
        if (parser->token.kind != TOKEN_WORD && parser->token.kind != '}')
            mcr_panic(parser);
    } else {
        parser->words = block->words;
        item.value = mcr_value_read(parser);
        parser->words = 0;
    }
    if (parser->panic)
        mcr_recover(parser, block->inside);
    add_item(parser, block, &item);
    block->after = item.value.kind == MCR_VALUE_ERROR || after_stray ? MCR_AFTER_ERROR : MCR_AFTER_SETTING;
}

/* `let` was taken. */
static void read_let(struct mcr_parser *parser, struct mcr_block *block)
{
    struct mcr_token word = parser->token;
    struct mcr_place place = here(parser);
    struct mcr_value value;
    const char *name;
    char text[80];
    int usable;

    block->after = MCR_AFTER_OTHER;
    if (word.kind != TOKEN_WORD) {
        complain(parser, place, "expected a name after 'let', found %s", mcr_token_described(&word, text));
        mcr_panic(parser);
        mcr_recover(parser, block->inside);
        return;
    }
    name = mcr_token_text(parser, &word);
    mcr_next(parser);
    usable = !mcr_is_reserved(name) || complain(parser, place, "'%s' has a meaning of its own and cannot be defined", name);
    if (parser->token.kind == '=')
        mcr_next(parser);
    else
        complain(parser, here(parser), "expected '=' after 'let %s', found %s", name, mcr_token_described(&parser->token, text));
    parser->deepest = parser->depth;
    if (!value_follows(parser)) {
        if (parser->taken_line != word.line || parser->taken_column != word.column + word.length) /* else it was said that there is no '=' */
            complain(parser, here(parser), "expected a value for '%s', found %s", name, mcr_token_described(&parser->token, text));
        value = mcr_error_value(place);
        if (parser->token.kind != TOKEN_WORD && parser->token.kind != '}')
            mcr_panic(parser);
    } else {
        value = mcr_plain_value_read(parser);
    }
    if (parser->panic)
        mcr_recover(parser, block->inside);
    if (usable && !parser->fatal)
        mcr_let_add(parser, name, place, &value, parser->deepest - parser->depth);
    block->after = value.kind == MCR_VALUE_ERROR ? MCR_AFTER_ERROR : MCR_AFTER_OTHER;
}

/* "mcrender 1" at the start of a text. Returns 0 if it is a format that is not known. */
static int read_header(struct mcr_parser *parser, int required)
{
    struct mcr_place place = here(parser);
    struct mcr_token word = parser->token;
    const char *name = word.kind == TOKEN_WORD ? mcr_token_text(parser, &word) : "";
    static const char *const expected[] = { "mcrender" };
    char text[80];

    if (!mcr_token_is(&word, "mcrender")) {
        const char *nearest = mcr_nearest_word(name, expected, 1);
        if (!required && !nearest)
            return 1;
        complain(parser, place, "expected 'mcrender 1', the format's version, at the start, found %s", mcr_token_described(&word, text));
        if (!nearest)
            return 1;
        mcr_report(parser->diagnostics, MCR_NOTE, place, "did you mean '%s'?", nearest);
    }
    mcr_next(parser);
    if (parser->token.kind != TOKEN_NUMBER) {
        complain(parser, here(parser), "expected 1, the format's version, after 'mcrender', found %s", mcr_token_described(&parser->token, text));
        return 1;
    }
    if (!parser->token.bad && parser->token.number != 1) {
        complain(parser, here(parser), "format version %.10g is not known, this program reads version 1", parser->token.number);
        return 0;
    }
    mcr_next(parser);
    return 1;
}

/* Items of another text, which become items of this block. */
static void read_included(struct mcr_parser *parser, struct mcr_block *block, const char *text, struct mcr_place place)
{
    struct mcr_file file = { .parent = parser->file };
    const char *path = mcr_source_path(parser, parser->file->directory, text), *judged = parser->judged;
    struct mcr_mark mark = mcr_mark(parser);
    int known = 0;

    parser->include_depth++;
    if (path && mcr_source_read(parser, path, &file, place)) {
        for (const struct mcr_file *outer = parser->file; outer; outer = outer->parent)
            if (file.has_identity && outer->has_identity && outer->device == file.device && outer->inode == file.inode) {
                complain(parser, place, "'%s' includes itself", path);
                file.source = NULL;
            }
        if (file.source) {
            file.directory = mcr_source_directory(parser, path);
            parser->file = &file;
            parser->judged = NULL;
            mcr_lexer_start(&parser->lexer, file.source, 0);
            mcr_next(parser);
            known = read_header(parser, 0);
            if (known)
                read_items(parser, block);
            parser->file = (struct mcr_file *)file.parent;
        }
    }
    parser->incomplete |= !known;
    block->damaged |= !known;
    parser->include_depth--;
    parser->judged = judged;
    mcr_return_to(parser, &mark);
    if (parser->fatal)
        mcr_next(parser);
}

/* `include` was taken. The token behind the file's name is read only after the file, so that mistakes are told in the text's order. */
static void read_include(struct mcr_parser *parser, struct mcr_block *block)
{
    struct mcr_token token = parser->token;
    struct mcr_place place = here(parser);
    const char *text;
    char found[80];

    block->after = MCR_AFTER_OTHER;
    if (token.kind != TOKEN_STRING) {
        complain(parser, place, "expected a file name in quotes after 'include', found %s", mcr_token_described(&token, found));
        parser->incomplete = block->damaged = 1;
        mcr_panic(parser);
        mcr_recover(parser, block->inside);
        return;
    }
    text = token.bad ? NULL : mcr_token_string(parser, &token);
    if (text && !*text)
        complain(parser, place, "expected the name of a file, found an empty string");
    else if (text && parser->include_depth >= MCR_INCLUDE_LIMIT)
        complain(parser, place, "files include each other deeper than %u levels", MCR_INCLUDE_LIMIT);
    else if (text) {
        read_included(parser, block, text, place);
        mcr_next(parser);
        return;
    }
    parser->incomplete = block->damaged = 1;
    mcr_next(parser);
}

/* ---- blocks ---- */

/* Content that was refused is read with this form, for the sake of its `let`s and brackets. */
static const struct mcr_block_form unknown_form = { "", 0, MCR_INSIDE_UNKNOWN, 0, 0, 0, 0 };

/* The name or the kind. */
static const char *read_part(struct mcr_parser *parser, struct mcr_place *place)
{
    const char *text = NULL;
    *place = here(parser);
    if (parser->token.kind == TOKEN_STRING && !parser->token.bad) {
        complain(parser, *place, "unexpected string, a name is written without quotes");
        text = mcr_token_string(parser, &parser->token);
        mcr_next(parser);
    } else if (parser->token.kind == TOKEN_WORD) {
        text = mcr_token_text(parser, &parser->token);
        mcr_next(parser);
    }
    return text;
}

/* Name and kind up to '{'. Returns whether they are complete. */
static int read_parts(struct mcr_parser *parser, const struct mcr_block_form *form, struct mcr_item *item)
{
    struct mcr_mark mark = mcr_mark(parser);
    int complete, follows;

    if (form->has_name)
        item->name = read_part(parser, &item->name_place);
    if (form->has_kind && (!form->has_name || item->name))
        item->kind = read_part(parser, &item->kind_place);
    complete = (!form->has_name || item->name) && (!form->has_kind || item->kind);
    if (!complete && parser->token.kind == '{')
        complain(parser, here(parser), "expected '%s%s%s {', %s missing", form->word, form->has_name ? " NAME" : "", form->has_kind ? " KIND" : "",
                 form->has_name && !item->name ? "name and kind are" : "the kind is");
    if (parser->token.kind != TOKEN_WORD)
        return complete;
    mark = mcr_mark(parser);
    mcr_next(parser);
    follows = mcr_block_follows(parser);
    mcr_return_to(parser, &mark);
    if (!follows)
        return complete;
    if (form != &unknown_form)
        complain(parser, here(parser), "unexpected '%s', expected '{': '%s' takes %s", mcr_token_text(parser, &parser->token), form->word,
                 form->has_name ? "a name and a kind" : form->has_kind ? "a kind and no name" : "neither name nor kind");
    while (parser->token.kind == TOKEN_WORD)
        mcr_next(parser);
    return complete;
}

static void not_closed(struct mcr_parser *parser, const struct mcr_block *block)
{
    if (*block->word)
        complain(parser, block->open, "the '{' of '%s' is not closed", block->word);
    else
        complain(parser, block->open, "'{' is not closed");
}

/* The content, from '{' on. */
static void read_content(struct mcr_parser *parser, struct mcr_block *parent, const struct mcr_block_form *form, struct mcr_item *item, int opened)
{
    struct mcr_block block = { .parent = parent, .word = form->word, .inside = form->inside, .open = here(parser), .file = parser->file };
    block.words = form->words;
    block.indent = parser->item_first ? item->place.column : 0;
    if (!opened) {
        block.open = item->place;
    } else if (!mcr_enter(parser, block.open)) {
        parser->panic = 0;
        parent->damaged = 1;
        mcr_skip_block(parser);
        return;
    } else {
        mcr_next(parser);
    }
    if (!opened)
        parser->depth++;
    block.level = parser->depth;
    parser->items[block.level].count = 0;
    read_items(parser, &block);
    if (block.closed) {
        /* by what stands here */
    } else if (parser->token.kind == '}') {
        mcr_next(parser);
    } else {
        not_closed(parser, &block);
    }
    mcr_leave(parser);
    item->damaged = (uint8_t)block.damaged;
    item->count = (uint32_t)parser->items[block.level].count;
    item->item = mcr_vector_take(parser, &parser->items[block.level], sizeof *item);
}

/* A block whose word was taken; keep: it becomes part of the tree. */
static void read_block(struct mcr_parser *parser, struct mcr_block *parent, const struct mcr_block_form *form, struct mcr_place place, int keep)
{
    struct mcr_item item = { .is_block = 1, .word = form->word, .place = place };
    int complete = read_parts(parser, form, &item), opened = parser->token.kind == '{';
    uint32_t depth = parser->depth;
    char text[80];

    parent->after = MCR_AFTER_OTHER;
    if (!opened) {
        complain(parser, here(parser), "expected '{' after '%s%s%s%s%s', found %s", form->word, item.name ? " " : "", item.name ? item.name : "",
                 item.kind ? " " : "", item.kind ? item.kind : "", mcr_token_described(&parser->token, text));
        /* With a '}' too many, it was meant to be here. */
        if (mcr_excess(parser) >= 0 || depth >= MCR_NESTING_LIMIT) {
            parent->damaged = 1;
            mcr_panic(parser);
            mcr_recover(parser, parent->inside);
            return;
        }
        parser->file->excess++;
    }
    read_content(parser, parent, form, &item, opened);
    if (keep && complete && item.item)
        add_item(parser, parent, &item);
    else
        parent->damaged = 1;
}

/* "a, b or c" */
static void listed(char *text, size_t room, const char *const *words, size_t count)
{
    size_t length = 0;
    text[0] = '\0';
    for (size_t i = 0; i < count && length < room; i++)
        length += (size_t)snprintf(text + length, room - length, "%s%s", i == 0 ? "" : i + 1 == count ? " or " : ", ", words[i]);
}

/* A word that nothing begins with, at the top level or in a group. If another word is near, that one is taken to be meant.
 * is_bad: the word is no word, which was reported. */
static void read_unknown(struct mcr_parser *parser, struct mcr_block *block, const char *word, struct mcr_place place, int is_bad)
{
    const char *words[WORD_ROOM], *nearest;
    size_t count = mcr_block_words(block->inside, words, WORD_ROOM);
    char expected[600], within[MCR_WORD_LIMIT + 8] = "at the top level";
    int follows = mcr_block_follows(parser);

    if (mcr_token_is(&(struct mcr_token){ .kind = TOKEN_WORD, .text = word, .text_length = (uint32_t)strlen(word) }, "mcrender")) {
        complain(parser, place, "'mcrender 1' stands at the start of a text only");
        block->after = MCR_AFTER_OTHER;
        if (parser->token.kind == TOKEN_NUMBER)
            mcr_next(parser);
        return;
    }
    if (block->parent)
        snprintf(within, sizeof within, "in '%s'", block->word);
    listed(expected, sizeof expected, words, count);
    if (!is_bad)
        complain(parser, place, "unknown word '%s' %s, expected %s", word, within, expected);
    nearest = mcr_nearest_word(word, words, count);
    if (nearest && !is_bad)
        mcr_report(parser->diagnostics, MCR_NOTE, place, "did you mean '%s'?", nearest);
    block->after = MCR_AFTER_OTHER;
    if (nearest && strcmp(nearest, "let") == 0 && parser->token.kind == TOKEN_WORD)
        read_let(parser, block);
    else if (nearest && strcmp(nearest, "include") == 0 && parser->token.kind == TOKEN_STRING)
        read_include(parser, block);
    else if (follows)
        read_block(parser, block, nearest && mcr_block_form(block->inside, nearest) ? mcr_block_form(block->inside, nearest) : &unknown_form, place,
                   nearest != NULL);
    else {
        block->damaged = 1;
        mcr_panic(parser);
        mcr_recover(parser, block->inside);
        if (parser->token.kind == '}' && !block->parent && mcr_excess(parser) < 0) {
            /* The block that this belonged to was closed too early. */
            parser->file->excess++;
            mcr_next(parser);
        }
    }
}

/* A block where only settings, or other blocks, may stand. `mark` is before its word. */
static void read_misplaced(struct mcr_parser *parser, struct mcr_block *block, const char *word, struct mcr_place place, const struct mcr_mark *mark)
{
    const struct mcr_block_form *form = NULL;
    const char *words[WORD_ROOM], *nearest;
    size_t count = mcr_block_words(block->inside, words, WORD_ROOM) - 2; /* without let and include */

    for (const struct mcr_block *outer = block->parent; outer && !form; outer = outer->parent)
        form = mcr_block_form(outer->inside, word);
    /* A bracket is missing in this text. It is this one, unless the lines are set as if the block was meant to be inside. */
    if (form && block->file == parser->file && mcr_excess(parser) > 0 &&
        (!mark->token.first || !block->indent || mark->token.column <= block->indent)) {
        parser->file->excess--;
        not_closed(parser, block);
        mcr_report(parser->diagnostics, MCR_NOTE, place, "'%s' cannot stand in it", word);
        mcr_return_to(parser, mark);
        block->closed = 1;
        return;
    }
    block->damaged = 1;
    if (form) {
        complain(parser, place, "'%s' cannot stand in '%s'", word, block->word);
        read_block(parser, block, form, place, 0);
        return;
    }
    nearest = mcr_nearest_word(word, words, count);
    complain(parser, place, "unknown block '%s' in '%s', expected %s", word, block->word, count ? words[0] : "settings");
    if (nearest)
        mcr_report(parser->diagnostics, MCR_NOTE, place, "did you mean '%s'?", nearest);
    read_block(parser, block, nearest ? mcr_block_form(block->inside, nearest) : &unknown_form, place, nearest != NULL);
}

/* The next token is a word. */
static void read_item(struct mcr_parser *parser, struct mcr_block *block)
{
    struct mcr_mark mark = mcr_mark(parser);
    struct mcr_place place = here(parser);
    const char *word = mcr_token_text(parser, &parser->token);
    const struct mcr_block_form *form = mcr_block_form(block->inside, word);
    int is_scene = (block->inside & (MCR_INSIDE_SCENE | MCR_INSIDE_GROUP)) != 0;

    parser->item_first = mark.token.first;
    mcr_next(parser);
    if (strcmp(word, "let") == 0)
        read_let(parser, block);
    else if (strcmp(word, "include") == 0)
        read_include(parser, block);
    else if (form && form->is_single && block->inside == MCR_INSIDE_GROUP && block->file == parser->file && mcr_excess(parser) > 0)
        read_misplaced(parser, block, word, place, &mark);
    else if (form)
        read_block(parser, block, form, place, 1);
    else if (is_scene)
        read_unknown(parser, block, word, place, mark.token.bad);
    else if (!mcr_block_follows(parser)) {
        read_setting(parser, block, word, place);
        if (mark.token.bad && block->inside != MCR_INSIDE_UNKNOWN) {
            parser->items[block->level].count--;
            block->damaged = 1;
        }
    }
    else if (block->inside == MCR_INSIDE_UNKNOWN)
        read_block(parser, block, &unknown_form, place, 0);
    else
        read_misplaced(parser, block, word, place, &mark);
}

/* Something that no item begins with. */
static void read_stray(struct mcr_parser *parser, struct mcr_block *block)
{
    int kind = parser->token.kind, begins_value = mcr_begins_value(&parser->token);
    struct mcr_item *before = last_setting(parser, block);
    char text[80];

    /* Behind a value that was wrong, this is what is left of it. */
    if (block->after != MCR_AFTER_ERROR || kind == '{')
        complain(parser, here(parser), "unexpected %s, expected a %s", mcr_token_described(&parser->token, text),
                 block->inside & (MCR_INSIDE_SCENE | MCR_INSIDE_GROUP) ? "block" : "setting");
    if (kind == ',') {
        mcr_next(parser);
        begins_value = parser->token.kind != TOKEN_WORD && mcr_begins_value(&parser->token);
    }
    if (begins_value && before)
        mcr_report(parser->diagnostics, MCR_NOTE, before->place, "a setting takes one value, several go into a tuple: %s ( a, b, ... )",
                   before->word);
    if (before && (begins_value || strchr("*/^=", kind)))
        before->value = mcr_error_value(before->value.place);
    if (kind == '{') {
        mcr_skip_block(parser);
    } else if (kind == ')') {
        mcr_next(parser);
    } else if (kind != ',' || begins_value) {
        mcr_panic(parser);
        mcr_recover(parser, block->inside);
    }
    block->after = MCR_AFTER_OTHER;
}

static void read_items(struct mcr_parser *parser, struct mcr_block *block)
{
    while (!parser->fatal && !block->closed && parser->token.kind != TOKEN_END) {
        if (parser->token.kind == TOKEN_WORD) {
            read_item(parser, block);
        } else if (parser->token.kind != '}') {
            read_stray(parser, block);
        } else if (block->parent && block->file == parser->file) {
            return;
        } else {
            complain(parser, here(parser), "unexpected '}', no '{' is open here");
            mcr_next(parser);
        }
    }
}

/* ---- entry points ---- */

static void parser_init(struct mcr_parser *parser, struct mcr_arena *arena, struct mcr_diagnostics *diagnostics)
{
    memset(parser, 0, sizeof *parser);
    parser->arena = arena;
    parser->diagnostics = diagnostics;
    parser->hash = 14695981039346656037u;
}

static void parser_fini(struct mcr_parser *parser)
{
    for (size_t i = 0; i < MCR_NESTING_LIMIT + 2; i++) {
        free(parser->items[i].data);
        free(parser->values[i].data);
        free(parser->call[i].data);
    }
    free(parser->names);
}

/* What the main text holds. */
static const struct mcr_item *parse(struct mcr_parser *parser, struct mcr_file *file)
{
    struct mcr_block top = { .word = "", .inside = MCR_INSIDE_SCENE, .file = file };
    struct root *root = mcr_arena_alloc(parser->arena, 1, sizeof *root);

    if (!root) {
        mcr_fatal(parser);
        return NULL;
    }
    mcr_definitions_read(parser);
    parser->file = file;
    parser->judged = NULL;
    mcr_lexer_start(&parser->lexer, file->source, 0);
    mcr_next(parser);
    if (!read_header(parser, 1))
        return NULL;
    read_items(parser, &top);
    mcr_names_check(parser);
    root->item = (struct mcr_item){ .is_block = 1, .word = "", .damaged = (uint8_t)top.damaged, .place = { file->source, 1, 1, 1 } };
    root->item.count = (uint32_t)parser->items[0].count;
    root->item.item = mcr_vector_take(parser, &parser->items[0], sizeof root->item);
    for (uint32_t i = 0; i < parser->definition_count; i++) {
        mcr_hash(parser, parser->definitions[i].name, strlen(parser->definitions[i].name) + 1);
        mcr_hash(parser, parser->definitions[i].text, strlen(parser->definitions[i].text) + 1);
    }
    root->hash = parser->hash;
    return parser->fatal ? NULL : &root->item;
}

const struct mcr_item *mcr_parse_file(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const char *path,
                                      struct mcr_definition *definitions, uint32_t definition_count)
{
    struct mcr_parser parser;
    struct mcr_file file = { .directory = "" };
    const struct mcr_item *root = NULL;

    parser_init(&parser, arena, diagnostics);
    parser.definitions = definitions;
    parser.definition_count = definition_count;
    if (mcr_source_read(&parser, path, &file, (struct mcr_place){ 0 })) {
        file.directory = mcr_source_directory(&parser, path);
        root = parse(&parser, &file);
    }
    parser_fini(&parser);
    return root;
}

const struct mcr_item *mcr_parse_text(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const char *name, const char *directory,
                                      const char *text, size_t length, struct mcr_definition *definitions, uint32_t definition_count)
{
    struct mcr_parser parser;
    struct mcr_file file = { .directory = directory ? directory : "" };
    const struct mcr_item *root = NULL;

    parser_init(&parser, arena, diagnostics);
    parser.definitions = definitions;
    parser.definition_count = definition_count;
    file.source = mcr_source_add(&parser, name, text, length, NULL);
    if (file.source) {
        mcr_hash(&parser, text, length);
        root = parse(&parser, &file);
    }
    parser_fini(&parser);
    return root;
}

static const struct mcr_value *parse_option(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const char *name, const char *text, int list)
{
    struct mcr_parser parser;
    struct mcr_file file = { .directory = "" };
    struct mcr_value *value = mcr_arena_alloc(arena, 1, sizeof *value);

    parser_init(&parser, arena, diagnostics);
    file.source = mcr_source_add(&parser, name, text, strlen(text), NULL);
    if (!value)
        mcr_fatal(&parser);
    if (file.source && value) {
        parser.file = &file;
        mcr_lexer_start(&parser.lexer, file.source, 0);
        mcr_next(&parser);
        *value = list ? mcr_whole_list_read(&parser) : mcr_whole_value_read(&parser, 0);
    }
    parser_fini(&parser);
    return file.source && value && value->kind != MCR_VALUE_ERROR ? value : NULL;
}

const struct mcr_value *mcr_parse_list(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const char *name, const char *text)
{
    return parse_option(arena, diagnostics, name, text, 1);
}

const struct mcr_value *mcr_parse_value(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const char *name, const char *text)
{
    return parse_option(arena, diagnostics, name, text, 0);
}

uint64_t mcr_parse_hash(const struct mcr_item *root)
{
    return ((const struct root *)root)->hash;
}
