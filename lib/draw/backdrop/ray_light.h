/* This header computes the light that surfaces and the sky send to the eye along vectors of
 * rays. */
#ifndef KILN_DRAW_BACKDROP_RAY_LIGHT_H
#define KILN_DRAW_BACKDROP_RAY_LIGHT_H

#include "draw/backdrop/ray_cache.h"
#include "draw/backdrop/ray_grid_smoke.h"
#include "draw/backdrop/ray_picture.h"
#include "draw/backdrop/ray_sun.h"
#include "draw/light/ray_lamp.h"
#include "shared/floor.h"
#include "shared/haze.h"
#include "shared/lamp.h"

struct ray_color {
    struct vf3 rgb;
    vf alpha;
};

/* ---- light that arrives at a surface --------------------------------------------------------- */

/* Holds the light of sky and lamps that arrives at points. */
struct arrived {
    struct vf3 irradiance;
    struct vf3 reflected; /* light of the lamps that a glossy floor reflects to the eye */
    /* The brightness of the irradiance without shadows and cones of lamps; that of what they take.
     */
    vf all, hidden;
};

/* Describes surfaces that get light. */
struct lit_surface {
    struct ray_point point;
    const struct floor_reflection *gloss; /* how a glossy floor reflects lamps, or NULL */
    const struct vf3 *middle;             /* of the solid particles that it is of, or NULL */
    const struct grid_place *grid;        /* or NULL */
    const struct cached_rays *cached;
};

/* Computes the part of the sky that a surface sees past objects. */
SIMD vf find_sky_seen(const struct kiln_ray_frame *frame, const struct lit_surface *s)
{
    struct ray_point others = s->point;
    vf seen = vf_all(1.0f);
    vi known = vi_all(0);
    if (s->grid)
        known = grid_sky_seen(s->grid, &seen);
    others.active &= ~known;
    if (!any(others.active))
        return seen;
    return vf_select(known, seen, sky_past_objects(frame, &others));
}

/* Computes the part of lamp i that a surface sees past objects. */
SIMD vf find_lamp_seen(const struct kiln_ray_frame *frame, uint32_t i, const struct lit_surface *s,
                       vi active)
{
    const struct kiln_draw_light *lamp = &frame->backdrop->lights[i];
    vf seen = vf_all(1.0f);
    vi known = vi_all(0);
    if (s->grid)
        known = grid_lamp_seen(s->grid, i, &seen);
    active &= ~known;
    if (!any(active))
        return vf_select(known, seen, vf_all(1.0f));
    const struct ray_point *p = &s->point;
    const vf found = lamp_visibility(&frame->lamp_objects, lamp, &frame->casters->lamps[i],
                                     vf3_add_scaled(p->at, p->normal, vf_all(LIGHT_START)),
                                     p->normal, s->middle, vf_all(0.0f), active);
    return vf_select(known, seen, found);
}

/* Returns the part of lamp i that a surface sees past objects. */
SIMD vf lamp_seen(const struct kiln_ray_frame *frame, uint32_t i, const struct lit_surface *s,
                  vi active)
{
    const uint32_t plane = plane_of_lamp(s->cached, i);
    if (plane && is_filled(s->cached))
        return read_cached(s->cached, plane);
    const vf seen = find_lamp_seen(frame, i, s, active);
    if (plane)
        fill_cached(s->cached, plane, seen);
    return seen;
}

/* Adds the light of lamp i. */
SIMD void add_lamp(const struct kiln_ray_frame *frame, uint32_t i, const struct lit_surface *s,
                   struct arrived *arrived)
{
    const struct kiln_draw_light *lamp = &frame->backdrop->lights[i];
    const struct ray_point *p = &s->point;
    const struct floor_reflection *gloss = s->gloss;
    const struct vf3 towards = vf3_towards(lamp->position_radius2, p->at);
    const float radius2 = lamp->position_radius2.w;
    const vf part = vf_where(p->active, lamp_irradiance(*lamp, towards, p->normal));
    const vi faces = part > 0.0f;
    if (!any(faces) && !gloss)
        return;
    const vf cone = lamp_cone(*lamp, towards);
    const struct ray_point lit = {p->at, p->normal, faces & (cone > 0.0f)};
    vf seen = cone * past_smoke(frame, i, &lit, s->grid);
    if ((lamp->casters.y || kiln_shape_set_any(&frame->casters->lamps[i])) && any(lit.active))
        seen *= lamp_seen(frame, i, s, lit.active);
    const vf all = (lamp->color.x + lamp->color.y + lamp->color.z) * part;
    arrived->all += all;
    arrived->hidden += all * (1.0f - seen);
    arrived->irradiance = vf3_add_scaled(arrived->irradiance, vf3_all(lamp->color), part * seen);
    if (gloss) {
        vf mirrored =
            floor_reflects_lamp(towards, radius2, gloss->normal, gloss->to_eye, gloss->spread);
        if (lamp->facing.w == KILN_LAMP_RECTANGLE)
            mirrored *= lamp_share(*lamp, towards);
        arrived->reflected =
            vf3_add_scaled(arrived->reflected, vf3_all(lamp->color), mirrored * seen);
    }
}

