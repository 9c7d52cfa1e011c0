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

/*
 * What white keeps of its light: the coat's reflection, of a black base by its own sampling or of a smooth coat's lobe, and what evaluate tells more of a
 * white base, by the midpoint rule over 1024 cosines. The rules err by 2e-5 at most: a quarter with half the steps.
 */
static double kept(struct sheet *white, struct sheet *black, int smooth, double mu, uint32_t *bad)
{
    double mass, coat;

    sheet_view(white, normal, mu, 0.7), sheet_view(black, normal, mu, 0.7);
    if (smooth) {
        white->number[0][0] = 0;
        sheet_delta(white);
        coat = white->colour.g[0];
    } else {
        struct estimate e = albedo_numbers(black, 256);
        coat = e.mean;
        *bad += e.bad;
    }
    return coat + albedo_uniform(white, normal, 1024, 4, &mass) - albedo_uniform(black, normal, 1024, 4, &mass);
}

/* As the manual says, white loses no light but for 0.02 % up to index 4, 0.04 % up to 20, 1 % up to 1000. */
static void test_furnace(void)
{
    static const double index[] = {1, 1.05, 1.5, 4, 20, 1000}, alpha[] = {0, 1e-4, 0.003, 0.02, 0.1, 0.4, 1}, mu[] = {1, 0.6, 0.25, 0.06, 0.01};
    double worst[3] = {0, 0, 0};
    uint32_t bad = 0;

    for (uint32_t k = 0; k < LENGTH(index) * LENGTH(alpha); k++) {
        double n = index[k % LENGTH(index)], a = alpha[k / LENGTH(index)];
        struct sheet white, black;

        make(&white, 1, n, a), make(&black, 0, n, a);
        for (uint32_t m = 0; m < LENGTH(mu); m++) {
            double *of = &worst[n <= 4 ? 0 : n <= 20 ? 1 : 2], off = fabs(kept(&white, &black, a == 0, mu[m], &bad) - 1);
            if (off > (n <= 4 ? 2e-4 : n <= 20 ? 4e-4 : 1e-2))
                printf("# index %g, alpha %g, cos %g: off by %.1e\n", n, a, mu[m], off);
            *of = fmax(*of, off);
        }
        unmake(&white), unmake(&black);
    }
    ok(bad == 0 && worst[0] < 2e-4 && worst[1] < 4e-4 && worst[2] < 1e-2, "%u: white loses no light (%.1e off, index 20 %.1e, index 1000 %.1e)", isa, worst[0],
       worst[1], worst[2]);
}

/* And what is drawn has that mean. */
static void test_drawn(void)
{
    static const double alpha[] = {0, 0.1, 0.5}, mu[] = {1, 0.25, 0.06};

    for (uint32_t k = 0; k < LENGTH(alpha) * LENGTH(mu); k++) {
        struct sheet white;
        struct estimate e;

        make(&white, 1, 1.5, alpha[k % 3]);
        sheet_view(&white, normal, mu[k / 3], 0.7);
        e = scattered(&white, alpha[k % 3] == 0, 24, 100 + k);
        ok(fabs(e.mean - 1) <= 2e-4 + 4 * e.error && e.error < 1e-3 && e.bad == 0, "%u: drawn, alpha %g, cos %g: %.5f +- %.5f", isa, alpha[k % 3], mu[k / 3],
           e.mean, e.error);
        unmake(&white);
    }
}

