/* SPDX-License-Identifier: Apache-2.0 */
/*
 * One scattering event: throughput times f cos / density, then Russian roulette (Arvo and Kirk, "Particle transport and image synthesis", 1990): a path
 * goes on with a chance and is weighted up by its inverse.
 *
 * The chance is the throughput, but at least the share of light that the surface scatters, f cos over the density of the material's own sampling (for
 * Lambert: the albedo; 1 where there is no such density). By throughput alone, a sampler that aims at lights would lose the paths that matter: they
 * have low throughput just where much light is to be found. By the share alone, paths of high throughput would gain more than they lose, without bound.
 * Stage file, compiled once per instruction set.
 */
#include <math.h>

#include "core/stages.h"

void MCR_ISA_NAME(mcr_stage_scatter)(struct mcr_batch *batch, const struct mcr_range *range)
{
    const uint32_t begin = range->begin, end = range->end, roulette = range->roulette;
    const struct mcr_paths *paths = &batch->sorted;
    double *r = paths->r, *g = paths->g, *b = paths->b, *alive = batch->alive;
    const double *fr = batch->fr, *fg = batch->fg, *fb = batch->fb, *density = batch->density;
    MCR_LANES
    for (uint32_t k = begin; k < end; k++) {
        int drawn = density[k] > 0;
        double inverse = 1 / (drawn ? density[k] : 1.0);
        double red = r[k] * (fr[k] * inverse), green = g[k] * (fg[k] * inverse), blue = b[k] * (fb[k] * inverse);
        double most = red > green ? red : green;
        most = most > blue ? most : blue;
        r[k] = red;
        g[k] = green;
        b[k] = blue;
        /* NaN lives on, so that it reaches the film and is told. */
        alive[k] = (drawn & !(most <= 0)) ? 1.0 : 0.0;
    }
    if (roulette < end) {
        const uint32_t *bounce = paths->bounce;
        const double *u = batch->roulette;
        const double *own = batch->material_density;
        const uint32_t from = batch->core->scene->render.roulette_from;
        MCR_LANES
        for (uint32_t k = roulette; k < end; k++) {
            double most = fr[k] > fg[k] ? fr[k] : fg[k];
            most = most > fb[k] ? most : fb[k];
            double share = most / (own[k] > 0 ? own[k] : 1.0);
            double carried = r[k] > g[k] ? r[k] : g[k];
            carried = carried > b[k] ? carried : b[k];
            double least = own[k] > 0 ? share : 1.0;
            double chance = carried > least ? carried : least;
            chance = ((chance < 1) & (bounce[k] >= from)) ? chance : 1.0;
            double inverse = 1 / (chance > 0 ? chance : 1.0);
            r[k] *= inverse;
            g[k] *= inverse;
            b[k] *= inverse;
            alive[k] = u[k] >= chance ? 0.0 : alive[k];
        }
    }
    for (uint32_t k = begin; k < end; k++)
        paths->bounce[k]++;
}

/* Unit length is meant to a few roundings; what is off by a millionth is a mistake. */
#define LENGTH_GRACE 2e-6

uint32_t MCR_ISA_NAME(mcr_stage_unsound)(uint32_t n, const double *density, const struct mcr_directions *drawn)
{
    double count = 0;
    if (!drawn) {
        MCR_LANES
        for (uint32_t i = 0; i < n; i++)
            count += (density[i] >= 0) & (density[i] < INFINITY) ? 0.0 : 1.0;
        return (uint32_t)count;
    }
    const double *x = drawn->x, *y = drawn->y, *z = drawn->z;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double off = x[i] * x[i] + y[i] * y[i] + z[i] * z[i] - 1;
        int none = density[i] == 0, fine = (density[i] > 0) & (density[i] < INFINITY) & (off < LENGTH_GRACE) & (off > -LENGTH_GRACE);
        count += none | fine ? 0.0 : 1.0;
    }
    return (uint32_t)count;
}
