/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Arithmetic, evaluated as it is read:
 *
 *     sum     = product { ("+" | "-") product }
 *     product = sign { ("*" | "/") sign }
 *     sign    = ("+" | "-") sign | power
 *     power   = primary [ "^" sign ]            so that -2^2 is -4, 2^-1 is 0.5 and 2^3^2 is 2^9
 *
 * A tuple of three numbers (a colour, a vector) may be multiplied with a number and divided by one. What else is no arithmetic (a tuple, a string, a
 * name, a call) passes through as it is; an operator beside it is an error. Results are finite or errors. Nothing of libm is called but sqrt and fabs: the numbers of a scene are the same on every machine.
 */
#include "language/internal.h"

#include "base/elementary.h"
#include "language/blackbody.h"

#include <math.h>

int mcr_is_finite(double number)
{
    return fabs(number) <= 1.7976931348623157e308;
}

struct mcr_value mcr_finite(struct mcr_parser *parser, struct mcr_place place, double number, const char *otherwise)
{
    struct mcr_value value = { .kind = MCR_VALUE_NUMBER, .place = place, .number = number, .text = "" };
    if (mcr_is_finite(number))
        return value;
    mcr_report(parser->diagnostics, MCR_ERROR, place, "%s", otherwise);
    return mcr_error_value(place);
}

int mcr_number(struct mcr_parser *parser, struct mcr_value *value)
{
    mcr_plain(parser, value);
    if (value->kind == MCR_VALUE_TUPLE || value->kind == MCR_VALUE_STRING) {
        mcr_report(parser->diagnostics, MCR_ERROR, value->place, "expected a number, got a %s", value->kind == MCR_VALUE_TUPLE ? "tuple" : "string");
        *value = mcr_error_value(value->place);
    }
    return value->kind == MCR_VALUE_NUMBER;
}

static struct mcr_value colour(struct mcr_parser *parser, struct mcr_place place, const double rgb[3])
{
    struct mcr_value value = { .kind = MCR_VALUE_TUPLE, .place = place, .count = 3, .text = "" }, *item;
    item = mcr_arena_alloc(parser->arena, 3, sizeof *item);
    if (!item) {
        mcr_fatal(parser);
        return mcr_error_value(place);
    }
    for (int i = 0; i < 3; i++)
        item[i] = (struct mcr_value){ .kind = MCR_VALUE_NUMBER, .place = place, .number = rgb[i], .text = "" };
    value.item = item;
    return value;
}

/* Three numbers, and nothing else. */
static int is_triple(const struct mcr_value *value)
{
    int is = value->kind == MCR_VALUE_TUPLE && value->count == 3;
    for (uint32_t i = 0; is && i < 3; i++)
        is = value->item[i].kind == MCR_VALUE_NUMBER;
    return is;
}

/* A triple times a number, or over it. */
static struct mcr_value scaled(struct mcr_parser *parser, struct mcr_place place, const struct mcr_value *triple, int operator, double by)
{
    double result[3];
    if (operator == '/' && by == 0)
        return mcr_finite(parser, place, INFINITY, "division by zero");
    for (int i = 0; i < 3; i++) {
        result[i] = operator == '/' ? triple->item[i].number / by : triple->item[i].number * by;
        if (!mcr_is_finite(result[i]))
            return mcr_finite(parser, place, result[i], "the result is too large, the limit is 1.797e308");
    }
    return colour(parser, place, result);
}

/* left operator right, at the place from left's start to the last token taken. */
static struct mcr_value combine(struct mcr_parser *parser, struct mcr_value *left, int operator, struct mcr_value *right)
{
    struct mcr_place place = mcr_span(parser, &left->place);
    const char *otherwise = "the result is too large, the limit is 1.797e308";
    double a, b, result;
    int both;

    mcr_plain(parser, left);
    mcr_plain(parser, right);
    if (is_triple(left) && right->kind == MCR_VALUE_NUMBER && (operator == '*' || operator == '/'))
        return scaled(parser, place, left, operator, right->number);
    if (left->kind == MCR_VALUE_NUMBER && is_triple(right) && operator == '*')
        return scaled(parser, place, right, operator, left->number);
    both = mcr_number(parser, left) & mcr_number(parser, right);
    a = left->number;
    b = right->number;
    if (!both)
        return mcr_error_value(place);
    switch (operator) {
    case '+':
        result = a + b;
        break;
    case '-':
        result = a - b;
        break;
    case '*':
        result = a * b;
        break;
    case '/':
        otherwise = b == 0 ? "division by zero" : otherwise;
        result = b == 0 ? INFINITY : a / b;
        break;
    default:
        otherwise = a == 0 ? "zero to a negative power" : a < 0 && floor(b) != b ? "a negative number to a power that is not whole" : otherwise;
        result = mcr_pow(a, b);
    }
    return mcr_finite(parser, place, result, otherwise);
}

