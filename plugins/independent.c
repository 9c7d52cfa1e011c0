/* SPDX-License-Identifier: Apache-2.0 */
/* independent: every number independent of all others, a hash of the path and the dimension. Ends every chain of number sources. */
#include <mcrender/sampler.h>

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    (void)host, (void)context, (void)with;
    *instance = NULL;
    return MCR_OK;
}

static uint32_t supplies(const void *instance, uint32_t first, uint32_t count)
{
    (void)instance, (void)first;
    return count;
}

static uint32_t correlated(const void *instance)
{
    (void)instance;
    return 0;
}

static void fill_fixed(uint32_t n, const uint64_t *restrict key, uint64_t dimension, double *restrict number)
{
    for (uint32_t i = 0; i < n; i++)
        number[i] = mcr_number(key[i], dimension);
}

static void fill_bounces(uint32_t n, const uint64_t *restrict key, const uint32_t *restrict bounce, uint64_t dimension,
                         double *restrict number)
{
    for (uint32_t i = 0; i < n; i++)
        number[i] = mcr_number(key[i], dimension + 32 * (uint64_t)bounce[i]);
}

static int32_t fill(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_samples *samples,
                    uint32_t first, uint32_t count, double *const *number)
{
    (void)host, (void)context, (void)instance;
    for (uint32_t k = 0; k < count; k++)
        if (first >= 8)
            fill_bounces(samples->n, samples->path_key, samples->bounce, (uint64_t)first + k, number[k]);
        else
            fill_fixed(samples->n, samples->path_key, (uint64_t)first + k, number[k]);
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_numbers_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_numbers_plugin),
             .kind = MCR_KIND_NUMBERS,
             .isa = MCR_ISA,
             .name = "independent",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "independent random numbers; the default"},
    .create = create,
    .supplies = supplies,
    .correlated = correlated,
    .fill = fill,
};

MCR_PLUGIN(struct mcr_numbers_plugin, descriptor);
