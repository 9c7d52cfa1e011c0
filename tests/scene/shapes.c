/* SPDX-License-Identifier: Apache-2.0 */
/* Shapes after transforms: kinds, edges, fronts, windings, what is left out. */
#include "help.h"

#include "scene/vector.h"

#define U 0x1p-53

/* A scene of these shapes, or NULL. The world is the caller's. */
static struct mcr_scene *build(struct world *world, const char *shapes)
{
    char text[8192];
    snprintf(text, sizeof text, CAMERA MATERIALS "%s", shapes);
    *world = open_world(text, NULL);
    return world->scene;
}

/* In units of the world. */
static void unscaled(const struct mcr_scene *scene, const double in[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = in[i] / scene->scale;
}

static void spheres(void)
{
    struct world world;
    const struct mcr_scene *scene = build(&world, "group { transform { scale -2 rotate (1, 2, 3, 50) translate (0, 0, 9) }\n"
                                                  "sphere { center (0, 0, 0) radius 0.5 material m }\n"
                                                  "sphere { center (1, 0, 0) radius 1 material m transform { scale (1, 1, 0.5) } } }\n");
    double v[3], gram[3][3];
    if (!ok(scene != NULL, "spheres are built"))
        return;
    ok(scene->shape[0].kind == MCR_SHAPE_SPHERE, "scaled by one factor, turned and mirrored, a sphere stays one");
    ok(fabs(scene->shape[0].radius / scene->scale - 1) <= 64 * U, "its radius is scaled by the magnitude");
    unscaled(scene, scene->shape[0].c, v);
    ok(near3(v, 0, 0, 9, 0), "its centre is moved");
    ok(scene->shape[1].kind == MCR_SHAPE_ELLIPSOID, "otherwise it is an ellipsoid");
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            gram[i][j] = mcr_dot(scene->shape[1].e[i], scene->shape[1].e[j]) / (scene->scale * scene->scale);
    ok(fabs(gram[0][0] - 4) <= 64 * U && fabs(gram[1][1] - 4) <= 64 * U && fabs(gram[2][2] - 1) <= 64 * U && fabs(gram[0][1]) <= 64 * U &&
           fabs(gram[1][2]) <= 64 * U && fabs(gram[0][2]) <= 64 * U,
       "with half axes of 2, 2 and 1");
    close_world(&world);
}

static void flat_shapes(void)
{
    struct world world;
    const struct mcr_scene *scene = build(&world, "quad { corner (0, 0, 5) u (1, 0, 0) v (0, 1, 0) material m }\n"
                                                  "group { transform { scale (-1, 1, 1) }\n"
                                                  "quad { corner (0, 0, 5) u (1, 0, 0) v (0, 1, 0) material m }\n"
                                                  "disk { center (0, 0, 5) normal (0, 0, 2) radius 1 material m }\n"
                                                  "plane { point (0, 0, 5) normal (1, 0, 1) material m } }\n"
                                                  "disk { center (0, 0, 5) normal (1, 0, 1) radius 1 material m transform { scale (3, 1, 1) } }\n");
    const struct mcr_shape *s;
    double v[3], h = sqrt(0.5);
    if (!ok(scene != NULL, "flat shapes are built"))
        return;
    s = scene->shape;
    ok(s[0].kind == MCR_SHAPE_PARALLELOGRAM && same3(s[0].n, 0, 0, 1), "the front of a quad is along u x v");
    unscaled(scene, s[1].e[0], v);
    ok(same3(v, -1, 0, 0) && same3(s[1].n, 0, 0, 1), "mirrored, its front stays where it was");
    ok(s[2].kind == MCR_SHAPE_DISK && same3(s[2].n, 0, 0, 1), "a disk's too");
    ok(near3(s[3].n, -h, 0, h, 2 * U), "a mirrored plane has a mirrored normal");
    unscaled(scene, s[3].c, v);
    ok(near3(v, -2.5, 0, 2.5, 16 * U), "its point is the one nearest to the camera");
    ok(near3(s[4].n, 1 / sqrt(10), 0, 3 / sqrt(10), 4 * U), "a stretched disk's normal is by the inverse transpose");
    ok(fabs(mcr_dot(s[4].n, s[4].e[0])) <= 4 * U && fabs(mcr_dot(s[4].n, s[4].e[1])) <= 4 * U, "its half axes lie in its plane");
    mcr_cross(s[4].e[0], s[4].e[1], v);
    ok(fabs(mcr_length(v) / (scene->scale * scene->scale) - sqrt(5)) <= 16 * U,
       "and span its area"); /* |cof (1,0,1)/sqrt 2| = |(1,0,3)|/sqrt 2 */
    close_world(&world);
}

static void boxes(void)
{
    struct world world;
    const struct mcr_scene *scene = build(&world, "box { size (1, 2, 3) material m }\n"
                                                  "box { min (1, 1, 1) max (2, 3, 4) material m transform { rotate (0, 1, 0, 90) } }\n"
                                                  "sphere { center (0, 0, 9) radius 1 material lamp }\n");
    double v[3];
    if (!ok(scene != NULL, "boxes are built"))
        return;
    unscaled(scene, scene->shape[0].c, v);
    ok(same3(v, 0, 0, 0), "a box is at the origin by default");
    unscaled(scene, scene->shape[1].c, v);
    ok(same3(v, 1, 1, -1), "turned by a quarter about y, x becomes -z");
    unscaled(scene, scene->shape[1].e[2], v);
    ok(same3(v, 3, 0, 0), "and z becomes x");
    ok(scene->shape[1].primitive == 6 && scene->shape[2].primitive == 12 && scene->primitive_count == 13, "a box counts as six surfaces");
    ok(scene->has_lights, "the emitting sphere is a light");
    ok(scene->shape[2].place.line == 7, "shapes know their line");
    close_world(&world);
}

static void quads(void)
{
    struct world world;
    const struct mcr_scene *scene =
        build(&world, "quad { corners ((0, 0, 5), (1, 0, 5), (1.5, 1, 5), (0.5, 1, 5)) material m }\n"
                      "quad { corner (0, 0, 5) u (1, 0, 0) v (0.5, 1, 0) material m }\n"
                      "quad { corners ((0, 0, 5), (2, 0, 5), (1.5, 1, 5), (0.5, 1, 5)) material lamp }\n"
                      "quad { corners ((0, 0, 5), (2, 0, 5), (1.5, 1, 5), (0.5, 1, 5)) material m transform { scale (-1, 1, 1) } }\n");
    const struct mcr_triangles *t;
    if (!ok(scene != NULL, "quads are built"))
        return;
    t = &scene->triangles;
    ok(scene->shape_count == 2 && memcmp(scene->shape[0].e, scene->shape[1].e, sizeof scene->shape[0].e) == 0 &&
           memcmp(scene->shape[0].c, scene->shape[1].c, sizeof scene->shape[0].c) == 0,
       "four corners of a parallelogram give the same bits as its edges");
    ok(t->count == 4 && t->vertex_count == 8 && t->first_primitive == 2 && scene->primitive_count == 6,
       "a trapezoid becomes two triangles");
    ok(scene->has_lights, "which are lights where they emit");
    for (uint32_t i = 0; i < t->count; i++) {
        const uint32_t *v = t->vertex[i];
        double area = (t->x[v[1]] - t->x[v[0]]) * (t->y[v[2]] - t->y[v[0]]) - (t->y[v[1]] - t->y[v[0]]) * (t->x[v[2]] - t->x[v[0]]);
        ok(area > 0, "triangle %u is counter-clockwise, %s", i, i < 2 ? "as given" : "mirrored");
    }
    ok(t->vertex[0][0] == t->vertex[1][0] && t->vertex[0][2] == t->vertex[1][1], "both share the diagonal");
    close_world(&world);
}

static void meshes(void)
{
    struct world world;
    const struct mcr_scene *scene =
        build(&world, "mesh { vertices ((0, 0, 5), (2, 0, 5), (2, 2, 5), (0, 2, 5), (1.5, 0.5, 5), (1, 1, 5)) material m\n"
                      "faces ((0, 1, 2, 3), (0, 4, 2, 3), (4, 2, 3, 0), (0, 5, 2), (1, 2, 3)) }\n"
                      "triangle { a (0, 0, 5) b (1, 0, 5) c (0, 1, 5) normals ((1, 0, 1), (0, 0, 1), (0, 1, 1)) uv ((0, 0), (1, 0), (0, 1))\n"
                      "material m transform { scale (-1, 1, 1) } }\n"
                      "mesh { vertices ((0, 0, 6), (1, 0, 6), (0, 1, 6)) faces ((0, 1, 2)) uv ((0, 0), (0.5, 0), (0, 0.5)) material m }\n");
    const struct mcr_triangles *t;
    double h = sqrt(0.5);
    const uint32_t *n;
    if (!ok(scene != NULL, "meshes are built"))
        return;
    t = &scene->triangles;
    ok(scene->dropped == 1 && mcr_diagnostics_warnings(world.diagnostics) == 2,
       "a triangle without area is left out, with a warning (the other one is of the lamp, which is not used)");
    ok(t->count == 9, "quadrilaterals give two triangles: %u in all", t->count);
    for (uint32_t i = 0; i < 6; i++) {
        const uint32_t *v = t->vertex[i];
        double area = (t->x[v[1]] - t->x[v[0]]) * (t->y[v[2]] - t->y[v[0]]) - (t->y[v[1]] - t->y[v[0]]) * (t->x[v[2]] - t->x[v[0]]);
        ok(area > 0, "triangle %u is not folded over, also of concave quadrilaterals", i);
    }
    ok(t->normal && t->normal[0][0] == UINT32_MAX && t->uv[0][2] == UINT32_MAX, "triangles without normals or uv say so");
    n = t->normal[7];
    ok(near3((const double[3]){ t->nx[n[0]], t->ny[n[0]], t->nz[n[0]] }, -h, 0, h, 2 * U),
       "normals of a mirrored triangle are mirrored, and unit");
    ok(t->vertex[7][1] == t->vertex[7][0] + 2 && n[1] == n[0] + 2 && t->uv[7][1] == t->uv[7][0] + 2,
       "its corners, normals and uv swap together");
    n = t->uv[8];
    ok(t->normal[8][1] == UINT32_MAX && t->u[n[1]] == 0.5 && t->v[n[2]] == 0.5, "uv of a mesh go by its vertices");
    close_world(&world);
}

int main(void)
{
    spheres();
    flat_shapes();
    boxes();
    quads();
    meshes();
    return tap_done();
}
