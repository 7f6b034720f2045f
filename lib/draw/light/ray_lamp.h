/* This header computes the part of each lamp that vectors of points, or of balls, see past the
 * backdrop's objects (shared/lamp_cover.h) and past solid particles (shared/lamp_map.h). An object
 * that hides nothing from a lane multiplies the lane's light by exactly 1, so that it does not
 * matter which lanes share a vector. */
#ifndef KILN_DRAW_LIGHT_RAY_LAMP_H
#define KILN_DRAW_LIGHT_RAY_LAMP_H

#include "base/real.h"
#include "draw/light/lamp_map.h"
#include "draw/light/lamp_solids.h"
#include "draw/light/lamps.h"
#include "draw/light/ray_box.h"
#include "draw/light/ray_shadow.h"
#include "shared/lamp_cover.h"
#include "shared/lamp_map.h"

/* Points or balls that see a lamp, in the lanes where it is not yet hidden. */
struct lamp_receiver {
    struct vf3 origin;
    struct lamp_way way;
    vi active;
    vf visible; /* part of the lamp, so far */
    vf blur;    /* width of the narrowest filter that read a map, m */
};

/* Takes the filter of a fetch into account. width: in texture coordinates of a face. */
SIMD void blur_lamp(struct lamp_receiver *r, vi near, vf width)
{
    const vf wide = 2.0f * width * r->way.reach;
    r->blur = vf_select(near, vf_min(r->blur, wide), r->blur);
}

/* Returns the radius of a cylinder's bounding sphere, m. axis: its direction and half its height.
 */
SIMD float cylinder_size(float4 cylinder, float4 axis)
{
    return sqrtf(cylinder.w * cylinder.w + axis.w * axis.w);
}

/* Rotates a direction from the world to the frame of a box. */
SIMD struct vf3 into_box(const struct kiln_draw_oriented_box *box, struct vf3 v)
{
    return (struct vf3){vf3_dot_all(v, box->rows[0]), vf3_dot_all(v, box->rows[1]),
                        vf3_dot_all(v, box->rows[2])};
}

/* Returns the lanes where a shape with such a bounding sphere may hide a part of the lamp. Most
 * shapes are farther from the ways to the lamp than a cone of light is wide anywhere; this is found
 * without the division in lamp_meets. */
SIMD vi lamp_may_be_hidden(const struct lamp_receiver *r, struct vf3 towards, float size)
{
    const vf t = vf3_dot(towards, r->way.direction);
    const struct vf3 across = vf3_add_scaled(towards, r->way.direction, -t);
    const vf widest = size + vf_max(r->way.radius, r->way.lit) + 2e-3f;
    const vi near =
        r->active & (t > -size - r->way.lit) & (vf3_dot(across, across) < widest * widest);
    return any(near) ? near & lamp_meets(towards, size, r->way) : near;
}

/* Returns the radius of a cone of light at the place of a box that is farthest along it, m. lit,
 * spread: of lamp_way; towards: the way to the box's centre; direction: of the light; both are
 * along the box's axes. */
SIMD vf cone_at_box(vf lit, vf spread, struct vf3 towards, float4 half, struct vf3 direction)
{
    const vf extent =
        vf_abs(direction.x) * half.x + vf_abs(direction.y) * half.y + vf_abs(direction.z) * half.z;
    const vf far = vf_max(vf3_dot(towards, direction) + extent, vf_all(0.0f));
    return lit + vf_max(spread, vf_all(0.0f)) * far + 1e-3f;
}

/* Holds the t at which rays enter and leave a box. */
struct box_crossing {
    vf enters, leaves;
};

/* Returns where rays cross a box after it is grown to all sides, m. */
SIMD struct box_crossing cross_grown_box(const struct ray_slabs *s, struct vf3 inverse, vf grow)
{
    const struct vf3 more = {grow * vf_abs(inverse.x), grow * vf_abs(inverse.y),
                             grow * vf_abs(inverse.z)};
    const struct vf3 near = vf3_sub(s->near, more), far = vf3_add(s->far, more);
    return (struct box_crossing){vf_max(vf_max(near.x, near.y), near.z),
                                 vf_min(vf_min(far.x, far.y), far.z)};
}

