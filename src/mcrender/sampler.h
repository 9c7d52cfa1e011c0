/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mcrender plugin interface: samplers.
 *
 * A sampler is an expression, `stratified(mixture(cosine 1, light 1))`; each node is a plugin of one of two kinds.
 * Number sources stand outside, direction nodes inside.
 */
#ifndef MCRENDER_SAMPLER_H
#define MCRENDER_SAMPLER_H

#include <mcrender/material.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Helpers: the host and its plugins compute these in the same way, to the bit --------------------------------- */

/*
 * A bijection of 64-bit words that spreads every bit over all, the finaliser of splitmix64: variant 13 of D. Stafford, "Better bit
 * mixing" (2011); G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
 */
MCR_INLINE uint64_t mcr_mix64(uint64_t x)
{
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

/*
 * The top 53 bits of a word as a number in [0, 1), exactly (x >> 11) * 2^-53. Only AVX-512 converts 64-bit integers: here 21 and 32 bits
 * are put below the exponents of 2^84 (whose last place is 2^32) and 2^52, which are then taken away again.
 */
MCR_INLINE double mcr_unit_double(uint64_t x)
{
    uint64_t high = (x >> 43) | (UINT64_C(0x453) << 52), low = ((x >> 11) & UINT64_C(0xffffffff)) | (UINT64_C(0x433) << 52);
    double upper, lower;

    memcpy(&upper, &high, sizeof upper);
    memcpy(&lower, &low, sizeof lower);
    return ((upper - 19342813113834066795298816.0) + (lower - 4503599627370496.0)) * (1.0 / 9007199254740992.0);
}

/* The independent number of a path in a dimension: what the source `independent` gives. path_key as in struct mcr_samples. */
MCR_INLINE double mcr_number(uint64_t path_key, uint64_t dimension)
{
    return mcr_unit_double(mcr_mix64(path_key + (dimension + 1) * UINT64_C(0x9e3779b97f4a7c15)));
}

/*
 * A point of the unit disk, uniform in area, from (u, v) in [0,1)^2; continuous both ways. The concentric map of Shirley and Chiu,
 * "A low distortion map between disk and square" (1997), without branches. Sine and cosine of s pi/4, |s| <= 1, are minimax
 * polynomials whose own error is below 2^-54. With e = 2^-53: x and y err by at most 3e of the radius max(|2u-1|, |2v-1|) <= 1, and
 * x^2 + y^2 by at most 5e of its square. Returns 1 - radius^2, to 3e relative: its square root is the height of the hemisphere
 * over the point, and (x, y, height) has unit length to 2e. (Measured over 2e7 points: 2.14e, 4.12e, 1.3e, 1.86e.)
 */
MCR_INLINE double mcr_disk_from_square(double u, double v, double *x, double *y)
{
    double a = 2 * u - 1, b = 2 * v - 1;
    double magnitude_a = a < 0 ? -a : a, magnitude_b = b < 0 ? -b : b;
    int wide = magnitude_a > magnitude_b;
    double radius = wide ? a : b, other = wide ? b : a;
    double s = other / (radius == 0 ? 1 : radius), q = s * s;
    double sine = 6.877366315879868e-12;
    double cosine = -3.858191511496696e-13;

    sine = sine * q - 1.7571500919274546e-09;
    sine = sine * q + 3.1336162256272475e-07;
    sine = sine * q - 3.657620415892393e-05;
    sine = sine * q + 0.002490394570188846;
    sine = sine * q - 0.08074551218828054;
    sine = (sine * q + 0.7853981633974483) * s;
    cosine = cosine * q + 1.1500512115865309e-10;
    cosine = cosine * q - 2.4611364034857796e-08;
    cosine = cosine * q + 3.590860446028774e-06;
    cosine = cosine * q - 0.0003259918869267379;
    cosine = cosine * q + 0.01585434424381542;
    cosine = cosine * q - 0.30842513753404244;
    cosine = cosine * q + 1;
    *x = radius * (wide ? cosine : sine);
    *y = radius * (wide ? sine : cosine);
    return (1 - radius) * (1 + radius);
}

/*
 * Two unit vectors that make a right-handed orthonormal basis (t, b, n) with the unit vector n; errors at most 8 * 2^-53 everywhere
 * (4.7 measured), near -z too. Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017.
 */
MCR_INLINE void mcr_basis(double nx, double ny, double nz, double *tx, double *ty, double *tz, double *bx, double *by, double *bz)
{
    double sign = nz < 0 ? -1.0 : 1.0;
    double a = -1 / (sign + nz), c = nx * ny * a;

    *tx = 1 + sign * nx * nx * a;
    *ty = sign * c;
    *tz = -sign * nx;
    *bx = c;
    *by = sign + ny * ny * a;
    *bz = -ny;
}

/* The vector x t + y b + z n of that basis, for a unit vector (x, y, z). One Newton step on its length keeps it unit to 3 * 2^-53. */
MCR_INLINE void mcr_to_world(double nx, double ny, double nz, double x, double y, double z, double *wx, double *wy, double *wz)
{
    double tx, ty, tz, bx, by, bz, vx, vy, vz, fix;

    mcr_basis(nx, ny, nz, &tx, &ty, &tz, &bx, &by, &bz);
    vx = x * tx + y * bx + z * nx;
    vy = x * ty + y * by + z * ny;
    vz = x * tz + y * bz + z * nz;
    fix = 0.5 * (1 - (vx * vx + vy * vy + vz * vz));
    *wx = vx + vx * fix;
    *wy = vy + vy * fix;
    *wz = vz + vz * fix;
}

/* ---- Directions ------------------------------------------------------------------------------------------------ */

/* Kinds of technique. */
#define MCR_TECHNIQUE_DIRECTION 1u /* draws a direction; the ray is traced to its first hit */
#define MCR_TECHNIQUE_EMITTER 2u   /* draws a point on a chosen emitter; visibility to it is tested */

/* What a technique covers: the directions at which its density is positive wherever a material scatters there. */
#define MCR_COVERS_REFLECTION 1u   /* the whole hemisphere of the outgoing direction */
#define MCR_COVERS_TRANSMISSION 2u /* the whole opposite hemisphere */
/* Mirror-like lobes need no technique: the core asks the material for them under every sampler. */
#define MCR_COVERS_EMITTERS 8u     /* all directions toward emitters that can be sampled */

/* One way in which a node draws. A node has 1 to MCR_MAX_TECHNIQUES of them. */
#define MCR_MAX_TECHNIQUES 4u
struct mcr_technique {
    uint32_t size;
    uint32_t kind;       /* MCR_TECHNIQUE_* */
    uint32_t covers;     /* MCR_COVERS_* */
    uint32_t continues;  /* 1 for the one direction technique that continues the path; others only look for emitted light */
    uint32_t dimensions; /* numbers in [0,1) that one draw takes; all techniques of a tree together at most 16 */
    uint32_t flags;      /* MCR_TECHNIQUE_CONTROL, or 0 */
};

/*
 * Of emitter techniques: where the unoccluded light of an emitter is known in closed form (polygons and spheres whose material is MCR_MATERIAL_EVEN, over
 * MCR_MATERIAL_LAMBERTIAN), the host adds it and takes the points drawn for an estimate of what is hidden. Elsewhere it changes nothing.
 */
#define MCR_TECHNIQUE_CONTROL 1u

/* How an emitter is sampled. */
#define MCR_LIGHT_BY_AREA 0u        /* uniform on its surface */
#define MCR_LIGHT_BY_SOLID_ANGLE 1u /* uniform in solid angle where that is stable, else by area with the area's density */

/*
 * n points on emitters, as emitter techniques exchange them with the host. All that shines from infinitely far, an environment and suns with an
 * extent, is one emitter, whose number is behind those of the others: its distance is INFINITY, only w says where the point is, and q is unused.
 */
struct mcr_emitter_points {
    uint32_t size;
    uint32_t n;
    int32_t *emitter;          /* the emitter's number; -1 where nothing was drawn */
    double *qx, *qy, *qz;      /* the point on it, render space */
    double *wx, *wy, *wz;      /* unit direction from the surface point to it */
    double *distance;          /* to it, render space, > 0 */
};

/*
 * A node that draws directions. `technique` below is an index into what `techniques` told.
 * Densities are over solid angle, in 1/sr, >= 0, never negative or NaN; for a direction that cannot be drawn it is 0.
 */
struct mcr_directions_plugin {
    struct mcr_descriptor head; /* kind MCR_KIND_DIRECTIONS */

    /* Main thread. Stores an immutable instance (NULL is a valid one). */
    int32_t (*create)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance);
    /* Main thread, once. May be NULL. */
    void (*destroy)(void *instance);
    /* Main thread, after create. Fills technique[0..*count), each element's size set by the host; *count <= MCR_MAX_TECHNIQUES. */
    int32_t (*techniques)(const struct mcr_host *host, struct mcr_context *context, const void *instance,
                          struct mcr_technique *technique, uint32_t *count);
    /* Bytes of scratch that one call over n lanes needs, without those of children. May be NULL: none. */
    uint64_t (*scratch_bytes)(const void *instance, uint32_t n);

    /*
     * Direction techniques. Draws one direction a lane. number[k] is an array of at->n numbers in [0,1), k < dimensions.
     * Where `density` is not NULL, the density of the direction that was drawn, over *all* ways in which this technique
     * could have drawn it, is stored there; 0 where nothing was drawn.
     */
    int32_t (*draw)(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density);
    /* Direction techniques. The density of any direction; (0, 0, 0) has density 0. */
    int32_t (*density)(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density);
    /* Direction techniques. What the density integrates to at each point, in [0, 1]. May be NULL: 1 everywhere. */
    int32_t (*mass)(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                    const struct mcr_points *at, double *mass);

    /* Emitter techniques. Draws a point on an emitter; where `density` is not NULL, also its density over solid angle. NULL if there is none. */
    int32_t (*draw_emitter)(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                            const struct mcr_points *at, const double *const *number, const struct mcr_emitter_points *out,
                            double *density);
    /* Emitter techniques. The density over solid angle of drawing these points; 0 where emitter is -1. NULL if there is none. */
    int32_t (*density_emitter)(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                               const struct mcr_points *at, const struct mcr_emitter_points *points, double *density);
};

