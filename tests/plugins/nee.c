/* SPDX-License-Identifier: Apache-2.0 */
/* bsdf, nee and control: what they ask the host for, with the arrays that it handed over, and that their directions follow the densities they tell. */
#include "stand_in.h"

#define LANES 4099u

static struct mcr_context context;
static struct mcr_host host; /* the stand-in with materials and points on lights */
static uint32_t isa;
static const char *name;
static const struct mcr_material_plugin *lambert;

/* What the services below were asked. */
static struct {
    const double *points;      /* the only array of positions at which a material may be asked */
    uint32_t elsewhere;        /* calls at others: a host has no material there */
    uint32_t draws, densities, point_draws, point_densities, by;
    double wanted;             /* lanes that the last call of draw wanted */
} asked;

/* Odd lanes' material is lambert turned over: what one plugin alone could not do must come from the host. */
static void turn_odd(const struct mcr_points *at, double *x, double *y, double *z)
{
    for (uint32_t i = 1; i < at->n; i += 2) {
        double c = 2 * (x[i] * at->nx[i] + y[i] * at->ny[i] + z[i] * at->nz[i]);
        x[i] -= c * at->nx[i], y[i] -= c * at->ny[i], z[i] -= c * at->nz[i];
    }
}

static void look_at(const struct mcr_points *at)
{
    asked.elsewhere += at->px != asked.points;
    asked.wanted = at->wanted ? 0 : at->n;
    for (uint32_t i = 0; at->wanted && i < at->n; i++)
        asked.wanted += at->wanted[i];
}

static int32_t material_density(const struct mcr_host *self, struct mcr_context *in, const struct mcr_points *at, const struct mcr_directions *toward,
                                double *density)
{
    struct mcr_directions turned = directions_array(at->n);
    struct mcr_inputs inputs = {sizeof inputs, 1, NULL, NULL};
    int32_t status;

    look_at(at);
    asked.densities++;
    for (uint32_t i = 0; i < at->n; i++)
        turned.x[i] = toward->x[i], turned.y[i] = toward->y[i], turned.z[i] = toward->z[i];
    turn_odd(at, turned.x, turned.y, turned.z);
    status = lambert->density(self, in, NULL, &inputs, at, &turned, density);
    free_directions(&turned);
    return status;
}

static int32_t material_draw(const struct mcr_host *self, struct mcr_context *in, const struct mcr_points *at, const double *const *number,
                             const struct mcr_directions *out, double *density)
{
    struct mcr_inputs inputs = {sizeof inputs, 1, NULL, NULL};
    int32_t status = lambert->draw(self, in, NULL, &inputs, at, number, out, NULL);

    look_at(at);
    asked.draws++;
    turn_odd(at, out->x, out->y, out->z);
    if (!status && density) {
        status = material_density(self, in, at, out, density);
        asked.densities--;
    }
    return status;
}

/* Points on lights: the numbers themselves, so that it shows which ones came here; nothing where number 0 is below 1/4. */
static int32_t light_draw_point(const struct mcr_host *self, struct mcr_context *in, uint32_t by, const struct mcr_points *at,
                                const double *const *number, const struct mcr_emitter_points *out, double *density)
{
    (void)self, (void)in;
    asked.point_draws++;
    asked.by = by;
    for (uint32_t i = 0; i < at->n; i++) {
        out->emitter[i] = number[0][i] < 0.25 ? -1 : 7;
        out->qx[i] = number[0][i], out->qy[i] = number[1][i], out->qz[i] = number[2][i];
        out->wx[i] = out->wy[i] = 0, out->wz[i] = out->distance[i] = 1;
        if (density)
            density[i] = out->emitter[i] < 0 ? 0 : 2.5;
    }
    return MCR_OK;
}

static int32_t light_density_point(const struct mcr_host *self, struct mcr_context *in, uint32_t by, const struct mcr_points *at,
                                   const struct mcr_emitter_points *points, double *density)
{
    (void)self, (void)in;
    asked.point_densities++;
    asked.by = by;
    for (uint32_t i = 0; i < at->n; i++)
        density[i] = points->emitter[i] < 0 ? 0 : 2.5;
    return MCR_OK;
}

