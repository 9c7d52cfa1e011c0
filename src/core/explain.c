/* SPDX-License-Identifier: Apache-2.0 */
#include "core/explain.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/assemble.h"
#include "core/compat.h"
#include "core/host.h"
#include "core/pass.h"

const char *const mcr_explained_emitter_kind[MCR_EXPLAINED_EMITTER_KINDS] = {
    [MCR_EMITTER_PARALLELOGRAM] = "parallelogram", [MCR_EMITTER_TRIANGLE] = "triangle",   [MCR_EMITTER_DISK] = "disk",
    [MCR_EMITTER_SPHERE] = "sphere",               [MCR_EMITTER_ELLIPSOID] = "ellipsoid",
};
_Static_assert(MCR_EXPLAINED_EMITTER_KINDS == MCR_EMITTER_KINDS, "kinds of emitters");

#define NAMES_SHOWN 4u /* the rest is counted */

/* A core that features are taken out of, one after the other, and what it was assembled from. */
struct subject {
    struct mcr_core core;
    struct mcr_scene scene;
    struct mcr_sampler sampler;
    const uint8_t *used;      /* by material: a surface has it */
    uint8_t *marked;          /* by material or texture: for lists of names */
};

/* ---- Clauses --------------------------------------------------------------------------------------------------- */

struct clause {
    char *text;
    size_t used, size;
};

static void say(struct clause *c, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void say(struct clause *c, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int n = vsnprintf(c->text + c->used, c->size - c->used, format, arguments);
    va_end(arguments);
    c->used += n < 0 ? 0 : (size_t)n;
    c->used = c->used < c->size ? c->used : c->size - 1;
}

/* Name `i` of `count`, which is shown only if it is among the first. */
static void say_name(struct clause *c, const char *name, uint32_t i, uint32_t count)
{
    if (i < NAMES_SHOWN)
        say(c, "%s%.40s", i ? ", " : "", name ? name : "(no name)");
    else if (i == NAMES_SHOWN)
        say(c, " and %u more", count - NAMES_SHOWN);
}

/* "2 materials BEHIND: glass, mirror", of those marked; returns how many they are. */
static int say_materials(struct subject *s, struct clause *c, const char *behind, const char *behind_one, const char *none)
{
    uint32_t count = 0, i = 0;
    for (uint32_t m = 0; m < s->scene.material_count; m++)
        count += s->marked[m];
    if (!count) {
        say(c, "no material %s", none);
        return 0;
    }
    say(c, "%u material%s %s: ", count, count > 1 ? "s" : "", count > 1 ? behind : behind_one);
    for (uint32_t m = 0; m < s->scene.material_count; m++)
        if (s->marked[m])
            say_name(c, s->scene.material[m].name, i++, count);
    return 1;
}

/* Marks used materials that do something of `does`. */
static void mark_does(struct subject *s, uint32_t does)
{
    for (uint32_t m = 0; m < s->scene.material_count; m++)
        s->marked[m] = s->used[m] && (s->scene.material[m].traits.does & does);
}

static void mark_needs(struct subject *s, uint32_t needs)
{
    for (uint32_t m = 0; m < s->scene.material_count; m++)
        s->marked[m] = s->used[m] && (s->scene.material[m].needs & needs);
}

/* ---- Features: whether, why, and the core without ---------------------------------------------------------------- */

static int layers_why(struct subject *s, struct clause *c)
{
    static const char *const word[] = {"albedo", "normal", "depth", "id", "direct and indirect light"};
    const char *between = "asked for: ";
    for (uint32_t i = 0; i < sizeof word / sizeof *word; i++)
        if (s->core.features & 1u << i) {
            say(c, "%s%s", between, word[i]);
            between = ", ";
        }
    if (!s->core.features)
        say(c, "no layer is asked for");
    return s->core.features != 0;
}

static void layers_without(struct subject *s)
{
    s->core.features = 0;
}

static int weights_why(struct subject *s, struct clause *c)
{
    say(c, s->scene.film.filter_edge ? "filter mitchell is negative in parts" : "the filter gives all samples the same weight");
    return s->scene.film.filter_edge != NULL;
}

static void weights_without(struct subject *s)
{
    s->scene.film.filter_edge = NULL;
}

static int compat_why(struct subject *s, struct clause *c)
{
    char text[MCR_COMPAT_TEXT];
    mcr_compat_text(s->scene.render.compat, text);
    if (s->scene.render.compat)
        say(c, "wrong on purpose: %s", text);
    else
        say(c, "no quirk is asked for");
    return s->scene.render.compat != 0;
}

static void compat_without(struct subject *s)
{
    s->scene.render.compat = 0;
}

static int rounds_why(struct subject *s, struct clause *c)
{
    const struct mcr_render_settings *r = &s->scene.render;
    const char *between = "";
    if (!mcr_render_in_rounds(r))
        say(c, "every pixel has spp samples");
    if (r->time > 0)
        say(c, "time %g s", r->time);
    between = c->used ? ", " : "";
    if (r->target_error > 0)
        say(c, "%starget_error %g", between, r->target_error);
    between = c->used ? ", " : "";
    if (r->adaptive && !r->mapped)
        say(c, "%sadaptive", between);
    if (r->mapped)
        say(c, "%sa sample map", between);
    return mcr_render_in_rounds(r);
}

static int lens_why(struct subject *s, struct clause *c)
{
    int lens = s->scene.camera.kind == MCR_CAMERA_THIN_LENS && s->scene.camera.lens_radius > 0;
    say(c, lens ? "the camera has a lens" : "the camera has no lens");
    return lens;
}

/* What needs coordinates still has them. */
static void need_less(struct subject *s, uint32_t needs)
{
    if (s->core.charts.needs)
        s->core.charts.needs = (s->core.charts.needs & ~needs) | MCR_NEEDS_COORDINATES;
}

static int normals_why(struct subject *s, struct clause *c)
{
    mark_needs(s, MCR_NEEDS_NORMALS);
    return say_materials(s, c, "have normal maps or bumps", "has a normal map or bumps", "has a normal map or bumps");
}

static void normals_without(struct subject *s)
{
    need_less(s, MCR_NEEDS_NORMALS);
}

static int smooth_why(struct subject *s, struct clause *c)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < s->scene.triangles.count && s->scene.triangles.normal; t++)
        count += s->scene.triangles.normal[t][0] != UINT32_MAX;
    if (s->core.surfaces.smooth)
        say(c, count == 1 ? "%u triangle has normals of its own" : "%u triangles have normals of their own", count);
    else
        say(c, "no triangle has normals of its own");
    return s->core.surfaces.smooth;
}

