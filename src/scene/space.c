/* SPDX-License-Identifier: Apache-2.0 */
/* Render space: what emits, how far the scene reaches, and the power of two that all lengths are multiplied by. */
#include "scene/build.h"
#include "scene/vector.h"

/*
 * The smallest length in render space of a radius or an edge: its square, and products of four such lengths, must stay normal numbers.
 */
#define SMALLEST 0x1p-250

/* The largest absolute coordinate of a bounded shape, or the distance of a plane. */
static double shape_extent(const struct mcr_shape *shape)
{
    double extent = 0;
    if (shape->kind == MCR_SHAPE_PLANE)
        return mcr_largest(shape->c);
    for (int i = 0; i < 3; i++) {
        double below = shape->c[i], above = shape->c[i];
        if (shape->kind == MCR_SHAPE_PARALLELOGRAM || shape->kind == MCR_SHAPE_BOX) {
            for (int j = 0; j < 3; j++) {
                below += mcr_min(shape->e[j][i], 0);
                above += mcr_max(shape->e[j][i], 0);
            }
        } else {
            const double reach[3] = { shape->e[0][i], shape->e[1][i], shape->e[2][i] };
            double half = mcr_max(shape->radius, mcr_length(reach));
            below -= half;
            above += half;
        }
        extent = mcr_max(extent, mcr_max(fabs(below), fabs(above)));
    }
    return extent;
}

static void find_extent(struct mcr_build *build)
{
    const struct mcr_scene *scene = build->scene;
    const struct mcr_triangles *triangles = &scene->triangles;
    const struct mcr_camera *camera = &scene->camera;
    double extent = camera->lens_radius;
    for (uint32_t i = 0; i < scene->light_count; i++)
        extent = mcr_max(extent, mcr_largest(scene->light[i].position));
    for (uint32_t i = 0; i < scene->shape_count; i++)
        extent = mcr_max(extent, shape_extent(&scene->shape[i]));
    for (uint32_t i = 0; i < triangles->count; i++) {
        for (int k = 0; k < 3; k++) {
            uint32_t v = triangles->vertex[i][k];
            extent = mcr_max(extent, mcr_max(fabs(triangles->x[v]), mcr_max(fabs(triangles->y[v]), fabs(triangles->z[v]))));
        }
    }
    if (camera->kind == MCR_CAMERA_ORTHOGRAPHIC) {
        /* Rays start in the view's rectangle: no further from its centre than this. */
        double aspect = scene->film.height ? (double)scene->film.width / scene->film.height : 1;
        extent = mcr_max(extent, camera->half_height * (1 + aspect));
    }
    build->extent = extent;
}

static void multiply(double *array, uint64_t count, double scale)
{
    for (uint64_t i = 0; i < count; i++)
        array[i] *= scale;
}

/* The shortest length that matters of a shape in render space. */
static double shortest(const struct mcr_shape *shape)
{
    static const uint32_t edges[] = { [MCR_SHAPE_ELLIPSOID] = 3, [MCR_SHAPE_PARALLELOGRAM] = 2, [MCR_SHAPE_DISK] = 2, [MCR_SHAPE_BOX] = 3 };
    double least = shape->kind == MCR_SHAPE_SPHERE ? shape->radius : 1;
    if (shape->kind == MCR_SHAPE_PLANE)
        return 1;
    for (uint32_t j = 0; j < edges[shape->kind]; j++)
        least = mcr_min(least, mcr_length(shape->e[j]));
    return least;
}

static void apply_scale(struct mcr_build *build)
{
    struct mcr_scene *scene = build->scene;
    struct mcr_triangles *triangles = &scene->triangles;
    double scale = scene->scale;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        struct mcr_shape *shape = &scene->shape[i];
        multiply(shape->c, 3, scale);
        multiply(shape->e[0], 9, scale);
        shape->radius *= scale;
        if (shortest(shape) < SMALLEST)
            mcr_error(build, shape->place, "this shape is too small beside the scene: less than %.3g of its extent", SMALLEST);
    }
    for (uint32_t i = 0; i < scene->light_count; i++) {
        struct mcr_scene_light *light = &scene->light[i];
        multiply(light->position, 3, scale);
        if (light->kind != MCR_LIGHT_SUN)
            multiply(light->colour, 3, scale * scale);
    }
    multiply(triangles->x, triangles->vertex_count, scale);
    multiply(triangles->y, triangles->vertex_count, scale);
    multiply(triangles->z, triangles->vertex_count, scale);
    scene->camera.lens_radius *= scale;
    scene->camera.focus_distance *= scale;
    if (scene->camera.kind == MCR_CAMERA_ORTHOGRAPHIC)
        scene->camera.half_height *= scale;
    if (scene->camera.focus_distance > MCR_EXTENT_LIMIT)
        mcr_error(build, build->camera_place, "'focus_distance' is too far beside the extent of the scene");
    if (scene->camera.lens_radius > 0 && scene->camera.lens_radius < SMALLEST)
        mcr_error(build, build->camera_place, "'lens_radius' is too small beside the extent of the scene");
}

static int emits(const struct mcr_scene_material *material)
{
    return (material->traits.does & (MCR_MATERIAL_EMITS_FRONT | MCR_MATERIAL_EMITS_BACK)) && mcr_largest(material->traits.radiance) > 0;
}

void mcr_build_lights(struct mcr_build *build)
{
    struct mcr_scene *scene = build->scene;
    scene->has_lights = mcr_build_sky_emits(scene);
    if (scene->material_count == 0)
        return; /* which shapes have missed: that was told */
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const struct mcr_shape *shape = &scene->shape[i];
        if (!emits(&scene->material[shape->material]))
            continue;
        if (shape->kind != MCR_SHAPE_PLANE) {
            scene->has_lights = 1;
        } else if (!build->planes_emit) {
            build->planes_emit = 1;
            build->plane_place = shape->place;
        }
    }
    for (uint32_t i = 0; i < scene->triangles.count && !scene->has_lights; i++)
        scene->has_lights = emits(&scene->material[scene->triangles.material[i]]);
}

/* Numbers the primitives: shapes in the order of the text, then triangles. */
static void number_primitives(struct mcr_build *build)
{
    struct mcr_scene *scene = build->scene;
    uint64_t number = 0;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        scene->shape[i].primitive = (uint32_t)number;
        number += scene->shape[i].kind == MCR_SHAPE_BOX ? 6 : 1;
    }
    scene->triangles.first_primitive = (uint32_t)number;
    number += scene->triangles.count;
    if (number > INT32_MAX)
        mcr_error(build, (struct mcr_place){ 0 }, "the scene has %llu surfaces, at most %d are allowed", (unsigned long long)number,
                  INT32_MAX);
    scene->primitive_count = (uint32_t)number;
}

void mcr_build_render_space(struct mcr_build *build)
{
    struct mcr_scene *scene = build->scene;
    number_primitives(build);
    find_extent(build);
    scene->scale = 1;
    if (build->extent > 0) {
        if (build->extent < 1 / MCR_EXTENT_LIMIT || build->extent > 4 * MCR_EXTENT_LIMIT) {
            mcr_error(build, (struct mcr_place){ 0 }, "the scene reaches %.3g from the camera, expected %g to %g", build->extent,
                      1 / MCR_EXTENT_LIMIT, 4 * MCR_EXTENT_LIMIT);
            return;
        }
        scene->scale = 0.5 / mcr_power_of_two(build->extent);
    }
    apply_scale(build);
}
