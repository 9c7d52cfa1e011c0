/* SPDX-License-Identifier: Apache-2.0 */
#include "film/sampling.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/allocate.h"

#define SCOUT_SHARE 16u                  /* one sample in so many is a scout's */
#define DEFENCE 16u                      /* no pixel has less than the mean over this */
#define SCOUT_REPLICATE (UINT64_C(1) << 32) /* the first replicate of scouts: beyond all others */
#define SCOUT_LEAST 4u                   /* independent samples that tell a variance at all */

enum { IMAGE, SCOUT };

struct mcr_sampling {
    struct mcr_film *film;
    struct mcr_features *features;    /* or NULL */
    struct mcr_sampling_rules rules;
    uint64_t pixels;
    uint32_t round[2], cells[2], cell_samples[2]; /* of the picture's and of the scouts' rounds */
    uint32_t most;
    uint32_t first_scouts;            /* rounds that every pixel's scouting begins with */
    int adaptive;                     /* in force: the limit leaves something to distribute */
    uint32_t *have[2], *want[2];      /* rounds; have: handed out */
    uint64_t total[2];                /* sums of have */
    int which;                        /* the running step: what is handed out, from pixel `at` on */
    uint64_t at;
    struct mcr_task_entry *entry;
    double *mean, *moment;            /* scouts: of luminance; units are samples, or rounds where they are correlated */
    double *variance, *noise, *scratch, *weight;
    double need;                      /* rounds that the target is thought to take; 0: not known */
    uint32_t steps;
    enum mcr_stopped stopped;
};

uint32_t mcr_sampling_most(uint32_t round)
{
    uint32_t odd = round / (round & -round), exact = (1u << 24) / odd, countable = INT32_MAX / round;
    return exact < countable ? exact : countable;
}

/* A round's size that can be cut into equal cells. */
static uint32_t even_round(uint32_t samples)
{
    return samples > MCR_CELL_SAMPLES ? samples / MCR_CELL_SAMPLES * MCR_CELL_SAMPLES : samples;
}

static void set_round(struct mcr_sampling *s, int which, uint32_t samples)
{
    s->round[which] = samples;
    s->cell_samples[which] = samples < MCR_CELL_SAMPLES ? samples : MCR_CELL_SAMPLES;
    s->cells[which] = samples / s->cell_samples[which];
}

/*
 * Scouts begin with what tells a variance, and with a sixteenth of the limit at most where that is enough for it. Correlated ones are rounds as the
 * picture's, if need be shorter: what is asked of them is which pixels are noisier than others.
 */
static void choose_scouts(struct mcr_sampling *s)
{
    uint32_t share = s->rules.limit ? s->rules.limit / SCOUT_SHARE : UINT32_MAX, samples;
    if (s->film->correlated) {
        samples = share / 2 < s->rules.round ? share / 2 : s->rules.round;
        s->first_scouts = 2;
        set_round(s, SCOUT, even_round(samples < 2 ? (s->rules.round < 2 ? 1 : 2) : samples));
    } else {
        samples = share < MCR_CELL_SAMPLES ? share : MCR_CELL_SAMPLES;
        s->first_scouts = 1;
        set_round(s, SCOUT, samples < SCOUT_LEAST ? SCOUT_LEAST : samples);
    }
    uint64_t floor = (s->rules.floor + (uint64_t)s->rules.round - 1) / s->rules.round;
    if (s->film->correlated && floor < 2) /* else no error is known */
        floor = 2;
    if (s->rules.least < floor)
        s->rules.least = (uint32_t)floor;
    uint64_t before = (uint64_t)s->rules.least * s->rules.round + (uint64_t)s->first_scouts * s->round[SCOUT];
    s->adaptive = !s->rules.limit || before + s->rules.round <= s->rules.limit;
}

