/* SPDX-License-Identifier: Apache-2.0 */
/* Quads: parallelograms, and other flat convex quadrilaterals as two triangles. */
#include "scene/build.h"
#include "scene/vector.h"

/*
 * How far a corner of a quad may lie off the plane of the others, in parts of the longer diagonal. A millionth is what coordinates
 * written with seven digits, or in single precision, need; the two triangles that are made of it share their edge in any case.
 */
#define PLANAR 1e-6

static void add_parallelogram(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                              uint32_t material, const double corner[3], const double u[3], const double v[3])
{
    struct mcr_shape *shape = mcr_build_new_shape(build, settings, MCR_SHAPE_PARALLELOGRAM, material);
    mcr_transform_point(transform, corner, shape->c);
    mcr_transform_vector(transform, u, shape->e[0]);
    mcr_transform_vector(transform, v, shape->e[1]);
    mcr_sine(shape->e[0], shape->e[1], shape->n);
    for (int i = 0; i < 3 && transform->mirrored; i++)
        shape->n[i] = -shape->n[i];
}

static void build_edges(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                        uint32_t material)
{
    double corner[3], edge[2][3];
    int bad = mcr_read_vector(build, settings, QUAD_CORNER, corner) != 0;
    for (uint32_t i = 0; i < 2; i++) {
        if (mcr_read_vector(build, settings, QUAD_U + i, edge[i]) != 0) {
            bad = 1;
        } else if (mcr_largest(edge[i]) == 0) {
            mcr_error(build, settings->value[QUAD_U + i]->place, "'%s' of 'quad' is zero", i ? "v" : "u");
            bad = 1;
        }
    }
    if (bad)
        return;
    if (mcr_sine(edge[0], edge[1], NULL) <= MCR_PARALLEL) {
        mcr_error(build, settings->value[QUAD_V]->place, "'u' and 'v' of 'quad' are parallel");
        return;
    }
    add_parallelogram(build, settings, transform, material, corner, edge[0], edge[1]);
}

/* Whether c[0] - c[1] + c[2] - c[3] is zero within the rounding of the coordinates. */
static int is_parallelogram(double c[4][3])
{
    double most = 0, off = 0;
    for (int i = 0; i < 3; i++) {
        off = mcr_max(off, fabs((c[0][i] - c[1][i]) + (c[2][i] - c[3][i])));
        for (int k = 0; k < 4; k++)
            most = mcr_max(most, fabs(c[k][i]));
    }
    return off <= 8 * MCR_ROUNDING * most;
}

/* Distances of the corners from the plane through their middle along the diagonals' normal; -1 after an error. */
static int check_corners(struct mcr_build *build, const struct mcr_value *place, double c[4][3])
{
    double diagonal[2][3], normal[3], longest, off, side[3];
    mcr_subtract(c[2], c[0], diagonal[0]);
    mcr_subtract(c[3], c[1], diagonal[1]);
    longest = mcr_max(mcr_length(diagonal[0]), mcr_length(diagonal[1]));
    if (mcr_sine(diagonal[0], diagonal[1], normal) <= MCR_PARALLEL) {
        mcr_error(build, place->place, "the corners of 'quad' have no area: its diagonals are parallel or zero");
        return -1;
    }
    mcr_subtract(c[1], c[0], side);
    off = fabs(mcr_dot(normal, side)) / 2;
    if (off > PLANAR * longest) {
        mcr_error(build, place->place, "the corners of 'quad' are not in one plane: they are %.3g off it, expected at most %.3g", off,
                  PLANAR * longest);
        return -1;
    }
    /* Convex and not crossing: every corner turns to the same side, seen along the diagonals' normal. */
    for (int k = 0; k < 4; k++) {
        double before[3], after[3], turn[3];
        mcr_subtract(c[k], c[(k + 3) % 4], before);
        mcr_subtract(c[(k + 1) % 4], c[k], after);
        if (mcr_largest(before) == 0) {
            mcr_error(build, place->place, "corners %d and %d of 'quad' are the same point", (k + 3) % 4 + 1, k + 1);
            return -1;
        }
        if (mcr_largest(after) == 0)
            continue;
        if (mcr_sine(before, after, turn) <= MCR_PARALLEL) {
            mcr_error(build, place->place, "corner %d of 'quad' lies on a line with those beside it", k + 1);
            return -1;
        }
        if (mcr_dot(turn, normal) <= 0) {
            mcr_error(build, place->place, "'quad' is not convex at corner %d, or its edges cross", k + 1);
            return -1;
        }
    }
    return 0;
}

static void build_corners(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                          uint32_t material)
{
    double c[4][3], at[3];
    uint32_t vertex[4], uv[4] = { 0 };
    if (mcr_read_tuples(build, settings, QUAD_CORNERS, 4, 3, c[0]) != 0 || check_corners(build, settings->value[QUAD_CORNERS], c) != 0)
        return;
    if (is_parallelogram(c)) {
        double u[3], v[3];
        mcr_subtract(c[1], c[0], u);
        mcr_subtract(c[3], c[0], v);
        add_parallelogram(build, settings, transform, material, c[0], u, v);
        return;
    }
    for (int k = 0; k < 4; k++) {
        mcr_transform_point(transform, c[k], at);
        vertex[k] = mcr_build_add_vertex(build, at, "quad", settings->place);
        if (build->needs)
            uv[k] = mcr_build_add_uv(build, k == 1 || k == 2, k >= 2);
    }
    for (uint32_t k = 0; k < 2; k++) {
        const uint32_t corner[3] = { vertex[0], vertex[k + 1], vertex[k + 2] };
        const uint32_t coordinates[3] = { uv[0], uv[k + 1], uv[k + 2] };
        if (!mcr_build_add_triangle(build, material, transform->mirrored, corner, NULL, build->needs ? coordinates : NULL))
            mcr_error(build, settings->place, "'quad' has no area to rounding where it is moved to");
    }
}

void mcr_build_quad(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform, uint32_t material)
{
    const struct mcr_value *const *value = settings->value;
    const char *missing = !value[QUAD_CORNER] ? "corner" : !value[QUAD_U] ? "u" : !value[QUAD_V] ? "v" : NULL;
    for (uint32_t i = QUAD_CORNER; i <= QUAD_V && value[QUAD_CORNERS]; i++) {
        if (value[i]) {
            mcr_error(build, settings->key[i], "'%s' and 'corners' are both given in 'quad', expected 'corner', 'u' and 'v', or 'corners'",
                      settings->word->setting[i].name);
            return;
        }
    }
    if (value[QUAD_CORNERS])
        build_corners(build, settings, transform, material);
    else if (!missing)
        build_edges(build, settings, transform, material);
    else if (!settings->damaged && (value[QUAD_CORNER] || value[QUAD_U] || value[QUAD_V]))
        mcr_error(build, settings->place, "'quad' needs '%s'", missing);
    else if (!settings->damaged)
        mcr_error(build, settings->place, "'quad' needs 'corner', 'u' and 'v', or 'corners'");
}
