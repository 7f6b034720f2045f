/* This file evaluates the lamps of a scene. It finds which objects may hide each light, a bit for
 * each (struct kiln_draw_light), and dims lights by planes, which hide the same part of a light
 * from all places above them. Of a rectangle, which is a part of a plane, objects hide nothing that
 * are wholly behind that plane, such as the wall that it hangs on. */
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

/* How far an object that counts as behind a rectangle may reach past its plane, m. */
static const float RECTANGLE_SLACK = 1e-3f;

/* Returns whether an object is wholly behind a rectangle. reach: how far the object extends from
 * its centre in the direction of the rectangle's front, m. */
static bool is_behind(const struct kiln_draw_light *light, float4 center, float reach)
{
    if (light->facing.w != KILN_LAMP_RECTANGLE)
        return false;
    const float3 from = way_from(light->position_radius2, xyz(center));
    return float3_dot(from, xyz(light->facing)) + reach < RECTANGLE_SLACK;
}

static float reach_of_box(float4 half, float3 way)
{
    return fabsf(way.x) * half.x + fabsf(way.y) * half.y + fabsf(way.z) * half.z;
}

static float reach_of_cylinder(float radius, float4 axis, float3 way)
{
    const float climb = float3_dot(way, xyz(axis));
    return fabsf(climb) * axis.w + radius * sqrtf(exact_max(1.0f - climb * climb, 0.0f));
}

static float reach_of_oriented_box(const struct kiln_draw_oriented_box *box, float3 way)
{
    const float3 there = {float3_dot(way, xyz(box->rows[0])), float3_dot(way, xyz(box->rows[1])),
                          float3_dot(way, xyz(box->rows[2]))};
    return reach_of_box(box->half_size, there);
}

/* Returns the bits of the boxes, spheres and cylinders that may hide a light, in the order of the
 * bits, and sets *bit to the next bit. */
static uint32_t find_plain_casters(const struct kiln_draw_shapes *shapes, const struct boxes *boxes,
                                   const struct kiln_draw_light *light, uint32_t *bit)
{
    const float3 at = xyz(light->position_radius2), way = xyz(light->facing);
    uint32_t casters = 0;
    for (uint32_t i = 0; i < boxes->count; i++, ++*bit) {
        const bool inside = box_contains(boxes->half[i], way_from(boxes->center[i], at)) ||
                            is_behind(light, boxes->center[i], reach_of_box(boxes->half[i], way));
        casters |= inside ? 0 : 1u << *bit;
    }
    for (uint32_t i = 0; i < shapes->counts.x; i++, ++*bit) {
        const float4 sphere = shapes->spheres[i];
        const float3 from = way_from(sphere, at);
        const bool inside =
            float3_dot(from, from) < sphere.w * sphere.w || is_behind(light, sphere, sphere.w);
        casters |= inside ? 0 : 1u << *bit;
    }
    for (uint32_t i = 0; i < shapes->counts.y; i++, ++*bit) {
        const float4 cylinder = shapes->cylinders[i], axis = shapes->cylinder_axis[i];
        const bool inside = cylinder_contains(cylinder, axis, way_from(cylinder, at)) ||
                            is_behind(light, cylinder, reach_of_cylinder(cylinder.w, axis, way));
        casters |= inside ? 0 : 1u << *bit;
    }
    return casters;
}

/* Returns the bits of the objects that may hide a light. */
static uint32_t find_casters(const struct kiln_draw_shapes *shapes, const struct boxes *boxes,
                             const struct kiln_draw_light *light)
{
    const float3 at = xyz(light->position_radius2), way = xyz(light->facing);
    uint32_t bit = 0, casters = find_plain_casters(shapes, boxes, light, &bit);
    for (uint32_t i = 0; i < shapes->oriented_counts.x; i++, bit++) {
        const float4 capsule = shapes->capsules[i], axis = shapes->capsule_axis[i];
        const float reach = capsule.w + axis.w * fabsf(float3_dot(way, xyz(axis)));
        const bool inside = capsule_contains(capsule, axis, way_from(capsule, at)) ||
                            is_behind(light, capsule, reach);
        casters |= inside ? 0 : 1u << bit;
    }
    for (uint32_t i = 0; i < shapes->oriented_counts.y; i++, bit++) {
        const struct kiln_draw_oriented_box *box = &shapes->oriented_boxes[i];
        const bool inside = oriented_box_contains(box, way_from(box->center, at)) ||
                            is_behind(light, box->center, reach_of_oriented_box(box, way));
        casters |= inside ? 0 : 1u << bit;
    }
    return casters;
}

