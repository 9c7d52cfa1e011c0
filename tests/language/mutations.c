/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Good texts, changed at random with a fixed seed: bytes replaced, removed, doubled, pieces moved, the end cut off. Nothing may crash (the
 * sanitized build looks closely), a text that is not read has an error, every number in a tree is finite, every place lies in its text,
 * and the same text gives the same result twice.
 */
#include "help.h"

#include <math.h>

#define ROUNDS 6000

static const char *const texts[] = {
    ("mcrender 1\nlet room = 555\ncamera perspective { from (278, 278, -800) to (278, 278, 0) fov 40 }\n"
     "film { size (512, 512) filter gaussian(sigma=0.5) }\n"
    "render { sampler stratified(n=4, m=4, mixture(light(by=area) 1, cosine 2*room)) spp 100 }\nmaterial white lambert { albedo hex(\"#ba8\") }\n"
    "quad { corner (213, room - 1, 227) u (130, 0, 0) v (0, 0, 105) material white }\n"),
    ("mcrender 1 # c\nlet a = (1, 2, (3, \"x\\n\")) let b = sqrt(2)^-1 + min(1, 2, 3)/max(2, pi)\ngroup { transform { translate (1, 2, 3) }\n"
    "  mesh { vertices ((0, 0, 0), (1, 0, 0), (0, 1, b)) faces ((0, 1, 2)) normals a color srgb(0.5, 0.25, 1) }\n  box { size b } }\n"),
    "mcrender 1 group { group { group { sphere { radius -(-(2^2^0.5)) center (((1))) } } } } include \"none\" let x = tan(45) disk { r x }\n",
};
static const char spice[] = "(){}[],=+-*/^\"'#\n\r\t \\.0123456789eExabz_\xff\xc3\xa9\xe2\x01";

/* Numerical Recipes' quick generator; only the upper bits are used. */
static uint32_t state = 20201122;
static uint32_t below(uint32_t limit)
{
    state = state * 1664525u + 1013904223u;
    return (uint32_t)(((uint64_t)state * limit) >> 32);
}

static size_t mutate(char *text, size_t length, size_t room)
{
    for (uint32_t times = below(6) + 1; times > 0; times--) {
        uint32_t at = below((uint32_t)length + 1), count = below(12) + 1, to;
        count = at + count > length ? (uint32_t)length - at : count;
        switch (below(7)) {
        case 0:
        case 1:
            if (at < length)
                text[at] = spice[below(sizeof spice)];
            break;
        case 2: /* remove */
            memmove(text + at, text + at + count, length - at - count);
            length -= count;
            break;
        case 3: /* insert */
            if (length < room) {
                memmove(text + at + 1, text + at, length - at);
                text[at] = spice[below(sizeof spice)];
                length++;
            }
            break;
        case 4: /* double a piece elsewhere */
            to = below((uint32_t)length + 1);
            if (length + count <= room) {
                char piece[12];
                memcpy(piece, text + at, count);
                memmove(text + to + count, text + to, length - to);
                memcpy(text + to, piece, count);
                length += count;
            }
            break;
        case 5: /* many of one kind */
            if (length + 80 <= room && count > 8) {
                memmove(text + at + 80, text + at, length - at);
                memset(text + at, spice[below(sizeof spice)], 80);
                length += 80;
            }
            break;
        default:
            length = below(8) ? length : at;
        }
    }
    return length;
}

/* Within the text; 4 bytes of slack for a byte order mark, which columns do not count, and the end, which is 1 long. */
static int place_is_sound(const struct mcr_place *place)
{
    const struct mcr_source *source = place->source;
    uint32_t line = 1;
    const char *at, *end;
    if (!source)
        return 0;
    for (at = source->text, end = at + source->length; line < place->line && at < end; at++)
        line += *at == '\n';
    return line == place->line && place->column >= 1 && (size_t)(end - at) + 4 >= place->column - 1 + (size_t)place->length;
}

static int value_is_sound(const struct mcr_value *value)
{
    int sound = place_is_sound(&value->place) && value->text && (value->kind == MCR_VALUE_NAME || !value->bound);
    if (value->kind == MCR_VALUE_NUMBER)
        return sound && isfinite(value->number);
    for (uint32_t i = 0; i < value->count && sound; i++) {
        if (value->kind == MCR_VALUE_TUPLE)
            sound = value_is_sound(&value->item[i]) && !value->item[i].bound && value->item[i].kind != MCR_VALUE_ERROR;
        else
            sound = value->kind == MCR_VALUE_CALL && value_is_sound(&value->argument[i].value) &&
                    (!value->argument[i].has_weight || value->argument[i].weight.kind == MCR_VALUE_NUMBER);
    }
    return sound;
}

static int item_is_sound(const struct mcr_item *item)
{
    int sound = place_is_sound(&item->place);
    if (!item->is_block)
        return sound && value_is_sound(&item->value);
    for (uint32_t i = 0; i < item->count && sound; i++)
        sound = item_is_sound(&item->item[i]);
    return sound;
}

int main(void)
{
    uint32_t crooked = 0, silent = 0, different = 0, read = 0;
    static char text[4096];

    for (int i = 0; i < ROUNDS; i++) {
        const char *good = texts[below(sizeof texts / sizeof texts[0])];
        struct parsed once, twice;
        size_t length = strlen(good);
        memcpy(text, good, length);
        length = mutate(text, length, sizeof text);
        parse_bytes(&once, text, length, NULL, 0);
        parse_bytes(&twice, text, length, NULL, 0);
        read += once.root != NULL && !mcr_diagnostics_errors(once.diagnostics);
        crooked += once.root && !item_is_sound(once.root);
        silent += !once.root && !mcr_diagnostics_errors(once.diagnostics);
        different += strcmp(once.tree, twice.tree) != 0 || strcmp(once.messages, twice.messages) != 0;
        if ((once.root && !item_is_sound(once.root)) || (!once.root && !mcr_diagnostics_errors(once.diagnostics)))
            printf("# round %d: %.*s\n", i, 200, once.messages);
        parsed_fini(&once);
        parsed_fini(&twice);
    }
    ok(read > 50 && read < ROUNDS / 2, "%d texts were read, %u of them without a mistake", ROUNDS, read);
    ok(crooked == 0, "all values and places are sound");
    ok(silent == 0, "what is not read has an error");
    ok(different == 0, "the same text gives the same result");
    return tap_done();
}
