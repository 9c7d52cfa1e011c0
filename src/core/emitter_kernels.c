/* SPDX-License-Identifier: Apache-2.0 */
/* The loops over lanes of what emitter_flat.h and emitter_round.h compute for one. Compiled once per instruction set. */
#include "core/emitter_flat.h"
#include "core/emitter_lanes.h"
#include "core/emitter_round.h"

/* The arrays of lanes, told to be apart. */
#define ARRAYS(l)                                                                                                                \
    const double *restrict px = (l)->px, *restrict py = (l)->py, *restrict pz = (l)->pz;                                       \
    const uint32_t n = (l)->n
#define DIRECTIONS(l) const double *restrict wx = (l)->wx, *restrict wy = (l)->wy, *restrict wz = (l)->wz

/* Calls `loop` with the kind as a constant, so that each kind has a loop of its own. */
#define BY_FLAT_KIND(kind, loop, ...)                                   \
    switch (kind) {                                                     \
    case MCR_EMITTER_PARALLELOGRAM:                                     \
        loop(MCR_EMITTER_PARALLELOGRAM, __VA_ARGS__);                   \
        break;                                                          \
    case MCR_EMITTER_TRIANGLE:                                          \
        loop(MCR_EMITTER_TRIANGLE, __VA_ARGS__);                        \
        break;                                                          \
    default:                                                            \
        loop(MCR_EMITTER_DISK, __VA_ARGS__);                            \
        break;                                                          \
    }

/* The lane's constants: loads that leave the loop, or one load a lane. */
#define CONSTANTS(load) load(varying ? k + i : k, varying ? MCR_EMITTER_BLOCK : 1)

/* Calls `loop` with `varying` as a constant. */
#define BY_VARYING(loop, ...)          \
    do {                               \
        if (varying)                   \
            loop(__VA_ARGS__, k, 1);   \
        else                           \
            loop(__VA_ARGS__, k, 0);   \
    } while (0)

/* ---- crossing ---------------------------------------------------------------------------------------------------- */

MCR_INLINE void cross_flat(uint32_t kind, const double *k, const struct mcr_emitter_lanes *lanes, double *restrict flag)
{
    ARRAYS(lanes);
    DIRECTIONS(lanes);
    const struct flat f = flat_load(k, 1);
    const double dual[6] = {k[MCR_K_DUAL0], k[MCR_K_DUAL0 + 1], k[MCR_K_DUAL0 + 2], k[MCR_K_DUAL1], k[MCR_K_DUAL1 + 1], k[MCR_K_DUAL1 + 2]};
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        flag[i] = flat_crossed(kind, &f, dual, px[i], py[i], pz[i], wx[i], wy[i], wz[i]) ? 1.0 : 0.0;
}

static void cross_ball(const double *k, const struct mcr_emitter_lanes *lanes, double *restrict flag)
{
    ARRAYS(lanes);
    DIRECTIONS(lanes);
    const struct ball s = ball_load(k, 1);
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        flag[i] = ball_crossed(&s, px[i], py[i], pz[i], wx[i], wy[i], wz[i]) ? 1.0 : 0.0;
}

static void cross_egg(const double *k, const struct mcr_emitter_lanes *lanes, double *restrict flag)
{
    ARRAYS(lanes);
    DIRECTIONS(lanes);
    const struct egg s = egg_load(k, 1);
    MCR_LANES
    for (uint32_t i = 0; i < n; i++)
        flag[i] = egg_crossed(&s, px[i], py[i], pz[i], wx[i], wy[i], wz[i]) ? 1.0 : 0.0;
}

void MCR_ISA_NAME(mcr_emitter_cross)(const struct mcr_emitters *all, uint32_t e, const struct mcr_emitter_lanes *lanes, double *flag)
{
    uint32_t kind = all->emitter[e].kind;
    if (kind == MCR_EMITTER_SPHERE)
        cross_ball(all->k[e], lanes, flag);
    else if (kind == MCR_EMITTER_ELLIPSOID)
        cross_egg(all->k[e], lanes, flag);
    else
        BY_FLAT_KIND(kind, cross_flat, all->k[e], lanes, flag)
}

