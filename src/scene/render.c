/* SPDX-License-Identifier: Apache-2.0 */
/* Blocks `render { … }`, what the command line says over them, and the sampler. */
#include "scene/build.h"
#include "scene/vector.h"

#define REPLICATES_FROM_SPP 16u /* correlated samplers: from here on two replicates, so that the error can be estimated */

static void read_roulette(struct mcr_build *build, const struct mcr_settings *settings)
{
    struct mcr_render_settings *render = &build->scene->render;
    const struct mcr_value *value = settings->value[RENDER_ROULETTE];
    struct mcr_settings arguments;
    double from = mcr_roulette_word.setting[0].fallback[0];
    render->roulette = 1;
    render->roulette_from = (uint32_t)from;
    if (!value)
        return;
    if (value->kind == MCR_VALUE_NAME && strcmp(value->text, "off") == 0) {
        render->roulette = 0;
    } else if ((value->kind == MCR_VALUE_NAME || value->kind == MCR_VALUE_CALL) && strcmp(value->text, "on") == 0) {
        mcr_settings_match_call(build, value, &mcr_roulette_word, &arguments);
        if (mcr_read_number(build, &arguments, 0, &from) == 0)
            render->roulette_from = (uint32_t)from;
    } else {
        mcr_wrong_kind(build, value, "roulette", "render", mcr_word_form(MCR_WORD_ROULETTE));
    }
}

/* adaptive on, off or on(floor=N). */
static void read_adaptive(struct mcr_build *build, const struct mcr_settings *settings)
{
    struct mcr_render_settings *render = &build->scene->render;
    const struct mcr_value *value = settings->value[RENDER_ADAPTIVE];
    struct mcr_settings arguments;
    double floor = mcr_adaptive_word.setting[0].fallback[0];
    render->floor = (uint32_t)floor;
    if (!value || (value->kind == MCR_VALUE_NAME && strcmp(value->text, "off") == 0))
        return;
    if ((value->kind != MCR_VALUE_NAME && value->kind != MCR_VALUE_CALL) || strcmp(value->text, "on") != 0) {
        mcr_wrong_kind(build, value, "adaptive", "render", mcr_word_form(MCR_WORD_ADAPTIVE));
        return;
    }
    render->adaptive = 1;
    mcr_settings_match_call(build, value, &mcr_adaptive_word, &arguments);
    build->floor_said = mcr_read_number(build, &arguments, 0, &floor) == 0;
    build->floor_place = value->place;
    if (build->floor_said)
        render->floor = (uint32_t)floor;
}

/* Choices that the language has but this build has not. */
static void check_available(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, double last, double number)
{
    static const char *const name[] = { [RENDER_ACCEL] = "embree", [RENDER_PRECISION] = "single" };
    if (number > last)
        mcr_error(build, settings->value[index]->place, "'%s %s' is not available in this build", settings->word->setting[index].name,
                  name[index]);
}

static double number_of(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index)
{
    double number = settings->word->setting[index].fallback[0];
    mcr_read_number(build, settings, index, &number);
    return number;
}

static void override(struct mcr_build *build)
{
    const struct mcr_overrides *over = build->overrides;
    struct mcr_render_settings *render = &build->scene->render;
    if (!over)
        return;
    if (over->has_spp)
        render->spp = over->spp;
    if (over->has_depth)
        render->depth = over->depth;
    if (over->has_seed)
        render->seed = over->seed;
    if (over->has_threads)
        render->threads = over->threads;
    if (over->has_accel)
        render->accel = over->accel;
    if (over->has_batch)
        render->batch = over->batch;
    if (over->has_roulette)
        render->roulette = over->roulette;
    if (over->has_roulette_from)
        render->roulette_from = over->roulette_from;
    if (over->has_compat) {
        render->compat = over->compat;
        build->compat_place = (struct mcr_place){ 0 };
    }
    if (over->has_replicates) {
        build->replicates = over->replicates;
        build->replicates_place = (struct mcr_place){ 0 };
    }
    if (over->sampler) {
        build->sampler = mcr_parse_value(build->arena, build->diagnostics, "--sampler", over->sampler);
        if (build->sampler)
            build->scene->sampler_place = build->sampler->place;
    }
}

