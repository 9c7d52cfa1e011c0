/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mcrender plugin interface: light that meets more than one microfacet of a rough clear interface, for materials. microfacet.h has what meets one.
 *
 * One facet sends the share E(c) of the light on, reflected or refracted; the rest, 1 - E(c), is lost there: shadowed, or sent to the wrong side. Kulla and
 * Conty, "Revisiting physically based shading at Imageworks" (2017), give it back in two diffuse lobes. With n the index of the other side, j, over that of
 * the outgoing direction's, i, L = 1 - E, <L> its mean weighted by the cosine, and F the mean of Fresnel's reflectance seen from i:
 *
 *     f cos = b L_i(o) L_j(w) |cos_w| / (pi <L_j> n^2)    transmitted, for radiance, with b = (1 - F) <L_j> / (<L_i> + <L_j>)
 *     f cos = (1 - b) L_i(o) L_i(w) cos_w / (pi <L_i>)    reflected
 *
 * 1 - F is n^2 times what it is seen from j, so that n^2 f is the same both ways; and E + (1 - b) L + b L = 1, on both sides.
 *
 * L is a table over the cosine, alpha and the index, of midpoint sums over 800 x 320 visible normals (tests/plugins/glass_table.py makes it). For indices
 * from 1.02 to 4, their inverses, and alpha from 1e-3 on, all light is kept to 2.5e-4 in 99 of 100 places and to 1.5e-3 in the worst, at the horizon.
 * Above an index of 4 less comes back than is lost; between 1 / 1.02 and 1.02, and below that alpha, nothing does.
 */
#ifndef MCRENDER_GLASS_H
#define MCRENDER_GLASS_H

#include <mcrender/glass_table.h>
#include <mcrender/microfacet.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MCR_GLASS_ALPHA 1e-3 /* the least of the table */
#define MCR_GLASS_INDEX 1.02

/* ---- the table ---- */

/*
 * It has three parts, for n > 1, 1 > n > 1 / sqrt(2) (where light that falls straight down on a facet of 45 degrees is reflected totally) and smaller n. A
 * part is Chebyshev polynomials of s = sqrt((m - 1) / (m + 1)), m being n or 1 / n, whose coefficients are such polynomials of
 * alpha (1 + sigma) / (alpha + sigma), sigma = sqrt(1 - 1 / m^2) being the cosine of the angle of total reflection, whose coefficients are those of uniform
 * cubic B-splines in place_ of L (c + alpha) / alpha. Means are polynomials of s with splines in the fourth root of the second coordinate, of <L> / alpha.
 */
struct mcr_glass_slice_ {
    double n, sigma; /* the index, and sigma */
    uint32_t part;
    double lost[MCR_GLASS_WIDTHS_][MCR_GLASS_SPLINES_], mean[MCR_GLASS_SPLINES_];
};

/* n sums of the polynomials T_k(x), k < count, times `scale`. */
MCR_LOOP void mcr_glass_blend_(uint32_t n, const int32_t *restrict coefficient, uint32_t count, double x, double scale, double *restrict out)
{
    double before = MCR_GLASS_UNIT_ * scale, t = before * x;

    for (uint32_t i = 0; i < n; i++)
        out[i] = before * coefficient[i] + t * coefficient[n + i];
    for (uint32_t k = 2; k < count; k++) {
        const int32_t *row = coefficient + (uint64_t)k * n;
        double next = 2 * x * t - before;

        before = t, t = next;
        for (uint32_t i = 0; i < n; i++)
            out[i] += next * row[i];
    }
}

/* What the table has for one index, `lost` if that is asked for; 0 if the index is too close to 1. */
MCR_LOOP int mcr_glass_slice_of_(double n, int lost, struct mcr_glass_slice_ *slice)
{
    static const double low[3] = {MCR_GLASS_S1_02_, MCR_GLASS_S1_02_, MCR_GLASS_S1_41_}, high[3] = {MCR_GLASS_S4_, MCR_GLASS_S1_41_, MCR_GLASS_S4_};
    double m = n > 1 ? n : 1 / n, s = sqrt((m - 1) / (m + 1)), inside = s < MCR_GLASS_S4_ ? s : MCR_GLASS_S4_, x;
    double left = (1 - s) / (1 - inside), scale = left * left * left;
    uint32_t part = n > 1 ? 0 : s < MCR_GLASS_S1_41_ ? 1 : 2;

    if (!(m >= MCR_GLASS_INDEX))
        return 0;
    x = 2 * (inside - low[part]) / (high[part] - low[part]) - 1;
    slice->n = n;
    slice->sigma = sqrt((1 - 1 / m) * (1 + 1 / m));
    slice->part = part;
    if (lost)
        mcr_glass_blend_(MCR_GLASS_WIDTHS_ * MCR_GLASS_SPLINES_, mcr_glass_lost_[part][0][0], MCR_GLASS_INDICES_, x, scale, slice->lost[0]);
    mcr_glass_blend_(MCR_GLASS_SPLINES_, mcr_glass_mean_[part][0], MCR_GLASS_MEANS_, x, scale, slice->mean);
    return 1;
}

