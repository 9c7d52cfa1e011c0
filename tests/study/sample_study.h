/* SPDX-License-Identifier: Apache-2.0 */
/* Made-up studies for the tests of what is written about them: no rendering, no statistics, only plausible numbers. */
#ifndef TESTS_STUDY_SAMPLE_STUDY_H
#define TESTS_STUDY_SAMPLE_STUDY_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/image.h"
#include "study/analysis.h"
#include "study/study.h"

#define SAMPLE_MOST 40u /* contestants */

struct sample_options {
    uint32_t contestants, spps, depths, runs, seeds;
    uint32_t width, height;
    int images;          /* written into the folder; missing ones are left out of the study */
    int lost_image;      /* the study names one that is not there */
    int unknown;         /* every number of the analysis is NaN */
    int interrupted;     /* cells have 0, 1, ... runs */
    int compat;
    int reference_image; /* a file instead of a render */
    int depths_compete;  /* one reference for all depths: a contestant a depth */
    int dark;            /* a scene far too dark to be seen */
    const char *title;   /* NULL: a usual one */
    const char *label;   /* of contestant 0; NULL: a usual one */
};

struct sample {
    struct mcr_study study;
    struct mcr_study_plan plan;
    struct mcr_analysis analysis;
    const char *sampler[SAMPLE_MOST], *label[SAMPLE_MOST];
    char name[2][SAMPLE_MOST][80];
    uint32_t spp[8], depth[8], one[1], compat[2];
    struct mcr_image *reference;
    char folder[1024];
};

static const char *const sample_sampler[] = {
    "cosine", "light", "mixture(cosine 1, light 1)", "stratified(cosine)", "stratified(light)", "stratified(mixture(cosine 1, light 1))",
        "nee", "uniform",
};
static const char *const sample_rgb[] = {"R", "G", "B"};
static const uint32_t sample_spp[] = {1, 100, 1000, 4000, 16000, 64000, 256000, 1024000};
static const uint32_t sample_depth[] = {1, 25, 50, 100, 200, 400, 800, 1600};

/* Numbers in (-1, 1) whose sum of three is near enough to a normal distribution; splitmix64. */
static double sample_noise(uint64_t *state)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        uint64_t z = *state += 0x9e3779b97f4a7c15u;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
        z = (z ^ z >> 27) * 0x94d049bb133111ebu;
        sum += (double)((z ^ z >> 31) >> 11) * 0x1p-52 - 1;
    }
    return sum;
}

/* A room, somewhat: walls, a lamp, two blocks, a gradient. */
static double sample_colour(double x, double y, int channel, int dark)
{
    static const double red[3] = {.55, .06, .05}, green[3] = {.1, .45, .09}, white[3] = {.62, .58, .5};
    const double *wall = x < .18 ? red : x > .82 ? green : white;
    double light = .25 + .75 * (1 - y) * (1 - y), value = wall[channel] * light;
    if (x > .4 && x < .6 && y < .06)
        value = 12;
    if ((x > .25 && x < .48 && y > .45 && y < .9) || (x > .56 && x < .74 && y > .66 && y < .94))
        value = .5 * white[channel] * (x < .5 ? 1.1 - y : 1.4 - y);
    return dark ? value / 4000 : value;
}

static struct mcr_image *sample_picture(const struct sample_options *options, double sigma, uint64_t seed)
{
    struct mcr_image *image = mcr_image_create(options->width, options->height, 3, sample_rgb);
    uint64_t state = seed;
    for (uint32_t y = 0; image && y < options->height; y++) {
        for (uint32_t x = 0; x < options->width; x++) {
            for (int k = 0; k < 3; k++) {
                double value = sample_colour((x + .5) / options->width, (y + .5) / options->height, k, options->dark);
                double noisy = value + sigma * sqrt(value < 1 ? value : 0) * sample_noise(&state);
                image->data[3 * ((size_t)y * options->width + x) + (uint32_t)k] = noisy > 0 ? noisy : 0;
            }
        }
    }
    return image;
}

/* Writes a picture as PFM into the folder and returns its name, to be freed; NULL after a failure. */
static char *sample_write(const struct sample *sample, const struct sample_options *options, const char *name, double sigma, uint64_t seed)
{
    char path[1200], error[256];
    struct mcr_write_options how = {0};
    struct mcr_write_result result;
    struct mcr_image *image = sample_picture(options, sigma, seed);
    snprintf(path, sizeof path, "%s/%s", sample->folder, name);
    struct mcr_target *target = mcr_target_open(path, error, sizeof error);
    int status = image && target ? mcr_target_write(target, image, &how, &result) : -1;
    mcr_image_destroy(image);
    return status ? NULL : strdup(name);
}