/* Over the scene: rules of the command line, a sample map in the place of all, or none. */
static void override_rules(struct mcr_build *build)
{
    const struct mcr_overrides *over = build->overrides;
    struct mcr_render_settings *render = &build->scene->render;
    if (!over)
        return;
    if (over->has_time)
        render->time = over->time;
    if (over->has_target_error)
        render->target_error = over->target_error;
    if (over->has_adaptive)
        render->adaptive = over->adaptive;
    if (over->has_floor) {
        render->floor = over->floor;
        build->floor_said = 1;
        build->floor_place = (struct mcr_place){ 0 };
    }
    if (over->has_round)
        render->round = over->round;
    render->mapped = over->mapped;
    if (over->mapped || over->plain)
        render->time = render->target_error = render->adaptive = 0;
}

/*
 * Which rounds there are, and whether spp limits them: it does where it is said beside the rules or over them. A rule of the command line is not held up
 * by the scene's spp, nor one of the scene by what spp is when nobody says it. To distribute samples without any other rule is to distribute spp of them.
 */
static void settle_rules(struct mcr_build *build, const struct mcr_settings *settings)
{
    const struct mcr_overrides *over = build->overrides;
    struct mcr_render_settings *render = &build->scene->render;
    const struct mcr_value *round = settings->value[RENDER_ROUND];
    struct mcr_place place = round && !(over && over->has_round) ? round->place : (struct mcr_place){ 0 };
    int above = over && ((over->has_time && over->time > 0) || (over->has_target_error && over->target_error > 0));
    int said = (over && over->has_spp) || (settings->value[RENDER_SPP] && !above), open = render->time > 0 || render->target_error > 0;
    render->least_rounds = build->replicates ? build->replicates : 1;
    if (!mcr_render_in_rounds(render)) {
        if (round || (over && over->has_round))
            mcr_error(build, over && over->has_round ? (struct mcr_place){ 0 } : settings->key[RENDER_ROUND],
                      "'round' is for rounds of samples: with time, target_error, adaptive or a map to follow, none of which is given");
        return;
    }
    render->limit = !render->mapped && (said || !open) ? render->spp : 0;
    if (render->limit && render->limit < render->round && !round && !(over && over->has_round))
        render->round = render->limit; /* nobody asked for more */
    if (render->round > 16 && render->round % 16 != 0)
        mcr_error(build, place, "a round of %u samples cannot be cut into cells of 16, expected up to 16, or a multiple of 16", render->round);
    if (!render->limit)
        return;
    if (render->adaptive && render->floor > render->limit) {
        if (build->floor_said)
            mcr_error(build, build->floor_place, "'floor' of 'adaptive' is %u samples of every pixel, but spp is %u in the mean", render->floor, render->limit);
        render->floor = render->limit; /* the default one gives way */
    }
    if (render->limit < render->round)
        mcr_error(build, place, "spp %u is less than one round of %u samples, expected a smaller 'round' (--round)", render->limit, render->round);
    else if (render->limit / render->round < render->least_rounds)
        mcr_error(build, build->replicates_place, "%u replicates are rounds of %u samples and need at least %llu samples per pixel, spp is %u",
                  render->least_rounds, render->round, (unsigned long long)render->least_rounds * render->round, render->limit);
}

/* Roulette weights paths up, so that more of them are clamped. The founding study has none: it is off with `clamp`, unless it was asked for. */
static void clamp_roulette(struct mcr_build *build, int in_scene)
{
    struct mcr_render_settings *render = &build->scene->render;
    if (!(render->compat & MCR_COMPAT_CLAMP) || !render->roulette)
        return;
    if (!in_scene && !(build->overrides && build->overrides->has_roulette))
        render->roulette = 0;
    else
        mcr_report(build->diagnostics, MCR_WARNING, build->compat_place,
                   "compat 'clamp' clamps paths that roulette has weighted up: 'roulette off' is what the founding study does");
}