/* `albedo` tells what is kept, of colours too, to the errors of both rules; roughness that varies gives the same bits as the same alone. */
static void test_albedo_told(void)
{
    static const double alpha[] = {0, 0.02, 0.5}, mu[] = {1, 0.1};
    double worst = 0;
    uint32_t bad = 0, differ = 0;

    for (uint32_t k = 0; k < LENGTH(alpha) * LENGTH(mu); k++) {
        double own[8], all, *lane = array(LANES);
        struct sheet grey, black;
        struct mcr_colours out = {sizeof out, 8, own, own, own};

        make(&grey, 0.6, 1.5, alpha[k % 3]), make(&black, 0, 1.5, alpha[k % 3]);
        all = kept(&grey, &black, alpha[k % 3] == 0, mu[k / 3], &bad);
        struct mcr_points few = grey.at;
        few.n = 8;
        plugin->albedo(&stand_in, &grey.context, grey.instance, &grey.inputs, &few, &out);
        worst = fmax(worst, fabs(own[0] - all));
        for (uint32_t i = 0; i < LANES; i++) {
            double w[3];
            unit_vector(320, i, w);
            grey.toward.x[i] = w[0], grey.toward.y[i] = w[1], grey.toward.z[i] = w[2];
            black.toward.x[i] = w[0], black.toward.y[i] = w[1], black.toward.z[i] = w[2];
            lane[i] = i % 2 ? alpha[k % 3] : 0.77;
        }
        sheet_evaluate(&grey);
        sheet_density(&grey);
        memcpy(black.copies, grey.copies, sizeof grey.copies);
        black.channel[3 * ROUGHNESS] = lane, black.stride[3 * ROUGHNESS] = alpha[k % 3] > 0; /* a smooth coat's does not vary */
        if (alpha[k % 3] == 0)
            black.channel[3 * ROUGHNESS] = black.copies[3 * ROUGHNESS];
        sheet_evaluate(&black);
        sheet_density(&black);
        for (uint32_t i = 1; i < LANES; i += 2)
            differ += grey.colour.g[i] != black.colour.g[i] || grey.density[i] != black.density[i];
        unmake(&grey), unmake(&black);
        free(lane);
    }
    ok(worst < 2e-4 && bad == 0, "%u: albedo tells what is kept (%.1e off)", isa, worst);
    ok(differ == 0, "%u: roughness may vary from lane to lane (%u differ)", isa, differ);
}

/*
 * The chance of the coat: third numbers below it draw from the coat, others from the base, found by 4 rounds of LANES numbers, and so to LANES^-4; and it is
 * what the density has of the coat, to rounding: s coat + (1 - s) cos / pi, where a black base has the coat's alone.
 */
static void test_share(void)
{
    static const double alpha[] = {0.05, 0.3, 1}, mu[] = {1, 0.4, 0.05};
    double worst = 0;

    for (uint32_t k = 0; k < LENGTH(alpha) * LENGTH(mu); k++) {
        double low = 0, step = 1, all, coat, cosine = 0.35 / M_PI;
        struct sheet grey, black;

        make(&grey, 0.3, 1.5, alpha[k % 3]), make(&black, 0, 1.5, alpha[k % 3]);
        sheet_view(&grey, normal, mu[k / 3], 0.3), sheet_view(&black, normal, mu[k / 3], 0.3);
        sheet_toward(&grey, 0, normal, 0.35, 1.9), sheet_toward(&black, 0, normal, 0.35, 1.9);
        sheet_density(&grey), sheet_density(&black);
        all = grey.density[0], coat = black.density[0];
        for (int round = 0; round < 4; round++) {
            uint32_t i = 0;
            step /= LANES;
            for (uint32_t j = 0; j < LANES; j++)
                grey.number[0][j] = 0.81, grey.number[1][j] = 0.37, grey.number[2][j] = low + j * step;
            grey.number[2][LANES - 1] = 1 - U; /* surely from the base */
            sheet_draw(&grey);
            while (i < LANES && (grey.toward.x[i] != grey.toward.x[LANES - 1] || grey.toward.z[i] != grey.toward.z[LANES - 1]))
                i++;
            low += (i ? i - 1 : 0) * step;
        }
        worst = fmax(worst, fabs(low - (all - cosine) / (coat - cosine)) / (step + 16 * U * fmax(coat, cosine) / fabs(coat - cosine)));
        unmake(&grey), unmake(&black);
    }
    ok(worst <= 1, "%u: the coat is drawn by the chance that the density has of it (%.2f of the error)", isa, worst);
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
    uint32_t widest = MCR_ISA_BASELINE;

    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++)
        widest = descriptor_of(file, isa) ? isa : widest;
    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        plugin = descriptor_of(file, isa);
        if (!plugin) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        if (isa == widest) { /* which has the baseline's bits, as is seen below */
            test_furnace();
            test_drawn();
            test_draw();
        }
        test_albedo_told();
        test_share();
        test_known();
        test_reciprocity();
        bits = test_extremes();
        first = isa == MCR_ISA_BASELINE ? bits : first;
        ok(bits == first, "%u: the bits of the baseline", isa);
    }
    return tap_done();
}
