/* SPDX-License-Identifier: Apache-2.0 */
/* A buffered writer on a descriptor that remembers its first error. */
#ifndef MCR_IMAGE_SINK_H
#define MCR_IMAGE_SINK_H

#include <stddef.h>

struct mcr_sink {
    int fd;      /* the caller's */
    int error;   /* errno of the first failure, 0 */
    size_t used;
    unsigned char buffer[1 << 16];
};

void mcr_sink_init(struct mcr_sink *sink, int fd);
/* Both return 0, or -1 once anything has failed. */
int mcr_sink_put(struct mcr_sink *sink, const void *bytes, size_t count);
int mcr_sink_flush(struct mcr_sink *sink);

#endif
