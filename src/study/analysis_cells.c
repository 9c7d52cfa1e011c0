/* SPDX-License-Identifier: Apache-2.0 */
/* What a cell says by itself: times, metrics, error; and what may be said about the references' noise. */
#include "base/elementary.h"
#include "study/inference.h"

#define NOTABLE_SHARE 0.05 /* of the reference's noise in a cell's mse */

/* ---- times ---- */

static double run_wall(const struct mcr_study_run *run) { return run->wall_seconds; }
static double run_cpu(const struct mcr_study_run *run) { return run->cpu_seconds; }

static void summarise_times(const struct mcr_inference *in, const struct mcr_study_cell *cell, double (*seconds)(const struct mcr_study_run *),
                            struct mcr_time_summary *r)
{
    r->runs = 0;
    for (uint32_t i = 0; i < cell->run_count && i < in->study->plan->runs; i++) {
        double x = seconds(&cell->run[i]);
        if (fabs(x) < MCR_INFINITY)
            in->scratch[r->runs++] = x;
    }
    mcr_sort(in->scratch, r->runs);
    r->trimmed = mcr_estimate_interval(mcr_trimmed_mean(in->scratch, r->runs, r->runs >= 3 ? 1 : 0), in->confidence);
    r->median = mcr_median(in->scratch, r->runs, in->confidence);
    r->lowest = r->runs ? in->scratch[0] : MCR_NAN;
    r->highest = r->runs ? in->scratch[r->runs - 1] : MCR_NAN;
}

/* ---- metrics ---- */

static int on_logarithm(uint32_t metric)
{
    return metric == MCR_METRIC_MSE || metric == MCR_METRIC_RMSE || metric == MCR_METRIC_MAE || metric == MCR_METRIC_RELMSE;
}

/* The values of a metric over the seeds that have one; 0 where one of them is infinite. */
static uint32_t gather(const struct mcr_inference *in, const struct mcr_study_cell *cell, uint32_t metric)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < cell->run_count && i < in->study->plan->seeds; i++) {
        double x = cell->run[i].metric[metric];
        if (fabs(x) == MCR_INFINITY)
            return 0;
        if (x == x)
            in->values[count++] = x;
    }
    return count;
}

static struct mcr_interval summarise_metric(const struct mcr_inference *in, const struct mcr_study_cell *cell, uint32_t metric)
{
    uint32_t count = gather(in, cell, metric);
    struct mcr_estimate mean = mcr_mean(in->values, count);
    struct mcr_interval r = mcr_estimate_interval(mean, in->confidence);
    if (on_logarithm(metric) && mean.value > 0.0 && mean.variance > 0.0) {
        struct mcr_term term = {in->values, 0.0, 1.0};
        r = mcr_estimate_exp_interval(mcr_contrast_errors(&term, 1, count, 0.0, in->scratch), in->confidence);
        r.value = mean.value;
    }
    return r;
}

/* ---- references ---- */

/* The noise that a reference happens to have, mean e_ref^2, scatters about its expectation as the mse of a cell does over its seeds: so the relative
 * variance of one seed's mse, averaged over the reference's cells at their highest spp. 0: none has two seeds. */
static double noise_variance(const struct mcr_inference *in, uint32_t reference)
{
    const struct mcr_study *study = in->study;
    double sum = 0.0;
    uint32_t highest = 0, count = 0;
    for (uint32_t c = 0; c < study->cell_count; c++) {
        const struct mcr_study_cell *cell = &study->cell[c];
        struct mcr_term term = {in->data[c].mse, 0.0, 1.0};
        struct mcr_estimate e;
        if (cell->reference != reference || cell->settings.spp < highest)
            continue;
        e = mcr_contrast_errors(&term, 1, in->runs, in->floor, in->scratch);
        if (!(e.variance >= 0.0))
            continue;
        if (cell->settings.spp > highest) {
            highest = cell->settings.spp;
            sum = 0.0;
            count = 0;
        }
        sum += e.variance * (e.df + 1.0);
        count++;
    }
    return count ? sum / count : 0.0;
}

