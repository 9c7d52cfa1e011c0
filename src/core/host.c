/* SPDX-License-Identifier: Apache-2.0 */
/* The services that plugins call while they run, and the calls into a sampler's nodes. A batch belongs to one thread, so nothing is locked. */
#include "core/host.h"

#include "core/lights.h"

#include <stdio.h>
#include <string.h>

static struct mcr_batch *batch_of(const struct mcr_context *context)
{
    return context->core;
}

static const struct mcr_directions_plugin *directions_of(const struct mcr_node *node)
{
    return (const struct mcr_directions_plugin *)(const void *)node->descriptor;
}

static uint64_t padded(uint64_t bytes)
{
    return (bytes + 63) / 64 * 64;
}

/* What an operation changes in the context, for putting it back. */
struct frame {
    const struct mcr_node *node;
    void *scratch;
    uint64_t used;
};

static struct frame enter(struct mcr_batch *batch, const struct mcr_node *node, uint64_t bytes)
{
    struct frame was = {batch->context.node, batch->context.scratch, batch->scratch_used};
    batch->context.node = node;
    batch->context.scratch = batch->scratch + batch->scratch_used;
    batch->scratch_used += padded(bytes);
    return was;
}

/* Returns the status; of a failure, the innermost node is remembered. */
static int32_t leave(struct mcr_batch *batch, const struct frame *was, int32_t status)
{
    if (status && !batch->failed)
        batch->failed = batch->context.node;
    batch->context.node = was->node;
    batch->context.scratch = was->scratch;
    batch->scratch_used = was->used;
    return status;
}

static uint64_t node_bytes(const struct mcr_node *node, uint32_t n)
{
    const struct mcr_directions_plugin *plugin = directions_of(node);
    return plugin->scratch_bytes ? plugin->scratch_bytes(node->instance, n) : 0;
}

int32_t mcr_node_draw(struct mcr_batch *batch, const struct mcr_node *node, uint32_t technique, const struct mcr_points *at,
                      const double *const *number, const struct mcr_directions *out, double *density)
{
    struct frame was = enter(batch, node, node_bytes(node, at->n));
    int32_t status = directions_of(node)->draw(&batch->core->host, &batch->context, node->instance, technique, at, number, out, density);
    return leave(batch, &was, status);
}

int32_t mcr_node_density(struct mcr_batch *batch, const struct mcr_node *node, uint32_t technique, const struct mcr_points *at,
                         const struct mcr_directions *toward, double *density)
{
    struct frame was = enter(batch, node, node_bytes(node, at->n));
    int32_t status = directions_of(node)->density(&batch->core->host, &batch->context, node->instance, technique, at, toward, density);
    return leave(batch, &was, status);
}

int32_t mcr_node_draw_emitter(struct mcr_batch *batch, const struct mcr_node *node, uint32_t technique, const struct mcr_points *at,
                              const double *const *number, const struct mcr_emitter_points *out, double *density)
{
    struct frame was = enter(batch, node, node_bytes(node, at->n));
    int32_t status = directions_of(node)->draw_emitter(&batch->core->host, &batch->context, node->instance, technique, at, number, out, density);
    return leave(batch, &was, status);
}

int32_t mcr_node_density_emitter(struct mcr_batch *batch, const struct mcr_node *node, uint32_t technique, const struct mcr_points *at,
                                 const struct mcr_emitter_points *points, double *density)
{
    struct frame was = enter(batch, node, node_bytes(node, at->n));
    int32_t status = directions_of(node)->density_emitter(&batch->core->host, &batch->context, node->instance, technique, at, points, density);
    return leave(batch, &was, status);
}

static void report(const struct mcr_host *host, struct mcr_context *context, uint32_t severity, const char *text)
{
    (void)host;
    (void)severity;
    snprintf(context->message, sizeof context->message, "%s", text ? text : "");
}

static void *scratch(const struct mcr_host *host, struct mcr_context *context)
{
    (void)host;
    return context->scratch;
}

