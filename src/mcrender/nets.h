/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mcrender plugin interface: digital nets in base 2 for number sources, one lane at a time. All functions are pure and have no branches that depend on
 * a lane, so that loops over them vectorise.
 *
 * A group of up to 4 dimensions is Sobol's sequence: I. Sobol', "On the distribution of points in a cube and the approximate evaluation of integrals",
 * USSR Comput. Math. Math. Phys. 7(4), 1967. Dimensions 1 and 2 are a (0,2)-sequence: every 2^m points that begin at a multiple of 2^m have one in
 * each of the 2^m boxes of any shape 2^-k x 2^-(m-k). Primitive polynomials and initial numbers of dimensions 3 and 4 are the first of S. Joe and
 * F. Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30(5), 2008; the rest is generated.
 *
 * Reversed: words named r hold their number's first binary place in bit 0.
 */
#ifndef MCRENDER_NETS_H
#define MCRENDER_NETS_H

#include <mcrender/sampler.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MCR_NET_BITS 32u /* of a point's number, and scrambled ones of a coordinate */

MCR_INLINE uint32_t mcr_reverse(uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/*
 * A. Owen's nested uniform scramble ("Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995) of a reversed word: whether a bit is turned depends
 * on the bits before it and the key. As a hash, after B. Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020, and S. Laine and T. Karras,
 * "Stratified sampling for stochastic transparency", 2011: a bijection in which a bit depends on itself and the bits below it alone, since sums and
 * products carry upward only and factors behind ^ are even. Each key's bit goes in twice, at places far apart. Measured over 2e6 keys: which two of
 * the 2^k bits at place k <= 6 are turned is as good as independent (no bias above .2 %), and so are any four neighbours.
 */
MCR_INLINE uint32_t mcr_scramble(uint32_t r, uint64_t key)
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

/* A reversed word scrambled, as a number in [0, 1); behind its 32 bits come 21 more, a hash of those and of the key. */
MCR_INLINE double mcr_net_number(uint32_t r, uint64_t key)
{
    uint32_t value = mcr_reverse(mcr_scramble(r, key)), behind = (value ^ (uint32_t)(key >> 32)) * 0x9e3779b9u + (uint32_t)key;

    behind = (behind ^ (behind >> 15)) * 0x846ca68bu;
    return mcr_unit_double((uint64_t)value << 32 | (behind ^ (behind >> 16)));
}

/* 32 hashed bits for a node of a tree and a key of hashed bits. Steps with constants of C. Wellons, "Prospecting for hash functions" (2018). */
MCR_INLINE uint32_t mcr_node_hash(uint32_t node, uint64_t key)
{
    uint32_t h = node * 0x9e3779b9u + (uint32_t)key;

    h = (h ^ (h >> 16)) * 0x21f0aaadu;
    h = (h ^ (h >> 15)) + (uint32_t)(key >> 32);
    h = (h ^ (h >> 16)) * 0x735a2d97u;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
}

/* ---- Points: dimension 1 of point x is r = x -------------------------------------------------------------------- */

/* Dimension 2, polynomial x + 1: Pascal's triangle modulo 2. Row i, column j has a 1 where the bits of i are among those of j. */
MCR_INLINE uint32_t mcr_net_second(uint32_t x)
{
    x ^= (x >> 1) & 0x55555555u;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 8) & 0x00ff00ffu;
    return x ^ (x >> 16);
}

/*
 * Dimensions 3 and 4: column[d][j] is what bit j of x adds (modulo 2) to r. From the direction numbers m_j of a primitive polynomial
 * x^s + a_1 x^(s-1) + ... + 1 over the field of two elements, by the recurrence m_j = 2 a_1 m_(j-1) + 4 a_2 m_(j-2) + ... + 2^s m_(j-s) + m_(j-s),
 * sums without carry (P. Bratley, B. Fox, "Algorithm 659", ACM TOMS 14(1), 1988). m_j has j binary places behind the point. Here the polynomials are
 * x^2 + x + 1 and x^3 + x + 1, in `a` with a_1 in bit s-1, ..., a_s = 1 in bit 0.
 */
MCR_INLINE void mcr_net_columns(uint32_t column[2][MCR_NET_BITS])
{
    static const uint32_t degree[2] = {2, 3}, a[2] = {3, 3}, initial[2][3] = {{1, 3, 0}, {1, 3, 1}};
    uint32_t m[MCR_NET_BITS];

    for (uint32_t d = 0; d < 2; d++)
        for (uint32_t j = 0, s = degree[d]; j < MCR_NET_BITS; j++) {
            m[j] = j < s ? initial[d][j] : m[j - s];
            for (uint32_t k = 1; k <= s && j >= s; k++)
                m[j] ^= (a[d] >> (s - k) & 1) * (m[j - k] << k);
            column[d][j] = mcr_reverse(m[j] << (MCR_NET_BITS - 1 - j));
        }
}

/* r plus the products with the four columns from `column` on, for bits 0 to 3 of x. */
MCR_INLINE uint32_t mcr_net_four(uint32_t r, uint32_t x, const uint32_t *column)
{
    return r ^ (column[0] & (0 - (x & 1))) ^ (column[1] & (0 - (x >> 1 & 1))) ^ (column[2] & (0 - (x >> 2 & 1))) ^ (column[3] & (0 - (x >> 3 & 1)));
}

/* ---- Orders: the samples of a pixel change places -------------------------------------------------------------- */

/* All bits below the highest one that is set, and it. */
MCR_INLINE uint32_t mcr_smear(uint32_t x)
{
    x |= x >> 1;
    x |= x >> 2;
    x |= x >> 4;
    x |= x >> 8;
    return x | x >> 16;
}

/* The k low bits of x, reversed, for mask = 2^k - 1. The product is a shift that processors without shifts by lane do, too. */
MCR_INLINE uint32_t mcr_reverse_low(uint32_t x, uint32_t mask)
{
    return (uint32_t)(mcr_reverse(x) * ((uint64_t)mask + 1) >> 32);
}

/*
 * A permutation of 0 .. mask = 2^k - 1: a scramble, which carries upward, and another one of the reversed bits, which carries downward. With one of
 * them alone, or without the last reversal, the lowest or the highest bit is turned by a function of the others alone, which doubles the variance of
 * what two groups do together; with both, the gain is that of random permutations as near as can be measured, though not all permutations are as likely.
 */
MCR_INLINE uint32_t mcr_permute(uint32_t x, uint32_t mask, uint64_t key)
{
    uint32_t a = (uint32_t)key, b = (uint32_t)(key >> 32);

    x = mcr_reverse_low(mcr_scramble(x, key) & mask, mask);
    return mcr_reverse_low(mcr_scramble(x, (uint64_t)(a * 0x9e3779b9u) << 32 | (b ^ 0x2545f491u)) & mask, mask);
}

/*
 * Of the block of samples that sample x of `planned` is in, the size less 1. With `whole` the largest power of two that is not above `planned`, blocks
 * are [0, 1), [1, 2), [2, 4) ... [whole/2, whole), then one for each further bit that is set in `planned`: each is a run of a power of two samples
 * that begins at a multiple of it, and each first 2^m samples are some of them.
 */
MCR_INLINE uint32_t mcr_block_mask(uint32_t x, uint32_t planned)
{
    uint32_t below = mcr_smear(x), behind = mcr_smear(x ^ planned), all = mcr_smear(planned);

    return (below < all ? below : behind) >> 1;
}

#ifdef __cplusplus
}
#endif

#endif
