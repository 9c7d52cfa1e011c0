/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/stop.h"

#include <stddef.h>

volatile sig_atomic_t mcr_stop_asked;

static void on_stop(int number)
{
    (void)number;
    mcr_stop_asked = 1;
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
}

void mcr_stop_catch(void)
{
    static const int stops[] = {SIGINT, SIGTERM};
    struct sigaction stop = {.sa_handler = on_stop, .sa_flags = SA_RESTART}, ignore = {.sa_handler = SIG_IGN}, before;
    for (int i = 0; i < 2; i++)
        if (!sigaction(stops[i], NULL, &before) && before.sa_handler != SIG_IGN) /* as nohup and shells have it for background jobs */
            sigaction(stops[i], &stop, NULL);
    sigaction(SIGPIPE, &ignore, NULL); /* writing fails with EPIPE */
    sigaction(SIGXFSZ, &ignore, NULL); /* writing fails with EFBIG */
}
