/* SPDX-License-Identifier: Apache-2.0 */
/* independent: the published function of path and dimension, for every group, in every instruction set. */
#include "stand_in.h"

#define LANES 1003u

int main(void)
{
    static const struct {
        uint32_t first, count;
    } group[] = {{0, 2}, {2, 2}, {1, 1}, {8, 16}, {11, 13}, {24, 4}, {28, 4}, {32, 1}};
    static uint64_t pixel_key[LANES], path_key[LANES];
    static uint32_t sample[LANES], planned[LANES], bounce[LANES];
    static struct mcr_context context;
    const struct mcr_plugin *file = load("independent");
    struct mcr_samples samples = {.size = sizeof samples, .n = LANES, .pixel_key = pixel_key, .path_key = path_key,
                                  .index = sample, .planned = planned, .bounce = bounce};
    double *number[16];

    for (uint32_t i = 0; i < LANES; i++) {
        pixel_key[i] = mcr_pixel_key(mcr_replicate_key(3, 0), i / 10);
        path_key[i] = mcr_path_key(pixel_key[i], i % 10);
        sample[i] = i % 10, planned[i] = 10;
        bounce[i] = i < 10 ? UINT32_MAX - i : i % 7 ? i % 7 : i * 1000003; /* far beyond 2^27, where 32 * bounce leaves 32 bits */
    }
    for (uint32_t isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        const struct mcr_numbers_plugin *plugin = descriptor_of(file, isa);

        if (!plugin) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        ok(plugin->correlated(NULL) == 0, "isa %u: not correlated", isa);
        for (uint32_t g = 0; g < sizeof group / sizeof *group; g++) {
            uint32_t wrong = plugin->supplies(NULL, group[g].first, group[g].count) != group[g].count, guards = 0;

            for (uint32_t k = 0; k < group[g].count; k++)
                number[k] = array(LANES);
            wrong += plugin->fill(&stand_in, &context, NULL, &samples, group[g].first, group[g].count, number) != MCR_OK;
            for (uint32_t k = 0; k < group[g].count; k++) {
                for (uint32_t i = 0; i < LANES; i++) {
                    uint64_t dimension = group[g].first + k + (group[g].first >= 8 ? 32 * (uint64_t)bounce[i] : 0);
                    wrong += number[k][i] != (double)(mcr_dimension_bits(path_key[i], dimension) >> 11) * 0x1p-53;
                }
                guards += !guarded(number[k], LANES);
                free(number[k]);
            }
            ok(wrong == 0 && guards == 0, "isa %u: dimensions %u to %u", isa, group[g].first, group[g].first + group[g].count - 1);
        }
    }
    return tap_done();
}
