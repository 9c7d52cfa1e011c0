/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Spheres and ellipsoids as emitters. One lane at a time, without branches and calls. Private to the emitters' stage file.
 *
 * By area the density of a direction is the sum over both crossings, the far half included. By solid angle a sphere is a cone: P. Shirley,
 * C. Wang, K. Zimmerman, "Monte Carlo techniques for direct lighting calculations", ACM TOG 15(1), 1996; 1 - cos is formed as sin^2 / (1 +
 * cos), so that it keeps its digits for the smallest spheres. Seen from inside, a sphere is drawn by area; so is an ellipsoid always, as
 * the image of the unit sphere uniform *there*: its density over the area at E s is 1 / (4 pi |det E| |E^-T s|), and over solid angle r^2 /
 * (4 pi |det E| |s.E^-1 w|).
 */
#ifndef MCR_CORE_EMITTER_ROUND_H
#define MCR_CORE_EMITTER_ROUND_H

#include "core/emitter_flat.h"

struct ball {
    double cx, cy, cz, radius, square, inverse, spread, above, below;
};

MCR_INLINE struct ball ball_load(const double *k, size_t step)
{
    struct ball s = {k[0 * step], k[1 * step], k[2 * step], k[MCR_K_RADIUS * step], k[MCR_K_SQUARE * step], k[MCR_K_INVERSE * step],
                     k[MCR_K_SPREAD * step], k[MCR_K_ABOVE * step], k[MCR_K_BELOW * step]};
    return s;
}

MCR_INLINE double ball_height(const struct ball *s, double px, double py, double pz)
{
    double fx = px - s->cx, fy = py - s->cy, fz = pz - s->cz;
    return fx * fx + fy * fy + fz * fz - s->square;
}

MCR_INLINE int ball_seen(const struct ball *s, double px, double py, double pz)
{
    double height = ball_height(s, px, py, pz);
    return (height > s->above) | (height < s->below);
}

/*
 * Along the ray: the middle of the two crossings, and the square of half their distance (<= 0: none), from the part that is perpendicular
 * to the ray.
 */
MCR_INLINE double ball_middle(const struct ball *s, double px, double py, double pz, double dx, double dy, double dz, double *discriminant)
{
    double fx = px - s->cx, fy = py - s->cy, fz = pz - s->cz, middle = -(fx * dx + fy * dy + fz * dz);
    double lx = fx + middle * dx, ly = fy + middle * dy, lz = fz + middle * dz;
    *discriminant = s->square - (lx * lx + ly * ly + lz * lz);
    return middle;
}

MCR_INLINE int ball_crossed(const struct ball *s, double px, double py, double pz, double dx, double dy, double dz)
{
    double height = ball_height(s, px, py, pz), discriminant, middle = ball_middle(s, px, py, pz, dx, dy, dz, &discriminant);
    return ball_seen(s, px, py, pz) & (discriminant > 0) & ((height < 0) | (middle > 0)); /* from inside every ray crosses */
}

/* Sum of r^2 over the crossings ahead, over area times cosine: the cosine is root / R at both. */
MCR_INLINE double ball_area_density(const struct ball *s, double px, double py, double pz, double dx, double dy, double dz)
{
    double discriminant, middle = ball_middle(s, px, py, pz, dx, dy, dz, &discriminant), root = sqrt(discriminant > 0 ? discriminant : 0);
    double near = middle - root, far = middle + root, sum = (near > 0 ? near * near : 0) + (far > 0 ? far * far : 0);
    return (ball_seen(s, px, py, pz) & (discriminant > 0)) ? s->spread * sum / root : 0;
}

/* 1 / (2 pi (1 - cos)) of the cone; only outside. */
MCR_INLINE double ball_cone_density(const struct ball *s, double square, double height)
{
    return (square + sqrt(square * height)) * s->inverse;
}

MCR_INLINE double ball_solid_density(const struct ball *s, double px, double py, double pz, double dx, double dy, double dz)
{
    double height = ball_height(s, px, py, pz), outside = height > 0 ? height : 0;
    double cone = ball_cone_density(s, outside + s->square, outside), by_area = ball_area_density(s, px, py, pz, dx, dy, dz);
    cone = ball_seen(s, px, py, pz) ? cone : 0;
    return height > 0 ? cone : by_area;
}

/*
 * Density of the point at `distance` alone, by solid angle: from outside that of the cone for the nearer crossing, which is what is drawn, and 0
 * for the farther one, which is seen where the nearer lets light pass. Between the two lies the distance of the limb.
 */