static int32_t failing_draw(const struct mcr_host *self, struct mcr_context *in, const struct mcr_points *at, const double *const *number,
                            const struct mcr_directions *out, double *density)
{
    (void)self, (void)in, (void)at, (void)number, (void)out, (void)density;
    return MCR_E_UNSUPPORTED;
}

static int32_t failing_density(const struct mcr_host *self, struct mcr_context *in, const struct mcr_points *at, const struct mcr_directions *toward,
                               double *density)
{
    (void)self, (void)in, (void)at, (void)toward, (void)density;
    return MCR_E_UNSUPPORTED;
}

static int32_t failing_light_draw(const struct mcr_host *self, struct mcr_context *in, uint32_t by, const struct mcr_points *at,
                                  const double *const *number, const struct mcr_emitter_points *out, double *density)
{
    (void)self, (void)in, (void)by, (void)at, (void)number, (void)out, (void)density;
    return MCR_E_UNSUPPORTED;
}

/* Technique 0 of both: the material's draw and density, to the bit, in every lane count, nothing behind the lanes, all points as they came. */
static void test_material(struct mcr_child *child, uint32_t n)
{
    struct mcr_points at = points_array(n);
    struct mcr_directions out = directions_array(n), own = directions_array(n);
    double *number[6], *density = array(n), *same = array(n), *direct = array(n);
    uint32_t wrong = 0, below = 0;

    for (int k = 0; k < 6; k++)
        number[k] = numbers(n, 50 + k);
    asked.points = at.px;
    asked.elsewhere = asked.draws = asked.densities = 0;
    wrong += child->plugin->draw(&host, &context, child->instance, 0, &at, (const double *const *)number, &out, density) != MCR_OK;
    wrong += child->plugin->density(&host, &context, child->instance, 0, &at, &out, same) != MCR_OK;
    ok(wrong == 0 && asked.draws == 1 && asked.densities == 1 && asked.elsewhere == 0, "%s %u: the host is asked once, at the points as they came",
       name, isa);
    material_draw(&host, &context, &at, (const double *const *)number, &own, direct);
    for (uint32_t i = 0; i < n; i++) {
        wrong += out.x[i] != own.x[i] || out.y[i] != own.y[i] || out.z[i] != own.z[i] || density[i] != direct[i] || same[i] != direct[i];
        wrong += !(density[i] > 0);
        below += at.nx[i] * out.x[i] + at.ny[i] * out.y[i] + at.nz[i] * out.z[i] < 0;
    }
    ok(wrong == 0 && below == n / 2, "%s %u: %u directions and densities are the material's, to the bit", name, isa, n);
    wrong = child->plugin->draw(&host, &context, child->instance, 0, &at, (const double *const *)number, &out, NULL) != MCR_OK;
    ok(wrong == 0 && guarded(out.x, n) && guarded(out.y, n) && guarded(out.z, n) && guarded(density, n) && guarded(same, n),
       "%s %u: without a density, too; nothing is written behind lane %u", name, isa, n);
    free_points(&at);
    free_directions(&out);
    free_directions(&own);
    for (int k = 0; k < 6; k++)
        free(number[k]);
    free(density), free(same), free(direct);
}

/*
 * Chi-square of N directions against the density that the sampler tells, over 16 x 32 cells of height and azimuth of the whole sphere
 * about one normal; each cell's expected count is the density's integral by the midpoint rule on 16 x 16 points, exact to 1e-3 of a cell's count at the worst: the
 * densities are at most linear in height. Wilson and Hilferty (1931) make a normal deviate of it. Even and odd lanes scatter to different sides.
 */
