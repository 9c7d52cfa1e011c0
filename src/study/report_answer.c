/* SPDX-License-Identifier: Apache-2.0 */
/* The head of report.html: what was asked, and the answer in words. */
#include <math.h>
#include <stdlib.h>

#include "study/page.h"
#include "study/words.h"

/* ---- the question ---------------------------------------------------------------------------------------------------------------- */

static void put_reference(struct mcr_page *page)
{
    const struct mcr_study_plan *plan = page->study->plan;
    struct mcr_text *out = page->out;
    if (plan->reference_image) {
        mcr_text_put(out, "the image <code>");
        mcr_page_user(page, plan->reference_image);
        mcr_text_put(out, "</code>");
        return;
    }
    mcr_text_put(out, "a reference rendered by <code>");
    mcr_page_user(page, plan->reference_sampler);
    mcr_text_printf(out, "</code> with %u\u00a0spp, ", plan->reference_spp);
    if (plan->has_reference_depth)
        mcr_text_printf(out, "depth\u00a0%u, ", plan->reference_depth);
    else
        mcr_text_put(out, "the contestants\u2019 depth ");
    mcr_text_put(out, "and seeds of its own");
}

static void put_design(struct mcr_page *page)
{
    const struct mcr_study_plan *plan = page->study->plan;
    struct mcr_text *out = page->out;
    mcr_text_put(out, "<p>Each was rendered with ");
    mcr_page_whole_list(page, plan->spp, plan->spp_count);
    mcr_text_put(out, " spp (samples per pixel) at depth ");
    mcr_page_whole_list(page, plan->depth, plan->depth_count);
    mcr_text_printf(out, ", with %u %s for its error and %u timed %s, in a shuffled order. The error is the mean square difference (MSE) "
                         "from ", plan->seeds,
                    plan->seeds == 1 ? "seed" : "independent seeds", plan->runs, plan->runs == 1 ? "run" : "runs");
    put_reference(page);
    mcr_text_put(out, ", less that reference\u2019s own noise where it is known. Square brackets hold intervals of ");
    mcr_text_short(out, plan->confidence * 100, 4);
    mcr_text_put(out, "\u00a0% confidence.</p>\n");
}

static void put_compat(struct mcr_page *page)
{
    uint32_t compat = 0;
    char names[MCR_COMPAT_TEXT];
    for (uint32_t i = 0; i < page->study->plan->compat_count; i++)
        compat |= page->study->plan->compat[i];
    if (!compat)
        return;
    mcr_compat_text(compat, names);
    mcr_text_put(page->out, "<p class=\"warn\"><b>Biased on purpose.</b> Some contestants render with <code>compat</code> settings (");
    mcr_page_user(page, names);
    mcr_text_put(page->out, "): they repeat known mistakes to show what these do. Their images do not converge to the right one, and they "
                            "carry the mark "
                            "<span class=\"mark\">compat</span>.</p>\n");
}

void mcr_page_question(struct mcr_page *page)
{
    const struct mcr_study *study = page->study;
    struct mcr_text *out = page->out;
    mcr_text_put(out, "<section id=\"question\">\n<h2>The question</h2>\n<p>");
    mcr_text_put(out, study->contestant_count > 1 ? "Which of these gives the less noisy image of <code>" : "How fast does this become an "
                                                                                                            "image of <code>");
    mcr_page_user(page, study->scene_path);
    mcr_text_printf(out, "</code> (%u\u00a0\u00d7\u00a0%u pixels) in the same time, by how much, and how sure is that?</p>\n<ul "
                         "class=\"contestants\">", study->width,
                    study->height);
    for (uint32_t c = 0; c < study->contestant_count && c < MCR_PAGE_ROWS; c++) {
        mcr_text_put(out, "<li><code>");
        mcr_page_put_label(page, c);
        mcr_text_put(out, "</code></li>\n");
    }
    mcr_text_put(out, "</ul>\n");
    put_design(page);
    if (page->run_count < page->run_total)
        mcr_text_printf(out, "<p class=\"warn\"><b>Not finished:</b> %u of %u runs are here. What follows is what these say; the study goes "
                             "on where it stopped when it is "
                             "started again.</p>\n", page->run_count, page->run_total);
    put_compat(page);
    mcr_text_put(out, "</section>\n");
}

