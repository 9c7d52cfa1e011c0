/* SPDX-License-Identifier: Apache-2.0 */
/* Diagnostics: their exact text, what is counted, and the nearest word. */
#include "base/diag.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

static char *printed;
static size_t printed_length;

static const char *print(struct mcr_diagnostics *diagnostics, int colour)
{
    FILE *file;
    free(printed);
    printed = NULL;
    file = open_memstream(&printed, &printed_length);
    mcr_diagnostics_print(diagnostics, file, colour);
    fclose(file);
    return printed;
}

static void expect(struct mcr_diagnostics *diagnostics, const char *text, const char *what)
{
    if (!ok(strcmp(print(diagnostics, 0), text) == 0, "%s", what))
        printf("# expected:\n%s# got:\n%s", text, printed);
}

static const struct mcr_source *source(struct mcr_diagnostics *diagnostics, const char *text)
{
    return mcr_diagnostics_source(diagnostics, "scene.scn", text, strlen(text), NULL);
}

static void format(void)
{
    struct mcr_diagnostics *d = mcr_diagnostics_create();
    const struct mcr_source *s = source(d, "one\n    raduis 3\n\tx\t\xc3\xa9 y\r\nlast");

    mcr_report(d, MCR_ERROR, (struct mcr_place){ s, 2, 5, 6 }, "unknown setting '%s'", "raduis");
    mcr_report(d, MCR_NOTE, (struct mcr_place){ s, 2, 5, 6 }, "did you mean 'radius'?");
    expect(d,
           "scene.scn:2:5: error: unknown setting 'raduis'\n"
           "    2 |     raduis 3\n"
           "      |     ^~~~~~\n"
           "scene.scn:2:5: note: did you mean 'radius'?\n",
           "an error with its line, and a note at the same place without");
    expect(d, "", "nothing is printed twice");

    mcr_report(d, MCR_WARNING, (struct mcr_place){ s, 3, 7, 1 }, "w");
    mcr_report(d, MCR_NOTE, (struct mcr_place){ s, 4, 1, 99 }, "elsewhere");
    expect(d,
           "scene.scn:3:7: warning: w\n"
           "    3 | \tx\t\xc3\xa9 y\n"
           "      | \t \t  ^\n"
           "scene.scn:4:1: note: elsewhere\n"
           "    4 | last\n"
           "      | ^~~~\n",
           "tabs and UTF-8 keep the caret in its place; CR LF; a place is cut at the line's end");

    mcr_report(d, MCR_ERROR, (struct mcr_place){ 0 }, "no place");
    mcr_report(d, MCR_ERROR, (struct mcr_place){ s, 4, 5, 1 }, "at the end");
    mcr_report(d, MCR_ERROR, (struct mcr_place){ s, 9, 1, 1 }, "no such line");
    expect(d,
           "error: no place\n"
           "scene.scn:4:5: error: at the end\n"
           "    4 | last\n"
           "      |     ^\n"
           "scene.scn:9:1: error: no such line\n",
           "without a place, behind the last byte, and behind the last line");

    mcr_report(d, MCR_ERROR, (struct mcr_place){ s, 1, 1, 3 }, "red");
    ok(strcmp(print(d, 1), "\033[1mscene.scn:1:1: \033[31merror:\033[0m red\n    1 | one\n      | \033[31m^~~\033[0m\n") == 0, "in colour");
    ok(mcr_diagnostics_errors(d) == 5 && mcr_diagnostics_warnings(d) == 1, "errors and warnings are counted");
    mcr_diagnostics_destroy(d);
}

static void hostile_text(void)
{
    struct mcr_diagnostics *d = mcr_diagnostics_create();
    const struct mcr_source *s = source(d, "\xef\xbb\xbf" "a\x1b[31m\xff\xc3 \xe2\x82\xac|");
    char *large = malloc(100001);

    mcr_report(d, MCR_ERROR, (struct mcr_place){ s, 1, 13, 1 }, "an escape \x1b and a byte \xfe");
    expect(d,
           "scene.scn:1:13: error: an escape ? and a byte ?\n"
           "    1 | a?[31m?? \xe2\x82\xac|\n"
           "      |          " " ^\n",
           "control characters and broken UTF-8 do not reach the terminal; a byte order mark is no part of the line");

    memset(large, 'x', 100000);
    large[100000] = '\0';
    mcr_report(d, MCR_ERROR, (struct mcr_place){ 0 }, "%s", large);
    ok(strlen(print(d, 0)) < 2100, "a message is cut");
    large[50000] = 'Y';
    s = mcr_diagnostics_source(d, "long.scn", large, 100000, NULL);
    mcr_report(d, MCR_ERROR, (struct mcr_place){ s, 1, 50001, 3 }, "far");
    print(d, 0);
    ok(strlen(printed) < 400 && strstr(printed, "    1 | ...xxx") && strstr(printed, "xYx") && strstr(printed, "x...\n"), "a long line is cut around the column");
    ok(strchr(printed, 'Y') - strstr(printed, "    1 | ") == strchr(printed, '^') - strstr(printed, "      | "),
       "with the caret below it");
    mcr_diagnostics_destroy(d);
    free(large);
}

