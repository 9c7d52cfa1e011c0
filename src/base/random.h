/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Random numbers as a pure function of (seed, replicate, pixel, sample, dimension): no state, so that threads, order and batch
 * size cannot matter. Each level of the key is a bijection of the level above plus its index times an odd constant:
 *
 *     replicate key = mix(mix(seed) + replicate * C3)
 *     pixel key  = mix(replicate key + pixel * C1)
 *     path key   = mix(pixel key + sample * C2)
 *     bits       = mix(path key + (dimension + 1) * golden)        (a path's numbers are splitmix64 started at its key)
 *
 * Within one seed no two replicates, no two samples of a pixel and no two dimensions of a path can share a key. Two paths overlap
 * in some dimension only where their keys differ by a small multiple of golden: with probability 2 D / 2^64 for a pair and D
 * dimensions, so that among the pairs of 10^9 paths with 200 dimensions about ten share numbers.
 * All functions are free of branches and libm, and loops over them are vectorised; but without AVX2 the compilers rightly find
 * 64-bit products faster one by one, so that bits and their conversion to doubles are best left to two loops.
 * May be called from any thread.
 */
#ifndef MCR_BASE_RANDOM_H
#define MCR_BASE_RANDOM_H

#include "base/elementary.h"
#include <mcrender/sampler.h> /* mcr_mix64, mcr_unit_double and mcr_number: public, so that plugins derive numbers in the same way */

/* 2^64 / golden ratio, of splitmix64; the fractional bits of sqrt 2 (made odd), of sqrt 3, and of sqrt 5 (made odd). */
#define MCR_GOLDEN UINT64_C(0x9e3779b97f4a7c15)
#define MCR_KEY_PIXEL UINT64_C(0x6a09e667f3bcc909)
#define MCR_KEY_SAMPLE UINT64_C(0xbb67ae8584caa73b)
#define MCR_KEY_REPLICATE UINT64_C(0x3c6ef372fe94f82b)

MCR_INLINE uint64_t mcr_replicate_key(uint64_t seed, uint64_t replicate)
{
    return mcr_mix64(mcr_mix64(seed) + replicate * MCR_KEY_REPLICATE);
}

MCR_INLINE uint64_t mcr_pixel_key(uint64_t replicate_key, uint64_t pixel)
{
    return mcr_mix64(replicate_key + pixel * MCR_KEY_PIXEL);
}

MCR_INLINE uint64_t mcr_path_key(uint64_t pixel_key, uint64_t sample)
{
    return mcr_mix64(pixel_key + sample * MCR_KEY_SAMPLE);
}

MCR_INLINE uint64_t mcr_dimension_bits(uint64_t path_key, uint64_t dimension)
{
    return mcr_mix64(path_key + (dimension + 1) * MCR_GOLDEN);
}

#endif
