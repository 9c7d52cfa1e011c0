/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Preloaded into mcrender by crash.sh: at call number MCR_CRASH_AT (from 1) of the functions by which a study keeps its state, counted over all of
 * them, the process is killed before the call, or after half of a write. With MCR_FULL_AT the call fails instead as on a full disk, and all that
 * follow. MCR_CRASH_COUNT names a file that gets the number of calls at the end.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static long calls;

static long asked(const char *name)
{
    const char *text = getenv(name);
    return text ? atol(text) : 0;
}

/* 1 if this call is to fail. */
static int step(int *killed)
{
    long full = asked("MCR_FULL_AT");
    *killed = ++calls == asked("MCR_CRASH_AT");
    if (full && calls >= full) {
        errno = ENOSPC;
        return 1;
    }
    return 0;
}

static void die(void)
{
    kill(getpid(), SIGKILL);
}

int fsync(int fd)
{
    static int (*next)(int);
    int killed;
    if (!next)
        next = (int (*)(int))dlsym(RTLD_NEXT, "fsync");
    if (step(&killed))
        return -1;
    if (killed)
        die();
    return next(fd);
}

int renameat(int from, const char *old, int to, const char *new)
{
    static int (*next)(int, const char *, int, const char *);
    int killed;
    if (!next)
        next = (int (*)(int, const char *, int, const char *))dlsym(RTLD_NEXT, "renameat");
    if (step(&killed))
        return -1;
    if (killed)
        die();
    return next(from, old, to, new);
}

ssize_t pwrite64(int fd, const void *bytes, size_t count, off64_t at);
static ssize_t half_write(int fd, const void *bytes, size_t count, off64_t at)
{
    static ssize_t (*next)(int, const void *, size_t, off64_t);
    int killed;
    if (!next)
        next = (ssize_t(*)(int, const void *, size_t, off64_t))dlsym(RTLD_NEXT, "pwrite64");
    if (step(&killed)) {
        next(fd, bytes, count / 2, at);
        errno = ENOSPC;
        return -1;
    }
    if (killed) {
        next(fd, bytes, count / 2, at);
        die();
    }
    return next(fd, bytes, count, at);
}

ssize_t pwrite64(int fd, const void *bytes, size_t count, off64_t at)
{
    return half_write(fd, bytes, count, at);
}

ssize_t pwrite(int fd, const void *bytes, size_t count, off_t at)
{
    return half_write(fd, bytes, count, at);
}

static void __attribute__((destructor)) tell(void)
{
    const char *path = getenv("MCR_CRASH_COUNT");
    FILE *to = path ? fopen(path, "w") : NULL;
    if (to) {
        fprintf(to, "%ld\n", calls);
        fclose(to);
    }
}
