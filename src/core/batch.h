/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A thread's batch of paths, and the table of stages that work on it. Private to src/core.
 *
 * Two orders of lanes alternate. *Rays* 0 .. rays-1 are what is traced; ray j belongs to the path state in lane source[j]. After the hits are known,
 * `sort` lists the rays that go on by *group* (a material plugin, or one material of it), each group beginning at a multiple of MCR_LANE_PAD, and
 * `surface` gathers them into points in that order. Everything up to `compact`, which makes rays of the living points, works on points.
 * The states of new camera paths are appended behind those of the points; arrays have room for both.
 */
#ifndef MCR_CORE_BATCH_H
#define MCR_CORE_BATCH_H

#include "accel/accel.h"
#include "base/lanes.h"
#include "core/core.h"
#include "core/emitters.h"
#include "core/features.h"
#include "core/point_lights.h"
#include "core/sky.h"

/*
 * A ray starts off its surface, on the side it leaves to, by MCR_OFFSET max(|p|, |o|, |c|, R): p the point, o the origin of the ray that found it,
 * c and R the shape's centre and radius. The point is off its surface along the normal by at most about 4 u of that maximum after the projection in
 * the surface stage (3 for the dot product and its difference, 1 for the subtraction); the kernels' numerators n.(c - o) err by 4 u of it, and the
 * sphere's |f|^2 - R^2 by 4 u R^2, which is 2 u R of distance. 16 u is twice their sum.
 */
#define MCR_OFFSET (16 * 0x1p-53)

#define MCR_NUMBERS_MAX 16u /* dimensions of a sampler's nodes at one bounce */
#define MCR_JOB_SLOTS 4096u /* samples in flight for one job: cells of up to MCR_CELL_SAMPLES */
#define MCR_JOBS 8u /* jobs that a batch may have in flight: more than one, so that the last paths of a job do not keep lanes empty */
#define MCR_DIMENSION_LENS 2u
#define MCR_DIMENSION_SAMPLER 8u
#define MCR_DIMENSION_MATERIAL 28u /* of bounce 0: 8 + 20 */
#define MCR_DIMENSION_LIGHT 24u    /* of bounce 0: 8 + 16 */
#define MCR_DIMENSION_ROULETTE 32u /* of bounce 0: 8 + 24 */

/* A path's state, apart from where it is. */
struct mcr_paths {
    double *r, *g, *b;      /* throughput */
    uint64_t *pixel_key, *path_key;
    uint32_t *index, *planned; /* the sample's number in its replicate, and how many are planned */
    uint32_t *x, *y;        /* the pixel; NULL unless core->needs_pixel */
    uint32_t *bounce;       /* scattering events so far */
    uint32_t *slot;         /* where its radiance goes, in the ring of slots */
    double *width, *spread; /* its pixel's footprint: diameter, and how that grows with the way; NULL without surface coordinates */
    uint32_t *inside[MCR_INTERIORS]; /* material + 1, in the order of entering, then 0; NULL from core->interiors on */
};

/* A primitive's surface, in one cache line, since primitives are looked up at random. All but spheres and ellipsoids are flat. */
struct mcr_surface {
    double x, y, z;         /* the normal; of a sphere the centre */
    double offset;          /* flat: n.c, c a point of it */
    double radius;          /* of a sphere, else 0 */
    double reach;           /* max(|c|, R) of the shape: the magnitudes that its hits were computed with */
    double padding[2];
};

/* Surface properties by primitive, for gathering. */
struct mcr_surfaces {
    uint32_t count;
    int round;              /* there are spheres */
    struct mcr_surface *surface;
    uint32_t *material;
    uint32_t *zone;         /* of primitive p in zone[p + 1], and of a miss in zone[0]: see sort.c */
    uint32_t *quadric;      /* an ellipsoid's index among the accelerator's shapes, or UINT32_MAX; NULL without ellipsoids */
    int smooth;             /* triangles have normals of their own */
};

/*
 * Surface coordinates, by primitive of a shape; where nothing needs them (needs is 0) there are no tables. On flat shapes
 * u = gu.(p - c) + u0; triangles are computed from their corners.
 */
