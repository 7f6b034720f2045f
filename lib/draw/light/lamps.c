/* This file evaluates the lamps of a scene. It finds which objects may hide each light, a bit for
 * each (struct kiln_draw_light), and dims lights by planes, which hide the same part of a light
 * from all places above them. */
#include "draw/light/lamps.h"

#include <math.h>

#include "shared/exact.h"
#include "shared/lamp_cover.h"

static float3 xyz(float4 v)
{
    return (float3){v.x, v.y, v.z};
}

static float3 way_from(float4 center, float3 point)
{
    return float3_sub(point, xyz(center));
}

static bool box_contains(float4 half, float3 from)
{
    return fabsf(from.x) < half.x && fabsf(from.y) < half.y && fabsf(from.z) < half.z;
}

static bool cylinder_contains(float4 cylinder, float4 axis, float3 from)
{
    const float height = float3_dot(from, xyz(axis));
    const float3 aside = float3_add_scaled(from, xyz(axis), -height);
    return fabsf(height) < axis.w && float3_dot(aside, aside) < cylinder.w * cylinder.w;
}

static bool capsule_contains(float4 capsule, float4 axis, float3 from)
{
    const float height = exact_clamp(float3_dot(from, xyz(axis)), -axis.w, axis.w);
    const float3 aside = float3_add_scaled(from, xyz(axis), -height);
    return float3_dot(aside, aside) < capsule.w * capsule.w;
}

static bool oriented_box_contains(const struct kiln_draw_oriented_box *box, float3 from)
{
    const float3 there = {float3_dot(from, xyz(box->rows[0])), float3_dot(from, xyz(box->rows[1])),
                          float3_dot(from, xyz(box->rows[2]))};
    return box_contains(box->half_size, there);
}

/* Holds the boxes along the axes. */
struct boxes {
    uint32_t count;
    float4 center[KILN_MAX_OBJECTS], half[KILN_MAX_OBJECTS];
};

/* Returns the bits of the objects that do not contain a point, in the order of the bits. */
static uint32_t find_casters(const struct kiln_draw_shapes *shapes, const struct boxes *boxes,
                             float3 at)
{
    uint32_t casters = 0, bit = 0;
    for (uint32_t i = 0; i < boxes->count; i++) {
        const bool inside = box_contains(boxes->half[i], way_from(boxes->center[i], at));
        casters |= inside ? 0 : 1u << bit;
        bit++;
    }
    for (uint32_t i = 0; i < shapes->counts.x; i++) {
        const float3 from = way_from(shapes->spheres[i], at);
        const bool inside = float3_dot(from, from) < shapes->spheres[i].w * shapes->spheres[i].w;
        casters |= inside ? 0 : 1u << bit;
        bit++;
    }
    for (uint32_t i = 0; i < shapes->counts.y; i++) {
        const bool inside = cylinder_contains(shapes->cylinders[i], shapes->cylinder_axis[i],
                                              way_from(shapes->cylinders[i], at));
        casters |= inside ? 0 : 1u << bit;
        bit++;
    }
    for (uint32_t i = 0; i < shapes->oriented_counts.x; i++) {
        const bool inside = capsule_contains(shapes->capsules[i], shapes->capsule_axis[i],
                                             way_from(shapes->capsules[i], at));
        casters |= inside ? 0 : 1u << bit;
        bit++;
    }
    for (uint32_t i = 0; i < shapes->oriented_counts.y; i++) {
        const struct kiln_draw_oriented_box *box = &shapes->oriented_boxes[i];
        casters |= oriented_box_contains(box, way_from(box->center, at)) ? 0 : 1u << bit;
        bit++;
    }
    return casters;
}

/* Returns the part of a light that planes and the floor leave. */
static float part_above_planes(const struct kiln_moment *moment, float3 at, float radius)
{
    const struct kiln_backdrop *backdrop = &moment->scene->backdrop;
    const struct kiln_draw_shapes *shapes = &moment->shapes;
    float part = 1.0f;
    if (backdrop->floor_enabled) {
        const float floor =
            kiln_scene_value(moment->scene, &backdrop->floor_height, moment->view.clock.x);
        part *= 1.0f - lamp_plane_cover(at.y - floor, radius);
    }
    for (uint32_t i = 0; i < shapes->oriented_counts.z; i++) {
        const float4 plane = shapes->planes[i];
        part *= 1.0f - lamp_plane_cover(float3_dot(at, xyz(plane)) - plane.w, radius);
    }
    return part;
}

uint32_t kiln_lamps_fill(const struct kiln_moment *moment, struct kiln_draw_light *lights)
{
    const struct kiln_scene *scene = moment->scene;
    const float time_s = moment->view.clock.x;
    for (uint32_t i = 0; i < scene->backdrop.light_count; i++) {
        const struct kiln_light *light = &scene->backdrop.lights[i];
        const float radius = kiln_scene_value(scene, &light->radius, time_s);
        const float3 at = kiln_scene_value3(scene, &light->position, time_s);
        const float3 color = kiln_scene_value3(scene, &light->color, time_s);
        lights[i] = (struct kiln_draw_light){
            .position_radius2 = {at.x, at.y, at.z, radius * radius},
            .color = {color.x, color.y, color.z, radius},
            .casters = {light->shadow ? 1 : 0, 0, 0, light->shadow ? 1 : 0},
        };
    }
    return scene->backdrop.light_count;
}

void kiln_lamps_find_casters(const struct kiln_moment *moment, struct kiln_draw_light *lights,
                             uint32_t count)
{
    struct boxes boxes;
    boxes.count =
        kiln_boxes_fill(moment->scene, moment->view.clock.x, boxes.center, boxes.half, NULL);
    for (uint32_t i = 0; i < count; i++) {
        struct kiln_draw_light *light = &lights[i];
        if (!light->casters.x)
            continue;
        const float3 at = xyz(light->position_radius2);
        const float part = part_above_planes(moment, at, light->color.w);
        light->casters.x = find_casters(&moment->shapes, &boxes, at);
        light->color.x *= part;
        light->color.y *= part;
        light->color.z *= part;
    }
}
