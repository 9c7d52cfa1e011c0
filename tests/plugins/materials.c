/* SPDX-License-Identifier: Apache-2.0 */
/* lambert and emitter: what they scatter and emit, for settings that are the same in all lanes and for ones that vary. */
#include "stand_in.h"

#define LANES 1037u

static struct mcr_context context;
static uint32_t isa;

/* Inputs of `count` parameters: varying ones from streams of numbers, others `number` in 8 equal copies. */
struct settings {
    double *own[12];
    const double *channel[12];
    uint32_t stride[12];
    struct mcr_inputs inputs;
};

static void set_inputs(struct settings *settings, uint32_t count, const double *number, const uint32_t *varies)
{
    for (uint32_t c = 0; c < 3 * count; c++) {
        settings->own[c] = varies[c] ? numbers(LANES, 70 + c) : array(8);
        for (uint32_t i = 0; !varies[c] && i < 8; i++)
            settings->own[c][i] = number[c];
        settings->channel[c] = settings->own[c];
        settings->stride[c] = varies[c] != 0;
    }
    settings->inputs = (struct mcr_inputs){sizeof(struct mcr_inputs), count, settings->channel, settings->stride};
}

static void free_inputs(struct settings *settings)
{
    for (uint32_t c = 0; c < 3 * settings->inputs.count; c++)
        free(settings->own[c]);
}

static double value(const struct settings *settings, uint32_t c, uint32_t i)
{
    return settings->own[c][i * settings->stride[c]];
}

static struct mcr_colours colours_array(uint32_t n)
{
    return (struct mcr_colours){sizeof(struct mcr_colours), n, array(n), array(n), array(n)};
}

static void free_colours(struct mcr_colours *colours)
{
    free(colours->r), free(colours->g), free(colours->b);
}

/*
 * evaluate against albedo / pi * cos, above both horizons, 0 elsewhere, over directions of the whole sphere. Three roundings of 2^-53 in the
 * products and those of the cosine, whose terms are at most 1 each: 8u absolute.
 */
static void test_evaluate(const struct mcr_material_plugin *plugin, uint32_t count, uint32_t first, const double *number, const uint32_t *varies,
                          const char *what)
{
    struct mcr_points at = points_array(LANES);
    struct mcr_directions toward = directions_array(LANES);
    struct mcr_colours out = colours_array(LANES);
    struct settings settings;
    uint32_t wrong = 0, black = 0;

    set_inputs(&settings, count, number, varies);
    for (uint32_t i = 0; i < LANES; i++) {
        double w[3];
        unit_vector(80, i, w);
        toward.x[i] = w[0], toward.y[i] = w[1], toward.z[i] = w[2];
    }
    plugin->evaluate(&stand_in, &context, NULL, &settings.inputs, &at, &toward, &out);
    for (uint32_t i = 0; i < LANES; i++) {
        double cosine = at.nx[i] * toward.x[i] + at.ny[i] * toward.y[i] + at.nz[i] * toward.z[i];
        double above = at.gx[i] * toward.x[i] + at.gy[i] * toward.y[i] + at.gz[i] * toward.z[i];
        double f = cosine > 0 && above > 0 ? cosine / M_PI : 0;

        black += f == 0 && cosine > 0;
        wrong += fabs(out.r[i] - f * value(&settings, first, i)) > 8 * 0x1p-53 || fabs(out.g[i] - f * value(&settings, first + 1, i)) > 8 * 0x1p-53 ||
                 fabs(out.b[i] - f * value(&settings, first + 2, i)) > 8 * 0x1p-53 || (f == 0 && (out.r[i] != 0 || out.g[i] != 0 || out.b[i] != 0));
    }
    ok(wrong == 0 && black > 0, "%s %u: scatters albedo / pi * cos, %s (%u lanes below the geometric surface only)", plugin->head.name, isa, what, black);
    ok(guarded(out.r, LANES) && guarded(out.g, LANES) && guarded(out.b, LANES), "%s %u: nothing is written behind the lanes", plugin->head.name, isa);
    free_inputs(&settings);
    free_points(&at);
    free_directions(&toward);
    free_colours(&out);
}