struct mcr_charts {
    uint32_t needs;         /* MCR_NEEDS_* of the materials of primitives */
    uint32_t count;         /* primitives of shapes */
    double *c[3];           /* anchor; of round shapes the centre */
    double *gu[3], *gv[3];  /* gradients, 1 / render length; 0 for round shapes */
    double *u0, *v0;
    double (*local)[9];     /* spheres and ellipsoids: rows of the map onto the unit sphere; NULL without them */
};

/* Points whose surface coordinates are asked for. */
struct mcr_chart_lanes {
    uint32_t n;
    const int64_t *primitive;
    const double *px, *py, *pz, *gx, *gy, *gz, *ox, *oy, *oz; /* as in struct mcr_points */
    double *u, *v;
    double *width;          /* of the footprint: comes as a diameter in render space, goes as one in units of u and v */
    double *gu[3], *gv[3];  /* gradients of u and v along the surface */
};

/* A parameter that is a texture, of one material. */
struct mcr_textured {
    uint32_t channel;               /* of the group's */
    int colour;                     /* three channels, else a number in one */
    const struct mcr_texture *texture;
};

/*
 * A material of a group's tree and where its inputs are: the group's own material first, then those inside it. The channels of a node are those of its
 * parameters, followed by what the host adds to its emission: red, green, blue, and the sides (MCR_MATERIAL_EMITS_*) as a number.
 */
struct mcr_layer {
    const struct mcr_node *node;    /* the first material's */
    uint32_t channel;               /* the first of 3 * parameters */
    uint32_t emission;              /* the first of 4, or UINT32_MAX: the host adds nothing */
};
#define MCR_EMISSION_CHANNELS 4u

/* What one call of a material plugin is for: a stateless plugin with all its materials, or one material. */
struct mcr_group {
    const struct mcr_material_plugin *plugin;
    const void *instance;
    const struct mcr_node *node;    /* the first material's */
    uint32_t material_count;        /* how many materials are in it */
    uint32_t first;                 /* one of them */
    int scatters, emits;
    int spreads, lobes;             /* what scatters: directions with a density, mirror-like lobes */
    uint32_t layer_count;
    struct mcr_layer *layer;
    uint32_t channels;              /* of all layers */
    double *constant;               /* channels * MCR_LANE_PAD: each value MCR_LANE_PAD times; of the first material */
    double **table;                 /* channels arrays of scene->material_count values, where the group has several materials; else NULL */
    uint8_t *varies;                /* channels: whether the group's materials differ in it, or one has a texture there */
    int textured;                   /* one has */
};

/* What crossing.c has to know of a material. */
struct mcr_interior {
    int passes, bounds, absorbs;
    double index, priority;
    double attenuation[3];          /* 1 / render length */
};

/* Bytes of the tables, by what they are for. */
struct mcr_core_tables {
    uint64_t surfaces; /* groups and textures' places too */
    uint64_t emitters, charts, crossing, sky, points;
};

