/* SPDX-License-Identifier: Apache-2.0 */
/* The same work on several threads at once. */
#ifndef MCR_BASE_THREADS_H
#define MCR_BASE_THREADS_H

#include <stdint.h>

#define MCR_THREADS_MAX 4096u
/* Stack of the threads that are started; what a stage needs beyond some kilobytes belongs into its scratch. */
#define MCR_THREAD_STACK (1u << 20)

/*
 * Runs work(argument, thread) once on each of `count` threads (0 counts as 1, above MCR_THREADS_MAX as that) and returns when all
 * have ended: how many ran. The caller is thread 0; the others have all signals blocked, so that SIGINT reaches the caller. If the
 * system refuses a thread, fewer run, with the numbers 0 to result - 1: work must take its share from a common counter and not
 * from `count`. What the threads wrote is visible to the caller afterwards. May be called from any thread, also within work.
 */
uint32_t mcr_threads_run(uint32_t count, void (*work)(void *argument, uint32_t thread), void *argument);

#endif
