/* SPDX-License-Identifier: Apache-2.0 */
/* Sampler expressions with the real plugins: what is built, its normal form, and the exact diagnostics of what is wrong. */
#include "../tap.h"
#include "base/cpu.h"
#include "plugin/node.h"

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
        if (*line != ' ' && *line) {
            memcpy(to, line, (size_t)(next - line));
            to += next - line;
        }
    }
    free(text);
    return kept;
}

static struct mcr_sampler *make(const char *text, int has_lights)
{
    const struct mcr_value *value = mcr_parse_value(arena, diagnostics, "--sampler", text);

    return value ? mcr_sampler_create(arena, diagnostics, registry, value, 100, has_lights) : NULL;
}

/* Built, and printed as `normal`, which reads back as itself. */
static void good(const char *text, const char *normal, uint32_t sources, uint32_t dimensions, uint32_t covers)
{
    struct mcr_sampler *sampler, *again;
    char *said;

    begin();
    sampler = make(text, 1);
    said = recorded();
    if (!ok(sampler && !*said && !strcmp(sampler->expression, normal), "%s is %s", text, normal)) {
        printf("# %s\n# %s\n", sampler ? sampler->expression : "not built", said);
    } else {
        const struct mcr_technique *technique = sampler->directions->technique;

        again = make(normal, 1);
        ok(again && !strcmp(again->expression, normal), "  which reads back as itself");
        ok(sampler->source_count == sources && sampler->correlated == !strncmp(text, "stratified", 10) && sampler->independent &&
               !strcmp(sampler->independent->descriptor->name, "independent"),
           "  with %u number sources before the independent one", sources);
        ok(technique->dimensions == dimensions && technique->covers == covers && technique->continues == 1,
           "  with %u dimensions (%u), covering %u (%u)", dimensions, technique->dimensions, covers, technique->covers);
        mcr_sampler_destroy(again);
    }
    mcr_sampler_destroy(sampler);
    free(said);
    end();
}

/* Refused, with exactly these diagnostics; a last line of "..." stands for anything more. */
static void bad(const char *text, int has_lights, const char *expected)
{
    struct mcr_sampler *sampler;
    size_t length = strlen(expected);
    char *said;
    int same;

    begin();
    sampler = make(text, has_lights);
    said = recorded();
    same = length >= 3 && !strcmp(expected + length - 3, "...") ? !strncmp(said, expected, length - 3) : !strcmp(said, expected);
    if (!ok(!sampler && same, "%.60s is refused", text))
        printf("# %s\n# instead of\n# %s\n", said, expected);
    mcr_sampler_destroy(sampler);
    free(said);
    end();
}

static void test_limits(void)
{
    char text[8192] = "mixture(", deep[512] = "";
    int k;

    for (k = 0; k < 16; k++)
        strcat(text, k ? ", cosine" : "cosine");
    strcat(text, ", uniform, light)");
    bad(text, 1, "--sampler:1:137: error: 'mixture' has more than 16 samplers inside it, expected at most 16\n");
    for (k = 0; k < 7; k++)
        strcat(deep, "mixture(");
    strcat(deep, "cosine)))))))");
    good(deep, "mixture(mixture(mixture(mixture(mixture(mixture(mixture(cosine 1) 1) 1) 1) 1) 1) 1)", 0, 9, MCR_COVERS_REFLECTION);
    memmove(deep + 8, deep, strlen(deep) + 1);
    memcpy(deep, "mixture(", 8);
    strcat(deep, ")");
    bad(deep, 1, "--sampler:1:65: error: samplers are nested too deeply, expected at most 8 levels\n");
    /* 16 mixtures of 16 mixtures of 16: above the limit of nodes. */
    *text = 0;
    strcat(text, "mixture(");
    for (int a = 0; a < 16; a++) {
        strcat(text, a ? ", mixture(" : "mixture(");
        for (int b = 0; b < 16; b++)
            strcat(text, b ? ", cosine" : "cosine");
        strcat(text, ")");
    }
    strcat(text, ")");
    bad(text, 1, "--sampler:1:2064: error: too many samplers in one expression, expected at most 256\n");
}

