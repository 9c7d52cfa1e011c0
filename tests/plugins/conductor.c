/* SPDX-License-Identifier: Apache-2.0 */
/* conductor: directional albedos with a known answer, Fresnel's formulas, reciprocity, sampling, and the extremes of roughness and angle. */
#include "facets.h"

#define LANES 4096u
#define U 0x1p-53
#define LENGTH(x) (sizeof(x) / sizeof *(x))

enum { METAL, REFLECTANCE, ETA, K, ROUGHNESS, ANISOTROPY, ROTATION, COMPENSATION, PARAMETERS };
enum { BY_REFLECTANCE, BY_INDEX, GOLD, SILVER, COPPER, ALUMINIUM };

static const double normal[3] = {0.48, -0.6, 0.64}, upright[3] = {0, 0, 1}; /* cosines to the latter are exact */
static const double alphas[] = {0.1, 0.25, 0.5, 1}, cosines[] = {1, 0.5, 0.1};
static uint32_t isa;
static const struct mcr_material_plugin *plugin;

static void settings_of(double s[24], double metal, double eta, double k, double alpha)
{
    memset(s, 0, 24 * sizeof *s);
    for (int c = 0; c < 3; c++)
        s[c] = 0, s[3 + c] = 1, s[6 + c] = eta, s[9 + c] = k, s[12 + c] = 0;
    s[0] = metal;
    s[12] = alpha;
}

static void set(struct sheet *sheet, double metal, double eta, double k, double alpha)
{
    double s[24];

    settings_of(s, metal, eta, k, alpha);
    sheet_set(sheet, s);
}

static void init(struct sheet *sheet, double alpha)
{
    double s[24];

    settings_of(s, BY_REFLECTANCE, 1, 1, alpha);
    sheet_init(sheet, plugin, LANES, s);
}

/* F = 1: computed in high precision, S21 of the project's table of analytic scenes. */
static void test_albedo(void)
{
    static const double answer[4][3] = {{.988304056521, .969204984412, .883455001867},
                                        {.915812430250, .857263435582, .891622351809},
                                        {.687848515110, .698250696928, .860105072668},
                                        {1 - M_LN2, .450693855666, .760210472720}};
    struct sheet sheet;

    init(&sheet, 1);
    for (uint32_t a = 0; a < LENGTH(alphas); a++)
        for (uint32_t m = 0; m < LENGTH(cosines); m++) {
            double exact = answer[a][m], mass, grid;
            struct estimate drawn;

            set(&sheet, BY_REFLECTANCE, 1, 1, alphas[a]);
            sheet_view(&sheet, normal, cosines[m], 0.7);
            drawn = albedo_numbers(&sheet, 512);
            ok(fabs(drawn.mean - exact) <= 2e-5 && drawn.bad == 0, "%u: albedo, alpha %g, cos %g, own sampling: off by %.1e", isa, alphas[a], cosines[m],
               drawn.mean - exact);
            ok(drawn.most <= 1 + 16 * U, "%u: no weight above 1 (%.17g)", isa, drawn.most);
            /* Seen from above nothing depends on the azimuth. The midpoint rule's own error is 1.3e-5 at most: a quarter with steps halved. */
            grid = albedo_uniform(&sheet, normal, m ? 512 : 4096, m ? 1024 : 128, &mass);
            ok(fabs(grid - exact) < 2e-5, "%u: by uniform directions: off by %.1e", isa, grid - exact);
            ok(mass >= drawn.mean - 2e-5 && mass <= 1 + 2e-5, "%u: the density integrates to %.6f", isa, mass);
        }
    sheet_fini(&sheet);
}

/*
 * Steps of the chi-squares' midpoint rule in a cell. Seen from above, the lobe is alpha^2 / 2 wide in cosines; steps of h = 1 / (16 fine) err by (h / that)^2 / 24
 * of a cell's count: 2e-3 for alpha = 0.1 with 64, 2e-4 from 0.25 on with 32; counts of 16000 err by 8e-3.
 */
static uint32_t fine_for(double alpha) { return alpha < 0.25 ? 64 : 32; }

