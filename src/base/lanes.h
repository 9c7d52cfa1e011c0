/* SPDX-License-Identifier: Apache-2.0 */
/* Loops over lanes: MCR_LANES before a `for` promises that its iterations are independent, so that it may be vectorised. */
#ifndef MCR_BASE_LANES_H
#define MCR_BASE_LANES_H

#if defined(__clang__)
#define MCR_LANES _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define MCR_LANES _Pragma("GCC ivdep")
#else
#define MCR_LANES
#endif

/* Lane counts and sizes of arrays are rounded up to this many doubles: one cache line, the widest vector. */
#define MCR_LANE_PAD 8u

#endif
