/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Measurements of a scattering material through the stand-in for the host: points that share one normal and one outgoing direction, directional albedos,
 * and whether draw, density and evaluate agree. The points of a test are counted by the caller.
 */
#ifndef TESTS_PLUGINS_FACETS_H
#define TESTS_PLUGINS_FACETS_H

#include "stand_in.h"

#define CHANNELS 96 /* of 32 parameters */

/* A material with the same settings in all lanes, and the arrays of one batch. */
struct sheet {
    const struct mcr_material_plugin *plugin;
    double copies[CHANNELS][8];
    const double *channel[CHANNELS];
    uint32_t stride[CHANNELS];
    struct mcr_inputs inputs;
    uint32_t n;
    struct mcr_points at;
    struct mcr_directions toward;
    struct mcr_colours colour;
    double *density, *number[3];
    struct mcr_context context;
    void *instance; /* NULL of what is stateless */
};

/* `settings`: 3 numbers for each parameter. */
static __attribute__((unused)) void sheet_set(struct sheet *s, const double *settings)
{
    uint32_t channels = 3 * s->plugin->head.parameter_count;

    for (uint32_t c = 0; c < channels; c++) {
        for (int k = 0; k < 8; k++)
            s->copies[c][k] = settings[c];
        s->channel[c] = s->copies[c];
        s->stride[c] = 0;
    }
    s->inputs = (struct mcr_inputs){sizeof s->inputs, channels / 3, s->channel, s->stride};
}

static __attribute__((unused)) void sheet_init(struct sheet *s, const struct mcr_material_plugin *plugin, uint32_t n, const double *settings)
{
    size_t bytes = plugin->scratch_bytes ? plugin->scratch_bytes(NULL, n) : 0;

    *s = (struct sheet){.plugin = plugin, .n = n, .at = points_array(n), .toward = directions_array(n), .density = array(n)};
    s->colour = (struct mcr_colours){sizeof s->colour, n, array(n), array(n), array(n)};
    for (int k = 0; k < 3; k++)
        s->number[k] = array(n);
    s->context.scratch = aligned_alloc(64, (bytes + 127) / 64 * 64);
    memset(s->context.scratch, 0xff, (bytes + 127) / 64 * 64);
    sheet_set(s, settings);
}

static __attribute__((unused)) void sheet_fini(struct sheet *s)
{
    free_points(&s->at);
    free_directions(&s->toward);
    free(s->colour.r), free(s->colour.g), free(s->colour.b), free(s->density), free(s->context.scratch);
    for (int k = 0; k < 3; k++)
        free(s->number[k]);
}

/* The frame of normal `n`. */
static __attribute__((unused)) void frame(const double n[3], double t[3], double b[3])
{
    mcr_basis(n[0], n[1], n[2], &t[0], &t[1], &t[2], &b[0], &b[1], &b[2]);
}

/* All points get the normal n, for both kinds, and an outgoing direction of cosine mu with the azimuth phi. */
static __attribute__((unused)) void sheet_view(struct sheet *s, const double n[3], double mu, double phi)
{
    double t[3], b[3], sine = sqrt((1 - mu) * (1 + mu)), *points[9];

    points[0] = (double *)s->at.nx, points[1] = (double *)s->at.ny, points[2] = (double *)s->at.nz;
    points[3] = (double *)s->at.gx, points[4] = (double *)s->at.gy, points[5] = (double *)s->at.gz;
    points[6] = (double *)s->at.ox, points[7] = (double *)s->at.oy, points[8] = (double *)s->at.oz;
    frame(n, t, b);
    for (uint32_t i = 0; i < s->n; i++)
        for (int c = 0; c < 3; c++) {
            points[c][i] = points[3 + c][i] = n[c];
            points[6 + c][i] = sine * cos(phi) * t[c] + sine * sin(phi) * b[c] + mu * n[c];
        }
}

