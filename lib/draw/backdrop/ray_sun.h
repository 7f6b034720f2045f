/* This header computes the part of the sun that surfaces see past the backdrop's objects and past
 * solid particles. An object that hides nothing from a lane multiplies the lane's light by exactly
 * 1, so that it does not matter which lanes share a vector. */
#ifndef KILN_DRAW_BACKDROP_RAY_SUN_H
#define KILN_DRAW_BACKDROP_RAY_SUN_H

#include "base/transpose.h"
#include "draw/backdrop/ray_shapes.h"
#include "draw/light/ray_shadow.h"
#include "draw/light/shapes_hide.h"
#include "shared/shadow_map.h"

/* Describes points whose sunlight is computed, and the lanes that need it. */
struct sun_receiver {
    struct vf3 origin, normal;
    vi active;
};

/* ---- meshes ---------------------------------------------------------------------------------- */

/* Returns the part of the sun that a mesh covers. */
SIMD vf mesh_cover(const struct kiln_ray_frame *frame, int i, const struct sun_receiver *receiver)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    const struct shadow_map map = {frame->meshes->shadows[i], KILN_SHADOW_EDGE, KILN_SHADOW_LEVELS,
                                   1};
    const vi first = vi_all(0);
    const float spread = shapes->sun_right.w;
    const struct shadow_receiver at =
        shadow_receiver_of(shapes->meshes[i].center, receiver->origin, receiver->normal,
                           frame->backdrop->sun_direction, shapes->sun_right, shapes->sun_up);
    vf widest = shadow_widest(at, spread), reach = 4.0f * widest;
    vi near = receiver->active & (at.u > -reach) & (at.v > -reach) & (at.u < 1.0f + reach) &
              (at.v < 1.0f + reach);
    if (!any(near))
        return vf_all(0.0f);

    struct shadow_filter filter = shadow_filter_of(&map, first, shadow_level(widest) + 1.0f);
    struct shadow_sample shadow = read_shadow(&map, &filter, at.u, at.v);
    near &= shadow.cover > 0.0f;
    if (!any(near))
        return vf_all(0.0f);
    vf width = shadow_width(at, spread, shadow.cover, shadow.distance);
    filter = shadow_filter_of(&map, first, shadow_level(width));
    vf stride = 0.5f * width, cover = vf_all(0.0f);
    vf ramp = 1.0f / (at.slack + stride);
    for (int k = 0; k < 4; k++) {
        vf aside_u = k & 1 ? stride : -stride, aside_v = k >> 1 ? stride : -stride;
        shadow = read_shadow(&map, &filter, at.u + aside_u, at.v + aside_v);
        cover += shadow_tap(at, aside_u, aside_v, shadow.cover, shadow.distance, ramp);
    }
    return vf_where(near, cover);
}

/* ---- particles ------------------------------------------------------------------------------- */

SIMD vf particle_cover(const struct kiln_ray_frame *frame, struct vf3 center, vf size,
                       struct vf3 origin)
{
    return speck_cover(vf3_sub(center, origin), size, frame->backdrop->sun_direction,
                       frame->shapes->sun_right.w, KILN_SOLID_FADE);
}

/* Returns where a level of the silhouettes starts, in texels. */
SIMD vi silhouette_start(vi level)
{
    vi start = vi_all(0), size = vi_all(KILN_INSTANCE_ATLAS * KILN_INSTANCE_ATLAS);
    for (int i = 0; i < KILN_INSTANCE_LEVELS; i++) {
        start += (level > i) & size;
        size >>= 2;
    }
    return start;
}

/* Describes each lane's tile as struct kiln_solid_bins does: where it starts and its width, in
 * texels; half of its width, m. */
struct ray_tile {
    vi x, y, edge;
    vf reach;
};

