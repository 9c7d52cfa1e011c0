/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Light sampling as a probability: for shapes of all kinds, near, far and grazing, alone and overlapping, by area and by solid angle,
 *   - the density integrates to the mass (Monte Carlo over a cone that holds all emitters, |z| <= 4);
 *   - drawn directions are distributed by that density (counts in 64 cells of the cone against its integral there);
 *   - the density told by a draw is that of the direction, and positive.
 * Fixed seeds, so that a result is a constant.
 */
#include <stdlib.h>
#include <string.h>

#include "emitters_scene.h"

#define LANES 4096u
#define SIDE 8u
#define CELLS (SIDE * SIDE)

/* Directions within an angle of an axis: uniform, and the cell of a direction. */
struct cone {
    double axis[3], t[3], b[3];
    double open; /* 1 - cos of the half angle; 2: the whole sphere */
};

static struct cone cone_toward(const double p[3], const double centre[3], double radius)
{
    struct cone c;
    double d[3] = {centre[0] - p[0], centre[1] - p[1], centre[2] - p[2]}, square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    double distance = sqrt(square), sine = radius / distance;
    if (distance <= radius) {
        d[0] = d[1] = 0;
        d[2] = distance = 1;
        c.open = 2;
    } else {
        c.open = sine * sine / (1 + sqrt(1 - sine * sine));
    }
    for (int i = 0; i < 3; i++)
        c.axis[i] = d[i] / distance;
    mcr_basis(c.axis[0], c.axis[1], c.axis[2], &c.t[0], &c.t[1], &c.t[2], &c.b[0], &c.b[1], &c.b[2]);
    return c;
}

/* Of LANES samples; sanitizers look for what is read or written out of place, not for densities. */
static uint32_t rounds(void)
{
    const char *sanitized = getenv("MCR_SANITIZED");
    return sanitized && !strcmp(sanitized, "1") ? 8 : 32;
}

static void cone_direction(const struct cone *c, double u, double v, double out[3])
{
    double sink = u * c->open, rho = sqrt(sink * (2 - sink)), angle = 2 * MCR_PI * v;
    for (int i = 0; i < 3; i++)
        out[i] = (1 - sink) * c->axis[i] + rho * (cos(angle) * c->t[i] + sin(angle) * c->b[i]);
}

static uint32_t cone_cell(const struct cone *c, double x, double y, double z)
{
    double across = x * c->t[0] + y * c->t[1] + z * c->t[2], up = x * c->b[0] + y * c->b[1] + z * c->b[2];
    double along = x * c->axis[0] + y * c->axis[1] + z * c->axis[2];
    double sink = along > 0 ? (across * across + up * up) / (1 + along) : 1 - along;
    double u = sink / c->open * SIDE, v = (atan2(up, across) / (2 * MCR_PI) + 0.5) * SIDE;
    uint32_t i = u < 0 ? 0 : u >= SIDE ? SIDE - 1 : (uint32_t)u, j = v < 0 ? 0 : v >= SIDE ? SIDE - 1 : (uint32_t)v;
    return i * SIDE + j;
}

/* Integrals of the density over cells and over all, each with its error. */
static void integrate(const struct stage *s, const struct mcr_emitter_functions *f, uint32_t by, const struct cone *c, struct batch *b,
                      struct mean cell[CELLS], struct mean *whole)
{
    for (uint32_t round = 0; round < rounds(); round++) {
        batch_numbers(b, 1000 + round);
        for (uint32_t i = 0; i < b->n; i++) {
            double w[3];
            cone_direction(c, b->u[0][i], b->u[1][i], w);
            b->x[i] = w[0], b->y[i] = w[1], b->z[i] = w[2];
        }
        batch_density(b, s, f, by, b->density);
        for (uint32_t i = 0; i < b->n; i++) {
            double value = b->density[i] * 2 * MCR_PI * c->open;
            uint32_t here = cone_cell(c, b->x[i], b->y[i], b->z[i]);
            mean_add(whole, value);
            cell[here].sum += value;
            cell[here].squares += value * value;
        }
    }
    for (uint32_t k = 0; k < CELLS; k++)
        cell[k].count = whole->count;
}

struct drawn_facts {
    double count[CELLS];
    double none, total;   /* lanes without a direction; all lanes */
    double worst;         /* relative difference of draw's density and density's */
    double lost;          /* directions of density 0 by density() */
    double bent;          /* worst | |w|^2 - 1 | */
};

