/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The OpenImageIO module: oiio.so, in the folders of MCRENDER_MODULE_PATH if that is set (colon-separated), else in
 * MCR_MODULE_DIR. Loaded at the first need, never closed. Main thread only.
 */
#ifndef MCR_IMAGE_MODULE_H
#define MCR_IMAGE_MODULE_H

#include "image/encode.h"
#include "image/image.h"
#include "image/pixels.h"
#include "image/sink.h"

/* Whether the module loads and knows OpenImageIO's format of this name. Returns 0, or -1 with the reason. */
int mcr_module_check(const char *format, char *error, size_t length);

/* Encodes to the sink. Returns 0, or -1 with the reason; "" where it is the sink's error. */
int mcr_module_write(const struct mcr_format *format, struct mcr_encoder *encoder, const struct mcr_write_options *options,
                     struct mcr_sink *sink, char *error, size_t length);

/* Decodes a file in memory. NULL after a failure, the reason in `error`. */
struct mcr_image *mcr_module_read(const char *format, const unsigned char *bytes, size_t count, char *error, size_t length);
/* The same, to numbers as the file holds them. data: of any colour space. */
struct mcr_pixels *mcr_module_pixels(const char *format, const unsigned char *bytes, size_t count, int data, char *error, size_t length);

#endif