static struct mcr_interval sample_interval(double value, double share, int unknown)
{
    return unknown ? (struct mcr_interval){NAN, NAN, NAN} : (struct mcr_interval){value, value / (1 + share), value * (1 + share)};
}

/* The true MSE and time of a contestant. Number 1 is biased, as light alone would be. */
static double sample_mse(uint32_t contestant, uint32_t spp)
{
    double variance = 0.4 / (1 + (contestant % 3) * 3) / (1 + contestant * 0.05);
    return variance / pow(spp, contestant % 6 >= 3 ? 1.06 : 1) + (contestant == 1 ? 0.004 : 0);
}

static double sample_time(uint32_t contestant, uint32_t spp, uint32_t depth)
{
    return 0.002 + spp * (1 - 1 / (1.0 + depth)) * 0.003 * (1 + 0.35 * (contestant % 4));
}

static void sample_plan(struct sample *sample, const struct sample_options *options)
{
    struct mcr_study_plan *plan = &sample->plan;
    for (uint32_t i = 0; i < options->contestants; i++) {
        char *name = sample->name[0][i];
        if (i < 8)
            snprintf(name, 80, "%s", sample_sampler[i]);
        else
            snprintf(name, 80, "mixture(cosine %u, light 1)", i);
        sample->sampler[i] = sample->label[i] = i == 0 && options->label ? options->label : name;
    }
    for (uint32_t i = 0; options->depths_compete && i < options->contestants * options->depths; i++) {
        snprintf(sample->name[1][i], 80, "%s, depth %u", sample_sampler[i % options->contestants], sample_depth[i / options->contestants]);
        sample->label[i] = sample->name[1][i];
    }
    for (uint32_t i = 0; i < 8; i++)
        sample->spp[i] = sample_spp[i], sample->depth[i] = sample_depth[i];
    sample->compat[1] = options->compat ? MCR_COMPAT_CLAMP | MCR_COMPAT_DISK_POLAR : 0;
    *plan = (struct mcr_study_plan){
        .title = options->title ? options->title : "Cornell box: what variance reduction buys",
        .sampler_count = options->contestants, .spp_count = options->spps, .depth_count = options->depths, .precision_count = 1,
        .accel_count = 1, .roulette_count = 1, .compat_count = options->compat ? 2 : 1, .sampler = sample->sampler, .spp = sample->spp,
        .depth = sample->depth, .precision = sample->one, .accel = sample->one, .roulette = sample->one,
        .compat = sample->compat, .runs = options->runs, .seeds = options->seeds, .first_seed = 9007199254740993u, .confidence = 0.95,
        .metrics = 1u << MCR_METRIC_PSNR | 1u << MCR_METRIC_SNR | 1u << MCR_METRIC_SSIM | 1u << MCR_METRIC_RELMSE, .output = sample->folder,
        .reference_image = options->reference_image ? "truth.exr" : NULL, .reference_sampler = "mixture(cosine 1, light 1)",
            .reference_spp = 16000,
        .reference_depth = 100, .has_reference_depth = options->depths_compete, .reference_seed = 77};
}

static void sample_metrics(double metric[MCR_METRIC_COUNT], double mse)
{
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++)
        metric[m] = NAN;
    metric[MCR_METRIC_MSE] = mse;
    metric[MCR_METRIC_RELMSE] = mse * 3;
    metric[MCR_METRIC_PSNR] = -10 * log10(mse);
    metric[MCR_METRIC_SNR] = -10 * log10(mse) - 4.5;
    metric[MCR_METRIC_SSIM] = 1 / (1 + 8 * mse);
}

static void sample_runs(struct mcr_study_cell *cell, const struct sample *sample, const struct sample_options *options, uint64_t *state)
{
    uint32_t most = options->runs > options->seeds ? options->runs : options->seeds, count = options->interrupted ?
        (uint32_t)(cell - sample->study.cell) % (most + 1) : most;
    cell->run_count = count;
    cell->run = calloc(count + 1, sizeof *cell->run);
    for (uint32_t i = 0; i < count; i++) {
        struct mcr_study_run *run = &cell->run[i];
        double time = sample_time(cell->contestant, cell->settings.spp, cell->settings.depth) * (1 + 0.02 * sample_noise(state));
        *run = (struct mcr_study_run){.seed = sample->plan.first_seed + i, .wall_seconds = time, .cpu_seconds = time * 1.98,
                                      .build_seconds = 0.001, .write_seconds = 0.004,
                                      .samples = (uint64_t)options->width * options->height * cell->settings.spp, .rays = 12345678901u + i,
                                          .order = i * 100u + cell->contestant};
        sample_metrics(run->metric, sample_mse(cell->contestant, cell->settings.spp) * (1 + 0.03 * sample_noise(state)));
    }
}