static void smooth_without(struct subject *s)
{
    s->core.surfaces.smooth = 0;
}

static int tangents_why(struct subject *s, struct clause *c)
{
    mark_needs(s, MCR_NEEDS_TANGENTS);
    return say_materials(s, c, "ask for tangents", "asks for tangents", "asks for tangents");
}

static void tangents_without(struct subject *s)
{
    need_less(s, MCR_NEEDS_TANGENTS);
}

/* Whether one of the material's parameters is a texture. */
static int is_textured(const struct mcr_core *core, uint32_t m)
{
    return core->textured_from && core->textured_from[m + 1] > core->textured_from[m];
}

static int textures_why(struct subject *s, struct clause *c)
{
    for (uint32_t m = 0; m < s->scene.material_count; m++)
        s->marked[m] = s->used[m] && is_textured(&s->core, m);
    return say_materials(s, c, "have textures", "has textures", "has a texture");
}

static void textures_without(struct subject *s)
{
    s->core.textured = NULL;
    s->core.textured_from = NULL;
}

/* Some material is in one call with others, and differs from them. */
static int inputs_why(struct subject *s, struct clause *c)
{
    uint32_t calls = 0, of = 0;
    for (uint32_t g = 0; g < s->core.group_count; g++) {
        const struct mcr_group *group = &s->core.group[g];
        uint32_t varies = 0;
        for (uint32_t i = 0; i < group->channels && group->table; i++)
            varies += group->table[i] && group->varies[i];
        calls += varies > 0;
        of += varies > 0 ? group->material_count : 0;
    }
    if (calls)
        say(c, "%u materials that differ are handled in %u call%s", of, calls, calls > 1 ? "s" : "");
    else
        say(c, "materials of one call do not differ");
    return calls > 0;
}

