/* SPDX-License-Identifier: Apache-2.0 */
/* What the files of the scene builder share. Private to src/scene and its tests. */
#ifndef MCR_SCENE_BUILD_H
#define MCR_SCENE_BUILD_H

#include "image/pixels.h"
#include "plugin/values.h"
#include "scene/scene.h"
#include "scene/transform.h"
#include "scene/words.h"

struct mcr_build {
    struct mcr_arena *arena;
    struct mcr_diagnostics *diagnostics;
    struct mcr_registry *registry;
    const struct mcr_overrides *overrides;
    struct mcr_scene *scene;
    int short_of_memory;                   /* told once */

    struct mcr_named_material {
        const char *name;
        uint32_t number;
    } *sorted;                             /* materials by name */
    const char **names;                    /* the same, for suggestions */
    uint8_t *used;                         /* by material */
    const struct mcr_item **material_block; /* by material */
    uint8_t *material_state;               /* by material: how far it is made, enum of materials.c */
    uint32_t material_depth;               /* materials that are being made, one inside the other */

    struct mcr_named_texture {
        const char *name;
        uint32_t number;
    } *textures;                           /* by name */
    const char **texture_names;            /* the same, for suggestions */
    uint8_t *texture_used;                 /* by texture */
    uint64_t texture_memory, texture_bytes; /* what pictures may take and what they take */

    struct mcr_named_light {
        const char *name;
        struct mcr_place place;
        uint32_t number;
    } *named_lights;                       /* in the order of the text, then by name */
    uint32_t named_light_count;

    uint64_t vertex_room, triangle_room, normal_room, uv_room;
    uint32_t needs;                        /* MCR_NEEDS_* of all materials: triangles without coordinates are given some */
    uint32_t plain_uv;                     /* the first of 3 coordinates for them: (0, 0), (1, 0), (0, 1) */
    int planes_emit;                       /* a plane's material emits */
    struct mcr_place plane_place;          /* of the first such plane */
    double extent;                         /* the largest coordinate relative to the camera, world units */

    const struct mcr_value *sampler;       /* expression, or NULL */
    uint32_t replicates;                   /* as set, 0 if not */
    struct mcr_place replicates_place, compat_place, floor_place;
    int floor_said;                        /* the floor of `adaptive` is not the default one */
    struct mcr_place camera_place;
};

#define mcr_error(build, place, ...) mcr_report((build)->diagnostics, MCR_ERROR, place, __VA_ARGS__)

/* Zeroed memory of the scene; NULL after an error that was recorded. */
void *mcr_build_alloc(struct mcr_build *build, uint64_t count, size_t size);

/* A picture was read, whose bytes have this hash: another picture is another scene. */
void mcr_build_file(struct mcr_build *build, const char *path, uint64_t hash);

/*
 * A file name as seen from the folder of the text that names it, as in `include`; from the current one where an option does, which has no source.
 * NULL after an error.
 */
const char *mcr_build_path(struct mcr_build *build, const char *path, struct mcr_place place);

/* ---- settings.c: which word means what ---- */

/* The values of a block in the order of its table; NULL where not given. */
struct mcr_settings {
    const struct mcr_block_word *word;
    const char *of; /* the block's word, for messages */
    struct mcr_place place;
    int damaged;    /* something of it could not be read: what is missing may have been there */
    uint32_t misspelt; /* bits: words that an unknown one was taken for */
    const struct mcr_value *value[MCR_SETTINGS_LIMIT];
    struct mcr_place key[MCR_SETTINGS_LIMIT]; /* of the setting's word */
    const struct mcr_item *transform;
};

/*
 * Sorts what a block holds by its table. Unknown words, doubles, missing ones and blocks in the place of settings are errors.
 * `inside`: roles (1 << enum mcr_block_role) of blocks that are allowed inside, which are left to the caller.
 * Returns 0, or -1 if something was wrong; what was good is filled in all the same.
 */
int mcr_settings_match(struct mcr_build *build, const struct mcr_item *block, const struct mcr_block_word *word, uint32_t inside,
                       struct mcr_settings *settings);
/* The same for the arguments of a call. */
int mcr_settings_match_call(struct mcr_build *build, const struct mcr_value *call, const struct mcr_block_word *word,
                            struct mcr_settings *settings);
/* Records "unknown WHAT 'word' of 'of'" with what was expected (a list of words) and the nearest of them. */
void mcr_unknown_word(struct mcr_build *build, struct mcr_place place, const char *what, const char *word, const char *of,
                      const char *const *words, uint32_t count);
/* The role of a block that is allowed here (a mask of 1 << role), or -1 after an error. `where`: "at the top of a scene", "in a group". */
int mcr_block_role(struct mcr_build *build, const struct mcr_item *block, uint32_t allowed, const char *where);

/* ---- read.c: values of settings ---- */

/* Each reads setting `index`; all return 0 if it is there and right, 1 if it is not given (out gets the default), -1 after an error. */
int mcr_read_number(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, double *out);
int mcr_read_colour(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, double out[3]);
int mcr_read_vector(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, double out[3]);
int mcr_read_whole(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, uint32_t count, uint32_t *out);
/* `count` tuples of `width` numbers each into out[count * width]. */
int mcr_read_tuples(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, uint32_t count, uint32_t width,
                    double *out);
/*
 * `value` as a tuple of `width` numbers of magnitude at most `limit`; `form` says what was expected where it is something else.
 * Returns 0, or -1 after an error.
 */
int mcr_read_numbers(struct mcr_build *build, const struct mcr_value *value, const char *name, const char *of, const char *form,
                     uint32_t width, double limit, double *out);
