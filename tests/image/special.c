/* SPDX-License-Identifier: Apache-2.0 */
/* Targets that are no files: devices, pipes, descriptors; and disks that are full. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "help.h"

#include <errno.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>

static struct mcr_image *small, *large; /* 17 bytes of PPM; 300 kB */
static const unsigned char expected[] = "P6\n2 1\n255\n\xff\x00\xff\x00\x00\x00";
static struct mcr_write_result result;

static int is_device(const char *path)
{
    struct stat status;
    return !lstat(path, &status) && S_ISCHR(status.st_mode);
}

static void devices(void)
{
    ok(!put("/dev/null", large, 0, 0, &result) && is_device("/dev/null"), "/dev/null takes an image and stays a device %s", result.error);
    ok(put("/dev/full", small, 0, 0, &result) == -1 && strstr(result.error, strerror(ENOSPC)) && is_device("/dev/full"), "%s", result.error);
    ok(put("/dev/full", large, 0, 0, &result) == -1 && strstr(result.error, strerror(ENOSPC)) && is_device("/dev/full"),
       "and with more than a buffer");
    if (symlink("/dev/full", in_folder("full.pfm"))) perror("symlink");
    ok(put(in_folder("full.pfm"), small, 0, 0, &result) == -1 && strstr(result.error, "full.pfm': No space left") &&
       is_device("/dev/full"), "through a link, too");
}

/* Runs in a child with a standard output of its own; returns its status. */
static int with_output(int fd, int (*body)(void))
{
    int status = -1;
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        if (fd < 0) close(STDOUT_FILENO);
        else dup2(fd, STDOUT_FILENO);
        _exit(body());
    }
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 99;
}

static int to_dash(void) { return put("-", small, 0, 0, &result) ? 1 : 0; }
static int to_dev_stdout(void) { return put("/dev/stdout", small, 0, 0, &result) ? 1 : 0; }
static int to_link(void) { return put(in_folder("out.ppm"), small, 0, 0, &result) ? 1 : 0; }
static int large_to_dash(void) { return put("-", large, 0, 0, &result) && strstr(result.error, strerror(EPIPE)) ? 0 : 1; }
static int dash_unusable(void) { return put("-", small, 0, 0, &result) && strstr(result.error, "descriptor 1 is not open") ? 0 : 1; }
static int dash_terminal(void) { return put("-", small, 0, 0, &result) && strstr(result.error, "is a terminal") ? 0 : 1; }

static void descriptors(void)
{
    static int (*const ways[])(void) = {to_dash, to_dev_stdout, to_link};
    static const char *const names[] = {"-", "/dev/stdout", "a link to /dev/stdout"};
    if (symlink("/dev/stdout", in_folder("out.ppm"))) perror("symlink");
    for (int i = 0; i < 3; i++) {
        int fd = open(in_folder("stream"), O_RDWR | O_CREAT | O_TRUNC, 0666);
        if (write(fd, "before", 6) != 6) perror("write");
        ok(!with_output(fd, ways[i]), "%s, standard output being a file", names[i]);
        ok(lseek(fd, 0, SEEK_CUR) == 6 + (off_t)sizeof expected - 1, "what stood there stays and the position goes on");
        close(fd);
        size_t count = 0;
        unsigned char *bytes = slurp(in_folder("stream"), &count);
        ok(count == 6 + sizeof expected - 1 && !memcmp(bytes, "before", 6) && !memcmp(bytes + 6, expected, sizeof expected - 1),
           "the bytes are right");
        free(bytes);
        int ends[2];
        char got[64];
        if (pipe(ends)) perror("pipe");
        int failed = with_output(ends[1], ways[i]);
        close(ends[1]);
        ok(!failed && read(ends[0], got, sizeof got) == (ssize_t)sizeof expected - 1 && !memcmp(got, expected, sizeof expected - 1),
           "and a pipe");
        close(ends[0]);
    }
    int ends[2];
    if (pipe(ends)) perror("pipe");
    close(ends[0]);
    ok(!with_output(ends[1], large_to_dash), "a pipe whose reader has gone is an error and not the end of the program");
    close(ends[1]);
    ok(!with_output(-1, dash_unusable), "a closed standard output is refused");
    int reading = open("/dev/null", O_RDONLY);
    ok(!with_output(reading, dash_unusable), "one that is open for reading only, too");
    close(reading);
    int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    const char *name = terminal >= 0 && !grantpt(terminal) && !unlockpt(terminal) ? ptsname(terminal) : NULL;
    int side = name ? open(name, O_RDWR | O_NOCTTY) : -1;
    if (side < 0) tap_skip("no image to a terminal", "no pseudo-terminal here");
    else ok(!with_output(side, dash_terminal), "no image to a terminal");
    if (side >= 0) close(side);
    if (terminal >= 0) close(terminal);
    ok(put("/dev/fd/987", small, 0, 0, &result) == -1, "%s", result.error);
}

