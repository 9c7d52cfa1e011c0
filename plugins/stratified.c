/* SPDX-License-Identifier: Apache-2.0 */
/*
 * stratified: the samples of a pixel are spread over cells of equal area, one in each, at a random place within the cell.
 *
 * Cells.  With n and m, a grid of n x m; samples come in sets of n * m, and the last set, if not full, takes a random subset. With
 *   neither, there are as many cells as samples are planned, N: the most nearly square grid n x m = N where it has m <= 2n (1000 =
 *   25 x 40); else, as for primes, floor(sqrt N) rows whose counts differ by at most one and whose heights are in proportion to
 *   their counts. All cells have area 1/N, so that samples keep equal weights and the variance is never above that of
 *   independent numbers.
 *   compat=floor-sqrt makes a mistake of the founding study: floor(sqrt N) squared cells for N samples. The core leaves the other samples
 *   black, and the picture is too dark by their share.
 * Order.  Which cell a sample takes is a permutation that is computed from the pixel's key, without tables: a Feistel network on
 *   pairs (left, right) of Z_a x Z_b with a * b >= cells (J. Black, P. Rogaway, "Ciphers with arbitrary finite domains", CT-RSA 2002:
 *   the generalised Feistel, and cycle walking where a * b > cells). Each pixel and each set has a permutation of its own.
 * Place.  The numbers that `independent` would have given.
 */
#include <math.h>
#include <mcrender/sampler.h>
#include <stdlib.h>

#define MOST_CELLS (1u << 30) /* more samples than that come in sets of so many */
#define BLOCK 256u            /* lanes that go through the loops together: their arrays are on the stack */
#define ROUNDS 10u            /* of the network, even. 8 leave pairs of samples in 4 x 4 cells uneven, 10 do not: tests/plugins/stratified.c */

static const struct mcr_parameter parameters[] = {
    {.size = sizeof(struct mcr_parameter),
     .type = MCR_TYPE_INTEGER,
     .name = "n",
     .unit = "",
     .summary = "Cells across a pixel; 0: follows from m and the samples planned, or with m also 0 as many cells as samples.",
     .fallback = {0},
     .min = 0,
     .max = 65536},
    {.size = sizeof(struct mcr_parameter),
     .type = MCR_TYPE_INTEGER,
     .name = "m",
     .unit = "",
     .summary = "Cells down a pixel; 0: samples planned / n, rounded up.",
     .fallback = {0},
     .min = 0,
     .max = 65536},
    {.size = sizeof(struct mcr_parameter),
     .type = MCR_TYPE_CHOICE,
     .name = "compat",
     .unit = "",
     .choices = "none|floor-sqrt",
     .summary = "A mistake of the founding study to make, which darkens the picture; where it is not set, what the render's `compat` names."},
};

struct stratified {
    uint32_t n, m; /* 0: automatic */
    int floor_sqrt;
};

/* How a pixel is cut: long_rows rows of columns + 1 cells come first, then rows of `columns` cells. */
struct strata {
    uint32_t cells, columns, long_rows;
    uint32_t a, b; /* the network's domain */
};

static int32_t create(const struct mcr_host *host, struct mcr_context *context, const struct mcr_creation *with, void **instance)
{
    struct stratified *stratified;
    double n = with->values->number[0], m = with->values->number[3];

    if (n * m > MOST_CELLS) {
        host->report(host, context, MCR_REPORT_ERROR, "n * m is above 1073741824 (2^30), the largest number of cells");
        return MCR_E_INVALID;
    }
    if (n + m > 0 && with->values->number[6] > 0) {
        host->report(host, context, MCR_REPORT_ERROR, "compat=floor-sqrt chooses the cells itself: expected neither n nor m, or compat=none");
        return MCR_E_INVALID;
    }
    stratified = malloc(sizeof *stratified);
    if (!stratified)
        return MCR_E_NOMEM;
    stratified->n = (uint32_t)n;
    stratified->m = (uint32_t)m;
    stratified->floor_sqrt = with->values->number[6] > 0;
    *instance = stratified;
    return MCR_OK;
}

