/* SPDX-License-Identifier: Apache-2.0 */
/* The table of stages of one instruction set. Compiled once per instruction set. */
#include "core/stages.h"

const struct mcr_stages MCR_ISA_NAME(mcr_stages) = {
    MCR_ISA_NAME(mcr_stage_begin), MCR_ISA_NAME(mcr_stage_camera),     MCR_ISA_NAME(mcr_stage_sort),    MCR_ISA_NAME(mcr_stage_surface),
    MCR_ISA_NAME(mcr_stage_chart), MCR_ISA_NAME(mcr_stage_cones), MCR_ISA_NAME(mcr_stage_coordinates),
    MCR_ISA_NAME(mcr_stage_emit),  MCR_ISA_NAME(mcr_stage_background), MCR_ISA_NAME(mcr_stage_mirror),  MCR_ISA_NAME(mcr_stage_scatter), MCR_ISA_NAME(mcr_stage_unsound),
    MCR_ISA_NAME(mcr_stage_compact),
    MCR_ISA_NAME(mcr_stage_gather),
    MCR_ISA_NAME(mcr_stage_point_choose), MCR_ISA_NAME(mcr_stage_point_aim), MCR_ISA_NAME(mcr_stage_point_add),
};
