/* SPDX-License-Identifier: Apache-2.0 */
/* What the tests of metrics share: images from formulas, random numbers, comparisons. */
#ifndef TESTS_METRICS_HELP_H
#define TESTS_METRICS_HELP_H

#include "../tap.h"
#include "base/elementary.h"
#include "metrics/metrics.h"

#include <stdlib.h>
#include <string.h>

#define UNUSED __attribute__((unused))

static const char *const rgb[] UNUSED = {"R", "G", "B"}, *const grey[] UNUSED = {"Y"};

static UNUSED struct mcr_image *image_new(uint32_t width, uint32_t height, uint32_t channels, const char *const *name)
{
    struct mcr_image *image = mcr_image_create(width, height, channels, name);
    if (!image) exit(99);
    return image;
}

/* All values the same. */
static UNUSED struct mcr_image *image_flat(uint32_t width, uint32_t height, uint32_t channels, const char *const *name, double value)
{
    struct mcr_image *image = image_new(width, height, channels, name);
    for (size_t i = 0; i < (size_t)width * height * channels; i++) image->data[i] = value;
    return image;
}

/* splitmix64 */
static uint64_t random_state UNUSED = 1;
static UNUSED double uniform(void) /* (0, 1) */
{
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return ((double)((z ^ z >> 31) >> 11) + 0.5) * 0x1p-53;
}

static UNUSED double normal(void)
{
    double r = sqrt(-2 * mcr_log(uniform()));
    return r * mcr_cos(2 * MCR_PI * uniform());
}

static UNUSED int close_to(double found, double wanted, double tolerance)
{
    if (fabs(found - wanted) <= tolerance) return 1;
    printf("# %.17g, expected %.17g\n", found, wanted);
    return 0;
}

/* Compares with default options; a failure ends the test. */
static UNUSED struct mcr_comparison compare(const struct mcr_image *image, const struct mcr_image *reference)
{
    struct mcr_metrics_options options = {0};
    struct mcr_comparison comparison;
    if (mcr_metrics_compare(image, reference, &options, MCR_METRICS_ALL, &comparison)) {
        printf("Bail out! %s\n", comparison.error);
        exit(99);
    }
    return comparison;
}

#endif
