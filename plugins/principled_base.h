/* SPDX-License-Identifier: Apache-2.0 */
/* principled: reflectances of its base, plastic and glass, at one facet. Formulas: principled.c. */
#ifndef PLUGINS_PRINCIPLED_BASE_H
#define PLUGINS_PRINCIPLED_BASE_H

#include <mcrender/microfacet.h>

/* At normal incidence, of the index n. */
MCR_INLINE double least_of(double n)
{
    double root = (n - 1) / (n + 1);
    return root * root;
}

/* Plastic's, with (1 - cos)^5, or a mean of it, as weight. */
MCR_INLINE double plastic_of(double least, double tint, double specular, double weight)
{
    double r = least * tint;

    r = r < 1 ? r : 1;
    return specular * (r + (1 - r) * weight);
}

/* Glass's share of Fresnel: `plain`, and by how much it is to be moved where the tint is not 1: `rest`, -1 where all is reflected. */
struct glass {
    double plain, rest, q;
};

MCR_INLINE struct glass glass_of(double c, double ratio)
{
    double least = least_of(ratio), rise;
    struct glass g;

    g.plain = mcr_fresnel_dielectric(c, ratio, &g.q);
    rise = (g.plain - least) / (1 - least);
    g.rest = g.plain < 1 ? 1 - (rise > 0 ? rise : 0) : -1;
    return g;
}

/* One interface's reflectance. */
MCR_INLINE double interface_of(double plain, double rest, double ratio, double tint, double specular)
{
    double least = least_of(ratio), r = least * tint, f;

    r = r < 1 ? r : 1;
    f = plain + (r - least) * rest;
    f = specular * (f > 0 ? f : 0);
    f = f < 1 ? f : 1;
    return rest < 0 ? 1 : f;
}

/* What a wall of two of them reflects. */
MCR_INLINE double wall_of(double f) { return 2 * f / (1 + f); }

/* Of the base at a facet, in grey: what is reflected, and what passes. For choosing between both. */
struct shares {
    double reflected, passed;
};

MCR_INLINE struct shares shares_of(double cosine, struct glass g, double ratio, double least, double tint, double specular, double metallic,
                                   double transmission, double grey, int thin)
{
    double weight = mcr_schlick_weight(cosine), f = interface_of(g.plain, g.rest, ratio, tint, specular), all = thin ? wall_of(f) : f;
    struct shares s;

    s.reflected = metallic * (grey + (1 - grey) * weight) +
                  (1 - metallic) * (transmission * all + (1 - transmission) * plastic_of(least, tint, specular, weight));
    s.passed = (1 - metallic) * transmission * (1 - all) * grey;
    return s;
}

/* The chance that a facet reflects. */
MCR_INLINE double reflects_of(struct shares s)
{
    double sum = s.reflected + s.passed;
    return sum > 0 ? s.reflected / sum : 1;
}

#endif
