/* SPDX-License-Identifier: Apache-2.0 */
/* Triangles: single ones and meshes. Their arrays have room for all that the text can make (mcr_build_mesh_room). */
#include "scene/build.h"
#include "scene/vector.h"

uint32_t mcr_build_add_vertex(struct mcr_build *build, const double at[3], const char *of, struct mcr_place place)
{
    struct mcr_triangles *triangles = &build->scene->triangles;
    uint32_t i = triangles->vertex_count++;
    if (!(mcr_largest(at) <= MCR_EXTENT_LIMIT))
        mcr_error(build, place, "'%s' is moved to a coordinate of %.3g, expected at most %g", of, mcr_largest(at), MCR_EXTENT_LIMIT);
    triangles->x[i] = at[0];
    triangles->y[i] = at[1];
    triangles->z[i] = at[2];
    return i;
}

static void vertex(const struct mcr_triangles *triangles, uint32_t i, double out[3])
{
    out[0] = triangles->x[i];
    out[1] = triangles->y[i];
    out[2] = triangles->z[i];
}

static void store(uint32_t out[3], const uint32_t in[3], int mirrored)
{
    out[0] = in ? in[0] : UINT32_MAX;
    out[1] = in ? in[mirrored ? 2 : 1] : UINT32_MAX;
    out[2] = in ? in[mirrored ? 1 : 2] : UINT32_MAX;
}

int mcr_build_add_triangle(struct mcr_build *build, uint32_t material, int mirrored, const uint32_t corner[3], const uint32_t normal[3],
                           const uint32_t uv[3])
{
    struct mcr_triangles *triangles = &build->scene->triangles;
    uint32_t i = triangles->count;
    double p[3][3], u[3], v[3];
    for (int k = 0; k < 3; k++)
        vertex(triangles, corner[k], p[k]);
    mcr_subtract(p[1], p[0], u);
    mcr_subtract(p[2], p[0], v);
    if (mcr_sine(u, v, NULL) <= MCR_PARALLEL)
        return 0;
    store(triangles->vertex[i], corner, mirrored);
    if (triangles->normal)
        store(triangles->normal[i], normal, mirrored);
    if (triangles->uv) {
        const uint32_t plain[3] = { build->plain_uv, build->plain_uv + 1, build->plain_uv + 2 };
        store(triangles->uv[i], uv ? uv : build->needs ? plain : NULL, mirrored);
    }
    triangles->material[i] = material;
    triangles->count++;
    return 1;
}

/* Stores one shading normal; -1 after an error. */
static int add_normal(struct mcr_build *build, const struct mcr_transform *transform, const struct mcr_value *value, const char *of,
                      const double n[3])
{
    struct mcr_triangles *triangles = &build->scene->triangles;
    uint32_t i = triangles->normal_count;
    double unit[3];
    if (!mcr_transform_normal(transform, n, unit)) {
        mcr_error(build, value->place, "a normal of '%s' is zero", of);
        return -1;
    }
    triangles->nx[i] = unit[0];
    triangles->ny[i] = unit[1];
    triangles->nz[i] = unit[2];
    triangles->normal_count++;
    return 0;
}

uint32_t mcr_build_add_uv(struct mcr_build *build, double u, double v)
{
    struct mcr_triangles *triangles = &build->scene->triangles;
    triangles->u[triangles->uv_count] = u;
    triangles->v[triangles->uv_count] = v;
    return triangles->uv_count++;
}

void mcr_build_triangle(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                        uint32_t material)
{
    const struct mcr_triangles *triangles = &build->scene->triangles;
    double p[3][3], n[9], uv[6], at[3], u[3], v[3];
    uint32_t corner[3], normals[3], uvs[3];
    int has_normals = mcr_read_tuples(build, settings, TRIANGLE_NORMALS, 3, 3, n);
    int has_uv = mcr_read_tuples(build, settings, TRIANGLE_UV, 3, 2, uv);
    int bad = has_normals < 0 || has_uv < 0;
    for (uint32_t k = 0; k < 3; k++)
        bad |= mcr_read_vector(build, settings, TRIANGLE_A + k, p[k]) != 0;
    if (bad)
        return;
    mcr_subtract(p[1], p[0], u);
    mcr_subtract(p[2], p[0], v);
    if (mcr_sine(u, v, NULL) <= MCR_PARALLEL) {
        mcr_error(build, settings->place, "the corners of 'triangle' lie on a line");
        return;
    }
    for (uint32_t k = 0; k < 3; k++) {
        mcr_transform_point(transform, p[k], at);
        corner[k] = mcr_build_add_vertex(build, at, "triangle", settings->place);
        normals[k] = triangles->normal_count;
        uvs[k] = triangles->uv_count;
        if (has_normals == 0) {
            const struct mcr_value *list = mcr_value_resolve(settings->value[TRIANGLE_NORMALS]);
            if (add_normal(build, transform, &list->item[k], settings->of, &n[3 * k]) != 0)
                return;
        }
        if (has_uv == 0)
            mcr_build_add_uv(build, uv[2 * k], uv[2 * k + 1]);
    }
    if (!mcr_build_add_triangle(build, material, transform->mirrored, corner, has_normals == 0 ? normals : NULL, has_uv == 0 ? uvs : NULL))
        mcr_error(build, settings->place, "'triangle' has no area to rounding where it is moved to");
}

