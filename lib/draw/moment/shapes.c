/* This file evaluates the backdrop's objects at a clip time and writes them into the uniform block
 * of shapes. The results affect only pictures, not the simulation. */
#include "draw/moment/shapes.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "base/matrix.h"
#include "draw/moment/instances.h"
#include "draw/moment/shapes_seen.h"
#include "shared/exact.h"
#include "shared/shapes.h"

enum { FIRST_MESH = 128 + 2 * 16 * KILN_WAVES };

static_assert(sizeof(struct kiln_draw_mesh) == 96, "std140");
static_assert(sizeof(struct kiln_draw_shape) == 112, "std140");
static_assert(offsetof(struct kiln_draw_shapes, meshes) == FIRST_MESH, "std140");
static_assert(sizeof(struct kiln_draw_shapes) == FIRST_MESH + 96 * KILN_MAX_MESHES +
                                                     16 * KILN_SHAPE_FIRSTS +
                                                     112 * KILN_MAX_OBJECTS,
              "std140, and no padding, which the backdrop would compare");
static_assert(KILN_MAX_MESHES < KILN_PAINT_LAYERS, "each may have paint");
static_assert(SHAPE_KINDS < 4 * KILN_SHAPE_FIRSTS, "`first` has one number more");

/* Returns the kind of shape that an object is drawn as, or SHAPE_KINDS: it is drawn as a mesh, or
 * not at all. */
static uint32_t shape_of(const struct kiln_object *object)
{
    switch (object->kind) {
    case KILN_OBJECT_BOX:
        return SHAPE_BOX;
    case KILN_OBJECT_SPHERE:
    case KILN_OBJECT_CAPSULE:
        return SHAPE_CAPSULE;
    case KILN_OBJECT_CYLINDER:
        return SHAPE_CYLINDER;
    case KILN_OBJECT_PLANE:
        return object->visible ? SHAPE_PLANE : SHAPE_KINDS;
    case KILN_OBJECT_CONE:
        return SHAPE_CONE;
    case KILN_OBJECT_MESH:
    case KILN_OBJECT_TERRAIN:
        break;
    }
    return SHAPE_KINDS;
}

struct kiln_shape_features kiln_shape_features(const struct kiln_scene *scene)
{
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    struct kiln_shape_features features = {
        .floor_image = backdrop->floor_image != NULL,
        .floor_gloss = kiln_scene_value_max(scene, &backdrop->floor_gloss) > 0.0f,
        .sky_image = backdrop->sky_image != NULL,
        .sun = kiln_scene_has_sun(scene),
        .smoke = kiln_scene_has_smoke(scene),
        .lamps = kiln_scene_has_lamps(scene),
        .lamp_shadows = kiln_scene_shadow_lights(scene) > 0,
    };
    uint32_t count = 0, meshes = 0;
    for (uint32_t i = 0; i < backdrop->light_count; i++)
        features.rectangles |= backdrop->lights[i].kind == KILN_LIGHT_RECTANGLE;
    for (uint32_t i = 0; i < backdrop->object_count; i++) {
        const struct kiln_object *object = &backdrop->objects[i];
        if (shape_of(object) < SHAPE_KINDS) {
            features.kinds |= 1u << shape_of(object);
            count++;
        }
        meshes += kiln_object_is_mesh(object);
        features.paint |= kiln_object_takes_paint(object);
    }
    features.stored = count > KILN_BLOCK_SHAPES;
    features.meshes = meshes > 0;
    features.many_meshes = meshes > KILN_FEW_MESHES;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        features.solids |= system->enabled && kiln_look_is_opaque(&system->look);
    }
    features.instances = kiln_instance_tile_edge(scene) > 0;
    return features;
}

void kiln_shape_defines(const struct kiln_shape_features *features, struct kiln_text *defines)
{
    const struct {
        const char *name;
        bool is_defined;
    } rows[] = {
        {"SHAPES_STORED", features->stored},
        {"MESHES", features->meshes},
        {"MANY_MESHES", features->many_meshes},
        {"PAINT", features->paint},
        {"SOLIDS", features->solids},
        {"INSTANCES", features->instances},
        {"FLOOR_IMAGE", features->floor_image},
        {"FLOOR_GLOSS", features->floor_gloss},
        {"SKY_IMAGE", features->sky_image},
        {"NO_SUN", !features->sun},
        {"NO_SMOKE", !features->smoke},
        {"NO_LAMPS", !features->lamps},
        {"NO_LAMP_SHADOWS", !features->lamp_shadows},
        {"NO_RECTANGLES", !features->rectangles},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (rows[i].is_defined)
            kiln_text_add(defines, "#define %s 1\n", rows[i].name);
    }
    kiln_text_add(defines, "#define KILN_SHAPES(ROW)");
#define ADD_ROW(KIND, name)                                                                        \
    if (features->kinds >> SHAPE_##KIND & 1)                                                       \
        kiln_text_add(defines, " ROW(" #KIND ", " #name ")");
    KILN_SHAPES(ADD_ROW)
#undef ADD_ROW
    kiln_text_add(defines, "\n");
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
    float3 at = kiln_object_center(scene, object, time_s);
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
                      : kiln_object_length(scene, object, &object->scale, time_s);
    mat3 turn;
    mat4 to_world = {{0.0f}, {0.0f}, {0.0f}, {at.x, at.y, at.z, 1.0f}};
    vec3 center = {at.x, at.y, at.z}, half_size = GLM_VEC3_ZERO_INIT, half_edges;
    kiln_object_rotation(scene, object, time_s, turn);
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
                shapes->meshes[mesh].color.w += (float)KILN_PAINT_LAYERS;
        }
        mesh += kiln_object_is_mesh(object);
    }
}

