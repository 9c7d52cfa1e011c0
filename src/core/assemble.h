/* SPDX-License-Identifier: Apache-2.0 */
/* Assembling the core for a scene: what the scene does not need is left out here. Private to src/core. */
#ifndef MCR_CORE_ASSEMBLE_H
#define MCR_CORE_ASSEMBLE_H

#include "core/batch.h"

/* `core` is zeroed and lives no longer than the arena and what it is made from. Returns 0, or -1 when memory is short. */
int mcr_core_init(struct mcr_core *core, struct mcr_arena *arena, const struct mcr_scene *scene, const struct mcr_accel *accel,
                  const struct mcr_render_options *options);

#endif