#define CROSS_EACH_LOOP(load, shape, ...)                                     \
    do {                                                                      \
        ARRAYS(lanes);                                                        \
        DIRECTIONS(lanes);                                                    \
        MCR_LANES                                                             \
        for (uint32_t i = 0; i < n; i++) {                                    \
            const struct shape s = load(k + i, MCR_EMITTER_BLOCK);            \
            flag[i] = __VA_ARGS__ ? 1.0 : 0.0;                                \
        }                                                                     \
    } while (0)

MCR_INLINE int crossed_with_duals(uint32_t kind, const struct flat *f, const double *restrict k, double px, double py, double pz, double dx,
                                  double dy, double dz)
{
    const double dual[6] = {k[MCR_K_DUAL0 * MCR_EMITTER_BLOCK],       k[(MCR_K_DUAL0 + 1) * MCR_EMITTER_BLOCK],
                            k[(MCR_K_DUAL0 + 2) * MCR_EMITTER_BLOCK], k[MCR_K_DUAL1 * MCR_EMITTER_BLOCK],
                            k[(MCR_K_DUAL1 + 1) * MCR_EMITTER_BLOCK], k[(MCR_K_DUAL1 + 2) * MCR_EMITTER_BLOCK]};
    return flat_crossed(kind, f, dual, px, py, pz, dx, dy, dz);
}

MCR_INLINE void cross_flat_each(uint32_t kind, const struct mcr_emitter_lanes *lanes, const double *restrict k, double *restrict flag)
{
    CROSS_EACH_LOOP(flat_load, flat, crossed_with_duals(kind, &s, k + i, px[i], py[i], pz[i], wx[i], wy[i], wz[i]));
}

static void cross_ball_each(const struct mcr_emitter_lanes *lanes, const double *restrict k, double *restrict flag)
{
    CROSS_EACH_LOOP(ball_load, ball, ball_crossed(&s, px[i], py[i], pz[i], wx[i], wy[i], wz[i]));
}

static void cross_egg_each(const struct mcr_emitter_lanes *lanes, const double *restrict k, double *restrict flag)
{
    CROSS_EACH_LOOP(egg_load, egg, egg_crossed(&s, px[i], py[i], pz[i], wx[i], wy[i], wz[i]));
}

void MCR_ISA_NAME(mcr_emitter_cross_each)(uint32_t kind, const struct mcr_emitter_lanes *lanes, const double *k, double *flag)
{
    if (kind == MCR_EMITTER_SPHERE)
        cross_ball_each(lanes, k, flag);
    else if (kind == MCR_EMITTER_ELLIPSOID)
        cross_egg_each(lanes, k, flag);
    else
        BY_FLAT_KIND(kind, cross_flat_each, lanes, k, flag)
}

/* ---- seen or not -------------------------------------------------------------------------------------------------- */

void MCR_ISA_NAME(mcr_emitter_seen)(const struct mcr_emitters *all, uint32_t e, const struct mcr_emitter_lanes *lanes)
{
    ARRAYS(lanes);
    const double *k = all->k[e];
    double *restrict seen = lanes->distance;
    const double above = k[MCR_K_ABOVE], below = k[MCR_K_BELOW];
    if (all->emitter[e].kind == MCR_EMITTER_SPHERE) {
        const struct ball s = ball_load(k, 1);
        MCR_LANES
        for (uint32_t i = 0; i < n; i++) {
            double height = ball_height(&s, px[i], py[i], pz[i]);
            seen[i] = ((height > above) | (height < below)) ? 1.0 : 0.0;
        }
    } else if (all->emitter[e].kind == MCR_EMITTER_ELLIPSOID) {
        const struct egg s = egg_load(k, 1);
        MCR_LANES
        for (uint32_t i = 0; i < n; i++) {
            double height = egg_ray(&s, px[i], py[i], pz[i], 0, 0, 0).height;
            seen[i] = ((height > above) | (height < below)) ? 1.0 : 0.0;
        }
    } else {
        const struct flat f = flat_load(k, 1);
        MCR_LANES
        for (uint32_t i = 0; i < n; i++) {
            double height = flat_height(&f, px[i], py[i], pz[i]);
            seen[i] = ((height > above) | (height < below)) ? 1.0 : 0.0;
        }
    }
}

