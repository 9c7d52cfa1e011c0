/* SPDX-License-Identifier: Apache-2.0 */
#include "core/closed_form.h"

#include <math.h>

#include "base/elementary.h"
#include "scene/vector.h"

/* The polygon's corners relative to p, cut off at the horizon: one more than there were at most. Returns their number. */
static uint32_t clip(const double corner[][3], uint32_t count, const double p[3], const double n[3], double out[][3])
{
    double from[3], height;
    uint32_t kept = 0;
    mcr_subtract(corner[count - 1], p, from);
    height = mcr_dot(from, n);
    for (uint32_t i = 0; i < count; i++) {
        double to[3], above;
        mcr_subtract(corner[i], p, to);
        above = mcr_dot(to, n);
        if ((height > 0) != (above > 0)) {
            double share = height / (height - above);
            for (int j = 0; j < 3; j++)
                out[kept][j] = from[j] + share * (to[j] - from[j]);
            kept++;
        }
        if (above > 0)
            mcr_copy(to, out[kept++]);
        mcr_copy(to, from);
        height = above;
    }
    return kept;
}

double mcr_polygon_cosine(const double corner[][3], uint32_t count, const double p[3], const double n[3])
{
    double v[MCR_POLYGON_MOST + 1][3], sum = 0;
    uint32_t kept = clip(corner, count, p, n, v);
    for (uint32_t i = 0; i < kept; i++) {
        const double *a = v[i], *b = v[(i + 1) % kept];
        double c[3], length;
        mcr_cross(a, b, c);
        length = sqrt(mcr_dot(c, c));
        if (length > 0) /* the edge's angle, and how far its plane leans from the horizon */
            sum += mcr_atan2(length, mcr_dot(a, b)) * mcr_dot(c, n) / length;
    }
    return 0.5 * fabs(sum);
}

double mcr_sphere_cosine(const double c[3], double radius, const double p[3], const double n[3])
{
    double to[3], square, distance, height, x, y, sine, root;
    mcr_subtract(c, p, to);
    square = mcr_dot(to, to);
    distance = sqrt(square);
    height = mcr_dot(to, n);
    if (!(distance > radius))
        return 0;
    if (height >= radius)
        return MCR_PI * (radius / distance) * (radius / distance) * (height / distance);
    if (height <= -radius)
        return 0;
    /* It crosses the horizon: with the distance H in radii, x = sqrt(H^2 - 1), y = -x cot(angle to the normal). */
    x = sqrt((distance - radius) * (distance + radius)) / radius;
    sine = mcr_length((double[3]){to[0] - height * n[0], to[1] - height * n[1], to[2] - height * n[2]}) / distance;
    y = mcr_clamp(-x * (height / distance) / sine, -1, 1);
    root = sqrt((1 - y) * (1 + y));
    return (height / distance * mcr_acos(y) - x * sine * root) * (radius * radius / square) + mcr_atan2(sine * root, x);
}
