/* SPDX-License-Identifier: Apache-2.0 */
#include "base/elf.h"

#include <fcntl.h>
#include <link.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int read_at(int fd, void *to, size_t bytes, uint64_t from)
{
    return from <= INT64_MAX && pread(fd, to, bytes, (off_t)from) == (ssize_t)bytes;
}

static int is_cut_off(int fd, uint64_t size)
{
    ElfW(Ehdr) head;
    if (!read_at(fd, &head, sizeof head, 0))
        return read_at(fd, &head, SELFMAG, 0) && !memcmp(&head, ELFMAG, SELFMAG);
    if (memcmp(head.e_ident, ELFMAG, SELFMAG) || head.e_ident[EI_CLASS] != (sizeof(void *) == 8 ? ELFCLASS64 : ELFCLASS32) ||
        head.e_phentsize != sizeof(ElfW(Phdr)))
        return 0;
    for (uint32_t i = 0; i < head.e_phnum; i++) {
        ElfW(Phdr) part;
        if (!read_at(fd, &part, sizeof part, head.e_phoff + i * sizeof part))
            return 1;
        if (part.p_type == PT_LOAD && (part.p_filesz > size || part.p_offset > size - part.p_filesz))
            return 1;
    }
    return 0;
}

int mcr_elf_is_cut_off(const char *path)
{
    struct stat status;
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK), result;
    if (fd < 0)
        return 0;
    result = !fstat(fd, &status) && S_ISREG(status.st_mode) && is_cut_off(fd, (uint64_t)status.st_size);
    close(fd);
    return result;
}
