/* SPDX-License-Identifier: Apache-2.0 */
/* mixture and light: which child draws, what is asked of whom, and what the host's light services are asked for. */
#include "stand_in.h"

#define LANES 20011u

static struct mcr_context context = {.has_lights = 1};
static uint32_t isa;
static const struct mcr_directions_plugin *uniform, *cosine, *light, *mixture;

static void test_light(void)
{
    struct mcr_points at = points_array(64);
    struct mcr_directions out = directions_array(64);
    double *number[3] = {numbers(64, 1), numbers(64, 2), numbers(64, 3)}, *density = array(64), *mass = array(64);
    uint32_t wrong = 0;
    struct mcr_child child;

    for (uint32_t by = MCR_LIGHT_BY_AREA; by <= MCR_LIGHT_BY_SOLID_ANGLE; by++) {
        ok(make_child(&child, &context, light, by, 0, NULL, NULL) == MCR_OK && child.technique[0].covers == MCR_COVERS_EMITTERS &&
               child.technique[0].dimensions == MCR_LIGHT_DIMENSIONS && child.technique[0].continues == 1,
           "light %u: created, covering emitters", isa);
        context.asked_by = 99;
        stand_in_draw(&stand_in, &context, &child, 0, &at, (const double *const *)number, &out, density);
        wrong += context.asked_by != by;
        context.asked_by = 99;
        stand_in_density(&stand_in, &context, &child, 0, &at, &out, density);
        wrong += context.asked_by != by;
        context.asked_by = 99;
        stand_in_mass(&stand_in, &context, &child, 0, &at, mass);
        wrong += context.asked_by != by || mass[0] != 0.5;
        ok(wrong == 0, "light %u: asks the host, by %s", isa, by ? "solid angle" : "area");
    }
    context.has_lights = 0;
    ok(make_child(&child, &context, light, 0, 0, NULL, NULL) == MCR_E_INVALID && context.message[0], "light %u: refused without lights: %s", isa,
       context.message);
    context.has_lights = 1;
    free_points(&at);
    free_directions(&out);
    free(number[0]), free(number[1]), free(number[2]), free(density), free(mass);
}

/* Three children of weights 1, 2 and 5: what each lane's child would have drawn, the weighted density, nothing where light drew nothing. */
static void test_choice(void)
{
    struct mcr_child leaf[3], child;
    const struct mcr_child *inner[3] = {&leaf[0], &leaf[1], &leaf[2]};
    const double weight[3] = {1, 2, 5};
    struct mcr_points at = points_array(LANES);
    struct mcr_directions out = directions_array(LANES), each[3];
    double *number[4], *density = array(LANES), *mass = array(LANES), *part[3], worst = 0;
    uint32_t wrong = 0, count[3] = {0}, nothing = 0;

    make_child(&leaf[0], &context, cosine, 0, 0, NULL, NULL);
    make_child(&leaf[1], &context, light, 1, 0, NULL, NULL);
    make_child(&leaf[2], &context, uniform, 0, 0, NULL, NULL);
    ok(make_child(&child, &context, mixture, 0, 3, inner, weight) == MCR_OK && child.technique[0].dimensions == 4 &&
           child.technique[0].covers == (MCR_COVERS_REFLECTION | MCR_COVERS_EMITTERS),
       "mixture %u: 1 + 3 numbers, covering what its children cover", isa);
    for (int k = 0; k < 4; k++)
        number[k] = numbers(LANES, 40 + k);
    number[0][0] = 0, number[0][1] = 1 - 0x1p-53, number[0][2] = 0.125, number[0][3] = 0.375, number[0][4] = nextafter(0.375, 0);
    for (int k = 0; k < 3; k++) {
        each[k] = directions_array(LANES);
        part[k] = array(LANES);
        stand_in_draw(&stand_in, &context, &leaf[k], 0, &at, (const double *const *)number + 1, &each[k], NULL);
        leaf[k].draws = leaf[k].densities = 0;
    }
    stand_in_draw(&stand_in, &context, &child, 0, &at, (const double *const *)number, &out, density);
    ok(leaf[0].draws == 1 && leaf[1].draws == 1 && leaf[2].draws == 1 && leaf[0].densities == 1 && leaf[1].densities == 1 && leaf[2].densities == 1,
       "mixture %u: every child draws once and tells its density once", isa);
    for (int k = 0; k < 3; k++)
        stand_in_density(&stand_in, &context, &leaf[k], 0, &at, &out, part[k]);
    for (uint32_t i = 0; i < LANES; i++) {
        int k = number[0][i] < 0.125 ? 0 : number[0][i] < 0.375 ? 1 : 2;
        int drawn = out.x[i] != 0 || out.y[i] != 0 || out.z[i] != 0;
        double expected = 0.125 * part[0][i] + 0.25 * part[1][i] + 0.625 * part[2][i];

        count[k]++;
        nothing += !drawn;
        wrong += out.x[i] != each[k].x[i] || out.y[i] != each[k].y[i] || out.z[i] != each[k].z[i] || (drawn ? !(density[i] > 0) : density[i] != 0);
        worst = fmax(worst, fabs(density[i] - expected) / (expected + (expected == 0)));
    }
    ok(wrong == 0 && count[0] && count[1] && count[2], "mixture %u: each lane has the direction of the child that its number 0 chose", isa);
    ok(nothing > 0, "mixture %u: where light drew nothing, nothing is drawn, with density 0 (%u lanes)", isa, nothing);
    ok(worst <= 4 * 0x1p-53, "mixture %u: the density is the weighted sum (error %.1fu)", isa, worst / 0x1p-53);
    stand_in_mass(&stand_in, &context, &child, 0, &at, mass);
    ok(mass[7] == 0.125 + 0.25 * 0.5 + 0.625, "mixture %u: the mass is the weighted sum", isa);
    leaf[0].densities = 0;
    stand_in_draw(&stand_in, &context, &child, 0, &at, (const double *const *)number, &out, NULL);
    ok(leaf[0].densities == 0, "mixture %u: no density is asked for where none is wanted", isa);
    destroy_child(&child);
    for (int k = 0; k < 3; k++)
        free_directions(&each[k]), free(part[k]);
    for (int k = 0; k < 4; k++)
        free(number[k]);
    free_points(&at);
    free_directions(&out);
    free(density), free(mass);
}