/* Fills in the frame of a shape around an axis, of which any vectors across the axis will do. */
static void fill_axis(float3 axis, struct kiln_draw_shape *out)
{
    const float3 from =
        fabsf(axis.x) > 0.7f ? (float3){-axis.z, 0.0f, axis.x} : (float3){0.0f, axis.z, -axis.y};
    const float3 across = kiln_direction(from);
    out->rows[0] = with_w(across, 0.0f);
    out->rows[1] = with_w(axis, 0.0f);
    out->rows[2] = with_w(float3_cross(across, axis), 0.0f);
}

static float size_of(const struct kiln_draw_shape *shape)
{
    float size = 0.0f;
#define SIZE(KIND, name)                                                                           \
    if (shape->kind.x == SHAPE_##KIND)                                                             \
        size = name##_size(*shape);
    KILN_SHAPES(SIZE)
#undef SIZE
    return size;
}

float kiln_shape_reach(const struct kiln_draw_shape *shape, float3 way)
{
    float reach = 0.0f;
#define REACH(KIND, name)                                                                          \
    if (shape->kind.x == SHAPE_##KIND)                                                             \
        reach = name##_reach(*shape, way);
    KILN_SHAPES(REACH)
#undef REACH
    return reach;
}

static void fill_shape(const struct kiln_scene *scene, const struct kiln_object *object,
                       float time_s, struct kiln_draw_shape *out)
{
    const bool turned = object->kind != KILN_OBJECT_BOX || kiln_object_is_oriented_box(object);
    *out = (struct kiln_draw_shape){
        .color = with_w(kiln_scene_value3(scene, &object->color, time_s), 0.0f),
        .kind = {shape_of(object), turned, 0, 0},
        .rows = {{1.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f, 0.0f}},
    };
    if (object->kind == KILN_OBJECT_BOX) {
        out->extent = with_w(float3_scale(kiln_object_size(scene, object, time_s), 0.5f), 0.0f);
        mat3 rotation; /* the columns of a rotation are the rows of its inverse */
        kiln_object_rotation(scene, object, time_s, rotation);
        for (int i = 0; turned && i < 3; i++)
            out->rows[i] = (float4){rotation[i][0], rotation[i][1], rotation[i][2], 0.0f};
    } else {
        const bool has_axis = object->kind != KILN_OBJECT_SPHERE;
        const float height =
            has_axis ? kiln_object_length(scene, object, &object->height, time_s) : 0.0f;
        const float radius = kiln_object_length(scene, object, &object->radius, time_s);
        out->extent = (float4){radius, 0.5f * height, radius, radius};
        if (has_axis)
            fill_axis(kiln_direction(kiln_object_axis(scene, object, time_s)), out);
    }
    out->center = with_w(kiln_object_center(scene, object, time_s), size_of(out));
}

/* Fills in all shapes in the order of their kinds. */
static void fill_kinds(const struct kiln_scene *scene, float time_s,
                       struct kiln_draw_shapes *shapes)
{
    uint32_t first[4 * KILN_SHAPE_FIRSTS] = {0};
    for (uint32_t kind = 0; kind < SHAPE_KINDS; kind++) {
        for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
            const struct kiln_object *object = &scene->backdrop.objects[i];
            if (shape_of(object) == kind)
                fill_shape(scene, object, time_s, &shapes->shapes[shapes->counts.x++]);
        }
        first[kind + 1] = shapes->counts.x;
    }
    static_assert(sizeof first == sizeof shapes->first, "as in GLSL");
    memcpy(shapes->first, first, sizeof first);
    shapes->counts.y = KILN_SURFACE_MESHES(shapes->counts.x);
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
    fill_kinds(scene, time_s, shapes);
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (!kiln_object_is_mesh(object))
            continue;
        const uint32_t k = shapes->counts.z++;
        fill_mesh(scene, object, meshes[k], time_s, &shapes->meshes[k]);
    }
    fill_paint(scene, shapes);
}

void kiln_shapes_see(const struct kiln_draw_shapes *shapes, float3 towards,
                     struct kiln_shape_seen seen[KILN_MAX_OBJECTS])
{
    for (uint32_t i = 0; i < shapes->counts.x; i++) {
        const struct kiln_draw_shape *shape = &shapes->shapes[i];
#define SEE(KIND, name)                                                                            \
    if (shape->kind.x == SHAPE_##KIND) {                                                           \
        const struct name##_seen found = name##_seen_along(*shape, towards);                       \
        static_assert(sizeof found <= sizeof seen->numbers, "each kind has room");                 \
        memcpy(seen[i].numbers, &found, sizeof found);                                             \
    }
        KILN_SHAPES(SEE)
#undef SEE
    }
}
