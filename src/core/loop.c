/* SPDX-License-Identifier: Apache-2.0 */
/* One thread's round: new camera paths, hits, emission, one scattering event for every path, rays for those that go on. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/cpu.h"
#include "base/random.h"
#include "core/compat.h"
#include "core/crossing.h"
#include "core/host.h"
#include "core/light.h"
#include "core/lobes.h"
#include "core/pass.h"

static void fail(struct mcr_batch *batch, struct mcr_pass *pass, const struct mcr_node *node, int32_t status)
{
    static const char *const reason[] = {"", "invalid", "out of memory", "unsupported", "internal error"};
    int none = 0;
    char text[sizeof pass->error];
    snprintf(text, sizeof text, "%s: %s%s%s", node->descriptor->name, status < 0 && status >= -4 ? reason[-status] : "unknown status",
             batch->context.message[0] ? ": " : "", batch->context.message);
    if (atomic_compare_exchange_strong(&pass->failed, &none, 1))
        memcpy(pass->error, text, sizeof text);
}

/* ---- Jobs ------------------------------------------------------------------------------------------------------ */

/* A job whose paths are not all begun, taken from the pass at need; NULL if there is none or all places are taken. */
static struct mcr_job *open_job(struct mcr_batch *batch, struct mcr_pass *pass)
{
    struct mcr_job *empty = NULL;
    for (uint32_t i = 0; i < MCR_JOBS; i++) {
        struct mcr_job *job = &batch->job[i];
        if (job->busy && job->begun < job->paths)
            return job;
        if (!job->busy && !empty)
            empty = job;
    }
    if (!empty || atomic_load_explicit(&pass->next, memory_order_relaxed) >= pass->cells)
        return NULL;
    uint64_t most = MCR_JOB_SLOTS / pass->cell_samples;
    uint64_t first = atomic_fetch_add(&pass->next, most);
    if (first >= pass->cells)
        return NULL;
    uint32_t cells = (uint32_t)(pass->cells - first < most ? pass->cells - first : most);
    *empty = (struct mcr_job){.first_cell = first, .cells = cells, .paths = cells * pass->cell_samples, .busy = 1};
    size_t slot = (size_t)(empty - batch->job) * MCR_JOB_SLOTS;
    memset(batch->slot_r + slot, 0, empty->paths * sizeof(double));
    memset(batch->slot_g + slot, 0, empty->paths * sizeof(double));
    memset(batch->slot_b + slot, 0, empty->paths * sizeof(double));
    if (batch->cap_r)
        mcr_compat_raise_caps(batch, slot, empty->paths);
    if (batch->core->features)
        mcr_features_begin(batch, slot, empty->paths);
    return empty;
}

/* Counts samples that are not finite and makes them black. */
static void reject(struct mcr_batch *batch, const struct mcr_pass *pass, uint64_t cell, size_t slot)
{
    for (uint32_t s = 0; s < pass->cell_samples; s++) {
        double *r = &batch->slot_r[slot + s], *g = &batch->slot_g[slot + s], *b = &batch->slot_b[slot + s];
        if (isfinite(*r) && isfinite(*g) && isfinite(*b))
            continue;
        *r = *g = *b = 0;
        if (!batch->not_finite++ || cell < batch->not_finite_cell) {
            batch->not_finite_cell = cell;
            batch->not_finite_sample = s;
        }
    }
}

/* Whether a path of the job in place i is among the rays still. */
static int in_flight(const struct mcr_batch *batch, uint32_t i)
{
    const uint32_t *slot = batch->state.slot, *source = batch->source, rays = batch->rays;
    uint32_t found = 0;
    for (uint32_t j = 0; j < rays; j++)
        found |= slot[source[j]] / MCR_JOB_SLOTS == i;
    return found != 0;
}

/* Adds up one cell, whose samples begin at `slot`. */
static void finish_cell(const struct mcr_batch *batch, const struct mcr_pass *pass, uint64_t number, size_t slot)
{
    const double *r = batch->slot_r + slot, *g = batch->slot_g + slot, *b = batch->slot_b + slot;
    mcr_cell_sum(r, g, b, pass->cell_samples, &pass->cell[number]);
    if (pass->channels)
        mcr_cell_channel_moments(r, g, b, pass->cell_samples, &pass->cell[number], &pass->channels[number]);
}

