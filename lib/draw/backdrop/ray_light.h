/* This header computes the light that surfaces send along vectors of rays, and the sky's, as
 * shaders/draw/backdrop/surface.glsl, round.glsl, mesh_trace.glsl and smoke_shadow.glsl do in
 * GL. */
#ifndef KILN_DRAW_BACKDROP_RAY_LIGHT_H
#define KILN_DRAW_BACKDROP_RAY_LIGHT_H

#include "draw/backdrop/ray_picture.h"
#include "draw/backdrop/ray_sun.h"
#include "draw/light/ray_smoke.h"

struct ray_color {
    struct vf3 rgb;
    vf alpha;
};

/* ---- sky on surfaces ------------------------------------------------------------------------- */

/* Returns how much a surface is turned towards an object; a little of an object behind it counts as
 * well. */
SIMD vf turned_to(vf along_normal, vf distance2)
{
    return clamp01(along_normal * vf_rsqrt(vf_max(distance2, vf_all(1e-9f))) + 0.4f);
}

/* Returns the part of the sky that is visible beside an object that hides it. */
SIMD vf shaded_sky(vf visible, vi hides, vf facing, vf fall)
{
    return visible * (1.0f - vf_where(hides, 0.7f * facing * fall));
}

/* Returns the visible sky beside a box; the vectors are in the box's frame. */
SIMD vf box_leaves_sky(float4 half, struct vf3 towards, struct vf3 normal, vi wanted, vf visible)
{
    const vf zero = vf_all(0.0f);
    const struct vf3 turn = {vf_abs(normal.x), vf_abs(normal.y), vf_abs(normal.z)};
    vf along = vf3_dot(towards, normal);
    /* A box that is wholly behind the surface hides nothing. */
    vi hides = wanted & (along > 1e-3f - vf3_dot_all(turn, half));
    if (!any(hides))
        return visible;
    struct vf3 beyond = {vf_max(vf_abs(towards.x) - half.x, zero),
                         vf_max(vf_abs(towards.y) - half.y, zero),
                         vf_max(vf_abs(towards.z) - half.z, zero)};
    float size = fminf(fminf(half.x, half.y), half.z);
    vf fall = size / (size + 2.0f * vf3_length(beyond));
    return shaded_sky(visible, hides, turned_to(along, vf3_dot(towards, towards)), fall * fall);
}

SIMD vf boxes_leave_sky(const struct kiln_ray_frame *frame, const struct ray_point *p, vf visible)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    for (uint32_t i = 0; i < b->counts.x; i++) {
        struct vf3 towards = vf3_towards(b->box_center[i], p->at);
        visible = box_leaves_sky(b->box_half[i], towards, p->normal, p->wanted, visible);
    }
    return visible;
}

/* Returns the visible sky beside a ball. towards: the way to its centre. */
SIMD vf ball_leaves_sky(struct vf3 towards, float radius, const struct ray_point *p, vf visible)
{
    vf distance2 = vf_max(vf3_dot(towards, towards), vf_all(1e-9f));
    vf fall = vf_min(radius * radius / distance2, vf_all(1.0f));
    return shaded_sky(visible, p->wanted, turned_to(vf3_dot(towards, p->normal), distance2), fall);
}

SIMD vf spheres_leave_sky(const struct kiln_ray_frame *frame, const struct ray_point *p, vf visible)
{
    for (uint32_t i = 0; i < frame->shapes->counts.x; i++) {
        const float4 sphere = frame->shapes->spheres[i];
        visible = ball_leaves_sky(vf3_towards(sphere, p->at), sphere.w, p, visible);
    }
    return visible;
}

