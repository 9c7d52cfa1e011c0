/* SPDX-License-Identifier: Apache-2.0 */
/* What a scene is, for the keys of a study's cells: its tree without the study itself, so that a study may grow and keep what it has. */
#include <string.h>

#include "base/random.h"
#include "plugin/values.h"
#include "study/work.h"

#define PRIME UINT64_C(1099511628211)
#define OFFSET UINT64_C(14695981039346656037)

static uint64_t add_bytes(uint64_t hash, const void *bytes, size_t count)
{
    const unsigned char *at = bytes;
    for (size_t i = 0; i < count; i++)
        hash = (hash ^ at[i]) * PRIME;
    return hash;
}

uint64_t mcr_study_hash(const void *bytes, size_t count)
{
    return mcr_mix64(add_bytes(OFFSET, bytes, count)); /* texts that differ little get names that differ */
}

static uint64_t add_text(uint64_t hash, const char *text)
{
    return add_bytes(hash, text ? text : "", strlen(text ? text : "") + 1);
}

static uint64_t add_whole(uint64_t hash, uint64_t number)
{
    unsigned char bytes[8];
    for (int i = 0; i < 8; i++)
        bytes[i] = (unsigned char)(number >> 8 * i);
    return add_bytes(hash, bytes, sizeof bytes);
}

/* Nesting is bounded by the parser (MCR_NESTING_LIMIT), through names, too. */
static uint64_t add_value(uint64_t hash, const struct mcr_value *value)
{
    uint64_t bits;
    value = mcr_value_resolve(value);
    hash = add_whole(hash, value->kind);
    switch (value->kind) {
    case MCR_VALUE_NUMBER:
        memcpy(&bits, &value->number, sizeof bits);
        return add_whole(hash, bits);
    case MCR_VALUE_TUPLE:
        hash = add_whole(hash, value->count);
        for (uint32_t i = 0; i < value->count; i++)
            hash = add_value(hash, &value->item[i]);
        return hash;
    case MCR_VALUE_CALL:
        hash = add_whole(add_text(hash, value->text), value->count);
        for (uint32_t i = 0; i < value->count; i++) {
            const struct mcr_argument *argument = &value->argument[i];
            hash = add_value(add_text(hash, argument->name), &argument->value);
            hash = argument->has_weight ? add_value(add_whole(hash, 1), &argument->weight) : add_whole(hash, 0);
        }
        return hash;
    default:
        return add_text(hash, value->text);
    }
}

/* What every cell says itself, or what concerns files of 8 bits only. */
static int is_of_cells(const char *block, const char *word)
{
    static const char *const words[][2] = {
        {"render", "sampler"}, {"render", "spp"},       {"render", "depth"},     {"render", "seed"},     {"render", "threads"}, {"render", "replicates"},
        {"render", "accel"},   {"render", "precision"}, {"render", "roulette"},  {"render", "compat"},   {"film", "size"},      {"film", "crop"},
        {"film", "exposure"},  {"film", "tone"},
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (!strcmp(words[i][0], block) && !strcmp(words[i][1], word))
            return 1;
    return 0;
}

static uint64_t add_block(uint64_t hash, const struct mcr_item *block)
{
    for (uint32_t i = 0; i < block->count; i++) {
        const struct mcr_item *item = &block->item[i];
        if (item->is_block && !strcmp(item->word, "study"))
            continue;
        if (!item->is_block && is_of_cells(block->word, item->word))
            continue;
        hash = add_text(add_whole(hash, item->is_block ? 2 : 1), item->word);
        if (item->is_block)
            hash = add_block(add_text(add_text(hash, item->name), item->kind), item);
        else
            hash = add_value(hash, &item->value);
    }
    return add_whole(hash, 3);
}

uint64_t mcr_study_content(const struct mcr_item *root)
{
    return mcr_mix64(add_block(OFFSET, root));
}
