/* SPDX-License-Identifier: Apache-2.0 */
/* What reports are made of: numbers and escapes, base64, PNG, axes, plots, parts of pictures. */
#include <locale.h>
#include <math.h>
#include <string.h>

#include "../tap.h"
#include "image/image.h"
#include "image/read.h"
#include "image/srgb.h"
#include "study/axis.h"
#include "study/picture.h"
#include "study/plot.h"
#include "study/png.h"
#include "study/text.h"

#include <stdlib.h>

/* Ends the text. */
static int text_is(struct mcr_text *text, const char *expected)
{
    int same = !text->failed && text->bytes && !strcmp(text->bytes, expected) && text->used == strlen(expected);
    if (!same)
        printf("# '%s' instead of '%s'\n", text->bytes ? text->bytes : "", expected);
    mcr_text_fini(text);
    return same;
}

static int digits_are(double x, int digits, const char *expected)
{
    struct mcr_text text = {0};
    mcr_text_digits(&text, x, digits);
    return text_is(&text, expected);
}

static void test_numbers(void)
{
    struct mcr_text text = {0};
    ok(digits_are(0, 3, "0") && digits_are(1, 3, "1.00") && digits_are(-0.00123456, 3, "-0.00123") && digits_are(999999.4, 6, "999999") &&
       digits_are(12345678, 3, "1.23e7") && digits_are(1.5e-9, 2, "1.5e-9") && digits_are(123456, 2, "120000") && digits_are(1234567, 3, "1.23e6") &&
       digits_are(0.9996, 3, "1.00"),
       "numbers have their significant digits");
    ok(digits_are(NAN, 3, "unknown") && digits_are(INFINITY, 3, "infinite") && digits_are(-INFINITY, 3, "-infinite") &&
       digits_are(5e-324, 3, "4.94e-324"),
       "special ones are words");
    mcr_text_digits_html(&text, -1.25e-7, 3);
    ok(text_is(&text, "\u22121.25\u00b710<sup>\u22127</sup>"), "HTML has a raised exponent");
    mcr_text_short(&text, 0.2500, 7);
    mcr_text_put(&text, " ");
    mcr_text_short(&text, 1000, 7);
    ok(text_is(&text, "0.25 1000"), "short ones have no zeros at the end");
    const double fixed[] = {-0.004, 12.345678, -3.5, 7.05, NAN, 1e300};
    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++) {
        mcr_text_fixed(&text, fixed[i]);
        mcr_text_put(&text, " ");
    }
    ok(text_is(&text, "0 12.35 -3.5 7.05 0 0 "), "coordinates have two decimals at most");
}

static void test_locale(void)
{
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "fr_FR.utf8", "nl_NL.UTF-8", "da_DK.UTF-8"};
    const char *found = NULL;
    for (size_t i = 0; i < sizeof names / sizeof *names && !found; i++)
        found = setlocale(LC_NUMERIC, names[i]);
    if (!found) {
        tap_skip("a locale with a decimal comma changes nothing", "no such locale is installed");
        return;
    }
    ok(digits_are(1234.5, 5, "1234.5") && digits_are(1.5e-9, 2, "1.5e-9"), "a locale with a decimal comma changes nothing");
    setlocale(LC_NUMERIC, "C");
}

static void test_escapes(void)
{
    struct mcr_text text = {0};
    mcr_text_html(&text, "<a href=\"x\">&'\tf(x)");
    ok(text_is(&text, "&lt;a href=&quot;x&quot;&gt;&amp;&#39;\tf(x)"), "what means something in HTML is escaped");
    mcr_text_html(&text, "a\x01" "b\xff" "c\xef\xbf\xbf" "d\xc3\xa9\xe2\x82");
    ok(text_is(&text, "a\ufffd" "b\ufffd" "c\ufffd" "d\u00e9\ufffd\ufffd"), "what is no character of XML is replaced");
    mcr_text_html_breaks(&text, "f(g(1))");
    ok(text_is(&text, "f(<wbr/>g(<wbr/>1))"), "lines may be broken behind a bracket");
}

