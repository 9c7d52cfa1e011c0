/* SPDX-License-Identifier: Apache-2.0 */
/* Maps of the error: raw values, false colours. */
#include "help.h"
#include "metrics/map.h"

/* CIE lightness from linear R, G, B. */
static double lightness(const double *pixel)
{
    double y = 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
    return y > 216.0 / 24389 ? 116 * mcr_pow(y, 1.0 / 3) - 16 : y * 24389 / 27;
}

static void raw(void)
{
    struct mcr_image *a = image_new(3, 2, 3, rgb), *r = image_new(3, 2, 3, rgb), *mask = image_flat(3, 2, 1, grey, 1), *map;
    struct mcr_metrics_options options = {.mask = mask}, crop = {.has_crop = 1, .crop = {1, 0, 3, 1}};
    char error[256];
    int good = 1;
    for (int i = 0; i < 18; i++) a->data[i] = 0.25 * i, r->data[i] = 3;
    mask->data[4] = 0;
    for (int kind = 0; kind < MCR_MAP_KINDS; kind++) {
        map = mcr_map_create(a, r, &options, kind, error, sizeof error);
        for (int i = 0; i < 18; i++) {
            double e = 0.25 * i - 3, wanted = kind == MCR_MAP_SIGNED ? e : kind == MCR_MAP_ABSOLUTE ? fabs(e) : fabs(e) / sqrt(9.01);
            good &= i / 3 == 4 ? isnan(map->data[i]) : close_to(map->data[i], wanted, 1e-15);
        }
        good &= close_to(mcr_map_largest(map), kind == MCR_MAP_RELATIVE ? 2.75 / sqrt(9.01) : 2.75, 1e-15);
        mcr_image_destroy(map);
    }
    ok(good, "signed, absolute and relative values; NaN where the mask is black");
    map = mcr_map_create(a, r, &crop, MCR_MAP_SIGNED, error, sizeof error);
    ok(map->width == 2 && map->height == 1 && map->channels == 3 && map->data[0] == 0.75 - 3 && !strcmp(map->name[2], "B"), "of the region only");
    mcr_image_destroy(map);
    mcr_image_destroy(a);
    mcr_image_destroy(r);
    mcr_image_destroy(mask);
}

static void colours(void)
{
    struct mcr_image *map = image_new(201, 1, 1, grey), *shown;
    int rising = 1, falling = 1, within = 1;
    for (int i = 0; i <= 200; i++) map->data[i] = 0.01 * i;
    shown = mcr_map_colour(map, MCR_MAP_ABSOLUTE, 2);
    for (int i = 0; i <= 200; i++) {
        /* 92 units of lightness in 512 shades: steps of .46 on average; a shade's distance from the exact place is at most .09 */
        if (i) rising &= close_to(lightness(shown->data + 3 * i) - lightness(shown->data + 3 * i - 3), 0.46, 0.2);
        for (int c = 0; c < 3; c++) within &= shown->data[3 * i + c] >= 0 && shown->data[3 * i + c] <= 1;
    }
    ok(rising, "absolute: lightness rises in equal steps");
    mcr_image_destroy(shown);
    for (int i = 0; i <= 200; i++) map->data[i] = 0.01 * i - 1;
    shown = mcr_map_colour(map, MCR_MAP_SIGNED, 1);
    for (int i = 1; i <= 100; i++) {
        const double *below = shown->data + 3 * (100 - i), *above = shown->data + 3 * (100 + i);
        falling &= lightness(below) < lightness(below + 3) && lightness(above) < lightness(above - 3) && close_to(lightness(below), lightness(above), 0.5);
        within &= i < 5 || (below[2] > below[0] && above[0] > above[2]);
    }
    ok(falling, "signed: lightness falls to both sides alike");
    ok(within, "all colours can be shown; below 0 is blue, above red");
    ok(lightness(shown->data + 300) > 95, "no error is white");
    mcr_image_destroy(shown);
    map->data[0] = MCR_NAN, map->data[1] = 1e300, map->data[2] = 1, map->data[3] = -1e300, map->data[4] = -1;
    shown = mcr_map_colour(map, MCR_MAP_SIGNED, 1);
    ok(shown->data[0] == shown->data[1] && shown->data[1] == shown->data[2] && shown->data[0] > 0.2 && shown->data[0] < 0.22, "what takes no part is grey");
    ok(!memcmp(shown->data + 3, shown->data + 6, 3 * sizeof(double)) && !memcmp(shown->data + 9, shown->data + 12, 3 * sizeof(double)),
       "what is beyond the range has its last colour");
    mcr_image_destroy(shown);
    mcr_image_destroy(map);
}

int main(void)
{
    raw();
    colours();
    return tap_done();
}
