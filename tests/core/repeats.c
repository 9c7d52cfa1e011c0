/* SPDX-License-Identifier: Apache-2.0 */
/*
 * For testing that the tests of number sources can fail: `repeats` supplies independent numbers, but of the first bounce for all bounces, as a renderer
 * does whose dimensions run out along a path; `repeats-twice` those of the first two bounces, in turn.
 */
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

static void repeat(const struct mcr_samples *samples, uint32_t period, uint32_t first, uint32_t count, double *const *number)
{
    for (uint32_t k = 0; k < count; k++)
        for (uint32_t i = 0; i < samples->n; i++)
            number[k][i] = mcr_number(samples->path_key[i], first + k + (first < 8 ? 0 : 32 * (samples->bounce[i] % period)));
}

static int32_t fill_one(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_samples *samples,
                        uint32_t first, uint32_t count, double *const *number)
{
    (void)host, (void)context, (void)instance;
    repeat(samples, 1, first, count, number);
    return MCR_OK;
}

static int32_t fill_two(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_samples *samples,
                        uint32_t first, uint32_t count, double *const *number)
{
    (void)host, (void)context, (void)instance;
    repeat(samples, 2, first, count, number);
    return MCR_OK;
}

#define HEAD(NAME) {sizeof(struct mcr_numbers_plugin), MCR_KIND_NUMBERS, MCR_ISA_BASELINE, 0, NAME, "1", "Apache-2.0", "for tests", NULL}

static const struct mcr_numbers_plugin repeats = {.head = HEAD("repeats"), .create = create, .supplies = supplies, .correlated = correlated,
                                                  .fill = fill_one};
static const struct mcr_numbers_plugin twice = {.head = HEAD("repeats-twice"), .create = create, .supplies = supplies, .correlated = correlated,
                                                .fill = fill_two};

static const struct mcr_descriptor *const list[] = {&repeats.head, &twice.head};

MCR_EXPORT const struct mcr_plugin mcr_plugin = {sizeof mcr_plugin, MCR_PLUGIN_MAJOR, MCR_PLUGIN_MINOR, 2, list};