/* Returns the part of a light that a plane hides. height: of the light's centre above it, m. A
 * rectangle sinks into the plane evenly, as it does where one of its edges is along the plane. */
static float cover_of_plane(const struct kiln_draw_light *light, float3 normal, float height)
{
    if (light->facing.w != KILN_LAMP_RECTANGLE)
        return lamp_plane_cover(height, light->color.w);
    const float reach = fabsf(float3_dot(xyz(light->right), normal)) +
                        fabsf(float3_dot(xyz(light->up), normal)) + RECTANGLE_SLACK;
    return exact_clamp(0.5f - 0.5f * (height + RECTANGLE_SLACK) / reach, 0.0f, 1.0f);
}

/* Returns the part of a light that planes and the floor leave. */
static float part_above_planes(const struct kiln_moment *moment,
                               const struct kiln_draw_light *light)
{
    const struct kiln_backdrop *backdrop = &moment->scene->backdrop;
    const struct kiln_draw_shapes *shapes = &moment->shapes;
    const float3 at = xyz(light->position_radius2);
    float part = 1.0f;
    if (backdrop->floor_enabled) {
        const float floor =
            kiln_scene_value(moment->scene, &backdrop->floor_height, moment->view.clock.x);
        part *= 1.0f - cover_of_plane(light, (float3){0.0f, 1.0f, 0.0f}, at.y - floor);
    }
    for (uint32_t i = 0; i < shapes->oriented_counts.z; i++) {
        const float4 plane = shapes->planes[i];
        const float height = float3_dot(at, xyz(plane)) - plane.w;
        part *= 1.0f - cover_of_plane(light, xyz(plane), height);
    }
    return part;
}

static float4 with_w(float3 v, float w)
{
    return (float4){v.x, v.y, v.z, w};
}

static float3 direction_of(const struct kiln_scene *scene, const struct kiln_light *light,
                           float time_s)
{
    return float3_normalize(kiln_scene_value3(scene, &light->direction, time_s),
                            (float3){0.0f, -1.0f, 0.0f});
}

/* Makes a spot of a point light. */
static void add_cone(const struct kiln_scene *scene, const struct kiln_light *light, float time_s,
                     struct kiln_draw_light *drawn)
{
    const float angle = kiln_scene_value(scene, &light->angle, time_s);
    const float softness = kiln_scene_value(scene, &light->softness, time_s);
    const float outer = exact_sincos(angle).cosine;
    const float inner = exact_sincos(angle * (1.0f - softness)).cosine;
    drawn->facing = with_w(direction_of(scene, light, time_s), KILN_LAMP_SPOT);
    drawn->right.w = outer;
    drawn->up.w = 1.0f / exact_max(inner - outer, 1e-6f);
}

/* Makes a rectangle of a point light. */
static void add_edges(const struct kiln_scene *scene, const struct kiln_light *light, float time_s,
                      struct kiln_draw_light *drawn)
{
    static const float PI = 3.14159265f;
    const float width = kiln_scene_value(scene, &light->width, time_s);
    const float height = kiln_scene_value(scene, &light->height, time_s);
    const float3 facing = direction_of(scene, light, time_s);
    const float3 none = {0.0f, 0.0f, 0.0f}, y = {0.0f, 1.0f, 0.0f}, minus_z = {0.0f, 0.0f, -1.0f};
    const float3 wanted = float3_normalize(kiln_scene_value3(scene, &light->up, time_s), none);
    float3 right = float3_cross(facing, wanted);
    if (float3_dot(right, right) < 1e-6f)
        right = float3_cross(facing, fabsf(facing.z) < 0.9f ? minus_z : y);
    right = float3_normalize(right, (float3){1.0f, 0.0f, 0.0f});
    const float radius2 = width * height / PI;
    drawn->position_radius2.w = radius2;
    drawn->color.x *= radius2;
    drawn->color.y *= radius2;
    drawn->color.z *= radius2;
    drawn->color.w = sqrtf(radius2);
    drawn->facing = with_w(facing, KILN_LAMP_RECTANGLE);
    drawn->right = with_w(float3_scale(right, 0.5f * width), 0.0f);
    drawn->up = with_w(float3_scale(float3_cross(right, facing), 0.5f * height), 0.0f);
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
        if (light->kind == KILN_LIGHT_SPOT)
            add_cone(scene, light, time_s, &lights[i]);
        else if (light->kind == KILN_LIGHT_RECTANGLE)
            add_edges(scene, light, time_s, &lights[i]);
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
        const float part = part_above_planes(moment, light);
        light->casters.x = find_casters(&moment->shapes, &boxes, light);
        light->color.x *= part;
        light->color.y *= part;
        light->color.z *= part;
    }
}
