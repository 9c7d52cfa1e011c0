/* SPDX-License-Identifier: Apache-2.0 */
#include "language/words.h"

#include <string.h>

#define ANYWHERE (MCR_INSIDE_SCENE | MCR_INSIDE_GROUP)
#define PLACED (ANYWHERE | MCR_INSIDE_SHAPE)

static const struct mcr_block_form forms[] = {
    /* word        within    inside               name kind single words */
    { "camera",    ANYWHERE, MCR_INSIDE_SETTINGS, 0,   1,   1,    0 },
    { "film",      ANYWHERE, MCR_INSIDE_SETTINGS, 0,   0,   1,    0 },
    { "render",    ANYWHERE, MCR_INSIDE_SETTINGS, 0,   0,   1,    MCR_WORDS_ALL },
    { "study",     ANYWHERE, MCR_INSIDE_STUDY,    0,   0,   1,    MCR_WORDS_ALL },
    { "reference", MCR_INSIDE_STUDY, MCR_INSIDE_SETTINGS, 0, 0, 0, MCR_WORDS_ALL },
    { "material",  ANYWHERE, MCR_INSIDE_SETTINGS, 1,   1,   0,    0 },
    { "light",     ANYWHERE, MCR_INSIDE_SHAPE,    1,   1,   0,    MCR_WORDS_SRGB },
    { "texture",   ANYWHERE, MCR_INSIDE_SETTINGS, 1,   1,   0,    MCR_WORDS_ALL },
    { "group",     ANYWHERE, MCR_INSIDE_GROUP,    0,   0,   0,    0 },
    { "transform", PLACED,   MCR_INSIDE_SETTINGS, 0,   0,   0,    0 },
    { "plane",     ANYWHERE, MCR_INSIDE_SHAPE,    0,   0,   0,    0 },
    { "sphere",    ANYWHERE, MCR_INSIDE_SHAPE,    0,   0,   0,    0 },
    { "quad",      ANYWHERE, MCR_INSIDE_SHAPE,    0,   0,   0,    0 },
    { "disk",      ANYWHERE, MCR_INSIDE_SHAPE,    0,   0,   0,    0 },
    { "box",       ANYWHERE, MCR_INSIDE_SHAPE,    0,   0,   0,    0 },
    { "triangle",  ANYWHERE, MCR_INSIDE_SHAPE,    0,   0,   0,    0 },
    { "mesh",      ANYWHERE, MCR_INSIDE_SHAPE,    0,   0,   0,    0 },
};

const struct mcr_block_form *mcr_block_form(unsigned inside, const char *word)
{
    for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++)
        if ((forms[i].within & inside) && forms[i].word[0] == word[0] && strcmp(forms[i].word, word) == 0)
            return &forms[i];
    return NULL;
}

size_t mcr_block_words(unsigned inside, const char **list, size_t room)
{
    size_t count = 0;
    for (size_t i = 0; i < sizeof forms / sizeof forms[0] && count < room; i++)
        if (forms[i].within & inside)
            list[count++] = forms[i].word;
    if (count < room)
        list[count++] = "let";
    if (count < room)
        list[count++] = "include";
    return count;
}
