/* SPDX-License-Identifier: Apache-2.0 */
/* dielectric and mirror: Fresnel's formulas, Snell's law, slabs with a known answer, energy, sampling and the extremes of index, roughness and angle. */
#include "facets.h"

#define LANES 4096u
#define U 0x1p-53
#define LENGTH(x) (sizeof(x) / sizeof *(x))

enum { INDEX, ROUGHNESS, THIN, TRANSMITTANCE, DEPTH, ATTENUATION, PRIORITY, PARAMETERS };

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
            worst = fmax(worst, fabs(a[4] - exact) / exact), sum = fmax(sum, fabs(a[3] - a[4]));
            turned = fmax(turned, fabs(a[0] + sheet.at.ox[0]) + fabs(a[1] + sheet.at.oy[0]) + fabs(a[2] - sheet.at.oz[0]));
            if (exact == 1) { /* total reflection: the only lobe */
                turned = fmax(turned, fabs(a[3] - 1) + fabs(b[2] - mu[m]));
                continue;
            }
            sum = fmax(sum, fabs(a[3] + b[3] - 1) + fabs(b[4] * n * n - b[3]));
            snell = fmax(snell, fabs(b[0] * n + sheet.at.ox[0]) + fabs(b[1] * n + sheet.at.oy[0]) + fabs(hypot(hypot(b[0], b[1]), b[2]) - 1));
            snell = fmax(snell, b[2] < 0 ? 0 : 1);
        }
    ok(worst < 1e-9, "%u: Fresnel's formulas to 1e-9 (%.1e)", isa, worst);
    ok(sum < 1e-12, "%u: the lobes' probabilities are their shares; 1/n^2 of the radiance is refracted (%.1e)", isa, sum);
    ok(snell < 1e-12 && turned < 1e-14, "%u: Snell's law, the mirror's, total reflection (%.1e, %.1e)", isa, snell, turned);
    sheet_view(&sheet, upright, 1, 0);
    for (uint32_t k = 0; k < LENGTH(steep); k++) {
        long double n = steep[k], exact = (n - 1) * (n - 1) / ((n + 1) * (n + 1));

        set(&sheet, steep[k], 0, 0);
        lobes(&sheet, a, b);
        normal_error = fmax(normal_error, fabs((double)(a[4] / exact - 1)));
    }
    ok(normal_error < 1e-6, "%u: ((n - 1) / (n + 1))^2 at normal incidence, down to n - 1 = 1e-9 (%.1e)", isa, normal_error);
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

/*
 * Rough: draws follow the density over the whole sphere; energy, weighing what is refracted by n^2, is at most 1 and close to it where little is lost;
 * what is reflected is that of the smooth surface as roughness goes to 0. The integral by uniform directions is the one by own sampling.
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
        double mass, z, energy = 0, scale, sum = 0, squares = 0, grid = 0, error, reflected = 0;
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

                bad += !isfinite(value) || value < 0 || weighed > 1 + 1e-9;
                energy += weighed / (64.0 * LANES), sum += value / (64.0 * LANES), squares += value * value / (64.0 * LANES);
                reflected += below > 0 ? value / (64.0 * LANES) : 0;
            }
        }
        ok(bad == 0 && energy <= 1 + 1e-9 && energy > 0.5, "%u: energy %.4f, no weight above 1", isa, energy);
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

/* For radiance n_w^2 f(o, w) = n_o^2 f(w, o) across the interface, f(o, w) = f(w, o) on either side. */
static void test_reciprocity(void)
{
    double worst = 0;
    uint32_t pairs = 0;
    struct sheet a, b;

    init(&a, 1), init(&b, 1);
    set(&a, 1.5, 0.4, 0), set(&b, 1.5, 0.4, 0);
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
        double f = a.colour.g[i] / fabs(in), g = b.colour.g[i] / 0.7 / (in < 0 ? 1.5 * 1.5 : 1);

        worst = fmax(worst, f > 1e-200 ? fabs(f - g) / f : g);
        pairs += f > 0;
    }
    ok(pairs > 2000 && worst < 1e-9, "%u: reciprocal, %u pairs (%.1e)", isa, pairs, worst);
    sheet_fini(&a), sheet_fini(&b);
}

static void test_extremes(void)
{
    static const double index[] = {1e-3, 1 - 1e-6, 1, 1 + 1e-12, 1 + 1e-6, 1.5, 1e3, 1e6}, alpha[] = {0, 1e-7, 1e-4, 0.1, 1};
    static const double mu[] = {1e-320, 1e-90, 1e-8, 0.3, 1}, ends[] = {0, 0x1p-60, 0.5, 1 - U};
    uint32_t bad = 0, drawn = 0, heavy = 0, straight = 0;
    struct sheet sheet;

    init(&sheet, 1);
    for (uint32_t k = 0; k < LENGTH(index) * LENGTH(alpha) * LENGTH(mu) * 2; k++) {
        double n = index[k % LENGTH(index)], a = alpha[k / LENGTH(index) % LENGTH(alpha)], c = mu[k / LENGTH(index) / LENGTH(alpha) % LENGTH(mu)];
        int thin = k >= LENGTH(index) * LENGTH(alpha) * LENGTH(mu);

        set(&sheet, n, a, thin);
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
                heavy += length > 0 && sheet.colour.g[i] * scale > d * (1 + 1e-6);
                drawn += length > 0;
                straight += !delta && n == 1 && !thin && z < 0 && fabs(z + c) < 1e-5 && fabs(sheet.colour.g[i] / d - 1) < 1e-3;
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
        for (uint32_t i = 0; i < LANES && (c == 3 * INDEX || c == 3 * THIN); i++)
            lane[c][i] = c == 3 * INDEX ? 0.5 + 2 * lane[c][i] : lane[c][i] < 0.3;
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
                 {1.5, 0, 1, 1, 1, 0, 1, 0, 0, MCR_MATERIAL_DELTA},
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

    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        plugin = descriptor_of(file, isa);
        if (!plugin) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        if (isa == MCR_ISA_BASELINE) /* the others have its bits */
            test_rough();
        test_fresnel();
        test_known();
        test_reciprocity();
        test_extremes();
        test_create();
        test_mirror(descriptor_of(other, isa));
        bits = test_varying();
        first = isa == MCR_ISA_BASELINE ? bits : first;
        ok(bits == first, "%u: the bits of the baseline", isa);
    }
    return tap_done();
}
