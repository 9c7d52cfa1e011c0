/* SPDX-License-Identifier: Apache-2.0 */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "study/folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int at_folder(const char *folder)
{
    return open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

int mcr_folder_has(const char *folder, const char *name)
{
    int directory = at_folder(folder), found;
    struct stat status;
    if (directory < 0)
        return 0;
    found = !fstatat(directory, name, &status, 0) && S_ISREG(status.st_mode);
    close(directory);
    return found;
}

static int fail(char *error, size_t length, const char *folder, const char *name, const char *reason)
{
    snprintf(error, length, "the study's folder '%.200s%s%s': %s", folder, *name ? "/" : "", name, reason);
    return -1;
}

int mcr_folder_make(const char *folder, char *error, size_t length)
{
    static const char *const ours[] = {"study.json", "study.csv", "report.html", "images", "state"};
    int made = !mkdir(folder, 0777), directory, status = 0;
    struct stat unused;
    if (!made && errno != EEXIST)
        return fail(error, length, folder, "", strerror(errno));
    directory = at_folder(folder);
    if (directory < 0)
        return fail(error, length, folder, "", strerror(errno));
    if (!made && fstatat(directory, "journal.jsonl", &unused, AT_SYMLINK_NOFOLLOW))
        for (size_t i = 0; i < sizeof ours / sizeof *ours && !status; i++)
            if (!fstatat(directory, ours[i], &unused, AT_SYMLINK_NOFOLLOW))
                status = fail(error, length, folder, ours[i], "it is there, but no journal of a study: give the study another folder");
    close(directory);
    return status;
}

int mcr_folder_fill(const char *folder, char *error, size_t length)
{
    static const char *const inner[] = {"images", "state"};
    int directory = at_folder(folder), status = 0;
    if (directory < 0)
        return fail(error, length, folder, "", strerror(errno));
    for (size_t i = 0; i < sizeof inner / sizeof *inner && !status; i++)
        if (mkdirat(directory, inner[i], 0777) && errno != EEXIST)
            status = fail(error, length, folder, inner[i], strerror(errno));
    close(directory);
    return status;
}

/* As src/image/target.c names them: .NAME.PID-XXXXXXXX.tmp; all: whatever the name. */
static int is_temporary(const char *name, int all)
{
    size_t length = strlen(name);
    return length > 4 && name[0] == '.' && !strcmp(name + length - 4, ".tmp") &&
           (all || !strncmp(name, ".study.", 7) || !strncmp(name, ".report.html.", 13));
}

static void tidy(int directory, int all)
{
    DIR *list = directory < 0 ? NULL : fdopendir(directory);
    const struct dirent *entry;
    if (!list) {
        if (directory >= 0)
            close(directory);
        return;
    }
    while ((entry = readdir(list)))
        if (is_temporary(entry->d_name, all))
            unlinkat(directory, entry->d_name, 0);
    closedir(list);
}

void mcr_folder_tidy(const char *folder)
{
    int directory = at_folder(folder);
    if (directory < 0)
        return;
    tidy(openat(directory, "state", O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW), 1);
    tidy(openat(directory, "images", O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW), 1);
    tidy(directory, 0); /* closes it */
}
