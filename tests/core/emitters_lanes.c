/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The light services give the same bits for every instruction set and however lanes are grouped into batches; draws of points agree with
 * their densities; nothing is written beyond the lanes; extreme points give no NaN.
 */
#include "emitters_scene.h"

#include "core/emitter_lanes.h"

#define LANES 1000u /* no multiple of a block */
#define RESULTS 13u

static void make_stage(struct stage *s, uint32_t many)
{
    const double e0[3] = {0.3, 0.02, 0}, e1[3] = {0, 0.3, 0.05}, axes[3][3] = {{0.1, 0, 0}, {0, 0.2, 0}, {0, 0.05, 0.1}};
    stage_begin(s);
    for (uint32_t i = 0; i < many; i++) {
        double c[3] = {-0.4 + 0.06 * i, 0.1 * (i % 3), 0.6 - 0.03 * i};
        uint32_t sides = i % 3 ? FRONT | BACK : i % 2 ? BACK : FRONT;
        if (i % 5 < 2)
            stage_flat(s, i % 5 ? MCR_SHAPE_PARALLELOGRAM : MCR_SHAPE_DISK, sides, 1 + i, c, e0, e1);
        else if (i % 5 == 2)
            stage_sphere(s, sides, 1, c, 0.1);
        else
            stage_axes(s, i % 5 == 3 ? MCR_SHAPE_ELLIPSOID : MCR_SHAPE_BOX, sides, 2, c, axes);
    }
    stage_triangle(s, FRONT | BACK, 1, (const double[3]){0, 0, 0.2}, (const double[3]){0.2, 0, 0.25}, (const double[3]){0, 0.3, 0.2});
    stage_ready(s);
}

/* Everything that the services tell about lanes first .. first+n-1, into out[k][first + i]. */
static void run(const struct stage *s, const struct mcr_emitter_functions *f, uint32_t by, const struct batch *b, uint32_t first,
                uint32_t n, double *out[RESULTS])
{
    struct batch part;
    double *q[8];
    int32_t *emitter = aligned_alloc(64, (n + 8) * sizeof *emitter / 64 * 64 + 64);
    batch_begin(&part, n);
    for (uint32_t k = 0; k < 8; k++)
        q[k] = doubles(n);
    memcpy(part.px, b->px + first, n * sizeof(double));
    memcpy(part.py, b->py + first, n * sizeof(double));
    memcpy(part.pz, b->pz + first, n * sizeof(double));
    for (int k = 0; k < 3; k++)
        memcpy(part.u[k], b->u[k] + first, n * sizeof(double));
    if (b->at.nx) {
        memcpy(part.nx, b->nx + first, n * sizeof(double));
        memcpy(part.ny, b->ny + first, n * sizeof(double));
        memcpy(part.nz, b->nz + first, n * sizeof(double));
        batch_normals(&part);
    }
    batch_draw(&part, s, f, by);
    const double *drawn[] = {part.x, part.y, part.z, part.density};
    for (uint32_t k = 0; k < 4; k++)
        memcpy(out[k] + first, drawn[k], n * sizeof(double));
    /* densities of directions that were drawn for another point: the next lane's */
    memmove(part.x, part.x + 1, (n - 1) * sizeof(double));
    for (uint32_t i = 0; i < n; i++) {
        part.x[i] = b->x[first + i];
        part.y[i] = b->y[first + i];
        part.z[i] = b->z[first + i];
    }
    batch_density(&part, s, f, by, out[4] + first);
    f->mass(s->emitters, s->scratch, by, &part.at, out[5] + first);
    struct mcr_emitter_points points = {sizeof points, n, emitter, q[0], q[1], q[2], q[3], q[4], q[5], q[6]};
    f->draw_point(s->emitters, s->scratch, by, &part.at, (const double *const *)part.u, &points, q[7]);
    f->density_point(s->emitters, s->scratch, by, &part.at, &points, out[6] + first);
    memcpy(out[7] + first, q[7], n * sizeof(double));
    for (uint32_t i = 0; i < n; i++)
        out[8][first + i] = emitter[i];
    memcpy(out[9] + first, q[0], n * sizeof(double));
    memcpy(out[10] + first, q[2], n * sizeof(double));
    memcpy(out[11] + first, q[4], n * sizeof(double));
    memcpy(out[12] + first, q[6], n * sizeof(double));
    for (uint32_t k = 0; k < 8; k++)
        free(q[k]);
    free(emitter);
    batch_end(&part);
}

