/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What is written about a study, for made-up ones: study.json holds all of it, study.csv a row a run, report.html what it must.
 * With the arguments `--write FOLDER` it writes the pages FOLDER/NAME.html and FOLDER/NAME/study.json and .csv for html.sh instead, and on
 * standard output a line for each: NAME, and how many <figure> and <img> it must have.
 */
#include <sys/stat.h>

#include "../tap.h"
#include "base/json.h"
#include "sample_study.h"
#include "study/report.h"
#include "study/words.h"

typedef int writer(struct mcr_target *, const struct mcr_study *, const struct mcr_analysis *, char *, size_t);

struct variant {
    const char *name;
    struct sample_options options;
};

static const struct variant variants[] = {
    {"usual", {.contestants = 6, .spps = 3, .depths = 2, .runs = 10, .seeds = 10, .width = 64, .height = 48, .images = 1}},
    {"one", {.contestants = 1, .spps = 1, .depths = 1, .runs = 1, .seeds = 1, .width = 16, .height = 16, .images = 1}},
    {"many", {.contestants = 30, .spps = 4, .depths = 1, .runs = 3, .seeds = 5, .width = 40, .height = 24, .images = 1, .dark = 1}},
    {"unknown", {.contestants = 3, .spps = 2, .depths = 1, .runs = 3, .seeds = 3, .width = 16, .height = 16, .unknown = 1}},
    {"interrupted", {.contestants = 4, .spps = 3, .depths = 2, .runs = 5, .seeds = 5, .width = 32, .height = 32, .images = 1,
                     .interrupted = 1, .compat = 1}},
    {"competing", {.contestants = 3, .spps = 3, .depths = 3, .runs = 4, .seeds = 4, .width = 24, .height = 24, .images = 1,
                   .depths_compete = 1}},
    {"hostile", {.contestants = 5, .spps = 2, .depths = 1, .runs = 2, .seeds = 2, .width = 16, .height = 8, .lost_image = 1,
                 .reference_image = 1,
                 .title = "</title><script>alert('1')</script> & \"quotes\" \xff\x01",
                 .label = "<img src=x onerror=alert(2)>,\"mixture(averyveryveryveryveryveryveryveryveryveryveryveryveryveryveryverylongname "
                          "1)\r\n&amp;"}},
};
#define VARIANTS (sizeof variants / sizeof *variants)

/* A whole file; NUL-terminated; to be freed. */
static char *read_whole(const char *path, size_t *length)
{
    struct stat status;
    FILE *file = stat(path, &status) ? NULL : fopen(path, "rb");
    char *text = file ? calloc(1, (size_t)status.st_size + 1) : NULL;
    *length = text ? fread(text, 1, (size_t)status.st_size, file) : 0;
    if (file)
        fclose(file);
    return text;
}

static int write_to(writer *write, const char *path, const struct sample *sample)
{
    char error[300] = "";
    struct mcr_target *target = mcr_target_open_text(path, error, sizeof error);
    int status = target ? write(target, &sample->study, &sample->analysis, error, sizeof error) : -1;
    if (status)
        printf("# %s: %s\n", path, error);
    return status;
}

/* Writes, and reads back what was written; NULL after a failure. */
static char *written(writer *write, const struct sample *sample, size_t *length)
{
    char path[1200];
    snprintf(path, sizeof path, "%s/written", sample->folder);
    *length = 0;
    return write_to(write, path, sample) ? NULL : read_whole(path, length);
}

static int has(const char *text, const char *what)
{
    return text && strstr(text, what) != NULL;
}

static uint32_t occurrences(const char *text, const char *what)
{
    uint32_t count = 0;
    for (const char *at = text; (at = strstr(at, what)); at += strlen(what))
        count++;
    return count;
}

/* The folder that the samples are in; the tests' own, which is removed after them. */
static const char *scratch(const char *name)
{
    static char path[900];
    const char *base = getenv("TMPDIR");
    snprintf(path, sizeof path, "%s/%s", base && *base ? base : "/tmp", name);
    mkdir(path, 0777);
    return path;
}

/* ---- study.json ------------------------------------------------------------------------------------------------------------------ */

struct parsed {
    struct mcr_arena *arena;
    struct mcr_diagnostics *diagnostics;
    struct mcr_json *root;
};