SIMD vf cylinders_leave_sky(const struct kiln_ray_frame *frame, const struct ray_point *p,
                            vf visible)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    const vf zero = vf_all(0.0f);
    for (uint32_t i = 0; i < shapes->counts.y; i++) {
        const float4 axis = shapes->cylinder_axis[i], cylinder = shapes->cylinders[i];
        float halves = axis.w, radius = cylinder.w, size = fminf(halves, radius);
        struct vf3 towards = vf3_towards(cylinder, p->at);
        vf height = vf3_dot_all(towards, axis);
        struct vf3 aside = vf3_along(towards, vf3_all(axis), -height);
        vf above = vf_max(vf_abs(height) - halves, zero);
        vf beside = vf_max(vf3_length(aside) - radius, zero);
        vf along = vf3_dot(towards, p->normal), climb = vf3_dot_all(p->normal, axis);
        vf slant = vf_sqrt(vf_max(1.0f - climb * climb, zero));
        vi hides = p->wanted & (along > 1e-3f - (halves * vf_abs(climb) + radius * slant));
        vf fall = size / (size + 2.0f * vf_sqrt(above * above + beside * beside));
        visible =
            shaded_sky(visible, hides, turned_to(along, vf3_dot(towards, towards)), fall * fall);
    }
    return visible;
}

/* Returns the visible sky beside capsules: each hides as the nearest of the balls that form it. */
SIMD vf capsules_leave_sky(const struct kiln_ray_frame *frame, const struct ray_point *p,
                           vf visible)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    for (uint32_t i = 0; i < shapes->more.x; i++) {
        const float4 axis = shapes->capsule_axis[i], capsule = shapes->capsules[i];
        struct vf3 towards = vf3_towards(capsule, p->at);
        vf along = vf_clamp(-vf3_dot_all(towards, axis), -axis.w, axis.w);
        towards = vf3_along(towards, vf3_all(axis), along);
        visible = ball_leaves_sky(towards, capsule.w, p, visible);
    }
    return visible;
}

SIMD vf turned_leave_sky(const struct kiln_ray_frame *frame, const struct ray_point *p, vf visible)
{
    for (uint32_t i = 0; i < frame->shapes->more.y; i++) {
        const struct kiln_draw_turned_box *box = &frame->shapes->turned[i];
        struct vf3 towards = into_box(box, vf3_towards(box->center, p->at));
        struct vf3 normal = into_box(box, p->normal);
        visible = box_leaves_sky(box->half_size, towards, normal, p->wanted, visible);
    }
    return visible;
}

/* Returns the visible sky beside meshes: each hides as the ellipsoid in its bounds. In a hollow of
 * a mesh its middle is in front, so hollows get darker. */
SIMD vf meshes_leave_sky(const struct kiln_ray_frame *frame, const struct ray_point *p, vf visible)
{
    for (uint32_t i = 0; i < frame->shapes->counts.z; i++) {
        const struct kiln_draw_mesh *mesh = &frame->shapes->meshes[i];
        const float4 half = mesh->half_size;
        struct vf3 towards = vf3_towards(mesh->center, p->at);
        struct vf3 parts = {towards.x * (1.0f / fmaxf(half.x, 1e-4f)),
                            towards.y * (1.0f / fmaxf(half.y, 1e-4f)),
                            towards.z * (1.0f / fmaxf(half.z, 1e-4f))};
        vf away = vf_max(vf3_length(parts) - 1.0f, vf_all(0.0f));
        vf fall = 1.0f / (1.0f + 2.0f * away);
        vf facing = turned_to(vf3_dot(towards, p->normal), vf3_dot(towards, towards));
        visible = shaded_sky(visible, p->wanted, facing, fall * fall);
    }
    return visible;
}

/* ---- what arrives at a surface --------------------------------------------------------------- */

SIMD void add_light(const struct kiln_draw_light *light, const struct ray_point *p,
                    struct vf3 *irradiance)
{
    struct vf3 towards = vf3_towards(light->position_radius2, p->at);
    vf along = vf3_dot(p->normal, towards);
    vi faces = p->wanted & (along > 0.0f);
    if (!any(faces))
        return;
    vf d2 = vf3_dot(towards, towards);
    vf part =
        along * vf_rsqrt(vf_max(d2, vf_all(1e-9f))) * RAY_PI / (d2 + light->position_radius2.w);
    part = vf_where(faces, part);
    irradiance->x += light->color.x * part;
    irradiance->y += light->color.y * part;
    irradiance->z += light->color.z * part;
}

