/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The words of the scene language: which blocks there are and what each setting takes. One table serves checking, messages and the
 * printed documentation. Settings of materials and samplers come from their plugins instead.
 */
#ifndef MCR_SCENE_WORDS_H
#define MCR_SCENE_WORDS_H

#include <mcrender/plugin.h>

/*
 * What a setting takes, beside MCR_TYPE_NUMBER, INTEGER, COLOUR and CHOICE. Rows are `struct mcr_parameter` with these types, so that
 * mcr_value_check reads those that plugins have too; min and max hold for each component.
 */
enum mcr_word_type {
    MCR_WORD_POINT = 32,  /* (x, y, z) */
    MCR_WORD_VECTOR,      /* (x, y, z) */
    MCR_WORD_PAIR,        /* (w, h), whole numbers */
    MCR_WORD_RECTANGLE,   /* (x0, y0, x1, y1), whole numbers */
    MCR_WORD_SCALE,       /* s or (sx, sy, sz) */
    MCR_WORD_ROTATION,    /* (ax, ay, az, degrees) */
    MCR_WORD_MATRIX,      /* 12 or 16 numbers */
    MCR_WORD_LOOKAT,      /* ((from), (to), (up)) */
    MCR_WORD_POINTS3,     /* 3 points */
    MCR_WORD_POINTS4,     /* 4 points */
    MCR_WORD_UVS3,        /* 3 pairs of numbers */
    MCR_WORD_POINT_LIST,  /* any number of points */
    MCR_WORD_UV_LIST,     /* any number of pairs */
    MCR_WORD_FACE_LIST,   /* any number of (i, j, k) or (i, j, k, l) */
    MCR_WORD_MATERIAL,    /* a material's name */
    MCR_WORD_SAMPLER,     /* a sampler expression */
    MCR_WORD_FILTER,      /* a filter: a name or a call */
    MCR_WORD_TONE,        /* a tone curve: a name or a call */
    MCR_WORD_ROULETTE,    /* on, off or on(from=N) */
    MCR_WORD_ADAPTIVE,    /* on, off or on(floor=N) */
    MCR_WORD_COMPAT,      /* none, a quirk's name, or a tuple of them */
    MCR_WORD_TEXT,        /* a string */
    MCR_WORD_SAMPLERS,    /* a sampler expression, or a tuple of them */
    MCR_WORD_WHOLES,      /* a whole number, or a tuple of them */
    MCR_WORD_CHOICES,     /* one of the words of `choices`, or a tuple of them */
    MCR_WORD_COMPATS,     /* a tuple of what `compat` takes, or one such */
    MCR_WORD_PAIR_OR_NUMBER, /* x, or (u, v) */
    MCR_WORD_UV,          /* (u, v) */
    MCR_WORD_WRAP,        /* a word of `choices`, or (for u, for v) */
    MCR_WORD_TEXTURE,     /* a texture's name */
    MCR_WORD_STOPS,       /* ((position, colour), ...) */
    MCR_WORD_TRANSFORM    /* a block of steps */
};

/* What a setting of this type looks like, e.g. "3 numbers (x, y, z)". */
const char *mcr_word_form(uint32_t type);

enum mcr_block_role {
    MCR_BLOCK_CAMERA, MCR_BLOCK_FILM, MCR_BLOCK_RENDER, MCR_BLOCK_MATERIAL, MCR_BLOCK_SHAPE, MCR_BLOCK_GROUP, MCR_BLOCK_TRANSFORM,
    MCR_BLOCK_STUDY, MCR_BLOCK_REFERENCE, MCR_BLOCK_TEXTURE, MCR_BLOCK_LIGHT
};

/* A block, or a call with named arguments (filters). */
struct mcr_block_word {
    const char *word;
    const char *kind;    /* of a camera, a texture or a light, else NULL */
    uint32_t role;       /* enum mcr_block_role */
    uint32_t count;
    const struct mcr_parameter *setting;
    const char *summary; /* one sentence */
};

extern const struct mcr_block_word mcr_scene_blocks[];
extern const uint32_t mcr_scene_block_count;

/* The row of a block by its word and, for cameras, textures and lights, its kind; NULL if there is none. */
const struct mcr_block_word *mcr_scene_block(const char *word, const char *kind);

/* Arguments of `filter`: box(radius=0.5), tent(radius=1), gaussian(sigma=0.5, radius=1.5), mitchell(radius=2, b=1/3, c=1/3). In the order of enum mcr_filter_kind. */
#define MCR_FILTER_COUNT 4u
extern const struct mcr_block_word mcr_filter_words[MCR_FILTER_COUNT];
/* Arguments of `tone`: linear, reinhard(white=4), hable(white=5.6), aces. In the order of enum mcr_tone_curve. */
#define MCR_TONE_WORDS 4u
extern const struct mcr_block_word mcr_tone_words[MCR_TONE_WORDS];
/* The argument of `roulette on(from=N)`. */
extern const struct mcr_block_word mcr_roulette_word;
/* The argument of `adaptive on(floor=N)`. */
extern const struct mcr_block_word mcr_adaptive_word;