static const struct mcr_node *node_of(const struct mcr_child *child)
{
    return (const struct mcr_node *)(const void *)child;
}

static int32_t child_techniques(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                struct mcr_technique *technique, uint32_t *count)
{
    const struct mcr_node *node = node_of(child);
    (void)host;
    (void)context;
    memcpy(technique, node->technique, node->technique_count * sizeof *technique);
    *count = node->technique_count;
    return MCR_OK;
}

static int32_t child_draw(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                          const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)host;
    return mcr_node_draw(batch_of(context), node_of(child), technique, at, number, out, density);
}

static int32_t child_density(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                             const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    (void)host;
    return mcr_node_density(batch_of(context), node_of(child), technique, at, toward, density);
}

static int32_t child_mass(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                          const struct mcr_points *at, double *mass)
{
    struct mcr_batch *batch = batch_of(context);
    const struct mcr_node *node = node_of(child);
    if (!directions_of(node)->mass) {
        for (uint32_t i = 0; i < at->n; i++)
            mass[i] = 1;
        return MCR_OK;
    }
    struct frame was = enter(batch, node, node_bytes(node, at->n));
    int32_t status = directions_of(node)->mass(host, context, node->instance, technique, at, mass);
    return leave(batch, &was, status);
}

/* The lights' working memory lies on the same stack as that of the nodes. */
#define WITH_LIGHTS(CALL)                                                                               \
    struct mcr_batch *batch = batch_of(context);                                                        \
    const struct mcr_core *core = batch->core;                                                          \
    struct frame was = enter(batch, context->node, mcr_lights_scratch(core, at->n));        \
    (void)host;                                                                                         \
    CALL;                                                                                 \
    return leave(batch, &was, MCR_OK)

static int32_t light_draw(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                          const double *const *number, const struct mcr_directions *out, double *density)
{
    batch_of(context)->kept_at = at->px;
    batch_of(context)->kept_by = by;
    batch_of(context)->kept_n = at->n;
    WITH_LIGHTS(mcr_lights_draw(core, context->scratch, by, at, number, out, density, batch->kept));
}

static int32_t light_density(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                             const struct mcr_directions *toward, double *density)
{
    const struct mcr_batch *b = batch_of(context);
    const double *kept = b->kept_at == at->px && b->kept_n == at->n && b->kept_by == by ? b->kept : NULL;
    WITH_LIGHTS(mcr_lights_density(core, context->scratch, by, at, toward, kept, density));
}

static int32_t light_mass(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at, double *mass)
{
    WITH_LIGHTS(mcr_lights_mass(core, context->scratch, by, at, mass));
}

static int32_t light_draw_point(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                                const double *const *number, const struct mcr_emitter_points *out, double *density)
{
    WITH_LIGHTS(mcr_lights_draw_point(core, context->scratch, by, at, number, out, density));
}

static int32_t light_density_point(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                                   const struct mcr_emitter_points *points, double *density)
{
    WITH_LIGHTS(mcr_lights_density_point(core, context->scratch, by, at, points, density));
}

/* The range that a sampler works on is one group, so that its material can be asked at once. */
static const struct mcr_group *running_group(const struct mcr_batch *batch, const struct mcr_points *at)
{
    const struct mcr_range *range = batch->running;
    if (!range || at->px != batch->at.px + range->begin || at->n != range->end - range->begin)
        return NULL;
    return &batch->core->group[range->group];
}

static int32_t material_draw(const struct mcr_host *host, struct mcr_context *context, const struct mcr_points *at, const double *const *number,
                             const struct mcr_directions *out, double *density)
{
    struct mcr_batch *batch = batch_of(context);
    const struct mcr_group *group = running_group(batch, at);
    if (!group || !group->plugin->draw)
        return MCR_E_UNSUPPORTED;
    struct mcr_inputs inputs = mcr_group_inputs(batch, group, batch->running->begin);
    struct frame was = enter(batch, context->node, mcr_material_bytes(group, at->n));
    int32_t status = group->plugin->draw(host, context, group->instance, &inputs, at, number, out, density);
    return leave(batch, &was, status);
}

