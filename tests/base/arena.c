/* SPDX-License-Identifier: Apache-2.0 */
/* Arenas: zeroed, aligned memory up to a limit, with products that cannot overflow; adopted memory. */
#include "base/arena.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

static int is_zero(const unsigned char *at, size_t length)
{
    for (size_t i = 0; i < length; i++)
        if (at[i])
            return 0;
    return 1;
}

/* Many pieces of all sizes: aligned, zeroed, and still what was written into them at the end (so none overlap). */
static void pieces(void)
{
    enum { COUNT = 4000 };
    static unsigned char *piece[COUNT];
    struct mcr_arena *arena = mcr_arena_create(0);
    size_t used = 0;
    int aligned = 1, zeroed = 1, kept = 1;

    for (unsigned i = 0; i < COUNT; i++) {
        size_t size = i % 500 == 499 ? 300000 : (i * 37u) % 700;
        piece[i] = mcr_arena_alloc(arena, size, 1);
        if (!piece[i]) {
            ok(0, "piece %u", i);
            return;
        }
        aligned &= (uintptr_t)piece[i] % (size >= 64 ? 64 : 16) == 0;
        zeroed &= is_zero(piece[i], size);
        memset(piece[i], (int)(i % 255 + 1), size);
        used += size;
    }
    for (unsigned i = 0; i < COUNT; i++) {
        size_t size = i % 500 == 499 ? 300000 : (i * 37u) % 700;
        for (size_t j = 0; j < size; j++)
            kept &= piece[i][j] == i % 255 + 1;
    }
    ok(aligned, "aligned to 64 bytes from 64 bytes on, else to 16");
    ok(zeroed, "zeroed");
    ok(kept, "no piece overlaps another");
    ok(mcr_arena_used(arena) == used, "the bytes handed out are counted");
    mcr_arena_destroy(arena);
}

static void limits(void)
{
    struct mcr_arena *arena = mcr_arena_create(1000);
    ok(mcr_arena_alloc(arena, 1000, 1) != NULL, "all of the limit can be had");
    ok(mcr_arena_alloc(arena, 1, 1) == NULL, "and not a byte more");
    ok(mcr_arena_alloc(arena, 0, 8) != NULL, "a count of 0 gives a valid pointer");
    ok(mcr_arena_text(arena, "", 0) == NULL, "the NUL of a text counts");
    mcr_arena_destroy(arena);

    arena = mcr_arena_create(0);
    ok(mcr_arena_alloc(arena, SIZE_MAX / 2, 3) == NULL, "a product that overflows is refused");
    ok(mcr_arena_alloc(arena, SIZE_MAX, 1) == NULL, "as is more than there can be");
    ok(mcr_arena_text(arena, "x", SIZE_MAX) == NULL, "also for text");
    ok(mcr_arena_used(arena) == 0, "what was refused is not counted");
    mcr_arena_destroy(arena);
    mcr_arena_destroy(NULL);
    ok(1, "NULL can be destroyed");
}

static void text(void)
{
    struct mcr_arena *arena = mcr_arena_create(0);
    char *copy = mcr_arena_text(arena, "abcdef", 3);
    ok(copy && strcmp(copy, "abc") == 0, "a text is copied and terminated");
    copy = mcr_arena_text(arena, "a\0b", 3);
    ok(copy && memcmp(copy, "a\0b", 4) == 0, "with a NUL in it");
    mcr_arena_destroy(arena);
}

static void adoption(void)
{
    struct mcr_arena *arena = mcr_arena_create(100);
    void *memory = malloc(60);
    ok(mcr_arena_adopt(arena, memory, 60) == 0 && mcr_arena_used(arena) == 60, "adopted memory is counted");
    memory = malloc(60);
    ok(mcr_arena_adopt(arena, memory, 60) == -1 && mcr_arena_used(arena) == 60, "and refused beyond the limit");
    free(memory);
    mcr_arena_destroy(arena); /* the sanitized run sees whether the first is freed */
}

int main(void)
{
    pieces();
    limits();
    text();
    adoption();
    return tap_done();
}
