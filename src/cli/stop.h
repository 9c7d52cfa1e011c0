/* SPDX-License-Identifier: Apache-2.0 */
/* Signals: the first SIGINT or SIGTERM asks for an orderly end, a second one kills. */
#ifndef MCR_CLI_STOP_H
#define MCR_CLI_STOP_H

#include <signal.h>

extern volatile sig_atomic_t mcr_stop_asked;

/* From here on signals are caught; SIGPIPE and SIGXFSZ become errors of writing. */
void mcr_stop_catch(void);

#endif
