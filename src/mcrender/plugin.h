/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mcrender plugin interface, version 0.9: what every kind of plugin shares.
 *
 * A plugin is a shared object WORD.so that exports one data symbol, `mcr_plugin`. It lists descriptors;
 * each descriptor names one word of the scene language, its parameters and its operations.
 *
 * Rules that hold everywhere below
 *   types      Only uint32_t, int32_t, uint64_t, double, char and pointers cross the boundary. 64-bit hosts only.
 *   growth     Every structure starts with `size`, the number of bytes its writer knows of. A member exists only
 *              if it lies within `size`. Structures grow at the end and never change otherwise within a major version.
 *   batches    Operations work on n lanes, all live. Arrays are structure-of-arrays, 64-byte aligned (those of 32-bit numbers 32-byte) and padded to a
 *              multiple of 8 doubles: the padding may be read, never relied on and never written. Inputs and outputs do not overlap.
 *   status     Operations return 0 or a negative MCR_E_*; a failure stops the render. Say why with host->report.
 *   threads    `create` runs once on the main thread and returns something immutable. Every other operation is
 *              re-entrant: it may run on many threads at once with the same instance.
 *   memory     Operations allocate nothing. Scratch is asked for with `scratch_bytes` and fetched with host->scratch;
 *              its contents are undefined at each call. Strings and arrays in a descriptor live as long as the process.
 *   manners    No globals that change, no per-thread state, no output, no exit; locale, rounding mode, signals and
 *              threads are the host's.
 *   numbers    For images that keep their bits on every machine, compile with -ffp-contract=off and call no libm
 *              function but sqrt, fabs, floor and ceil (mcrender-plugin.pc gives the flags).
 */
#ifndef MCRENDER_PLUGIN_H
#define MCRENDER_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A plugin loads when its major number equals the host's; the minor number may be any. */
#define MCR_PLUGIN_MAJOR 0u
#define MCR_PLUGIN_MINOR 9u

/* What operations return. */
#define MCR_OK 0
#define MCR_E_INVALID (-1)     /* a parameter or a combination of them cannot work */
#define MCR_E_NOMEM (-2)       /* `create` could not allocate */
#define MCR_E_UNSUPPORTED (-3) /* the host lacks a service that is needed */
#define MCR_E_INTERNAL (-4)    /* a promise was broken: a bug */

/* Kinds of descriptor. */
#define MCR_KIND_DIRECTIONS 1u /* struct mcr_directions_plugin, sampler.h */
#define MCR_KIND_NUMBERS 2u    /* struct mcr_numbers_plugin, sampler.h */
#define MCR_KIND_MATERIAL 3u   /* struct mcr_material_plugin, material.h */

/* Instruction sets. The same kind and name may be listed once per instruction set; baseline is required. */
#define MCR_ISA_BASELINE 0u
#define MCR_ISA_AVX2 1u
#define MCR_ISA_AVX512 2u

/* Types of parameters, and how many doubles a value of each takes (always stored in 3 slots). */
#define MCR_TYPE_NUMBER 1u  /* slot 0 */
#define MCR_TYPE_INTEGER 2u /* slot 0, a whole number of magnitude at most 2^53 */
#define MCR_TYPE_COLOUR 3u  /* slots 0-2: red, green, blue, linear Rec. 709 */
#define MCR_TYPE_CHOICE 4u  /* slot 0: the index of the word in `choices` */
#define MCR_TYPE_MATERIAL 5u /* of materials only; slot 0: which of the children of struct mcr_creation it is, -1: not given; the scene gives a material's name */

/* Flags of parameters. */
#define MCR_PARAMETER_REQUIRED 1u  /* the scene must set it; `fallback` is unused */
#define MCR_PARAMETER_VARYING 2u   /* may vary over the surface; read it from struct mcr_inputs in each operation */
#define MCR_PARAMETER_ABOVE_MIN 4u /* the minimum itself is out of range */
#define MCR_PARAMETER_BELOW_MAX 8u /* the maximum itself is out of range */

/*
 * One parameter. The host checks, fills defaults, reports mistakes at file:line:column and prints this table as
 * documentation; what reaches the plugin is finite, in range and of the type.
 */
struct mcr_parameter {
    uint32_t size;
    uint32_t type;       /* MCR_TYPE_* */
    uint32_t flags;      /* MCR_PARAMETER_* */
    uint32_t reserved;   /* 0 */
    const char *name;    /* a word: [a-z][a-z0-9_-]* */
    const char *unit;    /* "" for a pure number; else e.g. "W/(sr m^2)", "degrees" */
    const char *choices; /* MCR_TYPE_CHOICE: the words, separated by '|'; else NULL */
    const char *summary; /* one sentence */
    double fallback[3];  /* the default, laid out as a value */
    double min, max;     /* inclusive range of each component, infinities allowed; unused for choices */
};

/* The values of a node's parameters, in the order of its table. */
struct mcr_values {
    uint32_t size;
    uint32_t count;         /* parameters */
    const double *number;   /* 3 * count; components that a type does not use are 0 (a colour given as one number fills all 3) */
    const uint32_t *given;  /* count; 1 where the scene set the value, 0 where it is the default */
};

/*
 * The same values inside an operation, where those marked MCR_PARAMETER_VARYING may differ from lane to lane.
 * Channel 3*k + c is component c of parameter k; lane i of it is channel[3*k+c][i * stride[3*k+c]].
 * A stride is 0 or 1; with stride 0 the pointer leads to 8 equal copies.
 */
struct mcr_inputs {
    uint32_t size;
    uint32_t count;               /* parameters */
    const double *const *channel; /* 3 * count */
    const uint32_t *stride;       /* 3 * count */
};

