/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What cells are measured against. It is rendered in parts with seeds of their own, each kept as soon as it is there; the spread of the parts' means
 * tells the variance of each value of their mean, whatever numbers its sampler draws.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/state.h"
#include "study/work.h"

#define PLANES 6u /* means in R, G, B; sums of samples * (part's mean - mean)^2 */

static const char *const channel_names[] = {"R", "G", "B"};

struct place {
    char name[48];
};

static struct place place_of(const struct mcr_study_work *work, uint32_t k)
{
    struct place place;
    snprintf(place.name, sizeof place.name, "reference-%016llx.parts", (unsigned long long)work->reference_key[k]);
    return place;
}

static int no_memory(char *error, size_t length)
{
    snprintf(error, length, "out of memory");
    return -1;
}

/* ---- from a file ---- */

/* The channel of this name, or -1. */
static int channel(const struct mcr_image *image, const char *name)
{
    for (uint32_t i = 0; image->name && i < image->channels; i++)
        if (!strcmp(image->name[i], name))
            return (int)i;
    return -1;
}

static void take_channel(const struct mcr_image *from, uint32_t channel, struct mcr_image *to, uint32_t c)
{
    for (size_t p = 0; p < (size_t)to->width * to->height; p++)
        to->data[3 * p + c] = from->data[p * from->channels + channel];
}

static int all_finite(const struct mcr_image *image)
{
    for (size_t i = 0; i < (size_t)image->width * image->height * image->channels; i++)
        if (!isfinite(image->data[i]))
            return 0;
    return 1;
}

/* R, G and B of the file, and their variances where it has such layers. */
static int take_file(struct mcr_study_work *work, const struct mcr_image *file, char *error, size_t length)
{
    static const char *const variances[] = {"variance.R", "variance.G", "variance.B"};
    int has_variance = channel(file, variances[0]) >= 0 && channel(file, variances[1]) >= 0 && channel(file, variances[2]) >= 0;
    struct mcr_image *image = work->reference_image[0] = mcr_image_create(file->width, file->height, 3, channel_names);
    struct mcr_image *variance = has_variance ? mcr_image_create(file->width, file->height, 3, channel_names) : NULL;
    work->reference_variance[0] = variance;
    if (!image || (has_variance && !variance))
        return no_memory(error, length);
    for (uint32_t c = 0; c < 3; c++) {
        int named = channel(file, channel_names[c]);
        take_channel(file, named >= 0 ? (uint32_t)named : file->channels >= 3 ? c : 0, image, c);
        if (variance)
            take_channel(file, (uint32_t)channel(file, variances[c]), variance, c);
    }
    work->reference_key[0] = mcr_state_hash(0, image->data, (size_t)image->width * image->height * 3);
    if (all_finite(image) && (!variance || all_finite(variance)))
        return 0;
    snprintf(error, length, "the reference '%s' has values that are not finite", work->plan->reference_image);
    return -1;
}

int mcr_study_reference_read(struct mcr_study_work *work, char *error, size_t length)
{
    struct mcr_image *file = mcr_image_read(work->plan->reference_image, error, length);
    int status = -1;
    if (!file)
        return -1;
    if (file->width == work->study.width && file->height == work->study.height)
        status = take_file(work, file, error, length);
    else
        snprintf(error, length, "the reference '%s' has %u x %u pixels, the study's pictures %u x %u", work->plan->reference_image, file->width,
                 file->height, work->study.width, work->study.height);
    mcr_image_destroy(file);
    return status;
}

/* ---- rendered ---- */

/* Adds a part of n samples a pixel to the mean of N. */
static void add_part(struct mcr_state *state, const struct mcr_image *part, double before, double n)
{
    size_t pixels = (size_t)state->width * state->height;
    for (size_t p = 0; p < pixels; p++)
        for (size_t c = 0; c < 3; c++) {
            double *mean = &state->data[c * pixels + p], *moment = &state->data[(3 + c) * pixels + p];
            double difference = part->data[3 * p + c] - *mean;
            *mean += difference * (n / (before + n));
            *moment += difference * difference * (before * n / (before + n));
        }
}

