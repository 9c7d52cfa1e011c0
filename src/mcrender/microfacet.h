/* SPDX-License-Identifier: Apache-2.0 */
/*
 * mcrender plugin interface: rough interfaces of microfacets, for materials. Everything is compiled into the plugin, works on one lane without branches
 * and is meant for loops over lanes. All vectors are unit and in a frame with the shading normal as z (surface.h); o is the outgoing direction, w the one
 * toward which light is scattered; cosines are to the normal.
 *
 * The distribution of normals D is that of Trowbridge and Reitz, "Average irregularity representation of a rough surface for ray reflection" (1975), as
 * in Walter et al., "Microfacet models for refraction through rough surfaces" (2007), of width ax along the tangent and ay across. Shadowing and masking
 * G2 are Smith's, correlated by height: 1 / (1 + Lambda(o) + Lambda(w)), Heitz, "Understanding the masking-shadowing function in microfacet-based BRDFs"
 * (2014), section 6; also for transmitted light. Normals are drawn as o sees them, by a spherical cap: Dupuy and Benyoub, "Sampling visible GGX normals
 * with spherical caps" (2023).
 *
 * All is written in the normal's slope, so that nothing cancels or overflows down to MCR_GGX_LEAST, which is a lobe of 1e-7 rad: unit vectors in doubles
 * tell such a slope to about 1e-8 of it.
 */
#ifndef MCRENDER_MICROFACET_H
#define MCRENDER_MICROFACET_H

#include <mcrender/surface.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MCR_GGX_LEAST 1e-7     /* the smallest ax and ay: below, a surface is a mirror */
#define MCR_GGX_HORIZON 1e-100 /* cosines below count as 0, so that no product of two underflows */

/* ---- Fresnel: unpolarised reflectance at the cosine c in [0, 1] ---- */

/*
 * Of the real relative index n = beyond / here > 0; 1 where all is reflected. With q = n cos_t: r_s = (c - q) / (c + q) and r_p = (n^2 c - q) / (n^2 c + q),
 * whose differences are multiplied out by the sums, so that nothing cancels for n close to 1: r_s = (1 - n^2) / (c + q)^2 and
 * r_p = (n^2 - 1) ((n^2 + 1) c^2 - 1) / (n^2 c + q)^2. *q is 0 where all is reflected.
 */
MCR_INLINE double mcr_fresnel_dielectric(double c, double n, double *q)
{
    double above = c > MCR_GGX_HORIZON ? c : MCR_GGX_HORIZON, n2 = n * n, excess = (n - 1) * (n + 1), q2 = excess + c * c;
    double root = sqrt(q2 > 0 ? q2 : 0), sum = above + root, other = n2 * above + root;
    double s = excess / (sum * sum), p = excess * (n2 * above * above - (1 - above) * (1 + above)) / (other * other);
    double f = 0.5 * (s * s + p * p);

    *q = root;
    f = f < 1 ? f : 1;
    return q2 > 0 ? f : excess < 0 ? 1 : f;
}

/*
 * Of the index eta + i k. With eta^2 - k^2 - sin^2 + 2i eta k = (a + i b)^2: parallel and perpendicular part as quotients of squares, which do not
 * cancel; of a^2 and b^2 the smaller comes from the product a b = eta k.
 */
MCR_INLINE double mcr_fresnel_conductor(double c, double eta, double k)
{
    double s2 = (1 - c) * (1 + c), t = eta * eta - k * k - s2, ab = eta * k;
    double modulus = sqrt(t * t + 4 * ab * ab), larger = 0.5 * (modulus + fabs(t)), smaller = ab * ab / (larger > 0 ? larger : 1);
    double a2 = t > 0 ? larger : smaller, b2 = t > 0 ? smaller : larger, a = sqrt(a2);
    double across = ((a - c) * (a - c) + b2) / ((a + c) * (a + c) + b2);
    double minus = a * c - s2, plus = a * c + s2, below = plus * plus + b2 * c * c;
    double ratio = (minus * minus + b2 * c * c) / (below > 0 ? below : 1);

    ratio = below > 0 ? ratio : 1; /* 0/0 for eta = k = 0 at c = 1 alone: a perfect mirror */
    return 0.5 * (across + across * ratio);
}

