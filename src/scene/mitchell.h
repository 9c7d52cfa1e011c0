/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The piecewise cubic filter of Mitchell and Netravali, "Reconstruction filters in computer graphics" (1988), equation 8, along one axis: support
 * |x| <= 2, integral 1. With b and c in [0, 1] it falls from the middle to x = 1, is not negative up to (2 b + 6 c) / (b + 6 c), and not positive from
 * there on.
 */
#ifndef MCR_SCENE_MITCHELL_H
#define MCR_SCENE_MITCHELL_H

/* Cells into which the absolute filter is cut on each side, all of about the same weight. */
#define MCR_MITCHELL_CELLS 1024u

/* f(x) for x in [0, 2]. The outer piece is factored: at x = 2 nothing cancels. */
static inline double mcr_mitchell(double b, double c, double x)
{
    double inner = ((12 - 9 * b - 6 * c) * x - (18 - 12 * b - 6 * c)) * (x * x) + (6 - 2 * b);
    double rest = 2 - x, outer = ((b + 6 * c) * rest - 6 * c) * (rest * rest);
    return (x < 1 ? inner : outer) * (1.0 / 6);
}

/*
 * The cells' edges from 0 to where the filter ends, for drawing places in proportion to |f|, nearly: uniformly within a cell that is drawn uniformly.
 * What is drawn so has a weight f / density, whose expectation is exact wherever the edges are.
 */
void mcr_mitchell_edges(double b, double c, double edge[MCR_MITCHELL_CELLS + 1]);

#endif
