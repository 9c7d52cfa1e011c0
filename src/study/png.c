/* SPDX-License-Identifier: Apache-2.0 */
#include "study/png.h"

#include <stdlib.h>
#include <string.h>

#define PIXEL 3u          /* bytes */
#define SYMBOLS 286u      /* literals, the end, lengths of matches */
#define END 256u
#define LONGEST_CODE 15u
#define LONGEST_RUN 258u
#define SHORTEST_RUN 4u   /* RFC 1951 begins at 3: as long as three literals of zeros */

/* Bits from the least significant on, as RFC 1951 packs them. */
struct bits {
    unsigned char *at;
    uint64_t held;
    uint32_t count;
};

static void put_bits(struct bits *bits, uint32_t value, uint32_t count)
{
    bits->held |= (uint64_t)value << bits->count;
    for (bits->count += count; bits->count >= 8; bits->count -= 8, bits->held >>= 8)
        *bits->at++ = (unsigned char)bits->held;
}

/* ---- filters --------------------------------------------------------------------------------------------------------------------- */

static int paeth(int left, int up, int corner)
{
    int guess = left + up - corner, a = abs(guess - left), b = abs(guess - up), c = abs(guess - corner);
    return a <= b && a <= c ? left : b <= c ? up : corner;
}

/* One row after filter 0 .. 4; returns the sum of the residues as signed bytes: the smaller, the shorter it will be. */
static uint32_t filter_row(const uint8_t *row, const uint8_t *above, uint32_t bytes, uint32_t filter, uint8_t *to)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < bytes; i++) {
        int left = i >= PIXEL ? row[i - PIXEL] : 0, up = above ? above[i] : 0, corner = above && i >= PIXEL ? above[i - PIXEL] : 0;
        int guess = filter == 0 ? 0 : filter == 1 ? left : filter == 2 ? up : filter == 3 ? (left + up) / 2 : paeth(left, up, corner);
        to[i] = (uint8_t)(row[i] - guess);
        sum += to[i] < 128 ? to[i] : 256u - to[i];
    }
    return sum;
}

/* All rows, each behind the number of its filter. `trial` holds a row. */
static void filter_all(const uint8_t *rgb, uint32_t width, uint32_t height, uint8_t *trial, uint8_t *to)
{
    uint32_t bytes = PIXEL * width;
    for (uint32_t y = 0; y < height; y++, to += bytes + 1) {
        const uint8_t *row = rgb + (size_t)y * bytes, *above = y ? row - bytes : NULL;
        uint32_t best = UINT32_MAX;
        for (uint32_t filter = 0; filter < 5; filter++) {
            uint32_t sum = filter_row(row, above, bytes, filter, trial);
            if (sum >= best)
                continue;
            best = sum;
            to[0] = (uint8_t)filter;
            memcpy(to + 1, trial, bytes);
        }
    }
}

/* ---- Huffman's code -------------------------------------------------------------------------------------------------------------- */

struct code {
    uint32_t frequency[SYMBOLS];
    uint8_t length[SYMBOLS];
    uint16_t bits[SYMBOLS]; /* reversed, as they are written */
};

/* Depths of Huffman's tree over weight[]: the two lightest nodes are joined, again and again. Returns the greatest. */
static uint32_t tree_depths(const uint32_t weight[SYMBOLS], uint8_t depth[SYMBOLS])
{
    uint64_t node[2 * SYMBOLS];
    uint32_t parent[2 * SYMBOLS] = {0}, count = SYMBOLS, deepest = 0;
    for (uint32_t i = 0; i < SYMBOLS; i++)
        node[i] = weight[i];
    for (;; count++) {
        uint32_t least = UINT32_MAX, next = UINT32_MAX; /* weight 0: no node, or joined already */
        for (uint32_t i = 0; i < count; i++) {
            if (!node[i])
                continue;
            if (least == UINT32_MAX || node[i] < node[least])
                next = least, least = i;
            else if (next == UINT32_MAX || node[i] < node[next])
                next = i;
        }
        if (next == UINT32_MAX)
            break;
        node[count] = node[least] + node[next];
        node[least] = node[next] = 0;
        parent[least] = parent[next] = count;
    }
    for (uint32_t i = 0; i < SYMBOLS; i++) {
        uint32_t steps = 0;
        for (uint32_t at = i; weight[i] && parent[at]; at = parent[at])
            steps++;
        depth[i] = (uint8_t)steps;
        deepest = steps > deepest ? steps : deepest;
    }
    return deepest;
}

/* Lengths of at most 15 bits (flatter weights where the tree is deeper), and the canonical code of RFC 1951, 3.2.2. */
static void make_code(struct code *code)
{
    uint32_t weight[SYMBOLS], first[LONGEST_CODE + 2] = {0};
    memcpy(weight, code->frequency, sizeof weight);
    while (tree_depths(weight, code->length) > LONGEST_CODE)
        for (uint32_t i = 0; i < SYMBOLS; i++)
            weight[i] = (weight[i] + 1) / 2;
    for (uint32_t i = 0; i < SYMBOLS; i++)
        if (code->length[i])
            first[code->length[i] + 1]++;
    for (uint32_t n = 2; n <= LONGEST_CODE; n++)
        first[n] = (first[n] + first[n - 1]) << 1;
    for (uint32_t i = 0; i < SYMBOLS; i++) {
        uint32_t length = code->length[i], value = length ? first[length]++ : 0, reversed = 0;
        for (uint32_t b = 0; b < length; b++)
            reversed |= (value >> b & 1) << (length - 1 - b);
        code->bits[i] = (uint16_t)reversed;
    }
}

