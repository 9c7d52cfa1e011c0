/* SPDX-License-Identifier: Apache-2.0 */
#include "core/cell.h"

#include <string.h>

/* Adds by pairs, i and i + half at each level, absent samples being 0: a tree of fixed shape that is a few vector additions. */
static double pairwise(const double v[MCR_CELL_SAMPLES])
{
    double s[MCR_CELL_SAMPLES / 2];
    for (uint32_t i = 0; i < MCR_CELL_SAMPLES / 2; i++)
        s[i] = v[i] + v[i + MCR_CELL_SAMPLES / 2];
    for (uint32_t i = 0; i < MCR_CELL_SAMPLES / 4; i++)
        s[i] += s[i + MCR_CELL_SAMPLES / 4];
    for (uint32_t i = 0; i < MCR_CELL_SAMPLES / 8; i++)
        s[i] += s[i + MCR_CELL_SAMPLES / 8];
    return s[0] + s[1];
}

_Static_assert(MCR_CELL_SAMPLES == 16, "the tree has four levels");

void mcr_cell_sum(const double *r, const double *g, const double *b, uint32_t count, struct mcr_cell *cell)
{
    const double *from[3] = {r, g, b};
    double v[MCR_CELL_SAMPLES] = {0};
    for (int c = 0; c < 3; c++) {
        for (uint32_t i = 0; i < count; i++)
            v[i] = from[c][i];
        cell->sum[c] = pairwise(v);
    }
    double mean = mcr_luminance(cell->sum[0], cell->sum[1], cell->sum[2]) / count;
    for (uint32_t i = 0; i < count; i++) {
        double difference = mcr_luminance(r[i], g[i], b[i]) - mean;
        v[i] = difference * difference;
    }
    cell->moment = pairwise(v);
}

void mcr_cell_channel_moments(const double *r, const double *g, const double *b, uint32_t count, const struct mcr_cell *cell,
                              struct mcr_cell_channels *channels)
{
    const double *from[3] = {r, g, b};
    double v[MCR_CELL_SAMPLES] = {0};
    for (int c = 0; c < 3; c++) {
        double mean = cell->sum[c] / count;
        for (uint32_t i = 0; i < count; i++)
            v[i] = (from[c][i] - mean) * (from[c][i] - mean);
        channels->moment[c] = pairwise(v);
    }
}
