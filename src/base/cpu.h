/* SPDX-License-Identifier: Apache-2.0 */
/* What the machine is and what this process uses of it. All functions may be called from any thread. */
#ifndef MCR_BASE_CPU_H
#define MCR_BASE_CPU_H

#include <mcrender/plugin.h> /* MCR_ISA_* */
#include <stddef.h>
#include <stdint.h>

/* The highest MCR_ISA_* that processor and operating system support; MCR_ISA_BASELINE on other architectures than x86-64. */
uint32_t mcr_cpu_isa(void);
/* "baseline", "avx2" or "avx512"; NULL for another number. */
const char *mcr_cpu_isa_name(uint32_t isa);
/* The MCR_ISA_* of such a name, or -1. */
int32_t mcr_cpu_isa_parse(const char *name);

/* How many threads are worth starting: the processors that this process may run on, or its control group's quota where that is
 * less (rounded up). At least 1. */
uint32_t mcr_cpu_count(void);
/* The quota in processors (1.5 for 150 ms in 100 ms) of the control groups named in `membership` (a file like /proc/self/cgroup),
 * whose hierarchies are mounted below `mount` (/sys/fs/cgroup): the least along the way to the root. 0 where there is none. */
double mcr_cpu_quota(const char *membership, const char *mount);

/* The processor's name as the kernel tells it, "unknown" if it does not; cut to fit. */
void mcr_cpu_model(char *name, size_t size);

/* Largest resident memory of this process so far, in bytes, as exactly as the kernel counts (some 100 KiB); 0 if unknown. */
uint64_t mcr_peak_memory(void);

/* Seconds since some fixed moment; never runs backwards, whatever is done to the clock. */
double mcr_wall_seconds(void);
/* Seconds of processor time that all threads of this process have used. */
double mcr_cpu_seconds(void);

#endif
