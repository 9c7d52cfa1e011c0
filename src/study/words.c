/* SPDX-License-Identifier: Apache-2.0 */
#include "study/words.h"

const char *const mcr_mark_word[MCR_MARK_COUNT] = {"incomplete", "flattens", "biased", "compat", "reference", "not-finite"};

const char *const mcr_mark_sentence[MCR_MARK_COUNT] = {
    "its sampler does not cover all light paths: it does not estimate the whole image",
    "its error falls more slowly than 1/spp: a bias shows",
    "the mean over its seeds differs from the reference by more than both their noise explains",
    "it renders with a compat setting, which is known to be biased",
    "the reference\u2019s own noise is more than 5 % of its error, so that the error is less certain than its interval says",
    "some of its samples were not finite and were rejected",
};

const char *mcr_verdict_word(uint32_t verdict)
{
    static const char *const word[] = {"better", "worse", "unknown", "excluded"};
    return verdict <= MCR_VERDICT_EXCLUDED ? word[verdict] : "unknown";
}

const char *mcr_target_word(uint32_t target)
{
    static const char *const word[] = {"measured", "extrapolated", "unreachable", "unknown"};
    return target <= MCR_TARGET_UNKNOWN ? word[target] : "unknown";
}

const char *mcr_precision_word(uint32_t precision)
{
    return precision == MCR_PRECISION_DOUBLE ? "double" : "single";
}

const char *mcr_accel_word(uint32_t accel)
{
    return accel == MCR_ACCEL_AUTO ? "auto" : accel == MCR_ACCEL_LIST ? "list" : accel == MCR_ACCEL_BVH ? "bvh" : "embree";
}

const char *mcr_encoding_word(uint32_t encoding)
{
    return encoding == MCR_ENCODING_SRGB8 ? "srgb8" : "linear";
}

const char *mcr_metric_title(uint32_t metric)
{
    static const char *const title[MCR_METRIC_COUNT] = {
        [MCR_METRIC_MSE] = "MSE", [MCR_METRIC_RMSE] = "RMSE", [MCR_METRIC_MAE] = "MAE", [MCR_METRIC_RELMSE] = "relMSE",
            [MCR_METRIC_SMAPE] = "SMAPE",
        [MCR_METRIC_PSNR] = "PSNR (dB)", [MCR_METRIC_SNR] = "SNR (dB)", [MCR_METRIC_SNR_VARIANCE] = "SNR of variances (dB)",
        [MCR_METRIC_SSIM] = "SSIM", [MCR_METRIC_MS_SSIM] = "MS-SSIM", [MCR_METRIC_MEAN_RATIO] = "mean ratio",
    };
    return metric < MCR_METRIC_COUNT && title[metric] ? title[metric] : "?";
}

double mcr_metrics_peak(const struct mcr_metrics_options *options)
{
    return options->peak > 0 ? options->peak : options->encoding == MCR_ENCODING_SRGB8 ? 255 : 1;
}
