/* SPDX-License-Identifier: Apache-2.0 */
#include "film/film.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double *array(uint64_t count)
{
    return calloc(count ? count : 1, sizeof(double));
}

struct mcr_film *mcr_film_create(uint32_t width, uint32_t height, int correlated)
{
    struct mcr_film *film = calloc(1, sizeof *film);
    if (!film)
        return NULL;
    film->width = width;
    film->height = height;
    film->pixels = (uint64_t)width * height;
    film->correlated = correlated;
    if (correlated) {
        film->replicate_sum = array(film->pixels);
        film->unit_mean = array(film->pixels);
        film->unit_moment = array(film->pixels);
        if (!film->replicate_sum || !film->unit_mean || !film->unit_moment) {
            mcr_film_destroy(film);
            return NULL;
        }
    }
    return film;
}

/* Independent samples need moments in the levels, as they come; replicates have means, and these their moments. */
int mcr_film_keep_channels(struct mcr_film *film)
{
    film->channels = 1;
    for (int c = 0; c < 3 && film->correlated; c++) {
        film->replicate_channel[c] = array(film->pixels);
        film->unit_channel_mean[c] = array(film->pixels);
        film->unit_channel_moment[c] = array(film->pixels);
        if (!film->replicate_channel[c] || !film->unit_channel_mean[c] || !film->unit_channel_moment[c])
            return -1;
    }
    return 0;
}

static int sink_add(void *film, const struct mcr_cell *cell, uint32_t count)
{
    return mcr_film_add(film, cell, count);
}

static int sink_add_channels(void *film, const struct mcr_cell *cell, const struct mcr_cell_channels *channels, uint32_t count)
{
    return mcr_film_add_channels(film, cell, channels, count);
}

static void sink_end_replicate(void *film)
{
    mcr_film_end_replicate(film);
}

struct mcr_cell_sink mcr_film_sink(struct mcr_film *film)
{
    int moments = film->channels && !film->correlated;
    return (struct mcr_cell_sink){
        .data = film, .add = sink_add, .end_replicate = sink_end_replicate, .add_channels = moments ? sink_add_channels : NULL};
}

static void level_free(struct mcr_film_level *level)
{
    for (int c = 0; c < 3; c++) {
        free(level->sum[c]);
        free(level->channel[c]);
    }
    free(level->moment);
    memset(level, 0, sizeof *level);
}

void mcr_film_destroy(struct mcr_film *film)
{
    if (!film)
        return;
    for (uint32_t l = 0; l < MCR_FILM_LEVELS; l++)
        level_free(&film->level[l]);
    free(film->replicate_sum);
    free(film->unit_mean);
    free(film->unit_moment);
    for (int c = 0; c < 3; c++) {
        free(film->replicate_channel[c]);
        free(film->unit_channel_mean[c]);
        free(film->unit_channel_moment[c]);
    }
    free(film);
}

static int level_prepare(struct mcr_film *film, uint32_t l)
{
    struct mcr_film_level *level = &film->level[l];
    for (int c = 0; c < 3; c++)
        if (!level->sum[c] && !(level->sum[c] = array(film->pixels)))
            return -1;
    if (!level->moment && !(level->moment = array(film->pixels)))
        return -1;
    for (int c = 0; c < 3 && film->channels && !film->correlated; c++)
        if (!level->channel[c] && !(level->channel[c] = array(film->pixels)))
            return -1;
    return 0;
}

/* What the distance between two groups' means adds to the moment of both together (Chan, Golub and LeVeque): of sums and numbers of samples. */
static double between(double sum, double samples, double other_sum, double other_samples)
{
    double difference = other_sum / other_samples - sum / samples;
    return difference * difference * (samples * other_samples / (samples + other_samples));
}

/* The channels' part of level_add, before the sums are added. */
static void level_add_channels(struct mcr_film_level *level, uint64_t pixel, const double sum[3], const double moment[3], double count)
{
    for (int c = 0; c < 3; c++) {
        level->channel[c][pixel] += moment[c];
        if (level->samples)
            level->channel[c][pixel] += between(level->sum[c][pixel], (double)level->samples, sum[c], count);
    }
}

