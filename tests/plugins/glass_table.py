# SPDX-License-Identifier: Apache-2.0
#
# Writes src/mcrender/glass_table.h: the light that is lost at one facet of a rough clear interface, by the cosine c, alpha and the relative index n.
#
#     python3 tests/plugins/glass_table.py | diff - src/mcrender/glass_table.h
#
# Needs Python 3 and numpy, five to six minutes of one processor and some 50 MB. Run by hand, by no test: the sums are of doubles, so that another numpy or
# processor may round a few numbers to the neighbour, 1e-6 of a coefficient away.
#
# The interface is of GGX's facets with Smith's height-correlated masking. With spread(c) = sqrt(c^2 + alpha^2 (1 - c^2)),
#
#     G1(o) = 2 c_o / (c_o + spread(c_o)),    G2(o, w) = 2 c_o c_w / (c_w spread(c_o) + c_o spread(c_w)),
#
# the latter for refraction as for reflection, and 0 where w is on the wrong side. A facet drawn from the normals that o sees sends F G2 / G1 on by
# reflection and (1 - F) G2 / G1 by refraction, F being Fresnel's reflectance for unpolarised light. The mean of their sum over visible normals is E, and
# L = 1 - E is what the table has:
#
# - E. Heitz, "Understanding the masking-shadowing function in microfacet-based BRDFs" (2014): G1, G2, visible normals.
# - B. Walter and others, "Microfacet models for refraction through rough surfaces" (2007): GGX, the refracted direction.
# - J. Dupuy and A. Benyoub, "Sampling visible GGX normals with spherical caps" (2023): visible normals as a cap of the sphere, plus a vector.
# - C. Kulla and A. Conty, "Revisiting physically based shading at Imageworks" (2017): what L and its mean are for.
import sys
import textwrap

import numpy
from numpy.polynomial.chebyshev import chebval

INDICES, WIDTHS, SPLINES, MEANS = 8, 12, 43, 16
UNIT = 1e-6
LEAST, EDGE, MOST = 1.02, 2**0.5, 4.0
PARTS = ((LEAST, MOST, False), (LEAST, EDGE, True), (EDGE, MOST, True))  # from m to m; whether m is 1 / n, and there is total reflection
HEIGHTS, AZIMUTHS, MEAN_COSINES = 800, 320, 700
ROWS = 50  # heights of one array: it stays in the processor's cache

# ---- one facet ----

def spread(c, alpha):
    return numpy.sqrt(c * c + alpha * alpha * ((1 - c) * (1 + c)))


def passed(c, q, n):
    """1 - F at the cosine c, q being n times the refracted one's: 0 where q is, at total reflection."""
    across, along = c + q, n * n * c + q
    return 2 * c * q * (1 / (across * across) + n * n / (along * along))


def unmasked(w, o, alpha):
    """G2 / G1 by the cosines w and o."""
    above, spread_o = numpy.maximum(w, 0), spread(o, alpha)
    return above * (o + spread_o) / (above * spread_o + o * spread(w, alpha))


def visible_normals(o, alpha, t):
    """The cosines of visible normals to the surface's normal and to o: a row for each t, of half the azimuths, which the others mirror.

    A cap's heights are of one density. Here they are in proportion to t^2, to be weighted by 2 t, for more rows at the horizon, where they matter most.
    """
    azimuth = numpy.pi * (numpy.arange(AZIMUTHS) + 0.5) / AZIMUTHS
    sine, stretched = numpy.sqrt((1 - o) * (1 + o)), spread(o, alpha)
    x, cap, rest = alpha * sine / stretched, 1 + o / stretched, (t * t)[:, None]
    radius = numpy.sqrt((1 - rest) * cap * (2 - (1 - rest) * cap))
    mx, my, mz = alpha * (radius * numpy.cos(azimuth) + x), alpha * radius * numpy.sin(azimuth), cap * rest
    scale = 1 / numpy.sqrt(mx * mx + my * my + mz * mz)
    toward = (sine * mx + o * mz) * scale
    return mz * scale, numpy.clip(toward, 1e-100, 1)  # not 0, which would be 0 / 0 of `passed`


