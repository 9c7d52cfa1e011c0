/* SPDX-License-Identifier: Apache-2.0 */
/*
 * halton: Halton's points, scrambled, of their own in every small group of dimensions.
 *
 * Groups.  The pixel and the lens are groups of 2 dimensions, in bases 2 and 3; in bounces every 4 dimensions are one, in bases 2, 3, 5 and 7 (sampler
 *   4 of them, light, material, roulette). Coordinate b of point x is x with its digits in base b mirrored at the point: J. Halton, "On the efficiency
 *   of certain quasi-random sequences of points", Numer. Math. 2, 1960.
 *   A prime for every dimension of a path would have none above some depth, and long before, bases so large that N points fill none of their intervals
 *   twice: pairs of dimensions are then no better than independent, and without a good scramble much worse. Here every pair that belongs together
 *   has small bases, at any depth.
 * Order.  Groups are joined at random ("padded"): each takes the samples in an order of its own, so that no two groups share anything, however long
 *   the path: bases come back, points do not. Samples change places within the blocks of mcr_block_mask, so that every first 2^m samples are the first
 *   2^m points, and all N samples the first N for any N.
 * Values.  A. Owen's nested uniform scramble, base b ("Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995), in base 2 by mcr_scramble. Elsewhere
 *   digit d becomes a d + s modulo b, 0 < a < b and 0 <= s < b by a hash of the digits before it and a key: two different digits become any two
 *   different ones with equal probability, as by a uniform permutation, and the mean and the variance depend on nothing else. Behind the digits that
 *   tell N points apart come independent random numbers, which is what infinitely many scrambled zeros are.
 *   For no function and no N is the variance above 3/2 + log(d/2) times that of independent numbers, 2.6 for d = 6 dimensions (the bound holds from
 *   there on, and fewer have no more): A. Owen, Z. Pan, "Gain coefficients for scrambled Halton points", SIAM J. Numer. Anal. 62(3), 2024.
 * Keys.  Hashes of the pixel's key and the dimension, so that pixels, replicates, bounces and dimensions are independent.
 */
#include <mcrender/nets.h>

#define BLOCK 256u /* lanes that go through the loops together: their arrays are on the stack */

/* Odd: the fractional bits of sqrt 13 for the orders of groups, of sqrt 17 for values. */
#define KEY_ORDER UINT64_C(0x9b05688c2b3e6c1f)
#define KEY_VALUE UINT64_C(0x1f83d9abfb41bd6b)

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    (void)host, (void)context, (void)with;
    *instance = NULL;
    return MCR_OK;
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

/* The samples' numbers in the group's order. */
static void shuffle(uint32_t n, const uint32_t *restrict index, const uint32_t *restrict planned, const uint64_t *restrict key,
                    uint32_t *restrict order)
{
    for (uint32_t i = 0; i < n; i++) {
        uint32_t x = index[i], mask = mcr_block_mask(x, planned[i]);

        order[i] = (x & ~mask) | mcr_permute(x & mask, mask, key[i]);
    }
}

static void values_2(uint32_t n, const uint32_t *restrict order, const uint64_t *restrict key, double *restrict number)
{
    for (uint32_t i = 0; i < n; i++)
        number[i] = mcr_net_number(order[i], key[i]);
}

/* What a block of lanes has of its numbers. A node is a 1, then the digits so far, in base b. */
struct digits {
    uint32_t rest[BLOCK], left[BLOCK], node[BLOCK]; /* digits to come; of the last sample's number, in which those of all samples fit */
    double value[BLOCK], power[BLOCK];              /* the scrambled digits as a whole number, and b to their number */
};

static void begin(uint32_t n, const uint32_t *restrict order, const uint32_t *restrict planned, struct digits *restrict digits)
{
    for (uint32_t i = 0; i < n; i++) {
        digits->rest[i] = order[i];
        digits->left[i] = planned[i] - 1;
        digits->node[i] = 1;
        digits->value[i] = 0;
        digits->power[i] = 1;
    }
}

/*
 * One more digit, for those lanes that have any left. Returns 0 if none has. Written out for each base, as products take the place of quotients by
 * constants. a and s are the integer parts of hash * b / 2^32 and of the fraction that remains, * (b - 1): uneven by a few parts in 2^32.
 */