static void test_chi_square(struct mcr_child *child, const char *what)
{
    enum { ROWS = 16, COLUMNS = 32, FINE = 16, N = 1 << 17 };
    struct mcr_points at = points_array(N);
    struct mcr_directions out = directions_array(N), toward = directions_array(N);
    double *number[6], *density = array(N), chi = 0, df = -1, z, total = 0;
    double n[3] = {at.nx[9], at.ny[9], at.nz[9]}, tx, ty, tz, bx, by, bz;
    static double count[ROWS][COLUMNS], expected[ROWS][COLUMNS];

    memset(count, 0, sizeof count);
    memset(expected, 0, sizeof expected);
    for (int k = 0; k < 6; k++)
        number[k] = numbers(N, 80 + k);
    for (uint32_t i = 0; i < N; i++)
        ((double *)at.nx)[i] = n[0], ((double *)at.ny)[i] = n[1], ((double *)at.nz)[i] = n[2];
    mcr_basis(n[0], n[1], n[2], &tx, &ty, &tz, &bx, &by, &bz);
    asked.points = at.px;
    stand_in_draw(&host, &context, child, 0, &at, (const double *const *)number, &out, NULL);
    for (uint32_t i = 0; i < N; i++) {
        double h = n[0] * out.x[i] + n[1] * out.y[i] + n[2] * out.z[i];
        double azimuth = atan2(out.x[i] * bx + out.y[i] * by + out.z[i] * bz, out.x[i] * tx + out.y[i] * ty + out.z[i] * tz);
        int row = (int)((h + 1) / 2 * ROWS), column = (int)((azimuth / (2 * M_PI) + 0.5) * COLUMNS);

        count[row < ROWS ? row : ROWS - 1][column < COLUMNS ? column : COLUMNS - 1]++;
    }
    /* ROWS * COLUMNS * FINE * FINE = N points of equal solid angle, twice: once asked in even lanes, once in odd ones. */
    for (uint32_t shift = 0; shift < 2; shift++) {
        for (uint32_t i = 0; i < N; i++) {
            uint32_t cell = ((i >> 1 << 1) + (i + shift) % 2), r = cell / (COLUMNS * FINE), c = cell % (COLUMNS * FINE);
            double h = 2 * (r + 0.5) / (ROWS * FINE) - 1, s = sqrt(1 - h * h), phi = 2 * M_PI * ((c + 0.5) / (COLUMNS * FINE) - 0.5);

            toward.x[i] = s * cos(phi) * tx + s * sin(phi) * bx + h * n[0];
            toward.y[i] = s * cos(phi) * ty + s * sin(phi) * by + h * n[1];
            toward.z[i] = s * cos(phi) * tz + s * sin(phi) * bz + h * n[2];
        }
        stand_in_density(&host, &context, child, 0, &at, &toward, density);
        for (uint32_t i = 0; i < N; i++) {
            uint32_t cell = ((i >> 1 << 1) + (i + shift) % 2);
            expected[cell / (COLUMNS * FINE) / FINE][cell % (COLUMNS * FINE) / FINE] += density[i] * 4 * M_PI / 2;
        }
    }
    for (int r = 0; r < ROWS; r++)
        for (int c = 0; c < COLUMNS; c++) {
            df += expected[r][c] > 0;
            total += expected[r][c];
            if (expected[r][c] > 0 || count[r][c] > 0)
                chi += (count[r][c] - expected[r][c]) * (count[r][c] - expected[r][c]) / expected[r][c];
        }
    z = (cbrt(chi / df) - (1 - 2 / (9 * df))) / sqrt(2 / (9 * df));
    ok(fabs(total / N - 1) < 1e-4 && fabs(z) <= 4, "%s %u: directions follow the density, %s (integral %.6f, chi-square %.1f of %g, z %.2f)", name, isa,
       what, total / N, chi, df, z);
    free_points(&at);
    free_directions(&out);
    free_directions(&toward);
    for (int k = 0; k < 6; k++)
        free(number[k]);
    free(density);
}

/* Technique 1 of nee and control: the host's points, by what was asked for. */
static void test_emitter(struct mcr_child *child, uint32_t by)
{
    struct mcr_points at = points_array(LANES);
    double *number[3] = {numbers(LANES, 1), numbers(LANES, 2), numbers(LANES, 3)}, *place[7], *density = array(LANES), *same = array(LANES);
    int32_t *emitter = aligned_alloc(64, (LANES + 31) / 16 * 16 * sizeof *emitter);
    uint32_t wrong = 0, nothing = 0;

    for (int k = 0; k < 7; k++)
        place[k] = array(LANES);
    struct mcr_emitter_points out = {sizeof out, LANES, emitter, place[0], place[1], place[2], place[3], place[4], place[5], place[6]};
    asked.by = 99, asked.point_draws = asked.point_densities = 0;
    wrong += child->plugin->draw_emitter(&host, &context, child->instance, 1, &at, (const double *const *)number, &out, density) != MCR_OK;
    wrong += asked.by != by;
    asked.by = 99;
    wrong += child->plugin->density_emitter(&host, &context, child->instance, 1, &at, &out, same) != MCR_OK;
    wrong += asked.by != by;
    for (uint32_t i = 0; i < LANES; i++) {
        nothing += emitter[i] < 0;
        wrong += out.qx[i] != number[0][i] || out.qz[i] != number[2][i] || density[i] != same[i] || density[i] != (emitter[i] < 0 ? 0 : 2.5);
    }
    ok(wrong == 0 && nothing > 0 && asked.point_draws == 1 && asked.point_densities == 1, "%s %u: points on emitters are the host's, by %s", name, isa,
       by ? "solid angle" : "area");
    wrong = child->plugin->draw_emitter(&host, &context, child->instance, 1, &at, (const double *const *)number, &out, NULL) != MCR_OK;
    ok(wrong == 0, "%s %u: without a density, too", name, isa);
    free_points(&at);
    for (int k = 0; k < 3; k++)
        free(number[k]);
    for (int k = 0; k < 7; k++)
        free(place[k]);
    free(density), free(same), free(emitter);
}

