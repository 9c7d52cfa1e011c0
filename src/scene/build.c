/* SPDX-License-Identifier: Apache-2.0 */
/* The tree of a scene file becomes an immutable scene: the order of the work, room for the geometry, and groups. */
#include "scene/build.h"
#include "scene/texture_table.h"
#include "scene/vector.h"

#define ROLE(role) (1u << (role))
#define SHAPES (ROLE(MCR_BLOCK_SHAPE) | ROLE(MCR_BLOCK_GROUP) | ROLE(MCR_BLOCK_LIGHT))

void *mcr_build_alloc(struct mcr_build *build, uint64_t count, size_t size)
{
    void *memory = count <= SIZE_MAX ? mcr_arena_alloc(build->arena, (size_t)count, size) : NULL;
    if (!memory && !build->short_of_memory) {
        mcr_error(build, (struct mcr_place){ 0 }, "not enough memory for the scene");
        build->short_of_memory = 1;
    }
    return memory;
}

void mcr_build_file(struct mcr_build *build, const char *path, uint64_t hash)
{
    struct mcr_scene_file *file = mcr_build_alloc(build, 1, sizeof *file);
    if (file) {
        *file = (struct mcr_scene_file){ path, build->scene->files };
        build->scene->files = file;
    }
    build->scene->hash = (build->scene->hash ^ hash) * 1099511628211u; /* FNV-1a once more */
}

const char *mcr_build_path(struct mcr_build *build, const char *path, struct mcr_place place)
{
    const char *slash = place.source ? strrchr(place.source->name, '/') : NULL;
    size_t folder = slash ? (size_t)(slash - place.source->name) + 1 : 0, length = strlen(path);
    char *whole;
    if (!folder || path[0] == '/')
        return path;
    whole = mcr_build_alloc(build, folder + length + 1, 1);
    if (!whole)
        return NULL;
    memcpy(whole, place.source->name, folder);
    memcpy(whole + folder, path, length + 1);
    return whole;
}

/* Counts what a list of items can make at most. Nesting is bounded by the parser (MCR_NESTING_LIMIT). */
static uint64_t count_shapes(struct mcr_build *build, const struct mcr_item *item, uint32_t count)
{
    uint64_t shapes = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct mcr_block_word *word = item[i].is_block ? mcr_scene_block(item[i].word, NULL) : NULL;
        if (!word || !(SHAPES & ROLE(word->role)))
            continue;
        if (word->role == MCR_BLOCK_GROUP) {
            shapes += count_shapes(build, item[i].item, item[i].count);
            continue;
        }
        shapes++;
        if (strcmp(word->word, "mesh") == 0) {
            mcr_build_mesh_room(build, &item[i]);
        } else {
            /* Two triangles and four uv for a quad with any corners; three normals and uv for a single triangle. */
            uint64_t triangles = strcmp(word->word, "quad") == 0 ? 2 : strcmp(word->word, "triangle") == 0 ? 1 : 0;
            build->triangle_room += triangles;
            build->vertex_room += triangles ? 2 + triangles : 0;
            build->normal_room += triangles == 1 ? 3 : 0;
            build->uv_room += triangles ? 2 + triangles : 0;
        }
    }
    return shapes;
}

static int has_setting(const struct mcr_item *item, uint32_t count, const char *word)
{
    for (uint32_t i = 0; i < count; i++)
        if (item[i].is_block ? has_setting(item[i].item, item[i].count, word) : strcmp(item[i].word, word) == 0)
            return 1;
    return 0;
}

/* Room for all shapes; -1 after an error. */
static int make_room(struct mcr_build *build, const struct mcr_item *root)
{
    struct mcr_scene *scene = build->scene;
    struct mcr_triangles *t = &scene->triangles;
    uint64_t shapes = count_shapes(build, root->item, root->count);
    build->uv_room += 3; /* plain_uv */
    if (shapes > INT32_MAX || build->triangle_room > INT32_MAX || build->vertex_room >= UINT32_MAX || build->normal_room >= UINT32_MAX ||
        build->uv_room >= UINT32_MAX) {
        mcr_error(build, (struct mcr_place){ 0 }, "the scene has %llu shapes and up to %llu triangles, at most %d surfaces are allowed",
                  (unsigned long long)shapes, (unsigned long long)build->triangle_room, INT32_MAX);
        return -1;
    }
    scene->shape = mcr_build_alloc(build, shapes, sizeof *scene->shape);
    t->x = mcr_build_alloc(build, build->vertex_room, sizeof *t->x);
    t->y = mcr_build_alloc(build, build->vertex_room, sizeof *t->y);
    t->z = mcr_build_alloc(build, build->vertex_room, sizeof *t->z);
    t->vertex = mcr_build_alloc(build, build->triangle_room, sizeof *t->vertex);
    t->material = mcr_build_alloc(build, build->triangle_room, sizeof *t->material);
    if (has_setting(root->item, root->count, "normals")) {
        t->nx = mcr_build_alloc(build, build->normal_room, sizeof *t->nx);
        t->ny = mcr_build_alloc(build, build->normal_room, sizeof *t->ny);
        t->nz = mcr_build_alloc(build, build->normal_room, sizeof *t->nz);
        t->normal = mcr_build_alloc(build, build->triangle_room, sizeof *t->normal);
    }
    if (build->needs || has_setting(root->item, root->count, "uv")) {
        t->u = mcr_build_alloc(build, build->uv_room, sizeof *t->u);
        t->v = mcr_build_alloc(build, build->uv_room, sizeof *t->v);
        t->uv = mcr_build_alloc(build, build->triangle_room, sizeof *t->uv);
    }
    if (build->short_of_memory)
        return -1;
    if (build->needs) {
        build->plain_uv = mcr_build_add_uv(build, 0, 0);
        mcr_build_add_uv(build, 1, 0);
        mcr_build_add_uv(build, 0, 1);
    }
    return 0;
}

