/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Filters of the film, by pictures of an emitting edge and of an even plane: each pixel is the filter's integral over what is beyond the edge, by
 * quadrature of the published formula; the variance told is the true one. |z| <= 4 by pixel and overall.
 */
#include <stdlib.h>

#include "../scene/help.h"
#include "base/cpu.h"
#include "core/core.h"
#include "film/film.h"

#define WIDTH 12
#define HEIGHT 8
#define PIXELS (WIDTH * HEIGHT)

struct picture {
    double rgb[3 * PIXELS], variance[PIXELS];
};

/* One pixel is one unit of length; x to the right from the picture's left edge. What emits begins at x = edge. */
static int render(const char *filter, double edge, const char *settings, struct picture *picture)
{
    char text[1000];
    snprintf(text, sizeof text,
             "camera orthographic { from (%d, %d, 5) to (%d, %d, 0) height %d }\n"
             "film { size (%d, %d) filter %s }\nmaterial lamp emitter { radiance (1, 0.5, 2) sides two }\nrender { depth 0 %s }\n"
             "quad { corner (%.17g, -500, 0) u (500, 0, 0) v (0, 1000, 0) material lamp }\n",
             WIDTH / 2, HEIGHT / 2, WIDTH / 2, HEIGHT / 2, HEIGHT, WIDTH, HEIGHT, filter, settings, edge);
    struct mcr_overrides over = {.has_threads = 1, .threads = 1};
    struct world world = open_world(text, &over);
    if (!world.scene)
        return -1;
    struct mcr_film *film = mcr_film_create(WIDTH, HEIGHT, world.scene->sampler->correlated);
    struct mcr_render_options how = {.isa = MCR_ISA_BASELINE};
    struct mcr_render_stats stats;
    char error[256] = "";
    struct mcr_cell_sink sink = mcr_film_sink(film);
    struct mcr_accel *accel = mcr_accel_create(world.arena, world.scene, world.scene->render.accel);
    int status = mcr_render(world.scene, accel, &how, &sink, &stats, error, sizeof error);
    mcr_film_mean(film, picture->rgb);
    status |= mcr_film_variance(film, picture->variance);
    mcr_film_destroy(film);
    close_world(&world);
    return status;
}

/* Equation 8 of the paper, expanded as it is printed there. */
static double mitchell(double x, double b, double c)
{
    x = fabs(x);
    if (x < 1)
        return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
    return x < 2 ? ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) / 6 : 0;
}

static double tent(double x)
{
    return fabs(x) < 1 ? 1 - fabs(x) : 0;
}

/* The value at x, in units of half the support's width where b >= 0 (mitchell), of the radius otherwise: 1 tent. */
static double profile(double x, double radius, double b, double c)
{
    return b < 0 ? tent(x / radius) / radius : mitchell(2 * x / radius, b, c) * 2 / radius;
}

/* The integral from x = from on (of |f| with `absolute`), by the midpoint rule: error below 1e-8. */
static double beyond(double from, double radius, double b, double c, int absolute)
{
    const int steps = 200000;
    double low = from < -radius ? -radius : from, sum = 0;
    for (int i = 0; i < steps && low < radius; i++) {
        double f = profile(low + (radius - low) * (i + 0.5) / steps, radius, b, c);
        sum += (absolute ? fabs(f) : f) * (radius - low) / steps;
    }
    return sum;
}

static const double luminance = 0.2126 + 0.7152 * 0.5 + 0.0722 * 2;