static int elsewhere_why(struct subject *s, struct clause *c)
{
    int active = (s->core.combines || s->core.crosses) && s->core.varying_elsewhere;
    say(c, active ? "what look-ups find or rays cross is not the same everywhere" : "look-ups and crossings find the same everywhere");
    return active;
}

static void elsewhere_without(struct subject *s)
{
    s->core.varying_elsewhere = 0;
}

static int coordinates_why(struct subject *s, struct clause *c)
{
    mark_needs(s, ~0u);
    return say_materials(s, c, "need u and v", "needs u and v", "needs u and v");
}

static void coordinates_without(struct subject *s)
{
    s->core.charts.needs = 0;
}

static int lookups_why(struct subject *s, struct clause *c)
{
    const struct mcr_node *node = s->scene.sampler->directions;
    say(c, "%s has %u technique%s%s", node->descriptor->name, node->technique_count, node->technique_count == 1 ? "" : "s",
        node->technique_count > 1 ? s->scene.render.mis_power ? ", combined by the power heuristic" : ", combined by the balance heuristic" : "");
    return s->core.combines;
}

static void lookups_without(struct subject *s)
{
    s->core.combines = 0;
}

static int interiors_why(struct subject *s, struct clause *c)
{
    mark_does(s, MCR_MATERIAL_INTERIOR);
    return say_materials(s, c, "bound interiors", "bounds an interior", "bounds an interior");
}

static int passes_why(struct subject *s, struct clause *c)
{
    mark_does(s, MCR_MATERIAL_PASSES);
    return say_materials(s, c, "let light pass", "lets light pass", "lets light pass");
}

/* The arrays of crossing stay where something lets light pass. */
static void interiors_without(struct subject *s)
{
    s->core.interiors = s->core.crosses = 0;
    for (uint32_t m = 0; m < s->scene.material_count; m++)
        s->core.crosses |= s->used[m] && (s->scene.material[m].traits.does & MCR_MATERIAL_PASSES);
}

static void passes_without(struct subject *s)
{
    s->core.crosses = 0;
}

static int lobes_why(struct subject *s, struct clause *c)
{
    for (uint32_t m = 0; m < s->scene.material_count; m++)
        s->marked[m] = s->used[m] && s->core.group[s->core.group_of_material[m]].lobes;
    return say_materials(s, c, "have mirror-like lobes", "has mirror-like lobes", "has mirror-like lobes");
}

static void lobes_without(struct subject *s)
{
    s->core.lobes = 0;
}

static int roulette_why(struct subject *s, struct clause *c)
{
    if (!s->scene.render.roulette)
        say(c, "it is off");
    else if (s->scene.render.roulette_from >= s->scene.render.depth)
        say(c, "on from scattering event %u, which depth %u does not reach", s->scene.render.roulette_from, s->scene.render.depth);
    else
        say(c, "on from scattering event %u", s->scene.render.roulette_from);
    return s->scene.render.roulette;
}

static void roulette_without(struct subject *s)
{
    s->scene.render.roulette = 0;
}

static int points_why(struct subject *s, struct clause *c)
{
    const struct mcr_point_lights *lights = s->core.point_lights;
    if (!lights) {
        say(c, "no light is without extent");
        return 0;
    }
    say(c, "%u light%s without extent: ", lights->count, lights->count > 1 ? "s" : "");
    for (uint32_t i = 0; i < lights->count; i++)
        say_name(c, lights->light[i].name, i, lights->count);
    return 1;
}

static void points_without(struct subject *s)
{
    s->core.point_lights = NULL;
}

static int sky_why(struct subject *s, struct clause *c)
{
    const struct mcr_sky *sky = s->core.sky;
    if (!sky) {
        say(c, "there is neither an environment nor a sun with an extent");
        return 0;
    }
    if (sky->environment)
        say(c, sky->environment->texel ? "an environment of %u x %u texels" : "an environment by a gradient", sky->environment->width,
            sky->environment->height);
    if (sky->sun_count)
        say(c, "%s%u sun%s with an extent", sky->environment ? " and " : "", sky->sun_count, sky->sun_count > 1 ? "s" : "");
    return 1;
}

