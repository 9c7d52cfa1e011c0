/* SPDX-License-Identifier: Apache-2.0 */
/* Blocks `texture NAME image { … }`: a file becomes the levels of a texture, within the memory that the scene gives to textures. */
#include "scene/build.h"
#include "scene/texture_pyramid.h"

#include <stdlib.h>
#include <string.h>

enum { CHANNEL_AUTO, CHANNEL_RED, CHANNEL_GREEN, CHANNEL_BLUE, CHANNEL_ALPHA, CHANNEL_LUMINANCE };

/* What the settings say of the numbers. */
struct asked {
    uint32_t colour, channel;
};

static uint32_t choice(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index)
{
    double number = settings->word->setting[index].fallback[0];
    mcr_read_number(build, settings, index, &number);
    return (uint32_t)number;
}

/* The place of a word in repeat, mirror, clamp; -1 after an error. */
static int read_wrap_word(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_value *value)
{
    static const char *const words[] = { "repeat", "mirror", "clamp" };
    const struct mcr_parameter *row = &settings->word->setting[IMAGE_WRAP];
    if (value->kind != MCR_VALUE_NAME)
        return mcr_wrong_kind(build, value, row->name, settings->of, mcr_word_form(row->type));
    for (int i = 0; i < 3; i++)
        if (strcmp(value->text, words[i]) == 0)
            return i;
    mcr_unknown_word(build, value->place, "word", value->text, row->name, words, 3);
    return -1;
}

static void read_wrap(struct mcr_build *build, const struct mcr_settings *settings, uint32_t wrap[2])
{
    const struct mcr_parameter *row = &settings->word->setting[IMAGE_WRAP];
    const struct mcr_value *value = settings->value[IMAGE_WRAP];
    int pair = value && value->kind == MCR_VALUE_TUPLE, found;
    if (!value || value->kind == MCR_VALUE_ERROR)
        return;
    if (pair && value->count != 2) {
        mcr_wrong_kind(build, value, row->name, settings->of, mcr_word_form(row->type));
        return;
    }
    for (uint32_t axis = 0; axis < 2; axis++) {
        found = read_wrap_word(build, settings, pair ? &value->item[axis] : value);
        if (found < 0)
            return;
        wrap[axis] = (uint32_t)found;
    }
}

/* The path of the file; NULL after an error. */
static const char *path_of(struct mcr_build *build, const struct mcr_settings *settings)
{
    const struct mcr_value *value = settings->value[IMAGE_FILE], *text = value ? mcr_value_resolve(value) : NULL;
    if (!text)
        return NULL; /* told as missing */
    if (text->kind != MCR_VALUE_STRING) {
        mcr_wrong_kind(build, value, "file", settings->of, mcr_word_form(MCR_WORD_TEXT));
        return NULL;
    }
    if (!*text->text) {
        mcr_error(build, value->place, "'file' of '%s' is empty", settings->of);
        return NULL;
    }
    return mcr_build_path(build, text->text, text->place);
}

/* Which channels, and how they are decoded; -1 after an error. */
static int read_reading(struct mcr_build *build, const struct mcr_settings *settings, struct asked asked, const struct mcr_pixels *pixels,
                        struct mcr_texture_reading *reading)
{
    uint32_t colour = asked.colour, channel = asked.channel;
    uint32_t rgb[3] = { (uint32_t)pixels->red, (uint32_t)pixels->green, (uint32_t)pixels->blue };
    int grey = rgb[0] == rgb[1] && rgb[1] == rgb[2];
    *reading = (struct mcr_texture_reading){ .channels = grey ? 1 : 3,
                                             .channel = { rgb[0], rgb[1], rgb[2] } };
    reading->transfer = mcr_build_transfer(colour, pixels);
    if (channel == CHANNEL_AUTO)
        return 0;
    reading->channels = 1;
    reading->luminance = channel == CHANNEL_LUMINANCE && !grey;
    if (channel >= CHANNEL_RED && channel <= CHANNEL_BLUE)
        reading->channel[0] = rgb[channel - CHANNEL_RED];
    if (channel != CHANNEL_ALPHA)
        return 0;
    if (pixels->alpha < 0) {
        mcr_error(build, settings->value[IMAGE_CHANNEL]->place, "the picture has no channel 'alpha'");
        return -1;
    }
    reading->channel[0] = (uint32_t)pixels->alpha;
    reading->transfer = MCR_TRANSFER_LINEAR;
    return 0;
}

