/* SPDX-License-Identifier: Apache-2.0 */
#define _GNU_SOURCE /* sched_getaffinity */
#include "base/cpu.h"

#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

static const char *const isa_names[] = {"baseline", "avx2", "avx512"};

uint32_t mcr_cpu_isa(void)
{
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("avx2"))
        return MCR_ISA_BASELINE;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512bw"))
        return MCR_ISA_AVX512;
    return MCR_ISA_AVX2;
#else
    return MCR_ISA_BASELINE;
#endif
}

const char *mcr_cpu_isa_name(uint32_t isa)
{
    return isa < sizeof isa_names / sizeof *isa_names ? isa_names[isa] : NULL;
}

int32_t mcr_cpu_isa_parse(const char *name)
{
    for (uint32_t i = 0; i < sizeof isa_names / sizeof *isa_names; i++)
        if (!strcmp(name, isa_names[i]))
            return (int32_t)i;
    return -1;
}

/* ---- how many processors ---- */

/* Processors in the affinity mask. The kernel refuses masks smaller than its own, which may be larger than cpu_set_t. */
static uint32_t affinity_count(void)
{
    for (int processors = CPU_SETSIZE; processors <= 1 << 20; processors *= 2) {
        cpu_set_t *set = CPU_ALLOC(processors);
        size_t size = CPU_ALLOC_SIZE(processors);
        int count = set && !sched_getaffinity(0, size, set) ? CPU_COUNT_S(size, set) : 0;
        CPU_FREE(set);
        if (count > 0)
            return (uint32_t)count;
    }
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online > 0 ? (uint32_t)online : 1;
}

/* The first line of folder/file. */
static int first_line(const char *folder, const char *file, char *line, int size)
{
    char path[4096 + 64];
    int length = snprintf(path, sizeof path, "%s/%s", folder, file);
    FILE *in = length > 0 && (size_t)length < sizeof path ? fopen(path, "re") : NULL;
    int found = in && fgets(line, size, in);
    if (in)
        fclose(in);
    return found;
}

/* The quota of one group, version 2 ("max 100000" or "150000 100000" in cpu.max) or 1 (-1 for none); INFINITY if it has none. */
static double group_quota(const char *folder, int version)
{
    char line[128];
    double quota, period;
    if (version == 2) {
        if (!first_line(folder, "cpu.max", line, sizeof line) || sscanf(line, "%lf %lf", &quota, &period) != 2)
            return INFINITY;
    } else {
        if (!first_line(folder, "cpu.cfs_quota_us", line, sizeof line) || sscanf(line, "%lf", &quota) != 1 ||
            !first_line(folder, "cpu.cfs_period_us", line, sizeof line) || sscanf(line, "%lf", &period) != 1)
            return INFINITY;
    }
    return quota > 0.0 && period > 0.0 ? quota / period : INFINITY;
}

/* The least quota from mount/hierarchy/group up to mount/hierarchy. Inside a container the group's own folder may be missing: the
 * ones above it are asked all the same. */
static double hierarchy_quota(const char *mount, const char *hierarchy, const char *group, int version)
{
    char folder[4096];
    int root = snprintf(folder, sizeof folder, "%s%s%s", mount, *hierarchy ? "/" : "", hierarchy);
    int length = snprintf(folder, sizeof folder, "%s%s%s%s", mount, *hierarchy ? "/" : "", hierarchy, group);
    double least = INFINITY;

    if (root < 0 || length < root || (size_t)length >= sizeof folder)
        return INFINITY;
    for (;;) {
        char *slash;
        least = fmin(least, group_quota(folder, version));
        slash = strrchr(folder + root, '/');
        if (!slash)
            return least;
        *slash = '\0';
    }
}

double mcr_cpu_quota(const char *membership, const char *mount)
{
    char line[4096];
    double least = INFINITY;
    FILE *in = fopen(membership, "re");

    /* lines "0::/group" (version 2) and "4:cpu,cpuacct:/group" (version 1, mounted under its controllers' names) */
    while (in && fgets(line, sizeof line, in)) {
        char *controllers = strchr(line, ':'), *group = controllers ? strchr(controllers + 1, ':') : NULL, *word, *rest;
        if (!group)
            continue;
        *group++ = '\0';
        group[strcspn(group, "\n")] = '\0';
        controllers++;
        if (!*controllers) {
            least = fmin(least, hierarchy_quota(mount, "", group, 2));
            least = fmin(least, hierarchy_quota(mount, "unified", group, 2));
            continue;
        }
        least = strstr(controllers, "cpu") ? fmin(least, hierarchy_quota(mount, controllers, group, 1)) : least;
        for (word = strtok_r(controllers, ",", &rest); word; word = strtok_r(NULL, ",", &rest))
            if (!strcmp(word, "cpu"))
                least = fmin(least, hierarchy_quota(mount, "cpu", group, 1));
    }
    if (in)
        fclose(in);
    return isfinite(least) ? least : 0.0;
}

uint32_t mcr_cpu_count(void)
{
    uint32_t count = affinity_count();
    double quota = ceil(mcr_cpu_quota("/proc/self/cgroup", "/sys/fs/cgroup"));
    return quota >= 1.0 && quota < count ? (uint32_t)quota : count;
}

/* ---- descriptions and measures ---- */

/* What stands behind the first "key : value" of a file with one of the keys (NULL-terminated), without its surrounding blanks. */
static int keyed_value(const char *file, const char *const *keys, char *value, size_t size)
{
    char line[1024];
    int found = 0;
    FILE *in = fopen(file, "re");
    while (in && !found && fgets(line, sizeof line, in)) {
        char *colon = strchr(line, ':'), *text;
        size_t length = colon ? (size_t)(colon - line) : 0;
        while (length && (line[length - 1] == ' ' || line[length - 1] == '\t'))
            length--;
        for (const char *const *key = keys; colon && *key; key++)
            found |= strlen(*key) == length && !memcmp(*key, line, length);
        if (!found)
            continue;
        text = colon + 1 + strspn(colon + 1, " \t");
        text[strcspn(text, "\n")] = '\0';
        found = *text != '\0';
        if (found)
            snprintf(value, size, "%s", text);
    }
    if (in)
        fclose(in);
    return found;
}

void mcr_cpu_model(char *name, size_t size)
{
    static const char *const keys[] = {"model name", "cpu model", "cpu", "Model Name", "uarch", NULL};
    if (!keyed_value("/proc/cpuinfo", keys, name, size) && size)
        snprintf(name, size, "unknown");
}

uint64_t mcr_peak_memory(void)
{
    /* ru_maxrss of a program begins with the size of the process that started it (the kernel keeps it across exec), VmHWM does not. */
    static const char *const keys[] = {"VmHWM", NULL};
    char value[64];
    struct rusage usage;
    if (keyed_value("/proc/self/status", keys, value, sizeof value)) {
        unsigned long long kilobytes = strtoull(value, NULL, 10);
        if (kilobytes)
            return (uint64_t)kilobytes * 1024;
    }
    return getrusage(RUSAGE_SELF, &usage) == 0 && usage.ru_maxrss > 0 ? (uint64_t)usage.ru_maxrss * 1024 : 0;
}

static double seconds(clockid_t clock)
{
    struct timespec now = {0, 0};
    clock_gettime(clock, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

double mcr_wall_seconds(void)
{
    return seconds(CLOCK_MONOTONIC);
}

double mcr_cpu_seconds(void)
{
    return seconds(CLOCK_PROCESS_CPUTIME_ID);
}
