/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The founding study's quirks in the core, for scenes that ask for them (render { compat … }); all others do without. Private to src/core.
 *
 * Clamp. The study's recursion hands back L_b = min(1, e_b + w_b L_(b+1)) in each channel from every hit b: e_b what is emitted there (and what look-ups
 * find), w_b >= 0 the weight of what comes in. As a function of what comes in behind the last hit so far, x, the camera's radiance is min(c, a + m x):
 * so it is before the first hit (c infinite, a = 0, m = 1), and min(c, a + m min(1, e + w x)) = min(min(c, a + m), (a + m e) + m w x). a is what the
 * path's slot holds already and m its throughput: only the cap c is kept beside them, whatever the depth.
 */
#ifndef MCR_CORE_COMPAT_H
#define MCR_CORE_COMPAT_H

#include "core/batch.h"

/*
 * Before rays are traced: ends those that are not to be. background-at-limit: behind the last scattering event the background is seen, whatever is there.
 * floor-sqrt: samples beyond floor(sqrt(planned))^2 stay black.
 */
void mcr_compat_end_rays(struct mcr_batch *batch);
/* clamp: lowers the caps of all points, before anything of their hit is added. */
void mcr_compat_lower_caps(struct mcr_batch *batch);
/* clamp: slots first .. first+n-1 are new; and they are finished. */
void mcr_compat_raise_caps(struct mcr_batch *batch, size_t first, uint32_t n);
void mcr_compat_clamp(struct mcr_batch *batch, size_t first, uint32_t n);

#endif