/* Interpolates linearly between four texels of a level; texels beside the tile count as 0. */
SIMD vf silhouette_level(const float *texels, const struct ray_tile *tile, vf u, vf v, vi level)
{
    const vi edge = tile->edge >> level, pitch = vi_all(KILN_INSTANCE_ATLAS) >> level;
    const vi start = silhouette_start(level) + (tile->y >> level) * pitch + (tile->x >> level);
    const vf size = vf_of(edge);
    const vf x = vf_min(vf_max(u * size - 0.5f, vf_all(-2.0f)), size + 1.0f);
    const vf y = vf_min(vf_max(v * size - 0.5f, vf_all(-2.0f)), size + 1.0f);
    const vf left = vf_floor(x), top = vf_floor(y), right = x - left, down = y - top;
    vf sum = vf_all(0.0f);
    for (int i = 0; i < 4; i++) {
        vi column = vi_of(left) + (i & 1), row = vi_of(top) + (i >> 1);
        vi inside = (column >= 0) & (row >= 0) & (column < edge) & (row < edge);
        vf weight = (i & 1 ? right : 1.0f - right) * (i >> 1 ? down : 1.0f - down);
        vi at = vi_select(inside, start + row * pitch + column, vi_all(0));
        sum += vf_where(inside, weight * vf_gather(texels, at));
    }
    return sum;
}

/* Returns the part of the sun that meshes cover. ball: the part that the bounding sphere of each
 * mesh covers. */
SIMD vf silhouette_cover(const struct kiln_ray_frame *frame, struct vf3 center,
                         const struct ray_tile *tile, struct vf3 origin, vf ball)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    const float *texels = frame->solids.silhouettes;
    const struct silhouette_place at = silhouette_place_of(
        vf3_sub(center, origin), vf_of(tile->edge), tile->reach, frame->backdrop->sun_direction,
        shapes->sun_right, shapes->sun_up, shapes->sun_right.w);
    vf fine = vf_floor(at.level), coarse = vf_min(fine + 1.0f, at.last);
    vf cover = silhouette_level(texels, tile, at.u, at.v, vi_of(fine));
    cover +=
        (silhouette_level(texels, tile, at.u, at.v, vi_of(coarse)) - cover) * (at.level - fine);
    return silhouette_covers(at, cover, ball);
}

/* Holds an entry of the list of solids, read for each lane. */
struct ray_entry {
    struct vf3 center;
    vf size, reach; /* radius of the sphere; half of the tile's width, else the radius; m */
    vi at, edge;    /* offset in the lists, in floats; edge of the tile, texels, 0: no tile */
};

SIMD struct ray_entry read_entry(const struct kiln_solid_bins *solids, vi entry, vi active)
{
    const vi at = vi_select(active, 4 * entry, vi_all(0));
    const struct lane_offsets places = lane_offsets_of(at);
    const struct columns ball = columns_load(&solids->list->x, &places);
    struct ray_entry e = {.center = {ball.c[0], ball.c[1], ball.c[2]}, .size = ball.c[3], .at = at};
    e.reach = e.size;
    if (solids->tiles) {
        const struct columns tile = columns_load(&solids->tiles->x, &places);
        e.edge = vi_of(tile.c[3]);
        e.reach = vf_select(tile.c[3] > 0.0f, tile.c[2], e.size);
    }
    return e;
}

/* Returns the lanes where an entry may hide the sun; elsewhere its cover is 0. */
SIMD vi entry_is_near(const struct kiln_ray_frame *frame, const struct ray_entry *e,
                      struct vf3 origin)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    const struct vf3 towards = vf3_sub(e->center, origin);
    const vf t = vf3_dot_all(towards, frame->backdrop->sun_direction);
    const vf aside = vf_max(vf_abs(vf3_dot_all(towards, shapes->sun_right)),
                            vf_abs(vf3_dot_all(towards, shapes->sun_up)));
    /* Reads reach half a texel past a tile: at most the sun's radius there or 1/16 of the tile's
     * width. */
    const vf wider = vf_max(t * shapes->sun_right.w, 0.125f * e->reach);
    return (t > 0.0f) & (aside < e->reach + (wider + 1e-4f));
}

SIMD vf entry_cover(const struct kiln_ray_frame *frame, const struct ray_entry *e,
                    struct vf3 origin)
{
    const vf ball = particle_cover(frame, e->center, e->size, origin);
    const vi has = e->edge > 0;
    if (!any(has))
        return ball;
    const float *tiles = (const float *)frame->solids.tiles;
    const struct ray_tile tile = {vi_of(vf_gather(tiles, e->at)),
                                  vi_of(vf_gather(tiles + 1, e->at)),
                                  vi_select(has, e->edge, vi_all(1)), e->reach};
    return vf_select(has, silhouette_cover(frame, e->center, &tile, origin, ball), ball);
}

/* Number of entries of a list whose nearness is found before the near ones hide the sun. Each has a
 * bit, of which lowest_bit allows 31; most lists are shorter than 24. */
enum { ENTRIES_AT_A_TIME = 24 };

