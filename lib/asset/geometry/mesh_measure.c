/* Measures the size of a mesh: the middle of its bounding box, the box's longest edge, the distance
 * from the middle to the farthest vertex, and the radius of a disc as large as the mesh's shadow is
 * on average over all directions of light. Areas are summed in double precision. */
#include "asset/geometry/mesh_measure.h"

#include <math.h>

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
