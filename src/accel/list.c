/* SPDX-License-Identifier: Apache-2.0 */
/* The list: all shapes against blocks of rays. Stage file, compiled once per instruction set. */
#include "accel/block.h"

static inline __attribute__((always_inline)) void block_run(const struct mcr_accel *accel, const struct mcr_rays *rays, uint32_t first, const double *far,
                                                            struct mcr_block *b)
{
    block_begin(accel, rays, first, far, accel->inverses, b);
    for (uint32_t s = 0; s < accel->shape_count; s++)
        block_shape(&accel->shape[s], b);
    for (uint32_t f = 0; f < accel->triangles->count; f++)
        block_triangle(accel->triangles, f, b);
}

void MCR_ISA_NAME(mcr_list_closest)(const struct mcr_accel *accel, const struct mcr_rays *rays, double *t, int64_t *primitive)
{
    for (uint32_t first = 0; first < rays->n; first += MCR_ACCEL_BLOCK) {
        struct mcr_block b;
        block_run(accel, rays, first, NULL, &b);
        block_end(&b, t + first, primitive + first);
    }
}

void MCR_ISA_NAME(mcr_list_visible)(const struct mcr_accel *accel, const struct mcr_rays *rays, const double *far, double *visible)
{
    for (uint32_t first = 0; first < rays->n; first += MCR_ACCEL_BLOCK) {
        struct mcr_block b;
        block_run(accel, rays, first, far, &b);
        MCR_LANES
        for (uint32_t i = 0; i < b.count; i++)
            visible[first + i] = b.primitive[i] < 0 ? 1.0 : 0.0;
    }
}
