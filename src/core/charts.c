/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Tables of surface coordinates (struct mcr_charts). Each shape has those that mcrender-scene(5) tells; a transform takes them along with the shape.
 */
#include <math.h>

#include "core/groups.h"
#include "scene/vector.h"

/* The vector in the plane of a and b with d.a = 1 and d.b = 0. */
static void dual(const double a[3], const double b[3], double out[3])
{
    double p[3], q[3], n[3], volume, unit = mcr_level(a, p);
    mcr_level(b, q);
    mcr_cross(p, q, n);
    mcr_cross(q, n, out);
    volume = mcr_dot(p, out);
    for (int j = 0; j < 3; j++)
        out[j] = out[j] / volume / unit;
}

static void set_anchor(struct mcr_charts *charts, uint32_t p, const double c[3])
{
    for (int j = 0; j < 3; j++)
        charts->c[j][p] = c[j];
}

/* A flat primitive whose coordinates at its anchor are (u0, v0) and grow by 1 along du and by 1 along dv. */
static void set_flat(struct mcr_charts *charts, uint32_t p, const double du[3], const double dv[3], double u0, double v0)
{
    double gu[3], gv[3];
    dual(du, dv, gu);
    dual(dv, du, gv);
    for (int j = 0; j < 3; j++) {
        charts->gu[j][p] = gu[j];
        charts->gv[j][p] = gv[j];
    }
    charts->u0[p] = u0;
    charts->v0[p] = v0;
}

/*
 * Seen from outside, u grows to the right and v upward, with +y up on the four sides; on the top and the bottom, u grows along +x. The anchor of a
 * face is the corner c or, of faces at 1, that corner moved along the face's axis: both are at 0 of the other two edges.
 */
static void set_box(struct mcr_charts *charts, const struct mcr_shape *shape)
{
    static const struct {
        int u, v, u_down, v_down; /* the edges that u and v run along, and whether backward */
    } face[6] = {{2, 1, 0, 0}, {2, 1, 1, 0}, {0, 2, 0, 0}, {0, 2, 0, 1}, {0, 1, 1, 0}, {0, 1, 0, 0}};
    for (uint32_t f = 0; f < 6; f++) {
        double du[3], dv[3], c[3];
        for (int j = 0; j < 3; j++) {
            c[j] = f % 2 ? shape->c[j] + shape->e[f / 2][j] : shape->c[j];
            du[j] = face[f].u_down ? -shape->e[face[f].u][j] : shape->e[face[f].u][j];
            dv[j] = face[f].v_down ? -shape->e[face[f].v][j] : shape->e[face[f].v][j];
        }
        set_anchor(charts, shape->primitive + f, c);
        set_flat(charts, shape->primitive + f, du, dv, face[f].u_down, face[f].v_down);
    }
}

/* Rows of the inverse of a matrix of three columns. */
static void invert(double column[3][3], double rows[9])
{
    for (int i = 0; i < 3; i++) {
        double n[3], volume;
        mcr_cross(column[(i + 1) % 3], column[(i + 2) % 3], n);
        volume = mcr_dot(column[i], n);
        for (int j = 0; j < 3; j++)
            rows[3 * i + j] = n[j] / volume;
    }
}

static void set_shape(struct mcr_charts *charts, const struct mcr_shape *shape, double scale)
{
    double du[3], dv[3], axis[3][3];
    uint32_t p = shape->primitive;
    set_anchor(charts, p, shape->c);
    switch (shape->kind) {
    case MCR_SHAPE_PLANE:
        for (int j = 0; j < 3; j++) {
            du[j] = shape->axis[0][j] * scale;
            dv[j] = shape->axis[1][j] * scale;
        }
        set_flat(charts, p, du, dv, shape->uv[0], shape->uv[1]);
        break;
    case MCR_SHAPE_DISK: /* the square around it */
        for (int j = 0; j < 3; j++) {
            du[j] = 2 * shape->e[0][j];
            dv[j] = 2 * shape->e[1][j];
        }
        set_flat(charts, p, du, dv, 0.5, 0.5);
        break;
    case MCR_SHAPE_BOX:
        set_box(charts, shape);
        break;
    case MCR_SHAPE_SPHERE:
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                axis[i][j] = shape->axis[i][j] * shape->radius;
        invert(axis, charts->local[p]);
        break;
    case MCR_SHAPE_ELLIPSOID:
        for (int i = 0; i < 3; i++)
            mcr_copy(shape->e[i], axis[i]);
        invert(axis, charts->local[p]);
        break;
    default:
        set_flat(charts, p, shape->e[0], shape->e[1], 0, 0);
    }
}

int mcr_charts_init(struct mcr_core *core, struct mcr_arena *arena)
{
    const struct mcr_scene *scene = core->scene;
    struct mcr_charts *charts = &core->charts;
    double **array[] = {&charts->c[0], &charts->c[1], &charts->c[2], &charts->gu[0], &charts->gu[1], &charts->gu[2], &charts->gv[0],
                        &charts->gv[1], &charts->gv[2], &charts->u0, &charts->v0};
    for (uint32_t p = 0; p < core->surfaces.count; p++)
        charts->needs |= scene->material[core->surfaces.material[p]].needs;
    if (!charts->needs)
        return 0;
    charts->count = scene->triangles.first_primitive;
    /* One at least: lanes that hold triangles read the first entry and leave it. */
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        if (!(*array[i] = mcr_arena_alloc(arena, (size_t)charts->count + 1, sizeof(double))))
            return -1;
    if ((core->surfaces.round || core->surfaces.quadric) && !(charts->local = mcr_arena_alloc(arena, charts->count, sizeof *charts->local)))
        return -1;
    for (uint32_t i = 0; i < scene->shape_count; i++)
        set_shape(charts, &scene->shape[i], scene->scale);
    return 0;
}
