/* SPDX-License-Identifier: Apache-2.0 */
/* Arenas: memory for what lives as long as its owner (a tree, a scene), freed at once. Not thread-safe. */
#ifndef MCR_BASE_ARENA_H
#define MCR_BASE_ARENA_H

#include <stddef.h>
#include <stdint.h>

struct mcr_arena;

/* A new arena that hands out at most `limit` bytes (0: no limit). NULL when memory is short. */
struct mcr_arena *mcr_arena_create(size_t limit);
/* Frees all that was handed out. NULL is allowed. */
void mcr_arena_destroy(struct mcr_arena *arena);
/* Zeroed memory for count elements of `size` bytes, aligned to 64 bytes where count * size >= 64, else to 16.
 * NULL when memory or the limit is short or the product overflows. A count of 0 gives a valid pointer. */
void *mcr_arena_alloc(struct mcr_arena *arena, size_t count, size_t size);
/* A copy of length bytes with a NUL behind it; NULL when memory is short. */
char *mcr_arena_text(struct mcr_arena *arena, const char *text, size_t length);
/* Makes `size` bytes that came from malloc the arena's, to be freed with it. Returns 0, or -1 (limit or memory short: still the caller's). */
int mcr_arena_adopt(struct mcr_arena *arena, void *memory, size_t size);
/* Bytes handed out or adopted so far. */
size_t mcr_arena_used(const struct mcr_arena *arena);

#endif
