/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A stand-in for the host with materials inside materials, and materials to put inside: made up ones, of which every answer is written down
 * (struct recipe), and the program's. For tests/plugins/inside.c.
 */
#ifndef TESTS_PLUGINS_INSIDE_H
#define TESTS_PLUGINS_INSIDE_H

#include "stand_in.h"

#define LANES 389u
#define MANY (1u << 17)
#define ULP 0x1p-52

#define SCATTERS (MCR_MATERIAL_REFLECTS | MCR_MATERIAL_TRANSMITS)
#define EMITS (MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK)

static struct mcr_context context;
static struct mcr_host host; /* the stand-in with materials inside materials */
static uint32_t isa;

/* What the services below have seen that must not be. */
static struct {
    const double *points;  /* the only array of positions at which a material may be asked */
    uint32_t elsewhere;    /* calls at others: a host has no inputs there */
    uint32_t lacking;      /* operations that the material does not have */
    uint32_t numbers;      /* lanes with a number outside [0,1) */
    double wanted;         /* lanes that all draws since the last reset have wanted of recipes */
} asked;

/* ---- Made up materials ---- */

/* f cos = up cos / pi above the surface and down |cos| / pi below; two lobes, mirrored and straight on; each drawn by chances that fit nothing. */
struct recipe {
    uint32_t does;
    double up[3], down[3], share_up;
    double chance[2], lobe[2][3];
    double emits[3], passes[3], albedo[3];
    double index, attenuation[3], priority;
    int32_t fails; /* what all operations return */
};

static double cosine_to(const struct mcr_points *at, const double *x, const double *y, const double *z, uint32_t i)
{
    return at->nx[i] * x[i] + at->ny[i] * y[i] + at->nz[i] * z[i];
}

static int32_t store(const struct recipe *recipe, const double colour[3], const struct mcr_colours *out)
{
    for (uint32_t i = 0; i < out->n; i++)
        out->r[i] = colour[0], out->g[i] = colour[1], out->b[i] = colour[2];
    return recipe->fails;
}

static int32_t recipe_traits(const struct mcr_host *self, struct mcr_context *in, const void *instance, const struct mcr_values *values,
                             struct mcr_material_traits *traits)
{
    const struct recipe *recipe = instance;

    (void)self, (void)in, (void)values;
    traits->does = recipe->does;
    traits->index = recipe->index;
    traits->priority = recipe->priority;
    memcpy(traits->radiance, recipe->emits, sizeof traits->radiance);
    memcpy(traits->attenuation, recipe->attenuation, sizeof traits->attenuation);
    return recipe->fails;
}

static int32_t recipe_evaluate(const struct mcr_host *self, struct mcr_context *in, const void *instance, const struct mcr_inputs *inputs,
                               const struct mcr_points *at, const struct mcr_directions *toward, const struct mcr_colours *out)
{
    const struct recipe *recipe = instance;

    (void)self, (void)in, (void)inputs;
    for (uint32_t i = 0; i < at->n; i++) {
        double c = cosine_to(at, toward->x, toward->y, toward->z, i);
        const double *f = c > 0 ? recipe->up : recipe->down;
        out->r[i] = f[0] * fabs(c) / M_PI, out->g[i] = f[1] * fabs(c) / M_PI, out->b[i] = f[2] * fabs(c) / M_PI;
    }
    return recipe->fails;
}

static int32_t recipe_density(const struct mcr_host *self, struct mcr_context *in, const void *instance, const struct mcr_inputs *inputs,
                              const struct mcr_points *at, const struct mcr_directions *toward, double *density)
{
    const struct recipe *recipe = instance;

    (void)self, (void)in, (void)inputs;
    for (uint32_t i = 0; i < at->n; i++) {
        double c = cosine_to(at, toward->x, toward->y, toward->z, i);
        density[i] = (c > 0 ? recipe->share_up : 1 - recipe->share_up) * fabs(c) / M_PI;
    }
    return recipe->fails;
}

