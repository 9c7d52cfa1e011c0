/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Feature layers: what a path saw first, and the part of its light that was scattered once at most. Nothing of it exists or is computed unless a render
 * asks for it (mcr_render_options.features).
 *
 * First hit: the surface that the camera ray stays at, behind all that let it pass. Values are per sample, in the slots' order, and are added up by
 * cells with the samples. Samples count the same for all layers but direct and indirect light, also where the film's filter gives weights: with negative ones an albedo
 * could leave [0, 1].
 */
#ifndef MCR_CORE_FEATURES_H
#define MCR_CORE_FEATURES_H

#include <stddef.h>
#include <stdint.h>

/* What is asked for. */
enum {
    MCR_FEATURE_ALBEDO = 1, /* share of the light that the surface scatters, by the material's `albedo`, else estimated by draws */
    MCR_FEATURE_NORMAL = 2, /* shading normal in the world's axes, on the camera's side */
    MCR_FEATURE_DEPTH = 4,  /* length of the camera ray, in scene units */
    MCR_FEATURE_ID = 8,     /* the material's number in the scene, from 1; 0: nothing was hit */
    MCR_FEATURE_DIRECT = 16 /* emission seen directly or after one scattering event; and the rest, which is indirect */
};

/* Sums over the samples of a cell. */
struct mcr_cell_features {
    double albedo[3], normal[3], direct[3], indirect[3];
    double depth, hits;      /* over samples that hit something, and their number */
    double distance;         /* least distance of a sample from the pixel's centre, squared, in pixels */
    uint32_t id;             /* of that sample */
};

struct mcr_batch;

/* By slot; NULL what is not asked for. */
struct mcr_feature_slots {
    double *albedo[3], *normal[3], *direct[3], *indirect[3], *depth, *distance;
    uint32_t *id;            /* always there */
    uint8_t *taken;          /* `direct` was told; later light was scattered more often */
    /* for the estimate of albedos, by lane */
    double *number[3], *delta, *x, *y, *z, *density, *probability, *r, *g, *b, *sum[3];
};

/* Cuts the arrays; `cut` as in batch.c. */
void mcr_features_cut(struct mcr_batch *batch, void *(*cut)(void *cutter, size_t count, size_t size), void *cutter);
/* Slots first .. first+n-1 begin new samples. */
void mcr_features_begin(struct mcr_batch *batch, size_t first, uint32_t n);
/* After the surface stage: of the points that are first hits. Returns 0, or a plugin's failure. */
int32_t mcr_features_hit(struct mcr_batch *batch);
/* After emission: of the points behind one scattering event. */
void mcr_features_direct(struct mcr_batch *batch);
/* The samples have ended; before the filter's weights are applied. */
void mcr_features_settle(struct mcr_batch *batch, size_t first, uint32_t n);
/* Adds up one cell. */
void mcr_features_cell(const struct mcr_batch *batch, size_t slot, uint32_t count, struct mcr_cell_features *cell);

#endif
