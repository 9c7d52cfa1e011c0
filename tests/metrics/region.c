/* SPDX-License-Identifier: Apache-2.0 */
/* What is compared: crop, mask, values that are not finite; and what cannot be compared. */
#include "help.h"

static struct mcr_image *noisy(uint32_t width, uint32_t height, uint32_t channels, const char *const *name)
{
    struct mcr_image *image = image_new(width, height, channels, name);
    for (size_t i = 0; i < (size_t)width * height * channels; i++) image->data[i] = uniform();
    return image;
}

static struct mcr_image *cropped(const struct mcr_image *image, const uint32_t crop[4])
{
    struct mcr_image *part = image_new(crop[2] - crop[0], crop[3] - crop[1], image->channels, image->name);
    for (uint32_t y = 0; y < part->height; y++)
        memcpy(part->data + (size_t)y * part->width * part->channels,
               image->data + ((size_t)(crop[1] + y) * image->width + crop[0]) * image->channels, (size_t)part->width * part->channels * sizeof(double));
    return part;
}

static int same_metrics(const struct mcr_comparison *a, const struct mcr_comparison *b)
{
    for (int m = 0; m < MCR_METRIC_COUNT; m++)
        if (memcmp(&a->whole.value[m], &b->whole.value[m], sizeof(double)) && !(isnan(a->whole.value[m]) && isnan(b->whole.value[m]))) return 0;
    return 1;
}

static int refused(const struct mcr_image *a, const struct mcr_image *r, const struct mcr_metrics_options *options, const char *reason)
{
    struct mcr_comparison c;
    if (mcr_metrics_compare(a, r, options, MCR_METRICS_ALL, &c) == -1 && strstr(c.error, reason)) return 1;
    printf("# %s\n", c.error);
    return 0;
}

static void crop(const struct mcr_image *a, const struct mcr_image *r)
{
    struct mcr_metrics_options options = {.has_crop = 1, .crop = {3, 5, 40, 25}};
    struct mcr_image *part_a = cropped(a, options.crop), *part_r = cropped(r, options.crop);
    struct mcr_comparison c, wanted = compare(part_a, part_r);
    ok(!mcr_metrics_compare(a, r, &options, MCR_METRICS_ALL, &c) && same_metrics(&c, &wanted), "a crop is as the images cut to it");
    ok(c.pixels == 37 * 20 && !memcmp(c.region, options.crop, sizeof c.region), "its region is told");
    options.crop[2] = a->width + 1;
    ok(refused(a, r, &options, "beyond"), "a crop beyond the images");
    options.crop[2] = 3;
    ok(refused(a, r, &options, "empty"), "an empty crop");
    mcr_image_destroy(part_a);
    mcr_image_destroy(part_r);
}

static void mask(const struct mcr_image *a, const struct mcr_image *r)
{
    static const char *const with_alpha[] = {"Y", "A"};
    struct mcr_image *mask = image_new(a->width, a->height, 2, with_alpha);
    struct mcr_metrics_options options = {.mask = mask};
    struct mcr_comparison c, all = compare(a, r);
    double sum = 0, count = 0;
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) mask->data[2 * i + 1] = 1;
    ok(refused(a, r, &options, "mask is black"), "a black mask; its alpha does not count");
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) {
        mask->data[2 * i] = uniform() < 0.3 ? -0.5 : 0;
        for (int k = 0; k < 3 && mask->data[2 * i] != 0; k++, count++) {
            double e = a->data[3 * i + k] - r->data[3 * i + k];
            sum += e * e;
        }
    }
    ok(!mcr_metrics_compare(a, r, &options, MCR_METRICS_ALL, &c) && close_to(c.whole.value[MCR_METRIC_MSE], sum / count, 1e-14), "a mask");
    ok(c.pixels == (uint64_t)(count / 3), "its pixels are counted");
    ok(isnan(c.whole.value[MCR_METRIC_MS_SSIM]), "ms_ssim is undefined with it");
    ok(isfinite(c.whole.value[MCR_METRIC_SSIM]) && c.whole.value[MCR_METRIC_SSIM] != all.whole.value[MCR_METRIC_SSIM], "ssim is of windows around its pixels");
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) mask->data[2 * i] = 1;
    ok(!mcr_metrics_compare(a, r, &options, MCR_METRICS_ALL, &c) && same_metrics(&c, &all), "a white mask changes nothing");
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) mask->data[2 * i] = i == 0;
    ok(!mcr_metrics_compare(a, r, &options, MCR_METRICS_ALL, &c) && isnan(c.whole.value[MCR_METRIC_SSIM]) && c.whole.note[MCR_METRIC_SSIM],
       "no window lies around a pixel in the corner: ssim is undefined");
    mask->width--;
    ok(refused(a, r, &options, "the mask has"), "a mask of another size");
    mask->width++;
    mcr_image_destroy(mask);
}