/* ---- Numbers --------------------------------------------------------------------------------------------------- */

/*
 * The samples of n lanes. A number is a pure function of these and of the dimension.
 * Dimensions: 0, 1 pixel; 2, 3 lens; 4-7 reserved; bounce b has 32 from 8 + 32 b on: 0-15 sampler, 16-19 light,
 * 20-23 material, 24 roulette, 25-31 reserved.
 */
struct mcr_samples {
    uint32_t size;
    uint32_t n;
    const uint64_t *pixel_key; /* hash of seed, pixel and replicate: equal for the samples of one pixel's replicate */
    const uint64_t *path_key;  /* the same with the sample's number mixed in: another one for every path */
    const uint32_t *index;     /* the sample's number within its replicate, 0 .. planned-1 */
    const uint32_t *planned;   /* samples planned for this pixel and replicate, >= 1 */
    const uint32_t *bounce;    /* the path's bounce: 0 at the first surface; unused for dimensions below 8 */
    const uint32_t *x, *y;     /* the pixel, from the top left of the whole film; NULL unless the source needs MCR_NEEDS_PIXEL */
    uint64_t replicate_key;    /* hash of seed and replicate, from which pixel_key is made: equal for all pixels of the replicate */
};

/* What a number source asks for beyond the rest of struct mcr_samples. */
#define MCR_NEEDS_PIXEL 1u /* x and y */

