/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Feature layers: what is known of scenes by construction; `direct` against pictures of one scattering event, `albedo` against furnaces; and that asking
 * for them changes no bit of the picture.
 */
#include <stdlib.h>

#include "../scene/help.h"
#include "base/cpu.h"
#include "core/core.h"
#include "film/features.h"
#include "film/film.h"
#include "film/sampling.h"

#define SIDE 16
#define PIXELS (SIDE * SIDE)
#define ALL (MCR_FEATURE_ALBEDO | MCR_FEATURE_NORMAL | MCR_FEATURE_DEPTH | MCR_FEATURE_ID | MCR_FEATURE_DIRECT)

static double image[3 * PIXELS], plain[3 * PIXELS];

#define ROUND 16u

/* Renders; NULL after a failure, or where nothing is asked for. map: rounds of each pixel, or NULL. The picture goes to rgb. */
static struct mcr_features *render_by(const uint32_t *map, const char *text, const char *settings, const char *filter, uint32_t asked, double *rgb)
{
    char whole[4000];
    struct mcr_overrides over = {.has_threads = 1, .threads = 2};
    snprintf(whole, sizeof whole, "%sfilm { size (%d, %d) filter %s }\nrender { %s }\n", text, SIDE, SIDE, filter, settings);
    struct world world = open_world(whole, &over);
    if (!world.scene)
        return NULL;
    struct mcr_film *film = mcr_film_create(SIDE, SIDE, world.scene->sampler->correlated);
    struct mcr_features *features = asked ? mcr_features_create(PIXELS, asked, map != NULL) : NULL;
    const struct mcr_sampling_rules rules = {.round = ROUND, .map = map};
    struct mcr_sampling *sampling = map ? mcr_sampling_create(film, features, &rules) : NULL;
    struct mcr_director director;
    struct mcr_render_options how = {.isa = MCR_ISA_BASELINE, .features = asked};
    struct mcr_render_stats stats;
    char error[256] = "";
    struct mcr_cell_sink sink = mcr_film_sink(film);
    sink.add_features = mcr_features_add;
    sink.features = features;
    if (sampling) {
        director = mcr_sampling_director(sampling);
        how.director = &director;
    }
    struct mcr_accel *accel = mcr_accel_create(world.arena, world.scene, world.scene->render.accel);
    if (mcr_render(world.scene, accel, &how, &sink, &stats, error, sizeof error)) {
        fprintf(stderr, "%s\n", error);
        mcr_features_destroy(features);
        features = NULL;
    }
    mcr_film_mean(film, rgb);
    mcr_sampling_destroy(sampling);
    mcr_film_destroy(film);
    close_world(&world);
    return features;
}

static struct mcr_features *render(const char *text, const char *settings, const char *filter, uint32_t asked, double *rgb)
{
    return render_by(NULL, text, settings, filter, asked, rgb);
}

static double largest_difference(const double *a, const double *b, size_t n)
{
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, fabs(a[i] - b[i]));
    return most;
}

#define ROOM                                                                                                   \
    "camera perspective { from (0.1, 0.2, 3.4) to (0, 0, 0) fov 50 }\n"                                         \
    "material grey lambert { albedo (0.7, 0.5, 0.3) }\nmaterial lamp emitter { radiance (4, 3, 2) albedo 0.4 sides two }\n" \
    "box { min (-1, -1, -1) max (1, 1, 4) material grey }\nsphere { center (0.4, -0.6, 0) radius 0.4 material grey }\n" \
    "quad { corner (-0.4, 0.95, -0.4) u (0.8, 0, 0) v (0, 0, 0.8) material lamp }\n"

