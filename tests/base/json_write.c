/* SPDX-License-Identifier: Apache-2.0 */
/* The JSON writer: layout, escapes, numbers that read back, misuse, streams that fail; what it writes is read by the reader. */
#include "base/json.h"
#include "../tap.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* splitmix64 */
static uint64_t random_bits(uint64_t *state)
{
    uint64_t x = *state += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

static void test_layout(void)
{
    static const double row[] = {1, 0.1, -0.0, NAN};
    static const char expected[] = "{\n"
                                   "  \"name\": \"a \\\"b\\\" \\\\ \\n\\t\\r\\u0001\\u007f \xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80/\",\n"
                                   "  \"none\": null,\n"
                                   "  \"empty\": {},\n"
                                   "  \"list\": [\n"
                                   "    -9223372036854775808,\n"
                                   "    18446744073709551615,\n"
                                   "    true,\n"
                                   "    false,\n"
                                   "    null,\n"
                                   "    [],\n"
                                   "    {\n"
                                   "      \"\": 1e-300\n"
                                   "    }\n"
                                   "  ],\n"
                                   "  \"row\": [1, 0.1, -0, null],\n"
                                   "  \"nothing\": []\n"
                                   "}\n";
    struct mcr_json_writer *writer = mcr_json_writer_create(NULL);
    const char *text;
    size_t length;

    mcr_json_begin_object(writer, NULL);
    mcr_json_text(writer, "name", "a \"b\" \\ \n\t\r\x01\x7f \xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80/");
    mcr_json_text(writer, "none", NULL);
    mcr_json_begin_object(writer, "empty");
    mcr_json_end(writer);
    mcr_json_begin_array(writer, "list");
    mcr_json_integer(writer, NULL, INT64_MIN);
    mcr_json_unsigned(writer, NULL, UINT64_MAX);
    mcr_json_boolean(writer, NULL, 7);
    mcr_json_boolean(writer, NULL, 0);
    mcr_json_null(writer, NULL);
    mcr_json_begin_array(writer, NULL);
    mcr_json_end(writer);
    mcr_json_begin_object(writer, NULL);
    mcr_json_number(writer, "", 1e-300);
    mcr_json_end(writer);
    mcr_json_end(writer);
    mcr_json_numbers(writer, "row", row, 4);
    mcr_json_numbers(writer, "nothing", row, 0);
    mcr_json_end(writer);
    ok(mcr_json_writer_finish(writer) == 0, "a whole text is finished");
    text = mcr_json_writer_text(writer, &length);
    if (!ok(text && length == sizeof expected - 1 && !memcmp(text, expected, sizeof expected), "layout and escapes"))
        printf("%s", text ? text : "(nothing)\n");
    mcr_json_writer_destroy(writer);
}

/* The text that a single string becomes. */
static int writes(const char *text, const char *expected)
{
    struct mcr_json_writer *writer = mcr_json_writer_create(NULL);
    int good;
    mcr_json_text(writer, NULL, text);
    good = mcr_json_writer_finish(writer) == 0 && !strcmp(mcr_json_writer_text(writer, NULL), expected);
    mcr_json_writer_destroy(writer);
    return good;
}

static void test_invalid_utf8(void)
{
#define FFFD "\xef\xbf\xbd"
    ok(writes("\xff", "\"" FFFD "\"\n") && writes("a\x80z", "\"a" FFFD "z\"\n"), "a stray byte becomes U+FFFD");
    ok(writes("\xc0\xaf", "\"" FFFD FFFD "\"\n") && writes("\xe0\x80\xaf", "\"" FFFD FFFD FFFD "\"\n"), "overlong forms are refused");
    ok(writes("\xed\xa0\x80", "\"" FFFD FFFD FFFD "\"\n") &&
           writes("\xf4\x90\x80\x80", "\"" FFFD FFFD FFFD FFFD "\"\n"), "surrogates and what is above U+10FFFF");
    ok(writes("\xe2\x82", "\"" FFFD FFFD "\"\n") && writes("", "\"\"\n"), "a sequence cut off, an empty text");
}

static void test_numbers(void)
{
    static const struct {
        double number;
        const char *text;
    } known[] = {{0, "0"}, {-0.0, "-0"}, {0.1, "0.1"}, {1.0 / 3, "0.3333333333333333"}, {0.1 + 0.2, "0.30000000000000004"},
                 {100, "100"}, {1e15, "1e+15"},
                 {123456789012345, "123456789012345"}, {1e21, "1e+21"}, {5e-324, "4.94065645841247e-324"}, {DBL_MAX, "1.7976931348623157e+308"},
                 {NAN, "null"}, {INFINITY, "null"}, {-INFINITY, "null"}, {-2.5e-5, "-2.5e-05"}};
    char text[MCR_JSON_NUMBER_SIZE], shorter[64];
    uint64_t state = 1, wrong = 0, long_ones = 0;
    int good = 1;

    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        mcr_json_format(known[i].number, text);
        if (strcmp(text, known[i].text)) {
            printf("# %s, expected %s\n", text, known[i].text);
            good = 0;
        }
    }
    ok(good, "numbers as expected");
    for (uint32_t i = 0; i < 200000; i++) {
        uint64_t bits = random_bits(&state);
        double number, back;
        memcpy(&number, &bits, sizeof number);
        if (i & 1) /* few digits */
            number = (double)(int64_t)(bits >> 40) / 1000.0;
        if (!isfinite(number))
            continue;
        mcr_json_format(number, text);
        back = strtod(text, NULL);
        wrong += memcmp(&back, &number, sizeof back) != 0 || strlen(text) >= MCR_JSON_NUMBER_SIZE;
        snprintf(shorter, sizeof shorter, "%.15g", number);
        long_ones += strtod(shorter, NULL) == number && strcmp(shorter, text);
    }
    ok(wrong == 0, "200000 doubles read back as they were");
    ok(long_ones == 0, "and none is longer than needed");
}

