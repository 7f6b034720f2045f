/* Intersects segments with the depth maps of a mesh (Kolb et al. 2004, as described in Heinz 2019,
 * 2.5.1), for shared/collide.h. A point between front and back in every map is inside, so hollows
 * that no direction looks into are filled.
 *
 * As over terrain (shared/collide_terrain.h), four samples make a cell of two triangles of the
 * front and two of the back. The points at which a path enters and leaves a map are therefore
 * exact, and no particle is too fast and no part too thin. The mesh moves rigidly, as a mesh with a
 * distance field does (shared/collide_sdf.h). */
#ifndef KILN_SHARED_PAPERS_COLLIDE_DEPTH_H
#define KILN_SHARED_PAPERS_COLLIDE_DEPTH_H

#include "shared/collide_sdf.h"

/* Rows of a depth map, and the word of its first sample. */
struct depth_map {
    float4 column, row, height;
    uint first;
};

FN S(depth_map) depth_map_of(SIM_PARAM S(kiln_grid) g, uint number)
{
    uint rows = g.size.w + 3u * number;
    EXACT S(depth_map) map;
    map.column = GRID_WORD(rows);
    map.row = GRID_WORD(rows + 1u);
    map.height = GRID_WORD(rows + 2u);
    map.first = g.size.w + 3u * g.size.z + number * (2u * g.size.x * g.size.y);
    return map;
}

/* The front and the back of a cell, with heights along the direction. */
struct depth_cell {
    S(terrain_cell) front, back;
};

FN S(depth_cell) depth_cell_at(SIM_PARAM S(kiln_grid) g, S(depth_map) map, uint x, uint z)
{
    uint row = 2u * g.size.x;
    uint at = map.first + z * row + 2u * x;
    EXACT S(depth_cell) cell;
    cell.front.first = at;
    cell.front.row = row;
    EXACT float4 word = GRID_WORD(at);
    cell.front.h00 = word.w;
    word = GRID_WORD(at + 2u);
    cell.front.h10 = word.w;
    word = GRID_WORD(at + row);
    cell.front.h01 = word.w;
    word = GRID_WORD(at + row + 2u);
    cell.front.h11 = word.w;
    cell.back.first = at + 1u;
    cell.back.row = row;
    word = GRID_WORD(at + 1u);
    cell.back.h00 = word.w;
    word = GRID_WORD(at + 3u);
    cell.back.h10 = word.w;
    word = GRID_WORD(at + row + 1u);
    cell.back.h01 = word.w;
    word = GRID_WORD(at + row + 3u);
    cell.back.h11 = word.w;
    return cell;
}

/* Makes the path over a map: columns along x, rows along z, and height. */
FN S(terrain_path) depth_path_of(S(depth_map) map, float3 a, float3 b)
{
    EXACT S(terrain_path) path;
    path.x = sdf_row(map.column, a);
    path.z = sdf_row(map.row, a);
    path.y = sdf_row(map.height, a);
    EXACT float3 way = float3_sub(b, a);
    EXACT float way_x = map.column.x * way.x + map.column.y * way.y + map.column.z * way.z;
    EXACT float way_z = map.row.x * way.x + map.row.y * way.y + map.row.z * way.z;
    path.way_x = exact_canon(way_x);
    path.way_z = exact_canon(way_z);
    path.way_y = map.height.x * way.x + map.height.y * way.y + map.height.z * way.z;
    return path;
}

/* A place of a path within a cell. */
struct depth_place {
    float part;   /* part of the path */
    float aside;  /* distance from the line between the triangles */
    float behind; /* distance behind the front, units of the map; above 0: behind it */
    float before; /* distance before the back, units of the map; above 0: before it */
};