/* Adds a child of `count` samples to a pixel of a level that holds `samples`. */
static void level_add(struct mcr_film_level *level, uint64_t pixel, const double sum[3], double moment, double count)
{
    double samples = (double)level->samples;
    if (level->samples) {
        double before = mcr_luminance(level->sum[0][pixel], level->sum[1][pixel], level->sum[2][pixel]) / samples;
        double difference = mcr_luminance(sum[0], sum[1], sum[2]) / count - before;
        moment += difference * difference * (samples * count / (samples + count));
    }
    level->moment[pixel] += moment;
    for (int c = 0; c < 3; c++)
        level->sum[c][pixel] += sum[c];
}

/* Level l is complete: it becomes a child of level l + 1 and is empty again. */
static void level_carry(struct mcr_film *film, uint32_t l)
{
    struct mcr_film_level *from = &film->level[l], *to = &film->level[l + 1];
    for (uint64_t p = 0; p < film->pixels; p++) {
        double sum[3] = {from->sum[0][p], from->sum[1][p], from->sum[2][p]};
        if (from->channel[0]) {
            double moment[3] = {from->channel[0][p], from->channel[1][p], from->channel[2][p]};
            level_add_channels(to, p, sum, moment, (double)from->samples);
            from->channel[0][p] = from->channel[1][p] = from->channel[2][p] = 0;
        }
        level_add(to, p, sum, from->moment[p], (double)from->samples);
        for (int c = 0; c < 3; c++)
            from->sum[c][p] = 0;
        from->moment[p] = 0;
    }
    to->samples += from->samples;
    to->children++;
    from->samples = 0;
    from->children = 0;
}

int mcr_film_add(struct mcr_film *film, const struct mcr_cell *cell, uint32_t count)
{
    return mcr_film_add_channels(film, cell, NULL, count);
}

int mcr_film_add_channels(struct mcr_film *film, const struct mcr_cell *cell, const struct mcr_cell_channels *channels, uint32_t count)
{
    if (level_prepare(film, 0) || (!channels && film->level[0].channel[0]))
        return -1;
    /* A full level carries before the next child comes, so that the last one is never carried in vain. */
    uint32_t full = 0;
    while (full + 1 < MCR_FILM_LEVELS && film->level[full].children == MCR_FILM_RADIX) {
        if (level_prepare(film, full + 1))
            return -1;
        full++;
    }
    while (full-- > 0)
        level_carry(film, full);
    for (uint64_t p = 0; p < film->pixels; p++) {
        if (film->level[0].channel[0])
            level_add_channels(&film->level[0], p, cell[p].sum, channels[p].moment, count);
        level_add(&film->level[0], p, cell[p].sum, cell[p].moment, count);
        if (film->correlated)
            film->replicate_sum[p] += mcr_luminance(cell[p].sum[0], cell[p].sum[1], cell[p].sum[2]);
        for (int c = 0; c < 3 && film->replicate_channel[c]; c++)
            film->replicate_channel[c][p] += cell[p].sum[c];
    }
    film->level[0].samples += count;
    film->level[0].children++;
    film->samples += count;
    if (film->correlated)
        film->replicate_samples += count;
    else
        film->units = film->samples > UINT32_MAX ? UINT32_MAX : (uint32_t)film->samples;
    return 0;
}

/* The means of a replicate of `count` samples, whose sums are emptied, join those of replicates with `before` samples. */
static void join(uint64_t pixels, double *sum, double *mean, double *moment, double before, double count)
{
    for (uint64_t p = 0; p < pixels; p++) {
        double difference = sum[p] / count - mean[p];
        mean[p] += difference * (count / (before + count));
        moment[p] += difference * difference * (before * count / (before + count));
        sum[p] = 0;
    }
}

void mcr_film_end_replicate(struct mcr_film *film)
{
    double count = (double)film->replicate_samples, before = (double)film->unit_samples;
    if (!film->correlated || !film->replicate_samples)
        return;
    join(film->pixels, film->replicate_sum, film->unit_mean, film->unit_moment, before, count);
    for (int c = 0; c < 3 && film->replicate_channel[c]; c++)
        join(film->pixels, film->replicate_channel[c], film->unit_channel_mean[c], film->unit_channel_moment[c], before, count);
    film->unit_samples += film->replicate_samples;
    film->replicate_samples = 0;
    film->units++;
}

