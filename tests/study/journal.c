/* SPDX-License-Identifier: Apache-2.0 */
/* Journals and state files: what is written is read, and nothing that stands in them brings the program down or is taken for what it is not. */
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../tap.h"
#include "base/random.h"
#include "study/journal.h"
#include "study/state.h"

#define CONTENT UINT64_C(0x123456789abcdef0)

#define bail_out(...) (printf("Bail out! " __VA_ARGS__), exit(99))

static char folder[1024], path[1100];
static char reason[600];

static struct mcr_journal *open_it(void)
{
    struct mcr_journal_head head = {.scene = "a \"scene\"\n\xc3", .content = CONTENT, .started = "2026-01-01T00:00:00Z"};
    return mcr_journal_open(folder, &head, reason, sizeof reason);
}

static struct mcr_study_run example(uint32_t i)
{
    struct mcr_study_run run = {.seed = UINT64_MAX - i, .wall_seconds = 0.1 + i, .cpu_seconds = 1e-300, .build_seconds = 1 / 3., .write_seconds = 0,
                                .samples = UINT64_C(1) << 63, .rays = 12345678901234567u, .not_finite = i, .order = i};
    for (int m = 0; m < MCR_METRIC_COUNT; m++)
        run.metric[m] = m == 0 ? (double)INFINITY : m == 1 ? -(double)INFINITY : m == 2 ? (double)NAN : sqrt(m + i);
    return run;
}

static int same_run(const struct mcr_study_run *a, const struct mcr_study_run *b)
{
    int same = a->seed == b->seed && a->wall_seconds == b->wall_seconds && a->cpu_seconds == b->cpu_seconds && a->build_seconds == b->build_seconds &&
               a->samples == b->samples && a->rays == b->rays && a->not_finite == b->not_finite && a->order == b->order;
    for (int m = 0; m < MCR_METRIC_COUNT; m++)
        same &= a->metric[m] == b->metric[m] || (isnan(a->metric[m]) && isnan(b->metric[m]));
    return same;
}

static void round_trip(void)
{
    struct mcr_journal *journal = open_it(), *other;
    struct mcr_journal_equal equal = {.key = 5, .spp = 77, .wall_seconds = 2.5, .image = "images/a-b.exr"};
    struct mcr_study_run out[8];
    int good = journal != NULL;
    for (uint32_t i = 0; i < 5 && good; i++)
        for (uint64_t cell = 1; cell <= 3; cell++) {
            struct mcr_study_run run = example(i);
            good &= !mcr_journal_add_run(journal, cell * UINT64_C(0x9e3779b97f4a7c15), i == 3 && cell == 2 ? 7 : i, &run, reason, sizeof reason);
        }
    good = good && !mcr_journal_add_equal(journal, 9, &equal, reason, sizeof reason);
    ok(good, "written");
    other = open_it();
    ok(!other && strstr(reason, "another process"), "locked meanwhile: %s", reason);
    mcr_journal_close(journal);
    journal = open_it();
    ok(journal && mcr_journal_dropped(journal) == 0 && mcr_journal_count(journal) == 15, "read again");
    if (!journal)
        return;
    uint32_t count = mcr_journal_runs(journal, UINT64_C(0x9e3779b97f4a7c15), out, 8);
    good = count == 5;
    for (uint32_t i = 0; i < count; i++) {
        struct mcr_study_run run = example(i);
        good &= same_run(&run, &out[i]);
    }
    ok(good, "all bits of all runs, with infinities");
    ok(mcr_journal_runs(journal, 2 * UINT64_C(0x9e3779b97f4a7c15), out, 8) == 3, "runs behind a gap are left out");
    ok(mcr_journal_runs(journal, UINT64_C(0x9e3779b97f4a7c15), out, 2) == 2, "no more than there is room for");
    ok(mcr_journal_runs(journal, 1, out, 8) == 0, "none of another cell");
    const struct mcr_journal_equal *found = mcr_journal_equal(journal, 9);
    ok(found && found->spp == 77 && found->key == 5 && found->wall_seconds == 2.5 && !strcmp(found->image, "images/a-b.exr"), "the render at equal time");
    mcr_journal_close(journal);
    struct mcr_journal_head head = {.content = CONTENT + 1};
    ok(!mcr_journal_look(folder, &head, reason, sizeof reason) && strstr(reason, "another scene"), "another scene's: %s", reason);
}

static char *slurp(size_t *size)
{
    FILE *file = fopen(path, "rb");
    char *bytes = malloc(1 << 20);
    *size = file && bytes ? fread(bytes, 1, 1 << 20, file) : 0;
    if (file)
        fclose(file);
    return bytes;
}

