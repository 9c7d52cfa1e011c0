/* SPDX-License-Identifier: Apache-2.0 */
/* What the parts of report.html share: the text that grows, the study, and where its cells stand. */
#ifndef MCR_STUDY_PAGE_H
#define MCR_STUDY_PAGE_H

#include "study/analysis.h"
#include "study/text.h"

#define MCR_NO_CELL UINT32_MAX

/* What bounds the page; what is left out is told there. */
#define MCR_PAGE_GROUPS 48u      /* tables of groups */
#define MCR_PAGE_PAIRS 600u      /* rows of verdicts */
#define MCR_PAGE_PANELS 8u       /* depths that are plotted */
#define MCR_PAGE_PICTURES 40u    /* contestants that are shown */
#define MCR_PAGE_RUNS 40u        /* columns of single times */
#define MCR_PAGE_ROWS 400u       /* of any other table */

/* Cells that are compared with each other: of one spp, and of one depth unless depths compete. */
struct mcr_page_group {
    uint32_t number;         /* as in cell->group */
    uint32_t spp, depth;     /* depth: the greatest */
    uint32_t first_depth;    /* the least; differs where depths compete */
    uint32_t cells;
};

struct mcr_page {
    struct mcr_text *out;
    const struct mcr_study *study;
    const struct mcr_analysis *analysis;
    uint32_t *at;                  /* [group number * contestant_count + contestant]: index of a cell, or MCR_NO_CELL */
    uint32_t group_count;          /* that have cells */
    struct mcr_page_group *group;  /* by rising depth, then spp: the last is the greatest */
    uint32_t run_count, run_total; /* finished, planned */
};

/* The cell of contestant c in a group; NULL. And what is known of it. */
const struct mcr_study_cell *mcr_page_cell(const struct mcr_page *page, const struct mcr_page_group *group, uint32_t contestant);
const struct mcr_cell_analysis *mcr_page_known(const struct mcr_page *page, const struct mcr_study_cell *cell);
const char *mcr_page_label(const struct mcr_page *page, uint32_t contestant);

/* Small pieces. A user's text is escaped. */
void mcr_page_user(struct mcr_page *page, const char *text);
void mcr_page_put_label(struct mcr_page *page, uint32_t contestant);            /* may be broken behind each "(" */
void mcr_page_contestant(struct mcr_page *page, uint32_t contestant);           /* its label, as <b class="who"> */
void mcr_page_number(struct mcr_page *page, double x, int digits);
void mcr_page_range(struct mcr_page *page, const struct mcr_interval *interval, int digits); /* "[2.1, 2.5]"; nothing where it is unknown */
void mcr_page_group_words(struct mcr_page *page, const struct mcr_page_group *group);        /* "100 spp, depth 50" */
void mcr_page_marks(struct mcr_page *page, uint32_t marks);                     /* words, as little badges */
/* A table in a box that scrolls sideways by itself; `label` names it for those who cannot see it. */
void mcr_page_table_begin(struct mcr_page *page, const char *label);
void mcr_page_table_end(struct mcr_page *page);
void mcr_page_whole_list(struct mcr_page *page, const uint32_t *list, uint32_t count); /* "1, 100 and 1000" */

/* The sections, in the order of the page. */
void mcr_page_question(struct mcr_page *page);
void mcr_page_answer(struct mcr_page *page);
void mcr_page_pictures(struct mcr_page *page);
void mcr_page_plots(struct mcr_page *page);
void mcr_page_times(struct mcr_page *page);
void mcr_page_quality(struct mcr_page *page);
void mcr_page_series(struct mcr_page *page);
void mcr_page_caveats(struct mcr_page *page);
void mcr_page_repeat(struct mcr_page *page);
/* <style>. */
void mcr_page_style(struct mcr_page *page);

#endif
