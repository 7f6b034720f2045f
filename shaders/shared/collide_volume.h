/* Intersects segments with a volume of planes (Drone 2007, 7.5.2.2), for shared/collide.h.
 *
 * In each step, the host puts a mesh into a lattice of cells, as it is at the step's start and end.
 * A cell that a triangle touches in between has a plane that moves with that triangle. A path is
 * followed from cell to cell, and tested against each cell's plane over its part in the cell, so
 * that no particle is too fast. If the mesh is closed, planes have only a front. A particle that
 * gets into a cell behind its plane has passed a triangle whose plane was not kept; it is put in
 * front at once. If the mesh is open, planes have two sides, and a path stays on its side while it
 * goes through cells with planes. */
#ifndef KILN_SHARED_COLLIDE_VOLUME_H
#define KILN_SHARED_COLLIDE_VOLUME_H

#include "shared/collide_ground.h"

/* A face is the number of a plane, and whether it was hit from behind. */
#define VOLUME_FIRST_FACE 64u

/* Distance in cells. A particle that is farther behind the plane of its cell is not inside the part
 * of the mesh that the plane stands for. */
#define VOLUME_DEPTH 1.75f

/* A plane at both ends of the step: a place on it, and its unit normal. */
struct volume_plane {
    float3 start, end;
    float3 normal, normal_end;
};

FN S(volume_plane) volume_plane_at(SIM_PARAM S(kiln_collider) c, uint number)
{
    uint at = (c.planes & ~VOLUME_TWO_SIDED) + 3u * number;
    EXACT float4 first = VOLUME_WORD(at);
    EXACT float4 second = VOLUME_WORD(at + 1u);
    EXACT float4 third = VOLUME_WORD(at + 2u);
    EXACT S(volume_plane) plane;
    plane.start = FLOAT3(first.x, first.y, first.z);
    plane.end = FLOAT3(second.x, second.y, second.z);
    plane.normal = FLOAT3(first.w, second.w, third.w);
    plane.normal_end = FLOAT3(third.x, third.y, third.z);
    return plane;
}

/* Returns the mark of a cell by its place in the lattice; sim/world/voxels.h describes marks. */
FN float volume_mark(SIM_PARAM S(kiln_grid) g, uint x, uint y, uint z)
{
    uint cell = (z * g.size.y + y) * g.size.x + x;
    EXACT float4 four = VOLUME_WORD(g.size.w + (cell >> 2u));
    uint part = cell & 3u;
    EXACT float lower = part == 0u ? four.x : four.y;
    EXACT float upper = part == 2u ? four.z : four.w;
    EXACT float mark = part < 2u ? lower : upper;
    return mark;
}

FN float3 volume_moving(float3 a, float3 b, float since)
{
    EXACT float3 y = FLOAT3(collide_moving(a.x, b.x, since), collide_moving(a.y, b.y, since),
                            collide_moving(a.z, b.z, since));
    return y;
}

/* Returns the distance of a point in front of a plane after the part `since` of the step. */
FN float volume_height(S(volume_plane) plane, float since, float3 p)
{
    EXACT float3 normal = volume_moving(plane.normal, plane.normal_end, since);
    EXACT float3 foot = volume_moving(plane.start, plane.end, since);
    EXACT float3 from = float3_sub(p, foot);
    EXACT float y = float3_dot(normal, from);
    return y;
}

/* Converts a point to units of cells. */
FN float3 volume_cells(S(kiln_grid) g, float3 p)
{
    EXACT float3 y = FLOAT3((p.x - g.origin.x) * g.per_metre.x, (p.y - g.origin.y) * g.per_metre.y,
                            (p.z - g.origin.z) * g.per_metre.z);
    return y;
}

/* Returns the nearest cell along an axis. */
FN float volume_cell(float at, uint size)
{
    EXACT float last = FLOAT(size) - 1.0f;
    EXACT float whole = FLOOR(at);
    EXACT float y = exact_clamp(whole, 0.0f, last);
    return y;
}

/* A path, and the parts of the step in which it is flown. */
struct volume_path {
    float3 from, way;     /* m */
    float3 start, across; /* the same vectors in cells */
    float since, until;
};