static struct parsed parse(const char *text, size_t length)
{
    struct parsed parsed = {mcr_arena_create(0), mcr_diagnostics_create(), NULL};
    const struct mcr_source *source = mcr_diagnostics_source(parsed.diagnostics, "study.json", text, length, NULL);
    parsed.root = mcr_json_parse(parsed.arena, parsed.diagnostics, source);
    return parsed;
}

static void release(struct parsed *parsed)
{
    mcr_arena_destroy(parsed->arena);
    mcr_diagnostics_destroy(parsed->diagnostics);
}

static const struct mcr_json *element(const struct mcr_json *array, size_t index)
{
    const struct mcr_json *item = array ? array->first : NULL;
    while (item && index--)
        item = item->next;
    return item;
}

/* The member at "a.b.2.c"; NULL. */
static const struct mcr_json *at(const struct mcr_json *value, const char *path)
{
    while (value && *path) {
        char key[64];
        size_t length = strcspn(path, ".");
        snprintf(key, sizeof key, "%.*s", (int)length, path);
        value = value->kind == MCR_JSON_ARRAY ? element(value, strtoul(key, NULL, 10)) : mcr_json_get(value, key);
        path += length + (path[length] == '.');
    }
    return value;
}

/* Null stands for NaN. */
static int number_is(const struct mcr_json *root, const char *path, double expected)
{
    const struct mcr_json *value = at(root, path);
    int same = value && (isnan(expected) ? value->kind == MCR_JSON_NULL : value->kind == MCR_JSON_NUMBER && value->number == expected);
    if (!same)
        printf("# %s: %s instead of %.17g\n", path, value ? value->text ? value->text : "null" : "nothing", expected);
    return same;
}

static int word_is(const struct mcr_json *root, const char *path, const char *expected)
{
    const struct mcr_json *value = at(root, path);
    int same = value && value->kind == MCR_JSON_TEXT && !strcmp(value->text, expected);
    if (!same)
        printf("# %s: '%s' instead of '%s'\n", path, value && value->text ? value->text : "nothing", expected);
    return same;
}

static int interval_is(const struct mcr_json *value, const char *path, const struct mcr_interval *expected)
{
    const struct mcr_json *interval = at(value, path);
    return interval && number_is(interval, "value", expected->value) && number_is(interval, "low", expected->low) &&
           number_is(interval, "high", expected->high);
}

static int cell_is(const struct mcr_json *json, const struct sample *sample, uint32_t index)
{
    const struct mcr_study_cell *cell = &sample->study.cell[index];
    const struct mcr_cell_analysis *known = &sample->analysis.cell[index];
    const struct mcr_json *runs = at(json, "runs");
    char key[20];
    snprintf(key, sizeof key, "%016llx", (unsigned long long)cell->key);
    int same = word_is(json, "key", key) && number_is(json, "contestant", cell->contestant) && number_is(json, "group", cell->group) &&
               word_is(json, "sampler", sample->plan.sampler[cell->settings.sampler]) && number_is(json, "spp", cell->settings.spp) &&
               number_is(json, "depth", cell->settings.depth) && word_is(json, "coverage.missing", cell->coverage.missing) &&
               number_is(json, "bias_square", cell->bias_square) && number_is(json, "bias_square_error", cell->bias_square_error) &&
               (cell->image ? word_is(json, "image", cell->image) : at(json, "image")->kind == MCR_JSON_NULL) && runs &&
               runs->count == cell->run_count;
    for (uint32_t i = 0; same && i < cell->run_count; i++) {
        const struct mcr_json *run = element(runs, i);
        char seed[24];
        snprintf(seed, sizeof seed, "%llu", (unsigned long long)cell->run[i].seed);
        same = !strcmp(at(run, "seed")->text, seed) && number_is(run, "wall", cell->run[i].wall_seconds) &&
               number_is(run, "cpu", cell->run[i].cpu_seconds) &&
               number_is(run, "rays", (double)cell->run[i].rays) && number_is(run, "metrics.mse", cell->run[i].metric[MCR_METRIC_MSE]) &&
               number_is(run, "metrics.ssim", cell->run[i].metric[MCR_METRIC_SSIM]) && !at(run, "metrics.mae");
    }
    same = same && interval_is(json, "analysis.wall.trimmed", &known->wall.trimmed) &&
           interval_is(json, "analysis.wall.median", &known->wall.median) &&
           interval_is(json, "analysis.metrics.psnr", &known->metric[MCR_METRIC_PSNR]) &&
           interval_is(json, "analysis.error", &known->error) &&
           interval_is(json, "analysis.efficiency", &known->efficiency) && interval_is(json, "analysis.speed", &known->speed) &&
           number_is(json, "analysis.reference_share", known->reference_share);
    uint32_t marks = 0, count = 0;
    for (uint32_t i = 0; i < MCR_MARK_COUNT; i++) {
        for (const struct mcr_json *mark = at(json, "analysis.marks")->first; mark; mark = mark->next)
            marks |= !strcmp(mark->text, mcr_mark_word[i]) ? 1u << i : 0;
        count += known->marks >> i & 1;
    }
    return same && marks == known->marks && at(json, "analysis.marks")->count == count;
}

