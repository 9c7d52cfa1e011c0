/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A contestant over spp: slopes, and the time to reach the target.
 *
 * Everything is a contrast of the cells' log errors, with weights that depend on spp or on time alone, so that what the cells of one seed share is
 * accounted for. Times enter by their derivative: moving a cell by d in log time does to a line of slope s what moving it by -s d in log error does.
 */
#include "base/elementary.h"
#include "study/inference.h"

/* The cells of a series that have an error, ascending in spp. */
struct line {
    const struct mcr_inference *in;
    uint32_t cells;
    uint32_t *cell;        /* in->list */
};

static double log_error(const struct line *line, uint32_t j) { return mcr_log(line->in->analysis->cell[line->cell[j]].error.value); }
static double log_time(const struct line *line, uint32_t j) { return line->in->data[line->cell[j]].log_time; }

/* Terms of all cells, with weight 0. */
static void clear_terms(const struct line *line)
{
    const struct mcr_inference *in = line->in;
    for (uint32_t j = 0; j < line->cells; j++) {
        in->term[j] = (struct mcr_term){in->data[line->cell[j]].mse, in->data[line->cell[j]].noise, 0.0};
        in->time[j] = (struct mcr_term){in->data[line->cell[j]].log_wall, 0.0, 0.0};
    }
}

/* The contrast of in->term over `cells` cells from `first` on, with what the reference's noise adds: one chance for all cells. */
static struct mcr_estimate error_contrast(const struct line *line, uint32_t first, uint32_t cells)
{
    const struct mcr_inference *in = line->in;
    struct mcr_estimate e = mcr_contrast_errors(in->term + first, cells, in->runs, in->floor, in->scratch);
    double common = 0.0;
    for (uint32_t j = first; j < first + cells; j++)
        common += in->term[j].weight * in->data[line->cell[j]].reference_sd;
    e.variance += common * common;
    return e;
}

static struct mcr_estimate time_contrast(const struct line *line, uint32_t first, uint32_t cells)
{
    return mcr_contrast_times(line->in->time + first, cells, line->in->runs, line->in->scratch);
}

/* ---- slopes ---- */

/* Slope over in->place; in->weight is left as its weights. With one seed the scatter about the line is all that there is to go by. */
static struct mcr_estimate fit(const struct line *line)
{
    const struct mcr_inference *in = line->in;
    struct mcr_estimate e;
    clear_terms(line);
    mcr_slope_weights(in->place, line->cells, in->weight);
    for (uint32_t j = 0; j < line->cells; j++)
        in->term[j].weight = in->weight[j];
    e = error_contrast(line, 0, line->cells);
    if (e.variance != e.variance) {
        for (uint32_t j = 0; j < line->cells; j++)
            in->values[j] = log_error(line, j);
        e = mcr_slope(in->place, in->values, line->cells);
    }
    return e;
}

static struct mcr_interval slope_over_spp(const struct line *line)
{
    for (uint32_t j = 0; j < line->cells; j++)
        line->in->place[j] = mcr_log((double)line->in->study->cell[line->cell[j]].settings.spp);
    return line->cells < 2 ? mcr_interval_unknown() : mcr_estimate_interval(fit(line), line->in->confidence);
}

static struct mcr_estimate slope_over_time(const struct line *line)
{
    const struct mcr_inference *in = line->in;
    struct mcr_estimate e = {MCR_NAN, MCR_NAN, 0.0}, time;
    if (line->cells < 2)
        return e;
    for (uint32_t j = 0; j < line->cells; j++)
        in->place[j] = log_time(line, j);
    e = fit(line);
    for (uint32_t j = 0; j < line->cells; j++)
        in->time[j].weight = -e.value * in->weight[j];
    time = time_contrast(line, 0, line->cells);
    time.value = 0.0;
    return mcr_estimate_add(e, 1.0, time, 1.0);
}

/* ---- the time to the target ---- */

/* Log time at which the line from cell j to the next crosses `target`. */
static struct mcr_estimate interpolate(const struct line *line, uint32_t j, double target)
{
    const struct mcr_inference *in = line->in;
    double from = log_error(line, j), fall = log_error(line, j + 1) - from, way = log_time(line, j + 1) - log_time(line, j);
    double share = fall < 0.0 ? (target - from) / fall : 0.0, per_error = fall < 0.0 ? way / fall : 0.0;
    struct mcr_estimate e;
    clear_terms(line);
    in->term[j].weight = -per_error * (1.0 - share);
    in->term[j + 1].weight = -per_error * share;
    in->time[j].weight = 1.0 - share;
    in->time[j + 1].weight = share;
    e = mcr_estimate_add(error_contrast(line, j, 2), 1.0, time_contrast(line, j, 2), 1.0);
    e.value = log_time(line, j) + share * way;
    return e;
}