/* ---- the answer ------------------------------------------------------------------------------------------------------------------ */

/* The pairs of the group that the answer is about, by one of the two measures. */
struct contest {
    struct mcr_page *page;
    const struct mcr_page_group *group;
    int equal_time;
    uint32_t pair_count;
    const struct mcr_pair_analysis **pair;
    uint32_t *ranked, *defeats; /* of each contestant: pairs that were judged; lost ones */
};

static const struct mcr_pair_test *test_of(const struct contest *contest, const struct mcr_pair_analysis *pair)
{
    return contest->equal_time ? &pair->equal_time : &pair->equal_spp;
}

static uint32_t contestant_of(const struct contest *contest, uint32_t cell)
{
    return contest->page->study->cell[cell].contestant;
}

/* How much better the winner is, whichever of the two it is. */
static struct mcr_interval factor_of(const struct mcr_pair_test *test)
{
    struct mcr_interval factor = test->ratio;
    if (test->verdict == MCR_VERDICT_WORSE)
        factor = (struct mcr_interval){1 / test->ratio.value, 1 / test->ratio.high, 1 / test->ratio.low};
    return factor;
}

static void put_factor(struct mcr_page *page, const struct mcr_pair_test *test)
{
    struct mcr_interval factor = factor_of(test);
    mcr_text_put(page->out, "by a factor <b>");
    mcr_page_number(page, factor.value, 3);
    mcr_text_put(page->out, "</b>\u00a0");
    mcr_page_range(page, &factor, 3);
}

/* Counts who was judged and who lost. */
static void count(struct contest *contest, int equal_time)
{
    uint32_t contestants = contest->page->study->contestant_count;
    contest->equal_time = equal_time;
    for (uint32_t c = 0; c < contestants; c++)
        contest->ranked[c] = contest->defeats[c] = 0;
    for (uint32_t i = 0; i < contest->pair_count; i++) {
        const struct mcr_pair_analysis *pair = contest->pair[i];
        uint32_t a = contestant_of(contest, pair->cell_a), b = contestant_of(contest, pair->cell_b), verdict = test_of(contest,
                                                                                                                       pair)->verdict;
        if (verdict == MCR_VERDICT_EXCLUDED)
            continue;
        contest->ranked[a]++;
        contest->ranked[b]++;
        contest->defeats[a] += verdict == MCR_VERDICT_WORSE;
        contest->defeats[b] += verdict == MCR_VERDICT_BETTER;
    }
}

/* The winner's pair with the smallest factor (sign 1: the next best), or the greatest (-1: the last). */
static const struct mcr_pair_analysis *extreme_pair(const struct contest *contest, uint32_t winner, int sign)
{
    const struct mcr_pair_analysis *found = NULL;
    double least = INFINITY;
    for (uint32_t i = 0; i < contest->pair_count; i++) {
        const struct mcr_pair_analysis *pair = contest->pair[i];
        const struct mcr_pair_test *test = test_of(contest, pair);
        int wins = (contestant_of(contest, pair->cell_a) == winner && test->verdict == MCR_VERDICT_BETTER) ||
                   (contestant_of(contest, pair->cell_b) == winner && test->verdict == MCR_VERDICT_WORSE);
        double factor = sign * factor_of(test).value;
        if (!wins || !(factor < least))
            continue;
        least = factor;
        found = pair;
    }
    return found;
}

static uint32_t other_of(const struct contest *contest, const struct mcr_pair_analysis *pair, uint32_t contestant)
{
    uint32_t a = contestant_of(contest, pair->cell_a);
    return a == contestant ? contestant_of(contest, pair->cell_b) : a;
}