/* The share that is not drawn is what the density lacks: it is a cell of its own. */
static void test_draw(void)
{
    struct sheet sheet;

    init(&sheet, 1);
    for (uint32_t a = 0; a < LENGTH(alphas); a++)
        for (uint32_t m = 0; m < LENGTH(cosines); m++) {
            double mass, z;

            set(&sheet, BY_REFLECTANCE, 1, 1, alphas[a]);
            sheet_view(&sheet, normal, cosines[m], 2.1);
            z = chi_square_by(&sheet, normal, 64, 400 + 3 * a + m, 0, fine_for(alphas[a]), &mass);
            ok(z <= 4, "%u: draws follow the density, alpha %g, cos %g: chi-square z %.2f, drawn at all %.4f", isa, alphas[a], cosines[m], z, mass);
        }
    sheet_fini(&sheet);
}

/*
 * R of eta + i k from the complex amplitudes (n = eta + i k; r_s = (c - n c_t) / (c + n c_t), r_p = (n c - c_t) / (n c + c_t), c_t^2 = 1 - (1 - c^2) / n^2;
 * R the mean of |r_s|^2 and |r_p|^2), with python3-mpmath at 50 digits.
 */
static const double fresnel[][4] = {
    {1, 0.2, 3.9, 0.95195195195195195},
    {0.5, 0.2, 3.9, 0.9458823818013334},
    {0.1, 1.3, 7.3, 0.84995220093244356},
    {0.03125, 0.05, 4.1, 0.99668206133596628},
    {0.7, 1.5, 0, 0.050916935590777447},
    {0.3, 1.5, 0, 0.20775634307089776},
    {0.25, 0.5, 0.0, 1.0},
    {0.9, 0.5, 0, 0.16456302436995568},
    {0.25, 1, 1e-06, 5.649999997844212e-11},
    {0.5, 1000.0, 1000.0, 0.99750424565766055},
    {1e-08, 1.3, 1.8, 0.99999996757401474},
    {1, 1.5, 0, 0.04},
    {0.6, 1.01, 2.5, 0.60794835099690795},
    {1, 0, 0, 1},
};

/* evaluate toward the mirror direction, over the same with F = 1, whose half vector is the normal. */
static void test_fresnel(void)
{
    double worst = 0, schlick = 0, metals = 0;
    struct sheet sheet;

    init(&sheet, 0.3);
    for (uint32_t k = 0; k < LENGTH(fresnel); k++) {
        double one, f, c = fresnel[k][0], m = 1 - c;

        sheet_view(&sheet, normal, c, 0.4);
        sheet_toward(&sheet, 0, normal, c, 0.4 + M_PI);
        set(&sheet, BY_REFLECTANCE, 1, 1, 0.3);
        sheet_evaluate(&sheet);
        one = sheet.colour.g[0];
        set(&sheet, BY_INDEX, fresnel[k][1], fresnel[k][2], 0.3);
        sheet_evaluate(&sheet);
        f = sheet.colour.g[0] / one;
        worst = fmax(worst, fabs(f - fresnel[k][3]) / (fresnel[k][3] + 1e-6));
        for (int i = 0; i < 8; i++)
            sheet.copies[3 * METAL][i] = BY_REFLECTANCE, sheet.copies[3 * REFLECTANCE + 1][i] = 0.6;
        sheet_evaluate(&sheet);
        schlick = fmax(schlick, fabs(sheet.colour.g[0] / one - (0.6 + 0.4 * pow(m, 5))));
    }
    ok(worst <= 1e-12, "%u: Fresnel's formulas to 1e-12 (%.1e)", isa, worst);
    ok(schlick <= 1e-14, "%u: Schlick's formula to 1e-14 (%.1e)", isa, schlick);
    /*
     * Reflectances at normal incidence from the measured indices: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2), red, green, blue.
     * The plugin has the indices to 4 digits, which leaves 6e-5.
     */
    static const double metal[4][3] = {{0.9240, 0.7882, 0.4039}, {0.9870, 0.9829, 0.9791}, {0.8736, 0.6206, 0.5492}, {0.9102, 0.9154, 0.9208}};
    sheet_view(&sheet, normal, 1, 0);
    sheet_toward(&sheet, 0, normal, 1, 0);
    set(&sheet, BY_REFLECTANCE, 1, 1, 0.3);
    sheet_evaluate(&sheet);
    double one = sheet.colour.r[0];
    for (uint32_t k = 0; k < 4; k++) {
        set(&sheet, GOLD + k, 1, 1, 0.3);
        sheet_evaluate(&sheet);
        metals = fmax(metals, fabs(sheet.colour.r[0] / one - metal[k][0]));
        metals = fmax(metals, fabs(sheet.colour.g[0] / one - metal[k][1]));
        metals = fmax(metals, fabs(sheet.colour.b[0] / one - metal[k][2]));
    }
    ok(metals <= 1e-4, "%u: gold, silver, copper, aluminium have the reflectances of their measured indices (%.1e)", isa, metals);
    sheet_fini(&sheet);
}

