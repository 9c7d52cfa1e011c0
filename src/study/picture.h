/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures within a page: a part of an image as 8-bit sRGB, in a data: address. */
#ifndef MCR_STUDY_PICTURE_H
#define MCR_STUDY_PICTURE_H

#include "image/image.h"
#include "study/text.h"

struct mcr_view {
    uint32_t x0, y0, x1, y1; /* x0 <= x < x1, within the image */
    uint32_t shrink;         /* >= 1: so many pixels square become one, by their mean as a screen would show it */
    double scale;            /* of the linear values, before they are clipped to [0, 1] */
};

/* The indices of R, G and B by name; else the first three channels, or the first one three times. */
void mcr_picture_channels(const struct mcr_image *image, uint32_t index[3]);
/* Mean luminance (Rec. 709) of finite pixels, not below 0. */
double mcr_picture_luminance(const struct mcr_image *image);
/* Writes data:image/png;base64,... */
void mcr_picture_write(struct mcr_text *out, const struct mcr_image *image, const struct mcr_view *view);

/*
 * How far the images are from the reference, pixel by pixel: what is added is the squared error over the reference's square, at most 1 a
 * channel, so that neither a lamp nor a single bright dot outweighs the rest. Then the square window in which they are farthest.
 */
struct mcr_error_field {
    uint32_t width, height;
    double *sum; /* owned; of width * height */
};
/* 0, or -1 when memory is short. */
int mcr_error_field_init(struct mcr_error_field *field, const struct mcr_image *reference);
/* An image of another size is passed over. */
void mcr_error_field_add(struct mcr_error_field *field, const struct mcr_image *image, const struct mcr_image *reference);
/* Of `side` pixels, within region x0 y0 x1 y1, which it fits in; the centre where nothing was added. */
void mcr_error_field_window(const struct mcr_error_field *field, const uint32_t region[4], uint32_t side, uint32_t window[4]);
void mcr_error_field_fini(struct mcr_error_field *field);

#endif
