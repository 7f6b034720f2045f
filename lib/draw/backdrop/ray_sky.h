/* This header computes the part of the sky that surfaces see past the backdrop's objects. */
#ifndef KILN_DRAW_BACKDROP_RAY_SKY_H
#define KILN_DRAW_BACKDROP_RAY_SKY_H

#include "draw/backdrop/ray_oriented.h"
#include "draw/light/ray_lamp.h"
#include "draw/light/ray_smoke.h"
#include "shared/surface_light.h"

/* Returns the visible part of the sky times `beside`, the part that an object leaves, in the lanes
 * where the object hides some sky. */
SIMD vf occlude_sky(vf visible, vi hides, vf beside)
{
    return visible * vf_select(hides, beside, vf_all(1.0f));
}

/* Returns the part of the sky that stays visible beside a box; the vectors are in the box's
 * frame. */
SIMD vf box_sky_visibility(float4 half, struct vf3 towards, struct vf3 normal, vi active,
                           vf visible)
{
    vi hides = active & sky_meets_box(half, towards, normal);
    if (!any(hides))
        return visible;
    return occlude_sky(visible, hides, sky_beside_box(half, towards, normal));
}

SIMD vf boxes_sky_visibility(const struct kiln_ray_frame *frame, const struct ray_point *p,
                             vf visible)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    for (uint32_t i = 0; i < b->counts.x; i++) {
        struct vf3 towards = vf3_towards(b->box_center[i], p->at);
        visible = box_sky_visibility(b->box_half[i], towards, p->normal, p->active, visible);
    }
    return visible;
}

SIMD vf round_sky_visibility(const struct kiln_ray_frame *frame, const struct ray_point *p,
                             vf visible)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    for (uint32_t i = 0; i < shapes->counts.x; i++) {
        const float4 sphere = shapes->spheres[i];
        vf beside = sky_beside_ball(vf3_towards(sphere, p->at), sphere.w, p->normal);
        visible = occlude_sky(visible, p->active, beside);
    }
    for (uint32_t i = 0; i < shapes->counts.y; i++) {
        const float4 axis = shapes->cylinder_axis[i], cylinder = shapes->cylinders[i];
        const struct vf3 towards = vf3_towards(cylinder, p->at);
        vi hides = p->active & sky_meets_cylinder(towards, cylinder.w, axis, p->normal);
        visible =
            occlude_sky(visible, hides, sky_beside_cylinder(towards, cylinder.w, axis, p->normal));
    }
    return visible;
}

SIMD vf oriented_sky_visibility(const struct kiln_ray_frame *frame, const struct ray_point *p,
                                vf visible)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    for (uint32_t i = 0; i < shapes->oriented_counts.x; i++) {
        const float4 axis = shapes->capsule_axis[i], capsule = shapes->capsules[i];
        vf beside = sky_beside_capsule(vf3_towards(capsule, p->at), capsule.w, axis, p->normal);
        visible = occlude_sky(visible, p->active, beside);
    }
    for (uint32_t i = 0; i < shapes->oriented_counts.y; i++) {
        const struct kiln_draw_oriented_box *box = &shapes->oriented_boxes[i];
        struct vf3 towards = into_box(box, vf3_towards(box->center, p->at));
        struct vf3 normal = into_box(box, p->normal);
        visible = box_sky_visibility(box->half_size, towards, normal, p->active, visible);
    }
    return visible;
}

SIMD vf meshes_sky_visibility(const struct kiln_ray_frame *frame, const struct ray_point *p,
                              vf visible)
{
    for (uint32_t i = 0; i < frame->shapes->counts.z; i++) {
        const struct kiln_draw_mesh *mesh = &frame->shapes->meshes[i];
        vf beside = sky_beside_mesh(vf3_towards(mesh->center, p->at), mesh->half_size, p->normal);
        visible = occlude_sky(visible, p->active, beside);
    }
    return visible;
}

/* Returns the part of the sky that is seen past objects. */
SIMD vf sky_past_objects(const struct kiln_ray_frame *frame, const struct ray_point *p)
{
    vf sky = boxes_sky_visibility(frame, p, vf_all(1.0f));
    sky = round_sky_visibility(frame, p, sky);
    sky = oriented_sky_visibility(frame, p, sky);
    return meshes_sky_visibility(frame, p, sky);
}

#endif
