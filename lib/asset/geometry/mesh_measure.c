/* Measures the size of a mesh: the middle of its bounding box, the box's longest edge, the distance
 * from the middle to the farthest vertex, and the radius of a disc as large as the mesh's shadow is
 * on average over all directions of light, and the mesh's thinnest part. Areas are summed in double
 * precision. */
#include "asset/geometry/mesh_measure.h"

#include <math.h>

#include "asset/geometry/nearest.h"

/* Computes the normal of a triangle, scaled to twice the triangle's area. */
static void triangle_normal(const struct kiln_mesh *mesh, const uint32_t corners[3], double out[3])
{
    double a[3], b[3];
    for (int c = 0; c < 3; c++) {
        double from = (double)mesh->vertices[corners[0]][c];
        a[c] = (double)mesh->vertices[corners[1]][c] - from;
        b[c] = (double)mesh->vertices[corners[2]][c] - from;
    }
    for (int c = 0; c < 3; c++) {
        int d = (c + 1) % 3, e = (c + 2) % 3;
        out[c] = a[d] * b[e] - a[e] * b[d];
    }
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Returns the area of the mesh's shadow, averaged over all directions of light. For a convex body
 * this is a quarter of the surface (Cauchy); for another mesh it is an upper bound. The surface of
 * an open mesh includes a flat lid on its opening. The lid's area is the length of the sum of all
 * triangles' normals, each as long as the triangle's area; that sum is 0 for a closed mesh. */
static double mean_shadow_area(const struct kiln_mesh *mesh)
{
    double area = 0.0, sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        double normal[3];
        triangle_normal(mesh, mesh->triangles[i], normal);
        area += 0.5 * length(normal);
        for (int c = 0; c < 3; c++)
            sum[c] += 0.5 * normal[c];
    }
    return 0.25 * (area + length(sum));
}

struct kiln_mesh_measure kiln_mesh_measure(const struct kiln_mesh *mesh)
{
    struct kiln_mesh_measure measure = {0};
    for (int c = 0; c < 3; c++) {
        measure.middle[c] = 0.5f * (mesh->min[c] + mesh->max[c]);
        measure.edge = fmaxf(measure.edge, mesh->max[c] - mesh->min[c]);
    }
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        double offset[3];
        for (int c = 0; c < 3; c++)
            offset[c] = (double)mesh->vertices[i][c] - (double)measure.middle[c];
        measure.reach = fmaxf(measure.reach, (float)length(offset));
    }
    double radius = sqrt(mean_shadow_area(mesh) / 3.14159265358979);
    measure.shadow_radius = fminf((float)radius, measure.reach); /* the bound may be too large */
    return measure;
}

/* Returns six times the volume that a mesh encloses; it is negative if its triangles run clockwise
 * where they are seen from outside. */
static double volume_of(const struct kiln_mesh *mesh)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const float *a = mesh->vertices[mesh->triangles[i][0]];
        double normal[3];
        triangle_normal(mesh, mesh->triangles[i], normal);
        for (int c = 0; c < 3; c++)
            sum += normal[c] * ((double)a[c] - (double)mesh->min[c]);
    }
    return sum;
}

/* Makes the ray from the middle of a triangle inwards. False: the triangle has no area. */
static bool make_ray(const struct kiln_mesh *mesh, uint32_t triangle, struct kiln_nearest_ray *ray)
{
    double normal[3];
    triangle_normal(mesh, mesh->triangles[triangle], normal);
    const double size = length(normal);
    ray->start = triangle;
    for (int c = 0; c < 3; c++) {
        double sum = 0.0;
        for (int k = 0; k < 3; k++)
            sum += (double)mesh->vertices[mesh->triangles[triangle][k]][c];
        ray->from[c] = sum / 3.0;
        ray->way[c] = size > 0.0 ? -normal[c] / size : 0.0;
    }
    return size > 0.0;
}

bool kiln_mesh_thinnest(const struct kiln_mesh *mesh, double *thinnest)
{
    struct kiln_mesh *outwards = NULL; /* a copy of a mesh that is inside out */
    if (volume_of(mesh) < 0.0) {
        outwards = kiln_mesh_copy(mesh);
        if (!outwards)
            return false;
        kiln_mesh_face_outwards(outwards);
    }
    const struct kiln_mesh *measured = outwards ? outwards : mesh;
    struct kiln_nearest *tree = kiln_nearest_create(measured);
    *thinnest = INFINITY;
    for (uint32_t i = 0; tree && i < measured->triangle_count; i++) {
        struct kiln_nearest_ray ray;
        if (make_ray(measured, i, &ray))
            *thinnest = kiln_nearest_along(tree, &ray, *thinnest);
    }
    const bool ok = tree != NULL;
    kiln_nearest_destroy(&tree);
    kiln_mesh_destroy(&outwards);
    return ok;
}
