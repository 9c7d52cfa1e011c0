/* SPDX-License-Identifier: Apache-2.0 */
/* principled: glTF's formulas, its limits in other materials, energy, reciprocity, sampling, smooth lobes, mistakes, extremes. */
#include "facets.h"

#define LANES 4096u
#define LENGTH(x) (sizeof(x) / sizeof *(x))

enum {
    BASE, METALLIC, ROUGHNESS, IOR, SPECULAR, SPECULAR_COLOR, CLEARCOAT, CLEARCOAT_ROUGHNESS, SHEEN_COLOR, SHEEN_ROUGHNESS, TRANSMISSION, THIN,
    ATTENUATION_COLOR, ATTENUATION_DISTANCE, PRIORITY, COMPENSATION, PARAMETERS
};

static const double normal[3] = {0.48, -0.6, 0.64};
static uint32_t isa;
static const struct mcr_material_plugin *plugin;

/* What a test changes; the rest has the defaults of the table. */
struct looks {
    double base[3], metallic, roughness, ior, specular, tint, coat, coat_roughness, sheen, sheen_roughness, transmission;
    int thin, lossy;
};

static void settings_of(double s[3 * PARAMETERS], const struct looks *a)
{
    memset(s, 0, 3 * PARAMETERS * sizeof *s);
    for (int c = 0; c < 3; c++) {
        s[3 * BASE + c] = a->base[c], s[3 * SPECULAR_COLOR + c] = c == 1 ? a->tint : 1, s[3 * SHEEN_COLOR + c] = c == 1 ? a->sheen : a->sheen * 0.5;
        s[3 * ATTENUATION_COLOR + c] = 1;
    }
    s[3 * METALLIC] = a->metallic, s[3 * ROUGHNESS] = a->roughness, s[3 * IOR] = a->ior, s[3 * SPECULAR] = a->specular, s[3 * CLEARCOAT] = a->coat;
    s[3 * CLEARCOAT_ROUGHNESS] = a->coat_roughness, s[3 * SHEEN_ROUGHNESS] = a->sheen_roughness, s[3 * TRANSMISSION] = a->transmission;
    s[3 * THIN] = a->thin, s[3 * ATTENUATION_DISTANCE] = 1, s[3 * COMPENSATION] = !a->lossy;
}

static int32_t create(const double *s, const uint32_t *given, void **instance, struct mcr_context *context)
{
    struct mcr_values values = {sizeof values, PARAMETERS, s, given};
    struct mcr_creation with = {sizeof with, 0, &values, NULL, NULL, 16, 0};

    return plugin->create(&stand_in, context, &with, instance);
}

static void make(struct sheet *sheet, const struct looks *a, double side)
{
    static const uint32_t given[PARAMETERS];
    double s[3 * PARAMETERS];
    void *instance = NULL;

    settings_of(s, a);
    create(s, given, &instance, NULL);
    sheet_init(sheet, plugin, LANES, s);
    sheet->instance = instance;
    for (uint32_t i = 0; i < LANES; i++)
        ((double *)sheet->at.side)[i] = side;
}

static void unmake(struct sheet *sheet)
{
    plugin->destroy(sheet->instance);
    sheet_fini(sheet);
}

static const struct looks plain = {{1, 1, 1}, 0, 0.5, 1.5, 1, 1, 0, 0, 0, 0.3, 0, 0, 0};

/* Random settings, many of them 0 or 1. */
static struct looks random_looks(uint64_t k)
{
    struct looks a = plain;
    double x[16];

    for (int i = 0; i < 16; i++) {
        double u = fixed(400 + k, (uint64_t)i);
        x[i] = u < 0.2 ? 0 : u > 0.8 ? 1 : (u - 0.2) / 0.6;
    }
    a.base[0] = x[0], a.base[1] = x[1], a.base[2] = x[2], a.metallic = x[3], a.roughness = x[4], a.ior = 1 + 1.5 * x[5], a.specular = x[6];
    a.tint = 2 * x[7], a.coat = x[8], a.coat_roughness = x[9], a.sheen = x[10], a.sheen_roughness = x[11], a.transmission = x[12], a.thin = x[13] > 0.7;
    a.lossy = x[14] > 0.7;
    return a;
}