/* (1 - c)^5 of Schlick, "An inexpensive BRDF model for physically-based rendering" (1994). */
MCR_INLINE double mcr_schlick_weight(double c)
{
    double m = 1 - c, m2 = m * m;
    return m2 * m2 * m;
}

/* Reflectance at normal incidence, rising to 1 at grazing incidence. */
MCR_INLINE double mcr_fresnel_schlick(double c, double reflectance) { return reflectance + (1 - reflectance) * mcr_schlick_weight(c); }

/* Gauss's and Legendre's rule of 8 points for means over the hemisphere, weighted by the cosine: cosines and weights, whose sum is 1. */
static const double mcr_mean_node_[8] = {0.01985507175123191, 0.1016667612931866, 0.2372337950418355, 0.4082826787521751,
                                         0.5917173212478248,  0.7627662049581645, 0.8983332387068134, 0.9801449282487681};
static const double mcr_mean_weight_[8] = {0.002009899851317613, 0.02260875954590313, 0.07442181813145635, 0.1480775066176912,
                                           0.2146062767606707,   0.2392848277464308,  0.1997722749074713,  0.09921863643905911};

/* ---- mirror directions ---- */

/* o mirrored at the normal m, which need not be unit: m2 is its length squared. */
MCR_INLINE struct mcr_vector mcr_mirrored(struct mcr_vector o, struct mcr_vector m, double m2)
{
    double twice = 2 * mcr_dot(o, m) / (m2 > 0 ? m2 : 1);
    return mcr_vector(twice * m.x - o.x, twice * m.y - o.y, twice * m.z - o.z);
}

/* o refracted at the unit normal m on its side; c = o.m, q of mcr_fresnel_dielectric: (c - q) m - o, over n. */
MCR_INLINE struct mcr_vector mcr_refracted(struct mcr_vector o, struct mcr_vector m, double c, double n, double q)
{
    double inverse = 1 / n, k = c - q;
    struct mcr_vector v = mcr_vector((k * m.x - o.x) * inverse, (k * m.y - o.y) * inverse, (k * m.z - o.z) * inverse);
    double fix = 0.5 * (1 - mcr_dot(v, v));

    return mcr_vector(v.x + v.x * fix, v.y + v.y * fix, v.z + v.z * fix);
}

/* ---- GGX ---- */

/* sqrt(cos^2 + slope^2): in Smith's terms, cos (1 + 2 Lambda). */
MCR_INLINE double mcr_ggx_spread(double ax, double ay, struct mcr_vector v)
{
    double x = ax * v.x, y = ay * v.y;
    return sqrt(x * x + y * y + v.z * v.z);
}

struct mcr_ggx {
    double value;   /* f cos without Fresnel's share */
    double density; /* of w, were it always drawn by reflection (or refraction) at a visible normal */
    double cosine;  /* between the half vector and o: for Fresnel */
};

/* D of the half vector h, which is not unit: length2 = h.h > 0. */
MCR_INLINE double mcr_ggx_normals_(double ax, double ay, struct mcr_vector h, double length2)
{
    double a = ax * ay, q = (a * a * (h.z * h.z) + (ay * h.x) * (ay * h.x) + (ax * h.y) * (ax * h.y)) / (a * length2);
    return a / (3.1415926535897932 * q * q);
}

/*
 * Reflection, D G2 / (4 cos_o), and its density G1(o) D / (4 cos_o), over 1/sr; 0 below the horizon. The value is symmetric in o and w but for its factor
 * cos_w, to rounding.
 */
MCR_INLINE struct mcr_ggx mcr_ggx_reflect(double ax, double ay, struct mcr_vector o, struct mcr_vector w)
{
    struct mcr_vector h = mcr_vector(o.x + w.x, o.y + w.y, o.z + w.z);
    int above = (o.z > MCR_GGX_HORIZON) & (w.z > MCR_GGX_HORIZON);
    double length2 = above ? mcr_dot(h, h) : 1, half = 0.5 * sqrt(length2), so = mcr_ggx_spread(ax, ay, o), sw = mcr_ggx_spread(ax, ay, w);
    double d = mcr_ggx_normals_(ax, ay, h, length2), below = w.z * so + o.z * sw, value, density;
    struct mcr_ggx g;

    value = d * w.z / (2 * (above ? below : 1));
    density = d / (2 * (above ? o.z + so : 1));
    g.value = above ? value : 0;
    g.density = above ? density : 0;
    half = half < 1 ? half : 1;
    g.cosine = half > MCR_GGX_HORIZON ? half : MCR_GGX_HORIZON; /* both selects do nothing but at opposite and equal directions */
    return g;
}