/* One window, 11 x 11, and a mask of its centre: the ssim of these 121 pixels. */
static void mask_ssim(const struct mcr_image *a, const struct mcr_image *r)
{
    struct mcr_image *mask = image_new(a->width, a->height, 1, grey);
    struct mcr_metrics_options options = {.mask = mask}, window = {.has_crop = 1, .crop = {10, 8, 21, 19}};
    struct mcr_comparison of_mask, of_window;
    mask->data[(8 + 5) * a->width + 10 + 5] = 1;
    mcr_metrics_compare(a, r, &options, MCR_METRICS_ALL, &of_mask);
    mcr_metrics_compare(a, r, &window, MCR_METRICS_ALL, &of_window);
    ok(of_mask.pixels == 1 && close_to(of_mask.whole.value[MCR_METRIC_SSIM], of_window.whole.value[MCR_METRIC_SSIM], 1e-15), "ssim around one pixel");
    mcr_image_destroy(mask);
}

static void not_finite(const struct mcr_image *good, const struct mcr_image *r)
{
    struct mcr_image *a = image_new(good->width, good->height, 3, rgb), *mask = image_flat(good->width, good->height, 1, grey, 1);
    struct mcr_metrics_options options = {0}, masked = {.mask = mask};
    struct mcr_comparison c, of_mask;
    memcpy(a->data, good->data, (size_t)a->width * a->height * 3 * sizeof(double));
    a->data[3 * 5] = MCR_NAN, a->data[3 * 5 + 1] = -MCR_INFINITY, a->data[3 * 700 + 2] = MCR_INFINITY;
    mask->data[5] = mask->data[700] = 0;
    ok(refused(a, r, &options, "3 values of the image and 0 of the reference are NaN or infinite, in 2 pixels; the first is pixel 5,0"), "NaN and infinities fail");
    ok(refused(r, a, &options, "0 values of the image and 3 of the reference"), "those of the reference, too");
    ok(!mcr_metrics_compare(a, r, &masked, MCR_METRICS_ALL, &of_mask) && of_mask.not_finite[0] == 0, "outside the mask they are nobody's concern");
    options.exclude_not_finite = 1;
    ok(!mcr_metrics_compare(a, r, &options, MCR_METRICS_ALL, &c) && c.not_finite[0] == 3 && c.not_finite[1] == 0 &&
           c.pixels == (uint64_t)a->width * a->height - 2, "or left out, counted");
    ok(close_to(c.whole.value[MCR_METRIC_MSE], of_mask.whole.value[MCR_METRIC_MSE], 0) &&
           close_to(c.luminance.value[MCR_METRIC_SNR_VARIANCE], of_mask.luminance.value[MCR_METRIC_SNR_VARIANCE], 0), "as by that mask");
    ok(isfinite(c.whole.value[MCR_METRIC_SSIM]), "ssim leaves out the windows that see them");
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) a->data[3 * i] = MCR_NAN;
    ok(refused(a, r, &options, "no pixel takes part"), "nothing is left");
    mcr_image_destroy(a);
    mcr_image_destroy(mask);
}

static void channels(void)
{
    static const char *const layers[] = {"variance.R", "B", "A", "R", "G"}, *const strange[] = {"depth", "id"};
    struct mcr_image *a = noisy(20, 20, 5, layers), *r = noisy(20, 20, 3, rgb), *plain = image_new(20, 20, 3, NULL);
    struct mcr_image *one = noisy(20, 20, 1, grey), *odd = noisy(20, 20, 2, strange), *small = noisy(20, 19, 3, rgb);
    struct mcr_metrics_options options = {0};
    for (size_t i = 0; i < 400; i++)
        for (int k = 0; k < 3; k++) plain->data[3 * i + k] = a->data[5 * i + (k == 0 ? 3 : k == 1 ? 4 : 1)];
    struct mcr_comparison with = compare(a, r), without = compare(plain, r);
    ok(same_metrics(&with, &without), "R, G and B are found by name, other channels take no part");
    ok(refused(one, r, &options, "different channels: the image has one grey channel, the reference R, G, B"), "grey against colours");
    ok(refused(odd, odd, &options, "neither"), "no colours at all");
    ok(refused(small, r, &options, "different sizes: the image has 20x19 pixels, the reference 20x20"), "different sizes");
    mcr_image_destroy(a);
    mcr_image_destroy(r);
    mcr_image_destroy(plain);
    mcr_image_destroy(one);
    mcr_image_destroy(odd);
    mcr_image_destroy(small);
}

/* Values whose squares overflow: undefined, not infinite or wrong. */
static void overflow(void)
{
    struct mcr_image *a = image_flat(20, 20, 1, grey, 1e200), *r = image_flat(20, 20, 1, grey, 1);
    struct mcr_comparison c = compare(a, r);
    ok(isnan(c.whole.value[MCR_METRIC_MSE]) && c.whole.note[MCR_METRIC_MSE] && isnan(c.whole.value[MCR_METRIC_PSNR]) &&
           isnan(c.whole.value[MCR_METRIC_SSIM]) && c.whole.note[MCR_METRIC_SSIM], "squares beyond the range of doubles");
    ok(c.whole.value[MCR_METRIC_MAE] == 1e200, "what is in range is told");
    mcr_image_destroy(a);
    mcr_image_destroy(r);
}

int main(void)
{
    struct mcr_image *a = noisy(61, 47, 3, rgb), *r = noisy(61, 47, 3, rgb);
    crop(a, r);
    mask(a, r);
    mask_ssim(a, r);
    not_finite(a, r);
    channels();
    overflow();
    mcr_image_destroy(a);
    mcr_image_destroy(r);
    return tap_done();
}
