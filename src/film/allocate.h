/* SPDX-License-Identifier: Apache-2.0 */
/* Which pixels get more samples: the noise of each from what scouts saw, and the numbers that make the picture's mean square error least. */
#ifndef MCR_FILM_ALLOCATE_H
#define MCR_FILM_ALLOCATE_H

#include <stdint.h>

/*
 * The standard deviation of one sample for every pixel, from estimates of its variance: a weighted mean of the pixel's own estimate and the mean over the
 * pixels within MCR_NOISE_REACH in x and y, itself included, as if that were worth MCR_NOISE_PRIOR cells of scouts. So a pixel whose few scouts met nothing
 * is not starved where its neighbours are noisy, and one that is noisy alone is still seen. cells: scouts of each pixel, in units of MCR_CELL_SAMPLES.
 * What is not finite counts as the largest finite estimate. scratch: one value a pixel. No two arrays may overlap.
 */
#define MCR_NOISE_REACH 3u
#define MCR_NOISE_PRIOR 2.0
void mcr_noise(uint32_t width, uint32_t height, double *variance, const double *cells, double *noise, double *scratch);

/*
 * How many rounds each pixel is to have: want >= have, `least` (which is passed over where it takes more than `total`, and is not above `most`) and not above
 * `most`; `total` together (a whole number), less what pixels at `most` cannot take; and in proportion to `noise` where nothing bounds it. That makes the sum of noise^2 / want least (Neyman 1934, optimal allocation). Fractions are
 * carried to the next pixel. With no noise anywhere all pixels are alike. Returns the sum of want - have.
 */
uint64_t mcr_allocate(uint64_t pixels, const double *noise, const uint32_t *have, uint32_t least, uint32_t most, double total, uint32_t *want);

#endif
