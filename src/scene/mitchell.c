/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/mitchell.h"

/* The integral of f over [0, x]. */
static double integral(double b, double c, double x)
{
    double inner = x < 1 ? x : 1, rest = x < 1 ? 1 : 2 - x;
    double sum = ((12 - 9 * b - 6 * c) / 4 * inner - (18 - 12 * b - 6 * c) / 3) * (inner * inner * inner) + (6 - 2 * b) * inner;
    /* the outer piece by the distance from 2: all of it, less what lies beyond x */
    double whole = (b + 6 * c) / 4 - 2 * c, left = ((b + 6 * c) / 4 * rest - 2 * c) * (rest * rest * rest);
    return (sum + (whole - left)) / 6;
}

/* The integral of |f| over [0, x]; f turns negative at `root`. */
static double absolute(double b, double c, double root, double x)
{
    return x <= root ? integral(b, c, x) : 2 * integral(b, c, root) - integral(b, c, x);
}

void mcr_mitchell_edges(double b, double c, double edge[MCR_MITCHELL_CELLS + 1])
{
    const double end = b + c > 0 ? 2 : 1, root = b + c > 0 ? (2 * b + 6 * c) / (b + 6 * c) : 1, whole = absolute(b, c, root, end);
    edge[0] = 0;
    edge[MCR_MITCHELL_CELLS] = end;
    for (unsigned k = 1; k < MCR_MITCHELL_CELLS; k++) {
        double low = edge[k - 1], high = end;
        for (int step = 0; step < 60; step++) {
            double middle = low + (high - low) / 2;
            if (absolute(b, c, root, middle) * MCR_MITCHELL_CELLS < whole * k)
                low = middle;
            else
                high = middle;
        }
        edge[k] = high;
    }
}
