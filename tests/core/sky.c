/* SPDX-License-Identifier: Apache-2.0 */
/* What comes from infinitely far: densities integrate to 1 and are what is drawn; radiance is where the manual says; the same bits everywhere. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../tap.h"
#include "base/cpu.h"
#include "core/sky.h"

#define PI 3.14159265358979323846
#define LANES 4096

static double x[LANES], y[LANES], z[LANES], red[LANES], green[LANES], blue[LANES], density[LANES], u[3][LANES];
static struct mcr_arena *arena;

static const struct mcr_sky_functions *functions_of(uint32_t isa)
{
#if defined(__x86_64__)
    static const struct mcr_sky_functions *const all[] = {&mcr_sky_functions_isa0, &mcr_sky_functions_isa1, &mcr_sky_functions_isa2};
    return isa <= mcr_cpu_isa() ? all[isa] : NULL;
#else
    return isa == 0 ? &mcr_sky_functions_isa0 : NULL;
#endif
}

static double random_number(void)
{
    static uint64_t state = 12345;
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(state >> 11) * 0x1p-53;
}

static void draw_numbers(uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            u[k][i] = random_number();
}

/* A frame turned about an axis: rows are own axes in the scene. */
static void set_frame(struct mcr_environment *e, int turned)
{
    double a[3] = {2 / 7.0, 3 / 7.0, 6 / 7.0}, c = cos(0.7), s = sin(0.7);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int k = 3 - i - j;
            double sign = (j + 1) % 3 == i ? 1 : -1, cross = i == j ? 0 : sign * a[k] * s;
            e->frame[i][j] = turned ? a[i] * a[j] * (1 - c) + (i == j ? c : 0) + cross : i == j;
        }
}