/* The levels folded into one pixel's sums, from the highest, which holds the earliest samples, down. Returns the moment. */
static double pixel_total(const struct mcr_film *film, uint64_t p, double total[3])
{
    double moment = 0, samples = 0;
    total[0] = total[1] = total[2] = 0;
    for (int l = MCR_FILM_LEVELS - 1; l >= 0; l--) {
        const struct mcr_film_level *level = &film->level[l];
        double count = (double)level->samples;
        if (!level->samples)
            continue;
        if (samples > 0) {
            double difference = mcr_luminance(level->sum[0][p], level->sum[1][p], level->sum[2][p]) / count -
                                mcr_luminance(total[0], total[1], total[2]) / samples;
            moment += difference * difference * (samples * count / (samples + count));
        }
        moment += level->moment[p];
        for (int c = 0; c < 3; c++)
            total[c] += level->sum[c][p];
        samples += count;
    }
    return moment;
}

void mcr_film_mean(const struct mcr_film *film, double *rgb)
{
    for (uint64_t p = 0; p < film->pixels; p++) {
        double total[3];
        pixel_total(film, p, total);
        for (int c = 0; c < 3; c++)
            rgb[3 * p + c] = film->samples ? total[c] / (double)film->samples : 0;
    }
}

/* What a moment is divided by for the variance of the mean. */
static double divisor(const struct mcr_film *film)
{
    /* Units of equal size have Var(mean) = moment / (n (units - 1)); for replicates of almost equal size it stays unbiased with their samples as weights. */
    return film->correlated ? (double)film->unit_samples * (film->units - 1.0) : (double)film->samples * ((double)film->samples - 1);
}

int mcr_film_variance(const struct mcr_film *film, double *out)
{
    if (film->units < 2)
        return -1;
    for (uint64_t p = 0; p < film->pixels; p++) {
        double total[3];
        out[p] = (film->correlated ? film->unit_moment[p] : pixel_total(film, p, total)) / divisor(film);
    }
    return 0;
}

/* As pixel_total: the moment of one channel over all levels. */
static double channel_total(const struct mcr_film *film, uint64_t p, int c)
{
    double moment = 0, samples = 0, total = 0;
    for (int l = MCR_FILM_LEVELS - 1; l >= 0; l--) {
        const struct mcr_film_level *level = &film->level[l];
        double count = (double)level->samples;
        if (!level->samples)
            continue;
        moment += level->channel[c][p] + (samples > 0 ? between(total, samples, level->sum[c][p], count) : 0);
        total += level->sum[c][p];
        samples += count;
    }
    return moment;
}

int mcr_film_channel_variance(const struct mcr_film *film, double *rgb)
{
    if (!film->channels || film->units < 2)
        return -1;
    for (uint64_t p = 0; p < film->pixels; p++)
        for (int c = 0; c < 3; c++)
            rgb[3 * p + c] = (film->correlated ? film->unit_channel_moment[c][p] : channel_total(film, p, c)) / divisor(film);
    return 0;
}

int mcr_film_figures(const struct mcr_film *film, struct mcr_film_figures *figures)
{
    double pixels = (double)film->pixels;
    memset(figures, 0, sizeof *figures);
    double *rgb = array(3 * film->pixels), *variance = array(film->pixels);
    if (!rgb || !variance) {
        free(rgb);
        free(variance);
        return -1;
    }
    mcr_film_mean(film, rgb);
    for (uint64_t p = 0; p < film->pixels; p++)
        for (int c = 0; c < 3; c++)
            figures->mean[c] += rgb[3 * p + c] / pixels;
    figures->luminance = mcr_luminance(figures->mean[0], figures->mean[1], figures->mean[2]);
    if (mcr_film_variance(film, variance) == 0) {
        figures->known = 1;
        for (uint64_t p = 0; p < film->pixels; p++)
            figures->mean_variance += variance[p] / pixels;
        figures->standard_error = sqrt(figures->mean_variance / pixels);
        figures->relative_error = figures->luminance > 0 ? sqrt(figures->mean_variance) / figures->luminance : 0;
        figures->sample_variance = figures->mean_variance * (double)(film->correlated ? film->unit_samples : film->samples);
    }
    free(rgb);
    free(variance);
    return 0;
}
