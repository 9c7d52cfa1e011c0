/* SPDX-License-Identifier: Apache-2.0 */
/* Shapes from text into the camera's frame, in world units. Everything that is degenerate is an error at its place. */
#include "scene/build.h"
#include "scene/vector.h"

struct mcr_shape *mcr_build_new_shape(struct mcr_build *build, const struct mcr_settings *settings, uint32_t kind, uint32_t material)
{
    struct mcr_shape *shape = &build->scene->shape[build->scene->shape_count++];
    shape->kind = kind;
    shape->material = material;
    shape->place = settings->place;
    return shape;
}

/* A point, moved; 0 when it is there. */
static int moved_point(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index,
                       const struct mcr_transform *transform, double out[3])
{
    double p[3];
    int result = mcr_read_vector(build, settings, index, p);
    if (result >= 0)
        mcr_transform_point(transform, p, out);
    return result;
}

/* A normal, as it is in the text; -1 after an error. */
static int read_normal(struct mcr_build *build, const struct mcr_settings *settings, uint32_t index, double out[3])
{
    if (mcr_read_vector(build, settings, index, out) != 0)
        return -1;
    if (mcr_largest(out) == 0) {
        mcr_error(build, settings->value[index]->place, "'normal' of '%s' is zero", settings->of);
        return -1;
    }
    return 0;
}

static void basis(const double n[3], double p[3], double q[3]);

/* Coordinates of a plane count world lengths along two axes of the text's frame, which the transform takes along; both are 0 at the point given. */
static void plane_coordinates(struct mcr_shape *shape, const struct mcr_transform *transform, const double point[3], const double normal[3])
{
    double unit[3], axis[2][3], offset[3];
    mcr_unit(normal, unit);
    basis(unit, axis[0], axis[1]);
    mcr_subtract(shape->c, point, offset);
    for (int i = 0; i < 2; i++)
        mcr_transform_vector(transform, axis[i], shape->axis[i]);
    for (int i = 0; i < 2; i++) {
        double dual[3];
        mcr_cross(shape->axis[1 - i], shape->n, dual);
        shape->uv[i] = mcr_dot(dual, offset) / mcr_dot(dual, shape->axis[i]);
    }
}

static void build_plane(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                        uint32_t material)
{
    double point[3], normal[3], distance;
    struct mcr_shape *shape;
    int bad = moved_point(build, settings, PLANE_POINT, transform, point) != 0;
    bad |= read_normal(build, settings, PLANE_NORMAL, normal) != 0;
    if (bad)
        return;
    shape = mcr_build_new_shape(build, settings, MCR_SHAPE_PLANE, material);
    mcr_transform_normal(transform, normal, shape->n);
    /* The point nearest to the camera stands for all: one that was given far out would spoil the scale. */
    distance = mcr_dot(shape->n, point);
    for (int i = 0; i < 3; i++)
        shape->c[i] = distance * shape->n[i];
    plane_coordinates(shape, transform, point, normal);
}

static void build_sphere(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                         uint32_t material)
{
    double center[3], radius, factor = mcr_transform_similarity(transform);
    struct mcr_shape *shape;
    int bad = moved_point(build, settings, SPHERE_CENTER, transform, center) != 0;
    bad |= mcr_read_number(build, settings, SPHERE_RADIUS, &radius) != 0;
    if (bad)
        return;
    shape = mcr_build_new_shape(build, settings, factor > 0 ? MCR_SHAPE_SPHERE : MCR_SHAPE_ELLIPSOID, material);
    mcr_copy(center, shape->c);
    if (factor > 0) {
        shape->radius = factor * radius;
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++)
                shape->axis[j][i] = transform->l[i][j] / factor;
        return;
    }
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            shape->e[j][i] = transform->l[i][j] * radius;
}

/*
 * Two unit vectors p, q with p x q = n, exact for n along an axis (Duff et al., Building an Orthonormal Basis, Revisited,
 * JCGT 6(1), 2017).
 */
static void basis(const double n[3], double p[3], double q[3])
{
    double sign = n[2] < 0 ? -1 : 1, a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
    p[0] = 1 + sign * n[0] * n[0] * a;
    p[1] = sign * b;
    p[2] = -sign * n[0];
    q[0] = b;
    q[1] = sign + n[1] * n[1] * a;
    q[2] = -n[1];
}

static void build_disk(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                       uint32_t material)
{
    double center[3], normal[3], radius, unit[3], axis[2][3];
    struct mcr_shape *shape;
    int bad = moved_point(build, settings, DISK_CENTER, transform, center) != 0;
    bad |= read_normal(build, settings, DISK_NORMAL, normal) != 0;
    bad |= mcr_read_number(build, settings, DISK_RADIUS, &radius) != 0;
    if (bad)
        return;
    shape = mcr_build_new_shape(build, settings, MCR_SHAPE_DISK, material);
    mcr_copy(center, shape->c);
    mcr_unit(normal, unit);
    basis(unit, axis[0], axis[1]);
    for (int j = 0; j < 2; j++) {
        mcr_transform_vector(transform, axis[j], shape->e[j]);
        for (int i = 0; i < 3; i++)
            shape->e[j][i] *= radius;
    }
    mcr_transform_normal(transform, normal, shape->n);
}