static void make_points(struct batch *b)
{
    for (uint32_t i = 0; i < b->n; i++) {
        double z = 2 * mcr_number(i, 11) - 1, angle = 2 * MCR_PI * mcr_number(i, 12);
        b->px[i] = 2 * mcr_number(i, 13) - 1;
        b->py[i] = 2 * mcr_number(i, 14) - 1;
        b->pz[i] = 2 * mcr_number(i, 15) - 1;
        b->x[i] = sqrt(1 - z * z) * cos(angle);
        b->y[i] = sqrt(1 - z * z) * sin(angle);
        b->z[i] = z;
        b->nx[i] = i % 17 ? b->y[i] : 0; /* some without a normal */
        b->ny[i] = i % 17 ? z : 0;
        b->nz[i] = i % 17 ? b->x[i] : 0;
    }
    batch_numbers(b, 3);
}

static uint64_t different(double *const a[RESULTS], double *const b[RESULTS], uint32_t n)
{
    uint64_t count = 0;
    for (uint32_t k = 0; k < RESULTS; k++)
        for (uint32_t i = 0; i < n; i++)
            count += mcr_bits(a[k][i]) != mcr_bits(b[k][i]);
    return count;
}

static void test_bits(uint32_t many, int normals)
{
    struct stage s;
    struct batch b;
    double *reference[RESULTS], *other[RESULTS];
    make_stage(&s, many);
    batch_begin(&b, LANES);
    make_points(&b);
    if (normals)
        batch_normals(&b);
    for (uint32_t k = 0; k < RESULTS; k++) {
        reference[k] = doubles(LANES);
        other[k] = doubles(LANES);
    }
    for (uint32_t by = 0; by <= 1; by++) {
        run(&s, functions_of(0), by, &b, 0, LANES, reference);
        for (uint32_t isa = 0; isa <= 2; isa++) {
            static const uint32_t pieces[] = {1000, 128, 7, 1};
            if (!functions_of(isa)) {
                tap_skip("the same bits", "this processor lacks the instruction set");
                continue;
            }
            for (size_t k = 0; k < sizeof pieces / sizeof *pieces; k++) {
                for (uint32_t first = 0; first < LANES; first += pieces[k])
                    run(&s, functions_of(isa), by, &b, first, LANES - first < pieces[k] ? LANES - first : pieces[k], other);
                uint64_t count = different(reference, other, LANES);
                ok(count == 0, "%u emitters, %s normals, by %s: the same bits with isa %u in pieces of %u (%llu differ)", s.emitters->count,
                   normals ? "with" : "without", by ? "solid angle" : "area", isa, pieces[k], (unsigned long long)count);
            }
        }
    }
    for (uint32_t k = 0; k < RESULTS; k++) {
        free(reference[k]);
        free(other[k]);
    }
    batch_end(&b);
    stage_end(&s);
}

