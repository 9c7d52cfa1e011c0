/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A stand-in for the host: loads the plugins of MCRENDER_PLUGIN_PATH as the registry does, and calls their operations over arrays
 * laid out as the interface promises, with a guard behind the last lane. Children are plugins' instances; there is one scratch each.
 */
#ifndef TESTS_PLUGINS_STAND_IN_H
#define TESTS_PLUGINS_STAND_IN_H

#include <dlfcn.h>
#include <math.h>
#include <mcrender/material.h>
#include <mcrender/sampler.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../tap.h"
#include "base/cpu.h"
#include "base/random.h"
#include "plugin/registry.h"

#define GUARD 12345.678

struct mcr_child {
    const struct mcr_directions_plugin *plugin;
    void *instance;
    struct mcr_technique technique[MCR_MAX_TECHNIQUES];
    uint32_t technique_count;
    uint32_t draws, densities; /* calls so far */
};

struct mcr_context {
    void *scratch;
    char message[256];
    uint32_t has_lights;
    uint32_t asked_by; /* the last `by` that a light service was asked for */
};

/* ---- plugins ---- */

static __attribute__((unused)) const struct mcr_plugin *load(const char *word)
{
    const char *folder = getenv("MCRENDER_PLUGIN_PATH");
    char path[4096], why[256];
    const struct mcr_plugin *plugin;
    void *handle;

    snprintf(path, sizeof path, "%s/%s.so", folder ? folder : "plugins/.libs", word);
    handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    plugin = handle ? dlsym(handle, "mcr_plugin") : NULL;
    if (!plugin || mcr_plugin_validate(plugin, word, why, sizeof why)) {
        printf("Bail out! %s: %s\n", path, plugin ? why : dlerror());
        exit(99);
    }
    return plugin;
}

/* The descriptor of a plugin of one word for an instruction set, NULL where the plugin or the processor lacks it. */
static __attribute__((unused)) const void *descriptor_of(const struct mcr_plugin *plugin, uint32_t isa)
{
    for (uint32_t k = 0; k < plugin->count; k++)
        if (plugin->list[k]->isa == isa && isa <= mcr_cpu_isa())
            return plugin->list[k];
    return NULL;
}

/* ---- arrays ---- */

/* n numbers, padded to 8 and followed by 8 more, all GUARD. */
static __attribute__((unused)) double *array(uint32_t n)
{
    uint32_t room = (n + 7) / 8 * 8 + 8;
    double *x = aligned_alloc(64, room * sizeof *x);

    for (uint32_t i = 0; i < room; i++)
        x[i] = GUARD;
    return x;
}

static __attribute__((unused)) int guarded(const double *x, uint32_t n)
{
    for (uint32_t i = n; i < (n + 7) / 8 * 8 + 8; i++)
        if (x[i] != GUARD)
            return 0;
    return 1;
}

/* Number i of stream `stream`, fixed for ever. */
static __attribute__((unused)) double fixed(uint64_t stream, uint64_t i)
{
    return mcr_number(mcr_mix64(stream + 1000), i);
}

static __attribute__((unused)) double *numbers(uint32_t n, uint64_t stream)
{
    double *x = array(n);

    for (uint32_t i = 0; i < n; i++)
        x[i] = fixed(stream, i);
    return x;
}

static __attribute__((unused)) struct mcr_directions directions_array(uint32_t n)
{
    return (struct mcr_directions){sizeof(struct mcr_directions), n, array(n), array(n), array(n)};
}

static __attribute__((unused)) void free_directions(struct mcr_directions *directions)
{
    free(directions->x);
    free(directions->y);
    free(directions->z);
}

/* A unit vector, uniform over the sphere. */
static __attribute__((unused)) void unit_vector(uint64_t stream, uint64_t i, double v[3])
{
    double z = 2 * fixed(stream, 2 * i) - 1, phi = 2 * M_PI * fixed(stream, 2 * i + 1), r = sqrt(1 - z * z);

    v[0] = r * cos(phi), v[1] = r * sin(phi), v[2] = z;
}

/* Points with normals all over the sphere, the first ones along the axes; geometric normals up to 0.3 rad off the shading normal. */
static __attribute__((unused)) struct mcr_points points_array(uint32_t n)
{
    double *a[13];

    for (int k = 0; k < 13; k++)
        a[k] = array(n);
    for (uint32_t i = 0; i < n; i++) {
        double normal[3], other[3], length = 0;

        unit_vector(1, i, normal);
        unit_vector(2, i, other);
        if (i < 6)
            for (int c = 0; c < 3; c++)
                normal[c] = c == (int)i % 3 ? (i < 3 ? 1 : -1) : 0;
        for (int c = 0; c < 3; c++) {
            a[c][i] = other[c];
            a[3 + c][i] = normal[c];
            other[c] = normal[c] + 0.3 * other[c];
            length += other[c] * other[c];
        }
        for (int c = 0; c < 3; c++) {
            a[6 + c][i] = other[c] / sqrt(length);
            a[9 + c][i] = normal[c];
        }
        a[12][i] = i % 2 ? 1 : -1;
    }
    return (struct mcr_points){.size = sizeof(struct mcr_points), .n = n, .px = a[0], .py = a[1], .pz = a[2], .nx = a[3], .ny = a[4], .nz = a[5],
                               .gx = a[6], .gy = a[7], .gz = a[8], .ox = a[9], .oy = a[10], .oz = a[11], .side = a[12]};
}

static __attribute__((unused)) void free_points(struct mcr_points *at)
{
    const double *a[13] = {at->px, at->py, at->pz, at->nx, at->ny, at->nz, at->gx, at->gy, at->gz, at->ox, at->oy, at->oz, at->side};

    for (int k = 0; k < 13; k++)
        free((void *)a[k]);
}

