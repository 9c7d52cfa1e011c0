/* SPDX-License-Identifier: Apache-2.0 */
#include "image/sink.h"

#include <errno.h>
#include <poll.h>
#include <string.h>
#include <unistd.h>

void mcr_sink_init(struct mcr_sink *sink, int fd)
{
    sink->fd = fd;
    sink->error = 0;
    sink->used = 0;
}

/* Writes all of it: short writes go on, signals are retried, a descriptor that somebody made non-blocking is waited for. */
static int write_all(struct mcr_sink *sink, const unsigned char *bytes, size_t count)
{
    while (count > 0 && !sink->error) {
        ssize_t written = write(sink->fd, bytes, count < (1u << 30) ? count : 1u << 30);
        if (written > 0) {
            bytes += written;
            count -= (size_t)written;
        } else if (written == 0) {
            sink->error = ENOSPC;
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            struct pollfd wait = {.fd = sink->fd, .events = POLLOUT};
            if (poll(&wait, 1, -1) < 0 && errno != EINTR) sink->error = errno;
        } else if (errno != EINTR) {
            sink->error = errno;
        }
    }
    return sink->error ? -1 : 0;
}

int mcr_sink_flush(struct mcr_sink *sink)
{
    size_t used = sink->used;
    sink->used = 0;
    return write_all(sink, sink->buffer, used);
}

int mcr_sink_put(struct mcr_sink *sink, const void *bytes, size_t count)
{
    if (sink->error) return -1;
    if (count > sizeof sink->buffer - sink->used && mcr_sink_flush(sink)) return -1;
    if (count > sizeof sink->buffer) return write_all(sink, bytes, count);
    memcpy(sink->buffer + sink->used, bytes, count);
    sink->used += count;
    return 0;
}
