/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The journal of a study's folder, journal.jsonl: one line of JSON a finished render, appended and brought to the disk before the next begins.
 * Each line ends in `,"check":"HASH"}`, FNV-1a 64 of all before it: a line that a crash has torn, or that was edited, is not taken. The first line
 * tells the scene. Lines of cells that the study no longer has stay, and are found again when it has them again. The file is locked while it is open
 * for writing.
 */
#ifndef MCR_STUDY_JOURNAL_H
#define MCR_STUDY_JOURNAL_H

#include "study/study.h"

struct mcr_journal;

/* One render at equal time. */
struct mcr_journal_equal {
    uint64_t key;    /* of the cell that it would be */
    uint32_t spp;
    double wall_seconds;
    double metric[MCR_METRIC_COUNT];
    char image[256]; /* relative to the folder */
};

struct mcr_journal_head {
    const char *scene;       /* its name, for people */
    uint64_t content;        /* mcr_study_content */
    char started[32];        /* in: for a new journal; out: what the journal has */
};

/*
 * Opens the journal in `folder`, which exists, for writing, or makes a new one. NULL with the reason: a journal of another scene, one that another
 * process works with, a file that is no journal.
 */
struct mcr_journal *mcr_journal_open(const char *folder, struct mcr_journal_head *head, char *error, size_t length);
/* Reads without a lock and without a change; a folder or journal that does not exist is an empty one. */
struct mcr_journal *mcr_journal_look(const char *folder, struct mcr_journal_head *head, char *error, size_t length);
void mcr_journal_close(struct mcr_journal *journal);

/* Lines that were not taken: torn, edited, of an unknown kind. */
uint32_t mcr_journal_dropped(const struct mcr_journal *journal);
/* Runs that are journalled, whatever their cell: the order of the next. */
uint64_t mcr_journal_count(const struct mcr_journal *journal);

/* The finished runs 0, 1, 2 ... of a cell without a gap, at most `room`. Returns how many. */
uint32_t mcr_journal_runs(const struct mcr_journal *journal, uint64_t cell, struct mcr_study_run *run, uint32_t room);
/* The latest render at equal time of the series with this base key, or NULL. */
const struct mcr_journal_equal *mcr_journal_equal(const struct mcr_journal *journal, uint64_t base);

/* Append, with fsync. 0, or -1 with the reason: the journal is as it was before. */
int mcr_journal_add_run(struct mcr_journal *journal, uint64_t cell, uint32_t index, const struct mcr_study_run *run, char *error, size_t length);
int mcr_journal_add_equal(struct mcr_journal *journal, uint64_t base, const struct mcr_journal_equal *equal, char *error, size_t length);

#endif