static void test_base64(void)
{
    static const char *const plain[] = {"", "f", "fo", "foo", "foob", "fooba", "foobar"};
    static const char *const coded[] = {"!", "Zg==!", "Zm8=!", "Zm9v!", "Zm9vYg==!", "Zm9vYmE=!", "Zm9vYmFy!"};
    int right = 1;
    for (size_t i = 0; i < 7; i++) {
        struct mcr_text text = {0};
        mcr_text_base64(&text, (const unsigned char *)plain[i], strlen(plain[i]));
        mcr_text_put(&text, "!");
        right &= text_is(&text, coded[i]);
    }
    ok(right, "base64: the vectors of RFC 4648");
}

static void test_limit(void)
{
    struct mcr_text text = {0};
    static char megabyte[1 << 20];
    for (int i = 0; i < 300; i++)
        mcr_text_bytes(&text, megabyte, sizeof megabyte);
    ok(text.failed && text.used < MCR_TEXT_MAX && text.used + sizeof megabyte >= MCR_TEXT_MAX, "a text ends at its limit and remembers that");
    mcr_text_fini(&text);
}

/* ---- PNG ------------------------------------------------------------------------------------------------------------------------- */

/* Kinds of content: noise, flat, a noisy ramp, flat with dots, rows and columns that add up (where Paeth's filter is the best), and values
 * of which each is half as frequent as the one before (which make Huffman's tree as deep as can be). */
#define KINDS 6u
static void content(uint8_t *rgb, uint32_t width, uint32_t height, uint32_t kind)
{
    size_t count = 3 * (size_t)width * height;
    uint64_t state = kind + 1;
    for (size_t i = 0; i < count; i++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        uint32_t x = (uint32_t)(i / 3 % width), y = (uint32_t)(i / 3 / width), random = (uint32_t)(state >> 40);
        switch (kind) {
        case 0: rgb[i] = (uint8_t)random; break;
        case 1: rgb[i] = 200; break;
        case 2: rgb[i] = (uint8_t)(x + random % 8); break;
        case 3: rgb[i] = random % 256 ? 7 : (uint8_t)i; break;
        case 4: rgb[i] = (uint8_t)(x * 11 % 97 + y * 7 % 89 + random % 2); break;
        default: rgb[i] = (uint8_t)__builtin_ctz(random | 1u << 23); break;
        }
    }
}

/* The picture that a decoder of someone else's makes of it is the same. */
static int survives(uint32_t width, uint32_t height, uint32_t kind)
{
    size_t pixels = (size_t)width * height, length = 0;
    uint8_t *rgb = malloc(3 * pixels);
    char error[300] = "";
    content(rgb, width, height, kind);
    unsigned char *png = mcr_png_encode(rgb, width, height, &length);
    struct mcr_image *image = png ? mcr_image_decode(png, length, error, sizeof error) : NULL;
    int same = image && image->width == width && image->height == height && image->channels == 3;
    for (size_t i = 0; same && i < 3 * pixels; i++)
        same = mcr_srgb_quantise(image->data[i], 255) == rgb[i];
    if (!same)
        printf("# %ux%u, kind %u: %s\n", width, height, kind, error);
    mcr_image_destroy(image);
    free(png);
    free(rgb);
    return same;
}

static void test_png(void)
{
    static const uint32_t size[][2] = {{1, 1}, {1, 300}, {257, 1}, {64, 48}, {200, 200}};
    char error[300];
    uint8_t rgb[3] = {1, 2, 3};
    size_t length;
    ok(!mcr_png_encode(rgb, 0, 1, &length) && !mcr_png_encode(rgb, 1, MCR_PNG_MAX_SIDE + 1, &length), "PNG: sides out of range are refused");
    if (!mcr_image_module(error, sizeof error)) {
        tap_skip("PNG: every pixel comes back", "no OpenImageIO to decode it");
        return;
    }
    int right = 1;
    for (size_t i = 0; i < sizeof size / sizeof *size; i++)
        for (uint32_t kind = 0; kind < KINDS; kind++)
            right &= survives(size[i][0], size[i][1], kind);
    right &= survives(900, 600, 5);
    ok(right, "PNG: every pixel comes back, of all kinds of content");
}

