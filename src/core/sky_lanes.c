/* SPDX-License-Identifier: Apache-2.0 */
/* Radiance, density and directions of the sky (sky.h). Stage file, compiled once per instruction set. */
#include <math.h>

#include "base/elementary.h"
#include "base/lanes.h"
#include "core/cell.h"
#include "core/sky.h"
#include <mcrender/sampler.h>

#define BLOCK 64u

/* Lanes in the environment's own frame, and the texels that they fall into. */
struct block {
    uint32_t n;
    double x[BLOCK], y[BLOCK], z[BLOCK]; /* +y is up; zero directions stay zero */
    double across[BLOCK], down[BLOCK];   /* place in the image, in texels */
    int32_t row[BLOCK], column[BLOCK];
};

static double at_most(double a, double b)
{
    return a < b ? a : b;
}

static void turn(const struct mcr_environment *from, uint32_t n, const double *restrict wx, const double *restrict wy, const double *restrict wz,
                 struct block *restrict b)
{
    const double (*f)[3] = from->frame;
    b->n = n;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double x = wx[i], y = wy[i], z = wz[i], up = f[1][0] * x + f[1][1] * y + f[1][2] * z;
        b->x[i] = f[0][0] * x + f[0][1] * y + f[0][2] * z;
        b->y[i] = mcr_clamp(up, -1, 1);
        b->z[i] = f[2][0] * x + f[2][1] * y + f[2][2] * z;
    }
}

/*
 * The texel of each lane. Rows are told by the edges that they were drawn between: the arc cosine is a guess that may be one off.
 */
static void find_texels(const struct mcr_sky *sky, struct block *restrict b)
{
    const double *restrict edge = sky->edge;
    const double width = sky->environment->width, height = sky->environment->height;
    const int32_t last_column = (int32_t)sky->environment->width - 1, last_row = (int32_t)sky->environment->height - 1;
    MCR_LANES
    for (uint32_t i = 0; i < b->n; i++) {
        double across = (0.5 - mcr_atan2(b->x[i], b->z[i]) * (0.5 / MCR_PI)) * width, down = mcr_acos(b->y[i]) * (height / MCR_PI);
        int32_t c = (int32_t)at_most(across, width), r = (int32_t)at_most(down, height);
        c = c < 0 ? 0 : c > last_column ? last_column : c;
        r = r < 0 ? 0 : r > last_row ? last_row : r;
        r -= r > 0 && b->y[i] > edge[r];
        r += r < last_row && b->y[i] <= edge[r + 1];
        b->across[i] = across;
        b->down[i] = down;
        b->column[i] = c;
        b->row[i] = r;
    }
}

/* ---- Radiance -------------------------------------------------------------------------------------------------- */

static void add_gradient(const struct mcr_environment *from, const struct block *restrict b, double *restrict red, double *restrict green,
                         double *restrict blue)
{
    double *out[3] = {red, green, blue};
    for (int j = 0; j < 3; j++) {
        double *restrict to = out[j];
        const double horizon = from->horizon[j], above = from->zenith[j] - horizon, below = from->nadir[j] - horizon;
        MCR_LANES
        for (uint32_t i = 0; i < b->n; i++) {
            double y = b->y[i];
            to[i] += horizon + (y < 0 ? -y * below : y * above);
        }
    }
}

static void add_texels(const struct mcr_environment *from, const struct block *b, double *red, double *green, double *blue)
{
    for (uint32_t i = 0; i < b->n; i++) {
        const double *texel = from->texel + 3 * ((size_t)b->row[i] * from->width + (size_t)b->column[i]);
        red[i] += texel[0] * from->scale;
        green[i] += texel[1] * from->scale;
        blue[i] += texel[2] * from->scale;
    }
}

/*
 * Between the centres of four texels; around the image by columns, and as the outermost row beyond its middle. The neighbours are told from the texel
 * itself, so that none is asked whose reach the density leaves out.
 */
