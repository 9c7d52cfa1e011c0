/* SPDX-License-Identifier: Apache-2.0 */
/* Image buffers and the files they are written to and read from. */
#ifndef MCR_IMAGE_IMAGE_H
#define MCR_IMAGE_IMAGE_H

#include <stddef.h>
#include <stdint.h>

#include "image/tone.h"

/* Linear Rec. 709 radiance, double, channels interleaved, rows from the top. */
struct mcr_image {
    uint32_t width, height, channels;
    double *data;                 /* width * height * channels; owned */
    const char *const *name;      /* channels names, e.g. "R" "G" "B" "albedo.R", or NULL; borrowed, but the image's own after mcr_image_read */
    uint32_t units;               /* samples or replicates that the variance layers of a file were made of; 0: not known */
};

/* One attribute of a file's metadata. Text only: 64-bit integers do not survive in every format. */
struct mcr_attribute {
    const char *name, *text;
};

/* Zeroed. NULL when memory is short, a size is 0 or their product overflows. */
struct mcr_image *mcr_image_create(uint32_t width, uint32_t height, uint32_t channels, const char *const *name);
void mcr_image_destroy(struct mcr_image *image);

struct mcr_write_options {
    uint32_t bits;                          /* 8, 16, or 0: 8 in integer formats, floats in TIFF. A format without 16 bits writes 8 */
    double exposure;                        /* stops, within +-128: values are multiplied by 2^exposure; integer formats only */
    uint32_t attribute_count;
    const struct mcr_attribute *attribute;
    struct mcr_tone tone;                   /* after the exposure; integer formats only */
};

/* What writing met. */
struct mcr_write_result {
    uint64_t overflowed;  /* values beyond the format's range, clipped to it */
    uint64_t not_finite;  /* NaN and infinities, written as 0 in integer formats and HDR, kept in the others */
    char error[512];      /* what failed, "" after success */
};

struct mcr_target;

/*
 * Checks and prepares an output before the first ray: format by extension (none: PPM; "-": PPM on standard output), module, folder,
 * permission. NULL after a failure, the reason in `error`. An absent or regular target is proved by a temporary file made beside it and
 * removed at once, so that nothing lies around while rendering; anything else is opened (a FIFO waits for its reader).
 * EXR takes all channels; the other formats R, G and B (the first three where there are no such names), or one grey channel.
 * Files know no other time than SOURCE_DATE_EPOCH, or now, in UTC. The program ignores SIGPIPE and SIGXFSZ: both become errors here.
 */
struct mcr_target *mcr_target_open(const char *path, char *error, size_t length);
/* Whether the target's format holds a picture of so many columns and rows: 0, or -1 with the reason in `error`. */
int mcr_target_check_size(const struct mcr_target *target, uint32_t width, uint32_t height, char *error, size_t length);
/* Encodes and writes, checks (fsync, close) and renames. Returns 0, or -1 with result->error set and the old file untouched. Ends the target. */
int mcr_target_write(struct mcr_target *target, const struct mcr_image *image, const struct mcr_write_options *options,
                     struct mcr_write_result *result);
/* The same for a text, e.g. a report, under any name: no format is asked for, and "-" may be a terminal. */
struct mcr_target *mcr_target_open_text(const char *path, char *error, size_t length);
int mcr_target_write_text(struct mcr_target *target, const char *text, size_t bytes, char *error, size_t length);
/* 1 if writing the one would overwrite or mix with the other: the same file, however it was spelt, or the same pipe. */
int mcr_target_same(const struct mcr_target *a, const struct mcr_target *b);
/* 1 if `path` leads to the regular file that an input ("-": standard input; NULL: none) is read from. */
int mcr_target_is_input(const char *path, const char *input);
/* Gives up a target: nothing is left of it. NULL is allowed. */
void mcr_target_cancel(struct mcr_target *target);

/*
 * Reads an image as linear values: PGM, PPM and PFM here, EXR, PNG, JPEG, TIFF and HDR by OpenImageIO, told by its first bytes. Integers are
 * decoded from sRGB, unless the file says otherwise; alpha stays as it is. At most 65536 x 65536, 256 channels, 1 GiB of pixels.
 * NULL after a failure, the reason in `error`.
 */
struct mcr_image *mcr_image_read(const char *path, char *error, size_t length);

/* 1 if the OpenImageIO module is installed and loads; it is loaded at the first question. */
int mcr_image_module(char *error, size_t length);
/* The module's file, if something has loaded it so far; else NULL. */
const char *mcr_image_module_path(void);

#endif
