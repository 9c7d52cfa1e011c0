/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A log-log plot as inline SVG: series of points with intervals, joined by lines; level lines; a front. Colours come from the page's
 * style sheet by the classes s0 ... s7, strokes by d0 ... d3, markers are shapes: 32 styles that differ also without colour. Its text
 * alternative tells the numbers.
 */
#ifndef MCR_STUDY_PLOT_H
#define MCR_STUDY_PLOT_H

#include "study/analysis.h"
#include "study/text.h"

struct mcr_plot_point {
    struct mcr_interval x, y; /* ends may be NaN; a point that is not positive and finite is left out */
    int hollow;               /* drawn so: it takes no part in rankings */
    int front;                /* lies on the front */
};

struct mcr_plot_series {
    const char *label;
    uint32_t style, count;
    struct mcr_plot_point *point;
};

struct mcr_plot_level {
    double y; /* NaN: no line */
    const char *label;
};

struct mcr_plot {
    const char *id;                    /* of the element; unique on the page, [a-z0-9-] */
    const char *title, *x_label, *y_label, *x_unit; /* x_unit: as in "100 spp" */
    uint32_t series_count, level_count, tick_count;
    const struct mcr_plot_series *series;
    const struct mcr_plot_level *level;
    const double *tick;                /* of x; NULL: as the axis chooses */
    int has_front;                     /* low x and low y are good: the points marked so are joined by steps */
};

#define MCR_PLOT_STYLES 32u

/* Writes <svg>. */
void mcr_plot_write(struct mcr_text *out, const struct mcr_plot *plot);
/* A style's line and marker, as a small <svg> for a legend. */
void mcr_plot_swatch(struct mcr_text *out, uint32_t style);

#endif
