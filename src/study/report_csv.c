/* SPDX-License-Identifier: Apache-2.0 */
/* study.csv: one row a run, as RFC 4180 has it: a header, fields quoted where they must be, lines that end in CR LF. */
#include "study/report.h"

#include <math.h>
#include <stdio.h>

#include "base/json.h"
#include "study/text.h"
#include "study/words.h"

static const char head[] = "cell,contestant,sampler,spp,depth,precision,accelerator,roulette,compat,width,height,run,seed,order,timed,measured,"
                           "wall_seconds,cpu_seconds,build_seconds,write_seconds,samples,rays,not_finite";

/* A field of text and the comma behind it. */
static void put_field(struct mcr_text *csv, const char *field)
{
    mcr_text_put(csv, "\"");
    for (; *field; field++)
        mcr_text_bytes(csv, *field == '"' ? "\"\"" : field, *field == '"' ? 2 : 1);
    mcr_text_put(csv, "\",");
}

/* The shortest decimal that reads back as the same double; nothing for NaN. */
static void put_number(struct mcr_text *csv, double number)
{
    char text[MCR_JSON_NUMBER_SIZE];
    if (isnan(number))
        return;
    if (isinf(number))
        snprintf(text, sizeof text, number < 0 ? "-inf" : "inf");
    else
        mcr_json_format(number, text);
    mcr_text_put(csv, text);
}

static void put_compat(struct mcr_text *csv, uint32_t mask)
{
    const char *between = "";
    for (uint32_t i = 0; i < MCR_COMPAT_COUNT; i++) {
        if (!(mask >> i & 1))
            continue;
        mcr_text_printf(csv, "%s%s", between, mcr_compat_name[i]);
        between = " ";
    }
    mcr_text_put(csv, mask ? "," : "none,");
}

static void put_settings(struct mcr_text *csv, const struct mcr_study *study, const struct mcr_study_cell *cell)
{
    const struct mcr_study_settings *settings = &cell->settings;
    mcr_text_printf(csv, "%u,", (unsigned)(cell - study->cell));
    put_field(csv, cell->contestant < study->contestant_count ? study->contestant[cell->contestant] : "");
    put_field(csv, settings->sampler < study->plan->sampler_count ? study->plan->sampler[settings->sampler] : "");
    mcr_text_printf(csv, "%u,%u,%s,%s,%s,", settings->spp, settings->depth, mcr_precision_word(settings->precision),
                    mcr_accel_word(settings->accel),
                    settings->roulette ? "on" : "off");
    put_compat(csv, settings->compat);
    mcr_text_printf(csv, "%u,%u,", study->width, study->height);
}

static void put_run(struct mcr_text *csv, const struct mcr_study *study, const struct mcr_study_cell *cell, uint32_t index)
{
    const struct mcr_study_run *run = &cell->run[index];
    const double seconds[] = {run->wall_seconds, run->cpu_seconds, run->build_seconds, run->write_seconds};
    put_settings(csv, study, cell);
    mcr_text_printf(csv, "%u,%llu,%llu,%u,%u,", index, (unsigned long long)run->seed, (unsigned long long)run->order,
                    index < study->plan->runs, index < study->plan->seeds);
    for (uint32_t i = 0; i < sizeof seconds / sizeof *seconds; i++) {
        put_number(csv, seconds[i]);
        mcr_text_put(csv, ",");
    }
    mcr_text_printf(csv, "%llu,%llu,%llu", (unsigned long long)run->samples, (unsigned long long)run->rays,
                    (unsigned long long)run->not_finite);
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++) {
        mcr_text_put(csv, ",");
        put_number(csv, run->metric[m]);
    }
    mcr_text_put(csv, "\r\n");
}

int mcr_study_write_csv(struct mcr_target *target, const struct mcr_study *study, const struct mcr_analysis *analysis, char *error,
                        size_t length)
{
    struct mcr_text csv = {0};
    int status = -1;
    (void)analysis; /* one row a run: what the analysis says is about cells */
    mcr_text_put(&csv, head);
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++)
        mcr_text_printf(&csv, ",%s", mcr_metric_name[m]);
    mcr_text_put(&csv, "\r\n");
    for (uint32_t i = 0; i < study->cell_count; i++)
        for (uint32_t run = 0; run < study->cell[i].run_count; run++)
            put_run(&csv, study, &study->cell[i], run);
    if (csv.failed) {
        snprintf(error, length, "not enough memory for the study's CSV");
        mcr_target_cancel(target);
    } else {
        status = mcr_target_write_text(target, csv.bytes, csv.used, error, length);
    }
    mcr_text_fini(&csv);
    return status;
}
