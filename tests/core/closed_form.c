/* SPDX-License-Identifier: Apache-2.0 */
/* The closed forms against the table of analytic scenes (S2 ...: the project's reference), and against sums over directions where the horizon cuts. */
#include "core/closed_form.h"

#include <math.h>

#include "scene/vector.h"
#include "tap.h"

static const double origin[3] = {0, 0, 0}, up[3] = {0, 0, 1};

static void near(const char *what, double value, double expected, double relative)
{
    ok(fabs(value - expected) <= relative * expected, "%s: %.15g, expected %.15g", what, value, expected);
}

static double rectangle(double x0, double y0, double x1, double y1, double z)
{
    const double corner[4][3] = {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
    return mcr_polygon_cosine(corner, 4, origin, up) / MCR_PI;
}

static double sphere(double r, double d, double degrees)
{
    double c[3] = {d * sin(degrees * (MCR_PI / 180)), 0, d * cos(degrees * (MCR_PI / 180))};
    return mcr_sphere_cosine(c, r, origin, up) / MCR_PI;
}

/* Whether the direction meets the turned parallelogram c + [0,1] a + [0,1] b. */
static int meets(const double c[3], const double a[3], const double b[3], const double w[3])
{
    double n[3], q[3], rest[3], side[3];
    mcr_cross(a, b, n);
    double t = mcr_dot(c, n) / mcr_dot(w, n);
    if (!(t > 0))
        return 0;
    for (int j = 0; j < 3; j++)
        q[j] = t * w[j] - c[j];
    mcr_cross(q, b, rest);
    mcr_cross(a, q, side);
    double u = mcr_dot(rest, n) / mcr_dot(n, n), v = mcr_dot(side, n) / mcr_dot(n, n);
    return u >= 0 && u <= 1 && v >= 0 && v <= 1;
}

/* The sum of the cosine over a grid of the disk below the hemisphere: its error is that of the edge, about 1/cells. */
static void against_sum(void)
{
    const double c[3] = {0.4, -0.7, -0.3}, a[3] = {0.2, 1.5, 0.4}, b[3] = {0.5, -0.1, 1.1};
    const double corner[4][3] = {{c[0], c[1], c[2]},
                                 {c[0] + a[0], c[1] + a[1], c[2] + a[2]},
                                 {c[0] + a[0] + b[0], c[1] + a[1] + b[1], c[2] + a[2] + b[2]},
                                 {c[0] + b[0], c[1] + b[1], c[2] + b[2]}};
    const int cells = 4000;
    uint64_t inside = 0;
    for (int i = 0; i < cells; i++)
        for (int j = 0; j < cells; j++) {
            double x = (2.0 * i + 1) / cells - 1, y = (2.0 * j + 1) / cells - 1, square = 1 - x * x - y * y;
            inside += square > 0 && meets(c, a, b, (double[3]){x, y, sqrt(square)});
        }
    near("a parallelogram through the horizon, against a sum", mcr_polygon_cosine(corner, 4, origin, up), 4.0 * (double)inside / cells / cells, 2e-4);
}

int main(void)
{
    const double wall[4][3] = {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}};
    const double triangle[3][3] = {{0, 0, 2}, {1, 0, 2}, {0, 1, 3}}, back[3][3] = {{0, 1, 3}, {1, 0, 2}, {0, 0, 2}};
    near("S2, centred", rectangle(-1, -1, 1, 1, 1), .55412642397957, 1e-13);
    near("S2, receiver at (1.5, .5)", rectangle(-2.5, -1.5, -.5, .5, 1), .14748482740113, 1e-13);
    near("S2, .01 x .01 at 1", rectangle(-.005, -.005, .005, .005, 1), 3.182992762256e-5, 1e-10);
    near("S2, 2 x 2 at .01", rectangle(-1, -1, 1, 1, .01), .99991817594388, 1e-13);
    near("S3", mcr_polygon_cosine(wall, 4, origin, up) / MCR_PI, .055734197002554, 1e-12);
    near("S20", mcr_polygon_cosine(triangle, 3, origin, up) / MCR_PI, .023717994556414, 1e-12);
    near("S20, the other way round", mcr_polygon_cosine(back, 3, origin, up) / MCR_PI, .023717994556414, 1e-12);
    near("S5, 0", sphere(.5, 2, 0), .0625, 1e-14);
    near("S5, 60", sphere(.5, 2, 60), .03125, 1e-14);
    near("S6, 80", sphere(1, 2, 80), .054695816445537, 1e-12);
    near("S6, 90", sphere(1, 2, 90), .028834442811219, 1e-12);
    near("S6, 110", sphere(1, 2, 110), .0021495675176078, 1e-11);
    ok(sphere(1, 2, 121) == 0, "a sphere below the horizon gives nothing");
    ok(rectangle(-1, -1, 1, 1, -1) == 0, "nor does a rectangle");
    near("a tiny sphere on the horizon: half of its disk, 2/(3 pi) r^3/d^3 ...", sphere(1e-4, 1, 90), 2 * 1e-12 / (3 * MCR_PI), 1e-3);
    against_sum();
    return tap_done();
}
