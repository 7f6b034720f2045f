/* This file has the operations on meshes in the host's memory: it finds the bounding box, reverses
 * all triangles of a mesh that is inside out, copies and destroys meshes. mesh_in.c imports meshes;
 * mesh.h says who works on a copy. */
#include "asset/geometry/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/mesh_in.h"

void kiln_mesh_find_bounds(struct kiln_mesh *mesh)
{
    for (int c = 0; c < 3; c++)
        mesh->min[c] = mesh->max[c] = mesh->vertices[0][c];
    for (uint32_t i = 1; i < mesh->vertex_count; i++) {
        for (int c = 0; c < 3; c++) {
            mesh->min[c] = fminf(mesh->min[c], mesh->vertices[i][c]);
            mesh->max[c] = fmaxf(mesh->max[c], mesh->vertices[i][c]);
        }
    }
}

/* Returns six times the signed volume of the tetrahedron between a point and a triangle. It is
 * positive if the triangle faces away from the point. The vertices of a triangle run
 * counterclockwise where it is seen from the side that it faces. */
static double six_volumes(const struct kiln_mesh *mesh, const uint32_t triangle[3],
                          const float from[3])
{
    double v[3][3];
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 3; c++)
            v[k][c] = (double)mesh->vertices[triangle[k]][c] - (double)from[c];
    }
    return v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
           v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
           v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
}

void kiln_mesh_face_outwards(struct kiln_mesh *mesh)
{
    double volume = 0.0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        volume += six_volumes(mesh, mesh->triangles[i], mesh->min);
    for (uint32_t i = 0; volume < 0.0 && i < mesh->triangle_count; i++) {
        const uint32_t second = mesh->triangles[i][1];
        mesh->triangles[i][1] = mesh->triangles[i][2];
        mesh->triangles[i][2] = second;
    }
}

static void *copy_of(const void *from, size_t count, size_t size)
{
    void *copy = calloc(count, size);
    return copy ? memcpy(copy, from, count * size) : NULL;
}

struct kiln_mesh *kiln_mesh_copy(const struct kiln_mesh *mesh)
{
    struct kiln_mesh *other = copy_of(mesh, 1, sizeof *mesh);
    if (!other)
        return NULL;
    other->looks = NULL;
    other->vertices = copy_of(mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
    other->triangles = copy_of(mesh->triangles, mesh->triangle_count, sizeof *mesh->triangles);
    other->uvs = mesh->uvs ? copy_of(mesh->uvs, mesh->vertex_count, sizeof *mesh->uvs) : NULL;
    if (!other->vertices || !other->triangles || (mesh->uvs && !other->uvs))
        kiln_mesh_destroy(&other);
    return other;
}

void kiln_mesh_destroy(struct kiln_mesh **mesh)
{
    if (!*mesh)
        return;
    free((*mesh)->vertices);
    free((*mesh)->triangles);
    free((*mesh)->uvs);
    kiln_mesh_looks_destroy(&(*mesh)->looks);
    free(*mesh);
    *mesh = NULL;
}

uint64_t kiln_mesh_bytes(const struct kiln_mesh *mesh)
{
    const uint64_t uv = mesh->uvs ? sizeof *mesh->uvs : 0;
    return mesh->vertex_count * (sizeof *mesh->vertices + uv) +
           mesh->triangle_count * (uint64_t)sizeof *mesh->triangles;
}
