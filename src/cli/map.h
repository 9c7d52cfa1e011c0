/* SPDX-License-Identifier: Apache-2.0 */
/* Sample maps: images of one channel that say how many samples each pixel has (sampling.h). */
#ifndef MCR_CLI_MAP_H
#define MCR_CLI_MAP_H

#include "film/sampling.h"
#include "image/image.h"

/*
 * Reads a map for a picture of this size, whose values must be whole rounds: the rounds of every pixel, the caller's to free. NULL after a failure, the
 * reason in `error`.
 */
uint32_t *mcr_map_read(const char *path, uint32_t width, uint32_t height, uint32_t round, char *error, size_t length);

/* Whether a file of this name can hold a map: numbers as they are. Returns 0, or -1 with the reason in `error`. */
int mcr_map_check_path(const char *path, char *error, size_t length);

/* The map of a film. NULL when memory is short. */
struct mcr_image *mcr_map_of_film(const struct mcr_film *film);

#endif
