/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Parallelograms, triangles and disks as emitters: crossing, drawing by area and by solid angle, densities. One lane at a time, without
 * branches and calls, so that a loop over lanes is vectorised. Private to the emitters' stage file.
 *
 * Solid angle: A. Van Oosterom, J. Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30 (1983): for the triangle
 * A, B, C seen from the origin, tan(W/2) = T / D with the triple product T = A.(B x C) and D = |A||B||C| + (A.B)|C| + (B.C)|A| + (C.A)|B|.
 * T is taken as N.(p - c) with N = e0 x e1 known beforehand; it is the same for both triangles of a parallelogram, whose half angles are
 * added as the arguments of the complex numbers D + iT: one arc tangent gives the whole.
 *
 * Drawing: the polygon is swept by a fan of arcs from the vertex B; the arc that ends at the point P of the far edge cuts off the area w.
 * With P at the angle t along the great circle from the unit vector a toward m (m = E - (a.E) a for the edge's vector E), the formula above
 * gives
 *     tan(w/2) = T' tan(t/2) / ((1 + a.b)|m| + (b.m) tan(t/2)),   T' = a.(b x m),
 * which is solved for tan(t/2) without any angle: J. Arvo, "Stratified sampling of spherical triangles", SIGGRAPH 1995, in half-angle form
 * (C. Peters, "BRDF importance sampling for polygonal lights", ACM TOG 40(4), 2021, section 4, does alike). No term cancels for small
 * triangles, where Arvo's do.
 * Along the arc the cosine to B is uniform; it is taken from the chord |b - c'|^2 = 2 (1 - b.c').
 */
#ifndef MCR_CORE_EMITTER_FLAT_H
#define MCR_CORE_EMITTER_FLAT_H

#include "base/elementary.h"
#include "core/emitters.h"

/*
 * Below these limits points are drawn by area instead, the same in draw and density. A light of 1e-8 sr is so small that area and solid
 * angle are alike to 1e-4 (its measure would hold: the error is 7e-16 / (cos sin) at all sizes). A point lower over the plane than 2^-14 of
 * the farthest vertex sees it at a grazing angle or has it at its nose; above, the measure errs by at most 2.3e-12. Both figures:
 * tests/core/emitters_measure.c.
 */
#define STEADY_HALF_ANGLE 5e-9
#define STEADY_HEIGHT_SQUARED 0x1p-28

/* What was drawn in a lane: unit direction, density, distance. All 0: nothing. */
struct drawn {
    double x, y, z, density, distance;
};

#define NOT_STEADY (-1.0) /* as a density: by area instead */

struct flat {
    double cx, cy, cz, ux, uy, uz, vx, vy, vz, nx, ny, nz; /* corner, e0, e1, N */
    double above, below, factor, nn;
};

/* Constant j stands at k[j * step]. */
MCR_INLINE struct flat flat_load(const double *k, size_t step)
{
    struct flat f = {
        k[0 * step], k[1 * step], k[2 * step], k[3 * step], k[4 * step],  k[5 * step],
        k[6 * step], k[7 * step], k[8 * step], k[9 * step], k[10 * step], k[11 * step],
        k[MCR_K_ABOVE * step], k[MCR_K_BELOW * step], k[MCR_K_FACTOR * step], k[MCR_K_NN * step],
    };
    return f;
}

MCR_INLINE double flat_height(const struct flat *f, double px, double py, double pz)
{
    return f->nx * (px - f->cx) + f->ny * (py - f->cy) + f->nz * (pz - f->cz);
}

/*
 * 1 where the ray crosses. Coordinates (a, b) along the edges are compared after multiplication by the positive denominator of the ray's
 * length.
 * dual: the two dual vectors.
 */
