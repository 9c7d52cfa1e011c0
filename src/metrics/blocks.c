/* SPDX-License-Identifier: Apache-2.0 */
#include "metrics/blocks.h"

#include "base/elementary.h"
#include "base/memory.h"
#include "metrics/sum.h"

void mcr_series_row(const struct mcr_series *series, uint32_t y)
{
    mcr_pair_row(series->pair, 0, series->index, y, series->row[0]);
    mcr_pair_row(series->pair, 1, series->index, y, series->row[1]);
    for (int which = 0; which < 2; which++)
        mcr_pair_channel_row(series->pair, which, (uint32_t)series->variance[which], y, series->variance_row[which]);
}

int mcr_series_take(const struct mcr_series *series, uint32_t x, uint32_t y, struct mcr_noisy *sample)
{
    double a = series->row[0][x], r = series->row[1][x], unit = 0x1p-24 * mcr_max(fabs(a), fabs(r));
    *sample = (struct mcr_noisy){a - r, series->variance_row[0][x], series->variance_row[1][x], 2 * unit * unit};
    return mcr_pair_has(series->pair, x, y) && sample->va >= 0 && sample->vr >= 0 && sample->va + sample->vr < MCR_INFINITY;
}

static void fill(struct mcr_blocks *blocks, const struct mcr_series *series)
{
    struct mcr_noisy s;
    for (uint32_t y = 0; y < series->pair->height; y++) {
        struct mcr_block *row = blocks->block + (size_t)(y / blocks->side) * blocks->columns;
        mcr_series_row(series, y);
        for (uint32_t x = 0; x < series->pair->width; x++) {
            struct mcr_block *block = &row[x / blocks->side];
            if (!mcr_series_take(series, x, y, &s))
                continue;
            double v = mcr_noisy_variance(&s);
            block->count++;
            block->e += s.e;
            block->e2 += s.e * s.e;
            block->va += s.va;
            block->vr += s.vr;
            block->rounding += s.rounding;
            block->v2 += v * v;
        }
    }
}

int mcr_blocks_create(struct mcr_blocks *blocks, const struct mcr_series *series, uint32_t side)
{
    blocks->side = side;
    blocks->columns = (series->pair->width + side - 1) / side;
    blocks->rows = (series->pair->height + side - 1) / side;
    blocks->count = (size_t)blocks->columns * blocks->rows;
    blocks->block = mcr_array_alloc(blocks->count, sizeof *blocks->block);
    if (!blocks->block)
        return -1;
    fill(blocks, series);
    return 0;
}

const struct mcr_block *mcr_blocks_at(const struct mcr_blocks *blocks, uint32_t x, uint32_t y)
{
    return &blocks->block[(size_t)(y / blocks->side) * blocks->columns + x / blocks->side];
}

struct mcr_block mcr_blocks_total(const struct mcr_blocks *blocks)
{
    struct mcr_sum sum[6] = {{0, 0}};
    uint64_t count = 0;
    for (size_t i = 0; i < blocks->count; i++) {
        const struct mcr_block *b = &blocks->block[i];
        const double term[6] = {b->e, b->e2, b->va, b->vr, b->rounding, b->v2};
        count += b->count;
        for (int k = 0; k < 6; k++)
            mcr_sum_add(&sum[k], term[k]);
    }
    return (struct mcr_block){count, mcr_sum_value(sum[0]), mcr_sum_value(sum[1]), mcr_sum_value(sum[2]), mcr_sum_value(sum[3]), mcr_sum_value(sum[4]),
                              mcr_sum_value(sum[5])};
}

struct mcr_block mcr_blocks_around(const struct mcr_blocks *blocks, uint32_t column, uint32_t row)
{
    struct mcr_block all = {0};
    for (uint32_t y = row ? row - 1 : 0; y <= row + 1 && y < blocks->rows; y++)
        for (uint32_t x = column ? column - 1 : 0; x <= column + 1 && x < blocks->columns; x++) {
            const struct mcr_block *b = &blocks->block[(size_t)y * blocks->columns + x];
            all.count += b->count;
            all.e += b->e;
            all.e2 += b->e2;
            all.va += b->va;
            all.vr += b->vr;
            all.rounding += b->rounding;
            all.v2 += b->v2;
        }
    return all;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, ascending);
    return count ? values[count / 2] : MCR_NAN;
}

int mcr_blocks_typical(const struct mcr_blocks *blocks, struct mcr_blocks_medians *typical)
{
    double *ratio = mcr_array_alloc(blocks->count, sizeof *ratio), *squares = mcr_array_alloc(blocks->count, sizeof *squares);
    size_t count = 0;
    int status = ratio && squares ? 0 : -1;
    for (size_t i = 0; !status && i < blocks->count; i++) {
        const struct mcr_block *block = &blocks->block[i];
        if (!(block->va > 0) || !(block->vr > 0))
            continue;
        ratio[count] = block->va / block->vr;
        squares[count++] = block->e2 / mcr_block_noise(block);
    }
    if (!status)
        *typical = (struct mcr_blocks_medians){count, median(ratio, count), median(squares, count)};
    free(ratio);
    free(squares);
    return status;
}
