/* SPDX-License-Identifier: Apache-2.0 */
/* Error against samples and error against time, a pair of plots a depth. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "study/page.h"
#include "study/plot.h"
#include "study/words.h"

/* A run of groups of one depth, and a series of points for each contestant in it. */
struct panel {
    struct mcr_page *page;
    const struct mcr_page_group *group; /* by rising spp */
    uint32_t groups, number;
    struct mcr_plot_series *series;     /* of contestant_count */
    struct mcr_plot_point *point;       /* groups to each series */
    const struct mcr_plot_point **rank; /* scratch for the front */
    double *tick;                       /* the spp */
};

static void panel_fini(struct panel *panel)
{
    free(panel->series);
    free(panel->point);
    free(panel->rank);
    free(panel->tick);
}

static int panel_init(struct panel *panel)
{
    size_t contestants = panel->page->study->contestant_count, points = contestants * panel->groups; /* <= what page->at holds */
    panel->series = calloc(contestants + 1, sizeof *panel->series);
    panel->point = calloc(points + 1, sizeof *panel->point);
    panel->rank = calloc(points + 1, sizeof *panel->rank);
    panel->tick = calloc(panel->groups + 1, sizeof *panel->tick);
    return panel->series && panel->point && panel->rank && panel->tick ? 0 : -1;
}

/* The series with spp or time as x. */
static void fill(struct panel *panel, int by_time)
{
    struct mcr_page *page = panel->page;
    for (uint32_t c = 0; c < page->study->contestant_count; c++) {
        struct mcr_plot_series *series = &panel->series[c];
        *series = (struct mcr_plot_series){mcr_page_label(page, c), c % MCR_PLOT_STYLES, 0, panel->point + (size_t)c * panel->groups};
        for (uint32_t g = 0; g < panel->groups; g++) {
            const struct mcr_study_cell *cell = mcr_page_cell(page, &panel->group[g], c);
            if (!cell || !cell->run_count)
                continue;
            const struct mcr_cell_analysis *known = mcr_page_known(page, cell);
            const struct mcr_interval spp = {cell->settings.spp, NAN, NAN};
            series->point[series->count++] =
                (struct mcr_plot_point){by_time ? known->wall.trimmed : spp, known->error, (known->marks & MCR_MARK_UNRANKED) != 0, 0};
        }
    }
}

static int by_x_then_y(const void *a, const void *b)
{
    const struct mcr_plot_point *first = *(const struct mcr_plot_point *const *)a, *second = *(const struct mcr_plot_point *const *)b;
    if (first->x.value != second->x.value)
        return first->x.value < second->x.value ? -1 : 1;
    return first->y.value < second->y.value ? -1 : first->y.value > second->y.value;
}

/* Marks the ranked points than which no other is both faster and nearer to the reference. */
static void mark_front(struct panel *panel)
{
    uint32_t count = 0;
    double least = INFINITY;
    for (uint32_t c = 0; c < panel->page->study->contestant_count; c++) {
        for (uint32_t i = 0; i < panel->series[c].count; i++) {
            struct mcr_plot_point *point = &panel->series[c].point[i];
            if (!point->hollow && point->x.value > 0 && point->y.value > 0)
                panel->rank[count++] = point;
        }
    }
    qsort(panel->rank, count, sizeof *panel->rank, by_x_then_y);
    for (uint32_t i = 0; i < count; i++) {
        struct mcr_plot_point *point = panel->point + (panel->rank[i] - panel->point);
        point->front = point->y.value < least;
        least = point->front ? point->y.value : least;
    }
}

static void put_legend(struct panel *panel)
{
    struct mcr_page *page = panel->page;
    int hollow = 0;
    mcr_text_put(page->out, "<ul class=\"legend\">\n");
    for (uint32_t c = 0; c < page->study->contestant_count; c++) {
        if (!panel->series[c].count)
            continue;
        mcr_text_put(page->out, "<li>");
        mcr_plot_swatch(page->out, panel->series[c].style);
        mcr_page_put_label(page, c);
        mcr_text_put(page->out, "</li>\n");
        for (uint32_t i = 0; i < panel->series[c].count; i++)
            hollow |= panel->series[c].point[i].hollow;
    }
    if (hollow)
        mcr_text_put(page->out, "<li class=\"note\">hollow: marked, not ranked</li>\n");
    mcr_text_put(page->out, "<li class=\"note\"><svg class=\"swatch\" viewBox=\"0 0 40 16\" aria-hidden=\"true\"><path class=\"front\" "
                            "d=\"M2 3V12H38\"/></svg>Pareto front: "
                            "nothing ranked is both faster and nearer to the reference</li>\n</ul>\n");
}