/* All samplers, filters and a background: direct light of deep paths is what paths of one event see, and both parts are the whole. */
static void test_parts(const char *sampler, const char *filter, const char *more, int background)
{
    char settings[400];
    double sum[3 * PIXELS], direct[3 * PIXELS];
    int positive = 1, some = 0;
    const char *sky = background ? "background (0.3, 0.4, 0.5)" : "";
    snprintf(settings, sizeof settings, "spp 40 seed 5 depth 1 roulette off sampler %s %s %s", sampler, more, sky);
    render(ROOM, settings, filter, 0, plain);
    snprintf(settings, sizeof settings, "spp 40 seed 5 depth 6 roulette on(from=1) sampler %s %s %s", sampler, more, sky);
    struct mcr_features *f = render(ROOM, settings, filter, ALL, image);
    if (!ok(f != NULL, "%s, %s renders", sampler, filter))
        return;
    for (uint64_t p = 0; p < PIXELS; p++) {
        double indirect[3];
        mcr_features_value(f, MCR_FEATURE_DIRECT, p, direct + 3 * p);
        mcr_features_value(f, MCR_FEATURE_INDIRECT, p, indirect);
        for (int c = 0; c < 3; c++) {
            sum[3 * p + c] = direct[3 * p + c] + indirect[c];
            positive &= indirect[c] >= 0;
            some |= indirect[c] > 0.01;
        }
    }
    double parts = largest_difference(sum, image, 3 * PIXELS), once = largest_difference(direct, plain, 3 * PIXELS);
    ok(parts < 1e-12 * 4, "%s, %s: direct and indirect light are the picture (%.2g)", sampler, filter, parts);
    if (strncmp(more, "compat", 6)) /* else there is a background at the limit, which is another in the two pictures */
        ok(once < 1e-12 * 4, "%s, %s: direct light is the picture of one scattering event (%.2g)", sampler, filter, once);
    ok(some && (positive || strcmp(filter, "box")), "%s, %s: there is indirect light, and it is not negative", sampler, filter);
    mcr_features_destroy(f);
    render(ROOM, settings, filter, 0, plain);
    ok(!memcmp(plain, image, sizeof plain), "%s, %s: the picture has the same bits without features", sampler, filter);
}

/* One pixel of what a narrow view sees: a plane whose normal and distance are known, in scenes of any size. */
static void test_first(double size)
{
    char text[1000];
    double n[3], albedo[3], depth, id;
    snprintf(text, sizeof text,
             "let s = %g camera perspective { from (3 * s, 0, 0) to (0, 0, 0) fov 1e-6 }\n"
             "material other lambert { albedo 0.1 }\nmaterial mine lambert { albedo (0.2, 0.4, 0.8) }\n"
             "plane { point (0, 0, 0) normal (-3, 4, 0) / 5 material mine }\nsphere { center (0, 9 * s, 0) radius s material other }\n",
             size);
    struct mcr_features *f = render(text, "spp 20 depth 0 sampler cosine", "box", ALL, image);
    if (!ok(f != NULL, "size %g renders", size))
        return;
    mcr_features_value(f, MCR_FEATURE_NORMAL, 7, n);
    mcr_features_value(f, MCR_FEATURE_ALBEDO, 7, albedo);
    mcr_features_value(f, MCR_FEATURE_DEPTH, 7, &depth);
    mcr_features_value(f, MCR_FEATURE_ID, 7, &id);
    ok(near3(n, 0.6, -0.8, 0, 1e-12), "size %g: the normal on the camera's side (%.3g, %.3g, %.3g)", size, n[0], n[1], n[2]);
    ok(near3(albedo, 0.2, 0.4, 0.8, 1e-12), "size %g: the albedo, at depth 0 too (%.17g)", size, albedo[0]);
    ok(fabs(depth / (3 * size) - 1) < 1e-7, "size %g: depth %.9g in scene units", size, depth);
    ok(id == 2, "size %g: material %g", size, id);
    mcr_features_destroy(f);
}