static void add_bilinear(const struct mcr_environment *from, const struct block *b, double *red, double *green, double *blue)
{
    const int32_t width = (int32_t)from->width, height = (int32_t)from->height;
    for (uint32_t i = 0; i < b->n; i++) {
        int32_t c = b->column[i], r = b->row[i];
        double s = mcr_clamp(b->across[i] - c, 0, 1) - 0.5, t = mcr_clamp(b->down[i] - r, 0, 1) - 0.5;
        int32_t c2 = s < 0 ? (c + width - 1) % width : (c + 1) % width, r2 = t < 0 ? (r > 0 ? r - 1 : 0) : (r + 1 < height ? r + 1 : r);
        double sw = fabs(s), tw = fabs(t);
        const double *row = from->texel + 3 * (size_t)r * from->width, *row2 = from->texel + 3 * (size_t)r2 * from->width;
        double sum[3];
        for (int j = 0; j < 3; j++) {
            double one = row[3 * (size_t)c + (size_t)j] * (1 - sw) + row[3 * (size_t)c2 + (size_t)j] * sw;
            double two = row2[3 * (size_t)c + (size_t)j] * (1 - sw) + row2[3 * (size_t)c2 + (size_t)j] * sw;
            sum[j] = one * (1 - tw) + two * tw;
        }
        red[i] += sum[0] * from->scale;
        green[i] += sum[1] * from->scale;
        blue[i] += sum[2] * from->scale;
    }
}

/*
 * Whether w is within 1 - cos <= versine of a sun's direction s: |w - s|^2 / 2 is 1 - cos without cancellation. A difference of unit vectors errs by
 * 2^-53 a component, which is 1e-7 of the smallest angle.
 */
MCR_INLINE int within(const struct mcr_sky_sun *sun, double x, double y, double z)
{
    double dx = x - sun->direction[0], dy = y - sun->direction[1], dz = z - sun->direction[2];
    return 0.5 * (dx * dx + dy * dy + dz * dz) <= sun->versine;
}

static void add_sun(const struct mcr_sky_sun *sun, uint32_t n, const double *restrict x, const double *restrict y, const double *restrict z,
                    double *restrict red, double *restrict green, double *restrict blue)
{
    const double r = sun->radiance[0], g = sun->radiance[1], b = sun->radiance[2];
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        int inside = within(sun, x[i], y[i], z[i]);
        red[i] += inside ? r : 0;
        green[i] += inside ? g : 0;
        blue[i] += inside ? b : 0;
    }
}

static void radiance(const struct mcr_sky *sky, uint32_t n, const double *x, const double *y, const double *z, double *red, double *green, double *blue)
{
    for (uint32_t i = 0; i < n; i++) {
        red[i] = sky->background[0];
        green[i] = sky->background[1];
        blue[i] = sky->background[2];
    }
    for (uint32_t at = 0; sky->environment && at < n; at += BLOCK) {
        struct block b;
        turn(sky->environment, n - at < BLOCK ? n - at : BLOCK, x + at, y + at, z + at, &b);
        if (!sky->environment->texel) {
            add_gradient(sky->environment, &b, red + at, green + at, blue + at);
            continue;
        }
        find_texels(sky, &b);
        if (sky->environment->bilinear)
            add_bilinear(sky->environment, &b, red + at, green + at, blue + at);
        else
            add_texels(sky->environment, &b, red + at, green + at, blue + at);
    }
    for (uint32_t s = 0; s < sky->sun_count; s++)
        add_sun(&sky->sun[s], n, x, y, z, red, green, blue);
}

/* ---- Density --------------------------------------------------------------------------------------------------- */

static void gradient_density(const struct mcr_sky *sky, const struct block *restrict b, double *restrict density)
{
    const double horizon = sky->horizon, above = sky->zenith - horizon, below = sky->nadir - horizon, factor = sky->factor * sky->probability;
    MCR_LANES
    for (uint32_t i = 0; i < b->n; i++) {
        double y = b->y[i], l = horizon + (y < 0 ? -y * below : y * above);
        density[i] = (l < 0 ? 0 : l) * factor;
    }
}