static int pairs_are(const struct mcr_json *root, const struct sample *sample)
{
    const struct mcr_json *pair = at(root, "pairs.0");
    int same = at(root, "pairs")->count == sample->analysis.pair_count;
    for (uint32_t i = 0; same && i < sample->analysis.pair_count; i++, pair = pair->next) {
        const struct mcr_pair_analysis *expected = &sample->analysis.pair[i];
        uint32_t seeds = expected->equal_time.seeds_needed;
        same = number_is(pair, "group", expected->group) && number_is(pair, "cell_a", expected->cell_a) &&
               number_is(pair, "cell_b", expected->cell_b) &&
               word_is(pair, "equal_time.verdict", mcr_verdict_word(expected->equal_time.verdict)) &&
               interval_is(pair, "equal_spp.ratio", &expected->equal_spp.ratio) &&
               number_is(pair, "equal_spp.p_holm", expected->equal_spp.p_holm) &&
               number_is(pair, "equal_time.seeds_needed", seeds ? seeds : NAN);
    }
    return same;
}

static int series_are(const struct mcr_json *root, const struct sample *sample)
{
    const struct mcr_json *series = at(root, "series.0");
    int same = at(root, "series")->count == sample->study.series_count;
    for (uint32_t i = 0; same && i < sample->study.series_count; i++, series = series->next) {
        const struct mcr_series_analysis *expected = &sample->analysis.series[i];
        same = number_is(series, "contestant", expected->contestant) && number_is(series, "depth", expected->depth) &&
               interval_is(series, "slope", &expected->slope) &&
               interval_is(series, "time_slope", &expected->time_slope) && interval_is(series, "time_to_target", &expected->time_to_target) &&
               word_is(series, "target", mcr_target_word(expected->target));
    }
    return same;
}

static int head_is(const struct mcr_json *root, const struct sample *sample)
{
    const struct mcr_study_plan *plan = &sample->plan;
    return number_is(root, "schema", MCR_STUDY_SCHEMA) && word_is(root, "mcrender", "0.1.0") &&
           word_is(root, "scene.hash", "feedfacecafebeef") &&
           word_is(root, "machine.processor", sample->study.processor) && number_is(root, "machine.threads", 2) &&
           word_is(root, "command", sample->study.command) &&
           !strcmp(at(root, "plan.first_seed")->text, "9007199254740993") && number_is(root, "plan.runs", plan->runs) &&
           number_is(root, "plan.seeds", plan->seeds) &&
           at(root, "plan.samplers")->count == plan->sampler_count && at(root, "plan.spp")->count == plan->spp_count &&
           at(root, "plan.compat")->count == plan->compat_count &&
           number_is(root, "plan.confidence", .95) && word_is(root, "plan.baseline", plan->sampler[0]) &&
           number_is(root, "plan.measure.peak", 1) &&
           word_is(root, "plan.measure.encoding", "linear") && at(root, "contestants")->count == sample->study.contestant_count &&
           number_is(root, "references.0.noise", sample->study.reference[0].noise) &&
           number_is(root, "target.mse", sample->analysis.target) &&
           at(root, "target.chosen")->boolean && at(root, "equal_time.renders")->count == sample->study.equal_time_count;
}

