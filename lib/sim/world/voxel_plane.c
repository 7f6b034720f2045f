/* This file makes the plane that a cell of a volume keeps of a triangle: a place on the triangle
 * near the middle of the cell, and the normal, both at the start and at the end of a step. Normals
 * and weights are computed in double precision. */
#include "sim/world/voxel_plane.h"

#include <math.h>

#include "shared/exact.h"

static bool plane_normal(const float *const p[3], float3 *normal)
{
    double a[3], b[3], n[3];
    for (int c = 0; c < 3; c++) {
        a[c] = (double)p[1][c] - (double)p[0][c];
        b[c] = (double)p[2][c] - (double)p[0][c];
    }
    for (int c = 0; c < 3; c++)
        n[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 0))
        return false;
    *normal = float3_canon(
        FLOAT3((float)(n[0] / length), (float)(n[1] / length), (float)(n[2] / length)));
    return true;
}

/* Computes the barycentric weights of the foot of a point on the triangle's plane. If the foot is
 * outside of the triangle, the weights are those of a place on an edge nearby. */
static void find_weights(const float *const p[3], float3 unit, const double at[3],
                         double weights[3])
{
    const double n[3] = {(double)unit.x, (double)unit.y, (double)unit.z};
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const float *a = p[(k + 1) % 3], *b = p[(k + 2) % 3];
        double area = 0;
        for (int c = 0; c < 3; c++) {
            const int u = (c + 1) % 3, w = (c + 2) % 3;
            area += n[c] * (((double)b[u] - (double)a[u]) * (at[w] - (double)a[w]) -
                            ((double)b[w] - (double)a[w]) * (at[u] - (double)a[u]));
        }
        weights[k] = area > 0 ? area : 0;
        sum += weights[k];
    }
    for (int k = 0; k < 3; k++)
        weights[k] = sum > 0 ? weights[k] / sum : 1.0 / 3;
}

static float3 weighted(const float *const p[3], const double weights[3])
{
    double sum[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++)
            sum[c] += weights[k] * (double)p[k][c];
    return float3_canon(FLOAT3((float)sum[0], (float)sum[1], (float)sum[2]));
}

struct kiln_voxel kiln_voxel_plane(const struct kiln_voxels_input *in, uint32_t triangle,
                                   const double middle[3])
{
    const uint32_t *corners = in->triangles[triangle];
    const float *before[3], *after[3];
    for (int k = 0; k < 3; k++) {
        before[k] = in->before[corners[k]];
        after[k] = in->after[corners[k]];
    }
    struct kiln_voxel plane = {.triangle = triangle};
    double weights[3];
    if (!plane_normal(after, &plane.normal_end)) /* the triangle has an area only after rounding */
        plane.normal_end = FLOAT3(0.0f, 1.0f, 0.0f);
    if (!plane_normal(before, &plane.normal))
        plane.normal = plane.normal_end;
    find_weights(after, plane.normal_end, middle, weights);
    plane.start = weighted(before, weights);
    plane.end = weighted(after, weights);
    return plane;
}