static void spill(const char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file))
        bail_out("cannot write %s", path);
}

/* Every line that is taken is one that was written. */
static int honest(const struct mcr_journal *journal)
{
    struct mcr_study_run out[8];
    int good = 1;
    for (uint64_t cell = 1; cell <= 3; cell++) {
        uint32_t count = mcr_journal_runs(journal, cell * UINT64_C(0x9e3779b97f4a7c15), out, 8);
        for (uint32_t i = 0; i < count; i++) {
            struct mcr_study_run run = example(i);
            good &= same_run(&run, &out[i]);
        }
    }
    return good;
}

static void hostile(void)
{
    size_t size;
    char *bytes = slurp(&size), *changed = malloc(1 << 20);
    uint64_t state = 1;
    int good = 1, opened = 0, grown = 1;
    for (int i = 0; i < 3000; i++) {
        size_t length = size;
        memcpy(changed, bytes, size);
        state = mcr_mix64(state + 1);
        if (i % 3 == 0) {
            length = state % (size + 1);
        } else {
            for (uint64_t k = 0; k <= state % 4; k++)
                changed[(state >> 8 * (k + 1)) % size] = (char)(state >> 3 * k);
        }
        spill(changed, length);
        struct mcr_journal *journal = open_it();
        if (!journal)
            continue;
        opened++;
        good &= honest(journal);
        struct mcr_study_run run = example(0);
        grown &= !mcr_journal_add_run(journal, 99, 0, &run, reason, sizeof reason);
        mcr_journal_close(journal);
        journal = open_it();
        grown &= journal && mcr_journal_runs(journal, 99, &run, 1) == 1;
        mcr_journal_close(journal);
    }
    ok(opened > 1500, "of 3000 damaged journals, %d are still journals", opened);
    ok(good, "and nothing is taken from them that was not written");
    ok(grown, "and all of them go on");
    memset(changed, 'x', 1 << 20);
    memcpy(changed, bytes, size);
    spill(changed, 1 << 20);
    struct mcr_journal *journal = open_it();
    ok(journal && mcr_journal_dropped(journal) == 1 && honest(journal), "a line of a megabyte is not taken");
    mcr_journal_close(journal);
    free(bytes);
    free(changed);
}

static void states(void)
{
    struct mcr_state state, other;
    size_t size;
    int good = 1;
    snprintf(path, sizeof path, "%s/state", folder);
    mkdir(path, 0777);
    snprintf(path, sizeof path, "%s/state/x", folder);
    if (mcr_state_init(&state, 5, 7, 3, 2) || mcr_state_init(&other, 5, 7, 3, 2))
        bail_out("no memory");
    ok(mcr_state_read(&other, folder, "x") == 1, "a state that is not there");
    for (int i = 0; i < 42; i++)
        state.data[i] = i == 3 ? (double)NAN : sqrt(i);
    state.count = 4;
    state.mark = 77;
    state.seconds = 1.5;
    ok(!mcr_state_write(&state, folder, "x", reason, sizeof reason) && !mcr_state_read(&other, folder, "x") && other.count == 4 && other.mark == 77 &&
       other.seconds == 1.5 && !memcmp(other.data, state.data, 42 * sizeof(double)), "written and read: %s", reason);
    char *bytes = slurp(&size);
    for (size_t i = 0; i < size; i++) {
        bytes[i] ^= 4;
        spill(bytes, size);
        good &= mcr_state_read(&other, folder, "x") == -1;
        bytes[i] ^= 4;
    }
    ok(good, "any byte that is changed is found");
    for (size_t i = 0; i < size; i++) {
        spill(bytes, i);
        good &= mcr_state_read(&other, folder, "x") == -1;
    }
    ok(good && other.count == 4, "any shorter file, and the state stays what it was");
    spill(bytes, size);
    other.key = 6;
    ok(mcr_state_read(&other, folder, "x") == -1, "another's key");
    other.key = 5;
    ok(!mcr_state_read(&other, folder, "x"), "the whole file again");
    mcr_state_fini(&other);
    ok(!mcr_state_init(&other, 5, 3, 7, 2) && mcr_state_read(&other, folder, "x") == -1, "another size of as many values");
    ok(mcr_state_init(&(struct mcr_state){0}, 1, UINT32_MAX, UINT32_MAX, 6) == -1, "a size that overflows");
    free(bytes);
    mcr_state_fini(&state);
    mcr_state_fini(&other);
}

int main(void)
{
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/study-journal-XXXXXX", temporary ? temporary : "/tmp");
    if (!mkdtemp(folder))
        bail_out("no folder");
    snprintf(path, sizeof path, "%s/journal.jsonl", folder);
    round_trip();
    hostile();
    states();
    return tap_done();
}