FN S(volume_path) volume_path_of(S(kiln_grid) g, float since, float until, float3 a, float3 b)
{
    EXACT S(volume_path) path;
    path.from = a;
    path.way = float3_sub(b, a);
    path.start = volume_cells(g, a);
    EXACT float3 end = volume_cells(g, b);
    EXACT float3 across = float3_sub(end, path.start);
    path.across = float3_canon(across);
    path.since = since;
    path.until = until;
    return path;
}

/* Returns the height in front of a plane at a part of a path. */
FN float volume_height_on(S(volume_path) path, S(volume_plane) plane, float part)
{
    EXACT float3 p = float3_add_scaled(path.from, path.way, part);
    EXACT float since = path.since + (path.until - path.since) * part;
    EXACT float y = volume_height(plane, since, p);
    return y;
}

struct volume_hit {
    float part; /* part of the path; 2: none */
    uint face;
    int side; /* side on which the path is: 1 in front, -1 behind, 0 not known */
};

/* Tests a path between two of its parts, which lie in a cell with the plane of this number. */
FN S(volume_hit) volume_hit_in(SIM_PARAM S(kiln_collider) c, S(volume_path) path, int side,
                               uint number, float deep, float from, float to)
{
    EXACT S(volume_plane) plane = volume_plane_at(SIM c, number);
    EXACT float before = volume_height_on(path, plane, from);
    EXACT float after = volume_height_on(path, plane, to);
    int now = before < 0.0f ? -1 : 1;
    now = side == 0 ? now : side;
    before = now < 0 ? -before : before;
    after = now < 0 ? -after : after;
    EXACT float fall = before - after;
    EXACT float quotient = exact_div(before, fall);
    EXACT float part = exact_clamp(quotient, 0.0f, 1.0f);
    EXACT float crossing = from + (to - from) * part;
    bool at_once = before <= 0.0f && before > -deep;
    bool crosses = before > 0.0f && after <= 0.0f;
    S(volume_hit) hit;
    hit.part = crosses ? crossing : 2.0f;
    hit.part = at_once ? from : hit.part;
    hit.face = VOLUME_FIRST_FACE + 2u * number + (now < 0 ? 1u : 0u);
    hit.side = now;
    return hit;
}

/* A cell on a path, and the part of the path at which it enters the cell. */
struct volume_walk {
    float x, y, z;
    float at;
    bool ends; /* the path ends here, or leaves the grid */
};

/* Returns the parts at which a path leaves its cell along each axis. */
FN float3 volume_exits(S(volume_path) path, S(volume_walk) w)
{
    EXACT float3 y = FLOAT3(collide_leaves(path.start.x, path.across.x, w.x),
                            collide_leaves(path.start.y, path.across.y, w.y),
                            collide_leaves(path.start.z, path.across.z, w.z));
    return y;
}

/* Steps into the neighbour by which a path leaves at this part. */
FN S(volume_walk) volume_step(S(volume_path) path, S(volume_walk) w, float3 exits, float at)
{
    bool along_x = exits.x <= exits.y && exits.x <= exits.z;
    bool along_y = !along_x && exits.y <= exits.z;
    EXACT float step_x = path.across.x > 0.0f ? 1.0f : -1.0f;
    EXACT float step_y = path.across.y > 0.0f ? 1.0f : -1.0f;
    EXACT float step_z = path.across.z > 0.0f ? 1.0f : -1.0f;
    EXACT S(volume_walk) y;
    y.x = along_x ? w.x + step_x : w.x;
    y.y = along_y ? w.y + step_y : w.y;
    y.z = along_x || along_y ? w.z : w.z + step_z;
    y.at = at;
    y.ends = false;
    return y;
}

