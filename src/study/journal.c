/* SPDX-License-Identifier: Apache-2.0 */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "study/journal.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/json.h"
#include "study/text.h"

#define FORMAT 1                          /* of the journal */
#define FILE_LIMIT ((off_t)512 << 20)     /* bytes: a hundred thousand runs take 80 MB */
#define LINE_LIMIT ((size_t)64 << 10)
#define CHECK ",\"check\":\""
#define CHECK_LENGTH (sizeof CHECK - 1 + 16 + 2) /* ,"check":"0123456789abcdef"} */

struct entry {
    uint64_t cell;
    uint32_t index;
    uint32_t line;   /* the later one of two counts */
    struct mcr_study_run run;
};

struct equal_entry {
    uint64_t base;
    struct mcr_journal_equal equal;
};

struct mcr_journal {
    int fd;          /* -1: only looked at */
    off_t size;      /* behind the last whole line */
    uint32_t dropped, lines;
    struct entry *entry;
    size_t count, room;
    int sorted;
    struct equal_entry *equal;
    size_t equal_count, equal_room;
};

static uint64_t hash_of(const char *bytes, size_t count)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < count; i++)
        hash = (hash ^ (unsigned char)bytes[i]) * UINT64_C(1099511628211);
    return hash;
}

static int fail(char *error, size_t length, const char *folder, const char *what)
{
    snprintf(error, length, "the study's journal '%s/journal.jsonl': %s", folder, what);
    return -1;
}

/* ---- reading ---- */

/* A number, also one that JSON has no form for. NaN where it is missing. */
static double number_of(const struct mcr_json *value)
{
    if (value && value->kind == MCR_JSON_NUMBER)
        return value->number;
    if (value && value->kind == MCR_JSON_TEXT && !strcmp(value->text, "inf"))
        return (double)INFINITY;
    if (value && value->kind == MCR_JSON_TEXT && !strcmp(value->text, "-inf"))
        return -(double)INFINITY;
    return (double)NAN;
}

/* A whole number up to 2^64 - 1; 0 where it is missing or something else. */
static uint64_t whole_of(const struct mcr_json *value)
{
    char *end;
    unsigned long long number;
    if (!value || value->kind != MCR_JSON_NUMBER)
        return 0;
    errno = 0;
    number = strtoull(value->text, &end, 10);
    return value->text[0] == '-' || *end || errno ? 0 : number;
}

static uint64_t key_of(const struct mcr_json *value)
{
    char *end;
    unsigned long long key;
    if (!value || value->kind != MCR_JSON_TEXT || value->length != 16)
        return 0;
    key = strtoull(value->text, &end, 16);
    return *end ? 0 : key;
}

static void read_metrics(const struct mcr_json *value, double metric[MCR_METRIC_COUNT])
{
    for (int m = 0; m < MCR_METRIC_COUNT; m++)
        metric[m] = number_of(mcr_json_get(value, mcr_metric_name[m]));
}

/* Room for one more element. 0, or -1 when memory is short. */
static int grow(void **array, size_t count, size_t *room, size_t size)
{
    size_t more = *room ? 2 * *room : 64;
    void *bigger;
    if (count < *room)
        return 0;
    bigger = more > SIZE_MAX / 2 / size ? NULL : realloc(*array, more * size);
    if (!bigger)
        return -1;
    *array = bigger;
    *room = more;
    return 0;
}

static int keep_run(struct mcr_journal *journal, uint64_t cell, uint32_t index, const struct mcr_study_run *run)
{
    void *array = journal->entry;
    int short_of = grow(&array, journal->count, &journal->room, sizeof *journal->entry);
    journal->entry = array;
    if (short_of)
        return -1;
    journal->entry[journal->count++] = (struct entry){cell, index, journal->lines++, *run};
    journal->sorted = 0;
    return 0;
}

static int keep_equal(struct mcr_journal *journal, uint64_t base, const struct mcr_journal_equal *equal)
{
    void *array = journal->equal;
    int short_of = grow(&array, journal->equal_count, &journal->equal_room, sizeof *journal->equal);
    journal->equal = array;
    if (short_of)
        return -1;
    journal->equal[journal->equal_count++] = (struct equal_entry){base, *equal};
    return 0;
}

