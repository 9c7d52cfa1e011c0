/* SPDX-License-Identifier: Apache-2.0 */
/* oren-nayar: the model's formulas, its albedo, the white furnace, lambert where sigma is 0, sampling, and the extremes. */
#include "facets.h"

#define LANES 4096u
#define U 0x1p-53
#define LENGTH(x) (sizeof(x) / sizeof *(x))

enum { ALBEDO, SIGMA };

static const double normal[3] = {0.48, -0.6, 0.64}, upright[3] = {0, 0, 1}; /* cosines to the latter are exact */
static const double sigmas[] = {0, 1e-9, 0.1, 0.5, 1}, cosines[] = {1, 0.7, 0.3, 0.05};
static uint32_t isa;
static const struct mcr_material_plugin *plugin;

static void set(struct sheet *sheet, double albedo, double sigma)
{
    const double s[15] = {albedo / 2, albedo, 0, sigma};

    sheet_set(sheet, s);
}

static void init(struct sheet *sheet)
{
    static const double s[15] = {0.25, 0.5, 0, 0.5};

    sheet_init(sheet, plugin, LANES, s);
}

/* The paper's functions as it writes them: the albedo of single scattering, its mean, and f cos. */
static double single_albedo(double sigma, double mu)
{
    double s = sqrt(1 - mu * mu), g = s * (acos(mu) - s * mu) + 2.0 / 3 * (s / mu * (1 - s * s * s) - s), a = 1 / (1 + (0.5 - 2 / (3 * M_PI)) * sigma);

    return a * (1 + sigma * g / M_PI);
}

static double multiple_albedo(double albedo, double sigma, double *mean)
{
    *mean = (1 + (2.0 / 3 - 28 / (15 * M_PI)) * sigma) / (1 + (0.5 - 2 / (3 * M_PI)) * sigma);
    return albedo * albedo * *mean / (1 - albedo * (1 - *mean));
}

static double model(double albedo, double sigma, const double n[3], const double o[3], const double w[3])
{
    double in = 0, out = 0, s = 0, a = 1 / (1 + (0.5 - 2 / (3 * M_PI)) * sigma), mean, more = multiple_albedo(albedo, sigma, &mean);

    for (int c = 0; c < 3; c++)
        in += n[c] * w[c], out += n[c] * o[c], s += o[c] * w[c];
    s -= in * out;
    return in / M_PI * (albedo * a * (1 + sigma * s / (s > 0 ? fmax(in, out) : 1)) +
                        more * (1 - single_albedo(sigma, in)) * (1 - single_albedo(sigma, out)) / (1 - mean));
}

static void test_formula(void)
{
    double worst = 0, reciprocal = 0;
    uint32_t seen = 0;
    struct sheet sheet;

    init(&sheet);
    for (uint32_t k = 2; k < LENGTH(sigmas); k++)
        for (uint32_t m = 0; m < LENGTH(cosines); m++) {
            set(&sheet, 0.8, sigmas[k]);
            sheet_view(&sheet, normal, cosines[m], 1.3);
            for (uint32_t i = 0; i < LANES; i++)
                sheet_toward(&sheet, i, normal, 1e-3 + 0.999 * fixed(200, i), 2 * M_PI * fixed(201, i));
            sheet_evaluate(&sheet);
            for (uint32_t i = 0; i < LANES; i++) {
                double o[3] = {sheet.at.ox[i], sheet.at.oy[i], sheet.at.oz[i]}, w[3] = {sheet.toward.x[i], sheet.toward.y[i], sheet.toward.z[i]};
                double exact = model(0.8, sigmas[k], normal, o, w), back = model(0.8, sigmas[k], normal, w, o);
                double in = normal[0] * w[0] + normal[1] * w[1] + normal[2] * w[2], out = normal[0] * o[0] + normal[1] * o[1] + normal[2] * o[2];

                seen++;
                worst = fmax(worst, fabs(sheet.colour.g[i] / exact - 1));
                reciprocal = fmax(reciprocal, fabs(sheet.colour.g[i] / in * out / back - 1));
            }
        }
    ok(seen > 0 && worst <= 1e-11, "%u: the paper's formulas to 1e-11 (%.1e)", isa, worst); /* they lose digits to cancellation */
    ok(reciprocal <= 1e-11, "%u: reciprocal to the same (%.1e)", isa, reciprocal);
    sheet_fini(&sheet);
}

