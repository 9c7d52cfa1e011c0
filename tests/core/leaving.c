/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Rays that leave surfaces: the stages `surface` and `compact` with both accelerators, in closed rooms of every kind of shape, turned at random, at all scales
 * and distances from the origin of render space. Surface points must lie on the surface (4 u R for spheres), no ray may meet at once what it leaves, and none
 * may get out of the room: 2e5 paths of two segments behind the first.
 */
#include "../accel/scene.h"
#include "core/groups.h"

#define PATHS 200000u
#define BATCH 2000u
#define SEGMENTS 3

#ifdef __SIZEOF_FLOAT128__
typedef __float128 quad;
#else
typedef long double quad;
#endif

static const struct mcr_stages *stages(void)
{
#if MCR_ISA_COUNT > 1
    return best_isa() == 2 ? &mcr_stages_isa2 : best_isa() == 1 ? &mcr_stages_isa1 : &mcr_stages_isa0;
#else
    return &mcr_stages_isa0;
#endif
}

/* As much of a core as the stages look at: one group that scatters. */
struct bench {
    struct mcr_core core;
    struct mcr_group group;
    uint32_t group_of_material[1], shape_material[MOST_SHAPES];
    struct mcr_render_options options;
    struct mcr_batch batch;
    struct mcr_scene_material material;
};

static void bench_begin(struct bench *b, struct stage *s, uint32_t kind)
{
    memset(b, 0, sizeof *b);
    s->scene.render.depth = 1000;
    s->scene.material_count = 1;
    s->scene.material = &b->material;
    b->core.scene = &s->scene;
    b->core.accel = s->accel[kind];
    b->core.trace = functions_of(best_isa(), kind);
    b->core.stages = stages();
    b->core.options = &b->options;
    b->core.capacity = BATCH;
    b->core.group_count = 1;
    b->core.group = &b->group;
    b->core.group_of_material = b->group_of_material;
    b->group.scatters = 1;
    if (mcr_surfaces_init(&b->core, s->arena) || mcr_batch_init(&b->batch, &b->core))
        abort();
}

/* Known values of a room. */
struct room {
    const char *name;
    double size, far;  /* of the room; of its centre from the origin */
    double wall;       /* radius of the spheres that its walls are, or 0 */
    int round;         /* one sphere or ellipsoid, seen from inside: a ray may meet again what it leaves */
};

struct result {
    uint32_t leaks, self_hits, points;
    double off_sphere; /* largest */
};

/*
 * Distance of a surface point to its sphere in units of u R; of u |c| where the sphere is farther away than its radius, which is what coordinates there
 * are rounded to.
 */
static double off_surface(const struct mcr_shape *shape, const struct mcr_surface_points *at, uint32_t k)
{
    double far = sqrt(shape->c[0] * shape->c[0] + shape->c[1] * shape->c[1] + shape->c[2] * shape->c[2]);
    quad q[3] = {(quad)at->px[k] - shape->c[0], (quad)at->py[k] - shape->c[1], (quad)at->pz[k] - shape->c[2]};
    quad square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
    return fabs((double)(square - (quad)shape->radius * shape->radius) / (sqrt((double)square) + shape->radius)) / (UNIT_ROUNDING * fmax(far, shape->radius));
}

/* Camera rays from around the room's centre. */
static void start(struct mcr_batch *batch, const struct room *room, const double centre[3])
{
    batch->rays = batch->states = BATCH;
    for (uint32_t i = 0; i < BATCH; i++) {
        double d[3];
        random_direction(d);
        batch->rox[i] = centre[0] + room->size * between(-0.2, 0.2);
        batch->roy[i] = centre[1] + room->size * between(-0.2, 0.2);
        batch->roz[i] = centre[2] + room->size * between(-0.2, 0.2);
        batch->rdx[i] = d[0];
        batch->rdy[i] = d[1];
        batch->rdz[i] = d[2];
        batch->source[i] = i;
        batch->state.slot[i] = 0;
        batch->state.bounce[i] = 0;
    }
}

/* Directions over the hemispheres of the points, half of them by cosine and half grazing: cos down to 1e-6. */
static void scatter(struct mcr_batch *batch)
{
    const struct mcr_surface_points *at = &batch->at;
    for (uint32_t k = batch->range[0].begin; k < batch->range[0].end; k++) {
        double n[3] = {at->gx[k], at->gy[k], at->gz[k]}, other[3], e[2][3], angle = between(0, 2 * MCR_PI);
        double cosine = k % 2 ? sqrt(number()) : mcr_exp(between(-14, 0)), sine = sqrt(1 - cosine * cosine), d[3];
        random_direction(other);
        cross_product(n, other, e[0]);
        normalise(e[0]);
        cross_product(n, e[0], e[1]);
        for (int j = 0; j < 3; j++)
            d[j] = cosine * n[j] + sine * (mcr_cos(angle) * e[0][j] + mcr_sin(angle) * e[1][j]);
        normalise(d);
        batch->wx[k] = d[0];
        batch->wy[k] = d[1];
        batch->wz[k] = d[2];
        batch->alive[k] = 1;
        batch->sorted.bounce[k]++;
    }
}