/* A quad whose edge crosses all pixels of a column at 0.3: 0.7 of it is covered, and its centre is inside. */
static void test_edges(const char *filter, double covered, double tolerance)
{
    static const char text[] = "camera orthographic { from (8, 8, 5) to (8, 8, 0) height 16 }\nmaterial m lambert { albedo 0.5 }\n"
                               "material far lambert { albedo 1 }\nquad { corner (4.3, -9, 0) u (8, 0, 0) v (0, 99, 0) material m }\n";
    struct mcr_features *f = render(text, "spp 4096 depth 1 sampler cosine", filter, ALL, image);
    double albedo[3], n[3], depth, id, mean = 0;
    int depths = 1, ids = 1;
    if (!ok(f != NULL, "an edge, %s, renders", filter))
        return;
    for (uint64_t y = 0; y < SIDE; y++) {
        mcr_features_value(f, MCR_FEATURE_ALBEDO, y * SIDE + 4, albedo);
        mcr_features_value(f, MCR_FEATURE_NORMAL, y * SIDE + 4, n);
        mcr_features_value(f, MCR_FEATURE_DEPTH, y * SIDE + 4, &depth);
        mcr_features_value(f, MCR_FEATURE_ID, y * SIDE + 4, &id);
        mean += albedo[1] / SIDE;
        depths &= fabs(depth - 5) < 1e-12 && fabs(n[2] - albedo[0] * 2) < 1e-12;
        ids &= id == 1;
        mcr_features_value(f, MCR_FEATURE_DEPTH, y * SIDE, &depth);
        mcr_features_value(f, MCR_FEATURE_ID, y * SIDE, &id);
        depths &= depth == 0;
        ids &= id == 0;
    }
    /* 65536 samples: 4 sigma are 0.007 of coverage */
    ok(fabs(mean - 0.5 * covered) < tolerance, "%s: albedo of an edge %.5f, expected %.5f", filter, mean, 0.5 * covered);
    ok(depths, "%s: depth is that of hits, 0 without any; the normal is a mean of all", filter);
    ok(ids, "%s: ids are those at the pixels' centres", filter);
    mcr_features_destroy(f);
}

/* In a uniform light of 1 a convex body shows its directional albedo: the layer must have the same mean. */
static void test_albedo(const char *material, double tolerance)
{
    char text[1000];
    double mean[3] = {0, 0, 0}, seen[3] = {0, 0, 0}, albedo[3], worst = 0;
    snprintf(text, sizeof text, "camera orthographic { from (0, 0, 5) to (0, 0, 0) height 1.2 }\nmaterial m %s\nsphere { center (0, 0, 0) radius 1 material m }\n",
             material);
    struct mcr_features *f = render(text, "spp 1024 depth 1 sampler bsdf roulette off background 1", "box", MCR_FEATURE_ALBEDO, image);
    if (!ok(f != NULL, "%s renders", material))
        return;
    for (uint64_t p = 0; p < PIXELS; p++) {
        mcr_features_value(f, MCR_FEATURE_ALBEDO, p, albedo);
        for (int c = 0; c < 3; c++) {
            mean[c] += albedo[c] / PIXELS;
            seen[c] += image[3 * p + c] / PIXELS;
        }
    }
    for (int c = 0; c < 3; c++)
        worst = fmax(worst, fabs(mean[c] - seen[c]));
    ok(worst < tolerance && seen[0] > 0.1, "%s: albedo %.6f %.6f %.6f, furnace %.6f %.6f %.6f", material, mean[0], mean[1], mean[2], seen[0], seen[1], seen[2]);
    mcr_features_destroy(f);
}

/* A stained mask before a wall: what is opaque, and the wall through the rest. 262144 samples whose variance is below 1: 4 sigma are 0.008. */
static void test_mask(void)
{
    static const char text[] = "camera perspective { from (0, 0, 5) to (0, 0, 0) fov 40 }\nmaterial wall lambert { albedo 0.5 }\n"
                               "material lead lambert { albedo (0.8, 0.6, 0.4) }\nmaterial m mask { material lead opacity (0.5, 0.25, 0.75) }\n"
                               "quad { corner (-9, -9, -1) u (18, 0, 0) v (0, 18, 0) material wall }\n"
                               "quad { corner (-9, -9, 0) u (18, 0, 0) v (0, 18, 0) material m }\n";
    struct mcr_features *f = render(text, "spp 1024 depth 1 sampler cosine", "box", MCR_FEATURE_ALBEDO, image);
    double mean[3] = {0, 0, 0}, albedo[3];
    if (!ok(f != NULL, "a mask renders"))
        return;
    for (uint64_t p = 0; p < PIXELS; p++) {
        mcr_features_value(f, MCR_FEATURE_ALBEDO, p, albedo);
        for (int c = 0; c < 3; c++)
            mean[c] += albedo[c] / PIXELS;
    }
    ok(near3(mean, 0.5 * 0.8 + 0.5 * 0.5, 0.25 * 0.6 + 0.75 * 0.5, 0.75 * 0.4 + 0.25 * 0.5, 0.008), "the albedo of a mask and of what is behind it: %.4f %.4f %.4f",
       mean[0], mean[1], mean[2]);
    mcr_features_destroy(f);
}