/* From the environment's frame to the scene. */
static void put(const struct mcr_environment *e, uint32_t i, double colatitude, double longitude)
{
    double own[3] = {sin(longitude) * sin(colatitude), cos(colatitude), cos(longitude) * sin(colatitude)}, w[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            w[j] += own[k] * e->frame[k][j];
    x[i] = w[0], y[i] = w[1], z[i] = w[2];
}

static const struct mcr_sky *sky_of(const struct mcr_environment *e, struct mcr_scene_light *light, uint32_t count)
{
    static struct mcr_scene scene;
    const struct mcr_sky *sky;
    scene = (struct mcr_scene){.environment = e, .light = light, .light_count = count};
    if (mcr_sky_create(arena, &scene, &sky))
        abort();
    return sky;
}

/* Longitude of the middle of a column: the middle of the image along +z, +x in its left half. */
static double longitude_of(double column, uint32_t width)
{
    return (0.5 - column / width) * 2 * PI;
}

static void test_image(const char *what, struct mcr_environment *e)
{
    const struct mcr_sky *sky = sky_of(e, NULL, 0);
    const struct mcr_sky_functions *f = functions_of(0);
    const uint32_t w = e->width, h = e->height, draws = 400;
    double sum = 0, *weight = calloc((size_t)w * h, sizeof *weight), all = 0, square = 0, worst = 0, *counted = calloc((size_t)w * h, sizeof *counted);
    uint32_t cells = 0, wrong = 0, dark = 0;
    for (uint32_t r = 0; r < h; r++)
        for (uint32_t c = 0; c < w; c++) {
            double solid = 2 * PI / w * (cos(PI * r / h) - cos(PI * (r + 1) / h));
            put(e, 0, PI * (r + 0.5) / h, longitude_of(c + 0.5, w));
            f->density(sky, 1, x, y, z, density);
            f->radiance(sky, 1, x, y, z, red, green, blue);
            sum += density[0] * solid;
            const double *texel = e->texel + 3 * ((size_t)r * w + c);
            /* bilinear: the middle is off by a rounding of the colatitude, and neighbours may be 1e5 times as bright */
            double near = e->bilinear ? 1e-8 : 1e-13;
            wrong += fabs(red[0] - e->scale * texel[0]) > near * (1 + e->scale * texel[0]) || fabs(blue[0] - e->scale * texel[2]) > near * (1 + e->scale * texel[2]);
            weight[r * w + c] = density[0] * solid;
            all += (0.2126 * texel[0] + 0.7152 * texel[1] + 0.0722 * texel[2]) * solid;
        }
    ok(fabs(sum - 1) < 1e-9, "%s: the density integrates to 1%+.1e", what, sum - 1);
    ok(wrong == 0, "%s: the middles of texels have their radiance", what);
    for (uint32_t i = 0; i < w * h && !e->bilinear; i++) {
        uint32_t r = i / w;
        double expected = (0.2126 * e->texel[3 * i] + 0.7152 * e->texel[3 * i + 1] + 0.0722 * e->texel[3 * i + 2]) * 2 * PI / w *
                          (cos(PI * r / h) - cos(PI * (r + 1) / h)) / all;
        worst = fmax(worst, fabs(weight[i] - expected));
    }
    ok(worst < 1e-12, "%s: in proportion to luminance times solid angle, to %.1e", what, worst);
    ok(e->bilinear || fabs(sky->power / (all * e->scale) - 1) < 1e-12, "%s: its power", what);
    for (uint32_t pass = 0; pass < draws; pass++) {
        draw_numbers(LANES);
        f->draw(sky, LANES, u[0], u[1], u[2], x, y, z);
        f->density(sky, LANES, x, y, z, density);
        f->radiance(sky, LANES, x, y, z, red, green, blue);
        for (uint32_t i = 0; i < LANES; i++) {
            double own[3];
            for (int k = 0; k < 3; k++)
                own[k] = e->frame[k][0] * x[i] + e->frame[k][1] * y[i] + e->frame[k][2] * z[i];
            uint32_t r = (uint32_t)fmin(acos(fmax(fmin(own[1], 1), -1)) / PI * h, h - 1);
            uint32_t c = (uint32_t)fmin((0.5 - atan2(own[0], own[2]) / (2 * PI)) * w, w - 1);
            counted[r * w + c]++;
            dark += !(density[i] > 0) || (!e->bilinear && !(green[i] > 0)) || fabs(x[i] * x[i] + y[i] * y[i] + z[i] * z[i] - 1) > 1e-15;
        }
    }
    ok(dark == 0, "%s: what is drawn is unit, has a density and shines (%u of %u do not)", what, dark, draws * LANES);
    for (uint32_t i = 0; i < w * h; i++) {
        double expected = weight[i] * draws * LANES;
        cells += expected > 0;
        square += expected > 0 ? (counted[i] - expected) * (counted[i] - expected) / expected : counted[i] > 3 ? 1e9 : 0;
    }
    double deviation = (square - (cells - 1)) / sqrt(2.0 * (cells > 1 ? cells - 1 : 1));
    ok(fabs(deviation) < 4, "%s: texels are drawn as the density says: chi square %.1f of %u, %+.2f deviations", what, square, cells, deviation);
    /* Anywhere: where there is radiance, there is density. */
    uint32_t missed = 0;
    for (uint32_t i = 0; i < LANES; i++)
        put(e, i, acos(1 - 2 * random_number()), 2 * PI * random_number());
    f->density(sky, LANES, x, y, z, density);
    f->radiance(sky, LANES, x, y, z, red, green, blue);
    for (uint32_t i = 0; i < LANES; i++)
        missed += red[i] + green[i] + blue[i] > 0 && !(density[i] > 0);
    ok(missed == 0, "%s: no radiance without density", what);
    free(weight);
    free(counted);
}

static void test_gradient(const char *what, struct mcr_environment *e)
{
    const struct mcr_sky *sky = sky_of(e, NULL, 0);
    const struct mcr_sky_functions *f = functions_of(0);
    double sum = 0, worst = 0, bins[20] = {0}, square = 0;
    const int steps = 64;
    for (int i = -steps; i < steps; i++) { /* linear between: midpoints are exact */
        double t = (i + 0.5) / steps;
        put(e, 0, acos(t), 0.3 * i);
        f->density(sky, 1, x, y, z, density);
        f->radiance(sky, 1, x, y, z, red, green, blue);
        sum += density[0] * 2 * PI / steps;
        double expected = e->horizon[1] + (t > 0 ? t * (e->zenith[1] - e->horizon[1]) : -t * (e->nadir[1] - e->horizon[1]));
        worst = fmax(worst, fabs(green[0] - expected));
    }
    ok(fabs(sum - 1) < 1e-12, "%s: the density integrates to 1%+.1e", what, sum - 1);
    ok(worst < 1e-14, "%s: linear in the cosine, to %.1e", what, worst);
    uint32_t draws = 300, wrong = 0;
    for (uint32_t pass = 0; pass < draws; pass++) {
        draw_numbers(LANES);
        f->draw(sky, LANES, u[0], u[1], u[2], x, y, z);
        for (uint32_t i = 0; i < LANES; i++) {
            double t = e->frame[1][0] * x[i] + e->frame[1][1] * y[i] + e->frame[1][2] * z[i];
            bins[(int)fmin((t + 1) * 10, 19)]++;
            wrong += fabs(x[i] * x[i] + y[i] * y[i] + z[i] * z[i] - 1) > 1e-15;
        }
    }
    for (int b = 0; b < 20; b++) {
        double t = (b + 0.5) / 10 - 1, l[3];
        for (int j = 0; j < 3; j++)
            l[j] = e->horizon[j] + (t > 0 ? t * (e->zenith[j] - e->horizon[j]) : -t * (e->nadir[j] - e->horizon[j]));
        double expected = (0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2]) * 2 * PI * 0.1 / sky->power * draws * LANES;
        square += expected > 0 ? (bins[b] - expected) * (bins[b] - expected) / expected : bins[b];
    }
    ok(square < 19 + 4 * sqrt(38) && wrong == 0, "%s: drawn so: chi square %.1f of 19", what, square);
}

