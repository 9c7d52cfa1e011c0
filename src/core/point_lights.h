/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Lights without an extent: points, spots and parallel suns. No density draws them, so that at each scattering event, under every sampler, one of them
 * is chosen and a shadow ray is traced to it.
 */
#ifndef MCR_CORE_POINT_LIGHTS_H
#define MCR_CORE_POINT_LIGHTS_H

#include "base/arena.h"
#include "scene/scene.h"

struct mcr_batch;
struct mcr_range;

/*
 * The lights: suns first, then the others in the order of the tree's leaves. One is chosen with a probability in proportion to its luminance on a surface
 * that faces it, spots and suns that cannot be seen from the surface at all left out: among `direct` candidates, of which the last may stand for the
 * tree. In the tree each step goes to one of two children by what their boxes can give (Conty Estevez and Kulla, "Importance sampling of many lights
 * with adaptive tree splitting", 2018).
 */
struct mcr_point_lights {
    uint32_t count, suns;
    const struct mcr_scene_light *light;
    const double *luminance;             /* of `colour` */
    const struct mcr_point_node *node;   /* NULL: few */
};

/* What the estimate of a light may be at most, so that sums stay finite. */
#define MCR_MOST_ESTIMATE 1e280

/* *lights is set to NULL where the scene has none. Returns 0, or -1 when memory is short. */
int mcr_point_lights_create(struct mcr_arena *arena, const struct mcr_scene *scene, const struct mcr_point_lights **lights);

/* For the points of a range: adds what one light sends straight to each. Returns 0, or a plugin's failure. */
int32_t mcr_point_lights_add(struct mcr_batch *batch, const struct mcr_range *range);

#endif
