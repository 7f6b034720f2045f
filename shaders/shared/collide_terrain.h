/* Intersects segments with a height field (UberFlow 2004, 4.6), for shared/collide.h.
 *
 * A word of its grid is (slope along x, height, slope along z, ceiling). Four points make a cell of
 * two triangles, which share the diagonal from the first to the last point. Over each triangle, the
 * height above ground changes linearly along a path, so that the paper's p0 + d0 / (d0 + d1) * (p1
 * - p0) is exactly the point of impact. A path is followed from cell to cell, so no particle is too
 * fast and no crest too thin. All below the surface, and below its sides, is solid.
 *
 * For a ball, each point is raised by the height at which the centre of the ball is above a slope
 * as steep as at that point. So its centre meets a lattice again; in dents narrower than the ball,
 * it goes too deep. */
#ifndef KILN_SHARED_COLLIDE_TERRAIN_H
#define KILN_SHARED_COLLIDE_TERRAIN_H

#include "shared/collide_ground.h"
#include "shared/grid.h"

/* Returns a point's height, raised for the centre of a ball. */
FN float terrain_point(float4 word, float radius)
{
#if !defined(GL_core_profile) || defined(PUSHES)
    if (radius > 0.0f) {
        EXACT float square = word.x * word.x + word.z * word.z;
        EXACT float y = word.y + radius * exact_sqrt(1.0f + square);
        return y;
    }
#endif
    return word.y;
}

struct terrain_cell {
    uint first; /* index of the first word */
    uint row;   /* words from one row to the next */
    float h00, h10, h01, h11;
};

FN S(terrain_cell) terrain_cell_at(SIM_PARAM S(kiln_grid) g, uint x, uint z, float radius)
{
    EXACT S(terrain_cell) cell;
    cell.first = grid_index(g, x, 0u, z);
    cell.row = g.size.x;
    EXACT float4 word = GRID_WORD(cell.first);
    cell.h00 = terrain_point(word, radius);
    word = GRID_WORD(cell.first + 1u);
    cell.h10 = terrain_point(word, radius);
    word = GRID_WORD(cell.first + cell.row);
    cell.h01 = terrain_point(word, radius);
    word = GRID_WORD(cell.first + cell.row + 1u);
    cell.h11 = terrain_point(word, radius);
    return cell;
}

/* Returns the height at the part u along x and v along z of the cell. */
FN float terrain_height(S(terrain_cell) cell, float u, float v)
{
    bool lower = u >= v;
    EXACT float middle = lower ? cell.h10 : cell.h01;
    EXACT float near = lower ? u : v;
    EXACT float far = lower ? v : u;
    EXACT float y = cell.h00 + near * (middle - cell.h00) + far * (cell.h11 - middle);
    return y;
}

/* Returns whether no path from a to b can touch the ground: both points lie above the ceiling of
 * a's cell, raised for a ball, and at most a cell apart. */
FN bool terrain_is_clear(SIM_PARAM S(kiln_grid) g, float3 a, float3 b, float raised)
{
    EXACT S(grid_axis) x = grid_along(a.x, g.origin.x, g.per_metre.x, g.size.x);
    EXACT S(grid_axis) z = grid_along(a.z, g.origin.z, g.per_metre.z, g.size.z);
    EXACT float way_x = (b.x - a.x) * g.per_metre.x;
    EXACT float way_z = (b.z - a.z) * g.per_metre.z;
    EXACT float4 word = GRID_WORD(grid_index(g, x.first, 0u, z.first));
    bool near = way_x <= 1.0f && way_x >= -1.0f && way_z <= 1.0f && way_z >= -1.0f;
    EXACT float ceiling = word.w + raised;
    return x.inside && z.inside && near && a.y > ceiling && b.y > ceiling;
}

/* A path over the lattice: place and change along x and z in cells, and height in metres. */
struct terrain_path {
    float x, z, y;
    float way_x, way_z, way_y;
};

FN S(terrain_path) terrain_path_of(S(kiln_grid) g, float3 a, float3 b)
{
    EXACT S(terrain_path) path;
    path.x = (a.x - g.origin.x) * g.per_metre.x;
    path.z = (a.z - g.origin.z) * g.per_metre.z;
    path.y = a.y;
    EXACT float way_x = (b.x - a.x) * g.per_metre.x;
    EXACT float way_z = (b.z - a.z) * g.per_metre.z;
    path.way_x = exact_canon(way_x);
    path.way_z = exact_canon(way_z);
    path.way_y = b.y - a.y;
    return path;
}

/* A place of a path within a cell, and its height above the ground. */
struct terrain_place {
    float part;  /* part of the path */
    float aside; /* distance from the line between the triangles */
    float above; /* m */
};

