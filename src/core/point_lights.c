/* SPDX-License-Identifier: Apache-2.0 */
#include "core/point_lights.h"

#include <math.h>
#include <string.h>

#include "core/crossing.h"
#include "core/host.h"
#include "core/lobes.h"

/* With more lights that have a place than this, they are found through a tree. */
#define FEW 16u
#define LEAF 4u
#define DEPTH 64u /* halves of 2^32 lights end long before */

/* A stretch of lights: two children, the left one right behind it, or lights alone. */
struct mcr_point_node {
    double lo[3], hi[3];
    double luminance;             /* of all in it */
    uint32_t first, count, right; /* right 0: a leaf */
};

/* ---- The tree -------------------------------------------------------------------------------------------------- */

struct builder {
    struct mcr_scene_light *light;
    struct mcr_point_node *node;
    uint32_t nodes;
    double *luminance;
};

/* Puts the lights first .. first+count-1 into such an order that the middle one along the axis stands in the middle: quickselect. */
static void halve(struct mcr_scene_light *light, uint32_t first, uint32_t count, int axis)
{
    uint32_t low = first, high = first + count - 1, middle = first + count / 2;
    while (low < high) {
        double pivot = light[low + (high - low) / 2].position[axis];
        uint32_t i = low, j = high;
        for (;;) {
            while (light[i].position[axis] < pivot)
                i++;
            while (light[j].position[axis] > pivot)
                j--;
            if (i >= j)
                break;
            struct mcr_scene_light swap = light[i];
            light[i++] = light[j];
            light[j--] = swap;
        }
        if (middle <= j)
            high = j;
        else
            low = j + 1;
    }
}

static double luminance_of(const struct mcr_scene_light *light)
{
    return mcr_luminance(light->colour[0], light->colour[1], light->colour[2]);
}

static uint32_t build_node(struct builder *b, uint32_t first, uint32_t count)
{
    uint32_t number = b->nodes++;
    struct mcr_point_node *node = &b->node[number];
    int axis = 0;
    node->first = first;
    node->count = count;
    for (int j = 0; j < 3; j++) {
        node->lo[j] = INFINITY;
        node->hi[j] = -INFINITY;
        for (uint32_t i = first; i < first + count; i++) {
            node->lo[j] = fmin(node->lo[j], b->light[i].position[j]);
            node->hi[j] = fmax(node->hi[j], b->light[i].position[j]);
        }
        axis = node->hi[j] - node->lo[j] > node->hi[axis] - node->lo[axis] ? j : axis;
    }
    if (count > LEAF) {
        halve(b->light, first, count, axis);
        build_node(b, first, count / 2);
        b->node[number].right = build_node(b, first + count / 2, count - count / 2);
        return number;
    }
    return number;
}

/* Sums from the leaves up: children come behind their parents. */
static void sum_nodes(struct builder *b)
{
    for (uint32_t i = b->nodes; i-- > 0;) {
        struct mcr_point_node *node = &b->node[i];
        node->luminance = node->right ? b->node[i + 1].luminance + b->node[node->right].luminance : 0;
        for (uint32_t l = node->first; !node->right && l < node->first + node->count; l++)
            node->luminance += b->luminance[l];
    }
}

/* Suns with an extent are parts of the sky; what is black adds nothing. */
static int is_point(const struct mcr_scene_light *light)
{
    return (light->kind != MCR_LIGHT_SUN || !(light->outer > 0)) && luminance_of(light) > 0;
}

int mcr_point_lights_create(struct mcr_arena *arena, const struct mcr_scene *scene, const struct mcr_point_lights **out)
{
    uint32_t count = 0, suns = 0;
    double most = 0;
    *out = NULL;
    for (uint32_t i = 0; i < scene->light_count; i++)
        count += is_point(&scene->light[i]);
    if (!count)
        return 0;
    struct mcr_point_lights *all = mcr_arena_alloc(arena, 1, sizeof *all);
    struct mcr_scene_light *light = mcr_arena_alloc(arena, count, sizeof *light);
    double *luminance = mcr_arena_alloc(arena, count, sizeof *luminance);
    if (!all || !light || !luminance)
        return -1;
    count = 0;
    for (int pass = 0; pass < 2; pass++) { /* suns first; those that are black are left out */
        for (uint32_t i = 0; i < scene->light_count; i++) {
            const struct mcr_scene_light *from = &scene->light[i];
            int sun = from->kind == MCR_LIGHT_SUN;
            if (sun == pass || !is_point(from))
                continue;
            most = fmax(most, luminance_of(from));
            light[count++] = *from;
        }
        suns = pass == 0 ? count : suns;
    }
    struct builder b = {.light = light, .luminance = luminance};
    if (count - suns > FEW) {
        b.node = mcr_arena_alloc(arena, 2 * (size_t)(count - suns), sizeof *b.node);
        if (!b.node)
            return -1;
        build_node(&b, suns, count - suns);
    }
    for (uint32_t i = 0; i < count; i++)
        luminance[i] = luminance_of(&light[i]) / most;
    sum_nodes(&b);
    *all = (struct mcr_point_lights){.count = count, .suns = suns, .light = light, .luminance = luminance, .node = b.node};
    *out = all;
    return 0;
}

