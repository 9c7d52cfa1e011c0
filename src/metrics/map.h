/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures of the error: where it is. */
#ifndef MCR_METRICS_MAP_H
#define MCR_METRICS_MAP_H

#include "metrics/metrics.h"

/* Of each value: e = a - r, |e|, or |e| / sqrt(r^2 + 0.01 L^2), whose mean square is relmse. */
enum mcr_map_kind { MCR_MAP_SIGNED, MCR_MAP_ABSOLUTE, MCR_MAP_RELATIVE, MCR_MAP_KINDS };
extern const char *const mcr_map_kind_name[MCR_MAP_KINDS];

/*
 * The error of each encoded value within the region, channels R, G, B or Y; NaN where a pixel takes no part. The images are such as mcr_metrics_compare
 * accepted. NULL after a failure, with the reason.
 */
struct mcr_image *mcr_map_create(const struct mcr_image *image, const struct mcr_image *reference, const struct mcr_metrics_options *options,
                                 enum mcr_map_kind kind, char *error, size_t length);

/* The largest absolute value of what mcr_map_colour shows: of the channels' mean. */
double mcr_map_largest(const struct mcr_image *map);

/*
 * In false colour, linear R, G, B: the mean of the channels, from 0 (dark blue) by purple and orange to `range` (light yellow); of a signed map from -range
 * (blue) by white to range (red). Values beyond have the last colour, pixels that take no part are grey. The CIE lightness of the colours rises, or falls
 * to both sides, in equal steps. range > 0. NULL when memory is short.
 */
struct mcr_image *mcr_map_colour(const struct mcr_image *map, enum mcr_map_kind kind, double range);

#endif
