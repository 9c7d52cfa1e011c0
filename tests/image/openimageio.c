/* SPDX-License-Identifier: Apache-2.0 */
/* What goes through the OpenImageIO module: EXR, PNG, JPEG, TIFF, HDR; metadata, equal bytes, limits, files that lie. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* memmem */
#endif
#include "help.h"
#include "image/read.h"
#include "image/srgb.h"

#include <errno.h>
#include <math.h>
#include <sys/resource.h>
#include <signal.h>
#include <sys/wait.h>

static char error[512];
static struct mcr_write_result result;

static int same_bits(double a, double b)
{
    return a == b ? signbit(a) == signbit(b) : isnan(a) && isnan(b);
}

static const struct mcr_attribute attributes[] = {
    {"mcrender:seed", "18446744073709551615"}, {"mcrender:sampler", "stratified(mixture(cosine 1, light 1))"}, {"mcrender:spp", "100"}};

static int put_with_attributes(const char *path, const struct mcr_image *image)
{
    struct mcr_write_options options = {.attribute_count = 3, .attribute = attributes};
    struct mcr_target *target = mcr_target_open(path, result.error, sizeof result.error);
    return target ? mcr_target_write(target, image, &options, &result) : -1;
}

/* Every float comes back from EXR, under its channel's name. */
static void exr(void)
{
    static const char *const names[] = {"R", "G", "B", "albedo.R", "variance.G", "sampleCount.Y"};
    uint64_t state = 3;
    struct mcr_image *image = mcr_image_create(37, 150, 6, names), *back;
    for (int i = 0; i < 37 * 150 * 6; i++) {
        uint32_t bits = (uint32_t)next_random(&state);
        float value;
        memcpy(&value, &bits, sizeof value);
        image->data[i] = value; /* all kinds: tiny, huge, NaN, infinite */
    }
    image->data[0] = 1e300;
    ok(!put(in_folder("a.exr"), image, 16, 3, &result) && result.overflowed == 1 && result.not_finite > 50,
       "EXR of random bits: one value is clipped, some are not finite %s", result.error);
    image->data[0] = 0x1.fffffep127;
    back = mcr_image_read(in_folder("a.exr"), error, sizeof error);
    int same = back && back->width == 37 && back->height == 150 && back->channels == 6;
    for (uint32_t c = 0; same && c < 6; c++) {
        uint32_t k = 0;
        while (k < 6 && strcmp(back->name[k], names[c])) k++;
        for (int i = 0; same && (same = k < 6) && i < 37 * 150; i++) same = same_bits(back->data[i * 6 + k], image->data[i * 6 + c]);
    }
    ok(same, "comes back bit by bit, with all channels %s", back ? "" : error);
    ok(back && !strcmp(back->name[0], "R") && !strcmp(back->name[1], "G") && !strcmp(back->name[2], "B"), "R, G and B first");
    mcr_image_destroy(back);
    image->name = NULL;
    ok(put(in_folder("b.exr"), image, 0, 0, &result) == -1 && strstr(result.error, "6 channels have no names"), "%s", result.error);
    mcr_image_destroy(image);
}

static int holds(const unsigned char *bytes, size_t count, const char *text)
{
    return memmem(bytes, count, text, strlen(text)) != NULL;
}

static void metadata(void)
{
    static const float rec709[] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    static const double values[] = {1, 2, 3, 4, 5, 6};
    struct mcr_image *image = image_of(2, 1, 3, rgb, values);
    size_t count = 0;
    setenv("SOURCE_DATE_EPOCH", "981173106", 1);
    ok(!put_with_attributes(in_folder("meta.exr"), image), "EXR with attributes %s", result.error);
    unsigned char *bytes = slurp(in_folder("meta.exr"), &count);
    for (int i = 0; i < 3; i++)
        ok(holds(bytes, count, attributes[i].name) && holds(bytes, count, attributes[i].text), "%s is there as text", attributes[i].name);
    ok(holds(bytes, count, "chromaticities") && memmem(bytes, count, rec709, sizeof rec709), "chromaticities of Rec. 709");
    ok(holds(bytes, count, "lin_rec709"), "the colour space");
    ok(holds(bytes, count, "2001:02:03 04:05:06"), "the time of SOURCE_DATE_EPOCH, in UTC");
    ok(!holds(bytes, count, folder), "no path");
    free(bytes);
    static const char *const extensions[] = {"exr", "png", "tif", "hdr", "jpg"};
    for (int i = 0; i < 5; i++) {
        put_with_attributes(in_folder("one.%s", extensions[i]), image);
        put_with_attributes(in_folder("two.%s", extensions[i]), image);
        bytes = slurp(in_folder("one.%s", extensions[i]), &count);
        ok(bytes && count && file_is(in_folder("two.%s", extensions[i]), bytes, count), "the same input, the same %s", extensions[i]);
        free(bytes);
    }
    unsetenv("SOURCE_DATE_EPOCH");
    mcr_image_destroy(image);
}

