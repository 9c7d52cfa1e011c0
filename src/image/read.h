/* SPDX-License-Identifier: Apache-2.0 */
/* Decoding of files in memory. Files are not trusted: sizes are checked before memory is asked for. */
#ifndef MCR_IMAGE_READ_H
#define MCR_IMAGE_READ_H

#include "image/image.h"
#include "image/pixels.h"

#define MCR_IMAGE_MAX_SIDE 65536u
#define MCR_IMAGE_MAX_CHANNELS 256u
#define MCR_IMAGE_MAX_BYTES ((uint64_t)1 << 30) /* of pixels in memory, and of a file */

/* As mcr_image_create, with a copy of the names that lives as long as the image; zeroed. NULL beyond the limits above, too. */
struct mcr_image *mcr_image_create_named(uint32_t width, uint32_t height, uint32_t channels, const char *const *name);

/* An image from the bytes of a file of any known format. NULL after a failure, the reason, without a file's name, in `error`. */
struct mcr_image *mcr_image_decode(const unsigned char *bytes, size_t count, char *error, size_t length);

/* All bytes of a file; free() them. NULL after a failure, the reason, without the file's name, in `error`. */
unsigned char *mcr_image_bytes(const char *path, size_t *count, char *error, size_t length);
/* Tells that the first of `count` bytes are no known format's. */
void mcr_image_unknown(size_t count, char *error, size_t length);
/* 0, or -1 after telling that a format of OpenImageIO cannot be read without it. */
int mcr_image_needs_module(const char *module, char *error, size_t length);

/* Zeroed numbers as a file holds them; peak 0: floats. NULL beyond the limits above, or when memory is short. */
struct mcr_pixels *mcr_pixels_create(uint32_t width, uint32_t height, uint32_t channels, uint32_t peak);
/* Finds colours and alpha by the channels' names; alpha >= 0: known to be that one. */
void mcr_pixels_name(struct mcr_pixels *pixels, const char *const *names, int32_t alpha);
/* Codes of PGM and PPM. */
struct mcr_pixels *mcr_pnm_pixels(const unsigned char *bytes, size_t count, char *error, size_t length);

/* The same for PGM and PPM (P2, P3, P5, P6), and for PFM (PF, Pf). */
struct mcr_image *mcr_pnm_read(const unsigned char *bytes, size_t count, char *error, size_t length);
struct mcr_image *mcr_pfm_read(const unsigned char *bytes, size_t count, char *error, size_t length);

#endif
