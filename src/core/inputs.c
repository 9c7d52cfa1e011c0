/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The inputs of materials at points. Those that vary are evaluated once a round, before any plugin runs: values that differ between the materials of a
 * group are gathered, textures looked up, for all points of the material at once. A lane's inputs depend on its point alone.
 */
#include <string.h>

#include "base/cpu.h"
#include "core/batch.h"

/* Points whose inputs are evaluated. */
struct points {
    uint32_t n;
    const uint32_t *material;
    const double *u, *v, *width; /* NULL where nothing is textured */
    double *input;               /* channel c of lane i: input[c * room + i] */
    size_t room;
};

/* One texture at the lanes that are listed, or at all (lane NULL). */
static void look_up(const struct mcr_texture_lanes *t, const struct mcr_textured *textured, const struct points *at, const uint32_t *lane, uint32_t n)
{
    const double *u = lane ? t->u : at->u, *v = lane ? t->v : at->v, *width = lane ? t->width : at->width;
    double *const from[3] = {t->r, t->g, t->b};
    mcr_texture_lookup(textured->texture, n, u, v, mcr_texture_uses_width(textured->texture) ? width : NULL, t->r, t->g, t->b);
    for (uint32_t i = 0; i < n && !textured->colour; i++)
        t->r[i] = mcr_texture_number(t->r[i], t->g[i], t->b[i]);
    for (uint32_t c = 0; c < (textured->colour ? 3 : 1); c++) {
        double *to = at->input + (textured->channel + c) * at->room;
        if (!lane)
            memcpy(to, from[c], n * sizeof *to);
        for (uint32_t i = 0; lane && i < n; i++)
            to[lane[i]] = from[c][i];
    }
}

/* The textures of one material at those of the points that are its. */
static void look_up_material(struct mcr_batch *batch, uint32_t material, const struct points *at, uint32_t first)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_texture_lanes *t = &batch->textures;
    uint32_t n = 0;
    for (uint32_t k = first; k != UINT32_MAX; k = t->next[k])
        t->lane[n++] = k;
    for (uint32_t i = 0; i < n; i++) {
        t->u[i] = at->u[t->lane[i]];
        t->v[i] = at->v[t->lane[i]];
        t->width[i] = at->width[t->lane[i]];
    }
    for (uint32_t x = core->textured_from[material]; x < core->textured_from[material + 1]; x++)
        look_up(t, &core->textured[x], at, t->lane, n);
}

/* Lanes are listed by their material, then each material's textures are looked up. */
static void look_up_several(struct mcr_batch *batch, const struct points *at)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_texture_lanes *t = &batch->textures;
    uint32_t present = 0;
    for (uint32_t k = 0; k < at->n; k++) {
        uint32_t m = at->material[k];
        if (core->textured_from[m] == core->textured_from[m + 1])
            continue;
        if (t->head[m] == UINT32_MAX)
            t->present[present++] = m;
        t->next[k] = t->head[m];
        t->head[m] = k;
    }
    for (uint32_t i = 0; i < present; i++) {
        uint32_t first = t->head[t->present[i]];
        t->head[t->present[i]] = UINT32_MAX;
        look_up_material(batch, t->present[i], at, first);
    }
}

static void look_up_all(struct mcr_batch *batch, const struct mcr_group *group, const struct points *at)
{
    const struct mcr_core *core = batch->core;
    if (group->material_count > 1) {
        look_up_several(batch, at);
        return;
    }
    for (uint32_t x = core->textured_from[group->first]; x < core->textured_from[group->first + 1]; x++)
        look_up(&batch->textures, &core->textured[x], at, NULL, at->n);
}

static void evaluate(struct mcr_batch *batch, const struct mcr_group *group, const struct points *at)
{
    const struct mcr_core *core = batch->core;
    for (uint32_t c = 0; c < group->channels && group->table; c++)
        if (group->varies[c])
            core->stages->gather(at->n, at->material, group->table[c], at->input + c * at->room);
    if (group->textured)
        MCR_TIMED(MCR_STAGE_TEXTURES, look_up_all(batch, group, at));
}

void mcr_inputs_prepare(struct mcr_batch *batch)
{
    const struct mcr_surface_points *at = &batch->at;
    for (uint32_t r = 0; r < batch->range_count; r++) {
        const struct mcr_range *range = &batch->range[r];
        const uint32_t b = range->begin;
        evaluate(batch, &batch->core->group[range->group], &(struct points){.n = range->end - b,
                                                                            .material = at->material + b,
                                                                            .u = at->u ? at->u + b : NULL,
                                                                            .v = at->v ? at->v + b : NULL,
                                                                            .width = at->width ? at->width + b : NULL,
                                                                            .input = batch->lane_input + b,
                                                                            .room = batch->lanes});
    }
}

/* Pointers for plugins; lane 0 of channel c that varies is at input[c * lanes]. */
static struct mcr_inputs hand_over(struct mcr_batch *batch, const struct mcr_group *group, const double *input)
{
    batch->asked = group;
    for (uint32_t c = 0; c < group->channels; c++) {
        batch->channel[c] = group->varies[c] ? input + (size_t)c * batch->lanes : group->constant + (size_t)c * MCR_LANE_PAD;
        batch->stride[c] = group->varies[c];
    }
    return mcr_layer_inputs(batch, group->layer);
}

struct mcr_inputs mcr_layer_inputs(const struct mcr_batch *batch, const struct mcr_layer *layer)
{
    return (struct mcr_inputs){sizeof(struct mcr_inputs), layer->node->descriptor->parameter_count, batch->channel + layer->channel,
                               batch->stride + layer->channel};
}

struct mcr_inputs mcr_group_inputs(struct mcr_batch *batch, const struct mcr_group *group, uint32_t begin)
{
    return hand_over(batch, group, batch->lane_input + begin);
}

struct mcr_inputs mcr_elsewhere_inputs(struct mcr_batch *batch, const struct mcr_group *group, const struct mcr_points *at, const uint32_t *material)
{
    const struct mcr_elsewhere *e = &batch->elsewhere;
    const struct mcr_chart_lanes lanes = {.n = at->n,
                                          .primitive = e->primitive,
                                          .px = at->px,
                                          .py = at->py,
                                          .pz = at->pz,
                                          .gx = at->gx,
                                          .gy = at->gy,
                                          .gz = at->gz,
                                          .ox = at->ox,
                                          .oy = at->oy,
                                          .oz = at->oz,
                                          .u = e->u,
                                          .v = e->v,
                                          .width = e->width,
                                          .gu = {e->gu[0], e->gu[1], e->gu[2]},
                                          .gv = {e->gv[0], e->gv[1], e->gv[2]}};
    const struct points points = {at->n, material, e->u, e->v, e->width, e->input, batch->lanes};
    if (group->textured)
        MCR_TIMED(MCR_STAGE_COORDINATES, batch->core->stages->chart(batch->core, &lanes));
    if (e->input)
        MCR_TIMED(MCR_STAGE_INPUTS, evaluate(batch, group, &points));
    return hand_over(batch, group, e->input);
}
