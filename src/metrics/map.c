/* SPDX-License-Identifier: Apache-2.0 */
#include "metrics/map.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/elementary.h"
#include "base/memory.h"
#include "metrics/pair.h"

const char *const mcr_map_kind_name[MCR_MAP_KINDS] = {"signed", "absolute", "relative"};

static const char *const colours[] = {"R", "G", "B"}, *const grey[] = {"Y"};

static double error_of(double a, double r, enum mcr_map_kind kind, double peak)
{
    double e = a - r;
    if (kind == MCR_MAP_SIGNED)
        return e;
    return kind == MCR_MAP_ABSOLUTE ? fabs(e) : fabs(e) / sqrt(r * r + 0.01 * peak * peak);
}

static int fill(const struct mcr_pair *pair, enum mcr_map_kind kind, struct mcr_image *map)
{
    double *a = mcr_array_alloc(2 * (size_t)pair->width, sizeof *a), *r = a + pair->width;
    if (!a)
        return -1;
    for (uint32_t c = 0; c < pair->channels; c++)
        for (uint32_t y = 0; y < pair->height; y++) {
            double *out = map->data + (size_t)y * pair->width * pair->channels + c;
            mcr_pair_row(pair, 0, c, y, a);
            mcr_pair_row(pair, 1, c, y, r);
            for (uint32_t x = 0; x < pair->width; x++)
                out[(size_t)x * pair->channels] = mcr_pair_has(pair, x, y) ? error_of(a[x], r[x], kind, pair->peak) : MCR_NAN;
        }
    free(a);
    return 0;
}

struct mcr_image *mcr_map_create(const struct mcr_image *image, const struct mcr_image *reference, const struct mcr_metrics_options *options,
                                 enum mcr_map_kind kind, char *error, size_t length)
{
    struct mcr_pair pair;
    struct mcr_image *map = NULL;
    if (!mcr_pair_init(&pair, image, reference, options, error, length)) {
        map = mcr_image_create(pair.width, pair.height, pair.channels, pair.channels == 1 ? grey : colours);
        if (!map || fill(&pair, kind, map)) {
            snprintf(error, length, "out of memory");
            mcr_image_destroy(map);
            map = NULL;
        }
    }
    mcr_pair_fini(&pair);
    return map;
}

static double shown(const struct mcr_image *map, size_t pixel)
{
    double sum = 0;
    for (uint32_t c = 0; c < map->channels; c++)
        sum += map->data[pixel * map->channels + c];
    return sum / map->channels;
}

double mcr_map_largest(const struct mcr_image *map)
{
    double largest = 0;
    for (size_t i = 0; i < (size_t)map->width * map->height; i++)
        largest = mcr_max(fabs(shown(map, i)), largest); /* not where it is NaN */
    return largest;
}

/* CIELAB lightness, chroma and hue (degrees) to linear Rec. 709, white D65. */
static void lab_to_rgb(double lightness, double chroma, double hue, double rgb[3])
{
    static const double white[3] = {0.9505, 1, 1.089}, matrix[3][3] = {
        {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}, /* IEC 61966-2-1 */
    };
    double xyz[3], f[3];
    f[1] = (lightness + 16) / 116;
    f[0] = f[1] + chroma * mcr_cos_degrees(hue) / 500;
    f[2] = f[1] - chroma * mcr_sin_degrees(hue) / 200;
    for (int i = 0; i < 3; i++)
        xyz[i] = white[i] * (f[i] > 6.0 / 29 ? f[i] * f[i] * f[i] : (f[i] - 4.0 / 29) * 3 * (6.0 / 29) * (6.0 / 29));
    for (int i = 0; i < 3; i++)
        rgb[i] = matrix[i][0] * xyz[0] + matrix[i][1] * xyz[1] + matrix[i][2] * xyz[2];
}

/* The same with as much of the chroma as a display can show. */
static void colour_of(double lightness, double chroma, double hue, double rgb[3])
{
    for (int step = 0; step <= 100; step++) {
        lab_to_rgb(lightness, chroma * (1 - 0.01 * step), hue, rgb);
        if (rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0 && rgb[0] <= 1 && rgb[1] <= 1 && rgb[2] <= 1)
            return;
    }
    for (int i = 0; i < 3; i++)
        rgb[i] = mcr_clamp(rgb[i], 0, 1);
}

#define SHADES 512

/* t in [0, 1], or in [-1, 1] for a signed map. */
static void shade(double t, enum mcr_map_kind kind, double rgb[3])
{
    if (kind == MCR_MAP_SIGNED)
        colour_of(98 - 62 * fabs(t), 56 * fabs(t), t < 0 ? 275 : 35, rgb);
    else
        colour_of(4 + 92 * t, 62, 290 + 175 * t, rgb); /* hue 290: blue; 360: red; 465: yellow */
}

struct mcr_image *mcr_map_colour(const struct mcr_image *map, enum mcr_map_kind kind, double range)
{
    double low = kind == MCR_MAP_SIGNED ? -1 : 0;
    struct mcr_image *image = mcr_image_create(map->width, map->height, 3, colours);
    double (*table)[3] = mcr_array_alloc(SHADES + 1, sizeof *table);
    for (int k = 0; table && k <= SHADES; k++)
        shade(low + (1 - low) * k / SHADES, kind, table[k]);
    for (size_t i = 0; image && table && i < (size_t)map->width * map->height; i++) {
        double v = shown(map, i), t = mcr_clamp((v / range - low) / (1 - low), 0, 1);
        for (int c = 0; c < 3; c++)
            image->data[3 * i + c] = v == v ? table[(int)(t * SHADES + 0.5)][c] : 0.21404114048223255; /* of sRGB .5 */
    }
    if (!table) {
        mcr_image_destroy(image);
        image = NULL;
    }
    free(table);
    return image;
}
