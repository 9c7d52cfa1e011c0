/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The private interface between mcrender and its module oiio.so, which alone links OpenImageIO. Program and module are built and
 * installed together: the version must be equal. No C++ type, exception or allocation crosses. Main thread only.
 */
#ifndef MCR_IMAGE_OIIO_H
#define MCR_IMAGE_OIIO_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MCR_OIIO_VERSION 3u

/* Types of values in rows that are written. Integers are sRGB, floats linear Rec. 709. */
#define MCR_OIIO_U8 0u
#define MCR_OIIO_U16 1u
#define MCR_OIIO_FLOAT 2u

struct mcr_oiio_attribute {
    const char *name, *text;
};

struct mcr_oiio_output {
    uint32_t size;
    uint32_t width, height, channels;
    uint32_t type;                          /* MCR_OIIO_* */
    uint32_t attribute_count;
    const struct mcr_oiio_attribute *attribute;
    const char *format;                     /* OpenImageIO's name: "openexr", "png", … */
    const char *const *channel;             /* names */
    const char *date;                       /* "YYYY:MM:DD HH:MM:SS" */
    void *context;
    /* Stores row y, from the top; each is asked for once, in order. Does not fail. */
    void (*row)(void *context, uint32_t y, void *row);
    /* Takes bytes of the finished file, in order. -1: stop; the caller knows why. */
    int32_t (*put)(void *context, const void *bytes, uint64_t count);
};

/* How the values of a file are encoded. */
#define MCR_OIIO_LINEAR 0u
#define MCR_OIIO_SRGB 1u
#define MCR_OIIO_GAMMA 2u

struct mcr_oiio_header {
    uint32_t size;
    uint32_t width, height, channels;
    uint32_t bits;              /* of integer values, 0 for floats */
    uint32_t transfer;          /* MCR_OIIO_LINEAR, … */
    double gamma;               /* MCR_OIIO_GAMMA: linear = encoded ^ gamma */
    int32_t alpha, depth;       /* channels that are linear in any case, -1: none */
    const char *const *channel; /* names, valid during the call */
    uint32_t units;             /* of the attribute mcrender:units, 0 where it is absent */
    uint32_t type;              /* MCR_OIIO_*: what the values are given as, where they are asked for as the file holds them */
};

/* Integers of 8 and 16 bits as they are, all others as floats; and the same whatever colours they may mean: nothing of them is judged. */
#define MCR_OIIO_RAW 1u
#define MCR_OIIO_DATA 2u

struct mcr_oiio_input {
    uint32_t size;
    uint32_t max_side, max_channels;
    uint32_t raw;               /* 0: all values as doubles; MCR_OIIO_RAW, MCR_OIIO_DATA */
    uint64_t max_bytes;         /* of all values in that form */
    const char *format;
    const void *bytes;          /* the file */
    uint64_t count;
    void *context;
    /* Told what the file holds, within the limits; gives room for all values, or NULL: stop. */
    void *(*begin)(void *context, const struct mcr_oiio_header *header);
};

/* All return 0, or -1 with the reason in error[0..length). */
struct mcr_oiio {
    uint32_t size, version;
    const char *kind; /* MCR_OIIO_KIND: every module of mcrender exports a table, each of its own kind, by the same name */
    /* Whether this OpenImageIO reads and writes a format. */
    int32_t (*check)(const char *format, char *error, uint64_t length);
    int32_t (*write)(const struct mcr_oiio_output *output, char *error, uint64_t length);
    /* Values as they are stored, integers divided by 2^bits - 1 where they are given as floating point. */
    int32_t (*read)(const struct mcr_oiio_input *input, char *error, uint64_t length);
};

#define MCR_OIIO_KIND "oiio"
#define MCR_OIIO_SYMBOL "mcr_module" /* the one symbol of the module: a struct mcr_oiio */

#ifdef __cplusplus
}
#endif

#endif