MCR_INLINE int flat_crossed(uint32_t kind, const struct flat *f, const double *dual, double px, double py, double pz, double dx, double dy,
                            double dz)
{
    double fx = px - f->cx, fy = py - f->cy, fz = pz - f->cz;
    double height = f->nx * fx + f->ny * fy + f->nz * fz, toward = f->nx * dx + f->ny * dy + f->nz * dz;
    double over = fabs(height), sink = height < 0 ? toward : -toward;
    double a = (dual[0] * fx + dual[1] * fy + dual[2] * fz) * sink + over * (dual[0] * dx + dual[1] * dy + dual[2] * dz);
    double b = (dual[3] * fx + dual[4] * fy + dual[5] * fz) * sink + over * (dual[3] * dx + dual[4] * dy + dual[5] * dz);
    int seen = (height > f->above) | (height < f->below), inside;
    if (kind == MCR_EMITTER_PARALLELOGRAM)
        inside = (a >= 0) & (b >= 0) & (a <= sink) & (b <= sink);
    else if (kind == MCR_EMITTER_TRIANGLE)
        inside = (a >= 0) & (b >= 0) & (a + b <= sink);
    else
        inside = a * a + b * b <= sink * sink;
    return seen & inside & (sink > 0);
}

/* The density by area of a direction that crosses: t^2 / (area cos). As all densities of directions, 0 where the emitter is not seen. */
MCR_INLINE double flat_area_density(const struct flat *f, double px, double py, double pz, double dx, double dy, double dz)
{
    double height = flat_height(f, px, py, pz), sink = fabs(f->nx * dx + f->ny * dy + f->nz * dz);
    double density = f->factor * (height * height) / (sink * sink * sink);
    int crossed = ((height > f->above) | (height < f->below)) & (sink > 0);
    return crossed ? density : 0;
}

/* The distance to the plane. */
MCR_INLINE double flat_distance(const struct flat *f, double px, double py, double pz, double dx, double dy, double dz)
{
    return fabs(flat_height(f, px, py, pz) / (f->nx * dx + f->ny * dy + f->nz * dz));
}

/* A point (s, t) along e0, e1, uniform in area. */
MCR_INLINE struct drawn flat_draw_area(uint32_t kind, const struct flat *f, double px, double py, double pz, double u, double v)
{
    double ax = f->cx - px, ay = f->cy - py, az = f->cz - pz, s, t;
    double height = -(f->nx * ax + f->ny * ay + f->nz * az), over = fabs(height);
    if (kind == MCR_EMITTER_DISK) {
        mcr_disk_from_square(u, v, &s, &t);
    } else if (kind == MCR_EMITTER_TRIANGLE) {
        double root = sqrt(u);
        t = root * v;
        s = root - t;
    } else {
        s = u;
        t = v;
    }
    double qx = ax + s * f->ux + t * f->vx, qy = ay + s * f->uy + t * f->vy, qz = az + s * f->uz + t * f->vz;
    double square = qx * qx + qy * qy + qz * qz, distance = sqrt(square);
    double inverse = 1 / (distance * over), scale = inverse * over; /* one division for two */
    double density = f->factor * (square * square) * inverse;
    int good = ((height > f->above) | (height < f->below)) & (density < MCR_INFINITY);
    struct drawn d = {good ? qx * scale : 0, good ? qy * scale : 0, good ? qz * scale : 0, good ? density : 0, good ? distance : 0};
    return d;
}

/*
 * The argument of re + i im for im >= 0, in [0, pi], to 3 roundings: mcr_atan2 without its second division, signs and special cases (its
 * polynomial).
 * Divisions and roots are what the lanes wait for here.
 */
