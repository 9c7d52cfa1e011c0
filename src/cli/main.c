/* SPDX-License-Identifier: Apache-2.0 */
#include <fcntl.h>
#include <string.h>

#include "cli/commands.h"

/* A file that is opened must not become descriptor 0, 1 or 2: closed ones are taken, the wrong way round, so that using them fails. */
static void take_closed_descriptors(void)
{
    for (int fd = 0; fd < 3; fd++)
        if (fcntl(fd, F_GETFD) < 0)
            (void)!open("/dev/null", fd ? O_RDONLY : O_WRONLY);
}

/* A command that works on a scene; all have their options from one table. */
static int scene_command(int argc, char **argv)
{
    static const struct {
        const char *name;
        int (*run)(struct mcr_options *options);
        int needs_operand;
    } commands[] = {{"", mcr_command_render, 1}, {"check", mcr_command_check, 1}, {"explain", mcr_command_explain, 1}, {"study", mcr_command_study, 1},
                    {"plugins", mcr_command_plugins, 0}};
    struct mcr_options options;
    size_t c = 0;
    for (size_t i = 1; argc > 1 && i < sizeof commands / sizeof *commands; i++)
        if (!strcmp(argv[1], commands[i].name))
            c = i;
    int status = mcr_options_parse(&options, commands[c].name, c ? argc - 1 : argc, c ? argv + 1 : argv);
    if (!status && options.help) {
        (commands[c].run == mcr_command_study ? mcr_study_options_help : mcr_options_help)(stdout);
    } else if (!status && options.version) {
        puts("mcrender " PACKAGE_VERSION);
    } else if (!status && commands[c].needs_operand && !options.scene) {
        fprintf(stderr, "mcrender: error: a scene file is expected (see mcrender --help)\n");
        status = MCR_EXIT_USAGE;
    } else if (!status) {
        status = commands[c].run(&options);
    }
    mcr_options_fini(&options);
    return status;
}

int main(int argc, char **argv)
{
    take_closed_descriptors();
    int status = argc > 1 && !strcmp(argv[1], "compare") ? mcr_command_compare(argc - 1, argv + 1) : scene_command(argc, argv);
    if (fflush(stdout) || ferror(stdout)) {
        fprintf(stderr, "mcrender: error: standard output could not be written\n");
        status = status ? status : MCR_EXIT_FAILED;
    }
    return status;
}
