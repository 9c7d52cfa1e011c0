/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Rules of sampling on pictures whose samples have known distributions: a stand-in for the core renders what the director asks for. What is known: each
 * pixel's mean and the variance of a sample. Adaptive pictures must be unbiased in their means and in what they say of their errors.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../tap.h"
#include "base/random.h"
#include "film/allocate.h"
#include "film/sampling.h"

#define WIDTH 32u
#define HEIGHT 4u
#define PIXELS (WIDTH * HEIGHT)

/* ---- a stand-in for the core ---- */

#define KINDS 4u
#define SAME (PIXELS / KINDS) /* pixels of a kind: a block of columns */

static uint32_t kind(uint32_t pixel)
{
    return pixel % WIDTH / (WIDTH / KINDS);
}

/* A pixel is white with this probability, with a value that makes its mean 1. The first kind is constant; rare values are as skewed as it gets. */
static double chance(uint32_t pixel)
{
    static const double of[KINDS] = {1, 0.5, 0.2, 0.05};
    return of[kind(pixel)];
}

static double sample_variance(uint32_t pixel)
{
    return 1 / chance(pixel) - 1;
}

/* One sample; of a correlated round, the samples of each pair mirror each other: variance is no longer that of independent ones. */
static double sample(uint64_t seed, const struct mcr_task_entry *entry, uint32_t index, int correlated)
{
    uint32_t number = correlated ? index / 2 : index;
    uint64_t key = mcr_path_key(mcr_pixel_key(mcr_replicate_key(seed, entry->replicate), entry->pixel), number);
    double u = mcr_unit_double(mcr_dimension_bits(key, 0));
    if (correlated && index % 2)
        u = 1 - u;
    return u < chance(entry->pixel) ? 1 / chance(entry->pixel) : 0;
}

static int render_task(uint64_t seed, const struct mcr_director *director, const struct mcr_task *task, int correlated)
{
    static struct mcr_cell cell[MCR_TASK_CELLS];
    for (uint32_t e = 0; e < task->count; e++)
        for (uint32_t b = 0; b < task->cells; b++) {
            double v[MCR_CELL_SAMPLES];
            for (uint32_t i = 0; i < task->cell_samples; i++)
                v[i] = sample(seed, &task->entry[e], task->entry[e].first + b * task->cell_samples + i, correlated);
            mcr_cell_sum(v, v, v, task->cell_samples, &cell[b * task->count + e]);
        }
    return director->take(director->data, task, cell, NULL, NULL);
}

struct picture {
    struct mcr_sampling_result result;
    struct mcr_film_figures figures;
    double mean[PIXELS], variance[PIXELS];
    uint64_t samples[PIXELS];
    int bad;
};

/* clock: seconds that a sample takes. stop: tasks after which it is interrupted. */
static struct picture run(uint64_t seed, const struct mcr_sampling_rules *rules, int correlated, double clock, uint32_t stop)
{
    static double rgb[3 * PIXELS];
    struct picture picture;
    struct mcr_film *film = mcr_film_create(WIDTH, HEIGHT, correlated);
    struct mcr_sampling *sampling = mcr_sampling_create(film, NULL, rules);
    struct mcr_director director = mcr_sampling_director(sampling);
    struct mcr_task task = {.incomplete = 0};
    double seconds = 0;
    memset(&picture, 0, sizeof picture);
    for (uint32_t tasks = 0; (tasks < stop || task.incomplete) && director.next(director.data, seconds, &task) > 0; tasks++) {
        picture.bad |= render_task(seed, &director, &task, correlated) != 0;
        picture.bad |= !(task.begin >= 0 && task.begin <= task.end && task.end <= 1) || (uint64_t)task.count * task.cells > MCR_TASK_CELLS;
        seconds += clock * task.count * task.cells * task.cell_samples;
    }
    mcr_sampling_result(sampling, &picture.result);
    mcr_film_mean(film, rgb);
    mcr_film_variance(film, picture.variance);
    mcr_film_figures(film, &picture.figures);
    for (uint32_t p = 0; p < PIXELS; p++) {
        picture.mean[p] = rgb[3 * p];
        picture.samples[p] = mcr_film_samples(film, p);
    }
    mcr_sampling_destroy(sampling);
    mcr_film_destroy(film);
    return picture;
}