/* draw_point: the point is where its direction and distance say, on the emitter that is told, and its density is that of density_point. */
static void test_points(uint32_t many)
{
    const struct mcr_emitter_functions *f = best_functions();
    struct stage s;
    struct batch b;
    double *q[8], *again = doubles(LANES);
    int32_t *emitter = aligned_alloc(64, 64 * 1024);
    make_stage(&s, many);
    batch_begin(&b, LANES);
    make_points(&b);
    for (uint32_t k = 0; k < 8; k++)
        q[k] = doubles(LANES);
    for (uint32_t by = 0; by <= 1; by++) {
        struct mcr_emitter_points points = {sizeof points, LANES, emitter, q[0], q[1], q[2], q[3], q[4], q[5], q[6]};
        double worst = 0, apart = 0;
        uint32_t wrong = 0, drawn = 0;
        f->draw_point(s.emitters, s.scratch, by, &b.at, (const double *const *)b.u, &points, q[7]);
        f->density_point(s.emitters, s.scratch, by, &b.at, &points, again);
        for (uint32_t i = 0; i < LANES; i++) {
            if (emitter[i] < 0) {
                wrong += q[7][i] != 0 || again[i] != 0 || q[3][i] != 0 || q[4][i] != 0 || q[5][i] != 0;
                continue;
            }
            drawn++;
            wrong += emitter[i] >= (int32_t)s.emitters->count || !(q[7][i] > 0);
            worst = fmax(worst, fabs(again[i] / q[7][i] - 1));
            apart = fmax(apart, fabs(b.px[i] + q[6][i] * q[3][i] - q[0][i]) + fabs(b.py[i] + q[6][i] * q[4][i] - q[1][i]) +
                                    fabs(b.pz[i] + q[6][i] * q[5][i] - q[2][i]));
            const struct mcr_emitter *e = &s.emitters->emitter[emitter[i]];
            const double *k = s.emitters->k[emitter[i]];
            double at[3] = {q[0][i] - k[0], q[1][i] - k[1], q[2][i] - k[2]}, off;
            if (e->kind == MCR_EMITTER_SPHERE)
                off = sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]) / k[MCR_K_RADIUS] - 1;
            else if (e->kind == MCR_EMITTER_ELLIPSOID)
                off = 0;
            else
                off = at[0] * k[MCR_K_N] + at[1] * k[MCR_K_N + 1] + at[2] * k[MCR_K_N + 2];
            wrong += !(fabs(off) < 1e-10);
        }
        ok(wrong == 0 && drawn > LANES / 4, "%u emitters, by %u: points lie on the emitters they name (%u of %u wrong)", s.emitters->count,
           by, wrong, drawn);
        ok(worst < 1e-6 && apart < 1e-14, "%u emitters, by %u: drawn points have the density that density_point tells (%.1e)",
           s.emitters->count, by, worst);
    }
    for (uint32_t k = 0; k < 8; k++)
        free(q[k]);
    free(again);
    free(emitter);
    batch_end(&b);
    stage_end(&s);
}

/* The tree of many emitters leads rays to those that they cross: the densities are those of asking all, and draws tell them. */
static void test_tree(uint32_t many)
{
    const struct mcr_emitter_functions *f = best_functions();
    struct stage s;
    struct batch b;
    double *all = doubles(LANES), worst = 0, worst_drawn = 0;
    uint32_t crossed = 0, wrong = 0;
    make_stage(&s, many);
    batch_begin(&b, LANES);
    for (uint32_t round = 0; round < 20; round++) {
        struct mcr_emitter_node *node = s.emitters->node;
        make_points(&b);
        if (round % 2)
            batch_normals(&b);
        for (uint32_t i = 0; i < LANES; i++) {
            b.pz[i] += 0.01 * round;
            b.x[i] = i % 50 ? b.x[i] : 0, b.y[i] = i % 100 ? b.y[i] : 0; /* along axes, and not unit: as well */
        }
        for (int drawn = 0; drawn <= 1; drawn++) {
            double *told = doubles(LANES);
            if (drawn)
                batch_draw(&b, &s, f, MCR_LIGHT_BY_SOLID_ANGLE);
            memcpy(told, b.density, LANES * sizeof *told);
            batch_density(&b, &s, f, MCR_LIGHT_BY_SOLID_ANGLE, b.density);
            s.emitters->node = NULL;
            batch_density(&b, &s, f, MCR_LIGHT_BY_SOLID_ANGLE, all);
            s.emitters->node = node;
            for (uint32_t i = 0; i < LANES; i++) {
                crossed += all[i] > 0;
                wrong += (all[i] > 0) != (b.density[i] > 0);
                worst = fmax(worst, all[i] > 0 ? fabs(b.density[i] / all[i] - 1) : 0);
                worst_drawn = fmax(worst_drawn, drawn && told[i] > 0 && all[i] > 0 ? fabs(told[i] / all[i] - 1) : 0);
            }
            free(told);
        }
    }
    ok(s.emitters->node && wrong == 0 && crossed > LANES && worst < 1e-13,
       "%u emitters: the tree misses none (%u of %u lanes cross, %u wrong, %.1e)",
       s.emitters->count, crossed, 40 * LANES, wrong, worst);
    ok(worst_drawn < 1e-6, "%u emitters: draws tell the density (%.1e)", s.emitters->count, worst_drawn); /* at the limbs of ellipsoids */
    free(all);
    batch_end(&b);
    stage_end(&s);
}