static void test_json(const struct variant *variant, const struct sample *sample)
{
    size_t length;
    char *text = written(mcr_study_write_json, sample, &length);
    struct parsed parsed = parse(text ? text : "", length);
    if (!ok(parsed.root != NULL, "%s: study.json is read by a strict reader", variant->name))
        mcr_diagnostics_print(parsed.diagnostics, stdout, 0);
    if (parsed.root) {
        int hostile = variant->options.title != NULL; /* bytes that are no UTF-8 change */
        int same = at(parsed.root, "cells")->count == sample->study.cell_count;
        const struct mcr_json *cell = at(parsed.root, "cells.0");
        for (uint32_t i = 0; same && i < sample->study.cell_count; i++, cell = cell->next)
            same = cell_is(cell, sample, i);
        ok(same, "%s: it holds every cell and every run", variant->name);
        ok(head_is(parsed.root, sample) && (hostile || word_is(parsed.root, "title", sample->plan.title)),
           "%s: it holds the plan, the machine, the references", variant->name);
        ok(pairs_are(parsed.root, sample) && series_are(parsed.root, sample), "%s: it holds pairs and series", variant->name);
    }
    release(&parsed);
    free(text);
}

static void test_words(const struct sample *interrupted)
{
    size_t length;
    char *text = written(mcr_study_write_json, interrupted, &length);
    struct parsed parsed = parse(text, length);
    const struct mcr_json *compat = at(parsed.root, "cells.3.compat");
    ok(compat && compat->count == 2 && !strcmp(compat->first->text, "clamp") && !strcmp(compat->first->next->text, "disk-polar") &&
       at(parsed.root, "cells.2.compat")->count == 0,
       "compat settings are told by name");
    release(&parsed);
    free(text);
}

/* ---- study.csv ------------------------------------------------------------------------------------------------------------------- */

/* The next field, unquoted, in `field`; *end is what ended it: ',' or '\n', or 0 for anything that RFC 4180 does not allow. */
static const char *next_field(const char *at, char field[512], char *end)
{
    size_t used = 0;
    int quoted = *at == '"';
    for (at += quoted; *at && used < 511; at++) {
        if (quoted && *at == '"' && at[1] == '"')
            at++;
        else if (quoted ? *at == '"' : *at == ',' || *at == '\r' || *at == '"')
            break;
        field[used++] = *at;
    }
    field[used] = '\0';
    at += quoted && *at == '"';
    *end = *at == ',' ? ',' : at[0] == '\r' && at[1] == '\n' ? '\n' : 0;
    return at + (*end == '\n' ? 2 : 1);
}

static void test_csv(const struct variant *variant, const struct sample *sample)
{
    size_t length;
    char *text = written(mcr_study_write_csv, sample, &length), field[512], end = ',';
    uint32_t rows = 0, columns = 0, expected = 0, wall = 0, label = 0, runs = 0, mse = 0;
    int good = text != NULL, exact = 1;
    const char *next = text;
    for (; good && end == ','; columns++) { /* the header */
        next = next_field(next, field, &end);
        wall = !strcmp(field, "wall_seconds") ? columns : wall;
        label = !strcmp(field, "contestant") ? columns : label;
        mse = !strcmp(field, "mse") ? columns : mse;
    }
    good &= end == '\n' && wall && label && mse;
    const struct mcr_study_cell *cell = sample->study.cell;
    while (good && *next) {
        while (expected == cell->run_count)
            cell++, expected = 0;
        for (uint32_t column = 0; good && column < columns; column++) {
            next = next_field(next, field, &end);
            good = end == (column + 1 < columns ? ',' : '\n');
            exact &= column != wall || strtod(field, NULL) == cell->run[expected].wall_seconds;
            exact &= column != mse || strtod(field, NULL) == cell->run[expected].metric[MCR_METRIC_MSE];
            exact &= column != label || !strcmp(field, sample->study.contestant[cell->contestant]);
        }
        expected++;
        rows++;
    }
    for (uint32_t i = 0; i < sample->study.cell_count; i++)
        runs += sample->study.cell[i].run_count;
    ok(good && rows == runs, "%s: study.csv has %u rows for %u runs, each with the header's %u fields", variant->name, rows, runs, columns);
    ok(exact, "%s: with the same text and the same doubles", variant->name);
    free(text);
}

/* ---- report.html ----------------------------------------------------------------------------------------------------------------- */

/* The figures and pictures that must be there: plots, two a depth; the reference and the contestants, in up to three rows and at equal time. */
static void expected_figures(const struct sample_options *options, uint32_t *figures, uint32_t *pictures)
{
    uint32_t contestants = options->contestants * (options->depths_compete ? options->depths : 1);
    uint32_t rows = options->spps < 3 ? options->spps : 3, shots = (rows + 1) * (contestants + 1);
    uint32_t lost = options->contestants + 1; /* the contestants' places and the reference, which is too small for a crop */
    *figures = 2 * (options->depths_compete ? 1 : options->depths) + (options->images ? shots : options->lost_image ? lost : 0);
    *pictures = options->images ? 2 * shots : options->lost_image ? 1 : 0; /* each with its crop */
    if (options->interrupted)
        *pictures = 0; /* some are missing: not foretold */
}