FN S(depth_place) depth_place_at(S(terrain_path) path, S(depth_cell) cell, float x, float z,
                                 float part)
{
    EXACT S(depth_place) place;
    EXACT float u = path.x + path.way_x * part - x;
    EXACT float v = path.z + path.way_z * part - z;
    EXACT float y = path.y + path.way_y * part;
    u = exact_clamp(u, 0.0f, 1.0f);
    v = exact_clamp(v, 0.0f, 1.0f);
    EXACT float front = terrain_height(cell.front, u, v);
    EXACT float back = terrain_height(cell.back, u, v);
    place.part = part;
    place.aside = u - v;
    place.behind = front - y;
    place.before = y - back;
    return place;
}

/* The part of a path that is inside, from `enter` to `leave`; it is empty if it does not enter
 * before it leaves. */
struct depth_inside {
    float enter, leave;
};

/* Narrows a part of a path by one surface over one triangle. d0 and d1 are the distances from the
 * surface at a and b, above 0 on the inner side. */
FN S(depth_inside) depth_within(S(depth_inside) before, S(depth_place) a, S(depth_place) b,
                                float d0, float d1)
{
    EXACT S(depth_inside) y = before;
    EXACT float change = d0 - d1;
    EXACT float quotient = exact_div(d0, change);
    EXACT float part = exact_clamp(quotient, 0.0f, 1.0f);
    EXACT float way = b.part - a.part;
    EXACT float at = a.part + way * part;
    bool in0 = d0 > 0.0f;
    bool in1 = d1 > 0.0f;
    EXACT float later = in1 ? at : 2.0f; /* 2: the path does not enter */
    EXACT float enter = in0 ? y.enter : later;
    EXACT float leave = in1 ? y.leave : at;
    y.enter = exact_max(y.enter, enter);
    y.leave = exact_min(y.leave, leave);
    return y;
}

/* Returns the part that is inside over one triangle. */
FN S(depth_inside) depth_inside_between(S(depth_place) a, S(depth_place) b)
{
    EXACT S(depth_inside) y;
    y.enter = a.part;
    y.leave = b.part;
    y = depth_within(y, a, b, a.behind, b.behind);
    y = depth_within(y, a, b, a.before, b.before);
    return y;
}

/* The first part of a path within one map, and whether its end is known. */
struct depth_found {
    S(depth_inside) inside;
    bool begun, ended;
};

FN S(depth_found) depth_go_on(S(depth_found) before, S(depth_inside) next, S(depth_place) a,
                              S(depth_place) b)
{
    EXACT S(depth_found) found = before;
    bool any = next.enter < next.leave;
    if (a.part >= b.part)
        return found;
    if (!found.begun && any) {
        found.inside = next;
        found.begun = true;
        found.ended = next.leave < b.part;
    } else if (found.begun && !found.ended) {
        bool goes_on = any && next.enter <= a.part;
        found.inside.leave = goes_on ? next.leave : a.part;
        found.ended = !goes_on || next.leave < b.part;
    }
    return found;
}

/* Extends the first part within one map over a whole cell. */
FN S(depth_found) depth_go_through(S(depth_found) before, S(terrain_path) path, S(depth_cell) cell,
                                   float x, float z, float from, float to)
{
    EXACT S(depth_place) a = depth_place_at(path, cell, x, z, from);
    EXACT S(depth_place) b = depth_place_at(path, cell, x, z, to);
    EXACT float turn = a.aside - b.aside;
    EXACT float quotient = exact_div(a.aside, turn);
    EXACT float crossing = exact_clamp(quotient, 0.0f, 1.0f);
    bool crosses = (a.aside < 0.0f) != (b.aside < 0.0f);
    crossing = crosses ? crossing : 1.0f;
    EXACT float way = to - from;
    EXACT float between = from + way * crossing;
    EXACT S(depth_place) middle = depth_place_at(path, cell, x, z, between);
    EXACT S(depth_inside) first = depth_inside_between(a, middle);
    EXACT S(depth_inside) second = depth_inside_between(middle, b);
    EXACT S(depth_found) found = depth_go_on(before, first, a, middle);
    found = depth_go_on(found, second, middle, b);
    return found;
}

/* Follows a path from cell to cell, between its parts `from` and `to`, and returns the first part
 * inside. If it does not end before `to`, its end is 2; if there is none, its start is 2. */