MCR_INLINE double upper_argument(double im, double re)
{
    double side = fabs(re);
    int steep = im > side;
    double high = steep ? im : side, low = steep ? side : im;
    int large = low > 0x1.a827999fcef32p-2 * high; /* tan(pi/8) */
    double z = (large ? low - high : low) / (large ? low + high : high), w = z * z, w2 = w * w, w4 = w2 * w2;
    double p0 = (-0x1.555555555553dp-2 + w * 0x1.9999999995869p-3) + w2 * (-0x1.24924922ad54fp-3 + w * 0x1.c71c70e60a928p-4);
    double p1 = (-0x1.745cf8dba42ccp-4 + w * 0x1.3b111907c1d73p-4) + w2 * (-0x1.10ebb6fe2e503p-4 + w * 0x1.df0f3283725b7p-5);
    double p2 = (-0x1.9cd23155f70dcp-5 + w * 0x1.37d3f99aab701p-5) - w2 * 0x1.256616ad96409p-6;
    double p = p0 + w4 * (p1 + w4 * p2), angle;
    angle = (large ? 0x1.921fb54442d18p-1 : 0) + (z + z * (w * p));
    angle = steep ? 0x1.921fb54442d18p+0 - angle : angle;
    return re < 0 ? MCR_PI - angle : angle;
}

/*
 * Sine and cosine of x in [0, pi], from a quarter of it (the polynomials of mcr_sin and mcr_cos) by doubling twice: errors below 1e-15, of
 * the sine relative.
 */
MCR_INLINE void half_turn(double x, double *sine, double *cosine)
{
    double y = 0.25 * x, z = y * y, z2 = z * z, z4 = z2 * z2;
    double s = (-0x1.5555555555548p-3 + z * 0x1.111111110f72fp-7) + z2 * (-0x1.a01a019be90b4p-13 + z * 0x1.71de3555361a3p-19) +
               z4 * (-0x1.ae5e4ba0491e7p-26 + z * 0x1.5d8b60e162fadp-33);
    double c = (0x1.555555555554bp-5 - z * 0x1.6c16c16c15015p-10) + z2 * (0x1.a01a019c8f204p-16 - z * 0x1.27e4f7f188713p-22) +
               z4 * (0x1.1ee9dbc541f9cp-29 - z * 0x1.8fa67db631123p-37);
    s = y + y * (z * s);
    c = 1 - z * (0.5 - z * c);
    double sine2 = 2 * s * c, cosine2 = 1 - 2 * s * s;
    *sine = 2 * sine2 * cosine2;
    *cosine = 1 - 2 * sine2 * sine2;
}

/*
 * The vertices seen from the point: lengths and dot products. Vertex 2 of a triangle is c + e1; of a parallelogram, c + e0 + e1 and vertex
 * 3 is c + e1.
 */
struct fan {
    double x[4], y[4], z[4], length[4];
    double d01, d02, d12, d03, d23;
    double triple;        /* |T| */
    double first, second; /* D of the triangles 0 1 2 and 0 2 3 */
    double re, im;        /* argument: half the solid angle */
    double half;
    int seen, steady;
};

#define DOT(f, i, j) ((f)->x[i] * (f)->x[j] + (f)->y[i] * (f)->y[j] + (f)->z[i] * (f)->z[j])

MCR_INLINE void fan_triangle(const struct flat *k, struct fan *f)
{
    f->x[2] = f->x[0] + k->vx, f->y[2] = f->y[0] + k->vy, f->z[2] = f->z[0] + k->vz;
    double s0 = DOT(f, 0, 0), s1 = DOT(f, 1, 1), s2 = DOT(f, 2, 2), far = s0 > s1 ? s0 : s1;
    far = far > s2 ? far : s2;
    f->length[0] = sqrt(s0), f->length[1] = sqrt(s1), f->length[2] = sqrt(s2);
    f->d01 = DOT(f, 0, 1), f->d02 = DOT(f, 0, 2), f->d12 = DOT(f, 1, 2);
    f->re = f->length[0] * f->length[1] * f->length[2] + f->d01 * f->length[2] + f->d12 * f->length[0] + f->d02 * f->length[1];
    f->im = f->triple;
    f->first = f->re, f->second = 0; /* no second triangle */
    f->steady = f->triple * f->triple > STEADY_HEIGHT_SQUARED * (k->nn * far);
}