static void destroy(void *instance)
{
    free(instance);
}

/* The film only. */
static uint32_t supplies(const void *instance, uint32_t first, uint32_t count)
{
    (void)instance;
    return first == 0 && count >= 2 ? 2 : 0;
}

static uint32_t correlated(const void *instance)
{
    (void)instance;
    return 1;
}

/* The largest n with n * m = cells and n <= m <= 2n, or 0. */
static uint32_t nearly_square(uint32_t cells)
{
    uint32_t n = (uint32_t)sqrt(cells);

    while (n > 0 && 2 * (uint64_t)n * n >= cells && cells % n)
        n--;
    return n > 0 && 2 * (uint64_t)n * n >= cells ? n : 0;
}

static struct strata cut(const struct stratified *stratified, uint32_t planned)
{
    struct strata strata = {0};
    uint32_t n = stratified->n, m = stratified->m, root, most;

    if (stratified->floor_sqrt)
        n = m = (uint32_t)sqrt(planned < MOST_CELLS ? planned : MOST_CELLS);
    if (n || m) {
        most = MOST_CELLS / (n ? n : m);
        if (!n)
            n = planned / m + (planned % m > 0), n = n < most ? n : most;
        else if (!m)
            m = planned / n + (planned % n > 0), m = m < most ? m : most;
        strata.cells = n * m;
        strata.columns = n;
    } else {
        strata.cells = planned < MOST_CELLS ? planned : MOST_CELLS;
        n = nearly_square(strata.cells);
        root = (uint32_t)sqrt(strata.cells);
        strata.columns = n ? n : strata.cells / root;
        strata.long_rows = n ? 0 : strata.cells % root;
        m = n ? strata.cells / n : 0;
    }
    strata.a = n, strata.b = m;
    if (n < 4 || m < 4) { /* no network is any good on a side so short */
        root = (uint32_t)sqrt(strata.cells);
        strata.a = root > 4 ? root : 4;
        strata.b = (strata.cells + strata.a - 1) / strata.a;
        strata.b = strata.b > 4 ? strata.b : 4;
    }
    return strata;
}

/*
 * x + a pseudorandom amount that depends on `by` and the key, modulo `modulus`; x < modulus <= 2^16. The amount is the high half of
 * (the hash's upper 16 bits) * modulus, so that only those bits must be good: a multiplicative step before and one behind an xor of
 * shifted bits, with a constant of C. Wellons, "Prospecting for hash functions" (2018).
 */
MCR_INLINE uint32_t turn(uint32_t x, uint32_t modulus, uint32_t by, uint32_t key)
{
    uint32_t hash = by * 0x9e3779b9u + key;

    hash = (hash ^ (hash >> 15)) * 0x846ca68bu;
    x += (hash >> 16) * modulus >> 16;
    return x >= modulus ? x - modulus : x;
}

/* out = the network's image of in, in [0, a * b). */
static void network(uint32_t n, uint32_t a, uint32_t b, const uint64_t *restrict key, const uint32_t *restrict in, uint32_t *restrict out)
{
    double per_b = 1.0 / b;

    for (uint32_t i = 0; i < n; i++) {
        uint32_t round_key = (uint32_t)key[i], step = (uint32_t)(key[i] >> 32) | 1;
        uint32_t left = (uint32_t)(int32_t)(((int32_t)in[i] + 0.5) * per_b), right = in[i] - left * b;

        for (uint32_t k = 0; k < ROUNDS; k += 2) {
            right = turn(right, b, left, round_key + k * step);
            left = turn(left, a, right, round_key + (k + 1) * step);
        }
        out[i] = left * b + right;
    }
}

