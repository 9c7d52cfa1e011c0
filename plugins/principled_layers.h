/* SPDX-License-Identifier: Apache-2.0 */
/* principled: what is above its base, coat and sheen: their directional albedos, their lobes, and what they let through. Formulas: principled.c. */
#ifndef PLUGINS_PRINCIPLED_LAYERS_H
#define PLUGINS_PRINCIPLED_LAYERS_H

#include <mcrender/math.h>
#include <mcrender/microfacet.h>

/* ---- directional albedos ---- */

#define COAT_LEAST 0.04 /* ((1.5 - 1) / (1.5 + 1))^2 */

/* Of the coat; on entry `e` holds what is lost. */
MCR_LOOP void coat_lanes(uint32_t n, const double *restrict coat, const double *restrict grazing, double *restrict e)
{
    for (uint32_t i = 0; i < n; i++)
        e[i] = coat[i] * ((1 - e[i]) * (COAT_LEAST + (1 - COAT_LEAST) * grazing[i]));
}

/*
 * Of white sheen, a polynomial in x = 2 sqrt(cos) - 1 (rows) and y = (2 roughness - 1.1) / 0.9, fitted to midpoint sums over 400 x 200 directions. It errs by
 * less than SHEEN_ERROR, which is added.
 */
#define SHEEN_ERROR 2.5e-3
#define SHEEN_LEAST 0.1
static const double sheen_albedo[14][12] = {
    {0.42738957, -0.037023806, -0.011840679, 0.040998604, -0.14358183, 0.19412687, 0.20446427, -0.33134095, -0.42158941, 0.51079737,
     0.20018866, -0.23882175},
    {-0.48390504, 0.4265285, -0.3649447, 0.27695521, -0.13527434, -0.1771005, 0.20089456, 0.35637461, -0.36070916, -0.41226155, 0.58514284,
     -0.17712668},
    {0.07880211, -0.21289409, 0.18065895, -0.0093059429, 2.2718776, -3.6557088, -6.1329187, 9.1240573, 10.048778, -12.52318, -5.2058498,
     6.0599342},
    {0.030857029, -0.074940446, 0.21272586, -0.57544717, -0.83263598, 3.3650205, 1.9879525, -7.9882471, -2.0472641, 8.9776052, -0.89274297,
     -2.1659619},
    {-0.043988189, 0.10710051, 0.57432305, -1.6521622, -6.9623334, 13.098504, 23.98154, -37.029219, -35.988036, 48.029858, 18.504501,
     -22.64918},
    {0.052881796, -0.096165083, -0.17056471, 1.14519, 1.8401675, -7.4849485, -4.8935115, 18.608511, 4.3077605, -19.324458, 0.42406112,
     5.6224018},
    {0.070114794, -0.17647121, -0.89685191, 2.9451839, 9.8311745, -21.144678, -33.862191, 59.209873, 48.040449, -73.106849, -23.105865,
     32.238816},
    {-0.12258457, 0.14114356, -0.30531589, -0.031581188, 1.7545149, 0.54787595, -8.5816918, 2.2699044, 14.871621, -7.3793525, -9.5747398,
     6.3400306},
    {-0.17036916, 0.27592927, 0.57573096, -2.6164251, -7.7450319, 19.344798, 24.865715, -51.701532, -33.369462, 60.685811, 14.551043,
     -24.795147},
    {0.25295138, -0.21649741, 0.91212685, -1.7509738, -5.8221405, 10.059464, 22.9684, -31.736383, -33.506257, 41.275456, 18.198046,
     -20.491915},
    {0.16734519, -0.22072956, -0.094965607, 1.1046786, 2.9646164, -8.8656499, -8.2770446, 22.205617, 10.274101, -24.724491, -3.5135945,
     9.0752358},
    {-0.23544861, 0.19325624, -0.8078485, 1.7645787, 4.8541165, -9.8815104, -18.801133, 29.684406, 26.594448, -36.790206, -14.171383,
     17.464532},
    {-0.069430635, 0.079254535, -0.058485493, -0.11408981, -0.29085149, 1.3599729, 0.2669822, -2.886294, -0.002469778, 2.8243877,
     -0.51402811, -0.63402355},
    {0.08893795, -0.074689338, 0.27504253, -0.60192588, -1.5204968, 3.2356647, 5.9572596, -9.6718914, -8.3642211, 11.841045, 4.4966991,
     -5.6114426},
};

