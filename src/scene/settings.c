/* SPDX-License-Identifier: Apache-2.0 */
/* Which word means what: blocks against the tables of words.c. */
#include "scene/build.h"

#include <stdio.h>
#include <string.h>

/* "a, b or c" */
static void list_words(const char *const *words, uint32_t count, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (uint32_t i = 0; i < count && used < size; i++) {
        int n = snprintf(text + used, size - used, "%s%s", i == 0 ? "" : i + 1 == count ? " or " : ", ", words[i]);
        used += n > 0 ? (size_t)n : 0;
    }
}

void mcr_unknown_word(struct mcr_build *build, struct mcr_place place, const char *what, const char *word, const char *of,
                      const char *const *words, uint32_t count)
{
    const char *nearest = mcr_nearest_word(word, words, count);
    char text[500];
    list_words(words, count, text, sizeof text);
    mcr_error(build, place, "unknown %s '%s' of '%s', expected %s", what, word, of, text);
    if (nearest)
        mcr_report(build->diagnostics, MCR_NOTE, place, "did you mean '%s'?", nearest);
}

static int find_setting(const struct mcr_block_word *word, const char *name)
{
    for (uint32_t i = 0; i < word->count; i++)
        if (strcmp(word->setting[i].name, name) == 0)
            return (int)i;
    return -1;
}

static void unknown_setting(struct mcr_build *build, struct mcr_place place, const char *what, const char *name,
                            struct mcr_settings *settings)
{
    const char *words[MCR_SETTINGS_LIMIT], *nearest;
    for (uint32_t i = 0; i < settings->word->count; i++)
        words[i] = settings->word->setting[i].name;
    mcr_unknown_word(build, place, what, name, settings->of, words, settings->word->count);
    /* What was misspelt is not missing as well. */
    nearest = mcr_nearest_word(name, words, settings->word->count);
    if (nearest)
        settings->misspelt |= 1u << find_setting(settings->word, nearest);
}

/* Room for a value under this name; -1 after an error: it was given before. */
static int take(struct mcr_build *build, struct mcr_settings *settings, int index, struct mcr_place place)
{
    int first = !settings->value[index] && !(settings->transform && strcmp(settings->word->setting[index].name, "transform") == 0);
    if (first) {
        settings->key[index] = place;
        return 0;
    }
    mcr_error(build, place, "'%s' of '%s' is given twice, expected once", settings->word->setting[index].name, settings->of);
    mcr_report(build->diagnostics, MCR_NOTE, settings->key[index], "the first one is here");
    return -1;
}

/* The row of a block; where its kind is wrong, which is told elsewhere, one of its word. */
static const struct mcr_block_word *row_of(const struct mcr_item *item)
{
    const struct mcr_block_word *row = mcr_scene_block(item->word, item->kind);
    for (uint32_t i = 0; i < mcr_scene_block_count && !row; i++)
        if (strcmp(mcr_scene_blocks[i].word, item->word) == 0)
            row = &mcr_scene_blocks[i];
    return row;
}

static int match_block(struct mcr_build *build, const struct mcr_item *item, uint32_t inside, struct mcr_settings *settings)
{
    int index = find_setting(settings->word, item->word);
    const struct mcr_block_word *row = row_of(item);
    if (row && (inside & (1u << row->role)))
        return 0;
    if (index < 0) {
        if (row)
            mcr_error(build, item->place, "a block '%s' cannot stand in '%s'", item->word, settings->of);
        else
            unknown_setting(build, item->place, "block", item->word, settings);
        return -1;
    }
    if (settings->word->setting[index].type != MCR_WORD_TRANSFORM) {
        mcr_error(build, item->place, "'%s' of '%s' is a block, expected %s", item->word, settings->of,
                  mcr_word_form(settings->word->setting[index].type));
        return -1;
    }
    if (take(build, settings, index, item->place) != 0)
        return -1;
    settings->transform = item;
    return 0;
}

static int match_setting(struct mcr_build *build, const struct mcr_item *item, struct mcr_settings *settings)
{
    int index = find_setting(settings->word, item->word);
    if (index < 0) {
        if (mcr_scene_block(item->word, NULL) || strcmp(item->word, "camera") == 0 ||
            strcmp(item->word, "texture") == 0 || strcmp(item->word, "light") == 0)
            mcr_error(build, item->place, "'%s' opens a block, it is no setting of '%s'", item->word, settings->of);
        else if (item->value.kind == MCR_VALUE_ERROR)
            settings->damaged = 1; /* perhaps no setting at all, but what was left behind by a mistake */
        else
            unknown_setting(build, item->place, "setting", item->word, settings);
        return -1;
    }
    if (settings->word->setting[index].type == MCR_WORD_TRANSFORM) {
        mcr_error(build, item->place, "'%s' of '%s' is a value, expected %s", item->word, settings->of, mcr_word_form(MCR_WORD_TRANSFORM));
        return -1;
    }
    if (take(build, settings, index, item->place) != 0)
        return -1;
    settings->value[index] = &item->value;
    return 0;
}

