/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Distances between two images of one size.
 *
 * Everything is computed on values v = encode(image): linear as they are, or the 8-bit sRGB encoding (clipped to [0, 1], codes 0 ... 255). The
 * peak L is 1 for linear values unless another is given, 255 for codes. With e = a - r over the N values of the region (r: the reference):
 *   mse sum e^2 / N, rmse, mae sum |e| / N, relmse sum e^2 / (r^2 + 0.01 L^2) / N, smape sum |e| / (|a| + |r|) / N (0 where both are 0),
 *   psnr 10 log10(L^2 / mse), snr 10 log10(sum r^2 / sum e^2), snr_variance 10 log10(variance of r / variance of e), mean_ratio sum a / sum r,
 *   ssim (Wang, Bovik, Sheikh and Simoncelli 2004), ms_ssim (Wang, Simoncelli and Bovik 2003): see ssim.h.
 * The whole takes the values of all colour channels together; its snr_variance adds the channels' variances, each around its own mean, its ssim and
 * ms_ssim are the means of the channels'. Luminance is that of the linear values, encoded like a grey image.
 * A distance of 0 makes the ratios in decibels infinite. Sums are compensated: their error does not grow with the number of pixels.
 */
#ifndef MCR_METRICS_METRICS_H
#define MCR_METRICS_METRICS_H

#include "image/image.h"

enum mcr_metric {
    MCR_METRIC_MSE, MCR_METRIC_RMSE, MCR_METRIC_MAE, MCR_METRIC_RELMSE, MCR_METRIC_SMAPE, MCR_METRIC_PSNR, MCR_METRIC_SNR,
    MCR_METRIC_SNR_VARIANCE, MCR_METRIC_SSIM, MCR_METRIC_MS_SSIM, MCR_METRIC_MEAN_RATIO, MCR_METRIC_COUNT
};
#define MCR_METRICS_ALL ((1u << MCR_METRIC_COUNT) - 1)
/* The words: keys in JSON, names in --fail-above and in studies. In the order of enum mcr_metric. */
extern const char *const mcr_metric_name[MCR_METRIC_COUNT];
/* -1: less is better (mse), 1: more is better (psnr), 0: one is best (mean_ratio). */
int mcr_metric_sense(enum mcr_metric metric);

enum mcr_metrics_encoding { MCR_ENCODING_LINEAR, MCR_ENCODING_SRGB8 };
#define MCR_METRICS_CHANNELS 3u

struct mcr_metrics_options {
    uint32_t encoding;            /* MCR_ENCODING_* */
    double peak;                  /* 0: 1 or 255 */
    int has_crop;
    uint32_t crop[4];             /* x0 <= x < x1, y0 <= y < y1 */
    const struct mcr_image *mask; /* of the images' size: a pixel takes part where any of its channels but alpha is not 0. NULL: all */
    int exclude_not_finite;       /* pixels with a NaN or an infinity in either image are left out; else they are a failure */
};

/* Of one channel, of luminance (Rec. 709) or of all colour channels together. */
struct mcr_metrics {
    double value[MCR_METRIC_COUNT];     /* NaN where a metric is not defined or was not asked for */
    const char *note[MCR_METRIC_COUNT]; /* why the value is not finite; NULL where it is */
};

struct mcr_comparison {
    uint32_t channels;                             /* 1 or 3 */
    const char *channel_name[MCR_METRICS_CHANNELS];
    struct mcr_metrics whole, luminance, channel[MCR_METRICS_CHANNELS];
    double peak;
    double range[2][2];                            /* of the image and the reference: least and greatest finite value, encoded */
    uint32_t region[4];                            /* as crop */
    uint64_t pixels;                               /* that took part */
    uint64_t not_finite[2];                        /* values of a and of the reference, within the region */
    char error[256];
};

/* The colour channels of two images: R, G, B (or Y alone); other layers and alpha take no part. wanted: bits 1u << enum mcr_metric; the others
 * become NaN. Returns 0, or -1 with the reason in comparison->error: another size or other channels, nothing in the region, values that are
 * not finite (counted), memory. Beside the images it holds a byte a pixel where there is a mask, some rows for ssim, and half a channel's values for
 * ms_ssim. Re-entrant. */
int mcr_metrics_compare(const struct mcr_image *image, const struct mcr_image *reference, const struct mcr_metrics_options *options,
                        uint32_t wanted, struct mcr_comparison *comparison);

#endif