/* ---- Choosing -------------------------------------------------------------------------------------------------- */

/* A surface point: where, its geometric normal, and whether light from behind counts. */
struct spot {
    double p[3], g[3];
    int both;
};

/* Toward a light: a unit vector, the distance, and the share of its colour that arrives on a surface that faces it. */
static double toward(const struct mcr_scene_light *light, const double p[3], double w[3], double *distance)
{
    if (light->kind == MCR_LIGHT_SUN) {
        memcpy(w, light->direction, 3 * sizeof *w);
        *distance = INFINITY;
        return 1;
    }
    double d[3] = {light->position[0] - p[0], light->position[1] - p[1], light->position[2] - p[2]};
    double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (!(square > 0))
        return 0;
    *distance = sqrt(square);
    for (int j = 0; j < 3; j++)
        w[j] = d[j] / *distance;
    if (light->kind == MCR_LIGHT_POINT)
        return 1 / square;
    /* 1 - cos to the axis is |-w - axis|^2 / 2, without cancellation. */
    double v = 0;
    for (int j = 0; j < 3; j++)
        v += (w[j] + light->direction[j]) * (w[j] + light->direction[j]);
    v *= 0.5;
    if (v >= light->outer)
        return 0;
    double t = v <= light->inner ? 1 : (light->outer - v) / (light->outer - light->inner);
    return t * t * (3 - 2 * t) / square;
}

static double estimate(const struct mcr_point_lights *all, uint32_t i, const struct spot *at)
{
    double w[3], distance, share = toward(&all->light[i], at->p, w, &distance);
    if (!at->both && !(share > 0 && at->g[0] * w[0] + at->g[1] * w[1] + at->g[2] * w[2] > 0))
        return 0;
    return fmin(all->luminance[i] * share, MCR_MOST_ESTIMATE);
}

/* By the distance of the box's middle, at least half its diagonal; never 0 where one of its lights counts. */
static double estimate_node(const struct mcr_point_node *node, const struct spot *at)
{
    double square = 0, diagonal = 0, above = 0;
    for (int j = 0; j < 3; j++) {
        double half = (node->hi[j] - node->lo[j]) / 2, d = (node->lo[j] + half) - at->p[j];
        square += d * d;
        diagonal += half * half;
        above += at->g[j] * d + fabs(at->g[j]) * half * (1 + 1e-12) + fabs(at->g[j]) * 1e-12 * (fabs(d) + fabs(at->p[j]));
    }
    if (!at->both && !(above > 0))
        return 0;
    square = fmax(square, diagonal);
    return square > 0 ? fmin(node->luminance / square, MCR_MOST_ESTIMATE) : MCR_MOST_ESTIMATE;
}

/* One candidate after the other takes the place of those before it with its part of the sum; the number is scaled anew each time. */
struct choice {
    double number, total, weight;
    uint32_t index;
};

static void consider(struct choice *c, uint32_t index, double weight)
{
    if (!(weight > 0))
        return;
    c->total += weight;
    double share = weight / c->total;
    if (c->number < share) {
        c->number = c->number / share;
        c->index = index;
        c->weight = weight;
    } else {
        c->number = (c->number - share) / (1 - share);
    }
    c->number = c->number < 1 ? c->number : 0x1.fffffffffffffp-1; /* rounded up */
}

#define TREE UINT32_MAX
#define NONE (UINT32_MAX - 1)