/* What all threads share: immutable during a pass. */
struct mcr_core {
    const struct mcr_scene *scene;
    const struct mcr_accel *accel;
    const struct mcr_accel_functions *trace;
    const struct mcr_stages *stages;
    const struct mcr_light_functions *looks;
    struct mcr_emitters *emitters;
    const struct mcr_emitter_functions *lights;
    const struct mcr_sky *sky;      /* NULL: nothing but the background comes from infinitely far */
    const struct mcr_sky_functions *sky_functions;
    int32_t sky_emitter;            /* its number as an emitter, or -1 */
    double sky_share;               /* the probability with which it is chosen */
    const struct mcr_point_lights *point_lights; /* NULL: there are none */
    struct mcr_surfaces surfaces;
    struct mcr_charts charts;
    uint32_t group_count;
    struct mcr_group *group;
    uint32_t *group_of_material;
    uint32_t *textured_from;        /* by material: textured[textured_from[m]] .. textured[textured_from[m + 1] - 1]; NULL: nothing is textured */
    struct mcr_textured *textured;
    int varying_elsewhere;          /* the inputs of some that emit or pass are not the same everywhere */
    uint32_t interiors;             /* that a path remembers being in; 0 where no material has one */
    int crosses;                    /* one has, or lets light pass */
    struct mcr_interior *interior;  /* by material, where something crosses */
    uint32_t camera_inside[MCR_INTERIORS];
    uint32_t capacity;              /* rays in a batch */
    uint32_t channels;              /* most of any group */
    uint32_t dimensions;            /* of the sampler's techniques, one bounce */
    uint32_t continuing;            /* the sampler's technique that continues paths */
    int combines;                   /* it has more than one technique */
    int lobes;                      /* some group has mirror-like lobes */
    int32_t control;                /* the technique whose light comes in closed form where it is known, or -1: see control.h */
    double (*controllable)[4];      /* by emitter, and one more for none: where it is (MCR_K_C), and its area where it can, else -1 */
    int background;                 /* it is not black, or there is a sky */
    uint32_t features;              /* MCR_FEATURE_*, 0: none */
    uint64_t scratch_bytes;         /* for all nested operations of one thread */
    int needs_samples;              /* a number source other than `independent` is there */
    int needs_pixel;                /* one of them asks for the pixel */
    struct mcr_host host;
    const struct mcr_render_options *options;
    const struct mcr_stages *plain; /* where `stages` begins paths by a task (directed.c): the stages of the instruction set */
    const struct mcr_task *task;    /* of the running pass; NULL without a director */
    struct mcr_core_tables tables;
};

/* Points of one batch, sorted. */
struct mcr_surface_points {
    double *px, *py, *pz, *nx, *ny, *nz, *gx, *gy, *gz, *ox, *oy, *oz, *side;
    double *reach;                  /* magnitude for the offset of rays that leave: max(|p|, |o|, reach of the shape) */
    uint32_t *material;
    int64_t *primitive;
    /* NULL where nothing needs them: struct mcr_charts */
    double *u, *v, *width;          /* coordinates, and the footprint's diameter in them */
    double *gu[3], *gv[3];
    double *tx, *ty, *tz;           /* tangents */
    double *here, *beyond;          /* indices of refraction; NULL where no material has an interior */
};

/* A stretch of points of one group. */
struct mcr_range {
    uint32_t group, begin, end;     /* points begin .. end-1; begin is a multiple of MCR_LANE_PAD */
    uint32_t roulette;              /* a multiple of it: points before this are safe from roulette; only some behind it need not be */
    int ends;                       /* these paths emit and end */
};

/* For src/core/point_lights.c: arrays of one lane each, there only where the scene has such lights. Lanes are those of points, then compact ones. */
struct mcr_point_lanes {
    double *number;                /* chooses the light */
    double *wx, *wy, *wz;          /* toward it; 0 where none was chosen */
    double *er, *eg, *eb;          /* its irradiance on a surface that faces it, over the probability of the choice */
    double *far;                   /* its distance */
    double *fr, *fg, *fb;
    double *ox, *oy, *oz, *dx, *dy, *dz, *length, *seen; /* compact */
    uint32_t *lane;
};

/* A block of cells of the running pass that is being rendered: a place in the ring of slots. */
struct mcr_job {
    uint64_t first_cell;
    uint32_t cells, paths, begun;
    int busy;
};

/* For src/core/lobes.c: the lobe chosen at each point, there only when a material has mirror-like lobes. */
struct mcr_lobes {
    double *number;
    double *none;                  /* 1 where no lobe was chosen, 0 where one was: kept until the next hits are weighted */
    double *x, *y, *z;             /* its direction, away from the surface */
    double *probability;           /* of what was chosen, lobe or none */
    double *r, *g, *b;             /* the radiance that it passes on */
};

