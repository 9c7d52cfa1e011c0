/* SPDX-License-Identifier: Apache-2.0 */
/* Everything that it takes to repeat a study. */
#include <math.h>

#include "study/page.h"
#include "study/picture.h"
#include "study/words.h"

static void item(struct mcr_page *page, const char *term)
{
    mcr_text_printf(page->out, "<dt>%s</dt><dd>", term);
}

static void end_item(struct mcr_page *page)
{
    mcr_text_put(page->out, "</dd>\n");
}

static void text_item(struct mcr_page *page, const char *term, const char *text)
{
    item(page, term);
    mcr_page_user(page, text && *text ? text : "unknown");
    end_item(page);
}

static void put_origin(struct mcr_page *page)
{
    const struct mcr_study *study = page->study;
    struct mcr_text *out = page->out;
    item(page, "Command");
    mcr_text_put(out, "<code>");
    mcr_page_user(page, study->command && *study->command ? study->command : "unknown");
    mcr_text_put(out, "</code>");
    end_item(page);
    item(page, "Program");
    mcr_text_put(out, "mcrender ");
    mcr_page_user(page, study->version);
    end_item(page);
    text_item(page, "Started", study->started);
    text_item(page, "Machine", study->machine);
    text_item(page, "Processor", study->processor);
    item(page, "Instruction set");
    mcr_page_user(page, study->instruction_set);
    mcr_text_printf(out, "; %u %s", study->threads, study->threads == 1 ? "thread" : "threads");
    end_item(page);
    item(page, "Scene");
    mcr_text_put(out, "<code>");
    mcr_page_user(page, study->scene_path);
    mcr_text_printf(out, "</code>, hash %016llx, %u\u00a0\u00d7\u00a0%u pixels", (unsigned long long)study->scene_hash, study->width,
                    study->height);
    end_item(page);
}

static void put_words(struct mcr_page *page, uint32_t count, const uint32_t *list, const char *(*word)(uint32_t))
{
    for (uint32_t i = 0; i < count; i++)
        mcr_text_printf(page->out, "%s%s", i ? ", " : "", word(list[i]));
}

static const char *on_off(uint32_t value)
{
    return value ? "on" : "off";
}

static void put_matrix(struct mcr_page *page)
{
    const struct mcr_study_plan *plan = page->study->plan;
    struct mcr_text *out = page->out;
    char names[MCR_COMPAT_TEXT];
    item(page, "Samplers");
    for (uint32_t i = 0; i < plan->sampler_count; i++) {
        mcr_text_put(out, i ? ", <code>" : "<code>");
        mcr_page_user(page, plan->sampler[i]);
        mcr_text_put(out, "</code>");
    }
    end_item(page);
    item(page, "Matrix");
    mcr_text_put(out, "spp ");
    mcr_page_whole_list(page, plan->spp, plan->spp_count);
    mcr_text_put(out, "; depth ");
    mcr_page_whole_list(page, plan->depth, plan->depth_count);
    mcr_text_put(out, "; precision ");
    put_words(page, plan->precision_count, plan->precision, mcr_precision_word);
    mcr_text_put(out, "; accelerator ");
    put_words(page, plan->accel_count, plan->accel, mcr_accel_word);
    mcr_text_put(out, "; roulette ");
    put_words(page, plan->roulette_count, plan->roulette, on_off);
    mcr_text_put(out, "; compat ");
    for (uint32_t i = 0; i < plan->compat_count; i++) {
        mcr_compat_text(plan->compat[i], names);
        mcr_text_printf(out, plan->compat_count > 1 ? "%s(%s)" : "%s%s", i ? ", " : "", names);
    }
    mcr_text_printf(out, ": %u %s", page->study->cell_count, page->study->cell_count == 1 ? "cell" : "cells");
    end_item(page);
    uint32_t most = plan->seeds > plan->runs ? plan->seeds : plan->runs;
    item(page, "Seeds and runs");
    mcr_text_printf(out, "%llu to %llu; the first %u of each cell are timed, the first %u measured; %u of %u runs are here",
                    (unsigned long long)plan->first_seed,
                    (unsigned long long)(plan->first_seed + (most ? most - 1 : 0)), plan->runs, plan->seeds, page->run_count,
                        page->run_total);
    end_item(page);
}

