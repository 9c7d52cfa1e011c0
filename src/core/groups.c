/* SPDX-License-Identifier: Apache-2.0 */
/* Groups of materials that one call of a plugin can handle, and the tables of surfaces. */
#include "core/groups.h"

#include <math.h>
#include <string.h>

#include "plugin/values.h"

#define SPREADS (MCR_MATERIAL_REFLECTS | MCR_MATERIAL_TRANSMITS)
#define EMITS (MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK)

static const struct mcr_material_plugin *plugin_of(const struct mcr_scene_material *material)
{
    return (const struct mcr_material_plugin *)(const void *)material->node->descriptor;
}

static const struct mcr_scene_material *material_of(const struct mcr_scene *scene, const struct mcr_node *node)
{
    return &scene->material[node->number];
}

/* Whether the material fits the group: the same stateless plugin, doing the same things, with nothing inside. */
static int fits(const struct mcr_group *group, const struct mcr_scene *scene, const struct mcr_scene_material *material)
{
    const struct mcr_scene_material *first = &scene->material[group->first];
    return plugin_of(material) == group->plugin && (group->plugin->flags & MCR_MATERIAL_STATELESS) && first->traits.does == material->traits.does &&
           !first->surface.emits == !material->surface.emits && first->node->child_count == 0 && material->node->child_count == 0;
}

static uint32_t count_nodes(const struct mcr_node *node)
{
    uint32_t count = 1;
    for (uint32_t k = 0; k < node->child_count; k++)
        count += count_nodes(node->child[k]);
    return count;
}

/* Layers of the tree, each before what is inside it; a material that is there twice is two layers. */
static void add_layers(struct mcr_group *group, const struct mcr_scene *scene, const struct mcr_node *node)
{
    struct mcr_layer *layer = &group->layer[group->layer_count++];
    layer->node = node;
    layer->channel = group->channels;
    layer->emission = UINT32_MAX;
    group->channels += 3 * node->descriptor->parameter_count;
    if (material_of(scene, node)->surface.emits) {
        layer->emission = group->channels;
        group->channels += MCR_EMISSION_CHANNELS;
    }
    for (uint32_t k = 0; k < node->child_count; k++)
        add_layers(group, scene, node->child[k]);
}

/* The value of a group's channel for a node in the place of the layer's. */
static double layer_value(const struct mcr_layer *layer, const struct mcr_scene *scene, const struct mcr_node *node, uint32_t channel)
{
    const struct mcr_surface_settings *surface = &material_of(scene, node)->surface;
    if (channel < layer->emission)
        return node->values.number[channel - layer->channel];
    return channel - layer->emission < 3 ? surface->emission[channel - layer->emission] : surface->emits;
}

static int emits(const struct mcr_group *group, const struct mcr_scene *scene)
{
    const struct mcr_scene_material *material = &scene->material[group->first];
    return (material->traits.does & EMITS) && (group->plugin->emission || material->surface.emits);
}

static int group_start(struct mcr_arena *arena, struct mcr_group *group, const struct mcr_scene *scene, uint32_t m)
{
    const struct mcr_scene_material *material = &scene->material[m];
    group->plugin = plugin_of(material);
    group->instance = material->node->instance;
    group->node = material->node;
    group->first = m;
    group->spreads = (material->traits.does & SPREADS) && group->plugin->evaluate;
    group->lobes = (material->traits.does & MCR_MATERIAL_DELTA) != 0;
    group->scatters = group->spreads || group->lobes;
    group->emits = emits(group, scene);
    group->layer = mcr_arena_alloc(arena, count_nodes(material->node), sizeof *group->layer);
    if (!group->layer)
        return -1;
    add_layers(group, scene, material->node);
    group->constant = mcr_arena_alloc(arena, (size_t)group->channels * MCR_LANE_PAD, sizeof(double));
    group->varies = mcr_arena_alloc(arena, group->channels, 1);
    if (!group->constant || !group->varies)
        return -1;
    for (uint32_t l = 0; l < group->layer_count; l++) {
        const struct mcr_layer *layer = &group->layer[l];
        uint32_t end = l + 1 < group->layer_count ? group->layer[l + 1].channel : group->channels;
        for (uint32_t c = layer->channel; c < end; c++)
            for (uint32_t i = 0; i < MCR_LANE_PAD; i++)
                group->constant[c * MCR_LANE_PAD + i] = layer_value(layer, scene, layer->node, c);
    }
    return 0;
}

/* Values by material, for gathering, once there are two. */
static int join(struct mcr_arena *arena, struct mcr_group *group, const struct mcr_scene *scene, uint32_t m)
{
    const struct mcr_layer *layer = group->layer; /* the only one: fits() */
    const struct mcr_node *node = scene->material[m].node;
    if (!group->table) {
        group->table = mcr_arena_alloc(arena, group->channels, sizeof *group->table);
        for (uint32_t c = 0; group->table && c < group->channels; c++) {
            if (!(group->table[c] = mcr_arena_alloc(arena, scene->material_count, sizeof(double))))
                return -1;
            group->table[c][group->first] = group->constant[(size_t)c * MCR_LANE_PAD];
        }
        if (!group->table)
            return -1;
    }
    for (uint32_t c = 0; c < group->channels; c++) {
        group->table[c][m] = layer_value(layer, scene, node, c);
        group->varies[c] |= group->table[c][m] != group->constant[(size_t)c * MCR_LANE_PAD];
    }
    return 0;
}

