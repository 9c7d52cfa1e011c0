/* SPDX-License-Identifier: Apache-2.0 */
/* Writing PPM and PFM. */
#ifndef MCR_IMAGE_PNM_H
#define MCR_IMAGE_PNM_H

#include "image/encode.h"
#include "image/sink.h"

/*
 * PPM (P6; 16 bits big-endian) for integer encodings, PFM (PF, or Pf for one channel; little-endian, bottom row first) for floats.
 * Returns 0, or -1 after the sink's error or when memory is short (the sink's error is then ENOMEM).
 */
int mcr_pnm_write(struct mcr_encoder *encoder, struct mcr_sink *sink);

#endif
