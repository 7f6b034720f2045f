/* Looks up grids. Samples are fetched whole and interpolated here, because texture filters differ
 * from device to device (docs/determinism.md, 8). */
#ifndef KILN_SHARED_GRID_H
#define KILN_SHARED_GRID_H

#include "shared/exact.h"
#include "shared/layout.h"

/* A place along one axis: the first of the two samples around it, and the part of the way to the
 * second. */
struct grid_axis {
    uint first;
    float part;
    /* the place is inside of the grid; otherwise the others describe the nearest place that is */
    bool inside;
};

FN S(grid_axis) grid_along(float metres, float origin, float per_metre, uint size)
{
    EXACT S(grid_axis) axis;
    EXACT float at = (metres - origin) * per_metre;
    EXACT float last = FLOAT(size - 1u);
    axis.inside = at >= 0.0f && at <= last;
    EXACT float held = exact_clamp(at, 0.0f, last);
    EXACT float whole = FLOOR(held);
    EXACT float before_last = last - 1.0f;
    whole = exact_min(whole, before_last);
    axis.first = UINT(whole);
    axis.part = held - whole;
    return axis;
}

struct grid_place {
    S(grid_axis) x, y, z;
};

FN S(grid_place) grid_find(S(kiln_grid) g, float3 p)
{
    EXACT S(grid_place) place;
    place.x = grid_along(p.x, g.origin.x, g.per_metre.x, g.size.x);
    place.y = grid_along(p.y, g.origin.y, g.per_metre.y, g.size.y);
    place.z = grid_along(p.z, g.origin.z, g.per_metre.z, g.size.z);
    return place;
}

/* Returns the index of a word. Words lie by z, y, x, so neighbours along x are neighbours in
 * memory. */
FN uint grid_index(S(kiln_grid) g, uint x, uint y, uint z)
{
    return g.size.w + (z * g.size.y + y) * g.size.x + x;
}

FN float4 grid_lerp(float4 a, float4 b, float t)
{
    EXACT float4 y = FLOAT4(exact_lerp(a.x, b.x, t), exact_lerp(a.y, b.y, t),
                            exact_lerp(a.z, b.z, t), exact_lerp(a.w, b.w, t));
    return y;
}

/* Interpolates between two samples of a row along x. */
FN float4 grid_row(SIM_PARAM S(kiln_grid) g, S(grid_axis) x, uint row_y, uint row_z)
{
    uint at = grid_index(g, x.first, row_y, row_z);
    EXACT float4 before = GRID_WORD(at);
    EXACT float4 after = GRID_WORD(at + 1u);
    EXACT float4 y = grid_lerp(before, after, x.part);
    return y;
}

FN float4 grid_layer(SIM_PARAM S(kiln_grid) g, S(grid_place) p, uint layer)
{
    EXACT float4 before = grid_row(SIM g, p.x, p.y.first, layer);
    EXACT float4 after = grid_row(SIM g, p.x, p.y.first + 1u, layer);
    EXACT float4 y = grid_lerp(before, after, p.y.part);
    return y;
}

/* Interpolates trilinearly between the eight samples around a point, m. Beyond the edges, the
 * values at the edges continue. */
FN float4 grid_at(SIM_PARAM S(kiln_grid) g, float3 p)
{
    EXACT S(grid_place) place = grid_find(g, p);
    EXACT float4 before = grid_layer(SIM g, place, place.z.first);
    EXACT float4 after = grid_layer(SIM g, place, place.z.first + 1u);
    EXACT float4 y = grid_lerp(before, after, place.z.part);
    return y;
}

#endif