struct mcr_numbers_plugin {
    struct mcr_descriptor head; /* kind MCR_KIND_NUMBERS */

    int32_t (*create)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance);
    void (*destroy)(void *instance);
    uint64_t (*scratch_bytes)(const void *instance, uint32_t n);

    /*
     * How many numbers of the group that starts at `first` this source supplies: 0 .. count, counted from `first`.
     * The rest is asked of the next source inside, at last of the independent one. Groups: the pixel (first 0, count 2), the lens (2, 2) and,
     * in bounces (first >= 8, all lanes alike but for their bounce; first is given for bounce 0), sampler nodes, light, material, roulette.
     */
    uint32_t (*supplies)(const void *instance, uint32_t first, uint32_t count);
    /* 1 if samples of one pixel depend on each other, so that variance must come from replicates; else 0. */
    uint32_t (*correlated)(const void *instance);
    /* Stores number[k][i] in [0,1) for dimension first + k (+ 32 * bounce[i] where first >= 8), k < count. */
    int32_t (*fill)(const struct mcr_host *host, struct mcr_context *context, const void *instance,
                    const struct mcr_samples *samples, uint32_t first, uint32_t count, double *const *number);
    /* MCR_NEEDS_*, asked once after create: the host provides only what some source of the sampler needs. May be NULL: nothing. */
    uint32_t (*needs)(const void *instance);
};

