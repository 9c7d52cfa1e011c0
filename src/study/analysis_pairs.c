/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Contestants against the baseline and against each other, within groups.
 *
 * Equal runs of two cells share their seed, and through it some or all of their random numbers: their errors are compared run by run. Two cells that
 * make the same image bit by bit then differ by nothing at all, and are never better than each other. Without any dependence between the cells this
 * costs n - 1 degrees of freedom in the place of 2 (n - 1).
 */
#include <stdlib.h>

#include "base/elementary.h"
#include "base/memory.h"
#include "study/inference.h"

#define POWER 0.8
#define MOST_SEEDS 1000000u
#define SAME 1e-9 /* a difference of logarithms that is rounding: sums over images agree to about 1e-13 */

struct mcr_estimate mcr_error_ratio(const struct mcr_inference *in, uint32_t a, uint32_t b)
{
    struct mcr_term term[2] = {{in->data[a].mse, in->data[a].noise, 1.0}, {in->data[b].mse, in->data[b].noise, -1.0}};
    struct mcr_estimate e = mcr_contrast_errors(term, 2, in->runs, in->floor, in->scratch);
    double distance = in->data[a].reference_sd - in->data[b].reference_sd; /* one reference: one chance */
    e.variance += distance * distance;
    return e;
}

struct mcr_estimate mcr_time_ratio(const struct mcr_inference *in, uint32_t a, uint32_t b)
{
    struct mcr_term term[2] = {{in->data[a].log_wall, 0.0, 1.0}, {in->data[b].log_wall, 0.0, -1.0}};
    return mcr_contrast_times(term, 2, in->runs, in->scratch);
}

/* ---- the baseline ---- */

static uint32_t position(const uint32_t *list, uint32_t count, uint32_t value)
{
    uint32_t i = 0;
    while (i < count && list[i] != value)
        i++;
    return i;
}

/* 1 if x comes before y: by how early each setting stands in the plan's lists. */
static int earlier(const struct mcr_study_plan *plan, const struct mcr_study_settings *x, const struct mcr_study_settings *y)
{
    uint32_t a[5] = {position(plan->depth, plan->depth_count, x->depth), position(plan->precision, plan->precision_count, x->precision),
                     position(plan->accel, plan->accel_count, x->accel), position(plan->roulette, plan->roulette_count, (uint32_t)x->roulette),
                     position(plan->compat, plan->compat_count, x->compat)};
    uint32_t b[5] = {position(plan->depth, plan->depth_count, y->depth), position(plan->precision, plan->precision_count, y->precision),
                     position(plan->accel, plan->accel_count, y->accel), position(plan->roulette, plan->roulette_count, (uint32_t)y->roulette),
                     position(plan->compat, plan->compat_count, y->compat)};
    for (int i = 0; i < 5; i++) {
        if (a[i] != b[i])
            return a[i] < b[i];
    }
    return 0;
}

/* The cell of the group that has the baseline's sampler and otherwise the plan's first settings; cell_count: none. */
static uint32_t find_baseline(const struct mcr_study *study, const struct mcr_cell_place *place, uint32_t count)
{
    uint32_t found = study->cell_count;
    for (uint32_t i = 0; i < count; i++) {
        const struct mcr_study_settings *settings = &study->cell[place[i].cell].settings;
        if (settings->sampler != study->plan->baseline)
            continue;
        if (found == study->cell_count || earlier(study->plan, settings, &study->cell[found].settings))
            found = place[i].cell;
    }
    return found;
}

static void against_baseline(const struct mcr_inference *in, const struct mcr_cell_place *place, uint32_t count)
{
    uint32_t baseline = find_baseline(in->study, place, count);
    for (uint32_t i = 0; baseline < in->study->cell_count && i < count; i++) {
        struct mcr_cell_analysis *r = &in->analysis->cell[place[i].cell];
        struct mcr_estimate error = mcr_error_ratio(in, baseline, place[i].cell), time = mcr_time_ratio(in, baseline, place[i].cell);
        r->speed = mcr_estimate_exp_interval(time, in->confidence);
        r->efficiency = mcr_estimate_exp_interval(mcr_estimate_add(error, 1.0, time, 1.0), in->confidence);
    }
}

/* ---- pairs ---- */

static int left_out(const struct mcr_inference *in, const struct mcr_pair_analysis *pair)
{
    return ((in->analysis->cell[pair->cell_a].marks | in->analysis->cell[pair->cell_b].marks) & MCR_MARKS_LEFT_OUT) != 0;
}

static void test_pair(const struct mcr_inference *in, struct mcr_estimate goodness, struct mcr_pair_test *r)
{
    if (fabs(goodness.value) <= SAME)
        goodness.value = 0.0;
    r->ratio = mcr_estimate_exp_interval(goodness, in->confidence);
    r->p = mcr_estimate_p(goodness);
    r->p_holm = MCR_NAN;
    r->verdict = MCR_VERDICT_UNKNOWN;
}

typedef struct mcr_pair_test *test_of(struct mcr_pair_analysis *pair);