/* f(o, i) = f(i, o) by the plugin alone, at random directions of both. */
static void test_reciprocity(void)
{
    struct sheet a, b;
    double worst = 0;
    uint32_t pairs = 0;

    init(&a), init(&b);
    set(&a, 0.9, 0.7), set(&b, 0.9, 0.7);
    sheet_view(&a, normal, 1, 0), sheet_view(&b, normal, 1, 0);
    for (uint32_t i = 0; i < LANES; i++) {
        sheet_toward(&a, i, normal, fixed(210, i), 6 * fixed(211, i)), sheet_toward(&b, i, normal, fixed(212, i), 6 * fixed(213, i));
        ((double *)a.at.ox)[i] = b.toward.x[i], ((double *)a.at.oy)[i] = b.toward.y[i], ((double *)a.at.oz)[i] = b.toward.z[i];
        ((double *)b.at.ox)[i] = a.toward.x[i], ((double *)b.at.oy)[i] = a.toward.y[i], ((double *)b.at.oz)[i] = a.toward.z[i];
    }
    sheet_evaluate(&a), sheet_evaluate(&b);
    for (uint32_t i = 0; i < LANES; i++) {
        double in = normal[0] * a.toward.x[i] + normal[1] * a.toward.y[i] + normal[2] * a.toward.z[i];
        double out = normal[0] * b.toward.x[i] + normal[1] * b.toward.y[i] + normal[2] * b.toward.z[i];
        pairs += a.colour.g[i] > 0;
        worst = fmax(worst, fabs(a.colour.g[i] / in / (b.colour.g[i] / out) - 1));
    }
    ok(pairs == LANES && worst <= 8 * U, "%u: reciprocal to rounding (%.1f u)", isa, worst / U);
    sheet_fini(&a), sheet_fini(&b);
}

/* sigma 0: the bits of lambert, and its draws. */
static void test_lambert(void)
{
    const struct mcr_material_plugin *lambert = descriptor_of(load("lambert"), isa);
    uint32_t differ = 0, seen = 0;
    struct sheet a, b;
    static const double half[15] = {0.25, 0.5, 0, 0};

    sheet_init(&a, plugin, LANES, half), sheet_init(&b, lambert, LANES, half);
    sheet_numbers(&a, 220, 0), sheet_numbers(&b, 220, 0);
    sheet_draw(&a), sheet_draw(&b);
    for (int k = 0; k < 2; k++) {
        for (uint32_t i = 0; i < LANES && k == 1; i++) {
            double w[3];
            unit_vector(221, i, w);
            a.toward.x[i] = b.toward.x[i] = w[0], a.toward.y[i] = b.toward.y[i] = w[1], a.toward.z[i] = b.toward.z[i] = w[2];
        }
        sheet_density(&a), sheet_density(&b), sheet_evaluate(&a), sheet_evaluate(&b);
        for (uint32_t i = 0; i < LANES; i++) {
            seen += a.colour.g[i] > 0;
            differ += a.toward.x[i] != b.toward.x[i] || a.density[i] != b.density[i] || a.colour.r[i] != b.colour.r[i] || a.colour.g[i] != b.colour.g[i];
        }
    }
    ok(seen > LANES && differ == 0, "%u: with sigma 0 every result is lambert's, to the bit", isa);
    sheet_fini(&a), sheet_fini(&b);
}

/* Directional albedo: closed form albedo E + m (1 - E), quadrature, and own sampling; 1 where the albedo is. */
static void test_albedo(void)
{
    static const double albedos[] = {0.5, 1};
    struct sheet sheet;

    init(&sheet);
    for (uint32_t k = 0; k < LENGTH(sigmas); k++)
        for (uint32_t m = 0; m < LENGTH(cosines); m++)
            for (uint32_t a = 0; a < LENGTH(albedos); a++) {
                double mean, more = multiple_albedo(albedos[a], sigmas[k], &mean), e = single_albedo(sigmas[k], cosines[m]), mass;
                double exact = albedos[a] == 1 ? 1 : albedos[a] * e + more * (1 - e), grid;
                struct estimate drawn;

                set(&sheet, albedos[a], sigmas[k]);
                sheet_view(&sheet, normal, cosines[m], 1.3);
                grid = albedo_uniform(&sheet, normal, 512, 512, &mass);
                drawn = albedo_drawn(&sheet, 128, 230 + 8 * k + 2 * m + a);
                /* The midpoint rule errs by 1e-5, a quarter with steps halved; less for sigma 0, whose f cos is linear in the cosine. */
                ok(fabs(grid - exact) < 2e-5, "%u: albedo %g, sigma %g, cos %g: %.6f, off by %.1e", isa, albedos[a], sigmas[k], cosines[m], exact,
                   grid - exact);
                ok(fabs(mass - 1) < 2e-5, "%u: the density integrates to 1 (%.1e)", isa, mass - 1);
                ok(drawn.error < 0.001 * exact && fabs(drawn.mean - exact) <= 4 * drawn.error + LANES * 128 * U && drawn.bad == 0,
                   "%u: by own sampling: %.6f +- %.6f, z %.2f", isa, drawn.mean, drawn.error, (drawn.mean - exact) / (drawn.error + LANES * 128 * U));
                ok(drawn.most < 4, "%u: no weight above 4 (%.2f)", isa, drawn.most);
            }
    sheet_fini(&sheet);
}

