/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What the runs of a study say, with confidence intervals. All intervals are two-sided at plan->confidence; p values are two-sided.
 * A number that the data do not give is NaN. Pure functions of the study: the same runs give the same digits.
 *
 * Errors. The value of a cell is the mean over its seeds, which is unbiased for the expected MSE; its interval is a t-interval on the logarithm, over
 * the seeds' jackknife pseudo-values n log(mean of all) - (n - 1) log(mean of the others). (The geometric mean of n seeds estimates something
 * smaller, and with many seeds its interval loses the truth: tests/study/synthetic.c.) What several cells say together (a ratio, a slope) is
 * computed seed by seed from these pseudo-values and then summarised over the seeds, because cells share their seeds and through them some of
 * their random numbers (all of them with list against bvh). Errors below rounding, and differences within it, count as none.
 * Times. Run i of every cell is rendered in round i: ratios of times are taken within rounds, where a drift of the machine cancels, and summarised by
 * the trimmed mean of their logarithms (from seven runs on) with Yuen's interval. Errors and times are combined by Welch and Satterthwaite.
 */
#ifndef MCR_STUDY_ANALYSIS_H
#define MCR_STUDY_ANALYSIS_H

#include "study/statistics.h" /* struct mcr_interval */
#include "study/study.h"

struct mcr_time_summary {
    uint32_t runs;
    struct mcr_interval trimmed; /* lowest and highest discarded, mean of the rest (all, where fewer than 3); trimmed t (Yuen), no ends of 1 or 3 runs */
    struct mcr_interval median;  /* interval from order statistics; NaN ends where the runs are too few for the confidence */
    double lowest, highest;
};

/* Why a cell is marked. FLATTENS and BIASED are decided by one family of tests over the whole study (Holm): an unbiased study gets any of them in at
 * most a share 1 - confidence of all cases. Where errors are in encoded values (plan->how), there is no FLATTENS, the noise counts as unknown, and
 * BIASED has no least size. */
#define MCR_MARK_INCOMPLETE 1u /* the sampler does not cover the integrand */
#define MCR_MARK_FLATTENS 2u   /* from the previous or the first spp on, the error falls more slowly than spp^-0.9, and bias_square does not deny it */
#define MCR_MARK_BIASED 4u     /* the mean over the seeds differs from the reference beyond both their noise, by more than 1 % of the cell's error */
#define MCR_MARK_COMPAT 8u     /* renders with a quirk that is known to be biased */
#define MCR_MARK_REFERENCE 16u /* the reference's noise is not small (above 5 %) against this cell's error */
#define MCR_MARK_NOT_FINITE 32u /* samples were rejected */
#define MCR_MARKS_LEFT_OUT (MCR_MARK_INCOMPLETE | MCR_MARK_FLATTENS | MCR_MARK_BIASED) /* cells with one of these are left out of rankings */

struct mcr_cell_analysis {
    struct mcr_time_summary wall, cpu;
    struct mcr_interval metric[MCR_METRIC_COUNT]; /* over the seeds: mse, rmse, mae, relmse as above, others by t; NaN: a value was infinite */
    struct mcr_interval error;                    /* mse without the reference's own noise, where that is known; NaN where nothing is left */
    struct mcr_interval efficiency;               /* 1 / (error * wall) over the baseline's, in the same group: above 1 is better */
    struct mcr_interval speed;                    /* the baseline's wall time over this cell's */
    double reference_share;                       /* the reference's noise over the mean mse; NaN where it is unknown */
    uint32_t marks;
};

/* A series: one contestant and depth over spp. */
struct mcr_series_analysis {
    uint32_t contestant, depth, cells;
    struct mcr_interval slope;        /* of log error over log spp: least squares, seed by seed; of one seed from the scatter about the line */
    struct mcr_interval time_slope;   /* of log error over log wall time */
    struct mcr_interval time_to_target; /* wall seconds */
    uint32_t target;                  /* MCR_TARGET_* */
    uint32_t marks;                   /* of its cells */
};
#define MCR_TARGET_MEASURED 0u     /* between two measured cells */
#define MCR_TARGET_EXTRAPOLATED 1u /* along the slope, beyond them */
#define MCR_TARGET_UNREACHABLE 2u  /* beyond them, and the slope is not below 0 or the series has a mark of MCR_MARKS_LEFT_OUT */
#define MCR_TARGET_UNKNOWN 3u      /* too few cells to say */

#define MCR_VERDICT_BETTER 0u
#define MCR_VERDICT_WORSE 1u
#define MCR_VERDICT_UNKNOWN 2u /* the data cannot tell */
#define MCR_VERDICT_EXCLUDED 3u /* one of the two is marked */

/* Contestants a < b of one group: is a better than b? */
struct mcr_pair_test {
    struct mcr_interval ratio; /* of a's goodness over b's: above 1 a is better */
    double p, p_holm;          /* p_holm: over the pairs of the group that are not EXCLUDED, of these NaN */
    uint32_t verdict;          /* by p_holm */
    uint32_t seeds_needed;     /* of UNKNOWN: in all (and at equal time as many timed runs), for a power of 80 % if the ratio is what it seems;
                            * 0: more than a million, or too few to say */
};
struct mcr_pair_analysis {
    uint32_t group, cell_a, cell_b;
    struct mcr_pair_test equal_time; /* efficiency: 1 / (error * wall) */
    struct mcr_pair_test equal_spp;  /* 1 / error */
};

#define MCR_MOST_PAIRS 4000000u

struct mcr_analysis {
    struct mcr_cell_analysis *cell;       /* study->cell_count */
    uint32_t pair_count;
    struct mcr_pair_analysis *pair;       /* in order of group, a, b; none at all if they were more than MCR_MOST_PAIRS */
    struct mcr_series_analysis *series;   /* study->series_count */
    double target;                        /* MSE */
    int target_chosen;                    /* by the analysis: the geometric middle of least and greatest error of unmarked series at their highest spp */
    double reference_noise;               /* the largest over the references; NaN: none is known */
};

/* NULL when memory is short. Works with any number of finished runs, also of an interrupted study. */
struct mcr_analysis *mcr_analysis_create(const struct mcr_study *study);
void mcr_analysis_destroy(struct mcr_analysis *analysis);

#endif