static void draw_all(const struct stage *s, const struct mcr_emitter_functions *f, uint32_t by, const struct cone *c, struct batch *b,
                     struct drawn_facts *facts)
{
    double *again = doubles(b->n), *kept = doubles(b->n);
    for (uint32_t round = 0; round < rounds(); round++) {
        batch_numbers(b, 5000 + round);
        batch_draw(b, s, f, by);
        batch_density(b, s, f, by, again);
        batch_density_kept(b, s, f, by, kept);
        for (uint32_t i = 0; i < b->n; i++) {
            double x = b->x[i], y = b->y[i], z = b->z[i];
            facts->total++;
            if (x == 0 && y == 0 && z == 0) {
                facts->none++;
                facts->lost += b->density[i] != 0 || again[i] != 0;
                continue;
            }
            facts->count[cone_cell(c, x, y, z)]++;
            facts->bent = fmax(facts->bent, fabs(x * x + y * y + z * z - 1));
            if (again[i] > 0 && b->density[i] > 0)
                facts->worst = fmax(facts->worst, fmax(fabs(b->density[i] / again[i] - 1), fabs(kept[i] / again[i] - 1)));
            else
                facts->lost++;
        }
    }
    free(kept);
    free(again);
}

/* Chi-square of counts against integrals that have errors of their own, as a normal deviate (Wilson and Hilferty 1931). */
static double deviate(const struct drawn_facts *facts, const struct mean cell[CELLS])
{
    double chi = 0, degrees = 0;
    for (uint32_t k = 0; k < CELLS; k++) {
        double expected = mean_value(&cell[k]), error = mean_error(&cell[k]);
        double variance = expected * (1 - fmin(expected, 1)) / facts->total + error * error;
        if (expected * facts->total < 20)
            continue;
        double difference = facts->count[k] / facts->total - expected;
        chi += difference * difference / variance;
        degrees++;
    }
    if (degrees < 2)
        return 0;
    double scale = 2 / (9 * degrees);
    return (cbrt(chi / degrees) - (1 - scale)) / sqrt(scale);
}

/*
 * tolerance: of the relative difference between the density a draw tells and density() of its direction. It grows where the density depends
 * steeply on the direction: a rounding of it over the cosine at flat emitters, over its square at the limb of round ones.
 */
static void check(struct stage *s, const char *name, const double p[3], const double centre[3], double radius, double mass_known,
                  double tolerance)
{
    const struct mcr_emitter_functions *f = best_functions();
    struct cone c = cone_toward(p, centre, radius);
    struct batch b;
    batch_begin(&b, LANES);
    batch_at(&b, p);
    for (uint32_t by = MCR_LIGHT_BY_AREA; by <= MCR_LIGHT_BY_SOLID_ANGLE; by++) {
        const char *how = by == MCR_LIGHT_BY_AREA ? "area" : "solid angle";
        struct mean cell[CELLS] = {{0}}, whole = {0};
        struct drawn_facts facts = {.total = 0};
        double mass, error, z;
        integrate(s, f, by, &c, &b, cell, &whole);
        draw_all(s, f, by, &c, &b, &facts);
        f->mass(s->emitters, s->scratch, by, &b.at, b.density);
        mass = b.density[0];
        error = mean_error(&whole);
        z = (mean_value(&whole) - mass) / (error > 0 ? error : 1e-300);
        ok(mass_known < 0 || fabs(mass - mass_known) <= 1e-12, "%s, by %s: mass %.12g", name, how, mass);
        ok(fabs(z) <= 4 || fabs(mean_value(&whole) - mass) <= 1e-10, "%s, by %s: density integrates to it, z = %.2f (error %.1e)", name,
           how, z, error);
        z = (facts.none / facts.total - (1 - mass)) / sqrt(fmax(mass * (1 - mass), 1e-300) / facts.total);
        ok(fabs(z) <= 4 || facts.none == 0, "%s, by %s: draws as often, %.0f of %.0f empty", name, how, facts.none, facts.total);
        z = deviate(&facts, cell);
        ok(fabs(z) <= 4, "%s, by %s: drawn by the density, z = %.2f", name, how, z);
        ok(facts.worst <= tolerance && facts.lost <= facts.total * 1e-4, "%s, by %s: draw tells the density (worst %.1e, %.0f lost)", name,
           how,
           facts.worst, facts.lost);
        ok(facts.bent <= 1e-14, "%s, by %s: unit directions, %.1e", name, how, facts.bent);
    }
    batch_end(&b);
}

