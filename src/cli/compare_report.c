/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/compare_report.h"

#include <math.h>
#include <string.h>

#include "base/json.h"

int mcr_compare_exceeds(const struct mcr_compare_data *data, const struct mcr_compare_limit *limit)
{
    double value = data->comparison.whole.value[limit->metric];
    switch (mcr_metric_sense(limit->metric)) {
    case -1: return !(value <= limit->value);
    case 1: return !(value >= limit->value);
    default: return !(fabs(value - 1) <= limit->value);
    }
}

/* ---- text ---- */

static void text_value(FILE *to, double value)
{
    char text[32];
    snprintf(text, sizeof text, isfinite(value) ? "%.7g" : isnan(value) ? "-" : "infinite", value);
    fprintf(to, " %13s", text);
}

static void text_table(FILE *to, const struct mcr_comparison *c)
{
    fprintf(to, "\n%-12s %13s", "", "whole");
    for (uint32_t k = 0; k < c->channels && c->channels > 1; k++)
        fprintf(to, " %13s", c->channel_name[k]);
    fprintf(to, "%s\n", c->channels > 1 ? "     luminance" : "");
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++) {
        fprintf(to, "%-12s", mcr_metric_name[m]);
        text_value(to, c->whole.value[m]);
        for (uint32_t k = 0; k < c->channels && c->channels > 1; k++)
            text_value(to, c->channel[k].value[m]);
        if (c->channels > 1)
            text_value(to, c->luminance.value[m]);
        fputs("\n", to);
    }
    fputs("\n", to);
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++)
        if (c->whole.note[m])
            fprintf(to, "%-12s %s\n", mcr_metric_name[m], c->whole.note[m]);
}

static void text_series(FILE *to, const struct mcr_bias *bias, const struct mcr_bias_series *s)
{
    fprintf(to, "  %-10s", s->name);
    if (s->tested)
        fprintf(to, " %.4g %% of %llu pixels differ beyond the %.6g %% level (%.4g %% at most expected by chance)\n", 100 * (double)s->differing / (double)s->tested,
                (unsigned long long)s->tested, 100 * bias->confidence, 100 * bias->expected_share);
    else
        fputs(" no pixel has noise, and none differs\n", to);
    fprintf(to, "             mean difference %.4g (%.4g to %.4g), p %.2g", s->difference, s->low, s->high, s->mean_p);
    if (s->excess_p == s->excess_p)
        fprintf(to, "; squared differences %.4g of the noise, p %.2g", s->excess, s->excess_p);
    fprintf(to, "; worst tile %u,%u,%u,%u, p %.2g\n", s->tile[0], s->tile[1], s->tile[2], s->tile[3], s->local_p);
    if (s->silent_same + s->silent_differing)
        fprintf(to, "             without noise: %llu pixels agree, %llu differ\n", (unsigned long long)s->silent_same,
                (unsigned long long)s->silent_differing);
}

static void text_bias(FILE *to, const struct mcr_compare_data *data)
{
    const struct mcr_bias *bias = data->bias;
    if (!bias) {
        if (data->variance_known[0] != data->variance_known[1])
            fprintf(to, "bias         not tested: the %s has no variance layers (mcrender --layers variance)\n", data->variance_known[0] ? "reference" : "image");
        return;
    }
    fprintf(to, "bias         %s (p %.2g in %u tests together, at %.6g %% confidence)\n",
            bias->different ? "different: the images do not estimate the same thing" : "same: the noise of both images explains what they differ in", bias->p,
            bias->tests, 100 * bias->confidence);
    for (uint32_t i = bias->series_count; i-- > 0;)
        text_series(to, bias, &bias->series[i]);
    if (bias->dependent)
        fputs("  The images differ less than independent ones would: do they have a seed in common? Then these tests see little.\n", to);
}

static void text_limits(FILE *to, const struct mcr_compare_data *data)
{
    for (uint32_t i = 0; i < data->options->limit_count; i++) {
        const struct mcr_compare_limit *limit = &data->options->limit[i];
        int sense = mcr_metric_sense(limit->metric);
        fprintf(to, "limit        %s %s %g: %s\n", mcr_metric_name[limit->metric], sense < 0 ? "at most" : sense > 0 ? "at least" : "from 1 by at most",
                limit->value, mcr_compare_exceeds(data, limit) ? "exceeded" : "kept");
    }
}

