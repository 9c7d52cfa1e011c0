/* SPDX-License-Identifier: Apache-2.0 */
/* dielectric and mirror: Fresnel's formulas, Snell's law, slabs with a known answer, energy, sampling and the extremes of index, roughness and angle. */
#include "facets.h"

#define LANES 4096u
#define U 0x1p-53
#define HEAVY (64 * U) /* a weight is a quotient of some 20 products, roots and sums of terms of one sign, each to U */
#define LENGTH(x) (sizeof(x) / sizeof *(x))

enum { INDEX, ROUGHNESS, THIN, TRANSMITTANCE, DEPTH, ATTENUATION, PRIORITY, COMPENSATION, PARAMETERS };

static const double normal[3] = {0.48, -0.6, 0.64}, upright[3] = {0, 0, 1};
static uint32_t isa;
static const struct mcr_material_plugin *plugin;

static void settings_of(double s[3 * PARAMETERS], double index, double alpha, int thin)
{
    memset(s, 0, 3 * PARAMETERS * sizeof *s);
    s[3 * INDEX] = index, s[3 * ROUGHNESS] = alpha, s[3 * THIN] = thin, s[3 * DEPTH] = 1;
    for (int c = 0; c < 3; c++)
        s[3 * TRANSMITTANCE + c] = 1;
}

static void set(struct sheet *sheet, double index, double alpha, int thin)
{
    double s[3 * PARAMETERS];

    settings_of(s, index, alpha, thin);
    sheet_set(sheet, s);
}

/* Gives back the light that meets several facets. */
static void compensate(struct sheet *sheet)
{
    for (int i = 0; i < 8; i++)
        sheet->copies[3 * COMPENSATION][i] = 1;
}

static void init(struct sheet *sheet, double side)
{
    double s[3 * PARAMETERS];

    settings_of(s, 1.5, 0, 0);
    sheet_init(sheet, plugin, LANES, s);
    for (uint32_t i = 0; i < LANES; i++)
        ((double *)sheet->at.side)[i] = side;
}

/* Both lobes of a smooth surface: number 0 gives reflection, 1 - u the other, if there is one. */
static void lobes(struct sheet *sheet, double reflect[5], double refract[5])
{
    for (int k = 0; k < 2; k++) {
        double *lobe = k ? refract : reflect;

        sheet->number[0][0] = k ? 1 - U : 0;
        sheet_delta(sheet);
        lobe[0] = sheet->toward.x[0], lobe[1] = sheet->toward.y[0], lobe[2] = sheet->toward.z[0];
        lobe[3] = sheet->density[0], lobe[4] = sheet->colour.g[0];
    }
}

/* R of unpolarised light from Fresnel's amplitudes, in long double. */
static long double reference(long double c, long double n)
{
    long double t2 = 1 - (1 - c) * (1 + c) / (n * n), t, s, p;

    if (t2 <= 0)
        return 1;
    t = sqrtl(t2);
    s = (c - n * t) / (c + n * t), p = (n * c - t) / (n * c + t);
    return (s * s + p * p) / 2;
}

/*
 * By how much a rounding grows: q^2 = n^2 - 1 + c^2 is a difference of numbers up to 1, and R depends on q to about a power of 2. All else are some 20 products,
 * quotients and sums of one sign.
 */
static double condition(double c, double n)
{
    double q2 = (n - 1) * (n + 1) + c * c;
    return q2 > 0 && q2 < 1 ? 1 / q2 : 1;
}

