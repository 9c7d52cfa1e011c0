/* SPDX-License-Identifier: Apache-2.0 */
#include "base/memory.h"
#include "../tap.h"

int main(void)
{
    static const size_t counts[] = {0, 1, 7, 8, 9, 1000};
    size_t product;
    int good = 1;

    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        unsigned char *memory = mcr_array_alloc(counts[i], 8);
        good &= memory && (uintptr_t)memory % MCR_ALIGNMENT == 0;
        for (size_t b = 0; memory && b < (counts[i] * 8 + 63) / 64 * 64; b++) {
            good &= memory[b] == 0;
            memory[b] = 0xff;
        }
        free(memory);
    }
    ok(good, "arrays are aligned, zeroed and padded to a cache line");
    ok(mcr_size_mul(SIZE_MAX / 2, 2, &product) && product == SIZE_MAX - 1 && !mcr_size_mul(SIZE_MAX / 2 + 1, 2, &product), "products are checked");
    ok(!mcr_array_alloc(SIZE_MAX / 8 + 1, 8) && !mcr_array_alloc(PTRDIFF_MAX, 1) && !mcr_array_alloc(SIZE_MAX, 1), "sizes that overflow give NULL");
    return tap_done();
}
