/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The host's light services (mcrender/sampler.h) over all that can be aimed at: the finite emitters (emitters.h) and the sky (sky.h), which is one
 * more emitter, numbered behind them. The sky is chosen with a fixed probability, by its power over the scene's extent against that of the finite
 * emitters; densities are the sums weighted with these. Without a sky the calls go straight to the emitters. Private to src/core.
 */
#ifndef MCR_CORE_LIGHTS_H
#define MCR_CORE_LIGHTS_H

#include "core/batch.h"

/* Fills core->sky, sky_functions, sky_emitter and sky_share; core->emitters is there. Returns 0, or -1 when memory is short. */
int mcr_lights_init(struct mcr_core *core, struct mcr_arena *arena);

/* Bytes of scratch, 64-byte aligned, that one call over n points needs. */
size_t mcr_lights_scratch(const struct mcr_core *core, uint32_t n);

/* As struct mcr_emitter_functions. */
void mcr_lights_draw(const struct mcr_core *core, void *scratch, uint32_t by, const struct mcr_points *at, const double *const *number,
                     const struct mcr_directions *out, double *density, double *kept);
void mcr_lights_density(const struct mcr_core *core, void *scratch, uint32_t by, const struct mcr_points *at, const struct mcr_directions *toward,
                        const double *kept, double *density);
void mcr_lights_mass(const struct mcr_core *core, void *scratch, uint32_t by, const struct mcr_points *at, double *mass);
void mcr_lights_draw_point(const struct mcr_core *core, void *scratch, uint32_t by, const struct mcr_points *at, const double *const *number,
                           const struct mcr_emitter_points *out, double *density);
void mcr_lights_density_point(const struct mcr_core *core, void *scratch, uint32_t by, const struct mcr_points *at,
                              const struct mcr_emitter_points *points, double *density);

#endif