/* Shading normals of a triangle, in the middle of its corners: their mean, normalised. */
static void test_smooth(void)
{
    static const char text[] = "camera perspective { from (0, 0, 5) to (0, 0, 0) fov 1e-7 }\nmaterial m lambert { albedo 0.5 }\n"
                               "triangle { a (-1, -1, 0) b (2, -1, 0) c (-1, 2, 0) normals ((0, 0, 1), (0.6, 0, 0.8), (0, 0.6, 0.8)) material m }\n";
    struct mcr_features *f = render(text, "spp 4 depth 1 sampler cosine", "box", MCR_FEATURE_NORMAL, image);
    double n[3], length = sqrt(0.36 + 0.36 + 2.6 * 2.6);
    if (!ok(f != NULL, "a smooth triangle renders"))
        return;
    mcr_features_value(f, MCR_FEATURE_NORMAL, 100, n);
    ok(near3(n, 0.6 / length, 0.6 / length, 2.6 / length, 1e-8), "its shading normal (%.6f, %.6f, %.6f)", n[0], n[1], n[2]);
    mcr_features_destroy(f);
}

/* The boundary of an interior loses no light, though radiance changes with the index. */
static void test_matter(const char *material, double tolerance)
{
    char text[1000];
    double albedo[3], sum = 0;
    snprintf(text, sizeof text, "camera orthographic { from (0, 0, 5) to (0, 0, 0) height 1.2 }\nmaterial m %s\nsphere { center (0, 0, 0) radius 1 material m }\n",
             material);
    struct mcr_features *f = render(text, "spp 64 depth 0 sampler bsdf", "box", MCR_FEATURE_ALBEDO, image);
    if (!ok(f != NULL, "%s renders", material))
        return;
    for (uint64_t p = 0; p < PIXELS; p++) {
        mcr_features_value(f, MCR_FEATURE_ALBEDO, p, albedo);
        sum += albedo[1] / PIXELS;
    }
    ok(fabs(sum - 1) < tolerance, "%s: albedo %.6f", material, sum);
    mcr_features_destroy(f);
}

/* A wall, seen under 45 degrees, shows what it reflects and passes of the light around it; a smooth one to rounding. */
static void test_walls(void)
{
    static const char *const rough[] = {"", " roughness 0.4", " roughness 0.4 compensation kulla-conty"};
    for (int i = 0; i < 3; i++) {
        char text[1000];
        double mean = 0, seen = 0, albedo[3];
        snprintf(text, sizeof text, "camera orthographic { from (0, 3, 3) to (0, 0, 0) height 0.1 }\nmaterial m dielectric { thin yes transmittance (0.1, 0.5, 1)%s }\n"
                 "quad { corner (-1, -1, 0) u (2, 0, 0) v (0, 2, 0) material m }\n", rough[i]);
        struct mcr_features *f = render(text, "spp 1024 depth 1 sampler bsdf roulette off background 1", "box", MCR_FEATURE_ALBEDO, image);
        if (!ok(f != NULL, "a wall renders"))
            return;
        for (uint64_t p = 0; p < PIXELS; p++) {
            mcr_features_value(f, MCR_FEATURE_ALBEDO, p, albedo);
            mean += albedo[0] / PIXELS;
            seen += image[3 * p] / PIXELS;
        }
        ok(fabs(mean - seen) < 0.002 && seen > 0.1 && seen < 0.4, "a wall%s: albedo %.6f, furnace %.6f", rough[i], mean, seen);
        mcr_features_destroy(f);
    }
}

