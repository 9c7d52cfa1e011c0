/* SPDX-License-Identifier: Apache-2.0 */
/* Files: includes and their chain, cycles, depth, what cannot be read, pipes and devices, the limit on text. */
#include "help.h"

#include <sys/stat.h>
#include <unistd.h>

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(name, "w");
    if (!file || fputs(text, file) < 0 || fclose(file) != 0) {
        printf("Bail out! cannot write %s\n", name);
        exit(99);
    }
}

static void parse_file(struct parsed *parsed, const char *path)
{
    parsed_init(parsed);
    parsed->root = mcr_parse_file(parsed->arena, parsed->diagnostics, path, NULL, 0);
    parsed_keep(parsed);
}

static void file_is(const char *path, const char *tree, const char *messages, const char *what)
{
    struct parsed parsed;
    parse_file(&parsed, path);
    same(parsed.tree, tree, what);
    same(parsed.messages, messages, what);
    parsed_fini(&parsed);
}

static void good(void)
{
    mkdir("sub", 0777);
    mkdir("sub/deep", 0777);
    write_file("main.scn", "mcrender 1\nlet a = 1\ninclude \"sub/one.scn\"\nbox { x b include \"values.scn\" }\n");
    write_file("sub/one.scn", "mcrender 1 let b = a + 1 include \"deep/two.scn\" include \"../empty.scn\"");
    write_file("sub/deep/two.scn", "sphere { y b }");
    write_file("empty.scn", "");
    write_file("values.scn", "z (a, b)");
    file_is("main.scn", "{sphere{y b=2}; box{x b=2; z (1 2)}}", "", "includes are relative to the file they stand in, and share names");
    file_is("./sub/../main.scn", "{sphere{y b=2}; box{x b=2; z (1 2)}}", "", "also by another path");
    write_file("twice.scn", "mcrender 1 include \"sub/deep/three.scn\" include \"sub/deep/three.scn\"");
    write_file("sub/deep/three.scn", "box { }");
    file_is("twice.scn", "{box{}; box{}}", "", "a file may be included twice");
}

static void mistakes(void)
{
    write_file("bad.scn", "mcrender 1\n  include \"sub/bad.scn\"\nbox { x 1/0 }");
    write_file("sub/bad.scn", "include \"bad2.scn\"\nfoo");
    write_file("sub/bad2.scn", "box { y 1e999 }\n}\nsphere {\n");
    file_is("bad.scn", "{box{y ERROR}; sphere{}; box{x ERROR}}!",
            "in file included from sub/bad.scn:1:9:\n"
            "in file included from bad.scn:2:11:\n"
            "sub/bad2.scn:1:9: error: the number 1e999 is too large, the limit is 1.797e308\n"
            "    1 | box { y 1e999 }\n"
            "      |         ^~~~~\n"
            "sub/bad2.scn:2:1: error: unexpected '}', no '{' is open here\n"
            "    2 | }\n"
            "      | ^\n"
            "sub/bad2.scn:3:8: error: the '{' of 'sphere' is not closed\n"
            "    3 | sphere {\n"
            "      |        ^\n"
            "in file included from bad.scn:2:11:\n"
            "sub/bad.scn:2:1: error: unknown word 'foo' at the top level, expected camera, film, render, study, material, light, texture, group, transform, plane, sphere, "
            "quad, disk, box, triangle, mesh, let or include\n"
            "    2 | foo\n"
            "      | ^~~\n"
            "bad.scn:3:9: error: division by zero\n"
            "    3 | box { x 1/0 }\n"
            "      |         ^~~\n",
            "the chain of includes");

    write_file("self.scn", "mcrender 1 include \"sub/back.scn\" box { }");
    write_file("sub/back.scn", "include \"../self.scn\"");
    file_is("self.scn", "{box{}}!",
            "in file included from self.scn:1:20:\n"
            "sub/back.scn:1:9: error: 'sub/../self.scn' includes itself\n"
            "    1 | include \"../self.scn\"\n"
            "      |         ^~~~~~~~~~~~~\n",
            "a cycle");
    write_file("old.scn", "mcrender 1 include \"new.scn\" box { x name * 2 }");
    write_file("new.scn", "mcrender 7 something else { }");
    file_is("old.scn", "{box{x ERROR}}!",
            "in file included from old.scn:1:20:\n"
            "new.scn:1:10: error: format version 7 is not known, this program reads version 1\n"
            "    1 | mcrender 7 something else { }\n"
            "      |          ^\n",
            "another version in an included file");
    file_is("absent.scn", "NULL", "error: cannot read 'absent.scn': No such file or directory\n", "an absent file");
    file_is("sub", "NULL", "error: cannot read 'sub': Is a directory\n", "a directory");
    write_file("folder.scn", "mcrender 1 include \"sub\" include \"-\"");
    file_is("folder.scn", "{}!",
            "folder.scn:1:20: error: cannot read 'sub': Is a directory\n"
            "    1 | mcrender 1 include \"sub\" include \"-\"\n"
            "      |                    ^~~~~\n"
            "folder.scn:1:34: error: cannot read '-': No such file or directory\n"
            "    1 | mcrender 1 include \"sub\" include \"-\"\n"
            "      |                                  ^~~\n",
            "a directory included; '-' is standard input on the command line only");
}