static void test_suns(void)
{
    static const double radius[] = {1e-6, 1e-4, 0.1, 1.5};
    const struct mcr_sky_functions *f = functions_of(0);
    for (size_t s = 0; s < sizeof radius / sizeof *radius; s++) {
        double versine = 2 * sin(radius[s] / 2) * sin(radius[s] / 2), sum = 0, outside = 0, mean = 0;
        struct mcr_scene_light sun = {.kind = MCR_LIGHT_SUN, .direction = {2 / 7.0, -6 / 7.0, 3 / 7.0}, .colour = {3, 2, 1}, .outer = versine};
        const struct mcr_sky *sky = sky_of(NULL, &sun, 1);
        draw_numbers(LANES);
        f->draw(sky, LANES, u[0], u[1], u[2], x, y, z);
        f->density(sky, LANES, x, y, z, density);
        f->radiance(sky, LANES, x, y, z, red, green, blue);
        for (uint32_t i = 0; i < LANES; i++) {
            double dx = x[i] - sun.direction[0], dy = y[i] - sun.direction[1], dz = z[i] - sun.direction[2];
            outside += !(density[i] > 0) || red[i] != 3 || blue[i] != 1;
            sum = fmax(sum, fabs(density[i] * 2 * PI * versine - 1));
            mean += (dx * dx + dy * dy + dz * dz) / 2 / versine / LANES;
        }
        ok(outside == 0 && sum < 1e-13, "a sun of %g rad: drawn within, density to %.1e", radius[s], sum);
        ok(fabs(mean - 0.5) < 4 * sqrt(1 / 12.0 / LANES), "a sun of %g rad: uniform: mean %.4f of 1 - cos", radius[s], mean);
        /* just beyond its edge there is nothing */
        double beyond = sin(radius[s] * 1.001), t[3] = {-3 / sqrt(13) * 1.0, 0, 2 / sqrt(13)};
        for (int j = 0; j < 3; j++)
            (j == 0 ? x : j == 1 ? y : z)[0] = sun.direction[j] * cos(radius[s] * 1.001) + t[j] * beyond;
        f->radiance(sky, 1, x, y, z, red, green, blue);
        f->density(sky, 1, x, y, z, density);
        ok(red[0] == 0 && density[0] == 0, "a sun of %g rad: dark beyond its edge", radius[s]);
    }
}

