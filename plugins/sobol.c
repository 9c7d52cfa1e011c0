/* SPDX-License-Identifier: Apache-2.0 */
/*
 * sobol: Sobol's sequence, Owen-scrambled, of its own in every small group of dimensions.
 *
 * Groups.  The pixel and the lens are groups of 2 dimensions; in bounces every 4 dimensions are one (sampler 4 of them, light, material,
 *   roulette). A group is the sequence in its first 2 or 4 dimensions (mcrender/nets.h).
 * Order.  Groups are joined at random ("padded"): each takes the samples in an order of its own, so that no two groups share anything, however
 *   long the path. Samples change places within blocks that are nets, so that every first 2^m samples are one, and so is each part of a number of
 *   samples that is no power of two. Within blocks the order is nearly random: a nested scramble of the samples' numbers, as in Burley (nets.h),
 *   would keep all blocks of 2^m nets, but also double the variance of what two groups do together (coarse parts meet coarse parts: gain 2
 *   instead of 1), which decides where the groups alone are integrated well.
 * Values.  A. Owen's nested uniform scramble of 32 bits, by a hash. That makes every number uniform and the mean unbiased, keeps the boxes, and lets
 *   the variance of a smooth function fall as N^-3 instead of N^-2 ("Scrambled net variance for integrals of smooth functions", Ann. Stat. 25(4),
 *   1997).
 * Keys.  Hashes of the pixel's key and the dimension, so that pixels, replicates, bounces and dimensions are independent.
 */
#include <mcrender/nets.h>
#include <stdlib.h>

#define BLOCK 256u /* lanes that go through the loops together: their arrays are on the stack */

/* Odd: the fractional bits of sqrt 7 for the orders of groups, of sqrt 11 for values. */
#define KEY_ORDER UINT64_C(0xa54ff53a5f1d36f1)
#define KEY_VALUE UINT64_C(0x510e527fade682d1)

struct sobol {
    uint32_t column[2][MCR_NET_BITS]; /* dimensions 3 and 4 */
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    struct sobol *sobol = malloc(sizeof *sobol);

    (void)host, (void)context, (void)with;
    if (!sobol)
        return MCR_E_NOMEM;
    mcr_net_columns(sobol->column);
    *instance = sobol;
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

static void keys(uint32_t n, const uint64_t *restrict pixel_key, const uint32_t *restrict bounce, uint64_t stride, uint64_t dimension, uint64_t by,
                 uint64_t *restrict key)
{
    for (uint32_t i = 0; i < n; i++)
        key[i] = mcr_mix64(pixel_key[i] + (dimension + 1 + stride * bounce[i]) * by);
}

/* The samples' numbers in the group's order. Returns how many bits they have at most. */
static uint32_t shuffle(uint32_t n, const uint32_t *restrict index, const uint32_t *restrict planned, const uint64_t *restrict key,
                        uint32_t *restrict order)
{
    uint32_t most = 0, bits = 0;

    for (uint32_t i = 0; i < n; i++) {
        uint32_t x = index[i], mask = mcr_block_mask(x, planned[i]);

        order[i] = (x & ~mask) | mcr_permute(x & mask, mask, key[i]);
        most |= x | mask;
    }
    for (; most; most >>= 1)
        bits++;
    return bits;
}

static void second_dimension(uint32_t n, const uint32_t *restrict order, uint32_t *restrict r)
{
    for (uint32_t i = 0; i < n; i++)
        r[i] = mcr_net_second(order[i]);
}

/* Dimensions 3 and 4: the product with the matrix, four of its columns at a time. */
static void later_dimension(uint32_t n, uint32_t bits, const uint32_t *restrict column, const uint32_t *restrict order, uint32_t *restrict r)
{
    for (uint32_t i = 0; i < n; i++)
        r[i] = 0;
    for (uint32_t j = 0; j < bits; j += 4) {
        const uint32_t four[4] = {column[j], column[j + 1], column[j + 2], column[j + 3]};

        for (uint32_t i = 0; i < n; i++)
            r[i] = mcr_net_four(r[i], order[i] >> j, four);
    }
}

static void values(uint32_t n, const uint32_t *restrict r, const uint64_t *restrict key, double *restrict number)
{
    for (uint32_t i = 0; i < n; i++)
        number[i] = mcr_net_number(r[i], key[i]);
}

/* Where `first` is no bounce's dimension there are no bounces: any array does, times 0. */
static int32_t fill(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_samples *samples,
                    uint32_t first, uint32_t count, double *const *number)
{
    const struct sobol *sobol = instance;
    const uint32_t *bounce = first < 8 ? samples->index : samples->bounce, stride = first < 8 ? 0 : 32, size = first < 8 ? 2 : 4;
    uint32_t order[BLOCK], r[BLOCK], bits = 0;
    uint64_t key[BLOCK];

    (void)host, (void)context;
    for (uint32_t from = 0; from < samples->n; from += BLOCK) {
        uint32_t n = samples->n - from < BLOCK ? samples->n - from : BLOCK;

        for (uint32_t k = 0; k < count; k++) {
            uint32_t dimension = first + k, place = dimension % size;

            if (k == 0 || place == 0) {
                keys(n, samples->pixel_key + from, bounce + from, stride, dimension - place, KEY_ORDER, key);
                bits = shuffle(n, samples->index + from, samples->planned + from, key, order);
            }
            if (place == 1)
                second_dimension(n, order, r);
            else if (place >= 2)
                later_dimension(n, bits, sobol->column[place - 2], order, r);
            keys(n, samples->pixel_key + from, bounce + from, stride, dimension, KEY_VALUE, key);
            values(n, place ? r : order, key, number[k] + from);
        }
    }
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_numbers_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_numbers_plugin),
             .kind = MCR_KIND_NUMBERS,
             .isa = MCR_ISA,
             .name = "sobol",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "Owen-scrambled Sobol points in every 2 or 4 dimensions of the path; best with powers of two as samples per pixel"},
    .create = create,
    .destroy = destroy,
    .supplies = supplies,
    .correlated = correlated,
    .fill = fill,
};

MCR_PLUGIN(struct mcr_numbers_plugin, descriptor);
