/* SPDX-License-Identifier: Apache-2.0 */
/* What is compared: the colour channels of two images within a region, as rows of encoded values. */
#ifndef MCR_METRICS_PAIR_H
#define MCR_METRICS_PAIR_H

#include "metrics/metrics.h"

#define MCR_PAIR_LUMINANCE MCR_METRICS_CHANNELS /* a series behind those of the channels */

struct mcr_pair {
    const struct mcr_image *image[2];             /* the image and the reference; borrowed */
    uint32_t channels;                            /* 1 or 3 */
    uint32_t from[2][MCR_METRICS_CHANNELS];       /* where they are in each image */
    const char *name[MCR_METRICS_CHANNELS];       /* static */
    uint32_t x0, y0, width, height;               /* the region */
    uint32_t encoding;                            /* MCR_ENCODING_* */
    double peak;
    unsigned char *part;                          /* 1 where a pixel of the region takes part, width * height; NULL: all do. Owned */
    uint64_t pixels;                              /* that take part */
    uint64_t not_finite[2], left_out;             /* values; pixels left out for them */
    double range[2][2];
    double *edge;                                 /* of sRGB codes, or NULL; owned */
};

/* Returns 0, or -1 with the reason. End with mcr_pair_fini in any case. */
int mcr_pair_init(struct mcr_pair *pair, const struct mcr_image *image, const struct mcr_image *reference, const struct mcr_metrics_options *options,
                  char *error, size_t length);
void mcr_pair_fini(struct mcr_pair *pair);

/* Encoded values of row y of the region, pair->width of them: which 0 the image, 1 the reference; series: a channel, or MCR_PAIR_LUMINANCE. */
void mcr_pair_row(const struct mcr_pair *pair, int which, uint32_t series, uint32_t y, double *row);

/* The values of any channel of image `which`, as they are. */
void mcr_pair_channel_row(const struct mcr_pair *pair, int which, uint32_t channel, uint32_t y, double *row);

/* Whether a pixel of the region takes part. */
static inline int mcr_pair_has(const struct mcr_pair *pair, uint32_t x, uint32_t y)
{
    return !pair->part || pair->part[(size_t)y * pair->width + x];
}

/* The channel of that name, or -1. */
int mcr_pair_channel(const struct mcr_image *image, const char *name);

#endif