static void flat_near(uint32_t kind, const char *name)
{
    const double c[3] = {-0.3, -0.2, 0.5}, e0[3] = {0.5, 0.1, 0.1}, e1[3] = {-0.2, 0.6, 0.05};
    const double mid[3] = {c[0] + (e0[0] + e1[0]) / 2, c[1] + (e0[1] + e1[1]) / 2, c[2] + (e0[2] + e1[2]) / 2};
    const double *centre = kind == MCR_SHAPE_DISK ? c : mid;
    const double points[][3] = {{0, 0, 0}, {0.4, -0.3, 0.3}, {0, 0, 0.55}, {0.8, 0.5, -0.9}};
    struct stage s;
    char text[100];
    for (uint32_t sides = FRONT; sides <= (FRONT | BACK); sides += FRONT) {
        stage_begin(&s);
        stage_flat(&s, kind, sides, 1, c, e0, e1);
        stage_ready(&s);
        for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
            double height = s.shape[0].n[0] * (points[i][0] - c[0]) + s.shape[0].n[1] * (points[i][1] - c[1]) +
                            s.shape[0].n[2] * (points[i][2] - c[2]);
            double known = (height > 0 ? sides & FRONT : sides & BACK) ? 1 : 0;
            snprintf(text, sizeof text, "%s, sides %u, point %zu", name, sides / FRONT, i);
            check(&s, text, points[i], centre, 0.85, known, 1e-9);
        }
        stage_end(&s);
    }
}

static void flat_far(uint32_t kind, const char *name)
{
    const double c[3] = {0.1, 0.2, 0.3}, e0[3] = {2e-3, 1e-4, 3e-4}, e1[3] = {-3e-4, 1e-3, 1e-3};
    const double points[][3] = {{0.5, 0.5, 0.9}, {-0.9, 0.1, 0.4}, {0.1, 0.2, 0.31}};
    struct stage s;
    char text[100];
    stage_begin(&s);
    stage_flat(&s, kind, FRONT | BACK, 1, c, e0, e1);
    stage_ready(&s);
    for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
        snprintf(text, sizeof text, "far %s, point %zu", name, i);
        check(&s, text, points[i], c, 3.5e-3, 1, 1e-8);
    }
    stage_end(&s);
}

/* A point a hair over the plane, beside the emitter and in front of it. */
static void flat_grazing(uint32_t kind, const char *name)
{
    const double c[3] = {0.1, 0.2, 0.3}, e0[3] = {0.2, 0, 0}, e1[3] = {0, 0.3, 0};
    const double points[][3] = {{-0.3, 0.1, 0.3 + 1e-3}, {-0.3, 0.1, 0.3 + 1e-7}, {0.15, 0.25, 0.3 + 1e-2}, {0.10001, 0.3, 0.301}};
    const double reach[] = {0.62, 0.62, 0.4, 0.4};
    struct stage s;
    char text[100];
    stage_begin(&s);
    stage_flat(&s, kind, FRONT, 1, c, e0, e1);
    stage_ready(&s);
    for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
        snprintf(text, sizeof text, "grazing %s, point %zu", name, i);
        if (i == 1) { /* the emitter is a line there: no cone can be integrated over, but draws and density must agree */
            struct batch b;
            double *again = doubles(LANES), worst = 0;
            batch_begin(&b, LANES);
            batch_at(&b, points[i]);
            batch_numbers(&b, 77);
            batch_draw(&b, &s, best_functions(), MCR_LIGHT_BY_SOLID_ANGLE);
            batch_density(&b, &s, best_functions(), MCR_LIGHT_BY_SOLID_ANGLE, again);
            for (uint32_t k = 0; k < LANES; k++)
                worst = again[k] > 0 && b.density[k] > 0 ? fmax(worst, fabs(again[k] / b.density[k] - 1)) : worst;
            /* 1e-16 over the cosine 1e-7, cubed: 3e-9 a rounding */
            ok(worst < 1e-6, "%s: draw tells the density (worst %.1e)", text, worst);
            batch_end(&b);
            free(again);
        } else {
            check(&s, text, points[i], c, reach[i], 1, 1e-8);
        }
    }
    stage_end(&s);
}

static void round_ones(void)
{
    const double c[3] = {0.1, -0.2, 0.4}, axes[3][3] = {{0.3, 0.05, 0}, {-0.02, 0.1, 0.04}, {0, -0.1, 0.2}};
    const double outside[3] = {0.7, 0.3, -0.2}, inside[3] = {0.12, -0.19, 0.43}, close_by[3] = {0.1, -0.2, 0.4 - 0.2001};
    struct stage s;
    for (uint32_t sides = FRONT; sides <= (FRONT | BACK); sides += FRONT) {
        char text[100];
        stage_begin(&s);
        stage_sphere(&s, sides, 1, c, 0.2);
        stage_ready(&s);
        snprintf(text, sizeof text, "sphere, sides %u", sides / FRONT);
        check(&s, text, outside, c, 0.2001, sides & FRONT ? 1 : 0, 1e-2);
        snprintf(text, sizeof text, "sphere from inside, sides %u", sides / FRONT);
        check(&s, text, inside, c, 1, sides & BACK ? 1 : 0, 1e-9);
        snprintf(text, sizeof text, "sphere from close by, sides %u", sides / FRONT);
        check(&s, text, close_by, c, 1, sides & FRONT ? 1 : 0, 1e-2);
        stage_end(&s);
        stage_begin(&s);
        stage_axes(&s, MCR_SHAPE_ELLIPSOID, sides, 1, c, axes);
        stage_ready(&s);
        snprintf(text, sizeof text, "ellipsoid, sides %u", sides / FRONT);
        check(&s, text, outside, c, 0.42, sides & FRONT ? 1 : 0, 1e-2);
        snprintf(text, sizeof text, "ellipsoid from inside, sides %u", sides / FRONT);
        check(&s, text, inside, c, 1, sides & BACK ? 1 : 0, 1e-9);
        stage_end(&s);
    }
}

