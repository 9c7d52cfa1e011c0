/* SPDX-License-Identifier: Apache-2.0 */
/* The tables of times (in the shape of the founding study's table 3) and of image quality (its table 4), and one of times over all groups. */
#include <math.h>

#include "study/page.h"
#include "study/words.h"

static uint32_t rows_of(const struct mcr_page *page)
{
    return page->study->contestant_count < MCR_PAGE_ROWS ? page->study->contestant_count : MCR_PAGE_ROWS;
}

/* A value with its interval below, as a cell. */
static void put_interval(struct mcr_page *page, const struct mcr_interval *interval, int digits)
{
    mcr_text_put(page->out, "<td>");
    mcr_page_number(page, interval->value, digits);
    if (!isnan(interval->low) && !isnan(interval->high)) {
        mcr_text_put(page->out, "<br/>");
        mcr_page_range(page, interval, digits);
    }
    mcr_text_put(page->out, "</td>");
}

/* The groups that get tables of their own: the last ones, the greatest first. `put` writes one; the first stands open, the others are folded. */
static void each_group(struct mcr_page *page, void (*put)(struct mcr_page *page, const struct mcr_page_group *group))
{
    for (uint32_t i = 0; i < page->group_count && i < MCR_PAGE_GROUPS; i++) {
        const struct mcr_page_group *group = &page->group[page->group_count - 1 - i];
        mcr_text_put(page->out, i ? "<details><summary>" : "<details open=\"open\"><summary>");
        mcr_page_group_words(page, group);
        mcr_text_put(page->out, "</summary>\n");
        put(page, group);
        mcr_text_put(page->out, "</details>\n");
    }
    if (page->group_count > MCR_PAGE_GROUPS)
        mcr_text_printf(page->out, "<p class=\"fine\">%u more groups are in study.json.</p>\n", page->group_count - MCR_PAGE_GROUPS);
}

/* ---- times ----------------------------------------------------------------------------------------------------------------------- */

static void put_time(struct mcr_page *page, const struct mcr_study_cell *cell)
{
    const struct mcr_time_summary *wall = &mcr_page_known(page, cell)->wall;
    mcr_text_put(page->out, "<td><b>");
    mcr_page_number(page, wall->trimmed.value, 4);
    mcr_text_put(page->out, "</b><br/>");
    mcr_page_range(page, &wall->trimmed, 4);
    mcr_text_put(page->out, "<br/><span class=\"range\">median ");
    mcr_page_number(page, wall->median.value, 4);
    mcr_text_put(page->out, "</span></td>");
}

/* Rows: depth and spp. Columns: contestants. */
static void put_overview(struct mcr_page *page)
{
    struct mcr_text *out = page->out;
    uint32_t last = 0;
    mcr_page_table_begin(page, "Render time in seconds by depth, spp and contestant");
    mcr_text_put(out, "<thead><tr><th scope=\"col\">depth</th><th scope=\"col\">spp</th>");
    for (uint32_t c = 0; c < rows_of(page); c++) {
        mcr_text_put(out, "<th scope=\"col\">");
        mcr_page_put_label(page, c);
        mcr_text_put(out, "</th>");
    }
    mcr_text_put(out, "</tr></thead>\n<tbody>\n");
    for (uint32_t i = 0; i < page->group_count && i < MCR_PAGE_ROWS; i++) {
        const struct mcr_page_group *group = &page->group[i];
        mcr_text_printf(out, "<tr%s><th scope=\"row\">%u</th><th scope=\"row\">%u</th>", i && group->depth != last ? " class=\"part\"" : "",
                        group->depth, group->spp);
        last = group->depth;
        for (uint32_t c = 0; c < rows_of(page); c++) {
            const struct mcr_study_cell *cell = mcr_page_cell(page, group, c);
            if (cell && cell->run_count)
                put_time(page, cell);
            else
                mcr_text_put(out, "<td>\u2014</td>");
        }
        mcr_text_put(out, "</tr>\n");
    }
    mcr_text_put(out, "</tbody>");
    mcr_page_table_end(page);
}