/* Unknown noise is part of every mse measured against it: at most what the least of them may be. */
static double noise_bound(const struct mcr_inference *in, uint32_t reference)
{
    double bound = MCR_INFINITY;
    for (uint32_t c = 0; c < in->study->cell_count; c++) {
        double high = in->analysis->cell[c].metric[MCR_METRIC_MSE].high;
        if (in->study->cell[c].reference == reference && high < bound)
            bound = high;
    }
    return bound;
}

static void analyse_reference(const struct mcr_inference *in, uint32_t reference)
{
    const struct mcr_study *study = in->study;
    double noise = reference < study->reference_count ? study->reference[reference].noise : MCR_NAN;
    int known = in->linear && noise >= 0.0 && noise < MCR_INFINITY;
    double at_most = known ? noise : noise_bound(in, reference), variance = known && noise > 0.0 ? noise_variance(in, reference) : 0.0;
    for (uint32_t c = 0; c < study->cell_count; c++) {
        struct mcr_cell_data *data = &in->data[c];
        double mse = in->analysis->cell[c].metric[MCR_METRIC_MSE].value;
        if (study->cell[c].reference != reference)
            continue;
        data->noise = known ? noise : 0.0;
        data->noise_at_most = at_most;
        data->reference_sd = mse > data->noise ? data->noise / (mse - data->noise) * sqrt(variance) : 0.0;
        in->analysis->cell[c].reference_share = known && mse > 0.0 ? noise / mse : MCR_NAN;
    }
    if (known && !(in->analysis->reference_noise >= noise))
        in->analysis->reference_noise = noise;
}

/* ---- cells ---- */

static uint32_t own_marks(const struct mcr_study_cell *cell, double reference_share)
{
    uint32_t marks = cell->coverage.complete ? 0 : MCR_MARK_INCOMPLETE;
    marks |= cell->settings.compat ? MCR_MARK_COMPAT : 0;
    marks |= reference_share > NOTABLE_SHARE ? MCR_MARK_REFERENCE : 0;
    for (uint32_t i = 0; i < cell->run_count; i++)
        marks |= cell->run[i].not_finite ? MCR_MARK_NOT_FINITE : 0;
    return marks;
}

static void analyse_error(const struct mcr_inference *in, uint32_t c)
{
    struct mcr_cell_analysis *r = &in->analysis->cell[c];
    const struct mcr_cell_data *data = &in->data[c];
    struct mcr_term term = {data->mse, data->noise, 1.0};
    struct mcr_estimate e = mcr_contrast_errors(&term, 1, in->runs, in->floor, in->scratch);
    e.variance += data->reference_sd * data->reference_sd;
    r->error = mcr_estimate_exp_interval(e, in->confidence);
}

void mcr_analyse_cells(struct mcr_inference *in)
{
    const struct mcr_study *study = in->study;
    in->analysis->reference_noise = MCR_NAN;
    for (uint32_t c = 0; c < study->cell_count; c++) {
        struct mcr_cell_analysis *r = &in->analysis->cell[c];
        struct mcr_term term = {in->data[c].log_wall, 0.0, 1.0};
        summarise_times(in, &study->cell[c], run_wall, &r->wall);
        summarise_times(in, &study->cell[c], run_cpu, &r->cpu);
        for (uint32_t metric = 0; metric < MCR_METRIC_COUNT; metric++)
            r->metric[metric] = summarise_metric(in, &study->cell[c], metric);
        in->data[c].log_time = mcr_contrast_times(&term, 1, in->runs, in->scratch).value;
        r->efficiency = mcr_interval_unknown();
        r->speed = mcr_interval_unknown();
    }
    for (uint32_t reference = 0; reference < study->reference_count; reference++)
        analyse_reference(in, reference);
    for (uint32_t c = 0; c < study->cell_count; c++) {
        analyse_error(in, c);
        in->analysis->cell[c].marks = own_marks(&study->cell[c], in->analysis->cell[c].reference_share);
    }
}
