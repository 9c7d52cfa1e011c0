/* SPDX-License-Identifier: Apache-2.0 */
#include "core/lights.h"

#include <math.h>
#include <string.h>

#include "base/elementary.h"

/* Where there are both, neither the sky nor the finite emitters get less than this: power over the whole scene says little of a single point. */
#define LEAST_SHARE 0.2

static const struct mcr_sky_functions *sky_of(uint32_t isa)
{
#if MCR_ISA_COUNT > 1
    return isa == MCR_ISA_AVX512 ? &mcr_sky_functions_isa2 : isa == MCR_ISA_AVX2 ? &mcr_sky_functions_isa1 : &mcr_sky_functions_isa0;
#else
    (void)isa;
    return &mcr_sky_functions_isa0;
#endif
}

int mcr_lights_init(struct mcr_core *core, struct mcr_arena *arena)
{
    core->sky_emitter = -1;
    core->sky_functions = sky_of(core->options->isa);
    if (mcr_sky_create(arena, core->scene, &core->sky))
        return -1;
    if (!core->sky || !(core->sky->power > 0))
        return 0;
    core->sky_emitter = (int32_t)core->emitters->count;
    if (!core->emitters->count) {
        core->sky_share = 1;
        return 0;
    }
    /* Through a disk of radius 1: render space reaches from the camera to between 1/2 and 1. */
    double sky = MCR_PI * core->sky->power, finite = mcr_emitters_power(core->emitters);
    core->sky_share = mcr_clamp(sky / (sky + finite), LEAST_SHARE, 1 - LEAST_SHARE);
    return 0;
}

/* ---- Scratch: that of the emitters, then rows of doubles ------------------------------------------------------- */

enum { ROW_NUMBER, ROW_WANTED, ROW_CHOICE, ROW_X, ROW_Y, ROW_Z, ROW_DENSITY, ROW_EMITTER, ROWS };

static size_t row_length(uint32_t n)
{
    return ((size_t)n + 7) / 8 * 8;
}

static size_t emitters_bytes(const struct mcr_core *core, uint32_t n)
{
    return (mcr_emitters_scratch(core->emitters, n) + 63) / 64 * 64;
}

size_t mcr_lights_scratch(const struct mcr_core *core, uint32_t n)
{
    return emitters_bytes(core, n) + (core->sky_emitter >= 0 ? ROWS * row_length(n) * sizeof(double) : 0);
}

static double *row_of(const struct mcr_core *core, void *scratch, uint32_t n, int row)
{
    return (double *)(void *)((char *)scratch + emitters_bytes(core, n)) + (size_t)row * row_length(n);
}

static int is_alone(const struct mcr_core *core)
{
    return !core->emitters->count;
}

/*
 * Cuts number 0 into the choice of the sky and, scaled anew, the number that chooses what is aimed at there; `wanted` is told for the finite emitters.
 */
static void split(const struct mcr_core *core, const struct mcr_points *at, const double *restrict from, double *restrict number, double *restrict wanted,
                  double *restrict choice)
{
    const double share = core->sky_share, rest = share < 1 ? 1 - share : 1;
    for (uint32_t i = 0; i < at->n; i++) {
        int sky = from[i] < share;
        double scaled = (from[i] - share) / rest;
        number[i] = sky ? 0 : scaled < 1 ? scaled : 0x1.fffffffffffffp-1;
        scaled = from[i] / share;
        choice[i] = scaled < 1 ? scaled : 0x1.fffffffffffffp-1;
        wanted[i] = sky ? 0 : 1;
    }
    if (at->size >= sizeof *at && at->wanted)
        for (uint32_t i = 0; i < at->n; i++)
            wanted[i] = at->wanted[i] != 0 ? wanted[i] : 0;
}

/* ---- Directions ------------------------------------------------------------------------------------------------ */

void mcr_lights_density(const struct mcr_core *core, void *scratch, uint32_t by, const struct mcr_points *at, const struct mcr_directions *toward,
                        const double *kept, double *density)
{
    const double share = core->sky_share;
    if (core->sky_emitter < 0) {
        core->lights->density(core->emitters, scratch, by, at, toward, kept, density);
        return;
    }
    if (is_alone(core)) {
        core->sky_functions->density(core->sky, at->n, toward->x, toward->y, toward->z, density);
        return;
    }
    double *of_sky = row_of(core, scratch, at->n, ROW_DENSITY);
    core->lights->density(core->emitters, scratch, by, at, toward, kept, density);
    core->sky_functions->density(core->sky, at->n, toward->x, toward->y, toward->z, of_sky);
    for (uint32_t i = 0; i < at->n; i++)
        density[i] = (1 - share) * density[i] + share * of_sky[i];
}