/*
 * n points on surfaces, as materials and samplers see them. Positions are in render space: the axes of the world,
 * the origin at the camera, lengths scaled by a power of two. Directions are unit and leave the surface.
 */
struct mcr_points {
    uint32_t size;
    uint32_t n;
    const double *px, *py, *pz; /* position, render space */
    const double *nx, *ny, *nz; /* shading normal, unit, on the side of the outgoing direction */
    const double *gx, *gy, *gz; /* geometric normal, unit, on the side of the outgoing direction */
    const double *ox, *oy, *oz; /* outgoing direction: toward where the path came from */
    const double *side;         /* +1 where the outgoing direction is on the front of the surface, -1 on its back */
    const double *wanted;       /* 0 in lanes whose results nobody looks at, which need not be computed; NULL: all are wanted */
    const double *tx, *ty, *tz; /* tangent: unit, orthogonal to the shading normal, along growing u; NULL unless a material asks (MCR_MATERIAL_LEANS, _TANGENTS) */
    const double *here, *beyond; /* index of refraction on the side of the outgoing direction and on the other; NULL: no material has an interior */
};

/* n unit directions that leave the surface. (0, 0, 0) means that nothing was drawn in that lane. */
struct mcr_directions {
    uint32_t size;
    uint32_t n;
    double *x, *y, *z;
};

struct mcr_host;    /* services, below in sampler.h */
struct mcr_context; /* one call on one thread: opaque, lives for that call */
struct mcr_child;   /* a child node: opaque, lives as long as its parent */

#define MCR_MAX_CHILDREN 16u
#define MCR_MAX_TREE_DEPTH 8u

/* What `create` is given. Everything in it lives for the call only, except the children. */
struct mcr_creation {
    uint32_t size;
    uint32_t child_count;                  /* at most MCR_MAX_CHILDREN */
    const struct mcr_values *values;
    const struct mcr_child *const *child;  /* child_count; created before their parent */
    const double *weight;                  /* child_count; 1 where the expression gives none; finite and >= 0 */
    uint32_t spp;                          /* samples that are planned for one pixel and one replicate */
    uint32_t reserved;
};

/* The head of every descriptor. */
struct mcr_descriptor {
    uint32_t size;            /* of the whole descriptor, head and operations */
    uint32_t kind;            /* MCR_KIND_* */
    uint32_t isa;             /* MCR_ISA_* */
    uint32_t parameter_count;
    const char *name;         /* the word used in scenes; one of them equals the file's WORD */
    const char *version;      /* of the plugin, free form */
    const char *licence;      /* SPDX expression */
    const char *summary;      /* one line */
    const struct mcr_parameter *parameters;
};

/* The one exported symbol. `count` descriptors, each the head of a larger structure told by its kind. */
struct mcr_plugin {
    uint32_t size, major, minor, count;
    const struct mcr_descriptor *const *list;
};

#if defined(__GNUC__)
#define MCR_EXPORT __attribute__((visibility("default")))
#define MCR_HIDDEN __attribute__((visibility("hidden")))
/* Helpers within loops: a call that is left would keep the loop scalar. */
#define MCR_INLINE static inline __attribute__((always_inline, unused))
#else
#define MCR_EXPORT
#define MCR_HIDDEN
#define MCR_INLINE static inline
#endif

extern MCR_EXPORT const struct mcr_plugin mcr_plugin;

/*
 * A source may be compiled once per instruction set, with -DMCR_ISA=0 for the baseline, 1 (AVX2) and 2 (AVX-512), and the three
 * objects be linked into one plugin. Without -DMCR_ISA it is compiled once, as the baseline, and is the whole plugin.
 * MCR_ISA_COUNT is the number of objects: 3 where MCR_ISA is given on x86-64, else 1; -DMCR_ISA_COUNT=1 says otherwise.
 */
#ifndef MCR_ISA_COUNT
#if defined(MCR_ISA) && defined(__x86_64__)
#define MCR_ISA_COUNT 3
#else
#define MCR_ISA_COUNT 1
#endif
#endif
#ifndef MCR_ISA
#define MCR_ISA 0
#endif
#define MCR_PASTE_(a, b) a##b
#define MCR_PASTE(a, b) MCR_PASTE_(a, b)
/* x with a suffix of its own in each object. */
#define MCR_ISA_NAME(x) MCR_PASTE(x##_isa, MCR_ISA)

/*
 * The last line of a plugin of one word: exports its descriptor, of this type, whose definition begins
 *     MCR_HIDDEN const struct mcr_directions_plugin MCR_ISA_NAME(descriptor) = {
 * and leaves the export to the baseline's object. A plugin of several words writes out its list instead.
 */
#if MCR_ISA != 0
#define MCR_PLUGIN(type, name) extern const type MCR_ISA_NAME(name)
#else
#if MCR_ISA_COUNT == 3
#define MCR_PLUGIN_LIST_(type, name)                            \
    extern MCR_HIDDEN const type name##_isa1, name##_isa2;      \
    static const struct mcr_descriptor *const name##_list[] = { \
        &MCR_ISA_NAME(name).head, &name##_isa1.head, &name##_isa2.head}
#else
#define MCR_PLUGIN_LIST_(type, name) static const struct mcr_descriptor *const name##_list[] = {&MCR_ISA_NAME(name).head}
#endif
#define MCR_PLUGIN(type, name)                                                                                             \
    MCR_PLUGIN_LIST_(type, name);                                                                                          \
    const struct mcr_plugin mcr_plugin = {sizeof(struct mcr_plugin), MCR_PLUGIN_MAJOR, MCR_PLUGIN_MINOR, MCR_ISA_COUNT, name##_list}
#endif

#ifdef __cplusplus
}
#endif

#endif