/* Returns the lanes where a box may hide a part of a lamp: those in which the way to the lamp meets
 * the box after it is grown by the cone of light. A box is mostly much smaller than its bounding
 * sphere. towards: the way to the box's centre; direction: to the lamp; both are along the box's
 * axes. inverse: ray_inverse3 of the direction; s: where the ways cross the box's slabs. */
SIMD vi lamp_meets_box(const struct ray_slabs *s, struct vf3 towards, float4 half,
                       struct vf3 direction, struct vf3 inverse, const struct lamp_way *way)
{
    const vf grow = cone_at_box(way->lit, way->spread, towards, half, direction);
    const struct box_crossing c = cross_grown_box(s, inverse, grow);
    return (c.enters <= c.leaves) & (c.leaves >= -way->lit) &
           (c.enters <= way->reach + way->radius);
}

/* Returns the lanes where a cone of light may meet a cylinder or a capsule, however long: those in
 * which the distance between its axis and the middle of the cone is no more than their radii. A
 * cone that shrinks towards the lamp is wider behind its start, where the ball that is lit begins.
 * towards: the way to the middle of the shape; axis: its direction and half of its height, without
 * the ends of a capsule; the others as for cone_at_box. */
SIMD vi cone_meets_axis(vf lit, vf spread, struct vf3 towards, float radius, float4 axis,
                        struct vf3 direction)
{
    const vf climb = vf_abs(vf3_dot_all(direction, axis));
    const vf far = vf_max(vf3_dot(towards, direction) + climb * axis.w + radius, vf_all(0.0f));
    const vf grow = vf_max(spread, vf_all(0.0f)) * far,
             shrink = vf_max(-spread, vf_all(0.0f)) * lit;
    const vf wide = lit + grow + shrink + (radius + 1e-3f);
    const struct vf3 across = real3_cross(vf3_all(axis), direction);
    const vf apart = vf3_dot(towards, across);
    /* Rounding alone decides `across` where the axis is along the light. */
    const vf noise = 1e-12f * vf3_dot(towards, towards);
    return apart * apart <= wide * wide * vf3_dot(across, across) + noise;
}

/* Hides a part of a lamp in the lanes of a mask. Lanes that no longer see the lamp drop out. */
SIMD void hide_lamp(struct lamp_receiver *r, vi near, vf cover)
{
    r->visible *= 1.0f - vf_where(near, cover);
    r->active &= r->visible > 0.0f;
}

/* Returns the lanes where the bounding sphere of a box may hide a part of a lamp. */
SIMD vi lamp_meets_box_sphere(const struct kiln_lamp_objects *objects, int i,
                              const struct lamp_receiver *r)
{
    return lamp_may_be_hidden(r, vf3_towards(objects->box_center[i], r->origin),
                              objects->box_half[i].w);
}

/* Hides a lamp by boxes along the axes, all of which have one outline as seen from a point. */
SIMD void hide_lamp_by_boxes(const struct kiln_lamp_objects *objects, uint32_t boxes,
                             struct lamp_receiver *r)
{
    /* mostly no box is near, and the outline is not needed */
    while (boxes && !any(lamp_meets_box_sphere(objects, __builtin_ctz(boxes), r)))
        boxes &= boxes - 1;
    if (!boxes)
        return;
    const struct vf3 direction = r->way.direction, inverse = ray_inverse3(direction);
    const struct box_outline outline = box_outline_of(direction, inverse);
    for (; boxes; boxes &= boxes - 1) {
        const int i = __builtin_ctz(boxes);
        vi near = lamp_meets_box_sphere(objects, i, r);
        if (!any(near))
            continue;
        const float4 half = objects->box_half[i];
        const struct vf3 towards = vf3_towards(objects->box_center[i], r->origin);
        const struct ray_slabs s = ray_cross_slabs(towards, half, inverse);
        near &= lamp_meets_box(&s, towards, half, direction, inverse, &r->way);
        if (any(near))
            hide_lamp(r, near, ray_lamp_box_cover(&s, &outline, near, &r->way));
    }
}

