/* SPDX-License-Identifier: Apache-2.0 */
#include "metrics/pointwise.h"

#include "base/elementary.h"

static void measure_value(struct mcr_pointwise *sums, double a, double r, double floor)
{
    double e = a - r, both = fabs(a) + fabs(r);
    sums->count++;
    mcr_sum_add(&sums->image, a);
    mcr_sum_add(&sums->reference, r);
    mcr_sum_add(&sums->square_error, e * e);
    mcr_sum_add(&sums->absolute_error, fabs(e));
    mcr_sum_add(&sums->relative, e * e / (r * r + floor));
    mcr_sum_add(&sums->smape, both > 0 ? fabs(e) / both : 0);
    mcr_sum_add(&sums->square_reference, r * r);
}

/*
 * The sum of squared distances from the mean, given that of all terms: what rounding of the mean leaves is taken off. Distances are not known better
 * than to a rounding of the mean and one of the distance, 2^-52 |mean| together, so that a smaller spread is none.
 */
static double moment(struct mcr_sum squares, struct mcr_sum distances, double mean, double count)
{
    double left = mcr_sum_value(distances), result = mcr_sum_value(squares) - left * left / count, unit = 0x1p-52 * mean;
    return result > count * unit * unit ? result : result != result ? result : 0;
}

void mcr_pointwise_measure(const struct mcr_pair *pair, uint32_t series, double *row, struct mcr_pointwise *sums)
{
    double *a = row, *r = row + pair->width, floor = 0.01 * pair->peak * pair->peak;
    struct mcr_sum error = {0, 0}, squares[2] = {{0, 0}}, distances[2] = {{0, 0}};
    *sums = (struct mcr_pointwise){0};
    for (uint32_t y = 0; y < pair->height; y++) {
        mcr_pair_row(pair, 0, series, y, a);
        mcr_pair_row(pair, 1, series, y, r);
        for (uint32_t x = 0; x < pair->width; x++)
            if (mcr_pair_has(pair, x, y)) {
                measure_value(sums, a[x], r[x], floor);
                mcr_sum_add(&error, a[x] - r[x]);
            }
    }
    double count = (double)sums->count, mean[2] = {mcr_sum_value(error) / count, mcr_sum_value(sums->reference) / count};
    for (uint32_t y = 0; y < pair->height; y++) {
        mcr_pair_row(pair, 0, series, y, a);
        mcr_pair_row(pair, 1, series, y, r);
        for (uint32_t x = 0; x < pair->width; x++) {
            double distance[2] = {a[x] - r[x] - mean[0], r[x] - mean[1]};
            for (int i = 0; i < 2 && mcr_pair_has(pair, x, y); i++) {
                mcr_sum_add(&squares[i], distance[i] * distance[i]);
                mcr_sum_add(&distances[i], distance[i]);
            }
        }
    }
    sums->moment_error = moment(squares[0], distances[0], mean[0], count);
    sums->moment_reference = moment(squares[1], distances[1], mean[1], count);
}

void mcr_pointwise_join(struct mcr_pointwise *sums, const struct mcr_pointwise *other)
{
    sums->count += other->count;
    mcr_sum_join(&sums->image, other->image);
    mcr_sum_join(&sums->reference, other->reference);
    mcr_sum_join(&sums->square_error, other->square_error);
    mcr_sum_join(&sums->absolute_error, other->absolute_error);
    mcr_sum_join(&sums->relative, other->relative);
    mcr_sum_join(&sums->smape, other->smape);
    mcr_sum_join(&sums->square_reference, other->square_reference);
    sums->moment_error += other->moment_error;
    sums->moment_reference += other->moment_reference;
}

static double decibels(double ratio)
{
    return 10 * mcr_log(ratio) / 0x1.26bb1bbb55516p+1; /* ln 10 */
}

/* 10 log10(signal / noise). What is NaN has overflowed, and gets no note here. */
static void set_ratio(struct mcr_metrics *metrics, enum mcr_metric metric, double signal, double noise, const char *no_signal, const char *no_noise)
{
    double ratio = signal / noise;
    metrics->note[metric] = signal == 0 ? no_signal : noise == 0 ? no_noise : NULL;
    if (signal == 0)
        metrics->value[metric] = MCR_NAN;
    else if (noise == 0)
        metrics->value[metric] = MCR_INFINITY;
    else
        metrics->value[metric] = isfinite(ratio) && ratio > 0 ? decibels(ratio) : decibels(signal) - decibels(noise);
}

void mcr_pointwise_finish(const struct mcr_pointwise *sums, double peak, struct mcr_metrics *metrics)
{
    static const char same[] = "infinite: the values are the same", black[] = "undefined: the reference is black";
    double count = (double)sums->count, square = mcr_sum_value(sums->square_error), reference = mcr_sum_value(sums->reference);
    metrics->value[MCR_METRIC_MSE] = square / count;
    metrics->value[MCR_METRIC_RMSE] = sqrt(square / count);
    metrics->value[MCR_METRIC_MAE] = mcr_sum_value(sums->absolute_error) / count;
    metrics->value[MCR_METRIC_RELMSE] = mcr_sum_value(sums->relative) / count;
    metrics->value[MCR_METRIC_SMAPE] = mcr_sum_value(sums->smape) / count;
    set_ratio(metrics, MCR_METRIC_PSNR, peak * peak, square / count, "", same);
    set_ratio(metrics, MCR_METRIC_SNR, mcr_sum_value(sums->square_reference), square, black, same);
    set_ratio(metrics, MCR_METRIC_SNR_VARIANCE, sums->moment_reference, sums->moment_error, "undefined: the reference is of one value",
              "infinite: the values differ by a constant");
    metrics->value[MCR_METRIC_MEAN_RATIO] = reference != 0 ? mcr_sum_value(sums->image) / reference : MCR_NAN;
    if (reference == 0)
        metrics->note[MCR_METRIC_MEAN_RATIO] = "undefined: the mean of the reference is 0";
}