/* f(o, i) = f(i, o): sums and products commute, the quotients by the cosines leave a few roundings. */
static void test_reciprocity(void)
{
    double worst = 0;
    uint32_t pairs = 0;
    struct sheet a, b;

    init(&a, 1), init(&b, 1);
    for (uint32_t k = 0; k < 6; k++) {
        static const double alpha[6] = {1, 0.5, 0.1, 0.01, 1e-4, 1e-7};

        set(&a, BY_INDEX, 0.4, 2.4, alpha[k]), set(&b, BY_INDEX, 0.4, 2.4, alpha[k]);
        for (uint32_t i = 0; i < 64; i++) {
            double near = k < 3 ? 1 : alpha[k], mu = fixed(500, i), other = mu + near * (fixed(501, i) - mu), *swap[2][3];

            sheet_view(&a, normal, 0.5, 0), sheet_view(&b, normal, 0.5, 0);
            swap[0][0] = (double *)a.at.ox, swap[0][1] = (double *)a.at.oy, swap[0][2] = (double *)a.at.oz;
            swap[1][0] = (double *)b.at.ox, swap[1][1] = (double *)b.at.oy, swap[1][2] = (double *)b.at.oz;
            sheet_toward(&a, 0, normal, mu, 0), sheet_toward(&b, 0, normal, other, M_PI + near * fixed(502, i));
            swap[0][0][0] = b.toward.x[0], swap[0][1][0] = b.toward.y[0], swap[0][2][0] = b.toward.z[0];
            swap[1][0][0] = a.toward.x[0], swap[1][1][0] = a.toward.y[0], swap[1][2][0] = a.toward.z[0];
            sheet_evaluate(&a), sheet_evaluate(&b);
            double in = normal[0] * a.toward.x[0] + normal[1] * a.toward.y[0] + normal[2] * a.toward.z[0];
            double out = normal[0] * b.toward.x[0] + normal[1] * b.toward.y[0] + normal[2] * b.toward.z[0];
            double f = a.colour.g[0] / in, g = b.colour.g[0] / out;
            pairs += f > 0;
            worst = fmax(worst, fabs(f - g) / (f > 0 ? f : 1));
        }
    }
    ok(pairs > 300 && worst <= 8 * U, "%u: reciprocal to rounding, %u pairs (%.1f u)", isa, pairs, worst / U);
    sheet_fini(&a), sheet_fini(&b);
}