/* ---- Host services --------------------------------------------------------------------------------------------- */

/* Severities of reports. */
#define MCR_REPORT_NOTE 0u
#define MCR_REPORT_WARNING 1u
#define MCR_REPORT_ERROR 2u

/*
 * What the host does for plugins. Every service may be called from any operation with the context that the operation
 * was given; those that take points only from operations over batches. They return as operations do.
 */
struct mcr_host {
    uint32_t size;
    uint32_t major, minor;
    uint32_t reserved;

    /* A message for the user, located at the node in the scene or the command line. `text` is copied. */
    void (*report)(const struct mcr_host *host, struct mcr_context *context, uint32_t severity, const char *text);
    /* The scratch of the running operation: scratch_bytes(instance, n) bytes, 64-byte aligned. */
    void *(*scratch)(const struct mcr_host *host, struct mcr_context *context);

    /* Children that draw directions: their techniques (as told; main thread or later), and their operations. */
    int32_t (*child_techniques)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                struct mcr_technique *technique, uint32_t *count);
    int32_t (*child_draw)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                          const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density);
    int32_t (*child_density)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                             const struct mcr_points *at, const struct mcr_directions *toward, double *density);
    int32_t (*child_mass)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                          const struct mcr_points *at, double *mass);

    /*
     * Directions toward emitters. Takes MCR_LIGHT_DIMENSIONS numbers: one chooses the emitter, two the point.
     * `by` is MCR_LIGHT_BY_*. The density sums over all emitters that the ray crosses, behind others too.
     */
    int32_t (*light_draw)(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                          const double *const *number, const struct mcr_directions *out, double *density);
    int32_t (*light_density)(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                             const struct mcr_directions *toward, double *density);
    int32_t (*light_mass)(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at, double *mass);

    /* The same for emitter techniques: a point on one emitter, and the density of that emitter and point. */
    int32_t (*light_draw_point)(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                                const double *const *number, const struct mcr_emitter_points *out, double *density);
    int32_t (*light_density_point)(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                                   const struct mcr_emitter_points *points, double *density);

    /*
     * The material at the points: a direction by its own sampling (MCR_MATERIAL_DIMENSIONS numbers), and its density. The points are
     * those that the operation was given, all of them and in the same arrays; only `wanted` may differ.
     */
    int32_t (*material_draw)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_points *at,
                             const double *const *number, const struct mcr_directions *out, double *density);
    int32_t (*material_density)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_points *at,
                                const struct mcr_directions *toward, double *density);

    /* 1 if the scene has emitters that can be sampled, 0 if not; valid from create on. */
    uint32_t (*has_lights)(const struct mcr_host *host, struct mcr_context *context);

    /*
     * Materials inside materials: the children that parameters of MCR_TYPE_MATERIAL name. The host evaluates their inputs at the points, which
     * are those that the operation was given, all of them and in the same arrays; only `wanted` may differ. Traits are told from create on. An
     * operation that the child lacks returns MCR_E_UNSUPPORTED: its traits say what it does.
     */
    int32_t (*material_child_traits)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                     struct mcr_material_traits *traits);
    int32_t (*material_child_evaluate)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                       const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out);
    int32_t (*material_child_draw)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                   const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density);
    int32_t (*material_child_density)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                      const struct mcr_points *at, const struct mcr_directions *toward, double *density);
    int32_t (*material_child_emission)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                       const struct mcr_points *at, const struct mcr_colours *out);
    int32_t (*material_child_delta)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out,
                                    double *probability, const struct mcr_colours *weight);
    int32_t (*material_child_passes)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                     const struct mcr_points *at, const struct mcr_colours *out);
    int32_t (*material_child_albedo)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                     const struct mcr_points *at, const struct mcr_colours *out);
};

#define MCR_LIGHT_DIMENSIONS 3u
#define MCR_MATERIAL_DIMENSIONS 3u

/* For `create` of a node that takes no children: MCR_OK, or reports the mistake and returns MCR_E_INVALID. */
MCR_INLINE int32_t mcr_without_children(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with)
{
    if (with->child_count == 0)
        return MCR_OK;
    host->report(host, context, MCR_REPORT_ERROR, "this sampler takes no samplers inside it");
    return MCR_E_INVALID;
}

#ifdef __cplusplus
}
#endif

#endif
