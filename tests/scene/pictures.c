/* SPDX-License-Identifier: Apache-2.0 */
/* Textures that are pictures: filters at known values, levels, decoding, what memory leaves, files that lie. PPM and PFM need no module. */
#include "help.h"

#include "image/image.h"
#include "scene/texture_table.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

struct colour {
    double r, g, b;
};

static char folder[512];

static const char *path(const char *name)
{
    static char text[2][700];
    static int turn;
    char *to = text[turn++ % 2];
    snprintf(to, sizeof text[0], "%s/%s", folder, name);
    return to;
}

static void save(const char *name, const void *bytes, size_t count)
{
    FILE *file = fopen(path(name), "wb");
    if (!file || fwrite(bytes, 1, count, file) != count || fclose(file))
        exit(99);
}

/* A grey PFM (channels 1) or a colour one; rows from the bottom, as PFM has them and textures too. */
static void save_floats(const char *name, int width, int height, int channels, const float *value)
{
    char whole[65536];
    size_t count = sizeof *value * (size_t)(width * height * channels);
    int head = snprintf(whole, sizeof whole, "P%c\n%d %d\n-1\n", channels == 1 ? 'f' : 'F', width, height);
    memcpy(whole + head, value, count);
    save(name, whole, (size_t)head + count);
}

/* The first texture of a scene: `texture t image { file "folder/NAME" SETTINGS }`. NULL after errors. */
static const struct mcr_texture *load(struct world *world, const char *name, const char *settings, const char *more)
{
    char text[3000];
    snprintf(text, sizeof text,
             CAMERA MATERIALS "sphere { center (0, 0, 5) radius 1 material m }\nsphere { center (0, 3, 5) radius 1 material lamp }\n"
                              "texture t image { file \"%s\" %s }\n%s", path(name), settings, more);
    *world = open_world(text, NULL);
    return world->scene ? world->scene->texture[0].texture : NULL;
}

static struct colour look(const struct mcr_texture *texture, double u, double v, double width)
{
    struct colour colour = { NAN, NAN, NAN };
    if (texture)
        mcr_texture_lookup(texture, 1, &u, &v, width >= 0 ? &width : NULL, &colour.r, &colour.g, &colour.b);
    return colour;
}

static int is(double value, double expected, double tolerance)
{
    int good = fabs(value - expected) <= tolerance;
    if (!good)
        printf("# %.17g instead of %.17g\n", value, expected);
    return good;
}

/* 4 x 2 texels: 0 1 2 3 in the lower row, 10 11 12 13 above. */
static const float eight[] = { 0, 1, 2, 3, 10, 11, 12, 13 };

static void filters(void)
{
    struct world world;
    const struct mcr_texture *t;
    save_floats("eight.pfm", 4, 2, 1, eight);
    t = load(&world, "eight.pfm", "filter nearest", "");
    ok(is(look(t, 0, 0, -1).r, 0, 0) && is(look(t, 0.2499, 0.4999, -1).r, 0, 0) && is(look(t, 0.25, 0.5, -1).r, 11, 0) &&
       is(look(t, 0.999, 0.999, -1).g, 13, 0), "nearest: the texel that a point is in, upward and to the right");
    ok(is(look(t, -1e-30, 0, -1).r, 3, 0) && is(look(t, 1, 1, -1).r, 0, 0), "just left of the border the last one, on it the first");
    ok(!mcr_texture_uses_width(t) && mcr_texture_is_grey(t) && mcr_texture_bytes(t) == 64, "no footprint, grey, its size");
    close_world(&world);
    t = load(&world, "eight.pfm", "", "");
    ok(is(look(t, 0.375, 0.25, -1).r, 1, 0) && is(look(t, 0.625, 0.75, -1).b, 12, 0), "bilinear: exact at the centres");
    ok(is(look(t, 0.5, 0.25, -1).r, 1.5, 0) && is(look(t, 0.4375, 0.5, -1).r, 6.25, 0), "and in between, by hand");
    ok(is(look(t, 0, 0.25, -1).r, 1.5, 0) && is(look(t, 1, 0.25, -1).r, 1.5, 0) && is(look(t, 0.9375, 0.25, -1).r, 2.25, 0) && is(look(t, 0.375, 0, -1).r, 6, 0), "repeat: over the border");
    ok(is(look(t, 1e9 + 0.375, -1e9 + 0.25, -1).r, 1, 1e-6) && is(look(t, -0.625, -0.75, -1).r, 1, 0), "far away and on the other side");
    int finite = 1;
    const double odd[] = { INFINITY, -INFINITY, NAN, 1e308, -1e308, 1e19, -1e-320, 0x1p62, 0x1p53 };
    for (int i = 0; i < 9; i++)
        for (int j = 0; j < 9; j++) {
            double value = look(t, odd[i], odd[j], odd[(i + j) % 9]).r;
            finite &= value >= 0 && value <= 13;
        }
    ok(finite, "no coordinate leaves the picture");
    close_world(&world);
}

