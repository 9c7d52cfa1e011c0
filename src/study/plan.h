/* SPDX-License-Identifier: Apache-2.0 */
/* From what the scene's block and the options ask for to a complete plan. */
#ifndef MCR_STUDY_PLAN_H
#define MCR_STUDY_PLAN_H

#include "study/study.h"

/* The most renders of one study: cells times runs. */
#define MCR_STUDY_RUNS_LIMIT 100000u
/* A reference is rendered in so many independent parts, whose spread tells its noise: seeds reference_seed ... + 15. */
#define MCR_REFERENCE_PARTS 16u

/*
 * The plan of scene->study, which is not NULL, in the arena. `scene_name`: as it was given. The baseline is the first sampler where none is named:
 * who knows coverage decides (mcr_study_cells). reference_sampler is NULL where none is named. NULL after errors, which were recorded.
 */
struct mcr_study_plan *mcr_study_plan_create(struct mcr_arena *arena, struct mcr_diagnostics *diagnostics, const struct mcr_scene *scene,
                                             const char *scene_name);

/* The renders of each cell: the greater of runs and seeds. */
static inline uint32_t mcr_study_rounds(const struct mcr_study_plan *plan)
{
    return plan->runs > plan->seeds ? plan->runs : plan->seeds;
}

/* The reference's parts: fewer where it has fewer samples. */
static inline uint32_t mcr_study_parts(const struct mcr_study_plan *plan)
{
    return plan->reference_spp < MCR_REFERENCE_PARTS ? plan->reference_spp : MCR_REFERENCE_PARTS;
}

/* The number of cells; the limit above was checked. */
uint32_t mcr_study_cell_count(const struct mcr_study_plan *plan);

#endif