/* All codes of an integer format, through our encoding and back. */
static void integers(const char *name, uint32_t bits)
{
    uint32_t peak = bits == 8 ? 255 : 65535, side = bits == 8 ? 16 : 256;
    struct mcr_image *image = mcr_image_create(side, side, 3, rgb), *back;
    for (uint32_t i = 0; i < side * side * 3; i++) image->data[i] = mcr_srgb_decode((double)(i / 3) / peak);
    ok(!put(in_folder("%s", name), image, bits, 0, &result) && result.overflowed == 0, "%s of %u bits %s", name, bits, result.error);
    back = mcr_image_read(in_folder("%s", name), error, sizeof error);
    ok(back && back->channels == 3 && !memcmp(back->data, image->data, side * side * 3 * sizeof(double)), "all %u codes come back %s",
       peak + 1, back ? "" : error);
    mcr_image_destroy(back);
    const double beyond[] = {0.5, 2, -1, NAN, 0.25, 1};
    memcpy(image->data, beyond, sizeof beyond);
    put(in_folder("%s", name), image, bits, 1, &result);
    back = mcr_image_read(in_folder("%s", name), error, sizeof error);
    ok(back && result.overflowed > 2 && result.not_finite == 1 && back->data[0] == 1 && back->data[1] == 1 && back->data[2] == 0 &&
       back->data[3] == 0 &&
           fabs(back->data[4] - 0.5) < 0.01, "exposure, clipping and counting");
    mcr_image_destroy(back);
    mcr_image_destroy(image);
}

static void others(void)
{
    static const double values[] = {0.5, -2, 1e30, 0.25, NAN, 3};
    struct mcr_image *image = image_of(2, 1, 3, rgb, values), *back;
    ok(!put(in_folder("f.tiff"), image, 0, 2, &result), "TIFF of floats %s", result.error);
    back = mcr_image_read(in_folder("f.tiff"), error, sizeof error);
    int same = back != NULL;
    for (int i = 0; same && i < 6; i++) same &= same_bits(back->data[i], (float)values[i]);
    ok(same, "comes back bit by bit");
    mcr_image_destroy(back);
    ok(!put(in_folder("f.HDR"), image, 0, 2, &result) && result.overflowed == 1 && result.not_finite == 1, "HDR %s", result.error);
    back = mcr_image_read(in_folder("f.HDR"), error, sizeof error);
    ok(back && back->data[3] == 0.25 && back->data[4] == 0 && back->data[5] == 3 && fabs(back->data[2] / 1e30 - 1) <= 1.0 / 256,
       "comes back within its 8 bits");
    mcr_image_destroy(back);
    mcr_image_destroy(image);
    image = mcr_image_create(16, 16, 3, rgb);
    for (int i = 0; i < 768; i++) image->data[i] = 0.5;
    ok(!put(in_folder("f.jpeg"), image, 0, 0, &result), "JPEG %s", result.error);
    back = mcr_image_read(in_folder("f.jpeg"), error, sizeof error);
    ok(back && fabs(back->data[100] - 0.5) < 0.01, "comes back nearly");
    mcr_image_destroy(back);
    mcr_image_destroy(image);
    image = mcr_image_create(1, 1, 1, NULL);
    image->data[0] = 1;
    ok(!put(in_folder("grey.png"), image, 0, 0, &result) && (back = mcr_image_read(in_folder("grey.png"), error, sizeof error)) &&
       back->channels == 1 &&
           back->data[0] == 1, "one channel is grey in PNG");
    mcr_image_destroy(back);
    mcr_image_destroy(image);
}

