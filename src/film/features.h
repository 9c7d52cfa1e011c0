/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Feature layers of a picture: per-pixel sums of what core/features.h tells of the samples. Cells are added in the order of the samples, so that no bit
 * depends on threads, batches or passes.
 */
#ifndef MCR_FILM_FEATURES_H
#define MCR_FILM_FEATURES_H

#include "core/cell.h"
#include "core/core.h"

struct mcr_features {
    uint64_t pixels, samples;   /* samples: of each pixel, so far; with `taken`, of none */
    double *taken;              /* samples by pixel, where mcr_features_take adds them; else NULL */
    uint32_t asked;             /* MCR_FEATURE_* */
    /* pixels each; NULL where not asked for */
    double *albedo, *normal, *direct, *indirect; /* 3 * pixels */
    double *depth, *hits, *distance;
    uint32_t *id;
};

#define MCR_FEATURE_INDIRECT 32u /* a layer; asked for with MCR_FEATURE_DIRECT */

/* Bytes a pixel; by_pixel as below. */
uint32_t mcr_features_bytes(uint32_t asked, int by_pixel);

/* by_pixel: samples come by mcr_features_take, a number of their own for each pixel, not by mcr_features_add. NULL when memory is short. */
struct mcr_features *mcr_features_create(uint64_t pixels, uint32_t asked, int by_pixel);
void mcr_features_destroy(struct mcr_features *features); /* NULL is allowed */

/* For mcr_cell_sink: add_features, whose data is the struct mcr_features. */
int mcr_features_add(void *features, const struct mcr_cell_features *cell, uint32_t count);

/* The results of a director's task: cell b of entry e in cell[b * count + e]. */
void mcr_features_take(struct mcr_features *features, const struct mcr_task *task, const struct mcr_cell_features *cell);

/*
 * One layer of pixel p: 3 numbers for albedo, normal, direct and indirect, else 1. Albedo, direct and indirect are means over the samples; the normal
 * is, too: shorter than 1 where a pixel sees several. Depth is the mean over the samples that hit something, 0 where none did. The id is that of the sample nearest to the
 * pixel's centre, of the earliest where several are: a mean of numbers of materials would be a number of another one.
 */
void mcr_features_value(const struct mcr_features *features, uint32_t layer, uint64_t p, double *out);

#endif