static int32_t material_density(const struct mcr_host *host, struct mcr_context *context, const struct mcr_points *at,
                                const struct mcr_directions *toward, double *density)
{
    struct mcr_batch *batch = batch_of(context);
    const struct mcr_group *group = running_group(batch, at);
    if (!group || !group->plugin->density)
        return MCR_E_UNSUPPORTED;
    struct mcr_inputs inputs = mcr_group_inputs(batch, group, batch->running->begin);
    struct frame was = enter(batch, context->node, mcr_material_bytes(group, at->n));
    int32_t status = group->plugin->density(host, context, group->instance, &inputs, at, toward, density);
    return leave(batch, &was, status);
}

/* ---- Materials inside materials ---- */

/* The layer of the running group that holds a child: its inputs are there. One that is there twice has the same in both. */
static const struct mcr_layer *layer_of(const struct mcr_batch *batch, const struct mcr_child *child)
{
    const struct mcr_group *group = batch->asked;
    for (uint32_t l = 1; group && l < group->layer_count; l++)
        if (group->layer[l].node == node_of(child))
            return &group->layer[l];
    return NULL;
}

static const struct mcr_material_plugin *material_plugin(const struct mcr_node *node)
{
    return (const struct mcr_material_plugin *)(const void *)node->descriptor;
}

static uint64_t layer_bytes(const struct mcr_node *node, uint32_t n)
{
    const struct mcr_material_plugin *plugin = material_plugin(node);
    return plugin->scratch_bytes ? plugin->scratch_bytes(node->instance, n) : 0;
}

/* Calls operation OPERATION of a child with the arguments behind `inputs`. */
#define WITH_CHILD(OPERATION, ...)                                                                                  struct mcr_batch *batch = batch_of(context);                                                                    const struct mcr_layer *layer = layer_of(batch, child);                                                         if (!layer)                                                                                                         return MCR_E_INVALID;                                                                                       if (!material_plugin(layer->node)->OPERATION)                                                                       return MCR_E_UNSUPPORTED;                                                                                   struct mcr_inputs inputs = mcr_layer_inputs(batch, layer);                                                      struct frame was = enter(batch, layer->node, layer_bytes(layer->node, at->n));                                  return leave(batch, &was, material_plugin(layer->node)->OPERATION(host, context, layer->node->instance, &inputs, at, __VA_ARGS__))

static int32_t material_child_traits(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                     struct mcr_material_traits *traits)
{
    return mcr_creation_host()->material_child_traits(host, context, child, traits);
}

static int32_t material_child_evaluate(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                       const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    WITH_CHILD(evaluate, toward, out);
}

static int32_t material_child_draw(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                   const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    WITH_CHILD(draw, number, out, density);
}

static int32_t material_child_density(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                      const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    WITH_CHILD(density, toward, density);
}

static int32_t material_child_delta(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out,
                                    double *probability, const struct mcr_colours *weight)
{
    WITH_CHILD(delta, number, out, probability, weight);
}

static int32_t material_child_passes(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                     const struct mcr_points *at, const struct mcr_colours *out)
{
    WITH_CHILD(passes, out);
}

static int32_t material_child_albedo(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                     const struct mcr_points *at, const struct mcr_colours *out)
{
    WITH_CHILD(albedo, out);
}

static int32_t layer_emission(struct mcr_batch *batch, const struct mcr_layer *layer, const struct mcr_points *at, const struct mcr_inputs *inputs,
                              const struct mcr_colours *out);