static uint64_t total_of(const struct picture *picture)
{
    uint64_t total = 0;
    for (uint32_t p = 0; p < PIXELS; p++)
        total += picture->samples[p];
    return total;
}

/* ---- statistics ---- */

struct spread {
    double n, mean, moment;
};

static void spread_add(struct spread *s, double x)
{
    double difference = x - s->mean;
    s->mean += difference / ++s->n;
    s->moment += difference * (x - s->mean);
}

static double error_of(const struct spread *s)
{
    return sqrt(s->moment / (s->n - 1) / s->n);
}

static double z_of(const struct spread *s, double expected)
{
    double error = error_of(s);
    return error > 0 ? (s->mean - expected) / error : s->mean == expected ? 0 : INFINITY;
}

/* ---- unbiased ---- */

/* Pixels of a kind are one quantity: their mean, and for all of them what the film says of its variance against the true squared error. */
static void test_unbiased(const char *what, const struct mcr_sampling_rules *rules, int correlated, uint32_t runs)
{
    struct spread mean[KINDS] = {{0, 0, 0}}, claim = {0, 0, 0}, truth = {0, 0, 0}, difference = {0, 0, 0};
    double worst = 0, widest = 0;
    int bad = 0;
    for (uint32_t r = 0; r < runs; r++) {
        struct picture picture = run(1000 + r, rules, correlated, 1e-6, UINT32_MAX);
        double square = 0, said = 0, sum[KINDS] = {0};
        for (uint32_t p = 0; p < PIXELS; p++) {
            sum[kind(p)] += picture.mean[p] / SAME;
            square += (picture.mean[p] - 1) * (picture.mean[p] - 1) / PIXELS;
            said += picture.variance[p] / PIXELS;
        }
        for (uint32_t k = 0; k < KINDS; k++)
            spread_add(&mean[k], sum[k]);
        spread_add(&claim, said);
        spread_add(&truth, square);
        spread_add(&difference, said - square);
        bad |= picture.bad;
    }
    for (uint32_t k = 1; k < KINDS; k++) {
        worst = fmax(worst, fabs(z_of(&mean[k], 1)));
        widest = fmax(widest, error_of(&mean[k]));
    }
    ok(!bad && worst <= 4 && widest < 0.0025 && fabs(mean[0].mean - 1) < 1e-14, "%s: means of %u runs: |z| <= %.2f, 1 %% is %.1f standard errors", what, runs,
       worst, 0.01 / widest);
    ok(fabs(z_of(&difference, 0)) <= 4, "%s: the squared error is what is said: %.4g said, ratio %.4f +- %.4f", what, claim.mean, claim.mean / truth.mean,
       error_of(&difference) / truth.mean);
}

/* ---- the target ---- */

static double true_error(const struct picture *picture, int correlated)
{
    double sum = 0;
    for (uint32_t p = 0; p < PIXELS; p++) {
        /* A mirrored pair of a pixel with chance c <= 1/2 is white once with probability 2c: twice the variance less twice the covariance -1. */
        double variance = correlated && chance(p) <= 0.5 ? (1 / chance(p) - 2) : sample_variance(p);
        sum += variance / (double)picture->samples[p] / PIXELS;
    }
    return sqrt(sum);
}

