/* Intersects segments with the signed distance field of a mesh (UberFlow 2004, 4.6), for
 * shared/collide.h.
 *
 * A word of its grid is (gradient, distance); the distance is below 0 inside. The mesh moves
 * rigidly. A particle's places in the mesh's frame are computed at the start and at the end of the
 * step, and interpolated linearly, so that a path is a segment in that frame, too. The segment is
 * followed in strides no longer than the distance to the surface, and near it in strides of a
 * quarter of a cell. For a ball, the surface is farther out by its radius, and the centre is
 * tested. */
#ifndef KILN_SHARED_COLLIDE_SDF_H
#define KILN_SHARED_COLLIDE_SDF_H

#include "shared/collide_terrain.h"

FN float sdf_row(float4 row, float3 p)
{
    EXACT float y = row.x * p.x + row.y * p.y + row.z * p.z + row.w;
    return y;
}

/* Returns a point in the frame of the mesh after the part `since` of the step. */
FN float3 sdf_local(S(kiln_pose) pose, float since, float3 p)
{
    EXACT float x0 = sdf_row(pose.to_local[0], p);
    EXACT float y0 = sdf_row(pose.to_local[1], p);
    EXACT float z0 = sdf_row(pose.to_local[2], p);
    EXACT float x1 = sdf_row(pose.to_local_end[0], p);
    EXACT float y1 = sdf_row(pose.to_local_end[1], p);
    EXACT float z1 = sdf_row(pose.to_local_end[2], p);
    EXACT float3 q = FLOAT3(collide_moving(x0, x1, since), collide_moving(y0, y1, since),
                            collide_moving(z0, z1, since));
    return q;
}

FN float4 sdf_moving_row(float4 a, float4 b, float since)
{
    EXACT float4 y = FLOAT4(collide_moving(a.x, b.x, since), collide_moving(a.y, b.y, since),
                            collide_moving(a.z, b.z, since), 0.0f);
    return y;
}

/* Transforms a gradient from the mesh's frame to the world, by the transposed rows. */
FN float3 sdf_slope_to_world(S(kiln_pose) pose, float since, float3 v)
{
    EXACT float4 r0 = sdf_moving_row(pose.to_local[0], pose.to_local_end[0], since);
    EXACT float4 r1 = sdf_moving_row(pose.to_local[1], pose.to_local_end[1], since);
    EXACT float4 r2 = sdf_moving_row(pose.to_local[2], pose.to_local_end[2], since);
    EXACT float3 y =
        FLOAT3(r0.x * v.x + r1.x * v.y + r2.x * v.z, r0.y * v.x + r1.y * v.y + r2.y * v.z,
               r0.z * v.x + r1.z * v.y + r2.z * v.z);
    return y;
}

/* The distances at the corners of a cell, by x, y and z, and a place in the cell. */
struct sdf_cell {
    float d000, d100, d010, d110, d001, d101, d011, d111;
    float x, y, z;
};

FN float sdf_word(SIM_PARAM uint at)
{
    EXACT float4 word = GRID_WORD(at);
    return word.w;
}

FN S(sdf_cell) sdf_cell_at(SIM_PARAM S(kiln_grid) g, float3 q)
{
    EXACT S(grid_place) place = grid_find(g, q);
    uint at = grid_index(g, place.x.first, place.y.first, place.z.first);
    uint up = g.size.x;
    uint deep = g.size.x * g.size.y;
    EXACT S(sdf_cell) cell;
    cell.d000 = sdf_word(SIM at);
    cell.d100 = sdf_word(SIM at + 1u);
    cell.d010 = sdf_word(SIM at + up);
    cell.d110 = sdf_word(SIM at + up + 1u);
    cell.d001 = sdf_word(SIM at + deep);
    cell.d101 = sdf_word(SIM at + deep + 1u);
    cell.d011 = sdf_word(SIM at + deep + up);
    cell.d111 = sdf_word(SIM at + deep + up + 1u);
    cell.x = place.x.part;
    cell.y = place.y.part;
    cell.z = place.z.part;
    return cell;
}