/* Where on the splines, in [0, 1], the cosine c is: finer at c = 0 and at 1, and at sigma where n < 1, as wide as alpha. */
MCR_INLINE double mcr_glass_place_(double c, double alpha, double sigma, double total)
{
    double grazing = sqrt(c * (1 + alpha) / (c + alpha)), upright = 1 - sqrt(1 - c), wide = 4 * alpha * alpha, d = c - sigma, e = 1 - sigma;
    double first = sigma / sqrt(sigma * sigma + wide), last = e / sqrt(e * e + wide), edge = (d / sqrt(d * d + wide) + first) / (last + first);
    double above = 0.6 * grazing + 0.4 * upright, below = 0.5 * grazing + 0.25 * upright + 0.25 * edge;

    return total > 0 ? below : above;
}

MCR_INLINE double mcr_glass_width_(double alpha, double sigma) { return alpha * (1 + sigma) / (alpha + sigma); }

/* The interval of y in [0, 1], and the weights of its four coefficients. */
MCR_INLINE int32_t mcr_glass_knot_(double y, double w[4])
{
    double p = mcr_within_unit_(y) * (MCR_GLASS_SPLINES_ - 3), k = floor(p), f, g;

    k = k < MCR_GLASS_SPLINES_ - 4 ? k : MCR_GLASS_SPLINES_ - 4;
    f = p - k, g = 1 - f;
    w[0] = g * g * g * (1.0 / 6), w[3] = f * f * f * (1.0 / 6);
    w[1] = (4 + 3 * f * f * (f - 2)) * (1.0 / 6), w[2] = (4 + 3 * g * g * (g - 2)) * (1.0 / 6);
    return (int32_t)k;
}

/* The splines' coefficients for one alpha, by the sums that mcr_glass_each_ makes. */
MCR_LOOP void mcr_glass_line_(const struct mcr_glass_slice_ *slice, double alpha, double *restrict line)
{
    double x = 2 * mcr_glass_width_(alpha, slice->sigma) - 1, before = 1, t = x;

    for (uint32_t i = 0; i < MCR_GLASS_SPLINES_; i++)
        line[i] = slice->lost[0][i] + x * slice->lost[1][i];
    for (uint32_t j = 2; j < MCR_GLASS_WIDTHS_; j++) {
        double next = 2 * x * t - before;
        before = t, t = next;
        for (uint32_t i = 0; i < MCR_GLASS_SPLINES_; i++)
            line[i] += next * slice->lost[j][i];
    }
}

/* Lanes of the slice's index and of one alpha. */
MCR_LOOP void mcr_glass_same_(uint32_t n, const struct mcr_glass_slice_ *slice, const double *restrict line, const double *restrict alpha,
                              const double *restrict ratio, const double *restrict cosine, double *restrict lost)
{
    const double index = slice->n, sigma = slice->sigma, total = slice->part ? 1 : 0;

    for (uint32_t i = 0; i < n; i++) {
        double c = mcr_within_unit_(cosine[i]), w[4], value;
        int32_t k = mcr_glass_knot_(mcr_glass_place_(c, alpha[i], sigma, total), w);

        value = w[0] * line[k] + w[1] * line[k + 1] + w[2] * line[k + 2] + w[3] * line[k + 3];
        value = mcr_within_unit_(value * alpha[i] / (c + alpha[i]));
        lost[i] = ratio[i] == index ? value : lost[i];
    }
}

/* Of any alpha. */
MCR_LOOP void mcr_glass_each_(uint32_t n, const struct mcr_glass_slice_ *slice, const double *restrict alpha, const double *restrict ratio,
                              const double *restrict cosine, double *restrict lost)
{
    const double index = slice->n, sigma = slice->sigma, total = slice->part ? 1 : 0;
    const double *restrict all = &slice->lost[0][0];

    for (uint32_t i = 0; i < n; i++) {
        double c = mcr_within_unit_(cosine[i]), x = 2 * mcr_glass_width_(alpha[i], sigma) - 1, w[4], value, before = 1, t = x, a[4];
        int32_t k = mcr_glass_knot_(mcr_glass_place_(c, alpha[i], sigma, total), w);

        for (int m = 0; m < 4; m++)
            a[m] = all[k + m] + x * all[MCR_GLASS_SPLINES_ + k + m];
        for (int32_t j = 2; j < MCR_GLASS_WIDTHS_; j++) {
            double next = 2 * x * t - before;
            before = t, t = next;
            for (int m = 0; m < 4; m++)
                a[m] += next * all[j * MCR_GLASS_SPLINES_ + k + m];
        }
        value = w[0] * a[0] + w[1] * a[1] + w[2] * a[2] + w[3] * a[3];
        value = mcr_within_unit_(value * alpha[i] / (c + alpha[i]));
        lost[i] = ratio[i] == index ? value : lost[i];
    }
}