/* Corner and size of a box from either form; -1 after an error. */
static int read_box(struct mcr_build *build, const struct mcr_settings *settings, double corner[3], double size[3])
{
    const struct mcr_value *const *value = settings->value;
    double max[3];
    if (value[BOX_MIN] || value[BOX_MAX]) {
        uint32_t given = value[BOX_MIN] ? BOX_MIN : BOX_MAX, other = value[BOX_MIN] ? BOX_MAX : BOX_MIN;
        uint32_t mixed = value[BOX_CORNER] ? BOX_CORNER : value[BOX_SIZE] ? BOX_SIZE : 0;
        int bad;
        if (mixed) {
            mcr_error(build, settings->key[mixed],
                      "'%s' and '%s' are both given in 'box', expected 'corner' and 'size', or 'min' and 'max'",
                      settings->word->setting[mixed].name, settings->word->setting[given].name);
            return -1;
        }
        if (!value[other]) {
            mcr_error(build, settings->key[given], "'%s' needs '%s' beside it", settings->word->setting[given].name,
                      settings->word->setting[other].name);
            return -1;
        }
        bad = mcr_read_vector(build, settings, BOX_MIN, corner) != 0;
        bad |= mcr_read_vector(build, settings, BOX_MAX, max) != 0;
        if (bad)
            return -1;
        mcr_subtract(max, corner, size);
        for (int i = 0; i < 3; i++) {
            if (!(size[i] > 0)) {
                mcr_error(build, value[BOX_MAX]->place, "'max' of 'box' is not above 'min' along %c", "xyz"[i]);
                return -1;
            }
        }
        return 0;
    }
    if (!value[BOX_SIZE]) {
        if (!settings->damaged)
            mcr_error(build, settings->place, "'box' needs 'size', or 'min' and 'max'");
        return -1;
    }
    if (mcr_read_vector(build, settings, BOX_CORNER, corner) < 0 || mcr_read_vector(build, settings, BOX_SIZE, size) != 0)
        return -1;
    for (int i = 0; i < 3; i++)
        if (corner[i] + size[i] == corner[i]) {
            mcr_error(build, value[BOX_SIZE]->place, "'size' of 'box' is lost beside its corner along %c: %.10g + %.10g is %.10g", "xyz"[i], corner[i],
                      size[i], corner[i]);
            return -1;
        }
    return 0;
}

static void build_box(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                      uint32_t material)
{
    double corner[3], size[3];
    struct mcr_shape *shape;
    if (read_box(build, settings, corner, size) != 0)
        return;
    shape = mcr_build_new_shape(build, settings, MCR_SHAPE_BOX, material);
    mcr_transform_point(transform, corner, shape->c);
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            shape->e[j][i] = transform->l[i][j] * size[j];
}

/* Whether a transform that is all but singular has made edges parallel, or laid them into one plane. */
static int is_flattened(const struct mcr_shape *shape)
{
    double normal[3], third[3];
    if (shape->kind == MCR_SHAPE_PARALLELOGRAM || shape->kind == MCR_SHAPE_DISK)
        return mcr_sine(shape->e[0], shape->e[1], NULL) <= MCR_PARALLEL;
    if (shape->kind != MCR_SHAPE_BOX && shape->kind != MCR_SHAPE_ELLIPSOID)
        return 0;
    if (mcr_sine(shape->e[0], shape->e[1], normal) <= MCR_PARALLEL)
        return 1;
    mcr_unit(shape->e[2], third);
    return fabs(mcr_dot(normal, third)) <= MCR_SINGULAR;
}

/* Within the range of coordinates and with an extent of its own; else an error at the shape, which is taken back. */
static void check_shape(struct mcr_build *build, uint32_t shapes, const struct mcr_settings *settings)
{
    const struct mcr_shape *shape = &build->scene->shape[shapes];
    double most;
    if (build->scene->shape_count == shapes)
        return;
    most = mcr_max(mcr_largest(shape->c), shape->radius);
    for (int j = 0; j < 3; j++)
        most = mcr_max(most, mcr_largest(shape->e[j]));
    if (!(most <= MCR_EXTENT_LIMIT))
        mcr_error(build, settings->place, "'%s' reaches to %.3g, expected coordinates of at most %g", settings->of, most, MCR_EXTENT_LIMIT);
    else if (is_flattened(shape))
        mcr_error(build, settings->place, "'%s' is flat to rounding where it is moved to", settings->of);
    else
        return;
    build->scene->shape_count = shapes;
}

void mcr_build_shape(struct mcr_build *build, const struct mcr_item *block, const struct mcr_transform *transform)
{
    typedef void builder(struct mcr_build *, const struct mcr_settings *, const struct mcr_transform *, uint32_t);
    static const struct {
        const char *word;
        builder *build;
    } table[] = {
        { "plane", build_plane }, { "sphere", build_sphere }, { "quad", mcr_build_quad }, { "disk", build_disk },
        { "box", build_box }, { "triangle", mcr_build_triangle }, { "mesh", mcr_build_mesh },
    };
    struct mcr_transform own = *transform;
    struct mcr_settings settings;
    uint32_t shapes = build->scene->shape_count;
    int64_t material;
    mcr_settings_match(build, block, mcr_scene_block(block->word, NULL), 0, &settings);
    material = mcr_build_find_material(build, &settings);
    if (settings.transform && mcr_build_transform(build, settings.transform, &own) != 0)
        own = *transform; /* go on for the sake of further mistakes */
    for (uint32_t i = 0; i < settings.word->count; i++)
        if ((settings.word->setting[i].flags & MCR_PARAMETER_REQUIRED) && i != SHAPE_MATERIAL && !settings.value[i])
            return;
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
        if (strcmp(table[i].word, block->word) == 0)
            table[i].build(build, &settings, &own, material < 0 ? 0 : (uint32_t)material);
    check_shape(build, shapes, &settings);
}