static void sky_without(struct subject *s)
{
    s->core.sky = NULL;
    s->core.sky_emitter = -1;
}

static int background_why(struct subject *s, struct clause *c)
{
    const double *b = s->scene.render.background;
    int active = b[0] > 0 || b[1] > 0 || b[2] > 0;
    if (active)
        say(c, "the background is (%g, %g, %g)", b[0], b[1], b[2]);
    else
        say(c, "the background is black");
    return active;
}

static int emission_why(struct subject *s, struct clause *c)
{
    for (uint32_t m = 0; m < s->scene.material_count; m++)
        s->marked[m] = s->used[m] && s->core.group[s->core.group_of_material[m]].emits;
    return say_materials(s, c, "emit", "emits", "emits");
}

static int emitters_why(struct subject *s, struct clause *c)
{
    uint32_t count = s->core.emitters->count;
    if (count)
        say(c, "%u emitter%s can be aimed at", count, count > 1 ? "s" : "");
    else
        say(c, "no bounded surface emits");
    return count > 0;
}

static int tree_why(struct subject *s, struct clause *c)
{
    const struct mcr_emitters *emitters = s->core.emitters;
    say(c, emitters->node ? "%u emitters, more than %u" : "%u emitters, at most %u", emitters->count, MCR_EMITTERS_FEW);
    return emitters->node != NULL;
}

static int pixels_why(struct subject *s, struct clause *c)
{
    if (s->core.needs_pixel)
        say(c, "%s asks for the pixel", s->scene.sampler->expression);
    else
        say(c, "no source of numbers asks for the pixel");
    return s->core.needs_pixel;
}

static void pixels_without(struct subject *s)
{
    s->core.needs_pixel = 0;
}

static int sources_why(struct subject *s, struct clause *c)
{
    const struct mcr_sampler *sampler = s->scene.sampler;
    if (!sampler->source_count)
        say(c, "all numbers are independent");
    for (uint32_t i = 0; i < sampler->source_count; i++)
        say(c, "%s%s", i ? " around " : "numbers by ", sampler->source[i]->descriptor->name);
    return s->core.needs_samples;
}

static void sources_without(struct subject *s)
{
    s->core.needs_samples = 0;
    s->sampler.source_count = 0;
}

#define STAGE(NAME) (1u << MCR_STAGE_##NAME)

/* In the order in which they are taken out of the core: what needs another comes before it. */
static const struct feature {
    const char *name;
    uint32_t stages;           /* bits; one that several have is that of the last active one */
    int (*why)(struct subject *s, struct clause *c);
    void (*without)(struct subject *s); /* NULL: it adds nothing to a batch */
} table[] = {
    {"feature layers", STAGE(LAYERS), layers_why, layers_without},
    {"filter weights", 0, weights_why, weights_without},
    {"compat", 0, compat_why, compat_without},
    {"rounds", 0, rounds_why, NULL},
    {"lens", 0, lens_why, NULL},
    {"normal maps", STAGE(NORMALS), normals_why, normals_without},
    {"smooth normals", 0, smooth_why, smooth_without},
    {"tangents", 0, tangents_why, tangents_without},
    {"textures", STAGE(TEXTURES), textures_why, textures_without},
    {"varying inputs", STAGE(INPUTS), inputs_why, NULL},
    {"inputs elsewhere", 0, elsewhere_why, elsewhere_without},
    {"coordinates", STAGE(COORDINATES), coordinates_why, coordinates_without},
    {"look-ups", STAGE(LIGHT), lookups_why, lookups_without},
    {"interiors", STAGE(INTERIORS) | STAGE(CROSSING), interiors_why, interiors_without},
    {"light passes", STAGE(CROSSING), passes_why, passes_without},
    {"lobes", STAGE(LOBES), lobes_why, lobes_without},
    {"roulette", STAGE(ROULETTE), roulette_why, roulette_without},
    {"point lights", STAGE(POINTS), points_why, points_without},
    {"background", STAGE(SKY), background_why, NULL},
    {"sky", STAGE(SKY), sky_why, sky_without},
    {"emission", STAGE(EMISSION), emission_why, NULL},
    {"emitters", 0, emitters_why, NULL},
    {"light tree", 0, tree_why, NULL},
    {"pixel numbers", 0, pixels_why, pixels_without},
    {"sources", STAGE(NUMBERS), sources_why, sources_without},
};
#define FEATURES (sizeof table / sizeof *table)
_Static_assert(MCR_STAGE_COUNT <= 32, "bits for all stages");
_Static_assert(FEATURES <= MCR_EXPLAINED_FEATURES, "room for all features");