static void wraps(void)
{
    struct world world;
    const struct mcr_texture *t = load(&world, "eight.pfm", "filter nearest wrap (mirror, clamp)", "");
    ok(is(look(t, 1.1, 0.1, -1).r, 3, 0) && is(look(t, 1.3, 0.1, -1).r, 2, 0) && is(look(t, -0.1, 0.1, -1).r, 0, 0) &&
       is(look(t, -0.3, 0.1, -1).r, 1, 0) && is(look(t, 2.1, 0.1, -1).r, 0, 0) && is(look(t, 1e9 + 1.1, 0.1, -1).r, 3, 0), "mirror");
    ok(is(look(t, 0.1, 7, -1).r, 10, 0) && is(look(t, 0.1, 1, -1).r, 10, 0) && is(look(t, 0.1, -7, -1).r, 0, 0), "clamp, on the other axis");
    close_world(&world);
    t = load(&world, "eight.pfm", "wrap clamp", "");
    ok(is(look(t, 0, 0, -1).r, 0, 0) && is(look(t, 1, 1, -1).r, 13, 0) && is(look(t, 0.0625, 0.25, -1).r, 0, 0), "clamp, bilinear: the border is flat");
    close_world(&world);
    t = load(&world, "eight.pfm", "wrap mirror", "");
    ok(is(look(t, 1, 0.25, -1).r, 3, 0) && is(look(t, 0, 0.25, -1).r, 0, 0) && is(look(t, -0.375, 0.25, -1).r, 1, 0), "mirror, bilinear");
    close_world(&world);
    t = load(&world, "eight.pfm", "filter nearest scale (2, 1) offset (0.25, 0.5)", "");
    ok(is(look(t, 0, 0, -1).r, 11, 0) && is(look(t, 0.125, 0, -1).r, 12, 0) && is(look(t, 0.5, 0.5, -1).r, 1, 0), "scale, then offset");
    close_world(&world);
}

