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

uint64_t mcr_film_bytes(uint64_t pixels, int correlated, int channels, uint32_t planned, uint32_t replicates)
{
    uint64_t cells = (uint64_t)replicates * ((planned + MCR_CELL_SAMPLES - 1) / MCR_CELL_SAMPLES), levels = 1, full = MCR_FILM_RADIX;
    for (; levels < MCR_FILM_LEVELS && cells > full; full *= MCR_FILM_RADIX) /* a level carries when the next child comes */
        levels++;
    uint64_t numbers = levels * (channels && !correlated ? 7 : 4) + (correlated ? channels ? 12 : 3 : 0);
    return pixels * numbers * sizeof(double);
}

uint64_t mcr_film_pixel_bytes(uint64_t pixels, int correlated)
{
    return pixels * (sizeof(uint32_t) + (correlated ? 3 : 2) * sizeof(double));
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
    free(film->cells);
    free(film->part_mean);
    free(film->part_moment);
    free(film->part_open);
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
static void level_add_channels(struct mcr_film_level *level, uint64_t pixel, const double sum[3], const double moment[3], double count, double samples)
{
    for (int c = 0; c < 3; c++) {
        level->channel[c][pixel] += moment[c];
        if (samples > 0)
            level->channel[c][pixel] += between(level->sum[c][pixel], samples, sum[c], count);
    }
}

/* Adds a child of `count` samples to a pixel of a level that holds `samples`. */
static void level_add(struct mcr_film_level *level, uint64_t pixel, const double sum[3], double moment, double count, double samples)
{
    if (samples > 0) {
        double before = mcr_luminance(level->sum[0][pixel], level->sum[1][pixel], level->sum[2][pixel]) / samples;
        double difference = mcr_luminance(sum[0], sum[1], sum[2]) / count - before;
        moment += difference * difference * (samples * count / (samples + count));
    }
    level->moment[pixel] += moment;
    for (int c = 0; c < 3; c++)
        level->sum[c][pixel] += sum[c];
}

/* What a pixel has in level l, `samples` of them, becomes a child of level l + 1, which holds `before`. */
static void pixel_carry(struct mcr_film *film, uint32_t l, uint64_t p, double samples, double before)
{
    struct mcr_film_level *from = &film->level[l], *to = &film->level[l + 1];
    double sum[3] = {from->sum[0][p], from->sum[1][p], from->sum[2][p]};
    if (from->channel[0]) {
        double moment[3] = {from->channel[0][p], from->channel[1][p], from->channel[2][p]};
        level_add_channels(to, p, sum, moment, samples, before);
        from->channel[0][p] = from->channel[1][p] = from->channel[2][p] = 0;
    }
    level_add(to, p, sum, from->moment[p], samples, before);
    for (int c = 0; c < 3; c++)
        from->sum[c][p] = 0;
    from->moment[p] = 0;
}

/* Level l is complete: it becomes a child of level l + 1 and is empty again. */
static void level_carry(struct mcr_film *film, uint32_t l)
{
    struct mcr_film_level *from = &film->level[l], *to = &film->level[l + 1];
    for (uint64_t p = 0; p < film->pixels; p++)
        pixel_carry(film, l, p, (double)from->samples, (double)to->samples);
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
            level_add_channels(&film->level[0], p, cell[p].sum, channels[p].moment, count, (double)film->level[0].samples);
        level_add(&film->level[0], p, cell[p].sum, cell[p].moment, count, (double)film->level[0].samples);
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

/* The mean of a replicate of `count` samples, whose sum is emptied, joins those of replicates with `before` samples. */
static void join(double *sum, double *mean, double *moment, double before, double count)
{
    double difference = *sum / count - *mean;
    *mean += difference * (count / (before + count));
    *moment += difference * difference * (before * count / (before + count));
    *sum = 0;
}

/* The same for luminance, and the channels where they are kept. */
static void join_pixel(struct mcr_film *film, uint64_t p, double before, double count)
{
    join(&film->replicate_sum[p], &film->unit_mean[p], &film->unit_moment[p], before, count);
    for (int c = 0; c < 3 && film->replicate_channel[c]; c++)
        join(&film->replicate_channel[c][p], &film->unit_channel_mean[c][p], &film->unit_channel_moment[c][p], before, count);
}

void mcr_film_end_replicate(struct mcr_film *film)
{
    double count = (double)film->replicate_samples, before = (double)film->unit_samples;
    if (!film->correlated || !film->replicate_samples)
        return;
    for (uint64_t p = 0; p < film->pixels; p++)
        join_pixel(film, p, before, count);
    film->unit_samples += film->replicate_samples;
    film->replicate_samples = 0;
    film->units++;
}

/* ---- Pixels with numbers of samples of their own ---- */

int mcr_film_by_pixel(struct mcr_film *film, uint32_t cells, uint32_t cell_samples)
{
    film->cells = calloc(film->pixels ? film->pixels : 1, sizeof *film->cells);
    film->replicate_cells = cells;
    film->cell_samples = cell_samples;
    film->part_mean = array(film->pixels);
    film->part_moment = array(film->pixels);
    film->part_open = film->correlated ? array(film->pixels) : NULL;
    return film->cells && film->part_mean && film->part_moment && (film->part_open || !film->correlated) ? 0 : -1;
}

/* Number `parts` of a pixel's independent estimates of its units' variance. */
static void part_add(struct mcr_film *film, uint64_t p, double variance, double parts)
{
    double difference = variance - film->part_mean[p];
    film->part_mean[p] += difference / parts;
    film->part_moment[p] += difference * (variance - film->part_mean[p]);
}

/* A round of a correlated film, with its mean luminance: two of them estimate the variance. */
static void part_round(struct mcr_film *film, uint64_t p, double mean)
{
    uint32_t rounds = film->cells[p] / film->replicate_cells;
    double difference = mean - film->part_open[p];
    if (rounds % 2)
        film->part_open[p] = mean;
    else
        part_add(film, p, difference * difference / 2, rounds / 2);
}

/*
 * How many samples a pixel has in each level. With cells of one size their number says it all: a level holds 1 to 16 children of 16^l cells, unless there
 * are none, and the rest has been carried to those above.
 */
static void level_samples(const struct mcr_film *film, uint64_t p, double samples[MCR_FILM_LEVELS])
{
    uint64_t cells = film->cells ? film->cells[p] : 0, width = film->cell_samples;
    for (int l = 0; l < (int)MCR_FILM_LEVELS; l++) {
        uint64_t children = cells ? (cells - 1) % MCR_FILM_RADIX + 1 : 0;
        samples[l] = film->cells ? (double)(children * width) : (double)film->level[l].samples;
        cells = (cells - children) / MCR_FILM_RADIX;
        width *= MCR_FILM_RADIX;
    }
}

/* Adds the next cell of one pixel. Returns 0, or -1 when memory is short. */
static int pixel_add(struct mcr_film *film, uint64_t p, const struct mcr_cell *cell, const struct mcr_cell_channels *channels)
{
    double samples[MCR_FILM_LEVELS], room = film->cell_samples;
    uint32_t full = 0;
    level_samples(film, p, samples);
    while (full + 1 < MCR_FILM_LEVELS && samples[full] >= room * MCR_FILM_RADIX) {
        if (level_prepare(film, ++full))
            return -1;
        room *= MCR_FILM_RADIX;
    }
    while (full-- > 0) {
        pixel_carry(film, full, p, samples[full], samples[full + 1]);
        samples[full + 1] += samples[full];
        samples[full] = 0;
    }
    if (film->level[0].channel[0])
        level_add_channels(&film->level[0], p, cell->sum, channels->moment, film->cell_samples, samples[0]);
    level_add(&film->level[0], p, cell->sum, cell->moment, film->cell_samples, samples[0]);
    for (int c = 0; c < 3 && film->replicate_channel[c]; c++)
        film->replicate_channel[c][p] += cell->sum[c];
    if (film->correlated)
        film->replicate_sum[p] += mcr_luminance(cell->sum[0], cell->sum[1], cell->sum[2]);
    film->cells[p]++;
    if (!film->correlated && film->cell_samples > 1)
        part_add(film, p, cell->moment / (film->cell_samples - 1.0), film->cells[p]);
    return 0;
}

int mcr_film_take(struct mcr_film *film, const struct mcr_task *task, const struct mcr_cell *cell, const struct mcr_cell_channels *channels)
{
    const double count = (double)film->replicate_cells * film->cell_samples;
    if (level_prepare(film, 0) || (!channels && film->level[0].channel[0]))
        return -1;
    for (uint32_t e = 0; e < task->count; e++) {
        uint32_t p = task->entry[e].pixel;
        for (uint32_t b = 0; b < task->cells; b++) {
            uint64_t at = (uint64_t)b * task->count + e;
            if (pixel_add(film, p, &cell[at], channels ? &channels[at] : NULL))
                return -1;
        }
        if (film->correlated) {
            part_round(film, p, film->replicate_sum[p] / count);
            join_pixel(film, p, film->cells[p] * (double)film->cell_samples - count, count);
        }
    }
    uint32_t least = UINT32_MAX;
    for (uint64_t p = 0; p < film->pixels; p++)
        least = film->cells[p] < least ? film->cells[p] : least;
    film->samples = (uint64_t)least * film->cell_samples;
    film->units = film->correlated ? least / film->replicate_cells : film->samples > UINT32_MAX ? UINT32_MAX : (uint32_t)film->samples;
    return 0;
}

uint64_t mcr_film_samples(const struct mcr_film *film, uint64_t p)
{
    return film->cells ? (uint64_t)film->cells[p] * film->cell_samples : film->samples;
}

/* ---- What it shows ---- */

/* The levels folded into one pixel's sums, from the highest, which holds the earliest samples, down. Returns the moment. */
static double pixel_total(const struct mcr_film *film, uint64_t p, double total[3])
{
    double moment = 0, samples = 0, held[MCR_FILM_LEVELS];
    level_samples(film, p, held);
    total[0] = total[1] = total[2] = 0;
    for (int l = MCR_FILM_LEVELS - 1; l >= 0; l--) {
        const struct mcr_film_level *level = &film->level[l];
        double count = held[l];
        if (count == 0)
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
        uint64_t samples = mcr_film_samples(film, p);
        pixel_total(film, p, total);
        for (int c = 0; c < 3; c++)
            rgb[3 * p + c] = samples ? total[c] / (double)samples : 0;
    }
}

/* What a pixel's moment is divided by for the variance of the mean. */
static double divisor(const struct mcr_film *film, uint64_t p)
{
    double samples = (double)mcr_film_samples(film, p), units = film->units;
    if (!film->correlated)
        return samples * (samples - 1);
    if (film->cells)
        units = film->cells[p] / film->replicate_cells;
    else
        samples = (double)film->unit_samples;
    /* Units of equal size have Var(mean) = moment / (n (units - 1)); for replicates of almost equal size it stays unbiased with their samples as weights. */
    return samples * (units - 1.0);
}

int mcr_film_variance(const struct mcr_film *film, double *out)
{
    if (film->units < 2)
        return -1;
    for (uint64_t p = 0; p < film->pixels; p++) {
        double total[3];
        out[p] = (film->correlated ? film->unit_moment[p] : pixel_total(film, p, total)) / divisor(film, p);
    }
    return 0;
}

/* As pixel_total: the moment of one channel over all levels. */
static double channel_total(const struct mcr_film *film, uint64_t p, int c)
{
    double moment = 0, samples = 0, total = 0, held[MCR_FILM_LEVELS];
    level_samples(film, p, held);
    for (int l = MCR_FILM_LEVELS - 1; l >= 0; l--) {
        const struct mcr_film_level *level = &film->level[l];
        double count = held[l];
        if (count == 0)
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
            rgb[3 * p + c] = (film->correlated ? film->unit_channel_moment[c][p] : channel_total(film, p, c)) / divisor(film, p);
    return 0;
}

/* The samples that a pixel's variance comes from, and their units. */
static double counted(const struct mcr_film *film, uint64_t p, double *units)
{
    double samples = (double)(film->correlated && !film->cells ? film->unit_samples : mcr_film_samples(film, p));
    *units = !film->correlated ? samples : film->cells ? film->cells[p] / film->replicate_cells : film->units;
    return samples;
}

/*
 * The standard error of the mean variance of a film by pixel: from the spread of the parts' estimates, which sees long tails. Where a pixel has fewer than
 * two parts its units are taken for normal: Var(s^2) = 2 sigma^4 / (units - 1), and s^4 is on average sigma^4 (units + 1) / (units - 1).
 */
static double mean_variance_error(const struct mcr_film *film, const double *variance)
{
    double sum = 0, pixels = (double)film->pixels;
    for (uint64_t p = 0; p < film->pixels; p++) {
        double units, samples = counted(film, p, &units), v = variance[p] / pixels;
        double parts = film->correlated ? floor(units / 2) : film->cell_samples > 1 ? samples / film->cell_samples : 0;
        if (parts < 2)
            sum += v * v * (2 / (units + 1));
        else
            sum += film->part_moment[p] / ((parts - 1) * parts) / (units * pixels * (units * pixels));
    }
    return sqrt(sum);
}

static void figures_of_variance(const struct mcr_film *film, const double *variance, struct mcr_film_figures *figures)
{
    double pixels = (double)film->pixels;
    figures->known = 1;
    for (uint64_t p = 0; p < film->pixels; p++) {
        double units;
        figures->mean_variance += variance[p] / pixels;
        figures->sample_variance += variance[p] * counted(film, p, &units) / pixels;
    }
    if (!film->cells) /* all pixels alike: rounded once */
        figures->sample_variance = figures->mean_variance * (double)(film->correlated ? film->unit_samples : film->samples);
    figures->standard_error = sqrt(figures->mean_variance / pixels);
    figures->mean_variance_error = film->cells ? mean_variance_error(film, variance) : 0;
    if (figures->luminance > 0) {
        figures->relative_error = sqrt(figures->mean_variance) / figures->luminance;
        figures->relative_bound = sqrt(figures->mean_variance + MCR_FILM_BOUND * figures->mean_variance_error) / figures->luminance;
    }
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
    if (mcr_film_variance(film, variance) == 0)
        figures_of_variance(film, variance, figures);
    free(rgb);
    free(variance);
    return 0;
}