/*
 * Refraction into a medium of the relative index n = beyond / here, with w below the horizon: value = G2 D (o.h) |w.h| / (cos_o |o + n w|^2), h being the
 * unit vector along +-(o + n w) (Walter et al., equations 16, 17 and 21). That is for radiance: in the value's integral 1 / n^2 of what enters arrives.
 * n - 1 is kept off 0 by MCR_INDEX_LEAST: light is bent by less than that where there is no interface at all.
 */
#define MCR_INDEX_LEAST 1e-6
MCR_INLINE struct mcr_ggx mcr_ggx_transmit(double ax, double ay, struct mcr_vector o, struct mcr_vector w, double n)
{
    double excess = n - 1, bent = excess < 0 ? (excess < -MCR_INDEX_LEAST ? excess : -MCR_INDEX_LEAST)
                                             : (excess > MCR_INDEX_LEAST ? excess : MCR_INDEX_LEAST);
    /* o + n w = (o + w) + (n - 1) w, toward the side of the normal */
    struct mcr_vector k = mcr_vector((o.x + w.x) + bent * w.x, (o.y + w.y) + bent * w.y, (o.z + w.z) + bent * w.z);
    double sign = k.z < 0 ? -1 : 1, length2 = mcr_dot(k, k), m = 1 + bent;
    struct mcr_vector h = mcr_vector(sign * k.x, sign * k.y, sign * k.z);
    double oh = mcr_dot(o, h), wh = -mcr_dot(w, h), depth = -w.z;
    int crosses = (o.z > MCR_GGX_HORIZON) & (depth > MCR_GGX_HORIZON) & (oh > 0) & (wh > 0) & (length2 > 1e-60) & (h.z > 0);
    double safe2 = crosses ? length2 : 1, inverse = 1 / safe2, so = mcr_ggx_spread(ax, ay, o), sw = mcr_ggx_spread(ax, ay, w);
    double d = mcr_ggx_normals_(ax, ay, h, safe2), both = d * (oh * inverse) * (wh * inverse), below = depth * so + o.z * sw;
    double value = 2 * both * depth / (crosses ? below : 1), density = 2 * both * m * m / (crosses ? o.z + so : 1);
    double cosine = oh * sqrt(inverse);
    struct mcr_ggx g;

    g.value = crosses ? value : 0;
    g.density = crosses ? density : 0;
    cosine = crosses ? cosine : 1;
    g.cosine = cosine < 1 ? cosine : 1;
    return g;
}

/* The refraction that mcr_ggx_transmit knows, of a relative index too close to 1. */
MCR_INLINE double mcr_ggx_index(double n)
{
    double excess = n - 1, bent = excess < 0 ? (excess < -MCR_INDEX_LEAST ? excess : -MCR_INDEX_LEAST)
                                             : (excess > MCR_INDEX_LEAST ? excess : MCR_INDEX_LEAST);
    return 1 + bent;
}

/* Reflection above the horizon; below it refraction, or of a thin wall, which passes light as it reflects it, the mirrored direction's image. */
MCR_INLINE struct mcr_ggx mcr_ggx_interface(double alpha, double n, int thin, struct mcr_vector o, struct mcr_vector w)
{
    struct mcr_ggx reflected = mcr_ggx_reflect(alpha, alpha, o, mcr_vector(w.x, w.y, fabs(w.z))), refracted = mcr_ggx_transmit(alpha, alpha, o, w, n), g;
    int bends = !thin & (w.z < 0);

    g.value = bends ? refracted.value : reflected.value;
    g.density = bends ? refracted.density : reflected.density;
    g.cosine = bends ? refracted.cosine : reflected.cosine;
    return g;
}