/* All that is scattered, by delta lobes and by own draws; refraction is weighed by `scale`, the square of the relative index. */
static struct estimate scattered(struct sheet *sheet, double scale, uint32_t batches, uint64_t stream)
{
    struct estimate e = {0};
    double sum = 0, squares = 0, count = (double)batches * LANES, *lobe = array(LANES), *chance = array(LANES);

    for (uint32_t k = 0; k < batches; k++) {
        sheet_numbers(sheet, stream + 50, k);
        sheet_delta(sheet);
        for (uint32_t i = 0; i < LANES; i++) {
            double below = sheet->toward.x[i] * normal[0] + sheet->toward.y[i] * normal[1] + sheet->toward.z[i] * normal[2];
            int chosen = sheet->toward.x[i] != 0 || sheet->toward.y[i] != 0 || sheet->toward.z[i] != 0;

            lobe[i] = chosen ? sheet->colour.g[i] * (below < 0 ? scale : 1) / sheet->density[i] : 0;
            chance[i] = chosen ? 0 : sheet->density[i];
            e.bad += !isfinite(lobe[i]) || lobe[i] < 0 || !(chance[i] >= 0);
        }
        sheet_numbers(sheet, stream, k);
        sheet_draw(sheet), sheet_evaluate(sheet);
        for (uint32_t i = 0; i < LANES; i++) {
            double below = sheet->toward.x[i] * normal[0] + sheet->toward.y[i] * normal[1] + sheet->toward.z[i] * normal[2];
            double value = sheet->density[i] > 0 ? sheet->colour.g[i] * (below < 0 ? scale : 1) / sheet->density[i] : 0;
            double all = chance[i] > 0 ? value / chance[i] : lobe[i];

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

static double scale_of(const struct looks *a, double side)
{
    return a->thin ? 1 : side > 0 ? a->ior * a->ior : 1 / (a->ior * a->ior);
}

/* White plastic and white metal lose nothing: the polynomials err by 1e-3. */
static void test_furnace(void)
{
    static const double roughness[] = {0, 0.1, 0.3, 0.5, 0.75, 1}, mu[] = {1, 0.6, 0.25, 0.06}, ior[] = {1, 1.5, 2.5};
    double worst = 0, sharp = 0;
    uint32_t off = 0, bad = 0;

    for (uint32_t k = 0; k < 4 * LENGTH(roughness); k++) {
        struct looks a = plain;
        struct sheet sheet;

        a.metallic = k % 4 == 3, a.ior = ior[k % 3], a.roughness = roughness[k / 4];
        make(&sheet, &a, 1);
        for (uint32_t m = 0; m < LENGTH(mu); m++) {
            struct estimate e;

            sheet_view(&sheet, normal, mu[m], 0.7);
            e = scattered(&sheet, 1, 8, 100 + 4 * k + m);
            if (fabs(e.mean - 1) > 1.5e-3 + 4 * e.error)
                printf("# metallic %g, ior %g, roughness %g, cos %g: %.5f +- %.5f\n", a.metallic, a.ior, a.roughness, mu[m], e.mean, e.error), off++;
            worst = fmax(worst, fabs(e.mean - 1)), sharp = fmax(sharp, e.error), bad += e.bad;
        }
        unmake(&sheet);
    }
    ok(off == 0 && bad == 0 && sharp < 6e-3, "%u: white plastic and metal lose no light (%.1e off, standard errors up to %.1e)", isa, worst, sharp);
}

/* What is documented of white under layers and of rough glass: never more than 1, and at least this much. */
static void test_losses(void)
{
    static const struct {
        double coat, coat_roughness, sheen, transmission, roughness, mu, least;
    } cases[] = {{1, 0, 0, 0, 0.5, 1, 0.95}, {1, 0.5, 0, 0, 0.5, 0.3, 0.99}, {0, 0, 1, 0, 0.5, 1, 0.88}, {0, 0, 1, 0, 0.5, 0.2, 0.97},
                 {0, 0, 0, 1, 0, 0.5, 0.9999}, {0, 0, 0, 1, 0.3, 0.5, 0.999}, {0, 0, 0, 1, 1, 0.5, 0.999}};

    for (uint32_t k = 0; k < LENGTH(cases); k++) {
        struct looks a = plain;
        struct sheet sheet;
        struct estimate e;

        a.coat = cases[k].coat, a.coat_roughness = cases[k].coat_roughness, a.sheen = cases[k].sheen, a.transmission = cases[k].transmission;
        a.roughness = cases[k].roughness;
        make(&sheet, &a, 1);
        sheet_view(&sheet, normal, cases[k].mu, 0.7);
        e = scattered(&sheet, scale_of(&a, 1), 16, 600 + 3 * k);
        ok(e.bad == 0 && e.mean <= 1 + 1e-3 + 4 * e.error && e.mean >= cases[k].least - 4 * e.error && e.error < 8e-3,
           "%u: white, coat %g, sheen %g, transmission %g, roughness %g, cos %g: %.4f +- %.4f", isa, a.coat, a.sheen, a.transmission, a.roughness,
           cases[k].mu, e.mean, e.error);
        unmake(&sheet);
    }
}

/*
 * White glass loses nothing, from both sides and as a wall, whatever its index and roughness; without compensation it does. What scales its reflection makes
 * no light. It is dielectric's, lobes and all.
 */
static void test_glass(void)
{
    static const double ior[] = {1.33, 1.5, 2.4}, roughness[] = {0.23, 0.55, 1}, mu[] = {1, 0.5, 0.1};
    double worst = 0, error = 0, made = 0, same = 0;
    uint32_t bad = 0;

    for (uint32_t k = 0; k < 36; k++) {
        double n = ior[k % 3], side = k / 9 % 2 ? -1 : 1, settings[24] = {0}, off;
        struct looks a = plain;
        struct sheet sheet, other;
        struct estimate e;

        a.transmission = 1, a.ior = n, a.roughness = roughness[k / 3 % 3], a.thin = k / 9 == 2;
        if (k / 9 == 3) /* from outside */
            a.specular = 0.3 * (double)(k % 4), a.tint = k % 2 ? 0.5 : 3, side = 1;
        make(&sheet, &a, side);
        sheet_view(&sheet, normal, mu[(k + k / 3) % 3], 0.7);
        e = scattered(&sheet, scale_of(&a, side), 20, 1200 + 60 * k);
        off = k / 9 == 3 ? e.mean - 1 : fabs(e.mean - 1);
        if (k / 9 == 3)
            made = fmax(made, off - 4 * e.error);
        else
            worst = fmax(worst, off - 4 * e.error);
        error = fmax(error, e.error), bad += e.bad;
        if (k / 9 < 2) {
            settings[0] = n, settings[3] = a.roughness * a.roughness, settings[9] = settings[10] = settings[11] = settings[12] = 1, settings[21] = 1;
            sheet_init(&other, descriptor_of(load("dielectric"), isa), LANES, settings);
            for (uint32_t i = 0; i < LANES; i++)
                ((double *)other.at.side)[i] = side;
            sheet_view(&other, normal, mu[(k + k / 3) % 3], 0.7);
            sheet_evaluate(&sheet);
            for (uint32_t i = 0; i < LANES; i++)
                other.toward.x[i] = sheet.toward.x[i], other.toward.y[i] = sheet.toward.y[i], other.toward.z[i] = sheet.toward.z[i];
            sheet_evaluate(&other);
            for (uint32_t i = 0; i < LANES; i++)
                same = fmax(same, fabs(sheet.colour.g[i] - other.colour.g[i]) / fmax(other.colour.g[i], 1e-6));
            sheet_fini(&other);
        }
        unmake(&sheet);
    }
    ok(bad == 0 && worst < 3e-4 && error < 4e-3, "%u: white glass loses no light: off by %.1e beyond 4 standard errors of up to %.1e", isa, worst, error);
    ok(made < 3e-4, "%u: glass with a scaled reflection makes none (%.1e)", isa, made);
    ok(same < 1e-9, "%u: white glass is dielectric's (%.1e)", isa, same);
    for (int lossy = 0; lossy < 2; lossy++) {
        struct looks a = plain;
        struct sheet sheet;
        struct estimate e;

        a.transmission = 1, a.roughness = 1, a.lossy = lossy;
        make(&sheet, &a, 1);
        sheet_view(&sheet, normal, 0.5, 0.7);
        e = scattered(&sheet, scale_of(&a, 1), 16, 1190);
        ok(fabs(e.mean - (lossy ? 0.735 : 1)) < 5e-3 + 4 * e.error && e.error < 3e-3, "%u: glass of roughness 1, lossy %d: %.4f +- %.4f", isa, lossy, e.mean, e.error);
        unmake(&sheet);
    }
}

/* Whatever the settings: no more than 1 comes back, own sampling finds what the quadrature finds, and what comes back goes both ways. */
static void test_random(void)
{
    static const double mu[] = {0.95, 0.5, 0.1};
    uint32_t much = 0, bad = 0, differ = 0, one_way = 0, compared = 0;
    double most = 0, reciprocity = 0, sharp = 0;

    for (uint32_t k = 0; k < 40; k++) {
        struct looks a = random_looks(k);
        double side = k % 4 ? 1 : -1, mass;
        struct sheet sheet;

        make(&sheet, &a, side);
        for (uint32_t m = 0; m < LENGTH(mu); m++) {
            struct estimate e;

            sheet_view(&sheet, normal, mu[m], 0.7);
            e = scattered(&sheet, scale_of(&a, side), 4, 700 + 6 * k + m);
            much += e.mean > 1 + 2e-3 + 4 * e.error, bad += e.bad;
            most = fmax(most, e.mean), sharp = fmax(sharp, e.error);
            if (e.mean > 1 + 2e-3 + 4 * e.error)
                printf("# settings %u, cos %g: %.5f +- %.5f\n", k, mu[m], e.mean, e.error);
        }
        if (a.roughness > 0.4 && (a.coat == 0 || a.coat_roughness == 0 || a.coat_roughness > 0.4) && !(a.transmission > 0 && a.metallic < 1)) {
            struct estimate e;
            double grid;

            sheet_view(&sheet, normal, 0.5, 0.7);
            e = albedo_drawn(&sheet, 12, 800 + 2 * k);
            grid = albedo_uniform(&sheet, normal, 256, 256, &mass);
            compared++;
            if (fabs(e.mean - grid) > 4 * e.error + 1e-3 * grid + 1e-9)
                printf("# settings %u: drawn %.5f +- %.5f, by quadrature %.5f\n", k, e.mean, e.error, grid), differ++;
        }
        for (uint32_t i = 0; i < 16; i++) {
            double x = 0.05 + 0.95 * fixed(300, i), y = 0.05 + 0.95 * fixed(301, i), phi = 2 * M_PI * fixed(302, i), f, g;

            sheet_view(&sheet, normal, x, 0), sheet_toward(&sheet, 0, normal, y, phi), sheet_evaluate(&sheet);
            f = sheet.colour.g[0] / y;
            sheet_view(&sheet, normal, y, phi), sheet_toward(&sheet, 0, normal, x, 0), sheet_evaluate(&sheet);
            g = sheet.colour.g[0] / x;
            reciprocity = fmax(reciprocity, f > 1e-12 ? fabs(f - g) / f : 0);
            one_way += fabs(f - g) > 1e-10 * f + 1e-15;
        }
        unmake(&sheet);
    }
    ok(much == 0 && bad == 0 && sharp < 0.05, "%u: no settings make light (largest %.4f, standard errors up to %.1e)", isa, most, sharp);
    ok(differ == 0 && compared >= 6, "%u: draws find what the quadrature finds, %u settings", isa, compared);
    ok(one_way == 0, "%u: what is reflected goes both ways (%.1e)", isa, reciprocity);
}

static void test_draw(void)
{
    static const struct looks cases[] = {
        {{0.8, 0.3, 0.5}, 0, 0.6, 1.5, 1, 1, 0, 0, 0, 0.3, 0, 0, 0},       {{0.8, 0.3, 0.5}, 0.4, 0.8, 1.5, 1, 1, 0.7, 0.6, 0.8, 0.5, 0, 0, 0},
        {{0.8, 0.9, 0.5}, 0, 0.7, 1.5, 1, 1, 0, 0, 0, 0.3, 1, 0, 0},       {{0.8, 0.9, 0.5}, 0.2, 0.8, 1.3, 0.7, 2, 0.5, 0.7, 0.3, 0.4, 0.6, 0, 0},
        {{0.8, 0.9, 0.5}, 0.2, 0.7, 1.5, 1, 1, 0.5, 0, 0, 0.3, 0.6, 1, 0}, {{0.5, 0.5, 0.5}, 0, 0, 1.5, 1, 1, 1, 0.6, 0.5, 0.3, 0.3, 0, 0},
    };
    static const double mu[] = {0.9, 0.3, 0.6};

    for (uint32_t k = 0; k < LENGTH(cases); k++) {
        struct looks a = cases[k];
        struct sheet sheet;
        double mass, z;

        make(&sheet, &a, k == 3 ? -1 : 1);
        sheet_view(&sheet, normal, mu[k % 3], 0.7);
        z = chi_square_over(&sheet, normal, 48, 200 + k, -1, &mass);
        ok(z <= 4 && mass <= 1.001 && mass > 0.5, "%u: draws follow the density, case %u, cos %g: chi-square z %.2f, mass %.4f", isa, k, mu[k % 3], z, mass);
        unmake(&sheet);
    }
}

/* ---- limits that are other materials ---- */

static double other_value(const char *word, const double *settings, double mu, double toward, double phi)
{
    const struct mcr_material_plugin *other = descriptor_of(load(word), isa);
    struct sheet sheet;
    double value;

    sheet_init(&sheet, other, 8, settings);
    sheet_view(&sheet, normal, mu, 0);
    sheet_toward(&sheet, 0, normal, toward, phi);
    for (uint32_t i = 1; i < 8; i++)
        sheet_toward(&sheet, i, normal, 1, 0);
    sheet_evaluate(&sheet);
    value = sheet.colour.g[0];
    sheet_fini(&sheet);
    return value;
}

/* f cos by glTF's appendix B and its extensions, of plastic with its diffuse part left out. */
static double formula(const struct looks *a, double mu, double toward, double phi)
{
    double alpha = a->roughness * a->roughness, a2 = alpha * alpha, sx = sqrt(1 - mu * mu) + sqrt(1 - toward * toward) * cos(phi);
    double sy = sqrt(1 - toward * toward) * sin(phi), sz = mu + toward, length = sqrt(sx * sx + sy * sy + sz * sz), nh = sz / length, vh = length / 2;
    double t = nh * nh * (a2 - 1) + 1, d = a2 / (M_PI * t * t);
    double v = 0.5 / (toward * sqrt(mu * mu * (1 - a2) + a2) + mu * sqrt(toward * toward * (1 - a2) + a2));
    double f0 = pow((a->ior - 1) / (a->ior + 1), 2), f;

    f0 = fmin(f0 * a->tint, 1) * a->specular;
    f = f0 + (a->specular - f0) * pow(1 - vh, 5);
    return d * v * f * toward;
}

static void test_limits(void)
{
    double metal = 0, diffuse = 0, plastic = 0, sheen = 0;

    for (uint32_t k = 0; k < 24; k++) {
        double mu = 0.1 + 0.9 * fixed(500, k), toward = 0.1 + 0.9 * fixed(501, k), phi = 2 * M_PI * fixed(502, k), r = 0.2 + 0.8 * fixed(503, k), value, d, h;
        double conductor[24] = {0}, lambert[3] = {0.2, 0.7, 0.4};
        struct looks a = plain;
        struct sheet sheet;

        a.metallic = 1, a.base[1] = 0.7, a.roughness = r, a.ior = 1 + 2 * fixed(504, k), a.lossy = k % 2;
        conductor[3] = conductor[4] = conductor[5] = 0.7, conductor[12] = r * r, conductor[21] = !a.lossy;
        make(&sheet, &a, 1);
        sheet_view(&sheet, normal, mu, 0), sheet_toward(&sheet, 0, normal, toward, phi), sheet_evaluate(&sheet);
        metal = fmax(metal, fabs(sheet.colour.g[0] / other_value("conductor", conductor, mu, toward, phi) - 1));
        unmake(&sheet);

        a.metallic = 0, a.specular = 0;
        make(&sheet, &a, 1);
        sheet_view(&sheet, normal, mu, 0), sheet_toward(&sheet, 0, normal, toward, phi), sheet_evaluate(&sheet);
        diffuse = fmax(diffuse, fabs(sheet.colour.g[0] / other_value("lambert", lambert, mu, toward, phi) - 1));
        unmake(&sheet);

        a.base[1] = 0, a.specular = 0.8, a.tint = 1.5;
        make(&sheet, &a, 1);
        sheet_view(&sheet, normal, mu, 0), sheet_toward(&sheet, 0, normal, toward, phi), sheet_evaluate(&sheet);
        plastic = fmax(plastic, fabs(sheet.colour.g[0] / formula(&a, mu, toward, phi) - 1));
        unmake(&sheet);

        a.specular = 0, a.sheen = 0.6, a.sheen_roughness = 0.7 + 0.3 * r; /* that reflects less than 1 everywhere, so that nothing is divided */
        make(&sheet, &a, 1);
        sheet_view(&sheet, normal, mu, 0), sheet_toward(&sheet, 0, normal, toward, phi), sheet_evaluate(&sheet);
        h = pow(sqrt(1 - mu * mu) + sqrt(1 - toward * toward) * cos(phi), 2) + pow(sqrt(1 - toward * toward) * sin(phi), 2);
        h = sqrt(h / (h + (mu + toward) * (mu + toward)));
        d = 1 / (a.sheen_roughness * a.sheen_roughness), value = (2 + d) * pow(h, d) / (2 * M_PI) / (4 * (mu + toward - mu * toward)) * toward;
        sheen = fmax(sheen, fabs(sheet.colour.g[0] / (0.6 * value) - 1));
        unmake(&sheet);
    }
    ok(metal < 1e-12, "%u: metal is a conductor of this reflectance, with and without compensation (%.1e)", isa, metal);
    ok(diffuse < 1e-12, "%u: without specular it is lambert (%.1e)", isa, diffuse);
    ok(plastic < 1e-9, "%u: plastic over black is glTF's formula (%.1e)", isa, plastic);
    ok(sheen < 1e-9, "%u: sheen over black is the extension's formula (%.1e)", isa, sheen);
}

/* Smooth glass has the lobes of dielectric, from both sides and as a thin wall; smooth metal those of Schlick; a smooth coat's share. */
static void test_smooth(void)
{
    const struct mcr_material_plugin *glass = descriptor_of(load("dielectric"), isa);
    double worst = 0, metal = 0, coat = 0, none = 0;

    for (uint32_t k = 0; k < 3 * 8; k++) {
        double settings[24] = {1.5, 0, 0, 0, 0, 0, k % 3 == 2, 0, 0, 1, 1, 1, 1}, mu = 0.05 + 0.95 * fixed(510, k), side = k % 3 == 1 ? -1 : 1;
        struct looks a = plain;
        struct sheet sheet, other;

        a.roughness = 0, a.transmission = 1, a.thin = k % 3 == 2;
        make(&sheet, &a, side);
        sheet_init(&other, glass, LANES, settings);
        for (uint32_t i = 0; i < LANES; i++)
            ((double *)other.at.side)[i] = side;
        sheet_view(&sheet, normal, mu, 0.7), sheet_view(&other, normal, mu, 0.7);
        sheet_numbers(&sheet, 520, k), sheet_numbers(&other, 520, k);
        sheet_delta(&sheet), sheet_delta(&other);
        for (uint32_t i = 0; i < LANES; i++) {
            worst = fmax(worst, fabs(sheet.toward.x[i] - other.toward.x[i]) + fabs(sheet.toward.z[i] - other.toward.z[i]));
            worst = fmax(worst, fabs(sheet.colour.g[i] - other.colour.g[i]) + fabs(sheet.density[i] - other.density[i]));
        }
        unmake(&sheet), sheet_fini(&other);
        a = plain, a.metallic = 1, a.base[1] = 0.4, a.roughness = 0;
        make(&sheet, &a, 1);
        sheet_view(&sheet, normal, mu, 0.7), sheet_numbers(&sheet, 521, k), sheet_delta(&sheet);
        metal = fmax(metal, fabs(sheet.colour.g[k] - (0.4 + 0.6 * pow(1 - mu, 5))) + fabs(sheet.density[k] - 1));
        unmake(&sheet);
        a = plain, a.coat = 0.5;
        make(&sheet, &a, 1);
        sheet_view(&sheet, normal, mu, 0.7), sheet_numbers(&sheet, 521, k);
        sheet.number[0][0] = 0, sheet.number[0][1] = 1 - 0x1p-53, sheet_delta(&sheet);
        coat = fmax(coat, fabs(sheet.colour.g[0] - 0.5 * (0.04 + 0.96 * pow(1 - mu, 5))));
        none = fmax(none, fabs(sheet.density[0] + sheet.density[1] - 1) + fabs(sheet.toward.x[1]) + fabs(sheet.toward.z[1]) + sheet.colour.g[1]);
        unmake(&sheet);
    }
    ok(worst < 1e-12, "%u: smooth glass is dielectric's, from both sides and thin (%.1e)", isa, worst);
    ok(metal < 1e-12, "%u: smooth metal is a mirror as Schlick has it, and nothing else (%.1e)", isa, metal);
    ok(coat < 1e-12 && none < 1e-12, "%u: a smooth coat is a mirror; no lobe is chosen last (%.1e, %.1e)", isa, coat, none);
}

static void test_traits(void)
{
    static const struct {
        double metallic, roughness, coat, coat_roughness, transmission;
        int thin;
        uint32_t does;
    } cases[] = {{0, 0.5, 0, 0, 0, 0, MCR_MATERIAL_REFLECTS},
                 {0, 0, 0, 0, 0, 0, MCR_MATERIAL_REFLECTS | MCR_MATERIAL_DELTA},
                 {1, 0, 0, 0, 0, 0, MCR_MATERIAL_DELTA},
                 {1, 0.5, 1, 0, 0, 0, MCR_MATERIAL_REFLECTS | MCR_MATERIAL_DELTA},
                 {0, 0, 0, 0, 1, 0, MCR_MATERIAL_DELTA | MCR_MATERIAL_INTERIOR},
                 {0, 0, 0, 0, 1, 1, MCR_MATERIAL_DELTA | MCR_MATERIAL_THIN},
                 {0, 0.5, 0, 0, 1, 0, MCR_MATERIAL_REFLECTS | MCR_MATERIAL_TRANSMITS | MCR_MATERIAL_INTERIOR},
                 {1, 0.5, 0, 0, 1, 0, MCR_MATERIAL_REFLECTS}};
    uint32_t wrong = 0, given[PARAMETERS] = {0};
    struct mcr_material_traits traits = {.size = sizeof traits};
    double s[3 * PARAMETERS];
    struct mcr_values values = {sizeof values, PARAMETERS, s, given};

    for (uint32_t k = 0; k < LENGTH(cases); k++) {
        struct looks a = plain;

        a.metallic = cases[k].metallic, a.roughness = cases[k].roughness, a.coat = cases[k].coat, a.coat_roughness = cases[k].coat_roughness;
        a.transmission = cases[k].transmission, a.thin = cases[k].thin;
        settings_of(s, &a);
        plugin->traits(&stand_in, NULL, NULL, &values, &traits);
        wrong += traits.does != cases[k].does;
    }
    ok(wrong == 0, "%u: what it does", isa);
    values.number = s, s[3 * METALLIC] = 0, s[3 * ATTENUATION_COLOR] = 0.5, s[3 * ATTENUATION_COLOR + 1] = 0.25, s[3 * ATTENUATION_DISTANCE] = 2;
    s[3 * PRIORITY] = 7;
    plugin->traits(&stand_in, NULL, NULL, &values, &traits);
    ok(fabs(traits.attenuation[0] - M_LN2 / 2) < 1e-15 && fabs(traits.attenuation[1] - M_LN2) < 1e-15 && traits.attenuation[2] == 0 && traits.index == 1.5 &&
           traits.priority == 7,
       "%u: the interior: -ln(attenuation_color) / attenuation_distance", isa);
}

static void test_mistakes(void)
{
    static const struct {
        uint32_t first, second;
        double transmission, thin, distance;
        const char *text;
    } cases[] = {{ATTENUATION_COLOR, ATTENUATION_DISTANCE, 1, 1, 1, "'thin yes'"},       {PRIORITY, PRIORITY, 1, 1, 1, "'thin yes'"},
                 {THIN, THIN, 0, 1, 1, "without 'transmission'"},                         {PRIORITY, PRIORITY, 0, 0, 1, "without 'transmission'"},
                 {ATTENUATION_COLOR, ATTENUATION_COLOR, 1, 0, 1, "both or neither"},      {ATTENUATION_DISTANCE, ATTENUATION_DISTANCE, 1, 0, 1, "both or neither"},
                 {ATTENUATION_COLOR, ATTENUATION_DISTANCE, 1, 0, 1e-310, "too small"}};
    struct mcr_context context = {0};

    for (uint32_t k = 0; k < LENGTH(cases); k++) {
        uint32_t given[PARAMETERS] = {0};
        struct looks a = plain;
        double s[3 * PARAMETERS];
        void *instance = NULL;
        int32_t status;

        a.transmission = cases[k].transmission, a.thin = cases[k].thin != 0;
        settings_of(s, &a);
        s[3 * ATTENUATION_COLOR] = 1e-9, s[3 * ATTENUATION_DISTANCE] = cases[k].distance;
        given[cases[k].first] = given[cases[k].second] = 1;
        context.message[0] = 0;
        status = create(s, given, &instance, &context);
        ok(status == MCR_E_INVALID && instance == NULL && strstr(context.message, cases[k].text), "%u: %s", isa, context.message);
    }
}

static uint64_t test_extremes(void)
{
    static const double roughness[] = {0, 1e-4, 1e-2, 1}, ior[] = {1, 1 + 1e-9, 1.5, 3, 1e3}, mu[] = {1e-320, 1e-8, 0.5, 1};
    uint32_t bad = 0;
    uint64_t bits = 0;

    for (uint32_t k = 0; k < 20; k++) {
        struct looks a = random_looks(1000 + k);
        struct sheet sheet;

        a.roughness = roughness[k % 4], a.ior = ior[k % 5], a.coat_roughness = roughness[k / 4 % 4], a.sheen_roughness = k % 3 ? 0 : 1;
        a.tint = k % 7 == 0 ? 1e6 : a.tint;
        make(&sheet, &a, k % 3 ? 1 : -1);
        for (uint32_t m = 0; m < LENGTH(mu); m++) {
            sheet_view(&sheet, normal, mu[m], 0.7);
            for (int step = 0; step < 4; step++) {
                sheet_numbers(&sheet, 310, k);
                for (uint32_t i = 0; i < LANES / 8; i++) /* the square's edges */
                    for (uint32_t c = 0; c < 3; c++)
                        sheet.number[c][i] = (i >> c & 1) ? 0 : (i >> c & 8) ? 1 - 0x1p-53 : sheet.number[c][i];
                for (uint32_t i = 0; step == 2 && i < LANES; i++) { /* any direction, also opposite ones */
                    double w[3];
                    unit_vector(320, i, w);
                    sheet.toward.x[i] = i ? w[0] : -sheet.at.ox[0], sheet.toward.y[i] = i ? w[1] : -sheet.at.oy[0], sheet.toward.z[i] = i ? w[2] : -sheet.at.oz[0];
                }
                if (step == 0)
                    sheet_draw(&sheet), sheet_evaluate(&sheet);
                else if (step == 1)
                    sheet_delta(&sheet);
                else if (step == 2)
                    sheet_density(&sheet), sheet_evaluate(&sheet);
                else if (plugin->albedo(&stand_in, &sheet.context, sheet.instance, &sheet.inputs, &sheet.at, &sheet.colour) == MCR_E_UNSUPPORTED)
                    continue; /* left to the host */
                for (uint32_t i = 0; i < LANES; i++) {
                    bad += !isfinite(sheet.colour.g[i]) || !(sheet.colour.g[i] >= 0) || !isfinite(sheet.density[i]) || sheet.density[i] < 0;
                    bad += !isfinite(sheet.toward.x[i]) || (step == 3 && sheet.colour.g[i] > 1);
                    bits = mcr_mix64(bits + mcr_bits(sheet.colour.r[i]) + 3 * mcr_bits(sheet.toward.x[i]) + 5 * mcr_bits(sheet.density[i]));
                }
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
    const struct mcr_plugin *file = load("principled");
    uint64_t first = 0, bits;

    for (isa = MCR_ISA_AVX512; !(plugin = descriptor_of(file, isa)); isa--) /* the fastest; the others have its bits */
        ;
    test_furnace();
    test_losses();
    test_glass();
    test_random();
    test_draw();
    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        plugin = descriptor_of(file, isa);
        if (!plugin) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        test_mistakes();
        test_limits();
        test_smooth();
        test_traits();
        bits = test_extremes();
        first = isa == MCR_ISA_BASELINE ? bits : first;
        ok(bits == first, "%u: the bits of the baseline", isa);
    }
    return tap_done();
}
