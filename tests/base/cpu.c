/* SPDX-License-Identifier: Apache-2.0 */
/* What cpu.h tells; the quotas against made-up control groups. */
#include "base/cpu.h"
#include "../tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static char folder[512];

/* Writes a file below the test's folder, with its parents. */
static void write_file(const char *name, const char *text)
{
    char path[1024];
    FILE *out;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    for (char *slash = path + strlen(folder) + 1; (slash = strchr(slash, '/')); slash++) {
        *slash = '\0';
        mkdir(path, 0777);
        *slash = '/';
    }
    out = fopen(path, "w");
    if (!out || fputs(text, out) < 0 || fclose(out))
        exit(99);
}

static double quota(const char *membership)
{
    char file[600];
    write_file("membership", membership);
    snprintf(file, sizeof file, "%s/membership", folder);
    return mcr_cpu_quota(file, folder);
}

static void test_quota(void)
{
    const char *base = getenv("TMPDIR");
    char path[600], long_name[4200];
    snprintf(folder, sizeof folder, "%s/mcr-cpu-XXXXXX", base ? base : "/tmp");
    if (!mkdtemp(folder))
        exit(99);
    ok(quota("0::/a/b\n") == 0.0, "no files, no quota");
    write_file("a/cpu.max", "150000 100000\n");
    write_file("a/b/cpu.max", "max 100000\n");
    ok(quota("0::/a/b\n") == 1.5, "version 2: the parent's quota holds");
    write_file("a/b/cpu.max", "50000 100000\n");
    ok(quota("0::/a/b\n") == 0.5, "version 2: the least counts");
    ok(quota("0::/missing/group\n") == 0.0, "a group that is not mounted here");
    write_file("cpu.max", "300000 100000\n");
    ok(quota("0::/missing/group\n") == 3.0, "the mounted root is asked for a group that is missing");
    write_file("cpu,cpuacct/g/cpu.cfs_quota_us", "-1\n");
    write_file("cpu,cpuacct/g/cpu.cfs_period_us", "100000\n");
    ok(quota("5:memory:/g\n4:cpu,cpuacct:/g\n") == 0.0, "version 1: -1 is none");
    write_file("cpu,cpuacct/g/cpu.cfs_quota_us", "250000\n");
    ok(quota("5:memory:/g\n4:cpu,cpuacct:/g\n") == 2.5, "version 1: a quota");
    write_file("cpu/g/cpu.cfs_quota_us", "100000\n");
    write_file("cpu/g/cpu.cfs_period_us", "100000\n");
    ok(quota("4:cpu,cpuacct:/g\n") == 1.0, "version 1: mounted as cpu alone");
    write_file("cpu.max", "garbage\n");
    ok(quota("0::/\n\n:\n::\nx\n") == 0.0, "garbage is no quota");
    memset(long_name, 'x', sizeof long_name - 1);
    long_name[sizeof long_name - 1] = '\0';
    memcpy(long_name, "0::/", 4);
    ok(quota(long_name) == 0.0, "a name that is too long");
    ok(mcr_cpu_quota("/nonexistent/file", folder) == 0.0, "no membership file");
    snprintf(path, sizeof path, "rm -rf '%s'", folder);
    if (system(path))
        puts("# the test's folder is left behind");
}

static void test_isa(void)
{
    uint32_t isa = mcr_cpu_isa();
    int good = 1;
    for (uint32_t i = 0; i < 3; i++)
        good &= mcr_cpu_isa_name(i) && mcr_cpu_isa_parse(mcr_cpu_isa_name(i)) == (int32_t)i;
    ok(good && !mcr_cpu_isa_name(3), "instruction sets have names that parse");
    ok(mcr_cpu_isa_parse("AVX2") == -1 && mcr_cpu_isa_parse("") == -1 && mcr_cpu_isa_parse("avx") == -1, "other names do not");
    ok(mcr_cpu_isa_name(isa) != NULL, "this processor has %s", mcr_cpu_isa_name(isa));
}

static void test_measures(void)
{
    double wall = mcr_wall_seconds(), cpu = mcr_cpu_seconds(), sum = 0.0;
    uint64_t before = mcr_peak_memory(), after;
    char name[256], small[4] = "zzz";
    const size_t size = (size_t)64 << 20;
    volatile char *memory = malloc(size);

    for (size_t i = 0; memory && i < size; i += 512)
        memory[i] = 1;
    for (size_t i = 0; memory && i < size; i += 512)
        sum += memory[i];
    after = mcr_peak_memory();
    ok(sum > 0 && after >= before + size / 2 && after < before + 8 * size, "peak memory grows by what is touched: %.1f to %.1f MiB", before / 0x1p20,
       after / 0x1p20);
    free((void *)memory);
    /* the kernel adds pages up in batches, so that the last few may come and go */
    ok(mcr_peak_memory() >= before + size / 2, "and stays when that is freed");
    ok(mcr_wall_seconds() > wall && mcr_cpu_seconds() > cpu, "both clocks run");
    mcr_cpu_model(name, sizeof name);
    ok(*name && !strchr(name, '\n') && name[0] != ' ', "processor: %s", name);
    mcr_cpu_model(small, sizeof small);
    ok(strlen(small) == 3 && !strncmp(small, name, 3), "its name is cut to fit");
    ok(mcr_cpu_count() >= 1, "%u usable processors", mcr_cpu_count());
}

int main(void)
{
    test_isa();
    test_quota();
    test_measures();
    return tap_done();
}
