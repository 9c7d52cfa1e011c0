/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The immutable scene: what the accelerators and the core work on.
 *
 * Render space: the axes of the world, the origin at the camera's position, lengths multiplied by `scale`, a power of two that brings
 * the largest coordinate of the scene into [0.5, 1). Positions are subtracted from the camera's before anything else is computed with
 * them, so that a far origin costs no accuracy. Everything below is in render space unless it says world.
 */
#ifndef MCR_SCENE_SCENE_H
#define MCR_SCENE_SCENE_H

#include "base/arena.h"
#include "base/diag.h"
#include "image/tone.h"
#include "language/tree.h"
#include "plugin/node.h"
#include "plugin/registry.h"
#include "scene/lights.h"
#include "scene/study.h"
#include "scene/texture.h"

enum mcr_shape_kind {
    MCR_SHAPE_PLANE,         /* infinite: c a point, n */
    MCR_SHAPE_SPHERE,        /* c, radius; front outside */
    MCR_SHAPE_ELLIPSOID,     /* c, half axes e[0..2] (any three independent vectors: the image of the unit sphere); front outside */
    MCR_SHAPE_PARALLELOGRAM, /* corner c, edges e[0], e[1]; n along e[0] x e[1] (reversed under a mirroring transform) */
    MCR_SHAPE_DISK,          /* centre c, half axes e[0], e[1] (conjugate, need not be orthogonal); n */
    MCR_SHAPE_BOX            /* corner c, edges e[0..2]; 6 primitives: faces c + [0,1]e_j + [0,1]e_k at 0 and then at 1 of axis 0, 1, 2; front outside */
};

struct mcr_shape {
    uint32_t kind;
    uint32_t primitive; /* its first primitive's number */
    uint32_t material;
    double c[3];
    double e[3][3];
    double n[3];        /* unit, front; plane, parallelogram, disk */
    double radius;
    double axis[3][3];  /* for surface coordinates: sphere: unit vectors, turned with it; plane: the steps of 1 in u and in v, world lengths */
    double uv[2];       /* plane: of c */
    struct mcr_place place;
};

/* All triangles, of meshes and single ones. Primitive number of triangle i: first_primitive + i. */
struct mcr_triangles {
    uint32_t count, first_primitive;
    uint32_t vertex_count, normal_count, uv_count;
    double *x, *y, *z;           /* vertex_count */
    uint32_t (*vertex)[3];       /* count; counter-clockwise seen from the front */
    uint32_t *material;          /* count */
    double *nx, *ny, *nz;        /* normal_count, unit */
    uint32_t (*normal)[3];       /* count, or NULL if no mesh has normals; UINT32_MAX: this triangle has none */
    double *u, *v;               /* uv_count */
    uint32_t (*uv)[3];           /* count, or NULL if no material needs coordinates and no shape gives any */
};

/* What a material asks of the points on its surface. */
#define MCR_NEEDS_COORDINATES 1u /* u and v: it has textures */
#define MCR_NEEDS_TANGENTS 2u    /* its plugin says so, or it has a normal map */
#define MCR_NEEDS_NORMALS 4u     /* shading normals of its own: a normal map or bumps */

/* What a material block may set beside its plugin's parameters: the core does it for every plugin. */
struct mcr_surface_settings {
    uint32_t emits;                              /* MCR_MATERIAL_EMITS_*: the sides that radiate `emission`; 0: none */
    double emission[3];                          /* of a texture the mean */
    const struct mcr_texture *emission_texture;  /* or NULL */
    const struct mcr_texture *normal_map, *bump; /* or NULL */
    double normal_strength;
    double bump_height;                          /* world length */
};

struct mcr_scene_material {
    const char *name;
    struct mcr_place place;
    struct mcr_node *node;                       /* descriptor is a struct mcr_material_plugin */
    struct mcr_material_traits traits;
    uint32_t needs;                              /* MCR_NEEDS_* */
    struct mcr_surface_settings surface;
};

struct mcr_scene_texture {
    const char *name;
    struct mcr_place place;
    struct mcr_texture *texture; /* immutable once the scene is built */
};

