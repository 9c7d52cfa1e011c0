/* SPDX-License-Identifier: Apache-2.0 */
/* The commands. Each returns the exit status. */
#ifndef MCR_CLI_COMMANDS_H
#define MCR_CLI_COMMANDS_H

#include "cli/options.h"

int mcr_command_render(struct mcr_options *options);
int mcr_command_check(struct mcr_options *options);
int mcr_command_explain(struct mcr_options *options);
int mcr_command_study(struct mcr_options *options);
int mcr_command_plugins(struct mcr_options *options);
/* Has options of its own; argv[0] is its name. */
int mcr_command_compare(int argc, char **argv);

#endif