static struct mcr_value sign(struct mcr_parser *parser);

static struct mcr_value power(struct mcr_parser *parser)
{
    struct mcr_value base = mcr_primary(parser), exponent;
    if (parser->panic || parser->token.kind != '^')
        return base;
    if (!mcr_enter(parser, mcr_token_place(parser, &parser->token)))
        return mcr_error_value(base.place);
    mcr_next(parser);
    exponent = sign(parser);
    mcr_leave(parser);
    return parser->panic ? exponent : combine(parser, &base, '^', &exponent);
}

static struct mcr_value sign(struct mcr_parser *parser)
{
    int operator = parser->token.kind;
    struct mcr_place place = mcr_token_place(parser, &parser->token);
    struct mcr_value value;

    if (operator != '-' && operator != '+')
        return power(parser);
    if (!mcr_enter(parser, place))
        return mcr_error_value(place);
    mcr_next(parser);
    value = sign(parser);
    mcr_leave(parser);
    if (parser->panic || !mcr_number(parser, &value))
        return mcr_error_value(place);
    value.place = mcr_span(parser, &place);
    value.number = operator == '-' ? -value.number : value.number;
    return value;
}

static struct mcr_value product(struct mcr_parser *parser)
{
    struct mcr_value left = sign(parser);
    while (!parser->panic && (parser->token.kind == '*' || parser->token.kind == '/')) {
        int operator = parser->token.kind;
        struct mcr_value right;
        mcr_next(parser);
        right = sign(parser);
        left = parser->panic ? right : combine(parser, &left, operator, &right);
    }
    return left;
}

struct mcr_value mcr_expression(struct mcr_parser *parser)
{
    struct mcr_value left = product(parser);
    while (!parser->panic && (parser->token.kind == '+' || parser->token.kind == '-')) {
        int operator = parser->token.kind;
        struct mcr_value right;
        mcr_next(parser);
        right = product(parser);
        left = parser->panic ? right : combine(parser, &left, operator, &right);
    }
    return left;
}

/* ---- functions ---- */

enum function { SQRT, SIN, COS, TAN, ABS, MIN, MAX, SRGB, HEX, BLACKBODY };

static const struct {
    const char *word;
    uint32_t least, most; /* arguments */
} functions[] = {
    [SQRT] = { "sqrt", 1, 1 }, [SIN] = { "sin", 1, 1 }, [COS] = { "cos", 1, 1 },
    [TAN] = { "tan", 1, 1 },   [ABS] = { "abs", 1, 1 }, [MIN] = { "min", 2, UINT32_MAX },
    [MAX] = { "max", 2, UINT32_MAX }, [SRGB] = { "srgb", 3, 3 }, [HEX] = { "hex", 1, 1 },
    [BLACKBODY] = { "blackbody", 1, 1 },
};

static int function_of(const struct mcr_token *token)
{
    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++)
        if (mcr_token_is(token, functions[i].word))
            return (int)i;
    return -1;
}

int mcr_is_function(const struct mcr_token *token)
{
    return function_of(token) >= 0;
}

/* IEC 61966-2-1: encoded value in 0..1 -> linear. */
static double decoded(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : mcr_pow((encoded + 0.055) / 1.055, 2.4);
}

static struct mcr_value srgb(struct mcr_parser *parser, struct mcr_place place, const struct mcr_value argument[3])
{
    double rgb[3];
    int good = 1;
    for (int i = 0; i < 3; i++) {
        double x = argument[i].number;
        if (!(x >= 0 && x <= 1)) {
            mcr_report(parser->diagnostics, MCR_ERROR, argument[i].place, "%.10g is out of range for 'srgb', expected at least 0 and at most 1", x);
            good = 0;
        }
        rgb[i] = decoded(x >= 0 && x <= 1 ? x : 0);
    }
    return good ? colour(parser, place, rgb) : mcr_error_value(place);
}