FN S(terrain_place) terrain_place_at(S(terrain_path) path, S(terrain_cell) cell, float x, float z,
                                     float part)
{
    EXACT S(terrain_place) place;
    EXACT float u = path.x + path.way_x * part - x;
    EXACT float v = path.z + path.way_z * part - z;
    EXACT float y = path.y + path.way_y * part;
    u = exact_clamp(u, 0.0f, 1.0f);
    v = exact_clamp(v, 0.0f, 1.0f);
    EXACT float ground = terrain_height(cell, u, v);
    place.part = part;
    place.aside = u - v;
    place.above = y - ground;
    return place;
}

/* Returns the part of the path at which it goes from above ground to below it over one triangle; 2:
 * it does not (UberFlow 2004, 4.6). */
FN float terrain_impact_between(S(terrain_place) a, S(terrain_place) b)
{
    EXACT float fall = a.above - b.above;
    EXACT float quotient = exact_div(a.above, fall);
    EXACT float part = exact_clamp(quotient, 0.0f, 1.0f);
    EXACT float way = b.part - a.part;
    EXACT float y = a.part + way * part;
    EXACT float hit = b.above <= 0.0f ? y : 2.0f;
    hit = a.above <= 0.0f ? a.part : hit;
    return hit;
}

/* Returns the part of the path of an impact in a whole cell, or 2. */
FN float terrain_impact_in(S(terrain_path) path, S(terrain_cell) cell, float x, float z, float from,
                           float to)
{
    EXACT S(terrain_place) a = terrain_place_at(path, cell, x, z, from);
    EXACT S(terrain_place) b = terrain_place_at(path, cell, x, z, to);
    EXACT float turn = a.aside - b.aside;
    EXACT float quotient = exact_div(a.aside, turn);
    EXACT float crossing = exact_clamp(quotient, 0.0f, 1.0f);
    bool crosses = (a.aside < 0.0f) != (b.aside < 0.0f);
    crossing = crosses ? crossing : 1.0f;
    EXACT float way = to - from;
    EXACT float between = from + way * crossing;
    EXACT S(terrain_place) middle = terrain_place_at(path, cell, x, z, between);
    EXACT float first = terrain_impact_between(a, middle);
    EXACT float second = terrain_impact_between(middle, b);
    EXACT float y = first <= 1.0f ? first : second;
    return y;
}

/* Follows a path from cell to cell, between its parts `from` and `to`; returns the part of the
 * first impact, or 2. */
FN float terrain_march(SIM_PARAM S(kiln_grid) g, S(terrain_path) path, float from, float to,
                       float radius)
{
    EXACT float last_x = FLOAT(g.size.x) - 2.0f;
    EXACT float last_z = FLOAT(g.size.z) - 2.0f;
    EXACT float start_x = path.x + path.way_x * from;
    EXACT float start_z = path.z + path.way_z * from;
    EXACT float x = FLOOR(start_x);
    EXACT float z = FLOOR(start_z);
    x = exact_clamp(x, 0.0f, last_x);
    z = exact_clamp(z, 0.0f, last_z);
    EXACT float at = from;
    uint most = g.size.x + g.size.z;
    for (uint i = 0u; i < most; i++) {
        EXACT float leaves_x = collide_leaves(path.x, path.way_x, x);
        EXACT float leaves_z = collide_leaves(path.z, path.way_z, z);
        EXACT float leaves = exact_min(leaves_x, leaves_z);
        EXACT float next = exact_min(leaves, to);
        next = exact_max(next, at);
        EXACT S(terrain_cell) cell = terrain_cell_at(SIM g, UINT(x), UINT(z), radius);
        EXACT float hit = terrain_impact_in(path, cell, x, z, at, next);
        if (hit <= 1.0f)
            return hit;
        if (leaves >= to)
            return 2.0f;
        EXACT float step_x = path.way_x > 0.0f ? 1.0f : -1.0f;
        EXACT float step_z = path.way_z > 0.0f ? 1.0f : -1.0f;
        bool along_x = leaves_x <= leaves_z;
        x = along_x ? x + step_x : x;
        z = along_x ? z : z + step_z;
        if (x < 0.0f || x > last_x || z < 0.0f || z > last_z)
            return 2.0f;
        at = next;
    }
    return 2.0f;
}

/* Returns whether a point is below ground. */
FN bool terrain_is_inside(SIM_PARAM S(kiln_collider) c, float3 p)
{
    EXACT S(kiln_grid) g = AROUND(grids[c.grid]);
    EXACT S(grid_axis) x = grid_along(p.x, g.origin.x, g.per_metre.x, g.size.x);
    EXACT S(grid_axis) z = grid_along(p.z, g.origin.z, g.per_metre.z, g.size.z);
    EXACT S(terrain_cell) cell = terrain_cell_at(SIM g, x.first, z.first, c.center.w);
    EXACT float ground = terrain_height(cell, x.part, z.part);
    return p.x > c.min.x && p.x < c.max.x && p.z > c.min.z && p.z < c.max.z && p.y <= ground;
}

