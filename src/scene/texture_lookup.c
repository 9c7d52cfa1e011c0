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

/* ---- gradient ---- */

/* A coordinate in [0, 1]. */
static inline double wrapped(double s, uint32_t wrap)
{
    double turn = s - 2.0 * mcr_floor(0.5 * s);
    if (wrap == MCR_WRAP_REPEAT)
        return s - mcr_floor(s);
    if (wrap == MCR_WRAP_MIRROR)
        return turn > 1.0 ? 2.0 - turn : turn;
    return mcr_clamp(s, 0.0, 1.0);
}

/* The last stop that is not behind t: two stops at one place make a step. */
static inline uint32_t stop_before(const struct mcr_texture_gradient *gradient, double t)
{
    uint32_t low = 0, high = gradient->count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (gradient->position[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static double along(const struct mcr_texture_gradient *gradient, double s, double t)
{
    double x = s - 0.5, y = t - 0.5;
    return gradient->along == MCR_ALONG_U ? s : gradient->along == MCR_ALONG_V ? t : 2.0 * sqrt(x * x + y * y);
}

static void gradient(const struct mcr_texture *texture, uint32_t n, const struct lanes *lanes, double *r, double *g, double *b)
{
    const struct mcr_texture_gradient *gradient = &texture->gradient;
    const struct mcr_texture_bounds *bounds = &texture->bounds;
    for (uint32_t i = 0; i < n; i++) {
        double at = wrapped(along(gradient, lanes->s[i], lanes->t[i]), gradient->wrap), colour[3], share = 0;
        uint32_t k = stop_before(gradient, at), next = k + 1 < gradient->count ? k + 1 : k;
        if (next > k && at > gradient->position[k])
            share = (at - gradient->position[k]) / (gradient->position[next] - gradient->position[k]);
        for (int c = 0; c < 3; c++)
            colour[c] = mcr_clamp(gradient->colour[k][c] * (1.0 - share) + gradient->colour[next][c] * share, bounds->min[c], bounds->max[c]);
        r[i] = colour[0];
        g[i] = colour[1];
        b[i] = colour[2];
    }
}

/* ---- image ---- */

/* Where on an axis of `size` texels a filter looks: two texels and the share of the second. */
struct taps {
    size_t first, second;
    double share;
};

/* x: the number of a texel as a double, at most one beyond the ends. */
static inline size_t texel(double x, double size, uint32_t wrap)
{
    if (wrap == MCR_WRAP_REPEAT)
        x = x < 0 ? x + size : x >= size ? x - size : x;
    return (size_t)mcr_clamp(x, 0.0, size - 1.0); /* a mirror shows the last texel twice */
}

static inline struct taps taps_of(double s, double size, uint32_t wrap)
{
    double x = wrapped(s, wrap) * size - 0.5, below = mcr_floor(x);
    return (struct taps){ texel(below, size, wrap), texel(below + 1.0, size, wrap), x - below };
}

/* The texel that s is in. Where rounding has made s the upper end, it is the last and not the first. */
static inline struct taps nearest(double s, double size, uint32_t wrap)
{
    size_t at = texel(mcr_floor(wrapped(s, wrap) * size), size, MCR_WRAP_CLAMP);
    return (struct taps){ at, at, 0 };
}

static inline double number(const struct mcr_texture_image *image, const struct mcr_texture_level *level, size_t at)
{
    return level->code ? image->decode[level->code[at]] : level->value[at];
}

static inline double mixed(double a, double b, double share)
{
    return a + share * (b - a);
}

static void bilinear(const struct mcr_texture_image *image, uint32_t k, double s, double t, double out[3])
{
    const struct mcr_texture_level *level = &image->level[k];
    int is_nearest = image->filter == MCR_TEXTURE_NEAREST;
    struct taps x = is_nearest ? nearest(s, level->width, image->wrap[0]) : taps_of(s, level->width, image->wrap[0]);
    struct taps y = is_nearest ? nearest(t, level->height, image->wrap[1]) : taps_of(t, level->height, image->wrap[1]);
    size_t channels = image->channels, low = y.first * level->width, high = y.second * level->width;
    for (size_t c = 0; c < channels; c++) {
        double a = number(image, level, (low + x.first) * channels + c), b = number(image, level, (low + x.second) * channels + c);
        double d = number(image, level, (high + x.first) * channels + c), e = number(image, level, (high + x.second) * channels + c);
        out[c] = mixed(mixed(a, b, x.share), mixed(d, e, x.share), y.share);
    }
}

/*
 * The level whose texels are as wide as the footprint, in a mix with the next: 2^k texels of the picture are level k, and between two
 * levels the share of the coarser grows linearly with the footprint. The wider of both axes counts: rather blurred than aliased.
 */
static void trilinear(const struct mcr_texture_image *image, double s, double t, double ws, double wt, double out[3])
{
    double texels = mcr_max(ws * image->level[0].width, wt * image->level[0].height), share;
    uint32_t last = image->level_count - 1, k = 0;
    double coarse[3];
    if (texels > 1.0) {
        uint64_t exponent = (mcr_bits(texels) >> 52) - 1023;
        k = exponent < last ? (uint32_t)exponent : last;
    }
    bilinear(image, k, s, t, out);
    share = k < last && texels > 1.0 ? texels / (double)(UINT64_C(1) << k) - 1.0 : 0.0;
    if (share <= 0)
        return;
    bilinear(image, k + 1, s, t, coarse);
    for (uint32_t c = 0; c < image->channels; c++)
        out[c] = mixed(out[c], coarse[c], share);
}

static void image(const struct mcr_texture *texture, uint32_t n, const struct lanes *lanes, double *r, double *g, double *b)
{
    const struct mcr_texture_image *image = &texture->image;
    const struct mcr_texture_bounds *bounds = &texture->bounds;
    for (uint32_t i = 0; i < n; i++) {
        double colour[3];
        trilinear(image, lanes->s[i], lanes->t[i], lanes->ws[i], lanes->wt[i], colour);
        if (image->channels == 1)
            colour[1] = colour[2] = colour[0];
        r[i] = mcr_clamp(colour[0], bounds->min[0], bounds->max[0]);
        g[i] = mcr_clamp(colour[1], bounds->min[1], bounds->max[1]);
        b[i] = mcr_clamp(colour[2], bounds->min[2], bounds->max[2]);
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
        switch (texture->kind) {
        case MCR_TEXTURE_CHECKER:
            checker(texture, count, &lanes, r + begin, g + begin, b + begin);
            break;
        case MCR_TEXTURE_GRADIENT:
            gradient(texture, count, &lanes, r + begin, g + begin, b + begin);
            break;
        default:
            image(texture, count, &lanes, r + begin, g + begin, b + begin);
        }
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
