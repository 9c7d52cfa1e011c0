/* SPDX-License-Identifier: Apache-2.0 */
#include "film/features.h"

#include <math.h>
#include <stdlib.h>

uint32_t mcr_features_bytes(uint32_t asked, int by_pixel)
{
    uint32_t triples = !!(asked & MCR_FEATURE_ALBEDO) + !!(asked & MCR_FEATURE_NORMAL) + (asked & MCR_FEATURE_DIRECT ? 2 : 0);
    /* the cells of a pass besides */
    return triples * 24 + (asked & MCR_FEATURE_DEPTH ? 16 : 0) + (asked & MCR_FEATURE_ID ? 12 : 0) + (asked && by_pixel ? 8 : 0) +
           (asked ? (uint32_t)sizeof(struct mcr_cell_features) : 0);
}

/* Whether what is asked for could be had. */
static int array(double **to, uint32_t asked, uint64_t count)
{
    *to = asked ? calloc(count, sizeof **to) : NULL;
    return !asked || *to;
}

struct mcr_features *mcr_features_create(uint64_t pixels, uint32_t asked, int by_pixel)
{
    struct mcr_features *f = calloc(1, sizeof *f);
    if (!f)
        return NULL;
    f->pixels = pixels;
    f->asked = asked;
    int there = array(&f->albedo, asked & MCR_FEATURE_ALBEDO, 3 * pixels) & array(&f->normal, asked & MCR_FEATURE_NORMAL, 3 * pixels) &
                array(&f->direct, asked & MCR_FEATURE_DIRECT, 3 * pixels) & array(&f->indirect, asked & MCR_FEATURE_DIRECT, 3 * pixels) &
                array(&f->depth, asked & MCR_FEATURE_DEPTH, pixels) &
                array(&f->hits, asked & MCR_FEATURE_DEPTH, pixels) & array(&f->distance, asked & MCR_FEATURE_ID, pixels) & array(&f->taken, by_pixel != 0, pixels);
    f->id = asked & MCR_FEATURE_ID ? calloc(pixels, sizeof *f->id) : NULL;
    if (!there || ((asked & MCR_FEATURE_ID) && !f->id)) {
        mcr_features_destroy(f);
        return NULL;
    }
    for (uint64_t p = 0; f->distance && p < pixels; p++)
        f->distance[p] = INFINITY;
    return f;
}

void mcr_features_destroy(struct mcr_features *f)
{
    if (!f)
        return;
    free(f->taken);
    free(f->albedo);
    free(f->normal);
    free(f->direct);
    free(f->indirect);
    free(f->depth);
    free(f->hits);
    free(f->distance);
    free(f->id);
    free(f);
}

static void add3(double *to, uint64_t p, const double from[3])
{
    for (int c = 0; to && c < 3; c++)
        to[3 * p + c] += from[c];
}

static void add(struct mcr_features *f, uint64_t p, const struct mcr_cell_features *cell)
{
    add3(f->albedo, p, cell->albedo);
    add3(f->normal, p, cell->normal);
    add3(f->direct, p, cell->direct);
    add3(f->indirect, p, cell->indirect);
    if (f->depth) {
        f->depth[p] += cell->depth;
        f->hits[p] += cell->hits;
    }
    if (f->id && cell->distance < f->distance[p]) {
        f->distance[p] = cell->distance;
        f->id[p] = cell->id;
    }
}

int mcr_features_add(void *features, const struct mcr_cell_features *cell, uint32_t count)
{
    struct mcr_features *f = features;
    for (uint64_t p = 0; p < f->pixels; p++)
        add(f, p, &cell[p]);
    f->samples += count;
    return 0;
}

void mcr_features_take(struct mcr_features *f, const struct mcr_task *task, const struct mcr_cell_features *cell)
{
    for (uint32_t e = 0; e < task->count; e++) {
        uint32_t p = task->entry[e].pixel;
        for (uint32_t b = 0; b < task->cells; b++)
            add(f, p, &cell[(uint64_t)b * task->count + e]);
        f->taken[p] += (double)task->cells * task->cell_samples;
    }
}

void mcr_features_value(const struct mcr_features *f, uint32_t layer, uint64_t p, double *out)
{
    const double samples = f->taken ? f->taken[p] : (double)f->samples;
    const double *triple = layer == MCR_FEATURE_ALBEDO   ? f->albedo
                           : layer == MCR_FEATURE_NORMAL ? f->normal
                           : layer == MCR_FEATURE_DIRECT ? f->direct
                                                         : f->indirect;
    if (layer == MCR_FEATURE_DEPTH)
        *out = f->hits[p] > 0 ? f->depth[p] / f->hits[p] : 0;
    else if (layer == MCR_FEATURE_ID)
        *out = f->id[p];
    else
        for (int c = 0; c < 3; c++)
            out[c] = samples > 0 ? triple[3 * p + c] / samples : 0;
}
