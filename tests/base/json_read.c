/* SPDX-License-Identifier: Apache-2.0 */
/* The JSON reader: what is valid, what is refused and where, limits, and damage of every kind to a valid text. */
#include "base/json.h"
#include "../tap.h"

#include <stdlib.h>
#include <string.h>

struct parsed {
    struct mcr_arena *arena;
    struct mcr_diagnostics *diagnostics;
    struct mcr_json *root;
};

/* The source is an allocation of exactly length + 1 bytes, so that a sanitizer sees a byte read too many. */
static struct parsed parse(const char *text, size_t length, size_t limit)
{
    struct parsed p = {mcr_arena_create(limit), mcr_diagnostics_create(), NULL};
    p.root = mcr_json_parse(p.arena, p.diagnostics, mcr_diagnostics_source(p.diagnostics, "in", text, length, NULL));
    return p;
}

static void release(struct parsed *p)
{
    mcr_arena_destroy(p->arena);
    mcr_diagnostics_destroy(p->diagnostics);
}

static void test_values(void)
{
    static const char text[] = " {\"a\" : [1, -0.5e+3,\ttrue,false , null, \"x\\u0041\\n\\/\\\"\\\\\\b\\f\\r\\t\\u00e9\\u20AC\\ud83d\\uDE00\xe2\x82\xac\"],\r\n"
                               "  \"\": {}, \"b\": [], \"seed\": 18446744073709551615, \"n\\u0000l\": \"\\u0000\"}\n";
    struct parsed p = parse(text, sizeof text - 1, 0);
    struct mcr_json *a = mcr_json_get(p.root, "a"), *seed = mcr_json_get(p.root, "seed"), *items[6] = {NULL}, *last = NULL;
    int i = 0;

    ok(p.root && p.root->kind == MCR_JSON_OBJECT && p.root->count == 5 && !p.root->key &&
           mcr_diagnostics_errors(p.diagnostics) == 0, "an object is read");
    for (struct mcr_json *item = a ? a->first : NULL; item && i < 6; item = item->next)
        items[i++] = item;
    ok(a && a->kind == MCR_JSON_ARRAY && a->count == 6 && i == 6, "and its array");
    if (i == 6) {
        ok(items[0]->kind == MCR_JSON_NUMBER && items[0]->number == 1 && items[1]->number == -500 &&
               !strcmp(items[1]->text, "-0.5e+3"), "numbers");
        ok(items[2]->kind == MCR_JSON_BOOLEAN && items[2]->boolean == 1 && items[3]->kind == MCR_JSON_BOOLEAN && !items[3]->boolean &&
               items[4]->kind == MCR_JSON_NULL, "words");
        ok(items[5]->kind == MCR_JSON_TEXT && items[5]->length == strlen(items[5]->text) &&
               !strcmp(items[5]->text, "xA\n/\"\\\b\f\r\t\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80\xe2\x82\xac"), "escapes and UTF-8");
        ok(items[1]->place.line == 1 && items[1]->place.column == 13 && items[1]->place.length == 7, "places");
    }
    ok(seed && !strcmp(seed->text, "18446744073709551615") && seed->place.line == 2 && seed->key_place.column == 20,
       "whole numbers keep their digits");
    for (struct mcr_json *member = p.root ? p.root->first : NULL; member; member = member->next)
        last = member;
    ok(last && last->key_length == 3 && !memcmp(last->key, "n\0l", 4) && last->length == 1 && last->text[0] == 0,
       "a NUL may stand in keys and texts");
    ok(mcr_json_get(p.root, "") && !mcr_json_get(p.root, "n") && !mcr_json_get(NULL, "a") && !mcr_json_get(a, "a"),
       "members are found by their whole key");
    release(&p);
}

static void test_good(void)
{
    static const char *const good[] = {"0", "-0", "1e5", "1E-5", "0.0e0", "1e-400", "123.456", "\"\"", "true", "null", "[]", "{}",
                                       " [ ] ", "\n\r\t 1 \n",
                                       "[[[]]]", "{\"a\":{\"a\":{}}}", "\"\\uD834\\udd1e\"", "\"\x7f\"", "[\"a\", \"a\"]",
                                       "{\"a\":1,\"A\":2}", "1.7976931348623157e308"};
    int all = 1;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        struct parsed p = parse(good[i], strlen(good[i]), 0);
        if (!p.root || mcr_diagnostics_errors(p.diagnostics)) {
            printf("# refused: %s\n", good[i]);
            all = 0;
        }
        release(&p);
    }
    ok(all, "%zu valid texts are read", sizeof good / sizeof *good);
}