static void test_target(const char *what, double target, int adaptive, int correlated, uint32_t runs)
{
    struct mcr_sampling_rules rules = {.target = target, .round = 16, .least = 1, .floor = 16, .adaptive = adaptive};
    uint32_t missed = 0, wrong = 0;
    struct spread ratio = {0, 0, 0};
    for (uint32_t r = 0; r < runs; r++) {
        struct picture picture = run(r, &rules, correlated, 1e-6, UINT32_MAX);
        double error = true_error(&picture, correlated);
        missed += error > target;
        wrong += picture.result.stopped != MCR_STOPPED_TARGET || !(picture.figures.relative_bound <= target) || picture.result.mean < MCR_SAMPLING_LOOK;
        spread_add(&ratio, error / target);
    }
    /* Looks are several, and each may err: 5 % for one, and some more for all. */
    ok(!wrong && missed <= 0.1 * runs, "%s: target %.3g is missed by %u of %u runs", what, target, missed, runs);
    ok(ratio.mean > 0.6 && ratio.mean < 1, "%s: and not overdone: the true error is %.3f of it", what, ratio.mean);
}

/* ---- adaptive ---- */

static void test_gain(void)
{
    struct mcr_sampling_rules rules = {.limit = 512, .round = 16, .least = 1, .floor = 16, .adaptive = 1};
    struct spread gain = {0, 0, 0};
    double even = 0, best = 0, sd = 0;
    int wrong = 0;
    for (uint32_t p = 0; p < PIXELS; p++) {
        even += sample_variance(p) / 512 / PIXELS;
        sd += sqrt(sample_variance(p)) / PIXELS;
    }
    best = sd * sd / 512;
    for (uint32_t r = 0; r < 50; r++) {
        struct picture picture = run(r, &rules, 0, 1e-6, UINT32_MAX);
        double error = true_error(&picture, 0), all = (double)total_of(&picture) + picture.result.scouts * PIXELS;
        spread_add(&gain, even / (error * error));
        wrong += picture.result.stopped != MCR_STOPPED_SPP || all > 512.0 * PIXELS || all < 511.0 * PIXELS || picture.result.least < 16 ||
                 !picture.result.distributed || picture.result.scouts <= 0 || picture.samples[0] > picture.samples[PIXELS - 1];
    }
    ok(!wrong, "spp is kept, scouts included; the floor, too; constant pixels have fewer samples than the noisiest");
    ok(gain.mean > 0.75 * even / best && gain.mean < even / best, "the mean squared error falls by %.3f +- %.3f at equal samples; optimal: %.3f", gain.mean,
       error_of(&gain), even / best);
}

static int same(const struct picture *a, const struct picture *b)
{
    return !memcmp(a->mean, b->mean, sizeof a->mean) && !memcmp(a->variance, b->variance, sizeof a->variance) &&
           !memcmp(a->samples, b->samples, sizeof a->samples);
}

static void test_replay(int correlated, uint32_t round)
{
    static uint32_t rounds[PIXELS];
    struct mcr_sampling_rules rules = {.limit = 16 * round, .round = round, .least = 1, .floor = 16, .adaptive = 1};
    struct picture first = run(7, &rules, correlated, 1e-6, UINT32_MAX);
    for (uint32_t p = 0; p < PIXELS; p++)
        rounds[p] = (uint32_t)(first.samples[p] / round);
    struct mcr_sampling_rules replay = {.round = round, .map = rounds};
    struct picture again = run(7, &replay, correlated, 1e-6, UINT32_MAX), part = run(7, &replay, correlated, 1e-6, 1);
    ok(same(&first, &again) && again.result.stopped == MCR_STOPPED_MAP && again.result.scouts == 0 && first.result.least < first.result.most,
       "rounds of %u, %s: the map gives the same bits, %llu to %llu samples", round, correlated ? "correlated" : "independent",
       (unsigned long long)first.result.least, (unsigned long long)first.result.most);
    ok(part.result.stopped == MCR_STOPPED_NOT && part.result.least >= round, "interrupted, every pixel has a round");
}