static int read_run(struct mcr_journal *journal, const struct mcr_json *line)
{
    struct mcr_study_run run = {.seed = whole_of(mcr_json_get(line, "seed"))};
    uint64_t index = whole_of(mcr_json_get(line, "run"));
    if (index > UINT32_MAX)
        return 0;
    run.wall_seconds = number_of(mcr_json_get(line, "wall"));
    run.cpu_seconds = number_of(mcr_json_get(line, "cpu"));
    run.build_seconds = number_of(mcr_json_get(line, "build"));
    run.write_seconds = number_of(mcr_json_get(line, "write"));
    run.samples = whole_of(mcr_json_get(line, "samples"));
    run.rays = whole_of(mcr_json_get(line, "rays"));
    run.not_finite = whole_of(mcr_json_get(line, "not_finite"));
    run.order = whole_of(mcr_json_get(line, "order"));
    read_metrics(mcr_json_get(line, "metrics"), run.metric);
    return keep_run(journal, key_of(mcr_json_get(line, "cell")), (uint32_t)index, &run);
}

static int read_equal(struct mcr_journal *journal, const struct mcr_json *line)
{
    struct mcr_journal_equal equal = {.key = key_of(mcr_json_get(line, "cell")), .wall_seconds = number_of(mcr_json_get(line, "wall"))};
    const struct mcr_json *image = mcr_json_get(line, "image");
    uint64_t spp = whole_of(mcr_json_get(line, "spp"));
    if (spp < 1 || spp > INT32_MAX || !image || image->kind != MCR_JSON_TEXT || image->length >= sizeof equal.image || strlen(image->text) != image->length)
        return 0;
    equal.spp = (uint32_t)spp;
    memcpy(equal.image, image->text, image->length + 1);
    read_metrics(mcr_json_get(line, "metrics"), equal.metric);
    return keep_equal(journal, key_of(mcr_json_get(line, "equal")), &equal);
}

/* Whether the bytes are a whole line of ours, without its line feed. */
static int is_whole(const char *line, size_t length)
{
    char check[CHECK_LENGTH + 1];
    if (length <= CHECK_LENGTH || length > LINE_LIMIT)
        return 0;
    snprintf(check, sizeof check, CHECK "%016llx\"}", (unsigned long long)hash_of(line, length - CHECK_LENGTH));
    return !memcmp(line + length - CHECK_LENGTH, check, CHECK_LENGTH);
}

struct line_reader {
    struct mcr_arena *arena;
    struct mcr_diagnostics *diagnostics;
    const struct mcr_json *json; /* NULL: not taken */
};

static void line_close(struct line_reader *reader)
{
    if (reader->diagnostics)
        mcr_diagnostics_destroy(reader->diagnostics);
    mcr_arena_destroy(reader->arena);
}

static void line_open(struct line_reader *reader, const char *line, size_t length)
{
    *reader = (struct line_reader){mcr_arena_create(LINE_LIMIT * 128), NULL, NULL};
    if (!is_whole(line, length) || !reader->arena || !(reader->diagnostics = mcr_diagnostics_create()))
        return;
    const struct mcr_source *source = mcr_diagnostics_source(reader->diagnostics, "journal", line, length, NULL);
    reader->json = source ? mcr_json_parse(reader->arena, reader->diagnostics, source) : NULL;
}

/* The first line. 0, or -1 with the reason. */
static int read_head(const struct mcr_json *line, struct mcr_journal_head *head, const char *folder, char *error, size_t length)
{
    const struct mcr_json *scene = mcr_json_get(line, "scene"), *started = mcr_json_get(line, "started");
    char text[400];
    if (whole_of(mcr_json_get(line, "mcrender_study_journal")) != FORMAT)
        return fail(error, length, folder, "it is of another version of mcrender, or no journal: give the study another folder");
    if (key_of(mcr_json_get(line, "content")) != head->content) {
        snprintf(text, sizeof text,
                 "its renders are of another scene ('%.100s' as it was then): give the study another folder with -o, or remove this one",
                 scene && scene->kind == MCR_JSON_TEXT ? scene->text : "");
        return fail(error, length, folder, text);
    }
    if (started && started->kind == MCR_JSON_TEXT)
        snprintf(head->started, sizeof head->started, "%.31s", started->text);
    return 0;
}

