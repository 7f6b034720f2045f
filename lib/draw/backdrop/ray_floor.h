/* This header computes where vectors of rays hit the floor, the floor's albedo there, and its
 * reflections. */
#ifndef KILN_DRAW_BACKDROP_RAY_FLOOR_H
#define KILN_DRAW_BACKDROP_RAY_FLOOR_H

#include "draw/backdrop/ray_light.h"
#include "shared/floor.h"

SIMD struct floor_extent floor_extent_along(const struct kiln_ray_frame *frame,
                                            struct vf3 direction, vf t)
{
    const float4 frustum = frame->view->frustum;
    return floor_extent_of(direction, t, 2.0f * frustum.y / frustum.w);
}

/* Returns the t at which rays hit the floor; a t beyond RAY_FAR where they do not. */
SIMD vf find_floor(const struct kiln_ray_frame *frame, const struct ray *ray)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    if (b->floor_params.x <= 0.0f)
        return vf_all(2.0f * RAY_FAR);
    return ray_cross_plane(ray->origin.y - b->floor_color.w, ray->direction.y);
}

/* Returns the albedo of the floor where rays hit it. */
SIMD struct vf3 floor_albedo(const struct kiln_ray_frame *frame, const struct ray *ray, vf t,
                             vi active)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    vf x = ray->origin.x + ray->direction.x * t, z = ray->origin.z + ray->direction.z * t;
    if (frame->floor_image) {
        const float4 *rows = frame->view->world_to_view;
        const struct floor_footprint footprint = floor_footprint_of(
            ray->direction, t, rows[0], rows[1], frame->view->frustum, frame->shapes->floor_map.z);
        return floor_picture(frame, &footprint, x, z, active);
    }
    if (b->floor_params.y <= 0.0f)
        return vf3_all(b->floor_color);
    const struct floor_extent extent = floor_extent_along(frame, ray->direction, t);
    return vf3_scale(vf3_all(b->floor_color), floor_checkers(x, z, b->floor_params.y, extent));
}

/* ---- gloss ----------------------------------------------------------------------------------- */

SIMD struct floor_water find_water(const struct kiln_ray_frame *frame, vf x, vf z,
                                   struct floor_extent extent)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    struct floor_water water = {x, z, vf_all(0.0f), vf_all(0.0f), vf_all(0.0f)};
    for (int i = 0; i < KILN_WAVES && shapes->floor_gloss.z > 0.0f; i++)
        water = floor_add_wave(water, shapes->waves[i], shapes->wave_shift[i],
                               shapes->floor_gloss.z, extent);
    return water;
}

/* Holds how the floor reflects rays. */
struct ray_reflection {
    struct floor_reflection at;
    vf part;        /* factor of the light that it reflects */
    struct vf3 sun; /* sunlight that is reflected to the eye where there is no shadow */
};

/* Computes the reflection of the floor along rays from the eye. */
SIMD struct ray_reflection floor_reflection_along(const struct kiln_ray_frame *frame,
                                                  const struct ray *ray)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    const float4 gloss = frame->shapes->floor_gloss;
    struct vf3 direction = ray->direction;
    vf t = vf_max(ray->origin.y - b->floor_color.w, vf_all(0.0f)) /
           vf_max(-direction.y, vf_all(1e-6f));
    struct vf3 point = ray_at(ray, t);
    const struct floor_water water =
        find_water(frame, point.x, point.z, floor_extent_along(frame, direction, t));
    struct ray_reflection mirror = {
        .at = floor_reflection_of(direction, water, gloss.y),
        .part = vf_all(gloss.x),
    };
    if (b->counts.z == 0)
        mirror.part *= vf_exp(-b->floor_params.z * t * vf3_length(direction));
    const vf lobe =
        floor_lobe(mirror.at.normal, mirror.at.to_eye, vf3_all(b->sun_direction), mirror.at.spread);
    mirror.sun = vf3_scale(vf3_all(b->sun_color), mirror.part * lobe);
    return mirror;
}

#endif
