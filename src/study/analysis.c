/* SPDX-License-Identifier: Apache-2.0 */
/* The analysis as a whole: memory, tables and order of its parts. */
#include "study/analysis.h"

#include <stdlib.h>

#include "base/elementary.h"
#include "base/memory.h"
#include "study/inference.h"

#define DEFAULT_CONFIDENCE 0.95
#define ROUNDING 1e-28 /* of the mean square of an image: an MSE that sums and divisions of doubles may leave of nothing (an RMSE of 1e-14) */

/* The mean square of the values that errors are measured against, or the peak's where there are none. */
static double image_scale(const struct mcr_study *study)
{
    double scale = 0.0, peak = study->plan->how.peak > 0.0 ? study->plan->how.peak : 1.0;
    for (uint32_t i = 0; i < study->reference_count; i++) {
        const struct mcr_image *image = study->reference[i].image;
        double sum = 0.0;
        size_t count = image ? (size_t)image->width * image->height * image->channels : 0;
        for (size_t k = 0; k < count; k++)
            sum += image->data[k] * image->data[k];
        scale = count ? mcr_max(scale, sum / (double)count) : scale;
    }
    if (study->plan->how.encoding == MCR_ENCODING_SRGB8)
        return 255.0 * 255.0;
    return scale > 0.0 && scale < MCR_INFINITY ? scale : peak * peak;
}

static int by_place(const void *a, const void *b)
{
    const struct mcr_cell_place *x = a, *y = b;
    if (x->major != y->major)
        return x->major < y->major ? -1 : 1;
    if (x->minor != y->minor)
        return x->minor < y->minor ? -1 : 1;
    return (x->cell > y->cell) - (x->cell < y->cell);
}

static void order_cells(struct mcr_inference *in)
{
    uint32_t count = in->study->cell_count;
    for (uint32_t i = 0; i < count; i++) {
        const struct mcr_study_cell *cell = &in->study->cell[i];
        in->by_series[i] = (struct mcr_cell_place){cell->series, cell->settings.spp, i};
        in->by_group[i] = (struct mcr_cell_place){cell->group, cell->contestant, i};
    }
    qsort(in->by_series, count, sizeof *in->by_series, by_place);
    qsort(in->by_group, count, sizeof *in->by_group, by_place);
}

static uint32_t longest_series(const struct mcr_inference *in)
{
    uint32_t longest = 2, length = 0;
    for (uint32_t i = 0; i < in->study->cell_count; i++) {
        length = i && in->by_series[i].major == in->by_series[i - 1].major ? length + 1 : 1;
        longest = length > longest ? length : longest;
    }
    return longest;
}

static void fill_tables(struct mcr_inference *in)
{
    const struct mcr_study *study = in->study;
    for (uint32_t c = 0; c < study->cell_count; c++) {
        const struct mcr_study_cell *cell = &study->cell[c];
        struct mcr_cell_data *data = &in->data[c];
        data->mse = in->tables + (size_t)2 * c * in->runs;
        data->log_wall = data->mse + in->runs;
        for (uint32_t i = 0; i < in->runs; i++) {
            const struct mcr_study_run *run = i < cell->run_count ? &cell->run[i] : NULL;
            data->mse[i] = run && i < study->plan->seeds ? run->metric[MCR_METRIC_MSE] : MCR_NAN;
            data->log_wall[i] = run && i < study->plan->runs && run->wall_seconds > 0.0 ? mcr_log(run->wall_seconds) : MCR_NAN;
        }
    }
}

static int prepare(struct mcr_inference *in, const struct mcr_study *study, struct mcr_analysis *analysis)
{
    uint32_t longest, room;
    size_t table;
    in->study = study;
    in->analysis = analysis;
    in->confidence = study->plan->confidence > 0.0 && study->plan->confidence < 1.0 ? study->plan->confidence : DEFAULT_CONFIDENCE;
    in->linear = study->plan->how.encoding == MCR_ENCODING_LINEAR;
    in->floor = ROUNDING * image_scale(study);
    for (uint32_t i = 0; i < study->cell_count; i++)
        in->runs = study->cell[i].run_count > in->runs ? study->cell[i].run_count : in->runs;
    in->by_series = mcr_array_alloc(study->cell_count, sizeof *in->by_series);
    in->by_group = mcr_array_alloc(study->cell_count, sizeof *in->by_group);
    in->data = mcr_array_alloc(study->cell_count, sizeof *in->data);
    if (!in->by_series || !in->by_group || !in->data || !mcr_size_mul(study->cell_count, (size_t)2 * in->runs, &table))
        return -1;
    order_cells(in);
    longest = longest_series(in);
    in->tables = mcr_array_alloc(table, sizeof *in->tables);
    room = in->runs > longest ? in->runs : longest;
    in->scratch = mcr_array_alloc(room, sizeof *in->scratch);
    in->values = mcr_array_alloc(room, sizeof *in->values);
    in->term = mcr_array_alloc(longest, sizeof *in->term);
    in->time = mcr_array_alloc(longest, sizeof *in->time);
    in->place = mcr_array_alloc(longest, sizeof *in->place);
    in->weight = mcr_array_alloc(longest, sizeof *in->weight);
    in->list = mcr_array_alloc(longest, sizeof *in->list);
    if (!in->tables || !in->scratch || !in->values || !in->term || !in->time || !in->place || !in->weight || !in->list)
        return -1;
    fill_tables(in);
    return 0;
}

static void release(struct mcr_inference *in)
{
    free(in->by_series);
    free(in->by_group);
    free(in->data);
    free(in->tables);
    free(in->scratch);
    free(in->values);
    free(in->term);
    free(in->time);
    free(in->place);
    free(in->weight);
    free(in->list);
}

struct mcr_analysis *mcr_analysis_create(const struct mcr_study *study)
{
    struct mcr_analysis *analysis = calloc(1, sizeof *analysis);
    struct mcr_inference in = {0};
    int failed;
    if (!analysis)
        return NULL;
    analysis->cell = mcr_array_alloc(study->cell_count, sizeof *analysis->cell);
    analysis->series = mcr_array_alloc(study->series_count, sizeof *analysis->series);
    failed = !analysis->cell || !analysis->series || prepare(&in, study, analysis) != 0;
    if (!failed) {
        mcr_analyse_cells(&in);
        failed = mcr_analyse_marks(&in) != 0 || mcr_analyse_pairs(&in) != 0;
    }
    if (!failed)
        mcr_analyse_series(&in);
    release(&in);
    if (!failed)
        return analysis;
    mcr_analysis_destroy(analysis);
    return NULL;
}

void mcr_analysis_destroy(struct mcr_analysis *analysis)
{
    if (!analysis)
        return;
    free(analysis->cell);
    free(analysis->pair);
    free(analysis->series);
    free(analysis);
}
