/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Calls from the core into plugins, each with its own scratch on the batch's stack. All return what the operation did: 0 or a negative MCR_E_*;
 * batch->context.message holds what the plugin reported. Private to src/core.
 */
#ifndef MCR_CORE_HOST_H
#define MCR_CORE_HOST_H

#include "core/batch.h"

/* Fills core->host. */
void mcr_host_init(struct mcr_core *core);
/* Bytes of scratch that all nested operations of one thread can need. */
uint64_t mcr_host_scratch(const struct mcr_core *core);

/* A sampler's node. */
int32_t mcr_node_draw(struct mcr_batch *batch, const struct mcr_node *node, uint32_t technique, const struct mcr_points *at,
                      const double *const *number, const struct mcr_directions *out, double *density);
int32_t mcr_node_density(struct mcr_batch *batch, const struct mcr_node *node, uint32_t technique, const struct mcr_points *at,
                         const struct mcr_directions *toward, double *density);
int32_t mcr_node_draw_emitter(struct mcr_batch *batch, const struct mcr_node *node, uint32_t technique, const struct mcr_points *at,
                              const double *const *number, const struct mcr_emitter_points *out, double *density);
int32_t mcr_node_density_emitter(struct mcr_batch *batch, const struct mcr_node *node, uint32_t technique, const struct mcr_points *at,
                                 const struct mcr_emitter_points *points, double *density);

/* The material of a range of points. */
int32_t mcr_group_evaluate(struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_directions *toward,
                           const struct mcr_colours *out);
/* The density of the material's own sampling; 0 if it has none. */
int32_t mcr_group_density(struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_directions *toward, double *density);
/* Chooses a mirror-like lobe, or none: see struct mcr_material_plugin. */
int32_t mcr_group_delta(struct mcr_batch *batch, const struct mcr_range *range, const double *const *number, const struct mcr_directions *out,
                        double *probability, const struct mcr_colours *weight);
/* A direction of the material's own sampling; and its albedo, which it can tell. */
int32_t mcr_group_draw(struct mcr_batch *batch, const struct mcr_range *range, const double *const *number, const struct mcr_directions *out,
                       double *density);
int32_t mcr_group_albedo(struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_colours *out);
int32_t mcr_group_emission(struct mcr_batch *batch, const struct mcr_range *range, const struct mcr_colours *out);
/* The same for points elsewhere, all of one group; material[0 .. n-1] are theirs. */
int32_t mcr_points_emission(struct mcr_batch *batch, const struct mcr_group *group, const struct mcr_points *at, const uint32_t *material,
                            const struct mcr_colours *out);
int32_t mcr_points_passes(struct mcr_batch *batch, const struct mcr_group *group, const struct mcr_points *at, const uint32_t *material,
                          const struct mcr_colours *out);
uint64_t mcr_material_bytes(const struct mcr_group *group, uint32_t n);

/* `count` numbers from dimension `first` on for the states begin .. end-1, through the chain of sources. */
int32_t mcr_numbers(struct mcr_batch *batch, const struct mcr_paths *paths, uint32_t begin, uint32_t end, uint32_t first, uint32_t count,
                    double *const *number);

#endif