/* Walks to the next cell, or several cells on where the cell's mark says that no plane is near. */
FN S(volume_walk) volume_walk_on(S(kiln_grid) g, S(volume_path) path, S(volume_walk) w, float mark,
                                 float per_cell, float to)
{
    EXACT float3 exits = volume_exits(path, w);
    EXACT float leaves = exact_min(exits.x, exact_min(exits.y, exits.z));
    EXACT float until = exact_min(leaves, to);
    EXACT float next = exact_max(until, w.at);
    EXACT float stride = w.at + (-1.0f - mark) * per_cell;
    bool strides = mark < -1.5f && per_cell > 0.0f && stride > next;
    EXACT S(volume_walk) y = volume_step(path, w, exits, next);
    if (strides) {
        EXACT float3 there = float3_add_scaled(path.start, path.across, stride);
        y.x = volume_cell(there.x, g.size.x);
        y.y = volume_cell(there.y, g.size.y);
        y.z = volume_cell(there.z, g.size.z);
        y.at = stride;
    }
    EXACT float held_x = volume_cell(y.x, g.size.x);
    EXACT float held_y = volume_cell(y.y, g.size.y);
    EXACT float held_z = volume_cell(y.z, g.size.z);
    bool is_left = held_x != y.x || held_y != y.y || held_z != y.z;
    y.ends = is_left || (strides ? stride >= to : leaves >= to);
    return y;
}

/* Finds where a path first meets a plane of the cells that it goes through. */
FN S(volume_hit) volume_march(SIM_PARAM S(kiln_collider) c, S(kiln_grid) g, S(volume_path) path,
                              float from, float to)
{
    EXACT float3 first = float3_add_scaled(path.start, path.across, from);
    EXACT S(volume_walk) w;
    w.x = volume_cell(first.x, g.size.x);
    w.y = volume_cell(first.y, g.size.y);
    w.z = volume_cell(first.z, g.size.z);
    w.at = from;
    w.ends = false;
    EXACT float deep = VOLUME_DEPTH * exact_rcp(g.per_metre.x);
    EXACT float longest = exact_max(exact_abs(path.across.x),
                                    exact_max(exact_abs(path.across.y), exact_abs(path.across.z)));
    EXACT float per_cell = exact_rcp(longest);
    int unknown = (c.planes & VOLUME_TWO_SIDED) != 0u ? 0 : 1;
    int side = unknown;
    S(volume_hit) hit;
    hit.part = 2.0f;
    hit.face = VOLUME_FIRST_FACE;
    hit.side = 0;
    uint most = g.size.x + g.size.y + g.size.z;
    for (uint i = 0u; i < most && !w.ends; i++) {
        EXACT float mark = volume_mark(SIM g, UINT(w.x), UINT(w.y), UINT(w.z));
        side = mark > 0.0f ? side : unknown;
        if (mark > 0.0f) {
            EXACT float3 exits = volume_exits(path, w);
            EXACT float leaves = exact_min(exits.x, exact_min(exits.y, exits.z));
            EXACT float until = exact_min(leaves, to);
            EXACT float next = exact_max(until, w.at);
            hit = volume_hit_in(SIM c, path, side, UINT(mark) - 1u, deep, w.at, next);
            if (hit.part <= 1.0f)
                return hit;
            side = hit.side;
            hit.part = 2.0f;
        }
        w = volume_walk_on(g, path, w, mark, per_cell, to);
    }
    return hit;
}

/* Returns whether no path from a to b can touch a plane. */
FN bool volume_is_clear(SIM_PARAM S(kiln_grid) g, float3 a, float3 b)
{
    EXACT float3 from = volume_cells(g, a);
    EXACT float3 to = volume_cells(g, b);
    EXACT float x = volume_cell(from.x, g.size.x);
    EXACT float y = volume_cell(from.y, g.size.y);
    EXACT float z = volume_cell(from.z, g.size.z);
    EXACT float mark = volume_mark(SIM g, UINT(x), UINT(y), UINT(z));
    EXACT float far_x = exact_max(exact_abs(from.x - x), exact_abs(to.x - x));
    EXACT float far_y = exact_max(exact_abs(from.y - y), exact_abs(to.y - y));
    EXACT float far_z = exact_max(exact_abs(from.z - z), exact_abs(to.z - z));
    EXACT float far = exact_max(far_x, exact_max(far_y, far_z));
    return far <= -mark;
}