/* Log time at which a line through cell `end` with the slope over time meets `target`; in->weight: the slope's weights. */
static struct mcr_estimate extrapolate(const struct line *line, uint32_t end, double slope, double target)
{
    const struct mcr_inference *in = line->in;
    double way = (target - log_error(line, end)) / slope;
    struct mcr_estimate e;
    clear_terms(line);
    for (uint32_t j = 0; j < line->cells; j++) {
        in->term[j].weight = -(way * in->weight[j] + (j == end ? 1.0 : 0.0)) / slope;
        in->time[j].weight = way * in->weight[j] + (j == end ? 1.0 : 0.0);
    }
    e = mcr_estimate_add(error_contrast(line, 0, line->cells), 1.0, time_contrast(line, 0, line->cells), 1.0);
    e.value = log_time(line, end) + way;
    return e;
}

/* slope: over time, as just fitted, so that in->weight holds its weights. */
static void find_time(const struct line *line, struct mcr_estimate slope, struct mcr_series_analysis *r)
{
    double target = mcr_log(line->in->analysis->target);
    uint32_t j = 0;
    r->time_to_target = mcr_interval_unknown();
    r->target = MCR_TARGET_UNKNOWN;
    if (line->cells < 2 || target != target)
        return;
    while (j + 1 < line->cells && !(log_error(line, j) >= target && target >= log_error(line, j + 1)))
        j++;
    if (j + 1 < line->cells) {
        r->target = MCR_TARGET_MEASURED;
        r->time_to_target = mcr_estimate_exp_interval(interpolate(line, j, target), line->in->confidence);
    } else if (r->marks & MCR_MARKS_LEFT_OUT || slope.value >= 0.0) {
        r->target = MCR_TARGET_UNREACHABLE;
    } else if (slope.value < 0.0) {
        uint32_t end = log_error(line, 0) <= target ? 0 : line->cells - 1;
        r->target = MCR_TARGET_EXTRAPOLATED;
        r->time_to_target = mcr_estimate_exp_interval(extrapolate(line, end, slope.value, target), line->in->confidence);
        if (!(r->time_slope.high < 0.0)) /* the error may not fall at all */
            r->time_to_target.low = r->time_to_target.high = MCR_NAN;
    }
}

/* ---- all series ---- */

static void keep_timed(struct line *line)
{
    uint32_t kept = 0;
    for (uint32_t j = 0; j < line->cells; j++) {
        if (log_time(line, j) == log_time(line, j))
            line->cell[kept++] = line->cell[j];
    }
    line->cells = kept;
}

static void analyse_one(const struct mcr_inference *in, const struct mcr_cell_place *place, uint32_t cells, struct mcr_series_analysis *r)
{
    struct line line = {in, 0, in->list};
    struct mcr_estimate slope;
    r->contestant = in->study->cell[place->cell].contestant;
    r->depth = in->study->cell[place->cell].settings.depth;
    r->cells = cells;
    for (uint32_t j = 0; j < cells; j++) {
        r->marks |= in->analysis->cell[place[j].cell].marks;
        if (in->analysis->cell[place[j].cell].error.value > 0.0)
            line.cell[line.cells++] = place[j].cell;
    }
    r->slope = slope_over_spp(&line);
    keep_timed(&line);
    slope = slope_over_time(&line);
    r->time_slope = mcr_estimate_interval(slope, in->confidence);
    find_time(&line, slope, r);
}

static uint32_t series_length(const struct mcr_inference *in, uint32_t first)
{
    uint32_t end = first;
    while (end < in->study->cell_count && in->by_series[end].major == in->by_series[first].major)
        end++;
    return end - first;
}

/* The least and the greatest error of series at their highest spp that has one, of unmarked ones or of all. */
static int reached(const struct mcr_inference *in, uint32_t marks, double *least, double *greatest)
{
    int found = 0;
    for (uint32_t i = 0, n; i < in->study->cell_count; i += n) {
        double last = MCR_NAN;
        uint32_t of_series = 0;
        n = series_length(in, i);
        for (uint32_t j = i; j < i + n; j++) {
            const struct mcr_cell_analysis *cell = &in->analysis->cell[in->by_series[j].cell];
            of_series |= cell->marks;
            last = cell->error.value > 0.0 ? cell->error.value : last;
        }
        if (last != last || of_series & marks)
            continue;
        *least = found ? mcr_min(*least, last) : last;
        *greatest = found ? mcr_max(*greatest, last) : last;
        found = 1;
    }
    return found;
}

static void choose_target(const struct mcr_inference *in)
{
    double least, greatest;
    in->analysis->target = in->study->plan->target;
    in->analysis->target_chosen = !(in->analysis->target > 0.0);
    if (!in->analysis->target_chosen)
        return;
    if (reached(in, MCR_MARKS_LEFT_OUT, &least, &greatest) || reached(in, 0, &least, &greatest))
        in->analysis->target = sqrt(least) * sqrt(greatest);
    else
        in->analysis->target = MCR_NAN;
}

void mcr_analyse_series(struct mcr_inference *in)
{
    choose_target(in);
    for (uint32_t i = 0, n; i < in->study->cell_count; i += n) {
        n = series_length(in, i);
        if (in->by_series[i].major < in->study->series_count)
            analyse_one(in, &in->by_series[i], n, &in->analysis->series[in->by_series[i].major]);
    }
}