static void test_fresnel(void)
{
    static const double index[] = {1e-3, 0.5, 1 / 1.5, 0.999, 1.001, 1.33, 1.5, 2.4, 1e3}, mu[] = {1, 0.9, 0.7, 0.5, 0.3, 0.1, 1e-3};
    double worst = 0, snell = 0, sum = 0, turned = 0, normal_error = 0;
    static const double steep[] = {1 + 1e-6, 1 - 1e-6, 1.5, 1e3, 1e-3, 1 + 1e-9};
    double a[5], b[5];
    struct sheet sheet;

    init(&sheet, 1);
    for (uint32_t k = 0; k < LENGTH(index); k++)
        for (uint32_t m = 0; m < LENGTH(mu); m++) {
            double exact = (double)reference(mu[m], index[k]), n = index[k];

            set(&sheet, n, 0, 0);
            sheet_view(&sheet, upright, mu[m], 0.8);
            lobes(&sheet, a, b);
            worst = fmax(worst, fabs(a[4] - exact) / exact / condition(mu[m], n)), sum = fmax(sum, fabs(a[3] - a[4]));
            turned = fmax(turned, fabs(a[0] + sheet.at.ox[0]) + fabs(a[1] + sheet.at.oy[0]) + fabs(a[2] - sheet.at.oz[0]));
            if (exact == 1) { /* total reflection: the only lobe */
                turned = fmax(turned, fabs(a[3] - 1) + fabs(b[2] - mu[m]));
                continue;
            }
            sum = fmax(sum, fabs(a[3] + b[3] - 1) + fabs(b[4] * n * n - b[3]));
            snell = fmax(snell, fabs(b[0] * n + sheet.at.ox[0]) + fabs(b[1] * n + sheet.at.oy[0]) + fabs(hypot(hypot(b[0], b[1]), b[2]) - 1));
            snell = fmax(snell, b[2] < 0 ? 0 : 1);
        }
    ok(worst < 32 * U, "%u: Fresnel's formulas to 32 roundings (%.1f)", isa, worst / U);
    ok(sum < 1e-12, "%u: the lobes' probabilities are their shares; 1/n^2 of the radiance is refracted (%.1e)", isa, sum);
    ok(snell < 1e-12 && turned < 1e-14, "%u: Snell's law, the mirror's, total reflection (%.1e, %.1e)", isa, snell, turned);
    sheet_view(&sheet, upright, 1, 0);
    for (uint32_t k = 0; k < LENGTH(steep); k++) {
        long double n = steep[k], exact = (n - 1) * (n - 1) / ((n + 1) * (n + 1));

        set(&sheet, steep[k], 0, 0);
        lobes(&sheet, a, b);
        normal_error = fmax(normal_error, fabs((double)(a[4] / exact - 1)) / condition(1, steep[k]));
    }
    ok(normal_error < 32 * U, "%u: ((n - 1) / (n + 1))^2 at normal incidence, down to n - 1 = 1e-9, to 32 roundings (%.1f)", isa, normal_error / U);
    set(&sheet, 1, 0, 0);
    sheet_view(&sheet, upright, 0.4, 1);
    lobes(&sheet, a, b);
    ok(b[4] == 1 && b[3] == 1 && fabs(b[0] + sheet.at.ox[0]) < 4 * U && fabs(b[2] + sheet.at.oz[0]) < 4 * U, "%u: index 1 is not there", isa);
    sheet_fini(&sheet);
}

/* S22 and S13 of the project's table of analytic scenes, and what the host says of both sides. */
static void test_known(void)
{
    static const double degrees[] = {0, 30, 45, 60, 80}, slab[] = {.92307692307692, .92026553251895, .90432679145889, .83623246271017, .44122917337};
    double a[5], b[5], thin = 0, tinted, sum = 0, *here, *beyond;
    struct sheet sheet;

    init(&sheet, 1);
    sheet_view(&sheet, upright, sqrt(0.5), 2);
    lobes(&sheet, a, b);
    ok(fabs(a[4] - .050239911012) < 1e-12, "%u: S22 at 45 degrees", isa);
    sheet_view(&sheet, upright, 0.5, 2);
    lobes(&sheet, a, b);
    ok(fabs(a[4] - .089186712802) < 1e-12, "%u: S22 at 60 degrees", isa);
    for (uint32_t k = 0; k < 2000; k++) { /* the mean over the hemisphere: midpoints of the squared cosine */
        sheet_view(&sheet, upright, sqrt((k + 0.5) / 2000), 2);
        lobes(&sheet, a, b);
        sum += a[4] / 2000;
    }
    ok(fabs(sum - .091777959342) < 2e-5, "%u: S22 over the hemisphere (%.1e off)", isa, sum - .091777959342);
    set(&sheet, 1.5, 0, 1);
    for (uint32_t k = 0; k < LENGTH(slab); k++) {
        sheet_view(&sheet, normal, cos(degrees[k] * M_PI / 180), 2);
        lobes(&sheet, a, b);
        thin = fmax(thin, fabs(b[4] - slab[k]) + fabs(a[4] + b[4] - 1) + fabs(b[0] + sheet.at.ox[0]) + fabs(b[2] + sheet.at.oz[0]));
    }
    ok(thin < 1e-10, "%u: S13, straight through a thin wall (%.1e)", isa, thin);
    for (int i = 0; i < 8; i++)
        sheet.copies[3 * TRANSMITTANCE + 1][i] = 0.5;
    sheet_view(&sheet, normal, 1, 2);
    lobes(&sheet, a, b);
    tinted = 0.96 * 0.96 * 0.5 / (1 - 0.04 * 0.04 * 0.25);
    ok(fabs(b[4] - tinted) < 1e-14 && fabs(a[4] - (0.04 + 0.04 * 0.5 * tinted)) < 1e-14, "%u: a thin wall that absorbs", isa);
    here = array(LANES), beyond = array(LANES);
    for (uint32_t i = 0; i < LANES; i++)
        here[i] = 1.33, beyond[i] = 1.7;
    sheet.at.here = here, sheet.at.beyond = beyond;
    set(&sheet, 1.5, 0, 0);
    sheet_view(&sheet, normal, 0.6, 2);
    lobes(&sheet, a, b);
    ok(fabs(a[4] - (double)reference(0.6L, 1.7L / 1.33L)) < 1e-12 && fabs(b[4] - b[3] * (1.33 / 1.7) * (1.33 / 1.7)) < 1e-14,
       "%u: the host's indices of both sides count", isa);
    free(here), free(beyond);
    sheet.at.here = sheet.at.beyond = NULL;
    sheet_fini(&sheet);
    init(&sheet, -1);
    sheet_view(&sheet, normal, 0.8, 2);
    lobes(&sheet, a, b);
    ok(fabs(a[4] - (double)reference(0.8L, 1 / 1.5L)) < 1e-12, "%u: seen from inside", isa);
    sheet_fini(&sheet);
}

