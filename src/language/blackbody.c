/* SPDX-License-Identifier: Apache-2.0 */
#include "language/blackbody.h"

#include "base/elementary.h"

/* Second radiation constant h c / k in nm K, exact since the SI of 2019, to 10 digits. */
#define C2 1.438776877e7

/*
 * Colour matching functions of the CIE 1931 standard observer (ISO/CIE 11664-1), 380 nm to 780 nm by 10. A black body's spectrum is so smooth that the
 * sums are within 1e-4, in chromaticity, of those over splines by single nanometres. (The sum of Gaussians that Wyman, Sloan and Shirley fitted to these
 * functions is off by 0.01 at 1000 K, as so little is seen of such a body, and that by the functions' tails.)
 */
#define SHORTEST 380
#define LONGEST 780
#define STEP 10
static const double observer[(LONGEST - SHORTEST) / STEP + 1][3] = {
    {0.001368, 0.000039, 0.006450}, {0.004243, 0.000120, 0.020050},
    {0.014310, 0.000396, 0.067850}, {0.043510, 0.001210, 0.207400},
    {0.134380, 0.004000, 0.645600}, {0.283900, 0.011600, 1.385600},
    {0.348280, 0.023000, 1.747060}, {0.336200, 0.038000, 1.772110},
    {0.290800, 0.060000, 1.669200}, {0.195360, 0.090980, 1.287640},
    {0.095640, 0.139020, 0.812950}, {0.032010, 0.208020, 0.465180},
    {0.004900, 0.323000, 0.272000}, {0.009300, 0.503000, 0.158200},
    {0.063270, 0.710000, 0.078250}, {0.165500, 0.862000, 0.042160},
    {0.290400, 0.954000, 0.020300}, {0.433450, 0.994950, 0.008750},
    {0.594500, 0.995000, 0.003900}, {0.762100, 0.952000, 0.002100},
    {0.916300, 0.870000, 0.001650}, {1.026300, 0.757000, 0.001100},
    {1.062200, 0.631000, 0.000800}, {1.002600, 0.503000, 0.000340},
    {0.854450, 0.381000, 0.000190}, {0.642400, 0.265000, 0.000050},
    {0.447900, 0.175000, 0.000020}, {0.283500, 0.107000, 0},
    {0.164900, 0.061000, 0}, {0.087400, 0.032000, 0},
    {0.046770, 0.017000, 0}, {0.022700, 0.008210, 0},
    {0.011359, 0.004102, 0}, {0.005790, 0.002091, 0},
    {0.002899, 0.001047, 0}, {0.001440, 0.000520, 0},
    {0.000690, 0.000249, 0}, {0.000332, 0.000120, 0},
    {0.000166, 0.000060, 0}, {0.000083, 0.000030, 0},
    {0.000042, 0.000015, 0},
};

void mcr_blackbody(double kelvin, double rgb[3])
{
    /* From CIE XYZ to linear Rec. 709 (BT.709 primaries, white D65), and its luminance. */
    static const double to_rgb[3][3] = {
        {3.2409699419045226, -1.5373831775700939, -0.49861076029300340},
        {-0.96924363628087960, 1.8759675015077202, 0.041555057407175590},
        {0.055630079696993650, -0.20397695888897652, 1.0569715142428786},
    };
    static const double luminance[3] = {0.2126, 0.7152, 0.0722};
    double xyz[3] = {0, 0, 0}, sum = 0;
    const double least = C2 / (LONGEST * kelvin);
    for (int i = 0; SHORTEST + STEP * i <= LONGEST; i++) {
        /* Planck's law, all of it times exp(least), so that cold bodies do not underflow, and in units of 1 / (500 nm)^5. */
        double nm = SHORTEST + STEP * i, relative = 500 / nm, x = C2 / (nm * kelvin), square = relative * relative;
        double radiance = square * square * relative * mcr_exp(least - x) / (1 - mcr_exp(-x));
        for (int c = 0; c < 3; c++)
            xyz[c] += observer[i][c] * radiance;
    }
    for (int c = 0; c < 3; c++) {
        rgb[c] = to_rgb[c][0] * xyz[0] + to_rgb[c][1] * xyz[1] + to_rgb[c][2] * xyz[2];
        rgb[c] = rgb[c] > 0 ? rgb[c] : 0;
        sum += luminance[c] * rgb[c];
    }
    for (int c = 0; c < 3; c++)
        rgb[c] /= sum;
}