static int allocate_arrays(struct mcr_sampling *s)
{
    int kinds = s->adaptive ? 2 : 1, missing = 0;
    for (int w = 0; w < kinds; w++) {
        s->have[w] = calloc(s->pixels, sizeof *s->have[w]);
        s->want[w] = calloc(s->pixels, sizeof *s->want[w]);
        missing |= !s->have[w] || !s->want[w];
    }
    double **const array[] = {&s->mean, &s->moment, &s->variance, &s->noise, &s->scratch, &s->weight};
    for (uint32_t i = 0; i < sizeof array / sizeof *array && s->adaptive; i++) {
        *array[i] = calloc(s->pixels, sizeof(double));
        missing |= !*array[i];
    }
    s->entry = calloc(MCR_TASK_CELLS, sizeof *s->entry);
    return missing || !s->entry ? -1 : 0;
}

struct mcr_sampling *mcr_sampling_create(struct mcr_film *film, struct mcr_features *features, const struct mcr_sampling_rules *rules)
{
    struct mcr_sampling *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->film = film;
    s->features = features;
    s->rules = *rules;
    s->pixels = film->pixels;
    s->which = SCOUT;
    s->at = s->pixels; /* no step is running */
    s->most = mcr_sampling_most(rules->round);
    if (!s->rules.least)
        s->rules.least = 1;
    set_round(s, IMAGE, rules->round);
    if (rules->adaptive && !rules->map)
        choose_scouts(s);
    if (allocate_arrays(s) || mcr_film_by_pixel(film, s->cells[IMAGE], s->cell_samples[IMAGE])) {
        mcr_sampling_destroy(s);
        return NULL;
    }
    return s;
}

void mcr_sampling_destroy(struct mcr_sampling *s)
{
    if (!s)
        return;
    for (int w = 0; w < 2; w++) {
        free(s->have[w]);
        free(s->want[w]);
    }
    free(s->entry);
    free(s->mean);
    free(s->moment);
    free(s->variance);
    free(s->noise);
    free(s->scratch);
    free(s->weight);
    free(s);
}

/* ---- What a step holds ---- */

/* All samples so far, scouts included. */
static double samples_of(const struct mcr_sampling *s)
{
    return (double)s->total[IMAGE] * s->round[IMAGE] + (double)s->total[SCOUT] * s->round[SCOUT];
}

/* Rounds of the picture that the limit leaves. */
static double left_by_limit(const struct mcr_sampling *s)
{
    double all = (double)s->rules.limit * (double)s->pixels;
    return s->rules.limit ? floor((all - samples_of(s)) / s->round[IMAGE]) : INFINITY;
}

/* Rounds that fit into the time that is left, at the speed so far. */
static double left_by_time(const struct mcr_sampling *s, double seconds)
{
    if (!(s->rules.time > 0))
        return INFINITY;
    return (s->rules.time - seconds) / (seconds / samples_of(s)) / s->round[IMAGE];
}

static int same_for_all(struct mcr_sampling *s, double rounds)
{
    uint32_t want = rounds < s->most ? (uint32_t)rounds : s->most;
    uint64_t added = 0;
    for (uint64_t p = 0; p < s->pixels; p++) {
        s->want[IMAGE][p] = want > s->have[IMAGE][p] ? want : s->have[IMAGE][p];
        added += s->want[IMAGE][p] - s->have[IMAGE][p];
    }
    return added > 0;
}

/* How noisy one sample is, by pixel. */
static void estimate_noise(struct mcr_sampling *s)
{
    for (uint64_t p = 0; p < s->pixels; p++) {
        double samples = (double)s->have[SCOUT][p] * s->round[SCOUT], units = s->film->correlated ? s->have[SCOUT][p] : samples;
        s->variance[p] = s->moment[p] / (units - 1);
        s->weight[p] = samples / MCR_CELL_SAMPLES;
    }
    mcr_noise(s->film->width, s->film->height, s->variance, s->weight, s->noise, s->scratch);
}

