/* SPDX-License-Identifier: Apache-2.0 */
/* Convergence, the time to a target, coverage and marks. */
#include <math.h>

#include "study/page.h"
#include "study/words.h"

static void put_interval(struct mcr_page *page, const struct mcr_interval *interval, int digits)
{
    mcr_page_number(page, interval->value, digits);
    mcr_text_put(page->out, " ");
    mcr_page_range(page, interval, digits);
}

static void put_target(struct mcr_page *page, const struct mcr_series_analysis *series)
{
    mcr_text_put(page->out, "<td class=\"say line\">");
    if (series->target == MCR_TARGET_UNREACHABLE || isnan(series->time_to_target.value)) {
        mcr_text_put(page->out, series->target == MCR_TARGET_UNREACHABLE ? "out of reach" : "unknown");
    } else {
        put_interval(page, &series->time_to_target, 3);
        mcr_text_printf(page->out, " s, %s", mcr_target_word(series->target));
    }
    mcr_text_put(page->out, "</td>");
}

static void put_series(struct mcr_page *page)
{
    struct mcr_text *out = page->out;
    const struct mcr_study *study = page->study;
    mcr_page_table_begin(page, "Convergence of each contestant");
    mcr_text_put(out, "<thead><tr><th scope=\"col\">contestant</th><th scope=\"col\">depth</th><th scope=\"col\">slope over spp</th><th "
                      "scope=\"col\">slope over time</th>"
                      "<th scope=\"col\" class=\"say\">time to the target</th><th scope=\"col\" "
                      "class=\"say\">marks</th></tr></thead>\n<tbody>\n");
    for (uint32_t i = 0; i < study->series_count && i < MCR_PAGE_ROWS; i++) {
        const struct mcr_series_analysis *series = &page->analysis->series[i];
        mcr_text_put(out, "<tr><th scope=\"row\" class=\"name\">");
        mcr_page_put_label(page, series->contestant);
        mcr_text_printf(out, "</th><td>%u</td><td>", series->depth);
        put_interval(page, &series->slope, 3);
        mcr_text_put(out, "</td><td>");
        put_interval(page, &series->time_slope, 3);
        mcr_text_put(out, "</td>");
        put_target(page, series);
        mcr_text_put(out, "<td class=\"say\">");
        mcr_page_marks(page, series->marks);
        mcr_text_put(out, "</td></tr>\n");
    }
    mcr_text_put(out, "</tbody>");
    mcr_page_table_end(page);
    if (study->series_count > MCR_PAGE_ROWS)
        mcr_text_printf(out, "<p class=\"fine\">%u more are in study.json.</p>\n", study->series_count - MCR_PAGE_ROWS);
}

void mcr_page_series(struct mcr_page *page)
{
    mcr_text_put(page->out, "<section id=\"convergence\">\n<h2>Convergence and time to a target</h2>\n<p>The slope is that of log error "
                            "over log spp (or log time): \u22121 for independent "
                            "samples without bias, steeper where samples are spread well, flatter where a bias shows. The target is an MSE "
                            "of <b>");
    mcr_page_number(page, page->analysis->target, 3);
    mcr_text_put(page->out, page->analysis->target_chosen ? "</b>, chosen in the middle of what the contestants reached"
                                                          : "</b>, as the study asks");
    mcr_text_put(page->out, "; <i>measured</i> is between two measured cells, <i>extrapolated</i> along the slope beyond them.</p>\n");
    put_series(page);
    mcr_text_put(page->out, "</section>\n");
}

/* ---- what to be careful with ----------------------------------------------------------------------------------------------------- */

