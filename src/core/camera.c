/* SPDX-License-Identifier: Apache-2.0 */
/* Camera rays: film numbers through the reconstruction filter, then through the lens. Stage file, compiled once per instruction set. */
#include <math.h>

#include "base/elementary.h"
#include "base/random.h"
#include "core/stages.h"
#include <mcrender/sampler.h>

#define BLOCK 64u

/* Offsets from the pixel's centre, distributed like the filter, so that each sample counts for one pixel with weight 1. */
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

static void block_filter(const struct mcr_film_settings *film, uint32_t n, const double *u, const double *v, double *x, double *y)
{
    switch (film->filter) {
    case MCR_FILTER_TENT:
        filter_tent(film->filter_radius, n, u, x);
        filter_tent(film->filter_radius, n, v, y);
        break;
    case MCR_FILTER_GAUSSIAN:
        filter_gaussian(film->filter_sigma, film->filter_radius, n, u, v, x, y);
        break;
    default:
        filter_box(film->filter_radius, n, u, x);
        filter_box(film->filter_radius, n, v, y);
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
    const double step = 2.0 / film->height, half_width = film->width / 2.0, half_height = film->height / 2.0;
    _Alignas(64) double x[BLOCK], y[BLOCK], lens_x[BLOCK], lens_y[BLOCK];
    for (uint32_t first = 0; first < lanes->n; first += BLOCK) {
        uint32_t n = lanes->n - first < BLOCK ? lanes->n - first : BLOCK;
        block_filter(film, n, lanes->film[0] + first, lanes->film[1] + first, x, y);
        MCR_LANES
        for (uint32_t i = 0; i < n; i++) {
            x[i] = (lanes->x[first + i] + 0.5 + x[i] - half_width) * step;
            y[i] = (half_height - (lanes->y[first + i] + 0.5 + y[i])) * step;
            lens_x[i] = lens_y[i] = 0;
        }
        if (lanes->lens)
            for (uint32_t i = 0; i < n; i++)
                mcr_disk_from_square(lanes->lens[0][first + i], lanes->lens[1][first + i], &lens_x[i], &lens_y[i]);
        block_rays(&scene->camera, n, x, y, lens_x, lens_y, lanes, first);
    }
}

void MCR_ISA_NAME(mcr_stage_path_keys)(uint32_t n, const uint64_t *pixel_key, const uint32_t *index, uint64_t *path_key)
{
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        path_key[i] = mcr_path_key(pixel_key[i], index[i]);
}