enum mcr_camera_kind { MCR_CAMERA_PERSPECTIVE, MCR_CAMERA_ORTHOGRAPHIC, MCR_CAMERA_THIN_LENS };

/*
 * Perspective: a ray through the film point (s, t), s to the right and t up, each 0 at the picture's centre and t = +-1 at the upper and lower
 * edge of the *full* picture, leaves the origin along forward + s * half_height * right + t * half_height * up.
 * Orthographic: it starts at s * half_height * right + t * half_height * up, along forward.
 * Thin lens: as perspective, through the lens point; sharp at focus_distance along forward.
 */
struct mcr_camera {
    uint32_t kind;
    double right[3], up[3], forward[3]; /* orthonormal */
    double half_height;                 /* tan(fov/2), or half the height of the orthographic view in render space */
    double lens_radius;                 /* render space; 0: a pinhole */
    int lens_polar;                     /* compat disk-polar: points of the lens crowd in its middle */
    double focus_distance;              /* render space */
    double world[3];                    /* its position in the world */
};

enum mcr_filter_kind { MCR_FILTER_BOX, MCR_FILTER_TENT, MCR_FILTER_GAUSSIAN, MCR_FILTER_MITCHELL };

struct mcr_film_settings {
    uint32_t width, height;                  /* the full picture */
    uint32_t x0, y0, x1, y1;                 /* the crop that is rendered: x0 <= x < x1, from the top left */
    uint32_t filter;
    double filter_radius;                    /* pixels; box 0.5, tent 1, gaussian (circular cut) 1.5, mitchell 2 */
    double filter_sigma;                     /* gaussian, pixels */
    double filter_b, filter_c;               /* mitchell */
    const double *filter_edge;               /* MCR_MITCHELL_CELLS + 1 for mitchell, whose samples have weights; NULL: all weigh 1 */
    double exposure;                         /* stops, for formats of 8 and 16 bits, as is the tone curve */
    struct mcr_tone tone;
};

enum mcr_precision { MCR_PRECISION_DOUBLE };
enum mcr_accel_kind { MCR_ACCEL_AUTO, MCR_ACCEL_LIST, MCR_ACCEL_BVH };

/* Quirks of the founding study, each of which makes the picture wrong: bits of `compat`. In the order of mcr_compat_name. */
enum {
    MCR_COMPAT_CLAMP = 1,               /* what a bounce hands back is clamped to 1 */
    MCR_COMPAT_BACKGROUND_AT_LIMIT = 2, /* paths that reach the depth limit see the background */
    MCR_COMPAT_DISK_POLAR = 4,          /* points in the disk by r = u */
    MCR_COMPAT_SPHERE_SPHERICAL = 8,    /* points in the sphere by the study's algorithm 5 */
    MCR_COMPAT_FLOOR_SQRT = 16          /* strata: floor(sqrt(spp))^2 samples, divided by spp */
};
#define MCR_COMPAT_COUNT 5u
extern const char *const mcr_compat_name[MCR_COMPAT_COUNT];
#define MCR_COMPAT_TEXT 96u /* bytes that all names take as a text, with its NUL */

/*
 * A list as "clamp, disk-polar" (blanks may be left out), or "none". Returns 0, or -1 with the reason in `error`: what is unknown or named twice.
 * *mask is unchanged then.
 */
int mcr_compat_parse(const char *text, uint32_t *mask, char *error, size_t length);
/* The same list of a mask, in the order of the names; "none" for 0. */
void mcr_compat_text(uint32_t mask, char text[MCR_COMPAT_TEXT]);

