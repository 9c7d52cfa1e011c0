/* SPDX-License-Identifier: Apache-2.0 */
/* What correct text means: arithmetic, colours, tuples, names, calls, strings, blocks, places. */
#include "help.h"

#include <math.h>

static void gives(const char *expression, const char *expected)
{
    struct parsed parsed;
    char text[500], tree[500];
    snprintf(text, sizeof text, "mcrender 1 let three = 3 let t = (1, 2) let s = \"x\" box { a three a t a s v %s }", expression);
    snprintf(tree, sizeof tree, "{box{a three=3; a t=(1 2); a s=\"x\"; v %s}}", expected);
    parse_bytes(&parsed, text, strlen(text), NULL, 0);
    if (!ok(strcmp(parsed.tree, tree) == 0 && !*parsed.messages, "%s", expression))
        printf("# got: %s\n%s", parsed.tree, parsed.messages);
    parsed_fini(&parsed);
}

static void arithmetic(void)
{
    static const struct {
        const char *expression, *value;
    } cases[] = {
        { "1 + 2 * 3", "7" },        { "(1 + 2) * 3", "9" },     { "10 - 4 - 3", "3" },       { "16 / 4 / 2", "2" },
        { "-2^2", "-4" },            { "(-2)^2", "4" },          { "2^3^2", "512" },          { "2^-1", "0.5" },
        { "2^-2^2", "0.0625" },      { "-2^-2", "-0.25" },       { "--3", "3" },              { "+3", "3" },
        { "3 - -2", "5" },           { "2 * -3", "-6" },         { "4^0.5", "2" },            { "0^0", "1" },
        { "(-8)^3", "-512" },        { "1e3", "1000" },          { ".5", "0.5" },             { "5.", "5" },
        { "1E-2", "0.01" },          { "1e+2", "100" },          { "007", "7" },              { "123456789012345", "123456789012345" },
        { "1234567890123456789", "1.2345678901234568e+18" },     { "4.9e-324", "4.9406564584124654e-324" },
        { "1.7976931348623157e308", "1.7976931348623157e+308" }, { "pi", "3.1415926535897931" },
        { "2*pi", "6.2831853071795862" },                        { "sqrt(9)", "3" },          { "abs(-3)", "3" },
        { "sin(30)", "0.5" },        { "cos(60)", "0.5" },       { "tan(45)", "1" },          { "sin(180)", "0" },
        { "cos(90)", "0" },          { "cos(180)", "-1" },       { "min(3, 1, 2)", "1" },     { "max(3, 1, 4, 2)", "4" },
        { "max(-3, -1)", "-1" },     { "min(1, 2)", "1" },       { "sqrt(3^2 + 4^2)", "5" },  { "three * 2", "6" },
        { "three-1", "2" },          { "three -1", "2" },        { "three^three", "27" },     { "-three", "-3" },
        { "((((1))))", "1" },        { "(three)", "3" },         { "sqrt (4)", "2" },         { "max(1,2)*3", "6" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        gives(cases[i].expression, cases[i].value);
}

static void others(void)
{
    static const struct {
        const char *expression, *value;
    } cases[] = {
        { "(1, 2, 3)", "(1 2 3)" },
        { "(1, -2 + 1, three)", "(1 -1 3)" },
        { "((1, 2), (3, 4))", "((1 2) (3 4))" },
        { "((1, 2, 3))", "((1 2 3))" },
        { "(t, s, three)", "((1 2) \"x\" 3)" },
        { "(t)", "((1 2))" },
        { "(\"a\")", "(\"a\")" },
        { "white", "white" },
        { "solid-angle", "solid-angle" },
        { "three", "three=3" },
        { "t", "t=(1 2)" },
        { "\"a \\\"b\\\" \\\\ \\n.\"", "\"a \"b\" \\ \n.\"" },
        { "\"\"", "\"\"" },
        { "\"# \xc3\xa9 // \"", "\"# \xc3\xa9 // \"" },
        { "f()", "f()" },
        { "f(a)", "f(a)" },
        { "f(a 1, b 2*three, c -1, d +2, e three, g pi, h sqrt(4))", "f(a 1, b 6, c -1, d 2, e 3, g 3.1415926535897931, h 2)" },
        { "f(g(h) 2, i() (3), j(n=1) three)", "f(g(h) 2, i() 3, j(n=1) 3)" },
        { "f(a=1, b=(1, 2), c=\"x\", d=name, e=g(h), k=three, l=-1)", "f(a=1, b=(1 2), c=\"x\", d=name, e=g(h), k=three=3, l=-1)" },
        { "stratified(n=4, m=4, mixture(light(by=area) 1, cosine 1))", "stratified(n=4, m=4, mixture(light(by=area) 1, cosine 1))" },
        { "hex(\"#fff\")", "(1 1 1)" },
        { "hex(\"000000\")", "(0 0 0)" },
        { "hex(\"#F00\")", "(1 0 0)" },
        { "srgb(0, 1, 0)", "(0 1 0)" },
        { "2 * srgb(0, 1, 0)", "(0 2 0)" },
        { "(1, 2, 3) * 2 * three", "(6 12 18)" },
        { "(3, 6, -9) / three", "(1 2 -3)" },
        { "2 ^ 2 * (1, 2, 3) / 8", "(0.5 1 1.5)" },
        { "((1, 2, 3) * 2, 4)", "((2 4 6) 4)" },
        { "blackbody(500)", "(4.7036688617121349 0 0)" },
        { "f(a=2 * (1, 2, 3))", "f(a=(2 4 6))" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        gives(cases[i].expression, cases[i].value);
}

/* IEC 61966-2-1, against libm's pow: 2 ulp are allowed for the difference between the two. */
static void colours(void)
{
    struct parsed parsed;
    static char text[256 * 40];
    size_t length = (size_t)sprintf(text, "mcrender 1 box { ");
    int close_by = 1, same_bits = 1;

    for (int i = 0; i < 256; i++)
        length += (size_t)sprintf(text + length, "a srgb(%d/255, 0, 0) b hex(\"%02x0000\")\n", i, i);
    sprintf(text + length, "}");
    parse_bytes(&parsed, text, strlen(text), NULL, 0);
    for (int i = 0; i < 256; i++) {
        const struct mcr_item *item = parsed.root->item[0].item;
        double encoded = i / 255.0, linear = encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
        double got = item[2 * i].value.item[0].number;
        close_by &= fabs(got - linear) <= 2 * 0x1p-52 * linear;
        same_bits &= got == item[2 * i + 1].value.item[0].number;
    }
    ok(close_by, "srgb decodes all of 256 steps as IEC 61966-2-1 says");
    ok(same_bits, "hex gives the same");
    parsed_fini(&parsed);
}

static void whole_text(void)
{
    struct parsed parsed, again;
    static const char text[] = "\xef\xbb\xbf# a comment \xff\r\nmcrender 1 # another\r\n"
                               "let room = 555\r\ncamera perspective{from(278,278,-800)to(278,278,0)fov 40}\n"
                               "material white lambert { albedo 0.73 }\n"
                               "quad { corner (213, room - 1, 227) u (130, 0, 0) v (0, 0, 105) material white }\n"
                               "group { transform { rotate (0, 1, 0, -18) } group { box { let size = 3 size (size, 1, 1) transform { } } } }\n"
                               "film{}#";
    const struct mcr_item *quad;

    parse_bytes(&parsed, text, sizeof text - 1, NULL, 0);
    same(parsed.messages, "", "a text with a byte order mark, comments, CR LF and no needless blanks");
    same(parsed.tree,
         "{camera perspective{from (278 278 -800); to (278 278 0); fov 40}; material white lambert{albedo 0.72999999999999998}; "
         "quad{corner (213 554 227); u (130 0 0); v (0 0 105); material white}; "
         "group{transform{rotate (0 1 0 -18)}; group{box{size (3 1 1); transform{}}}}; film{}}",
         "its tree");
    quad = &parsed.root->item[2];
    ok(quad->place.line == 6 && quad->place.column == 1 && quad->place.length == 4, "place of a block's word");
    ok(quad->item[0].value.place.column == 15 && quad->item[0].value.place.length == 20, "place of a tuple");
    ok(quad->item[0].value.item[1].place.column == 21 && quad->item[0].value.item[1].place.length == 8, "place of an expression");
    ok(parsed.root->item[1].name_place.column == 10 && parsed.root->item[1].kind_place.column == 16, "places of name and kind");
    ok(parsed.root->item[0].place.line == 4, "a byte order mark and CR LF do not shift lines");

    parse_bytes(&again, text, sizeof text - 1, NULL, 0);
    ok(mcr_parse_hash(parsed.root) == mcr_parse_hash(again.root), "the hash of the same text is the same");
    parsed_fini(&again);
    parse_bytes(&again, text, sizeof text - 2, NULL, 0);
    ok(mcr_parse_hash(parsed.root) != mcr_parse_hash(again.root), "and of another text another");
    parsed_fini(&again);
    parsed_fini(&parsed);
    /* FNV-1a 64 of "mcrender 1", computed independently. */
    parse_bytes(&parsed, "mcrender 1", 10, NULL, 0);
    ok(mcr_parse_hash(parsed.root) == 0x3dc58713deb50f5eu, "it is FNV-1a: %016llx", (unsigned long long)mcr_parse_hash(parsed.root));
    parsed_fini(&parsed);
}

static void definitions(void)
{
    static const char text[] = "mcrender 1 let a = 1 let b = a + 1 box { x a y b }";
    struct mcr_definition three[] = { { "a", "2*3", 0 }, { "b", "(1, 2)", 0 }, { "a", "5", 0 } };
    struct mcr_definition bad[] = { { "a", "1/0", 0 }, { "rom", "1", 0 }, { "b", "a", 0 } };
    struct parsed parsed, plain;

    parse_bytes(&plain, text, sizeof text - 1, NULL, 0);
    same(plain.tree, "{box{x a=1; y b=2}}", "without definitions");
    parse_bytes(&parsed, text, sizeof text - 1, three, 1);
    same(parsed.tree, "{box{x a=6; y b=7}}", "a definition takes the place of a let, for all that follows");
    ok(three[0].used == 1, "and is marked as used");
    ok(mcr_parse_hash(parsed.root) != mcr_parse_hash(plain.root), "the hash covers definitions");
    parsed_fini(&parsed);
    parsed_fini(&plain);
    parse_bytes(&parsed, text, sizeof text - 1, three, 3);
    same(parsed.tree, "{box{x a=5; y b=(1 2)}}", "the last definition of a name counts; it may be of another type");
    parsed_fini(&parsed);
    parse_bytes(&parsed, text, sizeof text - 1, bad, 3);
    same(parsed.messages,
         "--set:1:3: error: division by zero\n"
         "    1 | a=1/0\n"
         "      |   ^~~\n"
         "--set:1:3: error: unknown name 'a'\n"
         "    1 | b=a\n"
         "      |   ^\n"
         "--set:1:1: error: no 'let rom' in the scene\n"
         "    1 | rom=1\n"
         "      | ^~~\n",
         "mistakes in definitions");
    parsed_fini(&parsed);
}

static void command_line(void)
{
    struct parsed parsed;
    const struct mcr_value *value;
    parsed_init(&parsed);
    value = mcr_parse_value(parsed.arena, parsed.diagnostics, "--sampler", "mixture(cosine 1, light(by=area) 2*3)");
    ok(value && value->kind == MCR_VALUE_CALL && value->count == 2 && value->argument[1].weight.number == 6, "a sampler from the command line");
    value = mcr_parse_value(parsed.arena, parsed.diagnostics, "--sampler", "cosine");
    ok(value && value->kind == MCR_VALUE_NAME, "a word alone");
    ok(!mcr_parse_value(parsed.arena, parsed.diagnostics, "--sampler", "mixture(cosine 1, ligth("), "an unclosed bracket gives NULL");
    ok(!mcr_parse_value(parsed.arena, parsed.diagnostics, "--sampler", "cosine light"), "two values give NULL");
    ok(!mcr_parse_value(parsed.arena, parsed.diagnostics, "--sampler", ""), "no value gives NULL");
    parsed_keep(&parsed);
    same(parsed.messages,
         "--sampler:1:24: error: '(' is not closed\n"
         "    1 | mixture(cosine 1, ligth(\n"
         "      |                        ^\n"
         "--sampler:1:25: note: expected a value before end of text\n"
         "    1 | mixture(cosine 1, ligth(\n"
         "      |                         ^\n"
         "--sampler:1:8: error: '(' is not closed\n"
         "    1 | mixture(cosine 1, ligth(\n"
         "      |        ^\n"
         "--sampler:1:25: note: expected ',' or ')' before end of text\n"
         "    1 | mixture(cosine 1, ligth(\n"
         "      |                         ^\n"
         "--sampler:1:8: error: unexpected 'light' after the value, expected the end\n"
         "    1 | cosine light\n"
         "      |        ^~~~~\n"
         "--sampler:1:1: error: expected a value, found end of text\n"
         "    1 | \n"
         "      | ^\n",
         "their messages");
    parsed_fini(&parsed);
}

int main(void)
{
    arithmetic();
    others();
    colours();
    whole_text();
    definitions();
    command_line();
    return tap_done();
}