/* 5 x 3: level 1 is 2 x 1, each texel the mean of 2.5 columns; level 2 one texel. */
static void levels(void)
{
    static const float value[15] = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 150 };
    struct world world;
    const struct mcr_texture *t;
    double mean = 0, left = 0;
    save_floats("odd.pfm", 5, 3, 1, value);
    for (int i = 0; i < 15; i++) {
        mean += value[i] / 15.0;
        left += (i % 5 < 2 ? 1 : i % 5 == 2 ? 0.5 : 0) * value[i] / 7.5;
    }
    t = load(&world, "odd.pfm", "filter mipmap", "");
    ok(t && t->image.level_count == 3 && t->image.level[1].width == 2 && t->image.level[1].height == 1 && t->image.level[2].width == 1,
       "5 x 3, 2 x 1, 1 x 1");
    ok(t && is(t->image.level[1].value[0], left, 1e-6) && is(t->image.level[1].value[1], 2 * mean - left, 1e-5), "level 1: means by area");
    ok(t && is(look(t, 0.3, 0.4, 1e9).r, mean, 1e-5) && is(mcr_texture_bounds(t)->mean[0], mean, 1e-12), "the last level: the mean");
    ok(is(look(t, 0.1, 0.5, 0.2).r, 6, 1e-15) && is(look(t, 0.1, 0.5, 0).r, 6, 1e-15), "a footprint of one texel is sharp");
    ok(is(look(t, 0.25, 0.5, 0.4).r, left, 1e-6), "one of two texels sees level 1");
    ok(is(look(t, 0.25, 0.5, 0.6).r, (left + mean) / 2, 1e-5), "one of three sees levels 1 and 2 by halves");
    ok(mcr_texture_uses_width(t) && mcr_texture_bounds(t)->max[0] == 150 && mcr_texture_bounds(t)->min[0] == 1, "its bounds");
    close_world(&world);
}

/* 77 x 53, of one colour and of random ones: means stay what they are through all levels. */
static void means(void)
{
    static unsigned char ppm[15 + 77 * 53 * 3];
    struct world world;
    const struct mcr_texture *t;
    size_t head = (size_t)snprintf((char *)ppm, sizeof ppm, "P6 77 53 255\n"), count = 77 * 53 * 3;
    uint64_t state = 1;
    int same = 1;
    memset(ppm + head, 201, count);
    save("flat.ppm", ppm, head + count);
    t = load(&world, "flat.ppm", "filter mipmap", "");
    for (int i = 0; i < 200; i++) {
        struct colour c = look(t, 0.137 * i, 0.071 * i, 0.001 * i * i);
        same &= t && c.r == t->image.decode[201] && c.g == c.r && c.b == c.r;
    }
    ok(same, "a picture of one colour is of that colour everywhere, to the last bit");
    close_world(&world);
    for (size_t i = 0; i < count; i++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        ppm[head + i] = (unsigned char)(state >> 56);
    }
    save("random.ppm", ppm, head + count);
    t = load(&world, "random.ppm", "filter mipmap colour linear", "");
    double sum[3] = { 0 };
    for (size_t i = 0; i < count; i++)
        sum[i % 3] += ppm[head + i] / 255.0 / (77 * 53);
    struct colour c = look(t, 0.5, 0.5, 1e6);
    ok(is(c.r, sum[0], 1e-6) && is(c.g, sum[1], 1e-6) && is(c.b, sum[2], 1e-6), "the mean of random colours survives six odd halvings");
    ok(t && mcr_texture_bytes(t) < count + 4 * count / 3 + 100 && !mcr_texture_is_grey(t), "a byte a value, and floats for the levels");
    close_world(&world);
}

/* All 256 codes against the formula of IEC 61966-2-1 in long double. */
static void decoding(void)
{
    unsigned char pgm[15 + 256];
    struct world world;
    const struct mcr_texture *t;
    size_t head = (size_t)snprintf((char *)pgm, sizeof pgm, "P5 256 1 255\n");
    int srgb = 1, linear = 1;
    for (int i = 0; i < 256; i++)
        pgm[head + (size_t)i] = (unsigned char)i;
    save("codes.pgm", pgm, head + 256);
    t = load(&world, "codes.pgm", "filter nearest", "");
    for (int i = 0; i < 256; i++) {
        long double e = i / 255.0L, l = e <= 0.04045L ? e / 12.92L : powl((e + 0.055L) / 1.055L, 2.4L);
        srgb &= look(t, (i + 0.5) / 256, 0, -1).r == (float)l;
    }
    close_world(&world);
    t = load(&world, "codes.pgm", "filter nearest colour linear", "");
    for (int i = 0; i < 256; i++)
        linear &= look(t, (i + 0.5) / 256, 0, -1).r == (float)(i / 255.0L);
    close_world(&world);
    ok(srgb, "all codes of 8 bits are decoded from sRGB, as floats exactly");
    ok(linear, "or not at all, as asked for");
    static const float half[] = { 0.5f, 0.5f, 0.5f };
    save_floats("half.pfm", 1, 1, 3, half);
    t = load(&world, "half.pfm", "colour srgb", "");
    ok(is(look(t, 0, 0, -1).r, 0.21404114048223255, 1e-8), "floats from sRGB, where that is asked for");
    close_world(&world);
    static const float colour[] = { 1, 10, 100 };
    save_floats("colour.pfm", 1, 1, 3, colour);
    t = load(&world, "colour.pfm", "channel green", "");
    ok(is(look(t, 0, 0, -1).b, 10, 0) && mcr_texture_is_grey(t), "one channel");
    close_world(&world);
    t = load(&world, "colour.pfm", "channel luminance", "");
    ok(is(look(t, 0, 0, -1).b, 0.2126 + 7.152 + 7.22, 1e-6), "luminance");
    close_world(&world);
}

