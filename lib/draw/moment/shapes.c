/* This file evaluates the backdrop's objects at a clip time and writes them into the uniform block
 * of shapes. The results affect only pictures, not the simulation. */
#include "draw/moment/shapes.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>

#include "base/matrix.h"
#include "draw/moment/instances.h"
#include "draw/moment/sun_outline.h"
#include "shared/exact.h"

enum { FIRST_SPHERE = 144 + 2 * 16 * KILN_WAVES };

static_assert(sizeof(struct kiln_draw_mesh) == 96, "std140");
static_assert(sizeof(struct kiln_draw_oriented_box) == 96, "std140");
static_assert(offsetof(struct kiln_draw_shapes, spheres) == FIRST_SPHERE, "std140");
static_assert(offsetof(struct kiln_draw_shapes, meshes) == FIRST_SPHERE + 80 * KILN_MAX_OBJECTS,
              "std140");
static_assert(sizeof(struct kiln_draw_shapes) == FIRST_SPHERE + 96 * (KILN_MAX_MESHES + 1) +
                                                     (80 + 80 + 96 + 96 + 48) * KILN_MAX_OBJECTS,
              "std140, and no padding, which the backdrop would compare");

struct kiln_shape_features kiln_shape_features(const struct kiln_scene *scene)
{
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    struct kiln_shape_features features = {
        .floor_image = backdrop->floor_image != NULL,
        .floor_gloss = kiln_scene_value_max(scene, &backdrop->floor_gloss) > 0.0f,
        .sky_image = backdrop->sky_image != NULL,
        .soft_sun = kiln_scene_value_max(scene, &backdrop->sun_size) > 0.0f,
    };
    for (uint32_t i = 0; i < backdrop->object_count; i++) {
        const struct kiln_object *object = &backdrop->objects[i];
        enum kiln_object_kind kind = object->kind;
        features.oriented |= kind == KILN_OBJECT_CAPSULE || kiln_object_is_oriented_box(object) ||
                             (kind == KILN_OBJECT_PLANE && object->visible);
        features.round |= kind == KILN_OBJECT_SPHERE || kind == KILN_OBJECT_CYLINDER;
        features.meshes |= kiln_object_is_mesh(&backdrop->objects[i]);
        features.paint |= kiln_object_takes_paint(object);
    }
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        features.solids |= system->enabled && kiln_look_is_opaque(&system->look);
    }
    features.instances = kiln_instance_tile_edge(scene) > 0;
    return features;
}

void kiln_shape_defines(const struct kiln_shape_features *features, int samples,
                        char out[KILN_SHAPE_DEFINES])
{
    snprintf(out, KILN_SHAPE_DEFINES, "#define SAMPLES %d\n%s%s%s%s%s%s%s%s%s%s", samples,
             features->round ? "#define ROUND 1\n" : "",
             features->oriented ? "#define ORIENTED 1\n" : "",
             features->meshes ? "#define MESHES 1\n" : "",
             features->paint ? "#define PAINT 1\n" : "",
             features->solids ? "#define SOLIDS 1\n" : "",
             features->instances ? "#define INSTANCES 1\n" : "",
             features->floor_image ? "#define FLOOR_IMAGE 1\n" : "",
             features->floor_gloss ? "#define FLOOR_GLOSS 1\n" : "",
             features->sky_image ? "#define SKY_IMAGE 1\n" : "",
             features->soft_sun ? "#define SOFT_SUN 1\n" : "");
}

static float4 with_w(float3 v, float w)
{
    return (float4){v.x, v.y, v.z, w};
}

float3 kiln_direction(float3 v)
{
    float length = sqrtf(v.x * v.x + v.y * v.y + v.z * v.z);
    if (!(length > 0.0f))
        return (float3){0.0f, 1.0f, 0.0f};
    return (float3){v.x / length, v.y / length, v.z / length};
}

struct kiln_sun_frame kiln_sun_frame_at(const struct kiln_scene *scene, float time_s)
{
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    float3 sun = kiln_direction(kiln_scene_value3(scene, &backdrop->sun_direction, time_s));
    float3 aside = fabsf(sun.y) < 0.9f ? (float3){0.0f, 1.0f, 0.0f} : (float3){1.0f, 0.0f, 0.0f};
    float3 right = kiln_direction(float3_cross(aside, sun));
    const struct exact_angle radius =
        exact_sincos(0.5f * kiln_scene_value(scene, &backdrop->sun_size, time_s));
    return (struct kiln_sun_frame){right, float3_cross(sun, right), sun,
                                   radius.sine / radius.cosine};
}

/* Fills in eight waves with directions around that of the wind; each is 0.71 times as long as the
 * one before. length_m: length of the longest wave. */