/* One light of many, NONE if none counts. *probability is that of the choice. Few are chosen from in point_lanes.c. */
static uint32_t choose(const struct mcr_point_lights *all, const struct spot *at, double number, double *probability)
{
    struct choice c = {number, 0, 0, NONE};
    const struct mcr_point_node *node = all->node;
    for (uint32_t i = 0; i < all->suns; i++)
        consider(&c, i, estimate(all, i, at));
    consider(&c, TREE, estimate_node(node, at));
    *probability = c.total > 0 ? c.weight / c.total : 0;
    if (c.index != TREE)
        return c.index;
    for (uint32_t depth = 0; node->right && depth < DEPTH; depth++) {
        const struct mcr_point_node *left = node + 1, *right = all->node + node->right;
        c = (struct choice){c.number, 0, 0, NONE};
        consider(&c, 0, estimate_node(left, at));
        consider(&c, 1, estimate_node(right, at));
        if (c.index == NONE)
            return NONE;
        *probability *= c.weight / c.total;
        node = c.index ? right : left;
    }
    c = (struct choice){c.number, 0, 0, NONE};
    for (uint32_t i = node->first; i < node->first + node->count; i++)
        consider(&c, i, estimate(all, i, at));
    if (c.index != NONE)
        *probability *= c.weight / c.total;
    return c.index;
}

/* ---- At a scattering event ------------------------------------------------------------------------------------- */

/* Where there is a tree, point after point. */
static void choose_by_tree(struct mcr_batch *batch, const struct mcr_range *range, int both)
{
    const struct mcr_core *core = batch->core;
    const struct mcr_point_lights *all = core->point_lights;
    const struct mcr_surface_points *at = &batch->at;
    struct mcr_point_lanes *l = &batch->point;
    for (uint32_t k = range->begin; k < range->end; k++) {
        struct spot spot = {{at->px[k], at->py[k], at->pz[k]}, {at->gx[k], at->gy[k], at->gz[k]}, both};
        double probability, w[3] = {0, 0, 0}, factor = 0;
        uint32_t i = choose(all, &spot, l->number[k], &probability);
        l->far[k] = 0;
        if (i != NONE)
            factor = toward(&all->light[i], spot.p, w, &l->far[k]) / probability;
        const double black[3] = {0, 0, 0}, *colour = factor > 0 ? all->light[i].colour : black;
        l->wx[k] = factor > 0 ? w[0] : 0;
        l->wy[k] = factor > 0 ? w[1] : 0;
        l->wz[k] = factor > 0 ? w[2] : 0;
        l->er[k] = colour[0] * factor;
        l->eg[k] = colour[1] * factor;
        l->eb[k] = colour[2] * factor;
    }
}

/*
 * The rays toward lights that something is scattered from; a ray ends a little before the light, as far as it starts off its surface, so that a light
 * that lies on a surface is not hidden by it.
 */
static int32_t trace(struct mcr_batch *batch, const struct mcr_range *range)
{
    struct mcr_point_lanes *l = &batch->point;
    const uint32_t rays = batch->core->stages->point_aim(batch, range);
    struct mcr_rays all = {rays, l->ox, l->oy, l->oz, l->dx, l->dy, l->dz};
    struct mcr_look look = {.rays = all, .lane = l->lane, .far = l->length, .seen = l->seen, .r = l->fr, .g = l->fg, .b = l->fb};
    int32_t status = mcr_look_visible(batch, &look);
    if (status)
        return status;
    batch->core->stages->point_add(batch, rays);
    batch->shadow_rays += rays;
    return MCR_OK;
}

int32_t mcr_point_lights_add(struct mcr_batch *batch, const struct mcr_range *range)
{
    struct mcr_point_lanes *l = &batch->point;
    const uint32_t b = range->begin, n = range->end - b;
    struct mcr_directions to = {sizeof to, n, l->wx + b, l->wy + b, l->wz + b};
    struct mcr_colours f = {sizeof f, n, l->fr + b, l->fg + b, l->fb + b};
    double *number = l->number + b;
    if (!batch->core->group[range->group].spreads)
        return MCR_OK;
    int32_t status = mcr_numbers(batch, &batch->sorted, b, range->end, MCR_DIMENSION_LIGHT, 1, &number);
    if (status)
        return status;
    int both = (batch->core->scene->material[batch->core->group[range->group].first].traits.does & MCR_MATERIAL_TRANSMITS) != 0;
    if (batch->core->point_lights->node)
        choose_by_tree(batch, range, both);
    else
        batch->core->stages->point_choose(batch, range, both);
    status = mcr_group_evaluate(batch, range, &to, &f);
    if (status)
        return status;
    if (batch->core->group[range->group].lobes)
        mcr_lobes_share(batch, range, &f);
    return trace(batch, range);
}