/* Materials of primitives; those that are only inside others need no group. */
static void mark_used(const struct mcr_scene *scene, uint8_t *used)
{
    for (uint32_t i = 0; i < scene->shape_count; i++)
        used[scene->shape[i].material] = 1;
    for (uint32_t t = 0; t < scene->triangles.count; t++)
        used[scene->triangles.material[t]] = 1;
}

/* The textures of one material in its group; with `list` NULL they are only counted. */
static uint32_t list_textures(struct mcr_group *group, const struct mcr_scene *scene, const struct mcr_node *root, struct mcr_textured *list)
{
    uint32_t count = 0;
    for (uint32_t l = 0; l < group->layer_count; l++) {
        const struct mcr_layer *layer = &group->layer[l];
        const struct mcr_node *node = l == 0 ? root : layer->node;
        const struct mcr_texture *emission = layer->emission != UINT32_MAX ? material_of(scene, node)->surface.emission_texture : NULL;
        for (uint32_t k = 0; node->texture && k < node->descriptor->parameter_count; k++) {
            int colour = mcr_descriptor_parameter(node->descriptor, k)->type == MCR_TYPE_COLOUR;
            if (node->texture[k] && list)
                list[count] = (struct mcr_textured){layer->channel + 3 * k, colour, node->texture[k]};
            count += node->texture[k] != NULL;
        }
        if (emission && list)
            list[count] = (struct mcr_textured){layer->emission, 1, emission};
        count += emission != NULL;
    }
    for (uint32_t i = 0; i < count && list; i++)
        for (uint32_t c = 0; c < (list[i].colour ? 3 : 1); c++)
            group->varies[list[i].channel + c] = 1;
    group->textured |= count > 0;
    return count;
}

static int textures_init(struct mcr_core *core, struct mcr_arena *arena, const uint8_t *used)
{
    const struct mcr_scene *scene = core->scene;
    uint32_t count = 0;
    for (uint32_t m = 0; m < scene->material_count; m++)
        if (used[m])
            count += list_textures(&core->group[core->group_of_material[m]], scene, scene->material[m].node, NULL);
    if (!count)
        return 0;
    core->textured_from = mcr_arena_alloc(arena, (size_t)scene->material_count + 1, sizeof *core->textured_from);
    core->textured = mcr_arena_alloc(arena, count, sizeof *core->textured);
    if (!core->textured_from || !core->textured)
        return -1;
    count = 0;
    for (uint32_t m = 0; m < scene->material_count; m++) {
        core->textured_from[m] = count;
        if (used[m])
            count += list_textures(&core->group[core->group_of_material[m]], scene, scene->material[m].node, core->textured + count);
    }
    core->textured_from[scene->material_count] = count;
    return 0;
}

int mcr_groups_init(struct mcr_core *core, struct mcr_arena *arena)
{
    const struct mcr_scene *scene = core->scene;
    uint8_t *used = mcr_arena_alloc(arena, scene->material_count, 1);
    core->group = mcr_arena_alloc(arena, scene->material_count, sizeof *core->group);
    core->group_of_material = mcr_arena_alloc(arena, scene->material_count, sizeof *core->group_of_material);
    if (!used || !core->group || !core->group_of_material)
        return -1;
    mark_used(scene, used);
    for (uint32_t m = 0; m < scene->material_count; m++) {
        uint32_t g = 0;
        if (!used[m])
            continue;
        while (g < core->group_count && !fits(&core->group[g], scene, &scene->material[m]))
            g++;
        struct mcr_group *group = &core->group[g];
        if (g == core->group_count ? (core->group_count++, group_start(arena, group, scene, m)) : join(arena, group, scene, m))
            return -1;
        core->group_of_material[m] = g;
        core->lobes |= group->lobes;
        group->material_count++;
        core->channels = group->channels > core->channels ? group->channels : core->channels;
    }
    if (textures_init(core, arena, used))
        return -1;
    for (uint32_t g = 0; g < core->group_count; g++)
        for (uint32_t c = 0; c < core->group[g].channels; c++)
            core->varying_elsewhere |= core->group[g].varies[c] &&
                                       (core->group[g].emits || scene->material[core->group[g].first].traits.does & MCR_MATERIAL_PASSES);
    return 0;
}

struct mcr_points mcr_batch_points(const struct mcr_batch *batch, uint32_t begin, uint32_t end)
{
    const struct mcr_surface_points *at = &batch->at;
    return (struct mcr_points){.size = sizeof(struct mcr_points),
                               .n = end - begin,
                               .px = at->px + begin,
                               .py = at->py + begin,
                               .pz = at->pz + begin,
                               .nx = at->nx + begin,
                               .ny = at->ny + begin,
                               .nz = at->nz + begin,
                               .gx = at->gx + begin,
                               .gy = at->gy + begin,
                               .gz = at->gz + begin,
                               .ox = at->ox + begin,
                               .oy = at->oy + begin,
                               .oz = at->oz + begin,
                               .side = at->side + begin,
                               .tx = at->tx ? at->tx + begin : NULL,
                               .ty = at->ty ? at->ty + begin : NULL,
                               .tz = at->tz ? at->tz + begin : NULL,
                               .here = at->here ? at->here + begin : NULL,
                               .beyond = at->here ? at->beyond + begin : NULL};
}

