/* SPDX-License-Identifier: Apache-2.0 */
/* Arrays with an owner of their own: sizes checked, aligned, zeroed. What lives as long as a scene belongs into an arena instead. */
#ifndef MCR_BASE_MEMORY_H
#define MCR_BASE_MEMORY_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define MCR_ALIGNMENT 64u /* a cache line, and the widest vector */

/* *product = a * b; 0 if that overflows. */
static inline int mcr_size_mul(size_t a, size_t b, size_t *product)
{
    return !__builtin_mul_overflow(a, b, product);
}

/* Zeroed memory for count elements of `size` bytes, aligned to 64 and padded to a multiple of 64 bytes; free() releases it. NULL when
 * memory is short or the size overflows. A count of 0 gives a valid pointer. */
static inline void *mcr_array_alloc(size_t count, size_t size)
{
    size_t bytes;
    void *memory;
    if (!mcr_size_mul(count, size, &bytes) || bytes > PTRDIFF_MAX - MCR_ALIGNMENT)
        return NULL;
    bytes = bytes ? (bytes + MCR_ALIGNMENT - 1) / MCR_ALIGNMENT * MCR_ALIGNMENT : MCR_ALIGNMENT;
    memory = aligned_alloc(MCR_ALIGNMENT, bytes);
    return memory ? memset(memory, 0, bytes) : NULL;
}

#endif
