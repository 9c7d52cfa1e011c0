/* SPDX-License-Identifier: Apache-2.0 */
/* Textures that are computed: known values, footprints, extremes. */
#include "help.h"

#include "scene/texture.h"

struct colour {
    double r, g, b;
};

static struct colour look(const struct mcr_texture *texture, double u, double v, double width)
{
    struct colour colour;
    mcr_texture_lookup(texture, 1, &u, &v, width >= 0 ? &width : NULL, &colour.r, &colour.g, &colour.b);
    return colour;
}

static int is(struct colour a, double r, double g, double b, double tolerance)
{
    int good = fabs(a.r - r) <= tolerance && fabs(a.g - g) <= tolerance && fabs(a.b - b) <= tolerance;
    if (!good)
        printf("# (%.17g, %.17g, %.17g) instead of (%g, %g, %g)\n", a.r, a.g, a.b, r, g, b);
    return good;
}

/* The scene's first texture. */
static const struct mcr_texture *texture_of(struct world *world, const char *text)
{
    char whole[2000];
    snprintf(whole, sizeof whole, CAMERA MATERIALS "sphere { center (0, 0, 5) radius 1 material m }\nsphere { center (0, 3, 5) radius 1 material lamp }\n%s", text);
    *world = open_world(whole, NULL);
    return world->scene ? world->scene->texture[0].texture : NULL;
}

static void checker(void)
{
    struct world world;
    const struct mcr_texture *t = texture_of(&world, "texture a checker { even (1, 0.5, 0) odd 0.25 scale (4, 2) }");
    const struct mcr_texture_bounds *bounds = mcr_texture_bounds(t);
    ok(is(look(t, 0.1, 0.1, -1), 1, 0.5, 0, 0) && is(look(t, 0.3, 0.1, -1), 0.25, 0.25, 0.25, 0) &&
       is(look(t, 0.3, 0.6, -1), 1, 0.5, 0, 0) && is(look(t, 0.1, 0.6, 0), 0.25, 0.25, 0.25, 0), "checker: fields of 1/4 by 1/2");
    ok(is(look(t, -0.1, 0.1, -1), 0.25, 0.25, 0.25, 0) && is(look(t, -0.1, -0.1, -1), 1, 0.5, 0, 0) &&
       is(look(t, 1e9 + 0.1, 0.1, -1), 1, 0.5, 0, 0), "and so to the left, below and far away");
    ok(is(look(t, INFINITY, NAN, INFINITY), 0.625, 0.375, 0.125, 1e-12) && is(look(t, 1e300, -INFINITY, NAN), 1, 0.5, 0, 0),
       "numbers that are not finite are no trouble");
    ok(is(look(t, 0.25, 0.1, 0.1), 0.625, 0.375, 0.125, 1e-15), "half on an edge: the mean");
    ok(is(look(t, 0.225, 0.25, 0.1), 0.8125, 0.4375, 0.0625, 1e-15), "a quarter of the footprint beyond an edge");
    ok(is(look(t, 0.33, 0.77, 1000.1), 0.625, 0.375, 0.125, 1e-4), "a wide footprint: the mean");
    ok(mcr_texture_uses_width(t) && !mcr_texture_is_grey(t) && bounds->min[0] == 0.25 && bounds->max[0] == 1 && bounds->min[2] == 0 &&
       bounds->mean[0] == 0.625 && bounds->mean[2] == 0.125, "its bounds");
    close_world(&world);
}

/* The box filter against the mean of many sharp lookups. */
static void checker_filter(void)
{
    struct world world;
    const struct mcr_texture *t = texture_of(&world, "texture a checker { even 1 odd 0 scale (3, -5) offset (0.3, 0.7) }");
    double worst = 0;
    for (int k = 0; k < 40; k++) {
        double u = 0.37 * k - 4, v = 0.61 * k - 9, w = 0.013 * (k + 1) * (k + 1) / 6, sum = 0;
        for (int i = 0; i < 400; i++)
            for (int j = 0; j < 400; j++)
                sum += look(t, u + w * ((i + 0.5) / 400 - 0.5), v + w * ((j + 0.5) / 400 - 0.5), -1).r;
        double error = fabs(sum / 160000 - look(t, u, v, w).r);
        worst = error > worst ? error : worst;
    }
    /* Each edge is met within half a step of 1/400; at most 18 and 30 edges within the widest footprints, which partly cancel. */
    ok(worst < 5e-3, "the filtered checker is the mean over the footprint: %.1e", worst);
    close_world(&world);
    t = texture_of(&world, "texture a checker { even 1 odd 0 filter none }");
    ok(!mcr_texture_uses_width(t) && look(t, 0.99, 0.5, 0.5).r == 1, "filter none: always sharp");
    close_world(&world);
}

static void gradient(void)
{
    struct world world;
    const struct mcr_texture *t = texture_of(&world, "texture a gradient { from (1, 0, 0) to (0, 0.5, 4) }");
    ok(is(look(t, 0, 9, -1), 1, 0, 0, 0) && is(look(t, 0.25, -3, 7), 0.75, 0.125, 1, 1e-15) && is(look(t, 1, 0, 0), 0, 0.5, 4, 0),
       "gradient along u");
    ok(is(look(t, -5, 0, -1), 1, 0, 0, 0) && is(look(t, 1e9, 0, -1), 0, 0.5, 4, 0) && is(look(t, NAN, INFINITY, -1), 1, 0, 0, 0),
       "its ends go on");
    ok(!mcr_texture_uses_width(t) && !mcr_texture_is_grey(t) && mcr_texture_bounds(t)->max[2] == 4 &&
       is((struct colour){ mcr_texture_bounds(t)->mean[0], mcr_texture_bounds(t)->mean[1], mcr_texture_bounds(t)->mean[2] }, 0.5, 0.25, 2, 1e-12),
       "its bounds");
    close_world(&world);
    t = texture_of(&world, "texture a gradient { from 0 to 1 along v wrap repeat scale (1, 2) }");
    ok(is(look(t, 5, 0.125, -1), 0.25, 0.25, 0.25, 1e-15) && is(look(t, 5, 0.625, -1), 0.25, 0.25, 0.25, 1e-15) && mcr_texture_is_grey(t),
       "along v, twice");
    close_world(&world);
    t = texture_of(&world, "texture a gradient { from 0 to 1 along radial wrap mirror }");
    ok(is(look(t, 0.5, 0.5, -1), 0, 0, 0, 0) && is(look(t, 0.8, 0.9, -1), 1, 1, 1, 1e-15) && is(look(t, 0.5, 1.25, -1), 0.5, 0.5, 0.5, 1e-15),
       "radial, and mirrored beyond");
    close_world(&world);
    t = texture_of(&world, "texture a gradient { stops ((0.25, 1), (0.5, 3), (0.5, 10), (0.75, (20, 10, 10))) }");
    ok(is(look(t, 0, 0, -1), 1, 1, 1, 0) && is(look(t, 0.375, 0, -1), 2, 2, 2, 1e-15) && is(look(t, 0.4999999999, 0, -1), 3, 3, 3, 1e-8) &&
       is(look(t, 0.5, 0, -1), 10, 10, 10, 0) && is(look(t, 0.625, 0, -1), 15, 10, 10, 1e-14) && is(look(t, 1, 0, -1), 20, 10, 10, 0),
       "stops, two of them at one place: a step");
    close_world(&world);
}

int main(void)
{
    gradient();
    checker();
    checker_filter();
    return tap_done();
}