static int32_t material_child_emission(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                       const struct mcr_points *at, const struct mcr_colours *out)
{
    struct mcr_batch *batch = batch_of(context);
    const struct mcr_layer *layer = layer_of(batch, child);
    (void)host;
    if (!layer)
        return MCR_E_INVALID;
    if (!material_plugin(layer->node)->emission && layer->emission == UINT32_MAX)
        return MCR_E_UNSUPPORTED;
    struct mcr_inputs inputs = mcr_layer_inputs(batch, layer);
    return layer_emission(batch, layer, at, &inputs, out);
}

static uint32_t has_lights(const struct mcr_host *host, struct mcr_context *context)
{
    (void)host;
    return context->has_lights;
}

uint64_t mcr_material_bytes(const struct mcr_group *group, uint32_t n)
{
    return group->plugin->scratch_bytes ? group->plugin->scratch_bytes(group->instance, n) : 0;
}

int32_t mcr_group_evaluate(struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    const struct mcr_group *group = &batch->core->group[range->group];
    struct mcr_points at = mcr_batch_points(batch, range->begin, range->end);
    struct mcr_inputs inputs = mcr_group_inputs(batch, group, range->begin);
    struct frame was = enter(batch, group->node, mcr_material_bytes(group, at.n));
    int32_t status = group->plugin->evaluate(&batch->core->host, &batch->context, group->instance, &inputs, &at, toward, out);
    return leave(batch, &was, status);
}

int32_t mcr_group_density(struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_directions *toward, double *density)
{
    const struct mcr_group *group = &batch->core->group[range->group];
    struct mcr_points at = mcr_batch_points(batch, range->begin, range->end);
    if (!group->plugin->density) {
        memset(density, 0, at.n * sizeof *density);
        return MCR_OK;
    }
    struct mcr_inputs inputs = mcr_group_inputs(batch, group, range->begin);
    struct frame was = enter(batch, group->node, mcr_material_bytes(group, at.n));
    int32_t status = group->plugin->density(&batch->core->host, &batch->context, group->instance, &inputs, &at, toward, density);
    return leave(batch, &was, status);
}

int32_t mcr_group_draw(struct mcr_batch *batch, const struct mcr_range *range, const double *const *number, const struct mcr_directions *out,
                       double *density)
{
    const struct mcr_group *group = &batch->core->group[range->group];
    struct mcr_points at = mcr_batch_points(batch, range->begin, range->end);
    struct mcr_inputs inputs = mcr_group_inputs(batch, group, range->begin);
    struct frame was = enter(batch, group->node, mcr_material_bytes(group, at.n));
    int32_t status = group->plugin->draw(&batch->core->host, &batch->context, group->instance, &inputs, &at, number, out, density);
    return leave(batch, &was, status);
}

int32_t mcr_group_albedo(struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_colours *out)
{
    const struct mcr_group *group = &batch->core->group[range->group];
    struct mcr_points at = mcr_batch_points(batch, range->begin, range->end);
    struct mcr_inputs inputs = mcr_group_inputs(batch, group, range->begin);
    struct frame was = enter(batch, group->node, mcr_material_bytes(group, at.n));
    int32_t status = group->plugin->albedo(&batch->core->host, &batch->context, group->instance, &inputs, &at, out);
    return leave(batch, &was, status);
}

int32_t mcr_group_delta(struct mcr_batch *batch, const struct mcr_range *range, const double *const *number, const struct mcr_directions *out,
                        double *probability, const struct mcr_colours *weight)
{
    const struct mcr_group *group = &batch->core->group[range->group];
    struct mcr_points at = mcr_batch_points(batch, range->begin, range->end);
    struct mcr_inputs inputs = mcr_group_inputs(batch, group, range->begin);
    struct frame was = enter(batch, group->node, mcr_material_bytes(group, at.n));
    int32_t status = group->plugin->delta(&batch->core->host, &batch->context, group->instance, &inputs, &at, number, out, probability, weight);
    return leave(batch, &was, status);
}

