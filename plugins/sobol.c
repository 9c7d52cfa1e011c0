/* SPDX-License-Identifier: Apache-2.0 */
/*
 * sobol: Sobol's sequence, Owen-scrambled, of its own in every small group of dimensions.
 *
 * Groups.  The pixel and the lens are groups of 2 dimensions; in bounces every 4 dimensions are one (sampler 4 of them, light, material,
 *   roulette). A group is the sequence in its first 2 or 4 dimensions: I. Sobol', "On the distribution of points in a cube and the approximate
 *   evaluation of integrals", USSR Comput. Math. Math. Phys. 7(4), 1967. Dimensions 1 and 2 are a (0,2)-sequence: every 2^m samples that begin
 *   at a multiple of 2^m have one in each of the 2^m boxes of any shape 2^-k x 2^-(m-k). Primitive polynomials and initial numbers of dimensions
 *   3 and 4 are the first of S. Joe and F. Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput.
 *   30(5), 2008; the rest is generated.
 * Order.  Groups are joined at random ("padded"): each takes the samples in an order of its own, so that no two groups share anything, however
 *   long the path. Samples change places within blocks that are nets, so that every first 2^m samples are one, and so is each part of a number of
 *   samples that is no power of two. Within blocks the order is nearly random: a nested scramble of the samples' numbers, as in Burley (below),
 *   would keep all blocks of 2^m nets, but also double the variance of what two groups do together (coarse parts meet coarse parts: gain 2
 *   instead of 1), which decides where the groups alone are integrated well.
 * Values.  A. Owen's nested uniform scramble ("Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995) of 32 bits: whether a bit is turned depends
 *   on the bits above it and a key. That makes every number uniform and the mean unbiased, keeps the boxes, and lets the variance of a smooth
 *   function fall as N^-3 instead of N^-2 ("Scrambled net variance for integrals of smooth functions", Ann. Stat. 25(4), 1997).
 * The scramble is a hash, as in B. Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020, after S. Laine and T. Karras, "Stratified
 *   sampling for stochastic transparency", 2011: with the bits reversed, additions and multiplications carry only from bits above to bits below.
 * Keys.  Hashes of the pixel's key and the dimension, so that pixels, replicates, bounces and dimensions are independent.
 *
 * Reversed: below, words named r hold their number's first binary place in bit 0.
 */
#include <mcrender/sampler.h>
#include <stdlib.h>

#define BLOCK 256u /* lanes that go through the loops together: their arrays are on the stack */
#define BITS 32u   /* of a sample's number, and scrambled ones of a value */

/* Odd: the fractional bits of sqrt 7 for the orders of groups, of sqrt 11 for values. */
#define KEY_ORDER UINT64_C(0xa54ff53a5f1d36f1)
#define KEY_VALUE UINT64_C(0x510e527fade682d1)

/* Dimensions 3 and 4: column[d][j] is what bit j of a sample's number adds (modulo 2) to r. */
struct sobol {
    uint32_t column[2][BITS];
};