/* Points in the plane, on edges and corners, at centres, far away; numbers 0 and just below 1: finite, and nothing beyond the lanes. */
static void test_extremes(void)
{
    static const double special[] = {0, 0.3, 0.6, 0.1, 0.02, 0.32, 1e-9, 1e-300, 1e9, -1e9, 0.35, 0.65};
    const uint32_t count = sizeof special / sizeof *special, lanes = count * count * count;
    const struct mcr_emitter_functions *f = best_functions();
    struct stage s;
    struct batch b;
    uint32_t bad = 0, touched = 0;
    make_stage(&s, 7);
    batch_begin(&b, lanes);
    for (uint32_t i = 0; i < lanes; i++) {
        b.px[i] = special[i % count];
        b.py[i] = special[i / count % count];
        b.pz[i] = special[i / count / count];
        b.u[0][i] = mcr_number(i, 1);
        b.u[1][i] = i % 3 == 0 ? 0 : i % 3 == 1 ? 1 - 0x1p-53 : 0.5;
        b.u[2][i] = i % 5 == 0 ? 0 : i % 5 == 1 ? 1 - 0x1p-53 : 0.5;
    }
    for (uint32_t by = 0; by <= 1; by++) {
        double mark = b.density[lanes] = b.x[lanes] = 12345;
        batch_draw(&b, &s, f, by);
        touched += b.density[lanes] != mark || b.x[lanes] != mark;
        for (uint32_t i = 0; i < lanes; i++) {
            double square = b.x[i] * b.x[i] + b.y[i] * b.y[i] + b.z[i] * b.z[i];
            bad += !(b.density[i] >= 0 && b.density[i] < INFINITY) || !(square == 0 ? b.density[i] == 0 : fabs(square - 1) < 1e-12);
        }
        batch_density(&b, &s, f, by, b.density);
        for (uint32_t i = 0; i < lanes; i++)
            bad += !(b.density[i] >= 0 && b.density[i] < INFINITY);
    }
    ok(bad == 0, "extreme points: unit directions or none, finite densities (%u bad)", bad);
    ok(touched == 0, "nothing is written beyond the lanes");
    batch_end(&b);
    stage_end(&s);
}

static void test_table(void)
{
    const double c[3] = {0, 0, 0.5}, e0[3] = {0.1, 0, 0}, e1[3] = {0, 0.2, 0}, axes[3][3] = {{0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}};
    struct stage s;
    stage_begin(&s);
    stage_shape(&s, MCR_SHAPE_PLANE, FRONT, 1, c);
    stage_flat(&s, MCR_SHAPE_PARALLELOGRAM, 0, 1, c, e0, e1);
    stage_flat(&s, MCR_SHAPE_PARALLELOGRAM, FRONT, 0, c, e0, e1);
    stage_flat(&s, MCR_SHAPE_DISK, FRONT | BACK, 1e30, c, e0, e1);
    stage_axes(&s, MCR_SHAPE_BOX, FRONT, 1e-30, c, axes);
    stage_sphere(&s, BACK, 1e30, c, 0.1);
    stage_ready(&s);
    const struct mcr_emitters *e = s.emitters;
    double disk = 2 * MCR_PI * 0.02, sphere = 4 * MCR_PI * 0.01;
    ok(e->count == 8, "planes, dark sides and radiance 0 are no emitters: %u", e->count);
    uint32_t led = 0; /* more than MCR_EMITTERS_FEW are in the order of their tree */
    for (uint32_t p = 3; p <= 10; p++)
        led += e->of_primitive[p] >= 0 && e->emitter[e->of_primitive[p]].primitive == p;
    ok(e->of_primitive[0] == -1 && e->of_primitive[1] == -1 && e->of_primitive[2] == -1 && led == 8, "primitives lead to their emitters");
    double bright = e->emitter[e->of_primitive[3]].probability, dark = e->emitter[e->of_primitive[6]].probability;
    ok(fabs(bright - disk / (disk + sphere)) < 1e-15 && dark >= 0 && dark < 1e-50,
       "probability in proportion to luminance, area and sides: %.17g", bright);
    double power = MCR_PI * 1e30 * (disk + sphere);
    ok(fabs(mcr_emitters_power(e) / power - 1) < 1e-14, "power of all: %.17g", mcr_emitters_power(e));
    stage_end(&s);

    stage_begin(&s);
    stage_ready(&s);
    ok(mcr_emitters_power(s.emitters) == 0, "no emitters, no power");
    struct batch b;
    batch_begin(&b, 8);
    batch_draw(&b, &s, best_functions(), 1);
    ok(s.emitters->count == 0 && b.x[0] == 0 && b.y[0] == 0 && b.z[0] == 0 && b.density[0] == 0, "without emitters nothing is drawn");
    batch_density(&b, &s, best_functions(), 1, b.density);
    ok(b.density[0] == 0, "without emitters the density is 0");
    batch_end(&b);
    stage_end(&s);
}

