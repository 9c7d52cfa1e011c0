/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Where images go. A regular or absent file is never half written: the bytes go to a temporary file in its folder, which takes its
 * name when all of them are on the disk. Devices, pipes and descriptors (/dev/stdout) are written directly: a rename over
 * /dev/full, as root, would replace the device.
 */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* O_PATH */
#endif
#include "image/encode.h"
#include "image/fail.h"
#include "image/format.h"
#include "image/image.h"
#include "image/module.h"
#include "image/pnm.h"
#include "image/sink.h"
#include "image/resolve.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

struct mcr_target {
    const struct mcr_format *format; /* NULL: for a text */
    char *shown;  /* as it was given, for messages */
    int direct;   /* the descriptor to write to, or -1: `name` in `folder` is replaced */
    int folder;   /* opened with O_PATH, so that a change of the current folder does not matter; or -1 */
    char *name;   /* NULL where direct */
};

/* What is written: an image, or a text. */
struct content {
    struct mcr_encoder *encoder; /* NULL for a text */
    const struct mcr_write_options *options;
    const char *text;
    size_t length;
};

#define TEMPORARY_NAME 256 /* NAME_MAX and the NUL */

/*
 * Creates a new file with a name of its own beside `name`, whose first 200 bytes it carries. Returns a descriptor or -1.
 * Hidden, so that it is not taken for a result if the machine stops before it is renamed.
 */
static int create_beside(int folder, const char *name, char temporary[TEMPORARY_NAME])
{
    static uint32_t serial;
    struct timespec now;
    for (int attempt = 0; attempt < 100; attempt++) {
        clock_gettime(CLOCK_REALTIME, &now);
        uint32_t mixed = (uint32_t)now.tv_nsec ^ ++serial << 20;
        snprintf(temporary, TEMPORARY_NAME, ".%.200s.%ld-%08lx.tmp", name, (long)getpid(), (unsigned long)mixed);
        int fd = openat(folder, temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666); /* less the umask */
        if (fd >= 0 || errno != EEXIST) return fd;
    }
    return -1;
}

/* Makes the target `name` in `folder`, a path. Proves that a file can be made there by making one. Returns 0, or -1 with the reason. */
static int open_replaced(struct mcr_target *target, const char *folder, const char *name, char *error, size_t length)
{
    char temporary[TEMPORARY_NAME];
    struct stat old;
    target->folder = open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (target->folder < 0) return mcr_image_fail(error, length, "its folder '%.150s': %s", folder, strerror(errno));
    if (!fstatat(target->folder, name, &old, AT_SYMLINK_NOFOLLOW)) {
        /* Renaming needs no right to write to the old file, but who took it away did not want it replaced. */
        if (faccessat(target->folder, name, W_OK, AT_EACCESS)) return mcr_image_fail(error, length, "%s", strerror(errno));
    } else if (errno != ENOENT) {
        return mcr_image_fail(error, length, "%s", strerror(errno));
    }
    int fd = create_beside(target->folder, name, temporary);
    if (fd < 0) return mcr_image_fail(error, length, "no file can be made in its folder '%.150s': %s", folder, strerror(errno));
    close(fd);
    unlinkat(target->folder, temporary, 0);
    target->name = strdup(name);
    return target->name ? 0 : mcr_image_fail(error, length, "not enough memory");
}

/* Writes to a copy of an own descriptor: the position, and O_APPEND, are those that the shell set. */
static int open_descriptor(struct mcr_target *target, int number, char *error, size_t length)
{
    int flags = fcntl(number, F_GETFL);
    if (flags < 0) return mcr_image_fail(error, length, "descriptor %d is not open", number);
    if ((flags & O_ACCMODE) == O_RDONLY) return mcr_image_fail(error, length, "descriptor %d is not open for writing", number);
    target->direct = fcntl(number, F_DUPFD_CLOEXEC, 3);
    return target->direct < 0 ? mcr_image_fail(error, length, "%s", strerror(errno)) : 0;
}

/* A FIFO waits here for its reader, who sees the end of the data even if rendering fails. */
static int open_special(struct mcr_target *target, const char *path, char *error, size_t length)
{
    do target->direct = open(path, O_WRONLY | O_CLOEXEC | O_NOCTTY);
    while (target->direct < 0 && errno == EINTR);
    return target->direct < 0 ? mcr_image_fail(error, length, "%s", strerror(errno)) : 0;
}