/* Text and the first line of its diagnostics. */
static const struct {
    const char *text, *error;
} bad[] = {
    {"", "in:1:1: error: expected a value"},
    {"  \n ", "in:2:2: error: expected a value"},
    {"nul", "in:1:1: error: expected a value"},
    {"True", "in:1:1: error: expected a value"},
    {"truely", "in:1:1: error: expected a value"},
    {"NaN", "in:1:1: error: expected a value"},
    {"[Infinity]", "in:1:2: error: expected a value"},
    {"-Infinity", "in:1:1: error: malformed number"},
    {"'a'", "in:1:1: error: expected a value"},
    {"// a\n1", "in:1:1: error: expected a value"},
    {"[1,]", "in:1:4: error: expected a value"},
    {"[,1]", "in:1:2: error: expected a value"},
    {"[1 2]", "in:1:4: error: expected ',' or ']'"},
    {"[1}", "in:1:3: error: expected ',' or ']'"},
    {"[", "in:1:2: error: expected a value"},
    {"[1,\n 2", "in:1:1: error: this array has no end, expected ']'"},
    {"]", "in:1:1: error: expected a value"},
    {"{", "in:1:2: error: expected a key in double quotes"},
    {"{\"a\":1,}", "in:1:8: error: expected a key in double quotes"},
    {"{a:1}", "in:1:2: error: expected a key in double quotes"},
    {"{1:1}", "in:1:2: error: expected a key in double quotes"},
    {"{\"a\" 1}", "in:1:6: error: expected ':' after the key"},
    {"{\"a\":}", "in:1:6: error: expected a value"},
    {"{\"a\":1 \"b\":2}", "in:1:8: error: expected ',' or '}'"},
    {"\n {\"a\":1", "in:2:2: error: this object has no end, expected '}'"},
    {"{\"a\":1,\n \"b\":2, \"a\":3}", "in:2:9: error: duplicate key"},
    {"{\"a\":1,\"\\u0061\":2}", "in:1:8: error: duplicate key"},
    {"01", "in:1:1: error: malformed number"},
    {"-", "in:1:1: error: malformed number"},
    {"+1", "in:1:1: error: expected a value"},
    {".5", "in:1:1: error: expected a value"},
    {"1.", "in:1:1: error: malformed number"},
    {"1.e5", "in:1:1: error: malformed number"},
    {"1e", "in:1:1: error: malformed number"},
    {"1e+", "in:1:1: error: malformed number"},
    {"0x10", "in:1:1: error: malformed number"},
    {"1_000", "in:1:1: error: malformed number"},
    {"1.5.2", "in:1:1: error: malformed number"},
    {"--1", "in:1:1: error: malformed number"},
    {"[1e309]", "in:1:2: error: number out of range"},
    {"-1e999999999999999999999", "in:1:1: error: number out of range"},
    {"\"abc", "in:1:1: error: this text has no end"},
    {"\"abc\\\"", "in:1:1: error: this text has no end"},
    {"\"abc\\", "in:1:1: error: this text has no end"},
    {"\"a\nb\"", "in:1:3: error: this line ends within a text"},
    {"\"a\tb\"", "in:1:3: error: control character in a text"},
    {"\"a\\\nb\"", "in:1:4: error: this line ends within a text"},
    {"\"\\x41\"", "in:1:2: error: unknown escape"},
    {"\"\\u12\"", "in:1:2: error: expected four hexadecimal digits"},
    {"\"\\u12G4\"", "in:1:2: error: expected four hexadecimal digits"},
    {"\"\\ud800\"", "in:1:2: error: half of a surrogate pair"},
    {"\"\\ud800\\u0041\"", "in:1:2: error: half of a surrogate pair"},
    {"\"\\udc00\"", "in:1:2: error: half of a surrogate pair"},
    {"\"\\ud800\\ud800\"", "in:1:2: error: half of a surrogate pair"},
    {"\"\xff\"", "in:1:2: error: this byte is not UTF-8"},
    {"\"a\xc0\xaf\"", "in:1:3: error: this byte is not UTF-8"},
    {"\"\xed\xa0\x80\"", "in:1:2: error: this byte is not UTF-8"},
    {"\"\xe2\x82\"", "in:1:2: error: this byte is not UTF-8"},
    {"\xef\xbb\xbf{}", "in:1:1: error: byte order mark"},
    {"1 2", "in:1:3: error: text after the end of the value"},
    {"{}}", "in:1:3: error: text after the end of the value"},
    {"[]\f", "in:1:3: error: text after the end of the value"},
};