/* ---- densities ---------------------------------------------------------------------------------------------------- */

#define DENSITY_LOOP(load, shape, ...)                  \
    do {                                                \
        ARRAYS(lanes);                                  \
        DIRECTIONS(lanes);                              \
        double *restrict density = lanes->density;      \
        MCR_LANES                                       \
        for (uint32_t i = 0; i < n; i++) {              \
            const struct shape s = CONSTANTS(load);     \
            density[i] = __VA_ARGS__;                   \
        }                                               \
    } while (0)
#define RAY px[i], py[i], pz[i], wx[i], wy[i], wz[i]

MCR_INLINE void density_flat_area(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    DENSITY_LOOP(flat_load, flat, flat_area_density(&s, RAY));
}

MCR_INLINE void density_flat_solid(uint32_t kind, const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    DENSITY_LOOP(flat_load, flat, flat_solid_density(kind, &s, RAY));
}

MCR_INLINE void density_ball_area(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    DENSITY_LOOP(ball_load, ball, ball_area_density(&s, RAY));
}

MCR_INLINE void density_ball_solid(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    DENSITY_LOOP(ball_load, ball, ball_solid_density(&s, RAY));
}

MCR_INLINE void density_ball_solid_alone(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    const double *restrict distance = lanes->distance;
    DENSITY_LOOP(ball_load, ball, ball_solid_point_density(&s, RAY, distance[i]));
}

MCR_INLINE void density_egg_area(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    DENSITY_LOOP(egg_load, egg, egg_area_density(&s, RAY));
}

MCR_INLINE void density_ball_alone(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    const double *restrict distance = lanes->distance;
    DENSITY_LOOP(ball_load, ball, ball_point_density(&s, RAY, distance[i]));
}

MCR_INLINE void density_egg_alone(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    const double *restrict distance = lanes->distance;
    DENSITY_LOOP(egg_load, egg, egg_point_density(&s, RAY, distance[i]));
}

/* By solid angle, but from inside a sphere by area: there a ray has one crossing, so that its density is that of the point alone. */
static void density_ball(uint32_t by, int alone, const struct mcr_emitter_lanes *lanes, const double *k, int varying)
{
    if (by == MCR_LIGHT_BY_SOLID_ANGLE && alone)
        BY_VARYING(density_ball_solid_alone, lanes);
    else if (by == MCR_LIGHT_BY_SOLID_ANGLE)
        BY_VARYING(density_ball_solid, lanes);
    else if (alone)
        BY_VARYING(density_ball_alone, lanes);
    else
        BY_VARYING(density_ball_area, lanes);
}

static void density_egg(int alone, const struct mcr_emitter_lanes *lanes, const double *k, int varying)
{
    if (alone)
        BY_VARYING(density_egg_alone, lanes);
    else
        BY_VARYING(density_egg_area, lanes);
}

void MCR_ISA_NAME(mcr_emitter_density)(const struct mcr_emitters *all, uint32_t kind, uint32_t by, int alone,
                                       const struct mcr_emitter_lanes *lanes,
                                       const double *k, int varying, struct mcr_solid_scratch *scratch)
{
    if (kind == MCR_EMITTER_SPHERE)
        density_ball(by, alone, lanes, k, varying);
    else if (kind == MCR_EMITTER_ELLIPSOID)
        density_egg(alone, lanes, k, varying);
    else if (by == MCR_LIGHT_BY_AREA)
        BY_VARYING(density_flat_area, lanes);
    else if (kind == MCR_EMITTER_DISK)
        MCR_ISA_NAME(mcr_emitter_disk_density)(all, lanes, k, varying, &scratch->disk);
    else if (kind == MCR_EMITTER_TRIANGLE)
        BY_VARYING(density_flat_solid, MCR_EMITTER_TRIANGLE, lanes);
    else
        BY_VARYING(density_flat_solid, MCR_EMITTER_PARALLELOGRAM, lanes);
}