/* Returns the lanes where a cylinder may hide the lamp: those that do not lie wholly beyond an end
 * or beside the cylinder, with the lamp on the same side. */
SIMD vi lamp_faces_cylinder(struct vf3 towards, float radius, float4 axis,
                            const struct lamp_way *way)
{
    const vf climb = vf3_dot_all(way->direction, axis);
    const struct cylinder_past past =
        cylinder_past_of(towards, radius, axis, way->direction, climb, way->lit);
    return (past.beyond != 1.0f) & (past.beside != 1.0f);
}

SIMD void hide_lamp_by_round(const struct kiln_draw_shapes *shapes, uint32_t spheres,
                             uint32_t cylinders, struct lamp_receiver *r)
{
    for (; spheres; spheres &= spheres - 1) {
        const float4 sphere = shapes->spheres[__builtin_ctz(spheres)];
        const struct vf3 towards = vf3_towards(sphere, r->origin);
        const vi near = lamp_may_be_hidden(r, towards, sphere.w);
        if (any(near))
            hide_lamp(r, near, lamp_ball_cover(towards, sphere.w, r->way));
    }
    for (; cylinders; cylinders &= cylinders - 1) {
        const int i = __builtin_ctz(cylinders);
        const float4 cylinder = shapes->cylinders[i], axis = shapes->cylinder_axis[i];
        const struct vf3 towards = vf3_towards(cylinder, r->origin);
        vi near = lamp_may_be_hidden(r, towards, cylinder_size(cylinder, axis));
        if (any(near))
            near &= cone_meets_axis(r->way.lit, r->way.spread, towards, cylinder.w, axis,
                                    r->way.direction);
        if (any(near))
            near &= lamp_faces_cylinder(towards, cylinder.w, axis, &r->way);
        if (any(near))
            hide_lamp(r, near, lamp_cylinder_cover(towards, cylinder.w, axis, r->way));
    }
}

SIMD void hide_lamp_by_oriented(const struct kiln_draw_shapes *shapes, uint32_t capsules,
                                uint32_t boxes, struct lamp_receiver *r)
{
    for (; capsules; capsules &= capsules - 1) {
        const int i = __builtin_ctz(capsules);
        const float4 capsule = shapes->capsules[i], axis = shapes->capsule_axis[i];
        const struct vf3 towards = vf3_towards(capsule, r->origin);
        vi near = lamp_may_be_hidden(r, towards, capsule.w + axis.w);
        if (any(near))
            near &= cone_meets_axis(r->way.lit, r->way.spread, towards, capsule.w, axis,
                                    r->way.direction);
        if (any(near))
            hide_lamp(r, near, lamp_capsule_cover(towards, capsule.w, axis, r->way));
    }
    for (; boxes; boxes &= boxes - 1) {
        const struct kiln_draw_oriented_box *box = &shapes->oriented_boxes[__builtin_ctz(boxes)];
        const struct vf3 towards = vf3_towards(box->center, r->origin);
        vi near = lamp_may_be_hidden(r, towards, box->half_size.w);
        if (!any(near))
            continue;
        const struct vf3 to_box = into_box(box, towards);
        const struct vf3 direction = into_box(box, r->way.direction);
        const struct vf3 inverse = ray_inverse3(direction);
        const struct ray_slabs s = ray_cross_slabs(to_box, box->half_size, inverse);
        near &= lamp_meets_box(&s, to_box, box->half_size, direction, inverse, &r->way);
        if (!any(near))
            continue;
        const struct box_outline outline = box_outline_of(direction, inverse);
        hide_lamp(r, near, ray_lamp_box_cover(&s, &outline, near, &r->way));
    }
}

/* ---- meshes ---------------------------------------------------------------------------------- */

