/* This header computes the floor along vectors of rays and its reflections, as
 * shaders/draw/backdrop/backdrop.frag and floor_gloss.glsl do in GL. */
#ifndef KILN_DRAW_BACKDROP_RAY_FLOOR_H
#define KILN_DRAW_BACKDROP_RAY_FLOOR_H

#include "draw/backdrop/ray_light.h"

/* The integral of a square wave of period 2. */
SIMD vf square_integral(vf x)
{
    vf half = x * 0.5f;
    return 1.0f - vf_abs((half - vf_floor(half)) * 2.0f - 1.0f);
}

/* Returns the extent of floor that one pixel covers, in x and z: longer along the view where the
 * floor is seen at a flat angle. */
SIMD void floor_footprint(const struct kiln_ray_frame *frame, struct vf3 direction, vf t, vf *x,
                          vf *z)
{
    const float4 frustum = frame->view->frustum;
    vf pixel = 2.0f * frustum.y / frustum.w * t;
    vf flat2 = direction.x * direction.x + direction.z * direction.z;
    vf length2 = flat2 + direction.y * direction.y;
    vf inverse = vf_rsqrt(vf_max(flat2, vf_all(1e-12f)));
    vf stretch = length2 * vf_rsqrt(length2) / vf_max(vf_abs(direction.y), vf_all(1e-6f)) * inverse;
    *x = pixel * (1.0f + vf_abs(direction.x) * stretch);
    *z = pixel * (1.0f + vf_abs(direction.z) * stretch);
}

/* Squares of two shades, averaged over the footprint of a pixel, so that they do not alias. */
SIMD struct vf3 checkers(const struct kiln_ray_frame *frame, struct vf3 direction, vf t, vf x, vf z)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    float inverse_edge = 1.0f / b->floor_params.y;
    vf width_x, width_z, least = vf_all(1e-3f);
    floor_footprint(frame, direction, t, &width_x, &width_z);
    width_x = vf_max(width_x * inverse_edge, least);
    width_z = vf_max(width_z * inverse_edge, least);
    x *= inverse_edge;
    z *= inverse_edge;
    vf wave_x = square_integral(x + 0.5f * width_x) - square_integral(x - 0.5f * width_x);
    vf wave_z = square_integral(z + 0.5f * width_z) - square_integral(z - 0.5f * width_z);
    vf shade = 1.0f + 0.2f * (wave_x * wave_z) / (width_x * width_z);
    return vf3_scale(vf3_all(b->floor_color), shade);
}

/* Returns the t at which rays hit the floor; a t beyond RAY_FAR where they do not. */
SIMD vf find_floor(const struct kiln_ray_frame *frame, const struct ray *ray)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    vf nowhere = vf_all(2.0f * RAY_FAR);
    if (b->floor_params.x <= 0.0f)
        return nowhere;
    vf height = ray->origin.y - b->floor_color.w;
    vi falls = (ray->direction.y < -1e-6f) & (height > 0.0f);
    return vf_select(falls, height / -ray->direction.y, nowhere);
}

/* Returns the albedo of the floor where rays hit it. */
SIMD struct vf3 floor_albedo(const struct kiln_ray_frame *frame, const struct ray *ray, vf t,
                             vi wanted)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    vf x = ray->origin.x + ray->direction.x * t, z = ray->origin.z + ray->direction.z * t;
    if (frame->floor_image) {
        const struct ray_patch patch = find_patch(frame, ray->direction, t, x, z);
        return floor_picture(frame, &patch, wanted);
    }
    if (b->floor_params.y > 0.0f)
        return checkers(frame, ray->direction, t, x, z);
    return vf3_all(b->floor_color);
}

/* ---- gloss ----------------------------------------------------------------------------------- */

/* Holds the slope of the water, and the square of the slopes that are averaged within a pixel. */
struct ray_slope {
    vf x, z, averaged;
};

SIMD struct ray_slope wave_slope(const struct kiln_ray_frame *frame, vf x, vf z, vf wide_x,
                                 vf wide_z)
{
    float steepness = frame->shapes->floor_gloss.w;
    struct ray_slope slope = {{0}, {0}, {0}};
    if (steepness <= 0.0f)
        return slope;
    for (int i = 0; i < KILN_WAVES; i++) {
        const struct kiln_wave *w = &frame->waves[i];
        vf phase = w->number * (w->way_x * x + w->way_z * z) - w->phase;
        vf across = w->number * (fabsf(w->way_x) * wide_x + fabsf(w->way_z) * wide_z);
        vf seen = vf_exp(-0.2f * across * across);
        struct vf_angle angle = vf_sincos(phase);
        vf tilt = steepness * seen * angle.cosine;
        slope.x += w->way_x * tilt;
        slope.z += w->way_z * tilt;
        slope.averaged += 0.5f * steepness * steepness * (1.0f - seen * seen);
        /* Each wave is shifted by the longer ones before it, so that crests are short. */
        x += (w->way_x * w->bend) * angle.sine;
        z += (w->way_z * w->bend) * angle.sine;
    }
    return slope;
}

