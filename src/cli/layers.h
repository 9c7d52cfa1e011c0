/* SPDX-License-Identifier: Apache-2.0 */
/* --layers: what EXR holds beside R, G and B. */
#ifndef MCR_CLI_LAYERS_H
#define MCR_CLI_LAYERS_H

#include "film/features.h"
#include "film/film.h"
#include "image/image.h"

/* In the order of the channels in a file. */
enum { MCR_LAYER_VARIANCE = 1, MCR_LAYER_ALBEDO = 2, MCR_LAYER_NORMAL = 4, MCR_LAYER_DEPTH = 8, MCR_LAYER_ID = 16, MCR_LAYER_DIRECT = 32, MCR_LAYER_INDIRECT = 64 };

/* "albedo,normal". Returns 0, or an exit status after a message. */
int mcr_layers_parse(const char *text, uint32_t *layers);
/* The MCR_FEATURE_* that the layers need. */
uint32_t mcr_layers_features(uint32_t layers);
/*
 * The picture with its layers; the variance is left out where it is not known. features: may be NULL if no layer needs it. NULL when memory is short.
 */
struct mcr_image *mcr_layers_image(const struct mcr_film *film, const struct mcr_features *features, uint32_t layers);

#endif