/* A failure of the host is handed on. */
static void test_failures(struct mcr_child *child, int emitter)
{
    struct mcr_host failing = host;
    struct mcr_points at = points_array(8);
    struct mcr_directions out = directions_array(8);
    struct mcr_emitter_points points = {.size = sizeof points, .n = 8};
    double *number[3] = {numbers(8, 1), numbers(8, 2), numbers(8, 3)}, *density = array(8);

    failing.material_draw = failing_draw;
    failing.material_density = failing_density;
    failing.light_draw_point = failing_light_draw;
    ok(child->plugin->draw(&failing, &context, child->instance, 0, &at, (const double *const *)number, &out, density) == MCR_E_UNSUPPORTED &&
           child->plugin->density(&failing, &context, child->instance, 0, &at, &out, density) == MCR_E_UNSUPPORTED &&
           (!emitter || child->plugin->draw_emitter(&failing, &context, child->instance, 1, &at, (const double *const *)number, &points, density) ==
                            MCR_E_UNSUPPORTED),
       "%s %u: a failure is handed on", name, isa);
    free_points(&at);
    free_directions(&out);
    free(number[0]), free(number[1]), free(number[2]), free(density);
}

static int tells(const struct mcr_technique *technique, uint32_t kind, uint32_t covers, uint32_t continues)
{
    return technique->kind == kind && technique->covers == covers && technique->continues == continues && technique->dimensions == 3;
}

#define ALL (MCR_COVERS_REFLECTION | MCR_COVERS_TRANSMISSION)

static void test_bsdf(const struct mcr_directions_plugin *plugin)
{
    struct mcr_child child;

    name = "bsdf";
    for (context.has_lights = 0; context.has_lights < 2; context.has_lights++)
        ok(make_child(&child, &context, plugin, 0, 0, NULL, NULL) == MCR_OK && child.technique_count == 1 &&
               tells(&child.technique[0], MCR_TECHNIQUE_DIRECTION, ALL, 1),
           "bsdf %u: one technique, covering what materials scatter, %s lights", isa, context.has_lights ? "with" : "without");
    for (uint32_t n = 1; n <= 17; n += 8)
        test_material(&child, n);
    test_material(&child, LANES);
    test_chi_square(&child, "alone");
    test_failures(&child, 0);
}

/* nee, and control, which is nee but for a flag of the points' technique. */
static void test_nee(const struct mcr_directions_plugin *plugin, uint32_t flags)
{
    struct mcr_child child;

    name = plugin->head.name;
    context.has_lights = 0;
    ok(make_child(&child, &context, plugin, 1, 0, NULL, NULL) == MCR_OK && child.technique_count == 1 &&
           tells(&child.technique[0], MCR_TECHNIQUE_DIRECTION, ALL, 1),
       "%s %u: without lights, the material's technique alone", name, isa);
    context.has_lights = 1;
    for (uint32_t by = MCR_LIGHT_BY_AREA; by <= MCR_LIGHT_BY_SOLID_ANGLE; by++) {
        ok(make_child(&child, &context, plugin, by, 0, NULL, NULL) == MCR_OK && child.technique_count == 2 &&
               tells(&child.technique[0], MCR_TECHNIQUE_DIRECTION, ALL, 1) &&
               tells(&child.technique[1], MCR_TECHNIQUE_EMITTER, MCR_COVERS_EMITTERS, 0) && child.technique[0].flags == 0 &&
               child.technique[1].flags == flags,
           "%s %u: the material's technique continues, another draws points on emitters", name, isa);
        test_emitter(&child, by);
    }
    test_material(&child, 17);
    test_material(&child, LANES);
    test_chi_square(&child, "of the material's technique");
    test_failures(&child, 1);
}