/* Returns a bit for each of the next entries of each lane's list that is near. count: entries that
 * are left in the list. */
SIMD vi find_near_entries(const struct kiln_ray_frame *frame, struct vf3 origin, vi first, vi count)
{
    vi bits = vi_all(0);
    for (int i = 0; i < ENTRIES_AT_A_TIME; i++) {
        const vi pending = count > i;
        if (!any(pending))
            break;
        const struct ray_entry e = read_entry(&frame->solids, first + i, pending);
        bits |= pending & entry_is_near(frame, &e, origin) & vi_all(1 << i);
    }
    return bits;
}

/* Returns the number of the lowest of 31 bits that is set; any number where none is. A float's
 * exponent tells it. */
SIMD vi lowest_bit(vi bits)
{
    return ((vi)vf_of(bits & -bits) >> 23) - 127;
}

/* Returns the part of the sun that solid particles let through. Each lane first finds which entries
 * of its list are near, so that few lanes wait for others. */
SIMD vf particles_sun_visibility(const struct kiln_ray_frame *frame,
                                 const struct sun_receiver *receiver)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    const int32_t *bins = (const int32_t *)frame->solids.bins;
    const float edge = (float)shapes->counts.w;
    vf visible = vf_all(1.0f);
    vf x = vf3_map(shapes->world_to_bin[0], receiver->origin);
    vf y = vf3_map(shapes->world_to_bin[1], receiver->origin);
    vi inside = receiver->active & (x >= 0.0f) & (y >= 0.0f) & (x < edge) & (y < edge);
    if (!any(inside))
        return visible;
    vi bin = vi_of(vf_where(inside, y)) * (int32_t)shapes->counts.w + vi_of(vf_where(inside, x));
    vi entry = vi_gather(bins, 2 * bin), count = inside & vi_gather(bins, 2 * bin + 1);
    for (; any(count > 0); entry += ENTRIES_AT_A_TIME, count -= ENTRIES_AT_A_TIME) {
        vi bits = find_near_entries(frame, receiver->origin, entry, count);
        for (vi found = bits != 0; any(found); bits &= bits - 1, found = bits != 0) {
            const struct ray_entry e = read_entry(&frame->solids, entry + lowest_bit(bits), found);
            visible *= 1.0f - vf_where(found, entry_cover(frame, &e, receiver->origin));
        }
    }
    return visible;
}

/* ---- all objects and particles --------------------------------------------------------------- */

SIMD struct sun_receiver sun_receiver_of(struct vf3 point, struct vf3 normal, vi active)
{
    return (struct sun_receiver){vf3_add_scaled(point, normal, vf_all(LIGHT_START)), normal,
                                 active};
}

/* Returns the part of the sun that is visible past objects; 0 for lanes that are not active. */
SIMD vf sun_past_objects(const struct kiln_ray_frame *frame, const struct sun_receiver *receiver)
{
    if (!any(receiver->active))
        return vf_all(0.0f);
    struct light_receiver r = {.origin = receiver->origin,
                               .seen = frame->from_sun,
                               .blocked = frame->shapes->sun_right.w == 0.0f,
                               .active = receiver->active,
                               .visible = vf_all(1.0f),
                               .way = sun_way_of(frame->backdrop->sun_direction,
                                                 frame->shapes->sun_right.w, vf_all(0.0f))};
    hide_by_shapes(frame->shapes, &frame->casters->sun_objects, &r);
    vf visible = r.visible;
    uint64_t meshes = frame->casters->sun_meshes;
    for (; meshes; meshes &= meshes - 1)
        visible *= 1.0f - mesh_cover(frame, __builtin_ctzll(meshes), receiver);
    return vf_where(receiver->active, visible);
}

/* Returns the part of the sun that solid particles let through. */
SIMD vf sun_past_particles(const struct kiln_ray_frame *frame, const struct sun_receiver *receiver)
{
    if (frame->shapes->counts.w == 0 || !any(receiver->active))
        return vf_all(1.0f);
    return particles_sun_visibility(frame, receiver);
}

/* Returns the visible part of the sun; 0 for lanes that are not active. */
SIMD vf sun_visibility(const struct kiln_ray_frame *frame, struct vf3 point, struct vf3 normal,
                       vi active)
{
    const struct sun_receiver receiver = sun_receiver_of(point, normal, active);
    return sun_past_objects(frame, &receiver) * sun_past_particles(frame, &receiver);
}

#endif