/* Intersects a segment between two parts of the step, as collide_segment does. */
FN S(collide_span) volume_segment(SIM_PARAM S(kiln_collider) c, float since, float until, float3 a,
                                  float3 b)
{
    EXACT S(collide_box) at_start = collide_box_at(c, since);
    EXACT S(collide_box) at_end = collide_box_at(c, until);
    EXACT S(collide_span) span = collide_segment(at_start, at_end, a, b);
    EXACT S(kiln_grid) g = AROUND(grids[c.grid]);
    if (span.misses || span.enter > span.leave || volume_is_clear(SIM g, a, b)) {
        span.misses = true;
        return span;
    }
    EXACT S(volume_path) path = volume_path_of(g, since, until, a, b);
    EXACT float to = exact_min(span.leave, 1.0f);
    EXACT S(volume_hit) hit = volume_march(SIM c, g, path, span.enter, to);
    span.misses = hit.part > 1.0f;
    span.outside = true;
    span.enter = hit.part;
    span.leave = 2.0f;
    span.face = hit.face;
    return span;
}

/* Returns 1 + the number of the plane of the cell at a point in the collider's box; 0: none. */
FN uint volume_find(SIM_PARAM S(kiln_collider) c, float3 p)
{
    EXACT S(kiln_grid) g = AROUND(grids[c.grid]);
    EXACT float3 q = volume_cells(g, p);
    EXACT float x = volume_cell(q.x, g.size.x);
    EXACT float y = volume_cell(q.y, g.size.y);
    EXACT float z = volume_cell(q.z, g.size.z);
    EXACT float mark = volume_mark(SIM g, UINT(x), UINT(y), UINT(z));
    return mark > 0.0f ? UINT(mark) : 0u;
}

/* Returns whether a point is behind the plane of its cell. Without a particle's way, no more can be
 * known. */
FN bool volume_is_inside(SIM_PARAM S(kiln_collider) c, float until, float3 p)
{
    EXACT S(collide_box) bounds = collide_box_at(c, until);
    uint found = volume_find(SIM c, p);
    if (found == 0u || !collide_inside(bounds, p))
        return false;
    EXACT S(volume_plane) plane = volume_plane_at(SIM c, found - 1u);
    EXACT float height = volume_height(plane, until, p);
    EXACT float deep = VOLUME_DEPTH * exact_rcp(AROUND(grids[c.grid]).per_metre.x);
    return height <= 0.0f && height > -deep;
}

/* Returns the surface at a point of the plane that a face names, or near it. */
FN S(collide_ground) volume_ground(SIM_PARAM S(kiln_collider) c, uint face, float since, float3 p)
{
    uint number = (face - VOLUME_FIRST_FACE) >> 1u;
    bool behind = (face & 1u) != 0u;
    if (face < VOLUME_FIRST_FACE) {
        uint found = volume_find(SIM c, p);
        number = found > 0u ? found - 1u : 0u;
        behind = false;
    }
    EXACT S(volume_plane) plane = volume_plane_at(SIM c, number);
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 front = volume_moving(plane.normal, plane.normal_end, since);
    EXACT float3 back = FLOAT3(-front.x, -front.y, -front.z);
    EXACT float3 facing = behind ? back : front;
    EXACT float3 foot = volume_moving(plane.start, plane.end, since);
    EXACT float reach = exact_abs(p.x) + exact_abs(p.y) + exact_abs(p.z);
    EXACT float gap = 6.103515625e-5f + reach * 9.5367431640625e-7f;
    EXACT float3 motion = float3_sub(plane.end, plane.start);
    EXACT S(collide_ground) ground;
    ground.normal = float3_normalize(facing, up);
    ground.facet = ground.normal;
    EXACT float3 from = float3_sub(p, foot);
    EXACT float height = float3_dot(ground.normal, from);
    EXACT float away = gap - height;
    ground.position = float3_add_scaled(p, ground.normal, away);
    ground.velocity = float3_scale(motion, AROUND(steps_per_s));
    return ground;
}

/* Returns where a particle is at the end of the step that rests on a plane for a part of it: in
 * front of the plane. */
FN float3 volume_carry(SIM_PARAM S(kiln_collider) c, uint face, float until, float3 p)
{
    EXACT S(collide_ground) ground = volume_ground(SIM c, face, until, p);
    EXACT float3 ahead = float3_sub(ground.position, p);
    EXACT float missing = float3_dot(ahead, ground.normal);
    EXACT float3 y = p;
    if (missing > 0.0f)
        y = ground.position;
    return y;
}

#endif
