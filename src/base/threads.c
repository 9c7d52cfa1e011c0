/* SPDX-License-Identifier: Apache-2.0 */
#include "base/threads.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>

struct worker {
    void (*work)(void *argument, uint32_t thread);
    void *argument;
    pthread_t thread;
    uint32_t number;
};

static void *run_worker(void *pointer)
{
    struct worker *worker = pointer;
    worker->work(worker->argument, worker->number);
    return NULL;
}

/* Starts workers 1 to count - 1; returns how many there are with the caller, who counts as 0. */
static uint32_t start_workers(struct worker *workers, uint32_t count, void (*work)(void *argument, uint32_t thread), void *argument)
{
    pthread_attr_t attributes, *with = &attributes;
    sigset_t all, before;
    uint32_t started = 1;

    if (pthread_attr_init(&attributes))
        return 1;
    if (pthread_attr_setstacksize(&attributes, MCR_THREAD_STACK)) /* refused where thread-local data need more: the default serves */
        with = NULL;
    /* A new thread inherits the mask of the one that creates it. */
    sigfillset(&all);
    if (!pthread_sigmask(SIG_SETMASK, &all, &before)) {
        for (; started < count; started++) {
            struct worker *worker = &workers[started];
            *worker = (struct worker){.work = work, .argument = argument, .number = started};
            if (pthread_create(&worker->thread, with, run_worker, worker))
                break;
        }
        pthread_sigmask(SIG_SETMASK, &before, NULL);
    }
    pthread_attr_destroy(&attributes);
    return started;
}

uint32_t mcr_threads_run(uint32_t count, void (*work)(void *argument, uint32_t thread), void *argument)
{
    struct worker *workers;
    uint32_t running = 1;

    count = count > MCR_THREADS_MAX ? MCR_THREADS_MAX : count;
    workers = count > 1 ? calloc(count, sizeof *workers) : NULL;
    if (workers)
        running = start_workers(workers, count, work, argument);
    work(argument, 0);
    for (uint32_t i = 1; i < running; i++)
        pthread_join(workers[i].thread, NULL);
    free(workers);
    return running;
}
