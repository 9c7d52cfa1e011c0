/* SPDX-License-Identifier: Apache-2.0 */
/* mirror: reflects each direction into one, on both sides, the same share at all angles. Nothing else is scattered: no density serves it. */
#include <mcrender/microfacet.h>

static const struct mcr_parameter parameters[] = {
    {.size = sizeof(struct mcr_parameter),
     .type = MCR_TYPE_COLOUR,
     .flags = MCR_PARAMETER_VARYING,
     .name = "reflectance",
     .unit = "",
     .summary = "Share of the arriving light that is reflected, at all angles.",
     .fallback = {0.9, 0.9, 0.9},
     .min = 0,
     .max = 1},
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    (void)host, (void)context, (void)with;
    *instance = NULL;
    return MCR_OK;
}

static int32_t traits(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_values *values,
                      struct mcr_material_traits *traits)
{
    (void)host, (void)context, (void)instance, (void)values;
    traits->does = MCR_MATERIAL_DELTA;
    return MCR_OK;
}

/* Where the shading normal would reflect below the geometric surface, the light is absorbed: the one lobe is chosen and has no direction. */
static void reflect_lanes(const struct mcr_points *at, double *restrict x, double *restrict y, double *restrict z, double *restrict weight)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_vector n = mcr_vector(nx[i], ny[i], nz[i]), o = mcr_vector(ox[i], oy[i], oz[i]), w = mcr_mirrored(o, n, mcr_dot(n, n));
        double fix = 0.5 * (1 - mcr_dot(w, w));
        int above = (mcr_dot(n, o) > 0) & (gx[i] * w.x + gy[i] * w.y + gz[i] * w.z > 0);

        x[i] = above ? w.x + w.x * fix : 0;
        y[i] = above ? w.y + w.y * fix : 0;
        z[i] = above ? w.z + w.z * fix : 0;
        weight[i] = above ? 1 : 0;
    }
}

static int32_t delta(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                     const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *probability,
                     const struct mcr_colours *weight)
{
    double *channel[3] = {weight->r, weight->g, weight->b};

    (void)host, (void)context, (void)instance, (void)number;
    mcr_fill_lanes(at->n, 1, probability);
    for (uint32_t c = 0; c < 3; c++) {
        reflect_lanes(at, out->x, out->y, out->z, channel[c]);
        mcr_multiply_lanes(at->n, inputs->channel[c], inputs->stride[c], channel[c]);
    }
    return MCR_OK;
}

static int32_t albedo(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_inputs *inputs,
                      const struct mcr_points *at, const struct mcr_colours *out)
{
    (void)host, (void)context, (void)instance;
    mcr_colour_lanes(at->n, inputs, 0, out);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_material_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_material_plugin),
             .kind = MCR_KIND_MATERIAL,
             .isa = MCR_ISA,
             .parameter_count = 1,
             .name = "mirror",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "perfect mirror, two-sided",
             .parameters = parameters},
    .flags = MCR_MATERIAL_STATELESS,
    .create = create,
    .traits = traits,
    .delta = delta,
    .albedo = albedo,
};

MCR_PLUGIN(struct mcr_material_plugin, descriptor);