/* Lobes down to 1e-7 rad, cosines down to 1e-8, numbers at the ends of their range: all finite, unit, above the horizon. */
static void test_extremes(void)
{
    static const double alpha[] = {1e-7, 1e-6, 1e-4, 0.01, 1}, mu[] = {1e-320, 1e-90, 1e-8, 1e-4, 0.5, 1}, ends[] = {0, 0x1p-60, 0.5, 1 - U};
    uint32_t bad = 0, drawn = 0, heavy = 0;
    static const double mirror[] = {[4] = 0.9458823818013334, [5] = 0.95195195195195195}; /* Fresnel's formulas at cosines 0.5 and 1, as in the table */
    double sharp = 0, off = 0;
    struct sheet sheet;

    init(&sheet, 1);
    for (uint32_t a = 0; a < LENGTH(alpha); a++)
        for (uint32_t m = 0; m < LENGTH(mu); m++) {
            double sum = 0;

            set(&sheet, BY_INDEX, 0.2, 3.9, alpha[a]);
            sheet_view(&sheet, upright, mu[m], 5);
            sheet_numbers(&sheet, 600, a * 8 + m);
            for (uint32_t i = 0; i < 16; i++)
                sheet.number[0][i] = ends[i / 4], sheet.number[1][i] = ends[i % 4];
            for (int k = 0; k < 3; k++) { /* drawn; the opposite at the horizon and close to the mirror direction; anywhere, below the horizon too */
                if (k == 0)
                    sheet_draw(&sheet);
                for (uint32_t i = 0; i < LANES && k == 1; i++)
                    sheet_toward(&sheet, i, upright, i % 2 ? mu[m] : 1e-8, 5 + M_PI * (1 + alpha[a] * (i / 8) / LANES));
                for (uint32_t i = 0; i < LANES && k == 2; i++) {
                    double w[3];
                    unit_vector(601, i, w);
                    sheet.toward.x[i] = w[0], sheet.toward.y[i] = w[1], sheet.toward.z[i] = w[2];
                }
                sheet_density(&sheet);
                sheet_evaluate(&sheet);
                for (uint32_t i = 0; i < LANES; i++) {
                    double x = sheet.toward.x[i], y = sheet.toward.y[i], z = sheet.toward.z[i], length = x * x + y * y + z * z, d = sheet.density[i];

                    bad += !(isfinite(d) && d >= 0 && isfinite(sheet.colour.r[i]) && sheet.colour.r[i] >= 0 && isfinite(sheet.colour.b[i]));
                    bad += k == 0 && !(length == 0 ? d == 0 && sheet.colour.g[i] == 0 : fabs(length - 1) < 8 * U && d > 0);
                    bad += k == 2 && x * upright[0] + y * upright[1] + z * upright[2] <= 0 && (d != 0 || sheet.colour.g[i] != 0);
                    heavy += k == 0 && d > 0 && sheet.colour.g[i] > d * (1 + 16 * U);
                    drawn += k == 0 && d > 0;
                    sum += k == 0 && d > 0 ? sheet.colour.g[i] / d / LANES : 0;
                }
            }
            off = a == 0 && m >= 4 ? fmax(off, fabs(sum - mirror[m])) : off; /* but for the 16 lanes of extreme numbers, whose facets lean */
        }
    ok(bad == 0 && drawn > 60000, "%u: finite at the extremes (%u wrong, %u drawn)", isa, bad, drawn);
    ok(heavy == 0, "%u: no weight above 1 at the extremes", isa);
    ok(off < 16.0 / LANES, "%u: alpha 1e-7 reflects as a mirror does: %.1e off", isa, off);
    /*
     * D at its peak is 1 / (pi alpha^2): with cosine c, f cos = D G2 / (4 c) at the mirror direction, G2 = 1 / sqrt(1 + alpha^2 tan^2). Rounding: the sum
     * of the two directions, 2 c long, leans by 4 * 2^-53 / (2 c), and D falls by the square of that over alpha.
     */
    for (uint32_t m = 3; m < LENGTH(mu); m++) {
        double tangent = sqrt((1 - mu[m]) * (1 + mu[m])) / mu[m], exact = 1 / (M_PI * 1e-14 * 4 * mu[m] * sqrt(1 + 1e-14 * tangent * tangent));

        set(&sheet, BY_REFLECTANCE, 1, 1, 1e-7);
        sheet_view(&sheet, upright, mu[m], 5);
        sheet_toward(&sheet, 0, upright, mu[m], 5 + M_PI);
        sheet_evaluate(&sheet);
        sharp = fmax(sharp, fabs(sheet.colour.g[0] / exact - 1));
    }
    ok(sharp < pow(4 * U / (2 * 1e-4) / 1e-7, 2), "%u: the peak at alpha 1e-7 is that of D (%.1e)", isa, sharp);
    sheet_view(&sheet, upright, 1, 0);
    for (uint32_t i = 0; i < LANES; i++) /* seen from below the shading normal */
        ((double *)sheet.at.ox)[i] = -upright[0], ((double *)sheet.at.oy)[i] = -upright[1], ((double *)sheet.at.oz)[i] = -upright[2];
    ok(albedo_drawn(&sheet, 1, 700).mean == 0, "%u: black where the outgoing direction is below the shading normal's horizon", isa);
    sheet_fini(&sheet);
}

