/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Ray against shape, one ray and one shape, in a form that vectorises when called in a loop over rays: no branches, no calls but sqrt.
 * Each returns whether the ray crosses the shape at some t > 0, and stores the smallest such t (without one: anything). Division by zero gives
 * infinities and NaN, which fail every comparison in the right direction.
 */
#ifndef MCR_ACCEL_KERNELS_H
#define MCR_ACCEL_KERNELS_H

#include <math.h>
#include <stdint.h>

#include "accel/accel.h"

/* t where the ray meets the plane through k[0..2] with normal k[3..5]. */
static inline __attribute__((always_inline)) int kernel_plane(const double *k, double ox, double oy, double oz, double dx, double dy, double dz, double *at)
{
    double numerator = k[3] * (k[0] - ox) + k[4] * (k[1] - oy) + k[5] * (k[2] - oz);
    double t = numerator / (k[3] * dx + k[4] * dy + k[5] * dz);
    *at = t;
    return t > 0;
}

/* The point's coordinates (a, b) along the two edges: dual vectors k[6..8], k[9..11]. */
static inline __attribute__((always_inline)) int kernel_parallelogram(const double *k, double ox, double oy, double oz, double dx, double dy, double dz, double *at)
{
    double cx = ox - k[0], cy = oy - k[1], cz = oz - k[2];
    double t = -(k[3] * cx + k[4] * cy + k[5] * cz) / (k[3] * dx + k[4] * dy + k[5] * dz);
    double qx = cx + t * dx, qy = cy + t * dy, qz = cz + t * dz;
    double a = k[6] * qx + k[7] * qy + k[8] * qz;
    double b = k[9] * qx + k[10] * qy + k[11] * qz;
    *at = t;
    return (t > 0) & (a >= 0) & (a <= 1) & (b >= 0) & (b <= 1);
}

static inline __attribute__((always_inline)) int kernel_disk(const double *k, double ox, double oy, double oz, double dx, double dy, double dz, double *at)
{
    double cx = ox - k[0], cy = oy - k[1], cz = oz - k[2];
    double t = -(k[3] * cx + k[4] * cy + k[5] * cz) / (k[3] * dx + k[4] * dy + k[5] * dz);
    double qx = cx + t * dx, qy = cy + t * dy, qz = cz + t * dz;
    double a = k[6] * qx + k[7] * qy + k[8] * qz;
    double b = k[9] * qx + k[10] * qy + k[11] * qz;
    *at = t;
    return (t > 0) & (a * a + b * b <= 1);
}

/*
 * The nearer of two roots q and c/q that lies beyond 0. The discriminant comes from the part of o - c that is perpendicular to the ray, which
 * keeps far and small spheres exact (Haines, Günther and Akenine-Möller, "Precision improvements for ray/sphere intersection", Ray Tracing Gems, 2019).
 */
static inline __attribute__((always_inline)) int kernel_sphere(const double *k, double ox, double oy, double oz, double dx, double dy, double dz, double *at)
{
    double fx = ox - k[0], fy = oy - k[1], fz = oz - k[2];
    double b = -(fx * dx + fy * dy + fz * dz);
    double lx = fx + b * dx, ly = fy + b * dy, lz = fz + b * dz;
    double discriminant = k[4] - (lx * lx + ly * ly + lz * lz);
    double root = sqrt(discriminant > 0 ? discriminant : 0);
    double q = b > 0 ? b + root : b - root;
    double c = (fx * fx + fy * fy + fz * fz) - k[4];
    double other = c / q;
    double near = q < other ? q : other;
    double far = q < other ? other : q;
    double t = near > 0 ? near : far;
    *at = t;
    return (discriminant >= 0) & (t > 0);
}

/* As the sphere, in the space where the ellipsoid is the unit sphere; the direction is not unit there. */
static inline __attribute__((always_inline)) int kernel_ellipsoid(const double *k, double ox, double oy, double oz, double dx, double dy, double dz, double *at)
{
    double gx = ox - k[0], gy = oy - k[1], gz = oz - k[2];
    double fx = k[3] * gx + k[4] * gy + k[5] * gz;
    double fy = k[6] * gx + k[7] * gy + k[8] * gz;
    double fz = k[9] * gx + k[10] * gy + k[11] * gz;
    double ex = k[3] * dx + k[4] * dy + k[5] * dz;
    double ey = k[6] * dx + k[7] * dy + k[8] * dz;
    double ez = k[9] * dx + k[10] * dy + k[11] * dz;
    double a = ex * ex + ey * ey + ez * ez;
    double b = -(fx * ex + fy * ey + fz * ez);
    double s = b / a;
    double lx = fx + s * ex, ly = fy + s * ey, lz = fz + s * ez;
    double discriminant = 1 - (lx * lx + ly * ly + lz * lz);
    double root = sqrt((discriminant > 0 ? discriminant : 0) * a);
    double q = b > 0 ? b + root : b - root;
    double c = (fx * fx + fy * fy + fz * fz) - 1;
    double one = q / a, other = c / q;
    double near = one < other ? one : other;
    double far = one < other ? other : one;
    double t = near > 0 ? near : far;
    *at = t;
    return (discriminant >= 0) & (t > 0);
}

