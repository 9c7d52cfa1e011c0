/* SPDX-License-Identifier: Apache-2.0 */
#include "metrics/metrics.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/elementary.h"
#include "base/memory.h"
#include "metrics/pair.h"
#include "metrics/pointwise.h"
#include "metrics/ssim.h"

const char *const mcr_metric_name[MCR_METRIC_COUNT] = {
    "mse", "rmse", "mae", "relmse", "smape", "psnr", "snr", "snr_variance", "ssim", "ms_ssim", "mean_ratio",
};

int mcr_metric_sense(enum mcr_metric metric)
{
    static const signed char sense[MCR_METRIC_COUNT] = {
        [MCR_METRIC_MSE] = -1, [MCR_METRIC_RMSE] = -1, [MCR_METRIC_MAE] = -1, [MCR_METRIC_RELMSE] = -1, [MCR_METRIC_SMAPE] = -1,
        [MCR_METRIC_PSNR] = 1, [MCR_METRIC_SNR] = 1, [MCR_METRIC_SNR_VARIANCE] = 1, [MCR_METRIC_SSIM] = 1, [MCR_METRIC_MS_SSIM] = 1,
    };
    return sense[metric];
}

#define STRUCTURAL (1u << MCR_METRIC_SSIM | 1u << MCR_METRIC_MS_SSIM)

/* One series into its metrics, its sums also into `all` where that is not NULL. Returns 0, or -1 when memory is short. */
static int measure(const struct mcr_pair *pair, uint32_t series, uint32_t wanted, double *row, struct mcr_metrics *metrics, struct mcr_pointwise *all)
{
    struct mcr_pointwise sums;
    double *ssim = wanted & 1u << MCR_METRIC_SSIM ? &metrics->value[MCR_METRIC_SSIM] : NULL;
    double *ms_ssim = wanted & 1u << MCR_METRIC_MS_SSIM ? &metrics->value[MCR_METRIC_MS_SSIM] : NULL;
    if (wanted & ~STRUCTURAL) {
        mcr_pointwise_measure(pair, series, row, &sums);
        mcr_pointwise_finish(&sums, pair->peak, metrics);
        if (all)
            mcr_pointwise_join(all, &sums);
    }
    if (!ssim && !ms_ssim)
        return 0;
    return mcr_ssim_measure(pair, series, ssim, ms_ssim, &metrics->note[MCR_METRIC_SSIM], &metrics->note[MCR_METRIC_MS_SSIM]);
}

/* The mean of the channels' values. Where it is undefined, it is so for all of them. */
static void mean_of_channels(struct mcr_comparison *comparison, enum mcr_metric metric)
{
    double sum = 0;
    for (uint32_t c = 0; c < comparison->channels; c++) {
        sum += comparison->channel[c].value[metric];
        if (comparison->channel[c].note[metric])
            comparison->whole.note[metric] = comparison->channel[c].note[metric];
    }
    comparison->whole.value[metric] = sum / comparison->channels;
}

/* What was not asked for becomes NaN, and every value that is not finite has a note. */
static void tidy(struct mcr_metrics *metrics, uint32_t wanted)
{
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++) {
        if (!(wanted & 1u << m)) {
            metrics->value[m] = MCR_NAN;
            metrics->note[m] = "not asked for";
        } else if (isfinite(metrics->value[m])) {
            metrics->note[m] = NULL;
        } else if (!metrics->note[m]) {
            metrics->value[m] = MCR_NAN;
            metrics->note[m] = "undefined: the values are too large";
        }
    }
}

static int measure_all(const struct mcr_pair *pair, uint32_t wanted, struct mcr_comparison *comparison)
{
    struct mcr_pointwise all = {0};
    double *row = mcr_array_alloc(2 * (size_t)pair->width, sizeof *row);
    int status = row ? 0 : -1;
    for (uint32_t c = 0; c < pair->channels && !status; c++)
        status = measure(pair, c, wanted, row, &comparison->channel[c], &all);
    if (!status && pair->channels > 1)
        status = measure(pair, MCR_PAIR_LUMINANCE, wanted, row, &comparison->luminance, NULL);
    else
        comparison->luminance = comparison->channel[0];
    free(row);
    if (status) {
        snprintf(comparison->error, sizeof comparison->error, "out of memory");
        return -1;
    }
    if (wanted & ~STRUCTURAL)
        mcr_pointwise_finish(&all, pair->peak, &comparison->whole);
    mean_of_channels(comparison, MCR_METRIC_SSIM);
    mean_of_channels(comparison, MCR_METRIC_MS_SSIM);
    tidy(&comparison->whole, wanted);
    tidy(&comparison->luminance, wanted);
    for (uint32_t c = 0; c < pair->channels; c++)
        tidy(&comparison->channel[c], wanted);
    return 0;
}

int mcr_metrics_compare(const struct mcr_image *image, const struct mcr_image *reference, const struct mcr_metrics_options *options,
                        uint32_t wanted, struct mcr_comparison *comparison)
{
    struct mcr_pair pair;
    memset(comparison, 0, sizeof *comparison);
    int status = mcr_pair_init(&pair, image, reference, options, comparison->error, sizeof comparison->error);
    comparison->channels = pair.channels;
    memcpy(comparison->channel_name, pair.name, sizeof pair.name);
    memcpy(comparison->range, pair.range, sizeof pair.range);
    memcpy(comparison->not_finite, pair.not_finite, sizeof pair.not_finite);
    comparison->peak = pair.peak;
    comparison->pixels = pair.pixels;
    comparison->region[0] = pair.x0, comparison->region[1] = pair.y0;
    comparison->region[2] = pair.x0 + pair.width, comparison->region[3] = pair.y0 + pair.height;
    if (!status)
        status = measure_all(&pair, wanted, comparison);
    mcr_pair_fini(&pair);
    return status;
}
