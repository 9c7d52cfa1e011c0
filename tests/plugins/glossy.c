/* SPDX-License-Identifier: Apache-2.0 */
/* glossy: no light lost under smooth and rough coats, reciprocity, sampling, colours, extremes. */
#include "facets.h"

#define LANES 4096u
#define U 0x1p-53
#define LENGTH(x) (sizeof(x) / sizeof *(x))

enum { ALBEDO, INDEX, ROUGHNESS, PARAMETERS };

static const double normal[3] = {0.48, -0.6, 0.64};
static uint32_t isa;
static const struct mcr_material_plugin *plugin;

static void make(struct sheet *sheet, double albedo, double index, double alpha)
{
    double s[3 * PARAMETERS] = {albedo, albedo, albedo, index, 0, 0, alpha};
    uint32_t given[PARAMETERS] = {0};
    struct mcr_values values = {sizeof values, PARAMETERS, s, given};
    struct mcr_creation with = {sizeof with, 0, &values, NULL, NULL, 16, 0};
    void *instance = NULL;

    plugin->create(&stand_in, NULL, &with, &instance);
    sheet_init(sheet, plugin, LANES, s);
    sheet->instance = instance;
}

static void unmake(struct sheet *sheet)
{
    plugin->destroy(sheet->instance);
    sheet_fini(sheet);
}

/* What is scattered in all: by delta lobes and by directions of own sampling. */
static struct estimate scattered(struct sheet *sheet, int smooth, uint32_t batches, uint64_t stream)
{
    struct estimate e = {0};
    double sum = 0, squares = 0, count = (double)batches * LANES, *lobe = array(LANES), *chance = array(LANES);

    for (uint32_t k = 0; k < batches; k++) {
        for (uint32_t i = 0; i < LANES; i++)
            lobe[i] = 0, chance[i] = 1;
        sheet_numbers(sheet, stream + 50, k);
        if (smooth) {
            sheet_delta(sheet);
            for (uint32_t i = 0; i < LANES; i++) {
                int chosen = sheet->toward.x[i] != 0 || sheet->toward.y[i] != 0 || sheet->toward.z[i] != 0;
                lobe[i] = chosen ? sheet->colour.g[i] / sheet->density[i] : 0;
                chance[i] = chosen ? 0 : sheet->density[i];
            }
        }
        sheet_numbers(sheet, stream, k);
        sheet_draw(sheet), sheet_evaluate(sheet);
        for (uint32_t i = 0; i < LANES; i++) {
            double value = sheet->density[i] > 0 ? sheet->colour.g[i] / sheet->density[i] : 0, all = chance[i] > 0 ? value / chance[i] : lobe[i];

            e.bad += !isfinite(value) || value < 0;
            e.most = fmax(e.most, all);
            sum += all, squares += all * all;
        }
    }
    free(lobe), free(chance);
    e.mean = sum / count;
    e.error = sqrt(fmax(squares / count - e.mean * e.mean, 0) / (count - 1));
    return e;
}

static void test_furnace(void)
{
    static const double index[] = {1, 1.2, 1.5, 2.5}, alpha[] = {0, 0.02, 0.1, 0.3, 0.6, 1}, mu[] = {1, 0.6, 0.25, 0.06};
    double worst = 0, sharp = 0;
    uint32_t off = 0, bad = 0;

    for (uint32_t k = 0; k < LENGTH(index) * LENGTH(alpha); k++) {
        struct sheet sheet;

        make(&sheet, 1, index[k % LENGTH(index)], alpha[k / LENGTH(index)]);
        for (uint32_t m = 0; m < LENGTH(mu); m++) {
            struct estimate e;

            sheet_view(&sheet, normal, mu[m], 0.7);
            e = scattered(&sheet, k < LENGTH(index), 24, 100 + 4 * k + m);
            if (fabs(e.mean - 1) > 1e-3 + 4 * e.error)
                printf("# index %g, alpha %g, cos %g: %.5f +- %.5f\n", index[k % LENGTH(index)], alpha[k / LENGTH(index)], mu[m], e.mean, e.error), off++;
            worst = fmax(worst, fabs(e.mean - 1)), sharp = fmax(sharp, e.error), bad += e.bad;
        }
        unmake(&sheet);
    }
    ok(off == 0 && bad == 0 && sharp < 6e-3, "%u: white loses no light (%.1e off, standard errors up to %.1e)", isa, worst, sharp);
}

