/* SPDX-License-Identifier: Apache-2.0 */
/* What `mcrender plugins` prints: the tables of plugins as documentation. The caller opens the stream and checks it for errors. */
#ifndef MCR_PLUGIN_DESCRIBE_H
#define MCR_PLUGIN_DESCRIBE_H

#include <stdio.h>

#include "plugin/registry.h"

/* `mcrender plugins`: everything that is loaded, by kind. Call mcr_registry_open_all before. */
void mcr_describe_all(FILE *to, const struct mcr_registry *registry);
/*
 * `mcrender plugins WORD`: its full documentation, for each kind that has the word. Opens its file. Returns 0, or -1 where there is no such
 * word, which was recorded.
 */
int mcr_describe_word(FILE *to, struct mcr_registry *registry, const char *word);

#endif