static __attribute__((unused)) void sheet_toward(struct sheet *s, uint32_t i, const double n[3], double mu, double phi)
{
    double t[3], b[3], sine = sqrt((1 - mu) * (1 + mu));

    frame(n, t, b);
    s->toward.x[i] = sine * cos(phi) * t[0] + sine * sin(phi) * b[0] + mu * n[0];
    s->toward.y[i] = sine * cos(phi) * t[1] + sine * sin(phi) * b[1] + mu * n[1];
    s->toward.z[i] = sine * cos(phi) * t[2] + sine * sin(phi) * b[2] + mu * n[2];
}

/* The directions of a grid of cosines and azimuths: the frame, and the cosine and sine of each column's azimuth, told once. */
struct grid {
    double t[3], b[3], n[3];
    uint32_t columns;
    double *c, *s;
};

static __attribute__((unused)) struct grid grid_of(const double n[3], uint32_t columns)
{
    struct grid g = {.n = {n[0], n[1], n[2]}, .columns = columns, .c = malloc(columns * sizeof *g.c), .s = malloc(columns * sizeof *g.s)};

    frame(n, g.t, g.b);
    for (uint32_t k = 0; k < columns; k++) {
        double phi = 2 * M_PI * (k + 0.5) / columns;
        g.c[k] = cos(phi), g.s[k] = sin(phi);
    }
    return g;
}

static __attribute__((unused)) void grid_toward(struct sheet *s, uint32_t i, const struct grid *g, double mu, uint32_t column)
{
    double sine = sqrt((1 - mu) * (1 + mu)), x = sine * g->c[column], y = sine * g->s[column];

    s->toward.x[i] = x * g->t[0] + y * g->b[0] + mu * g->n[0];
    s->toward.y[i] = x * g->t[1] + y * g->b[1] + mu * g->n[1];
    s->toward.z[i] = x * g->t[2] + y * g->b[2] + mu * g->n[2];
}

static __attribute__((unused)) void grid_free(struct grid *g) { free(g->c), free(g->s); }

static __attribute__((unused)) void sheet_numbers(struct sheet *s, uint64_t stream, uint64_t batch)
{
    for (uint32_t i = 0; i < s->n; i++)
        for (uint32_t k = 0; k < 3; k++)
            s->number[k][i] = fixed(stream, 3 * (batch * s->n + i) + k);
}

static __attribute__((unused)) void sheet_draw(struct sheet *s)
{
    s->plugin->draw(&stand_in, &s->context, s->instance, &s->inputs, &s->at, (const double *const *)s->number, &s->toward, s->density);
}

static __attribute__((unused)) void sheet_density(struct sheet *s)
{
    s->plugin->density(&stand_in, &s->context, s->instance, &s->inputs, &s->at, &s->toward, s->density);
}

static __attribute__((unused)) void sheet_evaluate(struct sheet *s)
{
    s->plugin->evaluate(&stand_in, &s->context, s->instance, &s->inputs, &s->at, &s->toward, &s->colour);
}

/* A mean and its standard error. */
struct estimate {
    double mean, error;
    double most;  /* the largest f cos / density */
    uint32_t bad; /* lanes that were not finite or were negative */
};

/* The directional albedo (green) by the material's own sampling. */
static __attribute__((unused)) struct estimate albedo_drawn(struct sheet *s, uint32_t batches, uint64_t stream)
{
    struct estimate e = {0, 0, 0, 0};
    double sum = 0, squares = 0, count = (double)batches * s->n;

    for (uint32_t k = 0; k < batches; k++) {
        sheet_numbers(s, stream, k);
        sheet_draw(s);
        sheet_evaluate(s);
        for (uint32_t i = 0; i < s->n; i++) {
            double value = s->density[i] > 0 ? s->colour.g[i] / s->density[i] : 0;

            e.bad += !(isfinite(s->density[i]) && isfinite(value) && value >= 0);
            e.most = value > e.most ? value : e.most;
            sum += value;
            squares += value * value;
        }
    }
    e.mean = sum / count;
    e.error = sqrt(fmax(squares / count - e.mean * e.mean, 0) / (count - 1)); /* rounding may leave less than 0 of a variance of 0 */
    return e;
}