/* For src/core/crossing.c: a ray on its way through surfaces, and arrays for those that are on their way together. There only where something crosses. */
struct mcr_crossing {
    uint32_t ray;                  /* the caller's */
    uint32_t bounce, crossings, material;
    uint32_t inside[MCR_INTERIORS];
    int by_chance;
    uint64_t key;
    int64_t hit;
    double o[3], d[3], t, far, travelled; /* the running stretch begins at o, `travelled` from where the ray began */
    double end[3];                 /* where `far` is finite */
    double q[3], n[3], side;
    double factor[3], share[3];
    double width, spread;          /* of the footprint, at where the ray began; unused without struct mcr_charts */
};
struct mcr_crossing_lanes {
    double *px, *py, *pz, *nx, *ny, *nz, *ox, *oy, *oz, *side, *r, *g, *b, *t;
    int64_t *primitive, *hit;
    uint32_t *material, *of, *active, *asked, *going;
};

/* For src/core/light.c: arrays of one lane each, there only when the sampler has more than one technique. Lanes are those of points. */
struct mcr_light_lanes {
    /* what the continuing technique's find at the next hit is weighted with */
    double *own, *others;          /* h of its density, and the sum of h over the other direction techniques, for its direction */
    double *weight;                /* by ray: the weight of what it finds */
    /* a look-up by another technique */
    int32_t *emitter;
    double *qx, *qy, *qz, *wx, *wy, *wz, *distance, *density, *sum, *other;
    double *fr, *fg, *fb;
    /* its rays and then its finds, compact: light_lanes.h */
    double *ox, *oy, *oz, *dx, *dy, *dz, *far, *seen;
    double *sx, *sy, *sz, *mx, *my, *mz; /* points on what they find, and the unit normals of its front */
    int64_t *hit;
    uint32_t *lane;                /* point */
    /* points on emitters, compact, of one group */
    double *px, *py, *pz, *nx, *ny, *nz, *tx, *ty, *tz, *side, *lr, *lg, *lb;
    uint32_t *material, *of;       /* find */
};

/*
 * Inputs at points that are not those of the batch: on emitters that look-ups find, and where rays cross surfaces. Before it asks for them, whoever has
 * such points (all of one group) fills in primitives and footprints; see mcr_elsewhere_inputs.
 */
struct mcr_elsewhere {
    double *input;                  /* as lane_input; NULL where nothing varies at such points */
    int64_t *primitive;             /* this and what follows: NULL without struct mcr_charts */
    double *width;                  /* comes as a diameter in render space */
    double *u, *v, *gu[3], *gv[3];
};

/* For looking up textures of stretches with several materials. */
struct mcr_texture_lanes {
    uint32_t *head;                 /* by material: its first lane, or UINT32_MAX */
    uint32_t *next;                 /* by lane */
    uint32_t *lane, *present;       /* lanes of one material; materials there are */
    double *u, *v, *width, *r, *g, *b;
    /* for shading normals: NULL where none are tilted */
    double *su, *sv, *step, *slope[2];
    double (*front)[3];
};

