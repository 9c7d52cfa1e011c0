/* SPDX-License-Identifier: Apache-2.0 */
/* Studies without rendering: a plan, cells and runs in memory, to be filled by a test. Contestants are samplers; one depth, one reference. */
#ifndef TESTS_STUDY_SYNTHETIC_H
#define TESTS_STUDY_SYNTHETIC_H

#include <math.h>
#include <stdlib.h>

#include "base/random.h"
#include "study/analysis.h"

#define MOST_SPP 8u

struct synthetic {
    struct mcr_study study;
    struct mcr_study_plan plan;
    struct mcr_study_reference reference;
    uint32_t spp[MOST_SPP], depth[1], zero[1], one[1];
    struct mcr_study_cell *cell;
};

/* samplers times the spp of a list that ends in 0; each cell with `runs` runs, timed and measured, of mse NaN and 1 second. The reference has no
 * noise. The cell of sampler s and the k-th spp is cell[s * spp_count + k]. */
static inline struct synthetic *synthetic_create(uint32_t samplers, const uint32_t *spp, uint32_t runs)
{
    struct synthetic *s = calloc(1, sizeof *s);
    uint32_t count = 0;
    for (; spp[count]; count++)
        s->spp[count] = spp[count];
    s->depth[0] = 5;
    s->one[0] = 1;
    s->plan = (struct mcr_study_plan){.sampler_count = samplers, .spp_count = count, .depth_count = 1, .precision_count = 1, .accel_count = 1,
        .roulette_count = 1, .compat_count = 1, .spp = s->spp, .depth = s->depth, .precision = s->zero, .accel = s->zero, .roulette = s->one,
        .compat = s->zero, .runs = runs, .seeds = runs, .first_seed = 1, .confidence = 0.95, .metrics = 1u << MCR_METRIC_MSE};
    s->reference = (struct mcr_study_reference){.depth = 5};
    s->cell = calloc((size_t)samplers * count, sizeof *s->cell);
    s->study = (struct mcr_study){.plan = &s->plan, .width = 16, .height = 16, .cell_count = samplers * count, .cell = s->cell,
        .contestant_count = samplers, .group_count = count, .series_count = samplers, .reference_count = 1, .reference = &s->reference};
    for (uint32_t i = 0; i < samplers * count; i++) {
        struct mcr_study_cell *cell = &s->cell[i];
        cell->settings = (struct mcr_study_settings){.sampler = i / count, .spp = spp[i % count], .depth = 5, .roulette = 1};
        cell->contestant = cell->series = i / count;
        cell->group = i % count;
        cell->run_count = runs;
        cell->run = calloc(runs, sizeof *cell->run);
        cell->coverage.complete = 1;
        cell->bias_square = cell->bias_square_error = NAN;
        for (uint32_t k = 0; k < runs; k++) {
            for (uint32_t metric = 0; metric < MCR_METRIC_COUNT; metric++)
                cell->run[k].metric[metric] = NAN;
            cell->run[k].seed = 1 + k;
            cell->run[k].wall_seconds = cell->run[k].cpu_seconds = 1;
        }
    }
    return s;
}

static inline void synthetic_destroy(struct synthetic *s)
{
    for (uint32_t i = 0; i < s->study.cell_count; i++)
        free(s->cell[i].run);
    free(s->cell);
    free(s);
}

/* ---- numbers: one stream a program ---- */

static uint64_t synthetic_state = 1;

static inline double uniform(void)
{
    return mcr_unit_double(mcr_mix64(synthetic_state++ * MCR_GOLDEN)) + 0x1p-54;
}

/* G. E. P. Box and M. E. Muller (1958): two at a time. */
static inline double gaussian(void)
{
    static double spare;
    static int has_spare;
    double r, sine, cosine;
    has_spare = !has_spare;
    if (!has_spare)
        return spare;
    r = sqrt(-2 * mcr_log(uniform()));
    mcr_sincos_turns(uniform(), &sine, &cosine);
    spare = r * sine;
    return r * cosine;
}

/* Mean 1, variance 1 / shape: the mean square of 2 shape independent Gaussian values. G. Marsaglia and W. W. Tsang (2000); shape >= 1. */
static inline double gamma_number(double shape)
{
    double d = shape - 1.0 / 3, c = 1 / sqrt(9 * d);
    for (;;) {
        double x = gaussian(), v = 1 + c * x;
        v = v * v * v;
        if (v > 0 && mcr_log(uniform()) < 0.5 * x * x + d - d * v + d * mcr_log(v))
            return d * v / shape;
    }
}

#endif
