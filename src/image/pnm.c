/* SPDX-License-Identifier: Apache-2.0 */
#include "image/pnm.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The row's bytes in the file's order, one grey value three times for PPM. */
static size_t arrange(const struct mcr_encoder *encoder, const void *row, unsigned char *bytes)
{
    size_t count = (size_t)encoder->image->width * encoder->channels;
    uint32_t copies = encoder->encoding != MCR_ENCODE_FLOAT && encoder->channels == 1 ? 3 : 1;
    unsigned char *at = bytes;
    for (size_t i = 0; i < count; i++) {
        if (encoder->encoding == MCR_ENCODE_FLOAT) {
            uint32_t bits;
            memcpy(&bits, (const float *)row + i, sizeof bits);
            for (int shift = 0; shift < 32; shift += 8) *at++ = (unsigned char)(bits >> shift);
            continue;
        }
        for (uint32_t copy = 0; copy < copies; copy++) {
            if (encoder->encoding == MCR_ENCODE_U8) {
                *at++ = ((const uint8_t *)row)[i];
            } else {
                uint16_t value = ((const uint16_t *)row)[i];
                *at++ = (unsigned char)(value >> 8);
                *at++ = (unsigned char)(value & 255);
            }
        }
    }
    return (size_t)(at - bytes);
}

int mcr_pnm_write(struct mcr_encoder *encoder, struct mcr_sink *sink)
{
    uint32_t width = encoder->image->width, height = encoder->image->height;
    int pfm = encoder->encoding == MCR_ENCODE_FLOAT;
    void *row = malloc(mcr_encoder_row_bytes(encoder));
    unsigned char *bytes = malloc((size_t)width * 3 * 4);
    char header[64];
    int count = pfm ? snprintf(header, sizeof header, "P%c\n%u %u\n-1.0\n", encoder->channels == 1 ? 'f' : 'F', width, height)
                    : snprintf(header, sizeof header, "P6\n%u %u\n%d\n", width, height, encoder->encoding == MCR_ENCODE_U8 ? 255 : 65535);
    if (!row || !bytes) sink->error = ENOMEM;
    mcr_sink_put(sink, header, (size_t)count);
    for (uint32_t i = 0; i < height && !sink->error; i++) {
        mcr_encode_row(encoder, pfm ? height - 1 - i : i, row);
        mcr_sink_put(sink, bytes, arrange(encoder, row, bytes));
    }
    free(bytes);
    free(row);
    return sink->error ? -1 : 0;
}