MCR_INLINE double sheen_of(double cosine, double roughness)
{
    double r = roughness > SHEEN_LEAST ? roughness : SHEEN_LEAST, x = 2 * sqrt(cosine) - 1, y = (r - 0.55) * (1 / 0.45);
    double p = mcr_row12_(sheen_albedo[13], y);

    p = p * x + mcr_row12_(sheen_albedo[12], y);
    p = p * x + mcr_row12_(sheen_albedo[11], y);
    p = p * x + mcr_row12_(sheen_albedo[10], y);
    p = p * x + mcr_row12_(sheen_albedo[9], y);
    p = p * x + mcr_row12_(sheen_albedo[8], y);
    p = p * x + mcr_row12_(sheen_albedo[7], y);
    p = p * x + mcr_row12_(sheen_albedo[6], y);
    p = p * x + mcr_row12_(sheen_albedo[5], y);
    p = p * x + mcr_row12_(sheen_albedo[4], y);
    p = p * x + mcr_row12_(sheen_albedo[3], y);
    p = p * x + mcr_row12_(sheen_albedo[2], y);
    p = p * x + mcr_row12_(sheen_albedo[1], y);
    p = p * x + mcr_row12_(sheen_albedo[0], y);
    p = (p > 0 ? p : 0) + SHEEN_ERROR;
    return p;
}

MCR_LOOP void sheen_lanes(uint32_t n, const double *restrict roughness, const double *restrict cosine, double *restrict e)
{
    for (uint32_t i = 0; i < n; i++)
        e[i] = sheen_of(cosine[i], roughness[i]);
}

/* ---- lobes ---- */

/* GGX of facets becomes the coat's. */
MCR_LOOP void coated_lanes(uint32_t n, const double *restrict coat, const double *restrict cosine, double *restrict value)
{
    for (uint32_t i = 0; i < n; i++)
        value[i] *= coat[i] * mcr_fresnel_schlick(cosine[i], COAT_LEAST);
}

/*
 * White sheen, f cos. D = (2 + 1/alpha) sin^(1/alpha) / (2 pi) of the half vector's angle to the normal; its sine is that of the part across the normal.
 */
MCR_LOOP void fibre_lanes(const struct mcr_points *at, const double *restrict roughness, const double *restrict x, const double *restrict y,
                          const double *restrict z, const double *restrict above, const double *restrict below, double *restrict value)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_vector n = mcr_vector(nx[i], ny[i], nz[i]), h = mcr_vector(ox[i] + x[i], oy[i] + y[i], oz[i] + z[i]);
        double o = mcr_dot(n, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_dot(n, mcr_vector(x[i], y[i], z[i])), up = o + w;
        double length2 = mcr_dot(h, h), sine2 = 1 - up * up / (length2 > 0 ? length2 : 1), r = roughness[i] > SHEEN_LEAST ? roughness[i] : SHEEN_LEAST;
        double inverse = 1 / (r * r), most = above[i] > below[i] ? above[i] : below[i], d, shadow = o + w - o * w;
        int seen = (o > MCR_GGX_HORIZON) & (w > MCR_GGX_HORIZON);

        sine2 = sine2 > 1e-300 ? sine2 : 1e-300;
        d = (2 + inverse) * mcr_exp(0.5 * inverse * mcr_log(sine2)) * (0.5 * MCR_PER_PI);
        d = d * w / (4 * (seen ? shadow : 1) * (most > 1 ? most : 1));
        value[i] = seen ? d : 0;
    }
}

/*
 * What the layers let through, and where: `over` is what is under the coat, `under` what is under sheen, too; 0 where the shading normal and the geometric
 * one do not agree on w's side. `crossed`: 1 on the other side.
 */
MCR_LOOP void cover_lanes(const struct mcr_points *at, const double *restrict x, const double *restrict y, const double *restrict z,
                          const double *restrict coat_o, const double *restrict coat_w, const double *restrict sheen_o, const double *restrict sheen_w,
                          const double *restrict tint, double *restrict over, double *restrict under, double *restrict crossed)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *gx = at->gx, *gy = at->gy, *gz = at->gz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        double o = nx[i] * ox[i] + ny[i] * oy[i] + nz[i] * oz[i], w = nx[i] * x[i] + ny[i] * y[i] + nz[i] * z[i];
        double side = gx[i] * x[i] + gy[i] * y[i] + gz[i] * z[i], sheen = sheen_o[i] > sheen_w[i] ? sheen_o[i] : sheen_w[i];
        double coat = coat_o[i] > coat_w[i] ? coat_o[i] : coat_w[i];
        int right = (o > MCR_GGX_HORIZON) & (fabs(w) > MCR_GGX_HORIZON) & (w < 0 ? side < 0 : side > 0);

        over[i] = right ? 1 - coat : 0;
        under[i] = over[i] * (1 - tint[i] * (sheen < 1 ? sheen : 1));
        crossed[i] = w < 0 ? 1 : 0;
    }
}

/* The base, `out`, under the layers, of one colour. */
MCR_LOOP void layers_lanes(uint32_t n, const double *restrict over, const double *restrict under, const double *restrict crossed, const double *restrict coated,
                           const double *restrict fibres, const double *restrict sheen, double *restrict out)
{
    for (uint32_t i = 0; i < n; i++) {
        double f = out[i] * under[i] + fibres[i] * sheen[i] * over[i], all = f + (over[i] > 0 && crossed[i] == 0 ? coated[i] : 0);
        out[i] = all;
    }
}

#endif
