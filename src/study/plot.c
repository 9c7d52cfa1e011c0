/* SPDX-License-Identifier: Apache-2.0 */
#include "study/plot.h"

#include <math.h>
#include <stdlib.h>

#include "study/axis.h"

/* In the drawing's units; on the page a unit is 0.75 pixels (a narrow telephone) to 1.3, so that letters of 15 are 11 to 20 pixels high. */
#define WIDTH 480.0
#define HEIGHT 350.0
#define LEFT 68.0
#define RIGHT 12.0
#define TOP 12.0
#define BOTTOM 56.0
#define MARKER 5.0 /* half a marker's size */
#define CAP 3.5    /* half the stroke at the end of an interval */

/* How many points the text alternative tells; more are in the tables. */
#define TOLD_POINTS 120u

struct frame {
    struct mcr_text *out;
    struct mcr_axis x, y;
};

static double at_x(const struct frame *frame, double value)
{
    return LEFT + mcr_axis_place(&frame->x, value) * (WIDTH - LEFT - RIGHT);
}

static double at_y(const struct frame *frame, double value)
{
    return HEIGHT - BOTTOM - mcr_axis_place(&frame->y, value) * (HEIGHT - TOP - BOTTOM);
}

static double between(double value, double low, double high)
{
    return value < low ? low : value > high ? high : value;
}

static int shown(const struct mcr_plot_point *point)
{
    return point->x.value > 0 && point->y.value > 0 && isfinite(point->x.value) && isfinite(point->y.value);
}

/* " NAME="VALUE"" for a coordinate. */
static void put_at(struct mcr_text *out, const char *name, double value)
{
    mcr_text_printf(out, " %s=\"", name);
    mcr_text_fixed(out, value);
    mcr_text_put(out, "\"");
}

static void put_line(struct mcr_text *out, const char *class, double x1, double y1, double x2, double y2)
{
    mcr_text_printf(out, "<line class=\"%s\"", class);
    put_at(out, "x1", x1);
    put_at(out, "y1", y1);
    put_at(out, "x2", x2);
    put_at(out, "y2", y2);
    mcr_text_put(out, "/>");
}

static void put_pair(struct mcr_text *out, const char *command, double x, double y)
{
    mcr_text_put(out, command);
    mcr_text_fixed(out, x);
    mcr_text_put(out, " ");
    mcr_text_fixed(out, y);
}

/* A closed polygon; corners in units of a marker's half size. */
static void put_polygon(struct mcr_text *out, double x, double y, const double (*corner)[2], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        put_pair(out, i ? "L" : "M", x + MARKER * corner[i][0], y + MARKER * corner[i][1]);
    mcr_text_put(out, "Z");
}

/* Shapes of about the same area, told apart at a few pixels. */
static void put_marker(struct mcr_text *out, uint32_t shape, double x, double y)
{
    static const double square[4][2] = {{-.9, -.9}, {.9, -.9}, {.9, .9}, {-.9, .9}};
    static const double up[3][2] = {{0, -1.25}, {1.15, .85}, {-1.15, .85}}, down[3][2] = {{0, 1.25}, {1.15, -.85}, {-1.15, -.85}};
    static const double diamond[4][2] = {{0, -1.3}, {1.1, 0}, {0, 1.3}, {-1.1, 0}};
    static const double plus[12][2] = {{-.4, -1.2}, {.4, -1.2}, {.4, -.4}, {1.2, -.4}, {1.2, .4}, {.4, .4},
                                       {.4, 1.2}, {-.4, 1.2}, {-.4, .4}, {-1.2, .4}, {-1.2, -.4}, {-.4, -.4}};
    static const double cross[12][2] = {{0, -.5}, {.75, -1.2}, {1.2, -.75}, {.5, 0}, {1.2, .75}, {.75, 1.2},
                                        {0, .5}, {-.75, 1.2}, {-1.2, .75}, {-.5, 0}, {-1.2, -.75}, {-.75, -1.2}};
    static const double hourglass[4][2] = {{-1.1, -1.1}, {1.1, -1.1}, {-1.1, 1.1}, {1.1, 1.1}};
    switch (shape) {
    case 1: put_polygon(out, x, y, square, 4); return;
    case 2: put_polygon(out, x, y, up, 3); return;
    case 3: put_polygon(out, x, y, diamond, 4); return;
    case 4: put_polygon(out, x, y, down, 3); return;
    case 5: put_polygon(out, x, y, plus, 12); return;
    case 6: put_polygon(out, x, y, cross, 12); return;
    case 7: put_polygon(out, x, y, hourglass, 4); return;
    default: break;
    }
    put_pair(out, "M", x - MARKER, y);
    put_pair(out, "a5 5 0 1 0 ", 2 * MARKER, 0); /* 5: MARKER */
    put_pair(out, "a5 5 0 1 0 ", -2 * MARKER, 0);
    mcr_text_put(out, "Z");
}

