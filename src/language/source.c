/* SPDX-License-Identifier: Apache-2.0 */
/* Files -> text. What is read is bounded before it is read, whatever the file is: a pipe, a device, a file that grows. */
#include "language/internal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

void mcr_hash(struct mcr_parser *parser, const char *bytes, size_t length)
{
    uint64_t hash = parser->hash;
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)bytes[i]) * 1099511628211u;
    parser->hash = hash;
}

const struct mcr_source *mcr_source_add(struct mcr_parser *parser, const char *name, const char *text, size_t length, const struct mcr_place *place)
{
    const struct mcr_source *source = NULL;
    if (length > MCR_SOURCE_LIMIT - parser->total) {
        mcr_report(parser->diagnostics, MCR_ERROR, place ? *place : (struct mcr_place){ 0 }, "'%s' is too long, scenes have at most %u MiB of text",
                   name, MCR_SOURCE_LIMIT >> 20);
        return NULL;
    }
    parser->total += length;
    source = mcr_diagnostics_source(parser->diagnostics, name, text, length, place);
    if (!source)
        mcr_fatal(parser);
    return source;
}

/* All of the file, at most one byte more than may be; NULL with errno set. */
static char *slurp(int file, size_t expected, size_t limit, size_t *length)
{
    size_t room = expected < limit ? expected + 1 : limit + 1;
    char *text;

    room = room < 4096 ? 4096 : room;
    text = malloc(room);
    for (*length = 0; text && *length <= limit;) {
        ssize_t got;
        if (*length == room) {
            char *larger = realloc(text, room * 2);
            if (!larger)
                break;
            text = larger;
            room *= 2;
        }
        got = read(file, text + *length, room - *length);
        if (got == 0)
            return text;
        if (got > 0)
            *length += (size_t)got;
        else if (errno != EINTR)
            break;
    }
    if (text && *length > limit)
        return text;
    free(text);
    return NULL;
}

const struct mcr_source *mcr_source_read(struct mcr_parser *parser, const char *path, struct mcr_file *file, struct mcr_place place)
{
    int is_standard = !place.source && strcmp(path, "-") == 0, descriptor = is_standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
    const char *name = is_standard ? "<stdin>" : path;
    const struct mcr_source *source = NULL;
    struct stat status;
    size_t length = 0;
    char *text = NULL;

    if (descriptor >= 0 && fstat(descriptor, &status) == 0) {
        file->has_identity = !is_standard && S_ISREG(status.st_mode);
        file->device = status.st_dev;
        file->inode = status.st_ino;
        if (S_ISDIR(status.st_mode))
            errno = EISDIR;
        else
            text = slurp(descriptor, S_ISREG(status.st_mode) ? (size_t)status.st_size : 0, MCR_SOURCE_LIMIT - (size_t)parser->total, &length);
    }
    if (!text)
        mcr_report(parser->diagnostics, MCR_ERROR, place, "cannot read '%s': %s", name, strerror(errno));
    else
        source = mcr_source_add(parser, name, text, length, place.source ? &place : NULL);
    if (source)
        mcr_hash(parser, text, length);
    free(text);
    if (descriptor >= 0 && !is_standard)
        close(descriptor);
    file->source = source;
    return source;
}

const char *mcr_source_path(struct mcr_parser *parser, const char *directory, const char *path)
{
    size_t folder = path[0] == '/' ? 0 : strlen(directory), length = strlen(path);
    int slash = folder && directory[folder - 1] != '/';
    char *joined = mcr_arena_alloc(parser->arena, folder + (size_t)slash + length + 1, 1);
    if (!joined) {
        mcr_fatal(parser);
        return NULL;
    }
    memcpy(joined, directory, folder);
    if (slash)
        joined[folder] = '/';
    memcpy(joined + folder + slash, path, length);
    return joined;
}

const char *mcr_source_directory(struct mcr_parser *parser, const char *path)
{
    const char *slash = strrchr(path, '/');
    size_t length = !slash ? 0 : slash == path ? 1 : (size_t)(slash - path);
    char *directory = mcr_arena_text(parser->arena, path, length);
    if (!directory)
        mcr_fatal(parser);
    return directory ? directory : "";
}
