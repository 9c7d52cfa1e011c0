/* SPDX-License-Identifier: Apache-2.0 */
/* A faulty sampler, for tests: uniform over the hemisphere, but what it draws or tells is wrong for a share of the directions. */
#include <math.h>
#include <mcrender/sampler.h>
#include <string.h>

enum { NAN_DENSITY, NEGATIVE_DENSITY, INFINITE_DENSITY, NAN_DIRECTION, LONG_DIRECTION, FAULTS };
static const uint32_t faults[FAULTS] = {NAN_DENSITY, NEGATIVE_DENSITY, INFINITE_DENSITY, NAN_DIRECTION, LONG_DIRECTION};

static const struct mcr_parameter parameters[] = {
    {.size = sizeof(struct mcr_parameter), .type = MCR_TYPE_CHOICE, .name = "fault", .unit = "",
     .choices = "nan-density|negative-density|infinite-density|nan-direction|long-direction", .summary = "What is wrong, for a tenth of all directions."},
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    *instance = (void *)(uintptr_t)&faults[(uint32_t)with->values->number[0]];
    return mcr_without_children(host, context, with);
}

static int32_t techniques(const struct mcr_host *host, struct mcr_context *context, const void *instance, struct mcr_technique *technique,
                          uint32_t *count)
{
    (void)host, (void)context, (void)instance;
    technique[0].kind = MCR_TECHNIQUE_DIRECTION;
    technique[0].covers = MCR_COVERS_REFLECTION;
    technique[0].continues = 1;
    technique[0].dimensions = 2;
    *count = 1;
    return MCR_OK;
}

/* A tenth of all directions, by the mixing of SplitMix64. */
static int is_hit(double x, double y)
{
    uint64_t a, b;
    memcpy(&a, &x, sizeof a);
    memcpy(&b, &y, sizeof b);
    a ^= b * UINT64_C(0x9e3779b97f4a7c15);
    a = (a ^ a >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    a = (a ^ a >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((a ^ a >> 31) >> 11) * 0x1p-53 < 0.1;
}

static int32_t density(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                       const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    static const double wrong[] = {NAN, -1, HUGE_VAL};
    const uint32_t fault = *(const uint32_t *)instance;
    (void)host, (void)context, (void)technique;
    for (uint32_t i = 0; i < at->n; i++) {
        density[i] = 0.15915494309189535;
        if (fault <= INFINITE_DENSITY && is_hit(toward->x[i], toward->y[i]))
            density[i] = wrong[fault];
    }
    return MCR_OK;
}

static int32_t draw(const struct mcr_host *host, struct mcr_context *context, const void *instance, uint32_t technique,
                    const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *densities)
{
    const uint32_t fault = *(const uint32_t *)instance;
    for (uint32_t i = 0; i < at->n; i++) {
        double lx, ly, height = mcr_disk_from_square(number[0][i], number[1][i], &lx, &ly), spread = sqrt(1 + height);
        mcr_to_world(at->nx[i], at->ny[i], at->nz[i], lx * spread, ly * spread, height, &out->x[i], &out->y[i], &out->z[i]);
        if (fault >= NAN_DIRECTION && is_hit(out->x[i], out->y[i]))
            out->z[i] *= fault == NAN_DIRECTION ? NAN : 1e300;
    }
    return densities ? density(host, context, instance, technique, at, out, densities) : MCR_OK;
}

MCR_HIDDEN const struct mcr_directions_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_directions_plugin),
             .kind = MCR_KIND_DIRECTIONS,
             .isa = MCR_ISA,
             .name = "astray",
             .version = "1",
             .licence = "Apache-2.0",
             .summary = "faults for tests",
             .parameter_count = 1,
             .parameters = parameters},
    .create = create,
    .techniques = techniques,
    .draw = draw,
    .density = density,
};

MCR_PLUGIN(struct mcr_directions_plugin, descriptor);