/* Takes all lines. *whole: bytes up to the end of the last whole line. 1 for an empty journal, 0, or -1 with the reason. */
static int read_lines(struct mcr_journal *journal, const char *bytes, size_t size, struct mcr_journal_head *head, const char *folder, char *error,
                      size_t length)
{
    int first = 1, status = 0;
    for (size_t at = 0; at < size && !status;) {
        const char *end = memchr(bytes + at, '\n', size - at);
        size_t count = end ? (size_t)(end - bytes) - at : size - at;
        struct line_reader line;
        line_open(&line, bytes + at, count);
        if (!line.json || !end) {
            /* A journal that was torn while it was made has nothing in it. */
            if (first && (end || strncmp(bytes, "{\"mcrender_study_journal\":", count < 26 ? count : 26)))
                status = fail(error, length, folder, "it is no journal of a study, or damaged at its start: give the study another folder");
            journal->dropped += !first;
        } else if (first) {
            status = read_head(line.json, head, folder, error, length);
            first = 0;
        } else if (mcr_json_get(line.json, "run") ? read_run(journal, line.json)
                   : mcr_json_get(line.json, "equal") ? read_equal(journal, line.json)
                                                      : (journal->dropped++, 0)) {
            status = fail(error, length, folder, "out of memory");
        }
        if (line.json && end)
            journal->size = (off_t)(at + count + 1);
        line_close(&line);
        at += count + 1;
    }
    return status ? status : first;
}

static char *read_all(int fd, off_t size)
{
    char *bytes = malloc((size_t)size + 1);
    size_t used = 0;
    while (bytes && used < (size_t)size) {
        ssize_t got = pread(fd, bytes + used, (size_t)size - used, (off_t)used);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0) {
            free(bytes);
            return NULL;
        }
        used += (size_t)got;
    }
    return bytes;
}