FN float sdf_mix(float a, float b, float t)
{
    EXACT float y = a + (b - a) * t;
    return y;
}

/* Interpolates the distance trilinearly. */
FN float sdf_distance(S(sdf_cell) c)
{
    EXACT float d00 = sdf_mix(c.d000, c.d100, c.x);
    EXACT float d10 = sdf_mix(c.d010, c.d110, c.x);
    EXACT float d01 = sdf_mix(c.d001, c.d101, c.x);
    EXACT float d11 = sdf_mix(c.d011, c.d111, c.x);
    EXACT float d0 = sdf_mix(d00, d10, c.y);
    EXACT float d1 = sdf_mix(d01, d11, c.y);
    EXACT float y = sdf_mix(d0, d1, c.z);
    return y;
}

/* Returns the gradient of the distance along x, y and z, in any unit; cells are cubes. */
FN float3 sdf_slope(S(sdf_cell) c)
{
    EXACT float x0 = sdf_mix(c.d100 - c.d000, c.d110 - c.d010, c.y);
    EXACT float x1 = sdf_mix(c.d101 - c.d001, c.d111 - c.d011, c.y);
    EXACT float y0 = sdf_mix(c.d010 - c.d000, c.d110 - c.d100, c.x);
    EXACT float y1 = sdf_mix(c.d011 - c.d001, c.d111 - c.d101, c.x);
    EXACT float z0 = sdf_mix(c.d001 - c.d000, c.d101 - c.d100, c.x);
    EXACT float z1 = sdf_mix(c.d011 - c.d010, c.d111 - c.d110, c.x);
    EXACT float3 y = FLOAT3(sdf_mix(x0, x1, c.z), sdf_mix(y0, y1, c.z), sdf_mix(z0, z1, c.y));
    return y;
}

FN float sdf_distance_at(SIM_PARAM S(kiln_grid) g, float3 q)
{
    EXACT S(sdf_cell) cell = sdf_cell_at(SIM g, q);
    EXACT float y = sdf_distance(cell);
    return y;
}

/* Intersects a segment with the box of a grid, both in the frame of the mesh. */
FN S(collide_span) sdf_box_segment(S(kiln_grid) g, float3 a, float3 b)
{
    EXACT float cell = exact_rcp(g.per_metre.x);
    EXACT float3 low = FLOAT3(g.origin.x, g.origin.y, g.origin.z);
    EXACT float3 high =
        FLOAT3(low.x + FLOAT(g.size.x - 1u) * cell, low.y + FLOAT(g.size.y - 1u) * cell,
               low.z + FLOAT(g.size.z - 1u) * cell);
    EXACT S(collide_box) box;
    box.min = low;
    box.max = high;
    EXACT S(collide_span) span = collide_segment(box, box, a, b);
    return span;
}

/* A ball's radius in the frame of the mesh, at the two ends of a segment. */
struct sdf_reach {
    float start, end;
};

FN float sdf_radius(S(kiln_pose) pose, float since, float radius)
{
    EXACT float y = 0.0f;
    if (radius > 0.0f) {
        EXACT float metres = collide_moving(pose.metres.x, pose.metres.y, since);
        y = exact_div(radius, metres);
    }
    return y;
}

/* Returns where distances of 0 begin before a part of a segment, between two parts of it. In a mesh
 * as thin as a cell, whose two sides lie on samples, all distances are 0. */
FN float sdf_march_back(SIM_PARAM S(kiln_grid) g, float3 a, float3 way, S(sdf_reach) reach,
                        float from, float to)
{
    EXACT float outside = from;
    EXACT float hit = to;
    for (uint i = 0u; i < 16u; i++) {
        EXACT float at = 0.5f * (outside + hit);
        EXACT float3 q = float3_add_scaled(a, way, at);
        EXACT float distance = sdf_distance_at(SIM g, q) - sdf_mix(reach.start, reach.end, at);
        outside = distance > 0.0f ? at : outside;
        hit = distance > 0.0f ? hit : at;
    }
    return hit;
}