/* The samples' weights by the film's filter, which may be negative: applied at the end, where they disturb no throughput. */
static void weigh(struct mcr_batch *batch, size_t first, uint32_t n)
{
    const double *restrict weight = batch->slot_weight;
    for (size_t i = first; i < first + n; i++) {
        batch->slot_r[i] *= weight[i];
        batch->slot_g[i] *= weight[i];
        batch->slot_b[i] *= weight[i];
    }
}

/* Sums up the jobs whose paths have all begun and ended. */
static void finish_jobs(struct mcr_batch *batch, struct mcr_pass *pass)
{
    for (uint32_t i = 0; i < MCR_JOBS; i++) {
        struct mcr_job *job = &batch->job[i];
        if (!job->busy || job->begun < job->paths || in_flight(batch, i))
            continue;
        if (batch->cap_r)
            mcr_compat_clamp(batch, (size_t)i * MCR_JOB_SLOTS, job->paths);
        if (batch->core->features)
            mcr_features_settle(batch, (size_t)i * MCR_JOB_SLOTS, job->paths);
        if (batch->slot_weight)
            weigh(batch, (size_t)i * MCR_JOB_SLOTS, job->paths);
        for (uint32_t c = 0; c < job->cells; c++) {
            size_t slot = (size_t)i * MCR_JOB_SLOTS + (size_t)c * pass->cell_samples;
            uint64_t number = job->first_cell + c;
            finish_cell(batch, pass, number, slot);
            if (pass->features)
                mcr_features_cell(batch, slot, pass->cell_samples, &pass->features[number]);
            if (isfinite(pass->cell[number].sum[0] + pass->cell[number].sum[1] + pass->cell[number].sum[2]))
                continue;
            reject(batch, pass, number, slot);
            finish_cell(batch, pass, number, slot);
        }
        job->busy = 0;
        atomic_fetch_add_explicit(&pass->done, job->cells, memory_order_relaxed);
    }
}

/* ---- Camera ---------------------------------------------------------------------------------------------------- */

static int32_t camera(struct mcr_batch *batch, struct mcr_pass *pass)
{
    struct mcr_core *core = batch->core;
    const struct mcr_paths *paths = &batch->state;
    struct mcr_job *job;
    while (batch->rays < core->capacity && (job = open_job(batch, pass))) {
        uint32_t room = core->capacity - batch->rays, to = batch->states, n = job->paths - job->begun < room ? job->paths - job->begun : room;
        int lens = core->scene->camera.kind == MCR_CAMERA_THIN_LENS && core->scene->camera.lens_radius > 0;
        struct mcr_begin begin = {.n = n,
                                  .to = to,
                                  .path = job->begun,
                                  .slot = (uint32_t)(job - batch->job) * MCR_JOB_SLOTS + job->begun,
                                  .cell_samples = pass->cell_samples,
                                  .pixel = job->first_cell % pass->pixels,
                                  .round = job->first_cell / pass->pixels,
                                  .pixels = pass->pixels,
                                  .first = (uint32_t)pass->first,
                                  .planned = pass->planned,
                                  .replicate_key = pass->replicate_key};
        double *weight = batch->slot_weight ? batch->slot_weight + begin.slot : NULL;
        core->stages->begin(batch, &begin);
        job->begun += n;
        int32_t status = mcr_numbers(batch, paths, to, to + n, 0, 2, batch->number);
        if (!status && lens)
            status = mcr_numbers(batch, paths, to, to + n, MCR_DIMENSION_LENS, 2, batch->number + 2);
        if (status)
            return status;
        struct mcr_camera_lanes lanes = {.n = n,
                                         .x = batch->camera_x,
                                         .y = batch->camera_y,
                                         .film = (const double *const *)batch->number,
                                         .lens = lens ? (const double *const *)batch->number + 2 : NULL,
                                         .ox = batch->rox + batch->rays,
                                         .oy = batch->roy + batch->rays,
                                         .oz = batch->roz + batch->rays,
                                         .dx = batch->rdx + batch->rays,
                                         .dy = batch->rdy + batch->rays,
                                         .dz = batch->rdz + batch->rays,
                                         .distance = core->features && batch->features.distance ? batch->features.distance + begin.slot : NULL,
                                         .weight = weight};
        core->stages->camera(core->scene, &lanes);
        if (core->charts.needs)
            MCR_TIMED(MCR_STAGE_COORDINATES, core->stages->cones(batch, to, batch->rays, n));
        if (core->interiors)
            MCR_TIMED(MCR_STAGE_INTERIORS, mcr_crossing_begin(batch, to, n));
        batch->rays += n;
        batch->states = (to + n + MCR_LANE_PAD - 1) / MCR_LANE_PAD * MCR_LANE_PAD;
        batch->camera_rays += n;
    }
    return MCR_OK;
}

