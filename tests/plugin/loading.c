/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Finding and loading: plugins made here, good ones and broken ones, in folders of this test's own. A broken plugin must be refused with
 * a message that says what is wrong, and nothing of it may be used.
 */
#include "../tap.h"
#include "base/cpu.h"
#include "plugin/describe.h"
#include "plugin/node.h"
#include "plugin/registry.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char top[512];
static const struct mcr_place nowhere;

/* The source of a plugin of directions, `name`, with preprocessor definitions that break it. */
static const char source[] =
    "#include <mcrender/sampler.h>\n"
    "#include <math.h>\n"
    "#ifndef NAME\n#define NAME \"probe\"\n#endif\n"
    "#ifndef VERSION\n#define VERSION \"1\"\n#endif\n"
    "#ifndef SIZE\n#define SIZE sizeof(struct mcr_directions_plugin)\n#endif\n"
    "#ifndef MAJOR\n#define MAJOR MCR_PLUGIN_MAJOR\n#endif\n"
    "#ifndef MINOR\n#define MINOR MCR_PLUGIN_MINOR\n#endif\n"
    "#ifndef KIND\n#define KIND MCR_KIND_DIRECTIONS\n#endif\n"
    "#ifndef ISA\n#define ISA 0\n#endif\n"
    "#ifndef COUNT\n#define COUNT 1\n#endif\n"
    "#ifndef LIST\n#define LIST list\n#endif\n"
    "#ifndef FIRST\n#define FIRST &d.head\n#endif\n"
    "#ifndef SECOND\n#define SECOND &d.head\n#endif\n"
    "#ifndef PLUGIN_SIZE\n#define PLUGIN_SIZE sizeof(struct mcr_plugin)\n#endif\n"
    "#ifndef PARAMETERS\n#define PARAMETERS 0\n#define TABLE {0}\n#endif\n"
    "#ifndef SUMMARY\n#define SUMMARY \"for tests\"\n#endif\n"
    "#ifndef DRAW\n#define DRAW draw\n#endif\n"
    "#ifndef TECHNIQUE\n#define TECHNIQUE\n#endif\n"
    "#define P(n, ...) {.size = sizeof(struct mcr_parameter), .type = MCR_TYPE_NUMBER, .name = n, .unit = \"\", .summary = \"A number.\", .max = 1, __VA_ARGS__}\n"
    "#define MORE(isa) struct mcr_directions_plugin more = {.head = {sizeof more, MCR_KIND_DIRECTIONS, isa, 0, \"probe\", \"1\", \"MIT\", \"more\", 0}, create, 0, techniques, 0, draw, density}\n"
    "static int32_t create(const struct mcr_host *h, struct mcr_context *c, const struct mcr_creation *w, void **i) { (void)h; (void)c; (void)w; *i = 0; return 0; }\n"
    "static int32_t techniques(const struct mcr_host *h, struct mcr_context *c, const void *i, struct mcr_technique *t, uint32_t *n)\n"
    "{ (void)h; (void)c; (void)i; t->kind = 1; t->continues = 1; t->covers = 1; t->dimensions = 2; *n = 1; TECHNIQUE; return 0; }\n"
    "static int32_t draw(const struct mcr_host *h, struct mcr_context *c, const void *i, uint32_t t, const struct mcr_points *at, const double *const *u,\n"
    "  const struct mcr_directions *o, double *d) { (void)h; (void)c; (void)i; (void)t; (void)at; (void)u; (void)o; (void)d; return -4; }\n"
    "static int32_t density(const struct mcr_host *h, struct mcr_context *c, const void *i, uint32_t t, const struct mcr_points *at,\n"
    "  const struct mcr_directions *o, double *d) { (void)h; (void)c; (void)i; (void)t; (void)at; (void)o; (void)d; return -4; }\n"
    "static const struct mcr_parameter parameters[] = TABLE;\n"
    "#ifdef EXTRA\nEXTRA;\n#endif\n"
    "static const struct mcr_directions_plugin d = {.head = {.size = SIZE, .kind = KIND, .isa = ISA, .parameter_count = PARAMETERS, .name = NAME,\n"
    "  .version = VERSION, .licence = \"MIT\", .summary = SUMMARY, .parameters = parameters}, .create = create, .techniques = techniques, .draw = DRAW,\n"
    "  .density = density};\n"
    "static const struct mcr_descriptor *const list[] = {FIRST, SECOND};\n"
    "#ifndef NO_SYMBOL\n"
    "const struct mcr_plugin mcr_plugin = {PLUGIN_SIZE, MAJOR, MINOR, COUNT, LIST};\n"
    "#endif\n";

