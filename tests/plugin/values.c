/* SPDX-License-Identifier: Apache-2.0 */
/* Settings against parameter tables: material blocks with the real plugins, and every type and range by hand. */
#include "../tap.h"
#include "base/cpu.h"
#include "plugin/node.h"
#include "plugin/values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct mcr_arena *arena;
static struct mcr_diagnostics *diagnostics;
static struct mcr_registry *registry;

static void begin(void)
{
    arena = mcr_arena_create(64 << 20);
    diagnostics = mcr_diagnostics_create();
    registry = mcr_registry_create(diagnostics, mcr_cpu_isa(), NULL);
}

static void end(void)
{
    mcr_registry_destroy(registry);
    mcr_diagnostics_destroy(diagnostics);
    mcr_arena_destroy(arena);
}

/* What was recorded, without the lines of the source and their carets. Malloc'd. */
static char *recorded(void)
{
    char *text = NULL, *kept, *line, *next, *to;
    size_t length = 0;
    FILE *memory = open_memstream(&text, &length);

    mcr_diagnostics_print(diagnostics, memory, 0);
    fclose(memory);
    kept = to = calloc(length + 2, 1);
    for (line = text; *line; line = next) {
        next = line + strcspn(line, "\n");
        next += *next == '\n';
        if (*line != ' ') {
            memcpy(to, line, (size_t)(next - line));
            to += next - line;
        }
    }
    free(text);
    return kept;
}

/* The material of a text of one block (behind `let x = 0.25`), or NULL. */
static struct mcr_node *make(const char *block)
{
    char text[1024];
    const struct mcr_item *root;

    snprintf(text, sizeof text, "mcrender 1\nlet x = 0.25\nlet c = (x, 1, 2 * x)\nlet s = \"text\"\n%s\n", block);
    root = mcr_parse_text(arena, diagnostics, "a.scn", ".", text, strlen(text), NULL, 0);
    for (uint32_t k = 0; root && k < root->count; k++)
        if (!strcmp(root->item[k].word, "material"))
            return mcr_material_create(arena, diagnostics, registry, &root->item[k]);
    return NULL;
}

static void good(const char *block, uint32_t count, const double *number, uint32_t does)
{
    struct mcr_material_traits traits;
    struct mcr_node *node;
    uint32_t wrong;
    char *said;

    begin();
    node = make(block);
    if (!ok(node && node->values.count == count && mcr_material_traits(node, diagnostics, &traits) == 0 && traits.does == does, "%s", block)) {
        said = recorded();
        printf("# %s\n", said);
        free(said);
    } else {
        wrong = 0;
        for (uint32_t k = 0; k < 3 * count; k++)
            wrong += node->values.number[k] != number[k];
        ok(wrong == 0, "  has the values");
    }
    mcr_material_destroy(node);
    end();
}

static void bad(const char *block, const char *expected)
{
    struct mcr_node *node;
    char *said, *at;

    begin();
    node = make(block);
    said = recorded();
    at = strstr(said, "a.scn:"); /* warnings of unused `let`s may stand before or behind */
    while (at && !strncmp(at + strcspn(at, " "), " warning", 8))
        at = strstr(at + 1, "a.scn:");
    if (!ok(!node && at && !strncmp(at, expected, strlen(expected)), "refused: %s", block))
        printf("# %s\n# instead of\n# %s\n", said, expected);
    mcr_material_destroy(node);
    free(said);
    end();
}