static void many(void)
{
    const double c[3] = {-0.2, -0.2, 0.5}, e0[3] = {0.5, 0, 0}, e1[3] = {0, 0.5, 0}, behind[3] = {-0.1, -0.1, 0.7}, ball[3] = {0, 0, 0.3};
    const double axes[3][3] = {{0.1, 0, 0}, {0, 0.2, 0}, {0, 0.05, 0.1}}, p[3] = {0.05, 0.02, 0}, q[3] = {0.1, 0.05, 0.95},
        all[3] = {0, 0, 0.5};
    struct stage s;
    stage_begin(&s);
    stage_flat(&s, MCR_SHAPE_PARALLELOGRAM, FRONT, 3, c, e0, e1); /* faces up */
    stage_flat(&s, MCR_SHAPE_PARALLELOGRAM, FRONT | BACK, 1, behind, e0, e1);
    stage_flat(&s, MCR_SHAPE_DISK, BACK, 1, behind, e0, e1);
    stage_sphere(&s, FRONT, 2, ball, 0.1);
    stage_axes(&s, MCR_SHAPE_BOX, FRONT, 1, ball, axes);
    stage_axes(&s, MCR_SHAPE_ELLIPSOID, FRONT, 1, behind, axes);
    stage_triangle(&s, FRONT | BACK, 1, c, behind, ball);
    stage_ready(&s);
    ok(s.emitters->count == 12, "a box is six emitters: %u in all", s.emitters->count);
    check(&s, "12 emitters, from below", p, all, 0.75, 1, 1e-2);
    check(&s, "12 emitters, from above", q, all, 1, -1, 1e-2);
    stage_end(&s);

    stage_begin(&s);
    for (int i = 0; i < 20; i++) {
        double corner[3] = {-0.3 + 0.02 * i, -0.2, 0.4 + 0.01 * i};
        stage_flat(&s, i % 2 ? MCR_SHAPE_PARALLELOGRAM : MCR_SHAPE_DISK, i % 3 ? FRONT | BACK : FRONT, 1 + i, corner, e0, e1);
    }
    stage_sphere(&s, FRONT, 2, ball, 0.1);
    stage_ready(&s);
    check(&s, "21 emitters, from below", p, all, 1, -1, 1e-2);
    check(&s, "21 emitters, from above", q, all, 1, 1, 1e-2);
    stage_end(&s);

    stage_begin(&s);
    stage_axes(&s, MCR_SHAPE_BOX, BACK, 1, ball, axes);
    stage_ready(&s);
    check(&s, "box, inside only, from outside: through the near faces", p, all, 0.75, 1, 1e-9);
    check(&s, "box, inside only, from inside", (const double[3]){0.05, 0.12, 0.37}, all, 1, 1, 1e-9);
    stage_end(&s);
}

static void triangles(void)
{
    const double a[3] = {-0.3, -0.2, 0.5}, b[3] = {0.3, -0.1, 0.6}, c[3] = {0, 0.4, 0.45}, p[3] = {0.1, 0, 0}, q[3] = {0.4, 0.4, 0.49},
        mid[3] = {0, 0, 0.5};
    struct stage s;
    stage_begin(&s);
    stage_triangle(&s, BACK, 1, a, b, c);
    stage_ready(&s);
    check(&s, "triangle from behind", p, mid, 0.5, 1, 1e-9);
    check(&s, "triangle from the side", q, mid, 1, -1, 1e-9);
    stage_end(&s);
    stage_begin(&s);
    stage_triangle(&s, FRONT, 1, a, b, c);
    stage_ready(&s);
    check(&s, "triangle that faces away", p, mid, 0.5, 0, 1e-9);
    stage_end(&s);
}

int main(void)
{
    flat_near(MCR_SHAPE_PARALLELOGRAM, "parallelogram");
    flat_near(MCR_SHAPE_DISK, "disk");
    flat_far(MCR_SHAPE_PARALLELOGRAM, "parallelogram");
    flat_far(MCR_SHAPE_DISK, "disk");
    flat_grazing(MCR_SHAPE_PARALLELOGRAM, "parallelogram");
    flat_grazing(MCR_SHAPE_DISK, "disk");
    triangles();
    round_ones();
    many();
    return tap_done();
}