/* Compiles the source with these definitions into top/folder/word.so. */
static int compile(const char *folder, const char *word, const char *definitions)
{
    const char *cc = getenv("MCR_CC"), *include = getenv("srcdir");
    char command[4096], directory[600];
    FILE *pipe;

    snprintf(directory, sizeof directory, "%s/%s", top, folder);
    mkdir(directory, 0777);
    snprintf(command, sizeof command, "%s -x c -shared -fPIC -w -I'%s/src' %s -o '%s/%s.so' -", cc ? cc : "cc", include ? include : ".",
             definitions, directory, word);
    pipe = popen(command, "w");
    if (!pipe)
        return -1;
    fputs(source, pipe);
    return pclose(pipe);
}

static void search(const char *a, const char *b)
{
    char path[1200];

    snprintf(path, sizeof path, "%s/%s:%s/%s", top, a, top, b);
    setenv("MCRENDER_PLUGIN_PATH", path, 1);
}

static char *recorded(struct mcr_diagnostics *diagnostics)
{
    char *text = NULL;
    size_t length = 0;
    FILE *memory = open_memstream(&text, &length);

    mcr_diagnostics_print(diagnostics, memory, 0);
    fclose(memory);
    return text;
}

/* A plugin that must be refused, with `says` in the message. */
static void refused(const char *what, const char *definitions, const char *says)
{
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    const struct mcr_descriptor *found;
    struct mcr_registry *registry;
    char *text, folder[16];
    static int count;

    snprintf(folder, sizeof folder, "bad%d", count++); /* a path that was opened once is never opened anew */
    search(folder, folder);
    if (compile(folder, "probe", definitions)) {
        ok(0, "%s: the test's plugin compiles", what);
        mcr_diagnostics_destroy(diagnostics);
        return;
    }
    registry = mcr_registry_create(diagnostics, MCR_ISA_AVX512, NULL);
    found = mcr_registry_find(registry, MCR_KIND_MASK(MCR_KIND_DIRECTIONS), "probe", nowhere, NULL);
    text = recorded(diagnostics);
    if (!ok(!found && mcr_diagnostics_errors(diagnostics) == 1 && strstr(text, says), "refused: %s", what))
        printf("# %s\n# without: %s\n", text, says);
    free(text);
    mcr_registry_destroy(registry);
    mcr_diagnostics_destroy(diagnostics);
}

static void test_broken(void)
{
    refused("another major version", "-DMAJOR=77", "it was built for plugin interface 77.9, this program has 0.9");
    refused("a short mcr_plugin", "-DPLUGIN_SIZE=16", "mcr_plugin has 16 bytes, expected at least 24");
    refused("a tiny mcr_plugin", "-DPLUGIN_SIZE=3", "mcr_plugin has 3 bytes");
    refused("no symbol", "-DNO_SYMBOL", "does not export mcr_plugin");
    refused("no list", "-DLIST=0", "its list of descriptors is missing");
    refused("no descriptors", "-DCOUNT=0", "it lists 0 descriptors, expected 1 to 256");
    refused("too many descriptors", "-DCOUNT=4000000000u", "it lists 4000000000 descriptors");
    refused("a missing descriptor", "-DFIRST=0", "descriptor 1 is missing");
    refused("a short head", "-DSIZE=8", "descriptor 1 is too short");
    refused("a short descriptor", "-DSIZE='sizeof(struct mcr_descriptor)'", "expected at least");
    refused("no name", "-DNAME=0", "the name of descriptor 1 is no word");
    refused("an evil name", "-DNAME='\"../probe\"'", "the name of descriptor 1 is no word");
    refused("an upper-case name", "-DNAME='\"Probe\"'", "the name of descriptor 1 is no word");
    refused("an empty name", "-DNAME='\"\"'", "the name of descriptor 1 is no word");
    refused("another word than the file's", "-DNAME='\"other\"'", "it does not define 'probe'");
    refused("an unknown kind", "-DKIND=9", "'probe': unknown kind 9 or instruction set 0");
    refused("an unknown instruction set", "-DISA=7", "unknown kind 1 or instruction set 7");
    refused("no baseline", "-DISA=1", "not there for the baseline instruction set");
    refused("the same twice", "-DCOUNT=2", "'probe': it is listed twice for instruction set 0");
    refused("no version", "-DVERSION=0", "version, licence or summary is missing");
    refused("control characters", "-DSUMMARY='\"a\\33[2Jb\"'", "control characters");
    refused("a missing operation", "-DDRAW=0", "operation draw is missing beside density");
}