static uint32_t warnings_of(struct world *world)
{
    return mcr_diagnostics_warnings(world->diagnostics);
}

static void memory(void)
{
    static float value[64 * 64];
    struct world world;
    const struct mcr_texture *t;
    uint32_t before;
    for (int i = 0; i < 64 * 64; i++)
        value[i] = (float)(i % 64);
    save_floats("large.pfm", 64, 64, 1, value);
    t = load(&world, "large.pfm", "", "");
    before = warnings_of(&world);
    ok(t && t->image.level[0].width == 64 && mcr_texture_bytes(t) == 16384, "16 KiB of floats");
    close_world(&world);
    t = load(&world, "large.pfm", "", "render { texture_memory 0.015 }");
    ok(t && t->image.level[0].width == 32 && warnings_of(&world) == before + 1 && is(look(t, 0.25, 0.5, -1).r, 15.5, 1e-6),
       "with less than that it is halved, with a warning");
    close_world(&world);
    t = load(&world, "large.pfm", "filter mipmap", "render { texture_memory 0.0003 }");
    ok(t && t->image.level[0].width == 4 && mcr_texture_bytes(t) <= 314 && is(look(t, 0.125, 0.5, -1).r, 7.5, 1e-6), "or halved again and again");
    close_world(&world);
    quiet = 1;
    t = load(&world, "large.pfm", "", "render { texture_memory 1e-5 }");
    ok(!t, "and refused where not even one texel fits");
    close_world(&world);
    char two[1000];
    snprintf(two, sizeof two, "texture s image { file \"%s\" }\nrender { texture_memory 0.02 }", path("large.pfm"));
    quiet = 0;
    t = load(&world, "large.pfm", "", two);
    ok(t && t->image.level[0].width == 64 && world.scene->texture[1].texture->image.level[0].width == 32, "all textures count together");
    close_world(&world);
}

/* Files that cannot be read: an error at the place of their name, no scene. */
static void hostile(void)
{
    static const float bad[] = { 1, NAN, 2, INFINITY };
    struct world world;
    int refused = 1;
    save_floats("nan.pfm", 2, 2, 1, bad);
    save("empty.ppm", "", 0);
    save("text.png", "hello", 5);
    save("huge.ppm", "P6 1000000 1000000 255\n", 23);
    save("large.ppm", "P6 60000 60000 255\n", 19);
    save("zero.ppm", "P6 0 5 255\n", 11);
    save("cut.ppm", "P6 5 5 255\n1234567890", 21);
    mkdir(path("folder.png"), 0700);
    quiet = 1;
    const char *names[] = { "nan.pfm", "empty.ppm", "text.png", "huge.ppm", "large.ppm", "zero.ppm", "cut.ppm", "folder.png", "absent.png", "eight.pfm/x" };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        int gone = !load(&world, names[i], "filter mipmap", "") && mcr_diagnostics_errors(world.diagnostics) == 1;
        if (!gone)
            printf("# %s\n", names[i]);
        refused &= gone;
        close_world(&world);
    }
    ok(refused, "files that are absent, cut off, of nothing, of too much or of no known kind: one error each");
    ok(!load(&world, "eight.pfm", "channel alpha", "") && mcr_diagnostics_errors(world.diagnostics) == 1, "no alpha, no channel alpha");
    close_world(&world);
    quiet = 0;
}