/* Eight colours; each further eight have the markers moved on by three and another stroke. */
static uint32_t colour_of(uint32_t style)
{
    return style % 8;
}

static uint32_t shape_of(uint32_t style)
{
    return (style + style / 8 * 3) % 8;
}

static uint32_t dash_of(uint32_t style)
{
    return style / 8 % 4;
}

void mcr_plot_swatch(struct mcr_text *out, uint32_t style)
{
    mcr_text_printf(out, "<svg class=\"swatch s%u d%u\" viewBox=\"0 0 40 16\" aria-hidden=\"true\"><path class=\"join\" d=\"M1 "
                         "8H39\"/><path class=\"dot\" d=\"",
                    colour_of(style), dash_of(style));
    put_marker(out, shape_of(style), 20, 8);
    mcr_text_put(out, "\"/></svg>");
}

/* ---- axes ------------------------------------------------------------------------------------------------------------------------ */

static void fit(struct frame *frame, const struct mcr_plot *plot)
{
    mcr_axis_init(&frame->x);
    mcr_axis_init(&frame->y);
    for (uint32_t s = 0; s < plot->series_count; s++) {
        for (uint32_t i = 0; i < plot->series[s].count; i++) {
            const struct mcr_plot_point *point = &plot->series[s].point[i];
            if (!shown(point))
                continue;
            mcr_axis_add(&frame->x, point->x.value);
            mcr_axis_add(&frame->y, point->y.value);
            mcr_axis_add_end(&frame->y, point->y.value, point->y.low);
            mcr_axis_add_end(&frame->y, point->y.value, point->y.high);
        }
    }
    double least = frame->y.least;
    for (uint32_t i = 0; i < plot->level_count; i++)
        if (plot->level[i].y > least / 30) /* a level far below would press the points together: it is told in words */
            mcr_axis_add(&frame->y, plot->level[i].y);
    mcr_axis_finish(&frame->x, 6);
    mcr_axis_finish(&frame->y, 7);
    if (plot->tick)
        mcr_axis_set_ticks(&frame->x, plot->tick, plot->tick_count, 0.12);
}

static void put_text(struct mcr_text *out, const char *class, double x, double y)
{
    mcr_text_printf(out, "<text class=\"%s\"", class);
    put_at(out, "x", x);
    put_at(out, "y", y);
    mcr_text_put(out, ">");
}

static void put_axes(struct frame *frame, const struct mcr_plot *plot)
{
    struct mcr_text *out = frame->out;
    double bottom = HEIGHT - BOTTOM, right = WIDTH - RIGHT;
    for (uint32_t i = 0; i < frame->x.ticks; i++) {
        double x = at_x(frame, frame->x.tick[i]);
        put_line(out, "grid", x, TOP, x, bottom);
        put_text(out, "tick mid", x, bottom + 19);
        mcr_axis_label(&frame->x, frame->x.tick[i], out);
        mcr_text_put(out, "</text>");
    }
    for (uint32_t i = 0; i < frame->y.ticks; i++) {
        double y = at_y(frame, frame->y.tick[i]);
        put_line(out, "grid", LEFT, y, right, y);
        put_text(out, "tick end", LEFT - 6, y + 5);
        mcr_axis_label(&frame->y, frame->y.tick[i], out);
        mcr_text_put(out, "</text>");
    }
    put_line(out, "axis", LEFT, bottom, right, bottom);
    put_line(out, "axis", LEFT, TOP, LEFT, bottom);
    put_text(out, "name mid", (LEFT + right) / 2, HEIGHT - 10);
    mcr_text_html(out, plot->x_label);
    mcr_text_put(out, "</text><text class=\"name mid\" transform=\"rotate(-90)\"");
    put_at(out, "x", -(TOP + bottom) / 2);
    put_at(out, "y", 15);
    mcr_text_put(out, ">");
    mcr_text_html(out, plot->y_label);
    mcr_text_put(out, "</text>");
}

