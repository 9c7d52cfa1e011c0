/* SPDX-License-Identifier: Apache-2.0 */
/* Where a path leads when all links at its end are followed. */
#ifndef MCR_IMAGE_RESOLVE_H
#define MCR_IMAGE_RESOLVE_H

#include <limits.h>
#include <stddef.h>

struct mcr_resolved {
    int descriptor;       /* >= 0: an own descriptor, as /dev/stdout and /dev/fd/N are */
    int special;          /* another entry of /proc: to be opened as it is */
    char path[PATH_MAX];  /* of what is no link, or is absent */
    char folder[PATH_MAX];
    char name[256];       /* within folder; "" where the path ends in a slash */
};

/* Follows links; the last may dangle. Returns 0, or -1 with the reason. */
int mcr_path_resolve(const char *path, struct mcr_resolved *at, char *error, size_t length);

#endif
