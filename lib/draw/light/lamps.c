/* This file evaluates the lamps of a scene. It finds which objects may hide each light, a bit for
 * each (struct kiln_draw_light), and dims lights by planes, which hide the same part of a light
 * from all places above them. Of a rectangle, which is a part of a plane, objects hide nothing that
 * are wholly behind that plane, such as the wall that it hangs on. */
#include "draw/light/lamps.h"

#include <math.h>
#include <string.h>

#include "shared/exact.h"
#include "shared/shapes.h"

static float3 xyz(float4 v)
{
    return (float3){v.x, v.y, v.z};
}

static bool contains(const struct kiln_draw_shape *shape, float3 from)
{
#define CONTAINS(KIND, name)                                                                       \
    if (shape->kind.x == SHAPE_##KIND)                                                             \
        return name##_contains(*shape, from);
    KILN_SHAPES(CONTAINS)
#undef CONTAINS
    return false;
}

/* How far an object that counts as behind a rectangle may reach past its plane, m. */
static const float RECTANGLE_SLACK = 1e-3f;

/* Returns whether a shape is wholly behind a rectangle. */
static bool is_behind(const struct kiln_draw_light *light, const struct kiln_draw_shape *shape)
{
    if (light->facing.w != KILN_LAMP_RECTANGLE)
        return false;
    const float3 from = float3_sub(xyz(shape->center), xyz(light->position_radius2));
    const float reach = kiln_shape_reach(shape, xyz(light->facing));
    return float3_dot(from, xyz(light->facing)) + reach < RECTANGLE_SLACK;
}

/* Returns the trimmed set of the shapes that may hide a light. hide: those that hide any. */
static struct kiln_shape_set find_casters(const struct kiln_draw_shapes *shapes,
                                          const struct kiln_shape_set *hide,
                                          const struct kiln_draw_light *light)
{
    struct kiln_shape_set casters = *hide;
    struct kiln_shape_walk walk = kiln_shape_walk_begin(hide);
    while (kiln_shape_walk_next(&walk)) {
        const uint32_t i = walk.shape;
        const struct kiln_draw_shape *shape = &shapes->shapes[i];
        const float3 from = float3_sub(xyz(light->position_radius2), xyz(shape->center));
        if (contains(shape, from) || is_behind(light, shape))
            kiln_shape_set_remove(&casters, i);
    }
    kiln_shape_set_trim(&casters);
    return casters;
}

/* Returns the part of a light that a plane hides. height: of the light's centre above it, m. A
 * rectangle sinks into the plane evenly, as it does where one of its edges is along the plane. */
static float cover_of_plane(const struct kiln_draw_light *light, float3 normal, float height)
{
    if (light->facing.w != KILN_LAMP_RECTANGLE)
        return plane_hides(height, light->color.w);
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
    for (uint32_t i = 0; i < shapes->counts.x; i++) {
        const struct kiln_draw_shape *plane = &shapes->shapes[i];
        const float3 normal = xyz(plane->rows[1]);
        if (plane->kind.x == SHAPE_PLANE)
            part *= 1.0f - cover_of_plane(light, normal,
                                          float3_dot(float3_sub(at, xyz(plane->center)), normal));
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
    const float3 direction = kiln_scene_value3(scene, &light->direction, time_s);
    return float3_normalize(kiln_attached_vector(scene, &light->attach, direction, time_s),
                            (float3){0.0f, -1.0f, 0.0f});
}

/* Returns one of the lengths of a light, m. */
static float length_of(const struct kiln_scene *scene, const struct kiln_light *light,
                       const struct kiln_value *length, float time_s)
{
    return kiln_attached_length(scene, &light->attach, kiln_scene_value(scene, length, time_s),
                                time_s);
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
    const float width = length_of(scene, light, &light->width, time_s);
    const float height = length_of(scene, light, &light->height, time_s);
    const float3 facing = direction_of(scene, light, time_s);
    const float3 none = {0.0f, 0.0f, 0.0f}, y = {0.0f, 1.0f, 0.0f}, minus_z = {0.0f, 0.0f, -1.0f};
    const float3 up = kiln_scene_value3(scene, &light->up, time_s);
    const float3 wanted =
        float3_normalize(kiln_attached_vector(scene, &light->attach, up, time_s), none);
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
        const float radius = length_of(scene, light, &light->radius, time_s);
        const float3 place = kiln_scene_value3(scene, &light->position, time_s);
        const float3 at = kiln_attached_point(scene, &light->attach, place, time_s);
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
    const struct kiln_shape_set hide = kiln_shapes_that_hide(&moment->shapes);
    for (uint32_t i = 0; i < count; i++) {
        struct kiln_draw_light *light = &lights[i];
        if (!light->casters.x)
            continue;
        const float part = part_above_planes(moment, light);
        const struct kiln_shape_set casters = find_casters(&moment->shapes, &hide, light);
        memcpy(light->hiders, casters.words, casters.count * sizeof *casters.words);
        light->casters.x = kiln_shape_set_any(&casters);
        light->color.x *= part;
        light->color.y *= part;
        light->color.z *= part;
    }
}