/* Where the facet of unit normal m, c = o.m, then sends what it does not reflect to `mirrored`. */
MCR_INLINE struct mcr_vector mcr_ggx_passed(struct mcr_vector o, struct mcr_vector m, double c, struct mcr_vector mirrored, double n, int thin)
{
    double bent = mcr_ggx_index(n), root2 = (bent - 1) * (bent + 1) + c * c;
    struct mcr_vector p = mcr_refracted(o, m, c, bent, sqrt(root2 > 0 ? root2 : 0));

    p.x = thin ? mirrored.x : p.x;
    p.y = thin ? mirrored.y : p.y;
    p.z = thin ? -mirrored.z : p.z;
    return p;
}

/*
 * A normal that o sees (o.z > 0), not unit. Squeezed by ax and ay, the surface's normals are those of a hemisphere and o becomes a unit vector s. A point
 * of the spherical cap z > -s.z, uniform in area, plus s is a visible normal of the hemisphere; stretched back, one of the surface. The cap's point at a
 * disk's radius r is at height 1 - r^2 (1 + s.z), so that the sum has the height (1 + s.z)(1 - r^2), which is exact at both ends.
 */
MCR_INLINE struct mcr_vector mcr_ggx_visible(double ax, double ay, struct mcr_vector o, double u, double v)
{
    double qx = ax * o.x, qy = ay * o.y, length = 1 / sqrt(qx * qx + qy * qy + o.z * o.z);
    double sx = qx * length, sy = qy * length, sz = o.z * length < 1 ? o.z * length : 1;
    double px, py, rest = mcr_disk_from_square(u, v, &px, &py), p = 1 + sz, s = sqrt(p * (2 - (1 - rest) * p));

    return mcr_vector(ax * (px * s + sx), ay * (py * s + sy), p * rest);
}

/* ---- directional albedos of isotropic GGX that reflects all light ---- */

/*
 * Polynomials fitted by Chebyshev interpolation to midpoint sums over 1200 x 1200 (lost) and 1000 x 1000 (grazing) visible normals, which err by less than
 * 1e-5. Largest errors: lost 2e-4, and 2e-5 from alpha = 0.1 on; grazing 4e-4; the means, of these polynomials themselves: of lost, 0.4 % for alpha below
 * 0.05, 0.3 % below 0.1 and 0.05 % from there on, of grazing 0.2 % and from 0.05 on 0.02 %.
 */