/* Returns the light of the sky and of the lamps. */
SIMD struct arrived light_without_sun(const struct kiln_ray_frame *frame,
                                      const struct lit_surface *s)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    const struct ray_point *p = &s->point;
    vf sky;
    if (is_filled(s->cached)) {
        sky = read_cached(s->cached, KILN_CACHE_SKY);
    } else {
        sky = find_sky_seen(frame, s);
        fill_cached(s->cached, KILN_CACHE_SKY, sky);
    }
    sky *= past_smoke(frame, GRID_SKY, p, s->grid);
    const struct vf3 ambient = sky_ambient(b->sky_horizon, b->sky_top, p->normal);
    struct arrived arrived = {.irradiance = vf3_scale(ambient, RAY_PI * sky)};
    arrived.all = arrived.irradiance.x + arrived.irradiance.y + arrived.irradiance.z;
    for (uint32_t i = 0; i < b->counts.y; i++)
        add_lamp(frame, i, s, &arrived);
    return arrived;
}

/* Returns the part of the sun that points see; 0 in lanes that are not lit. */
SIMD vf sun_seen(const struct kiln_ray_frame *frame, const struct ray_point *p, vi lit,
                 const struct cached_rays *cached)
{
    const struct sun_receiver receiver = sun_receiver_of(p->at, p->normal, lit);
    vf seen;
    if (is_filled(cached)) {
        seen = read_cached(cached, KILN_CACHE_SUN);
    } else {
        seen = sun_past_objects(frame, &receiver);
        fill_cached(cached, KILN_CACHE_SUN, seen);
    }
    return seen * sun_past_particles(frame, &receiver);
}

/* Returns the lanes whose surface faces the sun; none where the sun is black. */
SIMD vi facing_sun(const struct kiln_ray_frame *frame, const struct ray_point *p)
{
    const float4 color = frame->backdrop->sun_color;
    if (color.x + color.y + color.z <= 0.0f)
        return vi_all(0);
    return p->active & (vf3_dot_all(p->normal, frame->backdrop->sun_direction) > 0.0f);
}

/* ---- light that goes to the eye -------------------------------------------------------------- */

/* Returns the angle of a pixel in the middle of the picture. */
SIMD float pixel_angle(const struct kiln_ray_frame *frame)
{
    const float4 frustum = frame->view->frustum;
    return 2.0f * frustum.y / frustum.w;
}

/* Adds the glow around the sun to a colour of the sky. */
SIMD struct vf3 add_sun_glow(const struct kiln_draw_backdrop *b, struct vf3 sky,
                             struct vf3 direction)
{
    const float strength = b->sky_horizon.w;
    if (strength <= 0.0f)
        return sky;
    const vf glow = sky_glow(direction, b->sun_direction, b->floor_params.w);
    return vf3_add_scaled(sky, vf3_all(b->sun_color), strength * glow);
}

/* Returns the colour of the sky without the sun's disc. */
SIMD struct vf3 sky_color(const struct kiln_ray_frame *frame, struct vf3 direction, vi active)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    const struct vf3 sky = frame->sky_image
                               ? sky_picture(frame, direction, pixel_angle(frame), active)
                               : sky_gradient(b->sky_horizon, b->sky_top, direction);
    return add_sun_glow(b, sky, direction);
}

/* Adds the sun's disc to rays from the eye that hit nothing. Reflected rays do not meet the disc:
 * the floor's lobe of the sun stands for its reflection. */
SIMD struct vf3 add_sun_disc(const struct kiln_ray_frame *frame, struct vf3 color,
                             struct vf3 direction, vi sky)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    if (b->sky_top.w <= 0.0f || b->counts.z != 0 || !any(sky))
        return color;
    const vf disc = vf_where(sky, sky_disc(direction, b->sun_direction, pixel_angle(frame)));
    return vf3_add_scaled(color, vf3_all(b->sun_color), b->sky_top.w * disc);
}