static void includes(void)
{
    struct mcr_diagnostics *d = mcr_diagnostics_create();
    const struct mcr_source *a = source(d, "include \"b\"\n"), *b, *c;
    struct mcr_place at_a = { a, 1, 9, 3 }, at_b;
    b = mcr_diagnostics_source(d, "b.scn", "\n  include \"c\"\n", 15, &at_a);
    at_b = (struct mcr_place){ b, 2, 11, 3 };
    c = mcr_diagnostics_source(d, "c.scn", "x\ny\n", 4, &at_b);

    mcr_report(d, MCR_ERROR, (struct mcr_place){ c, 1, 1, 1 }, "one");
    mcr_report(d, MCR_ERROR, (struct mcr_place){ c, 2, 1, 1 }, "two");
    mcr_report(d, MCR_NOTE, (struct mcr_place){ b, 2, 3, 7 }, "note");
    mcr_report(d, MCR_ERROR, (struct mcr_place){ b, 2, 3, 7 }, "three");
    expect(d,
           "in file included from b.scn:2:11:\n"
           "in file included from scene.scn:1:9:\n"
           "c.scn:1:1: error: one\n"
           "    1 | x\n"
           "      | ^\n"
           "c.scn:2:1: error: two\n"
           "    2 | y\n"
           "      | ^\n"
           "b.scn:2:3: note: note\n"
           "    2 |   include \"c\"\n"
           "      |   ^~~~~~~\n"
           "in file included from scene.scn:1:9:\n"
           "b.scn:2:3: error: three\n"
           "    2 |   include \"c\"\n"
           "      |   ^~~~~~~\n",
           "the chain of includes stands before the first message of a file");
    mcr_diagnostics_destroy(d);
}

static void counts(void)
{
    struct mcr_diagnostics *d = mcr_diagnostics_create();
    size_t lines = 0;

    mcr_diagnostics_werror(d, 1);
    mcr_report(d, MCR_WARNING, (struct mcr_place){ 0 }, "unused");
    ok(mcr_diagnostics_errors(d) == 1 && mcr_diagnostics_warnings(d) == 0, "with --werror a warning is an error");
    expect(d, "error: unused [--werror]\n", "and says why");
    mcr_diagnostics_werror(d, 0);
    for (int i = 0; i < 200; i++) {
        mcr_report(d, MCR_ERROR, (struct mcr_place){ 0 }, "e%d", i);
        mcr_report(d, MCR_NOTE, (struct mcr_place){ 0 }, "n%d", i);
    }
    for (const char *at = print(d, 0); *at; at++)
        lines += *at == '\n';
    ok(lines == 2 * 99 + 1, "100 errors are kept with their notes, and a line tells that there are more: %zu", lines);
    ok(strstr(printed, "\nnote: n98\n101 more messages are not shown\n") != NULL, "how many");
    ok(mcr_diagnostics_errors(d) == 201, "all are counted");
    mcr_report(d, MCR_WARNING, (struct mcr_place){ 0 }, "a warning");
    expect(d, "warning: a warning\n", "warnings have room of their own");
    mcr_diagnostics_destroy(d);
    mcr_diagnostics_destroy(NULL);
}

static void nearest(void)
{
    static const char *const words[] = { "radius", "center", "material", "transform", "u", "v", "to" };
    static const struct {
        const char *word, *nearest;
    } cases[] = {
        { "raduis", "radius" },    /* two letters changed places: one edit */
        { "radus", "radius" },     { "radiuss", "radius" }, { "xadius", "radius" },
        { "centre", "center" },    { "tranfsrm", "transform" },
        { "matrl", NULL },         /* three edits of five letters */
        { "x", NULL },             /* nothing of "u" is left */
        { "ot", "to" },            { "uu", "u" },           { "", NULL },
        { "something", NULL },     { "radius", "radius" },
    };
    char large[100];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *got = mcr_nearest_word(cases[i].word, words, sizeof words / sizeof words[0]);
        ok(got == cases[i].nearest || (got && cases[i].nearest && strcmp(got, cases[i].nearest) == 0), "'%s' is near %s: %s", cases[i].word,
           cases[i].nearest ? cases[i].nearest : "nothing", got ? got : "nothing");
    }
    memset(large, 'a', sizeof large - 1);
    large[sizeof large - 1] = '\0';
    ok(!mcr_nearest_word(large, words, 7), "a word of 99 letters is near nothing");
    ok(!mcr_nearest_word("radius", words, 0), "and none is near no words");
}

int main(void)
{
    format();
    hostile_text();
    includes();
    counts();
    nearest();
    free(printed);
    return tap_done();
}