static void test_parameters(void)
{
    refused("too many parameters", "-DPARAMETERS=65 -DTABLE='{P(\"n\")}'", "it has 65 parameters, at most 64 are allowed");
    refused("a short parameter", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.size=16)}'", "its parameters have 16 bytes each");
    refused("parameters of two sizes", "-DPARAMETERS=2 -DTABLE='{P(\"n\"),P(\"m\",.size=200)}'", "parameter 2 has size 200");
    refused("the same parameter twice", "-DPARAMETERS=2 -DTABLE='{P(\"n\"),P(\"n\")}'", "parameter 'n' is there twice");
    refused("a parameter without a name", "-DPARAMETERS=1 -DTABLE='{P(0)}'", "the name of parameter 1 is no word");
    refused("a parameter with an evil name", "-DPARAMETERS=1 -DTABLE='{P(\"n=3\")}'", "the name of parameter 1 is no word");
    refused("a parameter without a unit", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.unit=0)}'", "unit or summary of parameter 'n' is missing");
    refused("a material in a sampler", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.type=5)}'", "parameter 'n' is a material, which only");
    refused("an unknown type", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.type=6)}'", "parameter 'n' has the unknown type 6");
    refused("unknown flags", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.flags=64)}'", "parameter 'n' has unknown flags");
    refused("a varying setting of a sampler", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.flags=2)}'", "which only a material's can be");
    refused("a default out of range", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.fallback={2})}'", "the default of parameter 'n' is 2, expected 0 to 1");
    refused("a default at an open end", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.flags=4)}'", "the default of parameter 'n' is 0, expected above 0 and at most 1");
    refused("a default that is no number", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.fallback={NAN})}'", "the default of parameter 'n' is");
    refused("an empty range", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.max=-1)}'", "parameter 'n' has an empty range");
    refused("a range that is no range", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.max=NAN)}'", "parameter 'n' has an empty range");
    refused("a broken whole number", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.type=2,.fallback={0.5})}'", "is 0.5, expected a whole number");
    refused("a choice without words", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.type=4)}'", "parameter 'n' has no choices");
    refused("a choice that is no word", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.type=4,.choices=\"a||b\")}'", "choice 2 of parameter 'n' is no word");
    refused("a choice twice", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.type=4,.choices=\"a|b|a\")}'", "parameter 'n' has the choice 'a' twice");
    refused("a default that is no choice", "-DPARAMETERS=1 -DTABLE='{P(\"n\",.type=4,.choices=\"a|b\",.fallback={2})}'",
            "the default of parameter 'n' is none of its choices");
    refused("parameters that differ between instruction sets",
            "-DCOUNT=2 -DPARAMETERS=1 -DTABLE='{P(\"n\")}' -DEXTRA='static const MORE(1)' -DSECOND='&more.head'",
            "its parameters differ between instruction sets");
}

/* ---- order, words, instruction sets ---- */

static const struct mcr_descriptor *find(const char *word, uint32_t isa, const char *const *files, char **said, char *path, size_t length)
{
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    struct mcr_registry *registry = mcr_registry_create(diagnostics, isa, files);
    const char *from = "";
    const struct mcr_descriptor *found = mcr_registry_find(registry, MCR_KIND_MASK(MCR_KIND_DIRECTIONS), word, nowhere, &from);

    *said = recorded(diagnostics);
    snprintf(path, length, "%s", found ? from : "");
    mcr_registry_destroy(registry);
    mcr_diagnostics_destroy(diagnostics);
    return found; /* plugins are never closed */
}

