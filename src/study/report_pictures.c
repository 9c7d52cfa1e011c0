/* SPDX-License-Identifier: Apache-2.0 */
/* The images side by side: with equal samples, and in equal time, each with the same part enlarged, beside the reference. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/elementary.h"
#include "image/image.h"
#include "study/page.h"
#include "study/picture.h"
#include "study/words.h"

#define SIDE_MAX 256u                /* pixels of a picture's longer side on the page */
#define SIDE_MIN 64u
#define PIXELS_MAX 2000000.0         /* of all pictures: some 8 MB of page */
#define ROWS 3u
#define CROP_MIN 8u
#define CROP_MAX 64u

/* One exhibition: what all its pictures have in common. */
struct show {
    struct mcr_page *page;
    const struct mcr_page_group *row[ROWS];
    uint32_t row_count;
    const struct mcr_image *reference; /* of the rows' first cell; NULL */
    uint32_t side;                     /* at most, of a whole picture */
    uint32_t crop[4];
    int has_crop;
    int stops;
    double scale;
};

/* A file of the study's folder. NULL with the reason. */
static struct mcr_image *load(const struct mcr_page *page, const char *name, char *error, size_t length)
{
    char path[4096];
    const char *folder = page->study->plan->output;
    int bytes = snprintf(path, sizeof path, "%s%s%s", folder ? folder : "", folder && *folder ? "/" : "", name);
    if (bytes < 0 || (size_t)bytes >= sizeof path) {
        snprintf(error, length, "its path is too long");
        return NULL;
    }
    return mcr_image_read(path, error, length);
}

static uint32_t shown_contestants(const struct mcr_page *page)
{
    return page->study->contestant_count < MCR_PAGE_PICTURES ? page->study->contestant_count : MCR_PAGE_PICTURES;
}

static int has_picture(const struct mcr_page *page, const struct mcr_page_group *group)
{
    for (uint32_t c = 0; c < shown_contestants(page); c++) {
        const struct mcr_study_cell *cell = mcr_page_cell(page, group, c);
        if (cell && cell->image)
            return 1;
    }
    return 0;
}

/* Rows: the least, the middle and the greatest spp that have pictures at the greatest depth. */
static void choose_rows(struct show *show)
{
    const struct mcr_page *page = show->page;
    uint32_t first = page->group_count, count = 0;
    while (first && page->group[first - 1].depth == page->group[page->group_count - 1].depth)
        first--;
    for (uint32_t i = first; i < page->group_count; i++)
        count += has_picture(page, &page->group[i]);
    uint32_t wanted[ROWS] = {0, count / 2, count - 1}, seen = 0;
    if (count <= 2)
        wanted[1] = 0;
    for (uint32_t i = first; i < page->group_count; i++) {
        if (!has_picture(page, &page->group[i]))
            continue;
        if (seen == wanted[0] || seen == wanted[1] || seen == wanted[2])
            show->row[show->row_count++] = &page->group[i];
        seen++;
    }
}

static void choose_reference(struct show *show)
{
    const struct mcr_study *study = show->page->study;
    for (uint32_t c = 0; show->row_count && c < study->contestant_count && !show->reference; c++) {
        const struct mcr_study_cell *cell = mcr_page_cell(show->page, show->row[0], c);
        if (cell && cell->reference < study->reference_count)
            show->reference = study->reference[cell->reference].image;
    }
    if (!show->row_count && study->reference_count)
        show->reference = study->reference[study->reference_count - 1].image;
}

/* Whole stops that bring a mean luminance outside [0.03, 0.7] to about 0.2; else none. */
static void choose_exposure(struct show *show)
{
    double mean = show->reference ? mcr_picture_luminance(show->reference) : 0;
    show->scale = 1;
    if (!(mean > 1e-30) || mean > 1e30 || (mean >= 0.03 && mean <= 0.7))
        return;
    show->stops = (int)floor(mcr_log(0.2 / mean) / mcr_log(2) + 0.5);
    show->scale = mcr_pow(2, show->stops);
}

/* Of the measured region, where the middle row is farthest from the reference. */
static void choose_crop(struct show *show)
{
    const struct mcr_page *page = show->page;
    const struct mcr_metrics_options *how = &page->study->plan->how;
    const struct mcr_page_group *middle = show->row_count ? show->row[show->row_count / 2] : NULL;
    struct mcr_error_field field;
    char error[256];
    if (!middle || !show->reference || mcr_error_field_init(&field, show->reference))
        return;
    uint32_t region[4] = {0, 0, field.width, field.height};
    if (how->has_crop && how->crop[2] <= field.width && how->crop[3] <= field.height && how->crop[0] < how->crop[2] &&
        how->crop[1] < how->crop[3])
        for (int i = 0; i < 4; i++)
            region[i] = how->crop[i];
    uint32_t width = region[2] - region[0], height = region[3] - region[1], least = width < height ? width : height, side = least / 4;
    side = side < CROP_MIN ? CROP_MIN : side > CROP_MAX ? CROP_MAX : side;
    if (side >= least) { /* so small that there is nothing to cut out */
        mcr_error_field_fini(&field);
        return;
    }
    for (uint32_t c = 0; c < shown_contestants(page); c++) {
        const struct mcr_study_cell *cell = mcr_page_cell(page, middle, c);
        struct mcr_image *image = cell && cell->image ? load(page, cell->image, error, sizeof error) : NULL;
        if (image)
            mcr_error_field_add(&field, image, show->reference);
        mcr_image_destroy(image);
    }
    mcr_error_field_window(&field, region, side, show->crop);
    show->has_crop = 1;
    mcr_error_field_fini(&field);
}