/*
 * The directional albedo (green) by the material's own sampling, of one that does not use the third number: the midpoint rule over the square of the first
 * two, in rings of the size r around its middle and places along them. What is close to the horizon comes from outermost rings; the rule's variable t is the
 * cube root of 1 - r^2, and its weight 3 t^2. Weights of reflections fade to 0 at the horizon: the error falls as 1 / side^2.
 */
static __attribute__((unused)) struct estimate albedo_numbers(struct sheet *s, uint32_t side)
{
    struct estimate e = {0, 0, 0, 0};
    double sum = 0, weights = 0;

    for (uint32_t k = 0; k < side * side; k += s->n) {
        for (uint32_t i = 0; i < s->n; i++) {
            double t = ((k + i) / side % side + 0.5) / side, r = sqrt(1 - t * t * t), along = 4.0 * ((k + i) % side + 0.5) / side, f = 2 * (along - floor(along)) - 1;
            int edge = (int)along;
            s->number[0][i] = 0.5 + 0.5 * r * (edge == 0 ? 1 : edge == 1 ? -f : edge == 2 ? -1 : f);
            s->number[1][i] = 0.5 + 0.5 * r * (edge == 0 ? f : edge == 1 ? 1 : edge == 2 ? -f : -1);
            s->number[2][i] = 0.5;
        }
        sheet_draw(s);
        sheet_evaluate(s);
        for (uint32_t i = 0; i < s->n && k + i < side * side; i++) {
            double value = s->density[i] > 0 ? s->colour.g[i] / s->density[i] : 0, t = ((k + i) / side + 0.5) / side;

            e.bad += !(isfinite(s->density[i]) && isfinite(value) && value >= 0);
            e.most = value > e.most ? value : e.most;
            sum += 3 * t * t * value;
            weights += 3 * t * t;
        }
    }
    e.mean = sum / weights;
    return e;
}

/*
 * The directional albedo (green), and the integral of the density, over rows x columns directions that are spread uniformly over the hemisphere: the
 * midpoint rule in the cosine and the azimuth.
 */
static __attribute__((unused)) double albedo_uniform(struct sheet *s, const double n[3], uint32_t rows, uint32_t columns, double *mass)
{
    double sum = 0, densities = 0;
    uint32_t lane = 0;
    struct grid grid = grid_of(n, columns);

    for (uint32_t k = 0; k < rows * columns; k++) {
        grid_toward(s, lane, &grid, (k / columns + 0.5) / rows, k % columns);
        if (++lane < s->n && k + 1 < rows * columns)
            continue;
        sheet_density(s);
        sheet_evaluate(s);
        for (uint32_t i = 0; i < lane; i++)
            sum += s->colour.g[i], densities += s->density[i];
        lane = 0;
    }
    grid_free(&grid);
    *mass = densities * 2 * M_PI / ((double)rows * columns);
    return sum * 2 * M_PI / ((double)rows * columns);
}

/* Delta lobes; the weights go to `colour`, the probabilities to `density`. */
static __attribute__((unused)) void sheet_delta(struct sheet *s)
{
    s->plugin->delta(&stand_in, &s->context, s->instance, &s->inputs, &s->at, (const double *const *)s->number, &s->toward, s->density, &s->colour);
}

/*
 * Chi-square of drawn directions over 16 x 16 cells of (cosine, azimuth), the last cell being "nothing drawn", against the density integrated by fine x fine
 * points a cell, the midpoint rule; as a normal deviate (Wilson and Hilferty). Cells with fewer than 10 expected are put together.
 */