struct mcr_batch {
    struct mcr_core *core;
    uint32_t lanes;                 /* room in the arrays of states and points */
    uint32_t rays;                  /* lanes of the ray arrays that are in use */
    double *rox, *roy, *roz, *rdx, *rdy, *rdz, *t;
    int64_t *hit;
    uint32_t *source;               /* ray -> lane of `state` */
    struct mcr_paths state, sorted; /* `sorted` is gathered from `state` with the points; they swap roles each round */
    uint32_t points;                /* lanes of the point arrays, padding between groups included */
    uint32_t states;                /* lanes of `state` in use: camera paths are appended from here */
    struct mcr_surface_points at;
    uint32_t *order;                /* point -> ray */
    struct mcr_range *range;
    uint32_t range_count;
    const uint32_t *miss;           /* rays that hit nothing */
    uint32_t miss_count;
    uint32_t *zone_count;           /* 3 * groups + 1: see sort.c */
    uint32_t *zone_list;            /* the rays of each, room for all of them */
    double *number[MCR_NUMBERS_MAX], *roulette;
    double *wx, *wy, *wz, *density; /* drawn directions */
    double *fr, *fg, *fb;           /* f * cos */
    double *material_density;       /* that the material's own sampling has for the drawn directions; for roulette */
    double *alive;                  /* 1 or 0 */
    struct mcr_light_lanes light;
    struct mcr_lobes lobe;
    double *controlled;             /* by point: 1 where light comes in closed form; NULL without control */
    struct mcr_crossing *crossing;  /* capacity */
    struct mcr_crossing_lanes crossing_lanes;
    struct mcr_point_lanes point;
    double *lane_input;             /* channels * lanes: inputs that vary from lane to lane, of all ranges */
    struct mcr_elsewhere elsewhere;
    struct mcr_texture_lanes textures; /* NULL without textures */
    const struct mcr_group *asked;  /* the group whose plugin runs: `channel` and `stride` are its */
    const double **channel;         /* the pointers handed to plugins */
    uint32_t *stride;
    double *slot_r, *slot_g, *slot_b;
    struct mcr_feature_slots features; /* there only where features are asked for */
    double *slot_weight;            /* what a sample counts in its pixel; NULL where the film's filter gives all the same */
    double *cap_r, *cap_g, *cap_b;  /* by slot; NULL without compat clamp: see compat.h */
    struct mcr_job *job;
    char *scratch;                  /* scratch_bytes */
    uint64_t scratch_used;
    struct mcr_context context;
    double *kept;                   /* of the last light_draw: see struct mcr_emitter_functions */
    const double *kept_at;          /* the points that it was for; NULL when they are gone */
    uint32_t kept_by, kept_n;
    const struct mcr_node *failed;  /* whose operation failed, or NULL */
    const struct mcr_range *running; /* the range whose points a sampler works on, for the host's material services */
    /* for new camera paths */
    double *camera_x, *camera_y;
    uint64_t replicate_key;         /* of the running pass */
    /* counts, summed at the end */
    uint64_t not_finite, not_finite_cell; /* of the pass */
    uint32_t not_finite_sample;
    uint64_t camera_rays, bounce_rays, shadow_rays, scatterings, crossings, overfull;
    double stage_seconds[MCR_STAGE_COUNT];
    double seconds_within;          /* of stages that the running one has called */
    void *memory;
};

/* Runs a statement and books its time on a stage, with --profile; not that of stages within it, which is booked on them. Needs base/cpu.h. */
#define MCR_TIMED(STAGE, STATEMENT)                                            \
    do {                                                                       \
        if (batch->core->options->profile) {                                   \
            double start = mcr_wall_seconds(), before = batch->seconds_within; \
            batch->seconds_within = 0;                                         \
            STATEMENT;                                                         \
            start = mcr_wall_seconds() - start;                                \
            batch->stage_seconds[STAGE] += start - batch->seconds_within;      \
            batch->seconds_within = before + start;                            \
        } else {                                                               \
            STATEMENT;                                                         \
        }                                                                      \
    } while (0)

/* Camera rays for lanes that were given their pixels: x, y in pixels of the full picture; u: film and lens numbers (NULL without a lens). */
struct mcr_camera_lanes {
    uint32_t n;
    const double *x, *y;
    const double *const *film;      /* 2 arrays */
    const double *const *lens;      /* 2 arrays, or NULL */
    double *ox, *oy, *oz, *dx, *dy, *dz;
    double *distance;               /* from the pixel's centre, squared, in pixels; NULL: nobody asks */
    double *weight;                 /* of the samples; NULL: the filter gives all the same */
};

/* New camera paths: the samples of a job in order, cell after cell (pass.h). */
struct mcr_begin {
    uint32_t n, to;                 /* states to .. to+n-1, whose rays are the batch's next */
    uint32_t path, slot;            /* the first path's number within the job, and its slot */
    uint32_t cell_samples;
    uint64_t pixel, round;          /* the job's first cell: c % pixels and c / pixels */
    uint64_t pixels;                /* of the crop */
    uint32_t first;                 /* the number of the pass's first sample within the replicate */
    uint32_t planned;
    uint64_t replicate_key;
};

