/* SPDX-License-Identifier: Apache-2.0 */
/* PPM and PFM: golden bytes, round trips, every variant that is read, and files that lie. */
#include "help.h"
#include "image/read.h"
#include "image/srgb.h"

#include <math.h>

static char error[512];

static struct mcr_image *decode(const char *bytes, size_t count)
{
    error[0] = '\0';
    return mcr_image_decode((const unsigned char *)bytes, count, error, sizeof error);
}

/* Golden files: a gradient of known codes, 3 x 2. */
static void golden(void)
{
    static const double values[] = {0, 0.5, 1, 0.0031308, 0.18, 2, -1, 0.01, 0.25, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const unsigned char eight[] = "P6\n3 2\n255\n\x00\xbc\xff\x0a\x76\xff\x00\x19\x89\xff\x00\x00\x00\xff\x00\x00\x00\xff";
    static const unsigned char sixteen[] = "P6\n3 2\n65535\n\x00\x00\xbc\x40\xff\xff\x0a\x5b\x76\x1b\xff\xff\x00\x00\x19\x90\x89\x7f"
                                           "\xff\xff\x00\x00\x00\x00\x00\x00\xff\xff\x00\x00\x00\x00\x00\x00\xff\xff";
    static const unsigned char pfm[] = "PF\n1 2\n-1.0\n"
        "\x00\x00\x80\xbf\x00\x00\x00\x3f\x00\x00\x40\x40\x00\x00\x80\x3f\x00\x00\x00\x40\x00\x00\x00\x00";
    static const double two[] = {1, 2, 0, -1, 0.5, 3};
    struct mcr_write_result result;
    struct mcr_image *image = image_of(3, 2, 3, rgb, values);
    ok(!put(in_folder("a.ppm"), image, 0, 0, &result) && file_is(in_folder("a.ppm"), eight, sizeof eight - 1), "PPM of 8 bits, byte by byte");
    ok(result.overflowed == 2 && result.not_finite == 0, "two values out of its range were counted");
    ok(!put(in_folder("plain"), image, 8, 0, &result) && file_is(in_folder("plain"), eight, sizeof eight - 1), "no extension means PPM");
    ok(!put(in_folder("A.PPM"), image, 16, 0, &result) && file_is(in_folder("A.PPM"), sixteen, sizeof sixteen - 1), "PPM of 16 bits, big-endian");
    mcr_image_destroy(image);
    image = image_of(1, 2, 3, rgb, two);
    ok(!put(in_folder("a.pfm"), image, 0, 4, &result) && file_is(in_folder("a.pfm"), pfm, sizeof pfm - 1),
       "PFM: little-endian, bottom row first, no exposure");
    mcr_image_destroy(image);
    image = image_of(1, 1, 1, NULL, values + 1);
    ok(!put(in_folder("grey.ppm"), image, 0, 0, &result) && file_is(in_folder("grey.ppm"), "P6\n1 1\n255\n\xbc\xbc\xbc", 14),
       "one channel is grey in PPM");
    ok(!put(in_folder("grey.pfm"), image, 0, 0, &result) && file_is(in_folder("grey.pfm"), "Pf\n1 1\n-1.0\n\0\0\0?", 16), "and Pf in PFM");
    mcr_image_destroy(image);
}

static void round_trips(void)
{
    static const double floats[] = {0x1p-100, -2.5, 0x1.fffffep127, 0x1p-149, 0.1f, INFINITY, NAN, 0, 1, 2, 3, 4};
    struct mcr_write_result result;
    struct mcr_image *image = image_of(2, 2, 3, rgb, floats), *back;
    put(in_folder("r.pfm"), image, 0, 0, &result);
    back = mcr_image_read(in_folder("r.pfm"), error, sizeof error);
    int same = back && back->width == 2 && back->height == 2 && back->channels == 3 && !strcmp(back->name[2], "B");
    for (int i = 0; same && i < 12; i++) same &= back->data[i] == floats[i] || (isnan(back->data[i]) && isnan(floats[i]));
    ok(same && result.not_finite == 2, "PFM comes back bit by bit, NaN and infinity too");
    mcr_image_destroy(back);
    mcr_image_destroy(image);

    image = mcr_image_create(256, 256, 1, NULL);
    for (int i = 0; i < 65536; i++) image->data[i] = mcr_srgb_decode(i / 65535.0);
    put(in_folder("r.ppm"), image, 16, 0, &result);
    back = mcr_image_read(in_folder("r.ppm"), error, sizeof error);
    same = back && back->channels == 3;
    for (int i = 0; same && i < 65536; i++) same &= back->data[3 * i] == image->data[i] && back->data[3 * i + 2] == image->data[i];
    ok(same, "65536 codes of PPM come back bit by bit");
    mcr_image_destroy(back);
    mcr_image_destroy(image);
}

static void good(const char *what, const char *bytes, size_t count, uint32_t channels, double first, double last)
{
    struct mcr_image *image = decode(bytes, count);
    ok(image && image->width == 2 && image->height == 1 && image->channels == channels && image->data[0] == first &&
           image->data[2 * channels - 1] == last, "read: %s (%s)", what, error);
    mcr_image_destroy(image);
}
#define GOOD(what, bytes, channels, first, last) good(what, bytes, sizeof bytes - 1, channels, first, last)

static void variants(void)
{
    double half = mcr_srgb_decode(0.5);
    GOOD("P6", "P6 2 1 255\n\xff\0\0\0\0\0", 3, 1, 0);
    GOOD("P6 with comments", "P6#one\n# two\n2 #three\n1\n#\n#x\n255\n\xff\0\0\0\0\xff", 3, 1, 1);
    GOOD("P6, maximum 2", "P6 2 1 2\n\1\0\0\0\0\2", 3, half, 1);
    GOOD("P6, 16 bits", "P6 2 1 256 \1\0\0\0\0\0\0\0\0\0\0\x80", 3, 1, half);
    GOOD("P5", "P5 2 1 255\n\xff\0", 1, 1, 0);
    GOOD("P3", "P3\r\n2 1\r\n10\r\n10 0 0 #x\n0 0\t5", 3, 1, half);
    GOOD("P2", "P2 2 1 1 1 0", 1, 1, 0);
    GOOD("what follows the pixels", "P5 2 1 255\n\xff\0 and more", 1, 1, 0);
    GOOD("Pf, big-endian", "Pf\n2 1\n1.0\n\x3f\x80\0\0\xc0\0\0\0", 1, 1, -2);
    GOOD("Pf, little-endian, scale 2", "Pf 2 1 -2\n\0\0\x80\x3f\0\0\0\xc0", 1, 2, -4);
    GOOD("Pf with exponent", "Pf 2 1 -1e0\n\0\0\x80\x3f\0\0\0\xc0", 1, 1, -2);
}

static void bad(const char *expected, const char *bytes, size_t count)
{
    struct mcr_image *image = decode(bytes, count);
    ok(!image && strstr(error, expected), "refused: %s (%s)", expected, error);
    mcr_image_destroy(image);
}
#define BAD(expected, bytes) bad(expected, bytes, sizeof bytes - 1)

static void lies(void)
{
    BAD("it is empty", "");
    BAD("no known image format", "GIF89a");
    BAD("no known image format", "P");
    BAD("no known image format", "P7\nWIDTH 1\n");
    BAD("at byte 2: expected white space", "P6");
    BAD("it ends at byte 3, where its width", "P6\n");
    BAD("at byte 3: expected a number for its width", "P6\n-5 5 255\n");
    BAD("at byte 3: its width is not from 1 to 65536", "P6\n65537 1 255\n");
    BAD("at byte 3: its width is not from 1 to 65536", "P6\n0 1 255\n");
    BAD("at byte 5: its height is not from 1 to 65536", "P6\n1 99999999999999999999999999 255\n");
    BAD("at byte 3: its width is not from 1 to 65536", "P6\n18446744073709551617 1 255\n");
    BAD("at byte 7: its maximum is not from 1 to 65535", "P6\n1 1 65536\n\0\0\0\0\0\0");
    BAD("at byte 7: its maximum is not from 1 to 65535", "P6\n1 1 0\n\0\0\0");
    BAD("at byte 7: its maximum is not from 1 to 65535", "P6\n1 1 00000000000\n\0\0\0");
    BAD("65536 x 65536 is too large", "P6\n65536 65536 255\n\0\0\0");
    BAD("it is cut off: 120000000 bytes of pixels at least, 3 there", "P6\n20000 2000 255\n\0\0\0");
    BAD("it is cut off: 12 bytes", "P6\n2 1 65535\n\0\0\0\0\0\0\0\0\0\0\0");
    BAD("white space", "P6\n1 1 255");
    BAD("white space", "P6\n1 1 255#\n\0\0\0");
    BAD("value 9 is over its maximum 8", "P6\n1 1 8\n\1\2\x09");
    BAD("at byte 13: its value is not from 0 to 255", "P3\n1 1 255\n1 256 0");
    BAD("expected a number for its value", "P3\n1 1 255\n1 2 x");
    BAD("it ends at byte 16, where its value", "P3\n1 1 255\n1 22 ");
    BAD("bitmaps", "P4\n8 1\n\xff");
    BAD("bitmaps", "P1\n1 1\n1");
    BAD("its scale is not a finite number other than 0", "PF\n1 1\nnan\n\0\0\0\0\0\0\0\0\0\0\0\0");
    BAD("at byte 7: its scale is not", "PF\n1 1\n0\n\0\0\0\0\0\0\0\0\0\0\0\0");
    BAD("at byte 7: its scale is not", "PF\n1 1\n1e999\n\0\0\0\0\0\0\0\0\0\0\0\0");
    BAD("at byte 7: its scale is not", "PF\n1 1\n-1.0x\n\0\0\0\0\0\0\0\0\0\0\0\0");
    BAD("at byte 7: its scale is not", "PF\n1 1\n");
    BAD("at byte 3: expected a number for its width", "PF\n-1 1\n-1.0\n");
    BAD("65536 x 65536 is too large", "Pf\n65536 65536\n-1.0\n\0\0\0\0");
    BAD("it is cut off: 12 bytes", "PF\n1 1\n-1.0\n\0\0\0\0\0\0\0\0\0\0\0");
}

static void files(void)
{
    ok(!mcr_image_read(in_folder("none.ppm"), error, sizeof error) && strstr(error, "none.ppm': No such file"), "a missing file: %s", error);
    ok(!mcr_image_read(folder, error, sizeof error) && strstr(error, "it is a folder"), "a folder: %s", error);
    spill(in_folder("short.ppm"), "P6 9 9 255\n", 11);
    ok(!mcr_image_read(in_folder("short.ppm"), error, sizeof error) && strstr(error, "short.ppm': it is cut off"), "a short file: %s", error);
    ok(!truncate(in_folder("short.ppm"), (off_t)5 << 30), "a sparse file of 5 GiB");
    ok(!mcr_image_read(in_folder("short.ppm"), error, sizeof error) && strstr(error, "larger than 1 GiB"), "is not read: %s", error);
}

/* Random damage to good files: any answer, but no crash, and a reason with each failure. */
static void fuzz(void)
{
    static const struct { const char *bytes; size_t count; } seeds[] = {
        {"P6 3 2 255\n0123456789abcdefgh", 29}, {"P3 2 1 10 1 2 3 4 5 6\n", 22}, {"P5\n# c\n4 1\n65535\n01234567", 25},
        {"PF\n1 2\n-1.0\n0123456789abcdefghijklmn", 36}, {"Pf\n2 2\n1.0\n0123456789abcdef", 27}};
    static const char interesting[] = "0123456789# \n-.ePFf\xff";
    uint64_t state = 20240607;
    int explained = 1, images = 0;
    for (int turn = 0; turn < 40000; turn++) {
        char bytes[48];
        size_t which = next_random(&state) % 5, count = seeds[which].count;
        memcpy(bytes, seeds[which].bytes, count);
        for (uint64_t hits = next_random(&state) % 4 + 1; hits > 0; hits--)
            bytes[2 + next_random(&state) % (count - 2)] = interesting[next_random(&state) % (sizeof interesting - 1)];
        if (next_random(&state) % 4 == 0) count = next_random(&state) % count;
        char *exact = malloc(count + !count); /* of its own size, for the address sanitizer */
        memcpy(exact, bytes, count);
        struct mcr_image *image = decode(exact, count);
        explained &= image || error[0];
        images += image != NULL;
        free(exact);
        mcr_image_destroy(image);
    }
    ok(explained && images > 1000, "40000 damaged files: %d were images, the others were refused with a reason", images);
}

int main(void)
{
    enter_folder();
    golden();
    round_trips();
    variants();
    lies();
    files();
    fuzz();
    leave_folder();
    return tap_done();
}