/* 1 for an empty journal, 0, or -1 with the reason. */
static int read_file(struct mcr_journal *journal, int fd, struct mcr_journal_head *head, const char *folder, char *error, size_t length)
{
    struct stat status;
    char *bytes;
    int result;
    if (fstat(fd, &status))
        return fail(error, length, folder, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return fail(error, length, folder, "it is no regular file");
    if (status.st_size > FILE_LIMIT)
        return fail(error, length, folder, "it is larger than 512 MiB");
    bytes = read_all(fd, status.st_size);
    if (!bytes)
        return fail(error, length, folder, "it cannot be read");
    result = read_lines(journal, bytes, (size_t)status.st_size, head, folder, error, length);
    free(bytes);
    return result;
}

/* ---- writing ---- */

static void put_number(struct mcr_text *text, const char *key, double number)
{
    char digits[MCR_JSON_NUMBER_SIZE];
    if (isfinite(number))
        mcr_json_format(number, digits);
    else
        snprintf(digits, sizeof digits, "\"%s\"", isnan(number) ? "nan" : number > 0 ? "inf" : "-inf");
    mcr_text_printf(text, "\"%s\":%s", key, digits);
}

static void put_metrics(struct mcr_text *text, const double metric[MCR_METRIC_COUNT])
{
    mcr_text_put(text, ",\"metrics\":{");
    for (int m = 0, n = 0; m < MCR_METRIC_COUNT; m++)
        if (!isnan(metric[m])) {
            mcr_text_put(text, n++ ? "," : "");
            put_number(text, mcr_metric_name[m], metric[m]);
        }
    mcr_text_put(text, "}");
}

/* Appends the line, which is ended here, and forgets it. */
static int append(struct mcr_journal *journal, struct mcr_text *text, char *error, size_t length)
{
    int reason = ENOMEM, done;
    size_t used = 0;
    mcr_text_printf(text, CHECK "%016llx\"}\n", (unsigned long long)hash_of(text->bytes ? text->bytes : "", text->used));
    if (!text->failed)
        reason = 0;
    while (!reason && used < text->used) {
        ssize_t put = pwrite(journal->fd, text->bytes + used, text->used - used, journal->size + (off_t)used);
        if (put > 0)
            used += (size_t)put;
        else if (put == 0 || errno != EINTR)
            reason = put == 0 ? EIO : errno;
    }
    if (!reason && fsync(journal->fd) && errno != EINVAL && errno != ENOTSUP)
        reason = errno;
    done = !reason;
    if (done)
        journal->size += (off_t)text->used;
    else if (ftruncate(journal->fd, journal->size))
        done = 0; /* what is torn is recognised by whoever reads it */
    mcr_text_fini(text);
    if (!done)
        snprintf(error, length, "the study's journal cannot be written: %s", strerror(reason));
    return done ? 0 : -1;
}

int mcr_journal_add_run(struct mcr_journal *journal, uint64_t cell, uint32_t index, const struct mcr_study_run *run, char *error, size_t length)
{
    struct mcr_text text = {0};
    mcr_text_printf(&text, "{\"run\":%u,\"cell\":\"%016llx\",\"order\":%llu,\"seed\":%llu,", index, (unsigned long long)cell,
                    (unsigned long long)run->order, (unsigned long long)run->seed);
    put_number(&text, "wall", run->wall_seconds);
    mcr_text_put(&text, ",");
    put_number(&text, "cpu", run->cpu_seconds);
    mcr_text_put(&text, ",");
    put_number(&text, "build", run->build_seconds);
    mcr_text_put(&text, ",");
    put_number(&text, "write", run->write_seconds);
    mcr_text_printf(&text, ",\"samples\":%llu,\"rays\":%llu,\"not_finite\":%llu", (unsigned long long)run->samples, (unsigned long long)run->rays,
                    (unsigned long long)run->not_finite);
    put_metrics(&text, run->metric);
    if (append(journal, &text, error, length))
        return -1;
    if (!keep_run(journal, cell, index, run))
        return 0;
    snprintf(error, length, "out of memory");
    return -1;
}

int mcr_journal_add_equal(struct mcr_journal *journal, uint64_t base, const struct mcr_journal_equal *equal, char *error, size_t length)
{
    struct mcr_text text = {0};
    mcr_text_printf(&text, "{\"equal\":\"%016llx\",\"cell\":\"%016llx\",\"spp\":%u,", (unsigned long long)base, (unsigned long long)equal->key, equal->spp);
    put_number(&text, "wall", equal->wall_seconds);
    put_metrics(&text, equal->metric);
    mcr_text_printf(&text, ",\"image\":\"%s\"", equal->image); /* made of letters, digits, '-', '.' and '/' */
    if (append(journal, &text, error, length))
        return -1;
    if (!keep_equal(journal, base, equal))
        return 0;
    snprintf(error, length, "out of memory");
    return -1;
}

/* A text within a line: what JSON would escape becomes '?'. */
static void plain(const char *from, char *to, size_t room)
{
    size_t i = 0;
    for (; from[i] && i + 1 < room; i++)
        to[i] = (unsigned char)from[i] < 0x20 || (unsigned char)from[i] > 0x7e || from[i] == '"' || from[i] == '\\' ? '?' : from[i];
    to[i] = '\0';
}

static int write_head(struct mcr_journal *journal, const struct mcr_journal_head *head, char *error, size_t length)
{
    struct mcr_text text = {0};
    char scene[200], started[32];
    plain(head->scene, scene, sizeof scene);
    plain(head->started, started, sizeof started);
    mcr_text_printf(&text, "{\"mcrender_study_journal\":%d,\"scene\":\"%s\",\"content\":\"%016llx\",\"started\":\"%s\"", FORMAT, scene,
                    (unsigned long long)head->content, started);
    journal->size = 0;
    return append(journal, &text, error, length);
}

/* ---- opening ---- */

static int open_in(const char *folder, int flags)
{
    int directory = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC), fd;
    if (directory < 0)
        return -1;
    fd = openat(directory, "journal.jsonl", flags | O_CLOEXEC | O_NONBLOCK, 0666);
    if (fd >= 0 && flags & O_CREAT)
        fsync(directory);
    close(directory);
    return fd;
}