/* Scouts follow the picture's samples; returns the samples that this takes. */
static double more_scouts(struct mcr_sampling *s)
{
    double added = 0;
    for (uint64_t p = 0; p < s->pixels; p++) {
        uint64_t share = (uint64_t)s->have[IMAGE][p] * s->round[IMAGE] / SCOUT_SHARE / s->round[SCOUT];
        uint32_t have = s->have[SCOUT][p];
        s->want[SCOUT][p] = share > have ? (uint32_t)share : have;
        added += (double)(s->want[SCOUT][p] - have) * s->round[SCOUT];
    }
    return added;
}

/* `rounds` more over the whole picture, where the noise is. */
static int distribute(struct mcr_sampling *s, double rounds, double left)
{
    double scouts = more_scouts(s) / s->round[IMAGE];
    if (scouts > left / 2 || left - scouts < 1) { /* the end is near: the picture's samples matter more */
        memcpy(s->want[SCOUT], s->have[SCOUT], s->pixels * sizeof *s->want[SCOUT]);
        scouts = 0;
    }
    rounds = floor(rounds < left - scouts ? rounds : left - scouts);
    double total = (double)s->total[IMAGE] + rounds, mean = total / (double)s->pixels / DEFENCE;
    uint32_t least = mean < s->rules.least ? s->rules.least : mean < s->most ? (uint32_t)mean : s->most;
    estimate_noise(s);
    return mcr_allocate(s->pixels, s->noise, s->have[IMAGE], least, s->most, total, s->want[IMAGE]) > 0;
}

/* ---- Which step is next ---- */

/* Rounds that the target is thought to take, over all; 1 if it is reached, 0 if not, -1 when memory is short. */
static int look(struct mcr_sampling *s)
{
    struct mcr_film_figures figures;
    s->need = 0;
    if (!(s->rules.target > 0) || s->film->units < 2 || (double)s->total[IMAGE] * s->round[IMAGE] < (double)MCR_SAMPLING_LOOK * (double)s->pixels)
        return 0;
    if (mcr_film_figures(s->film, &figures))
        return -1;
    if (figures.mean_variance == 0 || (figures.luminance > 0 && figures.relative_bound <= s->rules.target))
        return 1;
    double ratio = figures.relative_bound / s->rules.target, need = (double)s->total[IMAGE] * ratio * ratio;
    s->need = need < INFINITY ? need : 0; /* infinite, or no number in a picture that is black on average: not known */
    return 0;
}

/* Rounds to add: a fraction of what there is, near the target less, so that it is not overshot. */
static double growth(const struct mcr_sampling *s)
{
    double now = (double)s->total[IMAGE], least = now / 16, most = s->adaptive ? now / 8 : now / 2, step = most;
    if (s->need > 0)
        step = 0.8 * (s->need - now);
    return step < least ? least : step < most ? step : most;
}

/* A step of whole rounds of the picture. */
static int grow_all(struct mcr_sampling *s, double rounds, double left)
{
    double pixels = (double)s->pixels, now = s->have[IMAGE][0], more = floor(rounds / pixels), most = floor(left / pixels);
    double least = s->rules.target > 0 ? ceil((double)MCR_SAMPLING_LOOK / s->round[IMAGE]) : 1;
    least = s->film->correlated && least < 2 ? 2 : least;
    least = least > s->rules.least ? least : s->rules.least;
    more = now < least ? least - now : more < 1 ? 1 : more;
    return same_for_all(s, now + (more < most ? more : most));
}

/* Every pixel's floor, and its first scouts. */
static int first_scouting(struct mcr_sampling *s)
{
    for (uint64_t p = 0; p < s->pixels; p++)
        s->want[SCOUT][p] = s->first_scouts;
    same_for_all(s, s->rules.least);
    return 1;
}