static void put_references(struct mcr_page *page)
{
    const struct mcr_study *study = page->study;
    const struct mcr_study_plan *plan = study->plan;
    struct mcr_text *out = page->out;
    item(page, "Reference");
    if (plan->reference_image) {
        mcr_text_put(out, "the image <code>");
        mcr_page_user(page, plan->reference_image);
        mcr_text_put(out, "</code>");
    } else {
        mcr_text_put(out, "<code>");
        mcr_page_user(page, plan->reference_sampler);
        mcr_text_printf(out, "</code>, %u\u00a0spp, seeds from %llu on", plan->reference_spp, (unsigned long long)plan->reference_seed);
    }
    for (uint32_t i = 0; i < study->reference_count && i < MCR_PAGE_ROWS; i++) {
        const struct mcr_study_reference *reference = &study->reference[i];
        mcr_text_put(out, "; ");
        if (!plan->reference_image)
            mcr_text_printf(out, "depth\u00a0%u: ", reference->depth);
        mcr_text_put(out, "own noise (MSE) ");
        if (isnan(reference->noise))
            mcr_text_put(out, "unknown");
        else
            mcr_page_number(page, reference->noise, 3);
        if (reference->seconds > 0) {
            mcr_text_put(out, ", ");
            mcr_page_number(page, reference->seconds, 3);
            mcr_text_put(out, "\u00a0s");
        }
    }
    end_item(page);
}

/* The least and the greatest colour value of all references. */
static void put_value_range(struct mcr_page *page)
{
    const struct mcr_study *study = page->study;
    double least = NAN, greatest = NAN;
    for (uint32_t r = 0; r < study->reference_count; r++) {
        const struct mcr_image *image = study->reference[r].image;
        uint32_t channel[3];
        if (!image)
            continue;
        mcr_picture_channels(image, channel);
        for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
            for (uint32_t k = 0; k < 3; k++) {
                double value = image->data[i * image->channels + channel[k]];
                if (!isfinite(value))
                    continue;
                least = !(value >= least) ? value : least;
                greatest = !(value <= greatest) ? value : greatest;
            }
        }
    }
    mcr_page_number(page, least, 3);
    mcr_text_put(page->out, " to ");
    mcr_page_number(page, greatest, 3);
}

static void put_measures(struct mcr_page *page)
{
    const struct mcr_study *study = page->study;
    const struct mcr_study_plan *plan = study->plan;
    const struct mcr_metrics_options *how = &plan->how;
    struct mcr_text *out = page->out;
    item(page, "Metrics");
    mcr_text_printf(out, "on %s; peak ", how->encoding == MCR_ENCODING_SRGB8 ? "the 8-bit sRGB encoding" : "linear values");
    mcr_text_short(out, mcr_metrics_peak(how), 6);
    mcr_text_put(out, "; the references\u2019 linear values range from ");
    put_value_range(page);
    if (how->has_crop)
        mcr_text_printf(out, "; region %u\u00a0\u2264\u00a0x\u00a0&lt;\u00a0%u, %u\u00a0\u2264\u00a0y\u00a0&lt;\u00a0%u", how->crop[0],
                        how->crop[2], how->crop[1], how->crop[3]);
    else
        mcr_text_put(out, "; the whole image");
    mcr_text_put(out, how->mask ? ", by a mask" : "");
    mcr_text_put(out, how->exclude_not_finite ? "; pixels that are not finite are left out" : "");
    end_item(page);
    item(page, "Statistics");
    mcr_text_put(out, "confidence ");
    mcr_text_short(out, plan->confidence * 100, 6);
    mcr_text_put(out, "\u00a0%; baseline <code>");
    mcr_page_user(page, plan->baseline < plan->sampler_count ? plan->sampler[plan->baseline] : "");
    mcr_text_put(out, "</code>");
    end_item(page);
}

void mcr_page_repeat(struct mcr_page *page)
{
    mcr_text_put(page->out, "<section id=\"repeat\">\n<h2>To repeat it</h2>\n<dl class=\"facts\">\n");
    put_origin(page);
    put_matrix(page);
    put_references(page);
    put_measures(page);
    mcr_text_put(page->out, "</dl>\n<p class=\"fine\">All numbers, in full, are beside this page: study.json (described in "
                            "mcrender-study(1)), study.csv with one row a run, and the images. "
                            "With the accelerators list and bvh, images come out the same to the last bit on any machine; times do "
                            "not.</p>\n</section>\n");
}
