/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Going on after a mistake. Layout means nothing in correct text; here, where the question is what was meant, the start of a line is
 * evidence. Looking ahead is bounded, so that a hostile text cannot make the time grow with the square of its length.
 */
#include "language/internal.h"

#include <stdlib.h>

#define LOOK_AHEAD ((ptrdiff_t)1 << 20) /* bytes */
#define JUDGE_LIMIT 100u                /* errors, after which causes are no longer searched for */
#define ADOPT_FROM ((size_t)1 << 20)    /* bytes: larger arrays go to the arena as they are, instead of being copied */

int mcr_enter(struct mcr_parser *parser, struct mcr_place place)
{
    if (parser->depth >= MCR_NESTING_LIMIT) {
        mcr_report(parser->diagnostics, MCR_ERROR, place, "blocks, brackets and expressions are nested deeper than %u levels", MCR_NESTING_LIMIT);
        mcr_panic(parser);
        return 0;
    }
    parser->depth++;
    if (parser->depth > parser->deepest)
        parser->deepest = parser->depth;
    return 1;
}

void mcr_leave(struct mcr_parser *parser)
{
    parser->depth--;
}

void mcr_panic(struct mcr_parser *parser)
{
    if (!parser->panic)
        parser->panic_brackets = parser->brackets;
    parser->panic = 1;
}

void mcr_fatal(struct mcr_parser *parser)
{
    if (!parser->fatal)
        mcr_report(parser->diagnostics, MCR_ERROR, (struct mcr_place){ 0 }, "not enough memory for the scene's text");
    parser->fatal = 1;
    mcr_panic(parser);
    parser->token = (struct mcr_token){ .kind = TOKEN_END, .text = "" };
}

int mcr_brackets_close(struct mcr_parser *parser, uint32_t depth)
{
    struct mcr_lexer lexer = parser->lexer;
    struct mcr_token token = parser->token;
    int closed = 0;

    if (mcr_diagnostics_errors(parser->diagnostics) > JUDGE_LIMIT)
        return 0;
    parser->quiet++;
    while (token.kind != TOKEN_END && token.kind != '{' && token.kind != '}' && !mcr_token_is(&token, "let") && !mcr_token_is(&token, "include")) {
        if (token.kind == '(')
            depth++;
        if (token.kind == ')' && --depth == 0)
            closed = 1;
        if (closed || lexer.at - parser->lexer.at > LOOK_AHEAD)
            break;
        mcr_lex(parser, &lexer, &token);
    }
    parser->quiet--;
    return closed;
}

static const struct mcr_block_form *form_of(const struct mcr_token *token)
{
    char word[MCR_WORD_LIMIT + 1];
    memcpy(word, token->text, token->text_length);
    word[token->text_length] = '\0';
    return mcr_block_form(MCR_INSIDE_SCENE | MCR_INSIDE_GROUP | MCR_INSIDE_STUDY, word);
}

int mcr_block_follows(struct mcr_parser *parser)
{
    struct mcr_lexer lexer = parser->lexer;
    struct mcr_token word[2], token = parser->token;
    int words = 0;

    parser->quiet++;
    for (; token.kind == TOKEN_WORD && words < 2; words++) {
        word[words] = token;
        mcr_lex(parser, &lexer, &token);
    }
    parser->quiet--;
    if (token.kind != '{')
        return 0;
    /* `material white` and then `plane { … }`, say: the words before '{' may be a block's without the first of them. */
    for (int i = 0; i < words; i++) {
        const struct mcr_block_form *form = form_of(&word[i]);
        if (form && (int)(form->has_name + form->has_kind) == words - 1 - i)
            return 0;
    }
    return 1;
}

void mcr_skip_block(struct mcr_parser *parser)
{
    uint64_t depth = 0;
    do {
        if (parser->token.kind == '{')
            depth++;
        if (parser->token.kind == '}')
            depth--;
        mcr_let_use(parser, &parser->token);
        mcr_next(parser);
    } while (depth > 0 && parser->token.kind != TOKEN_END);
}