static const double mcr_ggx_lost_[18][12] = {
    {0.1631581104, 0.2027587777, 0.06186441648, -0.02661369125, 0.0003852214472, 0.000710348429, 0.0003146668615, -0.000233126063,
     -0.0001892950691, 0.000249950489, 4.547726712e-05, -8.934663096e-05},
    {0.2069985802, 0.2004036747, 0.04235305939, -0.04523636213, -0.003553411604, 0.00228047521, 0.003999537247, -0.001927711974,
     -0.003254020603, 0.002648093575, 0.0008404054227, -0.0008590798354},
    {-0.006476755913, -0.06189560622, -0.02984045705, -0.01920481233, -0.007004390244, 0.01508879504, -0.02704115607, 0.01446939448,
     0.030232519, -0.02857406125, -0.007869867899, 0.01019118718},
    {-0.02366263121, 0.0006856233984, 0.01347551718, -0.02008992977, 0.01090085802, 0.04697021667, -0.1616931672, 0.08995682162,
     0.1669186203, -0.1506398305, -0.04286134432, 0.05010161626},
    {0.01138509993, 0.05796727629, -0.03935349437, 0.0540737665, -0.04262884162, -0.2381620153, 0.7078549235, -0.3372285356,
     -0.7437317974, 0.6610996849, 0.1951871137, -0.2357647426},
    {-0.02168377573, 0.02255665314, -0.1180096187, 0.1787734429, -0.246786705, -0.6347972329, 2.579139069, -1.46094912, -2.632934473,
     2.424493987, 0.6739681209, -0.813228585},
    {-0.003130241938, -0.1450703864, 0.3950696495, -0.6879693814, 0.3641648408, 2.332734962, -6.40334365, 2.87277056, 6.789105326,
     -5.870916585, -1.801991417, 2.106324595},
    {0.06506105205, -0.1632102761, 0.7999446779, -1.407023384, 1.657151321, 4.69244863, -18.09398483, 10.15725615, 18.55395343,
     -17.13867032, -4.766577701, 5.797732206},
    {-0.004321407217, 0.7664714802, -1.847307469, 3.093661635, -1.467553769, -10.68073268, 28.31086355, -12.06945634, -30.2253725,
     25.53244921, 8.103563472, -9.223260926},
    {-0.2694992817, 0.6969717477, -3.188629124, 5.391508366, -5.814656543, -18.12099122, 67.08687391, -36.99559678, -69.14547409,
     63.57467242, 17.86438203, -21.68002596},
    {0.009944337424, -1.882485594, 4.662781655, -7.723563494, 3.152954904, 26.61058156, -67.52106727, 27.13259712, 72.60625552,
     -59.89554967, -19.66058471, 21.81579236},
    {0.5754261696, -1.550941895, 7.109341799, -11.86269541, 11.52339901, 39.85775644, -140.5740735, 75.43286037, 145.7122658,
     -132.6520577, -37.91233941, 45.61631131},
    {-0.03171062153, 2.647779029, -6.592590054, 10.62720495, -3.518993487, -36.66940149, 88.66476998, -33.24586749, -96.12233306,
     77.29994789, 26.29470943, -28.42386427},
    {-0.7180047205, 2.030613165, -9.105135024, 14.85029082, -12.75784761, -50.01452503, 167.1106265, -86.51937023, -174.3679158,
     156.4960177, 45.74321669, -54.29525825},
    {0.03388048098, -1.937364451, 4.880077146, -7.655782421, 1.873951837, 26.39843182, -60.32601908, 20.70543869, 65.99845887,
     -51.5387757, -18.24558415, 19.16553189},
    {0.4746310532, -1.415015734, 6.222721434, -9.918993554, 7.327172237, 33.46052099, -105.0656293, 51.88674674, 110.4590082,
     -97.26641654, -29.24782805, 34.0773788},
    {-0.01665435596, 0.5990643228, -1.507969579, 2.252221434, -0.2952676239, -7.770822642, 16.56525338, -5.050788674, -18.33249757,
     13.8317348, 5.125331385, -5.214479905},
    {-0.1331878975, 0.4251738183, -1.793335761, 2.747509633, -1.635786075, -9.291286137, 27.08651447, -12.56737619, -28.74283426,
     24.7017944, 7.69005703, -8.751832021},
};
static const double mcr_ggx_grazing_[14][16] = {
    {0.05557182856, -0.1391343139, 0.1688912935, -0.08459478532, -0.08710230916, 0.2412167008, -0.1490239277, -0.2213226441,
     0.2309064607, 0.2072193784, -0.07556728438, -0.2858969275, -0.05677877854, 0.2496318962, 0.03507717849, -0.08245456094},
    {-0.1350066276, 0.377465571, -0.5772063312, 0.5456740424, -0.06543512611, -0.8567710085, 0.7856515912, 0.6441824308, 0.6024343763,
     -2.234417112, -2.857145326, 4.747079881, 2.679522106, -4.107227773, -0.8358261352, 1.272029269},
    {0.06106133068, -0.1390653441, 0.1998553597, -0.2173016702, 2.043983222, -5.290413403, -6.87321463, 25.51027267, 14.33779227,
     -58.39948548, -20.34429705, 74.98257071, 15.74026909, -50.61827008, -4.829983287, 13.84844971},
    {0.0606487214, -0.3087275889, 0.9433558427, -2.269672349, -3.192649196, 19.50974641, 12.46448259, -80.89391031, -41.00099265,
     195.0512691, 70.88948716, -263.9285284, -57.70165388, 183.5515815, 17.71125891, -50.88922622},
    {-0.0329570532, 0.2142686129, 0.5161558707, -2.884860132, -19.58999474, 55.80514329, 116.4903036, -309.9023721, -327.3999631,
     818.83013, 480.1317032, -1132.858074, -351.9274459, 789.5560048, 101.5434357, -218.4819841},
    {-0.006627819598, -0.1118523072, -2.937069887, 15.03544688, 39.54083026, -178.4451924, -226.540004, 886.2631865, 647.2456137,
     -2245.165729, -960.4040748, 3034.466221, 706.4572501, -2079.306324, -203.4125892, 567.2996433},
    {0.054705005, -0.4111336749, -4.08631432, 15.21280219, 84.64336721, -222.7005631, -565.9969863, 1284.60526, 1725.950532,
     -3585.931811, -2645.561117, 5176.207859, 1985.015136, -3718.407124, -579.9777496, 1051.34373},
    {-0.1096864086, 1.168453191, 10.12226399, -54.00850482, -170.7851124, 667.9757153, 1067.963464, -3488.448025, -3134.676119,
     9124.363435, 4675.271444, -12570.78044, -3432.068852, 8715.342481, 984.3596984, -2395.610813},
    {-0.1059600104, 0.6508795977, 8.385990299, -27.669257, -163.1196137, 390.0691659, 1134.337429, -2303.595571, -3593.757551,
     6643.643676, 5673.572169, -9875.395036, -4352.782361, 7267.836935, 1293.590961, -2095.561592},
    {0.2285576575, -2.154439185, -18.39798708, 92.22710195, 324.354167, -1156.442505, -2102.746176, 6181.02058, 6328.515789, -16506.9051,
     -9606.17695, 23128.6777, 7143.0121, -16252.10863, -2068.93625, 4515.671017},
    {0.09798681496, -0.5027298209, -7.295850013, 21.60575291, 140.8237543, -306.2362483, -999.7693813, 1848.607342, 3242.839412,
     -5470.20182, -5228.359265, 8326.563124, 4083.128837, -6254.677769, -1231.615884, 1834.879697},
    {-0.200012264, 1.736606264, 15.57655441, -73.45938876, -278.8789307, 929.443052, 1844.685637, -5039.705457, -5654.102948,
     13660.22616, 8716.239867, -19400.4125, -6565.865729, 13793.96497, 1922.702386, -3871.791909},
    {-0.03388566691, 0.143432055, 2.311855275, -6.082909674, -44.64641168, 88.01152303, 321.6750871, -544.2702193, -1061.465413,
     1649.980389, 1739.425008, -2566.539775, -1378.147961, 1964.125492, 420.9427504, -585.3813416},
    {0.06564177439, -0.524010003, -4.931005994, 22.05260205, 88.96884443, -281.1200991, -596.3905671, 1540.578376, 1852.872364,
     -4223.976309, -2892.04455, 6065.2737, 2202.73716, -4355.906927, -651.3412191, 1233.625366},
};