/* ---- distances ---------------------------------------------------------------------------------------------------- */

#define DISTANCE_LOOP(load, shape, ...)                 \
    do {                                                \
        ARRAYS(lanes);                                  \
        DIRECTIONS(lanes);                              \
        double *restrict distance = lanes->distance;    \
        MCR_LANES                                       \
        for (uint32_t i = 0; i < n; i++) {              \
            const struct shape s = CONSTANTS(load);     \
            distance[i] = __VA_ARGS__;                  \
        }                                               \
    } while (0)

MCR_INLINE void distance_flat(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    DISTANCE_LOOP(flat_load, flat, flat_distance(&s, RAY));
}

MCR_INLINE void distance_ball(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    DISTANCE_LOOP(ball_load, ball, ball_distance(&s, RAY));
}

void MCR_ISA_NAME(mcr_emitter_distance)(uint32_t kind, const struct mcr_emitter_lanes *lanes, const double *k, int varying)
{
    if (kind == MCR_EMITTER_SPHERE)
        BY_VARYING(distance_ball, lanes);
    else
        BY_VARYING(distance_flat, lanes);
}

/* ---- drawing ------------------------------------------------------------------------------------------------------ */

#define DRAW_LOOP(load, shape, ...)                                                                                         \
    do {                                                                                                                    \
        ARRAYS(lanes);                                                                                                      \
        const double *restrict u = lanes->u, *restrict v = lanes->v;                                                        \
        double *restrict wx = lanes->wx, *restrict wy = lanes->wy, *restrict wz = lanes->wz;                                 \
        double *restrict density = lanes->density, *restrict distance = lanes->distance;                                    \
        MCR_LANES                                                                                                           \
        for (uint32_t i = 0; i < n; i++) {                                                                                  \
            const struct shape s = CONSTANTS(load);                                                                         \
            const struct drawn d = __VA_ARGS__;                                                                             \
            wx[i] = d.x, wy[i] = d.y, wz[i] = d.z, density[i] = d.density, distance[i] = d.distance;                        \
        }                                                                                                                   \
    } while (0)
#define NUMBERS px[i], py[i], pz[i], u[i], v[i]

MCR_INLINE void draw_flat_area(uint32_t kind, const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    DRAW_LOOP(flat_load, flat, flat_draw_area(kind, &s, NUMBERS));
}

/* The members of struct sweep in rows. */
#define SWEEP_OUT(row, s)                                                                                                      \
    (row)[0][i] = (s).length0, (row)[1][i] = (s).length1, (row)[2][i] = (s).length2, (row)[3][i] = (s).d01,                     \
    (row)[4][i] = (s).d02, (row)[5][i] = (s).triple, (row)[6][i] = (s).first, (row)[7][i] = (s).re, (row)[8][i] = (s).im,       \
    (row)[11][i] = (s).half
#define SWEEP_IN(row)                                                                                                          \
    {(row)[0][i], (row)[1][i], (row)[2][i], (row)[3][i], (row)[4][i],  (row)[5][i],                                             \
     (row)[6][i], (row)[7][i], (row)[8][i], (row)[9][i], (row)[10][i], (row)[11][i]}

