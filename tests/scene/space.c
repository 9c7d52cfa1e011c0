/* SPDX-License-Identifier: Apache-2.0 */
/* Render space: neither a far origin nor the unit of length changes a bit of it. */
#include "help.h"

#include "scene/vector.h"

/* One of each shape, under a rotation; offset and unit are filled in. Coordinates are multiples of 1/4, so that 1e8 + them is exact. */
static const char template[] =
    "let s = %s\nlet o = %s\n"
    "camera thinlens { from (o + s * 1, o + s * 2, s * -8) to (o + s * 1, o + s * 2, 0) fov 50 lens_radius s * 0.25 }\n" MATERIALS
    "plane { point (o + s * 4, o - s * 2, 0) normal (0, 1, 0) material m }\n"
    "quad { corner (o, o, s * 4) u (s * 2, 0, 0) v (0, s * 1, 0) material lamp }\n"
    "group { transform { translate (o, o, 0) } group { transform { rotate (1, 2, 3, 40) }\n"
    "sphere { center (s * 1, s * 2, s * 3) radius s * 0.5 material m }\n"
    "sphere { center (s * 1, s * 2, s * 3) radius s * 0.5 material m transform { scale (1, 2, 0.5) } }\n"
    "disk { center (s * 1, 0, 0) normal (1, 1, 0) radius s * 0.5 material m }\n"
    "box { corner (s * 3, 0, 0) size (s * 1, s * 2, s * 1) material m }\n"
    "mesh { vertices ((0, 0, 0), (s * 1, 0, 0), (0, s * 1, 0), (0, 0, s * 1)) faces ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)) material m }\n"
    "} }\n";

static struct world build(const char *scale, const char *offset)
{
    char text[8192];
    snprintf(text, sizeof text, template, scale, offset);
    return open_world(text, NULL);
}

static double largest(const struct mcr_scene *scene)
{
    double most = 0;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const struct mcr_shape *s = &scene->shape[i];
        for (int k = 0; k < 8 && s->kind != MCR_SHAPE_ELLIPSOID && s->kind != MCR_SHAPE_DISK; k++)
            for (int j = 0; j < 3; j++)
                most = fmax(most, fabs(s->c[j] + (k & 1 ? 1 : -1) * s->radius * (s->kind == MCR_SHAPE_SPHERE) + (k & 1 ? s->e[0][j] : 0) +
                                       (k & 2 ? s->e[1][j] : 0) + (k & 4 ? s->e[2][j] : 0)));
    }
    return most;
}

/* The same bits but for places. */
static int same_shapes(const struct mcr_scene *a, const struct mcr_scene *b)
{
    int same = a->shape_count == b->shape_count && a->triangles.count == b->triangles.count;
    for (uint32_t i = 0; same && i < a->shape_count; i++) {
        const struct mcr_shape *p = &a->shape[i], *q = &b->shape[i];
        same = p->kind == q->kind && memcmp(p->c, q->c, sizeof p->c) == 0 && memcmp(p->e, q->e, sizeof p->e) == 0 &&
               memcmp(p->n, q->n, sizeof p->n) == 0 && p->radius == q->radius;
    }
    return same && memcmp(a->triangles.x, b->triangles.x, a->triangles.vertex_count * sizeof(double)) == 0 &&
           memcmp(a->triangles.y, b->triangles.y, a->triangles.vertex_count * sizeof(double)) == 0 &&
           memcmp(a->triangles.z, b->triangles.z, a->triangles.vertex_count * sizeof(double)) == 0 &&
           memcmp(a->camera.forward, b->camera.forward, sizeof a->camera.forward) == 0 && a->camera.half_height == b->camera.half_height &&
           a->camera.lens_radius == b->camera.lens_radius && a->camera.focus_distance == b->camera.focus_distance;
}

int main(void)
{
    /* Powers of two, and what a decimal scale can reach. */
    static const char *const scales[] = { "2^-30", "2^40", "2^-200", "2^300" };
    struct world plain = build("1", "0"), other;
    if (!ok(plain.scene != NULL, "the scene is built"))
        return tap_done();
    ok(plain.scene->scale == 0x1p-4, "its largest coordinate is 12 from the camera: scaled by 1/16, got %g", plain.scene->scale);
    ok(largest(plain.scene) >= 0.5 && largest(plain.scene) < 1, "coordinates end in [0.5, 1): %g", largest(plain.scene));
    ok(plain.scene->camera.lens_radius == 0.25 / 16 && plain.scene->camera.focus_distance == 0.5, "the lens is scaled too");
    ok(same3(plain.scene->camera.world, 1, 2, -8), "the camera remembers where it was");

    other = build("1", "1e8");
    ok(other.scene && same_shapes(plain.scene, other.scene), "an offset of 1e8 changes no bit");
    close_world(&other);
    for (size_t i = 0; i < sizeof scales / sizeof scales[0]; i++) {
        other = build(scales[i], "0");
        ok(other.scene && same_shapes(plain.scene, other.scene), "a unit of %s changes no bit", scales[i]);
        close_world(&other);
    }
    other = build("1e-90", "0");
    ok(other.scene && largest(other.scene) >= 0.5 && largest(other.scene) < 1, "a scale of 1e-90 ends in [0.5, 1)");
    close_world(&other);
    other = build("1e90", "0");
    ok(other.scene && largest(other.scene) >= 0.5 && largest(other.scene) < 1, "a scale of 1e90 ends in [0.5, 1)");
    close_world(&other);
    quiet = 1;
    other = build("1e-300", "0");
    ok(!other.scene && mcr_diagnostics_errors(other.diagnostics) > 0, "a scale of 1e-300 is an error");
    close_world(&other);
    other = build("1e300", "0");
    ok(!other.scene && mcr_diagnostics_errors(other.diagnostics) > 0, "a scale of 1e300 is an error");
    close_world(&other);
    quiet = 0;
    other = open_world("camera perspective { from (0, 0, 0) to (0, 0, 1) fov 40 }\n", NULL);
    ok(other.scene && other.scene->scale == 1 && other.scene->primitive_count == 0, "an empty scene is one");
    close_world(&other);
    close_world(&plain);
    return tap_done();
}
