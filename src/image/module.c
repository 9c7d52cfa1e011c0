/* SPDX-License-Identifier: Apache-2.0 */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* secure_getenv */
#endif
#include "image/module.h"

#include "base/elf.h"
#include "image/fail.h"
#include "image/read.h"
#include "image/srgb.h"
#include "image/oiio.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#ifndef MCR_MODULE_DIR
#define MCR_MODULE_DIR "/usr/local/lib/mcrender-1/modules"
#endif

/* The state of loading: asked once, the answer kept. */
static struct {
    int asked;
    const struct mcr_oiio *table;
    char path[PATH_MAX]; /* once it is loaded */
    char error[300];
} module;

/* Finds oiio.so in a colon-separated list of folders. Empty elements are passed over: they would mean the current folder. */
static int find(const char *folders, char path[PATH_MAX])
{
    static const char name[] = "/oiio.so";
    for (const char *at = folders; *at; at += strcspn(at, ":"), at += *at == ':') {
        size_t count = strcspn(at, ":");
        if (count == 0 || count + sizeof name > PATH_MAX) continue;
        memcpy(path, at, count);
        memcpy(path + count, name, sizeof name);
        if (!access(path, F_OK)) return 0;
    }
    return -1;
}

static void load(void)
{
    char path[PATH_MAX];
    const char *asked = secure_getenv("MCRENDER_MODULE_PATH");
    const char *folders = asked && *asked ? asked : MCR_MODULE_DIR;
    if (find(folders, path)) {
        mcr_image_fail(module.error, sizeof module.error, "no oiio.so in %.150s%s", folders, asked && *asked ? " (MCRENDER_MODULE_PATH)" : "");
        return;
    }
    if (mcr_elf_is_cut_off(path)) {
        mcr_image_fail(module.error, sizeof module.error, "'%.200s' is cut off", path);
        return;
    }
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const struct mcr_oiio *table = handle ? dlsym(handle, MCR_OIIO_SYMBOL) : NULL;
    if (!handle) {
        mcr_image_fail(module.error, sizeof module.error, "cannot load it: %.250s", dlerror());
    } else if (!table) {
        mcr_image_fail(module.error, sizeof module.error, "'%.150s' is not a module of mcrender: it lacks %s", path, MCR_OIIO_SYMBOL);
    } else if (table->size < sizeof *table || table->version != MCR_OIIO_VERSION || strcmp(table->kind, MCR_OIIO_KIND)) {
        mcr_image_fail(module.error, sizeof module.error, "'%.150s' belongs to another version of mcrender", path);
    } else {
        module.table = table;
        memcpy(module.path, path, sizeof path);
    }
}

const char *mcr_image_module_path(void)
{
    return module.table ? module.path : NULL;
}

static const struct mcr_oiio *table_of(char *error, size_t length)
{
    if (!module.asked) load();
    module.asked = 1;
    if (!module.table) mcr_image_fail(error, length, "%s", module.error);
    return module.table;
}

int mcr_image_module(char *error, size_t length)
{
    return table_of(error, length) != NULL;
}

int mcr_module_check(const char *format, char *error, size_t length)
{
    const struct mcr_oiio *table = table_of(error, length);
    return table ? table->check(format, error, length) : -1;
}

/* ---- Writing --------------------------------------------------------------------------------------------------- */

struct writing {
    struct mcr_encoder *encoder;
    struct mcr_sink *sink;
};

static void give_row(void *context, uint32_t y, void *row)
{
    struct writing *writing = context;
    mcr_encode_row(writing->encoder, y, row);
}

static int32_t take_bytes(void *context, const void *bytes, uint64_t count)
{
    struct writing *writing = context;
    return mcr_sink_put(writing->sink, bytes, (size_t)count);
}

/* The time that a file carries: SOURCE_DATE_EPOCH for reproducible files, else now; in UTC. */
static void date_text(char date[64])
{
    const char *epoch = getenv("SOURCE_DATE_EPOCH");
    char *end = NULL;
    long long seconds = epoch && *epoch ? strtoll(epoch, &end, 10) : 0;
    time_t at = end && !*end && seconds >= 0 && seconds < 253402300800 ? (time_t)seconds : time(NULL); /* below the year 10000 */
    struct tm parts;
    if (!gmtime_r(&at, &parts) || !strftime(date, 64, "%Y:%m:%d %H:%M:%S", &parts)) strcpy(date, "1970:01:01 00:00:00");
}

/* Names for channels that have none. */
static const char *const *channel_names(const struct mcr_encoder *encoder)
{
    static const char *const grey[] = {"Y", "A"}, *const colour[] = {"R", "G", "B", "A"};
    if (encoder->all && encoder->image->name) return encoder->image->name;
    if (encoder->channels > 4) return NULL;
    return encoder->channels < 3 ? grey : colour;
}