/* ---- One scattering event -------------------------------------------------------------------------------------- */

static struct mcr_colours colours(struct mcr_batch *batch, uint32_t begin, uint32_t end)
{
    return (struct mcr_colours){sizeof(struct mcr_colours), end - begin, batch->fr + begin, batch->fg + begin, batch->fb + begin};
}

static int32_t emission(struct mcr_batch *batch)
{
    for (uint32_t r = 0; r < batch->range_count; r++) {
        const struct mcr_range *range = &batch->range[r];
        if (!batch->core->group[range->group].emits)
            continue;
        struct mcr_colours out = colours(batch, range->begin, range->end);
        int32_t status = mcr_group_emission(batch, range, &out);
        if (status)
            return status;
        if (batch->core->combines)
            for (uint32_t k = range->begin; k < range->end; k++) {
                double weight = batch->light.weight[batch->order[k]];
                batch->fr[k] *= weight;
                batch->fg[k] *= weight;
                batch->fb[k] *= weight;
            }
        batch->core->stages->emit(batch, range->begin, range->end);
    }
    return MCR_OK;
}

/* What roulette asks for, for those points of the range that it may end. */
static int32_t roulette(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_range part = {.group = range->group, .begin = range->roulette, .end = range->end};
    const uint32_t b = part.begin;
    struct mcr_directions toward = {sizeof toward, part.end - b, batch->wx + b, batch->wy + b, batch->wz + b};
    double *number = batch->roulette + b;
    int32_t status = MCR_OK;
    if (batch->core->group[range->group].spreads)
        status = mcr_group_density(batch, &part, &toward, batch->material_density + b);
    if (!status)
        status = mcr_numbers(batch, &batch->sorted, b, part.end, MCR_DIMENSION_ROULETTE, 1, &number);
    return status;
}

/* Directions by the sampler, look-ups for light, f cos: for the points of one group. */
static int32_t draw_range(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_core *core = batch->core;
    const uint32_t b = range->begin, n = range->end - b;
    const struct mcr_node *node = core->scene->sampler->directions;
    struct mcr_points at = mcr_batch_points(batch, b, range->end);
    struct mcr_directions toward = {sizeof toward, n, batch->wx + b, batch->wy + b, batch->wz + b};
    struct mcr_colours out = colours(batch, b, range->end);
    double *number[MCR_NUMBERS_MAX];
    int32_t status;
    uint32_t first = 0;
    at.wanted = core->group[range->group].lobes ? batch->lobe.none + b : NULL;
    for (uint32_t k = 0; k < MCR_NUMBERS_MAX; k++)
        number[k] = batch->number[k] + b;
    for (uint32_t t = 0; t < core->continuing; t++)
        first += node->technique[t].dimensions;
    batch->kept_at = NULL;
    MCR_TIMED(MCR_STAGE_NUMBERS, status = mcr_numbers(batch, &batch->sorted, b, range->end, MCR_DIMENSION_SAMPLER, core->dimensions, number));
    if (!status)
        MCR_TIMED(MCR_STAGE_SAMPLER,
                  status = mcr_node_draw(batch, node, core->continuing, &at, (const double *const *)number + first, &toward, batch->density + b));
    if (!status && core->combines)
        MCR_TIMED(MCR_STAGE_LIGHT, status = mcr_light_lookups(batch, range, &at, number));
    if (!status)
        MCR_TIMED(MCR_STAGE_MATERIAL, status = mcr_group_evaluate(batch, range, &toward, &out));
    return status;
}