/* Follows a segment in the frame of the mesh from one part to another; returns the part at which it
 * first gets inside, or 2. */
FN float sdf_march(SIM_PARAM S(kiln_grid) g, float3 a, float3 b, S(sdf_reach) reach, float from,
                   float to)
{
    EXACT float3 way = float3_sub(b, a);
    EXACT float way_length = float3_length(way);
    EXACT float cell = exact_rcp(g.per_metre.x);
    EXACT float least = cell * 0.25f;
    EXACT float per_length = exact_rcp(way_length);
    EXACT float before = from;
    EXACT float distance_before = 0.0f;
    EXACT float at = from;
    uint most = 4u * (g.size.x + g.size.y + g.size.z);
    for (uint i = 0u; i < most; i++) {
        EXACT float3 q = float3_add_scaled(a, way, at);
        EXACT float distance = sdf_distance_at(SIM g, q) - sdf_mix(reach.start, reach.end, at);
        if (distance <= 0.0f) {
            EXACT float fall = distance_before - distance;
            EXACT float quotient = exact_div(distance_before, fall);
            EXACT float part = exact_clamp(quotient, 0.0f, 1.0f);
            EXACT float hit = before + (at - before) * part;
            if (distance == 0.0f)
                hit = sdf_march_back(SIM g, a, way, reach, before, at);
            return hit;
        }
        if (at >= to)
            return 2.0f;
        before = at;
        distance_before = distance;
        /* Between samples the distance changes by at most the root of 3 a unit. */
        EXACT float stride = exact_max(distance * 0.57f, least);
        EXACT float next = at + stride * per_length;
        at = per_length == 0.0f ? to : exact_min(next, to);
    }
    return 2.0f;
}

/* Returns whether no path from a to b, in the frame of the mesh, can touch it. The distance at the
 * first sample of a's cell differs from that at a by less than the diagonal of the cell. Outside of
 * the grid there is no mesh within two cells and the reach of the largest ball. larger: radius of
 * the ball. */
FN bool sdf_is_clear(SIM_PARAM S(kiln_grid) g, float3 a, float3 b, float larger)
{
    EXACT S(grid_place) place = grid_find(g, a);
    EXACT float3 way = float3_sub(b, a);
    EXACT float way_length = float3_length(way);
    EXACT float cells = way_length * g.per_metre.x;
    EXACT float distance = sdf_word(SIM grid_index(g, place.x.first, place.y.first, place.z.first));
    distance = distance - larger;
    EXACT float reach = distance * g.per_metre.x - 1.75f;
    bool inside = place.x.inside && place.y.inside && place.z.inside;
    reach = inside ? reach : 1.9f;
    return cells < reach && (FLOAT_BITS(cells) & EXACT_SIZE_BITS) < EXACT_VAST_BITS;
}

/* Intersects a segment between two parts of the step, as collide_segment does. */
FN S(collide_span) sdf_segment(SIM_PARAM S(kiln_collider) c, float since, float until, float3 a,
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
    span = sdf_box_segment(g, from, end);
    EXACT S(sdf_reach) reach;
    reach.start = sdf_radius(pose, since, c.center.w);
    reach.end = sdf_radius(pose, until, c.center.w);
    EXACT float larger = exact_max(reach.start, reach.end);
    if (span.misses || span.enter > span.leave || sdf_is_clear(SIM g, from, end, larger)) {
        span.misses = true;
        return span;
    }
    EXACT float to = exact_min(span.leave, 1.0f);
    EXACT float hit = sdf_march(SIM g, from, end, reach, span.enter, to);
    span.misses = hit > 1.0f;
    span.outside = span.outside || hit > span.enter;
    span.enter = hit;
    span.leave = 2.0f;
    span.face = COLLIDE_SURFACE;
    return span;
}