static void choose_side(struct show *show)
{
    const struct mcr_page *page = show->page;
    double pictures = (show->row_count + (page->study->equal_time_count > 0)) * (shown_contestants(page) + 1.0);
    double side = pictures > 0 ? floor(sqrt(PIXELS_MAX / pictures)) : SIDE_MAX;
    show->side = side > SIDE_MAX ? SIDE_MAX : side < SIDE_MIN ? SIDE_MIN : (uint32_t)side;
}

static void put_percent(struct mcr_text *out, const char *property, double part, double whole)
{
    mcr_text_printf(out, "%s:", property);
    mcr_text_fixed(out, 100 * part / whole);
    mcr_text_put(out, "%;");
}

static void put_size(struct mcr_text *out, const struct mcr_view *view)
{
    mcr_text_printf(out, "\" width=\"%u\" height=\"%u\" alt=\"", (view->x1 - view->x0 + view->shrink - 1) / view->shrink,
                    (view->y1 - view->y0 + view->shrink - 1) / view->shrink);
}

/* The whole picture with the enlarged part framed, and that part. */
static void put_image(struct show *show, const struct mcr_image *image, const char *label)
{
    struct mcr_text *out = show->page->out;
    uint32_t longer = image->width > image->height ? image->width : image->height;
    struct mcr_view view = {.x1 = image->width, .y1 = image->height, .shrink = (longer + show->side - 1) / show->side, .scale = show->scale};
    int has_crop = show->has_crop && show->crop[2] <= image->width && show->crop[3] <= image->height;
    mcr_text_put(out, "<div class=\"whole\"><img src=\"");
    mcr_picture_write(out, image, &view);
    put_size(out, &view);
    mcr_text_html(out, label);
    mcr_text_put(out, ": the whole image\"/>");
    if (has_crop) {
        mcr_text_put(out, "<span class=\"box\" style=\"");
        put_percent(out, "left", show->crop[0], image->width);
        put_percent(out, "top", show->crop[1], image->height);
        put_percent(out, "width", show->crop[2] - show->crop[0], image->width);
        put_percent(out, "height", show->crop[3] - show->crop[1], image->height);
        mcr_text_put(out, "\"></span>");
    }
    mcr_text_put(out, "</div>\n");
    if (!has_crop)
        return;
    view = (struct mcr_view){show->crop[0], show->crop[1], show->crop[2], show->crop[3], 1, show->scale};
    mcr_text_put(out, "<img class=\"crop\" src=\"");
    mcr_picture_write(out, image, &view);
    put_size(out, &view);
    mcr_text_html(out, label);
    mcr_text_put(out, ": the framed part, enlarged\"/>\n");
}

static void put_quality(struct mcr_page *page, const double metric[MCR_METRIC_COUNT])
{
    struct mcr_text *out = page->out;
    if (!isnan(metric[MCR_METRIC_PSNR])) {
        mcr_text_put(out, " \u00b7 PSNR\u00a0");
        mcr_page_number(page, metric[MCR_METRIC_PSNR], 4);
        mcr_text_put(out, "\u00a0dB");
    } else if (!isnan(metric[MCR_METRIC_MSE])) {
        mcr_text_put(out, " \u00b7 MSE\u00a0");
        mcr_page_number(page, metric[MCR_METRIC_MSE], 3);
    }
}

static void begin_shot(struct show *show, const char *name, const char *label)
{
    struct mcr_page *page = show->page;
    char error[512];
    struct mcr_image *image = name ? load(page, name, error, sizeof error) : NULL;
    mcr_text_put(page->out, "<figure class=\"shot\">\n");
    if (image) {
        put_image(show, image, label);
    } else {
        mcr_text_put(page->out, "<div class=\"absent\">");
        mcr_page_user(page, name ? error : "no image");
        mcr_text_put(page->out, "</div>\n");
    }
    mcr_image_destroy(image);
    mcr_text_put(page->out, "<figcaption><b>");
    mcr_text_html_breaks(page->out, label);
    mcr_text_put(page->out, "</b><br/>");
}

static void put_reference(struct show *show)
{
    const struct mcr_page *page = show->page;
    if (!show->reference)
        return;
    mcr_text_put(page->out, "<figure class=\"shot\">\n");
    put_image(show, show->reference, "reference");
    mcr_text_put(page->out, "<figcaption><b>reference</b>");
    if (!page->study->plan->reference_image)
        mcr_text_printf(page->out, "<br/>%u\u00a0spp", page->study->plan->reference_spp);
    mcr_text_put(page->out, "</figcaption>\n</figure>\n");
}

