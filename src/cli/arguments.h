/* SPDX-License-Identifier: Apache-2.0 */
/* What the command lines of all commands have in common: names of options, their values, and what is said of mistakes. */
#ifndef MCR_CLI_ARGUMENTS_H
#define MCR_CLI_ARGUMENTS_H

#include <stddef.h>
#include <stdint.h>

/* Prints "mcrender: error: ..." on stderr and returns MCR_EXIT_USAGE. */
int mcr_usage_error(const char *format, ...) __attribute__((format(printf, 1, 2)));

/*
 * The place of the option among `count` names, each *(const char **) that is `stride` bytes behind the one before: that of which the first `length`
 * bytes of `argument` are all, or an abbreviation of `shortest` bytes at least. MCR_OPTION_NONE: none; MCR_OPTION_SEVERAL: after a message.
 */
#define MCR_OPTION_NONE (-1)
#define MCR_OPTION_SEVERAL (-2)
int mcr_option_find(const char *const *names, size_t stride, size_t count, const char *argument, size_t length, size_t shortest);
/* Says that there is none, and what was probably meant. help: the command to ask. Returns MCR_EXIT_USAGE. */
int mcr_option_unknown(const char *const *names, size_t stride, size_t count, const char *argument, size_t length, const char *help);

/* Values: 0, or MCR_EXIT_USAGE after a message that names the option. */
int mcr_argument_whole(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *out);
int mcr_argument_number(const char *option, const char *text, double low, double high, double *out);
/* `count` whole numbers up to 65536, with `separator` between them; `form` is what they look like. */
int mcr_argument_pixels(const char *option, const char *text, char separator, uint32_t count, uint32_t low, const char *form, uint32_t *out);
/* X0,Y0,X1,Y1: a rectangle that is not empty. */
int mcr_argument_crop(const char *option, const char *text, uint32_t crop[4]);
/* Its place among the words; those from `absent` on are known but not in this build. */
int mcr_argument_word(const char *option, const char *text, const char *const *words, uint32_t count, uint32_t absent, uint32_t *out);

#endif
