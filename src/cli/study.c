/* SPDX-License-Identifier: Apache-2.0 */
/* mcrender study SCENE: plan, render what is missing, analyse, write, tell. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/load.h"
#include "cli/stop.h"
#include "cli/study_report.h"
#include "study/report.h"
#include "study/run.h"

#define PROGRESS_WIDTH 110 /* columns */

/* A duration for people. */
static void duration(double seconds, char text[32])
{
    if (!(seconds >= 0))
        snprintf(text, 32, "unknown");
    else if (seconds < 100)
        snprintf(text, 32, "%.0f s", seconds);
    else if (seconds < 6000)
        snprintf(text, 32, "%.0f min", seconds / 60);
    else
        snprintf(text, 32, "%.1f h", seconds / 3600);
}

static void progress(void *data, const struct mcr_study_progress *at)
{
    char text[256], elapsed[32], left[32] = "";
    (void)data;
    duration(at->seconds, elapsed);
    if (!isnan(at->left))
        duration(at->left, left);
    snprintf(text, sizeof text, "%s %u of %u: %.40s, %u spp, depth %u; %s%s%s", at->what, at->done + 1, at->total, at->label, at->spp, at->depth, elapsed,
             *left ? ", ETA " : "", left);
    fprintf(stderr, "\r%-*.*s", PROGRESS_WIDTH, PROGRESS_WIDTH, text);
}

static void no_progress(int shown)
{
    if (shown)
        fprintf(stderr, "\r%*s\r", PROGRESS_WIDTH, "");
}

static void tell(void *data, const char *message)
{
    no_progress(*(const int *)data);
    fprintf(stderr, "mcrender: warning: %s\n", message);
}

/* ---- the command as words of a shell ---- */

static int is_plain(const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+.,:/@%";
    return *word && strspn(word, plain) == strlen(word);
}

static void put_word(FILE *to, const char *word)
{
    if (is_plain(word)) {
        fputs(word, to);
        return;
    }
    fputc('\'', to);
    for (; *word; word++)
        fputs(*word == '\'' ? "'\\''" : (const char[]){*word, '\0'}, to);
    fputc('\'', to);
}

/* The caller's; NULL when memory is short. */
static char *command_line(const struct mcr_options *options)
{
    char *text = NULL;
    size_t length = 0;
    FILE *to = open_memstream(&text, &length);
    if (!to)
        return NULL;
    fputs("mcrender study", to);
    for (int i = 1; i < options->argument_count; i++) {
        fputc(' ', to);
        put_word(to, options->argument[i]);
    }
    if (!fclose(to))
        return text;
    free(text);
    return NULL;
}

/* ---- outputs ---- */

typedef int writer(struct mcr_target *target, const struct mcr_study *study, const struct mcr_analysis *analysis, char *error, size_t length);

static int write_one(const char *name, writer *write, const struct mcr_study *study, const struct mcr_analysis *analysis)
{
    char reason[600], *path = malloc(strlen(study->plan->output) + strlen(name) + 2);
    struct mcr_target *target;
    int status = -1;
    snprintf(reason, sizeof reason, "out of memory");
    if (path) {
        sprintf(path, "%s/%s", study->plan->output, name);
        target = mcr_target_open_text(path, reason, sizeof reason);
        if (target)
            status = write(target, study, analysis, reason, sizeof reason);
    }
    if (status)
        fprintf(stderr, "mcrender: error: %s\n", reason);
    free(path);
    return status;
}

static int write_all(const struct mcr_study *study, const struct mcr_analysis *analysis)
{
    int status = write_one("study.json", mcr_study_write_json, study, analysis);
    status |= write_one("study.csv", mcr_study_write_csv, study, analysis);
    status |= write_one("report.html", mcr_study_write_html, study, analysis);
    return status ? MCR_EXIT_FAILED : MCR_EXIT_DONE;
}