static void sample_cell_analysis(struct mcr_cell_analysis *cell, const struct mcr_study_cell *from, const struct sample_options *options)
{
    double mse = sample_mse(from->contestant, from->settings.spp);
    double time = sample_time(from->contestant, from->settings.spp, from->settings.depth);
    double metric[MCR_METRIC_COUNT];
    int unknown = options->unknown || !from->run_count;
    sample_metrics(metric, mse);
    cell->wall = (struct mcr_time_summary){from->run_count, sample_interval(time, .01, unknown),
                                           sample_interval(time * 1.001, .012, unknown), time * .97, time * 1.04};
    cell->cpu = (struct mcr_time_summary){from->run_count, sample_interval(time * 2, .01, unknown),
                                          sample_interval(time * 2, .012, unknown), time, time};
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++)
        cell->metric[m] = sample_interval(metric[m], .02, unknown);
    cell->error = sample_interval(mse, .05 + .2 / (1 + from->settings.spp), unknown);
    cell->efficiency = sample_interval(sample_mse(0, from->settings.spp) / mse * sample_time(0, from->settings.spp,
                                                                                             from->settings.depth) / time, .05, unknown);
    cell->speed = sample_interval(sample_time(0, from->settings.spp, from->settings.depth) / time, .01, unknown);
    cell->reference_share = unknown ? NAN : 1e-5 / mse;
    cell->marks = (from->coverage.complete ? 0 : MCR_MARK_INCOMPLETE | MCR_MARK_FLATTENS) | (mse < 2e-4 ? MCR_MARK_REFERENCE : 0) |
        (from->settings.compat ? MCR_MARK_COMPAT : 0);
}

static void sample_cells(struct sample *sample, const struct sample_options *options)
{
    struct mcr_study *study = &sample->study;
    uint64_t state = 5;
    for (uint32_t i = 0; i < study->cell_count; i++) {
        struct mcr_study_cell *cell = &study->cell[i];
        uint32_t c = i % options->contestants, s = i / options->contestants % options->spps, d = i / options->contestants / options->spps;
        cell->settings = (struct mcr_study_settings){.sampler = c, .spp = sample->spp[s], .depth = sample->depth[d],
                                                     .compat = options->compat && c == 3 ? sample->compat[1] : 0};
        cell->contestant = options->depths_compete ? d * options->contestants + c : c;
        cell->group = options->depths_compete ? s : d * options->spps + s;
        cell->series = c + options->contestants * d;
        cell->key = 0x1234 + i;
        cell->coverage.complete = c != 1;
        if (c == 1)
            snprintf(cell->coverage.missing, sizeof cell->coverage.missing, "what white reflects in directions without light");
        cell->bias_square = 1e-6;
        cell->bias_square_error = NAN;
        sample_runs(cell, sample, options, &state);
        char name[64];
        snprintf(name, sizeof name, "c%u-%u-%u.pfm", c, cell->settings.spp, cell->settings.depth);
        if (options->images && cell->run_count)
            cell->image = sample_write(sample, options, name, sqrt(sample_mse(c, cell->settings.spp)), i + 1);
        else if (options->lost_image && !i)
            cell->image = strdup("lost.pfm");
        sample_cell_analysis(&sample->analysis.cell[i], cell, options);
    }
}

static struct mcr_pair_test sample_test(double ratio, int excluded, int unknown)
{
    struct mcr_pair_test test = {sample_interval(ratio, .06, unknown), unknown ? NAN : .01, unknown ? NAN : .03, MCR_VERDICT_UNKNOWN, 0};
    if (excluded)
        test.verdict = MCR_VERDICT_EXCLUDED;
    else if (!unknown && (ratio > 1.06 || ratio < 1 / 1.06))
        test.verdict = ratio > 1 ? MCR_VERDICT_BETTER : MCR_VERDICT_WORSE;
    else if (!unknown)
        test.seeds_needed = 140;
    return test;
}

static void sample_pairs(struct sample *sample, const struct sample_options *options)
{
    const struct mcr_study *study = &sample->study;
    struct mcr_analysis *analysis = &sample->analysis;
    for (uint32_t a = 0; a < study->cell_count; a++) {
        for (uint32_t b = a + 1; b < study->cell_count; b++) {
            const struct mcr_study_cell *first = &study->cell[a], *second = &study->cell[b];
            if (first->group != second->group)
                continue;
            int excluded = !first->coverage.complete || !second->coverage.complete;
            double spp = sample_mse(second->contestant, second->settings.spp) / sample_mse(first->contestant, first->settings.spp);
            double time = spp * sample_time(second->contestant, second->settings.spp,
                                            second->settings.depth) / sample_time(first->contestant, first->settings.spp,
                                                                                  first->settings.depth);
            analysis->pair[analysis->pair_count++] =
                (struct mcr_pair_analysis){first->group, a, b, sample_test(time, excluded, options->unknown),
                                           sample_test(spp, excluded, options->unknown)};
        }
    }
}