static void put_row(struct show *show, const struct mcr_page_group *group)
{
    struct mcr_page *page = show->page;
    mcr_text_put(page->out, "<h3>With equal samples: ");
    mcr_page_group_words(page, group);
    mcr_text_put(page->out, "</h3>\n<div class=\"shots\">\n");
    put_reference(show);
    for (uint32_t c = 0; c < shown_contestants(page); c++) {
        const struct mcr_study_cell *cell = mcr_page_cell(page, group, c);
        if (!cell)
            continue;
        begin_shot(show, cell->image, mcr_page_label(page, c));
        mcr_text_printf(page->out, "%u\u00a0spp", cell->settings.spp);
        if (cell->run_count) {
            mcr_text_put(page->out, " \u00b7 ");
            mcr_page_number(page, cell->run[0].wall_seconds, 3);
            mcr_text_put(page->out, "\u00a0s");
            put_quality(page, cell->run[0].metric);
        }
        mcr_page_marks(page, mcr_page_known(page, cell)->marks & ~MCR_MARK_REFERENCE);
        mcr_text_put(page->out, "</figcaption>\n</figure>\n");
    }
    mcr_text_put(page->out, "</div>\n");
}

/* What is known against a contestant at the depth of the pictures at equal time. */
static uint32_t marks_of(const struct mcr_page *page, uint32_t contestant)
{
    uint32_t marks = 0;
    for (uint32_t i = 0; i < page->study->series_count; i++)
        if (page->analysis->series[i].contestant == contestant && page->analysis->series[i].depth == page->study->equal_time_depth)
            marks |= page->analysis->series[i].marks;
    return marks;
}

static void put_equal_time(struct show *show)
{
    struct mcr_page *page = show->page;
    const struct mcr_study *study = page->study;
    if (!study->equal_time_count)
        return;
    mcr_text_put(page->out, "<h3>In equal time: about ");
    mcr_page_number(page, study->equal_time_seconds, 3);
    mcr_text_printf(page->out, "\u00a0s, depth\u00a0%u</h3>\n<div class=\"shots\">\n", study->equal_time_depth);
    put_reference(show);
    for (uint32_t i = 0; i < study->equal_time_count && i < MCR_PAGE_PICTURES; i++) {
        const struct mcr_study_equal_time *render = &study->equal_time[i];
        begin_shot(show, render->image, mcr_page_label(page, render->contestant));
        mcr_page_number(page, render->wall_seconds, 3);
        mcr_text_printf(page->out, "\u00a0s \u00b7 %u\u00a0spp", render->spp);
        put_quality(page, render->metric);
        mcr_page_marks(page, marks_of(page, render->contestant) & ~MCR_MARK_REFERENCE);
        mcr_text_put(page->out, "</figcaption>\n</figure>\n");
    }
    mcr_text_put(page->out, "</div>\n");
}

/* How the pictures are to be looked at. */
static void put_words(struct show *show)
{
    struct mcr_page *page = show->page;
    struct mcr_text *out = page->out;
    uint32_t longer = page->study->width > page->study->height ? page->study->width : page->study->height;
    uint32_t shrink = (longer + show->side - 1) / show->side;
    mcr_text_put(out, "<p>Each is the first run\u2019s image, as 8-bit sRGB, ");
    if (show->stops)
        mcr_text_printf(out, "all made %s by %d\u00a0%s alike", show->stops > 0 ? "brighter" : "darker", abs(show->stops),
                        abs(show->stops) == 1 ? "stop" : "stops");
    else
        mcr_text_put(out, "all at the exposure of the data");
    mcr_text_put(out, "; what is brighter than white is clipped.");
    if (shrink > 1)
        mcr_text_printf(out, " Whole images are scaled down %u\u00a0:\u00a01, which hides noise.", shrink);
    if (show->has_crop)
        mcr_text_printf(out, " The enlarged part (%u\u00a0\u00d7\u00a0%u pixels from %u,\u00a0%u) is the same everywhere: where these "
                             "images are farthest from the reference.",
                        show->crop[2] - show->crop[0], show->crop[3] - show->crop[1], show->crop[0], show->crop[1]);
    if (page->study->contestant_count > shown_contestants(page))
        mcr_text_printf(out, " The first %u contestants are shown.", shown_contestants(page));
    mcr_text_put(out, "</p>\n");
}

void mcr_page_pictures(struct mcr_page *page)
{
    struct show show = {.page = page};
    mcr_text_put(page->out, "<section id=\"images\">\n<h2>Images</h2>\n");
    choose_rows(&show);
    choose_reference(&show);
    choose_exposure(&show);
    choose_crop(&show);
    choose_side(&show);
    if (show.row_count || page->study->equal_time_count) {
        put_words(&show);
        for (uint32_t i = 0; i < show.row_count; i++)
            put_row(&show, show.row[i]);
        put_equal_time(&show);
    } else {
        mcr_text_put(page->out, "<p>There are no images.</p>\n");
    }
    mcr_text_put(page->out, "</section>\n");
}