/* Drawing in wanted lanes alone: the same bits there as in a full draw, nothing elsewhere, and the kept densities serve every lane. */
static void test_wanted(uint32_t many, uint32_t by, double share)
{
    const struct mcr_emitter_functions *f = best_functions();
    struct stage s;
    struct batch full, some;
    double *wanted = doubles(LANES), *plain = doubles(LANES), *kept = doubles(LANES);
    uint64_t drawn = 0, elsewhere = 0, densities = 0, count = 0;
    make_stage(&s, many);
    batch_begin(&full, LANES);
    batch_begin(&some, LANES);
    make_points(&full);
    make_points(&some);
    for (uint32_t i = 0; i < LANES; i++) {
        wanted[i] = mcr_number(i, 16) < share ? 1 : 0;
        some.x[i] = some.y[i] = some.z[i] = some.density[i] = 77;
        count += wanted[i] != 0;
    }
    some.at.wanted = wanted;
    batch_normals(&full);
    batch_normals(&some);
    batch_draw(&full, &s, f, by);
    batch_draw(&some, &s, f, by);
    for (uint32_t i = 0; i < LANES; i++) {
        int same = mcr_bits(full.x[i]) == mcr_bits(some.x[i]) && mcr_bits(full.y[i]) == mcr_bits(some.y[i]) &&
                   mcr_bits(full.z[i]) == mcr_bits(some.z[i]) && mcr_bits(full.density[i]) == mcr_bits(some.density[i]);
        int untouched = some.x[i] == 77 && some.y[i] == 77 && some.z[i] == 77 && some.density[i] == 77;
        drawn += wanted[i] != 0 && !same;
        elsewhere += wanted[i] == 0 && !untouched;
        some.x[i] = full.x[i];
        some.y[i] = full.y[i];
        some.z[i] = full.z[i];
    }
    batch_density(&some, &s, f, by, plain);
    batch_density_kept(&some, &s, f, by, kept);
    for (uint32_t i = 0; i < LANES; i++)
        densities += !(fabs(plain[i] - kept[i]) <= 1e-15 * plain[i]); /* found along another way: a few roundings */
    ok(count >= (share > 0 ? 1 : 0) && !drawn && !elsewhere && !densities,
       "%u emitters, by %s, %llu of %u lanes wanted: draws (%llu differ), other lanes (%llu touched), kept densities (%llu differ)", s.emitters->count,
       by ? "solid angle" : "area", (unsigned long long)count, LANES, (unsigned long long)drawn, (unsigned long long)elsewhere,
       (unsigned long long)densities);
    free(wanted);
    free(plain);
    free(kept);
    batch_end(&full);
    batch_end(&some);
    stage_end(&s);
}

int main(void)
{
    test_bits(0, 0);
    test_bits(3, 0);
    test_bits(6, 0);
    test_bits(9, 0);
    test_bits(9, 1);
    test_bits(40, 0);
    test_bits(40, 1);
    test_points(0);
    test_points(3);
    test_points(9);
    test_points(40);
    test_tree(20);
    test_tree(60);
    test_extremes();
    test_table();
    static const double shares[] = {0, 0.01, 0.5, 1};
    static const uint32_t counts[] = {0, 3, 12, 60}; /* and a triangle: 1, 4, 13 and 61 emitters */
    for (uint32_t k = 0; k < 16; k++)
        for (uint32_t by = 0; by <= 1; by++)
            test_wanted(counts[k / 4], by, shares[k % 4]);
    return tap_done();
}