MCR_INLINE double ball_solid_point_density(const struct ball *s, double px, double py, double pz, double dx, double dy, double dz,
                                           double distance)
{
    double height = ball_height(s, px, py, pz), limb = height + 16 * 0x1p-53 * (height + s->square);
    double density = ball_solid_density(s, px, py, pz, dx, dy, dz);
    return (height > 0) & (distance * distance > limb) ? 0 : density;
}

/* To the crossing that is seen: the nearer one from outside. */
MCR_INLINE double ball_distance(const struct ball *s, double px, double py, double pz, double dx, double dy, double dz)
{
    double discriminant, middle = ball_middle(s, px, py, pz, dx, dy, dz, &discriminant), root = sqrt(discriminant > 0 ? discriminant : 0);
    return ball_height(s, px, py, pz) > 0 ? middle - root : middle + root;
}

/* Density of the point at `distance` alone, by area. */
MCR_INLINE double ball_point_density(const struct ball *s, double px, double py, double pz, double dx, double dy, double dz,
                                     double distance)
{
    double qx = px - s->cx + distance * dx, qy = py - s->cy + distance * dy, qz = pz - s->cz + distance * dz;
    double cosine = fabs(qx * dx + qy * dy + qz * dz); /* times R */
    return (ball_seen(s, px, py, pz) & (cosine > 0)) ? s->spread * (distance * distance) / cosine : 0;
}

MCR_INLINE void unit_sphere(double u, double v, double *x, double *y, double *z)
{
    double rho = 2 * sqrt(u * (1 - u)), c, s;
    mcr_sincos_turns(v, &s, &c);
    *x = rho * c;
    *y = rho * s;
    *z = 1 - 2 * u;
}

/* alone: the density is that of the drawn point, not of all points in its direction. */
MCR_INLINE struct drawn ball_draw_area(const struct ball *s, int alone, double px, double py, double pz, double u, double v)
{
    double x, y, z;
    unit_sphere(u, v, &x, &y, &z);
    double qx = s->cx - px + s->radius * x, qy = s->cy - py + s->radius * y, qz = s->cz - pz + s->radius * z;
    double distance = sqrt(qx * qx + qy * qy + qz * qz), scale = 1 / distance;
    qx *= scale, qy *= scale, qz *= scale;
    double density = alone ? ball_point_density(s, px, py, pz, qx, qy, qz, distance) : ball_area_density(s, px, py, pz, qx, qy, qz);
    int good = (density > 0) & (density < MCR_INFINITY);
    struct drawn d = {good ? qx : 0, good ? qy : 0, good ? qz : 0, good ? density : 0, good ? distance : 0};
    return d;
}

/* A point of the unit disk, lifted to the cap of the cone: 1 - cos = rho^2 (1 - cos of the cone). NOT_STEADY inside. */
MCR_INLINE struct drawn ball_draw_solid(const struct ball *s, double px, double py, double pz, double u, double v)
{
    double height = ball_height(s, px, py, pz), outside = height > 0 ? height : 0, square = outside + s->square, distance = sqrt(square);
    double grown = square + sqrt(square * outside), inverse = 1 / (grown * distance), open = s->square * inverse * distance,
           along = inverse * grown;
    double x, y, rho = 1 - mcr_disk_from_square(u, v, &x, &y), sink = rho * open, out = sqrt(open * (2 - sink)), wx, wy, wz;
    int seen = (height > s->above) | (height < s->below), good = seen & (height > 0);
    double ax = (s->cx - px) * along, ay = (s->cy - py) * along, az = (s->cz - pz) * along;
    mcr_to_world(ax, ay, az, x * out, y * out, 1 - sink, &wx, &wy, &wz);
    double density = seen ? (height > 0 ? grown * s->inverse : NOT_STEADY) : 0.0;
    struct drawn d = {good ? wx : 0, good ? wy : 0, good ? wz : 0, density, 0};
    return d;
}

/* ---- ellipsoids -------------------------------------------------------------------------------------------------- */

struct egg {
    double cx, cy, cz, e[9], inverse[9], spread, above, below;
};

MCR_INLINE struct egg egg_load(const double *k, size_t step)
{
    struct egg s;
    s.cx = k[0 * step], s.cy = k[1 * step], s.cz = k[2 * step];
#pragma GCC unroll 9
    for (int i = 0; i < 9; i++) {
        s.e[i] = k[(MCR_K_E0 + i) * step];
        s.inverse[i] = k[(MCR_K_DUAL0 + i) * step];
    }
    s.spread = k[MCR_K_SPREAD * step], s.above = k[MCR_K_ABOVE * step], s.below = k[MCR_K_BELOW * step];
    return s;
}

