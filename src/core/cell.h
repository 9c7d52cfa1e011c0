/* SPDX-License-Identifier: Apache-2.0 */
/* What the core hands to the film: sums over a few consecutive samples of one pixel. */
#ifndef MCR_CORE_CELL_H
#define MCR_CORE_CELL_H

#include <stdint.h>

/* Samples in a cell; the last one of a replicate may hold fewer. */
#define MCR_CELL_SAMPLES 16u

/* Rec. 709 luminance. */
static inline double mcr_luminance(double r, double g, double b)
{
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/* One cell: sums over its samples, and the central second moment of their luminance. */
struct mcr_cell {
    double sum[3];
    double moment;
};

/* The same moment of R, G and B each, where they are asked for. */
struct mcr_cell_channels {
    double moment[3];
};

/* Adds up the samples of one cell by pairs: r, g, b [count], count in 1 .. MCR_CELL_SAMPLES, finite. */
void mcr_cell_sum(const double *r, const double *g, const double *b, uint32_t count, struct mcr_cell *cell);
/* The channels' moments of a cell that was added up. */
void mcr_cell_channel_moments(const double *r, const double *g, const double *b, uint32_t count, const struct mcr_cell *cell,
                              struct mcr_cell_channels *channels);

struct mcr_cell_features; /* features.h */

/*
 * Who takes the cells: the film, or whoever else wants them. Called on the main thread between passes, in the order of the samples.
 * Functions return 0, or -1 when memory is short.
 */
struct mcr_cell_sink {
    void *data;
    /* The next cell of every pixel of the crop, row by row from the top: each of `count` samples. */
    int (*add)(void *data, const struct mcr_cell *cell, uint32_t count);
    /* The samples since the last call, or the beginning, were one replicate. */
    void (*end_replicate)(void *data);
    /* Not NULL: called in the place of `add`, with the moments of the channels, which are computed for it only. */
    int (*add_channels)(void *data, const struct mcr_cell *cell, const struct mcr_cell_channels *channels, uint32_t count);
    /* Not NULL where features are asked for: called after either, of the same samples. */
    int (*add_features)(void *data, const struct mcr_cell_features *features, uint32_t count);
    void *features; /* its data */
};

#endif
