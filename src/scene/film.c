/* SPDX-License-Identifier: Apache-2.0 */
/* Blocks `film { … }`: size, crop, filter, and what the command line says over them. */
#include "scene/build.h"
#include "scene/mitchell.h"
#include "scene/vector.h"

/* Arguments of mitchell, and where its samples are drawn. */
static void read_mitchell(struct mcr_build *build, const struct mcr_settings *arguments)
{
    struct mcr_film_settings *film = &build->scene->film;
    double *edge = mcr_build_alloc(build, MCR_MITCHELL_CELLS + 1, sizeof *edge);
    int bad = mcr_read_number(build, arguments, FILTER_B, &film->filter_b) < 0;
    if (mcr_read_number(build, arguments, FILTER_C, &film->filter_c) < 0 || bad || !edge)
        return;
    mcr_mitchell_edges(film->filter_b, film->filter_c, edge);
    film->filter_edge = edge;
}

/* Which of the words a name or a call is, with its arguments; `count` after an error. */
static uint32_t choose(struct mcr_build *build, const struct mcr_value *value, const char *setting, const char *form, const struct mcr_block_word *words,
                       uint32_t count, struct mcr_settings *arguments)
{
    const char *list[MCR_FILTER_COUNT + MCR_TONE_WORDS];
    uint32_t found = count;
    if (value->kind != MCR_VALUE_NAME && value->kind != MCR_VALUE_CALL) {
        mcr_wrong_kind(build, value, setting, "film", form);
        return count;
    }
    for (uint32_t i = 0; i < count; i++) {
        list[i] = words[i].word;
        if (strcmp(words[i].word, value->text) == 0)
            found = i;
    }
    if (found == count)
        mcr_unknown_word(build, value->place, setting, value->text, "film", list, count);
    else if (!words[found].count && value->kind == MCR_VALUE_CALL && value->count)
        mcr_error(build, value->argument[0].name ? value->argument[0].name_place : value->argument[0].value.place, "'%s' takes no arguments", value->text);
    else
        mcr_settings_match_call(build, value, &words[found], arguments);
    return found;
}

static void read_filter(struct mcr_build *build, const struct mcr_settings *settings)
{
    struct mcr_film_settings *film = &build->scene->film;
    const struct mcr_value *value = settings->value[FILM_FILTER];
    struct mcr_settings arguments;
    uint32_t filter;
    film->filter = MCR_FILTER_BOX;
    film->filter_radius = mcr_filter_words[0].setting[FILTER_RADIUS].fallback[0];
    if (!value)
        return;
    filter = choose(build, value, "filter", mcr_word_form(MCR_WORD_FILTER), mcr_filter_words, MCR_FILTER_COUNT, &arguments);
    if (filter == MCR_FILTER_COUNT)
        return;
    film->filter = filter;
    mcr_read_number(build, &arguments, FILTER_RADIUS, &film->filter_radius);
    if (filter == MCR_FILTER_GAUSSIAN)
        mcr_read_number(build, &arguments, FILTER_SIGMA, &film->filter_sigma);
    if (filter == MCR_FILTER_MITCHELL)
        read_mitchell(build, &arguments);
}

_Static_assert(MCR_TONE_WORDS == MCR_TONE_COUNT, "a word for each curve");

static void read_tone(struct mcr_build *build, const struct mcr_value *value)
{
    struct mcr_tone *tone = &build->scene->film.tone;
    struct mcr_settings arguments;
    uint32_t curve = choose(build, value, "tone", mcr_word_form(MCR_WORD_TONE), mcr_tone_words, MCR_TONE_WORDS, &arguments);
    if (curve == MCR_TONE_WORDS)
        return;
    tone->curve = curve;
    if (mcr_tone_words[curve].count)
        mcr_read_number(build, &arguments, TONE_WHITE, &tone->white);
}

/* What only files of 8 and 16 bits show. The scene's own is read, and judged, too where an option replaces it. */
static void read_display(struct mcr_build *build, const struct mcr_settings *settings)
{
    const struct mcr_overrides *over = build->overrides;
    struct mcr_film_settings *film = &build->scene->film;
    mcr_read_number(build, settings, FILM_EXPOSURE, &film->exposure);
    if (settings->value[FILM_TONE])
        read_tone(build, settings->value[FILM_TONE]);
    if (over && over->has_exposure)
        film->exposure = over->exposure;
    if (over && over->tone) {
        const struct mcr_value *value = mcr_parse_value(build->arena, build->diagnostics, "--tone", over->tone);
        film->tone = (struct mcr_tone){ .curve = MCR_TONE_LINEAR };
        if (value)
            read_tone(build, value);
    }
}