struct mcr_render_settings {
    uint32_t spp;           /* >= 1 */
    uint32_t depth;         /* scattering events; 0: emission only */
    uint64_t seed;
    uint32_t threads;       /* 0: all */
    uint32_t replicates;    /* resolved: >= 1, <= spp; 1 for independent numbers */
    uint32_t accel;
    uint32_t precision;
    uint32_t batch;         /* paths in a batch, 0: the default */
    int roulette;           /* on or off */
    uint32_t roulette_from; /* the first bounce (0-based scattering event) at which it may end a path */
    uint32_t compat;        /* MCR_COMPAT_* in force: what finds nothing to act on in this scene is not among them */
    int mis_power;          /* techniques are combined by the power heuristic instead of the balance heuristic */
    double background[3];
    double time;            /* seconds after which it is enough; 0: no such rule */
    double target_error;    /* relative error at which it is enough; 0: no such rule */
    int adaptive;           /* more samples where more noise is */
    uint32_t floor;         /* then: samples of each pixel at least */
    int mapped;             /* a sample map says how many samples each pixel has */
    uint32_t round;         /* samples of a round, where one of these is in force */
    uint32_t limit;         /* spp where it limits these: the mean over the picture at most; 0: they have no limit */
    uint32_t least_rounds;  /* `replicates` where it is set, else 1 */
};

/* Whether rounds of samples are rendered as needed, instead of spp samples of every pixel. */
static inline int mcr_render_in_rounds(const struct mcr_render_settings *render)
{
    return render->time > 0 || render->target_error > 0 || render->adaptive || render->mapped;
}

/* A picture that the scene was read from beside its texts. */
struct mcr_scene_file {
    const char *path;
    const struct mcr_scene_file *earlier;
};

struct mcr_scene {
    struct mcr_arena *arena;
    const char *path;
    const struct mcr_scene_file *files; /* the last one, or NULL */
    uint64_t hash;
    double scale;                /* render length = world length * scale */
    struct mcr_camera camera;
    struct mcr_film_settings film;
    struct mcr_render_settings render;
    struct mcr_sampler *sampler;
    uint32_t material_count;
    struct mcr_scene_material *material;
    uint32_t texture_count;
    struct mcr_scene_texture *texture;
    uint32_t shape_count;
    struct mcr_shape *shape;
    struct mcr_triangles triangles;
    uint32_t primitive_count;    /* of shapes and triangles together, at most 2^31 - 1 */
    uint32_t dropped;            /* degenerate triangles of meshes, left out */
    uint32_t light_count;        /* point, spot and sun, in the order of the text */
    struct mcr_scene_light *light;
    const struct mcr_environment *environment; /* NULL: there is none */
    int has_lights;              /* bounded shapes emit, or there is a sun with an extent or an environment that is not black */
    struct mcr_place sampler_place;
    int sampler_chosen;          /* by the program, since neither the scene nor the command line names one */
    const struct mcr_scene_study *study; /* NULL where nothing asks for one */
};

/* What the command line says over the scene. Members are in force where their `has_` is set or their pointer is not NULL. */
struct mcr_overrides {
    int has_spp, has_depth, has_seed, has_threads, has_size, has_crop, has_accel, has_batch, has_roulette, has_replicates, has_compat;
    int roulette;
    uint32_t replicates, compat;
    uint32_t spp, depth, threads, width, height, crop[4], accel, batch;
    uint64_t seed;
    const char *sampler; /* an expression */
    const char *tone;    /* an expression */
    int has_exposure;
    double exposure;
    const struct mcr_study_texts *study; /* NULL: a block `study` is judged if there is one */
    int has_roulette_from;
    uint32_t roulette_from;
    uint32_t layer_bytes; /* a pixel, that layers of features take: count for the film's memory */
    int has_time, has_target_error, has_adaptive, has_floor, has_round;
    double time, target_error; /* 0: off */
    int adaptive;
    uint32_t floor, round;
    int mapped;           /* there is a sample map: `spp` and the rules of the scene are passed over */
    int plain;            /* spp samples of every pixel, whatever else the scene says */
    int channel_variance; /* the film is to keep the channels' variances: counts for its memory */
};

/*
 * Builds the scene of a tree. Everything that is wrong is recorded, as much as can be found in one run; NULL after an error.
 * The scene lives in `arena` (the tree's) and ends with mcr_scene_destroy.
 */
struct mcr_scene *mcr_scene_build(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, struct mcr_registry *registry,
                                  const struct mcr_item *root, const struct mcr_overrides *overrides);
/* Destroys plugin instances; the arena stays. NULL is allowed. */
void mcr_scene_destroy(struct mcr_scene *scene);

#endif
