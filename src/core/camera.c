/* SPDX-License-Identifier: Apache-2.0 */
/* Camera rays: film numbers through the reconstruction filter, then through the lens. Stage file, compiled once per instruction set. */
#include <math.h>

#include "base/elementary.h"
#include "base/random.h"
#include "core/stages.h"
#include "scene/mitchell.h"
#include <mcrender/sampler.h>

#define BLOCK 64u

/* Offsets from the pixel's centre, distributed like the filter, so that each sample counts for one pixel, with weight 1 where the filter has one sign. */
static void filter_box(double radius, uint32_t n, const double *u, double *offset)
{
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        offset[i] = (2 * u[i] - 1) * radius;
}

/* Inverse of the tent's distribution function. */
static void filter_tent(double radius, uint32_t n, const double *u, double *offset)
{
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double low = sqrt(2 * u[i]) - 1, high = 1 - sqrt(2 - 2 * u[i]);
        offset[i] = radius * (u[i] < 0.5 ? low : high);
    }
}

/* A Gaussian cut at a circle: the squared radius has an exponential distribution, cut. */
static void filter_gaussian(double sigma, double radius, uint32_t n, const double *u, const double *v, double *x, double *y)
{
    double kept = 1 - mcr_exp(-radius * radius / (2 * sigma * sigma));
    for (uint32_t i = 0; i < n; i++) {
        double sine, cosine, r = sigma * sqrt(-2 * mcr_log(1 - u[i] * kept));
        mcr_sincos_turns(v[i], &sine, &cosine);
        x[i] = r * cosine;
        y[i] = r * sine;
    }
}

/*
 * Both sides of a filter with negative parts: |2u - 1| chooses a cell of equal weight and a place in it, 2u - 1 the side. The sample's weight is
 * multiplied by filter over density: nearly +-(the integral of |f|), but for the cells where f reaches 0.
 */
static void filter_mitchell(const struct mcr_film_settings *film, uint32_t n, const double *u, double *offset, double *weight)
{
    const double *edge = film->filter_edge;
    const double b = film->filter_b, c = film->filter_c, half_radius = film->filter_radius / 2;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double side = 2 * u[i] - 1, place = fabs(side) * MCR_MITCHELL_CELLS;
        int32_t k = (int32_t)place;
        k = k < (int32_t)MCR_MITCHELL_CELLS ? k : (int32_t)MCR_MITCHELL_CELLS - 1;
        double low = edge[k], width = edge[k + 1] - low, x = low + width * (place - k);
        offset[i] = (side < 0 ? -x : x) * half_radius;
        weight[i] *= mcr_mitchell(b, c, x) * (width * (2.0 * MCR_MITCHELL_CELLS));
    }
}

static void block_filter(const struct mcr_film_settings *film, uint32_t n, const double *u, const double *v, double *x, double *y,
                         double *weight)
{
    switch (film->filter) {
    case MCR_FILTER_TENT:
        filter_tent(film->filter_radius, n, u, x);
        filter_tent(film->filter_radius, n, v, y);
        break;
    case MCR_FILTER_GAUSSIAN:
        filter_gaussian(film->filter_sigma, film->filter_radius, n, u, v, x, y);
        break;
    case MCR_FILTER_MITCHELL:
        for (uint32_t i = 0; i < n; i++)
            weight[i] = 1;
        filter_mitchell(film, n, u, x, weight);
        filter_mitchell(film, n, v, y, weight);
        break;
    default:
        filter_box(film->filter_radius, n, u, x);
        filter_box(film->filter_radius, n, v, y);
    }
}

/* Points in the lens, in units of its radius: uniform in area, or as the founding study draws them (its algorithm 4), crowded in the middle. */
static void lens_points(int polar, uint32_t n, const double *u, const double *v, double *x, double *y)
{
    for (uint32_t i = 0; i < n && !polar; i++)
        mcr_disk_from_square(u[i], v[i], &x[i], &y[i]);
    for (uint32_t i = 0; i < n && polar; i++) {
        double sine, cosine;
        mcr_sincos_turns(v[i], &sine, &cosine);
        x[i] = u[i] * cosine;
        y[i] = u[i] * sine;
    }
}

/* Rays through film points (s, t): see struct mcr_camera. lens_x, lens_y in units of the radius. */
static void block_rays(const struct mcr_camera *camera, uint32_t n, const double *s, const double *t, const double *lens_x, const double *lens_y,
                       const struct mcr_camera_lanes *to, uint32_t first)
{
    const double h = camera->half_height;
    const double rx = camera->right[0], ry = camera->right[1], rz = camera->right[2];
    const double ux = camera->up[0], uy = camera->up[1], uz = camera->up[2];
    const double fx = camera->forward[0], fy = camera->forward[1], fz = camera->forward[2];
    double *ox = to->ox + first, *oy = to->oy + first, *oz = to->oz + first;
    double *dx = to->dx + first, *dy = to->dy + first, *dz = to->dz + first;
    if (camera->kind == MCR_CAMERA_ORTHOGRAPHIC) {
        MCR_LANES
        for (uint32_t i = 0; i < n; i++) {
            double a = s[i] * h, b = t[i] * h;
            ox[i] = a * rx + b * ux;
            oy[i] = a * ry + b * uy;
            oz[i] = a * rz + b * uz;
            dx[i] = fx;
            dy[i] = fy;
            dz[i] = fz;
        }
        return;
    }
    const double radius = to->lens ? camera->lens_radius : 0, focus = to->lens ? camera->focus_distance : 1;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double a = s[i] * h, b = t[i] * h;
        double lx = radius * lens_x[i], ly = radius * lens_y[i];
        double px = lx * rx + ly * ux, py = lx * ry + ly * uy, pz = lx * rz + ly * uz;
        double vx = focus * (fx + a * rx + b * ux) - px;
        double vy = focus * (fy + a * ry + b * uy) - py;
        double vz = focus * (fz + a * rz + b * uz) - pz;
        double inverse = 1 / sqrt(vx * vx + vy * vy + vz * vz);
        ox[i] = px;
        oy[i] = py;
        oz[i] = pz;
        dx[i] = vx * inverse;
        dy[i] = vy * inverse;
        dz[i] = vz * inverse;
    }
}