static void test_order(void)
{
    const struct mcr_descriptor *found;
    char path[700], file[700], home[700], *said;
    const char *files[2] = {file, NULL};

    compile("first", "probe", "-DVERSION='\"first\"'");
    compile("second", "probe", "-DVERSION='\"second\"'");
    compile("second", "two", "-DNAME='\"two\"' -DCOUNT=2 -DEXTRA='static const MORE(0)' -DSECOND='&more.head'");
    snprintf(home, sizeof home, "%s/home", top);
    mkdir(home, 0777);
    setenv("HOME", home, 1);
    unsetenv("XDG_DATA_HOME");

    search("first", "second");
    found = find("probe", 0, NULL, &said, path, sizeof path);
    ok(found && !strcmp(found->version, "first") && strstr(path, "/first/probe.so") && !*said, "the first folder wins");
    free(said);
    search("nowhere", "second");
    found = find("probe", 0, NULL, &said, path, sizeof path);
    ok(found && !strcmp(found->version, "second"), "a folder that is not there is passed over");
    free(said);
    snprintf(file, sizeof file, "%s/second/probe.so", top);
    search("first", "first");
    found = find("probe", 0, files, &said, path, sizeof path);
    ok(found && !strcmp(found->version, "second") && !*said, "--plugin comes before all folders");
    free(said);

    search("second", "second");
    found = find("two", 0, NULL, &said, path, sizeof path);
    ok(found && strstr(path, "/two.so"), "a file of two words serves the one it is named after");
    free(said);
    snprintf(file, sizeof file, "%s/second/two.so", top);
    search("nowhere", "nowhere");
    found = find("probe", 0, files, &said, path, sizeof path);
    ok(found && !strcmp(found->summary, "more") && strstr(path, "/two.so"), "--plugin defines all words of its file");
    free(said);

    snprintf(file, sizeof file, "%s/none.so", top);
    search("first", "first");
    found = find("probe", 0, files, &said, path, sizeof path);
    ok(found && strstr(said, "no plugin file") && strstr(said, "none.so"), "a file of --plugin that is not there is an error");
    free(said);
}

/* The user's folder, $XDG_DATA_HOME and $HOME; what it hides is told. */
static void test_user(void)
{
    const struct mcr_descriptor *found;
    char path[700], folder[700], *said;

    search("nowhere", "nowhere");
    snprintf(folder, sizeof folder, "%s/home/.local", top);
    mkdir(folder, 0777);
    strcat(folder, "/share");
    mkdir(folder, 0777);
    strcat(folder, "/mcrender-1");
    mkdir(folder, 0777);
    compile("home/.local/share/mcrender-1/plugins", "probe", "-DVERSION='\"user\"'");
    found = find("probe", 0, NULL, &said, path, sizeof path);
    ok(found && !strcmp(found->version, "user") && strstr(path, "/home/.local/share/mcrender-1/plugins/probe.so"), "the user's folder is searched");
    free(said);
    snprintf(folder, sizeof folder, "%s/data", top);
    setenv("XDG_DATA_HOME", folder, 1);
    found = find("probe", 0, NULL, &said, path, sizeof path);
    ok(!found, "XDG_DATA_HOME takes the place of ~/.local/share");
    free(said);
    setenv("XDG_DATA_HOME", "home/.local/share", 1);
    found = find("probe", 0, NULL, &said, path, sizeof path);
    ok(found && strstr(path, "/home/.local/"), "a relative XDG_DATA_HOME is ignored");
    free(said);
    unsetenv("XDG_DATA_HOME");
}

static void test_words(void)
{
    static const char *const evil[] = {"../first/probe", "/etc/passwd", "Probe", "", "probe.so", "a/b", "-x", "1a", "pro be"};
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    struct mcr_registry *registry;
    uint32_t found = 0;
    char longer[80], *text;

    search("first", "second");
    registry = mcr_registry_create(diagnostics, 0, NULL);
    for (size_t k = 0; k < sizeof evil / sizeof *evil; k++)
        found += mcr_registry_find(registry, ~0u, evil[k], nowhere, NULL) != NULL;
    memset(longer, 'a', 79);
    longer[79] = 0;
    found += mcr_registry_find(registry, ~0u, longer, nowhere, NULL) != NULL;
    ok(found == 0 && mcr_diagnostics_errors(diagnostics) == sizeof evil / sizeof *evil + 1, "what is no word finds nothing");
    mcr_registry_destroy(registry);
    mcr_diagnostics_destroy(diagnostics);

    diagnostics = mcr_diagnostics_create();
    registry = mcr_registry_create(diagnostics, 0, NULL);
    ok(!mcr_registry_find(registry, MCR_KIND_MASK(MCR_KIND_MATERIAL), "probe", nowhere, NULL), "a sampler is no material");
    text = recorded(diagnostics);
    ok(strstr(text, "'probe' is a sampler, expected a material") != NULL, "and that is what is said");
    free(text);
    ok(!mcr_registry_find(registry, MCR_KIND_MASK(MCR_KIND_MATERIAL), "prob", nowhere, NULL), "an unknown word");
    text = recorded(diagnostics);
    ok(strstr(text, "unknown material 'prob'") && strstr(text, "did you mean 'probe'?"), "gets the nearest one");
    free(text);
    ok(!mcr_registry_find(registry, MCR_KIND_MASK(MCR_KIND_MATERIAL), "xyzzyplugh", nowhere, NULL), "a strange one");
    text = recorded(diagnostics);
    ok(strstr(text, "plugins found: probe, two") && strstr(text, "folders searched: ") && strstr(text, "/first"), "gets words and folders");
    free(text);
    mcr_registry_destroy(registry);
    mcr_diagnostics_destroy(diagnostics);
}

