/* SPDX-License-Identifier: Apache-2.0 */
/*
 * bluenoise: the errors of neighbouring pixels cancel, so that a picture of few samples looks and blurs better; the expectation of every pixel is true.
 *
 * A. Ahmed, P. Wonka, "Screen-space blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering of pixels", ACM TOG 39(6), 2020.
 * One scrambled (0,2)-sequence goes over all pixels of a tile in Morton's Z-order: N points for a pixel, the next N for its neighbour, and so on. The
 * points of a pixel, of any block of 2^k x 2^k pixels that the order visits in one go, and of the tile are then well spread each. In the order, the four
 * quarters of every block are permuted at random, which makes the spectrum of the error the same in all directions: blue, low frequencies are weak.
 *
 * Groups.  As in sobol: the pixel and the lens are groups of 2 dimensions, in bounces every 4 dimensions are one (mcrender/nets.h). Every group has a
 *   scramble and an order of the pixels of its own, and every pixel an order of its samples for every group, a random permutation: groups share nothing
 *   within a pixel. (Samples in order would make a picture that is interrupted worse than one of independent numbers: its pixels would have their
 *   points in the same part of the square.)
 * Tiles.   256 x 256 pixels, or as many as make at most 2^32 points; tiles are independent of each other.
 * Values.  A. Owen's nested uniform scramble, by a hash, the same for all pixels of a tile. Any point is uniform, hence no bias; a pixel's N points are
 *   as well spread as N successive ones of Sobol's sequence, a net where N is a power of two.
 * Keys.    Hashes of the replicate's key, the tile and the dimension; of the pixel's key for the order of its samples. Pixels for which another number of
 *   samples is planned have other keys, lest they share points.
 */
#include <mcrender/nets.h>
#include <stdlib.h>

#define BLOCK 256u      /* lanes that go through the loops together: their arrays are on the stack */
#define MOST_LEVELS 8u  /* a tile has 2^levels pixels across */

/* Odd: the fractional bits of sqrt 23 (tiles), sqrt 29 (pixels' order), sqrt 31 (values), sqrt 37 (samples' order). */
#define KEY_TILE UINT64_C(0xcbbb9d5dc1059ed9)
#define KEY_RANK UINT64_C(0x629a292a367cd507)
#define KEY_VALUE UINT64_C(0x9159015a3070dd17)
#define KEY_ORDER UINT64_C(0x152fecd8f70e5939)

struct bluenoise {
    uint32_t column[2][MCR_NET_BITS]; /* dimensions 3 and 4 */
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    struct bluenoise *bluenoise = malloc(sizeof *bluenoise);

    (void)host, (void)context, (void)with;
    if (!bluenoise)
        return MCR_E_NOMEM;
    mcr_net_columns(bluenoise->column);
    *instance = bluenoise;
    return MCR_OK;
}

static void destroy(void *instance)
{
    free(instance);
}

/* All there are. */
static uint32_t supplies(const void *instance, uint32_t first, uint32_t count)
{
    (void)instance, (void)first;
    return count;
}

static uint32_t correlated(const void *instance)
{
    (void)instance;
    return 1;
}

static uint32_t needs(const void *instance)
{
    (void)instance;
    return MCR_NEEDS_PIXEL;
}

/* So that 4^levels * planned <= 2^32. */
static uint32_t levels_of(uint32_t planned)
{
    uint32_t levels = MOST_LEVELS;

    while (levels > 0 && ((uint64_t)planned << 2 * levels) > UINT64_C(1) << 32)
        levels--;
    return levels;
}

static void tile_keys(uint32_t n, uint64_t replicate_key, uint32_t planned, uint32_t levels, const uint32_t *restrict x, const uint32_t *restrict y,
                      uint64_t *restrict key)
{
    uint64_t all = mcr_mix64(replicate_key + planned * KEY_TILE);

    for (uint32_t i = 0; i < n; i++)
        key[i] = mcr_mix64(all + ((uint64_t)(y[i] >> levels) << 32 | (x[i] >> levels)) * KEY_TILE);
}

static void keys(uint32_t n, const uint64_t *restrict of, const uint32_t *restrict bounce, uint64_t stride, uint64_t dimension, uint64_t by,
                 uint64_t *restrict key)
{
    for (uint32_t i = 0; i < n; i++)
        key[i] = mcr_mix64(of[i] + (dimension + 1 + stride * bounce[i]) * by);
}

/*
 * One of the 24 permutations of 0 .. 3: A d + s over the field of two elements, s any of 4 and A any of the 6 matrices whose columns are neither 0 nor
 * alike.
 */
MCR_INLINE uint32_t permute_four(uint32_t digit, uint32_t which)
{
    uint32_t shift = which & 3, first = 1 + (which >> 3), second = first + 1 + (which >> 2 & 1);

    second -= second > 3 ? 3 : 0;
    return shift ^ (first & (0 - (digit & 1))) ^ (second & (0 - (digit >> 1)));
}

static void next_quarter(uint32_t n, uint32_t level, const uint32_t *restrict x, const uint32_t *restrict y, const uint64_t *restrict key,
                         uint32_t *restrict node, uint32_t *restrict rank)
{
    for (uint32_t i = 0; i < n; i++) {
        uint32_t quarter = (y[i] >> level & 1) << 1 | (x[i] >> level & 1);

        rank[i] = rank[i] << 2 | permute_four(quarter, (uint32_t)((uint64_t)mcr_node_hash(node[i], key[i]) * 24 >> 32));
        node[i] = node[i] << 2 | quarter;
    }
}

