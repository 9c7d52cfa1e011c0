/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Arrays of doubles that outlive the process, in FOLDER/state/: all their bits, a header that says what they are of, and a checksum over both.
 * Replaced whole: beside, synced, renamed. In this machine's byte order; another's are damaged to us.
 */
#ifndef MCR_STUDY_STATE_H
#define MCR_STUDY_STATE_H

#include <stddef.h>
#include <stdint.h>

struct mcr_state {
    uint64_t key;                   /* whose it is */
    uint64_t count;                 /* of what was added */
    uint64_t mark;                  /* the writer's */
    double seconds;                 /* the writer's */
    uint32_t width, height, planes;
    double *data;                   /* width * height * planes; owned */
};

/* Zeroed data. 0, or -1 when memory is short. */
int mcr_state_init(struct mcr_state *state, uint64_t key, uint32_t width, uint32_t height, uint32_t planes);
void mcr_state_fini(struct mcr_state *state);
/* Fills a state of the same key and size from state/NAME. 0; 1: there is none; -1: damaged, another's, or not readable. It is as it was then. */
int mcr_state_read(struct mcr_state *state, const char *folder, const char *name);
/* 0, or -1 with the reason; the old file is untouched then. */
int mcr_state_write(const struct mcr_state *state, const char *folder, const char *name, char *error, size_t length);

void mcr_state_remove(const char *folder, const char *name);

/* Of count doubles, by their bits. */
uint64_t mcr_state_hash(uint64_t start, const double *data, size_t count);

#endif