static void text_maps(FILE *to, const struct mcr_compare_data *data)
{
    const char *kind = mcr_map_kind_name[data->options->map_kind];
    for (uint32_t i = 0; i < data->options->map_count; i++) {
        const struct mcr_compare_map *map = &data->map[i];
        if (map->failed)
            continue;
        fprintf(to, "map          %s: %s error", map->path, kind);
        if (map->coloured)
            fprintf(to, " in false colours from %g to %g", data->options->map_kind == MCR_MAP_SIGNED ? -data->map_range : 0, data->map_range);
        fputs("\n", to);
    }
}

void mcr_compare_text(FILE *to, const struct mcr_compare_data *data)
{
    const struct mcr_comparison *c = &data->comparison;
    const struct mcr_compare_options *options = data->options;
    fprintf(to, "image        %s\nreference    %s\n", options->image, options->reference);
    fprintf(to, "region       %u,%u,%u,%u of %ux%u pixels", c->region[0], c->region[1], c->region[2], c->region[3], data->width, data->height);
    fprintf(to, "%s%s; %llu pixels take part\n", options->mask ? ", mask " : "", options->mask ? options->mask : "", (unsigned long long)c->pixels);
    fprintf(to, "values       %s, peak %g; range %g to %g, of the reference %g to %g\n", mcr_metrics_encoding_name[options->how.encoding], c->peak,
            c->range[0][0], c->range[0][1], c->range[1][0], c->range[1][1]);
    if (c->not_finite[0] + c->not_finite[1])
        fprintf(to, "left out     pixels with %llu values of the image and %llu of the reference that are NaN or infinite\n",
                (unsigned long long)c->not_finite[0], (unsigned long long)c->not_finite[1]);
    text_table(to, c);
    text_bias(to, data);
    text_limits(to, data);
    text_maps(to, data);
}

/* ---- JSON ---- */

/* JSON has neither NaN nor infinities: null, and why below `notes`. */
static void json_metrics(struct mcr_json_writer *json, const struct mcr_metrics *metrics)
{
    int notes = 0;
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++) {
        mcr_json_number(json, mcr_metric_name[m], metrics->value[m]);
        notes |= metrics->note[m] != NULL;
    }
    if (!notes)
        return;
    mcr_json_begin_object(json, "notes");
    for (uint32_t m = 0; m < MCR_METRIC_COUNT; m++)
        if (metrics->note[m])
            mcr_json_text(json, mcr_metric_name[m], metrics->note[m]);
    mcr_json_end(json);
}

static void json_region(struct mcr_json_writer *json, const char *key, const uint32_t region[4])
{
    const double numbers[4] = {region[0], region[1], region[2], region[3]};
    mcr_json_numbers(json, key, numbers, 4);
}

static void json_what(struct mcr_json_writer *json, const struct mcr_compare_data *data)
{
    const struct mcr_comparison *c = &data->comparison;
    mcr_json_text(json, "mcrender", PACKAGE_VERSION);
    mcr_json_text(json, "image", data->options->image);
    mcr_json_text(json, "reference", data->options->reference);
    mcr_json_text(json, "mask", data->options->mask);
    mcr_json_unsigned(json, "width", data->width);
    mcr_json_unsigned(json, "height", data->height);
    json_region(json, "region", c->region);
    mcr_json_unsigned(json, "pixels", c->pixels);
    mcr_json_text(json, "encoding", mcr_metrics_encoding_name[data->options->how.encoding]);
    mcr_json_number(json, "peak", c->peak);
    mcr_json_begin_object(json, "range");
    mcr_json_numbers(json, "image", c->range[0], 2);
    mcr_json_numbers(json, "reference", c->range[1], 2);
    mcr_json_end(json);
    mcr_json_begin_object(json, "not_finite");
    mcr_json_unsigned(json, "image", c->not_finite[0]);
    mcr_json_unsigned(json, "reference", c->not_finite[1]);
    mcr_json_end(json);
}

