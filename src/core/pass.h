/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A pass: the next samples of every pixel, cut into cells, which threads take by jobs. Cell c belongs to pixel c % pixels of the crop and holds the
 * samples first + (c / pixels) * cell_samples on; with a director c % pixels is an entry of the pass's task instead (core.h). Private to src/core.
 */
#ifndef MCR_CORE_PASS_H
#define MCR_CORE_PASS_H

#include <stdatomic.h>

#include "core/batch.h"

struct mcr_pass {
    struct mcr_core *core;
    uint64_t pixels;
    uint64_t replicate_key;
    uint32_t planned;                 /* samples of this replicate */
    uint64_t first;                   /* the first sample's number within the replicate */
    uint32_t cell_samples;
    uint64_t cells;
    struct mcr_cell *cell;            /* results */
    struct mcr_cell_channels *channels; /* the same for the channels' moments; NULL: nobody asks for them */
    struct mcr_cell_features *features; /* the same for features; NULL: nobody asks for them */
    _Atomic uint64_t next;            /* the first cell that nobody took */
    _Atomic uint64_t done;            /* cells finished */
    _Atomic int failed;               /* an operation failed, or memory is short: everybody stops */
    char error[400];                  /* written by the one that set `failed` first */
    void (*tick)(void *data, const struct mcr_pass *pass); /* called by thread 0 between steps; may be NULL */
    void *tick_data;
};

/* directed.c: stages that begin paths as the running task says; `to` is filled from core->stages, which goes to core->plain. */
void mcr_directed_stages(struct mcr_core *core, struct mcr_stages *to);

/* loop.c: takes jobs of the pass until there are none. thread: 0 is the main one. */
void mcr_batch_run(struct mcr_batch *batch, struct mcr_pass *pass, uint32_t thread);

#endif