static double mebibytes(uint64_t bytes)
{
    return (double)bytes / 1048576;
}

/* How often the picture is halved to fit into what is left of the memory for textures, with a warning; -1 after an error: never. */
static int drop(struct mcr_build *build, const struct mcr_pixels *pixels, const struct mcr_texture_reading *reading, int pyramid,
                struct mcr_place place, uint64_t *bytes)
{
    uint64_t left = build->texture_memory - build->texture_bytes, whole;
    uint32_t width = pixels->width, height = pixels->height, codes = (uint32_t)mcr_texture_codes(pixels, reading);
    int dropped = 0;
    whole = *bytes = mcr_texture_room(width, height, reading->channels, codes != 0, pyramid);
    while (*bytes > left && (width > 1 || height > 1)) {
        width = mcr_texture_half(width);
        height = mcr_texture_half(height);
        *bytes = mcr_texture_room(width, height, reading->channels, 0, pyramid);
        dropped++;
    }
    if (*bytes > left) {
        mcr_error(build, place, "no memory is left for this picture: texture_memory is %.6g MiB, %.6g of it taken", mebibytes(build->texture_memory),
                  mebibytes(build->texture_bytes));
        return -1;
    }
    if (dropped)
        mcr_report(build->diagnostics, MCR_WARNING, place,
                   "this picture of %u x %u takes %.6g MiB, and texture_memory leaves %.6g: it is reduced to %u x %u", pixels->width, pixels->height,
                   mebibytes(whole), mebibytes(left), width, height);
    return dropped;
}

static void make_levels(struct mcr_build *build, const struct mcr_settings *settings, struct asked asked, const struct mcr_pixels *pixels,
                        struct mcr_texture *texture)
{
    struct mcr_place place = settings->value[IMAGE_FILE]->place;
    struct mcr_texture_reading reading;
    struct mcr_texture_survey survey;
    uint64_t bytes;
    int dropped;
    if (read_reading(build, settings, asked, pixels, &reading) != 0)
        return;
    dropped = drop(build, pixels, &reading, texture->image.filter == MCR_TEXTURE_MIPMAP, place, &bytes);
    if (dropped < 0)
        return;
    if (mcr_texture_pyramid(pixels, &reading, (uint32_t)dropped, &texture->image, &survey) != 0) {
        mcr_error(build, place, "not enough memory for a picture of %u x %u", pixels->width, pixels->height);
        return;
    }
    if (survey.not_finite) {
        mcr_error(build, place, "the picture holds values that are not finite: %llu, the first in column %u of row %u, counted from 0 at the top left",
                  (unsigned long long)survey.not_finite, survey.x, survey.y);
        return;
    }
    texture->kind = MCR_TEXTURE_IMAGE;
    texture->bounds = survey.bounds;
    texture->grey = reading.channels == 1;
    texture->bytes = bytes;
    build->texture_bytes += bytes;
}

uint32_t mcr_build_transfer(uint32_t colour, const struct mcr_pixels *pixels)
{
    return colour == MCR_COLOUR_AUTO ? pixels->transfer : colour == MCR_COLOUR_LINEAR ? MCR_TRANSFER_LINEAR : MCR_TRANSFER_SRGB;
}

void mcr_build_image(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_texture *texture)
{
    const char *path = path_of(build, settings);
    struct asked asked = { choice(build, settings, IMAGE_COLOUR), choice(build, settings, IMAGE_CHANNEL) };
    struct mcr_pixels *pixels;
    char reason[400];
    texture->image.filter = choice(build, settings, IMAGE_FILTER);
    read_wrap(build, settings, texture->image.wrap);
    if (!path)
        return;
    pixels = mcr_pixels_read(path, asked.colour != MCR_COLOUR_AUTO, reason, sizeof reason);
    if (!pixels) {
        mcr_error(build, settings->value[IMAGE_FILE]->place, "cannot read '%s': %s", path, reason);
        return;
    }
    mcr_build_file(build, path, pixels->hash);
    make_levels(build, settings, asked, pixels, texture);
    mcr_pixels_destroy(pixels);
}

void mcr_texture_release(struct mcr_texture *texture)
{
    free(texture->image.memory);
    texture->image.memory = NULL;
}
