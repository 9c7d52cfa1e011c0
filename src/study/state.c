/* SPDX-License-Identifier: Apache-2.0 */
#include "study/state.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/random.h"
#include "image/image.h"

struct header {
    char magic[8];
    uint64_t order; /* of bytes */
    uint64_t key, count, mark;
    double seconds;
    uint32_t width, height, planes, zero;
    uint64_t check; /* of all before it, and of the data */
};

static const char magic[8] = {'M', 'C', 'R', 'S', 'T', 'A', 'T', '1'};
#define ORDER UINT64_C(0x0102030405060708)

uint64_t mcr_state_hash(uint64_t start, const double *data, size_t count)
{
    uint64_t hash = start, bits;
    for (size_t i = 0; i < count; i++) {
        memcpy(&bits, &data[i], sizeof bits);
        hash = mcr_mix64(hash ^ bits) + MCR_GOLDEN;
    }
    return hash;
}

static size_t values(const struct mcr_state *state)
{
    return (size_t)state->width * state->height * state->planes;
}

static struct header header_of(const struct mcr_state *state)
{
    struct header header;
    double bytes[offsetof(struct header, check) / sizeof(double)];
    memset(&header, 0, sizeof header);
    memcpy(header.magic, magic, sizeof magic);
    header.order = ORDER;
    header.key = state->key;
    header.count = state->count;
    header.mark = state->mark;
    header.seconds = state->seconds;
    header.width = state->width;
    header.height = state->height;
    header.planes = state->planes;
    memcpy(bytes, &header, sizeof bytes);
    header.check = mcr_state_hash(mcr_state_hash(0, bytes, sizeof bytes / sizeof *bytes), state->data, values(state));
    return header;
}

int mcr_state_init(struct mcr_state *state, uint64_t key, uint32_t width, uint32_t height, uint32_t planes)
{
    size_t pixels, count;
    memset(state, 0, sizeof *state);
    if (!mcr_size_mul(width, height, &pixels) || !mcr_size_mul(pixels, planes, &count))
        return -1;
    *state = (struct mcr_state){.key = key, .width = width, .height = height, .planes = planes};
    state->data = mcr_array_alloc(count, sizeof(double));
    return state->data ? 0 : -1;
}

void mcr_state_fini(struct mcr_state *state)
{
    free(state->data);
    state->data = NULL;
}

static int path_of(char *path, size_t room, const char *folder, const char *name)
{
    return snprintf(path, room, "%s/state/%s", folder, name) < (int)room ? 0 : -1;
}

static int read_bytes(int fd, void *to, size_t count)
{
    char *at = to;
    while (count) {
        ssize_t got = read(fd, at, count);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return -1;
        at += got;
        count -= (size_t)got;
    }
    return 0;
}

/* The file is as long as it must be, and of what it should be, before anything is read into memory of that size. */
static int read_state(struct mcr_state *state, int fd)
{
    struct header header, expected;
    struct mcr_state found = *state;
    struct stat status;
    size_t bytes = values(state) * sizeof(double);
    if (fstat(fd, &status) || !S_ISREG(status.st_mode) || status.st_size < 0 || (uint64_t)status.st_size != sizeof header + bytes ||
        read_bytes(fd, &header, sizeof header))
        return -1;
    if (memcmp(header.magic, magic, sizeof magic) || header.order != ORDER || header.key != state->key || header.width != state->width ||
        header.height != state->height || header.planes != state->planes)
        return -1;
    if (mcr_state_init(&found, state->key, state->width, state->height, state->planes))
        return -1;
    found.count = header.count;
    found.mark = header.mark;
    found.seconds = header.seconds;
    if (!read_bytes(fd, found.data, bytes)) {
        expected = header_of(&found);
        if (!memcmp(&expected, &header, sizeof header)) {
            mcr_state_fini(state);
            *state = found;
            return 0;
        }
    }
    mcr_state_fini(&found);
    return -1;
}

int mcr_state_read(struct mcr_state *state, const char *folder, const char *name)
{
    char path[PATH_MAX];
    int fd, status;
    if (path_of(path, sizeof path, folder, name))
        return -1;
    fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        return errno == ENOENT ? 1 : -1;
    status = read_state(state, fd);
    close(fd);
    return status;
}

int mcr_state_write(const struct mcr_state *state, const char *folder, const char *name, char *error, size_t length)
{
    struct header header = header_of(state);
    size_t bytes = values(state) * sizeof(double);
    char path[PATH_MAX], *whole = malloc(sizeof header + bytes);
    struct mcr_target *target;
    int status = -1;
    if (!whole || path_of(path, sizeof path, folder, name)) {
        snprintf(error, length, whole ? "the folder's name is too long" : "out of memory");
        free(whole);
        return -1;
    }
    memcpy(whole, &header, sizeof header);
    memcpy(whole + sizeof header, state->data, bytes);
    target = mcr_target_open_text(path, error, length);
    if (target)
        status = mcr_target_write_text(target, whole, sizeof header + bytes, error, length);
    free(whole);
    return status;
}

void mcr_state_remove(const char *folder, const char *name)
{
    char path[PATH_MAX];
    if (!path_of(path, sizeof path, folder, name))
        unlink(path);
}