FN S(depth_inside) depth_march(SIM_PARAM S(kiln_grid) g, S(depth_map) map, S(terrain_path) path,
                               float from, float to)
{
    EXACT float last_x = FLOAT(g.size.x) - 2.0f;
    EXACT float last_z = FLOAT(g.size.y) - 2.0f;
    EXACT float start_x = path.x + path.way_x * from;
    EXACT float start_z = path.z + path.way_z * from;
    EXACT float x = FLOOR(start_x);
    EXACT float z = FLOOR(start_z);
    x = exact_clamp(x, 0.0f, last_x);
    z = exact_clamp(z, 0.0f, last_z);
    EXACT S(depth_found) found;
    found.inside.enter = 2.0f;
    found.inside.leave = 2.0f;
    found.begun = false;
    found.ended = false;
    EXACT float at = from;
    bool goes_on = true;
    uint most = g.size.x + g.size.y;
    for (uint i = 0u; i < most && goes_on; i++) {
        EXACT float leaves_x = collide_leaves(path.x, path.way_x, x);
        EXACT float leaves_z = collide_leaves(path.z, path.way_z, z);
        EXACT float leaves = exact_min(leaves_x, leaves_z);
        EXACT float next = exact_min(leaves, to);
        next = exact_max(next, at);
        EXACT S(depth_cell) cell = depth_cell_at(SIM g, map, UINT(x), UINT(z));
        found = depth_go_through(found, path, cell, x, z, at, next);
        EXACT float step_x = path.way_x > 0.0f ? 1.0f : -1.0f;
        EXACT float step_z = path.way_z > 0.0f ? 1.0f : -1.0f;
        bool along_x = leaves_x <= leaves_z;
        x = along_x ? x + step_x : x;
        z = along_x ? z : z + step_z;
        at = next;
        goes_on =
            !found.ended && leaves < to && x >= 0.0f && x <= last_x && z >= 0.0f && z <= last_z;
    }
    found.inside.leave = found.ended ? found.inside.leave : 2.0f;
    return found.inside;
}

/* Returns the part of a path at which it first is inside all maps, or 2. */
FN float depth_first_inside(SIM_PARAM S(kiln_grid) g, float3 a, float3 b, float from, float to)
{
    EXACT float leaves[KILN_MAX_DEPTH_DIRECTIONS]; /* the last end that was found in each map */
    for (uint m = 0u; m < g.size.z; m++)
        leaves[m] = from;
    EXACT float at = from;
    uint most = 2u * (g.size.x + g.size.y);
    bool moved = true;
    for (uint i = 0u; i < most && moved; i++) {
        moved = false;
        for (uint m = 0u; m < g.size.z; m++) {
            if (leaves[m] <= at && at <= 1.0f) {
                EXACT S(depth_map) map = depth_map_of(SIM g, m);
                EXACT S(terrain_path) path = depth_path_of(map, a, b);
                EXACT S(depth_inside) inside = depth_march(SIM g, map, path, at, to);
                leaves[m] = inside.leave;
                at = exact_max(at, inside.enter);
            }
        }
        for (uint m = 0u; m < g.size.z; m++)
            moved = moved || (leaves[m] <= at && at <= 1.0f);
    }
    return at;
}

/* Returns whether a way is outside of one face of the box around all maps. */
FN bool depth_is_clear(S(kiln_grid) g, float3 a, float3 b)
{
    return (a.x < g.low.x && b.x < g.low.x) || (a.y < g.low.y && b.y < g.low.y) ||
           (a.z < g.low.z && b.z < g.low.z) || (a.x > g.high.x && b.x > g.high.x) ||
           (a.y > g.high.y && b.y > g.high.y) || (a.z > g.high.z && b.z > g.high.z);
}

FN S(collide_box) depth_box(S(kiln_grid) g)
{
    EXACT S(collide_box) box;
    box.min = FLOAT3(g.low.x, g.low.y, g.low.z);
    box.max = FLOAT3(g.high.x, g.high.y, g.high.z);
    return box;
}

