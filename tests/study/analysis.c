/* SPDX-License-Identifier: Apache-2.0 */
/* The analysis on small studies worked out by hand: few data, none, strange ones; marks, ratios, slopes, times. Rates are in synthetic.c. */
#include "../tap.h"
#include "base/elementary.h"
#include "study/synthetic.h"

#define T_975_1 12.706204736174694 /* t quantiles: tests/base/distributions.c */
#define T_975_2 4.3026527297494618

static const uint32_t one_spp[] = {16, 0}, three_spp[] = {1, 10, 100, 0};

static int near(double value, double truth)
{
    return fabs(value - truth) <= 1e-10 * fabs(truth);
}

static int is(const struct mcr_interval *i, double value, double low, double high)
{
    return near(i->value, value) && near(i->low, low) && near(i->high, high);
}

static int is_nothing(const struct mcr_interval *i)
{
    return isnan(i->value) && isnan(i->low) && isnan(i->high);
}

static int is_bare(const struct mcr_interval *i, double value)
{
    return near(i->value, value) && isnan(i->low) && isnan(i->high);
}

static void set_mse(struct mcr_study_cell *cell, const double *mse)
{
    for (uint32_t i = 0; i < cell->run_count; i++)
        cell->run[i].metric[MCR_METRIC_MSE] = mse[i];
}

static void set_wall(struct mcr_study_cell *cell, const double *seconds)
{
    for (uint32_t i = 0; i < cell->run_count; i++)
        cell->run[i].wall_seconds = seconds[i];
}

/* ---- few and strange data ---- */

static void test_few(void)
{
    struct synthetic *s = synthetic_create(2, one_spp, 2);
    struct mcr_analysis *a;
    double half = T_975_1 * log(3) / 2; /* pseudo-values of 1 and 3: 2 log 2 - log 3 and 2 log 2 - log 1 */
    set_mse(&s->cell[0], (const double[]){1, 3});
    set_mse(&s->cell[1], (const double[]){4, 5});
    a = mcr_analysis_create(&s->study);
    ok(is(&a->cell[0].error, 2, 2 * exp(-half), 2 * exp(half)) && is(&a->cell[0].metric[MCR_METRIC_MSE], 2, 2 * exp(-half), 2 * exp(half)),
       "two seeds: t with one degree of freedom");
    ok(a->pair_count == 1 && near(a->pair->equal_spp.ratio.value, 2.25) && a->pair->equal_spp.verdict == MCR_VERDICT_UNKNOWN &&
       a->pair->equal_spp.seeds_needed >= 3, "two seeds seldom tell; %u are asked for", a->pair->equal_spp.seeds_needed);
    mcr_analysis_destroy(a);
    s->cell[0].run_count = s->cell[1].run_count = 1;
    a = mcr_analysis_create(&s->study);
    ok(is_bare(&a->cell[0].error, 1) && is_bare(&a->cell[0].wall.trimmed, 1) && is_bare(&a->cell[0].wall.median, 1) && a->cell[0].wall.runs == 1,
       "one seed, one run: values without intervals");
    ok(is_bare(&a->pair->equal_spp.ratio, 4) && isnan(a->pair->equal_spp.p) && isnan(a->pair->equal_spp.p_holm) &&
       a->pair->equal_spp.verdict == MCR_VERDICT_UNKNOWN && a->pair->equal_spp.seeds_needed == 0 && is_bare(&a->cell[1].efficiency, 0.25),
       "and ratios, without a verdict or a number of seeds");
    mcr_analysis_destroy(a);
    s->cell[1].run_count = 0;
    a = mcr_analysis_create(&s->study);
    ok(is_nothing(&a->cell[1].error) && is_nothing(&a->cell[1].wall.trimmed) && a->cell[1].wall.runs == 0 && isnan(a->cell[1].wall.lowest) &&
       is_nothing(&a->pair->equal_time.ratio) && a->pair->equal_time.verdict == MCR_VERDICT_UNKNOWN && is_nothing(&a->cell[1].efficiency) &&
       is_nothing(&a->series[1].slope) && a->series[1].target == MCR_TARGET_UNKNOWN, "no run: nothing");
    mcr_analysis_destroy(a);
    s->cell[0].run_count = 0;
    a = mcr_analysis_create(&s->study);
    ok(isnan(a->target) && a->target_chosen && a->reference_noise == 0, "no run at all: no target");
    mcr_analysis_destroy(a);
    s->study.cell_count = s->study.series_count = 0;
    a = mcr_analysis_create(&s->study);
    ok(a && a->pair_count == 0, "no cell");
    mcr_analysis_destroy(a);
    s->study.cell_count = 2;
    synthetic_destroy(s);
}