static void test_materials(void)
{
    good("material w lambert { }", 1, (double[]){0.5, 0.5, 0.5}, MCR_MATERIAL_REFLECTS);
    good("material w lambert { albedo 0.73 }", 1, (double[]){0.73, 0.73, 0.73}, MCR_MATERIAL_REFLECTS);
    good("material w lambert { albedo (0, 0.5, 1) }", 1, (double[]){0, 0.5, 1}, MCR_MATERIAL_REFLECTS);
    good("material w lambert { albedo x }", 1, (double[]){0.25, 0.25, 0.25}, MCR_MATERIAL_REFLECTS);
    good("material w lambert { albedo c }", 1, (double[]){0.25, 1, 0.5}, MCR_MATERIAL_REFLECTS);
    good("material w lambert { albedo (x, 2 * x, x + x / 2) }", 1, (double[]){0.25, 0.5, 0.375}, MCR_MATERIAL_REFLECTS);
    good("material w lambert { albedo srgb(1, 0, 1) }", 1, (double[]){1, 0, 1}, MCR_MATERIAL_REFLECTS);
    good("material l emitter { radiance 15 }", 3, (double[]){15, 15, 15, 0, 0, 0, 0, 0, 0}, MCR_MATERIAL_EMITS_FRONT);
    good("material l emitter { albedo 0.5   sides two   radiance (1, 2, 3) }", 3, (double[]){1, 2, 3, 1, 0, 0, 0.5, 0.5, 0.5},
         MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK | MCR_MATERIAL_REFLECTS);
    good("material l emitter { radiance 0 }", 3, (double[]){0, 0, 0, 0, 0, 0, 0, 0, 0}, 0);

    bad("material w lambret { }", "a.scn:5:12: error: unknown material 'lambret', expected the name of a plugin\na.scn:5:12: note: did you mean 'lambert'?\n");
    bad("material w cosine { }", "a.scn:5:12: error: 'cosine' is a sampler, expected a material\n");
    bad("material w lambert { albdo 0.5 }",
        "a.scn:5:22: error: unknown setting 'albdo' of 'lambert', expected albedo\na.scn:5:22: note: did you mean 'albedo'?\n");
    bad("material l emitter { glow 3   radiance 2 }", "a.scn:5:22: error: unknown setting 'glow' of 'emitter', expected radiance, sides or albedo\n");
    bad("material w lambert { albedo 1.5 }", "a.scn:5:29: error: 'albedo' of 'lambert' is 1.5, expected 0 to 1\n");
    bad("material w lambert { albedo -x }", "a.scn:5:29: error: 'albedo' of 'lambert' is -0.25, expected 0 to 1\n");
    bad("material w lambert { albedo (0.5, 1.5, 0.5) }", "a.scn:5:35: error: 'albedo' of 'lambert' is 1.5, expected 0 to 1\n");
    bad("material w lambert { albedo (0.5, 0.5) }",
        "a.scn:5:29: error: 'albedo' of 'lambert' has 2 components, expected a colour: one number, or three as (red, green, blue)\n");
    bad("material w lambert { albedo \"white\" }",
        "a.scn:5:29: error: 'albedo' of 'lambert' is a string, expected a colour: one number, or three as (red, green, blue)\n");
    bad("material w lambert { albedo s }",
        "a.scn:5:29: error: 'albedo' of 'lambert' is a string, expected a colour: one number, or three as (red, green, blue)\n");
    bad("material w lambert { albedo white }",
        "a.scn:5:29: error: unknown name 'white' for 'albedo' of 'lambert', expected a colour: one number, or three as (red, green, blue)\n");
    bad("material w lambert { albedo 0.5   albedo 0.6 }",
        "a.scn:5:35: error: 'albedo' of 'lambert' is given twice, expected once\na.scn:5:22: note: the first one is here\n");
    bad("material l emitter { }", "a.scn:5:12: error: 'emitter' needs 'radiance', expected a colour: one number, or three as (red, green, blue)\n");
    bad("material l emitter { radiance -1 }", "a.scn:5:31: error: 'radiance' of 'emitter' is -1, expected 0 to 1e+100 W/(sr m^2)\n");
    bad("material l emitter { radiance 1   sides both }", "a.scn:5:41: error: unknown word 'both' for 'sides' of 'emitter', expected one or two\n");
    bad("material l emitter { radiance 1   sides 2 }", "a.scn:5:41: error: 'sides' of 'emitter' is a number, expected a word\n");
    bad("material l emitter { radiance 1   sides \"two\" }", "a.scn:5:41: error: 'sides' of 'emitter' is a string, expected a word\n");
    bad("material l emitter { radiance -1   sides both   albedo 2 }",
        "a.scn:5:31: error: 'radiance' of 'emitter' is -1, expected 0 to 1e+100 W/(sr m^2)\n"
        "a.scn:5:42: error: unknown word 'both' for 'sides' of 'emitter', expected one or two\n"
        "a.scn:5:56: error: 'albedo' of 'emitter' is 2, expected 0 to 1\n");
}

/* ---- by hand ---- */

static void check(const struct mcr_parameter *parameter, const struct mcr_value *value, int status, double first, const char *says)
{
    double number[3];
    char *said;
    int is;

    begin();
    is = mcr_value_check(diagnostics, parameter, value, "thing", number);
    said = recorded();
    if (!ok(is == status && (status || number[0] == first) && (says ? strstr(said, says) != NULL : !*said), "%s", says ? says : parameter->summary))
        printf("# %s", said);
    free(said);
    end();
}