void mcr_build_render(struct mcr_build *build, const struct mcr_item *block)
{
    static const struct mcr_item none = { .is_block = 1, .word = "render" };
    struct mcr_render_settings *render = &build->scene->render;
    struct mcr_settings settings;
    double number;
    mcr_settings_match(build, block ? block : &none, mcr_scene_block("render", NULL), 0, &settings);
    render->spp = (uint32_t)number_of(build, &settings, RENDER_SPP);
    render->depth = (uint32_t)number_of(build, &settings, RENDER_DEPTH);
    render->seed = (uint64_t)number_of(build, &settings, RENDER_SEED);
    render->threads = (uint32_t)number_of(build, &settings, RENDER_THREADS);
    render->batch = (uint32_t)number_of(build, &settings, RENDER_BATCH);
    number = number_of(build, &settings, RENDER_ACCEL);
    check_available(build, &settings, RENDER_ACCEL, MCR_ACCEL_BVH, number);
    render->accel = (uint32_t)number;
    number = number_of(build, &settings, RENDER_PRECISION);
    check_available(build, &settings, RENDER_PRECISION, MCR_PRECISION_DOUBLE, number);
    render->precision = MCR_PRECISION_DOUBLE;
    render->mis_power = number_of(build, &settings, RENDER_MIS) == 1;
    build->texture_memory = (uint64_t)(number_of(build, &settings, RENDER_TEXTURE_MEMORY) * 1048576);
    mcr_read_colour(build, &settings, RENDER_BACKGROUND, render->background);
    read_roulette(build, &settings);
    render->compat = mcr_read_compat(build, &settings, RENDER_COMPAT);
    build->compat_place = settings.value[RENDER_COMPAT] ? settings.value[RENDER_COMPAT]->place : (struct mcr_place){ 0 };
    build->replicates = (uint32_t)number_of(build, &settings, RENDER_REPLICATES);
    if (settings.value[RENDER_REPLICATES])
        build->replicates_place = settings.value[RENDER_REPLICATES]->place;
    if (mcr_read_number(build, &settings, RENDER_TIME, &number) == 0)
        render->time = number;
    if (mcr_read_number(build, &settings, RENDER_TARGET_ERROR, &number) == 0)
        render->target_error = number;
    render->round = (uint32_t)number_of(build, &settings, RENDER_ROUND);
    read_adaptive(build, &settings);
    build->sampler = settings.value[RENDER_SAMPLER];
    if (build->sampler)
        build->scene->sampler_place = build->sampler->place;
    override(build);
    override_rules(build);
    settle_rules(build, &settings);
    clamp_roulette(build, settings.value[RENDER_ROULETTE] != NULL);
    if (mcr_render_in_rounds(render)) {
        build->replicates = 1; /* rounds take their place */
    } else if (build->replicates > render->spp) {
        mcr_error(build, build->replicates_place, "%u replicates need at least %u samples per pixel, spp is %u", build->replicates,
                  build->replicates, render->spp);
        build->replicates = 0;
    }
}

/* The node whose technique aims at emitters, or NULL. */
static const struct mcr_node *aims_at_emitters(const struct mcr_node *node)
{
    for (uint32_t i = 0; i < node->child_count; i++) {
        const struct mcr_node *found = node->child[i] ? aims_at_emitters(node->child[i]) : NULL;
        if (found)
            return found;
    }
    for (uint32_t i = 0; i < node->technique_count; i++)
        if (node->technique[i].kind == MCR_TECHNIQUE_EMITTER || (node->technique[i].covers & MCR_COVERS_EMITTERS))
            return node;
    return NULL;
}

static int covers(const struct mcr_node *node, uint32_t what)
{
    uint32_t all = 0;
    for (uint32_t i = 0; i < node->technique_count; i++)
        all |= node->technique[i].covers;
    return (all & what) != 0;
}

/* Judges what aims at emitters; -1 after an error. */
static int check_lights(struct mcr_build *build, const struct mcr_sampler *sampler)
{
    const struct mcr_node *light = sampler->directions ? aims_at_emitters(sampler->directions) : NULL;
    if (!light)
        return 0;
    if (build->planes_emit) {
        mcr_error(build, light->place, "an infinite plane cannot be sampled as a light");
        mcr_report(build->diagnostics, MCR_NOTE, build->plane_place, "this plane emits: use a quad or a disk, or a sampler without '%s'",
                   light->descriptor->name);
        return -1;
    }
    if (!build->scene->has_lights && !covers(sampler->directions, MCR_COVERS_REFLECTION | MCR_COVERS_TRANSMISSION) &&
        mcr_diagnostics_errors(build->diagnostics) == 0)
        mcr_report(build->diagnostics, MCR_WARNING, light->place,
                   "the scene has no light that '%s' could sample: only emission will be seen",
                   light->descriptor->name);
    return 0;
}

static uint32_t planned(const struct mcr_render_settings *render)
{
    return mcr_render_in_rounds(render) ? render->round : render->spp / render->replicates + (render->spp % render->replicates != 0);
}

