/* SPDX-License-Identifier: Apache-2.0 */
/* Images whose distances are known. */
#include "help.h"

/* Half a unit of the last digit that is known. */
static void value(const struct mcr_metrics *metrics, enum mcr_metric metric, double wanted, double tolerance)
{
    ok(close_to(metrics->value[metric], wanted, tolerance) && !metrics->note[metric], "%s is %.15g", mcr_metric_name[metric], wanted);
}

/* 16 x 16: ref = ((7 i + 13 j) mod 32) / 31, tst = ref + 0.05 (((5 i + 3 j) mod 8) / 7 - 0.5). */
static void worked_example(void)
{
    struct mcr_image *a = image_new(16, 16, 1, grey), *r = image_new(16, 16, 1, grey);
    for (int i = 0; i < 16; i++)
        for (int j = 0; j < 16; j++) {
            double v = ((7 * i + 13 * j) % 32) / 31.0;
            r->data[16 * i + j] = v;
            a->data[16 * i + j] = v + 0.05 * (((5 * i + 3 * j) % 8) / 7.0 - 0.5);
        }
    struct mcr_comparison c = compare(a, r);
    value(&c.whole, MCR_METRIC_MSE, 2.67857142857143e-4, 5e-19);
    value(&c.whole, MCR_METRIC_RMSE, 0.0163663417676994, 5e-17);
    value(&c.whole, MCR_METRIC_MAE, 0.0142857142857143, 5e-17);
    value(&c.whole, MCR_METRIC_PSNR, 35.720967679505, 5e-13);
    value(&c.whole, MCR_METRIC_SNR, 31.015906855156, 5e-13);
    value(&c.whole, MCR_METRIC_SSIM, 0.998509402356, 5e-13);
    value(&c.whole, MCR_METRIC_RELMSE, 0.00459093792346, 5e-15);
    /* By numpy: mean(abs(a - r) / (abs(a) + abs(r))), every term of which is defined here. */
    value(&c.whole, MCR_METRIC_SMAPE, 0.050803085020957, 5e-16);
    ok(c.channels == 1 && c.peak == 1 && c.pixels == 256 && c.region[2] == 16, "what was compared");
    ok(c.luminance.value[MCR_METRIC_MSE] == c.whole.value[MCR_METRIC_MSE], "of a grey image, luminance is all");
    ok(isnan(c.whole.value[MCR_METRIC_MS_SSIM]) && strstr(c.whole.note[MCR_METRIC_MS_SSIM], "176"), "ms_ssim of 16 pixels is undefined, and told");
    mcr_image_destroy(a);
    mcr_image_destroy(r);
}

/* Constants: ssim is (2 a r + C1) / (a^2 + r^2 + C1) = 0.6001 / 0.6101. */
static void constants(void)
{
    struct mcr_image *a = image_flat(16, 16, 3, rgb, 0.5), *r = image_flat(16, 16, 3, rgb, 0.6);
    struct mcr_comparison c = compare(a, r);
    value(&c.whole, MCR_METRIC_SSIM, 0.983609244386, 5e-13);
    value(&c.whole, MCR_METRIC_SSIM, 0.6001 / 0.6101, 1e-12); /* moments are rounded to some 1e-16, and variances stand beside C2 = 9e-4 */
    value(&c.channel[1], MCR_METRIC_SSIM, 0.983609244386, 5e-13);
    value(&c.luminance, MCR_METRIC_SSIM, 0.983609244386, 5e-13);
    value(&c.whole, MCR_METRIC_MSE, 0.01, 1e-17);
    value(&c.whole, MCR_METRIC_PSNR, 20, 1e-14);
    value(&c.whole, MCR_METRIC_MEAN_RATIO, 0.5 / 0.6, 1e-15);
    value(&c.whole, MCR_METRIC_SMAPE, 0.1 / 1.1, 1e-16);
    ok(isnan(c.whole.value[MCR_METRIC_SNR_VARIANCE]) && c.whole.note[MCR_METRIC_SNR_VARIANCE], "snr_variance of a reference of one value is undefined");
    mcr_image_destroy(a);
    mcr_image_destroy(r);
}

static void waves(void)
{
    struct mcr_image *a = image_new(256, 256, 1, NULL), *r = image_new(256, 256, 1, NULL);
    for (int i = 0; i < 256; i++)
        for (int j = 0; j < 256; j++) {
            double v = 0.5 + 0.25 * mcr_sin(2 * MCR_PI * i / 37) + 0.25 * mcr_cos(2 * MCR_PI * j / 53);
            r->data[256 * i + j] = v;
            a->data[256 * i + j] = mcr_clamp(v + 0.1 * mcr_sin(2 * MCR_PI * (3 * i + 5 * j) / 11), 0, 1);
        }
    struct mcr_comparison c = compare(a, r);
    value(&c.whole, MCR_METRIC_SSIM, 0.548418532648, 5e-13);
    /* By the few lines of numpy in tests/metrics/similarity.py. */
    value(&c.whole, MCR_METRIC_MS_SSIM, 0.972278617415054, 5e-14);
    mcr_image_destroy(a);
    mcr_image_destroy(r);
}

