/* SPDX-License-Identifier: Apache-2.0 */
/* The colour of a black body, by Planck's law. */
#ifndef MCR_LANGUAGE_BLACKBODY_H
#define MCR_LANGUAGE_BLACKBODY_H

/* Kelvin. Below, all is as red as Rec. 709 can be long since; above, colours no longer change. */
#define MCR_BLACKBODY_LEAST 500.0
#define MCR_BLACKBODY_MOST 1e6

/*
 * Linear Rec. 709, of luminance 0.2126 R + 0.7152 G + 0.0722 B = 1. What the primaries cannot mix (blue below 1900 K, green below 960 K would be
 * negative) is clamped to 0 before the luminance is made 1.
 */
void mcr_blackbody(double kelvin, double rgb[3]);

#endif