static void test_html(const struct variant *variant, const struct sample *sample)
{
    size_t length;
    uint32_t figures, pictures;
    char *text = written(mcr_study_write_html, sample, &length);
    static const char *const sections[] = {"question", "answer", "images", "plots", "times", "quality", "convergence", "caveats", "repeat"};
    const char *last = text;
    expected_figures(&variant->options, &figures, &pictures);
    ok(text && occurrences(text, "<figure") == figures && (!pictures || occurrences(text, "<img ") == pictures),
       "%s: report.html has its %u figures and %u pictures (%zu bytes)",
       variant->name, figures, pictures, length);
    for (size_t i = 0; last && i < sizeof sections / sizeof *sections; i++) {
        char mark[64];
        snprintf(mark, sizeof mark, "<section id=\"%s\">", sections[i]);
        last = strstr(last, mark);
    }
    ok(last != NULL, "%s: its sections stand in their order", variant->name);
    static const char *const forbidden[] = {"<script", "http:", "https:", "href", "url(", "@import", "<img src=x", "<link", "<iframe",
                                            ">nan", "\"nan", "\"-nan"};
    int clean = text && occurrences(text, " src=\"") == occurrences(text, " src=\"data:image/png;base64,");
    for (size_t i = 0; clean && i < sizeof forbidden / sizeof *forbidden; i++)
        clean = !strstr(text, forbidden[i]);
    ok(clean, "%s: no script, no address of elsewhere, no NaN", variant->name);
    free(text);
}

/* Cells that take part in rankings and than which no other of their depth is both faster and nearer to the reference. */
static uint32_t front_size(const struct sample *sample)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < sample->study.cell_count; i++) {
        const struct mcr_cell_analysis *one = &sample->analysis.cell[i];
        int beaten = (one->marks & MCR_MARK_UNRANKED) != 0;
        for (uint32_t k = 0; k < sample->study.cell_count; k++) {
            const struct mcr_cell_analysis *other = &sample->analysis.cell[k];
            double time = other->wall.trimmed.value - one->wall.trimmed.value, error = other->error.value - one->error.value;
            beaten |= sample->study.cell[k].settings.depth == sample->study.cell[i].settings.depth && !(other->marks & MCR_MARK_UNRANKED) &&
                      time <= 0 && error <= 0 && (time < 0 || error < 0);
        }
        count += !beaten;
    }
    return count;
}

static void test_front(const struct sample *usual)
{
    size_t length;
    char *text = written(mcr_study_write_html, usual, &length);
    uint32_t expected = front_size(usual);
    ok(text && expected > 2 && occurrences(text, " (on the front)") == expected, "the Pareto front has its %u points", expected);
    free(text);
}

/* text without its tags; to be freed. */
static char *told(char *text)
{
    char *to = text;
    int tag = 0;
    for (const char *from = text; *from; from++) {
        tag |= *from == '<';
        if (!tag)
            *to++ = *from;
        tag &= *from != '>';
    }
    *to = '\0';
    return text;
}

static void test_answer(const struct sample *usual, const struct sample *interrupted, const struct sample *one)
{
    size_t length;
    char *text = told(written(mcr_study_write_html, usual, &length));
    ok(has(text, "stratified(mixture(cosine 1, light 1)) is better than every other that can be ranked: by a factor 1.35\u00a0[1.27, 1.43] "
                 "than the next, stratified(light), "
                    "and by a factor 11.6"),
       "the winner is told, with factors and intervals");
    ok(has(text, "cosine is better by a factor 1.18\u00a0[1.11, 1.25]") &&
       has(text, "the data cannot tell (ratio 1.06\u00a0[1.00, 1.12]); about 140\u00a0seeds would"),
       "pairs: the better one first; what the data cannot tell");
    ok(has(text, "Left out of the rankings here:") && has(text, "it misses what white reflects in directions without light") &&
       !has(text, "Biased on purpose"),
       "who is left out, and why");
    free(text);
    text = told(written(mcr_study_write_html, interrupted, &length));
    ok(has(text, "Not finished: ") && has(text, "Biased on purpose. Some contestants render with compat settings (clamp, disk-polar)"),
       "an interrupted study and a compat one say so");
    free(text);
    text = told(written(mcr_study_write_html, one, &length));
    ok(has(text, "There is nothing to compare with: cosine has an MSE of 0.400"), "a single contestant has its error told");
    free(text);
}

