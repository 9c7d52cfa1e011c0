/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Colours of black bodies: chromaticities as they are tabulated (Wyszecki and Stiles, "Color Science", 2nd edition, table 1(3.11); illuminant A at its
 * temperature of today's scale), against an integration by single nanometres with another form of the observer, and what is clamped.
 */
#include <math.h>

#include "../tap.h"
#include "language/blackbody.h"

/* CIE x, y of linear Rec. 709. */
static void chromaticity(const double rgb[3], double *x, double *y)
{
    double big_x = 0.4123908 * rgb[0] + 0.3575843 * rgb[1] + 0.1804808 * rgb[2];
    double big_y = 0.2126390 * rgb[0] + 0.7151687 * rgb[1] + 0.0721923 * rgb[2];
    double big_z = 0.0193308 * rgb[0] + 0.1191948 * rgb[1] + 0.9505322 * rgb[2];
    *x = big_x / (big_x + big_y + big_z);
    *y = big_y / (big_x + big_y + big_z);
}

static double lobe(double nm, double middle, double left, double right)
{
    double t = (nm - middle) / (nm < middle ? left : right);
    return exp(-0.5 * t * t);
}

/* "Simple analytic approximations to the CIE XYZ color matching functions", Wyman, Sloan and Shirley (JCGT 2, 2013), the multi-lobe fits. */
static void by_fit(double kelvin, double *x, double *y)
{
    double sum[3] = {0, 0, 0};
    for (double nm = 360; nm <= 830; nm++) {
        double radiance = pow(nm / 560, -5) / expm1(1.438776877e7 / (nm * kelvin));
        sum[0] += radiance * (1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) - 0.065 * lobe(nm, 501.1, 20.4, 26.2));
        sum[1] += radiance * (0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1));
        sum[2] += radiance * (1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8));
    }
    *x = sum[0] / (sum[0] + sum[1] + sum[2]);
    *y = sum[1] / (sum[0] + sum[1] + sum[2]);
}

static double luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

int main(void)
{
    static const double known[][3] = {
        {2000, 0.5267, 0.4133}, {2855.5, 0.4476, 0.4074}, {3000, 0.4369, 0.4041}, {4000, 0.3805, 0.3768}, {5000, 0.3451, 0.3516},
        {6000, 0.3221, 0.3318}, {6504, 0.3135, 0.3237},   {10000, 0.2807, 0.2884},
    };
    double rgb[3], x, y, fx, fy, before = INFINITY, most = 0;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        mcr_blackbody(known[i][0], rgb);
        chromaticity(rgb, &x, &y);
        ok(fabs(x - known[i][1]) < 3e-4 && fabs(y - known[i][2]) < 3e-4, "%g K: x %.4f, y %.4f; tabulated %.4f, %.4f", known[i][0], x, y, known[i][1], known[i][2]);
    }
    for (double kelvin = 3000; kelvin < 1e6; kelvin *= 1.3) {
        mcr_blackbody(kelvin, rgb);
        chromaticity(rgb, &x, &y);
        by_fit(kelvin, &fx, &fy);
        most = fmax(most, fmax(fabs(x - fx), fabs(y - fy)));
    }
    ok(most < 0.0012, "from 3000 K on within 0.0012 of the fit by Gaussians (%.5f)", most);
    int falls = 1, whole = 1, positive = 1;
    for (double kelvin = MCR_BLACKBODY_LEAST; kelvin <= MCR_BLACKBODY_MOST; kelvin *= 1.01) {
        mcr_blackbody(kelvin, rgb);
        falls &= rgb[0] <= before * (1 + 1e-15);
        before = rgb[0];
        whole &= fabs(luminance(rgb) - 1) < 1e-14;
        positive &= rgb[0] > 0 && rgb[1] >= 0 && rgb[2] >= 0;
    }
    ok(whole, "the luminance is 1");
    ok(positive, "nothing is negative");
    ok(falls, "the hotter, the less red");
    mcr_blackbody(1890, rgb);
    ok(rgb[2] == 0 && rgb[1] > 0, "no blue at 1890 K");
    mcr_blackbody(1910, rgb);
    ok(rgb[2] > 0, "some at 1910 K");
    mcr_blackbody(955, rgb);
    ok(rgb[1] == 0, "no green at 955 K");
    mcr_blackbody(970, rgb);
    ok(rgb[1] > 0, "some at 970 K");
    mcr_blackbody(MCR_BLACKBODY_LEAST, rgb);
    ok(fabs(rgb[0] * 0.2126 - 1) < 1e-14, "red alone at 500 K");
    return tap_done();
}
