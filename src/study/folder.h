/* SPDX-License-Identifier: Apache-2.0 */
/* A study's folder. */
#ifndef MCR_STUDY_FOLDER_H
#define MCR_STUDY_FOLDER_H

#include <stddef.h>

/*
 * Makes the folder where it is absent; its own parent must exist. Refuses a folder without a journal that has files of a study's names: they are
 * somebody's. 0, or -1 with the reason.
 */
int mcr_folder_make(const char *folder, char *error, size_t length);
/* Makes state/ and images/ in it: after the journal, so that a folder with them has one. */
int mcr_folder_fill(const char *folder, char *error, size_t length);
/* Removes the temporary files that an interrupted process left there (the journal is locked: nobody else is at work). */
void mcr_folder_tidy(const char *folder);
/* 1 if the path, relative to the folder, is a regular file. */
int mcr_folder_has(const char *folder, const char *name);

#endif