/* Places in the tables. */
enum { CAMERA_FROM, CAMERA_TO, CAMERA_UP, CAMERA_FOV, CAMERA_FOCAL, CAMERA_FILM_HEIGHT, CAMERA_LENS_RADIUS, CAMERA_FOCUS_DISTANCE };
enum { ORTHOGRAPHIC_HEIGHT = CAMERA_FOV };
enum { FILM_SIZE, FILM_CROP, FILM_FILTER, FILM_EXPOSURE, FILM_TONE };
enum { TONE_WHITE };
enum { FILTER_RADIUS, FILTER_SIGMA, FILTER_B = 1, FILTER_C };
enum {
    RENDER_SAMPLER, RENDER_SPP, RENDER_DEPTH, RENDER_SEED, RENDER_THREADS, RENDER_REPLICATES, RENDER_ROULETTE, RENDER_BACKGROUND,
    RENDER_ACCEL, RENDER_PRECISION, RENDER_MIS, RENDER_BATCH, RENDER_COMPAT, RENDER_TEXTURE_MEMORY,
    RENDER_TIME, RENDER_TARGET_ERROR, RENDER_ADAPTIVE, RENDER_ROUND
};
enum {
    STUDY_TITLE, STUDY_SAMPLERS, STUDY_SPP, STUDY_DEPTH, STUDY_PRECISION, STUDY_ACCEL, STUDY_ROULETTE, STUDY_COMPAT, STUDY_SEEDS, STUDY_RUNS, STUDY_SEED,
    STUDY_BASELINE, STUDY_CONFIDENCE, STUDY_TARGET, STUDY_METRICS, STUDY_ENCODING, STUDY_PEAK, STUDY_OUTPUT, STUDY_SIZE, STUDY_CROP, STUDY_COUNT
};
enum { REFERENCE_SAMPLER, REFERENCE_SPP, REFERENCE_DEPTH, REFERENCE_SEED, REFERENCE_IMAGE, REFERENCE_COUNT };
/* In the order of enum mcr_metric, which belongs to a folder further right; tests/study compares the two. */
#define MCR_METRIC_WORDS "mse|rmse|mae|relmse|smape|psnr|snr|snr_variance|ssim|ms_ssim|mean_ratio"
/* The first two settings of every shape. */
enum { SHAPE_MATERIAL, SHAPE_TRANSFORM };
enum { PLANE_POINT = 2, PLANE_NORMAL };
enum { SPHERE_CENTER = 2, SPHERE_RADIUS };
enum { QUAD_CORNER = 2, QUAD_U, QUAD_V, QUAD_CORNERS };
enum { DISK_CENTER = 2, DISK_NORMAL, DISK_RADIUS };
enum { BOX_CORNER = 2, BOX_SIZE, BOX_MIN, BOX_MAX };
enum { TRIANGLE_A = 2, TRIANGLE_B, TRIANGLE_C, TRIANGLE_NORMALS, TRIANGLE_UV };
enum { MESH_VERTICES = 2, MESH_FACES, MESH_NORMALS, MESH_UV };
/* The first two settings of every texture. */
enum { TEXTURE_SCALE, TEXTURE_OFFSET };
enum { IMAGE_FILE = 2, IMAGE_WRAP, IMAGE_FILTER, IMAGE_COLOUR, IMAGE_CHANNEL };
enum { CHECKER_EVEN = 2, CHECKER_ODD, CHECKER_FILTER };
enum { GRADIENT_FROM = 2, GRADIENT_TO, GRADIENT_STOPS, GRADIENT_ALONG, GRADIENT_WRAP };
/* What every material takes beside its plugin's parameters. */
enum { SURFACE_EMISSION, SURFACE_EMISSION_SIDES, SURFACE_NORMAL_MAP, SURFACE_NORMAL_STRENGTH, SURFACE_BUMP, SURFACE_BUMP_HEIGHT, SURFACE_COUNT };
/* The first setting of every light. */
enum { LIGHT_TRANSFORM };
enum { POINT_POSITION = 1, POINT_INTENSITY, POINT_POWER };
enum { SPOT_TO = POINT_POWER + 1, SPOT_DIRECTION, SPOT_ANGLE, SPOT_SOFTNESS };
enum { SUN_DIRECTION = 1, SUN_IRRADIANCE, SUN_RADIANCE, SUN_ANGULAR_RADIUS };
enum { SKY_RADIANCE = 1, SKY_ZENITH, SKY_HORIZON, SKY_NADIR, SKY_IMAGE, SKY_FILTER, SKY_COLOUR, SKY_SCALE };
enum { STEP_TRANSLATE, STEP_ROTATE, STEP_SCALE, STEP_MATRIX, STEP_LOOKAT };

#define MCR_SETTINGS_LIMIT 24u /* no table is longer */
#define MCR_EXTENT_LIMIT 1e100 /* magnitude of coordinates and lengths in the world, so that products of three do not overflow */
#define MCR_TEXTURE_SCALE_LEAST 1e-9 /* magnitudes of a texture's scale; offsets are at most the larger one */
#define MCR_TEXTURE_SCALE_MOST 1e9
#define MCR_TEXTURE_MEMORY 1024 /* MiB, by default */
#define MCR_FILM_LIMIT 65536u
#define MCR_FILM_BYTES_PER_PIXEL 56u
#define MCR_FILM_ROUND_BYTES_PER_PIXEL 120u  /* more, where pixels have numbers of samples of their own: counts, scouts, noise, figures */
#define MCR_FILM_CHANNEL_BYTES_PER_PIXEL 72u /* more, where it keeps the channels' variances */
#define MCR_FILM_MEMORY_LIMIT ((uint64_t)1 << 30)

#endif