/* 1 / G1 - 1 of GGX by the cosine. */
static double lambda(double c, double alpha)
{
    return (sqrt(1 + alpha * alpha * (1 - c) * (1 + c) / (c * c)) - 1) / 2;
}

/*
 * The share of the light that one facet sends on, from the definitions in Walter et al.: the sum over all facets, by the midpoint rule in the root of the
 * share of steeper slopes and in the azimuth, of (o.m) / (o.n m.n) times what is reflected or passes and Smith's height-correlated G2 of both directions.
 */
static double one_facet(double mu, double alpha, double n, int thin)
{
    enum { ROWS = 600, COLUMNS = 200 };
    const double ox = sqrt((1 - mu) * (1 + mu));
    double sum = 0;

    for (int k = 0; k < ROWS * COLUMNS; k++) {
        double v = (k / COLUMNS + 0.5) / ROWS, turn = M_PI * (k % COLUMNS + 0.5) / COLUMNS, slope = alpha * sqrt(1 - v * v) / v, mz = 1 / sqrt(1 + slope * slope);
        double mx = slope * mz * cos(turn), c = ox * mx + mu * mz, t2 = 1 - (1 - c * c) / (n * n), t = sqrt(fmax(t2, 0)), f, up, down, sum_here = 0;

        if (c <= 0)
            continue;
        f = t2 > 0 ? (pow((c - n * t) / (c + n * t), 2) + pow((n * c - t) / (n * c + t), 2)) / 2 : 1;
        up = 2 * c * mz - mu, down = thin ? up : t * mz - (c * mz - mu) / n;
        if (up > 0)
            sum_here += (thin ? 1 : f) / (1 + lambda(mu, alpha) + lambda(up, alpha));
        if (!thin && down > 0)
            sum_here += (1 - f) / (1 + lambda(mu, alpha) + lambda(down, alpha));
        sum += 2 * v * sum_here * c / (mu * mz) / (ROWS * COLUMNS);
    }
    return sum;
}

/*
 * Rough: draws follow the density over the whole sphere; energy, weighing what is refracted by n^2, is that of one facet, no weight is above 1; what is reflected is that of the smooth surface as roughness goes to 0. The integral by uniform directions is the one by own sampling.
 */
