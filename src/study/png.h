/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A small writer of PNG (ISO/IEC 15948), for the pictures within a report: they are there without OpenImageIO too, and have the same bytes
 * everywhere. Colours are filtered as PNG does it and coded by Huffman's code with runs (RFC 1951), without a search for repetitions:
 * noise has none.
 */
#ifndef MCR_STUDY_PNG_H
#define MCR_STUDY_PNG_H

#include <stddef.h>
#include <stdint.h>

#define MCR_PNG_MAX_SIDE 4096u

/* 8-bit sRGB, rgb[3 * (y * width + x)], rows from the top; sides of 1 ... MCR_PNG_MAX_SIDE. The file's bytes, to be freed by the caller;
 * NULL when memory is short or a side is out of range. */
unsigned char *mcr_png_encode(const uint8_t *rgb, uint32_t width, uint32_t height, size_t *length);

#endif