/* Return 1 + the number of a lamp's maps of meshes, and of solid particles; 0: it has none. */
SIMD uint32_t mesh_map_of(const struct kiln_draw_light *lamp)
{
    return lamp->casters.y & ((1u << KILN_LAMP_SOLID_SHIFT) - 1);
}

SIMD uint32_t solid_map_of(const struct kiln_draw_light *lamp)
{
    return lamp->casters.y >> KILN_LAMP_SOLID_SHIFT;
}

/* Returns the part of a lamp that meshes hide, in the lanes where the receiver still sees it. */
SIMD vf lamp_mesh_cover(const struct kiln_lamp_objects *objects, const struct kiln_draw_light *lamp,
                        struct lamp_receiver *r, struct vf3 normal)
{
    const float radius = lamp->color.w, far = lamp->maps.x;
    const struct lamp_place place =
        lamp_place_of(vf3_scale(r->way.direction, -r->way.reach), normal, far);
    vi near = r->active;
    if (!any(near))
        return vf_all(0.0f);

    const struct shadow_map maps = {objects->maps, KILN_LAMP_EDGE, KILN_LAMP_LEVELS, 1};
    const vi face = vi_of(place.face) + (int32_t)(KILN_LAMP_FACES * (mesh_map_of(lamp) - 1));
    const vi first = face * KILN_LAMP_ENTRIES;
    const vf widest = lamp_widest(place, radius, r->way.lit), level = lamp_level(widest) + 1.0f;
    blur_lamp(r, near, widest);
    struct shadow_filter filter = shadow_filter_of(&maps, first, level);
    struct shadow_sample shadow = read_shadow(&maps, &filter, place.at.u, place.at.v);
    near &= shadow.cover > 0.0f;
    if (!any(near))
        return vf_all(0.0f);
    const vf width = lamp_width(place, radius, r->way.lit, far, shadow.cover, shadow.distance);
    blur_lamp(r, near, width);
    filter = shadow_filter_of(&maps, first, lamp_level(width));
    const vf stride = 0.5f * width;
    const vf ramp = 1.0f / (place.at.slack + stride * (2.0f * KILN_LAMP_RANGE) * place.at.depth);
    vf cover = vf_all(0.0f);
    for (int k = 0; k < 4; k++) {
        vf aside_u = k & 1 ? stride : -stride, aside_v = k >> 1 ? stride : -stride;
        shadow = read_shadow(&maps, &filter, place.at.u + aside_u, place.at.v + aside_v);
        cover += shadow_tap(place.at, aside_u, aside_v, shadow.cover, shadow.distance, ramp);
    }
    return vf_where(near, cover);
}

/* ---- solid particles ------------------------------------------------------------------------- */

/* Returns the part of a lamp that solid particles hide, in the lanes where the receiver still sees
 * it. middle: of the solid that is lit; NULL: another surface is lit. */