/* Parts overlap: the density is their sum, by power, over all of the sphere. */
static void test_parts(struct mcr_environment *e)
{
    struct mcr_scene_light sun[2] = {{.kind = MCR_LIGHT_SUN, .direction = {0, 1, 0}, .colour = {4, 4, 4}, .outer = 2 * sin(0.1) * sin(0.1)},
                                     {.kind = MCR_LIGHT_SUN, .direction = {0, 0.6, 0.8}, .colour = {9, 9, 9}, .outer = 2 * sin(0.2) * sin(0.2)}};
    const struct mcr_sky *sky = sky_of(e, sun, 2), *alone = sky_of(e, NULL, 0);
    const struct mcr_sky_functions *f = functions_of(0);
    double with[LANES], power[3] = {alone->power, 4 * 2 * PI * sun[0].outer, 9 * 2 * PI * sun[1].outer}, all = power[0] + power[1] + power[2], worst = 0;
    uint32_t chosen[3] = {0, 0, 0}, draws = 50;
    for (uint32_t i = 0; i < LANES; i++)
        put(e, i, acos(1 - 2 * random_number()), 2 * PI * random_number());
    f->density(sky, LANES, x, y, z, with);
    f->density(alone, LANES, x, y, z, density);
    for (uint32_t i = 0; i < LANES; i++) {
        double expected = density[i] * power[0] / all;
        for (int s = 0; s < 2; s++) {
            double c = x[i] * sun[s].direction[0] + y[i] * sun[s].direction[1] + z[i] * sun[s].direction[2];
            expected += 1 - c <= sun[s].outer ? power[s + 1] / all / (2 * PI * sun[s].outer) : 0;
        }
        worst = fmax(worst, fabs(with[i] / expected - 1));
    }
    ok(worst < 1e-12, "an environment and two suns: densities add up by power, to %.1e", worst);
    for (uint32_t pass = 0; pass < draws; pass++) {
        draw_numbers(LANES);
        f->draw(sky, LANES, u[0], u[1], u[2], x, y, z);
        for (uint32_t i = 0; i < LANES; i++) {
            double one = y[i], two = 0.6 * y[i] + 0.8 * z[i];
            chosen[1 - one <= sun[0].outer ? 1 : 1 - two <= sun[1].outer ? 2 : 0]++;
        }
    }
    double n = draws * LANES, p = (power[1] + power[0] / (4 * PI) * 2 * PI * sun[0].outer) / all;
    ok(!e->texel && fabs(chosen[1] - n * p) < 4 * sqrt(n * p * (1 - p)), "and so they are drawn: %u of %.0f in the first, expected %.0f", chosen[1], n, n * p);
}

static void test_bits(const char *what, struct mcr_environment *e)
{
    struct mcr_scene_light sun = {.kind = MCR_LIGHT_SUN, .direction = {0, 0.6, 0.8}, .colour = {9, 9, 9}, .outer = 0.02};
    const struct mcr_sky *sky = sky_of(e, &sun, 1);
    static double first[7][LANES], other[7][LANES];
    uint32_t wrong = 0, ways = 0;
    draw_numbers(LANES);
    for (uint32_t isa = 0; isa < 3; isa++)
        for (uint32_t part = 1; part <= LANES; part *= 16) {
            double (*to)[LANES] = isa == 0 && part == 1 ? first : other;
            const struct mcr_sky_functions *f = functions_of(isa);
            for (uint32_t i = 0; f && i < LANES; i += part) {
                f->draw(sky, part, u[0] + i, u[1] + i, u[2] + i, to[0] + i, to[1] + i, to[2] + i);
                f->density(sky, part, to[0] + i, to[1] + i, to[2] + i, to[3] + i);
                f->radiance(sky, part, to[0] + i, to[1] + i, to[2] + i, to[4] + i, to[5] + i, to[6] + i);
            }
            if (f && to == other) {
                ways++;
                wrong += memcmp(first, other, sizeof first) != 0;
            }
        }
    ok(wrong == 0, "%s: the same bits in %u ways", what, ways);
}