FN bool sdf_is_inside(SIM_PARAM S(kiln_collider) c, float until, float3 p)
{
    EXACT S(collide_box) bounds = collide_box_at(c, until);
    EXACT S(kiln_grid) g = AROUND(grids[c.grid]);
    EXACT float3 q = sdf_local(AROUND(poses[c.mesh]), until, p);
    EXACT S(collide_span) span = sdf_box_segment(g, q, q);
    EXACT float distance =
        sdf_distance_at(SIM g, q) - sdf_radius(AROUND(poses[c.mesh]), until, c.center.w);
    return collide_inside(bounds, p) && !span.misses && distance <= 0.0f;
}

/* Returns the velocity, m/s, of the mesh at a point after the part `since` of the step. */
FN float3 sdf_velocity(S(kiln_pose) pose, float since, float3 p, float steps_per_s)
{
    EXACT float3 center = FLOAT3(collide_moving(pose.center.x, pose.center_end.x, since),
                                 collide_moving(pose.center.y, pose.center_end.y, since),
                                 collide_moving(pose.center.z, pose.center_end.z, since));
    EXACT float3 motion =
        FLOAT3(pose.center_end.x - pose.center.x, pose.center_end.y - pose.center.y,
               pose.center_end.z - pose.center.z);
    EXACT float3 arm = float3_sub(p, center);
    EXACT float metres = collide_moving(pose.metres.x, pose.metres.y, since);
    EXACT float growth = exact_div(pose.metres.y - pose.metres.x, metres);
    motion = float3_add_scaled(motion, arm, growth);
    EXACT float3 moving = float3_scale(motion, steps_per_s);
    EXACT float3 turn = FLOAT3(pose.turn.x, pose.turn.y, pose.turn.z);
    EXACT float3 turning = float3_cross(turn, arm);
    EXACT float3 y = float3_add(moving, turning);
    return y;
}

/* Returns the surface at a point on it or near it. */
FN S(collide_ground) sdf_ground(SIM_PARAM S(kiln_collider) c, float since, float3 p)
{
    EXACT S(kiln_pose) pose = AROUND(poses[c.mesh]);
    EXACT S(kiln_grid) g = AROUND(grids[c.grid]);
    EXACT float metres = collide_moving(pose.metres.x, pose.metres.y, since);
    EXACT float3 q = sdf_local(pose, since, p);
    EXACT float4 word = grid_at(SIM g, q);
    EXACT float3 growth = FLOAT3(word.x, word.y, word.z);
    EXACT float3 slope = sdf_slope_to_world(pose, since, growth);
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT S(collide_ground) ground;
    ground.normal = float3_normalize(slope, up);
    EXACT float reach = exact_abs(p.x) + exact_abs(p.y) + exact_abs(p.z);
    EXACT float gap = 6.103515625e-5f + reach * 9.5367431640625e-7f;
    EXACT float away = (gap + c.center.w) - word.w * metres;
    EXACT float3 foot = float3_add_scaled(p, ground.normal, away);
    q = sdf_local(pose, since, foot);
    EXACT S(sdf_cell) cell = sdf_cell_at(SIM g, q);
    EXACT float missing = (gap + c.center.w) - sdf_distance(cell) * metres;
    missing = exact_max(missing, 0.0f);
    ground.position = float3_add_scaled(foot, ground.normal, missing);
    growth = sdf_slope(cell);
    slope = sdf_slope_to_world(pose, since, growth);
    ground.facet = float3_normalize(slope, ground.normal);
    EXACT float3 skin = float3_add_scaled(p, ground.normal, -c.center.w);
    ground.velocity = sdf_velocity(pose, since, skin, AROUND(steps_per_s));
    return ground;
}

#endif
