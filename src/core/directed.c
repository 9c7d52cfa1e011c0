/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Paths of a task: pixels that a director chose, each with a replicate of its own. The stage begins them as if the task's entries were the pixels of
 * the crop; here they get their true pixel and the keys that follow from it. Integers and exact doubles only: once is enough for all instruction sets.
 */
#include "base/random.h"
#include "core/pass.h"

/* The paths first .. end-1 of those that are begun, all of one entry. */
static void place(struct mcr_batch *batch, const struct mcr_begin *b, const struct mcr_task_entry *entry, uint32_t first, uint32_t end)
{
    const struct mcr_film_settings *film = &batch->core->scene->film;
    const uint32_t width = film->x1 - film->x0, x = film->x0 + entry->pixel % width, y = film->y0 + entry->pixel / width;
    const uint64_t key = mcr_pixel_key(mcr_replicate_key(batch->core->scene->render.seed, entry->replicate), (uint64_t)y * film->width + x);
    uint32_t *index = batch->state.index + b->to;
    uint64_t *pixel_key = batch->state.pixel_key + b->to, *path_key = batch->state.path_key + b->to;
    for (uint32_t i = first; i < end; i++) {
        batch->camera_x[i] = x;
        batch->camera_y[i] = y;
        index[i] += entry->first;
        pixel_key[i] = key;
        path_key[i] = mcr_path_key(key, index[i]);
    }
    for (uint32_t i = first; i < end && batch->state.x; i++) {
        batch->state.x[b->to + i] = x;
        batch->state.y[b->to + i] = y;
    }
}

static void begin(struct mcr_batch *batch, const struct mcr_begin *b)
{
    const struct mcr_core *core = batch->core;
    core->plain->begin(batch, b);
    for (uint32_t first = 0, end; first < b->n; first = end) {
        uint32_t path = b->path + first, left = b->cell_samples - path % b->cell_samples;
        uint64_t cell = b->pixel + b->round * b->pixels + path / b->cell_samples;
        end = b->n - first < left ? b->n : first + left;
        place(batch, b, &core->task->entry[cell % b->pixels], first, end);
    }
}

void mcr_directed_stages(struct mcr_core *core, struct mcr_stages *to)
{
    *to = *core->stages;
    to->begin = begin;
    core->plain = core->stages;
    core->stages = to;
}