/* A folder, a pipe, a text file named like a plugin. */
static void test_no_files(void)
{
    const struct mcr_descriptor *found;
    char path[700], name[700], *said;
    FILE *file;

    snprintf(name, sizeof name, "%s/odd", top);
    mkdir(name, 0777);
    snprintf(name, sizeof name, "%s/odd/folder.so", top);
    mkdir(name, 0777);
    snprintf(name, sizeof name, "%s/odd/pipe.so", top);
    mkfifo(name, 0666);
    snprintf(name, sizeof name, "%s/odd/text.so", top);
    file = fopen(name, "w");
    fputs("no plugin\n", file);
    fclose(file);
    search("odd", "odd");
    found = find("folder", 0, NULL, &said, path, sizeof path);
    ok(!found && strstr(said, "unknown sampler 'folder'"), "a folder is no plugin");
    free(said);
    found = find("pipe", 0, NULL, &said, path, sizeof path);
    ok(!found && strstr(said, "unknown sampler 'pipe'") && !strstr(said, "did you mean 'pipe'"), "a pipe is no plugin, and is not waited for");
    free(said);
    found = find("text", 0, NULL, &said, path, sizeof path);
    ok(!found && strstr(said, "cannot be loaded"), "a text is no plugin");
    free(said);
}

/* What is left of a plugin when it was not copied to its end, for several ends; the whole of it loads. */
static void test_cut_off(void)
{
    static const double parts[] = {0.001, 0.05, 0.3, 0.6, 0.8, 1};
    static char bytes[1 << 20];
    char path[700], name[700], *said;
    size_t size;
    FILE *file;

    compile("whole", "probe", "");
    snprintf(name, sizeof name, "%s/whole/probe.so", top);
    file = fopen(name, "r");
    size = file ? fread(bytes, 1, sizeof bytes, file) : 0;
    fclose(file);
    ok(size > 10000 && size < sizeof bytes, "a plugin of %zu bytes", size);
    for (uint32_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        char folder[16];
        const struct mcr_descriptor *found;

        snprintf(folder, sizeof folder, "cut%u", i);
        snprintf(name, sizeof name, "%s/%s", top, folder);
        mkdir(name, 0777);
        strcat(name, "/probe.so");
        file = fopen(name, "w");
        fwrite(bytes, 1, (size_t)(parts[i] * (double)size), file);
        fclose(file);
        search(folder, folder);
        found = find("probe", 0, NULL, &said, path, sizeof path);
        if (parts[i] < 0.5) /* beyond, all that is loaded may be there: what is missing are symbols for debuggers */
            ok(!found && strstr(said, "cannot be loaded: the file is cut off"), "%g of a plugin: %s", parts[i], said);
        else
            ok(found ? !*said : *said != 0, "%g of a plugin is loaded or told", parts[i]);
        free(said);
    }
}

static void test_sets(void)
{
    const struct mcr_descriptor *found;
    char path[700], *said;

    compile("sets", "probe", "-DCOUNT=2 -DEXTRA='static const MORE(1)' -DSECOND='&more.head'");
    search("sets", "sets");
    found = find("probe", MCR_ISA_BASELINE, NULL, &said, path, sizeof path);
    ok(found && found->isa == MCR_ISA_BASELINE, "the baseline where no more is allowed");
    free(said);
    found = find("probe", MCR_ISA_AVX2, NULL, &said, path, sizeof path);
    ok(found && found->isa == MCR_ISA_AVX2, "AVX2 where it is there and allowed");
    free(said);
    found = find("probe", MCR_ISA_AVX512, NULL, &said, path, sizeof path);
    ok(found && found->isa == MCR_ISA_AVX2, "the best there is where more is allowed");
    free(said);
    compile("later", "probe", "-DMINOR=50 -DCOUNT=2 -DEXTRA='static const struct mcr_descriptor more = {sizeof more, 99, 0, 0, \"probe\"}' "
                              "-DSECOND='&more'");
    search("later", "later");
    found = find("probe", MCR_ISA_AVX512, NULL, &said, path, sizeof path);
    ok(found && found->kind == MCR_KIND_DIRECTIONS && !*said, "what a later minor version adds is left alone");
    free(said);
}

