/* SPDX-License-Identifier: Apache-2.0 */
/* What stage files need: names of their own per instruction set, and loops over lanes. Private to the accelerators' stage files. */
#ifndef MCR_ACCEL_ISA_H
#define MCR_ACCEL_ISA_H

#include "accel/accel.h"
#include "base/lanes.h"
#include <mcrender/plugin.h>

void MCR_ISA_NAME(mcr_list_closest)(const struct mcr_accel *accel, const struct mcr_rays *rays, double *t, int64_t *primitive);
void MCR_ISA_NAME(mcr_list_visible)(const struct mcr_accel *accel, const struct mcr_rays *rays, const double *far, double *visible);
void MCR_ISA_NAME(mcr_bvh_closest)(const struct mcr_accel *accel, const struct mcr_rays *rays, double *t, int64_t *primitive);
void MCR_ISA_NAME(mcr_bvh_visible)(const struct mcr_accel *accel, const struct mcr_rays *rays, const double *far, double *visible);

#endif