static void texel_density(const struct mcr_sky *sky, const struct block *b, double *density)
{
    for (uint32_t i = 0; i < b->n; i++) {
        const double *from = sky->column_from + (size_t)b->row[i] * (sky->environment->width + 1) + (size_t)b->column[i];
        density[i] = sky->probability * sky->row_density[b->row[i]] * (from[1] - from[0]);
    }
}

static void add_sun_density(const struct mcr_sky_sun *sun, uint32_t n, const double *restrict x, const double *restrict y, const double *restrict z,
                            double *restrict density)
{
    const double its = sun->probability / (2 * MCR_PI * sun->versine);
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        density[i] += within(sun, x[i], y[i], z[i]) ? its : 0;
}

static void density(const struct mcr_sky *sky, uint32_t n, const double *x, const double *y, const double *z, double *out)
{
    for (uint32_t at = 0; at < n; at += BLOCK) {
        uint32_t count = n - at < BLOCK ? n - at : BLOCK;
        struct block b;
        if (!(sky->probability > 0)) {
            for (uint32_t i = 0; i < count; i++)
                out[at + i] = 0;
            continue;
        }
        turn(sky->environment, count, x + at, y + at, z + at, &b);
        if (sky->environment->texel) {
            find_texels(sky, &b);
            texel_density(sky, &b, out + at);
        } else {
            gradient_density(sky, &b, out + at);
        }
    }
    for (uint32_t s = 0; s < sky->sun_count; s++)
        add_sun_density(&sky->sun[s], n, x, y, z, out);
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) /* the zero direction */
        out[i] = x[i] * x[i] + y[i] * y[i] + z[i] * z[i] > 0.5 ? out[i] : 0;
}

/* ---- Directions ------------------------------------------------------------------------------------------------ */

/* Linear from a at 0 to b at 1: the place below which a share u of it lies. */
MCR_INLINE double invert_linear(double a, double b, double u)
{
    double root = sqrt(a * a + u * (b - a) * (b + a)), divisor = a + root;
    return at_most(u * (a + b) / (divisor > 0 ? divisor : 1), 1);
}

static void draw_gradient(const struct mcr_sky *sky, struct block *restrict b, const double *restrict u, const double *restrict v)
{
    const double above = sky->above, zenith = sky->zenith, horizon = sky->horizon, nadir = sky->nadir;
    MCR_LANES
    for (uint32_t i = 0; i < b->n; i++) {
        int up = u[i] < above;
        double share = up ? u[i] / (above > 0 ? above : 1) : (u[i] - above) / (above < 1 ? 1 - above : 1);
        double y = invert_linear(horizon, up ? zenith : nadir, at_most(share, 1)), sine, cosine, radius = sqrt((1 - y) * (1 + y));
        mcr_sincos_turns(v[i], &sine, &cosine);
        b->x[i] = radius * sine;
        b->y[i] = up ? y : -y;
        b->z[i] = radius * cosine;
    }
}

/* The last of 2^levels ascending numbers that is not above u; place[count] bounds it where there are fewer. */
static uint32_t search(const double *place, uint32_t count, uint32_t levels, double u)
{
    uint32_t at = 0;
    for (uint32_t l = levels; l-- > 0;) {
        uint32_t next = at + (1u << l);
        at = next < count && place[next < count ? next : 0] <= u ? next : at;
    }
    return at;
}

/* What is left of the number within its stretch, again in [0, 1). */
MCR_INLINE double rest(double u, double from, double to)
{
    double share = (u - from) / (to > from ? to - from : 1);
    return mcr_clamp(share, 0, 0x1.fffffffffffffp-1);
}