static int add_vertices(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                        uint32_t *count)
{
    const struct mcr_value *item;
    double p[3], at[3];
    int result = 0;
    if (mcr_read_list(build, settings, MESH_VERTICES, &item, count) != 0)
        return -1;
    for (uint32_t i = 0; i < *count; i++) {
        if (mcr_read_numbers(build, &item[i], "vertices", settings->of, mcr_word_form(MCR_WORD_POINT), 3, MCR_EXTENT_LIMIT, p) != 0) {
            result = -1;
            continue;
        }
        mcr_transform_point(transform, p, at);
        mcr_build_add_vertex(build, at, "mesh", item[i].place);
    }
    return result;
}

/* What comes once a vertex: normals (width 3) or uv (width 2). 0, 1 if not given, -1 after an error. */
static int add_per_vertex(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform,
                          uint32_t index, uint32_t vertices)
{
    const char *name = settings->word->setting[index].name;
    uint32_t width = index == MESH_NORMALS ? 3 : 2, count;
    const struct mcr_value *item;
    double p[3];
    int result = 0;
    if (!settings->value[index])
        return 1;
    if (mcr_read_list(build, settings, index, &item, &count) != 0)
        return -1;
    if (count != vertices) {
        mcr_error(build, settings->value[index]->place, "'%s' of 'mesh' has %u, expected one for each of the %u vertices", name, count,
                  vertices);
        return -1;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (mcr_read_numbers(build, &item[i], name, settings->of, width == 3 ? mcr_word_form(MCR_WORD_POINT) : "2 numbers (u, v)", width,
                             MCR_EXTENT_LIMIT, p) != 0)
            result = -1;
        else if (width == 2)
            mcr_build_add_uv(build, p[0], p[1]);
        else if (add_normal(build, transform, &item[i], settings->of, p) != 0)
            result = -1;
    }
    return result;
}

/* The vertex numbers of a face, 3 or 4 of them; 0 after an error. */
static uint32_t read_face(struct mcr_build *build, const struct mcr_value *value, uint32_t vertices, uint32_t face[4])
{
    const struct mcr_value *tuple = mcr_value_resolve(value);
    char text[80];
    if (tuple->kind != MCR_VALUE_TUPLE || tuple->count < 3 || tuple->count > 4) {
        mcr_wrong_kind(build, value, "faces", "mesh", "3 or 4 vertex numbers for each");
        return 0;
    }
    for (uint32_t k = 0; k < tuple->count; k++) {
        const struct mcr_value *number = mcr_value_resolve(&tuple->item[k]);
        if (number->kind == MCR_VALUE_ERROR)
            return 0;
        if (number->kind != MCR_VALUE_NUMBER || floor(number->number) != number->number) {
            mcr_error(build, tuple->item[k].place, "a face of 'mesh' has %s, expected whole numbers of vertices",
                      mcr_value_described(number, text));
            return 0;
        }
        if (!(number->number >= 0 && number->number < vertices)) {
            mcr_error(build, tuple->item[k].place, "there is no vertex %.10g in 'mesh', expected 0 to %u", number->number, vertices - 1);
            return 0;
        }
        face[k] = (uint32_t)number->number;
    }
    return tuple->count;
}