/* One contestant beats all others that can be ranked. */
static void put_winner(struct contest *contest, uint32_t winner, uint32_t ranked)
{
    struct mcr_page *page = contest->page;
    const struct mcr_pair_analysis *next = extreme_pair(contest, winner, 1), *last = extreme_pair(contest, winner, -1);
    mcr_page_contestant(page, winner);
    mcr_text_put(page->out, ranked > 2 ? " is better than every other that can be ranked: " : " is better than ");
    if (next && ranked > 2) {
        put_factor(page, test_of(contest, next));
        mcr_text_put(page->out, " than the next, ");
        mcr_page_contestant(page, other_of(contest, next, winner));
    } else if (next) {
        mcr_page_contestant(page, other_of(contest, next, winner));
        mcr_text_put(page->out, " ");
        put_factor(page, test_of(contest, next));
    }
    if (last && last != next && ranked > 2) {
        mcr_text_put(page->out, ", and ");
        put_factor(page, test_of(contest, last));
        mcr_text_put(page->out, " than the last, ");
        mcr_page_contestant(page, other_of(contest, last, winner));
    }
    mcr_text_put(page->out, ".");
}

/* Several that nothing beats: among them the data cannot tell, or one would have lost. */
static void put_undefeated(struct contest *contest, uint32_t undefeated, uint32_t ranked)
{
    struct mcr_page *page = contest->page;
    uint32_t said = 0;
    mcr_text_put(page->out, undefeated == ranked ? "The data cannot tell which is the best of " : "Nothing was found to be better than ");
    for (uint32_t c = 0; c < page->study->contestant_count; c++) {
        if (!contest->ranked[c] || contest->defeats[c])
            continue;
        mcr_text_put(page->out, !said ? "" : said + 1 < undefeated ? ", " : undefeated == ranked ? " and " : " or ");
        mcr_page_contestant(page, c);
        said++;
    }
    mcr_text_put(page->out, undefeated == ranked ? "." : "; among these the data cannot tell.");
}

static void put_headline(struct contest *contest, int equal_time)
{
    struct mcr_page *page = contest->page;
    uint32_t ranked = 0, undefeated = 0, best = 0;
    count(contest, equal_time);
    for (uint32_t c = 0; c < page->study->contestant_count; c++) {
        ranked += contest->ranked[c] > 0;
        if (!contest->ranked[c] || contest->defeats[c])
            continue;
        undefeated++;
        best = c;
    }
    mcr_text_printf(page->out, "<p class=\"headline\"><span class=\"measure\">%s</span> ", equal_time ? "In equal time" :
                    "With equal samples");
    if (!ranked)
        mcr_text_put(page->out, "No two contestants could be compared.");
    else if (undefeated == 1)
        put_winner(contest, best, ranked);
    else if (undefeated)
        put_undefeated(contest, undefeated, ranked);
    else
        mcr_text_put(page->out, "Each has lost to some other; see the pairs below."); /* a circle: of unlike intervals it can happen */
    mcr_text_put(page->out, "</p>\n");
}

static void put_verdict(struct mcr_page *page, const struct contest *contest, const struct mcr_pair_analysis *pair, int equal_time)
{
    struct mcr_text *out = page->out;
    const struct mcr_pair_test *test = equal_time ? &pair->equal_time : &pair->equal_spp;
    mcr_text_printf(out, "<td class=\"say %s\">", mcr_verdict_word(test->verdict));
    if (test->verdict == MCR_VERDICT_BETTER || test->verdict == MCR_VERDICT_WORSE) {
        mcr_page_contestant(page, contestant_of(contest, test->verdict == MCR_VERDICT_BETTER ? pair->cell_a : pair->cell_b));
        mcr_text_put(out, " is better ");
        put_factor(page, test);
    } else if (test->verdict == MCR_VERDICT_EXCLUDED) {
        mcr_text_put(out, "not ranked");
    } else {
        mcr_text_put(out, "the data cannot tell");
        if (!isnan(test->ratio.value)) {
            mcr_text_put(out, " (ratio ");
            mcr_page_number(page, test->ratio.value, 3);
            mcr_text_put(out, "\u00a0");
            mcr_page_range(page, &test->ratio, 3);
            mcr_text_put(out, ")");
        }
        if (test->seeds_needed)
            mcr_text_printf(out, "; about %u\u00a0seeds would", test->seeds_needed);
    }
    mcr_text_put(out, "</td>");
}

