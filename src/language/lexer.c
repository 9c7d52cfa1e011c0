/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Bytes -> tokens.
 *
 * A word is a letter or '_', then letters, digits and '_'; a '-' belongs to it where a letter follows ("solid-angle"; "a-1" is a minus 1, and
 * "a - b" needs its blanks). A number is decimal, with an optional fraction and exponent, and no letter may touch it. A string ends on its
 * line; \" \\ and \n are its escapes. Outside of strings and comments everything is ASCII; comments are not looked at, but for NUL.
 * Lines end with LF or CR LF. A byte order mark at the start of a text is passed over.
 */
#include "language/internal.h"

#include <stdarg.h>
#include <stdlib.h>

static int is_letter(int c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static int is_digit(int c)
{
    return c >= '0' && c <= '9';
}

static int byte(const struct mcr_lexer *lexer, size_t ahead)
{
    return (size_t)(lexer->end - lexer->at) > ahead ? (unsigned char)lexer->at[ahead] : 0;
}

void mcr_lexer_start(struct mcr_lexer *lexer, const struct mcr_source *source, size_t offset)
{
    *lexer = (struct mcr_lexer){ .source = source, .line = 1, .fresh = 1, .line_start = source->text, .end = source->text + source->length };
    if (source->length >= 3 && memcmp(source->text, "\xef\xbb\xbf", 3) == 0)
        lexer->line_start += 3;
    lexer->at = lexer->line_start + offset;
}

/* Reports once, however often the bytes are looked at. */
static void __attribute__((format(printf, 5, 6))) complain(struct mcr_parser *parser, const struct mcr_lexer *lexer, const char *at, size_t length,
                                                           const char *format, ...)
{
    struct mcr_place place = { lexer->source, lexer->line, (uint32_t)(at - lexer->line_start) + 1, (uint32_t)length };
    char text[300];
    va_list arguments;

    if (parser->quiet || at < parser->judged || mcr_diagnostics_errors(parser->diagnostics) > MCR_MISTAKE_LIMIT)
        return;
    parser->judged = at + length;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    mcr_report(parser->diagnostics, MCR_ERROR, place, "%s", text);
}

static void new_line(struct mcr_lexer *lexer)
{
    lexer->line++;
    lexer->line_start = lexer->at;
    lexer->fresh = 1;
}

static void lone_return(struct mcr_parser *parser, struct mcr_lexer *lexer, const char *at)
{
    if (!lexer->lone_return)
        complain(parser, lexer, at, 1, "a carriage return without a line feed, lines end with LF or CR LF");
    lexer->lone_return = 1;
}

static void skip_comment(struct mcr_parser *parser, struct mcr_lexer *lexer)
{
    const char *line_feed = memchr(lexer->at, '\n', (size_t)(lexer->end - lexer->at)), *stop = line_feed ? line_feed : lexer->end, *found;
    found = memchr(lexer->at, 0, (size_t)(stop - lexer->at));
    if (found)
        complain(parser, lexer, found, 1, "a NUL byte, expected text");
    found = memchr(lexer->at, '\r', (size_t)(stop - lexer->at));
    if (found && found + 1 != stop)
        lone_return(parser, lexer, found);
    lexer->at = stop;
}

/* Comments of other languages, told and passed over as such, so that their words are not taken for settings. */
static void skip_foreign_comment(struct mcr_parser *parser, struct mcr_lexer *lexer)
{
    int star = lexer->at[1] == '*';
    complain(parser, lexer, lexer->at, 2, "'%.2s' does not begin a comment, '#' does", lexer->at);
    if (!star) {
        skip_comment(parser, lexer);
        return;
    }
    for (lexer->at += 2; lexer->at < lexer->end;) {
        char c = *lexer->at++;
        if (c == '*' && byte(lexer, 0) == '/') {
            lexer->at++;
            return;
        }
        if (c == '\n')
            new_line(lexer);
    }
}

/* Bytes that mean nothing here. At least one is passed over. */
static void skip_stray(struct mcr_parser *parser, struct mcr_lexer *lexer)
{
    const char *start = lexer->at;
    int c = (unsigned char)*start;

    if (c == 0) {
        while (lexer->at < lexer->end && *lexer->at == 0)
            lexer->at++;
        complain(parser, lexer, start, (size_t)(lexer->at - start), "a NUL byte, expected text");
    } else if (c < 0x20 || c == 0x7f) {
        lexer->at++;
        complain(parser, lexer, start, 1, "unexpected control character 0x%02X", (unsigned)c);
    } else {
        lexer->at++;
        complain(parser, lexer, start, 1, "unexpected character '%c'%s", c, c == ']' ? ", tuples are written ( a, b, ... )" : "");
    }
}

/* Other scripts' letters, and whatever else is not ASCII, make a word that is wrong, but one word. */
static void lex_word(struct mcr_parser *parser, struct mcr_lexer *lexer, struct mcr_token *token)
{
    const char *start = lexer->at, *foreign = NULL;
    size_t length;
    for (;;) {
        int c = byte(lexer, 0);
        if (is_letter(c) || is_digit(c) || (c == '-' && is_letter(byte(lexer, 1)))) {
            lexer->at++;
        } else if (c >= 0x80) {
            foreign = foreign ? foreign : lexer->at;
            length = mcr_utf8_length(lexer->at, lexer->end);
            lexer->at += length ? length : 1;
        } else {
            break;
        }
    }
    if (foreign) {
        token->bad = 1;
        length = mcr_utf8_length(foreign, lexer->end);
        if (length)
            complain(parser, lexer, foreign, length, "unexpected '%.*s', only strings and comments are more than ASCII", (int)length, foreign);
        else
            complain(parser, lexer, foreign, 1, "unexpected byte 0x%02X, the text is not UTF-8", (unsigned)(unsigned char)*foreign);
    }
    token->kind = TOKEN_WORD;
    token->text_length = (uint32_t)(lexer->at - start);
    if (token->text_length > MCR_WORD_LIMIT) {
        complain(parser, lexer, start, token->text_length, "a word of %u bytes, at most %u are allowed", token->text_length, MCR_WORD_LIMIT);
        token->text_length = MCR_WORD_LIMIT;
    }
}

/* The value of a well-formed number. strtod reads a copy, in which it cannot run past the end; the locale is always "C" here. */
static void evaluate(struct mcr_parser *parser, const struct mcr_lexer *lexer, struct mcr_token *token)
{
    char copy[MCR_DIGIT_LIMIT + 1];
    int nonzero = 0;

    token->bad = 1;
    if (token->text_length > MCR_DIGIT_LIMIT) {
        complain(parser, lexer, token->text, token->text_length, "a number of %u bytes, at most %u are allowed", token->text_length, MCR_DIGIT_LIMIT);
        return;
    }
    if (token->text_length < 16 && !memchr(token->text, '.', token->text_length) && !memchr(token->text, 'e', token->text_length) &&
        !memchr(token->text, 'E', token->text_length)) { /* most numbers of a mesh; exact */
        uint64_t whole = 0;
        for (uint32_t i = 0; i < token->text_length; i++)
            whole = whole * 10 + (uint64_t)(token->text[i] - '0');
        token->number = (double)whole;
        token->bad = 0;
        return;
    }
    memcpy(copy, token->text, token->text_length);
    copy[token->text_length] = '\0';
    token->number = strtod(copy, NULL);
    for (const char *c = copy; *c && *c != 'e' && *c != 'E'; c++)
        nonzero |= *c >= '1' && *c <= '9';
    if (token->number > 1.7976931348623157e308)
        complain(parser, lexer, token->text, token->text_length, "the number %.40s is too large, the limit is 1.797e308", copy);
    else if (nonzero && token->number == 0)
        complain(parser, lexer, token->text, token->text_length, "the number %.40s is too small, it would become 0", copy);
    else
        token->bad = 0;
}

static void lex_number(struct mcr_parser *parser, struct mcr_lexer *lexer, struct mcr_token *token)
{
    while (is_digit(byte(lexer, 0)))
        lexer->at++;
    if (byte(lexer, 0) == '.')
        lexer->at++;
    while (is_digit(byte(lexer, 0)))
        lexer->at++;
    if (byte(lexer, 0) == 'e' || byte(lexer, 0) == 'E') {
        size_t sign = byte(lexer, 1) == '+' || byte(lexer, 1) == '-';
        if (is_digit(byte(lexer, 1 + sign)))
            lexer->at += 1 + sign;
        while (is_digit(byte(lexer, 0)))
            lexer->at++;
    }
    token->kind = TOKEN_NUMBER;
    if (is_letter(byte(lexer, 0)) || byte(lexer, 0) == '.') {
        do
            lexer->at++;
        while (is_letter(byte(lexer, 0)) || is_digit(byte(lexer, 0)) || byte(lexer, 0) == '.' ||
               ((lexer->at[-1] | 32) == 'e' && (byte(lexer, 0) == '+' || byte(lexer, 0) == '-')));
        token->bad = 1;
        complain(parser, lexer, token->text, (size_t)(lexer->at - token->text), "'%.*s' is not a number",
                 lexer->at - token->text > 60 ? 60 : (int)(lexer->at - token->text), token->text);
        return;
    }
    token->text_length = (uint32_t)(lexer->at - token->text);
    evaluate(parser, lexer, token);
}

/* The end of '...', which is told and read as a string that is wrong, if it ends on its line; else NULL. */
static const char *foreign_string_end(const struct mcr_lexer *lexer)
{
    const char *stop = memchr(lexer->at + 1, '\'', (size_t)(lexer->end - lexer->at - 1));
    return stop && !memchr(lexer->at, '\n', (size_t)(stop - lexer->at)) ? stop : NULL;
}

static void lex_foreign_string(struct mcr_parser *parser, struct mcr_lexer *lexer, struct mcr_token *token)
{
    const char *stop = foreign_string_end(lexer);
    token->kind = TOKEN_STRING;
    token->bad = 1;
    complain(parser, lexer, lexer->at, (size_t)(stop - lexer->at) + 1, "unexpected '...', strings are written \"...\"");
    lexer->at = stop + 1;
}

/* A string without an end: it stops before the brackets and commas that end its line, which were hardly meant to be in it. */
static void unterminated(struct mcr_parser *parser, struct mcr_lexer *lexer, struct mcr_token *token, const char *start)
{
    const char *stop = lexer->at;
    while (stop > token->text && strchr(" \t\r,)}", stop[-1]))
        stop--;
    lexer->at = stop;
    token->bad = 1;
    complain(parser, lexer, start, (size_t)(stop - start), "the string has no end, expected '\"' on the same line");
}

static void lex_string(struct mcr_parser *parser, struct mcr_lexer *lexer, struct mcr_token *token)
{
    const char *start = lexer->at++;
    token->kind = TOKEN_STRING;
    token->text = lexer->at;
    for (;;) {
        int c = byte(lexer, 0);
        size_t length = lexer->at < lexer->end ? mcr_utf8_length(lexer->at, lexer->end) : 1;
        if (lexer->at == lexer->end || c == '\n' || (c == '\r' && byte(lexer, 1) == '\n')) {
            unterminated(parser, lexer, token, start);
            break;
        }
        if (c == '"')
            break;
        if (c == '\\') {
            int escaped = byte(lexer, 1);
            if (escaped != '"' && escaped != '\\' && escaped != 'n') {
                token->bad = 1;
                complain(parser, lexer, lexer->at, 1, "unknown escape in a string, expected \\\", \\\\ or \\n");
            } else {
                lexer->at++;
            }
        } else if (!length || (c < 0x20 && c != '\t') || c == 0x7f) {
            token->bad = 1;
            complain(parser, lexer, lexer->at, 1,
                     c >= 0x80 ? "byte 0x%02X in a string, the text is not UTF-8" : "control character 0x%02X in a string", (unsigned)c);
            for (length = 1; (size_t)(lexer->end - lexer->at) > length && (unsigned char)lexer->at[length] >= 0x80 &&
                             !mcr_utf8_length(lexer->at + length, lexer->end);)
                length++;
        }
        lexer->at += length;
    }
    token->text_length = (uint32_t)(lexer->at - token->text);
    if (byte(lexer, 0) == '"')
        lexer->at++;
}

/* Blanks, comments and what cannot be read; stops at a token or the end. Returns whether bytes were refused. */
static int skip_blanks(struct mcr_parser *parser, struct mcr_lexer *lexer)
{
    int refused = 0;
    while (lexer->at < lexer->end) {
        int c = (unsigned char)*lexer->at;
        if (c == ' ' || c == '\t') {
            lexer->at++;
        } else if (c == '\n') {
            lexer->at++;
            new_line(lexer);
        } else if (c == '\r') {
            if (byte(lexer, 1) != '\n')
                lone_return(parser, lexer, lexer->at);
            lexer->at++;
        } else if (c == '#') {
            skip_comment(parser, lexer);
        } else if (c == '/' && (byte(lexer, 1) == '/' || byte(lexer, 1) == '*')) {
            skip_foreign_comment(parser, lexer);
        } else if (c == '[') {
            break;
        } else if (c == ']' && lexer->square) {
            break;
        } else if (c == '\'' && foreign_string_end(lexer)) {
            break;
        } else if (is_letter(c) || c >= 0x80 || is_digit(c) || c == '"' || (c == '.' && is_digit(byte(lexer, 1))) ||
                   (c && strchr("(){},=+-*/^", c))) {
            break;
        } else {
            skip_stray(parser, lexer);
            refused = 1;
        }
    }
    return refused;
}

static void lex_mark(struct mcr_parser *parser, struct mcr_lexer *lexer, struct mcr_token *token)
{
    int c = (unsigned char)*lexer->at++;
    if (c == '[') {
        complain(parser, lexer, token->text, 1, "unexpected character '[', tuples are written ( a, b, ... )");
        lexer->square++;
        c = '(';
    } else if (c == ']') {
        lexer->square--;
        c = ')';
    }
    token->kind = c;
}

void mcr_lex(struct mcr_parser *parser, struct mcr_lexer *lexer, struct mcr_token *token)
{
    int c, refused;
    if (parser->fatal)
        lexer->at = lexer->end;
    refused = skip_blanks(parser, lexer);
    *token = (struct mcr_token){ .kind = TOKEN_END, .line = lexer->line, .text = lexer->at, .first = (uint8_t)lexer->fresh,
                                 .column = (uint32_t)(lexer->at - lexer->line_start) + 1, .length = 1,
                                 .after_stray = (uint8_t)refused };
    lexer->fresh = 0;
    if (lexer->at == lexer->end)
        return;
    c = (unsigned char)*lexer->at;
    if (is_letter(c) || c >= 0x80)
        lex_word(parser, lexer, token);
    else if (is_digit(c) || c == '.')
        lex_number(parser, lexer, token);
    else if (c == '"')
        lex_string(parser, lexer, token);
    else if (c == '\'')
        lex_foreign_string(parser, lexer, token);
    else
        lex_mark(parser, lexer, token);
    token->length = (uint32_t)(lexer->at - (lexer->line_start + token->column - 1));
}

void mcr_next(struct mcr_parser *parser)
{
    parser->taken_line = parser->lexer.line;
    parser->taken_column = (uint32_t)(parser->lexer.at - parser->lexer.line_start) + 1;
    if (mcr_diagnostics_errors(parser->diagnostics) > MCR_MISTAKE_LIMIT && !parser->fatal) {
        mcr_report(parser->diagnostics, MCR_ERROR, mcr_token_place(parser, &parser->token), "too many mistakes, the rest is not read");
        parser->fatal = 1;
    }
    mcr_lex(parser, &parser->lexer, &parser->token);
}

struct mcr_mark mcr_mark(const struct mcr_parser *parser)
{
    return (struct mcr_mark){ parser->lexer, parser->token, parser->taken_line, parser->taken_column };
}

void mcr_return_to(struct mcr_parser *parser, const struct mcr_mark *mark)
{
    parser->lexer = mark->lexer;
    parser->token = mark->token;
    parser->taken_line = mark->taken_line;
    parser->taken_column = mark->taken_column;
}

struct mcr_place mcr_token_place(const struct mcr_parser *parser, const struct mcr_token *token)
{
    return (struct mcr_place){ parser->lexer.source, token->line, token->column, token->length };
}

struct mcr_place mcr_span(const struct mcr_parser *parser, const struct mcr_place *start)
{
    struct mcr_place place = *start;
    if (parser->taken_line == start->line && parser->taken_column > start->column)
        place.length = parser->taken_column - start->column;
    return place;
}

const char *mcr_token_described(const struct mcr_token *token, char text[80])
{
    int length = token->text_length > 40 ? 40 : (int)token->text_length;
    const char *more = token->text_length > 40 ? "..." : "";
    switch (token->kind) {
    case TOKEN_END:
        return "end of text";
    case TOKEN_WORD:
        snprintf(text, 80, "'%.*s%s'", length, token->text, more);
        break;
    case TOKEN_NUMBER:
        snprintf(text, 80, "number %.*s%s", length, token->text, more);
        break;
    case TOKEN_STRING:
        return "string";
    default:
        snprintf(text, 80, "'%c'", token->kind);
    }
    return text;
}

int mcr_token_is(const struct mcr_token *token, const char *word)
{
    return token->kind == TOKEN_WORD && strlen(word) == token->text_length && memcmp(word, token->text, token->text_length) == 0;
}

const char *mcr_token_string(struct mcr_parser *parser, const struct mcr_token *token)
{
    char *text = token->text_length ? mcr_arena_text(parser->arena, token->text, token->text_length) : "", *to = text;
    if (!text) {
        mcr_fatal(parser);
        return NULL;
    }
    if (!token->text_length || !memchr(text, '\\', token->text_length))
        return text;
    for (const char *from = token->text, *end = from + token->text_length; from < end; from++) {
        if (*from == '\\' && from + 1 < end)
            *to++ = *++from == 'n' ? '\n' : *from;
        else
            *to++ = *from;
    }
    *to = '\0';
    return text;
}