/* The runs that a trimmed mean leaves out: the first lowest and the first highest. */
static void discarded(const struct mcr_study_cell *cell, uint32_t runs, uint32_t index[2])
{
    index[0] = index[1] = UINT32_MAX;
    if (runs < 3)
        return;
    index[0] = 0;
    for (uint32_t i = 1; i < runs; i++)
        if (cell->run[i].wall_seconds < cell->run[index[0]].wall_seconds)
            index[0] = i;
    index[1] = index[0] ? 0 : 1;
    for (uint32_t i = 0; i < runs; i++)
        if (i != index[0] && cell->run[i].wall_seconds > cell->run[index[1]].wall_seconds)
            index[1] = i;
}

static void put_runs(struct mcr_page *page, const struct mcr_study_cell *cell, uint32_t columns)
{
    uint32_t runs = cell->run_count < page->study->plan->runs ? cell->run_count : page->study->plan->runs, out[2];
    discarded(cell, runs, out);
    for (uint32_t i = 0; i < columns; i++) {
        mcr_text_put(page->out, i == out[0] || i == out[1] ? "<td class=\"off\">" : "<td>");
        mcr_page_number(page, i < runs ? cell->run[i].wall_seconds : NAN, 4);
        mcr_text_put(page->out, "</td>");
    }
    const struct mcr_cell_analysis *known = mcr_page_known(page, cell);
    mcr_text_put(page->out, "<td><b>");
    mcr_page_number(page, known->wall.trimmed.value, 4);
    mcr_text_put(page->out, "</b><br/>");
    mcr_page_range(page, &known->wall.trimmed, 4);
    mcr_text_put(page->out, "</td>");
    put_interval(page, &known->wall.median, 4);
    put_interval(page, &known->cpu.trimmed, 4);
}

/* Rows: techniques. Columns: each run's time, and the mean. */
static void put_time_table(struct mcr_page *page, const struct mcr_page_group *group)
{
    struct mcr_text *out = page->out;
    uint32_t runs = page->study->plan->runs, columns = runs < MCR_PAGE_RUNS ? runs : MCR_PAGE_RUNS;
    mcr_page_table_begin(page, "Render time of each run in seconds");
    mcr_text_put(out, "<thead><tr><th scope=\"col\">technique</th>");
    for (uint32_t i = 0; i < columns; i++)
        mcr_text_printf(out, "<th scope=\"col\">time\u00a0%u</th>", i);
    mcr_text_put(out, "<th scope=\"col\">trimmed mean</th><th scope=\"col\">median</th><th scope=\"col\">CPU time, trimmed "
                      "mean</th></tr></thead>\n<tbody>\n");
    for (uint32_t c = 0; c < rows_of(page); c++) {
        const struct mcr_study_cell *cell = mcr_page_cell(page, group, c);
        if (!cell)
            continue;
        mcr_text_put(out, "<tr><th scope=\"row\" class=\"name\">");
        mcr_page_put_label(page, c);
        mcr_text_put(out, "</th>");
        put_runs(page, cell, columns);
        mcr_text_put(out, "</tr>\n");
    }
    mcr_text_put(out, "</tbody>");
    mcr_page_table_end(page);
    if (columns < runs)
        mcr_text_printf(out, "<p class=\"fine\">Times %u and on are in study.csv.</p>\n", columns);
}

void mcr_page_times(struct mcr_page *page)
{
    mcr_text_put(page->out, "<section id=\"times\">\n<h2>Time</h2>\n<p>Seconds of rendering alone, without building the scene and writing "
                            "the image. <b>Bold</b>: the mean without the "
                            "lowest and the highest run; below it its interval, and the median.</p>\n");
    put_overview(page);
    mcr_text_put(page->out, "<h3>Run by run</h3>\n<p>Grey: the lowest and the highest, which the trimmed mean leaves out.</p>\n");
    each_group(page, put_time_table);
    mcr_text_put(page->out, "</section>\n");
}

/* ---- quality --------------------------------------------------------------------------------------------------------------------- */

