/* This header computes the part of each lamp that vectors of points, or of balls, see past the
 * backdrop's objects (shapes_hide.h) and past solid particles (shared/lamp_map.h). */
#ifndef KILN_DRAW_LIGHT_RAY_LAMP_H
#define KILN_DRAW_LIGHT_RAY_LAMP_H

#include "base/real.h"
#include "draw/light/lamp_map.h"
#include "draw/light/lamp_solids.h"
#include "draw/light/lamps.h"
#include "draw/light/ray_shadow.h"
#include "draw/light/shapes_hide.h"
#include "shared/lamp_map.h"

/* Takes the filter of a fetch into account. width: in texture coordinates of a face. */
SIMD void blur_lamp(struct light_receiver *r, vi near, vf width)
{
    const vf wide = 2.0f * width * r->way.reach;
    r->blur = vf_select(near, vf_min(r->blur, wide), r->blur);
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
                        struct light_receiver *r, struct vf3 normal)
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
                         const struct kiln_draw_light *lamp, struct light_receiver *r,
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

/* Computes what points or balls see of a lamp: `visible`, 0 to 1. casters: the objects that may
 * hide it from them, some or all of lamp->hiders; normal: of the surface, unit; middle: of the
 * solid particles that the points are on, or NULL; lit: radius of the balls, m; 0 for points. */
SIMD struct light_receiver lamp_receiver_of(const struct kiln_lamp_objects *objects,
                                            const struct kiln_draw_light *lamp,
                                            const struct kiln_shape_set *casters, struct vf3 origin,
                                            struct vf3 normal, const struct vf3 *middle, vf lit,
                                            vi active)
{
    struct light_receiver r = {
        .origin = origin, .active = active, .visible = vf_all(1.0f), .blur = vf_all(1e6f)};
    r.way = lamp_way_to(*lamp, origin, normal, lit);
    hide_by_shapes(objects->shapes, casters, &r);
    if (lamp->casters.y)
        r.way = lamp_way_of(vf3_towards(lamp->position_radius2, origin), lamp->color.w, lit);
    if (mesh_map_of(lamp))
        hide_light(&r, active, lamp_mesh_cover(objects, lamp, &r, normal));
    if (solid_map_of(lamp))
        hide_light(&r, active, lamp_solid_cover(objects, lamp, &r, normal, middle));
    return r;
}

SIMD vf lamp_visibility(const struct kiln_lamp_objects *objects, const struct kiln_draw_light *lamp,
                        const struct kiln_shape_set *casters, struct vf3 origin, struct vf3 normal,
                        const struct vf3 *middle, vf lit, vi active)
{
    return lamp_receiver_of(objects, lamp, casters, origin, normal, middle, lit, active).visible;
}

#endif