static void test_edge(const char *filter, double radius, double b, double c, double edge, const char *settings)
{
    struct picture picture;
    double worst = 0, smallest = 1, squares = 0, spread = 0, ratios = 0;
    int count = 0;
    if (!ok(render(filter, edge, settings, &picture) == 0, "%s at %g renders", filter, edge))
        return;
    for (int x = 0; x < WIDTH; x++) {
        double expected = beyond(edge - (x + 0.5), radius, b, c, 0) * luminance, column = 0, variance = 0;
        for (int y = 0; y < HEIGHT; y++) {
            const double *p = picture.rgb + 3 * (y * WIDTH + x);
            double v = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2], error = sqrt(picture.variance[y * WIDTH + x]);
            smallest = fmin(smallest, v);
            ratios = fmax(ratios, fmax(fabs(p[0] - 2 * p[1]), fabs(p[2] - 2 * p[0])));
            column += v / HEIGHT;
            variance += error * error / HEIGHT / HEIGHT;
            if (!(error > 1e-9)) {
                worst = fmax(worst, fabs(v - expected) > 1e-4 ? 1e9 : 0); /* next to the support's end nothing may have been hit */
                continue;
            }
            worst = fmax(worst, fabs(v - expected) / error);
            squares += pow((v - expected) / error, 2);
            count++;
        }
        double error = sqrt(variance);
        ok(fabs(column - expected) <= 4 * error + 1e-7, "%s, edge %g, column %d: %.6f +- %.2g, expected %.6f", filter, edge, x, column, error, expected);
    }
    spread = (squares - count) / sqrt(2.0 * count);
    ok(worst <= 4.8, "%s: worst pixel |z| = %.2f", filter, worst); /* 2e-6 a pixel of 96, and pictures are few */
    ok(count > 8 && fabs(spread) <= 4, "%s: sum of z^2 %.1f of %d pixels", filter, squares, count);
    ok(ratios < 1e-12, "%s: the channels keep their ratios", filter);
    if (b == 0 && c == 0.5)
        ok(smallest < -0.01, "%s: it rings (%.4f)", filter, smallest);
}

/* An even plane: the mean of all pixels is exact within its error, and a sample's variance is W^4 - 1 times the square, W the integral of |f|. */
static void test_even(const char *filter, double b, double c, const char *settings, uint32_t spp)
{
    struct picture picture;
    double w = beyond(-2, 2, b, c, 1), mean = 0, variance = 0, expected = (w * w * w * w - 1) * luminance * luminance;
    if (!ok(render(filter, -400, settings, &picture) == 0, "%s, even, renders", filter))
        return;
    for (int p = 0; p < PIXELS; p++) {
        mean += (0.2126 * picture.rgb[3 * p] + 0.7152 * picture.rgb[3 * p + 1] + 0.0722 * picture.rgb[3 * p + 2]) / PIXELS;
        variance += picture.variance[p] * spp / PIXELS;
    }
    double error = sqrt(variance / spp / PIXELS);
    ok(fabs(mean - luminance) <= 4 * error && error < 0.0015 * luminance, "%s, even: %.6f +- %.2g, expected %.6f", filter, mean, error, luminance);
    /* weights within the few cells where f is near 0 vary, too: 0.3 % of the second moment */
    ok(fabs(variance - expected) < 0.01 * (expected + luminance * luminance), "%s, even: variance of a sample %.5f, expected %.5f", filter, variance, expected);
}

int main(void)
{
    static const double edge[] = {5.3, 6.5, 4.999};
    for (int i = 0; i < 3; i++) {
        test_edge("mitchell", 2, 1 / 3.0, 1 / 3.0, edge[i], "spp 20000 seed 3");
        test_edge("mitchell(b=0, c=0.5)", 2, 0, 0.5, edge[i], "spp 4000 seed 4");
    }
    test_edge("mitchell(radius=3.2, b=0.2, c=0.9)", 3.2, 0.2, 0.9, 5.3, "spp 4000");
    test_edge("mitchell(radius=0.5, b=0, c=1)", 0.5, 0, 1, 5.3, "spp 4000");
    test_edge("mitchell(b=1, c=0)", 2, 1, 0, 6.5, "spp 4000");
    test_edge("mitchell(b=0, c=0)", 2, 0, 0, 5.3, "spp 4000");
    test_edge("tent", 1, -1, 0, 5.3, "spp 4000");
    test_edge("mitchell", 2, 1 / 3.0, 1 / 3.0, 6.5, "spp 4096 replicates 64 sampler stratified(cosine)");
    test_even("mitchell", 1 / 3.0, 1 / 3.0, "spp 20000", 20000);
    test_even("mitchell(b=0, c=0.5)", 0, 0.5, "spp 20000", 20000);
    test_even("mitchell(b=0, c=1)", 0, 1, "spp 20000", 20000);
    return tap_done();
}
