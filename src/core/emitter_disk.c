/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The passes over lanes for disks by solid angle: cones, nodes of the sweep, its cosine series, its inversion, directions. Compiled once
 * per instruction set.
 */
#include "core/emitter_disk.h"
#include "core/emitter_lanes.h"

#define CHUNK MCR_DISK_CHUNK

MCR_INLINE void cones(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying,
                      struct mcr_disk_scratch *restrict s)
{
    const double *restrict px = lanes->px, *restrict py = lanes->py, *restrict pz = lanes->pz;
    const uint32_t n = lanes->n;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        const struct flat f = flat_load(varying ? k + i : k, varying ? MCR_EMITTER_BLOCK : 1);
        const struct disk_cone c = disk_cone(&f, px[i], py[i], pz[i]);
        s->cone[0][i] = c.zx, s->cone[1][i] = c.zy, s->cone[2][i] = c.zz;
        s->cone[3][i] = c.ax, s->cone[4][i] = c.ay, s->cone[5][i] = c.az;
        s->cone[6][i] = c.bx, s->cone[7][i] = c.by, s->cone[8][i] = c.bz;
        s->cone[9][i] = c.aa, s->cone[10][i] = c.bb;
        s->nodes[i] = c.seen ? c.nodes : -1.0;
    }
}

static void find_cones(const struct mcr_emitter_lanes *lanes, const double *k, int varying, struct mcr_disk_scratch *s)
{
    if (varying)
        cones(lanes, k, 1, s);
    else
        cones(lanes, k, 0, s);
}

static uint32_t list_nodes(const struct mcr_disk_scratch *s, uint32_t n, double nodes, int32_t *restrict list)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < n; i++) {
        list[count] = (int32_t)i;
        count += s->nodes[i] == nodes;
    }
    return count;
}

static void gather_cones(const struct mcr_disk_scratch *from, uint32_t count, const int32_t *restrict list, struct mcr_disk_chunk *to)
{
    for (uint32_t r = 0; r < MCR_DISK_ROWS; r++)
        for (uint32_t j = 0; j < count; j++)
            to->cone[r][j] = from->cone[r][list[j]];
    MCR_LANES
    for (uint32_t j = 0; j < count; j++) {
        to->p[j] = 1 + 0.5 * (to->cone[9][j] + to->cone[10][j]);
        to->q[j] = 0.5 * (to->cone[9][j] - to->cone[10][j]);
    }
}

/* g / (a b) at the nodes (j + 1/2) pi / nodes, and its mean. cosine[i] = cos(2 pi i / 128). */
static void sweep(uint32_t count, uint32_t nodes, const double *cosine, struct mcr_disk_chunk *c)
{
    const double *restrict p = c->p, *restrict q = c->q;
    double *restrict mean = c->mean;
    for (uint32_t i = 0; i < count; i++)
        mean[i] = 0;
    for (uint32_t j = 0; j < nodes; j++) {
        const double at = cosine[(2 * j + 1) * (32 / nodes)];
        double *restrict g = c->g[j];
        MCR_LANES
        for (uint32_t i = 0; i < count; i++) {
            double square = p[i] + q[i] * at;
            g[i] = 1 / (square + sqrt(square));
            mean[i] += g[i];
        }
    }
    const double share = 1.0 / nodes;
    for (uint32_t i = 0; i < count; i++)
        mean[i] *= share;
}

/*
 * Coefficients of the sine series of the sweep: cosine coefficients over k. Nodes are first folded: even ones see the sums, odd ones the
 * differences.
 */