/* ---- the stream ------------------------------------------------------------------------------------------------------------------ */

/* How many bytes from `at` on repeat the one before it, up to the longest run. */
static uint32_t run_at(const uint8_t *bytes, size_t at, size_t count)
{
    uint32_t run = 0;
    while (at && run < LONGEST_RUN && at + run < count && bytes[at + run] == bytes[at - 1])
        run++;
    return run >= SHORTEST_RUN ? run : 0;
}

/* RFC 1951, 3.2.5: the symbol of a match's length, its extra bits and their number. */
static uint32_t length_symbol(uint32_t run, uint32_t *extra, uint32_t *extra_bits)
{
    uint32_t base = 3, symbol = 257;
    *extra = *extra_bits = 0;
    if (run == LONGEST_RUN)
        return 285;
    for (;; symbol++) {
        uint32_t bits = symbol < 265 ? 0 : (symbol - 261) / 4;
        if (run < base + (1u << bits)) {
            *extra = run - base;
            *extra_bits = bits;
            return symbol;
        }
        base += 1u << bits;
    }
}

/* Counts the symbols (bits: NULL), or writes them. */
static void walk(const uint8_t *bytes, size_t count, struct code *code, struct bits *bits)
{
    uint32_t extra, extra_bits;
    for (size_t at = 0; at < count;) {
        uint32_t run = run_at(bytes, at, count), symbol = run ? length_symbol(run, &extra, &extra_bits) : bytes[at];
        at += run ? run : 1;
        if (!bits) {
            code->frequency[symbol]++;
            continue;
        }
        put_bits(bits, code->bits[symbol], code->length[symbol]);
        if (run) {
            put_bits(bits, extra, extra_bits);
            put_bits(bits, 0, 1); /* the one distance: 1 */
        }
    }
}

/* One block with a code of its own; the code lengths stand in four bits each, without runs. Returns the end. */
static unsigned char *deflate(const uint8_t *bytes, size_t count, unsigned char *to)
{
    struct code code = {.frequency = {[END] = 1}};
    struct bits bits = {.at = to};
    walk(bytes, count, &code, NULL);
    make_code(&code);
    put_bits(&bits, 1 | 2 << 1, 3);             /* the last block; a dynamic code */
    put_bits(&bits, SYMBOLS - 257, 5);
    put_bits(&bits, 0, 5);                      /* one distance */
    put_bits(&bits, 19 - 4, 4);
    for (uint32_t i = 0; i < 19; i++)           /* in the order 16 17 18 0 8 7 ...: 0 to 15 have codes of 4 bits */
        put_bits(&bits, i < 3 ? 0 : 4, 3);
    for (uint32_t i = 0; i <= SYMBOLS; i++) {
        uint32_t length = i < SYMBOLS ? code.length[i] : 1;
        put_bits(&bits, (length & 1) << 3 | (length & 2) << 1 | (length & 4) >> 1 | length >> 3, 4);
    }
    walk(bytes, count, &code, &bits);
    put_bits(&bits, code.bits[END], code.length[END]);
    put_bits(&bits, 0, 7);
    return bits.at;
}

static unsigned char *put32(unsigned char *to, uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        *to++ = (unsigned char)(value >> shift);
    return to;
}

static uint32_t adler32(const uint8_t *bytes, size_t count)
{
    uint32_t a = 1, b = 0;
    for (size_t i = 0; i < count; i++) {
        a = (a + bytes[i]) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

static uint32_t crc32(const unsigned char *bytes, size_t count)
{
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

/* A chunk whose content stands at chunk + 8 already, up to `end`: its length and kind before it, its checksum behind it. Returns the end. */
static unsigned char *chunk(unsigned char *chunk, const char *kind, unsigned char *end)
{
    put32(chunk, (uint32_t)(end - chunk - 8));
    memcpy(chunk + 4, kind, 4);
    return put32(end, crc32(chunk + 4, (size_t)(end - chunk - 4)));
}

unsigned char *mcr_png_encode(const uint8_t *rgb, uint32_t width, uint32_t height, size_t *length)
{
    if (!width || !height || width > MCR_PNG_MAX_SIDE || height > MCR_PNG_MAX_SIDE)
        return NULL;
    size_t row = (size_t)PIXEL * width, count = (row + 1) * height;
    uint8_t *filtered = malloc(count + row);
    unsigned char *png = malloc(count * 2 + 4096); /* a symbol has at most 15 bits, a run of 4 at most 16 */
    if (filtered && png) {
        unsigned char *at = memcpy(png, "\x89PNG\r\n\x1a\n", 8), *end;
        at += 8;
        end = put32(put32(at + 8, width), height);
        memcpy(end, "\x08\x02\0\0\0", 5); /* 8 bits, RGB */
        at = chunk(at, "IHDR", end + 5);
        at[8] = 0;                        /* how the colours are meant: perceptual */
        at = chunk(at, "sRGB", at + 9);
        filter_all(rgb, width, height, filtered + count, filtered);
        at[8] = 0x78;                     /* zlib (RFC 1950) */
        at[9] = 0x01;
        end = put32(deflate(filtered, count, at + 10), adler32(filtered, count));
        at = chunk(at, "IDAT", end);
        at = chunk(at, "IEND", at + 8);
        *length = (size_t)(at - png);
    } else {
        free(png);
        png = NULL;
    }
    free(filtered);
    return png;
}