/* The test of a point against a map: the nearer of its surfaces, and the distance outside of that
 * along the direction. */
struct depth_look {
    float outside;       /* units; below 0: inside */
    float side;          /* 1: the front, -1: the back */
    float far_out;       /* units: distance outside, with a penalty for a steep surface */
    float3 facet;        /* normal of the triangle, not normalised */
    float3 interpolated; /* interpolated normal, of any length */
};

FN S(depth_look) depth_look_at(SIM_PARAM S(kiln_grid) g, S(depth_map) map, float3 q)
{
    EXACT float column = sdf_row(map.column, q);
    EXACT float row = sdf_row(map.row, q);
    EXACT float y = sdf_row(map.height, q);
    EXACT S(grid_axis) x = grid_along(column, 0.0f, 1.0f, g.size.x);
    EXACT S(grid_axis) z = grid_along(row, 0.0f, 1.0f, g.size.y);
    EXACT S(depth_cell) both = depth_cell_at(SIM g, map, x.first, z.first);
    EXACT float above = y - terrain_height(both.front, x.part, z.part);
    EXACT float below = terrain_height(both.back, x.part, z.part) - y;
    EXACT S(depth_look) look;
    look.outside = exact_max(above, below);
    look.side = above >= below ? 1.0f : -1.0f;
    EXACT S(terrain_cell) cell = both.back;
    if (above >= below)
        cell = both.front;
    bool lower = x.part >= z.part;
    EXACT float near = lower ? x.part : z.part;
    EXACT float far = lower ? z.part : x.part;
    EXACT float4 w00 = GRID_WORD(cell.first);
    EXACT float4 middle = GRID_WORD(lower ? cell.first + 2u : cell.first + cell.row);
    EXACT float4 w11 = GRID_WORD(cell.first + cell.row + 2u);
    look.interpolated = FLOAT3(w00.x + near * (middle.x - w00.x) + far * (w11.x - middle.x),
                               w00.y + near * (middle.y - w00.y) + far * (w11.y - middle.y),
                               w00.z + near * (middle.z - w00.z) + far * (w11.z - middle.z));
    EXACT float rise_x = lower ? cell.h10 - cell.h00 : cell.h11 - cell.h01;
    EXACT float rise_z = lower ? cell.h11 - cell.h10 : cell.h01 - cell.h00;
    EXACT float3 up = FLOAT3(map.height.x - rise_x * map.column.x - rise_z * map.row.x,
                             map.height.y - rise_x * map.column.y - rise_z * map.row.y,
                             map.height.z - rise_x * map.column.z - rise_z * map.row.z);
    look.facet = float3_scale(up, look.side);
    EXACT float steep = float3_length(up);
    EXACT float3 columns = FLOAT3(map.column.x, map.column.y, map.column.z);
    EXACT float spacing = exact_rcp(float3_length(columns));
    EXACT float distance = exact_div(look.outside, steep);
    look.far_out = distance - 0.25f * spacing * (steep - 1.0f);
    return look;
}

/* Returns whether a point is between front and back in all maps. */
FN bool depth_is_within(SIM_PARAM S(kiln_grid) g, float3 q)
{
    bool within = true;
    for (uint m = 0u; m < g.size.z; m++) {
        EXACT S(depth_map) map = depth_map_of(SIM g, m);
        EXACT S(depth_look) look = depth_look_at(SIM g, map, q);
        within = within && look.outside < 0.0f;
    }
    return within;
}