MCR_INLINE uint32_t reverse(uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/*
 * The nested scramble of a reversed word: a bijection in which a bit depends on itself and the bits below it alone, since sums and products carry
 * upward only and factors behind ^ are even. Each key's bit goes in twice, at places far apart. Measured over 2e6 keys: which two of the 2^k bits at
 * place k <= 6 are turned is as good as independent (no bias above .2 %), and so are any four neighbours.
 */
MCR_INLINE uint32_t scramble(uint32_t r, uint64_t key)
{
    uint32_t a = (uint32_t)key, b = (uint32_t)(key >> 32);

    r += a;
    r ^= r * (b << 1);
    r += b << 16 | b >> 16;
    r ^= r * ((a << 16 | a >> 16) << 1);
    r ^= r * 0x94d049bau;
    r += (a >> 8) ^ (b << 3);
    r *= b >> 9 | 1;
    return r;
}

/*
 * The direction numbers m_j of a primitive polynomial x^s + a_1 x^(s-1) + ... + 1 over the field of two elements, by the recurrence
 * m_j = 2 a_1 m_(j-1) + 4 a_2 m_(j-2) + ... + 2^s m_(j-s) + m_(j-s), sums without carry (P. Bratley, B. Fox, "Algorithm 659", ACM TOMS 14(1), 1988).
 * m_j has j binary places behind the point. `a` has a_1 in bit s-1, ..., a_s = 1 in bit 0.
 */
static void directions(uint32_t s, uint32_t a, const uint32_t *initial, uint32_t *column)
{
    uint32_t m[BITS];

    for (uint32_t j = 0; j < BITS; j++) {
        m[j] = j < s ? initial[j] : m[j - s];
        for (uint32_t k = 1; k <= s && j >= s; k++)
            m[j] ^= (a >> (s - k) & 1) * (m[j - k] << k);
        column[j] = reverse(m[j] << (BITS - 1 - j));
    }
}

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    static const uint32_t third[] = {1, 3}, fourth[] = {1, 3, 1};
    struct sobol *sobol = malloc(sizeof *sobol);

    (void)host, (void)context, (void)with;
    if (!sobol)
        return MCR_E_NOMEM;
    directions(2, 3, third, sobol->column[0]);  /* x^2 + x + 1 */
    directions(3, 3, fourth, sobol->column[1]); /* x^3 + x + 1 */
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

/* All bits below the highest one that is set, and it. */
MCR_INLINE uint32_t smear(uint32_t x)
{
    x |= x >> 1;
    x |= x >> 2;
    x |= x >> 4;
    x |= x >> 8;
    return x | x >> 16;
}

/* The k low bits of x, reversed, for mask = 2^k - 1. The product is a shift that processors without shifts by lane do, too. */
MCR_INLINE uint32_t reverse_low(uint32_t x, uint32_t mask)
{
    return (uint32_t)(reverse(x) * ((uint64_t)mask + 1) >> 32);
}

/*
 * A permutation of 0 .. mask = 2^k - 1: a scramble, which carries upward, and another one of the reversed bits, which carries downward. With one of
 * them alone, or without the last reversal, the lowest or the highest bit is turned by a function of the others alone, which is what doubles the
 * variance; with both, the gain is that of random permutations as near as can be measured, though not all permutations are as likely.
 */
MCR_INLINE uint32_t permute(uint32_t x, uint32_t mask, uint64_t key)
{
    uint32_t a = (uint32_t)key, b = (uint32_t)(key >> 32);

    x = reverse_low(scramble(x, key) & mask, mask);
    return reverse_low(scramble(x, (uint64_t)(a * 0x9e3779b9u) << 32 | (b ^ 0x2545f491u)) & mask, mask);
}

/*
 * The samples' numbers in the group's order. Returns how many bits they have at most. With `whole` the largest power of two that is not above the
 * samples planned, blocks are [0, 1), [1, 2), [2, 4) ... [whole/2, whole), then one for each further bit that is set in `planned`.
 */
static uint32_t shuffle(uint32_t n, const uint32_t *restrict index, const uint32_t *restrict planned, const uint64_t *restrict key,
                        uint32_t *restrict order)
{
    uint32_t most = 0, bits = 0;

    for (uint32_t i = 0; i < n; i++) {
        uint32_t x = index[i], below = smear(x), behind = smear(x ^ planned[i]), all = smear(planned[i]);
        uint32_t mask = (below < all ? below : behind) >> 1;

        order[i] = (x & ~mask) | permute(x & mask, mask, key[i]);
        most |= x | mask;
    }
    for (; most; most >>= 1)
        bits++;
    return bits;
}

/* Dimension 2, polynomial x + 1: Pascal's triangle modulo 2. Row i, column j has a 1 where the bits of i are among those of j. */
static void second_dimension(uint32_t n, const uint32_t *restrict order, uint32_t *restrict r)
{
    for (uint32_t i = 0; i < n; i++) {
        uint32_t x = order[i];

        x ^= (x >> 1) & 0x55555555u;
        x ^= (x >> 2) & 0x33333333u;
        x ^= (x >> 4) & 0x0f0f0f0fu;
        x ^= (x >> 8) & 0x00ff00ffu;
        r[i] = x ^ (x >> 16);
    }
}

/* Dimensions 3 and 4: the product with the matrix, four of its columns at a time. */
static void later_dimension(uint32_t n, uint32_t bits, const uint32_t *restrict column, const uint32_t *restrict order, uint32_t *restrict r)
{
    for (uint32_t i = 0; i < n; i++)
        r[i] = 0;
    for (uint32_t j = 0; j < bits; j += 4) {
        uint32_t c0 = column[j], c1 = column[j + 1], c2 = column[j + 2], c3 = column[j + 3];

        for (uint32_t i = 0; i < n; i++) {
            uint32_t x = order[i] >> j;

            r[i] ^= (c0 & (0 - (x & 1))) ^ (c1 & (0 - (x >> 1 & 1))) ^ (c2 & (0 - (x >> 2 & 1))) ^ (c3 & (0 - (x >> 3 & 1)));
        }
    }
}

/* Scrambled, and 21 bits behind, a hash of those before. */
static void values(uint32_t n, const uint32_t *restrict r, const uint64_t *restrict key, double *restrict number)
{
    for (uint32_t i = 0; i < n; i++) {
        uint32_t value = reverse(scramble(r[i], key[i])), behind = (value ^ (uint32_t)(key[i] >> 32)) * 0x9e3779b9u + (uint32_t)key[i];

        behind = (behind ^ (behind >> 15)) * 0x846ca68bu;
        number[i] = mcr_unit_double((uint64_t)value << 32 | (behind ^ (behind >> 16)));
    }
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