/* bsdf inside mixture: asked at the very points, told in which lanes it was chosen. nee has two techniques and is refused. */
static void test_inside(const struct mcr_directions_plugin *bsdf, const struct mcr_directions_plugin *nee, const struct mcr_directions_plugin *uniform,
                        const struct mcr_directions_plugin *mixture)
{
    struct mcr_child leaf[2], child, refused;
    const struct mcr_child *inner[2] = {&leaf[0], &leaf[1]};
    const double weight[2] = {3, 1};
    struct mcr_points at = points_array(LANES);
    struct mcr_directions out = directions_array(LANES);
    double *number[4], *density = array(LANES), chosen = 0;

    name = "mixture(bsdf, uniform)";
    make_child(&leaf[0], &context, bsdf, 0, 0, NULL, NULL);
    make_child(&leaf[1], &context, uniform, 0, 0, NULL, NULL);
    ok(make_child(&child, &context, mixture, 0, 2, inner, weight) == MCR_OK && child.technique[0].dimensions == 4 && child.technique[0].covers == ALL,
       "mixture %u: takes bsdf in and covers what it covers", isa);
    for (int k = 0; k < 4; k++)
        number[k] = numbers(LANES, 40 + k);
    for (uint32_t i = 0; i < LANES; i++)
        chosen += number[0][i] < 0.75;
    asked.points = at.px;
    asked.elsewhere = asked.draws = asked.densities = 0;
    context.scratch = new_scratch(mixture, child.instance, LANES);
    child.plugin->draw(&host, &context, child.instance, 0, &at, (const double *const *)number, &out, NULL);
    ok(asked.draws == 1 && asked.densities == 0 && asked.elsewhere == 0 && asked.wanted == chosen,
       "mixture %u: the material is asked at the points as they came, for the %.0f lanes that chose it", isa, chosen);
    child.plugin->density(&host, &context, child.instance, 0, &at, &out, density);
    ok(asked.densities == 1 && asked.elsewhere == 0 && asked.wanted == LANES, "mixture %u: the density in all lanes", isa);
    free(context.scratch);
    context.scratch = NULL;
    test_chi_square(&child, "mixed with uniform");
    destroy_child(&child);
    make_child(&leaf[1], &context, nee, 1, 0, NULL, NULL);
    ok(make_child(&refused, &context, mixture, 0, 2, inner, weight) == MCR_E_INVALID && strstr(context.message, "number 2"),
       "mixture %u: nee is refused: %s", isa, context.message);
    ok(make_child(&refused, &context, bsdf, 0, 1, inner, weight) == MCR_E_INVALID && context.message[0], "bsdf %u: children are refused: %s", isa,
       context.message);
    ok(make_child(&refused, &context, nee, 1, 1, inner, weight) == MCR_E_INVALID && context.message[0], "nee %u: children are refused: %s", isa,
       context.message);
    free_points(&at);
    free_directions(&out);
    for (int k = 0; k < 4; k++)
        free(number[k]);
    free(density);
}

int main(void)
{
    const struct mcr_plugin *bsdf = load("bsdf"), *nee = load("nee"), *control = load("control"), *uniform = load("uniform"), *mixture = load("mixture"),
                            *material = load("lambert");

    host = stand_in;
    host.material_draw = material_draw;
    host.material_density = material_density;
    host.light_draw_point = light_draw_point;
    host.light_density_point = light_density_point;
    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        const struct mcr_directions_plugin *one = descriptor_of(bsdf, isa), *two = descriptor_of(nee, isa),
                                           *three = descriptor_of(control, isa);

        lambert = descriptor_of(material, isa);
        if (!one || !two || !three || !lambert) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        test_bsdf(one);
        test_nee(two, 0);
        test_nee(three, MCR_TECHNIQUE_CONTROL);
        test_inside(one, two, descriptor_of(uniform, isa), descriptor_of(mixture, isa));
    }
    return tap_done();
}