/* The points of one group: directions, f cos, throughput. */
static int32_t scatter_range(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_group *group = &core->group[range->group];
    int32_t status = MCR_OK;
    batch->running = range;
    if (group->lobes)
        MCR_TIMED(MCR_STAGE_LOBES, status = mcr_lobes_choose(batch, range));
    else if (core->lobes)
        MCR_TIMED(MCR_STAGE_LOBES, mcr_lobes_none(batch, range));
    if (!status && group->spreads)
        status = draw_range(batch, range);
    if (!status && range->roulette < range->end)
        MCR_TIMED(MCR_STAGE_ROULETTE, status = roulette(batch, range));
    if (!status && core->point_lights)
        MCR_TIMED(MCR_STAGE_POINTS, status = mcr_point_lights_add(batch, range));
    batch->running = NULL;
    if (status)
        return status;
    if (group->lobes)
        MCR_TIMED(MCR_STAGE_LOBES, core->stages->mirror(batch, range));
    MCR_TIMED(MCR_STAGE_SCATTER, core->stages->scatter(batch, range));
    if (core->interiors)
        MCR_TIMED(MCR_STAGE_INTERIORS, mcr_crossing_scattered(batch, range));
    batch->scatterings += range->end - range->begin;
    return MCR_OK;
}

/* Everybody's next ray, after camera() has filled the batch up. Returns 0, or a plugin's failure. */
static int32_t step(struct mcr_batch *batch, struct mcr_pass *pass)
{
    struct mcr_core *core = batch->core;
    int32_t status = MCR_OK;
    if (core->scene->render.compat & (MCR_COMPAT_BACKGROUND_AT_LIMIT | MCR_COMPAT_FLOOR_SQRT))
        mcr_compat_end_rays(batch);
    struct mcr_rays rays = {batch->rays, batch->rox, batch->roy, batch->roz, batch->rdx, batch->rdy, batch->rdz};
    MCR_TIMED(MCR_STAGE_HIT, core->trace->closest(core->accel, &rays, batch->t, batch->hit));
    if (core->crosses)
        MCR_TIMED(MCR_STAGE_CROSSING, status = mcr_crossing_paths(batch));
    if (!status && core->combines)
        MCR_TIMED(MCR_STAGE_LIGHT, status = mcr_light_weights(batch));
    if (status)
        return status;
    MCR_TIMED(MCR_STAGE_SORT, core->stages->sort(batch));
    if (core->background && batch->miss_count)
        MCR_TIMED(MCR_STAGE_SKY, core->stages->background(batch));
    MCR_TIMED(MCR_STAGE_SURFACE, core->stages->surface(batch));
    if (core->charts.needs)
        MCR_TIMED(MCR_STAGE_COORDINATES, core->stages->coordinates(batch));
    if (core->charts.needs & MCR_NEEDS_NORMALS)
        MCR_TIMED(MCR_STAGE_NORMALS, mcr_normals_tilt(batch));
    MCR_TIMED(MCR_STAGE_INPUTS, mcr_inputs_prepare(batch));
    if (core->interiors)
        MCR_TIMED(MCR_STAGE_INTERIORS, mcr_crossing_points(batch));
    if (batch->cap_r)
        mcr_compat_lower_caps(batch);
    if (core->features)
        MCR_TIMED(MCR_STAGE_LAYERS, status = mcr_features_hit(batch));
    if (!status)
        MCR_TIMED(MCR_STAGE_EMISSION, status = emission(batch));
    if (core->features)
        MCR_TIMED(MCR_STAGE_LAYERS, mcr_features_direct(batch));
    for (uint32_t r = 0; !status && r < batch->range_count && !batch->range[r].ends; r++)
        status = scatter_range(batch, &batch->range[r]);
    if (status)
        return status;
    MCR_TIMED(MCR_STAGE_COMPACT, core->stages->compact(batch));
    batch->bounce_rays += batch->rays;
    MCR_TIMED(MCR_STAGE_FILM, finish_jobs(batch, pass));
    return MCR_OK;
}

void mcr_batch_run(struct mcr_batch *batch, struct mcr_pass *pass, uint32_t thread)
{
    batch->replicate_key = pass->replicate_key;
    while (!atomic_load_explicit(&pass->failed, memory_order_relaxed)) {
        int32_t status;
        MCR_TIMED(MCR_STAGE_CAMERA, status = camera(batch, pass));
        if (!status && !batch->rays)
            return;
        if (!status)
            status = step(batch, pass);
        if (status)
            fail(batch, pass, batch->failed ? batch->failed : batch->core->scene->sampler->directions, status);
        if (thread == 0 && pass->tick)
            pass->tick(pass->tick_data, pass);
    }
}
