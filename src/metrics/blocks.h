/* SPDX-License-Identifier: Apache-2.0 */
/* Sums of differences and of their noise over blocks of pixels: what the tests in bias.h are made of. */
#ifndef MCR_METRICS_BLOCKS_H
#define MCR_METRICS_BLOCKS_H

#include <math.h>

#include "metrics/pair.h"

/* One series of two images: rows of values, and where their variances are. */
struct mcr_series {
    const struct mcr_pair *pair;
    uint32_t index;  /* a channel, or MCR_PAIR_LUMINANCE */
    int variance[2]; /* the channel that holds it in each image */
    double *row[2], *variance_row[2]; /* pair->width each */
};

/* What both images say of one pixel. The rest are variances; rounding: of two values stored as 32-bit floats, each off by half a unit at most. */
struct mcr_noisy {
    double e, va, vr, rounding;
};

/* Fills row[] with row y of the region. */
void mcr_series_row(const struct mcr_series *series, uint32_t y);
/* 1 if a pixel of that row can be looked at: it takes part, and its variances are numbers from 0 on. */
int mcr_series_take(const struct mcr_series *series, uint32_t x, uint32_t y, struct mcr_noisy *sample);

static inline double mcr_noisy_variance(const struct mcr_noisy *sample)
{
    return sample->va + sample->vr + sample->rounding;
}

/* Sums over the pixels of a block. */
struct mcr_block {
    uint64_t count;
    double e, e2, va, vr, rounding, v2; /* e2: of e^2; v2: of (va + vr + rounding)^2 */
};

static inline double mcr_block_noise(const struct mcr_block *block)
{
    return block->va + block->vr + block->rounding;
}

/* The blocks of a region, side x side pixels each but for those at the right and lower edges, row by row. */
struct mcr_blocks {
    uint32_t side, columns, rows;
    size_t count;
    struct mcr_block *block; /* freed by the owner of the structure */
};

/* Returns 0, or -1 when memory is short. */
int mcr_blocks_create(struct mcr_blocks *blocks, const struct mcr_series *series, uint32_t side);
/* The block of a pixel. */
const struct mcr_block *mcr_blocks_at(const struct mcr_blocks *blocks, uint32_t x, uint32_t y);
struct mcr_block mcr_blocks_total(const struct mcr_blocks *blocks);
/* The block at a place and those around it, as one. */
struct mcr_block mcr_blocks_around(const struct mcr_blocks *blocks, uint32_t column, uint32_t row);
/* Medians over the blocks where both images have noise; NaN where there is no such block. */
struct mcr_blocks_medians {
    size_t count;   /* such blocks */
    double ratio;   /* the image's variance over the reference's */
    double squares; /* sum of e^2 over that of v: 1 is expected of independent images */
};

/* Returns 0, or -1 when memory is short. */
int mcr_blocks_typical(const struct mcr_blocks *blocks, struct mcr_blocks_medians *typical);

#endif