/* Whether to cut the quadrilateral from corner 1 to 3: where the cut from 0 to 2 would fold it over, as at a concave corner. */
static int cut_other_way(const struct mcr_triangles *triangles, const uint32_t face[4], uint32_t base)
{
    double p[4][3], a[3], b[3], c[3], one[3], two[3];
    for (int k = 0; k < 4; k++)
        vertex(triangles, base + face[k], p[k]);
    mcr_subtract(p[1], p[0], a);
    mcr_subtract(p[2], p[0], b);
    mcr_subtract(p[3], p[0], c);
    mcr_sine(a, b, one);
    mcr_sine(b, c, two);
    return mcr_dot(one, two) < 0;
}

struct mesh {
    uint32_t material, vertices, base, normal_base, uv_base;
    int has_normals, has_uv, mirrored;
};

static void add_face_triangle(struct mcr_build *build, const struct mesh *mesh, const uint32_t face[4], int a, int b, int c)
{
    const uint32_t v[3] = { face[a], face[b], face[c] };
    uint32_t corner[3], normal[3], uv[3];
    for (int k = 0; k < 3; k++) {
        corner[k] = mesh->base + v[k];
        normal[k] = mesh->normal_base + v[k];
        uv[k] = mesh->uv_base + v[k];
    }
    if (!mcr_build_add_triangle(build, mesh->material, mesh->mirrored, corner, mesh->has_normals ? normal : NULL, mesh->has_uv ? uv : NULL))
        build->scene->dropped++;
}

static void add_faces(struct mcr_build *build, const struct mcr_settings *settings, const struct mesh *mesh)
{
    const struct mcr_triangles *triangles = &build->scene->triangles;
    const struct mcr_value *item;
    uint32_t count, face[4], before = build->scene->dropped;
    if (mcr_read_list(build, settings, MESH_FACES, &item, &count) != 0)
        return;
    if (count == 0)
        mcr_error(build, settings->value[MESH_FACES]->place, "'faces' of 'mesh' is empty");
    for (uint32_t i = 0; i < count; i++) {
        uint32_t corners = read_face(build, &item[i], mesh->vertices, face);
        int other = corners == 4 && cut_other_way(triangles, face, mesh->base);
        if (corners == 0)
            continue;
        add_face_triangle(build, mesh, face, 0, 1, other ? 3 : 2);
        if (corners == 4)
            add_face_triangle(build, mesh, face, other ? 1 : 0, 2, 3);
    }
    if (build->scene->dropped == before + 1)
        mcr_report(build->diagnostics, MCR_WARNING, settings->place, "a triangle of 'mesh' has no area and is left out");
    else if (build->scene->dropped > before)
        mcr_report(build->diagnostics, MCR_WARNING, settings->place, "%u triangles of 'mesh' have no area and are left out",
                   build->scene->dropped - before);
}

void mcr_build_mesh(struct mcr_build *build, const struct mcr_settings *settings, const struct mcr_transform *transform, uint32_t material)
{
    const struct mcr_triangles *triangles = &build->scene->triangles;
    struct mesh mesh = { material, 0, triangles->vertex_count, triangles->normal_count, triangles->uv_count, 0, 0, transform->mirrored };
    int bad = add_vertices(build, settings, transform, &mesh.vertices) != 0, normals, uv;
    if (mesh.vertices == 0)
        return;
    normals = add_per_vertex(build, settings, transform, MESH_NORMALS, mesh.vertices);
    uv = add_per_vertex(build, settings, transform, MESH_UV, mesh.vertices);
    mesh.has_normals = normals == 0;
    mesh.has_uv = uv == 0;
    /* A vertex that could not be read was not stored: faces would name others. */
    if (!bad || triangles->vertex_count - mesh.base == mesh.vertices)
        add_faces(build, settings, &mesh);
}

static uint64_t items_of(const struct mcr_value *value)
{
    value = mcr_value_resolve(value);
    return value->kind == MCR_VALUE_TUPLE ? value->count : 0;
}

void mcr_build_mesh_room(struct mcr_build *build, const struct mcr_item *block)
{
    for (uint32_t i = 0; i < block->count; i++) {
        const struct mcr_item *item = &block->item[i];
        uint64_t n;
        if (item->is_block)
            continue;
        n = items_of(&item->value);
        if (strcmp(item->word, "vertices") == 0)
            build->vertex_room += n;
        else if (strcmp(item->word, "faces") == 0)
            build->triangle_room += 2 * (n > 0 ? n : 1);
        else if (strcmp(item->word, "normals") == 0)
            build->normal_room += n;
        else if (strcmp(item->word, "uv") == 0)
            build->uv_room += n;
    }
}