MCR_INLINE void fan_parallelogram(const struct flat *k, struct fan *f)
{
    f->x[2] = f->x[1] + k->vx, f->y[2] = f->y[1] + k->vy, f->z[2] = f->z[1] + k->vz;
    f->x[3] = f->x[0] + k->vx, f->y[3] = f->y[0] + k->vy, f->z[3] = f->z[0] + k->vz;
    double s0 = DOT(f, 0, 0), s1 = DOT(f, 1, 1), s2 = DOT(f, 2, 2), s3 = DOT(f, 3, 3);
    double low = s0 > s1 ? s0 : s1, high = s2 > s3 ? s2 : s3, far = low > high ? low : high;
    f->length[0] = sqrt(s0), f->length[1] = sqrt(s1), f->length[2] = sqrt(s2), f->length[3] = sqrt(s3);
    f->d01 = DOT(f, 0, 1), f->d02 = DOT(f, 0, 2), f->d12 = DOT(f, 1, 2), f->d03 = DOT(f, 0, 3), f->d23 = DOT(f, 2, 3);
    double across = f->length[0] * f->length[2] + f->d02; /* of both triangles */
    f->first = f->length[1] * across + f->d01 * f->length[2] + f->d12 * f->length[0];
    f->second = f->length[3] * across + f->d03 * f->length[2] + f->d23 * f->length[0];
    f->re = f->first * f->second - f->triple * f->triple;
    f->im = f->triple * (f->first + f->second);
    f->steady = f->triple * f->triple > STEADY_HEIGHT_SQUARED * (k->nn * far);
}

/* All but `half`, whose limit `steady` does not include. */
MCR_INLINE struct fan fan_open(uint32_t kind, const struct flat *k, double px, double py, double pz)
{
    struct fan f;
    double height;
    f.x[0] = k->cx - px, f.y[0] = k->cy - py, f.z[0] = k->cz - pz;
    f.x[1] = f.x[0] + k->ux, f.y[1] = f.y[0] + k->uy, f.z[1] = f.z[0] + k->uz;
    height = -(k->nx * f.x[0] + k->ny * f.y[0] + k->nz * f.z[0]);
    f.triple = fabs(height);
    f.seen = (height > k->above) | (height < k->below);
    if (kind == MCR_EMITTER_TRIANGLE)
        fan_triangle(k, &f);
    else
        fan_parallelogram(k, &f);
    return f;
}

MCR_INLINE struct fan fan_measure(uint32_t kind, const struct flat *k, double px, double py, double pz)
{
    struct fan f = fan_open(kind, k, px, py, pz);
    f.half = upper_argument(f.im, f.re);
    f.steady &= f.half > STEADY_HALF_ANGLE;
    return f;
}

/* The density by solid angle of a direction that crosses; by area where that is not steady. */
MCR_INLINE double flat_solid_density(uint32_t kind, const struct flat *k, double px, double py, double pz, double dx, double dy, double dz)
{
    struct fan f = fan_measure(kind, k, px, py, pz);
    double by_area = flat_area_density(k, px, py, pz, dx, dy, dz), by_angle = 0.5 / f.half;
    by_angle = f.seen ? by_angle : 0;
    return f.steady ? by_angle : by_area;
}

/*
 * Drawing goes over the lanes three times, since the chain from the vertices to the direction is longer than what a processor holds in
 * flight: flat_draw_open, flat_draw_angle, flat_draw_sweep. What they hand over:
 */
struct sweep {
    double length0, length1, length2, d01, d02, triple, first, re, im; /* of struct fan */
    double sine, cosine;                                               /* of the part u of half the solid angle */
    double half;                                                       /* 0: not seen; NOT_STEADY */
};

