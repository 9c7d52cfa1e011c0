/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Cells whose error does not fall as an unbiased one must, and cells whose mean is not the reference. Both kinds of tests are one family (Holm).
 *
 * FLATTENS: with a bias b the error is variance / spp + b^2. Tested from the previous and from the first spp of the series: the error falls more slowly
 * than spp^-0.9 (so that -1 is nowhere near the border). Rare bright samples that no seed met at few spp look the same, and so do numbers of strata
 * that happen to be bad: therefore a cell is only marked where bias_square, which noise does not disturb, does not rule out that the excess is a bias.
 * Where the reference's noise is unknown, the most that it can be is taken off first.
 * BIASED: bias_square above 0 against its standard error over the pixels, and above a share of the cell's error.
 * Errors in encoded values fall in other ways (clipping, rounding to codes) and are no measure for bias_square: then BIASED goes by significance alone.
 */
#include <stdlib.h>

#include "base/elementary.h"
#include "base/memory.h"
#include "base/distributions.h"
#include "study/inference.h"

#define FLAT_SLOPE -0.9
#define NOTABLE_BIAS 0.01 /* of the cell's error: a tenth of the noise */

struct suspicion {
    uint32_t cell, mark;
    int relevant;
};

struct suspicions {
    struct suspicion *list;
    double *p;
    uint32_t count;
};

static void suspect(struct suspicions *all, uint32_t cell, uint32_t mark, double p, int relevant)
{
    if (p != p)
        return;
    all->p[all->count] = p;
    all->list[all->count++] = (struct suspicion){cell, mark, relevant};
}

static double mean_error(const struct mcr_inference *in, uint32_t c)
{
    return in->analysis->cell[c].metric[MCR_METRIC_MSE].value - in->data[c].noise_at_most;
}

/* 1 if bias_square may be as large as what the error is above variance / spp. */
static int bias_possible(const struct mcr_inference *in, uint32_t from, uint32_t to)
{
    const struct mcr_study_cell *cell = &in->study->cell[to];
    double fewer = (double)in->study->cell[from].settings.spp / cell->settings.spp;
    double excess = mean_error(in, to) - mean_error(in, from) * fewer;
    double most = cell->bias_square + mcr_normal_quantile(in->confidence) * cell->bias_square_error;
    return !(most < excess); /* where it is unknown, it is possible */
}

static void test_slope(const struct mcr_inference *in, uint32_t from, uint32_t to, struct suspicions *all)
{
    const struct mcr_study_cell *a = &in->study->cell[from], *b = &in->study->cell[to];
    struct mcr_term term[2] = {{in->data[to].mse, in->data[to].noise_at_most, 1.0}, {in->data[from].mse, in->data[from].noise_at_most, -1.0}};
    double distance = in->data[to].reference_sd - in->data[from].reference_sd, steps;
    struct mcr_estimate e;
    if (a->settings.spp == b->settings.spp || a->settings.spp == 0)
        return;
    steps = mcr_log((double)b->settings.spp / a->settings.spp);
    e = mcr_contrast_errors(term, 2, in->runs, in->floor, in->scratch);
    e.variance += distance * distance;
    suspect(all, to, MCR_MARK_FLATTENS, mcr_estimate_p_above(e, FLAT_SLOPE * steps), bias_possible(in, from, to));
}

static uint64_t pixels(const struct mcr_study *study)
{
    const struct mcr_metrics_options *how = &study->plan->how;
    uint64_t width = how->has_crop ? how->crop[2] - how->crop[0] : study->width, height = how->has_crop ? how->crop[3] - how->crop[1] : study->height;
    return width * height;
}

static void test_bias(const struct mcr_inference *in, uint32_t c, struct suspicions *all)
{
    const struct mcr_study_cell *cell = &in->study->cell[c];
    double error = in->analysis->cell[c].metric[MCR_METRIC_MSE].value - in->data[c].noise, degrees = (double)pixels(in->study) - 1.0;
    struct mcr_estimate e = {cell->bias_square, cell->bias_square_error * cell->bias_square_error, degrees};
    int notable = !in->linear || (e.value > in->floor && e.value > NOTABLE_BIAS * error);
    if (cell->run_count >= 2)
        suspect(all, c, MCR_MARK_BIASED, mcr_estimate_p_above(e, 0.0), notable);
}

static void collect(const struct mcr_inference *in, struct suspicions *all)
{
    uint32_t first = 0;
    for (uint32_t i = 0; i < in->study->cell_count; i++) {
        const struct mcr_cell_place *place = &in->by_series[i];
        if (i && place->major != place[-1].major)
            first = i;
        if (i > first && in->linear)
            test_slope(in, place[-1].cell, place->cell, all);
        if (i > first + 1 && in->linear)
            test_slope(in, in->by_series[first].cell, place->cell, all);
        test_bias(in, place->cell, all);
    }
}

int mcr_analyse_marks(struct mcr_inference *in)
{
    struct suspicions all = {0};
    size_t most;
    int status = -1;
    if (!mcr_size_mul(in->study->cell_count, 3, &most))
        return -1;
    all.list = mcr_array_alloc(most, sizeof *all.list);
    all.p = mcr_array_alloc(most, sizeof *all.p);
    if (all.list && all.p) {
        collect(in, &all);
        status = mcr_holm(all.p, all.p, all.count);
    }
    for (uint32_t i = 0; status == 0 && i < all.count; i++) {
        if (all.p[i] <= 1.0 - in->confidence && all.list[i].relevant)
            in->analysis->cell[all.list[i].cell].marks |= all.list[i].mark;
    }
    free(all.list);
    free(all.p);
    return status;
}
