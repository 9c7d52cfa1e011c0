/* SPDX-License-Identifier: Apache-2.0 */
/* What materials and samplers share when instances are made. Private to src/plugin. */
#ifndef MCR_PLUGIN_CREATE_H
#define MCR_PLUGIN_CREATE_H

#include "plugin/node.h"
#include "plugin/values.h"

/*
 * Calls the plugin's create for a node whose descriptor, place, values, children and weights are there. Returns 0, or -1 after an
 * error, which was recorded at the node's place.
 */
int mcr_node_instantiate(struct mcr_node *node, struct mcr_diagnostics *diagnostics, uint32_t planned, int has_lights);
/* Calls the plugin's destroy, and those of all children if `children`. */
void mcr_node_destroy(struct mcr_node *node, int children);
/* Records that an operation of the node's plugin failed with this status. */
void mcr_node_failed(const struct mcr_node *node, struct mcr_diagnostics *diagnostics, const char *operation, int32_t status);
/* Asks a direction node for its techniques and checks them. Returns 0, or -1 after an error. */
int mcr_node_techniques(struct mcr_node *node, struct mcr_diagnostics *diagnostics, int has_lights);
/* The expression of a tree in normal form, in the arena. NULL when memory is short. */
const char *mcr_node_expression(struct mcr_arena *arena, const struct mcr_node *root);

#endif