/* ---- services ---- */

static void stand_in_report(const struct mcr_host *host, struct mcr_context *context, uint32_t severity, const char *text)
{
    (void)host, (void)severity;
    snprintf(context->message, sizeof context->message, "%s", text);
}

static void *stand_in_scratch(const struct mcr_host *host, struct mcr_context *context)
{
    (void)host;
    return context->scratch;
}

static int32_t stand_in_techniques(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child,
                                   struct mcr_technique *technique, uint32_t *count)
{
    (void)host, (void)context;
    memcpy(technique, child->technique, child->technique_count * sizeof *technique);
    *count = child->technique_count;
    return MCR_OK;
}

/* The scratch of a call: not a number, so that what is read before it is written shows. */
static void *new_scratch(const struct mcr_directions_plugin *plugin, const void *instance, uint32_t n)
{
    size_t bytes = plugin->scratch_bytes ? plugin->scratch_bytes(instance, n) : 0;
    void *scratch = aligned_alloc(64, (bytes + 127) / 64 * 64);

    memset(scratch, 0xff, (bytes + 127) / 64 * 64);
    return scratch;
}

static int32_t stand_in_draw(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                             const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    void *before = context->scratch;
    int32_t status;

    ((struct mcr_child *)child)->draws++;
    context->scratch = new_scratch(child->plugin, child->instance, at->n);
    status = child->plugin->draw(host, context, child->instance, technique, at, number, out, density);
    free(context->scratch);
    context->scratch = before;
    return status;
}

static int32_t stand_in_density(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                                const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    void *before = context->scratch;
    int32_t status;

    ((struct mcr_child *)child)->densities++;
    context->scratch = new_scratch(child->plugin, child->instance, at->n);
    status = child->plugin->density(host, context, child->instance, technique, at, toward, density);
    free(context->scratch);
    context->scratch = before;
    return status;
}

static int32_t stand_in_mass(const struct mcr_host *host, struct mcr_context *context, const struct mcr_child *child, uint32_t technique,
                             const struct mcr_points *at, double *mass)
{
    void *before = context->scratch;
    int32_t status = MCR_OK;

    for (uint32_t i = 0; i < at->n && !child->plugin->mass; i++)
        mass[i] = 1;
    if (child->plugin->mass) {
        context->scratch = new_scratch(child->plugin, child->instance, at->n);
        status = child->plugin->mass(host, context, child->instance, technique, at, mass);
        free(context->scratch);
        context->scratch = before;
    }
    return status;
}

/* The light of this host: the direction +z alone where numbers 0 is below 1/2, nothing else; its "density" is 3 there. */
static int32_t stand_in_light_draw(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                                   const double *const *number, const struct mcr_directions *out, double *density)
{
    (void)host;
    context->asked_by = by;
    for (uint32_t i = 0; i < at->n; i++) {
        int hit = number[0][i] < 0.5;

        out->x[i] = out->y[i] = 0;
        out->z[i] = hit;
        if (density)
            density[i] = hit ? 3 : 0;
    }
    return MCR_OK;
}

static int32_t stand_in_light_density(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at,
                                      const struct mcr_directions *toward, double *density)
{
    (void)host;
    context->asked_by = by;
    for (uint32_t i = 0; i < at->n; i++)
        density[i] = toward->z[i] == 1 ? 3 : 0;
    return MCR_OK;
}

static int32_t stand_in_light_mass(const struct mcr_host *host, struct mcr_context *context, uint32_t by, const struct mcr_points *at, double *mass)
{
    (void)host;
    context->asked_by = by;
    for (uint32_t i = 0; i < at->n; i++)
        mass[i] = 0.5;
    return MCR_OK;
}

static uint32_t stand_in_has_lights(const struct mcr_host *host, struct mcr_context *context)
{
    (void)host;
    return context->has_lights;
}

static const struct mcr_host stand_in = {
    .size = sizeof stand_in,
    .major = MCR_PLUGIN_MAJOR,
    .minor = MCR_PLUGIN_MINOR,
    .report = stand_in_report,
    .scratch = stand_in_scratch,
    .child_techniques = stand_in_techniques,
    .child_draw = stand_in_draw,
    .child_density = stand_in_density,
    .child_mass = stand_in_mass,
    .light_draw = stand_in_light_draw,
    .light_density = stand_in_light_density,
    .light_mass = stand_in_light_mass,
    .has_lights = stand_in_has_lights,
};

/* Makes an instance of a direction plugin with its defaults, `first` being the first parameter's value; returns create's status. */
static __attribute__((unused)) int32_t make_child(struct mcr_child *child, struct mcr_context *context, const struct mcr_directions_plugin *plugin,
                                                  double first, uint32_t count, const struct mcr_child *const *inner, const double *weight)
{
    double number[3 * 64] = {first};
    uint32_t given[64] = {0};
    struct mcr_values values = {sizeof values, plugin->head.parameter_count, number, given};
    struct mcr_creation with = {sizeof with, count, &values, inner, weight, 16, 0};
    int32_t status;

    *child = (struct mcr_child){.plugin = plugin};
    context->message[0] = 0;
    status = plugin->create(&stand_in, context, &with, &child->instance);
    if (status)
        return status;
    for (uint32_t t = 0; t < MCR_MAX_TECHNIQUES; t++)
        child->technique[t].size = sizeof child->technique[t];
    child->technique_count = MCR_MAX_TECHNIQUES;
    return plugin->techniques(&stand_in, context, child->instance, child->technique, &child->technique_count);
}

static __attribute__((unused)) void destroy_child(struct mcr_child *child)
{
    if (child->plugin->destroy)
        child->plugin->destroy(child->instance);
}

#endif