/* With geometric normals of their own: black exactly where either direction is below the shading normal's horizon or `toward` below the geometric one. */
static void test_horizons(void)
{
    uint32_t wrong = 0, black = 0, geometric = 0;
    struct sheet sheet;

    init(&sheet, 0.5);
    for (uint32_t i = 0; i < LANES; i++) {
        double w[3];
        unit_vector(610, i, w);
        sheet.toward.x[i] = w[0], sheet.toward.y[i] = w[1], sheet.toward.z[i] = w[2];
        unit_vector(611, i, w);
        ((double *)sheet.at.ox)[i] = w[0], ((double *)sheet.at.oy)[i] = w[1], ((double *)sheet.at.oz)[i] = w[2];
    }
    sheet_evaluate(&sheet);
    sheet_density(&sheet);
    for (uint32_t i = 0; i < LANES; i++) {
        double x = sheet.toward.x[i], y = sheet.toward.y[i], z = sheet.toward.z[i], in = sheet.at.nx[i] * x + sheet.at.ny[i] * y + sheet.at.nz[i] * z;
        double out = sheet.at.nx[i] * sheet.at.ox[i] + sheet.at.ny[i] * sheet.at.oy[i] + sheet.at.nz[i] * sheet.at.oz[i];
        int seen = in > 0 && out > 0, above = sheet.at.gx[i] * x + sheet.at.gy[i] * y + sheet.at.gz[i] * z > 0;

        wrong += (sheet.colour.g[i] != 0) != (seen && above) || (sheet.density[i] > 0) != seen;
        black += !seen && above;
        geometric += seen && !above;
    }
    ok(wrong == 0 && black > 100 && geometric > 10, "%u: black below either horizon (%u, %u)", isa, black, geometric);
    sheet_fini(&sheet);
}

/* Settings that vary give what the same settings give alone; the bits are those of the baseline. */
static uint64_t test_varying(void)
{
    struct sheet sheet, one;
    double *lane[24], s[24], wrong = 0;
    uint64_t bits;

    init(&sheet, 1), init(&one, 1);
    for (uint32_t c = 0; c < 24; c++) {
        lane[c] = numbers(LANES, 800 + c);
        sheet.channel[c] = lane[c];
        sheet.stride[c] = 1;
        for (uint32_t i = 0; i < LANES && c == 0; i++)
            lane[c][i] = i % 6;
        for (uint32_t i = 0; i < LANES && c == 12; i++)
            lane[c][i] = 1e-7 + lane[c][i] * (1 - 1e-7);
        for (uint32_t i = 0; i < LANES && c == 3 * ANISOTROPY; i++)
            lane[c][i] = i % 3 ? 2 * lane[c][i] - 1 : 0;
        for (uint32_t i = 0; i < LANES && c == 3 * ROTATION; i++)
            lane[c][i] = i % 4 ? 720 * lane[c][i] - 360 : 0;
        for (uint32_t i = 0; i < LANES && c == 3 * COMPENSATION; i++)
            lane[c][i] = lane[c][i] < 0.5;
    }
    bits = sheet_bits(&sheet);
    memcpy(one.toward.x, sheet.toward.x, LANES * sizeof(double));
    memcpy(one.toward.y, sheet.toward.y, LANES * sizeof(double));
    memcpy(one.toward.z, sheet.toward.z, LANES * sizeof(double));
    for (uint32_t i = 0; i < 60; i++) {
        for (uint32_t c = 0; c < 24; c++)
            s[c] = lane[c][i];
        sheet_set(&one, s);
        sheet_evaluate(&one), sheet_density(&one);
        wrong += one.colour.r[i] != sheet.colour.r[i] || one.colour.g[i] != sheet.colour.g[i] || one.colour.b[i] != sheet.colour.b[i];
        wrong += one.density[i] != sheet.density[i];
    }
    ok(wrong == 0, "%u: settings may vary from lane to lane", isa);
    ok(guarded(sheet.colour.r, LANES) && guarded(sheet.colour.b, LANES) && guarded(sheet.density, LANES) && guarded(sheet.toward.z, LANES),
       "%u: nothing is written behind the lanes", isa);
    for (uint32_t c = 0; c < 24; c++)
        free(lane[c]);
    sheet_fini(&sheet), sheet_fini(&one);
    return bits;
}

