/* SPDX-License-Identifier: Apache-2.0 */
/*
 * One scattering event: throughput times f cos / density, then Russian roulette: a path goes on with the probability of its largest throughput
 * component (at most 1) and is weighted up by its inverse (Arvo and Kirk, "Particle transport and image synthesis", 1990).
 * Stage file, compiled once per instruction set.
 */
#include "core/stages.h"

void MCR_ISA_NAME(mcr_stage_scatter)(struct mcr_batch *batch, uint32_t begin, uint32_t end, const double *u)
{
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
    if (u) {
        const uint32_t *bounce = paths->bounce;
        const uint32_t from = batch->core->scene->render.roulette_from;
        MCR_LANES
        for (uint32_t k = begin; k < end; k++) {
            double most = r[k] > g[k] ? r[k] : g[k];
            most = most > b[k] ? most : b[k];
            double chance = ((bounce[k] >= from) & (most < 1)) ? most : 1.0;
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
