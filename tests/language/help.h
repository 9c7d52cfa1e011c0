/* SPDX-License-Identifier: Apache-2.0 */
/* Parses a text and keeps the tree and the diagnostics as text, to be compared. */
#ifndef TESTS_LANGUAGE_HELP_H
#define TESTS_LANGUAGE_HELP_H

#include "language/tree.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

struct parsed {
    struct mcr_arena *arena;
    struct mcr_diagnostics *diagnostics;
    const struct mcr_item *root;
    char *tree, *messages;
};

static void write_value(FILE *to, const struct mcr_value *value)
{
    switch (value->kind) {
    case MCR_VALUE_NUMBER:
        fprintf(to, "%.17g", value->number);
        break;
    case MCR_VALUE_STRING:
        fprintf(to, "\"%s\"", value->text);
        break;
    case MCR_VALUE_ERROR:
        fputs("ERROR", to);
        break;
    case MCR_VALUE_NAME:
        fputs(value->text, to);
        if (value->bound) {
            fputc('=', to);
            write_value(to, value->bound);
        }
        break;
    case MCR_VALUE_TUPLE:
        for (uint32_t i = 0; i < value->count; i++) {
            fputs(i ? " " : "(", to);
            write_value(to, &value->item[i]);
        }
        fputc(')', to);
        break;
    case MCR_VALUE_CALL:
        fprintf(to, "%s(", value->text);
        for (uint32_t i = 0; i < value->count; i++) {
            const struct mcr_argument *argument = &value->argument[i];
            fprintf(to, "%s%s%s", i ? ", " : "", argument->name ? argument->name : "", argument->name ? "=" : "");
            write_value(to, &argument->value);
            if (argument->has_weight) {
                fputc(' ', to);
                write_value(to, &argument->weight);
            }
        }
        fputc(')', to);
        break;
    }
}

/* `word name kind{item item …}`, and `!` behind what is damaged. */
static void write_item(FILE *to, const struct mcr_item *item)
{
    fputs(item->word, to);
    if (!item->is_block) {
        fputc(' ', to);
        write_value(to, &item->value);
        return;
    }
    fprintf(to, "%s%s%s%s{", item->name ? " " : "", item->name ? item->name : "", item->kind ? " " : "", item->kind ? item->kind : "");
    for (uint32_t i = 0; i < item->count; i++) {
        fputs(i ? "; " : "", to);
        write_item(to, &item->item[i]);
    }
    fputs(item->damaged ? "}!" : "}", to);
}

static void parsed_keep(struct parsed *parsed)
{
    size_t length;
    FILE *to = open_memstream(&parsed->messages, &length);
    mcr_diagnostics_print(parsed->diagnostics, to, 0);
    fclose(to);
    to = open_memstream(&parsed->tree, &length);
    if (parsed->root)
        write_item(to, parsed->root);
    else
        fputs("NULL", to);
    fclose(to);
}

static void parsed_init(struct parsed *parsed)
{
    memset(parsed, 0, sizeof *parsed);
    parsed->arena = mcr_arena_create(0);
    parsed->diagnostics = mcr_diagnostics_create();
}

static void parsed_fini(struct parsed *parsed)
{
    mcr_diagnostics_destroy(parsed->diagnostics);
    mcr_arena_destroy(parsed->arena);
    free(parsed->tree);
    free(parsed->messages);
}

static void __attribute__((unused)) parse_bytes(struct parsed *parsed, const char *text, size_t length, struct mcr_definition *definitions, uint32_t count)
{
    parsed_init(parsed);
    parsed->root = mcr_parse_text(parsed->arena, parsed->diagnostics, "a.scn", "", text, length, definitions, count);
    parsed_keep(parsed);
}

static int __attribute__((unused)) same(const char *got, const char *expected, const char *what)
{
    if (ok(strcmp(got, expected) == 0, "%s", what))
        return 1;
    printf("# expected: %s\n# got: %s\n", expected, got);
    return 0;
}

#endif