static void test_create(void)
{
    static const struct {
        double metal;
        uint32_t reflectance, eta, k;
        int32_t status;
    } cases[] = {{BY_REFLECTANCE, 1, 0, 0, 0}, {BY_INDEX, 0, 1, 1, 0},   {GOLD, 0, 0, 0, 0},
                 {BY_REFLECTANCE, 0, 1, 0, -1}, {BY_INDEX, 1, 0, 0, -1}, {SILVER, 0, 0, 1, -1}};
    uint32_t wrong = 0;

    for (uint32_t k = 0; k < LENGTH(cases); k++) {
        double s[24];
        uint32_t given[PARAMETERS] = {1, cases[k].reflectance, cases[k].eta, cases[k].k};
        struct mcr_values values = {sizeof values, PARAMETERS, s, given};
        struct mcr_creation with = {sizeof with, 0, &values, NULL, NULL, 16, 0};
        struct mcr_context context = {.message = ""};
        void *instance;

        settings_of(s, cases[k].metal, 1, 1, 0.2);
        wrong += plugin->create(&stand_in, &context, &with, &instance) != cases[k].status || (context.message[0] != 0) != (cases[k].status < 0);
    }
    ok(wrong == 0, "%u: a setting that would be ignored is an error", isa);
    for (uint32_t leans = 0; leans < 2; leans++) {
        double s[24];
        uint32_t given[PARAMETERS] = {[ANISOTROPY] = leans};
        struct mcr_values values = {sizeof values, PARAMETERS, s, given};
        struct mcr_material_traits traits = {.size = sizeof traits};

        settings_of(s, GOLD, 1, 1, 0.2);
        plugin->traits(&stand_in, NULL, NULL, &values, &traits);
        ok(traits.does == (MCR_MATERIAL_REFLECTS | (leans ? MCR_MATERIAL_LEANS : 0)), "%u: asks for tangents where it is anisotropic alone", isa);
    }
}

static void set_compensation(struct sheet *sheet, double how)
{
    for (int i = 0; i < 8; i++)
        sheet->copies[3 * COMPENSATION][i] = how;
}

/*
 * What a white metal keeps of its light: single reflections by its own sampling, without compensation, and the lobe that comes back, which is what evaluate
 * tells more with it, by the midpoint rule over 128 cosines and 32 azimuths, on which it depends little: an error of 2e-5 at most (a quarter with half
 * the steps), to which that of albedo_numbers comes.
 */
static double kept(struct sheet *sheet, uint32_t side, struct estimate *single)
{
    double mass, with, without;

    set_compensation(sheet, 0);
    *single = albedo_numbers(sheet, side);
    without = albedo_uniform(sheet, normal, 128, 32, &mass);
    set_compensation(sheet, 1);
    with = albedo_uniform(sheet, normal, 128, 32, &mass);
    return single->mean + (with - without);
}

/*
 * With compensation the white furnace keeps its light at every angle, as the manual says: to 0.03 % from alpha = 0.1 on, below that to 0.1 % down to the
 * cosine 0.1, and to 0.6 % closer to the horizon.
 */