/* Number 2 chooses the side. Lanes that are not wanted get no number at all, so that it shows who looks at them. */
static int32_t recipe_draw(const struct mcr_host *self, struct mcr_context *in, const void *instance, const struct mcr_inputs *inputs,
                           const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *density)
{
    const struct recipe *recipe = instance;

    for (uint32_t i = 0; i < at->n; i++) {
        double x, y, h = sqrt(mcr_disk_from_square(number[0][i], number[1][i], &x, &y));
        int wanted = !at->wanted || at->wanted[i] != 0;
        asked.wanted += wanted;
        asked.numbers += wanted && !(number[2][i] >= 0 && number[2][i] < 1);
        mcr_to_world(at->nx[i], at->ny[i], at->nz[i], x, y, number[2][i] < recipe->share_up ? h : -h, &out->x[i], &out->y[i], &out->z[i]);
        if (!wanted)
            out->x[i] = out->y[i] = out->z[i] = NAN;
    }
    return density ? recipe_density(self, in, instance, inputs, at, out, density) : recipe->fails;
}

static int32_t recipe_emission(const struct mcr_host *self, struct mcr_context *in, const void *instance, const struct mcr_inputs *inputs,
                               const struct mcr_points *at, const struct mcr_colours *out)
{
    (void)self, (void)in, (void)inputs, (void)at;
    return store(instance, ((const struct recipe *)instance)->emits, out);
}

static int32_t recipe_passes(const struct mcr_host *self, struct mcr_context *in, const void *instance, const struct mcr_inputs *inputs,
                             const struct mcr_points *at, const struct mcr_colours *out)
{
    (void)self, (void)in, (void)inputs, (void)at;
    return store(instance, ((const struct recipe *)instance)->passes, out);
}

static int32_t recipe_albedo(const struct mcr_host *self, struct mcr_context *in, const void *instance, const struct mcr_inputs *inputs,
                             const struct mcr_points *at, const struct mcr_colours *out)
{
    (void)self, (void)in, (void)inputs, (void)at;
    return store(instance, ((const struct recipe *)instance)->albedo, out);
}

static int32_t recipe_delta(const struct mcr_host *self, struct mcr_context *in, const void *instance, const struct mcr_inputs *inputs,
                            const struct mcr_points *at, const double *const *number, const struct mcr_directions *out, double *probability,
                            const struct mcr_colours *weight)
{
    const struct recipe *recipe = instance;

    (void)self, (void)in, (void)inputs;
    for (uint32_t i = 0; i < at->n; i++) {
        double u = number[0][i], c = cosine_to(at, at->ox, at->oy, at->oz, i), both = recipe->chance[0] + recipe->chance[1];
        int lobe = u < recipe->chance[0] ? 0 : u < both ? 1 : 2;
        double along = lobe == 0 ? 2 * c : 0, turned = lobe < 2 ? -1 : 0;

        asked.numbers += !(u >= 0 && u < 1);
        out->x[i] = along * at->nx[i] + turned * at->ox[i];
        out->y[i] = along * at->ny[i] + turned * at->oy[i];
        out->z[i] = along * at->nz[i] + turned * at->oz[i];
        probability[i] = lobe < 2 ? recipe->chance[lobe] : 1 - both;
        weight->r[i] = lobe < 2 ? recipe->lobe[lobe][0] : 0;
        weight->g[i] = lobe < 2 ? recipe->lobe[lobe][1] : 0;
        weight->b[i] = lobe < 2 ? recipe->lobe[lobe][2] : 0;
    }
    return recipe->fails;
}

static const struct mcr_material_plugin recipe_plugin = {.head = {sizeof(struct mcr_material_plugin), MCR_KIND_MATERIAL, 0, 0, "recipe", "1",
                                                                  "Apache-2.0", "for tests", NULL},
                                                         .traits = recipe_traits,
                                                         .evaluate = recipe_evaluate,
                                                         .draw = recipe_draw,
                                                         .density = recipe_density,
                                                         .emission = recipe_emission,
                                                         .delta = recipe_delta,
                                                         .passes = recipe_passes,
                                                         .albedo = recipe_albedo};

static const struct recipe two_sided = {.does = SCATTERS, .up = {0.5, 0.3, 0.1}, .down = {0.1, 0.2, 0.4}, .share_up = 0.7, .albedo = {0.6, 0.5, 0.5}};
static const struct recipe below = {.does = MCR_MATERIAL_TRANSMITS, .down = {0.9, 0.5, 0.2}, .share_up = 0.2, .albedo = {0.9, 0.5, 0.2}};
static const struct recipe all = {.does = SCATTERS | EMITS | MCR_MATERIAL_DELTA | MCR_MATERIAL_PASSES,
                                  .up = {0.2, 0.1, 0.3}, .down = {0.1, 0.2, 0.1}, .share_up = 0.4, .chance = {0.2, 0.5},
                                  .lobe = {{0.3, 0.1, 0.2}, {0.1, 0.4, 0.2}}, .emits = {1, 2, 3}, .passes = {0.2, 0.5, 0.9}, .albedo = {0.7, 0.8, 0.8}};
