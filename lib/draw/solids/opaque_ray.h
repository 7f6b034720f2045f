/* This header holds the rays and the lighting that solid spheres and solid meshes share. It is for
 * files *_simd.c, which are compiled once for each width of vectors. */
#ifndef KILN_DRAW_SOLIDS_OPAQUE_RAY_H
#define KILN_DRAW_SOLIDS_OPAQUE_RAY_H

#include "draw/backdrop/ray_light.h"
#include "draw/solids/solid_rows.h"

/* The positions of a pixel's samples, px from its middle: a rotated grid, in which no two samples
 * share a row or a column. */
static const float SAMPLE_OFFSETS[KILN_SOLID_SAMPLES][2] = {
    {-0.125f, -0.375f}, {0.375f, -0.125f}, {-0.375f, 0.125f}, {0.125f, 0.375f}};

/* Returns the ray in view space through a position in the picture, px. Its z is -1, so that t along
 * the ray is the view depth. */
SIMD struct vf3 view_ray(const struct kiln_ray_frame *frame, vf x, vf y)
{
    const float4 frustum = frame->view->frustum, principal = frame->view->principal;
    return (struct vf3){(x * (2.0f / frustum.z) - 1.0f) * frustum.x - principal.z,
                        (1.0f - y * (2.0f / frustum.w)) * frustum.y - principal.w, vf_all(-1.0f)};
}

SIMD struct vf3 gather3(const float *from, vi index)
{
    return (struct vf3){vf_gather(from, index), vf_gather(from + 1, index),
                        vf_gather(from + 2, index)};
}

SIMD struct vf3 view_to_world(const struct kiln_ray_frame *frame, struct vf3 v)
{
    const float4 *rows = frame->view->world_to_view;
    return (struct vf3){rows[0].x * v.x + rows[1].x * v.y + rows[2].x * v.z,
                        rows[0].y * v.x + rows[1].y * v.y + rows[2].y * v.z,
                        rows[0].z * v.x + rows[1].z * v.y + rows[2].z * v.z};
}

/* Holds visible particles in pixels of a row, one particle in one pixel a lane. */
struct visible_particles {
    vi column, particle; /* particle: offset of the particle's record in its array, in floats */
    vi corner;           /* for a mesh, offset of the triangle's first corner, in floats */
    vf part;             /* part of the pixel that the particle covers */
};

/* Holds the visible point of each particle of a vector, in world space. */
struct visible_point {
    struct vf3 at, normal, direction; /* position, m; unit normal; direction of the ray */
    struct vf3 sun_from;              /* start of the ray to the sun, m */
    struct vf3 middle;                /* of the particle, m */
    vf depth, lit;
    struct vf3 albedo, glow;
};

/* Computes the colour of visible points from sky, sun and lights, and their glow. */
SIMD_ONCE void light_place(const struct kiln_ray_frame *frame, const struct visible_point *place,
                           const struct visible_particles *visible, struct ray_color *color)
{
    const struct ray_hit hit = {.t = place->depth,
                                .surface = vf_all(0.0f),
                                .normal = place->normal,
                                .albedo = place->albedo};
    const struct cached_rays cached = not_cached();
    const struct lit_surface surface = {.point = {place->at, hit.normal, visible->part > 0.0f},
                                        .middle = &place->middle,
                                        .cached = &cached};
    const struct ray_point point = surface.point;
    vf sunlit = sun_visibility(frame, place->sun_from, point.normal, facing_sun(frame, &point));
    const struct ray_point sunny = {point.at, point.normal, sunlit > 0.0f};
    sunlit *= smoke_lets_through(frame->smoke_to_sun, frame->backdrop->sun_to_grid, &sunny);
    const struct hit_light light = {light_without_sun(frame, &surface).irradiance, sunlit};
    const struct vf3 lit = radiance_before_haze(frame, &hit, &light);
    struct vf3 shown = vf3_add_scaled(hit.albedo, vf3_sub(lit, hit.albedo), place->lit);
    shown = vf3_add(place->glow, shown);
    color->rgb =
        behind_haze(frame, shown, place->depth, place->direction, visible->part > 0.0f, &cached);
    color->alpha = visible->part;
}

#endif