/* ---- Bytes ----------------------------------------------------------------------------------------------------- */

static uint64_t batch_bytes(struct subject *s)
{
    s->core.scratch_bytes = mcr_host_scratch(&s->core);
    return mcr_batch_bytes(&s->core);
}

static int uses_texture(const struct mcr_core *core, const struct mcr_texture *texture)
{
    uint32_t count = core->textured_from ? core->textured_from[core->scene->material_count] : 0;
    for (uint32_t i = 0; i < count; i++)
        if (core->textured[i].texture == texture)
            return 1;
    return 0;
}

static int tilts_with(const struct subject *s, const struct mcr_texture *texture)
{
    for (uint32_t m = 0; m < s->scene.material_count; m++)
        if (s->used[m] && (s->scene.material[m].surface.normal_map == texture || s->scene.material[m].surface.bump == texture))
            return 1;
    return 0;
}

static struct mcr_explained_feature *find(struct mcr_explanation *out, const char *name)
{
    uint32_t i = 0;
    while (strcmp(out->feature[i].name, name) != 0)
        i++;
    return &out->feature[i];
}

/* Bytes go to the first of the features that is active, or to the base. */
static void book(struct mcr_explanation *out, uint64_t bytes, const char *first, const char *second)
{
    struct mcr_explained_feature *a = find(out, first), *b = second ? find(out, second) : a;
    out->table_bytes += bytes;
    if (a->active)
        a->table_bytes += bytes;
    else if (b->active)
        b->table_bytes += bytes;
    else
        out->table_base_bytes += bytes;
}

static void book_tables(const struct subject *s, struct mcr_explanation *out)
{
    const struct mcr_core_tables *t = &s->core.tables;
    out->table_bytes = out->table_base_bytes = t->surfaces;
    book(out, t->charts, "coordinates", NULL);
    book(out, t->crossing, "light passes", "interiors");
    book(out, t->sky, "sky", NULL);
    book(out, t->points, "point lights", NULL);
    book(out, t->emitters - s->core.emitters->tree_bytes, "emitters", NULL);
    book(out, s->core.emitters->tree_bytes, "light tree", NULL);
    for (uint32_t i = 0; i < s->scene.texture_count; i++) {
        const struct mcr_texture *texture = s->scene.texture[i].texture;
        uint64_t bytes = texture ? mcr_texture_bytes(texture) : 0;
        out->texture_bytes += bytes;
        if (texture && uses_texture(&s->core, texture)) {
            book(out, bytes, "textures", NULL);
        } else if (texture && tilts_with(s, texture)) {
            book(out, bytes, "normal maps", NULL);
        } else {
            out->table_bytes += bytes;
            out->table_base_bytes += bytes;
        }
    }
}

/* ---- Lights ---------------------------------------------------------------------------------------------------- */

static int aims(const struct mcr_node *node)
{
    for (uint32_t i = 0; i < node->technique_count; i++)
        if (node->technique[i].kind == MCR_TECHNIQUE_EMITTER || (node->technique[i].covers & MCR_COVERS_EMITTERS))
            return 1;
    for (uint32_t i = 0; i < node->child_count; i++)
        if (node->child[i] && aims(node->child[i]))
            return 1;
    return 0;
}

