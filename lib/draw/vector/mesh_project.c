/* This file projects triangles in perspective. Each triangle spans a pyramid whose apex is the eye
 * and whose sides are planes over the picture, so no triangle has to be clipped. */
#include "draw/vector/mesh_project.h"

#include "shared/exact.h"

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

static struct kiln_row_range pixels_between(float low, float high, float size)
{
    return (struct kiln_row_range){(int16_t)exact_clamp(low - 1.0f, 0.0f, size),
                                   (int16_t)exact_clamp(high + 2.0f, 0.0f, size)};
}

/* Bounds the pixels that a triangle may touch: all of them if part of it is behind the eye, none if
 * all of it is. */
static void find_bounds(float4 frustum, float4 principal, const float3 p[3],
                        struct kiln_projected_triangle *flat)
{
    const float width = frustum.z, height = frustum.w;
    float low[2] = {1e9f, 1e9f}, high[2] = {-1e9f, -1e9f};
    int in_front = 0;
    for (int k = 0; k < 3; k++) {
        float depth = -p[k].z;
        if (depth < KILN_MESH_NEAREST)
            continue;
        in_front++;
        float x = principal.x + p[k].x / (depth * frustum.x) * 0.5f * width;
        float y = principal.y - p[k].y / (depth * frustum.y) * 0.5f * height;
        low[0] = exact_min(low[0], x);
        high[0] = exact_max(high[0], x);
        low[1] = exact_min(low[1], y);
        high[1] = exact_max(high[1], y);
    }
    if (in_front == 0)
        return;
    bool crosses_eye = in_front < 3;
    flat->x = pixels_between(crosses_eye ? 0.0f : low[0], crosses_eye ? width : high[0], width);
    flat->y = pixels_between(crosses_eye ? 0.0f : low[1], crosses_eye ? height : high[1], height);
}

bool kiln_mesh_project(const float3 corner[3], float4 frustum, float4 principal,
                       struct kiln_projected_triangle *flat, float3 *face, float *volume)
{
    *flat = (struct kiln_projected_triangle){.y = {0, 0}};
    *face = float3_cross(float3_sub(corner[1], corner[0]), float3_sub(corner[2], corner[0]));
    *volume = float3_dot(corner[0], *face);
    /* A triangle seen edge-on has no pixels and no depth. */
    const float size2 = float3_dot(*face, *face) * float3_dot(corner[0], corner[0]);
    if (!(*volume * *volume > 1e-10f * size2))
        return false;
    const float sign = *volume < 0.0f ? -1.0f : 1.0f;
    set_plane(flat->nearness, float3_scale(*face, 1.0f / *volume));
    for (int k = 0; k < 3; k++)
        set_plane(flat->edges[k],
                  float3_scale(side_of(corner[(k + 1) % 3], corner[(k + 2) % 3]), sign));
    find_bounds(frustum, principal, corner, flat);
    return true;
}