/* Makes the sampler for as many samples as a replicate has; -1 after an error. */
static int create_sampler(struct mcr_build *build, int has_lights)
{
    struct mcr_scene *scene = build->scene;
    struct mcr_quirks quirks = { mcr_compat_name, MCR_COMPAT_COUNT, scene->render.compat };
    mcr_sampler_destroy(scene->sampler);
    scene->sampler = mcr_sampler_create_with(build->arena, build->diagnostics, build->registry, build->sampler, planned(&scene->render),
                                             has_lights, &quirks);
    return scene->sampler ? 0 : -1;
}

/* Leaves those quirks in force that find something to act on, with those that the sampler's expression asks for. */
static void settle_compat(struct mcr_build *build)
{
    struct mcr_scene *scene = build->scene;
    uint32_t always = MCR_COMPAT_CLAMP | MCR_COMPAT_BACKGROUND_AT_LIMIT, asked = scene->render.compat, acts = scene->sampler->quirks;
    if (scene->camera.kind == MCR_CAMERA_THIN_LENS && scene->camera.lens_radius > 0)
        always |= MCR_COMPAT_DISK_POLAR;
    scene->camera.lens_polar = (asked & always & MCR_COMPAT_DISK_POLAR) != 0;
    acts |= asked & always;
    for (uint32_t i = 0; i < MCR_COMPAT_COUNT; i++)
        if (asked & ~acts & 1u << i)
            mcr_report(build->diagnostics, MCR_WARNING, build->compat_place, "compat '%s' has no effect here: nothing in this scene draws that way",
                       mcr_compat_name[i]);
    scene->render.compat = acts;
}

/*
 * The best unbiased sampler for what the scene holds, by 1/(MSE t) in the scenes of scenes/: looking for emitters and drawing as the material does,
 * each weighted by how likely it was; without emitters that can be sampled, as the material does alone.
 */
static const char *default_sampler(const struct mcr_scene *scene, int planes_emit)
{
    if (scene->render.compat) /* quirks are the founding study's: so is the sampler */
        return scene->has_lights && !planes_emit ? "mixture(cosine 1, light 1)" : "cosine";
    return scene->has_lights && !planes_emit ? "sobol(nee)" : "sobol(bsdf)";
}

/* The sampler, and how many replicates: what is settled last. */
static void build_sampler(struct mcr_build *build)
{
    struct mcr_scene *scene = build->scene;
    struct mcr_render_settings *render = &scene->render;
    /* `light` is to be refused for a plane that emits, or for what was wrong with a lamp, and not for the want of emitters as well. */
    int wrong = mcr_diagnostics_errors(build->diagnostics) > 0;
    int lights = scene->has_lights, first_lights = lights || build->planes_emit || wrong;
    if (build->overrides && build->overrides->sampler && !build->sampler)
        return;
    if (!build->sampler) {
        build->sampler = mcr_parse_value(build->arena, build->diagnostics, "default sampler", default_sampler(scene, build->planes_emit));
        scene->sampler_chosen = 1;
    }
    if (!build->sampler || mcr_value_resolve(build->sampler)->kind == MCR_VALUE_ERROR)
        return;
    render->replicates = build->replicates ? build->replicates : 1;
    if (create_sampler(build, first_lights) != 0 || check_lights(build, scene->sampler) != 0 || wrong)
        return;
    if (!build->replicates && scene->sampler->correlated && render->spp >= REPLICATES_FROM_SPP)
        render->replicates = 2; /* sources lay out their samples by replicate: they are made anew for half as many */
    else if (first_lights == lights)
        return;
    create_sampler(build, lights);
}

void mcr_build_sampler(struct mcr_build *build)
{
    build_sampler(build);
    if (build->scene->sampler)
        settle_compat(build);
}

const char *mcr_build_try_sampler(struct mcr_build *build, const struct mcr_value *expression, uint32_t spp)
{
    int wrong = mcr_diagnostics_errors(build->diagnostics) > 0, lights = build->scene->has_lights || build->planes_emit || wrong;
    struct mcr_sampler *sampler = mcr_sampler_create(build->arena, build->diagnostics, build->registry, expression, spp, lights);
    const char *text = sampler && check_lights(build, sampler) == 0 ? sampler->expression : NULL;
    mcr_sampler_destroy(sampler);
    return text;
}