static void test_undecided(struct sample *usual)
{
    size_t length;
    for (uint32_t i = 0; i < usual->analysis.pair_count; i++) {
        struct mcr_pair_test *test = &usual->analysis.pair[i].equal_time;
        if (test->verdict != MCR_VERDICT_EXCLUDED)
            *test = (struct mcr_pair_test){{1, .9, 1.1}, .9, 1, MCR_VERDICT_UNKNOWN, 0};
    }
    char *text = told(written(mcr_study_write_html, usual, &length));
    ok(has(text, "The data cannot tell which is the best of cosine, mixture(cosine 1, light 1), stratified(cosine), stratified(light) and "
                 "stratified(mixture(cosine 1, light 1))."),
       "a study that decides nothing says that");
    free(text);
}

/* Nothing is written, and that is told, where writing fails. */
static void test_failure(const struct sample *one)
{
    static writer *const writers[] = {mcr_study_write_json, mcr_study_write_csv, mcr_study_write_html};
    int failed = 0;
    for (size_t i = 0; i < 3; i++) {
        char error[300] = "";
        struct mcr_target *target = mcr_target_open_text("/dev/full", error, sizeof error);
        failed += target && writers[i](target, &one->study, &one->analysis, error, sizeof error) && strstr(error, "/dev/full");
    }
    ok(failed == 3, "a full disk is an error with a name");
}

static int write_pages(const char *folder)
{
    int status = 0;
    for (size_t i = 0; i < VARIANTS; i++) {
        struct sample sample;
        char path[1300];
        uint32_t figures, pictures;
        snprintf(path, sizeof path, "%s/%s", folder, variants[i].name);
        mkdir(path, 0777);
        sample_init(&sample, &variants[i].options, path);
        snprintf(path, sizeof path, "%s/%s.html", folder, variants[i].name);
        status |= write_to(mcr_study_write_html, path, &sample);
        snprintf(path, sizeof path, "%s/%s/study.json", folder, variants[i].name);
        status |= write_to(mcr_study_write_json, path, &sample);
        snprintf(path, sizeof path, "%s/%s/study.csv", folder, variants[i].name);
        status |= write_to(mcr_study_write_csv, path, &sample);
        expected_figures(&variants[i].options, &figures, &pictures);
        printf("%s %u %u\n", variants[i].name, figures, pictures);
        sample_fini(&sample);
    }
    return status ? 1 : 0;
}

/* The words that the manual promises, by themselves: the rest of this file takes them from where the report does. */
static void test_promised_words(void)
{
    static const char *const target[] = {[MCR_TARGET_MEASURED] = "measured", [MCR_TARGET_EXTRAPOLATED] = "extrapolated",
                                         [MCR_TARGET_UNREACHABLE] = "unreachable", [MCR_TARGET_UNKNOWN] = "unknown"};
    static const char *const verdict[] = {[MCR_VERDICT_BETTER] = "better", [MCR_VERDICT_WORSE] = "worse", [MCR_VERDICT_UNKNOWN] = "unknown",
                                          [MCR_VERDICT_EXCLUDED] = "excluded"};
    for (uint32_t i = 0; i < 4; i++) {
        ok(strcmp(mcr_target_word(i), target[i]) == 0, "target %u is %s", i, target[i]);
        ok(strcmp(mcr_verdict_word(i), verdict[i]) == 0, "verdict %u is %s", i, verdict[i]);
    }
}

int main(int argc, char **argv)
{
    static struct sample samples[VARIANTS];
    if (argc == 3 && !strcmp(argv[1], "--write"))
        return write_pages(argv[2]);
    test_promised_words();
    for (size_t i = 0; i < VARIANTS; i++) {
        sample_init(&samples[i], &variants[i].options, scratch(variants[i].name));
        test_json(&variants[i], &samples[i]);
        test_csv(&variants[i], &samples[i]);
        test_html(&variants[i], &samples[i]);
    }
    test_words(&samples[4]);
    test_answer(&samples[0], &samples[4], &samples[1]);
    test_front(&samples[0]);
    test_undecided(&samples[0]);
    test_failure(&samples[1]);
    for (size_t i = 0; i < VARIANTS; i++)
        sample_fini(&samples[i]);
    return tap_done();
}
