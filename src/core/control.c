/* SPDX-License-Identifier: Apache-2.0 */
#include "core/control.h"

#include <math.h>

#include "core/closed_form.h"
#include "core/host.h"
#include "scene/vector.h"

/* Whether what a material emits is its mean radiance, from every point in every direction. */
static int is_even(const struct mcr_scene_material *material)
{
    const struct mcr_material_plugin *plugin = (const struct mcr_material_plugin *)(const void *)material->node->descriptor;
    if (material->needs & MCR_NEEDS_COORDINATES)
        return 0;
    return material->surface.emits ? !plugin->emission : (plugin->flags & MCR_MATERIAL_EVEN) != 0;
}

int mcr_control_init(struct mcr_core *core, struct mcr_arena *arena)
{
    const struct mcr_node *directions = core->scene->sampler->directions;
    const struct mcr_emitters *emitters = core->emitters;
    core->control = -1;
    for (uint32_t t = 0; t < directions->technique_count; t++)
        if (directions->technique[t].flags & MCR_TECHNIQUE_CONTROL)
            core->control = (int32_t)t;
    if (core->control < 0 || core->crosses || (core->scene->render.compat & MCR_COMPAT_BACKGROUND_AT_LIMIT) || !emitters->count || emitters->count > MCR_EMITTERS_FEW) {
        core->control = -1;
        return 0;
    }
    core->even = mcr_arena_alloc(arena, emitters->count, sizeof *core->even);
    if (!core->even)
        return -1;
    for (uint32_t e = 0; e < emitters->count; e++) {
        uint32_t kind = emitters->emitter[e].kind;
        int known = kind == MCR_EMITTER_PARALLELOGRAM || kind == MCR_EMITTER_TRIANGLE || kind == MCR_EMITTER_SPHERE;
        core->even[e] = known && is_even(&core->scene->material[emitters->emitter[e].material]);
    }
    return 0;
}

static void point_of(const struct mcr_batch *batch, uint32_t k, double p[3])
{
    p[0] = batch->at.px[k];
    p[1] = batch->at.py[k];
    p[2] = batch->at.pz[k];
}

int mcr_control_holds(const struct mcr_batch *batch, uint32_t k, int32_t e)
{
    const struct mcr_core *core = batch->core;
    if (core->control < 0 || e < 0 || (uint32_t)e >= core->emitters->count || !core->even[e] || !(batch->controlled[k] > 0))
        return 0;
    const double *c = core->emitters->k[e];
    double p[3], to[3];
    point_of(batch, k, p);
    mcr_subtract(c, p, to);
    return core->emitters->emitter[e].area >= MCR_CONTROL_LEAST * mcr_dot(to, to);
}

/* The integral of the cosine over the emitter; 0 where it shows the point a dark side. The sides are judged as where points are drawn. */
static double unoccluded(const struct mcr_core *core, uint32_t e, const double p[3], const double n[3])
{
    const double *k = core->emitters->k[e];
    double away[3], height;
    mcr_subtract(p, k + MCR_K_C, away);
    if (core->emitters->emitter[e].kind == MCR_EMITTER_SPHERE) {
        height = mcr_dot(away, away) - k[MCR_K_SQUARE];
        if (height < 0)
            return height < k[MCR_K_BELOW] ? MCR_PI : 0; /* inside: it is all around */
        return height > k[MCR_K_ABOVE] ? mcr_sphere_cosine(k + MCR_K_C, k[MCR_K_RADIUS], p, n) : 0;
    }
    height = mcr_dot(k + MCR_K_N, away);
    if (!(height > k[MCR_K_ABOVE] || height < k[MCR_K_BELOW]))
        return 0;
    int triangle = core->emitters->emitter[e].kind == MCR_EMITTER_TRIANGLE;
    double corner[4][3];
    for (int j = 0; j < 3; j++) {
        double c = k[MCR_K_C + j], a = k[MCR_K_E0 + j], b = k[MCR_K_E1 + j];
        corner[0][j] = c;
        corner[1][j] = c + a;
        corner[2][j] = triangle ? c + b : c + a + b;
        corner[3][j] = c + b;
    }
    return mcr_polygon_cosine(corner, triangle ? 3 : 4, p, n);
}

int32_t mcr_control_add(struct mcr_batch *batch, const struct mcr_range *range)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_group *group = &core->group[range->group];
    const struct mcr_surface_points *at = &batch->at;
    const struct mcr_paths *paths = &batch->sorted;
    struct mcr_light_lanes *l = &batch->light;
    const uint32_t b = range->begin;
    int lambertian = (group->plugin->flags & MCR_MATERIAL_LAMBERTIAN) && !group->lobes;
    for (uint32_t k = b; k < range->end; k++)
        batch->controlled[k] = lambertian && at->nx[k] == at->gx[k] && at->ny[k] == at->gy[k] && at->nz[k] == at->gz[k] ? 1.0 : 0.0;
    if (!lambertian)
        return MCR_OK;
    /* f cos toward the normal is rho / pi. */
    struct mcr_directions normal = {sizeof normal, range->end - b, at->nx + b, at->ny + b, at->nz + b};
    struct mcr_colours f = {sizeof f, range->end - b, l->fr + b, l->fg + b, l->fb + b};
    int32_t status = mcr_group_evaluate(batch, range, &normal, &f);
    for (uint32_t k = b; k < range->end && !status; k++) {
        double p[3], n[3] = {at->nx[k], at->ny[k], at->nz[k]}, sum[3] = {0, 0, 0};
        point_of(batch, k, p);
        for (uint32_t e = 0; e < core->emitters->count; e++) {
            if (!mcr_control_holds(batch, k, (int32_t)e))
                continue;
            const double *radiance = core->scene->material[core->emitters->emitter[e].material].traits.radiance;
            double share = unoccluded(core, e, p, n);
            for (int c = 0; c < 3; c++)
                sum[c] += radiance[c] * share;
        }
        batch->slot_r[paths->slot[k]] += paths->r[k] * l->fr[k] * sum[0];
        batch->slot_g[paths->slot[k]] += paths->g[k] * l->fg[k] * sum[1];
        batch->slot_b[paths->slot[k]] += paths->b[k] * l->fb[k] * sum[2];
    }
    return status;
}