static void test_rough(void)
{
    static const struct {
        double index, alpha, mu, side;
        int thin;
    } cases[] = {{1.5, 0.3, 0.8, 1, 0}, {1.5, 0.3, 0.8, -1, 0}, {1.5, 0.6, 0.2, 1, 0}, {1.5, 1, 0.5, -1, 0}, {1.1, 1, 0.9, 1, 0},
                 {0.7, 0.5, 0.6, 1, 0}, {2.5, 0.4, 0.3, 1, 0}, {1.5, 0.4, 0.6, 1, 1}, {0.8, 0.5, 0.7, 1, 1}};
    struct sheet sheet;

    for (uint32_t k = 0; k < LENGTH(cases); k++) {
        double mass, z, energy = 0, energies = 0, known, scale, sum = 0, squares = 0, grid = 0, error;
        uint32_t lane = 0, bad = 0;

        init(&sheet, cases[k].side);
        set(&sheet, cases[k].index, cases[k].alpha, cases[k].thin);
        sheet_view(&sheet, normal, cases[k].mu, 0.9);
        z = chi_square_over(&sheet, normal, 64, 200 + k, -1, &mass);
        ok(z <= 4 && mass <= 1.001, "%u: draws follow the density, index %g, alpha %g, cos %g, side %g, thin %d: chi-square z %.2f, mass %.4f", isa,
           cases[k].index, cases[k].alpha, cases[k].mu, cases[k].side, cases[k].thin, z, mass);
        scale = cases[k].thin ? 1 : pow(cases[k].index, 2 * cases[k].side);
        for (uint32_t batch = 0; batch < 64; batch++) {
            sheet_numbers(&sheet, 230 + k, batch);
            sheet_draw(&sheet);
            sheet_evaluate(&sheet);
            for (uint32_t i = 0; i < LANES; i++) {
                double below = sheet.toward.x[i] * normal[0] + sheet.toward.y[i] * normal[1] + sheet.toward.z[i] * normal[2];
                double value = sheet.density[i] > 0 ? sheet.colour.g[i] / sheet.density[i] : 0, weighed = below < 0 ? value * scale : value;

                bad += !isfinite(value) || value < 0 || weighed > 1 + HEAVY;
                energy += weighed / (64.0 * LANES), energies += weighed * weighed / (64.0 * LANES), sum += value / (64.0 * LANES), squares += value * value / (64.0 * LANES);
            }
        }
        known = one_facet(cases[k].mu, cases[k].alpha, cases[k].side > 0 || cases[k].thin ? cases[k].index : 1 / cases[k].index, cases[k].thin);
        error = sqrt(fmax(energies - energy * energy, 0) / (64.0 * LANES));
        ok(bad == 0 && fabs(energy - known) < 4 * error + 2e-4 && error < 1e-3, "%u: energy %.5f +- %.0e, of one facet %.5f; no weight above 1", isa, energy, error,
           known);
        for (uint32_t fine = 0; fine < 1024 * 256; fine++) {
            sheet_toward(&sheet, lane, normal, -1 + 2 * (fine / 256 + 0.5) / 1024, 2 * M_PI * (fine % 256 + 0.5) / 256);
            if (++lane < LANES)
                continue;
            sheet_evaluate(&sheet);
            for (uint32_t i = 0; i < LANES; i++)
                grid += sheet.colour.g[i] * 4 * M_PI / (1024.0 * 256);
            lane = 0;
        }
        error = sqrt((squares - sum * sum) / (64.0 * LANES));
        ok(fabs(grid - sum) < 4 * error + 1e-3 * sum && error < 2e-3, "%u: by uniform directions: off by %.1e, standard error %.1e", isa, grid - sum, error);
        if (k == 0) {
            double few = 0;

            set(&sheet, 1.5, 0.01, 0);
            for (uint32_t batch = 0; batch < 64; batch++) {
                sheet_numbers(&sheet, 260, batch), sheet_draw(&sheet);
                for (uint32_t i = 0; i < LANES; i++)
                    few += sheet.toward.x[i] * normal[0] + sheet.toward.y[i] * normal[1] + sheet.toward.z[i] * normal[2] > 0;
            }
            few /= 64.0 * LANES, z = (few - (double)reference(0.8L, 1.5L)) / sqrt(few / (64.0 * LANES));
            ok(fabs(z) <= 4, "%u: nearly smooth, the share of a smooth surface is reflected (z %.2f)", isa, z);
        }
        sheet_fini(&sheet);
    }
}

/*
 * All light that is scattered, green, what is refracted weighed by the square of the relative index: by own draws at the points of a Kronecker lattice (powers
 * of the root of x^4 = x + 1), shifted at random; mean and standard error are of the shifts.
 */
static struct estimate scattered(struct sheet *sheet, double scale, uint32_t batches, uint64_t stream)
{
    static const double step[3] = {0.81917251339616444, 0.67104360670378920, 0.54970047790197026};
    enum { SHIFTS = 16 };
    struct estimate e = {0, 0, 0, 0};
    double sum = 0, squares = 0;

    for (uint32_t shift = 0; shift < SHIFTS; shift++) {
        double part = 0;

        for (uint32_t batch = 0; batch < batches; batch++) {
            for (uint32_t i = 0; i < LANES; i++)
                for (uint32_t k = 0; k < 3; k++) {
                    double x = fixed(stream, 3 * shift + k) + (batch * LANES + i) * step[k];
                    sheet->number[k][i] = x - floor(x);
                }
            sheet_draw(sheet), sheet_evaluate(sheet);
            for (uint32_t i = 0; i < LANES; i++) {
                double below = sheet->toward.x[i] * normal[0] + sheet->toward.y[i] * normal[1] + sheet->toward.z[i] * normal[2];
                double value = sheet->density[i] > 0 ? sheet->colour.g[i] / sheet->density[i] * (below < 0 ? scale : 1) : 0;

                e.bad += !isfinite(value) || value < 0;
                part += value / (batches * LANES);
            }
        }
        sum += part / SHIFTS, squares += part * part / SHIFTS;
    }
    e.mean = sum;
    e.error = sqrt(fmax(squares - sum * sum, 0) / (SHIFTS - 1));
    return e;
}

/*
 * With compensation no light is lost: to 3e-4, which is what glass.h promises for most places, and 4 standard errors. From both sides, through total
 * reflection, at grazing angles, between two interiors, through walls. Draws follow the density.
 */