static void series(uint32_t count, uint32_t nodes, const double *cosine, struct mcr_disk_chunk *c)
{
    const uint32_t half = nodes / 2;
    for (uint32_t j = 0; j < half; j++) {
        double *restrict near = c->g[j], *restrict far = c->g[nodes - 1 - j];
        MCR_LANES
        for (uint32_t i = 0; i < count; i++) {
            double sum = near[i] + far[i], difference = near[i] - far[i];
            near[i] = sum;
            far[i] = difference;
        }
    }
    for (uint32_t k = 1; k < nodes; k++) {
        double *restrict out = c->series[k];
        for (uint32_t i = 0; i < count; i++)
            out[i] = 0;
        for (uint32_t j = 0; j < half; j++) {
            const double factor = cosine[k * (2 * j + 1) * (32 / nodes) % 128] * (2.0 / (nodes * k));
            const double *restrict g = c->g[k % 2 ? nodes - 1 - j : j];
            MCR_LANES
            for (uint32_t i = 0; i < count; i++)
                out[i] += factor * g[i];
        }
    }
}

/*
 * Solves mean * phi + sum of series[k] sin(k phi) = target for phi, in whole turns of the disk: phi from 0 to 4 pi. `steps` of Newton's
 * method.
 */
static void invert(uint32_t count, uint32_t nodes, uint32_t steps, const double *restrict u, struct mcr_disk_chunk *c)
{
    double *restrict phi = c->phi, *restrict b1 = c->b1, *restrict b2 = c->b2, *restrict sine = c->sine, *restrict twice = c->twice;
    const double *restrict mean = c->mean, *restrict p = c->p, *restrict q = c->q, *restrict first = c->series[1];
    MCR_LANES
    for (uint32_t i = 0; i < count; i++) {
        double even = 4 * MCR_PI * u[i];
        phi[i] = even - first[i] / mean[i] * mcr_sin(even);
    }
    for (uint32_t step = 0; step < steps; step++) {
        MCR_LANES
        for (uint32_t i = 0; i < count; i++) {
            sine[i] = mcr_sin(phi[i]);
            twice[i] = 2 * mcr_cos(phi[i]);
            b1[i] = b2[i] = 0;
        }
        for (uint32_t k = nodes - 1; k >= 1; k--) { /* Clenshaw */
            const double *restrict a = c->series[k];
            MCR_LANES
            for (uint32_t i = 0; i < count; i++) {
                double b = a[i] + twice[i] * b1[i] - b2[i];
                b2[i] = b1[i];
                b1[i] = b;
            }
        }
        MCR_LANES
        for (uint32_t i = 0; i < count; i++) {
            double square = p[i] + q[i] * (0.5 * twice[i]), excess = mean[i] * (phi[i] - 4 * MCR_PI * u[i]) + sine[i] * b1[i];
            phi[i] -= excess * (square + sqrt(square));
        }
    }
}

static void directions(uint32_t count, const double *restrict v, struct mcr_disk_chunk *c)
{
    const double *restrict phi = c->phi;
    MCR_LANES
    for (uint32_t i = 0; i < count; i++) {
        double turn = 0.5 * phi[i], x = mcr_cos(turn), y = mcr_sin(turn);
        double round = c->cone[9][i] * (x * x) + c->cone[10][i] * (y * y), square = 1 + round; /* s^2 */
        double inverse = 1 / (square + sqrt(square)), sink = v[i] * round * inverse, out = sqrt(v[i] * (2 - sink) * inverse);
        double keep = 1 - sink, ax = out * x, ay = out * y;
        double wx = keep * c->cone[0][i] + ax * c->cone[3][i] + ay * c->cone[6][i];
        double wy = keep * c->cone[1][i] + ax * c->cone[4][i] + ay * c->cone[7][i];
        double wz = keep * c->cone[2][i] + ax * c->cone[5][i] + ay * c->cone[8][i];
        double fix = 1.5 - 0.5 * (wx * wx + wy * wy + wz * wz);
        c->wx[i] = wx * fix, c->wy[i] = wy * fix, c->wz[i] = wz * fix;
    }
}

