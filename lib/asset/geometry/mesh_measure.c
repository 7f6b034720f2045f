/* This file measures the size of a mesh: the middle and longest edge of its bounding box, its
 * farthest vertex from there, and the radius of its mean shadow. Sums are in double. */
#include "asset/geometry/mesh_measure.h"

#include <math.h>

/* Computes a triangle's normal, of twice its area in length. */
static void double_area(const struct kiln_mesh *mesh, const uint32_t corners[3], double out[3])
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

/* Returns the area of the mean shadow. For a convex body it is a quarter of the surface (Cauchy).
 * An open mesh is closed by a lid, whose area is the length of the sum of all area vectors; that
 * sum is 0 for a closed mesh. */
static double mean_shadow(const struct kiln_mesh *mesh)
{
    double area = 0.0, sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        double normal[3];
        double_area(mesh, mesh->triangles[i], normal);
        area += 0.5 * length(normal);
        for (int c = 0; c < 3; c++)
            sum[c] += 0.5 * normal[c];
    }
    return 0.25 * (area + length(sum));
}

struct kiln_mesh_measure kiln_mesh_measure(const struct kiln_mesh *mesh)
{
    struct kiln_mesh_measure measure = {.edge = 0.0f};
    for (int c = 0; c < 3; c++) {
        measure.middle[c] = 0.5f * (mesh->min[c] + mesh->max[c]);
        measure.edge = fmaxf(measure.edge, mesh->max[c] - mesh->min[c]);
    }
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        double away[3];
        for (int c = 0; c < 3; c++)
            away[c] = (double)mesh->vertices[i][c] - (double)measure.middle[c];
        measure.reach = fmaxf(measure.reach, (float)length(away));
    }
    double shade = sqrt(mean_shadow(mesh) / 3.14159265358979);
    measure.shade = fminf((float)shade, measure.reach);
    return measure;
}