static void json_channels(struct mcr_json_writer *json, const struct mcr_comparison *c)
{
    mcr_json_begin_object(json, "channels");
    for (uint32_t k = 0; k < c->channels; k++) {
        mcr_json_begin_object(json, c->channel_name[k]);
        json_metrics(json, &c->channel[k]);
        mcr_json_end(json);
    }
    mcr_json_begin_object(json, "luminance");
    json_metrics(json, &c->luminance);
    mcr_json_end(json);
    mcr_json_end(json);
}

static void json_series(struct mcr_json_writer *json, const struct mcr_bias_series *s)
{
    const double interval[2] = {s->low, s->high};
    mcr_json_begin_object(json, s->name);
    mcr_json_number(json, "share", s->tested ? (double)s->differing / (double)s->tested : 0);
    mcr_json_unsigned(json, "tested", s->tested);
    mcr_json_unsigned(json, "differing", s->differing);
    mcr_json_unsigned(json, "silent_same", s->silent_same);
    mcr_json_unsigned(json, "silent_differing", s->silent_differing);
    mcr_json_number(json, "degrees_of_freedom", s->degrees);
    mcr_json_number(json, "mean_difference", s->difference);
    mcr_json_numbers(json, "mean_difference_interval", interval, 2);
    mcr_json_number(json, "mean_p", s->mean_p);
    mcr_json_number(json, "excess", s->excess);
    mcr_json_number(json, "excess_p", s->excess_p);
    mcr_json_number(json, "local", s->local);
    mcr_json_number(json, "local_p", s->local_p);
    json_region(json, "tile", s->tile);
    mcr_json_end(json);
}

static void json_bias(struct mcr_json_writer *json, const struct mcr_bias *bias)
{
    if (!bias) {
        mcr_json_null(json, "bias");
        return;
    }
    mcr_json_begin_object(json, "bias");
    mcr_json_text(json, "verdict", bias->different ? "different" : "same");
    mcr_json_number(json, "p", bias->p);
    mcr_json_unsigned(json, "tests", bias->tests);
    mcr_json_number(json, "confidence", bias->confidence);
    mcr_json_number(json, "expected_share", bias->expected_share);
    mcr_json_boolean(json, "dependent", bias->dependent);
    mcr_json_begin_object(json, "channels");
    for (uint32_t i = 0; i < bias->series_count; i++)
        json_series(json, &bias->series[i]);
    mcr_json_end(json);
    mcr_json_end(json);
}

static void json_limits(struct mcr_json_writer *json, const struct mcr_compare_data *data)
{
    mcr_json_begin_array(json, "limits");
    for (uint32_t i = 0; i < data->options->limit_count; i++) {
        const struct mcr_compare_limit *limit = &data->options->limit[i];
        mcr_json_begin_object(json, NULL);
        mcr_json_text(json, "metric", mcr_metric_name[limit->metric]);
        mcr_json_number(json, "limit", limit->value);
        mcr_json_boolean(json, "exceeded", mcr_compare_exceeds(data, limit));
        mcr_json_end(json);
    }
    mcr_json_end(json);
}

static void json_maps(struct mcr_json_writer *json, const struct mcr_compare_data *data)
{
    mcr_json_begin_array(json, "maps");
    for (uint32_t i = 0; i < data->options->map_count; i++) {
        const struct mcr_compare_map *map = &data->map[i];
        mcr_json_begin_object(json, NULL);
        mcr_json_text(json, "path", map->path);
        mcr_json_boolean(json, "written", !map->failed);
        mcr_json_text(json, "kind", mcr_map_kind_name[data->options->map_kind]);
        mcr_json_boolean(json, "false_colour", map->coloured);
        if (map->coloured)
            mcr_json_number(json, "map_range", data->map_range);
        mcr_json_end(json);
    }
    mcr_json_end(json);
}

int mcr_compare_json(FILE *to, const struct mcr_compare_data *data)
{
    struct mcr_json_writer *json = mcr_json_writer_create(to);
    if (!json)
        return -1;
    mcr_json_begin_object(json, NULL);
    json_what(json, data);
    json_metrics(json, &data->comparison.whole);
    json_channels(json, &data->comparison);
    json_bias(json, data->bias);
    json_limits(json, data);
    json_maps(json, data);
    mcr_json_end(json);
    int status = mcr_json_writer_finish(json);
    mcr_json_writer_destroy(json);
    return status;
}
