/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Unoccluded direct light as a control variate, for techniques with MCR_TECHNIQUE_CONTROL. At a Lambertian point (MCR_MATERIAL_LAMBERTIAN, its shading normal
 * the geometric one) an emitter that radiates alike everywhere (MCR_MATERIAL_EVEN), a polygon or a sphere, sheds
 *     rho/pi Le E - (what hides it of that),     E in closed form (closed_form.h).
 * The first term is added as it is; the technique's points estimate the second: those that are hidden count -f Le / density, those that are seen nothing.
 * Where nothing is hidden there is no noise. What the path's own direction finds of such an emitter is in it already, and counts 0.
 * All other points and emitters are combined as ever: emitters seen under less than MCR_CONTROL_LEAST too, where the closed form loses digits. So is
 * everything in scenes with more emitters than MCR_CONTROL_EMITTERS, since the closed forms of all are summed at each point, and where light may pass
 * through surfaces.
 * J. Hammersley and D. Handscomb, "Monte Carlo Methods", 1964, 5.5. Private to src/core.
 */
#ifndef MCR_CORE_CONTROL_H
#define MCR_CORE_CONTROL_H

#include "core/batch.h"

/* Most emitters of which the closed forms are summed. */
#define MCR_CONTROL_EMITTERS 16u
/* Area over distance^2 below which the closed form is not used: it keeps 9 digits there. */
#define MCR_CONTROL_LEAST 1e-6

/* Which of the sampler's techniques controls, and which emitters can be. Returns 0, or -1 when memory is short. After the emitters and groups are there. */
int mcr_control_init(struct mcr_core *core, struct mcr_arena *arena);

/* At the points of a range: which are controlled, and their unoccluded light. Before the range's look-ups. Returns 0 or a plugin's failure. */
int32_t mcr_control_add(struct mcr_batch *batch, const struct mcr_range *range);

#endif