static void fill_waves(float length_m, float time_s, struct kiln_draw_shapes *shapes)
{
    const float gravity = 9.81f, full_turn = EXACT_TWO_PI;
    for (int i = 0; i < KILN_WAVES; i++) {
        const struct exact_angle heading =
            exact_sincos(1.2f + 1.1f * exact_sincos(2.7f * (float)i).sine);
        float number = full_turn / length_m, turns = sqrtf(gravity * number) * time_s / full_turn;
        float shift = 0.1f * length_m;
        shapes->waves[i] =
            (float4){heading.cosine, heading.sine, number, (turns - floorf(turns)) * full_turn};
        shapes->wave_shift[i] = (float4){heading.cosine * shift, heading.sine * shift, 0.0f, 0.0f};
        length_m *= 0.71f;
    }
}

/* Fills in the gloss and the waves of the floor. A wave of height h and length l has the slope
 * pi h / l; the shorter waves are as steep as the longest one. */
static void fill_gloss(const struct kiln_scene *scene, float time_s,
                       struct kiln_draw_shapes *shapes)
{
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    float roughness = kiln_scene_value(scene, &backdrop->floor_roughness, time_s);
    float height = kiln_scene_value(scene, &backdrop->floor_wave_height, time_s);
    float length = kiln_scene_value(scene, &backdrop->floor_wave_length, time_s);
    shapes->floor_gloss = (float4){kiln_scene_value(scene, &backdrop->floor_gloss, time_s),
                                   roughness * roughness, 3.14159265f * height / length, 0.0f};
    fill_waves(length, height > 0.0f ? time_s : 0.0f, shapes);
}

/* Returns the world position of a mesh's origin. The origin of a terrain is its corner with the
 * least x and z. */
static float3 mesh_origin(const struct kiln_scene *scene, const struct kiln_object *object,
                          float time_s)
{
    float3 at = kiln_scene_value3(scene, &object->center, time_s);
    if (object->kind == KILN_OBJECT_TERRAIN) {
        at.x -= 0.5f * object->size.x.constant;
        at.z -= 0.5f * object->size.z.constant;
    }
    return at;
}

static void fill_mesh(const struct kiln_scene *scene, const struct kiln_object *object,
                      const struct kiln_mesh *mesh, float time_s, struct kiln_draw_mesh *out)
{
    float3 at = mesh_origin(scene, object, time_s);
    float scale = object->kind == KILN_OBJECT_TERRAIN
                      ? 1.0f
                      : kiln_scene_value(scene, &object->scale, time_s);
    mat3 turn;
    mat4 to_world = {{0.0f}, {0.0f}, {0.0f}, {at.x, at.y, at.z, 1.0f}};
    vec3 center = {at.x, at.y, at.z}, half_size = GLM_VEC3_ZERO_INIT, half_edges;
    kiln_scene_rotation(kiln_scene_value3(scene, &object->rotation, time_s), turn);
    glm_mat3_scale(turn, scale);
    glm_mat4_ins3(turn, to_world);
    kiln_matrix_to_rows(to_world, out->to_world);
    for (int c = 0; c < 3; c++) {
        vec3 size;
        glm_vec3_abs(turn[c], size);
        half_edges[c] = 0.5f * (mesh->max[c] - mesh->min[c]);
        glm_vec3_muladds(turn[c], 0.5f * (mesh->min[c] + mesh->max[c]), center);
        glm_vec3_muladds(size, half_edges[c], half_size);
    }
    glm_vec3_scale(half_edges, scale, half_edges);
    const float radius = glm_vec3_norm(half_edges);
    out->color = with_w(kiln_scene_value3(scene, &object->color, time_s), 0.0f);
    out->center = (float4){center[0], center[1], center[2], fmaxf(radius, 1e-6f)};
    const float clip_s =
        object->animation.enabled ? kiln_scene_animation_s(&object->animation, time_s) : 0.0f;
    out->half_size = (float4){half_size[0], half_size[1], half_size[2], clip_s};
}

/* Writes the layer of the paint textures that each mesh has, and its first mip level there. The
 * largest texture fills its layer from level 0 on; smaller textures start at a coarser level. */
static void fill_paint(const struct kiln_scene *scene, struct kiln_draw_shapes *shapes)
{
    uint32_t largest = 0, mesh = 0;
    float layer = 0.0f;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (kiln_object_takes_paint(object) && object->paint.size > largest)
            largest = object->paint.size;
    }
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (kiln_object_takes_paint(object)) {
            shapes->meshes[mesh].color.w = ++layer;
            for (uint32_t size = object->paint.size; size < largest; size *= 2)
                shapes->meshes[mesh].color.w += 16.0f;
        }
        mesh += kiln_object_is_mesh(object);
    }
}

/* Returns half of a box's size; w: the radius of its bounding sphere, m. */
static float4 half_of_box(float3 size)
{
    const float3 half = {0.5f * size.x, 0.5f * size.y, 0.5f * size.z};
    return with_w(half, box_radius(half));
}

static void fill_oriented_box(const struct kiln_scene *scene, const struct kiln_object *object,
                              float time_s, struct kiln_draw_oriented_box *out)
{
    mat3 rotation; /* the columns of a rotation are the rows of its inverse */
    kiln_scene_rotation(kiln_scene_value3(scene, &object->rotation, time_s), rotation);
    for (int i = 0; i < 3; i++)
        out->rows[i] = (float4){rotation[i][0], rotation[i][1], rotation[i][2], 0.0f};
    float3 size = kiln_scene_value3(scene, &object->size, time_s);
    out->center = with_w(kiln_scene_value3(scene, &object->center, time_s), 0.0f);
    out->half_size = half_of_box(size);
    out->color = with_w(kiln_scene_value3(scene, &object->color, time_s), 0.0f);
}