static void test_weights(void)
{
    struct mcr_child leaf[16], child;
    const struct mcr_child *inner[16];
    double weight[16] = {0};
    struct mcr_points at = points_array(100);
    struct mcr_directions out = directions_array(100);
    double *number[4], *density = array(100);

    for (int k = 0; k < 4; k++)
        number[k] = numbers(100, 60 + k);
    for (int k = 0; k < 16; k++) {
        make_child(&leaf[k], &context, k % 2 ? uniform : cosine, 0, 0, NULL, NULL);
        inner[k] = &leaf[k];
    }
    ok(make_child(&child, &context, mixture, 0, 16, inner, weight) == MCR_E_INVALID && context.message[0], "mixture %u: weights 0 are refused: %s",
       isa, context.message);
    ok(make_child(&child, &context, mixture, 0, 0, inner, weight) == MCR_E_INVALID && context.message[0], "mixture %u: no children are refused: %s",
       isa, context.message);
    weight[3] = weight[12] = 1.7e308; /* their sum overflows, their shares are 1/2 */
    ok(make_child(&child, &context, mixture, 0, 16, inner, weight) == MCR_OK && child.technique[0].dimensions == 3, "mixture %u: huge weights", isa);
    stand_in_draw(&stand_in, &context, &child, 0, &at, (const double *const *)number, &out, density);
    ok(leaf[3].draws == 1 && leaf[12].draws == 1 && leaf[0].draws == 0 && leaf[0].densities == 0 && leaf[15].draws == 0 && density[0] > 0 &&
           isfinite(density[0]),
       "mixture %u: children of weight 0 are never called", isa);
    destroy_child(&child);
    leaf[12].technique_count = 2;
    ok(make_child(&child, &context, mixture, 0, 16, inner, weight) == MCR_E_INVALID && strstr(context.message, "number 13"),
       "mixture %u: a child of two techniques is refused: %s", isa, context.message);
    leaf[12].technique_count = 1;
    leaf[2].technique[0].kind = MCR_TECHNIQUE_EMITTER;
    ok(make_child(&child, &context, mixture, 0, 16, inner, weight) == MCR_E_INVALID && strstr(context.message, "number 3"),
       "mixture %u: a child that draws points is refused: %s", isa, context.message);
    for (int k = 0; k < 4; k++)
        free(number[k]);
    free_points(&at);
    free_directions(&out);
    free(density);
}

int main(void)
{
    const struct mcr_plugin *file[4] = {load("uniform"), load("cosine"), load("light"), load("mixture")};

    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        uniform = descriptor_of(file[0], isa);
        cosine = descriptor_of(file[1], isa);
        light = descriptor_of(file[2], isa);
        mixture = descriptor_of(file[3], isa);
        if (!uniform || !cosine || !light || !mixture) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        test_light();
        test_choice();
        test_weights();
    }
    return tap_done();
}
