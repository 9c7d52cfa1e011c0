/* SPDX-License-Identifier: Apache-2.0 */
/* The images of a study: names, metadata, files. */
#include <stdio.h>
#include <string.h>

#include "study/text.h"
#include "study/work.h"

#define SLUG_LENGTH 60 /* bytes of a name that are for people; the key makes it unique */

/* Letters, digits and single '-': safe on every file system and in a URL. */
static void slug(const char *text, char to[SLUG_LENGTH + 1])
{
    size_t used = 0;
    for (; *text && used < SLUG_LENGTH; text++) {
        char c = *text >= 'A' && *text <= 'Z' ? (char)(*text + 32) : *text;
        if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
            to[used++] = c;
        else if (used && to[used - 1] != '-')
            to[used++] = '-';
    }
    while (used && to[used - 1] == '-')
        used--;
    to[used] = '\0';
}

const char *mcr_study_image_name(struct mcr_study_work *work, const char *label, uint32_t spp, uint32_t depth, uint64_t key)
{
    char name[SLUG_LENGTH + 1], whole[SLUG_LENGTH + 100], reason[256];
    slug(label, name);
    int length = snprintf(whole, sizeof whole, "images/%s-spp%u-depth%u-%08lx.%s", name, spp, depth, (unsigned long)(key >> 32),
                          mcr_image_module(reason, sizeof reason) ? "exr" : "pfm");
    return mcr_arena_text(work->arena, whole, (size_t)length);
}

#define ATTRIBUTES 8u

int mcr_study_image_write(struct mcr_study_work *work, const char *name, const struct mcr_image *image, const struct mcr_shot_settings *settings,
                          char *error, size_t length)
{
    char hash[20], spp[16], depth[16], seed[24], compat[MCR_COMPAT_TEXT];
    struct mcr_attribute attribute[ATTRIBUTES] = {
        {"mcrender:version", PACKAGE_VERSION}, {"mcrender:scene", hash}, {"mcrender:sampler", settings->sampler}, {"mcrender:spp", spp},
        {"mcrender:depth", depth},             {"mcrender:seed", seed},  {"mcrender:compat", compat},             {"mcrender:estimate", "biased"},
    };
    struct mcr_write_options options = {.attribute_count = settings->compat ? ATTRIBUTES : ATTRIBUTES - 2, .attribute = attribute};
    struct mcr_write_result result;
    struct mcr_text path = {0};
    struct mcr_target *target;
    int status = -1;
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)work->study.scene_hash);
    snprintf(spp, sizeof spp, "%u", settings->spp);
    snprintf(depth, sizeof depth, "%u", settings->depth);
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)settings->seed);
    mcr_compat_text(settings->compat, compat);
    mcr_text_printf(&path, "%s/%s", work->folder, name);
    if (path.failed) {
        snprintf(error, length, "out of memory");
    } else if ((target = mcr_target_open(path.bytes, error, length))) {
        status = mcr_target_write(target, image, &options, &result);
        if (status)
            snprintf(error, length, "%s", result.error);
    }
    mcr_text_fini(&path);
    return status;
}