/* evaluate / density of what draw gives is the albedo, where the geometric normal is the shading normal: to 4 roundings. */
static void test_draw(const struct mcr_material_plugin *plugin, uint32_t count, uint32_t first, const double *number, const uint32_t *varies)
{
    struct mcr_points at = points_array(LANES);
    struct mcr_directions out = directions_array(LANES);
    struct mcr_colours f = colours_array(LANES);
    double *random[3] = {numbers(LANES, 90), numbers(LANES, 91), numbers(LANES, 92)}, *density = array(LANES), *same = array(LANES);
    struct settings settings;
    uint32_t wrong = 0, differ = 0;

    set_inputs(&settings, count, number, varies);
    memcpy((double *)at.gx, at.nx, LANES * sizeof(double));
    memcpy((double *)at.gy, at.ny, LANES * sizeof(double));
    memcpy((double *)at.gz, at.nz, LANES * sizeof(double));
    plugin->draw(&stand_in, &context, NULL, &settings.inputs, &at, (const double *const *)random, &out, density);
    plugin->density(&stand_in, &context, NULL, &settings.inputs, &at, &out, same);
    plugin->evaluate(&stand_in, &context, NULL, &settings.inputs, &at, &out, &f);
    for (uint32_t i = 0; i < LANES; i++) {
        differ += density[i] != same[i];
        wrong += !(density[i] > 0) || fabs(f.g[i] / density[i] - value(&settings, first + 1, i)) > 4 * 0x1p-53;
    }
    ok(differ == 0, "%s %u: draw and density agree to the bit", plugin->head.name, isa);
    ok(wrong == 0, "%s %u: a drawn direction has the weight of the albedo", plugin->head.name, isa);
    free_inputs(&settings);
    free_points(&at);
    free_directions(&out);
    free_colours(&f);
    free(random[0]), free(random[1]), free(random[2]), free(density), free(same);
}

static void test_emission(const struct mcr_material_plugin *plugin, const double *number, const uint32_t *varies, const char *what)
{
    struct mcr_points at = points_array(LANES);
    struct mcr_colours out = colours_array(LANES);
    struct settings settings;
    uint32_t wrong = 0;

    set_inputs(&settings, 3, number, varies);
    for (uint32_t i = 0; varies[3] && i < LANES; i++)
        settings.own[3][i] = i % 3 == 0; /* a word's number */
    plugin->emission(&stand_in, &context, NULL, &settings.inputs, &at, &out);
    for (uint32_t i = 0; i < LANES; i++) {
        double shows = at.side[i] > 0 || value(&settings, 3, i) == 1;
        wrong += out.r[i] != shows * value(&settings, 0, i) || out.g[i] != shows * value(&settings, 1, i) || out.b[i] != shows * value(&settings, 2, i);
    }
    ok(wrong == 0, "emitter %u: emission, %s", isa, what);
    ok(guarded(out.r, LANES) && guarded(out.g, LANES) && guarded(out.b, LANES), "emitter %u: nothing is written behind the lanes", isa);
    free_inputs(&settings);
    free_points(&at);
    free_colours(&out);
}

static uint32_t traits(const struct mcr_material_plugin *plugin, const double *number, double radiance[3])
{
    uint32_t given[3] = {0};
    struct mcr_values values = {sizeof values, plugin->head.parameter_count, number, given};
    struct mcr_material_traits traits = {.size = sizeof traits};
    int32_t status = plugin->traits(&stand_in, &context, NULL, &values, &traits);

    memcpy(radiance, traits.radiance, sizeof traits.radiance);
    return status ? UINT32_MAX : traits.does;
}

static void test_traits(const struct mcr_material_plugin *lambert, const struct mcr_material_plugin *emitter)
{
    const double white[3] = {1, 1, 1}, black_lamp[9] = {1, 2, 3}, two[9] = {0, 0, 1, 1, 0, 0, 0, 0.5, 0}, off[9] = {0};
    double radiance[3];

    ok(traits(lambert, white, radiance) == MCR_MATERIAL_REFLECTS && radiance[0] == 0, "lambert %u: reflects", isa);
    ok(traits(emitter, black_lamp, radiance) == MCR_MATERIAL_EMITS_FRONT && radiance[0] == 1 && radiance[2] == 3, "emitter %u: emits only", isa);
    ok(traits(emitter, two, radiance) == (MCR_MATERIAL_REFLECTS | MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK),
       "emitter %u: emits on both sides and reflects", isa);
    ok(traits(emitter, off, radiance) == 0, "emitter %u: of radiance 0 does nothing", isa);
}

