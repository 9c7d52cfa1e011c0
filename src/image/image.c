/* SPDX-License-Identifier: Apache-2.0 */
#include "image/image.h"

#include "image/fail.h"
#include "image/format.h"
#include "image/module.h"
#include "image/read.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int mcr_image_fail(char *error, size_t length, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (length) vsnprintf(error, length, format, arguments);
    va_end(arguments);
    return -1;
}

/* The image and `extra` zeroed bytes behind its structure. */
static struct mcr_image *create(uint32_t width, uint32_t height, uint32_t channels, size_t extra)
{
    size_t pixels, values;
    if (!width || !height || !channels || __builtin_mul_overflow((size_t)width, height, &pixels) ||
        __builtin_mul_overflow(pixels, channels, &values))
        return NULL;
    struct mcr_image *image = calloc(1, sizeof *image + extra);
    double *data = image ? calloc(values, sizeof *data) : NULL;
    if (!data) {
        free(image);
        return NULL;
    }
    image->width = width, image->height = height, image->channels = channels;
    image->data = data;
    return image;
}

struct mcr_image *mcr_image_create(uint32_t width, uint32_t height, uint32_t channels, const char *const *name)
{
    struct mcr_image *image = create(width, height, channels, 0);
    if (image) image->name = name;
    return image;
}

struct mcr_image *mcr_image_create_named(uint32_t width, uint32_t height, uint32_t channels, const char *const *name)
{
    uint64_t values;
    size_t text = 0;
    if (width > MCR_IMAGE_MAX_SIDE || height > MCR_IMAGE_MAX_SIDE || channels > MCR_IMAGE_MAX_CHANNELS) return NULL;
    values = (uint64_t)width * height * channels;
    if (values > MCR_IMAGE_MAX_BYTES / sizeof(double)) return NULL;
    for (uint32_t c = 0; c < channels; c++) text += strlen(name[c]) + 1;
    struct mcr_image *image = create(width, height, channels, channels * sizeof(char *) + text);
    if (!image) return NULL;
    const char **copies = (const char **)(image + 1);
    char *at = (char *)(copies + channels);
    for (uint32_t c = 0; c < channels; c++) {
        size_t bytes = strlen(name[c]) + 1;
        copies[c] = memcpy(at, name[c], bytes);
        at += bytes;
    }
    image->name = copies;
    return image;
}

void mcr_image_destroy(struct mcr_image *image)
{
    if (!image) return;
    free(image->data);
    free(image);
}

void mcr_image_unknown(size_t count, char *error, size_t length)
{
    mcr_image_fail(error, length, "%s",
                   count ? "its first bytes are those of no known image format (PPM, PFM, EXR, PNG, JPEG, TIFF, HDR)" : "it is empty");
}

int mcr_image_needs_module(const char *module, char *error, size_t length)
{
    char reason[300];
    if (mcr_image_module(reason, sizeof reason)) return 0;
    return mcr_image_fail(error, length, "its format (%s) needs OpenImageIO, which is not available: %s", module, reason);
}

struct mcr_image *mcr_image_decode(const unsigned char *bytes, size_t count, char *error, size_t length)
{
    const char *module = NULL;
    switch (mcr_format_of_bytes(bytes, count, &module)) {
    case MCR_MAGIC_PNM: return mcr_pnm_read(bytes, count, error, length);
    case MCR_MAGIC_PFM: return mcr_pfm_read(bytes, count, error, length);
    case MCR_MAGIC_MODULE: break;
    case MCR_MAGIC_UNKNOWN: mcr_image_unknown(count, error, length); return NULL;
    }
    return mcr_image_needs_module(module, error, length) ? NULL : mcr_module_read(module, bytes, count, error, length);
}

/* All bytes of a file, at most MCR_IMAGE_MAX_BYTES; the caller frees them. NULL after a failure. */
static unsigned char *read_all(int fd, size_t *count, char *error, size_t length)
{
    size_t used = 0, room = 1 << 16;
    struct stat status;
    if (fstat(fd, &status)) return mcr_image_fail(error, length, "%s", strerror(errno)), NULL;
    if (S_ISDIR(status.st_mode)) return mcr_image_fail(error, length, "it is a folder"), NULL;
    if (S_ISREG(status.st_mode) && (uint64_t)status.st_size > MCR_IMAGE_MAX_BYTES)
        return mcr_image_fail(error, length, "the file is larger than 1 GiB"), NULL;
    if (S_ISREG(status.st_mode)) room = (size_t)status.st_size + 1; /* one more, to meet the end without growing */
    unsigned char *bytes = malloc(room);
    while (bytes) {
        ssize_t got = read(fd, bytes + used, room - used);
        if (got == 0) return *count = used, bytes;
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            mcr_image_fail(error, length, "%s", strerror(errno));
            return free(bytes), NULL;
        }
        used += (size_t)got;
        if (used < room) continue;
        if (used > MCR_IMAGE_MAX_BYTES) {
            mcr_image_fail(error, length, "the file is larger than 1 GiB");
            return free(bytes), NULL;
        }
        unsigned char *more = realloc(bytes, room *= 2);
        if (!more) free(bytes);
        bytes = more;
    }
    mcr_image_fail(error, length, "not enough memory");
    return NULL;
}

unsigned char *mcr_image_bytes(const char *path, size_t *count, char *error, size_t length)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
    if (fd < 0) return mcr_image_fail(error, length, "%s", strerror(errno)), NULL;
    unsigned char *bytes = read_all(fd, count, error, length);
    close(fd);
    return bytes;
}

struct mcr_image *mcr_image_read(const char *path, char *error, size_t length)
{
    char reason[400] = "";
    size_t count = 0;
    struct mcr_image *image = NULL;
    unsigned char *bytes = mcr_image_bytes(path, &count, reason, sizeof reason);
    if (bytes) image = mcr_image_decode(bytes, count, reason, sizeof reason);
    free(bytes);
    if (!image) mcr_image_fail(error, length, "cannot read '%.200s': %s", path, reason);
    return image;
}