static void test_places(void)
{
    static const double texel[3 * 4 * 2] = {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6, 7, 7, 7, 8, 8, 8};
    struct mcr_environment e = {.width = 4, .height = 2, .texel = texel, .scale = 10};
    static const double at[][4] = {{0.1, 0.2, 1, 20}, {1, 0.2, 0.1, 20}, {-0.1, 0.2, 1, 30}, {-1, 0.2, 0.1, 30}, {0.1, 0.2, -1, 10},
                                   {-0.1, 0.2, -1, 40}, {0.1, -0.2, 1, 60}, {-0.1, -0.2, -1, 80}};
    const struct mcr_sky_functions *f = functions_of(0);
    uint32_t wrong = 0;
    set_frame(&e, 0);
    const struct mcr_sky *sky = sky_of(&e, NULL, 0);
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        double length = sqrt(at[i][0] * at[i][0] + at[i][1] * at[i][1] + at[i][2] * at[i][2]);
        x[0] = at[i][0] / length, y[0] = at[i][1] / length, z[0] = at[i][2] / length;
        f->radiance(sky, 1, x, y, z, red, green, blue);
        wrong += fabs(red[0] - at[i][3]) > 1e-12;
    }
    ok(wrong == 0, "the top row is at +y, the middle along +z, +x in the left half");
    x[0] = y[0] = z[0] = 0;
    f->density(sky, 1, x, y, z, density);
    ok(density[0] == 0, "no direction, no density");
    /* poles and the seam: some texel, and a finite density */
    static const double edges[][3] = {{0, 1, 0}, {0, -1, 0}, {0, 0, -1}, {-0.0, 0, -1}, {1, 0, 0}, {0, 0, 1}};
    for (size_t i = 0; i < 6; i++)
        x[i] = edges[i][0], y[i] = edges[i][1], z[i] = edges[i][2];
    f->radiance(sky, 6, x, y, z, red, green, blue);
    f->density(sky, 6, x, y, z, density);
    for (size_t i = 0; i < 6; i++)
        wrong += !(red[i] >= 10 && red[i] <= 80 && density[i] > 0 && density[i] < 10);
    ok(wrong == 0, "poles and the seam have a texel");
}

int main(void)
{
    static double texel[3 * 64 * 32];
    struct mcr_environment image = {.width = 64, .height = 32, .texel = texel, .scale = 2.5};
    struct mcr_environment gradient = {.zenith = {2, 2, 2}, .horizon = {1, 1, 1}, .scale = 1};
    struct mcr_environment constant = {.zenith = {3, 2, 1}, .horizon = {3, 2, 1}, .nadir = {3, 2, 1}, .scale = 1};
    struct mcr_environment tent = {.zenith = {1e-30, 0, 0}, .nadir = {0, 0, 3e30}, .horizon = {0, 1e29, 0}, .scale = 1};
    arena = mcr_arena_create(0);
    test_places();
    for (size_t i = 0; i < 64 * 32; i++) { /* of a range of 1e6, with black rows and columns */
        double v = i / 64 == 7 || i % 64 == 3 || random_number() < 0.3 ? 0 : exp(4 * random_number() * (i % 5 == 0 ? 3 : 1));
        texel[3 * i] = v;
        texel[3 * i + 1] = 0.5 * v;
        texel[3 * i + 2] = 0.1 * v;
    }
    set_frame(&image, 0);
    test_image("image", &image);
    set_frame(&image, 1);
    test_image("turned image", &image);
    test_bits("image", &image);
    image.bilinear = 1;
    test_image("bilinear image", &image);
    test_bits("bilinear image", &image);
    for (size_t i = 0; i < sizeof texel / sizeof *texel; i++)
        texel[i] = i / 3 == 21 * 64 + 40 ? 1e30 : 0;
    image.bilinear = 0;
    test_image("one texel of 1e30", &image);
    image.bilinear = 1;
    test_image("one texel of 1e30, bilinear", &image);
    set_frame(&gradient, 0);
    set_frame(&constant, 1);
    set_frame(&tent, 1);
    test_gradient("1 + cos", &gradient);
    test_gradient("constant", &constant);
    test_bits("gradient", &constant);
    tent.nadir[2] = 0.3, tent.horizon[1] = 0.1, tent.zenith[0] = 0;
    test_gradient("black at the zenith", &tent);
    set_frame(&constant, 0);
    constant.zenith[0] = constant.horizon[0] = constant.nadir[0] = constant.zenith[2] = constant.horizon[2] = constant.nadir[2] = 2;
    test_parts(&constant);
    test_suns();
    mcr_arena_destroy(arena);
    return tap_done();
}