MCR_LOOP void mcr_glass_means_(uint32_t n, const struct mcr_glass_slice_ *slice, const double *restrict alpha, const double *restrict ratio,
                               double *restrict mean)
{
    const double index = slice->n, sigma = slice->sigma;
    const double *restrict c = slice->mean;

    for (uint32_t i = 0; i < n; i++) {
        double w[4], value;
        int32_t k = mcr_glass_knot_(sqrt(sqrt(mcr_glass_width_(alpha[i], sigma))), w);

        value = alpha[i] * (w[0] * c[k] + w[1] * c[k + 1] + w[2] * c[k + 2] + w[3] * c[k + 3]);
        mean[i] = ratio[i] == index ? mcr_within_unit_(value) : mean[i];
    }
}

/*
 * L by alpha, the relative index and the cosine (NULL: it is not asked for, and not stored), and its mean. The lanes of one index are done together; a lane's
 * bits do not depend on the others.
 */
MCR_LOOP void mcr_glass_lost_lanes(uint32_t n, const double *alpha, const double *ratio, const double *cosine, double *lost, double *mean)
{
    struct mcr_glass_slice_ slice;
    double line[MCR_GLASS_SPLINES_];
    int same = 1;

    for (uint32_t i = 1; i < n && same; i++)
        same = alpha[i] == alpha[0];
    mcr_fill_lanes(n, -1, mean);
    if (cosine)
        mcr_fill_lanes(n, 0, lost);
    for (uint32_t i = 0; i < n; i++) {
        if (!(mean[i] < 0) || !(alpha[i] >= MCR_GLASS_ALPHA) || !mcr_glass_slice_of_(ratio[i], cosine != NULL, &slice))
            continue;
        mcr_glass_means_(n, &slice, alpha, ratio, mean);
        if (cosine && same) {
            mcr_glass_line_(&slice, alpha[0], line);
            mcr_glass_same_(n, &slice, line, alpha, ratio, cosine, lost);
        } else if (cosine)
            mcr_glass_each_(n, &slice, alpha, ratio, cosine, lost);
    }
    for (uint32_t i = 0; i < n; i++)
        mean[i] = mean[i] > 0 && alpha[i] >= MCR_GLASS_ALPHA ? mean[i] : 0;
    for (uint32_t i = 0; i < n && cosine; i++)
        lost[i] = mean[i] > 0 ? lost[i] : 0;
}

/* ---- the lobes ---- */

/* 1 - F, for n > 1 by Kulla's and Conty's fit. */
MCR_INLINE double mcr_glass_mean_passed_(double n)
{
    double inverse = 1 / n, m = n > 1 ? n : inverse, passed = 1 - (m - 1) / (4.08567 + 1.00071 * m), scaled = passed * (n * n);
    return n > 1 ? passed : scaled;
}

/*
 * By the means on both sides: what L(o) L(w) |cos_w| is to be multiplied by, `up` for what is reflected, and `down`; `share`: b. All 0 where nothing comes
 * back.
 */
MCR_LOOP void mcr_glass_lobe_lanes(uint32_t n, const double *restrict ratio, const double *restrict mean, const double *restrict mean_beyond, double *restrict up,
                                   double *restrict down, double *restrict share)
{
    for (uint32_t i = 0; i < n; i++) {
        double here = mean[i], beyond = mean_beyond[i], passed = mcr_glass_mean_passed_(ratio[i]), both = here + beyond, b, above, below;
        int some = (here > 0) & (beyond > 0);

        passed = passed / (some ? both : 1);
        b = passed * beyond;
        above = (1 - b) * MCR_PER_PI / (some ? here : 1);
        below = passed * MCR_PER_PI / (ratio[i] * ratio[i]);
        up[i] = some ? above : 0;
        down[i] = some ? below : 0;
        share[i] = some ? b : 0;
    }
}

/*
 * Of a wall of two interfaces, which passes light as it reflects it, L is that of GGX (mcr_ggx_lost) on both sides. Where a facet reflects r and passes t of
 * the light from everywhere, of one colour, what comes back is (r + t)^2 (1 - <L>) / (1 - (r + t) <L>), as of a metal of reflectance r + t, in the
 * proportions r : t.
 */
