/* SPDX-License-Identifier: Apache-2.0 */
/* The tables that a sky is drawn from. */
#include "core/sky.h"

#include <math.h>

#include "base/elementary.h"
#include "core/cell.h"

static double luminance(const double c[3])
{
    return mcr_luminance(c[0], c[1], c[2]);
}

/* A gradient is linear in the cosine on each half: its mean there is that of the ends. Returns the power. */
static double prepare_gradient(struct mcr_sky *sky, const struct mcr_environment *from)
{
    double zenith = luminance(from->zenith), horizon = luminance(from->horizon), nadir = luminance(from->nadir);
    double most = fmax(zenith, fmax(horizon, nadir));
    if (!(most > 0))
        return 0;
    sky->zenith = zenith / most;
    sky->horizon = horizon / most;
    sky->nadir = nadir / most;
    double above = (sky->zenith + sky->horizon) / 2, below = (sky->nadir + sky->horizon) / 2;
    sky->above = above / (above + below);
    sky->factor = 1 / (2 * MCR_PI * (above + below));
    return 2 * MCR_PI * (above + below) * most;
}

/* What texel (row, column) is weighted with: its luminance; with bilinear filtering the mean over those that reach into it. */
static double texel_weight(const struct mcr_environment *from, uint32_t row, uint32_t column, double scale)
{
    double sum = 0;
    if (!from->bilinear)
        return luminance(from->texel + 3 * ((size_t)row * from->width + column)) * scale;
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t r = row + i == 0 ? 0 : row + i - 1 < from->height ? row + i - 1 : from->height - 1;
        for (uint32_t j = 0; j < 3; j++) {
            uint32_t c = (column + j + from->width - 1) % from->width;
            sum += luminance(from->texel + 3 * ((size_t)r * from->width + c)) * scale;
        }
    }
    return sum / 9;
}

/* Sums of the row's weights so far, each divided by the whole, and 1; returns the whole. */
static double row_sums(const struct mcr_environment *from, uint32_t row, double scale, double *to)
{
    double sum = 0;
    for (uint32_t c = 0; c < from->width; c++) {
        to[c] = sum;
        sum += texel_weight(from, row, c, scale);
    }
    for (uint32_t c = 0; c < from->width; c++)
        to[c] = sum > 0 ? fmin(to[c] / sum, 1) : 0;
    to[from->width] = 1;
    return sum;
}

static uint32_t levels_of(uint32_t count)
{
    uint32_t levels = 0;
    while ((uint64_t)1 << levels < count)
        levels++;
    return levels;
}

/* Marginal of rows and conditionals of columns, by luminance times solid angle. Sets *power; -1 when memory is short. */
static int prepare_image(struct mcr_sky *sky, const struct mcr_environment *from, struct mcr_arena *arena, double *power)
{
    const uint32_t width = from->width, height = from->height;
    double most = 0, sum = 0;
    *power = 0;
    for (size_t i = 0; i < (size_t)width * height; i++)
        most = fmax(most, luminance(from->texel + 3 * i));
    sky->row_levels = levels_of(height);
    sky->column_levels = levels_of(width);
    sky->edge = mcr_arena_alloc(arena, (size_t)height + 1, sizeof *sky->edge);
    sky->row_from = mcr_arena_alloc(arena, ((size_t)1 << sky->row_levels) + 1, sizeof *sky->row_from);
    sky->row_density = mcr_arena_alloc(arena, height, sizeof *sky->row_density);
    sky->column_from = mcr_arena_alloc(arena, (size_t)height * (width + 1), sizeof *sky->column_from);
    if (!sky->edge || !sky->row_from || !sky->row_density || !sky->column_from)
        return -1;
    for (uint32_t r = 0; r <= height; r++)
        sky->edge[r] = r == 0 ? 1 : r == height ? -1 : mcr_cos_degrees(180.0 * r / height);
    if (!(most > 0))
        return 0;
    for (uint32_t r = 0; r < height; r++) {
        sky->row_from[r] = sum;
        sum += row_sums(from, r, 1 / most, sky->column_from + (size_t)r * (width + 1)) * (sky->edge[r] - sky->edge[r + 1]);
    }
    for (uint32_t r = 0; r < height; r++)
        sky->row_from[r] = fmin(sky->row_from[r] / sum, 1);
    for (size_t r = height; r <= (size_t)1 << sky->row_levels; r++)
        sky->row_from[r] = 2; /* beyond every number */
    for (uint32_t r = 0; r < height; r++) {
        double probability = (r + 1 < height ? sky->row_from[r + 1] : 1) - sky->row_from[r];
        sky->row_density[r] = probability * width / (2 * MCR_PI * (sky->edge[r] - sky->edge[r + 1]));
    }
    *power = sum * most * from->scale * (2 * MCR_PI / width);
    return 0;
}

/* The suns with an extent, and what part of the power each part has. */
static void prepare_parts(struct mcr_sky *sky, const struct mcr_scene *scene, struct mcr_sky_sun *sun, double environment)
{
    double running;
    sky->power = environment;
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const struct mcr_scene_light *light = &scene->light[i];
        if (light->kind != MCR_LIGHT_SUN || !(light->outer > 0))
            continue;
        struct mcr_sky_sun *to = &sun[sky->sun_count++];
        for (int j = 0; j < 3; j++) {
            to->direction[j] = light->direction[j];
            to->radiance[j] = light->colour[j];
        }
        to->versine = light->outer;
        to->probability = luminance(light->colour) * 2 * MCR_PI * light->outer;
        sky->power += to->probability;
    }
    if (!(sky->power > 0))
        return;
    sky->probability = running = environment / sky->power;
    for (uint32_t i = 0; i < sky->sun_count; i++) {
        sun[i].from = running;
        running = fmin(running + sun[i].probability / sky->power, 1);
    }
    for (uint32_t i = 0; i < sky->sun_count; i++) /* what was added is what is told */
        sun[i].probability = (i + 1 < sky->sun_count ? sun[i + 1].from : 1) - sun[i].from;
}

int mcr_sky_create(struct mcr_arena *arena, const struct mcr_scene *scene, const struct mcr_sky **out)
{
    const struct mcr_environment *environment = scene->environment;
    uint32_t suns = 0;
    double power = 0;
    *out = NULL;
    for (uint32_t i = 0; i < scene->light_count; i++)
        suns += scene->light[i].kind == MCR_LIGHT_SUN && scene->light[i].outer > 0;
    if (!environment && !suns)
        return 0;
    struct mcr_sky *sky = mcr_arena_alloc(arena, 1, sizeof *sky);
    struct mcr_sky_sun *sun = mcr_arena_alloc(arena, suns, sizeof *sun);
    if (!sky || !sun)
        return -1;
    for (int j = 0; j < 3; j++)
        sky->background[j] = scene->render.background[j];
    sky->environment = environment;
    sky->sun = sun;
    if (environment && environment->texel && prepare_image(sky, environment, arena, &power))
        return -1;
    if (environment && !environment->texel)
        power = prepare_gradient(sky, environment);
    prepare_parts(sky, scene, sun, power);
    *out = sky;
    return 0;
}