static void draw_texels(const struct mcr_sky *sky, struct block *b, const double *u, const double *v)
{
    const uint32_t width = sky->environment->width, height = sky->environment->height;
    for (uint32_t i = 0; i < b->n; i++) {
        uint32_t r = search(sky->row_from, height, sky->row_levels, v[i]);
        const double *columns = sky->column_from + (size_t)r * (width + 1);
        uint32_t c = search(columns, width, sky->column_levels, u[i]);
        b->down[i] = sky->edge[r] + rest(v[i], sky->row_from[r], r + 1 < height ? sky->row_from[r + 1] : 1) * (sky->edge[r + 1] - sky->edge[r]);
        b->across[i] = 0.5 - (c + rest(u[i], columns[c], columns[c + 1])) / width;
    }
    MCR_LANES
    for (uint32_t i = 0; i < b->n; i++) {
        double y = b->down[i], sine, cosine, radius = sqrt((1 - y) * (1 + y));
        mcr_sincos_turns(b->across[i], &sine, &cosine);
        b->x[i] = radius * sine;
        b->y[i] = y;
        b->z[i] = radius * cosine;
    }
}

/* From the environment's frame; one Newton step on the length. */
static void turn_back(const struct mcr_environment *from, const struct block *restrict b, double *restrict wx, double *restrict wy, double *restrict wz)
{
    const double (*f)[3] = from->frame;
    MCR_LANES
    for (uint32_t i = 0; i < b->n; i++) {
        double x = b->x[i], y = b->y[i], z = b->z[i];
        double vx = f[0][0] * x + f[1][0] * y + f[2][0] * z, vy = f[0][1] * x + f[1][1] * y + f[2][1] * z;
        double vz = f[0][2] * x + f[1][2] * y + f[2][2] * z, fix = 0.5 * (1 - (vx * vx + vy * vy + vz * vz));
        wx[i] = vx + vx * fix;
        wy[i] = vy + vy * fix;
        wz[i] = vz + vz * fix;
    }
}

static void draw_sun(const struct mcr_sky_sun *sun, double to, uint32_t n, const double *restrict choice, const double *restrict u,
                     const double *restrict v, double *restrict x, double *restrict y, double *restrict z)
{
    const double from = sun->from, versine = sun->versine, sx = sun->direction[0], sy = sun->direction[1], sz = sun->direction[2];
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        double down = u[i] * versine, radius = sqrt(down * (2 - down)), sine, cosine, wx, wy, wz;
        double was_x = x[i], was_y = y[i], was_z = z[i]; /* read in any case: a select, not a store under a condition */
        int chosen = (choice[i] >= from) & (choice[i] < to);
        mcr_sincos_turns(v[i], &sine, &cosine);
        mcr_to_world(sx, sy, sz, radius * cosine, radius * sine, 1 - down, &wx, &wy, &wz);
        x[i] = chosen ? wx : was_x;
        y[i] = chosen ? wy : was_y;
        z[i] = chosen ? wz : was_z;
    }
}

/* Directions of the environment for all lanes, then those of the suns for the lanes that chose them. */
static void draw(const struct mcr_sky *sky, uint32_t n, const double *choice, const double *u, const double *v, double *x, double *y, double *z)
{
    for (uint32_t at = 0; at < n; at += BLOCK) {
        struct block b = {.n = n - at < BLOCK ? n - at : BLOCK};
        if (!(sky->probability > 0)) {
            for (uint32_t i = at; i < at + b.n; i++)
                x[i] = y[i] = z[i] = 0;
            continue;
        }
        if (sky->environment->texel)
            draw_texels(sky, &b, u + at, v + at);
        else
            draw_gradient(sky, &b, u + at, v + at);
        turn_back(sky->environment, &b, x + at, y + at, z + at);
    }
    for (uint32_t s = 0; s < sky->sun_count; s++)
        draw_sun(&sky->sun[s], s + 1 < sky->sun_count ? sky->sun[s + 1].from : 2, n, choice, u, v, x, y, z);
}

const struct mcr_sky_functions MCR_ISA_NAME(mcr_sky_functions) = {.radiance = radiance, .density = density, .draw = draw};