static void test_png_size(void)
{
    enum { SIDE = 200 };
    uint8_t *rgb = malloc(3 * SIDE * SIDE);
    size_t noise = 0, flat = 0, ramp = 0;
    content(rgb, SIDE, SIDE, 0);
    free(mcr_png_encode(rgb, SIDE, SIDE, &noise));
    content(rgb, SIDE, SIDE, 1);
    free(mcr_png_encode(rgb, SIDE, SIDE, &flat));
    content(rgb, SIDE, SIDE, 2);
    free(mcr_png_encode(rgb, SIDE, SIDE, &ramp));
    ok(noise < 3 * SIDE * SIDE * 1.01 + 300 && flat < 1500 && ramp < 3 * SIDE * SIDE / 2,
       "PNG: noise hardly grows (%zu), what is flat vanishes (%zu), a ramp halves (%zu)",
       noise, flat, ramp);
    free(rgb);
}

/* ---- axes ------------------------------------------------------------------------------------------------------------------------ */

static struct mcr_axis axis_of(double least, double greatest, uint32_t wanted)
{
    struct mcr_axis axis;
    mcr_axis_init(&axis);
    mcr_axis_add(&axis, least);
    mcr_axis_add(&axis, greatest);
    mcr_axis_finish(&axis, wanted);
    return axis;
}

/* Ticks rise, lie within, are 2 to 13 and have labels that differ. */
static int sensible(double least, double greatest)
{
    struct mcr_axis axis = axis_of(least, greatest, 7);
    char last[200] = "";
    int good = axis.ticks >= 2 && axis.ticks <= 13 && axis.low < least * (1 + 1e-9) && axis.high > greatest * (1 - 1e-9);
    for (uint32_t i = 0; i < axis.ticks; i++) {
        struct mcr_text label = {0};
        double place = mcr_axis_place(&axis, axis.tick[i]);
        mcr_axis_label(&axis, axis.tick[i], &label);
        good &= place > -1e-6 && place < 1 + 1e-6 && (!i || axis.tick[i] > axis.tick[i - 1]) && strcmp(last, label.bytes);
        snprintf(last, sizeof last, "%s", label.bytes);
        mcr_text_fini(&label);
    }
    if (!good)
        printf("# %g to %g: %u ticks, last %s\n", least, greatest, axis.ticks, last);
    return good;
}

static void test_axes(void)
{
    int right = 1;
    for (double least = 1e-12; least < 1e9; least *= 3.7)
        for (double ratio = 1; ratio < 1e18; ratio = ratio < 1.02 ? 1.03 : ratio * 1.5)
            right &= sensible(least, least * ratio);
    ok(right, "ticks are sensible for any range");
    struct mcr_axis axis = axis_of(3e-5, 0.4, 7);
    ok(axis.ticks == 4 && axis.powers && fabs(axis.tick[0] - 1e-4) < 1e-15, "decades: 1e-4 to 0.1");
    axis = axis_of(NAN, -3, 7);
    ok(axis.low > 0 && axis.ticks && isnan(mcr_axis_place(&axis, 0)) && isnan(mcr_axis_place(&axis, NAN)), "no values: still an axis");
    const double spp[] = {1, 1.1, 100, 1000, 1001};
    axis = axis_of(1, 1001, 7);
    mcr_axis_set_ticks(&axis, spp, 5, 0.1);
    ok(axis.ticks == 3 && axis.tick[0] == 1 && axis.tick[1] == 100 && axis.tick[2] == 1000, "given ticks that are too near are left out");
    mcr_axis_init(&axis);
    mcr_axis_add(&axis, 1);
    mcr_axis_add_end(&axis, 1, 1e9);
    mcr_axis_add_end(&axis, 1, -1);
    ok(axis.greatest == 4 && axis.least == 0.25, "an interval's far end does not stretch the axis");
}

/* ---- plots ----------------------------------------------------------------------------------------------------------------------- */

static uint32_t occurrences(const char *text, const char *what)
{
    uint32_t count = 0;
    for (const char *at = text; (at = strstr(at, what)); at += strlen(what))
        count++;
    return count;
}

