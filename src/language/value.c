/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Values: numbers, strings, names, calls, brackets.
 *
 * Brackets around one number group; around anything else they make a tuple: ((1, 2, 3)) is a tuple of one tuple. A tuple holds numbers,
 * tuples and strings; names in it are those of `let` and are replaced. In the settings of some blocks (words.c) it may hold other names and calls
 * besides. Alone, a name stays a name, with what a `let` binds it to.
 *
 * A call is a word with '(' behind it. In it, a word with '=' behind it begins a named argument; any other word is a child. A '(' right
 * behind a child's word always opens the child's own arguments. What then stands before ',' or ')' is its weight, a number expression that
 * begins with a number, a sign, '(' (only behind the child's own brackets), or a word that is a `let` name, a function or a constant;
 * another word there is a forgotten comma.
 */
#include "language/internal.h"

static const double pi = 0x1.921fb54442d18p+1;

struct mcr_value mcr_error_value(struct mcr_place place)
{
    return (struct mcr_value){ .kind = MCR_VALUE_ERROR, .place = place, .text = "" };
}

int mcr_begins_value(const struct mcr_token *token)
{
    return token->kind == TOKEN_WORD || token->kind == TOKEN_NUMBER || token->kind == TOKEN_STRING || token->kind == '(' || token->kind == '-' ||
           token->kind == '+';
}

void mcr_plain(struct mcr_parser *parser, struct mcr_value *value)
{
    struct mcr_place place = value->place;
    if (value->kind == MCR_VALUE_NAME && value->bound) {
        *value = *value->bound;
        value->place = place;
    } else if (value->kind == MCR_VALUE_NAME || value->kind == MCR_VALUE_CALL) {
        place.length = (uint32_t)strlen(value->text);
        mcr_unknown_name(parser, value->kind == MCR_VALUE_NAME ? "name" : "function", value->text, place);
        *value = mcr_error_value(value->place);
    }
}

static void not_closed(struct mcr_parser *parser, struct mcr_place open, const char *expected)
{
    char text[80];
    if (parser->fatal)
        return;
    mcr_report(parser->diagnostics, MCR_ERROR, open, "'(' is not closed");
    mcr_report(parser->diagnostics, MCR_NOTE, mcr_token_place(parser, &parser->token), "expected %s before %s", expected,
               mcr_token_described(&parser->token, text));
}

int mcr_element_follows(struct mcr_parser *parser, struct mcr_place open)
{
    if (parser->token.kind != TOKEN_END && parser->token.kind != '}')
        return 1;
    not_closed(parser, open, "a value");
    return 0;
}

int mcr_separator(struct mcr_parser *parser, struct mcr_place open)
{
    struct mcr_place here = mcr_token_place(parser, &parser->token);
    char text[80];

    if (parser->token.kind == ')') {
        mcr_next(parser);
        return MCR_LIST_DONE;
    }
    if (parser->token.kind == ',') {
        mcr_next(parser);
        if (parser->token.kind != ')')
            return mcr_element_follows(parser, open) ? MCR_LIST_MORE : MCR_LIST_SHORT;
        mcr_report(parser->diagnostics, MCR_ERROR, here, "expected a value after ',', found ')'");
        mcr_next(parser);
        return MCR_LIST_SHORT;
    }
    if (!parser->fatal && mcr_brackets_close(parser, 1)) {
        mcr_report(parser->diagnostics, MCR_ERROR, here, "expected ',' or ')', found %s", mcr_token_described(&parser->token, text));
        parser->expected_at = parser->token.text;
        if (mcr_begins_value(&parser->token))
            return MCR_LIST_MORE;
        mcr_panic(parser);
        return MCR_LIST_DONE;
    }
    not_closed(parser, open, "',' or ')'");
    return MCR_LIST_DONE;
}

static struct mcr_value brackets(struct mcr_parser *parser)
{
    struct mcr_place open = mcr_token_place(parser, &parser->token);
    struct mcr_value result = { .kind = MCR_VALUE_TUPLE, .place = open, .text = "" };
    struct mcr_vector *vector;
    int good = 1, more = 1, after;

    if (!mcr_enter(parser, open))
        return mcr_error_value(open);
    vector = &parser->values[parser->depth];
    vector->count = 0;
    mcr_next(parser);
    parser->brackets++;
    if (parser->token.kind == ')') {
        mcr_next(parser);
        mcr_report(parser->diagnostics, MCR_ERROR, mcr_span(parser, &open), "brackets with nothing in them, expected a value");
        good = more = 0;
    } else {
        good = more = mcr_element_follows(parser, open);
    }
    while (more) {
        struct mcr_value value = mcr_expression(parser);
        if (parser->panic)
            break;
        if (!(parser->words & MCR_WORDS_TUPLES) || (value.kind == MCR_VALUE_NAME && value.bound))
            mcr_plain(parser, &value);
        good &= value.kind != MCR_VALUE_ERROR;
        if (!mcr_vector_add(parser, vector, &value, sizeof value))
            break;
        after = mcr_separator(parser, open);
        more = after == MCR_LIST_MORE;
        good &= after != MCR_LIST_SHORT;
    }
    parser->brackets--;
    mcr_leave(parser);
    result.place = mcr_span(parser, &open);
    if (parser->panic || parser->fatal || !good)
        return mcr_error_value(result.place);
    if (vector->count == 1 && ((const struct mcr_value *)vector->data)->kind == MCR_VALUE_NUMBER) {
        result.kind = MCR_VALUE_NUMBER;
        result.number = ((const struct mcr_value *)vector->data)->number;
        return result;
    }
    result.count = (uint32_t)vector->count;
    result.item = mcr_vector_take(parser, vector, sizeof result);
    return result.item ? result : mcr_error_value(result.place);
}

/* A word that stands alone as a value. */
static struct mcr_value named(struct mcr_parser *parser, const struct mcr_token *word)
{
    struct mcr_place place = mcr_token_place(parser, word);
    struct mcr_value value = { .kind = MCR_VALUE_NAME, .place = place };
    struct mcr_let *let;

    value.text = mcr_token_text(parser, word);
    if (word->bad)
        return mcr_error_value(place);
    if (mcr_token_is(word, "pi")) {
        value = (struct mcr_value){ .kind = MCR_VALUE_NUMBER, .place = place, .number = pi, .text = "" };
        return value;
    }
    if (mcr_is_function(word) && (parser->words & MCR_WORDS_SRGB) && mcr_token_is(word, "srgb"))
        return value; /* `colour srgb` of a texture or an environment: what it means is judged by the block */
    if (mcr_is_function(word)) {
        mcr_report(parser->diagnostics, MCR_ERROR, place, "'%s' is a function, expected '(' after it", value.text);
        return mcr_error_value(place);
    }
    if (mcr_is_reserved(value.text)) {
        mcr_report(parser->diagnostics, MCR_ERROR, place,
                   strchr("ni", value.text[0]) && value.text[2] != 'c' ? "'%s' is no value, numbers are finite" : "'%s' is no value", value.text);
        return mcr_error_value(place);
    }
    let = mcr_let_use(parser, word);
    if (let) {
        value.bound = &let->value;
        if (let->depth + parser->depth > MCR_NESTING_LIMIT) {
            mcr_report(parser->diagnostics, MCR_ERROR, place, "with what '%s' holds, tuples are nested deeper than %u levels", value.text,
                       MCR_NESTING_LIMIT);
            return mcr_error_value(place);
        }
        if (let->depth + parser->depth > parser->deepest)
            parser->deepest = let->depth + parser->depth;
    }
    return value;
}

static struct mcr_value call(struct mcr_parser *parser, const struct mcr_token *word);

/* Whether a weight can begin here, behind a child. */
static int begins_weight(struct mcr_parser *parser)
{
    const struct mcr_token *token = &parser->token;
    if (token->kind != TOKEN_WORD)
        return mcr_begins_value(token);
    return mcr_let_exists(parser, token) || mcr_is_function(token) || mcr_token_is(token, "pi");
}

/* What stands where an argument should begin with a word: in a misspelt function, say. */
static void no_argument(struct mcr_parser *parser, const struct mcr_value *of, const struct mcr_token *found)
{
    struct mcr_place place = mcr_token_place(parser, found), name = of->place;
    char text[80];
    if (mcr_begins_value(found))
        place = mcr_value_read(parser).place;
    if (parser->panic)
        return;
    name.length = (uint32_t)strlen(of->text);
    if (parser->expected_at == found->text) {
        /* told already */
    } else if (mcr_is_near_function(of->text)) {
        mcr_unknown_name(parser, "function", of->text, name);
    } else {
        mcr_report(parser->diagnostics, MCR_ERROR, place, "expected 'name=value' or a child, found %s", mcr_token_described(found, text));
    }
    mcr_panic(parser);
}

/* One argument of the call. Returns whether it is good. */
static int argument(struct mcr_parser *parser, const struct mcr_value *of, struct mcr_argument *out)
{
    struct mcr_token word = parser->token;
    struct mcr_place place = mcr_token_place(parser, &word);

    memset(out, 0, sizeof *out);
    if (word.kind != TOKEN_WORD || mcr_is_function(&word) || mcr_token_is(&word, "pi")) {
        no_argument(parser, of, &word);
        return 0;
    }
    mcr_next(parser);
    if (parser->token.kind == '=') {
        mcr_next(parser);
        out->name = mcr_token_text(parser, &word);
        out->name_place = place;
        out->value = mcr_value_read(parser);
        return out->value.kind != MCR_VALUE_ERROR;
    }
    out->value = parser->token.kind == '(' ? call(parser, &word) : named(parser, &word);
    if (parser->panic || !begins_weight(parser))
        return out->value.kind != MCR_VALUE_ERROR;
    out->weight = mcr_expression(parser);
    out->has_weight = 1;
    return !parser->panic && mcr_number(parser, &out->weight) && out->value.kind != MCR_VALUE_ERROR;
}

static struct mcr_value call(struct mcr_parser *parser, const struct mcr_token *word)
{
    struct mcr_place open = mcr_token_place(parser, &parser->token), place = mcr_token_place(parser, word);
    struct mcr_value result = { .kind = MCR_VALUE_CALL, .place = place, .text = mcr_token_text(parser, word) };
    struct mcr_vector *vector;
    int good = 1, more, after;

    if (!mcr_enter(parser, open))
        return mcr_error_value(place);
    vector = &parser->call[parser->depth];
    vector->count = 0;
    mcr_next(parser);
    parser->brackets++;
    if (parser->token.kind == ')') {
        mcr_next(parser);
        more = 0;
    } else {
        good = more = mcr_element_follows(parser, open);
    }
    while (more) {
        struct mcr_argument next;
        if (++parser->arguments > MCR_ARGUMENT_LIMIT) {
            mcr_report(parser->diagnostics, MCR_ERROR, mcr_token_place(parser, &parser->token), "more than %u arguments of calls",
                       MCR_ARGUMENT_LIMIT);
            parser->arguments = 0;
            mcr_panic(parser);
            break;
        }
        good &= argument(parser, &result, &next);
        if (parser->panic || !mcr_vector_add(parser, vector, &next, sizeof next))
            break;
        after = mcr_separator(parser, open);
        more = after == MCR_LIST_MORE;
        good &= after != MCR_LIST_SHORT;
    }
    parser->brackets--;
    mcr_leave(parser);
    result.place = mcr_span(parser, &place);
    if (parser->panic || parser->fatal || !good)
        return mcr_error_value(result.place);
    result.count = (uint32_t)vector->count;
    result.argument = mcr_vector_take(parser, vector, sizeof(struct mcr_argument));
    return result.argument && !word->bad ? result : mcr_error_value(result.place);
}

struct mcr_value mcr_primary(struct mcr_parser *parser)
{
    struct mcr_token token = parser->token;
    struct mcr_value value = { .place = mcr_token_place(parser, &token), .text = "" };
    char text[80];

    switch (token.kind) {
    case TOKEN_NUMBER:
        mcr_next(parser);
        value.kind = token.bad ? MCR_VALUE_ERROR : MCR_VALUE_NUMBER;
        value.number = token.number;
        return value;
    case TOKEN_STRING:
        mcr_next(parser);
        value.kind = token.bad ? MCR_VALUE_ERROR : MCR_VALUE_STRING;
        if (!token.bad && !(value.text = mcr_token_string(parser, &token)))
            return mcr_error_value(value.place);
        return value;
    case '(':
        return brackets(parser);
    case TOKEN_WORD:
        mcr_next(parser);
        if (parser->token.kind != '(')
            return named(parser, &token);
        if (mcr_is_function(&token))
            return mcr_function(parser, &token);
        if (!mcr_token_is(&token, "pi"))
            return call(parser, &token);
        mcr_report(parser->diagnostics, MCR_ERROR, value.place, "'pi' is a number, expected no '(' after it");
        break;
    default:
        mcr_report(parser->diagnostics, MCR_ERROR, value.place, "expected a value, found %s", mcr_token_described(&token, text));
    }
    mcr_panic(parser);
    return mcr_error_value(value.place);
}

struct mcr_value mcr_value_read(struct mcr_parser *parser)
{
    struct mcr_value value = mcr_expression(parser);
    return parser->panic ? mcr_error_value(value.place) : value;
}

struct mcr_value mcr_plain_value_read(struct mcr_parser *parser)
{
    struct mcr_value value = mcr_value_read(parser);
    mcr_plain(parser, &value);
    return value;
}

/* Nothing may follow: else the value becomes an error. */
static struct mcr_value whole(struct mcr_parser *parser, struct mcr_value value)
{
    char text[80];
    if (!parser->panic && parser->token.kind != TOKEN_END) {
        mcr_report(parser->diagnostics, MCR_ERROR, mcr_token_place(parser, &parser->token), "unexpected %s after the value, expected the end",
                   mcr_token_described(&parser->token, text));
        value = mcr_error_value(value.place);
    }
    parser->panic = 0;
    return value;
}

struct mcr_value mcr_whole_value_read(struct mcr_parser *parser, int plain)
{
    return whole(parser, plain ? mcr_plain_value_read(parser) : mcr_value_read(parser));
}

struct mcr_value mcr_whole_list_read(struct mcr_parser *parser)
{
    struct mcr_value result = { .kind = MCR_VALUE_TUPLE, .place = mcr_token_place(parser, &parser->token), .text = "" };
    struct mcr_vector *vector = &parser->values[0];
    int good = 1;

    parser->words = MCR_WORDS_ALL;
    for (vector->count = 0;;) {
        struct mcr_value value = mcr_value_read(parser);
        good &= value.kind != MCR_VALUE_ERROR && mcr_vector_add(parser, vector, &value, sizeof value);
        if (!good || parser->panic || parser->token.kind != ',')
            break;
        mcr_next(parser);
    }
    parser->words = 0;
    if (good)
        result = whole(parser, result);
    parser->panic = 0;
    if (!good || parser->fatal || result.kind == MCR_VALUE_ERROR)
        return mcr_error_value(result.place);
    result.place.length = 1;
    result.count = (uint32_t)vector->count;
    result.item = mcr_vector_take(parser, vector, sizeof result);
    return result.item ? result : mcr_error_value(result.place);
}