def sent(o, alpha, n, t):
    """What facets send on, F G2 / G1 + (1 - F) G2 / G1. Only heights are needed: what is isotropic has its masking from them."""
    mz, c = visible_normals(o, alpha, t)
    q = numpy.sqrt(numpy.maximum((n - 1) * (n + 1) + c * c, 0))
    reflected = unmasked(2 * c * mz - o, o, alpha)
    refracted = unmasked((o - (c - q) * mz) / n, o, alpha)
    return reflected + passed(c, q, n) * (refracted - reflected)


def lost(o, alpha, n):
    """L, by midpoints."""
    e = 0
    for first in range(0, HEIGHTS, ROWS):
        t = (numpy.arange(first, first + ROWS) + 0.5) / HEIGHTS
        e += (2 * t / HEIGHTS) @ sent(o, alpha, n, t).mean(axis=1)
    return 1 - e


# ---- coordinates: see glass.h ----

def s_of(m):
    return numpy.sqrt((m - 1) / (m + 1))


def index_of(part, x):
    """n and sigma for x in [-1, 1]."""
    low, high, total = part
    s = s_of(low) + (x + 1) / 2 * (s_of(high) - s_of(low))
    m = (1 + s * s) / (1 - s * s)
    return (1 / m if total else m), numpy.sqrt((1 - 1 / m) * (1 + 1 / m))


def width_of(alpha, sigma):
    return alpha * (1 + sigma) / (alpha + sigma)


def alpha_of(width, sigma):
    return width * sigma / (1 + sigma - width)


def place(c, alpha, sigma, total):
    """Where L bends: at c = 0 over some alpha, at 1, and for n < 1 at sigma, from which on facets let light through, over some alpha as well."""
    grazing, upright = numpy.sqrt(c * (1 + alpha) / (c + alpha)), 1 - numpy.sqrt(1 - c)

    def step(x):
        return (x - sigma) / numpy.hypot(x - sigma, 2 * alpha)

    if not total:
        return 0.6 * grazing + 0.4 * upright
    return 0.5 * grazing + 0.25 * upright + 0.25 * (step(c) - step(0)) / (step(1) - step(0))


def cosine_at(y, alpha, sigma, total):
    """The cosine whose place is y, by halving; not 0, where nothing is seen."""
    low, high = numpy.zeros_like(y), numpy.ones_like(y)
    for _ in range(60):
        middle = (low + high) / 2
        below = place(middle, alpha, sigma, total) < y
        low, high = numpy.where(below, middle, low), numpy.where(below, high, middle)
    return numpy.clip((low + high) / 2, 1e-12, 1)


# ---- polynomials and splines ----

def nodes(count):
    """Chebyshev's, of the first kind: interpolation there is nearly the best there is."""
    return numpy.cos(numpy.pi * (numpy.arange(count) + 0.5) / count)


def chebyshev(values, axis):
    """Coefficients of the polynomial through values at nodes."""
    count = values.shape[axis]
    angle = numpy.pi * (numpy.arange(count) + 0.5) / count
    transform = 2 / count * numpy.cos(numpy.outer(numpy.arange(count), angle))
    transform[0] /= 2
    return numpy.moveaxis(numpy.tensordot(transform, values, (1, axis)), 0, axis)


def spline(values):
    """Coefficients of the cubic B-splines through values at even steps along the last axis.

    The slopes at the ends are not known: the second value and the last but one are no knots instead.
    """
    count = values.shape[-1]
    through = numpy.zeros((count + 2, count + 2))
    for i in range(count):
        through[i, i:i + 3] = 1 / 6, 4 / 6, 1 / 6
    for row, first in ((count, 0), (count + 1, count - 3)):
        through[row, first:first + 5] = 1, -4, 6, -4, 1  # the third derivative does not jump
    return values @ numpy.linalg.inv(through)[:, :count].T


def spline_at(coefficient, y):
    p = y * (len(coefficient) - 3)
    k = numpy.clip(numpy.floor(p).astype(int), 0, len(coefficient) - 4)
    f, g = p - k, 1 - (p - k)
    weight = g**3, 4 + 3 * f * f * (f - 2), 4 + 3 * g * g * (g - 2), f**3
    return sum(weight[i] * coefficient[k + i] for i in range(4)) / 6


# ---- the tables, in units of UNIT ----

def rounded(table):
    return numpy.rint(table / UNIT).astype(int)


