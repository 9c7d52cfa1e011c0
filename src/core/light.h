/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Multiple importance sampling of emitted light, for samplers with more than one technique (Veach and Guibas, "Optimally combining sampling
 * techniques for Monte Carlo rendering", SIGGRAPH 1995). All techniques of a point look for emitted light; each find is weighted by the balance
 * heuristic, h(p) / sum of h over the techniques, h(p) = p, or by the power heuristic with h(p) = p^2. Scenes with one technique do without all this.
 * Private to src/core.
 */
#ifndef MCR_CORE_LIGHT_H
#define MCR_CORE_LIGHT_H

#include "core/batch.h"

/* For the points of a range, after the continuing technique has drawn: the other techniques look for light. Returns 0 or a plugin's failure. */
int32_t mcr_light_lookups(struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_points *at, double *const *number);

/* Weights of what the rays have hit, while the points that they left are still there. */
int32_t mcr_light_weights(struct mcr_batch *batch);

#endif