/* Adds a capsule, a visible plane or a oriented box; ignores other objects. */
static void fill_oriented(const struct kiln_scene *scene, const struct kiln_object *object,
                          float time_s, struct kiln_draw_shapes *shapes)
{
    float3 center = kiln_scene_value3(scene, &object->center, time_s);
    float4 color = with_w(kiln_scene_value3(scene, &object->color, time_s), 0.0f);
    if (object->kind == KILN_OBJECT_CAPSULE) {
        uint k = shapes->oriented_counts.x++;
        float3 axis = kiln_direction(kiln_scene_value3(scene, &object->axis, time_s));
        shapes->capsules[k] = with_w(center, kiln_scene_value(scene, &object->radius, time_s));
        shapes->capsule_axis[k] =
            with_w(axis, 0.5f * kiln_scene_value(scene, &object->height, time_s));
        shapes->capsule_color[k] = color;
    } else if (kiln_object_is_oriented_box(object)) {
        fill_oriented_box(scene, object, time_s,
                          &shapes->oriented_boxes[shapes->oriented_counts.y++]);
    } else if (object->kind == KILN_OBJECT_PLANE && object->visible) {
        uint k = shapes->oriented_counts.z++;
        float3 normal = kiln_direction(kiln_scene_value3(scene, &object->axis, time_s));
        shapes->planes[k] = with_w(normal, float3_dot(normal, center));
        shapes->plane_color[k] = color;
    }
}

uint32_t kiln_boxes_fill(const struct kiln_scene *scene, float time_s, float4 *centers,
                         float4 *halves, float4 *colors)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *box = &scene->backdrop.objects[i];
        if (box->kind != KILN_OBJECT_BOX || kiln_object_is_oriented_box(box))
            continue;
        const float3 size = kiln_scene_value3(scene, &box->size, time_s);
        centers[count] = with_w(kiln_scene_value3(scene, &box->center, time_s), 0.0f);
        halves[count] = half_of_box(size);
        if (colors)
            colors[count] = with_w(kiln_scene_value3(scene, &box->color, time_s), 0.0f);
        count++;
    }
    return count;
}

/* Fills in the outlines of boxes and cylinders as seen from the sun. */
static void fill_sun(const struct kiln_sun_frame *sun, struct kiln_draw_shapes *shapes)
{
    shapes->edges = kiln_sun_edges_of(sun->towards);
    for (uint32_t i = 0; i < shapes->oriented_counts.y; i++) {
        float way[3];
        for (int k = 0; k < 3; k++) {
            const float4 row = shapes->oriented_boxes[i].rows[k];
            way[k] = float3_dot((float3){row.x, row.y, row.z}, sun->towards);
        }
        shapes->oriented_edges[i] = kiln_sun_edges_of((float3){way[0], way[1], way[2]});
    }
    for (uint32_t i = 0; i < shapes->counts.y; i++)
        shapes->bands[i] = kiln_sun_band_of(shapes->cylinder_axis[i], sun->towards, sun->right);
}

void kiln_shapes_fill(const struct kiln_scene *scene, const struct kiln_mesh *const *meshes,
                      const struct kiln_sun_frame *sun, float time_s,
                      struct kiln_draw_shapes *shapes)
{
    *shapes = (struct kiln_draw_shapes){.counts = {0, 0, 0, 0}};
    shapes->sun_right = with_w(sun->right, sun->spread);
    shapes->sun_up = with_w(sun->up, sun->spread);
    if (kiln_shape_features(scene).floor_gloss)
        fill_gloss(scene, time_s, shapes);
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        float3 center = kiln_scene_value3(scene, &object->center, time_s);
        float4 color = with_w(kiln_scene_value3(scene, &object->color, time_s), 0.0f);
        float radius = kiln_scene_value(scene, &object->radius, time_s);
        if (object->kind == KILN_OBJECT_SPHERE) {
            uint k = shapes->counts.x++;
            shapes->spheres[k] = with_w(center, radius);
            shapes->sphere_color[k] = color;
        } else if (object->kind == KILN_OBJECT_CYLINDER) {
            uint k = shapes->counts.y++;
            float3 axis = kiln_direction(kiln_scene_value3(scene, &object->axis, time_s));
            shapes->cylinders[k] = with_w(center, radius);
            shapes->cylinder_axis[k] =
                with_w(axis, 0.5f * kiln_scene_value(scene, &object->height, time_s));
            shapes->cylinder_color[k] = color;
        } else if (kiln_object_is_mesh(object)) {
            uint k = shapes->counts.z++;
            fill_mesh(scene, object, meshes[k], time_s, &shapes->meshes[k]);
        } else {
            fill_oriented(scene, object, time_s, shapes);
        }
    }
    fill_sun(sun, shapes);
    fill_paint(scene, shapes);
}
