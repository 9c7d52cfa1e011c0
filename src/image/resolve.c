/* SPDX-License-Identifier: Apache-2.0 */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "image/resolve.h"

#include "image/fail.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#define PROC_MAGIC 0x9fa0 /* PROC_SUPER_MAGIC of statfs(2) */
#define MAX_LINKS 40      /* as the kernel has it */

/* Splits at->path into folder and name. */
static int split(struct mcr_resolved *at, char *error, size_t length)
{
    const char *slash = strrchr(at->path, '/'), *name = slash ? slash + 1 : at->path;
    if (strlen(name) >= sizeof at->name) return mcr_image_fail(error, length, "%s", strerror(ENAMETOOLONG));
    strcpy(at->name, name);
    if (!slash) strcpy(at->folder, ".");
    else if (slash == at->path) strcpy(at->folder, "/");
    else snprintf(at->folder, sizeof at->folder, "%.*s", (int)(slash - at->path), at->path);
    return 0;
}

/* The number N where `folder` is this process's own list of descriptors and `name` an entry of it; else -1. */
static int own_descriptor(const char *folder, const char *name)
{
    char real[PATH_MAX], own[40], *end;
    snprintf(own, sizeof own, "/proc/%ld/", (long)getpid());
    size_t used = realpath(folder, real) ? strlen(real) : 0;
    if (used < 3 || strncmp(real, own, strlen(own)) || strcmp(real + used - 3, "/fd")) return -1;
    errno = 0;
    long number = strtol(name, &end, 10);
    return *name >= '0' && *name <= '9' && !*end && !errno && number <= INT_MAX ? (int)number : -1;
}

/* Replaces at->path by what the link there holds. Returns 1, 0 if there is no link, or -1 with the reason. */
static int follow(struct mcr_resolved *at, char *error, size_t length)
{
    char link[PATH_MAX], next[PATH_MAX];
    ssize_t count = readlink(at->path, link, sizeof link - 1);
    if (count < 0) return errno == EINVAL || errno == ENOENT ? 0 : mcr_image_fail(error, length, "%s", strerror(errno));
    link[count] = '\0';
    int needed = link[0] == '/' ? snprintf(next, sizeof next, "%s", link) : snprintf(next, sizeof next, "%s/%s", at->folder, link);
    if (needed < 0 || (size_t)needed >= sizeof next) return mcr_image_fail(error, length, "%s", strerror(ENAMETOOLONG));
    strcpy(at->path, next);
    return 1;
}

int mcr_path_resolve(const char *path, struct mcr_resolved *at, char *error, size_t length)
{
    at->descriptor = -1;
    at->special = 0;
    if (strlen(path) >= sizeof at->path) return mcr_image_fail(error, length, "%s", strerror(ENAMETOOLONG));
    strcpy(at->path, path);
    for (int links = 0; links <= MAX_LINKS; links++) {
        struct statfs system;
        struct stat status;
        if (split(at, error, length)) return -1;
        /* The links of /proc lead to open files, whatever their text says. */
        if (!statfs(at->folder, &system) && system.f_type == PROC_MAGIC && !lstat(at->path, &status) && S_ISLNK(status.st_mode)) {
            at->descriptor = own_descriptor(at->folder, at->name);
            at->special = at->descriptor < 0;
            return 0;
        }
        int followed = follow(at, error, length);
        if (followed <= 0) return followed;
    }
    return mcr_image_fail(error, length, "%s", strerror(ELOOP));
}