static const struct recipe lobes_only = {.does = MCR_MATERIAL_DELTA, .chance = {0.25, 0.75}, .lobe = {{0.5, 0.6, 0.7}, {0.4, 0.2, 0.1}},
                                         .albedo = {0.9, 0.8, 0.8}};
static const struct recipe lamp = {.does = EMITS, .emits = {5, 0, 2}};

/* ---- Trees of materials ---- */

enum kind { LEAF, MIX, MASK };

/* A material with its settings; to plugins it is a struct mcr_child. */
struct matter {
    enum kind kind;
    const struct mcr_material_plugin *plugin;
    void *instance;
    const struct matter *inner[2];
    struct mcr_material_traits traits;
    double *own[64]; /* channels: arrays of 8 or of n numbers */
    const double *channel[64];
    uint32_t stride[64];
    struct mcr_inputs inputs;
};

static const struct matter *matter_of(const struct mcr_child *child) { return (const struct matter *)(const void *)child; }

/* Fresh memory for one call, which is not a number; returns what was there before. */
static void *begin(struct mcr_context *in, const struct matter *m, const struct mcr_points *at)
{
    void *before = in->scratch;
    size_t bytes = m->plugin->scratch_bytes ? m->plugin->scratch_bytes(m->instance, at->n) : 0;

    asked.elsewhere += at->px != asked.points;
    bytes = (bytes + 127) / 64 * 64;
    in->scratch = aligned_alloc(64, bytes);
    memset(in->scratch, 0xff, bytes);
    return before;
}

static int32_t end(struct mcr_context *in, void *before, int32_t status)
{
    free(in->scratch);
    in->scratch = before;
    return status;
}

#define CALL(OPERATION, DOES, ...)                                                                                                      \
    const struct matter *m = matter_of(child);                                                                                          \
    if (!m->plugin->OPERATION || !(m->traits.does & (DOES))) {                                                                          \
        asked.lacking++;                                                                                                                \
        return MCR_E_UNSUPPORTED;                                                                                                       \
    }                                                                                                                                   \
    void *before = begin(in, m, at);                                                                                                    \
    return end(in, before, m->plugin->OPERATION(self, in, m->instance, &m->inputs, at, __VA_ARGS__))

static int32_t child_traits(const struct mcr_host *self, struct mcr_context *in, const struct mcr_child *child, struct mcr_material_traits *traits)
{
    (void)self, (void)in;
    if (matter_of(child)->plugin == &recipe_plugin && ((const struct recipe *)matter_of(child)->instance)->fails)
        return ((const struct recipe *)matter_of(child)->instance)->fails;
    *traits = matter_of(child)->traits;
    return MCR_OK;
}

static int32_t child_evaluate(const struct mcr_host *self, struct mcr_context *in, const struct mcr_child *child, const struct mcr_points *at,
                              const struct mcr_directions *toward, const struct mcr_colours *out)
{
    CALL(evaluate, SCATTERS, toward, out);
}

static int32_t child_draw(const struct mcr_host *self, struct mcr_context *in, const struct mcr_child *child, const struct mcr_points *at,
                          const double *const *number, const struct mcr_directions *out, double *density)
{
    CALL(draw, SCATTERS, number, out, density);
}

static int32_t child_density(const struct mcr_host *self, struct mcr_context *in, const struct mcr_child *child, const struct mcr_points *at,
                             const struct mcr_directions *toward, double *density)
{
    CALL(density, SCATTERS, toward, density);
}

static int32_t child_emission(const struct mcr_host *self, struct mcr_context *in, const struct mcr_child *child, const struct mcr_points *at,
                              const struct mcr_colours *out)
{
    CALL(emission, EMITS, out);
}

static int32_t child_delta(const struct mcr_host *self, struct mcr_context *in, const struct mcr_child *child, const struct mcr_points *at,
                           const double *const *number, const struct mcr_directions *out, double *probability, const struct mcr_colours *weight)
{
    CALL(delta, MCR_MATERIAL_DELTA, number, out, probability, weight);
}