/* Each case must make finish fail. */
static void misuse(int which, struct mcr_json_writer *writer)
{
    switch (which) {
    case 0: break; /* nothing */
    case 1: mcr_json_begin_object(writer, NULL); break;
    case 2: mcr_json_end(writer); break;
    case 3: mcr_json_null(writer, NULL), mcr_json_null(writer, NULL); break;
    case 4: mcr_json_null(writer, "key"); break;
    case 5: mcr_json_begin_object(writer, NULL), mcr_json_null(writer, NULL), mcr_json_end(writer); break;
    case 6: mcr_json_begin_array(writer, NULL), mcr_json_null(writer, "key"), mcr_json_end(writer); break;
    case 7: mcr_json_begin_array(writer, NULL), mcr_json_end(writer), mcr_json_end(writer); break;
    default:
        for (uint32_t i = 0; i < MCR_JSON_DEPTH + 1; i++)
            mcr_json_begin_array(writer, NULL);
        for (uint32_t i = 0; i < MCR_JSON_DEPTH + 1; i++)
            mcr_json_end(writer);
    }
}

static void test_failures(void)
{
    struct mcr_json_writer *writer;
    FILE *full = fopen("/dev/full", "w");
    int good = 1;

    for (int which = 0; which < 9; which++) {
        writer = mcr_json_writer_create(NULL);
        misuse(which, writer);
        if (mcr_json_writer_finish(writer) != -1) {
            printf("# case %d\n", which);
            good = 0;
        }
        mcr_json_writer_destroy(writer);
    }
    ok(good, "misuse is told by finish");
    writer = mcr_json_writer_create(NULL);
    for (uint32_t i = 0; i < MCR_JSON_DEPTH; i++)
        mcr_json_begin_array(writer, NULL);
    for (uint32_t i = 0; i < MCR_JSON_DEPTH; i++)
        mcr_json_end(writer);
    ok(mcr_json_writer_finish(writer) == 0, "the full depth is allowed");
    mcr_json_writer_destroy(writer);
    if (full) {
        writer = mcr_json_writer_create(full);
        mcr_json_text(writer, NULL, "some text");
        ok(mcr_json_writer_finish(writer) == -1 && !mcr_json_writer_text(writer, NULL), "a full device is told by finish");
        mcr_json_writer_destroy(writer);
        fclose(full);
    } else {
        tap_skip("a full device", "no /dev/full");
    }
    mcr_json_writer_destroy(NULL);
}

/* A large text to a stream and to a buffer: the same bytes, and the reader finds what was written. */
static void write_many(struct mcr_json_writer *writer)
{
    uint64_t state = 5;
    mcr_json_begin_array(writer, NULL);
    for (uint32_t i = 0; i < 20000; i++) {
        char text[9] = {0};
        uint64_t bits = random_bits(&state);
        for (int c = 0; c < 8; c++)
            text[c] = (char)(1 + (bits >> 8 * c) % 127);
        mcr_json_begin_object(writer, NULL);
        mcr_json_text(writer, text, text);
        mcr_json_number(writer, "second key, longer than any text", (double)bits);
        mcr_json_end(writer);
    }
    mcr_json_end(writer);
}

static void test_round_trip(void)
{
    struct mcr_json_writer *buffer = mcr_json_writer_create(NULL), *stream;
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    struct mcr_arena *arena = mcr_arena_create(0);
    char *streamed = NULL;
    size_t length, streamed_length = 0, wrong = 0;
    FILE *to = open_memstream(&streamed, &streamed_length);
    struct mcr_json *root;
    uint64_t state = 5;

    stream = mcr_json_writer_create(to);
    write_many(buffer);
    write_many(stream);
    ok(mcr_json_writer_finish(buffer) == 0 && mcr_json_writer_finish(stream) == 0, "a long text is written to a buffer and to a stream");
    fclose(to);
    const char *text = mcr_json_writer_text(buffer, &length);
    ok(length == streamed_length && !memcmp(text, streamed, length), "they are the same %zu bytes", length);
    root = mcr_json_parse(arena, diagnostics, mcr_diagnostics_source(diagnostics, "written", text, length, NULL));
    for (struct mcr_json *item = root ? root->first : NULL; item; item = item->next) {
        uint64_t bits = random_bits(&state);
        char expected[9] = {0};
        for (int c = 0; c < 8; c++)
            expected[c] = (char)(1 + (bits >> 8 * c) % 127);
        struct mcr_json *member = mcr_json_get(item, expected), *second = mcr_json_get(item, "second key, longer than any text");
        wrong += !member || !second || strcmp(member->text, expected) || second->number != (double)bits;
    }
    ok(root && root->count == 20000 && wrong == 0, "and the reader finds in it what was written");
    mcr_json_writer_destroy(buffer);
    mcr_json_writer_destroy(stream);
    mcr_arena_destroy(arena);
    mcr_diagnostics_destroy(diagnostics);
    free(streamed);
}

int main(void)
{
    test_layout();
    test_invalid_utf8();
    test_numbers();
    test_failures();
    test_round_trip();
    return tap_done();
}