static int check_missing(struct mcr_build *build, struct mcr_settings *settings)
{
    int result = 0;
    for (uint32_t i = 0; i < settings->word->count; i++) {
        const struct mcr_parameter *row = &settings->word->setting[i];
        if (!(row->flags & MCR_PARAMETER_REQUIRED) || settings->value[i])
            continue;
        result = -1;
        if (!settings->damaged && !(settings->misspelt & (1u << i)))
            mcr_error(build, settings->place, "'%s' needs '%s', expected %s", settings->of, row->name, mcr_word_form(row->type));
    }
    return result;
}

int mcr_settings_match(struct mcr_build *build, const struct mcr_item *block, const struct mcr_block_word *word, uint32_t inside,
                       struct mcr_settings *settings)
{
    int result = 0, before = 0;
    memset(settings, 0, sizeof *settings);
    settings->word = word;
    settings->of = block->word;
    settings->place = block->place;
    settings->damaged = block->damaged;
    if (!word->kind && word->role != MCR_BLOCK_MATERIAL && (block->name || block->kind)) {
        mcr_error(build, block->name ? block->name_place : block->kind_place, "'%s' takes no name, expected '{'", block->word);
        result = -1;
    }
    for (uint32_t i = 0; i < block->count; i++) {
        const struct mcr_item *item = &block->item[i];
        before = item->is_block ? match_block(build, item, inside, settings) : match_setting(build, item, settings);
        if (before != 0)
            result = -1;
    }
    if (check_missing(build, settings) != 0)
        result = -1;
    return result;
}

int mcr_settings_match_call(struct mcr_build *build, const struct mcr_value *call, const struct mcr_block_word *word,
                            struct mcr_settings *settings)
{
    int result = 0;
    memset(settings, 0, sizeof *settings);
    settings->word = word;
    settings->of = word->word;
    settings->place = call->place;
    for (uint32_t i = 0; call->kind == MCR_VALUE_CALL && i < call->count; i++) {
        const struct mcr_argument *argument = &call->argument[i];
        int index = argument->name ? find_setting(word, argument->name) : -1;
        if (!argument->name)
            mcr_error(build, argument->value.place, "'%s' expects arguments as name=value", word->word);
        else if (index < 0)
            unknown_setting(build, argument->name_place, "argument", argument->name, settings);
        if (index < 0 || take(build, settings, index, argument->name_place) != 0)
            result = -1;
        else
            settings->value[index] = &argument->value;
    }
    return result;
}

static int unknown_block(struct mcr_build *build, const struct mcr_item *block, uint32_t allowed, const char *where)
{
    const char *words[MCR_SETTINGS_LIMIT], *nearest;
    uint32_t count = 0;
    char text[300];
    for (uint32_t i = 0; i < mcr_scene_block_count && count < MCR_SETTINGS_LIMIT; i++)
        if ((allowed & (1u << mcr_scene_blocks[i].role)) && (i == 0 || strcmp(mcr_scene_blocks[i].word, mcr_scene_blocks[i - 1].word) != 0))
            words[count++] = mcr_scene_blocks[i].word;
    list_words(words, count, text, sizeof text);
    nearest = mcr_nearest_word(block->word, words, count);
    mcr_error(build, block->place, "unknown %s '%s' %s, expected %s", block->is_block ? "block" : "setting", block->word, where, text);
    if (nearest)
        mcr_report(build->diagnostics, MCR_NOTE, block->place, "did you mean '%s'?", nearest);
    return -1;
}

int mcr_block_role(struct mcr_build *build, const struct mcr_item *block, uint32_t allowed, const char *where)
{
    for (uint32_t i = 0; i < mcr_scene_block_count; i++) {
        const struct mcr_block_word *row = &mcr_scene_blocks[i];
        if (strcmp(row->word, block->word) != 0)
            continue;
        if (!block->is_block)
            mcr_error(build, block->place, "'%s' opens a block, expected '{'", block->word);
        else if (!(allowed & (1u << row->role)))
            mcr_error(build, block->place, "a block '%s' cannot stand %s", block->word, where);
        else
            return (int)row->role;
        return -1;
    }
    /* Settings that belong into a block, e.g. `spp 100` at the top. */
    if (!block->is_block) {
        for (uint32_t i = 0; i < mcr_scene_block_count; i++) {
            if (find_setting(&mcr_scene_blocks[i], block->word) >= 0) {
                mcr_error(build, block->place, "'%s' cannot stand %s, it belongs into a block such as '%s'", block->word, where,
                          mcr_scene_blocks[i].word);
                return -1;
            }
        }
    }
    return unknown_block(build, block, allowed, where);
}