MCR_INLINE void mcr_glass_wall(double alpha, double r, double t, double *up, double *down)
{
    double lost = mcr_ggx_mean_lost(alpha), all = r + t, again = all * (1 - lost) / (1 - all * lost) * MCR_PER_PI / lost;

    *up = again * r;
    *down = again * t;
}

/* Adds the lobes to f cos of one colour. `side`: 1 above, -1 below, 0 where w is on the wrong side. */
MCR_LOOP void mcr_glass_add_lanes(uint32_t n, const double *restrict lost_o, const double *restrict lost_w, const double *restrict cosine_w,
                                  const double *restrict side, const double *restrict up, const double *restrict down, double *restrict out)
{
    for (uint32_t i = 0; i < n; i++) {
        double f = lost_o[i] * lost_w[i] * cosine_w[i], lobe = f * (side[i] > 0 ? up[i] : down[i]);
        out[i] += side[i] != 0 ? lobe : 0;
    }
}

/* ---- drawing ---- */

/*
 * The lobes are drawn with the chance L(o), the share b of them below, and of both alpha in proportion to the cosine and 1 - alpha uniformly over the hemisphere:
 * of little roughness L is high at grazing angles. A number that does not choose them becomes the facet's.
 */
MCR_LOOP void mcr_glass_choice_lanes(uint32_t n, const double *restrict choice, const double *restrict lost, double *restrict rest)
{
    for (uint32_t i = 0; i < n; i++) {
        double left = 1 - lost[i], r = (choice[i] - lost[i]) / (left > 0 ? left : 1);
        r = r > 0 ? r : 0;
        rest[i] = r < 1 ? r : 0x1.fffffffffffffp-1;
    }
}

/* Puts the lobes' directions where the number chose them. */
MCR_LOOP void mcr_glass_draw_lanes(const struct mcr_points *at, const double *const t[3], const double *const *number, const double *restrict alpha,
                                   const double *restrict lost, const double *restrict share, double *restrict x, double *restrict y, double *restrict z)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz, *tx = t[0], *ty = t[1], *tz = t[2];
    const double *u = number[0], *v = number[1], *choice = number[2];

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_frame f = mcr_frame(mcr_vector(nx[i], ny[i], nz[i]), mcr_vector(tx[i], ty[i], tz[i]));
        double cut = lost[i] * share[i], first = cut * (1 - alpha[i]), second = (lost[i] - cut) * (1 - alpha[i]), above;
        int chosen = choice[i] < lost[i], down = choice[i] < cut, even = choice[i] < (down ? first : cut + second), seen;
        /* the point of the disk below a direction of the cosine lobe; drawn in, below one of the even lobe: height = 1 - radius^2 */
        double px, py, rest = mcr_disk_from_square(u[i], v[i], &px, &py), wide = sqrt(1 + rest), high = sqrt(rest);
        double o = mcr_dot(f.n, mcr_vector(ox[i], oy[i], oz[i])), height = even ? rest : high;
        struct mcr_vector w;

        wide = even ? wide : 1;
        w = mcr_from_frame(f, mcr_vector(px * wide, py * wide, down ? -height : height));
        above = mcr_dot(f.n, w);
        seen = (o > MCR_GGX_HORIZON) & (down ? above < -MCR_GGX_HORIZON : above > MCR_GGX_HORIZON);
        w.x = seen ? w.x : 0;
        w.y = seen ? w.y : 0;
        w.z = seen ? w.z : 0;
        x[i] = chosen ? w.x : x[i];
        y[i] = chosen ? w.y : y[i];
        z[i] = chosen ? w.z : z[i];
    }
}

/* The facets' density becomes that of both. */
MCR_LOOP void mcr_glass_density_lanes(const struct mcr_points *at, const double *restrict alpha, const double *restrict lost, const double *restrict share,
                                      const double *restrict x, const double *restrict y, const double *restrict z, double *restrict density)
{
    const double *nx = at->nx, *ny = at->ny, *nz = at->nz, *ox = at->ox, *oy = at->oy, *oz = at->oz;

    for (uint32_t i = 0; i < at->n; i++) {
        struct mcr_vector n = mcr_vector(nx[i], ny[i], nz[i]);
        double o = mcr_dot(n, mcr_vector(ox[i], oy[i], oz[i])), w = mcr_dot(n, mcr_vector(x[i], y[i], z[i]));
        double shape = (alpha[i] * fabs(w) + 0.5 * (1 - alpha[i])) * MCR_PER_PI, lobe = lost[i] * shape * (w < 0 ? share[i] : 1 - share[i]), all = (1 - lost[i]) * density[i] + lobe;
        int seen = (o > MCR_GGX_HORIZON) & (fabs(w) > MCR_GGX_HORIZON);

        density[i] = seen ? all : 0;
    }
}

#ifdef __cplusplus
}
#endif

#endif
