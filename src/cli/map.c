/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/map.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "image/format.h"

/* One value of a map in rounds; 0 after a message. */
static uint32_t rounds_of(const char *path, double samples, uint32_t x, uint32_t y, uint32_t round, char *error, size_t length)
{
    const double most = (double)mcr_sampling_most(round) * round;
    if (!(samples >= 1 && samples <= most && samples == floor(samples)))
        snprintf(error, length, "'%s': pixel %u,%u: %g is no number of samples, expected a whole number from 1 to %.0f", path, x, y, samples, most);
    else if (samples / round != floor(samples / round))
        snprintf(error, length, "'%s': pixel %u,%u: %.0f samples are not whole rounds of %u (--round)", path, x, y, samples, round);
    else
        return (uint32_t)(samples / round);
    return 0;
}

uint32_t *mcr_map_read(const char *path, uint32_t width, uint32_t height, uint32_t round, char *error, size_t length)
{
    struct mcr_image *image = mcr_image_read(path, error, length);
    uint32_t *rounds = NULL;
    int good = image != NULL;
    if (image && (image->width != width || image->height != height || image->channels != 1)) {
        snprintf(error, length, "'%s' has %ux%u pixels of %u channels, expected %ux%u of one", path, image->width, image->height, image->channels, width, height);
        good = 0;
    }
    if (good && !(rounds = calloc((size_t)width * height, sizeof *rounds))) {
        snprintf(error, length, "out of memory");
        good = 0;
    }
    for (uint64_t p = 0; good && p < (uint64_t)width * height; p++)
        good = (rounds[p] = rounds_of(path, image->data[p], (uint32_t)(p % width), (uint32_t)(p / width), round, error,
                                                    length)) > 0;
    mcr_image_destroy(image);
    if (good)
        return rounds;
    free(rounds);
    return NULL;
}

int mcr_map_check_path(const char *path, char *error, size_t length)
{
    const struct mcr_format *format = mcr_format_of_path(path, error, length);
    if (!format)
        return -1;
    if (mcr_format_encoding(format, 0) == MCR_ENCODE_FLOAT)
        return 0;
    snprintf(error, length, "'%s' cannot hold numbers of samples, .pfm and .exr can", path);
    return -1;
}

struct mcr_image *mcr_map_of_film(const struct mcr_film *film)
{
    static const char *const name[] = {"Y"};
    struct mcr_image *image = mcr_image_create(film->width, film->height, 1, name);
    for (uint64_t p = 0; image && p < film->pixels; p++)
        image->data[p] = (double)mcr_film_samples(film, p);
    return image;
}