MCR_INLINE struct sweep flat_draw_open(uint32_t kind, const struct flat *k, double px, double py, double pz)
{
    struct fan f = fan_open(kind, k, px, py, pz);
    struct sweep s = {f.length[0], f.length[1], f.length[2], f.d01, f.d02, f.triple, f.first, f.re, f.im, 0, 0,
                      f.seen ? (f.steady ? 1 : NOT_STEADY) : 0};
    return s;
}

MCR_INLINE void flat_draw_angle(struct sweep *s, double u)
{
    double half = upper_argument(s->im, s->re);
    half_turn(u * half, &s->sine, &s->cosine);
    s->half = s->half > 0 ? (half > STEADY_HALF_ANGLE ? half : NOT_STEADY) : s->half;
}

MCR_INLINE struct drawn flat_draw_sweep(uint32_t kind, const struct flat *k, const struct sweep *s, double px, double py, double pz,
                                        double v)
{
    double x0 = k->cx - px, y0 = k->cy - py, z0 = k->cz - pz, ax = x0 + k->ux, ay = y0 + k->uy, az = z0 + k->uz, ex, ey, ez;
    double sine = s->sine, cosine = s->cosine, length = s->length1, dot = s->d01;
    if (kind == MCR_EMITTER_TRIANGLE) {
        ex = k->vx - k->ux, ey = k->vy - k->uy, ez = k->vz - k->uz;
    } else {
        /* Past the first triangle, whose half angle has the direction first + i triple: the rest goes into the second one, along -e0. */
        double past = sine * s->first - cosine * s->triple, along = cosine * s->first + sine * s->triple;
        int second = past > 0;
        sine = second ? past : sine;
        cosine = second ? along : cosine;
        ax = second ? ax + k->vx : ax, ay = second ? ay + k->vy : ay, az = second ? az + k->vz : az;
        ex = second ? -k->ux : k->vx, ey = second ? -k->uy : k->vy, ez = second ? -k->uz : k->vz;
        length = second ? s->length2 : length;
        dot = second ? s->d02 : dot;
    }
    /*
     * With A and m = |A|^2 E - (A.E) A not brought to unit length, tan(t/2) = x |m| / y. One division serves 1/|A|, 1/|B| and 1/(x^2 m^2 +
     * y^2).
     */
    double square = length * length, along = ax * ex + ay * ey + az * ez;
    double mx = square * ex - along * ax, my = square * ey - along * ay, mz = square * ez - along * az;
    double lengths = length * s->length0, x = (lengths + dot) * sine;
    double y = square * s->triple * cosine - length * (x0 * mx + y0 * my + z0 * mz) * sine;
    double yy = y * y, xx = x * x * (mx * mx + my * my + mz * mz), norm = yy + xx;
    double inverse = 1 / (norm * lengths), scale = inverse * lengths, ib = inverse * norm * length;
    double ca = (yy - xx) * (inverse * s->length0), cm = 2 * (x * y) * scale;
    double bx = x0 * ib, by = y0 * ib, bz = z0 * ib;
    /* From b along the arc to c': cos = 1 - v chord^2 / 2. Again one division for two. */
    double dx = ca * ax + cm * mx - bx, dy = ca * ay + cm * my - by, dz = ca * az + cm * mz - bz;
    double chord = dx * dx + dy * dy + dz * dz, part = v * chord, rest = 4 - chord, share = 1 / (rest * s->half);
    double out = sqrt(v * (4 - part) * (s->half * share)), keep = 1 - 0.5 * part + 0.5 * chord * out;
    double wx = keep * bx + out * dx, wy = keep * by + out * dy, wz = keep * bz + out * dz;
    double fix = 1.5 - 0.5 * (wx * wx + wy * wy + wz * wz); /* a Newton step toward unit length */
    int good = s->half > 0;
    double density = good ? 0.5 * (rest * share) : s->half;
    struct drawn d = {good ? wx * fix : 0, good ? wy * fix : 0, good ? wz * fix : 0, density, 0};
    return d;
}

#endif
