/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/layers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/arguments.h"
#include "cli/options.h"
#include "image/read.h"

#define MOST_CHANNELS 21u

/* Channels by the conventions of Cycles, Blender and Open Image Denoise, as far as there are any. */
static const struct layer {
    const char *word;
    uint32_t feature, channels;
    const char *name[4];
} table[] = {
    {"variance", 0, 4, {"variance.R", "variance.G", "variance.B", "variance.Y"}},
    {"albedo", MCR_FEATURE_ALBEDO, 3, {"albedo.R", "albedo.G", "albedo.B"}},
    {"normal", MCR_FEATURE_NORMAL, 3, {"N.X", "N.Y", "N.Z"}},
    {"depth", MCR_FEATURE_DEPTH, 1, {"Z"}},
    {"id", MCR_FEATURE_ID, 1, {"id"}},
    {"direct", MCR_FEATURE_DIRECT, 3, {"direct.R", "direct.G", "direct.B"}},
    {"indirect", MCR_FEATURE_INDIRECT, 3, {"indirect.R", "indirect.G", "indirect.B"}},
};
#define LAYERS (sizeof table / sizeof *table)

int mcr_layers_parse(const char *text, uint32_t *layers)
{
    const char *words[LAYERS];
    for (size_t i = 0; i < LAYERS; i++)
        words[i] = table[i].word;
    for (*layers = 0;;) {
        size_t length = strcspn(text, ",");
        char word[64];
        uint32_t chosen;
        snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), text);
        if (mcr_argument_word("--layers", word, words, LAYERS, LAYERS, &chosen))
            return MCR_EXIT_USAGE;
        if (*layers & 1u << chosen)
            return mcr_usage_error("--layers names '%s' twice", words[chosen]);
        *layers |= 1u << chosen;
        if (!text[length])
            return 0;
        text += length + 1;
    }
}

uint32_t mcr_layers_features(uint32_t layers)
{
    uint32_t features = 0;
    for (size_t i = 0; i < LAYERS; i++)
        features |= layers & 1u << i ? table[i].feature : 0;
    return features & MCR_FEATURE_INDIRECT ? (features & ~MCR_FEATURE_INDIRECT) | MCR_FEATURE_DIRECT : features;
}

/* The variance of the mean in R, G, B and luminance. Returns 0, or -1 when memory is short. */
static int fill_variance(const struct mcr_film *film, double *channel, uint32_t channels)
{
    double *rgb = calloc(film->pixels, 3 * sizeof *rgb), *luminance = calloc(film->pixels, sizeof *luminance);
    int status = rgb && luminance ? 0 : -1;
    if (!status && !mcr_film_channel_variance(film, rgb) && !mcr_film_variance(film, luminance))
        for (uint64_t p = 0; p < film->pixels; p++) {
            memcpy(channel + channels * p, rgb + 3 * p, 3 * sizeof *rgb);
            channel[channels * p + 3] = luminance[p];
        }
    free(rgb);
    free(luminance);
    return status;
}

struct mcr_image *mcr_layers_image(const struct mcr_film *film, const struct mcr_features *features, uint32_t layers)
{
    const char *names[MOST_CHANNELS] = {"R", "G", "B"};
    uint32_t channels = 3, at[LAYERS];
    if (!film->channels || film->units < 2)
        layers &= ~(uint32_t)MCR_LAYER_VARIANCE;
    for (size_t i = 0; i < LAYERS; i++) {
        at[i] = channels;
        for (uint32_t c = 0; c < table[i].channels && (layers & 1u << i); c++)
            names[channels++] = table[i].name[c];
    }
    struct mcr_image *image = mcr_image_create_named(film->width, film->height, channels, names);
    double *mean = image ? calloc(film->pixels, 3 * sizeof *mean) : NULL;
    int status = mean ? 0 : -1;
    if (mean)
        mcr_film_mean(film, mean);
    for (uint64_t p = 0; mean && p < film->pixels; p++)
        memcpy(image->data + channels * p, mean + 3 * p, 3 * sizeof *mean);
    free(mean);
    for (size_t i = 0; i < LAYERS && !status; i++) {
        if (!(layers & 1u << i))
            continue;
        if (table[i].feature)
            for (uint64_t p = 0; p < features->pixels; p++)
                mcr_features_value(features, table[i].feature, p, image->data + channels * p + at[i]);
        else
            status = fill_variance(film, image->data + at[i], channels);
    }
    if (!status)
        return image;
    mcr_image_destroy(image);
    return NULL;
}