/* Not near 0 and 1: at them. */
static void identical(void)
{
    struct mcr_image *a = image_new(181, 177, 3, rgb);
    int exact = 1;
    for (size_t i = 0; i < 181 * 177 * 3; i++) a->data[i] = 3 * uniform() * uniform() - 0.5;
    struct mcr_comparison c = compare(a, a);
    const struct mcr_metrics *all[] = {&c.whole, &c.luminance, &c.channel[0], &c.channel[1], &c.channel[2]};
    for (int k = 0; k < 5; k++) {
        const double *v = all[k]->value;
        exact &= v[MCR_METRIC_MSE] == 0 && v[MCR_METRIC_RMSE] == 0 && v[MCR_METRIC_MAE] == 0 && v[MCR_METRIC_RELMSE] == 0 && v[MCR_METRIC_SMAPE] == 0;
        exact &= v[MCR_METRIC_SSIM] == 1 && v[MCR_METRIC_MS_SSIM] == 1 && v[MCR_METRIC_MEAN_RATIO] == 1;
        exact &= isinf(v[MCR_METRIC_PSNR]) && isinf(v[MCR_METRIC_SNR]) && isinf(v[MCR_METRIC_SNR_VARIANCE]) && v[MCR_METRIC_PSNR] > 0;
        exact &= all[k]->note[MCR_METRIC_PSNR] && !all[k]->note[MCR_METRIC_SSIM];
    }
    ok(exact, "identical images: exactly 0 and 1, infinite decibels, with a note");
    for (size_t i = 0; i < 181 * 177 * 3; i++) a->data[i] = 0;
    c = compare(a, a);
    ok(c.whole.value[MCR_METRIC_SMAPE] == 0 && c.whole.value[MCR_METRIC_SSIM] == 1 && isnan(c.whole.value[MCR_METRIC_SNR]) &&
           isnan(c.whole.value[MCR_METRIC_MEAN_RATIO]) && c.whole.note[MCR_METRIC_SNR] && c.whole.note[MCR_METRIC_MEAN_RATIO],
       "black images: no error, and ratios to black are undefined");
    mcr_image_destroy(a);
}

/* e = 0.1 everywhere has a spread of rounding only. */
static void constant_difference(void)
{
    struct mcr_image *a = image_new(50, 41, 1, grey), *r = image_new(50, 41, 1, grey);
    for (size_t i = 0; i < 50 * 41; i++) {
        r->data[i] = (double)(i % 64) / 64;
        a->data[i] = r->data[i] + 0.125;
    }
    struct mcr_comparison c = compare(a, r);
    ok(isinf(c.whole.value[MCR_METRIC_SNR_VARIANCE]) && strstr(c.whole.note[MCR_METRIC_SNR_VARIANCE], "constant"), "a constant difference: infinite snr_variance");
    value(&c.whole, MCR_METRIC_PSNR, 18.061799739838872, 4e-14); /* 60 log10 2 */
    mcr_image_destroy(a);
    mcr_image_destroy(r);
}

/* Peak and encoding scale what they should. */
static void scales(void)
{
    struct mcr_image *a = image_new(30, 20, 3, rgb), *r = image_new(30, 20, 3, rgb), *b = image_new(30, 20, 3, rgb), *s = image_new(30, 20, 3, rgb);
    struct mcr_metrics_options options = {.peak = 8};
    struct mcr_comparison one = {0}, eight;
    int same = 1;
    for (size_t i = 0; i < 30 * 20 * 3; i++) {
        a->data[i] = uniform(), r->data[i] = uniform();
        b->data[i] = 8 * a->data[i], s->data[i] = 8 * r->data[i];
    }
    one = compare(a, r);
    same &= !mcr_metrics_compare(b, s, &options, MCR_METRICS_ALL, &eight);
    for (int m = 0; m < MCR_METRIC_COUNT; m++) {
        double factor = m == MCR_METRIC_MSE ? 64 : m == MCR_METRIC_RMSE || m == MCR_METRIC_MAE ? 8 : 1;
        same &= m == MCR_METRIC_MS_SSIM || close_to(eight.whole.value[m], factor * one.whole.value[m], 1e-13 * fabs(factor * one.whole.value[m]));
    }
    ok(same && eight.peak == 8, "eight times the values and the peak: the same relative distances");
    options = (struct mcr_metrics_options){.encoding = MCR_ENCODING_SRGB8};
    for (size_t i = 0; i < 30 * 20 * 3; i++) a->data[i] = 0.21404114048223255, r->data[i] = i % 2 ? 7 : -1; /* sRGB 0.5: code 128; clipped: 255 and 0 */
    mcr_metrics_compare(a, r, &options, MCR_METRICS_ALL, &one);
    ok(one.peak == 255 && one.range[0][0] == 128 && one.range[0][1] == 128 && one.range[1][0] == 0 && one.range[1][1] == 255 &&
           one.whole.value[MCR_METRIC_MSE] == (128.0 * 128 + 127.0 * 127) / 2,
       "srgb8: codes, clipped, peak 255");
    mcr_image_destroy(a);
    mcr_image_destroy(r);
    mcr_image_destroy(b);
    mcr_image_destroy(s);
}

