/* SPDX-License-Identifier: Apache-2.0 */
/* Textures at work: from (u, v) to colours, in blocks of lanes. Nothing here allocates, and no lane looks at another. */
#include "base/elementary.h"
#include "base/lanes.h"
#include "scene/texture_table.h"

#include <stddef.h>

#define BLOCK 64u /* lanes at a time: their coordinates stay in the nearest cache */

/* Coordinates of a block in the texture's own space, with its footprint along both axes; all are finite, footprints at least 0. */
struct lanes {
    double s[BLOCK], t[BLOCK], ws[BLOCK], wt[BLOCK];
};

/* Where a double is no finer than whole periods there is nothing to look up. */
static inline double finite_or_zero(double x)
{
    return fabs(x) < 0x1p62 ? x : 0.0;
}

static void place(const struct mcr_texture *texture, uint32_t n, const double *restrict u, const double *restrict v,
                  const double *restrict width, struct lanes *restrict lanes)
{
    double su = texture->scale[0], sv = texture->scale[1], ou = texture->offset[0], ov = texture->offset[1];
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        lanes->s[i] = finite_or_zero(u[i] * su + ou);
        lanes->t[i] = finite_or_zero(v[i] * sv + ov);
    }
    if (!width) {
        for (uint32_t i = 0; i < n; i++)
            lanes->ws[i] = lanes->wt[i] = 0;
        return;
    }
    su = fabs(su);
    sv = fabs(sv);
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double w = width[i] > 0 ? width[i] : 0.0;
        w = w < 0x1p62 ? w : 0x1p62;
        lanes->ws[i] = w * su;
        lanes->wt[i] = w * sv;
    }
}

/* ---- checker ---- */

/* 1 - |1 - x| on [0, 2), with period 2: the integral from 0 of the wave that is 1 on [0, 1) and -1 on [1, 2). */
static inline double triangle(double x)
{
    return 1.0 - fabs(1.0 - (x - 2.0 * mcr_floor(0.5 * x)));
}

/*
 * The mean of that wave over [s - w/2, s + w/2]. A footprint of at most one field crosses one edge at most: what lies beyond it
 * counts with the other sign, without a difference of large numbers.
 */
static inline double wave(double s, double w)
{
    double k = mcr_floor(s), f = s - k, pair = 0.5 * k, odd = pair == mcr_floor(pair) ? 0.0 : 1.0, sign = 1.0 - 2.0 * odd;
    double half = 0.5 * w, over = mcr_max(mcr_max(f + half - 1.0, half - f), 0.0), divisor = w > 0 ? w : 1.0, near, far;
    near = sign * (1.0 - 2.0 * over / divisor);
    far = (triangle(f + odd + half) - triangle(f + odd - half)) / divisor;
    return w > 1.0 ? far : near;
}

/* The product of two such waves is 1 on even fields and -1 on odd ones, and its mean over a rectangle the product of the means. */
static void checker(const struct mcr_texture *restrict texture, uint32_t n, struct lanes *restrict lanes, double *restrict r,
                    double *restrict g, double *restrict b)
{
    const struct mcr_texture_checker *checker = &texture->checker;
    const struct mcr_texture_bounds *bounds = &texture->bounds;
    double filtered = checker->filtered ? 1.0 : 0.0;
    double *out[3] = { r, g, b };
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        lanes->s[i] = 0.5 - 0.5 * (wave(lanes->s[i], lanes->ws[i] * filtered) * wave(lanes->t[i], lanes->wt[i] * filtered));
    for (int c = 0; c < 3; c++) {
        double even = checker->even[c], odd = checker->odd[c], min = bounds->min[c], max = bounds->max[c], *restrict to = out[c];
        MCR_LANES
        for (uint32_t i = 0; i < n; i++)
            to[i] = mcr_clamp(even * (1.0 - lanes->s[i]) + odd * lanes->s[i], min, max);
    }
}

/* ---- all kinds ---- */

void mcr_texture_lookup(const struct mcr_texture *texture, uint32_t n, const double *u, const double *v, const double *width, double *r,
                        double *g, double *b)
{
    struct lanes lanes;
    for (uint32_t begin = 0; begin < n; begin += BLOCK) {
        uint32_t count = n - begin < BLOCK ? n - begin : BLOCK;
        place(texture, count, u + begin, v + begin, width ? width + begin : NULL, &lanes);
        checker(texture, count, &lanes, r + begin, g + begin, b + begin);
    }
}

const struct mcr_texture_bounds *mcr_texture_bounds(const struct mcr_texture *texture)
{
    return &texture->bounds;
}

int mcr_texture_uses_width(const struct mcr_texture *texture)
{
    return texture->kind == MCR_TEXTURE_CHECKER ? texture->checker.filtered
                                                : texture->kind == MCR_TEXTURE_IMAGE && texture->image.level_count > 1;
}

int mcr_texture_is_grey(const struct mcr_texture *texture)
{
    return texture->grey;
}

uint64_t mcr_texture_bytes(const struct mcr_texture *texture)
{
    return texture->bytes;
}