/* Whether the printed diagnostics begin with `expected`, and hold one error. */
static int told(struct parsed *p, const char *expected, const char *what)
{
    char *printed = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&printed, &size);
    int good;
    mcr_diagnostics_print(p->diagnostics, to, 0);
    fclose(to);
    good = !p->root && mcr_diagnostics_errors(p->diagnostics) == 1 && !strncmp(printed, expected, strlen(expected));
    if (!good)
        printf("# %s: expected %s, got %.*s\n", what, expected, (int)strcspn(printed, "\n"), printed);
    free(printed);
    return good;
}

static void test_bad(void)
{
    int all = 1;
    struct parsed p;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        p = parse(bad[i].text, strlen(bad[i].text), 0);
        all &= told(&p, bad[i].error, bad[i].text);
        release(&p);
    }
    ok(all, "%zu invalid texts are refused at the right place", sizeof bad / sizeof *bad);
    p = parse("[1,\0 2]", 7, 0);
    ok(told(&p, "in:1:4: error: expected a value", "NUL"), "a NUL byte is no blank");
    release(&p);
}

static void test_limits(void)
{
    const size_t many = 200000;
    char *text = malloc(many * 16 + 64), *at;
    struct parsed p;

    if (!text)
        exit(99);
    memset(text, '[', 64);
    memset(text + 64, ']', 64);
    p = parse(text, 128, 0);
    ok(p.root != NULL, "64 arrays within each other");
    release(&p);
    memset(text, '[', 65);
    memset(text + 65, ']', 65);
    p = parse(text, 130, 0);
    ok(told(&p, "in:1:65: error: nested too deeply", "65 levels"), "65 are refused");
    release(&p);
    memset(text, '[', many * 16);
    p = parse(text, many * 16, 0);
    ok(told(&p, "in:1:65: error: nested too deeply", "brackets"), "as are three million opening brackets");
    release(&p);
    memset(text, '{', 1);
    for (at = text + 1, p.root = NULL; (size_t)(at - text) < many * 14;)
        at += sprintf(at, "\"%zx\":0,", (size_t)(at - text));
    memcpy(at - 1, "}", 1);
    p = parse(text, (size_t)(at - text), 0);
    ok(p.root && p.root->count > 200000, "an object of many keys is read");
    release(&p);
    memcpy(at - 1, ",\"1\":0}", 7); /* the first key was 1 */
    p = parse(text, (size_t)(at - text) + 6, 0);
    ok(!p.root && mcr_diagnostics_errors(p.diagnostics) == 1, "and its one duplicate found");
    release(&p);
    p = parse(text, (size_t)(at - text) + 6, 1 << 16);
    ok(!p.root && mcr_arena_used(p.arena) <= 1 << 16 && mcr_diagnostics_errors(p.diagnostics) == 1, "an arena's limit is an error, no crash");
    release(&p);
    memset(text, '7', many);
    p = parse(text, many, 0);
    ok(told(&p, "in:1:1: error: number out of range", "digits"), "a number of 200000 digits");
    release(&p);
    free(text);
}

/* Every cut and every single wrong byte of a valid text: refused with one error or read, never anything else. */
static void test_damage(void)
{
    static const char text[] = "{\"a\": [1, -2.5e3, \"\\ud83d\\ude00 \\n \xc3\xa9\", true], \"b\": {\"c\": null}}";
    static const char bytes[] = "\"\\{}[],:-+.eEu0 9a\n\x01\x7f\x80\xc3\xff";
    char damaged[sizeof text];
    size_t length = sizeof text - 1, wrong = 0, cases = 0;
    struct parsed p;

    for (size_t cut = 0; cut <= length; cut++, cases++) {
        p = parse(text, cut, 0);
        wrong += (p.root != NULL) != (cut == length) || mcr_diagnostics_errors(p.diagnostics) != (p.root ? 0 : 1);
        release(&p);
    }
    ok(wrong == 0, "every cut of a text is refused with one error");
    for (size_t i = 0; i < length; i++)
        for (size_t b = 0; b < sizeof bytes; b++, cases++) { /* the NUL at the end included */
            memcpy(damaged, text, sizeof text);
            damaged[i] = bytes[b];
            p = parse(damaged, length, 0);
            wrong += mcr_diagnostics_errors(p.diagnostics) != (p.root ? 0 : 1);
            release(&p);
        }
    ok(wrong == 0, "%zu damaged texts are read or refused with one error", cases);
}

int main(void)
{
    test_values();
    test_good();
    test_bad();
    test_limits();
    test_damage();
    return tap_done();
}