/* Everything after the renders: also of a study that was stopped, or failed on its way. */
static int conclude(const struct mcr_study *study, int quiet)
{
    struct mcr_analysis *analysis = mcr_analysis_create(study);
    int status;
    if (!analysis) {
        fputs("mcrender: error: out of memory\n", stderr);
        return MCR_EXIT_FAILED;
    }
    status = write_all(study, analysis);
    if (!quiet)
        mcr_study_print(stdout, study, analysis);
    if (!quiet && !status)
        printf("\nreport    %s/report.html, study.json, study.csv\n", study->plan->output);
    mcr_analysis_destroy(analysis);
    return status;
}

static uint32_t finished(const struct mcr_study *study)
{
    uint32_t runs = 0;
    for (uint32_t i = 0; i < study->cell_count; i++)
        runs += study->cell[i].run_count;
    return runs;
}

static int run(struct mcr_study_work *work, int quiet, int shown)
{
    const struct mcr_study *study = mcr_study_of(work);
    char reason[600];
    int status = mcr_study_run(work, reason, sizeof reason), wrote;
    uint32_t all = study->cell_count * mcr_study_rounds(study->plan), done = finished(study);
    no_progress(shown);
    if (status < 0) {
        fprintf(stderr, "mcrender: error: %s\n", reason);
        return MCR_EXIT_FAILED;
    }
    if (status > 0)
        fprintf(stderr, "mcrender: warning: interrupted after %u of %u runs; the same command goes on from here\n", done, all);
    wrote = done ? conclude(study, quiet) : MCR_EXIT_DONE;
    return status && !wrote ? MCR_EXIT_INTERRUPTED : wrote;
}

static int estimate(struct mcr_study_work *work)
{
    const struct mcr_study *study = mcr_study_of(work);
    struct mcr_study_estimate reference, *cell = calloc(study->cell_count, sizeof *cell);
    char reason[600] = "out of memory";
    int status = cell ? mcr_study_estimate(work, cell, &reference, reason, sizeof reason) : -1;
    if (status < 0)
        fprintf(stderr, "mcrender: error: %s\n", reason);
    if (status == 0)
        mcr_study_print_estimate(stdout, study, cell, &reference);
    free(cell);
    return status < 0 ? MCR_EXIT_FAILED : status ? MCR_EXIT_INTERRUPTED : MCR_EXIT_DONE;
}

/* From a good scene to the exit status. */
static int study(struct mcr_options *options, struct mcr_loaded_scene *loaded, const char *command)
{
    int shown = isatty(STDERR_FILENO) && !options->quiet && !options->study.dry_run, status;
    char reason[600];
    struct mcr_study_setup setup = {
        .root = loaded->root, .diagnostics = loaded->diagnostics, .registry = loaded->registry, .scene = loaded->scene,
        .overrides = &options->overrides, .scene_name = options->scene, .command = command, .isa = options->isa, .stop = &mcr_stop_asked,
        .output = options->output_count ? options->output[0] : NULL, .progress = shown ? progress : NULL, .tell = tell, .data = &shown,
    };
    struct mcr_study_work *work = mcr_study_prepare(&setup, reason, sizeof reason);
    mcr_print_diagnostics(loaded->diagnostics);
    if (!work) {
        if (*reason)
            fprintf(stderr, "mcrender: error: %s\n", reason);
        return *reason ? MCR_EXIT_FAILED : MCR_EXIT_SCENE;
    }
    mcr_stop_catch();
    status = options->study.dry_run ? estimate(work) : run(work, options->quiet, shown);
    mcr_study_end(work);
    return status;
}

int mcr_command_study(struct mcr_options *options)
{
    struct mcr_loaded_scene loaded;
    char *command = command_line(options);
    int status;
    if (options->output_count > 1) {
        fputs("mcrender: error: a study has one folder, -o is given twice\n", stderr);
        free(command);
        return MCR_EXIT_USAGE;
    }
    options->overrides.study = &options->study.texts;
    status = mcr_load(&loaded, options);
    if (!status && !loaded.scene->study) {
        fprintf(stderr,
                "mcrender: error: %s asks for no study: expected a block such as study { samplers (cosine, light) spp (1, 16) } in it, or options such "
                "as --sampler cosine --sampler light\n",
                options->scene);
        status = MCR_EXIT_SCENE;
    }
    if (!status)
        status = study(options, &loaded, command ? command : "mcrender study");
    mcr_unload(&loaded);
    free(command);
    return status;
}