MCR_INLINE void draw_flat_solid(uint32_t kind, mcr_emitter_row *restrict row, const struct mcr_emitter_lanes *lanes,
                                const double *restrict k, const int varying)
{
    ARRAYS(lanes);
    const double *restrict u = lanes->u, *restrict v = lanes->v;
    double *restrict wx = lanes->wx, *restrict wy = lanes->wy, *restrict wz = lanes->wz;
    double *restrict density = lanes->density, *restrict distance = lanes->distance;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        const struct flat f = CONSTANTS(flat_load);
        const struct sweep s = flat_draw_open(kind, &f, px[i], py[i], pz[i]);
        SWEEP_OUT(row, s);
    }
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        struct sweep s = SWEEP_IN(row);
        flat_draw_angle(&s, u[i]);
        row[9][i] = s.sine, row[10][i] = s.cosine, row[11][i] = s.half;
    }
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        const struct flat f = CONSTANTS(flat_load);
        const struct sweep s = SWEEP_IN(row);
        const struct drawn d = flat_draw_sweep(kind, &f, &s, px[i], py[i], pz[i], v[i]);
        wx[i] = d.x, wy[i] = d.y, wz[i] = d.z, density[i] = d.density, distance[i] = d.distance;
    }
}

MCR_INLINE void draw_ball_area(int alone, const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    DRAW_LOOP(ball_load, ball, ball_draw_area(&s, alone, NUMBERS));
}

MCR_INLINE void draw_ball_solid(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    DRAW_LOOP(ball_load, ball, ball_draw_solid(&s, NUMBERS));
}

MCR_INLINE void draw_egg_area(int alone, const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    DRAW_LOOP(egg_load, egg, egg_draw_area(&s, alone, NUMBERS));
}

static void draw_round(uint32_t kind, uint32_t by, int alone, const struct mcr_emitter_lanes *lanes, const double *k, int varying)
{
    if (kind == MCR_EMITTER_ELLIPSOID && alone)
        BY_VARYING(draw_egg_area, 1, lanes);
    else if (kind == MCR_EMITTER_ELLIPSOID)
        BY_VARYING(draw_egg_area, 0, lanes);
    else if (by == MCR_LIGHT_BY_SOLID_ANGLE)
        BY_VARYING(draw_ball_solid, lanes);
    else if (alone)
        BY_VARYING(draw_ball_area, 1, lanes);
    else
        BY_VARYING(draw_ball_area, 0, lanes);
}

static void draw_flat(uint32_t kind, uint32_t by, const struct mcr_emitter_lanes *lanes, const double *k, int varying, mcr_emitter_row *row)
{
    if (kind == MCR_EMITTER_DISK)
        BY_VARYING(draw_flat_area, MCR_EMITTER_DISK, lanes); /* by area */
    else if (kind == MCR_EMITTER_TRIANGLE && by == MCR_LIGHT_BY_AREA)
        BY_VARYING(draw_flat_area, MCR_EMITTER_TRIANGLE, lanes);
    else if (kind == MCR_EMITTER_TRIANGLE)
        BY_VARYING(draw_flat_solid, MCR_EMITTER_TRIANGLE, row, lanes);
    else if (by == MCR_LIGHT_BY_AREA)
        BY_VARYING(draw_flat_area, MCR_EMITTER_PARALLELOGRAM, lanes);
    else
        BY_VARYING(draw_flat_solid, MCR_EMITTER_PARALLELOGRAM, row, lanes);
}

void MCR_ISA_NAME(mcr_emitter_draw)(const struct mcr_emitters *all, uint32_t kind, uint32_t by, int alone,
                                    const struct mcr_emitter_lanes *lanes, const double *k, int varying, struct mcr_solid_scratch *scratch)
{
    if (kind == MCR_EMITTER_DISK && by == MCR_LIGHT_BY_SOLID_ANGLE)
        MCR_ISA_NAME(mcr_emitter_disk_draw)(all, lanes, k, varying, &scratch->disk);
    else if (kind == MCR_EMITTER_SPHERE || kind == MCR_EMITTER_ELLIPSOID)
        draw_round(kind, by, alone, lanes, k, varying);
    else
        draw_flat(kind, by, lanes, k, varying, scratch->sweep);
}