static void fifos(void)
{
    int status = -1;
    mkfifo(in_folder("fifo.ppm"), 0666);
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        size_t count = 0;
        unsigned char *bytes = slurp(in_folder("fifo.ppm"), &count);
        _exit(bytes && count == sizeof expected - 1 && !memcmp(bytes, expected, count) ? 0 : 1);
    }
    int written = put(in_folder("fifo.ppm"), small, 0, 0, &result);
    waitpid(child, &status, 0);
    struct stat entry;
    ok(!written && status == 0 && !lstat(in_folder("fifo.ppm"), &entry) && S_ISFIFO(entry.st_mode),
       "a FIFO is written to and stays one %s", result.error);

    fflush(stdout);
    child = fork();
    if (child == 0) {
        int fd = open(in_folder("fifo.ppm"), O_RDONLY);
        char byte;
        _exit(fd >= 0 && read(fd, &byte, 1) == 1 ? 0 : 1);
    }
    ok(put(in_folder("fifo.ppm"), large, 0, 0, &result) == -1 && strstr(result.error, strerror(EPIPE)), "%s", result.error);
    waitpid(child, &status, 0);
}

/* What a full disk leaves: an error, the old file, nothing else. In a child, whose limits are its own. Returns bits of what was right. */
static int full_disk(const char *reason, const char *place)
{
    char old[600], new[600];
    snprintf(old, sizeof old, "%s/old.ppm", place);
    snprintf(new, sizeof new, "%s/new.pfm", place);
    spill(old, "old", 3);
    int before = entries(place), right = 0;
    right |= put(old, large, 0, 0, &result) == -1 && strstr(result.error, reason);
    right |= (put(new, large, 0, 0, &result) == -1 && strstr(result.error, reason)) << 1;
    right |= (file_is(old, "old", 3) && entries(place) == before) << 2;
    right |= (!put(old, small, 0, 0, &result) && file_is(old, expected, sizeof expected - 1)) << 3;
    return right;
}

static int limited(void)
{
    struct rlimit limit = {100000, 100000};
    setrlimit(RLIMIT_FSIZE, &limit);
    return full_disk(strerror(EFBIG), in_folder("disk"));
}

/* Says in /proc who this process is in its own name space of users. */
static int map(const char *path, unsigned id)
{
    FILE *file = fopen(path, "w");
    if (!file) return -1;
    fprintf(file, "%u %u 1\n", id, id);
    return fclose(file);
}

/* A file system of 64 kB, in name spaces of this child's own. */
static int tiny(void)
{
    unsigned user = getuid(), group = getgid();
    if (unshare(CLONE_NEWNS)) {
        if (unshare(CLONE_NEWUSER | CLONE_NEWNS)) return 77;
        FILE *file = fopen("/proc/self/setgroups", "w");
        if (file && (fputs("deny", file), fclose(file))) return 77;
        if (map("/proc/self/uid_map", user) || map("/proc/self/gid_map", group)) return 77;
    }
    if (mount(NULL, "/", NULL, MS_REC | MS_PRIVATE, NULL) ||
        mount("tiny", in_folder("disk"), "tmpfs", 0, "size=64k")) return 77;
    return full_disk(strerror(ENOSPC), in_folder("disk"));
}

static void full_disks(const char *what, int (*body)(void))
{
    static const char *const parts[] = {"replacing a file is an error", "and so is making one", "the old file is there and nothing else",
                                        "what has room is written"};
    int out = open("/dev/null", O_WRONLY), right = with_output(out, body);
    close(out);
    for (int i = 0; i < 4; i++) {
        if (right == 77) tap_skip(what, "no name space of its own allowed");
        else ok(right >> i & 1, "%s: %s", what, parts[i]);
    }
}

int main(void)
{
    static const double values[] = {1, 0, 1, 0, 0, 0};
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    enter_folder();
    mkdir(in_folder("disk"), 0777);
    small = image_of(2, 1, 3, rgb, values);
    large = mcr_image_create(320, 320, 3, rgb);
    devices();
    descriptors();
    fifos();
    full_disks("a limit of the file size", limited);
    full_disks("a disk of 64 kB", tiny);
    mcr_image_destroy(small);
    mcr_image_destroy(large);
    leave_folder();
    return tap_done();
}
