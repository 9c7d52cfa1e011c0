/* SPDX-License-Identifier: Apache-2.0 */
/*
 * An arena is a list of chunks. Small pieces are cut from the newest chunk, whose size grows with the arena; what would fill a quarter of
 * a chunk gets one of its own. Chunks come from calloc, so that large ones cost pages only where they are touched.
 */
#include "base/arena.h"

#include <stdlib.h>
#include <string.h>

#define FIRST_CHUNK ((size_t)16 << 10)
#define LAST_CHUNK ((size_t)1 << 20)
#define LINE ((size_t)64)

struct chunk {
    struct chunk *next;
    void *adopted; /* instead of memory behind this header */
};

struct mcr_arena {
    struct chunk *chunks;
    unsigned char *at, *end; /* the rest of the newest chunk that is shared */
    size_t chunk_size, limit, used;
};

struct mcr_arena *mcr_arena_create(size_t limit)
{
    struct mcr_arena *arena = calloc(1, sizeof *arena);
    if (arena) {
        arena->limit = limit ? limit : SIZE_MAX;
        arena->chunk_size = FIRST_CHUNK;
    }
    return arena;
}

void mcr_arena_destroy(struct mcr_arena *arena)
{
    if (!arena)
        return;
    for (struct chunk *chunk = arena->chunks, *next; chunk; chunk = next) {
        next = chunk->next;
        free(chunk->adopted);
        free(chunk);
    }
    free(arena);
}

static unsigned char *aligned(unsigned char *at, size_t alignment)
{
    return at + (-(uintptr_t)at & (alignment - 1));
}

/* A new chunk with room for `size` bytes at any alignment; NULL when memory is short. */
static unsigned char *add_chunk(struct mcr_arena *arena, size_t size)
{
    struct chunk *chunk = size > SIZE_MAX - sizeof *chunk - LINE ? NULL : calloc(1, sizeof *chunk + LINE + size);
    if (!chunk)
        return NULL;
    chunk->next = arena->chunks;
    arena->chunks = chunk;
    return (unsigned char *)(chunk + 1);
}

void *mcr_arena_alloc(struct mcr_arena *arena, size_t count, size_t size)
{
    size_t bytes, alignment;
    unsigned char *at;

    if (size && count > SIZE_MAX / size)
        return NULL;
    bytes = count * size;
    if (bytes > arena->limit - arena->used)
        return NULL;
    alignment = bytes >= LINE ? LINE : 16;
    at = arena->at ? aligned(arena->at, alignment) : NULL;
    if (at && at <= arena->end && bytes <= (size_t)(arena->end - at)) {
        arena->at = at + bytes;
    } else if (bytes >= arena->chunk_size / 4) {
        at = add_chunk(arena, bytes);
        if (!at)
            return NULL;
        at = aligned(at, alignment);
    } else {
        at = add_chunk(arena, arena->chunk_size);
        if (!at)
            return NULL;
        arena->end = at + arena->chunk_size; /* and a line more, so that aligning stays within the chunk */
        at = aligned(at, alignment);
        arena->at = at + bytes;
        if (arena->chunk_size < LAST_CHUNK)
            arena->chunk_size *= 2;
    }
    arena->used += bytes;
    return at;
}

char *mcr_arena_text(struct mcr_arena *arena, const char *text, size_t length)
{
    char *copy = length == SIZE_MAX ? NULL : mcr_arena_alloc(arena, length + 1, 1);
    if (copy && length)
        memcpy(copy, text, length);
    return copy;
}

int mcr_arena_adopt(struct mcr_arena *arena, void *memory, size_t size)
{
    struct chunk *chunk;
    if (size > arena->limit - arena->used)
        return -1;
    chunk = calloc(1, sizeof *chunk);
    if (!chunk)
        return -1;
    chunk->adopted = memory;
    chunk->next = arena->chunks;
    arena->chunks = chunk;
    arena->used += size;
    return 0;
}

size_t mcr_arena_used(const struct mcr_arena *arena)
{
    return arena->used;
}