static void test_compensation(void)
{
    static const double alpha[] = {0.001, 0.01, 0.02, 0.03, 0.1, 0.3, 0.6, 1}, mu[] = {1, 0.7, 0.3, 0.1, 0.02};
    double worst[3] = {0, 0, 0}, most = 0;
    uint32_t bad = 0;
    struct sheet sheet;

    init(&sheet, 1);
    for (uint32_t a = 0; a < LENGTH(alpha); a++)
        for (uint32_t m = 0; m < LENGTH(mu); m++) {
            struct estimate drawn, single;
            double z, mass, all, *of = &worst[alpha[a] >= 0.1 ? 0 : mu[m] >= 0.1 ? 1 : 2];

            set(&sheet, BY_REFLECTANCE, 1, 1, alpha[a]);
            sheet_view(&sheet, normal, mu[m], 0.3);
            all = kept(&sheet, 256, &single);
            *of = fmax(*of, fabs(all - 1));
            drawn = albedo_drawn(&sheet, 8, 900 + 8 * a + m);
            bad += drawn.bad + single.bad;
            bad += alpha[a] >= 0.01 && fabs(drawn.mean - all) > 4 * drawn.error + 2e-5; /* below, a handful of the draws is of the lobe */
            most = alpha[a] >= 0.1 ? fmax(most, drawn.most) : most;
            if (alpha[a] >= 0.3 && mu[m] != 0.1) {
                z = chi_square_by(&sheet, normal, 32, 940 + 8 * a + m, 0, fine_for(alpha[a]), &mass);
                ok(z <= 4, "%u: compensated, draws follow the density, alpha %g, cos %g: chi-square z %.2f", isa, alpha[a], mu[m], z);
            }
        }
    ok(worst[0] < 3e-4 && worst[1] < 1e-3 && worst[2] < 6e-3, "%u: compensated, a white metal keeps all light (%.1e off, below alpha 0.1 %.1e, at the horizon %.1e)",
       isa, worst[0], worst[1], worst[2]);
    ok(bad == 0, "%u: compensated, what is drawn has that mean (%u wrong)", isa, bad);
    ok(most < 3, "%u: compensated, no weight above 3 from alpha 0.1 on (%.2f)", isa, most);
    sheet_fini(&sheet);
}

/*
 * The chance of the lobe that comes back: third numbers below it draw from that lobe, others by visible normals, found by 4 rounds of LANES numbers, and so
 * to LANES^-4; and it is what the density has of that lobe, to rounding: of one with compensation, on = (1 - s) off + s cos / pi.
 */
static void test_share(void)
{
    static const double alpha[] = {0.05, 0.3, 1}, mu[] = {1, 0.4, 0.05};
    double worst = 0;
    struct sheet sheet;

    init(&sheet, 1);
    for (uint32_t k = 0; k < LENGTH(alpha) * LENGTH(mu); k++) {
        double low = 0, step = 1, on, off, cosine = 0.35 / M_PI;

        set(&sheet, BY_REFLECTANCE, 1, 1, alpha[k % 3]);
        sheet_view(&sheet, normal, mu[k / 3], 0.3);
        sheet_toward(&sheet, 0, normal, 0.35, 1.9);
        sheet_density(&sheet);
        off = sheet.density[0];
        set_compensation(&sheet, 1);
        sheet_density(&sheet);
        on = sheet.density[0];
        for (int round = 0; round < 4; round++) {
            uint32_t i = 0;
            step /= LANES;
            for (uint32_t j = 0; j < LANES; j++)
                sheet.number[0][j] = 0.81, sheet.number[1][j] = 0.37, sheet.number[2][j] = low + j * step;
            sheet.number[2][LANES - 1] = 1 - U; /* surely not from the lobe */
            sheet_draw(&sheet);
            while (i < LANES && (sheet.toward.x[i] != sheet.toward.x[LANES - 1] || sheet.toward.z[i] != sheet.toward.z[LANES - 1]))
                i++;
            low += (i ? i - 1 : 0) * step;
        }
        worst = fmax(worst, fabs(low - (on - off) / (cosine - off)) / (step + 16 * U * fmax(on, cosine) / fabs(cosine - off)));
    }
    ok(worst <= 1, "%u: compensated, the lobe is drawn by the chance that the density has of it (%.2f of the error)", isa, worst);
    sheet_fini(&sheet);
}

/*
 * Anisotropic: draws follow the density, f is reciprocal, and a quarter turn of the tangent swaps the signs of the anisotropy.
 */