void MCR_ISA_NAME(mcr_stage_camera)(const struct mcr_scene *scene, const struct mcr_camera_lanes *lanes)
{
    const struct mcr_film_settings *film = &scene->film;
    const int polar = scene->camera.lens_polar;
    const double step = 2.0 / film->height, half_width = film->width / 2.0, half_height = film->height / 2.0;
    _Alignas(64) double x[BLOCK], y[BLOCK], lens_x[BLOCK], lens_y[BLOCK];
    for (uint32_t first = 0; first < lanes->n; first += BLOCK) {
        uint32_t n = lanes->n - first < BLOCK ? lanes->n - first : BLOCK;
        block_filter(film, n, lanes->film[0] + first, lanes->film[1] + first, x, y, lanes->weight ? lanes->weight + first : NULL);
        for (uint32_t i = 0; i < n && lanes->distance; i++)
            lanes->distance[first + i] = x[i] * x[i] + y[i] * y[i];
        MCR_LANES
        for (uint32_t i = 0; i < n; i++) {
            x[i] = (lanes->x[first + i] + 0.5 + x[i] - half_width) * step;
            y[i] = (half_height - (lanes->y[first + i] + 0.5 + y[i])) * step;
            lens_x[i] = lens_y[i] = 0;
        }
        if (lanes->lens)
            lens_points(polar, n, lanes->lens[0] + first, lanes->lens[1] + first, lens_x, lens_y);
        block_rays(&scene->camera, n, x, y, lens_x, lens_y, lanes, first);
    }
}

/*
 * Which pixel and sample each path is for. Quotients are taken in doubles, where they vectorise: x + 1/2 over d is off a whole number by 1/(2d) at
 * least, far more than rounding for x and d below 2^32.
 */
static void identities(const struct mcr_film_settings *film, const struct mcr_begin *b, double *restrict x, double *restrict y,
                       uint64_t *restrict key, uint32_t *restrict index)
{
    const double width = film->x1 - film->x0, samples = b->cell_samples, pixels = (double)b->pixels, pixel0 = (double)b->pixel;
    const double per_width = 1 / width, per_samples = 1 / samples, per_pixels = 1 / pixels;
    const uint32_t x0 = film->x0, y0 = film->y0, full = film->width, path = b->path, n = b->n;
    const uint32_t start = b->first + (uint32_t)b->round * b->cell_samples;
    const uint64_t replicate_key = b->replicate_key;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double number = (int32_t)(path + i), cell = (int32_t)((number + 0.5) * per_samples), sample = number - cell * samples;
        double round = (int32_t)((pixel0 + cell + 0.5) * per_pixels), pixel = pixel0 + cell - round * pixels;
        double row = (int32_t)((pixel + 0.5) * per_width), column = pixel - row * width;
        uint32_t px = x0 + (uint32_t)(int32_t)column, py = y0 + (uint32_t)(int32_t)row;
        x[i] = (int32_t)px;
        y[i] = (int32_t)py;
        key[i] = mcr_pixel_key(replicate_key, (uint64_t)py * full + px);
        index[i] = start + (uint32_t)(int32_t)(round * samples + sample);
    }
}

/* The pixels as whole numbers, for number sources that ask for them. */
static void pixels(uint32_t n, const double *restrict x, const double *restrict y, uint32_t *restrict column, uint32_t *restrict row)
{
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        column[i] = (uint32_t)(int32_t)x[i];
        row[i] = (uint32_t)(int32_t)y[i];
    }
}

void MCR_ISA_NAME(mcr_stage_begin)(struct mcr_batch *batch, const struct mcr_begin *b)
{
    const struct mcr_paths *paths = &batch->state;
    const uint32_t n = b->n, to = b->to, slot = b->slot, planned = b->planned;
    uint32_t *slots = paths->slot + to, *bounces = paths->bounce + to, *plans = paths->planned + to, *source = batch->source + batch->rays;
    double *red = paths->r + to, *green = paths->g + to, *blue = paths->b + to;
    const uint64_t *pixel_key = paths->pixel_key + to;
    const uint32_t *index = paths->index + to;
    uint64_t *path_key = paths->path_key + to;
    identities(&batch->core->scene->film, b, batch->camera_x, batch->camera_y, paths->pixel_key + to, paths->index + to);
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        path_key[i] = mcr_path_key(pixel_key[i], index[i]);
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        plans[i] = planned;
        slots[i] = slot + i;
        bounces[i] = 0;
        source[i] = to + i;
    }
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        red[i] = green[i] = blue[i] = 1;
    if (paths->x)
        pixels(n, batch->camera_x, batch->camera_y, paths->x + to, paths->y + to);
}