/* The pixel's number in its tile in the scrambled Z-order, from the largest blocks to the smallest. A node is a 1, then the quarters so far. */
static void ranks(uint32_t n, uint32_t levels, const uint32_t *x, const uint32_t *y, const uint64_t *key, uint32_t *rank)
{
    uint32_t node[BLOCK];

    for (uint32_t i = 0; i < n; i++) {
        node[i] = 1;
        rank[i] = 0;
    }
    for (uint32_t level = levels; level-- > 0;)
        next_quarter(n, level, x, y, key, node, rank);
}

static void permute_all(uint32_t n, uint32_t mask, const uint64_t *restrict key, const uint32_t *restrict index, uint32_t *restrict out)
{
    for (uint32_t i = 0; i < n; i++)
        out[i] = mcr_permute(index[i], mask, key[i]);
}

/*
 * The samples' numbers permuted, of each pixel 0 .. planned-1. Cycle walking (J. Black, P. Rogaway, "Ciphers with arbitrary finite domains", CT-RSA
 * 2002): those that fall outside go through the permutation of the next power of two again until they come back.
 */
static void permute(uint32_t n, uint32_t planned, const uint64_t *key, const uint32_t *index, uint32_t *order)
{
    const uint32_t mask = mcr_smear(planned - 1);

    permute_all(n, mask, key, index, order);
    for (uint32_t i = 0; i < n && planned <= mask; i++)
        while (order[i] >= planned)
            order[i] = mcr_permute(order[i], mask, key[i]);
}

/* order becomes the number in the tile's sequence. */
static void place(uint32_t n, uint32_t planned, const uint32_t *restrict rank, uint32_t *restrict order)
{
    for (uint32_t i = 0; i < n; i++)
        order[i] += rank[i] * planned;
}

static void second_dimension(uint32_t n, const uint32_t *restrict point, uint32_t *restrict r)
{
    for (uint32_t i = 0; i < n; i++)
        r[i] = mcr_net_second(point[i]);
}

/* Dimensions 3 and 4: the product with the matrix, four of its columns at a time. */
static void later_dimension(uint32_t n, uint32_t bits, const uint32_t *restrict column, const uint32_t *restrict point, uint32_t *restrict r)
{
    for (uint32_t i = 0; i < n; i++)
        r[i] = 0;
    for (uint32_t j = 0; j < bits; j += 4) {
        const uint32_t four[4] = {column[j], column[j + 1], column[j + 2], column[j + 3]};

        for (uint32_t i = 0; i < n; i++)
            r[i] = mcr_net_four(r[i], point[i] >> j, four);
    }
}

static void values(uint32_t n, const uint32_t *restrict r, const uint64_t *restrict key, double *restrict number)
{
    for (uint32_t i = 0; i < n; i++)
        number[i] = mcr_net_number(r[i], key[i]);
}

/* The lanes from .. from + n - 1, for all of which the same number of samples is planned. */
static void fill_block(const struct bluenoise *bluenoise, const struct mcr_samples *samples, uint32_t from, uint32_t n, uint32_t first, uint32_t count,
                       double *const *number)
{
    const uint32_t *bounce = (first < 8 ? samples->index : samples->bounce) + from, *x = samples->x + from, *y = samples->y + from;
    const uint32_t stride = first < 8 ? 0 : 32, size = first < 8 ? 2 : 4, planned = samples->planned[from], levels = levels_of(planned);
    uint32_t rank[BLOCK], point[BLOCK], r[BLOCK], bits = 0;
    uint64_t tile[BLOCK], key[BLOCK];

    tile_keys(n, samples->replicate_key, planned, levels, x, y, tile);
    while (bits < MCR_NET_BITS && (((uint64_t)planned << 2 * levels) - 1) >> bits)
        bits++;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t dimension = first + k, at = dimension % size;

        if (k == 0 || at == 0) {
            keys(n, tile, bounce, stride, dimension - at, KEY_RANK, key);
            ranks(n, levels, x, y, key, rank);
            keys(n, samples->pixel_key + from, bounce, stride, dimension - at, KEY_ORDER, key);
            permute(n, planned, key, samples->index + from, point);
            place(n, planned, rank, point);
        }
        if (at == 1)
            second_dimension(n, point, r);
        else if (at >= 2)
            later_dimension(n, bits, bluenoise->column[at - 2], point, r);
        keys(n, tile, bounce, stride, dimension, KEY_VALUE, key);
        values(n, at ? r : point, key, number[k] + from);
    }
}

/* Lanes of one number of samples planned mostly stand together. */
static int32_t fill(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_samples *samples,
                    uint32_t first, uint32_t count, double *const *number)
{
    uint32_t n;

    (void)host, (void)context;
    if (!samples->x || !samples->y)
        return MCR_E_INTERNAL;
    for (uint32_t from = 0; from < samples->n; from += n) {
        uint32_t most = samples->n - from < BLOCK ? samples->n - from : BLOCK;

        for (n = 1; n < most && samples->planned[from + n] == samples->planned[from];)
            n++;
        fill_block(instance, samples, from, n, first, count, number);
    }
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_numbers_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_numbers_plugin),
             .kind = MCR_KIND_NUMBERS,
             .isa = MCR_ISA,
             .name = "bluenoise",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "Sobol points shared by neighbouring pixels, whose errors cancel: for pictures of few samples per pixel"},
    .create = create,
    .destroy = destroy,
    .supplies = supplies,
    .correlated = correlated,
    .fill = fill,
    .needs = needs,
};

MCR_PLUGIN(struct mcr_numbers_plugin, descriptor);
