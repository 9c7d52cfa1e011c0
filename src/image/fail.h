/* SPDX-License-Identifier: Apache-2.0 */
/* Errors of this folder are text, because outputs are named on the command line and not at a place in a file. */
#ifndef MCR_IMAGE_FAIL_H
#define MCR_IMAGE_FAIL_H

#include <stddef.h>

/* Stores a message, cut to length - 1 bytes; nothing when length is 0. Returns -1. */
int mcr_image_fail(char *error, size_t length, const char *format, ...) __attribute__((format(printf, 3, 4)));

#endif
