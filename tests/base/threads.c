/* SPDX-License-Identifier: Apache-2.0 */
/* Threads: numbers, joining, signals, and a system that refuses threads. */
#include "base/threads.h"
#include "../tap.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#define ITEMS 10000u

struct job {
    atomic_uint next, calls;
    atomic_uint seen[MCR_THREADS_MAX]; /* calls with this number */
    uint32_t done[ITEMS];              /* plain memory: joining makes it visible */
    pthread_t caller;
    atomic_int zero_is_caller, blocked;
};

static struct job job;

static void work(void *argument, uint32_t thread)
{
    struct job *mine = argument;
    sigset_t mask;
    atomic_fetch_add(&mine->calls, 1);
    atomic_fetch_add(&mine->seen[thread], 1);
    pthread_sigmask(SIG_SETMASK, NULL, &mask);
    if (thread == 0)
        atomic_store(&mine->zero_is_caller, pthread_equal(pthread_self(), mine->caller) && !sigismember(&mask, SIGINT));
    else if (!sigismember(&mask, SIGINT) || !sigismember(&mask, SIGTERM))
        atomic_store(&mine->blocked, 0);
    for (uint32_t i; (i = atomic_fetch_add(&mine->next, 1)) < ITEMS;)
        mine->done[i]++;
}

/* Whether `count` threads do every item once, with the numbers 0 to the result - 1 once each. */
static int run(uint32_t count, uint32_t *ran)
{
    int good;
    memset(&job, 0, sizeof job);
    job.caller = pthread_self();
    job.blocked = 1;
    *ran = mcr_threads_run(count, work, &job);
    good = job.calls == *ran && job.zero_is_caller && job.blocked;
    for (uint32_t i = 0; i < MCR_THREADS_MAX; i++)
        good &= job.seen[i] == (i < *ran);
    for (uint32_t i = 0; i < ITEMS; i++)
        good &= job.done[i] == 1;
    return good;
}

static void nested(void *argument, uint32_t thread)
{
    (void)thread;
    atomic_fetch_add((atomic_uint *)argument, 1);
}

static void outer(void *argument, uint32_t thread)
{
    (void)thread;
    mcr_threads_run(3, nested, argument);
}

/* In a child with a small address space not all stacks can be had: fewer threads run and do all the work. */
static int run_refused(void)
{
    int status = 0;
    pid_t child = fork();
    if (child == 0) {
        struct rlimit limit = {(rlim_t)256 << 20, (rlim_t)256 << 20};
        uint32_t ran = 0;
        int good;
        setrlimit(RLIMIT_AS, &limit);
        good = run(1000, &ran);
        _exit(good && ran >= 1 && ran < 1000 ? 0 : 1);
    }
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

int main(void)
{
    static const uint32_t counts[] = {0, 1, 2, 7, 64};
    atomic_uint calls = 0;
    sigset_t before, after;
    uint32_t ran;

    pthread_sigmask(SIG_SETMASK, NULL, &before);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        int good = run(counts[i], &ran);
        ok(good && ran == (counts[i] ? counts[i] : 1), "%u threads: %u ran, each with its number, all items done once", counts[i], ran);
    }
    pthread_sigmask(SIG_SETMASK, NULL, &after);
    ok(sigismember(&before, SIGINT) == sigismember(&after, SIGINT), "the caller's signal mask is restored");
    mcr_threads_run(4, outer, &calls);
    ok(calls == 12, "runs may be nested");
    if (getenv("MCR_SANITIZED") && !strcmp(getenv("MCR_SANITIZED"), "1"))
        tap_skip("refused threads", "sanitizers need their address space");
    else
        ok(run_refused(), "a system that refuses threads gets the work done by fewer");
    return tap_done();
}