SIMD vf fresnel(vf cosine)
{
    vf away = 1.0f - clamp01(cosine);
    vf away2 = away * away;
    return 0.02f + 0.98f * away2 * away2 * away;
}

/* Returns the part of the irradiance along `to_light` that is reflected to the eye, per solid
 * angle. */
SIMD vf lobe(struct vf3 normal, struct vf3 to_eye, struct vf3 to_light, vf spread)
{
    struct vf3 half_way = vf3_normalize(vf3_add(to_eye, to_light));
    vf a2 = spread * spread;
    vf nh = clamp01(vf3_dot(normal, half_way));
    vf nv = vf_clamp(vf3_dot(normal, to_eye), 1e-3f, 1.0f);
    vf nl = clamp01(vf3_dot(normal, to_light));
    vf d = nh * nh * (a2 - 1.0f) + 1.0f;
    vf distribution = a2 / (RAY_PI * d * d);
    vf shadowing =
        nl * vf_sqrt(nv * nv * (1.0f - a2) + a2) + nv * vf_sqrt(nl * nl * (1.0f - a2) + a2);
    return fresnel(vf3_dot(to_eye, half_way)) * distribution * 0.5f * nl /
           vf_max(shadowing, vf_all(1e-6f));
}

/* Holds how the floor reflects a ray. */
struct ray_mirror {
    struct vf3 lights;  /* that it sends to the eye */
    struct vf3 sun;     /* the same, where no shadow is */
    struct vf3 onwards; /* where the ray goes, */
    vf weight;          /* and how much of what it finds there is seen */
};

SIMD struct vf3 mirrored_lights(const struct kiln_ray_frame *frame, struct vf3 point,
                                struct vf3 normal, struct vf3 to_eye, vf spread)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    struct vf3 sum = {{0}, {0}, {0}};
    for (uint32_t i = 0; i < b->counts.y; i++) {
        const struct kiln_draw_light *light = &b->lights[i];
        float radius2 = light->position_radius2.w;
        struct vf3 towards = vf3_towards(light->position_radius2, point);
        vf d2 = vf_max(vf3_dot(towards, towards), vf_all(1e-6f));
        vf wide = vf_min(spread + 0.25f * vf_sqrt(radius2 / d2), vf_all(1.0f));
        vf part =
            RAY_PI / (d2 + radius2) * lobe(normal, to_eye, vf3_scale(towards, vf_rsqrt(d2)), wide);
        sum = vf3_along(sum, vf3_all(light->color), part);
    }
    return sum;
}

/* Computes the reflection of the floor along rays from the eye. */
SIMD struct ray_mirror floor_mirror(const struct kiln_ray_frame *frame, const struct ray *ray)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    const float4 gloss = frame->shapes->floor_gloss;
    struct vf3 direction = ray->direction;
    vf t = vf_max(ray->origin.y - b->floor_color.w, vf_all(0.0f)) /
           vf_max(-direction.y, vf_all(1e-6f));
    struct vf3 point = ray_at(ray, t);
    vf wide_x, wide_z;
    floor_footprint(frame, direction, t, &wide_x, &wide_z);
    struct ray_slope slope = wave_slope(frame, point.x, point.z, wide_x, wide_z);
    struct vf3 normal = vf3_normalize((struct vf3){-slope.x, vf_all(1.0f), -slope.z});
    vf length = vf3_length(direction);
    struct vf3 way = vf3_scale(direction, 1.0f / length), back = vf3_scale(way, vf_all(-1.0f));
    vf spread = vf_clamp(vf_sqrt(gloss.y * gloss.y + 2.0f * slope.averaged), 0.02f, 1.0f);
    struct vf3 onwards = vf3_along(way, normal, -2.0f * vf3_dot(way, normal));
    onwards.y = vf_max(onwards.y, vf_all(0.01f)); /* what goes down would meet a wave again */

    vf part = vf_all(gloss.x);
    if (b->counts.z == 0)
        part *= vf_exp(-b->floor_params.z * t * length);
    const struct vf3 sun = vf3_all(b->sun_direction);
    return (struct ray_mirror){
        .lights = vf3_scale(mirrored_lights(frame, point, normal, back, spread), part),
        .sun = vf3_scale(vf3_all(b->sun_color), part * lobe(normal, back, sun, spread)),
        .onwards = onwards,
        .weight = part * fresnel(vf3_dot(normal, back)),
    };
}

#endif