static void test_compensation(void)
{
    static const double index[] = {1.05, 1.33, 1.5, 2.4, 4}, alpha[] = {0.05, 0.3, 1}, mu[] = {1, 0.7, 0.4, 0.1, 0.02};
    double worst = 0, error = 0, most = 0, *here = array(LANES), *beyond = array(LANES);
    uint32_t bad = 0, cases = 0;
    struct sheet sheet;

    init(&sheet, 1);
    for (uint32_t k = 0; k < 2 * LENGTH(index) * LENGTH(alpha) + 5; k++) {
        uint32_t extra = k - 2 * LENGTH(index) * LENGTH(alpha), thin = k >= 2 * LENGTH(index) * LENGTH(alpha) && extra < 3;
        double n = thin ? 1.5 : index[k % LENGTH(index)], a = alpha[k / LENGTH(index) % LENGTH(alpha)], side = k / LENGTH(index) / LENGTH(alpha) ? -1 : 1;
        double scale = thin ? 1 : pow(n, 2 * side), off;
        struct estimate e;

        for (uint32_t i = 0; i < LANES; i++)
            ((double *)sheet.at.side)[i] = side, here[i] = 1.33, beyond[i] = k % 2 ? 1.7 : 1.2;
        set(&sheet, n, a, (int)thin), compensate(&sheet);
        if (k >= 2 * LENGTH(index) * LENGTH(alpha) + 3) /* the host's indices, not the material's own */
            sheet.at.here = here, sheet.at.beyond = beyond, scale = pow(beyond[0] / 1.33, 2);
        sheet_view(&sheet, normal, mu[(k + k / LENGTH(index)) % LENGTH(mu)], 0.9);
        e = scattered(&sheet, scale, 2, 400 + k);
        off = fabs(e.mean - 1) - 4 * e.error;
        bad += e.bad, error = fmax(error, e.error), cases++;
        if (off > worst)
            worst = off, most = n;
        if (off > 3e-4 || e.error > 3e-3)
            printf("# index %g, alpha %g, cos %g, side %g, thin %u: %.5f +- %.1e\n", n, a, mu[(k + k / LENGTH(index)) % LENGTH(mu)], side, thin, e.mean, e.error);
        sheet.at.here = sheet.at.beyond = NULL;
    }
    ok(bad == 0 && worst < 3e-4 && error < 3e-3, "%u: with compensation nothing is lost, %u cases: off by %.1e beyond 4 standard errors of up to %.1e (index %g)",
       isa, cases, worst, error, most);
    free(here), free(beyond);
    sheet_fini(&sheet);
}

/* The same sum over uniform directions, and the density's: the midpoint rule in cosine and azimuth. */
static void test_compensation_uniform(void)
{
    static const struct {
        double index, alpha, mu, side;
        int thin;
    } cases[] = {{1.5, 1, 0.6, 1, 0}, {1.5, 1, 0.6, -1, 0}, {1.33, 0.6, 0.3, -1, 0}, {2.4, 0.7, 0.8, 1, 0}, {1.5, 0.8, 0.5, 1, 1}};

    for (uint32_t k = 0; k < LENGTH(cases); k++) {
        const double scale = cases[k].thin ? 1 : pow(cases[k].index, 2 * cases[k].side);
        double mass, z, sum = 0;
        struct sheet sheet;
        uint32_t lane = 0;

        init(&sheet, cases[k].side);
        set(&sheet, cases[k].index, cases[k].alpha, cases[k].thin), compensate(&sheet);
        sheet_view(&sheet, normal, cases[k].mu, 0.9);
        z = chi_square_over(&sheet, normal, 64, 500 + k, -1, &mass);
        ok(z <= 4 && mass <= 1.001, "%u: compensated, draws follow the density, case %u: chi-square z %.2f, mass %.4f", isa, k, z, mass);
        for (uint32_t fine = 0; fine < 2048 * 256; fine++) {
            sheet_toward(&sheet, lane, normal, -1 + 2 * (fine / 256 + 0.5) / 2048, 2 * M_PI * (fine % 256 + 0.5) / 256);
            if (++lane < LANES)
                continue;
            sheet_evaluate(&sheet);
            for (uint32_t i = 0; i < LANES; i++)
                sum += sheet.colour.g[i] * (fine / 256 < 1024 ? scale : 1) * 4 * M_PI / (2048.0 * 256);
            lane = 0;
        }
        ok(fabs(sum - 1) < 5e-4, "%u: compensated, by uniform directions, case %u: %.5f", isa, k, sum);
        sheet_fini(&sheet);
    }
}

/*
 * For radiance n_w^2 f(o, w) = n_o^2 f(w, o) across the interface, f(o, w) = f(w, o) on either side: to roundings, of which there are some 60, and which the cosines
 * at the facet and between the directions and the surface, differences of products up to 1, enlarge by their inverses; the smaller one at a facet that refracts
 * by its square, as on the other side it is the root of such a difference (see condition).
 */