/* Sets what the next step wants. 1; 0 with s->stopped where it is enough; -1 when memory is short. */
static int plan(struct mcr_sampling *s, double seconds)
{
    if (!s->total[IMAGE]) /* with a map, too: what is interrupted then is a picture all the same */
        return same_for_all(s, 1);
    if (s->rules.map && s->steps > 1)
        s->stopped = MCR_STOPPED_MAP;
    if (s->rules.map) {
        memcpy(s->want[IMAGE], s->rules.map, s->pixels * sizeof *s->want[IMAGE]);
        return !s->stopped;
    }
    int reached = look(s);
    double least = s->adaptive ? (double)s->total[IMAGE] / 64 : (double)s->pixels;
    double by_limit = left_by_limit(s), by_time = left_by_time(s, seconds), rounds = growth(s);
    if (reached)
        s->stopped = MCR_STOPPED_TARGET;
    else if (by_limit < (s->adaptive ? 1 : (double)s->pixels))
        s->stopped = MCR_STOPPED_SPP;
    else if (by_time < least)
        s->stopped = MCR_STOPPED_TIME;
    if (reached || s->stopped)
        return reached < 0 ? -1 : 0;
    if (s->rules.time > 0 && rounds > 0.75 * by_time) /* speeds change: the last steps are small */
        rounds = 0.75 * by_time > least ? 0.75 * by_time : least;
    double left = by_limit < by_time ? by_limit : by_time;
    int more = !s->adaptive ? grow_all(s, rounds, left) : !s->total[SCOUT] ? first_scouting(s) : distribute(s, rounds < 1 ? 1 : rounds, left);
    if (!more)
        s->stopped = by_limit < INFINITY && s->adaptive && by_limit < 2 ? MCR_STOPPED_SPP : MCR_STOPPED_MOST;
    return more;
}

/* ---- The director ---- */

static struct mcr_task_entry entry_of(const struct mcr_sampling *s, int which, uint64_t pixel)
{
    uint32_t number = s->have[which][pixel];
    struct mcr_task_entry entry = {.pixel = (uint32_t)pixel};
    if (which == SCOUT)
        entry.replicate = SCOUT_REPLICATE + number;
    else if (s->film->correlated)
        entry.replicate = number;
    else
        entry.first = number * s->round[which];
    return entry;
}

/* Entries pixel by pixel, all that each wants. Returns how many there are. */
static uint32_t pixel_by_pixel(struct mcr_sampling *s, int w, uint32_t room)
{
    uint32_t count = 0;
    for (; s->at < s->pixels && count < room; s->at += s->have[w][s->at] == s->want[w][s->at]) {
        if (s->have[w][s->at] == s->want[w][s->at])
            continue;
        s->entry[count++] = entry_of(s, w, s->at);
        s->have[w][s->at]++;
    }
    return count;
}

/* Entries of the first replicate that some pixel lacks, then of the next. */
static uint32_t replicate_by_replicate(struct mcr_sampling *s, int w, uint32_t room)
{
    uint32_t count = 0, number = UINT32_MAX;
    if (s->at == s->pixels)
        return 0;
    for (uint64_t p = 0; p < s->pixels; p++)
        number = s->have[w][p] < s->want[w][p] && s->have[w][p] < number ? s->have[w][p] : number;
    uint64_t p = 0;
    for (; p < s->pixels && count < room; p++) {
        if (s->have[w][p] != number || number == s->want[w][p])
            continue;
        s->entry[count++] = entry_of(s, w, p);
        s->have[w][p]++;
    }
    if (!count)
        s->at = s->pixels;
    return count;
}

/* The next entries of the running step. Returns how many there are. */
static uint32_t hand_out(struct mcr_sampling *s)
{
    for (; s->which <= SCOUT; s->which++, s->at = 0) {
        const int w = s->which;
        const uint32_t room = s->have[w] ? MCR_TASK_CELLS / s->cells[w] : 0;
        uint32_t count = !room ? 0 : s->rules.by_replicate ? replicate_by_replicate(s, w, room) : pixel_by_pixel(s, w, room);
        s->total[w] += count;
        if (count)
            return count;
    }
    s->which = SCOUT;
    s->at = s->pixels;
    return 0;
}

