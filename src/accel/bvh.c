/* SPDX-License-Identifier: Apache-2.0 */
/* The tree of boxes: one ray after the other through it, nearest child first. Stage file, compiled once per instruction set. */
#include "accel/isa.h"
#include "accel/kernels.h"

/* Levels of the tree at most; the builder keeps below (accel/build.c). */
#define STACK 96

struct ray {
    double o[3], d[3], inverse[3];
    struct mcr_shear shear;
};

static struct ray ray_of(const struct mcr_rays *rays, uint32_t i, int triangles)
{
    struct ray ray = {.o = {rays->ox[i], rays->oy[i], rays->oz[i]}, .d = {rays->dx[i], rays->dy[i], rays->dz[i]}};
    kernel_inverse(ray.d[0], ray.d[1], ray.d[2], ray.inverse);
    if (triangles)
        ray.shear = kernel_shear(ray.d[0], ray.d[1], ray.d[2]);
    return ray;
}

/*
 * Where the ray enters the box, or +infinity. The far side is moved out by twice the error of a distance, 7 u (difference, inverse: 5, product), which
 * makes the test conservative (Ize, "Robust BVH ray traversal", JCGT 2(2), 2013). The inverses are finite, so nothing is NaN.
 */
static double enter_box(const struct mcr_bvh_node *node, const struct ray *ray, double far)
{
    const double widen = 1 + 16 * 0x1p-53;
    double enter = 0, leave = far;
    for (int j = 0; j < 3; j++) {
        int up = ray->inverse[j] >= 0;
        double a = ((up ? node->lo[j] : node->hi[j]) - ray->o[j]) * ray->inverse[j];
        double b = ((up ? node->hi[j] : node->lo[j]) - ray->o[j]) * ray->inverse[j] * widen;
        enter = a > enter ? a : enter;
        leave = b < leave ? b : leave;
    }
    return enter <= leave * widen ? enter : INFINITY;
}

/* Whether the item is crossed; *number is its primitive. */
static int item_hit(const struct mcr_accel *accel, uint32_t item, const struct ray *r, int64_t *number, double *t)
{
    const double *o = r->o, *d = r->d;
    if (item >= accel->shape_count) {
        const struct mcr_triangles *m = accel->triangles;
        uint32_t f = item - accel->shape_count;
        const uint32_t *v = m->vertex[f];
        *number = (int64_t)m->first_primitive + f;
        return kernel_triangle(&r->shear, m->x[v[0]], m->y[v[0]], m->z[v[0]], m->x[v[1]], m->y[v[1]], m->z[v[1]], m->x[v[2]], m->y[v[2]],
                               m->z[v[2]], o[0], o[1], o[2], t);
    }
    const struct mcr_accel_shape *shape = &accel->shape[item];
    *number = shape->primitive;
    switch (shape->kind) {
    case MCR_SHAPE_PLANE:
        return kernel_plane(shape->k, o[0], o[1], o[2], d[0], d[1], d[2], t);
    case MCR_SHAPE_SPHERE:
        return kernel_sphere(shape->k, o[0], o[1], o[2], d[0], d[1], d[2], t);
    case MCR_SHAPE_ELLIPSOID:
        return kernel_ellipsoid(shape->k, o[0], o[1], o[2], d[0], d[1], d[2], t);
    case MCR_SHAPE_PARALLELOGRAM:
        return kernel_parallelogram(shape->k, o[0], o[1], o[2], d[0], d[1], d[2], t);
    case MCR_SHAPE_DISK:
        return kernel_disk(shape->k, o[0], o[1], o[2], d[0], d[1], d[2], t);
    case MCR_ACCEL_RECTANGLE:
        return kernel_rectangle(shape->k, o[0], r->inverse[0], o[1], d[1], o[2], d[2], t);
    case MCR_ACCEL_RECTANGLE + 1:
        return kernel_rectangle(shape->k, o[1], r->inverse[1], o[2], d[2], o[0], d[0], t);
    case MCR_ACCEL_RECTANGLE + 2:
        return kernel_rectangle(shape->k, o[2], r->inverse[2], o[0], d[0], o[1], d[1], t);
    default: {
        double face;
        int hit;
        if (shape->kind == MCR_ACCEL_UPRIGHT)
            hit = kernel_upright(shape->k, 0, o[0], r->inverse[0], o[1], d[1], o[2], d[2], &face, t);
        else if (shape->kind == MCR_ACCEL_UPRIGHT + 1)
            hit = kernel_upright(shape->k, 1, o[1], r->inverse[1], o[2], d[2], o[0], d[0], &face, t);
        else if (shape->kind == MCR_ACCEL_UPRIGHT + 2)
            hit = kernel_upright(shape->k, 2, o[2], r->inverse[2], o[0], d[0], o[1], d[1], &face, t);
        else
            hit = kernel_box(shape->k, o[0], o[1], o[2], d[0], d[1], d[2], &face, t);
        *number += (int64_t)face;
        return hit;
    }
    }
}

