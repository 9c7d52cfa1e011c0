/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Do two noisy images estimate the same thing? Asked of images that carry their own variance: channels variance.R, variance.G, variance.B and
 * variance.Y (of luminance), or variance.Y alone for grey ones; each the estimated variance of that pixel's mean. Always on linear values.
 *
 * With e = a - r and v = va + vr + the variance that rounding to 32-bit floats may add, of a pixel that takes part:
 *   pixel   |e| / sqrt(v) beyond Student's t at the confidence. v is an estimate, maybe from few samples or replicates: its degrees of freedom are what
 *           the files say (image->units - 1), or where they do not, come from the scatter of va / (va + vr) among neighbours. With normal noise the share
 *           beyond is 1 - confidence by chance; with rare bright samples it is lower. Pixels without any noise: those that agree are not counted, those
 *           that do not differ for certain.
 *   mean    sum e against the root of sum v: a constant or a large difference.
 *   excess  sum (e^2 - v), which is 0 on average if and only if all expectations are equal, against its scatter over blocks of pixels: any difference,
 *           also one that is different from pixel to pixel.
 *   local   the greatest mean of a tile of 8 x 8 pixels in its standard errors, corrected for the number of tiles: a difference in one place.
 * For mean and local the noise is the greatest of what v, e^2 and (local) the tiles around tell, and of what each image's variance tells of the other's by the
 * typical ratio of the two: an image of few samples does not know of light that it has not met. This errs on the side of "the same", the more so where
 * the two were rendered by samplers with noise in different places.
 * The verdict takes all tests of all series together (Bonferroni): images that estimate the same are called different in at most 1 - confidence of
 * cases. It assumes independent noise: images of one seed differ too little, which is told.
 */
#ifndef MCR_METRICS_BIAS_H
#define MCR_METRICS_BIAS_H

#include "metrics/metrics.h"

#define MCR_BIAS_SERIES (MCR_METRICS_CHANNELS + 1) /* the channels and luminance */
#define MCR_BIAS_TILE 8u

struct mcr_bias_series {
    const char *name;                     /* "R", "luminance", … */
    double degrees;                       /* of freedom of v, for the pixels; infinite where nothing tells */
    uint64_t tested, differing;           /* pixels with noise, and pixels without noise that differ; those beyond the confidence */
    uint64_t silent_same, silent_differing; /* pixels without noise: equal; not equal (among the differing, too) */
    double difference, low, high;         /* mean of e, with its interval at the confidence */
    double mean_p;
    double excess, excess_p;              /* sum e^2 / sum v; NaN where there are too few pixels, or no noise */
    double local, local_p;                /* the greatest tile: in standard errors, with its sign */
    uint32_t tile[4];                     /* that tile, as a crop of the images */
};

struct mcr_bias {
    double confidence, expected_share;    /* of pixels that differ by chance: 1 - confidence */
    uint32_t series_count, tests;
    struct mcr_bias_series series[MCR_BIAS_SERIES];
    double p;                             /* of the verdict, corrected for the tests */
    int different;                        /* p < 1 - confidence */
    int dependent;                        /* the images differ less than independent ones would */
};

/* 1 if an image has a variance channel for each of its colour channels. */
int mcr_bias_known(const struct mcr_image *image);

/* Both images must have their variances, and mcr_metrics_compare must have accepted them. Returns 0, or -1 with the reason. */
int mcr_bias_test(const struct mcr_image *image, const struct mcr_image *reference, const struct mcr_metrics_options *options, double confidence,
                  struct mcr_bias *bias, char *error, size_t length);

#endif