/* The items of a list of tuples, also where the list has one item only and its parentheses stand for nothing. -1 after an error. */
int mcr_read_list(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, const struct mcr_value **item,
                  uint32_t *count);
/* compat.c: the quirks that setting `index` names; 0 if it is not given. Mistakes are recorded. */
uint32_t mcr_read_compat(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index);
/* Records that `value` is of another kind than `form` says. Returns -1. */
int mcr_wrong_kind(struct mcr_build *build, const struct mcr_value *value, const char *name, const char *of, const char *form);
/* "0.5", "a tuple of 2", ... */
const char *mcr_value_described(const struct mcr_value *value, char text[80]);

/* ---- the blocks ---- */

/* block NULL: only defaults. */
void mcr_build_camera(struct mcr_build *build, const struct mcr_item *block);
void mcr_build_film(struct mcr_build *build, const struct mcr_item *block);
/* After `render`: whether the film's memory is enough for rounds, too. */
void mcr_build_film_in_rounds(struct mcr_build *build);
void mcr_build_render(struct mcr_build *build, const struct mcr_item *block);
/* After everything else: needs has_lights. */
void mcr_build_sampler(struct mcr_build *build);

/* study.c: last of all, as it makes samplers; block NULL: only what options ask for. */
void mcr_build_study(struct mcr_build *build, const struct mcr_item *block);
/* Makes a sampler as a trial, as the scene would have it for so many samples. Its expression in normal form, without what `compat` fills in;
 * NULL after an error. */
const char *mcr_build_try_sampler(struct mcr_build *build, const struct mcr_value *expression, uint32_t spp);

void mcr_build_materials(struct mcr_build *build, const struct mcr_item *root);
/* The number of the material that a shape names; -1 after an error. */
int64_t mcr_build_find_material(struct mcr_build *build, const struct mcr_settings *settings);
void mcr_build_unused_materials(struct mcr_build *build);

/* textures.c: before materials, which name them. */
void mcr_build_textures(struct mcr_build *build, const struct mcr_item *root);
/* The texture that a value of kind MCR_VALUE_NAME names, which counts as used from here on; NULL after an error. In a scene with errors
 * its colours may be all 0. */
const struct mcr_texture *mcr_build_find_texture(struct mcr_build *build, const struct mcr_value *value);
/* Whether there is a texture of this name; nothing is told, and it is not used by that. */
int mcr_build_is_texture(const struct mcr_build *build, const char *name);
/* texture_image.c: the settings of one that is a picture. */
void mcr_build_image(struct mcr_build *build, const struct mcr_settings *settings, struct mcr_texture *texture);
/* The words of `colour`, of textures and of the environment, and what they make of a file: enum mcr_transfer. */
enum { MCR_COLOUR_AUTO, MCR_COLOUR_LINEAR, MCR_COLOUR_SRGB };
uint32_t mcr_build_transfer(uint32_t colour, const struct mcr_pixels *pixels);
/* After all that may name textures. */
void mcr_build_unused_textures(struct mcr_build *build);

/* All shapes and groups of the root block. */
void mcr_build_geometry(struct mcr_build *build, const struct mcr_item *root, const struct mcr_transform *to_camera);
/* One shape, moved by `transform` into the camera's frame, still in world units. */
void mcr_build_shape(struct mcr_build *build, const struct mcr_item *block, const struct mcr_transform *transform);
void mcr_build_quad(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform, uint32_t material);
void mcr_build_triangle(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                        uint32_t material);
void mcr_build_mesh(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform, uint32_t material);
/* Upper bounds for the arrays of triangles that a mesh needs. */
void mcr_build_mesh_room(struct mcr_build *build, const struct mcr_item *block);
/* A new shape with kind, material and place set. */
struct mcr_shape *mcr_build_new_shape(struct mcr_build *build, const struct mcr_settings *settings, uint32_t kind, uint32_t material);
/*
 * A triangle of vertices, normals (NULL: none) and uv (NULL: none) already stored. Mirrored ones swap their winding.
 * Returns 0 and leaves it out if it has no area.
 */
int mcr_build_add_triangle(struct mcr_build *build, uint32_t material, int mirrored, const uint32_t vertex[3], const uint32_t normal[3],
                           const uint32_t uv[3]);
/* Stores a pair of surface coordinates; returns its number. */
uint32_t mcr_build_add_uv(struct mcr_build *build, double u, double v);
/* Stores a vertex; returns its number. One that is too far out is an error at `place`. */
uint32_t mcr_build_add_vertex(struct mcr_build *build, const double at[3], const char *of, struct mcr_place place);

/* lights.c: room for the lights of a scene; -1 after an error. */
int mcr_build_light_room(struct mcr_build *build, const struct mcr_item *root);
/* One block `light NAME KIND { ... }`, moved by `transform` into the camera's frame, still in world units. */
void mcr_build_light(struct mcr_build *build, const struct mcr_item *block, const struct mcr_transform *transform);
/* After all lights: two of one name are an error. */
void mcr_build_light_names(struct mcr_build *build);
/* Whether an environment or a sun with an extent gives light. */
int mcr_build_sky_emits(const struct mcr_scene *scene);

/* After all shapes: has_lights, planes_emit. Every shape's material exists, or there were errors. */
void mcr_build_lights(struct mcr_build *build);
/* After all shapes, none of which is wrong: primitive numbers, the extent, the scale, and everything multiplied by it. */
void mcr_build_render_space(struct mcr_build *build);

#endif