int mcr_module_write(const struct mcr_format *format, struct mcr_encoder *encoder, const struct mcr_write_options *options,
                     struct mcr_sink *sink, char *error, size_t length)
{
    static const uint32_t types[] = {[MCR_ENCODE_U8] = MCR_OIIO_U8, [MCR_ENCODE_U16] = MCR_OIIO_U16,
                                     [MCR_ENCODE_FLOAT] = MCR_OIIO_FLOAT, [MCR_ENCODE_RGBE] = MCR_OIIO_FLOAT};
    const struct mcr_oiio *table = table_of(error, length);
    const char *const *names = channel_names(encoder);
    if (!table) return -1;
    if (!names) return mcr_image_fail(error, length, "its %u channels have no names", encoder->channels);
    struct mcr_oiio_attribute *attributes = calloc(options->attribute_count + 1, sizeof *attributes);
    if (!attributes) return mcr_image_fail(error, length, "not enough memory");
    for (uint32_t i = 0; i < options->attribute_count; i++) {
        attributes[i].name = options->attribute[i].name;
        attributes[i].text = options->attribute[i].text;
    }
    char date[64];
    date_text(date);
    struct writing writing = {encoder, sink};
    struct mcr_oiio_output output = {
        .size = sizeof output, .width = encoder->image->width, .height = encoder->image->height, .channels = encoder->channels,
        .type = types[encoder->encoding], .attribute_count = options->attribute_count, .attribute = attributes,
        .format = format->module, .channel = names, .date = date, .context = &writing, .row = give_row, .put = take_bytes,
    };
    int status = table->write(&output, error, length);
    free(attributes);
    return status;
}

/* ---- Reading --------------------------------------------------------------------------------------------------- */

struct reading {
    struct mcr_image *image;
    struct mcr_oiio_header header;
};

static void *begin(void *context, const struct mcr_oiio_header *header)
{
    struct reading *reading = context;
    reading->header = *header;
    reading->image = mcr_image_create_named(header->width, header->height, header->channels, header->channel);
    if (reading->image) reading->image->units = header->units;
    return reading->image ? reading->image->data : NULL;
}

/* Integers of 8 and 16 bits come back as the integers they were, so that a table of all their values decodes them. */
static double *decoding_table(uint32_t peak, const struct mcr_oiio_header *header)
{
    double *table = malloc((size_t)(peak + 1) * sizeof *table);
    for (uint32_t k = 0; table && k <= peak; k++) {
        double v = (double)k / peak;
        table[k] = header->transfer == MCR_OIIO_SRGB ? mcr_srgb_decode(v) : mcr_pow(v, header->gamma);
    }
    return table;
}

static int decode(struct reading *reading)
{
    const struct mcr_oiio_header *header = &reading->header;
    struct mcr_image *image = reading->image;
    if (header->transfer == MCR_OIIO_LINEAR) return 0;
    uint32_t peak = header->bits <= 8 ? 255 : 65535; /* 32-bit integers lose what is below 2^-16 */
    double *table = decoding_table(peak, header);
    if (!table) return -1;
    size_t count = (size_t)image->width * image->height;
    for (uint32_t c = 0; c < image->channels; c++) {
        if ((int32_t)c == header->alpha || (int32_t)c == header->depth) continue;
        for (size_t i = 0; i < count; i++) {
            double *v = &image->data[i * image->channels + c];
            *v = table[*v > 0 ? *v < 1 ? (uint32_t)(*v * peak + 0.5) : peak : 0];
        }
    }
    free(table);
    return 0;
}

struct mcr_image *mcr_module_read(const char *format, const unsigned char *bytes, size_t count, char *error, size_t length)
{
    const struct mcr_oiio *table = table_of(error, length);
    struct reading reading = {0};
    if (!table) return NULL;
    struct mcr_oiio_input input = {
        .size = sizeof input, .max_side = MCR_IMAGE_MAX_SIDE, .max_channels = MCR_IMAGE_MAX_CHANNELS,
        .max_bytes = MCR_IMAGE_MAX_BYTES, .format = format, .bytes = bytes, .count = count,
        .context = &reading, .begin = begin,
    };
    if (!table->read(&input, error, length)) {
        if (!decode(&reading)) return reading.image;
        mcr_image_fail(error, length, "not enough memory");
    }
    mcr_image_destroy(reading.image);
    return NULL;
}

static void *begin_pixels(void *context, const struct mcr_oiio_header *header)
{
    static const uint32_t peak[] = {[MCR_OIIO_U8] = 255, [MCR_OIIO_U16] = 65535, [MCR_OIIO_FLOAT] = 0};
    struct mcr_pixels **pixels = context, *made = mcr_pixels_create(header->width, header->height, header->channels, peak[header->type]);
    *pixels = made;
    if (!made) return NULL;
    made->transfer = header->transfer;
    made->gamma = header->gamma;
    mcr_pixels_name(made, header->channel, header->alpha);
    return made->memory;
}

struct mcr_pixels *mcr_module_pixels(const char *format, const unsigned char *bytes, size_t count, int data, char *error, size_t length)
{
    const struct mcr_oiio *table = table_of(error, length);
    struct mcr_pixels *pixels = NULL;
    if (!table) return NULL;
    struct mcr_oiio_input input = {
        .size = sizeof input, .max_side = MCR_IMAGE_MAX_SIDE, .max_channels = MCR_IMAGE_MAX_CHANNELS, .raw = data ? MCR_OIIO_DATA : MCR_OIIO_RAW,
        .max_bytes = MCR_IMAGE_MAX_BYTES, .format = format, .bytes = bytes, .count = count, .context = &pixels, .begin = begin_pixels,
    };
    if (!table->read(&input, error, length)) return pixels;
    mcr_pixels_destroy(pixels);
    return NULL;
}