static void test_reciprocity(double index, double alpha, int thin, int compensated)
{
    const double squared = thin ? 1 : index * index;
    double worst = 0;
    uint32_t pairs = 0;
    struct sheet a, b;

    init(&a, 1), init(&b, 1);
    set(&a, index, alpha, thin), set(&b, index, alpha, thin);
    if (compensated)
        compensate(&a), compensate(&b);
    for (int i = 0; i < 8 && thin; i++)
        a.copies[3 * TRANSMITTANCE + 1][i] = b.copies[3 * TRANSMITTANCE + 1][i] = 0.6;
    sheet_view(&a, normal, 0.7, 0.4);
    for (uint32_t i = 0; i < LANES; i++) {
        double w[3], in;
        unit_vector(300, i, w);
        in = w[0] * normal[0] + w[1] * normal[1] + w[2] * normal[2];
        a.toward.x[i] = w[0], a.toward.y[i] = w[1], a.toward.z[i] = w[2];
        b.toward.x[i] = a.at.ox[i], b.toward.y[i] = a.at.oy[i], b.toward.z[i] = a.at.oz[i];
        for (int c = 0; c < 3; c++) { /* the normals are on the side of the outgoing direction */
            double *n[3] = {(double *)b.at.nx, (double *)b.at.ny, (double *)b.at.nz}, *g[3] = {(double *)b.at.gx, (double *)b.at.gy, (double *)b.at.gz};
            double *o[3] = {(double *)b.at.ox, (double *)b.at.oy, (double *)b.at.oz};
            n[c][i] = g[c][i] = in < 0 ? -normal[c] : normal[c], o[c][i] = w[c];
        }
        ((double *)b.at.side)[i] = in < 0 ? -1 : 1;
    }
    sheet_evaluate(&a), sheet_evaluate(&b);
    for (uint32_t i = 0; i < LANES; i++) {
        double in = a.toward.x[i] * normal[0] + a.toward.y[i] * normal[1] + a.toward.z[i] * normal[2];
        double f = a.colour.g[i] / fabs(in), g = b.colour.g[i] / 0.7 / (in < 0 ? squared : 1);

        double hx = a.at.ox[i] + a.toward.x[i] * (in < 0 && !thin ? index : 1), hy = a.at.oy[i] + a.toward.y[i] * (in < 0 && !thin ? index : 1);
        double hz = a.at.oz[i] + a.toward.z[i] * (in < 0 && !thin ? index : 1), facet, small;

        facet = fabs(hx * a.at.ox[i] + hy * a.at.oy[i] + hz * a.at.oz[i]) / sqrt(hx * hx + hy * hy + hz * hz);
        small = fmin(fabs(in), in > 0 || thin ? 1 : facet * facet);
        worst = fmax(worst, f > 1e-200 ? fabs(f - g) / f * small : g);
        pairs += f > 0;
    }
    ok(pairs > 2000 && worst < 128 * U, "%u: reciprocal, index %g, alpha %g, thin %d, compensated %d: %u pairs, to 128 roundings (%.1f)", isa, index, alpha, thin,
       compensated, pairs, worst / U);
    sheet_fini(&a), sheet_fini(&b);
}

static void test_extremes(void)
{
    static const double index[] = {1e-3, 1 - 1e-6, 1, 1 + 1e-12, 1 + 1e-6, 1.5, 1e3, 1e6}, alpha[] = {0, 1e-7, 1e-4, 0.1, 1};
    static const double mu[] = {1e-320, 1e-90, 1e-8, 0.3, 1}, ends[] = {0, 0x1p-60, 0.5, 1 - U};
    uint32_t bad = 0, drawn = 0, heavy = 0, straight = 0;
    struct sheet sheet;

    init(&sheet, 1);
    for (uint32_t k = 0; k < LENGTH(index) * LENGTH(alpha) * LENGTH(mu) * (isa == MCR_ISA_BASELINE ? 4 : 2); k++) {
        double n = index[k % LENGTH(index)], a = alpha[k / LENGTH(index) % LENGTH(alpha)], c = mu[k / LENGTH(index) / LENGTH(alpha) % LENGTH(mu)];
        int thin = k / (LENGTH(index) * LENGTH(alpha) * LENGTH(mu)) % 2, several = k >= 2 * LENGTH(index) * LENGTH(alpha) * LENGTH(mu);

        set(&sheet, n, a, thin);
        if (several)
            compensate(&sheet);
        sheet_view(&sheet, upright, c, 5);
        sheet_numbers(&sheet, 310, k);
        for (uint32_t i = 0; i < 64; i++)
            sheet.number[0][i] = ends[i / 4 % 4], sheet.number[1][i] = ends[i % 4], sheet.number[2][i] = ends[i / 16];
        for (int delta = 0; delta < 2; delta++) {
            if (delta)
                sheet_delta(&sheet);
            else
                sheet_draw(&sheet), sheet_evaluate(&sheet);
            for (uint32_t i = 0; i < LANES; i++) {
                double x = sheet.toward.x[i], y = sheet.toward.y[i], z = sheet.toward.z[i], length = x * x + y * y + z * z, d = sheet.density[i];
                double scale = z < 0 && !thin ? n * n : 1;

                bad += !(isfinite(d) && d >= 0 && isfinite(sheet.colour.r[i]) && sheet.colour.r[i] >= 0);
                bad += length == 0 ? !delta && (d != 0 || sheet.colour.g[i] != 0) : !(fabs(length - 1) < 64 * U && d > 0);
                heavy += !several && length > 0 && sheet.colour.g[i] * scale > d * (1 + 1e-6);
                drawn += length > 0;
                straight += !delta && !several && n == 1 && !thin && z < 0 && fabs(z + c) < 1e-5 && fabs(sheet.colour.g[i] / d - 1) < 1e-3;
            }
        }
    }
    ok(bad == 0 && drawn > 500000, "%u: finite and unit at the extremes (%u wrong, %u drawn)", isa, bad, drawn);
    ok(heavy == 0, "%u: no weight above 1 at the extremes (%u)", isa, heavy);
    ok(straight > 10000, "%u: rough and of index 1, light passes straight on (%u)", isa, straight);
    sheet_fini(&sheet);
}