static void put_plot(struct panel *panel, int by_time)
{
    struct mcr_page *page = panel->page;
    const struct mcr_study *study = page->study;
    const struct mcr_page_group *group = panel->group;
    char id[64], title[160], y_label[80];
    double noise = NAN;
    for (uint32_t c = 0; c < study->contestant_count && isnan(noise); c++) {
        const struct mcr_study_cell *cell = mcr_page_cell(page, group, c);
        if (cell && cell->reference < study->reference_count)
            noise = study->reference[cell->reference].noise;
    }
    const struct mcr_plot_level level[2] = {{noise > 0 ? noise : NAN, "the reference\u2019s own noise"}, {page->analysis->target > 0 ?
                                                                                                          page->analysis->target : NAN,
                                                                                                              "target"}};
    snprintf(id, sizeof id, "plot-%u-%s", panel->number, by_time ? "time" : "spp");
    snprintf(title, sizeof title, "Error against %s at depth %u%s", by_time ? "render time" : "samples per pixel", group->depth,
             group->depth != group->first_depth ? " and below" : "");
    snprintf(y_label, sizeof y_label, "error (MSE%s)", study->plan->how.encoding == MCR_ENCODING_SRGB8 ? ", 8-bit sRGB codes" : "");
    struct mcr_plot plot = {.id = id, .title = title, .x_label = by_time ? "render time (s)" : "samples per pixel (spp)", .y_label = y_label,
                            .x_unit = by_time ? "s" : "spp", .series_count = study->contestant_count, .level_count = 2,
                                .tick_count = by_time ? 0 : panel->groups,
                            .series = panel->series, .level = level, .tick = by_time ? NULL : panel->tick, .has_front = by_time};
    mcr_text_put(page->out, "<figure class=\"plot\">\n");
    mcr_plot_write(page->out, &plot);
    mcr_text_put(page->out, "<figcaption>");
    mcr_page_user(page, title);
    mcr_text_put(page->out, by_time ? ": trimmed mean of the runs. Down and left is better." : ".");
    mcr_text_put(page->out, "</figcaption>\n</figure>\n");
}

static void put_panel(struct panel *panel)
{
    struct mcr_text *out = panel->page->out;
    if (panel_init(panel)) {
        out->failed = 1;
        return;
    }
    for (uint32_t g = 0; g < panel->groups; g++)
        panel->tick[g] = panel->group[g].spp;
    fill(panel, 0);
    mcr_text_printf(out, "<h3>Depth %u%s</h3>\n", panel->group->depth, panel->group->depth != panel->group->first_depth ?
                    " and below, in competition" : "");
    put_legend(panel);
    mcr_text_put(out, "<div class=\"plots\">\n");
    put_plot(panel, 0);
    fill(panel, 1);
    mark_front(panel);
    put_plot(panel, 1);
    mcr_text_put(out, "</div>\n");
}

/* The greatest depth first: it is what the answer is about. */
void mcr_page_plots(struct mcr_page *page)
{
    uint32_t end = page->group_count, number = 0;
    mcr_text_put(page->out, "<section id=\"plots\">\n<h2>Error against samples and time</h2>\n<p>Both axes are logarithmic. An error bar is "
                            "an interval of ");
    mcr_text_short(page->out, page->study->plan->confidence * 100, 4);
    mcr_text_put(page->out, "\u00a0% confidence; without bias the error falls tenfold with ten times the samples.</p>\n");
    while (end && number < MCR_PAGE_PANELS) {
        uint32_t first = end - 1;
        while (first && page->group[first - 1].depth == page->group[end - 1].depth)
            first--;
        struct panel panel = {.page = page, .group = &page->group[first], .groups = end - first, .number = number++};
        put_panel(&panel);
        panel_fini(&panel);
        end = first;
    }
    if (end)
        mcr_text_put(page->out, "<p class=\"fine\">The lesser depths are in the tables and in study.json.</p>\n");
    mcr_text_put(page->out, "</section>\n");
}
