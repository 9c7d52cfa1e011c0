/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The film: per-pixel sums of fixed shape and what is needed for their variance.
 *
 * Sums. The samples of a pixel form cells of MCR_CELL_SAMPLES consecutive ones (the last of a replicate may be shorter), added by pairs. Cells are
 * the leaves of a tree of radix MCR_FILM_RADIX: a node is the sum of its children in order. The shape depends on the samples' numbers only, so that
 * threads, batches and passes never change a bit, and a part that is cut at nodes can be added in later. The relative error for samples of one sign
 * is at most (4 + 15 * levels) u: below 2e-14 for 1e8 samples.
 *
 * Variance. With independent numbers each sample is a unit, with correlated ones each replicate: the units' central second moment of luminance
 * is merged pair by pair (Chan, Golub and LeVeque 1983). With fewer than two units the variance is unknown. R, G and B have moments of their own
 * where they are asked for (mcr_film_keep_channels); without, nothing is stored or computed for them.
 *
 * All pixels have the same samples (mcr_film_add), or each its own number of replicates of one size (mcr_film_by_pixel, mcr_film_take): a pixel's bits
 * depend on how many it has, and not on what others have or when they came.
 */
#ifndef MCR_FILM_FILM_H
#define MCR_FILM_FILM_H

#include <stdint.h>

#include "core/core.h"

#define MCR_FILM_RADIX 16u
#define MCR_FILM_LEVELS 9u /* 16 * 16^8 samples: more than 2^32 */

/* One node that is being added up, for all pixels: how many children it has, and the sums so far. */
struct mcr_film_level {
    uint32_t children;
    uint64_t samples;
    double *sum[3], *moment; /* pixels each; NULL until first used */
    double *channel[3];      /* the channels' moments; NULL unless kept, and the samples are independent */
};

struct mcr_film {
    uint32_t width, height; /* of the crop */
    uint64_t pixels;
    int correlated;         /* units are replicates */
    int channels;           /* the variance of R, G and B is kept, too */
    uint32_t replicates;
    uint64_t samples;       /* a pixel, so far; the least that any has */
    uint32_t units;         /* finished samples or replicates; the least that any pixel has */
    /* by pixel: */
    uint32_t *cells;        /* so far; NULL: all pixels have the same samples */
    uint32_t replicate_cells, cell_samples; /* cells of a replicate, samples of a cell */
    double *part_mean, *part_moment; /* over estimates of the units' variance from parts: cells, or pairs of replicates */
    double *part_open;               /* correlated: the mean of a replicate that waits for its pair */
    struct mcr_film_level level[MCR_FILM_LEVELS];
    /* correlated: */
    uint64_t replicate_samples;
    uint64_t unit_samples;  /* samples of the finished replicates */
    double *replicate_sum;  /* luminance of the running replicate */
    double *unit_mean, *unit_moment; /* over the finished replicates: mean, and sum of samples * (mean - overall mean)^2 */
    double *replicate_channel[3], *unit_channel_mean[3], *unit_channel_moment[3]; /* the same for R, G, B; NULL unless kept */
};

/* NULL when memory is short. */
struct mcr_film *mcr_film_create(uint32_t width, uint32_t height, int correlated);
void mcr_film_destroy(struct mcr_film *film);
/* Bytes that such a film takes for `replicates` replicates of `planned` samples at most, with the channels' variance or without. */
uint64_t mcr_film_bytes(uint64_t pixels, int correlated, int channels, uint32_t planned, uint32_t replicates);
/* What mcr_film_by_pixel takes besides. */
uint64_t mcr_film_pixel_bytes(uint64_t pixels, int correlated);
/* Asks for mcr_film_channel_variance; before the first cell. Returns 0, or -1 when memory is short. */
int mcr_film_keep_channels(struct mcr_film *film);
/* The film as a taker of cells, asking for what it keeps. */
struct mcr_cell_sink mcr_film_sink(struct mcr_film *film);

/*
 * Adds the next cell of every pixel: cell[pixel], each of `count` samples. Returns 0, or -1 when memory is short (nothing was added then).
 * Cells come in the order of the samples.
 */
int mcr_film_add(struct mcr_film *film, const struct mcr_cell *cell, uint32_t count);
/* The same with the channels' moments, which a film of independent samples that keeps channels needs. */
int mcr_film_add_channels(struct mcr_film *film, const struct mcr_cell *cell, const struct mcr_cell_channels *channels, uint32_t count);
/* The replicate is complete: its mean becomes a unit. Only for correlated films. */
void mcr_film_end_replicate(struct mcr_film *film);

/*
 * Instead of mcr_film_add, before the first cell: every pixel has its own number of replicates, each of so many cells of so many samples. Returns 0,
 * or -1 when memory is short.
 */
int mcr_film_by_pixel(struct mcr_film *film, uint32_t cells, uint32_t cell_samples);
/* Adds what a director's task brought. Returns 0, or -1 when memory is short: the film is of no use then. */
int mcr_film_take(struct mcr_film *film, const struct mcr_task *task, const struct mcr_cell *cell, const struct mcr_cell_channels *channels);
/* Samples that a pixel has. */
uint64_t mcr_film_samples(const struct mcr_film *film, uint64_t pixel);

/* The mean radiance of every pixel: rgb[3 * pixel]. Black where there is no sample. */
void mcr_film_mean(const struct mcr_film *film, double *rgb);
/* The variance of every pixel's mean luminance. Returns 0, or -1 if it is unknown (fewer than 2 units): out is untouched then. */
int mcr_film_variance(const struct mcr_film *film, double *out);
/* The variance of every pixel's mean in each channel: rgb[3 * pixel]. Returns 0, or -1 if it is unknown, or was not asked for: rgb is untouched then. */
int mcr_film_channel_variance(const struct mcr_film *film, double *rgb);

#define MCR_FILM_BOUND 1.6448536269514722 /* standard errors that 95 % of normal errors stay below */

/* Figures over the whole picture. */
struct mcr_film_figures {
    double mean[3], luminance;         /* mean over pixels */
    int known;                         /* whether the rest is */
    double mean_variance;              /* of a pixel's luminance, mean over pixels: the expected MSE of luminance */
    double standard_error;             /* of the mean luminance */
    double relative_error;             /* root of the mean variance over the mean luminance; 0 for a black picture */
    double sample_variance;            /* luminance variance of one sample, mean over pixels; for replicates: of the mean of one, times its samples */
    double mean_variance_error;        /* of a film by pixel: standard error of mean_variance; else 0 */
    double relative_bound;             /* what the relative error is below with 95 % confidence: from mean_variance + 1.645 of its standard errors */
};
/* Returns 0, or -1 when memory is short. */
int mcr_film_figures(const struct mcr_film *film, struct mcr_film_figures *figures);

#endif
