/* SPDX-License-Identifier: Apache-2.0 */
#include "core/cell.h"

#include <string.h>

/* Adds by pairs: ((0+1)+(2+3))+…, absent samples being 0. */
static double pairwise(const double v[MCR_CELL_SAMPLES])
{
    double s[MCR_CELL_SAMPLES];
    memcpy(s, v, sizeof s);
    for (uint32_t half = MCR_CELL_SAMPLES / 2; half; half /= 2)
        for (uint32_t i = 0; i < half; i++)
            s[i] = s[2 * i] + s[2 * i + 1];
    return s[0];
}

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