static void depth(void)
{
    struct parsed parsed;
    char name[20], text[60];
    for (int i = 0; i <= 18; i++) {
        snprintf(name, sizeof name, "d%d.scn", i);
        snprintf(text, sizeof text, "mcrender 1 include \"d%d.scn\"", i + 1);
        write_file(name, i == 18 ? "box { }" : text);
    }
    parse_file(&parsed, "d2.scn");
    same(parsed.tree, "{box{}}", "16 levels of includes");
    parsed_fini(&parsed);
    parse_file(&parsed, "d1.scn");
    ok(strstr(parsed.messages, "d17.scn:1:20: error: files include each other deeper than 16 levels") != NULL, "17 are too many");
    ok(mcr_diagnostics_errors(parsed.diagnostics) == 1 && strstr(parsed.messages, "in file included from d1.scn:1:20:") != NULL, "one error with the chain");
    parsed_fini(&parsed);
}

/* A child writes; returns the read end. */
static int piped(const char *text, unsigned times)
{
    int ends[2];
    if (pipe(ends) != 0)
        return -1;
    if (fork() == 0) {
        FILE *to = fdopen(ends[1], "w");
        close(ends[0]);
        for (unsigned i = 0; i < times; i++)
            if (fputs(text, to) < 0)
                break;
        fclose(to);
        _exit(0);
    }
    close(ends[1]);
    return ends[0];
}

static void pipes(void)
{
    char path[40];
    int end = piped("mcrender 1 box { x 1/0 }\n", 1), saved = dup(0);

    dup2(end, 0);
    close(end);
    file_is("-", "{box{x ERROR}}", "<stdin>:1:20: error: division by zero\n    1 | mcrender 1 box { x 1/0 }\n      |                    ^~~\n", "standard input");
    dup2(saved, 0);
    end = piped("mcrender 1 box { }", 1);
    snprintf(path, sizeof path, "/dev/fd/%d", end);
    file_is(path, "{box{}}", "", "a pipe by name");
    close(end);
    end = piped("##############################################################\n", 1100000);
    dup2(end, 0);
    close(end);
    file_is("-", "NULL", "error: '<stdin>' is too long, scenes have at most 64 MiB of text\n", "a pipe without end is read up to the limit");
    dup2(saved, 0);
    close(saved);
}

static void sizes(void)
{
    struct parsed parsed;
    FILE *file;
    write_file("large.scn", "");
    ok(truncate("large.scn", MCR_SOURCE_LIMIT + 1) == 0, "a file of 64 MiB and a byte");
    file_is("large.scn", "NULL", "error: 'large.scn' is too long, scenes have at most 64 MiB of text\n", "is too long");
    write_file("half.scn", "#");
    file = fopen("half.scn", "r+");
    for (unsigned i = 0; i < 40u << 10; i++)
        fprintf(file, "%1023s\n", i ? "" : "#");
    fclose(file);
    write_file("both.scn", "mcrender 1 include \"half.scn\" include \"half.scn\"");
    parse_file(&parsed, "both.scn");
    ok(strstr(parsed.messages, "both.scn:1:39: error: 'half.scn' is too long") && mcr_diagnostics_errors(parsed.diagnostics) == 1,
       "the limit holds for all includes together");
    parsed_fini(&parsed);
    if (access("/dev/zero", R_OK) == 0)
        file_is("/dev/zero", "NULL", "error: '/dev/zero' is too long, scenes have at most 64 MiB of text\n", "a device without end");
    else
        tap_skip("a device without end", "no /dev/zero");
}

int main(void)
{
    char folder[] = "/tmp/mcrender-test-XXXXXX";
    const char *given = getenv("TMPDIR");
    if (given ? chdir(given) != 0 : !mkdtemp(folder) || chdir(folder) != 0) {
        printf("Bail out! no folder to work in\n");
        return 99;
    }
    good();
    mistakes();
    depth();
    pipes();
    sizes();
    return tap_done();
}