MCR_INLINE double mcr_row12_(const double *c, double y)
{
    double p = c[11];

    p = ((p * y + c[10]) * y + c[9]) * y + c[8];
    p = (((p * y + c[7]) * y + c[6]) * y + c[5]) * y + c[4];
    return (((p * y + c[3]) * y + c[2]) * y + c[1]) * y + c[0];
}

MCR_INLINE double mcr_row16_(const double *c, double y)
{
    double p = c[15];

    p = ((p * y + c[14]) * y + c[13]) * y + c[12];
    p = (((p * y + c[11]) * y + c[10]) * y + c[9]) * y + c[8];
    p = (((p * y + c[7]) * y + c[6]) * y + c[5]) * y + c[4];
    return (((p * y + c[3]) * y + c[2]) * y + c[1]) * y + c[0];
}

MCR_INLINE double mcr_within_unit_(double x)
{
    double positive = x > 0 ? x : 0;
    return positive < 1 ? positive : 1;
}

/*
 * The share of light that meets more than one facet and is lost, 1 - E, by the cosine t to the normal of the surface that is stretched until its slopes
 * are those of a hemisphere: cos / mcr_ggx_spread.
 */
MCR_INLINE double mcr_ggx_lost_stretched(double alpha, double t)
{
    double x = 2 * sqrt(mcr_within_unit_(t)) - 1, y = 2 * alpha - 1, p = mcr_row12_(mcr_ggx_lost_[17], y);

    p = p * x + mcr_row12_(mcr_ggx_lost_[16], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[15], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[14], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[13], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[12], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[11], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[10], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[9], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[8], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[7], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[6], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[5], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[4], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[3], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[2], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[1], y);
    p = p * x + mcr_row12_(mcr_ggx_lost_[0], y);
    return mcr_within_unit_(p);
}

/* The same by the cosine c. */
MCR_INLINE double mcr_ggx_lost(double alpha, double c)
{
    double cosine = mcr_within_unit_(c), sine2 = (1 - cosine) * (1 + cosine), spread = sqrt(cosine * cosine + alpha * alpha * sine2);
    return mcr_ggx_lost_stretched(alpha, cosine / spread);
}