/* How much of all is done, as far as that can be known. */
static double progress_of(const struct mcr_sampling *s, double seconds, double samples)
{
    double done = s->rules.limit ? samples / ((double)s->rules.limit * (double)s->pixels) : 0, all = 0;
    double by_time = s->rules.time > 0 ? seconds / s->rules.time : 0, by_need = s->need > 0 ? samples / (s->need * s->round[IMAGE]) : 0;
    for (uint64_t p = 0; p < s->pixels && s->rules.map; p++)
        all += (double)s->rules.map[p] * s->round[IMAGE];
    done = all > 0 ? samples / all : done;
    done = by_time > done ? by_time : done;
    done = by_need > done ? by_need : done;
    return done < 1 ? done : 1;
}

static int next(void *data, double seconds, struct mcr_task *task)
{
    struct mcr_sampling *s = data;
    double before = samples_of(s);
    int whole = s->film->samples > 0; /* every pixel has a round */
    uint32_t count = 0;
    if (whole && s->rules.time > 0 && seconds >= s->rules.time && !s->rules.map) {
        s->stopped = MCR_STOPPED_TIME;
        return 0;
    }
    while (!(count = hand_out(s))) {
        int more = plan(s, seconds);
        if (more <= 0)
            return more;
        s->which = IMAGE;
        s->at = 0;
        s->steps++;
    }
    const int w = s->which;
    double after = samples_of(s), later = before > 0 ? seconds * (after / before) : seconds;
    *task = (struct mcr_task){.entry = s->entry,
                              .count = count,
                              .cells = s->cells[w],
                              .cell_samples = s->cell_samples[w],
                              .planned = s->round[w],
                              .incomplete = !whole && s->total[IMAGE] < s->pixels,
                              .begin = progress_of(s, seconds, before),
                              .end = progress_of(s, later, after)};
    return 1;
}

/* What a pixel's scouts saw in one round. */
static void take_scouts(struct mcr_sampling *s, const struct mcr_task *task, const struct mcr_cell *cell, uint32_t e)
{
    const uint32_t p = task->entry[e].pixel;
    double units = s->film->correlated ? 1 : task->cell_samples, sum = 0, moment = 0;
    double before = (double)(task->entry[e].replicate - SCOUT_REPLICATE) * units;
    for (uint32_t b = 0; b < task->cells; b++) {
        const struct mcr_cell *c = &cell[(uint64_t)b * task->count + e];
        sum += mcr_luminance(c->sum[0], c->sum[1], c->sum[2]);
        moment += c->moment;
    }
    double difference = sum / ((double)task->cells * task->cell_samples) - s->mean[p];
    s->mean[p] += difference * (units / (before + units));
    s->moment[p] += (s->film->correlated ? 0 : moment) + difference * difference * (before * units / (before + units));
}

static int take(void *data, const struct mcr_task *task, const struct mcr_cell *cell, const struct mcr_cell_channels *channels,
                const struct mcr_cell_features *features)
{
    struct mcr_sampling *s = data;
    if (s->which == IMAGE && s->features)
        mcr_features_take(s->features, task, features);
    if (s->which == IMAGE)
        return mcr_film_take(s->film, task, cell, channels);
    for (uint32_t e = 0; e < task->count; e++)
        take_scouts(s, task, cell, e);
    return 0;
}

struct mcr_director mcr_sampling_director(struct mcr_sampling *sampling)
{
    return (struct mcr_director){.data = sampling, .next = next, .take = take, .channels = sampling->film->channels};
}

void mcr_sampling_result(const struct mcr_sampling *s, struct mcr_sampling_result *result)
{
    double sum = 0;
    *result = (struct mcr_sampling_result){.stopped = s->stopped, .least = UINT64_MAX, .steps = s->steps, .distributed = s->adaptive && s->total[SCOUT]};
    for (uint64_t p = 0; p < s->pixels; p++) {
        uint64_t samples = mcr_film_samples(s->film, p);
        result->least = samples < result->least ? samples : result->least;
        result->most = samples > result->most ? samples : result->most;
        sum += (double)samples;
    }
    result->mean = sum / (double)s->pixels;
    result->scouts = (double)s->total[SCOUT] * s->round[SCOUT] / (double)s->pixels;
}
