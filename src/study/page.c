/* SPDX-License-Identifier: Apache-2.0 */
#include "study/page.h"

#include <math.h>

#include "study/words.h"

const struct mcr_study_cell *mcr_page_cell(const struct mcr_page *page, const struct mcr_page_group *group, uint32_t contestant)
{
    uint32_t index = page->at[(size_t)group->number * page->study->contestant_count + contestant];
    return index == MCR_NO_CELL ? NULL : &page->study->cell[index];
}

const struct mcr_cell_analysis *mcr_page_known(const struct mcr_page *page, const struct mcr_study_cell *cell)
{
    return &page->analysis->cell[cell - page->study->cell];
}

const char *mcr_page_label(const struct mcr_page *page, uint32_t contestant)
{
    return contestant < page->study->contestant_count ? page->study->contestant[contestant] : "";
}

void mcr_page_user(struct mcr_page *page, const char *text)
{
    mcr_text_html(page->out, text);
}

void mcr_page_put_label(struct mcr_page *page, uint32_t contestant)
{
    mcr_text_html_breaks(page->out, mcr_page_label(page, contestant));
}

void mcr_page_contestant(struct mcr_page *page, uint32_t contestant)
{
    mcr_text_put(page->out, "<b class=\"who\">");
    mcr_page_put_label(page, contestant);
    mcr_text_put(page->out, "</b>");
}

void mcr_page_number(struct mcr_page *page, double x, int digits)
{
    mcr_text_digits_html(page->out, x, digits);
}

void mcr_page_range(struct mcr_page *page, const struct mcr_interval *interval, int digits)
{
    if (isnan(interval->low) || isnan(interval->high))
        return;
    mcr_text_put(page->out, "<span class=\"range\">[");
    mcr_text_digits_html(page->out, interval->low, digits);
    mcr_text_put(page->out, ", ");
    mcr_text_digits_html(page->out, interval->high, digits);
    mcr_text_put(page->out, "]</span>");
}

void mcr_page_group_words(struct mcr_page *page, const struct mcr_page_group *group)
{
    mcr_text_printf(page->out, "%u\u00a0spp, depth\u00a0%u", group->spp, group->first_depth);
    if (group->first_depth != group->depth)
        mcr_text_printf(page->out, "\u2013%u", group->depth);
}

void mcr_page_marks(struct mcr_page *page, uint32_t marks)
{
    for (uint32_t i = 0; i < MCR_MARK_COUNT; i++)
        if (marks >> i & 1)
            mcr_text_printf(page->out, " <span class=\"mark\">%s</span>", mcr_mark_word[i]);
}

void mcr_page_table_begin(struct mcr_page *page, const char *label)
{
    mcr_text_put(page->out, "<div class=\"wide\" role=\"region\" tabindex=\"0\" aria-label=\"");
    mcr_text_html(page->out, label);
    mcr_text_put(page->out, "\"><table>\n");
}

void mcr_page_table_end(struct mcr_page *page)
{
    mcr_text_put(page->out, "</table></div>\n");
}

void mcr_page_whole_list(struct mcr_page *page, const uint32_t *list, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        mcr_text_printf(page->out, "%s%u", !i ? "" : i + 1 < count ? ", " : " and ", list[i]);
}