/* The same samples through the other way into the film. */
static void test_even(int correlated)
{
    enum { ROUNDS = 300, ROUND = 32 };
    static uint32_t rounds[PIXELS];
    static struct mcr_cell cell[PIXELS];
    struct mcr_film *film = mcr_film_create(WIDTH, HEIGHT, correlated);
    double rgb[3 * PIXELS], variance[PIXELS];
    int differ = 0;
    for (uint32_t r = 0; r < ROUNDS; r++) {
        for (uint32_t b = 0; b < ROUND / MCR_CELL_SAMPLES; b++) {
            for (uint32_t p = 0; p < PIXELS; p++) {
                struct mcr_task_entry entry = {.pixel = p, .replicate = correlated ? r : 0};
                double v[MCR_CELL_SAMPLES];
                for (uint32_t i = 0; i < MCR_CELL_SAMPLES; i++)
                    v[i] = sample(3, &entry, (correlated ? 0 : r * ROUND) + b * MCR_CELL_SAMPLES + i, correlated);
                mcr_cell_sum(v, v, v, MCR_CELL_SAMPLES, &cell[p]);
            }
            mcr_film_add(film, cell, MCR_CELL_SAMPLES);
        }
        mcr_film_end_replicate(film);
    }
    for (uint32_t p = 0; p < PIXELS; p++)
        rounds[p] = ROUNDS;
    struct mcr_sampling_rules rules = {.round = ROUND, .map = rounds};
    struct picture picture = run(3, &rules, correlated, 1e-6, UINT32_MAX);
    mcr_film_mean(film, rgb);
    mcr_film_variance(film, variance);
    for (uint32_t p = 0; p < PIXELS; p++)
        differ += picture.mean[p] != rgb[3 * p] || picture.variance[p] != variance[p];
    ok(!differ, "%s: with equal numbers the bits of a film whose pixels are all alike (600 cells)",
       correlated ? "correlated" : "independent");
    mcr_film_destroy(film);
}

/* ---- time ---- */

static void test_time(void)
{
    struct mcr_sampling_rules rules = {.time = 1, .round = 16, .least = 1};
    struct picture late = run(1, &rules, 0, 10, UINT32_MAX), even = run(1, &rules, 0, 1.0 / (1000.0 * PIXELS), UINT32_MAX);
    ok(late.result.stopped == MCR_STOPPED_TIME && late.result.least == 16 && late.result.most == 16, "time that is too short: one round");
    ok(even.result.stopped == MCR_STOPPED_TIME && even.result.least == even.result.most && even.result.least >= 960 && even.result.least <= 1000,
       "time for 1000 samples: %llu of every pixel", (unsigned long long)even.result.least);
    rules.adaptive = 1;
    rules.floor = 16;
    struct picture adaptive = run(1, &rules, 0, 1.0 / (1000.0 * PIXELS), UINT32_MAX);
    double all = adaptive.result.mean + adaptive.result.scouts;
    ok(adaptive.result.stopped == MCR_STOPPED_TIME && all > 950 && all <= 1000 && adaptive.result.least < adaptive.result.most, "adaptive: %.1f in the mean", all);
    rules.limit = 100;
    struct picture both = run(1, &rules, 0, 1.0 / (1000.0 * PIXELS), UINT32_MAX);
    ok(both.result.stopped == MCR_STOPPED_SPP && both.result.mean + both.result.scouts <= 100, "time and spp: whichever comes first");
    struct mcr_sampling_rules target = {.time = 1, .target = 1e-6, .round = 16, .least = 1};
    ok(run(1, &target, 1, 1.0 / (1000.0 * PIXELS), UINT32_MAX).result.stopped == MCR_STOPPED_TIME, "time and a target that is far");
    struct mcr_sampling_rules small = {.limit = 31, .round = 16, .least = 1, .floor = 16, .adaptive = 1};
    struct picture none = run(1, &small, 0, 1e-6, UINT32_MAX);
    ok(none.result.stopped == MCR_STOPPED_SPP && none.result.least == 16 && none.result.scouts == 0 && !none.result.distributed,
       "adaptive with a limit that leaves nothing: every pixel alike, no scouts, and it is told");
}

/* ---- allocation ---- */

