/* SPDX-License-Identifier: Apache-2.0 */
/* What the tests of images share: a folder, whole files, an image made of given values. */
#ifndef TESTS_IMAGE_HELP_H
#define TESTS_IMAGE_HELP_H

#include "../tap.h"
#include "image/image.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define UNUSED __attribute__((unused))

static char folder[512];

/* A new folder, also in `folder`. */
static UNUSED void enter_folder(void)
{
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%.400s/mcr-image-XXXXXX", base && *base ? base : "/tmp");
    if (!mkdtemp(folder)) {
        perror(folder);
        exit(99);
    }
}

/* folder/NAME in one of eight static buffers. */
static UNUSED const char *in_folder(const char *format, ...)
{
    static char buffer[8][1024];
    static unsigned turn;
    char *text = buffer[turn++ % 8];
    int used = snprintf(text, 1024, "%s/", folder);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, 1024 - (size_t)used, format, arguments);
    va_end(arguments);
    return text;
}

/* Removes the folder, one level of subfolders included. */
static UNUSED void leave_folder(void)
{
    char command[600];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    if (system(command)) perror(command);
}

/* Entries of a folder, "." and ".." not counted. */
static UNUSED int entries(const char *path)
{
    DIR *stream = opendir(path);
    int count = 0;
    while (stream && readdir(stream)) count++;
    if (stream) closedir(stream);
    return count - 2;
}

/* A whole file; *count bytes, NUL-terminated; freed by the caller. NULL if it cannot be read. */
static UNUSED unsigned char *slurp(const char *path, size_t *count)
{
    FILE *file = fopen(path, "rb");
    unsigned char *bytes = file ? malloc(1 << 24) : NULL;
    if (file && bytes) bytes[*count = fread(bytes, 1, (1 << 24) - 1, file)] = '\0';
    if (file) fclose(file);
    return bytes;
}

static UNUSED void spill(const char *path, const void *bytes, size_t count)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, count, file) != count || fclose(file)) {
        perror(path);
        exit(99);
    }
}

static UNUSED int file_is(const char *path, const void *bytes, size_t count)
{
    size_t found = 0;
    unsigned char *content = slurp(path, &found);
    int same = content && found == count && !memcmp(content, bytes, count);
    free(content);
    return same;
}

static UNUSED struct mcr_image *image_of(uint32_t width, uint32_t height, uint32_t channels, const char *const *name, const double *values)
{
    struct mcr_image *image = mcr_image_create(width, height, channels, name);
    memcpy(image->data, values, (size_t)width * height * channels * sizeof *values);
    return image;
}

/* Opens and writes; the error of either in result. */
static UNUSED int put(const char *path, const struct mcr_image *image, uint32_t bits, double exposure, struct mcr_write_result *result)
{
    struct mcr_write_options options = {.bits = bits, .exposure = exposure};
    memset(result, 0, sizeof *result);
    struct mcr_target *target = mcr_target_open(path, result->error, sizeof result->error);
    return target ? mcr_target_write(target, image, &options, result) : -1;
}

/* Numbers for fuzzing: splitmix64. */
static UNUSED uint64_t next_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static const char *const rgb[] UNUSED = {"R", "G", "B"};

#endif
