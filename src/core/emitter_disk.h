/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Elliptic disks by solid angle, coaxial or not. Private to the emitters' stage files.
 *
 * Seen from a point, the disk fills an elliptic cone. K = e0 e0' + e1 e1' - C C' (C: from the point to the centre) is the inverse of its
 * quadratic form: with eigenvalues mu1 >= mu2 > 0 > -m the cone is x^2/a^2 + y^2/b^2 <= z^2 in the eigenvectors' frame, a^2 = mu1/m, b^2 =
 * mu2/m. On its boundary (a cos t, b sin t, 1) of length s the solid angle swept around the axis is g dt, g = a b / (s (1 + s)): in p = 2 t
 * an even function of period 2 pi,
 *     s^2 = P + Q cos p,   P = 1 + (a^2 + b^2)/2,   Q = (a^2 - b^2)/2,
 * analytic up to a distance that makes its cosine coefficients fall like q^k, q = Q / (P + sqrt(P^2 - Q^2)). Nodes at the middles of M
 * equal parts give the solid angle to q^(2M) and the sweep, which is inverted by Newton's method, to q^M. Within the sector 1 - cos is
 * uniform. The principal frame is that of I. Guillen, C. Urena, A. King, M. Fajardo, I. Georgiev, J. Lopez-Moreno, A. Jarabo,
 * "Area-preserving parameterizations for spherical ellipses", EGSR 2017.
 */
#ifndef MCR_CORE_EMITTER_DISK_H
#define MCR_CORE_EMITTER_DISK_H

#include "core/emitter_flat.h"

/*
 * Rates q up to which M = 8, 16 and 32 nodes are taken: q^M < 5e-11 each time. Beyond, and where Newton's method has not settled, by area.
 */
#define DISK_RATE_8 0.05
#define DISK_RATE_16 0.226
#define DISK_RATE_32 0.475

/* The cone of a disk: axis z, a and b times their axes, a^2, b^2, and the number of nodes (0: by area). */
struct disk_cone {
    double zx, zy, zz, ax, ay, az, bx, by, bz, aa, bb, nodes;
    int seen;
};

/* e0, e1 in the frame whose z axis points at the disk's centre. */
struct disk_local {
    double x0, y0, z0, x1, y1, z1;
    double over, distance; /* |T| and |C| */
};

/*
 * -K's largest eigenvalue m: the root of m = w + v'(S + m)^-1 v with K = (S v; v' -w). The difference is increasing and concave, so that
 * Newton's method from below stays below; it starts from w or from the squared height over the disk, both lower bounds. All terms but w are
 * sums of squares, so that the smallest disks lose nothing. Up to rate 0.475 six steps are enough but for one point in a hundred. Stores
 * the axis, up to its length.
 */
MCR_INLINE double disk_axis(const struct disk_local *e, double square, double nn, double *x, double *y, int *settled)
{
    double xx = e->x0 * e->x0 + e->x1 * e->x1, yy = e->y0 * e->y0 + e->y1 * e->y1, xy = e->x0 * e->y0 + e->x1 * e->y1;
    double vx = e->x0 * e->z0 + e->x1 * e->z1, vy = e->y0 * e->z0 + e->y1 * e->z1, w = square - (e->z0 * e->z0 + e->z1 * e->z1);
    double trace = xx + yy, area = e->x0 * e->y1 - e->y0 * e->x1, k0 = e->y0 * vx - e->x0 * vy, k1 = e->y1 * vx - e->x1 * vy;
    double area_square = area * area, k = k0 * k0 + k1 * k1, vv = vx * vx + vy * vy, low = e->over * e->over / nn;
    double m = w > low ? w : low, step = 0;
#pragma GCC unroll 6
    for (int i = 0; i < 6; i++) {
        double d = area_square + m * (trace + m), n = k + m * vv; /* v'(S + m)^-1 v = n / d; one division for the step */
        step = d * (n - (m - w) * d) / (d * (d - vv) + n * (trace + 2 * m));
        m += step;
    }
    double inverse = 1 / (area_square + m * (trace + m));
    *settled = fabs(step) <= 1e-8 * m; /* its square is far below a rounding */
    *x = (xy * vy - (yy + m) * vx) * inverse;
    *y = (xy * vx - (xx + m) * vy) * inverse;
    return m;
}

MCR_INLINE double disk_nodes(double aa, double bb)
{
    double p = 1 + 0.5 * (aa + bb), q = 0.5 * (aa - bb), grown = p + sqrt((1 + aa) * (1 + bb)); /* P^2 - Q^2 */
    return q <= DISK_RATE_8 * grown ? 8 : q <= DISK_RATE_16 * grown ? 16 : q <= DISK_RATE_32 * grown ? 32 : 0;
}