def lost_table(part):
    """[INDICES][WIDTHS][SPLINES] of L (c + alpha) / alpha: L falls about as alpha / (c + alpha), so that what is left is nearly even."""
    x, w, y = numpy.meshgrid(nodes(INDICES), (nodes(WIDTHS) + 1) / 2, numpy.linspace(0, 1, SPLINES - 2), indexing='ij')
    n, sigma = index_of(part, x)
    alpha = alpha_of(w, sigma)
    c = cosine_at(y, alpha, sigma, part[2])
    value = numpy.vectorize(lost)(c, alpha, n) * (c + alpha) / alpha
    return rounded(spline(chebyshev(chebyshev(value, 0), 1)))


def mean_lost(part, table, x, width):
    """<L> / alpha, of the table's L, not of the sums: the lobes' energies are to add up with the L that renders.

    By midpoints again, between cosines that are even, denser toward 0 and denser toward sigma, all at once.
    """
    sigma = index_of(part, x)[1]
    alpha = alpha_of(width, sigma)
    u = (numpy.arange(MEAN_COSINES) + 0.5) / MEAN_COSINES
    v = 2 * u - 1
    c = numpy.unique(numpy.clip(numpy.r_[0, 1, u, alpha * u / (1 + alpha - u), sigma + 2 * alpha * v / numpy.sqrt(1 - v * v)], 0, 1))
    middle = (c[1:] + c[:-1]) / 2
    line = chebval(2 * width - 1, chebval(x, table * UNIT))
    value = numpy.clip(spline_at(line, place(middle, alpha, sigma, part[2])) * alpha / (middle + alpha), 0, 1)
    return 2 * middle * value @ numpy.diff(c) / alpha


def mean_table(part, table):
    """[MEANS][SPLINES], by the fourth root of the width; 0 would have alpha = 0."""
    widths = numpy.maximum(numpy.linspace(0, 1, SPLINES - 2)**4, 1e-7)
    return rounded(spline(chebyshev(numpy.array([[mean_lost(part, table, x, w) for w in widths] for x in nodes(MEANS)]), 0)))


# ---- the header ----

def braces(table, depth):
    indent = ' ' * 4 * depth
    if table.ndim > 1:
        return '%s{\n%s%s},\n' % (indent, ''.join(braces(row, depth + 1) for row in table), indent)
    text = '{%s},' % ', '.join(map(str, table))
    return '\n'.join(textwrap.wrap(text, 148, initial_indent=indent, subsequent_indent=indent + ' ', break_on_hyphens=False)) + '\n'


def array(name, sizes, tables):
    return 'static const int32_t %s[3]%s = {\n%s};\n' % (name, ''.join('[MCR_GLASS_%s_]' % s for s in sizes), ''.join(braces(t, 1) for t in tables))


HEAD = '''/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mcrender plugin interface: the numbers of glass.h, which tells what they are and includes them. Computed for mcrender, made by
 * tests/plugins/glass_table.py.
 */
#ifndef MCRENDER_GLASS_TABLE_H
#define MCRENDER_GLASS_TABLE_H

#include <stdint.h>

#define MCR_GLASS_INDICES_ %d /* polynomials of the index, of alpha; coefficients of splines */
#define MCR_GLASS_WIDTHS_ %d
#define MCR_GLASS_SPLINES_ %d
#define MCR_GLASS_MEANS_ %d /* polynomials of the index for means */
#define MCR_GLASS_UNIT_ 1e-6 /* of all numbers below */
/* sqrt((m - 1) / (m + 1)) for m = 1.02, sqrt(2) and 4 */
#define MCR_GLASS_S1_02_ %.17g
#define MCR_GLASS_S1_41_ %.17g
#define MCR_GLASS_S4_ %.17g

''' % (INDICES, WIDTHS, SPLINES, MEANS, s_of(LEAST), s_of(EDGE), s_of(MOST))

lost_tables = [lost_table(part) for part in PARTS]
mean_tables = [mean_table(part, table) for part, table in zip(PARTS, lost_tables)]
sys.stdout.write(HEAD + array('mcr_glass_lost_', ('INDICES', 'WIDTHS', 'SPLINES'), lost_tables)
                 + array('mcr_glass_mean_', ('MEANS', 'SPLINES'), mean_tables) + '\n#endif\n')
