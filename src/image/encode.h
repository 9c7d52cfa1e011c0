/* SPDX-License-Identifier: Apache-2.0 */
/* From linear doubles to the values of a file, row by row; what does not fit is clipped and counted. */
#ifndef MCR_IMAGE_ENCODE_H
#define MCR_IMAGE_ENCODE_H

#include "image/format.h"
#include "image/image.h"

struct mcr_encoder {
    const struct mcr_image *image; /* borrowed */
    enum mcr_encoding encoding;
    uint32_t channels;             /* of a row that is written */
    uint32_t all;                  /* 1: all channels of the image in their order; 0: from[] */
    uint32_t from[3];
    double scale;                  /* 2^exposure */
    struct mcr_tone tone;          /* integer formats; linear after init */
    uint64_t overflowed, not_finite;
    double edge[257];              /* U8: the least linear value of each code, nearly; edge[256] is beyond 1 */
};

/* Chooses the channels for `format`: all, or R, G and B by name (the first three without names), or one grey channel. */
void mcr_encoder_init(struct mcr_encoder *encoder, const struct mcr_image *image, const struct mcr_format *format, uint32_t bits,
                      double exposure);

/* Bytes of one row. */
size_t mcr_encoder_row_bytes(const struct mcr_encoder *encoder);

/* Stores row y (from the top) as uint8_t, uint16_t or float, in the machine's byte order. Each row is to be asked for once: it counts. */
void mcr_encode_row(struct mcr_encoder *encoder, uint32_t y, void *row);

/* 2^stops without the C library; exact for whole stops. */
double mcr_exposure_scale(double stops);

#endif