/* Renders the parts that are missing. 0, 1 stopped, -1 with the reason. */
static int render_parts(struct mcr_study_work *work, uint32_t k, struct mcr_state *state, char *error, size_t length)
{
    struct place place = place_of(work, k);
    uint32_t parts = mcr_study_parts(work->plan);
    double samples = 0;
    struct mcr_shot_settings settings;
    for (uint32_t part = 0; part < parts; part++) {
        struct mcr_shot shot = {0};
        int status;
        mcr_study_reference_shot(work, k, part, &settings);
        samples += settings.spp;
        if (part < state->count)
            continue;
        work->progress = (struct mcr_study_progress){.what = "reference", .label = settings.sampler, .spp = work->plan->reference_spp,
                                                     .depth = settings.depth, .done = part, .total = parts, .left = (double)NAN};
        mcr_study_show(work);
        status = mcr_shot_render(&work->setup, &settings, &shot, error, length);
        if (!status && shot.stats.not_finite)
            mcr_study_tell(work, "%llu samples of the reference were not finite and count as black", (unsigned long long)shot.stats.not_finite);
        if (!status) {
            add_part(state, shot.image, samples - settings.spp, settings.spp);
            state->count = part + 1;
            state->seconds += shot.stats.wall_seconds;
            status = mcr_state_write(state, work->folder, place.name, error, length);
        }
        mcr_shot_fini(&shot);
        if (status)
            return status;
    }
    return 0;
}

/* Images of the mean and of its variance. */
static int take_parts(struct mcr_study_work *work, uint32_t k, const struct mcr_state *state, char *error, size_t length)
{
    size_t pixels = (size_t)state->width * state->height;
    double degrees = (double)mcr_study_parts(work->plan) - 1;
    work->reference_image[k] = mcr_image_create(state->width, state->height, 3, channel_names);
    work->reference_variance[k] = degrees > 0 ? mcr_image_create(state->width, state->height, 3, channel_names) : NULL;
    if (!work->reference_image[k] || (degrees > 0 && !work->reference_variance[k]))
        return no_memory(error, length);
    for (size_t p = 0; p < pixels; p++)
        for (size_t c = 0; c < 3; c++) {
            work->reference_image[k]->data[3 * p + c] = state->data[c * pixels + p];
            if (degrees > 0)
                work->reference_variance[k]->data[3 * p + c] = state->data[(3 + c) * pixels + p] / ((double)work->plan->reference_spp * degrees);
        }
    work->study.reference[k].seconds = state->seconds;
    return 0;
}

static int make_parts(struct mcr_study_work *work, uint32_t k, char *error, size_t length)
{
    struct place place = place_of(work, k);
    struct mcr_state state;
    int status, found;
    if (mcr_state_init(&state, work->reference_key[k], work->study.width, work->study.height, PLANES))
        return no_memory(error, length);
    found = mcr_state_read(&state, work->folder, place.name);
    if (found < 0)
        mcr_study_tell(work, "'%s/state/%s' is damaged: the reference is rendered again", work->folder, place.name);
    if (state.count > mcr_study_parts(work->plan))
        state.count = 0;
    if (state.count == 0)
        memset(state.data, 0, (size_t)state.width * state.height * PLANES * sizeof(double));
    status = render_parts(work, k, &state, error, length);
    if (!status)
        status = take_parts(work, k, &state, error, length);
    mcr_state_fini(&state);
    return status;
}

uint32_t mcr_study_reference_parts(const struct mcr_study_work *work, uint32_t k)
{
    struct place place = place_of(work, k);
    struct mcr_state state;
    uint32_t parts = 0;
    if (work->plan->reference_image)
        return mcr_study_parts(work->plan);
    if (mcr_state_init(&state, work->reference_key[k], work->study.width, work->study.height, PLANES))
        return 0;
    if (!mcr_state_read(&state, work->folder, place.name) && state.count <= mcr_study_parts(work->plan))
        parts = (uint32_t)state.count;
    mcr_state_fini(&state);
    return parts;
}

int mcr_study_reference_make(struct mcr_study_work *work, uint32_t k, char *error, size_t length)
{
    struct mcr_study_reference *reference = &work->study.reference[k];
    const struct mcr_image *variance;
    int status = work->plan->reference_image ? 0 : make_parts(work, k, error, length);
    if (status)
        return status;
    variance = work->reference_variance[k];
    reference->image = work->reference_image[k];
    reference->noise = variance ? 0 : (double)NAN;
    for (size_t i = 0; variance && i < (size_t)variance->width * variance->height * 3; i++)
        reference->noise += variance->data[i] / ((double)variance->width * variance->height * 3);
    return 0;
}