static int hex_digit(int c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

static struct mcr_value hex(struct mcr_parser *parser, struct mcr_place place, const struct mcr_value *argument)
{
    const char *text = argument->text + (argument->text[0] == '#');
    size_t length = strlen(text), each = length / 3;
    double rgb[3];
    for (size_t i = 0; i < length; i++)
        if (hex_digit((unsigned char)text[i]) < 0)
            each = 0;
    if (each * 3 != length || (each != 1 && each != 2)) {
        mcr_report(parser->diagnostics, MCR_ERROR, argument->place, "expected a colour of 3 or 6 hexadecimal digits, as \"#ff8000\"");
        return mcr_error_value(place);
    }
    for (size_t i = 0; i < 3; i++) {
        int high = hex_digit((unsigned char)text[i * each]), low = hex_digit((unsigned char)text[i * each + each - 1]);
        rgb[i] = decoded((high * 16 + low) / 255.0);
    }
    return colour(parser, place, rgb);
}

static struct mcr_value blackbody(struct mcr_parser *parser, struct mcr_place place, const struct mcr_value *argument)
{
    double rgb[3], kelvin = argument->number;
    if (!(kelvin >= MCR_BLACKBODY_LEAST && kelvin <= MCR_BLACKBODY_MOST)) {
        mcr_report(parser->diagnostics, MCR_ERROR, argument->place, "%.10g is out of range for 'blackbody', expected at least %g and at most %.0f kelvin", kelvin,
                   MCR_BLACKBODY_LEAST, MCR_BLACKBODY_MOST);
        return mcr_error_value(place);
    }
    mcr_blackbody(kelvin, rgb);
    return colour(parser, place, rgb);
}

static struct mcr_value apply(struct mcr_parser *parser, int function, struct mcr_place place, const struct mcr_value argument[3], double folded)
{
    double x = argument[0].number;
    switch (function) {
    case SQRT:
        return mcr_finite(parser, place, x < 0 ? NAN : sqrt(x), "the square root of a negative number");
    case SIN:
        return mcr_finite(parser, place, mcr_sin_degrees(x), "sin is not known for such a large angle");
    case COS:
        return mcr_finite(parser, place, mcr_cos_degrees(x), "cos is not known for such a large angle");
    case TAN:
        return mcr_finite(parser, place, mcr_tan_degrees(x), "the tangent is infinite here");
    case ABS:
        return mcr_finite(parser, place, fabs(x), "");
    case SRGB:
        return srgb(parser, place, argument);
    case HEX:
        return hex(parser, place, argument);
    case BLACKBODY:
        return blackbody(parser, place, argument);
    default:
        return mcr_finite(parser, place, folded, "");
    }
}

/* The next argument is what the function wants; reports if not. */
static int fits(struct mcr_parser *parser, int function, struct mcr_value *value)
{
    if (function != HEX)
        return mcr_number(parser, value);
    mcr_plain(parser, value);
    if (value->kind != MCR_VALUE_STRING && value->kind != MCR_VALUE_ERROR)
        mcr_report(parser->diagnostics, MCR_ERROR, value->place, "'hex' expects a string, as hex(\"#ff8000\")");
    return value->kind == MCR_VALUE_STRING;
}

struct mcr_value mcr_function(struct mcr_parser *parser, const struct mcr_token *word)
{
    struct mcr_place place = mcr_token_place(parser, word), open = mcr_token_place(parser, &parser->token);
    struct mcr_value argument[3];
    int function = function_of(word), good = 1, more, after;
    uint32_t count = 0;
    double folded = 0;

    if (!mcr_enter(parser, open))
        return mcr_error_value(place);
    mcr_next(parser);
    parser->brackets++;
    if (parser->token.kind == ')') {
        mcr_next(parser);
        more = 0;
    } else {
        good = more = mcr_element_follows(parser, open);
    }
    while (more) {
        struct mcr_value value = mcr_expression(parser);
        if (parser->panic)
            break;
        good &= fits(parser, function, &value);
        if (count < 3)
            argument[count] = value;
        folded = count == 0 || (function == MIN ? value.number < folded : value.number > folded) ? value.number : folded;
        count++;
        after = mcr_separator(parser, open);
        more = after == MCR_LIST_MORE;
        good &= after != MCR_LIST_SHORT;
    }
    parser->brackets--;
    mcr_leave(parser);
    place = mcr_span(parser, &place);
    if (parser->panic || !good)
        return mcr_error_value(place);
    if (count < functions[function].least || count > functions[function].most) {
        mcr_report(parser->diagnostics, MCR_ERROR, place, "'%s' takes %u argument%s%s, got %u", functions[function].word, functions[function].least,
                   functions[function].least == 1 ? "" : "s", functions[function].most == UINT32_MAX ? " or more" : "", count);
        return mcr_error_value(place);
    }
    return apply(parser, function, place, argument, folded);
}