/* A cosine moved away from 0 by 1e-100, so that nothing is divided by zero and products of three stay in range. From 2e-84 on it stays as it is. */
static inline __attribute__((always_inline)) double kernel_off_zero(double x)
{
    return x + __builtin_copysign(1e-100, x);
}

/* The inverses of three cosines with one division, which is what the loops wait for. */
static inline __attribute__((always_inline)) void kernel_inverse(double x, double y, double z, double inverse[3])
{
    double a = kernel_off_zero(x), b = kernel_off_zero(y), c = kernel_off_zero(z);
    double bc = b * c, all = 1 / (a * bc);
    inverse[0] = all * bc;
    inverse[1] = all * (a * c);
    inverse[2] = all * (a * b);
}

/* A rectangle across an axis: at coordinate k[0] of that axis (o, inverse), from k[1] to k[2] of the next axis (p, d) and from k[3] to k[4] of the last (q, e). */
static inline __attribute__((always_inline)) int kernel_rectangle(const double *k, double o, double inverse, double p, double d, double q, double e, double *at)
{
    double t = (k[0] - o) * inverse;
    double a = p + t * d, b = q + t * e;
    *at = t;
    return (t > 0) & (a >= k[1]) & (a <= k[2]) & (b >= k[3]) & (b <= k[4]);
}

/* Where a ray meets the two faces across an axis: the nearer, the farther, and the inverse of its direction's cosine to the normal inward from the first face. */
struct mcr_slab {
    double near, far, inverse;
};

static inline __attribute__((always_inline)) struct mcr_slab kernel_slab(double first, double opposite, double inverse)
{
    struct mcr_slab s = {first < opposite ? first : opposite, first > opposite ? first : opposite, inverse};
    return s;
}

/*
 * What lies within three slabs, of the axes a, b and c. *face: 2 i for the face of axis i through the corner, 2 i + 1 for the opposite one. The
 * distances are finite (kernel_inverse), so that a ray in a side's plane makes no NaN.
 */
static inline __attribute__((always_inline)) int kernel_slabs(struct mcr_slab x, struct mcr_slab y, struct mcr_slab z, double a, double b, double c, double *face, double *at)
{
    double ix = x.inverse, iy = y.inverse, iz = z.inverse, nx = x.near, ny = y.near, nz = z.near, fx = x.far, fy = y.far, fz = z.far;
    double enter = ny > nx ? ny : nx;
    enter = nz > enter ? nz : enter;
    double leave = fy < fx ? fy : fx;
    leave = fz < leave ? fz : leave;
    int outside = enter > 0;
    double t = outside ? enter : leave;
    /* A ray that enters along a positive direction meets the face through the corner; one that leaves along it, the opposite one. */
    double tx = outside ? nx : fx, ty = outside ? ny : fy;
    int by_x = t == tx, by_y = t == ty;
    double along = by_y ? iy : iz, first = by_y ? 2 * b : 2 * c;
    along = by_x ? ix : along;
    first = by_x ? 2 * a : first;
    along = outside ? along : -along;
    *face = along > 0 ? first : first + 1;
    *at = t;
    return (enter <= leave) & (t > 0);
}

/* Unit normals k[3..11] inward from the faces through the corner, which are k[12..14] away from those opposite. */
static inline __attribute__((always_inline)) int kernel_box(const double *k, double ox, double oy, double oz, double dx, double dy, double dz, double *face, double *at)
{
    double cx = ox - k[0], cy = oy - k[1], cz = oz - k[2], inverse[3];
    double x = k[3] * cx + k[4] * cy + k[5] * cz, y = k[6] * cx + k[7] * cy + k[8] * cz, z = k[9] * cx + k[10] * cy + k[11] * cz;
    kernel_inverse(k[3] * dx + k[4] * dy + k[5] * dz, k[6] * dx + k[7] * dy + k[8] * dz, k[9] * dx + k[10] * dy + k[11] * dz, inverse);
    struct mcr_slab sx = kernel_slab(-x * inverse[0], (k[12] - x) * inverse[0], inverse[0]);
    struct mcr_slab sy = kernel_slab(-y * inverse[1], (k[13] - y) * inverse[1], inverse[1]);
    struct mcr_slab sz = kernel_slab(-z * inverse[2], (k[14] - z) * inverse[2], inverse[2]);
    return kernel_slabs(sx, sy, sz, 0, 1, 2, face, at);
}

/*
 * A box of which one axis, `axis`, is the world's (o, inverse); p, d and q, e are along the world's next and last one in cyclic order.
 * k[0..2]: the corner in the order o, p, q; k[3]: 1, or -1 where the edge runs against the axis; k[4]: the coordinate of the opposite face less
 * the corner's; k[5..6] and k[7..8]: the normals of the next and the last axis in (p, q); k[9..10]: their distances.
 */