/* Reads what is there, behind the lock, and cuts off what is torn. */
static int take(struct mcr_journal *journal, const char *folder, struct mcr_journal_head *head, char *error, size_t length)
{
    int empty;
    if (flock(journal->fd, LOCK_EX | LOCK_NB))
        return fail(error, length, folder, errno == EWOULDBLOCK ? "another process works in this folder" : strerror(errno));
    empty = read_file(journal, journal->fd, head, folder, error, length);
    if (empty < 0)
        return -1;
    if (ftruncate(journal->fd, empty ? 0 : journal->size))
        return fail(error, length, folder, strerror(errno));
    return empty ? write_head(journal, head, error, length) : 0;
}

struct mcr_journal *mcr_journal_open(const char *folder, struct mcr_journal_head *head, char *error, size_t length)
{
    struct mcr_journal *journal = calloc(1, sizeof *journal);
    if (!journal) {
        snprintf(error, length, "out of memory");
        return NULL;
    }
    journal->fd = open_in(folder, O_RDWR | O_CREAT | O_NOFOLLOW);
    if (journal->fd < 0)
        fail(error, length, folder, strerror(errno));
    if (journal->fd >= 0 && !take(journal, folder, head, error, length))
        return journal;
    mcr_journal_close(journal);
    return NULL;
}

struct mcr_journal *mcr_journal_look(const char *folder, struct mcr_journal_head *head, char *error, size_t length)
{
    struct mcr_journal *journal = calloc(1, sizeof *journal);
    int fd = journal ? open_in(folder, O_RDONLY) : -1, status = 0;
    if (!journal) {
        snprintf(error, length, "out of memory");
        return NULL;
    }
    journal->fd = -1;
    if (fd >= 0) {
        status = read_file(journal, fd, head, folder, error, length);
        close(fd);
    } else if (errno != ENOENT) {
        status = fail(error, length, folder, strerror(errno));
    }
    if (status >= 0)
        return journal;
    mcr_journal_close(journal);
    return NULL;
}

void mcr_journal_close(struct mcr_journal *journal)
{
    if (!journal)
        return;
    if (journal->fd >= 0)
        close(journal->fd);
    free(journal->entry);
    free(journal->equal);
    free(journal);
}

/* ---- asking ---- */

uint32_t mcr_journal_dropped(const struct mcr_journal *journal)
{
    return journal->dropped;
}

uint64_t mcr_journal_count(const struct mcr_journal *journal)
{
    return journal->count;
}

static int by_place(const void *a, const void *b)
{
    const struct entry *x = a, *y = b;
    if (x->cell != y->cell)
        return x->cell < y->cell ? -1 : 1;
    if (x->index != y->index)
        return x->index < y->index ? -1 : 1;
    return x->line < y->line ? -1 : x->line > y->line;
}

uint32_t mcr_journal_runs(const struct mcr_journal *journal, uint64_t cell, struct mcr_study_run *run, uint32_t room)
{
    struct mcr_journal *own = (struct mcr_journal *)journal; /* sorting changes nothing that can be asked */
    size_t low = 0, high = journal->count;
    uint32_t found = 0;
    if (!own->sorted && own->count)
        qsort(own->entry, own->count, sizeof *own->entry, by_place);
    own->sorted = 1;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (journal->entry[middle].cell < cell)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < journal->count && journal->entry[low].cell == cell && journal->entry[low].index <= found && found <= room; low++) {
        if (journal->entry[low].index == found && found == room)
            break;
        found += journal->entry[low].index == found;
        run[found - 1] = journal->entry[low].run; /* of two the later one */
    }
    return found;
}

const struct mcr_journal_equal *mcr_journal_equal(const struct mcr_journal *journal, uint64_t base)
{
    for (size_t i = journal->equal_count; i-- > 0;)
        if (journal->equal[i].base == base)
            return &journal->equal[i].equal;
    return NULL;
}