/* The mean of (1 - o.h)^5 over the light that is not lost: E with Schlick's formula is (1 - lost) (r + (1 - r) grazing). */
MCR_INLINE double mcr_ggx_grazing(double alpha, double c)
{
    double cosine = mcr_within_unit_(c), sine2 = (1 - cosine) * (1 + cosine), spread = sqrt(cosine * cosine + alpha * alpha * sine2);
    double x = 2 * (cosine * sqrt((1 + alpha) / (spread + alpha))) - 1, y = 2 * sqrt(alpha) - 1, p = mcr_row16_(mcr_ggx_grazing_[13], y);

    p = p * x + mcr_row16_(mcr_ggx_grazing_[12], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[11], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[10], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[9], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[8], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[7], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[6], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[5], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[4], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[3], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[2], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[1], y);
    p = p * x + mcr_row16_(mcr_ggx_grazing_[0], y);
    return mcr_within_unit_(p);
}

/* The mean of mcr_ggx_lost over the hemisphere, weighted by the cosine. */
MCR_INLINE double mcr_ggx_mean_lost(double alpha)
{
    double x = 2 * sqrt(alpha) - 1, z = (alpha < 0.05 ? 40 * alpha : 1) - 1, p, q;

    p = -1.657368041;
    p = p * x + 3.744016777;
    p = p * x + 3.593224631;
    p = p * x - 12.20926174;
    p = p * x - 0.5953026287;
    p = p * x + 14.80429843;
    p = p * x - 3.699261359;
    p = p * x - 8.089085493;
    p = p * x + 3.111613905;
    p = p * x + 1.962289393;
    p = p * x - 0.8371151662;
    p = p * x - 0.1207832914;
    p = p * x - 0.06160501302;
    p = p * x - 0.2664389986;
    p = p * x + 0.441000396;
    p = p * x + 0.4706855167;
    q = 1.099129111;
    q = q * z - 0.3982920229;
    q = q * z - 2.735034163;
    q = q * z + 0.9853327755;
    q = q * z + 2.517781494;
    q = q * z - 0.9860894678;
    q = q * z - 1.194458875;
    q = q * z + 0.5103005802;
    q = q * z + 3.638375706;
    return alpha < 0.05 ? alpha * (alpha * q) : alpha * p;
}

/* The same mean of (1 - lost) grazing. */
MCR_INLINE double mcr_ggx_mean_grazing(double alpha)
{
    double x = 2 * sqrt(alpha) - 1, p;

    p = 0.002062625912;
    p = p * x - 0.00559819669;
    p = p * x - 0.0005097002781;
    p = p * x + 0.01543966818;
    p = p * x - 0.01598935963;
    p = p * x - 0.003677099183;
    p = p * x + 0.02302841689;
    p = p * x - 0.02428845601;
    p = p * x + 0.003607657137;
    p = p * x + 0.02463413214;
    p = p * x - 0.03463173809;
    p = p * x + 0.01867760538;
    return p;
}

/* ---- anisotropic GGX ---- */

/*
 * By the stretched cosine, what anisotropic facets lose is close to what isotropic ones of one width between ax and ay lose from all azimuths. The width
 * below is the largest of which that is nowhere more than 1e-3 above what is lost, so that whoever gives it back creates no light: of the light that is
 * lost, up to 0.07 are left out where the widths differ most. width = larger (1 - (1 - r) p(larger, r)), r being the smaller width over the larger, and
 * its mean over the hemisphere is mcr_ggx_mean_lost(width) (1 + (1 - r) q(larger, r)). p and q are polynomials in 2 sqrt(larger) - 1 and 2 r - 1, fitted
 * one-sidedly, by linear programs, to midpoint sums over 100 x 80 visible normals at 61 directions for 11 x 10 pairs of widths.
 */
