/* SPDX-License-Identifier: Apache-2.0 */
/* The tables of words: complete, within their limits, and of one mind with the parser about which words open blocks. */
#include "help.h"

#include "language/words.h"
#include "scene/words.h"

/* What is wrong with a table, or NULL. */
static const char *judge(const struct mcr_block_word *word)
{
    if (word->count > MCR_SETTINGS_LIMIT || word->count > 32)
        return "too many settings";
    if (!word->summary || !word->summary[0] || word->summary[strlen(word->summary) - 1] != '.')
        return "no summary";
    for (uint32_t i = 0; i < word->count; i++) {
        const struct mcr_parameter *row = &word->setting[i];
        int number = row->type == MCR_TYPE_NUMBER || row->type == MCR_TYPE_INTEGER;
        if (row->size != sizeof *row || !row->name || !row->unit || !row->summary || row->summary[strlen(row->summary) - 1] != '.')
            return "an incomplete row";
        if (strcmp(mcr_word_form(row->type), "a value") == 0)
            return "a type without a form";
        if (!!row->choices != (row->type == MCR_TYPE_CHOICE || row->type == MCR_WORD_CHOICES))
            return "choices that are none";
        if (row->type != MCR_TYPE_CHOICE && row->type != MCR_WORD_TRANSFORM && !(row->min < row->max))
            return "an empty range";
        if (number && row->fallback[0] != 0 && !(row->fallback[0] >= row->min && row->fallback[0] <= row->max))
            return "a default out of range";
        for (uint32_t j = 0; j < i; j++)
            if (strcmp(word->setting[j].name, row->name) == 0)
                return "the same word twice";
    }
    return NULL;
}

int main(void)
{
    const char *list[64];
    size_t count = mcr_block_words(MCR_INSIDE_SCENE, list, 64);
    for (uint32_t i = 0; i < mcr_scene_block_count; i++) {
        const struct mcr_block_word *word = &mcr_scene_blocks[i];
        const struct mcr_block_form *form = mcr_block_form(word->role == MCR_BLOCK_REFERENCE ? MCR_INSIDE_STUDY : MCR_INSIDE_SCENE, word->word);
        const char *why = judge(word);
        ok(!why, "the table of %s%s%s: %s", word->word, word->kind ? " " : "", word->kind ? word->kind : "", why ? why : "good");
        ok(form && (word->kind || word->role == MCR_BLOCK_MATERIAL) == form->has_kind &&
           (word->role == MCR_BLOCK_MATERIAL || word->role == MCR_BLOCK_TEXTURE || word->role == MCR_BLOCK_LIGHT) == form->has_name,
           "the parser knows it, with the same parts");
    }
    for (uint32_t i = 0; i < MCR_FILTER_COUNT; i++)
        ok(!judge(&mcr_filter_words[i]), "the arguments of filter %s", mcr_filter_words[i].word);
    for (uint32_t i = 0; i < MCR_TONE_WORDS; i++)
        ok(!judge(&mcr_tone_words[i]) && strcmp(mcr_tone_words[i].word, mcr_tone_name[i]) == 0, "the arguments of tone %s", mcr_tone_words[i].word);
    ok(!judge(&mcr_roulette_word), "the arguments of roulette on");
    for (size_t i = 0; i < count; i++) {
        int known = strcmp(list[i], "let") == 0 || strcmp(list[i], "include") == 0 || mcr_scene_block(list[i], "perspective") || mcr_scene_block(list[i], "checker") ||
                    mcr_scene_block(list[i], "point");
        ok(known, "the parser's '%s' is known here", list[i]);
    }
    return tap_done();
}