/* 1 / solid angle; the mean is of g / (a b), over p from 0 to 2 pi. */
static void tell_density(uint32_t count, struct mcr_disk_chunk *c)
{
    MCR_LANES
    for (uint32_t i = 0; i < count; i++)
        c->density[i] = 1 / (2 * MCR_PI * sqrt(c->cone[9][i] * c->cone[10][i]) * c->mean[i]);
}

/* Newton steps that bring the sweep to a rounding; measured in tests/core/emitters_measure.c. */
static uint32_t steps_of(uint32_t nodes)
{
    return nodes == 8 ? 2 : nodes == 16 ? 3 : 4;
}

void MCR_ISA_NAME(mcr_emitter_disk_draw)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *lanes, const double *k,
                                         int varying, struct mcr_disk_scratch *s)
{
    struct mcr_disk_chunk *c = &s->chunk;
    find_cones(lanes, k, varying, s);
    for (uint32_t i = 0; i < lanes->n; i++) {
        lanes->wx[i] = lanes->wy[i] = lanes->wz[i] = lanes->distance[i] = 0;
        lanes->density[i] = s->nodes[i] < 0 ? 0 : NOT_STEADY;
    }
    for (uint32_t nodes = 8; nodes <= 32; nodes *= 2) {
        uint32_t listed = list_nodes(s, lanes->n, nodes, s->list);
        for (uint32_t first = 0; first < listed; first += CHUNK) {
            const int32_t *list = s->list + first;
            uint32_t count = listed - first < CHUNK ? listed - first : CHUNK;
            gather_cones(s, count, list, c);
            for (uint32_t j = 0; j < count; j++) {
                c->u[j] = lanes->u[list[j]];
                c->v[j] = lanes->v[list[j]];
            }
            sweep(count, nodes, all->cosine, c);
            tell_density(count, c);
            series(count, nodes, all->cosine, c);
            invert(count, nodes, steps_of(nodes), c->u, c);
            directions(count, c->v, c);
            for (uint32_t j = 0; j < count; j++) {
                int32_t i = list[j];
                lanes->wx[i] = c->wx[j], lanes->wy[i] = c->wy[j], lanes->wz[i] = c->wz[j], lanes->density[i] = c->density[j];
            }
        }
    }
}

MCR_INLINE void area_densities(const struct mcr_emitter_lanes *lanes, const double *restrict k, const int varying)
{
    const double *restrict px = lanes->px, *restrict py = lanes->py, *restrict pz = lanes->pz;
    const double *restrict wx = lanes->wx, *restrict wy = lanes->wy, *restrict wz = lanes->wz;
    double *restrict density = lanes->density;
    const uint32_t n = lanes->n;
    MCR_LANES
    for (uint32_t i = 0; i < n; i++) {
        const struct flat f = flat_load(varying ? k + i : k, varying ? MCR_EMITTER_BLOCK : 1);
        density[i] = flat_area_density(&f, px[i], py[i], pz[i], wx[i], wy[i], wz[i]);
    }
}

void MCR_ISA_NAME(mcr_emitter_disk_density)(const struct mcr_emitters *all, const struct mcr_emitter_lanes *lanes, const double *k,
                                            int varying, struct mcr_disk_scratch *s)
{
    struct mcr_disk_chunk *c = &s->chunk;
    find_cones(lanes, k, varying, s);
    if (varying)
        area_densities(lanes, k, 1);
    else
        area_densities(lanes, k, 0);
    for (uint32_t nodes = 8; nodes <= 32; nodes *= 2) {
        uint32_t listed = list_nodes(s, lanes->n, nodes, s->list);
        for (uint32_t first = 0; first < listed; first += CHUNK) {
            const int32_t *list = s->list + first;
            uint32_t count = listed - first < CHUNK ? listed - first : CHUNK;
            gather_cones(s, count, list, c);
            sweep(count, nodes, all->cosine, c);
            tell_density(count, c);
            for (uint32_t j = 0; j < count; j++)
                lanes->density[list[j]] = c->density[j];
        }
    }
}
