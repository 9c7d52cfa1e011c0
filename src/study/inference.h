/* SPDX-License-Identifier: Apache-2.0 */
/* What the parts of the analysis share: the study's numbers as tables by run, and contrasts, weighted sums over cells of log errors or log times. */
#ifndef MCR_STUDY_INFERENCE_H
#define MCR_STUDY_INFERENCE_H

#include "study/analysis.h"

struct mcr_cell_data {
    double *mse;            /* by run; NaN: none */
    double *log_wall;       /* by run; NaN: not timed */
    double noise;           /* to be taken off mse; 0 where it is unknown */
    double noise_at_most;   /* for tests that a reference's noise must not disturb: noise, or where it is unknown the most that it can be */
    double reference_sd;    /* of the log error, from what the reference's noise happens to be: the same chance for all cells of the reference */
    double log_time;        /* trimmed mean of log_wall */
};

/* Cells in the order of (major, minor): series and spp, or group and contestant. */
struct mcr_cell_place {
    uint32_t major, minor, cell;
};

/* One cell's part in a contrast. */
struct mcr_term {
    const double *x;
    double minus, weight;   /* weight * log(mean of x - minus), or weight * x */
};

struct mcr_inference {
    const struct mcr_study *study;
    struct mcr_analysis *analysis;
    double confidence;
    uint32_t runs;                  /* length of the tables: the most runs that a cell has */
    double floor;                   /* errors up to this are rounding */
    int linear;                     /* errors are in linear values, as the references' noise and bias_square are */
    struct mcr_cell_data *data;     /* one a cell */
    double *tables;                 /* all mse and log_wall; owned */
    struct mcr_cell_place *by_series, *by_group;
    /* Scratch. */
    double *scratch, *values;       /* as many as there are runs, or cells in the longest series */
    struct mcr_term *term, *time;   /* as many as the longest series has cells, at least 2 */
    double *place, *weight;         /* as many */
    uint32_t *list;                 /* as many */
};

/* Sum of weight * log(mean of (x - minus)) over the runs that all the terms have; variance over these runs, from the pseudo-values. value NaN: a mean
 * is not above `floor`; variance NaN: fewer than two runs, or one run holds all of a mean. */
struct mcr_estimate mcr_contrast_errors(const struct mcr_term *term, uint32_t terms, uint32_t runs, double floor, double *scratch);
/* Sum of weight * x run by run, over the runs that all have: trimmed mean, lowest and highest cut where there are seven or more. */
struct mcr_estimate mcr_contrast_times(const struct mcr_term *term, uint32_t terms, uint32_t runs, double *scratch);

/* These in turn: each reads what the former ones filled. Returns 0, or -1 when memory is short. */
void mcr_analyse_cells(struct mcr_inference *inference);
int mcr_analyse_marks(struct mcr_inference *inference);
int mcr_analyse_pairs(struct mcr_inference *inference);
void mcr_analyse_series(struct mcr_inference *inference);

/* Log of cell a's error over b's, resp. of a's wall time over b's. */
struct mcr_estimate mcr_error_ratio(const struct mcr_inference *inference, uint32_t a, uint32_t b);
struct mcr_estimate mcr_time_ratio(const struct mcr_inference *inference, uint32_t a, uint32_t b);

static inline struct mcr_interval mcr_interval_unknown(void)
{
    struct mcr_interval r = {__builtin_nan(""), __builtin_nan(""), __builtin_nan("")};
    return r;
}

#endif