static void whole_and_channels(void)
{
    struct mcr_image *a = image_flat(20, 20, 3, rgb, 0.5), *r = image_flat(20, 20, 3, rgb, 0.5);
    for (size_t i = 0; i < 400; i++) a->data[3 * i] += 0.3, a->data[3 * i + 2] -= 0.1;
    struct mcr_comparison c = compare(a, r);
    double luminance = 0.2126 * 0.3 - 0.0722 * 0.1;
    ok(close_to(c.channel[0].value[MCR_METRIC_MSE], 0.09, 1e-16) && c.channel[1].value[MCR_METRIC_MSE] == 0 &&
           close_to(c.channel[2].value[MCR_METRIC_MSE], 0.01, 1e-16), "channels");
    ok(close_to(c.whole.value[MCR_METRIC_MSE], 0.1 / 3, 1e-16), "the whole is of all values");
    ok(close_to(c.luminance.value[MCR_METRIC_RMSE], luminance, 1e-14), "luminance");
    ok(!strcmp(c.channel_name[0], "R") && !strcmp(c.channel_name[2], "B") && c.channels == 3, "names");
    double mean = (c.channel[0].value[MCR_METRIC_SSIM] + c.channel[1].value[MCR_METRIC_SSIM] + c.channel[2].value[MCR_METRIC_SSIM]) / 3;
    ok(close_to(c.whole.value[MCR_METRIC_SSIM], mean, 1e-15), "the whole's ssim is the channels' mean");
    mcr_image_destroy(a);
    mcr_image_destroy(r);
}

/* Normal noise: mse is sigma^2 on average, its standard deviation sigma^2 sqrt(2 / N). */
static void noise(void)
{
    const double sigma[] = {1e-6, 0.01, 3};
    for (int k = 0; k < 3; k++) {
        struct mcr_image *a = image_new(200, 150, 3, rgb), *r = image_new(200, 150, 3, rgb);
        size_t count = 200 * 150 * 3;
        random_state = 7;
        for (size_t i = 0; i < count; i++) {
            r->data[i] = 100 * uniform();
            a->data[i] = r->data[i] + sigma[k] * normal();
        }
        struct mcr_comparison c = compare(a, r);
        double z = (c.whole.value[MCR_METRIC_MSE] / (sigma[k] * sigma[k]) - 1) / sqrt(2.0 / (double)count);
        ok(fabs(z) <= 4, "noise of %g: mse %g, z %.2f", sigma[k], c.whole.value[MCR_METRIC_MSE], z);
        mcr_image_destroy(a);
        mcr_image_destroy(r);
    }
}

/* 4 million values of which plain summing would lose some: 2^53 + 1 is not a double. */
static void long_sums(void)
{
    struct mcr_image *a = image_flat(2048, 2048, 1, grey, 1), *r = image_flat(2048, 2048, 1, grey, 0);
    struct mcr_metrics_options options = {0};
    struct mcr_comparison c;
    a->data[0] = 0x1p26 * sqrt(2); /* its square is 2^53, up to rounding */
    mcr_metrics_compare(a, r, &options, 1u << MCR_METRIC_MSE, &c);
    double first = a->data[0] * a->data[0], count = 2048.0 * 2048, wanted = (first + (count - 1)) / count;
    ok(c.whole.value[MCR_METRIC_MSE] == wanted, "a long sum loses nothing: %.17g", c.whole.value[MCR_METRIC_MSE]);
    ok(isnan(c.whole.value[MCR_METRIC_SSIM]) && c.whole.note[MCR_METRIC_SSIM], "what was not asked for is not computed");
    mcr_image_destroy(a);
    mcr_image_destroy(r);
}

int main(void)
{
    worked_example();
    constants();
    waves();
    identical();
    constant_difference();
    scales();
    whole_and_channels();
    noise();
    long_sums();
    return tap_done();
}