int64_t mcr_excess(struct mcr_parser *parser)
{
    struct mcr_file *file = parser->file;
    struct mcr_lexer lexer;
    struct mcr_token token;

    if (file->excess_known)
        return file->excess;
    file->excess_known = 1;
    parser->quiet++;
    mcr_lexer_start(&lexer, file->source, 0);
    do {
        mcr_lex(parser, &lexer, &token);
        file->excess += (token.kind == '{') - (token.kind == '}');
    } while (token.kind != TOKEN_END);
    parser->quiet--;
    return file->excess;
}

/* Whether the word, not taken yet, can begin an item; evidence for it, that is. */
static int begins_item(struct mcr_parser *parser, unsigned inside)
{
    struct mcr_mark mark;
    int follows;

    if (mcr_token_is(&parser->token, "let") || mcr_token_is(&parser->token, "include"))
        return 1;
    if (!(inside & (MCR_INSIDE_SCENE | MCR_INSIDE_GROUP)))
        return parser->token.first ||
               !(mcr_let_exists(parser, &parser->token) || mcr_is_function(&parser->token) || mcr_token_is(&parser->token, "pi"));
    if (form_of(&parser->token))
        return 1;
    if (!parser->token.first)
        return 0;
    mark = mcr_mark(parser);
    parser->quiet++;
    mcr_next(parser);
    parser->quiet--;
    follows = mcr_block_follows(parser);
    mcr_return_to(parser, &mark);
    return follows;
}

void mcr_recover(struct mcr_parser *parser, unsigned inside)
{
    uint32_t depth = parser->panic_brackets;
    int judging = 1; /* until a bracket turns out not to be closed: looking ahead from each of many would take for ever */
    parser->panic = 0;
    if (depth && !mcr_brackets_close(parser, depth))
        depth = 0;
    while (parser->token.kind != TOKEN_END && parser->token.kind != '}') {
        if (parser->token.kind == '{') {
            mcr_skip_block(parser);
            continue;
        }
        if (parser->token.kind == TOKEN_WORD && depth == 0 && begins_item(parser, inside))
            break;
        if (parser->token.kind == '(') {
            judging = judging && (depth > 0 || mcr_brackets_close(parser, 0));
            depth += depth > 0 || judging;
        }
        if (parser->token.kind == ')' && depth)
            depth--;
        mcr_let_use(parser, &parser->token);
        mcr_next(parser);
    }
}

int mcr_vector_add(struct mcr_parser *parser, struct mcr_vector *vector, const void *element, size_t size)
{
    if (vector->count == vector->capacity) {
        size_t capacity = vector->capacity ? vector->capacity + vector->capacity / 2 : 16;
        void *data = capacity > SIZE_MAX / size ? NULL : realloc(vector->data, capacity * size);
        if (!data) {
            mcr_fatal(parser);
            return 0;
        }
        vector->data = data;
        vector->capacity = capacity;
    }
    memcpy((char *)vector->data + vector->count++ * size, element, size);
    return 1;
}

void *mcr_vector_take(struct mcr_parser *parser, struct mcr_vector *vector, size_t size)
{
    size_t bytes = vector->count * size;
    void *taken;

    if (bytes >= ADOPT_FROM) {
        taken = realloc(vector->data, bytes);
        if (taken)
            vector->data = taken;
        taken = vector->data;
        if (mcr_arena_adopt(parser->arena, taken, bytes) == 0) {
            *vector = (struct mcr_vector){ 0 };
            return taken;
        }
        vector->capacity = vector->count;
    }
    taken = mcr_arena_alloc(parser->arena, vector->count, size);
    if (!taken)
        mcr_fatal(parser);
    else if (bytes)
        memcpy(taken, vector->data, bytes);
    vector->count = 0;
    return taken;
}
