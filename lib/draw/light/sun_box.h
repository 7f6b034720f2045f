/* This header computes how much of the sun a box hides from a ball. It has no branches, so that
 * compilers vectorise loops over balls. */
#ifndef KILN_DRAW_LIGHT_SUN_BOX_H
#define KILN_DRAW_LIGHT_SUN_BOX_H

#include "draw/light/sun_cover.h"

/* Returns the part of a disc on the far side of a line, by the line's signed distance in radii. */
static inline float kiln_disc_cover(float distance)
{
    float x = exact_clamp(0.5f + 0.5f * distance, 0.0f, 1.0f);
    return x * x * (3.0f - 2.0f * x);
}

/* Returns the factor of cover for the way through a shape to the sun's free side. */
static inline float kiln_sun_behind(float way, struct kiln_ball ball)
{
    return exact_clamp(way / exact_max(ball.radius, 1e-4f), 0.0f, 1.0f);
}

/* Holds values that follow from a box and the sun's direction. The box's outline is the common part
 * of three strips (sun_cover.glsl), each between edges along one axis. */
struct kiln_sun_box {
    float3 center;
    float size;
    float3 inverse, half; /* of the way along the ray through its slabs */
    float3 scale;         /* from ways to distances across the strips */
    float3 first, second; /* by which ways mix at a strip's edges */
    float xy, others;     /* how much the strips' edges look like one: 1 where parallel */
    float3 slope;
};

/* Returns how much edges of two directions look like one: 1 where they are parallel. */
static inline float kiln_sun_likeness(float a, float b)
{
    float cosine = a * b / sqrtf(exact_max((1.0f - a * a) * (1.0f - b * b), 1e-12f));
    float square = exact_min(cosine * cosine, 1.0f);
    return square * square * square * square;
}

static inline struct kiln_sun_box kiln_sun_box_at(float3 center, float3 half_size,
                                                  const struct kiln_sun_frame *sun)
{
    const float3 d = sun->towards;
    const float ways[3] = {d.x, d.y, d.z}, halves[3] = {half_size.x, half_size.y, half_size.z};
    float inverse[3], half[3], scale[3], first[3], second[3], slope[3];
    for (int i = 0; i < 3; i++) {
        inverse[i] = (ways[i] < 0.0f ? -1.0f : 1.0f) / exact_max(fabsf(ways[i]), 1e-8f);
        half[i] = halves[i] * fabsf(inverse[i]);
        float climb = 1.0f / inverse[i];
        slope[i] = sqrtf(exact_max(1.0f - climb * climb, 0.0f)) * fabsf(inverse[i]);
    }
    for (int i = 0; i < 3; i++) {
        int a = (i + 1) % 3, b = (i + 2) % 3; /* its edges lie along axis i */
        float qa = inverse[a] * inverse[a], qb = inverse[b] * inverse[b];
        scale[i] = 1.0f / sqrtf(qa + qb);
        first[i] = qa / (qa + qb);
        second[i] = qb / (qa + qb);
    }
    return (struct kiln_sun_box){
        .center = center,
        .size = sqrtf(float3_dot(half_size, half_size)),
        .inverse = {inverse[0], inverse[1], inverse[2]},
        .half = {half[0], half[1], half[2]},
        .scale = {scale[0], scale[1], scale[2]},
        .first = {first[0], first[1], first[2]},
        .second = {second[0], second[1], second[2]},
        .xy = kiln_sun_likeness(d.x, d.y),
        .others = exact_max(kiln_sun_likeness(d.y, d.z), kiln_sun_likeness(d.x, d.z)),
        .slope = {slope[0], slope[1], slope[2]},
    };
}

struct kiln_sun_strip {
    float cover;
    float outside; /* m */
};

/* Computes a strip. in, out: the ways through the slabs of the two other axes. */
static inline struct kiln_sun_strip kiln_sun_strip_at(float in_a, float out_a, float in_b,
                                                      float out_b, float scale, float first,
                                                      float second, struct kiln_ball ball,
                                                      const struct kiln_sun_frame *sun)
{
    float one = (out_b - in_a) * scale, other = (out_a - in_b) * scale;
    float one_at = in_a * second + out_b * first, other_at = in_b * first + out_a * second;
    float cover = kiln_disc_cover(one / kiln_sun_penumbra(one_at, ball, sun)) +
                  kiln_disc_cover(other / kiln_sun_penumbra(other_at, ball, sun)) - 1.0f;
    return (struct kiln_sun_strip){exact_max(cover, 0.0f), -exact_min(one, other)};
}

/* Combines the covers of two strips. At a corner of the outline they are multiplied; but if the sun
 * is perpendicular to an axis, two of the strips end at the same edge. */
static inline float kiln_sun_both(float a, float b, float alike)
{
    return a * b + (exact_min(a, b) - a * b) * alike;
}

/* Returns the cover of a box. Beside the outline, the way behind the box is taken at its edge. */
static inline float kiln_sun_box_cover(const struct kiln_sun_box *box, struct kiln_ball ball,
                                       const struct kiln_sun_frame *sun)
{
    bool misses = kiln_sun_misses(box->center, box->size, ball, sun);
    float3 to = float3_sub(box->center, ball.center);
    float x = to.x * box->inverse.x, y = to.y * box->inverse.y, z = to.z * box->inverse.z;
    float3 in = {x - box->half.x, y - box->half.y, z - box->half.z};
    float3 out = {x + box->half.x, y + box->half.y, z + box->half.z};
    struct kiln_sun_strip of_x = kiln_sun_strip_at(in.y, out.y, in.z, out.z, box->scale.x,
                                                   box->first.x, box->second.x, ball, sun);
    struct kiln_sun_strip of_y = kiln_sun_strip_at(in.z, out.z, in.x, out.x, box->scale.y,
                                                   box->first.y, box->second.y, ball, sun);
    struct kiln_sun_strip of_z = kiln_sun_strip_at(in.x, out.x, in.y, out.y, box->scale.z,
                                                   box->first.z, box->second.z, ball, sun);
    float cover = kiln_sun_both(of_x.cover, of_y.cover, box->xy);
    cover = kiln_sun_both(cover, of_z.cover, box->others);
    float outside = exact_max(exact_max(of_x.outside, of_y.outside), exact_max(of_z.outside, 0.0f));
    float step = outside + 1e-3f * box->size;
    float way = exact_min(out.x + step * box->slope.x, out.y + step * box->slope.y);
    way = exact_min(way, out.z + step * box->slope.z);
    float seen = cover * kiln_sun_behind(way, ball);
    return misses ? 0.0f : seen;
}

#endif