static int open_path(struct mcr_target *target, const char *path, char *error, size_t length)
{
    struct mcr_resolved at;
    struct stat status;
    if (mcr_path_resolve(path, &at, error, length)) return -1;
    if (at.descriptor >= 0) return open_descriptor(target, at.descriptor, error, length);
    if (at.special) return open_special(target, at.path, error, length);
    if (!lstat(at.path, &status)) {
        if (S_ISDIR(status.st_mode)) return mcr_image_fail(error, length, "it is a folder");
        if (!S_ISREG(status.st_mode)) return open_special(target, at.path, error, length);
    } else if (errno != ENOENT) {
        return mcr_image_fail(error, length, "%s", strerror(errno));
    }
    if (!*at.name) return mcr_image_fail(error, length, "it names a folder that does not exist");
    return open_replaced(target, at.folder, at.name, error, length);
}

static int open_standard_output(struct mcr_target *target, char *error, size_t length)
{
    if (target->format && isatty(STDOUT_FILENO)) return mcr_image_fail(error, length, "standard output is a terminal; name a file or redirect it");
    return open_descriptor(target, STDOUT_FILENO, error, length);
}

static struct mcr_target *target_open(const char *path, const struct mcr_format *format, char *error, size_t length)
{
    char reason[400] = "its name is empty";
    struct mcr_target *target = calloc(1, sizeof *target);
    if (target) target->direct = target->folder = -1, target->shown = strdup(path), target->format = format;
    int status = -1;
    if (!target || !target->shown) mcr_image_fail(reason, sizeof reason, "not enough memory");
    else if (!strcmp(path, "-")) status = open_standard_output(target, reason, sizeof reason);
    else if (*path) status = open_path(target, path, reason, sizeof reason);
    if (!status) return target;
    mcr_image_fail(error, length, "cannot write '%.200s': %s", path, reason);
    mcr_target_cancel(target);
    return NULL;
}

struct mcr_target *mcr_target_open(const char *path, char *error, size_t length)
{
    const struct mcr_format *format = mcr_format_of_path(path, error, length);
    return format ? target_open(path, format, error, length) : NULL;
}

struct mcr_target *mcr_target_open_text(const char *path, char *error, size_t length)
{
    return target_open(path, NULL, error, length);
}

/* The file that is there: of a descriptor, or of the name. Returns 0, or -1 without one. */
static int target_status(const struct mcr_target *target, struct stat *status)
{
    return target->name ? fstatat(target->folder, target->name, status, AT_SYMLINK_NOFOLLOW) : fstat(target->direct, status);
}

int mcr_target_same(const struct mcr_target *a, const struct mcr_target *b)
{
    struct stat of_a, of_b;
    if (a->name && b->name) /* two names of one file are replaced one by one */
        return !strcmp(a->name, b->name) && !fstat(a->folder, &of_a) && !fstat(b->folder, &of_b) && of_a.st_dev == of_b.st_dev &&
               of_a.st_ino == of_b.st_ino;
    return !target_status(a, &of_a) && !target_status(b, &of_b) && of_a.st_dev == of_b.st_dev && of_a.st_ino == of_b.st_ino &&
           !S_ISCHR(of_a.st_mode);
}

int mcr_target_is_input(const char *path, const char *input)
{
    struct stat out, in;
    int there = input && !(strcmp(input, "-") ? stat(input, &in) : fstat(STDIN_FILENO, &in));
    return there && S_ISREG(in.st_mode) && !stat(path, &out) && out.st_dev == in.st_dev && out.st_ino == in.st_ino;
}

void mcr_target_cancel(struct mcr_target *target)
{
    if (!target) return;
    if (target->direct >= 0) close(target->direct);
    if (target->folder >= 0) close(target->folder);
    free(target->name);
    free(target->shown);
    free(target);
}

/* Writes everything into a descriptor and brings it to the disk. Returns 0, or -1 with the reason. */
static int put(const struct mcr_target *target, int fd, const struct content *content, char *error, size_t length)
{
    struct mcr_sink *sink = malloc(sizeof *sink);
    if (!sink) return mcr_image_fail(error, length, "not enough memory");
    mcr_sink_init(sink, fd);
    error[0] = '\0';
    int status = !content->encoder         ? mcr_sink_put(sink, content->text, content->length)
                 : target->format->module ? mcr_module_write(target->format, content->encoder, content->options, sink, error, length)
                                          : mcr_pnm_write(content->encoder, sink);
    if (!status) status = mcr_sink_flush(sink);
    if (!status && fsync(fd) && errno != EINVAL && errno != ENOTSUP && errno != EROFS) { /* pipes know no fsync */
        sink->error = errno;
        status = -1;
    }
    if (sink->error) mcr_image_fail(error, length, "%s", strerror(sink->error));
    free(sink);
    return status;
}

/* Gives the new file the owner, as far as that is allowed, and the permissions of the one that it replaces. */
static int take_over(int fd, const struct stat *old, char *error, size_t length)
{
    if (fchown(fd, old->st_uid, old->st_gid) && fchown(fd, (uid_t)-1, old->st_gid)) errno = 0; /* only root may: then it is ours */
    return fchmod(fd, old->st_mode & 0777) ? mcr_image_fail(error, length, "%s", strerror(errno)) : 0;
}