static void test_plot(void)
{
    struct mcr_plot_point first[] = {{{1, NAN, NAN}, {.5, .4, .6}, 0, 1}, {{100, NAN, NAN}, {.005, -1, .006}, 0, 1},
                                     {{NAN, 0, 0}, {1, 1, 1}, 0, 0}};
    struct mcr_plot_point second[] = {{{2, 1, 3}, {.7, NAN, NAN}, 1, 0}, {{50, 1, 3}, {0, 0, 0}, 0, 0}};
    const struct mcr_plot_series series[] = {{"a<b", 0, 3, first}, {"other", 9, 2, second}, {"none", 31, 0, NULL}};
    const struct mcr_plot_level level[] = {{.01, "target"}, {NAN, "nothing"}};
    struct mcr_plot plot = {.id = "p", .title = "T&T", .x_label = "time (s)", .y_label = "MSE", .x_unit = "s", .series_count = 3,
                            .level_count = 2, .series = series,
                            .level = level, .has_front = 1};
    struct mcr_text text = {0};
    mcr_plot_write(&text, &plot);
    ok(!text.failed && strstr(text.bytes, "<title id=\"p-title\">T&amp;T</title>") &&
       strstr(text.bytes, "a&lt;b: 1 s: 0.500 [0.400, 0.600] (on the front); 100 s: 0.00500") &&
       strstr(text.bytes, "other: 2 s: 0.700 (not ranked). none: no value. target: 0.0100. "),
       "a plot tells its numbers");
    ok(occurrences(text.bytes, "class=\"dot\"") == 1 && occurrences(text.bytes, "class=\"dot hollow\"") == 1 &&
       occurrences(text.bytes, "class=\"front\"") == 1 &&
       occurrences(text.bytes, "class=\"level\"") == 1 && strstr(text.bytes, ">time (s)<") && strstr(text.bytes, ">MSE<") &&
       !strstr(text.bytes, "nan"),
       "and draws them");
    mcr_text_fini(&text);
    plot.series_count = 0;
    plot.level_count = 0;
    mcr_plot_write(&text, &plot);
    ok(!text.failed && strstr(text.bytes, "no values yet") && !strstr(text.bytes, "nan"), "a plot of nothing says so");
    mcr_text_fini(&text);
}

/* ---- parts of pictures ----------------------------------------------------------------------------------------------------------- */

static void test_window(void)
{
    static const char *const names[] = {"variance.R", "B", "G", "R"};
    struct mcr_image *reference = mcr_image_create(64, 48, 4, names), *image = mcr_image_create(64, 48, 4, names);
    struct mcr_error_field field = {0};
    uint32_t window[4], channel[3], whole[4] = {0, 0, 64, 48}, part[4] = {0, 0, 30, 30};
    ok(!mcr_error_field_init(&field, reference), "a field of errors");
    mcr_error_field_window(&field, whole, 16, window);
    ok(window[0] == 24 && window[1] == 16 && window[2] == 40 && window[3] == 32, "without errors the centre is shown");
    for (uint32_t y = 4; y < 12; y++)
        for (uint32_t x = 40; x < 48; x++)
            image->data[4 * (y * 64 + x) + 2] = 1;
    image->data[0] = 1e30;  /* of another layer: takes no part */
    image->data[3] = 1e30;  /* a dot counts no more than any other pixel */
    mcr_error_field_add(&field, image, reference);
    mcr_error_field_window(&field, whole, 16, window);
    ok(window[0] <= 40 && window[2] >= 48 && window[1] <= 4 && window[3] >= 12 && window[2] - window[0] == 16,
       "else where the images are farthest from the reference");
    mcr_error_field_window(&field, part, 16, window);
    ok(window[2] <= 30 && window[3] <= 30, "within the region");
    mcr_picture_channels(image, channel);
    ok(channel[0] == 3 && channel[1] == 2 && channel[2] == 1, "colours are found by name");
    mcr_error_field_fini(&field);
    mcr_image_destroy(reference);
    mcr_image_destroy(image);
}

int main(void)
{
    test_numbers();
    test_locale();
    test_escapes();
    test_base64();
    test_limit();
    test_png();
    test_png_size();
    test_axes();
    test_plot();
    test_window();
    return tap_done();
}
