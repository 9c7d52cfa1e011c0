/* SPDX-License-Identifier: Apache-2.0 */
/* The file formats: which there are, how they are told from each other, how their values are encoded. */
#ifndef MCR_IMAGE_FORMAT_H
#define MCR_IMAGE_FORMAT_H

#include <stddef.h>
#include <stdint.h>

/* How values are stored. */
enum mcr_encoding {
    MCR_ENCODE_U8,    /* sRGB, 0 .. 255 */
    MCR_ENCODE_U16,   /* sRGB, 0 .. 65535 */
    MCR_ENCODE_FLOAT, /* linear, 32-bit IEEE */
    MCR_ENCODE_RGBE   /* linear, 32-bit IEEE that fits Ward's shared-exponent format */
};

struct mcr_format {
    const char *extension;        /* lower case, without the dot */
    const char *module;           /* OpenImageIO's name of the format; NULL: written and read here */
    enum mcr_encoding encoding;   /* with bits = 0 */
    enum mcr_encoding bits8, bits16;
    uint32_t all_channels;        /* 1: takes any number of named channels; 0: R, G and B alone, or one grey channel */
    uint32_t most;                /* columns and rows; 0: as many as there are */
};

/*
 * The format for a path by its extension (any case; none or "-": PPM), as it is checked before the first ray: the module is
 * loaded where the format needs it. NULL after a failure, the reason in `error`.
 */
const struct mcr_format *mcr_format_of_path(const char *path, char *error, size_t length);

/* The encoding that a format uses for write_options.bits. */
enum mcr_encoding mcr_format_encoding(const struct mcr_format *format, uint32_t bits);

/* What a file's first bytes say. */
enum mcr_magic { MCR_MAGIC_UNKNOWN, MCR_MAGIC_PNM, MCR_MAGIC_PFM, MCR_MAGIC_MODULE };

/* *module is set to OpenImageIO's name of the format where the answer is MCR_MAGIC_MODULE. */
enum mcr_magic mcr_format_of_bytes(const unsigned char *bytes, size_t count, const char **module);

#endif