/* Returns the irradiance from the sky and the point lights. */
SIMD struct vf3 soft_irradiance(const struct kiln_ray_frame *frame, const struct ray_point *p)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    vf sky = boxes_leave_sky(frame, p, vf_all(1.0f));
    sky = spheres_leave_sky(frame, p, sky);
    sky = cylinders_leave_sky(frame, p, sky);
    sky = capsules_leave_sky(frame, p, sky);
    sky = turned_leave_sky(frame, p, sky);
    sky = meshes_leave_sky(frame, p, sky);
    sky *= smoke_lets_through(frame->smoke_to_sky, b->sky_to_grid, p);
    struct vf3 ambient = vf3_mix(b->sky_horizon, b->sky_top, 0.5f + 0.5f * p->normal.y);
    struct vf3 irradiance = vf3_scale(ambient, RAY_PI * sky);
    for (uint32_t i = 0; i < b->counts.y; i++)
        add_light(&b->lights[i], p, &irradiance);
    return irradiance;
}

/* Returns the lanes whose surface is turned to the sun, if there is one. */
SIMD vi turned_to_sun(const struct kiln_ray_frame *frame, const struct ray_point *p)
{
    const float4 color = frame->backdrop->sun_color;
    if (color.x + color.y + color.z <= 0.0f)
        return vi_all(0);
    return p->wanted & (vf3_dot_all(p->normal, frame->backdrop->sun_direction) > 0.0f);
}

/* ---- what goes to the eye -------------------------------------------------------------------- */

SIMD struct vf3 sky_color(const struct kiln_ray_frame *frame, struct vf3 direction, vi wanted)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    const float4 frustum = frame->view->frustum;
    if (frame->sky_image)
        return sky_picture(frame, direction, 2.0f * frustum.y / frustum.w, wanted);
    vf up = clamp01(vf3_normalize(direction).y);
    return vf3_mix(b->sky_horizon, b->sky_top, 1.0f - vf_exp(-4.0f * up));
}

/* Returns the colour that the floor fades into far away. */
SIMD struct vf3 horizon_color(const struct kiln_ray_frame *frame, struct vf3 direction, vi wanted)
{
    if (!frame->sky_image)
        return vf3_all(frame->backdrop->sky_horizon);
    direction.y = vf_all(0.0f);
    return sky_picture(frame, direction, 0.1f, wanted);
}

/* Returns the radiance of a Lambertian surface: albedo / pi * irradiance. sunlight: the part of the
 * sun that arrives. */
SIMD struct ray_color radiance(const struct kiln_ray_frame *frame, const struct ray_hit *hit,
                               struct vf3 direction, struct vf3 irradiance, vf sunlight)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    bool transparent = b->counts.z != 0;
    vi surface = hit->surface >= 0.0f;
    vf sun = vf_max(vf3_dot_all(hit->normal, b->sun_direction), vf_all(0.0f)) * sunlight;
    irradiance = vf3_along(irradiance, vf3_all(b->sun_color), sun);
    struct vf3 color = {hit->albedo.x * (1.0f / RAY_PI) * irradiance.x,
                        hit->albedo.y * (1.0f / RAY_PI) * irradiance.y,
                        hit->albedo.z * (1.0f / RAY_PI) * irradiance.z};
    if (!transparent && b->floor_params.z > 0.0f) {
        vf clear = vf_exp(-b->floor_params.z * hit->t * vf3_length(direction));
        struct vf3 haze = horizon_color(frame, direction, surface);
        color = vf3_along(haze, vf3_sub(color, haze), clear);
    }
    return (struct ray_color){color, vf_all(1.0f)};
}

/* Returns the radiance of a surface, or the sky where the ray hits nothing. */
SIMD struct ray_color radiance_or_sky(const struct kiln_ray_frame *frame, const struct ray_hit *hit,
                                      struct vf3 direction, struct vf3 irradiance, vf sunlight)
{
    struct ray_color color = radiance(frame, hit, direction, irradiance, sunlight);
    vi sky = hit->surface < 0.0f;
    if (!any(sky))
        return color;
    struct vf3 behind = {{0}, {0}, {0}};
    vf alpha = vf_all(0.0f);
    if (frame->backdrop->counts.z == 0) {
        behind = sky_color(frame, direction, sky);
        alpha = vf_all(1.0f);
    }
    return (struct ray_color){vf3_select(sky, behind, color.rgb),
                              vf_select(sky, alpha, color.alpha)};
}

#endif
