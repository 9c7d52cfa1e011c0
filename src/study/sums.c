/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What the bias test needs of the images x_i of a cell: with e_i = x_i - r, for each pixel the sums of e over the runs, channel by channel, and of
 * e^2 over runs and channels. The mean of e_i e_j over pairs of different runs estimates (E x - r)^2 + variance of r without bias:
 *     ((sum e)^2 - sum e^2) / (S (S - 1)).
 */
#include <math.h>
#include <stdio.h>

#include "study/state.h"
#include "study/work.h"

#define PLANES 4u /* sums of e in R, G, B; sum of e^2 over the three */

struct place {
    char name[40];
};

static struct place place_of(const struct mcr_study_cell *cell)
{
    struct place place;
    snprintf(place.name, sizeof place.name, "%016llx.sums", (unsigned long long)cell->key);
    return place;
}

static void add(struct mcr_state *state, const double *x, const double *r)
{
    size_t pixels = (size_t)state->width * state->height;
    double *square = state->data + 3 * pixels;
    for (size_t p = 0; p < pixels; p++)
        for (size_t c = 0; c < 3; c++) {
            double e = x[3 * p + c] - r[3 * p + c];
            state->data[c * pixels + p] += e;
            square[p] += e * e;
        }
}

/*
 * The file is written before the run is journalled. A crash in between leaves sums with one run more than the journal has: that run is rendered
 * again, has the same bits (the mark), and is not added twice.
 */
int mcr_study_sums_add(struct mcr_study_work *work, const struct mcr_study_cell *cell, uint32_t run, const struct mcr_image *image, char *error,
                       size_t length)
{
    const struct mcr_image *reference = work->reference_image[cell->reference];
    struct place place = place_of(cell);
    struct mcr_state state;
    uint64_t mark = mcr_state_hash(0, image->data, (size_t)image->width * image->height * 3);
    int found, status = 0;
    if (mcr_state_init(&state, cell->key, image->width, image->height, PLANES)) {
        snprintf(error, length, "out of memory");
        return -1;
    }
    found = mcr_state_read(&state, work->folder, place.name);
    /* Without the sums of the earlier runs nothing can be added: bias stays unknown for this cell. The first run begins anew. */
    if (run == 0 && !(found == 0 && state.count == 1 && state.mark == mark)) {
        mcr_state_fini(&state);
        found = mcr_state_init(&state, cell->key, image->width, image->height, PLANES);
        if (found)
            snprintf(error, length, "out of memory");
    }
    if (found < 0 && run == 0) {
        status = -1;
    } else if (found == 0 && state.count == run) {
        add(&state, image->data, reference->data);
        state.count++;
        state.mark = mark;
        status = mcr_state_write(&state, work->folder, place.name, error, length);
    } else if (found == 0 && state.count == run + UINT64_C(1) && state.mark != mark) {
        mcr_state_remove(work->folder, place.name); /* the same run had other bits: the sums are of something else */
    }
    mcr_state_fini(&state);
    return status;
}

/* Neumaier's compensated sum. */
struct sum {
    double sum, rest;
};

static void sum_add(struct sum *sum, double x)
{
    double t = sum->sum + x;
    sum->rest += fabs(sum->sum) >= fabs(x) ? (sum->sum - t) + x : (x - t) + sum->sum;
    sum->sum = t;
}

/* One pixel's estimate: the mean over its channels, which are correlated. */
static double term(const struct mcr_state *state, const double *variance, size_t p)
{
    size_t pixels = (size_t)state->width * state->height;
    double count = (double)state->count, cross = -state->data[3 * pixels + p], noise = 0;
    for (size_t c = 0; c < 3; c++) {
        double e = state->data[c * pixels + p];
        cross += e * e;
        noise += variance[3 * p + c];
    }
    return (cross / (count * (count - 1)) - noise) / 3;
}

int mcr_study_sums_bias(struct mcr_study_work *work, struct mcr_study_cell *cell)
{
    const struct mcr_image *variance = work->reference_variance[cell->reference];
    struct place place = place_of(cell);
    struct mcr_state state;
    struct sum sum = {0}, square = {0};
    size_t pixels = (size_t)work->study.width * work->study.height;
    int status = -1;
    cell->bias_square = cell->bias_square_error = (double)NAN;
    if (cell->run_count == 0)
        return 0;
    if (mcr_state_init(&state, cell->key, work->study.width, work->study.height, PLANES))
        return -1;
    /* The journal may have more of this cell than the plan asks for; one run more than it has is of a crash. */
    if (!mcr_state_read(&state, work->folder, place.name) && state.count >= cell->run_count) {
        status = 0;
        for (size_t p = 0; variance && state.count > 1 && p < pixels; p++)
            sum_add(&sum, term(&state, variance->data, p));
        double mean = (sum.sum + sum.rest) / (double)pixels;
        for (size_t p = 0; variance && state.count > 1 && p < pixels; p++) {
            double d = term(&state, variance->data, p) - mean;
            sum_add(&square, d * d);
        }
        if (variance && state.count > 1) {
            cell->bias_square = mean;
            cell->bias_square_error = pixels > 1 ? sqrt((square.sum + square.rest) / ((double)pixels * (double)(pixels - 1))) : (double)NAN;
        }
    }
    mcr_state_fini(&state);
    return status;
}
