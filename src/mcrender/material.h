/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mcrender plugin interface: materials.
 *
 * A material scatters, emits, or both. Colours are RGB, linear Rec. 709. Both directions of a pair leave the surface.
 */
#ifndef MCRENDER_MATERIAL_H
#define MCRENDER_MATERIAL_H

#include <mcrender/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a material does at all. */
#define MCR_MATERIAL_REFLECTS 1u    /* scatters into the hemisphere of the outgoing direction */
#define MCR_MATERIAL_TRANSMITS 2u   /* scatters into the opposite one */
#define MCR_MATERIAL_DELTA 4u       /* has mirror-like lobes, told by `delta` */
#define MCR_MATERIAL_EMITS_FRONT 8u
#define MCR_MATERIAL_EMITS_BACK 16u
#define MCR_MATERIAL_INTERIOR 32u   /* bounds a medium: `index`, `attenuation` and `priority` of its traits */
#define MCR_MATERIAL_PASSES 64u     /* lets light cross straight on as if there were nothing, told by `passes` */
#define MCR_MATERIAL_LEANS 128u     /* as it is set, reads the tangents of struct mcr_points: as MCR_MATERIAL_TANGENTS, but of one instance */
#define MCR_MATERIAL_THIN 256u      /* light goes through it and is outside again: a wall, which cannot bound a medium as well */

/* Flags of descriptors. */
/* Operations read mcr_inputs, not the instance: one call may hold points of several materials of this plugin (any stride may be 1 then). */
#define MCR_MATERIAL_STATELESS 1u
/* Operations of every instance read the tangents of struct mcr_points. */
#define MCR_MATERIAL_TANGENTS 2u
/* `evaluate` is albedo / pi times the cosine to the shading normal, for both directions on its side. */
#define MCR_MATERIAL_LAMBERTIAN 4u
/* What it emits, it emits from every point in every direction: the radiance of its traits, but for parameters that vary. */
#define MCR_MATERIAL_EVEN 8u

/* What the host has to know of a material before the first ray. */
struct mcr_material_traits {
    uint32_t size;
    uint32_t does;        /* MCR_MATERIAL_REFLECTS, ... */
    double radiance[3];   /* emitted, a mean over the surface: for choosing among emitters, not for the image */
    /* With MCR_MATERIAL_INTERIOR: what is behind the front side, up to where the surface closes. */
    double index;          /* of refraction, > 0 */
    double attenuation[3]; /* extinction by absorption, 1 / scene length, >= 0: radiance falls as exp(-attenuation * distance) */
    double priority;       /* where interiors overlap, the highest one counts (Schmidt and Budge, "Simple nested dielectrics in ray traced images", 2002) */
};

/* One colour for each of n lanes. */
struct mcr_colours {
    uint32_t size;
    uint32_t n;
    double *r, *g, *b;
};

struct mcr_material_plugin {
    struct mcr_descriptor head; /* kind MCR_KIND_MATERIAL */
    uint32_t flags;             /* MCR_MATERIAL_STATELESS, ... */
    uint32_t reserved;

    /* Main thread. Stores an immutable instance (NULL is a valid one). Varying parameters have their mean over the surface in `values`. */
    int32_t (*create)(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance);
    /* Main thread, once. May be NULL. */
    void (*destroy)(void *instance);
    /* Main thread, after create. */
    int32_t (*traits)(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits);
    /* Bytes of scratch that one call over n lanes needs. May be NULL: none. */
    uint64_t (*scratch_bytes)(const void *instance, uint32_t n);

    /*
     * f(outgoing, toward) * |cos(toward, shading normal)|, in 1/sr, without delta lobes; 0 where `toward` cannot be
     * scattered into, which includes a reflection below the geometric surface. NULL if the material does not scatter.
     */
    int32_t (*evaluate)(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out);
    /* Draws a direction close in density to f * cos, with its density in 1/sr (may be NULL); number[0..2]. NULL if it does not scatter. */
    int32_t (*draw)(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density);
    /* The density of `draw` for any direction. NULL if it does not scatter. */
    int32_t (*density)(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density);

    /* Emitted radiance toward the outgoing direction, W/(sr m^2). NULL if it does not emit. */
    int32_t (*emission)(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_colours *out);
    /*
     * Delta lobes: with number[0] chooses one of them, or none. Stores for a lobe its direction, the probability with which it is
     * chosen, and as `weight` the radiance that it passes on, relative to the radiance that arrives along the direction; the weight is
     * not divided by the probability: the core does that. Where no lobe was chosen, stores direction (0, 0, 0), the probability of
     * that, and weight 0; the path then goes on by `evaluate` and a technique's density. None is chosen last: by the numbers from 1 less its
     * probability on, so that whoever asks with a number close to 1 learns how probable it is. Takes MCR_DELTA_DIMENSIONS numbers, and the core
     * calls it under every sampler. NULL if there is none.
     */
    int32_t (*delta)(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                     const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *probability,
                     const struct mcr_colours *weight);

    /*
     * The share of light that crosses the surface straight on, in [0, 1] for each colour: opacity 1 - passes. It is no scattering event, and rays
     * toward emitters cross too. What `evaluate`, `delta` and `emission` tell is for the surface as it is, the crossing light taken off. NULL if
     * nothing crosses.
     */
    int32_t (*passes)(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out);
    /*
     * The share of light that the surface scatters, about, in [0, 1], of which what crosses is no part: for feature layers, not for the image. NULL,
     * or MCR_E_UNSUPPORTED returned: the host estimates it. Of a material with others inside it is asked only where all those of them that scatter tell theirs.
     */
    int32_t (*albedo)(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out);
};

#define MCR_DELTA_DIMENSIONS 1u

#ifdef __cplusplus
}
#endif

#endif