MCR_INLINE struct disk_cone disk_cone(const struct flat *k, double px, double py, double pz)
{
    struct disk_cone cone;
    struct disk_local e;
    double cx = k->cx - px, cy = k->cy - py, cz = k->cz - pz, square = cx * cx + cy * cy + cz * cz, inverse;
    double height = -(k->nx * cx + k->ny * cy + k->nz * cz), tx, ty, tz, bx, by, bz;
    int settled;
    e.distance = sqrt(square);
    inverse = 1 / e.distance;
    cx *= inverse, cy *= inverse, cz *= inverse;
    mcr_basis(cx, cy, cz, &tx, &ty, &tz, &bx, &by, &bz);
    e.over = fabs(height);
    e.x0 = k->ux * tx + k->uy * ty + k->uz * tz, e.y0 = k->ux * bx + k->uy * by + k->uz * bz, e.z0 = k->ux * cx + k->uy * cy + k->uz * cz;
    e.x1 = k->vx * tx + k->vy * ty + k->vz * tz, e.y1 = k->vx * bx + k->vy * by + k->vz * bz, e.z1 = k->vx * cx + k->vy * cy + k->vz * cz;

    double x, y, m = disk_axis(&e, square, k->nn, &x, &y, &settled), unit = 1 / sqrt(1 + x * x + y * y);
    double zx = x * unit, zy = y * unit, zz = unit, sx, sy, sz, rx, ry, rz;
    mcr_basis(zx, zy, zz, &sx, &sy, &sz, &rx, &ry, &rz);
    /* K across the axis, and its eigenvectors; the determinant of K gives the smaller eigenvalue without cancellation. */
    double p0 = e.x0 * sx + e.y0 * sy + e.z0 * sz, p1 = e.x1 * sx + e.y1 * sy + e.z1 * sz, pc = e.distance * sz;
    double q0 = e.x0 * rx + e.y0 * ry + e.z0 * rz, q1 = e.x1 * rx + e.y1 * ry + e.z1 * rz, qc = e.distance * rz;
    double kp = p0 * p0 + p1 * p1 - pc * pc, kq = q0 * q0 + q1 * q1 - qc * qc, kpq = p0 * q0 + p1 * q1 - pc * qc;
    double half = 0.5 * (kp - kq), radius = sqrt(half * half + kpq * kpq), major = 0.5 * (kp + kq) + radius, per_m = 1 / m;
    double ep = half >= 0 ? half + radius : kpq, eq = half >= 0 ? kpq : radius - half, length = ep * ep + eq * eq;
    double level = 1 / sqrt(length > 0 ? length : 1);
    ep = length > 0 ? ep * level : 1; /* a circle has no direction of its own */
    eq = length > 0 ? eq * level : 0;
    double aa = major * per_m, bb = (e.over * per_m) * (e.over * per_m) / major;
    bb = bb < aa ? bb : aa; /* by a rounding */
    double a = sqrt(aa), b = sqrt(bb);
    double lx = a * (ep * sx + eq * rx), ly = a * (ep * sy + eq * ry), lz = a * (ep * sz + eq * rz);
    double ox = b * (ep * rx - eq * sx), oy = b * (ep * ry - eq * sy), oz = b * (ep * rz - eq * sz);
    double reach = square + e.x0 * e.x0 + e.y0 * e.y0 + e.z0 * e.z0 + e.x1 * e.x1 + e.y1 * e.y1 + e.z1 * e.z1;

    cone.zx = zx * tx + zy * bx + zz * cx, cone.zy = zx * ty + zy * by + zz * cy, cone.zz = zx * tz + zy * bz + zz * cz;
    cone.ax = lx * tx + ly * bx + lz * cx, cone.ay = lx * ty + ly * by + lz * cy, cone.az = lx * tz + ly * bz + lz * cz;
    cone.bx = ox * tx + oy * bx + oz * cx, cone.by = ox * ty + oy * by + oz * cy, cone.bz = ox * tz + oy * bz + oz * cz;
    cone.aa = aa, cone.bb = bb;
    cone.seen = (height > k->above) | (height < k->below);
    int steady = settled & (e.over * e.over > STEADY_HEIGHT_SQUARED * (k->nn * reach)) & (a * b > 2 * STEADY_HALF_ANGLE / MCR_PI);
    cone.nodes = steady ? disk_nodes(aa, bb) : 0;
    return cone;
}

#endif