static int32_t child_passes(const struct mcr_host *self, struct mcr_context *in, const struct mcr_child *child, const struct mcr_points *at,
                            const struct mcr_colours *out)
{
    CALL(passes, MCR_MATERIAL_PASSES, out);
}

static int32_t child_albedo(const struct mcr_host *self, struct mcr_context *in, const struct mcr_child *child, const struct mcr_points *at,
                            const struct mcr_colours *out)
{
    CALL(albedo, SCATTERS | MCR_MATERIAL_DELTA, out);
}

/* Channel c of n lanes: one number, or with `stream` not 0 the numbers of that stream. */
static void set_channel(struct matter *m, uint32_t c, double number, uint64_t stream, uint32_t n)
{
    m->own[c] = stream ? numbers(n, stream) : array(8);
    for (uint32_t i = 0; i < 8 && !stream; i++)
        m->own[c][i] = number;
    m->channel[c] = m->own[c];
    m->stride[c] = stream != 0;
}

static int32_t make(struct matter *m, const double *number)
{
    uint32_t given[64] = {0};
    struct mcr_values values = {sizeof values, m->plugin->head.parameter_count, number, given};
    const struct mcr_child *child[2] = {(const void *)m->inner[0], (const void *)m->inner[1]};
    struct mcr_creation with = {sizeof with, m->kind == MIX ? 2 : m->kind == MASK, &values, child, (double[]){1, 1}, 16, 0};
    int32_t status;

    context.message[0] = 0;
    m->inputs = (struct mcr_inputs){sizeof m->inputs, values.count, m->channel, m->stride};
    m->traits = (struct mcr_material_traits){.size = sizeof m->traits};
    status = m->plugin->create ? m->plugin->create(&host, &context, &with, &m->instance) : MCR_OK;
    return status ? status : m->plugin->traits(&host, &context, m->instance, &values, &m->traits);
}

static void unmake(struct matter *m)
{
    for (uint32_t c = 0; c < 64; c++)
        free(m->own[c]);
    if (m->plugin->destroy)
        m->plugin->destroy(m->instance);
}

/* A recipe as a leaf. */
static struct matter cook(const struct recipe *recipe)
{
    struct matter m = {.kind = LEAF, .plugin = &recipe_plugin, .instance = (void *)(uintptr_t)recipe};

    m.inputs = (struct mcr_inputs){sizeof m.inputs, 0, m.channel, m.stride};
    m.traits = (struct mcr_material_traits){.size = sizeof m.traits};
    recipe_traits(&host, &context, recipe, NULL, &m.traits);
    return m;
}

/* One of the program's materials with its defaults, but the first parameter, all three components of it. */
static void load_leaf(struct matter *m, const char *word, double first)
{
    const struct mcr_material_plugin *plugin = descriptor_of(load(word), isa);
    double number[3 * 64] = {0};

    *m = (struct matter){.kind = LEAF, .plugin = plugin};
    for (uint32_t p = 0; p < plugin->head.parameter_count; p++)
        for (uint32_t c = 0; c < 3; c++)
            number[3 * p + c] = p == 0 ? first : plugin->head.parameters[p].fallback[c];
    for (uint32_t c = 0; c < 3 * plugin->head.parameter_count; c++)
        set_channel(m, c, number[c], 0, 8);
    make(m, number);
}

/* A mix of two; with a stream, the amount varies. */
static int32_t mix_of(struct matter *m, const struct matter *first, const struct matter *second, double amount, uint64_t stream, uint32_t n)
{
    const double number[9] = {0, 0, 0, 1, 0, 0, amount};

    *m = (struct matter){.kind = MIX, .plugin = descriptor_of(load("mix"), isa), .inner = {first, second}};
    for (uint32_t c = 0; c < 9; c++)
        set_channel(m, c, number[c], c == 6 ? stream : 0, n);
    return make(m, number);
}

/* A mask; with a stream, green opacity varies. */
static int32_t mask_of(struct matter *m, const struct matter *material, const double opacity[3], uint64_t stream, uint32_t n)
{
    const double number[6] = {0, 0, 0, opacity[0], opacity[1], opacity[2]};

    *m = (struct matter){.kind = MASK, .plugin = descriptor_of(load("mask"), isa), .inner = {material}};
    for (uint32_t c = 0; c < 6; c++)
        set_channel(m, c, number[c], c == 4 ? stream : 0, n);
    return make(m, number);
}

#endif