/* The labels stand at alternate ends of their lines, so that two close ones do not meet. */
static void put_levels(struct frame *frame, const struct mcr_plot *plot)
{
    for (uint32_t i = 0; i < plot->level_count; i++) {
        double y = at_y(frame, plot->level[i].y);
        if (!(y >= TOP && y <= HEIGHT - BOTTOM))
            continue;
        put_line(frame->out, "level", LEFT, y, WIDTH - RIGHT, y);
        put_text(frame->out, i % 2 ? "note end" : "note", i % 2 ? WIDTH - RIGHT - 4 : LEFT + 5, y < TOP + 20 ? y + 15 : y - 5);
        mcr_text_html(frame->out, plot->level[i].label);
        mcr_text_put(frame->out, "</text>");
    }
}

/* ---- points ---------------------------------------------------------------------------------------------------------------------- */

static int by_x(const void *a, const void *b)
{
    double first = (*(const struct mcr_plot_point *const *)a)->x.value, second = (*(const struct mcr_plot_point *const *)b)->x.value;
    return first < second ? -1 : first > second;
}

/* The border of what some point of the front is at least as good as: steps through the points, on to the frame at both sides. */
static void put_front(struct frame *frame, const struct mcr_plot *plot)
{
    struct mcr_text *out = frame->out;
    uint32_t room = 0, count = 0;
    for (uint32_t s = 0; s < plot->series_count; s++)
        room += plot->series[s].count;
    const struct mcr_plot_point **front = room ? calloc(room, sizeof *front) : NULL;
    if (room && !front) {
        out->failed = 1;
        return;
    }
    for (uint32_t s = 0; s < plot->series_count; s++)
        for (uint32_t i = 0; i < plot->series[s].count; i++)
            if (plot->series[s].point[i].front && shown(&plot->series[s].point[i]))
                front[count++] = &plot->series[s].point[i];
    if (count) {
        qsort(front, count, sizeof *front, by_x);
        mcr_text_put(out, "<path class=\"front\" d=\"");
        put_pair(out, "M", at_x(frame, front[0]->x.value), TOP);
        for (uint32_t i = 0; i < count; i++) {
            double x = at_x(frame, front[i]->x.value);
            if (i)
                put_pair(out, "L", x, at_y(frame, front[i - 1]->y.value));
            put_pair(out, "L", x, at_y(frame, front[i]->y.value));
        }
        put_pair(out, "L", WIDTH - RIGHT, at_y(frame, front[count - 1]->y.value));
        mcr_text_put(out, "\"/>");
    }
    free(front);
}

/* One end-to-end stroke for an interval, cut at the frame; its caps are left out where it was cut. */
static void put_bar(struct frame *frame, const struct mcr_plot_point *point, int vertical)
{
    const struct mcr_interval *interval = vertical ? &point->y : &point->x;
    double x = at_x(frame, point->x.value), y = at_y(frame, point->y.value);
    if (!(interval->low < interval->high))
        return;
    double first = vertical ? TOP : LEFT, last = vertical ? HEIGHT - BOTTOM : WIDTH - RIGHT; /* at_x of 0 is NaN: then to the frame */
    double low = interval->low > 0 ? vertical ? at_y(frame, interval->low) : at_x(frame, interval->low) : vertical ? last : first;
    double high = isfinite(interval->high) ? vertical ? at_y(frame, interval->high) : at_x(frame, interval->high) : vertical ? first : last;
    for (int end = 0; end < 2; end++) {
        double to = between(end ? high : low, first, last);
        int cap = to == (end ? high : low);
        put_pair(frame->out, "M", x, y);
        put_pair(frame->out, "L", vertical ? x : to, vertical ? to : y);
        if (cap) {
            put_pair(frame->out, "M", vertical ? x - CAP : to, vertical ? to : y - CAP);
            put_pair(frame->out, "L", vertical ? x + CAP : to, vertical ? to : y + CAP);
        }
    }
}

static void put_markers(struct frame *frame, const struct mcr_plot_series *series, int hollow)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < series->count; i++) {
        const struct mcr_plot_point *point = &series->point[i];
        if (!shown(point) || !point->hollow != !hollow)
            continue;
        if (!count++)
            mcr_text_printf(frame->out, "<path class=\"%s\" d=\"", hollow ? "dot hollow" : "dot");
        put_marker(frame->out, shape_of(series->style), at_x(frame, point->x.value), at_y(frame, point->y.value));
    }
    if (count)
        mcr_text_put(frame->out, "\"/>");
}

