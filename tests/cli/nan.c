/* SPDX-License-Identifier: Apache-2.0 */
/* A faulty material, for tests: it glows with radiance 1, but with NaN at a share of the points, or its operation fails. */
#include <math.h>
#include <mcrender/material.h>
#include <mcrender/sampler.h>
#include <string.h>

static const struct mcr_parameter parameters[] = {
    {.size = sizeof(struct mcr_parameter), .type = MCR_TYPE_NUMBER, .flags = MCR_PARAMETER_VARYING, .name = "share", .unit = "",
     .summary = "Share of the points where the radiance is not a number.", .fallback = {1}, .min = 0, .max = 1},
    {.size = sizeof(struct mcr_parameter), .type = MCR_TYPE_CHOICE, .name = "fails", .unit = "", .choices = "no|yes",
     .summary = "Whether the operation fails."},
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    static int fails;
    (void)host, (void)context;
    *instance = with->values->number[3] > 0 ? &fails : NULL;
    return MCR_OK;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    (void)host, (void)context, (void)instance, (void)values;
    traits->does = MCR_MATERIAL_EMITS_FRONT;
    traits->radiance[0] = traits->radiance[1] = traits->radiance[2] = 1;
    return MCR_OK;
}

/* Uniform in [0, 1), a function of the point alone: the mixing of SplitMix64. */
static double number_at(double x, double y)
{
    uint64_t a, b;
    memcpy(&a, &x, sizeof a);
    memcpy(&b, &y, sizeof b);
    a ^= b * UINT64_C(0x9e3779b97f4a7c15);
    a = (a ^ a >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    a = (a ^ a >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((a ^ a >> 31) >> 11) * 0x1p-53;
}

static int32_t emission(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                        const struct mcr_points *at, const struct mcr_colours *out)
{
    if (instance) {
        host->report(host, context, MCR_REPORT_ERROR, "the filament is broken");
        return MCR_E_INTERNAL;
    }
    for (uint32_t i = 0; i < at->n; i++)
        out->r[i] = out->g[i] = out->b[i] = number_at(at->px[i], at->py[i]) < inputs->channel[0][i * inputs->stride[0]] ? NAN : 1;
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin), .kind = MCR_KIND_MATERIAL, .isa = MCR_ISA, .parameter_count = 2, .name = "nan",
             .version = "1", .licence = "Apache-2.0", .summary = "a faulty lamp, for tests", .parameters = parameters},
    .create = create,
    .traits = traits,
    .emission = emission,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