/* Adds what the host emits for a layer of the running group, on the sides that do. */
static void add_emission(const struct mcr_batch *batch, const struct mcr_layer *layer, const struct mcr_points *at, const struct mcr_colours *out)
{
    const double *const *channel = batch->channel + layer->emission, *sides = channel[3];
    const uint32_t *stride = batch->stride + layer->emission;
    double *const to[3] = {out->r, out->g, out->b};
    for (int c = 0; c < 3; c++)
        for (uint32_t i = 0; i < at->n; i++) {
            uint32_t does = (uint32_t)sides[i * stride[3]], side = at->side[i] > 0 ? MCR_MATERIAL_EMITS_FRONT : MCR_MATERIAL_EMITS_BACK;
            to[c][i] += does & side ? channel[c][i * stride[c]] : 0;
        }
}

/* What the plugin of a layer emits, if it does, and what the host adds. */
static int32_t layer_emission(struct mcr_batch *batch, const struct mcr_layer *layer, const struct mcr_points *at, const struct mcr_inputs *inputs,
                              const struct mcr_colours *out)
{
    const struct mcr_material_plugin *plugin = material_plugin(layer->node);
    int32_t status = MCR_OK;
    if (plugin->emission) {
        struct frame was = enter(batch, layer->node, layer_bytes(layer->node, at->n));
        status = leave(batch, &was, plugin->emission(&batch->core->host, &batch->context, layer->node->instance, inputs, at, out));
    } else {
        memset(out->r, 0, at->n * sizeof *out->r);
        memset(out->g, 0, at->n * sizeof *out->g);
        memset(out->b, 0, at->n * sizeof *out->b);
    }
    if (!status && layer->emission != UINT32_MAX)
        add_emission(batch, layer, at, out);
    return status;
}

int32_t mcr_group_emission(struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_colours *out)
{
    const struct mcr_group *group = &batch->core->group[range->group];
    struct mcr_points at = mcr_batch_points(batch, range->begin, range->end);
    struct mcr_inputs inputs = mcr_group_inputs(batch, group, range->begin);
    return layer_emission(batch, group->layer, &at, &inputs, out);
}

int32_t mcr_points_emission(struct mcr_batch *batch, const struct mcr_group *group, const struct mcr_points *at, const uint32_t *material,
                            const struct mcr_colours *out)
{
    struct mcr_inputs inputs = mcr_elsewhere_inputs(batch, group, at, material);
    return layer_emission(batch, group->layer, at, &inputs, out);
}

int32_t mcr_points_passes(struct mcr_batch *batch, const struct mcr_group *group, const struct mcr_points *at, const uint32_t *material,
                          const struct mcr_colours *out)
{
    struct mcr_inputs inputs = mcr_elsewhere_inputs(batch, group, at, material);
    struct frame was = enter(batch, group->node, mcr_material_bytes(group, at->n));
    int32_t status = group->plugin->passes(&batch->core->host, &batch->context, group->instance, &inputs, at, out);
    return leave(batch, &was, status);
}

static int32_t source_fill(struct mcr_batch *batch, const struct mcr_node *node, const struct mcr_samples *samples, uint32_t first, uint32_t count,
                           double *const *number)
{
    const struct mcr_numbers_plugin *plugin = (const struct mcr_numbers_plugin *)(const void *)node->descriptor;
    struct frame was = enter(batch, node, plugin->scratch_bytes ? plugin->scratch_bytes(node->instance, samples->n) : 0);
    int32_t status = plugin->fill(&batch->core->host, &batch->context, node->instance, samples, first, count, number);
    return leave(batch, &was, status);
}