/* Any settings from lane to lane give what each gives alone. */
static uint64_t test_varying(void)
{
    struct sheet sheet, one;
    double *lane[3 * PARAMETERS], s[3 * PARAMETERS];
    uint32_t wrong = 0;
    uint64_t bits;

    init(&sheet, 1), init(&one, 1);
    for (uint32_t c = 0; c < 3 * PARAMETERS; c++) {
        lane[c] = numbers(LANES, 320 + c);
        sheet.channel[c] = lane[c];
        sheet.stride[c] = 1;
        for (uint32_t i = 0; i < LANES && c == 3 * INDEX; i++)
            lane[c][i] = 0.5 + floor(12 * lane[c][i]) / 6;
        for (uint32_t i = 0; i < LANES && (c == 3 * THIN || c == 3 * COMPENSATION); i++)
            lane[c][i] = lane[c][i] < (c == 3 * THIN ? 0.3 : 0.7);
    }
    bits = sheet_bits(&sheet);
    memcpy(one.toward.x, sheet.toward.x, LANES * sizeof(double));
    memcpy(one.toward.y, sheet.toward.y, LANES * sizeof(double));
    memcpy(one.toward.z, sheet.toward.z, LANES * sizeof(double));
    for (uint32_t i = 0; i < 60; i++) {
        for (uint32_t c = 0; c < 3 * PARAMETERS; c++)
            s[c] = lane[c][i];
        sheet_set(&one, s);
        sheet_evaluate(&one), sheet_density(&one);
        wrong += one.colour.r[i] != sheet.colour.r[i] || one.colour.g[i] != sheet.colour.g[i] || one.density[i] != sheet.density[i];
    }
    ok(wrong == 0, "%u: settings may vary from lane to lane", isa);
    sheet_delta(&sheet);
    for (uint32_t i = 0; i < LANES; i++)
        bits = mcr_mix64(bits + mcr_bits(sheet.toward.x[i]) + 3 * mcr_bits(sheet.colour.r[i]) + 5 * mcr_bits(sheet.density[i]));
    ok(guarded(sheet.colour.r, LANES) && guarded(sheet.colour.b, LANES) && guarded(sheet.density, LANES) && guarded(sheet.toward.z, LANES),
       "%u: nothing is written behind the lanes", isa);
    for (uint32_t c = 0; c < 3 * PARAMETERS; c++)
        free(lane[c]);
    sheet_fini(&sheet), sheet_fini(&one);
    return bits;
}