static inline __attribute__((always_inline)) int kernel_upright(const double *k, int axis, double o, double inverse, double p, double d, double q, double e, double *face, double *at)
{
    double co = o - k[0], cp = p - k[1], cq = q - k[2];
    double x = k[5] * cp + k[6] * cq, y = k[7] * cp + k[8] * cq;
    double a = kernel_off_zero(k[5] * d + k[6] * e), b = kernel_off_zero(k[7] * d + k[8] * e), all = 1 / (a * b), ia = all * b, ib = all * a;
    struct mcr_slab own = kernel_slab(-co * inverse, (k[4] - co) * inverse, inverse * k[3]);
    struct mcr_slab next = kernel_slab(-x * ia, (k[9] - x) * ia, ia), last = kernel_slab(-y * ib, (k[10] - y) * ib, ib);
    return kernel_slabs(own, next, last, axis, (axis + 1) % 3, (axis + 2) % 3, face, at);
}

/*
 * A ray as the triangle kernel wants it: three linear forms that take a point relative to the origin to the plane perpendicular to the ray's main
 * axis, sheared along the ray, and to its depth.
 */
struct mcr_shear {
    double p[3], q[3], r[3];
};

/* Woop, Benthin and Wald, "Watertight ray/triangle intersection", JCGT 2(1), 2013: the same shear and axes, written as linear forms. */
static inline __attribute__((always_inline)) struct mcr_shear kernel_shear(double dx, double dy, double dz)
{
    double ax = fabs(dx), ay = fabs(dy), az = fabs(dz);
    int by_z = (az >= ax) & (az >= ay);
    int by_y = !by_z & (ay >= ax);
    int by_x = !by_z & !by_y;
    double major = by_z ? dz : by_y ? dy : dx;
    double inverse = 1 / major;
    /* The two other axes in cyclic order; swapped for a negative main axis so that the winding is kept. The forms' signs do not matter otherwise. */
    double u = (by_z ? dx : by_y ? dz : dy) * inverse;
    double v = (by_z ? dy : by_y ? dx : dz) * inverse;
    struct mcr_shear s;
    s.p[0] = by_z ? 1.0 : by_y ? 0.0 : -u;
    s.p[1] = by_z ? 0.0 : by_y ? -u : 1.0;
    s.p[2] = by_z ? -u : by_y ? 1.0 : 0.0;
    s.q[0] = by_z ? 0.0 : by_y ? 1.0 : -v;
    s.q[1] = by_z ? 1.0 : by_y ? -v : 0.0;
    s.q[2] = by_z ? -v : by_y ? 0.0 : 1.0;
    s.r[0] = by_x ? inverse : 0.0;
    s.r[1] = by_y ? inverse : 0.0;
    s.r[2] = by_z ? inverse : 0.0;
    return s;
}

/*
 * Watertight: an edge that two triangles share gives both the same edge function with opposite sign, to the bit (no contraction), and 0 counts
 * as inside for both. a, b, c are the vertices.
 */
static inline __attribute__((always_inline)) int kernel_triangle(const struct mcr_shear *s, double ax, double ay, double az, double bx, double by, double bz, double cx,
                                     double cy, double cz, double ox, double oy, double oz, double *at)
{
    ax -= ox, ay -= oy, az -= oz, bx -= ox, by -= oy, bz -= oz, cx -= ox, cy -= oy, cz -= oz;
    double ap = s->p[0] * ax + s->p[1] * ay + s->p[2] * az, aq = s->q[0] * ax + s->q[1] * ay + s->q[2] * az;
    double bp = s->p[0] * bx + s->p[1] * by + s->p[2] * bz, bq = s->q[0] * bx + s->q[1] * by + s->q[2] * bz;
    double cp = s->p[0] * cx + s->p[1] * cy + s->p[2] * cz, cq = s->q[0] * cx + s->q[1] * cy + s->q[2] * cz;
    double u = cp * bq - cq * bp, v = ap * cq - aq * cp, w = bp * aq - bq * ap;
    double ar = s->r[0] * ax + s->r[1] * ay + s->r[2] * az;
    double br = s->r[0] * bx + s->r[1] * by + s->r[2] * bz;
    double cr = s->r[0] * cx + s->r[1] * cy + s->r[2] * cz;
    double sum = u + v + w;
    double t = (u * ar + v * br + w * cr) / sum;
    int inside = ((u >= 0) & (v >= 0) & (w >= 0)) | ((u <= 0) & (v <= 0) & (w <= 0));
    /* Seen edge-on u, v, w are rounding alone: the ray has to pass the projection's bounds as well. Exact, so that it opens no crack. */
    int left = (ap <= 0) | (bp <= 0) | (cp <= 0), right = (ap >= 0) | (bp >= 0) | (cp >= 0);
    int below = (aq <= 0) | (bq <= 0) | (cq <= 0), above = (aq >= 0) | (bq >= 0) | (cq >= 0);
    *at = t;
    return inside & left & right & below & above & (t > 0);
}

#endif