static void tell_lights(const struct mcr_core *core, struct mcr_explained_lights *to)
{
    const struct mcr_emitters *emitters = core->emitters;
    const struct mcr_point_lights *points = core->point_lights;
    to->emitters = emitters->count;
    for (uint32_t e = 0; e < emitters->count; e++) {
        int both = emitters->emitter[e].sides == (MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK);
        to->kind[emitters->emitter[e].kind]++;
        to->one_sided += !both;
        to->two_sided += both;
    }
    to->aimed = aims(core->scene->sampler->directions);
    to->tree = emitters->node != NULL;
    to->sky = core->sky_emitter >= 0;
    to->sky_share = to->sky ? core->sky_share : 0;
    for (uint32_t i = 0; points && i < points->count; i++) {
        to->points += points->light[i].kind == MCR_LIGHT_POINT;
        to->spots += points->light[i].kind == MCR_LIGHT_SPOT;
        to->suns += points->light[i].kind == MCR_LIGHT_SUN;
    }
    to->points_tree = points && points->node;
}

/* ---- All of it ------------------------------------------------------------------------------------------------- */

/* Cells that a pass fills. */
static uint64_t pass_cells(const struct mcr_scene *scene)
{
    uint64_t pixels = (uint64_t)(scene->film.x1 - scene->film.x0) * (scene->film.y1 - scene->film.y0);
    if (mcr_render_in_rounds(&scene->render))
        return MCR_TASK_CELLS;
    uint64_t of_pixel = (scene->render.spp / scene->render.replicates + MCR_CELL_SAMPLES - 1) / MCR_CELL_SAMPLES;
    uint64_t at_once = pixels < MCR_TASK_CELLS ? MCR_TASK_CELLS / pixels : 1;
    return pixels * (of_pixel < at_once ? of_pixel : at_once);
}

static void explain(struct subject *s, int channels, struct mcr_explanation *out)
{
    uint64_t before = batch_bytes(s);
    out->count = FEATURES;
    out->batch = s->core.capacity;
    out->batch_bytes = before;
    out->pass_bytes = pass_cells(&s->scene) * (sizeof(struct mcr_cell) + (channels ? sizeof(struct mcr_cell_channels) : 0) +
                                               (s->core.features ? sizeof(struct mcr_cell_features) : 0));
    for (uint32_t i = 0; i < FEATURES; i++) {
        struct clause clause = {out->feature[i].why, 0, sizeof out->feature[i].why};
        out->feature[i].name = table[i].name;
        out->feature[i].active = table[i].why(s, &clause) != 0;
    }
    for (uint32_t i = FEATURES, taken = 0; i-- > 0;) {
        out->feature[i].stages = out->feature[i].active ? table[i].stages & ~taken : 0;
        taken |= out->feature[i].stages;
    }
    book_tables(s, out);
    tell_lights(&s->core, &out->lights);
    for (uint32_t i = 0; i < FEATURES; i++) {
        if (!table[i].without || !out->feature[i].active)
            continue;
        table[i].without(s);
        uint64_t bytes = batch_bytes(s);
        out->feature[i].batch_bytes = before - bytes;
        before = bytes;
    }
    out->batch_base_bytes = before;
}

int mcr_explain(const struct mcr_scene *scene, const struct mcr_accel *accel, const struct mcr_render_options *options, int channels,
                struct mcr_explanation *out)
{
    struct mcr_arena *arena = mcr_arena_create(0);
    uint32_t room = scene->material_count > scene->texture_count ? scene->material_count : scene->texture_count;
    struct subject subject;
    int status = -1;
    memset(out, 0, sizeof *out);
    memset(&subject, 0, sizeof subject);
    subject.scene = *scene;
    subject.sampler = *scene->sampler;
    subject.scene.sampler = &subject.sampler;
    uint8_t *used = arena ? mcr_arena_alloc(arena, room, 1) : NULL;
    subject.used = used;
    subject.marked = arena ? mcr_arena_alloc(arena, room, 1) : NULL;
    if (used && subject.marked && !mcr_core_init(&subject.core, arena, &subject.scene, accel, options)) {
        for (uint32_t p = 0; p < subject.core.surfaces.count; p++)
            used[subject.core.surfaces.material[p]] = 1;
        explain(&subject, channels, out);
        status = 0;
    }
    mcr_arena_destroy(arena);
    return status;
}