/* A sampler whose techniques are wrong for the root of an expression. */
static void test_root(const char *folder, const char *definitions, const char *says)
{
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    struct mcr_arena *arena = mcr_arena_create(0);
    struct mcr_value value = {.kind = MCR_VALUE_NAME, .text = "probe"};
    struct mcr_registry *registry;
    char *text;

    compile(folder, "probe", definitions);
    search(folder, folder);
    registry = mcr_registry_create(diagnostics, 0, NULL);
    ok(!mcr_sampler_create(arena, diagnostics, registry, &value, 1, 0), "refused as a sampler: %s", folder);
    text = recorded(diagnostics);
    if (!ok(strstr(text, says) && mcr_diagnostics_errors(diagnostics) == 1, "  %s", says))
        printf("# %s", text);
    free(text);
    mcr_registry_destroy(registry);
    mcr_diagnostics_destroy(diagnostics);
    mcr_arena_destroy(arena);
}

static void test_describe(void)
{
    struct mcr_diagnostics *diagnostics = mcr_diagnostics_create();
    struct mcr_registry *registry;
    char *text = NULL, line[1200];
    size_t length = 0;
    FILE *memory = open_memstream(&text, &length);

    compile("broken", "broken", "-DMAJOR=77");
    compile("broken", "probe", "-DVERSION='\"hiding\"' -DPARAMETERS=2 -DTABLE='{P(\"depth\",.unit=\"m\",.fallback={0.5}),"
                               "P(\"way\",.type=4,.choices=\"in|out\",.flags=1)}'");
    search("broken", "second");
    registry = mcr_registry_create(diagnostics, MCR_ISA_AVX512, NULL);
    mcr_registry_open_all(registry);
    mcr_describe_all(memory, registry);
    fflush(memory);
    ok(strstr(text, "samplers: directions\n  probe  for tests\n") && strstr(text, "  two    for tests\n"), "the list");
    snprintf(line, sizeof line, "hiding, %s/broken/probe.so (baseline)\n         hides %s/second/probe.so\n", top, top);
    ok(strstr(text, line) != NULL, "tells version, path, instruction sets and what is hidden");
    ok(mcr_diagnostics_warnings(diagnostics) == 1 && mcr_diagnostics_errors(diagnostics) == 0, "what does not load is a warning");
    fclose(memory);
    free(text);
    text = NULL;
    memory = open_memstream(&text, &length);
    ok(mcr_describe_word(memory, registry, "probe") == 0, "a word");
    fflush(memory);
    ok(strstr(text, "    depth: number, 0 to 1 m; default 0.5\n        A number.\n") && strstr(text, "    way: word, in or out; required\n") &&
           strstr(text, "  licence: MIT\n"),
       "its documentation");
    ok(mcr_describe_word(memory, registry, "nothing") == -1 && mcr_diagnostics_errors(diagnostics) == 1, "an unknown word");
    fclose(memory);
    free(text);
    mcr_registry_destroy(registry);
    mcr_diagnostics_destroy(diagnostics);
}

int main(void)
{
    const char *folder = getenv("TMPDIR");

    snprintf(top, sizeof top, "%s", folder ? folder : ".");
    if (getenv("MCR_SANITIZED") && !strcmp(getenv("MCR_SANITIZED"), "1")) {
        tap_skip("loading", "plugins that were built without sanitizers");
        return tap_done();
    }
    if (compile("first", "probe", "")) {
        tap_skip("loading", "no C compiler");
        return tap_done();
    }
    test_broken();
    test_parameters();
    test_order();
    test_user();
    test_words();
    test_no_files();
    test_cut_off();
    test_sets();
    test_root("dimensions", "-DTECHNIQUE='t->dimensions = 17'", "this sampler takes 17 numbers at each bounce, expected at most 16");
    test_root("overflow", "-DTECHNIQUE='t->dimensions = 0xffffffffu; t[1] = t[0]; t[1].dimensions = 2; t[1].continues = 0; *n = 2'",
              "this sampler takes 4294967297 numbers at each bounce, expected at most 16");
    test_root("ends", "-DTECHNIQUE='t->continues = 0'", "no technique of 'probe' continues the path, expected one that draws directions");
    test_root("alone", "", "unknown sampler 'independent'");
    test_describe();
    return tap_done();
}