/* Verdicts of one kind of test over the pairs of a group. */
static int decide(const struct mcr_inference *in, struct mcr_pair_analysis *pair, uint32_t count, test_of *kind)
{
    double *p = mcr_array_alloc(count, sizeof *p);
    int status;
    if (!p)
        return -1;
    for (uint32_t i = 0; i < count; i++)
        p[i] = left_out(in, &pair[i]) ? MCR_NAN : kind(&pair[i])->p;
    status = mcr_holm(p, p, count);
    for (uint32_t i = 0; i < count; i++) {
        struct mcr_pair_test *test = kind(&pair[i]);
        test->p_holm = p[i];
        if (left_out(in, &pair[i]))
            test->verdict = MCR_VERDICT_EXCLUDED;
        else if (p[i] <= 1.0 - in->confidence)
            test->verdict = test->ratio.value > 1.0 ? MCR_VERDICT_BETTER : MCR_VERDICT_WORSE;
    }
    free(p);
    return status;
}

static struct mcr_pair_test *equal_spp(struct mcr_pair_analysis *pair) { return &pair->equal_spp; }
static struct mcr_pair_test *equal_time(struct mcr_pair_analysis *pair) { return &pair->equal_time; }

/* The level of the next of Holm's tests: those of the pairs that are not decided share what is allowed. */
static double next_level(const struct mcr_inference *in, struct mcr_pair_analysis *pair, uint32_t count, test_of *kind)
{
    uint32_t open = 0;
    for (uint32_t i = 0; i < count; i++)
        open += kind(&pair[i])->verdict == MCR_VERDICT_UNKNOWN && kind(&pair[i])->p_holm == kind(&pair[i])->p_holm;
    return (1.0 - in->confidence) / (open ? open : 1);
}

static uint32_t seeds_for(double goodness, double spread, double fixed, double level, double runs)
{
    return mcr_sample_size(goodness, spread, fixed, level, POWER, (uint32_t)runs, MOST_SEEDS);
}

static void announce_seeds(const struct mcr_inference *in, struct mcr_pair_analysis *pair, double level_spp, double level_time)
{
    struct mcr_estimate error = mcr_error_ratio(in, pair->cell_a, pair->cell_b), time = mcr_time_ratio(in, pair->cell_a, pair->cell_b);
    double distance = in->data[pair->cell_a].reference_sd - in->data[pair->cell_b].reference_sd, fixed = distance * distance;
    double seeds = error.df + 1.0, runs = time.df + 1.0, spread = (error.variance - fixed) * seeds;
    if (error.variance != error.variance)
        return;
    if (pair->equal_spp.verdict == MCR_VERDICT_UNKNOWN)
        pair->equal_spp.seeds_needed = seeds_for(mcr_log(pair->equal_spp.ratio.value), spread, fixed, level_spp, seeds);
    if (pair->equal_time.verdict == MCR_VERDICT_UNKNOWN && time.variance == time.variance)
        pair->equal_time.seeds_needed = seeds_for(mcr_log(pair->equal_time.ratio.value), spread + time.variance * runs, fixed, level_time, seeds);
}

static int analyse_group(const struct mcr_inference *in, const struct mcr_cell_place *place, uint32_t count, struct mcr_pair_analysis *pair)
{
    uint32_t pairs = 0;
    double level_spp, level_time;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = i + 1; j < count; j++) {
            struct mcr_pair_analysis *r = &pair[pairs++];
            struct mcr_estimate error, time;
            *r = (struct mcr_pair_analysis){.group = place[i].major, .cell_a = place[i].cell, .cell_b = place[j].cell};
            error = mcr_error_ratio(in, r->cell_b, r->cell_a);
            time = mcr_time_ratio(in, r->cell_b, r->cell_a);
            test_pair(in, error, &r->equal_spp);
            test_pair(in, mcr_estimate_add(error, 1.0, time, 1.0), &r->equal_time);
        }
    }
    if (decide(in, pair, pairs, equal_spp) != 0 || decide(in, pair, pairs, equal_time) != 0)
        return -1;
    level_spp = next_level(in, pair, pairs, equal_spp);
    level_time = next_level(in, pair, pairs, equal_time);
    for (uint32_t i = 0; i < pairs; i++)
        announce_seeds(in, &pair[i], level_spp, level_time);
    return 0;
}

static uint32_t group_length(const struct mcr_inference *in, uint32_t first)
{
    uint32_t end = first;
    while (end < in->study->cell_count && in->by_group[end].major == in->by_group[first].major)
        end++;
    return end - first;
}

int mcr_analyse_pairs(struct mcr_inference *in)
{
    struct mcr_analysis *analysis = in->analysis;
    uint64_t pairs = 0, done = 0;
    for (uint32_t i = 0, n; i < in->study->cell_count; i += n) {
        n = group_length(in, i);
        pairs += (uint64_t)n * (n - 1) / 2;
        against_baseline(in, &in->by_group[i], n);
    }
    if (pairs > MCR_MOST_PAIRS)
        return 0;
    analysis->pair = mcr_array_alloc((size_t)pairs, sizeof *analysis->pair);
    if (!analysis->pair)
        return -1;
    for (uint32_t i = 0, n; i < in->study->cell_count; i += n) {
        n = group_length(in, i);
        if (analyse_group(in, &in->by_group[i], n, analysis->pair + done) != 0)
            return -1;
        done += (uint64_t)n * (n - 1) / 2;
    }
    analysis->pair_count = (uint32_t)done;
    return 0;
}