static void sample_series(struct sample *sample, const struct sample_options *options)
{
    for (uint32_t i = 0; i < sample->study.series_count; i++) {
        struct mcr_series_analysis *series = &sample->analysis.series[i];
        uint32_t c = i % options->contestants, d = i / options->contestants;
        *series = (struct mcr_series_analysis){options->depths_compete ? i : c, sample->depth[d], options->spps,
                                               sample_interval(-1.003, .01, options->unknown),
                                               sample_interval(-1.01, .02, options->unknown),
                                                   sample_interval(0.8 + c, .1, options->unknown), c % 3,
                                               c == 1 ? MCR_MARK_INCOMPLETE | MCR_MARK_FLATTENS : 0};
        for (struct mcr_interval *slope = &series->slope; slope <= &series->time_slope; slope++) {
            double low = slope->high; /* negative values: the ends change places */
            slope->high = slope->low;
            slope->low = low;
        }
    }
}

static void sample_equal_time(struct sample *sample, const struct sample_options *options)
{
    struct mcr_study *study = &sample->study;
    study->equal_time_count = options->images ? study->contestant_count : 0;
    study->equal_time = calloc(study->equal_time_count + 1, sizeof *study->equal_time);
    study->equal_time_depth = sample->depth[options->depths - 1];
    study->equal_time_seconds = 0.6;
    for (uint32_t i = 0; i < study->equal_time_count; i++) {
        struct mcr_study_equal_time *render = &study->equal_time[i];
        char name[64];
        *render = (struct mcr_study_equal_time){.contestant = i, .spp = 100 + 17 * (i % 5), .wall_seconds = 0.6 + 0.001 * i};
        sample_metrics(render->metric, sample_mse(i, render->spp));
        snprintf(name, sizeof name, "equal-%u.pfm", i);
        render->image = sample_write(sample, options, name, sqrt(sample_mse(i, render->spp)), 1000 + i);
    }
}

/* Fills the study; the folder exists. */
static void sample_init(struct sample *sample, const struct sample_options *options, const char *folder)
{
    struct mcr_study *study = &sample->study;
    memset(sample, 0, sizeof *sample);
    snprintf(sample->folder, sizeof sample->folder, "%s", folder);
    sample_plan(sample, options);
    uint32_t depths = options->depths, cells = options->contestants * options->spps * depths;
    *study = (struct mcr_study){
        .plan = &sample->plan, .scene_path = "scenes/studies/cornell-variance.scn", .scene_hash = 0xfeedfacecafebeefu,
        .width = options->width, .height = options->height, .cell_count = cells,
        .contestant_count = options->contestants * (options->depths_compete ? depths : 1),
        .group_count = options->spps * (options->depths_compete ? 1 : depths), .series_count = options->contestants * depths,
        .contestant = sample->label, .reference_count = 1, .version = "0.1.0", .machine = "Linux 6.1 x86_64",
        .processor = "Some Processor at 3 GHz", .instruction_set = "avx2", .started = "2026-01-02T03:04:05Z",
        .command = "mcrender study scenes/studies/cornell-variance.scn --runs 10", .threads = 2};
    study->cell = calloc(cells, sizeof *study->cell);
    study->reference = calloc(1, sizeof *study->reference);
    sample->reference = options->images || options->lost_image ? sample_picture(options, 0, 1) : NULL;
    study->reference[0] = (struct mcr_study_reference){sample->depth[depths - 1], sample->reference, options->unknown ? NAN : 1e-5, 12.5};
    sample->analysis = (struct mcr_analysis){
        .cell = calloc(cells, sizeof *sample->analysis.cell), .series = calloc(study->series_count, sizeof *sample->analysis.series),
        .pair = calloc((size_t)cells * cells / 2 + 1, sizeof *sample->analysis.pair), .target = options->unknown ? NAN : 1e-3,
        .target_chosen = 1, .reference_noise = options->unknown ? NAN : 1e-5};
    sample_cells(sample, options);
    sample_pairs(sample, options);
    sample_series(sample, options);
    sample_equal_time(sample, options);
}

static void sample_fini(struct sample *sample)
{
    for (uint32_t i = 0; i < sample->study.cell_count; i++) {
        free((char *)sample->study.cell[i].image);
        free(sample->study.cell[i].run);
    }
    for (uint32_t i = 0; i < sample->study.equal_time_count; i++)
        free((char *)sample->study.equal_time[i].image);
    free(sample->study.cell);
    free(sample->study.equal_time);
    free(sample->study.reference);
    free(sample->analysis.cell);
    free(sample->analysis.series);
    free(sample->analysis.pair);
    mcr_image_destroy(sample->reference);
}

#endif