static int replace(const struct mcr_target *target, const struct content *content, char *error, size_t length)
{
    char temporary[TEMPORARY_NAME];
    struct stat old;
    int exists = !fstatat(target->folder, target->name, &old, AT_SYMLINK_NOFOLLOW);
    if (exists && !S_ISREG(old.st_mode)) return mcr_image_fail(error, length, "it is no longer a regular file");
    int fd = create_beside(target->folder, target->name, temporary);
    if (fd < 0) return mcr_image_fail(error, length, "%s", strerror(errno));
    int status = exists ? take_over(fd, &old, error, length) : 0;
    if (!status) status = put(target, fd, content, error, length);
    if (close(fd) && !status) status = mcr_image_fail(error, length, "%s", strerror(errno));
    if (!status && renameat(target->folder, temporary, target->folder, target->name))
        status = mcr_image_fail(error, length, "%s", strerror(errno));
    if (status) unlinkat(target->folder, temporary, 0);
    return status;
}

static int write_direct(struct mcr_target *target, const struct content *content, char *error, size_t length)
{
    int status = put(target, target->direct, content, error, length);
    if (close(target->direct) && !status) status = mcr_image_fail(error, length, "%s", strerror(errno));
    target->direct = -1;
    return status;
}

static int check_options(const struct mcr_write_options *options, char *error, size_t length)
{
    if (options->bits != 0 && options->bits != 8 && options->bits != 16)
        return mcr_image_fail(error, length, "%u bits, expected 8 or 16", options->bits);
    if (!(fabs(options->exposure) <= 128))
        return mcr_image_fail(error, length, "exposure %g, expected -128 to 128 stops", options->exposure);
    if (options->tone.curve >= MCR_TONE_COUNT) return mcr_image_fail(error, length, "no such tone curve");
    if ((options->tone.curve == MCR_TONE_REINHARD || options->tone.curve == MCR_TONE_HABLE) && 
        !(options->tone.white >= MCR_TONE_LEAST_WHITE && options->tone.white <= MCR_TONE_MOST_WHITE))
        return mcr_image_fail(error, length, "tone curve with white %g, expected %g to %g", options->tone.white, MCR_TONE_LEAST_WHITE, MCR_TONE_MOST_WHITE);
    return 0;
}

static int target_write(struct mcr_target *target, const struct content *content, char *error, size_t length)
{
    return target->name ? replace(target, content, error, length) : write_direct(target, content, error, length);
}

static int check_size(const struct mcr_target *target, uint32_t width, uint32_t height, char *reason, size_t length)
{
    uint32_t most = target->format ? target->format->most : 0;
    if (!most || (width <= most && height <= most)) return 0;
    return mcr_image_fail(reason, length, "%u x %u is more than .%s holds, %u x %u", width, height, target->format->extension, most, most), -1;
}

int mcr_target_check_size(const struct mcr_target *target, uint32_t width, uint32_t height, char *error, size_t length)
{
    char reason[300];
    if (!check_size(target, width, height, reason, sizeof reason)) return 0;
    return mcr_image_fail(error, length, "cannot write '%.200s': %s", target->shown, reason), -1;
}

int mcr_target_write(struct mcr_target *target, const struct mcr_image *image, const struct mcr_write_options *options,
                     struct mcr_write_result *result)
{
    char reason[300] = "";
    struct mcr_encoder encoder;
    struct content content = {.encoder = &encoder, .options = options};
    memset(result, 0, sizeof *result);
    int status = check_options(options, reason, sizeof reason);
    if (!status) status = check_size(target, image->width, image->height, reason, sizeof reason);
    if (!status) {
        mcr_encoder_init(&encoder, image, target->format, options->bits, options->exposure);
        encoder.tone = options->tone;
        status = target_write(target, &content, reason, sizeof reason);
        result->overflowed = encoder.overflowed;
        result->not_finite = encoder.not_finite;
    }
    if (status) mcr_image_fail(result->error, sizeof result->error, "cannot write '%.200s': %s", target->shown, reason);
    mcr_target_cancel(target);
    return status ? -1 : 0;
}

int mcr_target_write_text(struct mcr_target *target, const char *text, size_t bytes, char *error, size_t length)
{
    char reason[300] = "";
    int status = target_write(target, &(struct content){.text = text, .length = bytes}, reason, sizeof reason);
    if (status) mcr_image_fail(error, length, "cannot write '%.200s': %s", target->shown, reason);
    mcr_target_cancel(target);
    return status ? -1 : 0;
}
