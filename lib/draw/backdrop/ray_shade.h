/* This header computes the colours of what vectors of rays hit. */
#ifndef KILN_DRAW_BACKDROP_RAY_SHADE_H
#define KILN_DRAW_BACKDROP_RAY_SHADE_H

#include "draw/backdrop/ray_floor.h"
#include "draw/backdrop/ray_trace.h"

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

/* Describes what helps to shade rays. */
struct ray_help {
    const struct grid_pixels *pixels; /* NULL: they are in no grid */
    const struct cached_rays *cached;
};

/* Computes the light that arrives at the hits, and their colours: code of its own for each level
 * (ray_light_simd.c), since several loops call it. */
void KILN_SIMD_NAME(kiln_rays_light)(const struct kiln_ray_frame *frame, const struct ray *ray,
                                     bool glossy, const struct ray_help *help,
                                     struct shaded_rays *shaded);

/* Finds what may be interpolated in a grid whose nodes have their places. Where no block is smooth
 * for a light, the nodes need not see it. lights: those that pixels will ask for. */
void KILN_SIMD_NAME(kiln_rays_judge_grid)(const struct kiln_ray_frame *frame,
                                          struct grid_lights lights, struct light_grid *grid);

/* Finds where what smoke lets through may be interpolated in a grid whose blocks are judged by
 * their surfaces. box: around what its pixels show; NULL: anywhere. */
void KILN_SIMD_NAME(kiln_rays_judge_smoke)(const struct kiln_ray_frame *frame,
                                           const struct kiln_lit_box *box, struct light_grid *grid);

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
                             const struct kiln_shape_set *shapes, const struct ray *ray,
                             const struct ray_place *place, const struct cached_rays *cached)
{
    if (is_filled(cached))
        return read_cached_hit(cached);
    const vf floor = place->layer < 0 ? vf_all(2.0f * RAY_FAR) : find_floor(frame, ray);
    struct ray_hit hit = trace(frame, shapes, ray, floor, place);
    color_floor(frame, ray, &hit);
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
    const struct ray_reflection *m = &shaded->mirror;
    const struct ray reflected = {ray_at(ray, shaded->first.t), m->at.direction};
    const struct ray_place nowhere = {.layer = -1};
    const struct cached_rays planes = cached_reflections(eye->cached);
    struct ray_help help = {NULL, &planes};
    struct grid_pixels pixels;
    if (eye->pixels && eye->pixels->mirrored) {
        pixels = (struct grid_pixels){eye->pixels->mirrored, NULL, eye->pixels->column,
                                      eye->pixels->row};
        help.pixels = &pixels;
    }
    struct shaded_rays reflection = {
        .first = find_hit(&all, frame->all_shapes, &reflected, &nowhere, help.cached)};
    KILN_SIMD_NAME(kiln_rays_light)(&all, &reflected, false, &help, &reflection);
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
    KILN_SIMD_NAME(kiln_rays_light)(frame, ray, frame->floor_gloss, help, &shaded);
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