static void test_allocate(void)
{
    enum { N = 1000 };
    static double noise[N];
    static uint32_t have[N], want[N];
    double sum = 0;
    uint64_t total = 0;
    int good = 1;
    for (uint32_t p = 0; p < N; p++)
        sum += noise[p] = 1 + p % 10;
    uint64_t added = mcr_allocate(N, noise, have, 1, UINT32_MAX, 100000, want);
    for (uint32_t p = 0; p < N; p++) {
        total += want[p];
        good &= fabs(want[p] - noise[p] / sum * 100000) <= 1;
    }
    ok(added == 100000 && total == 100000 && good, "in proportion to the noise, none lost");
    memset(noise, 0, sizeof noise);
    added = mcr_allocate(N, noise, have, 0, UINT32_MAX, 2500, want);
    good = 1;
    for (uint32_t p = 0; p < N; p++)
        good &= want[p] == 2 || want[p] == 3;
    ok(added == 2500 && good, "without any noise: even");
    noise[3] = 1;
    have[5] = 70;
    mcr_allocate(N, noise, have, 4, 50, 10000, want);
    ok(want[3] == 50 && want[5] == 70 && want[6] == 4, "least, most, and what a pixel has");
    ok(mcr_allocate(N, noise, have, 4, 50, 71, want) == 1 && want[6] == 0 && want[3] == 1, "least is passed over where the total does not allow it");
}

static void test_noise(void)
{
    double variance[PIXELS], cells[PIXELS], noise[PIXELS], scratch[PIXELS];
    int good = 1;
    for (uint32_t p = 0; p < PIXELS; p++) {
        variance[p] = 9e300;
        cells[p] = 1;
    }
    variance[9] = 0;
    mcr_noise(WIDTH, HEIGHT, variance, cells, noise, scratch);
    for (uint32_t p = 0; p < PIXELS; p++)
        good &= isfinite(noise[p]) && (p == 9 || noise[p] > noise[9]);
    ok(good && noise[9] > 0.8 * noise[31], "a lucky pixel is not starved: %.3f of its neighbours' noise", noise[9] / noise[31]);
    memset(variance, 0, sizeof variance);
    variance[9] = 4;
    mcr_noise(WIDTH, HEIGHT, variance, cells, noise, scratch);
    ok(noise[9] > 2 * noise[10] && noise[10] > 0 && noise[20] == 0, "one that is noisy alone is seen: %.2f, beside it %.2f", noise[9], noise[10]);
    variance[9] = NAN;
    variance[10] = INFINITY;
    variance[3] = 1;
    mcr_noise(WIDTH, HEIGHT, variance, cells, noise, scratch);
    for (uint32_t p = 0; p < PIXELS; p++)
        good &= noise[p] >= 0 && noise[p] <= 1;
    ok(good, "what is not finite stays out of the sums");
}

int main(void)
{
    struct mcr_sampling_rules spp = {.limit = 128, .round = 16, .least = 1, .floor = 16, .adaptive = 1};
    struct mcr_sampling_rules target = {.target = 0.05, .round = 16, .least = 1, .floor = 16, .adaptive = 1};
    struct mcr_sampling_rules even = {.target = 0.1, .round = 16, .least = 1};
    const uint32_t runs = 1200;
    test_unbiased("adaptive, independent", &spp, 0, runs);
    test_unbiased("adaptive, correlated", &spp, 1, runs);
    test_unbiased("adaptive with a target, independent", &target, 0, runs / 8);
    test_unbiased("a target for all pixels", &even, 0, runs / 3);
    test_target("adaptive", 0.06, 1, 0, 100);
    test_target("adaptive, correlated", 0.06, 1, 1, 100);
    test_target("even", 0.1, 0, 0, 100);
    test_target("even, correlated", 0.1, 0, 1, 100);
    test_gain();
    test_replay(0, 16);
    test_replay(1, 16);
    test_replay(0, 5);
    test_replay(1, 48);
    test_even(0);
    test_even(1);
    test_time();
    test_allocate();
    test_noise();
    return tap_done();
}