static void test_draw(void)
{
    struct sheet sheet;

    init(&sheet);
    for (uint32_t k = 0; k < LENGTH(sigmas); k += 2)
        for (uint32_t m = 0; m < LENGTH(cosines); m++) {
            double mass, z;

            set(&sheet, 0.5, sigmas[k]);
            sheet_view(&sheet, normal, cosines[m], 2.1);
            z = chi_square(&sheet, normal, 64, 400 + 3 * k + m, &mass);
            ok(z <= 4, "%u: draws follow the density, sigma %g, cos %g: chi-square z %.2f", isa, sigmas[k], cosines[m], z);
        }
    sheet_fini(&sheet);
}

/* Grazing views, also of exactly 0 and from below; directions everywhere, and close to both horizons. */
static void test_extremes(void)
{
    static const double mu[] = {-0.5, 0, 1e-320, 1e-16, 1e-8, 1}, sigma[] = {0, 1e-300, 1e-9, 1}, albedos[] = {0, 1e-300, 1};
    uint32_t bad = 0;
    struct sheet sheet;

    init(&sheet);
    for (uint32_t k = 0; k < LENGTH(sigma) * LENGTH(mu) * LENGTH(albedos); k++) {
        set(&sheet, albedos[k % 3], sigma[k / 3 % 4]);
        sheet_view(&sheet, upright, mu[k / 12], 1.3);
        for (uint32_t i = 0; i < LANES; i++) {
            double w[3];
            unit_vector(240, i, w);
            if (i % 2)
                sheet_toward(&sheet, i, upright, mu[i / 2 % 6], 1.3 + (i / 12 % 2 ? 0 : M_PI));
            else
                sheet.toward.x[i] = w[0], sheet.toward.y[i] = w[1], sheet.toward.z[i] = w[2];
        }
        sheet_density(&sheet), sheet_evaluate(&sheet);
        for (uint32_t i = 0; i < LANES; i++) {
            double in = upright[0] * sheet.toward.x[i] + upright[1] * sheet.toward.y[i] + upright[2] * sheet.toward.z[i], f = sheet.colour.g[i];

            bad += !(isfinite(f) && f >= 0 && f < 2 && isfinite(sheet.density[i]) && sheet.density[i] >= 0);
            bad += in <= 0 && (f != 0 || sheet.density[i] != 0);
            bad += in > 0 && !(sheet.density[i] > 0);
        }
    }
    ok(bad == 0, "%u: finite at the extremes (%u wrong)", isa, bad);
    sheet_fini(&sheet);
}

static uint64_t test_varying(void)
{
    struct sheet sheet, one;
    double *lane[6];
    uint32_t wrong = 0;
    uint64_t bits;

    init(&sheet), init(&one);
    for (uint32_t c = 0; c < 6; c++) {
        lane[c] = numbers(LANES, 800 + c);
        sheet.channel[c] = lane[c];
        sheet.stride[c] = 1;
    }
    bits = sheet_bits(&sheet);
    memcpy(one.toward.x, sheet.toward.x, LANES * sizeof(double));
    memcpy(one.toward.y, sheet.toward.y, LANES * sizeof(double));
    memcpy(one.toward.z, sheet.toward.z, LANES * sizeof(double));
    for (uint32_t i = 0; i < 60; i++) {
        double s[15] = {lane[0][i], lane[1][i], lane[2][i], lane[3][i]};
        sheet_set(&one, s);
        sheet_evaluate(&one), sheet_density(&one);
        wrong += one.colour.r[i] != sheet.colour.r[i] || one.colour.g[i] != sheet.colour.g[i] || one.colour.b[i] != sheet.colour.b[i];
        wrong += one.density[i] != sheet.density[i];
    }
    ok(wrong == 0, "%u: settings may vary from lane to lane", isa);
    ok(guarded(sheet.colour.r, LANES) && guarded(sheet.colour.b, LANES) && guarded(sheet.density, LANES) && guarded(sheet.toward.z, LANES),
       "%u: nothing is written behind the lanes", isa);
    for (uint32_t c = 0; c < 6; c++)
        free(lane[c]);
    sheet_fini(&sheet), sheet_fini(&one);
    return bits;
}

int main(void)
{
    const struct mcr_plugin *file = load("oren-nayar");
    uint64_t first = 0, bits;

    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        plugin = descriptor_of(file, isa);
        if (!plugin) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        ok(plugin->flags == MCR_MATERIAL_STATELESS, "%u: stateless", isa);
        if (isa == MCR_ISA_BASELINE) { /* the others have its bits */
            test_albedo();
            test_draw();
        }
        test_formula();
        test_reciprocity();
        test_lambert();
        test_extremes();
        bits = test_varying();
        first = isa == MCR_ISA_BASELINE ? bits : first;
        ok(bits == first, "%u: the bits of the baseline", isa);
    }
    return tap_done();
}