static void test_draw(void)
{
    static const double alpha[] = {0, 0.3, 0.7}, mu[] = {0.9, 0.2};

    for (uint32_t a = 0; a < LENGTH(alpha); a++) {
        struct sheet sheet;

        make(&sheet, 0.3, 1.5, alpha[a]);
        for (uint32_t m = 0; m < LENGTH(mu); m++) {
            double mass, z;

            sheet_view(&sheet, normal, mu[m], 0.7);
            z = chi_square(&sheet, normal, 48, 200 + 4 * a + m, &mass);
            ok(z <= 4, "%u: draws follow the density, alpha %g, cos %g: chi-square z %.2f", isa, alpha[a], mu[m], z);
        }
        unmake(&sheet);
    }
}

/* A smooth coat over black is Fresnel's mirror; a base of albedo a under it shows a (1 - F) (1 - F) / (n^2 (1 - a k)), k = 1 - (1 - <F>) / n^2. */
static void test_known(void)
{
    const double mean = .091777959342, f45 = .050239911012, f60 = .089186712802, k = 1 - (1 - mean) / 2.25; /* S22 */
    double exact = 0.4 * (1 - f45) * (1 - f60) / (2.25 * (1 - 0.4 * k)) * 0.5 / M_PI;
    struct sheet sheet;

    make(&sheet, 0.4, 1.5, 0);
    sheet_view(&sheet, normal, sqrt(0.5), 0.7);
    sheet_toward(&sheet, 0, normal, 0.5, 2.9);
    sheet_evaluate(&sheet);
    ok(fabs(sheet.colour.g[0] / exact - 1) < 1e-5, "%u: the base under a smooth coat (%.1e)", isa, sheet.colour.g[0] / exact - 1);
    sheet.number[0][0] = 0;
    sheet_delta(&sheet);
    ok(fabs(sheet.colour.g[0] - f45) < 1e-12, "%u: a smooth coat's mirror has the share S22", isa);
    unmake(&sheet);
}

static void test_reciprocity(void)
{
    double worst = 0;
    struct sheet sheet;

    make(&sheet, 0.7, 1.5, 0.2);
    for (uint32_t i = 0; i < 64; i++) {
        double a = 0.05 + 0.95 * fixed(300, i), b = 0.05 + 0.95 * fixed(301, i), phi = 2 * M_PI * fixed(302, i), f, g;

        sheet_view(&sheet, normal, a, 0), sheet_toward(&sheet, 0, normal, b, phi), sheet_evaluate(&sheet);
        f = sheet.colour.g[0] / b;
        sheet_view(&sheet, normal, b, phi), sheet_toward(&sheet, 0, normal, a, 0), sheet_evaluate(&sheet);
        g = sheet.colour.g[0] / a;
        worst = fmax(worst, fabs(f - g) / f);
    }
    ok(worst < 1e-12, "%u: reciprocal (%.1e)", isa, worst);
    unmake(&sheet);
}

static uint64_t test_extremes(void)
{
    static const double index[] = {1, 1 + 1e-6, 1.5, 1e3}, alpha[] = {0, 1e-12, 1e-7, 1e-3, 1}, mu[] = {1e-320, 1e-8, 0.5, 1};
    uint32_t bad = 0;
    uint64_t bits = 0;

    for (uint32_t k = 0; k < LENGTH(index) * LENGTH(alpha); k++) {
        struct sheet sheet;

        make(&sheet, k % 3 ? 1 : 0, index[k % LENGTH(index)], alpha[k / LENGTH(index)]);
        for (uint32_t m = 0; m < LENGTH(mu); m++) {
            sheet_view(&sheet, normal, mu[m], 0.7);
            sheet_numbers(&sheet, 310, k);
            for (int step = 0; step < 2; step++) {
                if (step)
                    sheet_delta(&sheet);
                else
                    bits = mcr_mix64(bits + sheet_bits(&sheet));
                for (uint32_t i = 0; i < LANES; i++)
                    bad += !isfinite(sheet.colour.g[i]) || !(sheet.colour.g[i] >= 0) || !isfinite(sheet.density[i]) || sheet.density[i] < 0;
                bits = mcr_mix64(bits + mcr_bits(sheet.colour.g[LANES / 2]) + mcr_bits(sheet.toward.x[7]));
            }
        }
        bad += !guarded(sheet.colour.r, LANES) || !guarded(sheet.density, LANES) || !guarded(sheet.toward.z, LANES);
        unmake(&sheet);
    }
    ok(bad == 0, "%u: finite at the extremes, nothing written behind the lanes (%u)", isa, bad);
    return bits;
}

int main(void)
{
    const struct mcr_plugin *file = load("glossy");
    uint64_t first = 0, bits;

    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        plugin = descriptor_of(file, isa);
        if (!plugin) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        if (isa == MCR_ISA_BASELINE) { /* the others have its bits */
            test_furnace();
            test_draw();
        }
        test_known();
        test_reciprocity();
        bits = test_extremes();
        first = isa == MCR_ISA_BASELINE ? bits : first;
        ok(bits == first, "%u: the bits of the baseline", isa);
    }
    return tap_done();
}