/* Returns the colour that surfaces fade into far away: that of the sky at the horizon. */
SIMD struct vf3 horizon_color(const struct kiln_ray_frame *frame, struct vf3 direction, vi active)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    direction.y = vf_all(0.0f);
    const struct vf3 sky =
        frame->sky_image ? sky_picture(frame, direction, 0.1f, active) : vf3_all(b->sky_horizon);
    return add_sun_glow(b, sky, direction);
}

/* Returns the colour of the haze in front of surfaces. */
SIMD struct vf3 haze_color(const struct kiln_ray_frame *frame, struct vf3 direction, vi active,
                           const struct cached_rays *cached)
{
    const uint32_t plane = cached->use == KILN_CACHE_UNUSED ? 0 : cached->cache->haze;
    if (plane && is_filled(cached))
        return read_cached3(cached, plane);
    const struct vf3 haze = horizon_color(frame, direction, active);
    if (plane)
        fill_cached3(cached, plane, haze);
    return haze;
}

/* Returns colours with the haze in front of them. t: of the ray from the eye along the direction;
 * active: a mask. */
SIMD struct vf3 behind_haze(const struct kiln_ray_frame *frame, struct vf3 color, vf t,
                            struct vf3 direction, vi active, const struct cached_rays *cached)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    if (b->counts.z != 0 || b->floor_params.z <= 0.0f)
        return color;
    vf clear = haze_clear(b->floor_params.z, t, vf3_length(direction));
    const struct vf3 haze = haze_color(frame, direction, active, cached);
    return vf3_add_scaled(haze, vf3_sub(color, haze), clear);
}

/* Holds light that arrives at hits. */
struct hit_light {
    struct vf3 irradiance; /* of the sky and of the lamps */
    vf sunlight;           /* part of the sun that arrives */
};

/* Returns the radiance of a Lambertian surface: albedo / pi * irradiance, without haze. */
SIMD struct vf3 radiance_before_haze(const struct kiln_ray_frame *frame, const struct ray_hit *hit,
                                     const struct hit_light *light)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    vf sun = vf_max(vf3_dot_all(hit->normal, b->sun_direction), vf_all(0.0f)) * light->sunlight;
    const struct vf3 irradiance = vf3_add_scaled(light->irradiance, vf3_all(b->sun_color), sun);
    return (struct vf3){hit->albedo.x * (1.0f / RAY_PI) * irradiance.x,
                        hit->albedo.y * (1.0f / RAY_PI) * irradiance.y,
                        hit->albedo.z * (1.0f / RAY_PI) * irradiance.z};
}

/* Returns the same with haze. */
SIMD struct ray_color radiance(const struct kiln_ray_frame *frame, const struct ray_hit *hit,
                               struct vf3 direction, const struct hit_light *light,
                               const struct cached_rays *cached)
{
    struct vf3 color = radiance_before_haze(frame, hit, light);
    color = behind_haze(frame, color, hit->t, direction, hit->surface >= 0.0f, cached);
    return (struct ray_color){color, vf_all(1.0f)};
}

/* Returns the colour of the sky behind rays that hit nothing. In the cache it is their albedo. */
SIMD struct vf3 sky_behind(const struct kiln_ray_frame *frame, const struct ray_hit *hit,
                           struct vf3 direction, vi sky, const struct cached_rays *cached)
{
    if (is_filled(cached))
        return hit->albedo;
    const struct vf3 behind = sky_color(frame, direction, sky);
    fill_cached3(cached, KILN_CACHE_ALBEDO, vf3_select(sky, behind, hit->albedo));
    return behind;
}

/* Returns the radiance of a surface, or the sky where the ray hits nothing. */
SIMD struct ray_color radiance_or_sky(const struct kiln_ray_frame *frame, const struct ray_hit *hit,
                                      struct vf3 direction, const struct hit_light *light,
                                      const struct cached_rays *cached)
{
    struct ray_color color = radiance(frame, hit, direction, light, cached);
    vi sky = hit->surface < 0.0f;
    if (!any(sky))
        return color;
    struct vf3 behind = {{0}, {0}, {0}};
    vf alpha = vf_all(0.0f);
    if (frame->backdrop->counts.z == 0) {
        behind = sky_behind(frame, hit, direction, sky, cached);
        alpha = vf_all(1.0f);
    }
    return (struct ray_color){vf3_select(sky, behind, color.rgb),
                              vf_select(sky, alpha, color.alpha)};
}

#endif
