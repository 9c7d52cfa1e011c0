/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/study_report.h"

#include <math.h>
#include <string.h>

#include "study/words.h"

#define ROWS 120u     /* of the table, cells; then the greatest spp alone */
#define PAIRS 20u     /* that are printed */
#define LABEL_WIDTH 60 /* bytes at most */

static int width_of(const struct mcr_study *study)
{
    int width = 10;
    for (uint32_t k = 0; k < study->contestant_count; k++) {
        int length = (int)strlen(study->contestant[k]);
        width = length > width ? length : width;
    }
    return width > LABEL_WIDTH ? LABEL_WIDTH : width;
}

/* "1.23e-05", or a dash. */
static const char *number(double x, char text[16])
{
    if (isnan(x))
        snprintf(text, 16, "-");
    else
        snprintf(text, 16, "%.3g", x);
    return text;
}

static void print_marks(FILE *to, uint32_t marks)
{
    for (uint32_t i = 0, n = 0; i < MCR_MARK_COUNT; i++)
        if (marks >> i & 1)
            fprintf(to, "%s%s", n++ ? ", " : "  ", mcr_mark_word[i]);
}

static void print_row(FILE *to, const struct mcr_study *study, const struct mcr_analysis *analysis, uint32_t i, int width)
{
    const struct mcr_study_cell *cell = &study->cell[i];
    const struct mcr_cell_analysis *of = &analysis->cell[i];
    char seconds[16], error[16], low[16], high[16], efficiency[16];
    fprintf(to, "%-*.*s %6u %8u %5u %9s %10s [%s, %s]  %s", width, width, study->contestant[cell->contestant], cell->settings.depth, cell->settings.spp,
            cell->run_count, number(of->wall.trimmed.value, seconds), number(of->error.value, error), number(of->error.low, low),
            number(of->error.high, high), number(of->efficiency.value, efficiency));
    print_marks(to, of->marks);
    fputc('\n', to);
}

static void print_cells(FILE *to, const struct mcr_study *study, const struct mcr_analysis *analysis)
{
    int width = width_of(study);
    uint32_t spp_count = study->plan->spp_count, few = study->cell_count > ROWS;
    fprintf(to, "%-*s %6s %8s %5s %9s %10s [interval]  efficiency%s\n", width, "contestant", "depth", "spp", "runs", "seconds", "error",
            few ? "   (the most samples alone)" : "");
    for (uint32_t i = 0; i < study->cell_count; i++)
        if (!few || i % spp_count == spp_count - 1)
            print_row(to, study, analysis, i, width);
}

static void print_test(FILE *to, const char *where, const struct mcr_pair_test *test)
{
    double factor = test->ratio.value, low = test->ratio.low, high = test->ratio.high;
    fprintf(to, "    %s: ", where);
    if (test->verdict == MCR_VERDICT_BETTER)
        fprintf(to, "better by a factor %.3g [%.3g, %.3g]", factor, low, high);
    else if (test->verdict == MCR_VERDICT_WORSE)
        fprintf(to, "worse by a factor %.3g [%.3g, %.3g]", 1 / factor, 1 / high, 1 / low);
    else if (test->verdict == MCR_VERDICT_EXCLUDED)
        fputs("not compared: one of the two is marked", to);
    else if (test->seeds_needed)
        fprintf(to, "the data cannot tell; about %u seeds would", test->seeds_needed);
    else
        fputs("the data cannot tell", to);
    fputc('\n', to);
}

/* The pairs of the greatest depth and spp; those that are left out are only counted. */
static void print_pairs(FILE *to, const struct mcr_study *study, const struct mcr_analysis *analysis)
{
    const uint32_t last = study->group_count - 1;
    uint32_t shown = 0, excluded = 0, more = 0;
    for (uint32_t i = 0; i < analysis->pair_count; i++) {
        const struct mcr_pair_analysis *pair = &analysis->pair[i];
        const struct mcr_study_cell *a = &study->cell[pair->cell_a], *b = &study->cell[pair->cell_b];
        if (pair->group != last)
            continue;
        if (pair->equal_time.verdict == MCR_VERDICT_EXCLUDED && pair->equal_spp.verdict == MCR_VERDICT_EXCLUDED) {
            excluded++;
        } else if (shown == PAIRS) {
            more++;
        } else {
            if (!shown++)
                fprintf(to, "\nAt %u spp, depth %u:\n", a->settings.spp, a->settings.depth);
            fprintf(to, "  %s against %s\n", study->contestant[a->contestant], study->contestant[b->contestant]);
            print_test(to, "in equal time", &pair->equal_time);
            print_test(to, "with equal samples", &pair->equal_spp);
        }
    }
    if (more)
        fprintf(to, "  %u further pairs are in report.html\n", more);
    if (excluded)
        fprintf(to, "\n%u pairs of the most samples are not compared: one of the two is marked, so that its error is not noise alone\n", excluded);
}

void mcr_study_print(FILE *to, const struct mcr_study *study, const struct mcr_analysis *analysis)
{
    print_cells(to, study, analysis);
    print_pairs(to, study, analysis);
}

void mcr_study_print_estimate(FILE *to, const struct mcr_study *study, const struct mcr_study_estimate *cell,
                              const struct mcr_study_estimate *reference)
{
    int width = width_of(study);
    double total = reference->seconds;
    uint32_t renders = reference->renders - reference->finished;
    fprintf(to, "%-*s %6s %8s %9s %8s %10s %10s\n", width, "contestant", "depth", "spp", "finished", "missing", "s each", "s to go");
    for (uint32_t i = 0; i < study->cell_count; i++) {
        const struct mcr_study_cell *of = &study->cell[i];
        uint32_t missing = cell[i].renders - cell[i].finished;
        fprintf(to, "%-*.*s %6u %8u %9u %8u %10.3g %10.3g%s\n", width, width, study->contestant[of->contestant], of->settings.depth, of->settings.spp,
                cell[i].finished, missing, cell[i].seconds, missing * cell[i].seconds, cell[i].measured ? "  measured" : "");
        total += missing * cell[i].seconds;
        renders += missing;
    }
    if (reference->renders)
        fprintf(to, "%-*s %6s %8u %9u %8u %10s %10.3g\n", width, "reference", "", study->plan->reference_spp, reference->finished,
                reference->renders - reference->finished, "", reference->seconds);
    fprintf(to, "\n%u cells, %u renders to go, about %.3g s, besides pictures at equal time; everything would be in %s\n", study->cell_count, renders, total,
            study->plan->output);
}