/* PSNR, SNR, SSIM and MSE first, as the founding study has them; then what this one adds, and behind it the other metrics. */
#define LEADING 4u
static const uint32_t metric_order[MCR_METRIC_COUNT] = {
    MCR_METRIC_PSNR, MCR_METRIC_SNR, MCR_METRIC_SSIM, MCR_METRIC_MSE, /* LEADING */
    MCR_METRIC_MS_SSIM, MCR_METRIC_RELMSE, MCR_METRIC_RMSE, MCR_METRIC_MAE,
    MCR_METRIC_SMAPE, MCR_METRIC_SNR_VARIANCE, MCR_METRIC_MEAN_RATIO,
};

static int wanted(const struct mcr_page *page, uint32_t metric)
{
    return metric == MCR_METRIC_MSE || (page->study->plan->metrics >> metric & 1);
}

static void put_metrics(struct mcr_page *page, const struct mcr_cell_analysis *known, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++)
        if (wanted(page, metric_order[i]))
            put_interval(page, &known->metric[metric_order[i]], 4);
}

static void put_titles(struct mcr_page *page, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++)
        if (wanted(page, metric_order[i]))
            mcr_text_printf(page->out, "<th scope=\"col\">%s</th>", mcr_metric_title(metric_order[i]));
}

static void put_quality_row(struct mcr_page *page, const struct mcr_study_cell *cell)
{
    const struct mcr_cell_analysis *known = mcr_page_known(page, cell);
    put_metrics(page, known, 0, LEADING);
    put_interval(page, &known->error, 4);
    put_interval(page, &known->efficiency, 3);
    put_interval(page, &known->speed, 3);
    mcr_text_put(page->out, "<td class=\"say\">");
    mcr_page_marks(page, known->marks);
    mcr_text_put(page->out, "</td>");
    put_metrics(page, known, LEADING, MCR_METRIC_COUNT);
}

static void put_quality_table(struct mcr_page *page, const struct mcr_page_group *group)
{
    struct mcr_text *out = page->out;
    mcr_page_table_begin(page, "Image quality and efficiency");
    mcr_text_put(out, "<thead><tr><th scope=\"col\">technique</th>");
    put_titles(page, 0, LEADING);
    mcr_text_put(out, "<th scope=\"col\">error</th><th scope=\"col\">relative efficiency</th><th scope=\"col\">relative speed</th>"
                      "<th scope=\"col\" class=\"say\">marks</th>");
    put_titles(page, LEADING, MCR_METRIC_COUNT);
    mcr_text_put(out, "</tr></thead>\n<tbody>\n");
    for (uint32_t c = 0; c < rows_of(page); c++) {
        const struct mcr_study_cell *cell = mcr_page_cell(page, group, c);
        if (!cell)
            continue;
        mcr_text_put(out, "<tr><th scope=\"row\" class=\"name\">");
        mcr_page_put_label(page, c);
        mcr_text_put(out, "</th>");
        put_quality_row(page, cell);
        mcr_text_put(out, "</tr>\n");
    }
    mcr_text_put(out, "</tbody>");
    mcr_page_table_end(page);
}

void mcr_page_quality(struct mcr_page *page)
{
    const struct mcr_study_plan *plan = page->study->plan;
    mcr_text_printf(page->out, "<section id=\"quality\">\n<h2>Image quality</h2>\n<p>Means over the seeds, against the reference, on %s, "
                               "peak\u00a0",
                    plan->how.encoding == MCR_ENCODING_SRGB8 ? "8-bit sRGB codes" : "linear values");
    mcr_text_short(page->out, mcr_metrics_peak(&plan->how), 6);
    mcr_text_put(page->out, ". <i>Error</i> is the MSE without the reference\u2019s own noise; "
                            "<i>efficiency</i> is 1/(error \u00d7 time), "
                            "relative to <code>");
    mcr_page_user(page, plan->baseline < plan->sampler_count ? plan->sampler[plan->baseline] : "");
    mcr_text_put(page->out, "</code>, as is <i>speed</i>.</p>\n");
    each_group(page, put_quality_table);
    mcr_text_put(page->out, "</section>\n");
}