/* A ray in the space where the ellipsoid is the unit sphere; its direction is not unit there. */
struct egg_ray {
    double fx, fy, fz, dx, dy, dz, height;
};

MCR_INLINE struct egg_ray egg_ray(const struct egg *s, double px, double py, double pz, double dx, double dy, double dz)
{
    const double *m = s->inverse;
    double gx = px - s->cx, gy = py - s->cy, gz = pz - s->cz;
    struct egg_ray r = {
        m[0] * gx + m[1] * gy + m[2] * gz, m[3] * gx + m[4] * gy + m[5] * gz, m[6] * gx + m[7] * gy + m[8] * gz,
        m[0] * dx + m[1] * dy + m[2] * dz, m[3] * dx + m[4] * dy + m[5] * dz, m[6] * dx + m[7] * dy + m[8] * dz, 0};
    r.height = r.fx * r.fx + r.fy * r.fy + r.fz * r.fz - 1;
    return r;
}

MCR_INLINE int egg_seen(const struct egg *s, const struct egg_ray *r)
{
    return (r->height > s->above) | (r->height < s->below);
}

/* As ball_middle, with `a` the square of the direction's length: crossings at middle +- sqrt(discriminant / a). */
MCR_INLINE double egg_middle(const struct egg_ray *r, double *a, double *discriminant)
{
    *a = r->dx * r->dx + r->dy * r->dy + r->dz * r->dz;
    double middle = -(r->fx * r->dx + r->fy * r->dy + r->fz * r->dz) / *a;
    double lx = r->fx + middle * r->dx, ly = r->fy + middle * r->dy, lz = r->fz + middle * r->dz;
    *discriminant = 1 - (lx * lx + ly * ly + lz * lz);
    return middle;
}

MCR_INLINE int egg_crossed(const struct egg *s, double px, double py, double pz, double dx, double dy, double dz)
{
    struct egg_ray r = egg_ray(s, px, py, pz, dx, dy, dz);
    double a, discriminant, middle = egg_middle(&r, &a, &discriminant);
    return egg_seen(s, &r) & (discriminant > 0) & ((r.height < 0) | (middle > 0));
}

/* |s.E^-1 w| is sqrt(a discriminant) at both crossings. */
MCR_INLINE double egg_area_density(const struct egg *s, double px, double py, double pz, double dx, double dy, double dz)
{
    struct egg_ray r = egg_ray(s, px, py, pz, dx, dy, dz);
    double a, discriminant, middle = egg_middle(&r, &a, &discriminant);
    double slope = sqrt(a * (discriminant > 0 ? discriminant : 0)), root = slope / a;
    double near = middle - root, far = middle + root, sum = (near > 0 ? near * near : 0) + (far > 0 ? far * far : 0);
    return (egg_seen(s, &r) & (discriminant > 0)) ? s->spread * sum / slope : 0;
}

MCR_INLINE double egg_point_density(const struct egg *s, double px, double py, double pz, double dx, double dy, double dz, double distance)
{
    struct egg_ray r = egg_ray(s, px, py, pz, dx, dy, dz);
    double slope = fabs((r.fx + distance * r.dx) * r.dx + (r.fy + distance * r.dy) * r.dy + (r.fz + distance * r.dz) * r.dz);
    return (egg_seen(s, &r) & (slope > 0)) ? s->spread * (distance * distance) / slope : 0;
}

MCR_INLINE struct drawn egg_draw_area(const struct egg *s, int alone, double px, double py, double pz, double u, double v)
{
    double x, y, z;
    unit_sphere(u, v, &x, &y, &z);
    double qx = s->cx - px + s->e[0] * x + s->e[3] * y + s->e[6] * z, qy = s->cy - py + s->e[1] * x + s->e[4] * y + s->e[7] * z;
    double qz = s->cz - pz + s->e[2] * x + s->e[5] * y + s->e[8] * z, distance = sqrt(qx * qx + qy * qy + qz * qz), scale = 1 / distance;
    qx *= scale, qy *= scale, qz *= scale;
    double density = alone ? egg_point_density(s, px, py, pz, qx, qy, qz, distance) : egg_area_density(s, px, py, pz, qx, qy, qz);
    int good = (density > 0) & (density < MCR_INFINITY);
    struct drawn d = {good ? qx : 0, good ? qy : 0, good ? qz : 0, good ? density : 0, good ? distance : 0};
    return d;
}

#endif