int main(void)
{
    good("cosine", "cosine", 0, 2, MCR_COVERS_REFLECTION);
    good("uniform", "uniform", 0, 2, MCR_COVERS_REFLECTION);
    good("light", "light", 0, 3, MCR_COVERS_EMITTERS);
    good("light()", "light", 0, 3, MCR_COVERS_EMITTERS);
    good("light(by=solid-angle)", "light", 0, 3, MCR_COVERS_EMITTERS);
    good("light(by=area)", "light(by=area)", 0, 3, MCR_COVERS_EMITTERS);
    good("mixture(cosine 1, light 1)", "mixture(cosine 1, light 1)", 0, 4, MCR_COVERS_REFLECTION | MCR_COVERS_EMITTERS);
    good("mixture(light(by=area) 0.1, cosine)", "mixture(light(by=area) 0.1, cosine 1)", 0, 4, MCR_COVERS_REFLECTION | MCR_COVERS_EMITTERS);
    good("mixture(cosine 0, light 2)", "mixture(cosine 0, light 2)", 0, 4, MCR_COVERS_EMITTERS);
    good("mixture(cosine 1e308, light 1e308)", "mixture(cosine 1e+308, light 1e+308)", 0, 4, MCR_COVERS_REFLECTION | MCR_COVERS_EMITTERS);
    good("stratified(cosine)", "stratified(cosine)", 1, 2, MCR_COVERS_REFLECTION);
    good("stratified(n=4, m=4, mixture(light(by=area) 1, cosine 1))", "stratified(n=4, m=4, mixture(light(by=area) 1, cosine 1))", 1, 4,
         MCR_COVERS_REFLECTION | MCR_COVERS_EMITTERS);
    good("stratified(n=0, cosine)", "stratified(cosine)", 1, 2, MCR_COVERS_REFLECTION);
    good("stratified(antithetic(of=bounces, sobol(cosine)))", "stratified(antithetic(of=bounces, sobol(cosine)))", 3, 2, MCR_COVERS_REFLECTION);
    good("independent(stratified(uniform))", "independent(stratified(uniform))", 2, 2, MCR_COVERS_REFLECTION);

    bad("cosin", 1, "--sampler:1:1: error: unknown sampler 'cosin', expected the name of a plugin\n--sampler:1:1: note: did you mean 'cosine'?\n");
    bad("xyzzyplugh", 1, "--sampler:1:1: error: unknown sampler 'xyzzyplugh', expected the name of a plugin\nnote: plugins found: antithetic, bluenoise, ...");
    bad("lambert", 1, "--sampler:1:1: error: 'lambert' is a material, expected a sampler\n");
    bad("3", 1, "--sampler:1:1: error: this is a number, expected a sampler, as in mixture(cosine 1, light 1)\n");
    bad("light", 0, "--sampler:1:1: error: 'light' has nothing to draw: no emitter of this scene can be sampled\n");
    bad("mixture", 1, "--sampler:1:1: error: 'mixture' needs samplers inside it, as in mixture(cosine 1, light 1)\n");
    bad("cosine(uniform)", 1, "--sampler:1:1: error: this sampler takes no samplers inside it\n");
    bad("stratified", 1, "--sampler:1:1: error: 'stratified' supplies numbers and has 0 samplers inside it, expected one, as in stratified(cosine)\n");
    bad("stratified(cosine, light)", 1,
        "--sampler:1:1: error: 'stratified' supplies numbers and has 2 samplers inside it, expected one, as in stratified(cosine)\n");
    bad("stratified(cosine 2)", 1, "--sampler:1:19: error: the sampler inside 'stratified' has a weight, expected none\n");
    bad("mixture(stratified(cosine), light)", 1,
        "--sampler:1:9: error: 'stratified' supplies numbers and stands outside of all directions, as in stratified(mixture(...))\n");
    bad("mixture(cosine -1, light)", 1, "--sampler:1:16: error: this weight is -1, expected at least 0\n");
    bad("mixture(cosine 0, light 0)", 1, "--sampler:1:1: error: all weights of 'mixture' are 0, expected at least one above 0\n");
    bad("light(by=aera)", 1,
        "--sampler:1:10: error: unknown word 'aera' for 'by' of 'light', expected area or solid-angle\n--sampler:1:10: note: did you mean 'area'?\n");
    bad("light(by=3)", 1, "--sampler:1:10: error: 'by' of 'light' is a number, expected a word\n");
    bad("light(buy=area)", 1,
        "--sampler:1:7: error: unknown setting 'buy' of 'light', expected by\n--sampler:1:7: note: did you mean 'by'?\n");
    bad("uniform(n=3)", 1, "--sampler:1:9: error: unknown setting 'n' of 'uniform', expected none: it has no parameters\n");
    bad("cosine(n=3)", 1, "--sampler:1:8: error: unknown setting 'n' of 'cosine', expected compat\n");
    bad("stratified(n=2.5, cosine)", 1, "--sampler:1:14: error: 'n' of 'stratified' is 2.5, expected a whole number\n");
    bad("stratified(n=-1, cosine)", 1, "--sampler:1:14: error: 'n' of 'stratified' is -1, expected 0 to 65536\n");
    bad("stratified(n=2, n=3, cosine)", 1,
        "--sampler:1:17: error: 'n' of 'stratified' is given twice, expected once\n--sampler:1:12: note: the first one is here\n");
    bad("stratified(n=65536, m=65536, cosine)", 1, "--sampler:1:1: error: n * m is above 1073741824 (2^30), the largest number of cells\n");
    bad("mixture(cosin 1, ligth 1, uniform(n=1))", 1,
        "--sampler:1:9: error: unknown sampler 'cosin', expected the name of a plugin\n--sampler:1:9: note: did you mean 'cosine'?\n"
        "--sampler:1:18: error: unknown sampler 'ligth', expected the name of a plugin\n--sampler:1:18: note: did you mean 'light'?\n"
        "--sampler:1:35: error: unknown setting 'n' of 'uniform', expected none: it has no parameters\n");
    test_limits();
    return tap_done();
}
