/* SPDX-License-Identifier: Apache-2.0 */
#include "image/format.h"

#include "image/fail.h"
#include "image/image.h"
#include "image/module.h"

#include <string.h>
#include <strings.h>

/*
 * Only formats in this table are ever asked of OpenImageIO, whose other readers we do not trust with files of unknown origin.
 * TIFF holds both: floats unless 8 or 16 bits were asked for.
 */
#define JPEG_MOST 65500 /* what libjpeg is built for; it ends the process where there are more */
static const struct mcr_format formats[] = {
    {"ppm", NULL, MCR_ENCODE_U8, MCR_ENCODE_U8, MCR_ENCODE_U16, 0, 0},
    {"pfm", NULL, MCR_ENCODE_FLOAT, MCR_ENCODE_FLOAT, MCR_ENCODE_FLOAT, 0, 0},
    {"exr", "openexr", MCR_ENCODE_FLOAT, MCR_ENCODE_FLOAT, MCR_ENCODE_FLOAT, 1, 0},
    {"png", "png", MCR_ENCODE_U8, MCR_ENCODE_U8, MCR_ENCODE_U16, 0, 0},
    {"jpg", "jpeg", MCR_ENCODE_U8, MCR_ENCODE_U8, MCR_ENCODE_U8, 0, JPEG_MOST},
    {"jpeg", "jpeg", MCR_ENCODE_U8, MCR_ENCODE_U8, MCR_ENCODE_U8, 0, JPEG_MOST},
    {"tif", "tiff", MCR_ENCODE_FLOAT, MCR_ENCODE_U8, MCR_ENCODE_U16, 0, 0},
    {"tiff", "tiff", MCR_ENCODE_FLOAT, MCR_ENCODE_U8, MCR_ENCODE_U16, 0, 0},
    {"hdr", "hdr", MCR_ENCODE_RGBE, MCR_ENCODE_RGBE, MCR_ENCODE_RGBE, 0, 0},
};
#define FORMAT_COUNT (sizeof formats / sizeof formats[0])

static const struct magic {
    const char *bytes;
    size_t count;
    const char *module;
} magics[] = {
    {"\x76\x2f\x31\x01", 4, "openexr"},
    {"\x89PNG\r\n\x1a\n", 8, "png"},
    {"\xff\xd8\xff", 3, "jpeg"},
    {"II*\0", 4, "tiff"},
    {"MM\0*", 4, "tiff"},
    {"II+\0", 4, "tiff"},
    {"MM\0+", 4, "tiff"},
    {"#?RADIANCE", 10, "hdr"},
    {"#?RGBE", 6, "hdr"},
};

/* The part behind the last dot of the file's name; "" without one, and for names like ".profile". */
static const char *extension_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    return dot && dot != name ? dot + 1 : "";
}

static const struct mcr_format *unknown(const char *path, const char *extension, char *error, size_t length)
{
    char reason[200];
    int there = mcr_image_module(reason, sizeof reason);
    mcr_image_fail(error, length,
                   "cannot write '%.200s': unknown image format '.%.20s'; known are .ppm and .pfm, and through OpenImageIO .exr, .png, "
                   ".jpg, .jpeg, .tif, .tiff and .hdr (%s%s)", path, extension, there ? "installed" : "not installed: ", there ? "" : reason);
    return NULL;
}

const struct mcr_format *mcr_format_of_path(const char *path, char *error, size_t length)
{
    const char *extension = extension_of(path);
    if (!*extension) return &formats[0];
    for (size_t i = 0; i < FORMAT_COUNT; i++) {
        char reason[250];
        if (strcasecmp(extension, formats[i].extension)) continue;
        if (!formats[i].module || !mcr_module_check(formats[i].module, reason, sizeof reason)) return &formats[i];
        mcr_image_fail(error, length, "cannot write '%.200s': .%s needs OpenImageIO, which is not available: %s", path,
                       formats[i].extension, reason);
        return NULL;
    }
    return unknown(path, extension, error, length);
}

enum mcr_encoding mcr_format_encoding(const struct mcr_format *format, uint32_t bits)
{
    return bits == 0 ? format->encoding : bits == 8 ? format->bits8 : format->bits16;
}

enum mcr_magic mcr_format_of_bytes(const unsigned char *bytes, size_t count, const char **module)
{
    if (count >= 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6') return MCR_MAGIC_PNM;
    if (count >= 2 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f')) return MCR_MAGIC_PFM;
    for (size_t i = 0; i < sizeof magics / sizeof magics[0]; i++) {
        if (count < magics[i].count || memcmp(bytes, magics[i].bytes, magics[i].count)) continue;
        *module = magics[i].module;
        return MCR_MAGIC_MODULE;
    }
    return MCR_MAGIC_UNKNOWN;
}
