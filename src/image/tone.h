/* SPDX-License-Identifier: Apache-2.0 */
/* Tone curves: from radiance without bounds to what 8 and 16 bits show, before it is encoded. */
#ifndef MCR_IMAGE_TONE_H
#define MCR_IMAGE_TONE_H

#include <stdint.h>

enum mcr_tone_curve {
    MCR_TONE_LINEAR,   /* as it is: what is above 1 is clipped */
    MCR_TONE_REINHARD, /* "Photographic tone reproduction for digital images" (Reinhard, Stark, Shirley and Ferwerda 2002), equation 4, of luminance */
    MCR_TONE_HABLE,    /* "Uncharted 2: HDR lighting" (J. Hable, GDC 2010), of each channel */
    MCR_TONE_ACES,     /* "ACES filmic tone mapping curve" (K. Narkowicz 2015), of each channel */
    MCR_TONE_COUNT
};
extern const char *const mcr_tone_name[MCR_TONE_COUNT];

#define MCR_TONE_LEAST_WHITE 1e-3
#define MCR_TONE_MOST_WHITE 1e10
#define MCR_TONE_MOST 1e200 /* magnitude of what is put through a curve */

/* white: the least value (luminance for reinhard) that becomes 1, within MCR_TONE_LEAST_WHITE and _MOST_WHITE; of reinhard and hable. Zeroed: linear. */
struct mcr_tone {
    uint32_t curve;
    double white;
};

/* Linear Rec. 709, already exposed, at most MCR_TONE_MOST, in place. What is not above 0 stays as it is, as does a colour that is not finite. */
void mcr_tone_apply(const struct mcr_tone *tone, double rgb[3]);

/* "linear", "reinhard(white=4)" */
#define MCR_TONE_TEXT 48u
void mcr_tone_text(const struct mcr_tone *tone, char text[MCR_TONE_TEXT]);

#endif