void mcr_lights_draw(const struct mcr_core *core, void *scratch, uint32_t by, const struct mcr_points *at, const double *const *number,
                     const struct mcr_directions *out, double *density, double *kept)
{
    if (core->sky_emitter < 0) {
        core->lights->draw(core->emitters, scratch, by, at, number, out, density, kept);
        return;
    }
    double *first = row_of(core, scratch, at->n, ROW_NUMBER), *wanted = row_of(core, scratch, at->n, ROW_WANTED);
    double *choice = row_of(core, scratch, at->n, ROW_CHOICE), *x = row_of(core, scratch, at->n, ROW_X), *y = row_of(core, scratch, at->n, ROW_Y);
    double *z = row_of(core, scratch, at->n, ROW_Z);
    if (is_alone(core)) {
        core->sky_functions->draw(core->sky, at->n, number[0], number[1], number[2], out->x, out->y, out->z);
    } else {
        const double *const numbers[MCR_LIGHT_DIMENSIONS] = {first, number[1], number[2]};
        struct mcr_points some = *at;
        some.wanted = wanted;
        split(core, at, number[0], first, wanted, choice);
        core->lights->draw(core->emitters, scratch, by, &some, numbers, out, NULL, kept);
        core->sky_functions->draw(core->sky, at->n, choice, number[1], number[2], x, y, z);
        for (uint32_t i = 0; i < at->n; i++) {
            int sky = number[0][i] < core->sky_share;
            out->x[i] = sky ? x[i] : out->x[i];
            out->y[i] = sky ? y[i] : out->y[i];
            out->z[i] = sky ? z[i] : out->z[i];
        }
    }
    if (density)
        mcr_lights_density(core, scratch, by, at, out, kept, density);
}

void mcr_lights_mass(const struct mcr_core *core, void *scratch, uint32_t by, const struct mcr_points *at, double *mass)
{
    const double share = core->sky_share;
    if (!is_alone(core) || core->sky_emitter < 0)
        core->lights->mass(core->emitters, scratch, by, at, mass);
    for (uint32_t i = 0; i < at->n && core->sky_emitter >= 0; i++)
        mass[i] = is_alone(core) ? 1 : (1 - share) * mass[i] + share;
}

/* ---- Points ---------------------------------------------------------------------------------------------------- */

/* What a point of the sky is, besides its direction. */
static void set_sky_point(const struct mcr_core *core, const struct mcr_emitter_points *out, uint32_t i)
{
    out->emitter[i] = core->sky_emitter;
    out->qx[i] = out->qy[i] = out->qz[i] = 0;
    out->distance[i] = INFINITY;
}

/* Of lanes that drew the sky. */
static void set_sky_density(const struct mcr_core *core, void *scratch, const struct mcr_emitter_points *points, double *density)
{
    double *of_sky = row_of(core, scratch, points->n, ROW_DENSITY);
    const double share = core->sky_share;
    core->sky_functions->density(core->sky, points->n, points->wx, points->wy, points->wz, of_sky);
    for (uint32_t i = 0; i < points->n; i++) {
        double finite = is_alone(core) ? 0 : (1 - share) * density[i];
        density[i] = points->emitter[i] == core->sky_emitter ? share * of_sky[i] : finite;
    }
}

void mcr_lights_draw_point(const struct mcr_core *core, void *scratch, uint32_t by, const struct mcr_points *at, const double *const *number,
                           const struct mcr_emitter_points *out, double *density)
{
    if (core->sky_emitter < 0) {
        core->lights->draw_point(core->emitters, scratch, by, at, number, out, density);
        return;
    }
    double *first = row_of(core, scratch, at->n, ROW_NUMBER), *wanted = row_of(core, scratch, at->n, ROW_WANTED);
    double *choice = row_of(core, scratch, at->n, ROW_CHOICE), *x = row_of(core, scratch, at->n, ROW_X), *y = row_of(core, scratch, at->n, ROW_Y);
    double *z = row_of(core, scratch, at->n, ROW_Z);
    if (is_alone(core)) {
        core->sky_functions->draw(core->sky, at->n, number[0], number[1], number[2], out->wx, out->wy, out->wz);
        for (uint32_t i = 0; i < at->n; i++)
            set_sky_point(core, out, i);
    } else {
        const double *const numbers[MCR_LIGHT_DIMENSIONS] = {first, number[1], number[2]};
        struct mcr_points some = *at;
        some.wanted = wanted;
        split(core, at, number[0], first, wanted, choice);
        core->lights->draw_point(core->emitters, scratch, by, &some, numbers, out, density);
        core->sky_functions->draw(core->sky, at->n, choice, number[1], number[2], x, y, z);
        for (uint32_t i = 0; i < at->n; i++) {
            if (!(number[0][i] < core->sky_share))
                continue;
            out->wx[i] = x[i];
            out->wy[i] = y[i];
            out->wz[i] = z[i];
            set_sky_point(core, out, i);
        }
    }
    if (density)
        set_sky_density(core, scratch, out, density);
}

void mcr_lights_density_point(const struct mcr_core *core, void *scratch, uint32_t by, const struct mcr_points *at,
                              const struct mcr_emitter_points *points, double *density)
{
    if (core->sky_emitter < 0) {
        core->lights->density_point(core->emitters, scratch, by, at, points, density);
        return;
    }
    if (!is_alone(core)) {
        struct mcr_emitter_points finite = *points;
        finite.emitter = (int32_t *)(void *)row_of(core, scratch, at->n, ROW_EMITTER);
        for (uint32_t i = 0; i < points->n; i++)
            finite.emitter[i] = points->emitter[i] == core->sky_emitter ? -1 : points->emitter[i];
        core->lights->density_point(core->emitters, scratch, by, at, &finite, density);
    }
    set_sky_density(core, scratch, points, density);
}