/* Permutes cell[i] < cells in place. Cycle walking: the lanes that fall outside are gathered and go through again until they come back. */
static void permute(uint32_t n, const struct strata *strata, const uint64_t *key, uint32_t *cell)
{
    uint32_t image[BLOCK], from[BLOCK], lane[BLOCK], outside = 0, count;
    uint64_t from_key[BLOCK];

    if (strata->cells == 1)
        return;
    network(n, strata->a, strata->b, key, cell, image);
    for (uint32_t i = 0; i < n; i++) {
        cell[i] = image[i];
        lane[outside] = i;
        outside += image[i] >= strata->cells;
    }
    while (outside) {
        for (uint32_t j = 0; j < outside; j++) {
            from[j] = cell[lane[j]];
            from_key[j] = key[lane[j]];
        }
        network(outside, strata->a, strata->b, from_key, from, image);
        count = outside;
        outside = 0;
        for (uint32_t j = 0; j < count; j++) {
            cell[lane[j]] = image[j];
            lane[outside] = lane[j];
            outside += image[j] >= strata->cells;
        }
    }
}

/*
 * A cell's column c of `count` is c / count <= x < (c + 1) / count, and its row, above which `before` cells lie, is
 * before / cells <= y < (before + count) / cells, all four rounded to doubles: a number that would round up to the upper bound takes the
 * double below it.
 */
static void place(uint32_t n, const struct strata *strata, const uint32_t *restrict cell, const uint64_t *restrict key, double *restrict x,
                  double *restrict y)
{
    const double below = 1 - 1.0 / 9007199254740992.0;
    double cells = strata->cells, columns = strata->columns, long_cells = strata->long_rows * (columns + 1);

    for (uint32_t i = 0; i < n; i++) {
        double c = (int32_t)cell[i], count = c < long_cells ? columns + 1 : columns, first = c < long_cells ? 0 : long_cells;
        double before = first + count * (int32_t)((c - first + 0.5) / count), column = c - before;
        double u = (column + mcr_number(key[i], 0)) / count, most_u = (column + 1) / count * below;
        double v = (before + count * mcr_number(key[i], 1)) / cells, most_v = (before + count) / cells * below;

        x[i] = u < most_u ? u : most_u;
        y[i] = v < most_v ? v : most_v;
    }
}

/* Lanes of one pixel key and number of samples planned need not stand together; those of one number of samples mostly do. */
static int32_t fill(const struct mcr_host *host, struct mcr_context *context, const void *instance, const struct mcr_samples *samples,
                    uint32_t first, uint32_t count, double *const *number)
{
    uint32_t cell[BLOCK], from, n;
    uint64_t key[BLOCK];
    struct strata strata = {0};

    (void)host, (void)context;
    if (first != 0 || count != 2)
        return MCR_E_INTERNAL;
    for (from = 0; from < samples->n; from += n) {
        uint32_t planned = samples->planned[from], most = samples->n - from < BLOCK ? samples->n - from : BLOCK;

        if (from == 0 || planned != samples->planned[from - 1])
            strata = cut(instance, planned);
        for (n = 0; n < most && samples->planned[from + n] == planned; n++) {
            uint32_t index = samples->index[from + n], set = index < strata.cells ? 0 : index / strata.cells;

            cell[n] = index - set * strata.cells;
            key[n] = mcr_mix64(samples->pixel_key[from + n] + ((uint64_t)set + 1) * UINT64_C(0xd1342543de82ef95));
        }
        permute(n, &strata, key, cell);
        place(n, &strata, cell, samples->path_key + from, number[0] + from, number[1] + from);
    }
    return MCR_OK;
}

MCR_HIDDEN const struct mcr_numbers_plugin MCR_ISA_NAME(descriptor) = {
    .head = {.size = sizeof(struct mcr_numbers_plugin),
             .kind = MCR_KIND_NUMBERS,
             .isa = MCR_ISA,
             .parameter_count = 3,
             .name = "stratified",
             .version = "0.9",
             .licence = "Apache-2.0",
             .summary = "samples of a pixel spread over cells of equal area, one in each",
             .parameters = parameters},
    .create = create,
    .destroy = destroy,
    .supplies = supplies,
    .correlated = correlated,
    .fill = fill,
};

MCR_PLUGIN(struct mcr_numbers_plugin, descriptor);