static int judged(const struct mcr_pair_analysis *pair)
{
    return pair->equal_time.verdict != MCR_VERDICT_EXCLUDED || pair->equal_spp.verdict != MCR_VERDICT_EXCLUDED;
}

static void put_pairs(struct contest *contest)
{
    struct mcr_page *page = contest->page;
    uint32_t count = 0, row = 0;
    for (uint32_t i = 0; i < contest->pair_count; i++)
        count += judged(contest->pair[i]);
    if (!count)
        return;
    int folded = count > 36;
    if (folded)
        mcr_text_printf(page->out, "<details><summary>All %u pairs</summary>\n", count);
    mcr_page_table_begin(page, "Verdicts for each pair of contestants");
    mcr_text_put(page->out, "<thead><tr><th scope=\"col\">pair</th><th scope=\"col\" class=\"say\">in equal time</th><th scope=\"col\" "
                            "class=\"say\">with equal samples</th></tr></thead>\n<tbody>\n");
    for (uint32_t i = 0; i < contest->pair_count && row < MCR_PAGE_PAIRS; i++) {
        const struct mcr_pair_analysis *pair = contest->pair[i];
        if (!judged(pair))
            continue;
        row++;
        mcr_text_put(page->out, "<tr><th scope=\"row\" class=\"name\">");
        mcr_page_put_label(page, contestant_of(contest, pair->cell_a));
        mcr_text_put(page->out, " <span class=\"range\">against</span> ");
        mcr_page_put_label(page, contestant_of(contest, pair->cell_b));
        mcr_text_put(page->out, "</th>");
        put_verdict(page, contest, pair, 1);
        put_verdict(page, contest, pair, 0);
        mcr_text_put(page->out, "</tr>\n");
    }
    mcr_text_put(page->out, "</tbody>");
    mcr_page_table_end(page);
    if (count > MCR_PAGE_PAIRS)
        mcr_text_printf(page->out, "<p class=\"fine\">%u more pairs are in study.json.</p>\n", count - MCR_PAGE_PAIRS);
    if (folded)
        mcr_text_put(page->out, "</details>\n");
}

/* Who is left out of the rankings, and why. */
static void put_marked(struct contest *contest)
{
    struct mcr_page *page = contest->page;
    uint32_t said = 0;
    for (uint32_t c = 0; c < page->study->contestant_count && said < MCR_PAGE_ROWS; c++) {
        const struct mcr_study_cell *cell = mcr_page_cell(page, contest->group, c);
        uint32_t marks = cell ? mcr_page_known(page, cell)->marks & MCR_MARK_UNRANKED : 0;
        if (!marks)
            continue;
        mcr_text_put(page->out, said++ ? "<li>" : "<p>Left out of the rankings here:</p>\n<ul>\n<li>");
        mcr_page_contestant(page, c);
        mcr_text_put(page->out, ": ");
        const char *between = "";
        for (uint32_t i = 0; i < MCR_MARK_COUNT; i++) {
            if (!(marks >> i & 1))
                continue;
            mcr_text_put(page->out, between);
            mcr_page_user(page, mcr_mark_sentence[i]);
            between = "; ";
        }
        if (marks & MCR_MARK_INCOMPLETE && *cell->coverage.missing) {
            mcr_text_put(page->out, " (it misses ");
            mcr_page_user(page, cell->coverage.missing);
            mcr_text_put(page->out, ")");
        }
        mcr_text_put(page->out, ".</li>\n");
    }
    if (said)
        mcr_text_put(page->out, "</ul>\n");
}