/* Intersects a segment, as collide_segment does. */
FN S(collide_span) terrain_segment(SIM_PARAM S(kiln_collider) c, float3 a, float3 b)
{
    EXACT S(collide_span) span;
    span.enter = 0.0f;
    span.leave = 2.0f;
    span.face = COLLIDE_SURFACE;
    span.misses = false;
    span.outside = false;
    span = collide_face(span, 0u, a.x - c.min.x, b.x - c.min.x);
    span = collide_face(span, 1u, c.max.x - a.x, c.max.x - b.x);
    span = collide_face(span, 4u, a.z - c.min.z, b.z - c.min.z);
    span = collide_face(span, 5u, c.max.z - a.z, c.max.z - b.z);
    span = collide_face(span, COLLIDE_SURFACE, c.max.y - a.y, c.max.y - b.y);
    EXACT S(kiln_grid) g = AROUND(grids[c.grid]);
    EXACT float raised = c.center.w * c.steepest;
    if (span.misses || span.enter > span.leave || terrain_is_clear(SIM g, a, b, raised)) {
        span.misses = true;
        return span;
    }
    EXACT S(terrain_path) path = terrain_path_of(g, a, b);
    EXACT float to = exact_min(span.leave, 1.0f);
    EXACT float hit = terrain_march(SIM g, path, span.enter, to, c.center.w);
    span.misses = hit > 1.0f;
    bool at_once = hit <= span.enter;
    span.face = at_once ? span.face : COLLIDE_SURFACE;
    span.outside = span.outside || !at_once;
    span.enter = hit;
    span.leave = 2.0f;
    return span;
}

/* Returns the surface at a point on it, above or below it. */
FN S(collide_ground) terrain_ground(SIM_PARAM S(kiln_collider) c, float3 p)
{
    EXACT S(kiln_grid) g = AROUND(grids[c.grid]);
    EXACT S(grid_axis) x = grid_along(p.x, g.origin.x, g.per_metre.x, g.size.x);
    EXACT S(grid_axis) z = grid_along(p.z, g.origin.z, g.per_metre.z, g.size.z);
    EXACT S(terrain_cell) cell = terrain_cell_at(SIM g, x.first, z.first, c.center.w);
    EXACT float height = terrain_height(cell, x.part, z.part);
    bool lower = x.part >= z.part;
    EXACT float4 w00 = GRID_WORD(cell.first);
    EXACT float4 middle = GRID_WORD(lower ? cell.first + 1u : cell.first + cell.row);
    EXACT float4 w11 = GRID_WORD(cell.first + cell.row + 1u);
    EXACT float near = lower ? x.part : z.part;
    EXACT float far = lower ? z.part : x.part;
    EXACT float slope_x = w00.x + near * (middle.x - w00.x) + far * (w11.x - middle.x);
    EXACT float slope_z = w00.z + near * (middle.z - w00.z) + far * (w11.z - middle.z);
    EXACT float rise_x = lower ? cell.h10 - cell.h00 : cell.h11 - cell.h01;
    EXACT float rise_z = lower ? cell.h11 - cell.h10 : cell.h01 - cell.h00;
    rise_x = rise_x * g.per_metre.x;
    rise_z = rise_z * g.per_metre.z;
    EXACT float steep = 1.0f + exact_abs(rise_x) + exact_abs(rise_z);
    EXACT float reach = exact_abs(p.x) + exact_abs(height) + exact_abs(p.z);
    EXACT float gap = 6.103515625e-5f + reach * 4.76837158203125e-7f;
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 smooth_normal = FLOAT3(-slope_x, 1.0f, -slope_z);
    EXACT float3 flat_normal = FLOAT3(-rise_x, 1.0f, -rise_z);
    EXACT S(collide_ground) ground;
    ground.position = FLOAT3(p.x, height + gap * steep, p.z);
    ground.normal = float3_normalize(smooth_normal, up);
    ground.facet = float3_normalize(flat_normal, up);
    ground.velocity = FLOAT3(0.0f, 0.0f, 0.0f);
    return ground;
}

/* Returns the surface at a point of one of the walls. */
FN S(collide_ground) terrain_wall(S(kiln_collider) c, uint face, float3 p)
{
    EXACT S(collide_box) box = collide_box_at(c, 0.0f);
    EXACT float3 zero = FLOAT3(0.0f, 0.0f, 0.0f);
    EXACT float out_sign = (face & 1u) != 0u ? 1.0f : -1.0f;
    EXACT S(collide_ground) ground;
    ground.position = collide_put_beside(box, face, p);
    ground.normal = collide_with_component(zero, face >> 1u, out_sign);
    ground.facet = ground.normal;
    ground.velocity = zero;
    return ground;
}

#endif
