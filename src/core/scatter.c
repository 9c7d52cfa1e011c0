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
#include <string.h>

#include "core/stages.h"

/*
 * Whether a density and what was drawn with it can be: 0, and then nothing was drawn, or above 0 and finite and a unit vector. Unit length is meant
 * to a few roundings; what is off by a millionth is a mistake.
 */
#define IS_SOUND(density, x, y, z) \
    (((density) == 0) | (((density) > 0) & ((density) < INFINITY) & (fabs((x) * (x) + (y) * (y) + (z) * (z)-1) < 2e-6)))
#define UNSOUND 2.0 /* as `alive`, for a moment: what was drawn or told cannot be */

/* Sums of doubles have an order, which keeps them from vectors; bits have none. */
static int has_unsound(uint32_t n, const double *alive)
{
    uint64_t all = 0;
    for (uint32_t i = 0; i < n; i++) {
        uint64_t bits;
        memcpy(&bits, alive + i, sizeof bits);
        all |= bits;
    }
    return all >> 62 != 0; /* 0 and 1 have neither bit, 2 has one */
}

void MCR_ISA_NAME(mcr_stage_scatter)(struct mcr_batch *batch, const struct mcr_range *range)
{
    const uint32_t begin = range->begin, end = range->end, roulette = range->roulette;
    const struct mcr_paths *paths = &batch->sorted;
    double *r = paths->r, *g = paths->g, *b = paths->b, *alive = batch->alive;
    const double *fr = batch->fr, *fg = batch->fg, *fb = batch->fb, *density = batch->density;
    const double *wx = batch->wx, *wy = batch->wy, *wz = batch->wz;
    MCR_LANES
    for (uint32_t k = begin; k < end; k++) {
        int drawn = density[k] > 0, sound = IS_SOUND(density[k], wx[k], wy[k], wz[k]);
        double inverse = 1 / (drawn ? density[k] : 1.0);
        double red = r[k] * (fr[k] * inverse), green = g[k] * (fg[k] * inverse), blue = b[k] * (fb[k] * inverse);
        double most = red > green ? red : green;
        most = most > blue ? most : blue;
        r[k] = red;
        g[k] = green;
        b[k] = blue;
        /* NaN lives on, so that it reaches the film and is told. */
        double on = (drawn & !(most <= 0)) ? 1.0 : 0.0;
        alive[k] = sound ? on : UNSOUND;
    }
    if (has_unsound(end - begin, alive + begin)) {
        const struct mcr_directions drawn = {sizeof drawn, end - begin, batch->wx + begin, batch->wy + begin, batch->wz + begin};
        mcr_batch_judge(batch, begin, end - begin, &drawn, batch->density + begin);
        for (uint32_t k = begin; k < end; k++)
            alive[k] = alive[k] == UNSOUND ? 0 : alive[k];
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

static int any_unsound(uint32_t n, const double *restrict density, const double *restrict x, const double *restrict y, const double *restrict z)
{
    _Alignas(64) double flag[64];
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        flag[i] = IS_SOUND(density[i], x[i], y[i], z[i]) ? 0.0 : UNSOUND;
    return has_unsound(n, flag);
}

int MCR_ISA_NAME(mcr_stage_unsound)(uint32_t n, const double *density, const struct mcr_directions *drawn)
{
    int found = 0;
    for (uint32_t first = 0; first < n && !found; first += 64)
        found = any_unsound(n - first < 64 ? n - first : 64, density + first, drawn->x + first, drawn->y + first, drawn->z + first);
    return found;
}