static const double mcr_ggx_narrow_[7][4] = {
    {0.6191291909, 0.1696824841, -0.0625773971, -0.02788196266},
    {-0.1102148331, 0.0386105834, 0.08936273498, 0.02973437029},
    {-0.2757714953, -0.3177535388, 0.01401452719, 0.09208818986},
    {0.7997112516, 0.3070737184, 0.3117831435, 0.2501327201},
    {-0.4631119763, 0.3706735238, -0.4983794905, -0.5992098232},
    {-0.4370436795, -0.2878693845, -0.431080126, -0.2905938448},
    {0.3893015417, -0.09689589112, 0.6048979938, 0.5613461551},
};
static const double mcr_ggx_narrow_mean_[9][4] = {
    {0.09379605254, 0.04408121834, -0.02261908002, -0.005539908433},
    {-0.3628568113, 0.1438582565, 0.169733821, -0.0444841495},
    {0.1730063742, -0.6315749894, -0.1743539969, 0.189847205},
    {0.8656545109, -1.150553089, -0.6480806804, 0.5652407404},
    {-1.710765793, 2.894283165, 0.6454162192, -1.438256644},
    {1.207415209, 3.165440574, 2.335172212, -0.4456625142},
    {0.4913586292, -5.854492052, -2.306079845, 1.879921938},
    {-1.468591888, -2.271966802, -2.061665754, 0.01726200868},
    {0.704629659, 3.658724095, 2.107035813, -0.6823228968},
};

MCR_INLINE double mcr_cubic_(const double *c, double y) { return ((c[3] * y + c[2]) * y + c[1]) * y + c[0]; }

MCR_INLINE double mcr_ggx_width(double ax, double ay)
{
    double larger = ax > ay ? ax : ay, r = (ax < ay ? ax : ay) / larger, w = 2 * sqrt(larger) - 1, y = 2 * r - 1, p = mcr_cubic_(mcr_ggx_narrow_[6], y);

    for (int i = 5; i >= 0; i--)
        p = p * w + mcr_cubic_(mcr_ggx_narrow_[i], y);
    return larger * (1 - (1 - r) * mcr_within_unit_(p));
}

/* The mean of mcr_ggx_lost_stretched for mcr_ggx_width over the hemisphere, weighted by the cosine, or a little more. */
MCR_INLINE double mcr_ggx_width_mean_lost(double ax, double ay)
{
    double larger = ax > ay ? ax : ay, r = (ax < ay ? ax : ay) / larger, w = 2 * sqrt(larger) - 1, y = 2 * r - 1;
    double q = mcr_cubic_(mcr_ggx_narrow_mean_[8], y);

    for (int i = 7; i >= 0; i--)
        q = q * w + mcr_cubic_(mcr_ggx_narrow_mean_[i], y);
    return mcr_ggx_mean_lost(mcr_ggx_width(ax, ay)) * (1 + (1 - r) * q);
}

/* ---- integrals over visible normals ---- */

/*
 * Point k < MCR_GGX_NORMALS of a lattice over the cap of mcr_ggx_visible, as its height `rest` and its place (x, y) in the unit disk's rim, with a weight;
 * the weights sum to 1. More points are where little of the cap's height is left, which are the steep normals. Mean shares of light are within 2e-3.
 */
#define MCR_GGX_NORMALS 144
MCR_INLINE double mcr_ggx_lattice(int k, double *rest, double *turn)
{
    double t = (k + 0.5) * (1.0 / MCR_GGX_NORMALS), v = (k * 89 % MCR_GGX_NORMALS + 0.5) * (1.0 / MCR_GGX_NORMALS); /* 89 and 144: Fibonacci's */

    *rest = t * t;
    *turn = v;
    return 2 * t * (1.0 / MCR_GGX_NORMALS);
}

/* The normal that o sees at that point; (sine, cosine) of the azimuth. Not unit. */
MCR_INLINE struct mcr_vector mcr_ggx_visible_at(double ax, double ay, struct mcr_vector o, double rest, double sine, double cosine)
{
    double qx = ax * o.x, qy = ay * o.y, length = 1 / sqrt(qx * qx + qy * qy + o.z * o.z);
    double sx = qx * length, sy = qy * length, sz = o.z * length < 1 ? o.z * length : 1, p = 1 + sz;
    double radius = sqrt(1 - rest) * sqrt(p * (2 - (1 - rest) * p));

    return mcr_vector(ax * (radius * cosine + sx), ay * (radius * sine + sy), p * rest);
}

#ifdef __cplusplus
}
#endif

#endif
