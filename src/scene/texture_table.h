/* SPDX-License-Identifier: Apache-2.0 */
/* What textures are made of. Private to the files texture*.c and their tests. */
#ifndef MCR_SCENE_TEXTURE_TABLE_H
#define MCR_SCENE_TEXTURE_TABLE_H

#include "scene/texture.h"

enum mcr_texture_kind { MCR_TEXTURE_IMAGE, MCR_TEXTURE_CHECKER, MCR_TEXTURE_GRADIENT };
/* In the order of the words `repeat|mirror|clamp`, `nearest|bilinear|mipmap`, `u|v|radial`. */
enum mcr_texture_wrap { MCR_WRAP_REPEAT, MCR_WRAP_MIRROR, MCR_WRAP_CLAMP };
enum mcr_texture_filter { MCR_TEXTURE_NEAREST, MCR_TEXTURE_BILINEAR, MCR_TEXTURE_MIPMAP };
enum mcr_texture_along { MCR_ALONG_U, MCR_ALONG_V, MCR_ALONG_RADIAL };

#define MCR_TEXTURE_LEVELS 17u /* of a picture of 65536 texels, MCR_IMAGE_MAX_SIDE */
#define MCR_TEXTURE_STOPS 256u

/* One level of a picture: rows from the bottom, channels interleaved. */
struct mcr_texture_level {
    uint32_t width, height;
    const uint8_t *code; /* one byte a value, decoded by the table; or NULL */
    const float *value;  /* linear values; or NULL */
};

struct mcr_texture_image {
    uint32_t filter;
    uint32_t wrap[2];
    uint32_t channels;    /* 1 or 3 */
    void *memory;         /* of all levels; from malloc */
    uint32_t level_count; /* 1 unless filter is MCR_TEXTURE_MIPMAP */
    struct mcr_texture_level level[MCR_TEXTURE_LEVELS];
    float decode[256];    /* of codes */
};

struct mcr_texture_checker {
    double even[3], odd[3];
    int filtered; /* averaged over the footprint */
};

struct mcr_texture_gradient {
    uint32_t along, wrap;
    uint32_t count;         /* of stops, at least 2 */
    const double *position; /* ascending, the first 0 and the last 1 */
    const double (*colour)[3];
};

struct mcr_texture {
    uint32_t kind;
    double scale[2], offset[2]; /* texture coordinates are (u, v) * scale + offset */
    struct mcr_texture_bounds bounds;
    int grey;
    uint64_t bytes;
    struct mcr_texture_image image;
    struct mcr_texture_checker checker;
    struct mcr_texture_gradient gradient;
};

/* Frees what is not in the arena. */
void mcr_texture_release(struct mcr_texture *texture);

#endif
