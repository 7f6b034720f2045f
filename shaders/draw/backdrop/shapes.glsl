/* Finds the nearest shape of the backdrop that a ray hits, and how much of the sky and of a light
 * shapes leave visible from a point. shared/shapes.h lists the kinds of shapes, each of which has a
 * loop here, since software GL runs both sides of a branch: in one loop, each shape would cost as
 * much as one of every kind. */
#include "shared/shapes.h"

#ifdef SHAPES_STORED
layout(std430, binding = KILN_BIND_STORED_SHAPES) readonly buffer stored_block
{
    kiln_draw_shape stored_shapes[];
};
#define SHAPE stored_shapes
/* Whether a shape may hide lamp `light`; light -1: the sun, which each may hide. */
#define MAY_HIDE(light, i)                                                                         \
    (light < 0 || (backdrop.lights[light].hiders[i >> 7][i >> 5 & 3] >> (i & 31) & 1u) != 0u)
#else
#define SHAPE              shapes.shapes
#define MAY_HIDE(light, i) ((casters >> i & 1u) != 0u)
#endif

/* Replaces `nearest` by the ray's nearest hit on a shape if that is nearer. */
void trace_shapes(vec3 origin, vec3 direction, inout hit nearest)
{
    int found;
    shape_ray ray = shape_ray_of(origin, direction);
#define TRACE(KIND, name)                                                                          \
    found = -1;                                                                                    \
    for (int i = KILN_SHAPES_FROM(SHAPE_##KIND); i < KILN_SHAPES_FROM(SHAPE_##KIND + 1u); i++) {   \
        ray_interval at = name##_cross(SHAPE[i], ray);                               \
        if (ray_meets(at, nearest.t)) {                                                            \
            nearest.t = at.near;                                                                   \
            found = i;                                                                             \
        }                                                                                          \
    }                                                                                              \
    if (found >= 0) {                                                                              \
        shape_face face = name##_face(SHAPE[found], ray, nearest.t);                 \
        nearest.normal = face.normal;                                                              \
        nearest.albedo = SHAPE[found].color.rgb;                                                   \
        nearest.surface = KILN_SURFACE_SHAPE(found) + int(face.number);                            \
    }
    KILN_SHAPES(TRACE)
}

/* Returns the part of the sky, 0 to 1, that shapes leave visible from a surface's point. */
float shapes_sky_visibility(vec3 point, vec3 normal)
{
    float visible = 1.0;
#define SKY(KIND, name)                                                                            \
    for (int i = KILN_SHAPES_FROM(SHAPE_##KIND); i < KILN_SHAPES_FROM(SHAPE_##KIND + 1u); i++)     \
        visible *= name##_sky(SHAPE[i], SHAPE[i].center.xyz - point, normal);
    KILN_SHAPES(SKY)
    return visible;
}

/* Returns the part of a light, 0 to 1, that shapes leave visible. light: the number of a lamp; -1:
 * the sun. */
float shapes_light_visibility(int light, vec3 origin, light_way way)
{
    float visible = 1.0;
#ifndef SHAPES_STORED
    uint casters = light < 0 ? ~0u : backdrop.lights[max(light, 0)].hiders[0].x;
#endif
#define HIDE(KIND, name)                                                                           \
    for (int i = KILN_SHAPES_FROM(SHAPE_##KIND); i < KILN_SHAPES_FROM(SHAPE_##KIND + 1u); i++) {   \
        vec3 towards = SHAPE[i].center.xyz - origin;                                               \
        bool near = MAY_HIDE(light, i) &&                                                          \
                    light_meets_sphere(way, towards, SHAPE[i].center.w);                           \
        name##_seen seen = name##_seen_along(SHAPE[i], way.direction);                             \
        near = near && name##_may_hide(SHAPE[i], seen, towards, way);                              \
        if (near)                                                                                  \
            visible *= 1.0 - light_hidden(way, name##_cover(SHAPE[i], seen, towards, way, near));  \
    }
    KILN_SHAPES(HIDE)
    return visible;
}