static void test_uneven(void)
{
    struct synthetic *s = synthetic_create(2, one_spp, 4);
    struct mcr_analysis *a;
    struct mcr_interval three;
    set_mse(&s->cell[0], (const double[]){1, 2, 4, 8});
    set_mse(&s->cell[1], (const double[]){2, 3, 9, NAN});
    a = mcr_analysis_create(&s->study);
    three = a->pair->equal_spp.ratio;
    ok(near(a->cell[0].error.value, 3.75) && near(a->cell[1].error.value, 14.0 / 3) && near(three.value, 2),
       "a ratio is of the seeds that both cells have");
    mcr_analysis_destroy(a);
    s->cell[1].run_count = 3;
    s->cell[0].run[3].metric[MCR_METRIC_MSE] = 1e9;
    a = mcr_analysis_create(&s->study);
    ok(is(&a->pair->equal_spp.ratio, 2, three.low, three.high), "a run less is the same as one without a value");
    mcr_analysis_destroy(a);
    s->cell[0].run[1].metric[MCR_METRIC_MSE] = NAN;
    a = mcr_analysis_create(&s->study);
    ok(near(a->pair->equal_spp.ratio.value, 11.0 / 5), "whichever of the two lacks it");
    mcr_analysis_destroy(a);
    s->cell[0].run[1].metric[MCR_METRIC_MSE] = 2;
    s->plan.seeds = 2;
    s->plan.runs = 3;
    set_wall(&s->cell[0], (const double[]){1, 2, 6, 1e9});
    a = mcr_analysis_create(&s->study);
    ok(near(a->cell[0].error.value, 1.5) && a->cell[0].wall.runs == 3 && is_bare(&a->cell[0].wall.trimmed, 2) && a->cell[0].wall.highest == 6,
       "runs beyond the planned seeds are not measured, beyond the planned runs not timed");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

static void test_strange(void)
{
    struct synthetic *s = synthetic_create(2, one_spp, 3);
    struct mcr_analysis *a;
    const struct mcr_interval *mse;
    set_mse(&s->cell[0], (const double[]){0, 0, 0});
    set_mse(&s->cell[1], (const double[]){0, 0, 3});
    s->cell[0].run[1].metric[MCR_METRIC_PSNR] = INFINITY;
    s->cell[1].run[0].metric[MCR_METRIC_PSNR] = 20;
    s->cell[1].run[2].metric[MCR_METRIC_PSNR] = 22;
    a = mcr_analysis_create(&s->study);
    mse = &a->cell[0].metric[MCR_METRIC_MSE];
    ok(mse->value == 0 && mse->low == 0 && mse->high == 0 && is_nothing(&a->cell[0].error),
       "no error at all: an mse of 0, no error to take logarithms of");
    ok(is_bare(&a->cell[1].error, 1) && is_nothing(&a->pair->equal_spp.ratio) && a->pair->equal_spp.verdict == MCR_VERDICT_UNKNOWN,
       "one seed holds all of the error: a value without interval; against none no verdict");
    ok(is_nothing(&a->cell[0].metric[MCR_METRIC_PSNR]) && is(&a->cell[1].metric[MCR_METRIC_PSNR], 21, 21 - T_975_1, 21 + T_975_1) &&
       is_nothing(&a->cell[1].metric[MCR_METRIC_SSIM]), "an infinite value, a missing one, none");
    mcr_analysis_destroy(a);
    set_mse(&s->cell[0], (const double[]){2, 2, 2});
    set_mse(&s->cell[1], (const double[]){3, 3, 3});
    a = mcr_analysis_create(&s->study);
    ok(is(&a->cell[0].error, 2, 2, 2) && is(&a->pair->equal_spp.ratio, 1.5, 1.5, 1.5) && a->pair->equal_spp.verdict == MCR_VERDICT_BETTER,
       "equal runs: no width, and any difference tells");
    mcr_analysis_destroy(a);
    set_mse(&s->cell[0], (const double[]){1e-32, 2e-32, 3e-32});
    set_mse(&s->cell[1], (const double[]){3e-31, 3e-31, 3e-31});
    a = mcr_analysis_create(&s->study);
    ok(is_nothing(&a->pair->equal_spp.ratio) && a->pair->equal_spp.verdict == MCR_VERDICT_UNKNOWN, "two errors that are rounding are not compared");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

/* Cells that render the same bits, e.g. list against bvh: what the one seed does, the other does. */
static void test_same_bits(void)
{
    struct synthetic *s = synthetic_create(2, one_spp, 5);
    struct mcr_analysis *a;
    const double mse[5] = {1, 1.1, 0.9, 1.3, 0.8};
    set_mse(&s->cell[0], mse);
    set_mse(&s->cell[1], mse);
    s->cell[1].run[2].metric[MCR_METRIC_MSE] *= 1 + 1e-13;
    s->cell[1].run[3].metric[MCR_METRIC_MSE] *= 1 + 1e-13;
    set_wall(&s->cell[0], (const double[]){1, 2, 1.01, 1.5, 1.02});
    set_wall(&s->cell[1], (const double[]){2.01, 4, 2, 3.03, 2.05});
    a = mcr_analysis_create(&s->study);
    ok(a->pair->equal_spp.verdict == MCR_VERDICT_UNKNOWN && a->pair->equal_spp.p == 1 && a->pair->equal_spp.ratio.value == 1 &&
       a->pair->equal_spp.seeds_needed == 0, "the same images are not better, whatever their rounding; nor do more seeds help");
    ok(a->pair->equal_time.verdict == MCR_VERDICT_BETTER && fabs(a->pair->equal_time.ratio.value - 2) < 0.02,
       "but the faster one is, in %.3f of the time",
       1 / a->pair->equal_time.ratio.value);
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

/* ---- references, marks ---- */

static void test_reference(void)
{
    struct synthetic *s = synthetic_create(2, one_spp, 3);
    struct mcr_analysis *a;
    set_mse(&s->cell[0], (const double[]){1, 1.1, 1.2});
    set_mse(&s->cell[1], (const double[]){0.05, 0.04, 0.03});
    s->reference.noise = 0.05;
    a = mcr_analysis_create(&s->study);
    ok(near(a->cell[0].error.value, 1.05) && near(a->cell[0].metric[MCR_METRIC_MSE].value, 1.1) && near(a->cell[0].reference_share, 0.05 / 1.1) &&
       a->cell[0].marks == 0, "the reference's noise is taken off");
    ok(is_nothing(&a->cell[1].error) && a->cell[1].marks == MCR_MARK_REFERENCE && is_nothing(&a->pair->equal_spp.ratio) && a->reference_noise == 0.05,
       "an error below it is unknown, and marked");
    mcr_analysis_destroy(a);
    s->reference.noise = NAN;
    a = mcr_analysis_create(&s->study);
    ok(near(a->cell[0].error.value, 1.1) && isnan(a->cell[0].reference_share) && a->cell[1].marks == 0 && isnan(a->reference_noise),
       "noise that is unknown stays in the error");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

static void test_marks(void)
{
    struct synthetic *s = synthetic_create(4, one_spp, 4);
    struct mcr_analysis *a;
    uint32_t excluded = 0;
    for (int i = 0; i < 4; i++)
        set_mse(&s->cell[i], (const double[]){1 + i, 1.1 + i, 1.2 + i, 1.12 + i});
    s->cell[0].coverage.complete = 0;
    s->cell[1].settings.compat = 2;
    s->cell[2].run[3].not_finite = 1;
    s->cell[3].bias_square = 0.5;
    s->cell[3].bias_square_error = 0.01;
    a = mcr_analysis_create(&s->study);
    ok(a->cell[0].marks == MCR_MARK_INCOMPLETE && a->cell[1].marks == MCR_MARK_COMPAT && a->cell[2].marks == MCR_MARK_NOT_FINITE &&
       a->cell[3].marks == MCR_MARK_BIASED && a->series[3].marks == MCR_MARK_BIASED, "marks");
    for (uint32_t i = 0; i < a->pair_count; i++)
        excluded += a->pair[i].equal_spp.verdict == MCR_VERDICT_EXCLUDED && a->pair[i].equal_time.verdict == MCR_VERDICT_EXCLUDED &&
                    isnan(a->pair[i].equal_spp.p_holm) && a->pair[i].equal_spp.p > 0;
    ok(a->pair_count == 6 && excluded == 5 && a->pair[3].cell_a == 1 && a->pair[3].cell_b == 2 &&
       a->pair[3].equal_spp.verdict == MCR_VERDICT_BETTER &&
       a->pair[3].equal_spp.p_holm == a->pair[3].equal_spp.p, "incomplete and biased ones are left out, and not counted among the tests");
    mcr_analysis_destroy(a);
    s->cell[3].bias_square = 0.03; /* of an error of 4.1 */
    s->cell[3].bias_square_error = 1e-4;
    a = mcr_analysis_create(&s->study);
    ok(a->cell[3].marks == 0, "a bias below 1 %% of the error is negligible, however certain");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

/* The reference's noise and bias_square are in linear values. */
static void test_encoded(void)
{
    const uint32_t two[] = {1, 100, 0};
    struct synthetic *s = synthetic_create(1, two, 4);
    struct mcr_analysis *a;
    s->plan.how.encoding = MCR_ENCODING_SRGB8;
    s->reference.noise = 0.01;
    set_mse(&s->cell[0], (const double[]){100, 101, 102, 103});
    set_mse(&s->cell[1], (const double[]){50, 51, 52, 53});
    s->cell[1].bias_square = 1e-4;
    s->cell[1].bias_square_error = 1e-5;
    a = mcr_analysis_create(&s->study);
    ok(near(a->cell[0].error.value, 101.5) && isnan(a->cell[0].reference_share) && a->cell[0].marks == 0 && a->cell[1].marks == MCR_MARK_BIASED,
       "errors in codes: no noise is taken off, nothing flattens, any bias counts");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

/* What is rounding goes by the reference's values. */
static void test_dark(void)
{
    struct synthetic *s = synthetic_create(2, one_spp, 3);
    double values[4] = {1e-10, 2e-10, 0, 1e-10};
    struct mcr_image image = {.width = 2, .height = 2, .channels = 1, .data = values};
    struct mcr_analysis *a;
    set_mse(&s->cell[0], (const double[]){1e-32, 1.1e-32, 1.2e-32});
    set_mse(&s->cell[1], (const double[]){3e-31, 3.1e-31, 3e-31});
    s->reference.image = &image;
    a = mcr_analysis_create(&s->study);
    ok(near(a->cell[0].error.value, 1.1e-32) && a->pair->equal_spp.verdict == MCR_VERDICT_BETTER, "small errors of a dark image are compared");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

/* Errors of three spp with a spread of 5 %, different for each seed and spp. */
static void set_errors(struct synthetic *s, uint32_t first, const double *error)
{
    for (uint32_t k = 0; k < 3; k++) {
        for (uint32_t i = 0; i < s->cell[first + k].run_count; i++)
            s->cell[first + k].run[i].metric[MCR_METRIC_MSE] = error[k] * (1 + 0.05 * sin(1 + 2 * i + 5 * k + 11 * first));
    }
}

static void test_flattens(void)
{
    struct synthetic *s = synthetic_create(3, three_spp, 10);
    struct mcr_analysis *a;
    set_errors(s, 0, (const double[]){1, 0.1, 0.01});
    set_errors(s, 3, (const double[]){1, 0.15, 0.065});  /* a bias square of 0.055 */
    set_errors(s, 6, (const double[]){1, 0.01, 0.0012}); /* strata */
    a = mcr_analysis_create(&s->study);
    ok(!a->series[0].marks && !a->series[2].marks && a->cell[4].marks == MCR_MARK_FLATTENS && a->cell[5].marks == MCR_MARK_FLATTENS &&
       !a->cell[3].marks,
       "an error that falls more slowly is marked, one that falls faster is not");
    mcr_analysis_destroy(a);
    s->cell[4].bias_square = 0.001;
    s->cell[4].bias_square_error = 0.002;
    s->cell[5].bias_square = 0.055;
    s->cell[5].bias_square_error = 0.05;
    a = mcr_analysis_create(&s->study);
    ok(!a->cell[4].marks && a->cell[5].marks == MCR_MARK_FLATTENS, "not where a bias of that size is ruled out");
    mcr_analysis_destroy(a);
    s->reference.noise = 0.055;
    set_errors(s, 0, (const double[]){1.055, 0.155, 0.065});
    set_errors(s, 6, (const double[]){1.055, 0.155, 0.065});
    s->cell[4].bias_square = s->cell[4].bias_square_error = s->cell[5].bias_square = s->cell[5].bias_square_error = NAN;
    a = mcr_analysis_create(&s->study);
    ok(!((a->series[0].marks | a->series[1].marks | a->series[2].marks) & MCR_MARKS_LEFT_OUT), "nor where the reference's noise explains it");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

/* ---- ratios ---- */

static void test_baseline(void)
{
    struct synthetic *s = synthetic_create(3, one_spp, 3);
    struct mcr_analysis *a;
    uint32_t accel[2] = {2, 1};
    double half = T_975_1 * log(3) / 2;
    for (int i = 0; i < 3; i++)
        set_mse(&s->cell[i], (const double[]){4 >> i, 4 >> i, 4 >> i});
    set_wall(&s->cell[0], (const double[]){3, 3, 3});
    s->plan.baseline = 1;
    a = mcr_analysis_create(&s->study);
    ok(near(a->cell[0].efficiency.value, 2.0 / 4 / 3) && is(&a->cell[0].speed, 1.0 / 3, 1.0 / 3, 1.0 / 3) && near(a->cell[1].efficiency.value, 1) &&
       near(a->cell[2].efficiency.value, 2) && near(a->cell[2].speed.value, 1), "efficiency and speed against the baseline");
    mcr_analysis_destroy(a);
    /* Two cells with the baseline's sampler: the one with the plan's first accelerator is it. */
    s->plan.accel = accel;
    s->plan.accel_count = 2;
    s->cell[0].settings = s->cell[2].settings;
    s->cell[0].settings.accel = s->cell[1].settings.accel = 1;
    s->cell[2].settings.sampler = 1;
    s->cell[2].settings.accel = 2;
    a = mcr_analysis_create(&s->study);
    ok(near(a->cell[2].efficiency.value, 1) && near(a->cell[1].efficiency.value, 0.5), "the baseline has the plan's first settings");
    mcr_analysis_destroy(a);
    s->plan.baseline = 7;
    s->plan.runs = 2;
    a = mcr_analysis_create(&s->study);
    ok(is_nothing(&a->cell[0].efficiency) && is_nothing(&a->cell[0].speed), "no baseline in the group: unknown");
    mcr_analysis_destroy(a);
    s->plan.baseline = 0;
    s->cell[0].settings.sampler = 0;
    set_wall(&s->cell[0], (const double[]){1, 3, 1});
    a = mcr_analysis_create(&s->study);
    ok(is(&a->cell[1].speed, sqrt(3), sqrt(3) * exp(-half), sqrt(3) * exp(half)), "two timed runs: the mean of the logarithms");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

static void test_outlier(void)
{
    struct synthetic *s = synthetic_create(2, one_spp, 10);
    struct mcr_analysis *a;
    const double drift[10] = {1, 1.5, 1.2, 2, 1.1, 1.7, 1, 3, 1.4, 1.3};
    for (uint32_t i = 0; i < 10; i++) {
        s->cell[0].run[i].wall_seconds = drift[i] * (1 + 0.01 * sin(i));
        s->cell[1].run[i].wall_seconds = 1.1 * drift[i] * (1 + 0.01 * cos(i));
    }
    s->cell[0].run[4].wall_seconds = 100;
    a = mcr_analysis_create(&s->study);
    ok(a->cell[1].speed.low < 1 / 1.1 && a->cell[1].speed.high > 1 / 1.1 && a->cell[1].speed.high < 1,
       "a drift of 3 and an outlier of 100: speed %.3f [%.3f, %.3f] of 0.909",
       a->cell[1].speed.value, a->cell[1].speed.low, a->cell[1].speed.high);
    ok(a->cell[0].wall.trimmed.high < 10 && a->cell[0].wall.highest == 100 && a->cell[0].wall.median.high < 4,
       "nor do a cell's own times go by the outlier");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

static void test_many(void)
{
    struct synthetic *s = synthetic_create(2829, one_spp, 1); /* 4,000,206 pairs */
    struct mcr_analysis *a = mcr_analysis_create(&s->study);
    ok(a && a->pair_count == 0 && !a->pair && is_nothing(&a->cell[2828].error), "too many pairs are left out");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

/* ---- series ---- */

/* Errors c / spp^-slope, times `seconds` spp; all seeds of a cell equal but for a factor of the seed that all cells share. */
static void set_series(struct synthetic *s, uint32_t first, double c, double slope, double seconds)
{
    static const double factor[3] = {0.5, 1, 2};
    for (uint32_t k = 0; k < 3; k++) {
        struct mcr_study_cell *cell = &s->cell[first + k];
        for (uint32_t i = 0; i < cell->run_count; i++) {
            cell->run[i].metric[MCR_METRIC_MSE] = c * pow(cell->settings.spp, slope) * factor[i % 3];
            cell->run[i].wall_seconds = seconds * cell->settings.spp;
        }
    }
}

static void test_series(void)
{
    struct synthetic *s = synthetic_create(2, three_spp, 6);
    struct mcr_analysis *a;
    set_series(s, 0, 1, -1, 0.01);
    set_series(s, 3, 2, -2, 0.02);
    a = mcr_analysis_create(&s->study);
    ok(fabs(a->series[0].slope.value + 1) < 1e-12 && a->series[0].slope.high - a->series[0].slope.low < 1e-6 &&
       fabs(a->series[1].slope.value + 2) < 1e-12 &&
       fabs(a->series[1].time_slope.value + 2) < 1e-12, "slopes of power laws; what a seed does to all cells alike is no uncertainty");
    ok(a->target_chosen && near(a->target, 7.0 / 6 * sqrt(0.01 * 2e-4)), "the target in the middle of what was reached");
    mcr_analysis_destroy(a);

    s->plan.target = 7.0 / 6 * 0.05; /* 20 spp of the first: 0.2 s; sqrt(40) of the second: 0.1265 s */
    a = mcr_analysis_create(&s->study);
    ok(!a->target_chosen && a->series[0].target == MCR_TARGET_MEASURED && near(a->series[0].time_to_target.value, 0.2) &&
       a->series[0].time_to_target.low < 0.2 && a->series[0].time_to_target.high > 0.2 && a->series[1].target == MCR_TARGET_MEASURED &&
       near(a->series[1].time_to_target.value, 0.02 * sqrt(40)), "time to a target between the cells");
    mcr_analysis_destroy(a);

    s->plan.target = 7.0 / 6 * 1e-4;
    a = mcr_analysis_create(&s->study);
    ok(a->series[0].target == MCR_TARGET_EXTRAPOLATED && near(a->series[0].time_to_target.value, 100) &&
       a->series[1].target == MCR_TARGET_EXTRAPOLATED &&
       near(a->series[1].time_to_target.value, 0.02 * sqrt(2e4)), "beyond them");
    mcr_analysis_destroy(a);

    s->plan.target = 7.0 / 6 * 4;
    s->cell[3].coverage.complete = 0;
    a = mcr_analysis_create(&s->study);
    ok(a->series[0].target == MCR_TARGET_EXTRAPOLATED && near(a->series[0].time_to_target.value, 0.0025) &&
       a->series[1].target == MCR_TARGET_UNREACHABLE &&
       is_nothing(&a->series[1].time_to_target), "before them; not for a series that is left out");
    mcr_analysis_destroy(a);

    s->cell[3].coverage.complete = 1;
    set_series(s, 0, 1, 0.5, 0.01);
    s->cell[4].run_count = s->cell[5].run_count = 0;
    a = mcr_analysis_create(&s->study);
    ok(a->series[0].target == MCR_TARGET_UNREACHABLE && a->series[1].target == MCR_TARGET_UNKNOWN && is_nothing(&a->series[1].slope) &&
       a->series[1].cells == 3, "an error that grows; a single cell");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

/* A series that bends: beyond it, the line with the slope of all goes through the nearest cell. */
static void test_bent(void)
{
    struct synthetic *s = synthetic_create(1, three_spp, 1);
    struct mcr_analysis *a;
    const double error[3] = {1, 0.1, 0.02}, slope = log10(0.02) / 2; /* of three points at equal distances */
    for (int k = 0; k < 3; k++) {
        s->cell[k].run->metric[MCR_METRIC_MSE] = error[k];
        s->cell[k].run->wall_seconds = 0.01 * s->cell[k].settings.spp;
    }
    s->plan.target = 0.001;
    a = mcr_analysis_create(&s->study);
    ok(is_bare(&a->series[0].time_to_target, pow(0.001 / 0.02, 1 / slope)), "extrapolated from the last cell");
    mcr_analysis_destroy(a);
    s->plan.target = 10;
    a = mcr_analysis_create(&s->study);
    ok(is_bare(&a->series[0].time_to_target, 0.01 * pow(10, 1 / slope)), "and from the first");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

/* The intervals of slope and times against what independent seeds give: the delta method by hand for two cells. */
static void test_propagation(void)
{
    const uint32_t two[] = {1, 100, 0};
    struct synthetic *s = synthetic_create(1, two, 4);
    struct mcr_analysis *a;
    double q, c[4], d[4], mean = 0, squares = 0, width;
    const double x[4] = {0.9, 1.1, 1.05, 0.95}, y[4] = {0.0102, 0.0098, 0.0097, 0.0103};
    set_mse(&s->cell[0], x);
    set_mse(&s->cell[1], y);
    set_wall(&s->cell[0], (const double[]){1, 1, 1, 1});
    set_wall(&s->cell[1], (const double[]){100, 100, 100, 100});
    s->plan.target = 0.1;
    a = mcr_analysis_create(&s->study);
    for (int i = 0; i < 4; i++) { /* pseudo-values but for a constant */
        c[i] = -3 * log((4 - x[i]) / 3);
        d[i] = -3 * log((0.04 - y[i]) / 0.03);
        mean += (d[i] - c[i]) / 4;
    }
    for (int i = 0; i < 4; i++)
        squares += (d[i] - c[i] - mean) * (d[i] - c[i] - mean);
    width = 3.182446305284263 * sqrt(squares / 3 / 4) / log(100); /* t quantile .975, 3 degrees of freedom */
    ok(is(&a->series[0].slope, -1, -1 - width, -1 + width) && is(&a->series[0].time_slope, -1, -1 - width, -1 + width), "the interval of a slope");
    mean = squares = 0;
    for (int i = 0; i < 4; i++)
        mean += (c[i] + d[i]) / 8;
    for (int i = 0; i < 4; i++)
        squares += ((c[i] + d[i]) / 2 - mean) * ((c[i] + d[i]) / 2 - mean);
    q = exp(3.182446305284263 * sqrt(squares / 3 / 4));
    ok(is(&a->series[0].time_to_target, 10, 10 / q, 10 * q), "the interval of a time to the target, half-way between two cells");
    mcr_analysis_destroy(a);
    s->cell[0].run_count = s->cell[1].run_count = 1;
    a = mcr_analysis_create(&s->study);
    ok(is_bare(&a->series[0].slope, log(y[0] / x[0]) / log(100)), "one seed, two cells: no interval");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

static void test_one_seed(void)
{
    struct synthetic *s = synthetic_create(1, three_spp, 1);
    struct mcr_analysis *a;
    s->cell[0].run->metric[MCR_METRIC_MSE] = 1;
    s->cell[1].run->metric[MCR_METRIC_MSE] = 0.1 * exp(0.3); /* residuals -0.1, 0.2, -0.1; squares over x 2 log(10)^2 */
    s->cell[2].run->metric[MCR_METRIC_MSE] = 0.01;
    a = mcr_analysis_create(&s->study);
    double width = T_975_1 * sqrt(0.06 / 2) / log(10);
    ok(is(&a->series[0].slope, -1, -1 - width, -1 + width), "one seed, three cells: the scatter about the line");
    mcr_analysis_destroy(a);
    synthetic_destroy(s);
}

int main(void)
{
    test_few();
    test_uneven();
    test_strange();
    test_same_bits();
    test_reference();
    test_marks();
    test_encoded();
    test_dark();
    test_flattens();
    test_baseline();
    test_outlier();
    test_many();
    test_series();
    test_bent();
    test_propagation();
    test_one_seed();
    return tap_done();
}