struct best {
    double t;
    int64_t primitive;
};

static void consider(const struct mcr_accel *accel, uint32_t item, const struct ray *ray, struct best *best)
{
    int64_t number;
    double t;
    if (!item_hit(accel, item, ray, &number, &t))
        return;
    if (t < best->t || (t == best->t && best->primitive >= 0 && number < best->primitive)) {
        best->t = t;
        best->primitive = number;
    }
}

/* The nearest crossing before best->t; with `any`, the first that is found. */
static void traverse(const struct mcr_accel *accel, const struct ray *ray, struct best *best, int any)
{
    struct {
        uint32_t node;
        double enter;
    } stack[STACK];
    uint32_t top = 0;
    for (uint32_t p = 0; p < accel->plane_count; p++)
        consider(accel, accel->plane[p], ray, best);
    if (!accel->node_count || (any && best->primitive >= 0))
        return;
    double enter = enter_box(&accel->node[0], ray, best->t);
    if (enter < INFINITY) {
        stack[0].node = 0;
        stack[0].enter = enter;
        top = 1;
    }
    while (top) {
        top--;
        const struct mcr_bvh_node *node = &accel->node[stack[top].node];
        if (stack[top].enter > best->t * (1 + 16 * 0x1p-53))
            continue;
        if (node->count) {
            for (uint32_t j = 0; j < node->count; j++)
                consider(accel, accel->item[node->first + j], ray, best);
            if (any && best->primitive >= 0)
                return;
            continue;
        }
        double left = enter_box(&accel->node[node->first], ray, best->t);
        double right = enter_box(&accel->node[node->first + 1], ray, best->t);
        uint32_t near = node->first, far = node->first + 1;
        if (right < left) {
            double swap = left;
            left = right;
            right = swap;
            near = node->first + 1;
            far = node->first;
        }
        if (right < INFINITY) {
            stack[top].node = far;
            stack[top++].enter = right;
        }
        if (left < INFINITY) {
            stack[top].node = near;
            stack[top++].enter = left;
        }
    }
}

void MCR_ISA_NAME(mcr_bvh_closest)(const struct mcr_accel *accel, const struct mcr_rays *rays, double *t, int64_t *primitive)
{
    for (uint32_t i = 0; i < rays->n; i++) {
        struct ray ray = ray_of(rays, i, accel->triangles->count != 0);
        struct best best = {INFINITY, -1};
        traverse(accel, &ray, &best, 0);
        t[i] = best.t;
        primitive[i] = best.primitive;
    }
}

void MCR_ISA_NAME(mcr_bvh_visible)(const struct mcr_accel *accel, const struct mcr_rays *rays, const double *far, double *visible)
{
    for (uint32_t i = 0; i < rays->n; i++) {
        struct ray ray = ray_of(rays, i, accel->triangles->count != 0);
        struct best best = {far[i], -1};
        traverse(accel, &ray, &best, 1);
        visible[i] = best.primitive < 0 ? 1.0 : 0.0;
    }
}

const struct mcr_accel_functions MCR_ISA_NAME(mcr_accel_functions)[2] = {
    {MCR_ISA_NAME(mcr_list_closest), MCR_ISA_NAME(mcr_list_visible)},
    {MCR_ISA_NAME(mcr_bvh_closest), MCR_ISA_NAME(mcr_bvh_visible)},
};
