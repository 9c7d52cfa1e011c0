/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Mirror-like lobes. A density cannot draw them, so the core asks the material under every sampler: one lobe, or none, is chosen with the
 * probabilities that the material tells, and what follows is divided by them. Emission found along a lobe has weight 1, since no technique
 * could have drawn that direction. Private to src/core.
 */
#ifndef MCR_CORE_LOBES_H
#define MCR_CORE_LOBES_H

#include "core/batch.h"

/* Of the points of a range whose group has lobes: fills batch->lobe. Returns 0 or the plugin's failure. */
int32_t mcr_lobes_choose(struct mcr_batch *batch, const struct mcr_range *range);

/* The points of a range whose group has none: no lobe was chosen. */
void mcr_lobes_none(struct mcr_batch *batch, const struct mcr_range *range);

/* What the points of a range scatter toward look-ups: nothing where a lobe was chosen, divided by the probability of none elsewhere. */
void mcr_lobes_share(const struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_colours *f);

#endif
