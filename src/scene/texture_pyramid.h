/* SPDX-License-Identifier: Apache-2.0 */
/* From the numbers of a file to the levels of a texture. Private to the files texture*.c and their tests. */
#ifndef MCR_SCENE_TEXTURE_PYRAMID_H
#define MCR_SCENE_TEXTURE_PYRAMID_H

#include "image/pixels.h"
#include "scene/texture_table.h"

/* What of a file is looked at, and how. */
struct mcr_texture_reading {
    uint32_t transfer; /* enum mcr_transfer */
    uint32_t channels; /* of the texture: 1 or 3 */
    uint32_t channel[3];
    int luminance;     /* one channel, of the three that are named */
};

/* What a file's texels are; those that are not finite are counted, and the first of them told (x, y from the top left). */
struct mcr_texture_survey {
    struct mcr_texture_bounds bounds;
    uint64_t not_finite;
    uint32_t x, y;
};

static inline uint32_t mcr_texture_half(uint32_t size)
{
    return size > 1 ? size / 2 : 1;
}

/* Whether the first level is kept as codes of 8 bits. */
static inline int mcr_texture_codes(const struct mcr_pixels *pixels, const struct mcr_texture_reading *reading)
{
    return pixels->peak && pixels->peak < 256 && !reading->luminance;
}

/* Bytes that a picture takes, with all its levels or its first alone. */
uint64_t mcr_texture_room(uint32_t width, uint32_t height, uint32_t channels, int codes, int pyramid);

/*
 * Fills channels, levels and memory of `image` (its filter is set), from a file that is halved `dropped` times first. Returns 0, or -1
 * without memory. Where texels are not finite it only counts them; nothing is made then.
 */
int mcr_texture_pyramid(const struct mcr_pixels *pixels, const struct mcr_texture_reading *reading, uint32_t dropped,
                        struct mcr_texture_image *image, struct mcr_texture_survey *found);

#endif
