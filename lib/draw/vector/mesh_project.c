/* This file projects triangles in perspective. Each triangle spans a pyramid whose apex is the eye
 * and whose sides are planes over the picture, so no triangle has to be clipped. */
#include "draw/vector/mesh_project.h"

#include "shared/exact.h"

/* How far a triangle's bounds are widened where it is cut at the nearest depth, px: there a
 * millimetre is many pixels. */
#define NEAREST_MARGIN 2.0f

/* Returns the normal of the pyramid's side through an edge. For the opposite direction of the edge
 * it is exactly the negative, since the ends are ordered first. */
static float3 side_of(float3 a, float3 b)
{
    bool swap = a.x > b.x || (a.x == b.x && (a.y > b.y || (a.y == b.y && a.z > b.z)));
    float3 from = swap ? b : a, to = swap ? a : b;
    return float3_scale(float3_cross(from, float3_sub(to, from)), swap ? -1.0f : 1.0f);
}

/* Sets the plane whose value at (u, v) is the dot product of (u, v, -1) and the normal. */
static void set_plane(float plane[3], float3 normal)
{
    plane[0] = normal.x;
    plane[1] = normal.y;
    plane[2] = -normal.z;
}

void kiln_mesh_bound(const float low[2], const float high[2], float width,
                     struct kiln_projected_triangle *flat)
{
    flat->top = low[1] - KILN_RANGE_MARGIN;
    flat->bottom = high[1] + KILN_RANGE_MARGIN;
    flat->x =
        kiln_row_range_between(low[0] - KILN_RANGE_MARGIN, high[0] + KILN_RANGE_MARGIN, width);
}

/* Holds the least and the greatest x and y of points in a picture, px. */
struct extent {
    float low[2], high[2];
};

/* Adds a point in view space, which is in front of the eye. */
static void extend(struct extent *e, float4 frustum, float4 principal, float3 p)
{
    const float depth = -p.z;
    const float at[2] = {principal.x + p.x / (depth * frustum.x) * 0.5f * frustum.z,
                         principal.y - p.y / (depth * frustum.y) * 0.5f * frustum.w};
    for (int i = 0; i < 2; i++) {
        e->low[i] = exact_min(e->low[i], at[i]);
        e->high[i] = exact_max(e->high[i], at[i]);
    }
}

/* Returns where the line from a point in front of the eye to one that is not has the nearest depth
 * that is drawn. It takes doubles, since the coordinates of distant corners nearly cancel there. */
static float3 where_nearest(float3 front, float3 behind, float nearest)
{
    const double part = -((double)front.z + (double)nearest) / ((double)behind.z - (double)front.z);
    return (float3){(float)((double)front.x + ((double)behind.x - (double)front.x) * part),
                    (float)((double)front.y + ((double)behind.y - (double)front.y) * part),
                    -nearest};
}

/* Bounds the pixels that a triangle may touch; none if all of it is behind the eye. */
static void find_bounds(float4 frustum, float4 principal, float nearest, const float3 p[3],
                        struct kiln_projected_triangle *flat)
{
    struct extent e = {{1e9f, 1e9f}, {-1e9f, -1e9f}};
    bool crosses_eye = false;
    for (int k = 0; k < 3; k++) {
        const float3 other = p[(k + 1) % 3];
        const bool front = -p[k].z >= nearest;
        if (front)
            extend(&e, frustum, principal, p[k]);
        if (front != (-other.z >= nearest)) {
            crosses_eye = true;
            extend(&e, frustum, principal,
                   front ? where_nearest(p[k], other, nearest)
                         : where_nearest(other, p[k], nearest));
        }
    }
    if (e.low[0] > e.high[0])
        return;
    for (int i = 0; i < 2 && crosses_eye; i++) {
        e.low[i] -= NEAREST_MARGIN;
        e.high[i] += NEAREST_MARGIN;
    }
    kiln_mesh_bound(e.low, e.high, frustum.z, flat);
}

bool kiln_mesh_project(const float3 corner[3], float4 frustum, float4 principal, float nearest,
                       struct kiln_projected_triangle *flat, float3 *face, float *volume)
{
    *flat = (struct kiln_projected_triangle){.x = {0, 0}};
    *face = float3_cross(float3_sub(corner[1], corner[0]), float3_sub(corner[2], corner[0]));
    *volume = float3_dot(corner[0], *face);
    /* A triangle seen edge-on has no pixels and no depth. */
    const float size2 = float3_dot(*face, *face) * float3_dot(corner[0], corner[0]);
    if (!(*volume * *volume > 1e-10f * size2))
        return false;
    find_bounds(frustum, principal, nearest, corner, flat);
    const struct kiln_row_range rows = kiln_rows_of_triangle(flat, frustum.w);
    if (rows.from >= rows.to)
        return false;
    const float sign = *volume < 0.0f ? -1.0f : 1.0f;
    set_plane(flat->nearness, float3_scale(*face, 1.0f / *volume));
    for (int k = 0; k < 3; k++)
        set_plane(flat->edges[k],
                  float3_scale(side_of(corner[(k + 1) % 3], corner[(k + 2) % 3]), sign));
    return true;
}