/* Many lanes are as many times one lane. */
static void lanes(void)
{
    enum { N = 203 };
    struct world world;
    const struct mcr_texture *t = load(&world, "eight.pfm", "filter mipmap wrap (repeat, mirror)", "");
    double u[N], v[N], w[N], r[N], g[N], b[N];
    int same = t != NULL;
    for (int i = 0; i < N; i++) {
        u[i] = 0.37 * i - 20;
        v[i] = 30 - 0.41 * i;
        w[i] = 0.01 * i;
    }
    if (t)
        mcr_texture_lookup(t, N, u, v, w, r, g, b);
    for (int i = 0; same && i < N; i++)
        same = look(t, u[i], v[i], w[i]).r == r[i] && r[i] == g[i] && g[i] == b[i];
    ok(same, "a lane depends on itself alone");
    close_world(&world);
}

/* PNG through the module: alpha, 16 bits, a file that is cut off. */
static void module_formats(void)
{
    static const char *const names[] = { "R", "G", "B", "A" };
    struct world world;
    char reason[300];
    if (!mcr_image_module(reason, sizeof reason)) {
        ok(1, "PNG and EXR # SKIP %s", reason);
        return;
    }
    struct mcr_image *image = mcr_image_create(40, 30, 4, names);
    for (int i = 0; i < 4 * 40 * 30; i++)
        image->data[i] = i % 4 == 3 ? 0.25 : i % 4 + (i / 4 % 40) * 0.01;
    for (int k = 0; k < 2; k++) {
        struct mcr_write_options options = { .bits = 8 };
        struct mcr_write_result result;
        struct mcr_target *target = mcr_target_open(path(k ? "a.tiff" : "a.exr"), reason, sizeof reason);
        if (!target || mcr_target_write(target, image, &options, &result) != 0)
            exit(99);
    }
    mcr_image_destroy(image);
    const struct mcr_texture *t = load(&world, "a.exr", "filter nearest", "");
    ok(is(look(t, 0.5 / 40, 0.5, -1).b, 2, 1e-7) && is(look(t, 2.5 / 40, 0.5, -1).r, 0.02, 1e-7), "EXR: colours");
    close_world(&world);
    t = load(&world, "a.exr", "filter nearest channel alpha", "");
    ok(is(look(t, 0.5, 0.5, -1).b, 0.25, 0), "EXR: alpha");
    close_world(&world);
    t = load(&world, "a.tiff", "filter nearest", "");
    ok(t && t->image.level[0].code && is(look(t, 20.5 / 40, 0.5, -1).r, 0.2, 2e-3), "TIFF of 8 bits, kept as such");
    close_world(&world);
    quiet = 1;
    for (int k = 0; k < 2; k++) {
        const char *name = k ? "a.tiff" : "a.exr";
        struct stat status;
        if (stat(path(name), &status) || truncate(path(name), status.st_size * 3 / 4))
            exit(99);
        ok(!load(&world, name, "", "") && mcr_diagnostics_errors(world.diagnostics) >= 1, "%s cut off is an error", name);
        close_world(&world);
    }
    quiet = 0;
}

int main(void)
{
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%.400s/mcr-picture-XXXXXX", base && *base ? base : "/tmp");
    if (!mkdtemp(folder))
        return 99;
    filters();
    wraps();
    levels();
    means();
    decoding();
    memory();
    hostile();
    lanes();
    module_formats();
    char command[600];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command) != 0 ? 99 : tap_done();
}
