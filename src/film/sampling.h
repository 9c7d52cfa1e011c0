/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Where samples go and when it is enough: `time`, `target_error`, `adaptive`, and sample maps. The director of a film by pixel.
 *
 * Rounds.   A pixel's samples come in rounds of equal size: replicates of their own for correlated numbers, the next samples for independent ones. A
 *   pixel's round j is the same whenever it is rendered, so that the number of rounds of each pixel, the sample map, tells the picture: run again with
 *   the map, the bits are the same. With the same number everywhere they are those of a render with so many spp (and as many replicates as rounds).
 * Error.    The figure of the report: the root of the mean over pixels of the variance of the pixel's mean luminance, over the picture's mean luminance.
 *   `target_error` is reached where its upper 95 % bound is not above the target (film.h: relative_bound), judged after whole steps, the first time
 *   from MCR_SAMPLING_LOOK samples a pixel on. Steps are at least 1/16 of what there is, so that the looks are few.
 * Adaptive. Samples in proportion to the standard deviation of a pixel's sample make that error least. The deviations are estimated from *scouts*:
 *   samples with numbers of their own which are never part of the picture (a sixteenth of the work). So what a pixel gets does not depend on what it
 *   shows, and neither its mean nor its variance is biased. The estimates are filtered (allocate.h); no pixel has less than the floor, nor less than a
 *   sixteenth of the mean. Decisions come from whole steps, in the order of pixels: threads and batches cannot matter.
 * Bias.     None by `adaptive`, nor by a map made with another seed. The moment at which `target_error` stops follows from the picture's own samples, but
 *   from all pixels together: what that does to one pixel falls with their number, and was found below the noise (tests/film/sampling.c). Replaying the
 *   map with another seed is free of it. `time` stops by the clock.
 * Time.     The first round always completes. Steps are chosen to end in time; a step that takes longer than foreseen is cut off.
 */
#ifndef MCR_FILM_SAMPLING_H
#define MCR_FILM_SAMPLING_H

#include "film/features.h"
#include "film/film.h"

#define MCR_SAMPLING_LOOK 64u /* samples a pixel before the error is first compared with the target */

/* Why it ended. */
enum mcr_stopped {
    MCR_STOPPED_NOT, /* interrupted, or failed */
    MCR_STOPPED_SPP,
    MCR_STOPPED_TIME,
    MCR_STOPPED_TARGET,
    MCR_STOPPED_MAP,
    MCR_STOPPED_MOST /* a pixel's samples cannot be counted further */
};

struct mcr_sampling_rules {
    double time;         /* seconds; 0: none */
    double target;       /* relative error; 0: none */
    uint32_t limit;      /* samples a pixel in the mean over the picture, scouts included; 0: none. There is at least one rule, or a map */
    uint32_t round;      /* samples of a round: up to MCR_CELL_SAMPLES, or a multiple of it; not above the limit */
    uint32_t least;      /* rounds of every pixel at least, as far as the limit goes */
    uint32_t floor;      /* adaptive: samples of every pixel at least */
    int adaptive;
    int by_replicate;    /* tasks are of one replicate each: for number sources that arrange the samples of neighbouring pixels */
    const uint32_t *map; /* rounds of every pixel, > 0; NULL: none. With it nothing else matters. Borrowed */
};

struct mcr_sampling;

/*
 * For a film that is empty; makes it a film by pixel. features: layers of the same pixels, created by_pixel, or NULL. NULL when memory is short. Film
 * and features are borrowed.
 */
struct mcr_sampling *mcr_sampling_create(struct mcr_film *film, struct mcr_features *features, const struct mcr_sampling_rules *rules);
void mcr_sampling_destroy(struct mcr_sampling *sampling);
struct mcr_director mcr_sampling_director(struct mcr_sampling *sampling);

struct mcr_sampling_result {
    enum mcr_stopped stopped;
    uint64_t least, most;    /* samples of a pixel in the picture */
    double mean;
    double scouts;           /* samples a pixel that only told where noise is, in the mean */
    uint32_t steps;
    int distributed;         /* adaptive: there was something left to distribute */
};
void mcr_sampling_result(const struct mcr_sampling *sampling, struct mcr_sampling_result *result);

/* Rounds of one pixel at most: a map's values, samples as 32-bit floats, must be exact, and samples below 2^31. */
uint32_t mcr_sampling_most(uint32_t round);

#endif
