/* SPDX-License-Identifier: Apache-2.0 */
/* The stage functions under the names of the instruction set that is being compiled. What they do: struct mcr_stages. Private to the stage files. */
#ifndef MCR_CORE_STAGES_H
#define MCR_CORE_STAGES_H

#include "core/batch.h"

void MCR_ISA_NAME(mcr_stage_camera)(const struct mcr_scene *scene, const struct mcr_camera_lanes *lanes);
void MCR_ISA_NAME(mcr_stage_begin)(struct mcr_batch *batch, const struct mcr_begin *begin);
void MCR_ISA_NAME(mcr_stage_sort)(struct mcr_batch *batch);
void MCR_ISA_NAME(mcr_stage_surface)(struct mcr_batch *batch);
void MCR_ISA_NAME(mcr_stage_chart)(const struct mcr_core *core, const struct mcr_chart_lanes *lanes);
void MCR_ISA_NAME(mcr_stage_cones)(struct mcr_batch *batch, uint32_t to, uint32_t ray, uint32_t n);
void MCR_ISA_NAME(mcr_stage_coordinates)(struct mcr_batch *batch);
void MCR_ISA_NAME(mcr_stage_emit)(struct mcr_batch *batch, uint32_t begin, uint32_t end);
void MCR_ISA_NAME(mcr_stage_background)(struct mcr_batch *batch);
void MCR_ISA_NAME(mcr_stage_mirror)(struct mcr_batch *batch, const struct mcr_range *range);
void MCR_ISA_NAME(mcr_stage_scatter)(struct mcr_batch *batch, const struct mcr_range *range);
int MCR_ISA_NAME(mcr_stage_unsound)(uint32_t n, const double *density, const struct mcr_directions *drawn);
void MCR_ISA_NAME(mcr_stage_compact)(struct mcr_batch *batch);
void MCR_ISA_NAME(mcr_stage_gather)(uint32_t n, const uint32_t *index, const double *table, double *out);
void MCR_ISA_NAME(mcr_stage_point_choose)(struct mcr_batch *batch, const struct mcr_range *range, int both);
uint32_t MCR_ISA_NAME(mcr_stage_point_aim)(struct mcr_batch *batch, const struct mcr_range *range);
void MCR_ISA_NAME(mcr_stage_point_add)(struct mcr_batch *batch, uint32_t rays);

#endif
