/* SPDX-License-Identifier: Apache-2.0 */
/* report.html: one page for people, XML as well as HTML, without scripts and without anything from elsewhere. */
#include "study/report.h"

#include <stdio.h>
#include <stdlib.h>

#include "study/page.h"

static int by_depth_then_spp(const void *a, const void *b)
{
    const struct mcr_page_group *first = a, *second = b;
    if (first->depth != second->depth)
        return first->depth < second->depth ? -1 : 1;
    if (first->spp != second->spp)
        return first->spp < second->spp ? -1 : 1;
    return first->number < second->number ? -1 : first->number > second->number;
}

/* Enters a cell into its group. */
static void place_cell(struct mcr_page *page, uint32_t index)
{
    const struct mcr_study_cell *cell = &page->study->cell[index];
    if (cell->group >= page->study->group_count || cell->contestant >= page->study->contestant_count)
        return;
    struct mcr_page_group *group = &page->group[cell->group];
    uint32_t depth = cell->settings.depth;
    page->at[(size_t)cell->group * page->study->contestant_count + cell->contestant] = index;
    group->spp = cell->settings.spp;
    group->depth = !group->cells || depth > group->depth ? depth : group->depth;
    group->first_depth = !group->cells || depth < group->first_depth ? depth : group->first_depth;
    group->cells++;
    page->run_count += cell->run_count;
}

/* 0, or -1 when memory is short. */
static int page_init(struct mcr_page *page)
{
    const struct mcr_study *study = page->study;
    size_t places;
    if (__builtin_mul_overflow((size_t)study->group_count, study->contestant_count, &places) || places > (size_t)1 << 28)
        return -1;
    page->at = malloc((places + 1) * sizeof *page->at);
    page->group = calloc((size_t)study->group_count + 1, sizeof *page->group);
    if (!page->at || !page->group)
        return -1;
    for (size_t i = 0; i < places; i++)
        page->at[i] = MCR_NO_CELL;
    for (uint32_t i = 0; i < study->group_count; i++)
        page->group[i].number = i;
    for (uint32_t i = 0; i < study->cell_count; i++)
        place_cell(page, i);
    for (uint32_t i = 0; i < study->group_count; i++)
        if (page->group[i].cells)
            page->group[page->group_count++] = page->group[i];
    qsort(page->group, page->group_count, sizeof *page->group, by_depth_then_spp);
    const struct mcr_study_plan *plan = study->plan;
    page->run_total = study->cell_count * (plan->runs > plan->seeds ? plan->runs : plan->seeds);
    return 0;
}

static void head(struct mcr_page *page)
{
    struct mcr_text *out = page->out;
    mcr_text_put(out, "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
                      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<meta name=\"color-scheme\" "
                      "content=\"light dark\"/>\n"
                      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; img-src "
                      "data:\"/>\n"
                      "<meta name=\"generator\" content=\"mcrender ");
    mcr_page_user(page, page->study->version);
    mcr_text_put(out, "\"/>\n<title>");
    mcr_page_user(page, page->study->plan->title);
    mcr_text_put(out, "</title>\n");
    mcr_page_style(page);
    mcr_text_put(out, "</head>\n<body>\n<main>\n<header>\n<p class=\"kind\">mcrender study</p>\n<h1>");
    mcr_page_user(page, page->study->plan->title);
    mcr_text_put(out, "</h1>\n</header>\n");
}

static void build(struct mcr_page *page)
{
    head(page);
    mcr_page_question(page);
    mcr_page_answer(page);
    mcr_page_pictures(page);
    mcr_page_plots(page);
    mcr_page_times(page);
    mcr_page_quality(page);
    mcr_page_series(page);
    mcr_page_caveats(page);
    mcr_page_repeat(page);
    mcr_text_put(page->out, "</main>\n</body>\n</html>\n");
}

int mcr_study_write_html(struct mcr_target *target, const struct mcr_study *study, const struct mcr_analysis *analysis, char *error,
                         size_t length)
{
    struct mcr_text out = {0};
    struct mcr_page page = {.out = &out, .study = study, .analysis = analysis};
    int status = page_init(&page);
    if (!status)
        build(&page);
    if (status || out.failed) {
        snprintf(error, length, "not enough memory for the study's report");
        mcr_target_cancel(target);
        status = -1;
    } else {
        status = mcr_target_write_text(target, out.bytes, out.used, error, length);
    }
    mcr_text_fini(&out);
    free(page.at);
    free(page.group);
    return status;
}
