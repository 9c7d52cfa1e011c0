/* SPDX-License-Identifier: Apache-2.0 */
/* Tables that the core makes of a scene before the first ray. Return 0, or -1 when memory is short. Private to src/core. */
#ifndef MCR_CORE_GROUPS_H
#define MCR_CORE_GROUPS_H

#include "core/batch.h"

int mcr_groups_init(struct mcr_core *core, struct mcr_arena *arena);
int mcr_surfaces_init(struct mcr_core *core, struct mcr_arena *arena);
/* charts.c: after the surfaces. */
int mcr_charts_init(struct mcr_core *core, struct mcr_arena *arena);

#endif