static double norm(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void set_flat(struct mcr_surfaces *s, uint32_t p, const double c[3], const double n[3], double reach, uint32_t material)
{
    s->surface[p] = (struct mcr_surface){.x = n[0], .y = n[1], .z = n[2], .offset = n[0] * c[0] + n[1] * c[1] + n[2] * c[2], .reach = reach};
    s->material[p] = material;
}

/* A box's faces: through its corner or the opposite one, normals outward. */
static void set_box(struct mcr_surfaces *s, const struct mcr_shape *shape, double reach)
{
    for (int axis = 0; axis < 3; axis++) {
        const double *edge = shape->e[axis];
        double n[3], far[3];
        cross(shape->e[(axis + 1) % 3], shape->e[(axis + 2) % 3], n);
        double length = norm(n), outward = n[0] * edge[0] + n[1] * edge[1] + n[2] * edge[2] > 0 ? 1 : -1;
        for (int j = 0; j < 3; j++) {
            n[j] *= -outward / length;
            far[j] = shape->c[j] + edge[j];
        }
        set_flat(s, shape->primitive + 2 * (uint32_t)axis, shape->c, n, reach, shape->material);
        for (int j = 0; j < 3; j++)
            n[j] = -n[j];
        set_flat(s, shape->primitive + 2 * (uint32_t)axis + 1, far, n, reach, shape->material);
    }
}

static void set_shape(struct mcr_surfaces *s, const struct mcr_shape *shape)
{
    double centre = norm(shape->c), size = norm(shape->e[0]) + norm(shape->e[1]) + norm(shape->e[2]);
    switch (shape->kind) {
    case MCR_SHAPE_BOX:
        set_box(s, shape, centre + size);
        break;
    case MCR_SHAPE_SPHERE:
        s->surface[shape->primitive] = (struct mcr_surface){.x = shape->c[0], .y = shape->c[1], .z = shape->c[2], .radius = shape->radius,
                                                            .reach = centre > shape->radius ? centre : shape->radius};
        s->material[shape->primitive] = shape->material;
        s->round = 1;
        break;
    case MCR_SHAPE_PLANE:
        set_flat(s, shape->primitive, shape->c, shape->n, centre, shape->material);
        break;
    default:
        set_flat(s, shape->primitive, shape->c, shape->n, centre + size, shape->material);
    }
}

static void set_triangles(struct mcr_surfaces *s, const struct mcr_triangles *m)
{
    for (uint32_t f = 0; f < m->count; f++) {
        const uint32_t *v = m->vertex[f];
        double a[3] = {m->x[v[0]], m->y[v[0]], m->z[v[0]]}, e[2][3], n[3], reach = norm(a);
        for (int i = 0; i < 2; i++) {
            double p[3] = {m->x[v[i + 1]], m->y[v[i + 1]], m->z[v[i + 1]]};
            reach = norm(p) > reach ? norm(p) : reach;
            for (int j = 0; j < 3; j++)
                e[i][j] = p[j] - a[j];
        }
        cross(e[0], e[1], n);
        double length = norm(n);
        for (int j = 0; j < 3; j++)
            n[j] /= length;
        set_flat(s, m->first_primitive + f, a, n, reach, m->material[f]);
    }
}

int mcr_surfaces_init(struct mcr_core *core, struct mcr_arena *arena)
{
    const struct mcr_scene *scene = core->scene;
    struct mcr_surfaces *s = &core->surfaces;
    s->count = scene->primitive_count;
    s->surface = mcr_arena_alloc(arena, s->count, sizeof *s->surface);
    s->material = mcr_arena_alloc(arena, s->count, sizeof *s->material);
    s->zone = mcr_arena_alloc(arena, (size_t)s->count + 1, sizeof *s->zone);
    if (!s->surface || !s->material || !s->zone)
        return -1;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        set_shape(s, &scene->shape[i]);
        if (scene->shape[i].kind != MCR_SHAPE_ELLIPSOID)
            continue;
        if (!s->quadric) {
            if (!(s->quadric = mcr_arena_alloc(arena, s->count, sizeof *s->quadric)))
                return -1;
            memset(s->quadric, 0xff, s->count * sizeof *s->quadric);
        }
        s->quadric[scene->shape[i].primitive] = i;
    }
    set_triangles(s, &scene->triangles);
    s->smooth = scene->triangles.normal != NULL;
    s->zone[0] = 3 * core->group_count;
    for (uint32_t p = 0; p < s->count; p++) {
        uint32_t g = core->group_of_material[s->material[p]];
        s->zone[p + 1] = core->group[g].scatters ? g : 2 * core->group_count + g;
    }
    return 0;
}