static void put_coverage(struct mcr_page *page)
{
    struct mcr_text *out = page->out;
    mcr_page_table_begin(page, "Coverage of each contestant");
    mcr_text_put(out, "<thead><tr><th scope=\"col\">contestant</th><th scope=\"col\" class=\"say\">covers the light paths of this "
                      "scene</th></tr></thead>\n<tbody>\n");
    for (uint32_t c = 0; c < page->study->contestant_count && c < MCR_PAGE_ROWS; c++) {
        const struct mcr_study_cell *cell = NULL;
        for (uint32_t g = 0; g < page->group_count && !cell; g++)
            cell = mcr_page_cell(page, &page->group[g], c);
        if (!cell)
            continue;
        mcr_text_put(out, "<tr><th scope=\"row\" class=\"name\">");
        mcr_page_put_label(page, c);
        mcr_text_put(out, cell->coverage.complete ? "</th><td class=\"say\">all" : "</th><td class=\"say\"><b>incomplete</b>: misses ");
        if (!cell->coverage.complete)
            mcr_page_user(page, *cell->coverage.missing ? cell->coverage.missing : "some");
        mcr_text_put(out, "</td></tr>\n");
    }
    mcr_text_put(out, "</tbody>");
    mcr_page_table_end(page);
}

/* The cells of one contestant that carry a mark: "everywhere", or which, up to a number. Returns how many. */
static uint32_t put_marked_cells(struct mcr_page *page, uint32_t contestant, uint32_t mark, const char *between)
{
    enum { NAMED = 6 };
    struct mcr_text *out = page->out;
    uint32_t marked = 0, cells = 0, named = 0;
    for (uint32_t g = 0; g < page->group_count; g++) {
        const struct mcr_study_cell *cell = mcr_page_cell(page, &page->group[g], contestant);
        cells += cell != NULL;
        marked += cell && (mcr_page_known(page, cell)->marks >> mark & 1);
    }
    if (!marked)
        return 0;
    mcr_text_put(out, between);
    mcr_page_contestant(page, contestant);
    mcr_text_put(out, marked == cells && cells > 1 ? " everywhere" : " at ");
    for (uint32_t g = page->group_count; g-- > 0 && marked < cells + (cells == 1);) {
        const struct mcr_study_cell *cell = mcr_page_cell(page, &page->group[g], contestant);
        if (!cell || !(mcr_page_known(page, cell)->marks >> mark & 1) || ++named > NAMED)
            continue;
        mcr_text_printf(out, "%s%u\u00a0spp, depth\u00a0%u", named > 1 ? " and " : "", cell->settings.spp, cell->settings.depth);
    }
    if (named > NAMED)
        mcr_text_printf(out, " and %u more", named - NAMED);
    return marked;
}

/* One mark: what it means, and the cells that carry it. */
static void put_mark(struct mcr_page *page, uint32_t mark)
{
    uint32_t found = 0;
    mcr_text_printf(page->out, "<dt><span class=\"mark\">%s</span></dt>\n<dd>", mcr_mark_word[mark]);
    mcr_page_user(page, mcr_mark_sentence[mark]);
    mcr_text_put(page->out, ": ");
    for (uint32_t c = 0; c < page->study->contestant_count && c < MCR_PAGE_ROWS; c++)
        found += put_marked_cells(page, c, mark, found ? "; " : "") > 0;
    mcr_text_put(page->out, ".</dd>\n");
}

void mcr_page_caveats(struct mcr_page *page)
{
    uint32_t marks = 0;
    for (uint32_t i = 0; i < page->study->cell_count; i++)
        marks |= page->analysis->cell[i].marks;
    mcr_text_put(page->out, "<section id=\"caveats\">\n<h2>Coverage and marks</h2>\n");
    put_coverage(page);
    if (marks) {
        mcr_text_put(page->out, "<dl class=\"marks\">\n");
        for (uint32_t i = 0; i < MCR_MARK_COUNT; i++)
            if (marks >> i & 1)
                put_mark(page, i);
        mcr_text_put(page->out, "</dl>\n");
    } else {
        mcr_text_put(page->out, "<p>No cell is marked.</p>\n");
    }
    mcr_text_put(page->out, "</section>\n");
}
