/* This header traces vectors of rays, and computes the colours of what they hit. */
#ifndef KILN_DRAW_BACKDROP_RAY_SHADE_H
#define KILN_DRAW_BACKDROP_RAY_SHADE_H

#include "draw/backdrop/ray_floor.h"
#include "draw/backdrop/ray_mesh.h"

/* Holds rays from the eye through pixels. */
struct eye_rays {
    struct ray ray;
    struct ray_place place;
};

SIMD struct eye_rays rays_at(const struct kiln_ray_frame *frame, const struct ray_place *place)
{
    const float4 *rows = frame->view->world_to_view;
    vf u = place->u, v = place->v;
    return (struct eye_rays){
        .ray = {.origin = vf3_all(frame->view->eye),
                .direction = {rows[0].x * u + rows[1].x * v - rows[2].x,
                              rows[0].y * u + rows[1].y * v - rows[2].y,
                              rows[0].z * u + rows[1].z * v - rows[2].z}},
        .place = *place,
    };
}

/* Returns the rays through the centres of pixels. */
SIMD struct eye_rays rays_through_pixels(const struct kiln_ray_frame *frame, vi column, vi row)
{
    const float4 frustum = frame->view->frustum, principal = frame->view->principal;
    vf x = vf_of(column) + 0.5f, y = vf_of(row) + 0.5f;
    struct ray_place place = {
        .u = (x * (2.0f / frustum.z) - 1.0f) * frustum.x - principal.z,
        .v = (1.0f - y * (2.0f / frustum.w)) * frustum.y - principal.w,
    };
    if (frame->meshes)
        place.hit = row * (int32_t)(KILN_HIT_LAYERS * frame->meshes->pitch) + column;
    return rays_at(frame, &place);
}

/* Finds the first hit of each ray. floor: the t at which each ray meets the floor; the albedo of
 * hits on the floor is left unset. */
SIMD_ONCE struct ray_hit trace(const struct kiln_ray_frame *frame,
                               const struct kiln_ray_objects *objects, const struct ray *ray,
                               vf floor, const struct ray_place *place)
{
    struct ray_hit nearest = {.t = vf_all(RAY_FAR),
                              .surface = vf_all(-1.0f),
                              .normal = {vf_all(0.0f), vf_all(1.0f), vf_all(0.0f)},
                              .albedo = {{0}, {0}, {0}}};
    trace_boxes(frame, objects->boxes, ray, &nearest);
    trace_spheres(frame, objects->spheres, ray, &nearest);
    trace_cylinders(frame, objects->cylinders, ray, &nearest);
    trace_capsules(frame, objects->capsules, ray, &nearest);
    trace_oriented_boxes(frame, objects->oriented_boxes, ray, &nearest);
    trace_planes(frame, objects->planes, ray, &nearest);
    if (frame->meshes && place->layer >= 0)
        trace_meshes(frame, place, &nearest);
    vi below = floor < nearest.t;
    const struct vf3 up = {vf_all(0.0f), vf_all(1.0f), vf_all(0.0f)};
    nearest.t = vf_select(below, floor, nearest.t);
    nearest.surface = vf_where(~below, nearest.surface);
    nearest.normal = vf3_select(below, up, nearest.normal);
    return nearest;
}

/* Holds the colours and the first hits of rays. */
struct shaded_rays {
    struct ray_color color;
    struct ray_hit first;
    vf arrives; /* part of the sun that arrives at the hit through smoke */
    vf light;   /* part of the sun that the hit sees past objects, less the part of its other light
                 * that shadows of lamps take; -1 to 1 */
    struct ray_reflection mirror; /* of a glossy floor */
    struct vf3 reflected;         /* light of the lamps that it reflects to the eye */
};

/* Describes the pixels of a vector whose rays are cast. */
struct grid_pixels {
    const struct light_grid *grid, *mirrored; /* of their strip, and of its reflections or NULL */
    uint32_t column, row;                     /* of the first pixel, in the strip */
};

/* Describes what helps to shade rays; members are NULL where there is no such help. */
struct ray_help {
    const struct grid_pixels *pixels;
    const struct cached_rays *cached;
};