/* The stage functions, compiled once per instruction set. */
struct mcr_stages {
    /* States of new paths, their pixels (camera_x, camera_y) and their places among the rays. */
    void (*begin)(struct mcr_batch *batch, const struct mcr_begin *begin);
    void (*camera)(const struct mcr_scene *scene, const struct mcr_camera_lanes *lanes);
    /* Groups rays by what they hit: fills order, range, miss. */
    void (*sort)(struct mcr_batch *batch);
    /* Points and path states in sorted order. */
    void (*surface)(struct mcr_batch *batch);
    /* Surface coordinates of any points. */
    void (*chart)(const struct mcr_core *core, const struct mcr_chart_lanes *lanes);
    /* The footprints of new camera paths: states to .. to+n-1, whose rays begin at `ray`. */
    void (*cones)(struct mcr_batch *batch, uint32_t to, uint32_t ray, uint32_t n);
    /* Footprints, surface coordinates and tangents of all points, after `surface`; only where something needs them. */
    void (*coordinates)(struct mcr_batch *batch);
    /* Adds radiance times throughput to the slots of points begin .. end-1. */
    void (*emit)(struct mcr_batch *batch, uint32_t begin, uint32_t end);
    /* Adds the background to the slots of the rays that hit nothing. */
    void (*background)(struct mcr_batch *batch);
    /* Lobes take the place of what was drawn. */
    void (*mirror)(struct mcr_batch *batch, const struct mcr_range *range);
    /* Throughput times f cos / density, and roulette; fills alive. */
    void (*scatter)(struct mcr_batch *batch, const struct mcr_range *range);
    /* Whether there is a density that is negative, infinite or NaN, or above 0 with a direction not of unit length. */
    int (*unsound)(uint32_t n, const double *density, const struct mcr_directions *drawn);
    /* Makes rays of the living points and lists their lanes in `source`. */
    void (*compact)(struct mcr_batch *batch);
    /* out[i] = table[index[i]] */
    void (*gather)(uint32_t n, const uint32_t *index, const double *table, double *out);
    /* Chooses lights without extent for the points of a range, among few; `both`: light from behind counts. */
    void (*point_choose)(struct mcr_batch *batch, const struct mcr_range *range, int both);
    /* Shadow rays toward them; returns how many. Then adds what comes along those that are `seen`. */
    uint32_t (*point_aim)(struct mcr_batch *batch, const struct mcr_range *range);
    void (*point_add)(struct mcr_batch *batch, uint32_t rays);
};

extern const struct mcr_stages mcr_stages_isa0, mcr_stages_isa1, mcr_stages_isa2;

/* batch.c: memory. Returns 0, or -1 when it is short. */
int mcr_batch_init(struct mcr_batch *batch, struct mcr_core *core);
/* The bytes that mcr_batch_init takes. */
size_t mcr_batch_bytes(struct mcr_core *core);
void mcr_batch_fini(struct mcr_batch *batch);

/* normals.c: tilts shading normals by normal maps and bumps, after `coordinates`; only where a material has them. */
void mcr_normals_tilt(struct mcr_batch *batch);
/* inputs.c: evaluates the inputs that vary at all points, once a round. */
void mcr_inputs_prepare(struct mcr_batch *batch);
/* Inputs of the points from `begin` on of a group, for a plugin's operation; those of layers inside are in batch->channel then. */
struct mcr_inputs mcr_group_inputs(struct mcr_batch *batch, const struct mcr_group *group, uint32_t begin);
/* The same for points elsewhere, evaluated now: see struct mcr_elsewhere. */
struct mcr_inputs mcr_elsewhere_inputs(struct mcr_batch *batch, const struct mcr_group *group, const struct mcr_points *at, const uint32_t *material);
/* Inputs of a layer of the group that was asked for last. */
struct mcr_inputs mcr_layer_inputs(const struct mcr_batch *batch, const struct mcr_layer *layer);
/*
 * What a sampler plugin told of the n points from `begin` on: densities, and the directions that it drew. Where they cannot be, the sample becomes NaN, which is counted and located as such (loop.c), and the density 0.
 */
void mcr_batch_judge(struct mcr_batch *batch, uint32_t begin, uint32_t n, const struct mcr_directions *drawn, double *density);
struct mcr_points mcr_batch_points(const struct mcr_batch *batch, uint32_t begin, uint32_t end);

#endif