/* Devices and full disks are met by EXR as by PPM. */
static void full_disk(void)
{
    struct mcr_image *image = mcr_image_create(300, 300, 3, rgb);
    uint64_t state = 5;
    for (int i = 0; i < 270000; i++) image->data[i] = (double)next_random(&state); /* does not compress */
    if (symlink("/dev/full", in_folder("full.exr")) || symlink("/dev/null", in_folder("null.exr"))) perror("symlink");
    ok(put(in_folder("full.exr"), image, 0, 0, &result) == -1 && strstr(result.error, strerror(ENOSPC)), "%s", result.error);
    ok(!put(in_folder("null.exr"), image, 0, 0, &result), "an EXR to /dev/null %s", result.error);
    mkdir(in_folder("disk"), 0777);
    spill(in_folder("disk/old.exr"), "old", 3);
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        struct rlimit limit = {100000, 100000};
        setrlimit(RLIMIT_FSIZE, &limit);
        _exit(put(in_folder("disk/old.exr"), image, 0, 0, &result) == -1 && strstr(result.error, strerror(EFBIG)) ? 0 : 1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    ok(status == 0 && file_is(in_folder("disk/old.exr"), "old", 3) && entries(in_folder("disk")) == 1,
       "a limit of the file size: an error, and the old file");
    mcr_image_destroy(image);
}

/* OpenImageIO's PNG reader leaves by longjmp and loses its strings: no leak of ours, so the leak sanitizer does not look there. */
__attribute__((weak)) void __lsan_disable(void);
__attribute__((weak)) void __lsan_enable(void);

/* Damages one byte or cuts the file, many times: no crash, and a reason with each failure. */
static void fuzz(const char *name, int turns)
{
    size_t count = 0;
    unsigned char *good = slurp(in_folder("%s", name), &count), *bad = malloc(count);
    uint64_t state = 20240607;
    int explained = 1, refused = 0;
    if (__lsan_disable) __lsan_disable();
    for (int turn = 0; turn < turns && good && bad; turn++) {
        size_t left = count, span = turn % 2 ? count : count < 400 ? count : 400; /* half of the damage to the header */
        memcpy(bad, good, count);
        for (uint64_t hits = next_random(&state) % 3 + 1; hits > 0; hits--)
            bad[8 + next_random(&state) % (span - 8)] = (unsigned char)(next_random(&state) >> 9);
        if (turn % 5 == 0) left = 12 + next_random(&state) % (count - 12);
        error[0] = '\0';
        struct mcr_image *image = mcr_image_decode(bad, left, error, sizeof error);
        explained &= image || error[0];
        refused += !image;
        mcr_image_destroy(image);
    }
    if (__lsan_enable) __lsan_enable();
    ok(good && explained && refused > 0, "%s: %d damaged files, %d refused with a reason", name, turns, refused);
    free(good);
    free(bad);
}

static void put32(unsigned char *at, uint32_t value)
{
    for (int i = 0; i < 4; i++) at[i] = (unsigned char)(value >> (24 - 8 * i));
}

/* The check sum of PNG's chunks. */
static uint32_t crc32(const unsigned char *bytes, size_t count)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

/* The same pixels under other primaries are other colours. */
static void primaries(void)
{
    static const float red = 0.64f, aces = 0.7347f;
    size_t count = 0;
    unsigned char *bytes = slurp(in_folder("meta.exr"), &count);
    unsigned char *at = bytes ? memmem(bytes, count, "chromaticities", 14) : NULL, *x = at ? memmem(at, 60, &red, sizeof red) : NULL;
    if (x) memcpy(x, &aces, sizeof aces);
    struct mcr_image *image = x ? mcr_image_decode(bytes, count, error, sizeof error) : NULL;
    ok(x && !image && strstr(error, "are not those of Rec. 709"), "other primaries are refused: %s", error);
    mcr_image_destroy(image);
    free(bytes);
}

/* A small PNG whose header promises another size. */
static void png_of_size(uint32_t width, uint32_t height, const char *reason)
{
    size_t count = 0;
    unsigned char *bytes = slurp(in_folder("i.png"), &count);
    put32(bytes + 16, width);
    put32(bytes + 20, height);
    put32(bytes + 29, crc32(bytes + 12, 17));
    struct mcr_image *image = mcr_image_decode(bytes, count, error, sizeof error);
    ok(!image && strstr(error, reason), "a header that promises %u x %u pixels: %s", width, height, error);
    mcr_image_destroy(image);
    free(bytes);
}

int main(void)
{
    if (!mcr_image_module(error, sizeof error)) {
        printf("1..0 # SKIP no OpenImageIO: %s\n", error);
        return 0;
    }
    signal(SIGXFSZ, SIG_IGN);
    enter_folder();
    exr();
    metadata();
    integers("i.png", 8);
    integers("j.png", 16);
    integers("i.tif", 8);
    integers("j.tif", 16);
    others();
    full_disk();
    primaries();
    png_of_size(70000, 1, "70000 x 1 is not within");
    png_of_size(60000, 60000, "");
    png_of_size(8000, 6000, "too large: over 1 GiB of pixels");
    png_of_size(4000, 4000, "bytes cannot hold 4000 x 4000 pixels");
    png_of_size(20, 20, "");
    fuzz("meta.exr", 400);
    fuzz("i.png", 400);
    fuzz("i.tif", 400);
    fuzz("f.HDR", 400);
    fuzz("f.jpeg", 400);
    leave_folder();
    return tap_done();
}