/* Computes the light that arrives at the hits, and their colours. */
SIMD_ONCE void light_hits(const struct kiln_ray_frame *frame, const struct ray *ray, bool glossy,
                          const struct ray_help *help, struct shaded_rays *shaded)
{
    const struct ray_hit *hit = &shaded->first;
    const struct ray_point point = {ray_at(ray, hit->t), hit->normal, hit->surface >= 0.0f};
    struct arrived arrived = {.irradiance = {{0}, {0}, {0}}};
    if (any(point.active)) {
        struct grid_place place;
        const struct grid_place *in_grid = NULL;
        if (help->pixels) {
            const struct grid_pixels *pixels = help->pixels;
            place = grid_place_of(pixels->grid, pixels->column, pixels->row, hit, point.at);
            in_grid = &place;
        }
        const vf sunlit = sun_seen(frame, &point, facing_sun(frame, &point), help->cached);
        const struct ray_point sunny = {point.at, point.normal, sunlit > 0.0f};
        shaded->arrives = sunlit * past_smoke(frame, GRID_SUN, &sunny, in_grid);
        glossy = glossy && any(hit->surface == 0.0f);
        if (glossy)
            shaded->mirror = floor_reflection_along(frame, ray);
        const struct lit_surface surface = {.point = point,
                                            .gloss = glossy ? &shaded->mirror.at : NULL,
                                            .grid = in_grid,
                                            .cached = help->cached};
        arrived = light_without_sun(frame, &surface);
        shaded->light = sunlit - arrived.hidden / vf_max(arrived.all, vf_all(1e-6f));
        shaded->reflected = arrived.reflected;
    }
    const struct hit_light light = {arrived.irradiance, shaded->arrives};
    shaded->color = radiance_or_sky(frame, hit, ray->direction, &light, help->cached);
}

/* Sets the albedo of hits on the floor. */
SIMD void color_floor(const struct kiln_ray_frame *frame, const struct ray *ray,
                      struct ray_hit *hit)
{
    const vi below = hit->surface == 0.0f;
    if (any(below))
        hit->albedo = vf3_select(below, floor_albedo(frame, ray, hit->t, below), hit->albedo);
}

/* Finds what rays from the eye, or reflected ones, hit. place->layer is -1 for the latter. */
SIMD struct ray_hit find_hit(const struct kiln_ray_frame *frame,
                             const struct kiln_ray_objects *objects, const struct ray *ray,
                             const struct ray_place *place, const struct cached_rays *cached)
{
    if (is_filled(cached))
        return read_cached_hit(cached);
    const vf floor = place->layer < 0 ? vf_all(2.0f * RAY_FAR) : find_floor(frame, ray);
    struct ray_hit hit = trace(frame, objects, ray, floor, place);
    color_floor(frame, ray, &hit);
    if (cached)
        fill_cached_hit(cached, &hit);
    return hit;
}

/* Adds the reflection of a glossy floor by following the reflected ray. eye: what helps with the
 * ray from the eye. */
SIMD_ONCE void add_reflection(const struct kiln_ray_frame *frame, const struct ray *ray,
                              const struct ray_help *eye, struct shaded_rays *shaded)
{
    vi floor = shaded->first.surface == 0.0f;
    if (!any(floor))
        return;
    struct kiln_ray_frame all = *frame;
    all.casters = frame->all_casters;
    const struct kiln_ray_objects objects = all_objects(frame);
    const struct ray_reflection *m = &shaded->mirror;
    const struct ray reflected = {ray_at(ray, shaded->first.t), m->at.direction};
    const struct ray_place nowhere = {.layer = -1};
    struct ray_help help = {NULL, NULL};
    struct cached_rays planes;
    if (eye->cached) {
        planes = cached_reflections(eye->cached);
        help.cached = &planes;
    }
    struct grid_pixels pixels;
    if (eye->pixels && eye->pixels->mirrored) {
        pixels = (struct grid_pixels){eye->pixels->mirrored, NULL, eye->pixels->column,
                                      eye->pixels->row};
        help.pixels = &pixels;
    }
    struct shaded_rays reflection = {
        .first = find_hit(&all, &objects, &reflected, &nowhere, help.cached)};
    light_hits(&all, &reflected, false, &help, &reflection);
    struct vf3 more = vf3_scale(shaded->reflected, m->part);
    more = vf3_add_scaled(more, m->sun, shaded->arrives);
    more = vf3_add_scaled(more, reflection.color.rgb, m->part * m->at.reflectance);
    shaded->color.rgb = vf3_select(floor, vf3_add(shaded->color.rgb, more), shaded->color.rgb);
}

/* Computes the colours of rays from the eye whose hits are known. */
SIMD struct shaded_rays shade_hits(const struct kiln_ray_frame *frame, const struct ray *ray,
                                   const struct ray_hit *first, const struct ray_help *help)
{
    struct shaded_rays shaded = {.first = *first};
    light_hits(frame, ray, frame->floor_gloss, help, &shaded);
    shaded.color.rgb = add_sun_disc(frame, shaded.color.rgb, ray->direction, first->surface < 0.0f);
    if (frame->floor_gloss)
        add_reflection(frame, ray, help, &shaded);
    return shaded;
}

/* Stores colours by channel. */
SIMD void store_channels(float channels[4][LANES], const struct ray_color *color)
{
    vf_store(channels[0], color->rgb.x);
    vf_store(channels[1], color->rgb.y);
    vf_store(channels[2], color->rgb.z);
    vf_store(channels[3], color->alpha);
}

/* Stores colours by pixel. */
SIMD void store_colors(float to[4 * LANES], const struct ray_color *color)
{
    _Alignas(64) float channels[4][LANES];
    store_channels(channels, color);
    for (int i = 0; i < LANES; i++) {
        for (int c = 0; c < 4; c++)
            to[4 * i + c] = channels[c][i];
    }
}

#endif