static void test_create(void)
{
    static const struct {
        double index, alpha, depth, transmittance;
        uint32_t thin, given_depth, given_transmittance, given_attenuation;
        int32_t status;
        uint32_t does;
    } cases[] = {{1.5, 0, 1, 1, 0, 0, 0, 0, 0, MCR_MATERIAL_DELTA | MCR_MATERIAL_INTERIOR},
                 {1.5, 0.2, 1, 1, 0, 0, 0, 0, 0, MCR_MATERIAL_REFLECTS | MCR_MATERIAL_TRANSMITS | MCR_MATERIAL_INTERIOR},
                 {1.5, 0, 1, 1, 1, 0, 1, 0, 0, MCR_MATERIAL_DELTA | MCR_MATERIAL_THIN},
                 {1.5, 0, 2, 0.25, 0, 1, 1, 0, 0, MCR_MATERIAL_DELTA | MCR_MATERIAL_INTERIOR},
                 {1.5, 0, 1, 1, 1, 0, 0, 1, -1, 0},
                 {1.5, 0, 1, 1, 0, 0, 1, 1, -1, 0},
                 {1.5, 0, 1, 1, 0, 1, 0, 0, -1, 0},
                 {1.5, 0, 1e-320, 0.5, 0, 1, 1, 0, -1, 0}};
    uint32_t wrong = 0;

    for (uint32_t k = 0; k < LENGTH(cases); k++) {
        double s[3 * PARAMETERS];
        uint32_t given[PARAMETERS] = {1, 1, 1, cases[k].given_transmittance, cases[k].given_depth, cases[k].given_attenuation, 0};
        struct mcr_values values = {sizeof values, PARAMETERS, s, given};
        struct mcr_creation with = {sizeof with, 0, &values, NULL, NULL, 16, 0};
        struct mcr_material_traits traits = {.size = sizeof traits};
        struct mcr_context context = {.message = ""};
        void *instance;

        settings_of(s, cases[k].index, cases[k].alpha, (int)cases[k].thin);
        s[3 * DEPTH] = cases[k].depth, s[3 * TRANSMITTANCE] = cases[k].transmittance;
        wrong += plugin->create(&stand_in, &context, &with, &instance) != cases[k].status || (context.message[0] != 0) != (cases[k].status < 0);
        if (cases[k].status)
            continue;
        plugin->traits(&stand_in, &context, instance, &values, &traits);
        wrong += traits.does != cases[k].does || (!cases[k].thin && traits.index != 1.5);
        wrong += fabs(traits.attenuation[0] - (cases[k].given_depth ? -log(cases[k].transmittance) / cases[k].depth : 0)) > 1e-15;
    }
    ok(wrong == 0, "%u: what the material does; a setting that would be ignored is an error (%u)", isa, wrong);
}

static void test_mirror(const struct mcr_material_plugin *mirror)
{
    double s[3] = {0.2, 0.5, 0.9};
    uint32_t wrong = 0, black = 0;
    struct sheet sheet;

    sheet_init(&sheet, mirror, LANES, s);
    for (uint32_t i = 0; i < LANES; i++) {
        double w[3];
        unit_vector(340, i, w);
        ((double *)sheet.at.ox)[i] = w[0], ((double *)sheet.at.oy)[i] = w[1], ((double *)sheet.at.oz)[i] = w[2];
    }
    sheet_delta(&sheet);
    for (uint32_t i = 0; i < LANES; i++) {
        const struct mcr_points *at = &sheet.at;
        double c = at->nx[i] * at->ox[i] + at->ny[i] * at->oy[i] + at->nz[i] * at->oz[i], x = 2 * c * at->nx[i] - at->ox[i];
        double y = 2 * c * at->ny[i] - at->oy[i], z = 2 * c * at->nz[i] - at->oz[i];
        int seen = c > 0 && at->gx[i] * x + at->gy[i] * y + at->gz[i] * z > 0;

        wrong += sheet.density[i] != 1 || (seen ? fabs(sheet.toward.x[i] - x) + fabs(sheet.toward.y[i] - y) + fabs(sheet.toward.z[i] - z) > 16 * U
                                                : sheet.toward.x[i] != 0 || sheet.toward.y[i] != 0 || sheet.toward.z[i] != 0);
        wrong += sheet.colour.r[i] != seen * 0.2 || sheet.colour.g[i] != seen * 0.5 || sheet.colour.b[i] != seen * 0.9;
        black += c > 0 && !seen;
    }
    ok(wrong == 0 && black > 10, "%u: mirror: reflects, but not below either horizon (%u, %u)", isa, wrong, black);
    ok(guarded(sheet.colour.r, LANES) && guarded(sheet.density, LANES) && guarded(sheet.toward.z, LANES), "%u: mirror: nothing behind the lanes", isa);
    sheet_fini(&sheet);
}

int main(void)
{
    const struct mcr_plugin *file = load("dielectric"), *other = load("mirror");
    uint64_t first = 0, bits;

    for (isa = MCR_ISA_AVX512; !(plugin = descriptor_of(file, isa)); isa--) /* the fastest; the others have its bits */
        ;
    test_rough();
    test_compensation();
    test_compensation_uniform();
    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        plugin = descriptor_of(file, isa);
        if (!plugin) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        test_fresnel();
        test_known();
        test_reciprocity(1.5, 0.4, 0, 0);
        test_reciprocity(1.5, 0.4, 0, 1);
        test_reciprocity(2.4, 0.9, 0, 1);
        test_reciprocity(0.8, 0.7, 1, 1);
        test_extremes();
        test_create();
        test_mirror(descriptor_of(other, isa));
        bits = test_varying();
        first = isa == MCR_ISA_BASELINE ? bits : first;
        ok(bits == first, "%u: the bits of the baseline", isa);
    }
    return tap_done();
}