static void test_anisotropy(void)
{
    static const double leans[] = {0.5, -0.8, 1}, mu[] = {0.9, 0.3};
    double turned = 0;
    struct sheet sheet;

    init(&sheet, 1);
    for (uint32_t k = 0; k < LENGTH(leans); k++)
        for (uint32_t m = 0; m < LENGTH(mu); m++) {
            double mass, z, f;

            set(&sheet, BY_REFLECTANCE, 1, 1, 0.6);
            for (int i = 0; i < 8; i++)
                sheet.copies[3 * ANISOTROPY][i] = leans[k], sheet.copies[3 * ROTATION][i] = 25;
            sheet_view(&sheet, normal, mu[m], 1.1);
            if (leans[k] < 1) {
                z = chi_square_by(&sheet, normal, 64, 960 + 4 * k + m, 0, 64, &mass);
                ok(z <= 4, "%u: anisotropy %g, cos %g: draws follow the density, chi-square z %.2f", isa, leans[k], mu[m], z);
            }
            sheet_toward(&sheet, 0, normal, 0.8, 4.4);
            sheet_evaluate(&sheet);
            f = sheet.colour.g[0];
            for (int i = 0; i < 8; i++)
                sheet.copies[3 * ANISOTROPY][i] = -leans[k], sheet.copies[3 * ROTATION][i] = -65;
            sheet_evaluate(&sheet);
            turned = fmax(turned, fabs(f - sheet.colour.g[0]) / (f > 0 ? f : 1));
        }
    ok(turned < 1e-13, "%u: a quarter turn swaps the widths (%.1e)", isa, turned);
    sheet_fini(&sheet);
}

/*
 * Compensated and anisotropic, a white metal creates no light (beyond 2e-3) and keeps at least 0.92 of it, as the manual says; and `albedo` tells what is
 * kept as exactly as the plugin says: to 2e-3, where it is anisotropic to 6e-3. The error of `kept` is 1e-4 at most.
 */
static void test_whiteness(void)
{
    static const double alpha[] = {0.05, 0.15, 0.3, 0.5, 0.75, 1}, leans[] = {0, 0.3, -0.6, 0.9, 1}, mu[] = {1, 0.8, 0.4, 0.1, 0.02}, phi[] = {0, 0.8, 1.5707};
    double most = 0, least = 2, told[2] = {0, 0}; /* isotropic, anisotropic */
    struct sheet sheet;

    init(&sheet, 1);
    for (uint32_t k = 0; k < LENGTH(alpha) * LENGTH(leans) * LENGTH(mu) * LENGTH(phi); k++) {
        double a = alpha[k % 6], lean = leans[k / 6 % 5], z = mu[k / 30 % 5], turn = phi[k / 150], all;
        struct estimate single;

        if (lean == 0 && k >= 150) /* the azimuth changes nothing */
            continue;
        set(&sheet, BY_REFLECTANCE, 1, 1, a);
        for (int i = 0; i < 8; i++)
            sheet.copies[3 * ANISOTROPY][i] = lean;
        sheet_view(&sheet, normal, z, turn);
        all = kept(&sheet, 128, &single);
        struct mcr_points few = sheet.at; /* all points are the same */
        struct mcr_colours told_of = sheet.colour;
        few.n = told_of.n = 8;
        for (int compensated = 0; compensated < 2; compensated++) {
            set_compensation(&sheet, compensated);
            plugin->albedo(&stand_in, &sheet.context, NULL, &sheet.inputs, &few, &told_of);
            told[lean != 0] = fmax(told[lean != 0], fabs(sheet.colour.g[0] - (compensated ? fmin(all, 1) : single.mean)));
        }
        if (all > 1.002 || all < 0.92)
            printf("# alpha %g, anisotropy %g, cos %g, azimuth %g: %.5f\n", a, lean, z, turn, all);
        most = fmax(most, all), least = fmin(least, all);
    }
    ok(most <= 1.002 && least >= 0.92, "%u: anisotropic, a white metal creates no light and keeps 0.92 of it (%.5f to %.5f)", isa, least, most);
    ok(told[0] < 2e-3 + 1e-4 && told[1] < 6e-3 + 1e-4, "%u: albedo tells what is kept (%.1e, anisotropic %.1e)", isa, told[0], told[1]);
    sheet_fini(&sheet);
}

int main(void)
{
    const struct mcr_plugin *file = load("conductor");
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
        ok(plugin->flags == MCR_MATERIAL_STATELESS, "%u: stateless", isa);
        if (isa == widest) { /* which has the baseline's bits, as is seen below */
            test_albedo();
            test_draw();
            test_compensation();
            test_share();
            test_anisotropy();
            test_whiteness();
        }
        test_fresnel();
        test_reciprocity();
        test_extremes();
        test_horizons();
        test_create();
        bits = test_varying();
        first = isa == MCR_ISA_BASELINE ? bits : first;
        ok(bits == first, "%u: the bits of the baseline", isa);
    }
    return tap_done();
}