/* A checksum over the bits of evaluate, draw and emission. */
static uint64_t bits_of(const struct mcr_material_plugin *plugin)
{
    const double number[9] = {0.3, 0.6, 0.9, 0, 0, 0, 0.1, 0.2, 0.7};
    const uint32_t varies[9] = {0, 1, 0, 0, 0, 0, 1, 0, 0};
    struct mcr_points at = points_array(LANES);
    struct mcr_directions out = directions_array(LANES);
    struct mcr_colours f = colours_array(LANES);
    double *random[3] = {numbers(LANES, 95), numbers(LANES, 96), numbers(LANES, 97)}, *density = array(LANES);
    struct settings settings;
    uint64_t sum = 0;

    set_inputs(&settings, plugin->head.parameter_count, number, varies);
    plugin->draw(&stand_in, &context, NULL, &settings.inputs, &at, (const double *const *)random, &out, density);
    plugin->evaluate(&stand_in, &context, NULL, &settings.inputs, &at, &out, &f);
    for (uint32_t i = 0; i < LANES; i++)
        sum = mcr_mix64(sum + mcr_bits(out.x[i]) + 3 * mcr_bits(f.r[i]) + 5 * mcr_bits(f.g[i]) + 7 * mcr_bits(f.b[i]) + 9 * mcr_bits(density[i]));
    free_inputs(&settings);
    free_points(&at);
    free_directions(&out);
    free_colours(&f);
    free(random[0]), free(random[1]), free(random[2]), free(density);
    return sum;
}

int main(void)
{
    static const double lambert_number[3] = {0.65, 0.05, 0.3}, lamp[9] = {15, 1e30, 0, 0, 0, 0, 0.25, 0.5, 1}, two[9] = {1, 2, 3, 1};
    static const uint32_t same[9] = {0}, some[9] = {0, 1, 0, 0, 0, 0, 0, 1, 1}, all[9] = {1, 1, 1, 1, 0, 0, 1, 1, 1};
    const struct mcr_plugin *lambert_file = load("lambert"), *emitter_file = load("emitter");
    uint64_t first_lambert = 0, first_emitter = 0;

    for (isa = MCR_ISA_BASELINE; isa <= MCR_ISA_AVX512; isa++) {
        const struct mcr_material_plugin *lambert = descriptor_of(lambert_file, isa), *emitter = descriptor_of(emitter_file, isa);

        if (!lambert || !emitter) {
            tap_skip("an instruction set", "this processor or build lacks it");
            continue;
        }
        ok((lambert->flags & MCR_MATERIAL_STATELESS) && (emitter->flags & MCR_MATERIAL_STATELESS), "%u: stateless", isa);
        test_traits(lambert, emitter);
        test_evaluate(lambert, 1, 0, lambert_number, same, "one albedo");
        test_evaluate(lambert, 1, 0, lambert_number, some, "green varies");
        test_evaluate(lambert, 1, 0, lambert_number, all, "all channels vary");
        test_evaluate(emitter, 3, 6, lamp, same, "one albedo");
        test_evaluate(emitter, 3, 6, lamp, some, "green and blue vary");
        test_draw(lambert, 1, 0, lambert_number, same);
        test_draw(lambert, 1, 0, lambert_number, all);
        test_draw(emitter, 3, 6, lamp, all);
        test_emission(emitter, lamp, same, "from the front");
        test_emission(emitter, two, same, "from both sides");
        test_emission(emitter, lamp, some, "green varies");
        test_emission(emitter, lamp, all, "points of several emitters");
        if (isa == MCR_ISA_BASELINE)
            first_lambert = bits_of(lambert), first_emitter = bits_of(emitter);
        ok(bits_of(lambert) == first_lambert && bits_of(emitter) == first_emitter, "%u: the bits of the baseline", isa);
    }
    return tap_done();
}