static void build_item(struct mcr_build *build, const struct mcr_item *item, const struct mcr_transform *transform);

static void build_group(struct mcr_build *build, const struct mcr_item *block, const struct mcr_transform *transform)
{
    struct mcr_transform own = *transform;
    struct mcr_settings settings;
    mcr_settings_match(build, block, mcr_scene_block("group", NULL), SHAPES, &settings);
    if (settings.transform && mcr_build_transform(build, settings.transform, &own) != 0)
        own = *transform; /* go on for the sake of further mistakes */
    for (uint32_t i = 0; i < block->count; i++)
        build_item(build, &block->item[i], &own);
}

/* Builds a shape, a light or a group and passes over everything else, which was judged where it stands. */
static void build_item(struct mcr_build *build, const struct mcr_item *item, const struct mcr_transform *transform)
{
    const struct mcr_block_word *word = item->is_block ? mcr_scene_block(item->word, NULL) : NULL;
    if (word && word->role == MCR_BLOCK_SHAPE)
        mcr_build_shape(build, item, transform);
    else if (word && word->role == MCR_BLOCK_GROUP)
        build_group(build, item, transform);
    else if (item->is_block && strcmp(item->word, "light") == 0)
        mcr_build_light(build, item, transform);
}

void mcr_build_geometry(struct mcr_build *build, const struct mcr_item *root, const struct mcr_transform *to_camera)
{
    if (make_room(build, root) != 0 || mcr_build_light_room(build, root) != 0)
        return;
    for (uint32_t i = 0; i < root->count; i++)
        build_item(build, &root->item[i], to_camera);
}

/* The one block of this word; others are errors. NULL if there is none. */
static const struct mcr_item *single(struct mcr_build *build, const struct mcr_item *root, const char *word)
{
    const struct mcr_item *first = NULL;
    for (uint32_t i = 0; i < root->count; i++) {
        const struct mcr_item *item = &root->item[i];
        if (!item->is_block || strcmp(item->word, word) != 0)
            continue;
        if (!first) {
            first = item;
            continue;
        }
        mcr_error(build, item->place, "a second '%s', a scene has one", word);
        mcr_report(build->diagnostics, MCR_NOTE, first->place, "the first is here");
    }
    return first;
}

static void build_all(struct mcr_build *build, const struct mcr_item *root)
{
    const uint32_t top = SHAPES | ROLE(MCR_BLOCK_CAMERA) | ROLE(MCR_BLOCK_FILM) | ROLE(MCR_BLOCK_RENDER) | ROLE(MCR_BLOCK_MATERIAL) |
                         ROLE(MCR_BLOCK_TEXTURE) |
                         ROLE(MCR_BLOCK_STUDY);
    const struct mcr_item *camera = single(build, root, "camera");
    struct mcr_transform to_camera;
    for (uint32_t i = 0; i < root->count; i++)
        mcr_block_role(build, &root->item[i], top, "at the top of a scene");
    if (camera)
        build->camera_place = camera->place;
    else if (!root->damaged)
        mcr_error(build, root->place,
                  "the scene needs a camera, expected for example camera perspective { from (0, 0, 5) to (0, 0, 0) fov 40 }");
    mcr_build_camera(build, camera);
    mcr_build_film(build, single(build, root, "film"));
    mcr_build_render(build, single(build, root, "render"));
    mcr_build_film_in_rounds(build);
    mcr_build_textures(build, root);
    if (build->short_of_memory)
        return;
    mcr_build_materials(build, root);
    if (build->short_of_memory)
        return;
    mcr_transform_init(&to_camera, build->scene->camera.world);
    mcr_build_geometry(build, root, &to_camera);
    mcr_build_unused_materials(build);
    mcr_build_unused_textures(build);
    mcr_build_light_names(build);
    if (build->short_of_memory)
        return;
    mcr_build_lights(build);
    if (mcr_diagnostics_errors(build->diagnostics) == 0)
        mcr_build_render_space(build);
    mcr_build_sampler(build);
    mcr_build_study(build, single(build, root, "study"));
}

struct mcr_scene *mcr_scene_build(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, struct mcr_registry *registry,
                                  const struct mcr_item *root, const struct mcr_overrides *overrides)
{
    struct mcr_build build = { .arena = arena, .diagnostics = diagnostics, .registry = registry, .overrides = overrides };
    build.scene = mcr_build_alloc(&build, 1, sizeof *build.scene);
    if (!build.scene)
        return NULL;
    build.scene->arena = arena;
    build.scene->path = root->place.source ? root->place.source->name : "";
    build.scene->hash = mcr_parse_hash(root);
    build_all(&build, root);
    if (mcr_diagnostics_errors(diagnostics) == 0)
        return build.scene;
    mcr_scene_destroy(build.scene);
    return NULL;
}

void mcr_scene_destroy(struct mcr_scene *scene)
{
    if (!scene)
        return;
    mcr_sampler_destroy(scene->sampler);
    for (uint32_t i = 0; i < scene->material_count; i++)
        if (scene->material[i].node)
            mcr_material_destroy(scene->material[i].node);
    for (uint32_t i = 0; i < scene->texture_count; i++)
        if (scene->texture[i].texture)
            mcr_texture_release(scene->texture[i].texture);
    scene->sampler = NULL;
    scene->texture_count = 0;
    scene->material_count = 0;
}