static __attribute__((unused)) double chi_square_by(struct sheet *s, const double n[3], uint32_t batches, uint64_t stream, double lowest, uint32_t fine,
                                                   double *mass)
{
    const double span = 1 - lowest; /* of cosines */
    enum { CELLS = 16 };
    const uint32_t side = CELLS * fine;
    static double expected[CELLS * CELLS + 1];
    static uint64_t count[CELLS * CELLS + 1];
    double t[3], b[3], chi = 0, few = 0, few_count = 0, total = (double)batches * s->n;
    uint32_t lane = 0, df = 0;
    struct grid grid = grid_of(n, side);

    frame(n, t, b);
    memset(count, 0, sizeof count);
    memset(expected, 0, sizeof expected);
    for (uint32_t k = 0; k < batches; k++) {
        sheet_numbers(s, stream, k);
        sheet_draw(s);
        for (uint32_t i = 0; i < s->n; i++) {
            double x = s->toward.x[i], y = s->toward.y[i], z = s->toward.z[i], mu = x * n[0] + y * n[1] + z * n[2];
            double angle = atan2(x * b[0] + y * b[1] + z * b[2], x * t[0] + y * t[1] + z * t[2]) / (2 * M_PI);
            int row = (int)((mu - lowest) / span * CELLS), column = (int)((angle - floor(angle)) * CELLS);

            row = row < 0 ? 0 : row < CELLS ? row : CELLS - 1, column = column < CELLS ? column : CELLS - 1;
            count[x == 0 && y == 0 && z == 0 ? CELLS * CELLS : row * CELLS + column]++;
        }
    }
    for (uint32_t k = 0; k < side * side; k++) {
        grid_toward(s, lane, &grid, lowest + span * (k / side + 0.5) / side, k % side);
        if (++lane < s->n && k + 1 < side * side)
            continue;
        sheet_density(s);
        for (uint32_t i = 0; i < lane; i++) {
            uint32_t f = k + 1 - lane + i;
            expected[f / side / fine * CELLS + f % side / fine] += s->density[i] * span * 2 * M_PI / ((double)side * side);
        }
        lane = 0;
    }
    grid_free(&grid);
    *mass = 0;
    for (uint32_t c = 0; c < CELLS * CELLS; c++)
        *mass += expected[c];
    expected[CELLS * CELLS] = *mass < 1 ? 1 - *mass : 0;
    for (uint32_t c = 0; c <= CELLS * CELLS; c++) {
        double e = expected[c] * total, o = (double)count[c];

        few += e < 10 ? e : 0, few_count += e < 10 ? o : 0;
        chi += e < 10 ? 0 : (o - e) * (o - e) / e;
        df += e >= 10;
    }
    chi += few > 0 ? (few_count - few) * (few_count - few) / (few < 1 ? 1 : few) : few_count;
    return (cbrt(chi / df) - (1 - 2 / (9.0 * df))) / sqrt(2 / (9.0 * df));
}

static __attribute__((unused)) double chi_square_over(struct sheet *s, const double n[3], uint32_t batches, uint64_t stream, double lowest, double *mass)
{
    return chi_square_by(s, n, batches, stream, lowest, 64, mass);
}

/* Over the hemisphere of the outgoing direction. */
static __attribute__((unused)) double chi_square(struct sheet *s, const double n[3], uint32_t batches, uint64_t stream, double *mass)
{
    return chi_square_over(s, n, batches, stream, 0, mass);
}

/* A checksum over the bits of draw, density and evaluate at the stand-in's points with settings of which some vary. */
static __attribute__((unused)) uint64_t sheet_bits(struct sheet *s)
{
    uint64_t sum = 0;

    sheet_numbers(s, 95, 0);
    sheet_draw(s);
    sheet_evaluate(s);
    for (uint32_t i = 0; i < s->n; i++)
        sum = mcr_mix64(sum + mcr_bits(s->toward.x[i]) + 3 * mcr_bits(s->colour.r[i]) + 5 * mcr_bits(s->colour.g[i]) + 7 * mcr_bits(s->colour.b[i]) +
                        9 * mcr_bits(s->density[i]));
    return sum;
}

#endif
