/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Structural similarity: Z. Wang, A. C. Bovik, H. R. Sheikh and E. P. Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
 * Similarity", IEEE Trans. Image Processing 13 (2004), with its Gaussian window of 11 x 11 and standard deviation 1.5, K1 = 0.01 and K2 = 0.03, no
 * padding (only windows that lie within the region), no downsampling before; the mean over the windows. Weighted moments, without Bessel's correction.
 *
 * Multi-scale: Z. Wang, E. P. Simoncelli and A. C. Bovik, "Multi-Scale Structural Similarity for Image Quality Assessment", Asilomar 2003: the product
 * of the means of contrast * structure at scales 1 to 4 and of ssim at scale 5, to the powers .0448 .2856 .3001 .2363 .1333. A scale is the one before,
 * averaged over 2 x 2 and every second pixel of it taken; a last odd row or column is averaged with itself. A negative mean counts as 0, which makes
 * the product 0, as in other implementations (tf.image.ssim_multiscale, pytorch-msssim).
 *
 * With a mask ssim is the mean over the windows whose centre takes part (what they see may not); a window with a value that was left out as not finite is
 * left out too. ms_ssim is undefined then.
 */
#ifndef MCR_METRICS_SSIM_H
#define MCR_METRICS_SSIM_H

#include "metrics/pair.h"

#define MCR_SSIM_TAPS 11u
#define MCR_SSIM_SCALES 5u
#define MCR_MS_SSIM_SIDE (MCR_SSIM_TAPS << (MCR_SSIM_SCALES - 1)) /* the least side for five scales: 176 */

/* One series. Either metric is computed if its pointer is not NULL, and becomes NaN with a note where it is undefined. Returns 0, or -1 when memory is short. */
int mcr_ssim_measure(const struct mcr_pair *pair, uint32_t series, double *ssim, double *ms_ssim, const char **ssim_note, const char **ms_ssim_note);

#endif