static void run_batch(struct bench *b, const struct stage *s, const struct room *room, const double centre[3], struct result *result)
{
    struct mcr_batch *batch = &b->batch;
    int64_t left[2 * BATCH];
    double cosine[2 * BATCH];
    start(batch, room, centre);
    for (int segment = 0; segment < SEGMENTS; segment++) {
        struct mcr_rays rays = {batch->rays, batch->rox, batch->roy, batch->roz, batch->rdx, batch->rdy, batch->rdz};
        b->core.trace->closest(b->core.accel, &rays, batch->t, batch->hit);
        for (uint32_t j = 0; j < batch->rays; j++) {
            result->leaks += batch->hit[j] < 0;
            /* A round wall is met again after 2 R cos, at half of which the search ends; the ellipsoid's curvature lies within a factor of 16 of that. */
            if (segment > 0)
                result->self_hits += batch->hit[j] == left[j] && (!room->round || batch->t[j] < cosine[j] * room->size / 16);
        }
        b->core.stages->sort(batch);
        b->core.stages->surface(batch);
        if (!batch->range_count)
            return;
        for (uint32_t k = batch->range[0].begin; k < batch->range[0].end; k++) {
            int64_t p = batch->at.primitive[k];
            result->points++;
            if (p < s->scene.shape_count && s->shape[p].kind == MCR_SHAPE_SPHERE)
                result->off_sphere = fmax(result->off_sphere, off_surface(&s->shape[p], &batch->at, k));
        }
        scatter(batch);
        b->core.stages->compact(batch);
        for (uint32_t j = 0; j < batch->rays; j++) {
            uint32_t k = batch->source[j];
            left[j] = batch->at.primitive[k];
            cosine[j] = batch->at.gx[k] * batch->rdx[j] + batch->at.gy[k] * batch->rdy[j] + batch->at.gz[k] * batch->rdz[j];
        }
    }
}

/* The shapes of a room around `centre`, turned. */
static void build(struct stage *s, const struct room *room, const double centre[3], double frame[3][3])
{
    double half = room->size / 2, e[3][3], corner[3], c[3];
    for (int j = 0; j < 3; j++) {
        corner[j] = centre[j] - half * (frame[0][j] + frame[1][j] + frame[2][j]);
        for (int i = 0; i < 3; i++)
            e[i][j] = room->size * frame[i][j];
    }
    if (strcmp(room->name, "box") == 0) {
        stage_axes(s, MCR_SHAPE_BOX, corner, e);
    } else if (strcmp(room->name, "sphere") == 0) {
        stage_sphere(s, centre, half);
    } else if (strcmp(room->name, "ellipsoid") == 0) {
        for (int j = 0; j < 3; j++) {
            e[0][j] *= 0.5;
            e[1][j] *= 0.35;
            e[2][j] *= 0.7;
        }
        stage_axes(s, MCR_SHAPE_ELLIPSOID, centre, e);
    } else if (strcmp(room->name, "triangles") == 0) {
        static const uint32_t face[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
        for (int v = 0; v < 8; v++) {
            for (int j = 0; j < 3; j++)
                c[j] = corner[j] + (v & 1 ? e[0][j] : 0) + (v & 2 ? e[1][j] : 0) + (v & 4 ? e[2][j] : 0);
            stage_vertex(s, c);
        }
        for (int f = 0; f < 6; f++) {
            stage_triangle(s, face[f][0], face[f][1], face[f][2]);
            stage_triangle(s, face[f][0], face[f][2], face[f][3]);
        }
    } else
        for (int f = 0; f < 6; f++) {
            int axis = f / 2;
            double side = f % 2 ? 1 : -1;
            for (int j = 0; j < 3; j++)
                c[j] = room->wall > 0 ? centre[j] + side * (half + room->wall) * frame[axis][j] : corner[j] + (f % 2 ? e[axis][j] : 0);
            if (room->wall > 0)
                stage_sphere(s, c, room->wall);
            else
                stage_flat(s, MCR_SHAPE_PARALLELOGRAM, c, e[(axis + 1) % 3], e[(axis + 2) % 3]);
        }
}

static void test_room(const struct room *room, uint32_t kind)
{
    struct result result = {0};
    struct bench *b = malloc(sizeof *b);
    for (uint32_t done = 0; done < PATHS; done += PATHS / 5) { /* five rooms, each turned and placed anew */
        struct stage *s = stage_create();
        double centre[3], frame[3][3];
        random_direction(centre);
        for (int j = 0; j < 3; j++)
            centre[j] *= room->far;
        random_frame(frame);
        build(s, room, centre, frame);
        stage_ready(s);
        bench_begin(b, s, kind);
        for (uint32_t batch = 0; batch < PATHS / 5; batch += BATCH)
            run_batch(b, s, room, centre, &result);
        mcr_batch_fini(&b->batch);
        stage_destroy(s);
    }
    ok(result.leaks == 0 && result.self_hits == 0 && result.points == SEGMENTS * PATHS && result.off_sphere <= 4,
       "%s, size %g, %g from the origin, %s: %u leaks, %u self-hits at %u points%s", room->name, room->size, room->far, accel_name[kind], result.leaks,
       result.self_hits, result.points, room->wall > 0 ? "; sphere walls" : "");
    if (result.off_sphere > 0)
        printf("# surface points are %.2g u R off at most\n", result.off_sphere);
    free(b);
}

int main(void)
{
    static const char *const name[] = {"quads", "box", "triangles", "sphere", "ellipsoid"};
    /* Render space has the largest coordinate in [.5, 1), but what counts are the ratios. */
    static const double size[] = {1, 1, 1, 1, 1e-9, 1e9}, far[] = {0, 1, 1e4, 1e8, 0, 0};
    for (uint32_t n = 0; n < 5; n++)
        for (uint32_t i = 0; i < 6; i++) {
            struct room room = {name[n], size[i], far[i], 0, n >= 3};
            test_room(&room, i % 2);
        }
    for (double wall = 1e4; wall < 2e8; wall *= 10) {
        struct room room = {"quads", 1, wall < 1e6 ? 0 : 1, wall, 0};
        test_room(&room, 0);
        test_room(&room, 1);
    }
    return tap_done();
}