/* The greatest group in which two cells have an error; else the greatest. */
static const struct mcr_page_group *answered_group(const struct mcr_page *page)
{
    for (uint32_t i = page->group_count; i-- > 0;) {
        uint32_t known = 0;
        for (uint32_t c = 0; c < page->study->contestant_count; c++) {
            const struct mcr_study_cell *cell = mcr_page_cell(page, &page->group[i], c);
            known += cell && !isnan(mcr_page_known(page, cell)->metric[MCR_METRIC_MSE].value);
        }
        if (known > 1 || (known && page->study->contestant_count == 1))
            return &page->group[i];
    }
    return page->group_count ? &page->group[page->group_count - 1] : NULL;
}

static void put_alone(struct mcr_page *page, const struct mcr_page_group *group)
{
    for (uint32_t c = 0; c < page->study->contestant_count; c++) {
        const struct mcr_study_cell *cell = mcr_page_cell(page, group, c);
        if (!cell)
            continue;
        const struct mcr_cell_analysis *known = mcr_page_known(page, cell);
        mcr_text_put(page->out, "<p class=\"headline\">There is nothing to compare with: ");
        mcr_page_contestant(page, c);
        mcr_text_put(page->out, " has an MSE of <b>");
        mcr_page_number(page, known->error.value, 3);
        mcr_text_put(page->out, "</b>\u00a0");
        mcr_page_range(page, &known->error, 3);
        mcr_text_put(page->out, " after <b>");
        mcr_page_number(page, known->wall.trimmed.value, 3);
        mcr_text_put(page->out, "\u00a0s</b>.</p>\n");
        return;
    }
}

void mcr_page_answer(struct mcr_page *page)
{
    const struct mcr_analysis *analysis = page->analysis;
    uint32_t contestants = page->study->contestant_count;
    struct contest contest = {.page = page, .group = answered_group(page)};
    mcr_text_put(page->out, "<section id=\"answer\">\n<h2>The answer</h2>\n");
    contest.pair = calloc((size_t)analysis->pair_count + 1, sizeof *contest.pair);
    contest.ranked = calloc((size_t)contestants + 1, sizeof *contest.ranked);
    contest.defeats = calloc((size_t)contestants + 1, sizeof *contest.defeats);
    if (!contest.pair || !contest.ranked || !contest.defeats) {
        page->out->failed = 1;
    } else if (contest.group) {
        mcr_text_put(page->out, "<p class=\"at\">At ");
        mcr_page_group_words(page, contest.group);
        mcr_text_put(page->out, ":</p>\n");
        for (uint32_t i = 0; i < analysis->pair_count; i++)
            if (analysis->pair[i].group == contest.group->number)
                contest.pair[contest.pair_count++] = &analysis->pair[i];
        if (contest.pair_count) {
            put_headline(&contest, 1);
            put_headline(&contest, 0);
            put_pairs(&contest);
        } else {
            put_alone(page, contest.group);
        }
        put_marked(&contest);
        mcr_text_put(page->out, "<p class=\"fine\">Better in equal time: more efficient, that is 1/(MSE \u00d7 time) is greater. With equal "
                                "samples: the MSE is smaller. "
                                "Verdicts are corrected for the number of pairs (Holm). The seeds are told in all, for a chance of "
                                "80\u00a0% to tell a difference as large as it "
                                "seems now.</p>\n");
    } else {
        mcr_text_put(page->out, "<p>Nothing was rendered yet.</p>\n");
    }
    mcr_text_put(page->out, "</section>\n");
    free(contest.pair);
    free(contest.ranked);
    free(contest.defeats);
}
