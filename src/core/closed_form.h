/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The unoccluded direct light of an emitter in closed form: the integral of the cosine over the directions in which it is seen above the horizon of
 * a surface point, in [0, pi]: pi times the form factor. Times radiance it is the irradiance. Private to src/core.
 */
#ifndef MCR_CORE_CLOSED_FORM_H
#define MCR_CORE_CLOSED_FORM_H

#include <stdint.h>

#define MCR_POLYGON_MOST 4u

/*
 * A convex polygon of 3 or 4 corners, whichever way round, seen from `p` with the unit normal `n`. Lambert's formula over the part above the horizon
 * (Lambert, "Photometria", 1760; Baum, Rushmeier and Winget, "Improving radiosity solutions through the use of analytically determined form-factors",
 * 1989). Its terms cancel where the polygon is small: the error is about 1e-15 / solid angle relative.
 */
double mcr_polygon_cosine(const double corner[][3], uint32_t count, const double p[3], const double n[3]);

/* A sphere seen from outside, the part below the horizon left out (Naraghi, "Radiative view factors from spherical segments to planar surfaces", 1988). */
double mcr_sphere_cosine(const double c[3], double radius, const double p[3], const double n[3]);

#endif