/* In rounds a pixel has the layers that it has in a render with as many samples everywhere. */
static void test_rounds(void)
{
    static const uint32_t layers[] = {MCR_FEATURE_ALBEDO, MCR_FEATURE_NORMAL, MCR_FEATURE_DEPTH, MCR_FEATURE_ID, MCR_FEATURE_DIRECT, MCR_FEATURE_INDIRECT};
    uint32_t map[PIXELS];
    double most = 0, different = 0;
    for (uint32_t p = 0; p < PIXELS; p++)
        map[p] = 1 + p % 3;
    struct mcr_features *mapped = render_by(map, ROOM, "seed 5 depth 3 sampler nee", "tent", ALL, image);
    if (!ok(mapped != NULL, "in rounds"))
        return;
    for (uint32_t n = 1; n <= 3; n++) {
        char settings[100];
        snprintf(settings, sizeof settings, "spp %u seed 5 depth 3 sampler nee", n * ROUND);
        struct mcr_features *whole = render(ROOM, settings, "tent", ALL, plain);
        if (!ok(whole != NULL, "with %u samples", n * ROUND))
            return;
        for (uint32_t p = 0; p < PIXELS; p++)
            for (uint32_t i = 0; i < 6; i++) {
                double a[3] = {0}, b[3] = {0}, off;
                mcr_features_value(mapped, layers[i], p, a);
                mcr_features_value(whole, layers[i], p, b);
                off = fmax(fabs(a[0] - b[0]), fmax(fabs(a[1] - b[1]), fabs(a[2] - b[2])));
                if (map[p] == n)
                    most = fmax(most, off);
                else
                    different += off;
            }
        mcr_features_destroy(whole);
    }
    ok(most < 1e-13 * 4, "in rounds every pixel has the layers of its number of samples (%.2g)", most);
    ok(different > 1, "which are others with other numbers (%.3g)", different);
    mcr_features_destroy(mapped);
}

int main(void)
{
    test_parts("cosine", "box", "", 0);
    test_parts("mixture(cosine 1, light 1)", "tent", "", 1);
    test_parts("nee", "mitchell", "", 0);
    test_parts("stratified(nee)", "gaussian", "replicates 2", 1);
    test_parts("cosine", "box", "compat (clamp, background-at-limit)", 1);
    test_first(1);
    test_first(1e-6);
    test_first(1e9);
    test_edges("box", 0.7, 0.0035);
    test_edges("tent", 1 - 0.5 * 0.8 * 0.8, 0.0035);
    test_albedo("lambert { albedo (0.3, 0.5, 0.9) }", 1e-9);
    test_albedo("oren-nayar { albedo (0.9, 0.5, 0.3) sigma 0.8 }", 0.002);
    test_albedo("conductor { metal gold roughness 0.5 }", 0.002);
    test_albedo("mix { first a second b amount 0.3 }\nmaterial a lambert { albedo (0.3, 0.5, 0.9) }\nmaterial b mirror { reflectance (0.9, 0.2, 0.4) }", 0.002);
    test_albedo("mix { first a second b amount 0.7 }\nmaterial a oren-nayar { albedo (0.9, 0.5, 0.3) sigma 0.8 }\nmaterial b emitter { radiance 0 }", 0.002);
    test_albedo("principled { base_color (0.9, 0.5, 0.3) roughness 0.6 }", 0.002);
    test_albedo("principled { base_color (0.9, 0.5, 0.3) metallic 0.5 }", 0.002);
    test_albedo("principled { base_color (0.9, 0.5, 0.3) metallic 1 roughness 0.8 compensation none }", 0.002);
    test_albedo("principled { base_color 0.3 sheen_color 1 }", 0.002);
    test_albedo("principled { base_color (0.9, 0.5, 0.3) clearcoat 1 }", 0.002);
    test_matter("dielectric { index 1.5 }", 1e-9);
    test_matter("dielectric { index 1.5 roughness 0.5 compensation kulla-conty }", 0.005);
    test_matter("principled { transmission 1 roughness 0.7 }", 0.005);
    test_walls();
    test_mask();
    test_rounds();
    test_smooth();
    return tap_done();
}