static void put_series(struct frame *frame, const struct mcr_plot_series *series)
{
    struct mcr_text *out = frame->out;
    const char *command = "M";
    mcr_text_printf(out, "<g class=\"s%u d%u\"><path class=\"join\" d=\"", colour_of(series->style), dash_of(series->style));
    for (uint32_t i = 0; i < series->count; i++) {
        if (!shown(&series->point[i]))
            continue;
        put_pair(out, command, at_x(frame, series->point[i].x.value), at_y(frame, series->point[i].y.value));
        command = "L";
    }
    mcr_text_put(out, "\"/><path class=\"bar\" d=\"");
    for (uint32_t i = 0; i < series->count; i++) {
        if (!shown(&series->point[i]))
            continue;
        put_bar(frame, &series->point[i], 1);
        put_bar(frame, &series->point[i], 0);
    }
    mcr_text_put(out, "\"/>");
    put_markers(frame, series, 0);
    put_markers(frame, series, 1);
    mcr_text_put(out, "</g>\n");
}

/* ---- words ----------------------------------------------------------------------------------------------------------------------- */

static void tell_point(struct mcr_text *out, const struct mcr_plot *plot, const struct mcr_plot_point *point)
{
    mcr_text_short(out, point->x.value, 4);
    mcr_text_printf(out, " %s: ", plot->x_unit);
    mcr_text_digits(out, point->y.value, 3);
    if (!isnan(point->y.low)) {
        mcr_text_put(out, " [");
        mcr_text_digits(out, point->y.low, 3);
        mcr_text_put(out, ", ");
        mcr_text_digits(out, point->y.high, 3);
        mcr_text_put(out, "]");
    }
    mcr_text_put(out, point->front && plot->has_front ? " (on the front)" : point->hollow ? " (not ranked)" : "");
}

static void tell(struct mcr_text *out, const struct mcr_plot *plot)
{
    uint32_t told = 0, left = 0;
    for (uint32_t s = 0; s < plot->series_count; s++) {
        const struct mcr_plot_series *series = &plot->series[s];
        const char *before = "";
        mcr_text_html(out, series->label);
        mcr_text_put(out, ": ");
        for (uint32_t i = 0; i < series->count; i++) {
            if (!shown(&series->point[i]))
                continue;
            if (told >= TOLD_POINTS) {
                left++;
                continue;
            }
            mcr_text_put(out, before);
            tell_point(out, plot, &series->point[i]);
            before = "; ";
            told++;
        }
        mcr_text_put(out, *before ? ". " : "no value. ");
    }
    if (left)
        mcr_text_printf(out, "%u more points are in the tables. ", left);
    for (uint32_t i = 0; i < plot->level_count; i++) {
        if (isnan(plot->level[i].y))
            continue;
        mcr_text_html(out, plot->level[i].label);
        mcr_text_put(out, ": ");
        mcr_text_digits(out, plot->level[i].y, 3);
        mcr_text_put(out, ". ");
    }
}

void mcr_plot_write(struct mcr_text *out, const struct mcr_plot *plot)
{
    struct frame frame = {.out = out};
    fit(&frame, plot);
    mcr_text_printf(out, "<svg class=\"plot\" role=\"img\" viewBox=\"0 0 %d %d\" aria-labelledby=\"%s-title\" "
                         "aria-describedby=\"%s-desc\">\n<title id=\"%s-title\">",
                    (int)WIDTH, (int)HEIGHT, plot->id, plot->id, plot->id);
    mcr_text_html(out, plot->title);
    mcr_text_printf(out, "</title>\n<desc id=\"%s-desc\">", plot->id);
    tell(out, plot);
    mcr_text_put(out, "</desc>\n");
    put_axes(&frame, plot);
    if (plot->has_front)
        put_front(&frame, plot);
    for (uint32_t s = 0; s < plot->series_count; s++)
        put_series(&frame, &plot->series[s]);
    put_levels(&frame, plot);
    if (isnan(frame.y.least)) {
        put_text(out, "name mid", (LEFT + WIDTH - RIGHT) / 2, (TOP + HEIGHT - BOTTOM) / 2);
        mcr_text_put(out, "no values yet</text>");
    }
    mcr_text_put(out, "</svg>\n");
}