/* Intersects a segment between two parts of the step, as collide_segment does. */
FN S(collide_span) depth_segment(SIM_PARAM S(kiln_collider) c, float since, float until, float3 a,
                                 float3 b)
{
    EXACT S(collide_box) at_start = collide_box_at(c, since);
    EXACT S(collide_box) at_end = collide_box_at(c, until);
    EXACT S(collide_span) span = collide_segment(at_start, at_end, a, b);
    if (span.misses)
        return span;
    EXACT S(kiln_pose) pose = AROUND(poses[c.mesh]);
    EXACT S(kiln_grid) g = AROUND(grids[c.grid]);
    EXACT float3 from = sdf_local(pose, since, a);
    EXACT float3 end = sdf_local(pose, until, b);
    EXACT S(collide_box) box = depth_box(g);
    span = collide_segment(box, box, from, end);
    if (span.misses || span.enter > span.leave || depth_is_clear(g, from, end)) {
        span.misses = true;
        return span;
    }
    EXACT float to = exact_min(span.leave, 1.0f);
    EXACT float hit = depth_first_inside(SIM g, from, end, span.enter, to);
    if (from.x == end.x && from.y == end.y && from.z == end.z) {
        bool within = depth_is_within(SIM g, from);
        hit = within ? span.enter : 2.0f;
    }
    span.misses = hit > 1.0f;
    span.outside = span.outside || hit > span.enter;
    span.enter = hit;
    span.leave = 2.0f;
    span.face = COLLIDE_SURFACE;
    return span;
}

FN bool depth_is_inside(SIM_PARAM S(kiln_collider) c, float until, float3 p)
{
    EXACT S(collide_box) bounds = collide_box_at(c, until);
    EXACT S(kiln_grid) g = AROUND(grids[c.grid]);
    EXACT float3 q = sdf_local(AROUND(poses[c.mesh]), until, p);
    EXACT S(collide_box) box = depth_box(g);
    return collide_inside(bounds, p) && collide_inside(box, q) && depth_is_within(SIM g, q);
}

/* Returns the surface at a point on it or near it, by the map in which the surface is nearest; of
 * maps with about the same distance, by the one that sees the surface least obliquely. The result's
 * position lies outside along that map's direction. */
FN S(collide_ground) depth_ground(SIM_PARAM S(kiln_collider) c, float since, float3 p)
{
    EXACT S(kiln_pose) pose = AROUND(poses[c.mesh]);
    EXACT S(kiln_grid) g = AROUND(grids[c.grid]);
    EXACT float metres = collide_moving(pose.metres.x, pose.metres.y, since);
    EXACT float3 q = sdf_local(pose, since, p);
    EXACT S(depth_map) map = depth_map_of(SIM g, 0u);
    EXACT S(depth_look) nearest = depth_look_at(SIM g, map, q);
    EXACT float3 along = FLOAT3(map.height.x, map.height.y, map.height.z);
    for (uint m = 1u; m < g.size.z; m++) {
        map = depth_map_of(SIM g, m);
        EXACT S(depth_look) look = depth_look_at(SIM g, map, q);
        if (look.far_out > nearest.far_out) {
            nearest = look;
            along = FLOAT3(map.height.x, map.height.y, map.height.z);
        }
    }
    along = float3_scale(along, nearest.side);
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 off = sdf_slope_to_world(pose, since, along);
    off = float3_normalize(off, up);
    EXACT float3 flat_normal = sdf_slope_to_world(pose, since, nearest.facet);
    EXACT float3 smooth_normal = sdf_slope_to_world(pose, since, nearest.interpolated);
    EXACT float steep =
        exact_abs(nearest.facet.x) + exact_abs(nearest.facet.y) + exact_abs(nearest.facet.z);
    EXACT float reach = exact_abs(p.x) + exact_abs(p.y) + exact_abs(p.z);
    EXACT float gap = 6.103515625e-5f + reach * 9.5367431640625e-7f;
    EXACT float away = gap * (1.0f + steep) - nearest.outside * metres;
    away = exact_max(away, 0.0f);
    EXACT S(collide_ground) ground;
    ground.position = float3_add_scaled(p, off, away);
    ground.facet = float3_normalize(flat_normal, off);
    ground.normal = float3_normalize(smooth_normal, ground.facet);
    ground.velocity = sdf_velocity(pose, since, p, AROUND(steps_per_s));
    return ground;
}

#endif