static struct mcr_value number_value(double number)
{
    return (struct mcr_value){.kind = MCR_VALUE_NUMBER, .number = number};
}

static void test_types(void)
{
    struct mcr_parameter angle = {sizeof angle, MCR_TYPE_NUMBER, MCR_PARAMETER_ABOVE_MIN | MCR_PARAMETER_BELOW_MAX, 0, "fov", "degrees", NULL, "in range",
                                  {40}, 0, 180};
    struct mcr_parameter count = {sizeof count, MCR_TYPE_INTEGER, 0, 0, "spp", "", NULL, "a whole number in range", {1}, 1, INFINITY};
    struct mcr_parameter any = {sizeof any, MCR_TYPE_NUMBER, 0, 0, "x", "m", NULL, "any number", {0}, -INFINITY, INFINITY};
    struct mcr_parameter least = {sizeof least, MCR_TYPE_NUMBER, 0, 0, "x", "", NULL, "at most", {0}, -INFINITY, 3};
    struct mcr_parameter way = {sizeof way, MCR_TYPE_CHOICE, 0, 0, "by", "", "area|solid-angle", "a word", {0}, 0, 0};
    struct mcr_value value = number_value(40), zero = number_value(-0.0), name = {.kind = MCR_VALUE_NAME, .text = "area", .bound = &value};
    struct mcr_value wrong = {.kind = MCR_VALUE_ERROR}, loop = {.kind = MCR_VALUE_NAME, .text = "loop", .bound = &loop};
    double number[3];

    check(&angle, &value, 0, 40, NULL);
    check(&angle, &name, 0, 40, NULL);
    check(&way, &name, 0, 0, NULL);
    value = number_value(0);
    check(&angle, &value, -1, 0, "'fov' of 'thing' is 0, expected above 0 and below 180 degrees");
    value = number_value(180);
    check(&angle, &value, -1, 0, "'fov' of 'thing' is 180, expected above 0 and below 180 degrees");
    value = number_value(NAN);
    check(&angle, &value, -1, 0, "expected above 0 and below 180 degrees");
    check(&count, &value, -1, 0, "expected a whole number");
    value = number_value(INFINITY);
    check(&any, &value, -1, 0, "'x' of 'thing' is inf, expected a finite number, in m");
    check(&count, &value, -1, 0, "expected a whole number");
    value = number_value(1e16);
    check(&count, &value, -1, 0, "expected a whole number");
    value = number_value(9007199254740992.0);
    check(&count, &value, 0, 9007199254740992.0, NULL);
    value = number_value(0);
    check(&count, &value, -1, 0, "'spp' of 'thing' is 0, expected at least 1");
    value = number_value(4);
    check(&least, &value, -1, 0, "'x' of 'thing' is 4, expected at most 3");
    value = number_value(1e300);
    check(&any, &value, 0, 1e300, NULL);
    check(&any, &wrong, -1, 0, NULL);
    check(&any, &loop, -1, 0, "unknown name 'loop'");
    begin();
    ok(mcr_value_check(diagnostics, &any, &zero, "thing", number) == 0 && !signbit(number[0]), "no negative zero");
    end();
}

static void test_text(void)
{
    struct mcr_parameter colour = {.type = MCR_TYPE_COLOUR, .unit = ""}, way = {.type = MCR_TYPE_CHOICE, .choices = "one|two|three"};
    char text[64] = "", word[MCR_MAX_WORD + 1];
    const double third[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3}, mixed[3] = {0.1, 1e-300, 3}, two[3] = {2};

    mcr_value_text(&colour, third, text, sizeof text);
    ok(strtod(text, NULL) == 1.0 / 3, "a number reads back: %s", text);
    mcr_value_text(&colour, mixed, text, sizeof text);
    ok(!strcmp(text, "(0.1, 1e-300, 3)"), "a colour: %s", text);
    mcr_value_text(&way, two, text, sizeof text);
    ok(!strcmp(text, "three"), "a word: %s", text);
    mcr_value_text(&colour, mixed, text, 8);
    ok(!strcmp(text, "(0.1, 1"), "what does not fit is cut");
    mcr_choice_word("one|two", 5, word);
    ok(mcr_choice_count("one|two") == 2 && !*word, "choices are counted, and there is none beyond");
}

int main(void)
{
    test_materials();
    test_types();
    test_text();
    return tap_done();
}
