/* SPDX-License-Identifier: Apache-2.0 */
/* A picture's numbers as its file holds them: codes of 8 or 16 bits, or floats. For textures, which decode them in their own time. */
#ifndef MCR_IMAGE_PIXELS_H
#define MCR_IMAGE_PIXELS_H

#include <stddef.h>
#include <stdint.h>

/* How numbers are encoded: those of image/oiio.h. */
enum mcr_transfer { MCR_TRANSFER_LINEAR, MCR_TRANSFER_SRGB, MCR_TRANSFER_GAMMA };

/* Channels interleaved, rows from the top. */
struct mcr_pixels {
    uint32_t width, height, channels;
    uint32_t peak;                        /* the code of 1; 0: floats */
    const uint8_t *code;                  /* peak < 256 */
    const uint16_t *wide;                 /* peak < 65536, else */
    const float *value;                   /* peak 0 */
    uint32_t transfer;                    /* as the file says, or its format by custom: sRGB for integers, linear for floats */
    double gamma;                         /* MCR_TRANSFER_GAMMA: linear = encoded ^ gamma */
    int32_t red, green, blue;             /* channels of a colour picture, or all the same: a grey one */
    int32_t alpha;                        /* -1: none. Always linear */
    uint64_t hash;                        /* FNV-1a 64 of the file's bytes */
    void *memory;
};

/*
 * Reads a picture of any format that mcr_image_read reads, within its limits. NULL after a failure, the reason, without the file's
 * name, in `error`. data: what the numbers mean is known, and a colour space or primaries that we do not know are no failure.
 */
struct mcr_pixels *mcr_pixels_read(const char *path, int data, char *error, size_t length);
/* NULL is allowed. */
void mcr_pixels_destroy(struct mcr_pixels *pixels);

/* Linear light of an encoded number; of any size and sign, as floats may be. */
double mcr_transfer_decode(uint32_t transfer, double gamma, double encoded);

/* Linear light of the codes 0 .. peak, allocated, the caller's to free. NULL for floats, or when memory is short. */
double *mcr_pixels_table(const struct mcr_pixels *pixels, uint32_t transfer);
/* The number at place `at` of the array in linear light. table: of mcr_pixels_table, where there are codes. */
double mcr_pixels_linear(const struct mcr_pixels *pixels, uint32_t transfer, const double *table, size_t at);

#endif