/* The place of what was wrong: the scene's setting, or none where the command line said it. */
static void check_crop(struct mcr_build *build, struct mcr_place place, const char *option)
{
    struct mcr_film_settings *film = &build->scene->film;
    uint64_t pixels, bytes = MCR_FILM_BYTES_PER_PIXEL;
    if (film->x0 >= film->x1 || film->y0 >= film->y1) {
        mcr_error(build, place, "%s is empty: expected x0 < x1 and y0 < y1", option);
        return;
    }
    if (film->x1 > film->width || film->y1 > film->height) {
        mcr_error(build, place, "%s reaches to (%u, %u), beyond the picture of %u x %u pixels", option, film->x1, film->y1, film->width,
                  film->height);
        return;
    }
    pixels = (uint64_t)(film->x1 - film->x0) * (film->y1 - film->y0);
    if (build->overrides && build->overrides->channel_variance)
        bytes += MCR_FILM_CHANNEL_BYTES_PER_PIXEL;
    if (build->overrides)
        bytes += build->overrides->layer_bytes;
    if (pixels > MCR_FILM_MEMORY_LIMIT / bytes)
        mcr_error(build, place, "a film of %u x %u pixels needs %llu MiB, at most 1024 MiB are allowed: render it in parts with 'crop'",
                  film->x1 - film->x0, film->y1 - film->y0,
                  (unsigned long long)((pixels * bytes + (1 << 20) - 1) >> 20));
}

void mcr_build_film(struct mcr_build *build, const struct mcr_item *block)
{
    static const struct mcr_item none = { .is_block = 1, .word = "film" };
    const struct mcr_overrides *over = build->overrides;
    struct mcr_film_settings *film = &build->scene->film;
    struct mcr_settings settings;
    struct mcr_place place = { 0 };
    const char *option = "'crop'";
    uint32_t size[2], crop[4];
    int bad, has_crop;
    mcr_settings_match(build, block ? block : &none, mcr_scene_block("film", NULL), 0, &settings);
    bad = mcr_read_whole(build, &settings, FILM_SIZE, 2, size) < 0;
    has_crop = mcr_read_whole(build, &settings, FILM_CROP, 4, crop);
    read_filter(build, &settings);
    read_display(build, &settings);
    if (bad || has_crop < 0)
        return;
    if (settings.value[FILM_CROP])
        place = settings.value[FILM_CROP]->place;
    if (over && over->has_size) {
        size[0] = over->width;
        size[1] = over->height;
        if (size[0] < 1 || size[1] < 1 || size[0] > MCR_FILM_LIMIT || size[1] > MCR_FILM_LIMIT) {
            mcr_error(build, place, "--size %ux%u is out of range, expected 1 to %u each", size[0], size[1], MCR_FILM_LIMIT);
            return;
        }
    }
    if (over && over->has_crop) {
        memcpy(crop, over->crop, sizeof crop);
        has_crop = 0;
        place = (struct mcr_place){ 0 };
        option = "--crop";
    }
    film->width = size[0];
    film->height = size[1];
    film->x0 = has_crop == 0 ? crop[0] : 0;
    film->y0 = has_crop == 0 ? crop[1] : 0;
    film->x1 = has_crop == 0 ? crop[2] : size[0];
    film->y1 = has_crop == 0 ? crop[3] : size[1];
    if (has_crop != 0 && settings.value[FILM_SIZE] && !(over && over->has_size))
        place = settings.value[FILM_SIZE]->place;
    check_crop(build, place, option);
}

void mcr_build_film_in_rounds(struct mcr_build *build)
{
    const struct mcr_film_settings *film = &build->scene->film;
    uint64_t pixels = (uint64_t)(film->x1 - film->x0) * (film->y1 - film->y0), bytes = MCR_FILM_BYTES_PER_PIXEL + MCR_FILM_ROUND_BYTES_PER_PIXEL;
    if (build->overrides && build->overrides->channel_variance)
        bytes += MCR_FILM_CHANNEL_BYTES_PER_PIXEL;
    if (mcr_render_in_rounds(&build->scene->render) && pixels > MCR_FILM_MEMORY_LIMIT / bytes)
        mcr_error(build, (struct mcr_place){ 0 },
                  "a film of %u x %u pixels needs %llu MiB in rounds, at most 1024 MiB are allowed: render it in parts with 'crop'",
                  film->x1 - film->x0, film->y1 - film->y0, (unsigned long long)((pixels * bytes + (1 << 20) - 1) >> 20));
}