SIMD vf lamp_solid_cover(const struct kiln_lamp_objects *objects,
                         const struct kiln_draw_light *lamp, struct lamp_receiver *r,
                         struct vf3 normal, const struct vf3 *middle)
{
    const float radius = lamp->color.w, far = lamp->maps.w;
    vi near = r->active;
    if (!any(near))
        return vf_all(0.0f);
    const struct lamp_solid_place to = lamp_solid_place_of(
        vf3_scale(r->way.direction, -r->way.reach), normal, far, vi_all(middle ? -1 : 0),
        middle ? vf3_length(vf3_towards(lamp->position_radius2, *middle)) : vf_all(0.0f));
    const struct shadow_receiver at = to.at;
    const struct shadow_map maps = {objects->solid_maps, KILN_LAMP_EDGE, KILN_LAMP_LEVELS,
                                    KILN_LAMP_SOLID_TEXEL};
    const vi face = vi_of(to.place.face) + (int32_t)(KILN_LAMP_FACES * (solid_map_of(lamp) - 1));
    const vi first = face * KILN_LAMP_ENTRIES;
    const vf widest = lamp_widest(to.place, radius, r->way.lit), level = lamp_level(widest) + 1.0f;
    blur_lamp(r, near, widest);
    struct shadow_filter filter = shadow_filter_of(&maps, first, level);
    struct shadow_sample shadow = read_shadow(&maps, &filter, at.u, at.v);
    near &= shadow.cover > 0.0f;
    if (!any(near))
        return vf_all(0.0f);
    const vf found = shadow.cover, narrow = shadow.narrow;
    const vf distance =
        middle ? lamp_other_distance(at, found, shadow.distance, shadow.square) : shadow.distance;
    const vf width = lamp_solid_width(to, radius, r->way.lit, far, found, distance);
    blur_lamp(r, near, width);
    filter = shadow_filter_of(&maps, first, lamp_level(width));
    const vf stride = 0.5f * width, ramp = 1.0f / at.slack;
    vf cover = vf_all(0.0f);
    for (int k = 0; k < 4; k++) {
        vf aside_u = k & 1 ? stride : -stride, aside_v = k >> 1 ? stride : -stride;
        shadow = read_shadow(&maps, &filter, at.u + aside_u, at.v + aside_v);
        cover += middle ? lamp_solid_tap(at, shadow.cover, shadow.distance, shadow.square)
                        : shadow_tap(at, aside_u, aside_v, shadow.cover, shadow.distance, ramp);
    }
    return vf_where(near,
                    lamp_thin_cover(to, radius, r->way.lit, far, found, distance, narrow, cover));
}

/* ---- lamps ----------------------------------------------------------------------------------- */

/* Returns the next `count` bits, which belong to the objects of one kind, and removes them. */
SIMD uint32_t take_bits(uint32_t *bits, uint32_t count)
{
    const uint32_t taken = *bits & (uint32_t)((1ull << count) - 1);
    *bits = count < 32 ? *bits >> count : 0;
    return taken;
}

/* Computes what points or balls see of a lamp: `visible`, 0 to 1. casters: the objects that may
 * hide it from them, some or all of lamp->casters.x; normal: of the surface, unit; middle: of the
 * solid particles that the points are on, or NULL; lit: radius of the balls, m; 0 for points. */
SIMD struct lamp_receiver lamp_receiver_of(const struct kiln_lamp_objects *objects,
                                           const struct kiln_draw_light *lamp, uint32_t casters,
                                           struct vf3 origin, struct vf3 normal,
                                           const struct vf3 *middle, vf lit, vi active)
{
    const struct kiln_draw_shapes *shapes = objects->shapes;
    struct lamp_receiver r = {
        .origin = origin, .active = active, .visible = vf_all(1.0f), .blur = vf_all(1e6f)};
    r.way = lamp_way_to(*lamp, origin, normal, lit);
    hide_lamp_by_boxes(objects, take_bits(&casters, objects->box_count), &r);
    const uint32_t spheres = take_bits(&casters, shapes->counts.x);
    hide_lamp_by_round(shapes, spheres, take_bits(&casters, shapes->counts.y), &r);
    const uint32_t capsules = take_bits(&casters, shapes->oriented_counts.x);
    hide_lamp_by_oriented(shapes, capsules, take_bits(&casters, shapes->oriented_counts.y), &r);
    if (lamp->casters.y)
        r.way = lamp_way_of(vf3_towards(lamp->position_radius2, origin), lamp->color.w, lit);
    if (mesh_map_of(lamp))
        hide_lamp(&r, active, lamp_mesh_cover(objects, lamp, &r, normal));
    if (solid_map_of(lamp))
        hide_lamp(&r, active, lamp_solid_cover(objects, lamp, &r, normal, middle));
    return r;
}

SIMD vf lamp_visibility(const struct kiln_lamp_objects *objects, const struct kiln_draw_light *lamp,
                        uint32_t casters, struct vf3 origin, struct vf3 normal,
                        const struct vf3 *middle, vf lit, vi active)
{
    return lamp_receiver_of(objects, lamp, casters, origin, normal, middle, lit, active).visible;
}

#endif