int32_t mcr_numbers(struct mcr_batch *batch, const struct mcr_paths *paths, uint32_t begin, uint32_t end, uint32_t first, uint32_t count,
                    double *const *number)
{
    const struct mcr_sampler *sampler = batch->core->scene->sampler;
    struct mcr_samples samples = {.size = sizeof samples,
                                  .n = end - begin,
                                  .pixel_key = paths->pixel_key + begin,
                                  .path_key = paths->path_key + begin,
                                  .index = paths->index + begin,
                                  .planned = paths->planned + begin,
                                  .bounce = paths->bounce + begin,
                                  .x = paths->x ? paths->x + begin : NULL,
                                  .y = paths->y ? paths->y + begin : NULL,
                                  .replicate_key = batch->replicate_key};
    uint32_t done = 0;
    for (uint32_t s = 0; s < sampler->source_count && done < count; s++) {
        const struct mcr_node *node = sampler->source[s];
        const struct mcr_numbers_plugin *plugin = (const struct mcr_numbers_plugin *)(const void *)node->descriptor;
        uint32_t supplied = plugin->supplies(node->instance, first + done, count - done);
        if (!supplied)
            continue;
        if (supplied > count - done)
            return MCR_E_INTERNAL;
        int32_t status = source_fill(batch, node, &samples, first + done, supplied, number + done);
        if (status)
            return status;
        done += supplied;
    }
    return done < count ? source_fill(batch, sampler->independent, &samples, first + done, count - done, number + done) : MCR_OK;
}

/* The deepest the stack can get below this node. */
static uint64_t tree_bytes(const struct mcr_node *node, uint32_t n)
{
    uint64_t below = 0;
    for (uint32_t c = 0; c < node->child_count; c++) {
        uint64_t bytes = tree_bytes(node->child[c], n);
        below = bytes > below ? bytes : below;
    }
    return padded(node_bytes(node, n)) + below;
}

/* The same below a material. */
static uint64_t layers_bytes(const struct mcr_node *node, uint32_t n)
{
    uint64_t below = 0;
    for (uint32_t c = 0; c < node->child_count; c++) {
        uint64_t bytes = layers_bytes(node->child[c], n);
        below = bytes > below ? bytes : below;
    }
    return padded(layer_bytes(node, n)) + below;
}

uint64_t mcr_host_scratch(const struct mcr_core *core)
{
    const struct mcr_sampler *sampler = core->scene->sampler;
    uint64_t most = 0, sources = 0;
    for (uint32_t g = 0; g < core->group_count; g++) {
        uint64_t bytes = layers_bytes(core->group[g].node, core->capacity);
        most = bytes > most ? bytes : most;
    }
    for (uint32_t s = 0; s <= sampler->source_count; s++) {
        const struct mcr_node *node = s < sampler->source_count ? sampler->source[s] : sampler->independent;
        const struct mcr_numbers_plugin *plugin = (const struct mcr_numbers_plugin *)(const void *)node->descriptor;
        uint64_t bytes = plugin->scratch_bytes ? padded(plugin->scratch_bytes(node->instance, core->capacity)) : 0;
        sources = bytes > sources ? bytes : sources;
    }
    return tree_bytes(sampler->directions, core->capacity) + padded(mcr_lights_scratch(core, core->capacity)) + most + sources;
}

void mcr_host_init(struct mcr_core *core)
{
    core->host = (struct mcr_host){.size = sizeof core->host,
                                   .major = MCR_PLUGIN_MAJOR,
                                   .minor = MCR_PLUGIN_MINOR,
                                   .report = report,
                                   .scratch = scratch,
                                   .child_techniques = child_techniques,
                                   .child_draw = child_draw,
                                   .child_density = child_density,
                                   .child_mass = child_mass,
                                   .light_draw = light_draw,
                                   .light_density = light_density,
                                   .light_mass = light_mass,
                                   .light_draw_point = light_draw_point,
                                   .light_density_point = light_density_point,
                                   .material_draw = material_draw,
                                   .material_density = material_density,
                                   .has_lights = has_lights,
                                   .material_child_traits = material_child_traits,
                                   .material_child_evaluate = material_child_evaluate,
                                   .material_child_draw = material_child_draw,
                                   .material_child_density = material_child_density,
                                   .material_child_emission = material_child_emission,
                                   .material_child_delta = material_child_delta,
                                   .material_child_passes = material_child_passes,
                                   .material_child_albedo = material_child_albedo};
}