#define NEXT_DIGIT(BASE)                                                                                                                       \
    static uint32_t next_digit_##BASE(uint32_t n, const uint64_t *restrict key, struct digits *restrict digits)                                \
    {                                                                                                                                          \
        uint32_t any = 0;                                                                                                                      \
                                                                                                                                               \
        for (uint32_t i = 0; i < n; i++) {                                                                                                     \
            uint32_t on = digits->left[i] > 0, digit = digits->rest[i] % (BASE), node = digits->node[i];                                       \
            uint64_t hash = (uint64_t)mcr_node_hash(node, key[i]) * (BASE);                                                                    \
            uint32_t shift = (uint32_t)(hash >> 32), factor = 1 + (uint32_t)((hash & 0xffffffffu) * ((BASE) - 1) >> 32);                       \
            uint32_t scrambled = (factor * digit + shift) % (BASE);                                                                            \
                                                                                                                                               \
            any |= digits->left[i];                                                                                                            \
            digits->rest[i] /= (BASE);                                                                                                         \
            digits->left[i] /= (BASE);                                                                                                         \
            digits->node[i] = on ? node * (BASE) + digit : node;                                                                               \
            digits->value[i] = on ? digits->value[i] * (BASE) + (double)(int32_t)scrambled : digits->value[i];                                 \
            digits->power[i] = on ? digits->power[i] * (BASE) : digits->power[i];                                                              \
        }                                                                                                                                      \
        return any;                                                                                                                            \
    }
NEXT_DIGIT(3)
NEXT_DIGIT(5)
NEXT_DIGIT(7)

/* A number anywhere in its interval [value / power, (value + 1) / power); one that would round up to the end takes the double below it. */
static void end(uint32_t n, const struct digits *restrict digits, const uint64_t *restrict key, double *restrict number)
{
    const double below = 1 - 1.0 / 9007199254740992.0;

    for (uint32_t i = 0; i < n; i++) {
        double behind = mcr_unit_double(mcr_mix64(key[i] + (digits->node[i] + UINT64_C(1)) * UINT64_C(0x9e3779b97f4a7c15)));
        double u = (digits->value[i] + behind) / digits->power[i], most = (digits->value[i] + 1) / digits->power[i] * below;

        number[i] = u < most ? u : most;
    }
}

static void values(uint32_t n, uint32_t place, const uint32_t *order, const uint32_t *planned, const uint64_t *key, double *number)
{
    static uint32_t (*const next_digit[])(uint32_t, const uint64_t *restrict, struct digits *restrict) = {next_digit_3, next_digit_5, next_digit_7};
    struct digits digits;

    if (place == 0) {
        values_2(n, order, key, number);
        return;
    }
    begin(n, order, planned, &digits);
    while (next_digit[place - 1](n, key, &digits))
        ;
    end(n, &digits, key, number);
}

/* Where `first` is no bounce's dimension there are no bounces: any array does, times 0. */
static int32_t fill(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_samples *samples,
                    uint32_t first, uint32_t count, double *const *number)
{
    const uint32_t *bounce = first < 8 ? samples->index : samples->bounce, stride = first < 8 ? 0 : 32, size = first < 8 ? 2 : 4;
    uint32_t order[BLOCK];
    uint64_t key[BLOCK];

    (void)host, (void)context, (void)instance;
    for (uint32_t from = 0; from < samples->n; from += BLOCK) {
        uint32_t n = samples->n - from < BLOCK ? samples->n - from : BLOCK;

        for (uint32_t k = 0; k < count; k++) {
            uint32_t dimension = first + k, place = dimension % size;

            if (k == 0 || place == 0) {
                keys(n, samples->pixel_key + from, bounce + from, stride, dimension - place, KEY_ORDER, key);
                shuffle(n, samples->index + from, samples->planned + from, key, order);
            }
            keys(n, samples->pixel_key + from, bounce + from, stride, dimension, KEY_VALUE, key);
            values(n, place, order, samples->planned + from, key, number[k] + from);
        }
    }
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_numbers_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_numbers_plugin),
             .kind = MCR_KIND_NUMBERS,
             .isa = MCR_ISA,
             .name = "halton",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "scrambled Halton points in every 2 or 4 dimensions of the path; any number of samples per pixel is as good as another"},
    .create = create,
    .supplies = supplies,
    .correlated = correlated,
    .fill = fill,
};

MCR_PLUGIN(struct mcr_numbers_plugin, descriptor);
